// What hulls are like beside the solid. See decomposition.h.
#include "base/container/sort.h"
#include "geometry/decomposition/decomposition.h"
#include "task/parallel.h"

namespace gyre {
namespace {

constexpr int kLines = 100;  // along each of two axes

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
  double cell_area() const { return width_ * height_; }

 private:
  void add_triangle(std::size_t t);
  DVec3 start(int line) const {
    return {0.0, low_.y + (double(line % kLines) + 0.5) * width_,
            low_.z + (double(line / kLines) + 0.5) * height_};
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
  width_ = (high_.y - low_.y) / double(kLines);
  height_ = (high_.z - low_.z) / double(kLines);
  crossings_.resize(std::size_t(kLines) * kLines);
  for (std::size_t t = 0; t < solid.model->triangle_count(); ++t) add_triangle(t);
}

void LineMeasure::add_triangle(std::size_t t) {
  const Model& model = *solid_.model;
  const DVec3 p[3] = {model.place(t, 0), model.place(t, 1), model.place(t, 2)};
  const DVec3 least = lower(p[0], lower(p[1], p[2])), most = higher(p[0], higher(p[1], p[2]));
  if (!(width_ > 0.0) || !(height_ > 0.0)) return;
  const int y0 = max(0, int((least.y - low_.y) / width_ - 1.0)),
            y1 = min(kLines - 1, int((most.y - low_.y) / width_ + 1.0));
  const int z0 = max(0, int((least.z - low_.z) / height_ - 1.0)),
            z1 = min(kLines - 1, int((most.z - low_.z) / height_ + 1.0));
  for (int z = z0; z <= z1; ++z) {
    for (int y = y0; y <= y1; ++y) {
      const int line = z * kLines + y;
      const DVec3 at = start(line);
      double side[3], sum = 0.0;
      for (int i = 0; i < 3; ++i) {
        const DVec3 a = p[(i + 1) % 3], b = p[(i + 2) % 3];
        side[i] = (b.y - a.y) * (at.z - a.z) - (b.z - a.z) * (at.y - a.y);
        sum += side[i];
      }
      // An edge counts for both of its triangles: what lies between crossings is looked at anyway.
      const bool in = (side[0] >= 0.0 && side[1] >= 0.0 && side[2] >= 0.0) ||
                      (side[0] <= 0.0 && side[1] <= 0.0 && side[2] <= 0.0);
      if (!in || sum == 0.0) continue;
      crossings_[std::size_t(line)].push_back((side[0] * p[0].x + side[1] * p[1].x + side[2] * p[2].x) / sum);
    }
  }
}

std::vector<Interval> LineMeasure::solid_spans(int line) const {
  std::vector<double> places = crossings_[std::size_t(line)];
  std::vector<double> scratch(places.size());
  merge_sort(std::span<double>(places), std::span<double>(scratch), [](double a, double b) { return a < b; });
  std::vector<Interval> spans;
  for (std::size_t i = 0; i + 1 < places.size(); ++i) {
    if (places[i + 1] - places[i] < 1.0e-9) continue;
    DVec3 middle = start(line);
    middle.x = 0.5 * (places[i] + places[i + 1]);
    if (!solid_.field->inside(middle)) continue;
    if (!spans.empty() && spans.back().to > places[i] - 1.0e-9) {
      spans.back().to = places[i + 1];
    } else {
      spans.push_back({places[i], places[i + 1]});
    }
  }
  return spans;
}

// Where the line is in any hull: spans that do not overlap, ascending.
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

// How far the point lies from the nearest of the bodies, but for those within `known`.
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
                    DecompositionReport& report) {
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
        double most = 0.0;
        for (int i = begin; i < end; ++i)
          most = max(most, outside_all(bodies, solid.samples[std::size_t(i)].point, most));
        return most;
      },
      larger);
  const LineMeasure lines(solid, bodies);
  const Lengths sum = reduce_blocks(
      tasks, kLines * kLines, 16, Lengths{},
      [&](int begin, int end, int) {
        Lengths part;
        for (int i = begin; i < end; ++i) part = part + lines.measure(i);
        return part;
      },
      [](const Lengths& a, const Lengths& b) { return a + b; });

  const double cubic = lines.cell_area() * metres * metres * metres;
  report.overhang = float(overhang * metres) + 0.0f;  // never -0
  report.overhang_bound = float(bound * metres);
  report.depth = float(depth * metres);
  report.uncovered = float(uncovered * metres);
  report.sample_spacing = float(solid.spacing * metres);
  report.solid_volume = sum.solid * cubic;
  report.hull_volume = sum.hulls * cubic;
  report.excess_volume = sum.excess * cubic;
  report.missing_volume = sum.missing * cubic;
  constexpr double kSlack = 1.05;  // vertices that a hull may not have
  report.within_concavity = overhang <= kSlack * solid.tolerance && depth <= kSlack * solid.tolerance;
}

}  // namespace gyre
