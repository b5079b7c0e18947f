// The joints of groups that follow what was stopped, as their solvers see them: of what acts on them only equations and limits.
#pragma once

#include "rigid/batch/joint_constraints.h"
#include "rigid/continuous/ccd_projection_path.h"

namespace gyre {

struct ProjectionJoints {
  std::span<JointRecord> records;
  JointConstraints constraints;
};

constexpr JointSettings kProjectionSettings{kProjectionStep, {1.0f / kProjectionStep, 1.0f, 0.0f}, false};

// Copies of the joints in these slots.
ProjectionJoints copy_projection_joints(const RigidWorld& w, std::span<const std::uint32_t> slots, Arena& arena);

}  // namespace gyre
