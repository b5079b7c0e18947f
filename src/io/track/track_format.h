// The payloads of the chunks of a track; docs/recording.md describes every byte:
//
//   track_start: version (u32), position bits (i8), orientation bits (u8), spare (u16), steps between frames (u32)
//   track_geometry: a hull's points, a mesh's triangles or a height field's heights; numbered from 0 in the order of the file
//   track_model: the type of a body and its shapes; numbered likewise
//   track_keyframe, track_frame: steps done (u64), time (f64), set version (u64), then bits (track_coder.h)
//   track_label: of a body: index (u32), generation (u16), name, colours
//   track_note: key and text
//   track_soft: the kind, radius, number of vertices and triangles of a rope, cloth or solid; numbered likewise
//   track_vertices: bits (soft_coder.h); of the frame that follows it
//   track_soft_label: as track_label, of a rope, cloth or solid
//
// Geometry is stored as its input, not cooked: cooked data may change from version to version.
#pragma once

#include "io/codec/bytes.h"
#include "io/track/pose_codec.h"

#include <gyre/track.h>

#include <string>

namespace gyre {

constexpr std::uint32_t kTrackVersion = 1;
constexpr std::uint64_t kKeyframeInterval = 64;  // frames

struct TrackStart {
  std::uint32_t version = kTrackVersion;
  PoseSteps steps;
  std::uint32_t frame_interval = 1;
};
void write_track_start(ByteWriter& out, const TrackStart& start);
// Code none if the reader can read the track.
Error read_track_start(std::span<const std::byte> payload, TrackStart& start);

void write_track_geometry(ByteWriter& out, const Geometry& geometry);
Result<Geometry> read_track_geometry(std::span<const std::byte> payload);

// `geometry_number` is that of the cooked geometry of the shape, if it has any.
void write_track_shape(ByteWriter& out, const TrackShape& shape, std::uint32_t geometry_number);
// Writes a body type and encoded shapes.
void write_track_model(ByteWriter& out, BodyType type, std::uint32_t shape_count,
                       std::span<const std::byte> shapes);
// False if the payload is invalid.
bool read_track_model(std::span<const std::byte> payload, std::span<const Geometry> geometry,
                      TrackModel& model);

// `index` and `generation` are those of the body's id, or of the rope's, cloth's or solid's.
struct StoredLabel {
  std::uint32_t index = 0;
  std::uint16_t generation = 0;
  std::string name;
  std::vector<TrackColor> colors;
};
void write_track_label(ByteWriter& out, std::uint32_t index, std::uint16_t generation, std::string_view name,
                       std::span<const TrackColor> colors);
bool read_track_label(std::span<const std::byte> payload, StoredLabel& label);

struct StoredNote {
  std::string key, text;
};
void write_track_note(ByteWriter& out, std::string_view key, std::string_view text);
bool read_track_note(std::span<const std::byte> payload, StoredNote& note);

// The surface of a rope, cloth or solid.
void write_track_soft(ByteWriter& out, SoftKind kind, float radius, std::uint32_t vertex_count,
                      std::span<const std::uint32_t> triangles);
// False if the payload is invalid.
bool read_track_soft(std::span<const std::byte> payload, TrackSoft& soft);

struct FrameHead {
  std::uint64_t step = 0;
  double time = 0.0;
  std::uint64_t set_version = 0;
};
constexpr std::size_t kFrameHeadBytes = 24;
void write_frame_head(ByteWriter& out, const FrameHead& head);
FrameHead read_frame_head(std::span<const std::byte> payload);  // of at least kFrameHeadBytes

}  // namespace gyre
