// The pose track of a recording: the bodies of each frame, their poses, which of them slept, and their shapes; the vertices of ropes,
// cloths and solids. It is read without
// simulating, forward and back, and also by other versions than the one that wrote it (docs/recording.md). A Recorder (gyre/replay.h)
// writes it.
//
// Poses are rounded to within TrackAccuracy in every frame, however long the recording is.
#pragma once

#include <gyre/defs.h>
#include <gyre/geometry.h>
#include <gyre/ids.h>
#include <gyre/math.h>
#include <gyre/result.h>
#include <gyre/soft.h>

#include <cstddef>
#include <cstdint>
#include <memory>
#include <span>
#include <string_view>
#include <vector>

namespace gyre {

// sRGB, 0 to 255 each.
struct TrackColor {
  std::uint8_t red = 0, green = 0, blue = 0;

  constexpr bool operator==(const TrackColor&) const = default;
};

// One shape of a body, for drawing. Cooked geometry is shared: shapes with equal content_hash have the same data.
struct TrackShape {
  AnyShape geometry = Sphere{};
  Transform local{};              // body_from_shape
  std::uint16_t material_id = 0;  // Material::id; 0 = none
  bool sensor = false;
};

// The appearance of a body. Bodies that look the same share one model.
struct TrackModel {
  BodyType type = BodyType::dynamic;
  std::vector<TrackShape> shapes{};
};

// A rope, cloth or solid, for drawing: its surface. Those that look the same share one. A rope has no triangles: its vertices are a line.
struct TrackSoft {
  SoftKind kind = SoftKind::rope;
  float radius = 0.0f;                     // m: that of a rope, half the thickness of a cloth, 0 of a solid
  std::uint32_t vertices = 0;              // their number
  std::vector<std::uint32_t> triangles{};  // three vertices each, counter-clockwise from outside; a cloth's upper side is outside
};

// The label that the recorder was given for a body (Recorder::label) or for a rope, cloth or solid (Recorder::label_soft); empty if none.
struct TrackLabel {
  std::string_view name{};               // as given, UTF-8 is not checked
  std::span<const TrackColor> colors{};  // of the model's shapes, in their order; may be fewer
};

// The largest difference between a pose of the track and the recorded one.
struct TrackAccuracy {
  double position = 0.0;     // m, each coordinate of a body's origin or of a vertex
  double orientation = 0.0;  // rad, angle between the two orientations
};

// One frame: parallel arrays of all its bodies, by ascending id index. Valid until the next seek.
struct TrackFrame {
  std::uint64_t step = 0;                   // step count of the world
  double time = 0.0;                        // s, of the world
  std::span<const BodyId> ids{};            // `world` is 0
  std::span<const Pose> poses{};            // world_from_body, of the origins
  std::span<const std::uint8_t> awake{};    // 1: awake dynamic or kinematic body; 0: fixed or sleeping
  std::span<const std::uint32_t> models{};  // into PoseTrack::models()
  // Counts changes of `ids`, `models`, `soft_ids` and `softs`. Two frames of one track with the same number have the same.
  std::uint64_t set_version = 0;

  std::span<const SoftId> soft_ids{};      // ropes, cloths and solids, by ascending id index. `world` is 0
  std::span<const std::uint32_t> softs{};  // into PoseTrack::softs()
  std::span<const DVec3> vertices{};       // m, of all of them, one after the other; PoseTrack::softs() tells their numbers
};

class PoseTrack {
 public:
  // Takes the bytes of a recording. Refuses, with the reason, bytes that are no recording or hold no whole frame of a track. Of a
  // recording that was cut off or damaged it has the frames before the damage.
  static Result<PoseTrack> open(std::vector<std::byte> bytes);
  ~PoseTrack();
  PoseTrack(PoseTrack&&) noexcept;
  PoseTrack& operator=(PoseTrack&&) noexcept;

  std::size_t frame_count() const;              // at least 1
  bool truncated() const;                       // the file ended without its closing chunk
  double time(std::size_t frame) const;         // s; 0 if there is no such frame
  std::uint64_t step(std::size_t frame) const;  // 0 if there is no such frame
  TrackAccuracy accuracy() const;

  // All models, in the order of their first frame.
  std::span<const TrackModel> models() const;
  std::span<const TrackSoft> softs() const;  // surfaces, likewise
  TrackLabel label(BodyId body) const;       // ignores BodyId::world
  TrackLabel soft_label(SoftId soft) const;  // ignores SoftId::world
  // The text that the recorder was given under `key` (Recorder::note); empty if none. `gyre simulate` notes "scene", a JSON object
  // with the scene's name and view.
  std::string_view note(std::string_view key) const;

  // Goes to a frame. One frame forward, or back within the frames since a keyframe, is cheap. Otherwise the frames since the last
  // keyframe are decoded, some dozens. Error invalid_argument: there is no such frame. Error invalid_data: the frame's content is
  // impossible (only in files made to deceive; checksums find other damage when the file is opened). The present frame then stays.
  Error seek(std::size_t frame);
  std::size_t position() const;  // the present frame; 0 after opening
  TrackFrame frame() const;      // the present frame
  // The vertices of one rope, cloth or solid in the present frame, by its place among TrackFrame::soft_ids; empty if there is none.
  std::span<const DVec3> soft_vertices(std::size_t i) const;

 private:
  struct Reader;
  explicit PoseTrack(std::unique_ptr<Reader> reader);
  std::unique_ptr<Reader> reader_;
};

}  // namespace gyre
