// Contacts of the vertices of soft matter with the shapes of bodies, found once a step.
//
// In: particles, shapes, a broad phase that has received all boxes. Out: SoftEntry::contacts, each a plane that moves with its body, with the
// impulses that the same vertex and shape had before; sleeping bodies that are touched wake. A vertex keeps contacts with the nearest
// kMaxVertexContacts shapes only. Contacts are speculative: all surfaces that a vertex may reach in the step are among them.
#pragma once

#include "base/arena/arena.h"
#include "rigid/store/rigid_world.h"
#include "soft/store/soft_store.h"
#include "task/task_system.h"

namespace gyre {

constexpr int kMaxVertexContacts = 4;

void find_soft_contacts(RigidWorld& w, SoftStore& soft, Array<std::uint32_t>& shapes_near, Arena& arena,
                        TaskSystem& tasks, float seconds);

}  // namespace gyre
