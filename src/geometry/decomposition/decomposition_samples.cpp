// Samples of the surface, and the sides on which the solid lies. See decomposition.h.
#include "geometry/decomposition/decomposition.h"
#include "task/parallel.h"

namespace gyre {
namespace {

// Offset from the surface, in sizes of the mesh: far above rounding, far below any feature.
constexpr double kOffset = 1.0e-5;
// Deviation of the winding number from an integer above which a point is close to a hole. The error of dipoles is much
// smaller.
constexpr double kBroken = 0.1;

struct SampleCandidate {
  SurfaceSample sample;
  DVec3 normal;
  bool open = false;  // the solid is behind the sample and not before it
  bool broken = false;
};

double fraction(double x) { return x - double(std::int64_t(x)); }

// One sample for each spacing * spacing of area, spread by a sequence that fills triangles evenly. M. Roberts, "The
// Unreasonable Effectiveness of Quasirandom Sequences", 2018 (the plastic number's powers).
std::vector<SampleCandidate> spread_points(const Model& model, double spacing) {
  constexpr double kStepU = 0.7548776662466927, kStepV = 0.5698402909980532;  // 1/p and 1/p^2 of the plastic number p
  std::vector<SampleCandidate> out;
  double area_left = 0.5;
  for (std::size_t t = 0; t < model.triangle_count(); ++t) {
    const DVec3 a = model.corner(t, 0), b = model.corner(t, 1), c = model.corner(t, 2);
    const DVec3 normal = cross(b - a, c - a);
    const double size = length(normal);
    if (!(size > 0.0)) continue;
    area_left += 0.5 * size / (spacing * spacing);
    for (; area_left >= 1.0; area_left -= 1.0) {
      const auto number = double(out.size() + 1);
      double u = fraction(number * kStepU), v = fraction(number * kStepV);
      if (u + v > 1.0) {
        u = 1.0 - u;
        v = 1.0 - v;
      }
      out.push_back({{a + u * (b - a) + v * (c - a), model.group[t]}, normal / size});
    }
  }
  return out;
}

}  // namespace

void sample_surface(TaskSystem& tasks, SampledSolid& solid) {
  const Model& model = *solid.model;
  const SurfaceField& field = *solid.field;
  std::vector<SampleCandidate> candidates = spread_points(model, solid.spacing);
  const double offset = kOffset * model.size;
  for_blocks(tasks, int(candidates.size()), 64, [&](int begin, int end, int) {
    for (int i = begin; i < end; ++i) {
      SampleCandidate& candidate = candidates[std::size_t(i)];
      const double before = field.winding(candidate.sample.point + offset * candidate.normal);
      const double behind = field.winding(candidate.sample.point - offset * candidate.normal);
      candidate.open = before < kInsideWinding && behind > kInsideWinding;
      // In a closed surface only the error of dipoles keeps the number from being whole.
      const bool whole =
          model.closed || absolute(before - double(std::int64_t(before + 64.5) - 64)) <= kBroken;
      candidate.broken = !whole || (before < kInsideWinding && behind <= kInsideWinding);
    }
  });
  solid.samples.clear();
  std::size_t broken = 0;
  for (const SampleCandidate& candidate : candidates) {
    if (candidate.open) solid.samples.push_back(candidate.sample);
    broken += candidate.broken ? 1 : 0;
  }
  solid.openness = candidates.empty() ? 1.0 : double(broken) / double(candidates.size());
  solid.covered_once = model.closed && solid.samples.size() == candidates.size();
}

}  // namespace gyre
