// Which cells are liquid, where the surface lies, and the pressure equation of that.
//
// How full the room around a centre is, with linear weights, is the particles' volume there over the room that solids leave. Below a flat surface at
// the depth d cells it is 1 - (1 - d)^2/2 and above it (1 + d)^2/2, which gives the distance d back: the surface of a lattice of particles that ends
// at some height is that height.
#pragma once

#include "fluid/liquid/liquid_pass.h"

namespace gyre {

// Of each face the fraction through which liquid passes, once for a step.
void find_open_faces(const LiquidPass& pass);
// From the sums of particles to `filled`, cells and the distance from the surface.
void find_surface(const LiquidPass& pass);
// True if no cell on either side of a row of faces is liquid; of a row of cells with axis -1.
bool is_dry(const LiquidPass& pass, int axis, int j, int k);
// Steepness of faces and the levels of the equation.
void build_liquid_matrix(const LiquidPass& pass);

}  // namespace gyre
