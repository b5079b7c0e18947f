// The kernels of soft bodies for one kind of CPU, in a namespace of its own so that the linker can never mix them with others'.
#define GYRE_TARGET_NAMESPACE target_sse2
#include "soft/kernels/soft_kernel.h"

// WebAssembly without SIMD would have every lane's code one after the other: its kernels are those of width 1.
#if !defined(__wasm__) || defined(__wasm_simd128__)
namespace gyre {

extern const SoftKernels kSoftKernels_sse2;
const SoftKernels kSoftKernels_sse2 = soft_kernels<4>();

}  // namespace gyre
#endif
