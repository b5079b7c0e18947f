// A scene of scenes.h, recorded.
#pragma once

#include "../memory_sink.h"
#include "scenes.h"

#include <optional>
#include <utility>

namespace gyre::scenes {

enum class RecordFrom {
  first_command,  // the recorder sees how the scene is built
  first_step,     // it begins with the scene as it stands
};

struct RecordRun {
  RecordFrom from = RecordFrom::first_step;
  RecordOptions options{};
  WorldDef world{};
};

// The bytes, empty if the recorder failed. `look(world)` is called before the first step and after each.
template <typename Look>
std::vector<std::byte> record_scene(const Scene& scene, int steps, const RecordRun& run, Look&& look) {
  World world = *World::create(run.world);
  MemorySink sink;
  std::optional<Recorder> recorder;
  if (run.from == RecordFrom::first_command) recorder.emplace(world, sink, run.options);
  scene.build(world);
  if (run.from == RecordFrom::first_step) recorder.emplace(world, sink, run.options);
  look(std::as_const(world));
  for (int i = 0; i < steps; ++i) {
    step_scene(scene, world, i);
    look(std::as_const(world));
  }
  if (!recorder->finish()) return {};
  return std::move(sink.bytes);
}

}  // namespace gyre::scenes
