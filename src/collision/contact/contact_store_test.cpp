// The contact store against plain bookkeeping: lowest slots first, no leaks, and indices that can be rebuilt.
#include "collision/contact/contact_store.h"

#include "collision/contact/pair_update.h"
#include "random.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <map>
#include <set>
#include <vector>

namespace gyre::contact_store_test {
namespace {

using testing_random::Random;

PairShapes describe(std::uint64_t key) {
  PairShapes shapes;
  shapes.body_a = std::uint32_t(key >> 32);
  shapes.body_b = std::uint32_t(key);
  shapes.against_mesh = (key & 3) == 0;
  shapes.surface.static_friction = float(key & 0xff);
  return shapes;
}

TEST(ContactStore, TakesTheLowestFreeSlot) {
  ContactStore store;
  for (std::uint32_t i = 0; i < 6; ++i) EXPECT_EQ(add_contact(store, pair_key(0, i + 1), describe(i + 1)), i);
  remove_contact(store, 4);
  remove_contact(store, 1);
  remove_contact(store, 3);
  EXPECT_EQ(find_fault(store), nullptr);
  EXPECT_EQ(add_contact(store, pair_key(7, 8), {}), 1u);
  EXPECT_EQ(add_contact(store, pair_key(7, 9), {}), 3u);
  EXPECT_EQ(add_contact(store, pair_key(7, 10), {}), 4u);
  EXPECT_EQ(add_contact(store, pair_key(7, 11), {}), 6u);
  EXPECT_EQ(store.live, 7u);
  EXPECT_EQ(find_fault(store), nullptr);
}

TEST(ContactStore, RemovedContactsLeaveNothingBehind) {
  ContactStore store;
  const std::uint32_t slot = add_contact(store, pair_key(3, 8), describe(pair_key(3, 8)));
  Manifold& manifold = store.manifolds[store.contacts[slot].first_manifold];
  manifold.count = 1;
  manifold.points[0].normal_impulse = 5.0f;
  store.contacts[slot].manifold_count = 1;
  remove_contact(store, slot);
  add_contact(store, pair_key(3, 8), describe(pair_key(3, 8)));
  EXPECT_EQ(store.contacts[slot].manifold_count, 0);
  EXPECT_EQ(store.manifolds[store.contacts[slot].first_manifold].count, 0);
  EXPECT_EQ(store.manifolds[store.contacts[slot].first_manifold].points[0].normal_impulse, 0.0f);
}

// Cached triangles belong to one mesh: a later contact in the same slots has none.
TEST(ContactStore, TrianglesOfAMeshAreForgottenWithItsContact) {
  ContactStore store;
  PairShapes on_mesh;
  on_mesh.against_mesh = true;
  const auto add = [&](std::uint32_t shape) { return add_contact(store, pair_key(0, shape), on_mesh); };
  const std::uint32_t slot = add(1), other = add(2);
  const std::uint32_t chunk = store.contacts[slot].first_manifold;
  cached_triangles_of(store, store.contacts[slot])->count = 3;
  cached_triangles_of(store, store.contacts[other])->count = 5;
  remove_contact(store, slot);
  const std::uint32_t next = add(3);
  ASSERT_EQ(store.contacts[next].first_manifold, chunk) << "it takes the same run";
  EXPECT_EQ(cached_triangles_of(store, store.contacts[next])->count, CachedTriangles::kUnknown);
  EXPECT_EQ(cached_triangles_of(store, store.contacts[other])->count, 5);
  rebuild_index(store);
  EXPECT_EQ(cached_triangles_of(store, store.contacts[other])->count, CachedTriangles::kUnknown);
}

TEST(ContactStore, ChurnKeepsIndicesRightAndMemoryLevel) {
  ContactStore store;
  Random random;
  std::map<std::uint64_t, std::uint32_t> expected;
  std::set<std::uint32_t> free_slots;
  std::vector<std::uint64_t> keys;
  std::size_t max_live = 0, owned = 0, max_owned = 0;
  for (int round = 0; round < 100000; ++round) {
    const bool grow = keys.size() < 500 || (keys.size() < 1500 && random.next(2) == 0);
    if (grow) {
      const std::uint32_t a = random.next(300), b = random.next(300);
      if (a == b || expected.count(pair_key(a, b)) != 0) continue;
      const std::uint64_t key = pair_key(a, b);
      const std::uint32_t slot = add_contact(store, key, describe(key));
      const std::uint32_t lowest_free =
          free_slots.empty() ? std::uint32_t(expected.size()) : *free_slots.begin();
      ASSERT_EQ(slot, lowest_free);
      free_slots.erase(slot);
      expected[key] = slot;
      owned += store.contacts[slot].manifold_room;
      keys.push_back(key);
    } else {
      const std::size_t i = random.next(std::uint32_t(keys.size()));
      const std::uint32_t slot = expected[keys[i]];
      owned -= store.contacts[slot].manifold_room;
      remove_contact(store, slot);
      free_slots.insert(slot);
      expected.erase(keys[i]);
      keys[i] = keys.back();
      keys.pop_back();
    }
    if (round % 9973 == 0) {
      ASSERT_STREQ(find_fault(store), nullptr) << round;
    }
    max_live = std::max(max_live, expected.size());
    max_owned = std::max(max_owned, owned);
  }
  ASSERT_STREQ(find_fault(store), nullptr);
  EXPECT_EQ(store.live, expected.size());
  for (const auto& [key, slot] : expected) EXPECT_EQ(find_contact(store, key), slot);
  // Never more slots than at the busiest moment, and little waste in shared chunks.
  EXPECT_EQ(store.contacts.size(), max_live);
  EXPECT_LE(store.manifolds.size(), max_owned + max_owned / 4);
}

TEST(ContactStore, RebuiltIndexGoesOnLikeTheOriginal) {
  ContactStore store;
  Random random;
  std::vector<std::uint64_t> keys;
  for (std::uint32_t a = 0; a < 40; ++a) {
    for (std::uint32_t b = a + 1; b < 40; b += 1 + random.next(4)) keys.push_back(pair_key(a, b));
  }
  for (const std::uint64_t key : keys) add_contact(store, key, describe(key));
  for (int i = 0; i < 150; ++i) {
    const std::uint64_t key = keys[random.next(std::uint32_t(keys.size()))];
    if (const std::uint32_t slot = find_contact(store, key); slot != SlotTable::kNone)
      remove_contact(store, slot);
  }
  ContactStore loaded;
  loaded.contacts = store.contacts;
  loaded.manifolds = store.manifolds;
  rebuild_index(loaded);
  ASSERT_STREQ(find_fault(loaded), nullptr);
  EXPECT_EQ(loaded.live, store.live);
  // The same calls must now have the same effect on both.
  for (int i = 0; i < 400; ++i) {
    const std::uint64_t key = keys[random.next(std::uint32_t(keys.size()))];
    for (ContactStore* const each : {&store, &loaded}) {
      if (const std::uint32_t slot = find_contact(*each, key); slot != SlotTable::kNone) {
        remove_contact(*each, slot);
      } else {
        add_contact(*each, key, describe(key));
      }
    }
    ASSERT_EQ(store.contacts.size(), loaded.contacts.size());
    for (std::size_t slot = 0; slot < store.contacts.size(); ++slot) {
      ASSERT_EQ(store.contacts[slot].shape_a, loaded.contacts[slot].shape_a);
      ASSERT_EQ(store.contacts[slot].shape_b, loaded.contacts[slot].shape_b);
      ASSERT_EQ(store.contacts[slot].first_manifold, loaded.contacts[slot].first_manifold);
    }
  }
  ASSERT_STREQ(find_fault(loaded), nullptr);
}

TEST(ContactStore, WalksTheContactsOfOneShape) {
  ContactStore store;
  add_contact(store, pair_key(1, 2), {});
  add_contact(store, pair_key(2, 5), {});
  add_contact(store, pair_key(0, 2), {});
  add_contact(store, pair_key(0, 1), {});
  std::set<std::uint32_t> slots;
  for_each_contact_of_shape(store, 2, [&](std::uint32_t slot) { slots.insert(slot); });
  EXPECT_EQ(slots, (std::set<std::uint32_t>{0, 1, 2}));
  int of_unknown = 0;
  for_each_contact_of_shape(store, 99, [&](std::uint32_t) { ++of_unknown; });
  EXPECT_EQ(of_unknown, 0);
}

TEST(ContactStore, FaultsAreFound) {
  ContactStore store;
  for (std::uint32_t i = 1; i < 9; ++i) add_contact(store, pair_key(0, i), {});
  ASSERT_STREQ(find_fault(store), nullptr);
  ContactStore broken = store;
  broken.links[3].next[0] = kNoLink;
  EXPECT_NE(find_fault(broken), nullptr);
  broken = store;
  broken.contacts[2].first_manifold = broken.contacts[5].first_manifold;
  EXPECT_NE(find_fault(broken), nullptr);
  broken = store;
  broken.live = 7;
  EXPECT_NE(find_fault(broken), nullptr);
  broken = store;
  broken.manifolds[broken.contacts[4].first_manifold].load_age = 1.0f;
  EXPECT_STREQ(find_fault(broken), "an unused manifold of a contact is not clear");
  broken.contacts[4].manifold_count = 1;
  EXPECT_STREQ(find_fault(broken), "the bit of a contact with manifolds is clear");
  for (const bool anchor : {false, true}) {
    ContactStore loaded = store;
    loaded.contacts[4].manifold_count = 1;
    loaded.with_manifolds.set(4);
    Manifold& manifold = loaded.manifolds[loaded.contacts[4].first_manifold];
    manifold.count = 2;
    manifold.points[1].mean_impulse = manifold.anchors[1].separation = 1.0f;
    EXPECT_STREQ(find_fault(loaded), nullptr);
    (anchor ? manifold.anchors[2].separation : manifold.points[2].mean_impulse) = 1.0f;
    EXPECT_STREQ(find_fault(loaded), "an unused point of a manifold is not clear");
  }
  broken.with_manifolds.set(4);
  EXPECT_EQ(find_fault(broken), nullptr);
  remove_contact(broken, 4);
  EXPECT_EQ(find_fault(broken), nullptr);
  broken.manifolds[store.contacts[4].first_manifold].load_age = 1.0f;
  EXPECT_STREQ(find_fault(broken), "a manifold of no contact is not clear");
}

TEST(PairUpdate, AddsNewUnblockedPairsInKeyOrder) {
  ContactStore store;
  BlockedBodies blocked;
  blocked.insert(pair_key(1, 3), 1);
  const std::uint64_t first[] = {pair_key(0, 1), pair_key(1, 2), pair_key(1, 3), pair_key(2, 3)};
  Array<std::uint32_t> added;
  add_pairs(store, first, blocked, describe, &added);
  EXPECT_EQ(store.live, 3u);
  EXPECT_EQ(added, (Array<std::uint32_t>{0, 1, 2}));
  EXPECT_EQ(find_contact(store, pair_key(1, 3)), SlotTable::kNone);
  added.clear();
  const std::uint64_t second[] = {pair_key(0, 1), pair_key(0, 4), pair_key(2, 3)};
  add_pairs(store, second, blocked, describe, &added);
  EXPECT_EQ(added, (Array<std::uint32_t>{3}));
  EXPECT_EQ(store.contacts[3].shape_b, 4u);
  EXPECT_EQ(store.contacts[3].surface.static_friction, 4.0f);
}

// Many new contacts at once move each array once at most: there is room for all, without an eighth more.
TEST(PairUpdate, MakesRoomForAllAtOnce) {
  ContactStore store;
  const auto keys_of = [](std::uint32_t first, std::uint32_t count) {
    std::vector<std::uint64_t> keys;
    for (std::uint32_t i = first; i < first + count; ++i) keys.push_back(pair_key(i, i + 1));
    return keys;
  };
  add_pairs(store, keys_of(0, 5000), {}, describe, nullptr);
  add_pairs(store, keys_of(5000, 7001), {}, describe, nullptr);
  EXPECT_EQ(store.live, 12001u);
  EXPECT_EQ(store.contacts.capacity(), 12001u);
  EXPECT_EQ(store.links.capacity(), 12001u);
}

TEST(PairUpdate, RemovesInSlotOrder) {
  ContactStore store;
  for (std::uint32_t i = 1; i < 70; ++i) add_contact(store, pair_key(0, i), {});
  Bitset gone(store.contacts.size());
  for (const std::size_t slot : {66u, 3u, 17u}) gone.set(slot);
  std::vector<std::uint32_t> order;
  remove_gone(store, gone, [&](std::uint32_t slot, const Contact& contact) {
    order.push_back(slot);
    EXPECT_EQ(contact.shape_b, slot + 1);
  });
  EXPECT_EQ(order, (std::vector<std::uint32_t>{3, 17, 66}));
  EXPECT_EQ(store.live, 66u);
  EXPECT_STREQ(find_fault(store), nullptr);
}

TEST(PairUpdate, RemovesAllContactsOfAShape) {
  ContactStore store;
  for (std::uint32_t i = 1; i < 20; ++i) add_contact(store, pair_key(i, (7 * i) % 23 + 30), {});
  for (const std::uint32_t other : {40u, 3u, 12u}) add_contact(store, pair_key(25, other), {});
  std::vector<std::uint32_t> order;
  Array<std::uint32_t> scratch;
  remove_contacts_of_shape(
      store, 25, [&](std::uint32_t slot, const Contact&) { order.push_back(slot); }, scratch);
  EXPECT_EQ(order, (std::vector<std::uint32_t>{19, 20, 21}));
  int left = 0;
  for_each_contact_of_shape(store, 25, [&](std::uint32_t) { ++left; });
  EXPECT_EQ(left, 0);
  EXPECT_STREQ(find_fault(store), nullptr);
}

}  // namespace
}  // namespace gyre::contact_store_test
