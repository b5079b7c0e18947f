// Poses as whole numbers, and the change of a pose since the two frames before it in few bits. All arithmetic after
// the rounding is in integers, so bits and poses are the same on every platform. docs/recording.md describes the
// format, docs/decisions/track-coding.md gives the reasons.
//
// - A coordinate is rounded to a multiple of 2^-position_bits m. The largest component of the quaternion is positive
//   and omitted; the others are rounded to multiples of 2^-orientation_bits.
// - A pose is predicted from the last two frames: the position by the same displacement, the orientation by the same
//   rotation. The difference from the prediction is stored, so errors do not accumulate.
// - A difference is stored in a Rice code whose parameter follows the sizes of the last differences of the same body
//   and component. R. F. Rice, "Some practical universal noiseless coding techniques", 1979.
#pragma once

#include "io/codec/bits.h"

#include <gyre/math.h>
#include <gyre/track.h>

namespace gyre {

struct PoseSteps {
  int position_bits = 13;
  int orientation_bits = 16;
};
// 2^bits, exactly.
inline double power_of_two(int bits) { return __builtin_bit_cast(double, std::uint64_t(1023 + bits) << 52); }
// The ranges that a reader accepts.
constexpr int kMaxPositionBits = 40;
constexpr int kMinPositionBits = -20;
constexpr int kMaxOrientationBits = 20;
constexpr int kMinOrientationBits = 8;
constexpr std::int64_t kMaxPosition =
    std::int64_t(1) << 51;  // rounding steps from the origin; poses farther out are moved there

struct RoundedPose {
  std::int64_t position[3] = {0, 0, 0};
  std::int64_t orientation[4] = {0, 0, 0, 0};  // x, y, z, w; the largest follows from the others
  int largest = 3;

  bool operator==(const RoundedPose&) const = default;
};

// The nearest coordinate and pose that can be stored. Both must be finite.
std::int64_t round_coordinate(double coordinate, PoseSteps steps);
RoundedPose round_pose(const Pose& pose, PoseSteps steps);
Pose unrounded(const RoundedPose& pose, PoseSteps steps);
// The largest error of a stored pose.
TrackAccuracy accuracy_of(PoseSteps steps);
// Computes the largest component from the others. False if those are too large.
bool complete_orientation(RoundedPose& pose, PoseSteps steps);

// The state of the prediction of one body.
struct PoseHistory {
  RoundedPose now, before;
  std::int64_t sizes[6] = {-1, -1, -1,
                           -1, -1, -1};  // of the last differences, in sixteenths; -1: there was none
};
// A history that begins with this pose, at rest.
PoseHistory begin_history(const RoundedPose& pose);
// The predicted pose, without `largest`.
RoundedPose predict(const PoseHistory& history, PoseSteps steps);

// Codes one difference; `size` is the running mean of those before it.
template <class Bits>
void code_difference(Bits& bits, std::int64_t& difference, std::int64_t& size) {
  constexpr int kFirstLowBits = 8;          // of the first difference of a history
  constexpr std::int64_t kSecondSize = 64;  // the first difference says nothing about later ones
  constexpr std::uint64_t kMaxHigh = 24;    // larger high parts are stored as a number of bits
  constexpr int kMaxBits = 57;
  const bool first = size < 0;
  // The smallest number of low bits k with 1.5 * 2^k >= size / 16.
  const int low_bits = first ? kFirstLowBits : int(std::bit_width(std::uint64_t((size - 1) / 12)));
  if constexpr (Bits::kReads) {
    std::uint64_t folded = 0, high = 0, more = 1;
    while (high < kMaxHigh) {
      bits.code_bits(more, 1);
      if (!more) break;
      ++high;
    }
    if (high >= kMaxHigh) {
      std::uint64_t width = 0;
      bits.code_bits(width, 6);
      if (width > kMaxBits) bits.fail(), width = 0;
      bits.code_bits(folded, int(width));
    } else {
      bits.code_bits(folded, low_bits);
      folded |= high << low_bits;
    }
    if (bits.failed() || folded >> kMaxBits != 0) bits.fail(), folded = 0;
    difference = unfold_sign(folded);
  } else {
    const std::uint64_t folded = fold_sign(difference), high = folded >> low_bits;
    if (high < kMaxHigh) {
      constexpr int kMaxLowBitsWithUnary = 64 - int(kMaxHigh);
      const std::uint64_t ones = (std::uint64_t(1) << high) - 1,
                          low = folded & ((std::uint64_t(1) << low_bits) - 1);
      const int unary = int(high) + 1;
      if (low_bits <= kMaxLowBitsWithUnary) {
        bits.code_bits(low << unary | ones, unary + low_bits);
      } else {
        bits.code_bits(ones, unary);
        bits.code_bits(low, low_bits);
      }
    } else {
      bits.code_bits((std::uint64_t(1) << kMaxHigh) - 1, int(kMaxHigh));
      bits.code_bits(std::uint64_t(std::bit_width(folded)), 6);
      bits.code_bits(folded, int(std::bit_width(folded)));
    }
  }
  const std::int64_t newest = 16 * (difference < 0 ? -difference : difference);
  size = first ? kSecondSize : size + ((newest - size + 1) >> 1);
}

// Codes a pose without a history.
template <class Bits>
void code_pose(Bits& bits, RoundedPose& pose, PoseSteps steps) {
  constexpr int kPositionOrder = 16;
  for (std::int64_t& coordinate : pose.position) {
    std::uint64_t folded = Bits::kReads ? 0 : fold_sign(coordinate);
    code_count(bits, folded, kPositionOrder);
    if constexpr (Bits::kReads) coordinate = unfold_sign(folded);
  }
  std::uint64_t largest = std::uint64_t(pose.largest);
  bits.code_bits(largest, 2);
  pose.largest = int(largest);
  const std::int64_t one = std::int64_t(1) << steps.orientation_bits;
  for (int i = 0; i < 4; ++i) {
    if (i == pose.largest) continue;
    std::uint64_t above = std::uint64_t(pose.orientation[i] + one);
    bits.code_bits(above, steps.orientation_bits + 2);
    pose.orientation[i] = std::int64_t(above) - one;
  }
}

// Codes the difference of a pose from its prediction.
template <class Bits>
void code_next_pose(Bits& bits, RoundedPose& pose, PoseHistory& history, PoseSteps steps) {
  RoundedPose expected = predict(history, steps);
  for (int i = 0; i < 3; ++i) {
    std::int64_t difference = pose.position[i] - expected.position[i];
    code_difference(bits, difference, history.sizes[i]);
    pose.position[i] = expected.position[i] + difference;
  }
  std::uint64_t other = pose.largest != expected.largest;
  bits.code_bits(other, 1);
  std::uint64_t largest = other ? std::uint64_t(pose.largest) : std::uint64_t(expected.largest);
  if (other) bits.code_bits(largest, 2);
  pose.largest = int(largest);
  const std::int64_t sign = expected.orientation[largest] < 0 ? -1 : 1;
  int component = 3;
  for (int i = 0; i < 4; ++i) {
    if (i == pose.largest) continue;
    std::int64_t difference = pose.orientation[i] - sign * expected.orientation[i];
    code_difference(bits, difference, history.sizes[component++]);
    pose.orientation[i] = sign * expected.orientation[i] + difference;
  }
}

// Appends the coded pose to the history. False if it is invalid, which only a reader meets.
bool advance(PoseHistory& history, RoundedPose& pose, PoseSteps steps);

}  // namespace gyre
