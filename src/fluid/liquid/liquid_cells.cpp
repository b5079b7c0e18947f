// Cells, surface and matrix of a liquid.
#include "fluid/liquid/liquid_cells.h"

#include "fluid/solver/pressure_pockets.h"

#include <cmath>
#include <cstring>

namespace gyre {

namespace {

// A surface closer to a liquid's centre than this counts as this far off, in edges: the coefficient of the face stays below 50 times that of
// others, which keeps the digits of a float, and the level of a resting surface changes by at most this.
constexpr float kMinTheta = 0.02f;
// A cell by a solid counts as if at least this share of the room around it were open: particles are too coarse to fill less evenly.
constexpr float kMinRoom = 0.3f;

// The share of each cell that solids leave, from the distance of its centre; without distances, from its faces. Particles, which keep a distance
// from solids, lie closer together beside them, so that a solid lifts the level by its own volume alone.
void find_room(const LiquidPass& pass, float* room) {
  const GridShape& shape = pass.shape();
  const GasSolids& solids = pass.solids;
  const float* const distance = solids.distance.empty() ? nullptr : solids.distance.data();
  const float inverse = 1.0f / pass.edge(0);
  each_row(pass, -1, [&](int c, int, int) {
    for (int i = c; i < c + shape.cells[0]; ++i) {
      float share = 0.0f;
      if (distance != nullptr) {
        share = 0.5f + distance[i] * inverse;
      } else if (solids.solid[i] == 0) {
        for (int axis = 0; axis < 3; ++axis)
          share += solids.open[axis][i] + solids.open[axis][i + shape.stride(axis)];
        share *= 1.0f / 6.0f;
      }
      room[i] = share > 0.0f ? share < 1.0f ? share : 1.0f : 0.0f;
    }
  });
}

// to = 1/8, 3/4, 1/8 of from along an axis: the parts of the linear weights that lie in the three cells.
void blur(const LiquidPass& pass, int axis, float* from, float* to) {
  const GridShape& shape = pass.shape();
  fill_ghosts(pass.box(), shape, from);
  const int step = shape.stride(axis);
  const bool flat = pass.flat(axis);
  each_row(pass, -1, [&](int c, int, int) {
    for (int i = c; i < c + shape.cells[0]; ++i)
      to[i] = flat ? from[i] : 0.75f * from[i] + 0.125f * (from[i - step] + from[i + step]);
  });
}

// Ghosts beyond walls are solid.
void fill_cell_ghosts(const LiquidPass& pass, LiquidCell* cell) {
  const GridShape& shape = pass.shape();
  for (int axis = 0; axis < 3; ++axis) {
    const int a = (axis + 1) % 3, b = (axis + 2) % 3, n = shape.cells[axis], stride = shape.stride(axis);
    for (int j = -1; j <= shape.cells[b]; ++j) {
      for (int i = -1; i <= shape.cells[a]; ++i) {
        LiquidCell* const line = cell + shape.first + i * shape.stride(a) + j * shape.stride(b);
        line[-stride] = line[n * stride] = LiquidCell::solid;
      }
    }
  }
  wrap_points(pass, cell);
}

bool are_all_above(const float* from, int count, float bound) {
  int below = 0;
  for (int i = 0; i < count; ++i) below |= from[i] > bound ? 0 : 1;
  return below == 0;
}

// Cells without room for liquid; their faces are closed. With distances they are those in solids that have no open face to a cell outside, since
// nothing says whether they are liquid, and those between two cells outside: liquid on either side of a thin wall must not share a pressure
// within it. Where a body nears a wall by less than a cell, the former would be air without pressure, which draws in particles for ever.
// Without distances they are all cells in solids.
void block_cells(const LiquidPass& pass) {
  const GridShape& shape = pass.shape();
  const GasSolids& solids = pass.solids;
  std::uint8_t* const blocked = pass.memory.blocked.data();
  const bool has_distance = !solids.distance.empty();
  each_row(pass, -1, [&](int c, int j, int k) {
    if (has_distance && are_all_above(solids.distance.data() + c, shape.cells[0], 0.0f)) {
      std::memset(blocked + c, 0, std::size_t(shape.cells[0]));
      return;
    }
    for (int i = 0; i < shape.cells[0]; ++i) {
      const int at = c + i, index[3] = {i, j, k};
      bool block = solids.solid[at] != 0;
      if (has_distance) {
        bool any = false, thin = false;
        for (int axis = 0; axis < 3; ++axis) {
          const float* const open = pass.memory.open[axis].data();
          const int step = shape.stride(axis);
          const bool has_lower = pass.wraps(axis) || index[axis] > 0,
                     has_upper = pass.wraps(axis) || index[axis] < shape.cells[axis] - 1;
          const bool lower = has_lower && solids.distance[at - step] >= 0.0f,
                     upper = has_upper && solids.distance[at + step] >= 0.0f;
          thin = thin || (lower && upper);
          any = any || (lower && open[at] > 0.0f) || (upper && open[at + step] > 0.0f);
        }
        block = solids.distance[at] < 0.0f && (!any || thin);
      }
      blocked[at] = block ? 1 : 0;
    }
  });
  for (int axis = 0; axis < 3; ++axis) {
    float* const open = pass.memory.open[axis].data();
    const int step = shape.stride(axis), last = shape.cells[axis], around = last * step;
    const bool wraps = pass.wraps(axis);
    each_row(pass, axis, [&](int c, int j, int k) {
      const int across = axis == 1 ? j : k;
      for (int i = 0; i < shape.cells[0] + (axis == 0 ? 1 : 0); ++i) {
        const int at = axis == 0 ? i : across, f = c + i;
        const int below = at > 0 ? f - step : f - step + around, above = at < last ? f : f - around;
        if (((at > 0 || wraps) && blocked[below] != 0) || ((at < last || wraps) && blocked[above] != 0))
          open[f] = 0.0f;
      }
    });
  }
}

// A cell whose centre lies in a solid has too little room for particles to tell whether it is liquid. It is as far from the surface as the cells
// beside it whose centres do not. It may be too full, though: particles would gather there without bound under a flat body.
void find_surface_in_solids(const LiquidPass& pass, const float* room) {
  const GridShape& shape = pass.shape();
  const float* const distance = pass.solids.distance.empty() ? nullptr : pass.solids.distance.data();
  if (distance == nullptr) return;
  float* const surface = pass.memory.surface.data();
  LiquidCell* const cell = pass.memory.cell.data();
  const std::uint8_t* const blocked = pass.memory.blocked.data();
  each_row(pass, -1, [&](int c, int j, int k) {
    for (int i = 0; i < shape.cells[0]; ++i) {
      const int at = c + i;
      if (distance[at] >= 0.0f || blocked[at] != 0) continue;
      const int index[3] = {i, j, k};
      float sum = 0.0f, weights = 0.0f;
      for (int axis = 0; axis < 3; ++axis) {
        const float* const open = pass.memory.open[axis].data();
        const int step = shape.stride(axis);
        const bool first = index[axis] == 0, last = index[axis] == shape.cells[axis] - 1;
        const int around = shape.cells[axis] * step;
        const int below = first ? at - step + around : at - step,
                  above = last ? at + step - around : at + step;
        if ((!first || pass.wraps(axis)) && distance[below] >= 0.0f)
          sum += open[at] * surface[below], weights += open[at];
        if ((!last || pass.wraps(axis)) && distance[above] >= 0.0f)
          sum += open[at + step] * surface[above], weights += open[at + step];
      }
      surface[at] = weights > 0.0f ? sum / weights : pass.edge(0);
      float& filled = pass.memory.filled[at];
      const float excess = filled * (room[at] > kMinRoom ? room[at] : kMinRoom) - room[at];
      filled = 1.0f + (excess > 0.0f ? excess : 0.0f);
      cell[at] = surface[at] <= 0.0f ? LiquidCell::liquid : LiquidCell::air;
    }
  });
}

// Eight cells at once, of which liquid counts: those that are all liquid or that have none need no look at each.
constexpr int kEight = 8;
std::uint64_t liquid_of_eight(const LiquidCell* cell) {
  static_assert(std::uint8_t(LiquidCell::air) == 0 && std::uint8_t(LiquidCell::liquid) == 1 &&
                std::uint8_t(LiquidCell::solid) == 2);
  std::uint64_t eight;
  std::memcpy(&eight, cell, sizeof eight);
  return eight & 0x0101010101010101u;
}
constexpr std::uint64_t kAllLiquid = 0x0101010101010101u;

bool are_eight_open(const float* open) {
  int closed = 0;
  for (int i = 0; i < kEight; ++i) closed |= open[i] != 1.0f ? 1 : 0;
  return closed == 0;
}

// How strongly cells are tied to the air around them, and which are air.
void find_ground(const LiquidPass& pass, PressureGrid& finest) {
  const GridShape& shape = pass.shape();
  const LiquidCell* const cell = pass.memory.cell.data();
  float inner[3];
  for (int axis = 0; axis < 3; ++axis)
    inner[axis] = pass.flat(axis) ? 0.0f : 1.0f / (pass.edge(axis) * pass.edge(axis));
  each_row(pass, -1, [&](int c, int j, int k) {
    const bool dry = is_dry(pass, -1, j, k);
    const int end = c + shape.cells[0], py = shape.pitch, pz = shape.plane;
    for (int i = c; i < end; ++i) {
      if (!dry && i + kEight <= end) {
        const std::uint64_t here = liquid_of_eight(cell + i);
        const bool within = here == kAllLiquid &&
                            (liquid_of_eight(cell + i - 1) & liquid_of_eight(cell + i + 1) &
                             liquid_of_eight(cell + i - py) & liquid_of_eight(cell + i + py) &
                             liquid_of_eight(cell + i - pz) & liquid_of_eight(cell + i + pz)) == kAllLiquid;
        if (here == 0 || within) {
          for (int n = i; n < i + kEight; ++n) {
            finest.ground[n] = 0.0f;
            finest.is_air[n] = cell[n] == LiquidCell::air ? 1 : 0;
          }
          i += kEight - 1;
          continue;
        }
      }
      if (dry) {
        finest.ground[i] = 0.0f;
        finest.is_air[i] = cell[i] == LiquidCell::air ? 1 : 0;
        continue;
      }
      float ground = 0.0f;
      if (cell[i] == LiquidCell::liquid) {
        for (int axis = 0; axis < 3; ++axis) {
          const int step = shape.stride(axis);
          const float *const open = pass.memory.open[axis].data(), *const steep =
                                                                       pass.memory.steepness[axis].data();
          if (cell[i - step] != LiquidCell::liquid) ground += inner[axis] * open[i] * steep[i];
          if (cell[i + step] != LiquidCell::liquid) ground += inner[axis] * open[i + step] * steep[i + step];
        }
      }
      finest.ground[i] = ground;
      finest.is_air[i] = cell[i] == LiquidCell::air ? 1 : 0;
    }
  });
}

}  // namespace

void find_open_faces(const LiquidPass& pass) {
  const GridShape& shape = pass.shape();
  const GasSolids& solids = pass.solids;
  const bool has_distance = solids.present() && !solids.distance.empty();
  bool same_sides = true;
  for (int side = 0; side < 6; ++side) {
    same_sides = same_sides && pass.memory.open_side[side] == pass.box().side[side];
    pass.memory.open_side[side] = pass.box().side[side];
  }
  if (pass.memory.has_open && same_sides && !solids.present()) return;
  pass.memory.has_open = !solids.present();
  for (int axis = 0; axis < 3; ++axis) {
    float* const to = pass.memory.open[axis].data();
    const int step = shape.stride(axis), last = shape.cells[axis];
    const bool wraps = pass.wraps(axis), flat = pass.flat(axis);
    const float low = wraps || pass.box().open(2 * axis) ? 1.0f : 0.0f;
    const float high = wraps || pass.box().open(2 * axis + 1) ? 1.0f : 0.0f;
    const float half_inverse = 0.5f / pass.edge(axis);
    each_row(pass, axis, [&](int c, int j, int k) {
      const int across = axis == 1 ? j : k, count = shape.cells[0] + (axis == 0 ? 1 : 0);
      // As far as this from every solid, a face is open.
      const float far = 0.51f * pass.edge(axis);
      const bool free =
          !solids.present() || (has_distance &&
                                (axis > 0 && across == last && !wraps
                                     ? true
                                     : are_all_above(solids.distance.data() + c, shape.cells[0], far)) &&
                                (axis > 0 && (across > 0 || wraps)
                                     ? are_all_above(solids.distance.data() + c - step, shape.cells[0], far)
                                     : true));
      for (int i = 0; i < count; ++i) {
        const int at = axis == 0 ? i : across, f = c + i;
        to[f] = flat ? 0.0f : at == 0 ? low : at == last ? high : 1.0f;
        if (free) continue;
        float open = solids.open[axis][f];
        if (has_distance) {
          const float below = solids.distance[at > 0 || wraps ? f - step : f],
                      above = solids.distance[at < last || wraps ? f : f - step];
          open = 0.5f + half_inverse * (below + above);
        }
        to[f] = !(open >= kMinOpen) ? 0.0f : open < 1.0f ? open * to[f] : to[f];
      }
    });
  }
  if (solids.present()) block_cells(pass);
}

void find_surface(const LiquidPass& pass) {
  const GridShape& shape = pass.shape();
  float* const filled = pass.memory.filled.data();
  float* const surface = pass.memory.surface.data();
  LiquidCell* const cell = pass.memory.cell.data();
  const float inverse_volume = 1.0f / (pass.edge(0) * pass.edge(1) * pass.edge(2));
  const float* room = nullptr;
  if (pass.solids.present()) {
    find_room(pass, pass.scratch(0));
    blur(pass, 0, pass.scratch(0), pass.scratch(1));
    blur(pass, 1, pass.scratch(1), pass.scratch(0));
    blur(pass, 2, pass.scratch(0), pass.scratch(1));
    room = pass.scratch(1);
  }
  const std::uint8_t* const blocked = pass.solids.present() ? pass.memory.blocked.data() : nullptr;
  const float edge = pass.edge(0);
  each_row(pass, -1, [&](int c, int, int) {
    for (int i = c; i < c + shape.cells[0]; ++i) {
      float full = filled[i] * inverse_volume;
      if (room != nullptr) full /= room[i] > kMinRoom ? room[i] : kMinRoom;
      filled[i] = full;
      const float part = full < 1.0f ? full : 1.0f;
      const float depth =
          part >= 0.5f ? 1.0f - std::sqrt(2.0f * (1.0f - part)) : std::sqrt(2.0f * part) - 1.0f;
      surface[i] = -edge * depth;
      cell[i] = blocked != nullptr && blocked[i] != 0 ? LiquidCell::solid
                : full >= 0.5f                        ? LiquidCell::liquid
                                                      : LiquidCell::air;
    }
  });
  if (pass.solids.present()) find_surface_in_solids(pass, room);
  fill_ghosts(pass.box(), shape, surface);
  fill_cell_ghosts(pass, cell);
  pass.memory.wet_row.resize(std::size_t(shape.rows()));
  each_row(pass, -1, [&](int c, int j, int k) {
    int any = 0;
    for (int i = c; i < c + shape.cells[0]; ++i) any |= cell[i] == LiquidCell::liquid ? 1 : 0;
    pass.memory.wet_row[j + k * shape.cells[1]] = std::uint8_t(any);
  });
}

// True if no cell on either side of a row of faces is liquid.
bool is_dry(const LiquidPass& pass, int axis, int j, int k) {
  const GridShape& shape = pass.shape();
  const auto wet = [&](int y, int z) {
    if (pass.wraps(1)) y = (y + shape.cells[1]) % shape.cells[1];
    if (pass.wraps(2)) z = (z + shape.cells[2]) % shape.cells[2];
    return y >= 0 && z >= 0 && y < shape.cells[1] && z < shape.cells[2] &&
           pass.memory.wet_row[y + z * shape.cells[1]] != 0;
  };
  return !wet(j, k) && !(axis > 0 && wet(j - (axis == 1 ? 1 : 0), k - (axis == 2 ? 1 : 0)));
}

void build_liquid_matrix(const LiquidPass& pass) {
  const GridShape& shape = pass.shape();
  PressureMatrix& matrix = pass.memory.matrix;
  PressureGrid& finest = matrix.levels[0];
  resize_pressure_level(finest, shape, true, true);
  mark_all_stale(finest);
  const LiquidCell* const cell = pass.memory.cell.data();
  const float* const surface = pass.memory.surface.data();
  float full = 0.0f;
  int axes = 0;
  for (int axis = 0; axis < 3; ++axis) {
    finest.periodic[axis] = pass.wraps(axis);
    const float inner = pass.flat(axis) ? 0.0f : 1.0f / (pass.edge(axis) * pass.edge(axis));
    full += inner;
    axes += pass.flat(axis) ? 0 : 1;
    const int step = shape.stride(axis), last = shape.cells[axis];
    const bool open_low = pass.box().open(2 * axis), open_high = pass.box().open(2 * axis + 1);
    const float* const open = pass.memory.open[axis].data();
    float* const steepness = pass.memory.steepness[axis].data();
    float* const face = finest.face[axis].data();
    each_row(pass, axis, [&](int c, int j, int k) {
      const int across = axis == 1 ? j : k, count = shape.cells[0] + (axis == 0 ? 1 : 0);
      if (is_dry(pass, axis, j, k)) {
        for (int f = c; f < c + count; ++f) steepness[f] = face[f] = 0.0f;
        return;
      }
      for (int i = 0; i < count; ++i) {
        if (i + kEight <= count) {
          const std::uint64_t below = liquid_of_eight(cell + c + i - step),
                              above = liquid_of_eight(cell + c + i);
          const bool none = (below | above) == 0;
          if (none || ((below & above) == kAllLiquid && are_eight_open(open + c + i))) {
            for (int f = c + i; f < c + i + kEight; ++f)
              steepness[f] = none ? 0.0f : 1.0f, face[f] = none ? 0.0f : inner;
            i += kEight - 1;
            continue;
          }
        }
        const int f = c + i, at = axis == 0 ? i : across;
        const bool lower = cell[f - step] == LiquidCell::liquid, upper = cell[f] == LiquidCell::liquid;
        float steep = 0.0f, between = 0.0f;
        if (open[f] > 0.0f && (lower || upper)) {
          if (lower && upper) {
            steep = 1.0f;
            between = inner * open[f];
          } else if ((at == 0 && open_low) || (at == last && open_high)) {
            steep = 2.0f;
          } else {
            const float in = lower ? surface[f - step] : surface[f],
                        out = lower ? surface[f] : surface[f - step];
            const float theta = in / (in - out);  // in <= 0 < out
            steep = 1.0f / (theta > kMinTheta ? theta : kMinTheta);
          }
        }
        steepness[f] = steep;
        face[f] = between;
      }
    });
  }
  finest.full_face = axes > 0 ? full / float(axes) : 0.0f;
  find_ground(pass, finest);
  build_pressure_levels(pass.kernels, pass.tasks, matrix);
  // Solids may enclose liquid that no air touches; without them all of the liquid touches air or none.
  matrix.has_pockets = pass.solids.present();
  if (matrix.has_pockets) find_pockets(matrix);
  const double grounded = sum_rows(shape, pass.tasks, [&](int c, int, int) {
    int any = 0;
    for (int i = c; i < c + shape.cells[0]; ++i) any |= finest.ground[i] > 0.0f ? 1 : 0;
    return double(any);
  });
  matrix.singular = !(grounded > 0.0);
}

}  // namespace gyre
