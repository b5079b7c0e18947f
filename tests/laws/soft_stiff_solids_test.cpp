// Stiff solids on the ground, on each other and within each other: contact presses them out of shape no further than the fall can, and what begins inside comes out calmly.
#include <gyre/gyre.h>
#include <gyre/replay.h>

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

namespace gyre::soft_stiff_solids_test {
namespace {

// A solid of some cells falls askew on the ground from `height`.
struct Fall {
  SolidModel model = SolidModel::linear;
  float half_extent = 0.0f, height = 0.0f;  // m
  float young_modulus = 0.0f;               // Pa
  int substeps = 1;
};

// Returns the greatest energy, kinetic and elastic, at the end of a step from some steps after the first impact on, over that of the fall.
double energy_after_impact(const Fall& fall) {
  WorldDef def;
  def.stepping.substeps = fall.substeps;
  World world = std::move(*World::create(def));
  world.add_body({.type = BodyType::fixed}, ShapeDef{.geometry = Plane{{0, 1, 0}, 0}});
  SolidDef solid;
  const float e = fall.half_extent;
  solid.box = SolidBox{{e, e, 0.7f * e}, {2, 4, 2}};
  solid.pose = {{0, double(fall.height), 0}, {0.3f, 0.5f, 0.2f, 0.7874f}};
  solid.model = fall.model, solid.young_modulus = fall.young_modulus, solid.poisson_ratio = 0.3f;
  const SoftId id = world.add_solid(solid);
  const double mass = world.soft_info(id).mass;
  double most = 0.0, least = 1.0e30;
  for (int n = 0; n < 90; ++n) {
    world.step(1.0f / 60.0f);
    const SoftInfo info = world.soft_info(id);
    if (n >= 20) most = std::max(most, info.kinetic_energy + info.elastic_energy);
    for (const double y : world.vertices(id).y) least = std::min(least, y);
  }
  EXPECT_GT(least, -0.5 * double(e));
  return most / (mass * 9.81 * double(fall.height));
}

TEST(SoftStiffSolids, ImpactsOnTheGroundThrowNoSolid) {
  for (const SolidModel model : {SolidModel::linear, SolidModel::corotated, SolidModel::neo_hookean}) {
    for (const int substeps : {1, 2, 4, 8, 16}) {
      for (const float modulus : {1.0e5f, 1.0e7f, 6.0e7f}) {
        const double ratio = energy_after_impact({model, 0.025f, 0.1f, modulus, substeps});
        EXPECT_LT(ratio, 1.0) << int(model) << ' ' << substeps << ' ' << modulus;
      }
    }
  }
}

TEST(SoftStiffSolids, WhatIsNotFiniteIsFrozenAndToldOnce) {
  World world = std::move(*World::create({}));
  world.add_body({.type = BodyType::fixed}, ShapeDef{.geometry = Plane{{0, 1, 0}, 0}});
  const SoftId broken =
      world.add_solid({.box = SolidBox{{0.1f, 0.1f, 0.1f}, {1, 1, 1}}, .pose = {{0, 5, 0}, {}}});
  const SoftId sound = world.add_rope({.points = {{3, 5, 0}, {4, 5, 0}}, .segments = 4});
  std::vector<Vec3> wild(world.vertices(broken).size(), Vec3{});
  wild[0] = {3.0e38f, 0, 0}, wild[1] = {-3.0e38f, 0, 0};
  ASSERT_TRUE(world.set_vertices(broken, {}, wild));
  const SoftVertices before = world.vertices(broken);
  const std::vector<double> y(before.y.begin(), before.y.end());
  int told = 0;
  World loaded = std::move(*World::create({}));
  for (int n = 0; n < 30; ++n) {
    world.step(1.0f / 60.0f);
    for (const Problem& one : world.problems()) {
      EXPECT_EQ(one.soft, broken);
      told += std::string(one.message)
                          .find("soft matter 0 is no longer finite; it was frozen at its last good places") !=
                      std::string::npos
                  ? 1
                  : 0;
    }
    if (n == 20) {
      ASSERT_TRUE(restore_snapshot(loaded, save_snapshot(world)).ok());
    }
    if (n > 20) {
      loaded.step(1.0f / 60.0f);
      EXPECT_EQ(world.hash(), loaded.hash());
    }
  }
  EXPECT_EQ(told, 1);
  const SoftVertices after = world.vertices(broken);
  for (std::size_t i = 0; i < y.size(); ++i) EXPECT_EQ(after.y[i], y[i]);
  EXPECT_FALSE(world.soft_info(broken).awake);
  // The other one falls on.
  EXPECT_LT(world.vertices(sound).y[0], 4.5);
  EXPECT_TRUE(world.soft_info(sound).awake);
  // Setting its vertices lets it move again.
  ASSERT_TRUE(world.set_vertices(broken, {}, std::vector<Vec3>(y.size(), Vec3{})));
  for (int n = 0; n < 30; ++n) world.step(1.0f / 60.0f);
  EXPECT_LT(world.vertices(broken).y[0], y[0] - 0.5);
}

// The energy that a world gains for three steps or longer, over that of the start, whose potential is that above the ground.
double gain_of(World& world, int steps) {
  const auto energy = [&] {
    const Energy e = world.energy();
    return e.kinetic + e.potential + e.elastic + e.soft_elastic;
  };
  const double start = energy();
  double low = start, gain = 0.0, last[2] = {start, start};
  for (int n = 0; n < steps; ++n) {
    world.step(1.0f / 60.0f);
    const double now = energy();
    EXPECT_TRUE(std::isfinite(now)) << n;
    gain = std::max(gain, std::min({now, last[0], last[1]}) - low);
    low = std::min(low, now);
    last[0] = last[1], last[1] = now;
  }
  return gain / start;
}
World make_world(int substeps) {
  WorldDef def;
  def.stepping.substeps = substeps;
  World world = std::move(*World::create(def));
  world.add_body({.type = BodyType::fixed}, ShapeDef{.geometry = Plane{{0, 1, 0}, 0}});
  return world;
}
SolidDef stiff_block(SolidModel model, float half_extent, float young_modulus, double height, Quat turn) {
  SolidDef solid;
  solid.box = SolidBox{{half_extent, 0.6f * half_extent, 0.8f * half_extent}, {2, 2, 3}};
  solid.pose = {{0, height, 0}, turn};
  solid.model = model, solid.young_modulus = young_modulus, solid.poisson_ratio = 0.3f;
  return solid;
}
constexpr SolidModel kTurningModels[] = {SolidModel::corotated, SolidModel::neo_hookean};

// A block of 1 cm turns by a quarter of a radian in a sub-step. Along the tangents its corners would go 3 % too far in each.
TEST(SoftStiffSolids, ASmallSolidThatTumblesIsNotStretched) {
  for (const SolidModel model : kTurningModels) {
    WorldDef def;
    def.gravity = {};
    def.stepping.substeps = 1;
    World world = std::move(*World::create(def));
    SolidDef cube = stiff_block(model, 0.005f, 1.0e7f, 0.0, {});
    const Vec3 spin{3.0f, 14.0f, 2.0f};
    for (int k = 0; k <= 3; ++k)
      for (int j = 0; j <= 2; ++j)
        for (int i = 0; i <= 2; ++i)
          cube.settings.velocities.push_back(
              cross(spin, {0.005f * float(i - 1), 0.003f * float(j - 1), 0.004f * (float(k) / 1.5f - 1.0f)}));
    const SoftId id = world.add_solid(cube);
    const double start = world.soft_info(id).kinetic_energy;
    const Vec3 momentum = to_float(world.momentum().angular);
    for (int n = 0; n < 60; ++n) world.step(1.0f / 60.0f);
    EXPECT_LT(world.soft_info(id).elastic_energy, 0.02 * start);
    EXPECT_NEAR(world.soft_info(id).kinetic_energy, start, 0.05 * start);
    EXPECT_LT(length(to_float(world.momentum().angular) - momentum), 1.0e-3f * length(momentum));
  }
}

// A block of 4 mm lands askew with one sub-step a step. The bounds of its moves stop it as a whole; one vertex that they hold back alone would give it a thousand times its energy.
TEST(SoftStiffSolids, ABlockThatLandsIsStoppedAsAWhole) {
  World world = make_world(1);
  SolidDef block;
  block.box = SolidBox{{0.0021218f, 0.00159899f, 0.0018481f}, {2, 4, 4}};
  block.pose = {{0, 0.01583, 0}, {-0.55338603f, 0.3485965f, -0.19538967f, 0.7307991f}};
  block.model = SolidModel::corotated, block.young_modulus = 4.556e5f, block.poisson_ratio = 0.1064f;
  block.density = 702.3f;
  world.add_solid(block);
  EXPECT_LT(gain_of(world, 90), 0.1);
}

// Two blocks fall on each other. An impulse on a vertex meets the mass of the whole block.
TEST(SoftStiffSolids, SmallStiffSolidsOnEachOtherGainLittle) {
  for (const SolidModel model : kTurningModels) {
    for (const int substeps : {4, 16}) {
      World world = make_world(substeps);
      world.add_solid(stiff_block(model, 0.004f, 1.0e5f, 0.008, {0.3f, 0.5f, 0.2f, 0.7874f}));
      world.add_solid(stiff_block(model, 0.004f, 1.0e5f, 0.02, {0.1f, 0.3f, -0.4f, 0.86f}));
      EXPECT_LT(gain_of(world, 60), 0.05) << int(model) << ' ' << substeps;
    }
  }
}

// The vertices of a block around a sphere are nearest to different sides of it.
TEST(SoftStiffSolids, WhatBeginsInABodyComesOutCalmly) {
  for (const SolidModel model : kTurningModels) {
    for (const float scale : {0.01f, 1.0f}) {
      for (const float modulus : {1.0e5f, 3.0e7f}) {
        World world = make_world(4);
        world.add_body({.type = BodyType::fixed, .pose = {{0.1 * double(scale), double(scale), 0}, {}}},
                       ShapeDef{.geometry = Sphere{0.3f * scale}});
        world.add_solid(
            stiff_block(model, 0.4f * scale, modulus, 1.2 * double(scale), {0.3f, 0.5f, 0.2f, 0.7874f}));
        EXPECT_LT(gain_of(world, 60), 0.05) << int(model) << ' ' << scale << ' ' << modulus;
      }
    }
  }
}

// A corner of one block begins within the other.
TEST(SoftStiffSolids, WhatBeginsInEachOtherPartsCalmly) {
  for (const SolidModel model : kTurningModels) {
    for (const float modulus : {1.0e5f, 3.0e7f}) {
      World world = make_world(4);
      world.add_solid(stiff_block(model, 0.3f, modulus, 1.0, {0.3f, 0.5f, 0.2f, 0.7874f}));
      world.add_solid(stiff_block(model, 0.3f, modulus, 1.4, {0.1f, 0.3f, -0.4f, 0.86f}));
      EXPECT_LT(gain_of(world, 60), 0.05) << int(model) << ' ' << modulus;
    }
  }
}

}  // namespace
}  // namespace gyre::soft_stiff_solids_test
