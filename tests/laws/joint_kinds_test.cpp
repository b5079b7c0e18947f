// Kinds of joints that are more than axes: cones, gears, racks, pulleys, curves, drags, drives to a pose. Closed forms.
#include "laws/any_joint.h"
#include "laws/kit.h"

namespace gyre::laws::joint_kinds_test {
namespace {

// --------------------------------------------------------------------------------------------------------------- cones

// How far b's axis, along x, is from where it was, about y and about z.
struct SwingOf {
  double y, z, angle;
};
SwingOf swing_of(const World& world, BodyId body) {
  const Vec3 x = rotate(world.pose(body).orientation, {1, 0, 0});
  const double angle = std::atan2(std::hypot(double(x.y), double(x.z)), double(x.x));
  const double sine = std::hypot(double(x.y), double(x.z));
  if (sine < 1e-9) return {0, 0, 0};
  return {-angle * double(x.z) / sine, angle * double(x.y) / sine, angle};
}

// A body is turned from many sides against the ellipse of its swing, and stops where it is.
TEST(Cone, HoldsItsSwingWithinAnEllipse) {
  for (const bool round : {true, false}) {
    for (int k = 0; k < 24; ++k) {
      const double a = 2.0 * kPiDouble * k / 24.0;
      World world = make_world({.gravity = {0, 0, 0}, .sleeping = false});
      const BodyId body = world.add_body(point_body(1.0, {0.1f, 0.1f, 0.1f}));
      const float ly = 0.8f, lz = round ? 0.8f : 0.4f;
      const JointId joint =
          world.add_joint(ConeDef{.b = body, .axis_b = Vec3{0, 0, 1}, .swing_y = ly, .swing_z = lz});
      ASSERT_TRUE(joint);
      double most = 0.0;
      for (int i = 0; i < 240; ++i) {
        // A weight that pulls the axis to one side: it comes to rest where the ellipse is farthest that way.
        const Vec3 x = rotate(world.pose(body).orientation, {1, 0, 0});
        const Vec3 down{0, float(std::sin(a)), float(-std::cos(a))};
        world.add_torque(body, 1.0f * cross(x, down) - 0.3f * world.angular_velocity(body));
        world.step(kStep);
        const SwingOf s = swing_of(world, body);
        most = std::max(most, std::hypot(s.y / double(ly), s.z / double(lz)));
      }
      const SwingOf s = swing_of(world, body);
      const double share = std::hypot(s.y / double(ly), s.z / double(lz));
      SCOPED_TRACE(testing::Message() << "direction " << k << (round ? ", round" : ", ellipse"));
      EXPECT_NEAR(share, 1.0, 5e-3);
      EXPECT_LE(most, 1.02);
      EXPECT_LE(length(world.pose(body).position), 1e-4);
      if (round) {
        EXPECT_NEAR(s.y, 0.8 * std::cos(a), 0.01);
        EXPECT_NEAR(s.z, 0.8 * std::sin(a), 0.01);
      }
    }
  }
}

TEST(Cone, LetsItsTwistAloneWithinTheSwing) {
  World world = weightless();
  BodyDef def = point_body(1.0, {0.1f, 0.1f, 0.1f});
  def.angular_velocity = {2, 0, 0};
  const BodyId body = world.add_body(def);
  const JointId joint = world.add_joint(ConeDef{.b = body, .swing_y = 0.5f, .swing_z = 0.3f});
  run(world, 10.0);
  EXPECT_NEAR(double(world.angular_velocity(body).x), 2.0, 1e-5);
  EXPECT_NEAR(double(world.joint_axis_state(joint, JointAxis::angular_x).position), 20.0, 1e-3);
}

// Ends of swing and twist that give way do so like springs: load / (2 pi f)^2 of the inertia.
TEST(Cone, GivesWayAtSoftLimits) {
  for (const bool swings : {true, false}) {
    World world = make_world({.gravity = {0, 0, 0}, .sleeping = false});
    const BodyId body = world.add_body(point_body(1.0, {1, 1, 1}));
    ASSERT_TRUE(world.add_joint(ConeDef{.b = body,
                                        .swing_y = 0.3f,
                                        .swing_z = 0.3f,
                                        .limits = Limits{-0.2f, 0.2f},
                                        .limit_frequency = 2.0f}));
    for (int i = 0; i < 600; ++i) {
      world.add_torque(body, swings ? Vec3{0, 5, 0} : Vec3{5, 0, 0});
      world.step(kStep);
    }
    const double omega = 2.0 * kPiDouble * 2.0;
    const Vec3 turn = to_rotation_vector(world.pose(body).orientation);
    EXPECT_NEAR(double(swings ? turn.y : turn.x), (swings ? 0.3 : 0.2) + 5.0 / (omega * omega), 1e-3);
  }
}

// Its drive turns a shoulder to an orientation: as a spring of its frequency, and with no more than its torque.
TEST(Cone, IsDrivenToAnOrientation) {
  const Quat turn = from_rotation_vector({0.3f, -0.4f, 0.5f});
  World world = weightless();
  const BodyId body = world.add_body(point_body(1.0, {1, 1, 1}));
  const JointId cone =
      world.add_joint(ConeDef{.b = body,
                              .axis_b = Vec3{0, 0, 1},
                              .drive = {.orientation = turn, .frequency = 2.0f, .max_torque = 1000.0f}});
  ASSERT_TRUE(cone);
  run(world, 3.0);
  EXPECT_LE(double(length(to_rotation_vector(world.pose(body).orientation * conjugate(turn)))), 1e-3);
  ASSERT_TRUE(world.set_drive(cone, {.max_torque = 0.5f}));
  world.step(kStep);
  EXPECT_NEAR(double(length(world.angular_velocity(body))), 0.5 / 60.0, 1e-4) << "half a newton metre on 1 kg m^2";
}

// Friction against all turning stops it at torque over inertia, whatever its axis.
TEST(Cone, AndBallAreBrakedByFriction) {
  for (const JointKind kind : {JointKind::ball, JointKind::cone}) {
    World world = weightless();
    BodyDef def = point_body(1.0, {0.5f, 0.5f, 0.5f});
    def.angular_velocity = {0.6f, 0.0f, 0.8f};
    const BodyId body = world.add_body(def);
    ASSERT_TRUE(world.add_joint(definition_of({.kind = kind, .b = body, .friction = 0.25f})));
    run(world, 1.0);
    EXPECT_NEAR(double(length(world.angular_velocity(body))), 0.5, 1e-3);
    EXPECT_NEAR(double(world.angular_velocity(body).x), 0.3, 1e-3) << "the axis stays";
    run(world, 1.5);
    EXPECT_NEAR(double(length(world.angular_velocity(body))), 0.0, 1e-6);
  }
}

// --------------------------------------------------------------------------------------------------------------- gears

struct GearRig {
  World world = weightless();
  BodyId first, second;
  JointId gear;
  GearRig() {
    first = world.add_body(point_body(1.0, {1, 1, 1}));
    second = world.add_body(point_body(1.0, {9, 9, 9}, {2, 0, 0}));
    world.add_joint(HingeDef{.b = first, .axis = {0, 0, 1}});
    world.add_joint(HingeDef{.b = second, .anchor = {2, 0, 0}, .axis = {0, 0, 1}});
    gear = world.add_joint(GearDef{.a = first, .b = second, .axis = {0, 0, 1}, .ratio = 3.0f});
  }
};

// 3:1, inertias 1 and 9, a torque of 1 on the first: 1 / (1 + 9 / 9) rad/s^2.
TEST(Gear, TurnsShaftsInItsRatio) {
  GearRig rig;
  for (int i = 0; i < 120; ++i) {
    rig.world.add_torque(rig.first, {0, 0, 1});
    rig.world.step(kStep);
  }
  EXPECT_TRUE(relative_row("A-42 acceleration", double(rig.world.angular_velocity(rig.first).z) / 2.0, 0.5,
                           1e-2, 1e-4));
  EXPECT_TRUE(relative_row(
      "A-42 ratio of speeds",
      double(rig.world.angular_velocity(rig.first).z) / double(rig.world.angular_velocity(rig.second).z),
      -3.0, 1e-4, 1e-6));
  rig.world.set_velocity(rig.first, {}, {0, 0, 30});
  rig.world.set_velocity(rig.second, {}, {0, 0, -10});
  run(rig.world, 22.0);  // more than a hundred turns
  const double a = double(rig.world.joint_axis_state(rig.gear, JointAxis::angular_x).position);
  const double b = double(rig.world.joint_axis_state(rig.gear, JointAxis::angular_y).position);
  EXPECT_GT(a, 2.0 * kPiDouble * 100.0);
  EXPECT_TRUE(limit_row("A-42 drift in 100 turns (rad)", std::fabs(a + 3.0 * b), 1e-3, 1e-4));
}

TEST(Gear, OfNegativeRatioTurnsTheSameWay) {
  World world = weightless();
  const BodyId a = world.add_body(point_body(1.0, {1, 1, 1}));
  const BodyId b = world.add_body(point_body(1.0, {1, 1, 1}, {1, 0, 0}));
  world.add_joint(HingeDef{.b = a, .axis = {0, 0, 1}});
  world.add_joint(HingeDef{.b = b, .anchor = {1, 0, 0}, .axis = {0, 1, 0}});  // bevel gears
  world.add_joint(GearDef{.a = a, .b = b, .axis = {0, 0, 1}, .axis_b = Vec3{0, 1, 0}, .ratio = -2.0f});
  for (int i = 0; i < 60; ++i) {
    world.add_torque(a, {0, 0, 1});
    world.step(kStep);
  }
  EXPECT_NEAR(double(world.angular_velocity(a).z), 1.0 / 1.25, 1e-4);
  EXPECT_NEAR(double(world.angular_velocity(b).y), 0.5 / 1.25, 1e-4);
}

// A planetary gear whose ring is held, of gears between pairs of shafts by Willis's formula: with sun, planets and ring of 24, 24 and
// 72 teeth the carrier turns at 1 / (1 + 72 / 24) of the sun, a planet at 1 - 72 / 24 of the carrier, both against the world.
TEST(Gear, PlanetsFollowWillis) {
  World world = weightless();
  const auto turning = [](double mass, float about, DVec3 place) {
    return point_body(mass, {about, about, about}, place);
  };
  const BodyId sun = world.add_body(turning(1.0, 0.5f, {}));
  const BodyId carrier = world.add_body(turning(2.0, 0.8f, {}));
  world.add_joint(HingeDef{.b = sun, .axis = {0, 0, 1}});
  world.add_joint(HingeDef{.b = carrier, .axis = {0, 0, 1}});
  ASSERT_TRUE(
      world.add_joint(GearDef{.a = sun, .b = carrier, .axis = {0, 0, 1}, .ratio = -(1.0f + 72.0f / 24.0f)}));
  std::vector<BodyId> planets;
  for (int i = 0; i < 3; ++i) {
    const double a = 2.0 * kPiDouble * i / 3.0;
    const DVec3 at{2.0 * std::cos(a), 2.0 * std::sin(a), 0};  // pitch radii of 1 m
    planets.push_back(world.add_body(turning(0.3, 0.2f, at)));
    world.add_joint(HingeDef{.a = carrier, .b = planets.back(), .anchor = at, .axis = {0, 0, 1}});
    ASSERT_TRUE(world.add_joint(
        GearDef{.a = planets.back(), .b = carrier, .axis = {0, 0, 1}, .ratio = -(1.0f - 72.0f / 24.0f)}));
  }
  for (int i = 0; i < 120; ++i) {
    world.add_torque(sun, {0, 0, 2});
    world.step(kStep);
  }
  const auto spin = [&](BodyId body) { return double(world.angular_velocity(body).z); };
  // Seen from the sun: the carrier with the planets' masses by the square of 1 / 4, the planets' own turning by that of 1 / 2.
  const double moved = 0.5 + (0.8 + 3 * 0.3 * 4.0) / 16.0 + 3 * 0.2 / 4.0;
  EXPECT_TRUE(relative_row("A-42 planetary: acceleration of the sun", spin(sun) / 2.0, 2.0 / moved, 1e-2, 1e-4));
  EXPECT_TRUE(relative_row("A-42 planetary: sun over carrier", spin(sun) / spin(carrier), 4.0, 1e-4, 1e-6));
  // Teeth do not slip: sun and planet move alike where they meet, planet and ring not at all.
  for (const BodyId planet : planets) {
    const DVec3 out = 0.5 * world.pose(planet).position;  // of length 1
    const auto tooth = [&](BodyId body, DVec3 at) { return DVec3(world.velocity_at(body, at)); };
    EXPECT_LE(length(tooth(sun, out) - tooth(planet, out)), 1e-3 * spin(sun));
    EXPECT_LE(length(tooth(planet, 3.0 * out)), 1e-3 * spin(sun));
  }
  run(world, 20.0);
  const double slip = std::fabs(spin(sun) - 4.0 * spin(carrier));
  EXPECT_TRUE(limit_row("A-42 planetary: slip of the carrier (rad/s)", slip, 1e-3, 1e-4));
}

// A rack of 2 kg on a pinion of radius 0.25 m and inertia 0.125 under 1 N m: 1 / (0.125 + 2 * 0.25^2) = 4 rad/s^2.
TEST(RackAndPinion, RollWithoutSlip) {
  World world = weightless();
  const BodyId pinion = world.add_body(point_body(1.0, {1, 1, 0.125f}));
  const BodyId rack = world.add_body(point_body(2.0, {1, 1, 1}, {0, -0.25, 0}));
  world.add_joint(HingeDef{.b = pinion, .axis = {0, 0, 1}});
  world.add_joint(SliderDef{.b = rack, .axis = {1, 0, 0}});
  const JointId joint = world.add_joint(
      RackAndPinionDef{.a = pinion, .b = rack, .axis = {0, 0, 1}, .axis_b = Vec3{1, 0, 0}, .ratio = 0.25f});
  ASSERT_TRUE(joint);
  for (int i = 0; i < 120; ++i) {
    world.add_torque(pinion, {0, 0, 1});
    world.step(kStep);
  }
  EXPECT_TRUE(relative_row("A-42 pinion (rad/s)", double(world.angular_velocity(pinion).z), 8.0, 1e-2, 1e-4));
  EXPECT_TRUE(relative_row("A-42 rack (m/s)", double(world.linear_velocity(rack).x), 2.0, 1e-2, 1e-4));
  run(world, 60.0);
  const double turned = double(world.joint_axis_state(joint, JointAxis::angular_x).position);
  EXPECT_TRUE(limit_row("A-42 slip of the rack in 76 turns (m)",
                        std::fabs(world.pose(rack).position.x - 0.25 * turned), 1e-3, 1e-4));
}

// A free rack against a free pinion: what one gets the other gives, also in angular momentum.
TEST(RackAndPinion, KeepMomentumBetweenThem) {
  World world = weightless();
  const BodyId pinion = world.add_body(point_body(1.0, {0.2f, 0.2f, 0.2f}));
  const BodyId rack = world.add_body(point_body(2.0, {0.4f, 0.4f, 0.4f}, {0, -0.25, 0}));
  world.add_joint(
      RackAndPinionDef{.a = pinion, .b = rack, .axis = {0, 0, 1}, .axis_b = Vec3{1, 0, 0}, .ratio = 0.25f});
  world.set_velocity(pinion, {}, {0, 0, 4});
  world.step(kStep);
  const Momentum m = world.momentum();
  EXPECT_NEAR(length(m.linear), 0.0, 1e-5);
  EXPECT_NEAR(m.angular.z, 0.2 * 4.0, 1e-3);
}

// ------------------------------------------------------------------------------------------------------------- pulleys

// 1 kg and 2 kg on a rope without mass.
TEST(Pulley, IsAtwoodsMachine) {
  World world = make_world({.sleeping = false});
  const BodyId has_extreme_mass_ratio = world.add_body(point_body(1.0, {1e-2f, 1e-2f, 1e-2f}, {-0.5, -2, 0}));
  const BodyId heavy = world.add_body(point_body(2.0, {1e-2f, 1e-2f, 1e-2f}, {0.5, -1, 0}));
  const JointId rope = world.add_joint(PulleyDef{
      .a = has_extreme_mass_ratio, .b = heavy, .anchor = {-0.5, -2, 0}, .ground_a = {-0.5, 0, 0}, .ground_b = {0.5, 0, 0}});
  ASSERT_TRUE(rope);
  run(world, 0.5);
  EXPECT_TRUE(relative_row("A-41 acceleration", -double(world.linear_velocity(heavy).y) / 0.5, kGravity / 3.0,
                           1e-2, 1e-4));
  EXPECT_TRUE(
      relative_row("A-41 tension (N)", double(length(world.joint_state(rope).force)), 13.08, 1e-2, 1e-4));
  EXPECT_NEAR(double(world.joint_state(rope).position), 3.0, 1e-4);
}

// A block and tackle: ratio 2 balances a weight twice as heavy; a rope never pushes.
TEST(Pulley, MultipliesForceAndGoesSlack) {
  World world = make_world({.sleeping = false});
  const BodyId a = world.add_body(point_body(2.0, {1e-2f, 1e-2f, 1e-2f}, {-0.5, -2, 0}));
  const BodyId b = world.add_body(point_body(4.0, {1e-2f, 1e-2f, 1e-2f}, {0.5, -1, 0}));
  const JointId rope = world.add_joint(PulleyDef{.a = a,
                                                 .b = b,
                                                 .anchor = {-0.5, -2, 0},
                                                 .ground_a = {-0.5, 0, 0},
                                                 .ground_b = {0.5, 0, 0},
                                                 .ratio = 2.0f});
  run(world, 2.0);
  EXPECT_NEAR(double(world.linear_velocity(a).y), 0.0, 1e-4);
  EXPECT_NEAR(world.pose(b).position.y, -1.0, 1e-3);
  world.set_velocity(a, {0, 3, 0}, {});
  world.step(kStep);
  EXPECT_NEAR(double(world.linear_velocity(b).y), -kGravity / 60.0, 1e-3) << "slack: b falls freely";
  EXPECT_LT(double(world.joint_state(rope).position), 4.0);
}

// --------------------------------------------------------------------------------------------------------------- paths

std::vector<Vec3> circle(float radius, int count) {
  std::vector<Vec3> points;
  for (int i = 0; i < count; ++i) {
    const double a = 2.0 * kPiDouble * i / count;
    points.push_back({radius * float(std::sin(a)), radius * float(1.0 - std::cos(a)), 0});
  }
  return points;
}

// A bead on a wire that is a circle of 2 m, upright: small swings take 2 pi sqrt(R / g), and energy stays.
TEST(Path, BeadOnACircularWireIsAPendulum) {
  World world = make_world({.sleeping = false});
  const BodyId bead = world.add_body(point_body(1.0, {1e-3f, 1e-3f, 1e-3f}));
  ASSERT_TRUE(world.add_joint(PathDef{.b = bead, .points = circle(2.0f, 64), .closed = true}));
  world.set_velocity(bead, {0.2f, 0, 0}, {});
  ZeroCrossings through;
  double off = 0.0;
  for (int i = 0; i < 1800; ++i) {
    const DVec3 p = world.pose(bead).position;
    through.add(double(i) * double(kStep), p.x);
    off = std::max(off, std::fabs(std::hypot(p.x, p.y - 2.0) - 2.0));
    world.step(kStep);
  }
  const double amplitude = 0.2 / std::sqrt(2.0 * kGravity);
  const double period = 2.0 * kPiDouble * std::sqrt(2.0 / kGravity) * (1.0 + amplitude * amplitude / 16.0);
  EXPECT_TRUE(relative_row("period of a bead", through.mean_period(), period, 2e-3, 2e-4));
  EXPECT_TRUE(limit_row("off the wire (m)", off, 1e-3, 1e-4));
}

// Looping the loop without friction: speed at the top of v0^2 - 4 g R, and no energy lost in 20 rounds.
TEST(Path, KeepsItsEnergyAround) {
  for (const PathOrientation orientation :
       {PathOrientation::free, PathOrientation::fixed, PathOrientation::following}) {
    World world = make_world({.sleeping = false});
    const BodyId bead = world.add_body(point_body(1.0, {0.05f, 0.05f, 0.05f}));
    ASSERT_TRUE(world.add_joint(
        PathDef{.b = bead, .points = circle(2.0f, 64), .closed = true, .orientation = orientation}));
    const float v0 = 12.0f;
    world.set_velocity(bead, {v0, 0, 0},
                       orientation == PathOrientation::following ? Vec3{0, 0, v0 / 2} : Vec3{});
    world.step(kStep);
    const auto energy = [&] { return world.energy().kinetic + world.energy().potential; };
    const double start = energy();
    double worst = 0.0, tilt = 0.0;
    int rounds = 0;
    double before = 0.0;
    for (int i = 0; i < 1200; ++i) {
      world.step(kStep);
      worst = std::max(worst, std::fabs(energy() / start - 1.0));
      const DVec3 p = world.pose(bead).position;
      if (before < 0.0 && p.x >= 0.0 && p.y < 2.0) ++rounds;
      before = p.x;
      if (orientation != PathOrientation::following) continue;
      const DVec3 along = turned(world.pose(bead).orientation, {1, 0, 0});
      tilt = std::max(tilt, std::fabs(dot(along, (1.0 / 2.0) * (p - DVec3{0, 2, 0}))));
    }
    EXPECT_GE(rounds, 14);
    EXPECT_TRUE(limit_row("energy lost or gained on a loop", worst, 2e-2, 2e-3));
    EXPECT_TRUE(limit_row("its nose off the curve (rad)", tilt, 2e-2, 2e-3));
  }
}

TEST(Path, EndsWhereItEnds) {
  World world = weightless();
  const BodyId cart = world.add_body(point_body(1.0, {1, 1, 1}));
  const JointId joint =
      world.add_joint(PathDef{.b = cart, .points = {{-1, 0, 0}, {0, 0, 0}, {1, 0.2f, 0}, {2, 0, 0}}});
  world.set_velocity(cart, {3, 0, 0}, {});
  run(world, 3.0);
  EXPECT_NEAR(world.pose(cart).position.x, 2.0, 2e-3);
  EXPECT_NEAR(double(world.joint_state(joint).velocity), 0.0, 1e-3);
}

// ---------------------------------------------------------------------------------------------------- mice and motors

// A mouse pulls a body after a point, with no more than its force: 10 kg, 5 N, from 4 m away.
TEST(Mouse, DragsWithALimitedForce) {
  World world = weightless();
  const BodyId body = world.add_body(point_body(10.0, {1, 1, 1}));
  const JointId mouse = world.add_joint(MouseDef{.b = body, .drive = {.frequency = 5.0f, .max_force = 5.0f}});
  ASSERT_TRUE(mouse);
  EXPECT_TRUE(world.set_drive(mouse, {.position = {4, 0, 0}, .frequency = 5.0f, .max_force = 5.0f}));
  run(world, 1.0);
  EXPECT_NEAR(double(world.linear_velocity(body).x), 0.5, 1e-3) << "at full force";
  EXPECT_NEAR(double(length(world.joint_state(mouse).force)), 5.0, 1e-3);
  EXPECT_TRUE(world.set_drive(mouse, {.position = {4, 1, 0}, .frequency = 5.0f, .max_force = 5000.0f}));
  run(world, 2.0);
  EXPECT_LE(length(world.pose(body).position - DVec3{4, 1, 0}), 1e-3);
}

// Off its centre it turns the body too: a point of it, not its centre, comes to the mouse.
TEST(Mouse, DragsTheVeryPoint) {
  World world = make_world({.sleeping = false});
  BodyDef def = point_body(1.0, {0.1f, 0.1f, 0.1f});
  def.angular_damping = 3.0f;
  const BodyId body = world.add_body(def);
  ASSERT_TRUE(world.add_joint(
      MouseDef{.b = body, .anchor = {0.5, 0, 0}, .drive = {.frequency = 10.0f, .max_force = 200.0f}}));
  run(world, 15.0);
  const DVec3 hung = world.pose(body).position;
  const double omega = 2.0 * kPiDouble * 10.0;
  EXPECT_NEAR(hung.x, 0.5, 1e-2);
  EXPECT_NEAR(hung.y, -0.5, 0.5 * kGravity / omega + 1e-2) << "hangs below the point";
}

TEST(PoseMotor, BringsABodyToItsPose) {
  const Quat turn = from_rotation_vector({0.4f, -0.3f, 0.8f});
  for (const float frequency : {0.0f, 3.0f}) {
    World world = make_world({.sleeping = false});
    const BodyId body = world.add_body(point_body(2.0, {0.2f, 0.3f, 0.4f}));
    const JointId motor = world.add_joint(MotorDef{.b = body,
                                                   .drive = {.position = {1, 2, 3},
                                                             .orientation = turn,
                                                             .frequency = frequency,
                                                             .max_force = 1000.0f,
                                                             .max_torque = 500.0f}});
    ASSERT_TRUE(motor);
    run(world, 3.0);
    const double omega = 2.0 * kPiDouble * double(frequency);
    const double sag = frequency > 0.0f ? kGravity / (omega * omega) : 0.0;
    EXPECT_LE(length(world.pose(body).position - DVec3{1, 2 - sag, 3}), 2e-3);
    EXPECT_LE(double(length(to_rotation_vector(world.pose(body).orientation * conjugate(turn)))), 1e-3);
    EXPECT_NEAR(double(world.joint_state(motor).force.y), 2.0 * kGravity, 0.05);
  }
}

TEST(PoseMotor, TurnsNoHarderThanItMay) {
  World world = weightless();
  const BodyId body = world.add_body(point_body(1.0, {1, 1, 1}));
  world.add_joint(
      MotorDef{.b = body, .drive = {.orientation = from_axis_angle({0, 0, 1}, 2.5f), .max_torque = 0.5f}});
  run(world, 1.0);
  EXPECT_NEAR(double(world.angular_velocity(body).z), 0.5, 1e-3);
}

}  // namespace
}  // namespace gyre::laws::joint_kinds_test
