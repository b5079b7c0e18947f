// FluidBody: a rigid body as a fluid sees it, one for each label of GasSolids.
#pragma once

#include <gyre/math.h>

namespace gyre {

struct FluidBody {
  float inverse_mass = 0.0f;  // 1/kg; 0: the body moves as told, whatever the fluid does
  Sym3 inverse_inertia{};     // 1/(kg m^2), in the axes of the world
  float volume =
      0.0f;  // m^3, that it displaces; corrects what the cells make of it by up to a tenth; 0: not known
  DVec3 center{};           // m, centre of mass, in the world
  Vec3 velocity{};          // m/s, at the beginning of the step
  Vec3 angular_velocity{};  // rad/s
  Vec3
      acceleration{};  // m/s^2, that other forces than the fluid's give it in the step: gravity, unless it stands on something
  Vec3 angular_acceleration{};  // rad/s^2
  bool has_bounds = false;      // if it is known how far the body reaches
  Aabb bounds{};                // m, in the axes of the fluid's box
};

}  // namespace gyre
