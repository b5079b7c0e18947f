#include "solver/joint/pose_drive.h"

#include "solver/joint/joint_blocks.h"

namespace gyre {

namespace {

// The change of an impulse that brings `speed` to its target, within a ball of radius `max_impulse`.
Vec3 drive_change(const Mat3& mass, Vec3 speed, Vec3 error, Vec3 impulse, const Softness& s,
                  float max_impulse) {
  const Vec3 target_impulse =
      impulse - s.mass_scale * (mass * (speed + s.bias_rate * error)) - s.impulse_scale * impulse;
  return clamp_length(target_impulse, max_impulse) - impulse;
}

}  // namespace

bool has_drive(const JointDetail& detail) {
  return detail.drive.max_force > 0.0f || detail.drive.max_torque > 0.0f || detail.friction > 0.0f;
}

void prepare_drive(const JointConstraint& work, const JointPair& pair, const JointSettings& settings) {
  const PoseDrive& drive = work.detail->drive;
  DriveConstraint& d = *work.drive;
  d.softness = drive.frequency > 0.0f ? make_softness(drive.frequency, drive.damping_ratio, settings.substep)
                                      : settings.softness;
  if (drive.max_force > 0.0f) {
    d.from_a = work.from_a + work.error;
    d.linear_error = work.error - rotate(work.frame_a, drive.position);
    d.target_velocity = rotate(work.frame_a, drive.linear_velocity);
    d.linear_mass = inverse(point_matrix(pair, d.from_a, work.from_b));
  }
  const Quat target = work.frame_a * normalized(drive.orientation);
  d.angular_error = to_rotation_vector(work.frame_b * conjugate(target));
  d.target_angular_velocity = rotate(work.frame_a, drive.angular_velocity);
  d.angular_mass = to_matrix(inverse(pair.inverse_inertia_a() + pair.inverse_inertia_b()));
}

void warm_start_drive(const JointConstraint& work, JointPair& pair) {
  const JointDetail& detail = *work.detail;
  if (detail.drive.max_force > 0.0f)
    pair.apply_impulse(detail.drive_force_impulse, work.drive->from_a, work.from_b);
  pair.apply_angular_impulse(detail.drive_torque_impulse + detail.friction_impulse);
}

void solve_drive(const JointConstraint& work, JointPair& pair, const JointSettings& settings) {
  JointDetail& detail = *work.detail;
  const DriveConstraint& d = *work.drive;
  const float h = settings.substep;
  if (detail.drive.max_torque > 0.0f && !settings.keeps_motors) {
    const Vec3 change =
        drive_change(d.angular_mass, pair.relative_spin() - d.target_angular_velocity, d.angular_error,
                     detail.drive_torque_impulse, d.softness, detail.drive.max_torque * h);
    pair.apply_angular_impulse(change);
    detail.drive_torque_impulse += change;
  }
  if (detail.friction > 0.0f) {
    const Vec3 change = drive_change(d.angular_mass, pair.relative_spin(), {}, detail.friction_impulse, {},
                                     detail.friction * h);
    pair.apply_angular_impulse(change);
    detail.friction_impulse += change;
  }
  if (detail.drive.max_force > 0.0f && !settings.keeps_motors) {
    const Vec3 speed = pair.point_velocity(d.from_a, work.from_b) - d.target_velocity;
    const Vec3 change = drive_change(d.linear_mass, speed, d.linear_error, detail.drive_force_impulse,
                                     d.softness, detail.drive.max_force * h);
    pair.apply_impulse(change, d.from_a, work.from_b);
    detail.drive_force_impulse += change;
  }
}

void accumulate_drive(JointRecord& joint, const JointDetail& detail) {
  joint.total_linear += detail.drive_force_impulse;
  joint.total_angular += detail.drive_torque_impulse + detail.friction_impulse;
}

}  // namespace gyre
