// A recording opened for playing: its chunks, checked and listed by step. The player and the search for the first
// difference use it.
#pragma once

#include "io/chunk/chunks.h"
#include "io/codec/command_codec.h"
#include "io/snapshot/snapshot.h"

#include <gyre/replay.h>

namespace gyre {

// The chunks of one step: geometry, snapshots and commands, of which the last is the step.
struct RecordedStep {
  std::size_t first_chunk = 0;  // into Recording::chunks
  std::size_t chunk_count = 0;
  std::uint64_t hash = 0;  // of the state after the step, or of its motion
  bool is_whole = false;   // the hash is of the state
};

struct Recording {
  Recording() = default;
  Recording(Recording&&) = default;  // no copies: spans refer to `bytes`
  Recording& operator=(Recording&&) = default;

  std::vector<std::byte> bytes;
  std::vector<Chunk> chunks;  // commands and later snapshots; payloads lie in `bytes`
  std::vector<RecordedStep> steps;
  GeometryTable geometry;
  std::span<const std::byte> first_snapshot;
  bool closed = false;  // the end chunk was found
};

// Lists all complete steps up to the first damage. Refused if the first snapshot is missing or damaged.
Result<Recording> open_recording(std::vector<std::byte> bytes);

// A world in the first state of the recording.
Result<World> make_recorded_world(const Recording& recording, const WorldDef& def);

// True if the hash of the state after a step equals the recorded one.
bool has_recorded_hash(const RecordedStep& step, const WorldState& state);

// Executes the commands of a step except the step itself. Returns its length, s.
float play_commands(const Recording& recording, const RecordedStep& step, WorldState& state);

}  // namespace gyre
