// How a sparse matrix of blocks is stored and eliminated: plain data, which kernels of every CPU target read too. Made by
// plan_blocks() in math/block_ldlt.h.
#pragma once

#include <cstdint>

namespace gyre {

struct BlockEntry {
  std::uint32_t index = 0;  // of the row's node in the order
  std::uint32_t offset =
      0;  // of its block among the values: rows of `place` by rows of the column, row after row
};

struct BlockColumn {
  std::uint32_t size = 0;            // rows of the node
  std::uint32_t row = 0;             // its first in vectors
  std::uint32_t diagonal = 0;        // offset of its own block among the values
  std::uint32_t begin = 0, end = 0;  // entries below the diagonal, by place
  std::uint32_t targets = 0;         // first of the blocks that eliminating it changes
};

}  // namespace gyre
