// Every operation of wide.h and wide_vec.h, run over rows of numbers. Compiled once for each CPU kind (the files
// wide_test_kernels_<kind>.cpp) and for each width in it; wide_test.cpp compares the bits with those of width 1.
//
// In: `count` numbers (a multiple of 16) in each of kWideTestInputs rows; out: `count` words of 32 bits in each of
// kWideTestResults rows. The numbers also serve as records to gather. The last kRecordFloats rows of the results are a
// record for each of the `count` lanes, as targets of scatters.
#pragma once

#include <cstdint>

#include "math/wide_vec.h"

namespace gyre {

constexpr int kWideTestInputs = 7;
constexpr int kWideTestResults = 181;
constexpr int kWideTestRecords = 400;  // fit into the inputs of 1024 lanes and more

using WideTest = void (*)(int width, const float* inputs, int count, std::uint32_t* results);
void run_wide_test_w1(int width, const float* inputs, int count, std::uint32_t* results);
void run_wide_test_sse2(int width, const float* inputs, int count, std::uint32_t* results);
void run_wide_test_avx2(int width, const float* inputs, int count, std::uint32_t* results);
void run_wide_test_avx512(int width, const float* inputs, int count, std::uint32_t* results);
void run_wide_test_neon(int width, const float* inputs, int count, std::uint32_t* results);
void run_wide_test_wasm(int width, const float* inputs, int count, std::uint32_t* results);

inline namespace GYRE_TARGET_NAMESPACE {

// Writes the results of one block of W numbers to its columns of each row. Checks that all queries of a mask agree with
// its bits, in every lane.
template <int W>
GYRE_INLINE Mask<W> tells_its_bits(Mask<W> mask) {
  const std::uint32_t bits = to_bits(mask), all_bits = to_bits(Mask<W>::splat(true));
  bool agrees = any(mask) == (bits != 0) && none(mask) == (bits == 0) && all(mask) == (bits == all_bits) &&
                all(Mask<W>::splat(true)) && none(Mask<W>::splat(false)) &&
                to_bits(Mask<W>::of_bits(bits)) == bits;
  for (int i = 0; i < W; ++i) agrees = agrees && mask[i] == ((bits >> i & 1u) != 0);
  return Mask<W>::splat(agrees);
}

template <int W>
struct WideTestRows {
  std::uint32_t* next;
  int count;
  int rows = 0;

  GYRE_INLINE void put(Wide<W> a) {
    a.store_unaligned(reinterpret_cast<float*>(next));
    step();
  }
  GYRE_INLINE void put(WideInt<W> a) {
    a.store_unaligned(reinterpret_cast<std::int32_t*>(next));
    step();
  }
  GYRE_INLINE void put(Mask<W> a) { put(to_int(a)); }
  GYRE_INLINE void put(Vec3W<W> a) {
    put(a.x);
    put(a.y);
    put(a.z);
  }
  GYRE_INLINE void put(QuatW<W> a) {
    put(a.x);
    put(a.y);
    put(a.z);
    put(a.w);
  }
  GYRE_INLINE void put(const Sym3W<W>& a) {
    put(a.xx);
    put(a.yy);
    put(a.zz);
    put(a.xy);
    put(a.xz);
    put(a.yz);
  }
  GYRE_INLINE void put(const Mat3W<W>& a) {
    put(a.x);
    put(a.y);
    put(a.z);
  }
  // The lanes' bits, spread out again: lane i gets bit i.
  GYRE_INLINE void put_bits(std::uint32_t bits) {
    WideInt<W> spread = 0;
    for (int i = 0; i < W; ++i) spread.set(i, std::int32_t((bits >> i) & 1u));
    put(spread);
  }
  GYRE_INLINE void step() {
    next += count;
    ++rows;
  }
};

template <int W>
inline __attribute__((noinline)) void wide_test_numbers(WideTestRows<W>& out, Wide<W> a, Wide<W> b,
                                                        Wide<W> c) {
  out.put(a + b);
  out.put(a - b);
  out.put(a * b);
  out.put(a / b);
  out.put(a * b + c);  // must round twice
  out.put(a * b - c * a);
  out.put(-a);
  out.put(2.5f * a);
  out.put(a + 1.0f);
  out.put(Wide<W>(-0.0f));
  out.put(a < b);
  out.put(a <= b);
  out.put(a > b);
  out.put(a >= b);
  out.put(a == b);
  out.put(a != b);
  out.put((a < b) & (b < c));
  out.put((a < b) | (b < c));
  out.put((a < b) ^ (b < c));
  out.put(~(a < b));
  out.put(and_not(a < b, b < c));
  out.put_bits(to_bits(a < c));
  out.put(tells_its_bits(a < c));
  out.put(Mask<W>::splat(true));
  out.put(Mask<W>::splat(false));
  out.put(select(a < b, b, c));
  out.put(select((a < b) & (c < b), a * c, b));
  out.put(min(a, b));
  out.put(max(a, b));
  out.put(max(a, Wide<W>{}));
  out.put(min(Wide<W>{}, a));
  out.put(clamp(a, -1.0f, b));
  out.put(keep(a < b, c));
  out.put(absolute(a));
  out.put(copy_sign(a, b));
  out.put(sqrt(a));
  out.put(1.0f / sqrt(absolute(a) + 1.0f));
  const SinCosW<W> turn = sin_cos(clamp(a, -1.0e6f, 1.0e6f));
  out.put(select(a == a, turn.sin, Wide<W>(0.0f)));
  out.put(select(a == a, turn.cos, Wide<W>(0.0f)));
}

template <int W>
inline __attribute__((noinline)) void wide_test_integers(WideTestRows<W>& out, Wide<W> a, Wide<W> b) {
  const WideInt<W> i = bit_pattern(a), j = bit_pattern(b);
  out.put(from_bit_pattern(i));
  out.put(i + j);
  out.put(i - j);
  out.put(i * j);
  out.put(i & j);
  out.put(i | j);
  out.put(i ^ j);
  out.put(~i);
  out.put(i << 3);
  out.put(i >> 5);
  out.put(shift_right_logical(i, 7));
  out.put(i < j);
  out.put(i <= j);
  out.put(i > j);
  out.put(i >= j);
  out.put(i == j);
  out.put(i != j);
  out.put(select(i < j, j, i));
  out.put(min(i, j));
  out.put(max(i, j));
  out.put(to_float(i));
  out.put(truncate(select(absolute(a) < 2.0e9f, a, Wide<W>(-7.75f))));
}

template <int W>
inline __attribute__((noinline)) void wide_test_vectors(WideTestRows<W>& out, Vec3W<W> u, Vec3W<W> v,
                                                        Wide<W> s) {
  out.put(u + v);
  out.put(u - v);
  out.put(s * u);
  out.put(v / s);
  out.put(dot(u, v));
  out.put(cross(u, v));
  out.put(lerp(u, v, s));
  out.put(length(u));
  out.put(normalized(u));
  out.put(select(s < 0.5f, u, v));
  const QuatW<W> q = normalized(QuatW<W>{u.x, u.y, u.z, s});
  out.put(q);
  out.put(q * QuatW<W>{v.x, v.y, v.z, s});
  out.put(rotate(q, v));
  out.put(rotate_inverse(q, v));
  const Mat3W<W> m = to_matrix(q);
  out.put(m);
  out.put(m * v);
  out.put(transpose_times(m, v));
  const Sym3W<W> t{u.x, u.y, u.z, v.x, v.y, v.z};
  out.put(t * v);
  out.put(inverse(t));
  out.put(rotate_inertia(m, t));
  out.put(rotate_moments(m, u));
  const Vec3W<W> turn{clamp(u.x, -100.0f, 100.0f), clamp(u.y, -0.5f, 0.5f), clamp(u.z, -0.01f, 0.01f)};
  out.put(integrate_rotation(q, turn));
}

// Lanes gather from arbitrary records, some from none, and scatter to the record of their own number.
template <int W>
inline __attribute__((noinline)) void wide_test_moves(WideTestRows<W>& out, const float* from, float* to,
                                                      int first) {
  std::int32_t sources[W], targets[W];
  for (int i = 0; i < W; ++i) {
    const int lane = first + i;
    sources[i] = lane % 5 == 3 ? -1 - lane : (37 * lane) % kWideTestRecords;
    targets[i] = lane % 7 == 2 ? -1 : lane;
  }
  Wide<W> all[16], half[8];
  gather16<W>(from, sources, all);
  gather8<W>(from, sources, half);
  for (int c = 0; c < 16; ++c) out.put(all[c]);
  for (int c = 0; c < 8; ++c) out.put(half[c]);
  // Each block of a record is written by another kind of scatter.
  if ((first / 16) % 4 == 0) scatter<16, W>(to, targets, all);
  if ((first / 16) % 4 == 1) scatter<8, W>(to, targets, half);
  if ((first / 16) % 4 == 2) scatter<6, W>(to, targets, half);
  if ((first / 16) % 4 == 3) scatter<13, W>(to, targets, all);
}

template <int W>
void run_wide_test_width(const float* inputs, int count, std::uint32_t* results) {
  for (int i = 0; i < count; i += W) {
    Wide<W> in[kWideTestInputs];
    for (int row = 0; row < kWideTestInputs; ++row)
      in[row] = Wide<W>::load_unaligned(inputs + row * count + i);
    WideTestRows<W> out{results + i, count};
    wide_test_numbers<W>(out, in[0], in[1], in[2]);
    wide_test_integers<W>(out, in[0], in[1]);
    wide_test_vectors<W>(out, {in[0], in[1], in[2]}, {in[3], in[4], in[5]}, in[6]);
    float* records = reinterpret_cast<float*>(results + (kWideTestResults - kRecordFloats) * count);
    wide_test_moves<W>(out, inputs, records, i);
    if (out.rows != kWideTestResults - kRecordFloats) __builtin_trap();  // the constant is wrong
  }
}

GYRE_INLINE void run_wide_test(int width, const float* inputs, int count, std::uint32_t* results) {
  if (width == 1) run_wide_test_width<1>(inputs, count, results);
  if (width == 4) run_wide_test_width<4>(inputs, count, results);
  if (width == 8) run_wide_test_width<8>(inputs, count, results);
  if (width == 16) run_wide_test_width<16>(inputs, count, results);
}

}  // namespace GYRE_TARGET_NAMESPACE
}  // namespace gyre
