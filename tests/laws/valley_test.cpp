// Balls that roll fast from one flat face of a mesh onto the next, which rises: they strike it where it is, lose what such a strike
// takes, and are braked by no face that they only roll beside.
// Closed form: a plastic strike keeps the angular momentum about the new point of contact, so v' / v = (cos a + k) / (1 + k),
// k = I / (m R^2); after "Dynamics of a System of Rigid Bodies" by E. Routh, part I (impulses).
#include "laws/kit.h"

namespace gyre::laws::valley_test {
namespace {

constexpr double kSolid = 0.4;
double kept_speed(double angle) { return (std::cos(angle) + kSolid) / (1.0 + kSolid); }

// Strips between lines along z through the points of a profile, cut into cells.
Geometry strips(const std::vector<DVec3>& profile, double from, double to, int cells) {
  std::vector<Vec3> vertices;
  std::vector<std::uint32_t> indices;
  for (const DVec3& p : profile) {
    for (int k = 0; k <= cells; ++k)
      vertices.push_back(to_float(p + DVec3{0, 0, from + (to - from) * double(k) / double(cells)}));
  }
  const auto row = std::uint32_t(cells + 1);
  for (std::uint32_t i = 0; i + 1 < profile.size(); ++i) {
    for (std::uint32_t k = 0; k + 1 < row; ++k) {
      const std::uint32_t a = i * row + k, c = a + row;
      for (const std::uint32_t v : {a, a + 1, c, c, a + 1, c + 1}) indices.push_back(v);
    }
  }
  return *cook_mesh({.vertices = vertices, .indices = indices});
}

struct Roll {
  double speed, radius;
  DVec3 start;  // where the ball touches the floor
  DVec3 direction{1, 0, 0};
};
BodyId add_ball(World& world, const Roll& roll) {
  BodyDef def{.pose = {.position = roll.start + DVec3{0, roll.radius, 0}}};
  def.linear_velocity = to_float(roll.speed * roll.direction);
  def.angular_velocity = to_float(roll.speed / roll.radius * cross(DVec3{0, 1, 0}, roll.direction));
  return world.add_body(def, {.geometry = Sphere{float(roll.radius)}, .material = surface(0.8f)});
}

// From a floor onto a slope, at every phase of the step.
struct Strike {
  double sink = 0.0;   // m, the deepest
  double gain = 0.0;   // of energy, relative
  double speed = 0.0;  // mean, of that before
};
Strike roll_onto_slope(double angle, double speed, double radius) {
  const int phases = 20;
  Strike seen;
  for (int phase = 0; phase < phases; ++phase) {
    World world = make_world({.gravity = {0, 0, 0}, .sleeping = false});
    const DVec3 uphill{std::cos(angle), std::sin(angle), 0}, normal{-std::sin(angle), std::cos(angle), 0};
    world.add_body(
        {.type = BodyType::fixed},
        {.geometry = strips({{-4, 0, 0}, {-2, 0, 0}, {0, 0, 0}, 2.0 * uphill, 4.0 * uphill}, -2, 2, 1),
         .material = surface(0.8f)});
    const double offset = speed * double(kStep) * double(phase) / phases;
    const BodyId ball = add_ball(world, {speed, radius, {-0.7 - offset, 0, 0.1}});
    const double before = world.energy().kinetic;
    for (int i = 0; i < int(1.4 / speed / double(kStep)); ++i) {
      world.step(kStep);
      const DVec3 place = world.pose(ball).position;
      seen.sink = std::max({seen.sink, radius - place.y, radius - dot(place, normal)});
      seen.gain = std::max(seen.gain, world.energy().kinetic / before - 1.0);
    }
    seen.speed += std::sqrt(world.energy().kinetic / before) / phases;
  }
  return seen;
}
TEST(Valley, ABallStrikesTheFarSlopeWhereItIs) {
  for (const double degrees : {3.0, 5.0, 10.0, 20.0}) {
    for (const double speed : {2.0, 5.0, 8.0}) {
      for (const double radius : {0.1, 0.25}) {
        say("[row] A-178 %g degrees, %g m/s, radius %g m\n", degrees, speed, radius);
        const double angle = degrees * double(kDegree);
        const Strike seen = roll_onto_slope(angle, speed, radius);
        EXPECT_TRUE(limit_row("A-178 sinks in (m)", seen.sink, 1e-3, 2e-4));
        EXPECT_TRUE(limit_row("A-178 gain of energy (relative)", seen.gain, 1e-4, 1e-6));
        EXPECT_TRUE(relative_row("A-178 speed kept", seen.speed, kept_speed(angle), 5e-3, 5e-4));
      }
    }
  }
}

// Without weight, so that nothing but the folds presses it on, around the inside of a polygon.
TEST(Valley, ABallLosesWithEachFoldWhatAStrikeTakes) {
  for (const double degrees : {2.0, 3.0, 5.0}) {
    const double angle = degrees * double(kDegree), radius = 0.1, speed = 5.0, side = 0.3;
    const int folds = 12;
    std::vector<DVec3> profile{{-2, 0, 0}};
    for (int i = 0; i <= folds; ++i)
      profile.push_back(profile.back() +
                        (i == 0 ? 2.0 : side) * DVec3{std::cos(angle * i), std::sin(angle * i), 0});
    profile.push_back(profile.back() + 4.0 * DVec3{std::cos(angle * folds), std::sin(angle * folds), 0});
    World world = make_world({.gravity = {0, 0, 0}, .sleeping = false});
    world.add_body({.type = BodyType::fixed},
                   {.geometry = strips(profile, -1, 1, 1), .material = surface(0.8f)});
    const BodyId ball = add_ball(world, {speed, radius, {-0.5, 0, 0}});
    const double before = world.energy().kinetic;
    run(world, (0.5 + side * folds + 1.0) / speed);
    const DVec3 v = wide(world.linear_velocity(ball));
    say("[row] A-178 folds of %g degrees\n", degrees);
    EXPECT_TRUE(row("A-178 turned by all folds (rad)", std::atan2(v.y, v.x), angle * folds, 2e-3, 1e-4));
    EXPECT_TRUE(relative_row("A-178 speed kept over twelve folds", std::sqrt(world.energy().kinetic / before),
                             std::pow(kept_speed(angle), folds), 1e-3, 1e-4));
  }
}

// Along a valley of many cells, beside its slope but not in touch with it; 0 degrees: a flat floor.
TEST(Valley, WhatABallRollsBesideDoesNotBrakeIt) {
  const double speed = 5.0, radius = 0.1, seconds = 1.0;
  for (const double degrees : {0.0, 5.0, 30.0}) {
    const double angle = degrees * double(kDegree);
    for (const double beside : {0.003, 0.01, 0.03}) {
      World world = make_world({.sleeping = false});
      world.add_body(
          {.type = BodyType::fixed},
          {.geometry = strips({{-1, 0, 0}, {0, 0, 0}, {std::cos(angle), std::sin(angle), 0}}, -1, 9, 97),
           .material = surface(0.8f)});
      const Roll roll{speed, radius, {-radius * std::tan(0.5 * angle) - beside, 0, 0}, {0, 0, 1}};
      const BodyId ball = add_ball(world, roll);
      run(world, seconds);
      const DVec3 moved = world.pose(ball).position - roll.start;
      say("[row] A-178 %g degrees, %g m beside\n", degrees, beside);
      EXPECT_TRUE(relative_row("A-178 way along (m)", moved.z, speed * seconds, 1e-3, 1e-5));
      EXPECT_TRUE(limit_row("A-178 way across (m)", std::fabs(moved.x), 1e-4, 1e-6));
    }
  }
}

}  // namespace
}  // namespace gyre::laws::valley_test
