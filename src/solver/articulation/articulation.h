// Articulations: bodies connected by joints whose equations are solved together, directly.
//
// The equations of a joint are a common point, a common axis, or the length of a rod. Those of an
// articulation form (J M^-1 J^T + compliance) p = -(J v + errors), a sparse matrix with one block a joint,
// factored in an order found once a step (math/block_ldlt.h); for a tree this is elimination from the leaves
// to the root. Springs, motors and limits are solved after the equations, along their responses
// (solver/articulation/articulation_drives.h, articulation_limits.h). Pose drives are iterated before. Rows
// are those of solver/joint/joint.h, softness excepted. docs/derive/joints.md has the equations,
// docs/decisions/articulations.md the figures.
//
// Sources: D. Baraff, "Linear-Time Dynamics using Lagrange Multipliers", SIGGRAPH 1996; R. Featherstone,
// "Rigid Body Dynamics Algorithms", 2008, chapter 8.
#pragma once

#include "math/block_ldlt.h"
#include "solver/joint/joint.h"

namespace gyre {

// The rows of a joint side by side, so that products of one row with all others are one run over lanes. Lanes
// beyond the rows are zero.
constexpr int kRowLanes = 8;
struct RowVectors {
  float x[kRowLanes] = {}, y[kRowLanes] = {}, z[kRowLanes] = {};
  Vec3 at(int row) const { return {x[row], y[row], z[row]}; }
  void set(int row, Vec3 v) { x[row] = v.x, y[row] = v.y, z[row] = v.z; }
};

// The speed of a row is direction . (v_b - v_a) + angular_b . w_b - angular_a . w_a.
struct ArticulationRows {
  RowVectors direction;                // of a force; zero for an angular row
  RowVectors angular_a, angular_b;     // r x direction, or the axis of an angular row
  RowVectors spin_a, spin_b;           // inverse inertia times the angular part
  float compliance[kRowLanes] = {};    // added to K: the speed by which the row yields to an impulse of one
  float target_speed[kRowLanes] = {};  // bias
};

// A joint of an articulation during its solve.
struct ArticulationNode {
  std::uint32_t record = 0;  // slot of the joint
  std::uint32_t work = 0;    // index of its JointConstraint
  std::int32_t body_a = kNoBody, body_b = kNoBody;
  std::int32_t side_a = -1, side_b = -1;  // indices in the bodies of the articulation; -1: not movable
  int count = 0;                          // rows
  ArticulationRows rows;
};
static_assert(kMaxBlockRows <= kRowLanes);

// A movable body of an articulation.
struct ArticulationBody {
  std::int32_t body = kNoBody;
  bool is_pressed = false;  // contacts act on it
  Sym3 geometric_stiffness;  // N m / rad, from tension in the joints
  Sym3 inverse;              // of the inertia with geometric stiffness
  Sym3 inertia;              // without geometric stiffness
  Quat rotation;             // rotation in the sub-step by its velocities
};

// Two joints that share a movable body, and the offset of their block.
struct ArticulationCoupling {
  std::uint32_t row = 0, column = 0;  // nodes
  std::uint32_t offset = 0;
  std::int32_t body = kNoBody;
  bool row_has_b = false, column_has_b = false;  // the body is b of the joint
};

// An axis with more than hard limits (solver/articulation/articulation_drives.h).
struct DrivenAxis {
  std::uint32_t node = 0;
  AxisConstraint* axis = nullptr;
};

struct Articulation {
  std::span<ArticulationNode> nodes;
  std::span<ArticulationBody> bodies;
  std::span<const ArticulationCoupling> couplings;
  BlockPlan plan;
  std::span<double> values;  // of the matrix, then of its factors
  std::span<double> room;
  std::span<double> vector;
  bool has_limits = false;  // hard limits (solver/articulation/articulation_limits.h)
  bool presses_held = false;  // a held body (rigid/solve/held_bodies.h)
  std::span<DrivenAxis> axes{};
  std::span<double> axis_room{};
};

struct ArticulationSolve {
  std::span<JointRecord> records;
  std::span<JointConstraint> work;
  std::span<const JointOffsets> offsets;
  JointBodies bodies;
  JointSettings settings;
  float compliance = 0.0f;   // compliance of rows, as a share of K
  std::span<double> room{};  // of the worker, for the limits of the largest articulation
};

// Adds `share` of the positive part of the geometric stiffness to an inertia and inverts it (six floats each,
// as Sym3).
void add_geometric_stiffness(const float* geometric_stiffness, const float* inertia, float share,
                             float* inverse_inertia);

// Prepares the rows at the present poses, and factors their matrix.
void prepare_articulation(const Articulation& articulation, const ArticulationSolve& solve);
// At the velocities after forces: computes the bias, and applies the impulses of the last sub-step.
void warm_start_articulation(const Articulation& articulation, const ArticulationSolve& solve);
void solve_articulation(const Articulation& articulation, const ArticulationSolve& solve);
// After the contacts.
void solve_articulation_after_contacts(const Articulation& articulation, const ArticulationSolve& solve);
// After the move: removes all speed along the rows, and sums the impulses.
void relax_articulation(const Articulation& articulation, const ArticulationSolve& solve);

}  // namespace gyre
