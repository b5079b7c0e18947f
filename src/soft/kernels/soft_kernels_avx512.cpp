// The kernels of soft bodies for one kind of CPU, in a namespace of its own so that the linker can never mix them with others'.
#define GYRE_TARGET_NAMESPACE target_avx512
#include "soft/kernels/soft_kernel.h"

namespace gyre {

extern const SoftKernels kSoftKernels_avx512;
const SoftKernels kSoftKernels_avx512 = soft_kernels<16>();

}  // namespace gyre
