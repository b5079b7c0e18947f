// The axis along which two convex polyhedra are farthest apart, or overlap least: every face normal of both, and the cross
// products of those pairs of edges that make a face of the Minkowski difference.
//
// In: two polytopes, where B is in A's frame, and the axis that decided last time. Out: the axis, or the first one along
// which they are farther apart than asked. Exact on overlapping polyhedra; on separated ones never more than the distance.
//
// Edges are looked at only where they can still win: the two points in which a winning pair of edges meets are no farther
// apart than the best face's depth, so both edges must come that near to the face's plane. Two normals' arcs that do not
// cross on the Gauss map make no face of the difference. And nothing at all is looked at where the nearest vertex lies over
// the middle of a face that was favoured or is best of all, or where favoured edges cross amid both: no axis parts the two by
// more.
//
// Sources: D. Gregorius, "The Separating Axis Test between Convex Polyhedra", GDC 2013; D. Eberly, "Dynamic Collision
// Detection using Oriented Bounding Boxes", for what the axes of a pair are.
#pragma once

#include "geometry/shape/polytope.h"

namespace gyre {

enum class AxisKind : std::uint8_t { none, face_a, face_b, edges };

struct PolytopeAxis {
  AxisKind kind = AxisKind::none;
  int index_a = 0;  // face or edge of A
  int index_b = 0;  // face or edge of B
  int vertex = 0;   // faces: the vertex of the other polytope that is nearest
  Vec3 normal;      // unit, from A to B, in A's frame
  float separation = -kUnbounded;
  float edge_separation =
      -kUnbounded;  // edges: the separation of the two alone, which is that of the polytopes where they meet
};

// A 32-bit name of the axis for PairCache, and back. 0 is none; names that fit no feature of the two come back as none.
std::uint32_t axis_name(const PolytopeAxis& axis);
PolytopeAxis axis_of_name(std::uint32_t name, const Polytope& a, const Polytope& b);

// How far the two are apart along a named axis (its `normal`, `vertex` and `edge_separation` are filled too). Exact along the axis.
float separation_along(const Polytope& a, const Polytope& b, const Transform& a_from_b, PolytopeAxis& axis);

// Faces win over edges, and `favoured`, of which separation_along has been asked, over others, when nearly equal.
PolytopeAxis separating_axis(const Polytope& a, const Polytope& b, const Transform& a_from_b,
                             float max_separation, const PolytopeAxis& favoured);

}  // namespace gyre
