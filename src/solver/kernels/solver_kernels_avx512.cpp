// The kernels for one kind of CPU, in a namespace of its own so that the linker can never mix them with others'.
#define GYRE_TARGET_NAMESPACE target_avx512
#include "solver/kernels/kernel_table.h"

namespace gyre {

extern const SolverKernels kSolverKernels_avx512;
const SolverKernels kSolverKernels_avx512 = solver_kernels<16>();

}  // namespace gyre
