// Definitions: plain structs in which every field has a default; write only what differs (designated initialisers).
// SI units throughout: m, kg, s, rad, N, N m.
#pragma once

#include <gyre/geometry.h>
#include <gyre/ids.h>
#include <gyre/math.h>

#include <cstdint>
#include <optional>

namespace gyre {

// ------------------------------------------------------------------------------------------------------------ world

// How velocities and places follow from forces. Orders are those of the error in smooth motion. A body that contacts or joints act
// on moves by the velocity that they leave it, as by semi-implicit Euler; docs/numerics.md has the tables.
enum class IntegratorKind : std::uint8_t {
  semi_implicit_euler,  // order 1, symplectic: v += h a, then x += h v
  explicit_euler,       // order 1, gains energy: x += h v, then v += h a
  rk4,                  // order 4: W. Kutta, 1901; forces at four stages
  verlet,  // order 2, without velocities: C. Stoermer; L. Verlet, 1967; the state is the last two poses
};
constexpr int kIntegratorKindCount = 4;
const char* to_string(IntegratorKind kind);
// How springs act that are joints of two points (JointKind::distance with stiffness and nothing else).
enum class SpringKind : std::uint8_t {
  implicit,  // rows of the solver, stable at any stiffness
  explicit_force,  // forces that the integrator sees at each of its stages; World::spring_stability() says what it can follow
};
const char* to_string(SpringKind kind);
// How a step is cut.
enum class TimeStepping : std::uint8_t {
  fixed,             // equal sub-steps
  adaptive,          // to each impact, found and resolved at its time; between them as error_controlled
  error_controlled,  // as many sub-steps as keep the estimated error of a step below `tolerance`
};
constexpr int kTimeSteppingCount = 3;
const char* to_string(TimeStepping stepping);
// Which structure finds the pairs whose boxes overlap. All find the same; docs/broad_phases.md says when each is fast.
enum class BroadPhaseKind : std::uint8_t {
  bvh,              // wide trees of bounding volumes, one of what is fixed and one of what moves
  brute_force,      // every pair, one by one
  grid,             // uniform hashed grid
  octree,           // loose octree
  quadtree,         // loose quadtree, its cells columns along y
  kd_tree,          // parts at medians, along axes
  bsp_tree,         // parts by planes of 13 directions
  sweep_and_prune,  // sorted along the axis of largest spread
};
constexpr int kBroadPhaseKindCount = 8;
const char* to_string(BroadPhaseKind kind);
// How contacts and joints are solved in a sub-step; docs/numerics.md compares them.
enum class SolverKind : std::uint8_t {
  soft_step,            // soft impulses in two short parts; stacks at rest and linkages exactly
  sequential_impulses,  // rows one after the other with accumulated impulses: joints, then contacts, each in the order of creation
  lcp,                  // all rows of an island at once, as a complementarity problem
};
constexpr int kSolverKindCount = 3;
const char* to_string(SolverKind kind);
// How the complementarity problem of an island is solved.
enum class LcpMethod : std::uint8_t {
  automatic,  // Newton's method; where it does not end, pivoting for small islands and NNCG for others
  dantzig,    // principal pivoting; needs a friction pyramid
  lemke,      // complementary pivoting; needs a friction pyramid
  newton,     // semi-smooth Newton on the pyramid or the cone, for islands of any size
  nncg,       // nonsmooth nonlinear conjugate gradients, for islands of any size
};
constexpr int kLcpMethodCount = 5;
const char* to_string(LcpMethod method);
// How sequential_impulses and lcp work; soft_step does not look at it.
struct SolverOptions {
  LcpMethod lcp_method = LcpMethod::automatic;
  int friction_sides = 0;  // of the friction pyramid, an even number of 4 to 32; 0: Coulomb's cone
  int iterations = 0;      // sweeps a sub-step, at most 10,000; 0: 10 for sequential_impulses, at most 200 for NNCG
  int direct_rows = 200;   // lcp: pivoting leaves islands with more rows (a contact point has three) to Newton's method; 0 to 600
};

// How two materials make one number: of the two values, or table entries where MaterialPair says so.
enum class CombineRule : std::uint8_t { geometric_mean, average, minimum, maximum, product };

struct Stepping {
  int substeps = 4;  // 1 to 64 equal sub-steps a step; bodies move twice in each
  IntegratorKind integrator = IntegratorKind::semi_implicit_euler;
  SolverKind solver = SolverKind::soft_step;
  BroadPhaseKind broad_phase = BroadPhaseKind::bvh;
  SpringKind springs = SpringKind::implicit;
  TimeStepping time = TimeStepping::fixed;
  float tolerance =
      1.0e-5f;  // m, not below 1e-9: of the estimated error of a body's points in a step; if not fixed
  int max_impacts =
      128;  // 1 to 4096: adaptive: times of impact in a step; the rest of the step is then a fixed one
  SolverOptions solver_options{};
};

// The door for the host application's own threads. `run` executes task(context, i) for every i in [0, count), possibly
// at the same time, and returns when all are done.
struct HostTasks {
  void (*run)(void* user, int count, void (*task)(void* context, int index), void* context) = nullptr;
  int worker_count = 1;
  void* user = nullptr;
};

struct WorldDef {
  Vec3 gravity{0, -9.81f, 0};  // m/s^2
  int threads = 1;             // workers, this thread included; 0 = as many as the machine has; never changes a bit of the result
  int simd_width = 0;          // lanes of the solver's kernels: 1, 4, 8 or 16; 0 = the best of this machine; never changes a bit
  Stepping stepping{};
  bool sleeping = true;        // resting islands sleep until something touches them
  CombineRule friction_rule = CombineRule::geometric_mean;
  CombineRule restitution_rule = CombineRule::maximum;
  HostTasks host_tasks{};        // used instead of own threads when `run` is set
};

// ---------------------------------------------------------------------------------------------------------- materials

// Surface of a shape. Coulomb friction: no sliding up to static_friction times the normal force, dynamic_friction times
// the normal force while sliding. Rolling and spinning friction are lengths: torque = length times normal force.
struct Material {
  float static_friction = 0.6f;
  float dynamic_friction = 0.6f;
  float restitution = 0.0f;        // speed after over speed before an impact, 0 to 1
  float rolling_friction = 0.0f;   // m
  float spinning_friction = 0.0f;  // m, added to what the contact's patch gives by itself
  std::uint16_t id = 0;            // names the material in the pair table; 0 = not in it
};

// What holds for two materials together, instead of the combine rules.
struct MaterialPair {
  std::uint16_t a = 0, b = 0;  // Material::id, both not 0; the order does not matter
  float static_friction = 0.6f;
  float dynamic_friction = 0.6f;
  float restitution = 0.0f;
};

// What else a surface does: a row of the world's table (World::set_surface_rule), for shapes whose material has the id and for
// triangles of meshes that carry it (MeshDef::materials). Directions are in the frame of the body.
struct SurfaceRule {
  std::uint16_t id = 0;  // Material::id, above 0
  Material material{};   // of triangles that carry the id; a shape's own material stays what it is
  Vec3 velocity{};       // m/s: the surface runs on like a conveyor belt while the body stays; only along the surface
  // What moves along this direction passes through, what comes against it is held; any length. Zero: nothing passes.
  Vec3 one_way{};
};

// Who may touch whom: two shapes may when each one's layer is among the other's collides_with. Two equal non-zero groups
// overrule that: always if positive, never if negative.
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
  bool sensor = false;      // reports what overlaps it and touches nothing
  std::uint64_t user_data = 0;
};

// ------------------------------------------------------------------------------------------------------------ bodies

enum class BodyType : std::uint8_t {
  fixed,      // never moves
  kinematic,  // moves with the velocity it is given; nothing pushes it
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
  bool continuous = false;           // also swept against moving bodies (it always is against fixed ones)
  bool can_sleep = true;
  LockedAxes locked{};
  std::optional<float> mass{};             // kg; scales the shapes' mass and inertia unless inertia is given too
  std::optional<Vec3> center_of_mass{};    // m, body frame
  std::optional<Sym3> inertia{};           // kg m^2, about the centre of mass, body axes
  std::uint64_t user_data = 0;
};

}  // namespace gyre
