// Nets: joints that are swept, since there are too many loops among them to be solved directly.
#include "laws/kit.h"

namespace gyre::laws {
namespace {

// Knots that are light for their arms swing faster under a net's load than sub-steps resolve; torn apart by that, a net of 32 x 32 that hung
// by two corners flew off at 2e5 m/s.
TEST(Net, OfLightKnotsGainsNoEnergy) {
  struct Case {
    int side;
    AnyShape knot;
  };
  const AnyShape board = Box{{0.15f, 0.02f, 0.05f}};
  for (const Case& one : {Case{10, Sphere{0.01f}}, Case{10, Sphere{0.02f}}, Case{20, Sphere{0.05f}},
                          Case{32, Sphere{0.08f}}, Case{30, board}}) {
    World world = make_world({.sleeping = false});
    const double spacing = 0.4;
    std::vector<BodyId> knots;
    for (int i = 0; i < one.side * one.side; ++i) {
      const int row = i / one.side, column = i % one.side;
      const bool hangs = row == 0 && (column == 0 || column == one.side - 1);
      knots.push_back(world.add_body({.type = hangs ? BodyType::fixed : BodyType::dynamic,
                                      .pose = {.position = {spacing * column, 40, spacing * row}}},
                                     {.geometry = one.knot}));
      const auto tie = [&](int other, double x, double z) {
        const DVec3 at = world.pose(knots[std::size_t(other)]).position;
        world.add_joint(
            {.a = knots[std::size_t(other)], .b = knots.back(), .anchor = {at.x + x, at.y, at.z + z}});
      };
      if (column > 0) tie(i - 1, 0.5 * spacing, 0.0);
      if (row > 0) tie(i - one.side, 0.0, 0.5 * spacing);
    }
    const double whole =
        9.81 * spacing * (one.side - 1) * double(knots.size());  // J/kg, all of it fallen by its span
    double gained = 0.0;
    for (int k = 0; k < 16; ++k) {
      run(world, 10.0 / 60.0);
      double energy = 0.0;  // J/kg, without the knots' spin
      for (const BodyId knot : knots) {
        const double speed = double(length(world.linear_velocity(knot)));
        energy += 0.5 * speed * speed + 9.81 * (world.pose(knot).position.y - 40.0);
      }
      gained = std::max(gained, energy / whole);
    }
    EXPECT_TRUE(limit_row("net of light knots: energy gained, of what it can fall by", gained, 0.01, 0.001))
        << one.side;
  }
}

}  // namespace
}  // namespace gyre::laws
