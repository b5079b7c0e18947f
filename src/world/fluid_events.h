// Events of fluids: which bodies and which soft matter entered and left them in a step.
//
// In: fluids, shapes and vertices at the end of the step, the visitors of the step before. Out: FluidStore::events and the visitors. These are state,
// so a world that goes on from a snapshot reports the same.
#pragma once

#include <cstdint>

namespace gyre {

struct WorldState;

// After the step: adds the events, and publishes them.
void report_fluid_events(WorldState& s);
// All visitors of a fluid that is about to be removed leave.
void end_fluid_touches(WorldState& s, std::uint32_t slot);

}  // namespace gyre
