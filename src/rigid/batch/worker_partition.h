// Which worker begins with which bodies and contacts of a batch. What one core has written comes to another slower than it is worked
// on, so where contacts are solved and bodies are moved, which is done many times in a step, the same bodies go to the same worker, and
// contacts to the worker that has their second body.
//
// Bodies are cut by their numbers, not by where they are: a core fetches ahead what lies behind in memory, and so takes it from the
// other wherever it comes to an end. Cut across space, bodies of both lie side by side everywhere.
//
// In: the pairs of bodies in contact. Out: for each body the number of a worker. Only the time that a step takes depends on it.
#pragma once

#include "base/arena/arena.h"
#include "task/coloring.h"
#include "task/spin.h"
#include "task/task_system.h"

#include <cstdint>
#include <span>

namespace gyre {

// Without threads there is one, which compilers see.
constexpr int kMaxPartitions = GYRE_HAS_THREADS ? TaskSystem::kMaxWorkers : 1;

struct WorkerPartition {
  int workers = 1;
  // By place in the batch, ascending. Empty where there is one domain only.
  std::span<const std::uint8_t> of_body;

  int count() const { return kMaxPartitions == 1 ? 1 : workers; }
  int of(std::uint32_t place) const { return count() == 1 ? 0 : int(of_body[place]); }
  int of(const ColoringPair& pair) const { return of(second_of(pair)); }
  static std::uint32_t second_of(const ColoringPair& pair) {
    return pair.b != ColoringPair::kNone ? pair.b : pair.a;
  }
};

// Runs of bodies with about as many contacts each.
WorkerPartition partition_by_worker(std::span<const ColoringPair> pairs, std::size_t bodies, int workers,
                                    Arena& arena);

// The first block of each domain's share among blocks of `width` items, and then the number of blocks: Stage::bounds. `starts`: the first
// item of each domain.
void set_partition_bounds(std::span<const std::uint32_t> starts, std::uint32_t items, std::uint32_t width,
                          int* bounds);

}  // namespace gyre
