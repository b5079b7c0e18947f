// Moving bodies between constraints: `predict` gives them the velocity that forces alone would, `advance` moves them by
// the velocity that the solver left. Both work on lists of awake bodies.
//
// Semi-implicit Euler (symplectic: E. Hairer, C. Lubich, G. Wanner, "Geometric Numerical Integration", I.1): a kick by
// forces and constraints at the present place, then the exact drift of a free body: x += h v, and torque-free rotation
// for the orientation. The kick changes momentum, the drift keeps it.
#pragma once

#include "rigid/body_store.h"

#include <span>

namespace gyre {

// Beyond these nothing is simulated faithfully; speeds are clamped to them and the clamping is reported.
constexpr float kMaxSpeed = 1.0e7f;   // m/s
constexpr float kMaxSpin = 2.0e4f;    // rad/s

// The vector without its components along locked world axes (bits 1, 2, 4: x, y, z).
inline Vec3 without_locked(Vec3 v, std::uint8_t locked) {
  if (locked & 1) v.x = 0.0f;
  if (locked & 2) v.y = 0.0f;
  if (locked & 4) v.z = 0.0f;
  return v;
}

// Velocities from forces, torques, gravity and damping over h.
void predict(BodyStore& bodies, std::span<const std::uint32_t> list, float h, Vec3 gravity);
// Displacement from velocities over h, orientation by free rotation, world inertia of the new orientation.
void advance(BodyStore& bodies, std::span<const std::uint32_t> list, float h);

}  // namespace gyre
