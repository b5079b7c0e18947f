// Light things that machines hold hard: a block between a fixed jaw and a jaw on a motor, and one that two such jaws lift. Masses of 10 to
// 200 g, forces of 10 to 150 N, and six kinds of shape are drawn. From the first step on nothing is entered, shot out or lost.
#include "laws/kit.h"

namespace gyre::laws::vise_test {
namespace {

// The same numbers everywhere. (D. Knuth, MMIX.)
class Dice {
 public:
  explicit Dice(std::uint64_t seed) : state_(seed * 2654435761u + 1u) {}
  float operator()(float low, float high) {
    state_ = state_ * 6364136223846793005u + 1442695040888963407u;
    return low + (high - low) * (float(state_ >> 40) * (1.0f / 16777216.0f));
  }
  // Each factor of two is as likely.
  float by_factors(float low, float high) { return low * std::pow(high / low, (*this)(0.0f, 1.0f)); }

 private:
  std::uint64_t state_;
};

constexpr int kShapes = 6;
const char* const kShapeNames[kShapes] = {"box", "sphere", "cylinder", "lying cylinder", "capsule", "hull"};

// Reaches from -r to r along x.
ShapeDef make_shape(int kind, float r, float friction) {
  ShapeDef def;
  def.material = surface(friction);
  switch (kind) {
    case 0:
      def.geometry = Box{{r, r, r}};
      break;
    case 1:
      def.geometry = Sphere{r};
      break;
    case 2:
      def.geometry = Cylinder{r, r};
      break;
    case 3:
      def.geometry = Cylinder{r, r};
      def.local.orientation = from_axis_angle({0, 0, 1}, 90.0f * kDegree);
      break;
    case 4:
      def.geometry = Capsule{r, r};
      break;
    default:
      def.geometry = *cook_hull(std::vector<Vec3>{{r, 0.9f * r, 0.8f * r},
                                                  {r, -0.9f * r, 0.7f * r},
                                                  {r, 0.2f * r, -r},
                                                  {-r, r, 0.7f * r},
                                                  {-r, -r, 0.8f * r},
                                                  {-r, -0.1f * r, -r},
                                                  {0, 1.1f * r, 0},
                                                  {0, -1.1f * r, 0}});
  }
  return def;
}

struct Held {
  int shape = 0;
  float r = 0.03f;      // m
  float block = 0.05f;  // kg
  float jaw = 0.05f;    // kg
  float force = 60.0f;  // N
  float speed = 0.2f;   // m/s, of the motor
  float friction = 0.5f;
};

// Draws all but the shape.
Held draw(Dice& dice, int shape) {
  return {.shape = shape,
          .r = dice.by_factors(0.01f, 0.04f),
          .block = dice.by_factors(0.01f, 0.2f),
          .jaw = dice.by_factors(0.02f, 0.2f),
          .force = dice.by_factors(10.0f, 150.0f),
          .speed = dice.by_factors(0.05f, 2.0f),
          .friction = dice(0.4f, 1.0f)};
}

struct Outcome {
  double depth =
      0.0;  // m, the largest of all steps: by how much the jaws are nearer to each other than the thing is wide
  double fastest = 0.0;  // m/s, of the held thing, against the hand
  double slip = 0.0;     // m, of the held thing against the hand, at the end
};

ShapeDef plate(Vec3 half_extents, float friction) {
  ShapeDef def;
  def.geometry = Box{half_extents};
  def.material = surface(friction);
  return def;
}

BodyId add_jaw(World& world, const Held& held, BodyId hand, double side) {
  BodyDef def{.pose = {.position = {side * (double(held.r) + 0.01), 0, 0}}};
  def.mass = held.jaw;
  const BodyId jaw = world.add_body(def, plate({0.01f, 0.06f, 0.06f}, held.friction));
  world.add_joint(SliderDef{.a = hand,
                            .b = jaw,
                            .anchor = def.pose.position,
                            .axis = {float(-side), 0, 0},
                            .motor = {.target_velocity = held.speed, .max_force = held.force}});
  return jaw;
}

BodyId add_thing(World& world, const Held& held) {
  BodyDef def;
  def.mass = held.block;
  return world.add_body(def, make_shape(held.shape, held.r, held.friction));
}

void watch(Outcome& out, const World& world, BodyId thing, DVec3 hand_velocity) {
  out.fastest = std::max(out.fastest, length(DVec3(world.linear_velocity(thing)) - hand_velocity));
}

// A jaw on a motor presses the thing on a fixed one. Nothing weighs anything.
Outcome press(const Held& held) {
  World world = weightless();
  BodyDef anvil{.type = BodyType::fixed, .pose = {.position = {-double(held.r) - 0.01, 0, 0}}};
  world.add_body(anvil, plate({0.01f, 0.06f, 0.06f}, held.friction));
  const BodyId jaw = add_jaw(world, held, {}, 1.0), thing = add_thing(world, held);
  Outcome out;
  for (int i = 0; i < 60; ++i) {
    world.step(kStep);
    out.depth = std::max(out.depth, double(held.r) + 0.01 - world.pose(jaw).position.x);
    watch(out, world, thing, {});
  }
  out.slip = length(to_float(world.pose(thing).position));
  return out;
}

// Two jaws on motors of a hand that rises hold the thing against its weight.
Outcome lift(const Held& held) {
  constexpr double kRise = 0.2;  // m/s
  World world = make_world();
  BodyDef def{.type = BodyType::kinematic,
              .pose = {.position = {0, 0.3, 0}},
              .linear_velocity = {0, float(kRise), 0}};
  const BodyId hand = world.add_body(def, plate({0.15f, 0.02f, 0.05f}, held.friction));
  const BodyId jaws[2] = {add_jaw(world, held, hand, -1.0), add_jaw(world, held, hand, 1.0)};
  const BodyId thing = add_thing(world, held);
  Outcome out;
  for (int i = 0; i < 60; ++i) {
    world.step(kStep);
    const double apart = world.pose(jaws[1]).position.x - world.pose(jaws[0]).position.x;
    out.depth = std::max(out.depth, 2.0 * double(held.r) + 0.02 - apart);
    if (i > 0) watch(out, world, thing, {0, kRise, 0});
  }
  out.slip = world.pose(hand).position.y - 0.3 - world.pose(thing).position.y;
  return out;
}

// m: what iterated contacts let through. In a half-step h a force F moves a block of mass m by F h^2 / m, and one of twenty iterations by a
// twentieth of it. Springs of contacts and rounding add 0.3 mm at most.
double depth_bound(const Held& held) {
  constexpr double kHalfStep = 1.0 / 480.0;
  return 3e-4 + double(held.force) * kHalfStep * kHalfStep / (20.0 * double(held.block));
}

std::string describe(const Held& held) {
  char text[160];
  std::snprintf(text, sizeof text, "%s of %.0f mm and %.0f g, jaws of %.0f g, %.0f N at %.2f m/s",
                kShapeNames[held.shape], 2e3 * double(held.r), 1e3 * double(held.block),
                1e3 * double(held.jaw), double(held.force), double(held.speed));
  return text;
}

void expect_held(const Held& held, double depth) {
  const std::string name = describe(held);
  const Outcome pressed = press(held), lifted = lift(held);
  EXPECT_TRUE(limit_row((name + ": entered (m)").c_str(), pressed.depth, depth, 0.2 * depth));
  EXPECT_TRUE(limit_row((name + ": entered as it is lifted (m)").c_str(), lifted.depth, depth, 0.2 * depth));
  // Until a motor has reached its force, it leaves a jaw at its own speed as a step ends. Nothing is faster.
  EXPECT_LT(pressed.fastest, double(held.speed) + 0.05) << name;
  EXPECT_LT(lifted.fastest, double(held.speed) + 0.05) << name;
  EXPECT_LT(pressed.slip, 5e-4) << name;
  EXPECT_LT(std::fabs(lifted.slip), 5e-4) << name;
}

// Robot hands enter what they hold by half a millimetre at most, whatever the shape.
TEST(Vise, HoldsLightThingsHard) {
  for (int shape = 0; shape < kShapes; ++shape) {
    for (const float jaw : {1.0f, 4.0f}) {
      expect_held({.shape = shape, .block = 0.05f, .jaw = jaw * 0.05f, .force = 60.0f}, 5e-4);
      expect_held({.shape = shape, .block = 0.01f, .jaw = jaw * 0.01f, .force = 30.0f}, 5e-4);
      expect_held({.shape = shape, .block = 0.01f, .jaw = jaw * 0.01f, .force = 10.0f}, 5e-4);
    }
  }
}

TEST(Vise, HoldsWhatIsDrawn) {
  Dice dice(7);
  for (int i = 0; i < 4 * kShapes; ++i) {
    const Held held = draw(dice, i % kShapes);
    expect_held(held, depth_bound(held));
  }
}

}  // namespace
}  // namespace gyre::laws::vise_test
