// Gases and liquids as bytes: generations of ids, then for each of them its definition and the arrays that a step changes,
// then the arrays that older versions lacked. A reader checks the
// definition as a command does, builds it, and checks that the arrays fit.
#pragma once

#include "fluid/store/fluid_store.h"
#include "io/codec/bytes.h"

namespace gyre {

void write_fluids(ByteWriter& out, const FluidStore& fluids);
// False if the bytes are none; references to bodies are checked later.
bool read_fluids(ByteReader& in, FluidStore& fluids);

}  // namespace gyre
