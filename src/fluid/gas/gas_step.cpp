// One step of a gas.
#include "fluid/gas/gas_step.h"

#include "fluid/gas/gas_reading.h"
#include "fluid/solver/combustion.h"
#include "fluid/solver/pressure_pockets.h"
#include "fluid/solver/transport.h"
#include "fluid/solver/viscosity.h"

namespace gyre {

namespace {

void prepare_memory(const GasGrid& grid, const GasSolids& solids, GasMemory& memory,
                    const GasKernels& kernels, TaskSystem& tasks) {
  const std::size_t size = std::size_t(grid.shape.size);
  const PressureMatrix& matrix = memory.matrix;
  // Two windows of the same size differ in the sides of the box that they reach.
  const bool same_size = matrix.count > 0 && memory.field[0].size() == size && memory.cells == grid.cells();
  if (!same_size) {
    memory.cells = grid.cells();
    memory.matrix.near.clear();
    for (Array<float>& field : memory.field) field.clear(), field.resize(size, 0.0f);
    for (Array<float>& field : memory.before) field.clear();
  }
  if (!same_size || matrix.solids_revision != (solids.present() ? solids.revision : 0)) {
    build_pressure_matrix(grid.box, grid.shape, solids, kernels, tasks, memory.matrix);
    // Solids may enclose gas, for which the equation has no solution unless its inflow adds up to zero. This depends on the cells alone, and not on
    // earlier steps, so a snapshot goes on with the same bits.
    memory.matrix.has_pockets = solids.present() && find_pockets(memory.matrix) > 1;
  }
}

// Cells within solids take the mean of the free cells beside them, so that the interpolation near a solid sees no jump, and so does a cell that
// the solid leaves.
void fill_solid_cells(const GasPass& pass, float* field, float otherwise) {
  if (!pass.solids.present()) return;
  const GridShape& shape = pass.shape();
  const std::uint8_t* const solid = pass.solids.solid.data();
  each_row(pass, -1, [&](int c, int j, int k) {
    if (!pass.solids.may_cut(shape, j, k)) return;
    for (int i = 0; i < shape.cells[0]; ++i) {
      if (solid[c + i] == 0) continue;
      float sum = 0.0f;
      int free = 0;
      const int index[3] = {i, j, k};
      for (int axis = 0; axis < 3; ++axis) {
        for (int side = -1; side <= 1; side += 2) {
          const int next = index[axis] + side, at = c + i + side * shape.stride(axis);
          if (next < 0 || next >= shape.cells[axis] || solid[at] != 0) continue;
          sum += field[at];
          ++free;
        }
      }
      field[c + i] = free > 0 ? sum / float(free) : otherwise;
    }
  });
}

// Transport between grid values does not keep the sum of smoke or fuel exactly. In a closed box it is set right, in proportion.
void conserve_mass(const GasPass& pass, Array<float>& field, double mass) {
  const double now = field_mass(pass.grid, field, pass.solids, pass.tasks);
  if (!(now > 0.0) || !(mass > 0.0)) return;
  const float scale = float(mass / now);
  if (scale == 1.0f) return;
  each_row(pass, -1, [&](int c, int, int) {
    for (int i = c; i < c + pass.shape().cells[0]; ++i) field[i] *= scale;
  });
}

// Where no side is open the pressure is known but for a constant: its mean is zero.
void center_pressure(const GasPass& pass) {
  const PressureMatrix& matrix = pass.memory.matrix;
  if (matrix.has_pockets) return remove_pocket_means(matrix, pass.grid.pressure.data());
  if (!matrix.singular || matrix.active_cells == 0) return;
  const GridShape& shape = pass.shape();
  float* const pressure = pass.grid.pressure.data();
  const float* const inverse = matrix.levels[0].inverse_diagonal.data();
  const double sum = sum_rows(shape, pass.tasks, [&](int c, int, int) {
    double part = 0.0;
    for (int i = c; i < c + shape.cells[0]; ++i) part += double(pressure[i]);
    return part;
  });
  const float mean = float(sum / double(matrix.active_cells));
  each_row(pass, -1, [&](int c, int, int) {
    for (int i = c; i < c + shape.cells[0]; ++i) pressure[i] -= inverse[i] > 0.0f ? mean : 0.0f;
  });
}

// For readings between the last cell of a periodic axis and the first.
void fill_periodic_ghosts(const GasPass& pass) {
  const bool periodic[3] = {pass.box().periodic(0), pass.box().periodic(1), pass.box().periodic(2)};
  for (int axis = 0; axis < 3; ++axis) clear_outside(pass.shape(), axis, pass.grid.velocity[axis]);
  for (Array<float>* field : {&pass.grid.density, &pass.grid.temperature, &pass.grid.pressure})
    clear_outside(pass.shape(), -1, *field);
  for (Array<float>* field : {&pass.grid.density, &pass.grid.temperature, &pass.grid.pressure})
    wrap_ghosts(pass.shape(), periodic, field->data());
  if (!pass.grid.fuel.empty()) {
    clear_outside(pass.shape(), -1, pass.grid.fuel);
    wrap_ghosts(pass.shape(), periodic, pass.grid.fuel.data());
  }
  for (Array<float>& field : pass.grid.velocity) wrap_ghosts(pass.shape(), periodic, field.data());
}

void run_substep(const GasPass& pass, std::span<const GasEmitter> emitters, const GasSettings& settings,
                 double time, GasReport& report) {
  GasGrid& grid = pass.grid;
  apply_emitters(pass, emitters, settings.emitter_fuel, time);
  const bool conserves = !grid.whole.any_open();
  const bool burns = settings.combustion.has_value();
  const double smoke = conserves ? smoke_mass(grid, pass.solids, pass.tasks) : 0.0;
  const double fuel = conserves && burns ? field_mass(grid, grid.fuel, pass.solids, pass.tasks) : 0.0;
  trace_paths(pass);
  if (settings.viscosity > 0.0f) save_velocity(pass);
  add_pressure(pass, 0.5f, true);
  transport_fields(pass, settings.advection);
  if (conserves) conserve_mass(pass, grid.density, smoke);
  if (conserves && burns) conserve_mass(pass, grid.fuel, fuel);
  apply_emitters(pass, emitters, settings.emitter_fuel, time);
  set_walls(pass);
  if (pass.motion.turns()) {
    // Without the push of the pressure, which would turn into a swirl.
    add_pressure(pass, -0.5f, false);
    turn_velocity(pass);
    add_pressure(pass, 0.5f, false);
  }
  add_pressure(pass, 0.5f, false);
  if (burns) {
    report.burned += burn_fuel(pass, *settings.combustion, settings.density);
    fill_solid_cells(pass, grid.fuel.data(), 0.0f);
  }
  fill_solid_cells(pass, grid.density.data(), 0.0f);
  fill_solid_cells(pass, grid.temperature.data(), grid.ambient_temperature);
  add_buoyancy(pass, settings.gravity, settings.buoyancy);
  if (pass.motion.turns()) add_outward(pass);
  if (settings.vorticity != 0.0f) add_confinement(pass, settings.vorticity);
  if (settings.viscosity > 0.0f) add_viscosity(pass, settings.viscosity / settings.density);
  set_walls(pass);
  const PressureReport solved = project_velocity(pass, settings.projection);
  report.iterations += solved.iterations;
  report.residual = solved.first > 0.0f ? solved.last / solved.first : 0.0f;
}

}  // namespace

GasReport step_gas(GasGrid& grid, const GasSolids& solids, std::span<const FluidBody> bodies,
                   std::span<const GasEmitter> emitters, const GasSettings& settings, double time, float step,
                   GasMemory& memory, const GasKernels& kernels, TaskSystem& tasks,
                   std::span<GasImpulse> impulses) {
  const TaskSystem::Busy busy(tasks);
  prepare_memory(grid, solids, memory, kernels, tasks);
  GasPass pass{grid, solids, memory, kernels, tasks, step, bodies, settings.density, settings.motion};
  begin_bodies(pass);
  GasReport report;
  const float cells = max_displacement(pass);
  report.substeps = 1;
  while (report.substeps < settings.max_substeps && cells > settings.max_cells * float(report.substeps))
    ++report.substeps;
  pass.step = step / float(report.substeps);
  for (int substep = 0; substep < report.substeps; ++substep) {
    run_substep(pass, emitters, settings, time, report);
    if (solids.present() && !impulses.empty()) add_impulses(pass, settings.density, impulses);
  }
  center_pressure(pass);
  fill_periodic_ghosts(pass);
  report.divergence = largest_divergence(pass);
  return report;
}

GasReport settle_gas(GasGrid& grid, const GasSolids& solids, const GasSettings& settings, GasMemory& memory,
                     const GasKernels& kernels, TaskSystem& tasks) {
  const TaskSystem::Busy busy(tasks);
  prepare_memory(grid, solids, memory, kernels, tasks);
  const GasPass pass{grid, solids, memory, kernels, tasks, 1.0f};
  memory.coupling.any_moves = false;
  GasReport report;
  set_walls(pass);
  const PressureReport solved = project_velocity(pass, settings.projection);
  for (float& one : grid.pressure) one = 0.0f;
  report.iterations = solved.iterations;
  report.residual = solved.first > 0.0f ? solved.last / solved.first : 0.0f;
  report.divergence = largest_divergence(pass);
  return report;
}

}  // namespace gyre
