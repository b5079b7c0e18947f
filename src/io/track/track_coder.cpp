// Decodes frames. See track_coder.h.
#include "io/track/track_coder.h"

namespace gyre {

bool FrameDecoder::read_put(BitReader& bits, TrackedBody& body) const {
  RoundedPose pose;
  code_put(bits, body, pose, steps_);
  PoseHistory history;
  if (bits.failed() || body.model >= model_count_ || !advance(history, pose, steps_)) return false;
  body.pose = begin_history(pose);
  body.put = true;
  return true;
}

// Old bodies and changes are both in order of index.
bool FrameDecoder::apply_changes(BitReader& bits, std::uint64_t count, std::vector<TrackedBody>& bodies) {
  next_.clear();
  std::size_t old = 0;
  std::uint64_t index = 0;
  for (std::uint64_t i = 0; i < count; ++i) {
    std::uint64_t gap = 0;
    BodyChange change = BodyChange::removed;
    code_change(bits, gap, change);
    index += gap + (i > 0 ? 1 : 0);
    if (bits.failed() || index > 0xffffffffu || change > BodyChange::flags) return false;
    while (old < bodies.size() && bodies[old].index < index) next_.push_back(bodies[old++]);
    const bool exists = old < bodies.size() && bodies[old].index == index;
    if (change == BodyChange::put) {
      TrackedBody body;
      body.index = std::uint32_t(index);
      if (!read_put(bits, body)) return false;
      next_.push_back(body);
    } else if (!exists) {
      return false;
    } else if (change == BodyChange::flags) {
      code_flags(bits, bodies[old]);
      next_.push_back(bodies[old]);
    }
    if (exists) ++old;
  }
  next_.insert(next_.end(), bodies.begin() + std::ptrdiff_t(old), bodies.end());
  bodies.swap(next_);
  return true;
}

bool FrameDecoder::decode(std::span<const std::byte> bytes, std::vector<TrackedBody>& bodies) {
  BitReader bits(bytes);
  for (TrackedBody& body : bodies) body.put = false;
  std::uint64_t count = 0;
  code_change_count(bits, count);
  if (bits.failed() || count > bits.left()) return false;
  if (count > 0 && !apply_changes(bits, count, bodies)) return false;
  for (TrackedBody& body : bodies) {
    if (!body.active || body.put) continue;
    RoundedPose pose;
    code_next_pose(bits, pose, body.pose, steps_);
    if (bits.failed() || !advance(body.pose, pose, steps_)) return false;
  }
  return bits.finished();
}

}  // namespace gyre
