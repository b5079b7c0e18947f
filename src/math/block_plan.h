// The storage and elimination of a sparse matrix of blocks, as plain data that kernels of every CPU target can read.
// Made by plan_blocks() in math/block_ldlt.h.
#pragma once

#include <cstdint>

namespace gyre {

struct BlockEntry {
  std::uint32_t index = 0;  // of the row's node, in the elimination order
  std::uint32_t offset =
      0;  // of its block in the values: rows of the entry's node by rows of the column, row after row
};

struct BlockColumn {
  std::uint32_t size = 0;            // rows of the node
  std::uint32_t row = 0;             // its first row in vectors
  std::uint32_t diagonal = 0;        // offset of its diagonal block in the values
  std::uint32_t begin = 0, end = 0;  // entries below the diagonal, ascending by index
  std::uint32_t targets = 0;         // first of the blocks that its elimination changes
};

}  // namespace gyre
