// A table without keys finds what a map with keys finds, under insertions and removals.
#include "base/container/slot_table.h"

#include <gtest/gtest.h>

#include <map>
#include <random>
#include <vector>

namespace gyre::slot_table_test {
namespace {

TEST(SlotTable, AgreesWithAMap) {
  std::mt19937_64 random(11);
  std::vector<std::uint64_t> keys(500);  // by slot
  std::map<std::uint64_t, std::uint32_t> expected;
  SlotTable table;
  const auto key_of = [&](std::uint32_t slot) { return keys[slot]; };
  for (int round = 0; round < 20000; ++round) {
    const auto slot = static_cast<std::uint32_t>(random() % keys.size());
    if (keys[slot] != 0) {
      table.erase(keys[slot], key_of);
      expected.erase(keys[slot]);
      keys[slot] = 0;
    } else {
      // Few different keys, so that runs of cells grow long and collide.
      const std::uint64_t key = 1 + random() % 700;
      if (expected.contains(key)) continue;
      keys[slot] = key;
      table.insert(key, slot, key_of);
      expected[key] = slot;
    }
    ASSERT_EQ(table.size(), expected.size());
    const std::uint64_t query = 1 + random() % 700;
    const auto found = expected.find(query);
    ASSERT_EQ(table.find(query, key_of), found == expected.end() ? SlotTable::kNone : found->second);
  }
  for (const auto& [key, slot] : expected) EXPECT_EQ(table.find(key, key_of), slot);
  table.clear();
  EXPECT_EQ(table.size(), 0u);
  for (const auto& [key, slot] : expected) EXPECT_EQ(table.find(key, key_of), SlotTable::kNone);
}

TEST(SlotTable, ASlotCostsFewBytes) {
  std::vector<std::uint64_t> keys;
  SlotTable table;
  for (std::uint32_t slot = 0; slot < 10000; ++slot) {
    keys.push_back(std::uint64_t{slot} << 32 | (slot + 1));
    table.insert(keys.back(), slot, [&](std::uint32_t s) { return keys[s]; });
    if (slot > 100) {
      ASSERT_LE(table.bytes(), 11 * table.size());
    }
  }
}

}  // namespace
}  // namespace gyre::slot_table_test
