// A step that has seen its scene before takes no memory, neither by the engine's door nor around it; a resting box is small.
#include "base/memory/memory.h"
#include "base/check.h"
#include "laws/kit.h"
#include "world/world_access.h"
#include "world/world_state.h"

#include <gyre/debug.h>

#include <algorithm>
#include <array>
#include <atomic>
#include <cstdlib>
#include <cstring>
#include <new>

namespace {
std::atomic<long> news{0};
std::atomic<long long> bytes_out{0};

// Each block has its size in front of it, at a distance that keeps the alignment.
constexpr std::size_t kPlain = 16;
void* take(std::size_t bytes, std::size_t align) {
  news.fetch_add(1, std::memory_order_relaxed);
  bytes_out.fetch_add((long long)(bytes), std::memory_order_relaxed);
  const std::size_t front = align < kPlain ? kPlain : align;
  char* const block = static_cast<char*>(std::aligned_alloc(front, (bytes + 2 * front - 1) / front * front));
  if (block == nullptr) std::abort();
  std::memcpy(block, &bytes, sizeof bytes);
  return block + front;
}
void give(void* p, std::size_t align) {
  if (p == nullptr) return;
  char* const block = static_cast<char*>(p) - (align < kPlain ? kPlain : align);
  std::size_t bytes = 0;
  std::memcpy(&bytes, block, sizeof bytes);
  bytes_out.fetch_sub((long long)(bytes), std::memory_order_relaxed);
  std::free(block);
}
}  // namespace

// Counting stand-ins for the whole program. The compiler cannot see that they belong together.
#if defined(__GNUC__) && !defined(__clang__)
#pragma GCC diagnostic ignored "-Wmismatched-new-delete"
#endif
void* operator new(std::size_t bytes) { return take(bytes, kPlain); }
void* operator new(std::size_t bytes, std::align_val_t align) { return take(bytes, std::size_t(align)); }
void* operator new(std::size_t bytes, std::align_val_t align, const std::nothrow_t&) noexcept {
  return take(bytes, std::size_t(align));
}
void operator delete(void* p) noexcept { give(p, kPlain); }
void operator delete(void* p, std::size_t) noexcept { give(p, kPlain); }
void operator delete(void* p, std::align_val_t align) noexcept { give(p, std::size_t(align)); }
void operator delete(void* p, std::size_t, std::align_val_t align) noexcept { give(p, std::size_t(align)); }

namespace gyre::laws::memory_test {
namespace {

// By the engine's door and by operator new.
long long bytes_held() { return bytes_out.load() + (long long)(total_bytes()); }

struct Taken {
  long news;
  std::uint64_t blocks;
};
Taken taken_by_steps(World& world, int steps) {
  const long before = news.load();
  const std::uint64_t blocks = allocation_count();
  for (int i = 0; i < steps; ++i) world.step(kStep);
  return {news.load() - before, allocation_count() - blocks};
}
void expect_none(World& world, int warm_up, int steps, const char* name) {
  state_of(world).validates = false;  // state validation in debug builds takes memory
  for (int i = 0; i < warm_up; ++i) world.step(kStep);
  const Taken t = taken_by_steps(world, steps);
  std::printf("[row] %s: %ld allocations, %llu by the engine's door, in %d steps\n", name, t.news,
              (unsigned long long)(t.blocks), steps);
  EXPECT_EQ(t.news, 0) << name;
  EXPECT_EQ(t.blocks, 0u) << name;
}

// What a host's allocator was asked for.
struct HostMemory {
  std::atomic<long long> out{0};
  std::atomic<int> taken{0}, returned{0}, changed{0};
};
AllocatorHooks hooks_of(HostMemory& memory) {
  return {.allocate =
              [](std::size_t bytes, std::size_t align, void* user) {
                auto& m = *static_cast<HostMemory*>(user);
                m.out += (long long)(bytes);
                ++m.taken;
                return std::aligned_alloc(align, (bytes + align - 1) / align * align);
              },
          .deallocate =
              [](void* block, std::size_t bytes, void* user) {
                auto& m = *static_cast<HostMemory*>(user);
                m.out -= (long long)(bytes);
                ++m.returned;
                std::free(block);
              },
          .reallocate =
              [](void* block, std::size_t old_bytes, std::size_t bytes, std::size_t align, void* user) {
                auto& m = *static_cast<HostMemory*>(user);
                m.out += (long long)(bytes) - (long long)(old_bytes);
                ++m.changed;
                void* const moved = std::aligned_alloc(align, (bytes + align - 1) / align * align);
                if (moved != nullptr) std::memcpy(moved, block, std::min(old_bytes, bytes));
                std::free(block);
                return moved;
              },
          .user = &memory};
}
// Large enough for blocks that change their size.
std::uint64_t hash_of_a_heap() {
  World world = make_world({.threads = 2, .sleeping = false});
  add_ground(world);
  for (int i = 0; i < 2000; ++i) {
    world.add_body({.pose = {.position = {1.1 * (i % 10), 1.0 + 1.1 * (i / 100), 1.1 * (i / 10 % 10)}}},
                   {.geometry = Box{}});
  }
  for (int i = 0; i < 60; ++i) world.step(kStep);
  return world.hash();
}

TEST(HostAllocator, ServesAWholeWorld) {
  const std::uint64_t expected = hash_of_a_heap();
  HostMemory memory;
  ASSERT_EQ(total_bytes(), 0u) << "a test before this one leaked";
  ASSERT_TRUE(set_allocator(hooks_of(memory)));
  EXPECT_EQ(hash_of_a_heap(), expected);
  EXPECT_GT(memory.changed, 0);
  EXPECT_EQ(memory.taken, memory.returned);
  EXPECT_EQ(memory.out, 0);
  ASSERT_TRUE(set_allocator({}));
}

TEST(NoAllocation, InAStackAtRest) {
  World world = make_world({.sleeping = false});
  add_ground(world);
  for (int i = 0; i < 10; ++i) world.add_body({.pose = {.position = {0, 0.5 + i, 0}}}, {.geometry = Box{}});
  expect_none(world, 60, 120, "stack");
}
TEST(NoAllocation, InAHeapAtRest) {
  World world = make_world({.sleeping = false});
  add_ground(world);
  for (int i = 0; i < 200; ++i) {
    world.add_body({.pose = {.position = {1.1 * (i % 5), 1.0 + 1.1 * (i / 25), 1.1 * (i / 5 % 5)}}},
                   {.geometry = Box{}});
  }
  expect_none(world, 600, 120, "heap");
}
TEST(NoAllocation, InJointsAndThreads) {
  World world = make_world({.threads = 2, .sleeping = false});
  BodyId last;
  for (int i = 0; i < 20; ++i) {
    const BodyId link =
        world.add_body({.pose = {.position = {0.5 + i, 0, 0}}}, {.geometry = Capsule{0.1f, 0.2f}});
    world.add_joint(BallDef{.a = last, .b = link, .anchor = {double(i), 0, 0}});
    last = link;
  }
  expect_none(world, 2400, 120, "chain on two threads");  // it swings for long, and now and then links touch
}
void add_piles(World& world) {
  add_ground(world);
  for (int pile = 0; pile < 24; ++pile) {
    const int boxes = pile == 12 ? 60 : 2;
    for (int i = 0; i < boxes; ++i)
      world.add_body({.pose = {.position = {20.0 * pile + 1.01 * (i % 4), 0.51 + 1.01 * (i / 4), 0}}},
                     {.geometry = Box{}});
  }
}

// Which of the workers solves which pile is chance.
TEST(NoAllocation, InPilesThatWorkersShare) {
  World world = make_world({.threads = 3, .sleeping = false});
  add_piles(world);
  expect_none(world, 20, 600, "piles on three threads");
}

// Whoever comes first does all there is: others have room for it before they ever had any of it.
TEST(NoAllocation, WhenAnotherWorkerTakesOver) {
  static int first = 0;
  WorldDef def{.sleeping = false};
  def.host_tasks.worker_count = 3;
  def.host_tasks.run = [](void*, int count, void (*task)(void*, int), void* context) {
    for (int i = 0; i < count; ++i) task(context, (first + i) % count);
  };
  World world = make_world(def);
  add_piles(world);
  expect_none(world, 20, 20, "the first worker");
  for (first = 1; first < 3; ++first) expect_none(world, 0, 20, "another worker");
}

TEST(NoAllocation, InFields) {
  World world = make_world({.threads = 2, .sleeping = false});
  world.add_field({.kind = FieldKind::buoyancy, .linear_drag = 0.5f});
  world.add_field({.velocity = {0.3f, 0, 0}, .turbulence = 0.3f});
  world.add_field({.kind = FieldKind::vortex, .strength = 0.1f});
  world.add_field({.kind = FieldKind::radial, .strength = 0.01f});
  for (int i = 0; i < 40; ++i) {
    const AnyShape shapes[] = {Box{{0.3f, 0.2f, 0.3f}}, Cylinder{0.2f, 0.4f}, Sphere{0.3f}};
    world.add_body({.pose = {.position = {3.0 * (i % 5), 0.2, 3.0 * (i / 5)}}},
                   {.geometry = shapes[i % 3], .density = i % 4 == 0 ? 2.0f : 400.0f});
  }
  expect_none(world, 300, 120, "fields on two threads");
}
TEST(NoAllocation, WhileStagesAreTimed) {
  World world = make_world({.sleeping = false});
  set_timing(world, true);
  add_ground(world);
  for (int i = 0; i < 10; ++i) world.add_body({.pose = {.position = {0, 0.5 + i, 0}}}, {.geometry = Box{}});
  expect_none(world, 60, 120, "timed stack");
  StepTimes times;
  read_times(world, times);
  EXPECT_EQ(times.steps, 180u);
}
TEST(NoAllocation, WhileAsleep) {
  World world = make_world();
  add_ground(world);
  for (int i = 0; i < 50; ++i) world.add_body({.pose = {.position = {2.0 * i, 0.5, 0}}}, {.geometry = Box{}});
  expect_none(world, 300, 120, "asleep");
}

// Balls and plates that are swept in every step, and slide along what they hit; a wall that moves runs over others.
TEST(NoAllocation, WhileFastBodiesFly) {
  World world = make_world({.gravity = {0, 0, 0}, .threads = 2, .sleeping = false});
  const Material smooth{.static_friction = 0.0f, .dynamic_friction = 0.0f, .restitution = 1.0f};
  for (int side = 0; side < 6; ++side) {
    DVec3 at{};
    (side / 2 == 0 ? at.x : side / 2 == 1 ? at.y : at.z) = side % 2 == 0 ? -10.0 : 10.0;
    const Vec3 half{side / 2 == 0 ? 0.5f : 11.0f, side / 2 == 1 ? 0.5f : 11.0f, side / 2 == 2 ? 0.5f : 11.0f};
    world.add_body({.type = BodyType::fixed, .pose = {.position = at}},
                   {.geometry = Box{half}, .material = smooth});
  }
  world.add_body({.type = BodyType::kinematic, .angular_velocity = {0, 3, 0}},
                 {.geometry = Box{{4, 1, 0.1f}}, .material = smooth});
  for (int i = 0; i < 60; ++i) {
    world.add_body({.pose = {.position = {-8.0 + 0.26 * i, 3.0 + 0.1 * i, -5.0 + 0.15 * i}},
                    .linear_velocity = {300, 97.0f + float(i), 41}},
                   {.geometry = i % 2 == 0 ? AnyShape(Sphere{0.1f}) : AnyShape(Box{{0.2f, 0.02f, 0.2f}}),
                    .material = smooth});
  }
  expect_none(world, 900, 120, "fast bodies");
}

// Questions of every kind, alone and in batches over two threads, in a heap that moves on between them.
TEST(NoAllocation, InQueries) {
  World world = make_world({.threads = 2});
  state_of(world).validates = false;
  std::vector<float> heights(33 * 33);
  for (std::size_t i = 0; i < heights.size(); ++i) heights[i] = 0.1f * float(i * 7919u % 10u);
  world.add_body({.type = BodyType::fixed},
                 {.geometry = *cook_height_field({.heights = heights, .columns = 33, .rows = 33})});
  for (int i = 0; i < 200; ++i) {
    world.add_body({.pose = {.position = {1.1 * (i % 10), 2.0 + 1.1 * (i / 100), 1.1 * (i / 10 % 10)}}},
                   {.geometry = i % 2 == 0 ? AnyShape(Box{}) : AnyShape(Sphere{})});
  }
  std::vector<Ray> rays(500);
  std::vector<ShapeCast> casts(100);
  std::vector<ShapePose> places(100);
  for (std::size_t i = 0; i < rays.size(); ++i)
    rays[i] = {{0.02 * double(i), 9, 0.01 * double(i)}, {0.3f, -20, 0}};
  for (std::size_t i = 0; i < casts.size(); ++i) {
    casts[i] = {Capsule{}, {{0.1 * double(i), 9, 0.1 * double(i)}, {}}, {0, -12, 0}};
    places[i] = {Box{}, {{0.1 * double(i), 2, 0.1 * double(i)}, {}}};
  }
  std::vector<CastHit> hits(rays.size());
  std::vector<ClosestPoint> closest(places.size());
  std::vector<std::uint32_t> counts(places.size()), ray_counts(rays.size());
  std::vector<std::uint8_t> any(rays.size());
  std::vector<CastHit> all_hits(3 * rays.size());
  std::vector<ClosestPoint> all_closest(3 * places.size());
  std::vector<Overlap> all_overlaps(3 * places.size());
  std::vector<Penetration> all_deep(3 * places.size());
  std::array<Penetration, 16> deep;
  std::array<Overlap, 16> overlapping;
  const auto ask = [&] {
    (void)world.cast_ray_batch(rays, hits);
    (void)world.cast_shape_batch(casts, std::span(hits).first(casts.size()));
    (void)world.closest_point_batch(places, 2.0, closest);
    (void)world.overlap_count_batch(places, counts);
    (void)world.cast_ray_any_batch(rays, any);
    (void)world.cast_ray_all_batch(rays, all_hits, ray_counts);
    (void)world.closest_point_all_batch(places, 1.0, all_closest, counts);
    (void)world.overlap_all_batch(places, all_overlaps, counts);
    (void)world.penetration_all_batch(places, all_deep, counts);
    std::size_t found = world.cast_ray_all(rays[3].origin, rays[3].translation, hits);
    for (const ShapePose& place : places) {
      found += world.penetration_all(place, deep) + world.overlap_all(place, overlapping);
      found += std::size_t(world.penetration(place).has_value());
      found += std::size_t(world.closest_point_any(place, 1.0));
      found += world.closest_point_all(place, 1.0, closest) + std::size_t(world.overlap_any(place));
      found += std::size_t(world.cast_ray_any(place.pose.position, {0, -5, 0}));
      found += std::size_t(world.closest_point(place, 2.0).has_value());
    }
    for (const ShapeCast& cast : casts) {
      found += std::size_t(world.cast_shape(cast).has_value()) + std::size_t(world.cast_shape_any(cast));
      found += world.cast_shape_all(cast, hits);
      found += std::size_t(world.cast_ray(cast.pose.position, cast.translation).has_value());
    }
    return found;
  };
  // The busiest steps come first; what steps take while the heap goes on settling is not the queries'.
  for (int i = 0; i < 300; ++i) {
    world.step(kStep);
    if (i < 60 || i > 260) ask();
  }
  Taken taken{0, 0};
  std::size_t found = 0;
  for (int i = 0; i < 30; ++i) {
    world.step(kStep);
    const long before = news.load();
    const std::uint64_t blocks = allocation_count();
    found += ask();
    taken.news += news.load() - before;
    taken.blocks += allocation_count() - blocks;
  }
  EXPECT_GT(found, 1000u);
  EXPECT_EQ(taken.news, 0);
  EXPECT_EQ(taken.blocks, 0u);
}

// ------------------------------------------------------------------------------------------------- bytes a resting box

void add_stacks(World& world, int boxes) {
  for (int i = 0; i < boxes; ++i) {
    const int stack = i / 10;
    world.add_body({.pose = {.position = {2.0 * (stack % 100), 0.5 + i % 10, 2.0 * (stack / 100)}}},
                   {.geometry = Box{}});
  }
}
void add_floor(World& world, int boxes) {
  for (int i = 0; i < boxes; ++i) {
    world.add_body({.pose = {.position = {1.5 * (i % 100), 0.5, 1.5 * (i / 100)}}}, {.geometry = Box{}});
  }
}
// Walls of twenty rows in which each box lies on two: nearly three manifolds a box.
void add_walls(World& world, int boxes) {
  for (int i = 0; i < boxes; ++i) {
    const int wall = i / 200, row = i % 200 / 10, column = i % 10;
    world.add_body({.pose = {.position = {1.02 * column + 0.51 * (row % 2), 0.5 + row, 2.0 * wall}}},
                   {.geometry = Box{}});
  }
}

// Everything that the world allocates, by box, once what only its first steps needed is given back.
double bytes_a_box(void (*add)(World&, int), int boxes, bool sleeping) {
  const long long before = bytes_held();
  World world = make_world({.threads = 1, .sleeping = sleeping});
  add_ground(world);
  add(world, boxes);
  for (int i = 0; i < 140; ++i) world.step(kStep);
  if (!sleeping) {
    EXPECT_EQ(world.stats().awake_bodies, boxes);
  }
  return double(bytes_held() - before) / boxes;
}
void expect_small(const char* name, void (*add)(World&, int), double most) {
  if (kAssertsActive) GTEST_SKIP() << "too slow in a build that checks itself; the bytes are the same";
  const double awake = bytes_a_box(add, 10000, false), asleep = bytes_a_box(add, 10000, true);
  std::printf("[row] %s of 10,000 boxes: %.0f B a box awake, %.0f B where they may sleep\n", name, awake,
              asleep);
  EXPECT_LT(awake, most);
  EXPECT_LT(asleep, most);
}

TEST(BytesOfARestingBox, InAStack) { expect_small("stacks", add_stacks, 1024); }
TEST(LongBytesOfARestingBox, OnTheFloor) { expect_small("a floor", add_floor, 1024); }
TEST(LongBytesOfARestingBox, InAWall) { expect_small("walls", add_walls, 2048); }

TEST(LongBytesOfARestingBox, AreTheSameForAHundredThousand) {
  if (kAssertsActive) GTEST_SKIP() << "too slow in a build that checks itself; the bytes are the same";
  const double many = bytes_a_box(add_stacks, 100000, false);
  std::printf("[row] stacks of 100,000 boxes: %.0f B a box\n", many);
  EXPECT_LT(many, 1024);
}

// B-28, for as long as a test may take: ten minutes in which something comes and something goes in every step.
TEST(LongChurn, MemoryStaysBounded) {
  const long long before = bytes_held();
  World world = make_world();
  add_ground(world);
  std::vector<BodyId> bodies(300);
  std::uint32_t random = 1;
  const auto next = [&](std::uint32_t below) {
    random = random * 1664525u + 1013904223u;
    return (random >> 8) % below;
  };
  constexpr int kMinutes = 10, kStepsPerMinute = 3600;
  long long most[kMinutes] = {};
  for (int minute = 0; minute < kMinutes; ++minute) {
    for (int i = 0; i < kStepsPerMinute; ++i) {
      BodyId& body = bodies[next(300)];
      if (body) world.remove_body(body);
      const DVec3 place{double(next(8)), 1.0 + next(6), double(next(8))};
      const AnyShape geometry =
          next(2) == 0 ? AnyShape(Box{{0.4f, 0.3f + 0.01f * float(next(40)), 0.4f}}) : AnyShape(Sphere{0.4f});
      body = world.add_body({.pose = {.position = place}}, {.geometry = geometry});
      world.step(kStep);
      most[minute] = std::max(most[minute], bytes_held() - before);
    }
  }
  std::printf("[row] churn: %.0f kB at most in the first minute, %.0f kB in the last\n",
              double(most[0]) / 1e3, double(most[kMinutes - 1]) / 1e3);
  for (int minute = 2; minute < kMinutes; ++minute)
    EXPECT_LT(double(most[minute]), 1.1 * double(std::max(most[0], most[1])));
}

}  // namespace
}  // namespace gyre::laws::memory_test
