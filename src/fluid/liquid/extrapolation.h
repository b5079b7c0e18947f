// Velocities of faces beyond the liquid, from those beside it, layer by layer: the mean of the neighbours that are known (R. Bridson, "Fluid
// Simulation for Computer Graphics", 2008).
#pragma once

#include "fluid/liquid/liquid_pass.h"

namespace gyre {

// Layers of faces: those beside liquid are 0, up to `count` beyond them.
void find_layers(const LiquidPass& pass, int count, Array<float> (&fields)[3]);

}  // namespace gyre
