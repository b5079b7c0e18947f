// What a broad phase costs a step, against the number of bodies: a fifth of them have changed their boxes, as in a world at
// work, and the pairs of these are asked for. One thread, and its own time: what else the machine does counts little.
//
// Worlds, each with about one pair a body whatever their number:
//   uniform     boxes of 1 m anywhere in a cube
//   clustered   the same in heaps of 500, far apart
//   unequal     sides from 0.1 to 30 m, as many from 0.1 to 1 as from 1 to 10
//
// tools/draw_broad_phases.py makes the chart and the table of docs/broad_phases.md of what this prints as JSON. A run whose
// next smaller one took too long a step is left out and says so.
#include "collision/broadphase/broadphase.h"

#include <benchmark/benchmark.h>

#include <time.h>

#include <cmath>
#include <map>
#include <string>
#include <utility>
#include <vector>

namespace {

using namespace gyre;

enum class Layout { uniform, clustered, unequal };
constexpr const char* kLayoutNames[] = {"uniform", "clustered", "unequal"};

constexpr double kMaxSeconds = 2.5;   // a step; the next larger world is then left out
constexpr int kShare = 5;             // one in so many bodies changes its box in a step
constexpr std::int64_t kCounts[] = {100, 300, 1000, 3000, 10000, 30000, 100000, 300000, 1000000};

struct Random {
  std::uint64_t state = 88172645463325252ull;
  float real(float low, float high) {
    state ^= state << 13;
    state ^= state >> 7;
    state ^= state << 17;
    return low + (high - low) * float(state >> 40) * (1.0f / 16777216.0f);
  }
  Vec3 vector(float low, float high) {
    const float x = real(low, high), y = real(low, high);
    return {x, y, real(low, high)};
  }
};

double thread_seconds() {
  timespec now{};
  clock_gettime(CLOCK_THREAD_CPUTIME_ID, &now);
  return double(now.tv_sec) + 1e-9 * double(now.tv_nsec);
}

float side_for(double volume) { return float(std::cbrt(volume)); }

struct World {
  std::vector<Proxy> proxies;
  std::vector<Vec3> velocities;  // m a step
  std::vector<std::vector<std::uint32_t>> shares;
  int step = 0;

  World(Layout layout, std::size_t count) : shares(kShare) {
    Random random;
    constexpr std::size_t kHeap = 500;
    const double heaps = double((count + kHeap - 1) / kHeap);
    Vec3 heap;
    for (std::size_t i = 0; i < count; ++i) {
      float size = 1.0f, side = side_for(4.0 * double(count));
      Vec3 place = random.vector(-0.5f * side, 0.5f * side);
      if (layout == Layout::clustered) {
        side = side_for(4.0 * double(std::min(count, kHeap)));
        // Heaps 20 of their sides apart, so that nearly all of space is empty.
        if (i % kHeap == 0) heap = 20.0f * side * float(std::cbrt(heaps)) * random.vector(-0.5f, 0.5f);
        place = heap + random.vector(-0.5f * side, 0.5f * side);
      }
      if (layout == Layout::unequal) {
        size = 0.1f * std::pow(300.0f, random.real(0.0f, 1.0f));
        side = side_for(2820.0 * double(count));  // half of the mean of (size + size)^3
        place = random.vector(-0.5f * side, 0.5f * side);
      }
      const Vec3 half = 0.5f * size * Vec3{1, 1, 1};
      Proxy proxy;
      proxy.fat_box = {place - half, place + half};
      proxy.body = std::uint32_t(i);
      proxy.motion = ProxyMotion::moving;
      proxies.push_back(proxy);
      velocities.push_back(0.2f * size * random.vector(-1, 1));
      shares[i % kShare].push_back(std::uint32_t(i));
    }
  }

  // Moves a fifth of the bodies, out for ten rounds and back for ten.
  const std::vector<std::uint32_t>& move() {
    const std::vector<std::uint32_t>& moved = shares[std::size_t(step % kShare)];
    const float sign = step / kShare % 20 < 10 ? 1.0f : -1.0f;
    for (const std::uint32_t i : moved) {
      Aabb& box = proxies[i].fat_box;
      box = {box.low + sign * velocities[i], box.high + sign * velocities[i]};
    }
    ++step;
    return moved;
  }
};

void run(benchmark::State& state, BroadPhaseKind kind, Layout layout) {
  // The slowest step of each broad phase and layout so far.
  static std::map<std::pair<BroadPhaseKind, Layout>, double> slowest;
  double& seconds = slowest[{kind, layout}];
  if (seconds > kMaxSeconds) {
    state.SkipWithError("left out: a smaller world took too long a step");
    return;
  }
  World world(layout, std::size_t(state.range(0)));
  TaskSystem tasks(1);
  const auto broadphase = make_broadphase(kind);
  broadphase->rebuild(world.proxies);
  Array<std::uint64_t> pairs;
  std::size_t found = 0, steps = 0;
  const auto one_step = [&] {
    const std::vector<std::uint32_t>& moved = world.move();
    const double start = thread_seconds();
    broadphase->update(world.proxies, moved);
    pairs.clear();
    broadphase->find_pairs(world.proxies, moved, tasks, pairs);
    broadphase->trim();
    const double passed = thread_seconds() - start;
    found += pairs.size();
    ++steps;
    return passed;
  };
  for (int i = 0; i < 3; ++i) seconds = one_step();
  for (auto _ : state) state.SetIterationTime(one_step());
  state.counters["pairs"] = benchmark::Counter(double(found) / double(steps));
  state.counters["bytes_per_body"] = benchmark::Counter(double(broadphase->bytes()) / double(state.range(0)));
}

const bool registered = [] {
  for (int layout = 0; layout < 3; ++layout) {
    for (int kind = 0; kind < kBroadPhaseKindCount; ++kind) {
      const std::string name =
          std::string("broad_phase/") + kLayoutNames[layout] + "/" + to_string(BroadPhaseKind(kind));
      benchmark::internal::Benchmark* const one = benchmark::RegisterBenchmark(
          name.c_str(), [=](benchmark::State& state) { run(state, BroadPhaseKind(kind), Layout(layout)); });
      for (const std::int64_t count : kCounts) one->Arg(count);
      one->UseManualTime()->Unit(benchmark::kMillisecond)->MinTime(0.2);
    }
  }
  return true;
}();

}  // namespace
