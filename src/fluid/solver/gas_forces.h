// The accelerations of a gas besides pressure: buoyancy, gravity along periodic axes, vorticity confinement, emitters.
#pragma once

#include "fluid/solver/gas_pass.h"

#include <span>

namespace gyre {

// Holds density and temperature in its ball, and the velocity if it has one, in every step that begins in [start, end).
struct GasEmitter {
  DVec3 position{};  // in the world
  float radius = 0.1f;
  float density = 1.0f;
  float temperature = 300.0f;
  Vec3 velocity{};
  bool has_velocity = false;
  double start = 0.0, end = 1.0e9;  // s
};

// The cells whose centres lie in the ball, and the one in which its centre lies. `fuel`: of each emitter, if the gas has fuel, else empty.
void apply_emitters(const GasPass& pass, std::span<const GasEmitter> emitters, std::span<const float> fuel,
                    double time);

// Velocity += step (g_periodic - buoyancy g (T - ambient) / ambient). Along axes that are not periodic the weight of the gas itself rests on
// pressure, within walls as beyond open sides, and is left out of both.
void add_buoyancy(const GasPass& pass, Vec3 gravity, float buoyancy);

// A box that turns adds two accelerations. Velocities turn against the box by twice its angle. They must not hold a push of the pressure, which
// would turn into a swirl.
void turn_velocity(const GasPass& pass);
// And the gas is drawn away from the axis.
void add_outward(const GasPass& pass);

// Velocity += step strength h (N x w), w the vorticity, N the direction in which it grows (J. Steinhoff, D. Underhill, 1994; R. Fedkiw, J. Stam,
// H. W. Jensen, "Visual Simulation of Smoke", 2001).
void add_confinement(const GasPass& pass, float strength);

}  // namespace gyre
