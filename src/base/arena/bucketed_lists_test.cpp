// Lists that are counted first keep what was added, in the order of its addition.
#include "base/arena/bucketed_lists.h"

#include <gtest/gtest.h>

#include <vector>

namespace gyre::bucketed_lists_test {
namespace {

void fill(BucketedLists& lists, std::span<const std::uint32_t> list_of, std::span<std::uint32_t> room,
          Arena* arena) {
  for (const std::uint32_t list : list_of) lists.count(list);
  if (arena != nullptr) {
    lists.make_room(*arena);
  } else {
    lists.make_room(room);
  }
  for (std::uint32_t item = 0; item < list_of.size(); ++item) lists.add(list_of[item], item);
}
std::vector<std::uint32_t> items_of(const BucketedLists& lists, std::size_t list) {
  const std::span<const std::uint32_t> items = lists.of(list);
  return {items.begin(), items.end()};
}

TEST(BucketedLists, KeepTheOrderOfAddition) {
  using Items = std::vector<std::uint32_t>;
  const std::uint32_t list_of[] = {2, 0, 2, 4, 0, 2};
  Arena arena;
  for (const bool own_room : {false, true}) {
    std::uint32_t room[8] = {};
    BucketedLists lists(5, arena);
    fill(lists, list_of, room, own_room ? nullptr : &arena);
    EXPECT_EQ(items_of(lists, 0), (Items{1, 4}));
    EXPECT_EQ(items_of(lists, 1), Items{});
    EXPECT_EQ(items_of(lists, 2), (Items{0, 2, 5}));
    EXPECT_EQ(items_of(lists, 3), Items{});
    EXPECT_EQ(items_of(lists, 4), (Items{3}));
    if (own_room) {
      EXPECT_EQ(lists.of(0).data(), room);
    }
  }
}

TEST(BucketedLists, MayBeNone) {
  Arena arena;
  BucketedLists none(0, arena), empty(1, arena);
  none.make_room(arena), empty.make_room(arena);
  EXPECT_TRUE(empty.of(0).empty());
}

}  // namespace
}  // namespace gyre::bucketed_lists_test
