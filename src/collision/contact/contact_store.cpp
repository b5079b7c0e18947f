// Adds and removes contacts and keeps the indices over them. See contact_store.h.
#include "collision/contact/contact_store.h"

#include "base/check.h"

#include <bit>
#include <cstring>

namespace gyre {
namespace {

constexpr std::uint32_t kChunk = kMaxMeshManifolds;
constexpr std::uint8_t kWholeChunk = 0xff;
static_assert(kChunk == 8, "a byte has a bit for each manifold of a chunk");

std::uint32_t add_chunk(ContactStore& store) {
  const auto chunk = std::uint32_t(store.chunk_used.size());
  store.chunk_used.push_back(0);
  store.manifolds.resize(store.manifolds.size() + kChunk);
  store.free_chunks.release(chunk);
  return chunk;
}

std::uint32_t acquire_manifolds(ContactStore& store, std::uint16_t room) {
  if (room == 1) {
    if (const std::uint32_t chunk = store.partial_chunks.lowest(); chunk != FreeSlots::kNone) {
      std::uint8_t& used = store.chunk_used[chunk];
      const auto index = std::uint32_t(std::countr_one(used));
      used = std::uint8_t(used | 1u << index);
      if (used == kWholeChunk) store.partial_chunks.acquire(chunk);
      return chunk * kChunk + index;
    }
  }
  std::uint32_t chunk = store.free_chunks.lowest();
  if (chunk == FreeSlots::kNone) chunk = add_chunk(store);
  store.free_chunks.acquire(chunk);
  store.chunk_used[chunk] = room == 1 ? std::uint8_t(1) : kWholeChunk;
  if (room == 1) store.partial_chunks.release(chunk);
  return chunk * kChunk;
}

void release_manifolds(ContactStore& store, std::uint32_t first, std::uint16_t room) {
  const std::uint32_t chunk = first / kChunk;
  std::uint8_t& used = store.chunk_used[chunk];
  used = room == 1 ? std::uint8_t(used & ~(1u << first % kChunk)) : std::uint8_t(0);
  if (used == 0) {
    store.partial_chunks.acquire(chunk);
    store.free_chunks.release(chunk);
  } else {
    store.partial_chunks.release(chunk);
  }
}

// A new mesh contact has no cached triangles.
void clear_cached_triangles(ContactStore& store, const Contact& contact) {
  const std::size_t chunk = contact.first_manifold / kChunk;
  if (store.cached_triangles.size() <= chunk) store.cached_triangles.resize(chunk + 1);
  store.cached_triangles[chunk].count = CachedTriangles::kUnknown;
}

void link(ContactStore& store, std::uint32_t slot) {
  const Contact& contact = store.contacts[slot];
  if (store.first_of_shape.size() <= contact.shape_b) {
    store.first_of_shape.resize(std::size_t(contact.shape_b) + 1, kNoLink);  // shape_b is the higher index
  }
  const std::uint32_t shapes[2] = {contact.shape_a, contact.shape_b};
  for (std::uint32_t side = 0; side < 2; ++side) {
    std::uint32_t& first = store.first_of_shape[shapes[side]];
    store.links[slot].previous[side] = kNoLink;
    store.links[slot].next[side] = first;
    if (first != kNoLink) store.links[first / 2].previous[first % 2] = 2 * slot + side;
    first = 2 * slot + side;
  }
}

void unlink(ContactStore& store, std::uint32_t slot) {
  const Contact& contact = store.contacts[slot];
  const std::uint32_t shapes[2] = {contact.shape_a, contact.shape_b};
  for (std::uint32_t side = 0; side < 2; ++side) {
    const std::uint32_t previous = store.links[slot].previous[side];
    const std::uint32_t next = store.links[slot].next[side];
    if (previous != kNoLink) {
      store.links[previous / 2].next[previous % 2] = next;
    } else {
      store.first_of_shape[shapes[side]] = next;
    }
    if (next != kNoLink) store.links[next / 2].previous[next % 2] = previous;
  }
}

}  // namespace

void FreeSlots::release(std::uint32_t index) {
  if (index >= free_.size()) free_.resize(std::size_t(index) + 1);
  free_.set(index);
  hint_ = min(hint_, index);
}

void FreeSlots::acquire(std::uint32_t index) {
  if (free_.test(index)) free_.clear(index);
}

std::uint32_t FreeSlots::lowest() {
  const std::size_t found = free_.find_next(hint_);
  hint_ = std::uint32_t(found);
  return found == free_.size() ? kNone : hint_;
}

std::uint32_t add_contact(ContactStore& store, std::uint64_t key, const PairShapes& shapes) {
  GYRE_ASSERT(find_contact(store, key) == SlotTable::kNone, "a pair has one contact");
  std::uint32_t slot = store.free_contacts.lowest();
  if (slot == FreeSlots::kNone) {
    slot = std::uint32_t(store.contacts.size());
    store.contacts.emplace_back();
    store.links.emplace_back();
    store.with_manifolds.resize(store.contacts.size());
  } else {
    store.free_contacts.acquire(slot);
  }
  Contact contact;
  contact.shape_a = std::uint32_t(key >> 32);
  contact.shape_b = std::uint32_t(key);
  contact.body_a = shapes.body_a;
  contact.body_b = shapes.body_b;
  contact.manifold_room = shapes.against_mesh ? std::uint16_t(kMaxMeshManifolds) : std::uint16_t(1);
  contact.first_manifold = acquire_manifolds(store, contact.manifold_room);
  contact.sensor = shapes.sensor ? 1 : 0;
  if (shapes.sensor) contact.cached_distance = kUnseen;
  contact.surface = shapes.surface;
  store.contacts[slot] = contact;
  if (shapes.against_mesh) clear_cached_triangles(store, contact);
  store.slot_of_pair.insert(key, slot, key_reader(store));
  link(store, slot);
  ++store.live;
  return slot;
}

void remove_contact(ContactStore& store, std::uint32_t slot) {
  const Contact contact = store.contacts[slot];
  GYRE_ASSERT(contact.manifold_room != 0, "the contact exists");
  unlink(store, slot);
  store.slot_of_pair.erase(pair_key(contact.shape_a, contact.shape_b), key_reader(store));
  // Unused manifolds are cleared, because hashes and snapshots include them.
  for (Manifold& manifold : manifolds_of(store, contact)) manifold = Manifold{};
  release_manifolds(store, contact.first_manifold, contact.manifold_room);
  store.contacts[slot] = Contact{};
  store.with_manifolds.clear(slot);
  store.free_contacts.release(slot);
  --store.live;
}

namespace {

// As clear(), but keeps the memory, since batches of worlds return to their start often.
void take_all_slots(FreeSlots& slots) {
  for (std::uint32_t slot = slots.lowest(); slot != FreeSlots::kNone; slot = slots.lowest()) slots.acquire(slot);
}

}  // namespace

void rebuild_index(ContactStore& store) {
  const std::size_t count = store.contacts.size();
  store.slot_of_pair.clear();
  store.first_of_shape.clear();
  store.links.clear();
  store.links.resize(count);
  store.with_manifolds.resize(count);
  store.with_manifolds.reset_all();
  take_all_slots(store.free_contacts);
  take_all_slots(store.free_chunks);
  take_all_slots(store.partial_chunks);
  store.cached_triangles.clear();
  store.chunk_used.assign(store.manifolds.size() / kChunk, 0);
  store.live = 0;
  for (std::uint32_t slot = 0; slot < count; ++slot) {
    const Contact& contact = store.contacts[slot];
    if (contact.manifold_room == 0) {
      store.free_contacts.release(slot);
      continue;
    }
    store.slot_of_pair.insert(pair_key(contact.shape_a, contact.shape_b), slot, key_reader(store));
    link(store, slot);
    ++store.live;
    store.with_manifolds.assign(slot, contact.manifold_count != 0);
    if (contact.manifold_room > 1) clear_cached_triangles(store, contact);
    std::uint8_t& used = store.chunk_used[contact.first_manifold / kChunk];
    used =
        contact.manifold_room == 1 ? std::uint8_t(used | 1u << contact.first_manifold % kChunk) : kWholeChunk;
  }
  for (std::uint32_t chunk = 0; chunk < store.chunk_used.size(); ++chunk) {
    const std::uint8_t used = store.chunk_used[chunk];
    if (used == 0) store.free_chunks.release(chunk);
    if (used != 0 && used != kWholeChunk) store.partial_chunks.release(chunk);
  }
}

namespace {

bool is_clear(const Manifold& manifold) {
  const Manifold clear{};
  return std::memcmp(&manifold, &clear, sizeof clear) == 0;
}

// True if the unused points of the manifold are as new.
bool ends_with_its_points(const Manifold& manifold) {
  const Manifold clear{};
  const auto unused = std::size_t(kMaxManifoldPoints - manifold.count);
  return std::memcmp(manifold.points + manifold.count, clear.points, unused * sizeof clear.points[0]) == 0 &&
         std::memcmp(manifold.anchors + manifold.count, clear.anchors, unused * sizeof clear.anchors[0]) == 0;
}

const char* find_fault(const ContactStore& store, std::uint32_t slot, Array<std::uint8_t>& used) {
  const Contact& contact = store.contacts[slot];
  if (contact.shape_a >= contact.shape_b) return "a contact's first shape is not the lower one";
  if (contact.manifold_room != 1 && contact.manifold_room != kMaxMeshManifolds)
    return "manifold_room is wrong";
  if (contact.manifold_count > contact.manifold_room) return "more manifolds than there is room";
  const std::uint32_t end = contact.first_manifold + contact.manifold_room;
  if (end > store.manifolds.size()) return "a manifold run ends beyond the array";
  for (std::uint32_t i = contact.first_manifold; i < end; ++i) {
    const std::uint8_t bit = std::uint8_t(1u << i % kChunk);
    if ((used[i / kChunk] & bit) != 0) return "two contacts own one manifold";
    used[i / kChunk] = std::uint8_t(used[i / kChunk] | bit);
  }
  for (const Manifold& manifold : manifolds_of(store, contact))
    if (!ends_with_its_points(manifold)) return "an unused point of a manifold is not clear";
  for (std::uint32_t i = contact.first_manifold + contact.manifold_count; i < end; ++i)
    if (!is_clear(store.manifolds[i])) return "an unused manifold of a contact is not clear";
  if (find_contact(store, pair_key(contact.shape_a, contact.shape_b)) != slot)
    return "the index does not lead to the contact";
  const std::uint32_t shapes[2] = {contact.shape_a, contact.shape_b};
  for (std::uint32_t side = 0; side < 2; ++side) {
    const std::uint32_t self = 2 * slot + side;
    const std::uint32_t previous = store.links[slot].previous[side];
    const std::uint32_t next = store.links[slot].next[side];
    const std::uint32_t from = previous == kNoLink ? store.first_of_shape[shapes[side]]
                                                   : store.links[previous / 2].next[previous % 2];
    if (from != self) return "a contact's list does not lead to it";
    if (next != kNoLink && store.links[next / 2].previous[next % 2] != self)
      return "a contact's list does not lead back";
  }
  return nullptr;
}

}  // namespace

const char* find_fault(const ContactStore& store) {
  if (store.links.size() != store.contacts.size()) return "a contact has no links";
  if (store.chunk_used.size() * kChunk != store.manifolds.size()) return "manifolds do not fill chunks";
  Array<std::uint8_t> used;
  used.resize(store.chunk_used.size());
  std::uint32_t live = 0;
  for (std::uint32_t slot = 0; slot < store.contacts.size(); ++slot) {
    const bool empty = store.contacts[slot].manifold_room == 0;
    if (store.free_contacts.contains(slot) != empty) return "free slots are not the empty ones";
    if (empty) continue;
    ++live;
    if (store.contacts[slot].manifold_count != 0 && !store.with_manifolds.test(slot))
      return "the bit of a contact with manifolds is clear";
    if (const char* const fault = find_fault(store, slot, used)) return fault;
  }
  if (live != store.live || live != store.slot_of_pair.size()) return "the number of contacts is wrong";
  for (std::uint32_t chunk = 0; chunk < used.size(); ++chunk) {
    if (used[chunk] != store.chunk_used[chunk]) return "a chunk's record differs from what contacts own";
    if (store.free_chunks.contains(chunk) != (used[chunk] == 0)) return "free chunks are not the unused ones";
    const bool partial = used[chunk] != 0 && used[chunk] != kWholeChunk;
    if (store.partial_chunks.contains(chunk) != partial) return "partial chunks are not the partly used ones";
    for (std::uint32_t i = 0; i < kChunk; ++i)
      if ((used[chunk] >> i & 1u) == 0 && !is_clear(store.manifolds[chunk * kChunk + i]))
        return "a manifold of no contact is not clear";
  }
  return nullptr;
}

}  // namespace gyre
