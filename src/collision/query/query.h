// Queries on a whole world of shapes: rays, shape casts, overlaps, closest points, penetrations.
//
// In: the shapes, their poses, and a broad phase with their boxes. Out: results with shape indices, in world axes. The
// broad phase gives candidates, and each is tested exactly (geometry/query/cast, geometry/query/closest_points, manifolds).
// The order of results differs between broad phases; the caller sorts them, the lowest index first among equals.
// Nothing here allocates, and any number of threads may query at once.
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
  const Broadphase& broadphase;  // has received all proxies
  FunctionRef<Pose(std::uint32_t shape)> pose_of;
  FunctionRef<bool(std::uint32_t shape)> accepts;
  bool back_faces = false;  // also hits back faces of surfaces
};

struct WorldRay {
  DVec3 origin;
  Vec3 translation;
};

// A convex shape in the world, and its translation in a cast (zero for other queries).
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
  Vec3 normal;  // out of the shape that was hit
  bool inside = false;
  float depth = 0.0f;
};

// Receives a hit and returns the fraction up to which hits still count (inclusive); below 0 ends the cast.
using HitVisit = FunctionRef<double(const ShapeHit& hit)>;

// Reports the first hit of every shape along the cast.
void cast_ray(const QueryInput& input, const WorldRay& ray, HitVisit found);
void cast_shape(const QueryInput& input, const WorldShape& shape, HitVisit found);

struct ShapeNear {
  std::uint32_t shape = 0;
  std::uint32_t triangle = kNoTriangle;
  double distance = 0.0;
  DVec3 point;      // on the near shape
  DVec3 query_point;  // on the query shape
  Vec3 normal;      // from the near shape to the query shape
};

// Reports every shape within `max_distance`, until `found` returns false.
void find_near(const QueryInput& input, const WorldShape& shape, double max_distance,
               FunctionRef<bool(const ShapeNear& near)> found);
// The nearest shape within `max_distance`, the lowest index among equals; false if there is none.
bool find_nearest_shape(const QueryInput& input, const WorldShape& shape, double max_distance,
                        ShapeNear& nearest);

struct ShapePenetration {
  std::uint32_t shape = 0;
  std::uint32_t triangle = kNoTriangle;
  double depth = 0.0;  // m
  DVec3 point;         // midway between the surfaces, where they overlap most
  Vec3 normal;         // unit: moving the query shape by depth * normal resolves this contact
};

// Reports every contact in which the shape overlaps another: one for each convex shape or plane, up to
// kMaxMeshManifolds for a mesh or height field.
void find_penetrations(const QueryInput& input, const WorldShape& shape,
                       FunctionRef<void(const ShapePenetration& deep)> found);

// True if the shapes of the two indices overlap or touch. Of any kinds.
bool do_shapes_overlap(const QueryInput& input, std::uint32_t a, std::uint32_t b);

}  // namespace gyre
