// Makes the entry of a gas from its definition, which is checked first. A pure function: the same definition gives the same bits.
#pragma once

#include "fluid/store/fluid_store.h"

#include <gyre/result.h>

#include <span>

namespace gyre {

constexpr std::int64_t kMaxFluidCells = 1 << 24;  // of one fluid

// Says why a definition is refused; code none if it is not. The message names the field, what was found and what is expected.
Error check_fluid(const GasDef& def);
Error check_emitters(std::span<const FluidEmitter> emitters, DVec3 lower, DVec3 upper);

// The definition must have passed its check.
FluidEntry build_fluid(std::shared_ptr<const FluidDef> def);
GasEmitter make_emitter(const FluidEmitter& emitter);
FluidEmitter emitter_def(const GasEmitter& emitter);

// The fields of a gas as a definition holds them.
GasFields copy_fields(const GasGrid& grid);

}  // namespace gyre
