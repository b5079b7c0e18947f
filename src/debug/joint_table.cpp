// read_joints: every joint with its frames, limits and loads. See <gyre/debug.h>.
#include "base/float_mode.h"
#include "debug/flat.h"
#include "debug/step_length.h"
#include "world/world_access.h"
#include "world/world_state.h"

#include <gyre/debug.h>

namespace gyre {

namespace {

// One end of a joint in the world.
struct End {
  BodyId body;
  Vec3 anchor;  // from the origin
  Quat frame;   // world_from_joint
};
End find_end(const RigidWorld& w, std::int32_t body, Vec3 local_anchor, Quat local_frame, DVec3 world_anchor,
             DVec3 origin) {
  if (body == kNoBody) return {{}, difference(world_anchor, origin), local_frame};
  const BodyPose& body_pose = w.bodies.poses[body];
  return {body_id(w, std::uint32_t(body)),
          difference(body_pose.center, origin) + rotate(body_pose.orientation, local_anchor),
          normalized(body_pose.orientation * local_frame)};
}

// A distance joint with two lengths is a rope, with one a rod; a spring has no limits.
bool has_limits(const JointRecord& joint) {
  if (joint.kind != JointKind::distance) return joint.has_limits;
  return joint.min_length < joint.max_length &&
         (joint.min_length > 0.0f || joint.max_length < kUnlimitedLength);
}

void add_joint(const RigidWorld& w, std::uint32_t slot, DVec3 origin, JointTable& out) {
  const JointRecord& joint = w.joints.records[slot];
  const End a =
      find_end(w, joint.body_a, joint.local_anchor_a, joint.local_frame_a, joint.world_anchor_a, origin);
  const End b =
      find_end(w, joint.body_b, joint.local_anchor_b, joint.local_frame_b, joint.world_anchor_b, origin);
  out.ids.push_back(joint_id(w, slot));
  out.kinds.push_back(joint.kind);
  for (const End& end : {a, b}) {
    out.bodies.push_back(end.body);
    append(out.anchors, end.anchor);
    append(out.frames, end.frame);
  }
  const bool limited = has_limits(joint);
  const bool by_length = joint.kind == JointKind::distance;
  out.has_limits.push_back(limited ? 1 : 0);
  out.limits.push_back(!limited ? 0.0f : by_length ? joint.min_length : joint.limits.low);
  out.limits.push_back(!limited ? 0.0f : by_length ? joint.max_length : joint.limits.high);
  out.positions.push_back(joint.position);
  const bool driven = joint.motor_force > 0.0f;
  out.motors.push_back(!driven                  ? 0.0f
                       : joint.has_motor_target ? joint.motor_position - joint.position
                                                : joint.motor_velocity);
  out.motors.push_back(driven ? joint.motor_force : 0.0f);
  append(out.forces, inverse_step_length(w) * joint.total_linear);
  append(out.torques, inverse_step_length(w) * joint.total_angular);
}

}  // namespace

void read_joints(const World& world, DVec3 origin, JointTable& out) {
  const FloatMode mode;
  const RigidWorld& w = state_of(world).rigid;
  clear_all(out.ids, out.kinds, out.bodies, out.anchors, out.frames, out.has_limits, out.limits,
            out.positions, out.motors, out.forces, out.torques);
  w.joints.ids.for_each_live([&](std::uint32_t slot) { add_joint(w, slot, origin, out); });
}

}  // namespace gyre
