// Clipping of two faces that meet, and the choice of four among many contact points. One face is cut by the sides of
// the other; each remaining corner becomes a point with its exact distance from the plane of the other face.
//
// In: two features (polygon, segment or point) of two cores in A's frame, and the contact normal. Out: candidate
// points, named by the vertices and edges that make them. So a point keeps its name from step to step, even if the two
// faces change roles. Positions lie midway between the true surfaces; separations are measured along the normal.
//
// Sources: I. Sutherland, G. Hodgman, "Reentrant Polygon Clipping", 1974; feature names after E. Catto, "Contact
// Manifolds", GDC 2007; reduction by depth, distance and area as in K. Erleben et al., "Physics-Based Animation", 2005,
// chapter 14.
#pragma once

#include "geometry/manifold/manifold.h"
#include "geometry/shape/support.h"

namespace gyre {

constexpr int kMaxClipPoints = 2 * kMaxFaceVertices;

struct FacePair {
  const FacePolygon* a = nullptr;  // both in A's frame
  const FacePolygon* b = nullptr;
  Vec3 normal;            // unit, from A to B
  float radius_a = 0.0f;  // of the balls around the cores
  float radius_b = 0.0f;
  float max_separation = 0.0f;            // of the surfaces; points farther apart are dropped
  float max_lateral_offset = kUnbounded;  // how far apart two segments may pass, seen along the normal
};

// Cuts one feature by the sides of the other, seen along the normal. The reference (A's feature if `reference_is_a`) is
// a polygon whose plane is not parallel to the normal; the other is a polygon or a segment. Returns the number of
// points, at most kMaxClipPoints.
int clip_faces(const FacePair& pair, bool reference_is_a, ManifoldPoint* out);

// Sine (6 degrees) below which two segments count as parallel and touch in two points.
constexpr float kParallelSegmentSine = 0.1f;
// How far apart two such segments may pass, as a fraction of the smaller radius. The error of the separation is then
// below 0.5 % of the radius.
constexpr float kMaxLateralOffset = 0.1f;

// Two segments that overlap along their length: the two ends of the shared stretch, seen along the normal. 0 if they
// share no stretch, or if they pass each other by more than `max_lateral_offset` at an end of it.
int clip_segments(const FacePair& pair, ManifoldPoint* out);

// Names of points: a vertex of A over B's face, a vertex of B over A's face, an edge of A across an edge of B (an edge
// has the name of its first vertex in the face), and the one closest point of two shapes that meet in no face.
constexpr std::uint32_t feature_vertex_a(std::uint32_t id) { return 0x40000000u | id; }
constexpr std::uint32_t feature_vertex_b(std::uint32_t id) { return 0x80000000u | id; }
constexpr std::uint32_t feature_edges(std::uint32_t edge_a, std::uint32_t edge_b) {
  return 0xc0000000u | (edge_a << 12) | edge_b;
}
constexpr std::uint32_t kFeatureNearest = 0x20000000u;

}  // namespace gyre
