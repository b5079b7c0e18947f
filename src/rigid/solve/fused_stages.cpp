#include "rigid/solve/fused_stages.h"

#include "base/noinline.h"
#include "rigid/solve/motion_stages.h"
#include "task/parallel.h"

namespace gyre {

namespace {

// Bodies are moved in whole blocks: with as many in a run, few lanes of the last one are empty.
constexpr std::size_t kMinBodies = 96;
// Of other bodies.
constexpr int kBlocksAlone = 4;

// A run while a stage works on it.
class Run {
 public:
  Run(BatchContext& solve, const FusedRange& run)
      : s_(solve),
        first_(run.first_bundle),
        last_(run.first_bundle + run.bundles),
        begin_(run.first_block),
        end_(run.first_block + run.blocks),
        lanes_(find_lanes(run)),
        spins_(has_fast_spinning(solve, begin_, end_)) {}

  void begin() const {
    prepare_motion(s_, begin_, end_);
    begin_bundles(s_.bundles, first_, last_, s_.w, s_.lane_start);
    for_bundles(&ArticulationKernels::prepare);
    predict_motion(s_, begin_, end_, false);
    for_bundles(&ArticulationKernels::compute_bias);
  }
  void solve_first() const {
    record_velocity_change(s_, begin_, end_);
    solve(true);
  }
  void between_contacts() const {
    finish_part();
    for_bundles(&ArticulationKernels::prepare);
    for_bundles(&ArticulationKernels::end_half_step, is_apart() || spins_, is_apart());
    predict_motion(s_, begin_, end_, true, lanes_);
    solve(is_apart());
  }
  void end() const {
    finish_part();
    for_bundles(&ArticulationKernels::prepare);
    for_bundles(&ArticulationKernels::end_step, is_apart() || spins_, true);
    finish_bundles(s_.bundles, first_, last_, s_.w);
  }

 private:
  // Where blocks have the same bodies in the same lanes as the only bundle of the run, velocities stay in its lanes from contacts to
  // contacts. (Bodies that turn alone are turned by their records.)
  LaneVelocities find_lanes(const FusedRange& run) const {
    if (run.bundles != 1) return {};
    const BundledArticulations& bundle = s_.bundles.bundles[std::size_t(first_)];
    const ArticulationKernels& kernels = *bundle.lanes.kernels;
    const bool is_full =
        kernels.width == s_.kernels.width && int(bundle.articulations.size()) == kernels.width;
    if (!is_full || s_.kernels.motion.integrate_velocities_in_lanes == nullptr) return {};
    return {reinterpret_cast<float*>(bundle.lanes.bodies + kernels.velocities_at),
            kernels.body_bytes / sizeof(float), begin_};
  }

  // Velocities go from hand to hand by the records.
  bool is_apart() const { return !lanes_.is_set(); }

  // `loads`, `stores`: as LaneArrays. (Cold: what it calls is long.)
  GYRE_COLD void for_bundles(BundleKernel kernel, bool loads = true, bool stores = true) const {
    LaneArrays arrays = s_.bundles.arrays;
    arrays.loads = loads, arrays.stores = stores;
    for (int i = first_; i < last_; ++i) {
      const ArticulationBundle& bundle = s_.bundles.bundles[std::size_t(i)].lanes;
      (bundle.kernels->*kernel)(bundle, arrays, s_.bundles.settings);
    }
  }
  GYRE_COLD void solve(bool loads) const {
    if (first_ == last_) return;
    for_bundles(&ArticulationKernels::solve, loads, true);
    record_velocities(s_, begin_, end_, lanes_);
  }
  // Since solve() only contacts have changed velocities in the records, and only of bodies that are watched: lanes have the others'.
  GYRE_COLD void finish_part() const {
    record_velocity_change(s_, begin_, end_, lanes_);
    for_bundles(&ArticulationKernels::solve_after_contacts, is_apart(), is_apart() || spins_);
    advance_motion(s_, begin_, end_, true, spins_ ? LaneVelocities{} : lanes_);
    rotate_fast_spinning(s_, begin_, end_);
  }

  BatchContext& s_;
  int first_, last_, begin_, end_;
  LaneVelocities lanes_;
  bool spins_;  // some turn alone
};

template <class Do>
void for_runs(void* context, int begin, int end, Do&& run) {
  const FusedStage& line = *static_cast<FusedStage*>(context);
  for (int i = begin; i < end; ++i) run(Run(*line.solve, line.runs[std::size_t(i)]));
}

}  // namespace

GYRE_COLD FusedStages::FusedStages(const BundleSolve& bundles, std::size_t bodies, int width, Arena& arena)
    : runs_(arena.make<FusedRange>(bundles.bundles.size() + bodies / std::size_t(kBlocksAlone * width) + 1)) {
  std::size_t filled = 0;
  for (std::size_t i = 0; i < bundles.bundles.size(); ++i) {
    const BundledArticulations& bundle = bundles.bundles[i];
    if (filled == 0) add({int(i), 0, count_blocks(), 0});
    FusedRange& run = runs_[used_ - 1];
    ++run.bundles;
    filled += bundle.lanes.moving_count * bundle.articulations.size();
    run.blocks = gyre::count_blocks(int(filled), width);
    if (filled >= kMinBodies) filled = 0;
  }
  bundle_runs_ = used_;
}

GYRE_COLD void FusedStages::add_blocks(int blocks) {
  for (int end = count_blocks() + blocks; count_blocks() < end;) {
    const int first = count_blocks();
    add({0, 0, first, min(kBlocksAlone, end - first)});
  }
}

GYRE_COLD void list_pushed(const BundleSolve& bundles, const FusedRange& run,
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

void fused_begin_stage(void* context, int begin, int end, int) {
  for_runs(context, begin, end, [](const Run& run) { run.begin(); });
}
void fused_first_stage(void* context, int begin, int end, int) {
  for_runs(context, begin, end, [](const Run& run) { run.solve_first(); });
}
void between_contacts_stage(void* context, int begin, int end, int) {
  for_runs(context, begin, end, [](const Run& run) { run.between_contacts(); });
}
void fused_end_stage(void* context, int begin, int end, int) {
  for_runs(context, begin, end, [](const Run& run) { run.end(); });
}

}  // namespace gyre
