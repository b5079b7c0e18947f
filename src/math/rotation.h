// Rotations beyond the value types of <gyre/math.h>: rotated inertia tensors, orientations moved along a rotation
// vector, and double twins for integrators of freely spinning bodies. In: unit quaternions and matrices; out: the same,
// never with library trigonometry.
//
// Sources: H. Goldstein, "Classical Mechanics"; J. Diebel, "Representing Attitude" (2006); S. W. Shepperd, "Quaternion
// from Rotation Matrix" (1978); K. Shoemake, "Animating Rotation with Quaternion Curves" (1985); F. S. Grassia,
// "Practical Parameterization of Rotations Using the Exponential Map" (1998).
#pragma once

#include <gyre/math.h>

namespace gyre {

// ---------------------------------------------------------------------------------------------------------- inertia

// R I R^T: the tensor `inertia` rotated by `rotation`. Exactly symmetric by construction.
constexpr Sym3 rotate_inertia(const Mat3& rotation, const Sym3& inertia) {
  const Mat3& r = rotation;
  // The columns of R I; the result's element (i, j) is row i of it times row j of R.
  const Vec3 a = r.x * inertia.xx + r.y * inertia.xy + r.z * inertia.xz;
  const Vec3 b = r.x * inertia.xy + r.y * inertia.yy + r.z * inertia.yz;
  const Vec3 c = r.x * inertia.xz + r.y * inertia.yz + r.z * inertia.zz;
  return {a.x * r.x.x + b.x * r.y.x + c.x * r.z.x, a.y * r.x.y + b.y * r.y.y + c.y * r.z.y,
          a.z * r.x.z + b.z * r.y.z + c.z * r.z.z, a.x * r.x.y + b.x * r.y.y + c.x * r.z.y,
          a.x * r.x.z + b.x * r.y.z + c.x * r.z.z, a.y * r.x.z + b.y * r.y.z + c.y * r.z.z};
}
constexpr Sym3 rotate_inertia(Quat rotation, const Sym3& inertia) {
  return rotate_inertia(to_matrix(rotation), inertia);
}
// R diag(moments) R^T.
constexpr Sym3 rotate_moments(const Mat3& rotation, Vec3 moments) {
  const Mat3& r = rotation;
  const Vec3 a = moments.x * r.x, b = moments.y * r.y, c = moments.z * r.z;
  return {a.x * r.x.x + b.x * r.y.x + c.x * r.z.x, a.y * r.x.y + b.y * r.y.y + c.y * r.z.y,
          a.z * r.x.z + b.z * r.y.z + c.z * r.z.z, a.x * r.x.y + b.x * r.y.y + c.x * r.z.y,
          a.x * r.x.z + b.x * r.y.z + c.x * r.z.z, a.y * r.x.z + b.y * r.y.z + c.y * r.z.z};
}
constexpr Sym3 rotate_moments(Quat rotation, Vec3 moments) {
  return rotate_moments(to_matrix(rotation), moments);
}
// The local tensor diag(moments), applied to a world vector.
constexpr Vec3 world_tensor_times(Quat world_from_local, Vec3 moments, Vec3 v) {
  return rotate(world_from_local, multiply_each(moments, rotate_inverse(world_from_local, v)));
}
// The inertia of a point mass, mass (|r|^2 - r r^T): the term of the parallel axis theorem.
constexpr Sym3 point_inertia(float mass, Vec3 r) {
  return {mass * (r.y * r.y + r.z * r.z),
          mass * (r.x * r.x + r.z * r.z),
          mass * (r.x * r.x + r.y * r.y),
          -mass * r.x * r.y,
          -mass * r.x * r.z,
          -mass * r.y * r.z};
}

// ----------------------------------------------------------------------------------------------------- orientations

// `orientation` rotated by the world rotation vector `rotation` (rad): from_rotation_vector(rotation) * orientation at
// length 1. Computed in double and rounded once, so that rotations far below a float's resolution add up without bias.
Quat integrate_rotation(Quat orientation, Vec3 rotation);

// The shortest rotation vector from `from` to `to`, in the frame of both: from_rotation_vector(v) * from = to.
Vec3 rotation_between(Quat from, Quat to);

// ---------------------------------------------------------------------------------------------------- double twins

// A unit quaternion in double, for integrators that must conserve energy and momentum over many revolutions.
struct DQuat {
  double x = 0.0;
  double y = 0.0;
  double z = 0.0;
  double w = 1.0;

  constexpr bool operator==(const DQuat&) const = default;
};

constexpr DQuat to_double(Quat q) { return {double(q.x), double(q.y), double(q.z), double(q.w)}; }
constexpr Quat to_float(DQuat q) { return {float(q.x), float(q.y), float(q.z), float(q.w)}; }
constexpr DQuat operator*(DQuat a, DQuat b) {
  return {a.w * b.x + a.x * b.w + a.y * b.z - a.z * b.y, a.w * b.y - a.x * b.z + a.y * b.w + a.z * b.x,
          a.w * b.z + a.x * b.y - a.y * b.x + a.z * b.w, a.w * b.w - a.x * b.x - a.y * b.y - a.z * b.z};
}
constexpr DQuat conjugate(DQuat q) { return {-q.x, -q.y, -q.z, q.w}; }
constexpr double dot(DQuat a, DQuat b) { return a.x * b.x + a.y * b.y + a.z * b.z + a.w * b.w; }
// `q` scaled to length 1; no rotation if `q` is zero.
inline DQuat normalized(DQuat q) {
  const double square = dot(q, q);
  if (square == 0.0) return {};
  const double scale = 1.0 / std::sqrt(square);
  return {q.x * scale, q.y * scale, q.z * scale, q.w * scale};
}
constexpr DVec3 rotate(DQuat q, DVec3 v) {
  const DVec3 u{q.x, q.y, q.z};
  const DVec3 t = 2.0 * cross(u, v);
  return v + q.w * t + cross(u, t);
}
constexpr DVec3 rotate_inverse(DQuat q, DVec3 v) { return rotate(conjugate(q), v); }
// The rotation whose rotation vector (rad) is `v`.
DQuat exponential_map(DVec3 v);
// The rotation vector of `q`, of length at most pi.
DVec3 logarithm_map(DQuat q);

}  // namespace gyre
