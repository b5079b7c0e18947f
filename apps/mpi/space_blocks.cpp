// Cells along a curve. See space_blocks.h.
#include "mpi/space_blocks.h"

#include <algorithm>

namespace gyre {

namespace {

constexpr std::int64_t kMiddle = std::int64_t(1) << 20;  // coordinates have 21 bits

// Bit i goes to bit 3 i.
std::uint64_t spread_bits(std::uint64_t x) {
  std::uint64_t out = 0;
  for (int i = 0; i < 21; ++i) out |= (x >> i & 1) << (3 * i);
  return out;
}

}  // namespace

std::int64_t SpaceBlocks::coordinate(double x) const {
  const double cells = std::floor(x / cell_);
  return std::int64_t(std::clamp(cells, double(-kMiddle), double(kMiddle - 1)));
}

std::uint64_t SpaceBlocks::key(std::int64_t x, std::int64_t y, std::int64_t z) {
  // y last: it is up in most scenes, and blocks that are wide and low would cut piles across.
  return spread_bits(std::uint64_t(x + kMiddle)) << 2 | spread_bits(std::uint64_t(z + kMiddle)) << 1 |
         spread_bits(std::uint64_t(y + kMiddle));
}

int SpaceBlocks::owner_of_key(std::uint64_t key) const {
  return int(std::upper_bound(begins_.begin(), begins_.end(), key) - begins_.begin()) - 1;
}

void SpaceBlocks::divide(const std::map<std::uint64_t, double>& weights) {
  double total = 0;
  for (const auto& [key, weight] : weights) total += weight;
  const auto ranks = double(begins_.size());
  std::fill(begins_.begin(), begins_.end(), ~std::uint64_t(0));
  begins_[0] = 0;
  double before = 0;
  std::size_t rank = 1;
  for (const auto& [key, weight] : weights) {
    // A cell begins the run of a rank if its middle is beyond the rank's share.
    while (rank < begins_.size() && before + 0.5 * weight >= total * double(rank) / ranks)
      begins_[rank++] = key;
    before += weight;
  }
}

}  // namespace gyre
