// One step of a liquid.
#include "fluid/liquid/liquid_step.h"

#include "fluid/liquid/extrapolation.h"
#include "fluid/liquid/liquid_cells.h"
#include "fluid/liquid/liquid_fields.h"
#include "fluid/liquid/liquid_pressure.h"
#include "fluid/liquid/liquid_viscosity.h"
#include "fluid/liquid/particle_transfer.h"
#include "fluid/liquid/surface_tension.h"

#include <cmath>

namespace gyre {

namespace {

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

// A lattice that moves with the velocity of a source: particles that have come from it are still on it, and only places without one get one.
struct SourceLattice {
  double spacing[3], offset[3];
  int first[3], counts[3];  // places around the source
  Array<std::uint8_t> taken;

  SourceLattice(const LiquidGrid& grid, const LiquidEmitter& emitter, Vec3 center, double time) {
    std::size_t count = 1;
    for (int axis = 0; axis < 3; ++axis) {
      const double edge = double(part_along(grid.box.cell, axis));
      const bool flat = grid.box.flat(axis);
      spacing[axis] = flat ? edge : 0.5 * edge;
      const double moved = flat ? 0.0 : double(part_along(emitter.velocity, axis)) * (time - emitter.start);
      const double places = moved / spacing[axis];
      offset[axis] = (places - std::floor(places)) * spacing[axis];
      // The first place begins before the box.
      const int last = (flat ? 1 : 2 * grid.box.cells[axis]) + 1;
      const auto within = [last](int i) { return i < 0 ? 0 : i < last ? i : last; };
      const float middle = part_along(center, axis);
      first[axis] = flat ? 0 : within(place(axis, middle - emitter.radius) - 1);
      const int end = flat ? last : within(place(axis, middle + emitter.radius) + 2);
      counts[axis] = end - first[axis];
      count *= std::size_t(counts[axis]);
    }
    taken.resize(count, std::uint8_t(0));
  }
  int place(int axis, float at) const {
    const double places = (double(at) - offset[axis]) / spacing[axis] + 1.0;
    return int(clamp(places, -1.0e9, 1.0e9));
  }
  float point(int axis, int i) const {
    return float((double(first[axis] + i) - 0.5) * spacing[axis] + offset[axis]);
  }
  std::uint8_t& at(int i, int j, int k) { return taken[i + counts[0] * (j + counts[1] * k)]; }
  void take(Vec3 point) {
    int index[3];
    for (int axis = 0; axis < 3; ++axis) {
      index[axis] = place(axis, part_along(point, axis)) - first[axis];
      if (index[axis] < 0 || index[axis] >= counts[axis]) return;
    }
    at(index[0], index[1], index[2]) = 1;
  }
};

void apply_emitter(const LiquidPass& pass, const LiquidEmitter& emitter, double time) {
  LiquidGrid& grid = pass.grid;
  const Vec3 center = difference(emitter.position, grid.box.corner);
  const auto holds = [&](Vec3 point) {
    Vec3 offset = point - center;
    if (pass.flat(0)) offset.x = 0.0f;
    if (pass.flat(1)) offset.y = 0.0f;
    if (pass.flat(2)) offset.z = 0.0f;
    return dot(offset, offset) <= emitter.radius * emitter.radius;
  };
  SourceLattice lattice(grid, emitter, center, time);
  for (int p = 0; p < grid.particles(); ++p) {
    const Vec3 point{grid.position[0][p], grid.position[1][p], grid.position[2][p]};
    if (!is_finite(point)) continue;
    lattice.take(point);
    if (!holds(point)) continue;
    for (int axis = 0; axis < 3; ++axis) {
      grid.motion[axis][p] = pass.flat(axis) ? 0.0f : part_along(emitter.velocity, axis);
      for (int b = 0; b < 3; ++b) grid.affine[3 * axis + b][p] = 0.0f;
    }
  }
  const Vec3 velocity{pass.flat(0) ? 0.0f : emitter.velocity.x, pass.flat(1) ? 0.0f : emitter.velocity.y,
                      pass.flat(2) ? 0.0f : emitter.velocity.z};
  const float volume = particle_volume(grid.box);
  for (int k = 0; k < lattice.counts[2]; ++k) {
    for (int j = 0; j < lattice.counts[1]; ++j) {
      for (int i = 0; i < lattice.counts[0]; ++i) {
        const Vec3 point{lattice.point(0, i), lattice.point(1, j), lattice.point(2, k)};
        if (lattice.at(i, j, k) == 0 && holds(point) &&
            has_room(grid.box, pass.memory.window, pass.solids, point))
          add_particle(grid, point, velocity, volume);
      }
    }
  }
}

// Within a source the liquid moves with its velocity, whatever pressure and weight would do: so as much flows as its area and velocity say.
void hold_sources(const LiquidPass& pass, std::span<const LiquidEmitter> emitters, double time) {
  const GridShape& shape = pass.shape();
  for (const LiquidEmitter& emitter : emitters) {
    if (!(time >= emitter.start && time < emitter.end)) continue;
    const Vec3 center = difference(emitter.position, pass.box().corner);
    for (int axis = 0; axis < 3; ++axis) {
      if (pass.flat(axis)) continue;
      const float velocity = part_along(emitter.velocity, axis);
      each_row(pass, axis, [&](int c, int j, int k) {
        for (int i = 0; i < shape.cells[0] + (axis == 0 ? 1 : 0); ++i) {
          const float place[3] = {float(i), float(j), float(k)};
          float square = 0.0f;
          for (int other = 0; other < 3; ++other) {
            const float at = (place[other] + (other == axis ? 0.0f : 0.5f)) * pass.edge(other);
            const float offset = at - part_along(center, other);
            if (!pass.flat(other)) square += offset * offset;
          }
          const float reach =
              emitter.radius + 0.5f * pass.edge(axis);  // particles at the rim lie between faces
          if (square > reach * reach || !(pass.memory.open[axis][c + i] > 0.0f)) continue;
          pass.memory.velocity[axis][c + i] = velocity;
          pass.memory.drift[axis][c + i] = velocity;
        }
      });
      wrap_points(pass, pass.memory.velocity[axis].data());
      wrap_points(pass, pass.memory.drift[axis].data());
    }
  }
}

void add_gravity(const LiquidPass& pass, Vec3 gravity) {
  for (int axis = 0; axis < 3; ++axis) {
    const float change = part_along(gravity, axis) * pass.step;
    if (pass.flat(axis) || change == 0.0f) continue;
    float* const velocity = pass.memory.velocity[axis].data();
    each_row(pass, axis, [&](int c, int, int) {
      for (int f = c; f < c + pass.shape().cells[0] + (axis == 0 ? 1 : 0); ++f) velocity[f] += change;
    });
  }
}

// A box that turns adds this to particles: their velocity turns against it by twice its angle, and they are drawn away from its axis.
void turn_particles(const LiquidPass& pass, const FrameMotion& motion) {
  constexpr int kBlock = 1024;
  LiquidGrid& grid = pass.grid;
  const Quat back = from_rotation_vector(-2.0f * pass.step * motion.spin);
  const float s[3] = {motion.spin.x, motion.spin.y, motion.spin.z};
  const float square = dot(motion.spin, motion.spin);
  for_blocks(pass.tasks, grid.particles(), kBlock, [&](int begin, int end, int) {
    for (int p = begin; p < end; ++p) {
      const Vec3 place{grid.position[0][p], grid.position[1][p], grid.position[2][p]};
      const Vec3 velocity{grid.motion[0][p], grid.motion[1][p], grid.motion[2][p]};
      const Vec3 changed = rotate(back, velocity) + pass.step * motion.outward(place);
      for (int axis = 0; axis < 3; ++axis)
        if (!pass.flat(axis)) grid.motion[axis][p] = part_along(changed, axis);
      for (int b = 0; b < 3; ++b) {
        if (pass.flat(b)) continue;
        const Vec3 column =
            rotate(back, Vec3{grid.affine[b][p], grid.affine[3 + b][p], grid.affine[6 + b][p]});
        for (int a = 0; a < 3; ++a) {
          const float outward = (a == b ? square : 0.0f) - s[a] * s[b];
          if (!pass.flat(a)) grid.affine[3 * a + b][p] = part_along(column, a) + pass.step * outward;
        }
      }
    }
  });
}

void save_velocity(const LiquidPass& pass) {
  for (int axis = 0; axis < 3; ++axis) {
    if (pass.flat(axis)) continue;
    pass.memory.before[axis].assign(pass.memory.velocity[axis].view());
    wrap_points(pass, pass.memory.before[axis].data());
  }
}

// The pressure acts on faces that a solid cuts as if liquid filled their open part. The particles there have another mass, at the first touch of
// a blow a smaller one, so they take from such faces the momentum that the solid gave: the change of velocity times the ratio of both masses.
// Called before particles move and again after it, which puts the velocities back.
constexpr float kMinMassRatio = 0.5f;  // 1: more, where particles crowd
constexpr float kMaxMassRatio = 2.0f;  // 1: less, so that few particles at a face get no wild velocity
void swap_cut_velocities(const LiquidPass& pass, bool forth) {
  LiquidMemory& memory = pass.memory;
  const float volume = pass.edge(0) * pass.edge(1) * pass.edge(2);
  for (const CutFace& face : memory.coupling.faces) {
    const std::size_t f = std::size_t(face.face);
    const float open = memory.open[face.axis][f], filled = memory.sums[face.axis][2 * f];
    if (!(open > 0.0f && open < 1.0f && filled > 0.0f)) continue;
    float& velocity = memory.velocity[face.axis][f];
    float& before = memory.before[face.axis][f];
    const float now = velocity;
    if (forth) {
      const float ratio = clamp(open * volume / filled, kMinMassRatio, kMaxMassRatio);
      velocity = before + ratio * (velocity - before);
      before = now;
    } else {
      velocity = before;
    }
  }
}

void run_substep(const LiquidPass& pass, const LiquidSettings& settings,
                 std::span<const LiquidEmitter> emitters, double time, LiquidReport& report,
                 std::span<GasImpulse> impulses) {
  sort_particles(pass);
  if (settings.motion.turns()) turn_particles(pass, settings.motion);
  transfer_to_grid(pass);
  find_surface(pass);
  build_liquid_matrix(pass);
  if (settings.blend < 1.0f) save_velocity(pass);
  add_gravity(pass, settings.gravity);
  if (settings.viscosity > 0.0f) add_liquid_viscosity(pass, settings.viscosity / settings.density);
  if (settings.surface_tension > 0.0f)
    set_surface_pressure(pass, settings.surface_tension / settings.density);
  const PressureReport solved = project_liquid(pass, settings, impulses);
  report.iterations += solved.iterations;
  report.residual = solved.first > 0.0f ? solved.last / solved.first : 0.0f;
  report.divergence = largest_liquid_divergence(pass);
  const int layers = 2 + int(settings.max_cells + 0.999f);
  report.iterations += find_carrier(pass).iterations;
  find_layers(pass, layers);
  extrapolate(pass, pass.memory.velocity, pass.memory.drift);
  hold_sources(pass, emitters, time);
  const bool cut = pass.solids.present() && !(settings.blend < 1.0f);
  if (cut) swap_cut_velocities(pass, true);
  move_particles(pass, settings.blend, settings.gravity);
  if (cut) swap_cut_velocities(pass, false);
}

// The window of the present particles instead of one that some of them are about to leave.
void move_window(const LiquidPass& pass, std::span<const LiquidEmitter> emitters, double time,
                 FunctionRef<void(const FluidWindow&)> cut, float ahead) {
  store_fields(pass);
  const CellBox cells = cells_of_particles(pass.grid, ahead, pass.tasks);
  pass.memory.window = find_window(pass.grid, cells, pass.bodies, emitters, time);
  cut(pass.memory.window);
  begin_fields(pass);
  find_open_faces(pass);
}

}  // namespace

LiquidReport step_liquid(LiquidGrid& grid, const GasSolids& solids, FunctionRef<void(const FluidWindow&)> cut,
                         std::span<const FluidBody> bodies, std::span<const LiquidEmitter> emitters,
                         const LiquidSettings& settings, double time, float step, LiquidMemory& memory,
                         const GasKernels& kernels, TaskSystem& tasks, std::span<GasImpulse> impulses) {
  const TaskSystem::Busy busy(tasks);
  memory.window = find_window(grid, cells_of_particles(grid, step, tasks), bodies, emitters, time);
  cut(memory.window);
  LiquidPass pass{grid, solids, bodies, memory, kernels, tasks, step, 0.0f};
  begin_fields(pass);
  LiquidReport report;
  begin_motions(grid.box, bodies, solids.present() ? solids.labels : 0, memory.coupling);
  find_open_faces(pass);
  for (const LiquidEmitter& emitter : emitters) {
    if (time >= emitter.start && time < emitter.end) apply_emitter(pass, emitter, time);
  }
  const float cells = largest_displacement(pass, settings.gravity);
  const float longest = capillary_step(grid.box, settings.surface_tension / settings.density);
  report.substeps = 1;
  while (report.substeps < settings.max_substeps &&
         (cells > settings.max_cells * float(report.substeps) || step > longest * float(report.substeps)))
    ++report.substeps;
  pass.step = step / float(report.substeps);
  // Waves of one cell that pass more than a cell in a sub-step grow without bound. If the sub-steps are too few, the tension is the largest that is
  // stable: the speed of these waves goes with its root.
  LiquidSettings stable = settings;
  if (pass.step > longest) {
    const float ratio = longest / pass.step;
    stable.surface_tension *= ratio * ratio;
  }
  for (int substep = 0; substep < report.substeps; ++substep) {
    pass.elapsed = float(substep) * pass.step;
    if (substep > 0 &&
        !memory.window.cells().contains(with_margin(grid.box, cells_of_particles(grid, 0.0f, tasks))))
      move_window(pass, emitters, time, cut, step - pass.elapsed);
    run_substep(pass, stable, emitters, time, report, impulses);
  }
  if (grid.box.any_open()) sort_particles(pass);
  store_fields(pass);
  return report;
}

void find_liquid_fields(LiquidGrid& grid, const GasSolids& solids,
                        FunctionRef<void(const FluidWindow&)> cut) {
  TaskSystem tasks(1);
  LiquidMemory memory;
  memory.window = find_window(grid, cells_of_particles(grid, 0.0f, tasks), {}, {}, 0.0);
  cut(memory.window);
  LiquidPass pass{grid, solids, {}, memory, select_gas_kernels(0), tasks, 0.0f, 0.0f};
  begin_fields(pass);
  find_open_faces(pass);
  sort_particles(pass);
  find_filled(pass);
  find_surface(pass);
  memory.has_stored = true, memory.stored = memory.window;
  store_fields(pass);
}

}  // namespace gyre
