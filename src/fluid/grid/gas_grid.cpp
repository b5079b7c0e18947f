// Fields of a gas: their memory, their ghosts, and values between grid points.
#include "fluid/grid/gas_grid.h"

#include "fluid/grid/gas_solids.h"

namespace gyre {

GasGrid make_gas_grid(const GasBox& box, float ambient_temperature) {
  GasGrid grid;
  grid.whole = grid.box = box;
  grid.shape = make_grid_shape(box.cells[0], box.cells[1], box.cells[2]);
  grid.ambient_temperature = ambient_temperature;
  const std::size_t size = std::size_t(grid.shape.size);
  for (Array<float>& faces : grid.velocity) faces.resize(size, 0.0f);
  grid.density.resize(size, 0.0f);
  grid.temperature.resize(size, ambient_temperature);
  grid.pressure.resize(size, 0.0f);
  return grid;
}

namespace {

// The value of a ghost: another cell of its line, that with the opposite sign, or a value.
enum class GhostKind : std::uint8_t { copy, mirror, value };

// Fills the layer `to` along an axis from the layer `from`; the other axes with their ghosts.
void fill_layer(const GridShape& shape, int axis, int from, int to, float* field, GhostKind kind,
                float value = 0.0f) {
  const int a = axis == 0 ? 1 : 0, b = axis == 2 ? 1 : 2;
  const int step_a = shape.stride(a), step_b = shape.stride(b);
  const int distance = (from - to) * shape.stride(axis);
  for (int j = -1; j <= shape.cells[b]; ++j) {
    float* const row = field + shape.first + j * step_b + to * shape.stride(axis);
    const auto fill = [&](int stride) {
      for (int i = -1; i <= shape.cells[a]; ++i) {
        const float other = row[i * stride + distance];
        row[i * stride] = kind == GhostKind::copy ? other : kind == GhostKind::mirror ? -other : value;
      }
    };
    step_a == 1 ? fill(1) : fill(step_a);
  }
}

}  // namespace

void fill_ghosts(const GasBox& box, const GridShape& shape, float* field, const float* outside) {
  for (int axis = 0; axis < 3; ++axis) {
    const int last = shape.cells[axis] - 1;
    const bool wraps = box.periodic(axis);
    for (int side = 0; side < 2; ++side) {
      const bool lower = side == 0;
      const bool valued = outside != nullptr && box.open(2 * axis + side);
      fill_layer(shape, axis, lower == wraps ? last : 0, lower ? -1 : last + 1, field,
                 valued ? GhostKind::value : GhostKind::copy, valued ? *outside : 0.0f);
    }
  }
}

void fill_pressure_ghosts(const GasBox& box, const GridShape& shape, float* field) {
  for (int axis = 0; axis < 3; ++axis) {
    const int last = shape.cells[axis] - 1;
    const bool wraps = box.periodic(axis);
    for (int side = 0; side < 2; ++side) {
      const bool lower = side == 0;
      fill_layer(shape, axis, lower == wraps ? last : 0, lower ? -1 : last + 1, field,
                 box.open(2 * axis + side) ? GhostKind::mirror : GhostKind::copy);
    }
  }
}

void clear_ghosts(const GridShape& shape, float* field) {
  for (int axis = 0; axis < 3; ++axis) {
    fill_layer(shape, axis, 0, -1, field, GhostKind::value);
    fill_layer(shape, axis, 0, shape.cells[axis], field, GhostKind::value);
  }
}

void wrap_ghosts(const GridShape& shape, const bool periodic[3], float* field) {
  for (int axis = 0; axis < 3; ++axis) {
    if (!periodic[axis]) continue;
    fill_layer(shape, axis, shape.cells[axis] - 1, -1, field, GhostKind::copy);
    fill_layer(shape, axis, 0, shape.cells[axis], field, GhostKind::copy);
  }
}

void wrap_faces(const GasBox& box, const GridShape& shape, int axis, float* faces) {
  for (int other = 0; other < 3; ++other) {
    const int last = shape.cells[other] - 1;
    if (box.periodic(other)) {
      fill_layer(shape, other, last, -1, faces, GhostKind::copy);
      fill_layer(shape, other, 0, last + 1, faces, GhostKind::copy);
    } else if (other != axis) {
      fill_layer(shape, other, 0, -1, faces, GhostKind::copy);
      fill_layer(shape, other, last, last + 1, faces, GhostKind::copy);
    }
  }
}

float sample_field(const GasBox& box, const GridShape& shape, const float* field, int faces, Vec3 point) {
  const float position[3] = {point.x / box.cell.x, point.y / box.cell.y, point.z / box.cell.z};
  int base[3];
  float fraction[3];
  for (int axis = 0; axis < 3; ++axis) {
    const float last = float(shape.cells[axis] - (axis == faces ? 0 : 1));
    float p = position[axis] - (axis == faces ? 0.0f : 0.5f);
    const bool wraps = box.periodic(axis) && axis != faces;  // between the last centre and the first
    const float low = wraps ? -1.0f : 0.0f, high = wraps ? last + 1.0f : last;
    p = p > low ? p : low;
    p = p < high ? p : high;
    int whole = int(p - low) + int(low);
    if (float(whole) >= high && high > low) whole -= 1;
    base[axis] = whole;
    fraction[axis] = p - float(whole);
  }
  float sum = 0.0f;
  for (int corner = 0; corner < 8; ++corner) {
    float weight = 1.0f;
    int at = shape.first;
    for (int axis = 0; axis < 3; ++axis) {
      const int up = corner >> axis & 1;
      weight *= up != 0 ? fraction[axis] : 1.0f - fraction[axis];
      at += (base[axis] + up) * shape.stride(axis);
    }
    if (weight != 0.0f) sum += weight * field[at];
  }
  return sum;
}

void clear_outside(const GridShape& shape, int faces, Array<float>& field) {
  const int rows_y = shape.cells[1] + (faces == 1 ? 1 : 0), rows_z = shape.cells[2] + (faces == 2 ? 1 : 0);
  const int length = shape.cells[0] + (faces == 0 ? 1 : 0);
  int end = 0;
  const auto clear_to = [&](int next) {
    for (int c = end; c < next; ++c) field[std::size_t(c)] = 0.0f;
  };
  for (int k = 0; k < rows_z; ++k) {
    for (int j = 0; j < rows_y; ++j) {
      clear_to(shape.row(j, k));
      end = shape.row(j, k) + length;
    }
  }
  clear_to(int(field.size()));
}

void clear_solids(const GridShape& shape, int labels, GasSolids& solids) {
  const std::size_t size = std::size_t(shape.size);
  const std::size_t rows = std::size_t(shape.cells[1] + 1) * std::size_t(shape.cells[2] + 1);
  solids.distance.clear();
  solids.nearest.clear();
  solids.labels = labels;
  ++solids.revision;
  if (solids.solid.size() == size && solids.near.size() == rows) {
    for (int k = 0; k <= shape.cells[2]; ++k) {
      for (int j = 0; j <= shape.cells[1]; ++j) {
        if (!solids.may_cut(shape, j, k)) continue;
        for (int c = shape.row(j, k); c <= shape.row(j, k) + shape.cells[0]; ++c) {
          for (int axis = 0; axis < 3; ++axis)
            solids.open[axis][c] = 1.0f, solids.velocity[axis][c] = 0.0f, solids.label[axis][c] = -1;
          solids.solid[c] = 0;
        }
      }
    }
    solids.near.clear();
    return;
  }
  solids.near.clear();
  for (int axis = 0; axis < 3; ++axis) {
    solids.open[axis].clear();
    solids.open[axis].resize(size, 1.0f);
    solids.velocity[axis].clear();
    solids.velocity[axis].resize(size, 0.0f);
    solids.label[axis].clear();
    solids.label[axis].resize(size, std::int16_t(-1));
  }
  solids.solid.clear();
  solids.solid.resize(size, std::uint8_t(0));
}

}  // namespace gyre
