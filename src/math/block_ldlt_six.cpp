// The factorisation of math/block_ldlt.h for blocks of six rows: two columns at a time (math/block_six.h).
#include "math/block_inverse.h"
#include "math/block_ldlt.h"
#include "math/block_six.h"

#include <algorithm>

namespace gyre {

void factor_six_blocks(const BlockPlan& plan, std::span<double> values, std::span<double> room) {
  for (const BlockColumn& column : plan.columns) {
    double* const diagonal = &values[column.diagonal];
    invert_block<kSix>(diagonal);
    if (column.begin == column.end) continue;
    const std::size_t count = column.end - column.begin;
    double* const below = &values[plan.entries[column.begin].offset];  // one block after the other
    double *const transposed = room.data(), *const scaled = transposed + count * kSixBlock;
    const std::uint32_t* target = plan.targets.data() + column.targets;
    for (std::size_t i = 0; i < count; ++i) {
      double* const own = scaled + i * kSixBlock;
      transpose_six(below + i * kSixBlock, transposed + i * kSixBlock);
      multiply_six(below + i * kSixBlock, diagonal, own);
      for (std::size_t j = 0; j <= i; ++j)
        subtract_product_six(own, transposed + j * kSixBlock, &values[*target++]);
    }
    std::copy(scaled, scaled + count * kSixBlock, below);
  }
}

void solve_six_blocks(const BlockPlan& plan, std::span<const double> values, std::span<double> x) {
  for (const BlockColumn& column : plan.columns) {
    for (std::uint32_t i = column.begin; i < column.end; ++i) {
      const BlockEntry& entry = plan.entries[i];
      subtract_times_six(&values[entry.offset], &x[column.row], &x[plan.columns[entry.index].row]);
    }
  }
  for (std::size_t index = plan.columns.size(); index-- > 0;) {
    const BlockColumn& column = plan.columns[index];
    double own[kSix] = {};
    for (int r = 0; r < kSix; ++r) {
      for (int c = 0; c < kSix; ++c)
        own[r] += values[column.diagonal + std::uint32_t(kSix * r + c)] * x[column.row + std::uint32_t(c)];
    }
    for (std::uint32_t i = column.begin; i < column.end; ++i) {
      const BlockEntry& entry = plan.entries[i];
      subtract_transposed_six(&values[entry.offset], &x[plan.columns[entry.index].row], own);
    }
    std::copy(own, own + kSix, &x[column.row]);
  }
}

}  // namespace gyre
