// The work behind decompose() of gyre/decomposition.h: cut, join, measure.
//
// In: a Model. Out: convex bodies in its coordinates. Rounds of cuts look at all parts at once; what one worker finds goes to a
// slot of its own, and choices are made in order, so threads never show.
#pragma once

#include "geometry/decomposition/decomposition_part.h"
#include "task/task_system.h"

#include <vector>

namespace gyre {

// Asked between pieces of work, with what is done (0 to 1); false: stop.
class DecompositionProgress {
 public:
  explicit DecompositionProgress(const DecompositionDef& def) : def_(def) {}
  // False from the first time on that the user wanted no more.
  bool go_on(double done);
  bool stopped() const { return stopped_; }

 private:
  const DecompositionDef& def_;
  float shown_ = 0.0f;
  bool stopped_ = false;
};

// Cuts until all parts are convex within the tolerance or there are `limit` of them.
std::vector<ConvexBody> cut_up(const SampledSolid& solid, TaskSystem& tasks, int limit,
                               DecompositionProgress& progress);
// Joins neighbours whose common hull is convex within the tolerance, the best pair first; then, while there are more than
// `max_hulls`, those that lack least.
void join_pieces(const SampledSolid& solid, TaskSystem& tasks, int max_hulls, std::vector<ConvexBody>& pieces,
                 DecompositionProgress& progress);
// Points evenly on the surface, where it borders the solid; `openness` is the part of it near which the winding number is no
// whole number.
std::vector<SurfaceSample> sample_surface(const Model& model, const SurfaceField& field, TaskSystem& tasks,
                                          double spacing, double& openness);
// Fills in all that is measured on the hulls as they are handed out.
void measure_pieces(const SampledSolid& solid, TaskSystem& tasks, std::span<const ConvexBody> bodies,
                    DecompositionReport& report);

}  // namespace gyre
