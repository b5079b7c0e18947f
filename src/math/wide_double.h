// WideDouble<H>: H doubles side by side, for kernels that need more than floats (factorisations). The W floats of a
// register are two such halves, low lanes first, because a register holds half as many doubles; with W = 1 there is
// one. Lane i has the bits of plain double arithmetic, as promised in math/wide.h.
#pragma once

#include "math/wide.h"

namespace gyre {
inline namespace GYRE_TARGET_NAMESPACE {

template <int H>
struct DoubleLanes {
  static_assert(H == 2 || H == 4 || H == 8 ||
                H == 16);  // 16 for overload resolution of calls with explicit lanes
  typedef double Double __attribute__((vector_size(8 * H)));
  typedef double AnyDouble __attribute__((vector_size(8 * H), may_alias));
  typedef double LooseDouble __attribute__((vector_size(8 * H), may_alias, aligned(8)));
  typedef float HalfFloat __attribute__((vector_size(4 * H)));
};
template <>
struct DoubleLanes<1> {
  using Double = double;
  using AnyDouble = double;
  using LooseDouble = double;
  using HalfFloat = float;
};

// The number of halves of W lanes, and their width.
template <int W>
constexpr int kHalves = W == 1 ? 1 : 2;
template <int W>
constexpr int kHalfLanes = W / kHalves<W>;

template <int H>
struct WideDouble {
  using Double = typename DoubleLanes<H>::Double;
  Double v;

  WideDouble() = default;
  GYRE_INLINE WideDouble(double value) : v(value - Double{}) {}
  static GYRE_INLINE WideDouble of(Double lanes) {
    WideDouble wide;
    wide.v = lanes;
    return wide;
  }
  // From and to H doubles in a row, aligned to 8 H bytes.
  static GYRE_INLINE WideDouble load(const double* from) {
    return of(*reinterpret_cast<const typename DoubleLanes<H>::AnyDouble*>(from));
  }
  GYRE_INLINE void store(double* to) const { *reinterpret_cast<typename DoubleLanes<H>::AnyDouble*>(to) = v; }
  // With the alignment of one double.
  static GYRE_INLINE WideDouble load_loose(const double* from) {
    return of(*reinterpret_cast<const typename DoubleLanes<H>::LooseDouble*>(from));
  }
  GYRE_INLINE void store_loose(double* to) const {
    *reinterpret_cast<typename DoubleLanes<H>::LooseDouble*>(to) = v;
  }

  // From and to H floats at any address; stores round.
  static GYRE_INLINE WideDouble load_floats(const void* from) {
    typename DoubleLanes<H>::HalfFloat half;
    __builtin_memcpy(&half, from, sizeof half);
    if constexpr (H == 1) {
      return of(double(half));
    } else {
      return of(__builtin_convertvector(half, Double));
    }
  }
  GYRE_INLINE void store_floats(void* to) const {
    typename DoubleLanes<H>::HalfFloat half;
    if constexpr (H == 1) {
      half = float(v);
    } else {
      half = __builtin_convertvector(v, typename DoubleLanes<H>::HalfFloat);
    }
    __builtin_memcpy(to, &half, sizeof half);
  }
  // One lane; for rare use.
  GYRE_INLINE double operator[](int lane) const {
    if constexpr (H == 1) {
      return (void)lane, v;
    } else {
      return v[lane];
    }
  }
  GYRE_INLINE void set(int lane, double value) {
    if constexpr (H == 1) {
      (void)lane, v = value;
    } else {
      __builtin_memcpy(reinterpret_cast<char*>(&v) + 8 * lane, &value, sizeof value);
    }
  }

  friend GYRE_INLINE WideDouble operator+(WideDouble a, WideDouble b) { return of(a.v + b.v); }
  friend GYRE_INLINE WideDouble operator-(WideDouble a, WideDouble b) { return of(a.v - b.v); }
  friend GYRE_INLINE WideDouble operator*(WideDouble a, WideDouble b) { return of(a.v * b.v); }
  friend GYRE_INLINE WideDouble operator/(WideDouble a, WideDouble b) { return of(a.v / b.v); }
  friend GYRE_INLINE WideDouble operator-(WideDouble a) { return of(-a.v); }
  friend GYRE_INLINE WideDouble& operator+=(WideDouble& a, WideDouble b) { return a = a + b; }
  friend GYRE_INLINE WideDouble& operator-=(WideDouble& a, WideDouble b) { return a = a - b; }
  // Correctly rounded; NaN below zero.
  friend GYRE_INLINE WideDouble sqrt(WideDouble a) {
    if constexpr (H == 1) {
      return of(__builtin_sqrt(a.v));
    } else {
#if defined(__AVX512F__)
      // With a full mask, as for floats.
      if constexpr (H == 8) return of((Double)_mm512_maskz_sqrt_pd(__mmask8(0xff), (__m512d)a.v));
#endif
#if defined(__AVX__)
      if constexpr (H == 4) return of((Double)_mm256_sqrt_pd((__m256d)a.v));
#endif
#if defined(__SSE2__)
      if constexpr (H == 2) return of((Double)_mm_sqrt_pd((__m128d)a.v));
#elif defined(__aarch64__)
      if constexpr (H == 2) return of((Double)vsqrtq_f64((float64x2_t)a.v));
#elif defined(__wasm_simd128__)
      if constexpr (H == 2) return of((Double)wasm_f64x2_sqrt((v128_t)a.v));
#endif
      WideDouble result = a;
      for (int i = 0; i < H; ++i) result.v[i] = __builtin_sqrt(a.v[i]);
      return result;
    }
  }
  // `then` where a == b (select_equal) or a > b (select_above), `otherwise` elsewhere.
  friend GYRE_INLINE WideDouble select_equal(WideDouble a, WideDouble b, WideDouble then,
                                             WideDouble otherwise) {
    return of(a.v == b.v ? then.v : otherwise.v);
  }
  friend GYRE_INLINE WideDouble select_above(WideDouble a, WideDouble b, WideDouble then,
                                             WideDouble otherwise) {
    return of(a.v > b.v ? then.v : otherwise.v);
  }
  // a < b ? a : b and a > b ? a : b.
  friend GYRE_INLINE WideDouble min(WideDouble a, WideDouble b) { return of(a.v < b.v ? a.v : b.v); }
  friend GYRE_INLINE WideDouble max(WideDouble a, WideDouble b) { return of(a.v > b.v ? a.v : b.v); }
  // True if a <= b in each lane.
  friend GYRE_INLINE bool all_at_most(WideDouble a, WideDouble b) {
    if constexpr (H == 1) {
      return a.v <= b.v;
    } else {
#if defined(__AVX512F__)
      if constexpr (H == 8) return _mm512_cmp_pd_mask((__m512d)a.v, (__m512d)b.v, _CMP_LE_OS) == 0xff;
#endif
      const auto is = a.v <= b.v;
#if defined(__AVX__)
      if constexpr (H == 4) return _mm256_movemask_pd((__m256d)is) == 15;
#endif
#if defined(__SSE2__)
      if constexpr (H == 2) return _mm_movemask_pd((__m128d)is) == 3;
#endif
      bool all = true;
      for (int i = 0; i < H; ++i) all = all && is[i] != 0;
      return all;
    }
  }
  // The integer part of numbers that fit into an int.
  friend GYRE_INLINE WideDouble whole_part(WideDouble a) {
    if constexpr (H == 1) {
      return of(double(int(a.v)));
    } else {
      typedef std::int32_t Whole __attribute__((vector_size(4 * H)));
      return of(__builtin_convertvector(__builtin_convertvector(a.v, Whole), Double));
    }
  }
};

// Half `Half` of the lanes as doubles; join_halves makes rounded floats of two halves.
template <int Half, int W>
GYRE_INLINE WideDouble<kHalfLanes<W>> half_of(Wide<W> a) {
  using Result = WideDouble<kHalfLanes<W>>;
  if constexpr (W == 1) {
    return Result(double(a.v));
  } else {
    typename DoubleLanes<kHalfLanes<W>>::HalfFloat half;
    __builtin_memcpy(&half, reinterpret_cast<const char*>(&a.v) + Half * sizeof half, sizeof half);
    return Result::of(__builtin_convertvector(half, typename Result::Double));
  }
}
template <int W>
GYRE_INLINE Wide<W> join_halves(WideDouble<kHalfLanes<W>> low, WideDouble<kHalfLanes<W>> high) {
  if constexpr (W == 1) {
    return (void)high, Wide<W>(float(low.v));
  } else {
    using HalfFloat = typename DoubleLanes<kHalfLanes<W>>::HalfFloat;
    const HalfFloat a = __builtin_convertvector(low.v, HalfFloat),
                    b = __builtin_convertvector(high.v, HalfFloat);
    if constexpr (W == 4) return Wide<W>::of(__builtin_shufflevector(a, b, 0, 1, 2, 3));
    if constexpr (W == 8) return Wide<W>::of(__builtin_shufflevector(a, b, 0, 1, 2, 3, 4, 5, 6, 7));
    if constexpr (W == 16)
      return Wide<W>::of(__builtin_shufflevector(a, b, 0, 1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11, 12, 13, 14, 15));
  }
}

}  // namespace GYRE_TARGET_NAMESPACE
}  // namespace gyre
