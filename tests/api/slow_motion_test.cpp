// Slow motion that must go on: what drives or accelerates a body keeps it awake, what drifts freely goes on, and what rests sleeps.
#include "laws/kit.h"

#include <gyre/replay.h>

#include <random>

namespace gyre::laws::slow_motion_test {
namespace {

constexpr double kLong = 5.0;  // s

// The speeds are from well below the sleep speed of a box of a metre, 0.044 m/s, to above it.
std::vector<float> slow_speeds() {
  std::mt19937 random(3);
  std::uniform_real_distribution<float> draw(-3.5f, -1.0f);
  std::vector<float> speeds;
  for (int i = 0; i < 4; ++i) speeds.push_back(std::pow(10.0f, draw(random)));
  return speeds;
}

TEST(SlowMotion, OfMotorsGoesOn) {
  for (const float speed : slow_speeds()) {
    World world = make_world();
    const BodyId lift = world.add_body({.pose = {.position = {0, 5, 0}}}, {.geometry = Box{}});
    world.add_joint(SliderDef{.b = lift,
                              .anchor = {0, 5, 0},
                              .axis = {0, 1, 0},
                              .motor = {.target_velocity = speed, .max_force = 1e6f}});
    const BodyId hand =
        world.add_body({.pose = {.position = {10, 5.5, 0}}}, {.geometry = Box{{0.02f, 0.5f, 0.02f}}});
    const JointId clock = world.add_joint(HingeDef{.b = hand,
                                                   .anchor = {10, 5, 0},
                                                   .axis = {0, 0, 1},
                                                   .motor = {.target_velocity = speed, .max_force = 1000}});
    run(world, kLong);
    EXPECT_NEAR(world.pose(lift).position.y - 5, double(speed) * kLong, 0.02 * double(speed) * kLong + 1e-4);
    EXPECT_NEAR(double(world.joint_state(clock).position), double(speed) * kLong,
                0.02 * double(speed) * kLong + 1e-4);
    EXPECT_TRUE(world.is_awake(lift) && world.is_awake(hand));
  }
}

TEST(SlowMotion, OfAMotorAtItsLimitEnds) {
  World world = make_world();
  const BodyId lift = world.add_body({.pose = {.position = {0, 5, 0}}}, {.geometry = Box{}});
  world.add_joint(SliderDef{.b = lift,
                            .anchor = {0, 5, 0},
                            .axis = {0, 1, 0},
                            .limits = Limits{0, 0.1f},
                            .motor = {.target_velocity = 0.1f, .max_force = 1e6f}});
  run(world, 4);
  EXPECT_NEAR(world.pose(lift).position.y, 5.1, 1e-3);
  EXPECT_FALSE(world.is_awake(lift));
}

TEST(SlowMotion, OnBeltsGoesOn) {
  for (const float speed : {0.003f, 0.01f, 0.03f}) {
    World world = make_world();
    world.set_surface_rule({.id = 1, .velocity = {speed, 0, 0}});
    Material belt;
    belt.id = 1;
    world.add_body({.type = BodyType::fixed, .pose = {.position = {0, -0.5, 0}}},
                   {.geometry = Box{{20, 0.5f, 2}}, .material = belt});
    const BodyId parcel = world.add_body({.pose = {.position = {0, 0.5, 0}}}, {.geometry = Box{}});
    run(world, kLong);
    EXPECT_NEAR(world.pose(parcel).position.x, double(speed) * kLong, 0.05 * double(speed) * kLong) << speed;
  }
}

TEST(SlowMotion, OfAParcelThatAWallHoldsOnABeltEnds) {
  World world = make_world();
  world.set_surface_rule({.id = 1, .velocity = {0.5f, 0, 0}});
  Material belt;
  belt.id = 1;
  world.add_body({.type = BodyType::fixed, .pose = {.position = {0, -0.5, 0}}},
                 {.geometry = Box{{20, 0.5f, 2}}, .material = belt});
  world.add_body({.type = BodyType::fixed, .pose = {.position = {2, 0.5, 0}}}, {.geometry = Box{}});
  const BodyId parcel = world.add_body({.pose = {.position = {0.5, 0.5, 0}}}, {.geometry = Box{}});
  run(world, 6);
  EXPECT_FALSE(world.is_awake(parcel));
}

TEST(SlowMotion, OfDoorsGoesOn) {
  for (const float speed : {0.004f, 0.01f, 0.03f, 0.1f}) {
    World world = make_world();
    const BodyId door = world.add_body({.pose = {.position = {0.5, 5, 0}},
                                        .linear_velocity = {0, 0, -0.5f * speed},
                                        .angular_velocity = {0, speed, 0}},
                                       {.geometry = Box{{0.5f, 1, 0.03f}}});
    const JointId hinge = world.add_joint(HingeDef{.b = door, .anchor = {0, 5, 0}, .axis = {0, 1, 0}});
    run(world, kLong);
    EXPECT_NEAR(double(world.joint_state(hinge).position), double(speed) * kLong,
                0.05 * double(speed) * kLong);
  }
}

TEST(SlowMotion, OfAPoleOffBalanceGrows) {
  for (const float angle : {0.0005f, 0.001f, 0.003f}) {
    World world = make_world();
    const Quat turn = from_axis_angle({0, 0, 1}, -angle);
    const BodyId pole =
        world.add_body({.pose = {{std::sin(double(angle)), std::cos(double(angle)), 0}, turn}},
                       {.geometry = Box{{0.05f, 1, 0.05f}}});
    world.add_joint(HingeDef{.b = pole, .anchor = {0, 0, 0}, .axis = {0, 0, 1}});
    double lowest = 1;
    for (int i = 0; i < 300; ++i) {
      world.step(kStep);
      lowest = std::min(lowest, world.pose(pole).position.y);
    }
    EXPECT_LT(lowest, 0.0) << angle;
  }
}

// A spring that is almost overdamped a hundred times creeps to its rest.
TEST(SlowMotion, OfSpringsGoesOnToTheirRest) {
  for (const float way : {0.05f, 0.2f}) {
    World world = make_world({.gravity = {0, 0, 0}});
    const BodyId weight =
        world.add_body({.pose = {.position = {double(way), 0, 0}}, .mass = 10.0f}, {.geometry = Box{}});
    SixDofDef joint{.b = weight};
    joint.linear_x = {.motion = AxisMotion::free, .stiffness = 100, .damping = 500};
    world.add_joint(joint);
    const double rest = world.pose(weight).position.x;
    world.set_pose(weight, {.position = {rest - double(way), 0, 0}});
    run(world, 40);
    EXPECT_NEAR(world.pose(weight).position.x, rest, 0.02);
    EXPECT_FALSE(world.is_awake(weight));
  }
}

TEST(SlowMotion, InSpaceGoesOnForBodiesTogether) {
  for (const float speed : slow_speeds()) {
    World world = weightless();
    // The same without weight of its own.
    World heavy = make_world();
    const BodyId e =
        heavy.add_body({.linear_velocity = {speed, 0, 0}, .gravity_scale = 0}, {.geometry = Box{}});
    const BodyId f = heavy.add_body(
        {.pose = {.position = {1.1, 0, 0}}, .linear_velocity = {speed, 0, 0}, .gravity_scale = 0},
        {.geometry = Box{}});
    heavy.add_joint(FixedDef{.a = e, .b = f, .anchor = {0.55, 0, 0}});
    run(heavy, kLong);
    EXPECT_NEAR(heavy.pose(e).position.x, double(speed) * kLong, 1e-3 * double(speed) * kLong);
    const BodyId a = world.add_body({.linear_velocity = {speed, 0, 0}}, {.geometry = Box{}});
    const BodyId b = world.add_body({.pose = {.position = {1.1, 0, 0}}, .linear_velocity = {speed, 0, 0}},
                                    {.geometry = Box{}});
    world.add_joint(FixedDef{.a = a, .b = b, .anchor = {0.55, 0, 0}});
    // Two that touch, and one alone.
    const BodyId c = world.add_body({.pose = {.position = {0, 5, 0}}, .linear_velocity = {speed, 0, 0}},
                                    {.geometry = Box{}});
    world.add_body({.pose = {.position = {0, 6, 0}}, .linear_velocity = {speed, 0, 0}}, {.geometry = Box{}});
    const BodyId d = world.add_body({.pose = {.position = {0, 9, 0}}, .linear_velocity = {speed, 0, 0}},
                                    {.geometry = Box{}});
    run(world, kLong);
    for (const BodyId body : {a, c, d})
      EXPECT_NEAR(world.pose(body).position.x, double(speed) * kLong, 1e-3 * double(speed) * kLong);
  }
}

TEST(SlowMotion, ThatIsNoneSleepsInSpace) {
  World world = weightless();
  const BodyId a = world.add_body({}, {.geometry = Box{}});
  const BodyId b = world.add_body({.pose = {.position = {1.1, 0, 0}}}, {.geometry = Box{}});
  world.add_joint(FixedDef{.a = a, .b = b, .anchor = {0.55, 0, 0}});
  run(world, 1);
  EXPECT_FALSE(world.is_awake(a) || world.is_awake(b));
}

// A joint that is taken far from where it holds brings its body back without velocity.
TEST(SlowMotion, BackToAJointGoesOn) {
  std::mt19937 random(9);
  std::uniform_real_distribution<double> draw(0.5, 10);
  for (int kind = 0; kind < 5; ++kind) {
    World world = make_world();
    const BodyId box =
        world.add_body({.pose = {.position = {0, -1, 0}}}, {.geometry = Box{{0.3f, 0.3f, 0.3f}}});
    JointDef joint = BallDef{.b = box};
    if (kind == 1) joint = HingeDef{.b = box, .axis = {1, 0, 0}};
    if (kind == 2) joint = FixedDef{.b = box};
    if (kind == 3) joint = SliderDef{.b = box, .axis = {1, 0, 0}};
    if (kind == 4) joint = DistanceDef{.b = box, .anchor = {0, 0, 0}, .anchor_b = DVec3{0, -1, 0}};
    world.add_joint(joint);
    run(world, 0.5);
    world.set_pose(box, {.position = {0, -1.0 - draw(random), 0}});
    run(world, 10);
    EXPECT_LT(length(world.pose(box).position - DVec3{0, -1, 0}), 0.01) << "joint " << kind;
  }
}

TEST(SlowMotion, BackToALimitGoesOn) {
  for (const float angle : {1.0f, 2.0f, 3.0f}) {
    World world = weightless();
    const BodyId arm = world.add_body({.pose = {.position = {1, 0, 0}}}, {.geometry = Box{{1, 0.1f, 0.1f}}});
    const JointId hinge = world.add_joint(HingeDef{.b = arm, .axis = {0, 0, 1}});
    world.step(kStep);
    world.set_joint_axis(hinge, JointAxis::angular_x,
                         {.motion = AxisMotion::limited, .limits = {angle, angle + 0.1f}});
    run(world, 10);
    EXPECT_GT(world.joint_state(hinge).position, angle - 0.01f);
    EXPECT_LT(world.joint_state(hinge).position, angle + 0.11f);
  }
}

// ------------------------------------------------------------------------------------------------------ thresholds

bool sleeps_while_swinging(float sleep_share, float sleep_speed) {
  World world = *World::create({.sleep_share = sleep_share});
  const BodyId lamp = world.add_body({.pose = {.position = {0.02, -1, 0}}, .sleep_speed = sleep_speed},
                                     {.geometry = Sphere{0.1f}});
  world.add_joint(BallDef{.b = lamp, .anchor = {0, 0, 0}});
  run(world, 5);
  return !world.is_awake(lamp);
}

TEST(SleepSpeed, IsSetForTheWorldAndForABody) {
  const float usual = WorldDef{}.sleep_share;
  EXPECT_FALSE(sleeps_while_swinging(usual, 0));
  EXPECT_TRUE(sleeps_while_swinging(usual, 0.2f));  // the lamp swings at up to 0.06 m/s
  EXPECT_FALSE(sleeps_while_swinging(usual, 0.02f));
  EXPECT_TRUE(sleeps_while_swinging(100 * usual, 0));
}

TEST(SleepSpeed, IsReadAndRecordedAndComesBack) {
  World world = *World::create({.sleep_share = 0.05f});
  const BodyId a = world.add_body({.sleep_speed = 0.5f}, {.geometry = Sphere{}});
  const BodyId b = world.add_body({}, {.geometry = Sphere{}});
  EXPECT_EQ(world.sleep_share(), 0.05f);
  EXPECT_EQ(world.def().sleep_share, 0.05f);
  EXPECT_EQ(world.sleep_speed(a), 0.5f);
  EXPECT_EQ(world.sleep_speed(b), 0.0f);
  EXPECT_TRUE(world.set_sleep_speed(b, 0.25f));
  EXPECT_TRUE(world.set_sleep_share(0.03f));
  World other = *load_snapshot(save_snapshot(world));
  EXPECT_EQ(other.hash(), world.hash());
  EXPECT_EQ(other.sleep_share(), 0.03f);
  world.set_sleep_speed(b, 0);
  EXPECT_NE(other.hash(), world.hash());
  // A body in the place of a removed one has the speed of the world.
  world.remove_body(a);
  EXPECT_EQ(world.sleep_speed(world.add_body({}, {.geometry = Sphere{}})), 0.0f);
}

TEST(SleepSpeed, OutOfRangeIsRefused) {
  World world = make_world();
  const BodyId body = world.add_body({}, {.geometry = Sphere{}});
  for (const float bad : {-1.0f, 1.0e9f, std::nanf("")}) {
    EXPECT_FALSE(world.set_sleep_speed(body, bad));
    EXPECT_FALSE(world.set_sleep_share(bad));
    EXPECT_FALSE(World::create({.sleep_share = bad}));
    EXPECT_FALSE(world.add_body({.sleep_speed = bad}, {.geometry = Sphere{}}));
  }
  EXPECT_FALSE(world.set_sleep_speed({}, 1.0f));
}

}  // namespace
}  // namespace gyre::laws::slow_motion_test
