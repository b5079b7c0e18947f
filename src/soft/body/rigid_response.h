// How a body of particles answers an impulse as a whole, by a motion of all of them together.
#pragma once

#include <gyre/math.h>

#include <cstdint>

namespace gyre {

constexpr std::uint32_t kNoRigidBody = 0xffffffffu;  // of a vertex whose body does not answer as a whole

// A velocity, m/s, and an angular velocity, rad/s, about a centre.
struct RigidVelocity {
  Vec3 linear{}, angular{};

  Vec3 at(Vec3 arm) const { return linear + cross(angular, arm); }
};

// The inverse of the inertia for both, of the velocity at the centre and about it. Zero: the body has no such motion.
struct RigidResponse {
  DVec3 center{};            // m
  float inverse[6][6] = {};  // by an impulse, N s, and its moment, N m s
  bool is_stiff = false;     // its moves are cut as a whole

  RigidVelocity of(Vec3 impulse, Vec3 arm) const {
    const Vec3 moment = cross(arm, impulse);
    const float given[6] = {impulse.x, impulse.y, impulse.z, moment.x, moment.y, moment.z};
    float found[6];
    for (int row = 0; row < 6; ++row) {
      found[row] = 0.0f;
      for (int column = 0; column < 6; ++column) found[row] += inverse[row][column] * given[column];
    }
    return {{found[0], found[1], found[2]}, {found[3], found[4], found[5]}};
  }
};

inline RigidVelocity& operator+=(RigidVelocity& a, const RigidVelocity& b) {
  a.linear += b.linear, a.angular += b.angular;
  return a;
}

}  // namespace gyre
