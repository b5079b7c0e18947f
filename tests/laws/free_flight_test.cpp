// Bodies that nothing touches: free fall, drag, forces and torques, damping, locked axes.
// Source: any textbook of mechanics; the discretisation error of semi-implicit Euler is derived beside its test.
#include "laws/kit.h"

namespace gyre::laws::free_flight_test {
namespace {

TEST(FreeFall, IsTheExactParabolaOrThatOfTheIntegrator) {
  World world = make_world();
  const BodyId ball = world.add_body({.pose = {.position = {0, 100, 0}}, .linear_velocity = {20, 20, 0}},
                                     {.geometry = Sphere{}});
  run(world, 2.0);
  const double y = world.pose(ball).position.y;
  // x += v h after v += a h is low by g T h / 2; the midpoint form is exact. Nothing between is.
  const double exact = 100.0 + 40.0 - 0.5 * kGravity * 4.0;
  const double euler = exact - 0.5 * kGravity * 2.0 / 480.0;
  const double expected = std::fabs(y - exact) < std::fabs(y - euler) ? exact : euler;
  EXPECT_TRUE(row("A-01 free fall", y, expected, 1e-3, 1e-4));
  say("[row] A-01 distance from the exact parabola %g m\n", y - exact);
  EXPECT_TRUE(row("A-01 free fall, x", world.pose(ball).position.x, 40.0, 1e-3, 1e-4));
}

TEST(Projectile, RangeAndTime) {
  World world = make_world();
  const float v = 20.0f * std::sqrt(0.5f);
  const BodyId ball = world.add_body({.linear_velocity = {v, v, 0}}, {.geometry = Sphere{.radius = 0.05f}});
  double range = 0.0, time = 0.0;
  DVec3 last = world.pose(ball).position;
  for (int i = 0; i < 240 && range == 0.0; ++i) {
    world.step(kStep);
    const DVec3 p = world.pose(ball).position;
    if (p.y < 0.0) {
      const double t = last.y / (last.y - p.y);
      range = last.x + t * (p.x - last.x);
      time = (double(i) + t) * double(kStep);
    }
    last = p;
  }
  EXPECT_TRUE(relative_row("A-02 range", range, 40.775, 2e-3, 1e-5));
  EXPECT_TRUE(relative_row("A-02 time of flight", time, 2.8832, 2e-3, 1e-5));
}

TEST(LinearDrag, ApproachesTheTerminalSpeed) {
  World world = make_world();
  const BodyId ball = world.add_body({.linear_damping = 0.5f}, {.geometry = Sphere{}});
  run(world, 2.0);
  EXPECT_TRUE(
      relative_row("A-06 speed after 2 s", -double(world.linear_velocity(ball).y), 12.402, 1e-2, 5e-4));
  EXPECT_TRUE(relative_row("A-06 fall in 2 s", -world.pose(ball).position.y, 14.436, 1e-2, 5e-4));
  run(world, 30.0);
  EXPECT_TRUE(relative_row("A-06 terminal speed", -double(world.linear_velocity(ball).y), 19.62, 1e-2, 5e-4));
}

TEST(Damping, IsExactlyExponentialAtAnyStep) {
  for (const float step : {1.0f / 240.0f, 1.0f / 60.0f, 0.25f}) {
    World world = weightless();
    const BodyId body = world.add_body({.linear_velocity = {10, 0, 0},
                                        .angular_velocity = {0, 3, 0},
                                        .linear_damping = 2.0f,
                                        .angular_damping = 0.7f},
                                       {.geometry = Sphere{}});
    run(world, 1.0, step);
    EXPECT_NEAR(double(world.linear_velocity(body).x), 10.0 * std::exp(-2.0), 2e-5) << step;
    EXPECT_NEAR(double(world.angular_velocity(body).y), 3.0 * std::exp(-0.7), 2e-5) << step;
  }
}

TEST(Forces, AddUpLikeVectors) {
  World world = weightless();
  const BodyId body = world.add_body({.pose = {.position = {5, 6, 7}}, .mass = 2.0f}, {.geometry = Box{}});
  for (int i = 0; i < 60; ++i) {
    world.add_force(body, {4, 0, 0});
    world.add_force(body, {0, -2, 0});
    world.add_force(body, {-1, 0, 6});
    world.step(kStep);
  }
  const Vec3 v = world.linear_velocity(body);
  EXPECT_NEAR(double(v.x), 1.5, 1e-5);
  EXPECT_NEAR(double(v.y), -1.0, 1e-5);
  EXPECT_NEAR(double(v.z), 3.0, 4e-5);  // 480 roundings of a float near 3
  world.step(kStep);
  EXPECT_EQ(world.linear_velocity(body), v) << "forces act for one step only";
}

TEST(Forces, AtAPointTurnTheBodyToo) {
  World world = weightless();
  const BodyId body = world.add_body({.pose = {.position = {5, 6, 7}}, .mass = 2.0f}, {.geometry = Box{}});
  // I of a unit cube of 2 kg is 1/3. A couple of 3 N at +-0.5 m gives 3 N m and no net force.
  world.add_force_at(body, {0, 3, 0}, {5.5, 6, 7});
  world.add_force_at(body, {0, -3, 0}, {4.5, 6, 7});
  world.step(kStep);
  EXPECT_NEAR(double(length(world.linear_velocity(body))), 0.0, 1e-7);
  EXPECT_NEAR(double(world.angular_velocity(body).z), 9.0 / 60.0, 1e-6);
  world.set_velocity(body, {}, {});
  world.add_torque(body, {0, 1, 0});
  world.step(kStep);
  EXPECT_NEAR(double(world.angular_velocity(body).y), 3.0 / 60.0, 1e-6);
}

TEST(Impulses, AtAPointChangeMomentumAndItsMoment) {
  World world = weightless();
  const BodyId body = world.add_body(
      {.mass = 2.0f, .center_of_mass = Vec3{0.25f, 0, 0}, .inertia = Sym3{1, 2, 2.5f, 0, 0, 0}},
      {.geometry = Box{}});
  world.add_impulse_at(body, {1, 2, 3}, {0.5, 0.5, -0.5});
  const Momentum m = world.momentum();
  EXPECT_NEAR(m.linear.x, 1.0, 1e-6);
  EXPECT_NEAR(m.linear.y, 2.0, 1e-6);
  EXPECT_NEAR(m.linear.z, 3.0, 1e-6);
  const DVec3 moment = cross(DVec3{0.5, 0.5, -0.5}, DVec3{1, 2, 3});
  EXPECT_NEAR(m.angular.x, moment.x, 1e-5);
  EXPECT_NEAR(m.angular.y, moment.y, 1e-5);
  EXPECT_NEAR(m.angular.z, moment.z, 1e-5);
}

TEST(GravityScale, ScalesGravityAlone) {
  World world = make_world();
  const BodyId up = world.add_body({.gravity_scale = -0.5f}, {.geometry = Sphere{}});
  const BodyId none =
      world.add_body({.pose = {.position = {5, 0, 0}}, .gravity_scale = 0.0f}, {.geometry = Sphere{}});
  run(world, 1.0);
  EXPECT_NEAR(double(world.linear_velocity(up).y), 0.5 * kGravity, 1e-4);
  EXPECT_EQ(world.linear_velocity(none), (Vec3{}));
  world.set_gravity_scale(none, 2.0f);
  run(world, 1.0);
  EXPECT_NEAR(double(world.linear_velocity(none).y), -2.0 * kGravity, 2e-4);
}

TEST(LockedAxes, AreExact) {
  World world = make_world();
  add_ground(world);
  const BodyId slider =
      world.add_body({.pose = {.position = {0, 3, 0}},
                      .linear_velocity = {1, 2, 3},
                      .angular_velocity = {1, 2, 3},
                      .locked = {.linear = {true, false, true}, .angular = {true, true, true}}},
                     {.geometry = Box{}});
  // Something to be pushed by: it falls upon the locked body off its centre.
  world.add_body({.pose = {.position = {0.4, 6, 0.3}}}, {.geometry = Sphere{}});
  for (int i = 0; i < 300; ++i) {
    world.step(kStep);
    const Pose p = world.pose(slider);
    ASSERT_EQ(p.position.x, 0.0) << i;
    ASSERT_EQ(p.position.z, 0.0) << i;
    ASSERT_EQ(p.orientation, Quat{}) << i;
  }
  EXPECT_NEAR(world.pose(slider).position.y, 0.5, 0.01);
}

TEST(LockedAxes, OneTurnAxisStaysFreeUnderLoad) {
  World world = weightless();
  const BodyId body =
      world.add_body({.locked = {.linear = {true, true, true}, .angular = {true, false, true}}},
                     {.geometry = Box{.half_extents = {1, 0.5f, 0.25f}}});
  const float i_y = world.mass_properties(body).inertia.yy;
  for (int i = 0; i < 60; ++i) {
    world.add_torque(body, {1000, 500, 2000});
    world.add_force(body, {1e4f, 1e4f, 1e4f});
    world.step(kStep);
  }
  EXPECT_EQ(world.pose(body).position, (DVec3{}));
  EXPECT_NEAR(double(world.angular_velocity(body).y), 500.0 / double(i_y), 1e-3 * 500.0 / double(i_y));
  EXPECT_EQ(world.angular_velocity(body).x, 0.0f);
  EXPECT_EQ(world.angular_velocity(body).z, 0.0f);
}

TEST(Kinematic, PushesAndIsNotPushed) {
  World world = make_world();
  add_ground(world, surface(0.0f));
  const BodyId pusher = world.add_body(
      {.type = BodyType::kinematic, .pose = {.position = {0, 0.5, 0}}, .linear_velocity = {2, 0, 0}},
      {.geometry = Box{}, .material = surface(0.0f)});
  const BodyId box = world.add_body({.pose = {.position = {2, 0.5, 0}}},
                                    {.geometry = Box{}, .density = 1e5f, .material = surface(0.0f)});
  run(world, 3.0);
  EXPECT_NEAR(world.pose(pusher).position.x, 6.0, 1e-4);
  EXPECT_NEAR(double(world.linear_velocity(box).x), 2.0, 0.02);
  EXPECT_NEAR(world.pose(box).position.x, 7.0, 0.02);
  EXPECT_NEAR(world.pose(box).position.y, 0.5, 0.01);
}

TEST(Kinematic, MovesWhereItIsTold) {
  World world = make_world();
  const BodyId lift =
      world.add_body({.type = BodyType::kinematic}, {.geometry = Box{.half_extents = {2, 0.25f, 2}}});
  const BodyId rider = world.add_body({.pose = {.position = {0, 0.75, 0}}}, {.geometry = Box{}});
  run(world, 1.0);
  for (int i = 1; i <= 120; ++i) {
    const Pose target{{0, 0.01 * i, 0}, from_axis_angle({0, 1, 0}, 0.01f * float(i))};
    ASSERT_TRUE(world.move_kinematic(lift, target, kStep));
    world.step(kStep);
    const Pose p = world.pose(lift);
    ASSERT_NEAR(p.position.y, target.position.y, 1e-5) << i;
    ASSERT_GT(std::fabs(dot(p.orientation, target.orientation)), 1.0f - 1e-6f) << i;
  }
  EXPECT_NEAR(world.pose(rider).position.y, 1.2 + 0.75, 0.01);
  const DVec3 arm = turned(world.pose(rider).orientation, {1, 0, 0});
  EXPECT_NEAR(std::atan2(-arm.z, arm.x), 1.2, 0.05) << "friction turns the rider with the lift";
}

}  // namespace
}  // namespace gyre::laws::free_flight_test
