// The joints of projection groups for their solvers: only equations and limits, without drives, springs and
// friction.
#pragma once

#include "rigid/batch/joint_constraints.h"
#include "rigid/continuous/ccd_projection_path.h"

namespace gyre {

struct ProjectionJoints {
  std::span<JointRecord> records;
  JointConstraints constraints;
};

constexpr JointSettings kProjectionSettings{kProjectionStep, {1.0f / kProjectionStep, 1.0f, 0.0f}, false};

// Copies the joints in these slots.
ProjectionJoints copy_projection_joints(const RigidWorld& w, std::span<const std::uint32_t> slots,
                                        Arena& arena);

}  // namespace gyre
