// Keeping two trees and a list in step with the proxies. See broadphase_bvh.h.
#include "collision/broadphase_bvh.h"

#include "base/sort.h"
#include "collision/fat_box.h"

namespace gyre {
namespace {

// When this many and this share of a tree's items change at once, building anew is cheaper than one change at a time.
constexpr std::size_t kManyChanges = 64;
constexpr std::size_t kRebuildShare = 4;  // a quarter
// Inner nodes regrouped in each update, and one more for so many changes.
constexpr std::size_t kImproved = 1;
constexpr std::size_t kChangesPerImproved = 128;

void insert_sorted(Array<std::uint32_t>& list, std::uint32_t index) {
  std::size_t place = 0;
  while (place < list.size() && list[place] < index) ++place;
  list.insert_at(place, index);
}

void erase_sorted(Array<std::uint32_t>& list, std::uint32_t index) {
  for (std::size_t i = 0; i < list.size(); ++i) {
    if (list[i] == index) {
      list.erase_at(i);
      return;
    }
  }
}

}  // namespace

BroadphaseBvh::Home BroadphaseBvh::home_of(const Proxy& proxy) {
  if (proxy.motion == ProxyMotion::none) return kNoHome;
  if (is_unbounded(proxy.fat_box)) return kUnboundedList;
  return proxy.motion == ProxyMotion::fixed ? kFixed : kMoving;
}

void BroadphaseBvh::build_tree(std::span<const Proxy> proxies, Home home) {
  trees_[home].begin_build();
  for (std::uint32_t i = 0; i < proxies.size(); ++i) {
    if (homes_[i] == home) trees_[home].add_to_build(i, proxies[i].fat_box);
  }
  trees_[home].finish_build();
}

void BroadphaseBvh::rebuild(std::span<const Proxy> proxies) {
  homes_.assign(proxies.size(), kNoHome);
  unbounded_.clear();
  for (std::uint32_t i = 0; i < proxies.size(); ++i) {
    homes_[i] = home_of(proxies[i]);
    if (homes_[i] == kUnboundedList) unbounded_.push_back(i);
  }
  build_tree(proxies, kFixed);
  build_tree(proxies, kMoving);
}

void BroadphaseBvh::add(std::uint32_t index, const Proxy& proxy, Home home) {
  homes_[index] = home;
  if (home == kUnboundedList) insert_sorted(unbounded_, index);
  if (home == kFixed || home == kMoving) trees_[home].insert(index, proxy.fat_box);
}

void BroadphaseBvh::remove(std::uint32_t index) {
  const Home home = homes_[index];
  if (home == kUnboundedList) erase_sorted(unbounded_, index);
  if (home == kFixed || home == kMoving) trees_[home].remove(index);
  homes_[index] = kNoHome;
}

void BroadphaseBvh::update(std::span<const Proxy> proxies, std::span<const std::uint32_t> changed) {
  if (homes_.size() < proxies.size()) homes_.resize(proxies.size(), kNoHome);
  std::size_t changes[4] = {};
  for (const std::uint32_t index : changed) {
    const Home home = home_of(proxies[index]);
    ++changes[home];
    if (home != homes_[index]) ++changes[homes_[index]];
  }
  bool build[2];
  for (const Home home : {kFixed, kMoving}) {
    build[home] = changes[home] > kManyChanges && changes[home] > trees_[home].size() / kRebuildShare;
    // A tree that is to be built anew is emptied first, so that no change below touches it.
    if (build[home]) trees_[home].clear();
  }
  for (const std::uint32_t index : changed) {
    const Home old = homes_[index];
    const Home home = home_of(proxies[index]);
    const bool old_is_tree = old == kFixed || old == kMoving;
    if (old_is_tree && build[old]) homes_[index] = kNoHome;
    if ((home == kFixed || home == kMoving) && build[home]) {
      remove(index);
      homes_[index] = home;
    } else if (old_is_tree && home == old) {
      trees_[home].move(index, proxies[index].fat_box);
    } else if (home != old || !old_is_tree) {
      remove(index);
      add(index, proxies[index], home);
    }
  }
  for (const Home home : {kFixed, kMoving}) {
    if (build[home]) {
      build_tree(proxies, home);
    } else if (changes[home] > 0) {
      trees_[home].improve(int(kImproved + changes[home] / kChangesPerImproved));
    }
  }
}

void BroadphaseBvh::find_pairs(std::span<const Proxy> proxies, std::span<const std::uint32_t> moved,
                               TaskSystem& tasks, Array<std::uint64_t>& pairs) {
  collector_.collect(proxies, moved, tasks, pairs, [&](std::uint32_t self, const auto& visit) {
    const Proxy& proxy = proxies[self];
    if (homes_[self] == kUnboundedList) {
      for (std::uint32_t other = 0; other < proxies.size(); ++other) visit(other);
      return;
    }
    trees_[kMoving].for_each_overlap(proxy.fat_box, visit);
    if (proxy.motion == ProxyMotion::moving) trees_[kFixed].for_each_overlap(proxy.fat_box, visit);
    for (const std::uint32_t other : unbounded_) visit(other);
  });
}

void BroadphaseBvh::query(std::span<const Proxy> proxies, const Aabb& box,
                          Array<std::uint32_t>& found) const {
  const std::size_t before = found.size();
  const auto add_found = [&](std::uint32_t index) { found.push_back(index); };
  trees_[kFixed].for_each_overlap(box, add_found);
  trees_[kMoving].for_each_overlap(box, add_found);
  for (const std::uint32_t index : unbounded_) {
    if (overlap(proxies[index].fat_box, box)) found.push_back(index);
  }
  const std::size_t count = found.size() - before;
  found.resize_uninitialized(before + 2 * count);
  const std::span<std::uint32_t> fresh = found.view().subspan(before, count);
  merge_sort(fresh, found.view().last(count), [](std::uint32_t a, std::uint32_t b) { return a < b; });
  found.resize_uninitialized(before + count);
}

void BroadphaseBvh::for_each_node(FunctionRef<void(const NodeBox&)> visit) const {
  for (const Home home : {kFixed, kMoving}) {
    trees_[home].for_each_node([&](const Aabb& box, int depth) { visit({box, depth, home == kFixed}); });
  }
}

void BroadphaseBvh::trim() {
  for (BoxTree& tree : trees_) tree.trim();
  collector_.trim();
}

std::size_t BroadphaseBvh::bytes() const {
  return trees_[0].bytes() + trees_[1].bytes() + unbounded_.bytes() + homes_.bytes() + collector_.bytes();
}

const char* BroadphaseBvh::find_fault(std::span<const Proxy> proxies, std::span<const std::uint32_t> changed) const {
  for (const BoxTree& tree : trees_) {
    if (const char* const fault = tree.find_fault()) return fault;
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
    for (const Home tree : {kFixed, kMoving}) {
      if (trees_[tree].contains(i) != (home == tree)) return "a tree does not hold the proxies of its kind";
      if (home == tree && !(trees_[tree].box_of(i) == proxies[i].fat_box))
        return "a tree knows a proxy by another box than its own";
    }
  }
  if (count[kFixed] != trees_[kFixed].size() || count[kMoving] != trees_[kMoving].size())
    return "a tree is too large";
  return count[kUnboundedList] == unbounded_.size() ? nullptr : "the list of unbounded proxies is wrong";
}

}  // namespace gyre
