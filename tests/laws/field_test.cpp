// Streams and pulls against closed forms, explosions against what they give away.
#include "laws/kit.h"

#include <complex>
#include <numeric>

namespace gyre::laws::field_test {
namespace {

BodyId add_ball(World& world, float radius, float density, DVec3 place, Vec3 velocity = {}) {
  BodyDef def;
  def.pose.position = place;
  def.linear_velocity = velocity;
  return world.add_body(def, {.geometry = Sphere{radius}, .density = density});
}

// v' = g - c v.
TEST(Fields, LinearDragHasItsTerminalSpeed) {
  World world = make_world();
  world.add_field({.kind = FieldKind::drag, .density = 0.0f, .linear_drag = 0.5f});
  const BodyId ball = add_ball(world, 0.1f, 1000, {0, 0, 0});
  run(world, 2.0);
  EXPECT_TRUE(relative_row("A-06 v(2 s), drag 0.5/s", -double(world.linear_velocity(ball).y), 12.402, 1.0e-2,
                           5.0e-4));
  EXPECT_TRUE(relative_row("A-06 fall in 2 s", -world.pose(ball).position.y, 14.436, 1.0e-2, 5.0e-4));
  run(world, 40.0);
  EXPECT_TRUE(
      relative_row("A-06 terminal speed", -double(world.linear_velocity(ball).y), 19.62, 1.0e-4, 1.0e-6));
}

// m v' = m g - 1/2 rho C A v^2: v = u tanh(g t / u).
TEST(Fields, QuadraticDragHasItsTerminalSpeed) {
  struct Case {
    const char* name;
    AnyShape shape;
    double area;
    Quat turn;
  };
  const Case cases[] = {{"ball", Sphere{0.2f}, kPiDouble * 0.04, {}},
                        {"box", Box{{0.2f, 0.1f, 0.3f}}, 4 * 0.2 * 0.3, {}},
                        {"standing cylinder", Cylinder{0.2f, 0.5f}, kPiDouble * 0.04, {}},
                        {"lying capsule", Capsule{0.1f, 0.3f}, kPiDouble * 0.01 + 4 * 0.1 * 0.3,
                         from_axis_angle({1, 0, 0}, kPi / 2)},
                        {"cone, apex up", Cone{0.3f, 0.2f}, kPiDouble * 0.09, {}}};
  for (const Case& c : cases) {
    World world = make_world();
    world.add_field({.kind = FieldKind::drag, .density = 1.2f, .drag_coefficient = 0.8f});
    BodyDef def;
    def.pose.orientation = c.turn;
    for (bool& locked : def.locked.angular) locked = true;  // a body that tumbles has another area
    const BodyId body = world.add_body(def, {.geometry = c.shape, .density = 60});
    const double mass = double(world.mass_properties(body).mass);
    const double u = std::sqrt(2 * mass * kGravity / (1.2 * 0.8 * c.area));
    run(world, 0.5 * u / kGravity);
    const double t = world.time();
    EXPECT_TRUE(relative_row((std::string("falling ") + c.name).c_str(),
                             -double(world.linear_velocity(body).y), u * std::tanh(kGravity * t / u), 1.0e-2,
                             1.0e-3));
    run(world, 12 * u / kGravity);
    EXPECT_TRUE(
        relative_row("  its terminal speed", -double(world.linear_velocity(body).y), u, 1.0e-3, 1.0e-5));
  }
}

// A plate of sides a and b that turns about the middle line along b: each half of its sides pushes with 1/2 rho C (w x)^2, so
// I w' = -k w^2 with k = rho C b a^4 / 64.
TEST(Fields, APlateThatTurnsIsSlowed) {
  World world = weightless();
  world.add_field({.kind = FieldKind::drag, .density = 1.2f, .drag_coefficient = 1.0f});
  const double a = 2.0, b = 3.0;
  BodyDef def;
  def.angular_velocity = {0, 0, 5};
  const BodyId plate =
      world.add_body(def, {.geometry = Box{{float(a / 2), 0.001f, float(b / 2)}}, .density = 500});
  const double inertia = double(world.mass_properties(plate).inertia.zz);
  const double k = 1.2 * b * a * a * a * a / 64 / inertia;
  run(world, 2.0);
  EXPECT_TRUE(relative_row("spin of a plate after 2 s", double(world.angular_velocity(plate).z),
                           5.0 / (1 + k * 5.0 * 2.0), 3.0e-2, 1.0e-2));
}

TEST(Fields, WindCarriesAndNeverOvertakes) {
  World world = weightless();
  world.add_field({.velocity = {20, 0, 0}, .drag_coefficient = 0.5f});
  const BodyId has_extreme_mass_ratio = add_ball(world, 0.5f, 0.05f, {0, 0, 0}),
               heavy = add_ball(world, 0.5f, 2000.0f, {0, 5, 0});
  double fastest = 0;
  for (int i = 0; i < 600; ++i) {
    world.step(kStep);
    fastest = std::fmax(fastest, double(world.linear_velocity(has_extreme_mass_ratio).x));
  }
  EXPECT_LE(fastest, 20.0 * (1 + 1e-6));
  EXPECT_GT(fastest, 19.5);
  // v = w - w / (1 + k w t) for the heavy one.
  const double k = 0.5 * 1.2 * 0.5 * kPiDouble * 0.25 / (2000.0 * 4.0 / 3.0 * kPiDouble * 0.125);
  const double expected = 20.0 * (1 - 1 / (1 + k * 20.0 * 10.0));
  EXPECT_TRUE(relative_row("heavy ball in the wind", double(world.linear_velocity(heavy).x), expected, 1.0e-2,
                           1.0e-3));
}

// A body that follows the air at once shows the gusts: their mean and root mean square.
TEST(Fields, GustsHaveTheirMeanAndTheirSize) {
  World world = weightless();
  world.add_field({.velocity = {10, 0, 0},
                   .density = 0.0f,
                   .linear_drag = 1.0e5f,
                   .turbulence = 0.2f,
                   .turbulence_length = 5.0f});
  BodyDef def;
  def.type = BodyType::dynamic;
  double square = 0;
  DVec3 mean;
  int count = 0;
  // At many places at once: the ball is set back to the next one each step.
  const BodyId ball = add_ball(world, 0.1f, 1000, {0, 0, 0});
  for (int i = 0; i < 4000; ++i) {
    world.set_pose(
        ball, {{std::fmod(i * 7.31, 200.0), std::fmod(i * 3.77, 150.0), std::fmod(i * 5.19, 170.0)}, {}});
    world.step(kStep);
    const DVec3 gust = DVec3(world.linear_velocity(ball)) - DVec3{10, 0, 0};
    mean += gust;
    square += dot(gust, gust);
    ++count;
  }
  EXPECT_TRUE(row("mean of gusts", length(mean) / count, 0.0, 0.15, 0.05));
  // Sines sampled thousands of times: their squares' mean is a half within a few percent.
  EXPECT_TRUE(relative_row("root mean square of gusts", std::sqrt(square / count), 2.0, 5.0e-2, 1.0e-2));
}

// A mass point goes round another: period 2 pi sqrt(r^3 / k), and on an ellipse neither energy nor angular momentum drift.
TEST(Fields, RadialPullHasKeplersOrbits) {
  World world = weightless();
  const double k = 4.0 * 25.0;  // strength times radius squared
  world.add_field({.kind = FieldKind::radial, .strength = 4.0f, .radius = 5.0f, .falloff = 2.0f});
  const double r = 5.0, v = std::sqrt(k / r);
  const BodyId round = add_ball(world, 0.1f, 1000, {r, 0, 0}, {0, 0, float(v)});
  const BodyId ellipse = add_ball(world, 0.1f, 700, {0, 8, 0}, {1.8f, 0, 0});
  const auto energy = [&](BodyId body) {
    const DVec3 w = wide(world.linear_velocity(body));
    return 0.5 * dot(w, w) - k / length(world.pose(body).position);
  };
  const auto spin = [&](BodyId body) {
    return length(cross(world.pose(body).position, wide(world.linear_velocity(body))));
  };
  const double e0 = energy(ellipse), l0 = spin(ellipse);
  Unwrapped angle;
  double worst = 0, worst_spin = 0, late = 0;
  for (int i = 0; i < 60 * 60; ++i) {
    world.step(kStep);
    angle.add(std::atan2(world.pose(round).position.z, world.pose(round).position.x));
    const double error = std::fabs(energy(ellipse) / e0 - 1);
    (i < 1800 ? worst : late) = std::fmax(i < 1800 ? worst : late, error);
    worst_spin = std::fmax(worst_spin, std::fabs(spin(ellipse) / l0 - 1));
  }
  EXPECT_TRUE(
      relative_row("angle of a circular orbit in 60 s", angle.turned(), 60.0 * v / r, 1.0e-3, 1.0e-4));
  EXPECT_TRUE(limit_row("energy of an elliptic orbit, first half minute", worst, 3.0e-2, 3.0e-3));
  EXPECT_TRUE(limit_row("  second half minute: no drift", late, 1.1 * worst, worst));
  EXPECT_TRUE(limit_row("  its angular momentum", worst_spin, 1.0e-4, 1.0e-5));
}

// falloff -1 is a spring: every orbit is an ellipse about the middle with one period. At 10^6 / s^2 it still holds.
TEST(Fields, ARadialPullThatGrowsIsASpring) {
  World world = weightless();
  world.add_field({.kind = FieldKind::radial, .strength = 9.0f, .radius = 1.0f, .falloff = -1.0f});
  const BodyId ball = add_ball(world, 0.1f, 1000, {2, 0, 0}, {0, 1, 0});
  ZeroCrossings crossings;
  for (int i = 0; i < 3600; ++i) {
    world.step(kStep);
    crossings.add(world.time(), world.pose(ball).position.x);
  }
  EXPECT_TRUE(
      relative_row("period in a spring's field", crossings.mean_period(), 2 * kPiDouble / 3, 1.0e-3, 1.0e-4));
  World stiff = weightless();
  stiff.add_field({.kind = FieldKind::radial, .strength = 1.0e6f, .radius = 1.0f, .falloff = -1.0f});
  const BodyId held = add_ball(stiff, 0.1f, 1000, {1, 0, 0});
  double farthest = 0;
  for (int i = 0; i < 3600; ++i) {
    stiff.step(kStep);
    farthest = std::fmax(farthest, length(stiff.pose(held).position));
  }
  // Symplectic: its amplitude is off by as much as the step is long against the swing, and does not grow.
  EXPECT_LE(farthest, 1.3);
}

// In the core of a vortex z'' = c (i W z - z'), z = x + i y across the axis: both roots of s^2 + c s - i c W = 0. And the body
// comes to turn with the medium.
TEST(Fields, VortexSpiralsAsItsEquationSays) {
  World world = weightless();
  const double rate = 2.0, c = 1.5;
  world.add_field({.kind = FieldKind::vortex,
                   .density = 0.0f,
                   .linear_drag = float(c),
                   .strength = float(rate * 10),
                   .radius = 10.0f,
                   .axis = {0, 0, 3}});
  const BodyId ball = add_ball(world, 0.1f, 1000, {1, 0, 0});
  run(world, 3.0);
  using Complex = std::complex<double>;
  const Complex root = std::sqrt(Complex(c * c, 4 * c * rate));
  const Complex s1 = 0.5 * (-c + root), s2 = 0.5 * (-c - root);
  const Complex z = (s1 * std::exp(s2 * 3.0) - s2 * std::exp(s1 * 3.0)) / (s1 - s2);
  const DVec3 p = world.pose(ball).position;
  EXPECT_TRUE(row("vortex: x after 3 s", p.x, z.real(), 1.0e-2 * std::abs(z), 1.0e-3));
  EXPECT_TRUE(row("vortex: y after 3 s", p.y, z.imag(), 1.0e-2 * std::abs(z), 1.0e-3));
  EXPECT_TRUE(relative_row("  its spin", double(world.angular_velocity(ball).z),
                           rate * (1 - std::exp(-c * 3.0)), 1.0e-2, 2.0e-3));
  // Outside the core the speed falls with the distance.
  World outside = weightless();
  outside.add_field(
      {.kind = FieldKind::vortex, .density = 0.0f, .linear_drag = 1.0e5f, .strength = 6.0f, .radius = 2.0f});
  const BodyId leaf = add_ball(outside, 0.1f, 1000, {8, 0, 0});
  outside.step(1.0f / 600.0f);
  EXPECT_TRUE(relative_row("speed at four radii", double(length(outside.linear_velocity(leaf))), 1.5, 1.0e-3,
                           1.0e-4));
  EXPECT_LT(outside.linear_velocity(leaf).z, 0.0f) << "counter-clockwise seen against y: from x towards -z";
}

TEST(Fields, BoundsAndLayersSayWhom) {
  World world = weightless();
  const FieldId field = world.add_field({.bounds = FieldBounds{{-1, -1, -1}, {1, 1, 1}},
                                         .layers = 2,
                                         .velocity = {10, 0, 0},
                                         .linear_drag = 1});
  const auto ball = [&](std::uint32_t layer, DVec3 place) {
    BodyDef def;
    def.pose.position = place;
    return world.add_body(def, {.geometry = Sphere{0.1f}, .filter = {.layer = layer}});
  };
  const BodyId in = ball(2, {0, 0, 0}), other_layer = ball(1, {0, 0.5, 0}), out = ball(2, {0, 2, 0});
  world.step(kStep);
  EXPECT_GT(world.linear_velocity(in).x, 0.1f);
  EXPECT_EQ(world.linear_velocity(other_layer), Vec3{});
  EXPECT_EQ(world.linear_velocity(out), Vec3{});
  FieldDef def = world.field(field);
  EXPECT_EQ(def.layers, 2u);
  def.velocity = {-10, 0, 0};
  def.bounds.reset();
  EXPECT_TRUE(world.set_field(field, def));
  world.step(kStep);
  EXPECT_LT(world.linear_velocity(out).x, 0.0f);
  EXPECT_TRUE(world.remove_field(field));
  EXPECT_FALSE(world.exists(field));
  const Vec3 kept = world.linear_velocity(in);
  world.step(kStep);
  EXPECT_EQ(world.linear_velocity(in), kept);
  EXPECT_FALSE(world.set_field(field, def));
  EXPECT_FALSE(bool(world.add_field({.turbulence = -1})));
  ASSERT_FALSE(world.problems().empty());
  EXPECT_NE(std::string(world.problems().back().message).find("field.turbulence is -1"), std::string::npos);
  const FieldId next = world.add_field({});
  EXPECT_EQ(next.index, field.index);
  EXPECT_FALSE(next == field);
}

// Wind against a box that friction holds, and against one that it does not: the push is 1/2 rho C A w^2 as on an open body.
TEST(Fields, WindPushesWhatLiesOnTheGround) {
  for (const float speed : {20.0f, 60.0f}) {
    World world = make_world();
    add_ground(world, surface(0.5f));
    world.add_field({.velocity = {speed, 0, 0}, .drag_coefficient = 1.0f});
    BodyDef def;
    def.pose.position = {0, 0.5, 0};
    const BodyId box = world.add_body(def, {.geometry = Box{}, .density = 200, .material = surface(0.5f)});
    run(world, 2.0);
    const bool holds = 0.5 * 1.2 * double(speed * speed) < 0.5 * 200 * kGravity;
    EXPECT_EQ(world.pose(box).position.x < 0.01, holds) << speed;
  }
}

// ------------------------------------------------------------------------------------------------------------ explosions

TEST(Explosion, AFarBallGetsThePressureOnItsShadow) {
  World world = weightless();
  const BodyId near = add_ball(world, 0.1f, 1000, {5, 0, 0}), far = add_ball(world, 0.1f, 1000, {0, 10, 0});
  const BodyId beyond = add_ball(world, 0.1f, 1000, {0, 0, 21});
  EXPECT_TRUE(world.explode({.center = {0, 0, 0}, .pressure = 5000, .radius = 20}));
  const double mass = double(world.mass_properties(near).mass), area = kPiDouble * 0.01;
  // A ball is not flat: its front is nearer. That is R / r of the pressure at most.
  EXPECT_TRUE(relative_row("ball at 5 m", double(world.linear_velocity(near).x), 5000 / 25.0 * area / mass,
                           4.0e-2, 2.0e-2));
  EXPECT_TRUE(relative_row("ball at 10 m", double(world.linear_velocity(far).y), 5000 / 100.0 * area / mass,
                           2.0e-2, 1.0e-2));
  EXPECT_EQ(world.linear_velocity(beyond), Vec3{});
  EXPECT_LT(length(world.angular_velocity(near)), 1e-3f);
}

// Bodies all round get as much to one side as to the other; one off the line of its centre is turned.
TEST(Explosion, MomentumCancelsAllRound) {
  World world = weightless();
  for (int i = 0; i < 6; ++i) {
    const double sign = i % 2 == 0 ? 1.0 : -1.0;
    DVec3 place;
    (i / 2 == 0 ? place.x : i / 2 == 1 ? place.y : place.z) = sign * 3.0;
    BodyDef def;
    def.pose.position = place;
    world.add_body(def, {.geometry = Box{{0.3f, 0.3f, 0.3f}}});
  }
  EXPECT_TRUE(world.explode({.pressure = 1000}));
  const Momentum sum = world.momentum();
  EXPECT_GT(world.energy().kinetic, 1.0);
  EXPECT_LT(length(sum.linear), 1e-3);
  EXPECT_LT(length(sum.angular), 1e-3);
  World turned = weightless();
  BodyDef def;
  def.pose.position = {3, 0.8, 0};
  const BodyId plank = turned.add_body(def, {.geometry = Box{{0.05f, 1.0f, 0.2f}}});
  turned.explode({.pressure = 1000});
  EXPECT_GT(turned.angular_velocity(plank).z, 0.01f) << "its near end is pushed more";
}

TEST(Explosion, WallsHide) {
  World world = weightless();
  world.add_body({.type = BodyType::fixed, .pose = {.position = {2, 0, 0}}}, {.geometry = Box{{0.1f, 2, 2}}});
  const BodyId behind = add_ball(world, 0.2f, 1000, {4, 0, 0}),
               open = add_ball(world, 0.2f, 1000, {-4, 0, 0});
  const BodyId half =
      add_ball(world, 0.2f, 1000, {4, 4.2, 0});  // the wall's upper edge hides up to y = 4.0 or so there
  world.explode({.pressure = 1000, .occlusion = true});
  EXPECT_EQ(world.linear_velocity(behind), Vec3{});
  EXPECT_LT(world.linear_velocity(open).x, -0.01f);
  EXPECT_GT(world.linear_velocity(half).y, 0.0f);
  world.explode({.pressure = 1000, .occlusion = false});
  EXPECT_GT(world.linear_velocity(behind).x, 0.01f);
}

}  // namespace
}  // namespace gyre::laws::field_test
