// Pockets: cells from which no open face leads to an open side. Within each of them the pressure is known but for a constant, and the right side
// must add up to zero. A box that is closed on all sides is one pocket; solids may enclose more.
#pragma once

#include "fluid/solver/pressure_matrix.h"

#include <span>

namespace gyre {

// Finds the pockets of the finest level. Returns the number of parts that no open face connects, with those that reach an open side.
int find_pockets(PressureMatrix& matrix);

// Makes the mean of a field zero within every pocket.
void remove_pocket_means(const PressureMatrix& matrix, float* field);

}  // namespace gyre
