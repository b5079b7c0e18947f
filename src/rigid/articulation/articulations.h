// Finds the linkages of a batch (solver/articulation/articulation.h): bodies that hang together by joints whose equations can be solved
// directly at a bounded price, and the order of their elimination. The rest stays with the sweeps.
#pragma once

#include "base/arena/arena.h"
#include "base/container/array.h"
#include "base/function_ref.h"
#include "rigid/batch/joint_constraints.h"
#include "rigid/batch/solve_batches.h"
#include "rigid/store/rigid_world.h"
#include "solver/articulation/articulation.h"
#include "solver/articulation/lane_transfer.h"

namespace gyre {

// What linkages that hang together alike have in common: how, and the order of their elimination.
struct ArticulationTopology {
  std::span<LaneNode> nodes;
  std::span<LaneCoupling> couplings;
  std::span<TraversalStep> traversal;  // as ArticulationBundle::walk
  BlockPlan plan;
  std::uint32_t body_count = 0, moving_count = 0;
  bool has_fill = false;  // as ArticulationBundle::has_fill
};

// A joint of a linkage.
struct ArticulationJoint {
  std::uint32_t record = 0;  // slot
  std::uint32_t index = 0;   // in the batch's list of joints
  std::int32_t body_a = kNoBody, body_b = kNoBody;
  bool pressed_a = false, pressed_b = false;  // contacts act on them
};
// A linkage that is solved beside others.
struct GroupedArticulation {
  std::span<const ArticulationJoint> joints;  // in the order of the shape's nodes
  std::uint32_t topology = 0;              // which it is like
};

struct Articulations {
  std::span<Articulation> scalar;        // each solved by itself
  std::span<GroupedArticulation> grouped;    // those that are solved side by side,
  std::span<ArticulationTopology> topologies;  // and what they are like
  // By place in the batch's list of joints: 1 if it is in no linkage; 1 if it is in one that is solved side by side.
  std::span<const std::uint8_t> iterative, simd;
};

// Nets that were found too dense to be planned, by all that the plan is made of: whoever asks for the same again need not try. Also
// all joints of a batch together, where no net of it can be. Kept from step to step; what is in it never changes a result.
class DenseGraphCache {
 public:
  // Whether a net of so many joints, in this order, was added before.
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
  Array<JointEdge> joints_;  // of all nets, one after the other
};

// Of one batch; `places` are those of all (solve_batches.h), `joints` are the batch's. `pressed`: by place, 1 of bodies on which contacts
// act; or empty. `start`: how lanes will be begun.
Articulations find_articulations(const RigidWorld& w, const SolveBatch& batch,
                                 std::span<const std::uint32_t> body_indices, std::span<const JointEdge> joints,
                                 std::span<const std::uint8_t> pressed, const LaneStart& start,
                                 DenseGraphCache& dense, Arena& arena);
// Where all joints are swept.
Articulations no_articulations(std::size_t joints, Arena& arena);

// Gives linkages that are solved alone the axes along which more acts than hard stops.
void attach_drives(const Articulations& articulations, std::span<JointConstraint> work, Arena& arena);

// Notes which linkages that are solved alone have stops. Returns room to solve these in, by worker.
std::span<std::span<double>> find_limits(const Articulations& articulations, std::span<const JointConstraint> work,
                                         std::size_t workers, Arena& arena);

}  // namespace gyre
