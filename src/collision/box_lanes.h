// Eight boxes side by side, so that one loop tests them all: what the nodes of trees and the buckets of grids hold.
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

// A box that nothing overlaps, for a lane without one.
inline void clear_lane_box(BoxLanes& lanes, int lane) {
  constexpr float kNever = std::numeric_limits<float>::infinity();
  set_lane_box(lanes, lane, {{kNever, kNever, kNever}, {-kNever, -kNever, -kNever}});
}

// Bit i: lane i's box overlaps `box`.
inline unsigned overlap_mask(const BoxLanes& lanes, const Aabb& box) {
  using Half = Wide<4>;
  const auto half = [&](int first) {
    const auto load = [first](const float* from) { return Half::load(from + first); };
    const Mask<4> x = (load(lanes.low[0]) <= Half(box.high.x)) & (load(lanes.high[0]) >= Half(box.low.x));
    const Mask<4> y = (load(lanes.low[1]) <= Half(box.high.y)) & (load(lanes.high[1]) >= Half(box.low.y));
    const Mask<4> z = (load(lanes.low[2]) <= Half(box.high.z)) & (load(lanes.high[2]) >= Half(box.low.z));
    return to_bits(x & y & z);
  };
  return half(0) | half(4) << 4;
}

}  // namespace gyre
