#include "solver/motion/torque_free_rotation.h"

#include "solver/motion/torque_free_rotation_kernel.h"

namespace gyre {

Tensor to_double(const Sym3& m) {
  return {double(m.xx), double(m.yy), double(m.zz), double(m.xy), double(m.xz), double(m.yz)};
}

namespace {

TensorW<1> lane_of(const Tensor& m) { return {m.xx, m.yy, m.zz, m.xy, m.xz, m.yz}; }

}  // namespace

Tensor inverse(const Tensor& m) {
  const TensorW<1> i = inverse(lane_of(m));
  return {i.xx.v, i.yy.v, i.zz.v, i.xy.v, i.xz.v, i.yz.v};
}

DQuat rotate_at_momentum(DQuat start, DVec3 momentum, const Tensor& inverse_inertia, double seconds,
                         double angle) {
  const DQuatW<1> q = rotate_in_steps(DQuatW<1>{start.x, start.y, start.z, start.w},
                                      DVec3W<1>{momentum.x, momentum.y, momentum.z}, lane_of(inverse_inertia),
                                      WideDouble<1>(seconds), WideDouble<1>(angle));
  return {q.x.v, q.y.v, q.z.v, q.w.v};
}

}  // namespace gyre
