// The sparse factorisation against a dense one, on graphs with a known good or bad elimination order.
#include "math/block_ldlt.h"

#include "math/dense.h"

#include <gtest/gtest.h>

#include <cmath>
#include <vector>

namespace gyre::block_ldlt_test {
namespace {

class Random {
 public:
  double next() {  // -1 to 1
    state_ = state_ * 6364136223846793005u + 1442695040888963407u;
    return double(std::int64_t(state_ >> 11)) / double(std::int64_t{1} << 52) - 1.0;
  }

 private:
  std::uint64_t state_ = 7;
};

struct Graph {
  std::vector<std::uint8_t> sizes;
  std::vector<BlockEdge> edges;
};

Graph chain(std::uint32_t count, std::uint8_t size, bool closed = false) {
  Graph graph;
  for (std::uint32_t i = 0; i < count; ++i) graph.sizes.push_back(size);
  for (std::uint32_t i = 0; i + 1 < count; ++i) graph.edges.push_back({i + 1, i});
  if (closed) graph.edges.push_back({0, count - 1});
  return graph;
}

// The joints of a random tree of bodies: the joints of one body are all neighbours of each other.
Graph tree(std::uint32_t count, std::uint8_t size) {
  Graph graph;
  Random random;
  std::vector<std::vector<std::uint32_t>> at_body(count + 1);
  for (std::uint32_t joint = 0; joint < count; ++joint) {
    const std::uint32_t parent = std::uint32_t(std::fabs(random.next()) * double(joint));
    for (const std::uint32_t other : at_body[parent]) graph.edges.push_back({joint, other});
    at_body[parent].push_back(joint);
    at_body[joint + 1].push_back(joint);
    graph.sizes.push_back(size);
  }
  return graph;
}

Graph grid(std::uint32_t side) {
  Graph graph;
  for (std::uint32_t i = 0; i < side * side; ++i) {
    graph.sizes.push_back(3);
    if (i % side > 0) graph.edges.push_back({i, i - 1});
    if (i >= side) graph.edges.push_back({i, i - side});
  }
  return graph;
}

// A symmetric matrix J J^T with the graph's pattern: each edge has rows of its own, and each node `own` more.
struct Matrix {
  std::vector<double> dense;
  std::vector<std::uint32_t> first;  // row of each node
  std::uint32_t rows = 0;
};
Matrix random_matrix(const Graph& graph, int own) {
  Matrix m;
  Random random;
  for (const std::uint8_t size : graph.sizes) {
    m.first.push_back(m.rows);
    m.rows += size;
  }
  m.dense.assign(m.rows * m.rows, 0.0);
  const auto add = [&](const std::vector<std::uint32_t>& nodes) {
    std::vector<std::pair<std::uint32_t, double>> column;
    for (const std::uint32_t node : nodes) {
      for (std::uint32_t r = 0; r < graph.sizes[node]; ++r)
        column.push_back({m.first[node] + r, random.next()});
    }
    for (const auto& [i, a] : column) {
      for (const auto& [j, b] : column) m.dense[i * m.rows + j] += a * b;
    }
  };
  for (const BlockEdge& edge : graph.edges) {
    for (int k = 0; k < 4; ++k) add({edge.a, edge.b});
  }
  for (std::uint32_t node = 0; node < graph.sizes.size(); ++node) {
    for (int k = 0; k < own; ++k) add({node});
  }
  return m;
}

// From the rows of the matrix to those of the plan.
std::vector<double> in_order(const Graph& graph, const Matrix& m, const std::vector<double>& b,
                             const BlockPlan& plan) {
  std::vector<double> x(plan.rows);
  for (std::uint32_t node = 0; node < graph.sizes.size(); ++node) {
    const BlockColumn& column = plan.columns[plan.index_of[node]];
    for (std::uint32_t r = 0; r < graph.sizes[node]; ++r) x[column.row + r] = b[m.first[node] + r];
  }
  return x;
}

std::vector<double> factored(const Graph& graph, const Matrix& m, const BlockPlan& plan) {
  std::vector<double> values(plan.values), room(factor_room(plan) + 1);
  const auto copy = [&](std::uint32_t row, std::uint32_t column, std::uint32_t offset) {
    for (std::uint32_t r = 0; r < graph.sizes[row]; ++r) {
      for (std::uint32_t c = 0; c < graph.sizes[column]; ++c)
        values[offset + r * graph.sizes[column] + c] =
            m.dense[(m.first[row] + r) * m.rows + m.first[column] + c];
    }
  };
  for (std::uint32_t node = 0; node < graph.sizes.size(); ++node)
    copy(node, node, plan.columns[plan.index_of[node]].diagonal);
  for (const BlockEdge& edge : graph.edges) {
    const BlockLocation location = find_block(plan, edge.a, edge.b);
    copy(location.first_is_row ? edge.a : edge.b, location.first_is_row ? edge.b : edge.a, location.offset);
  }
  factor_blocks(plan, values, room);
  return values;
}

std::vector<double> sparse_solution(const Graph& graph, const Matrix& m, const std::vector<double>& b,
                                    const BlockPlan& plan) {
  std::vector<double> x = in_order(graph, m, b, plan);
  solve_blocks(plan, factored(graph, m, plan), x);
  std::vector<double> result(m.rows);
  for (std::uint32_t node = 0; node < graph.sizes.size(); ++node) {
    const BlockColumn& column = plan.columns[plan.index_of[node]];
    for (std::uint32_t r = 0; r < graph.sizes[node]; ++r) result[m.first[node] + r] = x[column.row + r];
  }
  return result;
}

double dot(const std::vector<double>& a, const std::vector<double>& b) {
  double sum = 0.0;
  for (std::size_t i = 0; i < a.size(); ++i) sum += a[i] * b[i];
  return sum;
}

// |A x - b| over |b|.
double residual(const Matrix& m, const std::vector<double>& x, const std::vector<double>& b) {
  double error = 0.0, size = 0.0;
  for (std::uint32_t i = 0; i < m.rows; ++i) {
    double sum = -b[i];
    for (std::uint32_t j = 0; j < m.rows; ++j) sum += m.dense[i * m.rows + j] * x[j];
    error += sum * sum;
    size += b[i] * b[i];
  }
  return std::sqrt(error / size);
}

TEST(BlockLdlt, AgreesWithADenseFactorisation) {
  Graph mixed = tree(40, 3);
  for (std::size_t i = 0; i < mixed.sizes.size(); ++i) mixed.sizes[i] = std::uint8_t(1 + i % kMaxBlockRows);
  mixed.edges.push_back({0, 39});
  mixed.edges.push_back({39, 0});  // pairs may repeat
  for (const Graph& graph :
       {chain(1, 3), chain(30, 3), chain(30, 5), chain(17, 6, true), tree(50, 5), grid(7), mixed}) {
    Arena arena;
    BlockPlan plan;
    ASSERT_TRUE(plan_blocks(graph.sizes, graph.edges, std::uint64_t{1} << 40, arena, plan));
    const Matrix m = random_matrix(graph, 7);
    Random random;
    std::vector<double> b(m.rows);
    for (double& value : b) value = random.next();
    EXPECT_LT(residual(m, sparse_solution(graph, m, b, plan), b), 1e-9) << graph.sizes.size() << " nodes";
  }
}

// Redundant rows too: a body has fewer constraints than rows.
TEST(BlockLdlt, BlocksOfSixAreSolvedBitForBitAlike) {
  Graph net = grid(7);
  for (std::uint8_t& size : net.sizes) size = 6;
  for (const Graph& graph : {chain(1, 6), chain(17, 6, true), tree(50, 6), net}) {
    Arena arena;
    BlockPlan plan;
    ASSERT_TRUE(plan_blocks(graph.sizes, graph.edges, std::uint64_t{1} << 40, arena, plan));
    ASSERT_TRUE(plan.is_six);
    BlockPlan any_size = plan;
    any_size.is_six = false;
    for (const int own : {7, 1}) {
      const Matrix m = random_matrix(graph, own);
      Random random;
      std::vector<double> b(m.rows);
      for (double& value : b) value = random.next();
      EXPECT_EQ(sparse_solution(graph, m, b, plan), sparse_solution(graph, m, b, any_size))
          << graph.sizes.size() << " nodes";
    }
  }
}

// For right sides that are zero except in one node, as an impulse at a joint makes them.
TEST(BlockLdlt, HalfSolutionsGiveTheBilinearForm) {
  Graph mixed = tree(40, 3);
  for (std::size_t i = 0; i < mixed.sizes.size(); ++i) mixed.sizes[i] = std::uint8_t(1 + i % kMaxBlockRows);
  for (const Graph& graph : {chain(12, 5), chain(17, 6, true), grid(5), mixed}) {
    Arena arena;
    BlockPlan plan;
    ASSERT_TRUE(plan_blocks(graph.sizes, graph.edges, std::uint64_t{1} << 40, arena, plan));
    const Matrix m = random_matrix(graph, 7);
    const std::vector<double> values = factored(graph, m, plan);
    Random random;
    const std::size_t nodes = graph.sizes.size();
    std::vector<std::vector<double>> sides, down, scaled;
    for (const std::size_t node : {std::size_t{0}, nodes / 2, nodes - 1}) {
      std::vector<double>& b = sides.emplace_back(m.rows);
      for (std::uint32_t r = 0; r < graph.sizes[node]; ++r) b[m.first[node] + r] = random.next();
      down.push_back(in_order(graph, m, b, plan));
      solve_blocks_down(plan, values, down.back(), scaled.emplace_back(plan.rows, 7.0));
    }
    for (std::size_t i = 0; i < sides.size(); ++i) {
      for (std::size_t j = 0; j < sides.size(); ++j) {
        const double whole = dot(sides[i], sparse_solution(graph, m, sides[j], plan));
        EXPECT_NEAR(dot(down[i], scaled[j]), whole, 1e-10 * std::abs(whole) + 1e-12) << nodes << " nodes";
      }
    }
  }
}

// Elimination from the leaves adds no block; minimum degree adds a few where a body has many joints.
TEST(BlockLdlt, AddsHardlyABlockToATree) {
  for (const std::uint32_t count : {1u, 2u, 10u, 1000u}) {
    Arena arena;
    BlockPlan plan;
    const Graph graph = tree(count, 3);
    ASSERT_TRUE(plan_blocks(graph.sizes, graph.edges, std::uint64_t{1} << 40, arena, plan));
    EXPECT_LE(plan.entries.size(), graph.edges.size() + graph.edges.size() / 20) << count;
  }
}

TEST(BlockLdlt, WorksInProportionToAChainOpenOrClosed) {
  std::uint64_t work[2][2];
  for (const bool closed : {false, true}) {
    for (int k = 0; k < 2; ++k) {
      Arena arena;
      BlockPlan plan;
      const Graph graph = chain(k == 0 ? 100 : 1000, 3, closed);
      ASSERT_TRUE(plan_blocks(graph.sizes, graph.edges, std::uint64_t{1} << 40, arena, plan));
      work[closed][k] = plan.work;
      EXPECT_LE(plan.entries.size(), (closed ? 2 : 1) * graph.sizes.size());
    }
    EXPECT_LT(work[closed][1], 11 * work[closed][0]);
  }
}

TEST(BlockLdlt, RefusesTooMuchWork) {
  const Graph graph = grid(30);
  Arena arena;
  BlockPlan plan;
  EXPECT_FALSE(plan_blocks(graph.sizes, graph.edges, 1000 * graph.sizes.size(), arena, plan));
  EXPECT_TRUE(plan_blocks(graph.sizes, graph.edges, std::uint64_t{1} << 40, arena, plan));
  EXPECT_GT(plan.work, 1000 * graph.sizes.size());
}

// Repeated rows: the right side lies in the range, and the pivots of the repeated rows are only rounding.
TEST(BlockLdlt, DropsRedundantRows) {
  const Graph graph = chain(12, 5);
  Matrix m = random_matrix(graph, 1);  // 4 columns an edge, 1 a node: 56 columns for 60 rows
  ASSERT_EQ(m.rows, 60u);
  Random random;
  std::vector<double> truth(m.rows), b(m.rows, 0.0);
  for (double& value : truth) value = random.next();
  for (std::uint32_t i = 0; i < m.rows; ++i) {
    for (std::uint32_t j = 0; j < m.rows; ++j) b[i] += m.dense[i * m.rows + j] * truth[j];
  }
  Arena arena;
  BlockPlan plan;
  ASSERT_TRUE(plan_blocks(graph.sizes, graph.edges, std::uint64_t{1} << 40, arena, plan));
  const std::vector<double> x = sparse_solution(graph, m, b, plan);
  EXPECT_LT(residual(m, x, b), 1e-3);
}

}  // namespace
}  // namespace gyre::block_ldlt_test
