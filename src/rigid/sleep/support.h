// Finds what stops a slow body. Sleep does to a slow body what dry friction does: it stops the body for good. So a body may be stopped
// from its full sleep speed only if friction acts on it. (Of a body that rolls slowly it is rolling resistance that sleep stands
// for.) A body that swings on a joint, slides on ice, drifts or is driven goes on; it is still only at much smaller speeds.
#pragma once

#include "rigid/store/rigid_world.h"

namespace gyre {

// True if dry friction of the contacts of the body can stop it from `speed` (m/s) within `time` (s), by their loads in the last step of
// `seconds`. A conveyor belt does not hold a body, nor does anything else hold a body on one.
bool is_held_by_friction(const RigidWorld& w, std::uint32_t body, float speed, float time, float seconds);

// The effect of a body's joints on its rest.
struct JointDrives {
  bool any = false;  // a spring, motor or drive acts
  float slowest =
      kUnbounded;  // m/s, of the motors with a target velocity: the speed that they give to the surface of the body
};
JointDrives find_joint_drives(const RigidWorld& w, std::uint32_t body, float radius);

}  // namespace gyre
