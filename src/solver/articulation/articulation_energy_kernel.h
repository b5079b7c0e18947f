// Limits the kinetic energy that passive joints of a bundle add (solver/articulation/articulation_lanes.h).
// Where links rotate far within a sub-step, the equations with second-order bias can do work, and each
// sub-step repeats it: small nets of light knots that whipped gained fifty times the energy of their fall,
// thousands of times with more bias. So the energy added in a sub-step, beyond forces and contacts, is
// removed at its end, and gain beyond the existing energy at once, by scaling all inner motion. Velocities
// between two that satisfy the rows satisfy them too, and a free articulation keeps its momentum and angular
// momentum. docs/decisions/articulations.md has the figures.
#pragma once

#include "solver/articulation/articulation_block.h"

namespace gyre {
inline namespace GYRE_TARGET_NAMESPACE {

// Positions of the centres relative to the first body.
template <int W>
GYRE_INLINE void compute_centers(const WideBundle<W>& bundle) {
  const Wide<W> zero(0.0f);
  bundle.bodies[0].center = {zero, zero, zero};
  for (std::uint32_t i = 0; i + 1 < bundle.plain.body_count; ++i) {
    const TraversalStep& step = bundle.plain.traversal[i];
    const LaneNode& node = bundle.plain.nodes[step.node];
    const WideJoint<W>& joint = bundle.joints[step.node];
    const Vec3W<W> offset = joint.from_a + joint.error - joint.from_b;
    if (step.to_b)
      bundle.bodies[node.b].center = bundle.bodies[node.a].center + offset;
    else
      bundle.bodies[node.a].center = bundle.bodies[node.b].center - offset;
  }
}

// The motion of the carrier of an articulation as that of all its bodies, if it has a single carrier that
// moves.
template <int W>
struct CarrierMotion {
  bool moves = false;  // in any lane
  Vec3W<W> center, linear, angular;
  Vec3W<W> at(const WideBody<W>& body) const { return linear + cross(angular, body.center - center); }
};
template <int W>
bool has_one_carrier(const WideBundle<W>& bundle) {
  return bundle.plain.moving_count + 1 == bundle.plain.body_count;
}
template <int W>
__attribute__((noinline)) CarrierMotion<W> carrier_motion_of(const WideBundle<W>& bundle) {
  const Wide<W> zero(0.0f);
  const Vec3W<W> none{zero, zero, zero};
  CarrierMotion<W> carrier{false, none, none, none};
  if (!has_one_carrier(bundle)) return carrier;
  const WideBody<W>& carrier_body = bundle.bodies[bundle.plain.moving_count];
  carrier.moves = any(max(length_squared(carrier_body.linear), length_squared(carrier_body.angular)) > zero);
  if (!carrier.moves) return carrier;
  carrier.linear = carrier_body.linear, carrier.angular = carrier_body.angular;
  compute_centers(bundle);
  carrier.center = carrier_body.center;
  return carrier;
}

// J, of the movable bodies, relative to the carrier. (Not inlined, like the next ones: rarely called, from
// many places.)
template <int W>
__attribute__((noinline)) Wide<W> kinetic_energy(const WideBundle<W>& bundle,
                                                 const CarrierMotion<W>& carrier) {
  Wide<W> twice(0.0f);
  for (std::uint32_t i = 0; i < bundle.plain.moving_count; ++i) {
    const WideBody<W>& body = bundle.bodies[i];
    Vec3W<W> linear = body.linear, angular = body.angular;
    if (carrier.moves) linear = linear - carrier.at(body), angular = angular - carrier.angular;
    twice += keep(body.inverse_mass > 0.0f, length_squared(linear) / body.inverse_mass);
    twice += dot(angular, body.inertia * angular);
  }
  return 0.5f * twice;
}

// Lanes whose joints should do no work: their bodies rotate about all axes, and they are free or have a
// static or single carrier.
template <int W>
__attribute__((noinline)) Mask<W> find_passive_lanes(const WideBundle<W>& bundle) {
  Mask<W> passive = Mask<W>::splat(!bundle.plain.has_drives);
  for (std::uint32_t i = 0; i < bundle.plain.body_count; ++i) {
    const WideBody<W>& body = bundle.bodies[i];
    const Wide<W> zero(0.0f);
    if (bundle.moves(i))
      passive = passive & (body.inertia.xx > zero);
    else if (!has_one_carrier(bundle))
      passive = passive & (max(length_squared(body.linear), length_squared(body.angular)) <= zero);
  }
  return passive;
}

// The motion of an articulation as one rigid body with its momenta; of a carried one, that of its carrier.
template <int W>
struct RigidMotion {
  Vec3W<W> center, linear, angular;
  Wide<W> energy;
};

template <int W>
GYRE_INLINE RigidMotion<W> rigid_motion(const WideBundle<W>& bundle, const CarrierMotion<W>& carrier) {
  const Wide<W> zero(0.0f);
  const Vec3W<W> none{zero, zero, zero};
  if (bundle.plain.moving_count < bundle.plain.body_count)
    return {carrier.center, carrier.linear, carrier.angular, zero};
  compute_centers(bundle);
  Wide<W> mass = zero;
  Vec3W<W> moment = none, momentum = none;
  const auto mass_of = [&](const WideBody<W>& body) {
    return keep(body.inverse_mass > zero, 1.0f / body.inverse_mass);
  };
  for (std::uint32_t i = 0; i < bundle.plain.moving_count; ++i) {
    const WideBody<W>& body = bundle.bodies[i];
    const Wide<W> m = mass_of(body);
    mass += m;
    moment += m * body.center;
    momentum += m * body.linear;
  }
  const Vec3W<W> center = keep(mass > zero, (1.0f / mass) * moment),
                 linear = keep(mass > zero, (1.0f / mass) * momentum);
  Vec3W<W> spin = none;
  Sym3W<W> inertia{zero, zero, zero, zero, zero, zero};
  for (std::uint32_t i = 0; i < bundle.plain.moving_count; ++i) {
    const WideBody<W>& body = bundle.bodies[i];
    const Wide<W> m = mass_of(body);
    const Vec3W<W> r = body.center - center;
    spin += m * cross(r, body.linear - linear) + body.inertia * body.angular;
    const Wide<W> square = length_squared(r);
    inertia =
        inertia + body.inertia + m * Sym3W<W>{square - r.x * r.x, square - r.y * r.y, square - r.z * r.z,
                                              zero - r.x * r.y,   zero - r.x * r.z,   zero - r.y * r.z};
  }
  const Vec3W<W> angular = inverse(inertia) * spin;
  return {center, linear, angular, 0.5f * (mass * length_squared(linear) + dot(angular, spin))};
}

// Scales inner motion until `left` (J) remain, in these lanes. `rotates`: whether the rigid motion may.
template <int W>
GYRE_INLINE void scale_inner_motion(const WideBundle<W>& bundle, const RigidMotion<W>& rigid, bool rotates,
                                    Mask<W> lanes, Wide<W> energy, Wide<W> left) {
  const Wide<W> inner = energy - rigid.energy, remaining = left - rigid.energy, zero(0.0f);
  const Wide<W> share = sqrt(keep((inner > zero) & (remaining > zero), remaining / inner));
  for (std::uint32_t i = 0; i < bundle.plain.moving_count; ++i) {
    WideBody<W>& body = bundle.bodies[i];
    Vec3W<W> linear = rigid.linear;
    if (rotates) linear += cross(rigid.angular, body.center - rigid.center);
    body.linear = select<W>(lanes, linear + share * (body.linear - linear), body.linear);
    body.angular = select<W>(lanes, rigid.angular + share * (body.angular - rigid.angular), body.angular);
  }
}

// Clears the impulses that added energy, so that no warm start or compliance uses them.
template <int W>
GYRE_INLINE void clear_impulses(const WideBundle<W>& bundle, Mask<W> lanes) {
  const Wide<W> zero(0.0f);
  const Vec3W<W> none{zero, zero, zero};
  const auto clear = [&](WideLimitAxis<W>& axis) {
    axis.low_impulse = keep(~lanes, axis.low_impulse);
    axis.high_impulse = keep(~lanes, axis.high_impulse);
  };
  for (std::uint32_t n = 0; n < bundle.plain.node_count; ++n) {
    WideJoint<W>& joint = bundle.joints[n];
    joint.linear_impulse = select<W>(lanes, none, joint.linear_impulse);
    joint.angular_impulse = select<W>(lanes, none, joint.angular_impulse);
    if (bundle.plain.nodes[n].has_twist) clear(joint.twist);
    if (bundle.plain.nodes[n].has_swing) clear(joint.swing);
  }
}

// J: the energy of all bodies while large errors are removed at `rate` (1/s); for a carried articulation,
// plus that of its curved path in a sub-step of `h`.
template <int W>
GYRE_INLINE Wide<W> energy_of_error_removal(const WideBundle<W>& bundle, const CarrierMotion<W>& carrier,
                                            float rate, float h) {
  Wide<W> sum(0.0f), carried(0.0f);
  for (std::uint32_t i = 0; i < bundle.plain.moving_count; ++i) {
    const WideBody<W>& body = bundle.bodies[i];
    const Wide<W> largest = max(body.inertia.xx, max(body.inertia.yy, body.inertia.zz));
    sum += keep(body.inverse_mass > 0.0f, (kMaxErrors.point * kMaxErrors.point) / body.inverse_mass);
    sum += (kMaxErrors.rotation * kMaxErrors.rotation) * largest;
    if (!carrier.moves) continue;
    const Vec3W<W> velocity_change = h * cross(carrier.angular, carrier.at(body) - carrier.linear);
    carried += keep(body.inverse_mass > 0.0f, length_squared(velocity_change) / body.inverse_mass);
  }
  return (0.5f * rate * rate) * sum + 0.5f * carried;
}

// Lanes with a link so light between others that any solution may give it a huge speed.
template <int W>
GYRE_INLINE Mask<W> extreme_ratio_lanes(const WideBundle<W>& bundle) {
  return Wide<W>::load(bundle.plain.has_extreme_mass_ratio) > Wide<W>(0.0f);
}

// Measures the energy around a stage that changes velocities, from construction to limit_gain(). The gain of
// a sub-step is passed on from stage to stage. With light links the rigid motion is recorded before the
// stage: at a billion times its energy floats cannot tell it any more.
template <int W>
class EnergyLimiter {
 public:
  // For the first stage of a sub-step, in `lanes`.
  __attribute__((noinline)) EnergyLimiter(const WideBundle<W>& bundle, Mask<W> lanes)
      : bundle_(bundle), limited_(any(lanes) ? lanes & find_passive_lanes(bundle) : lanes) {
    Wide<W>(0.0f).store(bundle.plain.energy_gain);
    keep(limited_, Wide<W>(1.0f)).store(bundle.plain.energy_gain + W);
    record_energy();
  }
  // For later stages.
  __attribute__((noinline)) explicit EnergyLimiter(const WideBundle<W>& bundle)
      : bundle_(bundle), limited_(Wide<W>::load(bundle.plain.energy_gain + W) > Wide<W>(0.0f)) {
    record_energy();
  }
  // Before bodies move: limits the gain to the existing energy, or to that of error removal at `rate` (1/s)
  // in a sub-step of `h`.
  void limit_gain(float rate, float h) const {
    limit_gain(kMaxEnergyGainAhead, kMaxEnergyGainAhead, rate, h);
  }
  // After the move: removes the energy that joints added, if it is more than a little. Returns the changed
  // lanes.
  Mask<W> remove_gain() const { return limit_gain(kMaxEnergyGain, 0.0f, 0.0f, 0.0f); }

 private:
  // Where joints added more than `max_gain` of the energy before, leaves the share `left` of that. (Not
  // inlined: there is hardly ever anything to remove.)
  __attribute__((noinline)) Mask<W> limit_gain(float max_gain, float left, float rate, float h) const {
    if (none(limited_)) return limited_;
    const Wide<W> zero(0.0f), own = max(energy_ - Wide<W>::load(bundle_.plain.energy_gain), zero);
    const Wide<W> energy = kinetic_energy(bundle_, carrier_), energy_gain = energy - own;
    Mask<W> slowed = limited_ & (energy_gain > zero) & (energy_gain > max_gain * own);
    Wide<W> allowed = left * own;
    if (any(slowed) && rate > 0.0f) {
      const Wide<W> error_energy = energy_of_error_removal(bundle_, carrier_, rate, h);
      slowed = slowed & (energy_gain > max_gain * error_energy);
      allowed = left * max(own, error_energy);
    }
    if (any(slowed)) {
      const bool rotates = carrier_.moves || bundle_.plain.moving_count == bundle_.plain.body_count;
      scale_inner_motion(bundle_, rigid_in(extreme_ratio_lanes(bundle_)), rotates, slowed, energy,
                         own + allowed);
      if (rate > 0.0f) clear_impulses(bundle_, slowed);
    }
    keep(limited_, select(slowed, allowed, energy_gain)).store(bundle_.plain.energy_gain);
    return slowed;
  }
  void record_energy() {
    if (none(limited_)) return;
    carrier_ = carrier_motion_of(bundle_);
    energy_ = kinetic_energy(bundle_, carrier_);
    if (any(limited_ & extreme_ratio_lanes(bundle_))) rigid_ = rigid_motion(bundle_, carrier_);
  }
  // The recorded motion in these lanes, the present one in others.
  RigidMotion<W> rigid_in(Mask<W> before) const {
    const RigidMotion<W> now = rigid_motion(bundle_, carrier_);
    return {select<W>(before, rigid_.center, now.center), select<W>(before, rigid_.linear, now.linear),
            select<W>(before, rigid_.angular, now.angular), select(before, rigid_.energy, now.energy)};
  }

  const WideBundle<W>& bundle_;
  Mask<W> limited_;
  Wide<W> energy_{0.0f};
  RigidMotion<W> rigid_{};
  CarrierMotion<W> carrier_{};
};

}  // namespace GYRE_TARGET_NAMESPACE
}  // namespace gyre
