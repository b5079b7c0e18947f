#include "dynamics/gather_constraints.h"

#include "base/prefetch.h"
#include "rigid/batch/surface_rules.h"
#include "rigid/solve/speculative_contacts.h"
#include "solver/articulation/ball_joint_transfer.h"
#include "solver/rest/static_equilibrium.h"
#include "task/parallel.h"

#include <utility>

namespace gyre {

namespace {

// Largest speed of penetration removal, as a share of sqrt(gravity * size). A body that falls its own size has about that speed, so the
// rule holds from millimetres to kilometres.
constexpr float kPushShare = 0.4f;
// Manifolds and joints are fetched so many items ahead, for they are scattered in memory.
constexpr std::size_t kAhead = 6;
constexpr int kContactsPerGather = 64;
constexpr int kJointsPerGather = 128;

// The body as constraints store it: kNoBody if it never moves. Then its record is not read.
std::int32_t solver_body(const RigidWorld& w, std::uint32_t body) {
  const BodyFlags& flags = w.bodies.flags[body];
  return flags.type == BodyType::fixed || flags.frozen != 0 ? kNoBody : std::int32_t(body);
}

// Marks a body that other workers may mark at once: static bodies are in many batches. (std::atomic_ref is not used because Emscripten's
// library does not have it yet.)
void touch_shared(RigidWorld& w, std::uint32_t body, std::uint8_t touch) {
  std::uint8_t* const touched = &w.bodies.flags[body].constraint_use;
  std::uint8_t before = __atomic_load_n(touched, __ATOMIC_RELAXED);
  while (before < touch &&
         !__atomic_compare_exchange_n(touched, &before, touch, true, __ATOMIC_RELAXED, __ATOMIC_RELAXED)) {
  }
}

void fetch_manifold(const ContactStore& store, std::uint32_t slot) {
  prefetch(&store.manifolds[store.contacts[slot].first_manifold], sizeof(Manifold));
}

// Tells if any and if all points of a manifold carried load in the last step.
struct Loads {
  bool any = false, all = true;

  explicit Loads(const Manifold& manifold) {
    for (int k = 0; k < manifold.count; ++k) {
      const bool bears = manifold.points[k].normal_impulse > 0.0f;
      any |= bears;
      all &= bears;
    }
  }
};

// Writes the constraints of contacts into the lists.
class ContactGatherer {
 public:
  // `is_alone`: no other worker gathers contacts of the same batch.
  ContactGatherer(BatchContext& batch, bool is_alone)
      : lists_(batch.scratch.contacts),
        local_index_(batch.local_index),
        w_(batch.w),
        fall_(std::sqrt(reference_gravity(w_.settings))),
        has_rules_(!w_.surface_rules.empty()),
        in_lanes_(row_solver_of(batch.w) == nullptr),
        is_alone_(is_alone) {}

  // The properties found among some contacts.
  struct Found {
    bool gaps = false;  // some constraints have no manifold and are skipped
    bool bouncy = false;
    bool speculative = false;
  };

  Found gather(std::uint32_t slot, std::size_t index) const {
    const Contact& contact = w_.contacts.contacts[slot];
    const Ends ends = find_ends(contact);
    const bool speculative = in_lanes_ && is_speculative(w_, contact);
    const bool unseen = !speculative && is_far_ahead(w_, contact);
    // Bounces and speculative contacts act at present poses, with the inertia of present orientations.
    const bool reads_pose = speculative || contact.surface.restitution > 0.0f;
    touch_body(contact.body_a, ends.active_a, reads_pose ? kPoseRead : kConstrained);
    touch_body(contact.body_b, ends.active_b, reads_pose ? kPoseRead : kConstrained);
    const ColoringPair pair{ends.active_a ? local_index_[contact.body_a] : ColoringPair::kNone,
                            ends.active_b ? local_index_[contact.body_b] : ColoringPair::kNone};
    Found found;
    for (Manifold& manifold : manifolds_of(w_.contacts, contact)) {
      ContactConstraint& constraint = lists_.constraints[index];
      lists_.pairs[index] = pair;
      lists_.slots[index++] = slot;
      describe(contact, ends, constraint);
      if (unseen || !add_manifold(contact, manifold, constraint)) constraint.manifold = nullptr;
      constraint.speculative = speculative;
      found.speculative = found.speculative || speculative;
      found.gaps = found.gaps || constraint.manifold == nullptr;
      found.bouncy = found.bouncy || constraint.restitution > 0.0f;
    }
    return found;
  }

 private:
  // Data that depends on the contact's bodies and its size.
  struct Ends {
    bool active_a, active_b, linked;
    std::int32_t body_a, body_b;
    float push_speed;
  };

  Ends find_ends(const Contact& contact) const {
    Ends ends;
    ends.active_a = is_active(w_, contact.body_a);
    ends.active_b = is_active(w_, contact.body_b);
    ends.linked = (ends.active_a && !joints_of(w_.bodies, contact.body_a).empty()) ||
                  (ends.active_b && !joints_of(w_.bodies, contact.body_b).empty());
    ends.body_a = ends.active_a ? std::int32_t(contact.body_a) : solver_body(w_, contact.body_a);
    ends.body_b = ends.active_b ? std::int32_t(contact.body_b) : solver_body(w_, contact.body_b);
    ends.push_speed = kPushShare * fall_ * std::sqrt(contact.size);
    return ends;
  }
  // No atomics here: an active body is in one batch only.
  void touch_body(std::uint32_t body, bool active, std::uint8_t touch) const {
    if (!is_alone_ || !active) return touch_shared(w_, body, touch);
    std::uint8_t& touched = w_.bodies.flags[body].constraint_use;
    touched = max(touched, touch);
  }
  // Writes every member in place. A struct that is built elsewhere and copied in wider stores would wait for the narrow ones.
  static void describe(const Contact& contact, const Ends& ends, ContactConstraint& constraint) {
    constraint.static_friction = contact.surface.static_friction;
    constraint.dynamic_friction = contact.surface.dynamic_friction;
    constraint.rolling_friction = contact.surface.rolling_friction;
    constraint.spinning_friction = contact.surface.spinning_friction;
    constraint.size = contact.size;
    constraint.pushout_speed = ends.push_speed;
    constraint.surface_velocity = {};
    constraint.restitution = contact.surface.restitution;
    constraint.body_a = ends.body_a;
    constraint.body_b = ends.body_b;
    constraint.rigid = false;
    constraint.has_joint = ends.linked;
  }
  // Writes the members that depend on the manifold.
  bool add_manifold(const Contact& contact, Manifold& manifold, ContactConstraint& constraint) const {
    const Loads loads(manifold);
    constraint.manifold = &manifold;
    constraint.point_count = std::int8_t(manifold.count);
    constraint.loaded = loads.any;
    constraint.can_roll = false;
    constraint.stiffness = manifold.load_age >= kRigidContactAge ? ContactStiffness::rigid
                      : manifold.load_age > 0.0f            ? ContactStiffness::soft
                                                            : ContactStiffness::fresh;
    if (loads.all) {
      constraint.fast = false;
      for (int k = 0; k < manifold.count; ++k) manifold.points[k].approach_speed = 0.0f;
    } else {
      constraint.fast = record_hit_approach(w_, contact, manifold);
    }
    if (manifold.count == 0) return false;
    if (has_rules_ && !apply_surface_rules(w_, contact, manifold, constraint)) return false;
    if (contact.recycled == 0) constraint.can_roll = may_roll(w_, contact, constraint);
    constraint.spinning_friction +=
        manifold.count == 1 ? contact_patch_spin_friction(w_, contact, constraint) : 0.0f;
    return true;
  }

  ContactLists& lists_;
  std::span<const std::uint32_t> local_index_;
  RigidWorld& w_;
  float fall_;
  bool has_rules_;
  bool in_lanes_;  // solvers of rows know only the points as the step begins
  bool is_alone_;
};

void close_gaps(ContactLists& s) {
  std::size_t kept = 0;
  for (std::size_t i = 0; i < s.constraints.size(); ++i) {
    if (s.constraints[i].manifold == nullptr) continue;
    s.constraints[kept] = s.constraints[i];
    s.pairs[kept] = s.pairs[i];
    s.slots[kept++] = s.slots[i];
  }
  s.constraints.resize_uninitialized(kept);
  s.pairs.resize_uninitialized(kept);
  s.slots.resize_uninitialized(kept);
}

}  // namespace

void gather_contacts(BatchContext& batch, Arena& arena, TaskSystem& tasks) {
  const ArenaScope scope(arena);
  const RigidWorld& w = batch.w;
  ContactLists& s = batch.scratch.contacts;
  const std::span<const std::uint32_t> slots = batch.members.contacts;
  const auto waits = [&](std::uint32_t slot) { return !w.inactive_contacts.empty() && w.inactive_contacts[slot] != 0; };
  const auto for_each_block = [&](auto&& run) {
    for_blocks(tasks, int(slots.size()), kContactsPerGather,
               [&](int begin, int end, int) { run(std::size_t(begin), std::size_t(end)); });
  };
  // Returns the block of contacts at `begin`, for the list of each block's first constraint.
  const auto block_of = [](std::size_t begin) { return begin / std::size_t(kContactsPerGather); };
  const std::span<std::uint32_t> firsts =
      arena.make<std::uint32_t>(std::size_t(count_blocks(int(slots.size()), kContactsPerGather)));
  for_each_block([&](std::size_t begin, std::size_t end) {
    std::uint32_t manifolds = 0;
    for (const std::uint32_t slot : slots.subspan(begin, end - begin))
      if (!waits(slot)) manifolds += w.contacts.contacts[slot].manifold_count;
    firsts[block_of(begin)] = manifolds;
  });
  std::uint32_t count = 0;
  for (std::uint32_t& first : firsts) count += std::exchange(first, count);
  s.constraints.resize_uninitialized(count);
  s.pairs.resize_uninitialized(count);
  s.slots.resize_uninitialized(count);
  using Found = ContactGatherer::Found;
  const auto either = [](Found a, Found b) {
    return Found{a.gaps || b.gaps, a.bouncy || b.bouncy, a.speculative || b.speculative};
  };
  const ContactGatherer gatherer(batch, tasks.worker_count() == 1);
  const auto gather_block = [&](int begin, int end, int) {
    Found found;
    std::uint32_t index = firsts[block_of(std::size_t(begin))];
    for (std::size_t i = std::size_t(begin); i < std::size_t(end); ++i) {
      if (i + kAhead < slots.size()) fetch_manifold(w.contacts, slots[i + kAhead]);
      if (waits(slots[i])) continue;
      found = either(found, gatherer.gather(slots[i], index));
      index += w.contacts.contacts[slots[i]].manifold_count;
    }
    return found;
  };
  const Found found =
      reduce_blocks(tasks, int(slots.size()), kContactsPerGather, Found{}, gather_block, either);
  batch.contacts.has_speculative = found.speculative;
  if (found.gaps) close_gaps(s);
  s.impacts.clear();
  if (!found.bouncy) return;
  for (std::uint32_t i = 0; i < s.constraints.size(); ++i) {
    if (s.constraints[i].restitution > 0.0f) s.impacts.push_back(make_impact(s.constraints[i], i));
  }
}

void gather_joint_edges(BatchContext& batch, Arena& arena, TaskSystem& tasks) {
  RigidWorld& w = batch.w;
  JointSolve& joints = batch.joints;
  joints.edges = arena.make<JointEdge>(joints.batch.joints.size());
  joints.ball_lanes = arena.make<std::uint8_t>(joints.batch.joints.size());
  const auto touch = [&](std::int32_t body, bool is_spring) {
    if (body == kNoBody) return kNoBody;
    if (!is_spring) touch_shared(w, std::uint32_t(body), kPoseRead);
    return is_active(w, std::uint32_t(body)) ? body : kNoBody;
  };
  const int count = int(joints.batch.joints.size());
  for_blocks(tasks, count, kJointsPerGather, [&](int begin, int end, int) {
    for (std::size_t i = std::size_t(begin); i < std::size_t(end); ++i) {
      if (i + kAhead < joints.batch.joints.size()) fetch_joint(w.joints, joints.batch.joints[i + kAhead]);
      const std::uint32_t slot = joints.batch.joints[i];
      const JointRecord& joint = w.joints.records[slot];
      const JointDetail* const detail = detail_of(w.joints, slot);
      const bool is_spring = batch.motion.is_smooth && is_explicit_spring(w, slot);
      joints.edges[i] = {touch(joint.body_a, is_spring), touch(joint.body_b, is_spring),
                         count_equations(joint, detail)};
      joints.ball_lanes[i] = fits_ball_lane(joint, detail) ? 1 : 0;
    }
  });
}

void gather_swept_joints(BatchContext& batch) {
  const JointSolve& joints = batch.joints;
  JointLists& s = joints.lists;
  const std::size_t most = joints.batch.joints.size();
  s.swept.resize_uninitialized(most);
  s.pairs.resize_uninitialized(most);
  std::size_t count = 0;
  const auto local = [&](std::int32_t body) {
    return body == kNoBody ? ColoringPair::kNone : joints.local_index[std::size_t(body)];
  };
  for (std::uint32_t i = 0; i < most; ++i) {
    if (joints.articulations.iterative[i] == 0) continue;
    if (batch.motion.is_smooth && is_explicit_spring(batch.w, joints.batch.joints[i])) continue;
    const JointEdge& joint = joints.edges[i];
    s.swept[count] = i;
    s.pairs[count++] = {local(joint.body_a), local(joint.body_b)};
  }
  s.swept.resize_uninitialized(count);
  s.pairs.resize_uninitialized(count);
}

}  // namespace gyre
