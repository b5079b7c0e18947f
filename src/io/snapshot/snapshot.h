// The bytes of a snapshot, for the other files of this folder. The public side is <gyre/replay.h>.
//
//   magic (8 bytes), format version (u32), spare (u32), length of the rest (u64), checksum of the rest (u64)
//   cooked geometry, each once, by content hash
//   number of columns (u32), then each: length of its name (u8), name, layout of a record (u64), records (u64),
//   bytes (u64), payload
//
// Everything little-endian; records field by field, as state_fields.h lists them.
#pragma once

#include "io/codec/columns.h"
#include "io/codec/geometry_codec.h"

namespace gyre {

constexpr std::uint32_t kSnapshotVersion = 1;

// Appends a snapshot of the state. Its cooked geometry is added to `geometry`.
void write_snapshot(ByteWriter& out, const WorldState& state, GeometryTable& geometry);

// Reads and checks a snapshot, and builds all that is derived, for a world of this number. Geometry that the table holds
// is shared instead of built; what is new is added.
Error read_snapshot(std::span<const std::byte> bytes, std::uint16_t world_number, GeometryTable& geometry,
                    StateColumns& columns);

// All cooked geometry that a world's shapes use.
void collect_geometry(const WorldState& state, GeometryTable& geometry);

// Hash of the names and layouts of all columns: two builds with the same one hold the same state.
std::uint64_t state_layout();

// Makes the checksum of a snapshot that was changed right again. For tests that damage what lies behind it.
void reseal_snapshot(std::span<std::byte> bytes);

}  // namespace gyre
