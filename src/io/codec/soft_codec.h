// Ropes, cloths and solids as bytes: generations of ids, then for each of them its definition and the arrays that a step changes. A reader
// checks the definition as a command does, builds it, and checks that the arrays fit.
#pragma once

#include "io/codec/bytes.h"
#include "soft/store/soft_store.h"

namespace gyre {

void write_soft(ByteWriter& out, const SoftStore& soft);
// False if the bytes are none; references to bodies are checked later.
bool read_soft(ByteReader& in, SoftStore& soft);

}  // namespace gyre
