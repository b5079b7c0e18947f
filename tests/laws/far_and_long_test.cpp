// Worlds with very unequal sizes, masses and times: small on large, many sub-steps, steps of any length, locked axes,
// shafts that turn for long. Parameters are drawn.
#include "laws/kit.h"

#include <random>

namespace gyre::laws::far_and_long_test {
namespace {

struct Draw {
  std::mt19937 engine;
  double operator()(double low, double high) {
    return low + (high - low) * (double(engine() >> 8) / 16777216.0);
  }
  // With even chances for each factor of ten.
  double scale(double low, double high) { return std::exp((*this)(std::log(low), std::log(high))); }
  Vec3 direction() {
    for (;;) {
      const Vec3 v{float((*this)(-1, 1)), float((*this)(-1, 1)), float((*this)(-1, 1))};
      if (length(v) > 0.1f && length(v) < 1.0f) return v / length(v);
    }
  }
};

TEST(LargeGround, SmallFastBallsKeepTheirWay) {
  Draw draw{std::mt19937{1}};
  for (int trial = 0; trial < 12; ++trial) {
    const double half = draw.scale(10.0, 10000.0), radius = draw.scale(0.005, 0.05), speed = draw(0.3, 3.0);
    const double angle = draw(0.0, 6.28), place = draw(0.0, 0.8) * half;
    const Quat turn = trial % 2 == 0 ? Quat{} : from_axis_angle({0, 1, 0}, float(draw(0.0, 3.0)));
    World world = make_world({.sleeping = false});
    world.add_body({.type = BodyType::fixed, .pose = {.position = {0, -0.5, 0}, .orientation = turn}},
                   {.geometry = Box{{float(half), 0.5f, float(half)}}, .material = surface(0.5f)});
    const DVec3 start{place * std::cos(angle), radius, place * std::sin(angle)};
    const BodyId ball = world.add_body({.pose = {.position = start},
                                        .linear_velocity = {float(speed), 0, 0},
                                        .angular_velocity = {0, 0, float(-speed / radius)}},
                                       {.geometry = Sphere{float(radius)}, .material = surface(0.5f)});
    run(world, 2.0);
    EXPECT_NEAR(world.pose(ball).position.x - start.x, 2.0 * speed, 0.005 * speed)
        << "radius " << radius << " m, box " << half << " m, at " << place << " m";
  }
}

// The error of the speed and of the height after a fall.
DVec3 fall_error(int substeps, double seconds, bool jointed) {
  World world = make_world({.stepping = {.substeps = substeps}, .sleeping = false});
  const BodyId body = world.add_body({}, {.geometry = Sphere{0.3f}});
  if (jointed) {
    const BodyId other = world.add_body({.pose = {.position = {1, 0, 0}}}, {.geometry = Sphere{0.3f}});
    FixedDef fixed;
    fixed.a = body, fixed.b = other, fixed.anchor = {0.5, 0, 0};
    world.add_joint(fixed);
  }
  run(world, seconds);
  const double t = double(std::lround(seconds / double(kStep))) * double(kStep);
  return {absolute(double(world.linear_velocity(body).y) + kGravity * t),
          absolute(world.pose(body).position.y + 0.5 * kGravity * t * t), 0.0};
}
TEST(LongFall, MoreSubstepsAreNeverWorse) {
  Draw draw{std::mt19937{2}};
  for (int trial = 0; trial < 4; ++trial) {
    const double seconds = draw(5.0, 15.0);
    double before = 1.0e300;
    for (const int substeps : {1, 4, 16, 64}) {
      const DVec3 error = fall_error(substeps, seconds, trial % 2 == 1);
      EXPECT_LT(error.y, before) << substeps << " sub-steps, " << seconds << " s";
      EXPECT_LT(error.x, 0.01) << substeps;
      before = error.y;
    }
    EXPECT_LT(before, 0.02);
  }
}

TEST(LockedAxes, ABodySupportsAlongThemAndYieldsAlongTheOthers) {
  Draw draw{std::mt19937{3}};
  for (int trial = 0; trial < 8; ++trial) {
    const float ratio = float(draw.scale(0.1, 100.0)), restitution = trial % 3 == 0 ? 0.3f : 0.0f;
    World world = make_world({.sleeping = false});
    LockedAxes locked{{false, true, false}, {true, true, true}};
    const BodyId shelf = world.add_body(
        {.locked = locked}, {.geometry = Box{{1, 0.1f, 1}}, .material = surface(0.6f, restitution)});
    const float mass = world.mass_properties(shelf).mass;
    const BodyId load =
        world.add_body({.pose = {.position = {0, 0.6, 0}},
                        .linear_velocity = {trial % 2 == 0 ? 0.0f : 1.0f, 0, 0},
                        .mass = ratio * mass},
                       {.geometry = Box{{0.5f, 0.5f, 0.5f}}, .material = surface(0.6f, restitution)});
    run(world, 3.0);
    EXPECT_NEAR(world.pose(load).position.y, 0.6, 0.002) << ratio;
    EXPECT_EQ(world.pose(shelf).position.y, 0.0);
    if (trial % 2 == 0) continue;
    // Friction drags the shelf along; momentum is shared.
    const double common = double(ratio) / (1.0 + double(ratio));
    EXPECT_NEAR(double(world.linear_velocity(shelf).x), common, 0.01 * common + 1.0e-3) << ratio;
    EXPECT_NEAR(double(world.linear_velocity(load).x), common, 0.01 * common + 1.0e-3) << ratio;
  }
}

TEST(TurningGearbox, WheelsThatNothingDrivesStandStillInTheirHousing) {
  Draw draw{std::mt19937{5}};
  for (int trial = 0; trial < 8; ++trial) {
    const float ratio = trial % 2 == 0 ? 1.0f : 2.0f, off_plane = float(draw(0.001, 1.5));
    const Vec3 w{std::sin(off_plane), 0, std::cos(off_plane)};
    World world = make_world({.gravity = {0, 0, 0}, .sleeping = false});
    const ShapeDef ball{.geometry = Sphere{0.3f}, .filter = {.collides_with = 0}};
    const BodyId housing = world.add_body({.type = BodyType::kinematic, .angular_velocity = w}, ball);
    JointId hinges[2];
    BodyId wheels[2];
    for (int i = 0; i < 2; ++i) {
      const DVec3 p{0.6, i == 0 ? 0.4 : -0.4, 0};
      wheels[i] = world.add_body(
          {.pose = {.position = p}, .linear_velocity = cross(w, to_float(p)), .angular_velocity = w}, ball);
    }
    GearDef gear;
    gear.a = wheels[0], gear.b = wheels[1], gear.axis = {1, 0, 0}, gear.ratio = ratio;
    if (trial < 4) world.add_joint(gear);  // before its bearings
    for (int i = 0; i < 2; ++i) {
      HingeDef hinge;
      hinge.a = housing, hinge.b = wheels[i], hinge.anchor = {0.6, i == 0 ? 0.4 : -0.4, 0},
      hinge.axis = {1, 0, 0};
      hinges[i] = world.add_joint(hinge);
    }
    if (trial >= 4) world.add_joint(gear);
    for (int i = 1; i <= 3; ++i) {
      run(world, 6.0);
      for (const JointId hinge : hinges)
        EXPECT_NEAR(double(world.joint_state(hinge).position), 0.0, 0.005)
            << off_plane << " rad off the plane, ratio " << ratio << ", turn " << i;
    }
  }
}

TEST(TurningGearbox, TeethDoNotSlipInAFreeHousingInThousandsOfTurns) {
  Draw draw{std::mt19937{8}};
  for (int trial = 0; trial < 8; ++trial) {
    World world = make_world({.gravity = {0, 0, 0}, .sleeping = false});
    const ShapeDef box{.geometry = Box{{0.3f, 0.2f, 0.25f}}, .filter = {.collides_with = 0}};
    const ShapeDef disc{.geometry = Cylinder{0.2f, 0.05f}, .filter = {.collides_with = 0}};
    const Quat turn = from_rotation_vector({float(draw(-2, 2)), float(draw(-2, 2)), float(draw(-2, 2))});
    const float angle =
        trial % 2 == 0 ? 0.0f : float(draw(0.4, 2.7));  // between the shafts: spur and bevel gears
    const float ratio = float(draw(0.5, 3.0)) * (trial % 4 < 2 ? 1.0f : -1.0f);
    const Vec3 axes[2] = {rotate(turn, {0, 1, 0}), rotate(turn, {0, std::cos(angle), std::sin(angle)})};
    const DVec3 places[2] = {DVec3(rotate(turn, {-0.3f, 0, 0})), DVec3(rotate(turn, {0.3f, 0.1f, 0}))};
    const BodyId housing =
        world.add_body({.pose = {.orientation = turn}, .mass = float(draw(0.5, 20.0))}, box);
    BodyId wheels[2];
    JointId hinges[2];
    for (int i = 0; i < 2; ++i) {
      const Quat along = from_directions({0, 1, 0}, axes[i]);
      wheels[i] = world.add_body(
          {.pose = {.position = places[i], .orientation = along}, .mass = float(draw(0.5, 5.0))}, disc);
      HingeDef hinge;
      hinge.a = housing, hinge.b = wheels[i], hinge.anchor = places[i], hinge.axis = axes[i];
      if (i == 0) hinge.motor = {.target_velocity = 60.0f, .max_force = float(draw(0.5, 2.0))};
      hinges[i] = world.add_joint(hinge);
    }
    GearDef gear;
    gear.a = wheels[0], gear.b = wheels[1], gear.axis = axes[0], gear.axis_b = axes[1], gear.ratio = ratio;
    const JointId teeth = world.add_joint(gear);
    for (int i = 0; i < 4; ++i) {
      run(world, trial == 0 ? 27.0 : 2.0);
      const double a = double(world.joint_state(hinges[0]).position),
                   b = double(world.joint_state(hinges[1]).position);
      EXPECT_NEAR(a + double(ratio) * b, 0.0, 0.02)
          << "trial " << trial << ", ratio " << ratio << ", angle " << angle;
      EXPECT_NEAR(double(world.joint_axis_state(teeth, JointAxis::angular_x).position), a, 0.02) << trial;
      EXPECT_NEAR(double(world.joint_axis_state(teeth, JointAxis::angular_x).velocity),
                  double(world.joint_state(hinges[0]).velocity), 0.2)
          << trial;
      // The motor and the teeth are inside the gearbox.
      EXPECT_LT(length(world.momentum().linear), 0.02) << trial;
      EXPECT_LT(length(world.momentum().angular), 0.02) << trial;
    }
    EXPECT_GT(double(world.joint_state(hinges[0]).position), trial == 0 ? 6000.0 : 100.0) << trial;
  }
}

TEST(Density, ABodyOfShapesWithoutDensityRollsAndTurns) {
  Draw draw{std::mt19937{6}};
  for (int trial = 0; trial < 6; ++trial) {
    const float radius = float(draw(0.05, 0.5));
    World light = make_world({.gravity = {0, 0, 0}}), plain = make_world({.gravity = {0, 0, 0}});
    BodyDef def;
    if (trial % 2 == 0) def.mass = float(draw(0.1, 10.0));
    const BodyId a = light.add_body(def, {.geometry = Capsule{radius, 0.4f}, .density = 0.0f});
    def.mass = def.mass ? *def.mass : 1.0f;
    const BodyId b = plain.add_body(def, {.geometry = Capsule{radius, 0.4f}});
    light.add_torque(a, {1, 2, 3}), plain.add_torque(b, {1, 2, 3});
    light.step(kStep), plain.step(kStep);
    EXPECT_NEAR(double(length(light.angular_velocity(a) - plain.angular_velocity(b))), 0.0,
                1.0e-4 * double(length(plain.angular_velocity(b))));
    EXPECT_GT(length(light.angular_velocity(a)), 0.0f);
  }
}

// How often a chain of eight balls reports that sequential impulses are too weak for it, and how far its end is off after two seconds.
int weak_steps(float heavy, double& off) {
  World world = make_world({.stepping = {.solver = SolverKind::sequential_impulses}, .sleeping = false});
  BodyId last;
  for (int i = 0; i < 8; ++i) {
    const BodyId body =
        world.add_body({.pose = {.position = {0, -0.5 * i, 0}}, .mass = i == 7 ? heavy : 1.0f},
                       {.geometry = Sphere{0.2f}, .filter = {.collides_with = 0}});
    BallDef ball;
    ball.a = last, ball.b = body, ball.anchor = {0, 0.25 - 0.5 * i, 0};
    world.add_joint(ball);
    last = body;
  }
  int reports = 0;
  for (int i = 0; i < 120; ++i) {
    world.step(kStep);
    for (const Problem& problem : world.problems()) reports += problem.code == ErrorCode::unstable ? 1 : 0;
  }
  off = absolute(world.pose(last).position.y + 3.5);
  return reports;
}
TEST(SequentialImpulses, OpenJointsAreReported) {
  Draw draw{std::mt19937{7}};
  for (int trial = 0; trial < 6; ++trial) {
    const float heavy = float(draw.scale(1.0, 1000.0));
    double off = 0.0;
    const int reports = weak_steps(heavy, off);
    if (off > 0.1) {
      EXPECT_GT(reports, 60) << heavy << ": off by " << off;
    } else if (off < 0.01) {
      EXPECT_EQ(reports, 0) << heavy << ": off by " << off;
    }
  }
}

TEST(StepsOfAnyLength, AVeryShortOneDoesNotThrowBodies) {
  Draw draw{std::mt19937{8}};
  for (int trial = 0; trial < 4; ++trial) {
    World world = make_world({.sleeping = false});
    add_ground(world, surface(0.5f));
    BodyId last;
    for (int i = 0; i < 6; ++i) {
      const BodyId body =
          world.add_body({.pose = {.position = {draw(-0.05, 0.05), 0.3 + 0.45 * i, draw(-0.05, 0.05)}},
                          .linear_velocity = {0, float(draw(-3.0, 0.0)), 0}},
                         {.geometry = Box{{0.2f, 0.2f, 0.2f}}, .material = surface(0.5f)});
      if (i % 2 == 1) {
        BallDef ball;
        ball.a = last, ball.b = body, ball.anchor = world.pose(body).position;
        world.add_joint(ball);
      }
      last = body;
    }
    double highest = 0.0;
    for (int i = 0; i < 240; ++i) {
      world.step(i % 3 == 2 ? float(draw.scale(1.0e-8, 1.0e-3)) : kStep);
      const double energy = world.energy().kinetic;
      highest = std::max(highest, energy);
    }
    // They fall by less than three metres, and come with 3 m/s at most.
    EXPECT_LT(highest, 6 * 64.0 * (9.81 * 3.0 + 4.5));
  }
}

}  // namespace
}  // namespace gyre::laws::far_and_long_test
