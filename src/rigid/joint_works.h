// What a step knows of the joints of a batch: room for their work, and where their ends stand as it begins.
#pragma once

#include "base/arena.h"
#include "rigid/rigid_world.h"
#include "rigid/solve_batches.h"
#include "solver/joint.h"

namespace gyre {

struct JointWorks {
  std::span<JointWork> work;  // by place in the batch's list of joints
  std::span<JointPlaces> places;
};

// Where the ends of the joint stand as the step begins.
JointPlaces joint_places(const RigidWorld& w, std::uint32_t slot);
JointWorks begin_joints(RigidWorld& w, const SolveBatch& batch, float warm_scale, Arena& arena);
// What the work knows goes back into the joints.
void finish_joints(RigidWorld& w, const SolveBatch& batch, std::span<const JointWork> work);

}  // namespace gyre
