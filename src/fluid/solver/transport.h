// Moves all fields of a gas along its velocity. The path of each cell centre is traced once, back and ahead, for all fields; faces take the mean of
// the two cells beside them.
#pragma once

#include "fluid/solver/gas_pass.h"

namespace gyre {

// Traces cells through the velocity as it is: the displacements of the next transport_fields.
void trace_paths(const GasPass& pass);
void transport_fields(const GasPass& pass, Advection advection);

// The largest number of cells that the gas passes along an axis within the step.
float max_displacement(const GasPass& pass);

}  // namespace gyre
