// Chooses the kernels of soft bodies for this machine.
#include "soft/kernels/soft_kernels.h"

#include "base/processor.h"

namespace gyre {

extern const SoftKernels kSoftKernels_w1;
extern const SoftKernels kSoftKernels_sse2;
#if defined(__x86_64__)
extern const SoftKernels kSoftKernels_avx2;
extern const SoftKernels kSoftKernels_avx512;
#endif

const SoftKernels& select_soft_kernels(int width) {
  const int lanes = lanes_for(width);
#if defined(__x86_64__)
  if (lanes >= 16) return kSoftKernels_avx512;
  if (lanes >= 8) return kSoftKernels_avx2;
#endif
  if constexpr (kLanesOfAll >= 4) {
    if (lanes >= 4) return kSoftKernels_sse2;
  }
  return kSoftKernels_w1;
}

}  // namespace gyre
