#include "geometry/query/face_query.h"

#include "geometry/distance/closest.h"

#include <cmath>

namespace gyre {

namespace {

constexpr double kAnyDistance = 1.0e9;  // m, more than any triangle is away
constexpr int kProjections = 4;         // to and fro between triangle and shape
constexpr int kDescents = 14;           // steps along the triangle; a failed one halves the next
constexpr double kFirstStep = 0.25;     // of the longest edge
constexpr double kLevel = 1.0e-3;        // slope along the triangle at which it is level

class FaceSearch {
 public:
  FaceSearch(const Shape& shape, const DVec3 (&corner)[3]) : shape_(shape), corner_(corner) {}

  bool run(double max_distance, double least_depth, FaceDistance& out) {
    const DVec3 middle = (1.0 / 3.0) * (corner_[0] + corner_[1] + corner_[2]);
    best_.distance = kAnyDistance;
    if (!look_at(middle)) return false;
    double bound = 0.0;  // of the slope's fall
    for (const DVec3 c : corner_) bound = min(bound, dot(best_.normal, c - middle));
    bound += best_.distance;
    if (bound > max_distance) return false;
    double at_corners = kAnyDistance;
    for (const DVec3 c : corner_) {
      PointDistance found;
      if (find_point_distance(shape_, c, kAnyDistance, found)) at_corners = min(at_corners, found.distance);
      if (bound > at_corners - least_depth) return false;
    }
    project();
    descend();
    out = best_;
    return out.distance < max_distance && out.distance < at_corners - least_depth;
  }

 private:
  // Keeps the point if it is the best so far.
  bool look_at(DVec3 point) {
    PointDistance found;
    if (!find_point_distance(shape_, point, kAnyDistance, found) || !(found.distance < best_.distance))
      return false;
    const SimplexPoint in = closest_on_triangle(point, corner_[0], corner_[1], corner_[2]);
    for (int k = 0; k < 3; ++k) best_.weight[k] = in.weights[k];
    best_.distance = found.distance, best_.normal = found.normal, best_.on_surface = found.on_surface;
    at_ = point;
    return true;
  }
  DVec3 into_triangle(DVec3 p) const { return closest_on_triangle(p, corner_[0], corner_[1], corner_[2]).point; }

  void project() {
    for (int n = 0; n < kProjections && best_.distance > 0.0; ++n) {
      if (!look_at(into_triangle(best_.on_surface))) return;
    }
  }
  void descend() {
    const DVec3 area = cross(corner_[1] - corner_[0], corner_[2] - corner_[0]);
    const double size = length(area);
    if (!(size > 0.0)) return;
    const DVec3 up = area / size;
    double step = 0.0;
    for (int k = 0; k < 3; ++k) step = max(step, kFirstStep * length(corner_[(k + 1) % 3] - corner_[k]));
    for (int n = 0; n < kDescents; ++n) {
      const DVec3 slope = best_.normal - dot(best_.normal, up) * up;
      const double steep = length(slope);
      if (!(steep > kLevel)) return;
      if (!look_at(into_triangle(at_ - (step / steep) * slope))) step *= 0.5;
    }
  }

  const Shape& shape_;
  const DVec3 (&corner_)[3];
  FaceDistance best_;
  DVec3 at_;
};

}  // namespace

bool has_face_distance(const Shape& shape) {
  return shape.kind != ShapeKind::plane && shape.kind != ShapeKind::mesh &&
         shape.kind != ShapeKind::height_field;
}

bool find_face_distance(const Shape& shape, const DVec3 (&corner)[3], double max_distance, double least_depth,
                        FaceDistance& out) {
  return FaceSearch(shape, corner).run(max_distance, least_depth, out);
}

}  // namespace gyre
