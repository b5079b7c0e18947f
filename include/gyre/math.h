// The value types of Gyre's mathematics, for users and for every part of the engine.
//
// Conventions: SI units, right-handed frames, y up; quaternions are (x, y, z, w) with w the scalar part; matrices act on column vectors.
// A rotation or pose is named after its two frames: `world_from_body` takes body coordinates to world coordinates, so
// world_from_body * body_from_shape = world_from_shape.
//
// World positions are double (DVec3), positions relative to a body are float (Vec3). The difference of two world positions is float, and
// precise however far from the origin both are: one build serves a world 1,000 km wide.
//
// Source of the formulas: H. Goldstein, "Classical Mechanics"; J. Diebel, "Representing Attitude" (2006).
#pragma once

#include <cmath>
#include <cstdint>

namespace gyre {

constexpr float kPi = 3.14159265358979323846f;
constexpr double kPiDouble = 3.14159265358979323846;

// Smaller and larger of two numbers, defined the same on every backend: `a < b ? a : b`.
template <class T>
constexpr T min(T a, T b) {
  return a < b ? a : b;
}
template <class T>
constexpr T max(T a, T b) {
  return a > b ? a : b;
}
template <class T>
constexpr T clamp(T value, T low, T high) {
  return min(max(value, low), high);
}
template <class T>
constexpr T square(T value) {
  return value * value;
}
constexpr float absolute(float value) { return value < 0.0f ? -value : value; }
constexpr double absolute(double value) { return value < 0.0 ? -value : value; }

// ---------------------------------------------------------------------------------------------------------- vectors

// Three floats: a direction, a velocity, or a point measured from a body.
struct Vec3 {
  float x = 0.0f;
  float y = 0.0f;
  float z = 0.0f;

  constexpr float operator[](int axis) const { return axis == 0 ? x : axis == 1 ? y : z; }
  constexpr bool operator==(const Vec3&) const = default;
};

constexpr Vec3 operator+(Vec3 a, Vec3 b) { return {a.x + b.x, a.y + b.y, a.z + b.z}; }
constexpr Vec3 operator-(Vec3 a, Vec3 b) { return {a.x - b.x, a.y - b.y, a.z - b.z}; }
constexpr Vec3 operator-(Vec3 a) { return {-a.x, -a.y, -a.z}; }
constexpr Vec3 operator*(float s, Vec3 a) { return {s * a.x, s * a.y, s * a.z}; }
constexpr Vec3 operator*(Vec3 a, float s) { return {s * a.x, s * a.y, s * a.z}; }
constexpr Vec3 operator/(Vec3 a, float s) { return {a.x / s, a.y / s, a.z / s}; }
constexpr Vec3& operator+=(Vec3& a, Vec3 b) { return a = a + b; }
constexpr Vec3& operator-=(Vec3& a, Vec3 b) { return a = a - b; }
constexpr Vec3& operator*=(Vec3& a, float s) { return a = s * a; }
constexpr float dot(Vec3 a, Vec3 b) { return a.x * b.x + a.y * b.y + a.z * b.z; }
constexpr Vec3 cross(Vec3 a, Vec3 b) {
  return {a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x};
}
constexpr Vec3 multiply_each(Vec3 a, Vec3 b) { return {a.x * b.x, a.y * b.y, a.z * b.z}; }
constexpr Vec3 min(Vec3 a, Vec3 b) { return {min(a.x, b.x), min(a.y, b.y), min(a.z, b.z)}; }
constexpr Vec3 max(Vec3 a, Vec3 b) { return {max(a.x, b.x), max(a.y, b.y), max(a.z, b.z)}; }
constexpr Vec3 absolute(Vec3 a) { return {absolute(a.x), absolute(a.y), absolute(a.z)}; }
constexpr float length_squared(Vec3 a) { return dot(a, a); }
inline float length(Vec3 a) { return std::sqrt(dot(a, a)); }
inline float distance(Vec3 a, Vec3 b) { return length(a - b); }
constexpr float largest(Vec3 a) { return max(a.x, max(a.y, a.z)); }
constexpr float smallest(Vec3 a) { return min(a.x, min(a.y, a.z)); }
constexpr Vec3 lerp(Vec3 a, Vec3 b, float t) { return a + t * (b - a); }

// `a` scaled to length 1; `otherwise` if `a` is too short to have a direction.
inline Vec3 normalized(Vec3 a, Vec3 otherwise = {1.0f, 0.0f, 0.0f}) {
  // Scaled by its largest part first, so that neither tiny nor huge vectors under- or overflow when squared.
  const float scale = largest(absolute(a));
  if (!(scale > 1.0e-37f)) return otherwise;
  const Vec3 b = a / scale;
  return b / length(b);
}

// A unit vector perpendicular to the unit vector `a`.
inline Vec3 any_perpendicular(Vec3 a) {
  const Vec3 other = absolute(a.x) < 0.57735f ? Vec3{1, 0, 0} : (absolute(a.y) < 0.57735f ? Vec3{0, 1, 0} : Vec3{0, 0, 1});
  return normalized(cross(a, other));
}

// Three doubles: a position in the world, in metres.
struct DVec3 {
  double x = 0.0;
  double y = 0.0;
  double z = 0.0;

  constexpr DVec3() = default;
  constexpr DVec3(double x_, double y_, double z_) : x(x_), y(y_), z(z_) {}
  constexpr explicit DVec3(Vec3 a) : x(double(a.x)), y(double(a.y)), z(double(a.z)) {}

  constexpr double operator[](int axis) const { return axis == 0 ? x : axis == 1 ? y : z; }
  constexpr bool operator==(const DVec3&) const = default;
};

constexpr DVec3 operator+(DVec3 a, DVec3 b) { return {a.x + b.x, a.y + b.y, a.z + b.z}; }
constexpr DVec3 operator-(DVec3 a, DVec3 b) { return {a.x - b.x, a.y - b.y, a.z - b.z}; }
constexpr DVec3 operator-(DVec3 a) { return {-a.x, -a.y, -a.z}; }
constexpr DVec3 operator*(double s, DVec3 a) { return {s * a.x, s * a.y, s * a.z}; }
constexpr DVec3 operator/(DVec3 a, double s) { return {a.x / s, a.y / s, a.z / s}; }
constexpr DVec3 operator+(DVec3 a, Vec3 b) { return {a.x + double(b.x), a.y + double(b.y), a.z + double(b.z)}; }
constexpr DVec3 operator-(DVec3 a, Vec3 b) { return {a.x - double(b.x), a.y - double(b.y), a.z - double(b.z)}; }
constexpr DVec3& operator+=(DVec3& a, DVec3 b) { return a = a + b; }
constexpr DVec3& operator+=(DVec3& a, Vec3 b) { return a = a + b; }
constexpr double dot(DVec3 a, DVec3 b) { return a.x * b.x + a.y * b.y + a.z * b.z; }
constexpr DVec3 cross(DVec3 a, DVec3 b) {
  return {a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x};
}
constexpr double length_squared(DVec3 a) { return dot(a, a); }
inline double length(DVec3 a) { return std::sqrt(dot(a, a)); }
constexpr Vec3 to_float(DVec3 a) { return {float(a.x), float(a.y), float(a.z)}; }
// The vector from position `from` to position `to`: subtracted in double, then rounded to float.
constexpr Vec3 difference(DVec3 to, DVec3 from) { return to_float(to - from); }

inline bool is_finite(float a) { return a - a == 0.0f; }
inline bool is_finite(double a) { return a - a == 0.0; }
inline bool is_finite(Vec3 a) { return is_finite(a.x) && is_finite(a.y) && is_finite(a.z); }
inline bool is_finite(DVec3 a) { return is_finite(a.x) && is_finite(a.y) && is_finite(a.z); }

// --------------------------------------------------------------------------------------------------------- matrices

// A 3x3 matrix by columns: (x, y, z) are the images of the three axes.
struct Mat3 {
  Vec3 x{1, 0, 0};
  Vec3 y{0, 1, 0};
  Vec3 z{0, 0, 1};

  constexpr bool operator==(const Mat3&) const = default;
};

constexpr Vec3 operator*(const Mat3& m, Vec3 v) { return v.x * m.x + v.y * m.y + v.z * m.z; }
constexpr Mat3 operator*(const Mat3& a, const Mat3& b) { return {a * b.x, a * b.y, a * b.z}; }
constexpr Mat3 operator+(const Mat3& a, const Mat3& b) { return {a.x + b.x, a.y + b.y, a.z + b.z}; }
constexpr Mat3 operator-(const Mat3& a, const Mat3& b) { return {a.x - b.x, a.y - b.y, a.z - b.z}; }
constexpr Mat3 operator*(float s, const Mat3& m) { return {s * m.x, s * m.y, s * m.z}; }
constexpr Mat3 transpose(const Mat3& m) {
  return {{m.x.x, m.y.x, m.z.x}, {m.x.y, m.y.y, m.z.y}, {m.x.z, m.y.z, m.z.z}};
}
// transpose(m) * v without building the transpose.
constexpr Vec3 transpose_times(const Mat3& m, Vec3 v) { return {dot(m.x, v), dot(m.y, v), dot(m.z, v)}; }
constexpr float determinant(const Mat3& m) { return dot(m.x, cross(m.y, m.z)); }
// The matrix of v -> cross(a, v).
constexpr Mat3 skew(Vec3 a) { return {{0, a.z, -a.y}, {-a.z, 0, a.x}, {a.y, -a.x, 0}}; }
constexpr Mat3 diagonal(Vec3 d) { return {{d.x, 0, 0}, {0, d.y, 0}, {0, 0, d.z}}; }
// The inverse by cofactors; the zero matrix if `m` is singular.
constexpr Mat3 inverse(const Mat3& m) {
  const Vec3 yz = cross(m.y, m.z);
  const float det = dot(m.x, yz);
  if (det == 0.0f) return {{0, 0, 0}, {0, 0, 0}, {0, 0, 0}};
  const float s = 1.0f / det;
  return transpose({s * yz, s * cross(m.z, m.x), s * cross(m.x, m.y)});
}

// A symmetric 3x3 matrix, as an inertia tensor is: [xx, yy, zz, xy, xz, yz].
struct Sym3 {
  float xx = 0.0f;
  float yy = 0.0f;
  float zz = 0.0f;
  float xy = 0.0f;
  float xz = 0.0f;
  float yz = 0.0f;

  constexpr bool operator==(const Sym3&) const = default;
};

constexpr Vec3 operator*(const Sym3& m, Vec3 v) {
  return {m.xx * v.x + m.xy * v.y + m.xz * v.z, m.xy * v.x + m.yy * v.y + m.yz * v.z,
          m.xz * v.x + m.yz * v.y + m.zz * v.z};
}
constexpr Sym3 operator+(const Sym3& a, const Sym3& b) {
  return {a.xx + b.xx, a.yy + b.yy, a.zz + b.zz, a.xy + b.xy, a.xz + b.xz, a.yz + b.yz};
}
constexpr Sym3 operator-(const Sym3& a, const Sym3& b) {
  return {a.xx - b.xx, a.yy - b.yy, a.zz - b.zz, a.xy - b.xy, a.xz - b.xz, a.yz - b.yz};
}
constexpr Sym3 operator*(float s, const Sym3& m) {
  return {s * m.xx, s * m.yy, s * m.zz, s * m.xy, s * m.xz, s * m.yz};
}
constexpr Mat3 to_matrix(const Sym3& m) { return {{m.xx, m.xy, m.xz}, {m.xy, m.yy, m.yz}, {m.xz, m.yz, m.zz}}; }
// The symmetric part of `m`.
constexpr Sym3 to_symmetric(const Mat3& m) {
  return {m.x.x,
          m.y.y,
          m.z.z,
          0.5f * (m.x.y + m.y.x),
          0.5f * (m.x.z + m.z.x),
          0.5f * (m.y.z + m.z.y)};
}
// A power of two that scales a matrix with this largest diagonal element before its determinant is computed, since the determinant of a
// millimetre's or a kilometre's inertia is out of a float's range. Powers of two change no digit.
constexpr float inverse_scale(float largest) {
  if (largest > 0x1p30f) return largest > 0x1p70f ? 0x1p-100f : 0x1p-50f;
  if (largest < 0x1p-30f) return largest < 0x1p-70f ? 0x1p100f : 0x1p50f;
  return 1.0f;
}
// The inverse; the zero matrix if it is singular.
constexpr Sym3 inverse(const Sym3& matrix) {
  const float a = matrix.xx < 0.0f ? -matrix.xx : matrix.xx, b = matrix.yy < 0.0f ? -matrix.yy : matrix.yy;
  const float c = matrix.zz < 0.0f ? -matrix.zz : matrix.zz;
  const float scale = inverse_scale(max(a, max(b, c)));
  const Sym3 m = scale * matrix;
  const float cxx = m.yy * m.zz - m.yz * m.yz;
  const float cxy = m.xz * m.yz - m.xy * m.zz;
  const float cxz = m.xy * m.yz - m.xz * m.yy;
  const float det = m.xx * cxx + m.xy * cxy + m.xz * cxz;
  if (det == 0.0f) return {};
  const float s = scale / det;
  return {s * cxx,
          s * (m.xx * m.zz - m.xz * m.xz),
          s * (m.xx * m.yy - m.xy * m.xy),
          s * cxy,
          s * cxz,
          s * (m.xy * m.xz - m.xx * m.yz)};
}

// ------------------------------------------------------------------------------------------------------ orientation

// A unit quaternion: an orientation or a rotation. q and -q are the same rotation.
struct Quat {
  float x = 0.0f;
  float y = 0.0f;
  float z = 0.0f;
  float w = 1.0f;

  constexpr bool operator==(const Quat&) const = default;
};

constexpr Quat operator*(Quat a, Quat b) {
  return {a.w * b.x + a.x * b.w + a.y * b.z - a.z * b.y, a.w * b.y - a.x * b.z + a.y * b.w + a.z * b.x,
          a.w * b.z + a.x * b.y - a.y * b.x + a.z * b.w, a.w * b.w - a.x * b.x - a.y * b.y - a.z * b.z};
}
constexpr Quat conjugate(Quat q) { return {-q.x, -q.y, -q.z, q.w}; }
constexpr Quat operator-(Quat q) { return {-q.x, -q.y, -q.z, -q.w}; }
constexpr float dot(Quat a, Quat b) { return a.x * b.x + a.y * b.y + a.z * b.z + a.w * b.w; }
inline bool is_finite(Quat q) { return is_finite(q.x) && is_finite(q.y) && is_finite(q.z) && is_finite(q.w); }
// `q` scaled to length 1; no rotation if `q` is zero.
inline Quat normalized(Quat q) {
  const float n = std::sqrt(dot(q, q));
  if (!(n > 0.0f)) return {};
  return {q.x / n, q.y / n, q.z / n, q.w / n};
}
// The vector `v` rotated by `q`.
constexpr Vec3 rotate(Quat q, Vec3 v) {
  const Vec3 u{q.x, q.y, q.z};
  const Vec3 t = 2.0f * cross(u, v);
  return v + q.w * t + cross(u, t);
}
// The vector `v` rotated by the inverse of `q`.
constexpr Vec3 rotate_inverse(Quat q, Vec3 v) { return rotate(conjugate(q), v); }

// The rotation matrix of `q`; its columns are the rotated axes.
constexpr Mat3 to_matrix(Quat q) {
  const float x2 = q.x + q.x, y2 = q.y + q.y, z2 = q.z + q.z;
  const float xx = q.x * x2, yy = q.y * y2, zz = q.z * z2;
  const float xy = q.x * y2, xz = q.x * z2, yz = q.y * z2;
  const float wx = q.w * x2, wy = q.w * y2, wz = q.w * z2;
  return {{1.0f - (yy + zz), xy + wz, xz - wy}, {xy - wz, 1.0f - (xx + zz), yz + wx}, {xz + wy, yz - wx, 1.0f - (xx + yy)}};
}

// Declared here, computed with Gyre's own trigonometry (the same bits on every platform) in math/rotation.cpp.
// The rotation by `angle` (rad) about `axis` (any length but zero; no rotation if it is zero).
Quat from_axis_angle(Vec3 axis, float angle);
// The rotation whose rotation vector (axis times angle in rad) is `v`: the exponential map.
Quat from_rotation_vector(Vec3 v);
// The rotation vector of `q`, of length at most pi: the logarithm.
Vec3 to_rotation_vector(Quat q);
// The quaternion of a rotation matrix (columns orthonormal, right-handed). S. W. Shepperd, 1978.
Quat from_matrix(const Mat3& m);
// The shortest rotation from direction `from` to direction `to` (unit vectors).
Quat from_directions(Vec3 from, Vec3 to);
// Interpolation along the shortest great arc, t from 0 to 1.
Quat slerp(Quat a, Quat b, float t);

// The order of three intrinsic rotations: each is about an axis of the body, which rotates with the body.
enum class EulerOrder : std::uint8_t { xyz, xzy, yxz, yzx, zxy, zyx };
// Three Euler (Tait-Bryan) angles in rad, in the order of `order`: for xyz, R = Rx(first) Ry(second) Rz(third).
struct EulerAngles {
  float first = 0.0f;
  float second = 0.0f;
  float third = 0.0f;
  EulerOrder order = EulerOrder::xyz;
};
Quat from_euler(EulerAngles angles);
// The Euler angles of `q`: second within [-pi/2, pi/2]; at gimbal lock third is 0.
EulerAngles to_euler(Quat q, EulerOrder order = EulerOrder::xyz);
// The sine and cosine of `radians`, within 0.501 units in the last place for every finite angle; the same bits everywhere.
struct SinCos {
  float sin;
  float cos;
};
SinCos sin_cos(float radians);
// The angle of the point (x, y) in rad, in [-pi, pi]; a zero y counts as +0, and (0, 0) gives 0.
float atan2(float y, float x);
// The angle in [0, pi] whose cosine is `x` (clamped to [-1, 1]).
float acos(float x);

// -------------------------------------------------------------------------------------------------------- transforms

// A rigid transform in float, between frames close to each other: p -> rotate(orientation, p) + position.
struct Transform {
  Vec3 position{};
  Quat orientation{};

  constexpr bool operator==(const Transform&) const = default;
};

constexpr Vec3 operator*(const Transform& t, Vec3 p) { return rotate(t.orientation, p) + t.position; }
constexpr Transform operator*(const Transform& a, const Transform& b) {
  return {rotate(a.orientation, b.position) + a.position, a.orientation * b.orientation};
}
constexpr Transform inverse(const Transform& t) {
  return {rotate_inverse(t.orientation, -t.position), conjugate(t.orientation)};
}
// The transform's inverse applied to `p`.
constexpr Vec3 inverse_times(const Transform& t, Vec3 p) { return rotate_inverse(t.orientation, p - t.position); }
// inverse(a) * b.
constexpr Transform inverse_times(const Transform& a, const Transform& b) {
  return {rotate_inverse(a.orientation, b.position - a.position), conjugate(a.orientation) * b.orientation};
}

// A position and an orientation in the world: world_from_body.
struct Pose {
  DVec3 position{};
  Quat orientation{};

  constexpr bool operator==(const Pose&) const = default;
};

constexpr DVec3 operator*(const Pose& pose, Vec3 p) { return pose.position + rotate(pose.orientation, p); }
constexpr Pose operator*(const Pose& pose, const Transform& t) {
  return {pose.position + rotate(pose.orientation, t.position), pose.orientation * t.orientation};
}
// The world position `p` in the frame of `pose`.
constexpr Vec3 inverse_times(const Pose& pose, DVec3 p) {
  return rotate_inverse(pose.orientation, difference(p, pose.position));
}
// Pose `b` relative to pose `a`: a_from_b. Float, and precise near `a` however far both are from the origin.
constexpr Transform inverse_times(const Pose& a, const Pose& b) {
  return {rotate_inverse(a.orientation, difference(b.position, a.position)), conjugate(a.orientation) * b.orientation};
}
inline bool is_finite(const Pose& pose) { return is_finite(pose.position) && is_finite(pose.orientation); }
inline bool is_finite(const Transform& t) { return is_finite(t.position) && is_finite(t.orientation); }

// A 4x4 matrix for renderers: 16 floats, column after column; the translation is in elements 12 to 14.
struct Mat4 {
  float elements[16] = {1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1};
};
// The model matrix of a pose relative to `origin` (usually the camera, so that large worlds keep their precision). The model is scaled by
// `scale` first.
Mat4 model_matrix(const Pose& pose, DVec3 origin = {}, Vec3 scale = {1.0f, 1.0f, 1.0f});

// ------------------------------------------------------------------------------------------------------------ boxes

// An axis-aligned box from corner `low` to corner `high`, in the frame of its owner.
struct Aabb {
  Vec3 low{};
  Vec3 high{};

  constexpr bool operator==(const Aabb&) const = default;
};

constexpr Vec3 center(const Aabb& box) { return 0.5f * (box.low + box.high); }
constexpr Vec3 half_size(const Aabb& box) { return 0.5f * (box.high - box.low); }
constexpr bool overlap(const Aabb& a, const Aabb& b) {
  return a.low.x <= b.high.x && b.low.x <= a.high.x && a.low.y <= b.high.y && b.low.y <= a.high.y &&
         a.low.z <= b.high.z && b.low.z <= a.high.z;
}
constexpr bool contains(const Aabb& outer, const Aabb& inner) {
  return outer.low.x <= inner.low.x && outer.low.y <= inner.low.y && outer.low.z <= inner.low.z &&
         inner.high.x <= outer.high.x && inner.high.y <= outer.high.y && inner.high.z <= outer.high.z;
}
constexpr Aabb merge(const Aabb& a, const Aabb& b) { return {min(a.low, b.low), max(a.high, b.high)}; }
constexpr Aabb grow(const Aabb& box, float margin) {
  const Vec3 m{margin, margin, margin};
  return {box.low - m, box.high + m};
}
// Half the surface area: the cost measure of bounding volume trees.
constexpr float half_area(const Aabb& box) {
  const Vec3 d = box.high - box.low;
  return d.x * d.y + d.y * d.z + d.z * d.x;
}

}  // namespace gyre
