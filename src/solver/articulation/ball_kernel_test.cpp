// Ball joints side by side have the bits of each joint solved alone, at every width.
#include "base/arena/arena.h"
#include "math/rotation.h"
#include "solver/articulation/ball_joint_transfer.h"
#include "solver/kernels/solver_kernels.h"

#include <gtest/gtest.h>

#include <cstring>
#include <vector>

namespace gyre::ball_kernel_test {
namespace {

constexpr int kJoints = 11;  // no whole number of blocks at any width but one
constexpr float kSubstep = 1.0f / 480.0f;
const JointSettings kSettings{kSubstep, {40.0f, 0.96f, 0.04f}, true};

// Pairs of bodies; some are joined to the world, one to an immovable body.
struct Pairs {
  Arena arena;
  std::vector<BodyMotion> motion{std::size_t(2 * kJoints)};
  std::vector<BodyInertia> inertia{std::size_t(2 * kJoints)};
  std::vector<Quat> orientation{std::size_t(2 * kJoints)};
  std::vector<JointRecord> records{std::size_t(kJoints)};
  std::vector<JointConstraint> work{std::size_t(kJoints)};
  std::vector<JointOffsets> places{std::size_t(kJoints)};

  Pairs() {
    std::uint32_t state = 7;
    const auto next = [&] {  // -1 to 1
      state = state * 1664525u + 1013904223u;
      return float(state >> 8) / float(1 << 23) - 1.0f;
    };
    const auto vector = [&](float size) { return Vec3{size * next(), size * next(), size * next()}; };
    for (std::size_t i = 0; i < motion.size(); ++i) {
      motion[i].linear_velocity = vector(3.0f);
      motion[i].angular_velocity = vector(8.0f);
      motion[i].delta_position = vector(0.01f);
      orientation[i] = from_rotation_vector(vector(1.0f));
      if (i == 4) continue;
      motion[i].inverse_mass = inertia[i].inverse_mass = 1.0f + 0.5f * next();
      inertia[i].inverse = {
          .xx = 20 + next(), .yy = 30 + next(), .zz = 25 + next(), .xy = next(), .xz = next()};
    }
    for (std::size_t i = 0; i < records.size(); ++i) {
      JointRecord& joint = records[i];
      joint.body_a = i % 4 == 3 ? kNoBody : std::int32_t(2 * i);
      joint.body_b = std::int32_t(2 * i + 1);
      joint.local_anchor_a = joint.body_a == kNoBody ? Vec3{} : vector(0.3f);
      joint.local_anchor_b = vector(0.3f);
      joint.linear_impulse = vector(0.1f);
      places[i].offset = vector(0.1f);
      begin_joint(joint, nullptr, {}, work[i], 1.0f, arena);
    }
  }
  JointBodies bodies() { return {motion.data(), inertia.data(), orientation.data()}; }
};

void solve_alone(Pairs& pairs) {
  for (std::size_t i = 0; i < kJoints; ++i) {
    JointRecord& joint = pairs.records[i];
    JointConstraint& work = pairs.work[i];
    const JointBodies bodies = pairs.bodies();
    prepare_joint(joint, work, pairs.places[i], bodies, kSettings);
    update_joint_bias(joint, work, bodies, kSettings);
    warm_start_joint(joint, work, bodies);
    solve_joint(joint, work, bodies, kSettings, true);
    solve_joint(joint, work, bodies, kSettings, false);
    accumulate_joint_impulses(joint, work, bodies);
  }
}

void solve_side_by_side(Pairs& pairs, int width) {
  const BallKernels& kernels = select_kernels(width).balls;
  const int blocks = (kJoints + kernels.width - 1) / kernels.width;
  Arena arena;
  void* const memory = arena.make<std::byte>(std::size_t(blocks) * kernels.block_bytes).data();
  const BallArrays arrays{pairs.motion.data(), pairs.inertia.data(), pairs.orientation.data()};
  const Softness& softness = kSettings.softness;
  const BallSettings settings{kSubstep, softness.bias_rate, softness.mass_scale, softness.impulse_scale};
  clear_balls(kernels, memory, blocks - 1);
  for (int i = 0; i < kJoints; ++i) {
    ASSERT_TRUE(fits_ball_lane(pairs.records[std::size_t(i)], nullptr));
    begin_ball(kernels, memory, i / kernels.width, i % kernels.width, pairs.records[std::size_t(i)],
               pairs.places[std::size_t(i)].offset, 1.0f, true, pairs.inertia.data());
  }
  kernels.locate(memory, 0, blocks, arrays);
  kernels.prepare(memory, 0, blocks, arrays);
  kernels.update_bias(memory, 0, blocks, settings);
  kernels.warm_start(memory, 0, blocks);
  kernels.solve(memory, 0, blocks, settings);
  kernels.relax(memory, 0, blocks);
  for (int i = 0; i < kJoints; ++i)
    finish_ball(kernels, memory, i / kernels.width, i % kernels.width, pairs.records[std::size_t(i)]);
}

TEST(BallKernel, LanesHaveTheBitsOfSingleJoints) {
  Pairs alone;
  const Pairs untouched;
  solve_alone(alone);
  EXPECT_NE(std::memcmp(alone.motion.data(), untouched.motion.data(), sizeof(BodyMotion)), 0);
  EXPECT_EQ(std::memcmp(&alone.motion[4], &untouched.motion[4], sizeof(BodyMotion)), 0)
      << "nothing pushes it";
  for (const int width : {0, 1, 4, 8, 16}) {
    Pairs pairs;
    solve_side_by_side(pairs, width);
    const std::size_t bytes = pairs.motion.size() * sizeof(BodyMotion);
    EXPECT_EQ(std::memcmp(pairs.motion.data(), alone.motion.data(), bytes), 0) << "width " << width;
    for (std::size_t i = 0; i < kJoints; ++i) {
      const JointRecord &a = pairs.records[i], &b = alone.records[i];
      EXPECT_EQ(a.linear_impulse, b.linear_impulse) << "width " << width << ", joint " << i;
      EXPECT_EQ(a.total_linear, b.total_linear) << "width " << width << ", joint " << i;
    }
  }
}

}  // namespace
}  // namespace gyre::ball_kernel_test
