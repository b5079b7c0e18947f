// Reading and writing the chunks of a recording. See chunks.h.
#include "io/chunk/chunks.h"

#include "base/hash.h"
#include "io/codec/command_codec.h"
#include "io/snapshot/motion_hash.h"
#include "io/snapshot/snapshot.h"

#include <cstring>

namespace gyre {

namespace {

constexpr char kRecordingMagic[9] = "GYREPLAY";
constexpr std::size_t kFileHeaderBytes = 8 + 4 + 4 + 8;
constexpr std::size_t kChunkHeaderBytes = 4 + 4 + 8 + 8;
constexpr std::size_t kChunkLengthOffset = 8;
constexpr std::size_t kChunkChecksumOffset = 16;

// The checksum of the chunk header up to the checksum itself, and of the payload.
std::uint64_t checksum_of(const std::byte* chunk, std::size_t payload_bytes) {
  Hasher hasher;
  hasher.add(std::span<const std::byte>(chunk, kChunkChecksumOffset));
  hasher.add(std::span<const std::byte>(chunk + kChunkHeaderBytes, payload_bytes));
  return hasher.value();
}

}  // namespace

std::uint64_t recording_layout(bool motion_hashes) {
  const std::uint64_t layout = mix_bits(state_layout() + kCommandLayout);
  return motion_hashes ? mix_bits(layout + kMotionHashLayout) : layout;
}

void write_recording_header(ByteWriter& out, std::uint64_t layout) {
  out.put_bytes(std::as_bytes(std::span<const char>(kRecordingMagic, sizeof kRecordingMagic - 1)));
  out.put(kRecordingVersion);
  out.put(std::uint32_t(0));
  out.put(layout);
}

void write_chunk(ByteWriter& out, ChunkKind kind, std::uint32_t number, std::span<const std::byte> payload) {
  const std::size_t start = out.size();
  out.put(std::uint32_t(kind));
  out.put(number);
  out.put(std::uint64_t(payload.size()));
  out.put(std::uint64_t(0));
  out.put_bytes(payload);
  out.patch(start + kChunkChecksumOffset, checksum_of(out.view().data() + start, payload.size()));
}

Error ChunkReader::read_header() {
  ByteReader in(bytes_);
  const std::span<const std::byte> magic = in.get_bytes(sizeof kRecordingMagic - 1);
  if (in.failed() || std::memcmp(magic.data(), kRecordingMagic, magic.size()) != 0) {
    return make_error(ErrorCode::invalid_data, "recording: these bytes are none");
  }
  const auto version = in.get<std::uint32_t>();
  in.get<std::uint32_t>();
  layout_ = in.get<std::uint64_t>();
  if (in.failed()) return make_error(ErrorCode::invalid_data, "recording: it ends within its header");
  if (version != kRecordingVersion) {
    return make_error(ErrorCode::unsupported, "recording: it is of format %u; this version reads format %u",
                      version, kRecordingVersion);
  }
  offset_ = kFileHeaderBytes;
  return {};
}

bool ChunkReader::next(Chunk& chunk) {
  const std::size_t left = bytes_.size() - offset_;
  if (left < kChunkHeaderBytes) return false;
  const std::byte* const start = bytes_.data() + offset_;
  ByteReader in(bytes_.subspan(offset_));
  const auto kind = in.get<std::uint32_t>();
  const auto number = in.get<std::uint32_t>();
  const auto length = in.get<std::uint64_t>();
  const auto checksum = in.get<std::uint64_t>();
  if (length > left - kChunkHeaderBytes || number != number_) return false;
  if (checksum != checksum_of(start, std::size_t(length))) return false;
  const bool required = kind >= std::uint32_t(ChunkKind::snapshot) && kind <= std::uint32_t(ChunkKind::end);
  if (!required && kind < kFirstOptionalKind) return false;
  chunk.kind = ChunkKind(kind);
  chunk.payload = in.get_bytes(length);
  offset_ += kChunkHeaderBytes + std::size_t(length);
  ++number_;
  return true;
}

void reseal_recording(std::span<std::byte> bytes) {
  std::size_t offset = kFileHeaderBytes;
  for (std::uint32_t number = 0; offset + kChunkHeaderBytes <= bytes.size(); ++number) {
    std::byte* const start = bytes.data() + offset;
    const std::size_t left = bytes.size() - offset - kChunkHeaderBytes;
    auto length = load_little<std::uint64_t>(start + kChunkLengthOffset);
    if (length > left) length = left;
    const std::span<std::byte> payload(start + kChunkHeaderBytes, std::size_t(length));
    const std::uint32_t kind = load_little<std::uint32_t>(start);
    if (kind == std::uint32_t(ChunkKind::snapshot)) reseal_snapshot(payload);
    store_little(start + 4, number);
    store_little(start + kChunkLengthOffset, length);
    store_little(start + kChunkChecksumOffset, checksum_of(start, payload.size()));
    offset += kChunkHeaderBytes + payload.size();
  }
}

}  // namespace gyre
