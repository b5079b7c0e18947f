#include "solver/joint.h"

#include "math/trig.h"
#include "solver/joint_blocks.h"

namespace gyre {

namespace {

Quat orientation_of(std::int32_t body, const JointBodies& bodies) {
  return body == kNoBody ? Quat{} : bodies.orientation[body];
}

// How far the anchors part in h by the turning of their arms and of the slide, over h: what the rows, being linear, do not
// see. Asking the rows for the opposite makes the end of the sub-step, not its beginning, meet the joint, as in SHAKE
// (J.-P. Ryckaert, G. Ciccotti, H. Berendsen, 1977); with the rows taken anew before velocities relax (RATTLE: H. Andersen,
// 1983) a swinging pendulum keeps its energy.
Vec3 bend_of(const JointPair& pair, const JointWork& work, bool slides, float h) {
  Vec3 bend = cross(pair.angular_b, cross(pair.angular_b, work.from_b)) -
              cross(pair.angular_a, cross(pair.angular_a, work.from_a));
  if (slides) bend -= 2.0f * cross(pair.angular_a, pair.point_velocity(work.from_a, work.from_b));
  return 0.5f * h * bend;
}

// Coefficients of a spring row for one sub-step.
//
// As long as the sub-step resolves the spring (omega h <= 1) the explicit kick gets the stiffness and damping with which
// kick and drift together have exactly the eigenvalues of the continuous oscillator: det = exp(-2 zeta omega h), trace =
// 2 exp(-zeta omega h) cos(omega_d h). An undamped spring then keeps its amplitude for ever and its period exactly. Faster
// springs are implicit: stable at any stiffness.
void prepare_spring(const JointRecord& joint, JointWork& work, float displacement, const JointSettings& settings) {
  const double h = double(settings.substep);
  const double mass = double(work.axis_mass);
  if (!(mass > 0.0)) return;
  const double omega = std::sqrt(double(joint.stiffness) / mass);
  const double decay = 0.5 * double(joint.damping) / mass;  // zeta omega
  work.spring_is_stiff = omega * h > 1.0 || decay * h > 1.0;
  if (work.spring_is_stiff) {
    const double damping_ratio = omega > 0.0 ? decay / omega : 0.0;
    work.spring = make_softness(float(omega / (2.0 * kPiDouble)), float(damping_ratio), settings.substep);
    if (!(omega > 0.0)) {
      // A pure damper, implicitly: J = -h c v'.
      const double give = 1.0 / (1.0 + 2.0 * decay * h);
      work.spring = {0.0f, float(1.0 - give), float(give)};
    }
    work.spring_position = displacement;
    return;
  }
  const double e1 = exp(-decay * h);
  const double e2 = e1 * e1;
  const double square_d = omega * omega - decay * decay;
  const double angle = std::sqrt(square_d < 0.0 ? -square_d : square_d) * h;
  const double c = square_d < 0.0 ? 0.5 * (exp(angle) + exp(-angle)) : sin_cos(angle).cos;
  work.spring_damping = float(1.0 - e2);
  work.spring_position = float((1.0 + e2 - 2.0 * e1 * c) / h) * displacement;
}

void prepare_ball(const JointPair& pair, JointWork& work) {
  work.linear_mass = inverse(point_matrix(pair, work.from_a, work.from_b));
}

bool has_axis_rows(const JointRecord& joint) {
  return (joint.kind == JointKind::hinge || joint.kind == JointKind::slider) &&
         (joint.motor_force > 0.0f || joint.has_limits);
}

void prepare_hinge(JointRecord& joint, const JointPair& pair, JointWork& work, Quat frame_a, Quat frame_b,
                   bool swept) {
  const Mat3 axes_a = to_matrix(frame_a);
  const Vec3 axis_b = rotate(frame_b, {1, 0, 0});
  work.axis = axes_a.x;
  work.perpendicular_1 = axes_a.y;
  work.perpendicular_2 = axes_a.z;
  work.angular_error = cross(work.axis, axis_b);
  if (swept) {
    prepare_ball(pair, work);
    const Mat3 k = to_matrix(pair.inverse_inertia_a()) + to_matrix(pair.inverse_inertia_b());
    work.angular_mass = inverse_in_plane(k, work.perpendicular_1, work.perpendicular_2);
  }
  if (has_axis_rows(joint)) work.axis_mass = inverse_or_zero(turn_matrix(pair, work.axis));
  // The twist of b's frame in a's, unwrapped by staying near the last value.
  const Quat twist = conjugate(frame_a) * frame_b;
  const float angle = 2.0f * atan2(twist.x, twist.w);
  const float turns = (joint.position - angle) / (2.0f * kPi);
  work.position = joint.position = angle + 2.0f * kPi * std::floor(turns + 0.5f);
}

void prepare_slider(JointRecord& joint, const JointPair& pair, JointWork& work, Quat frame_a, Quat frame_b,
                    bool swept) {
  const Mat3 axes_a = to_matrix(frame_a);
  work.axis = axes_a.x;
  work.perpendicular_1 = axes_a.y;
  work.perpendicular_2 = axes_a.z;
  work.position = joint.position = dot(work.error, work.axis);
  // The rows act at b's anchor: the arm of a reaches to where b's anchor is now.
  work.from_a += work.error;
  work.error -= work.position * work.axis;
  work.angular_error = to_rotation_vector(frame_b * conjugate(frame_a));
  if (swept) {
    const Mat3 k = point_matrix(pair, work.from_a, work.from_b);
    work.linear_mass = inverse_in_plane(k, work.perpendicular_1, work.perpendicular_2);
    work.angular_mass = to_matrix(inverse(pair.inverse_inertia_a() + pair.inverse_inertia_b()));
  }
  if (has_axis_rows(joint))
    work.axis_mass = inverse_or_zero(axis_matrix(pair, work.axis, work.from_a, work.from_b));
}

void prepare_fixed(const JointPair& pair, JointWork& work, Quat frame_a, Quat frame_b, bool swept) {
  work.angular_error = to_rotation_vector(frame_b * conjugate(frame_a));
  if (!swept) return;
  prepare_ball(pair, work);
  work.angular_mass = to_matrix(inverse(pair.inverse_inertia_a() + pair.inverse_inertia_b()));
}

void prepare_distance(JointRecord& joint, const JointPair& pair, JointWork& work, const JointSettings& settings) {
  const float distance = length(work.error);
  work.axis = normalized(work.error, rotate({}, {0, 1, 0}));
  work.position = joint.position = distance;
  work.axis_mass = inverse_or_zero(axis_matrix(pair, work.axis, work.from_a, work.from_b));
  if (joint.is_spring) prepare_spring(joint, work, distance - joint.rest_length, settings);
}

// Limits and motor along (slider) or about (hinge) the axis.
void solve_axis(JointRecord& joint, const JointWork& work, JointPair& pair, const JointSettings& settings, bool soft) {
  const bool turns = joint.kind == JointKind::hinge;
  const auto speed = [&] {
    return turns ? dot(pair.turning(), work.axis) : dot(pair.point_velocity(work.from_a, work.from_b), work.axis);
  };
  const auto apply = [&](float impulse) {
    if (turns) {
      pair.turn(impulse * work.axis);
    } else {
      pair.push(impulse * work.axis, work.from_a, work.from_b);
    }
  };
  if (joint.motor_force > 0.0f) {
    float wanted = 0.0f;
    if (joint.has_motor_target) {
      const float error = work.position - joint.motor_position;
      const Softness drive = joint.motor_frequency > 0.0f
                                 ? make_softness(joint.motor_frequency, joint.motor_damping, settings.substep)
                                 : settings.softness;
      const float closing = speed() - joint.motor_velocity + drive.bias_rate * error;
      wanted = joint.motor_impulse - drive.mass_scale * work.axis_mass * closing - drive.impulse_scale * joint.motor_impulse;
    } else {
      wanted = joint.motor_impulse - work.axis_mass * (speed() - joint.motor_velocity);
    }
    const float most = joint.motor_force * settings.substep;
    const float next = clamp(wanted, -most, most);
    apply(next - joint.motor_impulse);
    joint.motor_impulse = next;
  }
  if (joint.has_limits) {
    const float low = stop_change(work.axis_mass, speed(), work.position - joint.limits.low, joint.low_impulse, settings, soft);
    apply(low);
    joint.low_impulse += low;
    const float high = stop_change(work.axis_mass, -speed(), joint.limits.high - work.position, joint.high_impulse,
                                   settings, soft);
    apply(-high);
    joint.high_impulse += high;
  }
}

void solve_distance(JointRecord& joint, const JointWork& work, JointPair& pair, const JointSettings& settings, bool soft) {
  const float bend = soft ? work.axis_bend : 0.0f;
  const auto speed = [&] { return dot(pair.point_velocity(work.from_a, work.from_b), work.axis) + bend; };
  const auto apply = [&](float impulse) { pair.push(impulse * work.axis, work.from_a, work.from_b); };
  if (joint.is_spring && soft) {
    float next = 0.0f;
    if (work.spring_is_stiff) {
      next = joint.spring_impulse -
             work.spring.mass_scale * work.axis_mass * (speed() + work.spring.bias_rate * work.spring_position) -
             work.spring.impulse_scale * joint.spring_impulse;
    } else {
      const float before = work.axis_mass * speed() - joint.spring_impulse;  // momentum without this spring's impulse
      next = -work.axis_mass * work.spring_position - work.spring_damping * before;
    }
    apply(next - joint.spring_impulse);
    joint.spring_impulse = next;
  }
  if (joint.min_length == joint.max_length) {
    // A rod: one two-sided row, kept in low_impulse (positive pushes apart).
    const float error = work.position - joint.min_length;
    float change = -work.axis_mass * speed();
    if (soft) {
      const Softness& s = settings.softness;
      change = -s.mass_scale * work.axis_mass * (speed() + s.bias_rate * error) -
               s.impulse_scale * joint.low_impulse;
    }
    apply(change);
    joint.low_impulse += change;
    return;
  }
  if (joint.min_length > 0.0f) {
    const float low = stop_change(work.axis_mass, speed(), work.position - joint.min_length, joint.low_impulse, settings, soft);
    apply(low);
    joint.low_impulse += low;
  }
  if (joint.max_length < kUnlimitedLength) {
    const float high = stop_change(work.axis_mass, -speed(), joint.max_length - work.position, joint.high_impulse,
                                   settings, soft);
    apply(-high);
    joint.high_impulse += high;
  }
}

void solve_turn_rows(JointRecord& joint, const JointWork& work, JointPair& pair, const JointSettings& settings, bool soft) {
  const Vec3 change = row_change(work.angular_mass, pair.turning(), work.angular_error, joint.angular_impulse,
                                 settings.softness, soft);
  pair.turn(change);
  joint.angular_impulse += change;
}

void solve_point_rows(JointRecord& joint, const JointWork& work, JointPair& pair, const JointSettings& settings, bool soft) {
  const Vec3 speed = pair.point_velocity(work.from_a, work.from_b) + (soft ? work.bend : Vec3{});
  const Vec3 change = row_change(work.linear_mass, speed, work.error, joint.linear_impulse, settings.softness, soft);
  pair.push(change, work.from_a, work.from_b);
  joint.linear_impulse += change;
}

// Impulse along the axis by limits, motor and spring together (on B).
float axis_impulse(const JointRecord& joint) {
  return joint.low_impulse - joint.high_impulse + joint.motor_impulse + joint.spring_impulse;
}

}  // namespace

void forget_impulses(JointRecord& joint) {
  joint.linear_impulse = joint.angular_impulse = {};
  joint.low_impulse = joint.high_impulse = joint.motor_impulse = joint.spring_impulse = 0.0f;
  joint.position = 0.0f;
  joint.total_linear = joint.total_angular = {};
}

void begin_joint(JointRecord& joint, JointWork& work, float warm_scale) {
  joint.linear_impulse *= warm_scale;
  joint.angular_impulse *= warm_scale;
  joint.low_impulse *= warm_scale;
  joint.high_impulse *= warm_scale;
  joint.motor_impulse *= warm_scale;
  joint.spring_impulse *= warm_scale;
  joint.total_linear = {};
  joint.total_angular = {};
  work = {};
}

void place_joint(JointRecord& joint, JointWork& work, const JointPlaces& places, const JointBodies& bodies,
                 const JointSettings& settings) {
  const JointPair pair(joint, bodies);
  const Quat orientation_a = orientation_of(joint.body_a, bodies);
  const Quat orientation_b = orientation_of(joint.body_b, bodies);
  work.from_a = rotate(orientation_a, joint.local_anchor_a);
  work.from_b = rotate(orientation_b, joint.local_anchor_b);
  work.error = places.offset + pair.moved() + work.from_b - work.from_a;
  const Quat frame_a = orientation_a * joint.local_frame_a;
  const Quat frame_b = orientation_b * joint.local_frame_b;
  switch (joint.kind) {
    case JointKind::ball:
      if (settings.swept) prepare_ball(pair, work);
      break;
    case JointKind::hinge:
      prepare_hinge(joint, pair, work, frame_a, frame_b, settings.swept);
      break;
    case JointKind::slider:
      prepare_slider(joint, pair, work, frame_a, frame_b, settings.swept);
      break;
    case JointKind::fixed:
      prepare_fixed(pair, work, frame_a, frame_b, settings.swept);
      break;
    case JointKind::distance:
      prepare_distance(joint, pair, work, settings);
      break;
  }
}

void bend_joint(const JointRecord& joint, JointWork& work, const JointBodies& bodies,
                const JointSettings& settings) {
  const JointPair pair(joint, bodies);
  work.bend = bend_of(pair, work, joint.kind == JointKind::slider, settings.substep);
  if (joint.kind != JointKind::distance) return;
  const Vec3 speed = pair.point_velocity(work.from_a, work.from_b);
  const Vec3 across = speed - dot(speed, work.axis) * work.axis;
  const float distance = work.position;
  work.axis_bend = dot(work.bend, work.axis) +
                   (distance > 0.0f ? 0.5f * settings.substep * length_squared(across) / distance : 0.0f);
}

void warm_start_joint(const JointRecord& joint, const JointWork& work, const JointBodies& bodies) {
  JointPair pair(joint, bodies);
  const float along = axis_impulse(joint);
  if (joint.kind == JointKind::hinge) {
    pair.push(joint.linear_impulse, work.from_a, work.from_b);
    pair.turn(joint.angular_impulse + along * work.axis);
  } else {
    pair.push(joint.linear_impulse + along * work.axis, work.from_a, work.from_b);
    pair.turn(joint.angular_impulse);
  }
  pair.store();
}

void solve_joint(JointRecord& joint, const JointWork& work, const JointBodies& bodies, const JointSettings& settings,
                 bool soft) {
  JointPair pair(joint, bodies);
  switch (joint.kind) {
    case JointKind::ball: solve_point_rows(joint, work, pair, settings, soft); break;
    case JointKind::hinge:
      solve_axis(joint, work, pair, settings, soft);
      solve_turn_rows(joint, work, pair, settings, soft);
      solve_point_rows(joint, work, pair, settings, soft);
      break;
    case JointKind::slider:
      solve_axis(joint, work, pair, settings, soft);
      solve_turn_rows(joint, work, pair, settings, soft);
      solve_point_rows(joint, work, pair, settings, soft);
      break;
    case JointKind::fixed:
      solve_turn_rows(joint, work, pair, settings, soft);
      solve_point_rows(joint, work, pair, settings, soft);
      break;
    case JointKind::distance: solve_distance(joint, work, pair, settings, soft); break;
  }
  pair.store();
}

void warm_start_joint_axis(const JointRecord& joint, const JointWork& work, const JointBodies& bodies) {
  if (!has_axis_rows(joint)) return;
  JointPair pair(joint, bodies);
  const Vec3 along = axis_impulse(joint) * work.axis;
  if (joint.kind == JointKind::hinge) {
    pair.turn(along);
  } else {
    pair.push(along, work.from_a, work.from_b);
  }
  pair.store();
}

void solve_joint_axis(JointRecord& joint, const JointWork& work, const JointBodies& bodies,
                      const JointSettings& settings, bool soft) {
  if (!has_axis_rows(joint)) return;
  JointPair pair(joint, bodies);
  solve_axis(joint, work, pair, settings, soft);
  pair.store();
}

void sum_joint(JointRecord& joint, const JointWork& work) {
  const float along = axis_impulse(joint);
  if (joint.kind == JointKind::hinge) {
    joint.total_linear += joint.linear_impulse;
    joint.total_angular += joint.angular_impulse + along * work.axis;
  } else {
    joint.total_linear += joint.linear_impulse + along * work.axis;
    joint.total_angular += joint.angular_impulse;
  }
}

}  // namespace gyre
