// Nets: joints that are swept, since there are too many loops among them to be solved directly.
#include "laws/kit.h"

namespace gyre::laws {
namespace {

struct NetCase {
  int side = 0;
  AnyShape knot;
  double spacing = 0.4;  // m
};

// Hung by two corners it falls and swings: by how much its energy grows, of what it can fall by.
double gained_by(const NetCase& one) {
  World world = make_world({.sleeping = false});
  const double spacing = one.spacing;
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
  return gained;
}

// Knots that are light for their arms swing faster under a net's load than sub-steps resolve; torn apart by that, a net of 32 x 32 that hung
// by two corners flew off at 2e5 m/s.
TEST(Net, OfLightKnotsGainsNoEnergy) {
  const AnyShape board = Box{{0.15f, 0.02f, 0.05f}};
  for (const NetCase& one : {NetCase{10, Sphere{0.01f}}, NetCase{10, Sphere{0.02f}},
                             NetCase{20, Sphere{0.05f}}, NetCase{32, Sphere{0.08f}}, NetCase{30, board}}) {
    EXPECT_TRUE(
        limit_row("net of light knots: energy gained, of what it can fall by", gained_by(one), 0.01, 0.001))
        << one.side;
  }
}

// A knot that its neighbour stops leaves joints open, and what hangs there is led after it. Of a net that is stretched the few joints around
// cannot all be closed while the rest stays: looked for all the same, a way out led one knot 18 m off.
TEST(Net, OfPlatesThatTouchIsNotTornWhereOneIsStopped) {
  const NetCase plates{16, Box{{0.035f, 0.168f, 0.168f}}, 0.35};
  EXPECT_TRUE(
      limit_row("net of plates: energy gained, of what it can fall by", gained_by(plates), 0.01, 0.001));
}

}  // namespace
}  // namespace gyre::laws
