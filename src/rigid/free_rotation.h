// Torque-free rotation of a rigid body: the exact drift between two kicks.
//
// The angular momentum L in the world frame is constant, so the only unknown is the orientation: q' = 1/2 w q with
// w = R I^-1 R^T L. L is kept exactly (to rounding) by construction and the energy to the order of the scheme, for any
// inertia tensor and any speed; bodies that spin about a principal axis turn by the exponential map, and bodies of
// revolution by two of them (the axis goes round L, the body about its axis), which is exact.
//
// Method: Runge-Kutta 4 on the orientation with L fixed, in inner steps of at most kInnerAngle; one midpoint step (error
// of order angle^3) where the angle is so small that it is exact in float. Source of the idea: E. Hairer, C. Lubich,
// G. Wanner, "Geometric Numerical Integration", VII.5; L as the variable: J. C. Simo, K. K. Wong, 1991.
#pragma once

#include "math/rotation.h"

namespace gyre {

// A symmetric tensor in double. The inverse is found here from the float inertia: the float inverse is not quite its
// inverse, and that error, the same in every sub-step, would add up over minutes.
struct Tensor {
  double xx = 0.0, yy = 0.0, zz = 0.0, xy = 0.0, xz = 0.0, yz = 0.0;
};
Tensor to_double(const Sym3& m);
Tensor inverse(const Tensor& m);
constexpr DVec3 times(const Tensor& m, DVec3 v) {
  return {m.xx * v.x + m.xy * v.y + m.xz * v.z, m.xy * v.x + m.yy * v.y + m.yz * v.z,
          m.xz * v.x + m.yz * v.y + m.zz * v.z};
}

// The orientation after `seconds` at a constant angular momentum (world frame, kg m^2/s); `angle`: about how far it turns, rad.
DQuat turn_at_momentum(DQuat start, DVec3 momentum, const Tensor& inverse_inertia, double seconds,
                       double angle);

// How a free rotation is worked out: at constant velocity, in closed form, or in inner steps.
enum class FreeTurnKind : std::uint8_t { steady, closed, stepped };
FreeTurnKind kind_of_turn(Quat orientation, Vec3 angular_velocity, const Sym3& inertia, float seconds);

// A body that turns freely: its orientation and angular velocity (world frame, rad/s) are moved on. `inertia` is in the body's
// frame and can be inverted. `turned` becomes the rotation vector by which the body turned (world frame, rad).
struct FreeTurn {
  Quat* orientation = nullptr;
  Vec3* angular_velocity = nullptr;
  const Sym3* inertia = nullptr;
  Vec3* turned = nullptr;
};
// So many side by side, all of a kind (not steady). A body may stand for its neighbour too.
constexpr int kFreeTurns = 2;
void rotate_freely(const FreeTurn (&turns)[kFreeTurns], FreeTurnKind kind, float seconds);

// Moves the orientation on at constant angular velocity: bodies with equal principal moments, kinematic bodies.
Vec3 rotate_steadily(Quat& orientation, Vec3 angular_velocity, float seconds);

}  // namespace gyre
