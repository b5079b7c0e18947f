// Velocities of faces beyond the liquid, from those beside it, layer by layer: the mean of the neighbours that are nearer (R. Bridson, "Fluid
// Simulation for Computer Graphics", 2008).
#pragma once

#include "fluid/liquid/liquid_pass.h"

namespace gyre {

// Lists the faces of each layer; those beside liquid are layer 0, up to `count` beyond them.
void find_layers(const LiquidPass& pass, int count);
// Gives the faces of all layers but the first their values, and ghosts theirs, in two fields at once.
void extrapolate(const LiquidPass& pass, Array<float> (&first_fields)[3], Array<float> (&second_fields)[3]);

}  // namespace gyre
