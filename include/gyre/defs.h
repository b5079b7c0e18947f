// Definitions: plain structs in which every field has a default. Write only the fields that differ (designated initialisers).
// SI units throughout: m, kg, s, rad, N, N m.
#pragma once

#include <gyre/geometry.h>
#include <gyre/ids.h>
#include <gyre/math.h>
#include <gyre/stepping.h>

#include <cstdint>
#include <optional>

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
  // The speed below which bodies are still, as a share of sqrt(gravity * bounding radius) of each. Bodies that no friction holds, or that
  // springs or motors move, have a twentieth of it. 0: only what does not move at all sleeps.
  float sleep_share = 0.015f;
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
  float density = 1000.0f;  // kg/m^3; 0 = adds no mass; a body of such shapes alone has 1 kg, or its `mass`, spread evenly
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
  float sleep_speed = 0.0f;          // m/s: the body is still below it, whatever holds or moves it; 0 = by WorldDef::sleep_share
  LockedAxes locked{};
  std::optional<float> mass{};             // kg; scales the shapes' mass and inertia unless inertia is given too
  std::optional<Vec3> center_of_mass{};    // m, body frame
  std::optional<Sym3> inertia{};           // kg m^2, about the centre of mass, body axes
  std::uint64_t user_data = 0;
  bool enabled = true;               // false: out of the simulation until World::set_enabled()
};

}  // namespace gyre
