#include "rigid/solve/hit_events.h"

#include "base/container/sort.h"
#include "rigid/batch/surface_rules.h"
#include "task/parallel_filter.h"

namespace gyre {

namespace {

// A contact is reported as a hit if it closes faster than this share of sqrt(gravity * size).
constexpr float kHitShare = 0.3f;

float hit_speed(const RigidWorld& w, const Contact& contact) {
  return kHitShare * std::sqrt(reference_gravity(w.settings) * contact.size);
}

// `struck`: the point that closed fastest.
ContactHit make_hit(const RigidWorld& w, const Contact& contact, const Manifold& manifold,
                    const ContactPointState& struck, float impulse) {
  const DVec3 place = w.bodies.poses[contact.body_a].center + struck.from_a;
  return {shape_id(w, contact.shape_a),
          shape_id(w, contact.shape_b),
          body_id(w, contact.body_a),
          body_id(w, contact.body_b),
          place,
          manifold.normal,
          struck.approach_speed,
          impulse,
          triangle_at(w, contact, place)};
}

}  // namespace

bool record_hit_approach(const RigidWorld& w, const Contact& contact, Manifold& manifold) {
  float fastest = 0.0f;
  for (int k = 0; k < manifold.count; ++k) {
    ContactPointState& point = manifold.points[k];
    point.approach_speed = 0.0f;
    if (point.normal_impulse > 0.0f) continue;
    point.approach_speed =
        dot(manifold.normal, point_velocity(w.bodies.motion[contact.body_a], point.from_a) -
                                 point_velocity(w.bodies.motion[contact.body_b], point.from_b));
    fastest = max(fastest, point.approach_speed);
  }
  return fastest > 0.0f && fastest > hit_speed(w, contact);
}

void find_hits(const RigidWorld& w, const ContactLists& contacts, Array<SlotHit>& hits, Arena& arena,
               TaskSystem& tasks) {
  const ArenaScope scope(arena);
  const auto came_fast = [&](std::uint32_t i) { return contacts.constraints[i].fast; };
  for (const std::uint32_t i : parallel_filter(tasks, arena, contacts.constraints.size(), came_fast).list) {
    const Contact& contact = w.contacts.contacts[contacts.slots[i]];
    const Manifold& manifold = *contacts.constraints[i].manifold;
    float fastest = hit_speed(w, contact);
    const ContactPointState* struck = nullptr;
    float impulse = 0.0f;
    for (int k = 0; k < manifold.count; ++k) {
      const ContactPointState& point = manifold.points[k];
      impulse += point.total_impulse;
      if (!(point.total_impulse > 0.0f) || !(point.approach_speed > fastest)) continue;
      fastest = point.approach_speed;
      struck = &point;
    }
    if (struck == nullptr) continue;
    hits.push_back({contacts.slots[i], make_hit(w, contact, manifold, *struck, impulse)});
  }
}

void report_hit(RigidWorld& w, const Contact& contact, const Manifold& manifold, float impulse) {
  const ContactPointState* struck = nullptr;
  for (int k = 0; k < manifold.count; ++k) {
    const ContactPointState& point = manifold.points[k];
    if (struck == nullptr || point.approach_speed > struck->approach_speed) struck = &point;
  }
  if (struck != nullptr) w.events.hits.push_back(make_hit(w, contact, manifold, *struck, impulse));
}

void report_hits(RigidWorld& w, std::span<SlotHit> hits, Arena& arena) {
  const ArenaScope scope(arena);
  merge_sort(hits, arena.make<SlotHit>(hits.size()),
             [](const SlotHit& a, const SlotHit& b) { return a.slot < b.slot; });
  for (const SlotHit& hit : hits) w.events.hits.push_back(hit.hit);
}

}  // namespace gyre
