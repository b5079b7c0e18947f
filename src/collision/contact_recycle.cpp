// Chooses how many contacts are recycled side by side on this machine.
#include "collision/contact_recycle.h"

namespace gyre {

#if defined(__wasm__) && !defined(__wasm_simd128__)
constexpr bool kHasFour = false;
#else
constexpr bool kHasFour = true;
#endif

extern const RecycleContacts kRecycleContacts_w1;
extern const RecycleContacts kRecycleContacts_sse2;
#if defined(__x86_64__)
extern const RecycleContacts kRecycleContacts_avx2;
#endif

RecycleContacts select_recycling(int width) {
#if defined(__x86_64__)
  if ((width == 0 || width >= 8) && __builtin_cpu_supports("avx2")) return kRecycleContacts_avx2;
#endif
  if constexpr (kHasFour) {
    if (width == 0 || width >= 4) return kRecycleContacts_sse2;
  }
  return kRecycleContacts_w1;
}

}  // namespace gyre
