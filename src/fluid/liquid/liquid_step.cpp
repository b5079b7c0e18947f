// One step of a liquid.
#include "fluid/liquid/liquid_step.h"

#include "fluid/liquid/extrapolation.h"
#include "fluid/liquid/liquid_cells.h"
#include "fluid/liquid/liquid_pressure.h"
#include "fluid/liquid/liquid_reading.h"
#include "fluid/liquid/particle_transfer.h"

namespace gyre {

namespace {

void prepare_memory(const LiquidPass& pass) {
  const std::size_t size = std::size_t(pass.shape().size);
  LiquidMemory& memory = pass.memory;
  if (memory.filled.size() == size && memory.cell.size() == size) return;
  const auto renew = [size](Array<float>& field) { field.clear(), field.resize(size, 0.0f); };
  for (Array<float>& field : memory.field) renew(field);
  renew(memory.filled);
  for (int axis = 0; axis < 3; ++axis) {
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
}

// The largest number of cells that a particle or a solid may pass along an axis within the step.
float largest_displacement(const LiquidPass& pass, Vec3 gravity) {
  constexpr int kBlock = 4096;
  const LiquidGrid& grid = pass.grid;
  float most = 0.0f;
  for (int axis = 0; axis < 3; ++axis) {
    if (pass.flat(axis)) continue;
    const float* const speed = grid.motion[axis].data();
    const float fastest = reduce_blocks(
        pass.tasks, grid.particles(), kBlock, 0.0f,
        [&](int begin, int end, int) {
          float part = 0.0f;
          for (int p = begin; p < end; ++p) {
            const float one = absolute(speed[p]);
            part = one > part ? one : part;
          }
          return part;
        },
        [](float a, float b) { return a > b ? a : b; });
    const float cells =
        (fastest + absolute(part_along(gravity, axis)) * pass.step) * pass.step / pass.edge(axis);
    most = cells > most ? cells : most;
  }
  return most;
}

void apply_emitters(const LiquidPass& pass, std::span<const LiquidEmitter> emitters, double time) {
  LiquidGrid& grid = pass.grid;
  for (const LiquidEmitter& emitter : emitters) {
    if (!(time >= emitter.start && time < emitter.end)) continue;
    const Vec3 center = difference(emitter.position, grid.box.corner);
    for (int p = 0; p < grid.particles(); ++p) {
      float square = 0.0f;
      for (int axis = 0; axis < 3; ++axis) {
        const float offset = grid.position[axis][p] - part_along(center, axis);
        if (!pass.flat(axis)) square += offset * offset;
      }
      if (!(square <= emitter.radius * emitter.radius)) continue;
      for (int axis = 0; axis < 3; ++axis) {
        grid.motion[axis][p] = pass.flat(axis) ? 0.0f : part_along(emitter.velocity, axis);
        for (int b = 0; b < 3; ++b) grid.affine[3 * axis + b][p] = 0.0f;
      }
    }
    fill_liquid_ball(grid, emitter.position, emitter.radius, emitter.velocity, pass.solids);
  }
}

void add_gravity(const LiquidPass& pass, Vec3 gravity) {
  for (int axis = 0; axis < 3; ++axis) {
    const float change = part_along(gravity, axis) * pass.step;
    if (pass.flat(axis) || change == 0.0f) continue;
    float* const velocity = pass.grid.velocity[axis].data();
    each_row(pass, axis, [&](int c, int, int) {
      for (int f = c; f < c + pass.shape().cells[0] + (axis == 0 ? 1 : 0); ++f) velocity[f] += change;
    });
  }
}

void save_velocity(const LiquidPass& pass) {
  for (int axis = 0; axis < 3; ++axis) {
    if (pass.flat(axis)) continue;
    pass.memory.before[axis].assign(pass.grid.velocity[axis].view());
    wrap_points(pass, pass.memory.before[axis].data());
  }
}

void run_substep(const LiquidPass& pass, const LiquidSettings& settings, LiquidReport& report,
                 std::span<GasImpulse> impulses) {
  sort_particles(pass);
  transfer_to_grid(pass);
  find_surface(pass);
  build_liquid_matrix(pass);
  if (settings.blend < 1.0f) save_velocity(pass);
  add_gravity(pass, settings.gravity);
  const PressureReport solved =
      project_liquid(pass, settings.projection, settings.density, settings.gravity, impulses);
  report.iterations += solved.iterations;
  report.residual = solved.first > 0.0f ? solved.last / solved.first : 0.0f;
  report.divergence = largest_liquid_divergence(pass);
  const int layers = 2 + int(settings.max_cells + 0.999f);
  report.iterations += find_carrier(pass).iterations;
  find_layers(pass, layers, pass.grid.velocity);
  find_layers(pass, layers, pass.memory.drift);
  move_particles(pass, settings.blend, settings.gravity);
}

}  // namespace

LiquidReport step_liquid(LiquidGrid& grid, const GasSolids& solids, std::span<const FluidBody> bodies,
                         std::span<const LiquidEmitter> emitters, const LiquidSettings& settings, double time,
                         float step, LiquidMemory& memory, const GasKernels& kernels, TaskSystem& tasks,
                         std::span<GasImpulse> impulses) {
  const TaskSystem::Busy busy(tasks);
  LiquidPass pass{grid, solids, bodies, memory, kernels, tasks, step, 0.0f};
  prepare_memory(pass);
  LiquidReport report;
  begin_motions(grid.box, bodies, solids.present() ? solids.labels : 0, memory.coupling);
  find_open_faces(pass);
  apply_emitters(pass, emitters, time);
  const float cells = largest_displacement(pass, settings.gravity);
  report.substeps = 1;
  while (report.substeps < settings.max_substeps && cells > settings.max_cells * float(report.substeps))
    ++report.substeps;
  pass.step = step / float(report.substeps);
  for (int substep = 0; substep < report.substeps; ++substep) {
    pass.elapsed = float(substep) * pass.step;
    run_substep(pass, settings, report, impulses);
  }
  if (grid.box.any_open()) sort_particles(pass);
  report.volume = liquid_volume(grid, solids);
  return report;
}

void find_liquid_fields(LiquidGrid& grid, const GasSolids& solids) {
  TaskSystem tasks(1);
  LiquidMemory memory;
  LiquidPass pass{grid, solids, {}, memory, select_gas_kernels(0), tasks, 0.0f, 0.0f};
  prepare_memory(pass);
  find_open_faces(pass);
  sort_particles(pass);
  find_filled(pass);
  find_surface(pass);
}

}  // namespace gyre
