// Builds the program of a batch (task/program.h) line by line. A line is a stage: a function of a context and of blocks [begin, end), for
// all blocks of one kind. A kind without blocks gets no line.
#pragma once

#include "base/check.h"
#include "base/noinline.h"
#include "dynamics/batch_context.h"
#include "rigid/solve/joint_stages.h"
#include "rigid/solve/motion_stages.h"
#include "task/program.h"

#include <type_traits>

namespace gyre {

// Adapts a function of a context to a stage.
template <auto stage, class Context>
void run_stage(void* context, int begin, int end, int worker) {
  if constexpr (std::is_invocable_v<decltype(stage), Context&, int, int, int>)
    stage(*static_cast<Context*>(context), begin, end, worker);
  else
    stage(*static_cast<Context*>(context), begin, end);
}

// Iterations over the contacts of held bodies in a half-step (docs/decisions/held-bodies.md).
constexpr std::size_t kHeldIterations = 20;

class ProgramBuilder {
 public:
  ProgramBuilder(BatchContext& batch, int half_steps, Arena& arena);

  // Add lines for constrained bodies: all; those whose contact change is measured; those that the kernels do not rotate; and all again, for
  // orientations.
  template <auto stage>
  void bodies() {
    add(run_stage<stage, BodyMotionSolve>, &batch_.motion, bodies_, kBodyBlocksPerClaim, batch_.moved_bounds);
  }
  template <auto stage>
  void measured_bodies() {
    add(run_stage<stage, BodyMotionSolve>, &batch_.motion, batch_.motion.measured_blocks, kBodyBlocksPerClaim,
        batch_.motion.measured_blocks == bodies_ ? batch_.moved_bounds : nullptr);
  }
  template <auto stage>
  void spinning_bodies() {
    add(run_stage<stage, BodyMotionSolve>, &batch_.motion, fast_spinning_);
  }
  template <auto stage>
  void orientations() {
    add(run_stage<stage, BodyMotionSolve>, &batch_.motion, orientations_);
  }
  // Add lines for free bodies, for systems of these that springs couple, and for the springs to constrained bodies.
  template <auto stage>
  void free_bodies() {
    add(run_stage<stage, BodyMotionSolve>, &batch_.motion, free_bodies_);
  }
  template <auto stage>
  void spring_systems() {
    add(run_stage<stage, SmoothMotion>, &batch_.motion.smooth, batch_.motion.smooth.count());
  }
  template <auto stage>
  void coupled_spring_systems() {
    if (batch_.motion.smooth.any_carried) spring_systems<stage>();
  }
  template <auto stage>
  void coupling_springs() {
    if (batch_.motion.smooth.any_carried) add(run_stage<stage, SmoothMotion>, &batch_.motion.smooth, 1);
  }
  // Adds a line for bodies on which fields act.
  template <auto stage>
  void field_bodies() {
    add(run_stage<stage, FieldSolve>, &batch_.motion.fields, fields_);
  }

  // Add lines for contacts: by colour; of held bodies; for all blocks; for those with restitution; for resting islands.
  template <auto stage>
  void contacts() {
    for (ContactGroup& group : batch_.contact_groups)
      add_group(run_stage<stage, ContactGroup>, group, int(group.count), kContactBlocksPerClaim);
  }
  template <auto stage>
  void held_contacts(std::size_t iterations) {
    for (std::size_t i = 0; i < iterations; ++i)
      for (ContactGroup& group : batch_.contact_groups)
        if (group.held)
          add_group(run_stage<stage, ContactGroup>, group, int(group.count), kContactBlocksPerClaim);
  }
  template <auto stage>
  void contact_blocks() {
    add(run_stage<stage, ContactSolve>, &batch_.contacts, contact_blocks_, kContactBlocksPerClaim);
  }
  template <auto stage>
  void impacts() {
    add(run_stage<stage, ContactSolve>, &batch_.contacts, impacts_);
  }
  template <auto stage>
  void resting_trees() {
    add(run_stage<stage, ContactSolve>, &batch_.contacts, trees_, kTreesPerClaim);
  }
  template <auto stage>
  void resting_structures() {
    add(run_stage<stage, ContactSolve>, &batch_.contacts, structures_);
  }

  // Add lines for iterative joints: by colour, or for all colours at once if each joint writes only its own data.
  template <auto stage>
  void joints() {
    for (JointGroup& group : batch_.joints.groups)
      add_group(run_stage<stage, JointGroup>, group, count_blocks(int(group.count), kJointsPerBlock),
                kJointBlocksPerClaim);
  }
  template <auto stage>
  void all_joints() {
    add(run_stage<in_joint_slices<stage>, JointSolve>, &batch_.joints, joint_slices_, kSlicesPerClaim);
  }
  // Add lines for scalar articulations, and for bundles of grouped ones.
  template <auto stage>
  void articulations() {
    add(run_stage<for_articulations<stage>, JointSolve>, &batch_.joints, articulations_);
  }
  template <BundleKernel... stages>
  void simd_articulations() {
    add(run_stage<for_simd_articulations<stages...>, JointSolve>, &batch_.joints, simd_articulations_);
  }
  template <auto stage>
  void simd_articulation_lanes() {
    add(run_stage<stage, JointSolve>, &batch_.joints, simd_articulations_);
  }
  // Add lines for the energy limiter's islands, and for bodies with geometric stiffness.
  template <auto stage>
  void joint_islands() {
    add(run_stage<stage, JointSolve>, &batch_.joints, joint_islands_);
  }
  template <auto stage>
  void stiffened_bodies() {
    add(run_stage<stage, JointSolve>, &batch_.joints, stiffened_);
  }

  // Adds a line for all soft matter. Its stage divides the work among the workers by itself.
  template <auto stage>
  void soft() {
    if (!batch_.has_soft()) return;
    add(run_stage<stage, SoftSolve>, &batch_.soft, 1);
    room_[used_ - 1].starts_work = true;
  }

  // Adds a line for all couplings.
  template <auto stage>
  void couplings() {
    if (batch_.couplings != nullptr) add(run_stage<stage, CouplingSolve>, batch_.couplings, 1);
  }

  // Adds a line for islands whose constraints are solved as rows.
  template <auto stage>
  void row_islands() {
    add(run_stage<stage, RowSolve>, batch_.rows, row_islands_);
  }

  // Adds several stages of articulations and their bodies as one line, run by run.
  template <void (FusedRun::*... stages)() const>
  void fused() {
    for (FusedRuns& line : batch_.fused_runs)
      add(run_stage<in_runs<stages...>, FusedRuns>, &line, int(line.runs.size()));
  }

  bool is_fused() const { return is_fused_; }
  bool has_swept_joints() const { return joint_slices_ > 0; }
  bool has_joints() const { return articulations_ > 0 || simd_articulations_ > 0 || has_swept_joints(); }
  // Soft matter moves once in a whole sub-step. True for its first half-step.
  bool begins_soft(int half_step) const { return half_step % batch_.soft.parts == 0; }
  bool is_solved_as_rows() const { return batch_.rows != nullptr; }
  bool has_fields() const { return fields_ > 0; }
  // True if no stage comes between forces and the warm start of bodies.
  bool can_warm_start_with_forces() const {
    return impacts_ == 0 && articulations_ == 0 && !has_swept_joints();
  }

  std::span<const Stage> stages() const { return room_.first(used_); }

 private:
  static constexpr int kBodyBlocksPerClaim = 4, kContactBlocksPerClaim = 2, kJointBlocksPerClaim = 2,
                       kSlicesPerClaim = 2, kTreesPerClaim = 8;

  // (Out of line, because fifty places call it.)
  GYRE_COLD void add(void (*kernel)(void*, int, int, int), void* context, int blocks, int per_claim = 1,
                     const int* bounds = nullptr) {
    if (blocks == 0) return;
    GYRE_ASSERT(used_ < room_.size(), "the program has more stages than were counted");
    room_[used_++] = {kernel, context, blocks, per_claim, bounds};
  }
  // Overflow groups, whose blocks share bodies, run in one claim.
  template <class Group>
  void add_group(void (*kernel)(void*, int, int, int), Group& group, int blocks, int per_claim) {
    add(kernel, &group, blocks, group.serial ? blocks : per_claim, group.bounds);
  }

  BatchContext& batch_;
  // Numbers of blocks of each kind.
  int bodies_, fast_spinning_, orientations_, free_bodies_, fields_;
  int contact_blocks_ = 0, impacts_, trees_, structures_;
  int joint_slices_, articulations_, simd_articulations_, joint_islands_, stiffened_;
  int row_islands_;
  bool is_fused_;
  std::span<Stage> room_;
  std::size_t used_ = 0;
};

}  // namespace gyre
