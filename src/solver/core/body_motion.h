// The 64-byte record of a body that every solver reads and writes. It is one cache line of sixteen floats, so
// wide kernels gather it with plain transposes. The solver does not know who owns the records.
#pragma once

#include <gyre/math.h>

#include <cstdint>

namespace gyre {

struct alignas(64) BodyMotion {
  Vec3 linear_velocity;   // m/s, of the centre of mass, world frame
  Vec3 angular_velocity;  // rad/s, world frame
  float inverse_mass = 0.0f;  // 1/kg; 0 for fixed and kinematic bodies
  float pushout = 0.0f;       // m: the largest pushout of a point of the body in this step
  Vec3 delta_position;        // m, of the centre of mass since the step began
  Vec3 delta_rotation;        // rad, rotation vector since the step began: the sum over the sub-steps
  float spare_1 = 0.0f;
  float spare_2 = 0.0f;
};
static_assert(sizeof(BodyMotion) == 64);

// Clears the record of a body that ceases to move. The displacement is cleared too: joints still read it, no
// step clears it any more, and snapshots do not store it.
inline void clear_motion(BodyMotion& motion) {
  motion.linear_velocity = motion.angular_velocity = {};
  motion.delta_position = motion.delta_rotation = {};
  motion.pushout = 0.0f;
}

// m/s, world frame: velocity of the point at `from_center` from the centre of mass (world axes).
inline Vec3 point_velocity(const BodyMotion& motion, Vec3 from_center) {
  return motion.linear_velocity + cross(motion.angular_velocity, from_center);
}

// Columns of the record for the wide kernels.
constexpr int kMotionFloats = 16;
constexpr int kMotionLinear = 0;
constexpr int kMotionAngular = 3;
constexpr int kMotionPushout = 7;
constexpr int kMotionDeltaPosition = 8;
constexpr int kMotionDeltaRotation = 11;

// Inverse inertia in the world frame. It has a record of its own because only preparation reads it.
struct BodyInertia {
  Sym3 inverse;                 // 1/(kg m^2), world axes
  float inverse_mass = 0.0f;
  float locked = 0.0f;          // locked world axes of the translation: bits 0 to 2 of a whole number
};
static_assert(sizeof(BodyInertia) == 32);
// The vector without its components along locked axes.
inline Vec3 along_free_axes(const BodyInertia& inertia, Vec3 v) {
  if (inertia.locked == 0.0f) return v;
  const int locked = int(inertia.locked);
  return {(locked & 1) != 0 ? 0.0f : v.x, (locked & 2) != 0 ? 0.0f : v.y, (locked & 4) != 0 ? 0.0f : v.z};
}
// The inverse mass along a unit vector.
inline float inverse_mass_along(const BodyInertia& inertia, Vec3 direction) {
  if (inertia.locked == 0.0f) return inertia.inverse_mass;
  return inertia.inverse_mass * length_squared(along_free_axes(inertia, direction));
}

// The static world, which has no record.
constexpr std::int32_t kNoBody = -1;
// "None" for unsigned indices; for bodies, kNoBody.
constexpr std::uint32_t kNoIndex = 0xffffffffu;

}  // namespace gyre
