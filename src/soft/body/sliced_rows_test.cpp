// Every neighbour has a place of its own, and that place names its column.
#include "soft/body/sliced_rows.h"

#include "random.h"

#include <gtest/gtest.h>

#include <set>

namespace gyre::sliced_rows_test {
namespace {

std::int32_t column_at(const SlicedRows& rows, int slot, int row) {
  const RowSlot& one = rows.slots[slot];
  return one.columns < 0 ? row + one.offset : rows.columns[one.columns + row % kSliceRows];
}

void expect_sound(Array<MatrixEntry> entries, int count) {
  merge_entries(entries);
  const NeighbourLists lists = list_neighbours(entries, count);
  Array<std::int32_t> place;
  const SlicedRows rows = slice_rows(lists, place);
  ASSERT_EQ(rows.slot_begin.size(), std::size_t(rows.slices()) + 1);
  std::set<std::int32_t> taken;
  for (int row = 0; row < count; ++row) {
    for (std::uint32_t k = lists.begin[row]; k < lists.begin[row + 1]; ++k) {
      const int slot = place[k] / kSliceRows, slice = row / kSliceRows;
      EXPECT_TRUE(taken.insert(place[k]).second);
      EXPECT_EQ(place[k] % kSliceRows, row % kSliceRows);
      EXPECT_GE(slot, rows.slot_begin[slice]);
      EXPECT_LT(slot, rows.slot_begin[slice + 1]);
      EXPECT_EQ(column_at(rows, slot, row), std::int32_t(lists.other[k]));
    }
  }
  // Whatever is read lies inside, also where there is no neighbour.
  for (int slice = 0; slice < rows.slices(); ++slice) {
    for (int slot = rows.slot_begin[slice]; slot < rows.slot_begin[slice + 1]; ++slot) {
      for (int lane = 0; lane < kSliceRows; ++lane) {
        const std::int32_t column = column_at(rows, slot, slice * kSliceRows + lane);
        EXPECT_GE(column, 0);
        EXPECT_LT(column, padded_rows(count));
      }
    }
  }
}

TEST(SlicedRows, OfAGridShareTheirSlots) {
  constexpr int kSide = 21;
  Array<MatrixEntry> entries;
  for (std::uint32_t j = 0; j < kSide; ++j) {
    for (std::uint32_t i = 0; i < kSide; ++i) {
      const std::uint32_t here = i + kSide * j;
      if (i + 1 < kSide) entries.push_back({here, here + 1, 1.0}), entries.push_back({here + 1, here, 1.0});
      if (j + 1 < kSide)
        entries.push_back({here, here + kSide, 1.0}), entries.push_back({here + kSide, here, 1.0});
    }
  }
  expect_sound(entries, kSide * kSide);
  merge_entries(entries);
  Array<std::int32_t> place;
  const SlicedRows rows = slice_rows(list_neighbours(entries, kSide * kSide), place);
  std::size_t listed = 0;
  for (const RowSlot& slot : rows.slots) listed += slot.columns >= 0 ? 1u : 0u;
  EXPECT_LT(listed, rows.slots.size() / 10);  // the first and the last slices, whose offsets lead outside
}

TEST(SlicedRows, OfRandomGraphsAreSoundToo) {
  testing_random::Random random;
  for (const int count : {1, 15, 16, 17, 200}) {
    Array<MatrixEntry> entries;
    for (int k = 0; k < 4 * count; ++k) {
      const std::uint32_t a = random.next(std::uint32_t(count)), b = random.next(std::uint32_t(count));
      entries.push_back({a, b, 1.0});
      entries.push_back({b, a, 1.0});
    }
    expect_sound(entries, count);
  }
}

TEST(SlicedRows, EntriesOfOnePlaceAreAddedUp) {
  Array<MatrixEntry> entries{{1, 0, 2.0}, {0, 1, 1.0}, {0, 0, 7.0}, {0, 1, 3.0}};
  merge_entries(entries);
  ASSERT_EQ(entries.size(), 2u);
  EXPECT_EQ(entries[0].value, 4.0);
  EXPECT_EQ(entries[1].value, 2.0);
}

}  // namespace
}  // namespace gyre::sliced_rows_test
