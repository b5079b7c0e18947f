// Crowds: pits of boxes, coincident bodies, many fixed bodies, endless coming and going, and steps of changing length.
#include "base/memory/memory.h"
#include "laws/kit.h"

#include <gyre/debug.h>

#include <chrono>

namespace gyre::laws::crowd_test {
namespace {

double seconds_since(std::chrono::steady_clock::time_point start) {
  return std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
}

// All structures of the engine agree with each other.
void expect_whole(const World& world) {
  const Error fault = validate(world);
  EXPECT_EQ(fault.code, ErrorCode::none) << fault.message;
}

// A pit with a floor and four walls, and boxes dropped into it layer upon layer.
struct Pit {
  World world;
  std::vector<BodyId> boxes;
  double half;
};
Pit fill(int n, int side) {
  Pit pit{make_world({.threads = 2}), {}, 0.6 * side + 0.5};
  add_ground(pit.world);
  const float half = float(pit.half), tall = 100.0f;
  for (int k = 0; k < 4; ++k) {
    const double s = k % 2 == 0 ? 1.0 : -1.0;
    const DVec3 p = k / 2 == 0 ? DVec3{s * (pit.half + 0.5), 0, 0} : DVec3{0, 0, s * (pit.half + 0.5)};
    const Vec3 h = k / 2 == 0 ? Vec3{0.5f, tall, half + 1} : Vec3{half + 1, tall, 0.5f};
    pit.world.add_body({.type = BodyType::fixed, .pose = {.position = p}}, {.geometry = Box{h}});
  }
  for (int i = 0; i < n; ++i) {
    const int layer = i / (side * side), x = i % side, z = i / side % side;
    BodyDef def;
    def.pose.position = {1.2 * (x - 0.5 * (side - 1)) + 0.05 * ((layer * 7 + z) % 3 - 1), 1.0 + 1.3 * layer,
                         1.2 * (z - 0.5 * (side - 1)) + 0.05 * ((layer * 5 + x) % 3 - 1)};
    def.pose.orientation = from_axis_angle({1, 0.4f, 0.2f}, 0.1f * float((i * 31) % 7));
    pit.boxes.push_back(pit.world.add_body(def, {.geometry = Box{}}));
  }
  return pit;
}
void expect_contained(const Pit& pit) {
  for (const BodyId b : pit.boxes) {
    const DVec3 p = pit.world.pose(b).position;
    ASSERT_TRUE(is_finite(p));
    ASSERT_LT(std::fabs(p.x), pit.half);
    ASSERT_LT(std::fabs(p.z), pit.half);
    ASSERT_GT(p.y, 0.3);
  }
}
// Nothing leaves the pit, nothing is lost, and everything comes to rest without deep overlap.
void drop(int n, int side, double seconds, const char* name) {
  Pit pit = fill(n, side);
  const auto start = std::chrono::steady_clock::now();
  run(pit.world, seconds);
  expect_contained(pit);
  expect_whole(pit.world);
  std::printf("[row] %s: %d boxes, %.1f s of computing for %g s\n", name, n, seconds_since(start), seconds);
  EXPECT_TRUE(limit_row("deepest penetration (m)", double(pit.world.max_penetration()), 1e-2, 5e-3));
  EXPECT_TRUE(limit_row("awake", pit.world.stats().awake_bodies, 0, 0));
}
TEST(Pit, KeepsAThousandBoxes) { drop(1000, 8, 10.0, "pit"); }
TEST(LongPit, KeepsTenThousandBoxes) { drop(10000, 18, 30.0, "long pit"); }

TEST(Capacity, ManyCoincidentBodiesTakeBoundedTime) {
  World world = make_world({.gravity = {0, 0, 0}, .sleeping = false});
  for (int i = 0; i < 150; ++i) world.add_body({}, {.geometry = Sphere{}});
  const auto start = std::chrono::steady_clock::now();
  for (int i = 0; i < 5; ++i) world.step(kStep);
  const double t = seconds_since(start);
  EXPECT_LT(t, 10.0);
  expect_whole(world);
  for (const Pose& p : world.bodies().poses) EXPECT_TRUE(is_finite(p));
}
TEST(LongCapacity, FiveThousandCoincidentShapesOfFixedBodies) {
  World world = make_world();
  for (int i = 0; i < 5000; ++i) world.add_body({.type = BodyType::fixed}, {.geometry = Box{}});
  const BodyId ball = world.add_body({.pose = {.position = {0, 2, 0}}}, {.geometry = Sphere{}});
  const auto start = std::chrono::steady_clock::now();
  for (int i = 0; i < 120; ++i) world.step(kStep);
  EXPECT_LT(seconds_since(start), 30.0);
  EXPECT_NEAR(world.pose(ball).position.y, 1.0, 0.02);
}
TEST(Capacity, FiveThousandShapesOnOneBody) {
  World world = make_world();
  add_ground(world);
  std::vector<ShapeDef> shapes;
  for (int i = 0; i < 5000; ++i) {
    shapes.push_back(
        {.geometry = Sphere{0.05f},
         .local = {.position = {0.1f * float(i % 50), 0.1f * float(i / 2500), 0.1f * float(i / 50 % 50)}}});
  }
  const BodyId slab = world.add_body({.pose = {.position = {0, 0.2, 0}}}, shapes);
  const auto start = std::chrono::steady_clock::now();
  for (int i = 0; i < 60; ++i) world.step(kStep);
  EXPECT_LT(seconds_since(start), 20.0);
  EXPECT_NEAR(world.pose(slab).position.y, 0.05, 0.02);
  expect_whole(world);
}
TEST(LongCapacity, AHundredThousandFixedAndAThousandMoving) {
  World world = make_world();
  for (int i = 0; i < 100000; ++i) {
    world.add_body({.type = BodyType::fixed, .pose = {.position = {double(i % 320), -0.5, double(i / 320)}}},
                   {.geometry = Box{}});
  }
  std::vector<BodyId> moving;
  for (int i = 0; i < 1000; ++i) {
    moving.push_back(world.add_body({.pose = {.position = {5.5 + 9.0 * (i % 32), 0.6, 5.5 + 9.0 * (i / 32)}}},
                                    {.geometry = Box{}}));
  }
  world.step(kStep);
  const auto start = std::chrono::steady_clock::now();
  for (int i = 0; i < 120; ++i) world.step(kStep);
  const double each = seconds_since(start) / 120.0;
  EXPECT_TRUE(limit_row("B-07 seconds a step among 100,000 fixed", each, 0.1, 0.01));
  for (const BodyId b : moving) EXPECT_NEAR(world.pose(b).position.y, 0.5, 0.02);
  expect_whole(world);
}

TEST(Churn, MemoryReachesAPlateau) {
  World world = make_world();
  add_ground(world);
  std::vector<BodyId> ring(200);
  std::uint64_t early = 0, late = 0;
  for (int i = 0; i < 100000; ++i) {
    BodyId& slot = ring[std::size_t(i) % ring.size()];
    if (slot) {
      ASSERT_TRUE(world.remove_body(slot));
    }
    slot = world.add_body({.pose = {.position = {double(i % 20), 0.5 + 0.01 * (i % 7), double(i / 20 % 10)}}},
                          {.geometry = Box{{0.4f, 0.4f, 0.4f}}});
    ASSERT_TRUE(slot);
    if (i % 500 == 0) world.step(kStep);
    if (i % 2500 == 13) expect_whole(world);
    if (i == 20000) early = total_bytes();
    late = total_bytes();
  }
  EXPECT_EQ(world.stats().bodies, 201);
  EXPECT_TRUE(limit_row("B-08 memory late over early", double(late) / double(early), 1.05, 1.0));
}

// Steps of 1 to 100 ms at random: a frictionless elastic gas keeps its energy, a tower stands.
void jitter(int steps) {
  World gas = make_world({.gravity = {0, 0, 0}, .sleeping = false}), tower = make_world({.sleeping = false});
  const Material lively = surface(0, 1);
  for (int side = 0; side < 6; ++side) {
    const float s = side % 2 == 0 ? 1.0f : -1.0f;
    gas.add_body(
        {.type = BodyType::fixed},
        {.geometry = Plane{.normal = {side / 2 == 0 ? s : 0, side / 2 == 1 ? s : 0, side / 2 == 2 ? s : 0},
                           .offset = -4.0f},
         .material = lively});
  }
  for (int i = 0; i < 27; ++i) {
    gas.add_body({.pose = {.position = {2.0 * (i % 3) - 2, 2.0 * (i / 3 % 3) - 2, 2.0 * (i / 9) - 2}},
                  .linear_velocity = {float(i % 5) - 2, float(i % 7) - 3, float(i % 3) - 1}},
                 {.geometry = Sphere{0.4f}, .material = lively});
  }
  add_ground(tower);
  BodyId top;
  for (int i = 0; i < 5; ++i)
    top = tower.add_body({.pose = {.position = {0, 0.5 + i, 0}}}, {.geometry = Box{}});
  const double start = gas.energy().kinetic;
  std::uint32_t random = 12345;
  for (int i = 0; i < steps; ++i) {
    random = random * 1664525u + 1013904223u;
    const float dt = 0.001f + 0.099f * float(random >> 8) / 16777216.0f;
    ASSERT_TRUE(gas.step(dt));
    ASSERT_TRUE(tower.step(dt));
  }
  EXPECT_TRUE(limit_row("B-27 energy over start", gas.energy().kinetic / start, 1.01, 1.0001));
  EXPECT_NEAR(tower.pose(top).position.y, 4.5, 0.05);
  EXPECT_LT(std::fabs(tower.pose(top).position.x) + std::fabs(tower.pose(top).position.z), 0.05);
}
TEST(Jitter, OfTheStepForAMinute) { jitter(3600); }
TEST(LongJitter, OfTheStepForAnHour) { jitter(216000); }

TEST(Scale, LargeGroundLittleBoxes) {
  World world = make_world();
  world.add_body({.type = BodyType::fixed, .pose = {.position = {0, -1, 0}}},
                 {.geometry = Box{{1e6f, 1, 1e6f}}});
  std::vector<BodyId> boxes;
  for (int i = 0; i < 5; ++i)
    boxes.push_back(world.add_body({.pose = {.position = {3e5, 0.05 + 0.1 * i, -2e5}}},
                                   {.geometry = Box{{0.05f, 0.05f, 0.05f}}}));
  run(world, 5.0);
  EXPECT_TRUE(
      row("B-18 top of five boxes of 10 cm (m)", world.pose(boxes.back()).position.y, 0.45, 2e-3, 1e-4));
  EXPECT_EQ(world.stats().awake_bodies, 0) << "B-18";
}
TEST(Scale, AScrewOnAKilometreOfTerrain) {
  World world = make_world();
  std::vector<float> heights(101 * 101);
  for (std::size_t i = 0; i < heights.size(); ++i) heights[i] = 0.5f * float(i % 101);
  const Result<Geometry> field =
      cook_height_field({.heights = heights, .columns = 101, .rows = 101, .spacing = 10.0f});
  ASSERT_TRUE(field);
  world.add_body({.type = BodyType::fixed}, {.geometry = *field});
  // The slope rises 0.5 m in 10 m along x; at the origin the ground is at 25 m.
  const BodyId screw = world.add_body({.pose = {.position = {0.3, 25.015 + 0.002, 0.2}}},
                                      {.geometry = Box{{0.0005f, 0.0005f, 0.002f}}});
  const BodyId house =
      world.add_body({.pose = {.position = {105.0, 25.0 + 5.25 + 5.6, 3.0}}}, {.geometry = Box{{5, 5, 5}}});
  run(world, 5.0);
  const DVec3 p = world.pose(screw).position;
  EXPECT_TRUE(row("B-19 screw above the ground (m)", p.y - (25.0 + 0.05 * p.x), 0.0005, 2e-4, 2e-5));
  const DVec3 q = world.pose(house).position;
  EXPECT_NEAR(q.y - (25.0 + 0.05 * q.x), 5.0, 0.05) << "B-19";
}
TEST(Scale, StacksFarAwaySleepInTheSameStep) {
  std::uint64_t frames[3] = {0, 0, 0};
  const double places[] = {0.0, 1e4, 1e7};
  for (int k = 0; k < 3; ++k) {
    World world = make_world();
    world.add_body({.type = BodyType::fixed, .pose = {.position = {places[k], -1, places[k]}}},
                   {.geometry = Box{{20, 1, 20}}});
    std::vector<BodyId> boxes;
    for (int i = 0; i < 5; ++i)
      boxes.push_back(
          world.add_body({.pose = {.position = {places[k], 0.6 + 1.1 * i, places[k]}}}, {.geometry = Box{}}));
    while (world.stats().awake_bodies > 0 && world.step_count() < 1200) world.step(kStep);
    frames[k] = world.step_count();
    EXPECT_NEAR(world.pose(boxes.back()).position.y, 4.5, 1e-2) << places[k];
    EXPECT_NEAR(world.pose(boxes.back()).position.x, places[k], 1e-3) << places[k];
  }
  EXPECT_EQ(frames[0], frames[1]) << "B-17";
  EXPECT_EQ(frames[0], frames[2]) << "B-17";
}

}  // namespace
}  // namespace gyre::laws::crowd_test
