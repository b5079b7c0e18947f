// The context of the joint stages (rigid/solve/joint_stages.h): the joints of a batch. Articulations are solved directly; iterative joints
// are solved colour by colour.
#pragma once

#include "rigid/articulation/articulation_bundles.h"
#include "rigid/articulation/articulations.h"
#include "rigid/batch/joint_constraints.h"
#include "task/coloring.h"

namespace gyre {

struct JointGroup;
struct JointIsland;

// A body with geometric stiffness (rigid/solve/geometric_stiffness.h).
struct StiffenedBody {
  std::uint32_t body = 0;
  float added_inertia = 0.0f;  // kg m^2, about every axis
};

// The iterative joints of a batch. The lists persist between steps only to reuse their memory.
struct JointLists {
  Array<std::uint32_t> swept;  // indices in the batch's list of joints
  Array<ColoringPair> pairs;   // movable bodies of each: indices in the batch
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
  std::span<std::uint8_t> ball_lanes{};  // 1 for joints that may be solved as ball joints in lanes
  bool all_iterative = false;            // all are iterative: joints of ball_lanes begin in lanes
  LaneStart lane_start{};                // for joints that begin in lanes
  JointConstraints works{};
  Articulations articulations{};
  ArticulationSolve articulation_solve{};
  std::span<std::span<double>> limit_rooms{};  // by worker, if an articulation has limits
  BundleSolve bundles{};                       // articulations side by side
  std::span<std::uint32_t> order{};            // indices in the list of iterative joints, by groups
  std::span<JointGroup> groups{};
  void* balls = nullptr;  // blocks of ball joints: solver/articulation/ball_joint_simd.h
  std::span<const StiffenedBody> stiffened{};
  std::span<JointIsland> islands{};  // rigid/solve/energy_limiter.h
};

// A range of joints of one colour.
struct JointGroup {
  const JointSolve* solve = nullptr;
  std::uint32_t first = 0, count = 0;  // in JointSolve::order
  bool serial = false;                 // the overflow group, whose members share bodies
  std::int32_t ball_block = -1;        // first block of ball joints in lanes, or -1
  const int* bounds = nullptr;         // bounds of each worker's share: Stage::bounds
};

// By index in the batch: 1 for joints that begin and finish in lanes and have no JointConstraint.
inline std::span<const std::uint8_t> prepared_in_simd(const JointSolve& s) {
  return s.all_iterative ? s.ball_lanes : s.articulations.simd;
}

}  // namespace gyre
