// The loads on bodies that soft matter holds or touches: all that contacts, joints, couplings and soft matter connect with each of them.
#pragma once

#include "base/arena/arena.h"
#include "rigid/store/rigid_world.h"
#include "soft/store/soft_store.h"

#include <cstdint>
#include <span>

namespace gyre {

// `loads`: of each body of `bodies` (awake, ascending) that is held by contacts or joints, too, the mass of all else that hangs together with it, kg; of one that soft matter alone
// holds, 0.
void find_loads(const RigidWorld& w, const SoftStore& soft, std::span<const std::uint32_t> bodies,
                Arena& arena, std::span<double> loads);

}  // namespace gyre
