#include "rigid/continuous/ccd_joint_constraints.h"

namespace gyre {

namespace {

void strip_to_limits(JointRecord& joint) {
  joint.motor_force = joint.stiffness = joint.damping = 0.0f;
  const float position = joint.position;
  clear_impulses(joint);
  joint.position = position;
}
void strip_to_limits(JointDetail& detail) {
  clear_impulses(detail);
  detail.drive.max_force = detail.drive.max_torque = detail.friction = 0.0f;
  for (JointAxisRecord& axis : detail.axes)
    axis.motor_force = axis.stiffness = axis.damping = axis.friction = 0.0f;
}

}  // namespace

ProjectionJoints copy_projection_joints(const RigidWorld& w, std::span<const std::uint32_t> slots,
                                        Arena& arena) {
  const std::size_t count = slots.size();
  const ProjectionJoints copies{arena.make<JointRecord>(count),
                                {arena.make<JointConstraint>(count), arena.make<JointOffsets>(count)}};
  for (std::size_t i = 0; i < count; ++i) {
    JointRecord& joint = copies.records[i] = w.joints.records[slots[i]];
    strip_to_limits(joint);
    copies.constraints.places[i] = joint_offsets(w, slots[i]);
    JointDetail* detail = nullptr;
    std::span<const PathPoint> path;
    if (const JointDetail* const own = detail_of(w.joints, slots[i])) {
      detail = arena.make<JointDetail>(1).data();
      *detail = *own;
      path = path_of(w.joints, *own);
      strip_to_limits(*detail);
    }
    begin_joint(joint, detail, path, copies.constraints.work[i], 1.0f, arena);
  }
  return copies;
}

}  // namespace gyre
