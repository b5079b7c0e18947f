// Triangles against triangles, and planes. See surface_overlap.h.
#include "geometry/query/surface_overlap.h"

#include "geometry/query/cast_surface.h"
#include "math/rotation.h"

namespace gyre {
namespace {

// relative to the size of a box: above the error of rotating it in float
constexpr float kRotationSlack = 1.0e-5f;
// Sine below which two half-spaces have opposite normals; they are then separated only if their planes are.
constexpr float kOpposite = 1.0e-6f;

struct Corners {
  DVec3 v[3];
};

bool are_separated(const Corners& a, const Corners& b, DVec3 axis) {
  const double a0 = dot(axis, a.v[0]), a1 = dot(axis, a.v[1]), a2 = dot(axis, a.v[2]);
  const double b0 = dot(axis, b.v[0]), b1 = dot(axis, b.v[1]), b2 = dot(axis, b.v[2]);
  return max(a0, max(a1, a2)) < min(b0, min(b1, b2)) || max(b0, max(b1, b2)) < min(a0, min(a1, a2));
}

// Axes: the normals, the cross products of edges, and, for triangles in one plane, the normals of the edges within it.
bool triangles_touch(const Corners& a, const Corners& b) {
  DVec3 edge_a[3], edge_b[3];
  for (int i = 0; i < 3; ++i) {
    edge_a[i] = a.v[(i + 1) % 3] - a.v[i];
    edge_b[i] = b.v[(i + 1) % 3] - b.v[i];
  }
  const DVec3 normal_a = cross(edge_a[0], edge_a[1]), normal_b = cross(edge_b[0], edge_b[1]);
  if (are_separated(a, b, normal_a) || are_separated(a, b, normal_b)) return false;
  for (int i = 0; i < 3; ++i) {
    for (int k = 0; k < 3; ++k) {
      if (are_separated(a, b, cross(edge_a[i], edge_b[k]))) return false;
    }
    if (are_separated(a, b, cross(normal_a, edge_a[i])) || are_separated(a, b, cross(normal_b, edge_b[i])))
      return false;
  }
  return true;
}

// True if test(triangle) holds for any triangle whose box may meet `box`. Holes of a height field are skipped.
template <class Test>
bool any_triangle(const Shape& surface, const Aabb& box, Test&& test) {
  bool found = false;
  if (surface.kind == ShapeKind::mesh) {
    walk_overlaps(
        surface.mesh->tree, box, [&](std::uint32_t, int) { return !found; },
        [&](std::uint32_t first, std::uint32_t count) {
          for (std::uint32_t id = first; id < first + count && !found; ++id)
            found = test(surface_triangle(*surface.mesh, id));
        });
    return found;
  }
  walk_cells(
      *surface.field, box, [&](HeightBlock) { return !found; },
      [&](std::uint32_t column, std::uint32_t row) {
        if (!is_solid_cell(*surface.field, column, row)) return;
        for (int half = 0; half < 2 && !found; ++half)
          found = test(surface_triangle(*surface.field, column, row, half));
      });
  return found;
}

Aabb grown(const Aabb& box) {
  const float slack = kRotationSlack * largest(max(box.high, -box.low));
  return {box.low - Vec3{slack, slack, slack}, box.high + Vec3{slack, slack, slack}};
}

std::uint64_t triangle_count(const Shape& surface) {
  if (surface.kind == ShapeKind::mesh) return surface.mesh->triangle_count();
  return 2 * std::uint64_t(surface.field->cell_columns()) * surface.field->cell_rows();
}

// `few` must have no more triangles than `many`.
bool meet(const Shape& many, const Shape& few, const Transform& many_from_few) {
  const Aabb search_box = grown(bounds(many, inverse(many_from_few)));
  const DQuat rotation = normalized(to_double(many_from_few.orientation));
  const DVec3 position(many_from_few.position);
  return any_triangle(few, search_box, [&](const SurfaceTriangle& one) {
    const Corners corners{{position + rotate(rotation, DVec3(one.a)),
                           position + rotate(rotation, DVec3(one.b)),
                           position + rotate(rotation, DVec3(one.c))}};
    const Vec3 p = to_float(corners.v[0]), q = to_float(corners.v[1]), r = to_float(corners.v[2]);
    const Aabb box = grown({min(p, min(q, r)), max(p, max(q, r))});
    return any_triangle(many, box, [&](const SurfaceTriangle& other) {
      return triangles_touch(corners, {{DVec3(other.a), DVec3(other.b), DVec3(other.c)}});
    });
  });
}

bool is_partly_below(const Shape& plane, const Shape& surface, const Transform& plane_from_surface) {
  const DQuat rotation = normalized(to_double(plane_from_surface.orientation));
  const DVec3 normal = rotate_inverse(rotation, DVec3(plane.extents));
  const double level = double(plane.offset) - dot(DVec3(plane.extents), DVec3(plane_from_surface.position));
  return any_triangle(surface, grown(bounds(surface, {})), [&](const SurfaceTriangle& t) {
    return min(dot(normal, DVec3(t.a)), min(dot(normal, DVec3(t.b)), dot(normal, DVec3(t.c)))) <= level;
  });
}

bool half_spaces_meet(const Shape& a, const Shape& b, const Transform& a_from_b) {
  const Vec3 normal = rotate(a_from_b.orientation, b.extents);
  if (length(a.extents + normal) > kOpposite) return true;
  return -(b.offset + dot(normal, a_from_b.position)) <= a.offset;
}

}  // namespace

bool surfaces_overlap(const Shape& a, const Shape& b, const Transform& a_from_b) {
  const bool plane_a = a.kind == ShapeKind::plane, plane_b = b.kind == ShapeKind::plane;
  if (plane_a && plane_b) return half_spaces_meet(a, b, a_from_b);
  if (plane_a) return is_partly_below(a, b, a_from_b);
  if (plane_b) return is_partly_below(b, a, inverse(a_from_b));
  return triangle_count(b) <= triangle_count(a) ? meet(a, b, a_from_b) : meet(b, a, inverse(a_from_b));
}

}  // namespace gyre
