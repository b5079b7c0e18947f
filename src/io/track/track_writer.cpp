// Encodes frames of a world. See track_writer.h and track_coder.h.
#include "io/track/track_writer.h"

#include "base/hash.h"

#include <algorithm>
#include <array>

namespace gyre {

void TrackWriter::begin(EmitChunk emit) const {
  ByteWriter payload;
  write_track_start(payload, start_);
  emit(ChunkKind::track_start, payload.view());
}

std::uint32_t TrackWriter::geometry_number(const AnyShape& shape, EmitChunk emit) {
  const Geometry* const cooked = std::get_if<Geometry>(&shape);
  if (cooked == nullptr) return 0;
  const auto next = std::uint32_t(geometry_numbers_.size());
  const std::uint32_t number = geometry_numbers_.find_or_insert(cooked->content_hash(), next);
  if (number == next) {
    ByteWriter payload;
    write_track_geometry(payload, *cooked);
    emit(ChunkKind::track_geometry, payload.view());
  }
  return number;
}

std::uint32_t TrackWriter::model_of(const RigidWorld& w, std::uint32_t body, EmitChunk emit) {
  ByteWriter shapes;
  for (const ShapeId id : w.bodies.shapes[body]) {
    TrackShape shape;
    shape.geometry = w.shapes.geometry[id.index];
    shape.local = w.shapes.body_from_shape[id.index];
    shape.material_id = w.shapes.materials[id.index].id;
    shape.sensor = w.shapes.proxies[id.index].sensor != 0;
    write_track_shape(shapes, shape, geometry_number(shape.geometry, emit));
  }
  ByteWriter payload;
  write_track_model(payload, w.bodies.flags[body].type, std::uint32_t(w.bodies.shapes[body].size()),
                    shapes.view());
  const auto next = std::uint32_t(model_numbers_.size());
  const std::uint64_t hash = hash_bytes(payload.view().data(), payload.size());
  const std::uint32_t number = model_numbers_.find_or_insert(hash, next);
  if (number == next) emit(ChunkKind::track_model, payload.view());
  return number;
}

void TrackWriter::update_rounded_pose(const BodyPose& body_pose, const BodyMass& mass, WrittenBody& written) {
  constexpr int kMinUnchangedFrames =
      8;  // frames; a slowly moving body would need a new rounding soon anyway
  const Pose pose = origin_pose(body_pose, mass);
  if (is_finite(pose)) {
    const RoundedPose next = round_pose(pose, start_.steps);
    if (!(next == written.next)) {
      written.next = next;
      written.unchanged_frames = 0;
      written.settled = false;
    }
  }
  written.tolerance = written.unchanged_frames < kMinUnchangedFrames
                          ? RoundingTolerance{}
                          : find_rounding_tolerance(body_pose, mass, start_.steps);
  written.reference = body_pose;
  written.reference_mass_center = mass.center;
}

void TrackWriter::update_known_body(const WorldState& state, WrittenBody& written) {
  const BodyStore& bodies = state.rigid.bodies;
  const std::uint32_t index = written.body.index;
  const BodyPose& body_pose = bodies.poses[index];
  const BodyMass& mass = bodies.masses[index];
  const bool awake = is_simulated(bodies.flags[index]);
  ++written.unchanged_frames;
  if (!is_within(body_pose, written.reference, written.tolerance) ||
      !(mass.center == written.reference_mass_center))
    update_rounded_pose(body_pose, mass, written);
  written.moved = awake || written.unchanged_frames == 0;
  if (awake == written.body.awake && written.moved == written.body.active) return;
  written.body.awake = awake;
  written.body.active = written.moved;
  changes_.push_back({index, BodyChange::flags});
}

void TrackWriter::update_body(const WorldState& state, std::uint32_t index, bool key, EmitChunk emit) {
  const BodyStore& bodies = state.rigid.bodies;
  WrittenBody& written = bodies_[index];
  written.moved = false;
  if (!bodies.ids.live(index)) {
    if (!written.present) return;
    written.present = false;
    ++set_version_;
    if (!key) changes_.push_back({index, BodyChange::removed});
    return;
  }
  const auto generation = std::uint16_t(bodies.ids.generation(index));
  const bool was_written = written.present && written.body.generation == generation;
  const std::uint32_t model =
      was_written && !models_stale_ ? written.body.model : model_of(state.rigid, index, emit);
  const bool same = was_written && model == written.body.model;
  if (!same) ++set_version_;
  if (same && !key) {
    update_known_body(state, written);
    return;
  }
  written.present = true;
  written.unchanged_frames = 0;
  written.settled = false;
  written.tolerance = {};
  written.reference = bodies.poses[index];
  written.reference_mass_center = bodies.masses[index].center;
  const Pose pose = origin_pose(bodies, index);
  if (is_finite(pose)) {
    written.next = round_pose(pose, start_.steps);
  } else if (!was_written) {
    written.next = round_pose({}, start_.steps);
  }
  written.body.index = index;
  written.body.generation = generation;
  written.body.model = model;
  written.body.awake = written.body.active = is_simulated(bodies.flags[index]);
  written.body.pose = begin_history(written.next);
  changes_.push_back({index, BodyChange::put});
}

// If neither the pose nor its history changes any more, the bits stay the same as long as the pose does.
void TrackWriter::settle(WrittenBody& written) const {
  BitWriter bits;
  PoseHistory history = written.body.pose;
  code_next_pose(bits, written.next, history, start_.steps);
  written.settled_size = int(bits.size());
  if (written.settled_size > 64) return;
  std::byte buffer[8] = {};
  const std::vector<std::byte> bytes = bits.take();
  std::copy(bytes.begin(), bytes.end(), buffer);
  written.settled_bits = load_little<std::uint64_t>(buffer);
  written.settled = true;
}

void TrackWriter::write_next(BitWriter& bits, WrittenBody& written) {
  if (written.settled) {
    bits.code_bits(written.settled_bits, written.settled_size);
    return;
  }
  PoseHistory& history = written.body.pose;
  const bool is_at_rest = written.unchanged_frames > 0 && history.before == history.now;
  const std::array sizes = std::to_array(history.sizes);
  code_next_pose(bits, written.next, history, start_.steps);
  advance(history, written.next, start_.steps);
  if (is_at_rest && sizes == std::to_array(history.sizes)) settle(written);
}

std::vector<std::byte> TrackWriter::frame_bits() {
  BitWriter bits;
  std::uint64_t count = changes_.size();
  code_change_count(bits, count);
  std::uint64_t expected = 0;
  for (Change& change : changes_) {
    std::uint64_t gap = change.index - expected;
    code_change(bits, gap, change.kind);
    expected = std::uint64_t(change.index) + 1;
    WrittenBody& written = bodies_[change.index];
    if (change.kind == BodyChange::put) code_put(bits, written.body, written.next, start_.steps);
    if (change.kind == BodyChange::flags) code_flags(bits, written.body);
  }
  for (WrittenBody& written : bodies_) {
    if (written.moved) write_next(bits, written);
  }
  return bits.take();
}

void TrackWriter::frame(const WorldState& state, EmitChunk emit) {
  const bool key = frames_since_key_ >= kKeyframeInterval;
  frames_since_key_ = key ? 1 : frames_since_key_ + 1;
  changes_.clear();
  // The number of slots never falls within a world, but a restored state may have fewer.
  const std::size_t slots = state.rigid.bodies.ids.capacity();
  if (bodies_.size() < slots) bodies_.resize(slots);
  for (std::uint32_t i = 0; i < bodies_.size(); ++i) update_body(state, i, key, emit);
  models_stale_ = false;
  if (softs_.frame(state.soft, key, emit)) ++set_version_;
  ByteWriter payload;
  write_frame_head(payload, {state.step_count, state.time, set_version_});
  payload.put_bytes(frame_bits());
  emit(key ? ChunkKind::track_keyframe : ChunkKind::track_frame, payload.view());
}

}  // namespace gyre
