#include "rigid/time/toi_stepping.h"

#include "collision/continuous/time_of_impact.h"
#include "rigid/batch/solve_batch.h"
#include "rigid/batch/surface_rules.h"
#include "rigid/solve/hit_events.h"

namespace gyre {

namespace {

// The states of a contact in RigidWorld::inactive_contacts.
constexpr std::uint8_t kActs = 0, kApart = 1, kSeparating = 2;

bool has_gap(const RigidWorld& w, const Contact& contact) {
  const auto is_solid = [&](std::uint32_t shape) {
    const ShapeKind kind = w.shapes.colliders[shape].shape.kind;
    return kind != ShapeKind::mesh && kind != ShapeKind::height_field;
  };
  return is_solid(contact.shape_a) && is_solid(contact.shape_b);
}

bool is_considered(const RigidWorld& w, const Contact& contact) {
  return contact.manifold_room != 0 && contact.sensor == 0 && contact.ended == 0 &&
         (is_active(w, contact.body_a) || is_active(w, contact.body_b)) && has_gap(w, contact);
}

// The motions of the two shapes of a contact.
struct SweptPair {
  Sweep sweep_a, sweep_b;
  SweptShape a, b;

  // `swept`: along their motion; else at their poses at the beginning of the step.
  SweptPair(const RigidWorld& w, const Contact& contact, bool swept)
      : sweep_a(sweep_of_body(w.bodies, contact.body_a)), sweep_b(sweep_of_body(w.bodies, contact.body_b)) {
    if (!swept) sweep_a.translation = sweep_a.rotation = sweep_b.translation = sweep_b.rotation = {};
    const ColliderShape &shape_a = w.shapes.colliders[contact.shape_a],
                        &shape_b = w.shapes.colliders[contact.shape_b];
    a = make_swept_shape(shape_a.shape, shape_a.body_from_shape, sweep_a);
    b = make_swept_shape(shape_b.shape, shape_b.body_from_shape, sweep_b);
  }
  SweptPair(const SweptPair&) = delete;
  SweptPair& operator=(const SweptPair&) = delete;

  Gap gap(double time, double reach) const { return find_gap(a, b, time, reach); }
};

// The smallest separating speed of the contact points within `tolerance` (m), m/s. Closing speeds are negative.
float separating_speed(const RigidWorld& w, const Contact& contact, float tolerance) {
  float slowest = 1.0e30f;
  for (const Manifold& manifold : manifolds_of(w.contacts, contact)) {
    for (int k = 0; k < manifold.count; ++k) {
      const ContactPointState& point = manifold.points[k];
      if (point.separation > tolerance) continue;
      const DVec3 v = DVec3(point_velocity(w.bodies.motion[contact.body_b], point.from_b)) -
                      DVec3(point_velocity(w.bodies.motion[contact.body_a], point.from_a));
      slowest = min(slowest, float(dot(v, DVec3(manifold.normal))));
    }
  }
  return slowest;
}

float min_separation(const RigidWorld& w, const Contact& contact) {
  float smallest = 1.0e30f;
  for (const Manifold& manifold : manifolds_of(w.contacts, contact)) {
    for (int k = 0; k < manifold.count; ++k) smallest = min(smallest, manifold.points[k].separation);
  }
  return smallest;
}

std::int32_t movable_body(const RigidWorld& w, std::uint32_t body) {
  const BodyFlags& flags = w.bodies.flags[body];
  return flags.type == BodyType::fixed || flags.frozen != 0 ? kNoBody : std::int32_t(body);
}

// The touching points of a manifold as an impact; count 0 if there are none.
ImpactContact make_touching_impact(const RigidWorld& w, const Contact& contact, Manifold& manifold) {
  ContactConstraint constraint;
  constraint.body_a = movable_body(w, contact.body_a);
  constraint.body_b = movable_body(w, contact.body_b);
  constraint.dynamic_friction = contact.surface.dynamic_friction;
  constraint.restitution = contact.surface.restitution;
  constraint.manifold = &manifold;
  constraint.point_count = std::int8_t(manifold.count);
  if (!w.surface_rules.empty() && !apply_surface_rules(w, contact, manifold, constraint))
    constraint.restitution = 0.0f;
  ImpactContact impact = make_impact(constraint, 0);
  const float tolerance = 2.0f * touch_distance(contact);
  int touching = 0;
  for (int k = 0; k < impact.count; ++k) {
    if (impact.points[k].separation > tolerance) {
      impact.points[k].separation = 1.0e30f;  // takes no part
      continue;
    }
    impact.points[k].separation = 0.0f;
    ++touching;
  }
  if (touching == 0 || !(impact.restitution > 0.0f)) impact.count = 0;
  return impact;
}

// The offset of b relative to a from its straight path at a share of the step. Under constant acceleration a body
// starts slower than its mean speed and ends faster.
DVec3 acceleration_offset(const RigidWorld& w, const StepCheckpoint& before, const Contact& contact,
                          double share, double seconds) {
  const auto velocity_change = [&](std::uint32_t body) {
    if (!is_active(w, body)) return DVec3{};
    return DVec3(w.bodies.motion[body].linear_velocity) - DVec3(before.motion(body).linear_velocity);
  };
  return (-0.5 * share * (1.0 - share) * seconds) *
         (velocity_change(contact.body_b) - velocity_change(contact.body_a));
}

double first_impact_time(const RigidWorld& w, const StepCheckpoint& before, const Contact& contact,
                         double seconds) {
  const double tolerance = double(touch_distance(contact));
  const SweptPair pair(w, contact, true);
  const Impact impact = time_of_impact(pair.a, pair.b, 0.0, 1.0, 0.5 * tolerance);
  if (!impact.hit) return kNoImpact;
  const double end = pair.gap(1.0, 4.0 * tolerance).distance;
  if (impact.time >= 1.0 || absolute(end) <= tolerance) return kNoImpact;  // touches just at the end
  const DVec3 off = acceleration_offset(w, before, contact, impact.time, seconds);
  constexpr double kTimeStep = 1.0e-3;  // of the step: of the difference quotient of the gap
  const double dt = min(kTimeStep, 0.5 * impact.time);
  const Gap at_impact = pair.gap(impact.time, 4.0 * tolerance),
            before_impact = pair.gap(impact.time - dt, 1.0e30);
  const double closing =
      dt > 0.0 ? (before_impact.distance - at_impact.distance) / dt : 0.0;  // m, for the whole step
  double time = impact.time;
  if (closing > 0.0) time += dot(off, at_impact.normal) / closing;
  // The correction may not move the impact out of the step: if the shapes overlap at the end, they meet in any case.
  if (!(time > 0.0)) time = impact.time;
  if (time >= 1.0) return end < 0.0 ? impact.time * seconds : kNoImpact;
  return time * seconds;
}

}  // namespace

void StepCheckpoint::save(const RigidWorld& w) {
  motion_ = w.bodies.motion;
  inertia_ = w.bodies.inertia;
  orientations_ = w.bodies.orientations;
  flags_ = w.bodies.flags;
  moves_ = w.bodies.last_moves;
  manifolds_ = w.contacts.manifolds;
  joints_ = w.joints.records;
  details_ = w.joints.details;
  settings_ = w.settings;
}

void StepCheckpoint::restore(RigidWorld& w) const {
  w.bodies.motion = motion_;
  w.bodies.inertia = inertia_;
  w.bodies.orientations = orientations_;
  w.bodies.flags = flags_;
  w.bodies.last_moves = moves_;
  w.contacts.manifolds = manifolds_;
  w.joints.records = joints_;
  w.joints.details = details_;
  w.settings = settings_;
}

bool resolve_impacts(RigidWorld& w, ImpactScratch& scratch, float threshold) {
  scratch.impacts.clear(), scratch.contacts.clear(), scratch.is_hit.clear(), scratch.hit_bodies.clear();
  for (std::uint32_t slot = 0; slot < w.contacts.contacts.size(); ++slot) {
    const Contact& contact = w.contacts.contacts[slot];
    if (!is_considered(w, contact) || !is_solved(w, contact)) continue;
    for (Manifold& manifold : manifolds_of(w.contacts, contact)) {
      const ImpactContact impact = make_touching_impact(w, contact, manifold);
      if (impact.count == 0) continue;
      scratch.impacts.push_back(impact);
      scratch.contacts.push_back(slot);
      scratch.is_hit.push_back(record_hit_approach(w, contact, manifold) ? 1 : 0);
    }
  }
  if (scratch.impacts.empty()) return false;
  const ContactBodies bodies{w.bodies.motion.data(), w.bodies.inertia.data()};
  // No forces act during an impact and no time passes. Every touching point that closes takes part.
  const ImpactSettings settings{1.0f, threshold};
  record_approach(scratch.impacts, bodies);
  apply_restitution(scratch.impacts, bodies, settings, [](ImpactContact&) { return true; });
  bool any = false;
  for (std::size_t i = 0; i < scratch.impacts.size(); ++i) {
    const ImpactContact& impact = scratch.impacts[i];
    float impulse = 0.0f;
    for (int k = 0; k < impact.count; ++k) impulse += impact.points[k].impulse;
    if (!(impulse > 0.0f)) continue;
    any = true;
    const Contact& contact = w.contacts.contacts[scratch.contacts[i]];
    scratch.hit_bodies.push_back(contact.body_a);
    scratch.hit_bodies.push_back(contact.body_b);
    if (scratch.is_hit[i] != 0) report_hit(w, contact, *impact.manifold, impulse);
  }
  return any;
}

void list_inactive_contacts(RigidWorld& w, float threshold) {
  w.inactive_contacts.resize(w.contacts.contacts.size());
  for (std::uint32_t slot = 0; slot < w.inactive_contacts.size(); ++slot) {
    const Contact& contact = w.contacts.contacts[slot];
    std::uint8_t& state = w.inactive_contacts[slot];
    state = kActs;
    if (!is_considered(w, contact)) continue;
    const float tolerance = touch_distance(contact);
    const SweptPair pair(w, contact, false);
    const Gap gap = pair.gap(0.0, 2.0 * double(tolerance));
    const bool apart = gap.beyond || gap.distance > double(tolerance);
    if (apart && min_separation(w, contact) > tolerance) {
      state = kApart;
    } else if (separating_speed(w, contact, 2.0f * tolerance) > threshold) {
      state = kSeparating;
    }
  }
}

FirstImpact find_first_impact(const RigidWorld& w, const StepCheckpoint& before, double seconds) {
  FirstImpact first;
  for (std::uint32_t slot = 0; slot < w.inactive_contacts.size(); ++slot) {
    if (w.inactive_contacts[slot] == kActs) continue;
    const Contact& contact = w.contacts.contacts[slot];
    if (w.inactive_contacts[slot] == kApart) {
      const double time = first_impact_time(w, before, contact, seconds);
      if (time < first.time) first = {time, false};
      continue;
    }
    // A separating contact that is back at the end of the step had a turning point within it.
    const double tolerance = double(touch_distance(contact));
    const SweptPair pair(w, contact, true);
    const Gap start = pair.gap(0.0, 1.0e30), end = pair.gap(1.0, 1.0e30);
    if (end.distance > tolerance) continue;
    const auto speed = [&](auto&& motion_of) {
      return dot(
          DVec3(motion_of(contact.body_b).linear_velocity) - DVec3(motion_of(contact.body_a).linear_velocity),
          start.normal);
    };
    const double away = speed([&](std::uint32_t body) -> const BodyMotion& { return before.motion(body); });
    const double back = speed([&](std::uint32_t body) -> const BodyMotion& { return w.bodies.motion[body]; });
    if (!(away > 0.0) || !(back < 0.0)) continue;
    const double time = seconds * away / (away - back);
    if (time < first.time) first = {time, true};
  }
  return first;
}

}  // namespace gyre
