// The wide operations as the CPU kind 'wasm' computes them; see wide_test_kernels.h.
#define GYRE_TARGET_NAMESPACE w_test_wasm
#include "math/wide_test_kernels.h"

namespace gyre {

void run_wide_test_wasm(int width, const float* inputs, int count, std::uint32_t* results) {
  run_wide_test(width, inputs, count, results);
}

}  // namespace gyre
