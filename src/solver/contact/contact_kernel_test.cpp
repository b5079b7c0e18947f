// The contact kernels at the limits of floats.
#include "base/arena/arena.h"
#include "base/processor.h"
#include "solver/kernels/solver_kernels.h"

#include <gtest/gtest.h>

#include <cmath>
#include <cstddef>
#include <vector>

namespace gyre::contact_kernel_test {
namespace {

// The first lane of a block, with memory of its own.
struct OneContact {
  const SolverKernels& kernels;
  Arena arena;
  std::vector<std::uint32_t> order;
  void* block = arena.make<std::byte>(kernels.contacts.block_bytes).data();
  void* cold = arena.make<std::byte>(kernels.contacts.cold_bytes).data();
  ContactSettings settings{.substep = 1.0f / 240.0f, .step = 1.0f / 60.0f, .rate = 9.0f, .up = {0, 1, 0}};

  explicit OneContact(int width)
      : kernels(select_kernels(width)), order(std::size_t(kernels.width), 0xffffffffu) {
    order[0] = 0;
  }
  void prepare(const ContactConstraint& constraint, BodyMotion& motion, const BodyInertia& inertia) {
    kernels.contacts.prepare(block, cold, 0, 1, &constraint, order.data(), {&motion, &inertia}, settings);
  }
};

// A ball on static ground, with a load from the last step; solved for a sub-step of a 240th of a second. `arm`: from the ground's centre.
BodyMotion touch(int width, float load, Vec3 arm = {0.3f, 0.5f, 0.2f}) {
  Manifold manifold;
  manifold.count = 1;
  manifold.points[0].from_b = {0, -0.15f, 0};
  manifold.points[0].from_a = arm;
  manifold.points[0].normal_impulse = load;
  manifold.friction_impulse = {0.1f * load, 0, 0};
  ContactConstraint constraint;
  constraint.static_friction = constraint.dynamic_friction = 0.5f;
  constraint.size = 0.15f;
  constraint.body_b = 0;
  constraint.manifold = &manifold;
  BodyMotion motion;
  motion.linear_velocity = {0, -1e-3f, 0.2f};
  motion.angular_velocity = {1, 0, 0};
  motion.inverse_mass = 1.0f;
  BodyInertia inertia;
  inertia.inverse = {.xx = 100.0f, .yy = 100.0f, .zz = 100.0f};
  inertia.inverse_mass = 1.0f;
  OneContact contact(width);
  contact.prepare(constraint, motion, inertia);
  contact.kernels.contacts.warm_start(contact.block, 0, 1);
  contact.kernels.contacts.solve(contact.block, 0, 1, contact.settings.substep);
  return motion;
}

bool is_finite(const BodyMotion& m) {
  const float sum = length_squared(m.linear_velocity) + length_squared(m.angular_velocity);
  return std::isfinite(sum);
}

// A kernel divided by a load that died away: below 3e-39 that is infinite, and a ball that rolled out froze.
TEST(ContactKernel, TakesAnyLoadThatAFloatCanHold) {
  for (const int width : {0, 1, 4, 8, 16}) {
    for (float load = 1.0f; load > 0.0f; load *= 0.1f) {
      const BodyMotion motion = touch(width, load);
      ASSERT_TRUE(is_finite(motion)) << "width " << width << ", load " << load;
      // Friction takes no more than the load allows: the ground stops the fall, 1e-3 N s, and the accumulated
      // load.
      const float change = std::fabs(motion.linear_velocity.z - 0.2f);
      ASSERT_LE(change, 0.51f * (1e-3f + 2.0f * load)) << "width " << width << ", load " << load;
    }
  }
}

// At width 1 the ground was a body whose angular velocity became zero times infinity.
TEST(ContactKernel, ImpulsesThatOverflowAtTheGroundAreTheSameAtEveryWidth) {
  const Vec3 far{1.0e17f, 3.0e17f, 2.0e17f};
  const BodyMotion expected = touch(1, 1.0e24f, far);
  EXPECT_TRUE(std::isfinite(expected.linear_velocity.x) && std::isfinite(expected.angular_velocity.x));
  EXPECT_NE(expected.linear_velocity, touch(1, 1.0f, far).linear_velocity);
  for (const int width : {4, 8, 16}) {
    const BodyMotion motion = touch(width, 1.0e24f, far);
    EXPECT_EQ(motion.linear_velocity, expected.linear_velocity) << width;
    EXPECT_EQ(motion.angular_velocity, expected.angular_velocity) << width;
  }
}

// With automatic width, eight lanes on a processor that has sixteen use its registers; with a set width they
// are those of any AVX2.
TEST(ContactKernel, AutomaticEightLanesUseTheRegistersOfSixteen) {
  const SolverKernels &best = select_kernels(0), &chosen = select_kernels(8);
  if (max_lanes() < 16) {
    EXPECT_EQ(&best, &select_kernels(best.width));
    return;
  }
  EXPECT_EQ(chosen.width, 8);
  const SolverKernels& eight = best.width == 8 ? best : narrower_kernels(best);
  EXPECT_EQ(eight.width, 8);
  EXPECT_NE(&eight, &chosen);
}

// A bone of 0.4 m on static ground. First its left end carries the load and friction, then its right end.
struct Bone {
  BodyMotion motion;
  BodyInertia inertia{.inverse = {.xx = 100.0f, .yy = 80.0f, .zz = 90.0f}, .inverse_mass = 1.0f};
  Arena arena;
  const SolverKernels& kernels;
  void* const block;
  void* const cold;
  AdvancedArms arms;

  explicit Bone(int width)
      : kernels(select_kernels(width)),
        block(arena.make<std::byte>(kernels.contacts.block_bytes).data()),
        cold(arena.make<std::byte>(kernels.contacts.cold_bytes).data()) {
    motion.inverse_mass = 1.0f;
    Manifold manifold;
    manifold.count = arms.count = 2;
    for (int k = 0; k < 2; ++k) {
      manifold.points[k].from_b = {k == 0 ? -0.2f : 0.2f, -0.05f, 0};
      arms.now.from_a[k] = manifold.points[k].from_a;
      arms.now.from_b[k] = manifold.points[k].from_b;
    }
    arms.before = arms.middle = arms.now;
    manifold.points[0].normal_impulse = 3.0f;
    manifold.friction_impulse = kFriction;
    ContactConstraint constraint;
    constraint.static_friction = constraint.dynamic_friction = 0.5f;
    constraint.size = 0.05f;
    constraint.body_b = 0;
    constraint.manifold = &manifold;
    std::vector<std::uint32_t> order(std::size_t(kernels.width), 0xffffffffu);
    order[0] = 0;
    const ContactSettings settings{
        .substep = 1.0f / 240.0f, .step = 1.0f / 60.0f, .rate = 9.0f, .up = {0, 1, 0}};
    kernels.contacts.prepare(block, cold, 0, 1, &constraint, order.data(), {&motion, &inertia}, settings);
    kernels.contacts.warm_start(block, 0, 1);
  }
  void follow() {
    const AdvancedArmsLane lane{0, &arms, nullptr, &inertia.inverse};
    kernels.contacts.advance_points(block, 0, &lane, 1);
  }
  static constexpr Vec3 kFriction{0, 0, 1.2f};
};

// The same impulse was given at one end and removed at the other: a bone thrown on the ground left it with
// six times its energy.
TEST(ContactKernel, FrictionGoesWhereTheLoadGoes) {
  for (const int width : {0, 1, 4, 8, 16}) {
    Bone bone(width);
    bone.follow();
    const Vec3 before = bone.motion.angular_velocity;
    ContactImpulse right{.normal = {0, 3.0f}, .friction = Bone::kFriction};
    bone.kernels.contacts.write_impulse(bone.block, 0, 0, right);
    bone.follow();
    const Vec3 expected = bone.inertia.inverse * cross(Vec3{0.4f, 0, 0}, Bone::kFriction);
    EXPECT_LT(length(bone.motion.angular_velocity - before - expected), 1e-5f * length(expected)) << width;
  }
}

// A bounce finds a manifold anew within the step. Points that its block had no room for kept the mean load of points that they
// replaced, unless another lane had as many: the state depended on the width.
TEST(ContactKernel, PointsFoundAtAnImpactEndTheStepWithoutLoad) {
  for (const int width : {0, 1, 4, 8, 16}) {
    Manifold manifold;
    manifold.count = 1;
    ContactConstraint constraint;
    constraint.size = 0.15f;
    constraint.body_b = 0;
    constraint.manifold = &manifold;
    BodyMotion motion;
    motion.inverse_mass = 1.0f;
    BodyInertia inertia{.inverse = {.xx = 100.0f, .yy = 100.0f, .zz = 100.0f}, .inverse_mass = 1.0f};
    OneContact contact(width);
    contact.prepare(constraint, motion, inertia);
    manifold.count = kMaxManifoldPoints;
    for (ContactPointState& point : manifold.points) point.mean_impulse = 1.0f;
    manifold.points[3].total_impulse = 2.0f;  // of the bounce
    contact.kernels.contacts.finish(contact.block, 0, 1, &constraint, contact.order.data(), contact.settings);
    for (const ContactPointState& point : manifold.points) {
      EXPECT_EQ(point.mean_impulse, 0.0f) << width;
      EXPECT_EQ(point.normal_impulse, 0.0f) << width;
    }
    EXPECT_EQ(manifold.points[3].total_impulse, 2.0f) << width;
  }
}

}  // namespace
}  // namespace gyre::contact_kernel_test
