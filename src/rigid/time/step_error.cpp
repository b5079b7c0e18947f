#include "rigid/time/step_error.h"

namespace gyre {

bool is_anything_constrained(const RigidWorld& w) {
  for (const std::uint32_t body : w.bodies.awake) {
    if (w.bodies.flags[body].constraint_use != kNotConstrained) return true;
  }
  return false;
}

double step_difference(const RigidWorld& w, std::span<const BodyMotion> other, float seconds) {
  const double t = double(seconds);
  double largest = 0.0;
  for (const std::uint32_t body : w.bodies.awake) {
    if (w.bodies.flags[body].constraint_use == kNotConstrained) continue;
    const BodyMotion &a = w.bodies.motion[body], &b = other[body];
    const double distance = length(DVec3(a.delta_position) - DVec3(b.delta_position)) +
                            t * length(DVec3(a.linear_velocity) - DVec3(b.linear_velocity));
    const double angle = length(DVec3(a.delta_rotation) - DVec3(b.delta_rotation)) +
                         t * length(DVec3(a.angular_velocity) - DVec3(b.angular_velocity));
    largest = max(largest, distance + double(w.bodies.masses[body].bounding_radius) * angle);
  }
  return largest;
}

}  // namespace gyre
