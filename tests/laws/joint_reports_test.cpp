// What users of other engines reported about joints (validation.md, B4, class J), as scenes: frames that are struck, welds that
// droop, ropes that give, motors that slam into limits, chains that go wild.
#include "laws/assembly.h"

namespace gyre::laws::joint_reports_test {
namespace {

// Row 38: a frame of sixty welded boxes is struck by a ball of 1 m at 100 m/s. Nothing explodes: no joint opens for good, and there is
// never more energy than the ball brought.
TEST(JointReports, AFrameThatIsStruckAt100MetresASecondHolds) {
  for (const JointKind kind : {JointKind::fixed, JointKind::ball}) {
    Assembly frame({.gravity = {0, 0, 0}, .sleeping = false});
    std::vector<BodyId> boxes;
    const auto at = [](int x, int y, int z) { return DVec3{double(x), double(y), double(z)}; };
    for (int k = 0; k < 60; ++k) {
      boxes.push_back(frame.world.add_body({.pose = {.position = at(k % 5, k / 5 % 4, k / 20)}},
                                           {.geometry = Box{{0.3f, 0.3f, 0.3f}}, .density = 1000.0f}));
    }
    const auto index = [](int x, int y, int z) { return std::size_t(x + 5 * y + 20 * z); };
    for (int k = 0; k < 60; ++k) {
      const int x = k % 5, y = k / 5 % 4, z = k / 20;
      const auto join = [&](int i, int j, int l) {
        frame.join(kind, boxes[index(x, y, z)], boxes[index(x + i, y + j, z + l)],
                   at(x, y, z) + DVec3{0.5 * i, 0.5 * j, 0.5 * l});
      };
      if (x < 4) join(1, 0, 0);
      if (y < 3) join(0, 1, 0);
      if (z < 2) join(0, 0, 1);
    }
    const BodyId ball =
        frame.world.add_body({.pose = {.position = {-5, 1.4, 0.9}}, .linear_velocity = {100, 0, 0}},
                             {.geometry = Sphere{1.0f}, .density = 1000.0f});
    const double start = frame.energy();
    const Momentum momentum = frame.world.momentum();
    double most = 0.0;
    for (int i = 0; i < 600; ++i) {
      frame.world.step(kStep);
      most = std::max(most, frame.energy() / start);
    }
    ASSERT_TRUE(is_finite(frame.world.pose(ball)));
    EXPECT_TRUE(limit_row("B4-38 energy over the ball's", most, 1.01, 1.0));
    EXPECT_TRUE(limit_row("B4-38 gap ten seconds later (m)", frame.largest_gap(), 1e-2, 1e-3));
    EXPECT_TRUE(
        relative_row("B4-38 momentum", frame.world.momentum().linear.x, momentum.linear.x, 1e-3, 1e-5));
  }
}

// A head on the wrong side of a slab, its neck too short for both to leave it: no force can mend that, and none may be saved up
// until it slips. (Contacts that keep all of their impulse wind it up to 80 kN and throw the two about with 40 to 260 J.)
TEST(JointReports, WhatIsLostInEachOtherLiesStill) {
  for (const double up : {0.0, 0.02, 0.05}) {
    World world = make_world({.sleeping = false});
    world.add_body({.type = BodyType::fixed}, {.geometry = Box{{1, 0.1f, 1}}});
    const BodyId chest =
        world.add_body({.pose = {.position = {0, -0.22, 0}}}, {.geometry = Box{{0.1f, 0.1f, 0.1f}}});
    const BodyId head = world.add_body({.pose = {.position = {0, 0.06 + up, 0}}}, {.geometry = Sphere{0.1f}});
    BallDef neck{.a = chest, .b = head};
    neck.anchor = {0, -0.05, 0};
    world.add_joint(neck);
    double most = 0.0;
    for (int i = 0; i < 1200; ++i) {
      world.step(kStep);
      if (i >= 60) most = std::max(most, world.energy().kinetic);
    }
    EXPECT_LT(most, 0.1) << up;
  }
}

// Row 39: a column of ten welded boxes under one that weighs up to a hundred times as much, beside its foot's middle.
TEST(JointReports, AWeldedColumnUnderAHeavyTopDoesNotDroop) {
  for (const float top : {1.0f, 10.0f, 100.0f}) {
    Assembly column({.sleeping = false});
    BodyId last{};
    for (int i = 0; i < 10; ++i) {
      BodyDef def{.pose = {.position = {0, i + 0.5, 0}}};
      def.mass = i == 9 ? top : 1.0f;
      if (i == 9) def.center_of_mass = Vec3{0.3f, 0, 0};
      const BodyId body = column.add(def, Box{{0.5f, 0.5f, 0.5f}});
      column.join(JointKind::fixed, last, body, {0, double(i), 0});
      last = body;
    }
    run(column.world, 10.0);
    EXPECT_TRUE(limit_row("B4-39 sag of the top (m)",
                          length(column.world.pose(last).position - DVec3{0, 9.5, 0}), 1e-2, 1e-3));
  }
}

// Row 40: a rope is never longer than it may be, whatever falls into it.
TEST(JointReports, ARopeNeverExceedsItsLength) {
  for (const float speed : {0.0f, 30.0f}) {
    World world = make_world({.sleeping = false});
    BodyDef def = point_body(80.0, {1, 1, 1}, {0.1, 1.9, 0});
    def.linear_velocity = {0, -speed, 0};
    const BodyId body = world.add_body(def);
    ASSERT_TRUE(world.add_joint(DistanceDef{.b = body, .max_length = 2.0f}));
    double most = 0.0;
    for (int i = 0; i < 600; ++i) {
      world.step(kStep);
      most = std::max(most, length(world.pose(body).position));
    }
    EXPECT_TRUE(limit_row("B4-40 longest (m)", most, 2.0 * 1.01, 2.0 * 1.001));
  }
}

// Row 41: ten welded boxes out of a wall stay level. Their end bears nothing, their root ten weights at five arms.
TEST(JointReports, ACantileverOfTenBoxesStaysLevel) {
  Assembly beam({.sleeping = false});
  BodyId last{};
  for (int i = 0; i < 10; ++i) {
    const BodyId body = beam.add({.pose = {.position = {i + 0.5, 0, 0}}}, Box{{0.5f, 0.25f, 0.25f}});
    beam.join(JointKind::fixed, last, body, {double(i), 0, 0});
    last = body;
  }
  run(beam.world, 10.0);
  const double weight = double(beam.world.mass_properties(last).mass) * kGravity;
  EXPECT_TRUE(limit_row("B4-41 sag of the end (m)", length(beam.world.pose(last).position - DVec3{9.5, 0, 0}),
                        1e-2, 1e-3));
  EXPECT_TRUE(relative_row("B4-41 moment at the wall (N m)",
                           double(length(beam.world.joint_state(beam.joints[0]).torque)), 50.0 * weight,
                           1e-2, 1e-3));
}

// Row 43: two bodies on a ball joint are struck beside the middle: the angular momentum of the blow stays.
TEST(JointReports, ABlowBesideTheMiddleKeepsItsAngularMomentum) {
  Assembly pair({.gravity = {0, 0, 0}, .sleeping = false});
  const BodyId a = pair.add({.pose = {.position = {-0.5, 0, 0}}}, Box{{0.5f, 0.1f, 0.2f}});
  const BodyId b = pair.add({.pose = {.position = {0.5, 0, 0}}}, Box{{0.5f, 0.1f, 0.2f}});
  pair.join(JointKind::ball, a, b, {});
  ASSERT_TRUE(pair.world.add_impulse_at(b, {0, 40, 10}, DVec3{0.9, 0.05, 0.1}));
  const DVec3 spin = cross(DVec3{0.9, 0.05, 0.1}, DVec3{0, 40, 10});
  run(pair.world, 10.0);
  EXPECT_TRUE(limit_row("B4-43 angular momentum, share lost",
                        length(pair.world.momentum().angular - spin) / length(spin), 1e-3, 1e-4));
}

// Row 46: a hundred pendulums whose bodies' origins are not their centres of mass swing with the period of each of them alone.
TEST(JointReports, ManyPendulumsHangAtTheirAnchors) {
  World world = make_world({.sleeping = false});
  std::vector<BodyId> bobs;
  for (int i = 0; i < 100; ++i) {
    BodyDef def = point_body(1.0, {0.01f, 0.01f, 0.01f}, {3.0 * i, 0, 0});
    def.center_of_mass = Vec3{0.1f, -1, 0};
    bobs.push_back(world.add_body(def));
    ASSERT_TRUE(world.add_joint(BallDef{.b = bobs.back(), .anchor = {3.0 * i, 0, 0}}));
  }
  const double arm = std::sqrt(1.01), moment = 1.01 + 0.01, swing = std::atan(0.1);
  const double period = 2.0 * kPiDouble * std::sqrt(moment / (arm * kGravity)) * (1.0 + swing * swing / 16.0);
  std::vector<ZeroCrossings> through(bobs.size());
  double off = 0.0;
  for (int i = 0; i < 600; ++i) {
    for (std::size_t k = 0; k < bobs.size(); ++k) {
      through[k].add(double(i) * double(kStep), world.center_of_mass(bobs[k]).x - 3.0 * double(k));
      off = std::max(off, length(world.pose(bobs[k]).position - DVec3{3.0 * double(k), 0, 0}));
    }
    world.step(kStep);
  }
  double worst = 0.0;
  for (const ZeroCrossings& one : through)
    worst = std::max(worst, std::fabs(one.mean_period() / period - 1.0));
  EXPECT_TRUE(limit_row("B4-46 period, worst of a hundred", worst, 2e-3, 2e-4));
  EXPECT_TRUE(limit_row("B4-46 off its anchor (m)", off, 1e-3, 1e-4));
}

// Row 49: a motor drives a flywheel into a limit for a minute, there and back.
TEST(JointReports, AMotorAgainstItsLimitStaysThere) {
  World world = weightless();
  const BodyId body = world.add_body(point_body(5.0, {2, 2, 2}));
  const JointId hinge =
      world.add_joint(HingeDef{.b = body, .axis = {0, 0, 1}, .limits = Limits{-1.0f, 1.0f}});
  double beyond = 0.0, shakes = 0.0;
  for (int i = 0; i < 3600; ++i) {
    if (i % 600 == 0)
      world.set_motor(hinge, {.target_velocity = i / 600 % 2 == 0 ? 30.0f : -30.0f, .max_force = 1000.0f});
    world.step(kStep);
    const JointState reading = world.joint_state(hinge);
    beyond = std::max(beyond, std::fabs(double(reading.position)) - 1.0);
    if (i % 600 > 300) shakes = std::max(shakes, std::fabs(double(reading.velocity)));
  }
  EXPECT_TRUE(limit_row("B4-49 beyond the limit (rad)", beyond, 2e-2, 2e-3));
  EXPECT_TRUE(limit_row("B4-49 speed at the limit (rad/s)", shakes, 1e-3, 1e-5));
}

// Row 50: a chain with a cube a hundred times as heavy as a link, dragged by its upper end, is calm five seconds after that stops.
TEST(JointReports, AChainWithACubeCalmsDown) {
  Assembly chain({.sleeping = false});
  add_ground(chain.world);
  const BodyId hand = chain.world.add_body({.type = BodyType::kinematic, .pose = {.position = {0, 8, 0}}});
  BodyId last = hand;
  for (int i = 0; i < 20; ++i) {
    BodyDef def{
        .pose = {.position = {0, 7.85 - 0.3 * i, 0}}, .linear_damping = 0.3f, .angular_damping = 0.3f};
    def.mass = 0.5f;
    const BodyId body = chain.add(def, Capsule{0.05f, 0.1f});
    chain.join(JointKind::ball, last, body, {0, 8.0 - 0.3 * i, 0});
    last = body;
  }
  BodyDef def{.pose = {.position = {0, 1.5, 0}}, .linear_damping = 0.3f, .angular_damping = 0.3f};
  def.mass = 50.0f;
  const BodyId cube = chain.add(def, Box{{0.5f, 0.5f, 0.5f}});
  chain.join(JointKind::ball, last, cube, {0, 2, 0});
  double fastest = 0.0;
  for (int i = 0; i < 180; ++i) {
    chain.world.move_kinematic(hand, {{i < 60 ? 0.05 * (i + 1) : 3.0, 8, 0}, {}}, kStep);
    chain.world.step(kStep);
    for (const BodyId body : chain.bodies)
      fastest = std::max(fastest, double(length(chain.world.linear_velocity(body))));
  }
  EXPECT_TRUE(limit_row("B4-50 fastest while it is dragged (m/s)", fastest, 20.0, 12.0));
  run(chain.world, 60.0);
  double left = 0.0;
  for (const BodyId body : chain.bodies)
    left = std::max(left, double(length(chain.world.linear_velocity(body))));
  EXPECT_TRUE(limit_row("B4-50 speed at the end (m/s)", left, 0.05, 1e-3));
  EXPECT_TRUE(limit_row("B4-50 gap (m)", chain.largest_gap(), 1e-3, 1e-5));
}

// Row 52: an arm of six axes that its motors press against all its limits for a minute.
TEST(JointReports, ARobotAtItsLimitsStandsStill) {
  Assembly robot({.sleeping = false});
  BodyId last{};
  for (int i = 0; i < 6; ++i) {
    const BodyId body = robot.add({.pose = {.position = {0, 0.5 * i + 0.25, 0}}}, Box{{0.1f, 0.25f, 0.1f}});
    robot.joints.push_back(
        robot.world.add_joint(HingeDef{.a = last,
                                       .b = body,
                                       .anchor = {0, 0.5 * i, 0},
                                       .axis = i % 2 == 0 ? Vec3{0, 0, 1} : Vec3{0, 1, 0},
                                       .limits = Limits{-0.5f, 0.5f},
                                       .motor = {.target_velocity = 2.0f, .max_force = 500.0f}}));
    last = body;
  }
  run(robot.world, 5.0);
  double shakes = 0.0, beyond = 0.0;
  for (int i = 0; i < 3600; ++i) {
    robot.world.step(kStep);
    for (const BodyId body : robot.bodies)
      shakes = std::max(shakes, double(length(robot.world.linear_velocity(body))));
    for (const JointId joint : robot.joints)
      beyond = std::max(beyond, std::fabs(double(robot.world.joint_state(joint).position) - 0.5));
  }
  EXPECT_TRUE(limit_row("B4-52 speed of a part (m/s)", shakes, 1e-3, 1e-5));
  // Limits are rows that give way by 9.5e-6 s^2 of the acceleration that they stop (docs/joints.md): here of up to 2,000 rad/s^2.
  EXPECT_TRUE(limit_row("B4-52 off a limit (rad)", beyond, 2.5e-2, 1e-3));
}

// a rope of sixty links lies over half a fixed drum and is pulled at either end. It slips where one pull is e^(mu pi) of the other.
TEST(Rope, SlipsOverADrumAsEulerAndEytelweinSay) {
  const double mu = 0.3, radius = 1.0, thick = 0.02, link = 0.09, exact = std::exp(mu * kPiDouble);
  const auto slips_at = [&](double ratio) {
    World world = make_world({.gravity = {0, 0, 0}, .sleeping = false});
    world.add_body(
        {.type = BodyType::fixed, .pose = {{0, 0, 0}, from_axis_angle({1, 0, 0}, 0.5f * kPi)}},
        {.geometry = Cylinder{float(radius), 0.5f}, .material = surface(float(mu)), .filter = {.layer = 1}});
    // Along a line up one side, over the drum and down the other, each link's ends on it.
    const double r = radius + thick, half = 0.5 * kPiDouble * r, whole = 60 * link;
    const auto on_rope = [&](double s) {  // s from the top
      if (std::fabs(s) <= half) return DVec3{r * std::sin(s / r), r * std::cos(s / r), 0};
      return DVec3{s < 0 ? -r : r, half - std::fabs(s), 0};
    };
    std::vector<BodyId> links;
    for (int i = 0; i < 60; ++i) {
      const DVec3 from = on_rope(-0.5 * whole + i * link), to = on_rope(-0.5 * whole + (i + 1) * link);
      const double way = std::atan2(to.y - from.y, to.x - from.x);
      BodyDef def{.pose = {0.5 * (from + to), from_axis_angle({0, 0, 1}, float(way - 0.5 * kPiDouble))}};
      def.mass = 0.02f;
      def.angular_damping = def.linear_damping = 2.0f;
      links.push_back(world.add_body(def, {.geometry = Capsule{float(thick), float(0.5 * link - thick)},
                                           .material = surface(float(mu)),
                                           .filter = {.layer = 2, .collides_with = 1}}));
      if (i > 0)
        world.add_joint(
            HingeDef{.a = links[std::size_t(i - 1)], .b = links.back(), .anchor = from, .axis = {0, 0, 1}});
    }
    const auto pull = [&](double by) {
      world.add_force(links.front(), {0, -10, 0});
      world.add_force(links.back(), {0, float(-10.0 * by), 0});
      world.step(kStep);
    };
    for (int i = 0; i < 60; ++i) pull(1.0);
    for (int i = 0; i < 60; ++i) pull(1.0 + (ratio - 1.0) * (i + 1) / 60.0);
    const double before = world.pose(links.back()).position.y;
    for (int i = 0; i < 60; ++i) pull(ratio);
    return before - world.pose(links.back()).position.y > 0.02;
  };
  double holds = 1.0, slips = 6.0;
  for (int i = 0; i < 8; ++i) {
    const double middle = 0.5 * (holds + slips);
    (slips_at(middle) ? slips : holds) = middle;
  }
  EXPECT_TRUE(
      relative_row("A-74 ratio of the pulls at which it slips", 0.5 * (holds + slips), exact, 0.15, 0.05));
}

}  // namespace
}  // namespace gyre::laws::joint_reports_test
