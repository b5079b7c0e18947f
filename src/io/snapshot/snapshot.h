// The bytes of a snapshot, for the other units of io. The public side is <gyre/replay.h>.
//
//   magic (8 bytes), format version (u32), spare (u32), length of the rest (u64), checksum of the rest (u64)
//   cooked geometry, each once, by content hash
//   number of columns (u32), then each: length of its name (u8), name, layout of a record (u64), records (u64),
//   bytes (u64), payload
//
// All numbers are little-endian; records are stored field by field, as state_fields.h lists them.
#pragma once

#include "io/codec/columns.h"
#include "io/codec/geometry_codec.h"

namespace gyre {

constexpr std::uint32_t kSnapshotVersion = 1;

// Appends a snapshot of the state. Its cooked geometry is added to `geometry`.
void write_snapshot(ByteWriter& out, const WorldState& state, GeometryTable& geometry);

// Reads and checks a snapshot and derives the rest of the state, for a world of this number. Geometry in the table is
// shared; new geometry is added to it.
Error read_snapshot(std::span<const std::byte> bytes, std::uint16_t world_number, GeometryTable& geometry,
                    StateColumns& columns);

// All cooked geometry of the shapes of a world.
void collect_geometry(const WorldState& state, GeometryTable& geometry);

// A hash of names and layouts of all columns. Two builds with the same hash have the same state.
std::uint64_t state_layout();

// Restores the checksum of a snapshot that was changed. For tests that damage the data behind it.
void reseal_snapshot(std::span<std::byte> bytes);

}  // namespace gyre
