#include "world/joint_commands.h"

#include "collision/contact/pair_update.h"
#include "rigid/rigid_step.h"
#include "rigid/sleep/island.h"
#include "rigid/solve/hit_events.h"
#include "solver/joint/joint_kinds.h"
#include "solver/joint/path.h"
#include "world/gear_housing.h"

namespace gyre {

namespace {

// ---------------------------------------------------------------------------------------------------- lists and pairs

void wake_joint_bodies(RigidWorld& w, const JointRecord& joint) {
  for (const std::int32_t body : {joint.body_a, joint.body_b}) {
    if (body != kNoBody && is_movable(w.bodies.flags[std::size_t(body)])) wake(w, std::uint32_t(body));
  }
}

// The sorted list of the joints of a body.
template <class List>
void insert_sorted(List& list, std::uint32_t slot) {
  std::size_t at = 0;
  while (at < list.size() && list[at] < slot) ++at;
  list.insert_at(at, slot);
}
template <class List>
void erase_slot(List& list, std::uint32_t slot) {
  for (std::size_t i = 0; i < list.size(); ++i) {
    if (list[i] != slot) continue;
    list.erase_at(i);
    return;
  }
}

bool blocks(const JointRecord& joint) {
  return !joint.collide_connected && joint.body_a != kNoBody && joint.body_b != kNoBody;
}

// Lists the fat boxes of both bodies as changed, so that the broad phase finds their contacts again.
void recheck_pairs(RigidWorld& w, const JointRecord& joint) {
  for (const std::int32_t body : {joint.body_a, joint.body_b}) {
    if (body == kNoBody) continue;
    for (const ShapeId id : w.bodies.shapes[std::size_t(body)]) w.shapes.changed.push_back(id.index);
  }
}

// ---------------------------------------------------------------------------------------------------------------- ends

// A point and a frame of the world in the frame of one end of a joint.
struct JointEnd {
  Vec3 anchor;
  Quat frame;
  DVec3 world_anchor;
};
JointEnd joint_end(const RigidWorld& w, std::int32_t body, DVec3 anchor, Quat world_from_joint) {
  if (body == kNoBody) return {{}, world_from_joint, anchor};
  const BodyPose& body_pose = w.bodies.poses[body];
  return {rotate_inverse(body_pose.orientation, difference(anchor, body_pose.center)),
          normalized(conjugate(body_pose.orientation) * world_from_joint), anchor};
}

DVec3 default_anchor_b(const RigidWorld& w, const JointRecord& joint, const FlatJoint& def) {
  if (def.kind != JointKind::distance && def.kind != JointKind::pulley) return def.anchor;
  if (def.anchor_b) return *def.anchor_b;
  return joint.body_b == kNoBody ? DVec3{} : origin_pose(w.bodies, std::uint32_t(joint.body_b)).position;
}

// The world frames of a new joint on a and b. If the two are equal, x is along `axis`, and z along the part of
// `axis_b` at a right angle to it.
struct JointFrames {
  Quat a, b;
};
JointFrames make_frames(const FlatJoint& def) {
  const Vec3 x = normalized(def.axis);
  const Vec3 other = def.axis_b                    ? normalized(*def.axis_b)
                     : def.kind == JointKind::gear ? x
                                                   : any_perpendicular(x);
  switch (def.kind) {
    case JointKind::gear:
    case JointKind::rack_and_pinion:
      return {from_directions({1, 0, 0}, x), from_directions({1, 0, 0}, other)};
    case JointKind::universal:
    case JointKind::wheel: {
      // y is at a right angle to both axes. x is that of a and z that of b; the angle between them is kept.
      const Vec3 y = normalized(cross(other, x), any_perpendicular(x));
      return {from_matrix({x, y, cross(x, y)}), from_matrix({cross(y, other), y, other})};
    }
    case JointKind::six_dof:
    case JointKind::motor:
    case JointKind::cone: {
      if (!def.axis_b) break;
      const Vec3 z = normalized(other - dot(other, x) * x, any_perpendicular(x));
      const Quat frame = from_matrix({x, cross(z, x), z});
      return {frame, frame};
    }
    case JointKind::mouse:
    case JointKind::path:
      return {};
    default:
      break;
  }
  const Quat frame = from_directions({1, 0, 0}, x);
  return {frame, frame};
}

// ---------------------------------------------------------------------------------------------------- what acts on it

// The effective mass of the two bodies along a line through their anchors, kg; 0 if nothing can move.
double mass_along(const RigidWorld& w, const JointRecord& joint, DVec3 anchor_a, DVec3 anchor_b) {
  const Vec3 direction = normalized(difference(anchor_b, anchor_a), {0, 1, 0});
  double inverse = 0.0;
  const auto add = [&](std::int32_t body, DVec3 anchor) {
    if (body == kNoBody) return;
    const std::size_t i = std::size_t(body);
    const BodyPose& body_pose = w.bodies.poses[i];
    const BodyInertia at = world_inertia(w.bodies.masses[i], w.bodies.flags[i], body_pose.orientation);
    const Vec3 arm = cross(difference(anchor, body_pose.center), direction);
    inverse += double(at.inverse_mass) + double(dot(arm, at.inverse * arm));
  };
  add(joint.body_a, anchor_a);
  add(joint.body_b, anchor_b);
  return inverse > 0.0 ? 1.0 / inverse : 0.0;
}

// Stiffness and damping of a spring that is given by frequency and damping ratio.
void set_frequency(JointRecord& joint, const FlatJoint& def, double mass) {
  const double omega = 2.0 * kPiDouble * double(*def.frequency);
  joint.is_spring = true;
  joint.stiffness = float(omega * omega * mass);
  joint.damping = float(2.0 * double(def.damping_ratio) * omega * mass);
}

void set_distance(JointRecord& joint, const FlatJoint& def, float present) {
  const float length = def.length ? *def.length : present;
  joint.rest_length = length;
  joint.is_spring = def.stiffness.has_value() || def.damping.has_value();
  joint.stiffness = def.stiffness ? *def.stiffness : 0.0f;
  joint.damping = def.damping ? *def.damping : 0.0f;
  const bool free = joint.is_spring || def.frequency || def.min_length || def.max_length;
  joint.min_length = def.min_length ? *def.min_length : (free ? 0.0f : length);
  joint.max_length = def.max_length ? *def.max_length : (free ? kUnlimitedLength : length);
  joint.position = present;
}

template <class Record>
void set_motor_of(Record& to, const Motor& motor) {
  to.motor_velocity = motor.target_velocity;
  to.has_motor_target = motor.target_position.has_value();
  to.motor_position = motor.target_position ? *motor.target_position : 0.0f;
  to.motor_force = motor.max_force;
  to.motor_frequency = motor.frequency;
  to.motor_damping = motor.damping_ratio;
}

void set_axis_of(JointAxisRecord& to, const JointAxisDef& def) {
  to.motion = def.motion;
  to.limits = def.limits;
  to.limit_frequency = def.limit_frequency;
  to.limit_damping = def.limit_damping_ratio;
  set_motor_of(to, def.motor);
  to.stiffness = def.stiffness;
  to.damping = def.damping;
  to.rest_position = def.rest_position;
  to.friction = def.friction;
}

// The main axis of a definition: its limits, motor and friction.
JointAxisDef main_axis_of(const FlatJoint& def) {
  JointAxisDef axis{.motion = def.limits ? AxisMotion::limited : AxisMotion::free};
  if (def.limits) axis.limits = *def.limits;
  axis.limit_frequency = def.limit_frequency;
  axis.limit_damping_ratio = def.limit_damping_ratio;
  axis.motor = def.motor;
  axis.friction = def.friction;
  axis.stiffness = def.stiffness ? *def.stiffness : 0.0f;
  axis.damping = def.damping ? *def.damping : 0.0f;
  return axis;
}

JointAxisDef freed(JointAxisDef def) {
  if (def.motion == AxisMotion::locked) def.motion = AxisMotion::free;
  return def;
}

void set_axes(JointDetail& detail, const FlatJoint& def) {
  const JointAxisDef main = main_axis_of(def);
  const auto axis = [&](JointAxis index) -> JointAxisRecord& { return detail.axes[int(index)]; };
  switch (def.kind) {
    case JointKind::six_dof: {
      const JointAxisDef* const given[] = {&def.linear_x,  &def.linear_y,  &def.linear_z,
                                           &def.angular_x, &def.angular_y, &def.angular_z};
      for (int i = 0; i < kJointAxisCount; ++i) set_axis_of(detail.axes[i], *given[i]);
      return;
    }
    case JointKind::universal:
      set_axis_of(axis(JointAxis::angular_x), main);
      set_axis_of(axis(JointAxis::angular_z), freed(def.angular_z));
      return;
    case JointKind::wheel: {
      JointAxisDef suspension = main, spin{.motion = AxisMotion::free};
      spin.motor = main.motor, spin.friction = main.friction;
      suspension.motor = {}, suspension.friction = 0.0f;
      set_axis_of(axis(JointAxis::linear_x), suspension);
      set_axis_of(axis(JointAxis::angular_x), def.angular_x);
      set_axis_of(axis(JointAxis::angular_z), spin);
      return;
    }
    case JointKind::cone: {
      JointAxisDef twist = main;
      twist.friction = 0.0f;
      set_axis_of(axis(JointAxis::angular_x), twist);
      if (!def.swing_y && !def.swing_z) return;
      detail.has_swing = true;
      detail.swing_y = def.swing_y ? *def.swing_y : *def.swing_z;
      detail.swing_z = def.swing_z ? *def.swing_z : *def.swing_y;
      set_axis_of(axis(JointAxis::angular_y), {.motion = AxisMotion::limited,
                                               .limit_frequency = def.limit_frequency,
                                               .limit_damping_ratio = def.limit_damping_ratio});
      return;
    }
    case JointKind::ball:
    case JointKind::gear:
    case JointKind::rack_and_pinion:
    case JointKind::mouse:
    case JointKind::motor:
    case JointKind::fixed:
    case JointKind::distance:
      return;
    case JointKind::hinge:
    case JointKind::slider:
    case JointKind::path:
    case JointKind::pulley:
      break;
  }
  JointAxisRecord& only = axis(main_axis(def.kind));
  set_axis_of(only, main);
}

void add_path(RigidWorld& w, JointDetail& detail, const FlatJoint& def, const JointEnd& a,
              Quat world_from_a) {
  detail.path_first = std::uint32_t(w.joints.path_points.size());
  detail.path_count = std::uint32_t(def.path.size());
  detail.path_closed = def.path_closed;
  detail.path_orientation = def.path_orientation;
  const Quat a_from_world = conjugate(world_from_a * a.frame);
  for (const Vec3& p : def.path) w.joints.path_points.push_back({rotate(a_from_world, p), 0.0f, {}});
  finish_path(w.joints.path_points.view().subspan(detail.path_first), def.path_closed);
  const PathCurve curve{path_of(w.joints, detail), def.path_closed};
  detail.path_parameter = nearest_on_path(curve, Vec3{});
  detail.start = path_length(curve, detail.path_parameter);
  detail.reference_a = path_frame(curve, detail.path_parameter);
  // By default the range of an open path is its whole length.
  JointAxisRecord& path_axis = detail.axes[int(JointAxis::linear_x)];
  if (def.path_closed || def.limits) return;
  path_axis.motion = AxisMotion::limited;
  path_axis.limits = {-detail.start, path_length(curve, curve.end()) - detail.start};
}

// The points of other paths form a closed curve.
void drop_path(JointStore& joints, const JointDetail& detail) {
  if (detail.path_count == 0) return;
  const std::size_t first = detail.path_first, count = detail.path_count;
  for (std::size_t i = first; i + count < joints.path_points.size(); ++i)
    joints.path_points[i] = joints.path_points[i + count];
  joints.path_points.resize(joints.path_points.size() - count);
  for (JointDetail& other : joints.details) {
    if (other.path_count > 0 && other.path_first > detail.path_first) other.path_first -= detail.path_count;
  }
}

void set_pulley(JointDetail& detail, const FlatJoint& def, DVec3 anchor_b) {
  detail.ground_a = def.ground_a;
  detail.ground_b = def.ground_b;
  const float present =
      length(difference(def.anchor, def.ground_a)) + def.ratio * length(difference(anchor_b, def.ground_b));
  JointAxisRecord& rope = detail.axes[int(JointAxis::linear_x)];
  rope.motion = AxisMotion::limited;
  rope.limits = {0.0f, def.length ? *def.length : present};
}

// True if the joint has data beyond its record.
bool needs_detail(const FlatJoint& def) {
  switch (def.kind) {
    case JointKind::fixed:
    case JointKind::distance:
      return false;
    case JointKind::ball:
      return def.friction > 0.0f;
    case JointKind::hinge:
    case JointKind::slider:
      return def.friction > 0.0f || def.limit_frequency > 0.0f || def.stiffness || def.damping;
    default:
      return true;
  }
}

JointDetail& make_detail(JointStore& joints, std::uint32_t slot) {
  if (joints.details.size() <= slot) joints.details.resize(slot + 1);
  joints.details[slot] = {};
  joints.details[slot].used = true;
  return joints.details[slot];
}

void fill_detail(RigidWorld& w, const JointRecord& joint, JointDetail& detail, const FlatJoint& def,
                 const JointEnd& a, const JointEnd& b, const JointFrames& frames) {
  set_axes(detail, def);
  detail.ratio = def.ratio;
  detail.reference_a = frames.a;
  detail.reference_b = frames.b;
  if (def.kind == JointKind::ball || def.kind == JointKind::cone) detail.friction = def.friction;
  if (has_pose_drive(def.kind)) detail.drive = def.drive;
  if (def.kind == JointKind::cone) detail.drive.max_force = 0.0f;
  if (def.kind == JointKind::mouse) detail.drive.max_torque = 0.0f;
  const auto orientation = [&](std::int32_t body) {
    return body == kNoBody ? Quat{} : w.bodies.poses[std::size_t(body)].orientation;
  };
  const auto center = [&](std::int32_t body, DVec3 anchor) {
    return body == kNoBody ? anchor : w.bodies.poses[std::size_t(body)].center;
  };
  if (def.kind == JointKind::rack_and_pinion) {
    const DVec3 from = center(joint.body_a, a.world_anchor), to = center(joint.body_b, b.world_anchor);
    detail.start = dot(difference(to, from), rotate(frames.b, {1, 0, 0}));
  }
  if (def.kind == JointKind::pulley) set_pulley(detail, def, b.world_anchor);
  if (def.kind == JointKind::path) add_path(w, detail, def, a, orientation(joint.body_a));
  if (def.kind == JointKind::universal || def.kind == JointKind::wheel) {
    // The axes keep their directions, even if they are not at a right angle.
    const float sine = dot(rotate(frames.a, {1, 0, 0}), rotate(frames.b, {0, 0, 1}));
    detail.axes[int(JointAxis::angular_y)].locked_position =
        atan2(sine, std::sqrt(max(0.0f, 1.0f - sine * sine)));
  }
}

}  // namespace

std::uint32_t open_axes(JointKind kind) {
  const auto bit = [](JointAxis axis) { return 1u << int(axis); };
  switch (kind) {
    case JointKind::six_dof:
      return (1u << kJointAxisCount) - 1;
    case JointKind::universal:
      return bit(JointAxis::angular_x) | bit(JointAxis::angular_z);
    case JointKind::wheel:
      return bit(JointAxis::linear_x) | bit(JointAxis::angular_x) | bit(JointAxis::angular_z);
    case JointKind::hinge:
    case JointKind::cone:
      return bit(JointAxis::angular_x);
    case JointKind::slider:
    case JointKind::path:
      return bit(JointAxis::linear_x);
    default:
      return 0;
  }
}

bool has_pose_drive(JointKind kind) {
  return kind == JointKind::cone || kind == JointKind::mouse || kind == JointKind::motor;
}

void block_bodies(RigidWorld& w, std::uint32_t a, std::uint32_t b) {
  const std::uint64_t key = pair_key(a, b);
  w.joints.blocked.find_or_insert(key, 0u)++;
  for (const ShapeId id : w.bodies.shapes[a]) {
    for (const std::uint32_t contact : list_contacts_of_shape(w.contacts, id.index, w.listed)) {
      const Contact& pair = w.contacts.contacts[contact];
      if (pair_key(pair.body_a, pair.body_b) != key) continue;
      report_end(w, pair);
      remove_contact(w.contacts, contact);
    }
  }
}

void unblock_bodies(RigidWorld& w, std::uint32_t a, std::uint32_t b) {
  std::uint32_t* count = w.joints.blocked.find(pair_key(a, b));
  if (count != nullptr && --*count == 0) w.joints.blocked.erase(pair_key(a, b));
}

JointId add_joint(RigidWorld& w, const FlatJoint& def) {
  const std::uint32_t slot = w.joints.ids.acquire().index;
  activate_joint(w, slot);
  if (slot >= w.joints.records.size()) w.joints.records.resize(slot + 1);
  JointRecord joint;
  joint.kind = def.kind;
  joint.body_a = def.a ? std::int32_t(def.a.index) : kNoBody;
  joint.body_b = def.b ? std::int32_t(def.b.index) : kNoBody;
  joint.collide_connected = def.collide_connected;
  const DVec3 anchor_b = default_anchor_b(w, joint, def);
  const JointFrames frames = make_frames(def);
  const JointEnd a = joint_end(w, joint.body_a, def.anchor, frames.a);
  const JointEnd b = joint_end(w, joint.body_b, anchor_b, frames.b);
  joint.local_anchor_a = a.anchor, joint.local_frame_a = a.frame, joint.world_anchor_a = a.world_anchor;
  joint.local_anchor_b = b.anchor, joint.local_frame_b = b.frame, joint.world_anchor_b = b.world_anchor;
  if (def.limits) joint.has_limits = true, joint.limits = *def.limits;
  set_motor_of(joint, def.motor);
  joint.break_force = def.break_force ? *def.break_force : 0.0f;
  joint.break_torque = def.break_torque ? *def.break_torque : 0.0f;
  if (def.kind == JointKind::distance) {
    set_distance(joint, def, length(difference(anchor_b, def.anchor)));
    if (def.frequency) set_frequency(joint, def, mass_along(w, joint, def.anchor, anchor_b));
  }
  w.joints.records[slot] = joint;
  if (needs_detail(def)) fill_detail(w, joint, make_detail(w.joints, slot), def, a, b, frames);
  wake_joint_bodies(w, joint);
  for (const std::int32_t body : {joint.body_a, joint.body_b}) {
    if (body != kNoBody) insert_sorted(make_joints_of(w.bodies, std::uint32_t(body)), slot);
  }
  if (blocks(joint)) block_bodies(w, std::uint32_t(joint.body_a), std::uint32_t(joint.body_b));
  // Gears may be older than their bearings.
  for (const std::int32_t body : {joint.body_a, joint.body_b}) {
    if (body == kNoBody || (def.kind != JointKind::hinge && def.kind != JointKind::gear)) continue;
    for (const std::uint32_t of_body : joints_of(w.bodies, std::uint32_t(body))) find_housing(w, of_body);
  }
  return joint_id(w, slot);
}

namespace {

// A coupling goes with any of its joints; the bodies of the others wake.
void remove_couplings_of(RigidWorld& w, std::uint32_t joint) {
  for (CouplingRecord& coupling : w.couplings) {
    bool has = false;
    for (std::uint32_t i = 0; coupling.is_live() && i < coupling.count; ++i) has = has || coupling.joints[i] == joint;
    if (!has) continue;
    for_each_body_of_coupling(w, coupling, [&](std::uint32_t body) { wake(w, body); });
    const std::uint32_t generation = coupling.generation + 1;
    coupling = {};
    coupling.generation = generation;
  }
}

}  // namespace

void remove_joint(RigidWorld& w, std::uint32_t slot) {
  const JointRecord joint = w.joints.records[slot];
  remove_couplings_of(w, slot);
  wake_joint_bodies(w, joint);
  for (const std::int32_t body : {joint.body_a, joint.body_b}) {
    if (body != kNoBody) erase_slot(make_joints_of(w.bodies, std::uint32_t(body)), slot);
  }
  if (blocks(joint)) {
    unblock_bodies(w, std::uint32_t(joint.body_a), std::uint32_t(joint.body_b));
    recheck_pairs(w, joint);
  }
  if (const JointDetail* const detail = detail_of(w.joints, slot)) {
    const JointDetail copy = *detail;
    w.joints.details[slot] = {};
    drop_path(w.joints, copy);
  }
  w.joints.ids.release(slot);
  w.joints.records[slot] = {};
}

void set_motor(RigidWorld& w, std::uint32_t slot, const Motor& motor) {
  JointRecord& joint = w.joints.records[slot];
  set_motor_of(joint, motor);
  if (JointDetail* const detail = detail_of(w.joints, slot))
    set_motor_of(detail->axes[int(main_axis(joint.kind))], motor);
  wake_joint_bodies(w, joint);
}

void set_joint_axis(RigidWorld& w, std::uint32_t slot, JointAxis axis, const JointAxisDef& def) {
  JointRecord& joint = w.joints.records[slot];
  if (detail_of(w.joints, slot) == nullptr) make_detail(w.joints, slot);
  JointAxisRecord& to = w.joints.details[slot].axes[int(axis)];
  // Only axes that can be free or locked may be locked. A locked axis keeps its present position.
  const bool may_lock =
      joint.kind == JointKind::six_dof || (joint.kind == JointKind::wheel && axis == JointAxis::angular_x);
  const bool was_locked = to.motion == AxisMotion::locked;
  set_axis_of(to, may_lock ? def : freed(def));
  if (to.motion == AxisMotion::locked && !was_locked) to.locked_position = to.position;
  // Limits are warm started with the impulse of the last step. Removed limits must not keep theirs.
  const bool is_limited = to.motion == AxisMotion::limited;
  if (!is_limited) to.low_impulse = to.high_impulse = 0.0f;
  if (joint.kind == JointKind::hinge || joint.kind == JointKind::slider) {
    joint.has_limits = is_limited;
    joint.limits = def.limits;
    if (!is_limited) joint.low_impulse = joint.high_impulse = 0.0f;
    set_motor_of(joint, def.motor);
  }
  wake_joint_bodies(w, joint);
}

void set_drive(RigidWorld& w, std::uint32_t slot, const PoseDrive& drive) {
  const JointRecord& joint = w.joints.records[slot];
  JointDetail& detail = w.joints.details[slot];
  detail.drive = drive;
  if (joint.kind == JointKind::cone) detail.drive.max_force = 0.0f;
  if (joint.kind == JointKind::mouse) detail.drive.max_torque = 0.0f;
  wake_joint_bodies(w, joint);
}

void shift_joint_ends(RigidWorld& w, std::uint32_t body, Vec3 by) {
  if (by == Vec3{}) return;
  for (const std::uint32_t slot : joints_of(w.bodies, body)) {
    JointRecord& joint = w.joints.records[slot];
    const bool is_a = joint.body_a == std::int32_t(body);
    Vec3& anchor = is_a ? joint.local_anchor_a : joint.local_anchor_b;
    anchor -= by;
    if (joint.kind != JointKind::rack_and_pinion) continue;
    // The displacement of the prismatic axis is measured between the centres.
    const auto orientation = [&](std::int32_t of) {
      return of == kNoBody ? Quat{} : w.bodies.poses[std::size_t(of)].orientation;
    };
    const Vec3 along = rotate(orientation(joint.body_b) * joint.local_frame_b, {1, 0, 0});
    const float further = dot(rotate(orientation(std::int32_t(body)), by), along);
    detail_of(w.joints, slot)->start += is_a ? -further : further;
  }
}

void forget_impulses(RigidWorld& w, std::uint32_t slot) {
  JointRecord& joint = w.joints.records[slot];
  const float position = joint.position;
  clear_impulses(joint);
  joint.position = position;
  JointDetail* const detail = detail_of(w.joints, slot);
  if (detail == nullptr) return;
  float positions[kJointAxisCount];
  for (int i = 0; i < kJointAxisCount; ++i) positions[i] = detail->axes[i].position;
  clear_impulses(*detail);
  for (int i = 0; i < kJointAxisCount; ++i) detail->axes[i].position = positions[i];
}

void set_joint_enabled(RigidWorld& w, std::uint32_t slot, bool enabled) {
  if (detail_of(w.joints, slot) == nullptr) {
    if (enabled) return;
    make_detail(w.joints, slot);
  }
  JointDetail& detail = w.joints.details[slot];
  if (detail.disabled == !enabled) return;
  detail.disabled = !enabled;
  const float position = w.joints.records[slot].position;
  clear_impulses(w.joints.records[slot]);
  w.joints.records[slot].position = position;
  wake_joint_bodies(w, w.joints.records[slot]);
}

// ------------------------------------------------------------------------------------------------------ flat definitions


namespace {

template <class T>
void set_field(T& to, const T& from) {
  to = from;
}
// Zero stiffness or damping means none. The check refuses other values out of range, NaN among them.
void set_field(std::optional<float>& to, float from) {
  if (from != 0.0f) to = from;
}

template <std::size_t n = 0>
JointDef make_default(std::size_t index) {
  if constexpr (n + 1 < std::variant_size_v<JointDef>) {
    if (index != n) return make_default<n + 1>(index);
  }
  return JointDef(std::in_place_index<n>);
}

}  // namespace

FlatJoint flatten(const JointDef& def) {
  FlatJoint flat;
  flat.kind = kind_of(def);
  std::visit([&](const auto& d) { for_each_field(d, flat, [](const auto& from, auto& to) { set_field(to, from); }); }, def);
  return flat;
}

JointDef default_joint(JointKind kind) { return make_default(std::size_t(kind)); }

}  // namespace gyre
