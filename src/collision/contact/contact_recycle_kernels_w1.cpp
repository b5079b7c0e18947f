// Contact recycling for one kind of CPU, in its own namespace so that the linker cannot mix kinds.
#define GYRE_TARGET_NAMESPACE target_w1
#include "collision/contact/contact_recycle_lanes.h"

namespace gyre {

extern const RecycleContacts kRecycleContacts_w1;
const RecycleContacts kRecycleContacts_w1 = recycle_contacts<1>;

}  // namespace gyre
