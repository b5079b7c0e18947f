// Joints of bodies that a sweep took back: what hangs on them comes after.
#pragma once

#include "base/arena/arena.h"
#include "base/container/array.h"
#include "rigid/continuous/ccd_joint_groups.h"
#include "solver/contact/contact_block.h"
#include "task/task_system.h"

namespace gyre {

// Whether the joint holds a point of its bodies together: two stopped bodies that it joins stop as one.
bool constrains_position(const RigidWorld& w, std::uint32_t joint);
// Moves bodies that hang together with those that were stopped, which stand where they will stay, so that the joints between them are
// closed and within their limits again: places and orientations alone, no velocities. Stopped ones are moved but for a little.
// `stays`: nothing goes on beyond where the first that it hangs together with was stopped. Adds to `moved` what ends far, against its
// size, from where it would have ended: it was not swept on that way.
void project_joints_after_ccd(RigidWorld& w, std::span<const HaltedBody> halted, bool stop_at_impact,
                              const ContactKernels& kernels, TaskSystem& tasks, Array<std::uint32_t>& moved,
                              Arena& arena);

}  // namespace gyre
