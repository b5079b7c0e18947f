// Gathers the constraints of a batch.
//
// In: a batch of whole islands (dynamics/island_batches.h). Out: lists of its contacts and joints, and the pairs of their bodies.
#pragma once

#include "dynamics/batch_context.h"

namespace gyre {

// Lists the batch's contacts as constraints, with the pairs for graph colouring. Marks the bodies as constrained.
void gather_contacts(BatchContext& batch, Arena& arena, TaskSystem& tasks);
// Lists the pairs of bodies of all joints in the batch, and marks these bodies.
void gather_joint_edges(BatchContext& batch, Arena& arena, TaskSystem& tasks);
// Lists the iterative joints with their pairs, as contacts.
void gather_swept_joints(BatchContext& batch);

}  // namespace gyre
