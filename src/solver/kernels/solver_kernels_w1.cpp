// The kernels for one kind of CPU, in a namespace of its own so that the linker can never mix them with others'.
#define GYRE_TARGET_NAMESPACE target_w1
#include "solver/kernels/kernel_table.h"

namespace gyre {

extern const SolverKernels kSolverKernels_w1;
const SolverKernels kSolverKernels_w1 = solver_kernels<1>();

}  // namespace gyre
