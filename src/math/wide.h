// Wide<W>: W floats side by side, W = 1, 4, 8 or 16, with one interface for every CPU. Kernels are templates over W.
//
// The promise: lane i of any operation has exactly the bits that Wide<1> has for the same input (except the payload of
// NaNs), on every compiler and CPU. So every operation here is fixed by IEEE 754: no fused multiply-add, no reciprocal
// estimates, and min/max are `a < b ? a : b` (as the x86 instructions, NaN and zeros included).
//
// Built on the vector extensions that GCC and Clang share, with named instructions only where those have no operator
// (square root, mask to bits). Vectors wider than the CPU's registers work too, only slower.
//
// A file with kernels for one CPU kind is compiled with its own instruction flags and defines GYRE_TARGET_NAMESPACE
// before it includes this file. All names here then live in an inline namespace of that name, so the linker cannot mix
// the functions of two kinds. Such a file includes only this, wide_vec.h and headers of its own kind.
#pragma once

#include "math/wide_mask.h"

namespace gyre {
inline namespace GYRE_TARGET_NAMESPACE {

// -------------------------------------------------------------------------------------------------------------- floats

template <int W>
struct Wide {
  using Float = typename Lanes<W>::Float;
  using Int = typename Lanes<W>::Int;
  Float v;

  Wide() = default;
  // The same number in every lane. `- Float{}` because x - 0 is x, also for the negative zero.
  GYRE_INLINE Wide(float value) : v(value - Float{}) {}
  static GYRE_INLINE Wide of(Float lanes) {
    Wide wide;
    wide.v = lanes;
    return wide;
  }

  // From and to W floats in a row; `load` and `store` need them aligned to 4 W bytes.
  static GYRE_INLINE Wide load(const float* from) {
    return of(*reinterpret_cast<const typename Lanes<W>::AnyFloat*>(from));
  }
  static GYRE_INLINE Wide load_unaligned(const float* from) {
    return of(*reinterpret_cast<const typename Lanes<W>::LooseFloat*>(from));
  }
  GYRE_INLINE void store(float* to) const { *reinterpret_cast<typename Lanes<W>::AnyFloat*>(to) = v; }
  GYRE_INLINE void store_unaligned(float* to) const {
    *reinterpret_cast<typename Lanes<W>::LooseFloat*>(to) = v;
  }
  // One lane; for set-up and tests, not for kernels.
  GYRE_INLINE float operator[](int lane) const {
    if constexpr (W == 1) {
      return (void)lane, v;
    } else {
      return v[lane];
    }
  }
  // A plain store if the lane is not known: Clang would otherwise move the vector to the stack and back.
  GYRE_INLINE void set(int lane, float value) {
    if constexpr (W == 1) {
      (void)lane, v = value;
    } else {
      __builtin_memcpy(reinterpret_cast<char*>(&v) + 4 * lane, &value, sizeof value);
    }
  }

  friend GYRE_INLINE Wide operator+(Wide a, Wide b) { return of(a.v + b.v); }
  friend GYRE_INLINE Wide operator-(Wide a, Wide b) { return of(a.v - b.v); }
  friend GYRE_INLINE Wide operator*(Wide a, Wide b) { return of(a.v * b.v); }
  friend GYRE_INLINE Wide operator/(Wide a, Wide b) { return of(a.v / b.v); }
  friend GYRE_INLINE Wide operator-(Wide a) { return of(-a.v); }
  friend GYRE_INLINE Wide& operator+=(Wide& a, Wide b) { return a = a + b; }
  friend GYRE_INLINE Wide& operator-=(Wide& a, Wide b) { return a = a - b; }
  friend GYRE_INLINE Wide& operator*=(Wide& a, Wide b) { return a = a * b; }

  friend GYRE_INLINE Mask<W> operator<(Wide a, Wide b) { return compare<W, Order::less>(a.v, b.v); }
  friend GYRE_INLINE Mask<W> operator<=(Wide a, Wide b) { return compare<W, Order::at_most>(a.v, b.v); }
  friend GYRE_INLINE Mask<W> operator>(Wide a, Wide b) { return compare<W, Order::more>(a.v, b.v); }
  friend GYRE_INLINE Mask<W> operator>=(Wide a, Wide b) { return compare<W, Order::at_least>(a.v, b.v); }
  friend GYRE_INLINE Mask<W> operator==(Wide a, Wide b) { return compare<W, Order::equal>(a.v, b.v); }
  friend GYRE_INLINE Mask<W> operator!=(Wide a, Wide b) { return compare<W, Order::unequal>(a.v, b.v); }

  friend GYRE_INLINE Wide select(Mask<W> mask, Wide a, Wide b) { return of(select_lanes(mask, a.v, b.v)); }
  // a < b ? a : b and a > b ? a : b. Instructions that do exactly this are named, since GCC does not find them if one
  // side is zero.
  friend GYRE_INLINE Wide min(Wide a, Wide b) {
#if defined(__AVX512F__)
    if constexpr (W == 16) return of((Float)_mm512_maskz_min_ps(__mmask16(0xffff), (__m512)a.v, (__m512)b.v));
#endif
#if defined(__AVX__)
    if constexpr (W == 8) return of((Float)_mm256_min_ps((__m256)a.v, (__m256)b.v));
#endif
#if defined(__SSE2__)
    if constexpr (W == 4) return of((Float)_mm_min_ps((__m128)a.v, (__m128)b.v));
#elif defined(__wasm_simd128__)
    if constexpr (W == 4) return of((Float)wasm_f32x4_pmin((v128_t)b.v, (v128_t)a.v));
#endif
    return select(a < b, a, b);
  }
  friend GYRE_INLINE Wide max(Wide a, Wide b) {
#if defined(__AVX512F__)
    if constexpr (W == 16) return of((Float)_mm512_maskz_max_ps(__mmask16(0xffff), (__m512)a.v, (__m512)b.v));
#endif
#if defined(__AVX__)
    if constexpr (W == 8) return of((Float)_mm256_max_ps((__m256)a.v, (__m256)b.v));
#endif
#if defined(__SSE2__)
    if constexpr (W == 4) return of((Float)_mm_max_ps((__m128)a.v, (__m128)b.v));
#elif defined(__wasm_simd128__)
    if constexpr (W == 4) return of((Float)wasm_f32x4_pmax((v128_t)b.v, (v128_t)a.v));
#endif
    return select(a > b, a, b);
  }
  friend GYRE_INLINE Wide clamp(Wide value, Wide low, Wide high) { return min(max(value, low), high); }
  // `a` where the mask is set, +0 elsewhere: one operation less than select.
  friend GYRE_INLINE Wide keep(Mask<W> mask, Wide a) {
    if constexpr (kMasksAreBits<W>) {
      return select(mask, a, Wide(0.0f));
    } else {
      return from_bits(bits_of(a) & mask.v);
    }
  }
  // Clears the sign, also of -0 and NaN.
  friend GYRE_INLINE Wide absolute(Wide a) { return from_bits(bits_of(a) & (0x7fffffff - Int{})); }
  // `magnitude` with the sign of `sign`.
  friend GYRE_INLINE Wide copy_sign(Wide magnitude, Wide sign) {
    const Int sign_bit = INT32_MIN - Int{};
    return from_bits((bits_of(magnitude) & ~sign_bit) | (bits_of(sign) & sign_bit));
  }
  friend GYRE_INLINE Wide square(Wide a) { return a * a; }

  // Correctly rounded; NaN below zero.
  friend GYRE_INLINE Wide sqrt(Wide a) {
    if constexpr (W == 1) {
      return of(__builtin_sqrtf(a.v));
    } else {
#if defined(__AVX512F__)
      // With a full mask: GCC's plain form warns of its own uninitialised operand.
      if constexpr (W == 16) return of((Float)_mm512_maskz_sqrt_ps(__mmask16(0xffff), (__m512)a.v));
#endif
#if defined(__AVX__)
      if constexpr (W == 8) return of((Float)_mm256_sqrt_ps((__m256)a.v));
#endif
#if defined(__SSE2__)
      if constexpr (W == 4) return of((Float)_mm_sqrt_ps((__m128)a.v));
#elif defined(__aarch64__)
      if constexpr (W == 4) return of((Float)vsqrtq_f32((float32x4_t)a.v));
#elif defined(__wasm_simd128__)
      if constexpr (W == 4) return of((Float)wasm_f32x4_sqrt((v128_t)a.v));
#endif
      Wide result = a;
      for (int i = 0; i < W; ++i) result.v[i] = __builtin_sqrtf(a.v[i]);
      return result;
    }
  }

  static GYRE_INLINE Int bits_of(Wide a) {
    if constexpr (W == 1) {
      return __builtin_bit_cast(std::int32_t, a.v);
    } else {
      return (Int)a.v;
    }
  }
  static GYRE_INLINE Wide from_bits(Int bits) {
    if constexpr (W == 1) {
      return of(__builtin_bit_cast(float, bits));
    } else {
      return of((Float)bits);
    }
  }
};

// ------------------------------------------------------------------------------------------------------------ integers

// W 32-bit integers: indices, flags, the bits of floats. Sums and products wrap.
template <int W>
struct WideInt {
  using Int = typename Lanes<W>::Int;
  using Unsigned = typename Lanes<W>::Unsigned;
  Int v;

  WideInt() = default;
  GYRE_INLINE WideInt(std::int32_t value) : v(value - Int{}) {}
  static GYRE_INLINE WideInt of(Int lanes) {
    WideInt wide;
    wide.v = lanes;
    return wide;
  }

  static GYRE_INLINE WideInt load(const std::int32_t* from) {
    return of(*reinterpret_cast<const typename Lanes<W>::AnyInt*>(from));
  }
  static GYRE_INLINE WideInt load_unaligned(const std::int32_t* from) {
    return of(*reinterpret_cast<const typename Lanes<W>::LooseInt*>(from));
  }
  GYRE_INLINE void store(std::int32_t* to) const { *reinterpret_cast<typename Lanes<W>::AnyInt*>(to) = v; }
  GYRE_INLINE void store_unaligned(std::int32_t* to) const {
    *reinterpret_cast<typename Lanes<W>::LooseInt*>(to) = v;
  }
  GYRE_INLINE std::int32_t operator[](int lane) const {
    if constexpr (W == 1) {
      return (void)lane, v;
    } else {
      return v[lane];
    }
  }
  GYRE_INLINE void set(int lane, std::int32_t value) {
    if constexpr (W == 1) {
      (void)lane, v = value;
    } else {
      v[lane] = value;
    }
  }

  friend GYRE_INLINE WideInt operator+(WideInt a, WideInt b) {
    return of((Int)((Unsigned)a.v + (Unsigned)b.v));
  }
  friend GYRE_INLINE WideInt operator-(WideInt a, WideInt b) {
    return of((Int)((Unsigned)a.v - (Unsigned)b.v));
  }
  friend GYRE_INLINE WideInt operator*(WideInt a, WideInt b) {
    return of((Int)((Unsigned)a.v * (Unsigned)b.v));
  }
  friend GYRE_INLINE WideInt operator&(WideInt a, WideInt b) { return of(a.v & b.v); }
  friend GYRE_INLINE WideInt operator|(WideInt a, WideInt b) { return of(a.v | b.v); }
  friend GYRE_INLINE WideInt operator^(WideInt a, WideInt b) { return of(a.v ^ b.v); }
  friend GYRE_INLINE WideInt operator~(WideInt a) { return of(~a.v); }
  // By 0 to 31 bits; a right shift copies the sign bit.
  friend GYRE_INLINE WideInt operator<<(WideInt a, int count) { return of((Int)((Unsigned)a.v << count)); }
  friend GYRE_INLINE WideInt operator>>(WideInt a, int count) { return of(a.v >> count); }
  // A right shift that moves zeros in.
  friend GYRE_INLINE WideInt shift_right_logical(WideInt a, int count) {
    return of((Int)((Unsigned)a.v >> count));
  }

  friend GYRE_INLINE Mask<W> operator<(WideInt a, WideInt b) { return compare<W, Order::less>(a.v, b.v); }
  friend GYRE_INLINE Mask<W> operator<=(WideInt a, WideInt b) { return compare<W, Order::at_most>(a.v, b.v); }
  friend GYRE_INLINE Mask<W> operator>(WideInt a, WideInt b) { return compare<W, Order::more>(a.v, b.v); }
  friend GYRE_INLINE Mask<W> operator>=(WideInt a, WideInt b) {
    return compare<W, Order::at_least>(a.v, b.v);
  }
  friend GYRE_INLINE Mask<W> operator==(WideInt a, WideInt b) { return compare<W, Order::equal>(a.v, b.v); }
  friend GYRE_INLINE Mask<W> operator!=(WideInt a, WideInt b) { return compare<W, Order::unequal>(a.v, b.v); }

  friend GYRE_INLINE WideInt select(Mask<W> mask, WideInt a, WideInt b) {
    return of(select_lanes(mask, a.v, b.v));
  }
  friend GYRE_INLINE WideInt min(WideInt a, WideInt b) { return select(a < b, a, b); }
  friend GYRE_INLINE WideInt max(WideInt a, WideInt b) { return select(a > b, a, b); }

  // The nearest float, and the integer part of a float (which must lie within the range of an int32).
  friend GYRE_INLINE Wide<W> to_float(WideInt a) {
    if constexpr (W == 1) {
      return Wide<W>::of(float(a.v));
    } else {
      return Wide<W>::of(__builtin_convertvector(a.v, typename Lanes<W>::Float));
    }
  }
};

template <int W>
GYRE_INLINE WideInt<W> truncate(Wide<W> a) {
  if constexpr (W == 1) {
    return WideInt<W>::of(std::int32_t(a.v));
  } else {
    return WideInt<W>::of(__builtin_convertvector(a.v, typename Lanes<W>::Int));
  }
}
// The bits of floats as integers, and back.
template <int W>
GYRE_INLINE WideInt<W> bit_pattern(Wide<W> a) {
  return WideInt<W>::of(Wide<W>::bits_of(a));
}
template <int W>
GYRE_INLINE Wide<W> from_bit_pattern(WideInt<W> a) {
  return Wide<W>::from_bits(a.v);
}
// A mask as integers 0 and -1.
template <int W>
GYRE_INLINE WideInt<W> to_int(Mask<W> mask) {
  return WideInt<W>::of(to_lanes(mask));
}

}  // namespace GYRE_TARGET_NAMESPACE
}  // namespace gyre
