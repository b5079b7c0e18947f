// EnclosedGas: gas within a closed surface of triangles, which pushes it outward.
//
// The volume within is V = 1/6 sum a.(b x c), and a pressure p over that outside pushes vertex i by p g_i, g_i = dV/dx_i: a third of the area vectors
// of its faces. The sum of these forces and of their torques is zero. An ideal gas of constant temperature keeps (p + p0) V, p0 the pressure outside, so
// the pressure has the stiffness (p + p0) / V g g^T, positive semi-definite and of rank one. What the pressure does as faces turn is left out of the
// matrix, as the compression of springs is. The free energy is -(p + p0) V ln(V / V0) + p0 (V - V0).
//
// In: places. Out: volume, pressure, g.
#pragma once

#include "base/container/array.h"
#include "soft/body/soft_body.h"

namespace gyre {

// m^3: within closed triangles, positive if they are counter-clockwise seen from outside.
double enclosed_volume(const Particles& particles, std::span<const std::uint32_t> triangles);
// Pa, above that outside.
double gauge_pressure(const EnclosedGas& gas, double volume);
// Pa / m^3: how much the pressure falls as the volume grows.
double volume_stiffness(const EnclosedGas& gas, double volume);
// J, 0 at the volume at rest.
double gas_energy(const EnclosedGas& gas, double volume);
// g by particle, m^2; zero where no face is. Three numbers a particle.
void find_volume_gradient(const Particles& particles, const EnclosedGas& gas, std::span<Vec3> gradient);

}  // namespace gyre
