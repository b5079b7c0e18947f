// Commands as bytes: the number of the alternative, then its fields. The world's number is left out of ids, since a replay
// runs in another world; cooked geometry is named by its content hash.
#pragma once

#include "base/function_ref.h"
#include "io/codec/geometry_codec.h"
#include "world/command.h"

namespace gyre {

// Counts the changes of what commands look like as bytes.
constexpr std::uint64_t kCommandLayout = 1;

void write_command(ByteWriter& out, const Command& command);

// The next command, its ids those of the world with this number. Fails the reader if there is none.
Command read_command(ByteReader& in, const GeometryTable& geometry, std::uint16_t world_number);

// Calls fn for each piece of geometry that the command brings along.
void for_each_shape(const Command& command, FunctionRef<void(const AnyShape&)> fn);

}  // namespace gyre
