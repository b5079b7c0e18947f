// Contact recycling for one kind of CPU, in its own namespace so that the linker cannot mix kinds.
#define GYRE_TARGET_NAMESPACE target_avx2
#include "collision/contact/contact_recycle_lanes.h"

namespace gyre {

extern const RecycleContacts kRecycleContacts_avx2;
const RecycleContacts kRecycleContacts_avx2 = recycle_contacts<8>;

}  // namespace gyre
