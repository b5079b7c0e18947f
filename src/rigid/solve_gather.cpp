#include "rigid/solve_gather.h"

#include "base/cold.h"
#include "base/prefetch.h"
#include "rigid/hits.h"
#include "rigid/surface_rules.h"
#include "solver/ball_records.h"
#include "solver/contact_structure.h"
#include "task/parallel.h"

#include <utility>

namespace gyre {

namespace {

// The fastest that overlap is taken back, as a share of sqrt(gravity * size): falling its own size is a body's natural
// scale of speed, so the rule holds from millimetres to kilometres.
constexpr float kPushShare = 0.4f;
// Manifolds and joints lie anywhere in memory: how many places before its turn one is asked for.
constexpr std::size_t kAhead = 6;
constexpr int kContactsPerBlock = 64;
constexpr int kJointsPerBlock = 128;

// A body as constraints know it: kNoBody if it never moves (its record is then never read).
std::int32_t solver_body(const RigidWorld& w, std::uint32_t body) {
  const BodyFlags& flags = w.bodies.flags[body];
  return flags.type == BodyType::fixed || flags.frozen != 0 ? kNoBody : std::int32_t(body);
}

// Others may touch it at once: what is fixed is in many batches. (Not std::atomic_ref: Emscripten's library has none yet.)
void touch_shared(RigidWorld& w, std::uint32_t body, std::uint8_t touch) {
  std::uint8_t* const touched = &w.bodies.flags[body].touched;
  std::uint8_t before = __atomic_load_n(touched, __ATOMIC_RELAXED);
  while (before < touch &&
         !__atomic_compare_exchange_n(touched, &before, touch, true, __ATOMIC_RELAXED, __ATOMIC_RELAXED)) {
  }
}

void fetch_manifold(const ContactStore& store, std::uint32_t slot) {
  prefetch(&store.manifolds[store.contacts[slot].first_manifold], sizeof(Manifold));
}

// Which points of a manifold bore load in the last step.
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

// Writes the constraints of contacts to their places in the lists.
class ContactGatherer {
 public:
  // `is_alone`: no other worker gathers contacts of the same batch.
  ContactGatherer(Solve& solve, bool is_alone)
      : solve_(solve),
        w_(solve.w),
        fall_(std::sqrt(length(w_.settings.gravity))),
        has_rules_(!w_.surface_rules.empty()),
        is_alone_(is_alone) {}

  // What was found among some contacts.
  struct Found {
    bool gaps = false;  // constraints without a manifold: nothing is asked of these
    bool bouncy = false;
  };

  Found gather(std::uint32_t slot, std::size_t place) const {
    const Contact& contact = w_.contacts.contacts[slot];
    const Ends ends = find_ends(contact);
    const std::uint8_t touch = contact.surface.restitution > 0.0f ? kPlaceShown : kTouched;
    touch_body(contact.body_a, ends.active_a, touch);
    touch_body(contact.body_b, ends.active_b, touch);
    const ColoringPair pair{ends.active_a ? solve_.places[contact.body_a] : ColoringPair::kNone,
                            ends.active_b ? solve_.places[contact.body_b] : ColoringPair::kNone};
    BatchScratch& s = solve_.scratch;
    Found found;
    for (Manifold& manifold : manifolds_of(w_.contacts, contact)) {
      ContactConstraint& constraint = s.constraints[place];
      s.pairs[place] = pair;
      s.constraint_contact[place++] = slot;
      describe(contact, ends, constraint);
      if (!add_manifold(contact, manifold, constraint)) constraint.manifold = nullptr;
      found.gaps = found.gaps || constraint.manifold == nullptr;
      found.bouncy = found.bouncy || constraint.restitution > 0.0f;
    }
    return found;
  }

 private:
  // What follows from the two bodies of a contact, and its size.
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
    ends.push_speed = kPushShare * (fall_ > 0.0f ? fall_ : 3.132f) * std::sqrt(contact.size);
    return ends;
  }
  // A body that is active is in one batch only.
  void touch_body(std::uint32_t body, bool active, std::uint8_t touch) const {
    if (!is_alone_ || !active) return touch_shared(w_, body, touch);
    std::uint8_t& touched = w_.bodies.flags[body].touched;
    touched = max(touched, touch);
  }
  // Every member is written, at its place: what is built elsewhere and copied in wider pieces waits for the smaller ones.
  static void describe(const Contact& contact, const Ends& ends, ContactConstraint& constraint) {
    constraint.static_friction = contact.surface.static_friction;
    constraint.dynamic_friction = contact.surface.dynamic_friction;
    constraint.rolling_friction = contact.surface.rolling_friction;
    constraint.spinning_friction = contact.surface.spinning_friction;
    constraint.size = contact.size;
    constraint.push_speed = ends.push_speed;
    constraint.surface_velocity = {};
    constraint.restitution = contact.surface.restitution;
    constraint.body_a = ends.body_a;
    constraint.body_b = ends.body_b;
    constraint.rigid = false;
    constraint.linked = ends.linked;
  }
  // The rest of the members.
  bool add_manifold(const Contact& contact, Manifold& manifold, ContactConstraint& constraint) const {
    const Loads loads(manifold);
    constraint.manifold = &manifold;
    constraint.point_count = std::int16_t(manifold.count);
    constraint.loaded = loads.any;
    constraint.may_roll = false;
    constraint.hold = manifold.age >= kHeldAge ? ContactHold::held
                      : manifold.age > 0.0f    ? ContactHold::sprung
                                               : ContactHold::none;
    if (loads.all) {
      constraint.fast = false;
      for (int k = 0; k < manifold.count; ++k) manifold.points[k].approach_speed = 0.0f;
    } else {
      constraint.fast = note_approach(w_, contact, manifold);
    }
    if (manifold.count == 0) return false;
    if (has_rules_ && !apply_surface_rules(w_, contact, manifold, constraint)) return false;
    if (contact.recycled == 0) constraint.may_roll = may_roll(w_, contact, constraint);
    constraint.spinning_friction += manifold.count == 1 ? patch_friction(w_, contact, constraint) : 0.0f;
    return true;
  }

  Solve& solve_;
  RigidWorld& w_;
  float fall_;
  bool has_rules_;
  bool is_alone_;
};

void close_gaps(BatchScratch& s) {
  std::size_t kept = 0;
  for (std::size_t i = 0; i < s.constraints.size(); ++i) {
    if (s.constraints[i].manifold == nullptr) continue;
    s.constraints[kept] = s.constraints[i];
    s.pairs[kept] = s.pairs[i];
    s.constraint_contact[kept++] = s.constraint_contact[i];
  }
  s.constraints.resize_uninitialized(kept);
  s.pairs.resize_uninitialized(kept);
  s.constraint_contact.resize_uninitialized(kept);
}

}  // namespace

void gather_contacts(Solve& solve, Arena& arena, TaskSystem& tasks) {
  const ArenaScope scope(arena);
  const RigidWorld& w = solve.w;
  BatchScratch& s = solve.scratch;
  const std::span<const std::uint32_t> slots = solve.batch.contacts;
  const auto waits = [&](std::uint32_t slot) { return !w.waiting.empty() && w.waiting[slot] != 0; };
  const auto for_each_block = [&](auto&& run) {
    for_blocks(tasks, int(slots.size()), kContactsPerBlock,
               [&](int begin, int end, int) { run(std::size_t(begin), std::size_t(end)); });
  };
  // Where the constraints of a block of contacts begin.
  const auto block_of = [](std::size_t begin) { return begin / std::size_t(kContactsPerBlock); };
  const std::span<std::uint32_t> firsts =
      arena.make<std::uint32_t>(std::size_t(count_blocks(int(slots.size()), kContactsPerBlock)));
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
  s.constraint_contact.resize_uninitialized(count);
  using Found = ContactGatherer::Found;
  const auto either = [](Found a, Found b) { return Found{a.gaps || b.gaps, a.bouncy || b.bouncy}; };
  const ContactGatherer gatherer(solve, tasks.worker_count() == 1);
  const auto gather_block = [&](int begin, int end, int) {
    Found found;
    std::uint32_t place = firsts[block_of(std::size_t(begin))];
    for (std::size_t i = std::size_t(begin); i < std::size_t(end); ++i) {
      if (i + kAhead < slots.size()) fetch_manifold(w.contacts, slots[i + kAhead]);
      if (waits(slots[i])) continue;
      found = either(found, gatherer.gather(slots[i], place));
      place += w.contacts.contacts[slots[i]].manifold_count;
    }
    return found;
  };
  const Found found =
      reduce_blocks(tasks, int(slots.size()), kContactsPerBlock, Found{}, gather_block, either);
  if (found.gaps) close_gaps(s);
  s.impacts.clear();
  if (!found.bouncy) return;
  for (const ContactConstraint& constraint : s.constraints) {
    if (constraint.restitution > 0.0f) s.impacts.push_back(make_impact(constraint));
  }
}

void look_at_joints(Solve& solve, Arena& arena, TaskSystem& tasks) {
  RigidWorld& w = solve.w;
  solve.net_joints = arena.make<NetJoint>(solve.batch.joints.size());
  solve.ball_lanes = arena.make<std::uint8_t>(solve.batch.joints.size());
  const auto look = [&](std::int32_t body, bool is_spring) {
    if (body == kNoBody) return kNoBody;
    if (!is_spring) touch_shared(w, std::uint32_t(body), kPlaceShown);
    return is_active(w, std::uint32_t(body)) ? body : kNoBody;
  };
  const int count = int(solve.batch.joints.size());
  for_blocks(tasks, count, kJointsPerBlock, [&](int begin, int end, int) {
    for (std::size_t i = std::size_t(begin); i < std::size_t(end); ++i) {
      if (i + kAhead < solve.batch.joints.size()) fetch_joint(w.joints, solve.batch.joints[i + kAhead]);
      const std::uint32_t slot = solve.batch.joints[i];
      const JointRecord& joint = w.joints.records[slot];
      const JointDetail* const detail = detail_of(w.joints, slot);
      const bool is_spring = solve.is_smooth && is_explicit_spring(w, slot);
      solve.net_joints[i] = {look(joint.body_a, is_spring), look(joint.body_b, is_spring),
                             count_equations(joint, detail)};
      solve.ball_lanes[i] = fits_ball_lane(joint, detail) ? 1 : 0;
    }
  });
}

void gather_joints(Solve& solve) {
  BatchScratch& s = solve.scratch;
  const std::size_t most = solve.batch.joints.size();
  s.swept_joints.resize_uninitialized(most);
  s.joint_pairs.resize_uninitialized(most);
  std::size_t count = 0;
  const auto place = [&](std::int32_t body) {
    return body == kNoBody ? ColoringPair::kNone : solve.places[std::size_t(body)];
  };
  for (std::uint32_t i = 0; i < most; ++i) {
    if (solve.linkages.swept[i] == 0) continue;
    if (solve.is_smooth && is_explicit_spring(solve.w, solve.batch.joints[i])) continue;
    const NetJoint& joint = solve.net_joints[i];
    s.swept_joints[count] = i;
    s.joint_pairs[count++] = {place(joint.body_a), place(joint.body_b)};
  }
  s.swept_joints.resize_uninitialized(count);
  s.joint_pairs.resize_uninitialized(count);
}

namespace {

// The kernels leave out what no body of a block needs: those that turn by another way lie apart.
constexpr std::uint8_t kTurnsAlone = 0, kNeverSwerves = 1, kSwerves = 2, kWaysToTurn = 3;
std::uint8_t way_to_turn(const Solve& solve, std::uint32_t body) {
  if (turns_alone(solve.w.bodies, body, solve.motions.substep)) return kTurnsAlone;
  return solve.w.bodies.masses[body].isotropic != 0 ? kNeverSwerves : kSwerves;
}

// Whether there are bundles, and nothing but they and contacts comes between the moves of bodies.
bool goes_in_runs(const Solve& solve) {
  const BatchScratch& s = solve.scratch;
  return !solve.bundles.bundles.empty() && !solve.is_smooth && s.impacts.empty() && s.swept_joints.empty() &&
         solve.linkages.linkages.empty() && solve.fields.blocks() == 0;
}

// The bodies of runs of bundles come first, run by run. Marks them in `kinds`, by place in the batch.
GYRE_COLD void list_runs(Solve& solve, const BundleRuns& runs, std::span<std::uint8_t> kinds,
                         std::uint8_t mark, Arena& arena) {
  const ArenaScope scope(arena);
  const std::size_t width = std::size_t(solve.kernels.width);
  for (const BundleRun& run : runs.of_bundles()) {
    const std::span<std::int32_t> bodies = arena.make<std::int32_t>(std::size_t(run.blocks) * width);
    list_pushed(solve.bundles, run, bodies);
    for (std::size_t i = 0; i < bodies.size(); ++i) {
      solve.moved[std::size_t(run.first_block) * width + i].body = bodies[i];
      if (bodies[i] != kNoBody) kinds[solve.places[std::size_t(bodies[i])]] = mark;
    }
  }
}

// Lists the bodies that constraints act on, and the others.
void part_bodies(Solve& solve, Arena& arena, TaskSystem& tasks) {
  const RigidWorld& w = solve.w;
  const std::span<const std::uint32_t> bodies = solve.batch.bodies;
  const int width = solve.kernels.width;
  BundleRuns runs(goes_in_runs(solve) ? solve.bundles : BundleSolve{}, bodies.size(), width, arena);
  const std::size_t led = std::size_t(runs.count_blocks() * width);
  solve.moved = arena.make<MovedBody>(led + bodies.size());
  solve.flying = arena.make<std::uint32_t>(bodies.size());
  const std::span<int> bounds = arena.make<int>(std::size_t(solve.domains.count() + 1));
  const ArenaScope scope(arena);
  // Where a body belongs: those in contact first, by domain and the way in which they turn.
  static_assert((kMostDomains + 1) * kWaysToTurn + 3 < 256, "kinds are bytes");
  const int domains = solve.domains.count();
  const std::uint8_t apart = std::uint8_t(domains * kWaysToTurn), flies = std::uint8_t(apart + kWaysToTurn),
                     stays = std::uint8_t(flies + 1), in_run = std::uint8_t(stays + 1);
  const std::span<std::uint8_t> kinds = arena.make<std::uint8_t>(bodies.size());
  for (std::uint8_t& kind : kinds) kind = apart;
  const auto touch = [&](std::uint32_t body) {
    if (body != ColoringPair::kNone) kinds[body] = std::uint8_t(solve.domains.of(body) * kWaysToTurn);
  };
  for (const ColoringPair& pair : solve.scratch.pairs) touch(pair.a), touch(pair.b);
  list_runs(solve, runs, kinds, in_run, arena);
  for_blocks(tasks, int(bodies.size()), kBodiesPerBlock, [&](int begin, int end, int) {
    for (std::size_t i = std::size_t(begin); i < std::size_t(end); ++i) {
      if (kinds[i] == in_run) continue;
      const BodyFlags& flags = w.bodies.flags[bodies[i]];
      kinds[i] = flags.touched != kUntouched ? std::uint8_t(kinds[i] + way_to_turn(solve, bodies[i]))
                 : !solve.is_smooth || !is_movable(flags) ? flies
                                                          : stays;
    }
  });
  std::uint32_t starts[(kMostDomains + 1) * kWaysToTurn + 4] = {};
  for (const std::uint8_t kind : kinds) ++starts[kind + 1];
  for (std::size_t kind = 0; kind <= in_run; ++kind) starts[kind + 1] += starts[kind];
  const std::size_t moved = starts[flies], flying = starts[stays] - moved;
  solve.moved_in_contact = led + starts[apart];
  if (domains > 1 && led == 0 && moved - solve.moved_in_contact <= moved / 8) {
    std::uint32_t firsts[kMostDomains];
    for (int i = 0; i < domains; ++i) firsts[i] = starts[i * kWaysToTurn];
    set_bounds(std::span(firsts).first(std::size_t(domains)), std::uint32_t(moved), std::uint32_t(width),
               bounds.data());
    solve.moved_bounds = bounds.data();
  }
  for (std::size_t i = 0; i < bodies.size(); ++i) {
    const std::size_t place = starts[kinds[i]]++;
    if (kinds[i] < flies) solve.moved[led + place].body = std::int32_t(bodies[i]);
    if (kinds[i] == flies) solve.flying[place - moved] = bodies[i];
  }
  if (led > 0) {
    runs.add_blocks(count_blocks(int(moved), width));
    solve.run_lines[0] = {&solve, runs.of_others()};
    solve.run_lines[1] = {&solve, runs.of_bundles()};
  }
  solve.moved = solve.moved.first(led + moved);
  solve.flying = solve.flying.first(flying);
}

}  // namespace

void gather_motion(Solve& solve, Arena& arena, TaskSystem& tasks) {
  RigidWorld& w = solve.w;
  part_bodies(solve, arena, tasks);
  const std::size_t moved = solve.moved.size();
  solve.pushes = arena.make<Vec3>(moved);
  solve.spinners = arena.make<std::uint32_t>(moved);
  std::size_t spinners = 0;
  const auto describe = [&](int begin, int end, int) {
    bool any_spins = false;
    for (MovedBody& each : solve.moved.subspan(std::size_t(begin), std::size_t(end - begin))) {
      if (each.body == kNoBody) {
        each = MovedBody{};
        continue;
      }
      const std::uint32_t body = std::uint32_t(each.body);
      each = describe_motion(w.bodies, body, solve.motions, w.bodies.flags[body].touched == kPlaceShown);
      // A field may spin a light body up within the step, beyond what the kernels turn.
      if (!w.field_rest.empty() && w.field_rest[body].acts != kNoFields) each.turns_alone = true;
      any_spins = any_spins || each.turns_alone;
    }
    return any_spins;
  };
  const auto either = [](bool a, bool b) { return a || b; };
  const std::size_t width = std::size_t(solve.kernels.width), blocks = (moved + width - 1) / width;
  if (reduce_blocks(tasks, int(moved), kBodiesPerBlock, false, describe, either)) {
    solve.spinner_starts = arena.make<std::uint32_t>(blocks + 1);
    for (std::size_t i = 0; i < moved; ++i) {
      if (i % width == 0) solve.spinner_starts[i / width] = std::uint32_t(spinners);
      if (solve.moved[i].turns_alone) solve.spinners[spinners++] = std::uint32_t(solve.moved[i].body);
    }
    solve.spinner_starts[blocks] = std::uint32_t(spinners);
  }
  solve.spinners = solve.spinners.first(spinners);
  solve.motion_blocks = arena.make<std::byte>(blocks * solve.kernels.motion.block_bytes).data();
}

namespace {

void mark_rolling_lanes(Solve& solve, std::uint32_t blocks, Arena& arena) {
  const std::uint32_t width = std::uint32_t(solve.kernels.width);
  solve.rolling_lanes = arena.make<std::uint16_t>(blocks);
  solve.rolling_places = arena.make<std::uint32_t>(std::size_t(blocks) * width);
  for (std::uint32_t block = 0; block < blocks; ++block) {
    unsigned lanes = 0;
    for (std::uint32_t lane = 0; lane < width; ++lane) {
      const std::uint32_t constraint = solve.scratch.order[block * width + lane];
      const std::uint32_t place =
          constraint == kNoPlace ? kNotRolling : solve.rolling.of_constraint[constraint];
      solve.rolling_places[block * width + lane] = place;
      if (place != kNotRolling) lanes |= 1u << lane;
    }
    solve.rolling_lanes[block] = std::uint16_t(lanes);
  }
}

// A block takes as long as the lane with the most points, and is swept again where some point would pull, as those do that bear
// nothing; where some lanes roll, the whole block is taken along, in each part or once: so contacts that are alike lie side by
// side. Those of one colour do not notice each other. Those without a body A come last.
constexpr int kWaysToRoll = 3;
constexpr int kWithA = 2 * kWaysToRoll * kMaxManifoldPoints;
int likeness(const Solve& solve, std::uint32_t member) {
  const ContactConstraint& constraint = solve.scratch.constraints[member];
  const int points = kMaxManifoldPoints - constraint.point_count, load = constraint.loaded ? 0 : 1;
  const RollingContacts& rolling = solve.rolling;
  const std::uint32_t place = rolling.contacts.empty() ? kNotRolling : rolling.of_constraint[member];
  const int roll = place == kNotRolling ? 2 : rolling.contacts[place].once ? 1 : 0;
  return (constraint.body_a == kNoBody ? kWithA : 0) + kWaysToRoll * (2 * points + load) + roll;
}

// Appends the members of a colour to the order, in whole blocks, domain by domain; `bounds` of these, if there are several.
void order_alike(const Solve& solve, std::span<const std::uint32_t> members, Array<std::uint32_t>& order,
                 int* bounds) {
  constexpr int kKinds = 2 * kWithA;
  const std::size_t domains = std::size_t(solve.domains.count());
  const auto kind_of = [&](std::uint32_t member) {
    return std::size_t(solve.domains.of(solve.scratch.pairs[member]) * kKinds + likeness(solve, member));
  };
  std::uint32_t starts[kMostDomains * kKinds], firsts[kMostDomains];
  for (std::size_t i = 0; i < domains * kKinds; ++i) starts[i] = 0;
  for (const std::uint32_t member : members) ++starts[kind_of(member)];
  // No block has contacts with and without a body A.
  const std::uint32_t width = std::uint32_t(solve.kernels.width);
  std::uint32_t place = 0;
  bool had_a = true;
  for (std::size_t half = 0; half < 2 * domains; ++half) {
    const bool has_a = half % 2 == 0;
    if (has_a) firsts[half / 2] = place;
    for (std::uint32_t& start : std::span(starts).subspan(half * kWithA, kWithA)) {
      const std::uint32_t count = start;
      if (count > 0 && has_a != had_a) {
        const std::uint32_t whole = (place + width - 1) / width * width;
        if (firsts[half / 2] == place) firsts[half / 2] = whole;
        place = whole;
        had_a = has_a;
      }
      start = place;
      place += count;
    }
  }
  const std::size_t first = order.size();
  order.resize(first + (place + width - 1) / width * width, kNoPlace);
  for (const std::uint32_t member : members) order[first + starts[kind_of(member)]++] = member;
  if (domains > 1 && bounds != nullptr) set_bounds(std::span(firsts).first(domains), place, width, bounds);
}

}  // namespace

std::span<Group> lay_out_contacts(Solve& solve, std::span<Group> groups) {
  BatchScratch& s = solve.scratch;
  const Coloring& colors = s.contact_colors;
  const std::uint32_t width = std::uint32_t(solve.kernels.width);
  s.order.clear();
  std::size_t used = 0;
  std::uint32_t blocks = 0;
  for (int g = 0; g < colors.group_count(); ++g) {
    const std::span<const std::uint32_t> members = colors.group(g);
    if (members.empty()) continue;
    const bool serial = g == colors.overflow_group();
    int* const bounds = serial || solve.group_bounds.empty()
                            ? nullptr
                            : &solve.group_bounds[used * std::size_t(solve.domains.count() + 1)];
    if (serial) {
      s.order.resize(s.order.size() + members.size() * width, kNoPlace);
      for (std::size_t i = 0; i < members.size(); ++i) s.order[(blocks + i) * width] = members[i];
    } else {
      order_alike(solve, members, s.order, bounds);
    }
    const std::uint32_t end = std::uint32_t(s.order.size()) / width;
    groups[used++] = {
        .solve = &solve, .first = blocks, .count = end - blocks, .serial = serial, .bounds = bounds};
    blocks = end;
    s.counts.colors_used |= std::uint64_t{1} << g;
  }
  return groups.first(used);
}

void make_contact_blocks(Solve& solve, std::span<const Group> groups, Arena& arena) {
  const std::uint32_t blocks = groups.empty() ? 0 : groups.back().first + groups.back().count;
  if (!solve.rolling.contacts.empty()) mark_rolling_lanes(solve, blocks, arena);
  solve.blocks = arena.make<std::byte>(std::size_t(blocks) * solve.kernels.block_bytes).data();
  solve.asides = arena.make<std::byte>(std::size_t(blocks) * solve.kernels.aside_bytes).data();
}

namespace {

// Of a group whose joints are solved one after the other.
void begin_ball_alone(Solve& solve, std::uint32_t joint, Arena& arena) {
  if (solve.is_net)
    begin_joint(solve.w, solve.batch, joint, solve.lane_start.warm_scale,
                {solve.joint_work, solve.joint_places}, arena);
}

}  // namespace

std::span<Group> lay_out_joints(Solve& solve, Arena& arena) {
  if (solve.scratch.swept_joints.empty()) return {};
  const Coloring& colors = solve.scratch.joint_colors;
  const std::span<Group> groups = arena.make<Group>(2 * std::size_t(colors.group_count()));
  solve.joint_order = arena.make<std::uint32_t>(colors.order.size());
  const std::uint32_t width = std::uint32_t(solve.kernels.width);
  const auto is_ball = [&](std::uint32_t member) {
    return solve.ball_lanes[solve.scratch.swept_joints[member]] != 0;
  };
  std::size_t used = 0;
  std::uint32_t blocks = 0;
  for (int g = 0; g < colors.group_count(); ++g) {
    const std::span<const std::uint32_t> members = colors.group(g);
    const std::uint32_t first = colors.offsets[g], count = std::uint32_t(members.size());
    const bool serial = g == colors.overflow_group();
    std::uint32_t balls = 0, others = 0;
    for (const std::uint32_t member : members) {
      if (serial && is_ball(member)) begin_ball_alone(solve, solve.scratch.swept_joints[member], arena);
      balls += !serial && is_ball(member) ? 1 : 0;
    }
    std::uint32_t placed = 0;
    for (const std::uint32_t member : members)
      solve.joint_order[first + (!serial && is_ball(member) ? placed++ : balls + others++)] = member;
    if (balls > 0) groups[used++] = {&solve, first, balls, false, std::int32_t(blocks)};
    if (others > 0) groups[used++] = {&solve, first + balls, count - balls, serial};
    blocks += (balls + width - 1) / width;
  }
  solve.balls = arena.make<std::byte>(blocks * solve.kernels.balls.block_bytes).data();
  return groups.first(used);
}

}  // namespace gyre
