#include "rigid/rest/resting_islands.h"

#include "rigid/integrate/integrators.h"
#include "solver/rest/static_equilibrium.h"

namespace gyre {

namespace {

// Speed of a body against the speed that it gains by falling through its own bounding radius.
struct RestSpeed {
  float speed, scale;

  RestSpeed(const RigidWorld& w, std::uint32_t body, float gravity) {
    const BodyMotion& motion = w.bodies.motion[body];
    const float radius = w.bodies.masses[body].bounding_radius;
    speed = length(motion.linear_velocity) + radius * length(motion.angular_velocity);
    scale = std::sqrt(gravity * radius);
  }
  bool is_below(float share) const { return speed <= share * scale; }
};
// True if the body has no locked axes and needs no exact rotation. A resting island needs both.
bool is_unlocked(const RigidWorld& w, std::uint32_t body) {
  const BodyFlags& flags = w.bodies.flags[body];
  return !needs_exact_rotation(w.bodies, body, w.settings.last_substep) && flags.locked_linear == 0 &&
         flags.locked_angular == 0;
}

// True if the body does not move: kNoBody, or a body without velocity (a kinematic one may move).
bool is_still(const RigidWorld& w, std::int32_t body) {
  if (body == kNoBody) return true;
  const BodyMotion& motion = w.bodies.motion[body];
  return motion.linear_velocity == Vec3{} && motion.angular_velocity == Vec3{};
}

}  // namespace

RestingIslands::RestingIslands(const RigidWorld& w, std::span<const ContactConstraint> constraints,
                               std::span<const ColoringPair> pairs, std::span<const JointEdge> joints,
                               const SolveBatch& batch, std::span<const std::uint32_t> local_index,
                               Arena& arena)
    : w_(w),
      batch_(batch),
      local_index_(local_index),
      sets_(arena.make<std::uint32_t>(batch.bodies.size())),
      counts_(arena.make<IslandCount>(batch.bodies.size())) {
  for (IslandCount& count : counts_) count = {};
  unite_constrained(pairs, joints);
  refuse_jointed(joints);
  count_bodies();
  count_contacts(constraints, pairs);
}

void RestingIslands::unite_constrained(std::span<const ColoringPair> pairs,
                                       std::span<const JointEdge> joints) {
  for (const ColoringPair& pair : pairs) {
    if (pair.a != ColoringPair::kNone && pair.b != ColoringPair::kNone) sets_.unite(pair.a, pair.b);
  }
  for (const JointEdge& joint : joints) {
    if (joint.body_a != kNoBody && joint.body_b != kNoBody)
      sets_.unite(local_index_[std::size_t(joint.body_a)], local_index_[std::size_t(joint.body_b)]);
  }
  sets_.flatten();
}

void RestingIslands::count_bodies() {
  const float gravity = length(w_.settings.gravity);
  for (std::uint32_t index = 0; index < batch_.bodies.size(); ++index) {
    const std::uint32_t body = batch_.bodies[index];
    if (!is_movable(w_.bodies.flags[body])) continue;
    IslandCount& count = counts_[sets_.parents[index]];
    if (count.refused) continue;
    const RestSpeed rest_speed(w_, body, gravity);
    const float radius = w_.bodies.masses[body].bounding_radius;
    count.smallest = count.bodies == 0 ? radius : min(count.smallest, radius);
    ++count.bodies;
    if (!is_unlocked(w_, body) || !rest_speed.is_below(kSlowSpeedShare)) {
      count.refused = true;
    } else if (!rest_speed.is_below(kCalmSpeedShare)) {
      count.not_calm = true;
    } else if (!rest_speed.is_below(kSettledSpeedShare)) {
      count.not_settled = true;
    }
  }
}

void RestingIslands::count_contacts(std::span<const ContactConstraint> constraints,
                                    std::span<const ColoringPair> pairs) {
  for (std::uint32_t i = 0; i < constraints.size(); ++i) {
    const bool active_a = pairs[i].a != ColoringPair::kNone, active_b = pairs[i].b != ColoringPair::kNone;
    IslandCount& count = counts_[sets_.parents[active_a ? pairs[i].a : pairs[i].b]];
    if (count.refused) continue;
    const ContactConstraint& c = constraints[i];
    ++count.contacts;
    if (!(c.static_friction > 0.0f) || c.surface_velocity != Vec3{}) count.refused = true;
    if (c.point_count < 3) count.has_narrow_contact = true;
    if (c.point_count == 1) ++count.single_point_contacts;
    if (c.stiffness == ContactStiffness::rigid) count.has_rigid_contact = true;
    if (c.stiffness == ContactStiffness::soft) count.has_soft_contact = true;
    if (active_a && active_b) continue;
    ++count.ground_contacts;
    count.ground_contact = i;
    if (!is_still(w_, active_a ? c.body_b : c.body_a)) count.refused = true;
  }
}

void RestingIslands::refuse_jointed(std::span<const JointEdge> joints) {
  for (const JointEdge& joint : joints)
    for_moving(joint, [&](std::uint32_t body) { counts_[sets_.parents[local_index_[body]]].refused = true; });
}

IncidentContacts link_incident_contacts(std::span<const ColoringPair> pairs, std::size_t bodies,
                                        Arena& arena) {
  IncidentContacts links{arena.make<std::uint32_t>(bodies), arena.make<std::uint32_t>(2 * pairs.size())};
  for (std::uint32_t& f : links.first) f = kNoIndex;
  for (std::uint32_t i = std::uint32_t(pairs.size()); i-- > 0;) {
    const std::uint32_t ends[2] = {pairs[i].a, pairs[i].b};
    for (std::uint32_t side = 0; side < 2; ++side) {
      if (ends[side] == ColoringPair::kNone) continue;
      std::uint32_t& first = links.first[ends[side]];
      links.next[2 * i + side] = first;
      first = 2 * i + side;
    }
  }
  return links;
}

std::span<std::uint32_t> find_kernel_positions(std::span<const std::uint32_t> order, std::size_t constraints,
                                               Arena& arena) {
  const std::span<std::uint32_t> positions = arena.make<std::uint32_t>(constraints);
  for (std::uint32_t i = 0; i < order.size(); ++i) {
    if (order[i] != kNoIndex) positions[order[i]] = i;
  }
  return positions;
}

}  // namespace gyre
