// How many floats this machine's processor works on side by side: for those who choose kernels when a program or a world begins. A choice
// never changes a bit of a result.
#pragma once

namespace gyre {

// Lanes that kernels have on every processor for which this program is built. (WebAssembly without SIMD would have every lane's code one
// after the other.)
#if defined(__wasm__) && !defined(__wasm_simd128__)
inline constexpr int kLanesOfAll = 1;
#else
inline constexpr int kLanesOfAll = 4;
#endif

// Lanes that the processor has instructions for: 16 (AVX-512 with what the kernels use of it), 8 (AVX2), or
// kLanesOfAll.
int max_lanes();

// Lanes with which kernels run fastest, at most max_lanes(). 16 only where they were measured to pay: on AMD's from family 1Ah on (Zen 5),
// where registers of 512 bits are as wide within, and on Intel's from Sapphire Rapids on, which do not slow down for them and are known by
// their arithmetic of half floats. Elsewhere what they save in instructions is lost again on the way (docs/performance_trials.md): there eight
// lanes have kernels that use the 32 registers.
int best_lanes();

// What somebody asked for, 0 being the best, as far as the processor has it.
inline int lanes_for(int requested) {
  if (requested == 0) return best_lanes();
  const int max = max_lanes();
  return requested < max ? requested : max;
}

}  // namespace gyre
