// What stands by leaning: card houses, towers of planks, arches of dry stones.
#include "laws/kit.h"

#include <random>

namespace gyre::laws::masonry_test {
namespace {

// How far the farthest of the bodies is from where it was.
double farthest_moved(const World& world, const std::vector<BodyId>& bodies, const std::vector<DVec3>& from) {
  double most = 0.0;
  for (std::size_t i = 0; i < bodies.size(); ++i) {
    most = std::max(most, length(world.pose(bodies[i]).position - from[i]));
  }
  return most;
}
std::vector<DVec3> places_of(const World& world, const std::vector<BodyId>& bodies) {
  std::vector<DVec3> places;
  for (const BodyId body : bodies) places.push_back(world.pose(body).position);
  return places;
}

// ------------------------------------------------------------------------------------------------------------- cards

struct Cards {
  double lean = 25.0 * kPi / 180.0;                     // of a card from the vertical
  double length = 0.9, thickness = 0.012, width = 0.6;  // m
};

// `storeys` rows of pairs that lean against each other, cards lying between the rows.
std::vector<BodyId> add_card_house(World& world, const Cards& cards, int storeys, const Material& material) {
  std::vector<BodyId> bodies;
  const double c = std::cos(cards.lean), s = std::sin(cards.lean);
  const double half = 0.5 * cards.length, thick = 0.5 * cards.thickness;
  const double row = 2.0 * (thick * s + half * c);  // m, height of a pair
  const double reach = thick * c + half * s;        // m, from a card's middle to where it meets the other
  const double pitch = 4.0 * reach + 0.01;          // m, between the pairs' middles
  const auto add = [&](double x, double y, double angle, double half_x, double half_y) {
    BodyDef def;
    def.pose.position = {x, y, 0};
    def.pose.orientation = from_axis_angle({0, 0, 1}, float(angle));
    bodies.push_back(
        world.add_body(def, {.geometry = Box{{float(half_x), float(half_y), float(0.5 * cards.width)}},
                             .density = 800,
                             .material = material}));
  };
  for (int storey = 0; storey < storeys; ++storey) {
    const int pairs = storeys - storey;
    const double floor = double(storey) * (row + cards.thickness);
    for (int i = 0; i < pairs; ++i) {
      const double x = (double(i) - 0.5 * double(pairs - 1)) * pitch;
      add(x - reach, floor + 0.5 * row, -cards.lean, thick, half);
      add(x + reach, floor + 0.5 * row, cards.lean, thick, half);
    }
    for (int i = 0; i + 1 < pairs; ++i) {
      const double x = (double(i) - 0.5 * double(pairs - 2)) * pitch;
      add(x, floor + row + thick, 0.0, 0.5 * pitch - 0.001, thick);
    }
  }
  return bodies;
}

//
double card_house_moves(int storeys, double seconds) {
  World world = make_world({.sleeping = false});
  add_ground(world, surface(0.7f));
  const std::vector<BodyId> bodies = add_card_house(world, {}, storeys, surface(0.7f));
  const std::vector<DVec3> from = places_of(world, bodies);
  run(world, seconds);
  return farthest_moved(world, bodies, from);
}

TEST(CardHouse, OfTwoStoreysStands) {
  EXPECT_TRUE(
      limit_row("A-116 card house of 2 storeys moves (m)", card_house_moves(2, 10.0), 1.0e-3, 1.0e-6));
}
TEST(CardHouse, OfThreeStoreysStands) {
  EXPECT_TRUE(
      limit_row("A-116 card house of 3 storeys moves (m)", card_house_moves(3, 10.0), 1.0e-3, 1.0e-6));
}
TEST(CardHouse, OfFiveStoreysStands) {
  EXPECT_TRUE(
      limit_row("A-116 card house of 5 storeys moves (m)", card_house_moves(5, 10.0), 1.0e-3, 1.0e-6));
}

// Two cards of mass m, length L that lean at an angle a from the vertical stand if the floor's friction is above tan(a) / 2: each
// bears m g on the floor and pushes the other with m g tan(a) / 2.
TEST(CardHouse, OfOnePairNeedsHalfTheTangent) {
  for (const double share : {0.9, 1.1}) {
    World world = make_world({.sleeping = false, .friction_rule = CombineRule::minimum});
    const Cards cards{.thickness = 0.001};
    add_ground(world, surface(float(share * 0.5 * std::tan(cards.lean))));
    const std::vector<BodyId> bodies = add_card_house(world, cards, 1, surface(0.9f));
    const std::vector<DVec3> from = places_of(world, bodies);
    run(world, 5.0);
    const double moved = farthest_moved(world, bodies, from);
    if (share < 1.0) {
      EXPECT_GT(moved, 0.1) << "stood without the friction it needs";
    } else {
      EXPECT_LT(moved, 1.0e-3) << "fell";
    }
  }
}

// Boards whose inner edges alone touch push each other with m g (x_m - x_f) / y_e, where x_m is a board's middle, x_f its foot and y_e
// the height of the edges. The floor has to bear that by friction; the edges, as both push level, need none.
TEST(CardHouse, OfTwoBoardsOnTheirEdgesNeedsFrictionOnTheFloorAlone) {
  std::mt19937 engine{7};
  const auto draw = [&](double low, double high) {
    return low + (high - low) * double(engine() >> 8) / 16777216.0;
  };
  for (int trial = 0; trial < 16; ++trial) {
    const double lean = draw(0.15, 0.6), half = draw(0.1, 0.8), thick = half * draw(0.03, 0.1),
                 yaw = draw(-3, 3);
    const double c = std::cos(lean), s = std::sin(lean);
    const double reach = half * s + thick * c;                                // from a middle to the edges
    const double foot = half * s - thick * c, height = half * c + thick * s;  // to the foot; of the middle
    const double needed = foot / (height + half * c - thick * s),
                 share = trial % 4 == 3 ? 0.8 : draw(1.2, 1.6);
    World world = make_world({.sleeping = false});
    const Material material = surface(float(share * needed));
    add_ground(world, material);
    const Quat turn = from_axis_angle({0, 1, 0}, float(yaw));
    std::vector<BodyId> boards;
    for (const double side : {-1.0, 1.0}) {
      BodyDef def;
      def.pose.position = DVec3(rotate(turn, {float(side * reach), 0, 0})) + DVec3{0, height, 0};
      def.pose.orientation = turn * from_axis_angle({0, 0, 1}, float(side * lean));
      boards.push_back(world.add_body(def, {.geometry = Box{{float(thick), float(half), float(0.5 * half)}},
                                            .density = 600,
                                            .material = material}));
    }
    const std::vector<DVec3> from = places_of(world, boards);
    run(world, 4.0);
    const double moved = farthest_moved(world, boards, from) / half;
    EXPECT_TRUE(share < 1.0 ? moved > 0.2 : moved < 2.0e-3)
        << "trial " << trial << ", lean " << lean << ", " << share << " of the friction: moved by " << moved;
  }
}

// ------------------------------------------------------------------------------------------------------------ planks

// Three planks a storey, crosswise from storey to storey; a plank is 120 x 24 x 8 mm.
double plank_tower_moves(int storeys, double seconds) {
  World world = make_world({.sleeping = false});
  add_ground(world, surface(0.5f));
  const Vec3 half{0.06f, 0.004f, 0.012f};
  std::vector<BodyId> bodies;
  for (int storey = 0; storey < storeys; ++storey) {
    const bool along_x = storey % 2 == 0;
    for (int i = -1; i <= 1; ++i) {
      const double offset = 0.048 * i, height = 0.004 + 0.008 * storey;
      BodyDef def;
      def.pose.position = along_x ? DVec3{0, height, offset} : DVec3{offset, height, 0};
      const Vec3 box = along_x ? half : Vec3{half.z, half.y, half.x};
      bodies.push_back(
          world.add_body(def, {.geometry = Box{box}, .density = 600, .material = surface(0.5f)}));
    }
  }
  const std::vector<DVec3> from = places_of(world, bodies);
  run(world, seconds);
  return farthest_moved(world, bodies, from);
}

TEST(PlankTower, OfThirtyStoreysStands) {
  EXPECT_TRUE(limit_row("A-123 plank tower of 30 storeys, 60 s, moves (m)", plank_tower_moves(30, 60.0),
                        1.0e-3, 1.0e-6));
}
TEST(LongPlankTower, OfAHundredAndTwentyStoreysStandsForTenMinutes) {
  EXPECT_TRUE(limit_row("A-123 plank tower of 120 storeys, 600 s, moves (m)", plank_tower_moves(120, 600.0),
                        1.0e-3, 1.0e-6));
}

// ------------------------------------------------------------------------------------------------------------- stones

// A half circle of `count` wedge-shaped stones without mortar, of mean radius 2 m and the given thickness, between fixed
// abutments. A semicircular arch stands if it is thicker than 10.75 % of its mean radius (R. Milankovitch, 1907; J. Heyman's 10.6 %
// rounds the line of thrust).
double arch_moves(double thickness, int count, double seconds) {
  World world = make_world({.sleeping = false});
  add_ground(world, surface(0.9f));
  std::vector<BodyId> bodies;
  const double inner = 2.0 - 0.5 * thickness, outer = 2.0 + 0.5 * thickness;
  const auto at = [](double radius, double angle) {
    return DVec3{radius * std::cos(angle), radius * std::sin(angle), 0};
  };
  for (int i = 0; i < count; ++i) {
    const double begin = kPi * double(i) / double(count), end = kPi * double(i + 1) / double(count);
    const DVec3 middle = at(2.0, 0.5 * (begin + end));
    std::vector<Vec3> corners;
    for (const DVec3 corner : {at(inner, begin), at(outer, begin), at(inner, end), at(outer, end)}) {
      for (const double z : {-0.25, 0.25}) corners.push_back(to_float(corner - middle + DVec3{0, 0, z}));
    }
    const Result<Geometry> stone = cook_hull(corners);
    EXPECT_TRUE(bool(stone));
    BodyDef def;
    def.pose.position = middle;
    bodies.push_back(world.add_body(def, {.geometry = *stone, .density = 2500, .material = surface(0.9f)}));
  }
  const std::vector<DVec3> from = places_of(world, bodies);
  run(world, seconds);
  return farthest_moved(world, bodies, from);
}

TEST(DryArch, StandsDownToMilankovitchsThickness) {
  for (const int count : {15, 31}) {
    EXPECT_LT(arch_moves(0.11 * 2.0, count, 10.0), 1.0e-3) << count << " stones fell";
    EXPECT_GT(arch_moves(0.105 * 2.0, count, 10.0), 0.3) << count << " stones stood that cannot";
  }
}

}  // namespace
}  // namespace gyre::laws::masonry_test
