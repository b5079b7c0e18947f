// Divides the work of a step into batches of whole islands, so no body that moves is in two batches. Batches are solved one after the
// other, and each reuses the memory of the one before (contact blocks, colours, trees). A batch is small enough to stay in a core's cache.
//
// docs/decisions/memory.md has the measurements. In: awake contacts, joints and bodies. Out: lists of them by batch, each ascending. The
// batch of an island never changes a bit of its result.
#pragma once

#include "base/arena/arena.h"
#include "rigid/batch/solve_batch.h"
#include "task/task_system.h"

namespace gyre {

// Limits for the size of batches. An island larger than `most`, or than 1/`shares` of the total, gets its own batch. If fewer than `fewest`
// other batches are beside such an island, they are merged into its batch: similar constraints fill the same lanes, and no worker waits for
// another's batch.
struct BatchSize {
  std::uint32_t most = 0;  // manifolds and joints, and a quarter of one for each body
  std::uint32_t shares = 1;
  std::uint32_t fewest = 0;
};

// A single worker is as fast with twice the size, but the memory of a batch stays. Workers that solve batches in parallel finish together
// if each has some. Workers that share a batch meet after each colour, and need a larger one.
constexpr BatchSize batch_size(int workers, bool in_parallel) {
  if (workers == 1) return {512, 1, 2};
  const std::uint32_t count = std::uint32_t(workers);
  return in_parallel ? BatchSize{1024, 4 * count, count} : BatchSize{2048 * count, 1, 2};
}

struct IslandBatch : SolveBatch {
  bool is_small = false;  // no larger than a batch shall be, and one of several
};

struct IslandBatches {
  std::span<const IslandBatch> batches;
  // By body: its index in its batch's list; undefined for bodies in no batch.
  std::span<const std::uint32_t> local_index;
  int united = -1;  // the batch of the bodies that were to be in one; -1: there are none
};

// All lists are allocated in `arena`.
// `united`: awake bodies that soft matter couples; they and their islands are one batch.
IslandBatches find_batches(const RigidWorld& w, std::span<const std::uint32_t> united, Arena& arena, TaskSystem& tasks,
                           BatchSize size);

}  // namespace gyre
