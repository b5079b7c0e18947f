// Couplings of joint axes, articulations in generalised coordinates, loads of motors, and fields of named laws: each against a closed form or
// against the engine's own steps; in snapshots and recordings; wrong ones are refused.
#include "laws/kit.h"

#include <gyre/articulation.h>
#include <gyre/debug.h>
#include <gyre/replay.h>

#include <gtest/gtest.h>

#include <cmath>
#include <string>
#include <vector>

namespace gyre::mechanisms_test {
namespace {

constexpr float kStep = 1.0f / 240.0f;

struct Memory : ByteSink {
  std::vector<std::byte> bytes;
  bool write(std::span<const std::byte> more) override {
    bytes.insert(bytes.end(), more.begin(), more.end());
    return true;
  }
};

void run(World& world, int steps) {
  for (int i = 0; i < steps; ++i) ASSERT_TRUE(world.step(kStep));
  ASSERT_TRUE(validate(world).ok()) << validate(world).message;
}

BodyId rod(World& world, DVec3 place, float mass, Vec3 half = {0.5f, 0.05f, 0.05f}) {
  return world.add_body({.pose = {.position = place}, .can_sleep = false, .mass = mass},
                        ShapeDef{.geometry = Box{half}});
}

double angle(const World& world, JointId joint) {
  return double(world.joint_axis_state(joint, JointAxis::angular_x).position);
}

// ------------------------------------------------------------------------------------------------------------ couplings

// Two fingers on a hand that a motor closes: both move alike, and the coupling carries half the force.
TEST(Couplings, FingersCloseTogether) {
  World w = *World::create({.gravity = {}});
  const BodyId hand = w.add_body({.type = BodyType::fixed});
  const BodyId left = rod(w, {-1, 0, 0}, 1, {0.1f, 0.3f, 0.1f}),
               right = rod(w, {1, 0, 0}, 1, {0.1f, 0.3f, 0.1f});
  const JointId a = w.add_joint(SliderDef{.a = hand, .b = left, .anchor = {-1, 0, 0}, .axis = {1, 0, 0}});
  const JointId b = w.add_joint(SliderDef{.a = hand, .b = right, .anchor = {1, 0, 0}, .axis = {-1, 0, 0}});
  const CouplingId coupling = w.add_coupling(
      {.terms = {{a, JointAxis::linear_x, 1.0f}, {b, JointAxis::linear_x, -1.0f}}, .offset = 0.0f});
  ASSERT_TRUE(coupling);
  for (int i = 0; i < 120; ++i) {
    ASSERT_TRUE(w.add_joint_load(a, JointAxis::linear_x, 4.0f));
    w.step(kStep);
  }
  const double time = 120 * double(kStep);
  EXPECT_NEAR(w.linear_velocity(left).x, 4.0 / 2.0 * time, 1e-3) << "one force moves both masses";
  EXPECT_NEAR(w.linear_velocity(right).x, -4.0 / 2.0 * time, 1e-3);
  EXPECT_NEAR(double(w.coupling_state(coupling).error), 0, 1e-5);
  EXPECT_NEAR(double(w.coupling_state(coupling).force), -2.0, 0.01) << "it holds the left one back with 2 N";
  // A box between the fingers, which only one of them drives, is pressed from both sides.
  ASSERT_TRUE(w.set_motor(a, {.target_velocity = 1, .max_force = 30}));
  const BodyId box = rod(w, {0, 0, 0}, 1, {0.2f, 0.1f, 0.1f});
  run(w, 480);
  double force = 0;
  std::vector<ContactPoint> points(w.body_contacts(left, {}));
  w.body_contacts(left, points);
  for (const ContactPoint& point : points) force += double(point.normal_impulse / kStep);
  EXPECT_NEAR(force, 15, 0.5) << "half of the motor's force";
  EXPECT_NEAR(double(w.coupling_state(coupling).error), 0, 1e-3);
  EXPECT_NEAR(w.pose(box).position.x, 0, 1e-3);
  EXPECT_NEAR(double(w.joint_axis_state(a, JointAxis::linear_x).motor), 30, 0.01);
}

// A mimic joint within a chain: a folding arm on a free base, with the momentum of the whole unchanged.
TEST(Couplings, AMimicJointFollowsWithinAChain) {
  World w = *World::create({.gravity = {}});
  const BodyId base = rod(w, {0, 0, 0}, 5);
  const BodyId upper = rod(w, {1, 0, 0}, 1), lower = rod(w, {2, 0, 0}, 1);
  const JointId shoulder =
      w.add_joint(HingeDef{.a = base, .b = upper, .anchor = {0.5, 0, 0}, .axis = {0, 0, 1}});
  const JointId elbow =
      w.add_joint(HingeDef{.a = upper, .b = lower, .anchor = {1.5, 0, 0}, .axis = {0, 0, 1}});
  const CouplingId coupling = w.add_coupling(
      {.terms = {{elbow, JointAxis::angular_x, 1.0f}, {shoulder, JointAxis::angular_x, 2.0f}}});
  ASSERT_TRUE(coupling);
  ASSERT_TRUE(w.set_motor(shoulder, {.target_velocity = 1.5f, .max_force = 20}));
  for (int i = 0; i < 240; ++i) {
    w.step(kStep);
    ASSERT_NEAR(angle(w, elbow), -2 * angle(w, shoulder), 2e-3) << "step " << i;
  }
  EXPECT_NEAR(angle(w, shoulder), 1.5, 0.05);
  EXPECT_LT(length(w.momentum().linear), 1e-3);
  EXPECT_LT(length(w.momentum().angular), 5e-3);
}

// A differential of three shafts: the carrier turns with the mean of both wheels, whichever is held.
TEST(Couplings, ADifferentialSharesItsTurning) {
  World w = *World::create({.gravity = {}});
  const BodyId shafts[3] = {rod(w, {0, 0, 0}, 1), rod(w, {0, 0, 3}, 1), rod(w, {0, 0, 6}, 1)};
  JointId hinges[3];
  for (int i = 0; i < 3; ++i)
    hinges[i] = w.add_joint(HingeDef{.b = shafts[i], .anchor = {0, 0, 3.0 * i}, .axis = {1, 0, 0}});
  const auto axis = JointAxis::angular_x;
  ASSERT_TRUE(w.add_coupling({.terms = {{hinges[0], axis, 1}, {hinges[1], axis, 1}, {hinges[2], axis, -2}}}));
  ASSERT_TRUE(w.set_motor(hinges[2], {.target_velocity = 2, .max_force = 1}));
  run(w, 120);
  EXPECT_NEAR(w.angular_velocity(shafts[0]).x, 2, 1e-3) << "alike wheels turn alike";
  EXPECT_NEAR(w.angular_velocity(shafts[1]).x, 2, 1e-3);
  ASSERT_TRUE(w.set_motor(hinges[0], {.target_velocity = 0, .max_force = 10}));
  run(w, 120);
  EXPECT_NEAR(w.angular_velocity(shafts[0]).x, 0, 1e-3);
  EXPECT_NEAR(w.angular_velocity(shafts[1]).x, 4, 5e-3) << "the free wheel turns twice as fast";
}

// Without friction a coupling keeps energy, and sleeping mechanisms keep still and wake together.
TEST(Couplings, KeepEnergyAndSleepTogether) {
  World w = *World::create();
  const BodyId a = rod(w, {0.5, 0, 0}, 1), b = rod(w, {0.5, 0, 4}, 2);
  const JointId one = w.add_joint(HingeDef{.b = a, .anchor = {0, 0, 0}, .axis = {0, 0, 1}});
  const JointId two = w.add_joint(HingeDef{.b = b, .anchor = {0, 0, 4}, .axis = {0, 0, 1}});
  const CouplingId coupling =
      w.add_coupling({.terms = {{one, JointAxis::angular_x, 1}, {two, JointAxis::angular_x, 1}}});
  const auto total = [&] { return w.energy().kinetic + w.energy().potential; };
  const double before = total();
  run(w, 960);
  EXPECT_NEAR(angle(w, one), -angle(w, two), 1e-3);
  EXPECT_NEAR(total(), before, 0.25) << "of 14.7 J between the highest and the lowest place";
  // Snapshots and clones have it.
  World loaded = *load_snapshot(save_snapshot(w));
  World cloned = *clone(w);
  EXPECT_EQ(cloned.coupling(coupling).terms.size(), 2u);
  run(w, 60), run(loaded, 60), run(cloned, 60);
  EXPECT_EQ(loaded.hash(), w.hash());
  EXPECT_EQ(cloned.hash(), w.hash());
  // At rest both sleep, and both wake.
  for (const BodyId body : {a, b}) {
    ASSERT_TRUE(w.set_damping(body, 5, 5));
    ASSERT_TRUE(w.set_can_sleep(body, true));
  }
  run(w, 2400);
  EXPECT_FALSE(w.is_awake(a));
  EXPECT_FALSE(w.is_awake(b));
  w.add_angular_impulse(a, {0, 0, 1});
  run(w, 2);
  EXPECT_TRUE(w.is_awake(b));
  ASSERT_TRUE(w.remove_joint(one));
  EXPECT_FALSE(w.exists(coupling)) << "it goes with its joint";
  EXPECT_FALSE(w.remove_coupling(coupling));
  run(w, 2);
}

TEST(Couplings, WrongOnesAreRefused) {
  World w = *World::create();
  const BodyId a = rod(w, {0, 0, 0}, 1), b = rod(w, {1, 0, 0}, 1);
  const JointId hinge = w.add_joint(HingeDef{.b = a}),
                ball = w.add_joint(BallDef{.a = a, .b = b, .anchor = {0.5, 0, 0}});
  const auto refused = [&](const CouplingDef& def, const char* words) {
    EXPECT_FALSE(w.add_coupling(def));
    ASSERT_FALSE(w.problems().empty());
    EXPECT_NE(std::string(w.problems().back().message).find(words), std::string::npos)
        << w.problems().back().message;
  };
  refused({.terms = {{hinge}}}, "2 to 8");
  refused({.terms = {{hinge}, {hinge}}}, "has the axis of");
  refused({.terms = {{hinge}, {ball}}}, "a ball joint has no angular_x to couple");
  refused({.terms = {{hinge}, {hinge, JointAxis::linear_x}}}, "no linear_x");
  refused({.terms = {{hinge}, {JointId{7, 1, 1}}}}, "does not exist");
  refused({.terms = {{hinge, JointAxis::angular_x, 0.0f}, {ball}}}, "must not be 0");
}

TEST(Couplings, AreRecordedAndReplayedToTheBit) {
  World w = *World::create();
  const BodyId a = rod(w, {0.5, 0, 0}, 1), b = rod(w, {0.5, 0, 4}, 2);
  const JointId one = w.add_joint(HingeDef{.b = a, .axis = {0, 0, 1}});
  const JointId two = w.add_joint(HingeDef{.b = b, .anchor = {0, 0, 4}, .axis = {0, 0, 1}});
  Memory file;
  Recorder recorder(w, file, {.hash_interval = 1});
  const CouplingId coupling = w.add_coupling(
      {.terms = {{one, JointAxis::angular_x, 1}, {two, JointAxis::angular_x, 0.5f}}, .offset = 0.1f});
  run(w, 30);
  FieldDef grid{.kind = FieldKind::grid, .bounds = FieldBounds{{-9, -9, -9}, {9, 9, 9}}, .points = {2, 2, 2}};
  grid.vectors.assign(8, Vec3{0, 0, 1});
  const FieldId field = w.add_field(grid);
  ASSERT_TRUE(field);
  run(w, 30);
  ASSERT_TRUE(w.remove_coupling(coupling));
  ASSERT_TRUE(w.set_field(field, {.kind = FieldKind::stokes, .strength = 3}));
  run(w, 30);
  ASSERT_TRUE(recorder.finish());
  Result<Replay> replay = Replay::open(file.bytes, {.threads = 2, .simd_width = 1});
  ASSERT_TRUE(replay) << replay.error().message;
  bool matches = true;
  int steps = 0;
  for (; replay->step(&matches); ++steps) ASSERT_TRUE(matches) << "step " << steps;
  EXPECT_EQ(steps, 90);
}

// --------------------------------------------------------------------------------------------------------- articulations

// Three links in space with a hinge, a slider and a ball; and a universal joint, a wheel and a fixed joint from the other side.
struct Arm {
  World world = *World::create({.stepping = {.substeps = 8}});
  BodyId first, last;
  std::vector<JointId> joints;

  explicit Arm(bool is_free) {
    const auto link = [&](double x) {
      return world.add_body({.pose = {.position = {x, 0, 0}},
                             .linear_velocity = {},
                             .can_sleep = false,
                             .mass = 1.0f + float(x),
                             .center_of_mass = Vec3{0.1f, 0.05f, -0.1f},
                             .inertia = Sym3{0.3f, 0.5f, 0.4f, 0.02f, 0.01f, -0.03f}});
    };
    first = link(0);
    const BodyId second = link(1), third = link(2), fourth = link(3);
    last = fourth;
    if (!is_free)
      joints.push_back(
          world.add_joint(HingeDef{.b = first, .anchor = {-0.5, 0, 0}, .axis = {0.6f, 0, 0.8f}}));
    // The slider has the link that is nearer to the base as b.
    joints.push_back(
        world.add_joint(SliderDef{.a = second, .b = first, .anchor = {0.5, 0, 0}, .axis = {0, 1, 1}}));
    joints.push_back(world.add_joint(UniversalDef{
        .a = second, .b = third, .anchor = {1.5, 0, 0}, .axis = {0, 0, 1}, .axis_b = Vec3{0, 1, 0.3f}}));
    joints.push_back(world.add_joint(BallDef{.a = third, .b = fourth, .anchor = {2.5, 0.2, 0}}));
    const BodyId bodies[] = {first, second, third, fourth};
    for (int i = 0; i < 4; ++i)
      world.add_angular_impulse(bodies[i], {0.3f - 0.2f * float(i), 0.5f, -0.4f + 0.1f * float(i)});
    // The joints make the velocities consistent.
    for (int i = 0; i < 100; ++i) world.step(1.0e-3f);
  }
};

double kinetic_energy(const ArticulationTable& table) {
  const std::size_t n = table.velocities.size();
  double energy = 0;
  for (std::size_t i = 0; i < n; ++i)
    for (std::size_t j = 0; j < n; ++j)
      energy += 0.5 * table.mass_matrix[i * n + j] * table.velocities[i] * table.velocities[j];
  return energy;
}

TEST(Articulations, TheMassMatrixGivesTheEnergyAndJacobiansTheVelocities) {
  for (const bool is_free : {false, true}) {
    const Arm arm(is_free);
    ArticulationTable table;
    read_articulation(arm.world, arm.last, table);
    const std::size_t n = table.velocities.size();
    ASSERT_EQ(n, is_free ? 12u : 7u);
    ASSERT_EQ(table.bodies.size(), 4u);
    EXPECT_EQ(table.loops, 0);
    EXPECT_NEAR(kinetic_energy(table), arm.world.energy().kinetic, 1e-3 * arm.world.energy().kinetic);
    for (std::size_t i = 0; i < 4; ++i) {
      const Vec3 v = arm.world.linear_velocity(table.bodies[i]),
                 s = arm.world.angular_velocity(table.bodies[i]);
      const float own[6] = {v.x, v.y, v.z, s.x, s.y, s.z};
      for (std::size_t row = 0; row < 6; ++row) {
        double sum = 0;
        for (std::size_t k = 0; k < n; ++k)
          sum += table.jacobians[(i * 6 + row) * n + k] * table.velocities[k];
        EXPECT_NEAR(sum, double(own[row]), 2e-3) << "body " << i << ", row " << row;
      }
    }
    std::vector<double> poses;
    forward_kinematics(arm.world, arm.first, table.positions, poses);
    ASSERT_EQ(poses.size(), 28u);
    for (std::size_t i = 0; i < 4; ++i) {
      const Pose pose = arm.world.pose(table.bodies[i]);
      EXPECT_LT(length(pose.position - DVec3{poses[i * 7], poses[i * 7 + 1], poses[i * 7 + 2]}), 2e-4) << i;
      const Quat q = pose.orientation;
      const double same = double(q.x) * poses[i * 7 + 3] + double(q.y) * poses[i * 7 + 4] +
                          double(q.z) * poses[i * 7 + 5] + double(q.w) * poses[i * 7 + 6];
      EXPECT_NEAR(std::abs(same), 1, 1e-6) << i;
    }
    std::vector<double> point;
    const Vec3 arm_of_point{0.3f, -0.2f, 0.5f};
    point_jacobian(arm.world, arm.last, arm.world.center_of_mass(arm.last) + arm_of_point, point);
    const Vec3 expected =
        arm.world.linear_velocity(arm.last) + cross(arm.world.angular_velocity(arm.last), arm_of_point);
    double speed = 0;
    for (std::size_t k = 0; k < n; ++k) speed += point[n + k] * table.velocities[k];
    EXPECT_NEAR(speed, double(expected.y), 2e-3);
  }
}

// The forces that belong to the accelerations of a short step are those that acted: none but one torque.
TEST(Articulations, InverseDynamicsAgreesWithAStep) {
  for (const bool is_free : {false, true}) {
    Arm arm(is_free);
    ArticulationTable before, after;
    constexpr float kTorque = 0.7f;
    constexpr double kShort = 1.0e-3;
    const JointId universal = arm.joints[arm.joints.size() - 2];
    const auto step = [&] {
      ASSERT_TRUE(arm.world.add_joint_load(universal, JointAxis::angular_x, kTorque));
      ASSERT_TRUE(arm.world.step(float(kShort)));
    };
    step();
    read_articulation(arm.world, arm.first, before);
    std::vector<double> expected, forces(before.velocities.size(), 0.0);
    for (std::size_t i = 0; i < forces.size(); ++i)
      if (before.coordinate_joints[i] == universal && before.coordinate_axes[i] == JointAxis::angular_x)
        forces[i] = double(kTorque);
    forward_dynamics(arm.world, arm.first, forces, expected);
    std::vector<double> back;
    inverse_dynamics(arm.world, arm.first, expected, back);
    for (std::size_t i = 0; i < forces.size(); ++i) EXPECT_NEAR(back[i], forces[i], 1e-9);
    for (int i = 0; i < 10; ++i) step();
    read_articulation(arm.world, arm.first, after);
    double largest = 0;
    for (const double acceleration : expected) largest = std::max(largest, std::abs(acceleration));
    for (std::size_t i = 0; i < forces.size(); ++i) {
      const double measured = (after.velocities[i] - before.velocities[i]) / (10 * kShort);
      EXPECT_NEAR(measured, expected[i], 0.03 * largest + 0.05) << "coordinate " << i;
    }
  }
}

// A double pendulum of point masses: M and the bias forces of the textbook (L. Meirovitch; absolute angles turned into relative ones).
TEST(Articulations, ADoublePendulumHasTheTextbooksEquations) {
  World w = *World::create();
  const double m1 = 2, m2 = 3, l1 = 1, l2 = 0.5, q1 = 0.4, q2 = 0.9, v1 = 1.5, v2 = -2, g = 9.81;
  const auto mass = [&](DVec3 at, double kg) {
    return w.add_body(
        {.pose = {.position = at}, .mass = float(kg), .inertia = Sym3{1e-6f, 1e-6f, 1e-6f, 0, 0, 0}});
  };
  const DVec3 first{l1 * std::sin(q1), -l1 * std::cos(q1), 0};
  const DVec3 arm{l2 * std::sin(q1 + q2), -l2 * std::cos(q1 + q2), 0};
  const BodyId a = mass(first, m1), b = mass(first + arm, m2);
  w.add_joint(HingeDef{.b = a, .axis = {0, 0, 1}});
  w.add_joint(HingeDef{.a = a, .b = b, .anchor = first, .axis = {0, 0, 1}});
  w.set_velocity(a, Vec3{float(-first.y * v1), float(first.x * v1), 0}, {0, 0, float(v1)});
  w.set_velocity(b,
                 Vec3{float(-first.y * v1 - arm.y * (v1 + v2)), float(first.x * v1 + arm.x * (v1 + v2)), 0},
                 {0, 0, float(v1 + v2)});
  ArticulationTable table;
  read_articulation(w, b, table);
  ASSERT_EQ(table.velocities.size(), 2u);
  EXPECT_NEAR(table.velocities[0], v1, 1e-5);
  EXPECT_NEAR(table.velocities[1], v2, 1e-5);
  const double c = std::cos(q2), s = std::sin(q2);
  const double m22 = m2 * l2 * l2, m12 = m22 + m2 * l1 * l2 * c,
               m11 = (m1 + m2) * l1 * l1 + m22 + 2 * m2 * l1 * l2 * c;
  EXPECT_NEAR(table.mass_matrix[0], m11, 1e-4);
  EXPECT_NEAR(table.mass_matrix[1], m12, 1e-4);
  EXPECT_NEAR(table.mass_matrix[2], m12, 1e-4);
  EXPECT_NEAR(table.mass_matrix[3], m22, 1e-4);
  const double h = m2 * l1 * l2 * s;
  const double gravity_2 = m2 * g * l2 * std::sin(q1 + q2),
               gravity_1 = (m1 + m2) * g * l1 * std::sin(q1) + gravity_2;
  EXPECT_NEAR(table.bias_forces[0], -h * (2 * v1 * v2 + v2 * v2) + gravity_1, 1e-3);
  EXPECT_NEAR(table.bias_forces[1], h * v1 * v1 + gravity_2, 1e-3);
}

TEST(Articulations, WithoutOneAllIsEmpty) {
  World w = *World::create();
  const BodyId fixed = w.add_body({.type = BodyType::fixed});
  ArticulationTable table;
  table.velocities.push_back(1);
  read_articulation(w, fixed, table);
  EXPECT_TRUE(table.velocities.empty());
  const BodyId free = rod(w, {}, 2);
  read_articulation(w, free, table);
  ASSERT_EQ(table.velocities.size(), 6u);
  EXPECT_NEAR(table.mass_matrix[0], 2, 1e-6);
  std::vector<double> out{1, 2};
  inverse_dynamics(w, free, std::vector<double>{1, 2}, out);
  EXPECT_TRUE(out.empty()) << "a wrong number of accelerations";
  // A loop of four bars.
  const BodyId a = rod(w, {0.5, 5, 0}, 1), b = rod(w, {1.5, 5, 0}, 1), c = rod(w, {2.5, 5, 0}, 1);
  for (const auto& [one, two, x] :
       {std::tuple{BodyId{}, a, 0.0}, {a, b, 1.0}, {b, c, 2.0}, {c, BodyId{}, 3.0}})
    w.add_joint(HingeDef{.a = one, .b = two, .anchor = {x, 5, 0}, .axis = {0, 0, 1}});
  read_articulation(w, c, table);
  EXPECT_EQ(table.velocities.size(), 3u);
  EXPECT_EQ(table.loops, 1);
}

// ---------------------------------------------------------------------------------------------------------------- fields

// A charge in a magnetic field keeps its speed and goes in a circle, with every integrator.
TEST(NamedFields, AChargeCirclesInAMagneticField) {
  for (const IntegratorKind integrator : {IntegratorKind::semi_implicit_euler, IntegratorKind::rk4}) {
    World w = *World::create({.gravity = {}, .stepping = {.integrator = integrator}});
    w.add_field({.kind = FieldKind::magnetic, .strength = 2, .axis = {0, 0, 1}});
    const BodyId charge = w.add_body({.linear_velocity = {1, 0, 0}, .mass = 3.0f});
    for (int i = 0; i < 600; ++i) w.step(1.0f / 60.0f);
    EXPECT_NEAR(length(w.linear_velocity(charge)), 1, 1e-4) << to_string(integrator);
    // v x B turns against the axis: after t seconds the velocity has turned by -2 t.
    EXPECT_NEAR(w.linear_velocity(charge).x, std::cos(20.0), 2e-3) << to_string(integrator);
    EXPECT_NEAR(w.linear_velocity(charge).y, -std::sin(20.0), 2e-3) << to_string(integrator);
    EXPECT_NEAR(w.pose(charge).position.y, (std::cos(20.0) - 1) / 2, 0.01) << "the circle has radius v / B";
  }
}

TEST(NamedFields, ADipoleFallsWithTheCube) {
  // At right angles to the moment, B points against it; along it, twice as strongly with it.
  const auto turned = [](DVec3 place) {
    World w = *World::create({.gravity = {}});
    w.add_field({.kind = FieldKind::magnetic_dipole, .strength = 0.8f, .radius = 2, .axis = {0, 0, 1}});
    const BodyId charge = w.add_body({.pose = {.position = place}, .linear_velocity = {1.0e-4f, 0, 0}});
    for (int i = 0; i < 60; ++i) w.step(1.0f / 60.0f);
    return std::atan2(double(w.linear_velocity(charge).y), double(w.linear_velocity(charge).x));
  };
  EXPECT_NEAR(turned({2, 0, 0}), 0.8, 2e-3);
  EXPECT_NEAR(turned({0, 4, 0}), 0.1, 2e-3);
  EXPECT_NEAR(turned({0, 0, 4}), -0.2, 2e-3);
}

TEST(NamedFields, ABallSinksInSyrupAsStokesSays) {
  World w = *World::create();
  w.add_field({.kind = FieldKind::stokes, .strength = 50});
  const float radius = 0.1f;
  const BodyId ball =
      w.add_body({.angular_velocity = {0, 3, 0}}, ShapeDef{.geometry = Sphere{radius}, .density = 500});
  const double mass = double(w.mass_properties(ball).mass);
  const double spin_rate = 8 * 3.14159265 * 50 * 1e-3 / (0.4 * mass * 0.01);
  w.step(1.0e-3f);
  EXPECT_NEAR(double(w.angular_velocity(ball).y), 3 / (1 + 1e-3 * spin_rate), 0.3);
  for (int i = 0; i < 120; ++i) w.step(1.0f / 60.0f);
  EXPECT_NEAR(double(w.linear_velocity(ball).y), -mass * 9.81 / (6 * 3.14159265 * 50 * double(radius)), 2e-3);
}

TEST(NamedFields, AGridIsInterpolated) {
  World w = *World::create({.gravity = {}});
  FieldDef grid{.kind = FieldKind::grid, .bounds = FieldBounds{{0, 0, 0}, {4, 2, 2}}, .points = {3, 2, 2}};
  for (int z = 0; z < 2; ++z)
    for (int y = 0; y < 2; ++y)
      for (int x = 0; x < 3; ++x) grid.vectors.push_back({float(x), float(10 * y), float(100 * z)});
  const FieldId field = w.add_field(grid);
  ASSERT_TRUE(field);
  const BodyId inside = w.add_body({.pose = {.position = {1, 0.5, 1.5}}, .mass = 7.0f});
  const BodyId outside = w.add_body({.pose = {.position = {5, 1, 1}}});
  w.step(1.0e-3f);
  EXPECT_NEAR(w.linear_velocity(inside).x, 0.5e-3, 1e-6);
  EXPECT_NEAR(w.linear_velocity(inside).y, 2.5e-3, 1e-6);
  EXPECT_NEAR(w.linear_velocity(inside).z, 75e-3, 1e-5);
  EXPECT_EQ(w.linear_velocity(outside), Vec3{});
  EXPECT_EQ(w.field(field).vectors.size(), 12u);
  World loaded = *load_snapshot(save_snapshot(w));
  for (int i = 0; i < 10; ++i) w.step(kStep), loaded.step(kStep);
  EXPECT_EQ(loaded.hash(), w.hash());
  grid.vectors.pop_back();
  EXPECT_FALSE(w.set_field(field, grid)) << "a vector too few";
  grid.bounds = {};
  EXPECT_FALSE(w.add_field(grid));
  EXPECT_FALSE(w.add_field({.kind = FieldKind::wind, .vectors = {Vec3{}}}));
  EXPECT_FALSE(w.add_field({.kind = FieldKind::stokes, .strength = -1}));
  ASSERT_TRUE(w.remove_field(field));
  w.step(kStep);
  EXPECT_TRUE(validate(w).ok());
}

}  // namespace
}  // namespace gyre::mechanisms_test
