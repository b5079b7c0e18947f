// The stages of the solvers that treat constraints as rows (solver/rows/row.h): sequential impulses, and the complementarity problem of
// each island. Bodies, forces, fields, restitution and positions use the stages of the default solver. Between forces and positions one
// worker builds, solves and applies the rows of an island. At the end of the step the same solver removes penetration by displacements.
//
// In: gathered and begun contacts and joints of a batch. Out: velocities of bodies, impulses in manifolds and joints.
#pragma once

#include "rigid/solve/contact_solve.h"
#include "rigid/solve/joint_solve.h"
#include "rigid/solve/row_islands.h"
#include "rigid/store/solver_settings.h"
#include "solver/rows/friction_set.h"
#include "solver/rows/row.h"
#include "solver/rows/solve_direct.h"

namespace gyre {

// The settings of the world's row solver; null if the world uses the default solver.
inline const SolverSettings* row_solver_of(const RigidWorld& w) {
  return w.solver.empty() ? nullptr : &w.solver[0];
}

// The memory of one worker for the island that it solves.
struct RowWorkerRoom {
  std::span<Row> rows;
  std::span<float*> kept;
  std::span<RowBody> bodies;
  std::span<RowLimits> limits;
  std::span<std::int32_t> starts, first, next;
  std::span<double> numbers;
};

struct RowSolve {
  const ContactSolve& contacts;
  const JointSolve& joints;
  const SolverSettings& settings;
  FrictionSet friction, polygon;
  DirectMethod method = DirectMethod::dantzig;
  RowIslands islands{};
  std::span<RowWorkerRoom> rooms{};
  std::span<RowStats> reports{};  // by island
};

RowSolve begin_row_solve(const ContactSolve& contacts, const JointSolve& joints,
                         const SolverSettings& settings, std::size_t workers, Arena& arena);

// Stages; each block is an island. The first half-step starts from the scaled impulses of the last step.
void solve_row_islands_first(const RowSolve& s, int begin, int end, int worker);
void solve_row_islands(const RowSolve& s, int begin, int end, int worker);
void prepare_row_joints(const RowSolve& s, int begin, int end);
void sum_row_joints(const RowSolve& s, int begin, int end);
void push_row_islands_apart(const RowSolve& s, int begin, int end, int worker);

// Updates the load ages of contacts, and adds the statistics of the islands to the report.
void finish_row_solve(const RowSolve& s, RowStats& report);

}  // namespace gyre
