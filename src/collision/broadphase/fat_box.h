// Fat boxes: the bounding boxes of proxies, enlarged so that they change rarely.
//
// Promise to the narrow phase (collide.h): two shapes whose surfaces may come within the speculative distance in the
// coming step have fat boxes that overlap as the step begins. Each box contains its shape, kSpeculativeShare of its
// size, and its motion in the step; the speculative distance never exceeds the sum of these margins of two boxes.
//
// Boxes are computed in double and rounded outward, so this holds at any distance from the origin.
#pragma once

#include "geometry/shape/shape.h"

namespace gyre {

// The speculative distance as a share of the smaller shape's size, to which the approach of the two in a step is added.
constexpr float kSpeculativeShare = 0.04f;
// The margin of a fat box, as a share of its shape's size.
constexpr float kFatShare = 0.05f;
// A fat box larger than needed by this many sizes is refitted; no new box is that large.
constexpr float kTooLarge = 3.0f;
// A box with a side this long belongs to a plane; trees keep such boxes apart.
constexpr float kUnboundedSide = 1.0e17f;
constexpr bool is_unbounded(const Aabb& box) { return !(largest(box.high - box.low) < kUnboundedSide); }

struct WorldBox {
  DVec3 low;
  DVec3 high;
};

// Contains every point of the shape.
WorldBox world_box(const Shape& shape, const Pose& world_from_shape);
// The same from the shape's bounds() at the origin with its orientation.
WorldBox world_box(const Shape& shape, const Aabb& rotated, DVec3 position);

// The motion of a shape in a step, which its fat box must contain.
struct BoxMotion {
  float size = 0.0f;  // ColliderShape::size
  Vec3 translation;   // m, of its body in a step at its present velocity
  float arc = 0.0f;   // m, arc of its points by rotation: angle times distance from the centre of mass
};

// Planes and meshes have no size of their own; the shapes that they meet decide.
inline double margin_size(const BoxMotion& motion) {
  return motion.size < kUnboundedSide ? double(motion.size) : 0.0;
}

// The box that the coming step needs.
inline WorldBox needed_box(const WorldBox& tight, const BoxMotion& motion) {
  const double margin = double(kSpeculativeShare) * margin_size(motion) + double(motion.arc);
  const DVec3 all{margin, margin, margin};
  return {tight.low - all + min(motion.translation, Vec3{}),
          tight.high + all + max(motion.translation, Vec3{})};
}

// The box for the broad phase: the needed box with a margin, longer in the direction of motion.
Aabb fat_box(const WorldBox& needed, const BoxMotion& motion);

inline bool contains(const Aabb& fat, const WorldBox& needed) {
  const DVec3 low(fat.low);
  const DVec3 high(fat.high);
  for (int axis = 0; axis < 3; ++axis) {
    if (low[axis] > needed.low[axis] || high[axis] < needed.high[axis]) return false;
  }
  return true;
}

// True if a fat box no longer contains the needed box, or is much too large.
inline bool needs_refit(const Aabb& fat, const WorldBox& needed, const BoxMotion& motion) {
  if (!contains(fat, needed)) return true;
  const DVec3 low(fat.low);
  const DVec3 high(fat.high);
  // Far from the origin, rounding alone makes a small shape's box large.
  const double size = margin_size(motion);
  for (int axis = 0; axis < 3; ++axis) {
    const double rounding = 4.0e-7 * (absolute(low[axis]) + absolute(high[axis]));
    const double excess = (high[axis] - low[axis]) - (needed.high[axis] - needed.low[axis]);
    if (excess > double(kTooLarge) * size + rounding) return true;
  }
  return false;
}

// Refits a fat box if needed. Returns true if it changed.
inline bool refit_box(Aabb& fat, const WorldBox& tight, const BoxMotion& motion) {
  const WorldBox needed = needed_box(tight, motion);
  if (!needs_refit(fat, needed, motion)) return false;
  fat = fat_box(needed, motion);
  return true;
}

// The smallest float box around `box`.
Aabb round_outward(const WorldBox& box);

}  // namespace gyre
