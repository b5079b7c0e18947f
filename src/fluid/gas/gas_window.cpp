#include "fluid/gas/gas_window.h"

#include "fluid/solver/gas_pass.h"

namespace gyre {

namespace {

// Of smoke, heat and fuel, less than this share of the largest value does not count. It is a few roundings of a float, so what a window
// that shrinks leaves behind does not change the sum of smoke.
constexpr float kNothing = 1.0e-6f;

// The magnitude of a number as bits, which have the same order. What is not finite is above all others.
inline std::int32_t bits_of(float number) {
  return std::int32_t(__builtin_bit_cast(std::uint32_t, number) & 0x7fffffffu);
}
float share_of(float share, std::int32_t bits) { return share * __builtin_bit_cast(float, bits); }

std::int32_t larger(std::int32_t a, std::int32_t b) { return a > b ? a : b; }

std::int32_t largest_bits(const float* from, int count, float less) {
  std::int32_t most = 0;
  for (int i = 0; i < count; ++i) most = larger(bits_of(from[i] - less), most);
  return most;
}

// Values of a cell that count: the largest of all cells, or limits.
struct CellContents {
  std::int32_t speed[3] = {0, 0, 0}, smoke = 0, heat = 0, fuel = 0;
};

CellContents largest_of(const GasGrid& grid, TaskSystem& tasks) {
  const GridShape& shape = grid.shape;
  const int n = shape.cells[0];
  return reduce_blocks(
      tasks, shape.rows(), kGridRows, CellContents{},
      [&](int begin, int end, int) {
        CellContents most;
        for (int row = begin; row < end; ++row) {
          const int c = shape.row(row % shape.cells[1], row / shape.cells[1]);
          for (int axis = 0; axis < 3; ++axis) {
            const float* const lower = grid.velocity[axis].data() + c;
            const std::int32_t sides[2] = {largest_bits(lower, n, 0.0f),
                                           largest_bits(lower + shape.stride(axis), n, 0.0f)};
            most.speed[axis] = larger(most.speed[axis], larger(sides[0], sides[1]));
          }
          most.smoke = larger(most.smoke, largest_bits(grid.density.data() + c, n, 0.0f));
          most.heat =
              larger(most.heat, largest_bits(grid.temperature.data() + c, n, grid.ambient_temperature));
          if (!grid.fuel.empty()) most.fuel = larger(most.fuel, largest_bits(grid.fuel.data() + c, n, 0.0f));
        }
        return most;
      },
      [](CellContents a, const CellContents& b) {
        for (int axis = 0; axis < 3; ++axis) a.speed[axis] = larger(a.speed[axis], b.speed[axis]);
        a.smoke = larger(a.smoke, b.smoke), a.heat = larger(a.heat, b.heat), a.fuel = larger(a.fuel, b.fuel);
        return a;
      });
}

// True if something is above its limit in one of `count` cells of a row.
bool any_above(const GasGrid& grid, const CellContents& limit, int c, int count) {
  int any = 0;
  const auto look = [&](const float* from, float less, std::int32_t most) {
    for (int i = 0; i < count; ++i) any |= bits_of(from[i] - less) > most ? 1 : 0;
  };
  for (int axis = 0; axis < 3; ++axis) {
    const float* const lower = grid.velocity[axis].data() + c;
    look(lower, 0.0f, limit.speed[axis]);
    look(lower + grid.shape.stride(axis), 0.0f, limit.speed[axis]);
  }
  look(grid.density.data() + c, 0.0f, limit.smoke);
  look(grid.temperature.data() + c, grid.ambient_temperature, limit.heat);
  if (!grid.fuel.empty()) look(grid.fuel.data() + c, 0.0f, limit.fuel);
  return any != 0;
}

CellBox no_cells(const GasBox& whole) {
  CellBox range;
  for (int axis = 0; axis < 3; ++axis) range.low[axis] = whole.cells[axis], range.high[axis] = 0;
  return range;
}

// Cells of the arrays above a limit, in the cells of the whole box.
CellBox cells_above(const GasGrid& grid, const CellContents& limit, TaskSystem& tasks) {
  const GridShape& shape = grid.shape;
  const int n = shape.cells[0];
  return reduce_blocks(
      tasks, shape.rows(), kGridRows, no_cells(grid.whole),
      [&](int begin, int end, int) {
        CellBox range = no_cells(grid.whole);
        for (int row = begin; row < end; ++row) {
          const int j = row % shape.cells[1], k = row / shape.cells[1], c = shape.row(j, k);
          if (!any_above(grid, limit, c, n)) continue;
          int low = 0, high = n;
          while (!any_above(grid, limit, c + low, 1)) ++low;
          while (!any_above(grid, limit, c + high - 1, 1)) --high;
          const int place[3] = {low, j, k}, end_place[3] = {high, j + 1, k + 1};
          CellBox one;
          for (int axis = 0; axis < 3; ++axis)
            one.low[axis] = grid.first(axis) + place[axis],
            one.high[axis] = grid.first(axis) + end_place[axis];
          range.include(one);
        }
        return range;
      },
      [](CellBox a, const CellBox& b) { return a.include(b), a; });
}

// Copies the places that two windows share, of centres (faces = -1) or of the faces across an axis.
void copy_shared(const GasGrid& from, const Array<float>& old, int faces, const GasGrid& to,
                 Array<float>& out) {
  const CellBox a = from.cells(), b = to.cells();
  int low[3], high[3];
  for (int axis = 0; axis < 3; ++axis) {
    low[axis] = a.low[axis] > b.low[axis] ? a.low[axis] : b.low[axis];
    high[axis] = (a.high[axis] < b.high[axis] ? a.high[axis] : b.high[axis]) + (axis == faces ? 1 : 0);
  }
  for (int k = low[2]; k < high[2]; ++k) {
    for (int j = low[1]; j < high[1]; ++j) {
      const float* const source = old.data() + from.shape.row(j - a.low[1], k - a.low[2]) - a.low[0];
      float* const target = out.data() + to.shape.row(j - b.low[1], k - b.low[2]) - b.low[0];
      for (int i = low[0]; i < high[0]; ++i) target[i] = source[i];
    }
  }
}

}  // namespace

bool is_empty(const CellBox& range) { return range.low[0] >= range.high[0]; }

CellBox find_active_cells(const GasGrid& grid, float threshold, float seconds, TaskSystem& tasks) {
  const CellContents most = largest_of(grid, tasks);
  std::int32_t fastest = 0;
  for (const std::int32_t speed : most.speed) fastest = larger(fastest, speed);
  CellContents limit;
  for (std::int32_t& speed : limit.speed) speed = bits_of(share_of(threshold, fastest));
  limit.smoke = bits_of(share_of(kNothing, most.smoke));
  limit.heat = bits_of(share_of(kNothing, most.heat));
  limit.fuel = bits_of(share_of(kNothing, most.fuel));
  CellBox range = cells_above(grid, limit, tasks);
  if (is_empty(range)) return range;
  const float edges[3] = {grid.whole.cell.x, grid.whole.cell.y, grid.whole.cell.z};
  for (int axis = 0; axis < 3; ++axis) {
    const int cells = grid.whole.cells[axis];
    const float way = share_of(seconds / edges[axis], most.speed[axis]);
    const int reach = way < float(cells) ? int(way) + 1 : cells;
    range.low[axis] = range.low[axis] > reach ? range.low[axis] - reach : 0;
    range.high[axis] = range.high[axis] + reach < cells ? range.high[axis] + reach : cells;
  }
  return range;
}

FluidWindow gas_window(const GasBox& whole, const CellBox& range) {
  return window_around(whole, is_empty(range) ? CellBox{} : range);
}

FluidWindow gas_window(const GasGrid& grid) {
  FluidWindow window;
  for (int axis = 0; axis < 3; ++axis) window.first[axis] = grid.first(axis);
  window.box = grid.box, window.shape = grid.shape;
  return window;
}

GasGrid make_gas_grid(const GasBox& whole, const CellBox& range, float ambient_temperature) {
  const FluidWindow window = gas_window(whole, range);
  GasGrid grid = make_gas_grid(window.box, ambient_temperature);
  grid.whole = whole;
  grid.window.push_back(window.cells());
  return grid;
}

void set_gas_window(GasGrid& grid, const FluidWindow& window) {
  if (window.cells() == grid.cells()) return;
  GasGrid to = make_gas_grid(grid.whole, window.cells(), grid.ambient_temperature);
  if (!grid.fuel.empty()) to.fuel.resize(std::size_t(to.shape.size), 0.0f);
  for (int axis = 0; axis < 3; ++axis) copy_shared(grid, grid.velocity[axis], axis, to, to.velocity[axis]);
  copy_shared(grid, grid.density, -1, to, to.density);
  copy_shared(grid, grid.temperature, -1, to, to.temperature);
  copy_shared(grid, grid.pressure, -1, to, to.pressure);
  if (!grid.fuel.empty()) copy_shared(grid, grid.fuel, -1, to, to.fuel);
  // Readings between the last cell of a periodic axis and the first need the ghosts before the next step, too.
  const bool periodic[3] = {grid.whole.periodic(0), grid.whole.periodic(1), grid.whole.periodic(2)};
  for (Array<float>* const field : {&to.density, &to.temperature, &to.pressure})
    wrap_ghosts(to.shape, periodic, field->data());
  if (!to.fuel.empty()) wrap_ghosts(to.shape, periodic, to.fuel.data());
  for (Array<float>& field : to.velocity) wrap_ghosts(to.shape, periodic, field.data());
  grid = static_cast<GasGrid&&>(to);
}

}  // namespace gyre
