// Bounding spheres: fast and smallest. See gyre/bounds.h for the sources.
#include "base/float_mode.h"
#include "geometry/bounds/bounds_points.h"

namespace gyre {
namespace {

// A point counts as inside a ball up to this fraction of its radius.
constexpr double kInside = 1.0e-14;

bool encloses(const Ball& ball, DVec3 p) {
  return ball.radius >= 0.0 &&
         length_squared(p - ball.center) <= ball.radius * ball.radius * (1.0 + 2.0 * kInside);
}

// The ball with up to four points on its surface and its centre in the point, line, plane or space that they span. The
// radius is negative if they span less.
Ball ball_through(const DVec3* points, int count) {
  if (count == 0) return {};
  // center = p0 + sum of t_i d_i, with d_i = p_i - p0 and |center - p0| = |center - p_i|: 2 d_i . sum t_k d_k = d_i . d_i.
  double a[3][4] = {};
  const int n = count - 1;
  for (int i = 0; i < n; ++i) {
    const DVec3 d = points[i + 1] - points[0];
    for (int k = 0; k < n; ++k) a[i][k] = 2.0 * dot(d, points[k + 1] - points[0]);
    a[i][3] = dot(d, d);
  }
  for (int i = 0; i < n; ++i) {
    int pivot = i;
    for (int k = i + 1; k < n; ++k) {
      if (absolute(a[k][i]) > absolute(a[pivot][i])) pivot = k;
    }
    const DVec3 d = points[pivot + 1] - points[0];
    if (!(absolute(a[pivot][i]) > 1.0e-12 * dot(d, d))) return {};
    for (int k = 0; k < 4; ++k) std::swap(a[i][k], a[pivot][k]);
    for (int row = 0; row < n; ++row) {
      if (row == i) continue;
      const double factor = a[row][i] / a[i][i];
      for (int k = i; k < 4; ++k) a[row][k] -= factor * a[i][k];
    }
  }
  DVec3 offset;
  for (int i = 0; i < n; ++i) offset += (a[i][3] / a[i][i]) * (points[i + 1] - points[0]);
  return {points[0] + offset, length(offset)};
}

// Welzl's recursion with moves to the front: the smallest ball around list[0 .. end) with `count` given points on its
// surface.
struct BallSearch {
  std::span<const DVec3> points;
  std::vector<std::size_t> list;

  Ball around(std::size_t end, DVec3* surface, int count) {
    Ball ball = ball_through(surface, count);
    if (count == 4) return ball;
    for (std::size_t i = 0; i < end; ++i) {
      const DVec3 p = points[list[i]];
      if (encloses(ball, p)) continue;
      surface[count] = p;
      const Ball larger = around(i, surface, count + 1);
      if (larger.radius < 0.0) continue;  // in line with the others: the ball contains it but for rounding
      ball = larger;
      const std::size_t moved = list[i];
      for (std::size_t k = i; k > 0; --k) list[k] = list[k - 1];
      list[0] = moved;
    }
    return ball;
  }
};

}  // namespace

Ball smallest_ball(std::span<const DVec3> points) {
  BallSearch search{points, {}};
  Ball ball{points[0], 0.0};
  search.list.push_back(0);
  // Each round adds the point farthest outside. The ball grows until no point is outside.
  for (;;) {
    double farthest = ball.radius * ball.radius * (1.0 + 2.0 * kInside);
    std::size_t pivot = points.size();
    for (std::size_t i = 0; i < points.size(); ++i) {
      const double squared = length_squared(points[i] - ball.center);
      if (squared > farthest) {
        farthest = squared;
        pivot = i;
      }
    }
    if (pivot == points.size()) return ball;
    DVec3 surface[4] = {points[pivot]};
    const Ball larger = search.around(search.list.size(), surface, 1);
    // Only rounding errors remain.
    if (!(larger.radius > ball.radius)) return ball;
    ball = larger;
    search.list.insert(search.list.begin(), pivot);
  }
}

namespace {

BoundingSphere rounded(const Ball& ball, std::span<const Vec3> points) {
  BoundingSphere sphere{to_float(ball.center), 0.0f};
  double farthest = 0.0;
  for (const Vec3& p : points) farthest = max(farthest, length(DVec3(p) - DVec3(sphere.center)));
  sphere.radius = round_up_to_float(farthest * (1.0 + 1.0e-15));
  return sphere;
}

}  // namespace

Result<BoundingSphere> fit_sphere(std::span<const Vec3> points) {
  const FloatMode mode;
  if (const Error e = check_bounded_points(points)) return e;
  std::vector<DVec3> exact;
  for (const Vec3& p : points) exact.emplace_back(p);
  return rounded(smallest_ball(exact), points);
}

Result<BoundingSphere> fit_sphere_fast(std::span<const Vec3> points) {
  const FloatMode mode;
  if (const Error e = check_bounded_points(points)) return e;
  const auto farthest_from = [&](Vec3 from) {
    Vec3 best = from;
    for (const Vec3& p : points) {
      if (length_squared(DVec3(p) - DVec3(from)) > length_squared(DVec3(best) - DVec3(from))) best = p;
    }
    return best;
  };
  const DVec3 a(farthest_from(points[0]));
  const DVec3 b(farthest_from(to_float(a)));
  Ball ball{0.5 * (a + b), 0.5 * length(b - a)};
  for (const Vec3& p : points) {
    const DVec3 offset = DVec3(p) - ball.center;
    const double distance = length(offset);
    if (distance <= ball.radius) continue;
    // The smallest ball around the current one and the point.
    const double radius = 0.5 * (ball.radius + distance);
    ball = {ball.center + ((distance - radius) / distance) * offset, radius};
  }
  return rounded(ball, points);
}

BoundingSphere merge(const BoundingSphere& a, const BoundingSphere& b) {
  const DVec3 offset = DVec3(b.center) - DVec3(a.center);
  const double apart = length(offset), ra = double(a.radius), rb = double(b.radius);
  if (apart + rb <= ra) return a;
  if (apart + ra <= rb) return b;
  const double radius = 0.5 * (apart + ra + rb);
  const Vec3 center = to_float(DVec3(a.center) + ((radius - ra) / apart) * offset);
  // Rounding moved the centre; both must still fit.
  const double needed =
      max(length(DVec3(center) - DVec3(a.center)) + ra, length(DVec3(center) - DVec3(b.center)) + rb);
  return {center, round_up_to_float(needed * (1.0 + 1.0e-15))};
}

bool overlap(const BoundingSphere& a, const BoundingSphere& b) {
  const double radii = double(a.radius) + double(b.radius);
  return length_squared(DVec3(b.center) - DVec3(a.center)) <= radii * radii;
}
bool contains(const BoundingSphere& sphere, Vec3 point) {
  return length(DVec3(point) - DVec3(sphere.center)) <= double(sphere.radius);
}
double volume(const BoundingSphere& sphere) {
  const auto r = double(sphere.radius);
  return 4.0 / 3.0 * kPiDouble * r * r * r;
}
double surface_area(const BoundingSphere& sphere) {
  const auto r = double(sphere.radius);
  return 4.0 * kPiDouble * r * r;
}

}  // namespace gyre
