// A world as coloured triangles. See draw_list.h.
#include "render/draw_list.h"

#include "render/tube.h"
#include "render/turning.h"
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

DrawListMaker::Look DrawListMaker::look_of(BodyId body, std::size_t ordinal, std::size_t shape) const {
  const bool glass = glass_.count(shape_key(body, shape)) > 0;
  const BodyType type = player_.world().type(body);
  const Scene* scene = player_.scene();
  const std::uint64_t index = player_.world().user_data(body);
  if (!scene || index >= player_.bodies().size() || !(player_.bodies()[index] == body) ||
      shape >= scene->bodies[index].shapes.size()) {
    const AnyShape& geometry = *player_.world().geometry(player_.world().shapes(body)[shape]);
    return {std::holds_alternative<Plane>(geometry) ? kGroundColor : automatic_color(type, ordinal), glass};
  }
  return {resolved_color(*scene, index, shape), glass || scene->bodies[index].sensor};
}

const ShapeMesh& DrawListMaker::mesh_of(const AnyShape& shape, int segments) {
  MeshKey key;
  key.add(shape.index());
  key.add(rounding_radius(shape) > 0.0f ? segments : 0);
  std::visit(key, shape);
  const auto [at, added] = meshes_.try_emplace(key.bytes);
  if (added) at->second = make_shape_mesh(shape, segments);
  return at->second;
}

DrawList DrawListMaker::make(const Camera& camera, const Subject& subject) {
  DrawList list;
  const World& world = player_.world();
  const BodyColumns bodies = world.bodies();
  for (std::size_t i = 0; i < bodies.ids.size(); ++i) {
    const std::span<const ShapeId> shapes = world.shapes(bodies.ids[i]);
    for (std::size_t k = 0; k < shapes.size(); ++k) {
      const AnyShape& shape = *world.geometry(shapes[k]);
      const Look look = look_of(bodies.ids[i], i, k);
      const Pose pose = bodies.poses[i] * world.local_transform(shapes[k]);
      const SceneColor color = look.color;
      if (const Plane* plane = std::get_if<Plane>(&shape)) {
        const Vec3 normal = normalized(plane->normal);
        const Vec3 point = (plane->offset / dot(plane->normal, plane->normal)) * plane->normal;
        add_plane(subject, pose * point, rotate(pose.orientation, normal), color, Paint::ground, list);
        continue;
      }
      const float away = max(float(length(pose.position - camera.eye)), 1e-6f);
      const ShapeMesh& mesh =
          mesh_of(shape, segments_for(rounding_radius(shape) / away * camera.focal_pixels()));
      const auto first = std::uint32_t(list.vertices.size());
      const Mat3 turned = to_matrix(pose.orientation);
      const Vec3 moved = difference(pose.position, subject.origin);
      for (const MeshVertex& vertex : mesh.vertices) {
        list.vertices.push_back(
            {turned * vertex.position + moved,
             turned * vertex.normal,
             {toned(color.red, vertex.tone), toned(color.green, vertex.tone), toned(color.blue, vertex.tone)},
             Paint::matter});
      }
      std::vector<std::uint32_t>& indices = look.glass ? list.glass : list.solid;
      for (const std::uint32_t index : mesh.indices) indices.push_back(first + index);
    }
  }
  add_joints(subject, list);
  if (subject.floor && list.ground.empty()) {
    add_plane(subject, {subject.origin.x, *subject.floor, subject.origin.z}, {0, 1, 0}, kGroundColor,
              Paint::floor, list);
  }
  return list;
}

void DrawListMaker::add_joints(const Subject& subject, DrawList& list) const {
  const World& world = player_.world();
  for (const SeenJoint& seen : joints_) {
    const JointDef& def = seen.joint->def;
    if (def.kind != JointKind::distance) continue;
    const auto is_gone = [&](BodyId body, int index) { return index >= 0 && !world.exists(body); };
    if (is_gone(seen.a, seen.joint->a) || is_gone(seen.b, seen.joint->b)) continue;
    if (seen.id != JointId{} && !world.exists(seen.id)) continue;
    const auto end = [&](BodyId body, int index, Vec3 point, DVec3 place) {
      return difference(index < 0 ? place : world.pose(body) * point, subject.origin);
    };
    const Vec3 a = end(seen.a, seen.joint->a, seen.point_a, seen.place_a);
    const Vec3 b = end(seen.b, seen.joint->b, seen.point_b, seen.place_b);
    const bool spring = def.stiffness.has_value();
    const std::vector<Vec3> line = spring ? coil_line(a, b, 5.0f * subject.rod_radius, 10)
                                          : hanging_line(a, b, def.max_length.value_or(0.0f),
                                                         normalized(world.gravity(), Vec3{0, -1, 0}));
    constexpr int kSides = 12;
    const auto first = std::uint32_t(list.vertices.size());
    const std::vector<TubePoint> rings = tube_rings(line, subject.rod_radius, kSides);
    for (const TubePoint& point : rings) {
      list.vertices.push_back(
          {point.position, point.normal, {kRodColor.red, kRodColor.green, kRodColor.blue}, Paint::matter});
    }
    add_quads(list, first, std::uint32_t(line.size()), kSides + 1);
  }
}

}  // namespace gyre
