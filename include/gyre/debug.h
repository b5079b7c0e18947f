// Debugging: tables of bodies, contacts, boxes and joints, lines and points to draw, times of the stages, the reason why a body is awake,
// and a check of all internal structures. Free functions on a World. None of them changes a bit of the simulation.
//
// Arrays are flat, so that a renderer or a JavaScript typed array can take each as it is: "3 a body" means that body i has
// elements 3 * i to 3 * i + 2. Positions are floats relative to an origin that the caller chooses (usually the camera), so that they are
// precise far from the world's origin. Directions are in world axes. SI units.
//
// Every function that fills a struct clears it first and keeps its memory, so a struct that is filled again needs no new memory for the
// same size. Call them between steps. Contacts and forces are those of the last step.
#pragma once

#include <gyre/geometry.h>
#include <gyre/ids.h>
#include <gyre/math.h>
#include <gyre/result.h>
#include <gyre/world.h>

#include <cstddef>
#include <cstdint>
#include <vector>

namespace gyre {

// ------------------------------------------------------------------------------------------------------------- bodies

// How close a body is to sleep.
enum class RestState : std::uint8_t {
  fixed,      // never moves
  kinematic,  // moved by the program, never sleeps
  moving,     // awake, its rest timer is at zero
  resting,    // awake, hardly moving: its rest timer runs
  asleep,
  frozen,  // its state stopped being finite; it stays at its last pose
  disabled,  // World::set_enabled(false)
};
constexpr int kRestStateCount = 7;
const char* to_string(RestState state);

constexpr std::uint32_t kNoIsland = 0xffffffffu;

// Every body of the world, in the order of World::bodies().
struct BodyTable {
  std::vector<BodyId> ids;
  std::vector<float> centers;      // 3 a body: centre of mass, m
  std::vector<float> axes;         // 4 a body: x y z w, the world orientation of the principal axes of inertia
  std::vector<float> semi_axes;    // 3 a body: of the solid ellipsoid with its mass and inertia, m; 0 if it has none
  std::vector<float> linear_velocities;   // 3 a body: of the centre of mass, m/s
  std::vector<float> angular_velocities;  // 3 a body: rad/s
  std::vector<float> speeds;       // 1 a body: of the centre of mass plus that of the farthest point about it, m/s
  std::vector<float> rest_speeds;  // 1 a body: a body at or below this speed is still, m/s
  std::vector<float> still_times;  // 1 a body: how long it has been still, s
  std::vector<RestState> states;   // 1 a body
  // Islands: dynamic bodies that contacts and joints connect. They fall asleep and wake together.
  std::vector<std::uint32_t> islands;       // 1 a body: lowest index in its island; kNoIsland if not dynamic
  std::vector<std::uint32_t> island_sizes;  // 1 a body: how many bodies its island has; 0 if not dynamic
  std::uint32_t island_count = 0;

  std::size_t size() const { return ids.size(); }
};
void read_bodies(const World& world, DVec3 origin, BodyTable& out);

// ----------------------------------------------------------------------------------------------------------- contacts

enum class ContactState : std::uint8_t {
  idle,      // the surfaces are close, but the contact bore no load in the last step
  pressing,  // bears load, friction holds
  sliding,   // bears load, friction is at its limit
  sensor,    // reports and bears no load
};
constexpr int kContactStateCount = 4;
const char* to_string(ContactState state);

constexpr std::uint8_t kNoColor = 255;

// Every contact point, in the order of World::contacts().
struct ContactTable {
  std::vector<std::uint32_t> bodies;   // 2 a point: BodyId::index of a and b
  std::vector<std::uint32_t> shapes;   // 2 a point: ShapeId::index of a and b
  std::vector<float> positions;        // 3 a point: midway between the surfaces, m
  std::vector<float> normals;          // 3 a point: unit, from a to b
  std::vector<float> tangents;         // 6 a point: two unit vectors, a basis together with the normal
  std::vector<float> separations;      // 1 a point: m, negative: overlap
  std::vector<float> forces;           // 1 a point: along the normal, mean over the last step, N
  std::vector<float> friction_forces;  // 3 a point: on b, N, of the manifold; at its first point only
  std::vector<float> scales;           // 1 a point: size of the smaller shape, m, as a scale for drawing
  std::vector<ContactState> states;    // 1 a point
  std::vector<std::uint8_t> colors;    // 1 a point: colour of the constraint graph; kNoColor if it has none

  std::size_t size() const { return separations.size(); }
};
void read_contacts(const World& world, DVec3 origin, ContactTable& out);

// -------------------------------------------------------------------------------------------------------------- boxes

enum class BoxKind : std::uint8_t {
  tight,        // the smallest box of a shape
  fat,          // the enlarged box of a shape in the broad phase
  fixed_tree,   // a node of the broad phase's tree of fixed bodies
  moving_tree,  // a node of its tree of moving bodies
};
constexpr int kBoxKindCount = 4;
constexpr std::uint32_t box_bit(BoxKind kind) { return 1u << int(kind); }
constexpr std::uint32_t kAllBoxes = (1u << kBoxKindCount) - 1;

constexpr std::uint32_t kNoShape = 0xffffffffu;

// Boxes of the given kinds (box_bit), ordered by kind, then by shape or from the root down. Planes have no boxes. Only the broad phase
// `bvh` has nodes.
struct BoxTable {
  std::vector<float> corners;         // 6 a box: low corner, high corner, m
  std::vector<BoxKind> kinds;         // 1 a box
  std::vector<std::uint8_t> depths;   // 1 a box: of a node below its root; 0 for boxes of shapes
  std::vector<std::uint32_t> shapes;  // 1 a box: ShapeId::index; kNoShape for a node

  std::size_t size() const { return kinds.size(); }
};
void read_boxes(const World& world, std::uint32_t kinds, DVec3 origin, BoxTable& out);

// ------------------------------------------------------------------------------------------------------------- joints

// Every joint, in the order of its index.
struct JointTable {
  std::vector<JointId> ids;
  std::vector<JointKind> kinds;
  std::vector<BodyId> bodies;  // 2 a joint: a and b; null is the world
  std::vector<float> anchors;  // 6 a joint: on a and on b, m; apart by the error (distance: by the length)
  std::vector<float> frames;   // 8 a joint: quaternions of the joint's frame on a and on b (x along the axis)
  std::vector<std::uint8_t> has_limits;  // 1 a joint; distance: 1 for a rope, 0 for a rod or spring
  std::vector<float> limits;     // 2 a joint: low and high, rad (hinge) or m; 0 without limits, 1e30: no end
  std::vector<float> positions;  // 1 a joint: angle (rad), slide or length (m)
  // 2 a joint, of its main axis: target velocity (or the distance left to the target position, rad or m) and maximum force; 0: no motor.
  std::vector<float> motors;
  std::vector<float> forces;     // 3 a joint: on b, mean over the last step, N
  std::vector<float> torques;    // 3 a joint: on b, N m

  std::size_t size() const { return ids.size(); }
};
void read_joints(const World& world, DVec3 origin, JointTable& out);

// --------------------------------------------------------------------------------------------------------------- draw

// Appends the edges of a shape, in its own frame, 6 floats a line: all edges of boxes, hulls, meshes and height fields, outlines
// of curved shapes in `segments` pieces a circle, a grid of 10 m for a plane.
void add_wireframe(const AnyShape& shape, std::vector<float>& lines, int segments = 32);

// Layers of a drawing; each is a range of its own in the arrays.
enum class DrawLayer : std::uint8_t {
  geometry,  // wireframes of shapes
  tight_bounds,
  fat_bounds,
  broad_phase,  // nodes of its trees, paler with depth
  contact_points,
  contact_normals,  // from a to b
  contact_forces,   // along the normal and friction, on b
  friction_basis,   // the two tangents
  mass_centers,     // a point and the principal axes
  inertia,          // the equivalent ellipsoid
  velocities,       // of the centre of mass, and the angular velocity as a vector
  joints,           // anchors, axes, limits, and a line from each body's centre to its anchor
  islands,          // lines between the centres of bodies that touch or are joined, one colour for each island
  soft_edges,       // of ropes, cloths and solids; a point for each vertex that is pinned or attached
  soft_contacts,    // a point for each vertex of them that touches a shape, and the normal there
};
constexpr int kDrawLayerCount = 15;
const char* to_string(DrawLayer layer);
constexpr std::uint32_t draw_bit(DrawLayer layer) { return 1u << int(layer); }
constexpr std::uint32_t kAllDrawLayers = (1u << kDrawLayerCount) - 1;

// The meaning of the colours of geometry, bounds and mass centres.
enum class ColorBy : std::uint8_t { type, rest_state, island };

struct DrawOptions {
  std::uint32_t layers = kAllDrawLayers;  // draw_bit of each
  DVec3 origin{};                         // positions are relative to it
  ColorBy color_by = ColorBy::type;
  bool solver_colors = false;      // contacts have the colours of the constraint graph instead of those of their state
  float meters_per_newton = 0.0f;  // length of forces; 0: the weight of the lighter body is as long as its bounding radius
  // Length of velocities: the distance covered in this time; angular velocities: that of a point at the bounding radius.
  float velocity_seconds = 0.1f;
  int segments = 32;                // of a circle
  std::size_t max_lines = 4000000;  // further lines are left out and `cut` is set
};

// Lines and points for a renderer: positions and colours per vertex, in separate arrays.
struct DebugDraw {
  struct Range {
    std::uint32_t first_line = 0, lines = 0;
    std::uint32_t first_point = 0, points = 0;
  };
  std::vector<float> line_positions;       // 6 a line: from, to, m
  std::vector<std::uint8_t> line_colors;   // 8 a line: red, green, blue, alpha of both ends
  std::vector<float> point_positions;      // 3 a point, m
  std::vector<std::uint8_t> point_colors;  // 4 a point
  Range layers[kDrawLayerCount];           // by DrawLayer
  bool cut = false;                        // max_lines was reached

  std::size_t line_count() const { return line_positions.size() / 6; }
  std::size_t point_count() const { return point_positions.size() / 3; }
};
void draw_debug(const World& world, const DrawOptions& options, DebugDraw& out);

// -------------------------------------------------------------------------------------------------------------- times

// Timing of the stages. It is off in a new world and then costs nothing. Times are no part of the state: hashes, snapshots and recordings
// are the same with and without timing.
void set_timing(World& world, bool enabled);
bool timing(const World& world);

struct StageSeconds {
  const char* name = "";  // of the stage, as in docs/step.md
  double seconds = 0.0;
};
struct StepCount {
  const char* name = "";
  std::uint64_t value = 0;
};
// Times of the last timed step. The stages come in their order; their sum is at most the time of the whole step.
struct StepTimes {
  std::uint64_t steps = 0;  // number of timed steps; 0: none, and all else is zero
  double seconds = 0.0;     // the whole step
  std::vector<StageSeconds> stages;
  std::vector<StepCount> counts;  // amounts of work
};
void read_times(const World& world, StepTimes& out);

// ------------------------------------------------------------------------------------------------------------ explain

// The reason why a body is awake or asleep.
enum class AwakeReason : std::uint8_t {
  none,            // the id is stale
  fixed,           // never moves
  kinematic,       // moved by the program, never sleeps
  frozen,          // its state stopped being finite
  asleep,          // it sleeps with its island
  sleeping_off,    // World::set_sleeping(false)
  may_not_sleep,   // BodyDef::can_sleep is false
  unsupported,     // nothing touches it and it has no joint: it flies or falls
  moving,          // faster than its rest speed
  settling,        // still, but not for long enough
  neighbor,        // it is still, but `cause` in its island is not
  moving_support,  // its island lies on `cause`, a moving kinematic body
  disabled,        // World::set_enabled(false)
};
constexpr int kAwakeReasonCount = 13;
const char* to_string(AwakeReason reason);

struct TouchingBody {
  BodyId body{};
  int points = 0;
  float force = 0.0f;  // N, normal force on the explained body, summed over the points, mean over the last step
  float depth = 0.0f;  // m, deepest overlap; 0 if the surfaces do not overlap
  bool sliding = false;
};
struct PullingJoint {
  JointId joint{};
  JointKind kind = JointKind::ball;
  BodyId other{};       // null is the world
  float force = 0.0f;   // N, mean over the last step
  float torque = 0.0f;  // N m
};

struct Explanation {
  AwakeReason reason = AwakeReason::none;
  BodyId cause{};                                // neighbor, moving_support: the body that keeps it awake
  AwakeReason cause_reason = AwakeReason::none;  // neighbor: the reason why `cause` is awake
  float speed = 0.0f;                            // m/s, of its farthest point
  float rest_speed = 0.0f;                       // m/s, a slower body is still
  float still_seconds = 0.0f;                    // how long it has been still
  float seconds_to_sleep = 0.0f;                 // how long it must be still
  int island_bodies = 0;                         // the body included; 0 if it is not dynamic
  BodyId island{};                     // the body of lowest index in the island: the same for all bodies of one island
  std::vector<TouchingBody> touching;  // by index; bodies that bear on it or are about to
  std::vector<PullingJoint> joints;    // by index
  char words[1024] = {};               // the explanation in English sentences; cut if it is longer
};

// Names of bodies in an explanation. Without `of` a body's index is its name.
struct BodyNames {
  const char* (*of)(void* user, BodyId body) = nullptr;
  void* user = nullptr;
};
Explanation explain(const World& world, BodyId body, const BodyNames& names = {});

// ----------------------------------------------------------------------------------------------------------- validate

// Checks all structures of a world between two steps: columns, lists and indices agree, trees contain every box in its place, contacts
// are those of overlapping boxes, colours of the constraint graph share no body, sleeping islands are connected. The error names the
// first broken rule. It is slow and meant for tests and for finding bugs.
Error validate(const World& world);

}  // namespace gyre
