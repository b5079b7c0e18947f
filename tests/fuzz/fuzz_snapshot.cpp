// Snapshots from outside: refused, or a world that can be stepped, saved and loaded again, the same each time.
#include "edits.h"
#include "io/snapshot/snapshot.h"
#include "small_scene.h"

#include <gyre/replay.h>

#include <cstdlib>

namespace {

using namespace gyre;

const std::vector<std::byte>& good_snapshot() {
  static const std::vector<std::byte> bytes = [] {
    World world = *World::create();
    fuzz::build_small_scene(world);
    return save_snapshot(world);
  }();
  return bytes;
}

void try_snapshot(std::span<const std::byte> bytes) {
  World kept = *World::create();
  const std::uint64_t hash = kept.hash();
  if (restore_snapshot(kept, bytes)) {
    if (kept.hash() != hash) std::abort();
    return;
  }
  Result<World> loaded = load_snapshot(bytes);
  if (!loaded || loaded->hash() != kept.hash()) std::abort();
  Result<World> again = load_snapshot(save_snapshot(*loaded));
  if (!again || again->hash() != loaded->hash()) std::abort();
  for (int i = 0; i < 3; ++i) {
    loaded->step(scenes::kStepSeconds);
    again->step(scenes::kStepSeconds);
    if (loaded->hash() != again->hash()) std::abort();
  }
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  try_snapshot(std::as_bytes(std::span(data, size)));
  fuzz::Input input(data, size);
  std::vector<std::byte> bytes = fuzz::edited(good_snapshot(), input);
  try_snapshot(bytes);
  reseal_snapshot(bytes);
  try_snapshot(bytes);
  return 0;
}
