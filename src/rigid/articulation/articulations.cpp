#include "rigid/articulation/articulations.h"

#include "base/container/disjoint_sets.h"
#include "base/prefetch.h"
#include "solver/articulation/articulation_drives.h"
#include "solver/articulation/articulation_limits.h"

#include <algorithm>

namespace gyre {

namespace {

// Largest number of multiplications of a factorisation, per row, for a direct solution.
constexpr std::uint64_t kMaxWorkPerRow = 400;
// Largest number of pairs of joints that share a body, per joint, for a direct solution.
constexpr std::uint64_t kMaxPairsPerJoint = 8;
// Number of topologies that an articulation is compared with. A topology found twice costs time, never bits.
constexpr std::size_t kTopologiesCompared = 16;

// The joints of a batch that have equations, as a graph of its bodies.
struct Graph {
  std::span<std::uint32_t> joints;   // indices in the batch's list
  std::span<std::uint32_t> first;    // by body index: begin of its part of `at_body`; one more at the end
  std::span<std::uint32_t> at_body;  // indices in `joints`, body by body
  DisjointSets bodies;               // by body index
};

Graph make_graph(std::span<const JointEdge> all, std::size_t bodies,
                 std::span<const std::uint32_t> body_indices, Arena& arena) {
  Graph graph;
  const std::span<std::uint32_t> joints = arena.make<std::uint32_t>(all.size());
  graph.first = arena.make<std::uint32_t>(bodies + 1);
  graph.bodies = DisjointSets(arena.make<std::uint32_t>(bodies));
  for (std::uint32_t& first : graph.first) first = 0;
  std::size_t count = 0, ends = 0;
  for (std::uint32_t i = 0; i < all.size(); ++i) {
    if (all[i].equations == 0) continue;
    joints[count++] = i;
    std::uint32_t previous = kNoIndex;
    for_moving(all[i], [&](std::uint32_t body) {
      ++graph.first[body_indices[body] + 1];
      ++ends;
      if (previous != kNoIndex) graph.bodies.unite(previous, body_indices[body]);
      previous = body_indices[body];
    });
  }
  graph.joints = joints.first(count);
  for (std::size_t i = 1; i < graph.first.size(); ++i) graph.first[i] += graph.first[i - 1];
  graph.at_body = arena.make<std::uint32_t>(ends);
  const ArenaScope scope(arena);
  const std::span<std::uint32_t> used = arena.make<std::uint32_t>(bodies);
  for (std::uint32_t& n : used) n = 0;
  for (std::uint32_t n = 0; n < graph.joints.size(); ++n) {
    for_moving(all[graph.joints[n]], [&](std::uint32_t body) {
      const std::uint32_t index = body_indices[body];
      graph.at_body[graph.first[index] + used[index]++] = n;
    });
  }
  return graph;
}

// The joints sorted by articulation, in the order of the lowest joint of each; joints of one keep their
// order.
struct Groups {
  std::span<std::uint32_t> members;  // indices in graph.joints
  std::span<std::uint32_t> ends;
  std::span<std::uint32_t> local;  // by index in graph.joints: position in its group
};
Groups group_joints(std::span<const JointEdge> all, std::span<const std::uint32_t> body_indices,
                    const Graph& graph, Arena& arena) {
  Groups groups{arena.make<std::uint32_t>(graph.joints.size()),
                arena.make<std::uint32_t>(graph.joints.size()),
                arena.make<std::uint32_t>(graph.joints.size())};
  const std::span<std::uint32_t> group_of_root = arena.make<std::uint32_t>(graph.bodies.parents.size());
  const std::span<std::uint32_t> group_of = arena.make<std::uint32_t>(graph.joints.size());
  for (std::uint32_t& group : group_of_root) group = kNoIndex;
  std::uint32_t count = 0;
  for (std::uint32_t n = 0; n < graph.joints.size(); ++n) {
    std::uint32_t index = kNoIndex;
    for_moving(all[graph.joints[n]], [&](std::uint32_t body) { index = body_indices[body]; });
    std::uint32_t& group = group_of_root[graph.bodies.of(index)];
    if (group == kNoIndex) {
      group = count;
      groups.ends[count++] = 0;
    }
    group_of[n] = group;
    groups.local[n] = groups.ends[group]++;
  }
  groups.ends = groups.ends.first(count);
  for (std::uint32_t group = 1; group < count; ++group) groups.ends[group] += groups.ends[group - 1];
  for (std::uint32_t n = 0; n < graph.joints.size(); ++n) {
    const std::uint32_t begin = group_of[n] == 0 ? 0 : groups.ends[group_of[n] - 1];
    groups.members[begin + groups.local[n]] = n;
  }
  return groups;
}

class ArticulationBuilder {
 public:
  ArticulationBuilder(const RigidWorld& w, const SolveBatch& batch,
                      std::span<const std::uint32_t> body_indices, std::span<const JointEdge> joints,
                      std::span<const std::uint8_t> pressed, const LaneStart& start, const Graph& graph,
                      std::span<const std::uint32_t> local, std::size_t max_topologies,
                      DenseGraphCache& dense, Arena& arena)
      : w_(w),
        batch_(batch),
        body_indices_(body_indices),
        joints_(joints),
        pressed_(pressed),
        start_(start),
        graph_(graph),
        local_(local),
        dense_(dense),
        arena_(arena),
        topologies_(arena.make<ArticulationTopology>(max_topologies)),
        sides_(arena.make<std::uint32_t>(batch.bodies.size())) {
    for (std::uint32_t& side : sides_) side = kNoIndex;
  }

  // Builds `scalar`, or `in_lanes` if its joints fit in lanes. False if neither is possible.
  bool make(std::span<const std::uint32_t> members, Articulation& scalar, GroupedArticulation& in_lanes) {
    const auto joint_at = [&](std::size_t i) -> const JointEdge& { return joint_edge(members[i]); };
    if (dense_.contains(members.size(), joint_at)) return false;
    const std::size_t pairs = count_pairs(members);
    if (pairs > kMaxPairsPerJoint * members.size()) return false;
    const Draft draft = make_draft(members);
    ArticulationTopology topology;
    const bool fits = describe(draft, topology);
    if (fits) in_lanes.joints = draft.joints;
    if (fits && find_topology(topology, in_lanes)) return true;
    const std::span<ArticulationCoupling> couplings = arena_.make<ArticulationCoupling>(pairs);
    const std::span<BlockEdge> edges = arena_.make<BlockEdge>(pairs);
    list_pairs(members, draft, couplings, edges);
    const std::span<std::uint8_t> sizes = arena_.make<std::uint8_t>(members.size());
    std::uint64_t rows = 0;
    for (std::size_t i = 0; i < members.size(); ++i) {
      sizes[i] = std::uint8_t(joint_at(i).equations);
      rows += sizes[i];
    }
    BlockPlan plan;
    if (!plan_blocks(sizes, edges, kMaxWorkPerRow * rows, arena_, plan)) {
      dense_.add(members.size(), joint_at);
      return false;
    }
    for (std::size_t i = 0; i < pairs; ++i) {
      const BlockLocation block = find_block(plan, edges[i].a, edges[i].b);
      ArticulationCoupling& c = couplings[i];
      c.offset = block.offset;
      if (block.first_is_row) continue;
      c = {c.column, c.row, c.offset, c.body, c.column_has_b, c.row_has_b};
    }
    if (fits) {
      in_lanes.topology = add_topology(topology, plan, couplings);
    } else {
      finish(scalar, draft, plan, couplings);
    }
    return true;
  }

  std::span<ArticulationTopology> topologies() const { return topologies_.first(topology_count_); }

 private:
  const JointEdge& joint_edge(std::uint32_t number) const { return joints_[graph_.joints[number]]; }
  std::span<const std::uint32_t> at_body(std::uint32_t body) const {
    const std::uint32_t index = body_indices_[body];
    return graph_.at_body.subspan(graph_.first[index], graph_.first[index + 1] - graph_.first[index]);
  }
  bool is_pressed(std::int32_t body) const {
    return !pressed_.empty() && body != kNoBody && is_active(w_, std::uint32_t(body)) &&
           pressed_[body_indices_[std::size_t(body)]] != 0;
  }
  bool presses_held(std::int32_t body) const {
    return is_pressed(body) && pressed_[body_indices_[std::size_t(body)]] == kPressesHeld;
  }
  std::size_t count_pairs(std::span<const std::uint32_t> members) const {
    std::size_t twice = 0;
    for (const std::uint32_t n : members) {
      for_moving(joint_edge(n), [&](std::uint32_t body) { twice += at_body(body).size() - 1; });
    }
    return twice / 2;
  }
  // The joints of an articulation and its movable bodies, each once, in the order of the joints.
  struct Draft {
    std::span<ArticulationJoint> joints;
    std::span<std::int32_t> side_a, side_b;  // by joint: index in `bodies`; -1: not movable
    std::span<std::int32_t> bodies;
  };
  Draft make_draft(std::span<const std::uint32_t> members) {
    const std::size_t count = members.size();
    Draft draft{arena_.make<ArticulationJoint>(count), arena_.make<std::int32_t>(count),
                arena_.make<std::int32_t>(count), arena_.make<std::int32_t>(2 * count)};
    std::size_t used = 0;
    const auto side_of = [&](std::int32_t body) -> std::int32_t {
      if (body == kNoBody || !is_active(w_, std::uint32_t(body))) return -1;
      std::uint32_t& side = sides_[body_indices_[std::size_t(body)]];
      if (side == kNoIndex) {
        side = std::uint32_t(used);
        draft.bodies[used++] = body;
      }
      return std::int32_t(side);
    };
    for (std::size_t i = 0; i < count; ++i) {
      const std::uint32_t index = graph_.joints[members[i]];
      const std::uint32_t slot = batch_.joints[index];
      const JointRecord& joint = w_.joints.records[slot];
      // describe() reads it.
      if (const JointDetail* const detail = detail_of(w_.joints, slot))
        prefetch(detail, offsetof(JointDetail, row_impulses));
      draft.joints[i] = {slot,
                         index,
                         joint.body_a,
                         joint.body_b,
                         is_pressed(joint.body_a),
                         is_pressed(joint.body_b),
                         presses_held(joint.body_a) || presses_held(joint.body_b)};
      draft.side_a[i] = side_of(joint.body_a);
      draft.side_b[i] = side_of(joint.body_b);
    }
    draft.bodies = draft.bodies.first(used);
    return draft;
  }
  void finish(Articulation& articulation, const Draft& draft, const BlockPlan& plan,
              std::span<const ArticulationCoupling> couplings) const {
    articulation.nodes = arena_.make<ArticulationNode>(draft.joints.size());
    for (std::size_t i = 0; i < draft.joints.size(); ++i) {
      const ArticulationJoint& joint = draft.joints[i];
      ArticulationNode& node = articulation.nodes[i] = ArticulationNode{};
      node.record = joint.record, node.work = joint.index;
      node.body_a = joint.body_a, node.body_b = joint.body_b;
      node.side_a = draft.side_a[i], node.side_b = draft.side_b[i];
      node.count = joints_[joint.index].equations;
      articulation.presses_held = articulation.presses_held || joint.presses_held;
    }
    articulation.bodies = arena_.make<ArticulationBody>(draft.bodies.size());
    for (std::size_t i = 0; i < draft.bodies.size(); ++i) {
      articulation.bodies[i] = ArticulationBody{};
      articulation.bodies[i].body = draft.bodies[i];
      articulation.bodies[i].is_pressed = is_pressed(draft.bodies[i]);
    }
    articulation.couplings = couplings;
    articulation.plan = plan;
    articulation.values = arena_.make<double>(plan.values);
    articulation.room = arena_.make<double>(factor_room(plan));
    articulation.vector = arena_.make<double>(plan.rows);
  }
  // Lists every pair of joints that share a movable body, once for each such body.
  void list_pairs(std::span<const std::uint32_t> members, const Draft& draft,
                  std::span<ArticulationCoupling> couplings, std::span<BlockEdge> edges) const {
    std::size_t used = 0;
    for (std::uint32_t i = 0; i < members.size(); ++i) {
      for_moving(joint_edge(members[i]), [&](std::uint32_t body) {
        for (const std::uint32_t n : at_body(body)) {
          const std::uint32_t other = local_[n];
          if (other >= i) break;  // in ascending order
          edges[used] = {i, other};
          couplings[used++] = {i,
                               other,
                               0,
                               std::int32_t(body),
                               draft.joints[i].body_b == std::int32_t(body),
                               draft.joints[other].body_b == std::int32_t(body)};
        }
      });
    }
  }

  // Describes the articulation for lanes; false if it does not fit. Immovable bodies come last, one for each
  // end of a joint.
  bool describe(const Draft& draft, ArticulationTopology& topology) {
    std::size_t limits = 0, servos = 0;
    topology.nodes = arena_.make<LaneNode>(draft.joints.size());
    topology.body_count = topology.moving_count = std::uint32_t(draft.bodies.size());
    for (std::size_t i = 0; i < draft.joints.size(); ++i) {
      const ArticulationJoint& joint = draft.joints[i];
      LaneNode& lane = topology.nodes[i] = LaneNode{};
      if (!fits_lane(w_.joints.records[joint.record], detail_of(w_.joints, joint.record), start_, lane))
        return false;
      limits += (lane.has_twist ? 1 : 0) + (lane.has_swing ? 1 : 0);
      servos += lane.has_servo ? 1 : 0;
      if (limits > kMaxLaneLimits) return false;
      lane.rows = std::uint32_t(joints_[joint.index].equations);
      lane.a = draft.side_a[i] < 0 ? topology.body_count++ : std::uint32_t(draft.side_a[i]);
      lane.b = draft.side_b[i] < 0 ? topology.body_count++ : std::uint32_t(draft.side_b[i]);
    }
    if (servos > kMaxLaneServos || limits + servos > kMaxLaneLimits) iterate_servos(topology);
    std::uint32_t driven = 0, servo_count = 0;
    for (LaneNode& lane : topology.nodes) {
      if (lane.is_driven()) lane.drives = driven++;
      if (lane.has_servo) lane.servo = servo_count++;
    }
    return true;
  }
  static void iterate_servos(ArticulationTopology& topology) {
    for (LaneNode& lane : topology.nodes) {
      lane.has_drive = lane.has_drive || lane.has_servo;
      lane.has_servo = false;
    }
  }
  bool find_topology(const ArticulationTopology& topology, GroupedArticulation& articulation) const {
    const auto same = [](const LaneNode& a, const LaneNode& b) {
      return a.kind == b.kind && a.has_twist == b.has_twist && a.has_swing == b.has_swing &&
             a.has_drive == b.has_drive && a.has_friction == b.has_friction && a.has_servo == b.has_servo &&
             a.a == b.a && a.b == b.b;
    };
    const std::size_t oldest =
        topology_count_ > kTopologiesCompared ? topology_count_ - kTopologiesCompared : 0;
    for (std::size_t i = topology_count_; i-- > oldest;) {
      const ArticulationTopology& other = topologies_[i];
      if (other.moving_count != topology.moving_count || other.nodes.size() != topology.nodes.size())
        continue;
      if (!std::equal(topology.nodes.begin(), topology.nodes.end(), other.nodes.begin(), same)) continue;
      articulation.topology = std::uint32_t(i);
      return true;
    }
    return false;
  }
  // Returns its index.
  std::uint32_t add_topology(ArticulationTopology& topology, const BlockPlan& plan,
                             std::span<const ArticulationCoupling> couplings) {
    topology.plan = plan;
    for (std::size_t i = 0; i < topology.nodes.size(); ++i) {
      const BlockColumn& column = plan.columns[plan.index_of[i]];
      topology.nodes[i].row = column.row;
      topology.nodes[i].column = plan.index_of[i];
      topology.nodes[i].diagonal = column.diagonal;
    }
    topology.couplings = arena_.make<LaneCoupling>(couplings.size());
    for (std::size_t i = 0; i < couplings.size(); ++i) {
      const ArticulationCoupling& c = couplings[i];
      const LaneNode& row = topology.nodes[c.row];
      topology.couplings[i] = {c.row,       c.column,       c.offset, c.row_has_b ? row.b : row.a,
                               c.row_has_b, c.column_has_b, false};
    }
    mark_first(topology);
    if (topology.body_count <= topology.moving_count + 1) find_traversal(topology);
    topologies_[topology_count_] = topology;
    return std::uint32_t(topology_count_++);
  }

  // Visits joint after joint, forwards and backwards, until all bodies are reached.
  void find_traversal(ArticulationTopology& topology) const {
    topology.traversal = arena_.make<TraversalStep>(topology.body_count - 1);
    const std::span<std::uint8_t> is_reached = arena_.make<std::uint8_t>(topology.body_count);
    for (std::uint8_t& reached : is_reached) reached = 0;
    is_reached[0] = 1;
    const std::size_t count = topology.nodes.size();
    std::size_t used = 0;
    for (std::size_t pass = 0; used < topology.traversal.size(); ++pass) {
      for (std::size_t i = 0; i < count; ++i) {
        const std::size_t n = pass % 2 == 0 ? i : count - 1 - i;
        const LaneNode& node = topology.nodes[n];
        if (is_reached[node.a] == is_reached[node.b]) continue;
        topology.traversal[used++] = {std::uint32_t(n), is_reached[node.a] != 0};
        is_reached[node.a] = is_reached[node.b] = 1;
      }
    }
  }

  // Marks the first coupling of each block, and finds whether all blocks below the diagonal have one.
  void mark_first(ArticulationTopology& topology) {
    const ArenaScope scope(arena_);
    const std::span<std::uint8_t> is_begun = arena_.make<std::uint8_t>(topology.plan.values);
    for (std::uint8_t& begun : is_begun) begun = 0;
    std::size_t blocks = 0;
    for (LaneCoupling& coupling : topology.couplings) {
      coupling.is_first = is_begun[coupling.offset] == 0;
      is_begun[coupling.offset] = 1;
      blocks += coupling.is_first ? 1 : 0;
    }
    topology.has_fill = blocks < topology.plan.entries.size();
  }

  const RigidWorld& w_;
  const SolveBatch& batch_;
  std::span<const std::uint32_t> body_indices_;
  std::span<const JointEdge> joints_;
  std::span<const std::uint8_t> pressed_;
  LaneStart start_;
  const Graph& graph_;
  std::span<const std::uint32_t> local_;
  DenseGraphCache& dense_;
  Arena& arena_;
  std::span<ArticulationTopology> topologies_;
  std::size_t topology_count_ = 0;
  std::span<std::uint32_t> sides_;  // by body index: index in the bodies of its articulation
};

}  // namespace

bool DenseGraphCache::contains(std::size_t size, FunctionRef<const JointEdge&(std::size_t)> joint_at) const {
  for (const JointGraph& graph : graphs_) {
    if (graph.size != size) continue;
    std::size_t same = 0;
    while (same < size && joints_[graph.first + same] == joint_at(same)) ++same;
    if (same == size) return true;
  }
  return false;
}
bool DenseGraphCache::contains(std::span<const JointEdge> joints) const {
  return contains(joints.size(), [&](std::size_t i) -> const JointEdge& { return joints[i]; });
}

void DenseGraphCache::add(std::size_t size, FunctionRef<const JointEdge&(std::size_t)> joint_at) {
  if (graphs_.size() == kMaxGraphs) graphs_.clear(), joints_.clear();
  graphs_.push_back({joints_.size(), size});
  for (std::size_t i = 0; i < size; ++i) joints_.push_back(joint_at(i));
}
void DenseGraphCache::add(std::span<const JointEdge> joints) {
  add(joints.size(), [&](std::size_t i) -> const JointEdge& { return joints[i]; });
}

Articulations no_articulations(std::size_t joints, Arena& arena) {
  const std::span<std::uint8_t> iterative = arena.make<std::uint8_t>(joints);
  for (std::uint8_t& flag : iterative) flag = 1;
  return {{}, {}, {}, iterative, {}};
}

Articulations find_articulations(const RigidWorld& w, const SolveBatch& batch,
                                 std::span<const std::uint32_t> body_indices,
                                 std::span<const JointEdge> joints, std::span<const std::uint8_t> pressed,
                                 const LaneStart& start, DenseGraphCache& dense, Arena& arena) {
  if (joints.empty()) return {};
  const Graph graph = make_graph(joints, batch.bodies.size(), body_indices, arena);
  const Groups groups = group_joints(joints, body_indices, graph, arena);
  const std::size_t group_count = groups.ends.size();
  const std::span<Articulation> scalar = arena.make<Articulation>(group_count);
  const std::span<GroupedArticulation> grouped = arena.make<GroupedArticulation>(group_count);
  const std::span<std::uint8_t> iterative = arena.make<std::uint8_t>(joints.size());
  const std::span<std::uint8_t> in_lanes = arena.make<std::uint8_t>(joints.size());
  for (std::uint8_t& flag : iterative) flag = 1;
  for (std::uint8_t& flag : in_lanes) flag = 0;
  ArticulationBuilder builder(w, batch, body_indices, joints, pressed, start, graph, groups.local,
                              group_count, dense, arena);
  std::size_t scalar_count = 0, grouped_count = 0;
  for (std::size_t group = 0; group < group_count; ++group) {
    const std::uint32_t begin = group == 0 ? 0 : groups.ends[group - 1];
    const std::span<const std::uint32_t> members = groups.members.subspan(begin, groups.ends[group] - begin);
    Articulation articulation;
    GroupedArticulation lanes;
    if (!builder.make(members, articulation, lanes)) continue;
    for (const std::uint32_t member : members) iterative[graph.joints[member]] = 0;
    if (lanes.joints.empty()) {
      scalar[scalar_count++] = articulation;
      continue;
    }
    for (const ArticulationJoint& joint : lanes.joints) in_lanes[joint.index] = 1;
    grouped[grouped_count++] = lanes;
  }
  const bool is_dense = group_count > 0 && scalar_count == 0 && grouped_count == 0;
  if (is_dense && !dense.contains(joints)) dense.add(joints);
  return {scalar.first(scalar_count), grouped.first(grouped_count), builder.topologies(), iterative,
          in_lanes};
}

void attach_drives(const Articulations& articulations, std::span<JointConstraint> work, Arena& arena) {
  for (Articulation& articulation : articulations.scalar) {
    std::size_t count = 0;
    for (const ArticulationNode& node : articulation.nodes)
      for (const AxisConstraint& axis : work[node.work].axes) count += is_driven_axis(axis) ? 1 : 0;
    if (count == 0) continue;
    articulation.axes = arena.make<DrivenAxis>(min(count, kMaxDrivenAxes));
    articulation.axis_room = arena.make<double>(drives_room(articulation, articulation.axes.size()));
    count = 0;
    for (std::uint32_t n = 0; n < articulation.nodes.size(); ++n)
      for (AxisConstraint& axis : work[articulation.nodes[n].work].axes) {
        if (!is_driven_axis(axis) || count == articulation.axes.size()) continue;
        axis.in_articulation = true;
        articulation.axes[count++] = {n, &axis};
      }
  }
}

std::span<std::span<double>> find_limits(const Articulations& articulations,
                                         std::span<const JointConstraint> work, std::size_t workers,
                                         Arena& arena) {
  std::size_t room_size = 0;
  for (Articulation& articulation : articulations.scalar) {
    for (const ArticulationNode& node : articulation.nodes)
      for (const AxisConstraint& axis : work[node.work].axes)
        articulation.has_limits = articulation.has_limits || has_hard_limit(axis);
    if (articulation.has_limits)
      room_size = max(room_size, limits_room(articulation.plan.rows, articulation.bodies.size()));
  }
  if (room_size == 0) return {};
  const std::span<std::span<double>> rooms = arena.make<std::span<double>>(workers);
  for (std::span<double>& room : rooms) room = arena.make<double>(room_size);
  return rooms;
}

}  // namespace gyre
