// Contact manifolds: collision detection writes them, solvers read them. A manifold depends on two shapes alone, so it
// stands with the other queries of shapes and knows neither bodies nor solvers.
#pragma once

#include "geometry/shape/shape.h"

namespace gyre {

struct CachedTriangles;

constexpr int kMaxManifoldPoints = 4;
constexpr int kMaxMeshManifolds = 8;  // of one convex against a mesh or height field

struct ManifoldPoint {
  Vec3 position;              // midway between the two surfaces, in the frame of shape A
  float separation = 0;       // distance of the surfaces along the normal; negative when they overlap
  std::uint32_t feature = 0;  // the pair of features that meet; it matches points from step to step
};

// Up to four points that share a normal.
struct LocalManifold {
  Vec3 normal;  // unit, from A to B, in the frame of shape A
  int count = 0;
  std::uint32_t triangle = 0;  // of a mesh or height field: the triangle, or the deepest one of several
  ManifoldPoint points[kMaxManifoldPoints];
};

// The smallest separation; kUnbounded if there are no points.
inline float deepest_of(const LocalManifold& manifold) {
  float smallest_separation = kUnbounded;
  for (int i = 0; i < manifold.count; ++i)
    smallest_separation = min(smallest_separation, manifold.points[i].separation);
  return smallest_separation;
}

// A manifold in the contact store, persistent from step to step: in world axes, with lever arms from both centres of
// mass and the impulses of the solver. `count` 0 means that no points are close enough. The solver reads and writes
// both records four floats at a time, so fields that are used together stand together.
struct ContactPointState {
  Vec3 from_a;              // m, world axes, when the step began: from A's centre of mass to the point
  float separation = 0.0f;  // m, when the step began
  Vec3 from_b;
  std::uint32_t feature = 0;
  float normal_impulse = 0.0f;  // N s, of the last sub-step: the warm start
  float total_impulse = 0.0f;   // N s, over the whole last step
  float mean_impulse = 0.0f;    // N s, a slow mean of normal_impulse: the load that the point is used to
  float approach_speed = 0.0f;  // m/s, before the first impulse of the step; positive when closing
};

// A contact point of the last manifold update in the body frame of A, or of B if only A has a rounded core. If the pair
// hardly moves, the point is recomputed from the anchor without the shapes.
struct PointAnchor {
  Vec3 position;  // m, midway between the surfaces
  float separation = 0.0f;
};

struct Manifold {
  Vec3 normal{0, 1, 0};  // unit, world axes, from A to B
  std::int32_t count = 0;
  ContactPointState points[kMaxManifoldPoints];
  float load_age = 0.0f;       // s for which the contact has carried load without a break
  Vec3 friction_impulse;       // N s on B, in the tangent plane, world axes
  float twist_impulse = 0.0f;  // N m s on B about the normal
  Vec3 rolling_impulse;        // N m s on B, world axes
  std::uint32_t triangle = 0;
  Vec3 total_friction;        // N s on B over the whole last step
  std::uint32_t sliding = 0;  // 1 if friction was at its limit at the end of the last step
  // Data of the last manifold update, which the solver never reads.
  Vec3 anchor_normal{0, 1, 0};  // the normal in the frame of the anchors
  PointAnchor anchors[kMaxManifoldPoints];
};

// The separating axis or simplex of the last manifold update, from which the next one starts. It is state of the world,
// because it may decide between equally good features.
struct PairCache {
  std::uint32_t words[4] = {};
};

// Manifold of two convex shapes. `a_from_b` is the pose of B in A's frame. Points farther apart than `max_separation`
// are dropped; count is 0 if none is left. The order of the points has no meaning, but is deterministic. Any two convex
// kinds in any order.
void collide_convex(const Shape& a, const Shape& b, const Transform& a_from_b, float max_separation,
                    PairCache& cache, LocalManifold& out);

// Manifold of a plane (A) and a convex shape (B).
void collide_plane(const Shape& plane, const Shape& b, const Transform& a_from_b, float max_separation,
                   LocalManifold& out);

// Manifolds of a mesh or height field (A) and a convex shape (B), at most kMaxMeshManifolds, grouped by normal.
// Internal edges never push sideways: a contact whose normal lies outside the Voronoi region of its feature gets the
// normal of the face or is dropped. Returns the number of manifolds. `triangles`, if not null, caches the triangles of
// a mesh between updates; it never changes the result.
int collide_mesh(const Shape& mesh, const Shape& b, const Transform& a_from_b, float max_separation,
                 LocalManifold* out, CachedTriangles* triangles = nullptr);

// Manifolds of any two shapes of which at least one is convex, in any order of kinds; the normal is always from A to
// B. Two non-convex shapes never touch: 0. Returns the number of manifolds in `out`, which has room for kMaxMeshManifolds.
// `triangles` as in collide_mesh.
int collide_shapes(const Shape& a, const Shape& b, const Transform& a_from_b, float max_separation,
                   PairCache& cache, LocalManifold* out, CachedTriangles* triangles = nullptr);

// Reduces `count` candidate points (at most 64) to four at most: the deepest, and those that span the largest area. Points that lie
// 1 / `fade` metres above the deepest count half.
int reduce_points(ManifoldPoint* points, int count, Vec3 normal, float fade = 0.0f);

}  // namespace gyre
