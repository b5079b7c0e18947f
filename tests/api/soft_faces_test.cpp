// Corners, edges and tips of bodies between the vertices of coarse sheets: none passes through.
#include "determinism/scenes.h"
#include "soft/contact/surface_crossings.h"

#include <gyre/gyre.h>
#include <gyre/replay.h>

#include <gtest/gtest.h>

#include <cmath>
#include <string>

namespace gyre::soft_faces_test {
namespace {

constexpr float kStep = 1.0f / 60.0f;
constexpr double kSize = 0.6;  // m, of a sheet

struct Sharp {
  const char* name;
  AnyShape shape;
  Quat turn;
};
const Sharp kSharp[] = {
    {"cone", Cone{0.1f, 0.15f}, {0, 0, 0, 1}},
    {"rim of a cone", Cone{0.1f, 0.15f}, {1, 0, 0, 0}},
    {"corner", Box{{0.1f, 0.1f, 0.1f}}, {0.27f, 0.11f, 0.36f, 0.886f}},
    {"edge", Box{{0.1f, 0.1f, 0.1f}}, {0, 0, 0.3826834f, 0.9238795f}},
    {"plate", Box{{0.1f, 0.1f, 0.002f}}, {0, 0, 0, 1}},
};
constexpr double kCells[] = {0.02, 0.04, 0.06, 0.1};  // m

World make_world(Vec3 gravity = {0, -9.81f, 0}, int threads = 1) {
  WorldDef def;
  def.gravity = gravity;
  def.threads = threads;
  return std::move(*World::create(def));
}
SoftId add_sheet(World& world, double cell, double height) {
  const int cells = int(kSize / cell + 0.5);
  ClothDef def;
  def.grid = ClothGrid{{float(kSize), float(kSize)}, {cells, cells}};
  def.settings.damping = 1.0e-3f;
  def.pose.position = {0.013, height, 0.007};
  return world.add_cloth(def);
}
void pin_corners(World& world, SoftId sheet, double cell) {
  const int cells = int(kSize / cell + 0.5);
  for (const int corner : {0, cells, cells * (cells + 1), (cells + 1) * (cells + 1) - 1})
    ASSERT_TRUE(world.pin(sheet, corner));
}
BodyId add_sharp(World& world, const Sharp& sharp, BodyType type, DVec3 at) {
  BodyDef body;
  body.type = type, body.pose = {at, sharp.turn};
  ShapeDef shape;
  shape.geometry = sharp.shape, shape.density = 500.0f;
  return world.add_body(body, shape);
}

// How often lines from the middle of the body to a point of the sharp parts meet the sheet.
int count_passed(const World& world, SoftId sheet, BodyId body, const AnyShape& shape) {
  std::vector<DVec3> tips;
  if (const Box* box = std::get_if<Box>(&shape)) {
    const Vec3 e = box->half_extents;
    for (const float x : {-e.x, e.x})
      for (const float y : {-e.y, e.y})
        for (const float z : {-e.z, e.z}) tips.push_back({x, y, z});
  } else {
    const Cone& cone = std::get<Cone>(shape);
    tips.push_back({0, double(cone.half_height), 0});
    for (int k = 0; k < 8; ++k) {
      const double angle = 0.25 * 3.14159265 * k;
      tips.push_back({double(cone.radius) * std::cos(angle), -double(cone.half_height), double(cone.radius) * std::sin(angle)});
    }
  }
  const Pose pose = world.pose(body);
  const auto place = [&](DVec3 v) {
    const DVec3 u{pose.orientation.x, pose.orientation.y, pose.orientation.z}, t = 2.0 * cross(u, v);
    return pose.position + v + double(pose.orientation.w) * t + cross(u, t);
  };
  const SoftVertices v = world.vertices(sheet);
  const std::span<const std::uint32_t> corner = world.soft_triangles(sheet);
  int passed = 0;
  for (const DVec3 tip : tips) {
    // All but the outermost 5 %.
    const DVec3 a = place({}), b = place(0.95 * tip);
    for (std::size_t k = 0; k + 2 < corner.size(); k += 3) {
      passed += segment_meets_triangle(a, b, v.position(corner[k]), v.position(corner[k + 1]), v.position(corner[k + 2]));
    }
  }
  return passed;
}

double energy_of(const World& world) {
  const Energy energy = world.energy();
  return energy.kinetic + energy.potential + energy.elastic + energy.soft_elastic;
}

// A body of up to 4 kg falls 25 cm onto a sheet of 72 g that hangs by its corners.
TEST(SoftFaces, BodiesFallOnASheet) {
  for (const Sharp& sharp : kSharp) {
    for (const double cell : kCells) {
      World world = make_world();
      const SoftId sheet = add_sheet(world, cell, 0.5);
      pin_corners(world, sheet, cell);
      const BodyId body = add_sharp(world, sharp, BodyType::dynamic, {0, 0.75, 0});
      const double start = energy_of(world);
      for (int n = 0; n < 60; ++n) {
        world.step(kStep);
        ASSERT_EQ(count_passed(world, sheet, body, sharp.shape), 0) << sharp.name << cell << " " << n;
        ASSERT_LT(energy_of(world), start + 0.02) << sharp.name << cell << " " << n;
      }
    }
  }
}

TEST(SoftFaces, ASheetFallsOnBodies) {
  for (const Sharp& sharp : kSharp) {
    for (const double cell : kCells) {
      World world = make_world();
      const SoftId sheet = add_sheet(world, cell, 0.6);
      const BodyId body = add_sharp(world, sharp, BodyType::fixed, {0, 0.35, 0});
      for (int n = 0; n < 90; ++n) {
        world.step(kStep);
        ASSERT_EQ(count_passed(world, sheet, body, sharp.shape), 0) << sharp.name << cell << " " << n;
      }
    }
  }
}

// They are pushed 15 cm up at 15 cm/s under a sheet that hangs by its corners.
TEST(SoftFaces, BodiesArePushedUnderASheet) {
  for (const Sharp& sharp : kSharp) {
    for (const double cell : kCells) {
      World world = make_world();
      const SoftId sheet = add_sheet(world, cell, 0.6);
      pin_corners(world, sheet, cell);
      const BodyId body = add_sharp(world, sharp, BodyType::kinematic, {0, 0.4, 0});
      for (int n = 0; n < 90; ++n) {
        world.move_kinematic(body, {{0, 0.4 + 0.15 * std::min(n + 1, 60) / 60.0, 0}, sharp.turn}, kStep);
        world.step(kStep);
        ASSERT_EQ(count_passed(world, sheet, body, sharp.shape), 0) << sharp.name << cell << " " << n;
      }
    }
  }
}

// A cone flies into a free sheet, between its vertices.
TEST(SoftFaces, KeepMomentum) {
  World world = make_world({});
  add_sheet(world, 0.1, 0.0);
  const BodyId cone = add_sharp(world, kSharp[0], BodyType::dynamic, {0.05, -0.2, 0.04});
  world.set_velocity(cone, {0, 1, 0}, {});
  const Momentum before = world.momentum();
  for (int n = 0; n < 30; ++n) world.step(kStep);
  const Momentum after = world.momentum();
  EXPECT_LT(world.linear_velocity(cone).y, 0.99f);
  EXPECT_LT(length(after.linear - before.linear), 1.0e-4 * length(before.linear));
  EXPECT_LT(length(after.angular - before.angular), 1.0e-3 * length(before.linear) * kSize);
}

// A corner that is drawn along under a sheet takes it along by friction.
TEST(SoftFaces, Rub) {
  double moved[2] = {};
  for (const bool rough : {false, true}) {
    World world = make_world();
    ClothDef def;
    def.grid = ClothGrid{{float(kSize), float(kSize)}, {6, 6}};
    def.pose.position = {0.013, 0.6, 0.007};
    def.settings.static_friction = def.settings.dynamic_friction = rough ? 1.0f : 0.0f;
    def.settings.damping = 1.0e-3f;
    const SoftId sheet = world.add_cloth(def);
    pin_corners(world, sheet, 0.1);
    const BodyId body = add_sharp(world, kSharp[0], BodyType::kinematic, {0, 0.4, 0});
    const auto mean = [&] {
      const SoftVertices v = world.vertices(sheet);
      double sum = 0.0;
      for (std::size_t i = 0; i < v.size(); ++i) sum += v.x[i];
      return sum / double(v.size());
    };
    double before = 0.0;
    for (int n = 0; n < 90; ++n) {
      const double up = 0.1 * std::min(n + 1, 60) / 60.0, along = 0.05 * std::max(n - 59, 0) / 30.0;
      world.move_kinematic(body, {{along, 0.4 + up, 0}, kSharp[0].turn}, kStep);
      if (n == 60) before = mean();
      world.step(kStep);
    }
    moved[rough] = mean() - before;
  }
  EXPECT_GT(moved[1], moved[0] + 0.002);
}

TEST(SoftFaces, ThreadsAndSnapshotsDoNotChangeABit) {
  std::uint64_t hash = 0;
  for (const int threads : {1, 2, 8}) {
    World world = make_world({0, -9.81f, 0}, threads);
    const SoftId sheet = add_sheet(world, 0.06, 0.5);
    pin_corners(world, sheet, 0.06);
    for (int k = 0; k < 3; ++k) add_sharp(world, kSharp[k], BodyType::dynamic, {0.1 * (k - 1), 0.8 + 0.3 * k, 0.02 * k});
    for (int n = 0; n < 30; ++n) world.step(kStep);
    const std::vector<std::byte> saved = save_snapshot(world);
    World loaded = make_world({0, -9.81f, 0}, threads);
    ASSERT_TRUE(restore_snapshot(loaded, saved).ok());
    EXPECT_EQ(world.hash(), loaded.hash());
    for (int n = 0; n < 30; ++n) world.step(kStep), loaded.step(kStep);
    EXPECT_EQ(world.hash(), loaded.hash());
    if (threads > 1) {
      EXPECT_EQ(world.hash(), hash);
    }
    hash = world.hash();
  }
}

}  // namespace
}  // namespace gyre::soft_faces_test
