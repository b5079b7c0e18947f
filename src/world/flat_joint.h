// The definition of a joint with the fields of all kinds side by side, as commands carry it and recordings store it.
// Users write one definition per kind (gyre/joints.h). for_each_field is the one list that relates the two forms.
#pragma once

#include <gyre/joints.h>

#include <type_traits>

namespace gyre {

// gyre/joints.h gives the meaning of each field. Fields that a kind does not have stay at their defaults. Older recordings may have
// further fields, an axis of a ball for example. Such fields are kept, because they are part of the state.
struct FlatJoint {
  JointKind kind = JointKind::ball;
  BodyId a{};
  BodyId b{};
  DVec3 anchor{};
  Vec3 axis{1, 0, 0};
  std::optional<DVec3> anchor_b{};
  std::optional<Limits> limits{};
  Motor motor{};
  std::optional<float> length{};
  std::optional<float> min_length{};
  std::optional<float> max_length{};
  std::optional<float> stiffness{};
  std::optional<float> damping{};
  std::optional<float> frequency{};
  float damping_ratio = 0.0f;
  std::optional<float> break_force{};
  std::optional<float> break_torque{};
  bool collide_connected = false;
  std::optional<Vec3> axis_b{};
  float friction = 0.0f;
  float limit_frequency = 0.0f;
  float limit_damping_ratio = 1.0f;
  std::optional<float> swing_y{};
  std::optional<float> swing_z{};
  float ratio = 1.0f;
  DVec3 ground_a{};
  DVec3 ground_b{};
  JointAxisDef linear_x{}, linear_y{}, linear_z{};
  JointAxisDef angular_x{}, angular_y{}, angular_z{};
  PoseDrive drive{};
  std::vector<Vec3> path{};
  bool path_closed = false;
  PathOrientation path_orientation = PathOrientation::free;
};

// Calls fn(field of the definition, field of the flat form) for each field of a definition.
template <class Def, class Flat, class Fn>
void for_each_field(Def& def, Flat& flat, Fn&& fn) {
  fn(def.a, flat.a), fn(def.b, flat.b), fn(def.anchor, flat.anchor);
  if constexpr (requires { def.axis; }) fn(def.axis, flat.axis);
  if constexpr (requires { def.axis_b; }) fn(def.axis_b, flat.axis_b);
  if constexpr (requires { def.anchor_b; }) fn(def.anchor_b, flat.anchor_b);
  if constexpr (requires { def.limits; }) {
    fn(def.limits, flat.limits), fn(def.limit_frequency, flat.limit_frequency);
    fn(def.limit_damping_ratio, flat.limit_damping_ratio);
  }
  if constexpr (requires { def.motor; }) fn(def.motor, flat.motor);
  if constexpr (requires { def.stiffness; }) fn(def.stiffness, flat.stiffness), fn(def.damping, flat.damping);
  if constexpr (requires { def.friction; }) fn(def.friction, flat.friction);
  if constexpr (requires { def.length; }) fn(def.length, flat.length);
  if constexpr (requires { def.min_length; }) {
    fn(def.min_length, flat.min_length), fn(def.max_length, flat.max_length);
    fn(def.frequency, flat.frequency), fn(def.damping_ratio, flat.damping_ratio);
  }
  if constexpr (requires { def.swing_y; }) fn(def.swing_y, flat.swing_y), fn(def.swing_z, flat.swing_z);
  if constexpr (requires { def.ratio; }) fn(def.ratio, flat.ratio);
  if constexpr (requires { def.ground_a; }) fn(def.ground_a, flat.ground_a), fn(def.ground_b, flat.ground_b);
  if constexpr (requires { def.linear_x; }) {
    fn(def.linear_x, flat.linear_x), fn(def.linear_y, flat.linear_y), fn(def.linear_z, flat.linear_z);
    fn(def.angular_x, flat.angular_x), fn(def.angular_y, flat.angular_y);
  }
  if constexpr (requires { def.steering; }) fn(def.steering, flat.angular_x);
  if constexpr (requires { def.angular_z; }) fn(def.angular_z, flat.angular_z);
  if constexpr (requires { def.drive; }) fn(def.drive, flat.drive);
  if constexpr (requires { def.points; }) {
    fn(def.points, flat.path), fn(def.closed, flat.path_closed);
    fn(def.orientation, flat.path_orientation);
  }
  fn(def.break_force, flat.break_force), fn(def.break_torque, flat.break_torque);
  fn(def.collide_connected, flat.collide_connected);
}

FlatJoint flatten(const JointDef& def);

}  // namespace gyre
