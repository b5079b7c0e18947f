#include "io/track/pose_codec.h"

#include "base/hash.h"

#include <gtest/gtest.h>

#include <cmath>

namespace gyre::pose_codec_test {
namespace {

struct Random {
  std::uint64_t state = 1;
  double unit() {  // [-1, 1]
    state = state * 6364136223846793005u + 1442695040888963407u;
    return double(state >> 11) / 4503599627370496.0 - 1.0;
  }
  Quat orientation() {
    for (;;) {
      const Quat q{float(unit()), float(unit()), float(unit()), float(unit())};
      if (dot(q, q) > 0.01f && dot(q, q) <= 1.0f) return normalized(q);
    }
  }
};

double angle_between(Quat a, Quat b) {
  // In double, and by the chord: exact for small angles.
  const double pa[] = {a.x, a.y, a.z, a.w}, pb[] = {b.x, b.y, b.z, b.w};
  double na = 0, nb = 0;
  for (int i = 0; i < 4; ++i) na += pa[i] * pa[i], nb += pb[i] * pb[i];
  double minus = 0, plus = 0;
  for (int i = 0; i < 4; ++i) {
    const double u = pa[i] / std::sqrt(na), v = pb[i] / std::sqrt(nb);
    minus += (u - v) * (u - v), plus += (u + v) * (u + v);
  }
  return 4.0 * std::asin(0.5 * std::sqrt(std::min(minus, plus)));
}

TEST(PoseCodec, RoundingStaysWithinTheStatedAccuracy) {
  Random random;
  for (const PoseSteps steps : {PoseSteps{}, PoseSteps{0, 8}, PoseSteps{30, 20}, PoseSteps{-5, 12}}) {
    const TrackAccuracy accuracy = accuracy_of(steps);
    double worst = 0.0, worst_angle = 0.0;
    for (int i = 0; i < 20'000; ++i) {
      const Pose pose{{1000 * random.unit(), 1000 * random.unit(), 1000 * random.unit()},
                      random.orientation()};
      const Pose back = unrounded(round_pose(pose, steps), steps);
      for (int axis = 0; axis < 3; ++axis)
        worst = std::max(worst, std::abs(back.position[axis] - pose.position[axis]));
      worst_angle = std::max(worst_angle, angle_between(pose.orientation, back.orientation));
      ASSERT_NEAR(length(DVec3{back.orientation.x, back.orientation.y, back.orientation.z}) *
                          length(DVec3{back.orientation.x, back.orientation.y, back.orientation.z}) +
                      double(back.orientation.w) * double(back.orientation.w),
                  1.0, 3e-7);
    }
    EXPECT_LE(worst, accuracy.position);
    EXPECT_GT(worst, 0.98 * accuracy.position);
    EXPECT_LE(worst_angle, accuracy.orientation);
    EXPECT_GT(worst_angle, 0.5 * accuracy.orientation);  // the bound is that of the worst direction
  }
  EXPECT_LE(accuracy_of({}).position, 1.0e-4);
  EXPECT_LE(accuracy_of({}).orientation, 1.0e-4);
}

TEST(PoseCodec, RoundingARoundedPoseChangesNothing) {
  Random random;
  for (int i = 0; i < 5000; ++i) {
    const RoundedPose once =
        round_pose({{random.unit(), random.unit(), random.unit()}, random.orientation()}, {});
    const RoundedPose twice = round_pose(unrounded(once, {}), {});
    for (int axis = 0; axis < 3; ++axis) EXPECT_EQ(once.position[axis], twice.position[axis]);
    EXPECT_LE(angle_between(unrounded(once, {}).orientation, unrounded(twice, {}).orientation), 1e-6);
  }
}

TEST(PoseCodec, StrangePosesAreStoredAllTheSame) {
  for (const Quat q : {Quat{0, 0, 0, 0}, Quat{1, 0, 0, 0}, Quat{0, 0, 0, -1}, Quat{0.5f, 0.5f, 0.5f, 0.5f},
                       Quat{3, 4, 0, 0}, Quat{1e-38f, 0, 0, 0}, Quat{-0.5f, 0.5f, -0.5f, -0.5f}}) {
    RoundedPose rounded = round_pose({{1e300, -1e300, 0}, q}, {});
    EXPECT_EQ(rounded.position[0], kMaxPosition);
    EXPECT_EQ(rounded.position[1], -kMaxPosition);
    EXPECT_GT(rounded.orientation[rounded.largest], 0);
    PoseHistory history;
    EXPECT_TRUE(advance(history, rounded, {}));
    const Quat expected = q == Quat{0, 0, 0, 0} ? Quat{} : q;
    EXPECT_LE(angle_between(unrounded(rounded, {}).orientation, expected), accuracy_of({}).orientation);
  }
}

TEST(PoseCodec, EveryDifferenceComesBackWhateverWasExpected) {
  std::vector<std::int64_t> values = {0, 1, -1, 2, -2};
  for (int bit = 2; bit < 55; ++bit) {
    const std::int64_t power = std::int64_t(1) << bit;
    for (const std::int64_t near : {power - 1, power, power + 1})
      values.push_back(near), values.push_back(-near);
  }
  for (const std::int64_t start : values) {
    BitWriter writer;
    std::int64_t size = start < 0 ? -1 : 16 * start;
    for (std::int64_t value : values) code_difference(writer, value, size);
    const std::vector<std::byte> bytes = writer.take();
    BitReader reader(bytes);
    std::int64_t read_size = start < 0 ? -1 : 16 * start;
    for (const std::int64_t value : values) {
      std::int64_t read = 77;
      code_difference(reader, read, read_size);
      ASSERT_EQ(read, value) << start;
    }
    EXPECT_EQ(size, read_size);
    EXPECT_TRUE(reader.finished());
  }
}

// A body that flies, turns, is hit, jumps and rests.
std::vector<Pose> adventure(int frames) {
  Random random;
  std::vector<Pose> poses;
  Pose pose{{100, 20, -30}, random.orientation()};
  DVec3 way{0.02, 0.1, 0};
  Vec3 turn{0.1f, 0.02f, 0};
  for (int i = 0; i < frames; ++i) {
    poses.push_back(pose);
    if (i % 50 == 49) way = {0.1 * random.unit(), 0.1 * random.unit(), 0.1 * random.unit()};
    if (i % 70 == 69) turn = {float(random.unit()), float(random.unit()), float(random.unit())};
    if (i % 111 == 110)
      pose = {{1e6 * random.unit(), random.unit(), 1e9 * random.unit()}, random.orientation()};
    if (i % 200 > 150) continue;
    way = way + DVec3{0, -0.0027, 0};
    pose.position = pose.position + way;
    pose.orientation = normalized(from_rotation_vector(turn) * pose.orientation);
    if (i % 3 == 0) pose.orientation = -pose.orientation;  // the same orientation
  }
  return poses;
}

std::vector<std::byte> coded(const std::vector<Pose>& poses, PoseSteps steps) {
  BitWriter writer;
  RoundedPose first = round_pose(poses[0], steps);
  code_pose(writer, first, steps);
  PoseHistory history = begin_history(first);
  for (std::size_t i = 1; i < poses.size(); ++i) {
    RoundedPose pose = round_pose(poses[i], steps);
    code_next_pose(writer, pose, history, steps);
    EXPECT_TRUE(advance(history, pose, steps));
  }
  return writer.take();
}

TEST(PoseCodec, AnyMotionComesBackWithinTheAccuracyHoweverLong) {
  const std::vector<Pose> poses = adventure(20'000);
  const PoseSteps steps;
  const std::vector<std::byte> bytes = coded(poses, steps);
  BitReader reader(bytes);
  RoundedPose pose;
  code_pose(reader, pose, steps);
  PoseHistory checked;
  ASSERT_TRUE(advance(checked, pose, steps));
  PoseHistory history = begin_history(pose);
  const TrackAccuracy accuracy = accuracy_of(steps);
  for (std::size_t i = 0; i < poses.size(); ++i) {
    if (i > 0) {
      RoundedPose next;
      code_next_pose(reader, next, history, steps);
      ASSERT_TRUE(advance(history, next, steps));
    }
    const Pose back = unrounded(history.now, steps);
    ASSERT_LE(angle_between(back.orientation, poses[i].orientation), accuracy.orientation) << i;
    for (int axis = 0; axis < 3; ++axis)
      ASSERT_LE(std::abs(back.position[axis] - poses[i].position[axis]), accuracy.position) << i;
  }
  EXPECT_TRUE(reader.finished());
}

TEST(PoseCodec, WhatGoesOnAsBeforeCostsNextToNothing) {
  std::vector<Pose> still(1000), gliding(1000), turning(1000);
  const Quat turn = from_rotation_vector({0, 0.03125f, 0});
  for (std::size_t i = 0; i < 1000; ++i) {
    gliding[i].position = {0.25 * double(i), -0.125 * double(i), 3.0};
    if (i > 0) turning[i].orientation = normalized(turn * turning[i - 1].orientation);
  }
  EXPECT_LT(coded(still, {}).size(), 920u);  // seven bits a frame and the beginning
  EXPECT_LT(coded(gliding, {}).size(), 950u);
  EXPECT_LT(coded(turning, {}).size(), 1800u);  // its rounding is not smooth
}

// The same on every machine: no engine between these numbers and the bytes.
TEST(PoseCodec, TheBytesAreTheSameEverywhere) {
  std::vector<Pose> poses;
  Random random;
  for (int i = 0; i < 500; ++i) {
    const float s = float(i) / 512.0f;
    poses.push_back({{double(i) * 0.125, double(i * i) * 0.001, -3.0 * random.unit()},
                     normalized(Quat{s, 0.25f, 1.0f - s, 0.5f * s})});
  }
  const std::vector<std::byte> bytes = coded(poses, {});
  EXPECT_EQ(bytes.size(), 2053u);
  EXPECT_EQ(hash_bytes(bytes.data(), bytes.size()), 11162220594152152047u);
}

TEST(PoseCodec, BytesThatAreNoPoseAreRefused) {
  PoseHistory history;
  RoundedPose pose = round_pose({}, {});
  pose.orientation[0] = pose.orientation[1] = 1 << 16;  // leaves nothing for w
  EXPECT_FALSE(advance(history, pose, {}));
  pose = round_pose({}, {});
  pose.position[2] = kMaxPosition + 1;
  EXPECT_FALSE(advance(history, pose, {}));
  const std::vector<std::byte> ones(64, std::byte(0xff));
  BitReader reader(ones);
  std::int64_t difference = 1, size = -1;
  code_difference(reader, difference, size);  // 63 bits are more than a difference has
  EXPECT_TRUE(reader.failed());
  EXPECT_EQ(difference, 0);
}

}  // namespace
}  // namespace gyre::pose_codec_test
