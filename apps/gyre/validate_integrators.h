// gyre validate --integrators: error of each integrator against the size of its step.
#pragma once

namespace gyre {

// Prints the table to stdout, or as rows of CSV. False if an observed order is not within 0.1 of the scheme's.
bool validate_integrators(bool csv);

}  // namespace gyre
