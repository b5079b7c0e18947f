// Recordings from outside: refused, or played to their end and back, the same each time. Their tracks: fuzz_track.cpp.
#include "../memory_sink.h"
#include "edits.h"
#include "io/chunk/chunks.h"
#include "small_scene.h"

#include <cstdlib>

namespace {

using namespace gyre;

// The scene itself from its snapshot, then a command of every kind.
const std::vector<std::byte>& good_recording() {
  static const std::vector<std::byte> bytes = [] {
    World world = *World::create();
    fuzz::build_small_scene(world);
    MemorySink sink;
    {
      Recorder recorder(world, sink);
      scenes::add_moving(world, {2, 3, 0}, scenes::pebble(0.3f));
      for (int step = 0; step < 46; ++step) {
        scenes::drive_changes(world, step);
        world.set_sleeping(step % 8 < 4);
        if (step % 6 == 0) world.step(scenes::kStepSeconds);
      }
    }
    return sink.bytes;
  }();
  return bytes;
}

void try_recording(const std::vector<std::byte>& bytes) {
  Result<Replay> replay = Replay::open(bytes);
  if (!replay) return;
  if (replay->step_count() > 64) return;  // only bytes that were made to last are that long
  while (replay->step()) {
  }
  const std::uint64_t hash = replay->world().hash();
  if (replay->seek(0)) std::abort();
  if (replay->seek(replay->step_count())) std::abort();
  if (replay->world().hash() != hash) std::abort();
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const std::span<const std::byte> raw = std::as_bytes(std::span(data, size));
  try_recording({raw.begin(), raw.end()});
  fuzz::Input input(data, size);
  std::vector<std::byte> bytes = fuzz::edited(good_recording(), input);
  try_recording(bytes);
  reseal_recording(bytes);
  try_recording(bytes);
  return 0;
}
