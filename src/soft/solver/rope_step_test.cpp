// Ropes against catenaries, Bessel's hanging chain, heavy loads and the exact elastica.
#include "soft/solver/rope_step.h"

#include "soft/elements/rope.h"
#include "soft/solver/soft_test_kit.h"

#include <gtest/gtest.h>

namespace gyre::rope_step_test {
namespace {

constexpr Vec3 kGravity{0.0f, -9.81f, 0.0f};

void run(SoftBody& rope, float step, int steps, Vec3 gravity = kGravity) {
  Arena arena;
  const RopeSettings settings{step, gravity, 10};
  for (int i = 0; i < steps; ++i) step_rope(rope, settings, arena);
}

// a cosh(x / a) between points at the same height: span 1, length, sag, end tension over weight per length.
struct CatenaryCase {
  double length, sag, tension;
};
class Catenary : public testing::TestWithParam<CatenaryCase> {};

TEST_P(Catenary, HangsAsTheFormulaSays) {
  const CatenaryCase& wanted = GetParam();
  const double deep = 0.5 * std::sqrt(wanted.length * wanted.length - 1.0);
  const DVec3 points[3] = {{0, 0, 0}, {0.5, -deep, 0}, {1, 0, 0}};
  RopeMaterial material;
  material.damping = 0.0f;
  SoftBody rope = rope_along(points, 100, material);
  hold(rope, 0, {0, 0, 0});
  hold(rope, 100, {1, 0, 0});
  run(rope, 0.1f, 100);
  EXPECT_NEAR(-rope.particles.y[50], wanted.sag, 0.003 * wanted.sag);
  // The end bears half a segment more than the middle of the first segment.
  const double weight = 9.81 * double(material.linear_density);
  EXPECT_NEAR(rope.chain.tension[0] / weight + 0.5 * wanted.length / 100, wanted.tension,
              0.003 * wanted.tension);
  for (int s = 0; s < 100; ++s) {
    const double span = length(rope.particles.place(s + 1) - rope.particles.place(s));
    EXPECT_NEAR(span / rope.chain.rest_length[s], 1.0, 1.0e-6);
  }
}
INSTANTIATE_TEST_SUITE_P(Rope, Catenary,
                         testing::Values(CatenaryCase{1.05, 0.139304, 1.058944},
                                         CatenaryCase{1.1, 0.200301, 0.855265},
                                         CatenaryCase{1.2, 0.292344, 0.761885},
                                         CatenaryCase{1.5, 0.502633, 0.810870},
                                         CatenaryCase{2.0, 0.796388, 1.026029}));

// D. Bernoulli's chain: w = j / 2 sqrt(g / L) with j the zeros of the Bessel function J0.
TEST(Rope, SwingsAtTheFrequencyOfAHangingChain) {
  const DVec3 points[2] = {{0, 0, 0}, {0, -1, 0}};
  SoftBody rope = rope_along(points, 60, {});
  hold(rope, 0, {0, 0, 0});
  // The shape of the first mode is J0(2 w sqrt(s / g)), s from the free end: 1 - u + u^2 / 4 - ..., u = w^2 s / g.
  const double square = 1.20241 * 1.20241;
  for (int i = 0; i <= 60; ++i) {
    const double u = square * (1.0 - i / 60.0);
    const double shape = 1.0 - u + u * u / 4.0 - u * u * u / 36.0 + u * u * u * u / 576.0;
    rope.particles.set_place(i, rope.particles.place(i) + DVec3{0.002 * shape, 0, 0});
  }
  Arena arena;
  const RopeSettings settings{1.0f / 1000.0f, kGravity, 3};
  double before = rope.particles.x[60], crossings[2] = {};
  int found = 0;
  for (int step = 1; step < 2000 && found < 2; ++step) {
    step_rope(rope, settings, arena);
    const double now = rope.particles.x[60];
    if (before * now < 0.0) crossings[found++] = (step - 1 + before / (before - now)) / 1000.0;
    before = now;
  }
  ASSERT_EQ(found, 2);
  const double frequency = double(kPi) / (crossings[1] - crossings[0]);
  EXPECT_NEAR(frequency, 1.20241 * std::sqrt(9.81), 0.01 * frequency);
}

TEST(Rope, CarriesTenTonnesOnOneKilogram) {
  const DVec3 points[2] = {{0, 0, 0}, {0, -10, 0}};
  RopeMaterial material;
  material.linear_density = 0.1f;
  for (const bool keeps_length : {true, false}) {
    material.keeps_length = keeps_length;
    material.damping = keeps_length ? 0.0f : 0.2f;  // it bounces otherwise
    material.stretch_stiffness = 1.0e7f;
    SoftBody rope = rope_along(points, 100, material);
    rope.particles.mass[100] += 10000.0f;
    hold(rope, 0, {0, 0, 0});
    rope.particles.set_velocity(100, {0.5f, 0, 0});
    const double wanted = 10.0 * (keeps_length ? 1.0 : 1.0 + 10000.5 * 9.81 / 1.0e7);
    double highest = 0.0;
    Arena arena;
    for (int step = 0; step < 480; ++step) {
      step_rope(rope, {1.0f / 240.0f, kGravity, 3}, arena);
      double whole = 0.0;
      for (int s = 0; s < 100; ++s) whole += length(rope.particles.place(s + 1) - rope.particles.place(s));
      if (step > 240) highest = max(highest, absolute(whole - wanted) / 10.0);
    }
    EXPECT_LT(highest, 1.0e-3) << "keeps length: " << keeps_length;
    // It swings as a pendulum of its length: within the first second to about v / w.
    EXPECT_LT(absolute(length(rope.particles.place(100)) - wanted), 0.01);
  }
}

TEST(Rope, HeldEndPullsTheRestWithinTheSubStep) {
  const DVec3 points[2] = {{0, 0, 0}, {1, 0, 0}};
  SoftBody rope = rope_along(points, 10, {});
  hold(rope, 0, {0, 0, 0});
  Arena arena;
  double at = 0.0;
  for (int step = 0; step < 100; ++step) {
    at -= 20.0 / 240.0;
    hold(rope, 0, {at, 0, 0});
    step_rope(rope, {1.0f / 240.0f, {}, 3}, arena);
    EXPECT_EQ(rope.particles.x[0], at);
    EXPECT_NEAR(rope.particles.x[10] - at, 1.0, 1.0e-6);
  }
}

TEST(Rope, KeepsItsLengthThroughAViolentSwing) {
  const DVec3 points[2] = {{0, 0, 0}, {2, 0, 0}};
  SoftBody rope = rope_along(points, 50, {});
  hold(rope, 0, {0, 0, 0});
  Arena arena;
  double worst = 0.0, energy = 1.0e30, rise = 0.0;
  for (int step = 0; step < 720; ++step) {
    step_rope(rope, {1.0f / 240.0f, kGravity, 6}, arena);
    double potential = soft_test::kinetic_energy(rope);
    for (int i = 0; i <= 50; ++i) potential += 9.81 * double(rope.particles.mass[i]) * rope.particles.y[i];
    rise = max(rise, potential - energy);
    energy = potential;
    for (int s = 0; s < 50; ++s) {
      const double span = length(rope.particles.place(s + 1) - rope.particles.place(s));
      worst = max(worst, absolute(span / rope.chain.rest_length[s] - 1.0));
    }
  }
  EXPECT_LT(worst, 1.0e-3);
  EXPECT_LT(rise, 2.0e-3 * 9.81 * 0.2 * 2.0);
}

}  // namespace
}  // namespace gyre::rope_step_test
