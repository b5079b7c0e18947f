// The joints of groups that follow what was stopped, as their solvers see them: of what acts on them only equations and limits.
#pragma once

#include "rigid/continuous/closing_way.h"
#include "rigid/batch/joint_works.h"

namespace gyre {

struct ClosingJoints {
  std::span<JointRecord> records;
  JointWorks works;
};

constexpr JointSettings kClosingSettings{kClosingStep, {1.0f / kClosingStep, 1.0f, 0.0f}, false};

// Copies of the joints in these slots.
ClosingJoints copy_closing_joints(const RigidWorld& w, std::span<const std::uint32_t> slots, Arena& arena);

}  // namespace gyre
