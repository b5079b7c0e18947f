// Queries for commands, by those of world_query.cpp: line of sight, and what a placed body overlaps.
#pragma once

#include <gyre/math.h>

#include <cstdint>

namespace gyre {

struct WorldState;

// Updates the broad phase with changes since its last update, for queries between steps. The first query does it for all.
void show_changes(WorldState& state);

// True if only shapes of the body itself and sensors are between the two points. A shape that contains the start does
// not hide anything.
bool is_in_sight(WorldState& state, DVec3 from, DVec3 to, std::uint32_t body);

// Wakes sleeping bodies that the shapes of a fixed or kinematic body overlap or touch, after a command placed it or changed what it
// collides with, and sleeping soft matter in their boxes. (Dynamic bodies are awake after such commands and wake what they touch.)
void wake_overlapped(WorldState& state, std::uint32_t body);

}  // namespace gyre
