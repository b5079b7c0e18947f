// The rigid part of a world: bodies, shapes, joints, contacts, fields and their settings.
#pragma once

#include "base/arena/arena.h"
#include "base/arena/shrink_policy.h"
#include "base/container/flat_map.h"
#include "collision/broadphase/broadphase.h"
#include "collision/contact/collide.h"
#include "collision/contact/contact_store.h"
#include "collision/contact/internal_edges.h"
#include "math/standard_gravity.h"
#include "rigid/store/active_constraints.h"
#include "rigid/store/body_store.h"
#include "rigid/store/coupling_record.h"
#include "rigid/store/field_record.h"
#include "rigid/store/shape_store.h"
#include "rigid/store/solver_settings.h"
#include "solver/joint/joint.h"

#include <gyre/events.h>

#include <memory>

namespace gyre {

struct JointStore {
  IdPool ids;
  Array<JointRecord> records;
  Array<JointDetail> details;    // by slot, shorter than the records: most joints have none
  Array<PathPoint> path_points;  // of all paths, one after the other
  FlatMap<std::uint32_t>
      blocked;  // body pair key -> number of joints and ignored pairs that disable the collision of the two; derived
};

// Data of the joint beyond its record; null if there is none.
inline const JointDetail* detail_of(const JointStore& joints, std::uint32_t slot) {
  return slot < joints.details.size() && joints.details[slot].used ? &joints.details[slot] : nullptr;
}
inline JointDetail* detail_of(JointStore& joints, std::uint32_t slot) {
  return slot < joints.details.size() && joints.details[slot].used ? &joints.details[slot] : nullptr;
}
// Prefetches the start of the records of a joint. Records are long, and loops visit many of them.
inline void fetch_joint(const JointStore& joints, std::uint32_t slot) {
  if (slot < joints.records.size()) __builtin_prefetch(&joints.records[slot]);
  if (slot < joints.details.size()) __builtin_prefetch(&joints.details[slot]);
}
inline std::span<const PathPoint> path_of(const JointStore& joints, const JointDetail& detail) {
  return joints.path_points.view().subspan(detail.path_first, detail.path_count);
}

struct RigidSettings {
  Vec3 gravity{0, -9.81f, 0};
  std::int32_t substeps = 4;
  std::uint8_t sleeping = 1;
  CombineRule friction_rule = CombineRule::geometric_mean;
  CombineRule restitution_rule = CombineRule::maximum;
  std::uint8_t spare = 0;
  float last_substep = 0.0f;  // s; the warm start is scaled by the change of the sub-step
  float last_step = 0.0f;     // s
};

// The acceleration by which speeds are judged: that of gravity, and where the world has none, that of the Earth's.
inline float reference_gravity(const RigidSettings& settings) {
  const float gravity = length(settings.gravity);
  return gravity > 0.0f ? gravity : float(kEarthGravity);
}

// The world's sleep speed, as a share of sqrt(gravity * bounding radius), the natural speed of a body.
constexpr float kSleepSpeedShare = 0.015f;
// Two bodies that ignore each other, by the user's wish.
struct IgnoredPair {
  std::uint32_t a = 0, b = 0;  // a < b
};

struct SleepSettings {
  float share = kSleepSpeedShare;
};

// The events of the present step, before they are published.
struct RigidEvents {
  Array<ContactBegin> begins;
  Array<ContactEnd> ends;
  Array<ContactHit> hits;
  Array<SensorTouch> sensors;
  Array<JointBroken> broken;
  Array<SleepChange> sleep_changes;
};

// Shrink policies of the arrays that only busy steps fill.
struct ScratchClocks {
  ShrinkPolicy changed, moved_shapes, new_pairs, sort_scratch;
  ShrinkPolicy begins, ends, hits, sensors, broken, sleep_changes;
};

// The effect of fields on a body in a step, for the sleep test. By body; empty in worlds without fields.
constexpr std::uint8_t kNoFields = 0, kFieldsAndConstraints = 1, kFieldsOnly = 2;
struct FieldRest {
  Vec3 linear, angular;            // velocity as the step began
  std::uint8_t acts = kNoFields;   // kNoFields, kFieldsAndConstraints or kFieldsOnly
  std::uint8_t is_unsteady = 0;    // a field with time-dependent forces acts
};

struct RigidWorld {
  BodyStore bodies;
  ShapeStore shapes;
  JointStore joints;
  ContactStore contacts;
  Array<MaterialPair> material_pairs;  // sorted by (a, b), a <= b
  Array<SurfaceRule> surface_rules;    // sorted by id
  Array<FieldRecord> fields;           // by slot
  RigidSettings settings;
  Array<MotionSettings> motion_settings;  // one record, or none for the defaults
  Array<SolverSettings> solver;           // one record, or none for the default solver
  Array<SleepSettings> sleep_settings;    // one record, or none for the default share

  // Derived, or valid for one step only.
  std::unique_ptr<Broadphase> broadphase;
  bool broadphase_stale = true;        // must be rebuilt from all proxies
  ActiveConstraints active_constraints;
  TouchChanges touches;
  InternalEdgeScratch internal_edges;  // contacts at internal edges in the last step
  Array<std::uint64_t> new_pairs;
  Array<std::uint64_t> sort_scratch;
  Array<std::uint32_t> listed;  // working memory: contacts of one shape
  std::uint64_t steps = 0;      // steps done so far; some searches run only every n-th step
  double now = 0.0;             // s, at the beginning of the step; for fields that depend on time
  Array<FieldRest> field_rest;
  Array<std::uint8_t> refit_marks;  // by shape: 1 if it got a new fat box in this step
  RigidEvents events;
  ScratchClocks clocks;
  Array<std::uint8_t>
      inactive_contacts;  // by contact: not 0 if it does not act (rigid/time/toi_stepping.h); empty unless the step is adaptive
  std::uint16_t world_number = 0;  // part of the ids in events
  // Part of the state, like the columns at the beginning.
  Array<IgnoredPair> ignored_pairs;  // sorted by (a, b)
  Array<CouplingRecord> couplings;   // by slot
  Array<FieldGrid> field_grids;      // by slot of field; short if later fields have none
  Array<FieldVector> field_vectors;  // of all grids, one after the other
};

inline MotionSettings motion_settings(const RigidWorld& w) {
  return w.motion_settings.empty() ? MotionSettings{} : w.motion_settings[0];
}

inline float sleep_share(const RigidWorld& w) {
  return w.sleep_settings.empty() ? kSleepSpeedShare : w.sleep_settings[0].share;
}

inline BodyId body_id(const RigidWorld& w, std::uint32_t body) {
  return {body, std::uint16_t(w.bodies.ids.generation(body)), w.world_number};
}
// Calls fn(slot) for each contact of a body, in no particular order; fn must not add or remove contacts.
template <class Fn>
void for_each_contact_of_body(const RigidWorld& w, std::uint32_t body, Fn&& fn) {
  for (const ShapeId id : w.bodies.shapes[body]) for_each_contact_of_shape(w.contacts, id.index, fn);
}
inline ShapeId shape_id(const RigidWorld& w, std::uint32_t shape) {
  return {shape, std::uint16_t(w.shapes.ids.generation(shape)), w.world_number};
}
inline JointId joint_id(const RigidWorld& w, std::uint32_t joint) {
  return {joint, std::uint16_t(w.joints.ids.generation(joint)), w.world_number};
}

// True if the joint acts: neither it nor one of its bodies is disabled.
inline bool is_joint_enabled(const RigidWorld& w, std::uint32_t slot) {
  const JointDetail* const detail = detail_of(w.joints, slot);
  if (detail != nullptr && detail->disabled) return false;
  const JointRecord& joint = w.joints.records[slot];
  const auto is_off = [&](std::int32_t body) {
    return body != kNoBody && is_disabled(w.bodies.flags[std::size_t(body)]);
  };
  return !is_off(joint.body_a) && !is_off(joint.body_b);
}

// Calls fn(body) for a moving body of each joint of a coupling.
template <class Fn>
void for_each_body_of_coupling(const RigidWorld& w, const CouplingRecord& coupling, Fn&& fn) {
  for (std::uint32_t i = 0; i < coupling.count; ++i) {
    const JointRecord& joint = w.joints.records[coupling.joints[i]];
    const auto moves = [&](std::int32_t body) {
      return body != kNoBody && is_movable(w.bodies.flags[std::size_t(body)]);
    };
    if (moves(joint.body_b)) {
      fn(std::uint32_t(joint.body_b));
    } else if (moves(joint.body_a)) {
      fn(std::uint32_t(joint.body_a));
    }
  }
}
// True if all joints of the coupling act.
inline bool is_coupling_enabled(const RigidWorld& w, const CouplingRecord& coupling) {
  if (!coupling.is_live()) return false;
  for (std::uint32_t i = 0; i < coupling.count; ++i)
    if (!is_joint_enabled(w, coupling.joints[i])) return false;
  return true;
}

// The surface of a pair of shapes, from the table of pairs or by the combine rules.
ContactSurface combine_materials(const RigidWorld& w, const Material& a, const Material& b);

}  // namespace gyre
