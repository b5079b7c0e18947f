#include "solver/lane_records.h"

#include "solver/joint_blocks.h"

#include <cstring>

namespace gyre {

namespace {

constexpr std::size_t kTwist = offsetof(LaneJoint, twist) / sizeof(float);
constexpr std::size_t kSwing = offsetof(LaneJoint, swing) / sizeof(float);
// Floats of a lane that go in: that balls have, that all others have too, and of an axis.
constexpr std::size_t kBallFloats = offsetof(LaneJoint, local_frame_a) / sizeof(float);
constexpr std::size_t kFrameFloats = kTwist;
constexpr std::size_t kAxisFloats = offsetof(LaneAxis, low_gap) / sizeof(float);
// Those that come out: the impulses, of an axis them and how far it is to the low stop.
constexpr std::size_t kImpulses = offsetof(LaneJoint, linear_impulse) / sizeof(float);
constexpr std::size_t kError = offsetof(LaneJoint, error) / sizeof(float);
constexpr std::size_t kAngularError = offsetof(LaneJoint, angular_error) / sizeof(float);
constexpr std::size_t kVectorFloats = sizeof(Vec3) / sizeof(float);
constexpr std::size_t kAxisImpulses = offsetof(LaneAxis, low_impulse) / sizeof(float);

// A joint's lane of a bundle, and ranges of its floats.
class Lane {
 public:
  Lane(const LinkageBundle& bundle, int lane, std::uint32_t node)
      : first_(reinterpret_cast<float*>(bundle.joints + node * bundle.kernels->joint_bytes) + lane),
        width_(std::size_t(bundle.kernels->width)) {}
  void write(const void* from, std::size_t begin, std::size_t count) const {
    for (std::size_t i = 0; i < count; ++i)
      std::memcpy(first_ + (begin + i) * width_, static_cast<const std::byte*>(from) + i * sizeof(float),
                  sizeof(float));
  }
  void read(void* to, std::size_t begin, std::size_t count) const {
    for (std::size_t i = 0; i < count; ++i)
      std::memcpy(static_cast<std::byte*>(to) + i * sizeof(float), first_ + (begin + i) * width_,
                  sizeof(float));
  }

 private:
  float* first_;
  std::size_t width_;
};

AxisWork* axis_at(const JointWork& work, JointAxis index) {
  for (AxisWork& x : work.axes) {
    if (x.index == index) return &x;
  }
  return nullptr;
}

void begin_axis(const Lane& lane, std::size_t at, const AxisWork& x) {
  LaneAxis from;
  from.low = x.axis.limits.low;
  from.high = x.axis.limits.high;
  from.low_impulse = x.axis.low_impulse;
  from.high_impulse = x.axis.high_impulse;
  from.total = x.axis.total;
  lane.write(&from, at, kAxisFloats);
}
LaneAxis finish_axis(const Lane& lane, std::size_t at, AxisWork& x) {
  LaneAxis to;
  lane.read(&to.low_impulse, at + kAxisImpulses, kAxisFloats + 1 - kAxisImpulses);
  x.axis.low_impulse = to.low_impulse;
  x.axis.high_impulse = to.high_impulse;
  x.axis.total = to.total;
  return to;
}

}  // namespace

bool fits_lane(const JointRecord& joint, const JointWork& work, LaneNode& node) {
  if (joint.kind != JointKind::ball && joint.kind != JointKind::cone && joint.kind != JointKind::hinge)
    return false;
  if (work.drive != nullptr || work.rows != nullptr) return false;
  node.kind = joint.kind;
  node.has_twist = node.has_swing = false;
  for (const AxisWork& x : work.axes) {
    const bool is_stop = x.axis.motion == AxisMotion::limited && !(x.axis.limit_frequency > 0.0f);
    if (!is_stop || x.axis.motor_force > 0.0f || x.axis.friction > 0.0f || has_spring(x.axis)) return false;
    if (x.index == JointAxis::angular_x && joint.kind != JointKind::ball) {
      node.has_twist = true;
    } else if (x.index == JointAxis::angular_y && joint.kind == JointKind::cone) {
      node.has_swing = true;
    } else {
      return false;
    }
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
                const JointWork& work, const JointPlaces& places) {
  const Lane to(bundle, lane, node);
  const bool is_ball = joint.kind == JointKind::ball;
  LaneJoint from;
  from.local_a = joint.local_anchor_a;
  from.local_b = joint.local_anchor_b;
  from.offset = places.offset;
  from.linear_impulse = joint.linear_impulse;
  from.total_linear = joint.total_linear;
  from.total_angular = joint.total_angular;
  from.local_frame_a = joint.local_frame_a;
  from.local_frame_b = joint.local_frame_b;
  from.position = joint.position;
  if (joint.kind == JointKind::hinge) from.angular_impulse = joint.angular_impulse;
  if (const AxisWork* const x = axis_at(work, JointAxis::angular_x)) begin_axis(to, kTwist, *x);
  if (const AxisWork* const x = axis_at(work, JointAxis::angular_y)) {
    constexpr float kLeastSwing = 1.0e-3f;  // rad
    begin_axis(to, kSwing, *x);
    from.swing_grip_y = 1.0f / max(work.detail->swing_y, kLeastSwing);
    from.swing_grip_z = 1.0f / max(work.detail->swing_z, kLeastSwing);
  }
  to.write(&from, 0, is_ball ? kBallFloats : kFrameFloats);
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
    LaneJoint joint;
    from.read(&joint.error, kError, kVectorFloats);
    add(joint.error);
    if (node.kind == JointKind::hinge) {
      from.read(&joint.angular_error, kAngularError, kVectorFloats);
      add(joint.angular_error);
    }
    if (node.has_twist) {
      from.read(&joint.twist.low_gap, kTwist + kAxisFloats, 2);
      most = max(most, max(-joint.twist.low_gap, -joint.twist.high_gap));
    }
    if (node.has_swing) {
      from.read(&joint.swing.high_gap, kSwing + kAxisFloats + 1, 1);
      most = max(most, -joint.swing.high_gap);
    }
  }
  return most;
}

void finish_lane(const LinkageBundle& bundle, int lane, std::uint32_t node, JointRecord& joint,
                 const JointWork& work) {
  const Lane from(bundle, lane, node);
  LaneJoint to;
  from.read(&to.linear_impulse, kImpulses, kBallFloats - kImpulses);
  joint.linear_impulse = to.linear_impulse;
  joint.angular_impulse = to.angular_impulse;
  joint.total_linear = to.total_linear;
  joint.total_angular = to.total_angular;
  if (joint.kind == JointKind::ball) return;
  from.read(&to.position, offsetof(LaneJoint, position) / sizeof(float), 1);
  joint.position = to.position;
  if (joint.kind == JointKind::cone && work.detail != nullptr) work.detail->axes[3].position = to.position;
  if (AxisWork* const x = axis_at(work, JointAxis::angular_x)) {
    finish_axis(from, kTwist, *x);
    x->axis.position = to.position;
  }
  if (AxisWork* const x = axis_at(work, JointAxis::angular_y)) {
    const LaneAxis swing = finish_axis(from, kSwing, *x);
    x->axis.limits = {};
    x->axis.position = -swing.low_gap;
  }
}

}  // namespace gyre
