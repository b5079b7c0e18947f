// Extrapolation of velocities.
#include "fluid/liquid/extrapolation.h"

#include <cstring>

namespace gyre {

namespace {

constexpr std::uint8_t kUnknown = 255;

void find_first_layer(const LiquidPass& pass, int axis, std::uint8_t* layer) {
  const GridShape& shape = pass.shape();
  const LiquidCell* const cell = pass.memory.cell.data();
  const int step = shape.stride(axis);
  each_row(pass, axis, [&](int c, int, int) {
    for (int f = c; f < c + shape.cells[0] + (axis == 0 ? 1 : 0); ++f) {
      const bool beside = cell[f] == LiquidCell::liquid || cell[f - step] == LiquidCell::liquid;
      layer[f] = beside ? 0 : kUnknown;
    }
  });
}

}  // namespace

void find_layers(const LiquidPass& pass, int count, Array<float> (&fields)[3]) {
  const GridShape& shape = pass.shape();
  const int steps[3] = {1, shape.pitch, shape.plane};
  for (int axis = 0; axis < 3; ++axis) {
    if (pass.flat(axis)) continue;
    Array<std::uint8_t>& layer = pass.memory.layer[axis];
    Array<std::uint8_t>& next = pass.memory.next_layer;
    float* const field = fields[axis].data();
    layer.clear();
    layer.resize(std::size_t(shape.size), kUnknown);
    find_first_layer(pass, axis, layer.data());
    for (int round = 1; round <= count; ++round) {
      wrap_points(pass, layer.data());
      wrap_points(pass, field);
      next.assign(layer.view());
      const std::uint8_t* const now = layer.data();
      each_row(pass, axis, [&](int c, int j, int k) {
        const int across = axis == 1 ? j : k;
        for (int i = 0; i < shape.cells[0] + (axis == 0 ? 1 : 0); ++i) {
          const int f = c + i;
          if (now[f] != kUnknown) continue;
          const bool last = (axis == 0 ? i : across) == shape.cells[axis];
          float sum = 0.0f;
          int known = 0;
          for (int other = 0; other < 3; ++other) {
            const int step = steps[other];
            if (now[f - step] != kUnknown) sum += field[f - step], ++known;
            if (other == axis && last) continue;
            if (now[f + step] != kUnknown) sum += field[f + step], ++known;
          }
          if (known == 0) continue;
          field[f] = sum / float(known);
          next[f] = std::uint8_t(round);
        }
      });
      Array<std::uint8_t> swapped = static_cast<Array<std::uint8_t>&&>(layer);
      layer = static_cast<Array<std::uint8_t>&&>(next);
      next = static_cast<Array<std::uint8_t>&&>(swapped);
    }
    wrap_points(pass, field);
  }
}

}  // namespace gyre
