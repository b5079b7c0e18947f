#include "rigid/batch/joint_works.h"

namespace gyre {

JointPlaces joint_places(const RigidWorld& w, std::uint32_t slot) {
  const JointRecord& joint = w.joints.records[slot];
  const JointDetail* const detail = detail_of(w.joints, slot);
  const DVec3 a = joint_place(w.bodies, joint.body_a, joint.world_anchor_a);
  const DVec3 b = joint_place(w.bodies, joint.body_b, joint.world_anchor_b);
  JointPlaces places{difference(b, a), {}, {}};
  if (detail == nullptr || joint.kind != JointKind::pulley) return places;
  places.ground_a = difference(detail->ground_a, a);
  places.ground_b = difference(detail->ground_b, b);
  return places;
}

void begin_joint(RigidWorld& w, const SolveBatch& batch, std::size_t i, float warm_scale,
                 const JointWorks& works, Arena& arena) {
  const std::uint32_t slot = batch.joints[i];
  JointDetail* const detail = detail_of(w.joints, slot);
  std::span<const PathPoint> path;
  if (detail != nullptr) path = path_of(w.joints, *detail);
  begin_joint(w.joints.records[slot], detail, path, works.work[i], warm_scale, arena);
  works.places[i] = joint_places(w, slot);
}

JointWorks begin_joints(RigidWorld& w, const SolveBatch& batch, std::span<const std::uint8_t> elsewhere,
                        float warm_scale, Arena& arena) {
  const std::size_t count = batch.joints.size();
  const JointWorks works{arena.make<JointWork>(count), arena.make<JointPlaces>(count)};
  for (std::size_t i = 0; i < count; ++i) {
    if (elsewhere.empty() || elsewhere[i] == 0) begin_joint(w, batch, i, warm_scale, works, arena);
  }
  return works;
}

void finish_joints(RigidWorld& w, const SolveBatch& batch, std::span<const std::uint8_t> elsewhere,
                   std::span<const JointWork> work) {
  for (std::size_t i = 0; i < batch.joints.size(); ++i) {
    if (elsewhere.empty() || elsewhere[i] == 0) finish_joint(w.joints.records[batch.joints[i]], work[i]);
  }
}

}  // namespace gyre
