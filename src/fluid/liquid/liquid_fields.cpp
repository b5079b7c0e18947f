// The fields of a step of a liquid.
#include "fluid/liquid/liquid_fields.h"

#include <cstring>

namespace gyre {

namespace {

struct ParticleBounds {
  float low[3] = {1.0e30f, 1.0e30f, 1.0e30f}, high[3] = {-1.0e30f, -1.0e30f, -1.0e30f};

  void include(int axis, float at) {
    low[axis] = at < low[axis] ? at : low[axis];
    high[axis] = at > high[axis] ? at : high[axis];
  }
  void include(const ParticleBounds& other) {
    for (int axis = 0; axis < 3; ++axis) {
      low[axis] = other.low[axis] < low[axis] ? other.low[axis] : low[axis];
      high[axis] = other.high[axis] > high[axis] ? other.high[axis] : high[axis];
    }
  }
};

// Calls fn(place in the state, place in the window, count) for rows of points of a window, in the state with the ghosts at the sides of the box that
// the window reaches.
template <class Fn>
void each_stored_row(const LiquidGrid& grid, const FluidWindow& window, Fn&& fn) {
  int low[3], high[3];
  for (int axis = 0; axis < 3; ++axis) {
    const int n = window.box.cells[axis];
    low[axis] = window.first[axis] == 0 ? -1 : 0;
    high[axis] = window.first[axis] + n == grid.box.cells[axis] ? n : n - 1;
  }
  for (int k = low[2]; k <= high[2]; ++k) {
    for (int j = low[1]; j <= high[1]; ++j) {
      const int to = grid.shape.at(window.first[0] + low[0], window.first[1] + j, window.first[2] + k);
      fn(to, window.shape.at(low[0], j, k), high[0] - low[0] + 1);
    }
  }
}

}  // namespace

CellBox cells_of_particles(const LiquidGrid& grid, float ahead, TaskSystem& tasks) {
  constexpr int kBlock = 4096;
  const ParticleBounds bounds = reduce_blocks(
      tasks, grid.particles(), kBlock, ParticleBounds{},
      [&](int begin, int end, int) {
        ParticleBounds part;
        for (int axis = 0; axis < 3; ++axis) {
          const float *const position = grid.position[axis].data(), *const motion = grid.motion[axis].data();
          for (int p = begin; p < end; ++p) {
            part.include(axis, position[p]);
            part.include(axis, position[p] + ahead * motion[p]);
          }
        }
        return part;
      },
      [](ParticleBounds all, const ParticleBounds& part) {
        all.include(part);
        return all;
      });
  if (!(bounds.low[0] <= bounds.high[0])) return {};
  const Vec3 low{bounds.low[0], bounds.low[1], bounds.low[2]},
      high{bounds.high[0], bounds.high[1], bounds.high[2]};
  return cells_of(grid.box, low, high);
}

FluidWindow find_window(const LiquidGrid& grid, CellBox cells, std::span<const FluidBody> bodies,
                        std::span<const LiquidEmitter> emitters, double time) {
  const GasBox& box = grid.box;
  bool any = grid.particles() > 0;
  for (const LiquidEmitter& emitter : emitters) {
    if (!(time >= emitter.start && time < emitter.end)) continue;
    const Vec3 center = difference(emitter.position, box.corner);
    const Vec3 reach{emitter.radius, emitter.radius, emitter.radius};
    const CellBox ball = cells_of(box, center - reach, center + reach);
    if (any)
      cells.include(ball);
    else
      cells = ball;
    any = true;
  }
  if (!any) return window_around(box, {});
  const CellBox liquid = with_margin(box, cells);
  CellBox all = liquid;
  for (const FluidBody& body : bodies) {
    if (!(body.inverse_mass > 0.0f)) continue;
    if (!body.has_bounds) return whole_window(box);
    const CellBox own = cells_of(box, difference(DVec3(body.bounds.low), box.corner) - box.cell,
                                 difference(DVec3(body.bounds.high), box.corner) + box.cell);
    if (liquid.overlaps(own)) all.include(own);
  }
  return window_around(box, all);
}

void begin_fields(const LiquidPass& pass) {
  const std::size_t size = std::size_t(pass.shape().size);
  LiquidMemory& memory = pass.memory;
  const PressureGrid& finest = memory.matrix.levels[0];
  const bool same_cells = finest.shape.cells[0] == pass.shape().cells[0] &&
                          finest.shape.cells[1] == pass.shape().cells[1] &&
                          finest.shape.cells[2] == pass.shape().cells[2];
  if (memory.filled.size() != size || memory.cell.size() != size || !same_cells) {
    const auto renew = [size](Array<float>& field) { field.clear(), field.resize(size, 0.0f); };
    for (Array<float>& field : memory.field) renew(field);
    renew(memory.filled);
    renew(memory.surface);
    renew(memory.pressure);
    for (int axis = 0; axis < 3; ++axis) {
      renew(memory.velocity[axis]);
      renew(memory.drift[axis]);
      renew(memory.before[axis]);
      renew(memory.open[axis]);
      renew(memory.steepness[axis]);
    }
    memory.blocked.clear();
    memory.blocked.resize(size, std::uint8_t(0));
    memory.cell.clear();
    memory.cell.resize(size, LiquidCell::solid);
    memory.matrix = PressureMatrix{};
    memory.has_open = false;
  }
  each_stored_row(pass.grid, memory.window, [&](int from, int to, int count) {
    std::memcpy(memory.pressure.data() + to, pass.grid.pressure.data() + from,
                std::size_t(count) * sizeof(float));
  });
}

void store_fields(const LiquidPass& pass) {
  LiquidGrid& grid = pass.grid;
  LiquidMemory& memory = pass.memory;
  const FluidWindow whole = whole_window(grid.box);
  each_stored_row(grid, memory.has_stored ? memory.stored : whole, [&](int to, int, int count) {
    for (Array<float>& faces : grid.velocity)
      std::memset(faces.data() + to, 0, std::size_t(count) * sizeof(float));
    std::memset(grid.pressure.data() + to, 0, std::size_t(count) * sizeof(float));
    float* const surface = grid.surface.data() + to;
    for (int i = 0; i < count; ++i) surface[i] = grid.box.cell.x;
  });
  each_stored_row(grid, memory.window, [&](int to, int from, int count) {
    const auto copy = [&](const Array<float>& field, Array<float>& state) {
      std::memcpy(state.data() + to, field.data() + from, std::size_t(count) * sizeof(float));
    };
    for (int axis = 0; axis < 3; ++axis) copy(memory.velocity[axis], grid.velocity[axis]);
    copy(memory.surface, grid.surface);
    copy(memory.pressure, grid.pressure);
  });
  memory.stored = memory.window;
  memory.has_stored = true;
}

}  // namespace gyre
