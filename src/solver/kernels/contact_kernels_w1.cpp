// The kernels for one CPU target, in a namespace of its own so that the linker never mixes targets.
#define GYRE_TARGET_NAMESPACE target_w1
#include "solver/kernels/contact_kernel_table.h"

namespace gyre {

extern const ContactKernels kContactKernels_w1;
const ContactKernels kContactKernels_w1 = contact_kernels<1>();

}  // namespace gyre
