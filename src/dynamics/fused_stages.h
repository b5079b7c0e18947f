// Fused stages: all stages of an articulation bundle and its bodies between two solves of contacts are one line, run by run. Nothing else
// acts on them in a fused batch, and the data of a run stays in the cache. Stage by stage, each articulation would come from memory several
// times a half-step, because all of them together exceed a core's cache (docs/decisions/fused-stages.md). dynamics/substep_program.cpp says
// which stages are fused, and in which order.
//
// In: a batch whose articulations are laid out. Out: the order in which its bodies move, and the parts of fused stages. All numbers equal
// those of the stages of rigid/solve, run one after the other.
#pragma once

#include "rigid/solve/body_motion_solve.h"
#include "rigid/solve/joint_solve.h"

namespace gyre {

// A run: consecutive bundles with the blocks of the bodies that they move, or blocks of other bodies alone.
struct ArticulationRun {
  int first_bundle = 0, bundles = 0;
  int first_block = 0, blocks = 0;
};

// The runs of one line of the program: of articulations, or of other bodies. The other bodies come first, because articulations may hang on
// kinematic bodies, which move but are not pushed.
struct FusedRuns {
  const JointSolve* joints = nullptr;
  const BodyMotionSolve* motion = nullptr;
  std::span<const ArticulationRun> runs{};
};

class RunLayout {
 public:
  // Divides all bundles into runs that fill most of their blocks of `width` bodies, and allocates runs for `bodies` other bodies.
  RunLayout(const BundleSolve& bundles, std::size_t bodies, int width, Arena& arena);
  // Appends runs for so many blocks of other bodies.
  void add_blocks(int blocks);

  int count_blocks() const { return used_ == 0 ? 0 : runs_[used_ - 1].first_block + runs_[used_ - 1].blocks; }
  std::span<const ArticulationRun> of_articulations() const { return runs_.first(articulation_runs_); }
  std::span<const ArticulationRun> of_others() const {
    return runs_.subspan(articulation_runs_, used_ - articulation_runs_);
  }

 private:
  void add(const ArticulationRun& run) { runs_[used_++] = run; }

  std::span<ArticulationRun> runs_;
  std::size_t used_ = 0, articulation_runs_ = 0;
};
// Lists the bodies of a run block by block: those of a bundle in the order of its topology, with all lanes of each. Free lanes of blocks
// get kNoBody.
void list_run_bodies(const BundleSolve& bundles, const ArticulationRun& run, std::span<std::int32_t> bodies);

// A run while a stage works on it. If the run has one bundle, and its blocks have the same bodies in the same lanes, velocities stay in the
// lanes of the bundle from one solve of contacts to the next. Otherwise stages exchange them through the records.
class FusedRun {
 public:
  FusedRun(const FusedRuns& line, const ArticulationRun& run);

  // prepare() reads bodies and articulations into their blocks as the step begins; finish() writes results back at its end.
  void prepare() const;
  void finish() const;
  void apply_forces() const;
  void apply_forces_and_warm_start() const;
  void add_contact_change() const;
  void integrate_positions() const;
  void prepare_joints() const;
  void compute_joint_bias() const;
  // The first half-step reads velocities from the records. The contact change is measured from here on.
  void solve_joints_first() const;
  void solve_joints() const;
  void solve_joints_after_contacts() const;
  void relax_joints() const;
  void relax_joints_last() const;
  // Adds up the change by the warm start of contacts.
  void add_first_contact_change() const;

 private:
  bool is_apart() const { return !lanes_.is_set(); }
  void for_bundles(BundleKernel kernel, bool loads = true, bool stores = true) const;
  void solve(bool loads) const;

  const JointSolve& joints_;
  const BodyMotionSolve& motion_;
  int first_, last_, begin_, end_;  // bundles, blocks
  LaneVelocities lanes_;
  bool spins_;  // some rotations are outside of the kernels
};

// Runs all these parts on one run after the other.
template <void (FusedRun::*... parts)() const>
void in_runs(const FusedRuns& line, int begin, int end) {
  for (int i = begin; i < end; ++i) {
    const FusedRun run(line, line.runs[std::size_t(i)]);
    ((run.*parts)(), ...);
  }
}

}  // namespace gyre
