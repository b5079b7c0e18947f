// Joints: one definition per kind, each with the fields of its kind alone. World::add_joint takes any of them. SI units.
//
// A joint constrains two bodies, or a body and the world. Anchors, axes and points are in the world frame, for the poses of the bodies
// when the joint is added. This relative pose is the zero of all angles and translations below. A joint has a frame on each body: the
// origin is the anchor, x points along `axis`, and z along the part of `axis_b` perpendicular to x. docs/joints.md gives the equations.
//
// At most one of `a` and `b` is null, which means the world. A joint with break_force or break_torque is removed in the first step in
// which its load is larger, and Events::broken lists it.
#pragma once

#include <gyre/ids.h>
#include <gyre/math.h>

#include <cstdint>
#include <optional>
#include <variant>
#include <vector>

namespace gyre {

enum class JointKind : std::uint8_t {
  ball,             // one common point
  hinge,            // one common point and axis
  slider,           // b slides along an axis of a and does not turn against it
  fixed,            // b keeps its pose in a
  distance,         // rod, rope or spring between a point of a and a point of b
  cone,             // a ball whose swing stays within an ellipse and whose twist within limits: a shoulder
  universal,        // one common point; b turns about `axis`, fixed in a, and `axis_b`, fixed in b, at a constant angle between them
  six_dof,          // six axes, each of them locked, free or limited, and sprung or driven
  gear,             // a's rotation about `axis` is -ratio times b's rotation about `axis_b`
  rack_and_pinion,  // b's translation along `axis_b` is ratio times a's rotation about `axis`
  pulley,           // a rope from a over two fixed points to b; it pulls and never pushes
  wheel,            // b spins about `axis_b`, is sprung along `axis` of a, and is steered about it
  path,             // a point of b stays on a curve that is fixed in a
  mouse,            // a point of b is dragged with a limited force
  motor,            // b is driven to a pose in a with a limited force and torque
};
constexpr int kJointKindCount = 15;
const char* to_string(JointKind kind);

// The axes of a joint's frame on a. The linear axes measure the position of b's anchor from a's.
// The angular axes are Cardan angles: about a's x, then about the rotated y, then about b's z.
// The angle y stays within a quarter turn.
enum class JointAxis : std::uint8_t { linear_x, linear_y, linear_z, angular_x, angular_y, angular_z };
constexpr int kJointAxisCount = 6;
const char* to_string(JointAxis axis);

// ------------------------------------------------------------------------------------------------------ shared parts

struct Limits {
  float low = 0.0f;   // rad (turning) or m (sliding)
  float high = 0.0f;
};

// Drives an angle (rad, N m) or a translation (m, N) with at most max_force. With target_position the motor is a spring to that
// position (frequency, damping_ratio), whose damper brakes the difference from target_velocity: set it to the speed of a position that
// moves. If the position stands and target_velocity does not vanish, the axis rests off the position by
// 2 damping_ratio target_velocity / (2 pi frequency). Without target_position the motor drives to target_velocity.
struct Motor {
  float target_velocity = 0.0f;
  std::optional<float> target_position{};
  float max_force = 0.0f;      // 0 = no motor
  float frequency = 0.0f;      // Hz, of the position spring; 0 = as stiff as the step allows
  float damping_ratio = 1.0f;
};

enum class AxisMotion : std::uint8_t {
  locked,   // stays where it was when the joint was added
  free,     // not held; may be driven, sprung and braked
  limited,  // free between limits
};

// One axis of a joint: its motion and the forces on it. All forces act at once and add up.
struct JointAxisDef {
  AxisMotion motion = AxisMotion::locked;
  Limits limits{};                   // if limited; rad or m, zero is the pose when added
  float limit_frequency = 0.0f;      // Hz, of springs as soft limits, on the effective mass of the axis; 0 = hard limits
  float limit_damping_ratio = 1.0f;
  Motor motor{};
  float stiffness = 0.0f;            // N/m or N m/rad: Hooke's spring to rest_position
  float damping = 0.0f;              // N s/m or N m s/rad
  float rest_position = 0.0f;        // m or rad
  float friction = 0.0f;             // N or N m: dry friction against motion
};

// Drives b to a pose in a (motor, mouse and cone joints). With a frequency the drive is a spring to the pose; frequency 0 is as stiff as
// the step allows. The velocities move the target.
struct PoseDrive {
  Vec3 position{};               // m, of b's anchor from a's, in the joint's frame on a
  Quat orientation{};            // joint's frame on a from joint's frame on b; identity is the pose when added
  Vec3 linear_velocity{};        // m/s, of the target, in the joint's frame on a
  Vec3 angular_velocity{};       // rad/s
  float frequency = 0.0f;        // Hz
  float damping_ratio = 1.0f;
  float max_force = 0.0f;        // N; 0 = no force
  float max_torque = 0.0f;       // N m; 0 = no torque
};

enum class PathOrientation : std::uint8_t {
  free,       // b rotates freely
  fixed,      // b does not rotate against a
  following,  // b rotates with the curve, without twist about the curve
};

// -------------------------------------------------------------------------------------------------- one for each kind

// One common point; b rotates freely about it.
struct BallDef {
  BodyId a{};                           // null = the world
  BodyId b{};                           // null = the world
  DVec3 anchor{};                       // m, world: the common point
  float friction = 0.0f;                // N m, dry: against all rotation
  std::optional<float> break_force{};   // N: larger loads break the joint; none = unbreakable
  std::optional<float> break_torque{};  // N m: larger loads break the joint; none = unbreakable
  bool collide_connected = false;       // true: a and b still collide with each other
};

// One common point and axis: b turns about `axis` of a. A door, an elbow. PhysX and Box3D: revolute.
struct HingeDef {
  BodyId a{};                           // null = the world
  BodyId b{};                           // null = the world
  DVec3 anchor{};                       // m, world: the common point
  Vec3 axis{1, 0, 0};                   // world, any length: positive rotation of b by the right-hand rule
  std::optional<Limits> limits{};       // rad, of b's angle against a; none = b rotates freely
  float limit_frequency = 0.0f;         // Hz, of springs as soft limits, on the effective mass of the axis; 0 = hard limits
  float limit_damping_ratio = 1.0f;     // of these springs
  Motor motor{};                        // rad/s, rad, N m; none by default
  float stiffness = 0.0f;               // N m/rad: a spring to angle zero
  float damping = 0.0f;                 // N m s/rad
  float friction = 0.0f;                // N m, dry: against rotation
  std::optional<float> break_force{};   // N: larger loads break the joint; none = unbreakable
  std::optional<float> break_torque{};  // N m: larger loads break the joint; none = unbreakable
  bool collide_connected = false;       // true: a and b still collide with each other
};

// b slides along `axis` of a and does not turn against it. A piston, a lift. PhysX and Box3D: prismatic.
struct SliderDef {
  BodyId a{};                           // null = the world
  BodyId b{};                           // null = the world
  DVec3 anchor{};                       // m, world: the common point
  Vec3 axis{1, 0, 0};                   // world, any length: positive translation of b
  std::optional<Limits> limits{};       // m, of b's translation; none = b slides freely
  float limit_frequency = 0.0f;         // Hz, of springs as soft limits, on the effective mass of the axis; 0 = hard limits
  float limit_damping_ratio = 1.0f;     // of these springs
  Motor motor{};                        // m/s, m, N; none by default
  float stiffness = 0.0f;               // N/m: a spring to translation zero
  float damping = 0.0f;                 // N s/m
  float friction = 0.0f;                // N, dry: against sliding
  std::optional<float> break_force{};   // N: larger loads break the joint; none = unbreakable
  std::optional<float> break_torque{};  // N m: larger loads break the joint; none = unbreakable
  bool collide_connected = false;       // true: a and b still collide with each other
};

// b keeps its pose in a. Box3D: weld.
struct FixedDef {
  BodyId a{};                           // null = the world
  BodyId b{};                           // null = the world
  DVec3 anchor{};                       // m, world: the reference point of the joint's force and torque
  std::optional<float> break_force{};   // N: larger loads break the joint; none = unbreakable
  std::optional<float> break_torque{};  // N m: larger loads break the joint; none = unbreakable
  bool collide_connected = false;       // true: a and b still collide with each other
};

// A rod, rope or spring between two points. By default the joint is a rod of the present length.
// min_length and max_length make a rope, without force between the two lengths.
// stiffness, damping or frequency make a Hooke spring of rest length `length`.
struct DistanceDef {
  BodyId a{};                           // null = the world
  BodyId b{};                           // null = the world
  DVec3 anchor{};                       // m, world: the point on a
  std::optional<DVec3> anchor_b{};      // m, world: the point on b; none = b's origin
  std::optional<float> length{};        // m, of the rod, or of the spring at rest; none = the present length
  std::optional<float> min_length{};    // m
  std::optional<float> max_length{};    // m
  std::optional<float> stiffness{};     // N/m
  std::optional<float> damping{};       // N s/m
  // Hz, instead of stiffness and damping. The joint converts the frequency to a stiffness when it is added, with the effective mass
  // of the two bodies along the line.
  std::optional<float> frequency{};
  float damping_ratio = 0.0f;           // with frequency: 1 = critical damping
  std::optional<float> break_force{};   // N: larger loads break the joint; none = unbreakable
  std::optional<float> break_torque{};  // N m: larger loads break the joint; none = unbreakable
  bool collide_connected = false;       // true: a and b still collide with each other
};

// A ball with an elliptic limit of the swing and limits of the twist: a shoulder. Jolt: SwingTwist.
struct ConeDef {
  BodyId a{};                           // null = the world
  BodyId b{};                           // null = the world
  DVec3 anchor{};                       // m, world: the common point
  Vec3 axis{1, 0, 0};                   // world, any length: the middle of the cone, along the limb; x of the joint's frame
  std::optional<Vec3> axis_b{};         // world: z of the joint's frame, made perpendicular to x; none = any perpendicular direction
  std::optional<float> swing_y{};       // rad, 0 to pi: the largest swing of b's axis about the frame's y; none = as swing_z
  std::optional<float> swing_z{};       // rad, 0 to pi: about the frame's z; none = as swing_y; none of both = free swing
  std::optional<Limits> limits{};       // rad, of the twist about `axis`; none = free twist
  float limit_frequency = 0.0f;         // Hz, of springs as soft limits of swing and twist, on their effective mass; 0 = hard limits
  float limit_damping_ratio = 1.0f;     // of these springs
  Motor motor{};                        // rad/s, rad, N m, of the twist; none by default
  float stiffness = 0.0f;               // N m/rad: a spring to twist zero
  float damping = 0.0f;                 // N m s/rad
  float friction = 0.0f;                // N m, dry: against all rotation
  PoseDrive drive{};                    // to an orientation; only the angular fields act
  std::optional<float> break_force{};   // N: larger loads break the joint; none = unbreakable
  std::optional<float> break_torque{};  // N m: larger loads break the joint; none = unbreakable
  bool collide_connected = false;       // true: a and b still collide with each other
};

// One common point; b rotates about `axis`, fixed in a, and `axis_b`, fixed in b. The angle of the two is constant. A cardan shaft.
struct UniversalDef {
  BodyId a{};                           // null = the world
  BodyId b{};                           // null = the world
  DVec3 anchor{};                       // m, world: the common point
  Vec3 axis{1, 0, 0};                   // world, any length: fixed in a
  std::optional<Vec3> axis_b{};         // world: fixed in b, 10 degrees or more from `axis`; none = any perpendicular direction
  std::optional<Limits> limits{};       // rad, about `axis`; none = free rotation
  float limit_frequency = 0.0f;         // Hz, of springs as soft limits, on the effective mass of the axis; 0 = hard limits
  float limit_damping_ratio = 1.0f;     // of these springs
  Motor motor{};                        // rad/s, rad, N m, about `axis`; none by default
  float stiffness = 0.0f;               // N m/rad: a spring to angle zero about `axis`
  float damping = 0.0f;                 // N m s/rad
  float friction = 0.0f;                // N m, dry: about `axis`
  JointAxisDef angular_z{};             // the rotation about `axis_b`; locked means free here
  std::optional<float> break_force{};   // N: larger loads break the joint; none = unbreakable
  std::optional<float> break_torque{};  // N m: larger loads break the joint; none = unbreakable
  bool collide_connected = false;       // true: a and b still collide with each other
};

// One definition for each of the six axes of the joint's frame (see JointAxis), locked by default. PhysX: D6.
struct SixDofDef {
  BodyId a{};                           // null = the world
  BodyId b{};                           // null = the world
  DVec3 anchor{};                       // m, world: the origin of the frame
  Vec3 axis{1, 0, 0};                   // world, any length: x of the frame
  std::optional<Vec3> axis_b{};         // world: z of the frame, made perpendicular to x; none = any perpendicular direction
  JointAxisDef linear_x{};              // m, N
  JointAxisDef linear_y{};
  JointAxisDef linear_z{};
  JointAxisDef angular_x{};             // rad, N m
  JointAxisDef angular_y{};
  JointAxisDef angular_z{};
  std::optional<float> break_force{};   // N: larger loads break the joint; none = unbreakable
  std::optional<float> break_torque{};  // N m: larger loads break the joint; none = unbreakable
  bool collide_connected = false;       // true: a and b still collide with each other
};

// a's rotation about `axis` is -ratio times b's rotation about `axis_b`. Both wheels need bearings: hinges. Rotations are measured against
// the body that carries both hinges, if it can move and the shafts are not on one line, and otherwise against the world.
struct GearDef {
  BodyId a{};                           // null = the world
  BodyId b{};                           // null = the world
  DVec3 anchor{};                       // m, world: the reference point of the joint's force and torque
  Vec3 axis{1, 0, 0};                   // world, any length: the shaft of a
  std::optional<Vec3> axis_b{};         // world: the shaft of b; none = as `axis`
  float ratio = 1.0f;                   // not 0: b's teeth over a's; negative if both rotate the same way
  std::optional<float> break_force{};   // N: larger loads break the joint; none = unbreakable
  std::optional<float> break_torque{};  // N m: larger loads break the joint; none = unbreakable
  bool collide_connected = false;       // true: a and b still collide with each other
};

// b, the rack, moves along `axis_b` by ratio times a's rotation about `axis`. Both need bearings: a slider and a hinge.
struct RackAndPinionDef {
  BodyId a{};                           // null = the world
  BodyId b{};                           // null = the world
  DVec3 anchor{};                       // m, world: the reference point of the joint's force and torque
  Vec3 axis{1, 0, 0};                   // world, any length: the shaft of the pinion, a
  std::optional<Vec3> axis_b{};         // world: along the rack, b, perpendicular to `axis`; required
  float ratio = 1.0f;                   // m/rad, not 0: the pinion's radius
  std::optional<float> break_force{};   // N: larger loads break the joint; none = unbreakable
  std::optional<float> break_torque{};  // N m: larger loads break the joint; none = unbreakable
  bool collide_connected = false;       // true: a and b still collide with each other
};

// A rope from a over two points of the world to b: |a's part| + ratio |b's part| <= length. The rope pulls and never pushes.
struct PulleyDef {
  BodyId a{};                           // must be a body
  BodyId b{};                           // must be a body
  DVec3 anchor{};                       // m, world: the point on a
  std::optional<DVec3> anchor_b{};      // m, world: the point on b; none = b's origin
  DVec3 ground_a{};                     // m, world: the fixed pulley of a's part of the rope
  DVec3 ground_b{};                     // m, world: the fixed pulley of b's part of the rope
  float ratio = 1.0f;                   // above 0: factor of b's part
  std::optional<float> length{};        // m, of the rope, with b's part times ratio; none = the present length
  std::optional<float> break_force{};   // N: larger loads break the joint; none = unbreakable
  std::optional<float> break_torque{};  // N m: larger loads break the joint; none = unbreakable
  bool collide_connected = false;       // true: a and b still collide with each other
};

// b, the wheel, spins about `axis_b`. The chassis, a, carries the wheel on a spring along `axis` and steers it about `axis`.
struct WheelDef {
  BodyId a{};                           // null = the world
  BodyId b{};                           // null = the world
  DVec3 anchor{};                       // m, world: the centre of the wheel
  Vec3 axis{1, 0, 0};                   // world, any length: of suspension and steering, from the ground up
  std::optional<Vec3> axis_b{};         // world: the axle, 10 degrees or more from `axis`; none = any perpendicular direction
  std::optional<Limits> limits{};       // m, of the suspension; none = no limits
  float limit_frequency = 0.0f;         // Hz, of springs as soft limits, on the effective mass of the axis; 0 = hard limits
  float limit_damping_ratio = 1.0f;     // of these springs
  float stiffness = 0.0f;               // N/m, of the suspension: a spring to the pose when added
  float damping = 0.0f;                 // N s/m, of the suspension
  Motor motor{};                        // rad/s, rad, N m, of the spin; none by default
  float friction = 0.0f;                // N m, dry, of the spin: a brake
  JointAxisDef steering{};              // rad, N m, about `axis`; locked by default: no steering
  std::optional<float> break_force{};   // N: larger loads break the joint; none = unbreakable
  std::optional<float> break_torque{};  // N m: larger loads break the joint; none = unbreakable
  bool collide_connected = false;       // true: a and b still collide with each other
};

// A point of b stays on a curve that is fixed in a. The curve is a Catmull-Rom spline through `points`.
struct PathDef {
  BodyId a{};                           // null = the world
  BodyId b{};                           // null = the world
  DVec3 anchor{};                       // m, world: the point of b, near the curve
  // m, from the anchor, world axes; 2 to kMaxPathPoints points, a closed curve at least 3; neighbours must differ.
  std::vector<Vec3> points{};
  bool closed = false;                  // true: the curve goes on from the last point to the first
  PathOrientation orientation = PathOrientation::free;
  std::optional<Limits> limits{};       // m along the curve; none = the ends of an open curve, no limits on a closed one
  float limit_frequency = 0.0f;         // Hz, of springs as soft limits, on the effective mass of the axis; 0 = hard limits
  float limit_damping_ratio = 1.0f;     // of these springs
  Motor motor{};                        // m/s, m, N, along the curve; none by default
  float stiffness = 0.0f;               // N/m: a spring to the position when added
  float damping = 0.0f;                 // N s/m
  float friction = 0.0f;                // N, dry: against motion along the curve
  std::optional<float> break_force{};   // N: larger loads break the joint; none = unbreakable
  std::optional<float> break_torque{};  // N m: larger loads break the joint; none = unbreakable
  bool collide_connected = false;       // true: a and b still collide with each other
};
constexpr int kMaxPathPoints = 4096;

// A limited force drags a point of b, as a mouse does. World::set_drive moves the target.
struct MouseDef {
  BodyId a{};                           // null = the world, the usual case
  BodyId b{};                           // null = the world
  DVec3 anchor{};                       // m, world: the point of b
  PoseDrive drive{};                    // only the linear fields, frequency and damping_ratio act
  std::optional<float> break_force{};   // N: larger loads break the joint; none = unbreakable
  std::optional<float> break_torque{};  // N m: larger loads break the joint; none = unbreakable
  bool collide_connected = false;       // true: a and b still collide with each other
};

// A limited force and torque drive b to a pose in a. World::set_drive moves the pose.
struct MotorDef {
  BodyId a{};                           // null = the world
  BodyId b{};                           // null = the world
  DVec3 anchor{};                       // m, world: the origin of the joint's frames
  Vec3 axis{1, 0, 0};                   // world, any length: x of the frames
  std::optional<Vec3> axis_b{};         // world: z of the frames, made perpendicular to x; none = any perpendicular direction
  PoseDrive drive{};                    // the pose, and the stiffness and largest force of the drive
  std::optional<float> break_force{};   // N: larger loads break the joint; none = unbreakable
  std::optional<float> break_torque{};  // N m: larger loads break the joint; none = unbreakable
  bool collide_connected = false;       // true: a and b still collide with each other
};

// A definition of any kind. The alternatives have the order of JointKind.
using JointDef = std::variant<BallDef, HingeDef, SliderDef, FixedDef, DistanceDef, ConeDef, UniversalDef, SixDofDef, GearDef,
                              RackAndPinionDef, PulleyDef, WheelDef, PathDef, MouseDef, MotorDef>;

inline JointKind kind_of(const JointDef& def) { return JointKind(def.index()); }
// A definition of the kind with default fields, for file readers and tools.
JointDef default_joint(JointKind kind);

}  // namespace gyre
