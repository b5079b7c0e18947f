#include "rigid/rest/resting_trees.h"

namespace gyre {

namespace {

bool hangs(const IslandCount& count) {
  return !count.refused && !count.balances && count.grounded == 1 && count.contacts == count.bodies &&
         count.bodies > 0;
}

TreeNode make_node(const RigidWorld& w, std::int32_t body, std::int32_t parent, std::uint32_t constraint,
                   bool is_b, float geometric_stiffness) {
  const BodyMass& mass = w.bodies.masses[body];
  TreeNode node;
  node.body = body;
  node.parent = parent;
  node.constraint = constraint;
  node.sign = is_b ? 1.0f : -1.0f;
  node.mass = mass.mass;
  node.rest_speed = kStillSpeedShare * std::sqrt(geometric_stiffness * mass.reach);
  node.rest_spin = mass.reach > 0.0f ? node.rest_speed / mass.reach : 0.0f;
  node.center = w.bodies.places[body].center;
  node.orientation = w.bodies.places[body].orientation;
  node.inertia = mass.inertia;
  return node;
}

}  // namespace

RestingTrees find_contact_trees(const RigidWorld& w, std::span<ContactConstraint> constraints,
                                std::span<const ColoringPair> pairs, const SolveBatch& batch,
                                const RestingIslands& islands, Arena& arena) {
  RestingTrees forest;
  std::size_t trees = 0, nodes = 0;
  const auto is_tree = [&](std::uint32_t place) {
    return islands.is_root(place) && hangs(islands.at_root(place));
  };
  for (std::uint32_t place = 0; place < batch.bodies.size(); ++place) {
    if (!is_tree(place)) continue;
    ++trees;
    nodes += islands.at_root(place).bodies;
  }
  if (trees == 0) return forest;
  forest.trees = arena.make<RestingTree>(trees);
  forest.nodes = arena.make<TreeNode>(nodes);
  forest.work = arena.make<TreeScratch>(nodes);
  const IncidentContacts links = link_incident_contacts(pairs, batch.bodies.size(), arena);
  const float geometric_stiffness = length(w.settings.gravity);
  const auto body_at = [&](std::uint32_t place) { return std::int32_t(batch.bodies[place]); };
  std::uint32_t used = 0;
  std::size_t tree = 0;
  for (std::uint32_t root = 0; root < batch.bodies.size(); ++root) {
    if (!is_tree(root)) continue;
    const std::uint32_t first = islands.at_root(root).first;
    const ColoringPair& ground = pairs[first];
    const bool is_b = ground.b != ColoringPair::kNone;
    const std::uint32_t begin = used;
    forest.nodes[used++] =
        make_node(w, body_at(is_b ? ground.b : ground.a), -1, first, is_b, geometric_stiffness);
    // Breadth first: every other contact of a body leads to a child, as there are no loops.
    for (std::uint32_t at = begin; at < used; ++at) {
      const std::uint32_t below = forest.nodes[at].constraint;
      const std::uint32_t place = forest.nodes[at].sign > 0.0f ? pairs[below].b : pairs[below].a;
      for (std::uint32_t link = links.first[place]; link != kNoPlace; link = links.next[link]) {
        const std::uint32_t i = link / 2;
        if (i == below) continue;
        const bool child_is_b = link % 2 == 0;
        const std::int32_t child = body_at(child_is_b ? pairs[i].b : pairs[i].a);
        forest.nodes[used++] = make_node(w, child, std::int32_t(at), i, child_is_b, geometric_stiffness);
      }
    }
    for (std::uint32_t i = begin; i < used; ++i) constraints[forest.nodes[i].constraint].rigid = true;
    forest.trees[tree++] = {begin, used};
  }
  return forest;
}

void place_tree_nodes(RestingTrees& forest, std::span<const std::uint32_t> places, int width) {
  for (TreeNode& node : forest.nodes) {
    node.block = places[node.constraint] / std::uint32_t(width);
    node.lane = places[node.constraint] % std::uint32_t(width);
  }
}

}  // namespace gyre
