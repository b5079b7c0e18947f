// Finds held bodies: those without a joint that a machine presses on something else. A machine is a set of bodies that joints connect, and
// one that does work (a motor, a drive or a spring) acts on it. Joints without equations, as ropes and springs, connect nothing here.
//
// A motor presses a light body with hundreds of its weights, and from one step to the next. One iteration in each half-step passes such a
// load on too slowly. Bodies enter each other by about F h^2 / m meanwhile, and by far more while soft contacts learn the load. So
// contacts of held bodies are rigid and iterated many times in each half-step, and the motors of their machines act before them, not
// after them (docs/decisions/held-bodies.md).
#pragma once

#include "base/arena/arena.h"
#include "rigid/batch/joint_constraints.h"
#include "rigid/batch/solve_batch.h"
#include "rigid/store/rigid_world.h"
#include "task/coloring.h"

namespace gyre {

struct HeldBodies {
  std::span<const std::uint8_t>
      contacts;  // by constraint: 1 for those of held bodies; empty if there are none
  std::span<const std::uint8_t> pressing;  // by body in the batch: 1 for those of machines that touch one
};

// `pairs`: indices in the batch of the moving bodies of the constraints. `joints`: those of the batch. `local_index`: by body its index in
// its batch.
HeldBodies find_held_bodies(const RigidWorld& w, const SolveBatch& batch,
                            std::span<const std::uint32_t> local_index, std::span<const JointEdge> joints,
                            std::span<const ColoringPair> pairs, Arena& arena);

}  // namespace gyre
