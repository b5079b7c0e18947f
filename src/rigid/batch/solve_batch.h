// A batch: bodies, contacts and joints that are solved together. It holds whole islands, so no body that moves is in two batches.
#pragma once

#include "rigid/store/rigid_world.h"

namespace gyre {

// All lists are in ascending order.
struct SolveBatch {
  std::span<const std::uint32_t> bodies;    // awake dynamic and kinematic bodies
  std::span<const std::uint32_t> contacts;  // slots; each has a manifold and a body that it moves
  std::span<const std::uint32_t> joints;  // slots
};

// True if constraints move the body: it is dynamic, awake and not frozen.
inline bool is_active(const RigidWorld& w, std::uint32_t body) {
  const BodyFlags& flags = w.bodies.flags[body];
  return flags.awake != 0 && is_movable(flags);
}

// True if the contact is a constraint once one of its bodies is active.
inline bool may_act(const Contact& contact) {
  return contact.manifold_room != 0 && contact.manifold_count != 0 && contact.sensor == 0;
}
inline bool may_act(const RigidWorld& w, std::uint32_t joint) {
  return is_joint_enabled(w, joint);
}
// True if the contact is a constraint now.
bool is_solved(const RigidWorld& w, const Contact& contact);
bool is_joint_solved(const RigidWorld& w, std::uint32_t slot);

}  // namespace gyre
