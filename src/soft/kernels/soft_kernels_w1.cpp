// The kernels of soft bodies for one kind of CPU, in a namespace of its own so that the linker can never mix them with others'.
#define GYRE_TARGET_NAMESPACE target_w1
#include "soft/kernels/soft_kernel.h"

namespace gyre {

extern const SoftKernels kSoftKernels_w1;
const SoftKernels kSoftKernels_w1 = soft_kernels<1>();

}  // namespace gyre
