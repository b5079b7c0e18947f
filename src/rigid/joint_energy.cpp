#include "rigid/joint_energy.h"

#include "base/disjoint_sets.h"
#include "math/rotation.h"
#include "solver/error_bounds.h"
#include "solver/joint_axis.h"
#include "solver/joint_drive.h"

#include <cmath>

namespace gyre {

namespace {

// Of those whose rows see nothing of the motion of all together as one rigid body.
bool is_inner(JointKind kind) {
  switch (kind) {
    case JointKind::ball:
    case JointKind::hinge:
    case JointKind::slider:
    case JointKind::fixed:
    case JointKind::distance:
    case JointKind::cone:
    case JointKind::universal:
    case JointKind::six_dof:
      return true;
    default:
      return false;
  }
}

bool is_workless(const JointRecord& joint, const JointDetail* detail) {
  if (!is_inner(joint.kind) || joint.is_spring || joint.motor_force > 0.0f || joint.stiffness > 0.0f ||
      joint.damping > 0.0f)
    return false;
  if (detail == nullptr) return true;
  if (has_drive(*detail)) return false;
  for (const JointAxisRecord& axis : detail->axes)
    if (axis.motor_force > 0.0f || has_spring(axis) || axis.limit_frequency > 0.0f) return false;
  return true;
}

bool turns_far(const BodyMotion& motion, float h) {
  return square(h) * length_squared(motion.angular_velocity) > square(kStraightTurn);
}

// Calls fn(slot) for the joints that are looked at.
template <class Fn>
void for_each_slot(const Solve& solve, Fn&& fn) {
  for (const std::uint32_t i : solve.scratch.swept_joints) fn(solve.batch.joints[i]);
  for (const Linkage& linkage : solve.linkages.linkages)
    for (const LinkageNode& node : linkage.nodes) fn(node.record);
}

// What is known of an island while it is gathered, at its lowest place.
struct Draft {
  bool has_joints = false, is_alone = false, is_fast = false, is_held = false, is_worked = false;
  std::uint32_t bodies = 0, joints = 0, next_body = 0, next_joint = 0;
};

class IslandFinder {
 public:
  IslandFinder(const Solve& solve, Arena& arena)
      : solve_(solve),
        w_(solve.w),
        arena_(arena),
        sets_(arena.make<std::uint32_t>(solve.batch.bodies.size())),
        drafts_(arena.make<Draft>(solve.batch.bodies.size())) {}

  std::span<JointIsland> find() {
    for (Draft& draft : drafts_) draft = Draft{};
    unite();
    find_alone();
    find_lanes();
    describe();
    return list();
  }

 private:
  bool is_pushed(std::int32_t body) const { return body != kNoBody && is_active(w_, std::uint32_t(body)); }
  std::uint32_t place(std::int32_t body) const { return solve_.places[std::size_t(body)]; }

  void unite() {
    for_each_slot(solve_, [&](std::uint32_t slot) {
      const JointRecord& joint = w_.joints.records[slot];
      const bool a = is_pushed(joint.body_a), b = is_pushed(joint.body_b);
      if (a) drafts_[place(joint.body_a)].has_joints = true;
      if (b) drafts_[place(joint.body_b)].has_joints = true;
      if (a && b) sets_.unite(place(joint.body_a), place(joint.body_b));
    });
  }
  // What it costs to watch them is little of what it costs to solve them.
  void find_alone() {
    for (const Linkage& linkage : solve_.linkages.linkages)
      drafts_[sets_.of(place(linkage.bodies[0].body))].is_alone = true;
  }
  // What is in lanes, too, is slowed there, with all that hangs on it.
  void find_lanes() {
    const auto mark = [&](std::int32_t body) {
      if (is_pushed(body)) drafts_[sets_.of(place(body))].is_worked = true;
    };
    for (const LaneLinkage& linkage : solve_.linkages.alike)
      for (const LinkedJoint& joint : linkage.joints) mark(joint.body_a), mark(joint.body_b);
  }
  void describe() {
    for_each_slot(solve_, [&](std::uint32_t slot) {
      const JointRecord& joint = w_.joints.records[slot];
      const bool a = is_pushed(joint.body_a), b = is_pushed(joint.body_b);
      if (!a && !b) return;
      Draft& draft = drafts_[sets_.of(place(a ? joint.body_a : joint.body_b))];
      ++draft.joints;
      if (!a || !b) hold(draft, a ? joint.body_b : joint.body_a);
      if (!is_workless(joint, detail_of(w_.joints, slot))) draft.is_worked = true;
    });
    for (std::uint32_t i = 0; i < drafts_.size(); ++i) {
      if (!drafts_[i].has_joints) continue;
      Draft& draft = drafts_[sets_.of(i)];
      const std::uint32_t body = solve_.batch.bodies[i];
      const BodyFlags& flags = w_.bodies.flags[body];
      ++draft.bodies;
      if (turns_far(w_.bodies.motion[body], solve_.h)) draft.is_fast = true;
      if (flags.locked_linear != 0 || flags.locked_angular != 0) draft.is_worked = true;
    }
  }
  // What moves by itself does work.
  void hold(Draft& draft, std::int32_t body) const {
    draft.is_held = true;
    if (body == kNoBody) return;
    const BodyMotion& motion = w_.bodies.motion[std::size_t(body)];
    if (motion.linear_velocity != Vec3{} || motion.angular_velocity != Vec3{}) draft.is_worked = true;
  }

  std::span<JointIsland> list() {
    const auto is_watched = [](const Draft& draft) {
      return draft.bodies > 0 && (draft.is_fast || draft.is_alone) && !draft.is_worked;
    };
    std::size_t count = 0, bodies = 0, joints = 0;
    for (const Draft& draft : drafts_)
      if (is_watched(draft)) ++count, bodies += draft.bodies, joints += draft.joints;
    if (count == 0) return {};
    const std::span<JointIsland> islands = arena_.make<JointIsland>(count);
    const std::span<std::uint32_t> members = arena_.make<std::uint32_t>(bodies),
                                   ties = arena_.make<std::uint32_t>(joints);
    count = bodies = joints = 0;
    for (Draft& draft : drafts_) {
      if (!is_watched(draft)) continue;
      islands[count++] = {members.subspan(bodies, draft.bodies), ties.subspan(joints, draft.joints),
                          draft.is_held, draft.is_fast};
      draft.next_body = std::uint32_t(bodies), draft.next_joint = std::uint32_t(joints);
      bodies += draft.bodies, joints += draft.joints;
    }
    for (std::uint32_t i = 0; i < drafts_.size(); ++i) {
      Draft& draft = drafts_[sets_.of(i)];
      if (drafts_[i].has_joints && is_watched(draft)) members[draft.next_body++] = solve_.batch.bodies[i];
    }
    for_each_slot(solve_, [&](std::uint32_t slot) {
      const JointRecord& joint = w_.joints.records[slot];
      const bool a = is_pushed(joint.body_a);
      if (!a && !is_pushed(joint.body_b)) return;
      Draft& draft = drafts_[sets_.of(place(a ? joint.body_a : joint.body_b))];
      if (is_watched(draft)) ties[draft.next_joint++] = slot;
    });
    return islands;
  }

  const Solve& solve_;
  const RigidWorld& w_;
  Arena& arena_;
  DisjointSets sets_;  // of places in the batch
  std::span<Draft> drafts_;
};

// World axes.
Sym3 inertia_of(const BodyStore& bodies, std::uint32_t body) {
  const BodyMass& mass = bodies.masses[body];
  return mass.isotropic != 0 ? mass.inertia : rotate_inertia(bodies.orientations[body], mass.inertia);
}

// J
double kinetic_energy(const BodyStore& bodies, const JointIsland& island) {
  double twice = 0.0;
  for (const std::uint32_t body : island.bodies) {
    const BodyMotion& motion = bodies.motion[body];
    const Vec3 spin = motion.angular_velocity;
    twice += double(bodies.masses[body].mass) * double(length_squared(motion.linear_velocity));
    twice += double(dot(spin, inertia_of(bodies, body) * spin));
  }
  return 0.5 * twice;
}

// The motion that an island would have as one rigid body, with the momenta that it has; of what hangs on something, none.
struct RigidMotion {
  DVec3 center;
  Vec3 linear, angular;
  double energy = 0.0;
};

DVec3 center_of(const BodyStore& bodies, std::uint32_t body) {
  return bodies.places[body].center + DVec3(bodies.motion[body].moved);
}

RigidMotion rigid_motion(const BodyStore& bodies, const JointIsland& island) {
  RigidMotion rigid;
  if (island.is_held) return rigid;
  const DVec3 origin = center_of(bodies, island.bodies[0]);
  double mass = 0.0;
  DVec3 moment, momentum;
  for (const std::uint32_t body : island.bodies) {
    const double m = double(bodies.masses[body].mass);
    mass += m;
    moment += m * (center_of(bodies, body) - origin);
    momentum += m * DVec3(bodies.motion[body].linear_velocity);
  }
  rigid.center = origin + (1.0 / mass) * moment;
  rigid.linear = to_float((1.0 / mass) * momentum);
  Vec3 spin;
  Sym3 inertia;
  for (const std::uint32_t body : island.bodies) {
    const float m = bodies.masses[body].mass;
    const Vec3 r = to_float(center_of(bodies, body) - rigid.center);
    const Sym3 own = inertia_of(bodies, body);
    const BodyMotion& motion = bodies.motion[body];
    spin += m * cross(r, motion.linear_velocity - rigid.linear) + own * motion.angular_velocity;
    const float square_r = length_squared(r);
    inertia = inertia + own + m * Sym3{square_r - r.x * r.x, square_r - r.y * r.y, square_r - r.z * r.z,
                                       -r.x * r.y,           -r.x * r.z,           -r.y * r.z};
  }
  rigid.angular = inverse(inertia) * spin;
  rigid.energy = 0.5 * (mass * double(length_squared(rigid.linear)) + double(dot(rigid.angular, spin)));
  return rigid;
}

// Takes so much (J) of inner motion away.
void slow_down(BodyStore& bodies, const JointIsland& island, double energy, double taken) {
  const RigidMotion rigid = rigid_motion(bodies, island);
  const double inner = energy - rigid.energy;
  const float share = inner > taken ? float(std::sqrt((inner - taken) / inner)) : 0.0f;
  for (const std::uint32_t body : island.bodies) {
    BodyMotion& motion = bodies.motion[body];
    Vec3 linear = rigid.linear;
    if (!island.is_held) linear += cross(rigid.angular, to_float(center_of(bodies, body) - rigid.center));
    motion.linear_velocity = linear + share * (motion.linear_velocity - linear) + Vec3{};
    motion.angular_velocity = rigid.angular + share * (motion.angular_velocity - rigid.angular) + Vec3{};
  }
}

// J: with which all bodies go back to where joints would have them, if they are far off.
double energy_of_errors(const BodyStore& bodies, const JointIsland& island, float rate) {
  double sum = 0.0;
  for (const std::uint32_t body : island.bodies) {
    const Sym3& inertia = bodies.masses[body].inertia;
    sum += double(bodies.masses[body].mass) * square(double(kMostErrors.point));
    sum += double(max(inertia.xx, max(inertia.yy, inertia.zz))) * square(double(kMostErrors.turn));
  }
  return 0.5 * square(double(rate)) * sum;
}

// Where joints have given more than `most` of what there was, or of `least`: leaves them what `left` says of that, and takes the rest
// away.
void bound_gain(BodyStore& bodies, JointIsland& island, float most, float left, double least = 0.0) {
  if (!(island.gained > 0.0)) return;
  const double energy = kinetic_energy(bodies, island), before = max(energy - island.gained, least);
  if (!(island.gained > double(most) * before)) return;
  const double kept = double(left) * before;
  slow_down(bodies, island, energy, island.gained - kept);
  island.gained = kept;
  if (left > 0.0f) island.is_bounded = true;
}

}  // namespace

std::span<JointIsland> find_joint_islands(const Solve& solve, Arena& arena) {
  if (solve.scratch.swept_joints.empty() && solve.linkages.linkages.empty()) return {};
  const BodyStore& bodies = solve.w.bodies;
  const auto is_fast = [&](std::uint32_t body) {
    return is_active(solve.w, body) && turns_far(bodies.motion[body], solve.h);
  };
  bool is_any = !solve.linkages.linkages.empty();
  for (const std::uint32_t body : solve.batch.bodies) {
    if (is_any) break;
    is_any = is_fast(body);
  }
  if (!is_any) return {};
  return IslandFinder(solve, arena).find();
}

void begin_joint_work(const Solve& solve, int begin, int end) {
  for (JointIsland& island : solve.joint_islands.subspan(std::size_t(begin), std::size_t(end - begin)))
    island.before = kinetic_energy(solve.w.bodies, island);
}
void end_joint_work(const Solve& solve, int begin, int end) {
  for (JointIsland& island : solve.joint_islands.subspan(std::size_t(begin), std::size_t(end - begin)))
    island.gained += kinetic_energy(solve.w.bodies, island) - island.before;
}
void bound_gains(const Solve& solve, int begin, int end) {
  for (JointIsland& island : solve.joint_islands.subspan(std::size_t(begin), std::size_t(end - begin)))
    bound_gain(solve.w.bodies, island, kMostGainAhead, kMostGainAhead,
               energy_of_errors(solve.w.bodies, island, solve.joint_settings.softness.bias_rate));
}
void take_gains_away(const Solve& solve, int begin, int end) {
  for (JointIsland& island : solve.joint_islands.subspan(std::size_t(begin), std::size_t(end - begin))) {
    if (island.is_fast || island.is_bounded) bound_gain(solve.w.bodies, island, kMostGain, 0.0f);
    island.gained = 0.0;
  }
}
void forget_bounded(const Solve& solve) {
  JointStore& joints = solve.w.joints;
  for (const JointIsland& island : solve.joint_islands) {
    if (!island.is_bounded) continue;
    for (const std::uint32_t slot : island.joints) {
      JointRecord& joint = joints.records[slot];
      joint.linear_impulse = joint.angular_impulse = {};
      joint.low_impulse = joint.high_impulse = 0.0f;
      if (JointDetail* const detail = detail_of(joints, slot))
        for (float& impulse : detail->row_impulses) impulse = 0.0f;
    }
  }
}

}  // namespace gyre
