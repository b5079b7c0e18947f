#include "rigid/solve/energy_limiter.h"

#include "base/container/disjoint_sets.h"
#include "math/rotation.h"
#include "rigid/solve/actuated_rows.h"
#include "solver/core/error_bounds.h"

#include <cmath>

namespace gyre {

namespace {

// The motions that the rows of a joint kind cannot see.
IslandFrame frame_of(JointKind kind) {
  switch (kind) {
    case JointKind::gear:
    case JointKind::rack_and_pinion:
      return IslandFrame::parallel;
    case JointKind::pulley:
      return IslandFrame::held;
    default:
      return IslandFrame::rigid;
  }
}

bool turns_far(const BodyMotion& motion, float h) {
  return square(h) * length_squared(motion.angular_velocity) > square(kSlowRotation);
}

// Calls fn(index in the batch's list) for the iterative joints, and then for those of scalar and of grouped articulations.
template <class Fn>
void for_each_swept(const JointSolve& solve, Fn&& fn) {
  for (const std::uint32_t place : solve.lists.swept) fn(place);
}
template <class Fn>
void for_each_joint(const JointSolve& solve, Fn&& fn) {
  for_each_swept(solve, fn);
  for (const Articulation& articulation : solve.articulations.scalar)
    for (const ArticulationNode& node : articulation.nodes) fn(node.work);
  for (const GroupedArticulation& articulation : solve.articulations.grouped)
    for (const ArticulationJoint& joint : articulation.joints) fn(joint.index);
}

// The data of an island under construction, stored at its lowest body index.
struct Draft {
  bool has_joints = false, is_swept = false, is_alone = false, is_fast = false;
  bool is_untold = false;  // its work is unknown: several moving carriers, locked axes, drives in lanes
  bool is_in_equilibrium = false, is_pushed = false;
  std::int32_t carrier = kNoBody;  // first body that carries it
  IslandFrame frame = IslandFrame::rigid;
  std::uint32_t bodies = 0, joints = 0, worked = 0;
  JointIsland* island = nullptr;
};

class IslandFinder {
 public:
  IslandFinder(const JointSolve& solve, std::span<const ColoringPair> contacts,
               std::span<const FieldBody> fields, Arena& arena)
      : solve_(solve),
        contacts_(contacts),
        fields_(fields),
        w_(solve.w),
        arena_(arena),
        in_lanes_(prepared_in_simd(solve)),
        sets_(arena.make<std::uint32_t>(solve.batch.bodies.size())),
        drafts_(arena.make<Draft>(solve.batch.bodies.size())) {}

  std::span<JointIsland> find() {
    for (Draft& draft : drafts_) draft = Draft{};
    unite();
    find_kinds();
    describe();
    return list();
  }

 private:
  bool is_in_lanes(std::uint32_t at) const { return !in_lanes_.empty() && in_lanes_[at] != 0; }
  bool is_pushed(std::int32_t body) const { return body != kNoBody && is_active(w_, std::uint32_t(body)); }
  std::uint32_t place(std::int32_t body) const { return solve_.local_index[std::size_t(body)]; }

  void unite() {
    for_each_joint(solve_, [&](std::uint32_t at) {
      const JointRecord& joint = w_.joints.records[solve_.batch.joints[at]];
      const bool a = is_pushed(joint.body_a), b = is_pushed(joint.body_b);
      if (a) drafts_[place(joint.body_a)].has_joints = true;
      if (b) drafts_[place(joint.body_b)].has_joints = true;
      if (a && b) sets_.unite(place(joint.body_a), place(joint.body_b));
    });
  }
  void find_kinds() {
    for (const Articulation& articulation : solve_.articulations.scalar)
      drafts_[sets_.of(place(articulation.bodies[0].body))].is_alone = true;
    for_each_swept(solve_, [&](std::uint32_t at) {
      const JointRecord& joint = w_.joints.records[solve_.batch.joints[at]];
      for (const std::int32_t body : {joint.body_a, joint.body_b})
        if (is_pushed(body)) drafts_[sets_.of(place(body))].is_swept = true;
    });
  }
  void describe() {
    for_each_joint(solve_, [&](std::uint32_t at) {
      const JointRecord& joint = w_.joints.records[solve_.batch.joints[at]];
      const bool a = is_pushed(joint.body_a), b = is_pushed(joint.body_b);
      if (!a && !b) return;
      Draft& draft = drafts_[sets_.of(place(a ? joint.body_a : joint.body_b))];
      ++draft.joints;
      draft.frame = max(draft.frame, frame_of(joint.kind));
      if (!a || !b) hold(draft, a ? joint.body_b : joint.body_a);
      if (!is_in_lanes(at))
        draft.worked += std::uint32_t(count_actuated_rows(solve_, at));
      else if (can_do_work(joint, detail_of(w_.joints, solve_.batch.joints[at])))
        draft.is_untold = true;
    });
    for (const ColoringPair& contact : contacts_)
      for (const std::uint32_t at : {contact.a, contact.b})
        if (at != ColoringPair::kNone) drafts_[sets_.of(at)].is_pushed = true;
    for (const FieldBody& field : fields_)
      drafts_[sets_.of(place(std::int32_t(field.body)))].is_pushed = true;
    for (std::uint32_t i = 0; i < drafts_.size(); ++i) {
      if (!drafts_[i].has_joints) continue;
      Draft& draft = drafts_[sets_.of(i)];
      const std::uint32_t body = solve_.batch.bodies[i];
      const BodyFlags& flags = w_.bodies.flags[body];
      ++draft.bodies;
      if (turns_far(w_.bodies.motion[body], solve_.settings.substep)) draft.is_fast = true;
      if (flags.locked_linear != 0 || flags.locked_angular != 0) draft.is_untold = true;
    }
  }
  // In its own frame a carrier does no work. This holds for one carrier, and for rows that depend only on motion relative to it.
  void hold(Draft& draft, std::int32_t body) const {
    if (draft.is_in_equilibrium && body != draft.carrier && (moves(body) || moves(draft.carrier)))
      draft.is_untold = true;
    if (!draft.is_in_equilibrium) draft.carrier = body;
    draft.is_in_equilibrium = true;
  }
  bool moves(std::int32_t body) const {
    if (body == kNoBody) return false;
    const BodyMotion& motion = w_.bodies.motion[std::size_t(body)];
    return motion.linear_velocity != Vec3{} || motion.angular_velocity != Vec3{};
  }
  void end_hold(Draft& draft) const {
    if (!draft.is_in_equilibrium) return;
    if (!moves(draft.carrier))
      draft.carrier = kNoBody;
    else if (draft.frame != IslandFrame::rigid)
      draft.is_untold = true;
    draft.frame = IslandFrame::held;
  }

  std::span<JointIsland> list() {
    for (Draft& draft : drafts_) end_hold(draft);
    // Scalar articulations are always watched, because that costs little of their solve. Kernels watch islands of grouped articulations
    // only.
    const auto is_watched = [](const Draft& draft) {
      return draft.bodies > 0 && (draft.is_alone || (draft.is_swept && draft.is_fast)) && !draft.is_untold;
    };
    std::size_t count = 0;
    for (const Draft& draft : drafts_)
      if (is_watched(draft)) ++count;
    if (count == 0) return {};
    const std::span<JointIsland> islands = arena_.make<JointIsland>(count);
    count = 0;
    for (Draft& draft : drafts_)
      if (is_watched(draft)) begin_island(draft, islands[count++]);
    fill();
    return islands;
  }
  // Makes an island with memory for its bodies, joints and rows.
  void begin_island(Draft& draft, JointIsland& island) {
    island = {arena_.make<std::uint32_t>(draft.bodies),
              arena_.make<std::uint32_t>(draft.joints),
              arena_.make<ActuatedRow>(draft.worked),
              draft.frame,
              draft.carrier,
              draft.is_pushed};
    draft.island = &island;
    draft.bodies = draft.joints = draft.worked = 0;
  }
  void fill() {
    for (std::uint32_t i = 0; i < drafts_.size(); ++i) {
      Draft& draft = drafts_[sets_.of(i)];
      if (drafts_[i].has_joints && draft.island != nullptr)
        draft.island->bodies[draft.bodies++] = solve_.batch.bodies[i];
    }
    for_each_joint(solve_, [&](std::uint32_t at) {
      const JointRecord& joint = w_.joints.records[solve_.batch.joints[at]];
      const bool a = is_pushed(joint.body_a);
      if (!a && !is_pushed(joint.body_b)) return;
      Draft& draft = drafts_[sets_.of(place(a ? joint.body_a : joint.body_b))];
      if (draft.island == nullptr) return;
      draft.island->joints[draft.joints++] = at;
      if (is_in_lanes(at)) return;
      list_actuated_rows(solve_, at, draft.island->worked.subspan(draft.worked));
      draft.worked += std::uint32_t(count_actuated_rows(solve_, at));
    });
  }

  const JointSolve& solve_;
  std::span<const ColoringPair> contacts_;
  std::span<const FieldBody> fields_;
  const RigidWorld& w_;
  Arena& arena_;
  std::span<const std::uint8_t> in_lanes_;
  DisjointSets sets_;  // sets of body indices in the batch
  std::span<Draft> drafts_;
};

// Share of an angular momentum below which a change is rounding.
constexpr double kSpinRounding = 1.0e-4;

// The inertia of a body in world axes.
Sym3 inertia_of(const BodyStore& bodies, std::uint32_t body) {
  const BodyMass& mass = bodies.masses[body];
  return mass.isotropic != 0 ? mass.inertia : rotate_inertia(bodies.orientations[body], mass.inertia);
}

// The inertia times an angular velocity, in world axes. This is cheaper than the matrix.
Vec3 spin_of(const BodyStore& bodies, std::uint32_t body, Vec3 turning) {
  const BodyMass& mass = bodies.masses[body];
  if (mass.isotropic != 0) return mass.inertia * turning;
  const Quat q = bodies.orientations[body];
  return rotate(q, mass.inertia * rotate_inverse(q, turning));
}

DVec3 center_of(const BodyStore& bodies, std::uint32_t body) {
  return bodies.poses[body].center + DVec3(bodies.motion[body].delta_position);
}

// The motion of the carrier of an island, as a rigid motion of all its bodies; zero if it does not move.
struct CarrierMotion {
  DVec3 center;
  Vec3 linear, angular;
  Vec3 at(DVec3 point) const { return linear + cross(angular, to_float(point - center)); }
};
CarrierMotion carriage_of(const BodyStore& bodies, const JointIsland& island) {
  if (island.carrier == kNoBody) return {};
  const BodyMotion& motion = bodies.motion[std::size_t(island.carrier)];
  return {center_of(bodies, std::uint32_t(island.carrier)), motion.linear_velocity, motion.angular_velocity};
}

// The kinetic energy (J) in the carrier frame.
double kinetic_energy(const BodyStore& bodies, const JointIsland& island) {
  const CarrierMotion carriage = carriage_of(bodies, island);
  double twice = 0.0;
  for (const std::uint32_t body : island.bodies) {
    const BodyMotion& motion = bodies.motion[body];
    Vec3 speed = motion.linear_velocity, spin = motion.angular_velocity;
    if (island.carrier != kNoBody) {
      speed -= carriage.at(center_of(bodies, body));
      spin -= carriage.angular;
    }
    twice += double(bodies.masses[body].mass) * double(length_squared(speed));
    twice += double(dot(spin, spin_of(bodies, body, spin)));
  }
  return 0.5 * twice;
}

// The angular momentum (kg m^2/s) about a point.
DVec3 angular_momentum(const BodyStore& bodies, const JointIsland& island, DVec3 point) {
  DVec3 sum;
  for (const std::uint32_t body : island.bodies) {
    const BodyMotion& motion = bodies.motion[body];
    sum += double(bodies.masses[body].mass) *
           cross(center_of(bodies, body) - point, DVec3(motion.linear_velocity));
    sum += DVec3(spin_of(bodies, body, motion.angular_velocity));
  }
  return sum;
}

// An island as one rigid body.
struct RigidBody {
  DVec3 center;
  double mass = 0.0;
  Sym3 inertia;
};
RigidBody as_one(const BodyStore& bodies, const JointIsland& island) {
  RigidBody one;
  const DVec3 origin = center_of(bodies, island.bodies[0]);
  DVec3 moment;
  for (const std::uint32_t body : island.bodies) {
    const double m = double(bodies.masses[body].mass);
    one.mass += m;
    moment += m * (center_of(bodies, body) - origin);
  }
  one.center = origin + (1.0 / one.mass) * moment;
  for (const std::uint32_t body : island.bodies) {
    const float m = bodies.masses[body].mass;
    const Vec3 r = to_float(center_of(bodies, body) - one.center);
    const float square_r = length_squared(r);
    one.inertia = one.inertia + inertia_of(bodies, body) +
                  m * Sym3{square_r - r.x * r.x, square_r - r.y * r.y, square_r - r.z * r.z,
                           -r.x * r.y,           -r.x * r.z,           -r.y * r.z};
  }
  return one;
}

// The rigid motion of an island with its present momenta, as far as its joints cannot see that motion.
struct RigidMotion {
  DVec3 center;
  Vec3 linear, angular;
  double energy = 0.0;
};
RigidMotion rigid_motion(const BodyStore& bodies, const JointIsland& island) {
  RigidMotion rigid;
  if (island.frame == IslandFrame::held) {
    const CarrierMotion carriage = carriage_of(bodies, island);
    return {carriage.center, carriage.linear, carriage.angular, 0.0};
  }
  const RigidBody one = as_one(bodies, island);
  rigid.center = one.center;
  DVec3 momentum;
  for (const std::uint32_t body : island.bodies)
    momentum += double(bodies.masses[body].mass) * DVec3(bodies.motion[body].linear_velocity);
  rigid.linear = to_float((1.0 / one.mass) * momentum);
  rigid.energy = 0.5 * one.mass * double(length_squared(rigid.linear));
  if (island.frame == IslandFrame::parallel) return rigid;
  const Vec3 spin = to_float(angular_momentum(bodies, island, one.center));
  rigid.angular = inverse(one.inertia) * spin;
  rigid.energy += 0.5 * double(dot(rigid.angular, spin));
  return rigid;
}

// Joint impulses on an island sum to zero. With geometric stiffness (solver/articulation/articulation.cpp) bodies take up less angular
// momentum than that; the island gets the rest as one rigid body.
void keep_angular_momentum(BodyStore& bodies, const JointIsland& island) {
  const DVec3 lost = island.spin - angular_momentum(bodies, island, center_of(bodies, island.bodies[0]));
  if (!(length_squared(lost) > square(kSpinRounding) * length_squared(island.spin))) return;
  const RigidBody one = as_one(bodies, island);
  const Vec3 turn = inverse(one.inertia) * to_float(lost);
  for (const std::uint32_t body : island.bodies) {
    BodyMotion& motion = bodies.motion[body];
    motion.linear_velocity += cross(turn, to_float(center_of(bodies, body) - one.center)) + Vec3{};
    motion.angular_velocity += turn + Vec3{};
  }
}

// Removes `taken` (J) from the inner motion.
void slow_down(BodyStore& bodies, const JointIsland& island, double energy, double taken) {
  const RigidMotion rigid = rigid_motion(bodies, island);
  const double inner = energy - rigid.energy;
  const float share = inner > taken ? float(std::sqrt((inner - taken) / inner)) : 0.0f;
  for (const std::uint32_t body : island.bodies) {
    BodyMotion& motion = bodies.motion[body];
    Vec3 linear = rigid.linear;
    if (island.frame != IslandFrame::parallel)
      linear += cross(rigid.angular, to_float(center_of(bodies, body) - rigid.center));
    motion.linear_velocity = linear + share * (motion.linear_velocity - linear) + Vec3{};
    motion.angular_velocity = rigid.angular + share * (motion.angular_velocity - rigid.angular) + Vec3{};
  }
}

// The energy (J) with which all bodies return from large joint errors. In a rotating carrier frame it includes the curvature of the path in
// a sub-step of `h`.
double energy_of_errors(const BodyStore& bodies, const JointIsland& island, float rate, float h) {
  const CarrierMotion carriage = carriage_of(bodies, island);
  double sum = 0.0, bent = 0.0;
  for (const std::uint32_t body : island.bodies) {
    const Sym3& inertia = bodies.masses[body].inertia;
    if (carriage.angular != Vec3{}) {
      const Vec3 acceleration =
          cross(carriage.angular, carriage.at(center_of(bodies, body)) - carriage.linear);
      bent += double(bodies.masses[body].mass) * double(length_squared(h * acceleration));
    }
    sum += double(bodies.masses[body].mass) * square(double(kMaxErrors.point));
    sum += double(max(inertia.xx, max(inertia.yy, inertia.zz))) * square(double(kMaxErrors.rotation));
  }
  return 0.5 * (square(double(rate)) * sum + bent);
}

// Share of the work of motors by which the gain may be off. The rows of light links between heavy bodies yield to a motor's force in one
// stage and take the yielding back in the next. So work passes between the motor and these rows, and is not all the motor's own.
constexpr float kMotorShare = 0.25f;

// Limits a gain that exceeds `most` times the energy before it, which counts as `least` or more. Then the island keeps `left` times that
// energy of its gain, and the rest is removed. True if the gain was limited.
bool bound_gain(BodyStore& bodies, JointIsland& island, float most, float left, double least = 0.0) {
  if (!(island.energy_gain > double(kMotorShare) * island.motor_work)) return false;
  const double energy = kinetic_energy(bodies, island), before = max(energy - island.energy_gain, least);
  if (!(island.energy_gain > double(most) * before)) return false;
  const double kept = double(left) * before;
  slow_down(bodies, island, energy, island.energy_gain - kept);
  island.energy_gain = kept;
  return true;
}

void clear_impulses(JointAxisRecord& axis) {
  axis.low_impulse = axis.high_impulse = axis.motor_impulse = axis.spring_impulse = axis.friction_impulse =
      0.0f;
}
// Clears the impulses that gave too much energy, and the spring and motor impulses that they answered, so that no warm start uses them. The
// axes are in the joint constraints within a step, and in the stored records at its end.
void clear_impulses(const JointSolve& solve, const JointIsland& island) {
  JointStore& joints = solve.w.joints;
  const std::span<const std::uint8_t> in_lanes = prepared_in_simd(solve);
  for (const std::uint32_t at : island.joints) {
    JointRecord& joint = joints.records[solve.batch.joints[at]];
    joint.linear_impulse = joint.angular_impulse = {};
    joint.low_impulse = joint.high_impulse = joint.motor_impulse = joint.spring_impulse = 0.0f;
    if (JointDetail* const detail = detail_of(joints, solve.batch.joints[at])) {
      for (float& impulse : detail->row_impulses) impulse = 0.0f;
      for (JointAxisRecord& axis : detail->axes) clear_impulses(axis);
      detail->drive_force_impulse = detail->drive_torque_impulse = detail->friction_impulse = {};
    }
    if (!in_lanes.empty() && in_lanes[at] != 0) continue;
    for (AxisConstraint& x : solve.works.work[at].axes) clear_impulses(x.axis);
  }
}

bool any_turns_far(const JointSolve& solve, const JointIsland& island) {
  for (const std::uint32_t body : island.bodies)
    if (turns_far(solve.w.bodies.motion[body], solve.settings.substep)) return true;
  return false;
}

}  // namespace

std::span<JointIsland> find_joint_islands(const JointSolve& solve, std::span<const ColoringPair> contacts,
                                          std::span<const FieldBody> fields, Arena& arena) {
  if (solve.lists.swept.empty() && solve.articulations.scalar.empty()) return {};
  const BodyStore& bodies = solve.w.bodies;
  const auto is_fast = [&](std::uint32_t body) {
    return is_active(solve.w, body) && turns_far(bodies.motion[body], solve.settings.substep);
  };
  bool is_any = !solve.articulations.scalar.empty();
  for (const std::uint32_t body : solve.batch.bodies) {
    if (is_any) break;
    is_any = is_fast(body);
  }
  if (!is_any) return {};
  return IslandFinder(solve, contacts, fields, arena).find();
}

namespace {

void begin_work(const JointSolve& solve, JointIsland& island, bool is_warm) {
  begin_actuated_rows(solve, island.worked, is_warm);
  island.before = kinetic_energy(solve.w.bodies, island);
  if (island.frame == IslandFrame::rigid)
    island.spin = angular_momentum(solve.w.bodies, island, center_of(solve.w.bodies, island.bodies[0]));
}
void end_work(const JointSolve& solve, JointIsland& island) {
  const ActuatedWork work = actuated_work(solve, island.worked);
  island.motor_work += work.of_motors;
  if (island.frame == IslandFrame::rigid) keep_angular_momentum(solve.w.bodies, island);
  island.energy_gain += kinetic_energy(solve.w.bodies, island) - island.before - work.net;
}

}  // namespace

void begin_warm_start_energy(const JointSolve& solve, int begin, int end) {
  for (JointIsland& island : solve.islands.subspan(std::size_t(begin), std::size_t(end - begin)))
    begin_work(solve, island, true);
}
void begin_energy_gain(const JointSolve& solve, int begin, int end) {
  for (JointIsland& island : solve.islands.subspan(std::size_t(begin), std::size_t(end - begin)))
    begin_work(solve, island, false);
}
void limit_energy_gain(const JointSolve& solve, int begin, int end) {
  for (JointIsland& island : solve.islands.subspan(std::size_t(begin), std::size_t(end - begin))) {
    end_work(solve, island);
    const double least =
        energy_of_errors(solve.w.bodies, island, solve.settings.softness.bias_rate, solve.settings.substep);
    if (!bound_gain(solve.w.bodies, island, kMaxEnergyGainAhead, kMaxEnergyGainAhead, least)) continue;
    island.is_bounded = true;
    clear_impulses(solve, island);
  }
}
void remove_energy_gain(const JointSolve& solve, int begin, int end) {
  for (JointIsland& island : solve.islands.subspan(std::size_t(begin), std::size_t(end - begin))) {
    end_work(solve, island);
    // A contact that carries a joint's load may remove between two stages the energy that seems to be added in one. At rest on the ground
    // this would be the whole gain. Beside fast rotation it is little.
    if (!island.is_pushed || island.is_bounded || any_turns_far(solve, island))
      bound_gain(solve.w.bodies, island, kMaxEnergyGain, 0.0f);
    island.energy_gain = island.motor_work = 0.0;
  }
}
void forget_limited_impulses(const JointSolve& solve) {
  for (const JointIsland& island : solve.islands)
    if (island.is_bounded) clear_impulses(solve, island);
}

}  // namespace gyre
