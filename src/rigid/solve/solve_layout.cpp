#include "rigid/solve/solve_layout.h"

#include "rigid/batch/joint_constraints.h"

namespace gyre {

namespace {

void mark_rolling_lanes(BatchContext& solve, std::uint32_t blocks, Arena& arena) {
  const std::uint32_t width = std::uint32_t(solve.kernels.width);
  solve.rolling_lanes = arena.make<std::uint16_t>(blocks);
  solve.rolling_places = arena.make<std::uint32_t>(std::size_t(blocks) * width);
  for (std::uint32_t block = 0; block < blocks; ++block) {
    unsigned lanes = 0;
    for (std::uint32_t lane = 0; lane < width; ++lane) {
      const std::uint32_t constraint = solve.scratch.order[block * width + lane];
      const std::uint32_t place =
          constraint == kNoIndex ? kNotRolling : solve.rolling.of_constraint[constraint];
      solve.rolling_places[block * width + lane] = place;
      if (place != kNotRolling) lanes |= 1u << lane;
    }
    solve.rolling_lanes[block] = std::uint16_t(lanes);
  }
}

// A block takes as long as the lane with the most points, and is swept again where some point would pull, as those do that bear
// nothing; where some lanes roll, the whole block is taken along, in each part or once: so contacts that are alike lie side by
// side. Those of one colour do not notice each other. Those without a body A come last.
constexpr int kWaysToRoll = 3;
constexpr int kWithA = 2 * kWaysToRoll * kMaxManifoldPoints;
int likeness(const BatchContext& solve, std::uint32_t member) {
  const ContactConstraint& constraint = solve.scratch.constraints[member];
  const int points = kMaxManifoldPoints - constraint.point_count, load = constraint.loaded ? 0 : 1;
  const RollingContacts& rolling = solve.rolling;
  const std::uint32_t place = rolling.contacts.empty() ? kNotRolling : rolling.of_constraint[member];
  const int roll = place == kNotRolling ? 2 : rolling.contacts[place].once ? 1 : 0;
  return (constraint.body_a == kNoBody ? kWithA : 0) + kWaysToRoll * (2 * points + load) + roll;
}

// Appends the members of a colour to the order, in whole blocks, domain by domain; `bounds` of these, if there are several.
void order_alike(const BatchContext& solve, std::span<const std::uint32_t> members,
                 Array<std::uint32_t>& order, int* bounds) {
  constexpr int kKinds = 2 * kWithA;
  const std::size_t domains = std::size_t(solve.domains.count());
  const auto kind_of = [&](std::uint32_t member) {
    return std::size_t(solve.domains.of(solve.scratch.pairs[member]) * kKinds + likeness(solve, member));
  };
  std::uint32_t starts[kMaxPartitions * kKinds], firsts[kMaxPartitions];
  for (std::size_t i = 0; i < domains * kKinds; ++i) starts[i] = 0;
  for (const std::uint32_t member : members) ++starts[kind_of(member)];
  // No block has contacts with and without a body A.
  const std::uint32_t width = std::uint32_t(solve.kernels.width);
  std::uint32_t place = 0;
  bool had_a = true;
  for (std::size_t half = 0; half < 2 * domains; ++half) {
    const bool has_a = half % 2 == 0;
    if (has_a) firsts[half / 2] = place;
    for (std::uint32_t& start : std::span(starts).subspan(half * kWithA, kWithA)) {
      const std::uint32_t count = start;
      if (count > 0 && has_a != had_a) {
        const std::uint32_t whole = (place + width - 1) / width * width;
        if (firsts[half / 2] == place) firsts[half / 2] = whole;
        place = whole;
        had_a = has_a;
      }
      start = place;
      place += count;
    }
  }
  const std::size_t first = order.size();
  order.resize(first + (place + width - 1) / width * width, kNoIndex);
  for (const std::uint32_t member : members) order[first + starts[kind_of(member)]++] = member;
  if (domains > 1 && bounds != nullptr)
    set_partition_bounds(std::span(firsts).first(domains), place, width, bounds);
}

}  // namespace

std::span<Group> lay_out_contacts(BatchContext& solve, std::span<Group> groups) {
  BatchScratch& s = solve.scratch;
  const Coloring& colors = s.contact_colors;
  const std::uint32_t width = std::uint32_t(solve.kernels.width);
  s.order.clear();
  std::size_t used = 0;
  std::uint32_t blocks = 0;
  for (int g = 0; g < colors.group_count(); ++g) {
    const std::span<const std::uint32_t> members = colors.group(g);
    if (members.empty()) continue;
    const bool serial = g == colors.overflow_group();
    int* const bounds = serial || solve.group_bounds.empty()
                            ? nullptr
                            : &solve.group_bounds[used * std::size_t(solve.domains.count() + 1)];
    if (serial) {
      s.order.resize(s.order.size() + members.size() * width, kNoIndex);
      for (std::size_t i = 0; i < members.size(); ++i) s.order[(blocks + i) * width] = members[i];
    } else {
      order_alike(solve, members, s.order, bounds);
    }
    const std::uint32_t end = std::uint32_t(s.order.size()) / width;
    groups[used++] = {
        .solve = &solve, .first = blocks, .count = end - blocks, .serial = serial, .bounds = bounds};
    blocks = end;
    s.counts.colors_used |= std::uint64_t{1} << g;
  }
  return groups.first(used);
}

void make_contact_blocks(BatchContext& solve, std::span<const Group> groups, Arena& arena) {
  const std::uint32_t blocks = groups.empty() ? 0 : groups.back().first + groups.back().count;
  if (!solve.rolling.contacts.empty()) mark_rolling_lanes(solve, blocks, arena);
  solve.blocks = arena.make<std::byte>(std::size_t(blocks) * solve.kernels.block_bytes).data();
  solve.cold_blocks = arena.make<std::byte>(std::size_t(blocks) * solve.kernels.aside_bytes).data();
}

namespace {

// Of a group whose joints are solved one after the other.
void begin_ball_alone(BatchContext& solve, std::uint32_t joint, Arena& arena) {
  if (solve.all_iterative)
    begin_joint(solve.w, solve.batch, joint, solve.lane_start.warm_scale,
                {solve.joint_work, solve.joint_offsets}, arena);
}

}  // namespace

std::span<Group> lay_out_joints(BatchContext& solve, Arena& arena) {
  if (solve.scratch.swept_joints.empty()) return {};
  const Coloring& colors = solve.scratch.joint_colors;
  const std::span<Group> groups = arena.make<Group>(2 * std::size_t(colors.group_count()));
  solve.joint_order = arena.make<std::uint32_t>(colors.order.size());
  const std::uint32_t width = std::uint32_t(solve.kernels.width);
  const auto is_ball = [&](std::uint32_t member) {
    return solve.ball_lanes[solve.scratch.swept_joints[member]] != 0;
  };
  std::size_t used = 0;
  std::uint32_t blocks = 0;
  for (int g = 0; g < colors.group_count(); ++g) {
    const std::span<const std::uint32_t> members = colors.group(g);
    const std::uint32_t first = colors.offsets[g], count = std::uint32_t(members.size());
    const bool serial = g == colors.overflow_group();
    std::uint32_t balls = 0, others = 0;
    for (const std::uint32_t member : members) {
      if (serial && is_ball(member)) begin_ball_alone(solve, solve.scratch.swept_joints[member], arena);
      balls += !serial && is_ball(member) ? 1 : 0;
    }
    std::uint32_t placed = 0;
    for (const std::uint32_t member : members)
      solve.joint_order[first + (!serial && is_ball(member) ? placed++ : balls + others++)] = member;
    if (balls > 0) groups[used++] = {&solve, first, balls, false, std::int32_t(blocks)};
    if (others > 0) groups[used++] = {&solve, first + balls, count - balls, serial};
    blocks += (balls + width - 1) / width;
  }
  solve.balls = arena.make<std::byte>(blocks * solve.kernels.balls.block_bytes).data();
  return groups.first(used);
}

}  // namespace gyre
