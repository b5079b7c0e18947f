// Where the work of a batch is cut between workers. See solve_domains.h.
#include "rigid/batch/worker_partition.h"

namespace gyre {

WorkerPartition partition_by_worker(std::span<const ColoringPair> pairs, std::size_t bodies, int workers,
                                    Arena& arena) {
  static_assert(kMaxPartitions <= 256, "domains are bytes");
  constexpr std::size_t kFewest = 256;  // with fewer contacts it is not worth while
  if (kMaxPartitions == 1 || workers == 1 || pairs.size() < kFewest) return {};
  const std::span<std::uint8_t> domains = arena.make<std::uint8_t>(bodies);
  const ArenaScope scope(arena);
  const std::span<std::uint32_t> contacts = arena.make<std::uint32_t>(bodies);
  for (std::uint32_t& count : contacts) count = 0;
  for (const ColoringPair& pair : pairs) ++contacts[WorkerPartition::second_of(pair)];
  std::size_t before = 0;
  for (std::size_t i = 0; i < bodies; ++i) {
    domains[i] = std::uint8_t(before * std::size_t(workers) / pairs.size());
    before += contacts[i];
  }
  // Behind the last contact.
  for (std::size_t i = bodies; i-- > 0 && int(domains[i]) == workers;) domains[i] = std::uint8_t(workers - 1);
  return {workers, domains};
}

void set_partition_bounds(std::span<const std::uint32_t> starts, std::uint32_t items, std::uint32_t width,
                          int* bounds) {
  for (std::size_t i = 1; i < starts.size(); ++i) bounds[i] = int((starts[i] + width / 2) / width);
  bounds[0] = 0;
  bounds[starts.size()] = int((items + width - 1) / width);
}

}  // namespace gyre
