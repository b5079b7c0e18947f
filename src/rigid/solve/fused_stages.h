// Bundles of linkages together with the bodies that they push. What is between the contacts of one part of a sub-step and those of the next
// (joints as contacts left them, moves, joints anew, forces, joints again) asks after no others: it is done run by run, while all
// that belongs to a run is in the cache. Stage by stage each bundle would come from memory several times a part: all together are more
// than a core's cache holds (docs/decisions/bundle-runs.md).
//
// In: a batch whose bundles are laid out. Out: the order in which its bodies are moved, and stages. Every number is what the stages of
// rigid/solve/motion_stages.h and of bundles would give one after the other.
#pragma once

#include "rigid/articulation/articulation_bundles.h"

namespace gyre {

// Bundles that follow each other and the blocks of the bodies that they push; or blocks of other bodies alone.
struct FusedRange {
  int first_bundle = 0, bundles = 0;
  int first_block = 0, blocks = 0;
};

// A line of the program has either the runs of bundles or those of other bodies. The latter come first: linkages may hang on kinematic
// bodies, which they do not push and which move all the same.
struct BatchContext;
struct FusedStage {
  BatchContext* solve = nullptr;
  std::span<FusedRange> runs{};
};

class FusedStages {
 public:
  // All bundles, in runs that fill most of their blocks of `width` bodies; with room for blocks of as many other bodies.
  FusedStages(const BundleSolve& bundles, std::size_t bodies, int width, Arena& arena);
  // Those blocks that follow.
  void add_blocks(int blocks);

  int count_blocks() const { return used_ == 0 ? 0 : runs_[used_ - 1].first_block + runs_[used_ - 1].blocks; }
  std::span<FusedRange> of_bundles() const { return runs_.first(bundle_runs_); }
  std::span<FusedRange> of_others() const { return runs_.subspan(bundle_runs_, used_ - bundle_runs_); }

 private:
  void add(const FusedRange& run) { runs_[used_++] = run; }

  std::span<FusedRange> runs_;
  std::size_t used_ = 0, bundle_runs_ = 0;
};
// The bodies of a run, block by block: those of a bundle in the order of its shape, of each all lanes. Where blocks have room left, kNoBody.
void list_pushed(const BundleSolve& bundles, const FusedRange& run, std::span<std::int32_t> bodies);

// Stages, whose blocks are runs. Their context is a FusedStage.
// Up to the warm start of contacts; from there to the contacts of the first part;
void fused_begin_stage(void* context, int begin, int end, int worker);
void fused_first_stage(void* context, int begin, int end, int worker);
// from the contacts of a part to those of the next; and after those of the last part.
void between_contacts_stage(void* context, int begin, int end, int worker);
void fused_end_stage(void* context, int begin, int end, int worker);

}  // namespace gyre
