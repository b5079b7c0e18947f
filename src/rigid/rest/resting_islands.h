// The islands of a batch that may be at rest, counted for the solvers that take such islands whole: trees of contacts
// (contact_forest.h) and structures (contact_structures.h).
#pragma once

#include "base/arena/arena.h"
#include "rigid/batch/joint_constraints.h"
#include "rigid/batch/solve_batches.h"
#include "rigid/store/rigid_world.h"
#include "solver/contact/contact_block.h"
#include "task/coloring.h"

namespace gyre {

constexpr std::uint32_t kNoIndex = 0xffffffffu;

// Slower than this share of sqrt(gravity * reach) counts as at rest.
constexpr float kSlowSpeedShare = 0.1f;
// and slower than this one as all but at rest: what has loops is looked at only then.
constexpr float kCalmSpeedShare = 0.02f;
// Slower than this share of it a sweep has left nothing to solve.
constexpr float kStillSpeedShare = 1.0e-7f;
// The same of an island with loops, whose loads have more rounding.
constexpr float kStructureStillSpeedShare = 1.0e-6f;
// An island with loops that is slower than this as a step begins has nothing to lose but what the step's forces give it.
constexpr float kSettledSpeedShare = 1.0e-4f;

// What is counted about an island, as long as it is not refused.
struct IslandCount {
  std::uint32_t bodies = 0, contacts = 0, ground_contacts = 0;
  std::uint32_t single_point_contacts = 0;       // contacts of a single point
  std::uint32_t first = kNoIndex;  // its last contact with the fixed world
  float smallest = 0.0f;           // m: the least reach of its bodies
  bool refused = false;   // cannot be at rest: fast or bound bodies, joints, moving ground, no friction
  bool not_calm = false;  // a body at rest is not calm
  bool not_settled = false;  // one is not settled
  bool has_narrow_contact = false;  // a contact has one or two points
  bool has_soft_contact = false;   // a contact bore load in the last step and was not solved directly
  bool has_rigid_contact = false;      // and one was
};

class RestingIslands {
 public:
  // `pairs`: places of the constraints' bodies in the batch, as far as these move. `joints`: those of the batch. `places`: of all
  // bodies (solve_batches.h).
  RestingIslands(const RigidWorld& w, std::span<const ContactConstraint> constraints,
                 std::span<const ColoringPair> pairs, std::span<const JointEdge> joints,
                 const SolveBatch& batch, std::span<const std::uint32_t> local_index, Arena& arena);

  // By place of a body in the batch. Only roots have counts.
  bool is_root(std::uint32_t index) const {
    return parent_[index] == index && is_movable(w_.bodies.flags[batch_.bodies[index]]);
  }
  const IslandCount& at_root(std::uint32_t index) const { return counts_[index]; }
  std::uint32_t root_of(std::uint32_t index) const { return parent_[index]; }

 private:
  std::uint32_t root(std::uint32_t index);
  void unite(std::uint32_t index_a, std::uint32_t index_b);
  void unite_constrained(std::span<const ColoringPair> pairs, std::span<const JointEdge> joints);
  void refuse_jointed(std::span<const JointEdge> joints);
  void count_bodies();
  void count_contacts(std::span<const ContactConstraint> constraints, std::span<const ColoringPair> pairs);

  const RigidWorld& w_;
  const SolveBatch& batch_;
  std::span<const std::uint32_t> local_index_;
  std::span<std::uint32_t> parent_;
  std::span<IslandCount> counts_;
};

// For each body that moves the constraints it is in, as linked lists: link 2 * constraint + side (0: it is their a).
struct IncidentContacts {
  std::span<std::uint32_t> first;  // by the body's place
  std::span<std::uint32_t> next;   // by link
};
IncidentContacts link_incident_contacts(std::span<const ColoringPair> pairs, std::size_t bodies,
                                        Arena& arena);

// Where the kernels keep each constraint: `order` has `width` constraint indices a block. By constraint: its place in `order`.
std::span<std::uint32_t> find_kernel_positions(std::span<const std::uint32_t> order, std::size_t constraints,
                                            Arena& arena);

}  // namespace gyre
