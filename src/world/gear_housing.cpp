#include "world/gear_housing.h"

#include "rigid/rigid_step.h"
#include "solver/joint/joint_kinds.h"

#include <vector>

namespace gyre {

namespace {

DVec3 place_of(const RigidWorld& w, std::int32_t body, Vec3 local) {
  const BodyPose& pose = w.bodies.poses[std::size_t(body)];
  return pose.center + rotate(pose.orientation, local);
}
Vec3 local_in(const RigidWorld& w, std::int32_t body, DVec3 place) {
  const BodyPose& pose = w.bodies.poses[std::size_t(body)];
  return rotate_inverse(pose.orientation, difference(place, pose.center));
}

// A hinge on which a shaft turns in a body that can move.
struct Bearing {
  std::int32_t housing = kNoBody;
  DVec3 place;
};
void list_bearings(const RigidWorld& w, std::int32_t wheel, Vec3 shaft, std::vector<Bearing>& out) {
  constexpr float kParallel = 0.999f;  // cosine of the angle between the hinge and the shaft
  out.clear();
  for (const std::uint32_t slot : joints_of(w.bodies, std::uint32_t(wheel))) {
    const JointRecord& joint = w.joints.records[slot];
    const bool is_a = joint.body_a == wheel;
    const std::int32_t housing = is_a ? joint.body_b : joint.body_a;
    if (joint.kind != JointKind::hinge || housing == kNoBody ||
        w.bodies.flags[std::size_t(housing)].type == BodyType::fixed)
      continue;
    const Quat orientation = w.bodies.poses[std::size_t(wheel)].orientation;
    const Vec3 axis = rotate(orientation * (is_a ? joint.local_frame_a : joint.local_frame_b), {1, 0, 0});
    if (absolute(dot(axis, shaft)) > kParallel)
      out.push_back({housing, place_of(w, wheel, is_a ? joint.local_anchor_a : joint.local_anchor_b)});
  }
}

}  // namespace

void find_housing(RigidWorld& w, std::uint32_t slot) {
  constexpr float kMinSine = 0.1f;          // of the angle between crossed shafts
  constexpr float kMinDistance = 1.0e-4f;  // m, between parallel shafts
  JointRecord& joint = w.joints.records[slot];
  JointDetail* const detail = detail_of(w.joints, slot);
  if (joint.kind != JointKind::gear || joint.body_a == kNoBody || joint.body_b == kNoBody ||
      gear_frame(*detail) != GearFrame::world)
    return;
  RowPose pose{{},
               {},
               w.bodies.poses[std::size_t(joint.body_a)].orientation * joint.local_frame_a,
               w.bodies.poses[std::size_t(joint.body_b)].orientation * joint.local_frame_b};
  const Vec3 a = rotate(pose.frame_a, {1, 0, 0}), b = rotate(pose.frame_b, {1, 0, 0});
  std::vector<Bearing> of_a, of_b;
  list_bearings(w, joint.body_a, a, of_a);
  list_bearings(w, joint.body_b, b, of_b);
  for (const Bearing& on_a : of_a) {
    for (const Bearing& on_b : of_b) {
      if (on_a.housing != on_b.housing) continue;
      const Vec3 between = difference(on_b.place, on_a.place);
      const float along = dot(a, b), square_sine = length_squared(cross(a, b));
      const bool crossed = square_sine > square(kMinSine);
      const float to_a = crossed ? (dot(between, a) - along * dot(between, b)) / square_sine : 0.0f,
                  to_b =
                      crossed ? (along * dot(between, a) - dot(between, b)) / square_sine : -dot(between, b);
      pose.anchor_offset = between + to_b * b - to_a * a;
      if (!crossed && !(length(pose.anchor_offset) > kMinDistance)) continue;
      joint.local_anchor_a = local_in(w, joint.body_a, on_a.place + to_a * a);
      joint.local_anchor_b = local_in(w, joint.body_b, on_b.place + to_b * b);
      clear_impulses(joint);
      clear_impulses(*detail);
      return start_gear(*detail, crossed ? GearFrame::shafts : GearFrame::centres, pose);
    }
  }
}

}  // namespace gyre
