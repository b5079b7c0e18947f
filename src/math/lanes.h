// The compiler's part in all wide kernels (math/wide.h): the CPU's instructions, attributes for inlining and unrolling,
// and the vector types of W lanes.
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

// Functions must be inlined even in debug builds: a call would pass vectors through memory, and the namespace of a CPU
// kind (math/wide.h) exists to prevent emitted copies.
#define GYRE_INLINE inline __attribute__((always_inline))

#ifndef GYRE_TARGET_NAMESPACE
#define GYRE_TARGET_NAMESPACE w_default
#endif

// Vectors wider than the CPU's registers have no stable calling convention, which the compiler notes; here nothing is
// called.
#pragma GCC diagnostic ignored "-Wpsabi"

// GYRE_UNROLL: before a short loop over lanes or columns whose arrays must become registers. GYRE_ROLLED: before a loop
// with a long body, which a compiler would copy several times.
#if defined(__clang__)
#define GYRE_UNROLL _Pragma("clang loop unroll(full)")
#define GYRE_ROLLED _Pragma("clang loop unroll(disable)")
#else
#define GYRE_UNROLL _Pragma("GCC unroll 16")
#define GYRE_ROLLED _Pragma("GCC unroll 1")
#endif

namespace gyre {
inline namespace GYRE_TARGET_NAMESPACE {

// The compiler's vector types for W lanes; plain numbers for one lane. Loose ones may have any address.
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
