// Friction of soft matter on slopes by Coulomb's law: a = g (sin a - mu cos a) with the dynamic coefficient, rest below the static one. Slopes are no
// multiples of right angles, so that no product of the normal's components is exact.
#include "laws/kit.h"

namespace gyre::laws::soft_friction_test {
namespace {

struct Slope {
  double angle;
  Quat turn{0, 0, float(-std::sin(0.5 * angle)), float(std::cos(0.5 * angle))};
  DVec3 down{std::cos(angle), -std::sin(angle), 0}, normal{std::sin(angle), std::cos(angle), 0};
};
World world_with(const Slope& slope, float static_friction, float dynamic_friction) {
  World world = make_world({.sleeping = false});
  BodyDef ground{.type = BodyType::fixed, .pose = {{}, slope.turn}};
  world.add_body(ground,
                 {.geometry = Plane{},
                  .material = {.static_friction = static_friction, .dynamic_friction = dynamic_friction}});
  return world;
}
SoftSettings frictional(float static_friction, float dynamic_friction) {
  SoftSettings settings;
  settings.static_friction = static_friction, settings.dynamic_friction = dynamic_friction;
  return settings;
}
SoftId add_sheet(World& world, const Slope& slope, SoftSettings settings) {
  ClothDef def{.grid = ClothGrid{{0.4f, 0.4f}, {6, 6}}, .thickness = 0.01f};
  def.pose = {0.005 * slope.normal, slope.turn};
  def.settings = settings;
  return world.add_cloth(def);
}
SoftId add_block(World& world, const Slope& slope, double size, float young, SoftSettings settings) {
  SolidDef def{.box = SolidBox{{float(2 * size), float(size), float(2 * size)}, {4, 2, 4}},
               .young_modulus = young,
               .poisson_ratio = 0.3f};
  def.pose = {size * slope.normal, slope.turn};
  def.settings = settings;
  return world.add_solid(def);
}
// Along the slope, of the middle vertex: m/s.
double speed_of(const World& world, SoftId soft, const Slope& slope) {
  const SoftVertices v = world.vertices(soft);
  return dot(wide(v.velocity(v.size() / 2)), slope.down);
}
double acceleration(World& world, SoftId soft, const Slope& slope) {
  run(world, 0.5);
  const double before = speed_of(world, soft, slope);
  run(world, 1.0);
  return speed_of(world, soft, slope) - before;
}
double exact_acceleration(const Slope& slope, double friction) {
  return kGravity * (std::sin(slope.angle) - friction * std::cos(slope.angle));
}

TEST(SoftFriction, FastSheetsAreNotHeldBackMoreThanSlowOnes) {
  const Slope slope{32.0 * double(kDegree)};
  for (const float most : {0.3f, 0.6f}) {
    World world = world_with(slope, most, 0.3f);
    const SoftId sheet = add_sheet(world, slope, frictional(most, 0.3f));
    EXPECT_TRUE(relative_row("S-20 sheet slides by dynamic friction, m/s^2",
                             acceleration(world, sheet, slope), exact_acceleration(slope, 0.3), 2e-2, 5e-3))
        << most;
  }
}
TEST(SoftFriction, StiffBlocksSlide) {
  const Slope slope{30.0 * double(kDegree)};
  struct Case {
    double size;  // m, half of the height
    float young;
  };
  for (const Case c : {Case{0.1, 1.0e7f}, Case{0.01, 1.0e5f}}) {
    World world = world_with(slope, 0.4f, 0.4f);
    const SoftId block = add_block(world, slope, c.size, c.young, frictional(0.4f, 0.4f));
    EXPECT_TRUE(relative_row("S-21 stiff block slides, m/s^2", acceleration(world, block, slope),
                             exact_acceleration(slope, 0.4), 2e-2, 5e-3))
        << c.size << ' ' << c.young;
  }
}
TEST(SoftFriction, StaticFrictionHoldsWhatDynamicFrictionWouldNot) {
  const Slope slope{25.0 * double(kDegree)};  // tan 0.466
  World world = world_with(slope, 0.6f, 0.3f);
  const SoftId block = add_block(world, slope, 0.1, 1.0e6f, frictional(0.6f, 0.3f));
  const DVec3 start = world.vertices(block).position(37);
  run(world, 2.0);
  EXPECT_TRUE(limit_row("S-22 block that static friction holds: way in 2 s, m",
                        length(world.vertices(block).position(37) - start), 1e-3, 5e-4));
}

}  // namespace
}  // namespace gyre::laws::soft_friction_test
