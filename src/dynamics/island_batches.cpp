// Finds islands as disjoint sets, assigns them to batches in the order of their lowest bodies, and sorts members into batches by counting.
// See island_batches.h.
#include "dynamics/island_batches.h"

#include "base/arena/bucketed_lists.h"
#include "base/container/disjoint_sets.h"
#include "task/parallel.h"
#include "task/parallel_filter.h"

#include <algorithm>

namespace gyre {

namespace {

// Fewest manifolds and joints that are worth sharing among workers.
constexpr std::uint32_t kWorthSharing = 64;

// The data of a contact or joint that islands and batches need, so that its record is read once.
struct ConstraintEdge {
  std::uint32_t owner;  // a moving body; its island has the constraint
  std::uint32_t other;  // may be immovable, or kNoIndex
  std::uint32_t size;   // manifolds
};

// The constraints of this step in ascending order, and their edges by slot. Edges of other slots are undefined.
struct Constraints {
  std::span<const std::uint32_t> contacts;
  std::span<const std::uint32_t> joints;
  std::span<const ConstraintEdge> contact_edges;
  std::span<const ConstraintEdge> joint_edges;
  std::size_t size = 0;  // manifolds and joints

  // Calls fn for the edges of contacts, then of joints.
  template <class Fn>
  void for_each_edge(Fn&& fn) const {
    for (const std::uint32_t slot : contacts) fn(contact_edges[slot]);
    for (const std::uint32_t slot : joints) fn(joint_edges[slot]);
  }
};

// Adds an edge; false if neither body moves. kNoIndex stands for no body.
bool add_edge(const RigidWorld& w, std::uint32_t a, std::uint32_t b, std::uint32_t size, ConstraintEdge& to) {
  if (a != kNoIndex && is_active(w, a)) {
    to = {a, b, size};
    return true;
  }
  if (b == kNoIndex || !is_active(w, b)) return false;
  to = {b, a, size};
  return true;
}

// Contacts and joints are fetched so many records ahead.
constexpr std::uint32_t kContactsFetched = 8, kJointsFetched = 8;

Constraints list_constraints(const RigidWorld& w, Arena& arena, TaskSystem& tasks) {
  const std::span<ConstraintEdge> contact_edges = arena.make<ConstraintEdge>(w.contacts.contacts.size());
  const std::span<ConstraintEdge> joint_edges = arena.make<ConstraintEdge>(w.joints.ids.capacity());
  const auto manifolds = [&](std::uint32_t slot) {
    if (w.contacts.with_manifolds.test(slot + kContactsFetched))
      __builtin_prefetch(&w.contacts.contacts[slot + kContactsFetched]);
    const Contact& contact = w.contacts.contacts[slot];
    const std::uint32_t count = contact.manifold_count;
    return may_act(contact) && add_edge(w, contact.body_a, contact.body_b, count, contact_edges[slot]) ? count
                                                                                                       : 0u;
  };
  const auto works = [&](std::uint32_t slot) {
    fetch_joint(w.joints, slot + kJointsFetched);
    if (!w.joints.ids.live(slot) || !may_act(w, slot)) return false;
    const JointRecord& joint = w.joints.records[slot];
    // As an unsigned number, kNoBody is kNoIndex.
    return add_edge(w, std::uint32_t(joint.body_a), std::uint32_t(joint.body_b), 1, joint_edges[slot]);
  };
  const FilteredList contacts = parallel_filter_among(tasks, arena, manifolds, w.contacts.with_manifolds,
                                                      w.active_constraints.contacts);
  const FilteredList joints = parallel_filter_among(tasks, arena, works, w.active_constraints.joints);
  return {contacts.list, joints.list, contact_edges, joint_edges, contacts.size + joints.size};
}

// Disjoint sets of bodies; the root of an island is its lowest body. A kinematic body belongs to the islands that it touches, because it
// moves in each sub-step and they must see its pose.
class BatchIslands {
 public:
  BatchIslands(const RigidWorld& w, const Constraints& constraints, std::span<const std::uint32_t> united,
               std::span<std::uint32_t> room)
      : sets_(room, w.bodies.awake) {
    constraints.for_each_edge([&](const ConstraintEdge& edge) {
      if (edge.other != kNoIndex && sets_.has(edge.other)) sets_.unite(edge.owner, edge.other);
    });
    for (const std::uint32_t body : united) sets_.unite(united[0], body);
    sets_.flatten(w.bodies.awake);
  }
  std::uint32_t root(std::uint32_t body) const { return sets_.parents[body]; }

 private:
  DisjointSets sets_;
};

// Weights are in quarters of a constraint; a body weighs one.
constexpr std::uint32_t kConstraint = 4;

// Returns the weights of islands by root.
std::span<const std::uint32_t> weigh_islands(const RigidWorld& w, const Constraints& constraints,
                                             const BatchIslands& islands, std::size_t bodies, Arena& arena) {
  const std::span<std::uint32_t> weights = arena.make<std::uint32_t>(bodies);
  for (std::uint32_t& weight : weights) weight = 0;
  constraints.for_each_edge(
      [&](const ConstraintEdge& edge) { weights[islands.root(edge.owner)] += kConstraint * edge.size; });
  for (const std::uint32_t body : w.bodies.awake) ++weights[islands.root(body)];
  return weights;
}

// Consecutive islands of equal weight are mostly alike (a crowd) and are solved in lanes. Their batch ends where lanes are full, if it
// is too small to fill them once more. Such a batch is more than half full.
constexpr std::uint32_t kIslandLanes = 8;

// Assigns a batch to each island, written to `batch_of` for all its bodies. Small islands fill one batch after the other; an island above
// `most` is alone. Returns the weights of the batches.
std::span<std::uint32_t> part_islands(const RigidWorld& w, const BatchIslands& islands,
                                      std::span<const std::uint32_t> weights, std::uint32_t most,
                                      Arena& arena, std::span<std::uint32_t> batch_of) {
  const std::span<std::uint32_t> filled = arena.make<std::uint32_t>(w.bodies.awake.size());
  // `open`: the batch that others may join; `alike`: how many of its last islands weigh `last` each.
  std::uint32_t count = 0, open = kNoIndex, alike = 0, last = 0;
  const auto begin_batch = [&] {
    filled[count] = 0;
    return count++;
  };
  const auto choose_batch = [&](std::uint32_t weight) {
    if (weight > most) return begin_batch();
    const bool lanes_are_full = weight == last && alike > 0 && alike % kIslandLanes == 0;
    if (open == kNoIndex || filled[open] + (lanes_are_full ? kIslandLanes : 1) * weight > most) {
      open = begin_batch();
      alike = 0;
    }
    alike = weight == last ? alike + 1 : 1;
    last = weight;
    return open;
  };
  for (const std::uint32_t body : w.bodies.awake) {
    const std::uint32_t root = islands.root(body);
    if (root == body) {
      batch_of[body] = choose_batch(weights[body]);
      filled[batch_of[body]] += weights[body];
    } else {
      batch_of[body] = batch_of[root];
    }
  }
  return filled.first(count);
}

// If few batches are beside those above `most`, merges them into the largest of these. Returns the weights of the remaining batches.
std::span<std::uint32_t> join_few(const RigidWorld& w, std::span<std::uint32_t> weights, std::uint32_t most,
                                  std::uint32_t fewest, Arena& arena, std::span<std::uint32_t> batch_of) {
  const auto is_small = [most](std::uint32_t weight) { return weight <= most; };
  const auto small = std::size_t(std::count_if(weights.begin(), weights.end(), is_small));
  if (small == 0 || small >= fewest || small == weights.size()) return weights;
  const auto host = std::max_element(weights.begin(), weights.end()) - weights.begin();
  const std::span<std::uint32_t> numbers = arena.make<std::uint32_t>(weights.size());
  std::uint32_t left = 0;
  for (std::size_t batch = 0; batch < weights.size(); ++batch) {
    numbers[batch] = kNoIndex;
    if (is_small(weights[batch])) continue;
    numbers[batch] = left;
    weights[left++] = weights[batch];
  }
  for (const std::uint32_t body : w.bodies.awake) {
    const std::uint32_t number = numbers[batch_of[body]];
    batch_of[body] = number != kNoIndex ? number : numbers[std::size_t(host)];
  }
  return weights.first(left);
}

// Memory for the result of find_batches(), whose size is not known yet.
struct BatchRoom {
  std::span<std::uint32_t> local_index, bodies, contacts, joints;
  std::span<IslandBatch> batches;

  BatchRoom(const RigidWorld& w, Arena& arena, BatchSize size) {
    const std::size_t awake = w.bodies.awake.size(), with_manifolds = w.contacts.with_manifolds.count();
    const std::size_t manifolds = min(with_manifolds * kMaxMeshManifolds, w.contacts.manifolds.size());
    local_index = arena.make<std::uint32_t>(w.bodies.motion.size());
    bodies = arena.make<std::uint32_t>(awake);
    contacts = arena.make<std::uint32_t>(with_manifolds);
    joints = arena.make<std::uint32_t>(w.joints.ids.capacity());
    // An island that is alone exceeds the size of a batch, and so does each other batch together with the next one.
    const std::uint32_t worth = size.shares == 1 ? size.most : min(size.most, kWorthSharing);
    const std::size_t weight = kConstraint * (manifolds + joints.size()) + awake;
    batches = arena.make<IslandBatch>(2 * weight / (kConstraint * worth) + 1);
  }
};

std::span<const std::uint32_t> copy_to(std::span<std::uint32_t> room, std::span<const std::uint32_t> list) {
  std::copy(list.begin(), list.end(), room.begin());
  return room.first(list.size());
}

}  // namespace

IslandBatches find_batches(const RigidWorld& w, std::span<const std::uint32_t> united, Arena& arena, TaskSystem& tasks,
                           BatchSize size) {
  const std::span<const std::uint32_t> awake = w.bodies.awake;
  // Results are allocated first. The rest is released before batches are solved.
  const BatchRoom room(w, arena, size);
  const std::span<std::uint32_t> local_index = room.local_index;
  const ArenaScope scope(arena);
  const Constraints constraints = list_constraints(w, arena, tasks);
  const std::size_t all_weights = kConstraint * constraints.size + awake.size();
  const auto share = std::uint32_t(all_weights / size.shares);
  const std::uint32_t most = min(kConstraint * size.most, max(share, kConstraint * kWorthSharing));
  const auto all_in_one = [&](std::span<IslandBatch> batches) {
    for (std::uint32_t i = 0; i < awake.size(); ++i) local_index[awake[i]] = i;
    if (!batches.empty())
      batches[0] = {
          {awake, copy_to(room.contacts, constraints.contacts), copy_to(room.joints, constraints.joints)}};
    return IslandBatches{batches, local_index, united.empty() ? -1 : 0};
  };
  if (all_weights <= most) return all_in_one(room.batches.first(awake.empty() ? 0 : 1));
  const std::span<IslandBatch> batches = room.batches;
  BucketedLists bodies(batches.size(), arena), contacts(batches.size(), arena), joints(batches.size(), arena);
  const std::span<std::uint32_t> batch_of = arena.make<std::uint32_t>(local_index.size());
  const BatchIslands islands(w, constraints, united, local_index);
  const std::span<const std::uint32_t> island_weights =
      weigh_islands(w, constraints, islands, local_index.size(), arena);
  const std::span<std::uint32_t> parts = part_islands(w, islands, island_weights, most, arena, batch_of);
  const std::span<const std::uint32_t> weights = join_few(w, parts, most, size.fewest, arena, batch_of);
  const std::size_t count = weights.size();
  if (count == 1) return all_in_one(batches.first(1));
  for (const std::uint32_t body : awake) bodies.count(batch_of[body]);
  const auto contact_batch = [&](std::uint32_t slot) {
    return batch_of[constraints.contact_edges[slot].owner];
  };
  const auto joint_batch = [&](std::uint32_t slot) { return batch_of[constraints.joint_edges[slot].owner]; };
  for (const std::uint32_t slot : constraints.contacts) contacts.count(contact_batch(slot));
  for (const std::uint32_t slot : constraints.joints) joints.count(joint_batch(slot));
  bodies.make_room(room.bodies), contacts.make_room(room.contacts), joints.make_room(room.joints);
  for (const std::uint32_t body : awake) bodies.add(batch_of[body], body);
  for (const std::uint32_t slot : constraints.contacts) contacts.add(contact_batch(slot), slot);
  for (const std::uint32_t slot : constraints.joints) joints.add(joint_batch(slot), slot);
  for (std::size_t i = 0; i < count; ++i) {
    batches[i] = {{bodies.of(i), contacts.of(i), joints.of(i)}, weights[i] <= most};
    for (std::uint32_t n = 0; n < batches[i].bodies.size(); ++n) local_index[batches[i].bodies[n]] = n;
  }
  return {batches.first(count), local_index, united.empty() ? -1 : int(batch_of[united[0]])};
}

}  // namespace gyre
