#include "solver/contact/impact.h"

namespace gyre {

namespace {

constexpr int kPasses = 24;           // over all contacts, until none closes
constexpr int kPointIterations = 16;  // over the points of one manifold

// The two bodies of a contact during an impact.
struct Bodies {
  BodyMotion* a;
  BodyMotion* b;
  const BodyInertia* inertia_a;
  const BodyInertia* inertia_b;

  Bodies(const ImpactContact& contact, ContactBodies bodies) {
    static constexpr BodyInertia kImmovable{};
    a = contact.body_a == kNoBody ? nullptr : &bodies.motion[contact.body_a];
    b = contact.body_b == kNoBody ? nullptr : &bodies.motion[contact.body_b];
    inertia_a = a == nullptr ? &kImmovable : &bodies.inertia[contact.body_a];
    inertia_b = b == nullptr ? &kImmovable : &bodies.inertia[contact.body_b];
  }

  Vec3 velocity(Vec3 from_a, Vec3 from_b) const {
    Vec3 v;
    if (b != nullptr) v += b->linear_velocity + cross(b->angular_velocity, from_b);
    if (a != nullptr) v -= a->linear_velocity + cross(a->angular_velocity, from_a);
    return v;
  }
  Vec3 displacement(Vec3 from_a, Vec3 from_b) const {
    Vec3 d;
    if (b != nullptr) d += b->delta_position + cross(b->delta_rotation, from_b);
    if (a != nullptr) d -= a->delta_position + cross(a->delta_rotation, from_a);
    return d;
  }
  float inverse_mass(Vec3 direction, Vec3 from_a, Vec3 from_b) const {
    const Vec3 ja = cross(from_a, direction), jb = cross(from_b, direction);
    return inverse_mass_along(*inertia_a, direction) + inverse_mass_along(*inertia_b, direction) +
           dot(ja, inertia_a->inverse * ja) + dot(jb, inertia_b->inverse * jb);
  }
  void apply_impulse(Vec3 p, Vec3 from_a, Vec3 from_b) {
    if (a != nullptr && (inertia_a->inverse_mass > 0.0f || inertia_a->inverse != Sym3{})) {
      a->linear_velocity -= inertia_a->inverse_mass * along_free_axes(*inertia_a, p);
      a->angular_velocity -= inertia_a->inverse * cross(from_a, p);
    }
    if (b != nullptr && (inertia_b->inverse_mass > 0.0f || inertia_b->inverse != Sym3{})) {
      b->linear_velocity += inertia_b->inverse_mass * along_free_axes(*inertia_b, p);
      b->angular_velocity += inertia_b->inverse * cross(from_b, p);
    }
  }
};

// Solves for the targets of all hit points together: impulses >= 0, speed >= target, one of the two equal.
void meet_targets(ImpactContact& contact, Bodies& bodies) {
  for (ImpactPoint& point : contact.points) point.impulse = 0.0f;
  for (int iteration = 0; iteration < kPointIterations; ++iteration) {
    float change = 0.0f;
    for (int k = 0; k < contact.count; ++k) {
      ImpactPoint& point = contact.points[k];
      if (!point.is_hit) continue;
      const float k_inverse = bodies.inverse_mass(contact.normal, point.from_a, point.from_b);
      if (!(k_inverse > 0.0f)) continue;
      const float speed = dot(bodies.velocity(point.from_a, point.from_b), contact.normal);
      const float next = max(point.impulse + (point.target - speed) / k_inverse, 0.0f);
      bodies.apply_impulse((next - point.impulse) * contact.normal, point.from_a, point.from_b);
      change = max(change, absolute(next - point.impulse) * k_inverse);
      point.impulse = next;
    }
    // Converged to the precision of floats.
    if (change <= 1.0e-6f * absolute(contact.points[0].target)) break;
  }
}

// Friction of the impact at its centre of pressure.
void apply_friction(ImpactContact& contact, Bodies& bodies) {
  float total = 0.0f;
  Vec3 from_a, from_b;
  for (int k = 0; k < contact.count; ++k) {
    const ImpactPoint& point = contact.points[k];
    total += point.impulse;
    from_a += point.impulse * point.from_a;
    from_b += point.impulse * point.from_b;
  }
  if (!(total > 0.0f)) return;
  for (int k = 0; k < contact.count; ++k)
    contact.manifold->points[k].total_impulse += contact.points[k].impulse;
  if (!(contact.friction > 0.0f)) return;
  from_a = from_a / total;
  from_b = from_b / total;
  const Vec3 v = bodies.velocity(from_a, from_b);
  const Vec3 slip = v - dot(v, contact.normal) * contact.normal;
  const float speed = length(slip);
  if (!(speed > 0.0f)) return;
  const Vec3 direction = slip / speed;
  const float k_inverse = bodies.inverse_mass(direction, from_a, from_b);
  if (!(k_inverse > 0.0f)) return;
  bodies.apply_impulse(-min(speed / k_inverse, contact.friction * total) * direction, from_a, from_b);
}

// True if the point touches within the sub-step. Sets its separating speed.
bool apply_point_restitution(ImpactPoint& point, const ImpactContact& contact, const Bodies& bodies,
                             const ImpactSettings& settings) {
  const float closing = -dot(bodies.velocity(point.from_a, point.from_b), contact.normal);
  if (!(closing > settings.threshold)) return false;
  // Below the surface (a contact that was found too late) the way up counts like the way down.
  const float separation =
      point.separation + dot(bodies.displacement(point.from_a, point.from_b), contact.normal);
  if (closing * settings.substep < separation) return false;
  const float start = closing - point.force_speed;  // u: before the forces of this sub-step
  const float half_force_speed = 0.5f * point.force_speed;
  const float fall = 2.0f * point.force_speed / settings.substep * separation;  // 2 a s
  const float energy = square(start + half_force_speed) + fall;
  if (!(energy > square(settings.threshold))) return false;
  const float leaving = square(contact.restitution) * energy;
  if (leaving - fall >= square(half_force_speed)) {
    point.target = max(std::sqrt(leaving - fall) - half_force_speed, 0.0f);
    point.is_hit = true;
  } else {
    point.target = half_force_speed + std::sqrt(leaving);
    point.pending = true;
  }
  return point.is_hit;
}

}  // namespace

ImpactContact make_impact(const ContactConstraint& constraint) {
  ImpactContact contact;
  contact.manifold = constraint.manifold;
  contact.body_a = constraint.body_a;
  contact.body_b = constraint.body_b;
  contact.restitution = constraint.restitution;
  contact.friction = constraint.dynamic_friction;
  contact.normal = constraint.manifold->normal;
  contact.count = constraint.manifold->count;
  for (int k = 0; k < contact.count; ++k) {
    const ContactPointState& from = constraint.manifold->points[k];
    contact.points[k].from_a = from.from_a;
    contact.points[k].from_b = from.from_b;
    contact.points[k].separation = from.separation;
  }
  return contact;
}

void record_approach(std::span<ImpactContact> contacts, ContactBodies bodies) {
  for (ImpactContact& contact : contacts) {
    const Bodies pair(contact, bodies);
    for (int k = 0; k < contact.count; ++k) {
      ImpactPoint& point = contact.points[k];
      point.force_speed = -dot(pair.velocity(point.from_a, point.from_b), contact.normal);
      point.pending = false;
    }
  }
}

void apply_restitution(std::span<ImpactContact> contacts, ContactBodies bodies,
                       const ImpactSettings& settings) {
  // Effect of the forces: closing speed now minus closing speed before.
  for (ImpactContact& contact : contacts) {
    const Bodies pair(contact, bodies);
    for (int k = 0; k < contact.count; ++k) {
      ImpactPoint& point = contact.points[k];
      point.force_speed = -dot(pair.velocity(point.from_a, point.from_b), contact.normal) - point.force_speed;
    }
  }
  for (int pass = 0; pass < kPasses; ++pass) {
    bool any = false;
    for (ImpactContact& contact : contacts) {
      Bodies pair(contact, bodies);
      bool is_hit = false;
      for (int k = 0; k < contact.count; ++k) {
        contact.points[k].is_hit = false;
        if (apply_point_restitution(contact.points[k], contact, pair, settings)) is_hit = true;
      }
      if (!is_hit) continue;
      any = true;
      meet_targets(contact, pair);
      apply_friction(contact, pair);
    }
    if (!any) break;
  }
}

void apply_delayed_restitution(std::span<ImpactContact> contacts, ContactBodies bodies,
                               const ImpactSettings&) {
  for (ImpactContact& contact : contacts) {
    bool pending = false;
    for (int k = 0; k < contact.count; ++k) {
      ImpactPoint& point = contact.points[k];
      point.is_hit = point.pending;
      pending = pending || point.pending;
      point.pending = false;
    }
    if (!pending) continue;
    Bodies pair(contact, bodies);
    meet_targets(contact, pair);
    apply_friction(contact, pair);
  }
}

}  // namespace gyre
