// Pieces of broken solids: they lie on each other and do not cross, and contact gives no energy.
#include <gyre/gyre.h>
#include <gyre/replay.h>

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <map>
#include <utility>

namespace gyre::soft_pieces_test {
namespace {

constexpr float kStep = 1.0f / 60.0f;

// A plate of 77 kg falls from 55 cm on a rod. With a substep of 1/480 s its stiffness is within what contacts of solids follow.
World make_world(int threads = 1, int width = 0) {
  WorldDef def;
  def.threads = threads;
  def.simd_width = width;
  def.stepping.substeps = 8;
  World world = std::move(*World::create(def));
  world.add_body({.type = BodyType::fixed}, ShapeDef{.geometry = Plane{{0, 1, 0}, 0}});
  world.add_body({.type = BodyType::fixed, .pose = {{0, 0.4, 0}, {0.7071068f, 0, 0, 0.7071068f}}},
                 ShapeDef{.geometry = Cylinder{0.05f, 0.6f}});
  return world;
}
SoftId add_plate(World& world) {
  SolidDef plate;
  plate.box = SolidBox{{0.6f, 0.04f, 0.4f}, {8, 2, 5}};
  plate.pose = {{0.02, 1.0, 0.01}, {0, 0, 0.02f, 0.9998f}};
  plate.young_modulus = 1.0e6f, plate.poisson_ratio = 0.3f;
  plate.fracture_stress = 1.3e4f;
  plate.settings.damping = 0.005f;
  return world.add_solid(plate);
}
double energy_of(const World& world) {
  const Energy energy = world.energy();
  return energy.kinetic + energy.potential + energy.elastic + energy.soft_elastic;
}

TEST(SoftPieces, APlateThatBreaksOverARodLiesInAHeap) {
  World world = make_world();
  const SoftId plate = add_plate(world);
  const double mass = world.soft_info(plate).mass, start = energy_of(world);
  const std::size_t whole = world.vertices(plate).size();
  double before = start, gained = 0.0;
  for (int n = 0; n < 180; ++n) {
    world.step(kStep);
    ASSERT_EQ(world.cloth_crossings(), 0u) << n;
    const double now = energy_of(world);
    gained += std::max(0.0, now - before);
    before = now;
  }
  EXPECT_GT(world.vertices(plate).size(), whole + 30);
  // Contacts give back nothing, but parts that are moved apart stretch what is around them.
  EXPECT_LT(gained, 1.0e-3 * start);
  EXPECT_EQ(world.soft_info(plate).mass, mass);
  // The heap rests: less than 0.01 J of 750 J are left in motion, and nothing is in the ground.
  EXPECT_LT(world.energy().kinetic, 0.01);
  const SoftVertices v = world.vertices(plate);
  for (std::size_t i = 0; i < v.size(); ++i) EXPECT_GT(v.y[i], -1.0e-3);
}

// Bars that are held at an end break under their weight, and their pieces fall. What is still in a crack lies in each other, and flies on as it is.
TEST(SoftPieces, PiecesThatFallGainNoEnergy) {
  for (int k = 0; k < 12; ++k) {
    WorldDef def;
    def.gravity = {0, -30, 0};
    World world = std::move(*World::create(def));
    SolidDef bar;
    bar.box = SolidBox{{0.5f, 0.1f, 0.1f}, {8, 2, 2}};
    bar.pose = {{0, 5, 0}, {}};
    bar.young_modulus = 2.0e4f * (1.0f + 0.05f * float(k));
    bar.fracture_stress = 1000.0f - 20.0f * float(k);
    const SoftId id = world.add_solid(bar);
    const std::size_t whole = world.vertices(id).size();
    for (int v = 0; v < int(whole); ++v)
      if (world.vertices(id).x[v] < -0.3) world.pin(id, v);
    const double start = energy_of(world);
    for (int n = 0; n < 60; ++n) {
      world.step(kStep);
      ASSERT_LT(energy_of(world), 1.0001 * start) << k << " " << n;
    }
    EXPECT_GT(world.vertices(id).size(), whole + 30);
  }
}

// Where a vertex that is held splits, the other parts move away from the one that stays.
TEST(SoftPieces, ABeamThatBreaksAtItsClampDoesNotCrossItself) {
  for (const std::array<int, 3> cells : {std::array{6, 2, 3}, std::array{10, 2, 4}, std::array{5, 1, 2}}) {
    World world = std::move(*World::create());
    SolidDef beam;
    beam.box = SolidBox{{0.5f, 0.1f, 0.2f}, cells};
    beam.young_modulus = 4.0e5f, beam.fracture_stress = 9.0e3f;
    const SoftId id = world.add_solid(beam);
    const std::size_t whole = world.vertices(id).size();
    for (int v = 0; v < int(whole); ++v)
      if (world.vertices(id).x[v] < -0.45) world.pin(id, v);
    for (int n = 0; n < 60; ++n) {
      world.step(kStep);
      ASSERT_EQ(world.cloth_crossings(), 0u) << cells[0] << " " << n;
    }
    EXPECT_GT(world.vertices(id).size(), whole);
    EXPECT_TRUE(world.problems().empty());
  }
}

TEST(SoftPieces, SnapshotsThreadsAndWidthsDoNotChangeABit) {
  std::uint64_t hash = 0;
  for (const auto& [threads, width] : {std::pair{1, 0}, {2, 4}, {3, 1}, {8, 0}}) {
    World world = make_world(threads, width);
    add_plate(world);
    for (int n = 0; n < 30; ++n) world.step(kStep);
    World loaded = make_world(threads, width);
    ASSERT_TRUE(restore_snapshot(loaded, save_snapshot(world)).ok());
    for (int n = 0; n < 15; ++n) world.step(kStep), loaded.step(kStep);
    EXPECT_EQ(world.hash(), loaded.hash());
    if (threads > 1) {
      EXPECT_EQ(world.hash(), hash);
    }
    hash = world.hash();
  }
}

// Legs of 8 cells of 5 cm on a bridge of 5 x 2 cells, with a gap of one cell between them, and each two cells thick. They swing towards each other.
SolidDef make_fork(float speed) {
  constexpr int kColumns = 5, kRows = 10, kLayers = 2, kBridge = 2;
  SolidDef fork;
  std::map<std::array<int, 3>, std::uint32_t> numbers;
  const auto vertex = [&](const std::array<int, 3>& at) {
    const auto [found, is_new] = numbers.try_emplace(at, std::uint32_t(fork.vertices.size()));
    if (is_new) {
      const float share = float(std::max(at[1] - kBridge, 0)) / float(kRows - kBridge);
      fork.vertices.push_back({0.05f * float(at[0]), 0.05f * float(at[1]), 0.05f * float(at[2])});
      fork.settings.velocities.push_back({2 * at[0] < kColumns ? share * speed : -share * speed, 0, 0});
    }
    return found->second;
  };
  for (int i = 0; i < kColumns; ++i) {
    for (int j = 0; j < kRows; ++j) {
      for (int k = 0; k < kLayers; ++k) {
        if (j >= kBridge && i == kColumns / 2) continue;
        std::array<int, 3> order = {0, 1, 2};
        do {
          std::array<int, 3> at = {i, j, k};
          fork.tetrahedra.push_back(vertex(at));
          for (const int axis : order) ++at[std::size_t(axis)], fork.tetrahedra.push_back(vertex(at));
          const int turns = (order[0] > order[1]) + (order[0] > order[2]) + (order[1] > order[2]);
          if (turns % 2 != 0) std::swap(fork.tetrahedra.end()[-1], fork.tetrahedra.end()[-2]);
        } while (std::next_permutation(order.begin(), order.end()));
      }
    }
  }
  return fork;
}

TEST(SoftPieces, LegsOfOneSolidMeet) {
  for (const float modulus : {5.0e4f, 1.0e6f}) {
    WorldDef def;
    def.gravity = {};
    World world = std::move(*World::create(def));
    SolidDef fork = make_fork(4.0f);
    fork.young_modulus = modulus, fork.poisson_ratio = 0.4f, fork.settings.damping = 0.005f;
    const SoftId solid = world.add_solid(fork);
    const auto is_tip = [&](std::size_t i, float x) {
      return fork.vertices[i] == Vec3{x, 0.05f * 10.0f, 0.05f};
    };
    double before = energy_of(world), gained = 0.0, nearest = 1.0;
    for (int n = 0; n < 60; ++n) {
      world.step(kStep);
      ASSERT_EQ(world.cloth_crossings(), 0u) << n;
      gained += std::max(0.0, energy_of(world) - before);
      before = energy_of(world);
      const SoftVertices v = world.vertices(solid);
      double gap = 0.0;
      for (std::size_t i = 0; i < v.size(); ++i)
        gap += (is_tip(i, 0.05f * 3.0f) - is_tip(i, 0.05f * 2.0f)) * v.x[i];
      nearest = std::min(nearest, gap);
    }
    // They are 5 cm apart at the start.
    EXPECT_LT(nearest, 0.004);
    EXPECT_GT(nearest, 0.0);
    EXPECT_LT(gained, 1.0e-3);
    EXPECT_LT(length(world.momentum().linear), 1.0e-4f);
  }
}

// Two blocks that are rigid within a sub-step: an impulse on a vertex meets the mass of the whole block.
TEST(SoftPieces, StiffSolidsThatStrikeEachOtherGainNoEnergy) {
  for (const float speed : {0.0f, -3.0f}) {
    World world = std::move(*World::create({}));
    world.add_body({.type = BodyType::fixed}, ShapeDef{.geometry = Plane{{0, 1, 0}, 0}});
    for (int k = 0; k < 2; ++k) {
      SolidDef block;
      block.box = SolidBox{{0.3f, 0.1f, 0.3f}, {6, 2, 6}};
      block.pose.position = {0, 0.1, 0};
      block.young_modulus = 1.0e7f, block.poisson_ratio = 0.3f;
      block.settings.damping = 0.005f;
      if (k == 1) {
        block.pose = {{0.13, 0.7, 0.07}, {0.1f, 0.2f, 0.25f, 0.94f}};
        block.settings.velocities.assign(7 * 3 * 7, {0, speed, 0});
      }
      world.add_solid(block);
    }
    const double start = energy_of(world);
    double before = start, gained = 0.0;
    for (int n = 0; n < 120; ++n) {
      world.step(kStep);
      ASSERT_EQ(world.cloth_crossings(), 0u) << n;
      gained += std::max(0.0, energy_of(world) - before);
      before = energy_of(world);
    }
    EXPECT_LT(gained, 0.03 * start) << speed;
  }
}

}  // namespace
}  // namespace gyre::soft_pieces_test
