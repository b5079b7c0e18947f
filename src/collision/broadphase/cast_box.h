// A box that moves along a line, or a ray: casts search their candidates with it.
//
// meets() decides, in double. CastTest comes before it, and line() serves trees: the same test in float with slack, so
// that it never leaves out a box that meets() would accept.
//
// Source: A. Williams, S. Barrus, R. Morley, P. Shirley, "An Efficient and Robust Ray-Box Intersection Algorithm",
// 2005.
#pragma once

#include "collision/broadphase/box_lanes.h"
#include "geometry/tree/ray_traversal.h"

#include <gyre/math.h>

#include <cstdint>

namespace gyre {

struct CastBox {
  DVec3 start;          // m, centre at t = 0
  Vec3 translation;     // m; at t = 1 the centre is at start + translation
  Vec3 half_extents{};  // m; zero for a ray
};

// True if the box meets `box` at any t from 0 to `max_fraction`.
inline bool meets(const CastBox& cast_box, float max_fraction, const Aabb& box) {
  double enter = 0.0, leave = double(max_fraction);
  for (int axis = 0; axis < 3; ++axis) {
    const double low = double(box.low[axis]) - double(cast_box.half_extents[axis]) - cast_box.start[axis];
    const double high = double(box.high[axis]) + double(cast_box.half_extents[axis]) - cast_box.start[axis];
    const double along = double(cast_box.translation[axis]);
    if (along == 0.0) {
      if (!(low <= 0.0 && high >= 0.0)) return false;
      continue;
    }
    enter = max(enter, (along > 0.0 ? low : high) / along);
    leave = min(leave, (along > 0.0 ? high : low) / along);
  }
  return enter <= leave;
}

// The range of t that remains.
struct CastRange {
  float enter = 0.0f;
  float leave = 1.0f;

  // With slack for the rounding of divisions.
  bool is_empty() const { return !(enter <= leave * 1.00001f); }
};

class CastTest {
 public:
  explicit CastTest(const CastBox& cast_box)
      : line_(cast_box.start, DVec3(cast_box.translation), cast_box.half_extents) {
    for (int axis = 0; axis < 3; ++axis) {
      origin_[axis] = float(cast_box.start[axis]);
      translation_[axis] = cast_box.translation[axis];
      still_[axis] = absolute(translation_[axis]) < 1.0e-30f;
      inverse_[axis] = still_[axis] ? 0.0f : 1.0f / translation_[axis];
      // Rounding of the position, and of differences to it.
      extent_[axis] =
          cast_box.half_extents[axis] + 4.0e-7f * (absolute(origin_[axis]) + cast_box.half_extents[axis]);
      if (still_[axis]) extent_[axis] += absolute(translation_[axis]);
    }
  }

  float translation(int axis) const { return translation_[axis]; }
  // The same for traversals of trees.
  const BoxRay& line() const { return line_; }

  // The bounds of the moving box from t = range.enter to range.leave, rounded outward.
  Aabb box_of(const CastRange& range) const {
    float low[3], high[3];
    for (int axis = 0; axis < 3; ++axis) {
      const float a = origin_[axis] + range.enter * translation_[axis],
                  b = origin_[axis] + range.leave * translation_[axis];
      const float room = extent_[axis] + 4.0e-7f * absolute(translation_[axis]);
      low[axis] = min(a, b) - room;
      high[axis] = max(a, b) + room;
    }
    return {{low[0], low[1], low[2]}, {high[0], high[1], high[2]}};
  }

  // Clips `range` to the t at which the box is between `low` and `high` on an axis.
  void clip(int axis, float low, float high, CastRange& range) const {
    const float to_low = low - extent_[axis] - origin_[axis], to_high = high + extent_[axis] - origin_[axis];
    if (still_[axis]) {
      if (!(to_low <= 0.0f && to_high >= 0.0f)) range = {1.0f, -1.0f};
      return;
    }
    const bool up = translation_[axis] > 0.0f;
    range.enter = max(range.enter, (up ? to_low : to_high) * inverse_[axis]);
    range.leave = min(range.leave, (up ? to_high : to_low) * inverse_[axis]);
  }
  // The same along a direction whose components are 1, 0 or -1.
  void clip_along(const std::int8_t* signs, float low, float high, CastRange& range) const {
    float origin = 0.0f, along = 0.0f, room = 0.0f, size = 0.0f, sum = 0.0f;
    for (int axis = 0; axis < 3; ++axis) {
      if (signs[axis] == 0) continue;
      origin += float(signs[axis]) * origin_[axis];
      along += float(signs[axis]) * translation_[axis];
      room += extent_[axis];
      size += absolute(origin_[axis]);
      sum += absolute(translation_[axis]);
    }
    // Rounding of the sums above, and of the similar sums behind `low` and `high`.
    room += 1.0e-6f * (size + sum + room);
    if (absolute(along) <= 1.0e-4f * sum || absolute(along) < 1.0e-30f) {
      room += 1.01e-4f * sum + 1.0e-30f;
      if (!(low - room <= origin && high + room >= origin)) range = {1.0f, -1.0f};
      return;
    }
    const float to_low = low - room - origin, to_high = high + room - origin;
    const float early = (along > 0.0f ? to_low : to_high) / along,
                late = (along > 0.0f ? to_high : to_low) / along;
    // The sum of translations has lost up to three digits.
    range.enter = max(range.enter, early - 2.0e-3f * absolute(early));
    range.leave = min(range.leave, late + 2.0e-3f * absolute(late));
  }
  CastRange clip(const Aabb& box, CastRange range) const {
    for (int axis = 0; axis < 3; ++axis) clip(axis, box.low[axis], box.high[axis], range);
    return range;
  }

  // Bit i: the box may touch lane i's box from t = 0 to `max_fraction`, not before t = enter[i].
  unsigned mask(const BoxLanes& lanes, float max_fraction, float* enter) const {
    return half_mask(lanes, 0, max_fraction, enter) | half_mask(lanes, 4, max_fraction, enter) << 4;
  }

 private:
  unsigned half_mask(const BoxLanes& lanes, int first, float max_fraction, float* enter) const {
    using Half = Wide<4>;
    Half from(0.0f), to(max_fraction);
    Mask<4> inside = Mask<4>::splat(true);
    for (int axis = 0; axis < 3; ++axis) {
      const Half to_low = Half::load(lanes.low[axis] + first) - Half(extent_[axis]) - Half(origin_[axis]);
      const Half to_high = Half::load(lanes.high[axis] + first) + Half(extent_[axis]) - Half(origin_[axis]);
      if (still_[axis]) {
        inside = inside & (to_low <= Half(0.0f)) & (to_high >= Half(0.0f));
      } else {
        const bool up = translation_[axis] > 0.0f;
        from = max(from, (up ? to_low : to_high) * Half(inverse_[axis]));
        to = min(to, (up ? to_high : to_low) * Half(inverse_[axis]));
      }
    }
    from.store_unaligned(enter + first);
    return to_bits(inside & (from <= to * Half(1.00001f)));
  }

  BoxRay line_;
  float origin_[3], translation_[3], inverse_[3], extent_[3];
  bool still_[3];
};

}  // namespace gyre
