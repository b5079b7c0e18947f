#include "dynamics/fused_stages.h"

#include "base/noinline.h"
#include "rigid/solve/motion_stages.h"
#include "task/parallel.h"

namespace gyre {

namespace {

// Least number of bodies in a run. Bodies move in whole blocks, and few lanes of the last block are empty at this number.
constexpr std::size_t kMinBodies = 96;
// Blocks in a run of other bodies.
constexpr int kBlocksAlone = 4;

// Returns the lanes of the run's velocities, or none. (Rotations outside of the kernels use the records of their bodies.)
LaneVelocities find_lanes(const FusedRuns& line, const ArticulationRun& run) {
  if (run.bundles != 1) return {};
  const SolverKernels& all = line.motion->kernels;
  const BundledArticulations& bundle = line.joints->bundles.bundles[std::size_t(run.first_bundle)];
  const ArticulationKernels& kernels = *bundle.lanes.kernels;
  const bool is_full = kernels.width == all.width && int(bundle.articulations.size()) == kernels.width;
  if (!is_full || all.motion.integrate_velocities_in_lanes == nullptr) return {};
  return {reinterpret_cast<float*>(bundle.lanes.bodies + kernels.velocities_at),
          kernels.body_bytes / sizeof(float), run.first_block};
}

}  // namespace

GYRE_COLD RunLayout::RunLayout(const BundleSolve& bundles, std::size_t bodies, int width, Arena& arena)
    : runs_(arena.make<ArticulationRun>(bundles.bundles.size() + bodies / std::size_t(kBlocksAlone * width) +
                                        1)) {
  std::size_t filled = 0;
  for (std::size_t i = 0; i < bundles.bundles.size(); ++i) {
    const BundledArticulations& bundle = bundles.bundles[i];
    if (filled == 0) add({int(i), 0, count_blocks(), 0});
    ArticulationRun& run = runs_[used_ - 1];
    ++run.bundles;
    filled += bundle.lanes.moving_count * bundle.articulations.size();
    run.blocks = gyre::count_blocks(int(filled), width);
    if (filled >= kMinBodies) filled = 0;
  }
  articulation_runs_ = used_;
}

GYRE_COLD void RunLayout::add_blocks(int blocks) {
  for (int end = count_blocks() + blocks; count_blocks() < end;) {
    const int first = count_blocks();
    add({0, 0, first, min(kBlocksAlone, end - first)});
  }
}

GYRE_COLD void list_run_bodies(const BundleSolve& bundles, const ArticulationRun& run,
                               std::span<std::int32_t> bodies) {
  for (std::int32_t& body : bodies) body = kNoBody;
  std::size_t first = 0;
  for (int i = run.first_bundle; i < run.first_bundle + run.bundles; ++i) {
    const BundledArticulations& bundle = bundles.bundles[std::size_t(i)];
    const ArticulationBundle& shape = bundle.lanes;
    const std::size_t lanes = bundle.articulations.size();
    for (std::uint32_t n = 0; n < shape.node_count; ++n) {
      for (std::size_t lane = 0; lane < lanes; ++lane) {
        const ArticulationJoint& joint = bundle.articulations[lane]->joints[n];
        const auto list = [&](std::uint32_t place, std::int32_t body) {
          if (place < shape.moving_count) bodies[first + place * lanes + lane] = body;
        };
        list(shape.nodes[n].a, joint.body_a);
        list(shape.nodes[n].b, joint.body_b);
      }
    }
    first += shape.moving_count * lanes;
  }
}

FusedRun::FusedRun(const FusedRuns& line, const ArticulationRun& run)
    : joints_(*line.joints),
      motion_(*line.motion),
      first_(run.first_bundle),
      last_(run.first_bundle + run.bundles),
      begin_(run.first_block),
      end_(run.first_block + run.blocks),
      lanes_(find_lanes(line, run)),
      spins_(has_fast_spinning(motion_, begin_, end_)) {}

void FusedRun::prepare() const {
  prepare_bodies(motion_, begin_, end_);
  begin_bundles(joints_.bundles, first_, last_, joints_.w, joints_.lane_start);
}
void FusedRun::finish() const { finish_bundles(joints_.bundles, first_, last_, joints_.w); }

void FusedRun::apply_forces() const { gyre::apply_forces(motion_, begin_, end_); }
void FusedRun::apply_forces_and_warm_start() const {
  if (is_apart()) return gyre::apply_forces_and_warm_start(motion_, begin_, end_);
  apply_forces_and_warm_start_in_lanes(motion_, begin_, end_, lanes_);
}
void FusedRun::add_first_contact_change() const { gyre::add_contact_change(motion_, begin_, end_); }
void FusedRun::add_contact_change() const {
  if (is_apart()) return gyre::add_contact_change(motion_, begin_, end_);
  add_contact_change_in_lanes(motion_, begin_, end_, lanes_);
}
void FusedRun::integrate_positions() const {
  if (is_apart() || spins_)
    gyre::integrate_positions(motion_, begin_, end_);
  else
    integrate_positions_in_lanes(motion_, begin_, end_, lanes_);
  integrate_fast_spinning_of_blocks(motion_, begin_, end_);
}

void FusedRun::prepare_joints() const { for_bundles(&ArticulationKernels::prepare); }
void FusedRun::compute_joint_bias() const { for_bundles(&ArticulationKernels::compute_bias); }
void FusedRun::solve_joints_first() const { solve(true); }
void FusedRun::solve_joints() const { solve(is_apart()); }
// Since solve() only contacts have changed velocities in the records, and only of measured bodies. The lanes hold the others.
void FusedRun::solve_joints_after_contacts() const {
  for_bundles(&ArticulationKernels::solve_after_contacts, is_apart(), is_apart() || spins_);
}
void FusedRun::relax_joints() const {
  for_bundles(&ArticulationKernels::end_half_step, is_apart() || spins_, is_apart());
}
void FusedRun::relax_joints_last() const {
  for_bundles(&ArticulationKernels::end_step, is_apart() || spins_, true);
}

// `loads`, `stores`: as LaneArrays. (It is cold because the functions it calls are long.)
GYRE_COLD void FusedRun::for_bundles(BundleKernel kernel, bool loads, bool stores) const {
  LaneArrays arrays = joints_.bundles.arrays;
  arrays.loads = loads, arrays.stores = stores;
  for (int i = first_; i < last_; ++i) {
    const ArticulationBundle& bundle = joints_.bundles.bundles[std::size_t(i)].lanes;
    (bundle.kernels->*kernel)(bundle, arrays, joints_.bundles.settings);
  }
}
GYRE_COLD void FusedRun::solve(bool loads) const {
  if (first_ == last_) return;
  for_bundles(&ArticulationKernels::solve, loads, true);
  if (is_apart()) return start_contact_change(motion_, begin_, end_);
  start_contact_change_in_lanes(motion_, begin_, end_, lanes_);
}

}  // namespace gyre
