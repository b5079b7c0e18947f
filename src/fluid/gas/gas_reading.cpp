// Energy, mass and probes of a gas.
#include "fluid/gas/gas_reading.h"

#include "fluid/grid/velocity_sample.h"
#include "fluid/solver/gas_pass.h"

namespace gyre {

namespace {

double cell_volume(const GasBox& box) { return double(box.cell.x) * double(box.cell.y) * double(box.cell.z); }

}  // namespace

double gas_kinetic_energy(const GasGrid& grid, const GasSolids& solids, float density, TaskSystem& tasks) {
  const GridShape& shape = grid.shape;
  const std::uint8_t* const solid = solids.present() ? solids.solid.data() : nullptr;
  double sum = 0.0;
  for (int axis = 0; axis < 3; ++axis) {
    const float* const v = grid.velocity[axis].data();
    const int step = shape.stride(axis);
    sum += sum_rows(shape, tasks, [&](int c, int, int) {
      double part = 0.0;
      for (int i = c; i < c + shape.cells[0]; ++i) {
        if (solid != nullptr && solid[i] != 0) continue;
        part += 0.5 * (double(v[i]) * double(v[i]) + double(v[i + step]) * double(v[i + step]));
      }
      return part;
    });
  }
  return 0.5 * double(density) * cell_volume(grid.box) * sum;
}

double smoke_mass(const GasGrid& grid, const GasSolids& solids, TaskSystem& tasks) {
  return field_mass(grid, grid.density, solids, tasks);
}

double field_mass(const GasGrid& grid, const Array<float>& field, const GasSolids& solids,
                  TaskSystem& tasks) {
  const GridShape& shape = grid.shape;
  const std::uint8_t* const solid = solids.present() ? solids.solid.data() : nullptr;
  const double sum = sum_rows(shape, tasks, [&](int c, int, int) {
    double part = 0.0;
    for (int i = c; i < c + shape.cells[0]; ++i) {
      if (solid == nullptr || solid[i] == 0) part += double(field[std::size_t(i)]);
    }
    return part;
  });
  return cell_volume(grid.box) * sum;
}

namespace {

// False beyond a side of the window that lies within the box of the gas. `local`: from the lower corner of the window.
bool is_computed(const GasGrid& grid, Vec3 local) {
  const float place[3] = {local.x / grid.box.cell.x, local.y / grid.box.cell.y, local.z / grid.box.cell.z};
  const CellBox cells = grid.cells();
  for (int axis = 0; axis < 3; ++axis) {
    if (cells.low[axis] > 0 && place[axis] < 0.0f) return false;
    if (cells.high[axis] < grid.whole.cells[axis] && place[axis] > float(grid.box.cells[axis])) return false;
  }
  return true;
}

}  // namespace

Vec3 gas_velocity(const GasGrid& grid, DVec3 point) {
  const Vec3 local = difference(point, grid.box.corner);
  if (!is_computed(grid, local)) return {};
  return sample_velocity(grid.box, grid.shape, grid.velocity, local);
}

GasProbe probe_gas(const GasGrid& grid, DVec3 point, float density, Vec3 gravity) {
  const Vec3 local = difference(point, grid.box.corner);
  GasProbe probe;
  probe.temperature = grid.ambient_temperature;
  if (is_computed(grid, local)) {
    const auto sample = [&](const Array<float>& field) {
      return sample_field(grid.box, grid.shape, field.data(), -1, local);
    };
    probe.velocity = gas_velocity(grid, point);
    probe.density = sample(grid.density), probe.temperature = sample(grid.temperature);
    probe.pressure = density * sample(grid.pressure);
    if (!grid.fuel.empty()) probe.fuel = sample(grid.fuel);
  }
  const GasBox& box = grid.whole;
  if (!box.any_open()) {
    const Vec3 place = difference(point, box.corner);
    const float from_middle[3] = {place.x - 0.5f * float(box.cells[0]) * box.cell.x,
                                  place.y - 0.5f * float(box.cells[1]) * box.cell.y,
                                  place.z - 0.5f * float(box.cells[2]) * box.cell.z};
    const float g[3] = {gravity.x, gravity.y, gravity.z};
    for (int axis = 0; axis < 3; ++axis) {
      if (!box.periodic(axis)) probe.pressure += density * g[axis] * from_middle[axis];
    }
  }
  return probe;
}

}  // namespace gyre
