// Rays against the triangles of meshes and height fields: the part of cast.h that traverses trees.
#pragma once

#include "geometry/query/box_cast.h"
#include "geometry/query/cast.h"
#include "geometry/query/triangle_ray.h"
#include "geometry/shape/mesh.h"

namespace gyre {

bool cast_ray_at_surface(const Shape& surface, const LocalRay& ray, double max_fraction, bool back_faces,
                         LocalHit& hit);

// Clips a ray, or a moving box of half size `half`, to the box of the mesh or field. Returns false if they do not meet.
// `from` and `to` are fractions, 0 <= from <= to <= max_fraction.
bool clip_to_surface(const Shape& surface, const LocalRay& ray, Vec3 half, double max_fraction, double& from,
                     double& to);

// The corners of a triangle of a mesh or height field, and its number.
struct SurfaceTriangle {
  std::uint32_t id;  // within the surface
  Vec3 a, b, c;      // counter-clockwise seen from the front
};
inline SurfaceTriangle surface_triangle(const Mesh& mesh, std::uint32_t id) {
  const std::uint32_t* corner = mesh.indices.data() + 3 * std::size_t(id);
  return {id, mesh.vertices[corner[0]], mesh.vertices[corner[1]], mesh.vertices[corner[2]]};
}
// `half` is 0 or 1; 0 is the triangle at the lower corner of the cell.
inline SurfaceTriangle surface_triangle(const HeightField& field, std::uint32_t column, std::uint32_t row,
                                        int half) {
  const std::uint32_t id = 2 * (row * field.cell_columns() + column) + std::uint32_t(half);
  const Vec3 near_z = field.sample(column, row + 1), near_x = field.sample(column + 1, row);
  if (half == 0) return {id, field.sample(column, row), near_z, near_x};
  return {id, near_x, near_z, field.sample(column + 1, row + 1)};
}
// The number of a triangle in the user's definition.
inline std::uint32_t public_triangle(const Shape& surface, std::uint32_t id) {
  return surface.kind == ShapeKind::mesh ? surface.mesh->source[id] : id;
}
inline bool is_double_sided(const Shape& surface) {
  return surface.kind == ShapeKind::mesh && surface.mesh->double_sided;
}
// The normal of a triangle: unit, outward.
Vec3 surface_normal(const Shape& surface, const SurfaceTriangle& triangle);

// Calls visit(triangle, max_fraction) for each triangle whose box is met by a moving box of half size `half` (0: a
// ray), roughly from near to far. visit returns the new max_fraction, never more than the old one. All fractions are of
// the whole ray.
template <class Visit>
void walk_triangles(const Shape& surface, const LocalRay& ray, Vec3 half, double max_fraction,
                    Visit&& visit) {
  double from, to;
  if (!clip_to_surface(surface, ray, half, max_fraction, from, to)) return;
  // The traversal starts near the surface, so that its floats are no larger than the coordinates there.
  const double clipped_length = to - from;
  const BoxRay line(ray.origin + from * ray.translation, clipped_length * ray.translation, half);
  const auto clipped_fraction = [&](double full) {
    return clipped_length > 0.0
               ? float(clamp((full - from) / clipped_length, 0.0, 1.0)) * 1.000001f + 1.0e-30f
               : 1.0f;
  };
  if (surface.kind == ShapeKind::mesh) {
    traverse_cast(surface.mesh->tree, line, 1.0f,
                  [&](std::uint32_t first, std::uint32_t count, float walked) {
                    for (std::uint32_t id = first; id < first + count; ++id)
                      max_fraction = visit(surface_triangle(*surface.mesh, id), max_fraction);
                    return min(walked, clipped_fraction(max_fraction));
                  });
    return;
  }
  traverse_cast(*surface.field, line, 1.0f, [&](std::uint32_t column, std::uint32_t row, float walked) {
    for (int side = 0; side < 2; ++side)
      max_fraction = visit(surface_triangle(*surface.field, column, row, side), max_fraction);
    return min(walked, clipped_fraction(max_fraction));
  });
}

}  // namespace gyre
