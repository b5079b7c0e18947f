// Vectors, quaternions and random numbers of the benchmark scenes: double, and nobody's but theirs, so that no engine judges itself.
#pragma once

#include <cmath>
#include <cstdint>

namespace gyre::bench {

struct V3 {
  double x = 0, y = 0, z = 0;
};
inline V3 operator+(V3 a, V3 b) { return {a.x + b.x, a.y + b.y, a.z + b.z}; }
inline V3 operator-(V3 a, V3 b) { return {a.x - b.x, a.y - b.y, a.z - b.z}; }
inline V3 operator*(double s, V3 a) { return {s * a.x, s * a.y, s * a.z}; }
inline V3 operator-(V3 a) { return {-a.x, -a.y, -a.z}; }
inline double dot(V3 a, V3 b) { return a.x * b.x + a.y * b.y + a.z * b.z; }
inline V3 cross(V3 a, V3 b) { return {a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x}; }
inline double len(V3 a) { return std::sqrt(dot(a, a)); }
inline V3 unit(V3 a) {
  double l = len(a);
  return l > 0 ? (1.0 / l) * a : V3{1, 0, 0};
}

struct Quat {
  double x = 0, y = 0, z = 0, w = 1;
};
inline Quat operator*(Quat a, Quat b) {
  return {a.w * b.x + a.x * b.w + a.y * b.z - a.z * b.y, a.w * b.y - a.x * b.z + a.y * b.w + a.z * b.x,
          a.w * b.z + a.x * b.y - a.y * b.x + a.z * b.w, a.w * b.w - a.x * b.x - a.y * b.y - a.z * b.z};
}
inline Quat conj(Quat q) { return {-q.x, -q.y, -q.z, q.w}; }
inline V3 rot(Quat q, V3 v) {
  V3 u{q.x, q.y, q.z};
  V3 t = 2.0 * cross(u, v);
  return v + q.w * t + cross(u, t);
}
inline Quat axis_angle(V3 a, double t) {
  a = unit(a);
  double s = std::sin(0.5 * t);
  return {s * a.x, s * a.y, s * a.z, std::cos(0.5 * t)};
}
inline Quat normalized(Quat q) {
  double l = std::sqrt(q.x * q.x + q.y * q.y + q.z * q.z + q.w * q.w);
  return {q.x / l, q.y / l, q.z / l, q.w / l};
}
// The rotation that takes the three unit axes to x, y and z (right-handed, orthonormal).
inline Quat from_axes(V3 x, V3 y, V3 z) {
  double m00 = x.x, m10 = x.y, m20 = x.z, m01 = y.x, m11 = y.y, m21 = y.z, m02 = z.x, m12 = z.y, m22 = z.z;
  double t = m00 + m11 + m22;
  Quat q;
  if (t > 0) {
    double s = 2 * std::sqrt(t + 1);
    q = {(m21 - m12) / s, (m02 - m20) / s, (m10 - m01) / s, 0.25 * s};
  } else if (m00 > m11 && m00 > m22) {
    double s = 2 * std::sqrt(1 + m00 - m11 - m22);
    q = {0.25 * s, (m01 + m10) / s, (m02 + m20) / s, (m21 - m12) / s};
  } else if (m11 > m22) {
    double s = 2 * std::sqrt(1 + m11 - m00 - m22);
    q = {(m01 + m10) / s, 0.25 * s, (m12 + m21) / s, (m02 - m20) / s};
  } else {
    double s = 2 * std::sqrt(1 + m22 - m00 - m11);
    q = {(m02 + m20) / s, (m12 + m21) / s, 0.25 * s, (m10 - m01) / s};
  }
  return normalized(q);
}
inline V3 any_perpendicular(V3 a) {
  return unit(std::fabs(a.x) < 0.6 ? cross(a, V3{1, 0, 0}) : cross(a, V3{0, 1, 0}));
}

struct Pose {
  V3 p;
  Quat q;
};
inline V3 apply(const Pose& t, V3 v) { return t.p + rot(t.q, v); }
inline V3 apply_inverse(const Pose& t, V3 v) { return rot(conj(t.q), v - t.p); }

// A fixed linear congruential generator, so that every engine sees the same numbers.
struct Lcg {
  uint64_t s;
  explicit Lcg(uint64_t seed) : s(seed * 2862933555777941757ULL + 3037000493ULL) {}
  double next() {
    s = s * 6364136223846793005ULL + 1442695040888963407ULL;
    return double(s >> 11) * (1.0 / 9007199254740992.0);
  }
  double range(double a, double b) { return a + (b - a) * next(); }
  int index(int n) { return int(next() * n) % n; }
  V3 dir() {
    for (;;) {
      V3 v{range(-1, 1), range(-1, 1), range(-1, 1)};
      double l = len(v);
      if (l > 0.1 && l < 1.0) return (1 / l) * v;
    }
  }
  Quat rotation() {
    V3 a = dir();
    return axis_angle(a, range(-3.14159265358979, 3.14159265358979));
  }
};

}  // namespace gyre::bench
