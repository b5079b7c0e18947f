#include "rigid/continuous/ccd_joint_projection_simd.h"

#include "rigid/articulation/articulation_bundles.h"
#include "rigid/continuous/ccd_joint_constraints.h"
#include "task/parallel.h"

namespace gyre {

namespace {

// Enough to separate redundant rows.
constexpr float kProjectionCompliance = 1.0e-4f;
// The second-order bias is for velocities that persist; on the path to a pose, where errors are measured
// anew, it helps little.
constexpr float kMaxBiasAngleOfPath = 0.15f;  // rad

// True if the group may fit in lanes, before its joints are checked.
bool may_fit(const RigidWorld& w, const ProjectionGroup& group) {
  if (!group.is_whole) return false;
  for (const ProjectionMember& member : group.members) {
    const BodyFlags& flags = w.bodies.flags[member.body];
    if (member.moves ? flags.locked_linear != 0 : flags.type != BodyType::fixed) return false;
  }
  for (const std::uint32_t slot : group.joints) {
    const JointRecord& joint = w.joints.records[slot];
    const bool has_kind =
        joint.kind == JointKind::ball || joint.kind == JointKind::cone || joint.kind == JointKind::hinge;
    if (!has_kind || joint.body_a == joint.body_b) return false;
  }
  return true;
}

class LaneProjection {
 public:
  LaneProjection(RigidWorld& w, std::span<const ProjectionGroup> groups, const ProjectionBodies& bodies,
                 Arena& arena)
      : w_(w),
        groups_(groups),
        bodies_(bodies),
        arena_(arena),
        is_projected_(arena.make<std::uint8_t>(groups.size())) {
    for (std::uint8_t& projected : is_projected_) projected = 0;
  }

  std::span<const std::uint8_t> project(bool stop_at_impact, const SolverKernels& kernels,
                                        TaskSystem& tasks) {
    list();
    if (batch_.joints.empty()) return is_projected_;
    const LaneStart start{.limits_only = true};
    DenseGraphCache dense;
    const Articulations articulations =
        find_articulations(w_, batch_, body_indices_, joint_edges_, {}, start, dense, arena_);
    const LaneArrays arrays{bodies_.motion.data(), bodies_.inertia.data(), bodies_.orientations.data()};
    const LaneSettings settings{kProjectionStep,
                                kProjectionSettings.softness.bias_rate,
                                kProjectionCompliance,
                                add_geometric_stiffness,
                                kMaxErrors,
                                0.0f,
                                kMaxBiasAngleOfPath,
                                false};
    bundles_ = lay_out_bundles(articulations, kernels, arrays, settings, arena_);
    paths_ = arena_.make<ProjectionPath>(groups_.size());
    for (const GroupedArticulation& articulation : articulations.grouped) {
      const std::uint32_t group = group_of(articulation);
      is_projected_[group] = 1;
      paths_[group] = ProjectionPath(w_, groups_[group], bodies_, stop_at_impact);
    }
    for_blocks(tasks, int(bundles_.bundles.size()), 1, [&](int begin, int end, int) {
      begin_bundles(bundles_, begin, end, w_, start);
      for (int i = begin; i < end; ++i) project_bundle(bundles_.bundles[std::size_t(i)]);
    });
    return is_projected_;
  }

 private:
  // Lists the joints and bodies of all groups that may fit.
  void list() {
    std::size_t joints = 0, bodies = 0;
    for (const ProjectionGroup& group : groups_)
      joints += group.joints.size(), bodies += group.members.size();
    const std::span<std::uint32_t> joint_list = arena_.make<std::uint32_t>(joints);
    const std::span<std::uint32_t> body_list = arena_.make<std::uint32_t>(bodies);
    group_of_joint_ = arena_.make<std::uint32_t>(joints);
    joint_edges_ = arena_.make<JointEdge>(joints);
    body_indices_ = arena_.make<std::uint32_t>(w_.bodies.motion.size());
    joints = bodies = 0;
    for (std::uint32_t g = 0; g < groups_.size(); ++g) {
      if (!may_fit(w_, groups_[g])) continue;
      for (const ProjectionMember& member : groups_[g].members) {
        body_indices_[member.body] = std::uint32_t(bodies);
        if (member.moves) body_list[bodies++] = member.body;
      }
      for (const std::uint32_t slot : groups_[g].joints) {
        group_of_joint_[joints] = g;
        joint_edges_[joints] = joint_edge(slot);
        joint_list[joints++] = slot;
      }
    }
    joint_edges_ = joint_edges_.first(joints);
    batch_.joints = joint_list.first(joints);
    batch_.bodies = body_list.first(bodies);
  }
  JointEdge joint_edge(std::uint32_t slot) const {
    const auto moving = [&](std::int32_t body) {
      return body != kNoBody && is_active(w_, std::uint32_t(body)) ? body : kNoBody;
    };
    const JointRecord& joint = w_.joints.records[slot];
    return {moving(joint.body_a), moving(joint.body_b), count_equations(joint, detail_of(w_.joints, slot))};
  }
  std::uint32_t group_of(const GroupedArticulation& articulation) const {
    return group_of_joint_[articulation.joints[0].index];
  }

  // Moves all lanes segment by segment, until the last has reached its end.
  void project_bundle(const BundledArticulations& bundle) const {
    const ArticulationKernels& kernels = *bundle.lanes.kernels;
    std::uint32_t active = (1u << bundle.articulations.size()) - 1;
    while (active != 0) {
      clear_lane_impulses(bundle.lanes);
      kernels.prepare(bundle.lanes, bundles_.arrays, bundles_.settings);
      std::uint32_t solved = 0;
      for (std::size_t lane = 0; lane < bundle.articulations.size(); ++lane) {
        if ((active >> lane & 1u) == 0) continue;
        const ProjectionPath::Next next =
            path_of(bundle, lane).next(find_lane_error(bundle.lanes, int(lane)));
        if (next == ProjectionPath::Next::solve) solved |= 1u << lane;
        if (next == ProjectionPath::Next::done) active &= ~(1u << lane);
      }
      if (solved == 0) continue;
      kernels.compute_bias(bundle.lanes, bundles_.arrays, bundles_.settings);
      kernels.solve(bundle.lanes, bundles_.arrays, bundles_.settings);
      kernels.solve_after_contacts(bundle.lanes, bundles_.arrays, bundles_.settings);
      for (std::size_t lane = 0; lane < bundle.articulations.size(); ++lane)
        if ((solved >> lane & 1u) != 0) path_of(bundle, lane).advance();
    }
  }
  ProjectionPath& path_of(const BundledArticulations& bundle, std::size_t lane) const {
    return paths_[group_of(*bundle.articulations[lane])];
  }

  RigidWorld& w_;
  std::span<const ProjectionGroup> groups_;
  ProjectionBodies bodies_;
  Arena& arena_;
  std::span<std::uint8_t> is_projected_;
  SolveBatch batch_;
  std::span<std::uint32_t> body_indices_;    // by body: index in the batch's list
  std::span<std::uint32_t> group_of_joint_;  // by index in the batch's list
  std::span<JointEdge> joint_edges_;
  BundleSolve bundles_;
  std::span<ProjectionPath> paths_;  // by group
};

}  // namespace

std::span<const std::uint8_t> project_batched(RigidWorld& w, std::span<const ProjectionGroup> groups,
                                              const ProjectionBodies& bodies, bool stop_at_impact,
                                              const SolverKernels& kernels, TaskSystem& tasks,
                                              Arena& arena) {
  return LaneProjection(w, groups, bodies, arena).project(stop_at_impact, kernels, tasks);
}

}  // namespace gyre
