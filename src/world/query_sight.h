// Line of sight for commands, by the queries of world_query.cpp.
#pragma once

#include <gyre/math.h>

#include <cstdint>

namespace gyre {

struct WorldState;

// True if only shapes of the body itself and sensors are between the two points. A shape that contains the start does
// not hide anything.
bool is_in_sight(WorldState& state, DVec3 from, DVec3 to, std::uint32_t body);

}  // namespace gyre
