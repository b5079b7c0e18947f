// Parts the work of a step into batches that are solved one after the other: each holds whole islands, so no body that moves
// is in two of them, and what a batch needs while it is solved (contacts side by side, colours, trees) is memory that the
// next one uses again. A batch is small enough to stay in a core's cache.
//
// In: contacts, joints and bodies that are awake. Out: lists of them by batch, each ascending. Which batch an island is in
// never changes a bit of it.
#pragma once

#include "base/arena.h"
#include "rigid/rigid_world.h"
#include "task/task_system.h"

namespace gyre {

// Manifolds and joints in a batch; an island that has more is a batch of its own. Workers that meet after each colour of a
// batch need more of it to do in between.
constexpr std::uint32_t batch_size(int workers) { return workers == 1 ? 512u : 2048u * std::uint32_t(workers); }

struct SolveBatch {
  std::span<const std::uint32_t> bodies;  // awake: dynamic, and kinematic ones
  std::span<const std::uint32_t>
      contacts;                           // slots; with manifolds, and one of the two bodies is moved by them
  std::span<const std::uint32_t> joints;  // slots
};

struct SolveBatches {
  std::span<const SolveBatch> batches;
  // By body: its place in its batch's list of bodies; meaningless for those that are in none.
  std::span<const std::uint32_t> places;
};

// Whether constraints move the body: dynamic, awake, not frozen.
inline bool is_active(const RigidWorld& w, std::uint32_t body) {
  const BodyFlags& flags = w.bodies.flags[body];
  return flags.awake != 0 && is_movable(flags);
}

// Whether constraints are made of the contact.
bool is_solved(const RigidWorld& w, const Contact& contact);
bool is_joint_solved(const RigidWorld& w, std::uint32_t slot);

// All lists are of `arena`. `size`: batch_size().
SolveBatches find_batches(const RigidWorld& w, Arena& arena, TaskSystem& tasks, std::uint32_t size);

}  // namespace gyre
