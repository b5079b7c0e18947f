#include "soft/store/soft_quarantine.h"

#include "soft/store/soft_builder.h"

#include <gtest/gtest.h>

#include <limits>

namespace gyre::soft_quarantine_test {
namespace {

constexpr float kNan = std::numeric_limits<float>::quiet_NaN();

// A rope whose ends a body holds, and which touches it.
SoftStore store_with_rope() {
  SoftStore store;
  store.ids.acquire();
  const RopeDef rope{.points = {{0, 0, 0}, {1, 0, 0}}, .segments = 4};
  store.entries.push_back(build_soft(std::make_shared<const SoftDef>(rope)));
  SoftEntry& entry = store.entries[0];
  entry.attachments.push_back({.particle = 0, .body = 0, .impulse = {1, 2, 3}});
  entry.attachments.push_back({.particle = 4, .body = 0});
  SoftContact contact;
  contact.particle = 2;
  entry.contacts.push_back(contact);
  keep_good_places(store);
  return store;
}

// A body that is frozen leaves an impulse that is no number on vertices that are sound. Its bits differ between processors.
TEST(SoftQuarantine, ForgetsImpulsesThatAreNotFinite) {
  SoftStore store = store_with_rope();
  SoftEntry& entry = store.entries[0];
  entry.attachments[1].impulse = {kNan, 0, 0};
  entry.contacts[0].impulse = {0, std::numeric_limits<float>::infinity(), 0};
  Array<std::uint32_t> frozen;
  quarantine_soft(store, frozen);
  EXPECT_TRUE(frozen.empty());
  EXPECT_EQ(entry.attachments[0].impulse, (Vec3{1, 2, 3}));
  EXPECT_EQ(entry.attachments[1].impulse, Vec3{});
  EXPECT_EQ(entry.contacts[0].impulse, Vec3{});
}

TEST(SoftQuarantine, FreezesAtTheLastGoodPlaces) {
  SoftStore store = store_with_rope();
  SoftEntry& entry = store.entries[0];
  entry.body.particles.x[2] = double(kNan);
  Array<std::uint32_t> frozen;
  quarantine_soft(store, frozen);
  ASSERT_EQ(frozen.size(), 1u);
  EXPECT_EQ(entry.body.particles.place(2), (DVec3{0.5, 0, 0}));
  EXPECT_TRUE(entry.is_quarantined());
  EXPECT_TRUE(entry.contacts.empty());
  EXPECT_EQ(entry.attachments[0].impulse, Vec3{});
}

}  // namespace
}  // namespace gyre::soft_quarantine_test
