// Makes the entry of a gas or liquid from its definition, which is checked first. A pure function: the same definition gives the same bits.
#pragma once

#include "fluid/gas/gas_window.h"
#include "fluid/store/fluid_store.h"

#include <gyre/result.h>

#include <span>

namespace gyre {

constexpr std::int64_t kMaxFluidCells = 1 << 24;  // of one fluid
constexpr int kMaxLiquidParticles = 1 << 22;      // of one liquid

// Says why a definition is refused; code none if it is not. The message names the field, what was found and what is expected.
Error check_fluid(const GasDef& def);
Error check_fluid(const LiquidDef& def);
Error check_frame(const Pose& pose, Vec3 linear_velocity, Vec3 angular_velocity);
Error check_emitters(std::span<const FluidEmitter> emitters, DVec3 lower, DVec3 upper);

// Cells of its box. The definition must have passed its check.
std::int64_t count_cells(const FluidDef& def);

// rest: without the fields of the definition, for whoever replaces them.
enum class FluidStart : std::uint8_t { definition, rest };
// The definition must have passed its check. A liquid has no particles yet: see fill_liquid.
FluidEntry build_fluid(std::shared_ptr<const FluidDef> def, FluidStart start = FluidStart::definition);
// The particles of the definition of a liquid, but for places within solids. Returns false, and leaves some out, if there are too many.
// `solids` are those of the whole box; `cut` makes them those of a window.
bool fill_liquid(FluidEntry& entry, const GasSolids& solids, FunctionRef<void(const FluidWindow&)> cut);
// Makes the box of the arrays that of the window that was read from a file. False if it is no window of the gas.
bool restore_window(FluidEntry& entry);
// True if the arrays of an entry that was read from a file can be those of its definition.
bool fits_definition(const FluidEntry& entry);
void set_emitters(FluidEntry& entry, std::span<const FluidEmitter> emitters);
std::vector<FluidEmitter> emitter_defs(const FluidEntry& entry);

// The fields of a gas, the particles of a liquid, as a definition holds them.
GasFields copy_fields(const GasGrid& grid);
LiquidParticles copy_particles(const LiquidGrid& grid);

}  // namespace gyre
