// Eight boxes side by side, tested by one loop: the nodes of trees and the buckets of grids.
#pragma once

#include "math/wide.h"

#include <gyre/math.h>

#include <limits>

namespace gyre {

struct BoxLanes {
  static constexpr int kWidth = 8;

  float low[3][kWidth];
  float high[3][kWidth];
};

inline Aabb lane_box(const BoxLanes& lanes, int lane) {
  return {{lanes.low[0][lane], lanes.low[1][lane], lanes.low[2][lane]},
          {lanes.high[0][lane], lanes.high[1][lane], lanes.high[2][lane]}};
}

inline void set_lane_box(BoxLanes& lanes, int lane, const Aabb& box) {
  for (int axis = 0; axis < 3; ++axis) {
    lanes.low[axis][lane] = box.low[axis];
    lanes.high[axis][lane] = box.high[axis];
  }
}

// A box that nothing overlaps, for an unused lane.
inline void clear_lane_box(BoxLanes& lanes, int lane) {
  constexpr float kNever = std::numeric_limits<float>::infinity();
  set_lane_box(lanes, lane, {{kNever, kNever, kNever}, {-kNever, -kNever, -kNever}});
}

inline namespace GYRE_TARGET_NAMESPACE {

// Tests one box against many lanes, W at once.
template <int W>
class OverlapLanes {
 public:
  GYRE_INLINE explicit OverlapLanes(const Aabb& box)
      : low_x_(box.low.x),
        low_y_(box.low.y),
        low_z_(box.low.z),
        high_x_(box.high.x),
        high_y_(box.high.y),
        high_z_(box.high.z) {}

  // Bit i: lane i's box overlaps.
  GYRE_INLINE unsigned mask(const BoxLanes& lanes) const {
    unsigned bits = 0;
    GYRE_UNROLL
    for (int first = 0; first < BoxLanes::kWidth; first += W) bits |= group_mask(lanes, first) << first;
    return bits;
  }

 private:
  GYRE_INLINE unsigned group_mask(const BoxLanes& lanes, int first) const {
    const auto load = [first](const float* from) { return Wide<W>::load(from + first); };
    const Mask<W> x = (load(lanes.low[0]) <= high_x_) & (load(lanes.high[0]) >= low_x_);
    const Mask<W> y = (load(lanes.low[1]) <= high_y_) & (load(lanes.high[1]) >= low_y_);
    const Mask<W> z = (load(lanes.low[2]) <= high_z_) & (load(lanes.high[2]) >= low_z_);
    return to_bits(x & y & z);
  }

  Wide<W> low_x_, low_y_, low_z_, high_x_, high_y_, high_z_;
};
using OverlapTest = OverlapLanes<4>;

}  // namespace GYRE_TARGET_NAMESPACE
}  // namespace gyre
