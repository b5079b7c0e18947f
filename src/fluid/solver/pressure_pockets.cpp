// Pockets by a search from cell to cell.
#include "fluid/solver/pressure_pockets.h"

namespace gyre {

namespace {

constexpr std::int32_t kUnseen = -1;

// Marks the cells that are connected to the first one in `queue` and tells whether an open side is among them: a coefficient on a side face of an
// axis that is not periodic.
bool mark_connected(PressureMatrix& matrix, std::int32_t mark, Array<std::int32_t>& queue) {
  const PressureGrid& finest = matrix.levels[0];
  const GridShape& shape = finest.shape;
  bool reaches_outside = false;
  for (std::size_t head = 0; head < queue.size(); ++head) {
    const std::int32_t c = queue[head];
    const int from_first = c - shape.first;
    reaches_outside = reaches_outside || (!finest.ground.empty() && finest.ground[c] > 0.0f);
    const int index[3] = {from_first % shape.plane % shape.pitch, from_first % shape.plane / shape.pitch,
                          from_first / shape.plane};
    for (int side = 0; side < 6; ++side) {
      const int axis = side / 2, last = shape.cells[axis] - 1, stride = shape.stride(axis);
      const bool upper = side % 2 != 0;
      if (!(finest.face[axis][upper ? c + stride : c] > 0.0f)) continue;
      int next = upper ? index[axis] + 1 : index[axis] - 1;
      if (next < 0 || next > last) {
        if (!finest.periodic[axis]) {
          reaches_outside = true;
          continue;
        }
        next = next < 0 ? last : 0;
      }
      const std::int32_t neighbor = c + (next - index[axis]) * stride;
      if (matrix.pocket[neighbor] != kUnseen) continue;
      matrix.pocket[neighbor] = mark;
      queue.push_back(neighbor);
    }
  }
  return reaches_outside;
}

}  // namespace

int find_pockets(PressureMatrix& matrix) {
  const PressureGrid& finest = matrix.levels[0];
  const GridShape& shape = finest.shape;
  matrix.pocket.clear();
  matrix.pocket.resize(std::size_t(shape.size), kUnseen);
  matrix.pocket_is_closed.clear();
  Array<std::int32_t> queue;
  for (int k = 0; k < shape.cells[2]; ++k) {
    for (int j = 0; j < shape.cells[1]; ++j) {
      const int first = shape.row(j, k);
      for (int c = first; c < first + shape.cells[0]; ++c) {
        if (matrix.pocket[c] != kUnseen || !(finest.inverse_diagonal[c] > 0.0f)) continue;
        const auto mark = std::int32_t(matrix.pocket_is_closed.size());
        matrix.pocket[c] = mark;
        queue.clear();
        queue.push_back(c);
        matrix.pocket_is_closed.push_back(mark_connected(matrix, mark, queue) ? 0 : 1);
      }
    }
  }
  return int(matrix.pocket_is_closed.size());
}

void remove_pocket_means(const PressureMatrix& matrix, float* field) {
  const GridShape& shape = matrix.levels[0].shape;
  Array<double> sum;
  Array<std::int32_t> count;
  sum.resize(matrix.pocket_is_closed.size(), 0.0);
  count.resize(matrix.pocket_is_closed.size(), 0);
  const auto for_cells_of_pockets = [&](auto&& fn) {
    for (int row = 0; row < shape.rows(); ++row) {
      const int first = shape.row(row % shape.cells[1], row / shape.cells[1]);
      for (int c = first; c < first + shape.cells[0]; ++c) {
        const std::int32_t pocket = matrix.pocket[c];
        if (pocket >= 0 && matrix.pocket_is_closed[pocket] != 0) fn(c, pocket);
      }
    }
  };
  for_cells_of_pockets([&](int c, std::int32_t pocket) { sum[pocket] += double(field[c]), ++count[pocket]; });
  for_cells_of_pockets(
      [&](int c, std::int32_t pocket) { field[c] -= float(sum[pocket] / double(count[pocket])); });
}

}  // namespace gyre
