#include "dynamics/fluid_step.h"

#include "fluid/gas/gas_reading.h"
#include "rigid/sleep/island.h"

#include <cmath>

namespace gyre {

namespace {

// A body that sleeps wakes if the force of a fluid changes by more than this share of its weight.
constexpr float kWakeShare = 0.01f;

DVec3 upper_corner(const GasBox& box) {
  return box.corner + DVec3{box.cells[0] * double(box.cell.x), box.cells[1] * double(box.cell.y),
                            box.cells[2] * double(box.cell.z)};
}

// The weight of the gas whose place the bodies take: the part of its pressure that the solver leaves out, since it rests on it
// (gas_forces.h). Faces that a body closes carry it, within the body too.
void add_lift(const GasGrid& gas, const GasSolids& solids, const GasSettings& settings, float seconds,
              std::span<GasImpulse> impulses) {
  const GridShape& shape = gas.shape;
  const Vec3 h = gas.box.cell;
  const double volume = double(h.x) * double(h.y) * double(h.z);
  const float gravity[3] = {settings.gravity.x, settings.gravity.y, settings.gravity.z};
  for (int axis = 0; axis < 3; ++axis) {
    if (gravity[axis] == 0.0f || gas.box.flat(axis) || gas.box.periodic(axis)) continue;
    const double scale = -double(seconds) * double(settings.density) * double(gravity[axis]) * volume;
    const Array<float>& open = solids.open[axis];
    const Array<std::int16_t>& label = solids.label[axis];
    for (int k = 0; k < shape.cells[2]; ++k) {
      for (int j = 0; j < shape.cells[1]; ++j) {
        const int row = shape.row(j, k);
        for (int i = 0; i < shape.cells[0]; ++i) {
          const std::size_t c = std::size_t(row + i);
          if (label[c] < 0 || (axis == 0 ? i : axis == 1 ? j : k) == 0) continue;
          const double push = scale * (1.0 - double(open[c]));
          const DVec3 at{(i + (axis == 0 ? 0.0 : 0.5)) * double(h.x),
                         (j + (axis == 1 ? 0.0 : 0.5)) * double(h.y),
                         (k + (axis == 2 ? 0.0 : 0.5)) * double(h.z)};
          const DVec3 force{axis == 0 ? push : 0.0, axis == 1 ? push : 0.0, axis == 2 ? push : 0.0};
          GasImpulse& impulse = impulses[std::size_t(label[c])];
          impulse.linear += force;
          impulse.angular += cross(at, force);
        }
      }
    }
  }
}

const FluidPush* find_push(const Array<FluidPush>& pushes, std::uint32_t body) {
  for (const FluidPush& one : pushes)
    if (one.body == body) return &one;
  return nullptr;
}

// Gives the impulses of the step to the bodies as forces. A sleeping body stays as it is as long as its force does.
void push_bodies(RigidWorld& w, FluidEntry& entry, const FluidScratch& scratch, float seconds) {
  Array<FluidPush> pushes;
  for (std::size_t label = 0; label < scratch.solids.bodies.size(); ++label) {
    const std::uint32_t body = scratch.solids.bodies[label];
    if (w.bodies.flags[body].type != BodyType::dynamic || w.bodies.flags[body].frozen != 0) continue;
    const GasImpulse& impulse = scratch.impulses[label];
    FluidPush push;
    push.body = body;
    push.force = to_float((1.0 / double(seconds)) * impulse.linear);
    const DVec3 arm = entry.gas.box.corner - w.bodies.poses[body].center;
    push.torque = to_float((1.0 / double(seconds)) * (impulse.angular + cross(arm, impulse.linear)));
    if (!is_finite(push.force) || !is_finite(push.torque)) continue;
    if (is_asleep(w, body)) {
      const FluidPush* const before = find_push(entry.pushes, body);
      const float weight = w.bodies.masses[body].mass * length(w.settings.gravity);
      const Vec3 old = before != nullptr ? before->force : Vec3{};
      if (!(length(push.force - old) > kWakeShare * weight)) {
        push.force = old, push.torque = before != nullptr ? before->torque : Vec3{};
        pushes.push_back(push);
        continue;
      }
      wake(w, body);
    }
    BodyForces& forces = w.bodies.forces[body];
    forces.force += push.force;
    forces.torque += push.torque;
    pushes.push_back(push);
  }
  entry.pushes = std::move(pushes);
}

// A fluid that is no longer finite is stilled: it goes on as air at rest.
void still(GasGrid& gas) { gas = make_gas_grid(gas.box, gas.ambient_temperature); }

bool is_finite_grid(const GasGrid& gas) {
  const auto good = [](const Array<float>& field) {
    float sum = 0.0f;
    for (const float one : field) sum += 0.0f * one;
    return sum == 0.0f;
  };
  return good(gas.velocity[0]) && good(gas.velocity[1]) && good(gas.velocity[2]) && good(gas.density) &&
         good(gas.temperature) && good(gas.pressure);
}

}  // namespace

GasSettings gas_settings(const GasDef& def, Vec3 gravity) {
  GasSettings settings;
  settings.density = def.density;
  settings.buoyancy = def.buoyancy;
  settings.vorticity = def.vorticity;
  settings.viscosity = def.viscosity;
  settings.advection = def.advection;
  settings.gravity = gravity;
  return settings;
}

void step_fluids(RigidWorld& w, FluidStore& fluids, std::vector<FluidScratch>& scratch,
                 const GasKernels& kernels, TaskSystem& tasks, double time, float seconds) {
  if (scratch.size() < fluids.entries.size()) scratch.resize(fluids.entries.size());
  for (std::size_t slot = 0; slot < fluids.entries.size(); ++slot) {
    FluidEntry& entry = fluids.entries[slot];
    if (entry.def == nullptr) continue;
    FluidScratch& own = scratch[slot];
    const GasSettings settings = gas_settings(entry.gas_def(), w.settings.gravity);
    cut_fluid_cells(w, entry.gas.box, entry.gas.shape, tasks, own.solids);
    own.impulses.clear();
    own.impulses.resize(own.solids.bodies.size(), GasImpulse{});
    own.report = step_gas(entry.gas, own.solids.solids, entry.emitters.view(), settings, time, seconds,
                          own.memory, kernels, tasks, own.impulses.view());
    own.failed = !is_finite_grid(entry.gas);
    if (own.failed) {
      still(entry.gas);
      own.memory = {};
      own.report = {};
      continue;
    }
    if (own.solids.solids.present())
      add_lift(entry.gas, own.solids.solids, settings, seconds, own.impulses.view());
    push_bodies(w, entry, own, seconds);
  }
}

bool find_wind(const FluidStore& fluids, DVec3 point, Vec3& velocity, float& density) {
  for (const FluidEntry& entry : fluids.entries) {
    if (entry.def == nullptr) continue;
    const GasBox& box = entry.gas.box;
    const DVec3 upper = upper_corner(box);
    if (point.x < box.corner.x || point.y < box.corner.y || point.z < box.corner.z || point.x > upper.x ||
        point.y > upper.y || point.z > upper.z)
      continue;
    velocity = gas_velocity(entry.gas, point);
    density = entry.gas_def().density;
    return true;
  }
  return false;
}

}  // namespace gyre
