#include "rigid/continuous/ccd_joint_constraints.h"

namespace gyre {

namespace {

void keep_limits_only(JointRecord& joint) {
  joint.motor_force = joint.stiffness = joint.damping = 0.0f;
  const float position = joint.position;
  forget_impulses(joint);
  joint.position = position;
}
void keep_limits_only(JointDetail& detail) {
  forget_impulses(detail);
  detail.drive.max_force = detail.drive.max_torque = detail.friction = 0.0f;
  for (JointAxisRecord& axis : detail.axes)
    axis.motor_force = axis.stiffness = axis.damping = axis.friction = 0.0f;
}

}  // namespace

ProjectionJoints copy_closing_joints(const RigidWorld& w, std::span<const std::uint32_t> slots,
                                     Arena& arena) {
  const std::size_t count = slots.size();
  const ProjectionJoints copies{arena.make<JointRecord>(count),
                                {arena.make<JointConstraint>(count), arena.make<JointOffsets>(count)}};
  for (std::size_t i = 0; i < count; ++i) {
    JointRecord& joint = copies.records[i] = w.joints.records[slots[i]];
    keep_limits_only(joint);
    copies.works.places[i] = joint_offsets(w, slots[i]);
    JointDetail* detail = nullptr;
    std::span<const PathPoint> path;
    if (const JointDetail* const own = detail_of(w.joints, slots[i])) {
      detail = arena.make<JointDetail>(1).data();
      *detail = *own;
      path = path_of(w.joints, *own);
      keep_limits_only(*detail);
    }
    begin_joint(joint, detail, path, copies.works.work[i], 1.0f, arena);
  }
  return copies;
}

}  // namespace gyre
