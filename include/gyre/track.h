// The pose track of a recording: frame by frame which bodies there were, where, and which slept, and what they looked like. It
// is read without simulating, forward and back, also by other versions than the one that wrote it (docs/recording.md). It is
// written by a Recorder (gyre/replay.h).
//
// Poses are stored rounded: to within TrackAccuracy, in every frame, however long the recording is.
#pragma once

#include <gyre/defs.h>
#include <gyre/geometry.h>
#include <gyre/ids.h>
#include <gyre/math.h>
#include <gyre/result.h>

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

// One shape of a body, as it is to be drawn. Cooked geometry is shared: shapes with equal content_hash are the same data.
struct TrackShape {
  AnyShape geometry = Sphere{};
  Transform local{};              // body_from_shape
  std::uint16_t material_id = 0;  // Material::id; 0 = none
  bool sensor = false;
};

// What a body looks like. Bodies that are alike share one.
struct TrackModel {
  BodyType type = BodyType::dynamic;
  std::vector<TrackShape> shapes{};
};

// What the recorder was told about a body (Recorder::label); empty if nothing.
struct TrackLabel {
  std::string_view name{};               // UTF-8 as it was given, not checked
  std::span<const TrackColor> colors{};  // of the model's shapes, in their order; may be fewer
};

// How far a pose of the track may be from the one that was recorded.
struct TrackAccuracy {
  double position = 0.0;     // m, each coordinate of the body's origin
  double orientation = 0.0;  // rad, angle between the two orientations
};

// One frame: parallel arrays over all bodies that exist in it, by ascending id index. Valid until the next seek.
struct TrackFrame {
  std::uint64_t step = 0;                   // steps that the world had done
  double time = 0.0;                        // s, of the world
  std::span<const BodyId> ids{};            // `world` is 0
  std::span<const Pose> poses{};            // world_from_body, of the origins
  std::span<const std::uint8_t> awake{};    // 1: moved, or could have; fixed and sleeping bodies 0
  std::span<const std::uint32_t> models{};  // into PoseTrack::models()
  // Counts changes of `ids` and `models`: both are the same in two frames of one track with the same number.
  std::uint64_t set_version = 0;
};

class PoseTrack {
 public:
  // Takes the bytes of a recording. Refused, with the reason, if they are none, or hold no whole frame of a track. A recording
  // that was cut off or damaged has the frames before that place.
  static Result<PoseTrack> open(std::vector<std::byte> bytes);
  ~PoseTrack();
  PoseTrack(PoseTrack&&) noexcept;
  PoseTrack& operator=(PoseTrack&&) noexcept;

  std::size_t frame_count() const;              // at least 1
  bool truncated() const;                       // the file ended without its closing chunk
  double time(std::size_t frame) const;         // s; 0 for a frame that is not there
  std::uint64_t step(std::size_t frame) const;  // 0 for a frame that is not there
  TrackAccuracy accuracy() const;

  // All models that occur, in the order in which they first did.
  std::span<const TrackModel> models() const;
  TrackLabel label(BodyId body) const;  // `world` of the id does not matter
  // Text that the recorder was given (Recorder::note) under `key`; empty if none. `gyre simulate` notes "scene", a JSON object
  // with the scene's name and view.
  std::string_view note(std::string_view key) const;

  // Goes to a frame. One frame on, or back within the frames since a keyframe, is cheap; elsewhere the frames since the last
  // keyframe are decoded, some dozens. invalid_argument: there is no such frame. invalid_data: what it holds cannot be (only
  // in files made to deceive; checksums find the rest when the file is opened). The present frame then stays.
  Error seek(std::size_t frame);
  std::size_t position() const;  // the present frame; 0 after opening
  TrackFrame frame() const;      // the present frame

 private:
  struct Reader;
  explicit PoseTrack(std::unique_ptr<Reader> reader);
  std::unique_ptr<Reader> reader_;
};

}  // namespace gyre
