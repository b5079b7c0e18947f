#include "rigid/articulation/articulation_bundles.h"

#include <algorithm>

namespace gyre {

namespace {

// Many lanes of long articulations leave the cache: these are bundled only if half of the lanes are used.
constexpr std::size_t kLongArticulation = 64;

// Number of the `left` articulations of a topology that the next bundle takes.
std::size_t lanes_of(std::size_t left, const ArticulationTopology& topology, std::size_t width) {
  const std::size_t fewest = topology.nodes.size() > kLongArticulation ? (width + 1) / 2 : 2;
  return left < fewest ? 1 : std::min(left, width);
}

ArticulationBundle make_bundle(const ArticulationTopology& topology, const ArticulationKernels& kernels,
                               Arena& arena) {
  ArticulationBundle b;
  b.kernels = &kernels;
  b.nodes = topology.nodes.data();
  b.couplings = topology.couplings.data();
  b.traversal = topology.traversal.data();
  b.node_count = std::uint32_t(topology.nodes.size());
  b.coupling_count = std::uint32_t(topology.couplings.size());
  b.body_count = topology.body_count;
  b.moving_count = topology.moving_count;
  b.columns = topology.plan.columns.data();
  b.entries = topology.plan.entries.data();
  b.targets = topology.plan.targets.data();
  b.column_count = std::uint32_t(topology.plan.columns.size());
  b.value_count = topology.plan.values;
  b.row_count = topology.plan.rows;
  b.has_fill = topology.has_fill;
  for (const LaneNode& node : topology.nodes) {
    b.limit_count += (node.has_twist ? 1 : 0) + (node.has_swing ? 1 : 0) + (node.has_servo ? 1 : 0);
    b.drive_count += node.is_driven() ? 1 : 0;
    b.servo_count += node.has_servo ? 1 : 0;
    b.has_drives = b.has_drives || node.has_drive || node.has_servo;
  }
  const std::size_t width = std::size_t(kernels.width);
  b.bodies = arena.make<std::byte>(b.body_count * kernels.body_bytes).data();
  b.joints = arena.make<std::byte>(b.node_count * kernels.joint_bytes).data();
  b.drives = arena.make<std::byte>(b.drive_count * kernels.drives_bytes).data();
  b.servos = arena.make<std::byte>(b.servo_count * kernels.servo_bytes).data();
  b.values = arena.make<float>(b.value_count * width).data();
  b.vector = arena.make<float>(b.row_count * width).data();
  b.room = arena.make<float>(topology.plan.widest * width).data();
  b.energy_gain = arena.make<float>(2 * width).data();
  b.has_extreme_mass_ratio = arena.make<float>(width).data();
  b.is_factored = arena.make<bool>(1).data();
  b.limits = arena.make<std::byte>(kernels.limit_room(b)).data();
  return b;
}

// The mobility (1/kg) of a body at a joint, averaged over all directions.
float mobility(const BodyMass& mass, Vec3 arm) {
  const Sym3& i = mass.inverse_inertia;
  const float angular = (i.xx + i.yy + i.zz) * length_squared(arm) - dot(arm, i * arm);
  return mass.inverse_mass + (1.0f / 3.0f) * angular;
}
// True if a joint couples bodies whose effective masses differ by more than 50, one of them with another
// joint too. Such links may get any speed from a solve, since their second-order bias is not resolved.
bool has_extreme_mass_ratio(const RigidWorld& w, const JointRecord& joint) {
  constexpr float kLighter = 3.0f, kMoreMobile = 50.0f;  // ratios of mass, and of inverse effective mass
  if (joint.body_a == kNoBody || joint.body_b == kNoBody) return false;
  const auto is_light = [&](std::int32_t body, Vec3 arm, std::int32_t other, Vec3 other_arm) {
    const BodyMass &own = w.bodies.masses[std::size_t(body)], &others = w.bodies.masses[std::size_t(other)];
    return others.inverse_mass > 0.0f && own.inverse_mass > kLighter * others.inverse_mass &&
           joints_of(w.bodies, std::uint32_t(body)).size() > 1 &&
           mobility(own, arm) > kMoreMobile * mobility(others, other_arm);
  };
  return is_light(joint.body_a, joint.local_anchor_a, joint.body_b, joint.local_anchor_b) ||
         is_light(joint.body_b, joint.local_anchor_b, joint.body_a, joint.local_anchor_a);
}

void mark_pressing_lanes(BundledArticulations& bundle) {
  for (std::size_t lane = 0; lane < bundle.articulations.size(); ++lane)
    for (const ArticulationJoint& joint : bundle.articulations[lane]->joints)
      if (joint.presses_held) bundle.lanes.presses_held |= 1u << lane;
}

}  // namespace

BundleSolve lay_out_bundles(const Articulations& articulations, const SolverKernels& kernels,
                            const LaneArrays& arrays, const LaneSettings& settings, Arena& arena) {
  BundleSolve result{{}, arrays, settings};
  const std::size_t count = articulations.grouped.size();
  if (count == 0) return result;
  // The articulations are sorted by topology, and then by their first joints.
  const std::span<const GroupedArticulation*> sorted = arena.make<const GroupedArticulation*>(count);
  const std::span<std::size_t> ends = arena.make<std::size_t>(articulations.topologies.size() + 1);
  for (std::size_t& end : ends) end = 0;
  for (const GroupedArticulation& articulation : articulations.grouped) ++ends[articulation.topology + 1];
  for (std::size_t i = 1; i < ends.size(); ++i) ends[i] += ends[i - 1];
  for (const GroupedArticulation& articulation : articulations.grouped)
    sorted[ends[articulation.topology]++] = &articulation;
  result.bundles = arena.make<BundledArticulations>(count);
  const ArticulationKernels& wide = kernels.articulations;
  const ArticulationKernels& narrow = narrower_kernels(kernels).articulations;
  const ArticulationKernels& single = select_kernels(1).articulations;
  const auto kernels_of = [&](std::size_t lanes) -> const ArticulationKernels& {
    return lanes == 1 ? single : lanes <= std::size_t(narrow.width) ? narrow : wide;
  };
  std::size_t used = 0, first = 0;
  for (std::size_t topology = 0; topology < articulations.topologies.size(); ++topology) {
    while (first < ends[topology]) {
      const std::size_t lanes =
          lanes_of(ends[topology] - first, articulations.topologies[topology], std::size_t(wide.width));
      result.bundles[used++] = {make_bundle(articulations.topologies[topology], kernels_of(lanes), arena),
                                sorted.subspan(first, lanes)};
      mark_pressing_lanes(result.bundles[used - 1]);
      first += lanes;
    }
  }
  result.bundles = result.bundles.first(used);
  return result;
}

void begin_bundles(const BundleSolve& bundles, int begin, int end, const RigidWorld& w,
                   const LaneStart& start) {
  for (int i = begin; i < end; ++i) {
    const BundledArticulations& bundle = bundles.bundles[std::size_t(i)];
    if (int(bundle.articulations.size()) < bundle.lanes.kernels->width) clear_lanes(bundle.lanes);
    bundle.lanes.kernels->begin(bundle.lanes);
    for (int lane = 0; lane < bundle.lanes.kernels->width; ++lane)
      bundle.lanes.has_extreme_mass_ratio[lane] = 0.0f;
    // Lanes are filled joint by joint, because the lanes of a joint share cache lines.
    for (std::uint32_t n = 0; n < bundle.lanes.node_count; ++n) {
      const LaneNode& node = bundle.lanes.nodes[n];
      for (std::size_t lane = 0; lane < bundle.articulations.size(); ++lane) {
        const ArticulationJoint& joint_of_lane = bundle.articulations[lane]->joints[n];
        const JointRecord& joint = w.joints.records[joint_of_lane.record];
        if (has_extreme_mass_ratio(w, joint)) bundle.lanes.has_extreme_mass_ratio[lane] = 1.0f;
        set_lane_body(bundle.lanes, int(lane), node.a, joint_of_lane.body_a, joint_of_lane.pressed_a);
        set_lane_body(bundle.lanes, int(lane), node.b, joint_of_lane.body_b, joint_of_lane.pressed_b);
        load_lane(bundle.lanes, int(lane), n, joint, detail_of(w.joints, joint_of_lane.record),
                  joint_offset(w, joint), start);
      }
    }
  }
}

void finish_bundles(const BundleSolve& bundles, int begin, int end, RigidWorld& w) {
  for (int i = begin; i < end; ++i) {
    const BundledArticulations& bundle = bundles.bundles[std::size_t(i)];
    for (std::uint32_t n = 0; n < bundle.lanes.node_count; ++n) {
      for (std::size_t lane = 0; lane < bundle.articulations.size(); ++lane) {
        const std::uint32_t slot = bundle.articulations[lane]->joints[n].record;
        store_lane(bundle.lanes, int(lane), n, w.joints.records[slot], detail_of(w.joints, slot));
      }
    }
  }
}

}  // namespace gyre
