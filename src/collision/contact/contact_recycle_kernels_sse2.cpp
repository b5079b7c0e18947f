// Recycling of contacts for one kind of CPU, in a namespace of its own so that the linker can never mix it with others'.
#define GYRE_TARGET_NAMESPACE target_sse2
#include "collision/contact/contact_recycle_lanes.h"

// WebAssembly without SIMD would have every lane's code one after the other: its kernel is that of width 1.
#if !defined(__wasm__) || defined(__wasm_simd128__)
namespace gyre {

extern const RecycleContacts kRecycleContacts_sse2;
const RecycleContacts kRecycleContacts_sse2 = recycle_contacts<4>;

}  // namespace gyre
#endif
