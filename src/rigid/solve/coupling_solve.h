// Couplings in a step: linear equations between axes of joints, solved in the generalised coordinates of their mechanisms.
//
// An impulse of a coupling changes the velocities of all bodies of the mechanism as M^-1 says, so joints stay satisfied and one solve is exact
// but for contacts, limits and loops. Couplings are solved after joints and after contacts, and relaxed at the new poses without bias.
// In: joint spaces of the mechanisms, errors of positions as the step began. Out: velocities of bodies; impulses for the warm start and for
// readings. One worker solves all couplings of a world, in order of slot.
#pragma once

#include "rigid/articulation/joint_space.h"
#include "rigid/store/rigid_world.h"

#include <span>
#include <vector>

namespace gyre {

// A coupling in a step.
struct CouplingWork {
  struct Term {
    std::size_t tree = 0, coordinate = 0;
    double coefficient = 0.0;
  };
  std::uint32_t slot = 0;
  double error = 0.0;    // present
  double impulse = 0.0;  // of the sub-step
  double mass = 0.0;     // effective; 0: nothing can move
  std::vector<Term> terms;
  std::vector<std::size_t> trees;
  std::vector<std::vector<double>>
      responses;  // by tree of the list: change of its speeds for an impulse of one
};

// Persists between steps only to reuse its memory.
struct CouplingSolve {
  RigidWorld* w = nullptr;
  float h = 0.0f;          // s, of a sub-step
  float bias_rate = 0.0f;  // 1/s
  float warm_scale = 1.0f;
  bool is_first = true;  // no sub-step was begun in this step
  std::vector<JointSpace> trees;
  std::vector<std::vector<double>> factors;  // of the mass matrices
  std::vector<CouplingWork> works;

  bool empty() const { return works.empty(); }
};

// Lists the bodies of all couplings that act on awake bodies.
void list_coupled_bodies(const RigidWorld& w, Array<std::uint32_t>& out);
// Finds the mechanisms and the errors.
void begin_couplings(CouplingSolve& solve, RigidWorld& w, float h, float bias_rate, float warm_scale);
// Stages of a sub-step; all have one block.
void warm_start_couplings(CouplingSolve& solve, int, int);
void solve_couplings(CouplingSolve& solve, int, int);       // with bias
void solve_couplings_last(CouplingSolve& solve, int, int);  // the same, before bodies move
void relax_couplings(CouplingSolve& solve, int, int);

}  // namespace gyre
