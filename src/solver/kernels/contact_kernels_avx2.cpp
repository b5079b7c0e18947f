// The kernels for one CPU target, in a namespace of its own so that the linker never mixes targets.
#define GYRE_TARGET_NAMESPACE target_avx2
#include "solver/kernels/contact_kernel_table.h"

namespace gyre {

extern const ContactKernels kContactKernels_avx2;
const ContactKernels kContactKernels_avx2 = contact_kernels<8>();

}  // namespace gyre
