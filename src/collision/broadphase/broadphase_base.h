// The common base of all broad phases but brute force: two indices of boxes, one of fixed and one of moving proxies;
// sensors are among the latter. Fixed proxies cost nothing, and only moving ones query them. Proxies without bounds (planes) have a list of their
// own; in an index they would overlap every query and swell every box above them.
//
// The index names the broad phase. It contains items (small numbers) with boxes, and has
//   insert(item, box), remove(item), move(item, box), clear(), begin_build(), add_to_build(item, box), finish_build(),
//   kRebuildShare                building is cheaper if more than one in so many changes at once
//   set_box(item, box), refit()  optional: many boxes changed at once; refit() is false if building is better
//   improve(changes)             upkeep after so many changes, before any query; not called after a build
//   for_each_overlap(box, visit), for_each_along(cast_test, max_fraction, visit), for_each_node(visit)
//   contains(item), box_of(item), size(), bytes(), trim(), find_fault()
// An index may visit items that do not overlap, but each at most once: this class tests every candidate again.
#pragma once

#include "base/container/sort.h"
#include "collision/broadphase/broadphase.h"
#include "collision/broadphase/fat_box.h"
#include "collision/broadphase/pair_collector.h"

namespace gyre {

template <class Index>
class BroadphaseBase : public Broadphase {
 public:
  void rebuild(std::span<const Proxy> proxies) override;
  void update(std::span<const Proxy> proxies, std::span<const std::uint32_t> changed) override;
  void find_pairs(std::span<const Proxy> proxies, std::span<const std::uint32_t> moved, PairFilter filter,
                  TaskSystem& tasks, Array<std::uint64_t>& pairs) override;
  void query(std::span<const Proxy> proxies, const Aabb& box, Array<std::uint32_t>& found) const override;
  float cast(std::span<const Proxy> proxies, const CastBox& cast_box, float max_fraction,
             CastVisit visit) const override;
  void trim() override;
  std::size_t bytes() const override;

  void for_each_node(FunctionRef<void(const NodeBox&)> visit) const override;
  const char* find_fault(std::span<const Proxy> proxies,
                         std::span<const std::uint32_t> changed) const override;

 protected:
  enum Home : std::uint8_t { kFixed, kMoving, kUnboundedList, kNoHome };

  Index indices_[2];                // by Home
  Array<std::uint32_t> unbounded_;  // ascending
  Array<Home> homes_;               // by proxy
  PairCollector collector_;

 private:
  // If more than this many and the index's own share of its items change at once, it is rebuilt.
  static constexpr std::size_t kMinRebuildChanges = 64;

  static Home home_of(const Proxy& proxy) {
    if (proxy.motion == ProxyMotion::none) return kNoHome;
    if (is_unbounded(proxy.fat_box)) return kUnboundedList;
    return is_scenery(proxy) ? kFixed : kMoving;
  }
  static bool has_index(Home home) { return home == kFixed || home == kMoving; }

  void build_index(std::span<const Proxy> proxies, Home home);
  void add(std::uint32_t index, const Proxy& proxy, Home home);
  void remove(std::uint32_t index);
  void change(std::span<const Proxy> proxies, std::uint32_t index, const bool* build);
  // Sets many boxes of the index, without insertions or removals.
  static constexpr bool kRefits = requires(Index & index) { index.refit(); };
  void set_boxes(std::span<const Proxy> proxies, std::span<const std::uint32_t> changed, Home home);
};

namespace sorted_list {

inline void insert_sorted(Array<std::uint32_t>& list, std::uint32_t index) {
  std::size_t k = 0;
  while (k < list.size() && list[k] < index) ++k;
  list.insert_at(k, index);
}

inline void erase_sorted(Array<std::uint32_t>& list, std::uint32_t index) {
  for (std::size_t i = 0; i < list.size(); ++i) {
    if (list[i] == index) {
      list.erase_at(i);
      return;
    }
  }
}

}  // namespace sorted_list

template <class Index>
void BroadphaseBase<Index>::build_index(std::span<const Proxy> proxies, Home home) {
  indices_[home].begin_build();
  for (std::uint32_t i = 0; i < proxies.size(); ++i) {
    if (homes_[i] == home) indices_[home].add_to_build(i, proxies[i].fat_box);
  }
  indices_[home].finish_build();
}

template <class Index>
void BroadphaseBase<Index>::rebuild(std::span<const Proxy> proxies) {
  homes_.assign(proxies.size(), kNoHome);
  unbounded_.clear();
  for (std::uint32_t i = 0; i < proxies.size(); ++i) {
    homes_[i] = home_of(proxies[i]);
    if (homes_[i] == kUnboundedList) unbounded_.push_back(i);
  }
  build_index(proxies, kFixed);
  build_index(proxies, kMoving);
}

template <class Index>
void BroadphaseBase<Index>::add(std::uint32_t index, const Proxy& proxy, Home home) {
  homes_[index] = home;
  if (home == kUnboundedList) sorted_list::insert_sorted(unbounded_, index);
  if (has_index(home)) indices_[home].insert(index, proxy.fat_box);
}

template <class Index>
void BroadphaseBase<Index>::remove(std::uint32_t index) {
  const Home home = homes_[index];
  if (home == kUnboundedList) sorted_list::erase_sorted(unbounded_, index);
  if (has_index(home)) indices_[home].remove(index);
  homes_[index] = kNoHome;
}

// `build`: the indices to be rebuilt; they are empty now.
template <class Index>
void BroadphaseBase<Index>::change(std::span<const Proxy> proxies, std::uint32_t index, const bool* build) {
  const Home old = homes_[index];
  const Home home = home_of(proxies[index]);
  if (has_index(old) && build[old]) homes_[index] = kNoHome;
  if (has_index(home) && build[home]) {
    remove(index);
    homes_[index] = home;
  } else if (has_index(old) && home == old) {
    indices_[home].move(index, proxies[index].fat_box);
  } else if (home != old || !has_index(old)) {
    remove(index);
    add(index, proxies[index], home);
  }
}

template <class Index>
void BroadphaseBase<Index>::set_boxes(std::span<const Proxy> proxies, std::span<const std::uint32_t> changed,
                                      Home home) {
  if constexpr (kRefits) {
    std::size_t count = 0;
    for (const std::uint32_t index : changed) {
      if (homes_[index] != home) continue;
      indices_[home].set_box(index, proxies[index].fat_box);
      ++count;
    }
    if (indices_[home].refit()) {
      indices_[home].improve(count);
    } else {
      build_index(proxies, home);
    }
  }
}

template <class Index>
void BroadphaseBase<Index>::update(std::span<const Proxy> proxies, std::span<const std::uint32_t> changed) {
  if (homes_.size() < proxies.size()) homes_.resize(proxies.size(), kNoHome);
  std::size_t changes[4] = {};
  bool stay[4] = {true, true, true, true};
  for (const std::uint32_t index : changed) {
    const Home home = home_of(proxies[index]);
    ++changes[home];
    if (home == homes_[index]) continue;
    ++changes[homes_[index]];
    stay[home] = stay[homes_[index]] = false;
  }
  bool build[2];
  for (const Home home : {kFixed, kMoving}) {
    build[home] =
        changes[home] > kMinRebuildChanges && changes[home] > indices_[home].size() / Index::kRebuildShare;
    if (kRefits && build[home] && stay[home]) continue;
    stay[home] = false;
    // An index to be rebuilt is emptied first, so that no change below touches it.
    if (build[home]) indices_[home].clear();
  }
  for (const std::uint32_t index : changed) {
    const Home home = homes_[index];
    if (!has_index(home) || !stay[home]) change(proxies, index, build);
  }
  for (const Home home : {kFixed, kMoving}) {
    if (stay[home]) {
      set_boxes(proxies, changed, home);
    } else if (build[home]) {
      build_index(proxies, home);
    } else if (changes[home] > 0) {
      indices_[home].improve(changes[home]);
    }
  }
}

template <class Index>
void BroadphaseBase<Index>::find_pairs(std::span<const Proxy> proxies, std::span<const std::uint32_t> moved,
                                       PairFilter filter, TaskSystem& tasks, Array<std::uint64_t>& pairs) {
  collector_.collect(proxies, moved, filter, tasks, pairs, [&](std::uint32_t self, const auto& visit) {
    const Proxy& proxy = proxies[self];
    if (homes_[self] == kUnboundedList) {
      for (std::uint32_t other = 0; other < proxies.size(); ++other) visit(other);
      return;
    }
    indices_[kMoving].for_each_overlap(proxy.fat_box, visit);
    if (!is_scenery(proxy)) indices_[kFixed].for_each_overlap(proxy.fat_box, visit);
    for (const std::uint32_t other : unbounded_) visit(other);
  });
}

template <class Index>
void BroadphaseBase<Index>::query(std::span<const Proxy> proxies, const Aabb& box,
                                  Array<std::uint32_t>& found) const {
  const std::size_t before = found.size();
  const auto add_found = [&](std::uint32_t index) {
    if (overlap(proxies[index].fat_box, box)) found.push_back(index);
  };
  indices_[kFixed].for_each_overlap(box, add_found);
  indices_[kMoving].for_each_overlap(box, add_found);
  for (const std::uint32_t index : unbounded_) add_found(index);
  const std::size_t count = found.size() - before;
  found.resize_uninitialized(before + 2 * count);
  const std::span<std::uint32_t> fresh = found.view().subspan(before, count);
  merge_sort(fresh, found.view().last(count), [](std::uint32_t a, std::uint32_t b) { return a < b; });
  found.resize_uninitialized(before + count);
}

template <class Index>
float BroadphaseBase<Index>::cast(std::span<const Proxy> proxies, const CastBox& cast_box, float max_fraction,
                                  CastVisit visit) const {
  const CastTest test(cast_box);
  const auto visit_if_met = [&](std::uint32_t index, float so_far) {
    return meets(cast_box, so_far, proxies[index].fat_box) ? visit(index, so_far) : so_far;
  };
  for (const std::uint32_t index : unbounded_) {
    if (max_fraction >= 0.0f) max_fraction = visit_if_met(index, max_fraction);
  }
  const bool still = cast_box.translation == Vec3{};
  for (const Home home : {kMoving, kFixed}) {
    if (max_fraction < 0.0f) return max_fraction;
    if (still) {
      // A box at rest meets what it overlaps.
      indices_[home].for_each_overlap(test.box_of({}), [&](std::uint32_t index) {
        if (max_fraction >= 0.0f) max_fraction = visit_if_met(index, max_fraction);
      });
    } else {
      max_fraction = indices_[home].for_each_along(test, max_fraction, visit_if_met);
    }
  }
  return max_fraction;
}

template <class Index>
void BroadphaseBase<Index>::for_each_node(FunctionRef<void(const NodeBox&)> visit) const {
  for (const Home home : {kFixed, kMoving}) {
    indices_[home].for_each_node([&](const Aabb& box, int depth) { visit({box, depth, home == kFixed}); });
  }
}

template <class Index>
void BroadphaseBase<Index>::trim() {
  for (Index& index : indices_) index.trim();
  collector_.trim();
}

template <class Index>
std::size_t BroadphaseBase<Index>::bytes() const {
  return indices_[0].bytes() + indices_[1].bytes() + unbounded_.bytes() + homes_.bytes() + collector_.bytes();
}

template <class Index>
const char* BroadphaseBase<Index>::find_fault(std::span<const Proxy> proxies,
                                              std::span<const std::uint32_t> changed) const {
  for (const Index& index : indices_) {
    if (const char* const fault = index.find_fault()) return fault;
  }
  std::size_t count[4] = {};
  for (std::uint32_t i = 0; i < proxies.size(); ++i) {
    if (!changed.empty() && changed.front() == i) {
      changed = changed.subspan(1);
      if (i < homes_.size()) ++count[homes_[i]];
      continue;
    }
    const Home home = home_of(proxies[i]);
    if (i >= homes_.size() ? home != kNoHome : homes_[i] != home) return "a proxy is not where it belongs";
    ++count[home];
    for (const Home each : {kFixed, kMoving}) {
      if (indices_[each].contains(i) != (home == each)) return "a tree does not hold the proxies of its kind";
      if (home == each && !(indices_[each].box_of(i) == proxies[i].fat_box))
        return "a tree knows a proxy by another box than its own";
    }
  }
  if (count[kFixed] != indices_[kFixed].size() || count[kMoving] != indices_[kMoving].size())
    return "a tree is too large";
  return count[kUnboundedList] == unbounded_.size() ? nullptr : "the list of unbounded proxies is wrong";
}

}  // namespace gyre
