// Definitions: plain structs in which every field has a default. Write only the fields that differ (designated initialisers).
// SI units throughout: m, kg, s, rad, N, N m.
#pragma once

#include <gyre/geometry.h>
#include <gyre/ids.h>
#include <gyre/math.h>
#include <gyre/stepping.h>

#include <cstdint>
#include <optional>
#include <vector>

namespace gyre {

// ------------------------------------------------------------------------------------------------------------ world

// How the coefficients of two materials are combined into one, unless a MaterialPair gives it.
enum class CombineRule : std::uint8_t { geometric_mean, average, minimum, maximum, product };

// The host application's own threads. `run` executes task(context, i) for every i in [0, count), possibly at the same time, and
// returns when all are done.
struct HostTasks {
  void (*run)(void* user, int count, void (*task)(void* context, int index), void* context) = nullptr;
  int worker_count = 1;
  void* user = nullptr;
};

struct WorldDef {
  Vec3 gravity{0, -9.81f, 0};  // m/s^2
  int threads = 1;             // workers, this thread included; 0 = as many as the machine has; never changes a bit of the result
  int simd_width = 0;          // lanes of the solver's kernels: 1, 4, 8 or 16; 0 = the best of this machine; never changes a bit
  Stepping stepping{};         // expert settings: stepping.h
  bool sleeping = true;        // resting islands sleep until something touches them
  CombineRule friction_rule = CombineRule::geometric_mean;
  CombineRule restitution_rule = CombineRule::maximum;
  HostTasks host_tasks{};        // used instead of own threads when `run` is set
};

// ---------------------------------------------------------------------------------------------------------- materials

// The surface of a shape. Coulomb friction: a contact does not slide up to static_friction times the normal force; a sliding contact
// bears dynamic_friction times the normal force. Rolling and spinning friction are lengths: their torque is length times normal force.
struct Material {
  float static_friction = 0.6f;
  float dynamic_friction = 0.6f;
  float restitution = 0.0f;        // speed after over speed before an impact, 0 to 1
  float rolling_friction = 0.0f;   // m, resistance against rolling: the torque is in the contact plane
  // m, torsional friction: the torque about the contact normal that resists spinning. It adds to the torque of the contact patch.
  float spinning_friction = 0.0f;
  std::uint16_t id = 0;  // of the material in the table of pairs; 0 = not in the table
};

// Coefficients of two materials in contact, instead of the combine rules.
struct MaterialPair {
  std::uint16_t a = 0, b = 0;  // Material::id, both not 0; the order does not matter
  float static_friction = 0.6f;
  float dynamic_friction = 0.6f;
  float restitution = 0.0f;
};

// Special behaviour of a surface: conveyor belts, one-way platforms, materials of single triangles. It is a row of the world's table
// (World::set_surface_rule) and applies to shapes whose material has the id and to mesh triangles with the id (MeshDef::materials).
// Directions are in the frame of the body.
struct SurfaceRule {
  std::uint16_t id = 0;  // Material::id, above 0
  Material material{};   // of triangles with the id; a shape keeps its own material
  Vec3 velocity{};       // m/s: the surface moves like a conveyor belt while the body stays; only along the surface
  // Bodies that move along this direction pass through, others are stopped; any length. Zero: none pass.
  Vec3 one_way{};
};

// Which shapes collide: two shapes do if each one's collides_with contains the other's layer. Two equal groups other than 0 overrule
// that: such shapes always collide if the group is positive, and never if it is negative.
struct Filter {
  std::uint32_t layer = 1;
  std::uint32_t collides_with = 0xffffffffu;
  std::int32_t group = 0;

  constexpr bool operator==(const Filter&) const = default;
};

struct ShapeDef {
  AnyShape geometry = Sphere{};
  Transform local{};          // body_from_shape
  float density = 1000.0f;  // kg/m^3; 0 = adds no mass
  Material material{};
  Filter filter{};
  bool sensor = false;      // reports overlaps and has no contacts
  std::uint64_t user_data = 0;
};

// ------------------------------------------------------------------------------------------------------------ bodies

enum class BodyType : std::uint8_t {
  fixed,      // never moves
  kinematic,  // moves with its given velocity; nothing pushes it
  dynamic,    // moved by forces
};

struct LockedAxes {
  bool linear[3] = {false, false, false};   // world axes
  bool angular[3] = {false, false, false};  // world axes

  constexpr bool operator==(const LockedAxes&) const = default;
};

struct BodyDef {
  BodyType type = BodyType::dynamic;
  Pose pose{};                         // world_from_body, of the body's origin
  Vec3 linear_velocity{};              // m/s, of the centre of mass, world frame
  Vec3 angular_velocity{};             // rad/s, world frame
  float linear_damping = 0.0f;       // 1/s: dv/dt = -damping * v, integrated exactly
  float angular_damping = 0.0f;      // 1/s
  float gravity_scale = 1.0f;
  bool continuous = false;           // continuous collision against moving bodies too (against fixed bodies it is always on)
  bool can_sleep = true;
  LockedAxes locked{};
  std::optional<float> mass{};             // kg; scales the shapes' mass and inertia unless inertia is given too
  std::optional<Vec3> center_of_mass{};    // m, body frame
  std::optional<Sym3> inertia{};           // kg m^2, about the centre of mass, body axes
  std::uint64_t user_data = 0;
};

// ------------------------------------------------------------------------------------------------------------- joints

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
  rack_and_pinion,  // b's way along `axis_b` is ratio times a's turning about `axis`
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

// A joint between two bodies; a null id is the world. Anchors and axes are given in the world frame as the bodies stand
// when the joint is added; they are stored in the bodies' frames. docs/joints.md says what each kind leaves free.
struct JointDef {
  JointKind kind = JointKind::ball;
  BodyId a{};
  BodyId b{};
  DVec3 anchor{};                        // the common point; distance, pulley: the point on a; path: of b, on the curve; mouse: of b
  Vec3 axis{1, 0, 0};                  // hinge, slider; cone: about which b twists; six_dof, motor: x of the frame; wheel: suspension and
                                       // steering, from the ground up; gear, rack_and_pinion: about which a turns
  std::optional<DVec3> anchor_b{};       // distance, pulley: the point on b; none = b's origin
  std::optional<Limits> limits{};        // hinge, slider; cone: twist; universal: about axis; wheel: suspension; path: along it.
                                         // Zero is the pose when added
  Motor motor{};                         // as limits, but wheel: spin
  // Distance: with none of these a rod of the present length. min and max make a rope (a gap within which nothing acts);
  // stiffness, damping or frequency make a Hooke spring of rest length `length`. Hinge, slider, wheel (suspension): a spring to the
  // pose when added, N/m or N m/rad.
  std::optional<float> length{};         // m; pulley: of the rope, of which ratio times b's part counts; none = as it is
  std::optional<float> min_length{};     // m
  std::optional<float> max_length{};     // m
  std::optional<float> stiffness{};      // N/m
  std::optional<float> damping{};        // N s/m
  // Distance, instead of stiffness and damping: those that let the two bodies alone, as heavy as they are when the joint is added,
  // swing along the line at this many Hz, and this share of critical damping.
  std::optional<float> frequency{};
  float damping_ratio = 0.0f;
  std::optional<float> break_force{};    // N: the joint breaks above it
  std::optional<float> break_torque{};   // N m
  bool collide_connected = false;      // whether the two bodies still collide with each other
  // universal, wheel (spin), gear, rack_and_pinion (way): of b; six_dof, motor, cone: z of the frame. None: gear as axis, rack an
  // error, others any across axis.
  std::optional<Vec3> axis_b{};
  float friction = 0.0f;               // N or N m, dry: as motor; ball and cone: against all turning
  float limit_frequency = 0.0f;        // Hz: `limits` give way like springs; 0 = they hold
  float limit_damping_ratio = 1.0f;
  std::optional<float> swing_y{};      // cone: how far b's axis may turn about the frame's y and z, rad, 0 to pi; with one given the
  std::optional<float> swing_z{};      // other is the same; none = freely
  float ratio = 1.0f;                  // gear: as above; rack_and_pinion: m/rad, the pinion's radius; pulley: of b's part of the rope
  DVec3 ground_a{};                    // pulley: the points that the rope runs over, fixed in the world
  DVec3 ground_b{};
  JointAxisDef linear_x{}, linear_y{}, linear_z{};     // six_dof
  JointAxisDef angular_x{}, angular_y{}, angular_z{};  // six_dof; wheel: angular_x steers; universal: angular_z about axis_b
  PoseDrive drive{};                   // motor, mouse; cone: its turning part
  // Path: points that the curve runs through (Catmull-Rom), m from the anchor, world axes; 2 to kMaxPathPoints, a closed
  // one at least 3. The curve must pass near the anchor.
  std::vector<Vec3> path{};
  bool path_closed = false;
  PathOrientation path_orientation = PathOrientation::free;
};
constexpr int kMaxPathPoints = 4096;

}  // namespace gyre
