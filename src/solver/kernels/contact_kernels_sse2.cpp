// The kernels for one CPU target, in a namespace of its own so that the linker never mixes targets.
#define GYRE_TARGET_NAMESPACE target_sse2
#include "solver/kernels/contact_kernel_table.h"

// WebAssembly without SIMD would run every lane's code one after the other, so its kernels are those of width
// 1.
#if !defined(__wasm__) || defined(__wasm_simd128__)
namespace gyre {

extern const ContactKernels kContactKernels_sse2;
const ContactKernels kContactKernels_sse2 = contact_kernels<4>();

}  // namespace gyre
#endif
