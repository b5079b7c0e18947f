// The broad phase: finds which fat boxes overlap. Every implementation returns exactly the same pairs, so the choice
// never changes a bit of the simulation, only its speed. Virtual calls happen per batch, never per pair.
#pragma once

#include "base/container/array.h"
#include "base/function_ref.h"
#include "collision/broadphase/cast_box.h"
#include "collision/broadphase/proxy.h"
#include "task/task_system.h"

#include <gyre/defs.h>

#include <memory>
#include <span>

namespace gyre {

struct NodeBox {
  Aabb box;
  int depth = 0;
  bool fixed = false;  // of the tree of fixed proxies
};

// Removes useless keys from index `from` on. Called by several workers at once.
using PairFilter = FunctionRef<void(Array<std::uint64_t>& keys, std::size_t from)>;

// Handles a candidate of a cast; returns the fraction up to which the cast continues, at most `max_fraction`, or below
// 0 to end it.
using CastVisit = FunctionRef<float(std::uint32_t index, float max_fraction)>;

class Broadphase {
 public:
  virtual ~Broadphase() = default;

  // Starts anew with all proxies that are in use.
  virtual void rebuild(std::span<const Proxy> proxies) = 0;

  // Some proxies were added, removed (motion none), changed their fat box or their motion. `changed`: ascending,
  // without repeats.
  virtual void update(std::span<const Proxy> proxies, std::span<const std::uint32_t> changed) = 0;

  // Appends pair_key of every pair whose fat boxes overlap, that may_pair, with at least one proxy in `moved`
  // (ascending, without repeats), and that `filter` keeps; sorted, without repeats. Parallel over `moved`.
  virtual void find_pairs(std::span<const Proxy> proxies, std::span<const std::uint32_t> moved,
                          PairFilter filter, TaskSystem& tasks, Array<std::uint64_t>& pairs) = 0;
  // Without a filter.
  void find_pairs(std::span<const Proxy> proxies, std::span<const std::uint32_t> moved, TaskSystem& tasks,
                  Array<std::uint64_t>& pairs) {
    find_pairs(
        proxies, moved, [](Array<std::uint64_t>&, std::size_t) {}, tasks, pairs);
  }

  // Appends the index of every proxy in use whose fat box overlaps `box`; ascending.
  virtual void query(std::span<const Proxy> proxies, const Aabb& box, Array<std::uint32_t>& found) const = 0;

  // Calls visit(index, max_fraction) once for each proxy in use whose fat box the cast meets from t = 0 to
  // `max_fraction` (0 to 1), which visit may shorten; returns the last max_fraction. The order is roughly from near to
  // far and differs between broad phases. Boxes met exactly at `max_fraction` are visited too; a caller that keeps the
  // nearest hit (the lowest index among equals) and returns its t gets the same result from all broad phases. May be
  // called from several threads at once, and allocates nothing.
  virtual float cast(std::span<const Proxy> proxies, const CastBox& cast_box, float max_fraction,
                     CastVisit visit) const = 0;

  // For debug drawing: calls visit for the box of every inner node of every tree, from the root (depth 0) down. Without
  // trees it calls nothing.
  virtual void for_each_node(FunctionRef<void(const NodeBox&)> visit) const;
  // Null if the broad phase contains the proxies with their boxes, except those in `changed` (ascending), which it has
  // not received yet; otherwise the fault in words. Visits everything: for tests and debug builds.
  virtual const char* find_fault(std::span<const Proxy> proxies,
                                 std::span<const std::uint32_t> changed) const;
  // To be called once a step: releases memory of searches and builds that was not needed for long.
  virtual void trim() = 0;
  // Memory in use.
  virtual std::size_t bytes() const = 0;
};

std::unique_ptr<Broadphase> make_broadphase(BroadPhaseKind kind);

}  // namespace gyre
