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
    if (is_movable(a, *inertia_a)) {
      a->linear_velocity -= inertia_a->inverse_mass * along_free_axes(*inertia_a, p);
      a->angular_velocity -= inertia_a->inverse * cross(from_a, p);
    }
    if (is_movable(b, *inertia_b)) {
      b->linear_velocity += inertia_b->inverse_mass * along_free_axes(*inertia_b, p);
      b->angular_velocity += inertia_b->inverse * cross(from_b, p);
    }
  }
  // Takes back the motion that an impulse, applied at once, adds before its time.
  void delay_impulse(Vec3 p, float time, Vec3 from_a, Vec3 from_b) {
    const Vec3 moment = time * p;
    if (is_movable(a, *inertia_a)) {
      a->delta_position += inertia_a->inverse_mass * along_free_axes(*inertia_a, moment);
      a->delta_rotation += inertia_a->inverse * cross(from_a, moment);
    }
    if (is_movable(b, *inertia_b)) {
      b->delta_position -= inertia_b->inverse_mass * along_free_axes(*inertia_b, moment);
      b->delta_rotation -= inertia_b->inverse * cross(from_b, moment);
    }
  }

 private:
  static bool is_movable(const BodyMotion* body, const BodyInertia& inertia) {
    return body != nullptr && (inertia.inverse_mass > 0.0f || inertia.inverse != Sym3{});
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
  for (int k = 0; k < contact.count; ++k) {
    const ImpactPoint& point = contact.points[k];
    if (point.impulse > 0.0f)
      bodies.delay_impulse(point.impulse * contact.normal, point.time, point.from_a, point.from_b);
  }
}

// Friction of the impact at its centre of pressure.
void apply_friction(ImpactContact& contact, Bodies& bodies) {
  float total = 0.0f, time = 0.0f;
  Vec3 from_a, from_b;
  for (int k = 0; k < contact.count; ++k) {
    const ImpactPoint& point = contact.points[k];
    total += point.impulse;
    time += point.impulse * point.time;
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
  const Vec3 impulse = -min(speed / k_inverse, contact.friction * total) * direction;
  bodies.apply_impulse(impulse, from_a, from_b);
  bodies.delay_impulse(impulse, time / total, from_a, from_b);
}

// True if the point would touch within the sub-step. Sets its separating speed and the time until then.
bool apply_point_restitution(ImpactPoint& point, const ImpactContact& contact, const Bodies& bodies,
                             const ImpactSettings& settings) {
  const float closing = -dot(bodies.velocity(point.from_a, point.from_b), contact.normal);
  if (!(closing > settings.threshold)) return false;
  // Below the surface (a contact that was found too late) the way up counts like the way down.
  const float separation =
      point.separation + dot(bodies.displacement(point.from_a, point.from_b), contact.normal);
  if (closing * settings.substep < separation) return false;
  // a h: closing speed that the forces of this sub-step added.
  const float force_speed =
      -dot(contact.linear + cross(contact.angular_b, point.from_b) - cross(contact.angular_a, point.from_a),
           contact.normal);
  const float start = closing - force_speed;  // u: before the forces of this sub-step
  const float half_force_speed = 0.5f * force_speed, acceleration = force_speed / settings.substep;
  const float energy = square(start + half_force_speed) + 2.0f * acceleration * separation;
  if (!(energy > square(settings.threshold))) return false;
  const float leaving = square(contact.restitution) * energy;
  point.time = contact.has_joint ? 0.0f : max(separation, 0.0f) / closing;
  const float left = separation - point.time * closing;
  // (w + a h / 2)^2 + 2 a (left - t w) = e^2 E
  const float half = half_force_speed - acceleration * point.time;
  const float squared = square(half) - square(half_force_speed) + leaving - 2.0f * acceleration * left;
  point.target = max(std::sqrt(max(squared, 0.0f)) - half, 0.0f);
  point.is_hit = true;
  return true;
}

bool find_hit_points(ImpactContact& contact, const Bodies& bodies, const ImpactSettings& settings) {
  bool is_hit = false;
  for (int k = 0; k < contact.count; ++k) {
    contact.points[k].is_hit = false;
    if (apply_point_restitution(contact.points[k], contact, bodies, settings)) is_hit = true;
  }
  return is_hit;
}

}  // namespace

ImpactContact make_impact(const ContactConstraint& constraint, std::uint32_t index) {
  ImpactContact contact;
  contact.manifold = constraint.manifold;
  contact.body_a = constraint.body_a;
  contact.body_b = constraint.body_b;
  contact.restitution = constraint.restitution;
  contact.friction = constraint.dynamic_friction;
  contact.constraint = index;
  contact.speculative = constraint.speculative;
  contact.has_joint = constraint.has_joint;
  read_manifold(contact);
  return contact;
}

void read_manifold(ImpactContact& contact) {
  contact.normal = contact.manifold->normal;
  contact.count = contact.manifold->count;
  for (int k = 0; k < contact.count; ++k) {
    const ContactPointState& from = contact.manifold->points[k];
    contact.points[k].from_a = from.from_a;
    contact.points[k].from_b = from.from_b;
    contact.points[k].separation = from.separation;
  }
}

void record_approach(std::span<ImpactContact> contacts, ContactBodies bodies) {
  for (ImpactContact& contact : contacts) {
    const Bodies pair(contact, bodies);
    contact.linear = pair.velocity({}, {});
    contact.angular_a = pair.a == nullptr ? Vec3{} : pair.a->angular_velocity;
    contact.angular_b = pair.b == nullptr ? Vec3{} : pair.b->angular_velocity;
  }
}

void apply_restitution(std::span<ImpactContact> contacts, ContactBodies bodies,
                       const ImpactSettings& settings, FindMeeting find_meeting) {
  // Effect of the forces: velocities now minus velocities before.
  for (ImpactContact& contact : contacts) {
    const Bodies pair(contact, bodies);
    contact.linear = pair.velocity({}, {}) - contact.linear;
    contact.angular_a = (pair.a == nullptr ? Vec3{} : pair.a->angular_velocity) - contact.angular_a;
    contact.angular_b = (pair.b == nullptr ? Vec3{} : pair.b->angular_velocity) - contact.angular_b;
  }
  for (int pass = 0; pass < kPasses; ++pass) {
    bool any = false;
    for (ImpactContact& contact : contacts) {
      Bodies pair(contact, bodies);
      if (!find_hit_points(contact, pair, settings)) continue;
      if (contact.speculative && (!find_meeting(contact) || !find_hit_points(contact, pair, settings)))
        continue;
      any = true;
      meet_targets(contact, pair);
      apply_friction(contact, pair);
    }
    if (!any) break;
  }
}

}  // namespace gyre
