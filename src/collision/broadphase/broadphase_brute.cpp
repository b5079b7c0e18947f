// The brute-force broad phase has no data of its own but the proxies.
#include "collision/broadphase/broadphase_brute.h"

namespace gyre {

void BroadphaseBrute::rebuild(std::span<const Proxy>) {}

void BroadphaseBrute::update(std::span<const Proxy>, std::span<const std::uint32_t>) {}

void BroadphaseBrute::find_pairs(std::span<const Proxy> proxies, std::span<const std::uint32_t> moved,
                                 PairFilter filter, TaskSystem& tasks, Array<std::uint64_t>& pairs) {
  collector_.collect(proxies, moved, filter, tasks, pairs, [&](std::uint32_t, const auto& visit) {
    for (std::uint32_t other = 0; other < proxies.size(); ++other) visit(other);
  });
}

void BroadphaseBrute::query(std::span<const Proxy> proxies, const Aabb& box,
                            Array<std::uint32_t>& found) const {
  for (std::uint32_t i = 0; i < proxies.size(); ++i) {
    if (proxies[i].motion != ProxyMotion::none && overlap(proxies[i].fat_box, box)) found.push_back(i);
  }
}

float BroadphaseBrute::cast(std::span<const Proxy> proxies, const CastBox& cast_box, float max_fraction,
                            CastVisit visit) const {
  for (std::uint32_t i = 0; i < proxies.size() && max_fraction >= 0.0f; ++i) {
    if (proxies[i].motion != ProxyMotion::none && meets(cast_box, max_fraction, proxies[i].fat_box))
      max_fraction = visit(i, max_fraction);
  }
  return max_fraction;
}

}  // namespace gyre
