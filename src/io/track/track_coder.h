// The bits of a frame, shared by writer and reader:
//
//   number of changed bodies, then for each, by ascending index: the gap from the last index, the kind of change
//     removed
//     put: generation, model, flags, pose without history
//     flags
//   then the next pose of each active body that was not put, by ascending index
//
// A body is active in frames that store its pose: while it is awake, or when it was moved in its sleep. A keyframe
// puts every body.
#pragma once

#include "io/track/pose_codec.h"

#include <vector>

namespace gyre {

struct TrackedBody {
  std::uint32_t index = 0;
  std::uint16_t generation = 0;
  bool awake = false;
  bool active = false;
  bool put = false;  // in the present frame
  std::uint32_t model = 0;
  PoseHistory pose;
};

enum class BodyChange : std::uint8_t { removed, put, flags };

template <class Bits>
void code_change_count(Bits& bits, std::uint64_t& count) {
  code_count(bits, count, 0);
}

// `gap`: indices between this body and the last changed one.
template <class Bits>
void code_change(Bits& bits, std::uint64_t& gap, BodyChange& change) {
  code_count(bits, gap, 4);
  auto number = std::uint64_t(change);
  bits.code_bits(number, 2);
  change = BodyChange(number);
}

template <class Bits>
void code_flags(Bits& bits, TrackedBody& body) {
  std::uint64_t awake = body.awake, active = body.active;
  bits.code_bits(awake, 1);
  bits.code_bits(active, 1);
  body.awake = awake != 0;
  body.active = active != 0;
}

template <class Bits>
void code_put(Bits& bits, TrackedBody& body, RoundedPose& pose, PoseSteps steps) {
  std::uint64_t generation = body.generation, model = body.model;
  bits.code_bits(generation, 16);
  code_count(bits, model, 4);
  body.generation = std::uint16_t(generation);
  body.model = model > 0xffffffffu ? 0xffffffffu : std::uint32_t(model);
  code_flags(bits, body);
  code_pose(bits, pose, steps);
}

// Decodes the bits of a frame into `bodies`, which must be those of the frame before (none for a keyframe). False if
// the bits are invalid; `bodies` is then unusable.
class FrameDecoder {
 public:
  FrameDecoder(std::uint32_t model_count, PoseSteps steps) : model_count_(model_count), steps_(steps) {}
  bool decode(std::span<const std::byte> bytes, std::vector<TrackedBody>& bodies);

 private:
  bool apply_changes(BitReader& bits, std::uint64_t count, std::vector<TrackedBody>& bodies);
  bool read_put(BitReader& bits, TrackedBody& body) const;

  std::uint32_t model_count_;
  PoseSteps steps_;
  std::vector<TrackedBody> next_;
};

}  // namespace gyre
