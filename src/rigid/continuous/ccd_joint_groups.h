// Finds the projection groups after CCD (rigid/continuous/ccd_joint_projection.h): each halted body with the
// bodies that joints connect to it, up to a bound.
#pragma once

#include "base/arena/arena.h"
#include "rigid/store/rigid_world.h"

#include <span>

namespace gyre {

// A fast body that CCD moved back to its time of impact.
struct HaltedBody {
  std::uint32_t body = 0;
  float fraction = 1.0f;                // of its displacement, up to the impact
  Vec3 delta_position, delta_rotation;  // over the whole step, as BodyMotion has it
};

// A body of a group, and its displacement.
struct ProjectionMember {
  const HaltedBody* halted = nullptr;  // null: not halted
  std::uint32_t body = 0;
  bool moves = false;         // all of its joints are in the group; other bodies are not moved by the group
  bool is_in_motion = false;  // moves, or has a displacement
  bool fixed = false;         // halted, and not to be moved any more
  Vec3 start_displacement;    // pose at the first impact of the group
  Quat start_orientation;
  Vec3 remaining_displacement, remaining_rotation;  // from there to the present pose
  Vec3 saved_displacement;                          // pose when joints were last closed
  Quat saved_orientation;
};

struct ProjectionGroup {
  std::span<std::uint32_t> joints;  // ascending
  std::span<ProjectionMember> members;
  bool is_whole = false;  // no other joint leads to it, so no other group moves a body of it
};

// In the order of the halted bodies. A body with all joints in groups of others has no group of its own.
std::span<ProjectionGroup> find_projection_groups(const RigidWorld& w, std::span<const HaltedBody> halted,
                                                  Arena& arena);

}  // namespace gyre
