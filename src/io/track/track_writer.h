// Writes the track of a recording: reads the world after a step and emits the chunks of a frame. It never changes the
// world. The reader is track_reader.cpp, the public side <gyre/track.h>.
#pragma once

#include "base/container/flat_map.h"
#include "base/function_ref.h"
#include "io/chunk/chunks.h"
#include "io/track/rounding_tolerance.h"
#include "io/track/soft_track_writer.h"
#include "io/track/track_coder.h"
#include "io/track/track_format.h"
#include "world/world_state.h"

namespace gyre {

using EmitChunk = FunctionRef<void(ChunkKind, std::span<const std::byte>)>;

class TrackWriter {
 public:
  explicit TrackWriter(const TrackStart& start) : start_(start), softs_(start.steps) {}

  void begin(EmitChunk emit) const;
  void frame(const WorldState& state, EmitChunk emit);
  // Shapes or types of existing bodies may have changed.
  void models_changed() { models_stale_ = true; }
  // The next frame does not continue from the last one.
  void jumped() { frames_since_key_ = kKeyframeInterval, models_stale_ = true; }

 private:
  struct WrittenBody {
    TrackedBody body;
    bool present = false;
    bool moved = false;        // `next` must be written
    int unchanged_frames = 0;  // frames since `next` changed
    bool settled = false;      // the bits of `next` are `settled_bits` until it changes
    int settled_size = 0;
    std::uint64_t settled_bits = 0;
    RoundedPose next;
    // `next` is the rounded pose as long as the body is within `tolerance` of the reference pose.
    RoundingTolerance tolerance;
    BodyPose reference{};
    Vec3 reference_mass_center{};
  };
  struct Change {
    std::uint32_t index;
    BodyChange kind;
  };

  void update_body(const WorldState& state, std::uint32_t index, bool key, EmitChunk emit);
  void update_known_body(const WorldState& state, WrittenBody& written);
  void update_rounded_pose(const BodyPose& body_pose, const BodyMass& mass, WrittenBody& written);
  void write_next(BitWriter& bits, WrittenBody& written);
  void settle(WrittenBody& written) const;
  std::vector<std::byte> frame_bits();
  std::uint32_t model_of(const RigidWorld& w, std::uint32_t body, EmitChunk emit);
  std::uint32_t geometry_number(const AnyShape& shape, EmitChunk emit);

  TrackStart start_;
  std::vector<WrittenBody> bodies_;  // by index
  std::vector<Change> changes_;      // of the present frame, by index
  SoftTrackWriter softs_;
  FlatMap<std::uint32_t> geometry_numbers_;  // by content hash
  FlatMap<std::uint32_t> model_numbers_;     // by hash of the written model
  bool models_stale_ = false;
  std::uint64_t frames_since_key_ = kKeyframeInterval;
  std::uint64_t set_version_ = 0;
};

}  // namespace gyre
