// Rays against the triangles of meshes and height fields: the part of cast.h that walks trees.
#pragma once

#include "geometry/query/box_cast.h"
#include "geometry/query/cast.h"
#include "geometry/shape/mesh.h"

namespace gyre {

// The crossing of a ray with triangles, so that a ray that meets an edge or a corner meets at least one of the triangles
// around it: all of them see the same sheared corners, and an edge counts to both sides.
class TriangleRay {
 public:
  explicit TriangleRay(const LocalRay& ray);

  // The fraction at which the triangle's plane is crossed inside the triangle, if there is one. `front`: the corners
  // run counter-clockwise seen from the ray's origin.
  bool crosses(Vec3 a, Vec3 b, Vec3 c, double& fraction, bool& front) const;

 private:
  DVec3 sheared(Vec3 corner) const;

  DVec3 origin_;
  int x_, y_, z_;  // axes: z is the one along which the ray runs most
  double shear_x_ = 0.0, shear_y_ = 0.0, scale_ = 0.0;
};

bool cast_ray_at_surface(const Shape& surface, const LocalRay& ray, double reach, bool back_faces,
                         LocalHit& hit);

// The box of the mesh or field, and the part of a way from `origin` (of a box of half size `half`) that can meet it: false if
// none can. `from` and `to` are fractions, 0 <= from <= to <= reach.
bool clip_to_surface(const Shape& surface, const LocalRay& ray, Vec3 half, double reach, double& from,
                     double& to);

// The corners of a triangle of a mesh or height field, and what the answers call it.
struct SurfaceTriangle {
  std::uint32_t id;  // within the surface
  Vec3 a, b, c;      // counter-clockwise seen from the front
};
inline SurfaceTriangle surface_triangle(const Mesh& mesh, std::uint32_t id) {
  const std::uint32_t* corner = mesh.indices.data() + 3 * std::size_t(id);
  return {id, mesh.vertices[corner[0]], mesh.vertices[corner[1]], mesh.vertices[corner[2]]};
}
// `half`: 0 or 1, the one on the side of the cell's lower corner first.
inline SurfaceTriangle surface_triangle(const HeightField& field, std::uint32_t column, std::uint32_t row,
                                        int half) {
  const std::uint32_t id = 2 * (row * field.cell_columns() + column) + std::uint32_t(half);
  const Vec3 near_z = field.sample(column, row + 1), near_x = field.sample(column + 1, row);
  if (half == 0) return {id, field.sample(column, row), near_z, near_x};
  return {id, near_x, near_z, field.sample(column + 1, row + 1)};
}
// The number of a triangle as the user gave it.
inline std::uint32_t public_triangle(const Shape& surface, std::uint32_t id) {
  return surface.kind == ShapeKind::mesh ? surface.mesh->source[id] : id;
}
inline bool is_double_sided(const Shape& surface) {
  return surface.kind == ShapeKind::mesh && surface.mesh->double_sided;
}
// Unit, outward.
Vec3 surface_normal(const Shape& surface, const SurfaceTriangle& triangle);

// Calls visit(triangle, reach) for those whose box is met by a box of half size `half` (0: a ray) that moves from the ray's
// origin along it, roughly from near to far; visit returns the new reach, never more than the old one. Fractions of the whole
// way.
template <class Visit>
void walk_triangles(const Shape& surface, const LocalRay& ray, Vec3 half, double reach, Visit&& visit) {
  double from, to;
  if (!clip_to_surface(surface, ray, half, reach, from, to)) return;
  // Moved near the surface, so that the floats of the walk are no larger than its coordinates.
  const double piece = to - from;
  const BoxRay line(ray.origin + from * ray.way, piece * ray.way, half);
  const auto piece_reach = [&](double whole) {
    return piece > 0.0 ? float(clamp((whole - from) / piece, 0.0, 1.0)) * 1.000001f + 1.0e-30f : 1.0f;
  };
  if (surface.kind == ShapeKind::mesh) {
    traverse_cast(surface.mesh->tree, line, 1.0f, [&](std::uint32_t first, std::uint32_t count, float walked) {
      for (std::uint32_t id = first; id < first + count; ++id)
        reach = visit(surface_triangle(*surface.mesh, id), reach);
      return min(walked, piece_reach(reach));
    });
    return;
  }
  traverse_cast(*surface.field, line, 1.0f, [&](std::uint32_t column, std::uint32_t row, float walked) {
    for (int side = 0; side < 2; ++side)
      reach = visit(surface_triangle(*surface.field, column, row, side), reach);
    return min(walked, piece_reach(reach));
  });
}

}  // namespace gyre
