// What a step knows of the joints of a batch: room for their work, and where their ends stand as it begins.
#pragma once

#include "base/arena/arena.h"
#include "rigid/batch/solve_batch.h"
#include "rigid/store/rigid_world.h"
#include "solver/joint/joint.h"

namespace gyre {

// What a joint adds to the plan of its net: the bodies that it holds and that move (else kNoBody), and its equations.
struct JointEdge {
  std::int32_t body_a = kNoBody, body_b = kNoBody;
  std::int32_t equations = 0;
  bool operator==(const JointEdge&) const = default;
};
// Calls fn(body) for those of its bodies that move.
template <class Fn>
void for_moving(const JointEdge& joint, Fn&& fn) {
  if (joint.body_a != kNoBody) fn(std::uint32_t(joint.body_a));
  if (joint.body_b != kNoBody) fn(std::uint32_t(joint.body_b));
}

struct JointConstraints {
  std::span<JointConstraint> work;  // by place in the batch's list of joints
  std::span<JointOffsets> places;
};

// Where the ends of the joint stand as the step begins.
JointOffsets joint_offsets(const RigidWorld& w, std::uint32_t slot);
// Where a body's end of a joint hangs: its centre of mass, or a point of the world.
inline const DVec3& joint_end_position(const BodyStore& bodies, std::int32_t body,
                                       const DVec3& world_anchor) {
  return body == kNoBody ? world_anchor : bodies.poses[std::size_t(body)].center;
}
// JointOffsets::offset alone.
inline Vec3 joint_offset(const RigidWorld& w, const JointRecord& joint) {
  return difference(joint_end_position(w.bodies, joint.body_b, joint.world_anchor_b),
                    joint_end_position(w.bodies, joint.body_a, joint.world_anchor_a));
}
// Of one joint, `i` in the batch's list.
void begin_joint(RigidWorld& w, const SolveBatch& batch, std::size_t i, float warm_scale,
                 const JointConstraints& works, Arena& arena);
// Of all but those that are begun elsewhere: `elsewhere` has 1 for these, or is empty.
JointConstraints begin_joints(RigidWorld& w, const SolveBatch& batch,
                              std::span<const std::uint8_t> in_articulation, float warm_scale, Arena& arena);
// What the work knows goes back into the joints.
void finish_joints(RigidWorld& w, const SolveBatch& batch, std::span<const std::uint8_t> in_articulation,
                   std::span<const JointConstraint> work);

}  // namespace gyre
