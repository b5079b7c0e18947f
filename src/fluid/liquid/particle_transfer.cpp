// Sorting of particles, sums over them on the grid, and their motion.
#include "fluid/liquid/particle_transfer.h"

#include "fluid/liquid/particle_collision.h"

namespace gyre {

namespace {

constexpr int kBlockRows = 4;  // of cells along y and z: a particle reaches no further than the next row
constexpr int kBlockParticles = 1024;  // of particles that a worker takes at a time

void move_column(const LiquidPass& pass, std::size_t left, Array<float>& column) {
  Array<float>& spare = pass.memory.spare;
  const std::int32_t* const place = pass.memory.place.data();
  spare.resize_uninitialized(left);
  for_blocks(pass.tasks, int(column.size()), kBlockParticles, [&](int begin, int end, int) {
    const float* const from = column.data();
    float* const to = spare.data();
    for (int p = begin; p < end; ++p)
      if (place[p] >= 0) to[place[p]] = from[p];
  });
  Array<float> swapped = static_cast<Array<float>&&>(column);
  column = static_cast<Array<float>&&>(spare);
  spare = static_cast<Array<float>&&>(swapped);
}

// Calls fn(begin, end) with the particles of each row of cells, so that no two calls at a time are for neighbours.
template <class Fn>
void for_particle_rows(const LiquidPass& pass, Fn&& fn) {
  const GridShape& shape = pass.shape();
  const std::int32_t* const start = pass.memory.start.data();
  const int blocks_y = count_blocks(shape.cells[1], kBlockRows),
            blocks_z = count_blocks(shape.cells[2], kBlockRows);
  for (int color = 0; color < 4; ++color) {
    const int odd_y = color & 1, odd_z = color >> 1;
    const int count_y = (blocks_y - odd_y + 1) / 2, count_z = (blocks_z - odd_z + 1) / 2;
    for_blocks(pass.tasks, count_y * count_z, 1, [&](int block, int, int) {
      const int first_y = kBlockRows * (2 * (block % count_y) + odd_y);
      const int first_z = kBlockRows * (2 * (block / count_y) + odd_z);
      for (int k = first_z; k < first_z + kBlockRows && k < shape.cells[2]; ++k) {
        for (int j = first_y; j < first_y + kBlockRows && j < shape.cells[1]; ++j) {
          const int row = (j + k * shape.cells[1]) * shape.cells[0];
          fn(start[row], start[row + shape.cells[0]]);
        }
      }
    });
  }
}

// Adds what lies in the ghosts of periodic axes to the cells it belongs to. `faces`: the axis of the faces, -1: centres; `numbers` at each.
void fold_ghosts(const LiquidPass& pass, int faces, int numbers, float* field) {
  const GridShape& shape = pass.shape();
  for (int axis = 0; axis < 3; ++axis) {
    if (!pass.wraps(axis)) continue;
    const int a = (axis + 1) % 3, b = (axis + 2) % 3, n = shape.cells[axis];
    for (int j = -1; j <= shape.cells[b]; ++j) {
      for (int i = -1; i <= shape.cells[a]; ++i) {
        const int c = shape.first + i * shape.stride(a) + j * shape.stride(b);
        for (int number = 0; number < numbers; ++number) {
          const auto at = [&](int cell) -> float& {
            return field[std::ptrdiff_t(c + cell * shape.stride(axis)) * numbers + number];
          };
          at(0) += at(n);
          if (axis == faces) {
            at(n) = at(0);
          } else {
            at(n - 1) += at(-1);
          }
        }
      }
    }
  }
}

ParticlePass particle_pass(const LiquidPass& pass) {
  ParticlePass result;
  LiquidGrid& grid = pass.grid;
  const FluidWindow& window = pass.memory.window;
  result.shape = window.shape;
  for (int axis = 0; axis < 3; ++axis) {
    result.axes[axis] = particle_axis(grid.box, axis, window.first[axis], window.box.cells[axis]);
    result.shape.first -= window.first[axis] * window.shape.stride(axis);
    result.position[axis] = grid.position[axis].data();
    result.motion[axis] = grid.motion[axis].data();
  }
  for (int i = 0; i < 9; ++i) result.affine[i] = grid.affine[i].data();
  result.volume = grid.volume.data();
  result.filled = pass.memory.filled.data();
  return result;
}

void find_wet_row(const LiquidCell* cell, int py, int pz, int count, std::uint8_t* wet) {
  for (int c = 0; c < count; ++c) {
    int any = 0;
    for (const int row : {0, py, pz, py + pz}) {
      any |= cell[c + row] == LiquidCell::liquid ? 1 : 0;
      any |= cell[c + row + 1] == LiquidCell::liquid ? 1 : 0;
    }
    wet[c] = std::uint8_t(any);
  }
}

// True if no particle adds to the faces of a row.
bool has_no_particles(const LiquidPass& pass, int j, int k) {
  if (pass.wraps(1) || pass.wraps(2)) return false;
  const GridShape& shape = pass.shape();
  const std::int32_t* const start = pass.memory.start.data();
  for (int z = k > 0 ? k - 1 : 0; z <= k + 1 && z < shape.cells[2]; ++z) {
    for (int y = j > 0 ? j - 1 : 0; y <= j + 1 && y < shape.cells[1]; ++y) {
      const int row = (y + z * shape.cells[1]) * shape.cells[0];
      if (start[row] != start[row + shape.cells[0]]) return false;
    }
  }
  return true;
}

// Centres around which something is liquid.
void find_wet(const LiquidPass& pass) {
  const GridShape& shape = pass.shape();
  pass.memory.wet.resize(std::size_t(shape.size), std::uint8_t(0));
  for_blocks(pass.tasks, (shape.cells[1] + 1) * (shape.cells[2] + 1), kGridRows,
             [&](int begin, int end, int) {
               for (int row = begin; row < end; ++row) {
                 const int k = row / (shape.cells[1] + 1) - 1, j = row % (shape.cells[1] + 1) - 1;
                 find_wet_row(pass.memory.cell.data() + shape.at(-1, j, k), shape.pitch, shape.plane,
                              shape.cells[0] + 1, pass.memory.wet.data() + shape.at(-1, j, k));
               }
             });
}

}  // namespace

void sort_particles(const LiquidPass& pass) {
  LiquidGrid& grid = pass.grid;
  const int count = grid.particles(), cells = pass.shape().count();
  const ParticlePass work = particle_pass(pass);
  Array<std::int32_t>& place = pass.memory.place;
  Array<std::int32_t>& start = pass.memory.start;
  place.resize_uninitialized(std::size_t(count));
  for_blocks(pass.tasks, count, kBlockParticles,
             [&](int begin, int end, int) { pass.kernels.find_cells(work, begin, end, place.data()); });
  start.clear();
  start.resize(std::size_t(cells) + 1, 0);
  for (const std::int32_t key : place)
    if (key >= 0) ++start[key];
  std::int32_t sum = 0;
  for (std::int32_t& one : start) {
    const std::int32_t here = one;
    one = sum;
    sum += here;
  }
  bool sorted = sum == count;
  for (int p = 0; p < count; ++p) {
    const std::int32_t key = place[p];
    if (key < 0) continue;
    place[p] = start[key]++;
    sorted = sorted && place[p] == p;
  }
  // Each start has become the next one.
  for (int cell = cells; cell > 0; --cell) start[cell] = start[cell - 1];
  start[0] = 0;
  if (sorted) return;
  for (int axis = 0; axis < 3; ++axis) {
    move_column(pass, std::size_t(sum), grid.position[axis]);
    move_column(pass, std::size_t(sum), grid.motion[axis]);
  }
  for (Array<float>& column : grid.affine) move_column(pass, std::size_t(sum), column);
  move_column(pass, std::size_t(sum), grid.volume);
}

void find_filled(const LiquidPass& pass) {
  for (float& one : pass.memory.filled) one = 0.0f;
  const ParticlePass work = particle_pass(pass);
  for_particle_rows(pass, [&](int begin, int end) { pass.kernels.add_particles(work, begin, end); });
  fold_ghosts(pass, -1, 1, pass.memory.filled.data());
}

void transfer_to_grid(const LiquidPass& pass) {
  LiquidGrid& grid = pass.grid;
  ParticlePass work = particle_pass(pass);
  float* sums[3] = {};
  for (int axis = 0; axis < 3; ++axis) {
    if (pass.flat(axis)) continue;
    pass.memory.sums[axis].clear();
    pass.memory.sums[axis].resize(2 * std::size_t(pass.shape().size), 0.0f);
    work.sums[axis] = sums[axis] = pass.memory.sums[axis].data();
  }
  for (float& one : pass.memory.filled) one = 0.0f;
  for_particle_rows(pass, [&](int begin, int end) { pass.kernels.add_particles(work, begin, end); });
  float* const filled = pass.memory.filled.data();
  fold_ghosts(pass, -1, 1, filled);
  for (int axis = 0; axis < 3; ++axis) {
    if (pass.flat(axis)) continue;
    fold_ghosts(pass, axis, 2, sums[axis]);
    float* const velocity = pass.memory.velocity[axis].data();
    const float least = 1.0e-6f * particle_volume(grid.box);
    each_row(pass, axis, [&](int c, int j, int k) {
      const int end = c + pass.shape().cells[0] + (axis == 0 ? 1 : 0);
      if (has_no_particles(pass, j, k)) {
        for (int f = c; f < end; ++f) velocity[f] = 0.0f;
        return;
      }
      for (int f = c; f < end; ++f) {
        const float volume = sums[axis][2 * f];
        velocity[f] = volume > least ? sums[axis][2 * f + 1] / volume : 0.0f;
      }
    });
  }
}

void move_particles(const LiquidPass& pass, float blend, Vec3 gravity) {
  LiquidGrid& grid = pass.grid;
  find_wet(pass);
  ParticlePass work = particle_pass(pass);
  for (int axis = 0; axis < 3; ++axis) {
    if (pass.flat(axis)) continue;
    work.velocity[axis] = pass.memory.velocity[axis].data();
    work.carrier[axis] = pass.memory.drift[axis].data();
    if (blend < 1.0f) work.before[axis] = pass.memory.before[axis].data();
    work.fall[axis] = part_along(gravity, axis) * pass.step;
  }
  work.wet = pass.memory.wet.data();
  work.step = pass.step;
  work.blend = blend;
  work.finishes = !pass.solids.present();
  if (work.finishes) {
    for (int axis = 0; axis < 3; ++axis) work.to[axis] = grid.position[axis].data();
    for_blocks(pass.tasks, grid.particles(), kBlockParticles,
               [&](int begin, int end, int) { pass.kernels.move_particles(work, begin, end); });
    return;
  }
  const ParticleCollision collision(pass);
  for_blocks(pass.tasks, grid.particles(), kBlockParticles, [&](int begin, int end, int) {
    float moved[3][kBlockParticles];
    ParticlePass block = work;
    for (int axis = 0; axis < 3; ++axis) block.to[axis] = moved[axis];
    block.to_begin = begin;
    pass.kernels.move_particles(block, begin, end);
    for (int p = begin; p < end; ++p) {
      const float from[3] = {grid.position[0][p], grid.position[1][p], grid.position[2][p]};
      float to[3];
      for (int axis = 0; axis < 3; ++axis) to[axis] = pass.flat(axis) ? from[axis] : moved[axis][p - begin];
      collision.finish(p, from, to);
    }
  });
}

}  // namespace gyre
