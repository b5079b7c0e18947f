// Chooses the contact kernels for this machine when a world is made.
#include "solver/contact_block.h"

namespace gyre {

#if defined(__wasm__) && !defined(__wasm_simd128__)
constexpr bool kHasFour = false;  // see contact_kernels_sse2.cpp
#else
constexpr bool kHasFour = true;
#endif

extern const ContactKernels kContactKernels_w1;
extern const ContactKernels kContactKernels_sse2;
#if defined(__x86_64__)
extern const ContactKernels kContactKernels_avx2;
extern const ContactKernels kContactKernels_avx512;
#endif

const ContactKernels& select_contact_kernels(int width) {
  const int most = width == 0 ? 8 : width;
#if defined(__x86_64__)
  if (most >= 16 && __builtin_cpu_supports("avx512f") && __builtin_cpu_supports("avx512vl") &&
      __builtin_cpu_supports("avx512dq") && __builtin_cpu_supports("avx512bw")) {
    return kContactKernels_avx512;
  }
  if (most >= 8 && __builtin_cpu_supports("avx2")) return kContactKernels_avx2;
#endif
  if constexpr (kHasFour) {
    if (most >= 4) return kContactKernels_sse2;
  }
  return kContactKernels_w1;
}

}  // namespace gyre
