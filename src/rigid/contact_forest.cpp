#include "rigid/contact_forest.h"

#include "math/rotation.h"
#include "rigid/integrators.h"

namespace gyre {

namespace {

constexpr std::uint32_t kNone = 0xffffffffu;

bool is_active(const RigidWorld& w, std::int32_t body) { return body != kNoBody && is_active(w, std::uint32_t(body)); }

// A body that could be part of a resting tree.
bool is_quiet(const RigidWorld& w, std::uint32_t body, float pull) {
  const BodyFlags& flags = w.bodies.flags[body];
  const BodyMotion& motion = w.bodies.motion[body];
  const float reach = w.bodies.masses[body].reach;
  const float speed = length(motion.linear_velocity) + reach * length(motion.angular_velocity);
  if (turns_alone(w.bodies, body, w.settings.last_substep)) return false;
  return flags.locked_linear == 0 && flags.locked_angular == 0 && speed <= kTreeRestShare * std::sqrt(pull * reach);
}

// The other end of a constraint may be the fixed world or a kinematic body that stands still.
bool is_still(const RigidWorld& w, std::int32_t body) {
  if (body == kNoBody) return true;
  const BodyMotion& motion = w.bodies.motion[body];
  return motion.linear_velocity == Vec3{} && motion.angular_velocity == Vec3{};
}

bool is_patch(const ContactConstraint& c) {
  return c.point_count >= 3 && c.static_friction > 0.0f && c.surface_velocity == Vec3{};
}

// What is counted about an island, at its root in the union-find.
struct Tally {
  std::uint32_t bodies = 0, contacts = 0, grounded = 0;
  std::uint32_t refused = 0;
  std::uint32_t first = kNone;  // its contact with the fixed world
};

// The islands of one batch: union-find over bodies, by their places in it, and what each island has.
class IslandTally {
 public:
  IslandTally(std::size_t bodies, std::span<const std::uint32_t> places, Arena& arena)
      : places_(places), parent_(arena.make<std::uint32_t>(bodies)), tally_(arena.make<Tally>(bodies)) {
    for (std::uint32_t i = 0; i < bodies; ++i) parent_[i] = i, tally_[i] = {};
  }
  std::uint32_t root(std::uint32_t i) {
    while (parent_[i] != i) i = parent_[i] = parent_[parent_[i]];
    return i;
  }
  void unite(std::int32_t body_a, std::int32_t body_b) {
    const std::uint32_t a = root(places_[std::size_t(body_a)]);
    const std::uint32_t b = root(places_[std::size_t(body_b)]);
    if (a < b) {
      parent_[b] = a;
    } else {
      parent_[a] = b;
    }
  }
  Tally& of(std::uint32_t body) { return tally_[root(places_[body])]; }
  Tally& at_root(std::uint32_t root) { return tally_[root]; }

 private:
  std::span<const std::uint32_t> places_;
  std::span<std::uint32_t> parent_;
  std::span<Tally> tally_;
};

void unite_all(const RigidWorld& w, std::span<const ContactConstraint> constraints, std::span<const std::uint32_t> joints,
               IslandTally& islands) {
  for (const ContactConstraint& c : constraints) {
    if (is_active(w, c.body_a) && is_active(w, c.body_b)) islands.unite(c.body_a, c.body_b);
  }
  for (const std::uint32_t slot : joints) {
    const JointRecord& joint = w.joints.records[slot];
    if (is_active(w, joint.body_a) && is_active(w, joint.body_b)) {
      islands.unite(joint.body_a, joint.body_b);
    }
  }
}

void count_all(const RigidWorld& w, std::span<const ContactConstraint> constraints, const SolveBatch& batch,
               IslandTally& islands) {
  const float pull = length(w.settings.gravity);
  for (const std::uint32_t body : batch.bodies) {
    if (!is_movable(w.bodies.flags[body])) continue;
    Tally& tally = islands.of(body);
    ++tally.bodies;
    if (!is_quiet(w, body, pull)) ++tally.refused;
  }
  for (std::uint32_t i = 0; i < constraints.size(); ++i) {
    const ContactConstraint& c = constraints[i];
    const bool active_a = is_active(w, c.body_a), active_b = is_active(w, c.body_b);
    Tally& tally = islands.of(std::uint32_t(active_a ? c.body_a : c.body_b));
    ++tally.contacts;
    if (!is_patch(c)) ++tally.refused;
    if (active_a && active_b) continue;
    ++tally.grounded;
    tally.first = i;
    if (!is_still(w, active_a ? c.body_b : c.body_a)) ++tally.refused;
  }
  for (const std::uint32_t slot : batch.joints) {
    const JointRecord& joint = w.joints.records[slot];
    for (const std::int32_t body : {joint.body_a, joint.body_b}) {
      if (is_active(w, body)) ++islands.of(std::uint32_t(body)).refused;
    }
  }
}

bool hangs(const Tally& tally) {
  return tally.refused == 0 && tally.grounded == 1 && tally.contacts == tally.bodies && tally.bodies > 0;
}

// For each body that moves the constraints it is in, as linked lists: link 2 * constraint + side.
struct Links {
  std::span<std::uint32_t> first;  // by the body's place
  std::span<std::uint32_t> next;   // by link
};

Links link_constraints(const RigidWorld& w, std::span<const ContactConstraint> constraints, std::size_t bodies,
                       std::span<const std::uint32_t> places, Arena& arena) {
  Links links{arena.make<std::uint32_t>(bodies), arena.make<std::uint32_t>(2 * constraints.size())};
  for (std::uint32_t& f : links.first) f = kNone;
  for (std::uint32_t i = std::uint32_t(constraints.size()); i-- > 0;) {
    const std::int32_t ends[2] = {constraints[i].body_a, constraints[i].body_b};
    for (std::uint32_t side = 0; side < 2; ++side) {
      if (!is_active(w, ends[side])) continue;
      std::uint32_t& first = links.first[places[std::size_t(ends[side])]];
      links.next[2 * i + side] = first;
      first = 2 * i + side;
    }
  }
  return links;
}

TreeNode make_node(const RigidWorld& w, std::int32_t body, std::int32_t parent, std::uint32_t constraint, bool is_b) {
  const float pull = length(w.settings.gravity);
  const BodyMass& mass = w.bodies.masses[body];
  TreeNode node;
  node.body = body;
  node.parent = parent;
  node.constraint = constraint;
  node.sign = is_b ? 1.0f : -1.0f;
  node.mass = mass.mass;
  node.still = kTreeStillShare * std::sqrt(pull * mass.reach);
  node.still_spin = mass.reach > 0.0f ? node.still / mass.reach : 0.0f;
  node.center = w.bodies.places[body].center;
  node.inertia = rotate_inertia(w.bodies.places[body].orientation, mass.inertia);
  return node;
}

}  // namespace

ContactForest find_contact_trees(const RigidWorld& w, std::span<ContactConstraint> constraints, const SolveBatch& batch,
                                 std::span<const std::uint32_t> places, Arena& arena) {
  ContactForest forest;
  if (constraints.empty() || !(length(w.settings.gravity) > 0.0f)) return forest;
  IslandTally islands(batch.bodies.size(), places, arena);
  unite_all(w, constraints, batch.joints, islands);
  count_all(w, constraints, batch, islands);
  std::size_t trees = 0, nodes = 0;
  const auto is_tree = [&](std::uint32_t place) {
    return is_movable(w.bodies.flags[batch.bodies[place]]) && islands.root(place) == place && hangs(islands.at_root(place));
  };
  for (std::uint32_t place = 0; place < batch.bodies.size(); ++place) {
    if (!is_tree(place)) continue;
    ++trees;
    nodes += islands.at_root(place).bodies;
  }
  if (trees == 0) return forest;
  forest.trees = arena.make<ContactTree>(trees);
  forest.nodes = arena.make<TreeNode>(nodes);
  forest.work = arena.make<TreeWork>(nodes);
  const Links links = link_constraints(w, constraints, batch.bodies.size(), places, arena);
  std::uint32_t used = 0;
  std::size_t tree = 0;
  for (std::uint32_t root = 0; root < batch.bodies.size(); ++root) {
    if (!is_tree(root)) continue;
    const std::uint32_t first = islands.at_root(root).first;
    const ContactConstraint& ground = constraints[first];
    const bool is_b = is_active(w, ground.body_b);
    const std::uint32_t begin = used;
    forest.nodes[used++] = make_node(w, is_b ? ground.body_b : ground.body_a, -1, first, is_b);
    // Breadth first: every other contact of a body leads to a child, as there are no loops.
    for (std::uint32_t at = begin; at < used; ++at) {
      const TreeNode node = forest.nodes[at];
      for (std::uint32_t link = links.first[places[std::size_t(node.body)]]; link != kNone; link = links.next[link]) {
        const std::uint32_t i = link / 2;
        if (i == node.constraint) continue;
        const bool child_is_b = link % 2 == 0;
        const std::int32_t child = child_is_b ? constraints[i].body_b : constraints[i].body_a;
        forest.nodes[used++] = make_node(w, child, std::int32_t(at), i, child_is_b);
      }
    }
    for (std::uint32_t i = begin; i < used; ++i) constraints[forest.nodes[i].constraint].rigid = true;
    forest.trees[tree++] = {begin, used};
  }
  return forest;
}

void place_tree_nodes(ContactForest& forest, std::span<const std::uint32_t> order, int width, std::size_t constraints,
                      Arena& arena) {
  if (forest.nodes.empty()) return;
  const std::span<std::uint32_t> place = arena.make<std::uint32_t>(constraints);
  for (std::uint32_t i = 0; i < order.size(); ++i) {
    if (order[i] != kNone) place[order[i]] = i;
  }
  for (TreeNode& node : forest.nodes) {
    node.block = place[node.constraint] / std::uint32_t(width);
    node.lane = place[node.constraint] % std::uint32_t(width);
  }
}

}  // namespace gyre
