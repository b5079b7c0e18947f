#include "rigid/solve/solve_step.h"

#include "rigid/batch/joint_constraints.h"
#include "rigid/solve/energy_limiter.h"
#include "rigid/solve/geometric_stiffness.h"
#include "rigid/solve/hits.h"
#include "rigid/solve/solve_bodies.h"
#include "rigid/solve/solve_gather.h"
#include "rigid/solve/solve_layout.h"
#include "rigid/solve/solve_program.h"
#include "rigid/solve/solve_rows.h"
#include "task/parallel.h"

#include <bit>

namespace gyre {

namespace {

// Contacts begin as soft springs and stiffen as they age, with this time to half; these are the rate at which a new one
// asks overlap back and that at which it gives way (1/s). docs/decisions/contact-softness.md tells how they were found.
constexpr float kContactRate = 9.0f;
constexpr float kContactLeak = 44.0f;
constexpr float kContactAging = 0.25f;
// A sub-step is solved in parts: one sweep over the constraints, then everything moves. Two short parts hold four times
// as stiff as two sweeps in one place.
constexpr int kHalfStepsPerSubstep = 2;
// Joints: errors are taken back at this rate (1/s), and impulses give way at this one, a little more than half of it, as
// sweeps that lag behind need (the same page). Neither depends on the sub-step.
constexpr float kJointRate = 40.0f;
constexpr float kJointLeak = 22.0f;
// Those of linkages are solved exactly; rows give way by this share of what would move them freely, enough to decide among
// redundant ones (docs/decisions/joint-trees.md).
constexpr float kArticulationCompliance = 1.0e-4f;
// Nothing bounces that closes slower than this many times the speed that gravity gives in a sub-step.
constexpr float kBounceShare = 2.0f;

// By how much impulses grow at most from one part of an adaptive step to the next.
constexpr float kMaxWarm = 4.0f;

// Whether all that is in contact hangs on joints. None of these islands counts as one at rest.
bool all_contacts_hang(const BatchContext& solve, Arena& arena) {
  if (solve.joint_edges.empty()) return false;
  const ArenaScope scope(arena);
  const std::span<std::uint8_t> hangs = arena.make<std::uint8_t>(solve.batch.bodies.size());
  for (std::uint8_t& one : hangs) one = 0;
  for (const JointEdge& joint : solve.joint_edges)
    for_moving(joint, [&](std::uint32_t body) { hangs[solve.places[body]] = 1; });
  const auto hangs_at = [&](std::uint32_t place) {
    return place != ColoringPair::kNone && hangs[place] != 0;
  };
  for (const ColoringPair& pair : solve.scratch.pairs)
    if (!hangs_at(pair.a) && !hangs_at(pair.b)) return false;
  return true;
}
// The islands at rest, which are solved directly.
void find_resting(BatchContext& solve, Arena& arena) {
  solve.forest = {};
  solve.structures = {};
  const std::span<ContactConstraint> constraints = solve.scratch.constraints.view();
  if (constraints.empty() || !(length(solve.w.settings.gravity) > 0.0f)) return;
  if (all_contacts_hang(solve, arena)) return;
  const std::span<const ColoringPair> pairs = solve.scratch.pairs;
  const RestingIslands islands(solve.w, constraints, pairs, solve.joint_edges, solve.batch, solve.places,
                               arena);
  solve.forest = find_resting_trees(solve.w, constraints, pairs, solve.batch, islands, arena);
  solve.structures = find_resting_structures(solve.w, pairs, solve.batch, islands, arena);
}
void place_resting(BatchContext& solve, Arena& arena) {
  if (solve.forest.nodes.empty() && solve.structures.empty()) return;
  const BatchScratch& scratch = solve.scratch;
  const int width = solve.kernels.width;
  const std::span<const std::uint32_t> places =
      find_kernel_positions(scratch.order, scratch.constraints.size(), arena);
  set_tree_positions(solve.forest, places, width);
  set_structure_positions(solve.structures, places, width);
  BodyMotion* motion = solve.contact_bodies.motion;
  solve.tree_solve = {solve.forest.nodes, solve.forest.work, scratch.constraints,        motion,
                      &solve.kernels,     solve.blocks,      solve.contact_settings.step};
  solve.structure_solve = {scratch.constraints, motion, &solve.kernels, solve.blocks, &arena};
}

// By place in the batch: 1 of bodies on which contacts act.
std::span<const std::uint8_t> find_pressed(const BatchContext& solve, Arena& arena) {
  const std::span<const ColoringPair> pairs = solve.scratch.pairs;
  if (pairs.empty() || solve.joint_edges.empty()) return {};
  const std::span<std::uint8_t> pressed = arena.make<std::uint8_t>(solve.batch.bodies.size());
  for (std::uint8_t& one : pressed) one = 0;
  for (const ColoringPair& pair : pairs) {
    if (pair.a != ColoringPair::kNone) pressed[pair.a] = 1;
    if (pair.b != ColoringPair::kNone) pressed[pair.b] = 1;
  }
  return pressed;
}

// Joints, and which of them are solved directly. Most of those in linkages, and of a net that is known to be swept, need no work
// but a lane.
void begin_joints(BatchContext& solve, float warm_scale, Arena& arena) {
  DenseGraphCache& nets = solve.scratch.dense_graphs;
  solve.all_iterative = !solve.joint_edges.empty() && nets.holds(solve.joint_edges);
  solve.lane_start = {
      .warm_scale = warm_scale, .substep = solve.h, .softness = solve.joint_settings.softness};
  solve.linkages = solve.all_iterative
                       ? no_articulations(solve.joint_edges.size(), arena)
                       : find_articulations(solve.w, solve.batch, solve.places, solve.joint_edges,
                                            find_pressed(solve, arena), solve.lane_start, nets, arena);
  const JointConstraints works =
      begin_joints(solve.w, solve.batch, prepared_in_simd(solve), warm_scale, arena);
  solve.joint_work = works.work;
  solve.joint_offsets = works.places;
}

void color(const BatchContext& solve, std::span<const ColoringPair> pairs,
           std::span<const std::uint32_t> names, Coloring& colors) {
  color_constraints(pairs, names, std::uint32_t(solve.batch.bodies.size()), {}, kColoringOptions, colors);
}

// How the constraints will be solved: directly or swept, in which colours, and in which lanes. Joints and islands at rest are looked at
// beside the contacts.
std::span<Group> arrange(BatchContext& solve, float warm_scale, Arena& arena, TaskSystem& tasks) {
  BatchScratch& scratch = solve.scratch;
  const std::span<Group> room = arena.make<Group>(kMaxGroups);
  if (solve.domains.count() > 1)
    solve.group_bounds = arena.make<int>(kMaxGroups * std::size_t(solve.domains.count() + 1));
  std::span<Group> contacts;
  side_by_side(
      tasks,
      [&] {
        begin_joints(solve, warm_scale, arena);
        gather_joints(solve);
        color(solve, scratch.joint_pairs, {}, scratch.joint_colors);
        find_resting(solve, arena);
      },
      [&] {
        color(solve, scratch.pairs, scratch.constraint_contact, scratch.contact_colors);
        contacts = lay_out_contacts(solve, room);
      });
  return contacts;
}

void solve_batch(BatchContext& solve, Arena& arena, TaskSystem& tasks, float warm_scale) {
  const ArenaScope scope(arena);
  BatchScratch& scratch = solve.scratch;
  gather_contacts(solve, arena, tasks);
  look_at_joints(solve, arena, tasks);
  solve.rolling =
      find_rolling_contacts(solve.w, scratch, solve.batch.bodies, solve.contact_settings.step, arena, tasks);
  solve.domains = partition_by_worker(scratch.pairs, solve.batch.bodies.size(), tasks.worker_count(), arena);
  const std::span<Group> contacts = arrange(solve, warm_scale, arena, tasks);
  if (solve.is_smooth)
    solve.smooth =
        find_smooth_motion(solve.w, solve.batch, solve.places, solve.motions.count, solve.h, arena);
  solve.fields = find_field_bodies(solve.w, solve.batch.bodies, solve.h, arena, !solve.is_smooth);
  solve.articulation_solve = {.records = solve.w.joints.records,
                              .work = solve.joint_work,
                              .places = solve.joint_offsets,
                              .bodies = solve.joint_bodies,
                              .settings = solve.joint_settings,
                              .compliance = kArticulationCompliance};
  solve.articulation_solve.settings.swept = false;
  attach_drives(solve.linkages, solve.joint_work, arena);
  solve.stop_rooms = find_limits(solve.linkages, solve.joint_work, std::size_t(tasks.worker_count()), arena);
  const JointBodies& bodies = solve.joint_bodies;
  solve.bundles = lay_out_bundles(
      solve.linkages, solve.kernels, {bodies.motion, bodies.inertia, bodies.orientation},
      {solve.h, solve.joint_settings.softness.bias_rate, kArticulationCompliance, add_geometric_stiffness},
      arena);
  solve.pulled = find_stiffened_bodies(solve, arena);
  solve.joint_islands = find_joint_islands(solve, arena);
  gather_motion(solve, arena, tasks);
  disable_gyroscopic_torque(solve, arena);
  make_contact_blocks(solve, contacts, arena);
  place_resting(solve, arena);
  const std::span<Group> joints = lay_out_joints(solve, arena);
  run_substeps(solve, contacts, joints, arena, tasks);
  restore_inertia(solve);
  finish_joints(solve.w, solve.batch, prepared_in_simd(solve), solve.joint_work);
  drop_limited_impulses(solve);
  if (solve.is_smooth) finish_springs(solve.w, solve.smooth, scratch.report);
  note_hits(solve.w, scratch, arena, tasks);
  scratch.counts.manifolds += scratch.constraints.size();
  scratch.counts.joints += solve.batch.joints.size();
  scratch.counts.swept_joints += scratch.swept_joints.size();
}

// How the sub-steps of a step are.
struct SubStepping {
  int parts = 0;
  float h = 0.0f;  // s, of a part
  float warm_scale = 0.0f;
};

SubStepping plan_substeps(RigidWorld& w, float seconds, bool by_rows) {
  SubStepping plan;
  plan.parts = by_rows ? w.settings.substeps : kHalfStepsPerSubstep * w.settings.substeps;
  plan.h = seconds / float(plan.parts);
  plan.warm_scale = w.settings.last_substep > 0.0f ? plan.h / w.settings.last_substep : 0.0f;
  // Parts of a step up to an impact may be as short as they like: what one of these leaves is mostly rounding.
  if (!w.inactive_contacts.empty()) plan.warm_scale = min(plan.warm_scale, kMaxWarm);
  w.settings.last_substep = plan.h;
  w.settings.last_step = seconds;
  return plan;
}

// What is the same for all batches.
BatchContext describe_solve(RigidWorld& w, BatchScratch& scratch, const ContactKernels& kernels,
                            float seconds, const SubStepping& plan) {
  const float h = plan.h;
  BatchContext solve{w, scratch, kernels};
  solve.h = h;
  solve.motions = {plan.parts, h, w.settings.gravity};
  solve.is_smooth = !w.motion_settings.empty();
  const float geometric_stiffness = length(w.settings.gravity);
  solve.contact_settings = {
      .substep = h,
      .step = seconds,
      .rate = min(kContactRate, 0.8f / h),
      .compliance = kContactLeak * h / (1.0f + kContactLeak * h),
      .aging = kContactAging,
      .warm_scale = plan.warm_scale,
      .up = geometric_stiffness > 0.0f ? (-1.0f / geometric_stiffness) * w.settings.gravity : Vec3{}};
  // Long sub-steps take back no more than the whole error and give way by less than the whole impulse.
  const float compliance = kJointLeak * h / (1.0f + kJointLeak * h);
  solve.joint_settings = {
      h, {min(kJointRate, 0.8f / h), 1.0f - compliance, compliance}, row_solver_of(w) == nullptr};
  solve.impact_settings = {h, kBounceShare * h * geometric_stiffness};
  solve.contact_bodies = {w.bodies.motion.data(), w.bodies.inertia.data()};
  solve.joint_bodies = {w.bodies.motion.data(), w.bodies.inertia.data(), w.bodies.orientations.data()};
  return solve;
}

void begin_bodies(RigidWorld& w, TaskSystem& tasks) {
  for_blocks(tasks, int(w.bodies.awake.size()), kBodiesPerBlock, [&](int begin, int end, int) {
    for (std::size_t i = std::size_t(begin); i < std::size_t(end); ++i) {
      const std::uint32_t body = w.bodies.awake[i];
      w.bodies.flags[body].constraint_use = 0;
      w.bodies.motion[body].moved = {};
      w.bodies.motion[body].turned = {};
      w.bodies.motion[body].pushed = 0.0f;
    }
  });
  w.field_rest.clear();
  if (!w.fields.empty()) w.field_rest.resize(w.bodies.motion.size());
  if (motion_settings(w).integrator == IntegratorKind::verlet)
    w.bodies.last_moves.resize(w.bodies.motion.size());
}

void begin_scratch(BatchScratch& scratch) {
  scratch.hits.clear();
  scratch.counts = {};
  scratch.report = {};
  scratch.rows = {};
}

// What constraints moved has its velocity from them.
void forget_moves(RigidWorld& w) {
  for (const std::uint32_t body : w.bodies.awake) {
    if (w.bodies.flags[body].constraint_use != kNotConstrained) w.bodies.last_moves[body] = {};
  }
}

// Whether workers may solve batches side by side: what fields, other solvers and other schemes tell of a step is put together by
// one only.
bool can_solve_batches_in_parallel(const RigidWorld& w, const TaskSystem& tasks) {
  return tasks.worker_count() > 1 && w.fields.empty() && w.motion_settings.empty() &&
         row_solver_of(w) == nullptr;
}

void make_as_roomy(WorkerContext& lone, const WorkerContext& other) {
  const auto even = [](auto& array, const auto& its) { array.reserve(its.capacity()); };
  const auto even_colors = [&](Coloring& coloring, const Coloring& its) {
    even(coloring.color, its.color), even(coloring.order, its.order);
    even(coloring.offsets, its.offsets), even(coloring.masks, its.masks);
  };
  BatchScratch& to = lone.scratch;
  const BatchScratch& from = other.scratch;
  even(to.constraints, from.constraints), even(to.constraint_contact, from.constraint_contact);
  even(to.impacts, from.impacts), even(to.pairs, from.pairs), even(to.order, from.order);
  even_colors(to.contact_colors, from.contact_colors), even_colors(to.joint_colors, from.joint_colors);
  even(to.swept_joints, from.swept_joints), even(to.joint_pairs, from.joint_pairs), even(to.hits, from.hits);
  lone.arena.expect(other.arena.peak());
}

// Which worker solves which batch is chance: all have room for what any of them had, so that a world at its working size no
// longer allocates.
void begin_lone(SolveScratch& scratch, std::size_t workers) {
  while (scratch.lone.size() > workers) scratch.lone.pop_back();
  while (scratch.lone.size() < workers) scratch.lone.push_back(std::make_unique<WorkerContext>());
  for (const std::unique_ptr<WorkerContext>& lone : scratch.lone) make_as_roomy(*scratch.lone[0], *lone);
  for (const std::unique_ptr<WorkerContext>& lone : scratch.lone) make_as_roomy(*lone, *scratch.lone[0]);
  // After all have heard of it: an arena that starts over forgets what it needed.
  for (const std::unique_ptr<WorkerContext>& lone : scratch.lone) {
    begin_scratch(lone->scratch);
    lone->arena.reset();
  }
}

// Of all batches together.
void sum_up(SolveScratch& scratch) {
  scratch.hits.clear();
  scratch.counts = {};
  const auto add = [&](const BatchScratch& part) {
    scratch.hits.append(part.hits);
    scratch.counts.manifolds += part.counts.manifolds;
    scratch.counts.joints += part.counts.joints;
    scratch.counts.swept_joints += part.counts.swept_joints;
    scratch.counts.colors_used |= part.counts.colors_used;
  };
  add(scratch.together);
  for (const std::unique_ptr<WorkerContext>& lone : scratch.lone) add(lone->scratch);
  scratch.colors = std::popcount(scratch.counts.colors_used);
  scratch.report = scratch.together.report;
  scratch.rows = scratch.together.rows;
}

}  // namespace

void solve_step(RigidWorld& w, SolveScratch& scratch, Arena& arena, TaskSystem& tasks,
                const ContactKernels& kernels, float seconds) {
  const SolverSettings* const row_solver = row_solver_of(w);
  const SubStepping plan = plan_substeps(w, seconds, row_solver != nullptr);
  begin_bodies(w, tasks);
  begin_scratch(scratch.together);
  const bool parted = can_solve_batches_in_parallel(w, tasks);
  begin_lone(scratch, parted ? std::size_t(tasks.worker_count()) : 0);
  const ArenaScope scope(arena);
  const SolveBatches all = find_batches(w, arena, tasks, batch_size(tasks.worker_count(), parted));
  for (const SolveBatch& batch : all.batches) {
    if (parted && batch.is_small) continue;
    BatchContext solve = describe_solve(w, scratch.together, kernels, seconds, plan);
    solve.batch = batch;
    solve.places = all.places;
    if (row_solver != nullptr) {
      solve_batch_as_rows(solve, *row_solver, arena, tasks, plan.warm_scale);
    } else {
      solve_batch(solve, arena, tasks, plan.warm_scale);
    }
  }
  if (parted) {
    for_blocks(tasks, int(all.batches.size()), 1, [&](int i, int, int worker) {
      const SolveBatch& batch = all.batches[std::size_t(i)];
      if (!batch.is_small) return;
      WorkerContext& lone = *scratch.lone[std::size_t(worker)];
      BatchContext solve = describe_solve(w, lone.scratch, kernels, seconds, plan);
      solve.batch = batch;
      solve.places = all.places;
      solve_batch(solve, lone.arena, lone.tasks, plan.warm_scale);
    });
  }
  sum_up(scratch);
  if (motion_settings(w).integrator == IntegratorKind::verlet) forget_moves(w);
  report_hits(w, scratch.hits.view(), arena);
}

}  // namespace gyre
