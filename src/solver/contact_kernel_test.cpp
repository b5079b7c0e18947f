// The contact kernels at the edge of what floats can say.
#include "base/arena.h"
#include "solver/contact_block.h"

#include <gtest/gtest.h>

#include <cmath>
#include <cstddef>
#include <vector>

namespace gyre {
namespace {

// A ball on fixed ground, with a load from the step before; solved for a sub-step of a 240th of a second.
BodyMotion touch(int width, float load) {
  const ContactKernels& kernels = select_contact_kernels(width);
  Manifold manifold;
  manifold.count = 1;
  manifold.points[0].from_b = {0, -0.15f, 0};
  manifold.points[0].from_a = {0.3f, 0.5f, 0.2f};
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
  std::vector<std::uint32_t> order(std::size_t(kernels.width), 0xffffffffu);
  order[0] = 0;
  Arena arena;
  void* const block = arena.make<std::byte>(kernels.block_bytes).data();
  void* const aside = arena.make<std::byte>(kernels.aside_bytes).data();
  const ContactSettings settings{
      .substep = 1.0f / 240.0f, .step = 1.0f / 60.0f, .rate = 9.0f, .up = {0, 1, 0}};
  kernels.prepare(block, aside, 0, 1, &constraint, order.data(), {&motion, &inertia}, settings);
  kernels.warm_start(block, 0, 1);
  kernels.solve(block, 0, 1, settings.substep);
  return motion;
}

bool is_finite(const BodyMotion& m) {
  const float sum = length_squared(m.linear_velocity) + length_squared(m.angular_velocity);
  return std::isfinite(sum);
}

// A load that died away was divided by: below 3e-39 that is infinite, and a ball that rolled out was frozen.
TEST(ContactKernel, TakesAnyLoadThatAFloatCanHold) {
  for (const int width : {1, 4, 8, 16}) {
    for (float load = 1.0f; load > 0.0f; load *= 0.1f) {
      const BodyMotion motion = touch(width, load);
      ASSERT_TRUE(is_finite(motion)) << "width " << width << ", load " << load;
      // Friction takes no more than the load allows: the ground stops the fall, 1e-3 N s, and what stood.
      const float change = std::fabs(motion.linear_velocity.z - 0.2f);
      ASSERT_LE(change, 0.51f * (1e-3f + 2.0f * load)) << "width " << width << ", load " << load;
    }
  }
}

}  // namespace
}  // namespace gyre
