// The container of a recording: a header, then chunks with length, sequence number and checksum, so that a file that was cut
// off or damaged can be read up to the last whole chunk.
//
//   header: magic (8 bytes), format version (u32), spare (u32), layout of the state (u64)
//   chunk: kind (u32), number of the chunk (u32), length (u64), checksum of all that and the payload (u64), payload
//
// To be played, a recording begins with a snapshot. Then, for each step: geometry that is new, commands of which the last is
// the step itself, and a hash after it: of the state, or in most steps of what moves. Another snapshot may stand where the world was put back to one. To be
// looked at, it has a track beside or instead of that (track_format.h), whose chunks have kinds from 256 on. An end chunk
// closes the file. docs/recording.md has it byte by byte.
#pragma once

#include "io/codec/bytes.h"

#include <gyre/result.h>

namespace gyre {

constexpr std::uint32_t kRecordingVersion = 1;

// Of state and commands together, and of the hash of motions where a recording has any: only builds with the same ones play
// each other's recordings.
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

  motion_hash = 263,  // step count of the world (u64), hash of what moves (u64); instead of a step hash
};

// Kinds from here on are passed over by who does not know them: a later version may add some.
constexpr std::uint32_t kFirstOptionalKind = 256;
inline bool is_optional(ChunkKind kind) { return std::uint32_t(kind) >= kFirstOptionalKind; }

struct Chunk {
  ChunkKind kind = ChunkKind::end;
  std::span<const std::byte> payload;
};

void write_recording_header(ByteWriter& out, std::uint64_t layout);
// Appends a whole chunk.
void write_chunk(ByteWriter& out, ChunkKind kind, std::uint32_t number, std::span<const std::byte> payload);

// Walks the chunks of a recording.
class ChunkReader {
 public:
  explicit ChunkReader(std::span<const std::byte> bytes) : bytes_(bytes) {}
  // Why these are no chunks that can be read; code none if they are. To be called first.
  Error read_header();
  // The layout of the state in the header: whether snapshots and commands can be read.
  std::uint64_t layout() const { return layout_; }
  // The next chunk. False at the end of the bytes, or where they are damaged: from there on nothing can be trusted. Its kind
  // is one of the above, or optional.
  bool next(Chunk& chunk);

 private:
  std::span<const std::byte> bytes_;
  std::size_t offset_ = 0;
  std::uint32_t number_ = 0;
  std::uint64_t layout_ = 0;
};

// Makes numbers, lengths and checksums right again in a recording that was changed, as far as its chunks can still be told
// apart. For tests that damage what lies behind them.
void reseal_recording(std::span<std::byte> bytes);

}  // namespace gyre
