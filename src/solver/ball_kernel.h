// The kernels of ball joints side by side (solver/ball_lanes.h), one template for every width.
#pragma once

#include "solver/ball_lanes.h"
#include "solver/linkage_block.h"

namespace gyre {
inline namespace GYRE_TARGET_NAMESPACE {

template <int W>
struct BallBlock {
  std::int32_t read_a[W], read_b[W], write_a[W], write_b[W], inertia[W];
  // As LaneBall.
  Vec3W<W> local_a, local_b, offset, from_a, from_b, error, bend, impulse, total;
  // Of this sub-step.
  Wide<W> inverse_mass_a, inverse_mass_b;
  Sym3W<W> inverse_inertia_a, inverse_inertia_b;
  Mat3W<W> mass;  // inverse of K
};

template <int W>
struct BallMotion {
  Vec3W<W> linear_a, angular_a, linear_b, angular_b;

  GYRE_INLINE BallMotion(const BallBlock<W>& block, const BallArrays& arrays) {
    Wide<W> c[8];
    gather8<W>(&arrays.motion->linear_velocity.x, block.read_a, c);
    linear_a = {c[0], c[1], c[2]}, angular_a = {c[3], c[4], c[5]};
    gather8<W>(&arrays.motion->linear_velocity.x, block.read_b, c);
    linear_b = {c[0], c[1], c[2]}, angular_b = {c[3], c[4], c[5]};
  }
  GYRE_INLINE void push(const BallBlock<W>& block, Vec3W<W> p) {
    linear_a -= block.inverse_mass_a * p;
    angular_a -= block.inverse_inertia_a * cross(block.from_a, p);
    linear_b += block.inverse_mass_b * p;
    angular_b += block.inverse_inertia_b * cross(block.from_b, p);
  }
  // Adding zero keeps -0 out of the state.
  GYRE_INLINE void store(const BallBlock<W>& block, const BallArrays& arrays) const {
    const Wide<W> zero(0.0f);
    const Wide<W> a[6] = {linear_a.x + zero,  linear_a.y + zero,  linear_a.z + zero,
                          angular_a.x + zero, angular_a.y + zero, angular_a.z + zero};
    const Wide<W> b[6] = {linear_b.x + zero,  linear_b.y + zero,  linear_b.z + zero,
                          angular_b.x + zero, angular_b.y + zero, angular_b.z + zero};
    scatter<6, W>(&arrays.motion->linear_velocity.x, block.write_a, a);
    scatter<6, W>(&arrays.motion->linear_velocity.x, block.write_b, b);
  }
  GYRE_INLINE Vec3W<W> point_velocity(const BallBlock<W>& block) const {
    return linear_b + cross(angular_b, block.from_b) - linear_a - cross(angular_a, block.from_a);
  }
};

alignas(64) constexpr float kNothing[kRecordFloats] = {};

// Pose of one side.
template <int W>
struct BallSide {
  QuatW<W> orientation;
  Vec3W<W> moved;

  GYRE_INLINE BallSide(const std::int32_t* indices, const BallArrays& arrays) {
    alignas(16) static constexpr float kUnturned[4] = {0.0f, 0.0f, 0.0f, 1.0f};
    Wide<W> c[4];
    gather_fours<1, W, 4>(&arrays.orientation->x, indices, kUnturned, 0, c);
    orientation = {c[0], c[1], c[2], c[3]};
    gather_fours<1, W, kMotionFloats>(&arrays.motion->linear_velocity.x, indices, kNothing, kMotionMoved, c);
    moved = {c[0], c[1], c[2]};
  }
};

template <int W>
GYRE_INLINE void load_inertia(const std::int32_t* indices, const BallArrays& arrays, Wide<W>& inverse_mass,
                              Sym3W<W>& inverse_inertia) {
  constexpr int kInertiaFloats = int(sizeof(BodyInertia) / sizeof(float));
  Wide<W> c[8];
  gather_fours<2, W, kInertiaFloats>(&arrays.inertia->inverse.xx, indices, kNothing, 0, c);
  inverse_inertia = {c[0], c[1], c[2], c[3], c[4], c[5]};
  inverse_mass = c[6];
}
template <int W>
GYRE_INLINE void load_inertia(BallBlock<W>& block, const BallArrays& arrays) {
  const auto inertia = WideInt<W>::load_unaligned(block.inertia);
  if (none(inertia != WideInt<W>(kInertiaKnown))) return;
  load_inertia<W>(block.read_a, arrays, block.inverse_mass_a, block.inverse_inertia_a);
  load_inertia<W>(block.read_b, arrays, block.inverse_mass_b, block.inverse_inertia_b);
  (inertia & WideInt<W>(kInertiaTurns)).store_unaligned(block.inertia);
}

// As between_skews() and point_matrix() of solver/joint_blocks.h, and inverse() of a Mat3.
template <int W>
GYRE_INLINE Mat3W<W> between_skews(Vec3W<W> r, const Sym3W<W>& s) {
  const Vec3W<W> x{s.xx, s.xy, s.xz}, y{s.xy, s.yy, s.yz}, z{s.xz, s.yz, s.zz};
  return {cross(r, r.z * y - r.y * z), cross(r, r.x * z - r.z * x), cross(r, r.y * x - r.x * y)};
}
template <int W>
GYRE_INLINE Mat3W<W> inverse_by_cofactors(const Mat3W<W>& m) {
  const Vec3W<W> yz = cross(m.y, m.z);
  const Wide<W> det = dot(m.x, yz);
  const Mask<W> regular = det != 0.0f;
  const Wide<W> s = 1.0f / det;
  const Mat3W<W> rows = transpose(Mat3W<W>{s * yz, s * cross(m.z, m.x), s * cross(m.x, m.y)});
  return {keep(regular, rows.x), keep(regular, rows.y), keep(regular, rows.z)};
}

template <int W>
void place_balls(void* blocks, int begin, int end, const BallArrays& arrays) {
  for (int i = begin; i < end; ++i) {
    BallBlock<W>& block = static_cast<BallBlock<W>*>(blocks)[i];
    const BallSide<W> a(block.read_a, arrays), b(block.read_b, arrays);
    load_inertia<W>(block, arrays);
    block.from_a = rotate(a.orientation, block.local_a);
    block.from_b = rotate(b.orientation, block.local_b);
    block.error = block.offset + (b.moved - a.moved) + block.from_b - block.from_a;
    const Wide<W> m = block.inverse_mass_a + block.inverse_mass_b, zero(0.0f);
    const Mat3W<W> by_a = between_skews(block.from_a, block.inverse_inertia_a),
                   by_b = between_skews(block.from_b, block.inverse_inertia_b);
    const Mat3W<W> k{Vec3W<W>{m, zero, zero} - by_a.x - by_b.x, Vec3W<W>{zero, m, zero} - by_a.y - by_b.y,
                     Vec3W<W>{zero, zero, m} - by_a.z - by_b.z};
    block.mass = inverse_by_cofactors(k);
  }
}

template <int W>
void bend_balls(void* blocks, int begin, int end, const BallArrays& arrays, const BallSettings& settings) {
  for (int i = begin; i < end; ++i) {
    BallBlock<W>& block = static_cast<BallBlock<W>*>(blocks)[i];
    const BallMotion<W> pair(block, arrays);
    const Vec3W<W> bend = cross(pair.angular_b, cross(pair.angular_b, block.from_b)) -
                          cross(pair.angular_a, cross(pair.angular_a, block.from_a));
    block.bend = (0.5f * settings.substep) * bend;
  }
}

template <int W>
void warm_balls(void* blocks, int begin, int end, const BallArrays& arrays) {
  for (int i = begin; i < end; ++i) {
    const BallBlock<W>& block = static_cast<const BallBlock<W>*>(blocks)[i];
    BallMotion<W> pair(block, arrays);
    pair.push(block, block.impulse);
    pair.store(block, arrays);
  }
}

template <int W>
void solve_balls(void* blocks, int begin, int end, const BallArrays& arrays, const BallSettings& s) {
  for (int i = begin; i < end; ++i) {
    BallBlock<W>& block = static_cast<BallBlock<W>*>(blocks)[i];
    BallMotion<W> pair(block, arrays);
    const Vec3W<W> speed = pair.point_velocity(block) + block.bend;
    const Vec3W<W> change =
        -s.mass_scale * (block.mass * (speed + s.rate * block.error)) - s.impulse_scale * block.impulse;
    pair.push(block, change);
    block.impulse += change;
    pair.store(block, arrays);
  }
}

template <int W>
void relax_balls(void* blocks, int begin, int end, const BallArrays& arrays) {
  const Wide<W> zero(0.0f);
  const Vec3W<W> nothing{zero, zero, zero};
  for (int i = begin; i < end; ++i) {
    BallBlock<W>& block = static_cast<BallBlock<W>*>(blocks)[i];
    BallMotion<W> pair(block, arrays);
    const Vec3W<W> change = -(block.mass * (pair.point_velocity(block) + nothing));
    pair.push(block, change);
    block.impulse += change;
    block.total += block.impulse;
    pair.store(block, arrays);
  }
}

template <int W>
constexpr BallKernels ball_kernels() {
  static_assert(offsetof(BallBlock<W>, inverse_mass_a) - offsetof(BallBlock<W>, local_a) ==
                W * sizeof(LaneBall));
  return {W,
          sizeof(BallBlock<W>),
          offsetof(BallBlock<W>, local_a),
          place_balls<W>,
          bend_balls<W>,
          warm_balls<W>,
          solve_balls<W>,
          relax_balls<W>};
}

}  // namespace GYRE_TARGET_NAMESPACE
}  // namespace gyre
