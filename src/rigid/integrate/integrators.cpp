#include "rigid/integrate/integrators.h"

#include "math/rotation.h"
#include "math/trig.h"
#include "math/wide_vec.h"
#include "solver/motion/torque_free_rotation.h"

#include <cstddef>

namespace gyre {

namespace {

Vec3 shortened(Vec3 v, float top, float max_length) {
  // In units of the largest component: the length itself may be beyond all floats.
  const float size = length(v / top), limit = max_length / top;
  return size > limit ? (limit / size) * v : v;
}
Vec3 clamp_without_overflow(Vec3 v, float max_length) {
  const float top = largest(absolute(v));
  return top > max_length * 0.5f ? shortened(v, top, max_length) : v;
}

// The vector without its components along locked world axes (bits 1, 2, 4: x, y, z).
Vec3 without_locked(Vec3 v, std::uint8_t locked) {
  if (locked & 1) v.x = 0.0f;
  if (locked & 2) v.y = 0.0f;
  if (locked & 4) v.z = 0.0f;
  return v;
}

// The exact step of dv/dt = a - damping v is v += gain a - loss v.
struct Damping {
  float gain, loss;

  Damping(float damping, float h) : gain(h), loss(0.0f) {
    if (!(damping > 0.0f)) return;
    // As a change of v: the factor itself, so near 1, would round in the same direction in every sub-step.
    const double share = 1.0 - exp(-double(damping) * double(h));
    gain = float(share / double(damping));
    loss = float(share);
  }
};

// The world inertia of a body at its present orientation.
void refresh_world_inertia(BodyStore& bodies, std::uint32_t i) {
  const BodyMass& mass = bodies.masses[i];
  const BodyFlags& flags = bodies.flags[i];
  if (!inertia_rotates(mass, flags)) return;
  bodies.inertia[i] = world_inertia(mass, flags, bodies.orientations[i]);
}

// The world inertia of bodies at their present orientation, four at once where it is simply the rotated body
// inertia.
class InertiaRefresh {
 public:
  explicit InertiaRefresh(BodyStore& bodies) : bodies_(bodies) {}

  void add(std::uint32_t body) {
    const BodyFlags& flags = bodies_.flags[body];
    if (!is_movable(flags) || flags.locked_angular != 0 || bodies_.masses[body].isotropic != 0)
      return refresh_world_inertia(bodies_, body);
    queue_[count_++] = body;
    if (count_ == kLanes) flush();
  }
  void finish() {
    for (int i = 0; i < count_; ++i) refresh_world_inertia(bodies_, queue_[i]);
    count_ = 0;
  }

 private:
  static constexpr int kLanes = 4;
  static_assert(offsetof(Sym3, xz) == 4 * sizeof(float) && offsetof(BodyInertia, inverse) == 0);

  void flush() {
    const float *orientations[kLanes], *own[kLanes], *own_rest[kLanes];
    float* rotated[kLanes];
    for (int i = 0; i < kLanes; ++i) {
      const BodyMass& mass = bodies_.masses[queue_[i]];
      BodyInertia& inertia = bodies_.inertia[queue_[i]];
      inertia.inverse_mass = bodies_.flags[queue_[i]].locked_linear == 7 ? 0.0f : mass.inverse_mass;
      orientations[i] = &bodies_.orientations[queue_[i]].x;
      own[i] = &mass.inverse_inertia.xx;
      own_rest[i] = &mass.inverse_inertia.xz;
      rotated[i] = &inertia.inverse.xx;
    }
    Wide<kLanes> q[4], in[8];
    Rows<kLanes>::gather(orientations, 0, q);
    Rows<kLanes>::gather(own, 0, in);
    Rows<kLanes>::gather(own_rest, 0, in + 4);
    const Sym3W<kLanes> inverse = rotate_inertia(to_matrix(QuatW<kLanes>{q[0], q[1], q[2], q[3]}),
                                                 Sym3W<kLanes>{in[0], in[1], in[2], in[3], in[4], in[5]});
    const Wide<kLanes> out[6] = {inverse.xx, inverse.yy, inverse.zz, inverse.xy, inverse.xz, inverse.yz};
    Rows<kLanes>::scatter<4>(rotated, 0, out);
    Rows<kLanes>::scatter<2>(rotated, 4, out + 4);
    count_ = 0;
  }

  BodyStore& bodies_;
  std::uint32_t queue_[kLanes];
  int count_ = 0;
};

// Collects rotations by rotation vectors, to compute them side by side.
class ConstantRotations {
 public:
  ConstantRotations(BodyStore& bodies, const RotationKernels& kernels) : bodies_(bodies), kernels_(kernels) {}

  // From an orientation, which need not be the present one.
  void add(std::uint32_t body, Quat from, Vec3 rotation) {
    rotations_[count_] = {from, rotation};
    queue_[count_++] = body;
  }
  bool is_full() const { return count_ == kMaxRotations; }
  // Calls then(body) for each rotated body.
  template <class Then>
  void finish(Then&& then) {
    kernels_.rotate_at_constant_velocity(rotations_, count_);
    for (int i = 0; i < count_; ++i) {
      bodies_.orientations[queue_[i]] = rotations_[i].orientation;
      then(queue_[i]);
    }
    count_ = 0;
  }

 private:
  BodyStore& bodies_;
  const RotationKernels& kernels_;
  ConstantRotation rotations_[kMaxRotations];
  std::uint32_t queue_[kMaxRotations];
  int count_ = 0;
};

// Rotates bodies by their velocities; collects them, to compute them side by side.
class BodyRotations {
 public:
  BodyRotations(BodyStore& bodies, const RotationKernels& kernels, float seconds)
      : bodies_(bodies), kernels_(kernels), seconds_(seconds), steady_(bodies, kernels) {}

  void add(std::uint32_t i) {
    const BodyFlags& flags = bodies_.flags[i];
    const BodyMass& mass = bodies_.masses[i];
    if (flags.type == BodyType::kinematic || mass.isotropic != 0 || flags.locked_angular != 0)
      return add_steady(i, flags.locked_angular);
    free_[count_] = i;
    rotations_[count_++] = {&bodies_.motion[i], &bodies_.orientations[i], &mass.inertia};
    if (count_ == kMaxRotations) rotate_torque_free();
  }
  void finish() {
    rotate_torque_free();
    rotate_at_constant_velocity();
  }

 private:
  void add_steady(std::uint32_t i, std::uint8_t locked) {
    BodyMotion& motion = bodies_.motion[i];
    if (locked != 0) motion.angular_velocity = without_locked(motion.angular_velocity, locked);
    const Vec3 rotation = seconds_ * motion.angular_velocity;
    motion.angular_velocity += Vec3{};
    if (rotation == Vec3{}) {
      motion.delta_rotation += Vec3{};
      if (locked != 0 && locked != 7) refresh_world_inertia(bodies_, i);
      return;
    }
    motion.delta_rotation += rotation;
    steady_.add(i, bodies_.orientations[i], rotation);
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
    kernels_.rotate_torque_free(rotations_, count_, seconds_);
    InertiaRefresh refresh(bodies_);
    for (int i = 0; i < count_; ++i) refresh.add(free_[i]);
    refresh.finish();
    count_ = 0;
  }

  BodyStore& bodies_;
  const RotationKernels& kernels_;
  float seconds_;
  ConstantRotations steady_;
  std::uint32_t free_[kMaxRotations];
  TorqueFreeRotation rotations_[kMaxRotations];
  int count_ = 0;
};

// Up to this many half-steps the scheme's own error is above the rounding of all their sums. With more, what rounding loses of a velocity
// in one half-step goes into the next (W. Kahan, "Further remarks on reducing truncation errors", 1965).
constexpr int kMaxRounded = 8;
bool carries_rounding(const Motions& motions) { return motions.count > kMaxRounded; }
// `lost`: by rounding so far; null where that is not carried.
Vec3 add_gain(Vec3 v, Vec3 gain, Vec3* lost) {
  if (lost == nullptr) return v + gain;
  gain += *lost;
  const Vec3 sum = v + gain;
  *lost = gain - (sum - v);
  return sum;
}

// Integrates the velocity over a sub-step by forces.
void integrate_velocity(BodyStore& bodies, std::uint32_t i, const Motions& motions, Vec3* lost) {
  const BodyFlags& flags = bodies.flags[i];
  const BodyForces& forces = bodies.forces[i];
  const BodyInertia& inertia = bodies.inertia[i];
  BodyMotion& motion = bodies.motion[i];
  const Damping linear(forces.linear_damping, motions.substep),
      angular(forces.angular_damping, motions.substep);
  const Vec3 acceleration = forces.gravity_scale * motions.gravity + inertia.inverse_mass * forces.force;
  const Vec3 v = add_gain(motion.linear_velocity,
                          linear.gain * acceleration - linear.loss * motion.linear_velocity, lost);
  const Vec3 w = motion.angular_velocity +
                 (angular.gain * (inertia.inverse * forces.torque) - angular.loss * motion.angular_velocity);
  // Adding zero keeps -0 out of the state, so wide kernels may add zeros to lanes that nothing acts on.
  motion.linear_velocity = clamp_without_overflow(without_locked(v, flags.locked_linear), kMaxSpeed) + Vec3{};
  motion.angular_velocity =
      clamp_without_overflow(without_locked(w, flags.locked_angular), kMaxSpin) + Vec3{};
}

// All sub-steps of the translation of a body without torques: constants are computed once, and the constant
// spin is only clamped.
void integrate_translation(BodyStore& bodies, std::uint32_t i, const Motions& motions) {
  const BodyFlags& flags = bodies.flags[i];
  const BodyForces& forces = bodies.forces[i];
  BodyMotion& motion = bodies.motion[i];
  const Damping damping(forces.linear_damping, motions.substep);
  const Vec3 gain =
      damping.gain * (forces.gravity_scale * motions.gravity + bodies.inertia[i].inverse_mass * forces.force);
  Vec3 v = motion.linear_velocity, delta_position = motion.delta_position;
  // No sub-step meets a lock or the bound on speed, or produces -0, once v has none.
  const float fastest = largest(absolute(v)) + float(motions.count) * largest(absolute(gain));
  Vec3 rounding;
  Vec3* const lost = carries_rounding(motions) ? &rounding : nullptr;
  if (flags.locked_linear == 0 && fastest <= 0.25f * kMaxSpeed) {
    v += Vec3{};
    for (int substep = 0; substep < motions.count; ++substep) {
      v = add_gain(v, gain - damping.loss * v, lost);
      delta_position += motions.substep * v;
    }
  } else {
    for (int substep = 0; substep < motions.count; ++substep) {
      v = add_gain(v, gain - damping.loss * v, lost);
      v = clamp_without_overflow(without_locked(v, flags.locked_linear), kMaxSpeed) + Vec3{};
      delta_position += motions.substep * v;
    }
  }
  motion.linear_velocity = v;
  motion.delta_position = delta_position;
  const bool is_bounded = largest(absolute(motion.angular_velocity)) <= 0.5f * kMaxSpin;
  for (int substep = 0; substep < (is_bounded ? 1 : motions.count); ++substep) {
    motion.angular_velocity =
        clamp_without_overflow(without_locked(motion.angular_velocity, flags.locked_angular), kMaxSpin) +
        Vec3{};
  }
}

// `rotations`: over the whole step.
void integrate_free_body(BodyStore& bodies, std::uint32_t i, const Motions& motions,
                         const RotationKernels& kernels, BodyRotations& rotations) {
  const BodyFlags& flags = bodies.flags[i];
  const BodyForces& forces = bodies.forces[i];
  BodyMotion& motion = bodies.motion[i];
  const bool has_forces = flags.type == BodyType::dynamic;
  // Without torques the momentum is constant: one rotation instead of one a sub-step.
  const bool is_torque_free = !has_forces || (forces.torque == Vec3{} && forces.angular_damping == 0.0f);
  if (has_forces && is_torque_free) {
    integrate_translation(bodies, i, motions);
    return rotations.add(i);
  }
  BodyRotations per_substep(bodies, kernels, motions.substep);
  Vec3 lost;
  for (int substep = 0; substep < motions.count; ++substep) {
    if (has_forces) integrate_velocity(bodies, i, motions, carries_rounding(motions) ? &lost : nullptr);
    motion.linear_velocity = without_locked(motion.linear_velocity, flags.locked_linear);
    motion.delta_position += motions.substep * motion.linear_velocity;
    if (is_torque_free) continue;
    per_substep.add(i);
    per_substep.finish();  // the next sub-step reads it
  }
  if (is_torque_free) rotations.add(i);
}

}  // namespace

MovedBody describe_motion(const BodyStore& bodies, std::uint32_t body, const Motions& motions,
                          bool pose_read) {
  const BodyFlags& flags = bodies.flags[body];
  const BodyForces& forces = bodies.forces[body];
  const BodyMass& mass = bodies.masses[body];
  MovedBody moved;
  moved.body = std::int32_t(body);
  moved.orientation = bodies.orientations[body];
  moved.needs_exact_rotation = needs_exact_rotation(bodies, body, motions.substep);
  moved.pose_read = pose_read;
  if (flags.type != BodyType::dynamic) return moved;
  const Damping linear(forces.linear_damping, motions.substep),
      angular(forces.angular_damping, motions.substep);
  moved.velocity_gain = linear.gain * (forces.gravity_scale * motions.gravity +
                                       bodies.inertia[body].inverse_mass * forces.force);
  moved.linear_loss = linear.loss;
  moved.torque = angular.gain * forces.torque;
  moved.angular_loss = angular.loss;
  moved.bounding_radius = mass.bounding_radius;
  moved.inertia = mass.inertia;
  moved.inverse_inertia = mass.inverse_inertia;
  moved.locked = flags.locked_linear;
  moved.carries_rounding = carries_rounding(motions);
  moved.isotropic = mass.isotropic != 0;
  return moved;
}

void integrate_free_bodies(BodyStore& bodies, std::span<const std::uint32_t> list, const Motions& motions,
                           const RotationKernels& kernels) {
  BodyRotations rotations(bodies, kernels, float(motions.count) * motions.substep);
  for (const std::uint32_t i : list) integrate_free_body(bodies, i, motions, kernels, rotations);
  rotations.finish();
}

void rotate_exactly(BodyStore& bodies, std::span<const std::uint32_t> list, float substep,
                    const RotationKernels& kernels) {
  BodyRotations rotations(bodies, kernels, substep);
  for (const std::uint32_t i : list) rotations.add(i);
  rotations.finish();
}

void apply_rotations(BodyStore& bodies, std::span<const MovedBody> moved, std::span<const Vec3> pushes,
                     const RotationKernels& kernels) {
  InertiaRefresh refresh(bodies);
  ConstantRotations rotations(bodies, kernels);
  const auto flush = [&] { rotations.finish([&](std::uint32_t i) { refresh.add(i); }); };
  for (std::size_t n = 0; n < moved.size(); ++n) {
    if (moved[n].body == kNoBody) continue;
    const std::uint32_t i = std::uint32_t(moved[n].body);
    if (bodies.flags[i].type != BodyType::dynamic) continue;
    BodyMotion& motion = bodies.motion[i];
    Quat& orientation = bodies.orientations[i];
    if (moved[n].needs_exact_rotation) {
      const Vec3 rotation = without_locked(pushes[n], bodies.flags[i].locked_angular);
      if (rotation == Vec3{}) continue;
      motion.delta_rotation += rotation;
      rotations.add(i, orientation, rotation);
    } else if (motion.delta_rotation != Vec3{}) {
      rotations.add(i, moved[n].orientation, motion.delta_rotation);
    } else if (moved[n].pose_read) {
      orientation = moved[n].orientation;
      refresh.add(i);
    }  // a body whose pose is not read has the orientation and inertia that it had
    if (rotations.is_full()) flush();
  }
  flush();
  refresh.finish();
}

}  // namespace gyre
