#include "solver/joint/joint_kinds.h"

#include "math/dense.h"
#include "solver/joint/joint_blocks.h"
#include "solver/joint/path.h"

namespace gyre {

namespace {

// Near what the twist of a cone is told: the nearer way round to its stops, if these are less than a turn apart; otherwise as it was last.
float near_twist(const JointRecord& joint, const JointDetail* detail) {
  if (detail == nullptr) return joint.position;
  const JointAxisRecord& axis = detail->axes[int(JointAxis::angular_x)];
  const Limits& l = axis.limits;
  const bool is_near = axis.motion == AxisMotion::limited && l.high - l.low < 2.0f * kPi;
  return is_near ? 0.5f * (l.low + l.high) : joint.position;
}

// 1 + cos(swing): how well the twist of a cone is told from its swing.
float twist_told(Quat frame_a, Quat frame_b) {
  return 1.0f + dot(rotate(frame_a, {1, 0, 0}), rotate(frame_b, {1, 0, 0}));
}

// ------------------------------------------------------------------------------------------------------ Cardan angles

// The rotation from a's frame to b's as turns about x, then y, then z: the axes about which they turn, world, and the angles.
struct Cardan {
  Vec3 axes[3];
  float angles[3];  // y within a quarter turn

  // d angle / dt = dual . (w_b - w_a): across the other two axes. Where x and z nearly fall together it stays finite.
  Vec3 dual(int i) const {
    constexpr float kLeast = 0.05f;
    const Vec3 across = cross(axes[(i + 1) % 3], axes[(i + 2) % 3]);
    return across / max(dot(axes[i], across), kLeast);
  }
};

Cardan cardan_of(Quat frame_a, Quat frame_b) {
  const Mat3 r = to_matrix(conjugate(frame_a) * frame_b);
  Cardan c;
  c.angles[0] = atan2(-r.z.y, r.z.z);
  c.angles[1] = atan2(r.z.x, std::sqrt(square(r.z.y) + square(r.z.z)));
  c.angles[2] = atan2(-r.y.x, r.x.x);
  c.axes[0] = rotate(frame_a, {1, 0, 0});
  c.axes[2] = rotate(frame_b, {0, 0, 1});
  c.axes[1] = normalized(cross(c.axes[2], c.axes[0]), rotate(frame_a, {0, 1, 0}));
  return c;
}

bool is_locked(const JointDetail& detail, int axis) { return detail.axes[axis].motion == AxisMotion::locked; }

int add_row(JointRows& rows, const JointRow& row) {
  rows.rows[rows.count] = row;
  return rows.count++;
}

JointRow point_row(const JointConstraint& work, Vec3 direction, float error) {
  return {direction, cross(work.from_a, direction), cross(work.from_b, direction), error};
}
JointRow turn_row(Vec3 axis, float error) { return {{}, axis, axis, error}; }

// The error of the locked angles as a rotation, to first order.
Vec3 locked_turn(const JointDetail& detail, const Cardan& c, const Vec3 (&axes)[3]) {
  Vec3 error;
  for (int i = 0; i < 3; ++i) {
    if (!is_locked(detail, 3 + i)) continue;
    const float hold = detail.axes[3 + i].hold;
    error += (unwrapped(c.angles[i], hold) - hold) * axes[i];
  }
  return error;
}

// Rows that hold the locked angles: across the axes that are free. An orthonormal basis that turns with the bodies.
void add_locked_turns(const JointDetail& detail, const JointConstraint& work, const Cardan& c,
                      JointRows& rows) {
  int free_axes[3], free_count = 0;
  for (int i = 0; i < 3; ++i) {
    if (!is_locked(detail, 3 + i)) free_axes[free_count++] = i;
  }
  const Vec3 error = locked_turn(detail, c, c.axes);
  const auto add = [&](Vec3 axis) { add_row(rows, turn_row(axis, dot(axis, error))); };
  if (free_count == 0) {
    const Mat3 frame = to_matrix(work.frame_a);
    for (const Vec3 axis : {frame.x, frame.y, frame.z}) add(axis);
  } else if (free_count == 1) {
    const Vec3 free = c.axes[free_axes[0]];
    const Vec3 first = free_axes[0] == 0   ? rotate(work.frame_a, {0, 1, 0})
                       : free_axes[0] == 1 ? c.axes[0]
                                           : rotate(work.frame_b, {1, 0, 0});
    add(first);
    add(cross(free, first));
  } else if (free_count == 2) {
    add(normalized(cross(c.axes[free_axes[0]], c.axes[free_axes[1]]), c.axes[1]));
  }
}

void place_axis_work(AxisConstraint& x, const AxisRow& row, float position, const JointPair& pair,
                     const JointSettings& settings) {
  x.row = row;
  x.axis.position = position;
  prepare_axis(x, pair, settings);
}

AxisRow point_axis(const JointConstraint& work, Vec3 direction) {
  return {direction, direction, cross(work.from_a, direction), cross(work.from_b, direction)};
}

// An angle that a float tells within a turn, told over many.
double over_turns(float angle, float near) {
  return double(angle) +
         2.0 * kPiDouble * std::floor((double(near) - double(angle)) / (2.0 * kPiDouble) + 0.5);
}

// How far a frame has turned about its own x since it stood as `reference`.
double turned_about_x(Quat reference, Quat frame, float near) {
  const Quat turn = conjugate(reference) * frame;
  return over_turns(2.0f * atan2(turn.x, turn.w), near);
}

float gear_error(const JointDetail& detail, Quat frame_a, Quat frame_b) {
  const double a = turned_about_x(detail.reference_a, frame_a, detail.axes[3].position);
  const double b = turned_about_x(detail.reference_b, frame_b, detail.axes[4].position);
  return float(a + double(detail.ratio) * b);
}

float rack_error(const JointDetail& detail, const RowPose& pose) {
  const double a = turned_about_x(detail.reference_a, pose.frame_a, detail.axes[3].position);
  const float along = dot(pose.centers, rotate(pose.frame_b, {1, 0, 0}));
  return float(double(along) - double(detail.start) - double(detail.ratio) * a);
}

// --------------------------------------------------------------------------------------------------------------- paths

PathCurve curve_of(const JointConstraint& work) { return {work.path, work.detail->path_closed}; }

// What a curve is at a place, in the world.
struct PathFrame {
  Mat3 axes;      // x along it
  Quat turn;      // joint's frame on a from the curve's
  Vec3 position;  // in the joint's frame on a
  Vec3 bending;   // rad/m: how its frame turns along it, world
};
PathFrame path_frame_at(const JointConstraint& work, float place, Quat frame_a) {
  const PathCurve curve = curve_of(work);
  const PathSample s = sample_path(curve, place);
  PathFrame f;
  f.turn = path_frame(curve, place);
  f.axes = to_matrix(frame_a * f.turn);
  f.position = s.position;
  const float speed = length(s.first);
  if (speed > 0.0f) f.bending = rotate(frame_a, cross(s.first, s.second) / (speed * speed * speed));
  return f;
}

Vec3 path_turn_error(const JointDetail& detail, const RowPose& pose, const PathFrame& f) {
  Quat target = pose.frame_a;
  if (detail.path_orientation == PathOrientation::following)
    target = pose.frame_a * (f.turn * conjugate(detail.reference_a));
  return to_rotation_vector(pose.frame_b * conjugate(target));
}

// -------------------------------------------------------------------------------------------------------------- cones

// The stop of a swing: where it is, and the axis about which it is nearest.
struct SwingLimit {
  float gap = 1.0e9f;  // rad
  Vec3 axis;           // world; turning about it brings the stop nearer
};
SwingLimit find_swing_limit(const JointDetail& detail, Quat frame_a, Quat frame_b) {
  constexpr float kMinSwing = 1.0e-3f;
  const Mat3 a = to_matrix(frame_a);
  const Vec3 x_b = rotate(frame_b, {1, 0, 0});
  const Vec3 about = cross(a.x, x_b);
  const float sine = length(about);
  const float angle = atan2(sine, dot(a.x, x_b));
  if (!(sine > 1.0e-6f))
    return angle > 1.0f ? SwingLimit{min(detail.swing_y, detail.swing_z) - angle, a.y} : SwingLimit{};
  const Vec3 along = about / sine;  // the axis of the swing, in a's y z plane
  const float cy = dot(along, a.y), cz = dot(along, a.z);
  const float ly = max(detail.swing_y, kMinSwing), lz = max(detail.swing_z, kMinSwing);
  // f = |swing / limits| = 1 at the stop; its change with the angle, and with the direction times the angle.
  const float share = std::sqrt(square(cy / ly) + square(cz / lz));
  const float across = cy * cz * (1.0f / square(lz) - 1.0f / square(ly)) / share;
  const Vec3 raw = share * along + (across * angle / sine) * cross(x_b, along);
  const float size = length(raw);
  return {(1.0f - share * angle) / size, raw / size};
}

}  // namespace

// ------------------------------------------------------------------------------------------------------------- placing

Vec3 angle_axis(Quat frame_a, Quat frame_b, int angle) { return cardan_of(frame_a, frame_b).dual(angle); }

// Half-way between the axes of a and b.
Vec3 twist_axis(Quat frame_a, Quat frame_b) {
  constexpr float kLeast = 0.05f;
  const Vec3 x_a = rotate(frame_a, {1, 0, 0}), x_b = rotate(frame_b, {1, 0, 0});
  return (x_a + x_b) / max(1.0f + dot(x_a, x_b), kLeast);
}

void adjust_axes(const JointRecord& joint, std::span<AxisConstraint> axes) {
  for (AxisConstraint& x : axes) {
    if (joint.kind == JointKind::pulley || (joint.kind == JointKind::cone && x.index == JointAxis::angular_y))
      x.has_low = false;
  }
}

void place_six_axes(JointRecord& joint, JointConstraint& work, const JointPair& pair,
                    const JointSettings& settings) {
  JointDetail& detail = *work.detail;
  const Mat3 frame = to_matrix(work.frame_a);
  const Vec3 linear[3] = {frame.x, frame.y, frame.z};
  const Vec3 apart = work.error;
  work.from_a += apart;  // the rows act at b's anchor
  work.along = {};
  JointRows& rows = *work.rows;
  rows.count = 0;
  for (int i = 0; i < 3; ++i) {
    const float place = dot(apart, linear[i]);
    detail.axes[i].position = place;
    if (is_locked(detail, i)) {
      add_row(rows, point_row(work, linear[i], place - detail.axes[i].hold));
    } else {
      work.along += place * linear[i];
    }
  }
  work.error = apart - work.along;
  const Cardan c = cardan_of(work.frame_a, work.frame_b);
  for (int i = 0; i < 3; ++i)
    detail.axes[3 + i].position = unwrapped(c.angles[i], detail.axes[3 + i].position);
  add_locked_turns(detail, work, c, rows);
  for (AxisConstraint& x : work.axes) {
    const int i = int(x.index);
    const Vec3 dual = i >= 3 ? c.dual(i - 3) : Vec3{};
    place_axis_work(x, i < 3 ? point_axis(work, linear[i]) : AxisRow{{}, {}, dual, dual},
                    detail.axes[i].position, pair, settings);
  }
  work.position = joint.position = detail.axes[int(main_axis(joint.kind))].position;
}

void prepare_cone(JointRecord& joint, JointConstraint& work, const JointPair& pair,
                  const JointSettings& settings) {
  const Quat twist = conjugate(work.frame_a) * work.frame_b;
  work.position = joint.position = unwrapped(2.0f * atan2(twist.x, twist.w), near_twist(joint, work.detail));
  if (work.detail == nullptr) return;
  work.detail->axes[3].position = joint.position;
  for (AxisConstraint& x : work.axes) {
    if (x.index == JointAxis::angular_x) {
      const Vec3 about = twist_axis(work.frame_a, work.frame_b);
      x.slack = twist_told(work.frame_a, work.frame_b) < kMinTwistReported ? kAway : 0.0f;
      place_axis_work(x, {{}, {}, about, about}, joint.position, pair, settings);
    } else {
      const SwingLimit stop = find_swing_limit(*work.detail, work.frame_a, work.frame_b);
      x.axis.limits = {};
      place_axis_work(x, {{}, {}, stop.axis, stop.axis}, -stop.gap, pair, settings);
    }
  }
}

void place_gear(JointRecord& joint, JointConstraint& work) {
  JointDetail& detail = *work.detail;
  JointRow row;
  row.error = gear_error(detail, work.frame_a, work.frame_b);
  row.arm_a = -rotate(work.frame_a, {1, 0, 0});
  row.arm_b = detail.ratio * rotate(work.frame_b, {1, 0, 0});
  detail.axes[3].position = float(turned_about_x(detail.reference_a, work.frame_a, detail.axes[3].position));
  detail.axes[4].position = float(turned_about_x(detail.reference_b, work.frame_b, detail.axes[4].position));
  work.position = joint.position = detail.axes[3].position;
  work.rows->count = 0;
  add_row(*work.rows, row);
}

void place_rack(JointRecord& joint, JointConstraint& work, const JointPair& pair,
                const JointOffsets& places) {
  JointDetail& detail = *work.detail;
  const Vec3 centers = places.offset + pair.moved();
  work.from_a += work.error;  // to b's anchor
  const Vec3 along = rotate(work.frame_b, {1, 0, 0}), about = rotate(work.frame_a, {1, 0, 0});
  JointRow row;
  row.error = rack_error(detail, {{}, centers, work.frame_a, work.frame_b});
  // The teeth meet at the rim: where it moves along the rack.
  const Vec3 rim = detail.ratio * cross(along, about);
  row.direction = along;
  row.arm_a = detail.ratio * about;
  row.arm_b = cross(rim - centers, along);
  detail.axes[3].position = float(turned_about_x(detail.reference_a, work.frame_a, detail.axes[3].position));
  work.position = joint.position = detail.axes[3].position;
  work.rows->count = 0;
  add_row(*work.rows, row);
}

void place_pulley(JointRecord& joint, JointConstraint& work, const JointPair& pair,
                  const JointOffsets& places, const JointSettings& settings) {
  const float ratio = work.detail->ratio;
  const Vec3 a = pair.moved_a() + work.from_a - places.ground_a,
             b = pair.moved_b() + work.from_b - places.ground_b;
  const float length_a = length(a), length_b = length(b);
  const Vec3 way_a = normalized(a, {0, -1, 0}), way_b = normalized(b, {0, -1, 0});
  work.perpendicular_1 = a;
  work.perpendicular_2 = b;
  work.position = joint.position = length_a + ratio * length_b;
  work.detail->axes[0].position = work.position;
  for (AxisConstraint& x : work.axes) {
    const AxisRow row{-way_a, ratio * way_b, cross(work.from_a, -way_a), cross(work.from_b, ratio * way_b)};
    place_axis_work(x, row, work.position, pair, settings);
  }
}

void bend_pulley(JointConstraint& work, const JointPair& pair, float h) {
  const auto side = [h](Vec3 rope, Vec3 velocity, Vec3 spin, Vec3 arm) {
    const float size = length(rope);
    const Vec3 way = normalized(rope, {0, -1, 0});
    const Vec3 speed = velocity + cross(spin, arm);
    const Vec3 across = speed - dot(speed, way) * way;
    return 0.5f * h *
           (dot(cross(spin, cross(spin, arm)), way) + (size > 0.0f ? length_squared(across) / size : 0.0f));
  };
  for (AxisConstraint& x : work.axes) {
    x.second_order_bias =
        side(work.perpendicular_1, pair.linear_a, pair.angular_a, work.from_a) +
        work.detail->ratio * side(work.perpendicular_2, pair.linear_b, pair.angular_b, work.from_b);
  }
}

void place_path(JointRecord& joint, JointConstraint& work, const JointPair& pair,
                const JointSettings& settings) {
  JointDetail& detail = *work.detail;
  const Vec3 apart = work.error;
  const Vec3 local = rotate_inverse(work.frame_a, apart);
  const PathCurve curve = curve_of(work);
  detail.path_place = nearest_on_path(curve, local, detail.path_place);
  const PathFrame f = path_frame_at(work, detail.path_place, work.frame_a);
  work.from_a += apart;
  JointRows& rows = *work.rows;
  rows.count = 0;
  const Vec3 off = rotate(work.frame_a, local - f.position);
  add_row(rows, point_row(work, f.axes.y, dot(off, f.axes.y)));
  add_row(rows, point_row(work, f.axes.z, dot(off, f.axes.z)));
  work.axis = f.axes.x;
  work.error = off;
  work.along = apart - off;
  if (detail.path_orientation != PathOrientation::free) {
    const Vec3 error = path_turn_error(detail, {apart, {}, work.frame_a, work.frame_b}, f);
    const bool follows = detail.path_orientation == PathOrientation::following;
    for (const Vec3 axis : {f.axes.x, f.axes.y, f.axes.z}) {
      JointRow row = turn_row(axis, dot(axis, error));
      if (follows) {
        row.direction = -dot(axis, f.bending) * f.axes.x;
        row.arm_a += cross(work.from_a, row.direction);
        row.arm_b += cross(work.from_b, row.direction);
      }
      add_row(rows, row);
    }
  }
  work.position = joint.position = path_length(curve, detail.path_place) - detail.start;
  detail.axes[0].position = work.position;
  for (AxisConstraint& x : work.axes)
    place_axis_work(x, point_axis(work, f.axes.x), work.position, pair, settings);
}

// ---------------------------------------------------------------------------------------------------------------- rows

void measure_rows(const JointRecord& joint, const JointConstraint& work, const RowPose& pose,
                  float (&errors)[kJointAxisCount]) {
  const JointDetail& detail = *work.detail;
  const JointRows& rows = *work.rows;
  switch (joint.kind) {
    case JointKind::gear:
      errors[0] = gear_error(detail, pose.frame_a, pose.frame_b);
      return;
    case JointKind::rack_and_pinion:
      errors[0] = rack_error(detail, pose);
      return;
    case JointKind::path: {
      const Vec3 local = rotate_inverse(pose.frame_a, pose.apart);
      const PathFrame f =
          path_frame_at(work, nearest_on_path(curve_of(work), local, detail.path_place), pose.frame_a);
      const Vec3 off = rotate(pose.frame_a, local - f.position);
      errors[0] = dot(off, f.axes.y);
      errors[1] = dot(off, f.axes.z);
      if (rows.count == 2) return;
      const Vec3 turn = path_turn_error(detail, pose, f);
      errors[2] = dot(turn, f.axes.x), errors[3] = dot(turn, f.axes.y), errors[4] = dot(turn, f.axes.z);
      return;
    }
    default:
      break;
  }
  const Mat3 frame = to_matrix(pose.frame_a);
  const Vec3 linear[3] = {frame.x, frame.y, frame.z};
  int n = 0;
  for (int i = 0; i < 3; ++i) {
    if (is_locked(detail, i)) errors[n++] = dot(pose.apart, linear[i]) - detail.axes[i].hold;
  }
  // Along the axes of the rows as they are, so that the rows tell how the error changes.
  const Cardan now = cardan_of(work.frame_a, work.frame_b), later = cardan_of(pose.frame_a, pose.frame_b);
  const Vec3 turn = locked_turn(detail, later, now.axes);
  for (; n < rows.count; ++n) errors[n] = dot(rows.rows[n].arm_a, turn);
}

void prepare_rows(JointRows& rows, const JointPair& pair) {
  const float inverse_mass = pair.inverse_mass_a() + pair.inverse_mass_b();
  const int n = rows.count;
  for (int i = 0; i < n; ++i) {
    const JointRow& row = rows.rows[i];
    const Vec3 spin_a = pair.inverse_inertia_a() * row.arm_a, spin_b = pair.inverse_inertia_b() * row.arm_b;
    for (int j = 0; j <= i; ++j) {
      const JointRow& other = rows.rows[j];
      rows.factors[i * n + j] = double(inverse_mass * dot(row.direction, other.direction) +
                                       dot(spin_a, other.arm_a) + dot(spin_b, other.arm_b));
    }
  }
  factor_ldlt(std::span<double>(rows.factors, std::size_t(n * n)), n);
}

void push_row(const JointRow& row, float impulse, JointPair& pair) {
  push_axis({row.direction, row.direction, row.arm_a, row.arm_b}, impulse, pair);
}

void warm_rows(const JointRows& rows, const JointDetail& detail, JointPair& pair) {
  for (int i = 0; i < rows.count; ++i) push_row(rows.rows[i], detail.row_impulses[i], pair);
}

void iterate_rows(JointRecord& joint, const JointConstraint& work, JointPair& pair,
                  const JointSettings& settings, bool soft) {
  const JointRows& rows = *work.rows;
  JointDetail& detail = *work.detail;
  const std::size_t n = std::size_t(rows.count);
  const Softness& s = settings.softness;
  const bool bends = soft && joint.kind != JointKind::gear && joint.kind != JointKind::rack_and_pinion;
  double x[kJointAxisCount];
  for (int i = 0; i < rows.count; ++i) {
    const JointRow& row = rows.rows[i];
    float speed = axis_speed({row.direction, row.direction, row.arm_a, row.arm_b}, pair);
    if (bends) speed += dot(row.direction, work.second_order_bias);
    x[i] = double(soft ? speed + s.bias_rate * clamped_error(row) : speed);
  }
  solve_ldlt(std::span<const double>(rows.factors, n * n), rows.count, std::span<double>(x, n));
  for (int i = 0; i < rows.count; ++i) {
    const float change =
        soft ? -s.mass_scale * float(x[i]) - s.impulse_scale * detail.row_impulses[i] : -float(x[i]);
    push_row(rows.rows[i], change, pair);
    detail.row_impulses[i] += change;
  }
}

void gather_rows(JointRecord& joint, const JointConstraint& work) {
  joint.linear_impulse = joint.angular_impulse = {};
  for (int i = 0; i < work.rows->count; ++i) {
    const JointRow& row = work.rows->rows[i];
    const float impulse = work.detail->row_impulses[i];
    joint.linear_impulse += impulse * row.direction;
    joint.angular_impulse += impulse * (row.arm_b - cross(work.from_b, row.direction));
  }
}

}  // namespace gyre
