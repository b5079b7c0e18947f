#include "solver/joint/joint_kinds.h"

#include "math/dense.h"
#include "solver/joint/joint_blocks.h"
#include "solver/joint/path.h"

namespace gyre {

namespace {

// The angle near which the twist of a cone is unwrapped: the middle of its limits if these are less than a
// turn apart, else the last twist.
float twist_reference(const JointRecord& joint, const JointDetail* detail) {
  if (detail == nullptr) return joint.position;
  const JointAxisRecord& axis = detail->axes[int(JointAxis::angular_x)];
  const Limits& l = axis.limits;
  const bool is_near = axis.motion == AxisMotion::limited && l.high - l.low < 2.0f * kPi;
  return is_near ? 0.5f * (l.low + l.high) : joint.position;
}

// 1 + cos(swing): near zero the swing leaves the twist undefined.
float twist_certainty(Quat frame_a, Quat frame_b) {
  return 1.0f + dot(rotate(frame_a, {1, 0, 0}), rotate(frame_b, {1, 0, 0}));
}

// ------------------------------------------------------------------------------------------------------ Cardan angles

// The rotation from a's frame to b's as rotations about x, then y, then z: their axes (world) and angles.
struct Cardan {
  Vec3 axes[3];
  float angles[3];  // y within a quarter turn

  // d angle / dt = dual . (w_b - w_a); the dual vector is normal to the other two axes. It stays finite where
  // x and z nearly coincide.
  Vec3 dual(int i) const {
    constexpr float kMinDot = 0.05f;  // sine of the middle angle's distance from 90 degrees
    const Vec3 across = cross(axes[(i + 1) % 3], axes[(i + 2) % 3]);
    return across / max(dot(axes[i], across), kMinDot);
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
JointRow angular_row(Vec3 axis, float error) { return {{}, axis, axis, error}; }

// The error of the locked angles as a rotation vector, to first order.
Vec3 locked_rotation_error(const JointDetail& detail, const Cardan& c, const Vec3 (&axes)[3]) {
  Vec3 error;
  for (int i = 0; i < 3; ++i) {
    if (!is_locked(detail, 3 + i)) continue;
    const float locked = detail.axes[3 + i].locked_position;
    error += (unwrapped(c.angles[i], locked) - locked) * axes[i];
  }
  return error;
}

// Adds rows for the locked angles, normal to the free axes. They are an orthonormal basis that rotates with
// the bodies.
void add_locked_rotation_rows(const JointDetail& detail, const JointConstraint& work, const Cardan& c,
                              JointRows& rows) {
  int free_axes[3], free_count = 0;
  for (int i = 0; i < 3; ++i) {
    if (!is_locked(detail, 3 + i)) free_axes[free_count++] = i;
  }
  const Vec3 error = locked_rotation_error(detail, c, c.axes);
  const auto add = [&](Vec3 axis) { add_row(rows, angular_row(axis, dot(axis, error))); };
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

void prepare_axis_row(AxisConstraint& x, const AxisRow& row, float position, const JointPair& pair,
                      const JointSettings& settings) {
  x.row = row;
  x.axis.position = position;
  prepare_axis(x, pair, settings);
}

AxisRow point_axis(const JointConstraint& work, Vec3 direction) {
  return {direction, direction, cross(work.from_a, direction), cross(work.from_b, direction)};
}

// An angle known within a turn, unwrapped in double.
double unwrap_in_double(float angle, float near) {
  return double(angle) +
         2.0 * kPiDouble * std::floor((double(near) - double(angle)) / (2.0 * kPiDouble) + 0.5);
}

// The rotation of a frame about its own x since it was `reference`.
double rotation_about_x(Quat reference, Quat frame, float near) {
  const Quat rotation = conjugate(reference) * frame;
  return unwrap_in_double(2.0f * atan2(rotation.x, rotation.w), near);
}

// Sine of half the angle between two axes from which on a reference follows.
constexpr float kFollowed = 1.0e-3f;
// Rotates a reference with the axis of its frame, without a rotation about that axis (parallel transport). So the rotation about x is the
// integral of the angular velocity along the axis, wherever the axis goes, and exact while it stays.
Quat followed(Quat reference, Quat frame) {
  const Quat q = conjugate(reference) * frame;
  const float size = std::sqrt(q.x * q.x + q.w * q.w);
  if (!(q.y * q.y + q.z * q.z > kFollowed * kFollowed) || !(size > 0.0f)) return reference;
  const Quat twist{q.x / size, 0.0f, 0.0f, q.w / size};
  return normalized(reference * (q * conjugate(twist)));
}

// The reference of a pinion: it turns with the rack.
Quat pinion_reference(const JointDetail& detail, Quat frame_b) {
  return frame_b * conjugate(detail.reference_b) * detail.reference_a;
}

// The axes of a gear's shafts, and the frames on them that turn with the housing.
struct GearShafts {
  Vec3 a, b;
  Quat frame_a, frame_b;
};
Quat frame_about(Vec3 x, Vec3 toward) {
  const Vec3 y = normalized(toward - dot(toward, x) * x, any_perpendicular(x));
  return from_matrix({x, y, cross(x, y)});
}
GearShafts shafts_of(GearFrame frame, const RowPose& pose) {
  GearShafts shafts{rotate(pose.frame_a, {1, 0, 0}), rotate(pose.frame_b, {1, 0, 0}), {}, {}};
  if (frame == GearFrame::world) return shafts;
  const bool centres = frame == GearFrame::centres;
  shafts.frame_a = frame_about(shafts.a, centres ? pose.anchor_offset : shafts.b);
  shafts.frame_b = frame_about(shafts.b, centres ? pose.anchor_offset : shafts.a);
  return shafts;
}

struct GearTurns {
  double a, b;
};
GearTurns gear_turns(const JointDetail& detail, const RowPose& pose) {
  const GearShafts shafts = shafts_of(gear_frame(detail), pose);
  return {rotation_about_x(shafts.frame_a * detail.reference_a, pose.frame_a, detail.axes[3].position),
          rotation_about_x(shafts.frame_b * detail.reference_b, pose.frame_b, detail.axes[4].position)};
}

float gear_error(const JointDetail& detail, const RowPose& pose) {
  const GearTurns turns = gear_turns(detail, pose);
  return float(turns.a + double(detail.ratio) * turns.b);
}

// The wrench between the wheels, equal and opposite: its torque is -1 about the shaft of a and `ratio` about that of b, and the housing
// bears the rest at the bearings. So no motion of all three together moves the row. Between shafts that are not parallel it is a couple;
// between parallel shafts it is the force of the teeth at the pitch point.
JointRow gear_row(const JointDetail& detail, const JointConstraint& work, Vec3 a, Vec3 b) {
  const float ratio = detail.ratio, along = dot(a, b);
  JointRow row;
  switch (gear_frame(detail)) {
    case GearFrame::world:
      row.angular_a = -a;
      row.angular_b = ratio * b;
      break;
    case GearFrame::shafts:
      row.angular_a = row.angular_b =
          (1.0f / (1.0f - along * along)) * ((ratio + along) * b - (1.0f + ratio * along) * a);
      break;
    case GearFrame::centres: {
      // The least wrench at the middle of the line n between the shafts; couples count over the length of n.
      const Vec3 half = 0.5f * work.error, arm_a = cross(a, half), arm_b = -cross(b, half);
      const float square_n = length_squared(work.error);
      const float aa = length_squared(arm_a) + square_n, bb = length_squared(arm_b) + square_n,
                  ab = dot(arm_a, arm_b) + square_n * along, scale = 1.0f / (aa * bb - ab * ab);
      const float of_a = -scale * (bb + ratio * ab), of_b = scale * (ab + ratio * aa);
      const Vec3 couple = square_n * (of_a * a + of_b * b);
      row.direction = of_a * arm_a + of_b * arm_b;
      row.angular_a = cross(work.from_a + half, row.direction) + couple;
      row.angular_b = cross(work.from_b - half, row.direction) + couple;
    }
  }
  return row;
}

float rack_error(const JointDetail& detail, const RowPose& pose) {
  const double a =
      rotation_about_x(pinion_reference(detail, pose.frame_b), pose.frame_a, detail.axes[3].position);
  const float along = dot(pose.center_offset, rotate(pose.frame_b, {1, 0, 0}));
  return float(double(along) - double(detail.start) - double(detail.ratio) * a);
}

// --------------------------------------------------------------------------------------------------------------- paths

PathCurve curve_of(const JointConstraint& work) { return {work.path, work.detail->path_closed}; }

// The frame of a curve at a parameter.
struct PathFrame {
  Mat3 axes;      // x along the curve
  Quat rotation;  // joint's frame on a from the curve's frame
  Vec3 position;  // in the joint's frame on a
  Vec3 bending;   // rad/m: rotation of the frame along the curve, world
};
PathFrame path_frame_at(const JointConstraint& work, float parameter, Quat frame_a) {
  const PathCurve curve = curve_of(work);
  const PathSample s = sample_path(curve, parameter);
  PathFrame f;
  f.rotation = path_frame(curve, parameter);
  f.axes = to_matrix(frame_a * f.rotation);
  f.position = s.position;
  const float speed = length(s.first);
  if (speed > 0.0f) f.bending = rotate(frame_a, cross(s.first, s.second) / (speed * speed * speed));
  return f;
}

Vec3 path_rotation_error(const JointDetail& detail, const RowPose& pose, const PathFrame& f) {
  Quat target = pose.frame_a;
  if (detail.path_orientation == PathOrientation::following)
    target = pose.frame_a * (f.rotation * conjugate(detail.reference_a));
  return to_rotation_vector(pose.frame_b * conjugate(target));
}

// -------------------------------------------------------------------------------------------------------------- cones

// The swing limit of a cone: the distance to it, and the axis about which it is nearest.
struct SwingLimit {
  float gap = 1.0e9f;  // rad
  Vec3 axis;           // world; rotation about it approaches the limit
};
SwingLimit find_swing_limit(const JointDetail& detail, Quat frame_a, Quat frame_b) {
  const Mat3 a = to_matrix(frame_a);
  const Vec3 x_b = rotate(frame_b, {1, 0, 0});
  const Vec3 about = cross(a.x, x_b);
  const float sine = length(about);
  const float angle = atan2(sine, dot(a.x, x_b));
  if (!(sine > 1.0e-6f))
    return angle > 1.0f ? SwingLimit{min(detail.swing_y, detail.swing_z) - angle, a.y} : SwingLimit{};
  const Vec3 along = about / sine;  // the axis of the swing, in a's y z plane
  const float cy = dot(along, a.y), cz = dot(along, a.z);
  const float ly = max(detail.swing_y, kMinSwingLimit), lz = max(detail.swing_z, kMinSwingLimit);
  // f = |swing / limits| = 1 at the limit; its derivatives by the angle, and by the direction times the
  // angle.
  const float share = std::sqrt(square(cy / ly) + square(cz / lz));
  const float across = cy * cz * (1.0f / square(lz) - 1.0f / square(ly)) / share;
  const Vec3 raw = share * along + (across * angle / sine) * cross(x_b, along);
  const float size = length(raw);
  return {(1.0f - share * angle) / size, raw / size};
}

}  // namespace

// ------------------------------------------------------------------------------------------------------------- preparation

Vec3 angle_axis(Quat frame_a, Quat frame_b, int angle) { return cardan_of(frame_a, frame_b).dual(angle); }

// Half-way between the axes of a and b.
Vec3 twist_axis(Quat frame_a, Quat frame_b) {
  constexpr float kMinDot = 0.05f;  // of 1 + cos(swing): 162 degrees
  const Vec3 x_a = rotate(frame_a, {1, 0, 0}), x_b = rotate(frame_b, {1, 0, 0});
  return (x_a + x_b) / max(1.0f + dot(x_a, x_b), kMinDot);
}

void adjust_axes(const JointRecord& joint, std::span<AxisConstraint> axes) {
  for (AxisConstraint& x : axes) {
    if (joint.kind == JointKind::pulley || (joint.kind == JointKind::cone && x.index == JointAxis::angular_y))
      x.has_low = false;
  }
}

void prepare_six_axes(JointRecord& joint, JointConstraint& work, const JointPair& pair,
                      const JointSettings& settings) {
  JointDetail& detail = *work.detail;
  const Mat3 frame = to_matrix(work.frame_a);
  const Vec3 linear[3] = {frame.x, frame.y, frame.z};
  const Vec3 anchor_offset = work.error;
  work.from_a += anchor_offset;  // the rows act at b's anchor
  work.free_offset = {};
  JointRows& rows = *work.rows;
  rows.count = 0;
  for (int i = 0; i < 3; ++i) {
    const float position = dot(anchor_offset, linear[i]);
    detail.axes[i].position = position;
    if (is_locked(detail, i)) {
      add_row(rows, point_row(work, linear[i], position - detail.axes[i].locked_position));
    } else {
      work.free_offset += position * linear[i];
    }
  }
  work.error = anchor_offset - work.free_offset;
  const Cardan c = cardan_of(work.frame_a, work.frame_b);
  for (int i = 0; i < 3; ++i)
    detail.axes[3 + i].position = unwrapped(c.angles[i], detail.axes[3 + i].position);
  add_locked_rotation_rows(detail, work, c, rows);
  for (AxisConstraint& x : work.axes) {
    const int i = int(x.index);
    const Vec3 dual = i >= 3 ? c.dual(i - 3) : Vec3{};
    prepare_axis_row(x, i < 3 ? point_axis(work, linear[i]) : AxisRow{{}, {}, dual, dual},
                     detail.axes[i].position, pair, settings);
  }
  work.position = joint.position = detail.axes[int(main_axis(joint.kind))].position;
}

void prepare_cone(JointRecord& joint, JointConstraint& work, const JointPair& pair,
                  const JointSettings& settings) {
  const Quat twist = conjugate(work.frame_a) * work.frame_b;
  work.position = joint.position =
      unwrapped(2.0f * atan2(twist.x, twist.w), twist_reference(joint, work.detail));
  if (work.detail == nullptr) return;
  work.detail->axes[3].position = joint.position;
  for (AxisConstraint& x : work.axes) {
    if (x.index == JointAxis::angular_x) {
      const Vec3 about = twist_axis(work.frame_a, work.frame_b);
      x.slack = twist_certainty(work.frame_a, work.frame_b) < kMinTwistReported ? kUnreachable : 0.0f;
      prepare_axis_row(x, {{}, {}, about, about}, joint.position, pair, settings);
    } else {
      const SwingLimit limit = find_swing_limit(*work.detail, work.frame_a, work.frame_b);
      x.axis.limits = {};
      prepare_axis_row(x, {{}, {}, limit.axis, limit.axis}, -limit.gap, pair, settings);
    }
  }
}

void start_gear(JointDetail& detail, GearFrame frame, const RowPose& pose) {
  const GearShafts shafts = shafts_of(frame, pose);
  detail.path_orientation = PathOrientation(frame);
  detail.reference_a = conjugate(shafts.frame_a) * pose.frame_a;
  detail.reference_b = conjugate(shafts.frame_b) * pose.frame_b;
}

void prepare_gear(JointRecord& joint, JointConstraint& work) {
  JointDetail& detail = *work.detail;
  if (gear_frame(detail) == GearFrame::world) {
    detail.reference_a = followed(detail.reference_a, work.frame_a);
    detail.reference_b = followed(detail.reference_b, work.frame_b);
  }
  const RowPose pose{work.error, {}, work.frame_a, work.frame_b};
  JointRow row = gear_row(detail, work, rotate(work.frame_a, {1, 0, 0}), rotate(work.frame_b, {1, 0, 0}));
  row.error = gear_error(detail, pose);
  const GearTurns turns = gear_turns(detail, pose);
  detail.axes[3].position = float(turns.a);
  detail.axes[4].position = float(turns.b);
  work.from_a += work.error;  // to b's anchor
  work.position = joint.position = detail.axes[3].position;
  work.rows->count = 0;
  add_row(*work.rows, row);
}

void prepare_rack(JointRecord& joint, JointConstraint& work, const JointPair& pair,
                  const JointOffsets& offsets) {
  JointDetail& detail = *work.detail;
  const Vec3 center_offset = offsets.offset + pair.relative_displacement();
  work.from_a += work.error;  // to b's anchor
  const Vec3 along = rotate(work.frame_b, {1, 0, 0}), about = rotate(work.frame_a, {1, 0, 0});
  const Quat before = pinion_reference(detail, work.frame_b), now = followed(before, work.frame_a);
  if (now != before) detail.reference_a = normalized(detail.reference_b * conjugate(work.frame_b) * now);
  JointRow row;
  row.error = rack_error(detail, {{}, center_offset, work.frame_a, work.frame_b});
  // The teeth meet at the rim, where it moves along the rack.
  const Vec3 rim = detail.ratio * cross(along, about);
  row.direction = along;
  row.angular_a = detail.ratio * about;
  row.angular_b = cross(rim - center_offset, along);
  detail.axes[3].position =
      float(rotation_about_x(pinion_reference(detail, work.frame_b), work.frame_a, detail.axes[3].position));
  work.position = joint.position = detail.axes[3].position;
  work.rows->count = 0;
  add_row(*work.rows, row);
}

void prepare_pulley(JointRecord& joint, JointConstraint& work, const JointPair& pair,
                    const JointOffsets& offsets, const JointSettings& settings) {
  const float ratio = work.detail->ratio;
  const Vec3 a = pair.displacement_a() + work.from_a - offsets.ground_a,
             b = pair.displacement_b() + work.from_b - offsets.ground_b;
  const float length_a = length(a), length_b = length(b);
  const Vec3 direction_a = normalized(a, {0, -1, 0}), direction_b = normalized(b, {0, -1, 0});
  work.perpendicular_1 = a;
  work.perpendicular_2 = b;
  work.position = joint.position = length_a + ratio * length_b;
  work.detail->axes[0].position = work.position;
  for (AxisConstraint& x : work.axes) {
    const AxisRow row{-direction_a, ratio * direction_b, cross(work.from_a, -direction_a),
                      cross(work.from_b, ratio * direction_b)};
    prepare_axis_row(x, row, work.position, pair, settings);
  }
}

void update_pulley_bias(JointConstraint& work, const JointPair& pair, float h) {
  const auto side = [h](Vec3 rope, Vec3 velocity, Vec3 spin, Vec3 arm) {
    const float size = length(rope);
    const Vec3 direction = normalized(rope, {0, -1, 0});
    const Vec3 speed = velocity + cross(spin, arm);
    const Vec3 across = speed - dot(speed, direction) * direction;
    return 0.5f * h *
           (dot(cross(spin, cross(spin, arm)), direction) +
            (size > 0.0f ? length_squared(across) / size : 0.0f));
  };
  for (AxisConstraint& x : work.axes) {
    x.second_order_bias =
        side(work.perpendicular_1, pair.linear_a, pair.angular_a, work.from_a) +
        work.detail->ratio * side(work.perpendicular_2, pair.linear_b, pair.angular_b, work.from_b);
  }
}

void prepare_path(JointRecord& joint, JointConstraint& work, const JointPair& pair,
                  const JointSettings& settings) {
  JointDetail& detail = *work.detail;
  const Vec3 anchor_offset = work.error;
  const Vec3 local = rotate_inverse(work.frame_a, anchor_offset);
  const PathCurve curve = curve_of(work);
  detail.path_parameter = nearest_on_path(curve, local, detail.path_parameter);
  const PathFrame f = path_frame_at(work, detail.path_parameter, work.frame_a);
  work.from_a += anchor_offset;
  JointRows& rows = *work.rows;
  rows.count = 0;
  const Vec3 off = rotate(work.frame_a, local - f.position);
  add_row(rows, point_row(work, f.axes.y, dot(off, f.axes.y)));
  add_row(rows, point_row(work, f.axes.z, dot(off, f.axes.z)));
  work.axis = f.axes.x;
  work.error = off;
  work.free_offset = anchor_offset - off;
  if (detail.path_orientation != PathOrientation::free) {
    const Vec3 error = path_rotation_error(detail, {anchor_offset, {}, work.frame_a, work.frame_b}, f);
    const bool follows = detail.path_orientation == PathOrientation::following;
    for (const Vec3 axis : {f.axes.x, f.axes.y, f.axes.z}) {
      JointRow row = angular_row(axis, dot(axis, error));
      if (follows) {
        row.direction = -dot(axis, f.bending) * f.axes.x;
        row.angular_a += cross(work.from_a, row.direction);
        row.angular_b += cross(work.from_b, row.direction);
      }
      add_row(rows, row);
    }
  }
  work.position = joint.position = path_length(curve, detail.path_parameter) - detail.start;
  detail.axes[0].position = work.position;
  for (AxisConstraint& x : work.axes)
    prepare_axis_row(x, point_axis(work, f.axes.x), work.position, pair, settings);
}

// ---------------------------------------------------------------------------------------------------------------- rows

void measure_rows(const JointRecord& joint, const JointConstraint& work, const RowPose& pose,
                  float (&errors)[kJointAxisCount]) {
  const JointDetail& detail = *work.detail;
  const JointRows& rows = *work.rows;
  switch (joint.kind) {
    case JointKind::gear:
      errors[0] = gear_error(detail, pose);
      return;
    case JointKind::rack_and_pinion:
      errors[0] = rack_error(detail, pose);
      return;
    case JointKind::path: {
      const Vec3 local = rotate_inverse(pose.frame_a, pose.anchor_offset);
      const PathFrame f =
          path_frame_at(work, nearest_on_path(curve_of(work), local, detail.path_parameter), pose.frame_a);
      const Vec3 off = rotate(pose.frame_a, local - f.position);
      errors[0] = dot(off, f.axes.y);
      errors[1] = dot(off, f.axes.z);
      if (rows.count == 2) return;
      const Vec3 rotation = path_rotation_error(detail, pose, f);
      errors[2] = dot(rotation, f.axes.x), errors[3] = dot(rotation, f.axes.y),
      errors[4] = dot(rotation, f.axes.z);
      return;
    }
    default:
      break;
  }
  const Mat3 frame = to_matrix(pose.frame_a);
  const Vec3 linear[3] = {frame.x, frame.y, frame.z};
  int n = 0;
  for (int i = 0; i < 3; ++i) {
    if (is_locked(detail, i))
      errors[n++] = dot(pose.anchor_offset, linear[i]) - detail.axes[i].locked_position;
  }
  // Errors along the axes of the present rows, so that they match the linear rows.
  const Cardan now = cardan_of(work.frame_a, work.frame_b), later = cardan_of(pose.frame_a, pose.frame_b);
  const Vec3 rotation = locked_rotation_error(detail, later, now.axes);
  for (; n < rows.count; ++n) errors[n] = dot(rows.rows[n].angular_a, rotation);
}

void prepare_rows(JointRows& rows, const JointPair& pair) {
  const float inverse_mass = pair.inverse_mass_a() + pair.inverse_mass_b();
  const int n = rows.count;
  for (int i = 0; i < n; ++i) {
    const JointRow& row = rows.rows[i];
    const Vec3 spin_a = pair.inverse_inertia_a() * row.angular_a,
               spin_b = pair.inverse_inertia_b() * row.angular_b;
    for (int j = 0; j <= i; ++j) {
      const JointRow& other = rows.rows[j];
      rows.factors[i * n + j] = double(inverse_mass * dot(row.direction, other.direction) +
                                       dot(spin_a, other.angular_a) + dot(spin_b, other.angular_b));
    }
  }
  factor_ldlt(std::span<double>(rows.factors, std::size_t(n * n)), n);
}

void apply_row_impulse(const JointRow& row, float impulse, JointPair& pair) {
  apply_axis_impulse({row.direction, row.direction, row.angular_a, row.angular_b}, impulse, pair);
}

void warm_start_rows(const JointRows& rows, const JointDetail& detail, JointPair& pair) {
  for (int i = 0; i < rows.count; ++i) apply_row_impulse(rows.rows[i], detail.row_impulses[i], pair);
}

void iterate_rows(JointRecord& joint, const JointConstraint& work, JointPair& pair,
                  const JointSettings& settings, bool soft) {
  const JointRows& rows = *work.rows;
  JointDetail& detail = *work.detail;
  const std::size_t n = std::size_t(rows.count);
  const Softness& s = settings.softness;
  const bool has_bias = soft && joint.kind != JointKind::gear && joint.kind != JointKind::rack_and_pinion;
  double x[kJointAxisCount];
  for (int i = 0; i < rows.count; ++i) {
    const JointRow& row = rows.rows[i];
    float speed = axis_speed({row.direction, row.direction, row.angular_a, row.angular_b}, pair);
    if (has_bias) speed += dot(row.direction, work.second_order_bias);
    x[i] = double(soft ? speed + s.bias_rate * clamped_error(row) : speed);
  }
  solve_ldlt(std::span<const double>(rows.factors, n * n), rows.count, std::span<double>(x, n));
  for (int i = 0; i < rows.count; ++i) {
    const float change =
        soft ? -s.mass_scale * float(x[i]) - s.impulse_scale * detail.row_impulses[i] : -float(x[i]);
    apply_row_impulse(rows.rows[i], change, pair);
    detail.row_impulses[i] += change;
  }
}

void sum_row_impulses(JointRecord& joint, const JointConstraint& work) {
  joint.linear_impulse = joint.angular_impulse = {};
  for (int i = 0; i < work.rows->count; ++i) {
    const JointRow& row = work.rows->rows[i];
    const float impulse = work.detail->row_impulses[i];
    joint.linear_impulse += impulse * row.direction;
    joint.angular_impulse += impulse * (row.angular_b - cross(work.from_b, row.direction));
  }
}

}  // namespace gyre
