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

// Soft matter rests like bodies: it falls asleep when all its vertices have been still for as long as bodies must be, no field acts, and all
// bodies that it touches or hangs on are asleep or stand still. It wakes when one of these moves or another comes near. Until its vertices
// are still it keeps the bodies that it touches awake. Cloths and solids that may touch each other sleep and wake together.
void rest_soft(RigidWorld& w, SoftStore& soft, Arena& arena, float seconds);
void wake_all(SoftStore& soft);

void find_soft_contacts(RigidWorld& w, SoftStore& soft, Array<std::uint32_t>& shapes_near, Arena& arena,
                        TaskSystem& tasks, float seconds);

}  // namespace gyre
