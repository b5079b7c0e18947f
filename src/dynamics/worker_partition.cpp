// Divides a batch between workers. See worker_partition.h.
#include "dynamics/worker_partition.h"

namespace gyre {

WorkerPartition partition_bodies(std::span<const ColoringPair> pairs, std::size_t bodies, int workers,
                                 Arena& arena) {
  static_assert(kMaxShares <= 256, "shares are bytes");
  constexpr std::size_t kFewest = 256;  // fewest contacts that are worth dividing
  if (kMaxShares == 1 || workers == 1 || pairs.size() < kFewest) return {};
  const std::span<std::uint8_t> shares = arena.make<std::uint8_t>(bodies);
  const ArenaScope scope(arena);
  const std::span<std::uint32_t> contacts = arena.make<std::uint32_t>(bodies);
  for (std::uint32_t& count : contacts) count = 0;
  for (const ColoringPair& pair : pairs) ++contacts[WorkerPartition::second_of(pair)];
  std::size_t before = 0;
  for (std::size_t i = 0; i < bodies; ++i) {
    shares[i] = std::uint8_t(before * std::size_t(workers) / pairs.size());
    before += contacts[i];
  }
  // Bodies after the last contact join the last share.
  for (std::size_t i = bodies; i-- > 0 && int(shares[i]) == workers;) shares[i] = std::uint8_t(workers - 1);
  return {workers, shares};
}

void find_share_bounds(std::span<const std::uint32_t> starts, std::uint32_t items, std::uint32_t width,
                       int* bounds) {
  for (std::size_t i = 1; i < starts.size(); ++i) bounds[i] = int((starts[i] + width / 2) / width);
  bounds[0] = 0;
  bounds[starts.size()] = int((items + width - 1) / width);
}

}  // namespace gyre
