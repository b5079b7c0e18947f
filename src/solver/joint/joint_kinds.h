// Kinds of joints beyond point and angular blocks: six axes (universal joints and wheels have most of them
// locked), cones, gears, racks, pulleys and curves. Equations are a list of rows; everything else is a list
// of axes. The derivation is in docs/derive/joints.md.
#pragma once

#include "solver/joint/joint.h"

namespace gyre {

// The relative pose of two bodies, as a joint measures it.
struct RowPose {
  Vec3 anchor_offset;     // b's anchor minus a's
  Vec3 center_offset;     // b's centre of mass minus a's
  Quat frame_a, frame_b;  // world_from_joint
};

// The axis whose dot product with w_b - w_a is the rate of a Cardan angle (0 to 2), and of the twist of a
// cone.
Vec3 angle_axis(Quat frame_a, Quat frame_b, int angle);
Vec3 twist_axis(Quat frame_a, Quat frame_b);

// Removes limits that a kind does not have.
void adjust_axes(const JointRecord& joint, std::span<AxisConstraint> axes);

void prepare_six_axes(JointRecord& joint, JointConstraint& work, const JointPair& pair,
                      const JointSettings& settings);
void prepare_cone(JointRecord& joint, JointConstraint& work, const JointPair& pair,
                  const JointSettings& settings);
// Counts the turns of a gear from this pose on.
void start_gear(JointDetail& detail, GearFrame frame, const RowPose& pose);
void prepare_gear(JointRecord& joint, JointConstraint& work);
void prepare_rack(JointRecord& joint, JointConstraint& work, const JointPair& pair,
                  const JointOffsets& offsets);
void prepare_pulley(JointRecord& joint, JointConstraint& work, const JointPair& pair,
                    const JointOffsets& offsets, const JointSettings& settings);
void prepare_path(JointRecord& joint, JointConstraint& work, const JointPair& pair,
                  const JointSettings& settings);
void update_pulley_bias(JointConstraint& work, const JointPair& pair, float substep);

// The errors that the rows would have at another pose nearby.
void measure_rows(const JointRecord& joint, const JointConstraint& work, const RowPose& pose,
                  float (&errors)[kJointAxisCount]);

void prepare_rows(JointRows& rows, const JointPair& pair);
void warm_start_rows(const JointRows& rows, const JointDetail& detail, JointPair& pair);
void iterate_rows(JointRecord& joint, const JointConstraint& work, JointPair& pair,
                  const JointSettings& settings, bool soft);
// Sums the impulses of the rows as a force and a torque impulse on B.
void sum_row_impulses(JointRecord& joint, const JointConstraint& work);

}  // namespace gyre
