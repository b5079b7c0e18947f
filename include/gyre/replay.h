// Snapshots, rollback, recordings and their replay. Free functions and classes on a World; the world does not depend on them.
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

// The whole state as bytes: named, versioned columns, little-endian. It loads in any build, at any SIMD width. Events that the next step
// would report are no part of it.
std::vector<std::byte> save_snapshot(const World& world);
// Threads, SIMD width and broad phase come from `def`, since they are no part of the state; everything else comes from the snapshot. The
// world is a new one with ids of its own: bodies() has them.
Result<World> load_snapshot(std::span<const std::byte> bytes, const WorldDef& def = {});
// Restores `world` to the snapshot. The world is unchanged if the bytes are refused. Ids from before the snapshot are valid again. A
// recording of the world continues.
Error restore_snapshot(World& world, std::span<const std::byte> bytes);

// A second world in the same state, with the same settings: for searches that try several futures. Ids of `world` name the same objects in the
// clone, until one of the two adds an object. Events of the last step, the problem hook and a recorder are left behind. Refused during a step.
Result<World> clone(const World& world);

// A snapshot with bytes of the caller's own behind it: scores, timers, the state of a script. load_snapshot() and restore_snapshot() pass over
// them; snapshot_user_bytes() finds them again; none if there are none or they are damaged.
std::vector<std::byte> save_snapshot_with(const World& world, std::span<const std::byte> user_bytes);
std::vector<std::byte> snapshot_user_bytes(std::span<const std::byte> snapshot);

// A ring of the last `capacity` in-memory snapshots, for rollback netcode.
class Rollback {
 public:
  explicit Rollback(int capacity);
  ~Rollback();
  Rollback(Rollback&&) noexcept;
  // Saves the world's present state under its step count.
  void save(const World& world);
  // Restores the world to the state saved at `step`; false if there is none.
  bool restore(World& world, std::uint64_t step) const;
  // Step counts of the oldest and the newest saved state; UINT64_MAX if there are none.
  std::uint64_t oldest() const;
  std::uint64_t newest() const;

 private:
  struct Ring;
  std::unique_ptr<Ring> ring_;
};

// The destination of a recording's bytes. Return false to stop (a full disk); the recording then ends at the last whole chunk.
class ByteSink {
 public:
  virtual ~ByteSink() = default;
  virtual bool write(std::span<const std::byte> bytes) = 0;
};

// The content of a recording: commands, poses, or both.
struct RecordOptions {
  bool commands = true;  // a snapshot, every command, a hash after each step: for Replay, which plays it to the bit
  bool poses = true;     // a pose track: for PoseTrack, which reads it without simulating, in any later version
  std::uint32_t frame_interval = 1;  // at least 1, steps between two frames of the track; the last step always has a frame
  float pose_accuracy = 1.0e-4f;     // m, from 1e-12 to 1e5: the largest error of a coordinate of the track
  // At least 1: steps between two hashes of the whole state. The last step has one too if the recorder ends right after it. The hashes
  // of other steps cover the moving bodies only: they are far cheaper, and still show the first step that moves differently.
  std::uint32_t hash_interval = 128;
};

// Records `world` from its present state until the recorder is finished or destroyed. The world must outlive the recorder. A second
// recorder of the same world fails at once, as do options out of range. Data are written at once and not kept.
class Recorder {
 public:
  Recorder(World& world, ByteSink& sink, const RecordOptions& options = {});
  ~Recorder();
  Recorder(const Recorder&) = delete;
  Recorder& operator=(const Recorder&) = delete;

  // Gives a body a name, and colours for its shapes in the order of World::shapes. It may be called at any time and repeatedly; the last
  // call holds for the whole recording. Nothing is written without a track.
  void label(BodyId body, std::string_view name, std::span<const TrackColor> colors = {});
  void label_soft(SoftId soft, std::string_view name, std::span<const TrackColor> colors = {});  // likewise
  // Stores any text under a key, with the same rules, except that the first text of a key holds.
  void note(std::string_view key, std::string_view text);

  bool finish();  // writes the closing chunk; true if every byte was written
  bool failed() const;

 private:
  struct Log;
  std::unique_ptr<Log> log_;
};

// The first difference between two runs.
struct Difference {
  std::uint64_t step = 0;  // index of the first step that differs, from 0
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
  // Plays one step; false at the end. `matches` says whether the hash equals the recorded one (of the whole state or of the moving bodies,
  // see RecordOptions::hash_interval).
  bool step(bool* matches = nullptr);
  // Goes to the state after `step` steps, forward or back (with keyframes saved while playing).
  Error seek(std::uint64_t step);

 private:
  struct Player;
  explicit Replay(std::unique_ptr<Player> player);
  std::unique_ptr<Player> player_;
};

// Runs two worlds in lockstep from the same snapshot under two defs (thread counts, SIMD widths) for `steps` steps of
// `seconds`, hashing every column after every stage. Returns the first difference, or step = UINT64_MAX if there is none.
Result<Difference> first_difference(std::span<const std::byte> snapshot, const WorldDef& a, const WorldDef& b, int steps,
                                    float seconds);
// The same for a recording: replays it and compares the recorded hashes. If a step differs, the steps since the last hash of the whole
// state are played again beside a single-threaded world of SIMD width 1, to name step, stage, column and row. If those two worlds agree,
// no column is named, and `step` is the first step whose hash differs.
Result<Difference> first_difference(std::span<const std::byte> recording, const WorldDef& def);

}  // namespace gyre
