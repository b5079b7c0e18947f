// What all wide kernels (math/wide.h) share with the compiler: the CPU's instructions, functions that must be inlined, loops that must or must
// not be unrolled, and the vector types of W lanes.
#pragma once

#include <cstdint>

#if defined(__AVX__)
#include <immintrin.h>
#elif defined(__SSE2__)
#include <emmintrin.h>
#elif defined(__aarch64__)
#include <arm_neon.h>
#elif defined(__wasm_simd128__)
#include <wasm_simd128.h>
#endif

// Functions must be inlined even in debug builds: a call would pass vectors through memory, and an emitted copy is what
// the namespace of a CPU kind (math/wide.h) guards against.
#define GYRE_INLINE inline __attribute__((always_inline))

#ifndef GYRE_TARGET_NAMESPACE
#define GYRE_TARGET_NAMESPACE w_default
#endif

// Compilers note that vectors wider than the CPU's registers have no stable calling convention; here nothing is called.
#pragma GCC diagnostic ignored "-Wpsabi"

// Before a short loop over lanes or columns whose arrays must become registers; and before one whose body is long enough already, of
// which a compiler would make several copies one after the other.
#if defined(__clang__)
#define GYRE_UNROLL _Pragma("clang loop unroll(full)")
#define GYRE_ROLLED _Pragma("clang loop unroll(disable)")
#else
#define GYRE_UNROLL _Pragma("GCC unroll 16")
#define GYRE_ROLLED _Pragma("GCC unroll 1")
#endif

namespace gyre {
inline namespace GYRE_TARGET_NAMESPACE {

// The compiler's vector types for W lanes; plain numbers for one lane. The loose ones may lie anywhere in memory.
template <int W>
struct Lanes {
  static_assert(W == 4 || W == 8 || W == 16);
  typedef float Float __attribute__((vector_size(4 * W)));
  typedef std::int32_t Int __attribute__((vector_size(4 * W)));
  typedef std::uint32_t Unsigned __attribute__((vector_size(4 * W)));
  typedef float AnyFloat __attribute__((vector_size(4 * W), may_alias));
  typedef float LooseFloat __attribute__((vector_size(4 * W), aligned(4), may_alias));
  typedef std::int32_t AnyInt __attribute__((vector_size(4 * W), may_alias));
  typedef std::int32_t LooseInt __attribute__((vector_size(4 * W), aligned(4), may_alias));
};
template <>
struct Lanes<1> {
  using Float = float;
  using Int = std::int32_t;
  using Unsigned = std::uint32_t;
  using AnyFloat = float;
  using LooseFloat = float;
  using AnyInt = std::int32_t;
  using LooseInt = std::int32_t;
};

}  // namespace GYRE_TARGET_NAMESPACE
}  // namespace gyre
