#include "world/joint_reading.h"

#include "solver/joint/joint_kinds.h"
#include "solver/joint/path.h"
#include "world/joint_commands.h"

namespace gyre {

namespace {

// The two ends of a joint: pose and motion.
struct JointMotion {
  BodyMotion a, b;
  Quat frame_a, frame_b;
  Vec3 offset;  // of b's anchor from a's
  Vec3 speed;   // of b's anchor relative to the body of a at that point
  Vec3 turning;
};
JointMotion state_of(const RigidWorld& w, const JointRecord& joint) {
  const auto motion = [&](std::int32_t body) {
    return body == kNoBody ? BodyMotion{} : w.bodies.motion[std::size_t(body)];
  };
  const auto orientation = [&](std::int32_t body) {
    return body == kNoBody ? Quat{} : w.bodies.poses[std::size_t(body)].orientation;
  };
  const JointAnchors anchors = joint_anchors(w, joint);
  JointMotion s;
  s.a = motion(joint.body_a), s.b = motion(joint.body_b);
  s.frame_a = orientation(joint.body_a) * joint.local_frame_a;
  s.frame_b = orientation(joint.body_b) * joint.local_frame_b;
  const Vec3 angular_b = rotate(orientation(joint.body_b), joint.local_anchor_b);
  s.offset = difference(anchors.b, anchors.a);
  const Vec3 angular_a = rotate(orientation(joint.body_a), joint.local_anchor_a) + s.offset;
  s.speed = s.b.linear_velocity + cross(s.b.angular_velocity, angular_b) - s.a.linear_velocity -
            cross(s.a.angular_velocity, angular_a);
  s.turning = s.b.angular_velocity - s.a.angular_velocity;
  return s;
}

float line_speed(const RigidWorld& w, const JointRecord& joint, const JointDetail* detail,
                 const JointMotion& s, int axis) {
  switch (joint.kind) {
    case JointKind::distance: {
      const JointAnchors anchors = joint_anchors(w, joint);
      return dot(s.speed, normalized(difference(anchors.b, anchors.a)));
    }
    case JointKind::path: {
      const PathCurve curve{path_of(w.joints, *detail), detail->path_closed};
      return dot(s.speed, rotate(s.frame_a, normalized(sample_path(curve, detail->path_parameter).first)));
    }
    case JointKind::pulley: {
      const JointAnchors anchors = joint_anchors(w, joint);
      const auto speed = [&](const BodyMotion& m, std::int32_t body, DVec3 anchor, DVec3 ground) {
        const Vec3 arm = difference(anchor, w.bodies.poses[std::size_t(body)].center);
        return dot(m.linear_velocity + cross(m.angular_velocity, arm),
                   normalized(difference(anchor, ground)));
      };
      return speed(s.a, joint.body_a, anchors.a, detail->ground_a) +
             detail->ratio * speed(s.b, joint.body_b, anchors.b, detail->ground_b);
    }
    default:
      break;
  }
  const Vec3 unit[3] = {{1, 0, 0}, {0, 1, 0}, {0, 0, 1}};
  return dot(s.speed, rotate(s.frame_a, unit[axis]));
}

// Angular velocity of a shaft of a gear about itself, against what the gear counts turns against.
float gear_speed(GearFrame frame, const JointMotion& s, bool of_a) {
  const Vec3 w_a = s.a.angular_velocity, w_b = s.b.angular_velocity;
  const Vec3 x = rotate(of_a ? s.frame_a : s.frame_b, {1, 0, 0}),
             other = rotate(of_a ? s.frame_b : s.frame_a, {1, 0, 0});
  const float speed = dot(of_a ? w_a : w_b, x);
  if (frame == GearFrame::world) return speed;
  const bool centres = frame == GearFrame::centres;
  const Vec3 along = centres ? s.offset : other,
             change = centres ? s.speed + cross(w_a, along) : cross(of_a ? w_b : w_a, along);
  const float lean = dot(along, x);
  const Vec3 arm = along - lean * x;
  const float square_arm = length_squared(arm),
              turned = dot(x, cross(arm, change)) + lean * dot(of_a ? w_a : w_b, arm);
  return square_arm > 0.0f ? speed - turned / square_arm : speed;
}

float turn_speed(const JointRecord& joint, const JointDetail* detail, const JointMotion& s, int axis) {
  const Vec3 x_a = rotate(s.frame_a, {1, 0, 0});
  switch (joint.kind) {
    case JointKind::hinge:
      return dot(s.turning, x_a);
    case JointKind::cone:
      return dot(s.turning, twist_axis(s.frame_a, s.frame_b));
    case JointKind::gear:
      return gear_speed(gear_frame(*detail), s, axis == 0);
    case JointKind::rack_and_pinion:
      return dot(s.a.angular_velocity, x_a);
    default:
      return dot(s.turning, angle_axis(s.frame_a, s.frame_b, axis));
  }
}

// The axes of a kind that have a position, one bit each: those that limits, motors and springs can act on, if there
// are any.
std::uint32_t readable_axes(JointKind kind) {
  const auto bit = [](JointAxis axis) { return 1u << int(axis); };
  if (const std::uint32_t open = open_axes(kind)) return open;
  switch (kind) {
    case JointKind::gear:
      return bit(JointAxis::angular_x) | bit(JointAxis::angular_y);
    case JointKind::ball:
    case JointKind::fixed:
    case JointKind::mouse:
    case JointKind::motor:
      return 0;
    default:
      return bit(main_axis(kind));
  }
}

template <class Record>
Motor motor_of(const Record& from) {
  Motor motor;
  motor.target_velocity = from.motor_velocity;
  if (from.has_motor_target) motor.target_position = from.motor_position;
  motor.max_force = from.motor_force;
  motor.frequency = from.motor_frequency;
  motor.damping_ratio = from.motor_damping;
  return motor;
}

// Forces along the one axis of joints that store it in their record: the total without the rows across it.
float force_in_record(const JointRecord& joint, const JointMotion& s) {
  const Vec3 along = rotate(s.frame_a, {1, 0, 0});
  return joint.kind == JointKind::hinge ? dot(joint.total_angular, along) : dot(joint.total_linear, along);
}

}  // namespace

JointAnchors joint_anchors(const RigidWorld& w, const JointRecord& joint) {
  const auto position = [&](std::int32_t body, Vec3 local, DVec3 world) {
    if (body == kNoBody) return world;
    const BodyPose& at = w.bodies.poses[std::size_t(body)];
    return at.center + rotate(at.orientation, local);
  };
  return {position(joint.body_a, joint.local_anchor_a, joint.world_anchor_a),
          position(joint.body_b, joint.local_anchor_b, joint.world_anchor_b)};
}

JointState read_joint(const RigidWorld& w, std::uint32_t slot) {
  const JointRecord& joint = w.joints.records[slot];
  JointState reading;
  const float seconds = w.settings.last_step;
  if (seconds > 0.0f) {
    reading.force = (1.0f / seconds) * joint.total_linear;
    reading.torque = (1.0f / seconds) * joint.total_angular;
  }
  reading.position = joint.position;
  reading.velocity = read_joint_axis(w, slot, main_axis(joint.kind)).velocity;
  return reading;
}

JointAxisState read_joint_axis(const RigidWorld& w, std::uint32_t slot, JointAxis axis) {
  const JointRecord& joint = w.joints.records[slot];
  if (((readable_axes(joint.kind) >> int(axis)) & 1u) == 0) return {};
  const JointDetail* const detail = detail_of(w.joints, slot);
  const JointMotion s = state_of(w, joint);
  const float seconds = w.settings.last_step;
  const int i = int(axis);
  JointAxisState reading;
  reading.velocity = i < 3 ? line_speed(w, joint, detail, s, i) : turn_speed(joint, detail, s, i - 3);
  const float substep = w.settings.last_substep;
  const bool in_record = joint.kind <= JointKind::distance;
  if (substep > 0.0f) reading.motor = (in_record ? joint.motor_impulse : detail->axes[i].motor_impulse) / substep;
  if (in_record) {
    reading.position = joint.position;
    if (seconds > 0.0f) reading.force = force_in_record(joint, s) / seconds;
    return reading;
  }
  reading.position = detail->axes[i].position;
  if (seconds > 0.0f) reading.force = detail->axes[i].total / seconds;
  return reading;
}

Motor read_motor(const JointRecord& joint) { return motor_of(joint); }

JointAxisDef read_joint_axis_def(const RigidWorld& w, std::uint32_t slot, JointAxis axis) {
  const JointRecord& joint = w.joints.records[slot];
  const int i = int(axis);
  JointAxisDef def;
  if (i < 0 || i >= kJointAxisCount || ((open_axes(joint.kind) >> i) & 1u) == 0) return def;
  const JointDetail* const detail = detail_of(w.joints, slot);
  if (detail == nullptr) {  // a hinge or slider without springs and friction
    def.motion = joint.has_limits ? AxisMotion::limited : AxisMotion::free;
    if (joint.has_limits) def.limits = joint.limits;
    def.motor = motor_of(joint);
    return def;
  }
  const JointAxisRecord& from = detail->axes[i];
  def.motion = from.motion;
  def.limits = from.limits;
  def.limit_frequency = from.limit_frequency;
  def.limit_damping_ratio = from.limit_damping;
  def.motor = motor_of(from);
  def.stiffness = from.stiffness;
  def.damping = from.damping;
  def.rest_position = from.rest_position;
  def.friction = from.friction;
  return def;
}

bool read_joint_load(const RigidWorld& w, std::uint32_t slot, JointAxis axis, float load, JointLoad& out) {
  const JointRecord& joint = w.joints.records[slot];
  const int i = int(axis);
  if (i < 0 || i >= kJointAxisCount || ((open_axes(joint.kind) >> i) & 1u) == 0) return false;
  const JointMotion s = state_of(w, joint);
  out = {};
  if (joint.body_a != kNoBody) out.a = body_id(w, std::uint32_t(joint.body_a));
  if (joint.body_b != kNoBody) out.b = body_id(w, std::uint32_t(joint.body_b));
  if (i >= 3) {
    // The direction whose product with the relative angular velocity is the velocity of the axis: power is load times velocity.
    const Vec3 direction = joint.kind == JointKind::hinge  ? rotate(s.frame_a, {1, 0, 0})
                           : joint.kind == JointKind::cone ? twist_axis(s.frame_a, s.frame_b)
                                                           : angle_axis(s.frame_a, s.frame_b, i - 3);
    out.torque_b = load * direction;
    out.torque_a = -out.torque_b;
    return true;
  }
  Vec3 direction = rotate(s.frame_a, Vec3{i == 0 ? 1.0f : 0.0f, i == 1 ? 1.0f : 0.0f, i == 2 ? 1.0f : 0.0f});
  if (joint.kind == JointKind::path) {
    const JointDetail* const detail = detail_of(w.joints, slot);
    const PathCurve curve{path_of(w.joints, *detail), detail->path_closed};
    direction = rotate(s.frame_a, normalized(sample_path(curve, detail->path_parameter).first));
  }
  out.force = load * direction;
  const DVec3 point = joint_anchors(w, joint).b;
  const auto torque = [&](std::int32_t body) {
    return body == kNoBody ? Vec3{}
                           : cross(difference(point, w.bodies.poses[std::size_t(body)].center), out.force);
  };
  out.torque_a = -torque(joint.body_a);
  out.torque_b = torque(joint.body_b);
  return true;
}

double spring_energy(const RigidWorld& w, std::uint32_t slot) {
  const JointRecord& joint = w.joints.records[slot];
  const JointDetail* const detail = detail_of(w.joints, slot);
  if (!is_joint_enabled(w, slot)) return 0.0;
  if (joint.kind == JointKind::distance) {
    if (!joint.is_spring) return 0.0;
    const JointAnchors anchors = joint_anchors(w, joint);
    const double stretch = length(anchors.b - anchors.a) - double(joint.rest_length);
    return 0.5 * double(joint.stiffness) * stretch * stretch;
  }
  double energy = 0.0;
  if (detail == nullptr) return energy;
  const bool in_record = joint.kind == JointKind::hinge || joint.kind == JointKind::slider;
  for (const JointAxisRecord& axis : detail->axes) {
    if (axis.stiffness <= 0.0f || axis.motion == AxisMotion::locked) continue;
    const double stretch = double(in_record ? joint.position : axis.position) - double(axis.rest_position);
    energy += 0.5 * double(axis.stiffness) * stretch * stretch;
  }
  return energy;
}

const char* to_string(JointKind kind) {
  switch (kind) {
    case JointKind::ball:
      return "ball";
    case JointKind::hinge:
      return "hinge";
    case JointKind::slider:
      return "slider";
    case JointKind::fixed:
      return "fixed";
    case JointKind::distance:
      return "distance";
    case JointKind::cone:
      return "cone";
    case JointKind::universal:
      return "universal";
    case JointKind::six_dof:
      return "six_dof";
    case JointKind::gear:
      return "gear";
    case JointKind::rack_and_pinion:
      return "rack_and_pinion";
    case JointKind::pulley:
      return "pulley";
    case JointKind::wheel:
      return "wheel";
    case JointKind::path:
      return "path";
    case JointKind::mouse:
      return "mouse";
    case JointKind::motor:
      return "motor";
  }
  return "unknown";
}

const char* to_string(JointAxis axis) {
  switch (axis) {
    case JointAxis::linear_x:
      return "linear_x";
    case JointAxis::linear_y:
      return "linear_y";
    case JointAxis::linear_z:
      return "linear_z";
    case JointAxis::angular_x:
      return "angular_x";
    case JointAxis::angular_y:
      return "angular_y";
    case JointAxis::angular_z:
      return "angular_z";
  }
  return "unknown";
}

}  // namespace gyre
