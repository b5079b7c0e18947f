// Joints: the record that persists, what preparation finds out in each sub-step, and the solve over a run of joints.
// Every kind is made of the blocks in joint_blocks.h.
//
// Frames: a joint has a frame on each body (origin at the anchor, x along the axis). The error of a joint is measured with
// the orientations of the sub-step, its rows are solved softly (position errors are taken back) and then rigidly (only
// velocities), as contacts are.
#pragma once

#include "base/arena/arena.h"
#include "solver/joint/joint_axis.h"
#include "solver/joint/joint_record.h"

namespace gyre {

// What a step knows about one joint: the difference of the anchors' owners' centres, exact at any distance from the origin.
struct JointOffsets {
  Vec3 offset;              // centre (or world anchor) of b minus that of a, as the step began
  Vec3 ground_a, ground_b;  // pulley: the fixed points minus the centres of a and b
};

// The columns that joints are solved on, indexed by body.
struct JointBodies {
  BodyMotion* motion = nullptr;
  const BodyInertia* inertia = nullptr;     // of this sub-step
  const Quat* orientation = nullptr;        // of this sub-step: world_from_body
};

struct JointSettings {
  float substep = 0.0f;
  Softness softness;  // of the joint's own rows
  bool iterative =
      true;  // false: the joint's equations and hard stops are solved elsewhere (solver/articulation/articulation.h)
};

// One row that holds always: it sees push . (v_b - v_a) + arm_b . w_b - arm_a . w_a.
struct JointRow {
  Vec3 direction;     // direction of a force; zero for a turning row
  Vec3 angular_a, angular_b;  // r x push, or the axis of a turn
  float error = 0.0f;
};

// The rows of kinds that are not made of the blocks of a point and a turn, and their K, factored.
struct JointRows {
  int count = 0;
  JointRow rows[kJointAxisCount];
  double factors[kJointAxisCount * kJointAxisCount] = {};
};

// What a drive to a pose, and friction against all turning, know of a sub-step.
struct DriveConstraint {
  Vec3 linear_error, angular_error;  // world
  Vec3 target_velocity, target_angular_velocity;  // asked for
  Vec3 from_a;                   // to where b's anchor is
  Mat3 linear_mass, angular_mass;
  Softness softness;
};

// One joint in one sub-step, prepared. Lives in the step's arena.
struct JointConstraint {
  Vec3 from_a, from_b;       // anchors from the centres of mass, world axes
  Vec3 error;                // anchor b minus anchor a
  Vec3
      second_order_bias;  // m/s: how far b's anchor leaves a's by turning in the sub-step, beyond what the rows see
  Vec3 axis;                 // hinge and slider: of a; distance: unit from a to b
  Vec3 perpendicular_1, perpendicular_2;
  Vec3 angular_error;        // rotation vector that turns a's frame onto b's
  Vec3 free_offset;                // where b's anchor is from a's, as far as that is no error
  Quat frame_a, frame_b;     // world_from_joint
  Mat3 linear_mass;          // inverse of K
  Mat3 angular_mass;
  float position = 0.0f;
  JointDetail* detail = nullptr;  // of the joint, if it has one
  std::span<const PathPoint> path{};
  std::span<AxisConstraint> axes{};
  JointRows* rows = nullptr;
  DriveConstraint* drive = nullptr;
};

// Once a step: room for the work, impulses scaled to a new sub-step length, sums cleared.
void begin_joint(JointRecord& joint, JointDetail* detail, std::span<const PathPoint> path,
                 JointConstraint& work, float warm_scale, Arena& arena);
// What depends on where the bodies are: once they have moved.
void prepare_joint(JointRecord& joint, JointConstraint& work, const JointOffsets& offsets,
                   const JointBodies& bodies, const JointSettings& settings);
// What depends on their velocities: before they are solved.
void update_joint_bias(const JointRecord& joint, JointConstraint& work, const JointBodies& bodies,
                       const JointSettings& settings);
void warm_start_joint(const JointRecord& joint, const JointConstraint& work, const JointBodies& bodies);
void solve_joint(JointRecord& joint, const JointConstraint& work, const JointBodies& bodies,
                 const JointSettings& settings, bool soft);
// Only what is no equation: axes (limits, motors, springs, friction) and drives.
void warm_start_joint_axes(const JointRecord& joint, const JointConstraint& work, const JointBodies& bodies);
void solve_joint_axes(JointRecord& joint, const JointConstraint& work, const JointBodies& bodies,
                      const JointSettings& settings, bool soft);
// Once velocities are those that the sub-step ends with: adds its impulses to the sums.
void accumulate_joint_impulses(JointRecord& joint, const JointConstraint& work, const JointBodies& bodies);
// Once a step: what the work knows goes back into the joint.
void finish_joint(JointRecord& joint, const JointConstraint& work);

// The axis that a joint's limits, motor and position are about.
JointAxis main_axis(JointKind kind);
// Whether the kind's equations are in JointConstraint::rows rather than blocks of a point and a turn.
bool has_rows(JointKind kind);
// The axis of kinds whose record has all that acts there (hinges, sliders, rods, ropes, springs); details may add to it.
JointAxisRecord axis_of_record(const JointRecord& joint, const JointDetail* detail, JointAxis index);
// How many rows of the joint are equations: 0 to 6.
int count_equations(const JointRecord& joint, const JointDetail* detail);

}  // namespace gyre
