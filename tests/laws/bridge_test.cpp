// Bridges of planks on hinges or pairs of balls: straight or slack, alone or under boxes.
#include "laws/assembly.h"

namespace gyre::laws::bridge_test {
namespace {

struct BridgeCase {
  int planks = 200;
  bool two_balls = false;  // at either edge, where a hinge would do
  double slack = 0.02;     // of the length
  float box_density = 0.0f;
  double seconds = 60.0;
};

struct BridgeOutcome {
  double gap = 0.0;
  double lowest_plank = 0.0, lowest_box = 0.0;
};

BridgeOutcome hold_bridge(const BridgeCase& c) {
  Assembly bridge({.sleeping = false});
  const double plank = 0.5, span = c.planks * plank * (1.0 - c.slack);
  double low = 1e-6, high = 3.0;  // half the angle of the arc
  for (int i = 0; i < 60; ++i) {
    const double t = 0.5 * (low + high);
    (std::sin(t) / t > 1.0 - c.slack ? low : high) = t;
  }
  const auto direction = [&](int i) { return c.slack > 0.0 ? -low + 2.0 * low * (i + 0.5) / c.planks : 0.0; };
  double chord = 0.0;
  for (int i = 0; i < c.planks; ++i) chord += plank * std::cos(direction(i));
  const double size = plank * span / chord;
  const auto join = [&](BodyId a, BodyId b, DVec3 at) {
    if (!c.two_balls) bridge.join(JointKind::hinge, a, b, at);
    for (const double side : {-0.5, 0.5}) {
      if (c.two_balls) bridge.join(JointKind::ball, a, b, at + DVec3{0, 0, side});
    }
  };
  DVec3 at{};
  BodyId last{};
  for (int i = 0; i < c.planks; ++i) {
    const DVec3 way{std::cos(direction(i)), std::sin(direction(i)), 0};
    const BodyId body = bridge.world.add_body(
        {.pose = {at + 0.5 * size * way, from_axis_angle({0, 0, 1}, float(direction(i)))}},
        {.geometry = Box{{float(0.475 * size), 0.05f, 1.0f}}, .density = 400.0f});
    bridge.bodies.push_back(body);
    join(last, body, at);
    at = at + size * way;
    last = body;
  }
  join(last, {}, at);
  std::vector<BodyId> boxes;
  const double middle = bridge.world.pose(bridge.bodies[std::size_t(c.planks / 2)]).position.y;
  for (int i = -2; i <= 2 && c.box_density > 0.0f; ++i) {
    boxes.push_back(bridge.world.add_body({.pose = {.position = {0.5 * span + 1.5 * i, middle + 0.65, 0}}},
                                          {.geometry = Box{{0.4f, 0.4f, 0.4f}}, .density = c.box_density}));
  }
  BridgeOutcome outcome;
  for (int i = 0; i < int(c.seconds * 60.0); ++i) {
    bridge.world.step(kStep);
    outcome.gap = std::max(outcome.gap, bridge.largest_gap());
  }
  for (const BodyId b : bridge.bodies)
    outcome.lowest_plank = std::min(outcome.lowest_plank, bridge.world.pose(b).position.y);
  for (const BodyId b : boxes)
    outcome.lowest_box = std::min(outcome.lowest_box, bridge.world.pose(b).position.y);
  return outcome;
}

// Straight from bank to bank there is no slack at all: only what the joints give lets it hang.
TEST(Bridge, OfFortyPlanksHoldsStraightOrSlackWithHingesOrPairsOfBalls) {
  for (const bool two_balls : {false, true}) {
    for (const double slack : {0.0, 0.02}) {
      const BridgeOutcome bridge = hold_bridge({40, two_balls, slack, 0.0f, 5.0});
      EXPECT_TRUE(limit_row("gap of 40 planks (m)", bridge.gap, 1e-3, 1e-4));
      EXPECT_GT(bridge.lowest_plank, slack > 0.0 ? -3.0 : -1.0);
    }
  }
}

TEST(Bridge, OfFortyPlanksCarriesBoxes) {
  for (const float density : {1000.0f, 4000.0f}) {  // 13 and 50 times a plank's mass
    const BridgeOutcome bridge = hold_bridge({40, false, 0.02, density, 5.0});
    EXPECT_TRUE(limit_row("gap of 40 planks under boxes (m)", bridge.gap, 5e-2, 1e-2));
    EXPECT_GT(bridge.lowest_box, bridge.lowest_plank);
  }
}

TEST(LongBridge, OfTwoHundredPlanksStandsForAMinute) {
  for (const bool two_balls : {false, true}) {
    EXPECT_TRUE(limit_row("gap of 200 planks (m)", hold_bridge({200, two_balls, 0.02}).gap, 1e-3, 1e-4));
    EXPECT_TRUE(
        limit_row("gap of 200 planks, straight (m)", hold_bridge({200, two_balls, 0.0}).gap, 2e-3, 1e-3));
  }
}

TEST(LongBridge, OfTwoHundredPlanksCarriesBoxesForAMinute) {
  for (const float density : {1000.0f, 5000.0f}) {
    const BridgeOutcome bridge = hold_bridge({200, false, 0.02, density});
    EXPECT_TRUE(limit_row("gap of 200 planks under boxes (m)", bridge.gap, 5e-2, 1e-2));
    EXPECT_GT(bridge.lowest_box, bridge.lowest_plank);
  }
}

}  // namespace
}  // namespace gyre::laws::bridge_test
