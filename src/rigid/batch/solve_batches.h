// Parts the work of a step into batches that are solved one after the other: each holds whole islands, so no body that moves
// is in two of them, and what a batch needs while it is solved (contacts side by side, colours, trees) is memory that the
// next one uses again. A batch is small enough to stay in a core's cache.
//
// In: contacts, joints and bodies that are awake. Out: lists of them by batch, each ascending. Which batch an island is in
// never changes a bit of it.
#pragma once

#include "base/arena/arena.h"
#include "rigid/store/rigid_world.h"
#include "task/task_system.h"

namespace gyre {

// How much is in a batch. An island that has more than `most` is a batch of its own, and so is what is more than a share of all
// where `shares` says in how many it is to be parted at least. Where there are fewer than `fewest` others beside such an island, they
// go along with it: what is alike fills the same lanes, and no worker waits for another's batch.
struct BatchSize {
  std::uint32_t most = 0;  // manifolds and joints, and a quarter of one for each body
  std::uint32_t shares = 1;
  std::uint32_t fewest = 0;
};

// Alone a worker is as fast with twice as much, but a batch's memory stays. Workers that solve batches side by side come out even
// if there are some for each; those that meet after each colour of one need more of it to do in between.
constexpr BatchSize batch_size(int workers, bool run_parallel) {
  if (workers == 1) return {512, 1, 2};
  const std::uint32_t count = std::uint32_t(workers);
  return run_parallel ? BatchSize{1024, 4 * count, count} : BatchSize{2048 * count, 1, 2};
}

struct SolveBatch {
  std::span<const std::uint32_t> bodies;  // awake: dynamic, and kinematic ones
  std::span<const std::uint32_t>
      contacts;                           // slots; with manifolds, and one of the two bodies is moved by them
  std::span<const std::uint32_t> joints;  // slots
  bool is_small = false;                  // not more than a batch is to be, and one of several
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

// All lists are of `arena`.
SolveBatches find_batches(const RigidWorld& w, Arena& arena, TaskSystem& tasks, BatchSize size);

}  // namespace gyre
