// add_wireframe: edges and outlines of a shape in its own frame. See <gyre/debug.h>.
#include "base/float_mode.h"
#include "debug/flat.h"
#include "geometry/shape/cooked.h"
#include "geometry/shape/height_field.h"
#include "geometry/shape/hull.h"
#include "geometry/shape/mesh.h"

#include <gyre/debug.h>

namespace gyre {

namespace {

// Half the side of the drawn part of a plane, and its grid.
constexpr float kPlaneHalf = 10.0f;  // m
constexpr int kPlaneCells = 10;
constexpr int kMinSegments = 4;
constexpr int kMaxSegments = 1024;

class Wire {
 public:
  Wire(std::vector<float>& lines, int segments)
      : lines_(lines),
        segments_(segments < kMinSegments ? kMinSegments
                                          : (segments > kMaxSegments ? kMaxSegments : segments)) {}

  void line(Vec3 from, Vec3 to) {
    append(lines_, from);
    append(lines_, to);
  }
  // An arc from `u` over `quarters` quarter turns towards `v`; both have the length of the radius.
  void arc(Vec3 center, Vec3 u, Vec3 v, int quarters) {
    const int count = (segments_ * quarters + 3) / 4;
    Vec3 from = center + u;
    for (int i = 1; i <= count; ++i) {
      const SinCos angle = sin_cos(0.5f * kPi * float(quarters) * float(i) / float(count));
      // A circle ends exactly at its first point.
      const Vec3 to = i == count && quarters == 4 ? center + u : center + angle.cos * u + angle.sin * v;
      line(from, to);
      from = to;
    }
  }
  void circle(Vec3 center, Vec3 u, Vec3 v) { arc(center, u, v, 4); }

  void shape(const Sphere& s) {
    const Vec3 x{s.radius, 0, 0}, y{0, s.radius, 0}, z{0, 0, s.radius};
    circle({}, x, y);
    circle({}, y, z);
    circle({}, z, x);
  }
  void shape(const Box& box);
  void shape(const Capsule& c);
  void shape(const Cylinder& c);
  void shape(const Cone& c);
  void shape(const Plane& plane);
  void shape(const Geometry& cooked);

 private:
  void box_edges(Vec3 inner, float rounding);
  void box_corners(Vec3 inner, float rounding);
  void mesh(const Mesh& mesh);
  void field(const HeightField& field);

  std::vector<float>& lines_;
  int segments_;
};

constexpr Vec3 unit(int axis, float length) {
  return {axis == 0 ? length : 0.0f, axis == 1 ? length : 0.0f, axis == 2 ? length : 0.0f};
}

// Each edge of the inner box, moved outward along both of its faces; without rounding the two lines coincide.
void Wire::box_edges(Vec3 inner, float rounding) {
  for (int axis = 0; axis < 3; ++axis) {
    const int u = (axis + 1) % 3, v = (axis + 2) % 3;
    const Vec3 along = unit(axis, inner[axis]);
    for (int corner = 0; corner < 4; ++corner) {
      const float su = (corner & 1) != 0 ? 1.0f : -1.0f, sv = (corner & 2) != 0 ? 1.0f : -1.0f;
      const Vec3 middle = unit(u, su * inner[u]) + unit(v, sv * inner[v]);
      const Vec3 out_u = unit(u, su * rounding), out_v = unit(v, sv * rounding);
      line(middle + out_u - along, middle + out_u + along);
      if (rounding > 0.0f) line(middle + out_v - along, middle + out_v + along);
    }
  }
}

void Wire::box_corners(Vec3 inner, float rounding) {
  for (int corner = 0; corner < 8; ++corner) {
    const Vec3 sign{(corner & 1) != 0 ? 1.0f : -1.0f, (corner & 2) != 0 ? 1.0f : -1.0f,
                    (corner & 4) != 0 ? 1.0f : -1.0f};
    const Vec3 center = multiply_each(sign, inner);
    for (int axis = 0; axis < 3; ++axis) {
      const int next = (axis + 1) % 3;
      arc(center, unit(axis, sign[axis] * rounding), unit(next, sign[next] * rounding), 1);
    }
  }
}

void Wire::shape(const Box& box) {
  const Vec3 inner = box.half_extents - Vec3{box.rounding, box.rounding, box.rounding};
  box_edges(inner, box.rounding);
  if (box.rounding > 0.0f) box_corners(inner, box.rounding);
}

void Wire::shape(const Capsule& c) {
  const Vec3 x{c.radius, 0, 0}, y{0, c.radius, 0}, z{0, 0, c.radius};
  const Vec3 end{0, c.half_height, 0};
  for (const float side : {1.0f, -1.0f}) {
    circle(side * end, x, z);
    arc(side * end, x, side * y, 2);
    arc(side * end, z, side * y, 2);
  }
  for (const Vec3 side : {x, -x, z, -z}) line(side - end, side + end);
}

void Wire::shape(const Cylinder& c) {
  const Vec3 x{c.radius, 0, 0}, z{0, 0, c.radius};
  const Vec3 end{0, c.half_height, 0};
  circle(end, x, z);
  circle(-end, x, z);
  for (const Vec3 side : {x, -x, z, -z}) line(side - end, side + end);
}

void Wire::shape(const Cone& c) {
  const Vec3 x{c.radius, 0, 0}, z{0, 0, c.radius};
  const Vec3 end{0, c.half_height, 0};
  circle(-end, x, z);
  for (const Vec3 side : {x, -x, z, -z}) line(side - end, end);
}

void Wire::shape(const Plane& plane) {
  const float size = length(plane.normal);
  if (!(size > 0.0f)) return;
  const Vec3 normal = plane.normal / size;
  const Vec3 middle = (plane.offset / size) * normal;
  const Vec3 u = any_perpendicular(normal), v = cross(normal, u);
  for (int i = 0; i <= kPlaneCells; ++i) {
    const float at = kPlaneHalf * (2.0f * float(i) / float(kPlaneCells) - 1.0f);
    line(middle + at * u - kPlaneHalf * v, middle + at * u + kPlaneHalf * v);
    line(middle + at * v - kPlaneHalf * u, middle + at * v + kPlaneHalf * u);
  }
}

void Wire::mesh(const Mesh& mesh) {
  for (std::uint32_t half = 0; half < mesh.indices.size(); ++half) {
    // The lower half-edge draws an edge of two triangles once.
    if (mesh.twins[half] != Mesh::kNoTwin && mesh.twins[half] < half) continue;
    const std::uint32_t next = half % 3 == 2 ? half - 2 : half + 1;
    line(mesh.vertices[mesh.indices[half]], mesh.vertices[mesh.indices[next]]);
  }
}

void Wire::field(const HeightField& field) {
  const auto solid = [&](std::uint32_t column, std::uint32_t row, int left, int up) {
    return is_solid_cell(field, std::int64_t(column) - left, std::int64_t(row) - up);
  };
  for (std::uint32_t row = 0; row < field.rows; ++row) {
    for (std::uint32_t column = 0; column < field.columns; ++column) {
      const bool is_solid = solid(column, row, 0, 0);
      if (is_solid || solid(column, row, 0, 1))
        line(field.sample(column, row), field.sample(column + 1, row));
      if (is_solid || solid(column, row, 1, 0))
        line(field.sample(column, row), field.sample(column, row + 1));
      if (is_solid) line(field.sample(column, row + 1), field.sample(column + 1, row));
    }
  }
}

void Wire::shape(const Geometry& cooked) {
  if (!cooked) return;
  const CookedGeometry& data = *cooked.data();
  if (data.hull != nullptr) {
    for (const HullEdge& edge : data.hull->edges)
      line(data.hull->vertices[edge.from], data.hull->vertices[edge.to]);
  }
  if (data.mesh != nullptr) mesh(*data.mesh);
  if (data.field != nullptr) field(*data.field);
}

}  // namespace

void add_wireframe(const AnyShape& shape, std::vector<float>& lines, int segments) {
  const FloatMode mode;
  Wire wire(lines, segments);
  std::visit([&](const auto& kind) { wire.shape(kind); }, shape);
}

}  // namespace gyre
