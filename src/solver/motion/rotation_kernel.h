// The kernels of freely rotating bodies. Bodies are sorted by the mode of their rotation, W at once in float,
// and then rotated in two halves in double (solver/motion/torque_free_rotation_kernel.h). Lane i has the bits
// of width 1.
#pragma once

#include "math/wide_vec.h"
#include "solver/motion/rotation_block.h"
#include "solver/motion/torque_free_rotation_kernel.h"

#include <cstddef>

namespace gyre {
inline namespace GYRE_TARGET_NAMESPACE {

// Below this angle only the steady part of the rotation reaches a float.
constexpr float kNoAngle = 1.0e-6f;
// Below this angle a sub-step of the midpoint rule is as exact as floats.
constexpr float kTinyAngle = 2.0e-3f;
// Principal moments this near to each other (relative) count as equal: those of shapes of revolution are
// rounded.
constexpr float kEqualMoments = 1.0e-6f;
// An angular velocity this near to parallel with the momentum (relative) is about a principal axis.
constexpr float kParallel = 1.0e-7f;

// How a free rotation is computed: at constant velocity, in closed form, by one midpoint step, or in inner
// Runge-Kutta steps.
enum class RotationMode : std::uint8_t { constant_velocity, symmetric_top, midpoint, runge_kutta };
constexpr int kRotationModeCount = 4;

// W bodies as columns.
template <int W>
struct RotationColumns {
  float* orientations[W];
  float* motions[W];
  int count;  // lanes from here on repeat the last body, and their results are discarded
  float nowhere[kRecordFloats];
  QuatW<W> orientation;
  Vec3W<W> spin, delta_rotation;
  Sym3W<W> inertia;
};
static_assert(offsetof(Sym3, xz) == 4 * sizeof(float) && sizeof(Quat) == 4 * sizeof(float));

// Gathers the first bodies of a list of `count`.
template <int W>
__attribute__((noinline)) void gather_rotations(const TorqueFreeRotation* rotations, const std::uint8_t* list,
                                                int count, RotationColumns<W>& columns) {
  columns.count = count < W ? count : W;
  const float *orientation[W], *motion[W], *inertia[W];
  for (int lane = 0; lane < W; ++lane) {
    const TorqueFreeRotation& body = rotations[list[lane < columns.count ? lane : columns.count - 1]];
    float *const q = &body.orientation->x, *const record = &body.motion->linear_velocity.x;
    orientation[lane] = q, motion[lane] = record, inertia[lane] = &body.inertia->xx;
    columns.orientations[lane] = lane < columns.count ? q : columns.nowhere;
    columns.motions[lane] = lane < columns.count ? record : columns.nowhere;
  }
  Wide<W> q[4], w[4], delta_rotation[4], m[8];
  gather_columns<4, W>(orientation, 0, q);
  gather_columns<4, W>(motion, kMotionAngular, w);
  gather_columns<4, W>(motion, kMotionDeltaRotation, delta_rotation);
  gather_columns<4, W>(inertia, 0, m);
  gather_columns<4, W>(inertia, 2, m + 4);
  columns.orientation = {q[0], q[1], q[2], q[3]};
  columns.spin = {w[0], w[1], w[2]};
  columns.delta_rotation = {delta_rotation[0], delta_rotation[1], delta_rotation[2]};
  columns.inertia = {m[0], m[1], m[2], m[3], m[6], m[7]};
}
template <int W>
GYRE_INLINE void scatter_rotations(const RotationColumns<W>& columns) {
  const QuatW<W>& q = columns.orientation;
  const Vec3W<W>&w = columns.spin, &delta_rotation = columns.delta_rotation;
  const Wide<W> out[] = {
      q.x, q.y, q.z, q.w, w.x, w.y, w.z, delta_rotation.x, delta_rotation.y, delta_rotation.z};
  scatter_columns<4, W>(columns.orientations, 0, out);
  scatter_columns<3, W>(columns.motions, kMotionAngular, out + 4);
  scatter_columns<3, W>(columns.motions, kMotionDeltaRotation, out + 7);
}

// Masks of the body axis (0, 1, 2) that is one of revolution; at most one is set in a lane.
template <int W>
struct SymmetryMasks {
  Mask<W> about_x, about_y, about_z, any;

  GYRE_INLINE explicit SymmetryMasks(const Sym3W<W>& m) {
    const Wide<W> zero(0.0f);
    const Mask<W> aligned = (m.xy == zero) & (m.xz == zero) & (m.yz == zero);
    const auto even = [&](Wide<W> a, Wide<W> b) { return aligned & (absolute(a - b) <= kEqualMoments * a); };
    about_x = even(m.yy, m.zz);
    about_y = and_not(even(m.zz, m.xx), about_x);
    about_z = and_not(even(m.xx, m.yy), about_x | about_y);
    any = about_x | about_y | about_z;
  }
};

// The rotation modes of the bodies, one a lane.
template <int W>
GYRE_INLINE WideInt<W> find_rotation_modes(const RotationColumns<W>& columns, float seconds) {
  const Vec3W<W> w = rotate_inverse(columns.orientation, columns.spin);  // body frame
  const Vec3W<W> momentum = columns.inertia * w;
  const Vec3W<W> torque = cross(momentum, w);
  const Wide<W> angle = seconds * length(columns.spin);
  const Mask<W> steady =
      (angle < kNoAngle) |
      (length_squared(torque) <= kParallel * kParallel * length_squared(momentum) * length_squared(w));
  const auto number = [](RotationMode mode) { return WideInt<W>(std::int32_t(mode)); };
  WideInt<W> mode =
      select(angle < kTinyAngle, number(RotationMode::midpoint), number(RotationMode::runge_kutta));
  mode = select(SymmetryMasks<W>(columns.inertia).any, number(RotationMode::symmetric_top), mode);
  return select(steady, number(RotationMode::constant_velocity), mode);
}

// Half of the lanes in double.
template <int H>
struct RotationHalf {
  DQuatW<H> orientation;  // in and out
  DVec3W<H> spin;         // in and out, rad/s
  DVec3W<H> delta_rotation;  // out, rad
  WideDouble<H> angle;       // rough angle of the rotation
  TensorW<H> inertia;
  SymmetricTopW<H> top;
};

// Not inlined: it would be part of the loop over both halves.
template <int H>
__attribute__((noinline)) void rotate_half(RotationHalf<H>& t, RotationMode mode, double seconds) {
  const WideDouble<H> time(seconds);
  const TensorW<H> inverse_inertia = inverse(t.inertia);
  const DQuatW<H> start = normalized(t.orientation);
  const DVec3W<H> velocity = rotate_inverse(start, t.spin);
  const DVec3W<H> own_momentum = times(t.inertia, velocity);
  const DVec3W<H> momentum = rotate(start, own_momentum);
  if (mode == RotationMode::symmetric_top) {
    t.orientation = rotate_symmetric_top(start, momentum, t.top, time);
  } else if (mode == RotationMode::midpoint) {
    t.orientation = rotate_by_midpoint(start, velocity, own_momentum, inverse_inertia, time);
  } else {
    t.orientation = rotate_in_steps(start, momentum, inverse_inertia, time, t.angle);
  }
  t.spin = rotate(t.orientation, body_velocity(t.orientation, momentum, inverse_inertia));
  t.delta_rotation = logarithm_map(t.orientation * conjugate(start));
}

// Access to the floats of half of the lanes as doubles.
template <int W>
class HalfView {
 public:
  static constexpr int H = kHalfLanes<W>;
  GYRE_INLINE explicit HalfView(int half) : first_(std::size_t(half) * H * sizeof(float)) {}

  GYRE_INLINE WideDouble<H> load(const Wide<W>& all) const {
    return WideDouble<H>::load_floats(reinterpret_cast<const char*>(&all.v) + first_);
  }
  GYRE_INLINE DVec3W<H> load(const Vec3W<W>& all) const { return {load(all.x), load(all.y), load(all.z)}; }
  GYRE_INLINE DQuatW<H> load(const QuatW<W>& all) const {
    return {load(all.x), load(all.y), load(all.z), load(all.w)};
  }
  GYRE_INLINE TensorW<H> load(const Sym3W<W>& all) const {
    return {load(all.xx), load(all.yy), load(all.zz), load(all.xy), load(all.xz), load(all.yz)};
  }
  GYRE_INLINE void store(WideDouble<H> half, Wide<W>& all) const {
    half.store_floats(reinterpret_cast<char*>(&all.v) + first_);
  }
  GYRE_INLINE void store(DVec3W<H> half, Vec3W<W>& all) const {
    store(half.x, all.x), store(half.y, all.y), store(half.z, all.z);
  }
  GYRE_INLINE void store(DQuatW<H> half, QuatW<W>& all) const {
    store(half.x, all.x), store(half.y, all.y), store(half.z, all.z), store(half.w, all.w);
  }

 private:
  std::size_t first_;
};

// Rotates the first `count` orientations by rotation vectors. In double, so that rotations far below the
// resolution of floats add up without bias.
template <int W>
__attribute__((noinline)) void rotate_by_vectors(QuatW<W>& orientation, const Vec3W<W>& rotation, int count) {
  for (int half = 0; half < kHalves<W> && half * kHalfLanes<W> < count; ++half) {
    const HalfView<W> view(half);
    view.store(normalized(exponential_map(view.load(rotation)) * view.load(orientation)), orientation);
  }
}

// Rotates columns of bodies at constant velocity.
template <int W>
GYRE_INLINE void rotate_steady_columns(RotationColumns<W>& columns, float seconds) {
  const Wide<W> zero(0.0f);
  const Vec3W<W> rotation = Wide<W>(seconds) * columns.spin;
  const Mask<W> is_rotating = (rotation.x != zero) | (rotation.y != zero) | (rotation.z != zero);
  QuatW<W> orientation = columns.orientation;
  rotate_by_vectors<W>(orientation, rotation, columns.count);
  // A body at rest keeps its orientation, whatever its length.
  columns.orientation = select(is_rotating, orientation, columns.orientation);
  columns.delta_rotation = columns.delta_rotation + keep(is_rotating, rotation);
}

// Rotates columns of bodies that have the same other mode.
template <int W>
GYRE_INLINE void rotate_free_columns(RotationColumns<W>& columns, RotationMode mode, float seconds) {
  const Wide<W> one(1.0f);
  const Sym3W<W>& m = columns.inertia;
  const SymmetryMasks<W> top(m);
  const Vec3W<W> axis{keep(top.about_x, one), keep(top.about_y, one), keep(top.about_z, one)};
  const Wide<W> along = select(top.about_x, m.xx, select(top.about_y, m.yy, m.zz));
  const Wide<W> across_1 = select(top.about_x, m.yy, select(top.about_y, m.zz, m.xx));
  const Wide<W> across_2 = select(top.about_x, m.zz, select(top.about_y, m.xx, m.yy));
  const Wide<W> angle = seconds * length(columns.spin);
  Vec3W<W> delta_rotation{Wide<W>(0.0f), Wide<W>(0.0f), Wide<W>(0.0f)};
  constexpr int H = kHalfLanes<W>;
  for (int half = 0; half * H < columns.count; ++half) {
    const HalfView<W> view(half);
    RotationHalf<H> t;
    t.orientation = view.load(columns.orientation);
    t.spin = view.load(columns.spin);
    t.angle = view.load(angle);
    t.inertia = view.load(m);
    t.top = {view.load(axis), view.load(along), 0.5 * (view.load(across_1) + view.load(across_2))};
    rotate_half<H>(t, mode, double(seconds));
    view.store(t.orientation, columns.orientation);
    view.store(t.spin, columns.spin);
    view.store(t.delta_rotation, delta_rotation);
  }
  columns.delta_rotation = columns.delta_rotation + delta_rotation;
}

template <int W>
void rotate_torque_free(const TorqueFreeRotation* rotations, int count, float seconds) {
  RotationColumns<W> columns;
  std::uint8_t all[kMaxRotations], lists[kRotationModeCount][kMaxRotations];
  int counts[kRotationModeCount] = {};
  for (int n = 0; n < count; ++n) all[n] = std::uint8_t(n);
  for (int n = 0; n < count; n += W) {
    gather_rotations<W>(rotations, all + n, count - n, columns);
    std::int32_t modes[W];
    find_rotation_modes<W>(columns, seconds).store_unaligned(modes);
    for (int lane = 0; lane < columns.count; ++lane) {
      const int mode = modes[lane];
      lists[mode][counts[mode]++] = all[n + lane];
    }
  }
  for (int mode = 0; mode < kRotationModeCount; ++mode) {
    for (int n = 0; n < counts[mode]; n += W) {
      gather_rotations<W>(rotations, lists[mode] + n, counts[mode] - n, columns);
      if (RotationMode(mode) == RotationMode::constant_velocity) {
        rotate_steady_columns<W>(columns, seconds);
      } else {
        rotate_free_columns<W>(columns, RotationMode(mode), seconds);
      }
      // Adding zero keeps -0 out of the state.
      const Wide<W> zero(0.0f);
      columns.spin = columns.spin + Vec3W<W>{zero, zero, zero};
      scatter_rotations<W>(columns);
    }
  }
}

template <int W>
void rotate_at_constant_velocity(ConstantRotation* rotations, int count) {
  static_assert(sizeof(ConstantRotation) == 8 * sizeof(float));
  float nowhere[sizeof(ConstantRotation) / sizeof(float)] = {};
  for (int n = 0; n < count; n += W) {
    const float* from[W];
    float* to[W];
    for (int lane = 0; lane < W; ++lane)
      from[lane] = to[lane] = n + lane < count ? &rotations[n + lane].orientation.x : nowhere;
    Wide<W> in[8];
    gather_columns<8, W>(from, 0, in);
    QuatW<W> q{in[0], in[1], in[2], in[3]};
    rotate_by_vectors<W>(q, Vec3W<W>{in[4], in[5], in[6]}, count - n);
    const Wide<W> out[] = {q.x, q.y, q.z, q.w};
    scatter_columns<4, W>(to, 0, out);
  }
}

// The table that a kernel file exports.
template <int W>
constexpr RotationKernels rotation_kernels() {
  return {rotate_torque_free<W>, rotate_at_constant_velocity<W>};
}

}  // namespace GYRE_TARGET_NAMESPACE
}  // namespace gyre
