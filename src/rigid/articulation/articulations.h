// Finds the articulations of a batch (solver/articulation/articulation.h): bodies connected by joints whose
// equations can be solved directly at a bounded cost, and their elimination order. All other joints are
// iterative.
#pragma once

#include "base/arena/arena.h"
#include "base/container/array.h"
#include "base/function_ref.h"
#include "rigid/batch/joint_constraints.h"
#include "rigid/batch/solve_batch.h"
#include "rigid/store/rigid_world.h"
#include "solver/articulation/articulation.h"
#include "solver/articulation/lane_transfer.h"

namespace gyre {

// The common data of articulations with equal topology, with the elimination order.
struct ArticulationTopology {
  std::span<LaneNode> nodes;
  std::span<LaneCoupling> couplings;
  std::span<TraversalStep> traversal;  // as ArticulationBundle::traversal
  BlockPlan plan;
  std::uint32_t body_count = 0, moving_count = 0;
  bool has_fill = false;  // as ArticulationBundle::has_fill
};

// A joint of an articulation.
struct ArticulationJoint {
  std::uint32_t record = 0;  // slot
  std::uint32_t index = 0;   // in the batch's list of joints
  std::int32_t body_a = kNoBody, body_b = kNoBody;
  bool pressed_a = false, pressed_b = false;  // contacts act on the body
  bool presses_held = false;                  // one of the bodies presses a held one
};
// An articulation that is solved side by side with others.
struct GroupedArticulation {
  std::span<const ArticulationJoint> joints;  // in the order of the topology's nodes
  std::uint32_t topology = 0;                 // index in Articulations::topologies
};

struct Articulations {
  std::span<Articulation> scalar;              // each solved by itself
  std::span<GroupedArticulation> grouped;      // solved side by side
  std::span<ArticulationTopology> topologies;  // of the grouped ones
  // By index in the batch's list of joints: 1 if it is in no articulation; 1 if it is in a grouped one.
  std::span<const std::uint8_t> iterative, simd;
};

// A cache of joint graphs that are too dense for direct elimination, so that they are not planned again. It
// may also hold all joints of a batch together, if none of its graphs can be planned. It persists between
// steps and never changes a result.
class DenseGraphCache {
 public:
  // True if a graph of these joints, in this order, was added before.
  bool contains(std::size_t size, FunctionRef<const JointEdge&(std::size_t)> joint_at) const;
  bool contains(std::span<const JointEdge> joints) const;
  void add(std::size_t size, FunctionRef<const JointEdge&(std::size_t)> joint_at);
  void add(std::span<const JointEdge> joints);

 private:
  static constexpr std::size_t kMaxGraphs = 16;
  struct JointGraph {
    std::size_t first = 0, size = 0;
  };
  Array<JointGraph> graphs_;
  Array<JointEdge> joints_;  // of all graphs, one after the other
};

// A value of `pressed` below: the body presses a held one (rigid/solve/held_bodies.h).
constexpr std::uint8_t kPressesHeld = 2;

// Finds the articulations of one batch. `places`: body indices of all batches (island_batches); `joints`:
// those of the batch. `pressed`: by body index, 1 for bodies with contacts, kPressesHeld for those that
// press a held body; or empty. `start`: settings of the lanes.
Articulations find_articulations(const RigidWorld& w, const SolveBatch& batch,
                                 std::span<const std::uint32_t> body_indices,
                                 std::span<const JointEdge> joints, std::span<const std::uint8_t> pressed,
                                 const LaneStart& start, DenseGraphCache& dense, Arena& arena);
// All joints are iterative.
Articulations no_articulations(std::size_t joints, Arena& arena);

// Gives scalar articulations the axes with more than hard limits.
void attach_drives(const Articulations& articulations, std::span<JointConstraint> work, Arena& arena);

// Marks scalar articulations with limits. Returns scratch memory for their solves, by worker.
std::span<std::span<double>> find_limits(const Articulations& articulations,
                                         std::span<const JointConstraint> work, std::size_t workers,
                                         Arena& arena);

}  // namespace gyre
