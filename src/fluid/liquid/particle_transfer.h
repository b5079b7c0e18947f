// From particles to the grid and back.
//
// A particle gives its volume and its momentum to the faces around it, with linear weights, and takes the velocity and its slopes from them with the
// same weights (C. Jiang, C. Schroeder, A. Selle, J. Teran, A. Stomakhin, "The Affine Particle-In-Cell Method", 2015). Particles are in the
// order of cells; blocks of four rows of cells by four, no two neighbours at a time, add to the faces, so every sum has one order.
#pragma once

#include "fluid/liquid/liquid_pass.h"

namespace gyre {

// Brings particles into the order of cells and removes those that have left through open sides or are no numbers.
void sort_particles(const LiquidPass& pass);
// The velocity on faces, zero where no particle is near, and how full the room around centres is.
void transfer_to_grid(const LiquidPass& pass);
// The latter alone.
void find_filled(const LiquidPass& pass);
// The velocity of particles and its slopes from faces; those away from the liquid fall freely. Then particles move. `blend`: see LiquidSettings.
void move_particles(const LiquidPass& pass, float blend, Vec3 gravity);

}  // namespace gyre
