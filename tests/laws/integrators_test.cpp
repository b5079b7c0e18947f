// The four integrators: observed orders in free flight, springs and rotation; energy; rest; springs that a scheme cannot follow.
// Exact ends and cuts: apps/gyre/integrator_trials.h. Rows.
#include "laws/kit.h"

#include "../../apps/gyre/integrator_trials.h"

namespace gyre::laws::integrators_test {
namespace {

World trial_world(IntegratorKind kind, Vec3 gravity, int substeps) {
  in_use().integrator = kind;
  return trials::make_world(kind, gravity, substeps);
}

constexpr IntegratorKind kKinds[] = {IntegratorKind::semi_implicit_euler, IntegratorKind::explicit_euler,
                                     IntegratorKind::rk4, IntegratorKind::verlet};

TEST(Integrators, HaveTheirOrders) {
  for (const trials::Trial& trial : trials::kTrials) {
    for (const IntegratorKind kind : kKinds) {
      in_use().integrator = kind;
      const std::vector<double> errors = trials::errors_of(trial, kind);
      const std::string name = std::string("A-03 ") + trial.name + " " + to_string(kind);
      if (trials::is_exact(kind, trial)) {
        EXPECT_TRUE(limit_row(name.c_str(), errors.back(), trials::kExact, trials::kExact));
        continue;
      }
      EXPECT_TRUE(row(name.c_str(), trials::order(errors[errors.size() - 2], errors.back()),
                      trials::expected_order(kind), 0.1, 0.05));
    }
  }
}

TEST(Integrators, VerletKeepsItsOrderWhereTheStepChanges) {
  in_use().integrator = IntegratorKind::verlet;
  const double coarse = trials::uneven_spring_error(IntegratorKind::verlet, 160);
  const double fine = trials::uneven_spring_error(IntegratorKind::verlet, 320);
  EXPECT_TRUE(
      row("A-05 order with steps of 4/5 and 6/5 in turn", trials::order(coarse, fine), 2.0, 0.2, 0.05));
}

TEST(Integrators, EnergyOfALongOscillation) {
  // 10 s at 240 parts a second, w = 2 pi. Explicit Euler: (1 + w^2 h^2)^n; semi-implicit Euler's is measured between its kicks: w h / 2
  // of it swings.
  const double h = 1.0 / 240.0, n = 2400.0, k = square(trials::kTurn * h);
  const double expected[] = {1.0, std::pow(1.0 + k, n), 1.0, 1.0}, good[] = {0.03, 0.01, 1e-4, 1e-3};
  for (const IntegratorKind kind : kKinds) {
    World world = trial_world(kind, {}, 1);
    BodyDef def = trials::point();
    def.pose.position = {2.1, 0, 0};
    const BodyId body = world.add_body(def);
    world.add_joint(DistanceDef{.b = body, .length = 2.0f, .stiffness = float(square(trials::kTurn))});
    const Energy before = world.energy();
    for (int i = 0; i < 1200; ++i) world.step(1.0f / 120.0f);
    const Energy after = world.energy();
    EXPECT_TRUE(row((std::string("A-04 energy ") + to_string(kind)).c_str(),
                    (after.kinetic + after.elastic) / (before.kinetic + before.elastic), expected[int(kind)],
                    good[int(kind)], 1e-4));
  }
}

TEST(Integrators, AllComeToRestOnAFloorWithoutFalseSpeed) {
  for (const IntegratorKind kind : kKinds) {
    for (const SpringKind springs : {SpringKind::implicit, SpringKind::explicit_force}) {
      WorldDef def;
      def.sleeping = false;
      def.stepping.integrator = kind;
      def.stepping.springs = springs;
      World world = make_world(def);
      add_ground(world);
      const BodyId box =
          world.add_body({.pose = {.position = {0, 0.7, 0}}}, {.geometry = Box{{0.5f, 0.5f, 0.5f}}});
      run(world, 4.0);
      const Pose before = world.pose(box);
      run(world, 1.0);
      EXPECT_LE(length(world.linear_velocity(box)), 1e-6f) << to_string(kind);
      EXPECT_LE(length(world.angular_velocity(box)), 1e-6f) << to_string(kind);
      EXPECT_LE(length(world.pose(box).position - before.position), 1e-6) << to_string(kind);
      EXPECT_NEAR(world.pose(box).position.y, 0.5, 1e-3) << to_string(kind);
    }
  }
}

TEST(Integrators, MomentumOfSpringsBetweenBodiesIsKept) {
  for (const IntegratorKind kind : kKinds) {
    World world = trial_world(kind, {}, 4);
    BodyId bodies[3];
    for (int i = 0; i < 3; ++i) {
      BodyDef def = trials::point();
      def.pose.position = {double(i), 0.1 * i * i, 0.0};
      def.linear_velocity = {0, float(i) - 1.0f, 0.5f};
      def.mass = 1.0f + float(i);
      bodies[i] = world.add_body(def);
    }
    for (int i = 0; i < 2; ++i) {
      world.add_joint(DistanceDef{.a = bodies[i],
                                  .b = bodies[i + 1],
                                  .anchor = {double(i), 0.1 * i * i, 0.2},
                                  .length = 0.8f,
                                  .stiffness = 300.0f,
                                  .damping = 1.0f});
    }
    const Momentum before = world.momentum();
    run(world, 2.0);
    const Momentum after = world.momentum();
    EXPECT_LE(length(after.linear - before.linear), 3e-6) << to_string(kind);
    // Explicit Euler's angular momentum x x v h is not kept: a term of the scheme, h times forces across.
    const double good = kind == IntegratorKind::explicit_euler ? 0.1 : 3e-4;
    EXPECT_LE(length(after.angular - before.angular), good) << to_string(kind);
  }
}

TEST(Integrators, ASpringToWhatStandsOnTheFloorPullsAtBoth) {
  for (const IntegratorKind kind : kKinds) {
    WorldDef def;
    def.sleeping = false;
    def.stepping = {.integrator = kind, .springs = SpringKind::explicit_force};
    World world = make_world(def);
    add_ground(world, surface(0.0f));
    // A sled of 8 kg on ice and a weight of 2 kg above it, weightless itself: they swing about their middle of mass.
    const BodyId sled =
        world.add_body({.pose = {.position = {0, 0.5, 0}}},
                       {.geometry = Box{{1, 0.5f, 0.5f}}, .density = 4.0f, .material = surface(0.0f)});
    BodyDef has_extreme_mass_ratio = point_body(2.0, {1, 1, 1}, {2.2, 0.5, 0.0});
    has_extreme_mass_ratio.gravity_scale = 0.0f;
    const BodyId weight = world.add_body(has_extreme_mass_ratio);
    world.add_joint(
        DistanceDef{.a = sled, .b = weight, .anchor = {0, 0.5, 0}, .length = 2.0f, .stiffness = 160.0f});
    ZeroCrossings through;
    for (int i = 0; i < 150; ++i) {
      world.step(kStep);
      const double middle = world.pose(weight).position.x - world.pose(sled).position.x - 2.0;
      through.add(double(i) * double(kStep), middle);
      // Verlet's velocity of the free end is shown at the time of its pose; the other has had the kick of the part before: F h / 2.
      EXPECT_NEAR(world.momentum().linear.x, 0.0, kind == IntegratorKind::verlet ? 0.5 * 32.0 / 240.0 : 1e-4)
          << to_string(kind);
    }
    // 1 / (1/8 + 1/2) = 1.6 kg on 160 N/m.
    EXPECT_TRUE(relative_row("spring between free and resting: period", through.mean_period(),
                             trials::kTurn / 10.0, 5e-3, 1e-3));
  }
}

// The critical step that is told, against the step at which the motion really grows: masses and springs over six orders.
TEST(Stiffness, IsToldAtTheStepFromWhichASchemeExplodes) {
  for (const IntegratorKind kind :
       {IntegratorKind::semi_implicit_euler, IntegratorKind::rk4, IntegratorKind::verlet}) {
    for (const float stiffness : {1.0f, 1.0e3f, 1.0e6f}) {
      for (const float mass : {0.01f, 1.0f, 100.0f}) {
        const auto grows = [&](double part, double* told, bool* warned) {
          World world = trial_world(kind, {}, 1);
          BodyDef def = trials::point();
          def.mass = mass;
          def.pose.position = {2.001, 0, 0};
          const BodyId body = world.add_body(def);
          world.add_joint(DistanceDef{.b = body, .length = 2.0f, .stiffness = stiffness});
          *told = world.spring_stability().critical_step;
          *warned = false;
          double most = 0.0;
          for (int i = 0; i < 60; ++i) {
            world.step(float(2.0 * part));
            for (const Problem& problem : world.problems())
              *warned = *warned || problem.code == ErrorCode::unstable;
            most = std::max(most, std::fabs(world.pose(body).position.x - 2.0));
          }
          return most > 0.1;
        };
        double told = 0.0;
        bool warned = false;
        const double rate = std::sqrt(double(stiffness) / double(mass));
        grows(0.01 / rate, &told, &warned);
        EXPECT_FALSE(warned);
        EXPECT_NEAR(told * rate, kind == IntegratorKind::rk4 ? 2.8284 : 2.0, 2e-3) << to_string(kind);
        if (2.2 * told > 1.0) continue;
        EXPECT_FALSE(grows(0.97 * told, &told, &warned))
            << to_string(kind) << " " << stiffness << " " << mass;
        EXPECT_FALSE(warned);
        EXPECT_TRUE(grows(1.1 * told, &told, &warned)) << to_string(kind) << " " << stiffness << " " << mass;
        EXPECT_TRUE(warned);
      }
    }
  }
}

TEST(Stiffness, OfManySpringsTogether) {
  // A chain of equal masses and springs between two walls: w = 2 sqrt(k/m) sin(n pi / (2 (n + 1))).
  World world = trial_world(IntegratorKind::verlet, {}, 4);
  constexpr int kCount = 10;
  BodyId last{};
  for (int i = 0; i <= kCount; ++i) {
    BodyId next{};
    BodyDef def = trials::point();
    def.pose.position = {double(i) + 1.0, 0, 0};
    if (i < kCount) next = world.add_body(def);
    world.add_joint(DistanceDef{.a = last,
                                .b = next,
                                .anchor = {double(i), 0, 0},
                                .anchor_b = DVec3{double(i) + 1.0, 0, 0},
                                .length = 1.0f,
                                .stiffness = 400.0f});
    last = next;
  }
  const double exact = 2.0 * 20.0 * std::sin(0.5 * kPiDouble * kCount / (kCount + 1.0));
  EXPECT_TRUE(relative_row("fastest mode of a chain", world.spring_stability().frequency * trials::kTurn,
                           exact, 0.02, 1e-3));
  EXPECT_EQ(world.spring_stability().springs, kCount + 1);
}

TEST(Stiffness, ExplicitEulerIsToldToGrowAndDampersHelp) {
  World world = trial_world(IntegratorKind::explicit_euler, {}, 4);
  BodyDef def = trials::point();
  def.pose.position = {2.5, 0, 0};
  const BodyId body = world.add_body(def);
  const JointId spring = world.add_joint(DistanceDef{.b = body, .length = 2.0f, .stiffness = 100.0f});
  world.step(kStep);
  EXPECT_EQ(world.spring_stability().critical_step, 0.0);
  ASSERT_EQ(world.problems().size(), 1u);
  EXPECT_EQ(world.problems()[0].code, ErrorCode::unstable);
  world.remove_joint(spring);
  world.add_joint(DistanceDef{.b = body, .length = 2.0f, .stiffness = 100.0f, .damping = 2.0f});
  // w = 10, d = 1: 2 d / w^2.
  EXPECT_TRUE(relative_row("critical step of explicit Euler", world.spring_stability().critical_step, 0.02,
                           1e-6, 1e-6));
}

TEST(ErrorControl, KeepsItsToleranceWhateverTheIntegrator) {
  for (const IntegratorKind kind : kKinds) {
    WorldDef def;
    def.gravity = {};
    def.sleeping = false;
    def.stepping = {.substeps = 1,
                    .integrator = kind,
                    .springs = SpringKind::explicit_force,
                    .time = TimeStepping::error_controlled,
                    .tolerance = 1e-5f};
    World world = make_world(def);
    BodyDef mass = trials::point();
    mass.pose.position = {3, 0, 0};
    const BodyId body = world.add_body(mass);
    world.add_joint(DistanceDef{.b = body, .length = 2.0f, .stiffness = float(square(trials::kTurn))});
    int parts = 0;
    for (int i = 0; i < 30; ++i) {
      world.step(1.0f / 30.0f);
      parts = std::max(parts, world.step_stats().parts);
      EXPECT_LE(world.step_stats().error, 1e-5f);
    }
    // Each step leaves at most the tolerance in the place, and the tolerance over the step's length in the velocity, of which
    // the oscillator makes 1 / w of way.
    EXPECT_NEAR(world.pose(body).position.x, 3.0, 30.0 * (1e-5 + 30.0 * 1e-5 / trials::kTurn))
        << to_string(kind);
    std::printf("[row] error control %-20s at most %4d parts a step, %9.2e m off after 1 s\n",
                to_string(kind), parts, std::fabs(world.pose(body).position.x - 3.0));
    EXPECT_GE(parts, 4);
  }
}

}  // namespace
}  // namespace gyre::laws::integrators_test
