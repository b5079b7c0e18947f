// Linkages: bodies that hang together by joints, solved directly.
//
// The rows of a joint that hold always (a common point, a common axis, the length of a rod) are equations. Those of a whole
// linkage are solved together: (J M^-1 J^T + give) p = -(J v + errors), a sparse matrix of one block a joint, factored in an
// order found once a step (math/block_ldlt.h); for a tree that is elimination from the leaves to the root. What acts
// along axes (springs, motors, stops) is solved along what the equations make of it, after them (solver/articulation/articulation_drives.h, linkage_stops.h);
// drives to a pose are swept over first. The rows, softness excepted, are those of
// solver/joint/joint.h; docs/derive/joints.md has the equations, docs/decisions/joint-trees.md the figures.
//
// Sources: D. Baraff, "Linear-Time Dynamics using Lagrange Multipliers", SIGGRAPH 1996; R. Featherstone, "Rigid Body Dynamics
// Algorithms", 2008, chapter 8.
#pragma once

#include "math/block_ldlt.h"
#include "solver/joint/joint.h"

namespace gyre {

// The rows of a joint lie side by side, so that what one of them has to do with all others is one run over lanes. Lanes beyond the
// rows are zero.
constexpr int kRowLanes = 8;
struct RowVectors {
  float x[kRowLanes] = {}, y[kRowLanes] = {}, z[kRowLanes] = {};
  Vec3 at(int row) const { return {x[row], y[row], z[row]}; }
  void set(int row, Vec3 v) { x[row] = v.x, y[row] = v.y, z[row] = v.z; }
};

// A row sees push . (v_b - v_a) + arm_b . w_b - arm_a . w_a.
struct ArticulationRows {
  RowVectors direction;          // direction of a force; zero for a turning row
  RowVectors angular_a, angular_b;       // r x push, or the axis of a turn
  RowVectors spin_a, spin_b;     // inverse inertia times arm
  float compliance[kRowLanes] = {};  // added to K: the speed by which the row gives way to an impulse of one
  float target_speed[kRowLanes] = {};  // the speed asked for
};

// A joint of a linkage, while it is solved.
struct ArticulationNode {
  std::uint32_t record = 0;  // slot of the joint
  std::uint32_t work = 0;    // place of its JointConstraint
  std::int32_t body_a = kNoBody, body_b = kNoBody;
  std::int32_t side_a = -1, side_b = -1;  // which bodies of the linkage they are; -1: it cannot be pushed
  int count = 0;                          // rows
  ArticulationRows rows;
};
static_assert(kMaxBlockRows <= kRowLanes);

// A body of a linkage that moves.
struct ArticulationBody {
  std::int32_t body = kNoBody;
  bool is_pressed = false;  // contacts act on it
  Sym3 geometric_stiffness;  // by how much tension holds its orientation: N m / rad
  Sym3 inverse;             // inertia, raised to what a sub-step can bear
  Sym3 inertia;             // as it is
  Quat rotation;                // what its velocities make of a sub-step
};

// Two joints that share a body that moves, and where their block lies.
struct ArticulationCoupling {
  std::uint32_t row = 0, column = 0;  // nodes
  std::uint32_t offset = 0;
  std::int32_t body = kNoBody;
  bool row_has_b = false, column_has_b = false;  // the body is b of the joint
};

// An axis along which more acts than hard stops (solver/articulation/articulation_drives.h).
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
  bool has_limits = false;  // limits that do not give way (solver/articulation/articulation_limits.h)
  std::span<DrivenAxis> axes{};
  std::span<double> axis_room{};
};

struct ArticulationSolve {
  std::span<JointRecord> records;
  std::span<JointConstraint> work;
  std::span<const JointOffsets> offsets;
  JointBodies bodies;
  JointSettings settings;
  float compliance = 0.0f;   // share of K by which rows give way
  std::span<double> room{};  // of the worker, for the stops of the largest linkage
};

// The inverse of an inertia raised by `share` of what of `pull` holds back (six floats each, as Sym3).
void add_geometric_stiffness(const float* geometric_stiffness, const float* inertia, float share,
                             float* inverse_inertia);

// The rows where the bodies are now, and their matrix, factored.
void prepare_articulation(const Articulation& articulation, const ArticulationSolve& solve);
// With the velocities after the forces: what is asked of the rows, and the impulses of the last sub-step.
void warm_start_articulation(const Articulation& articulation, const ArticulationSolve& solve);
void solve_articulation(const Articulation& articulation, const ArticulationSolve& solve);
// After the contacts.
void solve_articulation_after_contacts(const Articulation& articulation, const ArticulationSolve& solve);
// After the move: takes away all speed along the rows, and sums the impulses.
void relax_articulation(const Articulation& articulation, const ArticulationSolve& solve);

}  // namespace gyre
