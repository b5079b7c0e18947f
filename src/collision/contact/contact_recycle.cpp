// Chooses how many contacts are recycled side by side on this machine.
#include "collision/contact/contact_recycle.h"

#include "base/processor.h"

namespace gyre {

extern const RecycleContacts kRecycleContacts_w1;
extern const RecycleContacts kRecycleContacts_sse2;
#if defined(__x86_64__)
extern const RecycleContacts kRecycleContacts_avx2;
#endif

RecycleContacts select_recycling(int width) {
  const int lanes = lanes_for(width);
#if defined(__x86_64__)
  if (lanes >= 8) return kRecycleContacts_avx2;
#endif
  if constexpr (kLanesOfAll >= 4) {
    if (lanes >= 4) return kRecycleContacts_sse2;
  }
  return kRecycleContacts_w1;
}

}  // namespace gyre
