// Small things that tumble: what turns by radians in a step meets the ground amid it, is stopped on its way by the sweep, and touches
// elsewhere in each part of the step. None of it may gain energy: a stick of three centimetres that fell on a table once jumped to a metre.
#include "laws/kit.h"

#include "random.h"

#include <array>
#include <cmath>

namespace gyre::laws::whirl_test {
namespace {

constexpr std::array<const char*, 6> kKinds{"capsule", "box", "rounded box", "cylinder", "cone", "hull"};

// Within `size` from the middle, and of any proportions from 1 to 10.
AnyShape draw_shape(std::size_t kind, testing_random::Random& random, float size) {
  const auto part = [&] { return size * random.real(0.1f, 1.0f); };
  const float a = part(), b = part(), c = part();
  switch (kind) {
    case 0:
      return Capsule{0.5f * a, b};
    case 1:
      return Box{{a, b, c}};
    case 2:
      return Box{{a, b, c}, 0.3f * std::min({a, b, c})};
    case 3:
      return Cylinder{a, b};
    case 4:
      return Cone{a, b};
    default: {
      std::vector<Vec3> points;
      for (int i = 0; i < 12; ++i) points.push_back(multiply_each({a, b, c}, random.vector(-1, 1)));
      return *cook_hull(points);
    }
  }
}

// The most that one step adds to a body's energy, over what it was dropped with, and beyond what a sweep may leave it: where it is stopped
// on its way, gravity has worked for the whole step but has moved it for a part of it.
double drop(std::size_t kind, std::uint32_t seed, float friction, float min_spin, float max_spin) {
  testing_random::Random random;
  random.state += seed * 0x9e3779b97f4a7c15u;
  World world = make_world({.sleeping = false});
  add_ground(world, surface(friction));
  const float size = 0.01f * std::pow(30.0f, random.real(0, 1));                        // 1 to 30 cm
  const float spin = min_spin * std::pow(max_spin / min_spin, random.real(0, 1));       // about each axis
  const BodyDef def{.pose = {{0, 2.0 * double(size), 0}, random.turn(3.0f)},
                    .linear_velocity = random.vector(-1, 1),
                    .angular_velocity = random.vector(-spin, spin)};
  const BodyId body =
      world.add_body(def, {.geometry = draw_shape(kind, random, size), .material = surface(friction)});
  const double mass = double(world.mass_properties(body).mass), weight = mass * 9.81;
  const auto energy = [&] { return world.energy().kinetic + world.energy().potential; };
  const double scale = std::max(world.energy().kinetic, weight * double(size));
  double last = energy(), most = 0.0;
  for (int i = 0; i < 240; ++i) {
    EXPECT_TRUE(world.step(kStep));
    const double speed =
        double(length(world.linear_velocity(body)) + 2.0f * size * length(world.angular_velocity(body)));
    most = std::max(most, (energy() - last - weight * speed * double(kStep)) / scale);
    last = energy();
  }
  return most;
}

void expect_no_gain(float min_spin, float max_spin, double max_gain) {
  for (std::size_t kind = 0; kind < kKinds.size(); ++kind) {
    double most = 0.0;
    for (const float friction : {0.0f, 0.5f})
      for (std::uint32_t seed = 1; seed <= 100; ++seed)
        most = std::max(most, drop(kind, seed, friction, min_spin, max_spin));
    const std::string name = "up to " + std::to_string(int(max_spin)) + " rad/s: energy that a " +
                             kKinds[kind] + " gains in a step";
    EXPECT_TRUE(limit_row(name.c_str(), most, max_gain, 0.001));
  }
}

// Turned back to where it was stopped, a slender body that kept its angular velocity would have ten times the energy.
TEST(Whirl, WhatFallsAndTumblesGainsNothing) { expect_no_gain(3.0f, 150.0f, 0.05); }

// By up to a radian in a part of a step.
TEST(Whirl, WhatTurnsByRadiansInAStepGainsNothing) { expect_no_gain(80.0f, 200.0f, 0.05); }

}  // namespace
}  // namespace gyre::laws::whirl_test
