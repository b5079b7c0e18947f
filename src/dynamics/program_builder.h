// Builds the program of a batch (task/program.h) line by line. A line is a stage: a function of a context and of blocks [begin, end), for all
// blocks of one kind. A kind of which the batch has none gets no line.
#pragma once

#include "base/check.h"
#include "base/noinline.h"
#include "dynamics/batch_context.h"
#include "rigid/solve/joint_stages.h"
#include "rigid/solve/motion_stages.h"
#include "task/program.h"

#include <type_traits>

namespace gyre {

// A function of a context as a stage.
template <auto stage, class Context>
void run_stage(void* context, int begin, int end, int worker) {
  if constexpr (std::is_invocable_v<decltype(stage), Context&, int, int, int>)
    stage(*static_cast<Context*>(context), begin, end, worker);
  else
    stage(*static_cast<Context*>(context), begin, end);
}

class ProgramBuilder {
 public:
  ProgramBuilder(BatchContext& batch, int half_steps, Arena& arena);

  // Bodies that constraints act on; of these the ones whose velocity change by contacts is measured; those whose rotation the kernels leave
  // alone; and all of them again, for orientations.
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
  // Bodies that no constraint acts on; systems of these that springs couple, and the springs to what constraints act on.
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
  // Bodies on which fields act.
  template <auto stage>
  void field_bodies() {
    add(run_stage<stage, FieldSolve>, &batch_.motion.fields, fields_);
  }

  // Contacts: colour by colour; all blocks; those that bounce; islands at rest.
  template <auto stage>
  void contacts() {
    for (ContactGroup& group : batch_.contact_groups)
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

  // Joints that are solved iteratively, colour by colour, or all colours at once where each writes what is its own.
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
  // Articulations, each by itself; and those that are alike, side by side.
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
  // What joints do to the energy of their islands; bodies whose inertia is raised against joints.
  template <auto stage>
  void joint_islands() {
    add(run_stage<stage, JointSolve>, &batch_.joints, joint_islands_);
  }
  template <auto stage>
  void stiffened_bodies() {
    add(run_stage<stage, JointSolve>, &batch_.joints, stiffened_);
  }

  // Islands whose constraints are solved as rows.
  template <auto stage>
  void row_islands() {
    add(run_stage<stage, RowSolve>, batch_.rows, row_islands_);
  }

  // Several stages of articulations and their bodies as one line, run by run.
  template <void (FusedRun::*... stages)() const>
  void fused() {
    for (FusedRuns& line : batch_.fused_runs)
      add(run_stage<in_runs<stages...>, FusedRuns>, &line, int(line.runs.size()));
  }

  bool is_fused() const { return is_fused_; }
  bool has_swept_joints() const { return joint_slices_ > 0; }
  bool has_joints() const { return articulations_ > 0 || simd_articulations_ > 0 || has_swept_joints(); }
  bool has_fields() const { return fields_ > 0; }
  // Nothing comes between forces and the warm start of bodies.
  bool can_warm_start_with_forces() const {
    return impacts_ == 0 && articulations_ == 0 && !has_swept_joints();
  }

  std::span<const Stage> stages() const { return room_.first(used_); }

 private:
  static constexpr int kBodyBlocksPerClaim = 4, kContactBlocksPerClaim = 2, kJointBlocksPerClaim = 2,
                       kSlicesPerClaim = 2, kTreesPerClaim = 8;

  // (Out of line: it is called in fifty places.)
  GYRE_COLD void add(void (*kernel)(void*, int, int, int), void* context, int blocks, int per_claim = 1,
                     const int* bounds = nullptr) {
    if (blocks == 0) return;
    GYRE_ASSERT(used_ < room_.size(), "the program has more stages than were counted");
    room_[used_++] = {kernel, context, blocks, per_claim, bounds};
  }
  // What shares bodies goes in one claim.
  template <class Group>
  void add_group(void (*kernel)(void*, int, int, int), Group& group, int blocks, int per_claim) {
    add(kernel, &group, blocks, group.serial ? blocks : per_claim, group.bounds);
  }

  BatchContext& batch_;
  // How many blocks each kind has.
  int bodies_, fast_spinning_, orientations_, free_bodies_, fields_;
  int contact_blocks_ = 0, impacts_, trees_, structures_;
  int joint_slices_, articulations_, simd_articulations_, joint_islands_, stiffened_;
  int row_islands_;
  bool is_fused_;
  std::span<Stage> room_;
  std::size_t used_ = 0;
};

}  // namespace gyre
