// From two faces that meet to contact points: one face is cut to the sides of the other, every corner that is left
// becomes a point with its exact distance from the other face's plane; and the choice of four among many points.
//
// In: two features (polygon, segment or point) of two cores in A's frame, and the contact normal. Out: candidate points
// named by the vertices and edges that make them, so that a point keeps its name from step to step, even when the two
// faces change roles. Positions lie midway between the true surfaces, separations are measured along the normal.
//
// Sources: I. Sutherland, G. Hodgman, "Reentrant Polygon Clipping", 1974; feature names after E. Catto, "Contact
// Manifolds", GDC 2007; reduction by depth, distance and area as in common use since K. Erleben et al., "Physics-Based
// Animation", 2005, chapter 14.
#pragma once

#include "geometry/manifold/manifold.h"
#include "geometry/shape/support.h"

namespace gyre {

constexpr int kMaxClipPoints = 2 * kMaxFaceVertices;

struct FacePair {
  const FacePolygon* a = nullptr;  // both in A's frame
  const FacePolygon* b = nullptr;
  Vec3 normal;            // unit, from A to B
  float radius_a = 0.0f;  // of the balls that sweep the cores
  float radius_b = 0.0f;
  float max_separation = 0.0f;  // of the surfaces; what is farther apart is left out
  float max_lateral_offset = kUnbounded;  // how far two segments may lie beside each other, seen along the normal
};

// Cuts one feature to the sides of the other, seen along the normal. The reference (A's if `reference_is_a`) is a polygon
// whose plane is not parallel to the normal; the other may be a polygon or a segment. Returns the number of points, at most
// kMaxClipPoints.
int clip_faces(const FacePair& pair, bool reference_is_a, ManifoldPoint* out);

// Segments that lean less than this sine (6 degrees) against each other touch in two points,
constexpr float kParallelSegmentSine = 0.1f;
// ... while they lie over each other within this part of the smaller radius: the separation is then within 0.5 % of it.
constexpr float kMaxLateralOffset = 0.1f;

// Two segments over each other: the two ends of the stretch that both share, seen along the normal. 0 if they share none,
// or if they lie more than `max_lateral_offset` beside each other at an end of it.
int clip_segments(const FacePair& pair, ManifoldPoint* out);

// Names of points: a vertex of A over B's face, a vertex of B over A's, an edge of A across an edge of B (an edge is named
// by the vertex it starts from in its face), and the one nearest point of two shapes that meet in no face.
constexpr std::uint32_t feature_vertex_a(std::uint32_t id) { return 0x40000000u | id; }
constexpr std::uint32_t feature_vertex_b(std::uint32_t id) { return 0x80000000u | id; }
constexpr std::uint32_t feature_edges(std::uint32_t edge_a, std::uint32_t edge_b) {
  return 0xc0000000u | (edge_a << 12) | edge_b;
}
constexpr std::uint32_t kFeatureNearest = 0x20000000u;

}  // namespace gyre
