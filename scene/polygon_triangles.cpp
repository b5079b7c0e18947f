// Ears in the order of their quality. See polygon_triangles.h.
#include "scene/polygon_triangles.h"

namespace gyre {
namespace {

// Corners within this share of the length of a line lie on it: the rounding of coordinates with seven digits.
constexpr double kOnLine = 1.0e-6;

struct Point {
  double x, y;
};
Point operator-(Point a, Point b) { return {a.x - b.x, a.y - b.y}; }
double cross(Point a, Point b) { return a.x * b.y - a.y * b.x; }
double length_squared(Point a) { return a.x * a.x + a.y * a.y; }
bool same(Point a, Point b) { return a.x == b.x && a.y == b.y; }

// Twice the area of the triangle, relative to the square of its longest side; negative if it is clockwise.
double quality(Point a, Point b, Point c) {
  const double longest = max(length_squared(b - a), max(length_squared(c - b), length_squared(a - c)));
  return longest > 0.0 ? cross(b - a, c - a) / longest : 0.0;
}

// The corners in the plane in which the polygon is counter-clockwise and largest.
std::vector<Point> project(std::span<const Vec3> corners) {
  DVec3 normal;
  const DVec3 origin(corners[0]);
  for (std::size_t i = 1; i + 1 < corners.size(); ++i)
    normal += gyre::cross(DVec3(corners[i]) - origin, DVec3(corners[i + 1]) - origin);
  int axis = 0;
  for (int k = 1; k < 3; ++k) {
    if (absolute(normal[k]) > absolute(normal[axis])) axis = k;
  }
  const int u = (axis + 1) % 3, v = (axis + 2) % 3;
  std::vector<Point> points;
  for (const Vec3& corner : corners) {
    const DVec3 p = DVec3(corner) - origin;
    points.push_back(normal[axis] >= 0.0 ? Point{p[u], p[v]} : Point{p[v], p[u]});
  }
  return points;
}

class EarClipper {
 public:
  explicit EarClipper(std::span<const Vec3> corners) : points_(project(corners)) {
    const std::uint32_t count = std::uint32_t(corners.size());
    for (std::uint32_t i = 0; i < count; ++i) {
      before_.push_back(i == 0 ? count - 1 : i - 1);
      after_.push_back(i + 1 == count ? 0 : i + 1);
    }
    for (std::uint32_t i = 0; i < count; ++i) quality_.push_back(ear_quality(i));
  }

  std::vector<std::uint32_t> clip() {
    std::vector<std::uint32_t> triangles;
    std::uint32_t at = 0;
    for (std::size_t left = points_.size(); left > 2; --left) {
      std::uint32_t best = at;
      for (std::uint32_t i = after_[at]; i != at; i = after_[i]) {
        if (quality_[i] > quality_[best]) best = i;
      }
      const std::uint32_t a = before_[best], b = after_[best];
      for (const std::uint32_t corner : {a, best, b}) triangles.push_back(corner);
      after_[a] = b;
      before_[b] = a;
      quality_[a] = ear_quality(a);
      quality_[b] = ear_quality(b);
      at = a;
    }
    return triangles;
  }

 private:
  // Above 0 if the corner can be cut off, and else a number by which the least bad corner is found.
  double ear_quality(std::uint32_t i) const {
    const Point a = points_[before_[i]], b = points_[i], c = points_[after_[i]];
    const double shape = quality(a, b, c);
    if (!(shape > kOnLine)) return shape - 2.0;
    for (std::uint32_t k = after_[after_[i]]; k != before_[i]; k = after_[k]) {
      const Point p = points_[k];
      if (same(p, a) || same(p, b) || same(p, c)) continue;
      // A corner on the new side would have no triangle of its own.
      if (quality(a, b, p) > -kOnLine && quality(b, c, p) > -kOnLine && quality(c, a, p) > -kOnLine)
        return shape - 1.0 - kOnLine;
    }
    return shape;
  }

  std::vector<Point> points_;
  std::vector<std::uint32_t> before_, after_;  // neighbours among the corners that are left
  std::vector<double> quality_;
};

}  // namespace

bool is_fan(std::span<const Vec3> corners) {
  const std::vector<Point> points = project(corners);
  for (std::size_t i = 1; i + 1 < points.size(); ++i) {
    if (!(quality(points[0], points[i], points[i + 1]) > kOnLine)) return false;
  }
  return true;
}

std::vector<std::uint32_t> triangulate_polygon(std::span<const Vec3> corners) {
  if (corners.size() > 3 && !is_fan(corners)) return EarClipper(corners).clip();
  std::vector<std::uint32_t> triangles;
  for (std::uint32_t i = 1; i + 1 < corners.size(); ++i) {
    for (const std::uint32_t corner : {0u, i, i + 1}) triangles.push_back(corner);
  }
  return triangles;
}

}  // namespace gyre
