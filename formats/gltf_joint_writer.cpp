// Joints as limits and drives. The format: Khronos Group, draft of KHR_physics_rigid_bodies. See gltf_joint_writer.h.
#include "formats/gltf_joint_writer.h"

#include "formats/gltf_builder.h"

namespace gyre {
namespace {

constexpr float kStiffDrive =
    1.0e9f;  // N/m or N m/rad, and N s/m, of drives that are as stiff as a step allows

class JointDescription {
 public:
  // Axes 0 to 2 are linear, 3 to 5 angular.
  void limit(std::initializer_list<int> axes, std::optional<float> low, std::optional<float> high) {
    Json out;
    for (const int axis : axes) out[axis < 3 ? "linearAxes" : "angularAxes"].push_back(axis % 3);
    if (low) out["min"] = gltf_number(*low);
    if (high) out["max"] = gltf_number(*high);
    limits_.push_back(std::move(out));
  }
  void lock(std::initializer_list<int> axes) { limit(axes, 0.0f, 0.0f); }

  void drive(int axis, float stiffness, float damping, float position) {
    if (stiffness == 0.0f && damping == 0.0f) return;
    Json out = begin_drive(axis, "force");
    out["stiffness"] = gltf_number(stiffness);
    out["damping"] = gltf_number(damping);
    if (stiffness > 0.0f) out["positionTarget"] = gltf_number(position);
    drives_.push_back(std::move(out));
  }

  void drive(int axis, const Motor& motor) {
    if (motor.max_force == 0.0f) return;
    const bool is_spring = motor.target_position && motor.frequency > 0.0f;
    Json out = begin_drive(axis, is_spring ? "acceleration" : "force");
    out["maxForce"] = gltf_number(motor.max_force);
    out["velocityTarget"] = gltf_number(motor.target_velocity);
    const float rate = 2.0f * kPi * motor.frequency;
    if (motor.target_position) {
      out["positionTarget"] = gltf_number(*motor.target_position);
      out["stiffness"] = gltf_number(is_spring ? rate * rate : kStiffDrive);
    }
    out["damping"] = gltf_number(is_spring ? 2.0f * motor.damping_ratio * rate : kStiffDrive);
    drives_.push_back(std::move(out));
  }

  void axis(int index, const JointAxisDef& def) {
    if (def.motion == AxisMotion::locked) return lock({index});
    if (def.motion == AxisMotion::limited) limit({index}, def.limits.low, def.limits.high);
    drive(index, def.stiffness, def.damping, def.rest_position);
    drive(index, def.motor);
    is_complete = is_complete && def.friction == 0.0f && def.limit_frequency == 0.0f;
  }

  // The axis that the members of a definition itself describe.
  template <class Def>
  void main_axis(int index, const Def& def) {
    if (def.limits) limit({index}, def.limits->low, def.limits->high);
    drive(index, def.stiffness, def.damping, 0.0f);
    drive(index, def.motor);
    is_complete = is_complete && def.friction == 0.0f && def.limit_frequency == 0.0f;
  }

  Json take() {
    Json out = Json::object();
    if (!limits_.empty()) out["limits"] = std::move(limits_);
    if (!drives_.empty()) out["drives"] = std::move(drives_);
    return out;
  }

  bool is_complete = true;

 private:
  static Json begin_drive(int axis, const char* mode) {
    return {{"type", axis < 3 ? "linear" : "angular"}, {"mode", mode}, {"axis", axis % 3}};
  }

  Json limits_ = Json::array(), drives_ = Json::array();
};

struct Describe {
  JointDescription& out;

  bool operator()(const BallDef& def) const {
    out.lock({0, 1, 2});
    out.is_complete = def.friction == 0.0f;
    return true;
  }
  bool operator()(const HingeDef& def) const {
    out.lock({0, 1, 2});
    out.lock({4, 5});
    out.main_axis(3, def);
    return true;
  }
  bool operator()(const SliderDef& def) const {
    out.lock({1, 2});
    out.lock({3, 4, 5});
    out.main_axis(0, def);
    return true;
  }
  bool operator()(const FixedDef&) const {
    out.lock({0, 1, 2});
    out.lock({3, 4, 5});
    return true;
  }
  bool operator()(const DistanceDef& def) const {
    const bool is_spring = def.stiffness || def.damping || def.frequency;
    out.is_complete = !is_spring;
    if (def.min_length || def.max_length) {
      out.limit({0, 1, 2}, def.min_length.value_or(0.0f), def.max_length);
    } else if (!is_spring && def.length) {
      out.limit({0, 1, 2}, *def.length, *def.length);
    }
    return true;
  }
  bool operator()(const ConeDef& def) const {
    out.lock({0, 1, 2});
    out.is_complete = def.drive.max_torque == 0.0f;
    out.main_axis(3, def);
    if (def.swing_y) out.limit({4}, -*def.swing_y, *def.swing_y);
    if (def.swing_z) out.limit({5}, -*def.swing_z, *def.swing_z);
    return true;
  }
  bool operator()(const UniversalDef& def) const {
    out.lock({0, 1, 2});
    out.main_axis(3, def);
    out.lock({4});
    JointAxisDef second = def.angular_z;
    if (second.motion == AxisMotion::locked) second.motion = AxisMotion::free;
    out.axis(5, second);
    return true;
  }
  bool operator()(const SixDofDef& def) const {
    const JointAxisDef* const axes[] = {&def.linear_x,  &def.linear_y,  &def.linear_z,
                                        &def.angular_x, &def.angular_y, &def.angular_z};
    for (int i = 0; i < 6; ++i) out.axis(i, *axes[i]);
    return true;
  }
  // x is the suspension, z the axle.
  bool operator()(const WheelDef& def) const {
    out.lock({1, 2});
    out.lock({4});
    if (def.limits) out.limit({0}, def.limits->low, def.limits->high);
    out.drive(0, def.stiffness, def.damping, 0.0f);
    out.axis(3, def.steering);
    out.drive(5, def.motor);
    out.is_complete = out.is_complete && def.friction == 0.0f && def.limit_frequency == 0.0f;
    return true;
  }
  template <class Def>
  bool operator()(const Def&) const {
    return false;
  }
};

}  // namespace

Quat joint_frame(Vec3 axis, const std::optional<Vec3>& axis_b) {
  const Vec3 x = normalized(axis);
  const Vec3 z =
      axis_b ? normalized(*axis_b - dot(*axis_b, x) * x, any_perpendicular(x)) : any_perpendicular(x);
  return normalized(from_matrix({x, cross(z, x), z}));
}

std::optional<GltfJoint> gltf_joint(const JointDef& joint) {
  JointDescription description;
  if (!std::visit(Describe{description}, joint)) return std::nullopt;
  GltfJoint out;
  const auto place = [&](const auto& def) {
    out.anchor_a = out.anchor_b = def.anchor;
    if constexpr (requires { def.anchor_b; }) {
      if (def.anchor_b) out.anchor_b = *def.anchor_b;
    }
    if constexpr (requires { def.axis; }) {
      std::optional<Vec3> across;
      if constexpr (requires { def.axis_b; }) across = def.axis_b;
      out.orientation = joint_frame(def.axis, across);
    }
    if (def.break_force || def.break_torque) description.is_complete = false;
  };
  std::visit(place, joint);
  out.is_complete = description.is_complete;
  out.description = description.take();
  return out;
}

}  // namespace gyre
