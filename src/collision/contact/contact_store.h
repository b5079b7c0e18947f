// Persistent contacts: one slot for each pair of shapes whose fat boxes overlap. A contact keeps its manifolds, their
// impulses and the results of the pair's last update from step to step.
//
// A new pair takes the lowest free slot and the lowest free run of manifolds, in the order of pair keys. So slot order
// depends on history alone, and every loop over contacts follows it. The free slots follow from the contacts; a loaded
// snapshot therefore continues exactly as the world that wrote it.
#pragma once

#include "base/container/array.h"
#include "base/container/bitset.h"
#include "base/container/paged_array.h"
#include "base/container/slot_table.h"
#include "collision/broadphase/proxy.h"
#include "geometry/manifold/manifold.h"
#include "geometry/manifold_mesh/cached_triangles.h"

#include <cstdint>
#include <span>

namespace gyre {

// Mixed surface properties of a pair.
struct ContactSurface {
  float static_friction = 0.0f;
  float dynamic_friction = 0.0f;
  float restitution = 0.0f;
  float rolling_friction = 0.0f;
  float spinning_friction = 0.0f;
};

struct Contact {
  std::uint32_t shape_a = 0;  // the lower index
  std::uint32_t shape_b = 0;
  std::uint32_t body_a = 0;
  std::uint32_t body_b = 0;
  std::uint32_t first_manifold = 0;  // into ContactStore::manifolds
  std::uint16_t manifold_room = 0;   // 1; kMaxMeshManifolds against surfaces; 0: empty slot
  std::uint16_t manifold_count = 0;  // in use now
  std::uint8_t sensor = 0;           // only reports overlap
  std::uint8_t touching = 0;         // the surfaces touched at the last update (for events)
  std::uint8_t recycled = 0;         // the last update recycled the manifold
  std::uint8_t ended = 0;            // the fat boxes no longer overlap: to be removed
  // Results of the last full update. Within `cached_distance` there were no surfaces but those of the manifold's
  // points; negative before the first update. `size` is the scale of the pair's tolerances. `seen_a_from_b` is B's body
  // frame in A's.
  float cached_distance = -1.0f;  // m
  float size = 0.0f;              // m
  Transform seen_a_from_b;
  PairCache cache;
  ContactSurface surface;
};

// The links of a contact in the lists of its two shapes. A link is 2 * slot + side (0: in the list of shape_a).
struct ContactLinks {
  std::uint32_t previous[2];
  std::uint32_t next[2];
};
constexpr std::uint32_t kNoLink = 0xffffffffu;

// `cached_distance` of a sensor's contact that must be updated even if neither body moves: it is new, or a command halted a
// kinematic body after its last update.
constexpr float kUnseen = -2.0f;  // m
inline bool is_unseen(const Contact& contact) { return contact.cached_distance == kUnseen; }

// Free slots; the lowest is handed out first.
class FreeSlots {
 public:
  static constexpr std::uint32_t kNone = 0xffffffffu;
  void clear() { *this = FreeSlots{}; }
  void release(std::uint32_t index);
  void acquire(std::uint32_t index);  // takes this slot; no effect if it is not free
  std::uint32_t lowest();             // kNone if none is free
  bool contains(std::uint32_t index) const { return free_.test(index); }

 private:
  Bitset free_;
  std::uint32_t hint_ = 0;  // no free slot is below
};

struct ContactStore {
  Array<Contact> contacts;             // by slot; empty slots have manifold_room 0
  PagedArray<Manifold, 64> manifolds;  // runs owned by contacts; each run lies within one page
  std::uint32_t live = 0;

  // Everything below follows from `contacts` (see rebuild_index) and is not state.
  SlotTable slot_of_pair;  // see find_contact
  Array<std::uint32_t>
      first_of_shape;         // by shape, may be short: the first link of its list, in no particular order
  Array<ContactLinks> links;  // by slot
  Bitset with_manifolds;      // by slot: clear if the contact has no manifold for certain
  FreeSlots free_contacts;
  // Manifolds are handed out in chunks of kMaxMeshManifolds; a chunk is one run for a mesh contact, or single
  // manifolds.
  Array<std::uint8_t> chunk_used;  // bit i: manifold i of the chunk is in use
  FreeSlots free_chunks;           // unused chunks
  FreeSlots partial_chunks;        // chunks with used and free single manifolds
  // By chunk, for chunks of mesh contacts. As long as the last of these needs.
  Array<CachedTriangles> cached_triangles;
};

// Facts about the shapes of a new pair.
struct PairShapes {
  std::uint32_t body_a = 0, body_b = 0;
  bool against_mesh = false;
  bool sensor = false;
  ContactSurface surface;
};

// Reads the key of a slot for the table of pairs.
inline auto key_reader(const ContactStore& store) {
  return [&store](std::uint32_t slot) {
    return std::uint64_t(store.contacts[slot].shape_a) << 32 | store.contacts[slot].shape_b;
  };
}
// The slot of a pair's contact, or SlotTable::kNone.
inline std::uint32_t find_contact(const ContactStore& store, std::uint64_t key) {
  return store.slot_of_pair.find(key, key_reader(store));
}
// Adds the contact of a new pair, or removes a contact with its impulses.
std::uint32_t add_contact(ContactStore& store, std::uint64_t key, const PairShapes& shapes);
void remove_contact(ContactStore& store, std::uint32_t slot);
// Rebuilds everything but contacts and manifolds, after a snapshot was loaded.
void rebuild_index(ContactStore& store);
// Makes the next update of this contact a full one, after a change of a body that its pose does not show.
inline void invalidate_cache(Contact& contact) {
  if (!is_unseen(contact)) contact.cached_distance = -1.0f;
}

// Calls fn(slot) for each contact of a shape, in no particular order; fn must not add or remove contacts.
template <class Fn>
void for_each_contact_of_shape(const ContactStore& store, std::uint32_t shape, Fn&& fn) {
  if (shape >= store.first_of_shape.size()) return;
  for (std::uint32_t link = store.first_of_shape[shape]; link != kNoLink;
       link = store.links[link / 2].next[link % 2]) {
    fn(link / 2);
  }
}

// Null for a contact without a mesh or height field. For height fields nothing is cached.
inline CachedTriangles* cached_triangles_of(ContactStore& store, const Contact& contact) {
  return contact.manifold_room > 1 ? &store.cached_triangles[contact.first_manifold / kMaxMeshManifolds]
                                   : nullptr;
}

// Checks that indices, lists and free slots agree with the contacts. Visits everything; for tests and debug builds.
// Null if all is well, otherwise the fault in words.
const char* find_fault(const ContactStore& store);

inline std::span<Manifold> manifolds_of(ContactStore& store, const Contact& contact) {
  if (contact.manifold_count == 0) return {};
  return {&store.manifolds[contact.first_manifold], contact.manifold_count};
}
inline std::span<const Manifold> manifolds_of(const ContactStore& store, const Contact& contact) {
  if (contact.manifold_count == 0) return {};
  return {&store.manifolds[contact.first_manifold], contact.manifold_count};
}

}  // namespace gyre
