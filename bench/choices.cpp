// What a step costs with things that a user may choose, for counting under callgrind (bench/choice_counts): a scene,
// stepped so often to warm up, then so often with one of them.
//
//   bench/choices SCENE WARM_UP STEPS CHOICE
#include "bench/scenes/gyre_engine.h"

#include <gyre/debug.h>
#include <gyre/replay.h>

#include <algorithm>
#include <cstdio>
#include <cstdlib>
#include <optional>
#include <string>
#include <vector>

#if __has_include(<valgrind/callgrind.h>)
#include <valgrind/callgrind.h>
#else
#define CALLGRIND_START_INSTRUMENTATION static_cast<void>(0)
#endif

namespace {

using namespace gyre;

struct Swallow final : ByteSink {
  std::size_t bytes = 0;
  bool write(std::span<const std::byte> part) override {
    bytes += part.size();
    return true;
  }
};

struct Chosen {
  World* world = nullptr;
  bool events = false, persisting = false, poses = false, counts = false;
  std::vector<ContactPair> room{};
  Rollback* ring = nullptr;
  double sum = 0;  // of what was read, so that it is read
};

// Counted: a step, and what its user does with it.
[[gnu::noinline]] void advance(Chosen& chosen) {
  World& world = *chosen.world;
  world.step(float(bench::kDt));
  if (chosen.events) {
    const Events& events = world.events();
    for (const ContactBegin& e : events.begins) chosen.sum += double(e.shape_a.index + e.shape_b.index);
    for (const ContactEnd& e : events.ends) chosen.sum += double(e.shape_a.index + e.shape_b.index);
    for (const ContactHit& e : events.hits) chosen.sum += double(e.approach_speed);
    for (const SleepChange& e : events.sleep_changes) chosen.sum += double(e.body.index);
  }
  if (chosen.persisting) {
    std::size_t found = world.contact_pairs(chosen.room);
    if (found > chosen.room.size()) {
      chosen.room.resize(found + found / 4);
      found = world.contact_pairs(chosen.room);
    }
    for (std::size_t i = 0; i < found; ++i) chosen.sum += double(chosen.room[i].impulse);
  }
  if (chosen.poses) {
    for (const Pose& pose : world.bodies().poses) chosen.sum += pose.position.y;
  }
  if (chosen.counts) chosen.sum += world.stats().contact_points;
  if (chosen.ring != nullptr) chosen.ring->save(world);
}

}  // namespace

int main(int count, char** arguments) {
  if (count != 5) {
    std::fprintf(stderr,
                 "usage: %s SCENE WARM_UP STEPS "
                 "plain|events|persisting|poses|counts|timing|commands|track|recording|rollback\n",
                 arguments[0]);
    return 2;
  }
  const std::optional<bench::Scene> scene = bench::find_scene(arguments[1]);
  const int warm_up = std::atoi(arguments[2]), steps = std::atoi(arguments[3]);
  const std::string choice = arguments[4];
  if (!scene || steps <= 0) return 2;
  bench::GyreEngine engine;
  std::string why_not;
  if (!engine.create(*scene, 1, false, why_not)) {
    std::fprintf(stderr, "%s\n", why_not.c_str());
    return 1;
  }
  for (int i = 0; i < warm_up; ++i) engine.step();
  Chosen chosen;
  chosen.world = &engine.world();
  Swallow sink;
  std::optional<Recorder> recorder;
  std::optional<Rollback> ring;
  if (choice == "events")
    chosen.events = true;
  else if (choice == "persisting")
    chosen.persisting = true;
  else if (choice == "poses")
    chosen.poses = true;
  else if (choice == "counts")
    chosen.counts = true;
  else if (choice == "timing")
    set_timing(engine.world(), true);
  else if (choice == "commands")
    recorder.emplace(engine.world(), sink, RecordOptions{.poses = false});
  else if (choice == "track")
    recorder.emplace(engine.world(), sink, RecordOptions{.commands = false});
  else if (choice == "recording")
    recorder.emplace(engine.world(), sink);
  else if (choice == "rollback")
    chosen.ring = &ring.emplace(60);
  else if (choice != "plain")
    return 2;
  advance(chosen);  // the first one makes room
  CALLGRIND_START_INSTRUMENTATION;
  for (int i = 0; i < steps; ++i) advance(chosen);
  std::printf("%s: %d steps, %.17g read, %zu bytes recorded\n", choice.c_str(), steps, chosen.sum,
              sink.bytes);
  return 0;
}
