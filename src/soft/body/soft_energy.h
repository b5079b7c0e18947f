// Energies of soft bodies, in double and one element after the other: for readings, and for tests as another way to the forces.
#pragma once

#include "soft/body/soft_body.h"

namespace gyre {

// Of springs, bending and continua, J. A segment of a rope that keeps its length has none.
double elastic_energy(const SoftBody& body);

}  // namespace gyre
