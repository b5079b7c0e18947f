// Expert settings: how a step is computed. The defaults suit games, robots and tools; most users never change them.
// docs/numerics.md compares the choices with figures, docs/broad_phases.md the broad phases.
#pragma once

#include <cstdint>

namespace gyre {

// The integration scheme of velocities and positions. Its order is that of the error in smooth motion. A body under contacts or joints
// moves by the velocity that they leave it, as with semi-implicit Euler.
enum class IntegratorKind : std::uint8_t {
  semi_implicit_euler,  // order 1, symplectic: v += h a, then x += h v
  explicit_euler,       // order 1, gains energy: x += h v, then v += h a
  rk4,                  // order 4: W. Kutta, 1901; forces at four stages
  verlet,               // order 2, without velocities: C. Stoermer; L. Verlet, 1967; the state is the last two poses
};
constexpr int kIntegratorKindCount = 4;
const char* to_string(IntegratorKind kind);

// How springs between two points act (distance joints with a stiffness and no other limit).
enum class SpringKind : std::uint8_t {
  implicit,        // rows of the solver, stable at any stiffness
  explicit_force,  // forces at each stage of the integrator; World::spring_stability() says which step it can follow
};
const char* to_string(SpringKind kind);

// How a step is divided in time.
enum class TimeStepping : std::uint8_t {
  fixed,             // into equal sub-steps
  adaptive,          // at each time of impact, where the impact is resolved; between impacts as error_controlled
  error_controlled,  // into as many sub-steps as keep the estimated error of a step below Stepping::tolerance
};
constexpr int kTimeSteppingCount = 3;
const char* to_string(TimeStepping stepping);

// The structure that finds the pairs of shapes whose boxes overlap. All of them find the same pairs.
enum class BroadPhaseKind : std::uint8_t {
  bvh,              // wide trees of bounding volumes, one of fixed bodies and one of moving bodies
  brute_force,      // every pair, one by one
  grid,             // uniform hashed grid
  octree,           // loose octree
  quadtree,         // loose quadtree, its cells columns along y
  kd_tree,          // splits at medians, along axes
  bsp_tree,         // splits by planes of 13 directions
  sweep_and_prune,  // sorted along the axis of largest spread
};
constexpr int kBroadPhaseKindCount = 8;
const char* to_string(BroadPhaseKind kind);

// The solver of contacts and joints in a sub-step.
enum class SolverKind : std::uint8_t {
  soft_step,            // soft impulses in two half sub-steps; resting stacks and articulations are solved exactly
  sequential_impulses,  // rows one after the other with accumulated impulses: joints, then contacts, each in the order of creation
  lcp,                  // all rows of an island at once, as a complementarity problem
};
constexpr int kSolverKindCount = 3;
const char* to_string(SolverKind kind);

// The method that solves the complementarity problem of an island.
enum class LcpMethod : std::uint8_t {
  automatic,  // Newton's method; where it does not converge, pivoting for small islands and NNCG for others
  dantzig,    // principal pivoting; needs a friction pyramid
  lemke,      // complementary pivoting; needs a friction pyramid
  newton,     // semi-smooth Newton on the pyramid or the cone, for islands of any size
  nncg,       // nonsmooth nonlinear conjugate gradients, for islands of any size
};
constexpr int kLcpMethodCount = 5;
const char* to_string(LcpMethod method);

// Options of sequential_impulses and lcp. soft_step ignores them.
struct SolverOptions {
  LcpMethod lcp_method = LcpMethod::automatic;
  int friction_sides = 0;  // of the friction pyramid, an even number of 4 to 32; 0: Coulomb's cone
  int iterations = 0;      // sweeps a sub-step, at most 10,000; 0: 10 for sequential_impulses, at most 200 for NNCG
  int direct_rows = 200;   // lcp: 0 to 600; islands with more rows (a contact point has three) use Newton's method, not pivoting
};

struct Stepping {
  int substeps = 4;  // 1 to 64 equal sub-steps a step; bodies move twice in each
  IntegratorKind integrator = IntegratorKind::semi_implicit_euler;
  SolverKind solver = SolverKind::soft_step;
  BroadPhaseKind broad_phase = BroadPhaseKind::bvh;
  SpringKind springs = SpringKind::implicit;
  TimeStepping time = TimeStepping::fixed;
  float tolerance = 1.0e-5f;  // m, at least 1e-9: of the estimated error of a body's points in a step; if time is not fixed
  int max_impacts = 128;      // 1 to 4096: adaptive: times of impact in a step; what is left of the step is then a fixed one
  SolverOptions solver_options{};
};

}  // namespace gyre
