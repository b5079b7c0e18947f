// Reading gases and liquids through World.
#include "base/float_mode.h"
#include "fluid/gas/gas_reading.h"
#include "fluid/liquid/liquid_reading.h"
#include "fluid/liquid/liquid_surface.h"
#include "fluid/store/fluid_builder.h"
#include "geometry/mass/submerged.h"
#include "math/rotation.h"
#include "world/fluid_commands.h"
#include "world/world_state.h"

#include <limits>

namespace gyre {

namespace {

// Readings may be asked for by several threads at once, so each brings its own worker.
struct Reading {
  FloatMode mode;
  TaskSystem tasks{1};
};

const FluidScratch* scratch_of(const WorldState& s, std::uint32_t slot) {
  return slot < s.fluid_scratch.size() ? &s.fluid_scratch[slot] : nullptr;
}

float cell_speed(const Array<float> (&velocity)[3], const GridShape& shape, int c) {
  const auto mean = [&](int axis) {
    return 0.5f * (velocity[axis][std::size_t(c)] + velocity[axis][std::size_t(c + shape.stride(axis))]);
  };
  return length(Vec3{mean(0), mean(1), mean(2)});
}

float value_of(const FluidEntry& entry, FluidField field, int c) {
  const std::size_t at = std::size_t(c);
  const bool is_liquid = entry.is_liquid();
  switch (field) {
    case FluidField::smoke:
      return is_liquid ? (entry.liquid.surface[at] < 0.0f ? 1.0f : 0.0f) : entry.gas.density[at];
    case FluidField::temperature:
      return is_liquid ? 0.0f : entry.gas.temperature[at];
    case FluidField::pressure:
      return is_liquid ? entry.liquid_def().density * entry.liquid.pressure[at]
                       : entry.gas_def().density * entry.gas.pressure[at];
    case FluidField::speed:
      return is_liquid ? cell_speed(entry.liquid.velocity, entry.liquid.shape, c)
                       : cell_speed(entry.gas.velocity, entry.gas.shape, c);
    case FluidField::fuel:
      return entry.burns() ? entry.gas.fuel[at] : 0.0f;
  }
  return 0.0f;
}

// The length of the box along an axis, m.
double length_along(const GasBox& box, int axis) {
  const float edge = axis == 0 ? box.cell.x : axis == 1 ? box.cell.y : box.cell.z;
  return double(box.cells[axis]) * double(edge);
}

// The height of the highest surface above or below a point of the world, for a box that is turned: along the line through the point, from above.
bool find_surface_along(const FluidEntry& entry, DVec3 point, double& height) {
  const LiquidGrid& liquid = entry.liquid;
  const DVec3 from = point_to_frame(entry.frame(), point) - liquid.box.corner;
  const DVec3 up = vector_to_frame(entry.frame(), DVec3{0, 1, 0});
  const double origin[3] = {from.x, from.y, from.z}, way[3] = {up.x, up.y, up.z};
  double low = -1.0e300, high = 1.0e300;
  for (int axis = 0; axis < 3; ++axis) {
    const double size = length_along(liquid.box, axis);
    if (way[axis] == 0.0) {
      if (origin[axis] < 0.0 || origin[axis] > size) return false;
      continue;
    }
    const double a = -origin[axis] / way[axis], b = (size - origin[axis]) / way[axis];
    low = max(low, min(a, b)), high = min(high, max(a, b));
  }
  if (!(low < high)) return false;
  const auto distance_at = [&](double t) {
    return double(sample_field(liquid.box, liquid.shape, liquid.surface.data(), -1, to_float(from + t * up)));
  };
  const double edge = double(min(liquid.box.cell.x, min(liquid.box.cell.y, liquid.box.cell.z)));
  const int steps = 1 + int(2.0 * (high - low) / edge);
  double above = distance_at(high), last = high;
  if (above <= 0.0) return height = point.y + high, true;
  for (int i = 1; i <= steps; ++i) {
    const double t = high + (low - high) * (double(i) / double(steps)), here = distance_at(t);
    if (here <= 0.0) {
      height = point.y + t + (last - t) * (here / (here - above));
      return true;
    }
    above = here, last = t;
  }
  return false;
}

// The height of the highest surface of a liquid in the column of a point of the world.
bool find_level(const FluidEntry& entry, DVec3 point, double& height) {
  if (entry.frame() != nullptr) return find_surface_along(entry, point, height);
  const LiquidProbe probe = probe_liquid(entry.liquid, point, entry.liquid_def().density);
  height = probe.surface;
  return probe.has_surface;
}

// The mean level of a liquid at eight places round a box; false if there is none at any of them.
bool level_beside(const FluidEntry& entry, const Aabb& box, double& level) {
  const LiquidGrid& liquid = entry.liquid;
  const DVec3 low(box.low), high(box.high), middle = 0.5 * (low + high);
  const double edge = double(liquid.box.cell.x);
  double sum = 0.0;
  int found = 0;
  for (int side = 0; side < 9; ++side) {
    const int x = side % 3 - 1, z = side / 3 - 1;
    if (x == 0 && z == 0) continue;
    const DVec3 at{middle.x + x * (0.5 * (high.x - low.x) + edge), middle.y,
                   middle.z + z * (0.5 * (high.z - low.z) + edge)};
    const DVec3 inside = at - liquid.box.corner;
    if (entry.frame() == nullptr &&
        (inside.x < 0.0 || inside.z < 0.0 || inside.x > liquid.box.cells[0] * edge ||
         inside.z > liquid.box.cells[2] * double(liquid.box.cell.z)))
      continue;
    double surface = 0.0;
    if (!find_level(entry, at, surface)) continue;
    sum += surface;
    ++found;
  }
  if (found == 0) return false;
  level = sum / double(found);
  return true;
}

double volume_below(const RigidWorld& w, std::uint32_t body, double level) {
  double sum = 0.0;
  for (const ShapeId id : w.bodies.shapes[body]) {
    const Shape& shape = w.shapes.colliders[id.index].shape;
    if (w.shapes.proxies[id.index].sensor || !is_convex(shape.kind)) continue;
    const Pose pose = origin_pose(w.bodies, body) * w.shapes.body_from_shape[id.index];
    const DVec3 up = rotate_inverse(to_double(pose.orientation), DVec3{0, 1, 0});
    sum += submerged_part(shape, up, level - pose.position.y).volume;
  }
  return sum;
}

template <class Def>
void put_frame(const FluidEntry& entry, Def& def) {
  const FluidFrame frame = entry.frame() != nullptr ? *entry.frame() : FluidFrame{};
  def.pose = frame.pose, def.linear_velocity = frame.velocity, def.angular_velocity = frame.angular_velocity;
}

LiquidTotals totals_of(const WorldState& s, const FluidEntry& entry) {
  return liquid_totals(entry.liquid, entry.liquid_def().density, s.rigid.settings.gravity, entry.frame());
}

}  // namespace

FluidLoad World::fluid_load(BodyId body) const {
  FluidLoad load;
  if (!exists(body)) return load;
  const FloatMode mode;
  const RigidWorld& w = state_->rigid;
  for (const FluidEntry& entry : state_->fluids.entries) {
    if (entry.def == nullptr) continue;
    for (const FluidPush& push : entry.pushes) {
      if (push.body != body.index) continue;
      load.force += push.force, load.torque += push.torque;
      if (!entry.is_liquid()) continue;
      Aabb box;
      bool any = false;
      for (const ShapeId id : w.bodies.shapes[body.index]) {
        const Aabb& one = w.shapes.proxies[id.index].fat_box;
        box = any ? Aabb{min(box.low, one.low), max(box.high, one.high)} : one;
        any = true;
      }
      double level = 0.0;
      if (any && level_beside(entry, box, level)) load.wet_volume += volume_below(w, body.index, level);
    }
  }
  return load;
}

bool World::exists(FluidId fluid) const { return is_fluid(*state_, fluid); }

std::size_t World::fluids(std::span<FluidId> out) const {
  const IdPool& ids = state_->fluids.ids;
  std::size_t count = 0;
  ids.for_each_live([&](std::uint32_t slot) {
    if (count < out.size()) out[count] = {slot, std::uint16_t(ids.generation(slot)), state_->number};
    ++count;
  });
  return count;
}

FluidInfo World::fluid_info(FluidId fluid) const {
  if (!exists(fluid)) return {};
  Reading reading;
  const FluidEntry& entry = state_->fluids.entries[fluid.index];
  FluidInfo info;
  info.kind = entry.kind();
  const GasBox& box = entry.box();
  info.cells = {box.cells[0], box.cells[1], box.cells[2]};
  info.lower = box.corner, info.cell = box.cell;
  if (const FluidFrame* const frame = entry.frame()) {
    info.pose = frame->pose;
    info.linear_velocity = frame->velocity, info.angular_velocity = frame->angular_velocity;
  }
  info.user_data = std::visit([](const auto& def) { return def.user_data; }, *entry.def);
  const GasSolids none;
  const FluidScratch* const scratch = scratch_of(*state_, fluid.index);
  const FluidSolids* cut = scratch != nullptr ? &scratch->solids : nullptr;
  FluidSolids own;
  if (entry.is_liquid() && (cut == nullptr || cut->window.box.cells[0] == 0)) {
    // No step has cut the cells of this liquid yet.
    find_near_shapes(state_->rigid, entry, own);
    cut_fluid_cells(state_->rigid, entry, whole_window(box), reading.tasks, own);
    cut = &own;
  }
  const GasSolids& solids = cut != nullptr ? cut->solids : none;
  if (entry.is_liquid()) {
    const LiquidTotals totals = totals_of(*state_, entry);
    info.particles = entry.liquid.particles();
    info.kinetic_energy = totals.kinetic_energy;
    const FluidWindow* const window = solids.present() ? &cut->window : nullptr;
    info.volume = liquid_volume(entry.liquid, solids, window);
  } else {
    info.kinetic_energy = gas_kinetic_energy(entry.gas, solids, entry.gas_def().density, reading.tasks);
    info.smoke_mass = smoke_mass(entry.gas, solids, reading.tasks);
    const CellBox cells = entry.gas.cells();
    for (std::size_t axis = 0; axis < 3; ++axis) {
      info.active_first[axis] = cells.low[axis];
      info.active_cells[axis] = cells.high[axis] - cells.low[axis];
    }
    if (entry.burns()) info.fuel_mass = field_mass(entry.gas, entry.gas.fuel, solids, reading.tasks);
  }
  if (scratch == nullptr) return info;
  info.substeps = scratch->report.substeps, info.iterations = scratch->report.iterations;
  info.divergence = scratch->report.divergence, info.residual = scratch->report.residual;
  info.heat_rate = scratch->report.heat_rate;
  return info;
}

FluidProbe World::probe(FluidId fluid, DVec3 point) const {
  FluidProbe out;
  out.surface = std::numeric_limits<float>::quiet_NaN();
  if (!exists(fluid) || !is_finite(point)) return out;
  const FloatMode mode;
  const FluidEntry& entry = state_->fluids.entries[fluid.index];
  const FluidFrame* const frame = entry.frame();
  const DVec3 in_box = point_to_frame(frame, point);
  if (entry.is_liquid()) {
    const LiquidProbe probe = probe_liquid(entry.liquid, in_box, entry.liquid_def().density);
    out.velocity = velocity_to_world(frame, point, probe.velocity), out.pressure = probe.pressure;
    out.density = probe.inside ? 1.0f : 0.0f;
    double surface = probe.surface;
    if (frame != nullptr ? find_level(entry, point, surface) : probe.has_surface)
      out.surface = float(surface);
    return out;
  }
  const GasProbe probe = probe_gas(entry.gas, in_box, entry.gas_def().density,
                                   vector_to_frame(frame, state_->rigid.settings.gravity));
  out.velocity = velocity_to_world(frame, point, probe.velocity), out.pressure = probe.pressure;
  out.density = probe.density, out.temperature = probe.temperature, out.fuel = probe.fuel;
  return out;
}

void World::sample_velocity(FluidId fluid, std::span<const DVec3> points, std::span<Vec3> out) const {
  if (!exists(fluid)) return;
  const FloatMode mode;
  const FluidEntry& entry = state_->fluids.entries[fluid.index];
  for (std::size_t n = 0; n < min(points.size(), out.size()); ++n) {
    const DVec3 in_box = point_to_frame(entry.frame(), points[n]);
    const Vec3 velocity = entry.is_liquid()
                              ? probe_liquid(entry.liquid, in_box, entry.liquid_def().density).velocity
                              : gas_velocity(entry.gas, in_box);
    out[n] = velocity_to_world(entry.frame(), points[n], velocity);
  }
}

std::size_t World::fluid_field(FluidId fluid, FluidField field, std::span<float> out) const {
  if (!exists(fluid)) return 0;
  const FloatMode mode;
  const FluidEntry& entry = state_->fluids.entries[fluid.index];
  const GridShape& shape = entry.shape();
  const GasBox& box = entry.box();
  CellBox cells = whole_window(box).cells();
  if (!entry.is_liquid()) cells = entry.gas.cells();
  // Beyond the window of a gas the air is at rest.
  const float rest =
      field == FluidField::temperature && !entry.is_liquid() ? entry.gas.ambient_temperature : 0.0f;
  std::size_t n = 0;
  for (int k = 0; k < box.cells[2]; ++k) {
    for (int j = 0; j < box.cells[1]; ++j) {
      const bool has_row = k >= cells.low[2] && k < cells.high[2] && j >= cells.low[1] && j < cells.high[1];
      const int row = shape.row(j - cells.low[1], k - cells.low[2]) - cells.low[0];
      for (int i = 0; i < box.cells[0] && n < out.size(); ++i) {
        const bool has_cell = has_row && i >= cells.low[0] && i < cells.high[0];
        out[n++] = has_cell ? value_of(entry, field, row + i) : rest;
      }
    }
  }
  return std::size_t(box.cells[0]) * std::size_t(box.cells[1]) * std::size_t(box.cells[2]);
}

GasDef World::gas_def(FluidId fluid) const {
  if (!exists(fluid) || state_->fluids.entries[fluid.index].kind() != FluidKind::gas) return {};
  const FluidEntry& entry = state_->fluids.entries[fluid.index];
  GasDef def = entry.gas_def();
  def.emitters = emitter_defs(entry);
  put_frame(entry, def);
  def.fields = copy_fields(entry.gas);
  return def;
}

std::size_t World::liquid_particles(FluidId fluid, std::span<DVec3> positions,
                                    std::span<Vec3> velocities) const {
  if (!exists(fluid) || !state_->fluids.entries[fluid.index].is_liquid()) return 0;
  const LiquidGrid& grid = state_->fluids.entries[fluid.index].liquid;
  const FluidFrame* const frame = state_->fluids.entries[fluid.index].frame();
  const std::size_t count = std::size_t(grid.particles());
  const auto place = [&](std::size_t i) {
    return point_to_world(frame,
                          grid.box.corner + DVec3{double(grid.position[0][i]), double(grid.position[1][i]),
                                                  double(grid.position[2][i])});
  };
  for (std::size_t i = 0; i < min(count, positions.size()); ++i) positions[i] = place(i);
  for (std::size_t i = 0; i < min(count, velocities.size()); ++i) {
    const Vec3 velocity{grid.motion[0][i], grid.motion[1][i], grid.motion[2][i]};
    velocities[i] = frame == nullptr ? velocity : velocity_to_world(frame, place(i), velocity);
  }
  return count;
}

FluidSurfaceSize World::liquid_surface(FluidId fluid, std::span<Vec3> vertices,
                                       std::span<std::uint32_t> indices) const {
  if (!exists(fluid) || !state_->fluids.entries[fluid.index].is_liquid()) return {};
  const FloatMode mode;
  const LiquidGrid& grid = state_->fluids.entries[fluid.index].liquid;
  const FluidFrame* const frame = state_->fluids.entries[fluid.index].frame();
  Array<Vec3> found;
  Array<std::uint32_t> corners;
  find_surface_mesh(grid, found, corners);
  const Vec3 corner = to_float(grid.box.corner);
  for (std::size_t i = 0; i < min(found.size(), vertices.size()); ++i)
    vertices[i] = frame == nullptr ? corner + found[i]
                                   : to_float(point_to_world(frame, grid.box.corner + DVec3(found[i])));
  for (std::size_t i = 0; i < min(corners.size(), indices.size()); ++i) indices[i] = corners[i];
  return {found.size(), corners.size()};
}

LiquidDef World::liquid_def(FluidId fluid) const {
  if (!exists(fluid) || !state_->fluids.entries[fluid.index].is_liquid()) return {};
  const FluidEntry& entry = state_->fluids.entries[fluid.index];
  LiquidDef def = entry.liquid_def();
  def.emitters = emitter_defs(entry);
  put_frame(entry, def);
  // Particles may be anywhere in the whole cells of the box.
  const GasBox& box = entry.liquid.box;
  const double size = double(def.cell_size);
  def.upper = def.lower + size * DVec3{double(box.cells[0]), double(box.cells[1]), double(box.cells[2])};
  def.particles = copy_particles(entry.liquid);
  return def;
}

void add_fluid_energy(const WorldState& s, Energy& energy) {
  s.fluids.for_each([&](const FluidEntry& entry) {
    if (!entry.is_liquid()) return;
    const LiquidTotals totals = totals_of(s, entry);
    energy.kinetic += totals.kinetic_energy, energy.potential += totals.potential_energy;
  });
}
void add_fluid_momentum(const WorldState& s, Momentum& momentum) {
  s.fluids.for_each([&](const FluidEntry& entry) {
    if (!entry.is_liquid()) return;
    const LiquidTotals totals = totals_of(s, entry);
    momentum.linear += totals.momentum, momentum.angular += totals.angular_momentum;
  });
}

const char* to_string(FluidKind kind) { return kind == FluidKind::gas ? "gas" : "liquid"; }
const char* to_string(FluidBoundary boundary) {
  switch (boundary) {
    case FluidBoundary::periodic:
      return "periodic";
    case FluidBoundary::open:
      return "open";
    case FluidBoundary::closed:
      return "closed";
    case FluidBoundary::no_slip:
      return "no_slip";
  }
  return "unknown";
}
const char* to_string(Advection advection) {
  return advection == Advection::maccormack ? "maccormack" : "semi_lagrangian";
}
const char* to_string(FluidField field) {
  switch (field) {
    case FluidField::smoke:
      return "smoke";
    case FluidField::temperature:
      return "temperature";
    case FluidField::pressure:
      return "pressure";
    case FluidField::speed:
      return "speed";
    case FluidField::fuel:
      return "fuel";
  }
  return "unknown";
}

}  // namespace gyre
