// Chooses the kernels of gases for this machine.
#include "fluid/kernels/gas_kernels.h"

#include "base/processor.h"

namespace gyre {

extern const GasKernels kGasKernels_w1;
extern const GasKernels kGasKernels_sse2;
#if defined(__x86_64__)
extern const GasKernels kGasKernels_avx2;
extern const GasKernels kGasKernels_avx512;
#endif

const GasKernels& select_gas_kernels(int width) {
  const int lanes = lanes_for(width);
#if defined(__x86_64__)
  if (lanes >= 16) return kGasKernels_avx512;
  if (lanes >= 8) return kGasKernels_avx2;
#endif
  if constexpr (kLanesOfAll >= 4) {
    if (lanes >= 4) return kGasKernels_sse2;
  }
  return kGasKernels_w1;
}

}  // namespace gyre
