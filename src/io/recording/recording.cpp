// The recorder: receives every command from the log of the world and writes chunks (chunks.h).
#include "io/chunk/chunks.h"
#include "io/codec/command_codec.h"
#include "io/snapshot/motion_hash.h"
#include "io/snapshot/snapshot.h"
#include "io/track/track_writer.h"
#include "world/world_access.h"

#include <gyre/replay.h>

#include <optional>

namespace gyre {

namespace {

bool can_record(const RecordOptions& options) {
  return (options.commands || options.poses) && options.frame_interval > 0 && options.hash_interval > 0 &&
         options.pose_accuracy >= 1.0e-12f && options.pose_accuracy <= 1.0e5f;
}

// True if the command may change the look of existing bodies.
bool changes_models(const Command& command) {
  return std::holds_alternative<AddShape>(command) || std::holds_alternative<RemoveShape>(command) ||
         std::holds_alternative<SetType>(command) || std::holds_alternative<SetMaterial>(command) ||
         std::holds_alternative<SetSensor>(command) || std::holds_alternative<SetShape>(command);
}

}  // namespace

struct Recorder::Log final : CommandLog {
  // Commands are buffered until their step, or up to this many bytes.
  static constexpr std::size_t kMaxPending = std::size_t(1) << 20;

  Log(WorldState& recorded, ByteSink& to, const RecordOptions& record_options)
      : state(&recorded), sink(to), options(record_options) {}

  void on_command(const Command& command) override {
    whole_hash_due = false;
    if (track && changes_models(command)) track->models_changed();
    if (!options.commands) return;
    for_each_shape(command, [&](const AnyShape& shape) {
      if (!geometry.add(shape)) return;
      ByteWriter payload;
      write_geometry(payload, geometry.items().back());
      emit(ChunkKind::geometry, payload.view());
    });
    write_command(pending, command);
    // Written before the step runs, so that the file has its input even if the step crashes.
    if (std::holds_alternative<Step>(command) || pending.size() > kMaxPending) flush();
  }

  void on_step_done(WorldState& done) override {
    ++steps;
    if (options.commands) hash(done);
    frame_due = true;
    if (steps % options.frame_interval == 0) frame();
  }

  void on_restored(WorldState&) override {
    whole_hash_due = false;
    if (track) track->jumped();
    if (!options.commands) return;
    flush();
    snapshot();
  }

  void hash(const WorldState& done) {
    whole_hash_due = steps % options.hash_interval != 0;
    if (whole_hash_due) {
      emit_hash(ChunkKind::motion_hash, hash_motion(done));
    } else {
      emit_hash(ChunkKind::step_hash, hash_state(done));
    }
  }

  void emit_hash(ChunkKind kind, std::uint64_t hash) {
    ByteWriter payload;
    payload.put(state->step_count);
    payload.put(hash);
    emit(kind, payload.view());
  }

  // Writes the state as a frame of the track.
  void frame() {
    if (track && !failed)
      track->frame(*state,
                   [this](ChunkKind kind, std::span<const std::byte> payload) { emit(kind, payload); });
    frame_due = false;
  }

  void begin() {
    ByteWriter header;
    write_recording_header(header, recording_layout(options.commands && options.hash_interval > 1));
    write(header.view());
    if (options.commands) snapshot();
    if (!options.poses) return;
    TrackStart start;
    start.frame_interval = options.frame_interval;
    // The coarsest rounding with sufficient accuracy: a coordinate is off by half a rounding step at most.
    start.steps.position_bits = kMinPositionBits;
    for (double step = double(1 << -kMinPositionBits); 0.5 * step > double(options.pose_accuracy);
         step *= 0.5)
      ++start.steps.position_bits;
    track.emplace(start);
    track->begin([this](ChunkKind kind, std::span<const std::byte> payload) { emit(kind, payload); });
    frame();
  }

  void snapshot() {
    ByteWriter payload;
    write_snapshot(payload, *state, geometry);
    emit(ChunkKind::snapshot, payload.view());
  }

  void flush() {
    if (pending.size() != 0) emit(ChunkKind::commands, pending.view());
    pending.clear();
  }

  void emit(ChunkKind kind, std::span<const std::byte> payload) {
    ByteWriter chunk;
    write_chunk(chunk, kind, chunks++, payload);
    write(chunk.view());
  }

  // After the first failed write nothing more is written, so the file ends with a complete chunk.
  void write(std::span<const std::byte> bytes) {
    if (!failed && !sink.write(bytes)) failed = true;
  }

  WorldState* state;  // null once finished
  ByteSink& sink;
  RecordOptions options;
  std::optional<TrackWriter> track;
  GeometryTable geometry;  // all geometry in the file
  ByteWriter pending;
  std::uint32_t chunks = 0;
  std::uint64_t steps = 0;
  bool frame_due = false;  // a step was done since the last frame
  bool whole_hash_due =
      false;  // only the motion of the last step was hashed, and no command has changed the state since
  bool failed = false;
};

Recorder::Recorder(World& world, ByteSink& sink, const RecordOptions& options)
    : log_(std::make_unique<Log>(state_of(world), sink, options)) {
  Log& log = *log_;
  // A world has one recorder at a time.
  if (log.state->log != nullptr || log.state->stepping || !can_record(options)) {
    log.failed = true;
    log.state = nullptr;
    return;
  }
  log.state->log = &log;
  log.begin();
}

Recorder::~Recorder() { finish(); }

void Recorder::label(BodyId body, std::string_view name, std::span<const TrackColor> colors) {
  if (log_->state == nullptr || !log_->track) return;
  ByteWriter payload;
  write_track_label(payload, body.index, body.generation, name, colors);
  log_->emit(ChunkKind::track_label, payload.view());
}

void Recorder::label_soft(SoftId soft, std::string_view name, std::span<const TrackColor> colors) {
  if (log_->state == nullptr || !log_->track) return;
  ByteWriter payload;
  write_track_label(payload, soft.index, soft.generation, name, colors);
  log_->emit(ChunkKind::track_soft_label, payload.view());
}

void Recorder::note(std::string_view key, std::string_view text) {
  if (log_->state == nullptr || !log_->track) return;
  ByteWriter payload;
  write_track_note(payload, key, text);
  log_->emit(ChunkKind::track_note, payload.view());
}

bool Recorder::finish() {
  Log& log = *log_;
  if (log.state == nullptr) return !log.failed;
  log.flush();
  if (log.whole_hash_due) log.emit_hash(ChunkKind::step_hash, hash_state(*log.state));
  if (log.frame_due) log.frame();
  ByteWriter payload;
  payload.put(log.steps);
  log.emit(ChunkKind::end, payload.view());
  log.state->log = nullptr;
  log.state = nullptr;
  return !log.failed;
}

bool Recorder::failed() const { return log_->failed; }

}  // namespace gyre
