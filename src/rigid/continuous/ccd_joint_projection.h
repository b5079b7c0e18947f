// Joint projection after CCD: closes the joints of halted bodies.
#pragma once

#include "base/arena/arena.h"
#include "base/container/array.h"
#include "rigid/continuous/ccd_joint_groups.h"
#include "solver/kernels/solver_kernels.h"
#include "task/task_system.h"

namespace gyre {

// True if the joint keeps a point of its bodies together: two halted bodies that it connects are halted
// together.
bool constrains_position(const RigidWorld& w, std::uint32_t joint);
// Moves the bodies that joints connect to halted ones, which are at their impact poses, so that joints are
// closed and within limits again. Only poses change, no velocities. Halted bodies move but little.
// `stop_at_impact`: nothing moves beyond the first impact of its group. Adds to `moved` the bodies that end
// far, for their size, from their former end: CCD did not test that motion.
void project_joints_after_ccd(RigidWorld& w, std::span<const HaltedBody> halted, bool stop_at_impact,
                              const SolverKernels& kernels, TaskSystem& tasks, Array<std::uint32_t>& moved,
                              Arena& arena);

}  // namespace gyre
