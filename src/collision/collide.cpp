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

void look(ContactStore& store, std::uint32_t slot, const CollideInput& input, TouchChanges& changes) {
  Contact& contact = store.contacts[slot];
  if (contact.manifold_room == 0) return;
  const Proxy& proxy_a = input.proxies[contact.shape_a];
  const Proxy& proxy_b = input.proxies[contact.shape_b];
  bool touches = false;
  if (!overlap(proxy_a.fat_box, proxy_b.fat_box) || !may_pair(proxy_a, proxy_b)) {
    contact.ended = 1;
    changes.gone.set(slot);
  } else {
    const BodyLook& look_a = input.looks[contact.body_a];
    const BodyLook& look_b = input.looks[contact.body_b];
    if (look_a.spin < 0.0f && look_b.spin < 0.0f) return;
    const ContactPair pair{&input.shapes[contact.shape_a], &input.shapes[contact.shape_b], &look_a, &look_b,
                           input.centers[contact.body_a],  input.centers[contact.body_b]};
    touches = contact.sensor != 0 ? look_at_sensor(contact, pair)
                                  : update_contact(store, contact, pair, input.recycle);
    if (contact.manifold_count != 0 && proxy_a.pushes != proxy_b.pushes) changes.beside_resting.set(slot);
  }
  if (touches && contact.touching == 0) changes.began.set(slot);
  if (!touches && contact.touching != 0) changes.ended.set(slot);
  contact.touching = touches ? 1 : 0;
}

void fetch_manifold(ContactStore& store, int slot) {
  const Contact& contact = store.contacts[std::size_t(slot)];
  if (contact.manifold_count != 0) prefetch(&store.manifolds[contact.first_manifold], sizeof(Manifold));
}

}  // namespace

void collide(ContactStore& store, const CollideInput& input, TaskSystem& tasks, TouchChanges& changes) {
  const std::size_t count = store.contacts.size();
  prepare_bits(changes.began, count);
  prepare_bits(changes.ended, count);
  prepare_bits(changes.gone, count);
  prepare_bits(changes.beside_resting, count);
  for_blocks(tasks, int(count), kBlock, [&](int begin, int end, int) {
    for (int slot = begin; slot < min(begin + kAhead, end); ++slot) fetch_manifold(store, slot);
    for (int slot = begin; slot < end; ++slot) {
      if (slot + kAhead < end) fetch_manifold(store, slot + kAhead);
      look(store, std::uint32_t(slot), input, changes);
    }
  });
}

}  // namespace gyre
