// Commands as bytes: the number of the alternative, then its fields. Ids are stored without the number of the world,
// since a replay runs in another one. Cooked geometry is named by its content hash.
#pragma once

#include "base/function_ref.h"
#include "io/codec/geometry_codec.h"
#include "world/command.h"

namespace gyre {

// The version of the byte format of commands.
constexpr std::uint64_t kCommandLayout = 1;

void write_command(ByteWriter& out, const Command& command);

// Reads the next command; its ids get the given number of the world. The reader fails if there is none.
Command read_command(ByteReader& in, const GeometryTable& geometry, std::uint16_t world_number);

// Calls fn for each shape in the command.
void for_each_shape(const Command& command, FunctionRef<void(const AnyShape&)> fn);

// The definition of a rope, cloth or solid.
void write_soft_def(ByteWriter& out, const SoftDef& def);
std::shared_ptr<const SoftDef> read_soft_def(ByteReader& in);
// The definition of a fluid.
void write_fluid_def(ByteWriter& out, const FluidDef& def);
std::shared_ptr<const FluidDef> read_fluid_def(ByteReader& in);

}  // namespace gyre
