// Rigid bodies as columns, indexed by the slot of the id. Hot: the 64-byte motion record. Warm: poses, masses,
// forces. Cold: lists, overrides, user data.
//
// The state of a body is the position of its centre of mass (double), its orientation and its two velocities; the
// pose of its origin is derived. Slots never move, so an index of a body stays valid; `awake` has no sleeping bodies.
//
// The columns that hold the pose, by stage of world/step.cpp. The deltas are delta position and rotation in `motion`.
//
//   between steps, stages 1 to 4   poses; orientations equal theirs; the deltas are those of the last step
//   collide (3)                    also copies of poses for active contacts (rigid/collision_bodies.h), for this stage
//   solve (5), at its beginning    the deltas are zero; from now on a centre is that of poses + delta position
//   solve, in a sub-step           the deltas are new; the orientation is that of poses, rotated by the delta.
//                                  Motion blocks (solver/motion/motion_block.h) hold it and write it to orientations
//                                  and inertia of bodies whose pose is read. Fast-spinning bodies have it in
//                                  orientations only
//   solve, SIMD joints             copies of orientations and delta positions, new in each sub-step
//   solve, at its end              all orientations and inertia are new; poses are those of the beginning of the step
//   clamp_fast_bodies (6)          deltas and orientations of halted bodies return to the time of impact
//   finish_bodies (7)              poses take centres and orientations; from now on poses are valid
#pragma once

#include "base/container/array.h"
#include "base/container/interned_column.h"
#include "base/container/slot_map.h"
#include "base/container/small_array.h"
#include "collision/continuous/time_of_impact.h"
#include "rigid/store/motion_settings.h"
#include "solver/core/body_motion.h"

#include <gyre/defs.h>

#include <span>

namespace gyre {

// The position of the centre of mass and the orientation of a body.
struct BodyPose {
  DVec3 center;
  Quat orientation;  // world_from_body
};

// Mass and inertia about the centre of mass, in the frame of the body. Zero for static and kinematic bodies.
struct BodyMass {
  float mass = 0.0f;
  float inverse_mass = 0.0f;
  Vec3 center;              // body frame
  Sym3 inertia;             // kg m^2
  Sym3 inverse_inertia;     // without locked axes: those are removed in the world frame
  float bounding_radius = 0.0f;  // m, farthest point of any shape from the centre of mass
  float size = 0.0f;             // m, inner radius of the thinnest shape; tolerances scale with it
  std::uint32_t isotropic = 0;  // 1 when all principal moments are equal: no gyroscopic effect
};

// Forces on a body, damping and gravity scale.
struct BodyForces {
  Vec3 force;   // N, accumulated for the next step
  Vec3 torque;  // N m
  float linear_damping = 0.0f;
  float angular_damping = 0.0f;
  float gravity_scale = 1.0f;
};

// Values of BodyFlags::constraint_use in a step: no constraint acts; constraints or fields act; these also read the
// pose in each sub-step.
constexpr std::uint8_t kNotConstrained = 0, kConstrained = 1, kPoseRead = 2;

// Values of BodyFlags::frozen: the state stopped being finite, so the body no longer moves; or the user disabled the body, so its shapes are
// in no broad phase and its joints idle.
constexpr std::uint8_t kNotFrozen = 0, kFrozen = 1, kDisabled = 2;

struct BodyFlags {
  BodyType type = BodyType::fixed;
  std::uint8_t awake = 0;
  std::uint8_t can_sleep = 1;
  std::uint8_t continuous = 0;
  std::uint8_t frozen = kNotFrozen;
  std::uint8_t locked_linear = 0;   // bits 0 to 2: world x, y, z
  std::uint8_t locked_angular = 0;
  std::uint8_t constraint_use = 0;  // in the last step: kNotConstrained, kConstrained or kPoseRead
};

constexpr std::uint32_t kNoGroup = 0xffffffffu;

struct BodySleep {
  float still_time = 0.0f;             // s
  std::uint32_t group = kNoGroup;      // lowest body of the sleeping island; kNoGroup: awake or fixed
  std::uint32_t next_in_group = 0;     // ring of the group
};

// The sleep speed that the user gave a body.
struct BodySleepSpeed {
  float speed = 0.0f;  // m/s; 0: that of the world
};

// Mass properties that the user set instead of those of the shapes.
struct BodyOverrides {
  std::uint8_t has_mass = 0, has_center = 0, has_inertia = 0;
  float mass = 0.0f;
  Vec3 center;
  Sym3 inertia;
};

inline auto interning_key(const BodyMass& m) {
  static_assert(sizeof(BodyMass) == 80, "every field is among the bits");
  return words_of(m.mass, m.inverse_mass, m.center, m.inertia, m.inverse_inertia, m.bounding_radius, m.size,
                  m.isotropic);
}
inline auto interning_key(const BodyOverrides& o) {
  static_assert(sizeof(BodyOverrides) == 44, "every field is among the bits");
  const std::uint32_t has = std::uint32_t(o.has_mass) | std::uint32_t(o.has_center) << 8 | std::uint32_t(o.has_inertia) << 16;
  return words_of(has, o.mass, o.center, o.inertia);
}

struct BodyStore {
  IdPool ids;
  Array<BodyMotion> motion;
  Array<BodyInertia> inertia;  // world axes, at the present orientation; derived
  Array<BodyPose> poses;
  Array<Quat>
      orientations;  // a copy for the gathers of the solver; equals poses[i].orientation between steps
  InternedColumn<BodyMass> masses;
  Array<BodyForces> forces;
  Array<BodyFlags> flags;
  Array<BodySleep> sleep;
  InternedColumn<BodyOverrides> overrides;
  Array<std::uint64_t> user_data;
  Array<LastMove> last_moves;                   // by slot; empty unless the integrator is verlet
  Array<BodySleepSpeed> sleep_speeds;           // by slot; empty or short if no later body has its own: read with sleep_speed_of()
  Array<SmallArray<ShapeId, 1>> shapes;         // by body, ascending index; derived
  // By body, ascending index; derived. Shorter than the number of bodies, since most worlds have few joints: read
  // with joints_of().
  Array<SmallArray<std::uint32_t, 2>> joints;
  Array<std::uint32_t> awake;      // simulated bodies, ascending; derived
  // Dynamic bodies that sleep and are not frozen; derived. While `awake_stale`, an upper bound.
  std::size_t sleeping_count = 0;
  bool awake_stale = false;  // `awake` and `sleeping_count` must be derived again before use
};

inline float sleep_speed_of(const BodyStore& store, std::uint32_t body) {
  return body < store.sleep_speeds.size() ? store.sleep_speeds[body].speed : 0.0f;
}

// The joint slots of a body; and the list to be changed, for which room is made.
inline std::span<const std::uint32_t> joints_of(const BodyStore& store, std::uint32_t body) {
  return body < store.joints.size() ? store.joints[body] : std::span<const std::uint32_t>{};
}
inline SmallArray<std::uint32_t, 2>& make_joints_of(BodyStore& store, std::uint32_t body) {
  if (body >= store.joints.size()) store.joints.resize(store.motion.size());
  return store.joints[body];
}

// Takes a free slot for a body and resets its columns.
IdPool::Slot add_body_slot(BodyStore& store);
void remove_body_slot(BodyStore& store, std::uint32_t body);
// Recomputes the world-frame inverse inertia of one body from its orientation and locked axes.
BodyInertia world_inertia(const BodyMass& mass, const BodyFlags& flags, Quat orientation);
void refresh_inertia(BodyStore& store, std::uint32_t body);
// The pose of the origin, derived from that of the centre of mass. It is not stored: a loaded world derives it too,
// and a stored one would differ from that by rounding.
inline Pose origin_pose(const BodyPose& pose, const BodyMass& mass) {
  return {pose.center - rotate(pose.orientation, mass.center), pose.orientation};
}
inline Pose origin_pose(const BodyStore& store, std::uint32_t body) {
  return origin_pose(store.poses[body], store.masses[body]);
}
void refresh_awake(BodyStore& store);
// True if the world inertia changes when the body rotates.
inline bool inertia_rotates(const BodyMass& mass, const BodyFlags& flags) {
  return mass.isotropic == 0 || flags.locked_angular != 0;
}
inline bool is_disabled(const BodyFlags& flags) { return flags.frozen == kDisabled; }
inline bool is_movable(const BodyFlags& flags) { return flags.type == BodyType::dynamic && flags.frozen == 0; }
// True if the step moves this body: an awake dynamic or kinematic one. For other bodies the delta position and
// rotation may be stale.
inline bool is_simulated(const BodyFlags& flags) {
  return flags.awake != 0 && flags.type != BodyType::fixed && flags.frozen == 0;
}
// The motion of the body over the step, as far as it is known.
inline Sweep sweep_of_body(const BodyStore& store, std::uint32_t body) {
  const BodyMotion& motion = store.motion[body];
  const bool moves = is_simulated(store.flags[body]);
  return {origin_pose(store, body), store.masses[body].center, moves ? motion.delta_position : Vec3{},
          moves ? motion.delta_rotation : Vec3{}};
}
// Block size of parallel loops over bodies.
constexpr int kBodiesPerBlock = 64;

}  // namespace gyre
