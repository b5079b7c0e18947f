#include "rigid/batch/solve_batch.h"

namespace gyre {

bool is_solved(const RigidWorld& w, const Contact& contact) {
  return may_act(contact) && (is_active(w, contact.body_a) || is_active(w, contact.body_b));
}
bool is_joint_solved(const RigidWorld& w, std::uint32_t slot) {
  const JointRecord& joint = w.joints.records[slot];
  return may_act(w, slot) && ((joint.body_a != kNoBody && is_active(w, std::uint32_t(joint.body_a))) ||
                              (joint.body_b != kNoBody && is_active(w, std::uint32_t(joint.body_b))));
}

}  // namespace gyre
