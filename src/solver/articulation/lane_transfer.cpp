#include "solver/articulation/lane_transfer.h"

#include "solver/joint/pose_drive.h"

#include <cstring>

namespace gyre {

namespace {

constexpr std::size_t kTwist = offsetof(LaneJoint, twist) / sizeof(float);
constexpr std::size_t kSwing = offsetof(LaneJoint, swing) / sizeof(float);
// Offsets of the results of a lane, and of an axis.
constexpr std::size_t kImpulses = offsetof(LaneJoint, linear_impulse) / sizeof(float);
constexpr std::size_t kAngularImpulse = offsetof(LaneJoint, angular_impulse) / sizeof(float);
constexpr std::size_t kTotalLinear = offsetof(LaneJoint, total_linear) / sizeof(float);
constexpr std::size_t kTotalAngular = offsetof(LaneJoint, total_angular) / sizeof(float);
constexpr std::size_t kPosition = offsetof(LaneJoint, position) / sizeof(float);
constexpr std::size_t kError = offsetof(LaneJoint, error) / sizeof(float);
constexpr std::size_t kAngularError = offsetof(LaneJoint, angular_error) / sizeof(float);
constexpr std::size_t kAxisImpulses = offsetof(LaneLimitAxis, low_impulse) / sizeof(float);
constexpr std::size_t kHighImpulse = offsetof(LaneLimitAxis, high_impulse) / sizeof(float);
constexpr std::size_t kAxisTotal = offsetof(LaneLimitAxis, total) / sizeof(float);
constexpr std::size_t kLowGap = offsetof(LaneLimitAxis, low_gap) / sizeof(float);
constexpr std::size_t kHighGap = offsetof(LaneLimitAxis, high_gap) / sizeof(float);
constexpr std::size_t kFrictionImpulse = offsetof(LaneDrives, friction_impulse) / sizeof(float);
constexpr std::size_t kDrivesTotal = offsetof(LaneDrives, total) / sizeof(float);
constexpr std::size_t kServoMaxImpulse = offsetof(LaneServo, max_impulse) / sizeof(float);

// A lane of a joint of a bundle, or of its drives, and ranges of its floats.
class Lane {
 public:
  Lane(const ArticulationBundle& bundle, int lane, std::uint32_t node)
      : Lane(bundle, lane, bundle.joints + node * bundle.kernels->joint_bytes) {}
  static Lane of_drives(const ArticulationBundle& bundle, int lane, const LaneNode& node) {
    return Lane(bundle, lane, bundle.drives + node.drives * bundle.kernels->drives_bytes);
  }
  static Lane of_servo(const ArticulationBundle& bundle, int lane, const LaneNode& node) {
    return Lane(bundle, lane, bundle.servos + node.servo * bundle.kernels->servo_bytes);
  }
  float* at(std::size_t number) const { return first_ + number * width_; }
  std::size_t width() const { return width_; }
  // Each float by itself: a vector read of memory that was written in pieces waits for the pieces.
  float number(std::size_t begin) const { return first_[begin * width_]; }
  Vec3 vector(std::size_t begin) const { return {number(begin), number(begin + 1), number(begin + 2)}; }

 private:
  Lane(const ArticulationBundle& bundle, int lane, std::byte* block)
      : first_(reinterpret_cast<float*>(block) + lane), width_(std::size_t(bundle.kernels->width)) {}
  float* first_;
  std::size_t width_;
};

// Writes a lane in the order of its floats.
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

bool is_compliant(const JointAxisRecord& axis) {
  return axis.motion == AxisMotion::limited && axis.limit_frequency > 0.0f;
}

bool fits_hinge(const JointRecord& joint, const JointDetail* detail, const LaneStart& start, LaneNode& node) {
  const JointAxisRecord axis = axis_of_record(joint, detail, JointAxis::angular_x);
  node.has_twist = axis.motion == AxisMotion::limited;
  if (is_compliant(axis)) return false;
  if (start.limits_only) return true;
  node.has_servo = axis.motor_force > 0.0f && axis.motor_frequency <= 0.0f;
  node.has_drive = axis.motor_force > 0.0f && !node.has_servo;
  node.has_friction = axis.friction > 0.0f;
  return !has_spring(axis) && (detail == nullptr || !has_drive(*detail));
}

// Linear drives, and drives of ball joints, have no lanes.
bool fits_drives(JointKind kind, const JointDetail& detail, LaneNode& node) {
  node.has_drive = detail.drive.max_torque > 0.0f;
  node.has_friction = detail.friction > 0.0f;
  return !(detail.drive.max_force > 0.0f) && (kind == JointKind::cone || !node.has_drive);
}

// Limits of a cone about its twist and its swing; nothing else acts on an axis.
bool fits_axis(const JointAxisRecord& axis, JointAxis index, const LaneStart& start, LaneNode& node) {
  const bool is_limited = axis.motion == AxisMotion::limited;
  if (axis.motion == AxisMotion::locked || (start.limits_only ? !is_limited : !is_active(axis))) return true;
  if (!is_limited || is_compliant(axis) || node.kind != JointKind::cone) return false;
  const bool is_driven = axis.motor_force > 0.0f || axis.friction > 0.0f || has_spring(axis);
  if (is_driven && !start.limits_only) return false;
  if (index != JointAxis::angular_x && index != JointAxis::angular_y) return false;
  (index == JointAxis::angular_x ? node.has_twist : node.has_swing) = true;
  return true;
}

void begin_limit(const Lane& lane, std::size_t at, const Limits& limits, float low_impulse,
                 float high_impulse, const LaneStart& start) {
  const bool is_new = start.limits_only;
  LaneWriter(lane, at) << limits.low << limits.high << (is_new ? 0.0f : start.warm_scale * low_impulse)
                       << (is_new ? 0.0f : start.warm_scale * high_impulse) << 0.0f;
}
void finish_limit(const Lane& lane, std::size_t at, float& low_impulse, float& high_impulse) {
  low_impulse = lane.number(at + kAxisImpulses);
  high_impulse = lane.number(at + kHighImpulse);
}
void finish_limit(const Lane& lane, std::size_t at, JointAxisRecord& axis) {
  finish_limit(lane, at, axis.low_impulse, axis.high_impulse);
  axis.total = lane.number(at + kAxisTotal);
}

void begin_drives(const Lane& lane, const LaneNode& node, const JointRecord& joint, const JointDetail* detail,
                  const LaneStart& start) {
  const auto soft = [&](float frequency, float damping) {
    return frequency > 0.0f ? make_softness(frequency, damping, start.substep) : start.softness;
  };
  const auto write = [&](Vec3 drive, Vec3 friction, float max_drive, float max_friction, Vec3 target_speed,
                         Quat target, const Softness& softness) {
    LaneWriter(lane, 0) << start.warm_scale * drive << start.warm_scale * friction << 0.0f
                        << start.substep * max_drive << start.substep * max_friction << target_speed << target
                        << softness.bias_rate << softness.mass_scale << softness.impulse_scale;
  };
  if (node.kind == JointKind::hinge) {
    const JointAxisRecord axis = axis_of_record(joint, detail, JointAxis::angular_x);
    const Softness softness =
        axis.has_motor_target ? soft(axis.motor_frequency, axis.motor_damping) : Softness{};
    return write({axis.motor_impulse, 0.0f, 0.0f}, {axis.friction_impulse, 0.0f, 0.0f}, axis.motor_force,
                 axis.friction, {axis.motor_velocity, 0.0f, 0.0f}, {axis.motor_position, 0.0f, 0.0f, 0.0f},
                 softness);
  }
  const PoseDrive& drive = detail->drive;
  write(detail->drive_torque_impulse, detail->friction_impulse, drive.max_torque, detail->friction,
        drive.angular_velocity, normalized(drive.orientation), soft(drive.frequency, drive.damping_ratio));
}

void begin_servo(const Lane& lane, const JointAxisRecord& axis, const LaneStart& start) {
  // The motor may have been stronger in the last step, or the sub-step longer.
  const float max_impulse = start.substep * axis.motor_force;
  const float impulse = clamp(start.warm_scale * axis.motor_impulse, -max_impulse, max_impulse);
  LaneWriter(lane, 0) << axis.motor_position << 0.0f << impulse << 0.0f << 0.0f;
  LaneWriter(lane, kServoMaxImpulse) << max_impulse << axis.motor_velocity
                                     << (axis.has_motor_target ? start.softness.bias_rate : 0.0f);
}

// If a hinge has a detail, the results of its axis are stored there too.
void finish_hinge(const Lane& from, const LaneNode& shape, const Lane* drives, const Lane* servo,
                  JointRecord& joint, JointDetail* detail) {
  if (shape.has_twist) finish_limit(from, kTwist, joint.low_impulse, joint.high_impulse);
  if (drives != nullptr && shape.has_drive) joint.motor_impulse = drives->number(0);
  if (servo != nullptr) joint.motor_impulse = servo->number(kAxisImpulses);
  if (detail == nullptr || (!shape.has_twist && drives == nullptr && servo == nullptr)) return;
  JointAxisRecord& axis = detail->axes[int(JointAxis::angular_x)];
  axis = axis_of_record(joint, detail, JointAxis::angular_x);
  axis.total = shape.has_twist ? from.number(kTwist + kAxisTotal) : 0.0f;
  if (servo != nullptr) axis.total += servo->number(kAxisTotal);
  if (drives == nullptr) return;
  if (shape.has_friction) axis.friction_impulse = drives->number(kFrictionImpulse);
  axis.total += drives->number(kDrivesTotal);
}

}  // namespace

bool fits_lane(const JointRecord& joint, const JointDetail* detail, const LaneStart& start, LaneNode& node) {
  if (joint.kind != JointKind::ball && joint.kind != JointKind::cone && joint.kind != JointKind::hinge)
    return false;
  node.kind = joint.kind;
  node.has_twist = node.has_swing = node.has_drive = node.has_friction = node.has_servo = false;
  if (joint.kind == JointKind::hinge) return fits_hinge(joint, detail, start, node);
  if (detail == nullptr) return true;
  if (!start.limits_only && !fits_drives(joint.kind, *detail, node)) return false;
  for (int i = 0; i < kJointAxisCount; ++i)
    if (!fits_axis(detail->axes[i], JointAxis(i), start, node)) return false;
  return true;
}

void clear_lanes(const ArticulationBundle& bundle) {
  std::memset(static_cast<void*>(bundle.joints), 0, bundle.node_count * bundle.kernels->joint_bytes);
  if (bundle.drive_count > 0)
    std::memset(static_cast<void*>(bundle.drives), 0, bundle.drive_count * bundle.kernels->drives_bytes);
  if (bundle.servo_count > 0)
    std::memset(static_cast<void*>(bundle.servos), 0, bundle.servo_count * bundle.kernels->servo_bytes);
  for (std::uint32_t body = 0; body < bundle.body_count; ++body) {
    for (int lane = 0; lane < bundle.kernels->width; ++lane)
      set_lane_body(bundle, lane, body, kNoBody, false);
  }
}

void set_lane_body(const ArticulationBundle& bundle, int lane, std::uint32_t body, std::int32_t record,
                   bool is_pressed) {
  std::byte* const records = bundle.bodies + body * bundle.kernels->body_bytes;
  const std::int32_t pressed = is_pressed ? 1 : 0;
  const std::size_t width = std::size_t(bundle.kernels->width);
  std::memcpy(records + std::size_t(lane) * sizeof record, &record, sizeof record);
  std::memcpy(records + (width + std::size_t(lane)) * sizeof record, &pressed, sizeof record);
}

void load_lane(const ArticulationBundle& bundle, int lane, std::uint32_t node, const JointRecord& joint,
               const JointDetail* detail, Vec3 offset, const LaneStart& start) {
  const Lane to(bundle, lane, node);
  const LaneNode& shape = bundle.nodes[node];
  const bool is_hinge = joint.kind == JointKind::hinge;
  LaneWriter writer(to, 0);
  writer << joint.local_anchor_a << joint.local_anchor_b << offset;
  writer << start.warm_scale * joint.linear_impulse;
  writer << (is_hinge ? start.warm_scale * joint.angular_impulse : Vec3{});
  writer << Vec3{} << Vec3{};  // the sums
  if (shape.is_driven()) begin_drives(Lane::of_drives(bundle, lane, shape), shape, joint, detail, start);
  if (shape.has_servo)
    begin_servo(Lane::of_servo(bundle, lane, shape), axis_of_record(joint, detail, JointAxis::angular_x),
                start);
  if (joint.kind == JointKind::ball) return;
  writer << joint.local_frame_a << joint.local_frame_b << joint.position;
  if (!shape.has_swing) {
    writer << 0.0f << 0.0f;
  } else {
    const JointAxisRecord& swing = detail->axes[int(JointAxis::angular_y)];
    writer << 1.0f / max(detail->swing_y, kMinSwingLimit) << 1.0f / max(detail->swing_z, kMinSwingLimit);
    begin_limit(to, kSwing, swing.limits, swing.low_impulse, swing.high_impulse, start);
  }
  if (!shape.has_twist) return;
  if (is_hinge) return begin_limit(to, kTwist, joint.limits, joint.low_impulse, joint.high_impulse, start);
  const JointAxisRecord& twist = detail->axes[int(JointAxis::angular_x)];
  begin_limit(to, kTwist, twist.limits, twist.low_impulse, twist.high_impulse, start);
}

void clear_lane_impulses(const ArticulationBundle& bundle) {
  constexpr std::size_t kFloats =
      sizeof(LaneJoint::linear_impulse) / sizeof(float) + sizeof(LaneJoint::angular_impulse) / sizeof(float);
  const std::size_t width = std::size_t(bundle.kernels->width);
  for (std::uint32_t n = 0; n < bundle.node_count; ++n) {
    std::byte* const joint = bundle.joints + n * bundle.kernels->joint_bytes;
    const auto clear = [&](std::size_t first, std::size_t count) {
      std::memset(joint + first * sizeof(float) * width, 0, count * sizeof(float) * width);
    };
    clear(kImpulses, kFloats);
    for (const std::size_t axis : {kTwist, kSwing}) clear(axis + kAxisImpulses, 2);  // of both limits
  }
}

float find_lane_error(const ArticulationBundle& bundle, int lane) {
  float largest_error = 0.0f;
  const auto add = [&](Vec3 v) { largest_error = max(largest_error, largest(absolute(v))); };
  for (std::uint32_t n = 0; n < bundle.node_count; ++n) {
    const LaneNode& node = bundle.nodes[n];
    const Lane from(bundle, lane, n);
    add(from.vector(kError));
    if (node.kind == JointKind::hinge) add(from.vector(kAngularError));
    if (node.has_twist)
      largest_error =
          max(largest_error, max(-from.number(kTwist + kLowGap), -from.number(kTwist + kHighGap)));
    if (node.has_swing) largest_error = max(largest_error, -from.number(kSwing + kHighGap));
  }
  return largest_error;
}

void store_lane(const ArticulationBundle& bundle, int lane, std::uint32_t node, JointRecord& joint,
                JointDetail* detail) {
  const Lane from(bundle, lane, node);
  const LaneNode& shape = bundle.nodes[node];
  joint.linear_impulse = from.vector(kImpulses);
  joint.angular_impulse = from.vector(kAngularImpulse);
  joint.total_linear = from.vector(kTotalLinear);
  joint.total_angular = from.vector(kTotalAngular);
  const Lane drives = Lane::of_drives(bundle, lane, shape);
  const bool is_driven = shape.is_driven();
  if (is_driven && joint.kind != JointKind::hinge) {
    if (shape.has_drive) detail->drive_torque_impulse = drives.vector(0);
    if (shape.has_friction) detail->friction_impulse = drives.vector(kFrictionImpulse);
  }
  if (joint.kind == JointKind::ball) return;
  joint.position = from.number(kPosition);
  if (joint.kind == JointKind::hinge) {
    const Lane servo = Lane::of_servo(bundle, lane, shape);
    return finish_hinge(from, shape, is_driven ? &drives : nullptr, shape.has_servo ? &servo : nullptr, joint,
                        detail);
  }
  if (detail == nullptr) return;
  JointAxisRecord &twist = detail->axes[int(JointAxis::angular_x)],
                  &swing = detail->axes[int(JointAxis::angular_y)];
  twist.position = joint.position;
  if (shape.has_twist) finish_limit(from, kTwist, twist);
  if (!shape.has_swing) return;
  finish_limit(from, kSwing, swing);
  swing.position = -from.number(kSwing + kLowGap);
  swing.limits = {};
}

}  // namespace gyre
