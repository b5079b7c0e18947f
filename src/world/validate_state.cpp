// The rules, by group. See validate_state.h.
#include "world/validate_state.h"

#include "base/container/disjoint_sets.h"
#include "base/float_mode.h"
#include "collision/broadphase/fat_box.h"
#include "dynamics/island_batches.h"
#include "rigid/sleep/island.h"
#include "rigid/solve/speculative_contacts.h"
#include "world/world_state.h"

#include <vector>

namespace gyre {

namespace {

Error broken(const char* rule) { return make_error(ErrorCode::invalid_data, "%s", rule); }
template <class... Args>
Error broken(const char* rule, Args... args) {
  return make_error(ErrorCode::invalid_data, rule, args...);
}

class StateValidator {
 public:
  StateValidator(const WorldState& s, std::optional<StageName> after) : s_(s), w_(s.rigid), after_(after) {}

  Error run();

 private:
  // True if the stage is done; between steps all are.
  bool is_past(StageName stage) const { return !after_ || *after_ >= stage; }
  // Between the solve and finish_bodies, velocities and orientations are new and not yet checked to be finite.
  bool is_within_solve() const {
    return after_ && *after_ >= StageName::solve && *after_ < StageName::finish_bodies;
  }
  bool is_right_after(StageName stage) const { return after_ && *after_ == stage; }

  void list_changed();
  Error lists_of_bodies() const;
  Error list_of_awake() const;
  Error active_constraints() const;
  Error blocked_bodies() const;
  Error poses() const;
  Error fat_boxes() const;
  Error contacts_have_pairs() const;
  Error pairs_have_contacts() const;
  Error groups_of_constraints() const;
  Error groups_of_batch(const BatchScratch& solve) const;
  Error everything_is_solved() const;
  Error islands() const;
  Error no_sleeper_touches_motion() const;

  bool is_in_broadphase(std::uint32_t shape) const { return changed_mark_[shape] == 0; }

  const WorldState& s_;
  const RigidWorld& w_;
  std::optional<StageName> after_;
  std::vector<std::uint32_t> changed_;      // proxies that the broad phase does not know yet; ascending
  std::vector<std::uint8_t> changed_mark_;  // the same by shape
};

void StateValidator::list_changed() {
  changed_mark_.assign(w_.shapes.proxies.size(), 0);
  for (const std::uint32_t shape : w_.shapes.changed) changed_mark_[shape] = 1;
  for (std::uint32_t shape = 0; shape < changed_mark_.size(); ++shape) {
    if (changed_mark_[shape] != 0) changed_.push_back(shape);
  }
}

// Each shape is in the list of its body and each joint in those of its bodies, once and ascending. The lists have no
// other entries.
Error StateValidator::lists_of_bodies() const {
  std::size_t listed_shapes = 0, listed_joints = 0, joint_ends = 0;
  for (std::uint32_t body = 0; body < w_.bodies.ids.capacity(); ++body) {
    const std::span<const ShapeId> shapes = w_.bodies.shapes[body];
    const std::span<const std::uint32_t> joints = joints_of(w_.bodies, body);
    if (!w_.bodies.ids.live(body) && (!shapes.empty() || !joints.empty()))
      return broken("body %u was removed but has shapes or joints", body);
    for (std::size_t i = 0; i < shapes.size(); ++i) {
      const std::uint32_t shape = shapes[i].index;
      if (!w_.shapes.ids.live(shape) || w_.shapes.bodies[shape] != body ||
          !(shapes[i] == shape_id(w_, shape)))
        return broken("body %u lists shape %u, which is not its own", body, shape);
      if (i > 0 && shapes[i - 1].index >= shape)
        return broken("the shapes of body %u are not in order", body);
    }
    for (std::size_t i = 0; i < joints.size(); ++i) {
      if (!w_.joints.ids.live(joints[i]))
        return broken("body %u lists joint %u, which was removed", body, joints[i]);
      const JointRecord& joint = w_.joints.records[joints[i]];
      if (joint.body_a != std::int32_t(body) && joint.body_b != std::int32_t(body))
        return broken("body %u lists joint %u, which is between others", body, joints[i]);
      if (i > 0 && joints[i - 1] >= joints[i]) return broken("the joints of body %u are not in order", body);
    }
    listed_shapes += shapes.size();
    listed_joints += joints.size();
  }
  w_.joints.ids.for_each_live([&](std::uint32_t slot) {
    joint_ends += w_.joints.records[slot].body_a != kNoBody ? 1 : 0;
    joint_ends += w_.joints.records[slot].body_b != kNoBody ? 1 : 0;
  });
  if (listed_shapes != w_.shapes.ids.size()) return broken("a shape is not in the list of its body");
  if (listed_joints != joint_ends) return broken("a joint is not in the list of its body");
  return {};
}

Error StateValidator::list_of_awake() const {
  if (w_.bodies.awake_stale) return {};
  std::size_t next = 0, sleeping_count = 0;
  for (std::uint32_t body = 0; body < w_.bodies.ids.capacity(); ++body) {
    const BodyFlags& flags = w_.bodies.flags[body];
    const bool awake =
        w_.bodies.ids.live(body) && flags.type != BodyType::fixed && flags.awake != 0 && flags.frozen == 0;
    sleeping_count += w_.bodies.ids.live(body) && is_movable(flags) && flags.awake == 0 ? 1 : 0;
    const bool listed = next < w_.bodies.awake.size() && w_.bodies.awake[next] == body;
    if (awake != listed)
      return broken("body %u is %s but %s listed so", body, awake ? "awake" : "not awake",
                    listed ? "is" : "is not");
    if (listed) ++next;
  }
  if (sleeping_count != w_.bodies.sleeping_count)
    return broken("%zu bodies sleep, not %zu", sleeping_count, w_.bodies.sleeping_count);
  return next == w_.bodies.awake.size() ? Error{}
                                        : broken("the list of awake bodies has more than there are");
}

// Each contact and joint of a simulated body is active. More active ones only cost time.
Error StateValidator::active_constraints() const {
  const auto moves = [&](std::uint32_t body) { return is_simulated(w_.bodies.flags[body]); };
  for (std::uint32_t slot = 0; slot < w_.contacts.contacts.size(); ++slot) {
    const Contact& contact = w_.contacts.contacts[slot];
    if (contact.manifold_room == 0 || w_.active_constraints.contacts.test(slot)) continue;
    if (moves(contact.body_a) || moves(contact.body_b))
      return broken("contact %u has an awake body, but nobody asks it", slot);
  }
  for (std::uint32_t slot = 0; slot < w_.joints.ids.capacity(); ++slot) {
    if (!w_.joints.ids.live(slot) || w_.active_constraints.joints.test(slot)) continue;
    const JointRecord& joint = w_.joints.records[slot];
    if ((joint.body_a != kNoBody && moves(std::uint32_t(joint.body_a))) ||
        (joint.body_b != kNoBody && moves(std::uint32_t(joint.body_b))))
      return broken("joint %u has an awake body, but nobody asks it", slot);
  }
  return {};
}

Error StateValidator::blocked_bodies() const {
  std::size_t joints = 0, counted = 0;
  Error error;
  w_.joints.ids.for_each_live([&](std::uint32_t slot) {
    const JointRecord& joint = w_.joints.records[slot];
    if (joint.collide_connected || joint.body_a == kNoBody || joint.body_b == kNoBody) return;
    ++joints;
    if (!w_.joints.blocked.contains(pair_key(std::uint32_t(joint.body_a), std::uint32_t(joint.body_b))))
      error = broken("joint %u keeps its bodies from colliding, but they are not known to be kept", slot);
  });
  if (error) return error;
  for (const IgnoredPair& pair : w_.ignored_pairs) {
    ++joints;
    if (!w_.joints.blocked.contains(pair_key(pair.a, pair.b)))
      error = broken("bodies %u and %u ignore each other, but that is not known", pair.a, pair.b);
  }
  if (error) return error;
  w_.joints.blocked.for_each([&](std::uint64_t, std::uint32_t count) { counted += count; });
  return joints == counted ? Error{} : broken("bodies are kept from colliding by more joints than there are");
}

// Orientations equal those of the poses.
Error StateValidator::poses() const {
  if (is_within_solve()) return {};
  for (std::uint32_t body = 0; body < w_.bodies.ids.capacity(); ++body) {
    if (!w_.bodies.ids.live(body)) continue;
    if (!(w_.bodies.orientations[body] == w_.bodies.poses[body].orientation))
      return broken("body %u has two orientations", body);
  }
  return {};
}

Error StateValidator::fat_boxes() const {
  for (std::uint32_t shape = 0; shape < w_.shapes.ids.capacity(); ++shape) {
    if (!w_.shapes.ids.live(shape)) continue;
    const ColliderShape& collider = w_.shapes.colliders[shape];
    const WorldBox tight =
        world_box(collider.shape, origin_pose(w_.bodies, w_.shapes.bodies[shape]) * collider.body_from_shape);
    const Aabb& fat = w_.shapes.proxies[shape].fat_box;
    for (int axis = 0; axis < 3; ++axis) {
      if (double(fat.low[axis]) > tight.low[axis] || double(fat.high[axis]) < tight.high[axis])
        return broken("the fat box of shape %u does not contain the shape", shape);
    }
  }
  if (w_.broadphase_stale) return {};
  const char* const fault = w_.broadphase->find_fault(w_.shapes.proxies, changed_);
  return fault != nullptr ? broken("broad phase: %s", fault) : Error{};
}

Error StateValidator::contacts_have_pairs() const {
  if (const char* const fault = find_fault(w_.contacts)) return broken("contacts: %s", fault);
  for (std::uint32_t slot = 0; slot < w_.contacts.contacts.size(); ++slot) {
    const Contact& contact = w_.contacts.contacts[slot];
    if (contact.manifold_room == 0) continue;
    const Proxy &a = w_.shapes.proxies[contact.shape_a], &b = w_.shapes.proxies[contact.shape_b];
    if (!may_pair(a, b))
      return broken("contact %u is of shapes %u and %u, which may not touch", slot, contact.shape_a,
                    contact.shape_b);
    if (w_.joints.blocked.contains(pair_key(contact.body_a, contact.body_b)))
      return broken("contact %u is of bodies %u and %u, which a joint keeps from colliding", slot,
                    contact.body_a, contact.body_b);
    // The stage link_islands removes pairs whose fat boxes separated.
    if (!is_past(StageName::link_islands) || !is_in_broadphase(contact.shape_a) ||
        !is_in_broadphase(contact.shape_b))
      continue;
    if (!overlap(a.fat_box, b.fat_box))
      return broken("contact %u is of shapes %u and %u, whose fat boxes are apart", slot, contact.shape_a,
                    contact.shape_b);
  }
  return {};
}

Error StateValidator::pairs_have_contacts() const {
  if (w_.broadphase_stale || !is_past(StageName::find_pairs)) return {};
  Array<std::uint32_t> found;
  for (std::uint32_t shape = 0; shape < w_.shapes.ids.capacity(); ++shape) {
    if (!w_.shapes.ids.live(shape) || !is_in_broadphase(shape)) continue;
    const Proxy& proxy = w_.shapes.proxies[shape];
    found.clear();
    w_.broadphase->query(w_.shapes.proxies, proxy.fat_box, found);
    for (const std::uint32_t other : found) {
      if (other <= shape || !is_in_broadphase(other)) continue;
      const Proxy& other_proxy = w_.shapes.proxies[other];
      if (!may_pair(proxy, other_proxy) || w_.joints.blocked.contains(pair_key(proxy.body, other_proxy.body)))
        continue;
      if (find_contact(w_.contacts, pair_key(shape, other)) == SlotTable::kNone)
        return broken("the fat boxes of shapes %u and %u overlap, but they have no contact", shape, other);
    }
  }
  return {};
}

// No colour has a moving body twice, and each constraint has one colour. The results of the last solve are checked
// between steps, too.
Error StateValidator::groups_of_constraints() const {
  Error fault = groups_of_batch(s_.solve.together);
  for (const std::unique_ptr<WorkerContext>& worker : s_.solve.workers) {
    if (fault.ok()) fault = groups_of_batch(worker->scratch);
  }
  return fault;
}
Error StateValidator::groups_of_batch(const BatchScratch& solve) const {
  const auto fits = [](std::span<const ColoringPair> pairs, const Coloring& colors) {
    return pairs.empty() ||
           validate_coloring(pairs, std::uint32_t(colors.masks.size()), {}, kColoringOptions, colors);
  };
  if (!fits(solve.contacts.pairs, solve.contact_colors))
    return broken("a group of contacts has a moving body twice");
  if (!fits(solve.joints.pairs, solve.joint_colors))
    return broken("a group of joints has a moving body twice");
  return {};
}

// True if the lists of all batches together are the slots with acts(slot), each once.
template <class Acts>
bool are_all(const IslandBatches& batches, std::span<const std::uint32_t> SolveBatch::*list,
             std::size_t slots, const Acts& acts) {
  std::vector<std::uint8_t> listed(slots);
  for (const SolveBatch& batch : batches.batches) {
    for (std::size_t i = 0; i < (batch.*list).size(); ++i) {
      const std::uint32_t slot = (batch.*list)[i];
      if (slot >= slots || (i > 0 && (batch.*list)[i - 1] >= slot) || listed[slot]++ != 0) return false;
    }
  }
  for (std::uint32_t slot = 0; slot < slots; ++slot) {
    if (acts(slot) != (listed[slot] != 0)) return false;
  }
  return true;
}

// Each acting constraint is in one batch, which has all bodies that it moves, and the solver had as many constraints.
// The batches are found again with a smaller size, so that there are several.
Error StateValidator::everything_is_solved() const {
  Arena arena;
  TaskSystem alone;
  const IslandBatches batches = find_batches(w_, {}, arena, alone, {.most = 16});
  const auto acts = [&](std::uint32_t slot) { return is_solved(w_, w_.contacts.contacts[slot]); };
  if (!are_all(batches, &SolveBatch::contacts, w_.contacts.contacts.size(), acts))
    return broken("a contact with manifolds and an awake body is not in one batch");
  const auto joint_acts = [&](std::uint32_t slot) {
    return w_.joints.ids.live(slot) && is_joint_solved(w_, slot);
  };
  if (!are_all(batches, &SolveBatch::joints, w_.joints.ids.capacity(), joint_acts))
    return broken("a joint with an awake body is not in one batch");
  std::vector<std::uint32_t> batch_of(w_.bodies.motion.size(), 0xffffffffu);
  std::size_t manifolds = 0, far_ahead = 0, joints = 0, bodies = 0;
  for (std::uint32_t i = 0; i < batches.batches.size(); ++i) {
    for (const std::uint32_t body : batches.batches[i].bodies) batch_of[body] = i;
    bodies += batches.batches[i].bodies.size();
    joints += batches.batches[i].joints.size();
  }
  if (bodies != w_.bodies.awake.size()) return broken("the batches are not of all awake bodies");
  const auto is_elsewhere = [&](std::uint32_t body, std::uint32_t batch) {
    return w_.bodies.flags[body].type != BodyType::fixed && batch_of[body] != 0xffffffffu &&
           batch_of[body] != batch;
  };
  for (std::uint32_t i = 0; i < batches.batches.size(); ++i) {
    for (const std::uint32_t slot : batches.batches[i].contacts) {
      const Contact& contact = w_.contacts.contacts[slot];
      if (is_elsewhere(contact.body_a, i) || is_elsewhere(contact.body_b, i))
        return broken("contact %u is in another batch than its bodies", slot);
      for (const Manifold& manifold : manifolds_of(w_.contacts, contact))
        manifolds += manifold.count > 0 ? 1 : 0;
      far_ahead += is_far_ahead(w_, contact) ? 1 : 0;
    }
  }
  // Those far ahead may be left out.
  if (manifolds - far_ahead > s_.solve.counts.manifolds || s_.solve.counts.manifolds > manifolds)
    return broken("the solver has other manifolds than those that touch");
  return joints == s_.solve.counts.joints ? Error{}
                                          : broken("the solver has other joints than those that act");
}

// The bodies of a sleeping group are connected if they fell asleep by themselves. Bodies that were put to sleep in
// motion may have contacts that are about to end.
Error StateValidator::islands() const {
  std::vector<std::uint32_t> parent(w_.bodies.motion.size());
  const DisjointSets sets(parent);
  for_each_island_edge(w_, [&](std::uint32_t a, std::uint32_t b) {
    if (is_movable(w_.bodies.flags[a]) && is_movable(w_.bodies.flags[b])) sets.unite(a, b);
  });
  std::vector<std::uint8_t> fell_asleep_moving(parent.size(), 0);
  for (const BodySleep& sleep : w_.bodies.sleep) {
    if (sleep.group != kNoGroup && sleep.still_time < kTimeToSleep) fell_asleep_moving[sleep.group] = 1;
  }
  for (std::uint32_t body = 0; body < parent.size(); ++body) {
    const std::uint32_t group = w_.bodies.sleep[body].group;
    if (group == kNoGroup || fell_asleep_moving[group] != 0) continue;
    if (sets.of(body) != sets.of(group))
      return broken("body %u sleeps in the group of body %u, but nothing links them", body, group);
  }
  return {};
}

Error StateValidator::no_sleeper_touches_motion() const {
  Error error;
  for_each_island_edge(w_, [&](std::uint32_t a, std::uint32_t b) {
    const auto check = [&](std::uint32_t sleeper, std::uint32_t other) {
      const BodyFlags& flags = w_.bodies.flags[sleeper];
      if (is_movable(flags) && flags.awake == 0 && can_wake_others(w_, other))
        error = broken("body %u sleeps, although body %u beside it moves", sleeper, other);
    };
    check(a, b);
    check(b, a);
  });
  return error;
}

Error StateValidator::run() {
  Error error = is_within_solve() ? Error{} : check_columns(w_);
  const auto next = [&](Error (StateValidator::*rule)() const, bool holds = true) {
    if (error.ok() && holds) error = (this->*rule)();
  };
  if (error) return error;
  list_changed();
  next(&StateValidator::lists_of_bodies);
  next(&StateValidator::list_of_awake);
  next(&StateValidator::blocked_bodies);
  next(&StateValidator::poses);
  next(&StateValidator::contacts_have_pairs);
  next(&StateValidator::fat_boxes);
  next(&StateValidator::pairs_have_contacts);
  next(&StateValidator::groups_of_constraints);
  next(&StateValidator::islands);
  next(&StateValidator::no_sleeper_touches_motion, is_right_after(StageName::link_islands));
  next(&StateValidator::active_constraints);
  next(&StateValidator::everything_is_solved, is_right_after(StageName::solve));
  return error;
}

}  // namespace

Error validate_state(const WorldState& state, std::optional<StageName> after) {
  const FloatMode mode;  // derived data is computed again, with the same rounding
  return StateValidator(state, after).run();
}

}  // namespace gyre
