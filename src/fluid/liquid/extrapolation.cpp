// Extrapolation of velocities.
#include "fluid/liquid/extrapolation.h"

#include "fluid/liquid/liquid_cells.h"

#include <cstring>

namespace gyre {

namespace {

constexpr std::uint8_t kUnknown = 255, kOutside = 254, kWrapped = 253;
constexpr int kListed = 512;  // faces that a worker takes at a time

// The face or cell that a ghost of a periodic axis stands for.
int find_original(const LiquidPass& pass, int place) {
  const GridShape& shape = pass.shape();
  const int from = place - shape.at(-1, -1, -1);
  int index[3] = {from % shape.plane % shape.pitch - 1, from % shape.plane / shape.pitch - 1,
                  from / shape.plane - 1};
  for (int axis = 0; axis < 3; ++axis) {
    if (!pass.wraps(axis)) continue;
    const int n = shape.cells[axis];
    index[axis] = index[axis] < 0 ? n - 1 : index[axis] >= n ? 0 : index[axis];
  }
  return shape.at(index[0], index[1], index[2]);
}

void mark_row(const LiquidCell* cell, int step, int count, std::uint8_t* layer) {
  for (int f = 0; f < count; ++f) {
    const int beside =
        (cell[f] == LiquidCell::liquid ? 1 : 0) | (cell[f - step] == LiquidCell::liquid ? 1 : 0);
    layer[f] = beside != 0 ? 0 : kUnknown;
  }
}

void mark_faces(const LiquidPass& pass, int axis, Array<std::uint8_t>& layer) {
  const GridShape& shape = pass.shape();
  const LiquidCell* const cell = pass.memory.cell.data();
  const int step = shape.stride(axis);
  layer.clear();
  layer.resize(std::size_t(shape.size + shape.plane), kOutside);
  Array<std::uint8_t>& known_rows = pass.memory.known_row;
  const int rows_y = shape.cells[1] + (axis == 1 ? 1 : 0), rows_z = shape.cells[2] + (axis == 2 ? 1 : 0);
  known_rows.resize_uninitialized(std::size_t(rows_y) * std::size_t(rows_z));
  each_row(pass, axis, [&](int c, int j, int k) {
    const int count = shape.cells[0] + (axis == 0 ? 1 : 0);
    const bool dry = is_dry(pass, axis, j, k);
    known_rows[j + k * rows_y] = dry ? 0 : 1;
    if (dry)
      std::memset(layer.data() + c, kUnknown, std::size_t(count));
    else
      mark_row(cell + c, step, count, layer.data() + c);
  });
  for (int other = 0; other < 3; ++other) {
    if (!pass.wraps(other)) continue;
    const int a = (other + 1) % 3, b = (other + 2) % 3, n = shape.cells[other], stride = shape.stride(other);
    for (int j = -1; j <= shape.cells[b]; ++j) {
      for (int i = -1; i <= shape.cells[a]; ++i) {
        std::uint8_t* const line = layer.data() + shape.first + i * shape.stride(a) + j * shape.stride(b);
        line[-stride] = line[n * stride] = kWrapped;
      }
    }
  }
}

// Unknown faces with a known one or a ghost of a periodic axis beside them.
void find_beside(const std::uint8_t* at, int py, int pz, int count, std::uint8_t* found) {
  const auto counts = [](std::uint8_t one) { return std::uint8_t((one == 0) | (one == kWrapped)); };
  for (int i = 0; i < count; ++i) {
    const std::uint8_t any = counts(at[i - 1]) | counts(at[i + 1]) | counts(at[i - py]) | counts(at[i + py]) |
                             counts(at[i - pz]) | counts(at[i + pz]);
    found[i] = std::uint8_t(any & std::uint8_t(at[i] == kUnknown));
  }
}

// False if no face of a row is beside a known one.
bool may_be_beside(const LiquidPass& pass, int rows_y, int rows_z, int j, int k) {
  if (pass.wraps(1) || pass.wraps(2)) return true;
  const auto known = [&](int y, int z) {
    return y >= 0 && z >= 0 && y < rows_y && z < rows_z && pass.memory.known_row[y + z * rows_y] != 0;
  };
  return known(j, k) || known(j - 1, k) || known(j + 1, k) || known(j, k - 1) || known(j, k + 1);
}

// Adds the unknown faces beside known ones of a row.
void list_first_layer(const LiquidPass& pass, int first, int count, Array<std::uint8_t>& layer,
                      Array<std::uint8_t>& near, Array<std::int32_t>& list) {
  const GridShape& shape = pass.shape();
  const int py = shape.pitch, pz = shape.plane;
  const std::uint8_t* const at = layer.data() + first;
  near.resize(std::size_t(count) + 8, std::uint8_t(0));
  std::uint8_t* const found = near.data();
  // Those with a ghost of a periodic axis beside them are looked at below.
  find_beside(at, py, pz, count, found);
  for (int i = 0; i < count; ++i) {
    if (i % 8 == 0) {
      std::uint64_t eight;
      std::memcpy(&eight, found + i, sizeof eight);
      if (eight == 0 && i + 8 <= count) {
        i += 7;
        continue;
      }
    }
    if (found[i] == 0) continue;
    for (const int step : {1, py, pz}) {
      bool known = false;
      for (const int next : {first + i - step, first + i + step}) {
        const int original = layer[next] == kWrapped ? find_original(pass, next) : next;
        known = known || layer[original] == 0;
      }
      if (!known) continue;
      list.push_back(first + i);
      break;
    }
  }
}

}  // namespace

void find_layers(const LiquidPass& pass, int count) {
  const GridShape& shape = pass.shape();
  Array<std::uint8_t> near;
  for (int axis = 0; axis < 3; ++axis) {
    if (pass.flat(axis)) continue;
    Array<std::uint8_t>& layer = pass.memory.layer[axis];
    Array<std::int32_t>& list = pass.memory.beyond[axis];
    Array<std::int32_t>& begin = pass.memory.beyond_begin[axis];
    mark_faces(pass, axis, layer);
    list.clear();
    begin.clear();
    begin.push_back(0);
    const int rows_y = shape.cells[1] + (axis == 1 ? 1 : 0), rows_z = shape.cells[2] + (axis == 2 ? 1 : 0);
    for (int k = 0; k < rows_z; ++k) {
      for (int j = 0; j < rows_y; ++j)
        if (may_be_beside(pass, rows_y, rows_z, j, k))
          list_first_layer(pass, shape.row(j, k), shape.cells[0] + (axis == 0 ? 1 : 0), layer, near, list);
    }
    for (const std::int32_t f : list) layer[f] = 1;
    for (int round = 1; round < count; ++round) {
      const std::size_t first = std::size_t(begin.back()), last = list.size();
      begin.push_back(std::int32_t(last));
      for (std::size_t i = first; i < last; ++i) {
        const int f = list[i];
        for (const int step : {1, shape.pitch, shape.plane}) {
          for (const int beside : {f - step, f + step}) {
            const int next = layer[beside] == kWrapped ? find_original(pass, beside) : beside;
            if (layer[next] != kUnknown) continue;
            layer[next] = std::uint8_t(round + 1);
            list.push_back(next);
          }
        }
      }
    }
    begin.push_back(std::int32_t(list.size()));
  }
}

void extrapolate(const LiquidPass& pass, Array<float> (&first_fields)[3], Array<float> (&second_fields)[3]) {
  const GridShape& shape = pass.shape();
  for (int axis = 0; axis < 3; ++axis) {
    if (pass.flat(axis)) continue;
    const std::uint8_t* const layer = pass.memory.layer[axis].data();
    const Array<std::int32_t>& list = pass.memory.beyond[axis];
    const Array<std::int32_t>& begins = pass.memory.beyond_begin[axis];
    float *const one = first_fields[axis].data(), *const two = second_fields[axis].data();
    for (std::size_t round = 0; round + 1 < begins.size(); ++round) {
      const int first = begins[round], total = begins[round + 1] - first;
      const auto own = std::uint8_t(round + 1);
      for_blocks(pass.tasks, total, kListed, [&](int begin, int end, int) {
        for (int i = first + begin; i < first + end; ++i) {
          const int f = list[i];
          float sum_one = 0.0f, sum_two = 0.0f;
          int known = 0;
          for (const int step : {1, shape.pitch, shape.plane}) {
            for (const int beside : {f - step, f + step}) {
              const int next = layer[beside] == kWrapped ? find_original(pass, beside) : beside;
              if (layer[next] < own) sum_one += one[next], sum_two += two[next], ++known;
            }
          }
          one[f] = sum_one / float(known);
          two[f] = sum_two / float(known);
        }
      });
    }
    wrap_points(pass, one);
    wrap_points(pass, two);
  }
}

}  // namespace gyre
