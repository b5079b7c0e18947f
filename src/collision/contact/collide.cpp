// The narrow-phase stage: finds which contacts have ended, skips those that sleep, and updates the others. See
// collide.h.
#include "collision/contact/collide.h"

#include "base/prefetch.h"
#include "collision/broadphase/fat_box.h"
#include "collision/contact/contact_update.h"
#include "math/wide.h"
#include "task/parallel.h"

#include <bit>
#include <cstddef>

namespace gyre {
namespace {

void prepare_bits(Bitset& bits, std::size_t count) {
  if (bits.size() < count) bits.resize(count);
  bits.reset_all();
}

// The contacts of a block that need an update. A block is one word of a bitset, so no two workers write the same word.
// Contacts with manifolds fill the array from its start, the others from its end; whole groups of lanes then have no
// points to move.
struct UpdateList {
  // Not cleared: only used entries are read.
  union {
    PairInput pairs[kContactBlock];
  };
  std::uint32_t slots[kContactBlock];
  std::uint64_t with_manifolds = 0;  // bits, by number in the block
  std::uint64_t on_static_bits = 0;  // bits, by index in the list: contacts move only one of the two shapes
  int first_end = 0, last_begin = kContactBlock;
  UpdateList() {}

  int add(bool has_manifolds) { return has_manifolds ? first_end++ : --last_begin; }
  void note_manifolds(std::uint32_t slot, const Contact& contact) {
    with_manifolds |= std::uint64_t(contact.manifold_count != 0) << slot % kContactBlock;
  }
  // Fills an incomplete group of lanes with contacts from the end.
  void fill_lanes() {
    constexpr int kLanes = 8;
    for (; first_end % kLanes != 0 && last_begin < kContactBlock; ++first_end, ++last_begin) {
      pairs[first_end] = pairs[last_begin];
      slots[first_end] = slots[last_begin];
      const std::uint64_t bit = on_static_bits >> last_begin & 1;
      on_static_bits = (on_static_bits & ~(std::uint64_t{1} << first_end)) | bit << first_end;
    }
  }

  template <class Do>
  void for_each(Do&& run) const {
    for (int i = 0; i < first_end; ++i) run(i);
    for (int i = last_begin; i < kContactBlock; ++i) run(i);
  }
};

void set_touching(Contact& contact, std::uint32_t slot, bool touches, TouchChanges& changes) {
  if (touches == (contact.touching != 0)) return;
  (touches ? changes.began : changes.ended).set(slot);
  contact.touching = touches ? 1 : 0;
}

// As overlap(), with four floats at a time.
bool boxes_overlap(const Proxy& a, const Proxy& b) {
  static_assert(offsetof(Aabb, high) == sizeof(Vec3) && sizeof(Proxy) >= sizeof(Aabb) + sizeof(float));
  const auto load = [](const Vec3& corner) { return Wide<4>::load_unaligned(&corner.x); };
  const Mask<4> meets =
      (load(a.fat_box.low) <= load(b.fat_box.high)) & (load(b.fat_box.low) <= load(a.fat_box.high));
  return (to_bits(meets) & 7u) == 7u;
}

// True if the bounding balls of two bodies stay farther apart over the step than a full update searches for shapes of
// this size. Rotation does not change the balls; they only translate.
bool bodies_apart(const CollideInput& input, const Contact& contact) {
  const CollisionBody& a = input.bodies[contact.body_a];
  const CollisionBody& b = input.bodies[contact.body_b];
  const float extents = extent_of(input.centers[contact.body_a]) + extent_of(input.centers[contact.body_b]);
  const float max_distance =
      extents + (kSpeculativeShare + kNearSlack) * contact.size + length(b.translation - a.translation);
  return length_squared(difference(b.position, a.position)) > square(max_distance);
}

// How many contacts ahead a contact and its proxies are prefetched.
constexpr std::uint32_t kContactsAhead = 8, kProxiesAhead = 4;
void fetch_ahead(const ContactStore& store, std::uint32_t slot, const CollideInput& input) {
  const std::size_t count = store.contacts.size();
  if (slot + kContactsAhead < count) prefetch(&store.contacts[slot + kContactsAhead], sizeof(Contact));
  if (slot + kProxiesAhead >= count) return;
  const Contact& contact = store.contacts[slot + kProxiesAhead];
  if (contact.manifold_room == 0) return;
  __builtin_prefetch(&input.proxies[contact.shape_a]);
  __builtin_prefetch(&input.proxies[contact.shape_b]);
}

// Marks the contacts that have ended among `active` (bits) and lists those of the others that are awake.
void list_contacts(ContactStore& store, std::uint32_t begin, std::uint64_t active, const CollideInput& input,
                   TouchChanges& changes, UpdateList& list) {
  for (; active != 0; active &= active - 1) {
    const std::uint32_t slot = begin + std::uint32_t(std::countr_zero(active));
    fetch_ahead(store, slot, input);
    Contact& contact = store.contacts[slot];
    if (contact.manifold_room == 0) continue;
    const Proxy& proxy_a = input.proxies[contact.shape_a];
    const Proxy& proxy_b = input.proxies[contact.shape_b];
    if (!boxes_overlap(proxy_a, proxy_b) || !may_pair(proxy_a, proxy_b)) {
      contact.ended = 1;
      changes.gone.set(slot);
      set_touching(contact, slot, false, changes);
      list.note_manifolds(slot, contact);
      continue;
    }
    if (blocks_fast_bodies(contact, input.proxies)) changes.ccd_blockers.set(slot);
    const bool unseen = is_unseen(contact);
    if (input.awake[contact.body_a] == 0 && input.awake[contact.body_b] == 0 && !unseen) {
      list.note_manifolds(slot, contact);
      continue;
    }
    const ColliderShape& shape_a = input.shapes[contact.shape_a];
    const ColliderShape& shape_b = input.shapes[contact.shape_b];
    if (unseen) contact.cached_distance = -1.0f;
    // A sensor's contact caches nothing, so each of its updates is a first one.
    if (contact.cached_distance < 0.0f && contact.sensor == 0)
      contact.size = smaller_size(shape_a.size, shape_b.size);
    if (contact.manifold_count == 0 && contact.sensor == 0 && bodies_apart(input, contact)) {
      contact.recycled = 1;
      set_touching(contact, slot, false, changes);
      continue;
    }
    const int index = list.add(contact.manifold_count != 0);
    PairInput& pair = list.pairs[index];
    pair.contact = &contact;
    pair.manifolds = &store.manifolds[contact.first_manifold];
    pair.shape_a = &shape_a;
    pair.shape_b = &shape_b;
    pair.body_a = &input.bodies[contact.body_a];
    pair.body_b = &input.bodies[contact.body_b];
    pair.center_a = &input.centers[contact.body_a];
    pair.center_b = &input.centers[contact.body_b];
    list.on_static_bits |= std::uint64_t(proxy_a.pushes != proxy_b.pushes) << index;
    list.slots[index] = slot;
  }
  list.fill_lanes();
}

// Prefetches what full updates of mesh contacts read, one update ahead, since it lies anywhere in memory.
class MeshesAhead {
 public:
  MeshesAhead(ContactStore& store, const UpdateList& list, const Recycled& recycled)
      : store_(store), list_(list) {
    list.for_each([&](int i) {
      if ((recycled.contacts >> i & 1) != 0) return;
      const Contact& contact = *list.pairs[i].contact;
      const CachedTriangles* const cached =
          contact.sensor != 0 ? nullptr : cached_triangles_of(store, contact);
      if (cached == nullptr) return;
      prefetch(cached, sizeof(CachedTriangles));
      left_ |= std::uint64_t{1} << i;
    });
  }

  // To be called before the update of the contact at `index`.
  void prefetch_next(int index) {
    if ((left_ >> index & 1) == 0) return;
    left_ &= ~(std::uint64_t{1} << index);
    if (left_ == 0) return;
    const PairInput& next = list_.pairs[std::countr_zero(left_)];
    const Shape& a = next.shape_a->shape;
    const Shape& mesh = a.kind == ShapeKind::mesh ? a : next.shape_b->shape;
    if (mesh.kind == ShapeKind::mesh)
      prefetch_triangles(*mesh.mesh, *cached_triangles_of(store_, *next.contact));
  }

 private:
  ContactStore& store_;
  const UpdateList& list_;
  std::uint64_t left_ = 0;  // bits, by index in the list
};

void update_contact_block(ContactStore& store, int begin, const CollideInput& input, TouchChanges& changes) {
  const std::size_t word = std::size_t(begin / kContactBlock);
  const std::uint64_t active = input.active.words()[word];
  if (active == 0) return;
  UpdateList list;
  list_contacts(store, std::uint32_t(begin), active, input, changes, list);
  Recycled recycled;
  input.recycle_contacts(list.pairs, 0, list.first_end, input.recycle, recycled);
  if (list.last_begin < kContactBlock)
    input.recycle_contacts(list.pairs, list.last_begin, kContactBlock, input.recycle, recycled);
  MeshesAhead meshes(store, list, recycled);
  list.for_each([&](int i) {
    const PairInput& pair = list.pairs[i];
    meshes.prefetch_next(i);
    Contact& contact = *pair.contact;
    const std::uint64_t own = std::uint64_t{1} << i;
    contact.recycled = (recycled.contacts & own) != 0 ? 1 : 0;
    if ((recycled.apart & own) != 0) return set_touching(contact, list.slots[i], false, changes);
    const bool touches = contact.recycled != 0 ? (recycled.touching & own) != 0
                         : contact.sensor != 0
                             ? test_sensor_overlap(pair, recycled.views[i])
                             : compute_manifold(pair, recycled.views[i], cached_triangles_of(store, contact));
    set_touching(contact, list.slots[i], touches, changes);
    list.note_manifolds(list.slots[i], contact);
    if ((list.on_static_bits & own) != 0 && contact.manifold_count != 0) changes.on_static.set(list.slots[i]);
  });
  store.with_manifolds.put_word(word, (store.with_manifolds.words()[word] & ~active) | list.with_manifolds);
}

}  // namespace

void collide(ContactStore& store, const CollideInput& input, TaskSystem& tasks, TouchChanges& changes) {
  const std::size_t count = store.contacts.size();
  GYRE_ASSERT(input.active.size() == count, "there is one bit for each contact");
  prepare_bits(changes.began, count);
  prepare_bits(changes.ended, count);
  prepare_bits(changes.gone, count);
  prepare_bits(changes.on_static, count);
  prepare_bits(changes.ccd_blockers, count);
  for_blocks(tasks, int(count), kContactBlock,
             [&](int begin, int, int) { update_contact_block(store, begin, input, changes); });
}

}  // namespace gyre
