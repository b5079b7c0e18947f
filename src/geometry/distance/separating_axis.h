// The separating axis test (SAT) of two convex polyhedra: the axis along which they are farthest apart or overlap
// least. Candidates are the face normals of both, and the cross products of those pairs of edges that make a face of
// the Minkowski difference.
//
// In: two polytopes, the pose of B in A's frame, and the axis that decided last time. Out: the best axis, or the first
// one whose separation is above the allowed maximum. The separation is exact for overlapping polyhedra; for separated
// ones it is never more than the distance.
//
// Few edges are tested. At a winning pair of edges the two crossing points are no farther apart than the depth of the
// best face, so both edges must come that close to the plane of that face. Two edges make no face of the difference if
// their arcs of normals do not cross on the Gauss map. Edges are not tested at all if the closest vertex lies over the
// middle of the favoured or the best face, or if favoured edges cross well inside both: no other axis can then be
// better.
//
// Sources: D. Gregorius, "The Separating Axis Test between Convex Polyhedra", GDC 2013; D. Eberly, "Dynamic Collision
// Detection using Oriented Bounding Boxes" (the axes of a pair).
#pragma once

#include "geometry/shape/polytope.h"

namespace gyre {

enum class AxisKind : std::uint8_t { none, face_a, face_b, edges };

struct PolytopeAxis {
  AxisKind kind = AxisKind::none;
  int index_a = 0;  // face or edge of A
  int index_b = 0;  // face or edge of B
  int vertex = 0;   // of a face axis: the closest vertex of the other polytope
  Vec3 normal;      // unit, from A to B, in A's frame
  float separation = -kUnbounded;
  // Of an edge axis: the separation of the two edges alone. It is that of the polytopes if the edges meet.
  float edge_separation = -kUnbounded;
};

// Packs an axis into 32 bits for PairCache, and unpacks it. 0 means no axis, and so does a value that fits no feature
// of the two polytopes.
std::uint32_t encode_axis(const PolytopeAxis& axis);
PolytopeAxis decode_axis(std::uint32_t name, const Polytope& a, const Polytope& b);

// The exact separation of the polytopes along a known axis. Fills `normal`, `vertex` and `edge_separation` too.
float separation_along(const Polytope& a, const Polytope& b, const Transform& a_from_b, PolytopeAxis& axis);

// If separations are nearly equal, faces win over edges, and `favoured` wins over all others. separation_along() must
// have filled `favoured`.
PolytopeAxis separating_axis(const Polytope& a, const Polytope& b, const Transform& a_from_b,
                             float max_separation, const PolytopeAxis& favoured);

}  // namespace gyre
