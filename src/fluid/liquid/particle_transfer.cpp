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

// The cell of a particle in the order of rows, -1: it has left.
int find_key(const LiquidGrid& grid, const AxisPlaces (&axes)[3], int p) {
  int index[3];
  for (int axis = 0; axis < 3; ++axis) {
    const float at = grid.position[axis][p], speed = grid.motion[axis][p];
    const int n = grid.box.cells[axis];
    if (!(at >= 0.0f && at <= float(n) * axes[axis].edge) || !is_finite(speed)) return -1;
    const int i = int(at * axes[axis].inverse_edge);
    index[axis] = i < n ? i : n - 1;
  }
  return index[0] + grid.box.cells[0] * (index[1] + grid.box.cells[1] * index[2]);
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
    const int span = n * shape.stride(axis);
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
    (void)span;
  }
}

void prepare_axes(const GasBox& box, AxisPlaces (&axes)[3]) {
  for (int axis = 0; axis < 3; ++axis) axes[axis] = AxisPlaces(box, axis);
}

// The places of a particle between faces and between centres along every axis.
struct ParticlePlaces {
  AxisPlace face[3], center[3];
  ParticlePlaces(const AxisPlaces (&axes)[3], const float (&at)[3]) {
    for (int axis = 0; axis < 3; ++axis) {
      face[axis] = axes[axis].face(at[axis]);
      center[axis] = axes[axis].center(at[axis]);
    }
  }
  AxisPlace of(int component, int axis) const { return component == axis ? face[axis] : center[axis]; }
};

int index_of(const GridShape& shape, AxisPlace x, AxisPlace y, AxisPlace z) {
  return shape.at(x.base, y.base, z.base);
}

void add_particle_to_faces(const LiquidGrid& grid, const AxisPlaces (&axes)[3], const ParticlePlaces& places,
                           int component, int p, float* sums) {
  const GridShape& shape = grid.shape;
  const AxisPlace x = places.of(component, 0), y = places.of(component, 1), z = places.of(component, 2);
  const float volume = grid.volume[p], speed = grid.motion[component][p];
  const float slope_x = grid.affine[3 * component][p], slope_y = grid.affine[3 * component + 1][p],
              slope_z = grid.affine[3 * component + 2][p];
  const float left = slope_x * (-x.fraction * axes[0].edge),
              right = slope_x * ((1.0f - x.fraction) * axes[0].edge);
  const int index = index_of(shape, x, y, z);
  for (int up_z = 0; up_z < 2; ++up_z) {
    const float weight_z = up_z != 0 ? z.fraction : 1.0f - z.fraction;
    const float offset_z = (float(up_z) - z.fraction) * axes[2].edge;
    for (int up_y = 0; up_y < 2; ++up_y) {
      const float weight_y = up_y != 0 ? y.fraction : 1.0f - y.fraction;
      const float offset_y = (float(up_y) - y.fraction) * axes[1].edge;
      const float weight = volume * (weight_y * weight_z);
      const float u = speed + (slope_y * offset_y + slope_z * offset_z);
      const float w0 = weight * (1.0f - x.fraction), w1 = weight * x.fraction;
      float* const to = sums + 2 * (index + up_y * shape.pitch + up_z * shape.plane);
      to[0] += w0;
      to[1] += w0 * (u + left);
      to[2] += w1;
      to[3] += w1 * (u + right);
    }
  }
}

void add_particle_to_centers(const GridShape& shape, const ParticlePlaces& places, float volume,
                             float* filled) {
  const AxisPlace &x = places.center[0], &y = places.center[1], &z = places.center[2];
  const int index = index_of(shape, x, y, z);
  for (int up_z = 0; up_z < 2; ++up_z) {
    const float weight_z = up_z != 0 ? z.fraction : 1.0f - z.fraction;
    for (int up_y = 0; up_y < 2; ++up_y) {
      const float weight = volume * ((up_y != 0 ? y.fraction : 1.0f - y.fraction) * weight_z);
      float* const to = filled + index + up_y * shape.pitch + up_z * shape.plane;
      to[0] += weight * (1.0f - x.fraction);
      to[1] += weight * x.fraction;
    }
  }
}

// A value of faces at a particle, with its slopes.
struct FaceSample {
  float value;
  float slope[3];
};
FaceSample sample_faces(const GridShape& shape, const AxisPlaces (&axes)[3], const ParticlePlaces& places,
                        int component, const float* faces) {
  const AxisPlace x = places.of(component, 0), y = places.of(component, 1), z = places.of(component, 2);
  const float* const at = faces + index_of(shape, x, y, z);
  const int py = shape.pitch, pz = shape.plane;
  const auto mix = [](float a, float b, float t) { return a + t * (b - a); };
  const float x00 = mix(at[0], at[1], x.fraction), x10 = mix(at[py], at[py + 1], x.fraction);
  const float x01 = mix(at[pz], at[pz + 1], x.fraction), x11 = mix(at[py + pz], at[py + pz + 1], x.fraction);
  const float d0 = mix(at[1] - at[0], at[py + 1] - at[py], y.fraction);
  const float d1 = mix(at[pz + 1] - at[pz], at[py + pz + 1] - at[py + pz], y.fraction);
  const float y0 = mix(x00, x10, y.fraction), y1 = mix(x01, x11, y.fraction);
  FaceSample sample;
  sample.value = mix(y0, y1, z.fraction);
  sample.slope[0] = mix(d0, d1, z.fraction) * axes[0].inverse_edge;
  sample.slope[1] = mix(x10 - x00, x11 - x01, z.fraction) * axes[1].inverse_edge;
  sample.slope[2] = (y1 - y0) * axes[2].inverse_edge;
  return sample;
}
float sample_value(const GridShape& shape, const ParticlePlaces& places, int component, const float* faces) {
  const AxisPlace x = places.of(component, 0), y = places.of(component, 1), z = places.of(component, 2);
  const float* const at = faces + index_of(shape, x, y, z);
  const int py = shape.pitch, pz = shape.plane;
  const auto mix = [](float a, float b, float t) { return a + t * (b - a); };
  return mix(
      mix(mix(at[0], at[1], x.fraction), mix(at[py], at[py + 1], x.fraction), y.fraction),
      mix(mix(at[pz], at[pz + 1], x.fraction), mix(at[py + pz], at[py + pz + 1], x.fraction), y.fraction),
      z.fraction);
}

// True if none of the eight centres around a particle is liquid.
bool is_spray(const GridShape& shape, const ParticlePlaces& places, const LiquidCell* cell) {
  const LiquidCell* const at = cell + index_of(shape, places.center[0], places.center[1], places.center[2]);
  const int py = shape.pitch, pz = shape.plane;
  const auto wet = [&](int offset) {
    return at[offset] == LiquidCell::liquid || at[offset + 1] == LiquidCell::liquid;
  };
  return !wet(0) && !wet(py) && !wet(pz) && !wet(py + pz);
}

}  // namespace

void sort_particles(const LiquidPass& pass) {
  LiquidGrid& grid = pass.grid;
  const int count = grid.particles(), cells = grid.shape.count();
  AxisPlaces axes[3];
  prepare_axes(grid.box, axes);
  Array<std::int32_t>& place = pass.memory.place;
  Array<std::int32_t>& start = pass.memory.start;
  place.resize_uninitialized(std::size_t(count));
  for_blocks(pass.tasks, count, kBlockParticles, [&](int begin, int end, int) {
    for (int p = begin; p < end; ++p) place[p] = find_key(grid, axes, p);
  });
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
  const LiquidGrid& grid = pass.grid;
  AxisPlaces axes[3];
  prepare_axes(grid.box, axes);
  float* const filled = pass.memory.filled.data();
  for (float& one : pass.memory.filled) one = 0.0f;
  for_particle_rows(pass, [&](int begin, int end) {
    for (int p = begin; p < end; ++p) {
      const float at[3] = {grid.position[0][p], grid.position[1][p], grid.position[2][p]};
      add_particle_to_centers(grid.shape, ParticlePlaces(axes, at), grid.volume[p], filled);
    }
  });
  fold_ghosts(pass, -1, 1, filled);
}

void transfer_to_grid(const LiquidPass& pass) {
  LiquidGrid& grid = pass.grid;
  AxisPlaces axes[3];
  prepare_axes(grid.box, axes);
  float* sums[3];
  for (int axis = 0; axis < 3; ++axis) {
    pass.memory.sums[axis].clear();
    pass.memory.sums[axis].resize(2 * std::size_t(grid.shape.size), 0.0f);
    sums[axis] = pass.memory.sums[axis].data();
  }
  float* const filled = pass.memory.filled.data();
  for (float& one : pass.memory.filled) one = 0.0f;
  for_particle_rows(pass, [&](int begin, int end) {
    for (int p = begin; p < end; ++p) {
      const float at[3] = {grid.position[0][p], grid.position[1][p], grid.position[2][p]};
      const ParticlePlaces places(axes, at);
      for (int axis = 0; axis < 3; ++axis)
        if (!pass.flat(axis)) add_particle_to_faces(grid, axes, places, axis, p, sums[axis]);
      add_particle_to_centers(grid.shape, places, grid.volume[p], filled);
    }
  });
  fold_ghosts(pass, -1, 1, filled);
  for (int axis = 0; axis < 3; ++axis) {
    if (pass.flat(axis)) continue;
    fold_ghosts(pass, axis, 2, sums[axis]);
    float* const velocity = grid.velocity[axis].data();
    const float least = 1.0e-6f * particle_volume(grid.box);
    each_row(pass, axis, [&](int c, int, int) {
      for (int f = c; f < c + grid.shape.cells[0] + (axis == 0 ? 1 : 0); ++f) {
        const float volume = sums[axis][2 * f];
        velocity[f] = volume > least ? sums[axis][2 * f + 1] / volume : 0.0f;
      }
    });
  }
}

void move_particles(const LiquidPass& pass, float blend, Vec3 gravity) {
  LiquidGrid& grid = pass.grid;
  const GridShape& shape = grid.shape;
  AxisPlaces axes[3];
  prepare_axes(grid.box, axes);
  const LiquidCell* const cell = pass.memory.cell.data();
  const float* velocity[3];
  const float* carrier[3];
  for (int axis = 0; axis < 3; ++axis) {
    velocity[axis] = grid.velocity[axis].data();
    carrier[axis] = pass.memory.drift[axis].data();
  }
  const float fall[3] = {gravity.x * pass.step, gravity.y * pass.step, gravity.z * pass.step};
  const ParticleCollision collision(pass);
  for_blocks(pass.tasks, grid.particles(), kBlockParticles, [&](int begin, int end, int) {
    for (int p = begin; p < end; ++p) {
      const float at[3] = {grid.position[0][p], grid.position[1][p], grid.position[2][p]};
      float to[3] = {at[0], at[1], at[2]};
      const ParticlePlaces places(axes, at);
      if (is_spray(shape, places, cell)) {
        for (int axis = 0; axis < 3; ++axis) {
          if (pass.flat(axis)) continue;
          grid.motion[axis][p] += fall[axis];
          to[axis] = at[axis] + pass.step * grid.motion[axis][p];
        }
        for (Array<float>& one : grid.affine) one[p] = 0.0f;
      } else {
        float middle[3] = {at[0], at[1], at[2]};
        for (int axis = 0; axis < 3; ++axis) {
          if (pass.flat(axis)) continue;
          const FaceSample sample = sample_faces(shape, axes, places, axis, velocity[axis]);
          middle[axis] = at[axis] + 0.5f * pass.step * sample.value;
          float kept = sample.value;
          if (blend < 1.0f) {
            const float old = sample_value(shape, places, axis, pass.memory.before[axis].data());
            kept = blend * sample.value + (1.0f - blend) * (grid.motion[axis][p] + (sample.value - old));
          }
          grid.motion[axis][p] = kept;
          for (int b = 0; b < 3; ++b) grid.affine[3 * axis + b][p] = pass.flat(b) ? 0.0f : sample.slope[b];
        }
        collision.keep_inside(middle);
        const ParticlePlaces halfway(axes, middle);
        for (int axis = 0; axis < 3; ++axis) {
          if (!pass.flat(axis))
            to[axis] = at[axis] + pass.step * sample_value(shape, halfway, axis, carrier[axis]);
        }
      }
      collision.finish(p, at, to);
    }
  });
}

}  // namespace gyre
