// Contact recycling for one kind of CPU, in its own namespace so that the linker cannot mix kinds.
#define GYRE_TARGET_NAMESPACE target_sse2
#include "collision/contact/contact_recycle_lanes.h"

// WebAssembly without SIMD would run the lanes one after the other; it uses the kernel of width 1.
#if !defined(__wasm__) || defined(__wasm_simd128__)
namespace gyre {

extern const RecycleContacts kRecycleContacts_sse2;
const RecycleContacts kRecycleContacts_sse2 = recycle_contacts<4>;

}  // namespace gyre
#endif
