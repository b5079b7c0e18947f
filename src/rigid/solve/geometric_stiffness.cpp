#include "rigid/solve/geometric_stiffness.h"

#include "math/rotation.h"

namespace gyre {

namespace {

// The value of h^2 k / I up to which inertia is not raised. Semi-implicit Euler is stable up to 4, but the pull grows within a step.
constexpr float kMaxGeometricStiffness = 0.1f;
// Marks bodies whose rotation other joints hold, too. No sum of stiffnesses reaches zero from here.
constexpr float kNeverStiffened = -1.0e30f;

// Sums the stiffness (N m/rad) with which joints hold or drive the rotation of each body, by index in the batch. A force f at arm r acts on
// the rotation like a spring of stiffness (r . f) 1 - sym(r f^T). For forces along their arms the sum of r . f is the stiffness about every
// axis, or more. Compressed arms have a negative stiffness, whose motion grows as fast as that under tension swings.
std::span<const float> add_up_pulls(const JointSolve& solve, Arena& arena) {
  const BodyStore& bodies = solve.w.bodies;
  const std::span<float> pulls = arena.make<float>(solve.batch.bodies.size());
  for (float& geometric_stiffness : pulls) geometric_stiffness = 0.0f;
  const auto is_moved = [&](std::int32_t body) {
    return body != kNoBody && is_movable(bodies.flags[std::size_t(body)]);
  };
  const auto add = [&](std::int32_t body, Vec3 anchor, Vec3 force) {
    if (!is_moved(body)) return;
    const Vec3 arm = rotate(bodies.orientations[std::size_t(body)], anchor);
    pulls[solve.local_index[std::size_t(body)]] += absolute(dot(arm, force));
  };
  const auto leave_out = [&](std::int32_t body) {
    if (is_moved(body)) pulls[solve.local_index[std::size_t(body)]] = kNeverStiffened;
  };
  for (const std::uint32_t i : solve.lists.swept) {
    const JointRecord& joint = solve.w.joints.records[solve.batch.joints[i]];
    if (joint.kind != JointKind::ball) {
      leave_out(joint.body_a), leave_out(joint.body_b);
      continue;
    }
    // The impulse of the warm start: some batches have scaled it by now, others scale it in their lanes.
    const bool is_scaled = !(solve.all_iterative && solve.ball_lanes[i] != 0);
    const Vec3 impulse =
        is_scaled ? joint.linear_impulse : solve.lane_start.warm_scale * joint.linear_impulse;
    const Vec3 force = (1.0f / solve.settings.substep) * impulse;
    add(joint.body_a, joint.local_anchor_a, -force);
    add(joint.body_b, joint.local_anchor_b, force);
  }
  return pulls;
}

}  // namespace

std::span<const StiffenedBody> find_stiffened_bodies(const JointSolve& solve, Arena& arena) {
  if (solve.lists.swept.empty()) return {};
  const BodyStore& bodies = solve.w.bodies;
  const std::span<const float> pulls = add_up_pulls(solve, arena);
  // h^2 k / I about the axis with the least inertia.
  const auto unresolved = [&](std::uint32_t place) {
    const Sym3& inverse = bodies.inertia[solve.batch.bodies[place]].inverse;
    return square(solve.settings.substep) * pulls[place] * max(inverse.xx, max(inverse.yy, inverse.zz));
  };
  const auto is_stiffened = [&](std::uint32_t place) {
    return unresolved(place) > kMaxGeometricStiffness &&
           bodies.flags[solve.batch.bodies[place]].locked_angular == 0;
  };
  std::size_t count = 0;
  for (std::uint32_t place = 0; place < pulls.size(); ++place) count += is_stiffened(place) ? 1 : 0;
  const std::span<StiffenedBody> stiffened = arena.make<StiffenedBody>(count);
  count = 0;
  for (std::uint32_t place = 0; place < pulls.size(); ++place) {
    if (!is_stiffened(place)) continue;
    const float raise =
        square(solve.settings.substep) * pulls[place] * (1.0f - kMaxGeometricStiffness / unresolved(place));
    stiffened[count++] = {solve.batch.bodies[place], raise};
  }
  return stiffened;
}

void disable_gyroscopic_torque(const JointSolve& solve, std::span<MovedBody> moved, Arena& arena) {
  if (solve.stiffened.empty()) return;
  const ArenaScope scope(arena);
  const std::span<std::uint8_t> is_stiffened = arena.make<std::uint8_t>(solve.batch.bodies.size());
  for (std::uint8_t& one : is_stiffened) one = 0;
  for (const StiffenedBody& body : solve.stiffened) is_stiffened[solve.local_index[body.body]] = 1;
  for (MovedBody& one : moved) {
    if (one.body != kNoBody && is_stiffened[solve.local_index[std::size_t(one.body)]] != 0)
      one.isotropic = true;
  }
}

void stiffen_bodies(const JointSolve& solve, int, int) {
  BodyStore& bodies = solve.w.bodies;
  for (const StiffenedBody& each : solve.stiffened) {
    const BodyMass& mass = bodies.masses[each.body];
    Sym3 inertia =
        mass.isotropic != 0 ? mass.inertia : rotate_inertia(bodies.orientations[each.body], mass.inertia);
    inertia.xx += each.added_inertia, inertia.yy += each.added_inertia, inertia.zz += each.added_inertia;
    bodies.inertia[each.body].inverse = inverse(inertia);
  }
}

void restore_inertia(const JointSolve& solve) {
  BodyStore& bodies = solve.w.bodies;
  for (const StiffenedBody& stiffened : solve.stiffened) {
    const std::uint32_t body = stiffened.body;
    bodies.inertia[body] = world_inertia(bodies.masses[body], bodies.flags[body], bodies.orientations[body]);
  }
}

}  // namespace gyre
