#include "rigid/rigid_step.h"

#include "base/container/sort.h"
#include "collision/broadphase/fat_box.h"
#include "collision/contact/internal_edges.h"
#include "collision/contact/pair_update.h"
#include "rigid/collision_bodies.h"
#include "rigid/sleep/island.h"
#include "rigid/store/shape_boxes.h"
#include "task/parallel.h"
#include "task/parallel_filter.h"

namespace gyre {

namespace {

PairShapes describe_pair(const RigidWorld& w, std::uint64_t key) {
  const std::uint32_t a = std::uint32_t(key >> 32), b = std::uint32_t(key);
  PairShapes pair;
  pair.body_a = w.shapes.bodies[a];
  pair.body_b = w.shapes.bodies[b];
  const auto is_mesh = [&](std::uint32_t shape) {
    const ShapeKind kind = w.shapes.colliders[shape].shape.kind;
    return kind == ShapeKind::mesh || kind == ShapeKind::height_field;
  };
  pair.against_mesh = is_mesh(a) || is_mesh(b);
  pair.sensor = w.shapes.proxies[a].sensor || w.shapes.proxies[b].sensor;
  pair.surface = combine_materials(w, w.shapes.materials[a], w.shapes.materials[b]);
  return pair;
}

// Bodies whose joint disables their collision stay close to each other, so their pairs are found whenever one of them
// moves.
void drop_blocked_pairs(const RigidWorld& w, Array<std::uint64_t>& keys, std::size_t from) {
  if (w.joints.blocked.empty()) return;
  std::size_t count = from;
  for (std::size_t i = from; i < keys.size(); ++i) {
    const std::uint64_t key = keys[i];
    const std::uint32_t a = w.shapes.bodies[std::uint32_t(key >> 32)],
                        b = w.shapes.bodies[std::uint32_t(key)];
    if (!w.joints.blocked.contains(pair_key(a, b))) keys[count++] = key;
  }
  keys.resize_uninitialized(count);
}

void report_begin(RigidWorld& w, const Contact& contact) {
  if (contact.sensor != 0) {
    const bool a_senses = w.shapes.proxies[contact.shape_a].sensor;
    const std::uint32_t sensor = a_senses ? contact.shape_a : contact.shape_b;
    const std::uint32_t visitor = a_senses ? contact.shape_b : contact.shape_a;
    w.events.sensors.push_back({shape_id(w, sensor), shape_id(w, visitor), true});
    return;
  }
  w.events.begins.push_back({shape_id(w, contact.shape_a), shape_id(w, contact.shape_b),
                             body_id(w, contact.body_a), body_id(w, contact.body_b)});
}

bool finite_state(const BodyMotion& motion, Quat orientation) {
  // A value that is not finite, minus itself, is not zero; nor is any sum that contains the difference.
  const Vec3 nothing = (motion.linear_velocity - motion.linear_velocity) +
                       (motion.angular_velocity - motion.angular_velocity) + (motion.delta_position - motion.delta_position);
  const float rotation = (orientation.x - orientation.x) + (orientation.y - orientation.y) +
                         (orientation.z - orientation.z) + (orientation.w - orientation.w);
  return nothing.x + nothing.y + nothing.z + rotation == 0.0f;
}

void list_marked(RigidWorld& w, std::span<const std::uint32_t> bodies) {
  for (const std::uint32_t i : bodies) {
    for (const ShapeId id : w.bodies.shapes[i]) {
      if (w.refit_marks[id.index] == 0) continue;
      w.refit_marks[id.index] = 0;
      w.shapes.changed.push_back(id.index);
    }
  }
}

// Fits a new fat box if the present one does not cover the motion of the shape in the coming step. True if it did.
bool ensure_fat_box_covers_motion(RigidWorld& w, std::uint32_t shape, float seconds) {
  const ShapeBox box = find_box(w, shape, seconds);
  const WorldBox needed = needed_box(box.tight, box.motion);
  Proxy& proxy = w.shapes.proxies[shape];
  if (contains(proxy.fat_box, needed)) return false;
  proxy.fat_box = fat_box(needed, box.motion);
  return true;
}

void list_if_moving(RigidWorld& w, std::uint32_t shape) {
  const BodyMotion& motion = w.bodies.motion[w.shapes.bodies[shape]];
  if (motion.linear_velocity != Vec3{} || motion.angular_velocity != Vec3{})
    w.shapes.moved_shapes.push_back(shape);
}

// Establishes the invariant of collision/broadphase/fat_box.h at the beginning of a step.
void ensure_fat_boxes_cover_motion(RigidWorld& w, TaskSystem& tasks, float seconds) {
  if (seconds > w.shapes.fat_box_horizon) {
    w.refit_marks.resize(w.shapes.colliders.size(), 0);
    for_blocks(tasks, int(w.bodies.awake.size()), kBodiesPerBlock, [&](int begin, int end, int) {
      for (int n = begin; n < end; ++n) {
        const std::uint32_t i = w.bodies.awake[n];
        for (const ShapeId id : w.bodies.shapes[i])
          w.refit_marks[id.index] = ensure_fat_box_covers_motion(w, id.index, seconds);
      }
    });
    list_marked(w, w.bodies.awake);
  } else {
    for (const std::uint32_t shape : w.shapes.moved_shapes) {
      // Frozen and disabled bodies have velocities, but the step does not move them.
      if (!w.shapes.ids.live(shape) || !is_simulated(w.bodies.flags[w.shapes.bodies[shape]])) continue;
      if (ensure_fat_box_covers_motion(w, shape, seconds)) w.shapes.changed.push_back(shape);
    }
  }
  w.shapes.fat_box_horizon = seconds;
  w.clocks.moved_shapes.trim(w.shapes.moved_shapes, w.shapes.moved_shapes.size());
  w.shapes.moved_shapes.clear();
}

// Returns a body with a state that is not finite to its last pose and freezes it there. Its contacts and joints lose
// their impulses: a NaN would spread to other bodies, and its bits differ between processors.
void freeze(RigidWorld& w, std::uint32_t body) {
  w.bodies.motion[body] = {};
  w.bodies.orientations[body] = w.bodies.poses[body].orientation;
  w.bodies.flags[body].frozen = kFrozen;
  w.bodies.inertia[body] = {};
  w.bodies.awake_stale = true;
  for_each_contact_of_body(w, body, [&](std::uint32_t slot) {
    Contact& contact = w.contacts.contacts[slot];
    for (Manifold& manifold : manifolds_of(w.contacts, contact)) manifold = {};
    contact.manifold_count = 0;
    invalidate_cache(contact);
  });
  for (const std::uint32_t slot : joints_of(w.bodies, body)) {
    clear_impulses(w.joints.records[slot]);
    if (JointDetail* const detail = detail_of(w.joints, slot)) clear_impulses(*detail);
  }
}

// Lists the CCD blockers among the contacts of a body that woke after the narrow phase.
void collect_ccd_blockers(RigidWorld& w, std::uint32_t body) {
  for_each_contact_of_body(w, body, [&](std::uint32_t slot) {
    if (blocks_fast_bodies(w.contacts.contacts[slot], w.shapes.proxies)) w.touches.ccd_blockers.set(slot);
  });
}

}  // namespace

void sort_changed(Array<std::uint32_t>& changed, Array<std::uint64_t>& keys, Array<std::uint64_t>& scratch) {
  // The list is usually in order if only steps appended to it.
  bool rises = true;
  for (std::size_t i = 1; i < changed.size() && rises; ++i) rises = changed[i - 1] < changed[i];
  if (rises) return;
  keys.clear();
  for (const std::uint32_t shape : changed) keys.push_back(shape);
  scratch.resize_uninitialized(keys.size());
  radix_sort_u64(keys, scratch);
  changed.clear();
  for (std::size_t i = 0; i < keys.size(); ++i) {
    if (i == 0 || keys[i] != keys[i - 1]) changed.push_back(std::uint32_t(keys[i]));
  }
}

void refit_shape(RigidWorld& w, std::uint32_t shape, float seconds) {
  const ShapeBox box = find_box(w, shape, seconds);
  w.shapes.proxies[shape].fat_box = fat_box(needed_box(box.tight, box.motion), box.motion);
  w.shapes.changed.push_back(shape);
}

void mark_moved(RigidWorld& w, std::uint32_t body) {
  for (const ShapeId id : w.bodies.shapes[body]) list_if_moving(w, id.index);
}

void refit_placed_shape(RigidWorld& w, std::uint32_t shape) {
  refit_shape(w, shape, 0.0f);
  list_if_moving(w, shape);
}

void report_end(RigidWorld& w, const Contact& contact) {
  if (contact.touching == 0) return;
  if (contact.sensor != 0) {
    const bool a_senses = w.shapes.proxies[contact.shape_a].sensor;
    const std::uint32_t sensor = a_senses ? contact.shape_a : contact.shape_b;
    const std::uint32_t visitor = a_senses ? contact.shape_b : contact.shape_a;
    w.events.sensors.push_back({shape_id(w, sensor), shape_id(w, visitor), false});
    return;
  }
  w.events.ends.push_back({shape_id(w, contact.shape_a), shape_id(w, contact.shape_b)});
}

void refit(RigidWorld& w, TaskSystem& tasks, float seconds) {
  ensure_fat_boxes_cover_motion(w, tasks, seconds);
  sort_changed(w.shapes.changed, w.new_pairs, w.sort_scratch);
  if (w.broadphase_stale) {
    w.broadphase->rebuild(w.shapes.proxies);
    w.broadphase_stale = false;
  } else if (!w.shapes.changed.empty()) {
    w.broadphase->update(w.shapes.proxies, w.shapes.changed);
  }
}

std::size_t find_pairs(RigidWorld& w, TaskSystem& tasks) {
  w.new_pairs.clear();
  if (!w.shapes.changed.empty()) {
    const auto keep_new = [&](Array<std::uint64_t>& keys, std::size_t from) {
      drop_known_pairs(w.contacts, keys, from);
      drop_blocked_pairs(w, keys, from);
    };
    w.broadphase->find_pairs(w.shapes.proxies, w.shapes.changed, keep_new, tasks, w.new_pairs);
  }
  const std::size_t found = w.new_pairs.size();
  add_pairs(w.contacts, w.new_pairs, w.joints.blocked,
            [&](std::uint64_t key) { return describe_pair(w, key); });
  find_active_constraints(w);
  w.clocks.changed.trim(w.shapes.changed, w.shapes.changed.size());
  w.shapes.changed.clear();
  w.broadphase->trim();
  w.clocks.new_pairs.trim(w.new_pairs, found);
  w.clocks.sort_scratch.trim(w.sort_scratch, w.sort_scratch.size());
  w.new_pairs.clear();
  w.sort_scratch.clear();
  return found;
}

void collide_pairs(RigidWorld& w, Arena& arena, TaskSystem& tasks, RecycleContacts recycle_contacts,
                   float seconds) {
  const ArenaScope scope(arena);
  CollisionBodies bodies(w, arena, seconds);
  bodies.make(tasks, arena);
  const CollideInput input{w.shapes.colliders, bodies.collision_bodies(), bodies.centers(),
                           bodies.awake(),     w.shapes.proxies,          w.active_constraints.contacts,
                           recycle_contacts};
  collide(w.contacts, input, tasks, w.touches);
  remove_internal_edge_contacts(w.contacts, input, w.touches.on_static, arena, tasks, w.internal_edges);
}

void link_islands(RigidWorld& w) {
  w.touches.ended.for_each_set([&](std::size_t slot) {
    // `touching` has the new state already; an ended contact touched before.
    Contact ended = w.contacts.contacts[slot];
    ended.touching = 1;
    report_end(w, ended);
  });
  w.touches.began.for_each_set([&](std::size_t slot) { report_begin(w, w.contacts.contacts[slot]); });
  remove_gone(w.contacts, w.touches.gone, [](std::uint32_t, const Contact&) {});
  const std::size_t first_woken = w.events.sleep_changes.size();
  wake_touched(w);
  refresh_awake(w.bodies);
  for (std::size_t i = first_woken; i < w.events.sleep_changes.size(); ++i)
    collect_ccd_blockers(w, w.events.sleep_changes[i].body.index);
}

void finish_bodies(RigidWorld& w, Arena& arena, TaskSystem& tasks, float seconds,
                   Array<std::uint32_t>& frozen, bool last) {
  const ArenaScope scope(arena);
  BodyStore& bodies = w.bodies;
  const auto is_not_finite = [&](std::uint32_t n) {
    const std::uint32_t i = bodies.awake[n];
    return !finite_state(bodies.motion[i], bodies.orientations[i]);
  };
  for (const std::uint32_t n : parallel_filter(tasks, arena, bodies.awake.size(), is_not_finite).list)
    frozen.push_back(bodies.awake[n]);
  for (const std::uint32_t i : frozen) freeze(w, i);
  refresh_awake(bodies);
  w.refit_marks.resize(w.shapes.colliders.size(), 0);
  const std::span<const std::uint32_t> awake = bodies.awake;
  const auto block_at = [&](std::size_t begin) {
    return awake.subspan(begin, min(awake.size() - begin, std::size_t(kBodiesPerBlock)));
  };
  const std::span<bool> marked =
      arena.make<bool>(std::size_t(count_blocks(int(awake.size()), kBodiesPerBlock)));
  for_blocks(tasks, int(awake.size()), kBodiesPerBlock, [&](int begin, int, int) {
    const std::span<const std::uint32_t> block = block_at(std::size_t(begin));
    for (const std::uint32_t i : block) {
      bodies.poses[i].center += bodies.motion[i].delta_position;
      bodies.poses[i].orientation = bodies.orientations[i];
      if (last) {
        bodies.forces[i].force = {};
        bodies.forces[i].torque = {};
      }
    }
    marked[std::size_t(begin / kBodiesPerBlock)] = refit_boxes(w, block, seconds);
  });
  for (std::size_t i = 0; i < marked.size(); ++i) {
    if (marked[i]) list_marked(w, block_at(i * kBodiesPerBlock));
  }
  w.shapes.fat_box_horizon = seconds;
}

void break_joints(RigidWorld& w, float seconds) {
  const auto moves = [&](std::int32_t body) {
    return body != kNoBody && is_simulated(w.bodies.flags[std::size_t(body)]);
  };
  w.active_constraints.joints.for_each_set([&](std::size_t number) {
    const auto slot = std::uint32_t(number);
    if (!w.joints.ids.live(slot)) return;
    const JointRecord& joint = w.joints.records[slot];
    if (joint.break_force <= 0.0f && joint.break_torque <= 0.0f) return;
    // A sleeping joint keeps the impulses of the step in which it fell asleep; it withstood those.
    if (!moves(joint.body_a) && !moves(joint.body_b)) return;
    const float force = length(joint.total_linear) / seconds;
    const float torque = length(joint.total_angular) / seconds;
    if ((joint.break_force > 0.0f && force > joint.break_force) ||
        (joint.break_torque > 0.0f && torque > joint.break_torque)) {
      w.events.broken.push_back({joint_id(w, slot), force, torque});
    }
  });
}

}  // namespace gyre
