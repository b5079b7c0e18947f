// The recorder: sees every command at the world's one door, and writes chunks (chunks.h).
#include "io/chunks.h"
#include "io/command_codec.h"
#include "io/snapshot.h"

#include <gyre/replay.h>

namespace gyre {

struct Recorder::Log final : CommandLog {
  // Commands wait for the step that they belong to, unless they become this many bytes.
  static constexpr std::size_t kMostPending = std::size_t(1) << 20;

  Log(WorldState& recorded, ByteSink& to) : state(&recorded), sink(to) {}

  void on_command(const Command& command) override {
    for_each_shape(command, [&](const AnyShape& shape) {
      if (!geometry.add(shape)) return;
      ByteWriter payload;
      write_geometry(payload, geometry.items().back());
      emit(ChunkKind::geometry, payload.view());
    });
    write_command(pending, command);
    // Before the step is done, so that the file holds what a step was given even if it never comes back.
    if (std::holds_alternative<Step>(command) || pending.size() > kMostPending) flush();
  }

  void on_step_done(WorldState& done) override {
    ByteWriter payload;
    payload.put(done.step_count);
    payload.put(hash_state(done));
    emit(ChunkKind::step_hash, payload.view());
    ++steps;
  }

  void on_restored(WorldState&) override {
    flush();
    snapshot();
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

  // After the first write that fails nothing more is written: the file ends with its last whole chunk.
  void write(std::span<const std::byte> bytes) {
    if (!failed && !sink.write(bytes)) failed = true;
  }

  WorldState* state;  // null once finished
  ByteSink& sink;
  GeometryTable geometry;  // all that the file holds
  ByteWriter pending;
  std::uint32_t chunks = 0;
  std::uint64_t steps = 0;
  bool failed = false;
};

Recorder::Recorder(World& world, ByteSink& sink) : log_(std::make_unique<Log>(world.state(), sink)) {
  Log& log = *log_;
  if (log.state->log != nullptr || log.state->stepping) {
    // A world is recorded once at a time.
    log.failed = true;
    log.state = nullptr;
    return;
  }
  log.state->log = &log;
  ByteWriter header;
  write_recording_header(header);
  log.write(header.view());
  log.snapshot();
}

Recorder::~Recorder() { finish(); }

bool Recorder::finish() {
  Log& log = *log_;
  if (log.state == nullptr) return !log.failed;
  log.flush();
  ByteWriter payload;
  payload.put(log.steps);
  log.emit(ChunkKind::end, payload.view());
  log.state->log = nullptr;
  log.state = nullptr;
  return !log.failed;
}

bool Recorder::failed() const { return log_->failed; }

}  // namespace gyre
