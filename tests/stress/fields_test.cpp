// Fields of any strength on bodies of any weight: whatever the numbers, no body is lost, and the same world comes out with other
// threads and another width.
#include "laws/kit.h"

namespace gyre::laws::fields_test {
namespace {

class Dice {
 public:
  explicit Dice(std::uint32_t seed) : state_(seed * 2654435761u + 1u) {}
  double next() {
    state_ = state_ * 1664525u + 1013904223u;
    return double(state_ >> 8) / 16777216.0;
  }
  float between(double low, double high) { return float(low + (high - low) * next()); }
  // 10 to a power between the two.
  float power(double low, double high) { return float(std::pow(10.0, low + (high - low) * next())); }
  Vec3 vector(double size) {
    const float x = between(-size, size), y = between(-size, size), z = between(-size, size);
    return {x, y, z};
  }

 private:
  std::uint32_t state_;
};

FieldDef any_field(Dice& dice) {
  FieldDef def;
  def.kind = FieldKind(int(dice.next() * 5));
  def.velocity = dice.vector(double(dice.power(-1, 2)));
  def.density = dice.power(-2, 3.3);
  def.drag_coefficient = dice.power(-2, 2);
  def.linear_drag = dice.next() < 0.5 ? 0.0f : dice.power(-2, 3);
  def.turbulence = dice.between(0, 3);
  def.turbulence_length = dice.power(-1, 2);
  def.center = DVec3(dice.vector(5));
  def.strength = dice.power(-1, 3) * (dice.next() < 0.5 ? -1.0f : 1.0f);
  def.radius = dice.power(-1, 1);
  def.falloff = dice.between(-2, 4);
  def.core = dice.next() < 0.5 ? 0.0f : dice.between(0, 1);
  def.axis = dice.vector(1);
  def.normal = {dice.between(-0.5, 0.5), 1, dice.between(-0.5, 0.5)};
  def.offset = double(dice.between(-1, 2));
  return def;
}

AnyShape any_shape(Dice& dice) {
  const float a = dice.power(-2, 0), b = dice.power(-2, 0), c = dice.power(-2, 0);
  switch (int(dice.next() * 5)) {
    case 0:
      return Sphere{a};
    case 1:
      return Box{{a, b, c}};
    case 2:
      return Capsule{a, b};
    case 3:
      return Cylinder{a, b};
    default:
      return Cone{a, b};
  }
}

std::uint64_t run_world(std::uint32_t seed, int threads, int width) {
  Dice dice(seed);
  WorldDef def;
  def.threads = threads;
  def.simd_width = width;
  def.stepping.substeps = 1 + int(dice.next() * 4);
  World world = make_world(def);
  add_ground(world);
  for (int i = 0; i < 4; ++i) EXPECT_TRUE(bool(world.add_field(any_field(dice))));
  for (int i = 0; i < 24; ++i) {
    BodyDef body;
    body.pose = {DVec3(dice.vector(4)) + DVec3{0, 4, 0},
                 normalized(Quat{dice.between(-1, 1), dice.between(-1, 1), dice.between(-1, 1), 1})};
    body.linear_velocity = dice.vector(double(dice.power(-1, 2)));
    body.angular_velocity = dice.vector(double(dice.power(-1, 2)));
    body.locked.linear[0] = dice.next() < 0.1;
    body.locked.angular[2] = dice.next() < 0.1;
    world.add_body(body, {.geometry = any_shape(dice), .density = dice.power(0, 4)});
  }
  for (int i = 0; i < 90; ++i) {
    if (i % 30 == 10) world.explode({.center = DVec3(dice.vector(3)), .pressure = dice.power(0, 4)});
    world.step(kStep);
    for (const Problem& problem : world.problems())
      ADD_FAILURE() << "seed " << seed << " step " << i << ": " << problem.message;
    if (::testing::Test::HasFailure()) break;
  }
  return world.hash();
}

TEST(FieldStress, NoBodyIsLostWhateverTheNumbers) {
  for (std::uint32_t seed = 1; seed <= 30 && !HasFailure(); ++seed) {
    const std::uint64_t hash = run_world(seed, 1, 0);
    if (seed % 10 == 0) {
      EXPECT_EQ(run_world(seed, 3, 1), hash) << seed;
    }
  }
}

}  // namespace
}  // namespace gyre::laws::fields_test
