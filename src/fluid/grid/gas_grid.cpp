// Fields of a gas: their memory, their ghosts, and values between grid points.
#include "fluid/grid/gas_grid.h"

#include "fluid/grid/gas_solids.h"

namespace gyre {

GasGrid make_gas_grid(const GasBox& box, float ambient_temperature) {
  GasGrid grid;
  grid.box = box;
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

// Copies the layer `from` along an axis to the layer `to`; the other axes with their ghosts.
void copy_layer(const GridShape& shape, int axis, int from, int to, float* field, const float* value) {
  const int a = axis == 0 ? 1 : 0, b = axis == 2 ? 1 : 2;
  const int step = shape.stride(axis), step_a = shape.stride(a), step_b = shape.stride(b);
  for (int j = -1; j <= shape.cells[b]; ++j) {
    float* const row = field + shape.first + j * step_b;
    for (int i = -1; i <= shape.cells[a]; ++i) {
      row[i * step_a + to * step] = value != nullptr ? *value : row[i * step_a + from * step];
    }
  }
}

}  // namespace

void fill_ghosts(const GasBox& box, const GridShape& shape, float* field, const float* outside) {
  for (int axis = 0; axis < 3; ++axis) {
    const int last = shape.cells[axis] - 1;
    const bool wraps = box.periodic(axis);
    copy_layer(shape, axis, wraps ? last : 0, -1, field, box.open(2 * axis) ? outside : nullptr);
    copy_layer(shape, axis, wraps ? 0 : last, last + 1, field, box.open(2 * axis + 1) ? outside : nullptr);
  }
}

void wrap_ghosts(const GridShape& shape, const bool periodic[3], float* field) {
  for (int axis = 0; axis < 3; ++axis) {
    if (!periodic[axis]) continue;
    copy_layer(shape, axis, shape.cells[axis] - 1, -1, field, nullptr);
    copy_layer(shape, axis, 0, shape.cells[axis], field, nullptr);
  }
}

void wrap_faces(const GasBox& box, const GridShape& shape, int axis, float* faces) {
  for (int other = 0; other < 3; ++other) {
    const int last = shape.cells[other] - 1;
    if (box.periodic(other)) {
      copy_layer(shape, other, last, -1, faces, nullptr);
      copy_layer(shape, other, 0, last + 1, faces, nullptr);
    } else if (other != axis) {
      copy_layer(shape, other, 0, -1, faces, nullptr);
      copy_layer(shape, other, last, last + 1, faces, nullptr);
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

void clear_solids(const GridShape& shape, int labels, GasSolids& solids) {
  const std::size_t size = std::size_t(shape.size);
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
  solids.labels = labels;
  ++solids.revision;
}

}  // namespace gyre
