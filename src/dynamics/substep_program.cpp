// Writes the order of a step as the lines of a program. See substep_program.h.
#include "dynamics/substep_program.h"

#include "dynamics/program_builder.h"
#include "rigid/solve/contact_stages.h"
#include "rigid/solve/energy_limiter.h"
#include "rigid/solve/geometric_stiffness.h"

namespace gyre {

namespace {

using Simd = ArticulationKernels;

// Runs once before all half-steps: free bodies move for the whole step, and all else is prepared.
void add_preparation(ProgramBuilder& p) {
  p.free_bodies<move_free_bodies>();
  p.spring_systems<move_spring_systems>();
  if (!p.is_fused()) p.bodies<prepare_bodies>();
  p.stiffened_bodies<stiffen_bodies>();
  p.field_bodies<prepare_field_bodies>();
  p.contact_blocks<prepare_contacts>();
  p.all_joints<begin_ball_joints>();
  p.all_joints<prepare_joints>();
  p.articulations<prepare_articulation>();
  if (!p.is_fused()) p.simd_articulation_lanes<begin_simd_articulations>();
  if (!p.is_fused()) p.simd_articulations<&Simd::prepare>();
  p.row_islands<prepare_row_joints>();
}

// If no joint was relaxed since, joints are prepared in the same line, while their rows are in the cache.
void add_relaxation_of_simd(ProgramBuilder& p, bool are_prepared, bool last) {
  if (are_prepared && !last) p.simd_articulations<&Simd::end_half_step>();
  if (are_prepared && last) p.simd_articulations<&Simd::end_step>();
  if (!are_prepared && !last) p.simd_articulations<&Simd::prepare, &Simd::end_half_step>();
  if (!are_prepared && last) p.simd_articulations<&Simd::prepare, &Simd::end_step>();
}

// A fused batch before the contacts of the first half-step, and after those of each.
void add_first_fused(ProgramBuilder& p) {
  p.fused<&FusedRun::prepare, &FusedRun::prepare_joints, &FusedRun::apply_forces,
          &FusedRun::compute_joint_bias>();
  p.contacts<warm_start_contacts>();
  p.fused<&FusedRun::add_first_contact_change, &FusedRun::solve_joints_first>();
}
void add_fused_after_contacts(ProgramBuilder& p, bool last) {
  if (last)
    return p.fused<&FusedRun::add_contact_change, &FusedRun::solve_joints_after_contacts,
                   &FusedRun::integrate_positions, &FusedRun::prepare_joints, &FusedRun::relax_joints_last,
                   &FusedRun::finish>();
  p.fused<&FusedRun::add_contact_change, &FusedRun::solve_joints_after_contacts,
          &FusedRun::integrate_positions, &FusedRun::prepare_joints, &FusedRun::relax_joints,
          &FusedRun::apply_forces_and_warm_start, &FusedRun::solve_joints>();
}

// All contacts once; those of held bodies again and again.
void add_contacts(ProgramBuilder& p) {
  p.contacts<solve_contacts>();
  p.held_contacts<solve_contacts_again>(kHeldIterations - 1);
}

// One half-step: forces, warm start, joints, contacts, positions, relaxation. Kinds without blocks get no line. In a fused batch all stages
// from the contacts of one half-step to those of the next are one line, run by run (dynamics/fused_stages.h).
void add_half_step(ProgramBuilder& p, int half_step, int count) {
  const bool first = half_step == 0, last = half_step + 1 == count;
  const bool fused = p.is_fused(), has_swept = p.has_swept_joints(), has_joints = p.has_joints();
  const bool warm_start_with_forces = !first && p.can_warm_start_with_forces();
  if (fused && first) add_first_fused(p);
  if (!fused) {
    // Forces, and restitution of points that meet in this half-step.
    p.field_bodies<record_field_velocities>();
    p.impacts<record_contact_approach>();
    p.coupled_spring_systems<move_coupled_spring_systems>();
    p.coupling_springs<apply_spring_impulses>();
    if (warm_start_with_forces) p.bodies<apply_forces_and_warm_start>();
    if (!warm_start_with_forces) p.bodies<apply_forces>();
    p.impacts<apply_contact_restitution>();
    // Warm start. Joints come before contacts, so that their impulses are not counted as contact change.
    p.all_joints<compute_second_order_bias>();
    p.joint_islands<begin_warm_start_energy>();
    p.articulations<warm_start_articulation>();
    if (first) p.simd_articulations<&Simd::compute_bias>();  // later ones: at the end of the half-step before
    p.joints<warm_start_joints>();
    p.joint_islands<limit_energy_gain>();
    p.couplings<warm_start_couplings>();
    if (!first && !warm_start_with_forces) p.measured_bodies<warm_start_bodies>();
    if (first) p.measured_bodies<start_contact_change>();
    if (first) p.contacts<warm_start_contacts>();
    if (first || p.is_solved_as_rows()) p.soft<warm_start_soft_rows>();
    if (first) p.measured_bodies<add_contact_change>();
    // Fields come after the warm start, because a stream acts on the true velocity.
    p.field_bodies<apply_field_forces>();
    if (p.has_fields()) p.measured_bodies<start_contact_change>();
    // Joints.
    p.joint_islands<begin_energy_gain>();
    p.joints<solve_joints>();
    p.articulations<solve_articulation>();
    p.simd_articulations<&Simd::solve>();
    p.joint_islands<limit_energy_gain>();
    p.couplings<solve_couplings>();
    if (has_joints) p.measured_bodies<start_contact_change>();
  }
  // Contacts, or all constraints as rows. Resting islands are solved directly in the first half-step, for the loads of this step, and in
  // the last, so that they end at rest. No change is left in between.
  if (first) p.row_islands<solve_row_islands_first>();
  if (!first) p.row_islands<solve_row_islands>();
  add_contacts(p);
  // Soft matter, with bodies as joints and contacts leave them.
  if (p.begins_soft(half_step)) p.soft<turn_soft_rows>();
  if (p.begins_soft(half_step)) p.soft<begin_soft_members>();
  if (p.begins_soft(half_step)) p.soft<solve_soft_contacts>();
  if (p.begins_soft(half_step)) p.soft<solve_soft_rows>();
  if (first || last) p.resting_trees<solve_resting_trees>();
  if (first) p.resting_structures<solve_resting_structures_first>();
  if (last) p.resting_structures<solve_resting_structures_last>();
  if (fused) return add_fused_after_contacts(p, last);
  // Articulations are solved again, so that their joints come last.
  if (has_joints) p.measured_bodies<add_contact_change>();
  p.joint_islands<begin_energy_gain>();
  p.articulations<solve_articulation_after_contacts>();
  p.simd_articulations<&Simd::solve_after_contacts>();
  p.joint_islands<limit_energy_gain>();
  p.couplings<solve_couplings_last>();
  // Positions.
  if (has_joints) p.bodies<integrate_positions>();
  if (!has_joints) p.bodies<add_contact_change_and_integrate>();
  p.spinning_bodies<integrate_fast_spinning>();
  if (p.begins_soft(half_step + 1)) p.soft<finish_soft_members>();
  if (p.begins_soft(half_step + 1)) p.soft<bound_soft_surfaces>();
  // Joints are relaxed at the present poses, so that no velocity stays from the bias.
  p.stiffened_bodies<stiffen_bodies>();
  p.all_joints<prepare_other_joints>();
  p.articulations<prepare_articulation>();
  if (has_swept) p.simd_articulations<&Simd::prepare>();
  p.joint_islands<begin_energy_gain>();
  p.joints<relax_joints>();
  p.articulations<relax_articulation>();
  add_relaxation_of_simd(p, has_swept, last);
  p.joint_islands<remove_energy_gain>();
  p.couplings<relax_couplings>();
  p.row_islands<prepare_row_joints>();
  p.row_islands<sum_row_joints>();
}

// Runs once after all half-steps: contacts without springs, so that no velocity from these stays under load; pushout, which leaves
// velocities; and the return of gathered data to its stores.
void add_completion(ProgramBuilder& p) {
  p.contacts<relax_contacts>();
  p.bodies<begin_projection>();
  p.contacts<project_contacts>();
  p.row_islands<push_row_islands_apart>();
  p.bodies<end_projection>();
  p.orientations<finish_orientations>();
  p.spring_systems<finish_spring_systems>();
  p.contact_blocks<finish_contacts>();
  if (!p.is_fused()) p.simd_articulation_lanes<finish_simd_articulations>();
  p.all_joints<finish_ball_joints>();
}

// Returns the number of first bodies whose contact change is measured: those that contacts may act on. (Measuring also clears negative
// zeros, which joints outside of lanes leave.)
std::size_t count_measured(const BatchContext& batch) {
  const JointSolve& joints = batch.joints;
  const bool has_contacts = !batch.contact_groups.empty(), has_lanes = !joints.bundles.bundles.empty(),
             has_articulations = !joints.articulations.scalar.empty();
  if (batch.rows != nullptr) return 0;
  if (batch.has_soft()) return batch.motion.moved.size();
  if (joints.groups.empty() && !has_articulations) {
    if (has_lanes) return has_contacts ? batch.moved_in_contact : 0;
    return batch.motion.moved.size();
  }
  return has_contacts || has_lanes || has_articulations ? batch.motion.moved.size() : 0;
}

}  // namespace

void run_substeps(BatchContext& batch, Arena& arena, TaskSystem& tasks) {
  const int half_steps = batch.motion.motions.count;
  batch.motion.measured_blocks = count_blocks(int(count_measured(batch)), batch.kernels.width);
  ProgramBuilder program(batch, half_steps, arena);
  add_preparation(program);
  for (int i = 0; i < half_steps; ++i) add_half_step(program, i, half_steps);
  add_completion(program);
  if (batch.has_soft()) return run_program_in_parts(tasks, program.stages());
  run_program(tasks, program.stages());
}

}  // namespace gyre
