// Reading gases and liquids through World.
#include "base/float_mode.h"
#include "fluid/gas/gas_reading.h"
#include "fluid/store/fluid_builder.h"
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

float cell_speed(const GasGrid& gas, int c) {
  Vec3 mean;
  mean.x = 0.5f * (gas.velocity[0][std::size_t(c)] + gas.velocity[0][std::size_t(c + 1)]);
  mean.y = 0.5f * (gas.velocity[1][std::size_t(c)] + gas.velocity[1][std::size_t(c + gas.shape.pitch)]);
  mean.z = 0.5f * (gas.velocity[2][std::size_t(c)] + gas.velocity[2][std::size_t(c + gas.shape.plane)]);
  return length(mean);
}

float value_of(const FluidEntry& entry, FluidField field, int c) {
  const std::size_t at = std::size_t(c);
  switch (field) {
    case FluidField::smoke:
      return entry.gas.density[at];
    case FluidField::temperature:
      return entry.gas.temperature[at];
    case FluidField::pressure:
      return entry.gas_def().density * entry.gas.pressure[at];
    case FluidField::speed:
      return cell_speed(entry.gas, c);
  }
  return 0.0f;
}

}  // namespace

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
  const GasBox& box = entry.gas.box;
  info.cells = {box.cells[0], box.cells[1], box.cells[2]};
  info.lower = box.corner, info.cell = box.cell;
  info.user_data = entry.gas_def().user_data;
  const GasSolids none;
  const FluidScratch* const scratch = scratch_of(*state_, fluid.index);
  const GasSolids& solids = scratch != nullptr ? scratch->solids.solids : none;
  info.kinetic_energy = gas_kinetic_energy(entry.gas, solids, entry.gas_def().density, reading.tasks);
  info.smoke_mass = smoke_mass(entry.gas, solids, reading.tasks);
  if (scratch == nullptr) return info;
  info.substeps = scratch->report.substeps, info.iterations = scratch->report.iterations;
  info.divergence = scratch->report.divergence, info.residual = scratch->report.residual;
  return info;
}

FluidProbe World::probe(FluidId fluid, DVec3 point) const {
  FluidProbe out;
  out.surface = std::numeric_limits<float>::quiet_NaN();
  if (!exists(fluid) || !is_finite(point)) return out;
  const FloatMode mode;
  const FluidEntry& entry = state_->fluids.entries[fluid.index];
  const GasProbe probe = probe_gas(entry.gas, point, entry.gas_def().density, state_->rigid.settings.gravity);
  out.velocity = probe.velocity, out.pressure = probe.pressure;
  out.density = probe.density, out.temperature = probe.temperature;
  return out;
}

void World::sample_velocity(FluidId fluid, std::span<const DVec3> points, std::span<Vec3> out) const {
  if (!exists(fluid)) return;
  const FloatMode mode;
  const GasGrid& gas = state_->fluids.entries[fluid.index].gas;
  for (std::size_t n = 0; n < min(points.size(), out.size()); ++n) out[n] = gas_velocity(gas, points[n]);
}

std::size_t World::fluid_field(FluidId fluid, FluidField field, std::span<float> out) const {
  if (!exists(fluid)) return 0;
  const FloatMode mode;
  const FluidEntry& entry = state_->fluids.entries[fluid.index];
  const GridShape& shape = entry.gas.shape;
  std::size_t n = 0;
  for (int k = 0; k < shape.cells[2]; ++k) {
    for (int j = 0; j < shape.cells[1]; ++j) {
      for (int i = 0; i < shape.cells[0] && n < out.size(); ++i)
        out[n++] = value_of(entry, field, shape.at(i, j, k));
    }
  }
  return std::size_t(shape.count());
}

GasDef World::gas_def(FluidId fluid) const {
  if (!exists(fluid) || state_->fluids.entries[fluid.index].kind() != FluidKind::gas) return {};
  const FluidEntry& entry = state_->fluids.entries[fluid.index];
  GasDef def = entry.gas_def();
  def.emitters.clear();
  for (const GasEmitter& emitter : entry.emitters) def.emitters.push_back(emitter_def(emitter));
  def.fields = copy_fields(entry.gas);
  return def;
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
  }
  return "unknown";
}

}  // namespace gyre
