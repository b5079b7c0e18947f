// The kernels of gases for one kind of CPU, in a namespace of its own so that the linker can never mix them with others'.
#define GYRE_TARGET_NAMESPACE target_avx512
#include "fluid/kernels/gas_kernel.h"

namespace gyre {

extern const GasKernels kGasKernels_avx512;
const GasKernels kGasKernels_avx512 = gas_kernels<16>();

}  // namespace gyre
