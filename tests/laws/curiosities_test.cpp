// Tippe top, a spinning ellipsoid on a slope: friction and rotation together.
// Source: J. Jellett, "A Treatise on the Theory of Friction", 1872.
#include "laws/kit.h"

namespace gyre::laws::curiosities_test {
namespace {

TEST(TippeTop, TurnsOverAndKeepsJellettsInvariant) {
  World world = make_world({.sleeping = false});
  add_ground(world, surface(0.3f));
  const double radius = 0.25, offset = 0.05;
  const Quat tilt = from_axis_angle({0, 0, 1}, 0.1f);
  const DVec3 axis = turned(tilt, {0, 1, 0});
  const float moment = float(0.4 * radius * radius);
  BodyDef def = point_body(1.0, {moment, moment, moment}, DVec3{0, radius, 0} - offset * axis);
  def.pose.orientation = tilt;
  def.angular_velocity = to_float(40.0 * axis);
  const BodyId top = world.add_body(def, {.geometry = Sphere{float(radius)},
                                          .local = {.position = {0, float(offset), 0}},
                                          .material = surface(0.3f)});
  const auto jellett = [&] {
    const DVec3 up = turned(world.pose(top).orientation, {0, 1, 0});
    const DVec3 to_contact = offset * up - DVec3{0, radius, 0};
    return -double(moment) * dot(wide(world.angular_velocity(top)), to_contact);
  };
  const double start = jellett();
  double error = 0.0, over = -1.0;
  for (int i = 1; i <= 600 && over < 0.0; ++i) {
    world.step(kStep);
    error = std::max(error, std::fabs(jellett() / start - 1.0));
    if (turned(world.pose(top).orientation, {0, 1, 0}).y < std::cos(150.0 * double(kDegree)))
      over = i * double(kStep);
  }
  say("[row] A-23 turned over after %g s\n", over);
  EXPECT_GT(over, 0.0);
  EXPECT_TRUE(limit_row("A-23 change of Jellett's invariant", error, 5e-2, 5e-3));
}

TEST(Ellipsoid, SpinningOnASlopeDoesNotSpeedUp) {
  World world = make_world({.gravity = {0, 0, 0}, .sleeping = false});
  const double angle = 15.0 * double(kDegree);
  world.set_gravity({float(kGravity * std::sin(angle)), float(-kGravity * std::cos(angle)), 0});
  add_ground(world, surface(0.6f));
  std::vector<Vec3> points;
  for (int i = 0; i <= 12; ++i) {
    for (int k = 0; k < 20; ++k) {
      const double a = kPiDouble * i / 12, b = 2 * kPiDouble * k / 20;
      points.push_back({float(0.05 * std::sin(a) * std::cos(b)), float(0.1 * std::cos(a)),
                        float(0.15 * std::sin(a) * std::sin(b))});
      if (i == 0 || i == 12) break;
    }
  }
  const Result<Geometry> hull = cook_hull(points);
  ASSERT_TRUE(hull);
  const BodyId body = world.add_body({.pose = {.position = {0, 0.1, 0}}, .angular_velocity = {0, 30, 0}},
                                     {.geometry = *hull});
  double fastest = 0.0;
  for (int i = 0; i < 5000; ++i) {
    world.step(0.002f);
    fastest = std::max(fastest, double(length(world.angular_velocity(body))));
  }
  EXPECT_TRUE(limit_row("A-18 spin over start", fastest / 30.0, 2.0, 1.0));
}

}  // namespace
}  // namespace gyre::laws::curiosities_test
