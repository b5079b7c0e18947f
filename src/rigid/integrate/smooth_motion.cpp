#include "rigid/integrate/smooth_motion.h"

#include "base/container/disjoint_sets.h"
#include "solver/motion/motion_block.h"

namespace gyre {

namespace {

// Largest number of sub-steps of the error control.
constexpr int kMaxSubsteps = 8192;

bool is_unconstrained(const RigidWorld& w, std::uint32_t body) {
  return is_active(w, body) && w.bodies.flags[body].constraint_use == kNotConstrained;
}

SmoothBody describe(const RigidWorld& w, std::uint32_t i, Arena& arena) {
  const BodyMass& mass = w.bodies.masses[i];
  const BodyForces& forces = w.bodies.forces[i];
  const BodyFlags& flags = w.bodies.flags[i];
  const BodyMotion& motion = w.bodies.motion[i];
  SmoothBody body;
  body.body = i;
  body.mass = double(mass.mass);
  body.inertia = to_double(mass.inertia);
  // A body without moments of inertia does not turn.
  const bool turns = mass.inertia.xx > 0.0f && mass.inertia.yy > 0.0f && mass.inertia.zz > 0.0f;
  body.inverse_inertia = turns ? inverse(body.inertia) : Tensor{};
  body.acceleration =
      double(forces.gravity_scale) * DVec3(w.settings.gravity) + DVec3(forces.force) / body.mass;
  body.torque = DVec3(forces.torque);
  body.linear_damping = double(forces.linear_damping);
  body.angular_damping = double(forces.angular_damping);
  body.bounding_radius = double(mass.bounding_radius);
  body.locked_linear = flags.locked_linear;
  body.locked_angular = flags.locked_angular;
  if (!w.fields.empty()) {
    const std::span<std::uint32_t> list = arena.make<std::uint32_t>(w.fields.size());
    std::size_t count = 0;
    for (std::uint32_t slot = 0; slot < w.fields.size(); ++slot) {
      if (w.fields[slot].is_live() && acts_on(w, w.fields[slot], i, w.bodies.poses[i].center))
        list[count++] = slot;
    }
    body.fields = list.first(count);
  }
  body.start.x = w.bodies.poses[i].center;
  body.start.q = normalized(to_double(w.bodies.orientations[i]));
  body.start.v = without_axes(DVec3(motion.linear_velocity), body.locked_linear);
  body.start.l = momentum_of(body, body.start, DVec3(motion.angular_velocity));
  return body;
}

// The last move of a body whose velocities have not been changed since.
LastMove last_move_of(const RigidWorld& w, std::uint32_t body) {
  if (body >= w.bodies.last_moves.size()) return {};
  const LastMove& move = w.bodies.last_moves[body];
  const BodyMotion& motion = w.bodies.motion[body];
  return move.linear == motion.linear_velocity && move.angular == motion.angular_velocity ? move : LastMove{};
}

void begin_room(const RigidWorld& w, const SmoothSystem& system, SchemeRoom& room) {
  for (std::size_t i = 0; i < system.bodies.size(); ++i) {
    room.states[i] = system.bodies[i].start;
    room.moves[i] = last_move_of(w, system.bodies[i].body);
    room.delta_rotation[i] = {};
  }
  for (SmoothSpring& spring : system.springs) spring.impulse = spring.total = {};
}

void limit_speeds(const SmoothSystem& system, SchemeRoom& room) {
  for (std::size_t i = 0; i < system.bodies.size(); ++i) {
    SmoothState& s = room.states[i];
    s.v = clamp_length(s.v, double(kMaxSpeed));
    const DVec3 spin = spin_of(system.bodies[i], s);
    if (length(spin) > double(kMaxSpin))
      s.l = momentum_of(system.bodies[i], s, clamp_length(spin, double(kMaxSpin)));
  }
}

SpringEnd make_end(const RigidWorld& w, std::int32_t body, Vec3 local_anchor, DVec3 world_anchor,
                   std::span<const std::uint32_t> index_in_system,
                   std::span<const std::uint32_t> body_indices) {
  SpringEnd end;
  end.body = body;
  end.arm = DVec3(local_anchor);
  end.point = world_anchor;
  if (body != kNoBody && is_unconstrained(w, std::uint32_t(body)))
    end.index = int(index_in_system[body_indices[std::size_t(body)]]);
  return end;
}

SmoothSpring make_spring(const RigidWorld& w, std::uint32_t slot,
                         std::span<const std::uint32_t> index_in_system,
                         std::span<const std::uint32_t> body_indices) {
  const JointRecord& joint = w.joints.records[slot];
  SmoothSpring spring;
  spring.joint = slot;
  spring.stiffness = double(joint.stiffness);
  spring.damping = double(joint.damping);
  spring.rest = double(joint.rest_length);
  spring.a =
      make_end(w, joint.body_a, joint.local_anchor_a, joint.world_anchor_a, index_in_system, body_indices);
  spring.b =
      make_end(w, joint.body_b, joint.local_anchor_b, joint.world_anchor_b, index_in_system, body_indices);
  return spring;
}

// Updates a carried end to the present pose.
void update_end(const RigidWorld& w, SpringEnd& end) {
  if (end.index >= 0 || end.body == kNoBody) return;
  const std::size_t i = std::size_t(end.body);
  const BodyMotion& motion = w.bodies.motion[i];
  const DVec3 lever = rotate(normalized(to_double(w.bodies.orientations[i])), end.arm);
  end.point = w.bodies.poses[i].center + motion.delta_position + lever;
  end.velocity = DVec3(motion.linear_velocity) + cross(DVec3(motion.angular_velocity), lever);
}

void apply_impulse_to_end(RigidWorld& w, const SpringEnd& end, DVec3 impulse) {
  if (end.index >= 0 || end.body == kNoBody || !is_active(w, std::uint32_t(end.body))) return;
  const std::size_t i = std::size_t(end.body);
  BodyMotion& motion = w.bodies.motion[i];
  const DVec3 lever = end.point - (w.bodies.poses[i].center + motion.delta_position);
  motion.linear_velocity += motion.inverse_mass * to_float(impulse) + Vec3{};
  motion.angular_velocity += w.bodies.inertia[i].inverse * to_float(cross(lever, impulse)) + Vec3{};
}

bool moves(const RigidWorld& w, const SpringEnd& end) {
  if (end.index >= 0 || end.body == kNoBody) return false;
  const BodyFlags& flags = w.bodies.flags[std::size_t(end.body)];
  return flags.type != BodyType::fixed && flags.awake != 0 && flags.constraint_use != kNotConstrained;
}

// Sub-steps [0, substeps) of the whole step.
void run_substeps_of(const SmoothMotion& motion, SmoothSystem& system, SchemeRoom& room, int substeps) {
  const double h = motion.h * double(motion.substeps) / double(substeps);
  begin_room(*motion.world, system, room);
  for (int substep = 0; substep < substeps; ++substep) {
    system.substep_begin = double(substep) * h;
    integrate(motion.settings.integrator, system, room, system.substep_begin, h);
    limit_speeds(system, room);
  }
  for (SmoothSpring& spring : system.springs) spring.total = spring.impulse;
  system.substep_begin = double(substeps) * h;
  set_pose_velocities(motion.settings.integrator, system, room, system.substep_begin);
}

// Difference between two results of the same step of `seconds`: of poses, and of the effect of velocities
// over the same time again.
double difference_of(const SmoothSystem& system, const SchemeRoom& a, const SchemeRoom& b, double seconds) {
  double largest = 0.0;
  for (std::size_t i = 0; i < system.bodies.size(); ++i) {
    const SmoothState &s = a.stage[i], &t = b.stage[i];
    const double linear = length(s.x - t.x) + seconds * length(s.v - t.v);
    const double angular = length(logarithm_map(s.q * conjugate(t.q))) +
                           seconds * length(spin_of(system.bodies[i], s) - spin_of(system.bodies[i], t));
    largest = max(largest, linear + system.bodies[i].bounding_radius * angular);
  }
  return largest;
}

// Removes the error that the two results show (local extrapolation). Schemes of order 1 then have order 2,
// and are exact for constant forces.
void extrapolate(const SmoothSystem& system, const SchemeRoom& coarse, SchemeRoom& fine) {
  for (std::size_t i = 0; i < system.bodies.size(); ++i) {
    const SmoothState& from = coarse.stage[i];
    SmoothState& to = fine.stage[i];
    to.x += to.x - from.x;
    to.v += to.v - from.v;
    to.l += to.l - from.l;
    const DVec3 rotation = logarithm_map(to.q * conjugate(from.q));
    to.q = normalized(exponential_map(rotation) * to.q);
    fine.delta_rotation[i] += rotation;
  }
}

void run_to_tolerance(const SmoothMotion& motion, std::size_t n) {
  SmoothSystem& system = motion.systems[n];
  SchemeRoom* coarse = &motion.second_rooms[n];
  SchemeRoom* fine = &motion.rooms[n];
  const double share = double((1 << order_of(motion.settings.integrator)) - 1);
  const double tolerance = double(motion.settings.tolerance);
  int substeps = motion.substeps;
  run_substeps_of(motion, system, *coarse, substeps);
  for (;;) {
    substeps *= 2;
    run_substeps_of(motion, system, *fine, substeps);
    const double error = difference_of(system, *coarse, *fine, motion.h * double(motion.substeps)) / share;
    motion.errors[n] = error;
    motion.substeps_used[n] = std::uint32_t(substeps);
    if (!(error > tolerance) || substeps >= kMaxSubsteps) break;
    std::swap(coarse, fine);
  }
  if (order_of(motion.settings.integrator) == 1) extrapolate(system, *coarse, *fine);
  if (fine != &motion.rooms[n]) std::swap(motion.rooms[n], motion.second_rooms[n]);
}

// The bodies of each system together, ascending, systems by their lowest body.
struct Members {
  std::span<std::uint32_t> system_of;  // by body index in the batch
  std::span<std::uint32_t> in_system;  // by body index in the batch
  std::span<std::uint32_t> sizes;
};

Members group_bodies(const RigidWorld& w, const SolveBatch& batch,
                     std::span<const std::uint32_t> body_indices, std::span<const std::uint32_t> springs,
                     Arena& arena) {
  const std::size_t count = batch.bodies.size();
  const DisjointSets roots(arena.make<std::uint32_t>(count));
  for (const std::uint32_t slot : springs) {
    const JointRecord& joint = w.joints.records[slot];
    if (joint.body_a == kNoBody || joint.body_b == kNoBody) continue;
    const std::uint32_t a = std::uint32_t(joint.body_a), b = std::uint32_t(joint.body_b);
    if (is_unconstrained(w, a) && is_unconstrained(w, b)) roots.unite(body_indices[a], body_indices[b]);
  }
  Members members{arena.make<std::uint32_t>(count), arena.make<std::uint32_t>(count),
                  arena.make<std::uint32_t>(count)};
  std::uint32_t systems = 0;
  for (std::uint32_t i = 0; i < count; ++i) {
    members.system_of[i] = kNoIndex;
    if (!is_unconstrained(w, batch.bodies[i])) continue;
    const std::uint32_t root = roots.of(i);
    if (root == i) {
      members.sizes[systems] = 0;
      members.system_of[i] = systems++;
    } else {
      members.system_of[i] = members.system_of[root];
    }
    members.in_system[i] = members.sizes[members.system_of[i]]++;
  }
  members.sizes = members.sizes.first(systems);
  return members;
}

// Forces that depend on velocities need more evaluations.
bool feels_velocity(const RigidWorld& w, const SmoothBody& body) {
  bool feels = body.linear_damping > 0.0 || body.angular_damping > 0.0;
  for (const std::uint32_t slot : body.fields) feels = feels || w.fields[slot].is_medium() || w.fields[slot].is_magnetic();
  return feels;
}

void make_systems(SmoothMotion& motion, const SolveBatch& batch, const Members& members, Arena& arena) {
  RigidWorld& w = *motion.world;
  const std::size_t count = members.sizes.size();
  motion.systems = arena.make<SmoothSystem>(count);
  motion.rooms = arena.make<SchemeRoom>(count);
  motion.substeps_used = arena.make<std::uint32_t>(count);
  motion.errors = arena.make<double>(count);
  const bool plans = motion.settings.time != TimeStepping::fixed;
  motion.second_rooms = arena.make<SchemeRoom>(plans ? count : 0);
  for (std::size_t n = 0; n < count; ++n) {
    SmoothSystem& system = motion.systems[n];
    system = {};
    system.world = &w;
    system.begin = w.now;
    system.bodies = arena.make<SmoothBody>(members.sizes[n]);
    motion.rooms[n] = make_room(members.sizes[n], arena);
    if (plans) motion.second_rooms[n] = make_room(members.sizes[n], arena);
    motion.substeps_used[n] = std::uint32_t(motion.substeps);
    motion.errors[n] = 0.0;
  }
  for (std::size_t i = 0; i < batch.bodies.size(); ++i) {
    if (members.system_of[i] == kNoIndex) continue;
    const std::uint32_t body = batch.bodies[i];
    SmoothSystem& system = motion.systems[members.system_of[i]];
    SmoothBody& made = system.bodies[members.in_system[i]];
    made = describe(w, body, arena);
    system.damped = system.damped || feels_velocity(w, made);
    if (w.field_rest.empty() || made.fields.empty()) continue;
    FieldRest& rest = w.field_rest[body];
    rest = {w.bodies.motion[body].linear_velocity, w.bodies.motion[body].angular_velocity, kFieldsOnly, 0};
    for (const std::uint32_t slot : made.fields) {
      if (w.fields[slot].is_medium() && w.fields[slot].turbulence != 0.0f) rest.is_unsteady = 1;
    }
  }
}

// Assigns springs to the system of their free end; springs without one are loose.
void share_springs(SmoothMotion& motion, const Members& members, std::span<const std::uint32_t> springs,
                   std::span<const std::uint32_t> body_indices, Arena& arena) {
  const RigidWorld& w = *motion.world;
  const auto system_of = [&](std::uint32_t slot) {
    const JointRecord& joint = w.joints.records[slot];
    for (const std::int32_t body : {joint.body_a, joint.body_b}) {
      if (body != kNoBody && is_unconstrained(w, std::uint32_t(body)))
        return members.system_of[body_indices[std::size_t(body)]];
    }
    return kNoIndex;
  };
  const std::span<std::uint32_t> counts = arena.make<std::uint32_t>(motion.systems.size());
  for (std::uint32_t& count : counts) count = 0;
  std::size_t loose = 0;
  for (const std::uint32_t slot : springs) {
    const std::uint32_t system = system_of(slot);
    if (system == kNoIndex)
      ++loose;
    else
      ++counts[system];
  }
  motion.loose = arena.make<SmoothSpring>(loose);
  for (std::size_t n = 0; n < counts.size(); ++n) {
    motion.systems[n].springs = arena.make<SmoothSpring>(counts[n]);
    counts[n] = 0;
  }
  loose = 0;
  for (const std::uint32_t slot : springs) {
    const std::uint32_t n = system_of(slot);
    SmoothSpring spring = make_spring(w, slot, members.in_system, body_indices);
    if (n == kNoIndex) {
      motion.loose[loose++] = spring;
      continue;
    }
    SmoothSystem& system = motion.systems[n];
    system.damped = system.damped || spring.damping > 0.0;
    system.carried = system.carried || moves(w, spring.a) || moves(w, spring.b);
    update_end(w, spring.a);
    update_end(w, spring.b);
    system.springs[counts[n]++] = spring;
  }
}

}  // namespace

bool is_explicit_spring(const RigidWorld& w, std::uint32_t slot) {
  if (w.motion_settings.empty() || w.motion_settings[0].springs != SpringKind::explicit_force) return false;
  const JointRecord& joint = w.joints.records[slot];
  if (joint.kind != JointKind::distance || !joint.is_spring) return false;
  if (joint.min_length > 0.0f || joint.max_length < kUnlimitedLength) return false;
  const JointDetail* const detail = detail_of(w.joints, slot);
  if (detail == nullptr) return true;
  return detail->axes[int(JointAxis::linear_x)].friction == 0.0f;
}

SmoothMotion find_smooth_motion(RigidWorld& w, const SolveBatch& batch,
                                std::span<const std::uint32_t> body_indices, int substeps, float h,
                                Arena& arena) {
  SmoothMotion motion;
  motion.world = &w;
  motion.settings = w.motion_settings[0];
  motion.substeps = substeps;
  motion.h = double(h);
  const std::span<std::uint32_t> springs = arena.make<std::uint32_t>(batch.joints.size());
  std::size_t count = 0;
  for (const std::uint32_t slot : batch.joints) {
    if (is_explicit_spring(w, slot)) springs[count++] = slot;
  }
  // Bodies with springs have their pose read in each sub-step: kinematic bodies, and constrained ones.
  for (const std::uint32_t slot : springs.first(count)) {
    const JointRecord& joint = w.joints.records[slot];
    for (const std::int32_t body : {joint.body_a, joint.body_b}) {
      if (body == kNoBody) continue;
      BodyFlags& flags = w.bodies.flags[std::size_t(body)];
      if (flags.type == BodyType::kinematic || flags.constraint_use != kNotConstrained)
        flags.constraint_use = kPoseRead;
    }
  }
  const Members members = group_bodies(w, batch, body_indices, springs.first(count), arena);
  make_systems(motion, batch, members, arena);
  share_springs(motion, members, springs.first(count), body_indices, arena);
  for (const SmoothSystem& system : motion.systems) motion.any_carried = motion.any_carried || system.carried;
  motion.any_carried = motion.any_carried || !motion.loose.empty();
  for (SmoothSpring& spring : motion.loose) spring.total = {};
  return motion;
}

void move_spring_systems(const SmoothMotion& motion, int begin, int end) {
  for (int n = begin; n < end; ++n) {
    SmoothSystem& system = motion.systems[std::size_t(n)];
    if (system.carried) {
      begin_room(*motion.world, system, motion.rooms[std::size_t(n)]);
    } else if (motion.settings.time != TimeStepping::fixed) {
      run_to_tolerance(motion, std::size_t(n));
    } else {
      run_substeps_of(motion, system, motion.rooms[std::size_t(n)], motion.substeps);
    }
  }
}

void move_coupled_spring_systems(const SmoothMotion& motion, int begin, int end) {
  for (int n = begin; n < end; ++n) {
    SmoothSystem& system = motion.systems[std::size_t(n)];
    if (!system.carried) continue;
    system.substep_begin = motion.time;
    for (SmoothSpring& spring : system.springs) {
      spring.impulse = {};
      update_end(*motion.world, spring.a);
      update_end(*motion.world, spring.b);
    }
    integrate(motion.settings.integrator, system, motion.rooms[std::size_t(n)], motion.time, motion.h);
    limit_speeds(system, motion.rooms[std::size_t(n)]);
    for (SmoothSpring& spring : system.springs) spring.total += spring.impulse;
  }
}

void apply_spring_impulses(SmoothMotion& motion, int, int) {
  RigidWorld& w = *motion.world;
  // Loose springs are all evaluated before any acts.
  for (SmoothSpring& spring : motion.loose) {
    update_end(w, spring.a);
    update_end(w, spring.b);
    const SpringForce on_b =
        spring_force(spring, spring.a.point, spring.b.point, spring.a.velocity, spring.b.velocity);
    spring.impulse = motion.h * on_b.force;
    spring.length = on_b.length;
    spring.total += spring.impulse;
  }
  const auto apply = [&](const SmoothSpring& spring) {
    apply_impulse_to_end(w, spring.a, -spring.impulse);
    apply_impulse_to_end(w, spring.b, spring.impulse);
  };
  for (const SmoothSpring& spring : motion.loose) apply(spring);
  for (const SmoothSystem& system : motion.systems) {
    if (!system.carried) continue;
    for (const SmoothSpring& spring : system.springs) apply(spring);
  }
  motion.time += motion.h;
}

void finish_spring_systems(const SmoothMotion& motion, int begin, int end) {
  RigidWorld& w = *motion.world;
  const bool stores_last_move = motion.settings.integrator == IntegratorKind::verlet;
  for (int n = begin; n < end; ++n) {
    SmoothSystem& system = motion.systems[std::size_t(n)];
    SchemeRoom& room = motion.rooms[std::size_t(n)];
    if (system.carried) {
      system.substep_begin = motion.h * double(motion.substeps);
      set_pose_velocities(motion.settings.integrator, system, room, system.substep_begin);
    }
    for (std::size_t k = 0; k < system.bodies.size(); ++k) {
      const SmoothBody& from = system.bodies[k];
      const SmoothState& s = room.stage[k];
      const std::uint32_t i = from.body;
      BodyMotion& to = w.bodies.motion[i];
      to.linear_velocity = to_float(clamp_length(s.v, double(kMaxSpeed))) + Vec3{};
      to.angular_velocity = to_float(clamp_length(spin_of(from, s), double(kMaxSpin))) + Vec3{};
      to.delta_position = to_float(s.x - from.start.x) + Vec3{};
      to.delta_rotation = to_float(room.delta_rotation[k]) + Vec3{};
      w.bodies.orientations[i] = normalized(to_float(s.q));
      const BodyMass& mass = w.bodies.masses[i];
      const BodyFlags& flags = w.bodies.flags[i];
      if (mass.isotropic == 0 || flags.locked_angular != 0)
        w.bodies.inertia[i] = world_inertia(mass, flags, w.bodies.orientations[i]);
      if (!stores_last_move) continue;
      LastMove& move = w.bodies.last_moves[i];
      move = room.moves[k];
      move.linear = to.linear_velocity;
      move.angular = to.angular_velocity;
    }
  }
}

void finish_springs(RigidWorld& w, const SmoothMotion& motion, StepStats& report) {
  const auto finish = [&](const SmoothSpring& spring) {
    JointRecord& joint = w.joints.records[spring.joint];
    joint.total_linear = to_float(spring.total) + Vec3{};
    joint.total_angular = {};
    joint.position = float(spring.length);
    joint.spring_impulse = 0.0f;
  };
  for (const SmoothSpring& spring : motion.loose) finish(spring);
  for (std::size_t n = 0; n < motion.systems.size(); ++n) {
    for (const SmoothSpring& spring : motion.systems[n].springs) finish(spring);
    report.parts = max(report.parts, int(motion.substeps_used[n]));
    report.error = max(report.error, float(motion.errors[n]));
  }
}

}  // namespace gyre
