#include "rigid/rest/resting_trees.h"

namespace gyre {

namespace {

bool is_resting_tree(const IslandCount& count) {
  return !count.refused && !count.has_narrow_contact && count.ground_contacts == 1 &&
         count.contacts == count.bodies && count.bodies > 0;
}

TreeNode make_node(const RigidWorld& w, std::int32_t body, std::int32_t parent, std::uint32_t constraint,
                   bool is_b, float gravity) {
  const BodyMass& mass = w.bodies.masses[body];
  TreeNode node;
  node.body = body;
  node.parent = parent;
  node.constraint = constraint;
  node.sign = is_b ? 1.0f : -1.0f;
  node.mass = mass.mass;
  node.rest_speed = kStillSpeedShare * std::sqrt(gravity * mass.bounding_radius);
  node.rest_spin = mass.bounding_radius > 0.0f ? node.rest_speed / mass.bounding_radius : 0.0f;
  node.center = w.bodies.poses[body].center;
  node.orientation = w.bodies.poses[body].orientation;
  node.inertia = mass.inertia;
  return node;
}

}  // namespace

RestingTrees find_resting_trees(const RigidWorld& w, std::span<ContactConstraint> constraints,
                                std::span<const ColoringPair> pairs, const SolveBatch& batch,
                                const RestingIslands& islands, Arena& arena) {
  RestingTrees trees;
  std::size_t tree_count = 0, nodes = 0;
  const auto is_tree = [&](std::uint32_t index) {
    return islands.is_root(index) && is_resting_tree(islands.at_root(index));
  };
  for (std::uint32_t index = 0; index < batch.bodies.size(); ++index) {
    if (!is_tree(index)) continue;
    ++tree_count;
    nodes += islands.at_root(index).bodies;
  }
  if (tree_count == 0) return trees;
  trees.trees = arena.make<RestingTree>(tree_count);
  trees.nodes = arena.make<TreeNode>(nodes);
  trees.work = arena.make<TreeScratch>(nodes);
  const IncidentContacts links = link_incident_contacts(pairs, batch.bodies.size(), arena);
  const float gravity = length(w.settings.gravity);
  const auto body_at = [&](std::uint32_t index) { return std::int32_t(batch.bodies[index]); };
  std::uint32_t used = 0;
  std::size_t tree = 0;
  for (std::uint32_t root = 0; root < batch.bodies.size(); ++root) {
    if (!is_tree(root)) continue;
    const std::uint32_t first = islands.at_root(root).ground_contact;
    const ColoringPair& ground = pairs[first];
    const bool is_b = ground.b != ColoringPair::kNone;
    const std::uint32_t begin = used;
    trees.nodes[used++] = make_node(w, body_at(is_b ? ground.b : ground.a), -1, first, is_b, gravity);
    // Breadth first. There are no loops, so every other contact of a body leads to a child.
    for (std::uint32_t at = begin; at < used; ++at) {
      const std::uint32_t below = trees.nodes[at].constraint;
      const std::uint32_t index = trees.nodes[at].sign > 0.0f ? pairs[below].b : pairs[below].a;
      for (std::uint32_t link = links.first[index]; link != kNoIndex; link = links.next[link]) {
        const std::uint32_t i = link / 2;
        if (i == below) continue;
        const bool child_is_b = link % 2 == 0;
        const std::int32_t child = body_at(child_is_b ? pairs[i].b : pairs[i].a);
        trees.nodes[used++] = make_node(w, child, std::int32_t(at), i, child_is_b, gravity);
      }
    }
    for (std::uint32_t i = begin; i < used; ++i) constraints[trees.nodes[i].constraint].rigid = true;
    trees.trees[tree++] = {begin, used};
  }
  return trees;
}

void set_tree_positions(RestingTrees& trees, std::span<const std::uint32_t> positions, int width) {
  for (TreeNode& node : trees.nodes) {
    node.block = positions[node.constraint] / std::uint32_t(width);
    node.lane = positions[node.constraint] % std::uint32_t(width);
  }
}

}  // namespace gyre
