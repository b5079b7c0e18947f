#include "rigid/continuous/ccd_joint_groups.h"

#include "base/container/sort.h"
#include "rigid/batch/solve_batch.h"

namespace gyre {

namespace {

constexpr std::size_t kMaxJoints = 48;  // around each halted body; the body's own joints are always included

// True if its equations and limits depend on the positions of two bodies, and not only on rotation or travel.
bool constrains_pose(const RigidWorld& w, std::uint32_t joint) {
  const JointKind kind = w.joints.records[joint].kind;
  return is_joint_enabled(w, joint) && kind != JointKind::gear &&
         kind != JointKind::rack_and_pinion && kind != JointKind::pulley && kind != JointKind::mouse &&
         kind != JointKind::motor;
}

class GroupFinder {
 public:
  GroupFinder(const RigidWorld& w, std::span<const HaltedBody> halted, Arena& arena)
      : w_(w),
        halted_(halted),
        arena_(arena),
        group_of_joint_(arena.make<std::uint32_t>(w.joints.records.size())),
        group_of_body_(arena.make<std::uint32_t>(w.bodies.motion.size())),
        halt_of_(arena.make<const HaltedBody*>(w.bodies.motion.size())) {
    for (std::uint32_t& group : group_of_joint_) group = 0;
    for (std::uint32_t& group : group_of_body_) group = 0;
    for (const HaltedBody*& halt : halt_of_) halt = nullptr;
    for (const HaltedBody& one : halted) halt_of_[one.body] = &one;
  }

  std::span<ProjectionGroup> find_all() {
    const std::span<ProjectionGroup> groups = arena_.make<ProjectionGroup>(halted_.size());
    for (const HaltedBody& one : halted_)
      if (!is_in_groups(one.body)) groups[number_++] = find(one.body);
    return groups.first(number_);
  }

 private:
  bool is_in_groups(std::uint32_t body) const {
    for (const std::uint32_t slot : joints_of(w_.bodies, body))
      if (constrains_pose(w_, slot) && group_of_joint_[slot] == 0) return false;
    return true;
  }
  bool is_new(std::uint32_t slot) const {
    return constrains_pose(w_, slot) && group_of_joint_[slot] != number_ + 1;
  }
  void add_body(std::int32_t body, std::span<ProjectionMember> members, std::size_t& count) {
    if (body == kNoBody || group_of_body_[std::size_t(body)] == number_ + 1) return;
    group_of_body_[std::size_t(body)] = number_ + 1;
    ProjectionMember& member = members[count++] = ProjectionMember{};
    member.body = std::uint32_t(body);
    member.halted = halt_of_[std::size_t(body)];
  }

  // Body by body, nearest first, each with all of its joints.
  ProjectionGroup find(std::uint32_t first) {
    const std::size_t max_joints = max(kMaxJoints, joints_of(w_.bodies, first).size());
    ProjectionGroup group{arena_.make<std::uint32_t>(max_joints),
                          arena_.make<ProjectionMember>(max_joints + 1), true};
    std::size_t joints = 0, members = 0;
    add_body(std::int32_t(first), group.members, members);
    for (std::size_t next = 0; next < members; ++next) {
      ProjectionMember& member = group.members[next];
      if (!is_active(w_, member.body)) continue;
      std::size_t new_joints = 0;
      for (const std::uint32_t slot : joints_of(w_.bodies, member.body)) new_joints += is_new(slot) ? 1 : 0;
      member.moves = joints + new_joints <= max_joints;
      group.is_whole = group.is_whole && member.moves;
      if (!member.moves) continue;
      for (const std::uint32_t slot : joints_of(w_.bodies, member.body)) {
        if (!is_new(slot)) continue;
        group_of_joint_[slot] = number_ + 1;
        group.joints[joints++] = slot;
        add_body(w_.joints.records[slot].body_a, group.members, members);
        add_body(w_.joints.records[slot].body_b, group.members, members);
      }
    }
    group.joints = group.joints.first(joints);
    group.members = group.members.first(members);
    merge_sort(group.joints, arena_.make<std::uint32_t>(joints),
               [](std::uint32_t a, std::uint32_t b) { return a < b; });
    return group;
  }

  const RigidWorld& w_;
  std::span<const HaltedBody> halted_;
  Arena& arena_;
  std::span<std::uint32_t> group_of_joint_, group_of_body_;  // the last group, from 1 on; 0: none
  std::span<const HaltedBody*> halt_of_;                     // by body
  std::uint32_t number_ = 0;
};

}  // namespace

std::span<ProjectionGroup> find_projection_groups(const RigidWorld& w, std::span<const HaltedBody> halted,
                                                  Arena& arena) {
  return GroupFinder(w, halted, arena).find_all();
}

}  // namespace gyre
