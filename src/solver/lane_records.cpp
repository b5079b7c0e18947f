#include "solver/lane_records.h"

#include "solver/joint_drive.h"

#include <cstring>

namespace gyre {

namespace {

constexpr std::size_t kTwist = offsetof(LaneJoint, twist) / sizeof(float);
constexpr std::size_t kSwing = offsetof(LaneJoint, swing) / sizeof(float);
// Floats of a lane that come out, and those of an axis.
constexpr std::size_t kImpulses = offsetof(LaneJoint, linear_impulse) / sizeof(float);
constexpr std::size_t kAngularImpulse = offsetof(LaneJoint, angular_impulse) / sizeof(float);
constexpr std::size_t kTotalLinear = offsetof(LaneJoint, total_linear) / sizeof(float);
constexpr std::size_t kTotalAngular = offsetof(LaneJoint, total_angular) / sizeof(float);
constexpr std::size_t kPosition = offsetof(LaneJoint, position) / sizeof(float);
constexpr std::size_t kError = offsetof(LaneJoint, error) / sizeof(float);
constexpr std::size_t kAngularError = offsetof(LaneJoint, angular_error) / sizeof(float);
constexpr std::size_t kAxisImpulses = offsetof(LaneAxis, low_impulse) / sizeof(float);
constexpr std::size_t kHighImpulse = offsetof(LaneAxis, high_impulse) / sizeof(float);
constexpr std::size_t kAxisTotal = offsetof(LaneAxis, total) / sizeof(float);
constexpr std::size_t kLowGap = offsetof(LaneAxis, low_gap) / sizeof(float);
constexpr std::size_t kHighGap = offsetof(LaneAxis, high_gap) / sizeof(float);

// A joint's lane of a bundle, and ranges of its floats.
class Lane {
 public:
  Lane(const LinkageBundle& bundle, int lane, std::uint32_t node)
      : first_(reinterpret_cast<float*>(bundle.joints + node * bundle.kernels->joint_bytes) + lane),
        width_(std::size_t(bundle.kernels->width)) {}
  float* at(std::size_t number) const { return first_ + number * width_; }
  std::size_t width() const { return width_; }
  // Each float by itself: what is written to memory in pieces and read from there as one waits for the pieces.
  float number(std::size_t begin) const { return first_[begin * width_]; }
  Vec3 vector(std::size_t begin) const { return {number(begin), number(begin + 1), number(begin + 2)}; }

 private:
  float* first_;
  std::size_t width_;
};

// A lane in the order of its floats.
class LaneWriter {
 public:
  LaneWriter(const Lane& lane, std::size_t begin) : to_(lane.at(begin)), width_(lane.width()) {}
  LaneWriter& operator<<(float value) {
    *to_ = value;
    to_ += width_;
    return *this;
  }
  LaneWriter& operator<<(Vec3 v) { return *this << v.x << v.y << v.z; }
  LaneWriter& operator<<(Quat q) { return *this << q.x << q.y << q.z << q.w; }

 private:
  float* to_;
  std::size_t width_;
};

// Whether anything acts on the axis, and if so whether that is no more than a hard stop.
enum class Acts : std::uint8_t { nothing, stop, more };
Acts what_acts(const JointAxisRecord& axis, const LaneStart& start) {
  const bool is_limited = axis.motion == AxisMotion::limited;
  if (start.limits_only ? !is_limited : !acts(axis)) return Acts::nothing;
  if (!is_limited || axis.limit_frequency > 0.0f) return Acts::more;
  const bool is_driven = axis.motor_force > 0.0f || axis.friction > 0.0f || has_spring(axis);
  return is_driven && !start.limits_only ? Acts::more : Acts::stop;
}

void begin_stop(const Lane& lane, std::size_t at, const Limits& limits, float low_impulse, float high_impulse,
                const LaneStart& start) {
  const bool is_new = start.limits_only;
  LaneWriter(lane, at) << limits.low << limits.high << (is_new ? 0.0f : start.warm_scale * low_impulse)
                       << (is_new ? 0.0f : start.warm_scale * high_impulse) << 0.0f;
}
void finish_stop(const Lane& lane, std::size_t at, float& low_impulse, float& high_impulse) {
  low_impulse = lane.number(at + kAxisImpulses);
  high_impulse = lane.number(at + kHighImpulse);
}
void finish_stop(const Lane& lane, std::size_t at, JointAxisRecord& axis) {
  finish_stop(lane, at, axis.low_impulse, axis.high_impulse);
  axis.total = lane.number(at + kAxisTotal);
}

}  // namespace

bool fits_lane(const JointRecord& joint, const JointDetail* detail, const LaneStart& start, LaneNode& node) {
  if (joint.kind != JointKind::ball && joint.kind != JointKind::cone && joint.kind != JointKind::hinge)
    return false;
  if (detail != nullptr && !start.limits_only && has_drive(*detail)) return false;
  node.kind = joint.kind;
  node.has_twist = node.has_swing = false;
  if (joint.kind == JointKind::hinge) {
    const Acts all = what_acts(axis_of_record(joint, detail, JointAxis::angular_x), start);
    node.has_twist = all == Acts::stop;
    return all != Acts::more;
  }
  if (detail == nullptr) return true;
  for (int i = 0; i < kJointAxisCount; ++i) {
    const JointAxisRecord& axis = detail->axes[i];
    if (axis.motion == AxisMotion::locked) continue;
    const Acts all = what_acts(axis, start);
    if (all == Acts::nothing) continue;
    bool& stop = JointAxis(i) == JointAxis::angular_x ? node.has_twist : node.has_swing;
    const bool turns = JointAxis(i) == JointAxis::angular_x || JointAxis(i) == JointAxis::angular_y;
    if (all == Acts::more || !turns || joint.kind != JointKind::cone) return false;
    stop = true;
  }
  return true;
}

void clear_lanes(const LinkageBundle& bundle) {
  std::memset(static_cast<void*>(bundle.joints), 0, bundle.node_count * bundle.kernels->joint_bytes);
  for (std::uint32_t body = 0; body < bundle.body_count; ++body) {
    for (int lane = 0; lane < bundle.kernels->width; ++lane) set_lane_body(bundle, lane, body, kNoBody);
  }
}

void set_lane_body(const LinkageBundle& bundle, int lane, std::uint32_t body, std::int32_t record) {
  std::byte* const records = bundle.bodies + body * bundle.kernels->body_bytes;
  std::memcpy(records + std::size_t(lane) * sizeof record, &record, sizeof record);
}

void begin_lane(const LinkageBundle& bundle, int lane, std::uint32_t node, const JointRecord& joint,
                const JointDetail* detail, Vec3 offset, const LaneStart& start) {
  const Lane to(bundle, lane, node);
  const LaneNode& shape = bundle.nodes[node];
  const bool is_hinge = joint.kind == JointKind::hinge;
  LaneWriter writer(to, 0);
  writer << joint.local_anchor_a << joint.local_anchor_b << offset;
  writer << start.warm_scale * joint.linear_impulse;
  writer << (is_hinge ? start.warm_scale * joint.angular_impulse : Vec3{});
  writer << Vec3{} << Vec3{};  // the sums
  if (joint.kind == JointKind::ball) return;
  writer << joint.local_frame_a << joint.local_frame_b << joint.position;
  if (!shape.has_swing) {
    writer << 0.0f << 0.0f;
  } else {
    constexpr float kLeastSwing = 1.0e-3f;  // rad
    const JointAxisRecord& swing = detail->axes[int(JointAxis::angular_y)];
    writer << 1.0f / max(detail->swing_y, kLeastSwing) << 1.0f / max(detail->swing_z, kLeastSwing);
    begin_stop(to, kSwing, swing.limits, swing.low_impulse, swing.high_impulse, start);
  }
  if (!shape.has_twist) return;
  if (is_hinge) return begin_stop(to, kTwist, joint.limits, joint.low_impulse, joint.high_impulse, start);
  const JointAxisRecord& twist = detail->axes[int(JointAxis::angular_x)];
  begin_stop(to, kTwist, twist.limits, twist.low_impulse, twist.high_impulse, start);
}

void forget_lane_impulses(const LinkageBundle& bundle) {
  constexpr std::size_t kFloats =
      sizeof(LaneJoint::linear_impulse) / sizeof(float) + sizeof(LaneJoint::angular_impulse) / sizeof(float);
  const std::size_t width = std::size_t(bundle.kernels->width);
  for (std::uint32_t n = 0; n < bundle.node_count; ++n) {
    std::byte* const joint = bundle.joints + n * bundle.kernels->joint_bytes;
    const auto clear = [&](std::size_t first, std::size_t count) {
      std::memset(joint + first * sizeof(float) * width, 0, count * sizeof(float) * width);
    };
    clear(kImpulses, kFloats);
    for (const std::size_t axis : {kTwist, kSwing}) clear(axis + kAxisImpulses, 2);  // of both stops
  }
}

float find_lane_error(const LinkageBundle& bundle, int lane) {
  float most = 0.0f;
  const auto add = [&](Vec3 v) { most = max(most, largest(absolute(v))); };
  for (std::uint32_t n = 0; n < bundle.node_count; ++n) {
    const LaneNode& node = bundle.nodes[n];
    const Lane from(bundle, lane, n);
    add(from.vector(kError));
    if (node.kind == JointKind::hinge) add(from.vector(kAngularError));
    if (node.has_twist) most = max(most, max(-from.number(kTwist + kLowGap), -from.number(kTwist + kHighGap)));
    if (node.has_swing) most = max(most, -from.number(kSwing + kHighGap));
  }
  return most;
}

void finish_lane(const LinkageBundle& bundle, int lane, std::uint32_t node, JointRecord& joint,
                 JointDetail* detail) {
  const Lane from(bundle, lane, node);
  const LaneNode& shape = bundle.nodes[node];
  joint.linear_impulse = from.vector(kImpulses);
  joint.angular_impulse = from.vector(kAngularImpulse);
  joint.total_linear = from.vector(kTotalLinear);
  joint.total_angular = from.vector(kTotalAngular);
  if (joint.kind == JointKind::ball) return;
  joint.position = from.number(kPosition);
  if (joint.kind == JointKind::hinge) {
    if (!shape.has_twist) return;
    finish_stop(from, kTwist, joint.low_impulse, joint.high_impulse);
    if (detail == nullptr) return;
    JointAxisRecord& axis = detail->axes[int(JointAxis::angular_x)];
    axis = axis_of_record(joint, detail, JointAxis::angular_x);
    axis.total = from.number(kTwist + kAxisTotal);
    return;
  }
  if (detail == nullptr) return;
  JointAxisRecord &twist = detail->axes[int(JointAxis::angular_x)],
                  &swing = detail->axes[int(JointAxis::angular_y)];
  twist.position = joint.position;
  if (shape.has_twist) finish_stop(from, kTwist, twist);
  if (!shape.has_swing) return;
  finish_stop(from, kSwing, swing);
  swing.position = -from.number(kSwing + kLowGap);
  swing.limits = {};
}

}  // namespace gyre
