#include "rigid/rest/resting_islands.h"

#include "rigid/integrate/integrators.h"
#include "solver/rest/static_equilibrium.h"

namespace gyre {

namespace {

// What may be part of a resting island is no faster than a share of what it falls through its own size with,
struct RestSpeed {
  float speed, scale;

  RestSpeed(const RigidWorld& w, std::uint32_t body, float geometric_stiffness) {
    const BodyMotion& motion = w.bodies.motion[body];
    const float reach = w.bodies.masses[body].reach;
    speed = length(motion.linear_velocity) + reach * length(motion.angular_velocity);
    scale = std::sqrt(geometric_stiffness * reach);
  }
  bool is_below(float share) const { return speed <= share * scale; }
};
// and bound to no axes.
bool is_unbound(const RigidWorld& w, std::uint32_t body) {
  const BodyFlags& flags = w.bodies.flags[body];
  return !needs_exact_rotation(w.bodies, body, w.settings.last_substep) && flags.locked_linear == 0 &&
         flags.locked_angular == 0;
}

// The other end of a constraint may be the fixed world or a kinematic body that stands still.
bool is_still(const RigidWorld& w, std::int32_t body) {
  if (body == kNoBody) return true;
  const BodyMotion& motion = w.bodies.motion[body];
  return motion.linear_velocity == Vec3{} && motion.angular_velocity == Vec3{};
}

}  // namespace

RestingIslands::RestingIslands(const RigidWorld& w, std::span<const ContactConstraint> constraints,
                               std::span<const ColoringPair> pairs, std::span<const JointEdge> joints,
                               const SolveBatch& batch, std::span<const std::uint32_t> places, Arena& arena)
    : w_(w),
      batch_(batch),
      places_(places),
      sets_(arena.make<std::uint32_t>(batch.bodies.size())),
      counts_(arena.make<IslandCount>(batch.bodies.size())) {
  for (IslandCount& count : counts_) count = {};
  unite_all(pairs, joints);
  refuse_jointed(joints);
  count_bodies();
  count_contacts(constraints, pairs);
}

void RestingIslands::unite_all(std::span<const ColoringPair> pairs, std::span<const JointEdge> joints) {
  for (const ColoringPair& pair : pairs) {
    if (pair.a != ColoringPair::kNone && pair.b != ColoringPair::kNone) sets_.unite(pair.a, pair.b);
  }
  for (const JointEdge& joint : joints) {
    if (joint.body_a != kNoBody && joint.body_b != kNoBody)
      sets_.unite(places_[std::size_t(joint.body_a)], places_[std::size_t(joint.body_b)]);
  }
  sets_.flatten();
}

void RestingIslands::count_bodies() {
  const float geometric_stiffness = length(w_.settings.gravity);
  for (std::uint32_t place = 0; place < batch_.bodies.size(); ++place) {
    const std::uint32_t body = batch_.bodies[place];
    if (!is_movable(w_.bodies.flags[body])) continue;
    IslandCount& count = counts_[sets_.parents[place]];
    if (count.refused) continue;
    const RestSpeed slowness(w_, body, geometric_stiffness);
    const float reach = w_.bodies.masses[body].reach;
    count.smallest = count.bodies == 0 ? reach : min(count.smallest, reach);
    ++count.bodies;
    if (!is_unbound(w_, body) || !slowness.is_below(kSlowSpeedShare)) {
      count.refused = true;
    } else if (!slowness.is_below(kCalmSpeedShare)) {
      count.not_calm = true;
    } else if (!slowness.is_below(kSettledShare)) {
      count.settling = true;
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
    if (c.point_count < 3) count.balances = true;
    if (c.point_count == 1) ++count.corners;
    if (c.stiffness == ContactStiffness::rigid) count.held = true;
    if (c.stiffness == ContactStiffness::soft) count.springs = true;
    if (active_a && active_b) continue;
    ++count.grounded;
    count.first = i;
    if (!is_still(w_, active_a ? c.body_b : c.body_a)) count.refused = true;
  }
}

void RestingIslands::refuse_jointed(std::span<const JointEdge> joints) {
  for (const JointEdge& joint : joints)
    for_moving(joint, [&](std::uint32_t body) { counts_[sets_.parents[places_[body]]].refused = true; });
}

IncidentContacts link_incident_contacts(std::span<const ColoringPair> pairs, std::size_t bodies,
                                        Arena& arena) {
  IncidentContacts links{arena.make<std::uint32_t>(bodies), arena.make<std::uint32_t>(2 * pairs.size())};
  for (std::uint32_t& f : links.first) f = kNoPlace;
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

std::span<std::uint32_t> find_kernel_places(std::span<const std::uint32_t> order, std::size_t constraints,
                                            Arena& arena) {
  const std::span<std::uint32_t> places = arena.make<std::uint32_t>(constraints);
  for (std::uint32_t i = 0; i < order.size(); ++i) {
    if (order[i] != kNoPlace) places[order[i]] = i;
  }
  return places;
}

}  // namespace gyre
