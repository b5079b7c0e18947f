// Events of soft matter: what tore, which shapes it began and ceased to touch, and which of its tetrahedra were turned inside out, in a step.
//
// In: contacts and vertices before and after the step. Out: SoftStore::events. A contact touches if it overlaps or bears load, so all follows from the
// state of two steps, and a world that goes on from a snapshot reports the same.
#pragma once

#include <cstdint>

namespace gyre {

struct SoftEntry;
struct WorldState;

// Before anything of a step changes.
void note_soft_before(WorldState& s);
// Lets solids flow by what they bore in the `seconds` before, and tears what was strained too far. Before contacts are found.
void damage_soft(WorldState& s, float seconds);
// After the step: adds the events, and publishes them.
void report_soft_events(WorldState& s);

// Contacts of soft matter that a command drops end. All shapes of one entry, or one shape of all entries.
void end_soft_touches(WorldState& s, std::uint32_t slot);
void drop_soft_contacts(WorldState& s, std::uint32_t shape);

}  // namespace gyre
