// The container of a recording: a header, then chunks with length, sequence number and checksum. A truncated or
// damaged file can be read up to the last complete chunk.
//
//   header: magic (8 bytes), format version (u32), spare (u32), layout of the state (u64)
//   chunk: kind (u32), sequence number (u32), length (u64), checksum of these and the payload (u64), payload
//
// A recording that can be played begins with a snapshot. For each step it has new geometry, commands of which the
// last is the step itself, and a hash of the result: of the state, or in most steps of the motion only. Another
// snapshot follows where the world was restored to one. A recording that can be viewed has a pose track beside these
// or instead of them (track_format.h), whose chunk kinds begin at 256. An end chunk closes the file.
// docs/recording.md describes every byte.
#pragma once

#include "io/codec/bytes.h"

#include <gyre/result.h>

namespace gyre {

constexpr std::uint32_t kRecordingVersion = 1;

// The layout of state and commands, and of motion hashes if the recording has any. Builds with the same layout can
// play each other's recordings.
std::uint64_t recording_layout(bool motion_hashes);

enum class ChunkKind : std::uint32_t {
  snapshot = 1,
  geometry = 2,   // one cooked geometry
  commands = 3,   // command after command
  step_hash = 4,  // step count of the world (u64), hash of its state (u64)
  end = 5,        // number of steps (u64)

  track_start = 256,
  track_geometry = 257,
  track_model = 258,
  track_keyframe = 259,
  track_frame = 260,
  track_label = 261,
  track_note = 262,

  motion_hash = 263,  // step count of the world (u64), hash of the motion (u64); instead of a step hash

  track_soft = 264,      // the surface of a rope, cloth or solid
  track_vertices = 265,  // of all of them, for the frame that follows
  track_soft_label = 266,
};

// A reader skips unknown kinds from here on: later versions may add some.
constexpr std::uint32_t kFirstOptionalKind = 256;
inline bool is_optional(ChunkKind kind) { return std::uint32_t(kind) >= kFirstOptionalKind; }

struct Chunk {
  ChunkKind kind = ChunkKind::end;
  std::span<const std::byte> payload;
};

void write_recording_header(ByteWriter& out, std::uint64_t layout);
// Appends one chunk.
void write_chunk(ByteWriter& out, ChunkKind kind, std::uint32_t number, std::span<const std::byte> payload);

// Reads the chunks of a recording in order.
class ChunkReader {
 public:
  explicit ChunkReader(std::span<const std::byte> bytes) : bytes_(bytes) {}
  // Must be called first. Code none if the bytes are a recording that this version reads.
  Error read_header();
  // The layout of the state in the header, which decides whether snapshots and commands can be read.
  std::uint64_t layout() const { return layout_; }
  // Reads the next chunk. False at the end of the bytes and at damage; nothing after it can be trusted. The kind is
  // one of the above, or optional.
  bool next(Chunk& chunk);

 private:
  std::span<const std::byte> bytes_;
  std::size_t offset_ = 0;
  std::uint32_t number_ = 0;
  std::uint64_t layout_ = 0;
};

// Restores numbers, lengths and checksums of a recording that was changed, as far as its chunks can still be
// separated. For tests that damage the data behind them.
void reseal_recording(std::span<std::byte> bytes);

}  // namespace gyre
