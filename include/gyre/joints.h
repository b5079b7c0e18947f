// Joints: one definition per kind, each with the fields of that kind alone. World::add_joint takes any of them.
//
// A joint holds two bodies, or a body and the world. Anchors, axes and points are given in the world frame as the bodies stand when
// the joint is added, and are stored in the bodies' frames. That pose is the zero of every angle (rad) and length (m) below. A joint's
// frame on a and on b has its origin at the anchor, x along `axis` and z along `axis_b` as far as that is across. SI units.
// docs/joints.md gives the equations of each kind.
//
// One of the bodies `a` and `b` must be a body. A joint that breaks is removed, and is in the step's events.
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
  universal,        // one common point; b turns about `axis`, fixed in a, and about `axis_b`, fixed in b, which keep their angle
  six_dof,          // each of the six axes of the joint as it is told: locked, free, limited, sprung, driven
  gear,             // a's turning about `axis` is -ratio times b's turning about `axis_b`
  rack_and_pinion,  // b's travel along `axis_b` is ratio times a's turning about `axis`
  pulley,           // a rope from a over two fixed points to b; it pulls and never pushes
  wheel,            // b spins about `axis_b`, is sprung along `axis` of a, and is steered about it
  path,             // a point of b stays on a curve that is fixed in a
  mouse,            // a point of b is dragged with a limited force
  motor,            // b is driven to a pose in a with a limited force and torque
};
constexpr int kJointKindCount = 15;
const char* to_string(JointKind kind);

// The axes of a joint's frame: x along `axis`, z along `axis_b` as far as that is across, fixed in a. Linear: where b's
// anchor is from a's. Angular: Cardan angles x, y, z, each about an axis that the one before has turned (x is fixed in a, z
// in b); y stays within a quarter turn.
enum class JointAxis : std::uint8_t { linear_x, linear_y, linear_z, angular_x, angular_y, angular_z };
constexpr int kJointAxisCount = 6;
const char* to_string(JointAxis axis);

// ------------------------------------------------------------------------------------------------------ shared parts

struct Limits {
  float low = 0.0f;   // rad (turning) or m (sliding)
  float high = 0.0f;
};

// Drives what turns (rad, N m) or slides (m, N). With target_position it is a spring to that position (frequency,
// damping_ratio), otherwise it drives to target_velocity; either way with at most max_force.
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

// What holds for one axis of a joint. All that is given acts at once and adds up.
struct JointAxisDef {
  AxisMotion motion = AxisMotion::locked;
  Limits limits{};                   // if limited; rad or m, zero is the pose when added
  float limit_frequency = 0.0f;      // Hz: the ends give way like springs on what the joint moves; 0 = they hold
  float limit_damping_ratio = 1.0f;
  Motor motor{};
  float stiffness = 0.0f;            // N/m or N m/rad: Hooke's spring to rest_position
  float damping = 0.0f;              // N s/m or N m s/rad
  float rest_position = 0.0f;        // m or rad
  float friction = 0.0f;             // N or N m: dry friction against motion
};

// Drives b to a pose in a: motors, mice, cones. With a frequency the pose is a spring's rest; frequency 0 is as stiff as the step
// allows. The velocities are what it moves on with.
struct PoseDrive {
  Vec3 position{};               // m, of b's anchor from a's, in the joint's frame on a
  Quat orientation{};            // joint's frame on a from joint's frame on b; as they were when added: none
  Vec3 linear_velocity{};        // m/s, of the target, in the joint's frame on a
  Vec3 angular_velocity{};       // rad/s
  float frequency = 0.0f;        // Hz
  float damping_ratio = 1.0f;
  float max_force = 0.0f;        // N; 0 = it does not push
  float max_torque = 0.0f;       // N m; 0 = it does not turn
};

enum class PathOrientation : std::uint8_t {
  free,       // b turns as it likes
  fixed,      // b does not turn against a
  following,  // b turns with the curve, without twist about it
};

// -------------------------------------------------------------------------------------------------- one for each kind

// One common point; b turns freely about it.
struct BallDef {
  BodyId a{};                           // null = the world
  BodyId b{};                           // null = the world
  DVec3 anchor{};                       // m, world: the common point
  float friction = 0.0f;                // N m, dry: against all turning
  std::optional<float> break_force{};   // N: the joint breaks above it; none = never
  std::optional<float> break_torque{};  // N m: the joint breaks above it; none = never
  bool collide_connected = false;       // whether a and b still collide with each other
};

// One common point and axis: b turns about `axis` of a. A door, an elbow. PhysX and Box3D: revolute.
struct HingeDef {
  BodyId a{};                           // null = the world
  BodyId b{};                           // null = the world
  DVec3 anchor{};                       // m, world: the common point
  Vec3 axis{1, 0, 0};                   // world, any length; b turns positively about it by the right-hand rule
  std::optional<Limits> limits{};       // rad, of b's angle against a; none: it turns freely
  float limit_frequency = 0.0f;         // Hz: the limits give way like springs on what the joint moves; 0 = they hold
  float limit_damping_ratio = 1.0f;     // of these springs
  Motor motor{};                        // rad/s, rad, N m; none by default
  float stiffness = 0.0f;               // N m/rad: a spring to angle zero
  float damping = 0.0f;                 // N m s/rad
  float friction = 0.0f;                // N m, dry: against turning
  std::optional<float> break_force{};   // N: the joint breaks above it; none = never
  std::optional<float> break_torque{};  // N m: the joint breaks above it; none = never
  bool collide_connected = false;       // whether a and b still collide with each other
};

// b slides along `axis` of a and does not turn against it. A piston, a lift. PhysX and Box3D: prismatic.
struct SliderDef {
  BodyId a{};                           // null = the world
  BodyId b{};                           // null = the world
  DVec3 anchor{};                       // m, world: the common point
  Vec3 axis{1, 0, 0};                   // world, any length: positive travel of b
  std::optional<Limits> limits{};       // m, of b's travel; none: it slides freely
  float limit_frequency = 0.0f;         // Hz: the limits give way like springs on what the joint moves; 0 = they hold
  float limit_damping_ratio = 1.0f;     // of these springs
  Motor motor{};                        // m/s, m, N; none by default
  float stiffness = 0.0f;               // N/m: a spring to travel zero
  float damping = 0.0f;                 // N s/m
  float friction = 0.0f;                // N, dry: against sliding
  std::optional<float> break_force{};   // N: the joint breaks above it; none = never
  std::optional<float> break_torque{};  // N m: the joint breaks above it; none = never
  bool collide_connected = false;       // whether a and b still collide with each other
};

// b keeps its pose in a. Box3D: weld.
struct FixedDef {
  BodyId a{};                           // null = the world
  BodyId b{};                           // null = the world
  DVec3 anchor{};                       // m, world: where force and torque of the joint are measured
  std::optional<float> break_force{};   // N: the joint breaks above it; none = never
  std::optional<float> break_torque{};  // N m: the joint breaks above it; none = never
  bool collide_connected = false;       // whether a and b still collide with each other
};

// A rod, rope or spring between two points. With none of the lengths and none of the spring's fields it is a rod of the present
// length. min_length and max_length make a rope (a gap within which nothing acts); stiffness, damping or frequency make a Hooke
// spring of rest length `length`.
struct DistanceDef {
  BodyId a{};                           // null = the world
  BodyId b{};                           // null = the world
  DVec3 anchor{};                       // m, world: the point on a
  std::optional<DVec3> anchor_b{};      // m, world: the point on b; none = b's origin
  std::optional<float> length{};        // m, of the rod, or the spring at rest; none = as it is
  std::optional<float> min_length{};    // m
  std::optional<float> max_length{};    // m
  std::optional<float> stiffness{};     // N/m
  std::optional<float> damping{};       // N s/m
  // Hz, instead of stiffness and damping: those that let the two bodies alone, as heavy as they are when the joint is added, swing
  // along the line at this frequency.
  std::optional<float> frequency{};
  float damping_ratio = 0.0f;           // with frequency: 1 = critical damping
  std::optional<float> break_force{};   // N: the joint breaks above it; none = never
  std::optional<float> break_torque{};  // N m: the joint breaks above it; none = never
  bool collide_connected = false;       // whether a and b still collide with each other
};

// A ball whose swing stays within an ellipse and whose twist within limits: a shoulder. Jolt: SwingTwist.
struct ConeDef {
  BodyId a{};                           // null = the world
  BodyId b{};                           // null = the world
  DVec3 anchor{};                       // m, world: the common point
  Vec3 axis{1, 0, 0};                   // world, any length: the middle of the cone, along the limb; x of the joint's frame
  std::optional<Vec3> axis_b{};         // world: z of the joint's frame; none = any direction across `axis`
  std::optional<float> swing_y{};       // rad, 0 to pi: how far b's axis may turn about the frame's y and z; with one given the
  std::optional<float> swing_z{};       // other is the same; none = freely
  std::optional<Limits> limits{};       // rad, of the twist about `axis`; none: it twists freely
  float limit_frequency = 0.0f;         // Hz: swing and twist limits give way like springs on what the joint moves; 0 = they hold
  float limit_damping_ratio = 1.0f;     // of these springs
  Motor motor{};                        // rad/s, rad, N m, of the twist; none by default
  float stiffness = 0.0f;               // N m/rad: a spring to twist zero
  float damping = 0.0f;                 // N m s/rad
  float friction = 0.0f;                // N m, dry: against all turning
  PoseDrive drive{};                    // to an orientation: its turning part alone
  std::optional<float> break_force{};   // N: the joint breaks above it; none = never
  std::optional<float> break_torque{};  // N m: the joint breaks above it; none = never
  bool collide_connected = false;       // whether a and b still collide with each other
};

// One common point; b turns about `axis`, fixed in a, and about `axis_b`, fixed in b, which keep their angle. A cardan shaft.
struct UniversalDef {
  BodyId a{};                           // null = the world
  BodyId b{};                           // null = the world
  DVec3 anchor{};                       // m, world: the common point
  Vec3 axis{1, 0, 0};                   // world, any length: fixed in a
  std::optional<Vec3> axis_b{};         // world: fixed in b, 10 degrees or more from `axis`; none = any direction across it
  std::optional<Limits> limits{};       // rad, about `axis`; none: it turns freely
  float limit_frequency = 0.0f;         // Hz: these limits give way like springs on what the joint moves; 0 = they hold
  float limit_damping_ratio = 1.0f;     // of these springs
  Motor motor{};                        // rad/s, rad, N m, about `axis`; none by default
  float stiffness = 0.0f;               // N m/rad: a spring to angle zero about `axis`
  float damping = 0.0f;                 // N m s/rad
  float friction = 0.0f;                // N m, dry: about `axis`
  JointAxisDef angular_z{};             // all that acts about `axis_b`; locked means free here
  std::optional<float> break_force{};   // N: the joint breaks above it; none = never
  std::optional<float> break_torque{};  // N m: the joint breaks above it; none = never
  bool collide_connected = false;       // whether a and b still collide with each other
};

// Each of the six axes of the joint's frame as it is told (see JointAxis); what is not told is locked. PhysX: D6.
struct SixDofDef {
  BodyId a{};                           // null = the world
  BodyId b{};                           // null = the world
  DVec3 anchor{};                       // m, world: the origin of the frame
  Vec3 axis{1, 0, 0};                   // world, any length: x of the frame
  std::optional<Vec3> axis_b{};         // world: z of the frame as far as it is across; none = any direction across `axis`
  JointAxisDef linear_x{};              // m, N
  JointAxisDef linear_y{};
  JointAxisDef linear_z{};
  JointAxisDef angular_x{};             // rad, N m
  JointAxisDef angular_y{};
  JointAxisDef angular_z{};
  std::optional<float> break_force{};   // N: the joint breaks above it; none = never
  std::optional<float> break_torque{};  // N m: the joint breaks above it; none = never
  bool collide_connected = false;       // whether a and b still collide with each other
};

// a's turning about `axis` is -ratio times b's turning about `axis_b`, both against the world. Both wheels want bearings: hinges.
struct GearDef {
  BodyId a{};                           // null = the world
  BodyId b{};                           // null = the world
  DVec3 anchor{};                       // m, world: where force and torque of the joint are measured
  Vec3 axis{1, 0, 0};                   // world, any length: the shaft of a
  std::optional<Vec3> axis_b{};         // world: the shaft of b; none = as `axis`
  float ratio = 1.0f;                   // not 0: b's teeth over a's; negative where they turn the same way
  std::optional<float> break_force{};   // N: the joint breaks above it; none = never
  std::optional<float> break_torque{};  // N m: the joint breaks above it; none = never
  bool collide_connected = false;       // whether a and b still collide with each other
};

// b, the rack, travels along `axis_b` by ratio times a's turning about `axis`. Both want bearings: a hinge and a slider.
struct RackAndPinionDef {
  BodyId a{};                           // null = the world
  BodyId b{};                           // null = the world
  DVec3 anchor{};                       // m, world: where force and torque of the joint are measured
  Vec3 axis{1, 0, 0};                   // world, any length: the shaft of the pinion, a
  std::optional<Vec3> axis_b{};         // world: along the rack, b; across `axis`. It must be given
  float ratio = 1.0f;                   // m/rad, not 0: the pinion's radius
  std::optional<float> break_force{};   // N: the joint breaks above it; none = never
  std::optional<float> break_torque{};  // N m: the joint breaks above it; none = never
  bool collide_connected = false;       // whether a and b still collide with each other
};

// A rope from a over two points of the world to b: |a's part| + ratio |b's part| <= length. It pulls and never pushes.
struct PulleyDef {
  BodyId a{};                           // must be a body
  BodyId b{};                           // must be a body
  DVec3 anchor{};                       // m, world: the point on a
  std::optional<DVec3> anchor_b{};      // m, world: the point on b; none = b's origin
  DVec3 ground_a{};                     // m, world, fixed: the point that a's part of the rope runs over
  DVec3 ground_b{};                     // m, world, fixed: the point that b's part of the rope runs over
  float ratio = 1.0f;                   // above 0: how much b's part counts
  std::optional<float> length{};        // m, of the whole rope; none = as it is
  std::optional<float> break_force{};   // N: the joint breaks above it; none = never
  std::optional<float> break_torque{};  // N m: the joint breaks above it; none = never
  bool collide_connected = false;       // whether a and b still collide with each other
};

// b, the wheel, spins about `axis_b`, is sprung along `axis` of a, the chassis, and is steered about `axis`.
struct WheelDef {
  BodyId a{};                           // null = the world
  BodyId b{};                           // null = the world
  DVec3 anchor{};                       // m, world: the middle of the wheel
  Vec3 axis{1, 0, 0};                   // world, any length: of suspension and steering, from the ground up
  std::optional<Vec3> axis_b{};         // world: what the wheel spins about, 10 degrees or more from `axis`; none = any across it
  std::optional<Limits> limits{};       // m, of the suspension; none: it moves freely
  float limit_frequency = 0.0f;         // Hz: these limits give way like springs on what the joint moves; 0 = they hold
  float limit_damping_ratio = 1.0f;     // of these springs
  float stiffness = 0.0f;               // N/m, of the suspension: a spring to the pose when added
  float damping = 0.0f;                 // N s/m, of the suspension
  Motor motor{};                        // rad/s, rad, N m, of the spin; none by default
  float friction = 0.0f;                // N m, dry, of the spin: a brake
  JointAxisDef steering{};              // rad, N m, about `axis`; locked by default: it does not steer
  std::optional<float> break_force{};   // N: the joint breaks above it; none = never
  std::optional<float> break_torque{};  // N m: the joint breaks above it; none = never
  bool collide_connected = false;       // whether a and b still collide with each other
};

// A point of b stays on a curve that is fixed in a: a smooth curve (Catmull-Rom) through `points`.
struct PathDef {
  BodyId a{};                           // null = the world
  BodyId b{};                           // null = the world
  DVec3 anchor{};                       // m, world: the point of b; the curve must pass near it
  // m, from the anchor, world axes; 2 to kMaxPathPoints, a closed curve at least 3; no two neighbours alike.
  std::vector<Vec3> points{};
  bool closed = false;                  // whether the last point is joined to the first
  PathOrientation orientation = PathOrientation::free;
  std::optional<Limits> limits{};       // m along the curve; none: a closed curve has no end, an open one ends where it ends
  float limit_frequency = 0.0f;         // Hz: the ends give way like springs on what the joint moves; 0 = they hold
  float limit_damping_ratio = 1.0f;     // of these springs
  Motor motor{};                        // m/s, m, N, along the curve; none by default
  float stiffness = 0.0f;               // N/m: a spring to the place when added
  float damping = 0.0f;                 // N s/m
  float friction = 0.0f;                // N, dry: against motion along the curve
  std::optional<float> break_force{};   // N: the joint breaks above it; none = never
  std::optional<float> break_torque{};  // N m: the joint breaks above it; none = never
  bool collide_connected = false;       // whether a and b still collide with each other
};
constexpr int kMaxPathPoints = 4096;

// A point of b is dragged with a limited force, as by a mouse. World::set_drive moves it.
struct MouseDef {
  BodyId a{};                           // null = the world, as it usually is
  BodyId b{};                           // null = the world
  DVec3 anchor{};                       // m, world: the point of b
  PoseDrive drive{};                    // its position, linear_velocity, frequency, damping_ratio and max_force
  std::optional<float> break_force{};   // N: the joint breaks above it; none = never
  std::optional<float> break_torque{};  // N m: the joint breaks above it; none = never
  bool collide_connected = false;       // whether a and b still collide with each other
};

// b is driven to a pose in a with a limited force and torque. World::set_drive moves the pose.
struct MotorDef {
  BodyId a{};                           // null = the world
  BodyId b{};                           // null = the world
  DVec3 anchor{};                       // m, world: the origin of the joint's frames
  Vec3 axis{1, 0, 0};                   // world, any length: x of the frames
  std::optional<Vec3> axis_b{};         // world: z of the frames as far as it is across; none = any direction across `axis`
  PoseDrive drive{};                    // the pose, and how hard b is driven to it
  std::optional<float> break_force{};   // N: the joint breaks above it; none = never
  std::optional<float> break_torque{};  // N m: the joint breaks above it; none = never
  bool collide_connected = false;       // whether a and b still collide with each other
};

// A definition of any kind, in the order of JointKind.
using JointDef = std::variant<BallDef, HingeDef, SliderDef, FixedDef, DistanceDef, ConeDef, UniversalDef, SixDofDef, GearDef,
                              RackAndPinionDef, PulleyDef, WheelDef, PathDef, MouseDef, MotorDef>;

inline JointKind kind_of(const JointDef& def) { return JointKind(def.index()); }
// A definition of the kind with every field at its default, for readers of files and tools.
JointDef default_joint(JointKind kind);

}  // namespace gyre
