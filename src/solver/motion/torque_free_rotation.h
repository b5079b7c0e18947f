// Torque-free rotation of a single body at constant momentum, in double. The equations are in
// solver/motion/torque_free_rotation_kernel.h.
#pragma once

#include "math/rotation.h"

namespace gyre {

// A symmetric tensor in double. The inverse comes from the float inertia: the stored float inverse is
// slightly off, and this error, equal in every sub-step, would add up over minutes.
struct Tensor {
  double xx = 0.0, yy = 0.0, zz = 0.0, xy = 0.0, xz = 0.0, yz = 0.0;
};
Tensor to_double(const Sym3& m);
Tensor inverse(const Tensor& m);
constexpr DVec3 times(const Tensor& m, DVec3 v) {
  return {m.xx * v.x + m.xy * v.y + m.xz * v.z, m.xy * v.x + m.yy * v.y + m.yz * v.z,
          m.xz * v.x + m.yz * v.y + m.zz * v.z};
}

// The orientation after `seconds` at constant angular momentum (world frame, kg m^2/s); `angle`: rough angle
// of the rotation, rad.
DQuat rotate_at_momentum(DQuat start, DVec3 momentum, const Tensor& inverse_inertia, double seconds,
                         double angle);

}  // namespace gyre
