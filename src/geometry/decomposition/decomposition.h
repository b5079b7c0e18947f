// The steps of decompose() of gyre/decomposition.h: cut, join, measure.
//
// In: a Model. Out: convex bodies in its coordinates. A round of cuts tests all parts in parallel. Each worker writes
// to a slot of its own, and choices are made in order, so the result does not depend on threads.
#pragma once

#include "geometry/decomposition/decomposition_part.h"
#include "task/task_system.h"

#include <vector>

namespace gyre {

// Progress callback of the user, called between pieces of work with the fraction done (0 to 1). The user may stop the
// work.
class DecompositionProgress {
 public:
  explicit DecompositionProgress(const DecompositionDef& def) : def_(def) {}
  // Reports progress. Returns false once the user has asked to stop.
  bool report_progress(double done);
  bool stopped() const { return stopped_; }

 private:
  const DecompositionDef& def_;
  float reported_ = 0.0f;
  bool stopped_ = false;
};

// Cuts until all parts are convex within the tolerance or there are `limit` of them.
std::vector<ConvexBody> cut_up(const SampledSolid& solid, TaskSystem& tasks, int limit,
                               DecompositionProgress& progress);
// Joins neighbours whose common hull is convex within the tolerance, the best pair first. Then, while there are more
// than `max_hulls`, joins the pairs that lack least.
void join_pieces(const SampledSolid& solid, TaskSystem& tasks, int max_hulls, std::vector<ConvexBody>& pieces,
                 DecompositionProgress& progress);
// Samples the surface evenly where it borders the solid. Fills in `samples`, `openness` and `covered_once`.
void sample_surface(TaskSystem& tasks, SampledSolid& solid);
// Fills in all measures of the final hulls.
void measure_pieces(const SampledSolid& solid, TaskSystem& tasks, std::span<const ConvexBody> bodies,
                    DecompositionStats& report);

}  // namespace gyre
