// Rounds and predicts poses. See pose_codec.h.
#include "io/track/pose_codec.h"

#include <cmath>

namespace gyre {

namespace {

// The floor of value + 0.5. std::floor would be a function call on processors without an instruction for it.
std::int64_t nearest(double value) {
  const double above = value + 0.5;
  const auto whole = std::int64_t(above);
  return whole - (double(whole) > above ? 1 : 0);
}

std::int64_t magnitude(std::int64_t value) { return value < 0 ? -value : value; }

int largest_of(const std::int64_t (&q)[4]) {
  int largest = 0;
  for (int i = 1; i < 4; ++i) {
    if (magnitude(q[i]) > magnitude(q[largest])) largest = i;
  }
  return largest;
}

std::int64_t dot(const std::int64_t (&a)[4], const std::int64_t (&b)[4]) {
  return a[0] * b[0] + a[1] * b[1] + a[2] * b[2] + a[3] * b[3];
}

// The square of the largest component from the others, in rounding steps.
std::int64_t left_for_largest(const RoundedPose& pose, PoseSteps steps) {
  std::int64_t left = std::int64_t(1) << 2 * steps.orientation_bits;
  for (int i = 0; i < 4; ++i) {
    if (i != pose.largest) left -= pose.orientation[i] * pose.orientation[i];
  }
  return left;
}

}  // namespace

bool complete_orientation(RoundedPose& pose, PoseSteps steps) {
  const std::int64_t left = left_for_largest(pose, steps);
  if (left <= 0) return false;
  // Below 2^41, so exact in double, and the root is correctly rounded everywhere.
  pose.orientation[pose.largest] = nearest(std::sqrt(double(left)));
  return true;
}

std::int64_t round_coordinate(double coordinate, PoseSteps steps) {
  const double scaled = coordinate * power_of_two(steps.position_bits);
  const double limit = double(kMaxPosition);
  return scaled >= limit ? kMaxPosition : scaled <= -limit ? -kMaxPosition : nearest(scaled);
}

RoundedPose round_pose(const Pose& pose, PoseSteps steps) {
  RoundedPose rounded;
  for (int i = 0; i < 3; ++i) rounded.position[i] = round_coordinate(pose.position[i], steps);
  const Quat q = pose.orientation == Quat{0, 0, 0, 0} ? Quat{} : pose.orientation;
  const double components[4] = {double(q.x), double(q.y), double(q.z), double(q.w)};
  double square = 0.0;
  for (const double component : components) square += component * component;
  const double scale = power_of_two(steps.orientation_bits) / std::sqrt(square);
  for (int i = 0; i < 4; ++i) rounded.orientation[i] = nearest(components[i] * scale);
  rounded.largest = largest_of(rounded.orientation);
  if (rounded.orientation[rounded.largest] < 0) {
    for (std::int64_t& component : rounded.orientation) component = -component;
  }
  complete_orientation(rounded, steps);
  return rounded;
}

Pose unrounded(const RoundedPose& pose, PoseSteps steps) {
  const double metre = power_of_two(-steps.position_bits);
  const double unit = power_of_two(-steps.orientation_bits);
  float components[4];
  for (int i = 0; i < 4; ++i) {
    const double component =
        i == pose.largest ? std::sqrt(double(left_for_largest(pose, steps))) : double(pose.orientation[i]);
    components[i] = float(component * unit);
  }
  return {
      {double(pose.position[0]) * metre, double(pose.position[1]) * metre, double(pose.position[2]) * metre},
      {components[0], components[1], components[2], components[3]}};
}

// Three components of the quaternion are off by half a rounding step each. The largest component, at least 1/2 but
// for rounding, is off by the change that keeps the length 1. The whole error is at most twice that of the three. An
// angle is twice the displacement of the quaternion. Floats add their last bits.
TrackAccuracy accuracy_of(PoseSteps steps) {
  constexpr double kFloatBits = 4.0e-7;
  const double unit = power_of_two(-steps.orientation_bits);
  return {0.5 * power_of_two(-steps.position_bits),
          2.0 * std::sqrt(3.0) * (1.0 + 8.0 * unit) * unit + kFloatBits};
}

PoseHistory begin_history(const RoundedPose& pose) {
  PoseHistory history;
  history.now = history.before = pose;
  return history;
}

RoundedPose predict(const PoseHistory& history, PoseSteps steps) {
  RoundedPose expected;
  for (int i = 0; i < 3; ++i) {
    expected.position[i] = 2 * history.now.position[i] - history.before.position[i];
  }
  // Applies the last rotation again: now * before^-1 * now, which for unit quaternions is 2 (now . before) now -
  // before. For -before the result has the other sign; the code of a pose chooses its sign.
  const std::int64_t twice_dot = 2 * dot(history.now.orientation, history.before.orientation);
  const int shift = 2 * steps.orientation_bits;
  const std::int64_t half = std::int64_t(1) << (shift - 1);
  for (int i = 0; i < 4; ++i) {
    expected.orientation[i] =
        ((twice_dot * history.now.orientation[i] + half) >> shift) - history.before.orientation[i];
  }
  expected.largest = largest_of(expected.orientation);
  return expected;
}

bool advance(PoseHistory& history, RoundedPose& pose, PoseSteps steps) {
  for (const std::int64_t coordinate : pose.position) {
    if (magnitude(coordinate) > kMaxPosition) return false;
  }
  const std::int64_t one = std::int64_t(1) << steps.orientation_bits;
  for (int i = 0; i < 4; ++i) {
    if (i != pose.largest && magnitude(pose.orientation[i]) > one) return false;
  }
  if (!complete_orientation(pose, steps)) return false;
  history.before = history.now;
  history.now = pose;
  return true;
}

}  // namespace gyre
