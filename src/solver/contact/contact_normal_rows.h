// K of the normal rows of contact blocks and its inverse, as a step begins. Part of the kernels
// (contact_prepare.h).
#pragma once

#include "solver/contact/contact_pair.h"

namespace gyre {
inline namespace GYRE_TARGET_NAMESPACE {

template <int W>
GYRE_INLINE void mark_uneven_points(ContactBlock<W>& block) {
  std::uint32_t missing = 0;
  for (int i = 0; i < block.point_count; ++i) missing |= block.rows[i] ^ all_lanes(W);
  block.has_uneven_points = missing != 0 ? 1 : 0;
}

// K of the normal rows and its inverse. Four points of a plane give rank 3 at most, so the inverse is of K
// with its diagonal raised by a share: impulses that no motion distinguishes then change least. Rows of
// missing points are those of the identity in Cholesky's factor, and 0 after.
template <int W, int Count>
GYRE_INLINE void prepare_rows(ContactBlock<W>& block, const Wide<W> (&point_exists)[kMaxManifoldPoints]) {
  constexpr float kRegular = 0.02f;  // of the diagonal, added to it: points in line or on one spot stay solvable
  const Wide<W> zero(0.0f), one(1.0f);
  Wide<W> inverse_masses = block.inverse_mass_a + block.inverse_mass_b;
  if (block.locked != 0)
    inverse_masses = inverse_masses_between<W>(block, block.normal, block.normal, inverse_masses);
  Wide<W> l[10], inverse_diagonal[Count];  // Cholesky factor of the regularised K
  for (int i = 0; i < Count; ++i) {
    const PointBlock<W>& point = block.points[i];
    const Vec3W<W> ia = block.inverse_inertia_a * (point.arm + block.arm_shift_a);
    const Vec3W<W> ib = block.inverse_inertia_b * (point.arm + block.arm_shift_b);
    const Vec3W<W> angular = ia + ib;
    const Wide<W> common = inverse_masses + (dot(block.arm_shift_a, ia) + dot(block.arm_shift_b, ib));
    const auto exists = point_exists[i] > zero;
    Wide<W> row[Count];
    for (int j = 0; j <= i; ++j) {
      const Wide<W> k = common + dot(block.points[j].arm, angular);
      block.cold->k[packed(j, i)] = row[j] = keep(exists & (point_exists[j] > zero), k);
    }
    const Wide<W> own = row[i];
    block.cold->inverse_diagonal[i] = keep(own > zero, one / select(own > zero, own, one));
    block.rows[i] = lane_bits<W>(block.cold->inverse_diagonal[i] > zero);
    for (int j = 0; j < i; ++j) {
      Wide<W> sum = row[j];
      for (int m = 0; m < j; ++m) sum = sum - l[packed(m, i)] * l[packed(m, j)];
      l[packed(j, i)] = sum * inverse_diagonal[j];
    }
    Wide<W> sum = own * Wide<W>(1.0f + kRegular);
    for (int m = 0; m < i; ++m) sum = sum - l[packed(m, i)] * l[packed(m, i)];
    inverse_diagonal[i] = one / select(sum > zero, sqrt(sum), one);
  }
  // Columns of the inverse, by forward and back substitution.
  for (int column = 0; column < Count; ++column) {
    Wide<W> x[Count];
    for (int i = column; i < Count; ++i) {
      Wide<W> sum = i == column ? one : zero;
      for (int m = column; m < i; ++m) sum = sum - l[packed(m, i)] * x[m];
      x[i] = sum * inverse_diagonal[i];
    }
    const auto exists = point_exists[column] > zero;
    for (int i = Count - 1; i >= 0; --i) {
      Wide<W> sum = i < column ? zero : x[i];
      for (int m = i + 1; m < Count; ++m) sum = sum - l[packed(i, m)] * x[m];
      x[i] = sum * inverse_diagonal[i];
      if (i <= column) block.inverse_k[packed(i, column)] = keep(exists, x[i]);
    }
  }
}
// Not inlined: it is as long as all of its callers together.
template <int W>
__attribute__((noinline)) void prepare_normals(ContactBlock<W>& block,
                                               const Wide<W> (&point_exists)[kMaxManifoldPoints]) {
  switch (block.point_count) {
    case 0:
      break;
    case 1:
      prepare_rows<W, 1>(block, point_exists);
      break;
    case 2:
      prepare_rows<W, 2>(block, point_exists);
      break;
    case 3:  // with moving points
      prepare_rows<W, 3>(block, point_exists);
      break;
    default:
      prepare_rows<W, 4>(block, point_exists);
      break;
  }
  mark_uneven_points<W>(block);
}

}  // namespace GYRE_TARGET_NAMESPACE
}  // namespace gyre
