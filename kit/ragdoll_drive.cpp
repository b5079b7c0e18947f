// Drives ragdolls: sets a target for each bone and the next step, with the engine's soft rows, which bear any stiffness.
//
// A key is a motor joint between the bone and the world (or the root). A motor is the drive of the bone's own joint. Neither has a target
// that moves within a step. So they get the target's pose in the mean of the ends of the step's half-steps, and its velocity: a bone then
// follows a steady motion without lag. A target is set only if it changed, so that a ragdoll with a resting target may sleep.
#include "kit/ragdoll_frames.h"

namespace gyre::kit {

namespace {

// Distance from a key's joint above which floats would be too coarse for the position.
constexpr double kFar = 64.0;  // m

// Angles of a joint's rotation are taken the short way round.
Quat shortest(Quat q) { return q.w < 0.0f ? -q : q; }

bool same(const PoseDrive& a, const PoseDrive& b) {
  return a.position == b.position && a.orientation == b.orientation &&
         a.linear_velocity == b.linear_velocity && a.angular_velocity == b.angular_velocity &&
         a.frequency == b.frequency && a.damping_ratio == b.damping_ratio && a.max_force == b.max_force &&
         a.max_torque == b.max_torque;
}
bool same(const Motor& a, const Motor& b) {
  return a.target_velocity == b.target_velocity && a.target_position == b.target_position &&
         a.max_force == b.max_force && a.frequency == b.frequency && a.damping_ratio == b.damping_ratio;
}

class Driver {
 public:
  Driver(World& world, const RagdollDef& def, Ragdoll& ragdoll, const RagdollPose& target, float seconds)
      : world_(world), def_(def), ragdoll_(ragdoll), seconds_(seconds) {
    moves_ = world.step_count() == ragdoll.target_step + 1;
    const float n = float(world.substeps());  // each has two half-steps
    mean_ = moves_ ? 0.5f + 0.25f / n : 1.0f;
    for (std::size_t i = 0; i < def.bones.size(); ++i) {
      RagdollBone& bone = ragdoll.bones[i];
      bone.previous_target = bone.target;
      bone.target = target.world_from_model * target.bones[i];
      bone.target.orientation = normalized(bone.target.orientation);
    }
    ragdoll.target_step = world.step_count();
  }

  void run(std::span<const BoneDrive> drives) {
    for (std::size_t i = 0; i < def_.bones.size(); ++i) {
      const BoneDrive& drive = drives[drives.size() == 1 ? 0 : i];
      move(i, drive.kinematic);
      pull(i, drive);
      turn(i, drive.motor);
    }
  }

 private:
  const Pose& before(std::size_t i) const { return ragdoll_.bones[i].previous_target; }
  const Pose& after(std::size_t i) const { return ragdoll_.bones[i].target; }

  void move(std::size_t i, bool kinematic) {
    const BodyId body = ragdoll_.bones[i].body;
    const BodyType type = kinematic ? BodyType::kinematic : BodyType::dynamic;
    if (world_.type(body) != type) world_.set_type(body, type);
    if (kinematic) world_.move_kinematic(body, after(i), seconds_);
  }

  // ------------------------------------------------------------------------------------------------------------- keys

  void pull(std::size_t i, const BoneDrive& drive) {
    RagdollBone& b = ragdoll_.bones[i];
    const bool wanted = drive.key.strength > 0.0f && !drive.kinematic;
    const bool to_root = drive.key_to_root && i > 0;
    if (!wanted) {
      if (b.key && world_.joint_enabled(b.key)) world_.set_joint_enabled(b.key, false);
      return;
    }
    const BodyId root = ragdoll_.bones[0].body;
    const bool far = !to_root && length(after(i).position - b.key_position) > kFar;
    if (b.key && (far || b.key_to_root != to_root)) {
      world_.remove_joint(b.key);
      b.key = {};
    }
    if (!b.key) make_key(b, to_root ? root : BodyId{});
    if (!world_.joint_enabled(b.key)) world_.set_joint_enabled(b.key, true);
    const BoneKey& key = drive.key;
    PoseDrive d = to_root ? key_from_root(i) : key_from_world(i);
    d.frequency = key.frequency * std::sqrt(key.strength);
    d.damping_ratio = key.damping_ratio;
    d.max_force = key.strength * key.max_force;
    d.max_torque = key.strength * key.max_torque;
    if (same(d, b.key_drive)) return;
    world_.set_drive(b.key, d);
    b.key_drive = d;
  }

  // The frames of the joint: the body's is its present one, at its centre of mass.
  void make_key(RagdollBone& b, BodyId to) {
    const Pose pose = world_.pose(b.body);
    const Mat3 frame = to_matrix(pose.orientation);
    MotorDef joint;
    joint.a = to;
    joint.b = b.body;
    joint.anchor = world_.center_of_mass(b.body);
    joint.axis = frame.x;
    joint.axis_b = frame.z;
    joint.collide_connected = true;  // bones in contact stay in contact
    b.key = world_.add_joint(joint);
    b.key_to_root = bool(to);
    b.key_position = joint.anchor;
    b.key_orientation = normalized(from_matrix(frame));
    b.key_drive = {};
    if (to) {  // relative to the root
      const Pose root = world_.pose(to);
      b.key_position = DVec3(inverse_times(root, joint.anchor));
      b.key_orientation = normalized(conjugate(root.orientation) * b.key_orientation);
    }
  }

  Vec3 center(std::size_t i) const { return world_.mass_properties(ragdoll_.bones[i].body).center; }

  // Returns the target's pose at the mean of the step, between the last call and this one, and its velocities.
  PoseDrive key_from_world(std::size_t i) const {
    const RagdollBone& b = ragdoll_.bones[i];
    const Vec3 c = center(i);
    return in_frame(b.key_orientation, difference(before(i) * c, b.key_position), before(i).orientation,
                    difference(after(i) * c, b.key_position), after(i).orientation);
  }
  PoseDrive key_from_root(std::size_t i) const {
    const RagdollBone& b = ragdoll_.bones[i];
    const Vec3 c = center(i), place = to_float(b.key_position);
    const Transform from = inverse_times(before(0), before(i)), to = inverse_times(after(0), after(i));
    return in_frame(b.key_orientation, from * c - place, from.orientation, to * c - place, to.orientation);
  }
  PoseDrive in_frame(Quat frame, Vec3 before, Quat turned_before, Vec3 after, Quat turned_after) const {
    PoseDrive d;
    d.position = rotate_inverse(frame, lerp(before, after, mean_));
    d.orientation = normalized(conjugate(frame) * between(turned_before, turned_after));
    if (!moves_) return d;
    d.linear_velocity = (1.0f / seconds_) * rotate_inverse(frame, after - before);
    d.angular_velocity = (1.0f / seconds_) *
                         rotate_inverse(frame, to_rotation_vector(turned_after * conjugate(turned_before)));
    return d;
  }
  Quat between(Quat before, Quat after) const {
    const Vec3 way = to_rotation_vector(after * conjugate(before));
    return mean_ == 1.0f ? after : from_rotation_vector(mean_ * way) * before;
  }

  // ----------------------------------------------------------------------------------------------------------- motors

  void turn(std::size_t i, const BoneMotor& motor) {
    const BoneDef& bone = def_.bones[i];
    RagdollBone& b = ragdoll_.bones[i];
    if (bone.parent < 0 || bone.joint.kind == BoneJointKind::fixed) return;
    const std::size_t parent = std::size_t(bone.parent);
    const float most = motor.strength * bone.joint.max_torque;
    const bool held = world_.type(ragdoll_.bones[parent].body) != BodyType::dynamic;
    const float stiffer = std::sqrt(held ? b.motor_share_held : b.motor_share);
    const float frequency = motor.frequency * std::sqrt(motor.strength) * stiffer;
    const float damping = motor.frequency > 0.0f ? motor.damping_ratio * stiffer : motor.damping_ratio;
    const Quat middle = conjugate(middle_turn(bone.joint));
    const Quat from =
        shortest(middle * turn_between(bone, before(parent).orientation, before(i).orientation));
    const Quat to = shortest(middle * turn_between(bone, after(parent).orientation, after(i).orientation));
    // A motor without torque needs no target, and so no update.
    const bool works = most > 0.0f;
    if (bone.joint.kind == BoneJointKind::hinge) {
      Motor m;
      if (works) {
        const float way = twist_of(shortest(to * conjugate(from)));
        m = {moves_ ? way / seconds_ : 0.0f, twist_of(from) + mean_ * way, most, frequency, damping};
      }
      if (same(m, b.joint_motor)) return;
      world_.set_motor(b.joint, m);
      b.joint_motor = m;
      return;
    }
    PoseDrive d;
    if (works) {
      d = in_frame({}, {}, from, {}, to);
      d.frequency = frequency;
      d.damping_ratio = damping;
      d.max_torque = most;
    }
    if (same(d, b.joint_drive)) return;
    world_.set_drive(b.joint, d);
    b.joint_drive = d;
  }

  World& world_;
  const RagdollDef& def_;
  Ragdoll& ragdoll_;
  float seconds_;
  bool moves_ = false;  // the last target was a step ago
  float mean_ = 1.0f;   // share of the path between targets: the mean of the half-steps' ends
};

bool is_share(float v) { return v >= 0.0f && v <= 1.0f; }
bool is_amount(float v) { return v >= 0.0f && v <= 1.0e9f; }

Error refuse(const char* what) { return make_error(ErrorCode::invalid_argument, "ragdoll: %s", what); }

Error check_drive(const BoneDrive& d) {
  if (!is_share(d.key.strength) || !is_share(d.motor.strength))
    return refuse("the strength of a drive must be 0 to 1");
  if (!is_amount(d.key.max_force) || !is_amount(d.key.max_torque))
    return refuse("the max_force and max_torque of a key must be 0 to 1e9");
  const auto in_range = [](float v) { return v >= 0.0f && v <= 1.0e4f; };
  if (!in_range(d.key.frequency) || !in_range(d.motor.frequency) || !in_range(d.key.damping_ratio) ||
      !in_range(d.motor.damping_ratio)) {
    return refuse("the frequency and damping_ratio of a drive must be 0 to 1e4");
  }
  return {};
}

}  // namespace

Error drive_ragdoll(World& world, const RagdollDef& def, Ragdoll& ragdoll, const RagdollPose& target,
                    std::span<const BoneDrive> drives, float seconds) {
  const std::size_t count = def.bones.size();
  if (count == 0 || ragdoll.bones.size() != count || target.bones.size() != count)
    return refuse("the ragdoll and its target must have as many bones as the definition");
  if (drives.size() != 1 && drives.size() != count) return refuse("drives must be one, or one for each bone");
  if (!(seconds > 0.0f && seconds <= 1.0f)) return refuse("seconds must be above 0 and at most 1");
  for (const RagdollBone& bone : ragdoll.bones) {
    if (!world.exists(bone.body))
      return make_error(ErrorCode::stale_id, "ragdoll: body %u does not exist in this world",
                        bone.body.index);
  }
  for (const Transform& bone : target.bones) {
    if (!is_finite(bone) || !(absolute(dot(bone.orientation, bone.orientation) - 1.0f) < 1.0e-3f))
      return refuse("a target's bones must be finite, their orientations of length 1");
  }
  if (!is_finite(target.world_from_model)) return refuse("a target's place must be finite");
  for (const BoneDrive& drive : drives) {
    const Error e = check_drive(drive);
    if (e) return e;
  }
  Driver(world, def, ragdoll, target, seconds).run(drives);
  return {};
}

}  // namespace gyre::kit
