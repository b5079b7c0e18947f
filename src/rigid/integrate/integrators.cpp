#include "rigid/integrate/integrators.h"

#include "math/rotation.h"
#include "math/trig.h"
#include "math/wide_vec.h"
#include "rigid/integrate/free_rotation.h"

#include <cstddef>

namespace gyre {

namespace {

Vec3 shortened(Vec3 v, float top, float most) {
  // In units of the largest component: the length itself may be beyond all floats.
  const float size = length(v / top), limit = most / top;
  return size > limit ? (limit / size) * v : v;
}
Vec3 within_length(Vec3 v, float most) {
  const float top = largest(absolute(v));
  return top > most * 0.5f ? shortened(v, top, most) : v;
}

// The vector without its components along locked world axes (bits 1, 2, 4: x, y, z).
Vec3 without_locked(Vec3 v, std::uint8_t locked) {
  if (locked & 1) v.x = 0.0f;
  if (locked & 2) v.y = 0.0f;
  if (locked & 4) v.z = 0.0f;
  return v;
}

// The exact step of dv/dt = a - damping v is v += gain a - lost v.
struct Damping {
  float gain, lost;

  Damping(float damping, float h) : gain(h), lost(0.0f) {
    if (!(damping > 0.0f)) return;
    // As a change of v: e itself, so near 1, would round the same way in every sub-step.
    const double share = 1.0 - exp(-double(damping) * double(h));
    gain = float(share / double(damping));
    lost = float(share);
  }
};

// The inertia of a body whose orientation is known.
void refresh_world_inertia(BodyStore& bodies, std::uint32_t i) {
  const BodyMass& mass = bodies.masses[i];
  const BodyFlags& flags = bodies.flags[i];
  if (!inertia_rotates(mass, flags)) return;
  bodies.inertia[i] = world_inertia(mass, flags, bodies.orientations[i]);
}

// The inertia of bodies whose orientation is known, four at once where it is plainly that of their frame, turned.
class InertiaRefresh {
 public:
  explicit InertiaRefresh(BodyStore& bodies) : bodies_(bodies) {}

  void add(std::uint32_t body) {
    const BodyFlags& flags = bodies_.flags[body];
    if (!is_movable(flags) || flags.locked_angular != 0 || bodies_.masses[body].isotropic != 0)
      return refresh_world_inertia(bodies_, body);
    waiting_[count_++] = body;
    if (count_ == kLanes) turn_all();
  }
  void finish() {
    for (int i = 0; i < count_; ++i) refresh_world_inertia(bodies_, waiting_[i]);
    count_ = 0;
  }

 private:
  static constexpr int kLanes = 4;
  static_assert(offsetof(Sym3, xz) == 4 * sizeof(float) && offsetof(BodyInertia, inverse) == 0);

  void turn_all() {
    const float *turns[kLanes], *own[kLanes], *own_rest[kLanes];
    float* turned[kLanes];
    for (int i = 0; i < kLanes; ++i) {
      const BodyMass& mass = bodies_.masses[waiting_[i]];
      BodyInertia& inertia = bodies_.inertia[waiting_[i]];
      inertia.inverse_mass = bodies_.flags[waiting_[i]].locked_linear == 7 ? 0.0f : mass.inverse_mass;
      turns[i] = &bodies_.orientations[waiting_[i]].x;
      own[i] = &mass.inverse_inertia.xx;
      own_rest[i] = &mass.inverse_inertia.xz;
      turned[i] = &inertia.inverse.xx;
    }
    Wide<kLanes> q[4], in[8];
    Rows<kLanes>::gather(turns, 0, q);
    Rows<kLanes>::gather(own, 0, in);
    Rows<kLanes>::gather(own_rest, 0, in + 4);
    const Sym3W<kLanes> inverse = rotate_inertia(to_matrix(QuatW<kLanes>{q[0], q[1], q[2], q[3]}),
                                                 Sym3W<kLanes>{in[0], in[1], in[2], in[3], in[4], in[5]});
    const Wide<kLanes> out[6] = {inverse.xx, inverse.yy, inverse.zz, inverse.xy, inverse.xz, inverse.yz};
    Rows<kLanes>::scatter<4>(turned, 0, out);
    Rows<kLanes>::scatter<2>(turned, 4, out + 4);
    count_ = 0;
  }

  BodyStore& bodies_;
  std::uint32_t waiting_[kLanes];
  int count_ = 0;
};

// Turns by rotation vectors wait for others, to be made side by side.
class SteadyTurns {
 public:
  SteadyTurns(BodyStore& bodies, const RotationKernels& kernels) : bodies_(bodies), kernels_(kernels) {}

  // From an orientation, which need not be the present one.
  void add(std::uint32_t body, Quat from, Vec3 turn) {
    turns_[count_] = {from, turn};
    waiting_[count_++] = body;
  }
  bool is_full() const { return count_ == kMaxTurns; }
  // Calls then(body) for each that is turned.
  template <class Then>
  void finish(Then&& then) {
    kernels_.rotate_at_constant_velocity(turns_, count_);
    for (int i = 0; i < count_; ++i) {
      bodies_.orientations[waiting_[i]] = turns_[i].orientation;
      then(waiting_[i]);
    }
    count_ = 0;
  }

 private:
  BodyStore& bodies_;
  const RotationKernels& kernels_;
  ConstantRotation turns_[kMaxTurns];
  std::uint32_t waiting_[kMaxTurns];
  int count_ = 0;
};

// Turns bodies with the velocities that they have: they wait for others, to be turned side by side.
class BodyTurns {
 public:
  BodyTurns(BodyStore& bodies, const RotationKernels& kernels, float seconds)
      : bodies_(bodies), kernels_(kernels), seconds_(seconds), steady_(bodies, kernels) {}

  void add(std::uint32_t i) {
    const BodyFlags& flags = bodies_.flags[i];
    const BodyMass& mass = bodies_.masses[i];
    if (flags.type == BodyType::kinematic || mass.isotropic != 0 || flags.locked_angular != 0)
      return add_steady(i, flags.locked_angular);
    free_[count_] = i;
    turns_[count_++] = {&bodies_.motion[i], &bodies_.orientations[i], &mass.inertia};
    if (count_ == kMaxTurns) rotate_torque_free();
  }
  void finish() {
    rotate_torque_free();
    rotate_at_constant_velocity();
  }

 private:
  void add_steady(std::uint32_t i, std::uint8_t locked) {
    BodyMotion& motion = bodies_.motion[i];
    if (locked != 0) motion.angular_velocity = without_locked(motion.angular_velocity, locked);
    const Vec3 turn = seconds_ * motion.angular_velocity;
    motion.angular_velocity += Vec3{};
    if (turn == Vec3{}) {
      motion.turned += Vec3{};
      if (locked != 0 && locked != 7) refresh_world_inertia(bodies_, i);
      return;
    }
    motion.turned += turn;
    steady_.add(i, bodies_.orientations[i], turn);
    if (steady_.is_full()) rotate_at_constant_velocity();
  }
  void rotate_at_constant_velocity() {
    steady_.finish([&](std::uint32_t i) {
      const std::uint8_t locked = bodies_.flags[i].locked_angular;
      if (locked != 0 && locked != 7) refresh_world_inertia(bodies_, i);
    });
  }
  void rotate_torque_free() {
    if (count_ == 0) return;
    kernels_.rotate_torque_free(turns_, count_, seconds_);
    InertiaRefresh refresh(bodies_);
    for (int i = 0; i < count_; ++i) refresh.add(free_[i]);
    refresh.finish();
    count_ = 0;
  }

  BodyStore& bodies_;
  const RotationKernels& kernels_;
  float seconds_;
  SteadyTurns steady_;
  std::uint32_t free_[kMaxTurns];
  TorqueFreeRotation turns_[kMaxTurns];
  int count_ = 0;
};

// Velocity by the forces of a sub-step.
void kick(BodyStore& bodies, std::uint32_t i, const Motions& motions) {
  const BodyFlags& flags = bodies.flags[i];
  const BodyForces& forces = bodies.forces[i];
  const BodyInertia& inertia = bodies.inertia[i];
  BodyMotion& motion = bodies.motion[i];
  const Damping linear(forces.linear_damping, motions.substep),
      angular(forces.angular_damping, motions.substep);
  const Vec3 geometric_stiffness =
      forces.gravity_scale * motions.gravity + inertia.inverse_mass * forces.force;
  const Vec3 v =
      motion.linear_velocity + (linear.gain * geometric_stiffness - linear.lost * motion.linear_velocity);
  const Vec3 w = motion.angular_velocity +
                 (angular.gain * (inertia.inverse * forces.torque) - angular.lost * motion.angular_velocity);
  // Adding zero keeps -0 out of the state, so that wide kernels may add zeros to lanes that nothing touches.
  motion.linear_velocity = within_length(without_locked(v, flags.locked_linear), kMaxSpeed) + Vec3{};
  motion.angular_velocity = within_length(without_locked(w, flags.locked_angular), kMaxSpin) + Vec3{};
}

// The kicks and moves of all parts of a step for a body without torques: what each part has in common is worked out once, and
// the spin, which no part changes, is only kept within bounds.
void kick_and_move(BodyStore& bodies, std::uint32_t i, const Motions& motions) {
  const BodyFlags& flags = bodies.flags[i];
  const BodyForces& forces = bodies.forces[i];
  BodyMotion& motion = bodies.motion[i];
  const Damping damping(forces.linear_damping, motions.substep);
  const Vec3 kick =
      damping.gain * (forces.gravity_scale * motions.gravity + bodies.inertia[i].inverse_mass * forces.force);
  Vec3 v = motion.linear_velocity, moved = motion.moved;
  // Neither a lock nor the bound on speed is met in any part: nor is -0, once v has none.
  const float fastest = largest(absolute(v)) + float(motions.count) * largest(absolute(kick));
  if (flags.locked_linear == 0 && fastest <= 0.25f * kMaxSpeed) {
    v += Vec3{};
    for (int part = 0; part < motions.count; ++part) {
      v = v + (kick - damping.lost * v);
      moved += motions.substep * v;
    }
  } else {
    for (int part = 0; part < motions.count; ++part) {
      v = v + (kick - damping.lost * v);
      v = within_length(without_locked(v, flags.locked_linear), kMaxSpeed) + Vec3{};
      moved += motions.substep * v;
    }
  }
  motion.linear_velocity = v;
  motion.moved = moved;
  const bool is_bounded = largest(absolute(motion.angular_velocity)) <= 0.5f * kMaxSpin;
  for (int part = 0; part < (is_bounded ? 1 : motions.count); ++part) {
    motion.angular_velocity =
        within_length(without_locked(motion.angular_velocity, flags.locked_angular), kMaxSpin) + Vec3{};
  }
}

// `turns`: over the whole step.
void integrate_free_body(BodyStore& bodies, std::uint32_t i, const Motions& motions,
                         const RotationKernels& kernels, BodyTurns& turns) {
  const BodyFlags& flags = bodies.flags[i];
  const BodyForces& forces = bodies.forces[i];
  BodyMotion& motion = bodies.motion[i];
  const bool is_kicked = flags.type == BodyType::dynamic;
  // Without torques the momentum is the same in every sub-step: one rotation instead of many.
  const bool turns_freely = !is_kicked || (forces.torque == Vec3{} && forces.angular_damping == 0.0f);
  if (is_kicked && turns_freely) {
    kick_and_move(bodies, i, motions);
    return turns.add(i);
  }
  BodyTurns parts(bodies, kernels, motions.substep);
  for (int part = 0; part < motions.count; ++part) {
    if (is_kicked) kick(bodies, i, motions);
    motion.linear_velocity = without_locked(motion.linear_velocity, flags.locked_linear);
    motion.moved += motions.substep * motion.linear_velocity;
    if (turns_freely) continue;
    parts.add(i);
    parts.finish();  // the next kick reads it
  }
  if (turns_freely) turns.add(i);
}

}  // namespace

MovedBody describe_motion(const BodyStore& bodies, std::uint32_t body, const Motions& motions, bool shown) {
  const BodyFlags& flags = bodies.flags[body];
  const BodyForces& forces = bodies.forces[body];
  const BodyMass& mass = bodies.masses[body];
  MovedBody moved;
  moved.body = std::int32_t(body);
  moved.orientation = bodies.orientations[body];
  moved.needs_exact_rotation = needs_exact_rotation(bodies, body, motions.substep);
  moved.shown = shown;
  if (flags.type != BodyType::dynamic) return moved;
  const Damping linear(forces.linear_damping, motions.substep),
      angular(forces.angular_damping, motions.substep);
  moved.kick = linear.gain *
               (forces.gravity_scale * motions.gravity + bodies.inertia[body].inverse_mass * forces.force);
  moved.linear_lost = linear.lost;
  moved.torque = angular.gain * forces.torque;
  moved.angular_lost = angular.lost;
  moved.reach = mass.bounding_radius;
  moved.inertia = mass.inertia;
  moved.inverse_inertia = mass.inverse_inertia;
  moved.locked = flags.locked_linear;
  moved.isotropic = mass.isotropic != 0;
  return moved;
}

void integrate_free_bodies(BodyStore& bodies, std::span<const std::uint32_t> list, const Motions& motions,
                           const RotationKernels& kernels) {
  BodyTurns turns(bodies, kernels, float(motions.count) * motions.substep);
  for (const std::uint32_t i : list) integrate_free_body(bodies, i, motions, kernels, turns);
  turns.finish();
}

void rotate_exactly(BodyStore& bodies, std::span<const std::uint32_t> list, float substep,
                    const RotationKernels& kernels) {
  BodyTurns turns(bodies, kernels, substep);
  for (const std::uint32_t i : list) turns.add(i);
  turns.finish();
}

void apply_rotations(BodyStore& bodies, std::span<const MovedBody> moved, std::span<const Vec3> pushes,
                     const RotationKernels& kernels) {
  InertiaRefresh refresh(bodies);
  SteadyTurns turns(bodies, kernels);
  const auto turn_all = [&] { turns.finish([&](std::uint32_t i) { refresh.add(i); }); };
  for (std::size_t n = 0; n < moved.size(); ++n) {
    if (moved[n].body == kNoBody) continue;
    const std::uint32_t i = std::uint32_t(moved[n].body);
    if (bodies.flags[i].type != BodyType::dynamic) continue;
    BodyMotion& motion = bodies.motion[i];
    Quat& orientation = bodies.orientations[i];
    if (moved[n].needs_exact_rotation) {
      const Vec3 turn = without_locked(pushes[n], bodies.flags[i].locked_angular);
      if (turn == Vec3{}) continue;
      motion.turned += turn;
      turns.add(i, orientation, turn);
    } else if (motion.turned != Vec3{}) {
      turns.add(i, moved[n].orientation, motion.turned);
    } else if (moved[n].shown) {
      orientation = moved[n].orientation;
      refresh.add(i);
    }  // who was not shown has the orientation and inertia that it had
    if (turns.is_full()) turn_all();
  }
  turn_all();
  refresh.finish();
}

}  // namespace gyre
