// For programs that spread one world over several processes, as gyre-mpi does: bodies that are simulated in one process and only followed
// in others. docs/scaling.md explains it.
#pragma once

#include <gyre/ids.h>
#include <gyre/math.h>
#include <gyre/world.h>

namespace gyre {

// The motion of a body to the bit: Pose has the place of its origin, which is rounded when it is made of this.
struct ReplicaMotion {
  DVec3 center{};           // m, of the centre of mass, world
  Quat orientation{};       // world_from_body
  Vec3 linear_velocity{};   // m/s, of the centre of mass
  Vec3 angular_velocity{};  // rad/s

  constexpr bool operator==(const ReplicaMotion&) const = default;
};

// Zero for a stale id.
ReplicaMotion replica_motion(const World& world, BodyId body);
// Sets the motion of a body that another process simulates. In contrast to set_pose(), contacts stay with their impulses, and nothing wakes:
// the body is meant to have moved there by steps of its own. False, and no change, for a stale id, numbers that are not finite, a fixed
// body, or a world that is recorded, since this is no command.
bool set_replica_motion(World& world, BodyId body, const ReplicaMotion& motion);
// m: the farthest point of any shape from the centre of mass. Zero for a stale id.
float bounding_radius(const World& world, BodyId body);

}  // namespace gyre
