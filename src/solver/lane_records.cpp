#include "solver/lane_records.h"

#include "solver/joint_blocks.h"

#include <cstring>

namespace gyre {

namespace {

constexpr std::size_t kLaneFloats = sizeof(LaneJoint) / sizeof(float);
static_assert(sizeof(LaneJoint) == kLaneFloats * sizeof(float));

float* lane_of(const LinkageBundle& bundle, int lane, std::uint32_t node) {
  return reinterpret_cast<float*>(bundle.joints + node * bundle.kernels->joint_bytes) + lane;
}

AxisWork* axis_at(const JointWork& work, JointAxis index) {
  for (AxisWork& x : work.axes) {
    if (x.index == index) return &x;
  }
  return nullptr;
}

void begin_axis(LaneAxis& lane, const AxisWork& x) {
  lane.low = x.axis.limits.low;
  lane.high = x.axis.limits.high;
  lane.low_impulse = x.axis.low_impulse;
  lane.high_impulse = x.axis.high_impulse;
  lane.total = x.axis.total;
}
void finish_axis(const LaneAxis& lane, AxisWork& x) {
  x.axis.low_impulse = lane.low_impulse;
  x.axis.high_impulse = lane.high_impulse;
  x.axis.total = lane.total;
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
  if (const AxisWork* const x = axis_at(work, JointAxis::angular_x)) begin_axis(from.twist, *x);
  if (const AxisWork* const x = axis_at(work, JointAxis::angular_y)) {
    constexpr float kLeastSwing = 1.0e-3f;  // rad
    begin_axis(from.swing, *x);
    from.swing_grip_y = 1.0f / max(work.detail->swing_y, kLeastSwing);
    from.swing_grip_z = 1.0f / max(work.detail->swing_z, kLeastSwing);
  }
  float floats[kLaneFloats];
  std::memcpy(floats, &from, sizeof from);
  float* const to = lane_of(bundle, lane, node);
  const std::size_t width = std::size_t(bundle.kernels->width);
  for (std::size_t i = 0; i < kLaneFloats; ++i) to[i * width] = floats[i];
}

void finish_lane(const LinkageBundle& bundle, int lane, std::uint32_t node, JointRecord& joint,
                 const JointWork& work) {
  float floats[kLaneFloats];
  const float* const from = lane_of(bundle, lane, node);
  const std::size_t width = std::size_t(bundle.kernels->width);
  for (std::size_t i = 0; i < kLaneFloats; ++i) floats[i] = from[i * width];
  LaneJoint to;
  std::memcpy(static_cast<void*>(&to), floats, sizeof to);
  joint.linear_impulse = to.linear_impulse;
  joint.angular_impulse = to.angular_impulse;
  joint.total_linear = to.total_linear;
  joint.total_angular = to.total_angular;
  if (joint.kind == JointKind::ball) return;
  joint.position = to.position;
  if (joint.kind == JointKind::cone && work.detail != nullptr) work.detail->axes[3].position = to.position;
  if (AxisWork* const x = axis_at(work, JointAxis::angular_x)) {
    finish_axis(to.twist, *x);
    x->axis.position = to.position;
  }
  if (AxisWork* const x = axis_at(work, JointAxis::angular_y)) {
    finish_axis(to.swing, *x);
    x->axis.limits = {};
    x->axis.position = -to.swing.low_gap;
  }
}

}  // namespace gyre
