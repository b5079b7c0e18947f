// Tests all pairs, one by one: the oracle for every other broad phase.
#pragma once

#include "collision/broadphase/broadphase.h"
#include "collision/broadphase/pair_collector.h"

namespace gyre {

class BroadphaseBrute final : public Broadphase {
 public:
  void rebuild(std::span<const Proxy> proxies) override;
  void update(std::span<const Proxy> proxies, std::span<const std::uint32_t> changed) override;
  void find_pairs(std::span<const Proxy> proxies, std::span<const std::uint32_t> moved, PairFilter filter,
                  TaskSystem& tasks, Array<std::uint64_t>& pairs) override;
  void query(std::span<const Proxy> proxies, const Aabb& box, Array<std::uint32_t>& found) const override;
  float cast(std::span<const Proxy> proxies, const CastBox& cast_box, float max_fraction,
             CastVisit visit) const override;
  void trim() override { collector_.trim(); }
  std::size_t bytes() const override { return collector_.bytes(); }

 private:
  PairCollector collector_;
};

}  // namespace gyre
