// One axis of a joint: a row along or about a free direction, and everything that may act there: a Hooke
// spring, a motor, dry friction, and a hard or soft limit at either end. Hinges, sliders, ropes, rods and
// springs have one such axis, other kinds up to six.
#pragma once

#include "solver/joint/joint_record.h"
#include "solver/core/softness.h"

#include <cstdint>
#include <span>

namespace gyre {

class JointPair;
struct JointSettings;

// The speed along the row is linear_b . v_b + angular_b . w_b - linear_a . v_a - angular_a . w_a.
struct AxisRow {
  Vec3 linear_a, linear_b;
  Vec3 angular_a, angular_b;
};

// A spring over a sub-step: v' = retained v + load_share (other changes of v) - return_rate x. See
// make_spring().
struct SpringStep {
  float retained = 1.0f;
  float load_share = 1.0f;
  float return_rate = 0.0f;  // 1/s
  Softness implicit;         // used if the sub-step does not resolve the spring
  bool is_implicit = false;
};

struct AxisConstraint {
  JointAxisRecord axis;  // settings and impulses; written back into the joint after the step
  JointAxis index = JointAxis::linear_x;
  bool has_low = false, has_high = false;
  bool in_articulation =
      false;  // solved with the equations of its articulation (solver/articulation/articulation_drives.h)
  bool is_rod = false;      // an equation at limits.low, its impulse in low_impulse
  double drive_work = 0.0;  // J since the step began, by all but hard limits; only for axes in an
                            // articulation
  float slack = 0.0f;       // distance by which both limits are moved outwards
  AxisRow row;
  float mass = 0.0f;          // effective
  float second_order_bias = 0.0f;  // m/s: change of the position in the sub-step beyond the linear row
  float speed_before = 0.0f;       // as the half step began, before forces
  SpringStep spring;
  Softness drive, limit_softness;
};

inline bool has_spring(const JointAxisRecord& axis) { return axis.stiffness > 0.0f || axis.damping > 0.0f; }
// True if anything acts on an axis that is not locked.
inline bool is_active(const JointAxisRecord& axis) {
  return axis.motion == AxisMotion::limited || axis.motor_force > 0.0f || axis.friction > 0.0f ||
         has_spring(axis);
}

// Distance to the limits.
inline float low_gap(const AxisConstraint& x) { return x.axis.position - x.axis.limits.low + x.slack; }
inline float high_gap(const AxisConstraint& x) { return x.axis.limits.high - x.axis.position + x.slack; }

float axis_speed(const AxisRow& row, const JointPair& pair);
void apply_axis_impulse(const AxisRow& row, float impulse, JointPair& pair);
// Sum of all impulses along the axis.
float axis_impulse(const JointAxisRecord& axis);

// Prepares the axis from its row and position, as if the two bodies were alone.
void prepare_axis(AxisConstraint& axis, const JointPair& pair, const JointSettings& settings);
// Prepares what depends on the effective mass.
void prepare_axis_mass(AxisConstraint& axis, float mass, const JointSettings& settings);
void solve_axis(AxisConstraint& axis, JointPair& pair, const JointSettings& settings, bool soft);
// Solves an axis with `speed` along its row that changes by k for an impulse of one. Returns the total
// impulse.
float solve_axis(AxisConstraint& axis, float speed, float k, const JointSettings& settings, bool soft);

}  // namespace gyre
