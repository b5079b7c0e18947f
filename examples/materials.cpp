// Friction and restitution belong to shapes. A combine rule, or a table entry for the pair, gives the values of a contact.
#include <gyre/gyre.h>

#include <cmath>
#include <cstdint>
#include <cstdio>

using namespace gyre;

namespace {

constexpr std::uint16_t kRubber = 1;
constexpr std::uint16_t kIce = 2;

// The distance that a box slides in two seconds down a slope of 20 degrees.
double slide(World& world, const Material& material, float z) {
  const float angle = 20.0f * kPi / 180.0f;
  const Quat tilt = from_axis_angle({0, 0, 1}, -angle);
  // The slope is a static box; its top face contains the line x = y = 0.
  world.add_body({.type = BodyType::fixed,
                  .pose = {.position = DVec3{0, 0, z} + rotate(tilt, {0, -0.5f, 0}), .orientation = tilt}},
                 {.geometry = Box{{50, 0.5f, 1}},
                  .material = {.static_friction = 0.5f, .dynamic_friction = 0.4f, .id = kRubber}});
  const BodyId box = world.add_body(
      {.pose = {.position = DVec3{0, 0, z} + rotate(tilt, {0, 0.25f, 0}), .orientation = tilt}},
      {.geometry = Box{{0.5f, 0.25f, 0.5f}}, .material = material});
  const DVec3 start = world.pose(box).position;
  for (int i = 0; i < 120; ++i) world.step(1.0f / 60.0f);
  return double(length(difference(world.pose(box).position, start)));
}

}  // namespace

int main() {
  World world = *World::create();
  // Rubber with itself: the geometric mean of equal values is the value. tan(20 degrees) = 0.364 < 0.5, so the box stays.
  const double rubber = slide(world, {.static_friction = 0.5f, .dynamic_friction = 0.4f, .id = kRubber}, 0);
  // Ice on rubber: the table entry.
  world.set_material_pair(
      {.a = kIce, .b = kRubber, .static_friction = 0.1f, .dynamic_friction = 0.05f, .restitution = 0});
  const double ice = slide(world, {.static_friction = 0.02f, .dynamic_friction = 0.02f, .id = kIce}, 5);
  // Sliding down a slope: s = g (sin a - mu cos a) t^2 / 2.
  const double angle = 20.0 * 3.14159265358979 / 180.0;
  const double exact = 0.5 * 9.81 * (std::sin(angle) - 0.05 * std::cos(angle)) * 4.0;
  std::printf("rubber slid %.4f m, ice %.3f m (exactly %.3f m)\n", rubber, ice, exact);
  return rubber < 1e-2 && std::fabs(ice - exact) < 0.02 * exact ? 0 : 1;
}
