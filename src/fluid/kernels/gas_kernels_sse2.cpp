// The kernels of gases for one kind of CPU, in a namespace of its own so that the linker can never mix them with others'.
#define GYRE_TARGET_NAMESPACE target_sse2
#include "fluid/kernels/gas_kernel.h"

// WebAssembly without SIMD would have every lane's code one after the other: its kernels are those of width 1.
#if !defined(__wasm__) || defined(__wasm_simd128__)
namespace gyre {

extern const GasKernels kGasKernels_sse2;
const GasKernels kGasKernels_sse2 = gas_kernels<4>();

}  // namespace gyre
#endif
