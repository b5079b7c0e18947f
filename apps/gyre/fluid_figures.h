// Figures of all gases and liquids of a world together.
#pragma once

#include "scene/scene_runner.h"

namespace gyre {

struct FluidFigures {
  double liquid_volume = 0.0;      // m^3
  long long liquid_particles = 0;  // of all liquids
  double smoke_mass = 0.0;         // kg
  double fuel_mass = 0.0;          // kg
  double heat_rate = 0.0;          // W, of combustion in the last step
  double divergence = 0.0;         // 1/s, the largest
  double residual = 0.0;           // of the last solve over its right side, the largest
};

inline FluidFigures fluid_figures(const SceneRunner& runner) {
  FluidFigures out;
  runner.for_each_fluid([&](const SceneFluid&, FluidId id) {
    const FluidInfo info = runner.world().fluid_info(id);
    out.liquid_volume += info.volume;
    out.liquid_particles += info.particles;
    out.smoke_mass += info.smoke_mass;
    out.fuel_mass += info.fuel_mass;
    out.heat_rate += info.heat_rate;
    out.divergence = max(out.divergence, double(info.divergence));
    out.residual = max(out.residual, double(info.residual));
  });
  return out;
}

}  // namespace gyre
