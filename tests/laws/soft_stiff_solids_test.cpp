// Stiff solids on the ground and on each other: contact presses them out of shape no further than the fall can.
#include <gyre/gyre.h>
#include <gyre/replay.h>

#include <gtest/gtest.h>

#include <algorithm>
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

}  // namespace
}  // namespace gyre::soft_stiff_solids_test
