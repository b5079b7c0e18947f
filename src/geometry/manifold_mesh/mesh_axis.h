// Along which direction a convex shape and one triangle of a surface touch, and whether the surface allows that direction.
//
// A direction is allowed if it is a normal of the SURFACE, not only of the triangle: the face's own normal; at a convex or
// open edge the arc between the two faces' normals; at a corner the cone that all edges around it leave free. A triangle
// alone would also offer directions across its flat and concave edges: those are the ghost collisions, and whether the
// contact then turns to the face or belongs to a neighbour is for manifold_mesh to decide, who sees all triangles.
//
// Sources: C. Ericson, "Real-Time Collision Detection", 2005, chapter 5 (separating axes); D. Gregorius, "The Separating Axis
// Test between Convex Polyhedra", GDC 2013 (edge pairs by arcs on the Gauss map).
#pragma once

#include "geometry/shape/height_field.h"
#include "geometry/shape/mesh.h"
#include "geometry/manifold_mesh/local_convex.h"

namespace gyre {

// The mesh or the height field, one of the two.
struct Surface {
  const Mesh* mesh = nullptr;
  const HeightField* field = nullptr;

  explicit Surface(const Shape& shape);
  // A box around the triangle, quick to get.
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

// A triangle moved to the origin of the convex shape, with its edges measured.
struct LocalTriangle : TriangleView {
  // Known once the edges are measured, and not cleared before.
  union {
    Vec3 along[3];  // unit, from v[i] to the next corner
  };
  float length[3];
  union {
    Vec3 outward[3];  // unit, in the plane, away from the triangle
  };
  float slack = 0.0f;   // m: what rounding can do to the places of its corners
  bool turned = false;  // seen from behind: corners 1 and 2 have changed places against the surface's own

  LocalTriangle() {}
};

// The triangle without its edges' measures. `position` is that of the convex shape. A double-sided surface shows the side on
// which the shape's middle lies.
LocalTriangle local_triangle(const Surface& surface, std::uint32_t id, Vec3 position,
                            const LocalConvex& convex);
void measure_edges(LocalTriangle& triangle);
inline LocalTriangle measured_triangle(const Surface& surface, std::uint32_t id, Vec3 position,
                                  const LocalConvex& convex) {
  LocalTriangle triangle = local_triangle(surface, id, position, convex);
  measure_edges(triangle);
  return triangle;
}

// Relative to the size of the shape: directions whose separations differ by less are equally good. A corner or an edge that is
// worse than the best direction by more is of no use and not reported.
constexpr float kAxisBias = 5.0e-4f;

enum class AxisSource : std::uint8_t {
  shape_face,  // the normal of a face of the shape
  shape_edge,  // an edge of the shape across an edge of the triangle
  nearest_pair,  // between the nearest points of triangle and core, or the deepest of an overlap with a curved one
};

// A corner or edge of the triangle where shape and surface may touch, and the direction.
struct FeatureAxis {
  float separation = -__builtin_huge_valf();  // of the surfaces; -infinity: there is none
  Vec3 direction;                             // unit, from the triangle to the convex shape
  unsigned corners = 0;  // bits of the triangle's corners: one for a corner, two for an edge
  AxisSource source = AxisSource::shape_face;
  int from = 0, to = 0;  // shape_edge: vertices of the shape
  Vec3 on_core;          // nearest_pair: the core's point
};

struct AxisSearch {
  float best = -__builtin_huge_valf();  // the largest separation along any direction, allowed or not
  FeatureAxis feature;                  // the best allowed direction besides the face's normal
  bool over_face = false;  // the nearest point of the core, where it was searched for, lies over the face
  Vec3 on_core;            // that point
};

// Room for the triangle in the form that GJK takes, kept between triangles so that it is made once, and for how far the
// triangle lies before each face of a polyhedron: each of its corners, and the whole of it; and for what the faces' normals have
// along its edges.
struct AxisScratch {
  Hull triangle;
  float before[3][LocalConvex::kMaxVertices], before_face[LocalConvex::kMaxVertices];
  float along[3][LocalConvex::kMaxVertices];
};

// Looks at all directions but the face's normal, for which the caller knows the separation of the surfaces. Ends early once
// one separation is above `max_separation`.
AxisSearch search_axes(const Surface& surface, const LocalTriangle& triangle, const LocalConvex& convex,
                       float face_separation, float max_separation, AxisScratch& scratch);

// The same from the nearest points alone, for shapes that are apart: also the directions between a corner and an edge or a
// corner, which an axis search over polyhedra does not know.
AxisSearch search_nearest(const Surface& surface, const LocalTriangle& triangle, const LocalConvex& convex,
                          float face_separation, float max_separation, AxisScratch& scratch);

}  // namespace gyre
