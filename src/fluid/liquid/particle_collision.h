// Keeps particles within walls and outside solids. Solids stand as given at the beginning of the step and move on with their bodies; a
// particle's path is seen from the solid nearest to it, so that a thin wall that moves by more than its thickness still takes along what
// stands before it.
#pragma once

#include "fluid/liquid/liquid_pass.h"

namespace gyre {

class ParticleCollision {
 public:
  explicit ParticleCollision(const LiquidPass& pass);
  // The particle's way from `from` to `to`, shortened where something is in the way: sets its position.
  void finish(int particle, const float (&from)[3], float (&to)[3]) const;

 private:
  struct Motion {
    Vec3 center{}, velocity{}, spin{};
  };
  Vec3 velocity_at(int label, Vec3 point) const;
  // Takes the speed of a particle into a solid of this velocity. No pressure stops particles that fly, which else would gain the speed of a fall
  // while they lie on a solid.
  void stop(int particle, Vec3 solid, Vec3 outward) const;
  // True if no centre around is liquid.
  bool flies(const float (&from)[3]) const;
  void avoid_solids(int particle, const float (&from)[3], float (&to)[3]) const;
  float distance_at(Vec3 point) const;

  const LiquidPass& pass_;
  ParticleAxis axes_[3];
  bool has_solids_;
  float edge_ = 0.0f;       // the shortest of a cell
  float diagonal_ = 0.0f;   // of a cell
  bool has_exact_ = false;  // distances were given
  Array<Motion> motions_;
  Array<float> derived_;  // distances where none are given
  const float* distance_ = nullptr;
};

}  // namespace gyre
