// Axis-aligned and oriented bounding boxes. See gyre/bounds.h for the sources.
#include "base/container/sort.h"
#include "base/float_mode.h"
#include "geometry/bounds/bounds_points.h"

namespace gyre {
namespace {

constexpr std::size_t kMaxEdges = 64;
// This many of the best boxes are improved by rotations.
constexpr int kMaxStarts = 8;
constexpr int kMaxRotations = 60;
// A rotation must shrink the cost by this fraction.
constexpr double kMinGain = 1.0e-9;

struct Point2 {
  double x, y;
};
double cross(Point2 o, Point2 a, Point2 b) { return (a.x - o.x) * (b.y - o.y) - (a.y - o.y) * (b.x - o.x); }

// The convex hull of points in a plane, counter-clockwise, without repetitions. A. Andrew, 1979.
void plane_hull(std::vector<Point2>& points, std::vector<Point2>& scratch, std::vector<Point2>& hull) {
  scratch.resize(points.size());
  merge_sort(std::span(points), std::span(scratch),
             [](const Point2& a, const Point2& b) { return a.x < b.x || (a.x == b.x && a.y < b.y); });
  hull.clear();
  const auto add = [&](Point2 p, std::size_t min_size) {
    while (hull.size() >= min_size + 2 && cross(hull[hull.size() - 2], hull.back(), p) <= 0.0)
      hull.pop_back();
    hull.push_back(p);
  };
  for (const Point2& p : points) add(p, 0);
  const std::size_t lower = hull.size() - 1;
  for (std::size_t i = points.size() - 1; i-- > 0;) add(points[i], lower);
  if (hull.size() > 1) hull.pop_back();
}

struct BoxCandidate {
  DAxes axes;
  double cost;
};

// The volume, and a small weight on the surface, so that flat boxes have an optimum too.
double cost_of(DVec3 extents, double size) {
  const double surface = extents.x * extents.y + extents.y * extents.z + extents.z * extents.x;
  return extents.x * extents.y * extents.z + 1.0e-12 * size * surface;
}

// Searches boxes around the points of an outline.
class BoxSearch {
 public:
  explicit BoxSearch(std::span<const DVec3> points) : points_(points) {
    const DVec3 extents = extents_along({});
    size_ = max(extents.x, max(extents.y, extents.z));
  }

  DVec3 extents_along(const DAxes& axes) const {
    DVec3 extents;
    const auto along = [&](DVec3 axis) {
      double low = dot(axis, points_[0]), high = low;
      for (const DVec3& p : points_) {
        low = min(low, dot(axis, p));
        high = max(high, dot(axis, p));
      }
      return high - low;
    };
    extents = {along(axes.x), along(axes.y), along(axes.z)};
    return extents;
  }
  BoxCandidate candidate(const DAxes& axes) const { return {axes, cost_of(extents_along(axes), size_)}; }

  // The best box with `axis` as one of its axes. It is exact, because one of its sides contains an edge of the outline
  // seen along the axis.
  BoxCandidate best_about(DVec3 axis) {
    const DVec3 u = some_perpendicular(axis), v = gyre::cross(axis, u);
    flat_.clear();
    double low = dot(axis, points_[0]), high = low;
    for (const DVec3& p : points_) {
      const DVec3 from = p - points_[0];
      flat_.push_back({dot(u, from), dot(v, from)});
      low = min(low, dot(axis, p));
      high = max(high, dot(axis, p));
    }
    plane_hull(flat_, scratch_, hull_);
    BoxCandidate best{{u, v, axis}, 0.0};
    bool found = false;
    for (std::size_t i = 0; i < hull_.size() || !found; ++i) {
      const Point2 a = hull_[i % hull_.size()], b = hull_[(i + 1) % hull_.size()];
      double x = b.x - a.x, y = b.y - a.y;
      const double edge = std::sqrt(x * x + y * y);
      x = edge > 0.0 ? x / edge : 1.0;
      y = edge > 0.0 ? y / edge : 0.0;
      double low_x = 1e300, high_x = -1e300, low_y = 1e300, high_y = -1e300;
      for (const Point2& p : hull_) {
        const double along = p.x * x + p.y * y, across = p.y * x - p.x * y;
        low_x = min(low_x, along);
        high_x = max(high_x, along);
        low_y = min(low_y, across);
        high_y = max(high_y, across);
      }
      const double cost = cost_of({high_x - low_x, high_y - low_y, high - low}, size_);
      if (found && cost >= best.cost) continue;
      found = true;
      best = {{x * u + y * v, x * v - y * u, axis}, cost};
    }
    return best;
  }

  // Rotates the box about each of its own axes in turn, as long as it shrinks.
  BoxCandidate descended(BoxCandidate start) {
    int unchanged = 0;
    for (int rotation = 0; rotation < kMaxRotations && unchanged < 3; ++rotation) {
      const DVec3 axis = rotation % 3 == 0 ? start.axes.x : rotation % 3 == 1 ? start.axes.y : start.axes.z;
      const BoxCandidate candidate_box = best_about(axis);
      if (candidate_box.cost < start.cost * (1.0 - kMinGain)) {
        // The order of its axes makes the next rotations try other axes first.
        start = candidate_box;
        unchanged = 0;
      } else {
        ++unchanged;
      }
    }
    return start;
  }

 private:
  std::span<const DVec3> points_;
  double size_ = 0.0;
  std::vector<Point2> flat_, scratch_, hull_;
};

// Directions of edges, without repetition or reversal, the longest first; at most kMaxEdges.
std::vector<DVec3> main_directions(const std::vector<DVec3>& edges) {
  std::vector<DVec3> sorted = edges, scratch(edges.size()), directions;
  merge_sort(std::span(sorted), std::span(scratch),
             [](const DVec3& a, const DVec3& b) { return length_squared(a) > length_squared(b); });
  for (const DVec3& edge : sorted) {
    const DVec3 direction = unit(edge);
    bool is_new = directions.size() < kMaxEdges;
    for (const DVec3& other : directions)
      is_new = is_new && length_squared(gyre::cross(direction, other)) > 1.0e-10;
    if (is_new) directions.push_back(direction);
  }
  return directions;
}

void insert_best(std::vector<BoxCandidate>& best, const BoxCandidate& candidate) {
  std::size_t slot = best.size();
  while (slot > 0 && candidate.cost < best[slot - 1].cost) --slot;
  if (slot >= kMaxStarts) return;
  best.insert(best.begin() + std::ptrdiff_t(slot), candidate);
  if (best.size() > kMaxStarts) best.pop_back();
}

DAxes smallest_axes(const Outline& outline) {
  BoxSearch search(outline.points);
  std::vector<BoxCandidate> best;
  for (const DVec3& axis :
       {DVec3(1, 0, 0), DVec3(0, 1, 0), DVec3(0, 0, 1), outline.axes.x, outline.axes.y, outline.axes.z})
    insert_best(best, search.best_about(axis));
  for (const DVec3& normal : outline.face_normals) insert_best(best, search.best_about(normal));
  const std::vector<DVec3> directions = main_directions(outline.edges);
  for (std::size_t i = 0; i < directions.size(); ++i) {
    for (std::size_t k = i + 1; k < directions.size(); ++k) {
      insert_best(best, search.best_about(unit(gyre::cross(directions[i], directions[k]))));
    }
  }
  BoxCandidate smallest = best[0];
  for (const BoxCandidate& start : best) {
    const BoxCandidate end = search.descended(start);
    if (end.cost < smallest.cost) smallest = end;
  }
  return smallest.axes;
}

// The box around all points (an outline has only some of them), rounded outward.
OrientedBox box_around(std::span<const Vec3> points, const DAxes& target_axes) {
  OrientedBox box;
  box.orientation = to_quaternion(target_axes);
  const DAxes axes = axes_of(box.orientation);
  const DVec3 each[3] = {axes.x, axes.y, axes.z};
  const DVec3 origin(points[0]);
  DVec3 center = origin;
  for (const DVec3& axis : each) {
    double low = 0.0, high = 0.0;
    for (const Vec3& p : points) {
      const double along = dot(axis, DVec3(p) - origin);
      low = min(low, along);
      high = max(high, along);
    }
    center += 0.5 * (low + high) * axis;
  }
  box.center = to_float(center);
  float half[3];
  for (int i = 0; i < 3; ++i) {
    double farthest = 0.0;
    for (const Vec3& p : points)
      farthest = max(farthest, absolute(dot(each[i], DVec3(p) - DVec3(box.center))));
    half[i] = round_up_to_float(farthest);
  }
  box.half_extents = {half[0], half[1], half[2]};
  return box;
}

void add_corners(const OrientedBox& box, std::vector<Vec3>& corners, std::vector<DVec3>& exact) {
  const DAxes axes = axes_of(box.orientation);
  for (int i = 0; i < 8; ++i) {
    const auto offset = [&](int axis) {
      return ((i >> axis & 1) != 0 ? 1.0 : -1.0) * double(box.half_extents[axis]);
    };
    exact.push_back(DVec3(box.center) + offset(0) * axes.x + offset(1) * axes.y + offset(2) * axes.z);
    corners.push_back(to_float(exact.back()));
  }
}

}  // namespace

Result<Aabb> fit_box(std::span<const Vec3> points) {
  if (const Error e = check_bounded_points(points)) return e;
  Aabb box{points[0], points[0]};
  for (const Vec3& p : points) box = {min(box.low, p), max(box.high, p)};
  return box;
}
bool contains(const Aabb& box, Vec3 point) { return contains(box, Aabb{point, point}); }
double volume(const Aabb& box) {
  const DVec3 d = DVec3(box.high) - DVec3(box.low);
  return d.x * d.y * d.z;
}
double surface_area(const Aabb& box) {
  const DVec3 d = DVec3(box.high) - DVec3(box.low);
  return 2.0 * (d.x * d.y + d.y * d.z + d.z * d.x);
}

Result<OrientedBox> fit_oriented_box_fast(std::span<const Vec3> points) {
  const FloatMode mode;
  if (const Error e = check_bounded_points(points)) return e;
  return box_around(points, outline_of(points).axes);
}

Result<OrientedBox> fit_oriented_box(std::span<const Vec3> points) {
  const FloatMode mode;
  if (const Error e = check_bounded_points(points)) return e;
  return box_around(points, smallest_axes(outline_of(points)));
}

OrientedBox merge(const OrientedBox& a, const OrientedBox& b) {
  const FloatMode mode;
  std::vector<Vec3> corners;
  std::vector<DVec3> exact;
  add_corners(a, corners, exact);
  add_corners(b, corners, exact);
  const BoxSearch search(exact);
  DAxes best = axes_of(a.orientation);
  for (const DAxes& axes : {axes_of(b.orientation), smallest_axes(outline_of(corners))}) {
    if (search.candidate(axes).cost < search.candidate(best).cost) best = axes;
  }
  OrientedBox box = box_around(corners, best);
  // The corners were rounded, so the box grows to contain the exact ones.
  const DAxes axes = axes_of(box.orientation);
  const DVec3 each[3] = {axes.x, axes.y, axes.z};
  float half[3];
  for (int i = 0; i < 3; ++i) {
    double farthest = 0.0;
    for (const DVec3& p : exact) farthest = max(farthest, absolute(dot(each[i], p - DVec3(box.center))));
    half[i] = round_up_to_float(farthest * (1.0 + 1.0e-14));
  }
  box.half_extents = {half[0], half[1], half[2]};
  return box;
}

bool overlap(const OrientedBox& a, const OrientedBox& b) {
  const DAxes a_axes = axes_of(a.orientation), b_axes = axes_of(b.orientation);
  const DVec3 ax[3] = {a_axes.x, a_axes.y, a_axes.z}, bx[3] = {b_axes.x, b_axes.y, b_axes.z};
  const DVec3 offset = DVec3(b.center) - DVec3(a.center);
  const auto separates = [&](DVec3 axis) {
    double radius = 0.0;
    for (int i = 0; i < 3; ++i) {
      radius += double(a.half_extents[i]) * absolute(dot(axis, ax[i])) +
                double(b.half_extents[i]) * absolute(dot(axis, bx[i]));
    }
    return absolute(dot(axis, offset)) > radius;
  };
  for (int i = 0; i < 3; ++i) {
    if (separates(ax[i]) || separates(bx[i])) return false;
  }
  for (const DVec3& u : ax) {
    for (const DVec3& v : bx) {
      const DVec3 axis = gyre::cross(u, v);
      // Parallel axes add nothing to the six above.
      if (length_squared(axis) > 1.0e-12 && separates(axis)) return false;
    }
  }
  return true;
}

bool contains(const OrientedBox& box, Vec3 point) {
  const DAxes axes = axes_of(box.orientation);
  const DVec3 offset = DVec3(point) - DVec3(box.center);
  return absolute(dot(axes.x, offset)) <= double(box.half_extents.x) &&
         absolute(dot(axes.y, offset)) <= double(box.half_extents.y) &&
         absolute(dot(axes.z, offset)) <= double(box.half_extents.z);
}
double volume(const OrientedBox& box) { return volume(Aabb{-box.half_extents, box.half_extents}); }
double surface_area(const OrientedBox& box) {
  return surface_area(Aabb{-box.half_extents, box.half_extents});
}

}  // namespace gyre
