// Persistent contacts: one slot for each pair of shapes whose fat boxes overlap. A contact keeps its manifolds, the
// impulses in them and what the pair's last look found out, from step to step.
//
// Slots and manifold runs are handed out lowest-free-first, to new pairs in key order. So slot order is a function of
// history alone, everything that walks contacts walks them in slot order, and which places are free follows from the
// contacts themselves: a loaded snapshot goes on exactly as the world that wrote it.
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

// Mixed surface of a pair.
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
  std::uint16_t manifold_room =
      0;  // 1, or kMaxMeshManifolds against meshes and height fields; 0: the slot is empty
  std::uint16_t manifold_count = 0;  // those in use now
  std::uint8_t sensor = 0;           // touches nothing, only reported
  std::uint8_t touching = 0;         // surfaces met at the last look (for events)
  std::uint8_t recycled = 0;         // the last look took the manifold over unchanged in the bodies' frames
  std::uint8_t ended = 0;            // fat boxes no longer overlap: to be removed
  // What the last full look saw: how far it reached (no surfaces but those of the manifold's points were nearer then; below
  // zero: never looked), the size that the pair's tolerances are relative to, and B's body frame in A's.
  float cached_distance = -1.0f;  // m
  float size = 0.0f;     // m
  Transform seen_a_from_b;
  PairCache cache;
  ContactSurface surface;
};

// Where a contact hangs in the lists of its two shapes. A link is 2 * slot + side (0: in the list of shape_a).
struct ContactLinks {
  std::uint32_t previous[2];
  std::uint32_t next[2];
};
constexpr std::uint32_t kNoLink = 0xffffffffu;

// Places that are free, of which the lowest is handed out first.
class FreeSlots {
 public:
  static constexpr std::uint32_t kNone = 0xffffffffu;
  void clear() { *this = FreeSlots{}; }
  void release(std::uint32_t index);
  void acquire(std::uint32_t index);  // takes this very place; no effect if it is not free
  std::uint32_t lowest();          // kNone if none is free
  bool contains(std::uint32_t index) const { return free_.test(index); }

 private:
  Bitset free_;
  std::uint32_t hint_ = 0;  // nothing below is free
};

struct ContactStore {
  Array<Contact> contacts;             // by slot; empty slots have manifold_room 0
  PagedArray<Manifold, 64> manifolds;  // runs owned by contacts; a run lies within a page
  std::uint32_t live = 0;

  // The rest follows from `contacts` (rebuild_index makes it anew) and is no part of the state.
  SlotTable slot_of_pair;  // see find_contact
  Array<std::uint32_t>
      first_of_shape;         // by shape: the first link of its list, in no particular order; may be short
  Array<ContactLinks> links;  // by slot
  Bitset with_manifolds;      // by slot: clear where a contact has no manifold, for certain
  FreeSlots free_contacts;
  // Manifolds are handed out in chunks of kMaxMeshManifolds: a chunk is one run for a mesh contact, or singles.
  Array<std::uint8_t> chunk_used;  // bit i: manifold i of the chunk is in use
  FreeSlots free_chunks;           // chunks of which nothing is in use
  FreeSlots partial_chunks;        // chunks of which some singles are in use and some are free
  // By chunk, of those that belong to mesh contacts: what their looks keep of the mesh. As long as the last of these needs.
  Array<CachedTriangles> cached_triangles;
};

// What a new pair needs to know about its shapes.
struct PairShapes {
  std::uint32_t body_a = 0, body_b = 0;
  bool against_mesh = false;
  bool sensor = false;
  ContactSurface surface;
};

// How the table of pairs reads the key of a slot.
inline auto key_reader(const ContactStore& store) {
  return [&store](std::uint32_t slot) {
    return std::uint64_t(store.contacts[slot].shape_a) << 32 | store.contacts[slot].shape_b;
  };
}
// The slot of a pair's contact; SlotTable::kNone if it has none.
inline std::uint32_t find_contact(const ContactStore& store, std::uint64_t key) {
  return store.slot_of_pair.find(key, key_reader(store));
}
// Adds a contact (the pair must be new) / removes one; the manifolds' impulses go with it.
std::uint32_t add_contact(ContactStore& store, std::uint64_t key, const PairShapes& shapes);
void remove_contact(ContactStore& store, std::uint32_t slot);
// Builds everything but contacts and manifolds anew (after loading a snapshot).
void rebuild_index(ContactStore& store);
// Makes the next look at this contact a full one: something about one of its bodies changed that its pose does not show.
inline void invalidate_cache(Contact& contact) { contact.cached_distance = -1.0f; }

// Calls fn(slot) for each contact of a shape, in no particular order; fn must not add or remove contacts.
template <class Fn>
void for_each_contact_of_shape(const ContactStore& store, std::uint32_t shape, Fn&& fn) {
  if (shape >= store.first_of_shape.size()) return;
  for (std::uint32_t link = store.first_of_shape[shape]; link != kNoLink;
       link = store.links[link / 2].next[link % 2]) {
    fn(link / 2);
  }
}

// Null for a contact without a mesh or height field; of fields nothing is ever known.
inline CachedTriangles* cached_triangles_of(ContactStore& store, const Contact& contact) {
  return contact.manifold_room > 1 ? &store.cached_triangles[contact.first_manifold / kMaxMeshManifolds]
                                   : nullptr;
}

// Whether indices, lists and free places agree with the contacts. Walks everything; for tests and debug builds. Null if
// all is well, otherwise what is not, in words.
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
