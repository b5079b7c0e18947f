// What the stages of joints (rigid/solve/joint_stages.h) work on: the joints of a batch, those in articulations that are solved directly
// and those that are solved iteratively, colour by colour.
#pragma once

#include "rigid/articulation/articulation_bundles.h"
#include "rigid/articulation/articulations.h"
#include "rigid/batch/joint_constraints.h"
#include "task/coloring.h"

namespace gyre {

struct JointGroup;
struct JointIsland;

// A body of which joints ask more than a sub-step resolves (rigid/solve/geometric_stiffness.h).
struct StiffenedBody {
  std::uint32_t body = 0;
  float added_inertia = 0.0f;  // kg m^2, about every axis
};

// The joints of a batch that are in no articulation. Kept from step to step only for its memory.
struct JointLists {
  Array<std::uint32_t> swept;  // indices in the batch's list of joints
  Array<ColoringPair> pairs;   // between which bodies each is: indices in the batch, as far as they move
  DenseGraphCache dense_graphs;
};

struct JointSolve {
  RigidWorld& w;
  JointLists& lists;
  const SolverKernels& kernels;
  SolveBatch batch{};
  std::span<const std::uint32_t> local_index{};  // by body: its index in its batch
  JointSettings settings{};
  JointBodies bodies{};
  std::span<JointEdge> edges{};          // of the batch's joints
  std::span<std::uint8_t> ball_lanes{};  // 1 for those that may be solved as ball joints side by side
  bool all_iterative = false;     // all are known to be swept: those of ball_lanes are begun in their lanes
  LaneStart lane_start{};  // of joints that are begun in lanes
  JointConstraints works{};
  Articulations articulations{};
  ArticulationSolve articulation_solve{};
  std::span<std::span<double>> limit_rooms{};  // by worker, where an articulation has limits
  BundleSolve bundles{};                       // articulations side by side
  std::span<std::uint32_t> order{};            // indices in the list of swept joints, by groups
  std::span<JointGroup> groups{};
  void* balls = nullptr;  // ball joints side by side: solver/articulation/ball_joint_simd.h
  std::span<const StiffenedBody> stiffened{};
  std::span<JointIsland> islands{};  // rigid/solve/energy_limiter.h
};

// Joints of one colour.
struct JointGroup {
  const JointSolve* solve = nullptr;
  std::uint32_t first = 0, count = 0;  // in the joint order
  bool serial = false;           // what is left over when the colours are used up: its members share bodies
  std::int32_t ball_block = -1;  // of ball joints that are solved side by side: their first block
  const int* bounds = nullptr;   // of each worker's share: Stage::bounds
};

// By index in the batch: 1 for those joints that are begun and finished in their lanes, and have no work.
inline std::span<const std::uint8_t> prepared_in_simd(const JointSolve& s) {
  return s.all_iterative ? s.ball_lanes : s.articulations.simd;
}

}  // namespace gyre
