#include "rigid/solve/speculative_contacts.h"

#include "collision/broadphase/fat_box.h"
#include "collision/contact/contact_update.h"
#include "collision/continuous/swept_surface.h"
#include "math/rotation.h"
#include "rigid/batch/surface_rules.h"
#include "rigid/solve/hit_events.h"

#include <optional>

namespace gyre {

namespace {

// In sizes of the pair. Contacts nearer than kNearest have the features that will meet; an impact leaves kImpactGap.
constexpr float kNearest = 2.0e-3f, kImpactGap = 1.0e-3f;
// In sizes of the pair: pairs that move less against each other in a half-step are not swept. A corner that passes another within one may
// be missed, by about the square of that. With 0.05 most contacts of a heap that lands are swept, which takes three times as long.
constexpr float kUnsweptMove = 0.1f;

// The present pose of a body's origin.
Pose present_pose(const BodyStore& bodies, std::uint32_t body) {
  const BodyFlags& flags = bodies.flags[body];
  if (!is_simulated(flags)) return origin_pose(bodies, body);
  const BodyPose& begin = bodies.poses[body];
  const BodyMotion& motion = bodies.motion[body];
  const Quat orientation = flags.constraint_use == kPoseRead
                               ? bodies.orientations[body]
                               : integrate_rotation(begin.orientation, motion.delta_rotation);
  return origin_pose({begin.center + DVec3(motion.delta_position), orientation}, bodies.masses[body]);
}

// The motion over a time at the present velocities.
Sweep present_sweep(const BodyStore& bodies, std::uint32_t body, float seconds) {
  Sweep sweep{present_pose(bodies, body), bodies.masses[body].center, {}, {}};
  if (!is_simulated(bodies.flags[body])) return sweep;
  sweep.translation = seconds * bodies.motion[body].linear_velocity;
  sweep.rotation = seconds * bodies.motion[body].angular_velocity;
  return sweep;
}

// A body at a share of its sweep, as the narrow phase needs it.
struct BodyAtImpact {
  CollisionBody body;
  BodyCenter center;

  BodyAtImpact(const RigidWorld& w, std::uint32_t index, const Sweep& sweep, double share, float seconds) {
    const BodyMass& mass = w.bodies.masses[index];
    ColliderBody from;
    from.pose = pose_at(sweep, share);
    from.center = mass.center;
    from.bounding_radius = mass.bounding_radius;
    from.awake = is_simulated(w.bodies.flags[index]);
    if (from.awake) {
      from.linear_velocity = w.bodies.motion[index].linear_velocity;
      from.angular_velocity = w.bodies.motion[index].angular_velocity;
    }
    body = make_collision_body(from, seconds);
    center = {from.center, from.bounding_radius};
  }
};

// The displacement of the point of a body since the step began, and after a time at its present velocity.
Vec3 displacement_of(const ContactSolve& s, std::int32_t body, Vec3 from_center, float seconds) {
  if (body == kNoBody) return {};
  const BodyMotion& motion = s.bodies.motion[body];
  return motion.delta_position + cross(motion.delta_rotation, from_center) +
         seconds * point_velocity(motion, from_center);
}

SweptShape swept(const ColliderShape& shape, const Sweep& sweep) {
  return make_swept_shape(shape.shape, shape.body_from_shape, sweep);
}

// The time at which the two shapes meet, as a share of the sweeps.
Impact meeting_time(const ContactSolve& s, const Contact& contact, const Sweep (&sweeps)[2]) {
  const ColliderShape &a = s.w.shapes.colliders[contact.shape_a], &b = s.w.shapes.colliders[contact.shape_b];
  const SweptShape swept_a = swept(a, sweeps[0]), swept_b = swept(b, sweeps[1]);
  const double target = double(kImpactGap * contact.size);
  if (contact.manifold_room == 1) {
    if (stays_clear(swept_a, swept_b, 0.0, 1.0, 2.0 * target)) return {};
    return time_of_impact(swept_a, swept_b, 0.0, 1.0, target);
  }
  TriangleHull triangle;
  return is_convex(a.shape.kind) ? first_meeting(swept_a, swept_b, target, triangle)
                                 : first_meeting(swept_b, swept_a, target, triangle);
}

// Updates the manifolds at the poses of the impact; what a manifold counted in the step stays with it. Returns their number.
int update_manifolds(const ContactSolve& s, Contact& contact, const Sweep (&sweeps)[2], double share) {
  RigidWorld& w = s.w;
  Manifold* const manifolds = &w.contacts.manifolds[contact.first_manifold];
  const int before = contact.manifold_count;
  Manifold former[kMaxMeshManifolds];
  for (int m = 0; m < before; ++m) former[m] = manifolds[m];
  const BodyAtImpact a(w, contact.body_a, sweeps[0], share, s.settings.step),
      b(w, contact.body_b, sweeps[1], share, s.settings.step);
  const PairInput pair{&contact,
                       manifolds,
                       &w.shapes.colliders[contact.shape_a],
                       &w.shapes.colliders[contact.shape_b],
                       &a.body,
                       &b.body,
                       &a.center,
                       &b.center};
  Recycled views;
  s.update_views(&pair, 0, 1, false, views);
  compute_manifold(pair, views.views[0], cached_triangles_of(w.contacts, contact));
  const int found = min(before, int(contact.manifold_count));
  for (int m = 0; m < found; ++m) {
    for (int k = 0; k < former[m].count; ++k)
      manifolds[m].points[0].total_impulse += former[m].points[k].total_impulse;
    manifolds[m].total_friction = former[m].total_friction;
  }
  // The solver has as many manifolds as the step began with: the others stay as they were, and are held back.
  for (int m = found; m < int(contact.manifold_count); ++m) manifolds[m] = {};
  for (int m = found; m < before; ++m) manifolds[m] = former[m];
  if (before != int(contact.manifold_count)) invalidate_cache(contact);
  contact.manifold_count = std::uint16_t(before);
  return found;
}

// Makes separations those of the present, less the motion since the step began; `seconds`: from now to the impact.
void date_back(const ContactSolve& s, const ContactConstraint& constraint, float seconds) {
  Manifold& manifold = *constraint.manifold;
  for (int k = 0; k < manifold.count; ++k) {
    ContactPointState& point = manifold.points[k];
    point.separation -= dot(displacement_of(s, constraint.body_b, point.from_b, seconds) -
                                displacement_of(s, constraint.body_a, point.from_a, seconds),
                            manifold.normal);
  }
}

bool is_slow(const ContactSolve& s, const Contact& contact, const Sweep (&sweeps)[2]) {
  const auto turn = [&](const Sweep& sweep, std::uint32_t body) {
    return length(sweep.rotation) * s.w.bodies.masses[body].bounding_radius;
  };
  return length(sweeps[1].translation - sweeps[0].translation) + turn(sweeps[0], contact.body_a) +
             turn(sweeps[1], contact.body_b) <
         kUnsweptMove * contact.size;
}

struct Meeting {
  double share = 0.0;  // of the half-step
  int manifolds = 0;   // found there
};

std::optional<Meeting> find_swept_meeting(const ContactSolve& s, Contact& contact, const Sweep (&sweeps)[2]) {
  const Impact impact = meeting_time(s, contact, sweeps);
  if (!impact.hit) return std::nullopt;
  return Meeting{impact.time, update_manifolds(s, contact, sweeps, impact.time)};
}

// The meeting of a slow convex pair without a sweep. The distance at the end of the half-step tells if the two meet, and the manifold there
// when; that of this time is the result. Where they do not meet, the manifold is as it was.
std::optional<Meeting> find_slow_meeting(const ContactSolve& s, Contact& contact, const Sweep (&sweeps)[2]) {
  const SweptShape a = swept(s.w.shapes.colliders[contact.shape_a], sweeps[0]),
                   b = swept(s.w.shapes.colliders[contact.shape_b], sweeps[1]);
  const float target = kImpactGap * contact.size;
  if (find_gap(a, b, 1.0, double(target)).distance > double(target)) return std::nullopt;
  Manifold& manifold = s.w.contacts.manifolds[contact.first_manifold];
  const Manifold former = manifold;
  const std::uint16_t count = contact.manifold_count;
  const auto stay_apart = [&]() -> std::optional<Meeting> {
    manifold = former;
    contact.manifold_count = count;
    return std::nullopt;
  };
  if (update_manifolds(s, contact, sweeps, 1.0) == 0) return stay_apart();
  const ContactPointState* deepest = manifold.points;
  for (int k = 1; k < manifold.count; ++k)
    if (manifold.points[k].separation < deepest->separation) deepest = &manifold.points[k];
  if (manifold.count == 0 || deepest->separation > target) return stay_apart();
  const auto move = [&](const Sweep& sweep, Vec3 from_center) {
    return sweep.translation + cross(sweep.rotation, from_center);
  };
  const float closing =
                  dot(move(sweeps[0], deepest->from_a) - move(sweeps[1], deepest->from_b), manifold.normal),
              beyond = target - deepest->separation;
  const double share = closing > beyond ? 1.0 - double(beyond / closing) : 0.0;
  const int manifolds = update_manifolds(s, contact, sweeps, share);
  if (manifolds == 0) return stay_apart();
  return Meeting{share, manifolds};
}

bool is_apart(const RigidWorld& w, const Contact& contact) {
  for (const Manifold& manifold : manifolds_of(w.contacts, contact)) {
    for (int k = 0; k < manifold.count; ++k)
      if (manifold.points[k].separation <= kNearest * contact.size) return false;
  }
  return true;
}

// True for a contact with a static shape if its mover touches another. It may slide from one to the other, and the first planes are
// those without internal edges (collision/contact/internal_edges.h).
bool slides_on_static(const RigidWorld& w, const Contact& contact) {
  const auto pushes = [&](std::uint32_t shape) { return w.shapes.proxies[shape].pushes; };
  if (pushes(contact.shape_a) == pushes(contact.shape_b)) return false;
  const std::uint32_t mover = pushes(contact.shape_a) ? contact.shape_a : contact.shape_b;
  bool slides = false;
  for_each_contact_of_shape(w.contacts, mover, [&](std::uint32_t slot) {
    const Contact& other = w.contacts.contacts[slot];
    if (&other == &contact || other.sensor != 0 || pushes(other.shape_a) == pushes(other.shape_b)) return;
    slides = slides || !is_apart(w, other);
  });
  return slides;
}

bool has_plane(const RigidWorld& w, const Contact& contact) {
  return w.shapes.colliders[contact.shape_a].shape.kind == ShapeKind::plane ||
         w.shapes.colliders[contact.shape_b].shape.kind == ShapeKind::plane;
}

}  // namespace

bool is_far_ahead(const RigidWorld& w, const Contact& contact) {
  if (contact.manifold_room != 1 || contact.manifold_count == 0) return false;
  const float farthest = (kSpeculativeShare + kMaxApproach) * contact.size;
  const Manifold& manifold = w.contacts.manifolds[contact.first_manifold];
  for (int k = 0; k < manifold.count; ++k)
    if (manifold.points[k].separation <= farthest) return false;
  return manifold.count > 0;
}

bool is_speculative(const RigidWorld& w, const Contact& contact) {
  if (contact.recycled != 0 || contact.manifold_count == 0 || has_plane(w, contact)) return false;
  for (const Manifold& manifold : manifolds_of(w.contacts, contact)) {
    for (int k = 0; k < manifold.count; ++k)
      if (manifold.points[k].normal_impulse > 0.0f) return false;
  }
  return is_apart(w, contact) && !slides_on_static(w, contact);
}

bool find_meeting(const ContactSolve& s, std::uint32_t index) {
  RigidWorld& w = s.w;
  Array<ContactConstraint>& constraints = s.lists.constraints;
  const std::uint32_t slot = s.lists.slots[index];
  Contact& contact = w.contacts.contacts[slot];
  // All manifolds of a surface are found at once, in one of its constraints.
  std::size_t first = index, end = index + 1;
  while (first > 0 && s.lists.slots[first - 1] == slot) --first;
  while (end < constraints.size() && s.lists.slots[end] == slot) ++end;
  for (std::size_t i = first; i < end && contact.manifold_room > 1; ++i)
    if (!constraints[i].speculative) return !constraints[index].speculative;
  const float substep = s.settings.substep;
  const Sweep sweeps[2] = {present_sweep(w.bodies, contact.body_a, substep),
                           present_sweep(w.bodies, contact.body_b, substep)};
  // A bounce needs the moment of the impact to more digits.
  const bool is_swept =
      contact.manifold_room > 1 || constraints[index].restitution > 0.0f || !is_slow(s, contact, sweeps);
  const std::optional<Meeting> meeting =
      is_swept ? find_swept_meeting(s, contact, sweeps) : find_slow_meeting(s, contact, sweeps);
  if (!meeting) return false;
  const Manifold* const manifolds = &w.contacts.manifolds[contact.first_manifold];
  bool is_found = false;
  for (std::size_t i = first; i < end; ++i) {
    ContactConstraint& constraint = constraints[i];
    Manifold& manifold = *constraint.manifold;
    if (&manifold - manifolds >= meeting->manifolds) continue;
    date_back(s, constraint, float(meeting->share) * substep);
    constraint.point_count = std::int8_t(manifold.count);
    constraint.fast = record_hit_approach(w, contact, manifold) || constraint.fast;
    if (!w.surface_rules.empty() && !apply_surface_rules(w, contact, manifold, constraint)) continue;
    constraint.speculative = false;
    is_found = is_found || i == index;
  }
  return is_found;
}

}  // namespace gyre
