// Adds and removes contacts in a fixed order. See pair_update.h.
#include "collision/contact/pair_update.h"

#include "base/container/sort.h"

namespace gyre {

namespace {

// How many keys ahead a contact is prefetched; contacts lie in slot order, keys in another.
constexpr std::size_t kAhead = 24;
void fetch_contact(const ContactStore& store, std::uint64_t key) {
  const std::uint32_t slot = store.slot_of_pair.first_tried(key);
  if (slot != SlotTable::kNone) __builtin_prefetch(&store.contacts[slot]);
}

}  // namespace

void drop_known_pairs(const ContactStore& store, Array<std::uint64_t>& keys, std::size_t from) {
  std::size_t unknown = from;
  for (std::size_t i = from; i < keys.size() && i < from + kAhead; ++i) fetch_contact(store, keys[i]);
  for (std::size_t i = from; i < keys.size(); ++i) {
    if (i + kAhead < keys.size()) fetch_contact(store, keys[i + kAhead]);
    const std::uint64_t key = keys[i];
    if (find_contact(store, key) == SlotTable::kNone) keys[unknown++] = key;
  }
  keys.resize_uninitialized(unknown);
}

void add_pairs(ContactStore& store, std::span<const std::uint64_t> keys, const BlockedBodies& blocked,
               FunctionRef<PairShapes(std::uint64_t key)> describe, Array<std::uint32_t>* added) {
  // If many pairs begin at once, the arrays grow in one step instead of many.
  store.contacts.expect(store.live + keys.size());
  store.links.expect(store.live + keys.size());
  for (const std::uint64_t key : keys) {
    if (find_contact(store, key) != SlotTable::kNone) continue;
    const PairShapes shapes = describe(key);
    if (!blocked.empty() && blocked.contains(pair_key(shapes.body_a, shapes.body_b))) continue;
    const std::uint32_t slot = add_contact(store, key, shapes);
    if (added != nullptr) added->push_back(slot);
  }
}

void remove_gone(ContactStore& store, const Bitset& gone, BeforeRemoval before_removal) {
  gone.for_each_set([&](std::size_t bit) {
    const auto slot = std::uint32_t(bit);
    before_removal(slot, store.contacts[slot]);
    remove_contact(store, slot);
  });
}

std::span<const std::uint32_t> list_contacts_of_shape(const ContactStore& store, std::uint32_t shape,
                                                      Array<std::uint32_t>& scratch) {
  scratch.clear();
  for_each_contact_of_shape(store, shape, [&](std::uint32_t slot) { scratch.push_back(slot); });
  const std::size_t count = scratch.size();
  scratch.resize_uninitialized(2 * count);
  const std::span<std::uint32_t> slots = scratch.view().first(count);
  merge_sort(slots, scratch.view().last(count), [](std::uint32_t a, std::uint32_t b) { return a < b; });
  return slots;
}

void remove_contacts_of_shape(ContactStore& store, std::uint32_t shape, BeforeRemoval before_removal,
                              Array<std::uint32_t>& scratch) {
  for (const std::uint32_t slot : list_contacts_of_shape(store, shape, scratch)) {
    before_removal(slot, store.contacts[slot]);
    remove_contact(store, slot);
  }
}

}  // namespace gyre
