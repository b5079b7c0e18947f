// Finds and counts the islands of a batch that may be at rest. Resting trees (resting_trees.h) and resting structures
// (resting_structures.h) solve such islands as a whole.
//
// The speeds below are shares of sqrt(gravity * bounding radius).
#pragma once

#include "base/arena/arena.h"
#include "base/container/disjoint_sets.h"
#include "rigid/batch/joint_constraints.h"
#include "rigid/batch/solve_batch.h"
#include "rigid/store/rigid_world.h"
#include "solver/contact/contact_block.h"
#include "task/coloring.h"

namespace gyre {

// A slower body is slow: it may belong to a resting island.
constexpr float kSlowSpeedShare = 0.1f;
// A slower body is calm. Islands with loops are only solved directly if all their bodies are calm.
constexpr float kCalmSpeedShare = 0.02f;
// A slower body has no velocity left to solve for in a resting tree.
constexpr float kStillSpeedShare = 1.0e-7f;
// The same in an island with loops, whose loads have larger rounding errors.
constexpr float kStructureStillSpeedShare = 1.0e-6f;
// A slower body is settled: only the forces of the step give it velocity.
constexpr float kSettledSpeedShare = 1.0e-4f;

// Counts of one island. They are incomplete if it is refused.
struct IslandCount {
  std::uint32_t bodies = 0, contacts = 0, ground_contacts = 0;
  std::uint32_t single_point_contacts = 0;
  std::uint32_t ground_contact = kNoIndex;  // the last contact with the fixed world
  float smallest = 0.0f;                    // m, the smallest bounding radius of its bodies
  bool refused = false;      // cannot be at rest: a fast or locked body, a joint, moving ground, no friction
  bool not_calm = false;     // a body is slow but not calm
  bool not_settled = false;  // a body is calm but not settled
  bool has_narrow_contact = false;  // a contact has one or two points
  bool has_soft_contact = false;    // a contact carried load in the last step and was solved iteratively
  bool has_rigid_contact = false;   // a contact carried load in the last step and was solved directly
};

class RestingIslands {
 public:
  // `pairs`: indices in the batch of the moving bodies of the constraints. `joints`: those of the batch.
  // `local_index`: by body its index in its batch.
  RestingIslands(const RigidWorld& w, std::span<const ContactConstraint> constraints,
                 std::span<const ColoringPair> pairs, std::span<const JointEdge> joints,
                 const SolveBatch& batch, std::span<const std::uint32_t> local_index, Arena& arena);

  // The index is that of a body in the batch. Only roots have counts.
  bool is_root(std::uint32_t index) const {
    return sets_.parents[index] == index && is_movable(w_.bodies.flags[batch_.bodies[index]]);
  }
  const IslandCount& at_root(std::uint32_t index) const { return counts_[index]; }
  std::uint32_t root_of(std::uint32_t index) const { return sets_.parents[index]; }

 private:
  void unite_constrained(std::span<const ColoringPair> pairs, std::span<const JointEdge> joints);
  void refuse_jointed(std::span<const JointEdge> joints);
  void count_bodies();
  void count_contacts(std::span<const ContactConstraint> constraints, std::span<const ColoringPair> pairs);

  const RigidWorld& w_;
  const SolveBatch& batch_;
  std::span<const std::uint32_t> local_index_;
  DisjointSets sets_;
  std::span<IslandCount> counts_;
};

// The contact constraints of each moving body as linked lists. A link is 2 * constraint + side; side 0 means that the
// body is body a of the constraint.
struct IncidentContacts {
  std::span<std::uint32_t> first;  // by index of the body in the batch
  std::span<std::uint32_t> next;   // by link
};
IncidentContacts link_incident_contacts(std::span<const ColoringPair> pairs, std::size_t bodies,
                                        Arena& arena);

// The position of each constraint in the memory of the kernels: `order` has `width` constraint indices for each
// block. Out: by constraint its index in `order`.
std::span<std::uint32_t> find_kernel_positions(std::span<const std::uint32_t> order, std::size_t constraints,
                                               Arena& arena);

}  // namespace gyre
