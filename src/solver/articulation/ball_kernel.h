// The kernels of ball joints side by side (solver/articulation/ball_joint_simd.h), one template for every
// width.
#pragma once

#include "solver/articulation/articulation_block.h"
#include "solver/articulation/ball_joint_simd.h"

#include <cstring>

namespace gyre {
inline namespace GYRE_TARGET_NAMESPACE {

template <int W>
struct BallInertia {
  Wide<W> inverse_mass;
  Sym3W<W> inverse;
};

// Addresses of motion records.
template <int W>
using RecordList = float* [W];

template <int W>
struct BallBlock {
  std::int32_t read_a[W], read_b[W], write_a[W], write_b[W], inertia[W];
  // As LaneBall. Fields that the same loops read are neighbours: the loops wait for memory more than they
  // compute.
  Vec3W<W> local_a, local_b, offset, total, from_a, from_b, impulse, error, second_order_bias;
  Mat3W<W> mass;  // of this sub-step: inverse of K
  // The records of the bodies for reading (zeros for none), and for writing: most blocks write all that they
  // read and have one list for both.
  RecordList<W> record_a, record_b;
  const RecordList<W>* written_a;
  const RecordList<W>* written_b;
  // Own inertia, or that of another block with the same: nets mostly have equal bodies, and then one stays in
  // the cache.
  const BallInertia<W>* inertia_a;
  const BallInertia<W>* inertia_b;

  BallInertia<W> own_inertia_a, own_inertia_b;
  RecordList<W> write_list_a, write_list_b;  // immovable bodies are written to `nowhere`
  alignas(64) float nowhere[kRecordFloats];
};

template <int W>
GYRE_INLINE const RecordList<W>* locate_lanes(float* motion, const std::int32_t* read,
                                              const std::int32_t* write, float* nowhere,
                                              RecordList<W>& record, RecordList<W>& write_list) {
  // Read-only records are never written.
  locate_records<W>(motion, read, const_cast<float*>(kNoRecord), record);
  if (all(WideInt<W>::load_unaligned(read) == WideInt<W>::load_unaligned(write)) &&
      none(WideInt<W>::load_unaligned(read) < WideInt<W>(0)))
    return &record;
  locate_records<W>(motion, write, nowhere, write_list);
  return &write_list;
}
template <int W>
void locate_balls(void* blocks, int begin, int end, const BallArrays& arrays) {
  float* const motion = &arrays.motion->linear_velocity.x;
  for (int i = begin; i < end; ++i) {
    BallBlock<W>& block = static_cast<BallBlock<W>*>(blocks)[i];
    block.written_a = locate_lanes<W>(motion, block.read_a, block.write_a, block.nowhere, block.record_a,
                                      block.write_list_a);
    block.written_b = locate_lanes<W>(motion, block.read_b, block.write_b, block.nowhere, block.record_b,
                                      block.write_list_b);
  }
}

template <int W>
struct BallMotion {
  Vec3W<W> linear_a, angular_a, linear_b, angular_b;

  GYRE_INLINE explicit BallMotion(const BallBlock<W>& block) {
    Wide<W> c[8];
    gather_columns<8, W>(block.record_a, kMotionLinear, c);
    linear_a = {c[0], c[1], c[2]}, angular_a = {c[3], c[4], c[5]};
    gather_columns<8, W>(block.record_b, kMotionLinear, c);
    linear_b = {c[0], c[1], c[2]}, angular_b = {c[3], c[4], c[5]};
  }
  GYRE_INLINE void apply_impulse(const BallBlock<W>& block, Vec3W<W> p) {
    const BallInertia<W>&a = *block.inertia_a, &b = *block.inertia_b;
    linear_a -= a.inverse_mass * p;
    angular_a -= a.inverse * cross(block.from_a, p);
    linear_b += b.inverse_mass * p;
    angular_b += b.inverse * cross(block.from_b, p);
  }
  // Adding zero keeps -0 out of the state.
  GYRE_INLINE void store(const BallBlock<W>& block) const {
    const Wide<W> zero(0.0f);
    const Wide<W> a[6] = {linear_a.x + zero,  linear_a.y + zero,  linear_a.z + zero,
                          angular_a.x + zero, angular_a.y + zero, angular_a.z + zero};
    const Wide<W> b[6] = {linear_b.x + zero,  linear_b.y + zero,  linear_b.z + zero,
                          angular_b.x + zero, angular_b.y + zero, angular_b.z + zero};
    scatter_columns<6, W>(*block.written_a, kMotionLinear, a);
    scatter_columns<6, W>(*block.written_b, kMotionLinear, b);
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
  Vec3W<W> delta_position;

  GYRE_INLINE BallSide(const std::int32_t* indices, const RecordList<W>& records, const BallArrays& arrays) {
    alignas(16) static constexpr float kUnturned[4] = {0.0f, 0.0f, 0.0f, 1.0f};
    Wide<W> c[4];
    gather_vec4<1, W, 4>(&arrays.orientation->x, indices, kUnturned, 0, c);
    orientation = {c[0], c[1], c[2], c[3]};
    gather_columns<4, W>(records, kMotionDeltaPosition, c);
    delta_position = {c[0], c[1], c[2]};
  }
};

template <int W>
GYRE_INLINE void load_inertia(const std::int32_t* indices, const BallArrays& arrays,
                              BallInertia<W>& inertia) {
  constexpr int kInertiaFloats = int(sizeof(BodyInertia) / sizeof(float));
  Wide<W> c[8];
  gather_vec4<2, W, kInertiaFloats>(&arrays.inertia->inverse.xx, indices, kNothing, 0, c);
  inertia = {c[6], {c[0], c[1], c[2], c[3], c[4], c[5]}};
}
// To the bit.
template <int W>
GYRE_INLINE bool are_same(const BallInertia<W>& a, const BallInertia<W>& b) {
  return std::memcmp(&a, &b, sizeof(BallInertia<W>)) == 0;
}
// `before`: the block before this one, if it may be shared.
template <int W>
GYRE_INLINE void load_inertia(BallBlock<W>& block, const BallBlock<W>* before, const BallArrays& arrays) {
  const auto inertia = WideInt<W>::load_unaligned(block.inertia);
  if (none(inertia != WideInt<W>(kInertiaKnown))) return;
  load_inertia<W>(block.read_a, arrays, block.own_inertia_a);
  load_inertia<W>(block.read_b, arrays, block.own_inertia_b);
  block.inertia_a = &block.own_inertia_a;
  block.inertia_b = &block.own_inertia_b;
  const auto rotates = inertia & WideInt<W>(kInertiaRotates);
  rotates.store_unaligned(block.inertia);
  if (any(rotates != WideInt<W>(0))) return;
  const bool may_share =
      before != nullptr && none(WideInt<W>::load_unaligned(before->inertia) != WideInt<W>(kInertiaKnown));
  if (may_share && are_same<W>(*block.inertia_a, *before->inertia_a)) block.inertia_a = before->inertia_a;
  if (may_share && are_same<W>(*block.inertia_b, *before->inertia_b)) block.inertia_b = before->inertia_b;
  if (are_same<W>(*block.inertia_b, *block.inertia_a)) block.inertia_b = block.inertia_a;
}

// As between_skews() and point_matrix() of solver/joint/joint_blocks.h, and inverse() of a Mat3.
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
void prepare_balls(void* blocks, int begin, int end, const BallArrays& arrays) {
  for (int i = begin; i < end; ++i) {
    BallBlock<W>& block = static_cast<BallBlock<W>*>(blocks)[i];
    const BallSide<W> a(block.read_a, block.record_a, arrays), b(block.read_b, block.record_b, arrays);
    load_inertia<W>(block, i > begin ? &block - 1 : nullptr, arrays);
    const BallInertia<W>&inertia_a = *block.inertia_a, &inertia_b = *block.inertia_b;
    block.from_a = rotate(a.orientation, block.local_a);
    block.from_b = rotate(b.orientation, block.local_b);
    block.error = block.offset + (b.delta_position - a.delta_position) + block.from_b - block.from_a;
    const Wide<W> m = inertia_a.inverse_mass + inertia_b.inverse_mass, zero(0.0f);
    const Mat3W<W> by_a = between_skews(block.from_a, inertia_a.inverse),
                   by_b = between_skews(block.from_b, inertia_b.inverse);
    const Mat3W<W> k{Vec3W<W>{m, zero, zero} - by_a.x - by_b.x, Vec3W<W>{zero, m, zero} - by_a.y - by_b.y,
                     Vec3W<W>{zero, zero, m} - by_a.z - by_b.z};
    block.mass = inverse_by_cofactors(k);
  }
}

template <int W>
void update_ball_bias(void* blocks, int begin, int end, const BallSettings& settings) {
  for (int i = begin; i < end; ++i) {
    BallBlock<W>& block = static_cast<BallBlock<W>*>(blocks)[i];
    const BallMotion<W> pair(block);
    const Vec3W<W> second_order_bias = cross(pair.angular_b, cross(pair.angular_b, block.from_b)) -
                                       cross(pair.angular_a, cross(pair.angular_a, block.from_a));
    block.second_order_bias = (0.5f * settings.substep) * second_order_bias;
  }
}

template <int W>
void warm_start_balls(void* blocks, int begin, int end) {
  for (int i = begin; i < end; ++i) {
    BallBlock<W>& block = static_cast<BallBlock<W>*>(blocks)[i];
    BallMotion<W> pair(block);
    pair.apply_impulse(block, block.impulse);
    pair.store(block);
  }
}

template <int W>
void solve_balls(void* blocks, int begin, int end, const BallSettings& s) {
  for (int i = begin; i < end; ++i) {
    BallBlock<W>& block = static_cast<BallBlock<W>*>(blocks)[i];
    BallMotion<W> pair(block);
    const Vec3W<W> speed = pair.point_velocity(block) + block.second_order_bias;
    const Vec3W<W> change =
        -s.mass_scale * (block.mass * (speed + s.rate * block.error)) - s.impulse_scale * block.impulse;
    pair.apply_impulse(block, change);
    block.impulse += change;
    pair.store(block);
  }
}

template <int W>
void relax_balls(void* blocks, int begin, int end) {
  const Wide<W> zero(0.0f);
  const Vec3W<W> nothing{zero, zero, zero};
  for (int i = begin; i < end; ++i) {
    BallBlock<W>& block = static_cast<BallBlock<W>*>(blocks)[i];
    BallMotion<W> pair(block);
    const Vec3W<W> change = -(block.mass * (pair.point_velocity(block) + nothing));
    pair.apply_impulse(block, change);
    block.impulse += change;
    block.total += block.impulse;
    pair.store(block);
  }
}

template <int W>
constexpr BallKernels ball_kernels() {
  static_assert(offsetof(BallBlock<W>, mass) - offsetof(BallBlock<W>, local_a) == W * sizeof(LaneBall));
  return {W,
          sizeof(BallBlock<W>),
          offsetof(BallBlock<W>, local_a),
          locate_balls<W>,
          prepare_balls<W>,
          update_ball_bias<W>,
          warm_start_balls<W>,
          solve_balls<W>,
          relax_balls<W>};
}

}  // namespace GYRE_TARGET_NAMESPACE
}  // namespace gyre
