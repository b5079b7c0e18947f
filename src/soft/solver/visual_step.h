// One sub-step of the visual scheme: particles fly freely, then one sweep moves them to fit their links and tethers (extended position based dynamics with small
// steps). It is stable and quick. Stiffness depends on cells and sub-steps, so its figures are those of a picture. Springs of the body are links; bending and
// damping are left out. Links are swept colour by colour, since a sweep in the order of a mesh diverges. Tethers keep each particle within the way along the
// links from the nearest held one, so that a sheet that hangs does not stretch with the number of its cells.
//
// Sources: M. Macklin et al., "Small Steps in Physics Simulation", 2019; T.-Y. Kim, N. Chentanez, M. Mueller-Fischer, "Long Range Attachments", 2012.
#pragma once

#include "base/arena/arena.h"
#include "soft/body/soft_body.h"

namespace gyre {

void step_visual(SoftBody& body, float step, Vec3 gravity, Arena& arena);

}  // namespace gyre
