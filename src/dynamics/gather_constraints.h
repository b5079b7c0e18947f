// Gathers the constraints of a batch.
//
// In: a batch of whole islands (dynamics/island_batches.h). Out: its contacts and joints in lists, and between which bodies they are.
#pragma once

#include "dynamics/batch_context.h"

namespace gyre {

// The batch's contacts as constraints, and what colouring needs to know of them; marks the bodies as touched.
void gather_contacts(BatchContext& batch, Arena& arena, TaskSystem& tasks);
// Between which bodies all joints of the batch are; marks these bodies.
void gather_joint_edges(BatchContext& batch, Arena& arena, TaskSystem& tasks);
// Those that are in no articulation, as contacts.
void gather_swept_joints(BatchContext& batch);

}  // namespace gyre
