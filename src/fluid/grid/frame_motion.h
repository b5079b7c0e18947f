// FrameMotion: how the axes of a fluid's box move, as the fluid sees it. Velocities are relative to the box; a box that turns adds the accelerations
// -w x (w x r) - 2 w x v (L. D. Landau, E. M. Lifshitz, "Mechanics", section 39).
#pragma once

#include <gyre/math.h>

namespace gyre {

// All in the axes of the box, places from its lower corner.
struct FrameMotion {
  Vec3 velocity{};  // m/s, of the lower corner
  Vec3 spin{};      // rad/s
  Vec3 center{};    // m: a point that does not accelerate

  bool moves() const { return velocity != Vec3{} || spin != Vec3{}; }
  bool turns() const { return spin != Vec3{}; }
  // The velocity of a point at rest in the world, at a place of the box.
  Vec3 rest_at(Vec3 place) const { return -(velocity + cross(spin, place)); }
  // m/s^2, away from the axis.
  Vec3 outward(Vec3 place) const { return -cross(spin, cross(spin, place - center)); }
};

}  // namespace gyre
