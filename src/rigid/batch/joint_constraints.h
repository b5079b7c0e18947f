// Joint constraints of a batch: memory for their solve, and the offsets between their ends as the step begins.
#pragma once

#include "base/arena/arena.h"
#include "rigid/batch/solve_batch.h"
#include "rigid/store/rigid_world.h"
#include "solver/joint/joint.h"

namespace gyre {

// A joint as an edge of the graph of bodies: its movable bodies (else kNoBody) and its number of equations.
struct JointEdge {
  std::int32_t body_a = kNoBody, body_b = kNoBody;
  std::int32_t equations = 0;
  bool operator==(const JointEdge&) const = default;
};
// Calls fn(body) for each movable body of the edge.
template <class Fn>
void for_moving(const JointEdge& joint, Fn&& fn) {
  if (joint.body_a != kNoBody) fn(std::uint32_t(joint.body_a));
  if (joint.body_b != kNoBody) fn(std::uint32_t(joint.body_b));
}

struct JointConstraints {
  std::span<JointConstraint> work;  // by index in the batch's list of joints
  std::span<JointOffsets> places;
};

// The offsets of the joint's ends as the step begins.
JointOffsets joint_offsets(const RigidWorld& w, std::uint32_t slot);
// The position of a body's end: its centre of mass, or a point of the world.
inline const DVec3& joint_end_position(const BodyStore& bodies, std::int32_t body,
                                       const DVec3& world_anchor) {
  return body == kNoBody ? world_anchor : bodies.poses[std::size_t(body)].center;
}
// Computes JointOffsets::offset alone.
inline Vec3 joint_offset(const RigidWorld& w, const JointRecord& joint) {
  return difference(joint_end_position(w.bodies, joint.body_b, joint.world_anchor_b),
                    joint_end_position(w.bodies, joint.body_a, joint.world_anchor_a));
}
// Begins joint `i` of the batch's list.
void begin_joint(RigidWorld& w, const SolveBatch& batch, std::size_t i, float warm_scale,
                 const JointConstraints& works, Arena& arena);
// Begins all joints but those with 1 in `elsewhere`, which may be empty.
JointConstraints begin_joints(RigidWorld& w, const SolveBatch& batch,
                              std::span<const std::uint8_t> in_articulation, float warm_scale, Arena& arena);
// Writes impulses from the constraints back to the joints.
void finish_joints(RigidWorld& w, const SolveBatch& batch, std::span<const std::uint8_t> in_articulation,
                   std::span<const JointConstraint> work);

}  // namespace gyre
