// Decides which worker begins with which bodies and contacts of a batch. Data that one core has written comes slowly to another. Contacts
// are solved and bodies move many times in a step, so the same bodies go to the same worker, and contacts to the worker of their second
// body.
//
// Bodies are divided by index, not by position. A core prefetches the memory after its own, and takes it from another core where their
// ranges meet. With a division by position they would meet everywhere.
//
// In: the pairs of bodies in contact. Out: the number of a worker for each body. Only the time of a step depends on it.
#pragma once

#include "base/arena/arena.h"
#include "task/coloring.h"
#include "task/spin.h"
#include "task/task_system.h"

#include <cstdint>
#include <span>

namespace gyre {

// Without threads this is a compile-time 1.
constexpr int kMaxShares = GYRE_HAS_THREADS ? TaskSystem::kMaxWorkers : 1;

struct WorkerPartition {
  int workers = 1;
  // By index in the batch, ascending; empty if there is one share.
  std::span<const std::uint8_t> of_body;

  int count() const { return kMaxShares == 1 ? 1 : workers; }
  int of(std::uint32_t place) const { return count() == 1 ? 0 : int(of_body[place]); }
  int of(const ColoringPair& pair) const { return of(second_of(pair)); }
  static std::uint32_t second_of(const ColoringPair& pair) {
    return pair.b != ColoringPair::kNone ? pair.b : pair.a;
  }
};

// Divides the bodies into consecutive ranges with about as many contacts each.
WorkerPartition partition_bodies(std::span<const ColoringPair> pairs, std::size_t bodies, int workers,
                                 Arena& arena);

// Writes the first block of each share among blocks of `width` items, and then the number of blocks: Stage::bounds. `starts`: the first
// item of each share.
void find_share_bounds(std::span<const std::uint32_t> starts, std::uint32_t items, std::uint32_t width,
                       int* bounds);

}  // namespace gyre
