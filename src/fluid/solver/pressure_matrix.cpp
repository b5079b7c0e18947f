// Builds the levels of the pressure equation.
#include "fluid/solver/pressure_matrix.h"

#include "task/parallel.h"

namespace gyre {

PressureLevel PressureMatrix::level(int index) const {
  const PressureGrid& grid = levels[index];
  PressureLevel level;
  level.shape = grid.shape;
  for (int axis = 0; axis < 3; ++axis) {
    level.face[axis] = grid.face[axis].data();
    level.halved[axis] = grid.halved[axis];
  }
  level.inverse_diagonal = grid.inverse_diagonal.data();
  level.transfer = grid.transfer.data();
  level.ground = grid.ground.empty() ? nullptr : grid.ground.data();
  level.rows = grid.rows.data();
  return level;
}

namespace {

constexpr int kCoarsest = 2;  // cells along an axis that are not halved

// Rows that are stale, of cells or with those of the last faces.
template <class Fn>
void each_row(const PressureGrid& grid, int rows_y, int rows_z, TaskSystem& tasks, Fn&& fn) {
  const GridShape& shape = grid.shape;
  const std::uint8_t* const stale = grid.stale.data();
  for_blocks(tasks, rows_y * rows_z, kGridRows, [&](int begin, int end, int) {
    for (int row = begin; row < end; ++row) {
      const int k = row / rows_y, j = row - k * rows_y;
      if (stale[j + k * (shape.cells[1] + 1)] != 0) fn(shape.row(j, k), j, k);
    }
  });
}

// A solid changes the matrix, in coarser levels too, at most this many rows away: a cell's transfer depends on cells of the next
// level, and these on their faces.
constexpr int kStaleReach = 3;

// The rows of `from` within the reach of begin to end along each axis that are not zero.
bool any_row(const GridShape& shape, const Array<std::uint8_t>& from, const int (&begin)[2],
             const int (&end)[2]) {
  int low[2], high[2];
  for (int a = 0; a < 2; ++a) {
    low[a] = begin[a] - kStaleReach > 0 ? begin[a] - kStaleReach : 0;
    high[a] = end[a] + kStaleReach < shape.cells[a + 1] ? end[a] + kStaleReach : shape.cells[a + 1];
  }
  for (int k = low[1]; k <= high[1]; ++k)
    for (int j = low[0]; j <= high[0]; ++j)
      if (from[j + k * (shape.cells[1] + 1)] != 0) return true;
  return false;
}

// Rows of the finest level near those that solids cut before or cut now.
void mark_stale(const GridShape& shape, const Array<std::uint8_t>& before, const Array<std::uint8_t>& now,
                PressureGrid& grid) {
  mark_all_stale(grid);
  Array<std::uint8_t> changed;
  changed.resize_uninitialized(now.size());
  for (std::size_t row = 0; row < now.size(); ++row) changed[row] = std::uint8_t(before[row] | now[row]);
  for (int k = 0; k <= shape.cells[2]; ++k)
    for (int j = 0; j <= shape.cells[1]; ++j)
      grid.stale[j + k * (shape.cells[1] + 1)] = any_row(shape, changed, {j, k}, {j, k}) ? 1 : 0;
}

void mark_coarse_stale(const PressureGrid& fine, PressureGrid& coarse) {
  mark_all_stale(coarse);
  int all = 1;
  for (const std::uint8_t one : fine.stale) all &= int(one);
  if (all != 0) return;
  const int scale[2] = {fine.halved[1] ? 2 : 1, fine.halved[2] ? 2 : 1};
  const GridShape& shape = coarse.shape;
  for (int k = 0; k <= shape.cells[2]; ++k) {
    for (int j = 0; j <= shape.cells[1]; ++j) {
      const int begin[2] = {scale[0] * j, scale[1] * k};
      const int end[2] = {begin[0] + scale[0] - 1, begin[1] + scale[1] - 1};
      coarse.stale[j + k * (shape.cells[1] + 1)] = any_row(fine.shape, fine.stale, begin, end) ? 1 : 0;
    }
  }
}

// The faces across one axis of the finest level.
void find_faces(const GasBox& box, const GasSolids& solids, int axis, TaskSystem& tasks, PressureGrid& grid) {
  const GridShape& shape = grid.shape;
  const float edge = axis == 0 ? box.cell.x : axis == 1 ? box.cell.y : box.cell.z;
  const float inner = box.flat(axis) ? 0.0f : 1.0f / (edge * edge);
  const float sides[2] = {box.periodic(axis)   ? inner
                          : box.open(2 * axis) ? 2.0f * inner
                                               : 0.0f,
                          box.periodic(axis)       ? inner
                          : box.open(2 * axis + 1) ? 2.0f * inner
                                                   : 0.0f};
  const int step = shape.stride(axis), last = shape.cells[axis];
  const int extra[3] = {axis == 0 ? 1 : 0, axis == 1 ? 1 : 0, axis == 2 ? 1 : 0};
  float* const to = grid.face[axis].data();
  each_row(grid, shape.cells[1] + extra[1], shape.cells[2] + extra[2], tasks, [&](int c, int j, int k) {
    const int count = shape.cells[0] + extra[0];
    const int across = axis == 1 ? j : k;
    for (int i = 0; i < count; ++i) {
      const int at = axis == 0 ? i : across;
      to[c + i] = at == 0 ? sides[0] : at == last ? sides[1] : inner;
    }
    if (!solids.present()) return;
    const float* const open = solids.open[axis].data();
    const std::uint8_t* const solid = solids.solid.data();
    for (int i = 0; i < count; ++i) {
      const int at = axis == 0 ? i : across;
      const bool lower = at > 0 && solid[c + i - step] != 0, upper = at < last && solid[c + i] != 0;
      const bool closed = lower || upper || !(open[c + i] >= kMinOpen);
      to[c + i] = closed ? 0.0f : open[c + i] < 1.0f ? open[c + i] * to[c + i] : to[c + i];
    }
  });
}

// A face of a coarser level: half of what all finer faces within it have, if it is also twice as far across.
void coarsen_faces(const PressureGrid& fine, int axis, TaskSystem& tasks, PressureGrid& coarse) {
  const GridShape& shape = coarse.shape;
  const int extra[3] = {axis == 0 ? 1 : 0, axis == 1 ? 1 : 0, axis == 2 ? 1 : 0};
  const float scale = fine.halved[axis] ? 0.5f : 1.0f;
  float* const to = coarse.face[axis].data();
  each_row(coarse, shape.cells[1] + extra[1], shape.cells[2] + extra[2], tasks, [&](int c, int j, int k) {
    // The first finer index along each axis and how many there are.
    const auto children = [&](int of, int place, int& begin, int& count) {
      begin = fine.halved[of] ? 2 * place : place;
      const int cells = fine.shape.cells[of];
      if (of == axis) {
        begin = begin < cells ? begin : cells;
        count = 1;
      } else {
        count = fine.halved[of] && begin + 1 < cells ? 2 : 1;
      }
    };
    int y, z, count_y, count_z;
    children(1, j, y, count_y);
    children(2, k, z, count_z);
    for (int i = 0; i < shape.cells[0] + extra[0]; ++i) {
      int x, count_x;
      children(0, i, x, count_x);
      float sum = 0.0f;
      for (int dz = 0; dz < count_z; ++dz) {
        for (int dy = 0; dy < count_y; ++dy) {
          const float* const from = fine.face[axis].data() + fine.shape.at(x, y + dy, z + dz);
          sum += count_x == 2 ? from[0] + from[1] : from[0];
        }
      }
      to[c + i] = scale * sum;
    }
  });
}

// Air, and how strongly cells are tied to it. What a fine cell has is in series with the way from its centre to that of the coarse cell,
// half an edge: two rows of cells at the distance d from the surface become one at d + 1/2.
void coarsen_ground(const PressureGrid& fine, TaskSystem& tasks, PressureGrid& coarse) {
  const GridShape& shape = coarse.shape;
  each_row(coarse, shape.cells[1], shape.cells[2], tasks, [&](int c, int j, int k) {
    const auto children = [&](int axis, int place, int& begin, int& end) {
      begin = fine.halved[axis] ? 2 * place : place;
      end = fine.halved[axis] && begin + 1 < fine.shape.cells[axis] ? begin + 2 : begin + 1;
    };
    int y, y_end, z, z_end;
    children(1, j, y, y_end);
    children(2, k, z, z_end);
    for (int i = 0; i < shape.cells[0]; ++i) {
      int x, x_end;
      children(0, i, x, x_end);
      float sum = 0.0f;
      bool air = false;
      for (int zz = z; zz < z_end; ++zz) {
        for (int yy = y; yy < y_end; ++yy) {
          for (int xx = x; xx < x_end; ++xx) {
            const int at = fine.shape.at(xx, yy, zz);
            const float ground = fine.ground[at];
            air = air || fine.is_air[at] != 0;
            if (!(ground > 0.0f)) continue;
            const float way = 2.0f * fine.full_face;
            sum += way > 0.0f ? ground * way / (ground + way) : ground;
          }
        }
      }
      coarse.ground[c + i] = sum;
      coarse.is_air[c + i] = air ? 1 : 0;
    }
  });
}

// Diagonals. Returns the number of cells that have an equation.
int find_diagonals(TaskSystem& tasks, PressureGrid& grid) {
  const GridShape& shape = grid.shape;
  const float *const ax = grid.face[0].data(), *const ay = grid.face[1].data(),
                     *const az = grid.face[2].data();
  const float* const ground = grid.ground.empty() ? nullptr : grid.ground.data();
  float* const to = grid.inverse_diagonal.data();
  grid.active.resize(std::size_t(shape.rows()), 0);
  each_row(grid, shape.cells[1], shape.cells[2], tasks, [&](int c, int j, int k) {
    int active = 0;
    for (int i = c; i < c + shape.cells[0]; ++i) {
      float diagonal = ax[i] + ax[i + 1] + (ay[i] + ay[i + shape.pitch]) + (az[i] + az[i + shape.plane]);
      if (ground != nullptr) diagonal += ground[i];
      to[i] = diagonal > 0.0f ? 1.0f / diagonal : 0.0f;
      active += diagonal > 0.0f ? 1 : 0;
    }
    grid.active[j + k * shape.cells[1]] = active;
  });
  int active = 0;
  for (const std::int32_t one : grid.active) active += one;
  return active;
}

// transfer: 1 over the sum of the weights with which a cell takes from cells of the coarser level that have an equation, or have none
// because they are air.
void find_transfer(PressureMatrix& matrix, int fine_index, const GasKernels& kernels, TaskSystem& tasks) {
  PressureGrid& fine = matrix.levels[fine_index];
  PressureGrid& coarse = matrix.levels[fine_index + 1];
  for_blocks(tasks, coarse.shape.rows(), kGridRows, [&](int begin, int end, int) {
    for (int row = begin; row < end; ++row) {
      const int c = coarse.shape.row(row % coarse.shape.cells[1], row / coarse.shape.cells[1]);
      for (int i = c; i < c + coarse.shape.cells[0]; ++i)
        coarse.x[i] = coarse.inverse_diagonal[i] > 0.0f || (!coarse.is_air.empty() && coarse.is_air[i] != 0)
                          ? 1.0f
                          : 0.0f;
    }
  });
  wrap_ghosts(coarse.shape, coarse.periodic, coarse.x.data());
  PressureLevel level = matrix.level(fine_index);
  Array<float>& weights = fine.transfer;
  each_row(fine, fine.shape.cells[1], fine.shape.cells[2], tasks, [&](int c, int j, int k) {
    for (int i = c; i < c + fine.shape.cells[0]; ++i) weights[i] = 1.0f;
    // In place: 1 + 1 * weight.
    const int row = j + k * fine.shape.cells[1];
    kernels.prolong(level, coarse.shape, coarse.x.data(), weights.data(), row, row + 1);
    for (int i = c; i < c + fine.shape.cells[0]; ++i) {
      const float weight = weights[i] - 1.0f;
      weights[i] = fine.inverse_diagonal[i] > 0.0f && weight > 0.0f ? 1.0f / weight : 0.0f;
    }
  });
}

void find_cut_rows(const GridShape& shape, const GasSolids& solids, TaskSystem& tasks,
                   PressureMatrix& matrix) {
  matrix.cut_row.clear();
  if (!solids.present()) return;
  matrix.cut_row.resize(std::size_t(shape.rows()), std::uint8_t(0));
  const auto any_below_one = [](const float* open, int count) {
    int any = 0;
    for (int i = 0; i < count; ++i) any |= open[i] < 1.0f ? 1 : 0;
    return any != 0;
  };
  for_blocks(tasks, shape.rows(), kGridRows, [&](int begin, int end, int) {
    for (int row = begin; row < end; ++row) {
      const int k = row / shape.cells[1], j = row - k * shape.cells[1], c = shape.row(j, k);
      if (!solids.may_cut(shape, j, k)) continue;
      bool cut = any_below_one(solids.open[0].data() + c, shape.cells[0] + 1);
      for (int axis = 1; axis < 3; ++axis) {
        const float* const lower = solids.open[axis].data() + c;
        cut = cut || any_below_one(lower, shape.cells[0]) ||
              any_below_one(lower + shape.stride(axis), shape.cells[0]);
      }
      for (int i = c; i < c + shape.cells[0] && !cut; ++i) cut = solids.solid[i] != 0;
      matrix.cut_row[row] = cut ? 1 : 0;
    }
  });
}

bool all_equal(const float* from, int begin, int end) {
  for (int i = begin + 1; i < end; ++i)
    if (from[i] != from[begin]) return false;
  return true;
}

bool all_zero(const float* from, int count) {
  int any = 0;
  for (int i = 0; i < count; ++i) any |= from[i] != 0.0f ? 1 : 0;
  return any == 0;
}

void find_row_kinds(TaskSystem& tasks, PressureGrid& grid) {
  const GridShape& shape = grid.shape;
  const int n = shape.cells[0];
  each_row(grid, shape.cells[1], shape.cells[2], tasks, [&](int c, int j, int k) {
    const bool plain = n > 2 && all_equal(grid.inverse_diagonal.data() + c, 1, n - 1) &&
                       all_equal(grid.face[0].data() + c, 1, n) &&
                       all_equal(grid.face[1].data() + c, 1, n - 1) &&
                       all_equal(grid.face[1].data() + c + shape.pitch, 1, n - 1) &&
                       all_equal(grid.face[2].data() + c, 1, n - 1) &&
                       all_equal(grid.face[2].data() + c + shape.plane, 1, n - 1) &&
                       all_equal(grid.transfer.data() + c, 1, n - 1) &&
                       (grid.ground.empty() || all_equal(grid.ground.data() + c, 1, n - 1));
    const bool empty = all_zero(grid.inverse_diagonal.data() + c, n);
    grid.rows[j + k * shape.cells[1]] = empty   ? PressureRow::empty
                                        : plain ? PressureRow::plain
                                                : PressureRow::mixed;
  });
}

}  // namespace

void build_pressure_matrix(const GasBox& box, const GridShape& shape, const GasSolids& solids,
                           const GasKernels& kernels, TaskSystem& tasks, PressureMatrix& matrix) {
  matrix.singular = !box.any_open();
  matrix.solids_revision = solids.present() ? solids.revision : 0;
  const bool renewed = resize_pressure_level(matrix.levels[0], shape, true, false);
  Array<std::uint8_t> near;
  if (!solids.present()) {
    near.resize(std::size_t(shape.cells[1] + 1) * std::size_t(shape.cells[2] + 1), std::uint8_t(0));
  } else {
    near = solids.near;
  }
  if (renewed || near.empty() || matrix.near.size() != near.size() || box.periodic(1) || box.periodic(2)) {
    mark_all_stale(matrix.levels[0]);
  } else {
    mark_stale(shape, matrix.near, near, matrix.levels[0]);
  }
  matrix.near = static_cast<Array<std::uint8_t>&&>(near);
  for (int axis = 0; axis < 3; ++axis) {
    matrix.levels[0].periodic[axis] = box.periodic(axis) && !box.flat(axis);
    find_faces(box, solids, axis, tasks, matrix.levels[0]);
  }
  find_cut_rows(shape, solids, tasks, matrix);
  build_pressure_levels(kernels, tasks, matrix);
}

void mark_all_stale(PressureGrid& grid) {
  const std::size_t rows = std::size_t(grid.shape.cells[1] + 1) * std::size_t(grid.shape.cells[2] + 1);
  grid.stale.clear();
  grid.stale.resize(rows, std::uint8_t(1));
}

bool resize_pressure_level(PressureGrid& grid, const GridShape& shape, bool finest, bool has_ground) {
  const std::size_t size = std::size_t(shape.size);
  if (grid.inverse_diagonal.size() == size && grid.shape.pitch == shape.pitch &&
      grid.shape.plane == shape.plane && grid.shape.cells[0] == shape.cells[0] &&
      grid.shape.cells[2] == shape.cells[2]) {
    return false;
  }
  const auto renew = [size](Array<float>& field) { field.clear(), field.resize(size, 0.0f); };
  grid.shape = shape;
  for (Array<float>& faces : grid.face) renew(faces);
  renew(grid.inverse_diagonal);
  renew(grid.transfer);
  grid.ground.clear();
  grid.is_air.clear();
  if (has_ground) renew(grid.ground), grid.is_air.resize(size, std::uint8_t(0));
  grid.rows.resize(std::size_t(shape.rows()), PressureRow::mixed);
  if (!finest) renew(grid.b), renew(grid.x), renew(grid.other);
  return true;
}

void build_pressure_levels(const GasKernels& kernels, TaskSystem& tasks, PressureMatrix& matrix) {
  const bool has_ground = !matrix.levels[0].ground.empty();
  matrix.active_cells = find_diagonals(tasks, matrix.levels[0]);
  matrix.count = 1;
  while (matrix.count < PressureMatrix::kMaxLevels) {
    PressureGrid& fine = matrix.levels[matrix.count - 1];
    PressureGrid& coarse = matrix.levels[matrix.count];
    int cells[3];
    bool smaller = false;
    for (int axis = 0; axis < 3; ++axis) {
      const int n = fine.shape.cells[axis];
      // Half a cell at the end of a periodic axis would have no mirror image at its beginning.
      fine.halved[axis] = n > kCoarsest && !(fine.periodic[axis] && n % 2 != 0);
      cells[axis] = fine.halved[axis] ? (n + 1) / 2 : n;
      smaller = smaller || fine.halved[axis];
      coarse.periodic[axis] = fine.periodic[axis];
    }
    if (!smaller) break;
    resize_pressure_level(coarse, make_grid_shape(cells[0], cells[1], cells[2]), false, has_ground);
    mark_coarse_stale(fine, coarse);
    for (int axis = 0; axis < 3; ++axis) coarsen_faces(fine, axis, tasks, coarse);
    if (has_ground) {
      coarsen_ground(fine, tasks, coarse);
      const int halves = (fine.halved[0] ? 1 : 0) + (fine.halved[1] ? 1 : 0) + (fine.halved[2] ? 1 : 0);
      const float growth[4] = {1.0f, 0.5f, 1.0f,
                               2.0f};  // of the faces: twice as many each other axis, twice as far
      coarse.full_face = fine.full_face * growth[halves];
    }
    find_diagonals(tasks, coarse);
    find_transfer(matrix, matrix.count - 1, kernels, tasks);
    ++matrix.count;
  }
  for (int index = 0; index < matrix.count; ++index) find_row_kinds(tasks, matrix.levels[index]);
}

}  // namespace gyre
