// One axis of a joint: a single row along or about which a joint is free, and all that may act there: a Hooke spring, a motor,
// dry friction, and stops at either end, hard or soft. Hinges, sliders, ropes, rods and springs have one such axis, other kinds
// up to six; what acts is the same.
#pragma once

#include "solver/joint/joint_record.h"
#include "solver/core/softness.h"

#include <cstdint>
#include <span>

namespace gyre {

class JointPair;
struct JointSettings;

// What the row sees: push_b . v_b + arm_b . w_b - push_a . v_a - arm_a . w_a.
struct AxisRow {
  Vec3 linear_a, linear_b;
  Vec3 angular_a, angular_b;
};

// What a spring makes of a sub-step: v' = kept v + loaded (what else changed v) - returned x. See prepare_spring().
struct SpringStep {
  float retained = 1.0f;
  float load_share = 1.0f;
  float return_rate = 0.0f;  // 1/s
  Softness implicit;      // if the sub-step does not resolve the spring
  bool is_implicit = false;
};

struct AxisConstraint {
  JointAxisRecord axis;  // settings and impulses; goes back into the joint when the step is over
  JointAxis index = JointAxis::linear_x;
  bool has_low = false, has_high = false;
  bool in_articulation =
      false;  // solved with the equations of its linkage (solver/articulation/articulation_drives.h)
  bool is_rod = false;  // one two-sided stop at limits.low, its impulse in low_impulse
  double drive_work = 0.0;  // J since the step began, if it is linked: by all but hard stops
  float slack = 0.0f;   // by how much farther than the limits both stops are
  AxisRow row;
  float mass = 0.0f;          // effective
  float second_order_bias =
      0.0f;                   // m/s: how far the position changes in the sub-step beyond what the row sees
  float speed_before = 0.0f;  // as the part began, before forces
  SpringStep spring;
  Softness drive, limit_softness;
};

inline bool has_spring(const JointAxisRecord& axis) { return axis.stiffness > 0.0f || axis.damping > 0.0f; }
// Whether anything acts on an axis that is not locked.
inline bool is_active(const JointAxisRecord& axis) {
  return axis.motion == AxisMotion::limited || axis.motor_force > 0.0f || axis.friction > 0.0f ||
         has_spring(axis);
}

// How far it is to the stops.
inline float low_gap(const AxisConstraint& x) { return x.axis.position - x.axis.limits.low + x.slack; }
inline float high_gap(const AxisConstraint& x) { return x.axis.limits.high - x.axis.position + x.slack; }

float axis_speed(const AxisRow& row, const JointPair& pair);
void apply_axis_impulse(const AxisRow& row, float impulse, JointPair& pair);
// Impulse of everything along the axis together.
float axis_impulse(const JointAxisRecord& axis);

// Once the row and the position are known: as if the two bodies were alone.
void prepare_axis(AxisConstraint& axis, const JointPair& pair, const JointSettings& settings);
// What depends on the effective mass.
void prepare_axis_mass(AxisConstraint& axis, float mass, const JointSettings& settings);
void solve_axis(AxisConstraint& axis, JointPair& pair, const JointSettings& settings, bool soft);
// Where the row sees `speed` and an impulse of one changes that by k: the impulse of all that acts.
float solve_axis(AxisConstraint& axis, float speed, float k, const JointSettings& settings, bool soft);

}  // namespace gyre
