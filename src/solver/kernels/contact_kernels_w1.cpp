// The contact kernels for one kind of CPU, in a namespace of its own so that the linker can never mix them with others'.
#define GYRE_TARGET_NAMESPACE target_w1
#include "solver/kernels/contact_kernel_table.h"

namespace gyre {

extern const ContactKernels kContactKernels_w1;
const ContactKernels kContactKernels_w1 = contact_kernels<1>();

}  // namespace gyre
