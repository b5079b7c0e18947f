// The stress and strain in the elements of solids, for fracture and readings.
#pragma once

#include "soft/body/soft_body.h"

#include <gyre/math.h>

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

// Of the principal strains of a tetrahedron, stretches less 1, the one of largest size; the flow of what has yielded is not in it.
double largest_strain(const SoftBody& body, std::size_t tetrahedron);
// Of numbers by size, the first of equal ones.
inline double largest_of(double a, double b) { return absolute(b) > absolute(a) ? b : a; }

}  // namespace gyre
