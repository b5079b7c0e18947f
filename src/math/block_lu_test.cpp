// The sparse factorisation of unsymmetric blocks: it recovers a known vector from its product with the matrix.
#include "math/block_lu.h"

#include <gtest/gtest.h>

#include <cmath>
#include <vector>

namespace gyre::block_lu_test {
namespace {

class Random {
 public:
  double next() {  // -1 to 1
    state_ = state_ * 6364136223846793005u + 1442695040888963407u;
    return double(std::int64_t(state_ >> 11)) / double(std::int64_t{1} << 52) - 1.0;
  }

 private:
  std::uint64_t state_ = 11;
};

struct Sparse {
  Arena arena;
  BlockPlan plan;
  std::vector<double> lower, upper, pivots;
  BlockLu lu() { return {&plan, lower, upper, pivots}; }
};

// Nodes in a square, each coupled to its neighbours. `heavy` is added to the diagonal.
void make_grid(Sparse& sparse, std::uint32_t side, double heavy, Random& random) {
  std::vector<std::uint8_t> sizes(side * side, kLuBlock);
  std::vector<BlockEdge> edges;
  for (std::uint32_t i = 0; i < side * side; ++i) {
    if (i % side > 0) edges.push_back({i, i - 1});
    if (i >= side) edges.push_back({i, i - side});
  }
  ASSERT_TRUE(plan_blocks(sizes, edges, 1u << 30, sparse.arena, sparse.plan));
  sparse.lower.assign(sparse.plan.values, 0.0);
  sparse.upper = sparse.lower;
  sparse.pivots.assign(sparse.plan.rows, 0.0);
  for (const BlockColumn& column : sparse.plan.columns) {
    for (std::uint32_t k = 0; k < 36; ++k) sparse.lower[column.diagonal + k] = random.next();
    // Not on the diagonal: a factorisation without exchanges within the block would meet small pivots.
    for (std::uint32_t k = 0; k < 6; ++k) sparse.lower[column.diagonal + 6 * k + (k + 1) % 6] += heavy;
  }
  for (const BlockEdge& edge : edges) {
    const BlockLocation location = find_block(sparse.plan, edge.a, edge.b);
    for (std::uint32_t k = 0; k < 36; ++k) {
      sparse.lower[location.offset + k] = random.next();
      sparse.upper[location.offset + k] = random.next();
    }
  }
}

std::vector<double> times(const Sparse& sparse, const std::vector<double>& x) {
  std::vector<double> y(x.size(), 0.0);
  const auto add = [&](const double* block, std::uint32_t row, std::uint32_t column) {
    for (std::uint32_t r = 0; r < 6; ++r)
      for (std::uint32_t c = 0; c < 6; ++c) y[row + r] += block[6 * r + c] * x[column + c];
  };
  for (const BlockColumn& column : sparse.plan.columns) {
    add(&sparse.lower[column.diagonal], column.row, column.row);
    for (std::uint32_t i = column.begin; i < column.end; ++i) {
      const BlockEntry& entry = sparse.plan.entries[i];
      const std::uint32_t row = sparse.plan.columns[entry.index].row;
      add(&sparse.lower[entry.offset], row, column.row);
      add(&sparse.upper[entry.offset], column.row, row);
    }
  }
  return y;
}

TEST(BlockLu, RecoversAKnownVector) {
  Random random;
  for (std::uint32_t side = 1; side < 8; ++side) {
    Sparse sparse;
    make_grid(sparse, side, 8.0, random);
    std::vector<double> known(sparse.plan.rows);
    for (double& value : known) value = random.next();
    std::vector<double> x = times(sparse, known);
    ASSERT_TRUE(factor_lu(sparse.lu()));
    solve_lu(sparse.lu(), x);
    for (std::size_t i = 0; i < x.size(); ++i) EXPECT_NEAR(x[i], known[i], 1.0e-12) << side;
  }
}

TEST(BlockLu, SaysThatAMatrixIsSingular) {
  Random random;
  Sparse sparse;
  make_grid(sparse, 2, 8.0, random);
  const BlockColumn& column = sparse.plan.columns[0];
  for (std::uint32_t k = 0; k < 6; ++k) sparse.lower[column.diagonal + 6 * k + 3] = 0.0;
  EXPECT_FALSE(factor_lu(sparse.lu()));
}

}  // namespace
}  // namespace gyre::block_lu_test
