// Prints the state's hash of every scene and of some random worlds every 50 steps, the hash of each scene's pose track, and
// nothing else: whatever compiler, optimisation and processor this is built for, and whatever threads and SIMD width it is
// given, the output must be determinism/golden.txt. With numbers, it prints those random worlds instead. With --steps, scenes
// end sooner, for builds whose steps are slow.
// Usage: determinism [--steps N] [threads] [simd width] [first random world] [last random world]
#include "../determinism/random_world.h"
#include "../determinism/scenes.h"

#include <gyre/replay.h>

#include <cinttypes>
#include <cstdio>
#include <cstdlib>
#include <cstring>

namespace {

using namespace gyre;

constexpr int kRandomWorlds = 16;
constexpr int kRandomSteps = 100;

void print_hash(const char* name, int step, const World& world) {
  if (step % scenes::kHashEvery == 0) std::printf("%s %d %016" PRIx64 "\n", name, step, world.hash());
}

struct HashSink final : ByteSink {
  bool write(std::span<const std::byte> bytes) override {
    for (const std::byte byte : bytes) hash = (hash ^ std::uint64_t(byte)) * 0x100000001b3u;  // FNV-1a
    return true;
  }
  std::uint64_t hash = 0xcbf29ce484222325u;
};

// The hash of a recording's bytes, by when it is whole.
void print_track(const char* name, Recorder& recorder, const HashSink& sink, int steps) {
  if (recorder.finish()) std::printf("%s_track %d %016" PRIx64 "\n", name, steps, sink.hash);
}

bool print_scene(const scenes::Scene& scene, const WorldDef& def, int steps) {
  Result<World> made = World::create(def);
  if (!made) return false;
  World world = *std::move(made);
  scene.build(world);
  HashSink sink;
  Recorder recorder(world, sink, {.commands = false});
  for (int step = 0; step < steps; ++step) {
    scenes::step_scene(scene, world, step);
    print_hash(scene.name, step + 1, world);
  }
  print_track(scene.name, recorder, sink, steps);
  return true;
}

bool print_random_world(int number, const WorldDef& computed) {
  scenes::RandomWorld random{std::uint32_t(number)};
  WorldDef def = random.def();
  def.threads = computed.threads;
  def.simd_width = computed.simd_width;
  Result<World> made = World::create(def);
  if (!made) return false;
  World world = *std::move(made);
  random.build(world);
  char name[32];
  std::snprintf(name, sizeof name, "random_%d", number);
  for (int step = 0; step < kRandomSteps; ++step) {
    random.step(world, step);
    print_hash(name, step + 1, world);
  }
  return true;
}

}  // namespace

int main(int argc, char** argv) {
  int steps = scenes::kSteps;
  if (argc > 2 && std::strcmp(argv[1], "--steps") == 0) {
    steps = std::atoi(argv[2]);
    argc -= 2;
    argv += 2;
  }
  const auto argument = [&](int place, int otherwise) {
    return argc > place ? std::atoi(argv[place]) : otherwise;
  };
  WorldDef def;
  def.threads = argument(1, 1);
  def.simd_width = argument(2, 0);
  if (argc <= 3) {
    for (const scenes::Scene& scene : scenes::kScenes) {
      if (!print_scene(scene, def, steps)) return 1;
    }
  }
  const int first = argument(3, 0);
  for (int number = first; number <= argument(4, first + kRandomWorlds - 1); ++number) {
    if (!print_random_world(number, def)) return 1;
  }
  return 0;
}
