// The stage that keeps fast bodies from passing through things: lists those that moved far against their size, lets
// collision/continuous/continuous sweep them, and takes back what motion they may not keep.
#include "collision/continuous/continuous.h"
#include "math/rotation.h"
#include "rigid/continuous/ccd_joint_projection.h"
#include "rigid/rigid_step.h"
#include "rigid/store/shape_boxes.h"
#include "rigid/batch/surface_rules.h"
#include "task/parallel_filter.h"
#include "task/parallel.h"

#include <cmath>

namespace gyre {

namespace {

// The part of its way that a body in contact keeps whatever the sweep says.
constexpr float kMinProgress = 0.2f;
// How often bodies that follow others by joints are swept in turn.
constexpr int kMaxRounds = 4;

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

// The middle of mass as the body will be once its motion is done.
DVec3 middle_of(const RigidWorld& w, std::uint32_t body) {
  return w.bodies.poses[body].center + DVec3(w.bodies.motion[body].moved);
}

// Takes the speed with which a body goes on into what its core met: first by an impulse without bounce at the point where the
// core would have gone in, and then, if its middle still goes that way, by one through the middle. What is at rest or asleep is
// not moved by them.
class BodyImpulse {
 public:
  BodyImpulse(RigidWorld& w, std::uint32_t body, const SavedMotion& kept)
      : w_(w), bodies_{body, kept.other}, normal_(kept.impact_normal), at_(kept.impact_point) {}

  void take() {
    for (int k = 0; k < 2; ++k) lever_[k] = to_float(at_ - middle_of(w_, bodies_[k]));
    push();
    // Through the middle of the body that was stopped.
    lever_[0] = {};
    push();
  }

 private:
  bool is_moved(std::uint32_t i) const {
    return is_movable(w_.bodies.flags[i]) && w_.bodies.flags[i].awake != 0;
  }
  void push() {
    Vec3 turn[2];
    float mass = 0.0f, closing = 0.0f;
    for (int k = 0; k < 2; ++k) {
      const std::uint32_t i = bodies_[k];
      const BodyMotion& motion = w_.bodies.motion[i];
      const Vec3 speed = motion.linear_velocity + cross(motion.angular_velocity, lever_[k]);
      closing += (k == 0 ? 1.0f : -1.0f) * dot(speed, normal_);
      if (!is_moved(i)) continue;
      turn[k] = w_.bodies.inertia[i].inverse * cross(lever_[k], normal_);
      mass += motion.inverse_mass + dot(cross(turn[k], lever_[k]), normal_);
    }
    if (!(closing > 0.0f) || !(mass > 0.0f)) return;
    for (int k = 0; k < 2; ++k) {
      if (!is_moved(bodies_[k])) continue;
      BodyMotion& motion = w_.bodies.motion[bodies_[k]];
      const float impulse = (k == 0 ? -closing : closing) / mass;
      motion.linear_velocity += impulse * motion.inverse_mass * normal_;
      motion.angular_velocity += impulse * turn[k];
    }
  }

  RigidWorld& w_;
  std::uint32_t bodies_[2];
  Vec3 normal_;
  DVec3 at_;
  Vec3 lever_[2];
};

// A bound on the way that the farthest points of a body go in the step as seen from another one: that of its middle, and what
// its turning against the other adds. (A rotation differs from its first order by half the angle squared at most.)
float way_against(const RigidWorld& w, std::uint32_t seen_from, const Sweep& frame, std::uint32_t body) {
  const Sweep own = sweep_of_body(w.bodies, body);
  const Vec3 apart = difference(w.bodies.poses[body].center, w.bodies.poses[seen_from].center);
  return length(own.translation - frame.translation - cross(frame.rotation, apart)) +
         0.5f * length_squared(frame.rotation) * length(apart) +
         length(own.rotation - frame.rotation) * w.bodies.masses[body].bounding_radius;
}

// What moves by itself runs over what stands in its way, however slow that is: such bodies are fast against it, unless they go
// along. Where one of the two is a sensor and nothing can stop either, both are looked at for what they cross.
class Overrun {
 public:
  Overrun(const RigidWorld& w, ContinuousScratch& scratch) : w_(w), scratch_(scratch) {}

  void add_all() {
    scratch_.gates.clear();
    scratch_.listed.resize(w_.bodies.motion.size());
    for (const std::uint32_t i : w_.bodies.awake) {
      if (w_.bodies.flags[i].type != BodyType::kinematic || w_.bodies.shapes[i].empty()) continue;
      const Sweep sweep = sweep_of_body(w_.bodies, i);
      if (sweep.translation != Vec3{} || sweep.rotation != Vec3{}) add_those_before(i, sweep);
    }
  }

 private:
  void add_those_before(std::uint32_t i, const Sweep& sweep) {
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
          if (way_against(w_, i, sweep, other.body) > kFastShare * w_.bodies.masses[other.body].size)
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
    scratch_.fast.push_back(
        {body, w_.bodies.flags[body].continuous != 0, 0.0f, joints_of(w_.bodies, body).empty(), only_crosses});
  }

  const RigidWorld& w_;
  ContinuousScratch& scratch_;
  bool any_ = false;
};

std::size_t count_stopped_with_joints(const RigidWorld& w, const ContinuousScratch& scratch) {
  std::size_t count = 0;
  for (std::size_t k = 0; k < scratch.fast.size(); ++k)
    count += scratch.saved[k].fraction < 1.0f && !joints_of(w.bodies, scratch.fast[k].body).empty() ? 1 : 0;
  return count;
}

// Of two stopped bodies with a joint between them both keep what the one that is stopped first keeps.
void stop_together(const RigidWorld& w, const ContinuousScratch& scratch, std::span<SavedMotion> kept,
                   Arena& arena) {
  constexpr int kMaxPasses = 16;
  const std::span<std::uint32_t> place = arena.make<std::uint32_t>(w.bodies.motion.size());
  for (std::uint32_t& p : place) p = kNoIndex;
  for (std::uint32_t k = 0; k < kept.size(); ++k) {
    if (kept[k].fraction < 1.0f) place[scratch.fast[k].body] = k;
  }
  bool changed = true;
  for (int pass = 0; pass < kMaxPasses && changed; ++pass) {
    changed = false;
    for (std::size_t k = 0; k < kept.size(); ++k) {
      if (!(kept[k].fraction < 1.0f)) continue;
      const std::int32_t body = std::int32_t(scratch.fast[k].body);
      for (const std::uint32_t slot : joints_of(w.bodies, std::uint32_t(body))) {
        const JointRecord& joint = w.joints.records[slot];
        const std::int32_t other = joint.body_a == body ? joint.body_b : joint.body_a;
        if (other == kNoBody || place[std::size_t(other)] == kNoIndex || !constrains_position(w, slot)) continue;
        const float others = kept[place[std::size_t(other)]].fraction;
        changed = changed || others < kept[k].fraction;
        kept[k].fraction = min(kept[k].fraction, others);
      }
    }
  }
}

void list_fast_bodies(const RigidWorld& w, ContinuousScratch& scratch, Arena& arena, TaskSystem& tasks) {
  const ArenaScope scope(arena);
  scratch.fast.clear();
  const auto goes_fast = [&](std::uint32_t n) {
    const std::uint32_t i = w.bodies.awake[n];
    const BodyMotion& motion = w.bodies.motion[i];
    const BodyMass& mass = w.bodies.masses[i];
    return is_fast(motion.moved, motion.turned, mass.bounding_radius, mass.size) &&
           is_movable(w.bodies.flags[i]) && !w.bodies.shapes[i].empty();
  };
  for (const std::uint32_t n : parallel_filter(tasks, arena, w.bodies.awake.size(), goes_fast).list) {
    const std::uint32_t i = w.bodies.awake[n];
    // What contacts already act on must not be held in the air by a sweep: it keeps a part of its way, and they answer.
    const float least = w.bodies.flags[i].constraint_use != 0 ? kMinProgress : 0.0f;
    scratch.fast.push_back({i, w.bodies.flags[i].continuous != 0, least, joints_of(w.bodies, i).empty(), false});
  }
  Overrun(w, scratch).add_all();
}

// By shape: whether a contact may stop it.
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

// Leaves those out that stay in their fat boxes, in which nothing is that may stop them: most of what falls.
void leave_out_free(const RigidWorld& w, ContinuousScratch& scratch, Arena& arena, TaskSystem& tasks) {
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
  std::size_t kept = 0;
  for (std::size_t k = 0; k < fast.size(); ++k)
    if (!is_free(k)) fast[kept++] = fast[k];
  fast.resize(kept);
}

void list_moved_bodies(const RigidWorld& w, ContinuousScratch& scratch) {
  scratch.fast.clear();
  scratch.gates.clear();
  for (const std::uint32_t i : scratch.moved) {
    if (!w.bodies.shapes[i].empty())
      scratch.fast.push_back({i, w.bodies.flags[i].continuous != 0, 0.0f, false, false});
  }
}

// What the listed bodies keep of their ways: into scratch.kept.
void sweep_fast_bodies(const RigidWorld& w, ContinuousScratch& scratch, Arena& arena, TaskSystem& tasks) {
  // The shapes of each fast body as plain indices, in a place that is found by body.
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
  const auto passes = [&](std::uint32_t shape, Vec3 way) { return lets_pass(w, shape, way); };
  const FunctionRef<bool(std::uint32_t shape, Vec3 way)> one_way(passes);
  const KnownContacts contacts{w.contacts, w.touches.ccd_blockers, scratch.near_blockers};
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

// The angular velocity of a body that is turned back on its way, as its angular momentum asks for there: of what turns freely that is the one
// that it had. It never is more than its energy allows: what contacts gave on the way would turn a slender body much faster where it was
// before, and a stick that whirls along the ground would gain energy each time that it is stopped.
Vec3 spin_at(const BodyMass& mass, const BodyFlags& flags, Quat from, Quat to, Vec3 spin) {
  if (mass.isotropic != 0 || flags.locked_angular != 0 || spin == Vec3{}) return spin;
  const Vec3 own_spin = rotate_inverse(from, spin), own_momentum = mass.inertia * own_spin;
  const Vec3 momentum = rotate_inverse(to, rotate(from, own_momentum)),
             turned = mass.inverse_inertia * momentum;
  const float had = dot(own_spin, own_momentum), has = dot(turned, momentum);
  const float share = has > had ? std::sqrt(had / has) : 1.0f;
  return rotate(to, share * turned);
}

// Puts the listed bodies where they stay. Returns those that were stopped and hang on joints.
std::span<const HaltedBody> remove_error(RigidWorld& w, ContinuousScratch& scratch, Arena& arena) {
  const std::span<HaltedBody> stopped = arena.make<HaltedBody>(count_stopped_with_joints(w, scratch));
  std::size_t stopped_count = 0;
  if (!stopped.empty()) stop_together(w, scratch, scratch.saved, arena);
  for (std::size_t k = 0; k < scratch.fast.size(); ++k) {
    const std::uint32_t i = scratch.fast[k].body;
    const SavedMotion& kept = scratch.saved[k];
    if (!(kept.fraction < 1.0f)) continue;
    BodyMotion& motion = w.bodies.motion[i];
    if (!joints_of(w.bodies, i).empty())
      stopped[stopped_count++] = {i, kept.fraction, motion.moved, motion.turned};
    const Quat stopped_at = pose_at(sweep_of_body(w.bodies, i), double(kept.fraction)).orientation;
    const Quat end = w.bodies.orientations[i];
    w.bodies.orientations[i] =
        kept.rotation == Vec3{} ? stopped_at : integrate_rotation(stopped_at, kept.rotation);
    motion.angular_velocity = spin_at(w.bodies.masses[i], w.bodies.flags[i], end, w.bodies.orientations[i],
                                      motion.angular_velocity);
    motion.moved = kept.fraction * motion.moved + kept.slide;
    motion.turned = kept.fraction * motion.turned + kept.rotation;
    w.bodies.inertia[i] = world_inertia(w.bodies.masses[i], w.bodies.flags[i], w.bodies.orientations[i]);
    if (!(kept.impact_normal == Vec3{})) BodyImpulse(w, i, kept).take();
  }
  return stopped;
}

}  // namespace

void clamp_fast_bodies(RigidWorld& w, ContinuousScratch& scratch, const SolverKernels& kernels, Arena& arena,
                       TaskSystem& tasks) {
  list_fast_bodies(w, scratch, arena, tasks);
  if (!scratch.fast.empty()) {
    mark_near_blockers(w, scratch.near_blockers);
    leave_out_free(w, scratch, arena, tasks);
  }
  if (scratch.fast.empty() && scratch.gates.empty()) return;
  for (int round = 1; round <= kMaxRounds; ++round) {
    sweep_fast_bodies(w, scratch, arena, tasks);
    if (round == 1) report_crossings(w, scratch.collision.crossings());
    const std::span<const HaltedBody> stopped = remove_error(w, scratch, arena);
    if (stopped.empty()) return;
    // What hangs on those that were stopped comes after, on ways that have not been looked at.
    scratch.moved.clear();
    project_joints_after_ccd(w, stopped, round == kMaxRounds, kernels, tasks, scratch.moved, arena);
    list_moved_bodies(w, scratch);
    if (scratch.fast.empty()) return;
  }
}

}  // namespace gyre
