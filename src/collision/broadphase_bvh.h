// The default broad phase: two wide trees, one of fixed and one of moving proxies, so that what never moves costs nothing
// and is asked only by what moves. Proxies without bounds (planes) lie in a list of their own: in a tree they would
// overlap every query and swell every box above them.
#pragma once

#include "collision/box_tree.h"
#include "collision/broadphase.h"
#include "collision/pair_collector.h"

namespace gyre {

class BroadphaseBvh final : public Broadphase {
 public:
  void rebuild(std::span<const Proxy> proxies) override;
  void update(std::span<const Proxy> proxies, std::span<const std::uint32_t> changed) override;
  void find_pairs(std::span<const Proxy> proxies, std::span<const std::uint32_t> moved, TaskSystem& tasks,
                  Array<std::uint64_t>& pairs) override;
  void query(std::span<const Proxy> proxies, const Aabb& box, Array<std::uint32_t>& found) const override;
  void trim() override;
  std::size_t bytes() const override;

  void for_each_node(FunctionRef<void(const NodeBox&)> visit) const override;
  const char* find_fault(std::span<const Proxy> proxies, std::span<const std::uint32_t> changed) const override;
  const BoxTree& moving_tree() const { return trees_[kMoving]; }
  const BoxTree& fixed_tree() const { return trees_[kFixed]; }

 private:
  enum Home : std::uint8_t { kFixed, kMoving, kUnboundedList, kNoHome };

  static Home home_of(const Proxy& proxy);
  void build_tree(std::span<const Proxy> proxies, Home home);
  void add(std::uint32_t index, const Proxy& proxy, Home home);
  void remove(std::uint32_t index);

  BoxTree trees_[2];
  Array<std::uint32_t> unbounded_;  // ascending
  Array<Home> homes_;               // by proxy
  PairCollector collector_;
};

}  // namespace gyre
