#include "rigid/continuous/closing_lanes.h"

#include "rigid/continuous/closing_joints.h"
#include "rigid/articulation/linkage_bundles.h"
#include "task/parallel.h"

namespace gyre {

namespace {

// Enough to tell redundant rows apart.
constexpr float kGive = 1.0e-4f;
// Bends are for speeds that stay; of a way to a pose, in which errors are measured anew, little helps.
constexpr float kMostTurn = 0.15f;  // rad

// Whether lanes may bear the group, as far as that shows before its joints are looked at.
bool may_fit(const RigidWorld& w, const ClosingGroup& group) {
  if (!group.is_whole) return false;
  for (const ClosingMember& member : group.members) {
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

class LaneClosing {
 public:
  LaneClosing(RigidWorld& w, std::span<const ClosingGroup> groups, const ClosingBodies& bodies, Arena& arena)
      : w_(w),
        groups_(groups),
        bodies_(bodies),
        arena_(arena),
        is_led_(arena.make<std::uint8_t>(groups.size())) {
    for (std::uint8_t& led : is_led_) led = 0;
  }

  std::span<const std::uint8_t> follow(bool stays, const ContactKernels& kernels, TaskSystem& tasks) {
    list();
    if (batch_.joints.empty()) return is_led_;
    const LaneStart start{.limits_only = true};
    DenseNets dense;
    const Linkages linkages = find_linkages(w_, batch_, places_, net_joints_, {}, start, dense, arena_);
    const LaneArrays arrays{bodies_.motion.data(), bodies_.inertia.data(), bodies_.orientations.data()};
    const LaneSettings settings{
        kClosingStep, kClosingSettings.softness.bias_rate, kGive, raise_inertia, kMostErrors, 0.0f,
        kMostTurn,    false};
    bundles_ = lay_out_bundles(linkages, kernels, arrays, settings, arena_);
    ways_ = arena_.make<ClosingWay>(groups_.size());
    for (const LaneLinkage& linkage : linkages.alike) {
      const std::uint32_t group = group_of(linkage);
      is_led_[group] = 1;
      ways_[group] = ClosingWay(w_, groups_[group], bodies_, stays);
    }
    for_blocks(tasks, int(bundles_.bundles.size()), 1, [&](int begin, int end, int) {
      begin_bundles(bundles_, begin, end, w_, start);
      for (int i = begin; i < end; ++i) follow_bundle(bundles_.bundles[std::size_t(i)]);
    });
    return is_led_;
  }

 private:
  // The joints and bodies of all groups that may fit.
  void list() {
    std::size_t joints = 0, bodies = 0;
    for (const ClosingGroup& group : groups_) joints += group.joints.size(), bodies += group.members.size();
    const std::span<std::uint32_t> joint_list = arena_.make<std::uint32_t>(joints);
    const std::span<std::uint32_t> body_list = arena_.make<std::uint32_t>(bodies);
    group_of_joint_ = arena_.make<std::uint32_t>(joints);
    net_joints_ = arena_.make<NetJoint>(joints);
    places_ = arena_.make<std::uint32_t>(w_.bodies.motion.size());
    joints = bodies = 0;
    for (std::uint32_t g = 0; g < groups_.size(); ++g) {
      if (!may_fit(w_, groups_[g])) continue;
      for (const ClosingMember& member : groups_[g].members) {
        places_[member.body] = std::uint32_t(bodies);
        if (member.moves) body_list[bodies++] = member.body;
      }
      for (const std::uint32_t slot : groups_[g].joints) {
        group_of_joint_[joints] = g;
        net_joints_[joints] = net_joint(slot);
        joint_list[joints++] = slot;
      }
    }
    net_joints_ = net_joints_.first(joints);
    batch_.joints = joint_list.first(joints);
    batch_.bodies = body_list.first(bodies);
  }
  NetJoint net_joint(std::uint32_t slot) const {
    const auto moving = [&](std::int32_t body) {
      return body != kNoBody && is_active(w_, std::uint32_t(body)) ? body : kNoBody;
    };
    const JointRecord& joint = w_.joints.records[slot];
    return {moving(joint.body_a), moving(joint.body_b), count_equations(joint, detail_of(w_.joints, slot))};
  }
  std::uint32_t group_of(const LaneLinkage& linkage) const {
    return group_of_joint_[linkage.joints[0].place];
  }

  // All lanes step by step, until the last has come to its end.
  void follow_bundle(const Bundled& bundle) const {
    const LinkageKernels& kernels = *bundle.lanes.kernels;
    std::uint32_t going = (1u << bundle.linkages.size()) - 1;
    while (going != 0) {
      forget_lane_impulses(bundle.lanes);
      kernels.place(bundle.lanes, bundles_.arrays, bundles_.settings);
      std::uint32_t solved = 0;
      for (std::size_t lane = 0; lane < bundle.linkages.size(); ++lane) {
        if ((going >> lane & 1u) == 0) continue;
        const ClosingWay::Next next = way_of(bundle, lane).next(find_lane_error(bundle.lanes, int(lane)));
        if (next == ClosingWay::Next::solve) solved |= 1u << lane;
        if (next == ClosingWay::Next::done) going &= ~(1u << lane);
      }
      if (solved == 0) continue;
      kernels.ask(bundle.lanes, bundles_.arrays, bundles_.settings);
      kernels.solve(bundle.lanes, bundles_.arrays, bundles_.settings);
      kernels.solve_again(bundle.lanes, bundles_.arrays, bundles_.settings);
      for (std::size_t lane = 0; lane < bundle.linkages.size(); ++lane)
        if ((solved >> lane & 1u) != 0) way_of(bundle, lane).advance();
    }
  }
  ClosingWay& way_of(const Bundled& bundle, std::size_t lane) const {
    return ways_[group_of(*bundle.linkages[lane])];
  }

  RigidWorld& w_;
  std::span<const ClosingGroup> groups_;
  ClosingBodies bodies_;
  Arena& arena_;
  std::span<std::uint8_t> is_led_;
  SolveBatch batch_;
  std::span<std::uint32_t> places_;          // by body: in the batch's list
  std::span<std::uint32_t> group_of_joint_;  // by place in the batch's list
  std::span<NetJoint> net_joints_;
  BundleSolve bundles_;
  std::span<ClosingWay> ways_;  // by group
};

}  // namespace

std::span<const std::uint8_t> follow_in_lanes(RigidWorld& w, std::span<const ClosingGroup> groups,
                                              const ClosingBodies& bodies, bool stays,
                                              const ContactKernels& kernels, TaskSystem& tasks,
                                              Arena& arena) {
  return LaneClosing(w, groups, bodies, arena).follow(stays, kernels, tasks);
}

}  // namespace gyre
