// Snapshots, rollback, recordings and their replay. Free functions on a World, so that the world knows none of them.
#pragma once

#include <gyre/result.h>
#include <gyre/track.h>
#include <gyre/world.h>

#include <cstddef>
#include <cstdint>
#include <memory>
#include <span>
#include <string_view>
#include <vector>

namespace gyre {

// The whole state as bytes: named, versioned columns, little-endian; loads in any build, at any SIMD width. Events that wait
// for the next step to be shown are no part of it.
std::vector<std::byte> save_snapshot(const World& world);
// Threads, SIMD width and broad phase come from `def` (never part of the state); everything else from the snapshot. The
// world is a new one: bodies() gives the ids under which it knows its bodies.
Result<World> load_snapshot(std::span<const std::byte> bytes, const WorldDef& def = {});
// Puts `world` back to the snapshot; the world is unchanged if the bytes are refused (the error says why). Ids that it had
// given out when the snapshot was saved are valid again. A recording of the world goes on.
Error restore_snapshot(World& world, std::span<const std::byte> bytes);

// A ring of the last `capacity` in-memory snapshots, for rollback netcode.
class Rollback {
 public:
  explicit Rollback(int capacity);
  ~Rollback();
  Rollback(Rollback&&) noexcept;
  // Keeps the world's present state under its step count.
  void save(const World& world);
  // Puts the world back to the state saved at `step`; false if that is no longer (or not yet) kept.
  bool restore(World& world, std::uint64_t step) const;
  // Step counts of the states that are kept; UINT64_MAX when there are none.
  std::uint64_t oldest() const;
  std::uint64_t newest() const;

 private:
  struct Ring;
  std::unique_ptr<Ring> ring_;
};

// Where a recording's bytes go. Return false to stop (a full disk); the recording then ends at the last whole chunk.
class ByteSink {
 public:
  virtual ~ByteSink() = default;
  virtual bool write(std::span<const std::byte> bytes) = 0;
};

// What a recording holds. Both parts may stand in one file; at least one must.
struct RecordOptions {
  bool commands = true;  // a snapshot, every command, a hash after each step: for Replay, which plays it to the bit
  bool poses = true;     // a pose track: for PoseTrack, which looks at it without simulating, in any later version
  std::uint32_t frame_interval = 1;  // steps between two frames of the track, from 1; the last step always has one
  float pose_accuracy = 1.0e-4f;     // m, from 1e-12 to 1e5: the most by which a coordinate of the track may be off
  // Steps between two hashes of the whole state, from 1; the last step has one too if the recorder ends right after it. The hashes of
  // the other steps are of what moves: far cheaper, and a replay that moves otherwise is told in the very step.
  std::uint32_t hash_interval = 128;
};

// Records `world` until destroyed or finished, beginning with its present state. The world must still be there then. A second
// recorder of the same world fails at once, as do options out of range. What is recorded is written
// at once and not kept.
class Recorder {
 public:
  Recorder(World& world, ByteSink& sink, const RecordOptions& options = {});
  ~Recorder();
  Recorder(const Recorder&) = delete;
  Recorder& operator=(const Recorder&) = delete;

  // For who looks at the track: a body's name, and the colours of its shapes in the order of World::shapes. May be said at
  // any time, and again; the last word holds for the whole recording. Nothing is written without a track.
  void label(BodyId body, std::string_view name, std::span<const TrackColor> colors = {});
  // Any text under a key, the same way. The first text of a key holds.
  void note(std::string_view key, std::string_view text);

  bool finish();  // writes the closing chunk; true if every byte went through
  bool failed() const;

 private:
  struct Log;
  std::unique_ptr<Log> log_;
};

// The first place where two runs differ.
struct Difference {
  std::uint64_t step = 0;  // steps that were equal: the number of the first that is not, from 0
  char stage[48] = {};     // name of the first stage after which the states differ, or "before the step"
  char column[48] = {};  // name of the state column
  std::uint64_t row = 0;
};

// Plays a recording back.
class Replay {
 public:
  static Result<Replay> open(std::vector<std::byte> bytes, const WorldDef& def = {});
  ~Replay();
  Replay(Replay&&) noexcept;
  Replay& operator=(Replay&&) noexcept;
  World& world();
  std::uint64_t step_count() const;   // whole steps in the recording
  std::uint64_t position() const;     // steps played
  bool truncated() const;             // the file ended without its closing chunk
  // Plays one step; false at the end. `matches` tells whether the hash is the recorded one: of the whole state, or of what moves
  // (RecordOptions::hash_interval).
  bool step(bool* matches = nullptr);
  // Goes to the state after `step` steps, forward or back (by keyframes kept while playing).
  Error seek(std::uint64_t step);

 private:
  struct Player;
  explicit Replay(std::unique_ptr<Player> player);
  std::unique_ptr<Player> player_;
};

// Runs two worlds in lockstep from the same snapshot under two defs (thread counts, SIMD widths) for `steps` steps of
// `seconds`, hashing every column after every stage; the first difference, or step = UINT64_MAX if there is none.
Result<Difference> first_difference(std::span<const std::byte> snapshot, const WorldDef& a, const WorldDef& b, int steps,
                                    float seconds);
// The same for a recording: replays it and compares with the recorded hashes; when a step differs, the steps since the last hash
// of the whole state are played again beside a single-threaded, width-1 world to name step, stage, column and row (no column if
// these two agree with each other; `step` is then the first whose hash differs).
Result<Difference> first_difference(std::span<const std::byte> recording, const WorldDef& def);

}  // namespace gyre
