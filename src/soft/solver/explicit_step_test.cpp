// A stiff spring and the schemes: which explode, and from which step on.
#include "soft/solver/explicit_step.h"

#include "soft/solver/implicit_step.h"
#include "soft/solver/soft_test_kit.h"

#include <gtest/gtest.h>

namespace gyre::explicit_step_test {
namespace {

constexpr float kStiffness = 1.0e4f, kMass = 0.01f;  // w = 1000 / s
constexpr double kFrequency = 1000.0;

// A particle on a spring along x, out of its place at rest by 1 cm.
SoftBody oscillator() {
  SoftBody body;
  body.particles.resize(2);
  body.particles.set_place(1, {1.01, 0, 0});
  body.particles.mass[0] = body.particles.mass[1] = kMass;
  const Spring spring{0, 1, 1.0f, kStiffness};
  set_springs(body, {&spring, 1});
  hold(body, 0, {0, 0, 0});
  return body;
}

// The largest distance from rest in steps `from` to `to`, in units of the first.
double swing(ExplicitScheme scheme, double step, int from, int to) {
  SoftBody body = oscillator();
  soft_test::Bench bench;
  double largest = 0.0;
  for (int i = 0; i < to; ++i) {
    step_explicit(body, {float(step), {}, scheme}, bench.kernels, bench.arena, bench.tasks);
    if (i >= from) largest = max(largest, absolute(body.particles.x[1] - 1.0) / 0.01);
  }
  return largest;
}

TEST(ExplicitSchemes, ExplicitEulerGrowsAtAnyStep) {
  // The amplitude grows by sqrt(1 + (w h)^2) a step.
  for (const double turn : {0.01, 0.1, 0.5}) {
    const int steps = int(6.0 / (turn * turn));
    const double wanted = std::pow(1.0 + turn * turn, 0.5 * steps);
    const int around = int(7.0 / turn);
    const double after =
        swing(ExplicitScheme::explicit_euler, turn / kFrequency, steps - min(around, steps / 4), steps);
    EXPECT_GT(after, 0.3 * wanted) << turn;
    EXPECT_LT(after, 1.2 * wanted) << turn;
  }
}

TEST(ExplicitSchemes, SemiImplicitEulerAndVerletAreStableBelowTwoOverTheFrequency) {
  for (const ExplicitScheme scheme : {ExplicitScheme::semi_implicit_euler, ExplicitScheme::verlet}) {
    EXPECT_LT(swing(scheme, 1.99 / kFrequency, 0, 3000), 20.0);
    EXPECT_GT(swing(scheme, 2.01 / kFrequency, 0, 60), 100.0);
    EXPECT_NEAR(swing(scheme, 0.1 / kFrequency, 0, 3000), 1.0, 0.06);
  }
}

TEST(ExplicitSchemes, RungeAndKuttaIsStableBelowTheSquareRootOfEight) {
  EXPECT_LT(swing(ExplicitScheme::rk4, 2.82 / kFrequency, 0, 3000), 2.0);
  EXPECT_GT(swing(ExplicitScheme::rk4, 2.84 / kFrequency, 0, 3000), 5.0);
}

TEST(ExplicitSchemes, BackwardEulerIsStableAtTenThousandTimesTheFrequency) {
  SoftBody body = oscillator();
  soft_test::Bench bench;
  ImplicitSettings settings;
  settings.step = 10.0f;  // w h = 10,000
  for (int i = 0; i < 20; ++i) bench.step(body, settings);
  EXPECT_NEAR(body.particles.x[1], 1.0, 1.0e-6);
}

// The amplitude of backward Euler falls by 1 / sqrt(1 + (w h)^2) a step; that of the midpoint rule stays.
TEST(ExplicitSchemes, ImplicitSchemesDampAsTheirFormulasSay) {
  const double turn = 0.1;
  const int steps = 630;  // ten periods
  for (const ImplicitScheme scheme : {ImplicitScheme::backward_euler, ImplicitScheme::midpoint}) {
    SoftBody body = oscillator();
    soft_test::Bench bench;
    ImplicitSettings settings;
    settings.step = float(turn / kFrequency);
    settings.scheme = scheme;
    settings.tolerance = 1.0e-6f;
    for (int i = 0; i < steps; ++i) bench.step(body, settings);
    const double energy = elastic_energy(body) + soft_test::kinetic_energy(body);
    const double start = 0.5 * double(kStiffness) * 0.01 * 0.01;
    const double wanted = scheme == ImplicitScheme::midpoint ? 1.0 : std::pow(1.0 + turn * turn, -steps);
    EXPECT_NEAR(energy / start / wanted, 1.0, 0.01);
  }
}

}  // namespace
}  // namespace gyre::explicit_step_test
