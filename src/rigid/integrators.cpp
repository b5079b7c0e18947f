#include "rigid/integrators.h"

#include "math/trig.h"
#include "rigid/free_rotation.h"

namespace gyre {

namespace {

Vec3 clamp_length(Vec3 v, float most) {
  const float top = largest(absolute(v));
  if (!(top > most * 0.5f)) return v;
  const float size = top * length(v / top);  // no overflow
  return size > most ? (most / size) * v : v;
}

// The exact step of dv/dt = a - c v.
Vec3 damped(Vec3 v, Vec3 acceleration, float damping, float h) {
  if (!(damping > 0.0f)) return v + h * acceleration;
  // As a change of v: e itself, so near 1, would round the same way in every sub-step.
  const double lost = 1.0 - exp(-double(damping) * double(h));
  return v + (float(lost / double(damping)) * acceleration - float(lost) * v);
}

}  // namespace

void predict(BodyStore& bodies, std::span<const std::uint32_t> list, float h, Vec3 gravity) {
  for (const std::uint32_t i : list) {
    const BodyFlags& flags = bodies.flags[i];
    if (flags.type != BodyType::dynamic) continue;
    BodyMotion& motion = bodies.motion[i];
    const BodyForces& forces = bodies.forces[i];
    const BodyInertia& inertia = bodies.inertia[i];
    const Vec3 pull = forces.gravity_scale * gravity + inertia.inverse_mass * forces.force;
    Vec3 v = damped(motion.linear_velocity, pull, forces.linear_damping, h);
    Vec3 w = damped(motion.angular_velocity, inertia.inverse * forces.torque, forces.angular_damping, h);
    if ((flags.locked_linear | flags.locked_angular) != 0) {
      v = without_locked(v, flags.locked_linear);
      w = without_locked(w, flags.locked_angular);
    }
    // Adding zero keeps -0 out of the state, so that wide kernels may add zeros to lanes that nothing touches.
    motion.linear_velocity = clamp_length(v, kMaxSpeed) + Vec3{};
    motion.angular_velocity = clamp_length(w, kMaxSpin) + Vec3{};
  }
}

void advance(BodyStore& bodies, std::span<const std::uint32_t> list, float h) {
  for (const std::uint32_t i : list) {
    const BodyFlags& flags = bodies.flags[i];
    BodyMotion& motion = bodies.motion[i];
    if ((flags.locked_linear | flags.locked_angular) != 0) {
      motion.linear_velocity = without_locked(motion.linear_velocity, flags.locked_linear);
      motion.angular_velocity = without_locked(motion.angular_velocity, flags.locked_angular);
    }
    motion.moved += h * motion.linear_velocity;
    const BodyMass& mass = bodies.masses[i];
    Quat& orientation = bodies.orientations[i];
    if (flags.type == BodyType::kinematic || mass.isotropic != 0 || flags.locked_angular != 0) {
      motion.turned += rotate_steadily(orientation, motion.angular_velocity, h);
      if (flags.locked_angular != 0 && flags.locked_angular != 7) {
        bodies.inertia[i] = world_inertia(mass, flags, orientation);
      }
    } else {
      motion.turned += rotate_freely(orientation, motion.angular_velocity, mass.inertia, h);
      bodies.inertia[i] = world_inertia(mass, flags, orientation);
    }
    motion.angular_velocity += Vec3{};
  }
}

}  // namespace gyre
