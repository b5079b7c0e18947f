// Shapes as triangles. See shape_mesh.h.
//
// Spheres and boxes, rounded or not, are one thing: a ball cut into eight octants that are moved apart. Capsules, cylinders and
// cones are profiles turned about y. Meshes and height fields get soft normals except across sharp edges.
#include "formats/shape_mesh.h"

#include "formats/turning.h"

#include <algorithm>
#include <cmath>

namespace gyre {
namespace {

constexpr float kDark = 0.72f;
constexpr float kCreaseCosine = 0.8f;  // edges sharper than 37 degrees stay sharp

std::uint32_t add_vertex(ShapeMesh& mesh, Vec3 position, Vec3 normal, float tone = 1.0f) {
  mesh.vertices.push_back({position, normal, tone});
  return std::uint32_t(mesh.vertices.size() - 1);
}

void add_triangle(ShapeMesh& mesh, std::uint32_t a, std::uint32_t b, std::uint32_t c) {
  const Vec3 pa = mesh.vertices[a].position, pb = mesh.vertices[b].position, pc = mesh.vertices[c].position;
  if (pa == pb || pb == pc || pc == pa) return;
  mesh.indices.insert(mesh.indices.end(), {a, b, c});
}

// One of the six faces of a cube, bulged to a ball of radius `rounding` and cut at its middle lines, where the quarters are
// moved apart by `core`. What lies between the quarters is the flat part of the face and the straight part of its edges.
void add_bulged_face(ShapeMesh& mesh, int axis, float side, Vec3 core, float rounding, int steps,
                     bool toned) {
  const int rows = 2 * steps + 2;  // the middle line twice
  const auto first = std::uint32_t(mesh.vertices.size());
  const auto place = [&](int i) {
    const bool beyond = i > steps;
    const float along = float(beyond ? i - steps - 1 : i) / float(steps);  // 0 to 1 within the half
    // Equal angles look more even than equal lengths.
    return std::pair(tangent((beyond ? along : along - 1.0f) * 0.25f * kHalfTurn), beyond ? 1.0f : -1.0f);
  };
  for (int i = 0; i < rows; ++i) {
    for (int k = 0; k < rows; ++k) {
      const auto [u, u_side] = place(i);
      const auto [v, v_side] = place(k);
      // Axes in turn: (axis, next, next but one) is right-handed.
      float direction[3], octant[3];
      direction[axis] = side;
      octant[axis] = side;
      direction[(axis + 1) % 3] = u;
      octant[(axis + 1) % 3] = u_side;
      direction[(axis + 2) % 3] = v;
      octant[(axis + 2) % 3] = v_side;
      const Vec3 normal = normalized(Vec3{direction[0], direction[1], direction[2]});
      const Vec3 moved{octant[0] * core.x, octant[1] * core.y, octant[2] * core.z};
      const bool dark = toned && octant[0] * octant[1] * octant[2] < 0.0f;
      add_vertex(mesh, moved + rounding * normal, normal, dark ? kDark : 1.0f);
    }
  }
  for (int i = 0; i + 1 < rows; ++i) {
    for (int k = 0; k + 1 < rows; ++k) {
      const std::uint32_t a = first + std::uint32_t(i * rows + k), b = a + std::uint32_t(rows), c = b + 1,
                          d = a + 1;
      if (side > 0.0f) {
        add_triangle(mesh, a, b, c);
        add_triangle(mesh, a, c, d);
      } else {
        add_triangle(mesh, a, c, b);
        add_triangle(mesh, a, d, c);
      }
    }
  }
}

ShapeMesh bulged_box(Vec3 half_extents, float rounding, int segments, bool toned) {
  const Vec3 core = half_extents - Vec3{rounding, rounding, rounding};
  const int steps = std::max(1, segments / 8);
  ShapeMesh mesh;
  for (int axis = 0; axis < 3; ++axis) {
    for (const float side : {-1.0f, 1.0f}) {
      add_bulged_face(mesh, axis, side, max(core, Vec3{}), rounding, steps, toned);
    }
  }
  return mesh;
}

ShapeMesh sharp_box(Vec3 h) {
  ShapeMesh mesh;
  for (int axis = 0; axis < 3; ++axis) {
    for (const float side : {-1.0f, 1.0f}) {
      std::uint32_t corner[4];
      for (int k = 0; k < 4; ++k) {
        float place[3], normal[3] = {0, 0, 0};
        normal[axis] = place[axis] = side;
        place[(axis + 1) % 3] = k == 1 || k == 2 ? side : -side;
        place[(axis + 2) % 3] = k >= 2 ? 1.0f : -1.0f;
        corner[k] = add_vertex(mesh, {place[0] * h.x, place[1] * h.y, place[2] * h.z},
                               {normal[0], normal[1], normal[2]});
      }
      add_triangle(mesh, corner[0], corner[1], corner[2]);
      add_triangle(mesh, corner[0], corner[2], corner[3]);
    }
  }
  return mesh;
}

// A point of a profile, from the top down; where the outline has a corner the point stands there twice.
struct ProfilePoint {
  float radius, y;
  float out, up;  // the normal
};

// Each half turn is a part of its own, and the other one is darker.
void turn_profile(ShapeMesh& mesh, const std::vector<ProfilePoint>& profile, int segments) {
  const int half = segments / 2;
  for (int part = 0; part < 2; ++part) {
    const auto first = std::uint32_t(mesh.vertices.size());
    for (int i = 0; i <= half; ++i) {
      const Turn turn = turn_of(float(part) * kHalfTurn + kHalfTurn * float(i) / float(half));
      for (const ProfilePoint& point : profile) {
        add_vertex(mesh, {point.radius * turn.cosine, point.y, -point.radius * turn.sine},
                   {point.out * turn.cosine, point.up, -point.out * turn.sine}, part == 0 ? 1.0f : kDark);
      }
    }
    const auto count = std::uint32_t(profile.size());
    for (std::uint32_t i = 0; i < std::uint32_t(half); ++i) {
      for (std::uint32_t k = 0; k + 1 < count; ++k) {
        const std::uint32_t a = first + i * count + k, b = a + 1, c = b + count, d = a + count;
        add_triangle(mesh, a, b, c);
        add_triangle(mesh, a, c, d);
      }
    }
  }
}

ShapeMesh capsule_mesh(const Capsule& s, int segments) {
  std::vector<ProfilePoint> profile;
  const int quarter = segments / 4;
  for (const float side : {1.0f, -1.0f}) {
    for (int i = 0; i <= quarter; ++i) {
      const Turn turn = turn_of(0.5f * kHalfTurn * float(side > 0 ? i : quarter - i) / float(quarter));
      profile.push_back({s.radius * turn.sine, side * (s.half_height + s.radius * turn.cosine), turn.sine,
                         side * turn.cosine});
    }
  }
  ShapeMesh mesh;
  turn_profile(mesh, profile, segments);
  return mesh;
}

ShapeMesh cylinder_mesh(const Cylinder& s, int segments) {
  ShapeMesh mesh;
  turn_profile(mesh,
               {{0, s.half_height, 0, 1},
                {s.radius, s.half_height, 0, 1},
                {s.radius, s.half_height, 1, 0},
                {s.radius, -s.half_height, 1, 0},
                {s.radius, -s.half_height, 0, -1},
                {0, -s.half_height, 0, -1}},
               segments);
  return mesh;
}

ShapeMesh cone_mesh(const Cone& s, int segments) {
  const Vec3 slope = normalized(Vec3{2.0f * s.half_height, s.radius, 0});
  ShapeMesh mesh;
  turn_profile(mesh,
               {{0, s.half_height, slope.x, slope.y},
                {s.radius, -s.half_height, slope.x, slope.y},
                {s.radius, -s.half_height, 0, -1},
                {0, -s.half_height, 0, -1}},
               segments);
  return mesh;
}

ShapeMesh hull_mesh(const HullView& hull) {
  ShapeMesh mesh;
  for (std::size_t face = 0; face + 1 < hull.face_offsets.size(); ++face) {
    const std::uint32_t begin = hull.face_offsets[face], end = hull.face_offsets[face + 1];
    const auto corner = [&](std::uint32_t i) { return hull.vertices[hull.face_indices[i]]; };
    Vec3 area;
    for (std::uint32_t i = begin + 1; i + 1 < end; ++i) {
      area = area + cross(corner(i) - corner(begin), corner(i + 1) - corner(begin));
    }
    const Vec3 normal = normalized(area);
    const auto first = std::uint32_t(mesh.vertices.size());
    for (std::uint32_t i = begin; i < end; ++i) add_vertex(mesh, corner(i), normal);
    for (std::uint32_t i = 1; i + 1 < end - begin; ++i) add_triangle(mesh, first, first + i, first + i + 1);
  }
  return mesh;
}

ShapeMesh height_field_mesh(const HeightFieldView& field) {
  std::vector<Vec3> vertices;
  std::vector<std::uint32_t> indices;
  const float left = -0.5f * float(field.columns - 1) * field.spacing;
  const float front = -0.5f * float(field.rows - 1) * field.spacing;
  for (std::uint32_t row = 0; row < field.rows; ++row) {
    for (std::uint32_t column = 0; column < field.columns; ++column) {
      const float height = field.heights[std::size_t(row) * field.columns + column];
      // No triangle uses the corner of a hole; its place only has to be a number.
      vertices.push_back({left + float(column) * field.spacing, std::isnan(height) ? 0.0f : height,
                          front + float(row) * field.spacing});
    }
  }
  const auto is_hole = [&](std::uint32_t vertex) { return std::isnan(field.heights[vertex]); };
  for (std::uint32_t row = 0; row + 1 < field.rows; ++row) {
    for (std::uint32_t column = 0; column + 1 < field.columns; ++column) {
      const std::uint32_t a = row * field.columns + column, b = a + 1, c = a + field.columns, d = c + 1;
      if (is_hole(a) || is_hole(b) || is_hole(c) || is_hole(d)) continue;
      indices.insert(indices.end(), {a, c, b, b, c, d});
    }
  }
  return smooth_mesh(vertices, indices, kCreaseCosine);
}

ShapeMesh cooked_mesh(const Geometry& geometry) {
  switch (geometry.kind()) {
    case ShapeKind::hull:
      return hull_mesh(view_hull(geometry));
    case ShapeKind::mesh: {
      const MeshView view = view_mesh(geometry);
      return smooth_mesh(view.vertices, view.indices, kCreaseCosine);
    }
    case ShapeKind::height_field:
      return height_field_mesh(view_height_field(geometry));
    default:
      return {};
  }
}

Aabb box_of(std::span<const Vec3> points) {
  if (points.empty()) return {{1, 1, 1}, {-1, -1, -1}};
  Aabb box{points[0], points[0]};
  for (const Vec3 point : points) box = {min(box.low, point), max(box.high, point)};
  return box;
}

Aabb box_of(const HeightFieldView& field) {
  const float x = 0.5f * float(field.columns - 1) * field.spacing,
              z = 0.5f * float(field.rows - 1) * field.spacing;
  Aabb box{{-x, 1, -z}, {x, -1, z}};
  bool any = false;
  for (const float height : field.heights) {
    if (std::isnan(height)) continue;
    box.low.y = any ? min(box.low.y, height) : height;
    box.high.y = any ? max(box.high.y, height) : height;
    any = true;
  }
  return any ? box : Aabb{{1, 1, 1}, {-1, -1, -1}};
}

Aabb box_of(const Geometry& geometry) {
  switch (geometry.kind()) {
    case ShapeKind::hull:
      return box_of(view_hull(geometry).vertices);
    case ShapeKind::mesh:
      return box_of(view_mesh(geometry).vertices);
    default:
      return box_of(view_height_field(geometry));
  }
}

struct MeshMaker {
  int segments;
  ShapeMesh operator()(const Sphere& s) const {
    return bulged_box({s.radius, s.radius, s.radius}, s.radius, segments, true);
  }
  ShapeMesh operator()(const Box& s) const {
    return s.rounding > 0.0f ? bulged_box(s.half_extents, s.rounding, segments, false)
                             : sharp_box(s.half_extents);
  }
  ShapeMesh operator()(const Capsule& s) const { return capsule_mesh(s, segments); }
  ShapeMesh operator()(const Cylinder& s) const { return cylinder_mesh(s, segments); }
  ShapeMesh operator()(const Cone& s) const { return cone_mesh(s, segments); }
  ShapeMesh operator()(const Plane&) const { return {}; }
  ShapeMesh operator()(const Geometry& geometry) const { return cooked_mesh(geometry); }
};

struct BoxMaker {
  static Aabb around(Vec3 half) { return {-half, half}; }
  Aabb operator()(const Sphere& s) const { return around({s.radius, s.radius, s.radius}); }
  Aabb operator()(const Box& s) const { return around(s.half_extents); }
  Aabb operator()(const Capsule& s) const { return around({s.radius, s.half_height + s.radius, s.radius}); }
  Aabb operator()(const Cylinder& s) const { return around({s.radius, s.half_height, s.radius}); }
  Aabb operator()(const Cone& s) const { return around({s.radius, s.half_height, s.radius}); }
  Aabb operator()(const Plane&) const { return {{1, 1, 1}, {-1, -1, -1}}; }
  Aabb operator()(const Geometry& geometry) const { return box_of(geometry); }
};

struct RoundingMaker {
  float operator()(const Sphere& s) const { return s.radius; }
  float operator()(const Box& s) const { return s.rounding; }
  float operator()(const Capsule& s) const { return s.radius; }
  float operator()(const Cylinder& s) const { return s.radius; }
  float operator()(const Cone& s) const { return s.radius; }
  float operator()(const Plane&) const { return 0; }
  float operator()(const Geometry&) const { return 0; }
};

}  // namespace

ShapeMesh smooth_mesh(std::span<const Vec3> vertices, std::span<const std::uint32_t> indices,
                      float crease_cosine) {
  const std::size_t triangles = indices.size() / 3;
  std::vector<Vec3> areas(triangles), normals(triangles);
  std::vector<std::uint32_t> offsets(vertices.size() + 1), around(indices.size());
  for (std::size_t t = 0; t < triangles; ++t) {
    const Vec3 a = vertices[indices[3 * t]], b = vertices[indices[3 * t + 1]],
               c = vertices[indices[3 * t + 2]];
    areas[t] = cross(b - a, c - a);
    normals[t] = normalized(areas[t]);
  }
  for (const std::uint32_t index : indices) ++offsets[index + 1];
  for (std::size_t i = 1; i < offsets.size(); ++i) offsets[i] += offsets[i - 1];
  std::vector<std::uint32_t> next(offsets.begin(), offsets.end() - 1);
  for (std::size_t i = 0; i < indices.size(); ++i) around[next[indices[i]]++] = std::uint32_t(i / 3);

  ShapeMesh mesh;
  mesh.vertices.reserve(indices.size());
  mesh.indices.reserve(indices.size());
  for (std::size_t i = 0; i < indices.size(); ++i) {
    const std::uint32_t vertex = indices[i];
    Vec3 sum;
    for (std::uint32_t k = offsets[vertex]; k < offsets[vertex + 1]; ++k) {
      if (dot(normals[around[k]], normals[i / 3]) > crease_cosine) sum = sum + areas[around[k]];
    }
    mesh.indices.push_back(add_vertex(mesh, vertices[vertex], normalized(sum)));
  }
  return mesh;
}

ShapeMesh make_shape_mesh(const AnyShape& shape, int segments) {
  return std::visit(MeshMaker{(std::max(segments, 8) + 7) / 8 * 8}, shape);
}

Aabb bounding_box(const AnyShape& shape) { return std::visit(BoxMaker{}, shape); }

float bounding_radius(const AnyShape& shape) {
  if (std::holds_alternative<Plane>(shape)) return 0.0f;
  if (const Sphere* sphere = std::get_if<Sphere>(&shape)) return sphere->radius;
  const Aabb box = bounding_box(shape);
  if (box.low.x > box.high.x) return 0.0f;  // a height field that is one hole
  return length(max(-box.low, box.high));
}

float rounding_radius(const AnyShape& shape) { return std::visit(RoundingMaker{}, shape); }

}  // namespace gyre
