#include "rigid/solve/contact_stages.h"

#include "rigid/solve/speculative_contacts.h"

#include <bit>

namespace gyre {

namespace {

// Lanes of the widest kernels.
constexpr int kMaxLanes = 16;

// Calls fn(rolling, block, lane) for the rolling contacts of the blocks. They are few.
template <class Fn>
void for_each_rolling(const ContactGroup& group, int begin, int end, Fn&& fn) {
  const ContactSolve& s = *group.solve;
  if (s.rolling.contacts.empty()) return;
  for (int block = int(group.first) + begin; block < int(group.first) + end; ++block) {
    for (unsigned lanes = s.rolling_lanes[std::size_t(block)]; lanes != 0; lanes &= lanes - 1) {
      const int lane = std::countr_zero(lanes);
      fn(s.rolling.contacts[s.rolling_indices[std::size_t(block * s.kernels.width + lane)]], block, lane);
    }
  }
}

// Advances the points of rolling contacts to the middle of the sub-step, and their bodies to the velocities there, until these contacts are
// solved.
void advance_contact_points(const ContactGroup& group, int begin, int end) {
  const ContactSolve& s = *group.solve;
  AdvancedArmsLane lanes[kMaxLanes];
  RollingContact* contacts[kMaxLanes];
  int present = 0, count = 0;
  const auto inverse_of = [&](std::int32_t body) {
    return body == kNoBody ? nullptr : &s.bodies.inertia[body].inverse;
  };
  const auto advance_block = [&] {
    if (count == 0) return;
    s.kernels.contacts.advance_points(s.blocks, present, lanes, count);
    for (int i = 0; i < count; ++i) {
      Vec3& spin = s.bodies.motion[contacts[i]->body].angular_velocity;
      spin = spin + contacts[i]->drift;
    }
    count = 0;
  };
  for_each_rolling(group, begin, end, [&](RollingContact& rolling, int block, int lane) {
    if (block != present) advance_block();
    present = block;
    if (rolling.once) s.rolling_lanes[std::size_t(block)] &= std::uint16_t(~(1u << lane));
    advance_contact_point(s.w, rolling, 0.5f * (rolling.once ? s.settings.step : s.settings.substep));
    contacts[count] = &rolling;
    lanes[count++] = {lane, &rolling.arms, inverse_of(body_a_of(rolling)), inverse_of(body_b_of(rolling))};
  });
  advance_block();
}
void advance_velocities(const ContactGroup& group, int begin, int end) {
  for_each_rolling(group, begin, end, [&](const RollingContact& rolling, int, int) {
    Vec3& spin = group.solve->bodies.motion[rolling.body].angular_velocity;
    spin = spin + rolling.drift;
  });
}
void restore_velocities(const ContactGroup& group, int begin, int end) {
  for_each_rolling(group, begin, end, [&](const RollingContact& rolling, int, int) {
    Vec3& spin = group.solve->bodies.motion[rolling.body].angular_velocity;
    spin = spin - rolling.drift;
  });
}

// Finds the manifolds of speculative contacts that would push, and solves those whose shapes meet.
void solve_speculative(const ContactSolve& s, int begin, int end) {
  const ContactKernels& kernels = s.kernels.contacts;
  std::uint32_t lanes = 0;
  while ((begin = kernels.find_pushing(s.blocks, begin, end, lanes)) < end) {
    for (; lanes != 0; lanes &= lanes - 1) {
      const int lane = std::countr_zero(lanes);
      const std::uint32_t index = s.lists.order[std::size_t(begin * s.kernels.width + lane)];
      if (find_meeting(s, index))
        kernels.solve_anew(s.blocks, begin, lane, s.lists.constraints[index], s.bodies, s.settings);
    }
  }
}

}  // namespace

void prepare_contacts(const ContactSolve& s, int begin, int end) {
  s.kernels.contacts.prepare(s.blocks, s.cold_blocks, begin, end, s.lists.constraints.data(),
                             s.lists.order.data(), s.bodies, s.settings);
}
void finish_contacts(const ContactSolve& s, int begin, int end) {
  s.kernels.contacts.finish(s.blocks, begin, end, s.lists.constraints.data(), s.lists.order.data(),
                            s.settings);
}

void warm_start_contacts(const ContactGroup& group, int begin, int end) {
  const ContactSolve& s = *group.solve;
  s.kernels.contacts.warm_start(s.blocks, int(group.first) + begin, int(group.first) + end);
}
void solve_contacts(const ContactGroup& group, int begin, int end) {
  const ContactSolve& s = *group.solve;
  // Blocks of the overflow group share bodies, so each block is advanced, solved and restored by itself.
  const int blocks = group.serial && (s.has_speculative || !s.rolling.contacts.empty()) ? 1 : end - begin;
  for (; begin < end; begin += blocks) {
    advance_contact_points(group, begin, begin + blocks);
    s.kernels.contacts.solve(s.blocks, int(group.first) + begin, int(group.first) + begin + blocks,
                             s.settings.substep);
    restore_velocities(group, begin, begin + blocks);
    if (s.has_speculative)
      solve_speculative(s, int(group.first) + begin, int(group.first) + begin + blocks);
  }
}
void solve_contacts_again(const ContactGroup& group, int begin, int end) {
  const ContactSolve& s = *group.solve;
  const int blocks = group.serial && !s.rolling.contacts.empty() ? 1 : end - begin;
  for (; begin < end; begin += blocks) {
    advance_velocities(group, begin, begin + blocks);
    s.kernels.contacts.solve_again(s.blocks, int(group.first) + begin, int(group.first) + begin + blocks,
                                   s.settings.substep);
    restore_velocities(group, begin, begin + blocks);
  }
}
void relax_contacts(const ContactGroup& group, int begin, int end) {
  const ContactSolve& s = *group.solve;
  s.kernels.contacts.relax(s.blocks, int(group.first) + begin, int(group.first) + end, s.settings.substep);
}
void project_contacts(const ContactGroup& group, int begin, int end) {
  const ContactSolve& s = *group.solve;
  s.kernels.contacts.project(s.blocks, int(group.first) + begin, int(group.first) + end, s.settings.step);
}

void record_contact_approach(const ContactSolve& s, int, int) { record_approach(s.lists.impacts, s.bodies); }
void apply_contact_restitution(const ContactSolve& s, int, int) {
  const auto find = [&](ImpactContact& impact) {
    if (!find_meeting(s, impact.constraint)) return false;
    read_manifold(impact);
    return true;
  };
  apply_restitution(s.lists.impacts, s.bodies, s.impact_settings, find);
}

void solve_resting_trees(const ContactSolve& s, int begin, int end) {
  for (int i = begin; i < end; ++i) solve_tree(s.forest.trees[std::size_t(i)], s.tree_solve);
}
void solve_resting_structures_first(const ContactSolve& s, int, int) {
  for (RestingStructure& structure : s.structures) solve_structure_first(structure, s.structure_solve);
}
void solve_resting_structures_last(const ContactSolve& s, int, int) {
  for (RestingStructure& structure : s.structures) solve_structure_last(structure, s.structure_solve);
}

}  // namespace gyre
