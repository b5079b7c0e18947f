// Ragdolls: bodies and joints made from a description of a skeleton, limp or driven to an animated pose.
//
// It uses the public headers only. RagdollDef describes a ragdoll; Ragdoll has its bodies in a world and its last drive. Both are plain
// data: copy Ragdoll together with a snapshot of the world, and both can be rolled back. Call drive_ragdoll once before each World::step
// with the same seconds; a limp ragdoll needs no calls. SI units. docs/ragdolls.md has the equations, the sources of the humanoid's
// numbers, and measurements. skeleton_map.h maps ragdolls to finer skeletons.
//
// Frames: bone, of each body; model, the frame of the rest pose (the root bone's parent); world. A bone rotates about its own origin.
#pragma once

#include <gyre/world.h>

#include <span>
#include <string_view>
#include <vector>

namespace gyre::kit {

// ---------------------------------------------------------------------------------------------------------- description

// A name of up to 47 bytes; longer names are cut.
class BoneName {
 public:
  constexpr BoneName() = default;
  constexpr BoneName(const char* text) : BoneName(std::string_view(text)) {}
  constexpr BoneName(std::string_view text) {
    for (std::size_t i = 0; i < text.size() && i + 1 < sizeof text_; ++i) text_[i] = text[i];
  }
  constexpr const char* c_str() const { return text_; }
  constexpr operator std::string_view() const { return text_; }

 private:
  char text_[48] = {};
};

enum class BoneJointKind : std::uint8_t {
  cone,   // three rotations: swing within an ellipse, and twist
  hinge,  // one rotation about an axis
  ball,   // three rotations without limits
  fixed,  // no rotation
};

// The joint between a bone and its parent, at the bone's origin. The joint's frame on the bone has x along `axis` and z along `across`, made
// perpendicular to x. Angles are rotations of the bone about these axes from the rest pose.
struct BoneJoint {
  BoneJointKind kind = BoneJointKind::cone;
  Vec3 axis{1, 0, 0};         // bone frame: hinge: the axis of rotation; cone: the axis of twist, along the limb
  Vec3 across{0, 0, 1};       // cone: z of the joint's frame
  Limits twist{-0.5f, 0.5f};  // rad, about x. Hinge: its angle. Cone: twist
  Limits swing_y{-0.5f, 0.5f};  // rad. Cone: about y and z. Half of high - low is the semi-axis of the ellipse, at most pi; the
  Limits swing_z{-0.5f, 0.5f};  // centre of the ellipse is at the middles of the limits
  float friction = 0.0f;      // N m, dry
  float max_torque = 100.0f;  // N m, of the motor at full strength
};

struct BoneDef {
  BoneName name{};              // unique
  int parent = -1;                 // a bone before this one; -1: the root, which is the first and the only one
  Transform rest{};                // parent_from_bone in the rest pose; of the root: model_from_bone
  std::vector<ShapeDef> shapes{};  // bone frame
  // As in BodyDef: kg, kg m^2 about the centre of mass, bone axes. None: from the shapes.
  std::optional<float> mass{};
  std::optional<Sym3> inertia{};
  BoneJoint joint{};  // unused for the root
};

struct RagdollDef {
  static constexpr int kMaxBones = 256;
  std::vector<BoneDef> bones{};
  // Bones of one ragdoll that do not collide with each other: bones at most `neighbours` joints apart (1: bone and parent; at least 1),
  // bones that overlap in the rest pose (if skip_rest_overlaps), and filtered_pairs. To let none collide, give all shapes one negative
  // Filter::group.
  int neighbours = 1;
  bool skip_rest_overlaps = true;
  struct Pair {
    int a = 0, b = 0;
  };
  std::vector<Pair> filtered_pairs{};
  float linear_damping = 0.0f;  // 1/s, of all bones
  float angular_damping = 0.05f;
};

// The reason why a definition is invalid, with the bone and the field; code none if it is valid.
Error check_ragdoll(const RagdollDef& def);

// The index of the bone with a name; -1 if there is none.
int find_bone(const RagdollDef& def, std::string_view name);

// A person: 16 bones, pelvis first, standing upright on y = 0 with the arms to the sides; y up, z forward, x to the left. Masses, lengths
// and limits are those of docs/ragdolls.md. `height` in m (0.1 to 10), `mass` in kg.
RagdollDef make_humanoid(float height = 1.741f, float mass = 73.0f);

// Upper bounds of the ratios of mass and inertia, for stable contacts, limits and motors. Each is at least 1.
struct StableDef {
  float mass_ratio = 5.0f;     // of a bone to its parent, and of the parent to the bone
  float slenderness = 10.0f;   // largest principal moment of a bone over its smallest
  float inertia_ratio = 8.0f;  // largest principal moment of a bone over the smallest of its parent
};
// The same ragdoll within these bounds, with as little change as possible: masses are shifted between bones, their sum is kept, and moments
// of inertia are raised. After O. Strunk, "Stop my constraints from blowing up" (Havok), and Jolt Physics' RagdollSettings::Stabilize.
Result<RagdollDef> stabilized(const RagdollDef& def, const StableDef& stable = {});

// ----------------------------------------------------------------------------------------------------------------- poses

// Poses of all bones: the target of a drive, or the present pose of a ragdoll.
struct RagdollPose {
  Pose world_from_model{};
  std::vector<Transform> bones{};  // model_from_bone, one for each bone of the definition
};

RagdollPose rest_pose(const RagdollDef& def, const Pose& world_from_model = {});
// Every joint in the middle of its limits.
RagdollPose middle_pose(const RagdollDef& def, const Pose& world_from_model = {});
// Rotates a bone about its joint by a rotation vector (rad, the joint's frame: x twist or hinge), with all bones below it.
void rotate_bone(const RagdollDef& def, RagdollPose& pose, int bone, Vec3 rotation);
// The rotation of a bone relative to its parent from the rest pose, as a rotation vector in the joint's frame. Zero for the root.
Vec3 bone_rotation(const RagdollDef& def, const RagdollPose& pose, int bone);
// By how much a bone is beyond its limits, in rad; 0 within them.
float limit_violation(const RagdollDef& def, const RagdollPose& pose, int bone);

// ------------------------------------------------------------------------------------------------------ in a world

// A drive of the bone towards its pose in the target: a spring and damper on the bone's own mass.
struct BoneKey {
  float strength = 0.0f;       // 0 to 1: share of stiffness and maximum force
  float frequency = 0.0f;      // Hz; 0: as stiff as the step allows
  float damping_ratio = 1.0f;
  float max_force = 1.0e5f;    // N
  float max_torque = 1.0e4f;   // N m
};

// The joint's motor, towards the target's angle between bone and parent.
struct BoneMotor {
  float strength = 0.0f;       // 0 to 1: share of stiffness and of the joint's max_torque
  float frequency = 4.0f;      // Hz, of all bones below the joint as one rigid body in the rest pose; 0: as stiff as the step allows
  float damping_ratio = 1.0f;
};

// The drive of a bone. All parts act at once and add up; without any the bone is limp.
struct BoneDrive {
  bool kinematic = false;  // the bone follows the target exactly and ignores obstacles
  BoneKey key{};
  // The key's target is relative to the root bone, and the opposite force acts on the root. Otherwise it is relative to the world. For
  // the root it always is the world.
  bool key_to_root = false;
  BoneMotor motor{};
};

// A bone in a world, and its last drive.
struct RagdollBone {
  BodyId body{};
  JointId joint{};  // to the parent; null for the root
  JointId key{};    // of BoneDrive::key; null until it is first used
  bool key_to_root = false;
  DVec3 key_position{};  // of the key's joint when it was added
  Quat key_orientation{};
  // Inertia of all bones below the joint relative to that of its two bodies, and to that of the bone alone if the parent is kinematic.
  float motor_share = 1.0f, motor_share_held = 1.0f;
  Pose target{}, previous_target{};  // world
  PoseDrive key_drive{};
  PoseDrive joint_drive{};  // cone, ball
  Motor joint_motor{};      // hinge
};

struct Ragdoll {
  std::vector<RagdollBone> bones{};
  std::uint64_t target_step = ~std::uint64_t(0);  // World::step_count at the last target
};

// Adds a ragdoll to the world, at rest and limp. It uses the root's pose and the orientations of `start`; offsets between bones are those of
// the rest pose. Returns an error, and adds nothing, if something is invalid.
Result<Ragdoll> add_ragdoll(World& world, const RagdollDef& def, const RagdollPose& start);
// Removes its bodies and joints.
void remove_ragdoll(World& world, Ragdoll& ragdoll);

// Drives the ragdoll for the next step of `seconds`, towards `target` at the end of that step. The target's velocity is the difference to the
// target of the call one step ago; without such a call it is zero. `drives` has one element for all bones, or one for each, and may differ
// from call to call. A bone that stops being kinematic keeps its velocity. Returns an error, and changes nothing, if something is invalid.
Error drive_ragdoll(World& world, const RagdollDef& def, Ragdoll& ragdoll, const RagdollPose& target,
                    std::span<const BoneDrive> drives, float seconds);

// The present poses of the bones. The model frame follows the root: the root is at its rest pose in it.
RagdollPose read_ragdoll(const World& world, const RagdollDef& def, const Ragdoll& ragdoll);

}  // namespace gyre::kit
