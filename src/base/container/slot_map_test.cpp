// The lowest slot comes first, stale ids never come back, and a restored pool continues as the original.
#include "base/container/slot_map.h"

#include <gtest/gtest.h>

#include <random>
#include <set>
#include <vector>

namespace gyre::slot_map_test {
namespace {

TEST(IdPool, LowestFreeSlotFirst) {
  IdPool pool;
  for (std::uint32_t i = 0; i < 200; ++i) EXPECT_EQ(pool.acquire().index, i);
  for (const std::uint32_t i : {150u, 3u, 64u, 199u, 63u}) pool.release(i);
  for (const std::uint32_t i : {3u, 63u, 64u, 150u, 199u, 200u}) EXPECT_EQ(pool.acquire().index, i);
}

TEST(IdPool, ZeroIsNull) {
  IdPool pool;
  EXPECT_FALSE(pool.alive(0, 0));
  const IdPool::Slot slot = pool.acquire();
  EXPECT_NE(slot.generation, 0u);
  EXPECT_FALSE(pool.alive(0, 0));
  EXPECT_TRUE(pool.alive(slot.index, slot.generation));
  EXPECT_FALSE(pool.alive(1000, 1));
  pool.release(slot.index);
  EXPECT_FALSE(pool.alive(slot.index, slot.generation));
  EXPECT_FALSE(pool.alive(slot.index, slot.generation + 1)) << "a free slot's number is nobody's";
}

TEST(IdPool, AWornOutSlotRetires) {
  IdPool pool;
  std::set<std::uint32_t> seen;
  for (;;) {
    const IdPool::Slot slot = pool.acquire();
    if (slot.index != 0) break;
    ASSERT_LE(slot.generation, 0xffffu) << "fits in a public id";
    ASSERT_TRUE(seen.insert(slot.generation).second);
    pool.release(0);
  }
  EXPECT_EQ(seen.size(), 32768u);
  EXPECT_FALSE(pool.live(0));
  EXPECT_FALSE(pool.alive(0, IdPool::kRetired));
  for (const std::uint32_t generation : seen) ASSERT_FALSE(pool.alive(0, generation));
  pool.release(1);
  EXPECT_EQ(pool.acquire().index, 1u);
  IdPool restored;
  ASSERT_TRUE(restored.restore(pool.generations()));
  EXPECT_EQ(restored.acquire().index, 2u) << "still retired after a snapshot";
}

TEST(IdPool, RandomLifeAgainstSets) {
  std::mt19937 random(5);
  IdPool pool;
  std::set<std::uint32_t> free_slots, used;
  std::vector<IdPool::Slot> dead;
  for (int step = 0; step < 20000; ++step) {
    if (used.empty() || random() % 100 < (step / 2000 % 2 == 0 ? 60 : 40)) {
      const std::uint32_t expected =
          free_slots.empty() ? static_cast<std::uint32_t>(used.size()) : *free_slots.begin();
      const IdPool::Slot slot = pool.acquire();
      ASSERT_EQ(slot.index, expected);
      free_slots.erase(slot.index);
      used.insert(slot.index);
    } else {
      auto victim = used.lower_bound(static_cast<std::uint32_t>(random() % pool.capacity()));
      if (victim == used.end()) victim = used.begin();
      dead.push_back({*victim, pool.generation(*victim)});
      pool.release(*victim);
      free_slots.insert(*victim);
      used.erase(victim);
    }
    ASSERT_EQ(pool.size(), used.size());
    if (step % 1000 == 0) {
      IdPool restored;
      ASSERT_TRUE(restored.restore(pool.generations()));
      EXPECT_EQ(restored.free_slots(), pool.free_slots());
      EXPECT_EQ(restored.size(), pool.size());
      pool = restored;
    }
  }
  for (const IdPool::Slot& slot : dead) ASSERT_FALSE(pool.alive(slot.index, slot.generation));
  std::vector<std::uint32_t> walked;
  pool.for_each_live([&walked](std::uint32_t i) { walked.push_back(i); });
  EXPECT_EQ(walked, std::vector<std::uint32_t>(used.begin(), used.end()));
  pool.release_all();
  EXPECT_EQ(pool.size(), 0u);
  EXPECT_EQ(pool.acquire().index, 0u);
}

TEST(IdPool, RefusesDamagedState) {
  IdPool pool;
  pool.acquire();
  const std::uint32_t damaged[] = {1, IdPool::kRetired + 1};
  EXPECT_FALSE(pool.restore(damaged));
  EXPECT_EQ(pool.size(), 1u);
}

}  // namespace
}  // namespace gyre::slot_map_test
