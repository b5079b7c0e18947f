// Floating bodies: Archimedes' draught, which way up they float, how they swing, and that no body is too light or too heavy.
//
// Sub-steps of h = 1/480 s swing with tan(W h / 2) = w h / 2 (docs/fields.md), so periods are off by (w h)^2 / 12 of themselves, below
// 1e-4 for everything here; draughts are off by rounding alone, once drag has taken the motion away.
#include "laws/kit.h"

namespace gyre::laws::buoyancy_test {
namespace {

constexpr double kWater = 1000.0;

FieldDef water(float linear_drag = 0.0f, float drag_coefficient = 0.0f) {
  return {.kind = FieldKind::buoyancy,
          .density = float(kWater),
          .drag_coefficient = drag_coefficient,
          .linear_drag = linear_drag};
}

BodyId add_floater(World& world, const AnyShape& shape, float density, DVec3 place, Quat turn = {}) {
  BodyDef def;
  def.pose = {place, turn};
  return world.add_body(def, {.geometry = shape, .density = density});
}

Vec3 up_of(const World& world, BodyId body) {
  return rotate_inverse(world.pose(body).orientation, {0, 1, 0});
}

TEST(Buoyancy, BoxFindsArchimedesDraught) {
  const Vec3 half{1.0f, 0.25f, 1.5f};
  for (const float density : {50.0f, 250.0f, 500.0f, 750.0f, 950.0f}) {
    World world = make_world({.sleeping = false});
    world.add_field(water(1500.0f / density));  // of the share that is in the water, whatever that is
    // Tilted, and dropped from above: it must find its way.
    const BodyId box = add_floater(world, Box{half}, density, {0, 0.4, 0}, from_axis_angle({0, 0, 1}, 0.35f));
    run(world, 60.0);
    const double draught = 2.0 * 0.25 * double(density) / kWater;
    const double measured = 0.25 - world.pose(box).position.y;
    EXPECT_TRUE(relative_row("draught of a box", measured, draught, 1.0e-2, 1.0e-4)) << density;
    EXPECT_LT(std::fabs(measured - draught), 1.0e-4 * draught + 2.0e-6) << density;
    EXPECT_TRUE(row("  its deck is level", double(up_of(world, box).y), 1.0, 1.0e-5, 1.0e-7));
  }
}

// What floats still sleeps, near enough to its place; and wakes when the water changes.
TEST(Buoyancy, WhatFloatsStillSleeps) {
  World world = make_world();
  const FieldId field = world.add_field(water(3.0f, 1.0f));
  const BodyId box =
      add_floater(world, Box{{1.0f, 0.25f, 1.5f}}, 400.0f, {0, 0.3, 0}, from_axis_angle({0, 0, 1}, 0.2f));
  for (int i = 0; i < 30 * 60 && world.is_awake(box); ++i) world.step(kStep);
  EXPECT_FALSE(world.is_awake(box));
  EXPECT_TRUE(
      relative_row("draught of a box that sleeps", 0.25 - world.pose(box).position.y, 0.2, 1.0e-2, 1.0e-3));
  FieldDef higher = world.field(field);
  higher.offset = 1.0;
  world.set_field(field, higher);
  EXPECT_TRUE(world.is_awake(box));
  run(world, 10.0);
  EXPECT_NEAR(world.pose(box).position.y, 1.05, 0.01);
}

// Deeper than all of it: it stays where it is if as heavy as water, sinks or rises otherwise, by the difference of weights.
TEST(Buoyancy, SubmergedBodyFeelsTheDifferenceOfWeights) {
  for (const float density : {500.0f, 1000.0f, 2000.0f}) {
    World world = make_world();
    world.add_field(water());
    const BodyId ball = add_floater(world, Sphere{0.2f}, density, {0, -50, 0});
    run(world, 1.0);
    const double expected = kGravity * (kWater / double(density) - 1.0);
    EXPECT_TRUE(row("speed after a second under water", double(world.linear_velocity(ball).y), expected,
                    1.0e-4, 1.0e-5));
  }
}

// Sphere and lying cylinder of half the density of water float at their middles; others at the depth that displaces their mass.
TEST(Buoyancy, RoundShapesFindTheirDraught) {
  const auto settle = [](const AnyShape& shape, float density, Quat turn) {
    World world = make_world({.sleeping = false});
    world.add_field(water(4.0f));
    const BodyId body = add_floater(world, shape, density, {0, 0.1, 0}, turn);
    run(world, 40.0);
    return world.pose(body).position.y;
  };
  // A ball with its middle y above the water displaces pi/3 (r - y)^2 (2 r + y).
  const double y = settle(Sphere{0.5f}, 300.0f, {});
  const double displaced = kPiDouble / 3 * (0.5 - y) * (0.5 - y) * (1.0 + y);
  EXPECT_TRUE(relative_row("mass displaced by a ball", displaced, 0.3 * 4.0 / 3.0 * kPiDouble * 0.125, 1.0e-2,
                           1.0e-4));
  // A lying cylinder: a segment of its circle.
  const double z = settle(Cylinder{0.5f, 1.5f}, 700.0f, from_axis_angle({1, 0, 0}, kPi / 2));
  const double segment = 0.25 * std::acos(z / 0.5) - z * std::sqrt(0.25 - z * z);
  EXPECT_TRUE(
      relative_row("mass displaced by a lying cylinder", segment, 0.7 * kPiDouble * 0.25, 1.0e-2, 1.0e-4));
  EXPECT_TRUE(
      row("middle of a ball of half the density", settle(Sphere{0.5f}, 500.0f, {}), 0.0, 1.0e-4, 1.0e-6));
}

// A log of square section floats flat below 21.13 % of water's density and above 78.87 %, and on an edge at half of it.
// The bounds: s (1 - s) = 1/6, where the metacentre lies in the centre of mass. (E. N. Gilbert, "How Things Float", 1991.)
TEST(Buoyancy, SquareLogsFloatFlatOrOnEdge) {
  const auto settle = [](float share) {
    World world = make_world({.sleeping = false});
    world.add_field(water(1.0f));
    const BodyId box = add_floater(world, Box{{0.25f, 0.25f, 2.0f}}, share * float(kWater), {0, 0, 0},
                                   from_axis_angle({0, 0, 1}, 0.03f));
    run(world, 90.0);
    const Vec3 up = up_of(world, box);
    return double(std::max(std::fabs(up.x), std::fabs(up.y)));
  };
  EXPECT_TRUE(row("log of 0.19: flat", settle(0.19f), 1.0, 1.0e-3, 1.0e-5));
  EXPECT_TRUE(row("log of 0.81: flat", settle(0.81f), 1.0, 1.0e-3, 1.0e-5));
  EXPECT_TRUE(row("log of 0.5: on an edge", settle(0.5f), std::sqrt(0.5), 1.0e-3, 1.0e-5));
  EXPECT_LT(settle(0.24f), 0.999) << "just past the bound it leans";
  EXPECT_LT(settle(0.76f), 0.999);
}

TEST(Buoyancy, TallBoxTipsWideOneStands) {
  const auto settle = [](Vec3 half) {
    World world = make_world({.sleeping = false});
    world.add_field(water(1.0f));
    const BodyId box = add_floater(world, Box{half}, 500.0f, {0, 0, 0}, from_axis_angle({0, 0, 1}, 0.02f));
    run(world, 40.0);
    return std::fabs(double(up_of(world, box).y));
  };
  EXPECT_TRUE(row("wide box stands", settle({0.8f, 0.3f, 0.8f}), 1.0, 1.0e-4, 1.0e-6));
  EXPECT_TRUE(row("tall box lies", settle({0.3f, 1.0f, 0.4f}), 0.0, 1.0e-3, 1.0e-5));
}

struct Swing {
  double period, first, last;  // s; amplitude of the first and of the last swing
};
template <class Read>
Swing swing(World& world, double seconds, Read read) {
  ZeroCrossings crossings;
  double first = 0, last = 0;
  const int steps = int(seconds * 60.0);
  for (int i = 0; i < steps; ++i) {
    world.step(kStep);
    const double value = read();
    crossings.add((i + 1) / 60.0, value);
    if (i < steps / 10) first = std::fmax(first, std::fabs(value));
    if (i >= steps - steps / 10) last = std::fmax(last, std::fabs(value));
  }
  return {crossings.mean_period(), first, last};
}

// Up and down: m y'' = -rho g A y, and nothing is lost or gained in a minute.
TEST(Buoyancy, HeaveHasItsPeriodAndKeepsItsAmplitude) {
  World world = make_world({.sleeping = false});
  world.add_field(water());
  const BodyId box = add_floater(world, Box{{1.0f, 0.5f, 1.0f}}, 400.0f, {0, 0.2, 0});
  const double rest = 0.5 - 1.0 * 0.4;
  const Swing s = swing(world, 60.0, [&] { return world.pose(box).position.y - rest; });
  const double period = 2 * kPiDouble * std::sqrt(400.0 * 1.0 / (kWater * kGravity));
  EXPECT_TRUE(relative_row("period of heave", s.period, period, 1.0e-3, 1.0e-4));
  EXPECT_TRUE(relative_row("amplitude after a minute", s.last, s.first, 1.0e-2, 1.0e-3));
}

// Rolling by little: I a'' = -rho g V GM a with GM = I_cut / V - BG, about an axis through the centre of mass.
TEST(Buoyancy, RollHasItsPeriod) {
  World world = make_world({.sleeping = false});
  world.add_field(water());
  const double wide = 2.0, high = 0.6, s = 0.5;
  BodyDef def;
  def.pose = {{0, high * (0.5 - s), 0}, from_axis_angle({0, 0, 1}, 0.01f)};
  def.locked.linear[0] = true;
  const BodyId box = world.add_body(def, {.geometry = Box{{1.0f, 0.3f, 2.0f}}, .density = float(s * kWater)});
  const double draught = s * high, metacentric = wide * wide / (12 * draught) - 0.5 * (high - draught);
  const double inertia = (wide * wide + high * high) / 12;  // over the mass
  const double period = 2 * kPiDouble * std::sqrt(inertia / (kGravity * metacentric));
  const Swing roll = swing(world, 60.0, [&] { return double(up_of(world, box).x); });
  EXPECT_TRUE(relative_row("period of roll", roll.period, period, 2.0e-3, 2.0e-4));
  EXPECT_TRUE(relative_row("amplitude after a minute", roll.last, roll.first, 2.0e-2, 2.0e-3));
}

// Bodies that hardly weigh anything, under water, at the surface and dropped onto it: without any drag none may get higher than
// it began, nor than its work under water lets it. A sheet of a tenth of a millimetre and a thousandth of water's density swings with
// w = 10^4 / s on its own cut: 20 times what a sub-step would bear without the scheme's larger mass.
TEST(Buoyancy, NoBodyIsTooLight) {
  for (const int substeps : {1, 4}) {
    for (const float density : {1.0f, 10.0f, 100.0f}) {
      for (const AnyShape& shape : {AnyShape(Box{{0.5f, 0.00005f, 0.5f}}), AnyShape(Sphere{0.02f}),
                                    AnyShape(Box{{0.3f, 0.3f, 0.3f}})}) {
        World world = make_world({.stepping = {.substeps = substeps}, .sleeping = false});
        world.add_field(water());
        const BodyId body = add_floater(world, shape, density, {0, 0.5, 0});
        double highest = 0;
        for (int i = 0; i < 1800; ++i) {
          world.step(kStep);
          highest = std::max(highest, world.pose(body).position.y);
        }
        EXPECT_TRUE(is_finite(world.pose(body).position));
        // Without drag it flies again and again; forces that change along the way within a sub-step cost or give some of it.
        EXPECT_LT(highest, 0.5 * 1.25)
            << "density " << density << " sub-steps " << substeps << " kind " << shape.index();
      }
    }
  }
}

// Whatever the drag, velocities go towards the stream's and not beyond.
TEST(Buoyancy, NoDragIsTooStrong) {
  for (const float drag : {1.0f, 1.0e3f, 1.0e6f}) {
    World world = make_world({.sleeping = false});
    FieldDef def = water(drag, drag);
    def.velocity = {1.5f, 0, 0};
    world.add_field(def);
    const BodyId box = add_floater(world, Box{{0.2f, 0.2f, 0.2f}}, 200.0f, {0, -0.1, 0});
    world.set_velocity(box, {-30, 2, 5}, {20, -10, 30});
    double fastest = 0;
    for (int i = 0; i < 600; ++i) {
      world.step(kStep);
      fastest = std::fmax(fastest, double(world.linear_velocity(box).x));
    }
    EXPECT_LE(fastest, 1.5 * (1 + 1e-5)) << drag;
    EXPECT_NEAR(double(world.linear_velocity(box).x), 1.5, 0.02) << drag;
    EXPECT_LT(double(length(world.angular_velocity(box))), drag > 1.0f ? 0.01 : 1.0) << drag;
  }
}

// Hulls and compounds float as what they are: a hull with the corners of a box as that box, two half boxes as the whole.
TEST(Buoyancy, TheSameBodyInPartsOrAsAHullFloatsAlike) {
  const auto height = [](std::vector<ShapeDef> shapes) {
    World world = make_world({.sleeping = false});
    world.add_field(water(0.5f, 1.0f));
    BodyDef def;
    def.pose = {{0, 0.3, 0}, from_axis_angle(normalized(Vec3{1, 0, 1}), 0.2f)};
    const BodyId body = world.add_body(def, shapes);
    run(world, 3.0);
    return world.pose(body);
  };
  std::vector<Vec3> corners;
  for (int i = 0; i < 8; ++i)
    corners.push_back({(i & 1) ? 0.8f : -0.8f, (i & 2) ? 0.3f : -0.3f, (i & 4) ? 0.5f : -0.5f});
  const Pose box = height({{.geometry = Box{{0.8f, 0.3f, 0.5f}}, .density = 600}});
  const Pose hull = height({{.geometry = *cook_hull(corners), .density = 600}});
  const Pose halves =
      height({{.geometry = Box{{0.4f, 0.3f, 0.5f}}, .local = {{-0.4f, 0, 0}, {}}, .density = 600},
              {.geometry = Box{{0.4f, 0.3f, 0.5f}}, .local = {{0.4f, 0, 0}, {}}, .density = 600}});
  EXPECT_NEAR(box.position.y, hull.position.y, 1e-4);
  EXPECT_NEAR(std::fabs(dot(box.orientation, hull.orientation)), 1.0, 1e-6);
  // The inner faces of the halves face the stream too, which changes their drag, not their lift.
  EXPECT_NEAR(box.position.y, halves.position.y, 2e-2);
}

}  // namespace
}  // namespace gyre::laws::buoyancy_test
