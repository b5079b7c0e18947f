// Islands by union-find, islands to batches in the order of their lowest bodies, members to batches by counting. See
// solve_batches.h.
#include "rigid/solve_batches.h"

#include "task/parallel.h"

#include <bit>

namespace gyre {

namespace {

constexpr std::uint32_t kNone = 0xffffffffu;
// Manifolds and joints: what is less is not worth to be shared among workers.
constexpr std::uint32_t kWorthSharing = 64;

// What is solved in this step, ascending.
struct Constraints {
  std::span<const std::uint32_t> contacts;
  std::span<const std::uint32_t> joints;
  std::size_t size = 0;  // manifolds and joints
};

Constraints list_constraints(const RigidWorld& w, Arena& arena, TaskSystem& tasks) {
  // Contacts are looked at in blocks of one word of bits each.
  struct Count {
    std::uint32_t contacts = 0, manifolds = 0;
  };
  const std::size_t slots = w.contacts.contacts.size();
  const std::span<std::uint64_t> solved = arena.make<std::uint64_t>((slots + 63) / 64);
  const auto look = [&](int begin, int end, int) {
    Count count;
    std::uint64_t bits = 0;
    for (int slot = begin; slot < end; ++slot) {
      const Contact& contact = w.contacts.contacts[std::size_t(slot)];
      if (!is_solved(w, contact)) continue;
      bits |= std::uint64_t{1} << (slot - begin);
      ++count.contacts;
      count.manifolds += contact.manifold_count;
    }
    solved[std::size_t(begin) / 64] = bits;
    return count;
  };
  const Count count = reduce_blocks(tasks, int(slots), 64, Count{}, look, [](Count a, Count b) {
    return Count{a.contacts + b.contacts, a.manifolds + b.manifolds};
  });
  const std::span<std::uint32_t> contacts = arena.make<std::uint32_t>(count.contacts);
  std::size_t contact_count = 0;
  for (std::size_t word = 0; word < solved.size(); ++word) {
    for (std::uint64_t left = solved[word]; left != 0; left &= left - 1)
      contacts[contact_count++] = std::uint32_t(64 * word) + std::uint32_t(std::countr_zero(left));
  }
  const std::span<std::uint32_t> joints = arena.make<std::uint32_t>(w.joints.ids.size());
  std::size_t joint_count = 0;
  w.joints.ids.for_each_live([&](std::uint32_t slot) {
    if (is_joint_solved(w, slot)) joints[joint_count++] = slot;
  });
  return {contacts, joints.first(joint_count), count.manifolds + joint_count};
}

// Every constraint has a body that moves; its island is the constraint's.
std::uint32_t owner(const RigidWorld& w, const Contact& contact) {
  return is_active(w, contact.body_a) ? contact.body_a : contact.body_b;
}
std::uint32_t owner(const RigidWorld& w, const JointRecord& joint) {
  return joint.body_a != kNoBody && is_active(w, std::uint32_t(joint.body_a)) ? std::uint32_t(joint.body_a)
                                                                              : std::uint32_t(joint.body_b);
}

// Union-find over bodies; the root of an island is its lowest body. A kinematic body belongs to the islands that it touches:
// it moves from sub-step to sub-step, and all must see it where it is.
class Islands {
 public:
  Islands(const RigidWorld& w, const Constraints& constraints, std::span<std::uint32_t> parents)
      : parents_(parents) {
    for (std::uint32_t& parent : parents_) parent = kNone;
    for (const std::uint32_t body : w.bodies.awake) parents_[body] = body;
    for (const std::uint32_t slot : constraints.contacts) {
      const Contact& contact = w.contacts.contacts[slot];
      unite(contact.body_a, contact.body_b);
    }
    for (const std::uint32_t slot : constraints.joints) {
      const JointRecord& joint = w.joints.records[slot];
      if (joint.body_a != kNoBody && joint.body_b != kNoBody)
        unite(std::uint32_t(joint.body_a), std::uint32_t(joint.body_b));
    }
  }
  std::uint32_t root(std::uint32_t i) {
    while (parents_[i] != i) i = parents_[i] = parents_[parents_[i]];
    return i;
  }

 private:
  void unite(std::uint32_t a, std::uint32_t b) {
    if (parents_[a] == kNone || parents_[b] == kNone) return;
    a = root(a);
    b = root(b);
    parents_[max(a, b)] = min(a, b);
  }

  std::span<std::uint32_t> parents_;
};

// Lists of numbers by batch: first how many each gets, then the numbers themselves.
class Lists {
 public:
  Lists(Arena& arena, std::size_t batches) : ends_(arena.make<std::uint32_t>(batches)) {
    for (std::uint32_t& end : ends_) end = 0;
  }
  void count(std::uint32_t batch) { ++ends_[batch]; }
  void make_room(Arena& arena) {
    std::uint32_t sum = 0;
    for (std::uint32_t& end : ends_) {
      const std::uint32_t count = end;
      end = sum;
      sum += count;
    }
    items_ = arena.make<std::uint32_t>(sum);
  }
  void add(std::uint32_t batch, std::uint32_t item) { items_[ends_[batch]++] = item; }
  // After all were added.
  std::span<const std::uint32_t> of(std::size_t batch) const {
    const std::uint32_t begin = batch == 0 ? 0 : ends_[batch - 1];
    return items_.subspan(begin, ends_[batch] - begin);
  }

 private:
  std::span<std::uint32_t> ends_;
  std::span<std::uint32_t> items_;
};

// Weights are in quarters of a constraint: each body is one.
constexpr std::uint32_t kConstraint = 4;

// How much the islands are, by root.
std::span<const std::uint32_t> weigh_islands(const RigidWorld& w, const Constraints& constraints,
                                             Islands& islands, std::size_t bodies, Arena& arena) {
  const std::span<std::uint32_t> weights = arena.make<std::uint32_t>(bodies);
  for (std::uint32_t& weight : weights) weight = 0;
  for (const std::uint32_t slot : constraints.contacts) {
    const Contact& contact = w.contacts.contacts[slot];
    weights[islands.root(owner(w, contact))] += kConstraint * contact.manifold_count;
  }
  for (const std::uint32_t slot : constraints.joints)
    weights[islands.root(owner(w, w.joints.records[slot]))] += kConstraint;
  for (const std::uint32_t body : w.bodies.awake) ++weights[islands.root(body)];
  return weights;
}

// Gives each island its batch, written for all its bodies to `batch_of`. Returns the weights of the batches.
std::span<const std::uint32_t> part_islands(const RigidWorld& w, Islands& islands,
                                            std::span<const std::uint32_t> weights, std::uint32_t most,
                                            Arena& arena, std::span<std::uint32_t> batch_of) {
  const std::span<std::uint32_t> filled = arena.make<std::uint32_t>(w.bodies.awake.size());
  std::uint32_t batch = 0;
  filled[0] = 0;
  for (const std::uint32_t body : w.bodies.awake) {
    const std::uint32_t root = islands.root(body);
    if (root == body) {
      if (filled[batch] > 0 && filled[batch] + weights[body] > most) filled[++batch] = 0;
      filled[batch] += weights[body];
    }
    batch_of[body] = root == body ? batch : batch_of[root];
  }
  return filled.first(batch + 1);
}

}  // namespace

bool is_solved(const RigidWorld& w, const Contact& contact) {
  if (contact.manifold_room == 0 || contact.manifold_count == 0 || contact.sensor != 0) return false;
  return is_active(w, contact.body_a) || is_active(w, contact.body_b);
}
bool is_joint_solved(const RigidWorld& w, std::uint32_t slot) {
  const JointRecord& joint = w.joints.records[slot];
  const JointDetail* const detail = detail_of(w.joints, slot);
  if (detail != nullptr && detail->disabled) return false;
  return (joint.body_a != kNoBody && is_active(w, std::uint32_t(joint.body_a))) ||
         (joint.body_b != kNoBody && is_active(w, std::uint32_t(joint.body_b)));
}

SolveBatches find_batches(const RigidWorld& w, Arena& arena, TaskSystem& tasks, BatchSize size) {
  const std::span<const std::uint32_t> awake = w.bodies.awake;
  const std::span<std::uint32_t> places = arena.make<std::uint32_t>(w.bodies.motion.size());
  const Constraints constraints = list_constraints(w, arena, tasks);
  const std::size_t all_weights = kConstraint * constraints.size + awake.size();
  const auto share = std::uint32_t(all_weights / size.shares);
  const std::uint32_t most = min(kConstraint * size.most, max(share, kConstraint * kWorthSharing));
  if (all_weights <= most) {
    for (std::uint32_t i = 0; i < awake.size(); ++i) places[awake[i]] = i;
    const std::span<SolveBatch> all = arena.make<SolveBatch>(awake.empty() ? 0 : 1);
    if (!all.empty()) all[0] = {awake, constraints.contacts, constraints.joints};
    return {all, places};
  }
  const std::span<std::uint32_t> batch_of = arena.make<std::uint32_t>(places.size());
  Islands islands(w, constraints, places);
  const std::span<const std::uint32_t> weights = part_islands(
      w, islands, weigh_islands(w, constraints, islands, places.size(), arena), most, arena, batch_of);
  const std::size_t count = weights.size();
  const auto batch_of_contact = [&](std::uint32_t slot) {
    return batch_of[owner(w, w.contacts.contacts[slot])];
  };
  const auto batch_of_joint = [&](std::uint32_t slot) { return batch_of[owner(w, w.joints.records[slot])]; };
  Lists bodies(arena, count), contacts(arena, count), joints(arena, count);
  for (const std::uint32_t body : awake) bodies.count(batch_of[body]);
  for (const std::uint32_t slot : constraints.contacts) contacts.count(batch_of_contact(slot));
  for (const std::uint32_t slot : constraints.joints) joints.count(batch_of_joint(slot));
  bodies.make_room(arena), contacts.make_room(arena), joints.make_room(arena);
  for (const std::uint32_t body : awake) bodies.add(batch_of[body], body);
  for (const std::uint32_t slot : constraints.contacts) contacts.add(batch_of_contact(slot), slot);
  for (const std::uint32_t slot : constraints.joints) joints.add(batch_of_joint(slot), slot);
  const std::span<SolveBatch> batches = arena.make<SolveBatch>(count);
  for (std::size_t i = 0; i < count; ++i) {
    batches[i] = {bodies.of(i), contacts.of(i), joints.of(i), count > 1 && weights[i] <= most};
    for (std::uint32_t n = 0; n < batches[i].bodies.size(); ++n) places[batches[i].bodies[n]] = n;
  }
  return {batches, places};
}

}  // namespace gyre
