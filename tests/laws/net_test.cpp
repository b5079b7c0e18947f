// Nets: joints that are swept, since there are too many loops among them to be solved directly.
#include "laws/kit.h"

namespace gyre::laws {
namespace {

// Knots that are light for their arms swing faster under a net's load than sub-steps resolve; torn apart by that, a net of 30 x 30 that hung
// by two corners flew off at 2e5 m/s.
TEST(Net, OfLightKnotsGainsNoEnergy) {
  struct Case {
    int knots;
    float radius;
  };
  for (const Case& one : {Case{10, 0.02f}, Case{20, 0.05f}, Case{30, 0.08f}}) {
    World world = make_world({.sleeping = false});
    const float spacing = 0.4f;
    std::vector<BodyId> knots;
    for (int i = 0; i < one.knots * one.knots; ++i) {
      const int row = i / one.knots, column = i % one.knots;
      const bool hangs = row == 0 && (column == 0 || column == one.knots - 1);
      knots.push_back(
          world.add_body({.type = hangs ? BodyType::fixed : BodyType::dynamic,
                          .pose = {.position = {double(spacing) * column, 40, double(spacing) * row}}},
                         {.geometry = Sphere{one.radius}}));
      const auto tie = [&](BodyId other, double x, double z) {
        const DVec3 at = world.pose(other).position;
        world.add_joint({.a = other, .b = knots.back(), .anchor = {at.x + x, at.y, at.z + z}});
      };
      if (column > 0) tie(knots[std::size_t(i - 1)], 0.5 * double(spacing), 0.0);
      if (row > 0) tie(knots[std::size_t(i - one.knots)], 0.0, 0.5 * double(spacing));
    }
    const double mass = double(mass_properties(Sphere{one.radius}, 1000.0f)->mass);
    const double span = double(spacing) * (one.knots - 1);
    double fall = 0.0;  // what all of it could have fallen by the end, at most
    for (int k = 0; k < 16; ++k) {
      run(world, 10.0 / 60.0);
      double energy = 0.0;
      for (const BodyId knot : knots) {
        const Vec3 v = world.linear_velocity(knot), w = world.angular_velocity(knot);
        energy += 0.5 * mass * double(length_squared(v)) +
                  0.2 * mass * double(square(one.radius) * length_squared(w)) +
                  mass * 9.81 * (world.pose(knot).position.y - 40.0);
      }
      fall = std::max(fall, energy / (mass * 9.81 * span * double(knots.size())));
    }
    EXPECT_TRUE(limit_row("net of light knots: energy over m g times its span", fall, 0.01, 0.001))
        << one.knots;
  }
}

}  // namespace
}  // namespace gyre::laws
