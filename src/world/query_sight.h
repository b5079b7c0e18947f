// Lines of sight for commands: the queries of world_query.cpp, asked from inside.
#pragma once

#include <gyre/math.h>

#include <cstdint>

namespace gyre {

struct WorldState;

// Whether nothing stands between the two points but shapes of the body itself and sensors. What a line starts inside of does
// not hide anything.
bool is_in_sight(WorldState& state, DVec3 from, DVec3 to, std::uint32_t body);

}  // namespace gyre
