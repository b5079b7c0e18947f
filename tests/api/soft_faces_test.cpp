// Corners, edges and tips of bodies between the vertices of coarse sheets: none passes through.
#include "determinism/scenes.h"
#include "geometry/query/face_query.h"
#include "math/rotation.h"

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

// The least signed distance of any point of the sheet to the body, m.
double depth_of(const World& world, SoftId sheet, BodyId body, const AnyShape& geometry) {
  Shape shape;
  if (const Box* box = std::get_if<Box>(&geometry)) {
    shape.kind = ShapeKind::box, shape.extents = box->half_extents, shape.radius = 0.0f;
  } else {
    const Cone& cone = std::get<Cone>(geometry);
    shape.kind = ShapeKind::cone, shape.radius = cone.radius;
    shape.extents = {cone.radius, cone.half_height, cone.radius};
  }
  const Pose pose = world.pose(body);
  const SoftVertices v = world.vertices(sheet);
  const std::span<const std::uint32_t> corner = world.soft_triangles(sheet);
  double least = 1.0e9;
  for (std::size_t k = 0; k + 2 < corner.size(); k += 3) {
    DVec3 local[3];
    for (std::size_t n = 0; n < 3; ++n)
      local[n] = rotate_inverse(to_double(pose.orientation), v.position(corner[k + n]) - pose.position);
    FaceDistance found;
    if (find_face_distance(shape, local, least, -1.0e9, found)) least = std::min(least, found.distance);
  }
  return least;
}

// A sheet that strikes a rim goes this deep for some steps, m; what passes through is deeper.
constexpr double kDeepest = 0.016;

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
        ASSERT_GT(depth_of(world, sheet, body, sharp.shape), -kDeepest) << sharp.name << cell << " " << n;
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
        ASSERT_GT(depth_of(world, sheet, body, sharp.shape), -kDeepest) << sharp.name << cell << " " << n;
      }
      // The radius is 2.5 mm.
      EXPECT_GT(depth_of(world, sheet, body, sharp.shape), -2.0e-3) << sharp.name << cell;
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
        ASSERT_GT(depth_of(world, sheet, body, sharp.shape), -kDeepest) << sharp.name << cell << " " << n;
      }
      // The radius is 2.5 mm.
      EXPECT_GT(depth_of(world, sheet, body, sharp.shape), -2.0e-3) << sharp.name << cell;
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

// A sheet hangs over the edge of a box, 10 cm out of balance: friction holds it, and without it slides off.
TEST(SoftFaces, Rub) {
  for (const bool rough : {false, true}) {
    World world = make_world();
    ClothDef def;
    def.grid = ClothGrid{{float(kSize), float(kSize)}, {10, 10}};
    def.pose.position = {0.1, 0.51, 0.007};
    def.settings.static_friction = def.settings.dynamic_friction = rough ? 1.0f : 0.0f;
    def.settings.damping = 1.0e-2f;
    const SoftId sheet = world.add_cloth(def);
    add_sharp(world, kSharp[3], BodyType::fixed, {0, 0.35, 0});
    for (int n = 0; n < 120; ++n) world.step(kStep);
    const SoftVertices v = world.vertices(sheet);
    double highest = -1.0e9;
    for (std::size_t i = 0; i < v.size(); ++i) highest = std::max(highest, v.y[i]);
    if (rough) {
      EXPECT_GT(highest, 0.4);
    } else {
      EXPECT_LT(highest, 0.0);
    }
  }
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
