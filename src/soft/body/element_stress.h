// The stress in the elements of solids, for fracture and readings.
#pragma once

#include "soft/body/soft_body.h"

#include <cstddef>

namespace gyre {

// The volume of a tetrahedron at rest, m^3, and that times the stress of the corotated law, Pa: xx, yy, zz, xy, xz, yz in the frame of the world.
struct ElementStress {
  double volume = 0.0;
  double stress[6] = {};
};
ElementStress stress_of(const SoftBody& body, std::size_t tetrahedron);
// Pa: sqrt(3/2 s:s) with s the deviator of the stress. Source: R. von Mises, 1913.
double von_mises(const ElementStress& element);

}  // namespace gyre
