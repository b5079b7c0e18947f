// Rays, moving shapes and overlaps against one rope, cloth or solid at its present vertices.
//
// In: an entry of the store, boxes of its triangles or segments (fit_soft_boxes), and a query in the world. Out: the first hit with its triangle
// or segment and the weights of the corners there; among equal fractions the lowest number. Rays meet the middle surface of a cloth, from both
// sides, and the round surface of a rope. Moving shapes and overlaps stop at half the thickness of a cloth. A solid is hit from outside; a ray
// that starts within it hits at once, and a shape whose origin is within it overlaps it.
//
// The methods are those of meshes and capsules: geometry/query/cast.h, geometry/query/closest_points.h.
#pragma once

#include "base/arena/arena.h"
#include "geometry/query/cast.h"
#include "soft/store/soft_store.h"

#include <gyre/math.h>

#include <span>

namespace gyre {

// Boxes about `origin`, with the radius of a rope.
struct SoftBoxes {
  DVec3 origin{};
  Aabb box{};
  SurfaceBoxes surface;            // cloths and solids
  std::span<const Aabb> segments;  // ropes: of kSegmentsPerBox each
};
constexpr int kSegmentsPerBox = 16;

SoftBoxes fit_soft_boxes(const SoftEntry& entry, Arena& arena);

struct SoftHit {
  double fraction = 0.0;
  DVec3 point{};  // world
  Vec3 normal{};  // out of the surface that is hit
  bool inside = false;
  float depth = 0.0f;
  std::uint32_t part = 0;  // triangle of SoftEntry::triangles, or segment
  float weights[3] = {};   // of its corners
};

struct SoftCast {
  const Shape* shape = nullptr;  // null: a ray
  DVec3 position{};
  DQuat orientation{};
  DVec3 translation{};
  float skin = 0.0f;
};

// The first hit at a fraction of at most `max_fraction`.
bool cast_at_soft(const SoftEntry& entry, const SoftBoxes& boxes, const SoftCast& cast, double max_fraction,
                  bool back_faces, SoftHit& hit);
// True if the shape overlaps or touches; `part` is then the lowest triangle or segment that it overlaps, or kNoTriangle if it lies wholly within a
// solid.
bool overlaps_soft(const SoftEntry& entry, const SoftBoxes& boxes, const SoftCast& place,
                   std::uint32_t& part);

}  // namespace gyre
