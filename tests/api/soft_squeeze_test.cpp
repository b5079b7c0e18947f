// Cloth between bodies that close on it, whatever they are: nothing is thrown.
#include <gyre/gyre.h>

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <vector>

namespace gyre::soft_squeeze_test {
namespace {

constexpr float kStep = 1.0f / 60.0f;

World make_world(int substeps) {
  WorldDef def{.sleeping = false};
  def.stepping.substeps = substeps;
  World world = *World::create(def);
  world.add_body({.type = BodyType::fixed}, {.geometry = Plane{}});
  return world;
}

// The largest speed of a vertex, from places of this step and the last.
class SpeedMeter {
 public:
  double read(World& world, SoftId cloth) {
    const SoftVertices v = world.vertices(cloth);
    double most = 0.0;
    for (std::size_t i = 0; i < v.size(); ++i) {
      const DVec3 place = v.position(i);
      if (i < last_.size()) most = std::max(most, length(place - last_[i]) / double(kStep));
      if (i >= last_.size()) last_.push_back(place);
      last_[i] = place;
      if (!std::isfinite(place.x + place.y + place.z)) return 1.0e30;
    }
    return most;
  }

 private:
  std::vector<DVec3> last_;
};

// A kinematic body goes through a sheet on the ground into the ground, where the sheet has no place to be.
TEST(SoftSqueeze, ASheetBetweenAKinematicBodyAndTheGroundIsNotThrown) {
  const AnyShape shapes[] = {Box{{0.3f, 0.1f, 0.3f}}, Sphere{0.25f}, Capsule{0.1f, 0.2f}};
  for (const AnyShape& shape : shapes) {
    for (const int substeps : {1, 4, 8}) {
      World world = make_world(substeps);
      const SoftId cloth = world.add_cloth({.grid = ClothGrid{{1.5f, 1.5f}, {10, 10}},
                                            .pose = {{0, 0.05, 0}, {}},
                                            .area_density = 0.3f,
                                            .stretch_stiffness = 2.0e3f});
      const BodyId body = world.add_body({.type = BodyType::kinematic,
                                          .pose = {{0, 0.5, 0}, normalized(Quat{0.3f, 0.1f, 0.2f, 0.9f})},
                                          .linear_velocity = {0, -0.7f, 0}},
                                         {.geometry = shape});
      SpeedMeter meter;
      double fastest = 0.0, last = 0.0;
      for (int i = 0; i < 180; ++i) {
        if (i == 70) world.set_velocity(body, {}, {});
        ASSERT_TRUE(world.step(kStep));
        last = meter.read(world, cloth);
        fastest = std::max(fastest, last);
      }
      EXPECT_LT(fastest, 20.0) << shape.index() << " " << substeps;
      EXPECT_LT(last, 12.0) << shape.index() << " " << substeps;
    }
  }
}

// Both sides of a squeeze want to open, and neither can: their impulses must not add up.
TEST(SoftSqueeze, WhatComesFreeIsNotThrownWhereverTheBodyStands) {
  for (int place = 0; place < 8; ++place) {
    World world = make_world(1);
    const SoftId cloth = world.add_cloth({.grid = ClothGrid{{1.5f, 1.5f}, {10, 10}},
                                          .pose = {{0, 0.05, 0}, {}},
                                          .area_density = 0.3f,
                                          .stretch_stiffness = 2.0e3f});
    const BodyId body =
        world.add_body({.type = BodyType::kinematic,
                        .pose = {{0.005 * place, 0.5, 0}, normalized(Quat{0.3f, 0.1f, 0.2f, 0.9f})},
                        .linear_velocity = {0, -0.7f, 0}},
                       {.geometry = Box{{0.3f, 0.1f, 0.3f}}});
    SpeedMeter meter;
    for (int i = 0; i < 180; ++i) {
      if (i == 70) world.set_velocity(body, {}, {});
      ASSERT_TRUE(world.step(kStep));
      ASSERT_LT(meter.read(world, cloth), 20.0) << place << " " << i;
    }
  }
}

// A body that falls on a visual sheet meets the ground below it, as if there were no sheet.
TEST(SoftSqueeze, AVisualSheetDoesNotPushWhatFallsOnIt) {
  for (const int substeps : {1, 2, 8}) {
    World world = make_world(substeps);
    ClothDef def{.grid = ClothGrid{{1.5f, 1.5f}, {10, 10}},
                 .pose = {{0, 0.05, 0}, {}},
                 .area_density = 0.2f,
                 .stretch_stiffness = 1.0e3f};
    def.settings.integrator = SoftIntegrator::visual;
    const SoftId cloth = world.add_cloth(def);
    World bare = make_world(substeps);
    const BodyDef body{.pose = {{0.1, 0.8, 0}, normalized(Quat{0.3f, 0.1f, 0.2f, 0.9f})},
                       .linear_velocity = {0.5f, -4, 0}};
    const ShapeDef shape{.geometry = Box{{0.3f, 0.1f, 0.2f}}, .density = 2.0e3f};
    const BodyId on_sheet = world.add_body(body, shape), on_ground = bare.add_body(body, shape);
    SpeedMeter meter;
    for (int i = 0; i < 180; ++i) {
      ASSERT_TRUE(world.step(kStep));
      ASSERT_TRUE(bare.step(kStep));
      ASSERT_LT(meter.read(world, cloth), 60.0) << substeps << " " << i;
    }
    EXPECT_LT(length(world.pose(on_sheet).position - bare.pose(on_ground).position), 1.0e-3) << substeps;
  }
}

}  // namespace
}  // namespace gyre::soft_squeeze_test
