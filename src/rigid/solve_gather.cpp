#include "rigid/solve_gather.h"

#include "base/prefetch.h"
#include "rigid/hits.h"
#include "rigid/surface_rules.h"
#include "solver/ball_records.h"

namespace gyre {

namespace {

// The fastest that overlap is taken back, as a share of sqrt(gravity * size): falling its own size is a body's natural
// scale of speed, so the rule holds from millimetres to kilometres.
constexpr float kPushShare = 0.4f;
// Manifolds lie anywhere in memory: how many contacts before its turn one is asked for.
constexpr std::size_t kAhead = 6;

// A body as constraints know it: kNoBody if it never moves (its record is then never read).
std::int32_t solver_body(const RigidWorld& w, std::uint32_t body) {
  const BodyFlags& flags = w.bodies.flags[body];
  return flags.type == BodyType::fixed || flags.frozen != 0 ? kNoBody : std::int32_t(body);
}

void touch_body(RigidWorld& w, std::uint32_t body, std::uint8_t touch) {
  std::uint8_t& touched = w.bodies.flags[body].touched;
  touched = max(touched, touch);
}

void fetch_manifold(const ContactStore& store, std::uint32_t slot) {
  prefetch(&store.manifolds[store.contacts[slot].first_manifold], sizeof(Manifold));
}

}  // namespace

void gather_contacts(Solve& solve) {
  RigidWorld& w = solve.w;
  SolveScratch& s = solve.scratch;
  s.constraints.clear();
  s.constraint_contact.clear();
  s.impacts.clear();
  s.pairs.clear();
  const float fall = std::sqrt(length(w.settings.gravity));
  const bool has_rules = !w.surface_rules.empty(), some_wait = !w.waiting.empty();
  for (std::size_t i = 0; i < solve.batch.contacts.size(); ++i) {
    if (i + kAhead < solve.batch.contacts.size()) fetch_manifold(w.contacts, solve.batch.contacts[i + kAhead]);
    const std::uint32_t slot = solve.batch.contacts[i];
    if (some_wait && w.waiting[slot] != 0) continue;
    const Contact& contact = w.contacts.contacts[slot];
    const bool active_a = is_active(w, contact.body_a), active_b = is_active(w, contact.body_b);
    const std::uint8_t touch = contact.surface.restitution > 0.0f ? kPlaceShown : kTouched;
    touch_body(w, contact.body_a, touch);
    touch_body(w, contact.body_b, touch);
    ContactConstraint constraint;
    constraint.body_a = solver_body(w, contact.body_a);
    constraint.body_b = solver_body(w, contact.body_b);
    constraint.static_friction = contact.surface.static_friction;
    constraint.dynamic_friction = contact.surface.dynamic_friction;
    constraint.rolling_friction = contact.surface.rolling_friction;
    constraint.spinning_friction = contact.surface.spinning_friction;
    constraint.restitution = contact.surface.restitution;
    constraint.size = contact.size;
    constraint.linked = (active_a && !w.bodies.joints[contact.body_a].empty()) ||
                        (active_b && !w.bodies.joints[contact.body_b].empty());
    constraint.push_speed = kPushShare * (fall > 0.0f ? fall : 3.132f) * std::sqrt(contact.size);
    for (Manifold& manifold : manifolds_of(w.contacts, contact)) {
      if (manifold.count == 0) continue;
      constraint.fast = note_approach(w, contact, manifold);
      constraint.manifold = &manifold;
      constraint.point_count = manifold.count;
      s.constraints.push_back(constraint);
      if (has_rules && !apply_surface_rules(w, contact, manifold, s.constraints.back())) {
        s.constraints.pop_back();
        continue;
      }
      s.constraints.back().spinning_friction += patch_friction(w, contact, s.constraints.back());
      s.constraint_contact.push_back(slot);
      s.pairs.push_back({active_a ? solve.places[contact.body_a] : ColoringPair::kNone,
                         active_b ? solve.places[contact.body_b] : ColoringPair::kNone});
      if (s.constraints.back().restitution > 0.0f) s.impacts.push_back(make_impact(s.constraints.back()));
    }
  }
}

void gather_joints(Solve& solve) {
  RigidWorld& w = solve.w;
  SolveScratch& s = solve.scratch;
  s.swept_joints.clear();
  s.joint_pairs.clear();
  for (std::uint32_t i = 0; i < solve.batch.joints.size(); ++i) {
    const std::uint32_t slot = solve.batch.joints[i];
    const JointRecord& joint = w.joints.records[slot];
    const bool active_a = joint.body_a != kNoBody && is_active(w, std::uint32_t(joint.body_a));
    const bool active_b = joint.body_b != kNoBody && is_active(w, std::uint32_t(joint.body_b));
    if (solve.is_smooth && is_explicit_spring(w, slot)) continue;
    if (joint.body_a != kNoBody) touch_body(w, std::uint32_t(joint.body_a), kPlaceShown);
    if (joint.body_b != kNoBody) touch_body(w, std::uint32_t(joint.body_b), kPlaceShown);
    if (solve.linkages.swept[i] == 0) continue;
    s.swept_joints.push_back(i);
    s.joint_pairs.push_back({active_a ? solve.places[std::size_t(joint.body_a)] : ColoringPair::kNone,
                             active_b ? solve.places[std::size_t(joint.body_b)] : ColoringPair::kNone});
  }
}

void gather_motion(Solve& solve, Arena& arena) {
  RigidWorld& w = solve.w;
  const std::size_t count = solve.batch.bodies.size();
  solve.moved = arena.make<MovedBody>(count);
  solve.pushes = arena.make<Vec3>(count);
  solve.flying = arena.make<std::uint32_t>(count);
  solve.spinners = arena.make<std::uint32_t>(count);
  std::size_t moved = 0, flying = 0, spinners = 0;
  for (const std::uint32_t body : solve.batch.bodies) {
    const std::uint8_t touched = w.bodies.flags[body].touched;
    if (touched == kUntouched) {
      if (solve.is_smooth && is_movable(w.bodies.flags[body])) continue;
      solve.flying[flying++] = body;
      continue;
    }
    solve.moved[moved] = describe_motion(w.bodies, body, solve.motions, touched == kPlaceShown);
    // A field may spin a light body up within the step, beyond what the kernels turn.
    if (!w.field_rest.empty() && w.field_rest[body].acts != kNoFields) solve.moved[moved].turns_alone = true;
    if (solve.moved[moved].turns_alone) solve.spinners[spinners++] = body;
    ++moved;
  }
  solve.moved = solve.moved.first(moved);
  solve.pushes = solve.pushes.first(moved);
  solve.flying = solve.flying.first(flying);
  solve.spinners = solve.spinners.first(spinners);
  const std::size_t width = std::size_t(solve.kernels.width);
  solve.motion_blocks = arena.make<std::byte>((moved + width - 1) / width * solve.kernels.motion.block_bytes).data();
}

std::span<Group> lay_out_contacts(Solve& solve, Arena& arena) {
  SolveScratch& s = solve.scratch;
  const Coloring& colors = s.contact_colors;
  const std::uint32_t width = std::uint32_t(solve.kernels.width);
  const std::span<Group> groups = arena.make<Group>(std::size_t(colors.group_count()));
  s.order.clear();
  std::size_t used = 0;
  std::uint32_t block = 0;
  for (int g = 0; g < colors.group_count(); ++g) {
    const std::span<const std::uint32_t> members = colors.group(g);
    if (members.empty()) continue;
    const std::uint32_t lanes = g == colors.overflow_group() ? 1 : width;
    const std::uint32_t first = block;
    for (std::size_t i = 0; i < members.size(); i += lanes, ++block) {
      for (std::uint32_t lane = 0; lane < width; ++lane) {
        s.order.push_back(lane < lanes && i + lane < members.size() ? members[i + lane] : 0xffffffffu);
      }
    }
    groups[used++] = {&solve, first, block - first, g == colors.overflow_group()};
    s.colors_used |= std::uint64_t{1} << g;
  }
  solve.blocks = arena.make<std::byte>(std::size_t(block) * solve.kernels.block_bytes).data();
  return groups.first(used);
}

std::span<Group> lay_out_joints(Solve& solve, Arena& arena) {
  if (solve.scratch.swept_joints.empty()) return {};
  const Coloring& colors = solve.scratch.joint_colors;
  const std::span<Group> groups = arena.make<Group>(2 * std::size_t(colors.group_count()));
  solve.joint_order = arena.make<std::uint32_t>(colors.order.size());
  const std::uint32_t width = std::uint32_t(solve.kernels.width);
  const auto is_ball = [&](std::uint32_t member) {
    const std::uint32_t joint = solve.scratch.swept_joints[member];
    return fits_ball_lane(solve.w.joints.records[solve.batch.joints[joint]], solve.joint_work[joint]);
  };
  std::size_t used = 0;
  std::uint32_t blocks = 0;
  for (int g = 0; g < colors.group_count(); ++g) {
    const std::span<const std::uint32_t> members = colors.group(g);
    const std::uint32_t first = colors.offsets[g], count = std::uint32_t(members.size());
    const bool serial = g == colors.overflow_group();
    std::uint32_t balls = 0, others = 0;
    for (const std::uint32_t member : members) balls += !serial && is_ball(member) ? 1 : 0;
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
