// The turn of a single body at constant momentum (solver/motion/torque_free_rotation.h tells how and why).
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
DQuat rotate_at_momentum(DQuat start, DVec3 momentum, const Tensor& inverse_inertia, double seconds,
                       double angle);

}  // namespace gyre
