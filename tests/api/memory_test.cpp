// A step that has seen its scene before takes no memory, neither by the engine's door nor around it; a resting box is small.
#include "base/memory.h"
#include "laws/kit.h"
#include "world/world_state.h"

#include <gyre/debug.h>

#include <atomic>
#include <cstdlib>
#include <new>

namespace {
std::atomic<long> news{0};
}

// Counting stand-ins for the whole program. The compiler cannot see that they belong together.
#if defined(__GNUC__) && !defined(__clang__)
#pragma GCC diagnostic ignored "-Wmismatched-new-delete"
#endif
void* operator new(std::size_t bytes) {
  news.fetch_add(1, std::memory_order_relaxed);
  void* const p = std::malloc(bytes == 0 ? 1 : bytes);
  if (p == nullptr) std::abort();
  return p;
}
void* operator new(std::size_t bytes, std::align_val_t align) {
  news.fetch_add(1, std::memory_order_relaxed);
  const std::size_t a = std::size_t(align);
  void* const p = std::aligned_alloc(a, (bytes + a - 1) / a * a);
  if (p == nullptr) std::abort();
  return p;
}
void* operator new(std::size_t bytes, std::align_val_t align, const std::nothrow_t&) noexcept {
  return operator new(bytes, align);
}
void operator delete(void* p) noexcept { std::free(p); }
void operator delete(void* p, std::size_t) noexcept { std::free(p); }
void operator delete(void* p, std::align_val_t) noexcept { std::free(p); }
void operator delete(void* p, std::size_t, std::align_val_t) noexcept { std::free(p); }

namespace gyre::laws {
namespace {

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
  world.state().walks = false;  // the walks of debug builds take memory
  for (int i = 0; i < warm_up; ++i) world.step(kStep);
  const Taken t = taken_by_steps(world, steps);
  std::printf("[row] %s: %ld allocations, %llu by the engine's door, in %d steps\n", name, t.news,
              (unsigned long long)(t.blocks), steps);
  EXPECT_EQ(t.news, 0) << name;
  EXPECT_EQ(t.blocks, 0u) << name;
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
    world.add_joint({.kind = JointKind::ball, .a = last, .b = link, .anchor = {double(i), 0, 0}});
    last = link;
  }
  expect_none(world, 600, 120, "chain on two threads");
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

}  // namespace
}  // namespace gyre::laws
