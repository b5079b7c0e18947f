// A world as coloured triangles. See draw_list.h.
#include "render/draw_list.h"

#include "render/fluid_draw.h"
#include "render/soft_mesh.h"
#include "render/tube.h"
#include "formats/turning.h"
#include "scene/scene_color.h"

#include <algorithm>
#include <cmath>
#include <cstring>

namespace gyre {
namespace {

constexpr SceneColor kRodColor{92, 96, 104};

void add_quads(DrawList& list, std::uint32_t first, std::uint32_t rings, std::uint32_t a_ring) {
  for (std::uint32_t ring = 0; ring + 1 < rings; ++ring) {
    for (std::uint32_t k = 0; k + 1 < a_ring; ++k) {
      const std::uint32_t a = first + ring * a_ring + k, b = a + 1, c = b + a_ring, d = a + a_ring;
      list.solid.insert(list.solid.end(), {a, b, c, a, c, d});
    }
  }
}

// A square of the plane around the foot of the subject, far larger than the picture.
void add_plane(const Subject& subject, DVec3 point, Vec3 normal, SceneColor color, Paint paint,
               DrawList& list) {
  const Vec3 side = any_perpendicular(normal), other = cross(normal, side);
  const float reach = 60.0f * subject.radius;
  const Vec3 to_plane = difference(point, subject.origin);
  const Vec3 foot = dot(to_plane, normal) * normal;
  const auto first = std::uint32_t(list.vertices.size());
  for (const auto& [u, v] : {std::pair(-1.0f, -1.0f), {1.0f, -1.0f}, {1.0f, 1.0f}, {-1.0f, 1.0f}}) {
    list.vertices.push_back(
        {foot + reach * (u * side + v * other), normal, {color.red, color.green, color.blue}, paint});
  }
  list.ground.insert(list.ground.end(), {first, first + 1, first + 2, first, first + 2, first + 3});
}

void add_link(const SeenLink& link, Vec3 down, const Subject& subject, DrawList& list) {
  constexpr int kSides = 12;
  constexpr int kTurns = 10;
  const Vec3 a = difference(link.a, subject.origin), b = difference(link.b, subject.origin);
  const std::vector<Vec3> line = link.spring ? coil_line(a, b, 5.0f * subject.rod_radius, kTurns)
                                             : hanging_line(a, b, link.length, down);
  const auto first = std::uint32_t(list.vertices.size());
  for (const TubePoint& point : tube_rings(line, subject.rod_radius, kSides)) {
    list.vertices.push_back(
        {point.position, point.normal, {kRodColor.red, kRodColor.green, kRodColor.blue}, Paint::matter});
  }
  add_quads(list, first, std::uint32_t(line.size()), kSides + 1);
}

// A rope is drawn as the smooth line through its vertices.
void add_rope(const SeenSoft& rope, const std::vector<Vec3>& vertices, float radius,
              std::span<const SceneColor> colors, DrawList& list) {
  constexpr int kSides = 16;
  constexpr int kPieces = 4;
  if (vertices.size() < 2) return;
  const auto first = std::uint32_t(list.vertices.size());
  const std::vector<TubePoint> tube = capped_tube(smooth_line(vertices, kPieces), radius, kSides);
  const std::size_t rings = tube.size() / (kSides + 1), caps = (rings - (kPieces * (vertices.size() - 1) + 1)) / 2;
  for (std::size_t i = 0; i < tube.size(); ++i) {
    // The vertex that the ring is nearest to.
    const std::size_t ring = i / (kSides + 1), along = ring > caps ? ring - caps : 0;
    const std::size_t vertex = min((along + kPieces / 2) / kPieces, vertices.size() - 1);
    const SceneColor color = colors.empty() ? rope.color : colors[vertex];
    list.vertices.push_back(
        {tube[i].position, tube[i].normal, {color.red, color.green, color.blue}, Paint::matter});
  }
  add_quads(list, first, std::uint32_t(rings), kSides + 1);
}

// `color_of(i)`: of the i-th vertex of the mesh.
template <class ColorOf>
void add_mesh(const ShapeMesh& mesh, const ColorOf& color_of, Paint paint, DrawList& list) {
  const auto first = std::uint32_t(list.vertices.size());
  for (std::size_t i = 0; i < mesh.vertices.size(); ++i) {
    const SceneColor color = color_of(i);
    list.vertices.push_back(
        {mesh.vertices[i].position, mesh.vertices[i].normal, {color.red, color.green, color.blue}, paint});
  }
  for (const std::uint32_t index : mesh.indices) list.solid.push_back(first + index);
}

// The back of a cloth is paler than its front.
SceneColor back_of(SceneColor color) {
  const auto pale = [](std::uint8_t part) { return std::uint8_t((2 * int(part) + 3 * 222) / 5); };
  return {pale(color.red), pale(color.green), pale(color.blue)};
}

void add_soft(const Sight& sight, const SeenSoft& soft, const ReadingRange& range, const Subject& subject,
              DrawList& list) {
  std::vector<Vec3> vertices;
  std::vector<SceneColor> colors;
  for (const float reading : soft.readings) colors.push_back(reading_color(reading, range));
  // By vertex of the soft matter.
  const auto color_of = [&](std::size_t vertex) { return colors.empty() ? soft.color : colors[vertex]; };
  for (const DVec3& vertex : sight.vertices_of(soft)) vertices.push_back(difference(vertex, subject.origin));
  if (soft.kind == SoftKind::rope) {
    // A rope thinner than a pixel would not be seen.
    add_rope(soft, vertices, max(soft.radius, 0.15f * subject.rod_radius), colors, list);
    return;
  }
  if (soft.kind == SoftKind::solid) {
    const auto color_of_corner = [&](std::size_t i) { return color_of(soft.triangles[i]); };
    add_mesh(solid_mesh(vertices, soft.triangles), color_of_corner, Paint::matter, list);
    return;
  }
  const ClothMesh mesh = cloth_mesh(vertices, soft.triangles, soft.radius);
  // Both sides of a cloth tell what is read.
  const auto back_color_of = [&](std::size_t i) { return colors.empty() ? back_of(soft.color) : colors[i]; };
  const auto rim_color_of = [&](std::size_t i) { return color_of(mesh.rim_of[i]); };
  add_mesh(mesh.front, color_of, Paint::sheet, list);
  add_mesh(mesh.back, back_color_of, Paint::sheet, list);
  add_mesh(mesh.rim, rim_color_of, Paint::matter, list);
}

std::uint8_t toned(std::uint8_t part, float tone) { return std::uint8_t(float(part) * tone + 0.5f); }

// All that a mesh depends on, as bytes.
struct MeshKey {
  std::string bytes;
  template <class T>
  void add(const T& value) {
    bytes.append(reinterpret_cast<const char*>(&value), sizeof value);
  }
  void operator()(const Sphere& s) { add(s.radius); }
  void operator()(const Box& s) {
    add(s.half_extents);
    add(s.rounding);
  }
  template <class Round>
  void operator()(const Round& s) {
    add(s.radius);
    add(s.half_height);
  }
  void operator()(const Plane&) {}
  void operator()(const Geometry& s) { add(s.data()); }
};

// So many that the outline is off by a quarter of a pixel at most.
int segments_for(float radius_pixels) {
  if (!(radius_pixels > 0.5f)) return 8;
  const float angle = acos(1.0f - min(0.25f / radius_pixels, 1.0f));
  return std::clamp(int(kHalfTurn / angle) + 7, 16, 160) / 8 * 8;
}

}  // namespace

const ShapeMesh& DrawListMaker::mesh_of(const AnyShape& shape, int segments) {
  MeshKey key;
  key.add(shape.index());
  key.add(rounding_radius(shape) > 0.0f ? segments : 0);
  std::visit(key, shape);
  const auto [at, added] = meshes_.try_emplace(key.bytes);
  if (added) at->second = make_shape_mesh(shape, segments);
  return at->second;
}

void DrawListMaker::add_shape(const SeenShape& shape, const Pose& pose, bool glass, const Camera& camera,
                              DVec3 origin, DrawList& list) {
  const float away = max(float(length(pose.position - camera.eye)), 1e-6f);
  const float radius_pixels = rounding_radius(*shape.geometry) / away * camera.focal_pixels();
  const ShapeMesh& mesh = mesh_of(*shape.geometry, segments_for(radius_pixels));
  const auto first = std::uint32_t(list.vertices.size());
  const Mat3 turned = to_matrix(pose.orientation);
  const Vec3 moved = difference(pose.position, origin);
  const SceneColor color = shape.color;
  for (const MeshVertex& vertex : mesh.vertices) {
    list.vertices.push_back(
        {turned * vertex.position + moved,
         turned * vertex.normal,
         {toned(color.red, vertex.tone), toned(color.green, vertex.tone), toned(color.blue, vertex.tone)},
         Paint::matter});
  }
  std::vector<std::uint32_t>& indices = glass ? list.glass : list.solid;
  for (const std::uint32_t index : mesh.indices) indices.push_back(first + index);
}

DrawList DrawListMaker::make(const Sight& sight, const Camera& camera, const Subject& subject) {
  DrawList list;
  for (const SeenBody& body : sight.bodies) {
    const std::span<const SeenShape> shapes = sight.shapes_of(body);
    for (std::size_t k = 0; k < shapes.size(); ++k) {
      const Pose pose = body.pose * shapes[k].local;
      if (const Plane* plane = std::get_if<Plane>(shapes[k].geometry)) {
        const Vec3 normal = normalized(plane->normal);
        const Vec3 point = (plane->offset / dot(plane->normal, plane->normal)) * plane->normal;
        add_plane(subject, pose * point, rotate(pose.orientation, normal), shapes[k].color, Paint::ground,
                  list);
      } else {
        const bool glass = shapes[k].sensor || glass_.count(shape_key(body.id, k)) > 0;
        add_shape(shapes[k], pose, glass, camera, subject.origin, list);
      }
    }
  }
  for (const SeenLink& link : sight.links) add_link(link, sight.down, subject, list);
  for (const SeenSoft& soft : sight.softs) add_soft(sight, soft, range_, subject, list);
  for (const SeenFluid& fluid : sight.fluids) add_fluid(fluid, subject, list);
  if (subject.floor && list.ground.empty()) {
    add_plane(subject, {subject.origin.x, *subject.floor, subject.origin.z}, {0, 1, 0}, kGroundColor,
              Paint::floor, list);
  }
  return list;
}

}  // namespace gyre
