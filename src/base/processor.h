// The number of floats that this machine's processor handles side by side, to choose kernels when a program or a world
// starts. The choice never changes a bit of a result.
#pragma once

namespace gyre {

// Lanes available on every processor for which this program is built. (WebAssembly without SIMD would run the lanes one
// after the other.)
#if defined(__wasm__) && !defined(__wasm_simd128__)
inline constexpr int kLanesOfAll = 1;
#else
inline constexpr int kLanesOfAll = 4;
#endif

// Lanes for which the processor has instructions: 16 (AVX-512 with the extensions that the kernels use), 8 (AVX2), or
// kLanesOfAll.
int max_lanes();

// The fastest number of lanes, at most max_lanes(). 16 only where measurements favour it: on AMD from family 1Ah on
// (Zen 5), whose 512-bit registers are as wide inside, and on Intel from Sapphire Rapids on, which does not slow down
// for them (known by its half-float arithmetic). Elsewhere the saved instructions gain no time
// (docs/performance_trials.md); eight lanes there have kernels that use the 32 registers.
int best_lanes();

// The requested number of lanes (0: the best), limited to what the processor has.
inline int lanes_for(int requested) {
  if (requested == 0) return best_lanes();
  const int max = max_lanes();
  return requested < max ? requested : max;
}

}  // namespace gyre
