#include "soft/body/sliced_rows.h"

#include "base/container/sort.h"

namespace gyre {

namespace {

// How many rows of a slice must share an offset to be read as one row of numbers: fewer cost less in a slot with listed columns.
constexpr int kSharedRows = 6;

// Offsets of a slice's neighbours, ascending, with the number of rows that have each.
struct OffsetCount {
  std::int32_t offset = 0;
  std::int32_t rows = 0;
};

void count_offsets(const NeighbourLists& lists, int first, int last, Array<OffsetCount>& counts) {
  counts.clear();
  for (int row = first; row < last; ++row) {
    for (std::uint32_t k = lists.begin[row]; k < lists.begin[row + 1]; ++k) {
      const std::int32_t offset = std::int32_t(lists.other[k]) - row;
      std::size_t at = 0;
      while (at < counts.size() && counts[at].offset < offset) ++at;
      if (at < counts.size() && counts[at].offset == offset) {
        ++counts[at].rows;
      } else {
        counts.insert_at(at, {offset, 1});
      }
    }
  }
}

// The slot of a slice that takes offset `offset`; -1 if there is none.
int find_slot(const SlicedRows& rows, int slot_begin, std::int32_t offset) {
  for (int slot = slot_begin; slot < int(rows.slots.size()); ++slot) {
    if (rows.slots[slot].columns < 0 && rows.slots[slot].offset == offset) return slot;
  }
  return -1;
}

void slice_one(const NeighbourLists& lists, int slice, SlicedRows& rows, Array<OffsetCount>& counts,
               Array<std::int32_t>& place) {
  const int first = slice * kSliceRows;
  const int last = first + kSliceRows < rows.count ? first + kSliceRows : rows.count;
  const int slot_begin = int(rows.slots.size());
  count_offsets(lists, first, last, counts);
  for (const OffsetCount& one : counts) {
    const bool inside = first + one.offset >= 0 && first + one.offset + kSliceRows <= padded_rows(rows.count);
    if (one.rows >= kSharedRows && inside) rows.slots.push_back({one.offset, -1});
  }
  const int listed_begin = int(rows.slots.size());
  for (int row = first; row < last; ++row) {
    int listed = listed_begin;
    for (std::uint32_t k = lists.begin[row]; k < lists.begin[row + 1]; ++k) {
      const std::int32_t column = std::int32_t(lists.other[k]);
      int slot = find_slot(rows, slot_begin, column - row);
      if (slot < 0) {
        slot = listed++;
        if (slot == int(rows.slots.size())) {
          rows.slots.push_back({0, std::int32_t(rows.columns.size())});
          for (int lane = 0; lane < kSliceRows; ++lane) rows.columns.push_back(first + lane);
        }
        rows.columns[rows.slots[slot].columns + row - first] = column;
      }
      place[k] = slot * kSliceRows + row - first;
    }
  }
}

}  // namespace

SlicedRows slice_rows(const NeighbourLists& lists, Array<std::int32_t>& place) {
  SlicedRows rows;
  rows.count = lists.rows();
  place.resize(lists.other.size());
  Array<OffsetCount> counts;
  rows.slot_begin.push_back(0);
  for (int slice = 0; slice < rows.slices(); ++slice) {
    slice_one(lists, slice, rows, counts, place);
    rows.slot_begin.push_back(std::int32_t(rows.slots.size()));
  }
  rows.slots.trim(rows.slots.size());
  rows.columns.trim(rows.columns.size());
  return rows;
}

int find_place(const SlicedRows& rows, std::uint32_t row, std::uint32_t column) {
  if (rows.slots.empty()) return -1;
  const int slice = int(row) / kSliceRows, lane = int(row) % kSliceRows;
  for (int slot = rows.slot_begin[slice]; slot < rows.slot_begin[slice + 1]; ++slot) {
    const RowSlot& one = rows.slots[slot];
    const std::int32_t read = one.columns < 0 ? std::int32_t(row) + one.offset : rows.columns[one.columns + lane];
    if (read == std::int32_t(column)) return slot * kSliceRows + lane;
  }
  return -1;
}

void merge_entries(Array<MatrixEntry>& entries) {
  Array<MatrixEntry> scratch;
  scratch.resize(entries.size());
  merge_sort(entries.view(), scratch.view(), [](const MatrixEntry& a, const MatrixEntry& b) {
    return a.row != b.row ? a.row < b.row : a.column < b.column;
  });
  std::size_t kept = 0;
  for (const MatrixEntry& entry : entries) {
    if (entry.row == entry.column) continue;
    if (kept > 0 && entries[kept - 1].row == entry.row && entries[kept - 1].column == entry.column) {
      entries[kept - 1].value += entry.value;
    } else {
      entries[kept++] = entry;
    }
  }
  entries.resize(kept);
}

NeighbourLists list_neighbours(std::span<const MatrixEntry> entries, int rows) {
  NeighbourLists lists;
  lists.begin.resize(std::size_t(rows) + 1);
  for (const MatrixEntry& entry : entries) {
    ++lists.begin[entry.row + 1];
    lists.other.push_back(entry.column);
  }
  for (int row = 0; row < rows; ++row) lists.begin[row + 1] += lists.begin[row];
  return lists;
}

}  // namespace gyre
