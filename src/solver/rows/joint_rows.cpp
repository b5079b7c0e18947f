// Rows of joints; rows of contacts are in contact_rows.cpp.
#include "solver/rows/constraint_rows.h"
#include "solver/rows/constraint_rows_common.h"
#include "solver/joint/pose_drive.h"
#include "solver/joint/joint_equations.h"

namespace gyre {

namespace {

constexpr Vec3 kWorldAxes[3] = {{1, 0, 0}, {0, 1, 0}, {0, 0, 1}};

void set_axis(Row& row, const AxisRow& axis, float sign) {
  const double s = double(sign);
  row.linear_a = -s * DVec3(axis.linear_a), row.angular_a = -s * DVec3(axis.angular_a);
  row.linear_b = s * DVec3(axis.linear_b), row.angular_b = s * DVec3(axis.angular_b);
}

// Completes a soft row: its compliance is that of the implicit spring and damper of the softness.
void end_soft_row(Row& row, const JointRecord& joint, const Softness& soft, const RowFrame& frame) {
  end_row(row, joint.body_a, joint.body_b, frame);
  if (!(soft.mass_scale > 0.0f)) return;
  row.compliance = row.diagonal * double(soft.impulse_scale) / double(soft.mass_scale);
  row.diagonal += row.compliance;
}

int equations_of(const JointRecord& joint, const JointConstraint& work) {
  return count_equations(joint, work.detail);
}

// rad. Bodies that rotate further than this in a sub-step get less of the second-order bias. Articulations
// fade it from kMaxBiasAngle on.
constexpr double kMaxBiasRotation = 0.15;

float bias_fade(const JointRecord& joint, const RowFrame& frame) {
  double fastest = 0.0;
  for (const std::int32_t body : {joint.body_a, joint.body_b}) {
    if (body != kNoBody) fastest = max(fastest, length_squared(DVec3(frame.motion[body].angular_velocity)));
  }
  fastest *= square(frame.substep);
  return fastest > square(kMaxBiasRotation) ? float(square(kMaxBiasRotation) / fastest) : 1.0f;
}

void add_equations(JointRecord& joint, JointConstraint& work, const RowFrame& frame, float rate,
                   bool in_motion, RowList& list) {
  if (equations_of(joint, work) == 0) return;
  JointEquations node;
  make_equations(node, joint, work);
  const float share = bias_fade(joint, frame);
  const bool has_bias = joint.kind != JointKind::gear && joint.kind != JointKind::rack_and_pinion;
  for (int i = 0; i < node.count; ++i) {
    const JointEquation& from = node.rows[i];
    Row& row = begin_row(list);
    if (i == 0) row.block = node.count;
    row.linear_a = -DVec3(from.direction), row.angular_a = -DVec3(from.angular_a);
    row.linear_b = DVec3(from.direction), row.angular_b = DVec3(from.angular_b);
    if (in_motion) {
      const float second_order_bias = joint.kind == JointKind::distance
                                          ? work.axes[0].second_order_bias
                                          : dot(from.direction, work.second_order_bias);
      row.target_speed = -double(rate * error_of(joint, work, from, i)) -
                         (has_bias ? double(share * second_order_bias) : 0.0);
      row.impulse = double(accumulated_impulse(joint, work, from, i));
    }
    end_row(row, joint.body_a, joint.body_b, frame, !in_motion);
  }
}

// The rows of one axis of a joint.
class AxisRows {
 public:
  AxisRows(const JointRecord& joint, AxisConstraint& work, const JointSettings& settings,
           const RowFrame& frame, RowList& list)
      : joint_(joint), x_(work), settings_(settings), frame_(frame), list_(list) {}

  void add_all() {
    JointAxisRecord& axis = x_.axis;
    if (!(x_.mass > 0.0f)) return;
    if (has_spring(axis)) add_spring();
    if (axis.motor_force > 0.0f) add_motor();
    if (axis.friction > 0.0f) {
      Row& row = begin(axis.friction_impulse, 1.0f);
      bound(row, axis.friction);
      end_row(row, joint_.body_a, joint_.body_b, frame_);
    }
    if (x_.is_rod) return;  // an equation
    if (x_.slack > 0.0f) {  // no rows for limits out of reach
      axis.low_impulse = axis.high_impulse = 0.0f;
      return;
    }
    const bool is_angular = x_.row.linear_b == Vec3{} && x_.row.linear_a == Vec3{};
    const float lowest = is_angular ? -kMaxLimitError : -1.0e30f;
    if (x_.has_low) add_limit(axis.low_impulse, max(low_gap(x_), lowest), 1.0f);
    if (x_.has_high) add_limit(axis.high_impulse, max(high_gap(x_), lowest), -1.0f);
  }

 private:
  Row& begin(float& impulse, float sign) {
    Row& row = begin_row(list_);
    list_.stored[list_.count - 1] = &impulse;
    set_axis(row, x_.row, sign);
    row.target_speed = -double(sign * x_.second_order_bias);
    row.impulse = double(impulse);
    return row;
  }
  void bound(Row& row, float force) const {
    row.limits.high = double(force) * frame_.substep;
    row.limits.low = -row.limits.high;
  }

  void add_spring() {
    JointAxisRecord& axis = x_.axis;
    const float displacement = axis.position - axis.rest_position;
    if (x_.spring.is_implicit) {
      Row& row = begin(axis.spring_impulse, 1.0f);
      row.target_speed -= double(x_.spring.implicit.bias_rate * displacement);
      end_soft_row(row, joint_, x_.spring.implicit, frame_);
      return;
    }
    Row row;
    set_axis(row, x_.row, 1.0f);
    end_row(row, joint_.body_a, joint_.body_b, frame_);
    const double speed = row_speed(row, frame_.bodies) - row.target_speed, before = double(x_.speed_before);
    const double target = double(x_.spring.retained) * before +
                          double(x_.spring.load_share) * (speed - before) -
                          double(x_.spring.return_rate) * double(displacement);
    axis.spring_impulse = float(double(x_.mass) * (target - speed));
    apply_row_impulse(row, double(axis.spring_impulse), frame_.bodies);
  }
  void add_motor() {
    JointAxisRecord& axis = x_.axis;
    Row& row = begin(axis.motor_impulse, 1.0f);
    bound(row, axis.motor_force);
    row.target_speed += double(axis.motor_velocity);
    if (!axis.has_motor_target) return end_row(row, joint_.body_a, joint_.body_b, frame_);
    row.target_speed -= double(x_.drive.bias_rate * (axis.position - axis.motor_position));
    end_soft_row(row, joint_, x_.drive, frame_);
  }
  // A limit at distance `gap`; a soft one acts once it is reached.
  void add_limit(float& impulse, float gap, float sign) {
    const bool is_soft = x_.axis.limit_frequency > 0.0f;
    if (is_soft && gap > 0.0f) {
      impulse = 0.0f;
      return;
    }
    Row& row = begin(impulse, sign);
    row.limits.low = 0.0;
    const double rate = gap > 0.0f
                            ? 1.0 / frame_.substep
                            : double(is_soft ? x_.limit_softness.bias_rate : settings_.softness.bias_rate);
    row.target_speed -= rate * double(gap);
    if (is_soft) return end_soft_row(row, joint_, x_.limit_softness, frame_);
    end_row(row, joint_.body_a, joint_.body_b, frame_);
  }

  const JointRecord& joint_;
  AxisConstraint& x_;
  const JointSettings& settings_;
  const RowFrame& frame_;
  RowList& list_;
};

void add_drive_rows(const JointRecord& joint, const JointConstraint& work, const RowFrame& frame,
                    RowList& list) {
  JointDetail& detail = *work.detail;
  const DriveConstraint& d = *work.drive;
  const auto add = [&](float& impulse, Vec3 axis, bool is_angular, float force, float target_speed,
                       const Softness& soft) {
    Row& row = begin_row(list);
    list.stored[list.count - 1] = &impulse;
    AxisRow along{{}, {}, axis, axis};
    if (!is_angular) along = {axis, axis, cross(d.from_a, axis), cross(work.from_b, axis)};
    set_axis(row, along, 1.0f);
    row.impulse = double(impulse);
    row.limits.high = double(force) * frame.substep;
    row.limits.low = -row.limits.high;
    row.target_speed = double(target_speed);
    end_soft_row(row, joint, soft, frame);
  };
  const auto add_three = [&](Vec3& impulse, bool is_angular, float force, Vec3 target_speed,
                             const Softness& soft) {
    if (!(force > 0.0f)) return;
    add(impulse.x, kWorldAxes[0], is_angular, force, target_speed.x, soft);
    add(impulse.y, kWorldAxes[1], is_angular, force, target_speed.y, soft);
    add(impulse.z, kWorldAxes[2], is_angular, force, target_speed.z, soft);
  };
  const float rate = d.softness.bias_rate;
  add_three(detail.drive_torque_impulse, true, detail.drive.max_torque,
            d.target_angular_velocity - rate * d.angular_error, d.softness);
  add_three(detail.friction_impulse, true, detail.friction, {}, {});
  add_three(detail.drive_force_impulse, false, detail.drive.max_force,
            d.target_velocity - rate * d.linear_error, d.softness);
}

}  // namespace

int count_joint_rows(const JointRecord& joint, const JointDetail* detail, const JointConstraint& work) {
  int count = count_equations(joint, detail);
  count += 5 * int(work.axes.size());
  return count + (work.drive != nullptr ? 9 : 0);
}

void add_joint_rows(JointRecord& joint, JointConstraint& work, const JointSettings& settings,
                    const RowFrame& frame, RowList& list) {
  add_equations(joint, work, frame, settings.softness.bias_rate, true, list);
  for (AxisConstraint& axis : work.axes) AxisRows(joint, axis, settings, frame, list).add_all();
  if (work.drive != nullptr) add_drive_rows(joint, work, frame, list);
}

void add_joint_equations(JointRecord& joint, JointConstraint& work, const RowFrame& frame, RowList& list) {
  add_equations(joint, work, frame, 0.0f, false, list);
}

void store_joint_impulses(JointRecord& joint, JointConstraint& work, std::span<const Row> rows,
                          std::span<float* const> stored) {
  if (equations_of(joint, work) > 0) {
    JointEquations node;
    make_equations(node, joint, work);
    clear_equation_impulses(joint, work);
    for (int i = 0; i < node.count; ++i)
      add_impulse(joint, work, node.rows[i], i, float(rows[std::size_t(i)].impulse) + 0.0f);
  }
  for (std::size_t i = 0; i < rows.size(); ++i) {
    if (stored[i] != nullptr) *stored[i] = float(rows[i].impulse) + 0.0f;
  }
}

}  // namespace gyre
