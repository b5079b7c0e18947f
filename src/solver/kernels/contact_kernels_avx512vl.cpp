// The kernels for one CPU target, in a namespace of its own so that the linker never mixes targets.
#define GYRE_TARGET_NAMESPACE target_avx512vl
#include "solver/kernels/contact_kernel_table.h"

namespace gyre {

extern const ContactKernels kContactKernels_avx512vl;
const ContactKernels kContactKernels_avx512vl = contact_kernels<8>();

}  // namespace gyre
