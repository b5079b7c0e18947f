// The stage: which contacts are gone, which sleep, and what the others say about touching. See collide.h.
#include "collision/collide.h"

#include "base/prefetch.h"
#include "collision/contact_update.h"
#include "task/parallel.h"

namespace gyre {
namespace {

// Contacts a block: one word of a bitset, so that no two blocks write to the same one.
constexpr int kBlock = 64;
// Manifolds lie anywhere in memory: how many contacts before its turn one is asked for.
constexpr int kAhead = 6;

void prepare_bits(Bitset& bits, std::size_t count) {
  if (bits.size() < count) bits.resize(count);
  bits.reset_all();
}

// Contacts of a block that are to be looked at.
struct LookList {
  std::uint32_t slots[kBlock];
  int count = 0;
};

ContactPair pair_of(const Contact& contact, const CollideInput& input) {
  return {&input.shapes[contact.shape_a], &input.shapes[contact.shape_b], &input.looks[contact.body_a],
          &input.looks[contact.body_b],   input.centers[contact.body_a],  input.centers[contact.body_b]};
}

void note_touch(Contact& contact, std::uint32_t slot, bool touches, TouchChanges& changes) {
  if (touches && contact.touching == 0) changes.began.set(slot);
  if (!touches && contact.touching != 0) changes.ended.set(slot);
  contact.touching = touches ? 1 : 0;
}

// Which contacts are gone; of the others, which are not asleep. Sensors are looked at here.
void list_contacts(ContactStore& store, std::uint32_t begin, std::uint32_t end, const CollideInput& input,
                   TouchChanges& changes, LookList& list) {
  for (std::uint32_t slot = begin; slot < end; ++slot) {
    Contact& contact = store.contacts[slot];
    if (contact.manifold_room == 0) continue;
    const Proxy& proxy_a = input.proxies[contact.shape_a];
    const Proxy& proxy_b = input.proxies[contact.shape_b];
    if (!overlap(proxy_a.fat_box, proxy_b.fat_box) || !may_pair(proxy_a, proxy_b)) {
      contact.ended = 1;
      changes.gone.set(slot);
      note_touch(contact, slot, false, changes);
    } else if (input.looks[contact.body_a].spin >= 0.0f || input.looks[contact.body_b].spin >= 0.0f) {
      if (contact.sensor != 0) {
        note_touch(contact, slot, look_at_sensor(contact, pair_of(contact, input)), changes);
      } else {
        list.slots[list.count++] = slot;
      }
    }
  }
}

void look_at_group(ContactStore& store, std::span<const std::uint32_t> slots, const CollideInput& input,
                   TouchChanges& changes) {
  const Recycled recycled = recycle_contacts(store, slots, input);
  for (std::size_t i = 0; i < slots.size(); ++i) {
    Contact& contact = store.contacts[slots[i]];
    contact.recycled = recycled.contacts >> i & 1u;
    const bool touches = contact.recycled != 0
                             ? (recycled.touching >> i & 1u) != 0
                             : look_anew(store, contact, pair_of(contact, input), recycled.views[i]);
    note_touch(contact, slots[i], touches, changes);
    if (contact.manifold_count != 0 &&
        input.proxies[contact.shape_a].pushes != input.proxies[contact.shape_b].pushes)
      changes.beside_resting.set(slots[i]);
  }
}

void fetch_manifold(ContactStore& store, std::uint32_t slot) {
  const Contact& contact = store.contacts[slot];
  if (contact.manifold_count != 0) prefetch(&store.manifolds[contact.first_manifold], sizeof(Manifold));
}

void look_at_block(ContactStore& store, int begin, int end, const CollideInput& input,
                   TouchChanges& changes) {
  LookList list;
  list_contacts(store, std::uint32_t(begin), std::uint32_t(end), input, changes, list);
  for (int i = 0; i < min(kAhead, list.count); ++i) fetch_manifold(store, list.slots[i]);
  for (int first = 0; first < list.count; first += kLookWidth) {
    const int next = min(first + kAhead + kLookWidth, list.count);
    for (int i = first + kAhead; i < next; ++i) fetch_manifold(store, list.slots[i]);
    look_at_group(store, {list.slots + first, std::size_t(min(kLookWidth, list.count - first))}, input,
                  changes);
  }
}

}  // namespace

void collide(ContactStore& store, const CollideInput& input, TaskSystem& tasks, TouchChanges& changes) {
  const std::size_t count = store.contacts.size();
  prepare_bits(changes.began, count);
  prepare_bits(changes.ended, count);
  prepare_bits(changes.gone, count);
  prepare_bits(changes.beside_resting, count);
  for_blocks(tasks, int(count), kBlock,
             [&](int begin, int end, int) { look_at_block(store, begin, end, input, changes); });
}

}  // namespace gyre
