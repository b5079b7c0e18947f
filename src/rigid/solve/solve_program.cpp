// The stages of sub-steps and their order. See solve_program.h.
#include "rigid/solve/solve_program.h"

#include "rigid/batch/joint_constraints.h"
#include "rigid/solve/energy_limiter.h"
#include "rigid/solve/geometric_stiffness.h"
#include "rigid/solve/motion_stages.h"
#include "solver/articulation/ball_joint_transfer.h"
#include "task/parallel.h"
#include "task/program.h"

#include <bit>

namespace gyre {

namespace {

constexpr int kJointsPerBlock = 16;  // whole blocks of lanes at every width
constexpr int kJointBlocksPerClaim = 2;
constexpr int kBlocksPerClaim = 2;
constexpr int kTreesPerClaim = 8;

// --------------------------------------------------------------------------------------------------- stages' kernels

void record_approach_stage(void* context, int, int, int) {
  const BatchContext& s = *static_cast<BatchContext*>(context);
  record_approach(s.scratch.impacts, s.contact_bodies);
}
void apply_restitution_stage(void* context, int, int, int) {
  const BatchContext& s = *static_cast<BatchContext*>(context);
  apply_restitution(s.scratch.impacts, s.contact_bodies, s.impact_settings);
}
void release_stage(void* context, int, int, int) {
  const BatchContext& s = *static_cast<BatchContext*>(context);
  apply_delayed_restitution(s.scratch.impacts, s.contact_bodies, s.impact_settings);
}

template <void (*kernel)(const BatchContext&, int, int)>
void joint_islands_stage(void* context, int begin, int end, int) {
  kernel(*static_cast<BatchContext*>(context), begin, end);
}
void stiffen_bodies_stage(void* context, int, int, int) {
  stiffen_bodies(*static_cast<BatchContext*>(context));
}

void solve_trees_stage(void* context, int begin, int end, int) {
  const BatchContext& s = *static_cast<BatchContext*>(context);
  for (int i = begin; i < end; ++i) solve_tree(s.forest.trees[std::size_t(i)], s.tree_solve);
}

// One after the other: they share the step's arena, which nobody else uses meanwhile.
template <void (*kernel)(RestingStructure&, const StructureSolve&)>
void structures_stage(void* context, int, int, int) {
  const BatchContext& s = *static_cast<BatchContext*>(context);
  for (RestingStructure& structure : s.structures) kernel(structure, s.structure_solve);
}

void prepare_contacts_stage(void* context, int begin, int end, int) {
  const BatchContext& s = *static_cast<BatchContext*>(context);
  s.kernels.prepare(s.blocks, s.cold_blocks, begin, end, s.scratch.constraints.data(), s.scratch.order.data(),
                    s.contact_bodies, s.contact_settings);
}
void finish_contacts_stage(void* context, int begin, int end, int) {
  const BatchContext& s = *static_cast<BatchContext*>(context);
  s.kernels.finish(s.blocks, begin, end, s.scratch.constraints.data(), s.scratch.order.data(),
                   s.contact_settings);
}
void warm_contacts_stage(void* context, int begin, int end, int) {
  const Group& g = *static_cast<Group*>(context);
  g.solve->kernels.warm_start(g.solve->blocks, int(g.first) + begin, int(g.first) + end);
}
// Of the widest kernels.
constexpr int kMaxLanes = 16;

// Calls fn(rolling, block, lane) for those contacts of the blocks that roll, which are few.
template <class Fn>
void for_each_rolling(const Group& g, int begin, int end, Fn&& fn) {
  BatchContext& s = *g.solve;
  if (s.rolling.contacts.empty()) return;
  for (int block = int(g.first) + begin; block < int(g.first) + end; ++block) {
    for (unsigned lanes = s.rolling_lanes[std::size_t(block)]; lanes != 0; lanes &= lanes - 1) {
      const int lane = std::countr_zero(lanes);
      fn(s.rolling.contacts[s.rolling_places[std::size_t(block * s.kernels.width + lane)]], block, lane);
    }
  }
}
// Takes their points along, and their bodies to the velocities of the middle of the sub-step, until these contacts are solved.
void advance_contact_points(const Group& g, int begin, int end) {
  BatchContext& s = *g.solve;
  AdvancedArmsLane lanes[kMaxLanes];
  RollingContact* contacts[kMaxLanes];
  int present = 0, count = 0;
  const auto inverse_of = [&](std::int32_t body) {
    return body == kNoBody ? nullptr : &s.contact_bodies.inertia[body].inverse;
  };
  const auto follow_block = [&] {
    if (count == 0) return;
    s.kernels.follow(s.blocks, present, lanes, count);
    for (int i = 0; i < count; ++i) {
      Vec3& spin = s.contact_bodies.motion[contacts[i]->body].angular_velocity;
      spin = spin + contacts[i]->drift;
    }
    count = 0;
  };
  for_each_rolling(g, begin, end, [&](RollingContact& rolling, int block, int lane) {
    if (block != present) follow_block();
    present = block;
    if (rolling.once) s.rolling_lanes[std::size_t(block)] &= std::uint16_t(~(1u << lane));
    advance_contact_point(s.w, rolling, 0.5f * (rolling.once ? s.contact_settings.step : s.h));
    contacts[count] = &rolling;
    lanes[count++] = {lane, &rolling.arms, inverse_of(body_a_of(rolling)), inverse_of(body_b_of(rolling))};
  });
  follow_block();
}
void restore_velocities(const Group& g, int begin, int end) {
  for_each_rolling(g, begin, end, [&](const RollingContact& rolling, int, int) {
    Vec3& spin = g.solve->contact_bodies.motion[rolling.body].angular_velocity;
    spin = spin - rolling.drift;
  });
}
void solve_contacts_stage(void* context, int begin, int end, int) {
  const Group& g = *static_cast<Group*>(context);
  // What is left over when the colours are used up shares bodies: each of them goes to its middle once.
  const int blocks = g.serial && !g.solve->rolling.contacts.empty() ? 1 : end - begin;
  for (; begin < end; begin += blocks) {
    advance_contact_points(g, begin, begin + blocks);
    g.solve->kernels.solve(g.solve->blocks, int(g.first) + begin, int(g.first) + begin + blocks, g.solve->h);
    restore_velocities(g, begin, begin + blocks);
  }
}
void relax_contacts_stage(void* context, int begin, int end, int) {
  const Group& g = *static_cast<Group*>(context);
  g.solve->kernels.relax(g.solve->blocks, int(g.first) + begin, int(g.first) + end, g.solve->h);
}
void project_contacts_stage(void* context, int begin, int end, int) {
  const Group& g = *static_cast<Group*>(context);
  g.solve->kernels.project(g.solve->blocks, int(g.first) + begin, int(g.first) + end,
                           g.solve->contact_settings.step);
}
// Calls fn(place in the batch's list) for the joints of some blocks of a group.
template <class Fn>
void for_members(const Group& g, int begin, int end, Fn&& fn) {
  const BatchContext& s = *g.solve;
  const std::uint32_t last = min(std::uint32_t(end * kJointsPerBlock), g.count);
  for (std::uint32_t n = std::uint32_t(begin * kJointsPerBlock); n < last; ++n)
    fn(s.scratch.swept_joints[s.joint_order[g.first + n]]);
}
// Calls fn(record, work, places) for them.
template <class Fn>
void for_joints(const Group& g, int begin, int end, Fn&& fn) {
  BatchContext& s = *g.solve;
  for_members(g, begin, end, [&](std::uint32_t i) {
    fn(s.w.joints.records[s.batch.joints[i]], s.joint_work[i], s.joint_offsets[i]);
  });
}
// The blocks of a group whose joints are solved side by side.
struct Balls {
  const BallKernels& kernels;
  void* blocks;
  BallArrays arrays;
  BallSettings settings;
  int begin, end;
};
Balls balls_of(const Group& g, int begin, int end) {
  const BatchContext& s = *g.solve;
  const Softness& softness = s.joint_settings.softness;
  const int width = s.kernels.width, joints = min(end * kJointsPerBlock, int(g.count));
  return {s.kernels.balls,
          s.balls,
          {s.joint_bodies.motion, s.joint_bodies.inertia, s.joint_bodies.orientation},
          {s.h, softness.bias_rate, softness.mass_scale, softness.impulse_scale},
          g.ball_block + begin * kJointsPerBlock / width,
          g.ball_block + count_blocks(joints, width)};
}
// Records of joints are large, and lie in the order of their slots, not of colours: what is needed of them comes while others are
// worked on.
constexpr int kJointsAhead = 6;
void fetch_ahead(const JointRecord& joint) {
  __builtin_prefetch(&joint);
  __builtin_prefetch(&joint.linear_impulse);
  __builtin_prefetch(&joint.total_linear);
}
// Calls fn(block, lane, slot) for the joints of such a group.
template <class Fn>
void for_balls(const Group& g, int begin, int end, Fn&& fn) {
  const BatchContext& s = *g.solve;
  const int width = s.kernels.width, last = min(end * kJointsPerBlock, int(g.count));
  const auto slot_of = [&](int n) {
    return s.batch.joints[s.scratch.swept_joints[s.joint_order[g.first + std::uint32_t(n)]]];
  };
  for (int n = begin * kJointsPerBlock; n < last; ++n) {
    if (n + kJointsAhead < last) fetch_ahead(s.w.joints.records[slot_of(n + kJointsAhead)]);
    fn(g.ball_block + n / width, n % width, slot_of(n));
  }
}
void begin_balls_stage(void* context, int begin, int end, int) {
  const Group& g = *static_cast<Group*>(context);
  if (g.ball_block < 0) return;
  const Balls balls = balls_of(g, begin, end);
  // Lanes without a joint join nothing.
  if (int(g.count) % balls.kernels.width != 0) clear_balls(balls.kernels, balls.blocks, balls.end - 1);
  const BatchContext& s = *g.solve;
  const float warm_scale = s.all_iterative ? s.lane_start.warm_scale : 1.0f;
  const auto turns = [&](std::int32_t body) {
    return body != kNoBody &&
           inertia_rotates(s.w.bodies.masses[std::size_t(body)], s.w.bodies.flags[std::size_t(body)]);
  };
  for_balls(g, begin, end, [&](int block, int lane, std::uint32_t slot) {
    const JointRecord& joint = s.w.joints.records[slot];
    begin_ball(balls.kernels, balls.blocks, block, lane, joint, joint_offset(s.w, joint), warm_scale,
               turns(joint.body_a) || turns(joint.body_b), balls.arrays.inertia);
  });
  balls.kernels.locate(balls.blocks, balls.begin, balls.end, balls.arrays);
}
void finish_balls_stage(void* context, int begin, int end, int) {
  const Group& g = *static_cast<Group*>(context);
  if (g.ball_block < 0) return;
  const Balls balls = balls_of(g, begin, end);
  for_balls(g, begin, end, [&](int block, int lane, std::uint32_t slot) {
    finish_ball(balls.kernels, balls.blocks, block, lane, g.solve->w.joints.records[slot]);
  });
}
void prepare_joints_stage(void* context, int begin, int end, int) {
  const Group& g = *static_cast<Group*>(context);
  if (g.ball_block >= 0) {
    const Balls balls = balls_of(g, begin, end);
    return balls.kernels.place(balls.blocks, balls.begin, balls.end, balls.arrays);
  }
  for_joints(g, begin, end, [&](JointRecord& joint, JointConstraint& work, const JointOffsets& places) {
    prepare_joint(joint, work, places, g.solve->joint_bodies, g.solve->joint_settings);
  });
}
void update_joint_bias_stage(void* context, int begin, int end, int) {
  const Group& g = *static_cast<Group*>(context);
  if (g.ball_block >= 0) {
    const Balls balls = balls_of(g, begin, end);
    return balls.kernels.second_order_bias(balls.blocks, balls.begin, balls.end, balls.settings);
  }
  for_joints(g, begin, end, [&](JointRecord& joint, JointConstraint& work, const JointOffsets&) {
    update_joint_bias(joint, work, g.solve->joint_bodies, g.solve->joint_settings);
  });
}
void warm_joints_stage(void* context, int begin, int end, int) {
  const Group& g = *static_cast<Group*>(context);
  if (g.ball_block >= 0) {
    const Balls balls = balls_of(g, begin, end);
    return balls.kernels.warm(balls.blocks, balls.begin, balls.end);
  }
  for_joints(g, begin, end, [&](JointRecord& joint, JointConstraint& work, const JointOffsets&) {
    warm_start_joint(joint, work, g.solve->joint_bodies);
  });
}
void solve_joints_stage(void* context, int begin, int end, int) {
  const Group& g = *static_cast<Group*>(context);
  if (g.ball_block >= 0) {
    const Balls balls = balls_of(g, begin, end);
    return balls.kernels.solve(balls.blocks, balls.begin, balls.end, balls.settings);
  }
  for_joints(g, begin, end, [&](JointRecord& joint, JointConstraint& work, const JointOffsets&) {
    solve_joint(joint, work, g.solve->joint_bodies, g.solve->joint_settings, true);
  });
}
// Balls are placed with what follows, while they are in the cache: nothing that one colour gives changes where the next one
// stands, and no linkage has their bodies.
void place_again_stage(void* context, int begin, int end, int worker) {
  if (static_cast<Group*>(context)->ball_block < 0) prepare_joints_stage(context, begin, end, worker);
}
void relax_joints_stage(void* context, int begin, int end, int) {
  const Group& g = *static_cast<Group*>(context);
  if (g.ball_block >= 0) {
    const Balls balls = balls_of(g, begin, end);
    balls.kernels.place(balls.blocks, balls.begin, balls.end, balls.arrays);
    return balls.kernels.relax(balls.blocks, balls.begin, balls.end);
  }
  for_joints(g, begin, end, [&](JointRecord& joint, JointConstraint& work, const JointOffsets&) {
    solve_joint(joint, work, g.solve->joint_bodies, g.solve->joint_settings, false);
    accumulate_joint_impulses(joint, work, g.solve->joint_bodies);
  });
}

// Of all groups in one stage: for kernels that write nothing but what is a joint's own. A slice is the same share of each group, so
// that workers keep to the bodies that they have in the groups' own stages.
constexpr int kJointSlices = 32;
constexpr int kSlicesPerClaim = 2;
template <void (*kernel)(void*, int, int, int)>
void joint_slices_stage(void* context, int begin, int end, int worker) {
  for (Group& g : static_cast<BatchContext*>(context)->joint_groups) {
    const int blocks = count_blocks(int(g.count), kJointsPerBlock);
    const int first = blocks * begin / kJointSlices, last = blocks * end / kJointSlices;
    if (first < last) kernel(&g, first, last, worker);
  }
}

template <void (*kernel)(void*, int, int, int)>
void smooth_stage(void* context, int begin, int end, int worker) {
  kernel(&static_cast<BatchContext*>(context)->smooth, begin, end, worker);
}

// Of linkages [begin, end).
template <void (*kernel)(const Articulation&, const ArticulationSolve&)>
void articulation_stage(void* context, int begin, int end, int worker) {
  const BatchContext& s = *static_cast<BatchContext*>(context);
  ArticulationSolve own = s.articulation_solve;
  if (!s.stop_rooms.empty()) own.room = s.stop_rooms[std::size_t(worker)];
  for (int i = begin; i < end; ++i) kernel(s.linkages.linkages[std::size_t(i)], own);
}

// Of linkages side by side.
void begin_bundles_stage(void* context, int begin, int end, int) {
  const BatchContext& s = *static_cast<BatchContext*>(context);
  begin_bundles(s.bundles, begin, end, s.w, s.lane_start);
}
void finish_bundles_stage(void* context, int begin, int end, int) {
  const BatchContext& s = *static_cast<BatchContext*>(context);
  finish_bundles(s.bundles, begin, end, s.w);
}
template <BundleKernel... kernels>
void bundle_stage(void* context, int begin, int end, int) {
  const BundleSolve& s = static_cast<BatchContext*>(context)->bundles;
  for (int i = begin; i < end; ++i) {
    const ArticulationBundle& bundle = s.bundles[std::size_t(i)].lanes;
    ((bundle.kernels->*kernels)(bundle, s.arrays, s.settings), ...);
  }
}

// ---------------------------------------------------------------------------------------------------------- program

// Of how many bodies, the first, somebody asks what contacts gave them: where there may be any. (The look clears negative zeros
// away, too, which joints that are not in lanes leave.)
std::size_t count_watched(const BatchContext& s, bool has_contacts) {
  const bool has_lanes = !s.bundles.bundles.empty(), has_articulations = !s.linkages.linkages.empty();
  if (s.joint_groups.empty() && !has_articulations) {
    if (has_lanes) return has_contacts ? s.moved_in_contact : 0;
    return s.moved.size();
  }
  return has_contacts || has_lanes || has_articulations ? s.moved.size() : 0;
}

// A part of a sub-step: how many blocks its stages have.
struct HalfStep {
  bool first, last;
  std::span<Group> contacts, joints;
  int bodies, watched, impacts, linkages, bundles, fields, slices, pulled, islands;
  // Joints act between forces and contacts: what they give is none of the contacts' work, and how they bend in the sub-step
  // is none of what contacts gave in the last one.
  bool has_joints;

  HalfStep(const BatchContext& solve, int part, std::span<Group> contact_groups,
           std::span<Group> joint_groups)
      : first(part == 0),
        last(part + 1 == solve.motions.count),
        contacts(contact_groups),
        joints(joint_groups),
        bodies(count_blocks(int(solve.moved.size()), solve.kernels.width)),
        watched(solve.recorded_blocks),
        impacts(solve.scratch.impacts.empty() ? 0 : 1),
        linkages(int(solve.linkages.linkages.size())),
        bundles(int(solve.bundles.bundles.size())),
        fields(solve.fields.blocks()),
        slices(joints.empty() ? 0 : kJointSlices),
        pulled(solve.pulled.empty() ? 0 : 1),
        islands(int(solve.joint_islands.size())),
        has_joints(linkages > 0 || bundles > 0 || !joints.empty()) {}
};

// Forces, impacts and joints, these only where there are any.
void add_before_contacts(ProgramWriter& program, BatchContext& solve, const HalfStep& part) {
  const bool first = part.first;
  const bool is_warm = !first && part.impacts == 0 && part.linkages == 0 && part.joints.empty();
  program.add(watch_fields_stage, &solve.fields, part.fields);
  program.add(record_approach_stage, &solve, part.impacts);
  if (solve.smooth.any_carried) {
    program.add(smooth_stage<move_carried_stage>, &solve, solve.smooth.count());
    program.add(smooth_stage<kick_carriers_stage>, &solve, 1);
  }
  add_motion(program, solve, is_warm ? predict_warm_stage : predict_stage, part.bodies);
  program.add(apply_restitution_stage, &solve, part.impacts);
  program.add(joint_slices_stage<update_joint_bias_stage>, &solve, part.slices, kSlicesPerClaim);
  program.add(joint_islands_stage<begin_warm_work>, &solve, part.islands);
  program.add(articulation_stage<warm_start_articulation>, &solve, part.linkages);
  // Later they have been asked as the last part ended: velocities are as they were but for what turns no joint. (Blows of the batch must
  // not be a reason to ask again: they may be another island's.)
  if (first) program.add(bundle_stage<&ArticulationKernels::ask>, &solve, part.bundles);
  program.add_groups(warm_joints_stage, part.joints, kJointsPerBlock, kJointBlocksPerClaim);
  program.add(joint_islands_stage<end_joint_work>, &solve, part.islands);
  program.add(joint_islands_stage<limit_gain>, &solve, part.islands);
  if (!first && !is_warm) add_motion(program, solve, warm_motion_stage, part.watched);
  if (first) {
    add_motion(program, solve, record_velocities_stage, part.watched);
    program.add_groups(warm_contacts_stage, part.contacts, 1, kBlocksPerClaim);
    add_motion(program, solve, record_velocity_change_stage, part.watched);
  }
  // What contacts and joints gave in the last part is in the velocities by now: a stream pulls at what really moves.
  program.add(apply_fields_stage, &solve.fields, part.fields);
  if (part.fields > 0) add_motion(program, solve, record_velocities_stage, part.watched);
  program.add(joint_islands_stage<begin_joint_work>, &solve, part.islands);
  program.add_groups(solve_joints_stage, part.joints, kJointsPerBlock, kJointBlocksPerClaim);
  program.add(articulation_stage<solve_articulation>, &solve, part.linkages);
  program.add(bundle_stage<&ArticulationKernels::solve>, &solve, part.bundles);
  program.add(joint_islands_stage<end_joint_work>, &solve, part.islands);
  program.add(joint_islands_stage<limit_gain>, &solve, part.islands);
  if (part.has_joints) add_motion(program, solve, record_velocities_stage, part.watched);
}

// Stacks and structures at rest are solved directly after the first sweep, which gives them the loads of this step, and after
// the last, which leaves them at rest: in between nothing is left for the sweeps to change.
void add_contacts(ProgramWriter& program, BatchContext& solve, const HalfStep& part) {
  const int trees = part.first || part.last ? int(solve.forest.trees.size()) : 0;
  const int structures = solve.structures.empty() ? 0 : 1;
  program.add_groups(solve_contacts_stage, part.contacts, 1, kBlocksPerClaim);
  program.add(solve_trees_stage, &solve, trees, kTreesPerClaim);
  if (part.first) program.add(structures_stage<solve_structure_first>, &solve, structures);
  if (part.last) program.add(structures_stage<solve_structure_last>, &solve, structures);
}

// Joints as contacts have left them, moves, and what is left of speed along the joints.
void add_after_contacts(ProgramWriter& program, BatchContext& solve, const HalfStep& part) {
  const bool last = part.last;
  if (part.has_joints) add_motion(program, solve, record_velocity_change_stage, part.watched);
  program.add(joint_islands_stage<begin_joint_work>, &solve, part.islands);
  program.add(articulation_stage<solve_articulation_after_contacts>, &solve, part.linkages);
  program.add(bundle_stage<&ArticulationKernels::solve_again>, &solve, part.bundles);
  program.add(joint_islands_stage<end_joint_work>, &solve, part.islands);
  program.add(joint_islands_stage<limit_gain>, &solve, part.islands);
  add_motion(program, solve, part.has_joints ? advance_recorded_stage : advance_stage, part.bodies);
  add_exact_rotation(program, solve);
  program.add(release_stage, &solve, part.impacts);
  program.add(stiffen_bodies_stage, &solve, part.pulled);
  program.add(joint_slices_stage<place_again_stage>, &solve, part.slices, kSlicesPerClaim);
  program.add(articulation_stage<prepare_articulation>, &solve, part.linkages);
  if (!part.joints.empty()) program.add(bundle_stage<&ArticulationKernels::place>, &solve, part.bundles);
  program.add(joint_islands_stage<begin_joint_work>, &solve, part.islands);
  program.add_groups(relax_joints_stage, part.joints, kJointsPerBlock, kJointBlocksPerClaim);
  program.add(articulation_stage<relax_articulation>, &solve, part.linkages);
  // Where no joint is swept in between, while their rows are still in the cache.
  if (!part.joints.empty())
    program.add(last ? bundle_stage<&ArticulationKernels::finish> : bundle_stage<&ArticulationKernels::pass>,
                &solve, part.bundles);
  else
    program.add(last ? bundle_stage<&ArticulationKernels::place, &ArticulationKernels::finish>
                     : bundle_stage<&ArticulationKernels::place, &ArticulationKernels::pass>,
                &solve, part.bundles);
  program.add(joint_islands_stage<end_joint_work>, &solve, part.islands);
  program.add(joint_islands_stage<remove_gain>, &solve, part.islands);
}

// Of a batch that goes in runs: all that bundles and moves do between the contacts of one part and those of the next is one line, and one
// before it for bodies that are in none.
bool is_fused(const BatchContext& solve) { return !solve.run_lines[1].runs.empty(); }
void add_runs(ProgramWriter& program, BatchContext& solve, void (*kernel)(void*, int, int, int)) {
  for (FusedStage& line : solve.run_lines) program.add(kernel, &line, int(line.runs.size()));
}
void add_fused_half_step(ProgramWriter& program, BatchContext& solve, const HalfStep& part) {
  if (part.first) {
    add_runs(program, solve, fused_begin_stage);
    program.add_groups(warm_contacts_stage, part.contacts, 1, kBlocksPerClaim);
    add_runs(program, solve, fused_first_stage);
  }
  add_contacts(program, solve, part);
  add_runs(program, solve, part.last ? fused_end_stage : between_contacts_stage);
}

void add_half_step(ProgramWriter& program, BatchContext& solve, const HalfStep& part) {
  if (is_fused(solve)) return add_fused_half_step(program, solve, part);
  add_before_contacts(program, solve, part);
  add_contacts(program, solve, part);
  add_after_contacts(program, solve, part);
}

}  // namespace

void run_substeps(BatchContext& solve, std::span<Group> contacts, std::span<Group> joints, Arena& arena,
                  TaskSystem& tasks) {
  const int parts = solve.motions.count;
  const std::size_t per_part =
      (solve.bundles.bundles.empty() ? 40 : 45) + 3 * joints.size() + 2 * contacts.size();
  ProgramWriter program(arena.make<Stage>(19 + std::size_t(parts) * per_part + 2 * contacts.size()));
  solve.joint_groups = joints;
  solve.recorded_blocks = count_blocks(int(count_watched(solve, !contacts.empty())), solve.kernels.width);
  const int slices = joints.empty() ? 0 : kJointSlices;
  std::uint32_t blocks = 0;
  for (const Group& group : contacts) blocks += group.count;
  const int bodies = count_blocks(int(solve.moved.size()), solve.kernels.width);
  add_free_bodies(program, solve);
  program.add(smooth_stage<move_smooth_stage>, &solve, solve.smooth.count());
  const bool in_runs = is_fused(solve);
  if (!in_runs) add_motion(program, solve, prepare_motion_stage, bodies);
  program.add(stiffen_bodies_stage, &solve, solve.pulled.empty() ? 0 : 1);
  program.add(prepare_fields_stage, &solve.fields, solve.fields.blocks());
  program.add(prepare_contacts_stage, &solve, int(blocks), kBlocksPerClaim);
  program.add(joint_slices_stage<begin_balls_stage>, &solve, slices, kSlicesPerClaim);
  program.add(joint_slices_stage<prepare_joints_stage>, &solve, slices, kSlicesPerClaim);
  program.add(articulation_stage<prepare_articulation>, &solve, int(solve.linkages.linkages.size()));
  const int bundles = in_runs ? 0 : int(solve.bundles.bundles.size());
  program.add(begin_bundles_stage, &solve, bundles);
  program.add(bundle_stage<&ArticulationKernels::place>, &solve, bundles);
  for (int i = 0; i < parts; ++i) add_half_step(program, solve, HalfStep(solve, i, contacts, joints));
  program.add_groups(relax_contacts_stage, contacts, 1, kBlocksPerClaim);
  add_motion(program, solve, begin_projection_stage, bodies);
  program.add_groups(project_contacts_stage, contacts, 1, kBlocksPerClaim);
  add_motion(program, solve, end_projection_stage, bodies);
  add_apply_rotations(program, solve);
  program.add(smooth_stage<finish_smooth_stage>, &solve, solve.smooth.count());
  program.add(finish_contacts_stage, &solve, int(blocks), kBlocksPerClaim);
  program.add(finish_bundles_stage, &solve, bundles);
  program.add(joint_slices_stage<finish_balls_stage>, &solve, slices, kSlicesPerClaim);
  run_program(tasks, program.stages());
}

}  // namespace gyre
