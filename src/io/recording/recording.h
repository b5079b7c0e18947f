// A recording opened for playing: its chunks checked and listed by step. Used by the replay player and by the search for
// the first difference.
#pragma once

#include "io/chunk/chunks.h"
#include "io/codec/command_codec.h"
#include "io/snapshot/snapshot.h"

#include <gyre/replay.h>

namespace gyre {

// What stands in a recording for one step: geometry, snapshots and commands, of which the last is the step.
struct RecordedStep {
  std::size_t first_chunk = 0;  // into Recording::chunks
  std::size_t chunk_count = 0;
  std::uint64_t hash = 0;  // of the state after it, or of what moves
  bool is_whole = false;   // of the state
};

struct Recording {
  Recording() = default;
  Recording(Recording&&) = default;  // not to be copied: spans lead into `bytes`
  Recording& operator=(Recording&&) = default;

  std::vector<std::byte> bytes;
  std::vector<Chunk> chunks;  // commands and later snapshots; payloads lie in `bytes`
  std::vector<RecordedStep> steps;
  GeometryTable geometry;
  std::span<const std::byte> first_snapshot;
  bool closed = false;  // the end chunk was there
};

// Lists what can be played: all whole steps up to the first thing that is damaged or cannot be. Refused if not even the
// first snapshot is there.
Result<Recording> open_recording(std::vector<std::byte> bytes);

// A world in the recording's first state.
Result<World> make_recorded_world(const Recording& recording, const WorldDef& def);

// Whether the state right after a step is the recorded one, as far as the step's hash tells.
bool has_recorded_hash(const RecordedStep& step, const WorldState& state);

// Plays the commands of a step but not the step itself, whose length it returns.
float play_commands(const Recording& recording, const RecordedStep& step, WorldState& state);

}  // namespace gyre
