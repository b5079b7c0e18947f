// The best direction between a convex shape and one triangle of a surface, and whether the surface allows it.
//
// A direction is allowed if it is a normal of the SURFACE and not of the triangle alone: the normal of the face; at a
// convex or open edge, the arc between the normals of its two faces; at a corner, the cone that all its edges leave
// free. The triangle alone would also offer directions across its flat and concave edges, which are the ghost
// collisions. manifold_mesh, which knows all triangles, decides if such a contact gets the normal of the face or
// belongs to a neighbour.
//
// In: a triangle and a convex shape in the form of local_convex.h. Out: the largest separation along any direction, and
// the best allowed feature.
//
// Sources: C. Ericson, "Real-Time Collision Detection", 2005, chapter 5 (separating axes); D. Gregorius, "The
// Separating Axis Test between Convex Polyhedra", GDC 2013 (edge pairs by arcs on the Gauss map).
#pragma once

#include "geometry/manifold_mesh/local_convex.h"
#include "geometry/shape/height_field.h"
#include "geometry/shape/mesh.h"

namespace gyre {

// The mesh or the height field; the other is null.
struct Surface {
  const Mesh* mesh = nullptr;
  const HeightField* field = nullptr;

  explicit Surface(const Shape& shape);
  // A box around the triangle that is quick to compute.
  Aabb box(std::uint32_t id) const {
    if (mesh != nullptr) return triangle_box(*mesh, id);
    const std::uint32_t cell = id / 2;
    return block_box(*field, {-1, cell % field->cell_columns(), cell / field->cell_columns()});
  }
  BareTriangle bare_triangle(std::uint32_t id) const {
    return mesh != nullptr ? gyre::bare_triangle(*mesh, id) : gyre::bare_triangle(*field, id);
  }
  bool in_normal_cone(std::uint32_t id, int corner, Vec3 direction, float tolerance) const {
    return mesh != nullptr ? gyre::in_normal_cone(*mesh, id, corner, direction, tolerance)
                           : gyre::in_normal_cone(*field, id, corner, direction, tolerance);
  }
  bool double_sided() const { return mesh != nullptr && mesh->double_sided; }
  TriangleView triangle(std::uint32_t id) const {
    return mesh != nullptr ? view_triangle(*mesh, id) : view_triangle(*field, id);
  }
};

// A triangle relative to the origin of the convex shape, with the measures of its edges.
struct LocalTriangle : TriangleView {
  // Set by measure_edges(), and not cleared before.
  union {
    Vec3 along[3];  // unit, from v[i] to the next corner
  };
  float length[3];
  union {
    Vec3 outward[3];  // unit, in the plane, away from the triangle
  };
  float slack = 0.0f;    // m, the rounding error of the corners
  bool flipped = false;  // seen from behind: corners 1 and 2 are exchanged

  LocalTriangle() {}
};

// The triangle without the measures of its edges. `position` is that of the convex shape. A double-sided surface shows
// the side on which the centre of the shape lies.
LocalTriangle local_triangle(const Surface& surface, std::uint32_t id, Vec3 position,
                             const LocalConvex& convex);
void measure_edges(LocalTriangle& triangle);
inline LocalTriangle measured_triangle(const Surface& surface, std::uint32_t id, Vec3 position,
                                       const LocalConvex& convex) {
  LocalTriangle triangle = local_triangle(surface, id, position, convex);
  measure_edges(triangle);
  return triangle;
}

// Relative to the size of the shape: directions whose separations differ by less are equally good. A corner or an edge
// that is worse than the best direction by more is not reported.
constexpr float kAxisBias = 5.0e-4f;

enum class AxisSource : std::uint8_t {
  shape_face,  // the normal of a face of the shape
  shape_edge,  // an edge of the shape across an edge of the triangle
  // between the closest points of triangle and core, or the deepest points of an overlap with a curved core
  nearest_pair,
};

// A corner or edge of the triangle at which shape and surface may touch, and the direction.
struct FeatureAxis {
  float separation = -__builtin_huge_valf();  // of the surfaces; -infinity if there is no feature
  Vec3 direction;                             // unit, from the triangle to the convex shape
  unsigned corners = 0;  // bits of the triangle's corners: one for a corner, two for an edge
  AxisSource source = AxisSource::shape_face;
  int from = 0, to = 0;  // shape_edge: vertices of the shape
  Vec3 on_core;          // nearest_pair: the point of the core
};

struct AxisSearch {
  float best = -__builtin_huge_valf();  // the largest separation along any direction, allowed or not
  FeatureAxis feature;                  // the best allowed direction other than the normal of the face
  bool over_face = false;  // the closest point of the core, if it was searched, lies over the face
  Vec3 on_core;            // that point
};

// Buffers that are reused from triangle to triangle: the triangle in the form that GJK takes; the distances of each
// corner and of the whole triangle before each face of a polyhedron; and the components of the face normals along the
// edges of the triangle.
struct AxisScratch {
  Hull triangle;
  float before[3][LocalConvex::kMaxVertices], before_face[LocalConvex::kMaxVertices];
  float along[3][LocalConvex::kMaxVertices];
};

// Tests all directions but the normal of the face, along which the caller knows the separation of the surfaces. Ends
// early once a separation is above `max_separation`.
AxisSearch search_axes(const Surface& surface, const LocalTriangle& triangle, const LocalConvex& convex,
                       float face_separation, float max_separation, AxisScratch& scratch);

// The same by the closest points alone, for shapes that are apart. It also finds the directions between a corner and an
// edge or a corner, which an axis search over polyhedra does not know.
AxisSearch search_nearest(const Surface& surface, const LocalTriangle& triangle, const LocalConvex& convex,
                          float face_separation, float max_separation, AxisScratch& scratch);

}  // namespace gyre
