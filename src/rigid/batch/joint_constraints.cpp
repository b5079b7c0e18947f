#include "rigid/batch/joint_constraints.h"

namespace gyre {

JointOffsets joint_offsets(const RigidWorld& w, std::uint32_t slot) {
  const JointRecord& joint = w.joints.records[slot];
  const JointDetail* const detail = detail_of(w.joints, slot);
  const DVec3 a = joint_end_position(w.bodies, joint.body_a, joint.world_anchor_a);
  const DVec3 b = joint_end_position(w.bodies, joint.body_b, joint.world_anchor_b);
  JointOffsets places{difference(b, a), {}, {}};
  if (detail == nullptr || joint.kind != JointKind::pulley) return places;
  places.ground_a = difference(detail->ground_a, a);
  places.ground_b = difference(detail->ground_b, b);
  return places;
}

void begin_joint(RigidWorld& w, const SolveBatch& batch, std::size_t i, float warm_scale,
                 const JointConstraints& works, Arena& arena) {
  const std::uint32_t slot = batch.joints[i];
  JointDetail* const detail = detail_of(w.joints, slot);
  std::span<const PathPoint> path;
  if (detail != nullptr) path = path_of(w.joints, *detail);
  begin_joint(w.joints.records[slot], detail, path, works.work[i], warm_scale, arena);
  works.places[i] = joint_offsets(w, slot);
}

JointConstraints begin_joints(RigidWorld& w, const SolveBatch& batch,
                              std::span<const std::uint8_t> in_articulation, float warm_scale, Arena& arena) {
  const std::size_t count = batch.joints.size();
  const JointConstraints works{arena.make<JointConstraint>(count), arena.make<JointOffsets>(count)};
  for (std::size_t i = 0; i < count; ++i) {
    if (in_articulation.empty() || in_articulation[i] == 0)
      begin_joint(w, batch, i, warm_scale, works, arena);
  }
  return works;
}

void finish_joints(RigidWorld& w, const SolveBatch& batch, std::span<const std::uint8_t> in_articulation,
                   std::span<const JointConstraint> work) {
  for (std::size_t i = 0; i < batch.joints.size(); ++i) {
    if (in_articulation.empty() || in_articulation[i] == 0)
      finish_joint(w.joints.records[batch.joints[i]], work[i]);
  }
}

}  // namespace gyre
