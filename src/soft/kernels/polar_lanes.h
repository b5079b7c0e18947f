// The rotation of a deformation gradient, and eigenvectors of symmetric matrices, W at a time.
//
// Sources: N. J. Higham, "Functions of Matrices", 2008, chapter 8 (the rotation of F = R S makes tr(R^T F) largest); G. H. Golub and C. F.
// Van Loan, "Matrix Computations", section 8.5 (Jacobi).
#pragma once

#include "math/wide_vec.h"

namespace gyre {
inline namespace GYRE_TARGET_NAMESPACE {

// A rotation whose first axis is that of f, the second near it: where the iterations begin.
template <int W>
GYRE_INLINE Mat3W<W> orthogonal_start(const Mat3W<W>& f) {
  Mat3W<W> r;
  r.x = normalized(f.x, Vec3W<W>{1.0f, 0.0f, 0.0f});
  const Vec3W<W> across = f.y - dot(r.x, f.y) * r.x;
  const Vec3W<W> other = f.z - dot(r.x, f.z) * r.x;
  // Where f.y leads along f.x, what f.z leaves is taken; and where that does too, any.
  const Vec3W<W> aside =
      select(absolute(r.x.x) < 0.57735f, Vec3W<W>{1.0f, 0.0f, 0.0f}, Vec3W<W>{0.0f, 1.0f, 0.0f});
  const Vec3W<W> any = normalized(aside - dot(r.x, aside) * r.x);
  const Wide<W> size = length(f.y), other_size = length(f.z);
  const Vec3W<W> from_z = select(length(other) > 1.0e-5f * other_size, cross(normalized(other), r.x), any);
  r.y = select(length(across) > 1.0e-5f * size, normalized(across), from_z);
  r.z = cross(r.x, r.y);
  return r;
}

// The turn of the last step of Newton's, rad, of which the square is lost in rounding: the error after the step is of the order of that square.
constexpr float kLastTurn = 2.0e-4f;

// A step of Newton's towards the largest tr(R^T F), for lanes that are `moving`: with S = R^T F near its symmetric part, the turn w has
// (tr(S) 1 - S) w = axial part of S. Where that matrix is not positive definite the axial part alone, over the size of S. Lanes stop after a
// small turn of Newton's, each for itself, so that a lane has the same bits whatever the others do.
template <int W>
GYRE_INLINE void improve_rotation(Mat3W<W>& r, const Mat3W<W>& f, Mask<W>& moving) {
  const Mat3W<W> s = transpose(r) * f;
  const Vec3W<W> axial{s.y.z - s.z.y, s.z.x - s.x.z, s.x.y - s.y.x};
  const Wide<W> trace = s.x.x + s.y.y + s.z.z;
  const Sym3W<W> matrix{trace - s.x.x,           trace - s.y.y,           trace - s.z.z,
                        -0.5f * (s.x.y + s.y.x), -0.5f * (s.x.z + s.z.x), -0.5f * (s.y.z + s.z.y)};
  const Wide<W> minor = matrix.xx * matrix.yy - matrix.xy * matrix.xy;
  const Wide<W> determinant = matrix.xx * (matrix.yy * matrix.zz - matrix.yz * matrix.yz) -
                              matrix.xy * (matrix.xy * matrix.zz - matrix.yz * matrix.xz) +
                              matrix.xz * (matrix.xy * matrix.yz - matrix.yy * matrix.xz);
  const Wide<W> size = length(s.x) + length(s.y) + length(s.z) + 1.0e-30f;
  const Mask<W> definite = (matrix.xx > 0.0f) & (minor > 0.0f) & (determinant > 1.0e-4f * size * size * size);
  const Vec3W<W> newton = inverse(matrix) * axial;
  Vec3W<W> turn = select(definite, newton, axial / size);
  const Wide<W> angle = length(turn);
  turn = (1.0f / max(angle, Wide<W>(1.0f))) * turn;  // at most about a radian
  const QuatW<W> q = normalized(QuatW<W>{0.5f * turn.x, 0.5f * turn.y, 0.5f * turn.z, 1.0f});
  const Mat3W<W> improved = r * to_matrix(q);
  r = {select(moving, improved.x, r.x), select(moving, improved.y, r.y), select(moving, improved.z, r.z)};
  moving = and_not(moving, definite & (angle < kLastTurn));
}

// The rotation nearest to f, also where f turns volume inside out: then the direction of least stretch is the one turned over.
template <int W>
GYRE_INLINE Mat3W<W> polar_rotation(const Mat3W<W>& f) {
  Mat3W<W> r = orthogonal_start(f);
  Mask<W> moving = Mask<W>::splat(true);
  GYRE_ROLLED
  for (int i = 0; i < 5; ++i) {
    improve_rotation(r, f, moving);
    if (none(moving)) break;
  }
  return r;
}

template <int W>
struct EigenLanes {
  Vec3W<W> values;
  Mat3W<W> axes;  // columns
};

// One rotation of Jacobi's that makes a_pq zero; r is the third row.
template <int W>
GYRE_INLINE void jacobi_rotate(Wide<W>& app, Wide<W>& aqq, Wide<W>& apq, Wide<W>& arp, Wide<W>& arq,
                               Vec3W<W>& vp, Vec3W<W>& vq) {
  const Wide<W> half = 0.5f * (aqq - app);
  // tan = apq / (half + sign(half) sqrt(half^2 + apq^2)), without division where apq is zero
  const Wide<W> reach = half + copy_sign(sqrt(half * half + apq * apq), half);
  const Wide<W> t = keep(reach != 0.0f, apq / reach);
  const Wide<W> c = 1.0f / sqrt(1.0f + t * t), s = t * c;
  app = app - t * apq;
  aqq = aqq + t * apq;
  apq = Wide<W>(0.0f);
  const Wide<W> rp = arp, rq = arq;
  arp = c * rp - s * rq;
  arq = s * rp + c * rq;
  const Vec3W<W> p = vp, q = vq;
  vp = c * p - s * q;
  vq = s * p + c * q;
}

template <int W>
GYRE_INLINE EigenLanes<W> symmetric_eigen_lanes(Sym3W<W> a) {
  EigenLanes<W> out;
  const Wide<W> one(1.0f), zero(0.0f);
  out.axes = {{one, zero, zero}, {zero, one, zero}, {zero, zero, one}};
  GYRE_ROLLED
  for (int sweep = 0; sweep < 4; ++sweep) {
    jacobi_rotate(a.xx, a.yy, a.xy, a.xz, a.yz, out.axes.x, out.axes.y);
    jacobi_rotate(a.xx, a.zz, a.xz, a.xy, a.yz, out.axes.x, out.axes.z);
    jacobi_rotate(a.yy, a.zz, a.yz, a.xy, a.xz, out.axes.y, out.axes.z);
  }
  out.values = {a.xx, a.yy, a.zz};
  return out;
}

// The matrix with its negative eigenvalues made zero.
template <int W>
GYRE_INLINE Sym3W<W> without_negative_part(const Sym3W<W>& a) {
  const EigenLanes<W> eigen = symmetric_eigen_lanes(a);
  return rotate_moments(eigen.axes, max(eigen.values, Vec3W<W>{0.0f, 0.0f, 0.0f}));
}

}  // namespace GYRE_TARGET_NAMESPACE
}  // namespace gyre
