// Common code of every broad phase's find_pairs: blocks of moved proxies run in parallel, each worker stores the keys
// that it finds, and one sort at the end makes the result independent of the workers.
#pragma once

#include "base/arena/shrink_policy.h"
#include "base/container/array.h"
#include "base/container/bitset.h"
#include "base/container/sort.h"
#include "collision/broadphase/broadphase.h"
#include "task/parallel.h"

#include <cstdint>
#include <span>

namespace gyre {

class PairCollector {
 public:
  // Calls search(index of the moved proxy, visit), which must call visit(other) for at least every other proxy whose
  // fat box overlaps, once each. Appends the keys of those pairs that may meet and that the filter keeps, sorted.
  template <class Search>
  void collect(std::span<const Proxy> proxies, std::span<const std::uint32_t> moved, PairFilter filter,
               TaskSystem& tasks, Array<std::uint64_t>& pairs, const Search& search) {
    collect_from(proxies, moved, int(moved.size()), filter, tasks, pairs, [&](int i, const auto& emit) {
      const std::uint32_t self = moved[std::size_t(i)];
      if (proxies[self].motion == ProxyMotion::none) return;
      search(self, [&](std::uint32_t other) {
        // Two moved proxies are paired from the lower one only.
        if (other == self || (other < self && is_moved(other))) return;
        emit(self, other);
      });
    });
  }

  // The same, not by moved proxies: calls search(i, emit) for each i below `count`; together these must call emit(one,
  // other) once for each overlapping pair of which one is_moved().
  template <class Search>
  void collect_from(std::span<const Proxy> proxies, std::span<const std::uint32_t> moved, int count,
                    PairFilter filter, TaskSystem& tasks, Array<std::uint64_t>& pairs, const Search& search) {
    if (is_moved_.size() < proxies.size()) is_moved_.resize(proxies.size());
    for (const std::uint32_t index : moved) is_moved_.set(index);
    found_.resize(std::size_t(tasks.worker_count()));
    for (Found& found : found_) found.keys.reserve(max_pairs_ + max_per_block_);
    for_blocks(tasks, count, kBlock, [&](int begin, int end, int worker) {
      Array<std::uint64_t>& keys = found_[worker].keys;
      const std::size_t before = keys.size();
      const auto emit = [&](std::uint32_t one, std::uint32_t other) {
        const Proxy& a = proxies[one];
        const Proxy& b = proxies[other];
        if (overlap(a.fat_box, b.fat_box) && may_pair(a, b)) keys.push_back(pair_key(one, other));
      };
      for (int i = begin; i < end; ++i) search(i, emit);
      found_[worker].max_per_block = max(found_[worker].max_per_block, keys.size() - before);
      filter(keys, before);
    });
    for (const std::uint32_t index : moved) is_moved_.clear(index);
    append_sorted(pairs);
  }
  // Valid while collecting.
  bool is_moved(std::uint32_t index) const { return is_moved_.test(index); }

  // To be called once a step: releases memory that was not needed for long.
  void trim() {
    const std::size_t needed = last_ * sizeof(std::uint64_t);
    last_ = 0;
    if (!clock_.should_shrink(needed, scratch_.bytes())) return;
    max_pairs_ = 2 * clock_.max_needed() / sizeof(std::uint64_t);
    max_per_block_ = 0;
    for (Found& found : found_) found = {};
    scratch_ = Array<std::uint64_t>();
  }
  std::size_t bytes() const {
    std::size_t sum = scratch_.bytes() + (is_moved_.size() + 7) / 8;
    for (const Found& found : found_) sum += found.keys.bytes();
    return sum;
  }

 private:
  static constexpr int kBlock = 32;

  // The result of one worker.
  struct Found {
    Array<std::uint64_t> keys;
    std::size_t max_per_block = 0;  // in a block
  };

  void append_sorted(Array<std::uint64_t>& pairs) {
    const std::size_t before = pairs.size();
    for (Found& found : found_) {
      pairs.append(found.keys);
      found.keys.clear();
      max_per_block_ = max(max_per_block_, found.max_per_block);
    }
    const std::size_t count = pairs.size() - before;
    // Workers find different numbers in each run: each gets room for all pairs, and for a block before it is filtered,
    // so that none grows once warm.
    if (count > max_pairs_) max_pairs_ = count + count / 2;
    last_ = last_ < count ? count : last_;
    if (scratch_.size() < count) scratch_.resize_uninitialized(max_pairs_);
    radix_sort_u64({pairs.data() + before, count}, scratch_);
  }

  Bitset is_moved_;
  Array<Found> found_;  // by worker
  Array<std::uint64_t> scratch_;
  std::size_t max_pairs_ = 0;  // pairs of a step
  std::size_t max_per_block_ = 0;
  std::size_t last_ = 0;  // pairs found since the last trim()
  ShrinkPolicy clock_;
};

}  // namespace gyre
