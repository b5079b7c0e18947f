// The strain that the elements of soft matter tell is that of the motion they are given.
// Sources: A. L. Cauchy, 1827; A. J. C. B. de Saint-Venant, 1855 (principal strains).
#include "laws/soft_kit.h"

#include <cmath>
#include <vector>

namespace gyre::laws::soft_strain_test {
namespace {

// Moves every vertex by an affine map of its place at rest, and turns it.
template <class Map>
void deform(World& world, SoftId soft, Map&& map) {
  const Quat turn = normalized(Quat{0.3f, -0.2f, 0.4f, 0.8f});
  std::vector<DVec3> places;
  for (std::size_t i = 0; i < world.vertices(soft).size(); ++i)
    places.push_back(turned(turn, map(world.vertices(soft).position(i))));
  ASSERT_TRUE(world.set_vertices(soft, places, {}));
}
std::vector<float> strains(const World& world, SoftId soft) {
  std::vector<float> out(world.soft_strain(soft, {}));
  EXPECT_EQ(world.soft_strain(soft, out), out.size());
  return out;
}
double worst_error(const World& world, SoftId soft, double expected) {
  double worst = 0.0;
  for (const float one : strains(world, soft)) worst = std::fmax(worst, std::fabs(double(one) - expected));
  return worst;
}

TEST(SoftStrain, OfARope) {
  for (const RopeLinks links : {RopeLinks::springs, RopeLinks::rods}) {
    World world = weightless();
    const SoftId rope =
        world.add_rope({.points = {{-1, 0, 0}, {0, 1, 0}, {2, 1, 0}}, .segments = 7, .links = links});
    EXPECT_EQ(strains(world, rope).size(), 7u);
    EXPECT_LT(worst_error(world, rope, 0.0), 1e-7);
    deform(world, rope, [](DVec3 p) { return 1.25 * p; });
    EXPECT_TRUE(
        limit_row("S-69 strain of a rope that is drawn: error", worst_error(world, rope, 0.25), 1e-5, 1e-6));
  }
}

TEST(SoftStrain, OfASheet) {
  for (const ClothLinks links : {ClothLinks::springs, ClothLinks::rods, ClothLinks::membrane}) {
    for (const float tear : {0.0f, 3.0f}) {
      World world = weightless();
      ClothDef def{
          .grid = ClothGrid{{2, 1}, {6, 4}}, .links = links, .shear_stiffness = 400.0f, .tear_strain = tear};
      const SoftId sheet = world.add_cloth(def);
      EXPECT_EQ(3 * strains(world, sheet).size(), world.soft_triangles(sheet).size());
      EXPECT_LT(worst_error(world, sheet, 0.0), 1e-6);
      std::vector<DVec3> rest;
      for (std::size_t i = 0; i < world.vertices(sheet).size(); ++i)
        rest.push_back(world.vertices(sheet).position(i));
      const auto told = [&](auto&& map, double expected) {
        deform(world, sheet, map);
        EXPECT_TRUE(limit_row("S-69 strain of a sheet that is drawn, pressed or sheared: error",
                              worst_error(world, sheet, expected), 1e-5, 1e-6));
        ASSERT_TRUE(world.set_vertices(sheet, rest, {}));
      };
      told([](DVec3 p) { return DVec3{1.2 * p.x, p.y, 0.9 * p.z}; }, 0.2);
      told([](DVec3 p) { return DVec3{1.1 * p.x, p.y, 0.7 * p.z}; }, -0.3);
      // A simple shear g stretches by (sqrt(4 + g^2) + g) / 2.
      told([](DVec3 p) { return DVec3{p.x + 0.4 * p.z, p.y, p.z}; }, 0.5 * (std::sqrt(4.16) + 0.4) - 1.0);
      told([](DVec3 p) { return DVec3{0.0 * p.x, p.y, p.z}; }, -1.0);
    }
  }
}

TEST(SoftStrain, OfASolid) {
  for (const SolidModel model : {SolidModel::linear, SolidModel::corotated, SolidModel::neo_hookean}) {
    World world = weightless();
    const SoftId solid = world.add_solid({.box = SolidBox{{0.5f, 0.1f, 0.1f}, {5, 2, 2}}, .model = model});
    EXPECT_EQ(4 * strains(world, solid).size(), world.solid_tetrahedra(solid, {}));
    EXPECT_LT(worst_error(world, solid, 0.0), 1e-6);
    deform(world, solid, [](DVec3 p) { return DVec3{1.2 * p.x, 0.9 * p.y, 0.95 * p.z}; });
    EXPECT_TRUE(
        limit_row("S-69 strain of a bar that is drawn: error", worst_error(world, solid, 0.2), 1e-5, 1e-6));
  }
}

// Torn parts are not strained by their gap.
TEST(SoftStrain, OfWhatHasTorn) {
  World world = weightless();
  const SoftId sheet =
      world.add_cloth({.grid = ClothGrid{{1, 1}, {6, 6}}, .stretch_stiffness = 100.0f, .tear_strain = 0.2f});
  std::vector<Vec3> velocities;
  for (std::size_t i = 0; i < 49; ++i)
    velocities.push_back({world.vertices(sheet).x[i] > 0.05 ? 15.0f : -15.0f, 0, 0});
  ASSERT_TRUE(world.set_vertices(sheet, {}, velocities));
  for (int i = 0; i < 120; ++i) world.step(kStep);
  ASSERT_GT(world.vertices(sheet).size(), 49u);
  EXPECT_EQ(strains(world, sheet).size(), 72u);
  for (const float one : strains(world, sheet)) EXPECT_LT(std::fabs(one), 0.3f);
}

}  // namespace
}  // namespace gyre::laws::soft_strain_test
