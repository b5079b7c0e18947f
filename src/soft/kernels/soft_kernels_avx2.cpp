// The kernels of soft bodies for one kind of CPU, in a namespace of its own so that the linker can never mix them with others'.
#define GYRE_TARGET_NAMESPACE target_avx2
#include "soft/kernels/soft_kernel.h"

namespace gyre {

extern const SoftKernels kSoftKernels_avx2;
const SoftKernels kSoftKernels_avx2 = soft_kernels<8>();

}  // namespace gyre
