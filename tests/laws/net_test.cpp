// Nets: loops of joints, few of them solved directly, many swept.
#include "laws/kit.h"

namespace gyre::laws::net_test {
namespace {

enum class Tie : std::uint8_t { ball, rod };
enum class Hung : std::uint8_t { fixed, pinned, loose };

struct NetCase {
  int side = 0;
  AnyShape knot;
  double spacing = 0.4;  // m
  Tie tie = Tie::ball;
  Hung hung = Hung::fixed;  // two corners: fixed, tied to the world at their middles, or not at all
};

std::vector<BodyId> add_net(World& world, const NetCase& net) {
  const double spacing = net.spacing;
  std::vector<BodyId> knots;
  const auto tie = [&](int first, int second) {
    const DVec3 a = world.pose(knots[std::size_t(first)]).position,
                b = world.pose(knots[std::size_t(second)]).position;
    const BodyId one = knots[std::size_t(first)], other = knots[std::size_t(second)];
    if (net.tie == Tie::rod) {
      world.add_joint(
          DistanceDef{.a = one, .b = other, .anchor = 0.7 * a + 0.3 * b, .anchor_b = 0.3 * a + 0.7 * b});
    } else {
      world.add_joint(BallDef{.a = one, .b = other, .anchor = 0.5 * (a + b)});
    }
  };
  const BodyId post = world.add_body({.type = BodyType::fixed, .pose = {.position = {0, 200, 0}}},
                                     {.geometry = Sphere{0.1f}});
  for (int i = 0; i < net.side * net.side; ++i) {
    const int row = i / net.side, column = i % net.side;
    const bool hangs = net.hung != Hung::loose && row == 0 && (column == 0 || column == net.side - 1);
    const bool is_fixed = hangs && net.hung == Hung::fixed;
    const DVec3 at{spacing * column, 40, spacing * row};
    knots.push_back(
        world.add_body({.type = is_fixed ? BodyType::fixed : BodyType::dynamic, .pose = {.position = at}},
                       {.geometry = net.knot}));
    if (hangs && !is_fixed) world.add_joint(BallDef{.a = post, .b = knots.back(), .anchor = at});
    if (column > 0) tie(i - 1, i);
    if (row > 0) tie(i - net.side, i);
  }
  return knots;
}

// It falls and swings: by how much its energy grows, of what it can fall by.
double gained_by(const NetCase& net) {
  World world = make_world({.sleeping = false});
  const std::vector<BodyId> knots = add_net(world, net);
  const double whole =
      9.81 * net.spacing * (net.side - 1) * double(knots.size());  // J/kg, all of it fallen by its span
  double energy_gain = 0.0;
  for (int k = 0; k < 24; ++k) {
    run(world, 10.0 / 60.0);
    double energy = 0.0;  // J/kg, without the knots' spin
    for (const BodyId knot : knots) {
      const double speed = double(length(world.linear_velocity(knot)));
      energy += 0.5 * speed * speed + 9.81 * (world.pose(knot).position.y - 40.0);
    }
    energy_gain = std::max(energy_gain, energy / whole);
  }
  return energy_gain;
}
bool gains_nothing(const char* what, const NetCase& net) {
  return limit_row(what, gained_by(net), 0.01, 0.001);
}

// Knots that are light for their arms swing faster under a net's load than sub-steps resolve; torn apart by that, a net of 32 x 32 that hung
// by two corners flew off at 2e5 m/s.
TEST(Net, OfLightKnotsGainsNoEnergy) {
  const AnyShape board = Box{{0.15f, 0.02f, 0.05f}};
  for (const NetCase& one : {NetCase{10, Sphere{0.01f}}, NetCase{10, Sphere{0.02f}},
                             NetCase{20, Sphere{0.05f}}, NetCase{32, Sphere{0.08f}}, NetCase{30, board}})
    EXPECT_TRUE(gains_nothing("net of light knots: energy gained, of what it can fall by", one)) << one.side;
}

// A knot that its neighbour stops leaves joints open, and what hangs there is led after it. Of a net that is stretched the few joints around
// cannot all be closed while the rest stays: looked for all the same, a way out led one knot 18 m off.
TEST(Net, OfPlatesThatTouchIsNotTornWhereOneIsStopped) {
  const NetCase plates{16, Box{{0.035f, 0.168f, 0.168f}}, 0.35};
  EXPECT_TRUE(gains_nothing("net of plates: energy gained, of what it can fall by", plates));
}

// Nets of up to 8 x 8 are solved directly. As the last of their swing goes into knots that are light for their arms these turn by a quarter
// of a radian in a sub-step, where equations of second order give energy: fifty times what there was.
TEST(Net, OfFewLightKnotsGainsNoEnergy) {
  for (const NetCase& one : {NetCase{4, Box{{0.06f, 0.02f, 0.04f}}, 0.4, Tie::ball, Hung::pinned},
                             NetCase{6, Box{{0.06f, 0.1f, 0.04f}}, 0.4, Tie::ball, Hung::pinned},
                             NetCase{7, Box{{0.09f, 0.09f, 0.222f}}, 0.6, Tie::ball, Hung::pinned},
                             NetCase{5, Box{{0.017f, 0.035f, 0.035f}}, 0.35, Tie::ball, Hung::pinned}})
    EXPECT_TRUE(gains_nothing("net of few knots: energy gained, of what it can fall by", one)) << one.side;
}

// Joints that see a raised inertia and contacts that see the body's own answered each other ever more.
TEST(Net, OfFewKnotsThatTouchGainsNoEnergy) {
  const NetCase net{8, Box{{0.035f, 0.087f, 0.017f}}, 0.35};
  EXPECT_TRUE(gains_nothing("net of knots that touch: energy gained, of what it can fall by", net));
}

// Rods between points of bodies turn these as ball joints do.
TEST(Net, OfRodsGainsNoEnergy) {
  for (const NetCase& one : {NetCase{11, Box{{0.09f, 0.288f, 0.09f}}, 0.6, Tie::rod},
                             NetCase{12, Box{{0.087f, 0.13f, 0.017f}}, 0.35, Tie::rod, Hung::pinned},
                             NetCase{9, Box{{0.075f, 0.025f, 0.075f}}, 0.5, Tie::rod, Hung::pinned}})
    EXPECT_TRUE(gains_nothing("net of rods: energy gained, of what it can fall by", one)) << one.side;
}

struct Sums {
  DVec3 momentum, spin;  // the second about the world's origin
  double energy = 0.0;   // J, of motion
};
Sums sum_up(const World& world, const std::vector<BodyId>& knots) {
  Sums sums;
  for (const BodyId knot : knots) {
    const MassProperties own = world.mass_properties(knot);
    const Quat turned = world.pose(knot).orientation;
    const double mass = double(own.mass);
    const DVec3 v(world.linear_velocity(knot)), w(world.angular_velocity(knot));
    const DVec3 turn(rotate(turned, own.inertia * rotate_inverse(turned, to_float(w))));
    sums.momentum += mass * v;
    sums.spin += mass * cross(world.pose(knot).position, v) + turn;
    sums.energy += 0.5 * mass * dot(v, v) + 0.5 * dot(w, turn);
  }
  return sums;
}

// What hangs on nothing is slowed as seen from itself: while its knots whirl, the net as a whole goes and turns.
TEST(Net, ThatFliesKeepsItsMomentaWhereItIsSlowed) {
  const AnyShape knot = Box{{0.06f, 0.02f, 0.04f}};
  for (const NetCase& net :
       {NetCase{5, knot, 0.4, Tie::ball, Hung::loose}, NetCase{10, knot, 0.4, Tie::rod, Hung::loose}}) {
    World world = make_world({.gravity = {0, 0, 0}, .sleeping = false});
    const std::vector<BodyId> knots = add_net(world, net);
    const double middle = 0.5 * net.spacing * (net.side - 1);
    for (std::size_t i = 0; i < knots.size(); ++i) {
      const DVec3 at = world.pose(knots[i]).position - DVec3{middle, 40, middle};
      const float wild = i % 3 == 0 ? 300.0f : -150.0f;  // rad/s: joints give a lot at once
      world.set_velocity(knots[i], Vec3{3, 1, 0} + to_float(cross(DVec3{0, 0, 2}, at)),
                         {wild, 0.5f * wild, i % 2 == 0 ? wild : -wild});
    }
    run(world, 1.0 / 60.0);  // until all goes as the joints have it
    const Sums start = sum_up(world, knots);
    double most = 0.0;
    for (int k = 0; k < 60; ++k) {
      run(world, 1.0 / 60.0);
      most = std::max(most, sum_up(world, knots).energy / start.energy);
    }
    const Sums end = sum_up(world, knots);
    const auto off = [](DVec3 a, DVec3 b) { return length(b - a) / length(a); };
    EXPECT_TRUE(limit_row("net that flies: momentum off by", off(start.momentum, end.momentum), 1e-4, 1e-5));
    EXPECT_TRUE(limit_row("net that flies: spin off by", off(start.spin, end.spin), 1e-3, 1e-4));
    EXPECT_TRUE(limit_row("net that flies: energy, of what it was", most, 1.02, 1.001)) << net.side;
  }
}

}  // namespace
}  // namespace gyre::laws::net_test
