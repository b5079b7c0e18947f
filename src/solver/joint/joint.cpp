#include "solver/joint/joint.h"

#include "solver/joint/joint_blocks.h"
#include "solver/joint/pose_drive.h"
#include "solver/joint/joint_kinds.h"

namespace gyre {

namespace {

Quat orientation_of(std::int32_t body, const JointBodies& bodies) {
  return body == kNoBody ? Quat{} : bodies.orientation[body];
}

// The second-order bias of a joint: how far the anchors part in h by the rotation of their arms and of the
// slide, over h, beyond the linear rows. With its opposite as bias, the end of the sub-step instead of its
// beginning meets the joint, as in SHAKE (J.-P. Ryckaert, G. Ciccotti, H. Berendsen, 1977). Since relaxation
// takes the rows at the new pose (RATTLE: H. Andersen, 1983), a swinging pendulum keeps its energy.
Vec3 second_order_bias_of(const JointPair& pair, const JointConstraint& work, bool slides, float h) {
  Vec3 second_order_bias = cross(pair.angular_b, cross(pair.angular_b, work.from_b)) -
              cross(pair.angular_a, cross(pair.angular_a, work.from_a));
  if (slides) second_order_bias -= 2.0f * cross(pair.angular_a, pair.point_velocity(work.from_a, work.from_b));
  return 0.5f * h * second_order_bias;
}

void prepare_ball(const JointPair& pair, JointConstraint& work) {
  work.linear_mass = inverse(point_matrix(pair, work.from_a, work.from_b));
}

// The axis of a hinge, slider or distance joint, if anything acts on it.
AxisConstraint* single_axis(JointConstraint& work) { return work.axes.empty() ? nullptr : &work.axes[0]; }

void prepare_line_axis(JointConstraint& work, const JointPair& pair, const JointSettings& settings) {
  AxisConstraint* const x = single_axis(work);
  if (x == nullptr) return;
  x->row = {work.axis, work.axis, cross(work.from_a, work.axis), cross(work.from_b, work.axis)};
  x->axis.position = work.position;
  prepare_axis(*x, pair, settings);
}

void prepare_hinge(JointRecord& joint, const JointPair& pair, JointConstraint& work, const JointSettings& settings) {
  const Mat3 axes_a = to_matrix(work.frame_a);
  const Vec3 axis_b = rotate(work.frame_b, {1, 0, 0});
  work.axis = axes_a.x;
  work.perpendicular_1 = axes_a.y;
  work.perpendicular_2 = axes_a.z;
  work.angular_error = clamp_length(cross(work.axis, axis_b), kMaxErrors.rotation);
  if (settings.iterative) {
    prepare_ball(pair, work);
    const Mat3 k = to_matrix(pair.inverse_inertia_a()) + to_matrix(pair.inverse_inertia_b());
    work.angular_mass = inverse_in_plane(k, work.perpendicular_1, work.perpendicular_2);
  }
  // The twist of b's frame in a's, unwrapped to stay near the last value.
  const Quat twist = conjugate(work.frame_a) * work.frame_b;
  work.position = joint.position = unwrapped(2.0f * atan2(twist.x, twist.w), joint.position);
  AxisConstraint* const x = single_axis(work);
  if (x == nullptr) return;
  x->row = {{}, {}, work.axis, work.axis};
  x->axis.position = work.position;
  prepare_axis(*x, pair, settings);
}

void prepare_slider(JointRecord& joint, const JointPair& pair, JointConstraint& work, const JointSettings& settings) {
  const Mat3 axes_a = to_matrix(work.frame_a);
  work.axis = axes_a.x;
  work.perpendicular_1 = axes_a.y;
  work.perpendicular_2 = axes_a.z;
  work.position = joint.position = dot(work.error, work.axis);
  // The rows act at b's anchor, so the arm of a ends there.
  work.from_a += work.error;
  work.free_offset = work.position * work.axis;
  work.error -= work.free_offset;
  work.angular_error =
      clamp_length(to_rotation_vector(work.frame_b * conjugate(work.frame_a)), kMaxErrors.rotation);
  if (settings.iterative) {
    const Mat3 k = point_matrix(pair, work.from_a, work.from_b);
    work.linear_mass = inverse_in_plane(k, work.perpendicular_1, work.perpendicular_2);
    work.angular_mass = to_matrix(inverse(pair.inverse_inertia_a() + pair.inverse_inertia_b()));
  }
  prepare_line_axis(work, pair, settings);
}

void prepare_fixed(const JointPair& pair, JointConstraint& work, bool iterative) {
  work.angular_error =
      clamp_length(to_rotation_vector(work.frame_b * conjugate(work.frame_a)), kMaxErrors.rotation);
  if (!iterative) return;
  prepare_ball(pair, work);
  work.angular_mass = to_matrix(inverse(pair.inverse_inertia_a() + pair.inverse_inertia_b()));
}

void prepare_distance(JointRecord& joint, const JointPair& pair, JointConstraint& work, const JointSettings& settings) {
  work.axis = normalized(work.error, rotate(Quat{}, {0, 1, 0}));
  work.position = joint.position = length(work.error);
  prepare_line_axis(work, pair, settings);
}

void solve_axes(const JointConstraint& work, JointPair& pair, const JointSettings& settings, bool soft) {
  if (work.drive != nullptr) solve_drive(work, pair, settings);
  for (AxisConstraint& x : work.axes) solve_axis(x, pair, settings, soft);
}
void warm_start_axes(const JointConstraint& work, JointPair& pair, bool rods) {
  for (const AxisConstraint& x : work.axes) {
    if (rods || !x.is_rod) apply_axis_impulse(x.row, axis_impulse(x.axis), pair);
  }
  if (work.drive != nullptr) warm_start_drive(work, pair);
}
bool has_axes(const JointConstraint& work) { return !work.axes.empty() || work.drive != nullptr; }

void solve_angular_rows(JointRecord& joint, const JointConstraint& work, JointPair& pair,
                        const JointSettings& settings, bool soft) {
  const Vec3 change = row_change(work.angular_mass, pair.relative_spin(), work.angular_error,
                                 joint.angular_impulse, settings.softness, soft);
  pair.apply_angular_impulse(change);
  joint.angular_impulse += change;
}

void solve_point_rows(JointRecord& joint, const JointConstraint& work, JointPair& pair, const JointSettings& settings, bool soft) {
  const Vec3 speed = pair.point_velocity(work.from_a, work.from_b) + (soft ? work.second_order_bias : Vec3{});
  const Vec3 change = row_change(work.linear_mass, speed, work.error, joint.linear_impulse, settings.softness, soft);
  pair.apply_impulse(change, work.from_a, work.from_b);
  joint.linear_impulse += change;
}

bool stores_axis_in_record(JointKind kind) {
  return kind == JointKind::hinge || kind == JointKind::slider || kind == JointKind::distance;
}

void scale_impulses(JointAxisRecord& axis, float scale) {
  axis.low_impulse *= scale;
  axis.high_impulse *= scale;
  axis.motor_impulse *= scale;
  axis.spring_impulse *= scale;
  axis.friction_impulse *= scale;
  axis.total = 0.0f;
}

// Clears impulses of parts that no longer act.
void clear_inactive_impulses(JointAxisRecord& axis) {
  if (!(axis.motor_force > 0.0f)) axis.motor_impulse = 0.0f;
  if (!has_spring(axis)) axis.spring_impulse = 0.0f;
  if (!(axis.friction > 0.0f)) axis.friction_impulse = 0.0f;
  if (axis.motion != AxisMotion::limited) axis.low_impulse = axis.high_impulse = 0.0f;
}
void clear_inactive_impulses(JointDetail& detail) {
  if (!(detail.drive.max_force > 0.0f)) detail.drive_force_impulse = {};
  if (!(detail.drive.max_torque > 0.0f)) detail.drive_torque_impulse = {};
  if (!(detail.friction > 0.0f)) detail.friction_impulse = {};
}

// Prepares an axis on which something acts.
void begin_axis(AxisConstraint& x, JointAxis index, const JointAxisRecord& axis, float warm_scale) {
  x = {};
  x.axis = axis;
  clear_inactive_impulses(x.axis);
  scale_impulses(x.axis, warm_scale);
  x.index = index;
  x.has_low = x.has_high = axis.motion == AxisMotion::limited;
}

// Prepares all axes on which anything acts.
void begin_axes(const JointRecord& joint, JointConstraint& work, float warm_scale, Arena& arena) {
  if (stores_axis_in_record(joint.kind)) {
    const JointAxis index = joint.kind == JointKind::hinge ? JointAxis::angular_x : JointAxis::linear_x;
    const JointAxisRecord axis = axis_of_record(joint, work.detail, index);
    if (joint.kind != JointKind::distance && !is_active(axis)) return;
    work.axes = arena.make<AxisConstraint>(1);
    begin_axis(work.axes[0], index, axis, warm_scale);
    if (joint.kind != JointKind::distance) return;
    work.axes[0].is_rod = joint.min_length == joint.max_length;
    work.axes[0].has_low = joint.min_length > 0.0f;
    work.axes[0].has_high = joint.max_length < kUnlimitedLength;
    return;
  }
  if (work.detail == nullptr) return;
  const auto acts_on = [&](int i) {
    const JointAxisRecord& axis = work.detail->axes[i];
    return axis.motion != AxisMotion::locked && is_active(axis);
  };
  std::size_t count = 0;
  for (int i = 0; i < kJointAxisCount; ++i) count += acts_on(i) ? 1 : 0;
  if (count == 0) return;
  work.axes = arena.make<AxisConstraint>(count);
  std::size_t used = 0;
  for (int i = 0; i < kJointAxisCount; ++i) {
    if (acts_on(i)) begin_axis(work.axes[used++], JointAxis(i), work.detail->axes[i], warm_scale);
  }
  adjust_axes(joint, work.axes);
}

void prepare_kind(JointRecord& joint, JointConstraint& work, const JointPair& pair,
                  const JointOffsets& offsets, const JointSettings& settings) {
  switch (joint.kind) {
    case JointKind::ball:
      if (settings.iterative) prepare_ball(pair, work);
      break;
    case JointKind::cone:
      if (settings.iterative) prepare_ball(pair, work);
      prepare_cone(joint, work, pair, settings);
      break;
    case JointKind::hinge: prepare_hinge(joint, pair, work, settings); break;
    case JointKind::slider: prepare_slider(joint, pair, work, settings); break;
    case JointKind::fixed:
      prepare_fixed(pair, work, settings.iterative);
      break;
    case JointKind::distance: prepare_distance(joint, pair, work, settings); break;
    case JointKind::universal:
    case JointKind::six_dof:
    case JointKind::wheel:
      prepare_six_axes(joint, work, pair, settings);
      break;
    case JointKind::gear:
      prepare_gear(joint, work);
      break;
    case JointKind::rack_and_pinion:
      prepare_rack(joint, work, pair, offsets);
      break;
    case JointKind::pulley:
      prepare_pulley(joint, work, pair, offsets, settings);
      break;
    case JointKind::path:
      prepare_path(joint, work, pair, settings);
      break;
    case JointKind::mouse:
    case JointKind::motor: break;
  }
  if (work.drive != nullptr) prepare_drive(work, pair, settings);
  if (work.rows != nullptr && settings.iterative) prepare_rows(*work.rows, pair);
}

}  // namespace

JointAxis main_axis(JointKind kind) {
  switch (kind) {
    case JointKind::hinge:
    case JointKind::cone:
    case JointKind::universal:
    case JointKind::gear:
    case JointKind::rack_and_pinion: return JointAxis::angular_x;
    case JointKind::wheel: return JointAxis::angular_z;
    default: return JointAxis::linear_x;
  }
}

JointAxisRecord axis_of_record(const JointRecord& joint, const JointDetail* detail, JointAxis index) {
  JointAxisRecord axis;
  if (detail != nullptr) axis = detail->axes[int(index)];
  axis.motion = joint.has_limits ? AxisMotion::limited : AxisMotion::free;
  axis.limits = joint.limits;
  axis.has_motor_target = joint.has_motor_target;
  axis.motor_velocity = joint.motor_velocity;
  axis.motor_position = joint.motor_position;
  axis.motor_force = joint.motor_force;
  axis.motor_frequency = joint.motor_frequency;
  axis.motor_damping = joint.motor_damping;
  if (joint.kind == JointKind::distance) {
    axis.motion = AxisMotion::limited;
    axis.limits = {joint.min_length, joint.max_length};
    axis.motor_force = 0.0f;
    axis.stiffness = joint.is_spring ? joint.stiffness : 0.0f;
    axis.damping = joint.is_spring ? joint.damping : 0.0f;
    axis.rest_position = joint.rest_length;
  }
  axis.low_impulse = joint.low_impulse;
  axis.high_impulse = joint.high_impulse;
  axis.motor_impulse = joint.motor_impulse;
  axis.spring_impulse = joint.spring_impulse;
  axis.position = joint.position;
  return axis;
}

bool has_rows(JointKind kind) {
  return kind == JointKind::universal || kind == JointKind::six_dof || kind == JointKind::wheel ||
         kind == JointKind::gear || kind == JointKind::rack_and_pinion || kind == JointKind::path;
}

int count_equations(const JointRecord& joint, const JointDetail* detail) {
  switch (joint.kind) {
    case JointKind::ball:
    case JointKind::cone: return 3;
    case JointKind::hinge:
    case JointKind::slider: return 5;
    case JointKind::fixed: return 6;
    case JointKind::distance: return joint.min_length == joint.max_length && !joint.is_spring ? 1 : 0;
    case JointKind::gear:
    case JointKind::rack_and_pinion: return 1;
    case JointKind::path: return detail->path_orientation == PathOrientation::free ? 2 : 5;
    case JointKind::universal:
    case JointKind::six_dof:
    case JointKind::wheel: {
      int count = 0;
      for (const JointAxisRecord& axis : detail->axes) count += axis.motion == AxisMotion::locked ? 1 : 0;
      return count;
    }
    case JointKind::pulley:
    case JointKind::mouse:
    case JointKind::motor: return 0;
  }
  return 0;
}

void begin_joint(JointRecord& joint, JointDetail* detail, std::span<const PathPoint> path, JointConstraint& work, float warm_scale,
                 Arena& arena) {
  joint.linear_impulse *= warm_scale;
  joint.angular_impulse *= warm_scale;
  joint.total_linear = {};
  joint.total_angular = {};
  work = {};
  work.detail = detail;
  work.path = path;
  begin_axes(joint, work, warm_scale, arena);
  if (detail == nullptr) return;
  clear_inactive_impulses(*detail);
  for (float& impulse : detail->row_impulses) impulse *= warm_scale;
  if (has_rows(joint.kind)) {
    work.rows = arena.make<JointRows>(1).data();
    *work.rows = {};
  }
  if (!has_drive(*detail)) return;
  detail->drive_force_impulse *= warm_scale;
  detail->drive_torque_impulse *= warm_scale;
  detail->friction_impulse *= warm_scale;
  work.drive = arena.make<DriveConstraint>(1).data();
  *work.drive = {};
}

void prepare_joint(JointRecord& joint, JointConstraint& work, const JointOffsets& offsets,
                   const JointBodies& bodies, const JointSettings& settings) {
  const JointPair pair(joint, bodies);
  const Quat orientation_a = orientation_of(joint.body_a, bodies);
  const Quat orientation_b = orientation_of(joint.body_b, bodies);
  work.from_a = rotate(orientation_a, joint.local_anchor_a);
  work.from_b = rotate(orientation_b, joint.local_anchor_b);
  work.error = offsets.offset + pair.relative_displacement() + work.from_b - work.from_a;
  const bool rotates_freely = joint.kind == JointKind::ball || joint.kind == JointKind::distance;
  if (!rotates_freely || work.drive != nullptr) {
    work.frame_a = orientation_a * joint.local_frame_a;
    work.frame_b = orientation_b * joint.local_frame_b;
  }
  prepare_kind(joint, work, pair, offsets, settings);
}

void update_joint_bias(const JointRecord& joint, JointConstraint& work, const JointBodies& bodies,
                const JointSettings& settings) {
  const JointPair pair(joint, bodies);
  const bool slides = joint.kind == JointKind::slider || has_rows(joint.kind);
  work.second_order_bias = second_order_bias_of(pair, work, slides, settings.substep);
  if (joint.kind == JointKind::pulley) update_pulley_bias(work, pair, settings.substep);
  if (joint.kind != JointKind::distance) return;
  const Vec3 speed = pair.point_velocity(work.from_a, work.from_b);
  const Vec3 across = speed - dot(speed, work.axis) * work.axis;
  const float distance = work.position;
  work.axes[0].second_order_bias = dot(work.second_order_bias, work.axis) +
                      (distance > 0.0f ? 0.5f * settings.substep * length_squared(across) / distance : 0.0f);
}

void warm_start_joint(const JointRecord& joint, const JointConstraint& work, const JointBodies& bodies) {
  JointPair pair(joint, bodies);
  if (work.rows != nullptr) {
    warm_start_rows(*work.rows, *work.detail, pair);
  } else {
    pair.apply_impulse(joint.linear_impulse, work.from_a, work.from_b);
    if (joint.angular_impulse != Vec3{}) pair.apply_angular_impulse(joint.angular_impulse);
  }
  warm_start_axes(work, pair, true);
  pair.store();
}

void solve_joint(JointRecord& joint, const JointConstraint& work, const JointBodies& bodies, const JointSettings& settings,
                 bool soft) {
  JointPair pair(joint, bodies);
  solve_axes(work, pair, settings, soft);
  switch (joint.kind) {
    case JointKind::ball:
    case JointKind::cone: solve_point_rows(joint, work, pair, settings, soft); break;
    case JointKind::hinge:
    case JointKind::slider:
    case JointKind::fixed:
      solve_angular_rows(joint, work, pair, settings, soft);
      solve_point_rows(joint, work, pair, settings, soft);
      break;
    default:
      if (work.rows != nullptr) iterate_rows(joint, work, pair, settings, soft);
  }
  pair.store();
}

void warm_start_joint_axes(const JointRecord& joint, const JointConstraint& work, const JointBodies& bodies) {
  if (!has_axes(work)) return;
  JointPair pair(joint, bodies);
  warm_start_axes(work, pair, false);  // rods are equations
  pair.store();
}

void solve_joint_axes(JointRecord& joint, const JointConstraint& work, const JointBodies& bodies,
                      const JointSettings& settings, bool soft) {
  if (!has_axes(work)) return;
  JointPair pair(joint, bodies);
  solve_axes(work, pair, settings, soft);
  pair.store();
}

void accumulate_joint_impulses(JointRecord& joint, const JointConstraint& work, const JointBodies& bodies) {
  if (work.rows != nullptr) sum_row_impulses(joint, work);
  joint.total_linear += joint.linear_impulse;
  joint.total_angular += joint.angular_impulse;
  if (!has_axes(work)) return;
  const JointPair pair(joint, bodies);
  for (AxisConstraint& x : work.axes) {
    const float along = axis_impulse(x.axis);
    x.axis.total += along;
    joint.total_linear += along * x.row.linear_b;
    joint.total_angular += along * (x.row.angular_b - cross(work.from_b, x.row.linear_b));
    x.speed_before = axis_speed(x.row, pair);
  }
  if (work.drive != nullptr) accumulate_drive(joint, *work.detail);
}

void finish_joint(JointRecord& joint, const JointConstraint& work) {
  for (const AxisConstraint& x : work.axes) {
    if (work.detail != nullptr) work.detail->axes[int(x.index)] = x.axis;
    if (!stores_axis_in_record(joint.kind)) continue;
    joint.low_impulse = x.axis.low_impulse;
    joint.high_impulse = x.axis.high_impulse;
    joint.motor_impulse = x.axis.motor_impulse;
    joint.spring_impulse = x.axis.spring_impulse;
  }
}

void clear_impulses(JointRecord& joint) {
  joint.linear_impulse = joint.angular_impulse = {};
  joint.low_impulse = joint.high_impulse = joint.motor_impulse = joint.spring_impulse = 0.0f;
  joint.position = 0.0f;
  joint.total_linear = joint.total_angular = {};
}

void clear_impulses(JointDetail& detail) {
  for (JointAxisRecord& axis : detail.axes) {
    axis.low_impulse = axis.high_impulse = axis.motor_impulse = axis.spring_impulse = axis.friction_impulse = 0.0f;
    axis.position = axis.total = 0.0f;
  }
  for (float& impulse : detail.row_impulses) impulse = 0.0f;
  detail.drive_force_impulse = detail.drive_torque_impulse = detail.friction_impulse = {};
}

}  // namespace gyre
