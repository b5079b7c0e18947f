// Rigid bodies as columns, indexed by the id's slot. Hot: the 64-byte motion record. Warm: places, masses, what acts on
// the body. Cold: lists, overrides, user data.
//
// The state of a body is the place of its centre of mass (double), its orientation and its two velocities; the pose of
// its origin is derived. Slots never move, so everything may keep a body's index; sleeping bodies are left out of `awake`.
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

// Where a body is: its centre of mass and how it is turned.
struct BodyPose {
  DVec3 center;
  Quat orientation;  // world_from_body
};

// Mass and inertia, in the body's frame, about the centre of mass. Zero for bodies that nothing moves.
struct BodyMass {
  float mass = 0.0f;
  float inverse_mass = 0.0f;
  Vec3 center;              // body frame
  Sym3 inertia;             // kg m^2
  Sym3 inverse_inertia;     // locked axes are taken off in the world frame, not here
  float bounding_radius = 0.0f;       // m, farthest point of any shape from the centre of mass
  float size = 0.0f;        // m, inner radius of its thinnest shape: the scale of tolerances
  std::uint32_t isotropic = 0;  // 1 when all principal moments are equal: no gyroscopic effect
};

// What acts on a body.
struct BodyForces {
  Vec3 force;   // N, summed for the next step
  Vec3 torque;  // N m
  float linear_damping = 0.0f;
  float angular_damping = 0.0f;
  float gravity_scale = 1.0f;
};

// What BodyFlags::touched says in a step: constraints or fields act on the body; they also look at its place in each sub-step.
constexpr std::uint8_t kNotConstrained = 0, kConstrained = 1, kPoseRead = 2;

struct BodyFlags {
  BodyType type = BodyType::fixed;
  std::uint8_t awake = 0;
  std::uint8_t can_sleep = 1;
  std::uint8_t continuous = 0;
  std::uint8_t frozen = 0;        // quarantined: its state stopped being finite
  std::uint8_t locked_linear = 0;   // bits 0 to 2: world x, y, z
  std::uint8_t locked_angular = 0;
  std::uint8_t constraint_use = 0;       // a constraint row acted on it in the last step
};

constexpr std::uint32_t kNoGroup = 0xffffffffu;

struct BodySleep {
  float still_time = 0.0f;             // s, for which it has hardly moved
  std::uint32_t group = kNoGroup;      // lowest body of the sleeping island; kNoGroup: awake or fixed
  std::uint32_t next_in_group = 0;     // the group as a ring
};

// Mass properties given by the user instead of by the shapes.
struct BodyOverrides {
  std::uint8_t has_mass = 0, has_center = 0, has_inertia = 0;
  float mass = 0.0f;
  Vec3 center;
  Sym3 inertia;
};

inline auto interning_key(const BodyMass& m) {
  static_assert(sizeof(BodyMass) == 80, "every field is among the bits");
  return words_of(m.mass, m.inverse_mass, m.center, m.inertia, m.inverse_inertia, m.bounding_radius, m.size, m.isotropic);
}
inline auto interning_key(const BodyOverrides& o) {
  static_assert(sizeof(BodyOverrides) == 44, "every field is among the bits");
  const std::uint32_t has = std::uint32_t(o.has_mass) | std::uint32_t(o.has_center) << 8 | std::uint32_t(o.has_inertia) << 16;
  return words_of(has, o.mass, o.center, o.inertia);
}

struct BodyStore {
  IdPool ids;
  Array<BodyMotion> motion;
  Array<BodyInertia> inertia;       // world axes, of the present orientation; can be rebuilt
  Array<BodyPose> poses;
  Array<Quat> orientations;         // beside `places` for the solver's gathers; equal to places[i].orientation between steps
  InternedColumn<BodyMass> masses;
  Array<BodyForces> forces;
  Array<BodyFlags> flags;
  Array<BodySleep> sleep;
  InternedColumn<BodyOverrides> overrides;
  Array<std::uint64_t> user_data;
  Array<LastMove> last_moves;       // by slot, in worlds with the integrator verlet; else empty
  Array<SmallArray<ShapeId, 1>> shapes;         // by body, ascending index; derived
  // By body, as far as one needed it (most worlds have no joints): joints_of(); ascending index; derived.
  Array<SmallArray<std::uint32_t, 2>> joints;
  Array<std::uint32_t> awake;       // dynamic bodies that are awake and kinematic ones, ascending; derived
  std::size_t sleeping_count = 0;         // dynamic bodies that are not, and not frozen; derived
  bool awake_stale = false;         // the two must be found anew before use
};

// The slots of a body's joints; and its list to be changed, which makes room for those of all bodies.
inline std::span<const std::uint32_t> joints_of(const BodyStore& store, std::uint32_t body) {
  return body < store.joints.size() ? store.joints[body] : std::span<const std::uint32_t>{};
}
inline SmallArray<std::uint32_t, 2>& make_joints_of(BodyStore& store, std::uint32_t body) {
  if (body >= store.joints.size()) store.joints.resize(store.motion.size());
  return store.joints[body];
}

// Makes room for a body in a fresh slot and returns the slot.
IdPool::Slot add_body_slot(BodyStore& store);
void remove_body_slot(BodyStore& store, std::uint32_t body);
// Recomputes the world-frame inverse inertia of one body from its orientation and locked axes.
BodyInertia world_inertia(const BodyMass& mass, const BodyFlags& flags, Quat orientation);
void refresh_inertia(BodyStore& store, std::uint32_t body);
// The pose of the body's origin, from the place of its centre of mass. It is not kept: rounding would make the kept one
// differ from what a world that is loaded can know.
inline Pose origin_pose(const BodyPose& pose, const BodyMass& mass) {
  return {pose.center - rotate(pose.orientation, mass.center), pose.orientation};
}
inline Pose origin_pose(const BodyStore& store, std::uint32_t body) {
  return origin_pose(store.poses[body], store.masses[body]);
}
void refresh_awake(BodyStore& store);
// Whether the body's world inertia changes as it turns.
inline bool inertia_rotates(const BodyMass& mass, const BodyFlags& flags) {
  return mass.isotropic == 0 || flags.locked_angular != 0;
}
inline bool is_movable(const BodyFlags& flags) { return flags.type == BodyType::dynamic && flags.frozen == 0; }
// Whether a step takes it along, by itself or as its velocity says. What does not may still hold the way of an earlier step.
inline bool is_simulated(const BodyFlags& flags) {
  return flags.awake != 0 && flags.type != BodyType::fixed && flags.frozen == 0;
}
// How the body moves over the step, as far as that is known.
inline Sweep sweep_of_body(const BodyStore& store, std::uint32_t body) {
  const BodyMotion& motion = store.motion[body];
  const bool moves = is_simulated(store.flags[body]);
  return {origin_pose(store, body), store.masses[body].center, moves ? motion.moved : Vec3{}, moves ? motion.turned : Vec3{}};
}
// What loops over bodies take at once.
constexpr int kBodiesPerBlock = 64;

}  // namespace gyre
