// Limits of vertices: each stays near its target and in front of its backstop, whatever moved it. Places are exact; of the velocity only the part that leads out of
// the limit goes.
//
// In: an entry whose vertices have moved. Out: their places and velocities.
#pragma once

#include "soft/store/soft_store.h"

namespace gyre {

void keep_limits(SoftEntry& entry);

}  // namespace gyre
