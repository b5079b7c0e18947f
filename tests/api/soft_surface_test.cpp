// Solids made of a closed surface, through the public calls: added, read, saved and loaded, and refused with a reason.
#include <gyre/gyre.h>
#include <gyre/replay.h>

#include "determinism/scenes.h"
#include "soft/mesh/tetrahedral_fill_test_meshes.h"

#include <gtest/gtest.h>

#include <string>
#include <vector>

namespace gyre::soft_surface_test {
namespace {

SolidDef ball_def(int resolution) {
  const TestMesh mesh = ball_mesh(3);
  SolidDef def;
  def.surface = SolidSurface{mesh.vertices, mesh.indices, resolution};
  def.pose.position = {0, 5, 0};
  return def;
}
std::vector<DVec3> surface_of(const World& world, SoftId soft) {
  std::vector<DVec3> places(world.soft_surface(soft, {}));
  EXPECT_EQ(world.soft_surface(soft, places), places.size());
  return places;
}
World new_world() {
  Result<World> made = World::create(WorldDef{});
  return std::move(*made);
}

TEST(SoftSurface, CanBeReadAndSaved) {
  World world = new_world();
  const SoftId ball = world.add_solid(ball_def(8));
  ASSERT_TRUE(world.exists(ball));
  const std::vector<DVec3> places = surface_of(world, ball);
  ASSERT_EQ(places.size(), ball_def(8).surface->vertices.size());
  for (std::size_t i = 0; i < places.size(); ++i)
    EXPECT_LT(length(places[i] - DVec3{0, 5, 0} - DVec3(ball_def(8).surface->vertices[i])), 1.0e-6);
  EXPECT_EQ(world.soft_surface_triangles(ball).size(), ball_def(8).surface->triangles.size());
  EXPECT_NEAR(world.soft_info(ball).mass, 1000.0 * ball_mesh(3).volume(), 0.5);

  std::vector<DVec3> moved;
  const SoftVertices vertices = world.vertices(ball);
  for (std::size_t i = 0; i < vertices.size(); ++i) moved.push_back(2.0 * vertices.position(i));
  ASSERT_TRUE(world.set_vertices(ball, moved, {}));
  const std::vector<std::byte> saved = save_snapshot(world);
  Result<World> loaded = load_snapshot(saved);
  ASSERT_TRUE(loaded) << loaded.error().message;
  SoftId same;
  ASSERT_EQ(loaded->softs(std::span(&same, 1)), 1u);
  EXPECT_TRUE(surface_of(*loaded, same) == surface_of(world, ball));
  EXPECT_LT(length(surface_of(world, ball)[7] - 2.0 * places[7]), 1.0e-5);
  EXPECT_EQ(loaded->hash(), world.hash());
}

// Under its own weight a ball flattens a little; its fine surface stays above the ground, and it comes to rest.
TEST(SoftSurface, LiesOnTheGround) {
  World world = new_world();
  scenes::add_fixed(world, {0, 0, 0}, Plane{});
  SolidDef def = ball_def(6);
  def.pose.position = {0, 1.1, 0};
  def.young_modulus = 5.0e5f;
  def.poisson_ratio = 0.3f;
  def.settings.damping = 0.02f;
  const SoftId ball = world.add_solid(def);
  ASSERT_TRUE(world.exists(ball));
  const double potential = world.soft_info(ball).mass * 9.81;
  for (int i = 0; i < 150; ++i) world.step(1.0f / 60.0f);
  double low = 1.0e300, high = -1.0e300;
  for (const DVec3 p : surface_of(world, ball)) {
    low = min(low, p.y);
    high = max(high, p.y);
  }
  EXPECT_GT(low, -0.05);
  EXPECT_LT(low, 0.05);
  EXPECT_GT(high, 1.6);
  EXPECT_LT(high, 2.05);
  EXPECT_LT(world.soft_info(ball).kinetic_energy, 1.0e-3 * potential);
}

TEST(SoftSurface, IsThatOfFilledSolidsAlone) {
  World world = new_world();
  const SoftId box = world.add_solid({.box = SolidBox{}});
  ASSERT_TRUE(world.exists(box));
  EXPECT_EQ(world.soft_surface(box, {}), 0u);
  EXPECT_TRUE(world.soft_surface_triangles(box).empty());
  EXPECT_EQ(world.soft_surface(SoftId{}, {}), 0u);
}

TEST(SoftSurface, IsRefusedWithAReason) {
  World world = new_world();
  SolidDef open = ball_def(8);
  open.surface->triangles.resize(open.surface->triangles.size() - 3);
  EXPECT_FALSE(world.exists(world.add_solid(open)));
  ASSERT_FALSE(world.problems().empty());
  EXPECT_NE(std::string(world.problems().back().message).find("is open (triangles with it: 1)"),
            std::string::npos);
}

}  // namespace
}  // namespace gyre::soft_surface_test
