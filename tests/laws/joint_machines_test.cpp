// Machines of several joints, and what has gone wrong with joints elsewhere: gimbals, universal shafts, springs of any stiffness,
// teleported bases, doubled joints, frames that are half a turn apart. Closed forms, and things that must not happen.
#include "laws/any_joint.h"
#include "laws/kit.h"

#include <random>

namespace gyre::laws::joint_machines_test {
namespace {

// a rotor in two gimbals. A torque about the outer axis turns the inner one at torque / (I3 w).
TEST(Gimbal, PrecessesAboutTheOtherAxis) {
  World world = weightless();
  const Vec3 has_extreme_mass_ratio{1e-5f, 1e-5f, 1e-5f};
  const BodyId outer = world.add_body(point_body(0.1, has_extreme_mass_ratio));
  const BodyId inner = world.add_body(point_body(0.1, has_extreme_mass_ratio));
  BodyDef def = point_body(1.0, {0.01f, 0.01f, 0.02f});
  def.angular_velocity = {0, 0, 100};
  const BodyId rotor = world.add_body(def);
  world.add_joint(HingeDef{.b = outer, .axis = {1, 0, 0}});
  const JointId second = world.add_joint(HingeDef{.a = outer, .b = inner, .axis = {0, 1, 0}});
  world.add_joint(HingeDef{.a = inner, .b = rotor, .axis = {0, 0, 1}});
  // The nutation is averaged out: it has hundreds of periods in a second.
  double last = 0.0;
  const int steps = 120;
  for (int i = 0; i < steps; ++i) {
    world.add_torque(outer, {0.5f, 0, 0});
    world.step(kStep);
    last = double(world.joint_state(second).position);
  }
  // The torque turns the spin with it: its part along the outer axis is torque times time.
  EXPECT_TRUE(
      relative_row("A-22 precession (rad/s)", std::sin(std::fabs(last)) / (steps / 60.0), 0.25, 2e-2, 1e-3));
  EXPECT_NEAR(double(length(world.angular_velocity(rotor))), 100.0, 0.1);
}

// A cylinder of two light bodies that drives a heavy bucket at 0.05 m/s, with more force than balance needs (82.8 kN).
TEST(Cylinder, OfLightPartsLiftsWhatItsForceCan) {
  std::mt19937 engine{3};
  const auto draw = [&](double low, double high) {
    return low + (high - low) * double(engine() >> 8) / 16777216.0;
  };
  for (int trial = 0; trial < 8; ++trial) {
    World world = make_world();
    const float light = float(0.5 * std::pow(10.0, draw(0.0, 2.0)));
    const ShapeDef part{.geometry = Box{{0.4f, 0.1f, 0.1f}}, .filter = {.collides_with = 0}};
    const auto body = [&](DVec3 place, float mass, float angle) {
      return world.add_body(
          {.pose = {.position = place, .orientation = from_axis_angle({0, 0, 1}, angle)}, .mass = mass},
          part);
    };
    const DVec3 foot{0.3, 0, 0}, head{1.5, 1, 0}, middle{0.9, 0.5, 0};
    const float angle = float(std::atan2(1.0, 1.2));
    const BodyId boom = body({2, 1, 0}, 50, 0), bucket = body({4, 1, 0}, 2000, 0);
    const BodyId barrel = body({0.66, 0.3, 0}, light, angle), rod = body({1.14, 0.7, 0}, light, angle);
    world.add_joint(HingeDef{.b = boom, .anchor = {0, 1, 0}, .axis = {0, 0, 1}});
    world.add_joint(FixedDef{.a = boom, .b = bucket, .anchor = {4, 1, 0}});
    world.add_joint(HingeDef{.b = barrel, .anchor = foot, .axis = {0, 0, 1}});
    world.add_joint(HingeDef{.a = boom, .b = rod, .anchor = head, .axis = {0, 0, 1}});
    const JointId cylinder = world.add_joint(
        SliderDef{.a = barrel,
                  .b = rod,
                  .anchor = middle,
                  .axis = to_float(head - foot),
                  .motor = {.target_velocity = 0.05f, .max_force = float(82800.0 * draw(1.3, 4.0))}});
    run(world, 3.0);
    EXPECT_NEAR(double(world.joint_state(cylinder).position), 0.15, 0.01) << "parts of " << light << " kg";
    EXPECT_GT(world.pose(bucket).position.y, 1.57) << "parts of " << light << " kg";
  }
}

// A universal joint between shafts at an angle b: the second turns cos b / (1 - sin^2 b cos^2 t) times as fast, and two of them
// in the right position turn evenly again.
TEST(Universal, TurnsUnevenlyAndTwoOfThemEvenly) {
  const double bend = 0.5;
  World world = weightless();
  const Vec3 moments{0.1f, 0.1f, 0.1f};
  const DVec3 way{std::cos(bend), std::sin(bend), 0}, across{-std::sin(bend), std::cos(bend), 0};
  const BodyId first = world.add_body(point_body(1.0, moments, {-1, 0, 0}));
  const BodyId middle = world.add_body(point_body(1.0, moments, way));
  const BodyId last = world.add_body(point_body(1.0, moments, 2.0 * way + DVec3{1, 0, 0}));
  const JointId drive = world.add_joint(HingeDef{.b = first, .anchor = {-1, 0, 0}, .axis = {1, 0, 0}});
  const JointId out =
      world.add_joint(HingeDef{.b = last, .anchor = 2.0 * way + DVec3{1, 0, 0}, .axis = {1, 0, 0}});
  world.add_joint(UniversalDef{.a = first, .b = middle, .axis = {0, 0, 1}, .axis_b = to_float(across)});
  world.add_joint(UniversalDef{
      .a = middle, .b = last, .anchor = 2.0 * way, .axis = to_float(across), .axis_b = Vec3{0, 0, 1}});
  world.set_motor(drive, {.target_velocity = 3.0f, .max_force = 1000.0f});
  run(world, 0.5);
  double worst_middle = 0.0, worst_last = 0.0;
  for (int i = 0; i < 300; ++i) {
    world.step(kStep);
    // t: how far the first's cross axis is from where it lies across the plane of the shafts.
    const double t = double(world.joint_state(drive).position);
    const double exact = 3.0 * std::cos(bend) / (1.0 - std::pow(std::sin(bend) * std::sin(t), 2.0));
    const double measured = dot(DVec3(world.angular_velocity(middle)), way);
    worst_middle = std::max(worst_middle, std::fabs(measured / exact - 1.0));
    worst_last = std::max(worst_last, std::fabs(double(world.joint_state(out).velocity) / 3.0 - 1.0));
  }
  EXPECT_TRUE(limit_row("middle shaft off Hooke's law", worst_middle, 1e-2, 1e-3));
  EXPECT_TRUE(limit_row("last shaft off the first", worst_last, 1e-2, 1e-3));
}

// limits beyond half a turn.
TEST(Hinge, StopsBeyondHalfATurn) {
  const Limits cases[] = {
      {-200 * kDegree, 200 * kDegree}, {0, 270 * kDegree}, {-720 * kDegree, -10 * kDegree}};
  for (const Limits limits : cases) {
    for (const float way : {-1.0f, 1.0f}) {
      World world = weightless();
      const BodyId body = world.add_body(point_body(1.0, {1, 1, 1}));
      const JointId hinge = world.add_joint(HingeDef{.b = body, .axis = {0, 0, 1}, .limits = limits});
      for (int i = 0; i < 600; ++i) {
        world.add_torque(body, {0, 0, way});
        world.step(kStep);
      }
      const double stop = double(way > 0.0f ? limits.high : limits.low);
      EXPECT_TRUE(row("A-45 stop (degrees)", double(world.joint_state(hinge).position) / double(kDegree),
                      stop / double(kDegree), 1.0, 0.1));
    }
  }
}

// 10^9 N/m on a gram: bounded, no energy from nowhere, and it hangs where it should.
TEST(Spring, OfAnyStiffnessIsStable) {
  for (const double stiffness : {1.0, 1e3, 1e6, 1e9, 1e12}) {
    for (const double damping : {0.0, 1.0, 1e6}) {
      for (const double mass : {1e-3, 1.0, 1e3}) {
        World world = make_world({.sleeping = false});
        const double rest = 1.0, extension = 0.01;
        const float moment = float(mass * 1e-2);
        const BodyId body =
            world.add_body(point_body(mass, {moment, moment, moment}, {0, -rest - extension, 0}));
        world.add_joint(DistanceDef{
            .b = body, .length = float(rest), .stiffness = float(stiffness), .damping = float(damping)});
        const auto energy = [&] {
          const Energy e = world.energy();
          return e.kinetic + e.elastic + e.potential;
        };
        const double start = energy();
        const double scale = 0.5 * stiffness * extension * extension + mass * kGravity * extension;
        double most = start;
        for (int i = 0; i < 600; ++i) {
          world.step(kStep);
          most = std::max(most, energy());
        }
        SCOPED_TRACE(testing::Message() << stiffness << " N/m, " << damping << " N s/m on " << mass << " kg");
        ASSERT_TRUE(is_finite(most));
        EXPECT_LE(most - start, 0.03 * scale + mass * kGravity * mass * kGravity / stiffness);
        if (stiffness >= 1e9) {
          EXPECT_NEAR(world.pose(body).position.y, -rest - mass * kGravity / stiffness, 1e-6 + 1e-7 * rest);
        }
      }
    }
  }
}

// A-54 for springs that carry through other things: a plate on four damped springs, with a box on it.
TEST(Spring, CarriesWhatLiesOnIt) {
  World world = make_world({.sleeping = false});
  const BodyId plate =
      world.add_body({.pose = {.position = {0, 1, 0}}, .mass = 10.0f}, {.geometry = Box{{1, 0.1f, 1}}});
  world.add_body({.pose = {.position = {0, 1.3, 0}}, .mass = 30.0f}, {.geometry = Box{{0.2f, 0.2f, 0.2f}}});
  std::vector<JointId> springs;
  for (const double x : {-0.9, 0.9}) {
    for (const double z : {-0.9, 0.9}) {
      springs.push_back(world.add_joint(SliderDef{
          .b = plate, .anchor = {x, 1, z}, .axis = {0, 1, 0}, .stiffness = 2500.0f, .damping = 100.0f}));
    }
  }
  run(world, 8.0);
  EXPECT_TRUE(
      row("sag under a load (m)", 1.0 - world.pose(plate).position.y, 40.0 * kGravity / 1e4, 2e-4, 1e-5));
}

// A car's corner: a wheel that stands on the ground carries its share through the suspension.
TEST(Wheel, CarriesItsLoadThroughTheSuspension) {
  World world = make_world({.sleeping = false});
  add_ground(world, surface(1.0f));
  BodyDef chassis = point_body(800.0, {100, 400, 400}, {0, 1, 0});
  const BodyId car = world.add_body(chassis);
  std::vector<JointId> wheels;
  for (const double x : {-1.2, 1.2}) {
    for (const double z : {-0.8, 0.8}) {
      const BodyId wheel =
          world.add_body({.pose = {{x, 0.35, z}, from_axis_angle({1, 0, 0}, 0.5f * kPi)}, .mass = 15.0f},
                         {.geometry = Cylinder{0.35f, 0.1f}, .material = surface(1.0f)});
      wheels.push_back(world.add_joint(WheelDef{.a = car,
                                                .b = wheel,
                                                .anchor = {x, 0.35, z},
                                                .axis = {0, 1, 0},
                                                .axis_b = Vec3{0, 0, 1},
                                                .limits = Limits{-0.3f, 0.3f},
                                                .stiffness = 30000.0f,
                                                .damping = 3000.0f}));
    }
  }
  run(world, 5.0);
  for (const JointId wheel : wheels) {
    const JointAxisState at = world.joint_axis_state(wheel, JointAxis::linear_x);
    EXPECT_NEAR(double(at.position), 200.0 * kGravity / 30000.0, 2e-3);
    EXPECT_NEAR(double(at.force), -200.0 * kGravity, 0.02 * 200.0 * kGravity);
  }
  // Driven, it rolls without slip: speed is spin times radius.
  for (const JointId wheel : wheels) world.set_motor(wheel, {.target_velocity = -10.0f, .max_force = 100.0f});
  run(world, 8.0);
  EXPECT_NEAR(double(world.linear_velocity(car).x), 3.5, 0.05);
  EXPECT_NEAR(double(world.linear_velocity(car).z), 0.0, 0.02);
}

// B-30: a driven arm whose base the user teleports and turns at every step.
TEST(JointTrouble, DrivenAgainstATeleportedBase) {
  World world = make_world({.sleeping = false});
  const BodyId base = world.add_body({.type = BodyType::kinematic});
  const BodyId arm = world.add_body(point_body(1.0, {0.1f, 0.1f, 0.1f}, {0.5, 0, 0}));
  world.add_joint(HingeDef{
      .a = base, .b = arm, .axis = {0, 0, 1}, .motor = {.target_position = 0.5f, .max_force = 100.0f}});
  for (int i = 0; i < 300; ++i) {
    world.set_pose(base, {{(i % 7) * 3.0, (i % 5) * 2.0, 0}, from_axis_angle({1, 1, 0}, float(i))});
    world.step(kStep);
    ASSERT_TRUE(is_finite(world.pose(arm)));
  }
  world.set_pose(base, {{1, 2, 3}, {}});
  run(world, 5.0);
  const DVec3 expected{1 + 0.5 * std::cos(0.5), 2 + 0.5 * std::sin(0.5), 3};
  EXPECT_TRUE(limit_row("B-30 a driven arm off its place (m)", length(world.pose(arm).position - expected),
                        1e-2, 1e-3));
}

// B-30: a spring to a kinematic body that moves.
TEST(JointTrouble, SpringOnAKinematicBody) {
  World world = weightless();
  const BodyId base = world.add_body({.type = BodyType::kinematic, .linear_velocity = {2, 0, 0}});
  const BodyId body = world.add_body(point_body(1.0, {0.1f, 0.1f, 0.1f}, {-1, 0, 0}));
  world.add_joint(DistanceDef{.a = base, .b = body, .length = 1.0f, .stiffness = 100.0f, .damping = 20.0f});
  run(world, 10.0);
  EXPECT_TRUE(relative_row("B-30 speed behind a kinematic body", double(world.linear_velocity(body).x), 2.0,
                           2.5e-2, 1e-3));
  EXPECT_TRUE(relative_row("B-30 length of its spring",
                           length(world.pose(body).position - world.pose(base).position), 1.0, 2e-2, 1e-3));
}

// B-30: several joints between one pair, and bodies that must not collide while any is left.
TEST(JointTrouble, ParallelJointsBetweenOnePair) {
  World world = weightless();
  const BodyId a = world.add_body({}, {.geometry = Box{{0.5f, 0.5f, 0.5f}}});
  const BodyId b = world.add_body({.pose = {.position = {0.5, 0, 0}}}, {.geometry = Box{{0.5f, 0.5f, 0.5f}}});
  std::vector<JointId> joints;
  for (const JointKind kind : {JointKind::hinge, JointKind::hinge, JointKind::fixed, JointKind::ball,
                               JointKind::universal, JointKind::six_dof})
    joints.push_back(world.add_joint(
        definition_of({.kind = kind, .a = a, .b = b, .anchor = {0.25, 0, 0}, .axis = {0, 0, 1}})));
  world.set_velocity(a, {}, {0, 0, 3});
  for (const JointId joint : joints) {
    run(world, 1.0);
    EXPECT_EQ(world.stats().touching, 0);
    EXPECT_TRUE(
        limit_row("B-30 speed on several joints (m/s)", double(length(world.linear_velocity(a))), 3.0, 1.0));
    EXPECT_TRUE(world.remove_joint(joint));
  }
  run(world, 0.5);
  EXPECT_GT(world.stats().touching + int(length(world.pose(a).position - world.pose(b).position) > 0.9), 0)
      << "now they collide";
}

// B-30: bodies that are half a turn apart when they are joined.
TEST(JointTrouble, FramesHalfATurnApart) {
  for (const JointKind kind : {JointKind::hinge, JointKind::slider, JointKind::fixed, JointKind::universal,
                               JointKind::cone, JointKind::six_dof, JointKind::wheel, JointKind::motor}) {
    for (const Vec3 axis : {Vec3{1, 0, 0}, Vec3{0, 1, 0}, Vec3{0, 0, 1}}) {
      World world = weightless();
      const BodyId a = world.add_body(point_body(1.0, {0.1f, 0.2f, 0.3f}));
      BodyDef def = point_body(1.0, {0.1f, 0.2f, 0.3f}, {1, 0, 0});
      def.pose.orientation = from_axis_angle(axis, kPi);
      const BodyId b = world.add_body(def);
      FlatJoint joint{.kind = kind, .a = a, .b = b, .anchor = {0.5, 0, 0}};
      joint.drive = {.max_force = 100.0f, .max_torque = 100.0f};
      ASSERT_TRUE(world.add_joint(definition_of(joint)));
      run(world, 1.0);
      SCOPED_TRACE(to_string(kind));
      const double speed = double(length(world.linear_velocity(a)) + length(world.angular_velocity(b)));
      EXPECT_TRUE(limit_row("B-30 speed, half a turn apart", speed, 1e-5, 1e-6));
      EXPECT_TRUE(limit_row("B-30 moved (m)", length(world.pose(b).position - DVec3{1, 0, 0}), 1e-5, 1e-6));
    }
  }
}

// A chain under a ball of its own weight, let go level: no joint ever opens by more than a millimetre.
TEST(SwingingChain, HoldsEachOfItsJoints) {
  for (const JointKind kind : {JointKind::ball, JointKind::cone, JointKind::universal}) {
    World world = make_world({.sleeping = false});
    std::vector<BodyId> links;
    const int count = 100;
    BodyId last{};
    for (int i = 0; i <= count; ++i) {
      const bool is_load = i == count;
      const Filter apart{.layer = 2, .collides_with = 1};
      const Quat turn = from_axis_angle({0, 0, 1}, -0.5f * kPi);
      const double x = is_load ? 0.5 * count + 0.8 : 0.5 * i + 0.25;
      const float mass = 13.6f;
      const BodyId link = world.add_body(
          {.pose = {{x, 0, 0}, turn}, .mass = is_load ? 100.0f * mass : mass},
          {.geometry = is_load ? AnyShape(Sphere{0.8f}) : AnyShape(Capsule{0.1f, 0.15f}), .filter = apart});
      world.add_joint(definition_of({.kind = kind,
                                     .a = last,
                                     .b = link,
                                     .anchor = {0.5 * i, 0, 0},
                                     .axis = {0, 0, 1},
                                     .axis_b = Vec3{0, 1, 0}}));
      links.push_back(link);
      last = link;
    }
    double worst = 0.0;
    for (int i = 0; i < 600; ++i) {
      world.step(kStep);
      DVec3 end{};
      for (const BodyId link : links) {
        const Pose pose = world.pose(link);
        const double half = link == links.back() ? 0.8 : 0.25;
        worst = std::max(worst, length(pose.position + turned(pose.orientation, {0, -half, 0}) - end));
        end = pose.position + turned(pose.orientation, {0, half, 0});
      }
    }
    EXPECT_TRUE(limit_row("gap in a swinging chain (m)", worst, 1e-3, 1e-4));
  }
}

// Rods on universal joints and six axes keep their energy like those on hinges, and momentum when nothing holds them.
TEST(Articulations, OfOtherKindsKeepEnergyAndMomentum) {
  for (const JointKind kind : {JointKind::universal, JointKind::cone, JointKind::six_dof}) {
    for (const bool hung : {true, false}) {
      World world = make_world(
          {.gravity = {0, hung ? -9.81f : 0.0f, 0}, .stepping = {.substeps = 16}, .sleeping = false});
      BodyId last{};
      DVec3 spin{};
      for (int i = 0; i < 3; ++i) {
        BodyDef def{.pose = {.position = {i + 0.5, 0, 0}}};
        if (!hung) def.angular_velocity = {0.5f, float(i), 1.0f};
        const BodyId body = world.add_body(
            def, {.geometry = Box{{0.5f, 0.05f, 0.05f}}, .filter = {.layer = 2, .collides_with = 1}});
        FlatJoint joint{.kind = kind,
                        .a = last,
                        .b = body,
                        .anchor = {double(i), 0, 0},
                        .axis = {0, 0, 1},
                        .axis_b = Vec3{0, 1, 0}};
        joint.angular_x.motion = joint.angular_z.motion = AxisMotion::free;
        if (hung || i > 0) world.add_joint(definition_of(joint));
        last = body;
      }
      world.step(kStep);
      const auto energy = [&] { return world.energy().kinetic + world.energy().potential; };
      const double start = energy(), range = hung ? 2.0 * 10.0 * kGravity * 4.5 : start;
      spin = world.momentum().angular;
      double worst = 0.0, lost = 0.0;
      for (int i = 0; i < 1200; ++i) {
        world.step(kStep);
        worst = std::max(worst, std::fabs(energy() - start) / range);
        if (!hung) lost = std::max(lost, length(world.momentum().angular - spin) / length(spin));
      }
      EXPECT_TRUE(limit_row("energy of three rods on other joints", worst, 1e-2, 1e-3));
      EXPECT_TRUE(limit_row("their angular momentum", lost, 1e-3, 1e-4));
    }
  }
}

}  // namespace
}  // namespace gyre::laws::joint_machines_test
