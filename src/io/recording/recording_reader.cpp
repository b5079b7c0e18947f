// Opens a recording. See recording.h.
#include "io/recording/recording.h"

#include "io/snapshot/motion_hash.h"
#include "world/world_access.h"

namespace gyre {

namespace {

// Calls fn(command) for all commands of a chunk. False if one cannot be read.
template <class Fn>
bool for_each_command(const Chunk& chunk, const GeometryTable& geometry, std::uint16_t world_number,
                      Fn&& fn) {
  ByteReader in(chunk.payload);
  while (in.left() > 0) {
    const Command command = read_command(in, geometry, world_number);
    if (in.failed()) return false;
    fn(command);
  }
  return true;
}

// Collects chunks up to the first error.
class RecordingOpener {
 public:
  explicit RecordingOpener(Recording& recording) : recording_(recording) {}

  // False ends the reading. The chunks before can be played.
  bool read_chunk(const Chunk& chunk) {
    if (recording_.closed) return false;
    switch (chunk.kind) {
      case ChunkKind::snapshot:
        return read_snapshot_chunk(chunk);
      case ChunkKind::geometry:
        return read_geometry_chunk(chunk);
      case ChunkKind::commands:
        return read_commands_chunk(chunk);
      case ChunkKind::step_hash:
        return read_hash_chunk(chunk, true);
      case ChunkKind::motion_hash:
        return read_hash_chunk(chunk, false);
      case ChunkKind::end:
        recording_.closed = true;
        return true;
      default:
        return is_optional(chunk.kind);
    }
  }

 private:
  bool read_snapshot_chunk(const Chunk& chunk) {
    StateColumns columns;
    if (read_snapshot(chunk.payload, 1, recording_.geometry, columns)) return false;
    if (recording_.first_snapshot.empty()) {
      recording_.first_snapshot = chunk.payload;
      return true;
    }
    return append(chunk);
  }
  bool read_geometry_chunk(const Chunk& chunk) {
    ByteReader in(chunk.payload);
    const Result<Geometry> geometry = read_geometry(in, recording_.geometry);
    if (!geometry || !in.finished()) return false;
    recording_.geometry.add(*geometry);
    return true;
  }
  bool read_commands_chunk(const Chunk& chunk) {
    // A step is the last command before the hash of its result.
    bool in_order = true;
    const bool whole = for_each_command(chunk, recording_.geometry, 1, [&](const Command& command) {
      in_order = in_order && !step_seen_;
      step_seen_ = std::holds_alternative<Step>(command);
    });
    return whole && in_order && append(chunk);
  }
  bool read_hash_chunk(const Chunk& chunk, bool is_whole) {
    ByteReader in(chunk.payload);
    in.get<std::uint64_t>();
    const auto hash = in.get<std::uint64_t>();
    if (!in.finished()) return false;
    if (is_whole && follows_motion_hash()) {
      recording_.steps.back().hash = hash;
      recording_.steps.back().is_whole = true;
      return true;
    }
    if (!step_seen_) return false;
    recording_.steps.push_back({first_chunk_, recording_.chunks.size() - first_chunk_, hash, is_whole});
    first_chunk_ = recording_.chunks.size();
    step_seen_ = false;
    return true;
  }
  // True if a state hash directly follows a motion hash, as in the last step of a recording.
  bool follows_motion_hash() const {
    return !recording_.steps.empty() && !recording_.steps.back().is_whole &&
           first_chunk_ == recording_.chunks.size();
  }
  bool append(const Chunk& chunk) {
    if (recording_.first_snapshot.empty()) return false;
    recording_.chunks.push_back(chunk);
    return true;
  }

  Recording& recording_;
  std::size_t first_chunk_ = 0;
  bool step_seen_ = false;
};

}  // namespace

Result<Recording> open_recording(std::vector<std::byte> bytes) {
  Recording recording;
  recording.bytes = std::move(bytes);
  ChunkReader reader(recording.bytes);
  const Error e = reader.read_header();
  if (e) return e;
  if (reader.layout() != recording_layout(false) && reader.layout() != recording_layout(true)) {
    return make_error(
        ErrorCode::unsupported,
        "recording: it was made by a version whose worlds have another state, so it cannot be played; its "
        "poses can be looked at if it has any");
  }
  RecordingOpener opener(recording);
  Chunk chunk;
  while (reader.next(chunk) && opener.read_chunk(chunk)) {
  }
  if (recording.first_snapshot.empty()) {
    return make_error(
        ErrorCode::invalid_data,
        "recording: its first state is missing or damaged; it may have been made to be looked at only");
  }
  return Result<Recording>(std::move(recording));
}

Result<World> make_recorded_world(const Recording& recording, const WorldDef& def) {
  Error e = check_world_def(def);
  if (e) return e;
  std::unique_ptr<WorldState> state = make_world_state(def);
  GeometryTable geometry = recording.geometry;
  StateColumns columns;
  e = read_snapshot(recording.first_snapshot, state->number, geometry, columns);
  if (e) return e;
  adopt_columns(*state, std::move(columns));
  return WorldAccess::make(std::move(state));
}

bool has_recorded_hash(const RecordedStep& step, const WorldState& state) {
  return step.hash == (step.is_whole ? hash_state(state) : hash_motion(state));
}

float play_commands(const Recording& recording, const RecordedStep& step, WorldState& state) {
  float seconds = 0.0f;
  for (std::size_t i = 0; i < step.chunk_count; ++i) {
    const Chunk& chunk = recording.chunks[step.first_chunk + i];
    if (chunk.kind == ChunkKind::snapshot) {
      GeometryTable geometry = recording.geometry;
      StateColumns columns;
      if (read_snapshot(chunk.payload, state.number, geometry, columns).ok()) {
        adopt_columns(state, std::move(columns));
      }
      continue;
    }
    for_each_command(chunk, recording.geometry, state.number, [&](const Command& command) {
      if (const Step* const last = std::get_if<Step>(&command)) {
        seconds = last->seconds;
      } else {
        submit(state, command);
      }
    });
  }
  return seconds;
}

}  // namespace gyre
