// The minimum degree order, the plan and the kernels of the factorisation. See block_ldlt.h.
#include "math/block_ldlt.h"

#include "base/check.h"
#include "math/block_inverse.h"

#include <algorithm>
#include <type_traits>

namespace gyre {

namespace {

constexpr std::uint32_t kNone = 0xffffffffu;

// The graph during elimination: the remaining neighbours of each node.
class Elimination {
 public:
  Elimination(std::span<const std::uint8_t> sizes, std::span<const BlockEdge> edges, Arena& arena)
      : arena_(arena),
        sizes_(sizes),
        lists_(arena.make<List>(sizes.size())),
        marks_(arena.make<std::uint32_t>(sizes.size())),
        heads_(arena.make<std::uint32_t>(sizes.size() + 1)),
        before_(arena.make<std::uint32_t>(sizes.size())),
        after_(arena.make<std::uint32_t>(sizes.size())) {
    for (List& list : lists_) list = {};
    for (std::uint32_t& mark : marks_) mark = kNone;
    for (std::uint32_t& head : heads_) head = kNone;
    for (const BlockEdge& edge : edges) ++lists_[edge.a].room, ++lists_[edge.b].room;
    for (List& list : lists_) list.items = arena.make<std::uint32_t>(list.room).data();
    for (const BlockEdge& edge : edges) lists_[edge.a].add(edge.b), lists_[edge.b].add(edge.a);
    for (std::uint32_t node = std::uint32_t(sizes.size()); node-- > 0;) {
      drop_doubles(node);
      insert(node);
    }
  }

  // Removes and returns the next node; its neighbours stay readable until the next call. kNone if none is left.
  std::uint32_t next() {
    while (lowest_ < heads_.size() && heads_[lowest_] == kNone) ++lowest_;
    if (lowest_ == heads_.size()) return kNone;
    const std::uint32_t node = heads_[lowest_];
    remove(node);
    return node;
  }
  std::span<const std::uint32_t> neighbours(std::uint32_t node) const {
    return {lists_[node].items, lists_[node].count};
  }

  // Makes the neighbours of the node neighbours of each other.
  void eliminate(std::uint32_t node) {
    const std::span<const std::uint32_t> around = neighbours(node);
    for (const std::uint32_t other : around) marks_[other] = node;
    for (const std::uint32_t other : around) {
      remove(other);
      List& list = lists_[other];
      std::uint32_t count = 0;
      for (std::uint32_t i = 0; i < list.count; ++i) {
        const std::uint32_t item = list.items[i];
        if (item != node && marks_[item] != node) list.items[count++] = item;
      }
      list.count = count;
      reserve(list, count + std::uint32_t(around.size()) - 1);
      for (const std::uint32_t item : around) {
        if (item != other) list.add(item);
      }
      insert(other);
    }
  }

 private:
  struct List {
    std::uint32_t* items = nullptr;
    std::uint32_t count = 0, room = 0;
    void add(std::uint32_t item) { items[count++] = item; }
  };

  void drop_doubles(std::uint32_t node) {
    List& list = lists_[node];
    std::uint32_t count = 0;
    for (std::uint32_t i = 0; i < list.count; ++i) {
      const std::uint32_t item = list.items[i];
      if (marks_[item] == node) continue;
      marks_[item] = node;
      list.items[count++] = item;
    }
    list.count = count;
  }
  void reserve(List& list, std::uint32_t room) {
    if (room <= list.room) return;
    list.room = 2 * room;
    std::uint32_t* items = arena_.make<std::uint32_t>(list.room).data();
    std::copy(list.items, list.items + list.count, items);
    list.items = items;
  }
  // Lists nodes by number of neighbours, in doubly linked lists.
  void insert(std::uint32_t node) {
    const std::uint32_t degree = lists_[node].count;
    before_[node] = kNone;
    after_[node] = heads_[degree];
    if (heads_[degree] != kNone) before_[heads_[degree]] = node;
    heads_[degree] = node;
    lowest_ = std::min(lowest_, degree);
  }
  void remove(std::uint32_t node) {
    if (after_[node] != kNone) before_[after_[node]] = before_[node];
    if (before_[node] != kNone) {
      after_[before_[node]] = after_[node];
    } else {
      heads_[lists_[node].count] = after_[node];
    }
  }

  Arena& arena_;
  std::span<const std::uint8_t> sizes_;
  std::span<List> lists_;
  std::span<std::uint32_t> marks_;
  std::span<std::uint32_t> heads_, before_, after_;
  std::uint32_t lowest_ = 0;
};

// Lists, for each pair of entries of each column, the block that its elimination changes: entry i (rows) by entry j <=
// i.
std::span<std::uint32_t> list_targets(std::span<BlockColumn> columns, std::span<const BlockEntry> entries,
                                      Arena& arena) {
  std::size_t count = 0;
  for (BlockColumn& column : columns) {
    const std::size_t below = column.end - column.begin;
    column.targets = std::uint32_t(count);
    count += below * (below + 1) / 2;
  }
  const std::span<std::uint32_t> targets = arena.make<std::uint32_t>(count);
  for (const BlockColumn& column : columns) {
    for (std::uint32_t j = column.begin; j < column.end; ++j) {
      const BlockColumn& other = columns[entries[j].index];
      std::uint32_t at = other.begin;
      for (std::uint32_t i = j; i < column.end; ++i) {
        const std::uint32_t local = i - column.begin;
        std::uint32_t& target = targets[column.targets + local * (local + 1) / 2 + (j - column.begin)];
        if (i == j) {
          target = other.diagonal;
          continue;
        }
        while (entries[at].index != entries[i].index) ++at;
        target = entries[at].offset;
      }
    }
  }
  return targets;
}

void sort_by_index(std::span<BlockEntry> entries) {
  for (std::size_t i = 1; i < entries.size(); ++i) {
    const BlockEntry entry = entries[i];
    std::size_t k = i;
    for (; k > 0 && entries[k - 1].index > entry.index; --k) entries[k] = entries[k - 1];
    entries[k] = entry;
  }
}

// Kernels: R, Q and C are numbers of rows known at compile time, or 0 for those of the arguments.
template <int R, int C>
void multiply(const double* b, const double* d, double* out, int rows, int columns) {
  const int r_end = R > 0 ? R : rows, c_end = C > 0 ? C : columns;
  for (int r = 0; r < r_end; ++r) {
    for (int c = 0; c < c_end; ++c) {
      double sum = 0.0;
      for (int k = 0; k < c_end; ++k) sum += b[r * c_end + k] * d[k * c_end + c];
      out[r * c_end + c] = sum;
    }
  }
}
template <int R, int Q, int C>
void subtract_product(const double* w, const double* b, double* out, int rows, int others, int columns) {
  const int r_end = R > 0 ? R : rows, q_end = Q > 0 ? Q : others, c_end = C > 0 ? C : columns;
  for (int r = 0; r < r_end; ++r) {
    for (int q = 0; q < q_end; ++q) {
      double sum = 0.0;
      for (int k = 0; k < c_end; ++k) sum += w[r * c_end + k] * b[q * c_end + k];
      out[r * q_end + q] -= sum;
    }
  }
}

// Calls fn with the number as a constant for a ball joint or a hinge, with 0 otherwise.
template <class Fn>
void with_constant(std::uint32_t rows, Fn&& fn) {
  if (rows == 3) return fn(std::integral_constant<int, 3>());
  if (rows == 5) return fn(std::integral_constant<int, 5>());
  fn(std::integral_constant<int, 0>());
}

void invert(double* block, std::uint32_t size) {
  switch (size) {
    case 1:
      return invert_block<1>(block);
    case 2:
      return invert_block<2>(block);
    case 3:
      return invert_block<3>(block);
    case 4:
      return invert_block<4>(block);
    case 5:
      return invert_block<5>(block);
    default:
      return invert_block<6>(block);
  }
}

// y -= B x, and y -= B^T x.
template <int R, int C>
void subtract_times(const double* b, const double* x, double* y, int rows, int columns) {
  const int r_end = R > 0 ? R : rows, c_end = C > 0 ? C : columns;
  for (int r = 0; r < r_end; ++r) {
    double sum = 0.0;
    for (int c = 0; c < c_end; ++c) sum += b[r * c_end + c] * x[c];
    y[r] -= sum;
  }
}
template <int R, int C>
void subtract_transposed_times(const double* b, const double* x, double* y, int rows, int columns) {
  const int r_end = R > 0 ? R : rows, c_end = C > 0 ? C : columns;
  for (int r = 0; r < r_end; ++r) {
    for (int c = 0; c < c_end; ++c) y[c] -= b[r * c_end + c] * x[r];
  }
}

// Eliminates a column of C rows (0: as many as it has).
template <int C>
void eliminate_column(const BlockPlan& plan, const BlockColumn& column, double* values, double* room) {
  const double* diagonal = values + column.diagonal;
  const int columns = int(column.size);
  double* scaled = room;
  const std::uint32_t* target = plan.targets.data() + column.targets;
  for (std::uint32_t i = column.begin; i < column.end; ++i) {
    const BlockEntry& entry = plan.entries[i];
    const int rows = int(plan.columns[entry.index].size);
    with_constant(std::uint32_t(rows), [&](auto r) {
      multiply<r(), C>(values + entry.offset, diagonal, scaled, rows, columns);
      for (std::uint32_t j = column.begin; j <= i; ++j) {
        const BlockEntry& other = plan.entries[j];
        const int others = int(plan.columns[other.index].size);
        double* out = values + *target++;
        with_constant(std::uint32_t(others), [&](auto q) {
          subtract_product<r(), q(), C>(scaled, values + other.offset, out, rows, others, columns);
        });
      }
    });
    scaled += rows * columns;
  }
  if (column.begin < column.end) std::copy(room, scaled, values + plan.entries[column.begin].offset);
}

template <int C>
void solve_down(const BlockPlan& plan, const BlockColumn& column, const double* values, double* x) {
  for (std::uint32_t i = column.begin; i < column.end; ++i) {
    const BlockColumn& row = plan.columns[plan.entries[i].index];
    with_constant(row.size, [&](auto r) {
      subtract_times<r(), C>(values + plan.entries[i].offset, x + column.row, x + row.row, int(row.size),
                             int(column.size));
    });
  }
}

bool is_zero(const double* x, std::uint32_t count) {
  for (std::uint32_t i = 0; i < count; ++i)
    if (x[i] != 0.0) return false;
  return true;
}

// D^-1 times the rows of a vector that belong to a column. The diagonal block contains D^-1.
template <int C>
void scale_column(const BlockColumn& column, const double* values, const double* x, double* out) {
  const int size = C > 0 ? C : int(column.size);
  const double* const inverse = values + column.diagonal;
  for (int r = 0; r < size; ++r) {
    double sum = 0.0;
    for (int c = 0; c < size; ++c) sum += inverse[r * size + c] * x[c];
    out[r] = sum;
  }
}

template <int C>
void solve_up(const BlockPlan& plan, const BlockColumn& column, const double* values, double* x) {
  const int size = C > 0 ? C : int(column.size);
  double own[kMaxBlockRows];
  scale_column<C>(column, values, x + column.row, own);
  for (std::uint32_t i = column.begin; i < column.end; ++i) {
    const BlockColumn& row = plan.columns[plan.entries[i].index];
    with_constant(row.size, [&](auto r) {
      subtract_transposed_times<r(), C>(values + plan.entries[i].offset, x + row.row, own, int(row.size),
                                        size);
    });
  }
  for (int r = 0; r < size; ++r) x[column.row + std::uint32_t(r)] = own[r];
}

// Lists the neighbours of each column at its elimination. False if the work exceeds `max_work`.
bool eliminate_all(std::span<const std::uint8_t> sizes, std::span<const BlockEdge> edges,
                   std::uint64_t max_work, Arena& arena, std::span<std::uint32_t> index_of,
                   std::span<std::uint32_t> node_at, std::span<std::span<const std::uint32_t>> below,
                   std::uint64_t& work) {
  Elimination elimination(sizes, edges, arena);
  work = 0;
  for (std::uint32_t index = 0; index < sizes.size(); ++index) {
    const std::uint32_t node = elimination.next();
    const std::span<const std::uint32_t> around = elimination.neighbours(node);
    std::uint64_t rows = 0;
    for (const std::uint32_t other : around) rows += sizes[other];
    const std::uint64_t own = sizes[node];
    work += own * own * own + own * own * rows + own * rows * (rows + 1) / 2;
    if (work > max_work) return false;
    index_of[node] = index;
    node_at[index] = node;
    below[index] = around;
    elimination.eliminate(node);
  }
  return true;
}

}  // namespace

bool plan_blocks(std::span<const std::uint8_t> sizes, std::span<const BlockEdge> edges,
                 std::uint64_t max_work, Arena& arena, BlockPlan& plan) {
  const std::size_t count = sizes.size();
  const std::span<std::uint32_t> index_of = arena.make<std::uint32_t>(count);
  const std::span<std::uint32_t> node_at = arena.make<std::uint32_t>(count);
  const std::span<std::span<const std::uint32_t>> below = arena.make<std::span<const std::uint32_t>>(count);
  plan = {};
  if (!eliminate_all(sizes, edges, max_work, arena, index_of, node_at, below, plan.work)) return false;
  std::size_t entry_count = 0;
  for (const std::span<const std::uint32_t>& nodes : below) entry_count += nodes.size();
  const std::span<BlockColumn> columns = arena.make<BlockColumn>(count);
  const std::span<BlockEntry> entries = arena.make<BlockEntry>(entry_count);
  std::uint32_t used = 0;
  plan.is_six = true;
  for (std::uint32_t index = 0; index < count; ++index) {
    BlockColumn& column = columns[index];
    column.size = sizes[node_at[index]];
    plan.is_six = plan.is_six && column.size == kMaxBlockRows;
    column.row = plan.rows;
    plan.rows += column.size;
    column.diagonal = plan.values;
    plan.values += column.size * column.size;
    column.begin = used;
    for (const std::uint32_t node : below[index]) entries[used++].index = index_of[node];
    column.end = used;
    const std::span<BlockEntry> own = entries.subspan(column.begin, column.end - column.begin);
    sort_by_index(own);
    std::uint32_t values = 0;
    for (BlockEntry& entry : own) {
      entry.offset = plan.values + values;
      values += column.size * sizes[node_at[entry.index]];
    }
    plan.values += values;
    plan.widest = std::max(plan.widest, values);
  }
  plan.index_of = index_of;
  plan.node_at = node_at;
  plan.columns = columns;
  plan.entries = entries;
  plan.targets = list_targets(columns, entries, arena);
  return true;
}

BlockLocation find_block(const BlockPlan& plan, std::uint32_t a, std::uint32_t b) {
  const std::uint32_t index_a = plan.index_of[a], index_b = plan.index_of[b];
  const BlockColumn& column = plan.columns[std::min(index_a, index_b)];
  const std::uint32_t later = std::max(index_a, index_b);
  for (std::uint32_t i = column.begin; i < column.end; ++i) {
    if (plan.entries[i].index == later) return {plan.entries[i].offset, index_a == later};
  }
  GYRE_ASSERT(false, "the nodes are not neighbours");
  return {};
}

void factor_blocks(const BlockPlan& plan, std::span<double> values, std::span<double> room) {
  if (plan.is_six) return factor_six_blocks(plan, values, room);
  for (const BlockColumn& column : plan.columns) {
    invert(&values[column.diagonal], column.size);
    with_constant(column.size,
                  [&](auto c) { eliminate_column<c()>(plan, column, values.data(), room.data()); });
  }
}

void solve_blocks(const BlockPlan& plan, std::span<const double> values, std::span<double> x) {
  if (plan.is_six) return solve_six_blocks(plan, values, x);
  for (const BlockColumn& column : plan.columns) {
    with_constant(column.size, [&](auto c) { solve_down<c()>(plan, column, values.data(), x.data()); });
  }
  for (std::size_t index = plan.columns.size(); index-- > 0;) {
    const BlockColumn& column = plan.columns[index];
    with_constant(column.size, [&](auto c) { solve_up<c()>(plan, column, values.data(), x.data()); });
  }
}

void solve_blocks_down(const BlockPlan& plan, std::span<const double> values, std::span<double> x,
                       std::span<double> scaled) {
  for (const BlockColumn& column : plan.columns) {
    double* const out = scaled.data() + column.row;
    if (is_zero(x.data() + column.row, column.size)) {
      std::fill(out, out + column.size, 0.0);
      continue;
    }
    with_constant(column.size, [&](auto c) {
      solve_down<c()>(plan, column, values.data(), x.data());
      scale_column<c()>(column, values.data(), x.data() + column.row, out);
    });
  }
}

}  // namespace gyre
