#include "dynamics/solve_step.h"

#include "collision/contact/contact_recycle.h"
#include "dynamics/constraint_layout.h"
#include "dynamics/gather_bodies.h"
#include "dynamics/gather_constraints.h"
#include "dynamics/substep_program.h"
#include "rigid/solve/energy_limiter.h"
#include "rigid/solve/geometric_stiffness.h"
#include "task/parallel.h"

#include <bit>

namespace gyre {

namespace {

// Soft contacts: the rate (1/s) at which a new contact removes penetration, the rate (1/s) at which its impulse yields, and the half-life
// (s) of its softness. docs/decisions/contact-softness.md tells how they were found.
constexpr float kContactRate = 9.0f;
constexpr float kContactLeak = 44.0f;
constexpr float kContactAging = 0.25f;
// A sub-step is solved in half-steps: one iteration over the constraints, then all bodies move. Two short ones are four times as stiff as
// two iterations at one pose.
constexpr int kHalfStepsPerSubstep = 2;
// Joints: the rate (1/s) at which errors are removed, and the rate (1/s) at which impulses yield. The second is a little more than half of
// the first, because iterations lag behind (the same page). Neither depends on the sub-step.
constexpr float kJointRate = 40.0f;
constexpr float kJointLeak = 22.0f;
// Compliance of articulations as a share of the effective inverse mass. They are solved exactly, so this need only decide among redundant
// rows (docs/decisions/articulations.md).
constexpr float kArticulationCompliance = 1.0e-4f;
// Least closing speed for restitution, in speeds that gravity gives in a sub-step.
constexpr float kBounceShare = 2.0f;

// Largest factor by which impulses grow from one step to the next, or from one piece of an adaptive step to the next. In a very short one
// they are mostly those of an impact, which does not last, and rounding.
constexpr float kMaxWarm = 4.0f;

// ------------------------------------------------------------------------------------------------------- islands at rest

// True if every contact has a jointed body. Then no island counts as resting.
bool all_contacts_are_jointed(const BatchContext& batch, Arena& arena) {
  const JointSolve& joints = batch.joints;
  if (joints.edges.empty()) return false;
  const ArenaScope scope(arena);
  const std::span<std::uint8_t> jointed = arena.make<std::uint8_t>(batch.members.bodies.size());
  for (std::uint8_t& one : jointed) one = 0;
  for (const JointEdge& joint : joints.edges)
    for_moving(joint, [&](std::uint32_t body) { jointed[batch.local_index[body]] = 1; });
  const auto is_jointed = [&](std::uint32_t body) {
    return body != ColoringPair::kNone && jointed[body] != 0;
  };
  for (const ColoringPair& pair : batch.scratch.contacts.pairs)
    if (!is_jointed(pair.a) && !is_jointed(pair.b)) return false;
  return true;
}
// Finds the resting islands, which are solved directly.
void find_resting(BatchContext& batch, Arena& arena) {
  ContactSolve& contacts = batch.contacts;
  contacts.forest = {};
  contacts.structures = {};
  if (batch.has_soft()) return;  // loads by soft matter are none that the direct solvers know
  const std::span<ContactConstraint> constraints = contacts.lists.constraints.view();
  if (constraints.empty() || !(length(batch.w.settings.gravity) > 0.0f)) return;
  if (all_contacts_are_jointed(batch, arena)) return;
  const std::span<const ColoringPair> pairs = contacts.lists.pairs;
  const RestingIslands islands(batch.w, constraints, pairs, batch.joints.edges, batch.members,
                               batch.local_index, arena);
  contacts.forest = find_resting_trees(batch.w, constraints, pairs, batch.members, islands, arena);
  contacts.structures = find_resting_structures(batch.w, pairs, batch.members, islands, arena);
}
void lay_out_resting(ContactSolve& s, Arena& arena) {
  if (s.forest.nodes.empty() && s.structures.empty()) return;
  const int width = s.kernels.width;
  const std::span<const std::uint32_t> places =
      find_kernel_positions(s.lists.order, s.lists.constraints.size(), arena);
  set_tree_positions(s.forest, places, width);
  set_structure_positions(s.structures, places, width);
  const ContactKernels* const kernels = &s.kernels.contacts;
  s.tree_solve = {s.forest.nodes, s.forest.work, s.lists.constraints, s.bodies.motion,
                  kernels,        s.blocks,      s.settings.step};
  s.structure_solve = {s.lists.constraints, s.bodies.motion, kernels, s.blocks, &arena};
}

// ---------------------------------------------------------------------------------------------------------------- joints

// By index in the batch: 1 for bodies in contact, kPressesHeld for those that press a held body.
std::span<const std::uint8_t> find_bodies_in_contact(const BatchContext& batch, Arena& arena) {
  const std::span<const ColoringPair> pairs = batch.scratch.contacts.pairs;
  if (pairs.empty() || batch.joints.edges.empty()) return {};
  const std::span<std::uint8_t> in_contact = arena.make<std::uint8_t>(batch.members.bodies.size());
  for (std::uint8_t& one : in_contact) one = 0;
  for (const ColoringPair& pair : pairs) {
    if (pair.a != ColoringPair::kNone) in_contact[pair.a] = 1;
    if (pair.b != ColoringPair::kNone) in_contact[pair.b] = 1;
  }
  const std::span<const std::uint8_t> pressing = batch.contacts.held.pressing;
  for (std::size_t i = 0; i < pressing.size(); ++i)
    if (pressing[i] != 0) in_contact[i] = kPressesHeld;
  return in_contact;
}

// Begins the joints and finds the articulations. Joints in lanes need no JointConstraint: most joints of articulations, and those of a
// graph that is known to be iterative.
void begin_joints(BatchContext& batch, Arena& arena) {
  JointSolve& s = batch.joints;
  DenseGraphCache& nets = s.lists.dense_graphs;
  s.all_iterative = !s.edges.empty() && nets.contains(s.edges);
  s.articulations = s.all_iterative
                        ? no_articulations(s.edges.size(), arena)
                        : find_articulations(s.w, s.batch, s.local_index, s.edges,
                                             find_bodies_in_contact(batch, arena), s.lane_start, nets, arena);
  s.works = begin_joints(s.w, s.batch, prepared_in_simd(s), s.lane_start.warm_scale, arena);
}
void prepare_articulations(JointSolve& s, std::size_t workers, Arena& arena) {
  s.articulation_solve = {.records = s.w.joints.records,
                          .work = s.works.work,
                          .offsets = s.works.places,
                          .bodies = s.bodies,
                          .settings = s.settings,
                          .compliance = kArticulationCompliance};
  s.articulation_solve.settings.iterative = false;
  attach_drives(s.articulations, s.works.work, arena);
  s.limit_rooms = find_limits(s.articulations, s.works.work, workers, arena);
  s.bundles = lay_out_bundles(
      s.articulations, s.kernels, {s.bodies.motion, s.bodies.inertia, s.bodies.orientation},
      {s.settings.substep, s.settings.softness.bias_rate, kArticulationCompliance, add_geometric_stiffness},
      arena);
}

// --------------------------------------------------------------------------------------------------------------- a batch

void color(const BatchContext& batch, std::span<const ColoringPair> pairs,
           std::span<const std::uint32_t> names, Coloring& colors) {
  color_constraints(pairs, names, std::uint32_t(batch.members.bodies.size()), {}, kColoringOptions, colors);
}

// Gathers the constraints, their pairs, and the workers' shares.
void gather_constraints(BatchContext& batch, Arena& arena, TaskSystem& tasks) {
  gather_contacts(batch, arena, tasks);
  gather_joint_edges(batch, arena, tasks);
  ContactSolve& contacts = batch.contacts;
  contacts.rolling = find_rolling_contacts(batch.w, batch.scratch.contacts, batch.members.bodies,
                                           contacts.settings.step, arena, tasks);
  for (const RollingContact& rolling : contacts.rolling.contacts)
    contacts.lists.constraints[rolling.constraint].speculative = false;
  batch.partition = partition_bodies(batch.scratch.contacts.pairs, batch.members.bodies.size(),
                                     tasks.worker_count(), arena);
}

// Finds held bodies. Their contacts are solved to the end in each half-step, so they need no spring.
void find_held(BatchContext& batch, Arena& arena) {
  ContactSolve& contacts = batch.contacts;
  contacts.held = find_held_bodies(batch.w, batch.members, batch.local_index, batch.joints.edges,
                                   contacts.lists.pairs, arena);
  const std::span<const std::uint8_t> held = contacts.held.contacts;
  for (std::size_t i = 0; i < held.size(); ++i)
    if (held[i] != 0) contacts.lists.constraints[i].rigid = true;
}

// Chooses how constraints are solved: directly or iteratively, in which colours, and contacts in which lanes. Joints and resting islands
// are found in parallel to contacts.
void color_constraints(BatchContext& batch, Arena& arena, TaskSystem& tasks) {
  BatchScratch& scratch = batch.scratch;
  const std::span<ContactGroup> room = arena.make<ContactGroup>(kMaxGroups);
  find_held(batch, arena);
  if (batch.partition.count() > 1)
    batch.group_bounds = arena.make<int>(kMaxGroups * std::size_t(batch.partition.count() + 1));
  run_parallel(
      tasks,
      [&] {
        begin_joints(batch, arena);
        gather_swept_joints(batch);
        color(batch, scratch.joints.pairs, {}, scratch.joint_colors);
        find_resting(batch, arena);
      },
      [&] {
        color(batch, scratch.contacts.pairs, scratch.contacts.slots, scratch.contact_colors);
        batch.contact_groups = lay_out_contacts(batch, room);
      });
}

// Each function uses the results of those before it.
void prepare_batch(BatchContext& batch, Arena& arena, TaskSystem& tasks) {
  BodyMotionSolve& motion = batch.motion;
  JointSolve& joints = batch.joints;
  if (motion.is_smooth)
    motion.smooth = find_smooth_motion(batch.w, batch.members, batch.local_index, motion.motions.count,
                                       motion.motions.substep, arena);
  motion.fields =
      find_field_bodies(batch.w, batch.members.bodies, motion.motions.substep, arena, !motion.is_smooth);
  prepare_articulations(joints, std::size_t(tasks.worker_count()), arena);
  joints.stiffened = find_stiffened_bodies(joints, arena);
  joints.islands = find_joint_islands(joints, batch.scratch.contacts.pairs, motion.fields.bodies, arena);
  gather_bodies(batch, arena, tasks);
  disable_gyroscopic_torque(joints, motion.moved, arena);
  make_contact_blocks(batch, arena);
  lay_out_resting(batch.contacts, arena);
  lay_out_joints(batch, arena);
}

void finish_batch(BatchContext& batch, Arena& arena, TaskSystem& tasks) {
  BatchScratch& scratch = batch.scratch;
  const JointSolve& joints = batch.joints;
  restore_inertia(joints);
  finish_joints(batch.w, batch.members, prepared_in_simd(joints), joints.works.work);
  forget_limited_impulses(joints);
  if (batch.motion.is_smooth) finish_springs(batch.w, batch.motion.smooth, scratch.report);
  find_hits(batch.w, scratch.contacts, scratch.hits, arena, tasks);
  scratch.counts.manifolds += scratch.contacts.constraints.size();
  scratch.counts.joints += batch.members.joints.size();
  scratch.counts.swept_joints += scratch.joints.swept.size();
}

void solve_batch(BatchContext& batch, Arena& arena, TaskSystem& tasks) {
  const ArenaScope scope(arena);
  gather_constraints(batch, arena, tasks);
  color_constraints(batch, arena, tasks);
  prepare_batch(batch, arena, tasks);
  run_substeps(batch, arena, tasks);
  finish_batch(batch, arena, tasks);
}

// ------------------------------------------------------------------------------------------------------ a batch, as rows

// Marks the bodies as read: rows read their poses in each half-step.
void show_bodies(const BatchContext& batch) {
  RigidWorld& w = batch.w;
  for (const std::uint32_t slot : batch.members.joints) {
    const JointRecord& joint = w.joints.records[slot];
    if (joint.body_a != kNoBody) w.bodies.flags[std::size_t(joint.body_a)].constraint_use = kPoseRead;
    if (joint.body_b != kNoBody) w.bodies.flags[std::size_t(joint.body_b)].constraint_use = kPoseRead;
  }
  for (const std::uint32_t body : batch.members.bodies) {
    std::uint8_t& touched = w.bodies.flags[body].constraint_use;
    if (touched != kNotConstrained) touched = kPoseRead;
  }
}

// Solves a batch with the row solvers: without colours, and each island by one worker.
void solve_batch_as_rows(BatchContext& batch, const SolverSettings& settings, Arena& arena,
                         TaskSystem& tasks) {
  const ArenaScope scope(arena);
  BatchScratch& scratch = batch.scratch;
  JointSolve& joints = batch.joints;
  gather_contacts(batch, arena, tasks);
  for (const ContactConstraint& constraint : scratch.contacts.constraints)
    constraint.manifold->total_friction = {};
  show_bodies(batch);
  batch.motion.fields = find_field_bodies(batch.w, batch.members.bodies, batch.motion.motions.substep, arena);
  joints.works = begin_joints(batch.w, batch.members, {}, joints.lane_start.warm_scale, arena);
  gather_bodies(batch, arena, tasks);
  RowSolve rows = begin_row_solve(batch.contacts, joints, settings, std::size_t(tasks.worker_count()), arena);
  batch.rows = &rows;
  run_substeps(batch, arena, tasks);
  finish_row_solve(rows, scratch.rows);
  finish_joints(batch.w, batch.members, {}, joints.works.work);
  // Rows have no colours, and empty pairs tell later code so.
  scratch.contacts.pairs.clear();
  scratch.joints.pairs.clear();
  find_hits(batch.w, scratch.contacts, scratch.hits, arena, tasks);
  scratch.counts.manifolds += scratch.contacts.constraints.size();
  scratch.counts.joints += batch.members.joints.size();
}

// ---------------------------------------------------------------------------------------------------------------- a step

// The half-steps of a step.
struct HalfStepping {
  int count = 0;
  float h = 0.0f;  // s, duration of each
  float warm_scale = 0.0f;
  int parts = 1;  // half-steps of a sub-step
};

HalfStepping plan_half_steps(RigidWorld& w, float seconds, bool by_rows) {
  HalfStepping plan;
  plan.parts = by_rows ? 1 : kHalfStepsPerSubstep;
  plan.count = plan.parts * w.settings.substeps;
  plan.h = seconds / float(plan.count);
  plan.warm_scale = w.settings.last_substep > 0.0f ? min(plan.h / w.settings.last_substep, kMaxWarm) : 0.0f;
  w.settings.last_substep = plan.h;
  w.settings.last_step = seconds;
  return plan;
}

ContactSettings contact_settings(const RigidWorld& w, float seconds, const HalfStepping& plan) {
  const float h = plan.h, gravity = length(w.settings.gravity);
  return {.substep = h,
          .step = seconds,
          .rate = min(kContactRate, 0.8f / h),
          .compliance = kContactLeak * h / (1.0f + kContactLeak * h),
          .aging = kContactAging,
          .warm_scale = plan.warm_scale,
          .up = gravity > 0.0f ? (-1.0f / gravity) * w.settings.gravity : Vec3{}};
}
// A long half-step removes at most the whole error and yields by less than the whole impulse.
JointSettings joint_settings(const RigidWorld& w, float h) {
  const float compliance = kJointLeak * h / (1.0f + kJointLeak * h);
  return {h, {min(kJointRate, 0.8f / h), 1.0f - compliance, compliance}, row_solver_of(w) == nullptr};
}

// The context of a batch before it is gathered.
BatchContext describe_batch(RigidWorld& w, BatchScratch& scratch, const SolverKernels& kernels,
                            const SolveBatch& members, std::span<const std::uint32_t> local_index,
                            float seconds, const HalfStepping& plan) {
  BatchContext batch{.w = w,
                     .scratch = scratch,
                     .kernels = kernels,
                     .members = members,
                     .local_index = local_index,
                     .contacts = {w, scratch.contacts, kernels},
                     .joints = {w, scratch.joints, kernels, members, local_index},
                     .motion = {w, kernels}};
  BodyMotion* const motion = w.bodies.motion.data();
  BodyInertia* const inertia = w.bodies.inertia.data();
  Quat* const orientations = w.bodies.orientations.data();
  batch.contacts.settings = contact_settings(w, seconds, plan);
  batch.contacts.impact_settings = {plan.h, kBounceShare * plan.h * length(w.settings.gravity)};
  batch.contacts.bodies = {motion, inertia};
  batch.contacts.update_views = select_recycling(kernels.width);
  batch.joints.settings = joint_settings(w, plan.h);
  batch.joints.bodies = {motion, inertia, orientations};
  batch.joints.lane_start = {
      .warm_scale = plan.warm_scale, .substep = plan.h, .softness = batch.joints.settings.softness};
  batch.motion.motions = {plan.count, plan.h, w.settings.gravity};
  batch.motion.arrays = {motion, inertia, orientations};
  batch.motion.is_smooth = !w.motion_settings.empty();
  return batch;
}

void begin_bodies(RigidWorld& w, TaskSystem& tasks) {
  for_blocks(tasks, int(w.bodies.awake.size()), kBodiesPerBlock, [&](int begin, int end, int) {
    for (std::size_t i = std::size_t(begin); i < std::size_t(end); ++i) {
      const std::uint32_t body = w.bodies.awake[i];
      w.bodies.flags[body].constraint_use = 0;
      w.bodies.motion[body].delta_position = {};
      w.bodies.motion[body].delta_rotation = {};
      w.bodies.motion[body].pushout = 0.0f;
    }
  });
  w.field_rest.clear();
  if (!w.fields.empty()) w.field_rest.resize(w.bodies.motion.size());
  if (motion_settings(w).integrator == IntegratorKind::verlet)
    w.bodies.last_moves.resize(w.bodies.motion.size());
}

void add_soft(BatchContext& batch, SoftStore& soft, const FluidStore& fluids, SoftScratch& scratch,
              const HalfStepping& plan, TaskSystem& tasks) {
  batch.soft = {.w = &batch.w,
                .store = &soft,
                .fluids = &fluids,
                .scratch = &scratch,
                .kernels = &select_soft_kernels(batch.kernels.width),
                .members = scratch.slots,
                .h = float(plan.parts) * plan.h,
                .parts = plan.parts,
                .warm_scale = plan.warm_scale,
                .tasks = &tasks,
                .time = batch.w.now};
  make_soft_rows(batch.soft);
}

// The bodies that soft matter or couplings unite in one batch.
std::span<const std::uint32_t> list_united(const RigidWorld& w, SolveScratch& scratch) {
  if (w.couplings.empty()) return scratch.soft.touched.view();
  scratch.united.clear();
  scratch.united.append(scratch.soft.touched);
  list_coupled_bodies(w, scratch.united);
  return scratch.united.view();
}
void add_couplings(BatchContext& batch, CouplingSolve& couplings, const HalfStepping& plan) {
  if (batch.w.couplings.empty()) return;
  begin_couplings(couplings, batch.w, plan.h, batch.joints.settings.softness.bias_rate, plan.warm_scale);
  if (!couplings.empty()) batch.couplings = &couplings;
}

void begin_scratch(BatchScratch& scratch) {
  scratch.hits.clear();
  scratch.counts = {};
  scratch.report = {};
  scratch.rows = {};
}

// Constrained bodies have their velocities from the constraints, so their last moves are forgotten.
void forget_moves(RigidWorld& w) {
  for (const std::uint32_t body : w.bodies.awake) {
    if (w.bodies.flags[body].constraint_use != kNotConstrained) w.bodies.last_moves[body] = {};
  }
}

// True if workers may solve batches in parallel. Only one worker may combine the results of fields, of other solvers and of other
// integration schemes.
bool may_share_batches(const RigidWorld& w, const TaskSystem& tasks) {
  return tasks.worker_count() > 1 && w.fields.empty() && w.motion_settings.empty() &&
         row_solver_of(w) == nullptr;
}

void make_as_roomy(WorkerContext& worker, const WorkerContext& other) {
  const auto even = [](auto& array, const auto& its) { array.reserve(its.capacity()); };
  const auto even_colors = [&](Coloring& coloring, const Coloring& its) {
    even(coloring.color, its.color), even(coloring.order, its.order);
    even(coloring.offsets, its.offsets), even(coloring.masks, its.masks);
  };
  BatchScratch& to = worker.scratch;
  const BatchScratch& from = other.scratch;
  even(to.contacts.constraints, from.contacts.constraints), even(to.contacts.slots, from.contacts.slots);
  even(to.contacts.impacts, from.contacts.impacts), even(to.contacts.pairs, from.contacts.pairs);
  even(to.contacts.order, from.contacts.order), even(to.contacts.members, from.contacts.members);
  even_colors(to.contact_colors, from.contact_colors), even_colors(to.joint_colors, from.joint_colors);
  even(to.joints.swept, from.joints.swept), even(to.joints.pairs, from.joints.pairs),
      even(to.hits, from.hits);
  worker.arena.expect(other.arena.peak());
}

// Chance decides which worker solves a batch. Each worker gets as much memory as any of them needed, so a world of constant size does not
// allocate.
void begin_workers(SolveScratch& scratch, std::size_t count) {
  while (scratch.workers.size() > count) scratch.workers.pop_back();
  while (scratch.workers.size() < count) scratch.workers.push_back(std::make_unique<WorkerContext>());
  for (const std::unique_ptr<WorkerContext>& each : scratch.workers)
    make_as_roomy(*scratch.workers[0], *each);
  for (const std::unique_ptr<WorkerContext>& each : scratch.workers)
    make_as_roomy(*each, *scratch.workers[0]);
  // The arenas start over after all workers have been compared, because an arena that starts over forgets its need.
  for (const std::unique_ptr<WorkerContext>& each : scratch.workers) {
    begin_scratch(each->scratch);
    each->arena.reset();
  }
}

// Adds up the results of all batches.
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
  for (const std::unique_ptr<WorkerContext>& each : scratch.workers) add(each->scratch);
  scratch.colors = std::popcount(scratch.counts.colors_used);
  scratch.report = scratch.together.report;
  scratch.rows = scratch.together.rows;
}

}  // namespace

void solve_step(RigidWorld& w, SoftStore& soft, const FluidStore& fluids, SolveScratch& scratch, Arena& arena,
                TaskSystem& tasks, const SolverKernels& kernels, float seconds) {
  const SolverSettings* const row_solver = row_solver_of(w);
  const HalfStepping plan = plan_half_steps(w, seconds, row_solver != nullptr);
  begin_bodies(w, tasks);
  begin_scratch(scratch.together);
  const bool shared = may_share_batches(w, tasks);
  begin_workers(scratch, shared ? std::size_t(tasks.worker_count()) : 0);
  const ArenaScope scope(arena);
  scratch.soft.slots.clear(), scratch.soft.touched.clear();
  if (!soft.empty()) gather_soft(w, soft, scratch.soft, arena);
  const std::span<const std::uint32_t> united = list_united(w, scratch);
  const IslandBatches all = find_batches(w, united, arena, tasks, batch_size(tasks.worker_count(), shared));
  const auto describe = [&](const IslandBatch& members, BatchScratch& own) {
    return describe_batch(w, own, kernels, members, all.local_index, seconds, plan);
  };
  const auto solve_together = [&](const IslandBatch& members, bool is_united) {
    BatchContext batch = describe(members, scratch.together);
    const bool has_soft = is_united && !scratch.soft.slots.empty();
    if (has_soft) add_soft(batch, soft, fluids, scratch.soft, plan, tasks);
    if (is_united) add_couplings(batch, scratch.couplings, plan);
    if (row_solver != nullptr) {
      solve_batch_as_rows(batch, *row_solver, arena, tasks);
    } else {
      solve_batch(batch, arena, tasks);
    }
    if (has_soft) keep_soft_rows(batch.soft);
  };
  // Soft matter that touches no moving body has a batch of its own.
  if (!scratch.soft.slots.empty() && all.united < 0) solve_together({}, true);
  for (std::size_t i = 0; i < all.batches.size(); ++i) {
    const bool is_united = int(i) == all.united;
    if (!shared || !all.batches[i].is_small || is_united) solve_together(all.batches[i], is_united);
  }
  if (shared) {
    for_blocks(tasks, int(all.batches.size()), 1, [&](int i, int, int worker) {
      const IslandBatch& members = all.batches[std::size_t(i)];
      if (!members.is_small || i == all.united) return;
      WorkerContext& own = *scratch.workers[std::size_t(worker)];
      BatchContext batch = describe(members, own.scratch);
      solve_batch(batch, own.arena, own.tasks);
    });
  }
  sum_up(scratch);
  if (motion_settings(w).integrator == IntegratorKind::verlet) forget_moves(w);
  report_hits(w, scratch.hits.view(), arena);
}

}  // namespace gyre
