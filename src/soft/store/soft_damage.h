// Tearing of cloths, fracture and flow of solids. Between steps.
//
// A cloth tears where an edge is strained beyond its limit: one end of the edge is split by the plane across it. A solid breaks where the mean stress of
// the tetrahedra around a vertex has a tension beyond the limit: the vertex is split by the plane across that tension (J. O'Brien, J. Hodgins,
// "Graphical Modeling and Animation of Brittle Fracture", 1999; here the parts are whole elements, so cracks follow edges and faces). The greatest
// excess goes first, equal ones by their numbers. Elements around a vertex that was split wait for the next step, so a crack runs on at its tip.
//
// New vertices have the velocity of the old one and a share of its mass, rounded so that the sum is exactly that of before. They move apart by the
// gap that surfaces keep, about their common centre of mass: linear and angular momentum stay. Parts of a vertex that is held move away from the part
// that stays held.
//
// A solid flows where the stress of von Mises exceeds the yield stress: F = Fe Fp, and Fp takes up a share of the deviator of ln Fe, at constant volume
// (J. Simo, 1992). Each tetrahedron keeps P = Fp^-1; its rest shape is Dm^-1 P.
//
// In: an entry after a step. Out: the same, with more vertices or other rest shapes.
#pragma once

#include "soft/store/soft_store.h"
#include "task/task_system.h"

namespace gyre {

struct SoftSplit {
  std::uint32_t vertex = 0, made = 0;
};

// Sets up what a definition that tears, breaks or flows needs; after the body is built.
void begin_damage(SoftEntry& entry);
// Builds the elements anew from damage that was read: particles beyond those of the definition are at the origin. False if the damage does not fit
// the definition.
bool rebuild_damaged(SoftEntry& entry);

// Starts the flow of a solid that yields, and builds its rest shapes anew after its elements.
void begin_flow(SoftEntry& entry);
void renew_flow(SoftEntry& entry);

// Appends what was split.
void tear_soft(SoftEntry& entry, TaskSystem& tasks, Array<SoftSplit>& out);
// `seconds`: since it was last called.
void flow_soft(SoftEntry& entry, float seconds, TaskSystem& tasks);

}  // namespace gyre
