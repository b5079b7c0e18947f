// The stage of continuous collision detection: lists fast bodies, lets collision/continuous/continuous sweep
// them, and moves them back to their time of impact.
#include "collision/continuous/continuous.h"
#include "math/rotation.h"
#include "rigid/batch/surface_rules.h"
#include "rigid/continuous/ccd_joint_projection.h"
#include "rigid/rigid_step.h"
#include "rigid/store/shape_boxes.h"
#include "task/parallel.h"
#include "task/parallel_filter.h"

#include <cmath>

namespace gyre {

namespace {

// The fraction of its displacement that a constrained body keeps in any case.
constexpr float kMinProgress = 0.2f;
// Number of sweeps of bodies that joint projection has moved.
constexpr int kMaxRounds = 4;

// A shape that was inside as the step began has had its begin event, and its end is found with the next
// manifold update.
void report_crossings(RigidWorld& w, std::span<const std::uint64_t> crossings) {
  for (const std::uint64_t key : crossings) {
    const std::uint32_t sensor = std::uint32_t(key >> 32), visitor = std::uint32_t(key);
    const std::uint32_t slot = find_contact(w.contacts, pair_key(sensor, visitor));
    if (slot != SlotTable::kNone && w.contacts.contacts[slot].touching != 0) continue;
    w.events.sensors.push_back({shape_id(w, sensor), shape_id(w, visitor), true});
    w.events.sensors.push_back({shape_id(w, sensor), shape_id(w, visitor), false});
  }
}

// The centre of mass after the step.
DVec3 center_of_mass_of(const RigidWorld& w, std::uint32_t body) {
  return w.bodies.poses[body].center + DVec3(w.bodies.motion[body].delta_position);
}

// Removes the closing speed of a halted body against its blocker: first by an impulse without restitution at
// the point where the core would have entered, and then, if the centre still approaches, by one through the
// centre. Resting and sleeping bodies are not moved.
class BodyImpulse {
 public:
  BodyImpulse(RigidWorld& w, std::uint32_t body, const SavedMotion& result)
      : w_(w), bodies_{body, result.other}, normal_(result.impact_normal), at_(result.impact_point) {}

  void apply() {
    for (int k = 0; k < 2; ++k) lever_[k] = to_float(at_ - center_of_mass_of(w_, bodies_[k]));
    apply_impulse();
    // Through the centre of the halted body.
    lever_[0] = {};
    apply_impulse();
  }

 private:
  bool is_moved(std::uint32_t i) const {
    return is_movable(w_.bodies.flags[i]) && w_.bodies.flags[i].awake != 0;
  }
  void apply_impulse() {
    Vec3 spin[2];
    float mass = 0.0f, closing = 0.0f;
    for (int k = 0; k < 2; ++k) {
      const std::uint32_t i = bodies_[k];
      const BodyMotion& motion = w_.bodies.motion[i];
      const Vec3 speed = motion.linear_velocity + cross(motion.angular_velocity, lever_[k]);
      closing += (k == 0 ? 1.0f : -1.0f) * dot(speed, normal_);
      if (!is_moved(i)) continue;
      spin[k] = w_.bodies.inertia[i].inverse * cross(lever_[k], normal_);
      mass += motion.inverse_mass + dot(cross(spin[k], lever_[k]), normal_);
    }
    if (!(closing > 0.0f) || !(mass > 0.0f)) return;
    for (int k = 0; k < 2; ++k) {
      if (!is_moved(bodies_[k])) continue;
      BodyMotion& motion = w_.bodies.motion[bodies_[k]];
      const float impulse = (k == 0 ? -closing : closing) / mass;
      motion.linear_velocity += impulse * motion.inverse_mass * normal_;
      motion.angular_velocity += impulse * spin[k];
    }
  }

  RigidWorld& w_;
  std::uint32_t bodies_[2];
  Vec3 normal_;
  DVec3 at_;
  Vec3 lever_[2];
};

// A bound on the displacement of the farthest points of a body in the step relative to another body: that of
// its centre, plus the effect of relative rotation. (A rotation differs from its first order by at most half
// the angle squared.)
float relative_displacement_bound(const RigidWorld& w, std::uint32_t seen_from, const Sweep& frame,
                                  std::uint32_t body) {
  const Sweep own = sweep_of_body(w.bodies, body);
  const Vec3 apart = difference(w.bodies.poses[body].center, w.bodies.poses[seen_from].center);
  return length(own.translation - frame.translation - cross(frame.rotation, apart)) +
         0.5f * length_squared(frame.rotation) * length(apart) +
         length(own.rotation - frame.rotation) * w.bodies.masses[body].bounding_radius;
}

// Kinematic bodies run over bodies in their path, however slowly: such bodies are fast relative to them,
// unless they move along. If one of the two is a sensor and nothing can halt either, both are tested for
// crossings.
class Overrun {
 public:
  Overrun(const RigidWorld& w, ContinuousScratch& scratch) : w_(w), scratch_(scratch) {}

  void add_all() {
    scratch_.gates.clear();
    scratch_.listed.resize(w_.bodies.motion.size());
    for (const std::uint32_t i : w_.bodies.awake) {
      if (w_.bodies.flags[i].type != BodyType::kinematic || w_.bodies.shapes[i].empty()) continue;
      const Sweep sweep = sweep_of_body(w_.bodies, i);
      if (sweep.translation != Vec3{} || sweep.rotation != Vec3{}) add_bodies_in_path(i, sweep);
    }
  }

 private:
  void add_bodies_in_path(std::uint32_t i, const Sweep& sweep) {
    for (const ShapeId id : w_.bodies.shapes[i]) {
      const ColliderShape& shape = w_.shapes.colliders[id.index];
      if (shape.shape.kind == ShapeKind::plane) continue;
      scratch_.found.clear();
      w_.broadphase->query(w_.shapes.proxies, bounds_of_sweep(shape, sweep), scratch_.found);
      for (const std::uint32_t found : scratch_.found) {
        const Proxy &own = w_.shapes.proxies[id.index], &other = w_.shapes.proxies[found];
        if (!may_pair(own, other)) continue;
        const bool moves = is_movable(w_.bodies.flags[other.body]) && w_.bodies.flags[other.body].awake != 0;
        const bool surface = !is_convex(shape.shape.kind) && is_convex(w_.shapes.colliders[found].shape.kind);
        if (surface && own.sensor != other.sensor) scratch_.gates.push_back({found, id.index});
        if (moves) {
          if (relative_displacement_bound(w_, i, sweep, other.body) >
              kFastShare * w_.bodies.masses[other.body].size)
            add(other.body, false);
        } else if (own.sensor != other.sensor) {
          add(other.body, true);
          add(i, true);
        }
      }
    }
  }
  void add(std::uint32_t body, bool only_crosses) {
    if (!any_) {
      scratch_.listed.reset_all();
      for (const FastBody& fast : scratch_.fast) scratch_.listed.set(fast.body);
      any_ = true;
    }
    if (scratch_.listed.test(body)) return;
    scratch_.listed.set(body);
    scratch_.fast.push_back({body, w_.bodies.flags[body].continuous != 0, 0.0f,
                             joints_of(w_.bodies, body).empty(), only_crosses});
  }

  const RigidWorld& w_;
  ContinuousScratch& scratch_;
  bool any_ = false;
};

std::size_t count_halted_with_joints(const RigidWorld& w, const ContinuousScratch& scratch) {
  std::size_t count = 0;
  for (std::size_t k = 0; k < scratch.fast.size(); ++k)
    count += scratch.saved[k].fraction < 1.0f && !joints_of(w.bodies, scratch.fast[k].body).empty() ? 1 : 0;
  return count;
}

// Two halted bodies with a joint between them both keep the smaller fraction.
void halt_together(const RigidWorld& w, const ContinuousScratch& scratch, std::span<SavedMotion> results,
                   Arena& arena) {
  constexpr int kMaxPasses = 16;
  const std::span<std::uint32_t> index = arena.make<std::uint32_t>(w.bodies.motion.size());
  for (std::uint32_t& p : index) p = kNoIndex;
  for (std::uint32_t k = 0; k < results.size(); ++k) {
    if (results[k].fraction < 1.0f) index[scratch.fast[k].body] = k;
  }
  bool changed = true;
  for (int pass = 0; pass < kMaxPasses && changed; ++pass) {
    changed = false;
    for (std::size_t k = 0; k < results.size(); ++k) {
      if (!(results[k].fraction < 1.0f)) continue;
      const std::int32_t body = std::int32_t(scratch.fast[k].body);
      for (const std::uint32_t slot : joints_of(w.bodies, std::uint32_t(body))) {
        const JointRecord& joint = w.joints.records[slot];
        const std::int32_t other = joint.body_a == body ? joint.body_b : joint.body_a;
        if (other == kNoBody || index[std::size_t(other)] == kNoIndex || !constrains_position(w, slot))
          continue;
        const float others = results[index[std::size_t(other)]].fraction;
        changed = changed || others < results[k].fraction;
        results[k].fraction = min(results[k].fraction, others);
      }
    }
  }
}

void list_fast_bodies(const RigidWorld& w, ContinuousScratch& scratch, Arena& arena, TaskSystem& tasks) {
  const ArenaScope scope(arena);
  scratch.fast.clear();
  const auto is_moving_fast = [&](std::uint32_t n) {
    const std::uint32_t i = w.bodies.awake[n];
    const BodyMotion& motion = w.bodies.motion[i];
    const BodyMass& mass = w.bodies.masses[i];
    return is_fast(motion.delta_position, motion.delta_rotation, mass.bounding_radius, mass.size) &&
           is_movable(w.bodies.flags[i]) && !w.bodies.shapes[i].empty();
  };
  for (const std::uint32_t n : parallel_filter(tasks, arena, w.bodies.awake.size(), is_moving_fast).list) {
    const std::uint32_t i = w.bodies.awake[n];
    // A body with contacts must not be halted in the air: it keeps a part of its displacement, and the
    // contacts respond.
    const float min_fraction = w.bodies.flags[i].constraint_use != 0 ? kMinProgress : 0.0f;
    scratch.fast.push_back(
        {i, w.bodies.flags[i].continuous != 0, min_fraction, joints_of(w.bodies, i).empty(), false});
  }
  Overrun(w, scratch).add_all();
}

// By shape: whether a contact with it may be a blocker.
void mark_near_blockers(const RigidWorld& w, Bitset& near) {
  near.resize(w.shapes.colliders.size());
  near.reset_all();
  w.touches.ccd_blockers.for_each_set([&](std::size_t slot) {
    const Contact& contact = w.contacts.contacts[slot];
    if (contact.manifold_room == 0) return;
    near.set(contact.shape_a);
    near.set(contact.shape_b);
  });
}

// Removes bodies that stay in fat boxes without any blocker: most falling bodies.
void remove_unblocked(const RigidWorld& w, ContinuousScratch& scratch, Arena& arena, TaskSystem& tasks) {
  const ArenaScope scope(arena);
  Array<FastBody>& fast = scratch.fast;
  const std::span<std::uint32_t> bodies = arena.make<std::uint32_t>(fast.size());
  const std::span<bool> stay = arena.make<bool>(fast.size());
  for (std::size_t k = 0; k < fast.size(); ++k) bodies[k] = fast[k].body;
  for_blocks(tasks, int(fast.size()), kBodiesPerBlock, [&](int begin, int end, int) {
    const std::size_t first = std::size_t(begin), count = std::size_t(end - begin);
    find_within_fat_boxes(w, bodies.subspan(first, count), stay.subspan(first, count));
  });
  const auto is_free = [&](std::size_t k) {
    if (!stay[k] || fast[k].continuous || fast[k].only_crosses) return false;
    for (const ShapeId id : w.bodies.shapes[fast[k].body])
      if (scratch.near_blockers.test(id.index)) return false;
    return true;
  };
  std::size_t count = 0;
  for (std::size_t k = 0; k < fast.size(); ++k)
    if (!is_free(k)) fast[count++] = fast[k];
  fast.resize(count);
}

void list_moved_bodies(const RigidWorld& w, ContinuousScratch& scratch) {
  scratch.fast.clear();
  scratch.gates.clear();
  for (const std::uint32_t i : scratch.moved) {
    if (!w.bodies.shapes[i].empty())
      scratch.fast.push_back({i, w.bodies.flags[i].continuous != 0, 0.0f, false, false});
  }
}

// Sweeps the listed bodies; results go to scratch.saved.
void sweep_fast_bodies(const RigidWorld& w, ContinuousScratch& scratch, Arena& arena, TaskSystem& tasks) {
  // The shapes of each fast body as plain indices, by body.
  const std::span<std::span<const std::uint32_t>> shapes =
      arena.make<std::span<const std::uint32_t>>(w.bodies.motion.size());
  for (const FastBody& fast : scratch.fast) {
    const std::span<const ShapeId> ids = w.bodies.shapes[fast.body];
    const std::span<std::uint32_t> list = arena.make<std::uint32_t>(ids.size());
    for (std::size_t k = 0; k < ids.size(); ++k) list[k] = ids[k].index;
    shapes[fast.body] = list;
  }
  const auto sweep_of = [&](std::uint32_t body) { return sweep_of_body(w.bodies, body); };
  const auto shapes_of = [&](std::uint32_t body) { return shapes[body]; };
  const auto passes = [&](std::uint32_t shape, Vec3 direction) { return lets_pass(w, shape, direction); };
  const FunctionRef<bool(std::uint32_t shape, Vec3 direction)> one_way(passes);
  const KnownContacts contacts{w.contacts, w.touches.ccd_blockers, scratch.near_blockers,
                               w.internal_edges.hidden};
  const ContinuousInput input{w.shapes.colliders,
                              w.shapes.proxies,
                              *w.broadphase,
                              w.joints.blocked,
                              sweep_of,
                              shapes_of,
                              w.surface_rules.empty() ? nullptr : &one_way,
                              scratch.gates,
                              &contacts};
  scratch.saved.resize(scratch.fast.size());
  scratch.collision.clamp_fast_bodies(input, scratch.fast, tasks, scratch.saved);
}

// The angular velocity of a body that was moved back, from its angular momentum at the earlier orientation;
// for free rotation that is the velocity it had. Its energy must not grow: impulses of contacts on the way
// would spin a slender body much faster at its earlier orientation, and a fast-spinning stick on the ground
// would gain energy each time it is halted.
Vec3 spin_at(const BodyMass& mass, const BodyFlags& flags, Quat from, Quat to, Vec3 spin) {
  if (mass.isotropic != 0 || flags.locked_angular != 0 || spin == Vec3{}) return spin;
  const Vec3 own_spin = rotate_inverse(from, spin), own_momentum = mass.inertia * own_spin;
  const Vec3 momentum = rotate_inverse(to, rotate(from, own_momentum)),
             turned = mass.inverse_inertia * momentum;
  const float had = dot(own_spin, own_momentum), has = dot(turned, momentum);
  const float share = has > had ? std::sqrt(had / has) : 1.0f;
  return rotate(to, share * turned);
}

// Moves the halted bodies back. Returns those with joints.
std::span<const HaltedBody> halt_bodies(RigidWorld& w, ContinuousScratch& scratch, Arena& arena) {
  const std::span<HaltedBody> halted = arena.make<HaltedBody>(count_halted_with_joints(w, scratch));
  std::size_t halted_count = 0;
  if (!halted.empty()) halt_together(w, scratch, scratch.saved, arena);
  for (std::size_t k = 0; k < scratch.fast.size(); ++k) {
    const std::uint32_t i = scratch.fast[k].body;
    const SavedMotion& result = scratch.saved[k];
    if (!(result.fraction < 1.0f)) continue;
    BodyMotion& motion = w.bodies.motion[i];
    if (!joints_of(w.bodies, i).empty())
      halted[halted_count++] = {i, result.fraction, motion.delta_position, motion.delta_rotation};
    const Quat impact_orientation = pose_at(sweep_of_body(w.bodies, i), double(result.fraction)).orientation;
    const Quat end = w.bodies.orientations[i];
    w.bodies.orientations[i] = result.rotation == Vec3{}
                                   ? impact_orientation
                                   : integrate_rotation(impact_orientation, result.rotation);
    motion.angular_velocity = spin_at(w.bodies.masses[i], w.bodies.flags[i], end, w.bodies.orientations[i],
                                      motion.angular_velocity);
    motion.delta_position = result.fraction * motion.delta_position + result.slide;
    motion.delta_rotation = result.fraction * motion.delta_rotation + result.rotation;
    w.bodies.inertia[i] = world_inertia(w.bodies.masses[i], w.bodies.flags[i], w.bodies.orientations[i]);
    if (!(result.impact_normal == Vec3{})) BodyImpulse(w, i, result).apply();
  }
  return halted;
}

}  // namespace

void clamp_fast_bodies(RigidWorld& w, ContinuousScratch& scratch, const SolverKernels& kernels, Arena& arena,
                       TaskSystem& tasks) {
  list_fast_bodies(w, scratch, arena, tasks);
  if (!scratch.fast.empty()) {
    mark_near_blockers(w, scratch.near_blockers);
    remove_unblocked(w, scratch, arena, tasks);
  }
  if (scratch.fast.empty() && scratch.gates.empty()) return;
  for (int round = 1; round <= kMaxRounds; ++round) {
    sweep_fast_bodies(w, scratch, arena, tasks);
    if (round == 1) report_crossings(w, scratch.collision.crossings());
    const std::span<const HaltedBody> halted = halt_bodies(w, scratch, arena);
    if (halted.empty()) return;
    // Bodies connected to the halted ones follow, along paths that were not tested yet.
    scratch.moved.clear();
    project_joints_after_ccd(w, halted, round == kMaxRounds, kernels, tasks, scratch.moved, arena);
    list_moved_bodies(w, scratch);
    if (scratch.fast.empty()) return;
  }
}

}  // namespace gyre
