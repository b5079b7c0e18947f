// The stages of a step that work on rigid bodies; world/step.cpp lists them. Each is a function from arrays to
// arrays.
#pragma once

#include "base/arena/arena.h"
#include "collision/continuous/continuous.h"
#include "rigid/store/rigid_world.h"
#include "solver/kernels/solver_kernels.h"
#include "task/task_system.h"

namespace gyre {

// Memory of the stage clamp_fast_bodies. Its contents last for one step.
struct ContinuousScratch {
  Array<FastBody> fast;
  Array<SavedMotion> saved;
  Array<std::uint32_t> found;
  Bitset listed;
  Bitset near_blockers;  // by shape
  ContinuousCollision collision;
  Array<GatePair> gates;
  Array<std::uint32_t> moved;  // bodies that joints move after CCD
};

// Sorts a list of changed proxies and removes repeats. `keys` and `scratch` are working memory.
void sort_changed(Array<std::uint32_t>& changed, Array<std::uint64_t>& keys, Array<std::uint64_t>& scratch);
// Updates the broad phase with new, removed and refitted proxies. A command does not know the length of the step, so
// the fat boxes of shapes that it placed or set moving are extended by their motion here. If the step is longer than
// the last, all fat boxes are checked.
void refit(RigidWorld& w, TaskSystem& tasks, float seconds);
// Makes contacts of new pairs of fat boxes, in the order of their keys. Returns the number of pairs that the broad
// phase reported.
std::size_t find_pairs(RigidWorld& w, TaskSystem& tasks);
// The narrow phase: updates the manifolds of all active contacts and finds which contacts began, ended or are gone.
void collide_pairs(RigidWorld& w, Arena& arena, TaskSystem& tasks, RecycleContacts recycle_contacts,
                   float seconds);
// Reports begun and ended touches, removes contacts whose fat boxes separated, and wakes bodies that awake bodies
// touch.
void link_islands(RigidWorld& w);
// Applies the motion of the step to poses, inertia and fat boxes of awake bodies. Bodies whose state is not finite
// are frozen; their slots are appended to `frozen`. `last` is false if only a piece of the step is done: then the
// user's forces stay.
void finish_bodies(RigidWorld& w, Arena& arena, TaskSystem& tasks, float seconds,
                   Array<std::uint32_t>& frozen, bool last = true);
// Reports joints whose force or torque exceeded their limit.
void break_joints(RigidWorld& w, float seconds);

// Continuous collision: moves each fast body back to its first impact with a blocker.
void clamp_fast_bodies(RigidWorld& w, ContinuousScratch& scratch, const SolverKernels& kernels, Arena& arena,
                       TaskSystem& tasks);

// Fits a new fat box around one shape, extended by its motion in a step of this length, and lists it as changed.
void refit_shape(RigidWorld& w, std::uint32_t shape, float seconds);
// A command changed the velocity of the body. The next step checks its fat boxes.
void mark_moved(RigidWorld& w, std::uint32_t body);
// Fits a fat box without motion around a shape that a command placed. The next step adds its motion.
void refit_placed_shape(RigidWorld& w, std::uint32_t shape);
// Reports the end of touch of a contact that is about to be removed.
void report_end(RigidWorld& w, const Contact& contact);

}  // namespace gyre
