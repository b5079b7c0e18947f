// Fat boxes: what a proxy shows of its shape. A fat box is larger than the shape needs, so that it changes rarely.
//
// Promise to the narrow phase (collide.h): two shapes whose surfaces may come within the speculative distance in the
// coming step have fat boxes that overlap as it begins. Each box holds its shape, kSpeculativeShare of its size, and the
// way that it can go in the step; the speculative distance is never more than what two boxes have together.
//
// Boxes are worked out in double and rounded outward, so all of this holds however far from the origin.
#pragma once

#include "geometry/shape/shape.h"

namespace gyre {

// Contacts are looked for up to this share of the smaller shape's size (and the way that the two can come in a step).
constexpr float kSpeculativeShare = 0.04f;
// A fat box is larger than needed by this share of its shape's size.
constexpr float kFatShare = 0.05f;
// And made anew where it is larger by this many sizes: more than any is made.
constexpr float kTooLarge = 3.0f;
// A box with a side this long belongs to a plane or the like; trees keep such boxes apart.
constexpr float kUnboundedSide = 1.0e17f;
constexpr bool is_unbounded(const Aabb& box) { return !(largest(box.high - box.low) < kUnboundedSide); }

struct WorldBox {
  DVec3 low;
  DVec3 high;
};

// Contains every point of the shape.
WorldBox world_box(const Shape& shape, const Pose& world_from_shape);
// The same where its bounds() at the origin, turned as it is, are known.
WorldBox world_box(const Shape& shape, const Aabb& rotated, DVec3 position);

// How a shape moves: what its fat box must hold.
struct BoxMotion {
  float size = 0.0f;  // ColliderShape::size
  Vec3 translation;   // m, how far its body goes in a step at its present velocity
  float arc =
      0.0f;  // m, how far its points go because the body turns (angle times distance from the centre of mass)
};

// Planes and meshes have no size of their own; what they meet decides.
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

// The box to be given to the broad phase: the needed one with a margin, longer in the direction of motion.
Aabb fat_box(const WorldBox& needed, const BoxMotion& motion);

inline bool contains(const Aabb& fat, const WorldBox& needed) {
  const DVec3 low(fat.low);
  const DVec3 high(fat.high);
  for (int axis = 0; axis < 3; ++axis) {
    if (low[axis] > needed.low[axis] || high[axis] < needed.high[axis]) return false;
  }
  return true;
}

// Whether a fat box must be made anew: it no longer holds what is needed, or is much too large.
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

// Makes a fat box anew where that must be. Returns whether it was.
inline bool refit_box(Aabb& fat, const WorldBox& tight, const BoxMotion& motion) {
  const WorldBox needed = needed_box(tight, motion);
  if (!needs_refit(fat, needed, motion)) return false;
  fat = fat_box(needed, motion);
  return true;
}

// The smallest float box around `box`.
Aabb round_outward(const WorldBox& box);

}  // namespace gyre
