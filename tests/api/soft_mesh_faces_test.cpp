// Tips and ridges of meshes and height fields between the vertices of coarse sheets: none passes through.
#include "determinism/scenes.h"

#include <gyre/gyre.h>
#include <gyre/replay.h>

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <vector>

namespace gyre::soft_mesh_faces_test {
namespace {

constexpr float kStep = 1.0f / 60.0f;

// A surface of triangles, and points of its tips and ridges.
struct Sharp {
  std::vector<Vec3> vertices;
  std::vector<std::uint32_t> indices;
  std::vector<DVec3> tips;
};
Sharp cone() {
  constexpr std::uint32_t kSides = 12;
  Sharp out;
  out.vertices.push_back({0, 0.4f, 0});
  for (std::uint32_t i = 0; i < kSides; ++i) {
    const float angle = 6.2831853f * float(i) / float(kSides);
    out.vertices.push_back({0.2f * std::cos(angle), 0, 0.2f * std::sin(angle)});
    for (const std::uint32_t v : {0u, (i + 1) % kSides + 1, i + 1}) out.indices.push_back(v);
  }
  out.tips.push_back({0, 0.4, 0});
  return out;
}
Sharp roof() {
  Sharp out;
  for (const float z : {-0.6f, 0.6f}) {
    for (const Vec3 v : {Vec3{-0.25f, 0, z}, Vec3{0.25f, 0, z}, Vec3{0, 0.35f, z}}) out.vertices.push_back(v);
  }
  out.indices = {0, 3, 5, 0, 5, 2, 1, 2, 5, 1, 5, 4, 0, 2, 1, 3, 4, 5};
  for (int i = -55; i <= 55; ++i) out.tips.push_back({0, 0.35, 0.01 * i});
  return out;
}
AnyShape cook(const Sharp& sharp) {
  MeshDef def;
  def.vertices = sharp.vertices, def.indices = sharp.indices;
  return *cook_mesh(def);
}
// Peaks of 20 cm every 30 cm, on cells of 10 cm.
AnyShape peaks(std::vector<DVec3>& tips) {
  constexpr int kSamples = 13;
  std::vector<float> heights;
  for (int j = 0; j < kSamples; ++j) {
    for (int i = 0; i < kSamples; ++i) {
      const bool is_peak = i % 3 == 0 && j % 3 == 0;
      heights.push_back(is_peak ? 0.2f : 0.0f);
      if (is_peak) tips.push_back({0.1 * (i - 6), 0.2, 0.1 * (j - 6)});
    }
  }
  HeightFieldDef def;
  def.columns = kSamples, def.rows = kSamples, def.spacing = 0.1f;
  def.heights = heights;
  return *cook_height_field(def);
}

World make_world(const AnyShape& shape, int threads = 1) {
  WorldDef def;
  def.threads = threads;
  World world = std::move(*World::create(def));
  ShapeDef part;
  part.geometry = shape;
  world.add_body({.type = BodyType::fixed}, part);
  world.add_body({.type = BodyType::fixed}, ShapeDef{.geometry = Plane{{0, 1, 0}, -0.5f}});
  return world;
}
SoftId add_sheet(World& world, double cell, DVec3 at) {
  const int cells = int(0.6 / cell + 0.5);
  ClothDef def;
  def.grid = ClothGrid{{0.6f, 0.6f}, {cells, cells}};
  def.settings.damping = 1.0e-3f;
  def.pose.position = at;
  return world.add_cloth(def);
}
// How far a tip is above the face at its place of the ground plan, along the normal of the face, m, at most.
double depth_of(const World& world, SoftId sheet, const std::vector<DVec3>& tips) {
  const SoftVertices v = world.vertices(sheet);
  const std::span<const std::uint32_t> corner = world.soft_triangles(sheet);
  double most = 0.0;
  for (std::size_t k = 0; k + 2 < corner.size(); k += 3) {
    const DVec3 p[3] = {v.position(corner[k]), v.position(corner[k + 1]), v.position(corner[k + 2])};
    const DVec3 area = cross(p[1] - p[0], p[2] - p[0]);
    const DVec3 up = (area.y < 0.0 ? -1.0 : 1.0) / length(area) * area;
    for (const DVec3& tip : tips) {
      const double height = dot(tip - p[0], up);
      const DVec3 below = tip - DVec3{0, height / up.y, 0};
      bool inside = up.y > 0.1;
      for (int n = 0; n < 3; ++n)
        inside = inside && dot(cross(p[(n + 1) % 3] - p[n], below - p[n]), area) > 0.0;
      if (inside) most = std::max(most, height);
    }
  }
  return most;
}
double energy_of(const World& world) {
  const Energy energy = world.energy();
  return energy.kinetic + energy.potential + energy.elastic + energy.soft_elastic;
}

void expect_bears(const AnyShape& shape, const std::vector<DVec3>& tips, double cell, DVec3 at,
                  double rest_depth, double gain) {
  World world = make_world(shape);
  const SoftId sheet = add_sheet(world, cell, at);
  const double start = energy_of(world);
  double before = start, gained = 0.0, depth = 0.0;
  for (int n = 0; n < 150; ++n) {
    world.step(kStep);
    gained += std::max(0.0, energy_of(world) - before);
    before = energy_of(world);
    depth = depth_of(world, sheet, tips);
    EXPECT_LT(depth, 0.015) << n;
  }
  EXPECT_LT(depth, rest_depth);
  EXPECT_LT(gained, gain * start);
}

TEST(SoftMeshFaces, ASheetOnAConeOfTriangles) {
  const Sharp sharp = cone();
  for (const double cell : {0.05, 0.1})
    expect_bears(cook(sharp), sharp.tips, cell, {0.013, 0.7, 0.007}, 0.0013, 5.0e-3);
}
TEST(SoftMeshFaces, ASheetOnARoof) {
  const Sharp sharp = roof();
  for (const double cell : {0.05, 0.1})
    expect_bears(cook(sharp), sharp.tips, cell, {0.013, 0.7, 0.007}, 0.0013, 5.0e-3);
}
// Two tips may be under one face, which has one point of contact.
TEST(SoftMeshFaces, ASheetOnPeaksOfAHeightField) {
  std::vector<DVec3> tips;
  const AnyShape field = peaks(tips);
  for (const double cell : {0.05, 0.1}) expect_bears(field, tips, cell, {0.013, 0.5, 0.007}, 0.006, 0.03);
}

TEST(SoftMeshFaces, SnapshotsAndThreadsDoNotChangeABit) {
  std::uint64_t hash = 0;
  for (const int threads : {1, 2, 3, 8}) {
    World world = make_world(cook(cone()), threads);
    add_sheet(world, 0.1, {0.013, 0.7, 0.007});
    for (int n = 0; n < 30; ++n) world.step(kStep);
    World loaded = make_world(cook(cone()), threads);
    ASSERT_TRUE(restore_snapshot(loaded, save_snapshot(world)).ok());
    for (int n = 0; n < 20; ++n) world.step(kStep), loaded.step(kStep);
    EXPECT_EQ(world.hash(), loaded.hash());
    if (threads > 1) {
      EXPECT_EQ(world.hash(), hash);
    }
    hash = world.hash();
  }
}

}  // namespace
}  // namespace gyre::soft_mesh_faces_test
