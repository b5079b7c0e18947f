// Cloths and solids that cross when they begin, or were forced to: they are told, and part without a gain of energy or momentum.
#include "determinism/scenes.h"
#include "soft/contact/surface_crossings.h"

#include <gyre/gyre.h>
#include <gyre/replay.h>

#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <string>

namespace gyre::soft_untangling_test {
namespace {

constexpr float kStep = 1.0f / 60.0f;
constexpr double kSize = 0.5;  // m, of a sheet
constexpr double kHalfRoot = 0.7071067811865476;

World make_world(Vec3 gravity = {}, int threads = 1) {
  WorldDef def;
  def.gravity = gravity;
  def.threads = threads;
  return std::move(*World::create(def));
}

// A sheet whose vertices are where `place` puts those of a square about the origin.
SoftId add_sheet(World& world, int cells, const std::function<DVec3(double, double)>& place) {
  ClothDef def;
  def.grid = ClothGrid{{float(kSize), float(kSize)}, {cells, cells}};
  def.settings.damping = 1.0e-3f;
  for (int j = 0; j <= cells; ++j) {
    for (int i = 0; i <= cells; ++i) {
      def.settings.positions.push_back(
          place(kSize * (double(i) / cells - 0.5), kSize * (double(j) / cells - 0.5)));
    }
  }
  return world.add_cloth(def);
}
SoftId add_flat(World& world, int cells) {
  return add_sheet(world, cells, [](double x, double z) { return DVec3{x, 0, z}; });
}

double energy_of(const World& world) {
  const Energy energy = world.energy();
  return energy.kinetic + energy.potential + energy.elastic + energy.soft_elastic;
}

struct Separation {
  int steps = 0;         // until there were no crossings
  double gain = 0.0;     // J, at most, beyond the energy of the start

};

// Steps until nothing crosses, and then for a second in which nothing may.
Separation untangle(World& world, int most_steps) {
  Separation run;
  const double start = energy_of(world);
  EXPECT_GT(world.cloth_crossings(), 0u);
  while (world.cloth_crossings() > 0 && run.steps < most_steps) {
    world.step(kStep);
    ++run.steps;
    run.gain = std::max(run.gain, energy_of(world) - start);
  }
  for (int n = 0; n < 60; ++n) {
    world.step(kStep);
    run.gain = std::max(run.gain, energy_of(world) - start);
    EXPECT_EQ(world.cloth_crossings(), 0u) << n;
  }
  return run;
}

// The work of separation: the kinetic energy of both sheets at the speed of untangling, 0.4 times that of a fall from the length of an edge.
double most_gain(int cells) {
  const double speed = 0.4 * std::sqrt(9.81 * kSize / cells);
  return 0.5 * 0.1 * speed * speed;
}

TEST(SoftUntangling, ACornerThroughASheet) {
  for (const Vec3 gravity : {Vec3{}, Vec3{0, -9.81f, 0}}) {
    for (const int cells : {5, 10, 17}) {
      World world = make_world(gravity);
      add_flat(world, cells);
      add_sheet(world, cells, [](double x, double y) {
        return DVec3{kHalfRoot * (x - y), kHalfRoot * (x + y) + kSize * kHalfRoot - 0.1, 0.013};
      });
      const Separation run = untangle(world, 60);
      EXPECT_LT(run.gain, most_gain(cells)) << cells;
    }
  }
}

TEST(SoftUntangling, ASheetThroughAnotherByHalfACell) {
  for (const int cells : {5, 10, 17}) {
    World world = make_world();
    add_flat(world, cells);
    add_sheet(world, cells, [&](double x, double y) {
      return DVec3{0.97 * x, y + 0.5 * kSize - 0.5 * kSize / cells, 0.1 * x + 0.003};
    });
    const Separation run = untangle(world, 30);
    EXPECT_LT(run.gain, most_gain(cells)) << cells;
  }
}

// Its half goes back through the other half, 4 cm behind the fold.
TEST(SoftUntangling, AFoldedSheetThroughItself) {
  for (const int cells : {10, 17}) {
    World world = make_world();
    add_sheet(world, cells, [](double x, double z) {
      const double r = 0.04, arc = 3.14159265 * r;
      if (x < 0) return DVec3{x, 0, z};
      if (x < arc) return DVec3{r * std::sin(x / r), r - r * std::cos(x / r), z};
      return DVec3{-0.5 * (x - arc), 2 * r - 0.866 * (x - arc), 0.98 * z};
    });
    const Separation run = untangle(world, 30);
    EXPECT_LT(run.gain, most_gain(cells)) << cells;
  }
}

// The line of intersection begins at the rim of one and ends at the rim of the other: no side of either is the wrong one.
TEST(SoftUntangling, SheetsThatGripEachOther) {
  for (const int cells : {5, 10}) {
    World world = make_world();
    add_flat(world, cells);
    add_sheet(world, cells, [](double x, double y) { return DVec3{x + 0.35, y, 0.013}; });
    const Separation run = untangle(world, 60);
    EXPECT_LT(run.gain, most_gain(cells)) << cells;
  }
}

TEST(SoftUntangling, SolidsThatOverlap) {
  World world = make_world();
  std::vector<SoftId> ids;
  for (int k = 0; k < 2; ++k) {
    SolidDef def;
    def.box = SolidBox{{0.1f, 0.1f, 0.1f}, {4, 4, 4}};
    def.young_modulus = 1.0e5f;
    def.density = 200.0f;
    def.pose.position = {0.13 * k, 0.14 * k, 0.11 * k};
    ids.push_back(world.add_solid(def));
  }
  world.step(kStep);
  EXPECT_FALSE(world.problems().empty());
  for (int n = 0; n < 30; ++n) world.step(kStep);
  EXPECT_TRUE(world.problems().empty());
}

// Nothing but the sheets pushes the sheets.
TEST(SoftUntangling, KeepsMomentum) {
  World world = make_world();
  add_flat(world, 10);
  add_sheet(world, 10, [](double x, double y) {
    return DVec3{kHalfRoot * (x - y), kHalfRoot * (x + y) + kSize * kHalfRoot - 0.1, 0.013};
  });
  for (int n = 0; n < 60; ++n) world.step(kStep);
  const Momentum after = world.momentum();
  const double scale = 0.1 * 0.28;  // kg m/s: both at the speed of untangling
  EXPECT_LT(length(DVec3(after.linear)), 1.0e-4 * scale);
  EXPECT_LT(length(DVec3(after.angular)), 1.0e-2 * scale * kSize);
}

// A sheet is drawn down through another that is pinned at every vertex: it crosses for as long as it is forced to.
TEST(SoftUntangling, AForcedCrossingStaysUntilItIsFree) {
  const int cells = 10;
  World world = make_world();
  const SoftId net = add_flat(world, cells);
  for (int vertex = 0; vertex < (cells + 1) * (cells + 1); ++vertex) world.pin(net, vertex);
  const SoftId drawn =
      add_sheet(world, cells, [](double x, double y) { return DVec3{0.98 * x, y + 0.3, 0.013}; });
  const BodyId bar = world.add_body({.type = BodyType::kinematic, .pose = {{0, 2, 0}}},
                                    ShapeDef{.geometry = Sphere{0.01f}});
  for (int i = 0; i <= cells; ++i) ASSERT_TRUE(world.attach(drawn, i, bar));
  for (int n = 0; n < 120; ++n) {
    if (n < 60) world.move_kinematic(bar, {{0, 2 - 0.1 * (n + 1) / 60.0, 0}}, kStep);
    world.step(kStep);
  }
  EXPECT_GT(world.cloth_crossings(), 0u);
  EXPECT_FALSE(world.problems().empty());
  for (int i = 0; i <= cells; ++i) ASSERT_TRUE(world.release(drawn, i));
  untangle(world, 60);
}

// Both are held by all their vertices: the crossing is told in each step, and after ten seconds that it did not go.
TEST(SoftUntangling, WhatCannotPartIsTold) {
  World world = make_world();
  const SoftId flat = add_flat(world, 4);
  const SoftId upright = add_sheet(world, 4, [](double x, double y) { return DVec3{x, y + 0.01, 0.013}; });
  for (int i = 0; i < 25; ++i) world.pin(flat, i), world.pin(upright, i);
  for (int n = 0; n < 10 * 60 + 5; ++n) {
    world.step(kStep);
    ASSERT_EQ(world.problems().size(), 2u) << n;
    const std::string message = world.problems()[0].message;
    const bool is_late = message.find("could not be untangled") != std::string::npos;
    if (n < 595 || n > 602) {
      EXPECT_EQ(is_late, n > 600) << n << message;
    }
    EXPECT_EQ(world.problems()[0].severity, Severity::warning);
  }
}

// Vertices that are set across a sheet are found, as are those of a snapshot that crosses: it goes on with the same bits.
TEST(SoftUntangling, SnapshotsAndThreadsDoNotChangeABit) {
  std::uint64_t hash = 0;
  for (const int threads : {1, 2, 8}) {
    World world = make_world({}, threads);
    add_flat(world, 8);
    const SoftId other = add_sheet(world, 8, [](double x, double y) { return DVec3{x, y + 0.5, 0.013}; });
    for (int n = 0; n < 3; ++n) world.step(kStep);
    EXPECT_TRUE(world.problems().empty());
    const SoftVertices v = world.vertices(other);
    std::vector<DVec3> places;
    for (std::size_t i = 0; i < v.size(); ++i) places.push_back(v.position(i) + DVec3{0, -0.3, 0});
    ASSERT_TRUE(world.set_vertices(other, places, {}));
    world.step(kStep);
    EXPECT_FALSE(world.problems().empty());
    const std::vector<std::byte> saved = save_snapshot(world);
    World loaded = make_world({}, threads);
    ASSERT_TRUE(restore_snapshot(loaded, saved).ok());
    for (int n = 0; n < 20; ++n) world.step(kStep), loaded.step(kStep);
    EXPECT_EQ(world.hash(), loaded.hash());
    if (threads > 1) {
      EXPECT_EQ(world.hash(), hash);
    }
    hash = world.hash();
  }
}

}  // namespace
}  // namespace gyre::soft_untangling_test
