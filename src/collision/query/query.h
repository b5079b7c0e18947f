// Questions to a whole world of shapes: rays, moving shapes, overlaps, closest points, penetrations.
//
// In: the shapes, where they are, and a broad phase that holds their boxes. Out: answers that name shapes by their index,
// in the world's axes. Candidates come from the broad phase and each is looked at exactly (geometry/query/cast, geometry/query/nearest,
// manifolds). They come in an order that differs between broad phases: to sort the answers, with the lowest index first among
// equals, is the caller's part, who alone knows how many are wanted. Nothing here allocates, and any number of threads may
// ask at once.
#pragma once

#include "base/function_ref.h"
#include "collision/broadphase/broadphase.h"
#include "collision/contact/collide.h"
#include "geometry/query/cast.h"

#include <span>

namespace gyre {

struct QueryInput {
  ColliderShapes shapes;
  std::span<const Proxy> proxies;
  const Broadphase& broadphase;  // has been shown all proxies
  FunctionRef<Pose(std::uint32_t shape)> pose_of;
  FunctionRef<bool(std::uint32_t shape)> accepts;
  bool back_faces = false;  // of surfaces too
};

struct WorldRay {
  DVec3 origin;
  Vec3 translation;
};

// A convex shape somewhere in the world, and where it goes (nowhere for questions about one place).
struct WorldShape {
  Shape shape;
  Pose pose;
  Vec3 translation;
  float skin = 0.0f;
};

struct ShapeHit {
  std::uint32_t shape = 0;
  std::uint32_t triangle = kNoTriangle;
  double fraction = 0.0;
  DVec3 point;
  Vec3 normal;  // out of the shape that is hit
  bool inside = false;
  float depth = 0.0f;
};

// Told of an answer; returns up to where answers are still wanted: a fraction of the way (what lies at it included), below 0 for
// no more.
using HitVisit = FunctionRef<double(const ShapeHit& hit)>;

// The first hit of every shape on the way.
void cast_ray(const QueryInput& input, const WorldRay& ray, HitVisit found);
void cast_shape(const QueryInput& input, const WorldShape& shape, HitVisit found);

struct ShapeNear {
  std::uint32_t shape = 0;
  std::uint32_t triangle = kNoTriangle;
  double distance = 0.0;
  DVec3 point;      // of the shape that is near
  DVec3 own_point;  // of the one that asks
  Vec3 normal;      // from the near shape to the one that asks
};

// Every shape within `max_distance`, until `found` says false.
void find_near(const QueryInput& input, const WorldShape& shape, double max_distance,
               FunctionRef<bool(const ShapeNear& near)> found);
// The nearest within `max_distance`, of equal ones that of the lowest index; false if there is none.
bool find_nearest_shape(const QueryInput& input, const WorldShape& shape, double max_distance,
                        ShapeNear& nearest);

struct ShapePenetration {
  std::uint32_t shape = 0;
  std::uint32_t triangle = kNoTriangle;
  double depth = 0.0;  // m
  DVec3 point;         // midway between the surfaces, where they are deepest
  Vec3 normal;  // unit: moving the asking shape by depth * normal parts the two, as far as this contact goes
};

// Every contact in which the shape overlaps another: one of each convex shape or plane, up to kMaxMeshManifolds of a mesh or
// height field.
void find_penetrations(const QueryInput& input, const WorldShape& shape,
                       FunctionRef<void(const ShapePenetration& deep)> found);

}  // namespace gyre
