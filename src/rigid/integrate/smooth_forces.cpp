#include "rigid/integrate/smooth_forces.h"

#include "rigid/field/fields.h"

namespace gyre {

namespace {

struct EndMotion {
  DVec3 point, velocity, lever;
};

EndMotion motion_of(const SmoothSystem& system, const SpringEnd& end, std::span<const SmoothState> states,
                    double ahead) {
  if (end.index < 0) return {end.point + ahead * end.velocity, end.velocity, {}};
  const SmoothState& s = states[std::size_t(end.index)];
  const DVec3 lever = rotate(s.q, end.arm);
  return {s.x + lever, s.v + cross(spin_of(system.bodies[std::size_t(end.index)], s), lever), lever};
}

// Projects torques of bodies with locked axes to the free ones, as angular accelerations.
DVec3 on_free_axes(const SmoothBody& body, const SmoothState& s, DVec3 torque) {
  if (body.locked_angular == 0) return torque;
  const Quat q = to_float(s.q);
  BodyFlags flags;
  flags.type = BodyType::dynamic;
  flags.locked_angular = body.locked_angular;
  BodyMass mass;
  mass.inertia = {float(body.inertia.xx), float(body.inertia.yy), float(body.inertia.zz),
                  float(body.inertia.xy), float(body.inertia.xz), float(body.inertia.yz)};
  mass.inverse_mass = float(1.0 / body.mass);
  return times(to_double(world_inertia(mass, flags, q).inverse), torque);
}

}  // namespace

DVec3 without_axes(DVec3 v, std::uint8_t locked) {
  if (locked & 1) v.x = 0.0;
  if (locked & 2) v.y = 0.0;
  if (locked & 4) v.z = 0.0;
  return v;
}

DVec3 spin_of(const SmoothBody& body, const SmoothState& s) {
  if (body.locked_angular != 0) return s.l;
  return rotate(s.q, times(body.inverse_inertia, rotate_inverse(s.q, s.l)));
}

DVec3 momentum_of(const SmoothBody& body, const SmoothState& s, DVec3 spin) {
  if (body.locked_angular != 0) return without_axes(spin, body.locked_angular);
  return rotate(s.q, times(body.inertia, rotate_inverse(s.q, spin)));
}

SpringForce spring_force(const SmoothSpring& spring, DVec3 a, DVec3 b, DVec3 velocity_a, DVec3 velocity_b) {
  const DVec3 offset = b - a;
  const double size = length(offset);
  if (!(size > 0.0)) return {{}, size};
  const DVec3 along = offset / size;
  const double speed = dot(velocity_b - velocity_a, along);
  return {(-(spring.stiffness * (size - spring.rest) + spring.damping * speed)) * along, size};
}

void find_rates(const SmoothSystem& system, std::span<const SmoothState> states, double time, double weight,
                bool damping, std::span<Rates> rates) {
  const RigidWorld& w = *system.world;
  for (std::size_t i = 0; i < states.size(); ++i) {
    const SmoothBody& body = system.bodies[i];
    const SmoothState& s = states[i];
    rates[i] = {body.acceleration, body.torque};
    if (body.fields.empty()) continue;
    const BodyState stance{s.x, s.q, s.v, spin_of(body, s)};
    const Vec6 force = force_of_fields(w, body.body, body.fields, stance, system.begin + time);
    rates[i].acceleration += force.linear() / body.mass;
    rates[i].torque += force.angular();
  }
  for (SmoothSpring& spring : system.springs) {
    const double ahead = time - system.substep_begin;
    const EndMotion a = motion_of(system, spring.a, states, ahead),
                    b = motion_of(system, spring.b, states, ahead);
    const SpringForce on_b = spring_force(spring, a.point, b.point, a.velocity, b.velocity);
    spring.impulse += weight * on_b.force;
    spring.length = on_b.length;
    if (spring.a.index >= 0) {
      Rates& r = rates[std::size_t(spring.a.index)];
      r.acceleration += (-1.0 / system.bodies[std::size_t(spring.a.index)].mass) * on_b.force;
      r.torque += cross(on_b.force, a.lever);
    }
    if (spring.b.index >= 0) {
      Rates& r = rates[std::size_t(spring.b.index)];
      r.acceleration += (1.0 / system.bodies[std::size_t(spring.b.index)].mass) * on_b.force;
      r.torque += cross(b.lever, on_b.force);
    }
  }
  for (std::size_t i = 0; i < states.size(); ++i) {
    const SmoothBody& body = system.bodies[i];
    rates[i].torque = on_free_axes(body, states[i], rates[i].torque);
    if (damping) {
      rates[i].acceleration += (-body.linear_damping) * states[i].v;
      rates[i].torque += (-body.angular_damping) * states[i].l;
    }
    rates[i].acceleration = without_axes(rates[i].acceleration, body.locked_linear);
  }
}

}  // namespace gyre
