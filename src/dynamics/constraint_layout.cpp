#include "dynamics/constraint_layout.h"

namespace gyre {

namespace {

void mark_rolling_lanes(ContactSolve& s, std::uint32_t blocks, Arena& arena) {
  const std::uint32_t width = std::uint32_t(s.kernels.width);
  s.rolling_lanes = arena.make<std::uint16_t>(blocks);
  s.rolling_indices = arena.make<std::uint32_t>(std::size_t(blocks) * width);
  for (std::uint32_t block = 0; block < blocks; ++block) {
    unsigned lanes = 0;
    for (std::uint32_t lane = 0; lane < width; ++lane) {
      const std::uint32_t constraint = s.lists.order[block * width + lane];
      const std::uint32_t index = constraint == kNoIndex ? kNotRolling : s.rolling.of_constraint[constraint];
      s.rolling_indices[block * width + lane] = index;
      if (index != kNotRolling) lanes |= 1u << lane;
    }
    s.rolling_lanes[block] = std::uint16_t(lanes);
  }
}

// Sort key by which similar contacts of a colour share blocks. A block takes as long as its lane with the most points. It is solved again
// if a point would pull, as points without load do. If one lane rolls, the points of the whole block are advanced, once or in each
// half-step. Contacts of one colour are independent, so their order is free. Contacts without a body A come last.
constexpr int kWaysToRoll = 3;
constexpr int kWithA = 2 * kWaysToRoll * kMaxManifoldPoints;
int likeness(const BatchContext& batch, std::uint32_t member) {
  const ContactConstraint& constraint = batch.scratch.contacts.constraints[member];
  const int points = kMaxManifoldPoints - constraint.point_count, load = constraint.loaded ? 0 : 1;
  const RollingContacts& rolling = batch.contacts.rolling;
  const std::uint32_t place = rolling.contacts.empty() ? kNotRolling : rolling.of_constraint[member];
  const int roll = place == kNotRolling ? 2 : rolling.contacts[place].once ? 1 : 0;
  return (constraint.body_a == kNoBody ? kWithA : 0) + kWaysToRoll * (2 * points + load) + roll;
}

// Appends the members of a colour to the order, in whole blocks, share by share, and writes the `bounds` of several shares.
void order_alike(const BatchContext& batch, std::span<const std::uint32_t> members,
                 Array<std::uint32_t>& order, int* bounds) {
  constexpr int kKinds = 2 * kWithA;
  const std::size_t shares = std::size_t(batch.partition.count());
  const auto kind_of = [&](std::uint32_t member) {
    return std::size_t(batch.partition.of(batch.scratch.contacts.pairs[member]) * kKinds +
                       likeness(batch, member));
  };
  std::uint32_t starts[kMaxShares * kKinds], firsts[kMaxShares];
  for (std::size_t i = 0; i < shares * kKinds; ++i) starts[i] = 0;
  for (const std::uint32_t member : members) ++starts[kind_of(member)];
  // No block mixes contacts with and without a body A.
  const std::uint32_t width = std::uint32_t(batch.kernels.width);
  std::uint32_t place = 0;
  bool had_a = true;
  for (std::size_t half = 0; half < 2 * shares; ++half) {
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
  if (shares > 1 && bounds != nullptr)
    find_share_bounds(std::span(firsts).first(shares), place, width, bounds);
}

}  // namespace

std::span<ContactGroup> lay_out_contacts(BatchContext& batch, std::span<ContactGroup> groups) {
  ContactLists& lists = batch.scratch.contacts;
  Array<std::uint32_t>& order = lists.order;
  const Coloring& colors = batch.scratch.contact_colors;
  const std::uint32_t width = std::uint32_t(batch.kernels.width);
  order.clear();
  std::size_t used = 0;
  std::uint32_t blocks = 0;
  const auto lay_out = [&](int g, std::span<const std::uint32_t> members, bool held) {
    if (members.empty()) return;
    const bool serial = g == colors.overflow_group();
    int* const bounds = serial || batch.group_bounds.empty()
                            ? nullptr
                            : &batch.group_bounds[used * std::size_t(batch.partition.count() + 1)];
    if (serial) {
      order.resize(order.size() + members.size() * width, kNoIndex);
      for (std::size_t i = 0; i < members.size(); ++i) order[(blocks + i) * width] = members[i];
    } else {
      order_alike(batch, members, order, bounds);
    }
    const std::uint32_t end = std::uint32_t(order.size()) / width;
    groups[used++] = {&batch.contacts, blocks, end - blocks, serial, bounds, held};
    blocks = end;
    batch.scratch.counts.colors_used |= std::uint64_t{1} << g;
  };
  const std::span<const std::uint8_t> held = batch.contacts.held.contacts;
  for (int g = 0; g < colors.group_count() && held.empty(); ++g) lay_out(g, colors.group(g), false);
  for (int part = 0; part < 2 && !held.empty(); ++part) {
    for (int g = 0; g < colors.group_count(); ++g) {
      lists.members.clear();
      for (const std::uint32_t member : colors.group(g))
        if (held[member] == part) lists.members.push_back(member);
      lay_out(g, lists.members.view(), part == 1);
    }
  }
  return groups.first(used);
}

void make_contact_blocks(BatchContext& batch, Arena& arena) {
  const std::span<const ContactGroup> groups = batch.contact_groups;
  ContactSolve& contacts = batch.contacts;
  const std::uint32_t blocks = groups.empty() ? 0 : groups.back().first + groups.back().count;
  if (!contacts.rolling.contacts.empty()) mark_rolling_lanes(contacts, blocks, arena);
  const ContactKernels& kernels = contacts.kernels.contacts;
  contacts.blocks = arena.make<std::byte>(std::size_t(blocks) * kernels.block_bytes).data();
  contacts.cold_blocks = arena.make<std::byte>(std::size_t(blocks) * kernels.cold_bytes).data();
}

namespace {

// Begins a ball joint of a group whose joints are solved one after the other.
void begin_ball_alone(JointSolve& s, std::uint32_t joint, Arena& arena) {
  if (s.all_iterative) begin_joint(s.w, s.batch, joint, s.lane_start.warm_scale, s.works, arena);
}

}  // namespace

void lay_out_joints(BatchContext& batch, Arena& arena) {
  JointSolve& s = batch.joints;
  if (s.lists.swept.empty()) return;
  const Coloring& colors = batch.scratch.joint_colors;
  const std::span<JointGroup> groups = arena.make<JointGroup>(2 * std::size_t(colors.group_count()));
  s.order = arena.make<std::uint32_t>(colors.order.size());
  const std::uint32_t width = std::uint32_t(s.kernels.width);
  const auto is_ball = [&](std::uint32_t member) { return s.ball_lanes[s.lists.swept[member]] != 0; };
  std::size_t used = 0;
  std::uint32_t blocks = 0;
  for (int g = 0; g < colors.group_count(); ++g) {
    const std::span<const std::uint32_t> members = colors.group(g);
    const std::uint32_t first = colors.offsets[g], count = std::uint32_t(members.size());
    const bool serial = g == colors.overflow_group();
    std::uint32_t balls = 0, others = 0;
    for (const std::uint32_t member : members) {
      if (serial && is_ball(member)) begin_ball_alone(s, s.lists.swept[member], arena);
      balls += !serial && is_ball(member) ? 1 : 0;
    }
    std::uint32_t placed = 0;
    for (const std::uint32_t member : members)
      s.order[first + (!serial && is_ball(member) ? placed++ : balls + others++)] = member;
    if (balls > 0) groups[used++] = {&s, first, balls, false, std::int32_t(blocks)};
    if (others > 0) groups[used++] = {&s, first + balls, count - balls, serial};
    blocks += (balls + width - 1) / width;
  }
  s.balls = arena.make<std::byte>(blocks * s.kernels.balls.block_bytes).data();
  s.groups = groups.first(used);
}

}  // namespace gyre
