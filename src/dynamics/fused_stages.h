// Fused stages: all that happens to an articulation bundle and its bodies between two sets of contacts is done in one line, run by run.
// Nothing else acts there in a fused batch, and the data of a run stays in the cache. Stage by stage each articulation would come from
// memory several times a half-step, for all of them together are larger than a core's cache (docs/decisions/fused-stages.md).
// dynamics/substep_program.cpp says which stages are fused, and in which order.
//
// In: a batch whose articulations are laid out. Out: the order in which its bodies are moved, and the parts of fused stages. Every number is
// the one that the stages of rigid/solve give one after the other.
#pragma once

#include "rigid/solve/body_motion_solve.h"
#include "rigid/solve/joint_solve.h"

namespace gyre {

// Bundles of articulations that follow each other and the blocks of the bodies that they push; or blocks of other bodies alone.
struct ArticulationRun {
  int first_bundle = 0, bundles = 0;
  int first_block = 0, blocks = 0;
};

// A line of the program has either the runs of articulations or those of other bodies. The latter come first: articulations may hang on
// kinematic bodies, which they do not push and which move all the same.
struct FusedRuns {
  const JointSolve* joints = nullptr;
  const BodyMotionSolve* motion = nullptr;
  std::span<const ArticulationRun> runs{};
};

class RunLayout {
 public:
  // All bundles, in runs that fill most of their blocks of `width` bodies; with room for blocks of as many other bodies.
  RunLayout(const BundleSolve& bundles, std::size_t bodies, int width, Arena& arena);
  // Those blocks that follow.
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
// The bodies of a run, block by block: those of a bundle in the order of its topology, of each all lanes. Where blocks have room left,
// kNoBody.
void list_run_bodies(const BundleSolve& bundles, const ArticulationRun& run, std::span<std::int32_t> bodies);

// A run while a stage works on it. Velocities stay in the lanes of its articulation from contacts to contacts where blocks have the same
// bodies in the same lanes as the only bundle of the run; else they go from hand to hand by the records.
class FusedRun {
 public:
  FusedRun(const FusedRuns& line, const ArticulationRun& run);

  // As the step begins: bodies and articulations into their blocks; and as it ends.
  void prepare() const;
  void finish() const;
  void apply_forces() const;
  void apply_forces_and_warm_start() const;
  void add_contact_change() const;
  void integrate_positions() const;
  void prepare_joints() const;
  void compute_joint_bias() const;
  // In the first half-step velocities come from the records; what contacts change is measured from here on.
  void solve_joints_first() const;
  void solve_joints() const;
  void solve_joints_after_contacts() const;
  void relax_joints() const;
  void relax_joints_last() const;
  // What the warm start of contacts changed.
  void add_first_contact_change() const;

 private:
  bool is_apart() const { return !lanes_.is_set(); }
  void for_bundles(BundleKernel kernel, bool loads = true, bool stores = true) const;
  void solve(bool loads) const;

  const JointSolve& joints_;
  const BodyMotionSolve& motion_;
  int first_, last_, begin_, end_;  // bundles, blocks
  LaneVelocities lanes_;
  bool spins_;  // the kernels leave the rotation of some alone
};

// Does all of that to one run after the other.
template <void (FusedRun::*... parts)() const>
void in_runs(const FusedRuns& line, int begin, int end) {
  for (int i = begin; i < end; ++i) {
    const FusedRun run(line, line.runs[std::size_t(i)]);
    ((run.*parts)(), ...);
  }
}

}  // namespace gyre
