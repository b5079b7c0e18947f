#include "rigid/rest/resting_structures.h"

#include "math/rotation.h"

namespace gyre {

namespace {

// Larger islands are not solved as resting structures.
constexpr std::uint32_t kMaxBodies = 512;
// Islands with more contacts for each body are heaps. They are not solved as resting structures either.
constexpr std::uint32_t kMaxContactsPerBody = 4;
// A larger island is a heap if more than one in eight of its contacts has a single point. One of its bodies slips
// more often than not, and a direct solve of a heap of 300 bodies takes forty times as long as a step.
constexpr std::uint32_t kMaxInHeap = 32;
constexpr std::uint32_t kContactsPerSinglePoint = 8;
// An island that was not in equilibrium in the last step is tried again after this many steps, by its number of
// bodies, since a trial of a large island is dear. The interval of large islands follows the time in which their
// smallest body falls through its own size: sooner it cannot fall far.
constexpr std::uint32_t kMaxSmall = 4, kMaxMedium = 128;
constexpr std::uint64_t kRetryInterval = 8, kMinRetryIntervalIfLarge = 16;
constexpr float kFallTimesIfLarge = 4.0f, kMaxRetryIntervalIfLarge = 1024.0f;

bool is_due_this_step(const RigidWorld& w, const IslandCount& count) {
  if (count.bodies <= kMaxSmall) return true;
  if (count.bodies <= kMaxMedium) return w.steps % kRetryInterval == 0;
  const float fall = std::sqrt(count.smallest / length(w.settings.gravity));  // s
  const float interval = min(kFallTimesIfLarge * fall / w.settings.last_step, kMaxRetryIntervalIfLarge);
  return w.steps % max(std::uint64_t(interval), kMinRetryIntervalIfLarge) == 0;
}

// True if all contacts that carried load in the last step were solved directly.
bool is_in_equilibrium(const IslandCount& count) {
  return count.has_rigid_contact && !count.has_soft_contact;
}

bool can_be_in_equilibrium(const RigidWorld& w, const IslandCount& count) {
  if (count.refused || count.not_calm || count.ground_contacts == 0) return false;
  // Resting trees have a solver of their own (resting_trees.h).
  if (!count.has_narrow_contact && count.ground_contacts == 1 && count.contacts == count.bodies) return false;
  if (count.bodies > kMaxBodies || count.contacts > kMaxContactsPerBody * count.bodies) return false;
  if (count.bodies > kMaxInHeap && kContactsPerSinglePoint * count.single_point_contacts > count.contacts)
    return false;
  return is_in_equilibrium(count) || is_due_this_step(w, count);
}

class StructureBuilder {
 public:
  StructureBuilder(const RigidWorld& w, std::span<const ColoringPair> pairs, const SolveBatch& batch,
                   const RestingIslands& islands, Arena& arena)
      : w_(w),
        pairs_(pairs),
        batch_(batch),
        islands_(islands),
        arena_(arena),
        node_of_(arena.make<std::uint32_t>(batch.bodies.size())),
        members_(arena.make<Members>(batch.bodies.size())) {
    for (std::uint32_t i = 0; i < node_of_.size(); ++i) node_of_[i] = kNoNode, members_[i] = {};
  }

  // Lists nodes and contacts of each island at `roots`.
  void list(std::span<const std::uint32_t> roots) {
    for (const std::uint32_t root : roots) {
      members_[root].nodes = arena_.make<StructureNode>(islands_.at_root(root).bodies);
      members_[root].contacts = arena_.make<StructureContact>(islands_.at_root(root).contacts);
    }
    for (std::uint32_t index = 0; index < batch_.bodies.size(); ++index) {
      if (!is_movable(w_.bodies.flags[batch_.bodies[index]])) continue;
      Members& members = members_[islands_.root_of(index)];
      if (members.nodes.empty()) continue;
      node_of_[index] = members.bodies;
      members.nodes[members.bodies++] = make_node(batch_.bodies[index]);
    }
    for (std::uint32_t i = 0; i < pairs_.size(); ++i) {
      const ColoringPair& pair = pairs_[i];
      Members& members = members_[islands_.root_of(pair.a != ColoringPair::kNone ? pair.a : pair.b)];
      if (members.nodes.empty()) continue;
      StructureContact& contact = members.contacts[members.count++] = {};
      contact.constraint = i;
      contact.node_a = node_at(pair.a);
      contact.node_b = node_at(pair.b);
    }
  }

  RestingStructure make(std::uint32_t root) const {
    const Members& members = members_[root];
    RestingStructure structure;
    const IslandCount& count = islands_.at_root(root);
    structure.is_settling = count.not_settled;
    structure.was_rigid = is_in_equilibrium(count);
    structure.is_new = !count.has_rigid_contact && !count.has_soft_contact;
    structure.nodes = members.nodes;
    structure.contacts = members.contacts;
    structure.work = arena_.make<StructureScratch>(members.contacts.size());
    return structure;
  }

 private:
  struct Members {
    std::span<StructureNode> nodes;
    std::span<StructureContact> contacts;
    std::uint32_t bodies = 0, count = 0;
  };

  std::uint32_t node_at(std::uint32_t index) const {
    return index == ColoringPair::kNone ? kNoNode : node_of_[index];
  }
  StructureNode make_node(std::uint32_t body) const {
    const BodyMass& mass = w_.bodies.masses[body];
    StructureNode node;
    node.body = std::int32_t(body);
    node.mass = mass.mass;
    node.rest_speed = kStructureStillSpeedShare * std::sqrt(length(w_.settings.gravity) * mass.bounding_radius);
    node.rest_spin = mass.bounding_radius > 0.0f ? node.rest_speed / mass.bounding_radius : 0.0f;
    node.inertia = rotate_inertia(w_.bodies.poses[body].orientation, mass.inertia);
    return node;
  }

  const RigidWorld& w_;
  std::span<const ColoringPair> pairs_;
  const SolveBatch& batch_;
  const RestingIslands& islands_;
  Arena& arena_;
  std::span<std::uint32_t> node_of_;  // by index of the body in the batch
  std::span<Members> members_;        // by root
};

}  // namespace

std::span<RestingStructure> find_resting_structures(const RigidWorld& w, std::span<const ColoringPair> pairs,
                                                    const SolveBatch& batch, const RestingIslands& islands,
                                                    Arena& arena) {
  std::size_t count = 0;
  for (std::uint32_t index = 0; index < batch.bodies.size(); ++index) {
    if (islands.is_root(index) && can_be_in_equilibrium(w, islands.at_root(index))) ++count;
  }
  if (count == 0) return {};
  const std::span<std::uint32_t> roots = arena.make<std::uint32_t>(count);
  count = 0;
  for (std::uint32_t index = 0; index < batch.bodies.size(); ++index) {
    if (islands.is_root(index) && can_be_in_equilibrium(w, islands.at_root(index))) roots[count++] = index;
  }
  StructureBuilder builder(w, pairs, batch, islands, arena);
  builder.list(roots);
  const std::span<RestingStructure> structures = arena.make<RestingStructure>(count);
  for (std::size_t i = 0; i < count; ++i) structures[i] = builder.make(roots[i]);
  return structures;
}

void set_structure_positions(std::span<RestingStructure> structures, std::span<const std::uint32_t> positions,
                             int width) {
  for (RestingStructure& structure : structures) {
    for (StructureContact& contact : structure.contacts) {
      contact.block = positions[contact.constraint] / std::uint32_t(width);
      contact.lane = positions[contact.constraint] % std::uint32_t(width);
    }
  }
}

}  // namespace gyre
