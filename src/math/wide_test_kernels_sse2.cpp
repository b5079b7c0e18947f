// The wide operations as the CPU kind 'sse2' computes them; see wide_test_kernels.h.
#define GYRE_TARGET_NAMESPACE w_test_sse2
#include "math/wide_test_kernels.h"

namespace gyre {

void run_wide_test_sse2(int width, const float* inputs, int count, std::uint32_t* results) {
  run_wide_test(width, inputs, count, results);
}

}  // namespace gyre
