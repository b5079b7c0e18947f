// Vectors, quaternions and matrices of Wide<W> numbers, with the operations of <gyre/math.h> in the same order of
// roundings, so that lane i has exactly the bits of the scalar operation. Also gather and scatter by index between
// lanes and records of 16 floats (64 bytes: one cache line, one body).
//
// Sources: the formulas are those of <gyre/math.h>; transposition of 4x4 blocks by unpacking pairs is folklore of every
// SIMD manual.
#pragma once

#include "math/wide.h"

namespace gyre {
inline namespace GYRE_TARGET_NAMESPACE {

// ------------------------------------------------------------------------------------------------------------- vectors

template <int W>
struct Vec3W {
  Wide<W> x, y, z;
};

// The vector `v` (anything with x, y, z) in every lane.
template <int W, class Vector>
GYRE_INLINE Vec3W<W> splat(const Vector& v) {
  return {v.x, v.y, v.z};
}
// Four vectors, one in each lane.
template <class Vector>
GYRE_INLINE Vec3W<4> side_by_side(const Vector& a, const Vector& b, const Vector& c, const Vector& d) {
  // Without an array, which GCC would build on the stack element by element.
  typedef float Quad __attribute__((vector_size(16)));
  return {Wide<4>::of(Quad{a.x, b.x, c.x, d.x}), Wide<4>::of(Quad{a.y, b.y, c.y, d.y}),
          Wide<4>::of(Quad{a.z, b.z, c.z, d.z})};
}
// Eight lanes from two times four.
GYRE_INLINE Wide<8> join(Wide<4> low, Wide<4> high) {
  return Wide<8>::of(__builtin_shufflevector(low.v, high.v, 0, 1, 2, 3, 4, 5, 6, 7));
}
GYRE_INLINE Vec3W<8> join(Vec3W<4> low, Vec3W<4> high) {
  return {join(low.x, high.x), join(low.y, high.y), join(low.z, high.z)};
}
template <int W>
GYRE_INLINE Vec3W<W> operator+(Vec3W<W> a, Vec3W<W> b) {
  return {a.x + b.x, a.y + b.y, a.z + b.z};
}
template <int W>
GYRE_INLINE Vec3W<W> operator-(Vec3W<W> a, Vec3W<W> b) {
  return {a.x - b.x, a.y - b.y, a.z - b.z};
}
template <int W>
GYRE_INLINE Vec3W<W> operator-(Vec3W<W> a) {
  return {-a.x, -a.y, -a.z};
}
template <int W>
GYRE_INLINE Vec3W<W> operator*(Wide<W> s, Vec3W<W> a) {
  return {s * a.x, s * a.y, s * a.z};
}
template <int W>
GYRE_INLINE Vec3W<W> operator*(Vec3W<W> a, Wide<W> s) {
  return {s * a.x, s * a.y, s * a.z};
}
template <int W>
GYRE_INLINE Vec3W<W> operator*(float s, Vec3W<W> a) {
  return Wide<W>(s) * a;
}
template <int W>
GYRE_INLINE Vec3W<W> operator/(Vec3W<W> a, Wide<W> s) {
  return {a.x / s, a.y / s, a.z / s};
}
template <int W>
GYRE_INLINE Vec3W<W>& operator+=(Vec3W<W>& a, Vec3W<W> b) {
  return a = a + b;
}
template <int W>
GYRE_INLINE Vec3W<W>& operator-=(Vec3W<W>& a, Vec3W<W> b) {
  return a = a - b;
}
template <int W>
GYRE_INLINE Wide<W> dot(Vec3W<W> a, Vec3W<W> b) {
  return a.x * b.x + a.y * b.y + a.z * b.z;
}
template <int W>
GYRE_INLINE Vec3W<W> cross(Vec3W<W> a, Vec3W<W> b) {
  return {a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x};
}
template <int W>
GYRE_INLINE Vec3W<W> multiply_each(Vec3W<W> a, Vec3W<W> b) {
  return {a.x * b.x, a.y * b.y, a.z * b.z};
}
template <int W>
GYRE_INLINE Vec3W<W> min(Vec3W<W> a, Vec3W<W> b) {
  return {min(a.x, b.x), min(a.y, b.y), min(a.z, b.z)};
}
template <int W>
GYRE_INLINE Vec3W<W> max(Vec3W<W> a, Vec3W<W> b) {
  return {max(a.x, b.x), max(a.y, b.y), max(a.z, b.z)};
}
template <int W>
GYRE_INLINE Vec3W<W> absolute(Vec3W<W> a) {
  return {absolute(a.x), absolute(a.y), absolute(a.z)};
}
template <int W>
GYRE_INLINE Wide<W> length_squared(Vec3W<W> a) {
  return dot(a, a);
}
template <int W>
GYRE_INLINE Wide<W> length(Vec3W<W> a) {
  return sqrt(dot(a, a));
}
template <int W>
GYRE_INLINE Wide<W> largest(Vec3W<W> a) {
  return max(a.x, max(a.y, a.z));
}
template <int W>
GYRE_INLINE Wide<W> smallest(Vec3W<W> a) {
  return min(a.x, min(a.y, a.z));
}
template <int W>
GYRE_INLINE Vec3W<W> lerp(Vec3W<W> a, Vec3W<W> b, Wide<W> t) {
  return a + t * (b - a);
}
template <int W>
GYRE_INLINE Vec3W<W> select(Mask<W> mask, Vec3W<W> a, Vec3W<W> b) {
  return {select(mask, a.x, b.x), select(mask, a.y, b.y), select(mask, a.z, b.z)};
}
template <int W>
GYRE_INLINE Vec3W<W> keep(Mask<W> mask, Vec3W<W> a) {
  return {keep(mask, a.x), keep(mask, a.y), keep(mask, a.z)};
}
// `a` at length 1; `otherwise` where `a` is too short to have a direction.
template <int W>
GYRE_INLINE Vec3W<W> normalized(Vec3W<W> a, Vec3W<W> otherwise = {1.0f, 0.0f, 0.0f}) {
  const Wide<W> scale = largest(absolute(a));
  const Vec3W<W> b = a / scale;
  return select(scale > 1.0e-37f, b / length(b), otherwise);
}

// ------------------------------------------------------------------------------------------------------------ matrices

// A 3x3 matrix by columns.
template <int W>
struct Mat3W {
  Vec3W<W> x, y, z;
};

template <int W>
GYRE_INLINE Vec3W<W> operator*(const Mat3W<W>& m, Vec3W<W> v) {
  return v.x * m.x + v.y * m.y + v.z * m.z;
}
template <int W>
GYRE_INLINE Mat3W<W> operator*(const Mat3W<W>& a, const Mat3W<W>& b) {
  return {a * b.x, a * b.y, a * b.z};
}
template <int W>
GYRE_INLINE Mat3W<W> operator+(const Mat3W<W>& a, const Mat3W<W>& b) {
  return {a.x + b.x, a.y + b.y, a.z + b.z};
}
template <int W>
GYRE_INLINE Mat3W<W> transpose(const Mat3W<W>& m) {
  return {{m.x.x, m.y.x, m.z.x}, {m.x.y, m.y.y, m.z.y}, {m.x.z, m.y.z, m.z.z}};
}
template <int W>
GYRE_INLINE Vec3W<W> transpose_times(const Mat3W<W>& m, Vec3W<W> v) {
  return {dot(m.x, v), dot(m.y, v), dot(m.z, v)};
}

// A symmetric 3x3 matrix.
template <int W>
struct Sym3W {
  Wide<W> xx, yy, zz, xy, xz, yz;
};

template <int W>
GYRE_INLINE Vec3W<W> operator*(const Sym3W<W>& m, Vec3W<W> v) {
  return {m.xx * v.x + m.xy * v.y + m.xz * v.z, m.xy * v.x + m.yy * v.y + m.yz * v.z,
          m.xz * v.x + m.yz * v.y + m.zz * v.z};
}
template <int W>
GYRE_INLINE Sym3W<W> operator+(const Sym3W<W>& a, const Sym3W<W>& b) {
  return {a.xx + b.xx, a.yy + b.yy, a.zz + b.zz, a.xy + b.xy, a.xz + b.xz, a.yz + b.yz};
}
template <int W>
GYRE_INLINE Sym3W<W> operator-(const Sym3W<W>& a, const Sym3W<W>& b) {
  return {a.xx - b.xx, a.yy - b.yy, a.zz - b.zz, a.xy - b.xy, a.xz - b.xz, a.yz - b.yz};
}
template <int W>
GYRE_INLINE Sym3W<W> operator*(Wide<W> s, const Sym3W<W>& m) {
  return {s * m.xx, s * m.yy, s * m.zz, s * m.xy, s * m.xz, s * m.yz};
}
template <int W>
GYRE_INLINE Sym3W<W> select(Mask<W> mask, const Sym3W<W>& a, const Sym3W<W>& b) {
  return {select(mask, a.xx, b.xx), select(mask, a.yy, b.yy), select(mask, a.zz, b.zz),
          select(mask, a.xy, b.xy), select(mask, a.xz, b.xz), select(mask, a.yz, b.yz)};
}
// The inverse; the zero matrix where `m` is singular.
template <int W>
GYRE_INLINE Sym3W<W> inverse(const Sym3W<W>& matrix) {
  // As inverse_scale() in gyre/math.h.
  const Wide<W> largest = max(absolute(matrix.xx), max(absolute(matrix.yy), absolute(matrix.zz)));
  Wide<W> scale(1.0f);
  scale = select(largest > Wide<W>(0x1p30f), Wide<W>(0x1p-50f), scale);
  scale = select(largest > Wide<W>(0x1p70f), Wide<W>(0x1p-100f), scale);
  scale = select(largest < Wide<W>(0x1p-30f), Wide<W>(0x1p50f), scale);
  scale = select(largest < Wide<W>(0x1p-70f), Wide<W>(0x1p100f), scale);
  const Sym3W<W> m = scale * matrix;
  const Wide<W> cxx = m.yy * m.zz - m.yz * m.yz;
  const Wide<W> cxy = m.xz * m.yz - m.xy * m.zz;
  const Wide<W> cxz = m.xy * m.yz - m.xz * m.yy;
  const Wide<W> det = m.xx * cxx + m.xy * cxy + m.xz * cxz;
  const Mask<W> regular = det != 0.0f;
  const Wide<W> s = scale / det;
  return {keep(regular, s * cxx),
          keep(regular, s * (m.xx * m.zz - m.xz * m.xz)),
          keep(regular, s * (m.xx * m.yy - m.xy * m.xy)),
          keep(regular, s * cxy),
          keep(regular, s * cxz),
          keep(regular, s * (m.xy * m.xz - m.xx * m.yz))};
}

// --------------------------------------------------------------------------------------------------------- quaternions

template <int W>
struct QuatW {
  Wide<W> x, y, z, w;
};

template <int W>
GYRE_INLINE QuatW<W> operator*(QuatW<W> a, QuatW<W> b) {
  return {a.w * b.x + a.x * b.w + a.y * b.z - a.z * b.y, a.w * b.y - a.x * b.z + a.y * b.w + a.z * b.x,
          a.w * b.z + a.x * b.y - a.y * b.x + a.z * b.w, a.w * b.w - a.x * b.x - a.y * b.y - a.z * b.z};
}
template <int W>
GYRE_INLINE QuatW<W> conjugate(QuatW<W> q) {
  return {-q.x, -q.y, -q.z, q.w};
}
template <int W>
GYRE_INLINE Wide<W> dot(QuatW<W> a, QuatW<W> b) {
  return a.x * b.x + a.y * b.y + a.z * b.z + a.w * b.w;
}
template <int W>
GYRE_INLINE QuatW<W> select(Mask<W> mask, QuatW<W> a, QuatW<W> b) {
  return {select(mask, a.x, b.x), select(mask, a.y, b.y), select(mask, a.z, b.z), select(mask, a.w, b.w)};
}
// `q` at length 1; no rotation where `q` is zero.
template <int W>
GYRE_INLINE QuatW<W> normalized(QuatW<W> q) {
  const Wide<W> n = sqrt(dot(q, q));
  return select(n > 0.0f, QuatW<W>{q.x / n, q.y / n, q.z / n, q.w / n}, QuatW<W>{0.0f, 0.0f, 0.0f, 1.0f});
}
template <int W>
GYRE_INLINE Vec3W<W> rotate(QuatW<W> q, Vec3W<W> v) {
  const Vec3W<W> u{q.x, q.y, q.z};
  const Vec3W<W> t = 2.0f * cross(u, v);
  return v + q.w * t + cross(u, t);
}
template <int W>
GYRE_INLINE Vec3W<W> rotate_inverse(QuatW<W> q, Vec3W<W> v) {
  return rotate(conjugate(q), v);
}
template <int W>
GYRE_INLINE Mat3W<W> to_matrix(QuatW<W> q) {
  const Wide<W> x2 = q.x + q.x, y2 = q.y + q.y, z2 = q.z + q.z;
  const Wide<W> xx = q.x * x2, yy = q.y * y2, zz = q.z * z2;
  const Wide<W> xy = q.x * y2, xz = q.x * z2, yz = q.y * z2;
  const Wide<W> wx = q.w * x2, wy = q.w * y2, wz = q.w * z2;
  return {{1.0f - (yy + zz), xy + wz, xz - wy},
          {xy - wz, 1.0f - (xx + zz), yz + wx},
          {xz + wy, yz - wx, 1.0f - (xx + yy)}};
}
// R I R^T, as rotate_inertia of math/rotation.h.
template <int W>
GYRE_INLINE Sym3W<W> rotate_inertia(const Mat3W<W>& r, const Sym3W<W>& inertia) {
  const Vec3W<W> a = r.x * inertia.xx + r.y * inertia.xy + r.z * inertia.xz;
  const Vec3W<W> b = r.x * inertia.xy + r.y * inertia.yy + r.z * inertia.yz;
  const Vec3W<W> c = r.x * inertia.xz + r.y * inertia.yz + r.z * inertia.zz;
  return {a.x * r.x.x + b.x * r.y.x + c.x * r.z.x, a.y * r.x.y + b.y * r.y.y + c.y * r.z.y,
          a.z * r.x.z + b.z * r.y.z + c.z * r.z.z, a.x * r.x.y + b.x * r.y.y + c.x * r.z.y,
          a.x * r.x.z + b.x * r.y.z + c.x * r.z.z, a.y * r.x.z + b.y * r.y.z + c.y * r.z.z};
}
// R diag(moments) R^T, as rotate_moments of math/rotation.h.
template <int W>
GYRE_INLINE Sym3W<W> rotate_moments(const Mat3W<W>& r, Vec3W<W> moments) {
  const Vec3W<W> a = moments.x * r.x, b = moments.y * r.y, c = moments.z * r.z;
  return {a.x * r.x.x + b.x * r.y.x + c.x * r.z.x, a.y * r.x.y + b.y * r.y.y + c.y * r.z.y,
          a.z * r.x.z + b.z * r.y.z + c.z * r.z.z, a.x * r.x.y + b.x * r.y.y + c.x * r.z.y,
          a.x * r.x.z + b.x * r.y.z + c.x * r.z.z, a.y * r.x.z + b.y * r.y.z + c.y * r.z.z};
}

// Sine and cosine in float, within 2 units of the last place of 1 for |x| up to 8,000. Beyond, fewer and fewer digits
// are right, but sin^2 + cos^2 stays 1 until 10^6. Not the bits of sin_cos in <gyre/math.h>, which works in double.
// Cody and Waite's reduction by pi/2 as a sum of three, then Taylor series.
template <int W>
struct SinCosW {
  Wide<W> sin, cos;
};
template <int W>
GYRE_INLINE SinCosW<W> sin_cos(Wide<W> x) {
  // Adding 1.5 * 2^23 rounds to the nearest integer and leaves its last bits at the end of the mantissa.
  const Wide<W> shifted = x * 0.636619772f + 12582912.0f;
  const WideInt<W> quadrant = bit_pattern(shifted);
  const Wide<W> n = shifted - 12582912.0f;
  const Wide<W> r = ((x - n * 0x1.92p+0f) - n * 0x1.fb4p-12f) - n * 0x1.4442d2p-24f;
  const Wide<W> z = r * r;
  const Wide<W> sin =
      r + r * (z * (-1.0f / 6.0f + z * (1.0f / 120.0f + z * (-1.0f / 5040.0f + z * (1.0f / 362880.0f)))));
  const Wide<W> cos =
      1.0f + z * (-0.5f + z * (1.0f / 24.0f +
                               z * (-1.0f / 720.0f + z * (1.0f / 40320.0f + z * (-1.0f / 3628800.0f)))));
  const Mask<W> odd = (quadrant & 1) != 0;
  const Wide<W> s = select(odd, cos, sin), c = select(odd, sin, cos);
  // Bit 1 of the quadrant negates the sine, bit 1 of the next quadrant the cosine.
  const WideInt<W> sine_sign = (quadrant & 2) << 30, cosine_sign = ((quadrant + 1) & 2) << 30;
  return {from_bit_pattern(bit_pattern(s) ^ sine_sign), from_bit_pattern(bit_pattern(c) ^ cosine_sign)};
}

// `orientation` rotated by the world rotation vector `rotation` (rad): the float twin of integrate_rotation in
// math/rotation.h, for blocks of bodies. As exact as the rounding of the angle to float, for rotations below 10^4.
template <int W>
GYRE_INLINE QuatW<W> integrate_rotation(QuatW<W> orientation, Vec3W<W> rotation) {
  const Wide<W> z = 0.25f * dot(rotation, rotation);  // the half angle squared
  // sin(a)/a and cos(a) by their series in a^2; good to a = 1.
  Wide<W> s =
      0.5f + z * (-1.0f / 12.0f + z * (1.0f / 240.0f + z * (-1.0f / 10080.0f + z * (1.0f / 725760.0f))));
  Wide<W> c =
      1.0f + z * (-0.5f + z * (1.0f / 24.0f +
                               z * (-1.0f / 720.0f + z * (1.0f / 40320.0f + z * (-1.0f / 3628800.0f)))));
  // Fast spins use sin_cos, each lane by its own angle alone, so that its neighbours cannot change its bits.
  const Mask<W> fast = z > 1.0f;
  if (any(fast)) {
    const Wide<W> half = sqrt(select(fast, z, Wide<W>(1.0f)));
    const SinCosW<W> exact = sin_cos(half);
    s = select(fast, 0.5f * exact.sin / half, s);
    c = select(fast, exact.cos, c);
  }
  const QuatW<W> q{s * rotation.x, s * rotation.y, s * rotation.z, c};
  return normalized(q * orientation);
}

// --------------------------------------------------------------------------------------------- gather and scatter

constexpr int kRecordFloats = 16;

// The address of record `index`, or `otherwise` for a negative index; with bit operations instead of a branch, since
// lanes without a record are hard to predict.
template <int Stride>
GYRE_INLINE std::uintptr_t record_address(std::uintptr_t base, std::int32_t index) {
  return base + std::uintptr_t(std::intptr_t(index)) * (Stride * 4u);
}
template <int Stride = kRecordFloats, class Number>
GYRE_INLINE Number* record_or(Number* base, std::int32_t index, Number* otherwise) {
  const std::uintptr_t record = record_address<Stride>(std::uintptr_t(base), index);
  const std::uintptr_t none = std::uintptr_t(std::intptr_t(index) >> (8 * sizeof(std::intptr_t) - 1));
  return reinterpret_cast<Number*>(record ^ ((record ^ std::uintptr_t(otherwise)) & none));
}
// The addresses for each lane, of records of `Stride` floats: the first form needs a record in every lane, the second
// does not. Most blocks have a record in every lane and skip the test of single lanes.
template <int W, int Stride = kRecordFloats, class Number>
GYRE_INLINE void locate_records(Number* base, const std::int32_t* indices, Number* (&record)[W]) {
  GYRE_UNROLL
  for (int i = 0; i < W; ++i)
    record[i] = reinterpret_cast<Number*>(record_address<Stride>(std::uintptr_t(base), indices[i]));
}
template <int W, int Stride = kRecordFloats, class Number>
GYRE_INLINE void locate_records(Number* base, const std::int32_t* indices, Number* otherwise,
                                Number* (&record)[W]) {
  if (none(WideInt<W>::load_unaligned(indices) < WideInt<W>(0))) {
    locate_records<W, Stride>(base, indices, record);
  } else {
    GYRE_UNROLL
    for (int i = 0; i < W; ++i) record[i] = record_or<Stride>(base, indices[i], otherwise);
  }
}

// Blocks of four floats of W records. 128-bit lane l of row j is record 4 l + j, so a transposition of rows and columns
// never crosses 128-bit lanes. Written without loops over rows, because GCC keeps unrolled arrays in memory.
template <int W>
struct Rows {
  using Float = typename Lanes<W>::Float;
  using Quad = typename Lanes<4>::Float;
  using LooseQuad = typename Lanes<4>::LooseFloat;

  static GYRE_INLINE Float load(const float* const (&record)[W], int j, int first) {
    if constexpr (W == 4) {
      return quad(record[j] + first);
    } else if constexpr (W == 8) {
      return join(quad(record[j] + first), quad(record[4 + j] + first));
    } else {
      const Quad q0 = quad(record[j] + first), q1 = quad(record[4 + j] + first);
      const Quad q2 = quad(record[8 + j] + first), q3 = quad(record[12 + j] + first);
#if defined(__AVX512F__)
      // Inserted directly from memory, without a shuffle.
      __m512 row = _mm512_castps128_ps512((__m128)q0);
      row = _mm512_insertf32x4(row, (__m128)q1, 1);
      row = _mm512_insertf32x4(row, (__m128)q2, 2);
      return (Float)_mm512_insertf32x4(row, (__m128)q3, 3);
#else
      return __builtin_shufflevector(join(q0, q1), join(q2, q3), 0, 1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11, 12, 13,
                                     14, 15);
#endif
    }
  }

  // Writes the first `Count` (1 to 4) floats of row j.
  template <int Count>
  static GYRE_INLINE void store(Float row, float* const (&record)[W], int j, int first) {
    store_quad<Count>(record[j] + first, quad_of<0>(row));
    if constexpr (W >= 8) store_quad<Count>(record[4 + j] + first, quad_of<1>(row));
    if constexpr (W == 16) {
      store_quad<Count>(record[8 + j] + first, quad_of<2>(row));
      store_quad<Count>(record[12 + j] + first, quad_of<3>(row));
    }
  }

  // Transposes rows and columns: within each 128-bit lane, element i of row j and element j of row i change places.
  static GYRE_INLINE void transpose(Float& r0, Float& r1, Float& r2, Float& r3) {
    const Float a = unpack_low(r0, r1), b = unpack_high(r0, r1);
    const Float c = unpack_low(r2, r3), d = unpack_high(r2, r3);
    r0 = low_pairs(a, c);
    r1 = high_pairs(a, c);
    r2 = low_pairs(b, d);
    r3 = high_pairs(b, d);
  }

  // Loads columns first ... first + 3 of the records.
  static GYRE_INLINE void gather(const float* const (&record)[W], int first, Wide<W>* out) {
    Float r0 = load(record, 0, first), r1 = load(record, 1, first);
    Float r2 = load(record, 2, first), r3 = load(record, 3, first);
    transpose(r0, r1, r2, r3);
    out[0].v = r0;
    out[1].v = r1;
    out[2].v = r2;
    out[3].v = r3;
  }
  // Stores `Count` columns from `first` on.
  template <int Count>
  static GYRE_INLINE void scatter(float* const (&record)[W], int first, const Wide<W>* in) {
    Float r0 = in[0].v, r1 = in[Count > 1 ? 1 : 0].v, r2 = in[Count > 2 ? 2 : 0].v,
          r3 = in[Count > 3 ? 3 : 0].v;
    transpose(r0, r1, r2, r3);
    store<Count>(r0, record, 0, first);
    store<Count>(r1, record, 1, first);
    store<Count>(r2, record, 2, first);
    store<Count>(r3, record, 3, first);
  }

 private:
  static GYRE_INLINE Quad quad(const float* from) { return *reinterpret_cast<const LooseQuad*>(from); }
  static GYRE_INLINE typename Lanes<8>::Float join(Quad low, Quad high) {
    return __builtin_shufflevector(low, high, 0, 1, 2, 3, 4, 5, 6, 7);
  }
  // 128-bit lane l of a row. Extractions are named, since GCC does not store the result of a shuffle directly.
  template <int l>
  static GYRE_INLINE Quad quad_of(Float row) {
    if constexpr (W == 4) {
      return row;
    } else {
#if defined(__AVX512F__)
      if constexpr (W == 16 && l > 0)
        return (Quad)_mm512_maskz_extractf32x4_ps(__mmask8(0xf), (__m512)row, l);
#endif
#if defined(__AVX__)
      if constexpr (W == 8 && l > 0) return (Quad)_mm256_extractf128_ps((__m256)row, l);
#endif
      return __builtin_shufflevector(row, row, 4 * l, 4 * l + 1, 4 * l + 2, 4 * l + 3);
    }
  }
  template <int Count>
  static GYRE_INLINE void store_quad(float* to, Quad quad_value) {
    if constexpr (Count == 4) {
      *reinterpret_cast<LooseQuad*>(to) = quad_value;
    } else {
      __builtin_memcpy(to, &quad_value, Count * sizeof(float));
    }
  }

  // Of each 128-bit lane: a0 b0 a1 b1 (unpack_low); a2 b2 a3 b3; a0 a1 b0 b1; a2 a3 b2 b3.
  static GYRE_INLINE Float unpack_low(Float a, Float b) {
    if constexpr (W == 4) {
      return __builtin_shufflevector(a, b, 0, 4, 1, 5);
    } else if constexpr (W == 8) {
      return __builtin_shufflevector(a, b, 0, 8, 1, 9, 4, 12, 5, 13);
    } else {
      return __builtin_shufflevector(a, b, 0, 16, 1, 17, 4, 20, 5, 21, 8, 24, 9, 25, 12, 28, 13, 29);
    }
  }
  static GYRE_INLINE Float unpack_high(Float a, Float b) {
    if constexpr (W == 4) {
      return __builtin_shufflevector(a, b, 2, 6, 3, 7);
    } else if constexpr (W == 8) {
      return __builtin_shufflevector(a, b, 2, 10, 3, 11, 6, 14, 7, 15);
    } else {
      return __builtin_shufflevector(a, b, 2, 18, 3, 19, 6, 22, 7, 23, 10, 26, 11, 27, 14, 30, 15, 31);
    }
  }
  static GYRE_INLINE Float low_pairs(Float a, Float b) {
    if constexpr (W == 4) {
      return __builtin_shufflevector(a, b, 0, 1, 4, 5);
    } else if constexpr (W == 8) {
      return __builtin_shufflevector(a, b, 0, 1, 8, 9, 4, 5, 12, 13);
    } else {
      return __builtin_shufflevector(a, b, 0, 1, 16, 17, 4, 5, 20, 21, 8, 9, 24, 25, 12, 13, 28, 29);
    }
  }
  static GYRE_INLINE Float high_pairs(Float a, Float b) {
    if constexpr (W == 4) {
      return __builtin_shufflevector(a, b, 2, 3, 6, 7);
    } else if constexpr (W == 8) {
      return __builtin_shufflevector(a, b, 2, 3, 10, 11, 6, 7, 14, 15);
    } else {
      return __builtin_shufflevector(a, b, 2, 3, 18, 19, 6, 7, 22, 23, 10, 11, 26, 27, 14, 15, 30, 31);
    }
  }
};

// Loads columns first ... first + Columns - 1 (a multiple of four) of W records: out[c] lane i is record[i][first + c].
template <int Columns, int W>
GYRE_INLINE void gather_columns(const float* const (&record)[W], int first, Wide<W>* out) {
  static_assert(Columns % 4 == 0 && Columns <= kRecordFloats);
  if constexpr (W == 1) {
    GYRE_UNROLL
    for (int c = 0; c < Columns; ++c) out[c].v = record[0][first + c];
  } else {
    Rows<W>::gather(record, first, out);
    if constexpr (Columns > 4) Rows<W>::gather(record, first + 4, out + 4);
    if constexpr (Columns > 8) Rows<W>::gather(record, first + 8, out + 8);
    if constexpr (Columns > 12) Rows<W>::gather(record, first + 12, out + 12);
  }
}

// Writes columns in[0 ... Columns) to the records, from `first` on. No other float of a record is touched.
template <int Columns, int W>
GYRE_INLINE void scatter_columns(float* const (&record)[W], int first, const Wide<W>* in) {
  static_assert(Columns >= 1 && Columns <= kRecordFloats);
  if constexpr (W == 1) {
    GYRE_UNROLL
    for (int c = 0; c < Columns; ++c) record[0][first + c] = in[c].v;
  } else {
    Rows<W>::template scatter<(Columns < 4 ? Columns : 4)>(record, first, in);
    if constexpr (Columns > 4) {
      Rows<W>::template scatter<(Columns < 8 ? Columns - 4 : 4)>(record, first + 4, in + 4);
    }
    if constexpr (Columns > 8) {
      Rows<W>::template scatter<(Columns < 12 ? Columns - 8 : 4)>(record, first + 8, in + 8);
    }
    if constexpr (Columns > 12) Rows<W>::template scatter<Columns - 12>(record, first + 12, in + 12);
  }
}

// Read by lanes without a record.
alignas(64) constexpr float kNoRecord[kRecordFloats] = {};

// The first `Columns` floats of W records of 16 floats: out[c] lane i is base[16 indices[i] + c]. Lanes with a negative
// index have no record and read zeros.
template <int Columns, int W>
GYRE_INLINE void gather(const float* base, const std::int32_t* indices, Wide<W>* out) {
  const float* record[W];
  locate_records<W>(base, indices, kNoRecord, record);
  gather_columns<Columns, W>(record, 0, out);
}
template <int W>
GYRE_INLINE void gather16(const float* base, const std::int32_t* indices, Wide<W>* out) {
  gather<16, W>(base, indices, out);
}
template <int W>
GYRE_INLINE void gather8(const float* base, const std::int32_t* indices, Wide<W>* out) {
  gather<8, W>(base, indices, out);
}

// Writes columns in[0 ... Columns) to the records; lanes with a negative index write nothing. Two lanes must not name
// the same record. No float beyond the first `Columns` of a record is touched.
template <int Columns, int W>
GYRE_INLINE void scatter(float* base, const std::int32_t* indices, const Wide<W>* in) {
  if constexpr (W == 1) {
    if (indices[0] < 0) return;
    float* const record[1] = {base + kRecordFloats * std::int64_t(indices[0])};
    scatter_columns<Columns, W>(record, 0, in);
  } else {
    alignas(64) float nowhere[kRecordFloats];
    float* record[W];
    locate_records<W>(base, indices, static_cast<float*>(nowhere), record);
    scatter_columns<Columns, W>(record, 0, in);
  }
}

}  // namespace GYRE_TARGET_NAMESPACE
}  // namespace gyre
