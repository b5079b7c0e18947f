// Springs: frequency, damping, sag, stiffness beyond the step, and the modes of two masses. Closed forms.
#include "laws/kit.h"

namespace gyre::laws::spring_test {
namespace {

// A mass on a spring of rest length 2 m along x from the origin, pulled 0.5 m.
struct Oscillator {
  World world;
  BodyId mass;
  JointId spring;
};
Oscillator pulled(double stiffness, double damping, float geometric_stiffness = 0.5f) {
  Oscillator o{make_world({.gravity = {0, 0, 0}, .sleeping = false}), {}, {}};
  o.mass = o.world.add_body(point_body(1.0, {1, 1, 1}, {2.0 + double(geometric_stiffness), 0, 0}));
  o.spring = o.world.add_joint(DistanceDef{.b = o.mass,
                                           .anchor = {0, 0, 0},
                                           .length = 2.0f,
                                           .stiffness = float(stiffness),
                                           .damping = float(damping)});
  return o;
}

TEST(Spring, FrequencyAndAmplitudeLast) {
  for (const double hertz : {1.0, 2.0, 5.0}) {
    const double omega = 2.0 * kPiDouble * hertz;
    Oscillator o = pulled(omega * omega, 0.0);
    ZeroCrossings through;
    double late = 0.0;
    for (int i = 0; i < 1200; ++i) {
      const double x = o.world.pose(o.mass).position.x - 2.0;
      through.add(double(i) * double(kStep), x);
      if (i > 1080)
        late = std::max(late, x);  // these periods are whole numbers of steps: the peak is sampled
      o.world.step(kStep);
    }
    EXPECT_TRUE(relative_row("A-50 period", through.mean_period(), 1.0 / hertz, 1e-2, 1e-4));
    EXPECT_TRUE(relative_row("A-50 amplitude after 20 s", late, 0.5, 1e-2, 1e-4));
  }
}

TEST(Spring, DampedResponse) {
  const double ratios[] = {0.1, 0.5, 1.0};
  const double places[] = {-0.36458, -0.07035, 0.08949};
  for (int k = 0; k < 3; ++k) {
    const double omega = 2.0 * kPiDouble;
    Oscillator o = pulled(omega * omega, 2.0 * ratios[k] * omega);
    double peak = 0.0;
    for (int i = 1; i <= 90; ++i) {
      o.world.step(kStep);
      const double x = o.world.pose(o.mass).position.x - 2.0;
      if (i == 30) {
        EXPECT_TRUE(relative_row("A-52 place after 0.5 s", x, places[k], 0.1, 1e-3));
      }
      if (i > 45) peak = std::max(peak, x);
    }
    if (k == 0) {
      EXPECT_TRUE(relative_row("A-52 ratio of peaks", peak / 0.5, 0.5318, 0.1, 1e-3));
    }
  }
}

// By frequency and damping: between two bodies, with the anchor of one off its centre, so that turning takes part.
TEST(Spring, IsToldByItsFrequency) {
  const double ratios[] = {0.0, 0.1, 0.5};
  for (const double ratio : ratios) {
    World world = make_world({.gravity = {0, 0, 0}, .sleeping = false});
    const BodyId a = world.add_body(point_body(2.0, {0.3f, 0.3f, 0.3f}, {0, 0, 0}));
    const BodyId b = world.add_body(point_body(3.0, {0.5f, 0.5f, 0.5f}, {2.01, 0, 0}));
    const JointId spring = world.add_joint(DistanceDef{.a = a,
                                                       .b = b,
                                                       .anchor = {0, 0.2, 0},
                                                       .anchor_b = DVec3{2.01, 0.2, 0},
                                                       .length = 2.0f,
                                                       .frequency = 2.0f,
                                                       .damping_ratio = float(ratio)});
    ASSERT_TRUE(spring);
    // Small swings: the line keeps its direction, and the effective mass its value.
    const double damped = std::sqrt(1.0 - ratio * ratio);
    ZeroCrossings through;
    double peak = 0.0;
    for (int i = 0; i < 240; ++i) {
      const double x = double(world.joint_state(spring).position) - 2.0;
      if (i > 0) through.add(double(i) * double(kStep), x);
      if (i > 20 && i < 45) peak = std::max(peak, x);
      world.step(kStep);
    }
    if (ratio < 0.3) {
      EXPECT_TRUE(relative_row("period by frequency (s)", through.mean_period(), 0.5 / damped, 1e-2, 1e-3));
    }
    const double expected = std::exp(-2.0 * kPiDouble * ratio / damped);
    EXPECT_TRUE(row("ratio of peaks by damping ratio", peak / 0.01, expected, 2e-2, 2e-3));
  }
}

// Only distance joints are given a frequency; motors have their own.
template <class Def>
concept HasFrequency = requires(Def def) { def.frequency; };
static_assert(HasFrequency<DistanceDef> && !HasFrequency<HingeDef> && !HasFrequency<SliderDef>);

TEST(Spring, RefusesAFrequencyBesideAStiffness) {
  World world = weightless();
  const BodyId body = world.add_body(point_body(1.0, {1, 1, 1}, {2, 0, 0}));
  EXPECT_FALSE(world.add_joint(DistanceDef{.b = body, .stiffness = 1.0f, .frequency = 2.0f}));
  EXPECT_FALSE(world.add_joint(DistanceDef{.b = body, .frequency = -1.0f}));
  EXPECT_FALSE(world.problems().empty());
}

TEST(Spring, StifferThanTheStepGainsNoEnergy) {
  Oscillator o = pulled(2400.0 * 2400.0, 0.0, 0.01f);
  const double start = o.world.energy().elastic;
  double most = 0.0;
  for (int i = 0; i < 600; ++i) {
    o.world.step(kStep);
    const Energy e = o.world.energy();
    most = std::max(most, e.kinetic + e.elastic);
  }
  EXPECT_TRUE(limit_row("A-53 energy over start", most / start, 1.01, 1.0001));
}

// A damped spring is a map with the exact decay and rate, which puts its rest off by the decay of one sub-step. Asleep it
// stays where it was let alone, below the speed that counts as rest.
TEST(Spring, SagsByTheWeightOverItsStiffness) {
  for (const bool sleeping : {false, true}) {
    World world = make_world({.sleeping = sleeping});
    const float moment = 0.4f * 0.1f * 0.1f;
    const BodyId mass = world.add_body(point_body(1.0, {moment, moment, moment}, {0, -1, 0}));
    world.add_joint(
        DistanceDef{.b = mass, .anchor = {0, 0, 0}, .length = 1.0f, .stiffness = 100.0f, .damping = 2.0f});
    run(world, 30.0);
    const double sag = -1.0 - world.pose(mass).position.y;
    if (sleeping) {
      EXPECT_TRUE(row("A-54 sag where it may sleep (m)", sag, 0.0981, 1e-3, 1e-6));
      EXPECT_FALSE(world.is_awake(mass)) << "it does fall asleep";
    } else {
      EXPECT_TRUE(row("A-54 sag (m)", sag, 0.0981, 1e-3, 1e-6));
    }
  }
}

TEST(Spring, ModesOfTwoMasses) {
  const double omegas[] = {6.1803, 16.1803};
  const double shapes[] = {1.6180, -0.6180};
  for (int k = 0; k < 2; ++k) {
    World world = make_world({.gravity = {0, 0, 0}, .sleeping = false});
    const BodyId first = world.add_body(point_body(1.0, {1, 1, 1}, {1.1, 0, 0}));
    const BodyId second = world.add_body(point_body(1.0, {1, 1, 1}, {2.0 + 0.1 * shapes[k], 0, 0}));
    world.add_joint(DistanceDef{.b = first, .anchor = {0, 0, 0}, .length = 1.0f, .stiffness = 100.0f});
    world.add_joint(DistanceDef{
        .a = first, .b = second, .anchor = world.pose(first).position, .length = 1.0f, .stiffness = 100.0f});
    ZeroCrossings through;
    for (int i = 0; i < 600; ++i) {
      through.add(double(i) * double(kStep), world.pose(first).position.x - 1.0);
      world.step(kStep);
    }
    EXPECT_TRUE(
        relative_row("A-47 rate of a mode", 2.0 * kPiDouble / through.mean_period(), omegas[k], 1e-2, 5e-4));
  }
}

TEST(Rope, ActsOnlyWhenTaut) {
  World world = make_world({.sleeping = false});
  const BodyId bob = world.add_body(point_body(1.0, {1e-3f, 1e-3f, 1e-3f}, {0, -0.1, 0}));
  world.add_joint(DistanceDef{.b = bob, .anchor = {0, 0, 0}, .max_length = 1.0f});
  run(world, 0.4);
  EXPECT_NEAR(double(world.linear_velocity(bob).y), -0.4 * kGravity, 1e-3) << "slack, it falls freely";
  double longest = 0.0;
  for (int i = 0; i < 600; ++i) {
    world.step(kStep);
    longest = std::max(longest, length(world.pose(bob).position));
  }
  EXPECT_LE(longest, 1.01);
  EXPECT_NEAR(world.pose(bob).position.y, -1.0, 1e-2);
}

}  // namespace
}  // namespace gyre::laws::spring_test
