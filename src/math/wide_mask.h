// Mask<W>: a truth value for each lane of Wide<W> (math/wide.h), and comparisons. On most CPUs a lane is a vector
// element with all bits set or none; with AVX-512 it is one bit.
#pragma once

#include "math/lanes.h"

namespace gyre {
inline namespace GYRE_TARGET_NAMESPACE {

// All bits of a lane set or none.
template <int W>
struct Mask {
  using Int = typename Lanes<W>::Int;
  Int v;

  static GYRE_INLINE Mask of(Int lanes) {
    Mask mask;
    mask.v = lanes;
    return mask;
  }
  static GYRE_INLINE Mask splat(bool value) { return of((value ? -1 : 0) - Int{}); }
  // From the result of a comparison: a vector of 0 and -1, or a bool.
  template <class T>
  static GYRE_INLINE Mask from(T compared) {
    if constexpr (W == 1) {
      return of(compared ? -1 : 0);
    } else {
      return of((Int)compared);
    }
  }

  // The inverse of to_bits.
  static GYRE_INLINE Mask of_bits(std::uint32_t bits) {
    if constexpr (W == 1) {
      return splat((bits & 1u) != 0u);
    } else {
      Int own{};
      for (int i = 0; i < W; ++i) own[i] = 1 << i;
      return from(((int(bits) - Int{}) & own) != Int{});
    }
  }

  GYRE_INLINE bool operator[](int lane) const {
    if constexpr (W == 1) {
      return (void)lane, v != 0;
    } else {
      return v[lane] != 0;
    }
  }

  friend GYRE_INLINE Mask operator&(Mask a, Mask b) { return of(a.v & b.v); }
  friend GYRE_INLINE Mask operator|(Mask a, Mask b) { return of(a.v | b.v); }
  friend GYRE_INLINE Mask operator^(Mask a, Mask b) { return of(a.v ^ b.v); }
  friend GYRE_INLINE Mask operator~(Mask a) { return of(~a.v); }
  // a and not b
  friend GYRE_INLINE Mask and_not(Mask a, Mask b) { return of(a.v & ~b.v); }

  // One bit for each lane, lane 0 the lowest.
  friend GYRE_INLINE std::uint32_t to_bits(Mask mask) {
    if constexpr (W == 1) {
      return mask.v != 0 ? 1u : 0u;
    } else {
#if defined(__AVX__)
      if constexpr (W == 8) return std::uint32_t(_mm256_movemask_ps((__m256)mask.v));
#endif
#if defined(__SSE2__)
      if constexpr (W == 4) return std::uint32_t(_mm_movemask_ps((__m128)mask.v));
#elif defined(__wasm_simd128__)
      if constexpr (W == 4) return std::uint32_t(wasm_i32x4_bitmask((v128_t)mask.v));
#endif
      std::uint32_t bits = 0;
      for (int i = 0; i < W; ++i) bits |= mask.v[i] != 0 ? 1u << i : 0u;
      return bits;
    }
  }
  friend GYRE_INLINE bool any(Mask mask) {
#if defined(__aarch64__)
    if constexpr (W == 4) return vmaxvq_u32((uint32x4_t)mask.v) != 0;
#elif defined(__wasm_simd128__)
    if constexpr (W == 4) return wasm_v128_any_true((v128_t)mask.v);
#endif
    return to_bits(mask) != 0u;
  }
  friend GYRE_INLINE bool all(Mask mask) {
#if defined(__aarch64__)
    if constexpr (W == 4) return vminvq_u32((uint32x4_t)mask.v) != 0;
#elif defined(__wasm_simd128__)
    if constexpr (W == 4) return wasm_i32x4_all_true((v128_t)mask.v);
#endif
    return to_bits(mask) == (1u << W) - 1u;
  }
  friend GYRE_INLINE bool none(Mask mask) { return !any(mask); }
};

#if defined(__AVX512F__) && defined(__AVX512DQ__)
template <int W>
constexpr bool kMasksAreBits = W == 16;

// One bit for each lane, in a mask register.
template <>
struct Mask<16> {
  std::uint16_t v;

  static GYRE_INLINE Mask of_bits(std::uint32_t bits) {
    Mask mask;
    mask.v = std::uint16_t(bits);
    return mask;
  }
  static GYRE_INLINE Mask splat(bool value) { return of_bits(value ? 0xffffu : 0u); }

  GYRE_INLINE bool operator[](int lane) const { return (v >> lane & 1) != 0; }

  friend GYRE_INLINE Mask operator&(Mask a, Mask b) { return of_bits(a.v & b.v); }
  friend GYRE_INLINE Mask operator|(Mask a, Mask b) { return of_bits(a.v | b.v); }
  friend GYRE_INLINE Mask operator^(Mask a, Mask b) { return of_bits(a.v ^ b.v); }
  friend GYRE_INLINE Mask operator~(Mask a) { return of_bits(~std::uint32_t(a.v)); }
  friend GYRE_INLINE Mask and_not(Mask a, Mask b) { return of_bits(a.v & ~std::uint32_t(b.v)); }

  friend GYRE_INLINE std::uint32_t to_bits(Mask mask) { return mask.v; }
  friend GYRE_INLINE bool any(Mask mask) { return mask.v != 0; }
  friend GYRE_INLINE bool all(Mask mask) { return mask.v == 0xffff; }
  friend GYRE_INLINE bool none(Mask mask) { return mask.v == 0; }
};
#else
template <int W>
constexpr bool kMasksAreBits = false;
#endif

// Comparisons of two numbers.
enum class Order : std::uint8_t { equal, less, at_most, unequal, at_least, more };

template <int W, Order order, class Vector>
GYRE_INLINE Mask<W> compare(Vector a, Vector b) {
  if constexpr (order == Order::equal) return Mask<W>::from(a == b);
  if constexpr (order == Order::less) return Mask<W>::from(a < b);
  if constexpr (order == Order::at_most) return Mask<W>::from(a <= b);
  if constexpr (order == Order::unequal) return Mask<W>::from(a != b);
  if constexpr (order == Order::at_least) return Mask<W>::from(a >= b);
  if constexpr (order == Order::more) return Mask<W>::from(a > b);
}
// `mask ? a : b` on the lanes of either type.
template <int W, class Vector>
GYRE_INLINE Vector select_lanes(Mask<W> mask, Vector a, Vector b) {
  if constexpr (W == 1) {
    return mask.v != 0 ? a : b;
  } else {
    return mask.v ? a : b;
  }
}
// 0 and -1.
template <int W>
GYRE_INLINE typename Lanes<W>::Int to_lanes(Mask<W> mask) {
  return mask.v;
}

#if defined(__AVX512F__) && defined(__AVX512DQ__)
// The same on masks of bits.
template <int W, Order order>
GYRE_INLINE Mask<16> compare(Lanes<16>::Float a, Lanes<16>::Float b) {
  constexpr int kPredicates[] = {_CMP_EQ_OQ, _CMP_LT_OS, _CMP_LE_OS, _CMP_NEQ_UQ, _CMP_GE_OS, _CMP_GT_OS};
  constexpr int kPredicate = kPredicates[int(order)];
  return Mask<16>::of_bits(_mm512_cmp_ps_mask((__m512)a, (__m512)b, kPredicate));
}
template <int W, Order order>
GYRE_INLINE Mask<16> compare(Lanes<16>::Int a, Lanes<16>::Int b) {
  constexpr int kPredicates[] = {_MM_CMPINT_EQ, _MM_CMPINT_LT,  _MM_CMPINT_LE,
                                 _MM_CMPINT_NE, _MM_CMPINT_NLT, _MM_CMPINT_NLE};
  constexpr int kPredicate = kPredicates[int(order)];
  return Mask<16>::of_bits(_mm512_cmp_epi32_mask((__m512i)a, (__m512i)b, kPredicate));
}
GYRE_INLINE Lanes<16>::Float select_lanes(Mask<16> mask, Lanes<16>::Float a, Lanes<16>::Float b) {
  return (Lanes<16>::Float)_mm512_mask_blend_ps(mask.v, (__m512)b, (__m512)a);
}
GYRE_INLINE Lanes<16>::Int select_lanes(Mask<16> mask, Lanes<16>::Int a, Lanes<16>::Int b) {
  return (Lanes<16>::Int)_mm512_mask_blend_epi32(mask.v, (__m512i)b, (__m512i)a);
}
GYRE_INLINE Lanes<16>::Int to_lanes(Mask<16> mask) { return (Lanes<16>::Int)_mm512_movm_epi32(mask.v); }
#endif

}  // namespace GYRE_TARGET_NAMESPACE
}  // namespace gyre
