#include "rigid/integrate/smooth_motion.h"

#include "base/container/disjoint_sets.h"
#include "solver/motion/motion_block.h"

namespace gyre {

namespace {

// As many parts as a step is ever cut into for the sake of its error.
constexpr int kMaxParts = 8192;

bool is_untouched(const RigidWorld& w, std::uint32_t body) {
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
  body.inverse_inertia = inverse(body.inertia);
  body.geometric_stiffness =
      double(forces.gravity_scale) * DVec3(w.settings.gravity) + DVec3(forces.force) / body.mass;
  body.torque = DVec3(forces.torque);
  body.linear_damping = double(forces.linear_damping);
  body.angular_damping = double(forces.angular_damping);
  body.reach = double(mass.bounding_radius);
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

// The last move of a body whose velocities are still those that it was shown with.
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
    room.turned[i] = {};
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
                   std::span<const std::uint32_t> place_in_system, std::span<const std::uint32_t> places) {
  SpringEnd end;
  end.body = body;
  end.arm = DVec3(local_anchor);
  end.point = world_anchor;
  if (body != kNoBody && is_untouched(w, std::uint32_t(body)))
    end.place = int(place_in_system[places[std::size_t(body)]]);
  return end;
}

SmoothSpring make_spring(const RigidWorld& w, std::uint32_t slot,
                         std::span<const std::uint32_t> place_in_system,
                         std::span<const std::uint32_t> places) {
  const JointRecord& joint = w.joints.records[slot];
  SmoothSpring spring;
  spring.joint = slot;
  spring.stiffness = double(joint.stiffness);
  spring.damping = double(joint.damping);
  spring.rest = double(joint.rest_length);
  spring.a = make_end(w, joint.body_a, joint.local_anchor_a, joint.world_anchor_a, place_in_system, places);
  spring.b = make_end(w, joint.body_b, joint.local_anchor_b, joint.world_anchor_b, place_in_system, places);
  return spring;
}

// Where a carried end is now.
void look_at_end(const RigidWorld& w, SpringEnd& end) {
  if (end.place >= 0 || end.body == kNoBody) return;
  const std::size_t i = std::size_t(end.body);
  const BodyMotion& motion = w.bodies.motion[i];
  const DVec3 lever = rotate(normalized(to_double(w.bodies.orientations[i])), end.arm);
  end.point = w.bodies.poses[i].center + motion.moved + lever;
  end.velocity = DVec3(motion.linear_velocity) + cross(DVec3(motion.angular_velocity), lever);
}

void kick_end(RigidWorld& w, const SpringEnd& end, DVec3 impulse) {
  if (end.place >= 0 || end.body == kNoBody || !is_active(w, std::uint32_t(end.body))) return;
  const std::size_t i = std::size_t(end.body);
  BodyMotion& motion = w.bodies.motion[i];
  const DVec3 lever = end.point - (w.bodies.poses[i].center + motion.moved);
  motion.linear_velocity += motion.inverse_mass * to_float(impulse) + Vec3{};
  motion.angular_velocity += w.bodies.inertia[i].inverse * to_float(cross(lever, impulse)) + Vec3{};
}

bool moves(const RigidWorld& w, const SpringEnd& end) {
  if (end.place >= 0 || end.body == kNoBody) return false;
  const BodyFlags& flags = w.bodies.flags[std::size_t(end.body)];
  return flags.type != BodyType::fixed && flags.awake != 0 && flags.constraint_use != kNotConstrained;
}

// Parts [0, parts) of the whole step.
void run_parts(const SmoothMotion& motion, SmoothSystem& system, SchemeRoom& room, int parts) {
  const double h = motion.h * double(motion.parts) / double(parts);
  begin_room(*motion.world, system, room);
  for (int part = 0; part < parts; ++part) {
    system.part = double(part) * h;
    integrate(motion.settings.integrator, system, room, system.part, h);
    limit_speeds(system, room);
  }
  for (SmoothSpring& spring : system.springs) spring.total = spring.impulse;
  system.part = double(parts) * h;
  show_velocities(motion.settings.integrator, system, room, system.part);
}

// How far apart two ends of the same step of `seconds` are: places, and what the velocities make of them in as much time again.
double difference_of(const SmoothSystem& system, const SchemeRoom& a, const SchemeRoom& b, double seconds) {
  double most = 0.0;
  for (std::size_t i = 0; i < system.bodies.size(); ++i) {
    const SmoothState &s = a.stage[i], &t = b.stage[i];
    const double way = length(s.x - t.x) + seconds * length(s.v - t.v);
    const double turn = length(logarithm_map(s.q * conjugate(t.q))) +
                        seconds * length(spin_of(system.bodies[i], s) - spin_of(system.bodies[i], t));
    most = max(most, way + system.bodies[i].reach * turn);
  }
  return most;
}

// Schemes of order 1: what the two ends say about their error is taken off (local extrapolation), which makes them of order 2, and
// exact where forces are the same all along.
void extrapolate(const SmoothSystem& system, const SchemeRoom& coarse, SchemeRoom& fine) {
  for (std::size_t i = 0; i < system.bodies.size(); ++i) {
    const SmoothState& from = coarse.stage[i];
    SmoothState& to = fine.stage[i];
    to.x += to.x - from.x;
    to.v += to.v - from.v;
    to.l += to.l - from.l;
    const DVec3 turn = logarithm_map(to.q * conjugate(from.q));
    to.q = normalized(exponential_map(turn) * to.q);
    fine.turned[i] += turn;
  }
}

void run_to_tolerance(const SmoothMotion& motion, std::size_t n) {
  SmoothSystem& system = motion.systems[n];
  SchemeRoom* coarse = &motion.second_rooms[n];
  SchemeRoom* fine = &motion.rooms[n];
  const double share = double((1 << order_of(motion.settings.integrator)) - 1);
  const double tolerance = double(motion.settings.tolerance);
  int parts = motion.parts;
  run_parts(motion, system, *coarse, parts);
  for (;;) {
    parts *= 2;
    run_parts(motion, system, *fine, parts);
    const double error = difference_of(system, *coarse, *fine, motion.h * double(motion.parts)) / share;
    motion.errors[n] = error;
    motion.parts_used[n] = std::uint32_t(parts);
    if (!(error > tolerance) || parts >= kMaxParts) break;
    std::swap(coarse, fine);
  }
  if (order_of(motion.settings.integrator) == 1) extrapolate(system, *coarse, *fine);
  if (fine != &motion.rooms[n]) std::swap(motion.rooms[n], motion.second_rooms[n]);
}

// The bodies of each system together, ascending, systems by their lowest body.
struct Members {
  std::span<std::uint32_t> system_of;  // by place in the batch
  std::span<std::uint32_t> in_system;  // by place in the batch
  std::span<std::uint32_t> sizes;
};

Members part_bodies(const RigidWorld& w, const SolveBatch& batch, std::span<const std::uint32_t> places,
                    std::span<const std::uint32_t> springs, Arena& arena) {
  const std::size_t count = batch.bodies.size();
  const DisjointSets roots(arena.make<std::uint32_t>(count));
  for (const std::uint32_t slot : springs) {
    const JointRecord& joint = w.joints.records[slot];
    if (joint.body_a == kNoBody || joint.body_b == kNoBody) continue;
    const std::uint32_t a = std::uint32_t(joint.body_a), b = std::uint32_t(joint.body_b);
    if (is_untouched(w, a) && is_untouched(w, b)) roots.unite(places[a], places[b]);
  }
  Members members{arena.make<std::uint32_t>(count), arena.make<std::uint32_t>(count),
                  arena.make<std::uint32_t>(count)};
  std::uint32_t systems = 0;
  for (std::uint32_t i = 0; i < count; ++i) {
    members.system_of[i] = kNoIndex;
    if (!is_untouched(w, batch.bodies[i])) continue;
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

// What feels velocities needs more looks at its forces.
bool feels_velocity(const RigidWorld& w, const SmoothBody& body) {
  bool feels = body.linear_damping > 0.0 || body.angular_damping > 0.0;
  for (const std::uint32_t slot : body.fields) feels = feels || w.fields[slot].is_medium();
  return feels;
}

void make_systems(SmoothMotion& motion, const SolveBatch& batch, const Members& members, Arena& arena) {
  RigidWorld& w = *motion.world;
  const std::size_t count = members.sizes.size();
  motion.systems = arena.make<SmoothSystem>(count);
  motion.rooms = arena.make<SchemeRoom>(count);
  motion.parts_used = arena.make<std::uint32_t>(count);
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
    motion.parts_used[n] = std::uint32_t(motion.parts);
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

// Springs go to the system of their free end; those without one are loose.
void share_springs(SmoothMotion& motion, const Members& members, std::span<const std::uint32_t> springs,
                   std::span<const std::uint32_t> places, Arena& arena) {
  const RigidWorld& w = *motion.world;
  const auto system_of = [&](std::uint32_t slot) {
    const JointRecord& joint = w.joints.records[slot];
    for (const std::int32_t body : {joint.body_a, joint.body_b}) {
      if (body != kNoBody && is_untouched(w, std::uint32_t(body)))
        return members.system_of[places[std::size_t(body)]];
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
    SmoothSpring spring = make_spring(w, slot, members.in_system, places);
    if (n == kNoIndex) {
      motion.loose[loose++] = spring;
      continue;
    }
    SmoothSystem& system = motion.systems[n];
    system.damped = system.damped || spring.damping > 0.0;
    system.carried = system.carried || moves(w, spring.a) || moves(w, spring.b);
    look_at_end(w, spring.a);
    look_at_end(w, spring.b);
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

SmoothMotion find_smooth_motion(RigidWorld& w, const SolveBatch& batch, std::span<const std::uint32_t> places,
                                int parts, float h, Arena& arena) {
  SmoothMotion motion;
  motion.world = &w;
  motion.settings = w.motion_settings[0];
  motion.parts = parts;
  motion.h = double(h);
  const std::span<std::uint32_t> springs = arena.make<std::uint32_t>(batch.joints.size());
  std::size_t count = 0;
  for (const std::uint32_t slot : batch.joints) {
    if (is_explicit_spring(w, slot)) springs[count++] = slot;
  }
  // Who has a spring is looked at in each part: kinematic bodies, and those that constraints act on anyway.
  for (const std::uint32_t slot : springs.first(count)) {
    const JointRecord& joint = w.joints.records[slot];
    for (const std::int32_t body : {joint.body_a, joint.body_b}) {
      if (body == kNoBody) continue;
      BodyFlags& flags = w.bodies.flags[std::size_t(body)];
      if (flags.type == BodyType::kinematic || flags.constraint_use != kNotConstrained)
        flags.constraint_use = kPoseRead;
    }
  }
  const Members members = part_bodies(w, batch, places, springs.first(count), arena);
  make_systems(motion, batch, members, arena);
  share_springs(motion, members, springs.first(count), places, arena);
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
      run_parts(motion, system, motion.rooms[std::size_t(n)], motion.parts);
    }
  }
}

void move_coupled_spring_systems(const SmoothMotion& motion, int begin, int end) {
  for (int n = begin; n < end; ++n) {
    SmoothSystem& system = motion.systems[std::size_t(n)];
    if (!system.carried) continue;
    system.part = motion.time;
    for (SmoothSpring& spring : system.springs) {
      spring.impulse = {};
      look_at_end(*motion.world, spring.a);
      look_at_end(*motion.world, spring.b);
    }
    integrate(motion.settings.integrator, system, motion.rooms[std::size_t(n)], motion.time, motion.h);
    limit_speeds(system, motion.rooms[std::size_t(n)]);
    for (SmoothSpring& spring : system.springs) spring.total += spring.impulse;
  }
}

void apply_spring_impulses(SmoothMotion& motion, int, int) {
  RigidWorld& w = *motion.world;
  // Loose springs first look at all places and speeds as they were, then act.
  for (SmoothSpring& spring : motion.loose) {
    look_at_end(w, spring.a);
    look_at_end(w, spring.b);
    const SpringForce on_b =
        spring_force(spring, spring.a.point, spring.b.point, spring.a.velocity, spring.b.velocity);
    spring.impulse = motion.h * on_b.force;
    spring.length = on_b.length;
    spring.total += spring.impulse;
  }
  const auto kick = [&](const SmoothSpring& spring) {
    kick_end(w, spring.a, -spring.impulse);
    kick_end(w, spring.b, spring.impulse);
  };
  for (const SmoothSpring& spring : motion.loose) kick(spring);
  for (const SmoothSystem& system : motion.systems) {
    if (!system.carried) continue;
    for (const SmoothSpring& spring : system.springs) kick(spring);
  }
  motion.time += motion.h;
}

void finish_spring_systems(const SmoothMotion& motion, int begin, int end) {
  RigidWorld& w = *motion.world;
  const bool keeps_moves = motion.settings.integrator == IntegratorKind::verlet;
  for (int n = begin; n < end; ++n) {
    SmoothSystem& system = motion.systems[std::size_t(n)];
    SchemeRoom& room = motion.rooms[std::size_t(n)];
    if (system.carried) {
      system.part = motion.h * double(motion.parts);
      show_velocities(motion.settings.integrator, system, room, system.part);
    }
    for (std::size_t k = 0; k < system.bodies.size(); ++k) {
      const SmoothBody& from = system.bodies[k];
      const SmoothState& s = room.stage[k];
      const std::uint32_t i = from.body;
      BodyMotion& to = w.bodies.motion[i];
      to.linear_velocity = to_float(clamp_length(s.v, double(kMaxSpeed))) + Vec3{};
      to.angular_velocity = to_float(clamp_length(spin_of(from, s), double(kMaxSpin))) + Vec3{};
      to.moved = to_float(s.x - from.start.x) + Vec3{};
      to.turned = to_float(room.turned[k]) + Vec3{};
      w.bodies.orientations[i] = normalized(to_float(s.q));
      const BodyMass& mass = w.bodies.masses[i];
      const BodyFlags& flags = w.bodies.flags[i];
      if (mass.isotropic == 0 || flags.locked_angular != 0)
        w.bodies.inertia[i] = world_inertia(mass, flags, w.bodies.orientations[i]);
      if (!keeps_moves) continue;
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
    report.parts = max(report.parts, int(motion.parts_used[n]));
    report.error = max(report.error, float(motion.errors[n]));
  }
}

}  // namespace gyre
