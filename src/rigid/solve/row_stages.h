// The stages of the solvers that see constraints as rows (solver/rows/row.h): sequential impulses, and the complementarity problem of
// each island. Bodies, forces, fields, bounces and moves are those of the default solver; between forces and moves each island is solved by
// one worker: rows, solve, velocities. When the step is over overlap is pushed apart in displacements, by the same solver.
//
// In: contacts and joints of a batch, gathered and begun. Out: velocities of bodies, impulses in manifolds and joints.
#pragma once

#include "rigid/solve/contact_solve.h"
#include "rigid/solve/joint_solve.h"
#include "rigid/solve/row_islands.h"
#include "rigid/store/solver_settings.h"
#include "solver/rows/friction_set.h"
#include "solver/rows/row.h"
#include "solver/rows/solve_direct.h"

namespace gyre {

// The settings of the world's solver; null: the default one.
inline const SolverSettings* row_solver_of(const RigidWorld& w) {
  return w.solver.empty() ? nullptr : &w.solver[0];
}

// What one worker needs for the island that it is at.
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

// Stages, whose blocks are islands. In the first half-step impulses are those of the last step, scaled.
void solve_row_islands_first(const RowSolve& s, int begin, int end, int worker);
void solve_row_islands(const RowSolve& s, int begin, int end, int worker);
void prepare_row_joints(const RowSolve& s, int begin, int end);
void sum_row_joints(const RowSolve& s, int begin, int end);
void push_row_islands_apart(const RowSolve& s, int begin, int end, int worker);

// Ages of contacts; adds what the islands had to say to the report.
void finish_row_solve(const RowSolve& s, RowStats& report);

}  // namespace gyre
