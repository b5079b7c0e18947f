// The rigid half of a step, as stages that world/step.cpp lists. Each is a function from arrays to arrays.
#pragma once

#include "base/arena/arena.h"
#include "collision/continuous/continuous.h"
#include "rigid/store/rigid_world.h"
#include "solver/contact/contact_block.h"
#include "task/task_system.h"

namespace gyre {

// Kept from step to step only for its memory.
struct ContinuousScratch {
  Array<FastBody> fast;
  Array<SavedMotion> saved;
  Array<std::uint32_t> found;
  Bitset listed;
  Bitset near_stops;  // by shape
  ContinuousCollision collision;
  Array<GatePair> gates;
  Array<std::uint32_t> moved;  // bodies that follow others by joints
};

// A list of changed proxies, ascending and without repeats; the other two are scratch.
void sort_changed(Array<std::uint32_t>& changed, Array<std::uint64_t>& keys, Array<std::uint64_t>& scratch);
// Tells the broad phase what came, went or moved its fat box since the last step. Commands do not know how long the step will be:
// boxes of what they placed or set moving get its way here, and all do where the step is longer than the last.
void refit(RigidWorld& w, TaskSystem& tasks, float seconds);
// New pairs of fat boxes become contacts, in key order.
// Returns how many pairs of boxes the broad phase named.
std::size_t find_pairs(RigidWorld& w, TaskSystem& tasks);
// Looks at every contact that could have changed: manifolds in, touch changes out.
void collide_pairs(RigidWorld& w, Arena& arena, TaskSystem& tasks, RecycleContacts recycle_contacts,
                   float seconds);
// Events of touches; removes pairs that came apart; wakes what was touched.
void link_islands(RigidWorld& w);
// New places, poses, inertia and fat boxes of awake bodies; freezes bodies whose state is not finite. Returns how many
// were frozen (their slots are appended to `frozen`).
// `last`: forces that the user gave end with the step; false where only a part of it is done.
void finish_bodies(RigidWorld& w, Arena& arena, TaskSystem& tasks, float seconds,
                   Array<std::uint32_t>& frozen, bool last = true);
// Joints that bore more than they can break.
void break_joints(RigidWorld& w, float seconds);

// Sweeps bodies that moved far against what is in their way and takes them back to the first impact.
void clamp_fast_bodies(RigidWorld& w, ContinuousScratch& scratch, const ContactKernels& kernels, Arena& arena,
                       TaskSystem& tasks);

// Fits a new fat box around one shape, with its way in a step of this length, and lists it as changed.
void refit_shape(RigidWorld& w, std::uint32_t shape, float seconds);
// A command changed how the body moves: the coming step sees to its boxes.
void mark_moved(RigidWorld& w, std::uint32_t body);
// Fits a new fat box around what a command placed, with no way yet; the coming step sees to that.
void refit_placed_shape(RigidWorld& w, std::uint32_t shape);
// Removes one contact's traces: its end-of-touch event.
void report_end(RigidWorld& w, const Contact& contact);

}  // namespace gyre
