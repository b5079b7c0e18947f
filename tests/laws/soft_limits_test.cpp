// Gas within cloth, tearing, fracture and plasticity.
#include "determinism/scenes.h"

#include <gyre/gyre.h>
#include <gyre/replay.h>

#include <gtest/gtest.h>

#include <cmath>
#include <map>

namespace gyre {
namespace {

constexpr float kStep = 1.0f / 60.0f;

World make_world(Vec3 gravity = {0, -9.81f, 0}, int threads = 1, int width = 0) {
  WorldDef def;
  def.gravity = gravity;
  def.threads = threads;
  def.simd_width = width;
  return std::move(*World::create(def));
}

// An icosahedron whose faces are divided `times` times, on a sphere.
void make_ball(ClothDef& def, double radius, int times) {
  const double g = 0.5 * (1.0 + std::sqrt(5.0));
  std::vector<DVec3> at = {{-1, g, 0}, {1, g, 0}, {-1, -g, 0}, {1, -g, 0}, {0, -1, g}, {0, 1, g}, {0, -1, -g}, {0, 1, -g}, {g, 0, -1}, {g, 0, 1}, {-g, 0, -1}, {-g, 0, 1}};
  std::vector<std::uint32_t> faces = {0, 11, 5, 0, 5, 1, 0, 1, 7, 0, 7, 10, 0, 10, 11, 1, 5, 9, 5, 11, 4, 11, 10, 2, 10, 7, 6, 7, 1, 8,
                                      3, 9, 4, 3, 4, 2, 3, 2, 6, 3, 6, 8, 3, 8, 9, 4, 9, 5, 2, 4, 11, 6, 2, 10, 8, 6, 7, 9, 8, 1};
  for (int n = 0; n < times; ++n) {
    std::map<std::pair<std::uint32_t, std::uint32_t>, std::uint32_t> middles;
    const auto middle = [&](std::uint32_t a, std::uint32_t b) {
      const auto [found, is_new] = middles.try_emplace({std::min(a, b), std::max(a, b)}, std::uint32_t(at.size()));
      if (is_new) at.push_back(0.5 * (at[a] + at[b]));
      return found->second;
    };
    std::vector<std::uint32_t> next;
    for (std::size_t t = 0; t < faces.size(); t += 3) {
      const std::uint32_t a = faces[t], b = faces[t + 1], c = faces[t + 2], ab = middle(a, b), bc = middle(b, c), ca = middle(c, a);
      next.insert(next.end(), {a, ab, ca, b, bc, ab, c, ca, bc, ab, bc, ca});
    }
    faces = next;
    for (DVec3& p : at) p = (1.0 / length(p)) * p;
  }
  for (DVec3& p : at) def.vertices.push_back(to_float((radius / length(p)) * p));
  def.triangles = faces;
}

ClothDef balloon(double radius, float pressure) {
  ClothDef def;
  make_ball(def, radius, 2);
  def.links = ClothLinks::membrane;
  def.stretch_stiffness = 1000.0f, def.shear_stiffness = 400.0f;
  def.pressure = pressure;
  def.settings.damping = 0.02f;
  return def;
}

double area_of(const ClothDef& def) {
  double sum = 0.0;
  for (std::size_t t = 0; t < def.triangles.size(); t += 3) {
    const auto at = [&](std::size_t k) { return DVec3(def.vertices[def.triangles[t + k]]); };
    sum += 0.5 * length(cross(at(1) - at(0), at(2) - at(0)));
  }
  return sum;
}
double volume_of(const World& world, SoftId soft) {
  const SoftVertices v = world.vertices(soft);
  const auto t = world.soft_triangles(soft);
  double sum = 0.0;
  for (std::size_t k = 0; k < t.size(); k += 3)
    sum += dot(v.position(t[k]) - v.position(0), cross(v.position(t[k + 1]) - v.position(0), v.position(t[k + 2]) - v.position(0))) / 6.0;
  return sum;
}

// A balloon grows until its tension balances the gas: p = 2 A0 (c + c') e / (3 V0 s) at the stretch s, e = (s^2 - 1) / 2, with the stiffness
// c + c' = Y / (1 - nu) of a sheet that is stretched alike in both directions, and (p + p0) s^3 that of the start.
TEST(SoftGas, ABalloonGrowsUntilItsTensionBalancesThePressure) {
  for (const float ambient : {0.0f, 1.0e5f}) {
    World world = make_world({});
    ClothDef def = balloon(0.5, 2000.0f);
    def.ambient_pressure = ambient;
    const SoftId soft = world.add_cloth(def);
    const double rest = volume_of(world, soft), area = area_of(def);
    for (int i = 0; i < 150; ++i) world.step(kStep);
    const double ratio = double(def.stretch_stiffness) / (2.0 * double(def.shear_stiffness)) - 1.0;
    const double both = double(def.stretch_stiffness) / (1.0 - ratio);
    double low = 1.0, high = 3.0;
    for (int n = 0; n < 60; ++n) {
      const double s = 0.5 * (low + high);
      const double pulls = 2.0 * area * both * 0.5 * (s * s - 1.0) / (3.0 * rest * s);
      const double pushes = (2000.0 + double(ambient)) / (s * s * s) - double(ambient);
      (pushes > pulls ? low : high) = s;
    }
    const SoftInfo info = world.soft_info(soft);
    EXPECT_NEAR(info.volume, volume_of(world, soft), 1e-9);
    EXPECT_NEAR(std::cbrt(info.volume / rest), low, 0.002 * low) << ambient;
    EXPECT_GT(low, ambient == 0.0f ? 1.1 : 1.0005);
    EXPECT_NEAR((info.pressure + double(ambient)) * info.volume, (2000.0 + double(ambient)) * rest, 1e-6 * (2000.0 + double(ambient)) * rest);
    EXPECT_LT(info.kinetic_energy, 1e-3);
  }
}

// A plate lies on a balloon: the heavier it is, the smaller the volume, and the gas keeps its law.
TEST(SoftGas, ABalloonBearsALoad) {
  double volumes[2] = {};
  for (int k = 0; k < 2; ++k) {
    World world = make_world();
    scenes::add_fixed(world, {0, -0.5, 0}, Box{{5.0f, 0.5f, 5.0f}});
    ClothDef def = balloon(0.5, 500.0f);
    def.pose.position = {0, 0.52, 0};
    def.ambient_pressure = 2000.0f;
    const SoftId soft = world.add_cloth(def);
    BodyDef slab;
    slab.pose.position = {0, 1.15, 0};
    slab.mass = k == 0 ? 5.0f : 40.0f;
    slab.locked = {.linear = {true, false, true}, .angular = {true, true, true}};
    const BodyId plate = world.add_body(slab, ShapeDef{.geometry = Box{{0.6f, 0.05f, 0.6f}}});
    world.set_damping(plate, 2.0f, 0.0f);
    const double start = world.soft_info(soft).volume;
    for (int i = 0; i < 240; ++i) world.step(kStep);
    const SoftInfo info = world.soft_info(soft);
    volumes[k] = info.volume;
    EXPECT_NEAR((info.pressure + 2000.0) * info.volume, 2500.0 * start, 1e-5 * 2500.0 * start);
    EXPECT_GT(world.pose(plate).position.y, 0.3) << k;
    EXPECT_LT(length(world.linear_velocity(plate)), 0.1f) << k;
  }
  EXPECT_LT(volumes[1], 0.95 * volumes[0]);
}

TEST(SoftGas, KeepsMomentumAndIsTheSameWithAnyThreadsAndWidths) {
  const auto run = [](int threads, int width) {
    World world = make_world({}, threads, width);
    ClothDef def = balloon(0.5, 3000.0f);
    def.ambient_pressure = 1.0e4f;
    def.settings.velocities.assign(def.vertices.size(), Vec3{1, 0, 0});
    for (std::size_t i = 0; i < def.vertices.size(); ++i) {
      def.settings.velocities[i] += cross(Vec3{0, 0, 2}, def.vertices[i]);
      if (def.vertices[i].y > 0.4f) def.settings.velocities[i] += Vec3{0, -8, 0};
    }
    world.add_cloth(def);
    const Momentum before = world.momentum();
    double energy = 1e30;
    for (int i = 0; i < 60; ++i) {
      world.step(kStep);
      const Energy now = world.energy();
      EXPECT_LT(now.kinetic + now.soft_elastic, energy + 1e-3);
      energy = now.kinetic + now.soft_elastic;
    }
    EXPECT_LT(length(world.momentum().linear - before.linear), 1e-5 * length(before.linear));
    EXPECT_LT(length(world.momentum().angular - before.angular), 0.01 * length(before.angular));
    return world.hash();
  };
  const std::uint64_t hash = run(1, 1);
  EXPECT_EQ(hash, run(2, 0));
  EXPECT_EQ(hash, run(3, 4));
}

TEST(SoftGas, AFanKeepsThePressure) {
  World world = make_world({});
  ClothDef def = balloon(0.5, 800.0f);
  def.pressure_law = PressureLaw::constant;
  const SoftId soft = world.add_cloth(def);
  const double start = world.soft_info(soft).volume;
  for (int i = 0; i < 120; ++i) world.step(kStep);
  EXPECT_EQ(world.soft_info(soft).pressure, 800.0);
  EXPECT_GT(world.soft_info(soft).volume, 1.1 * start);
}

TEST(SoftGas, OpenClothsAreRefusedAndSnapshotsKeepTheGas) {
  World world = make_world();
  ClothDef grid;
  grid.grid = ClothGrid{};
  grid.pressure = 100.0f;
  EXPECT_FALSE(world.add_cloth(grid));
  ClothDef open = balloon(0.5, 100.0f);
  open.triangles.resize(open.triangles.size() - 3);
  EXPECT_FALSE(world.add_cloth(open));
  ClothDef turned = balloon(0.5, 100.0f);
  std::swap(turned.triangles[0], turned.triangles[1]);
  EXPECT_FALSE(world.add_cloth(turned));
  ClothDef none = balloon(0.5, -2.0e5f);
  EXPECT_FALSE(world.add_cloth(none));
  ClothDef inward = balloon(0.5, 1000.0f);
  for (std::size_t t = 0; t < inward.triangles.size(); t += 3) std::swap(inward.triangles[t], inward.triangles[t + 1]);
  const SoftId soft = world.add_cloth(inward);
  ASSERT_TRUE(soft);
  EXPECT_GT(world.soft_info(soft).volume, 0.4);
  for (int i = 0; i < 10; ++i) world.step(kStep);
  const auto bytes = save_snapshot(world);
  Result<World> other = load_snapshot(bytes);
  ASSERT_TRUE(other);
  EXPECT_EQ(other->hash(), world.hash());
  for (int i = 0; i < 10; ++i) world.step(kStep), other->step(kStep);
  EXPECT_EQ(other->hash(), world.hash());
  EXPECT_GT(world.soft_info(soft).pressure, 0.0);
}

}  // namespace
}  // namespace gyre
