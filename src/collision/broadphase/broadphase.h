// The broad phase: which fat boxes overlap. Every implementation returns exactly the same pairs, so the choice never
// changes a bit of the simulation; only speed differs. Virtual per batch, never per pair.
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
  bool fixed = false;  // of the tree over what never moves
};

// Takes out what is of no use among keys, from place `from` on. Asked by several workers at once.
using PairFilter = FunctionRef<void(Array<std::uint64_t>& keys, std::size_t from)>;

// What a cast does with a candidate: returns how far along the sweep it is still to look, at most `reach`; below 0 ends it.
using CastVisit = FunctionRef<float(std::uint32_t index, float max_fraction)>;

class Broadphase {
 public:
  virtual ~Broadphase() = default;

  // Forgets everything and takes in all proxies that are in use.
  virtual void rebuild(std::span<const Proxy> proxies) = 0;

  // Some proxies have come, gone (motion none), moved their fat box or changed between fixed and moving. `changed`:
  // ascending, without repeats.
  virtual void update(std::span<const Proxy> proxies, std::span<const std::uint32_t> changed) = 0;

  // Appends pair_key of every pair whose fat boxes overlap, that may_pair, and of which at least one is in `moved`
  // (ascending, without repeats), and that `filter` leaves; sorted, without repeats. Parallel over `moved`.
  virtual void find_pairs(std::span<const Proxy> proxies, std::span<const std::uint32_t> moved,
                          PairFilter filter, TaskSystem& tasks, Array<std::uint64_t>& pairs) = 0;
  // All of them.
  void find_pairs(std::span<const Proxy> proxies, std::span<const std::uint32_t> moved, TaskSystem& tasks,
                  Array<std::uint64_t>& pairs) {
    find_pairs(
        proxies, moved, [](Array<std::uint64_t>&, std::size_t) {}, tasks, pairs);
  }

  // Appends the index of every proxy in use whose fat box overlaps `box`; ascending.
  virtual void query(std::span<const Proxy> proxies, const Aabb& box, Array<std::uint32_t>& found) const = 0;

  // Calls visit(index, reach) once for each proxy in use whose fat box the sweep meets from t = 0 to `reach` (0 to 1), which
  // visit may shorten as it goes; returns the last reach. The order is roughly from near to far, differs between broad
  // phases, and is none that a result may depend on: what is met at `reach` itself is visited too, so that a caller who keeps
  // the nearest hit (of equal ones that of the lowest index) and returns its t gets the same from all. May be called from
  // several threads at once, and allocates nothing.
  virtual float cast(std::span<const Proxy> proxies, const CastBox& cast_box, float max_fraction,
                     CastVisit visit) const = 0;

  // For the eyes of people: calls visit for the box of every inner node of every tree that the broad phase has, from the
  // root (depth 0) down. Nothing if it has no trees.
  virtual void for_each_node(FunctionRef<void(const NodeBox&)> visit) const;
  // Null if it holds the proxies with their boxes, but for those in `changed` (ascending), which it has not been shown yet;
  // otherwise what is wrong. Walks everything: for tests and debug builds.
  virtual const char* find_fault(std::span<const Proxy> proxies,
                                 std::span<const std::uint32_t> changed) const;
  // To be called once a step: memory that only searches and builds need is given back when it was not needed for long.
  virtual void trim() = 0;
  // Of memory held.
  virtual std::size_t bytes() const = 0;
};

std::unique_ptr<Broadphase> make_broadphase(BroadPhaseKind kind);

}  // namespace gyre
