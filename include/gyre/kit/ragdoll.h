// Ragdolls: bodies and joints made from a description of a skeleton, limp or driven to an animated pose.
//
// Made of the public interface alone, like a user's own. RagdollDef says what a ragdoll is, Ragdoll where it is in a world and how it
// was driven last: plain data; copy it with a snapshot of the world and both can be rolled back. Call drive_ragdoll once before each
// World::step with the same seconds; a limp ragdoll needs no calls. SI units. docs/ragdolls.md gives the equations, the sources of the
// humanoid's numbers, and what was measured. skeleton_map.h joins ragdolls to finer skeletons.
//
// Frames: bone, of each body; model, in which the rest pose stands (the root bone's parent); world. A bone turns about its own origin.
#pragma once

#include <gyre/world.h>

#include <span>
#include <string_view>
#include <vector>

namespace gyre::kit {

// ---------------------------------------------------------------------------------------------------------- description

// A name of up to 47 bytes; what is longer is cut.
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
  cone,   // turns all ways: swing within an ellipse, and twist
  hinge,  // turns about one axis
  ball,   // turns all ways without limits
  fixed,  // does not turn
};

// How a bone hangs on its parent, at its own origin. The joint's frame, on the bone: x along `axis`, z along `across` as far as
// that is across. Angles are turns of the bone about these axes out of the rest pose.
struct BoneJoint {
  BoneJointKind kind = BoneJointKind::cone;
  Vec3 axis{1, 0, 0};         // bone frame: hinge: what it turns about; cone: along the limb, what it twists about
  Vec3 across{0, 0, 1};       // cone: z of the joint's frame
  Limits turn{-0.5f, 0.5f};   // rad. Hinge: its angle. Cone: twist
  Limits swing_y{-0.5f, 0.5f};  // rad. Cone: about y and z. Half of high - low is how far the ellipse reaches, at most pi; its
  Limits swing_z{-0.5f, 0.5f};  // middle is where the limits' middles are
  float friction = 0.0f;      // N m, dry
  float max_torque = 100.0f;  // N m, of the motor at full strength
};

struct BoneDef {
  BoneName name{};              // unique
  int parent = -1;                 // a bone before this one; -1: the root, which is the first and the only one
  Transform rest{};                // parent_from_bone in the rest pose; of the root: model_from_bone
  std::vector<ShapeDef> shapes{};  // bone frame
  // As in BodyDef: kg, kg m^2 about the centre of mass, bone axes. None: as the shapes say.
  std::optional<float> mass{};
  std::optional<Sym3> inertia{};
  BoneJoint joint{};  // the root's means nothing
};

struct RagdollDef {
  static constexpr int kMaxBones = 256;
  std::vector<BoneDef> bones{};
  // Which bones of one ragdoll do not touch each other: those that are at most so many joints apart (1: bone and parent; at least 1),
  // those that overlap in the rest pose if asked, and these pairs. To let none touch, give all shapes one negative Filter::group.
  int neighbours = 1;
  bool skip_rest_overlaps = true;
  struct Pair {
    int a = 0, b = 0;
  };
  std::vector<Pair> apart{};
  float linear_damping = 0.0f;  // 1/s, of all bones
  float angular_damping = 0.05f;
};

// Why a definition cannot be used, with the bone and the field; code none if it can.
Error check_ragdoll(const RagdollDef& def);

// The bone of a name; -1 if there is none.
int find_bone(const RagdollDef& def, std::string_view name);

// A person: 16 bones, pelvis first, standing upright on y = 0 with the arms to the sides; y up, z forward, x to the left. Masses, lengths
// and limits are those of docs/ragdolls.md. `height` in m (0.1 to 10), `mass` in kg.
RagdollDef make_humanoid(float height = 1.741f, float mass = 73.0f);

// How unlike the bones of a joint may be, for contacts, limits and motors that must not fight each other.
struct StableDef {
  float mass_ratio = 5.0f;     // of a bone to its parent, and of the parent to it: at most
  float slenderness = 10.0f;   // largest principal moment over the smallest: at most
  float inertia_ratio = 8.0f;  // largest principal moment of a bone over the smallest of its parent: at most
};
// The same ragdoll with masses shifted between bones, their sum as it was, and moments of inertia raised, as little as is enough. Every
// ratio 1 or more. After O. Strunk, "Stop my constraints from blowing up" (Havok), and Jolt Physics' RagdollSettings::Stabilize.
Result<RagdollDef> stabilized(const RagdollDef& def, const StableDef& stable = {});

// ----------------------------------------------------------------------------------------------------------------- poses

// Where all bones are. A drive's target, or what is read of a ragdoll.
struct RagdollPose {
  Pose world_from_model{};
  std::vector<Transform> bones{};  // model_from_bone, one for each bone of the definition
};

RagdollPose rest_pose(const RagdollDef& def, const Pose& world_from_model = {});
// Every joint in the middle of its limits.
RagdollPose middle_pose(const RagdollDef& def, const Pose& world_from_model = {});
// Turns a bone about its joint by a rotation vector (rad, the joint's frame: x twist or hinge), and all that hangs on it.
void turn_bone(const RagdollDef& def, RagdollPose& pose, int bone, Vec3 turn);
// How far a bone is turned about its joint against its parent, out of the rest pose: a rotation vector in the joint's frame. Zero for
// the root.
Vec3 bone_turn(const RagdollDef& def, const RagdollPose& pose, int bone);
// How far a bone is beyond its limits in rad; 0 within them.
float beyond_limits(const RagdollDef& def, const RagdollPose& pose, int bone);

// ------------------------------------------------------------------------------------------------------ in a world

// A pull of the bone itself towards its place in the target: a spring and damper on the bone's own mass.
struct BoneKey {
  float strength = 0.0f;       // 0 to 1: share of stiffness and greatest force
  float frequency = 0.0f;      // Hz; 0: as stiff as the step allows
  float damping_ratio = 1.0f;
  float max_force = 1.0e5f;    // N
  float max_torque = 1.0e4f;   // N m
};

// The joint's motor, towards the target's angle between bone and parent.
struct BoneMotor {
  float strength = 0.0f;       // 0 to 1: share of stiffness and of the joint's max_torque
  float frequency = 4.0f;      // Hz, of all that hangs on the joint, as a rigid whole in the rest pose; 0: as stiff as the step allows
  float damping_ratio = 1.0f;
};

// What moves a bone. All that is given acts at once and adds up; nothing: it is limp.
struct BoneDrive {
  bool kinematic = false;  // goes with the target, whatever is in its way
  BoneKey key{};
  // The target's place is taken as it stands to the root: what pulls the bone pushes the root. Else to the world. Of the root
  // itself always the world.
  bool key_to_root = false;
  BoneMotor motor{};
};

// A bone in a world, and what it was told last.
struct RagdollBone {
  BodyId body{};
  JointId joint{};  // to the parent; null for the root
  JointId key{};    // of BoneDrive::key; null until it is wanted
  bool key_to_root = false;
  DVec3 key_place{};     // where the key's joint was made
  Quat key_turn{};
  // Inertia of what hangs on the joint over that of its two bodies, and over that of the bone alone, where the parent is kinematic.
  float motor_share = 1.0f, motor_share_held = 1.0f;
  Pose target{}, target_before{};  // world
  PoseDrive key_drive{};
  PoseDrive joint_drive{};  // cone, ball
  Motor joint_motor{};      // hinge
};

struct Ragdoll {
  std::vector<RagdollBone> bones{};
  std::uint64_t target_step = ~std::uint64_t(0);  // World::step_count at the last target
};

// Puts a ragdoll into the world, at rest, limp. Of `start` its place and the orientations are used; the bones hang together as in the
// rest pose. An error, and nothing is added, if something cannot be used.
Result<Ragdoll> add_ragdoll(World& world, const RagdollDef& def, const RagdollPose& start);
// Bodies and joints.
void remove_ragdoll(World& world, Ragdoll& ragdoll);

// Drives the ragdoll for the next step of `seconds`, at whose end it should stand as `target`. Velocities are those from the last call's
// target to this one, if a step ago; without such a call the target rests. `drives`: one for all bones, or one for each. May be another one
// in each call; bones that cease to be kinematic keep their velocity. An error if something cannot be used; nothing changes then.
Error drive_ragdoll(World& world, const RagdollDef& def, Ragdoll& ragdoll, const RagdollPose& target,
                    std::span<const BoneDrive> drives, float seconds);

// Where the bones are. Model is where the root would be in its rest pose.
RagdollPose read_ragdoll(const World& world, const RagdollDef& def, const Ragdoll& ragdoll);

}  // namespace gyre::kit
