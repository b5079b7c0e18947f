#include "dynamics/fluid/fluid_step.h"

#include "dynamics/fluid/adaptive_domain.h"
#include "fluid/gas/gas_reading.h"
#include "fluid/liquid/liquid_reading.h"
#include "fluid/store/fluid_builder.h"
#include "fluid/store/fluid_motion.h"
#include "geometry/mass/submerged.h"
#include "math/rotation.h"
#include "rigid/sleep/island.h"
#include "task/parallel.h"

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
              std::span<const FluidBody> bodies, std::span<GasImpulse> impulses) {
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
        if (!solids.may_cut(shape, j, k)) continue;
        const int row = shape.row(j, k);
        for (int i = 0; i < shape.cells[0]; ++i) {
          const std::size_t c = std::size_t(row + i);
          if (label[c] < 0 || (axis == 0 ? i : axis == 1 ? j : k) == 0) continue;
          const double push = scale * (1.0 - double(open[c]));
          DVec3 at{(i + (axis == 0 ? 0.0 : 0.5)) * double(h.x), (j + (axis == 1 ? 0.0 : 0.5)) * double(h.y),
                   (k + (axis == 2 ? 0.0 : 0.5)) * double(h.z)};
          at += image_shift(gas.box, at, bodies[std::size_t(label[c])].center - gas.box.corner);
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

// The point about which the moments of impulses are: the lower corner of the box of a liquid, or of the window of a gas.
DVec3 impulse_corner(const FluidEntry& entry) {
  return entry.is_liquid() ? entry.liquid.box.corner : entry.gas.box.corner;
}

// Gives the impulses of the step to the bodies as forces. A sleeping body stays as it is as long as its force does.
void push_bodies(RigidWorld& w, FluidEntry& entry, const FluidScratch& scratch, float seconds) {
  Array<FluidPush> pushes;
  for (std::size_t label = 0; label < scratch.solids.bodies.size(); ++label) {
    const std::uint32_t body = scratch.solids.bodies[label];
    if (w.bodies.flags[body].type != BodyType::dynamic || w.bodies.flags[body].frozen != 0) continue;
    const GasImpulse& impulse = scratch.impulses[label];
    const FluidFrame* const frame = entry.frame();
    FluidPush push;
    push.body = body;
    push.force = to_float((1.0 / double(seconds)) * vector_to_world(frame, impulse.linear));
    const DVec3 arm = impulse_corner(entry) - point_to_frame(frame, w.bodies.poses[body].center);
    push.torque = to_float((1.0 / double(seconds)) *
                           vector_to_world(frame, impulse.angular + cross(arm, impulse.linear)));
    if (!is_finite(push.force) || !is_finite(push.torque)) continue;
    if (is_asleep(w, body)) {
      const FluidPush* const before = find_push(entry.pushes, body);
      const float weight = w.bodies.masses[body].mass * length(w.settings.gravity);
      const Vec3 old = before != nullptr ? before->force : Vec3{};
      // The window of a gas leaves out bodies that sleep, which the gas bears as before.
      const bool is_known = entry.is_liquid() || is_within_window(entry.gas, scratch.solids, body);
      if (!is_known || !(length(push.force - old) > kWakeShare * weight)) {
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

bool is_finite_field(const Array<float>& field, TaskSystem& tasks) {
  constexpr int kBlock = 16384;
  const float* const from = field.data();
  return reduce_blocks(
             tasks, int(field.size()), kBlock, 0,
             [&](int begin, int end, int) {
               int any = 0;
               for (int i = begin; i < end; ++i) {
                 const auto bits = __builtin_bit_cast(std::uint32_t, from[i]);
                 any |= (bits & 0x7f800000u) == 0x7f800000u ? 1 : 0;
               }
               return any;
             },
             [](int a, int b) { return a | b; }) == 0;
}
bool is_finite_fluid(const FluidEntry& entry, TaskSystem& tasks) {
  const auto all = [&](const auto& fields) {
    bool good = true;
    for (const Array<float>& field : fields) good = good && is_finite_field(field, tasks);
    return good;
  };
  if (entry.is_liquid())
    return all(entry.liquid.position) && all(entry.liquid.motion) && all(entry.liquid.affine);
  return all(entry.gas.velocity) && is_finite_field(entry.gas.density, tasks) &&
         is_finite_field(entry.gas.temperature, tasks) && is_finite_field(entry.gas.pressure, tasks) &&
         is_finite_field(entry.gas.fuel, tasks);
}

// A fluid that is no longer finite goes on at rest: a gas as air, a liquid with those particles whose places are finite.
void still(FluidEntry& entry) {
  if (!entry.is_liquid()) {
    entry.gas = entry.is_adaptive() ? make_gas_grid(entry.gas.whole, CellBox{}, entry.gas.ambient_temperature)
                                    : make_gas_grid(entry.gas.whole, entry.gas.ambient_temperature);
    if (entry.burns()) entry.gas.fuel.resize(std::size_t(entry.gas.shape.size), 0.0f);
    return;
  }
  LiquidGrid calm = make_liquid_grid(entry.liquid.box);
  const LiquidGrid& old = entry.liquid;
  for (std::size_t i = 0; i < std::size_t(old.particles()); ++i) {
    const Vec3 at{old.position[0][i], old.position[1][i], old.position[2][i]};
    if (is_finite(at)) add_particle(calm, at, {}, old.volume[i]);
  }
  entry.liquid = std::move(calm);
}

// m^3; 0: not known, since a shape is not convex. Shapes that overlap count twice.
float volume_of_body(const RigidWorld& w, std::uint32_t body) {
  double sum = 0.0;
  for (const ShapeId id : w.bodies.shapes[body]) {
    const Shape& shape = w.shapes.colliders[id.index].shape;
    if (w.shapes.proxies[id.index].sensor) continue;
    if (!is_convex(shape.kind)) return 0.0f;
    sum += volume_of(shape);
  }
  return float(sum);
}

// A body yields to the pressure of a gas within the equation if it is lighter than this many times the gas whose place it takes. Heavier ones
// get the force of the pressure afterwards: the gas that moves with them does not matter then, and a body that stands on something presses
// nothing out from under it.
constexpr float kLightShare = 8.0f;

// Bodies as the pressure of a fluid sees them: those that are awake and free to move yield to it; in a gas, of this density, light ones.
void list_bodies(const RigidWorld& w, const FluidFrame* frame, float gas_density, FluidScratch& scratch) {
  scratch.bodies.clear();
  const auto find_bounds = [&](std::uint32_t index, FluidBody& body) {
    for (const NearShape& near : scratch.solids.moving) {
      if (near.body != index) continue;
      body.bounds = body.has_bounds
                        ? Aabb{min(body.bounds.low, near.box.low), max(body.bounds.high, near.box.high)}
                        : near.box;
      body.has_bounds = true;
    }
  };
  for (const std::uint32_t body : scratch.solids.bodies) {
    FluidBody out;
    const BodyFlags& flags = w.bodies.flags[body];
    const BodyMotion& motion = w.bodies.motion[body];
    out.center = w.bodies.poses[body].center;
    if (flags.type != BodyType::fixed)
      out.velocity = motion.linear_velocity, out.angular_velocity = motion.angular_velocity;
    if (flags.type == BodyType::dynamic && flags.frozen == 0 && flags.awake != 0) {
      const BodyMass& mass = w.bodies.masses[body];
      const float volume = volume_of_body(w, body);
      if (gas_density > 0.0f && !(mass.mass < kLightShare * gas_density * volume)) {
        scratch.bodies.push_back(out);
        continue;
      }
      const BodyForces& forces = w.bodies.forces[body];
      const Sym3 inverse_inertia = rotate_inertia(w.bodies.poses[body].orientation, mass.inverse_inertia);
      out.inverse_mass = mass.inverse_mass;
      if (gas_density == 0.0f) find_bounds(body, out);
      // The cells of a gas count as they are, for its lift too.
      out.volume = gas_density > 0.0f ? 0.0f : volume;
      out.inverse_inertia = inverse_inertia;
      out.acceleration = forces.gravity_scale * w.settings.gravity + mass.inverse_mass * forces.force;
      out.angular_acceleration = inverse_inertia * forces.torque;
    }
    scratch.bodies.push_back(out);
  }
  if (frame == nullptr) return;
  const Quat to_box = conjugate(frame->pose.orientation);
  for (FluidBody& body : scratch.bodies) {
    body.velocity = velocity_to_frame(frame, body.center, body.velocity);
    body.angular_velocity = vector_to_frame(frame, body.angular_velocity - frame->angular_velocity);
    body.center = point_to_frame(frame, body.center);
    body.inverse_inertia = rotate_inertia(to_box, body.inverse_inertia);
    body.acceleration = vector_to_frame(frame, body.acceleration);
    body.angular_acceleration = vector_to_frame(frame, body.angular_acceleration);
  }
}

// In the middle of the step, since the box may turn.
Vec3 gravity_in_box(const RigidWorld& w, const FluidFrame* frame, float seconds) {
  if (frame == nullptr) return w.settings.gravity;
  const FluidFrame middle = advanced(*frame, 0.5f * seconds);
  return vector_to_frame(&middle, w.settings.gravity);
}

bool touches(const RigidWorld& w, std::uint32_t body) {
  bool any = false;
  for_each_contact_of_body(w, body, [&](std::uint32_t slot) {
    const Contact& contact = w.contacts.contacts[slot];
    any = any || (contact.touching != 0 && contact.sensor == 0);
  });
  return any;
}

// Bodies that yield to the gas do so with its lift; those that touch something, as if that bore them.
void add_lift_to_bodies(const RigidWorld& w, const FluidEntry& entry, const GasSettings& settings,
                        float seconds, FluidScratch& own) {
  bool any = false;
  for (const FluidBody& body : own.bodies) any = any || body.inverse_mass > 0.0f;
  if (!any) return;
  Array<GasImpulse> lift;
  lift.resize(own.bodies.size(), GasImpulse{});
  add_lift(entry.gas, own.solids.solids, settings, seconds, own.bodies.view(), lift.view());
  for (std::size_t label = 0; label < own.bodies.size(); ++label) {
    FluidBody& body = own.bodies[label];
    if (!(body.inverse_mass > 0.0f)) continue;
    if (touches(w, own.solids.bodies[label])) {
      body.acceleration = body.angular_acceleration = {};
      continue;
    }
    const double rate = 1.0 / double(seconds);
    const DVec3 arm = impulse_corner(entry) - body.center;
    body.acceleration += body.inverse_mass * to_float(rate * lift[label].linear);
    body.angular_acceleration +=
        body.inverse_inertia * to_float(rate * (lift[label].angular + cross(arm, lift[label].linear)));
  }
}

void step_gas_entry(RigidWorld& w, FluidEntry& entry, FluidScratch& own, const GasKernels& kernels,
                    TaskSystem& tasks, double time, float seconds) {
  const GasDef& def = entry.gas_def();
  GasSettings settings;
  settings.density = def.density, settings.buoyancy = def.buoyancy;
  settings.vorticity = def.vorticity, settings.viscosity = def.viscosity;
  settings.advection = def.advection;
  settings.gravity = gravity_in_box(w, entry.frame(), seconds);
  if (entry.frame() != nullptr && entry.frame()->moves()) settings.motion = frame_motion(entry);
  settings.combustion = def.combustion;
  settings.emitter_fuel = entry.emitter_fuel.view();
  list_bodies(w, entry.frame(), def.density, own);
  add_lift_to_bodies(w, entry, settings, seconds, own);
  const GasReport report = step_gas(entry.gas, own.solids.solids, own.bodies.view(), entry.emitters.view(),
                                    settings, time, seconds, own.gas, kernels, tasks, own.impulses.view());
  own.report.substeps = report.substeps, own.report.iterations = report.iterations;
  own.report.divergence = report.divergence, own.report.residual = report.residual;
  if (def.combustion)
    own.report.heat_rate = double(def.combustion->heat_release) * report.burned / double(seconds);
  if (own.solids.solids.present())
    add_lift(entry.gas, own.solids.solids, settings, seconds, own.bodies.view(), own.impulses.view());
}

void step_liquid_entry(RigidWorld& w, FluidEntry& entry, FluidScratch& own, const GasKernels& kernels,
                       TaskSystem& tasks, double time, float seconds) {
  const LiquidDef& def = entry.liquid_def();
  LiquidSettings settings;
  settings.density = def.density, settings.viscosity = def.viscosity;
  settings.surface_tension = def.surface_tension;
  settings.gravity = gravity_in_box(w, entry.frame(), seconds);
  if (entry.frame() != nullptr && entry.frame()->moves()) settings.motion = frame_motion(entry);
  own.sources.clear();
  own.report.full = entry.liquid.particles() >= kMaxLiquidParticles && !entry.emitters.empty();
  if (!own.report.full) {
    for (const GasEmitter& one : entry.emitters)
      own.sources.push_back(
          {one.position, one.radius, one.has_velocity ? one.velocity : Vec3{}, one.start, one.end});
  }
  list_bodies(w, entry.frame(), 0.0f, own);
  const auto cut = [&](const FluidWindow& window) { cut_fluid_cells(w, entry, window, tasks, own.solids); };
  const LiquidReport report =
      step_liquid(entry.liquid, own.solids.solids, cut, own.bodies.view(), own.sources.view(), settings, time,
                  seconds, own.liquid, kernels, tasks, own.impulses.view());
  own.report.substeps = report.substeps, own.report.iterations = report.iterations;
  own.report.divergence = report.divergence, own.report.residual = report.residual;
}

// Points in the axes of the box.
bool is_in_liquid(const LiquidGrid& liquid, DVec3 point) {
  return sample_field(liquid.box, liquid.shape, liquid.surface.data(), -1,
                      difference(point, liquid.box.corner)) < 0.0f;
}

bool is_within(const GasBox& box, DVec3 point) {
  const DVec3 upper = upper_corner(box);
  return point.x >= box.corner.x && point.y >= box.corner.y && point.z >= box.corner.z &&
         point.x <= upper.x && point.y <= upper.y && point.z <= upper.z;
}

}  // namespace

void step_fluids(RigidWorld& w, const SoftStore& soft, FluidStore& fluids, std::vector<FluidScratch>& scratch,
                 const GasKernels& kernels, TaskSystem& tasks, double time, float seconds) {
  if (scratch.size() < fluids.entries.size()) scratch.resize(fluids.entries.size());
  for (std::size_t slot = 0; slot < fluids.entries.size(); ++slot) {
    FluidEntry& entry = fluids.entries[slot];
    if (entry.def == nullptr) continue;
    FluidScratch& own = scratch[slot];
    find_near_shapes(w, entry, own.solids);
    if (!entry.is_liquid()) {
      const Vec3 gravity = gravity_in_box(w, entry.frame(), seconds);
      adapt_domain(w, soft, own.solids, gravity, time, seconds, tasks, entry);
      cut_fluid_cells(w, entry, gas_window(entry.gas), tasks, own.solids);
    }
    own.impulses.clear();
    own.impulses.resize(own.solids.bodies.size(), GasImpulse{});
    own.report = {};
    if (entry.is_liquid())
      step_liquid_entry(w, entry, own, kernels, tasks, time, seconds);
    else
      step_gas_entry(w, entry, own, kernels, tasks, time, seconds);
    if (!is_finite_fluid(entry, tasks)) {
      still(entry);
      own.gas = {}, own.liquid = {};
      own.report = {};
      own.report.failed = true;
      advance_frame(entry, seconds);
      continue;
    }
    push_bodies(w, entry, own, seconds);
    advance_frame(entry, seconds);
  }
}

bool find_stream(const FluidStore& fluids, DVec3 point, FluidStream& out) {
  const int slot = find_fluid(fluids, point);
  if (slot < 0) return false;
  const FluidEntry& entry = fluids.entries[std::size_t(slot)];
  const Vec3 h = entry.box().cell;
  const float edge = min(h.x, min(h.y, h.z));
  const DVec3 in_box = point_to_frame(entry.frame(), point);
  if (entry.is_liquid())
    out = {probe_liquid(entry.liquid, in_box, entry.liquid_def().density).velocity,
           entry.liquid_def().density, true, edge};
  else
    out = {gas_velocity(entry.gas, in_box), entry.gas_def().density, false, edge};
  out.velocity = velocity_to_world(entry.frame(), point, out.velocity);
  return true;
}

int find_fluid(const FluidStore& fluids, DVec3 point) {
  int found = -1;
  for (std::size_t slot = 0; slot < fluids.entries.size(); ++slot) {
    const FluidEntry& entry = fluids.entries[slot];
    if (entry.def == nullptr) continue;
    const DVec3 in_box = point_to_frame(entry.frame(), point);
    if (!is_within(entry.box(), in_box)) continue;
    if (entry.is_liquid()) {
      if (is_in_liquid(entry.liquid, in_box)) return int(slot);
    } else if (found < 0) {
      found = int(slot);
    }
  }
  return found;
}

}  // namespace gyre
