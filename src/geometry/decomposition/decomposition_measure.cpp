// Measures of the hulls against the solid. See decomposition.h.
#include "base/container/sort.h"
#include "geometry/decomposition/decomposition.h"
#include "task/parallel.h"

namespace gyre {
namespace {

// Lines through the points of a lattice whose rows no mesh is aligned with, neither along y nor along z: consecutive Fibonacci numbers.
// S. Zaremba, "Good lattice points, discrepancy, and numerical integration", 1966.
constexpr int kLines = 10946, kLatticeStep = 6765;

struct Interval {
  double from, to;
};

// Lengths along one line, or sums of them.
struct Lengths {
  double solid = 0.0, hulls = 0.0, excess = 0.0, missing = 0.0;
};
Lengths operator+(const Lengths& a, const Lengths& b) {
  return {a.solid + b.solid, a.hulls + b.hulls, a.excess + b.excess, a.missing + b.missing};
}

class LineMeasure {
 public:
  LineMeasure(const SampledSolid& solid, std::span<const ConvexBody> bodies);
  Lengths measure(int line) const;
  // The area of the section that each line stands for.
  double cell_area() const { return width_ * height_ / double(kLines); }

 private:
  void add_triangle(std::size_t t);
  DVec3 start(int line) const {
    const std::int64_t across = std::int64_t(line) * kLatticeStep % kLines;
    return {0.0, low_.y + (double(line) + 0.5) / double(kLines) * width_,
            low_.z + (double(across) + 0.5) / double(kLines) * height_};
  }
  std::vector<Interval> solid_spans(int line) const;
  std::vector<Interval> hull_spans(int line) const;

  const SampledSolid& solid_;
  std::span<const ConvexBody> bodies_;
  DVec3 low_{1e300, 1e300, 1e300}, high_{-1e300, -1e300, -1e300};
  double width_ = 0.0, height_ = 0.0;
  std::vector<std::vector<double>> crossings_;  // by line
};

LineMeasure::LineMeasure(const SampledSolid& solid, std::span<const ConvexBody> bodies)
    : solid_(solid), bodies_(bodies) {
  const auto widen = [&](DVec3 p) {
    low_ = lower(low_, p);
    high_ = higher(high_, p);
  };
  for (const DVec3& p : solid.model->vertices) widen(p);
  for (const ConvexBody& body : bodies) {
    for (const DVec3& p : body.vertices) widen(p);
  }
  width_ = high_.y - low_.y;
  height_ = high_.z - low_.z;
  crossings_.resize(std::size_t(kLines));
  for (std::size_t t = 0; t < solid.model->triangle_count(); ++t) add_triangle(t);
}

void LineMeasure::add_triangle(std::size_t t) {
  const Model& model = *solid_.model;
  const DVec3 p[3] = {model.corner(t, 0), model.corner(t, 1), model.corner(t, 2)};
  const DVec3 low_corner = lower(p[0], lower(p[1], p[2])), high_corner = higher(p[0], higher(p[1], p[2]));
  if (!(width_ > 0.0) || !(height_ > 0.0)) return;
  const double lines_per_width = double(kLines) / width_;
  const int first = max(0, int((low_corner.y - low_.y) * lines_per_width - 1.0)),
            last = min(kLines - 1, int((high_corner.y - low_.y) * lines_per_width + 1.0));
  for (int line = first; line <= last; ++line) {
    const DVec3 at = start(line);
    if (at.z < low_corner.z || at.z > high_corner.z) continue;
    double side[3], sum = 0.0;
    for (int i = 0; i < 3; ++i) {
      const DVec3 a = p[(i + 1) % 3], b = p[(i + 2) % 3];
      side[i] = (b.y - a.y) * (at.z - a.z) - (b.z - a.z) * (at.y - a.y);
      sum += side[i];
    }
    // An edge counts for both of its triangles. The intervals between crossings are tested anyway.
    const bool in = (side[0] >= 0.0 && side[1] >= 0.0 && side[2] >= 0.0) ||
                    (side[0] <= 0.0 && side[1] <= 0.0 && side[2] <= 0.0);
    if (!in || sum == 0.0) continue;
    crossings_[std::size_t(line)].push_back((side[0] * p[0].x + side[1] * p[1].x + side[2] * p[2].x) / sum);
  }
}

std::vector<Interval> LineMeasure::solid_spans(int line) const {
  std::vector<double> crossings = crossings_[std::size_t(line)];
  std::vector<double> scratch(crossings.size());
  merge_sort(std::span<double>(crossings), std::span<double>(scratch),
             [](double a, double b) { return a < b; });
  std::vector<Interval> spans;
  for (std::size_t i = 0; i + 1 < crossings.size(); ++i) {
    if (crossings[i + 1] - crossings[i] < 1.0e-9) continue;
    DVec3 middle = start(line);
    middle.x = 0.5 * (crossings[i] + crossings[i + 1]);
    if (!solid_.field->inside(middle)) continue;
    if (!spans.empty() && spans.back().to > crossings[i] - 1.0e-9) {
      spans.back().to = crossings[i + 1];
    } else {
      spans.push_back({crossings[i], crossings[i + 1]});
    }
  }
  return spans;
}

// The intervals of the line inside any hull, without overlap, ascending.
std::vector<Interval> LineMeasure::hull_spans(int line) const {
  const DVec3 at = start(line);
  std::vector<Interval> all;
  for (const ConvexBody& body : bodies_) {
    if (at.y < body.low.y || at.y > body.high.y || at.z < body.low.z || at.z > body.high.z) continue;
    double from = body.low.x, to = body.high.x;
    for (const HalfSpace& plane : body.planes) {
      const double room = plane.offset - dot(plane.normal, at);
      if (plane.normal.x > 1.0e-12) {
        to = min(to, room / plane.normal.x);
      } else if (plane.normal.x < -1.0e-12) {
        from = max(from, room / plane.normal.x);
      } else if (room < 0.0) {
        to = from - 1.0;
      }
    }
    if (from < to) all.push_back({from, to});
  }
  std::vector<Interval> scratch(all.size());
  merge_sort(std::span<Interval>(all), std::span<Interval>(scratch),
             [](const Interval& a, const Interval& b) { return a.from < b.from; });
  std::vector<Interval> out;
  for (const Interval& span : all) {
    if (!out.empty() && span.from <= out.back().to) {
      out.back().to = max(out.back().to, span.to);
    } else {
      out.push_back(span);
    }
  }
  return out;
}

Lengths LineMeasure::measure(int line) const {
  const std::vector<Interval> solid = solid_spans(line), hulls = hull_spans(line);
  Lengths out;
  double both = 0.0;
  for (const Interval& span : solid) out.solid += span.to - span.from;
  for (const Interval& span : hulls) out.hulls += span.to - span.from;
  for (const Interval& a : solid) {
    for (const Interval& b : hulls) both += max(0.0, min(a.to, b.to) - max(a.from, b.from));
  }
  out.excess = out.hulls - both;
  out.missing = out.solid - both;
  return out;
}

// The distance of the point from the closest body, or 0 if it is at most `known`.
double outside_all(std::span<const ConvexBody> bodies, DVec3 p, double known) {
  double nearest = 1.0e300;
  const ConvexBody* best = nullptr;
  for (const ConvexBody& body : bodies) {
    const double outside = -depth_below(body, p);
    if (outside <= known) return 0.0;
    if (best != nullptr && outside >= nearest) continue;
    nearest = outside;
    best = &body;
  }
  double distance = best != nullptr ? distance_from(*best, p) : 0.0;
  if (distance <= known) return 0.0;
  for (const ConvexBody& body : bodies) {
    if (&body != best && -depth_below(body, p) < distance) distance = min(distance, distance_from(body, p));
  }
  return distance;
}

}  // namespace

void measure_pieces(const SampledSolid& solid, TaskSystem& tasks, std::span<const ConvexBody> bodies,
                    DecompositionStats& report) {
  const double metres = 1.0 / solid.model->scale;
  std::vector<Overhang> overhangs(bodies.size());
  std::vector<double> depths(bodies.size());
  for_blocks(tasks, int(bodies.size()), 1, [&](int i, int, int) {
    const ConvexBody& body = bodies[std::size_t(i)];
    overhangs[std::size_t(i)] = find_overhang(
        *solid.field, body, {.ignore = 0.25 * solid.tolerance, .resolution = 0.1 * solid.tolerance});
    depths[std::size_t(i)] = deepest_sample(solid, body);
  });
  double overhang = 0.0, bound = 0.0, depth = 0.0;
  for (std::size_t i = 0; i < bodies.size(); ++i) {
    overhang = max(overhang, overhangs[i].value);
    bound = max(bound, overhangs[i].bound);
    depth = max(depth, depths[i]);
  }
  const auto larger = [](double a, double b) { return max(a, b); };
  const double uncovered = reduce_blocks(
      tasks, int(solid.samples.size()), 64, 0.0,
      [&](int begin, int end, int) {
        double largest = 0.0;
        for (int i = begin; i < end; ++i)
          largest = max(largest, outside_all(bodies, solid.samples[std::size_t(i)].point, largest));
        return largest;
      },
      larger);
  const LineMeasure lines(solid, bodies);
  const Lengths sum = reduce_blocks(
      tasks, kLines, 16, Lengths{},
      [&](int begin, int end, int) {
        Lengths sum_of_block;
        for (int i = begin; i < end; ++i) sum_of_block = sum_of_block + lines.measure(i);
        return sum_of_block;
      },
      [](const Lengths& a, const Lengths& b) { return a + b; });

  const double cubic = lines.cell_area() * metres * metres * metres;
  report.overhang = float(overhang * metres) + 0.0f;  // never -0
  report.overhang_bound = float(bound * metres);
  report.depth = float(depth * metres);
  report.uncovered = float(uncovered * metres);
  report.sample_spacing = float(solid.spacing * metres);
  report.excess_volume = sum.excess * cubic;
  report.missing_volume = sum.missing * cubic;
  report.solid_volume =
      solid.covered_once ? enclosed_volume(*solid.model) * metres * metres * metres : sum.solid * cubic;
  report.hull_volume = report.solid_volume + report.excess_volume - report.missing_volume;
  constexpr double kSlack = 1.05;  // vertices that a hull may not have
  report.within_concavity = overhang <= kSlack * solid.tolerance && depth <= kSlack * solid.tolerance;
}

}  // namespace gyre
