// Cloths that fall on themselves, on each other and on shapes, in a world: no crossing, judged exactly.
#include "determinism/scenes.h"
#include "soft/contact/surface_crossings.h"

#include <gyre/gyre.h>
#include <gyre/replay.h>

#include <gtest/gtest.h>

#include <cmath>

namespace gyre::soft_surfaces_test {
namespace {

constexpr float kStep = 1.0f / 60.0f;

World make_world(int threads = 1) {
  WorldDef def;
  def.threads = threads;
  World world = std::move(*World::create(def));
  scenes::add_fixed(world, {0, 0, 0}, Plane{});
  return world;
}

SoftId add_sheet(World& world, float size, int cells, DVec3 at, float thickness = 0.01f,
                 float damping = 1.0e-3f) {
  ClothDef def;
  def.grid = ClothGrid{{size, size}, {cells, cells}};
  def.pose.position = at;
  def.thickness = thickness;
  def.settings.damping = damping;
  return world.add_cloth(def);
}

// Crossings of all cloths and solids.
long crossings(const World& world) {
  std::vector<SoftId> ids(std::size_t(world.stats().softs));
  world.softs(ids);
  Array<SoftSurface> surfaces;
  Array<PlacedSurface> placed;
  Array<DVec3> positions;
  for (const SoftId id : ids) {
    const SoftVertices v = world.vertices(id);
    const std::size_t first = positions.size();
    for (std::size_t i = 0; i < v.size(); ++i) positions.push_back(v.position(i));
    if (world.soft_triangles(id).empty()) continue;
    surfaces.push_back(make_surface(positions.view().subspan(first), world.soft_triangles(id), 0.0f));
    placed.push_back({nullptr, std::uint32_t(first)});
  }
  for (std::size_t i = 0; i < placed.size(); ++i) placed[i].surface = &surfaces[i];
  Arena arena;
  return count_crossings(placed, positions, arena);
}

double height_of(const World& world, SoftId id) {
  const SoftVertices v = world.vertices(id);
  double sum = 0.0;
  for (std::size_t i = 0; i < v.size(); ++i) sum += v.y[i];
  return sum / double(v.size());
}

double energy_of(const World& world) {
  const Energy energy = world.energy();
  return energy.kinetic + energy.potential + energy.elastic + energy.soft_elastic;
}

TEST(SoftSurfaces, ASheetFallsOverABallOntoTheGround) {
  World world = make_world();
  scenes::add_fixed(world, {0, 0.15, 0}, Sphere{0.15f});
  add_sheet(world, 1.0f, 20, {0.03, 0.4, 0.02});
  for (int n = 0; n < 90; ++n) {
    world.step(kStep);
    ASSERT_EQ(crossings(world), 0) << n;
  }
}

// Large sheets fall over a ball and fold, their rims at 4 m/s, three quarters of an edge in a sub-step: energy only ever falls.
TEST(SoftSurfaces, SheetsThatFallAndFoldGainNoEnergy) {
  struct Drawn {
    int cells;
    double x, z;
    float radius;
  };
  for (const Drawn drawn : {Drawn{24, 0, 0, 0.25f}, Drawn{21, 0.11, 0.07, 0.2f}}) {
    World world = std::move(*World::create(WorldDef{}));
    scenes::add_fixed(world, {0, -1, 0}, Box{{20, 1, 20}});
    scenes::add_fixed(world, {0, 0.5, 0}, Sphere{drawn.radius});
    add_sheet(world, 2.0f, drawn.cells, {drawn.x, 0.9, drawn.z}, 0.005f, 0.0f);
    const double start = energy_of(world);
    double least = start;
    for (int n = 0; n < 40; ++n) {
      world.step(kStep);
      ASSERT_EQ(crossings(world), 0) << n;
      const double now = energy_of(world);
      EXPECT_LT(now, least + 0.01 * start) << drawn.cells << " " << n;
      least = std::min(least, now);
    }
    EXPECT_LT(least, 0.5 * start);
  }
}

TEST(SoftSurfaces, TenSheetsFallOnEachOther) {
  World world = make_world();
  std::vector<SoftId> sheets;
  for (int k = 0; k < 10; ++k)
    sheets.push_back(add_sheet(world, 0.5f, 7, {0.011 * k, 0.02 + 0.02 * k, 0.007 * k}));
  for (int n = 0; n < 90; ++n) {
    world.step(kStep);
    ASSERT_EQ(crossings(world), 0) << n;
  }
  // They lie in their order, about a thickness apart.
  for (std::size_t k = 1; k < sheets.size(); ++k) {
    EXPECT_GT(height_of(world, sheets[k]), height_of(world, sheets[k - 1]) + 0.005) << k;
  }
  EXPECT_LT(height_of(world, sheets.back()), 0.15);
}

// A solid falls on a sheet that hangs by its corners, and stays on it.
TEST(SoftSurfaces, ASolidLiesOnASheet) {
  World world = make_world();
  const SoftId sheet = add_sheet(world, 1.0f, 10, {0, 1, 0});
  for (const int corner : {0, 10, 110, 120}) ASSERT_TRUE(world.pin(sheet, corner));
  SolidDef def;
  def.box = SolidBox{{0.1f, 0.1f, 0.1f}, {3, 3, 3}};
  def.pose.position = {0.02, 1.15, 0.01};
  def.density = 100.0f;
  const SoftId solid = world.add_solid(def);
  for (int n = 0; n < 120; ++n) {
    world.step(kStep);
    ASSERT_EQ(crossings(world), 0) << n;
  }
  EXPECT_GT(height_of(world, solid), 0.5);
}

TEST(SoftSurfaces, ThreadsDoNotChangeABit) {
  std::uint64_t hash = 0;
  for (const int threads : {1, 2, 8}) {
    World world = make_world(threads);
    scenes::add_fixed(world, {0, 0.1, 0}, Sphere{0.1f});
    for (int k = 0; k < 3; ++k) add_sheet(world, 0.5f, 8, {0.01 * k, 0.25 + 0.03 * k, 0.01 * k});
    for (int n = 0; n < 30; ++n) world.step(kStep);
    const std::uint64_t now = world.hash();
    if (threads > 1) {
      EXPECT_EQ(now, hash) << threads;
    }
    hash = now;
  }
}

// Without it, a sheet folded onto itself passes through itself.
TEST(SoftSurfaces, SelfCollisionCanBeSwitchedOff) {
  for (const bool on : {true, false}) {
    World world = make_world();
    const int cells = 10;
    ClothDef def;
    def.grid = ClothGrid{{1.0f, 0.5f}, {cells, cells}};
    def.self_collision = on;
    def.settings.damping = 1.0e-3f;
    for (int j = 0; j <= cells; ++j) {
      for (int i = 0; i <= cells; ++i) {
        const double x = double(i) / cells - 0.5;
        def.settings.positions.push_back(
            {0.3 * x, 1.0 - 0.95 * std::fabs(x), 0.5 * (double(j) / cells - 0.5)});
        // Its halves fly at each other.
        def.settings.velocities.push_back({x > 0.1 ? -2.0f : x < -0.1 ? 2.0f : 0.0f, 0.0f, 0.0f});
      }
    }
    const SoftId sheet = world.add_cloth(def);
    for (int j = 0; j <= cells; ++j) ASSERT_TRUE(world.pin(sheet, cells / 2 + j * (cells + 1)));
    long most = 0;
    for (int n = 0; n < 20; ++n) {
      world.step(kStep);
      most = std::max(most, crossings(world));
    }
    if (on) {
      EXPECT_EQ(most, 0);
    } else {
      EXPECT_GT(most, 0);
    }
  }
}

}  // namespace
}  // namespace gyre::soft_surfaces_test
