// Sparse symmetric matrices of small dense blocks, factored as L D L^T. An elimination order with little fill-in is
// found once for a pattern, and then used for any number of factorisations and solutions.
//
// The order is minimum degree: the node with the fewest neighbours goes first, and its neighbours become neighbours of
// each other. Among equals the node that reached its degree last goes first, so a chain is followed from end to end. On
// a tree this eliminates from the leaves to the root, with hardly a new block. Everything is a function of the
// numbering of nodes and edges: the same bits everywhere.
//
// Sources: W. Tinney and J. Walker, Proc. IEEE 55, 1967 (minimum degree); A. George and J. Liu, "Computer Solution of
// Large Sparse Positive Definite Systems", 1981.
#pragma once

#include "base/arena/arena.h"
#include "math/block_plan.h"

#include <cstdint>
#include <span>

namespace gyre {

constexpr int kMaxBlockRows = 6;

// Two nodes with a block that is not zero. Pairs may repeat; a node is not paired with itself.
struct BlockEdge {
  std::uint32_t a = 0, b = 0;
};

// The memory belongs to the arena that was given to plan_blocks().
struct BlockPlan {
  std::span<const std::uint32_t> index_of;  // index in the order, by node
  std::span<const std::uint32_t> node_at;   // node, by index in the order
  std::span<const BlockColumn> columns;     // in the order
  std::span<const BlockEntry> entries;
  std::span<const std::uint32_t> targets;  // offsets for each pair of entries of a column, row by row
  std::uint32_t values = 0;                // number of doubles of the matrix
  std::uint32_t rows = 0;                  // number of rows of a vector
  std::uint32_t widest = 0;                // values of the largest column below its diagonal
  std::uint64_t work = 0;                  // multiplications in one factorisation
  bool is_six = false;                     // every node has six rows
};

// Plans the elimination of nodes with `sizes` rows (1 to 6). False, without a plan, if it would take more than
// `max_work` multiplications.
bool plan_blocks(std::span<const std::uint8_t> sizes, std::span<const BlockEdge> edges,
                 std::uint64_t max_work, Arena& arena, BlockPlan& plan);

// The location of the block of two nodes. `first_is_row`: its rows are those of `a`, otherwise those of `b`.
struct BlockLocation {
  std::uint32_t offset = 0;
  bool first_is_row = false;
};
BlockLocation find_block(const BlockPlan& plan, std::uint32_t a, std::uint32_t b);

// Replaces the values of the matrix (lower triangle of blocks; whole diagonal blocks) by its factors. Pivots that are
// only rounding are dropped, as in math/dense.h. `room` holds factor_room() doubles.
constexpr std::size_t factor_room(const BlockPlan& plan) {
  return (plan.is_six ? 2 : 1) * std::size_t(plan.widest);
}
void factor_blocks(const BlockPlan& plan, std::span<double> values, std::span<double> room);
// Solves in place: `x` is the right side before and the solution after, with rows in the order of the plan.
void solve_blocks(const BlockPlan& plan, std::span<const double> values, std::span<double> x);

// The first half of a solution, L y = x in place, and `scaled` = D^-1 y: cheap if few rows of x are not zero. For two
// right sides a and b, a . A^-1 b is then y_a . scaled_b.
void solve_blocks_down(const BlockPlan& plan, std::span<const double> values, std::span<double> x,
                       std::span<double> scaled);

// The same for plans in which every node has six rows: the same bits, faster (math/block_ldlt_six.cpp).
void factor_six_blocks(const BlockPlan& plan, std::span<double> values, std::span<double> room);
void solve_six_blocks(const BlockPlan& plan, std::span<const double> values, std::span<double> x);

}  // namespace gyre
