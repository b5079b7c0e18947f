// Joints in a sub-step: preparation from the persistent record, and the solve. Every kind is made of the
// blocks in joint_blocks.h.
//
// A joint has a frame on each body (origin at the anchor, x along the axis). Its error is measured with the
// orientations of the sub-step. Its rows are first solved softly, with a bias that removes the error, and
// then rigidly, for velocities only, as contacts are.
#pragma once

#include "base/arena/arena.h"
#include "solver/joint/joint_axis.h"
#include "solver/joint/joint_record.h"

namespace gyre {

// Offsets of a joint at the beginning of a step, exact at any distance from the origin.
struct JointOffsets {
  Vec3 offset;              // centre (or world anchor) of b minus that of a
  Vec3 ground_a, ground_b;  // pulley: the fixed points minus the centres of a and b
};

// The columns that joints read and write, indexed by body.
struct JointBodies {
  BodyMotion* motion = nullptr;
  const BodyInertia* inertia = nullptr;     // of this sub-step
  const Quat* orientation = nullptr;        // of this sub-step: world_from_body
};

struct JointSettings {
  float substep = 0.0f;
  Softness softness;      // of the equations of the joint
  bool iterative = true;  // false: equations and hard limits are solved by an articulation
                          // (solver/articulation/articulation.h)
  bool keeps_motors = false;  // motors and drives keep their impulses
};

// One equation of a joint, on the speed direction . (v_b - v_a) + angular_b . w_b - angular_a . w_a.
struct JointRow {
  Vec3 direction;             // of a force; zero for an angular row
  Vec3 angular_a, angular_b;  // r x direction, or the axis of an angular row
  float error = 0.0f;
};

// Equations of kinds that are not made of point and angular blocks, and their factored K.
struct JointRows {
  int count = 0;
  JointRow rows[kJointAxisCount];
  double factors[kJointAxisCount * kJointAxisCount] = {};
};

// Pose drive and friction against all rotation in a sub-step.
struct DriveConstraint {
  Vec3 linear_error, angular_error;               // world
  Vec3 target_velocity, target_angular_velocity;  // targets
  Vec3 from_a;                                    // to b's anchor
  Mat3 linear_mass, angular_mass;
  Softness softness;
};

// One joint in one sub-step. It lives in the step's arena.
struct JointConstraint {
  Vec3 from_a, from_b;       // anchors from the centres of mass, world axes
  Vec3 error;                // anchor b minus anchor a
  Vec3 second_order_bias;  // m/s: speed with which b's anchor leaves a's by rotation in the sub-step, beyond
                           // the linear rows
  Vec3 axis;               // hinge and slider: on a; distance: unit from a to b
  Vec3 perpendicular_1, perpendicular_2;
  Vec3 angular_error;        // rotation vector from a's frame to b's
  Vec3 free_offset;          // part of the anchors' offset that the joint leaves free
  Quat frame_a, frame_b;     // world_from_joint
  Mat3 linear_mass;          // inverse of K
  Mat3 angular_mass;
  float position = 0.0f;
  JointDetail* detail = nullptr;  // null if the joint has none
  std::span<const PathPoint> path{};
  std::span<AxisConstraint> axes{};
  JointRows* rows = nullptr;
  DriveConstraint* drive = nullptr;
};

// Once a step: allocates axes, rows and drive, scales impulses to the new sub-step and clears sums.
void begin_joint(JointRecord& joint, JointDetail* detail, std::span<const PathPoint> path,
                 JointConstraint& work, float warm_scale, Arena& arena);
// Prepares what depends on poses, after bodies have moved.
void prepare_joint(JointRecord& joint, JointConstraint& work, const JointOffsets& offsets,
                   const JointBodies& bodies, const JointSettings& settings);
// Computes the bias that depends on velocities, before the solve.
void update_joint_bias(const JointRecord& joint, JointConstraint& work, const JointBodies& bodies,
                const JointSettings& settings);
void warm_start_joint(const JointRecord& joint, const JointConstraint& work, const JointBodies& bodies);
void solve_joint(JointRecord& joint, const JointConstraint& work, const JointBodies& bodies,
                 const JointSettings& settings, bool soft);
// Only axes (limits, motors, springs, friction) and drives, without equations.
void warm_start_joint_axes(const JointRecord& joint, const JointConstraint& work, const JointBodies& bodies);
void solve_joint_axes(JointRecord& joint, const JointConstraint& work, const JointBodies& bodies,
                      const JointSettings& settings, bool soft);
// Adds the impulses of the sub-step to the sums, at the final velocities of the sub-step.
void accumulate_joint_impulses(JointRecord& joint, const JointConstraint& work, const JointBodies& bodies);
// Once a step: writes impulses back into the joint.
void finish_joint(JointRecord& joint, const JointConstraint& work);

// The axis of a joint's limits, motor and position.
JointAxis main_axis(JointKind kind);
// True for kinds whose equations are in JointConstraint::rows instead of point and angular blocks.
bool has_rows(JointKind kind);
// The axis of kinds whose record holds its settings (hinges, sliders, rods, ropes, springs); details may add
// to it.
JointAxisRecord axis_of_record(const JointRecord& joint, const JointDetail* detail, JointAxis index);
// Number of equations of the joint: 0 to 6.
int count_equations(const JointRecord& joint, const JointDetail* detail);

}  // namespace gyre
