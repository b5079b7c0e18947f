// Persistent contacts: one slot for each pair of shapes whose fat boxes overlap. A contact keeps its manifolds, the
// impulses in them and what the pair's last look found out, from step to step.
//
// Slots are handed out lowest-free-first to new pairs in key order, so slot order is a function of history alone and
// everything that walks contacts walks them in slot order.
#pragma once

#include "base/array.h"
#include "base/flat_map.h"
#include "collision/proxy.h"
#include "geometry/manifold.h"

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
  std::uint16_t manifold_room = 0;   // 1, or kMaxMeshManifolds against meshes and height fields; 0: the slot is empty
  std::uint16_t manifold_count = 0;  // those in use now
  std::uint8_t sensor = 0;           // touches nothing, only reported
  std::uint8_t touching = 0;         // surfaces met at the last look (for events)
  std::uint8_t recycled = 0;         // the last look took the manifold over unchanged in the bodies' frames
  std::uint8_t ended = 0;            // fat boxes no longer overlap: to be removed
  ContactSurface surface;
  PairCache cache;
  Transform seen_a_from_b;           // relative pose of the shapes at the last full look
};

struct ContactStore {
  Array<Contact> contacts;             // by slot; empty slots have manifold_room 0
  Array<Manifold> manifolds;           // runs owned by contacts
  Array<std::uint32_t> free_contacts;  // a min-heap of empty slots
  Array<std::uint32_t> free_single;    // a min-heap of free manifold runs of length 1
  Array<std::uint32_t> free_mesh;      // a min-heap of free manifold runs of length kMaxMeshManifolds
  FlatMap<std::uint32_t> slot_of_pair; // pair_key -> slot; can be rebuilt from `contacts`

  std::uint32_t live = 0;
};

// What a new pair needs to know about its shapes.
struct PairShapes {
  std::uint32_t body_a = 0, body_b = 0;
  bool against_mesh = false;
  bool sensor = false;
  ContactSurface surface;
};

// Adds a contact (the pair must be new) / removes one; the manifolds' impulses go with it.
std::uint32_t add_contact(ContactStore& store, std::uint64_t key, const PairShapes& shapes);
void remove_contact(ContactStore& store, std::uint32_t slot);
// Builds slot_of_pair and the free lists anew from `contacts` (after loading a snapshot).
void rebuild_index(ContactStore& store);

inline std::span<Manifold> manifolds_of(ContactStore& store, const Contact& contact) {
  return {store.manifolds.data() + contact.first_manifold, contact.manifold_count};
}
inline std::span<const Manifold> manifolds_of(const ContactStore& store, const Contact& contact) {
  return {store.manifolds.data() + contact.first_manifold, contact.manifold_count};
}

}  // namespace gyre
