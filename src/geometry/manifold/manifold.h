// Contact manifolds: what collision writes and solvers read. A manifold is a question about two shapes, so it lives with
// the other questions about shapes and knows neither bodies nor solvers.
#pragma once

#include "geometry/shape/shape.h"

namespace gyre {

struct CachedTriangles;

constexpr int kMaxManifoldPoints = 4;
constexpr int kMaxMeshManifolds = 8;  // of one convex against a mesh or height field

struct ManifoldPoint {
  Vec3 position;         // midway between the two surfaces, in the frame of shape A
  float separation = 0;  // distance of the surfaces along the normal; negative when they overlap
  std::uint32_t feature = 0;  // names the pair of features that meet, to match points from step to step
};

// Up to four points that share a normal.
struct LocalManifold {
  Vec3 normal;  // unit, from A to B, in the frame of shape A
  int count = 0;
  std::uint32_t triangle = 0;  // mesh and height field: which triangle (the deepest one if several share the manifold)
  ManifoldPoint points[kMaxManifoldPoints];
};

// The least separation; kUnbounded if there are no points.
inline float deepest_of(const LocalManifold& manifold) {
  float least = kUnbounded;
  for (int i = 0; i < manifold.count; ++i) least = min(least, manifold.points[i].separation);
  return least;
}

// A manifold as it lives in the contact store from step to step: in world axes, anchored at both bodies' centres of mass,
// with the impulses that the solver left there. `count` 0 means that nothing is near enough to matter. The solver reads and
// writes both records four floats at a time: what belongs together lies together.
struct ContactPointState {
  Vec3 from_a;                 // m, world axes: from A's centre of mass to the point, as the step began
  float separation = 0.0f;     // m, as the step began
  Vec3 from_b;
  std::uint32_t feature = 0;
  float normal_impulse = 0.0f;  // N s, of the last sub-step: the warm start
  float total_impulse = 0.0f;   // N s, over the whole last step
  float mean_impulse = 0.0f;            // N s: the load that the point is used to (a slow mean of normal_impulse)
  float approach_speed = 0.0f;  // m/s, before the step's first impulse; positive when closing
};

// A contact point as the last full look found it, in the body frame of A, or of B where only A is a core swept by a ball:
// from it the point of a pair that hardly moved against each other is found again without asking the shapes.
struct PointAnchor {
  Vec3 position;  // m, midway between the surfaces
  float separation = 0.0f;
};

struct Manifold {
  Vec3 normal{0, 1, 0};  // unit, world axes, from A to B
  std::int32_t count = 0;
  ContactPointState points[kMaxManifoldPoints];
  float load_age = 0.0f;           // s for which it has borne load without a break
  Vec3 friction_impulse;      // N s on B, in the tangent plane, world axes
  float twist_impulse = 0.0f;   // N m s on B about the normal
  Vec3 rolling_impulse;       // N m s on B, world axes
  std::uint32_t triangle = 0;
  Vec3 total_friction;        // N s on B over the whole last step
  std::uint32_t sliding = 0;  // 1 when friction was at its limit at the end of the last step
  // What the solver never reads: the manifold as the last full look saw it.
  Vec3 anchor_normal{0, 1, 0};  // in the frame of the anchors
  PointAnchor anchors[kMaxManifoldPoints];
};

// What a pair remembers from its last look, so that the next one starts well: a separating axis or a simplex.
// Part of the world's state: it may decide between features that are equally good.
struct PairCache {
  std::uint32_t words[4] = {};
};

// Manifold of two convex shapes. `a_from_b` places B in A's frame. Points farther apart than `max_separation` are left
// out; count 0 when there are none. Points are in no particular order but a deterministic one.
// Symmetric in what it accepts: any two convex kinds in any order.
void collide_convex(const Shape& a, const Shape& b, const Transform& a_from_b, float max_separation, PairCache& cache,
                    LocalManifold& out);

// Manifold of a plane (A) and a convex shape (B).
void collide_plane(const Shape& plane, const Shape& b, const Transform& a_from_b, float max_separation,
                   LocalManifold& out);

// Manifolds of a mesh or height field (A) and a convex shape (B), at most kMaxMeshManifolds, grouped by normal. Inner
// edges never push sideways: a contact whose normal lies outside the Voronoi region of the triangle's feature is turned
// to the face's normal or dropped. Returns how many were written. `kept`, if it is not null: what is kept of a mesh from one
// look of this shape at it to the next, which changes nothing of what is found.
int collide_mesh(const Shape& mesh, const Shape& b, const Transform& a_from_b, float max_separation,
                 LocalManifold* out, CachedTriangles* kept = nullptr);

// Manifolds of any two shapes of which at most one is not convex, for any order of kinds (the result is always from A to
// B). Two non-convex shapes never touch: 0. Returns the number of manifolds written to `out` (room for kMaxMeshManifolds).
// `kept` as in collide_mesh.
int collide_shapes(const Shape& a, const Shape& b, const Transform& a_from_b, float max_separation,
                   PairCache& cache, LocalManifold* out, CachedTriangles* kept = nullptr);

// Keeps at most four of `count` candidate points (at most 64): the deepest, and those that span the largest area.
int reduce_points(ManifoldPoint* points, int count, Vec3 normal);

}  // namespace gyre
