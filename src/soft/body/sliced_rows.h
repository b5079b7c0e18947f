// SlicedRows: the pattern of a sparse symmetric matrix over particles, in slices of 16 rows, so that the rows of a slice are worked on side
// by side whatever the width of the processor. A slice has slots; a slot holds at most one neighbour of each row.
//
// Where most rows of a slice have a neighbour at the same distance in the numbering (grids, boxes of cells), these share a slot, and its
// columns are read as one row of numbers. All other neighbours lie in slots whose columns are listed.
//
// The matrix acts by differences, y_i = sum_j B_ij (x_i - x_j), as everything does that internal forces make: a translation gives exactly
// zero, and there is no diagonal to keep. A place without a neighbour has B = 0.
//
// Source: sliced ELLPACK, A. Monakov, A. Lokhmotov, A. Avetisyan, "Automatically Tuning Sparse Matrix-Vector Multiplication", 2010.
#pragma once

#include "base/container/array.h"
#include "soft/body/element_blocks.h"

#include <cstdint>
#include <span>

namespace gyre {

struct SlicedRows {
  int count = 0;                   // rows, without those that fill up the last slice
  Array<std::int32_t> slot_begin;  // by slice, and the end
  Array<RowSlot> slots;
  Array<std::int32_t> columns;

  int slices() const { return padded_rows(count) / kSliceRows; }
  // Places for a number of the matrix, 16 a slot: that of row i in slot s is kSliceRows s + i % 16.
  std::size_t places() const { return slots.size() * kSliceRows; }
};

// Neighbours of each row, one row after the other, ascending: those of row i are other[begin[i]] to other[begin[i + 1] - 1].
struct NeighbourLists {
  Array<std::uint32_t> begin;
  Array<std::uint32_t> other;

  int rows() const { return int(begin.size()) - 1; }
};

// The pattern; `place` becomes the place of each neighbour in the order of the lists.
SlicedRows slice_rows(const NeighbourLists& lists, Array<std::int32_t>& place);

// The place in a row where a product reads this column; -1 if there is none. The column is another than the row.
int find_place(const SlicedRows& rows, std::uint32_t row, std::uint32_t column);

// One number of a matrix.
struct MatrixEntry {
  std::uint32_t row = 0;
  std::uint32_t column = 0;
  double value = 0.0;
};

// Sorts entries by row and column and adds up those of the same place, in the order given; entries on the diagonal are dropped.
void merge_entries(Array<MatrixEntry>& entries);

// The lists of neighbours of merged entries, each of which is one neighbour of its row.
NeighbourLists list_neighbours(std::span<const MatrixEntry> entries, int rows);

}  // namespace gyre
