// The stage that keeps fast bodies from passing through things: lists those that moved far against their size, lets
// collision/continuous sweep them, and takes back what motion they may not keep.
#include "collision/continuous.h"
#include "rigid/rigid_step.h"
#include "rigid/surface_rules.h"

namespace gyre {

namespace {

// The part of its way that a body in contact keeps whatever the sweep says.
constexpr float kLeastProgress = 0.2f;

Sweep sweep_of_body(const RigidWorld& w, std::uint32_t body) {
  const BodyMotion& motion = w.bodies.motion[body];
  const BodyFlags& flags = w.bodies.flags[body];
  const bool moves = flags.type != BodyType::fixed && flags.awake != 0 && flags.frozen == 0;
  return {origin_pose(w.bodies, body), w.bodies.masses[body].center, moves ? motion.moved : Vec3{}, moves ? motion.turned : Vec3{}};
}

// What was inside as the step began has been told to begin, and its end is seen when the contact is looked at again.
void report_crossings(RigidWorld& w, std::span<const std::uint64_t> crossings) {
  for (const std::uint64_t key : crossings) {
    const std::uint32_t sensor = std::uint32_t(key >> 32), visitor = std::uint32_t(key);
    const std::uint32_t slot = find_contact(w.contacts, pair_key(sensor, visitor));
    if (slot != SlotTable::kNone && w.contacts.contacts[slot].touching != 0) continue;
    w.events.sensors.push_back({shape_id(w, sensor), shape_id(w, visitor), true});
    w.events.sensors.push_back({shape_id(w, sensor), shape_id(w, visitor), false});
  }
}

}  // namespace

void clamp_fast_bodies(RigidWorld& w, ContinuousScratch& scratch, Arena& arena, TaskSystem& tasks) {
  scratch.fast.clear();
  for (const std::uint32_t i : w.bodies.awake) {
    if (!is_movable(w.bodies.flags[i]) || w.bodies.shapes[i].empty()) continue;
    const BodyMotion& motion = w.bodies.motion[i];
    const BodyMass& mass = w.bodies.masses[i];
    if (is_fast(motion.moved, motion.turned, mass.reach, mass.size)) {
      // What contacts already act on must not be held in the air by a sweep: it keeps a part of its way, and they answer.
      const float least = w.bodies.flags[i].touched != 0 ? kLeastProgress : 0.0f;
      scratch.fast.push_back({i, w.bodies.flags[i].continuous != 0, least});
    }
  }
  if (scratch.fast.empty()) return;
  // The shapes of each fast body as plain indices, in a place that is found by body.
  const std::span<std::span<const std::uint32_t>> shapes = arena.make<std::span<const std::uint32_t>>(w.bodies.motion.size());
  for (const FastBody& fast : scratch.fast) {
    const std::span<const ShapeId> ids = w.bodies.shapes[fast.body];
    const std::span<std::uint32_t> list = arena.make<std::uint32_t>(ids.size());
    for (std::size_t k = 0; k < ids.size(); ++k) list[k] = ids[k].index;
    shapes[fast.body] = list;
  }
  const auto sweep_of = [&](std::uint32_t body) { return sweep_of_body(w, body); };
  const auto shapes_of = [&](std::uint32_t body) { return shapes[body]; };
  const auto passes = [&](std::uint32_t shape, Vec3 way) { return lets_pass(w, shape, way); };
  const FunctionRef<bool(std::uint32_t shape, Vec3 way)> one_way(passes);
  const ContinuousInput input{w.shapes.colliders, w.shapes.proxies, *w.broadphase, w.joints.blocked, sweep_of, shapes_of,
                              w.surface_rules.empty() ? nullptr : &one_way};
  scratch.fractions.resize(scratch.fast.size());
  scratch.collision.clamp_fast_bodies(input, scratch.fast, tasks, scratch.fractions);
  report_crossings(w, scratch.collision.crossings());
  for (std::size_t k = 0; k < scratch.fast.size(); ++k) {
    const std::uint32_t i = scratch.fast[k].body;
    const float fraction = scratch.fractions[k];
    if (!(fraction < 1.0f)) continue;
    w.bodies.orientations[i] = pose_at(sweep_of_body(w, i), double(fraction)).orientation;
    w.bodies.motion[i].moved *= fraction;
    w.bodies.motion[i].turned *= fraction;
    w.bodies.inertia[i] = world_inertia(w.bodies.masses[i], w.bodies.flags[i], w.bodies.orientations[i]);
  }
}

}  // namespace gyre
