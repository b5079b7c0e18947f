// Who is led along when a sweep has taken bodies back (rigid/continuous/ccd_joint_projection.h): for each of them what hangs together with it by
// joints, as far as that is few enough.
#pragma once

#include "base/arena/arena.h"
#include "rigid/store/rigid_world.h"

#include <span>

namespace gyre {

// A fast body that goes only a part of its way in this step.
struct HaltedBody {
  std::uint32_t body = 0;
  float fraction = 1.0f;  // of its way, up to where it met something
  Vec3 delta_position, delta_rotation;     // the whole way, as BodyMotion has it
};

// A body of a group, and its way.
struct ProjectionMember {
  const HaltedBody* halted = nullptr;  // null: it was not
  std::uint32_t body = 0;
  bool moves = false;  // all of its joints are in the group; others go where they go anyway
  bool is_in_motion = false;   // moves, or does not stand still
  bool fixed = false;   // stopped, and not to be moved any more
  Vec3 start_displacement;    // where the first of the group was stopped
  Quat start_orientation;
  Vec3 remaining_displacement, remaining_rotation;  // from there to where it is
  Vec3 saved_displacement;               // where it was when joints were last closed
  Quat saved_orientation;
};

struct ProjectionGroup {
  std::span<std::uint32_t> joints;  // ascending
  std::span<ProjectionMember> members;
  bool is_whole = false;  // nothing more hangs there, so no other group has a body of it that moves
};

// In the order of the stopped bodies; those of which all joints are in groups of others have none of their own.
std::span<ProjectionGroup> find_projection_groups(const RigidWorld& w, std::span<const HaltedBody> halted,
                                                  Arena& arena);

}  // namespace gyre
