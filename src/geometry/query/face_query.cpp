#include "geometry/query/face_query.h"

#include "geometry/distance/closest.h"
#include "geometry/query/cast_surface.h"
#include "geometry/shape/height_field.h"

#include <cmath>

namespace gyre {

namespace {

constexpr double kAnyDistance = 1.0e9;  // m, more than any triangle is away
constexpr int kProjections = 4;         // to and fro between triangle and shape
constexpr int kDescents = 14;           // steps along the triangle; a failed one halves the next
constexpr double kFirstStep = 0.25;     // of the longest edge
constexpr double kAcross = 0.5;         // cosine of the normal of two edges and that of the face, at least
constexpr double kLevel = 1.0e-3;       // slope along the triangle at which it is level

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
  DVec3 into_triangle(DVec3 p) const {
    return closest_on_triangle(p, corner_[0], corner_[1], corner_[2]).point;
  }

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

// Looks at the corners and edges of the triangles of a surface from the face.
class FeatureSearch {
 public:
  FeatureSearch(const Shape& surface, const DVec3 (&corner)[3], double reach, double limit)
      : surface_(surface), corner_(corner), reach_(reach), limit_(limit) {
    const DVec3 area = cross(corner[1] - corner[0], corner[2] - corner[0]);
    const double size = length(area);
    is_flat_ = size > 0.0;
    if (is_flat_) up_ = area / size;
  }

  bool run(FaceDistance& out) {
    if (!is_flat_) return false;
    best_.distance = limit_;
    DVec3 low = corner_[0], high = corner_[0];
    for (const DVec3 c : corner_) {
      low = {min(low.x, c.x), min(low.y, c.y), min(low.z, c.z)};
      high = {max(high.x, c.x), max(high.y, c.y), max(high.z, c.z)};
    }
    // A feature that touches the face between its corners is above or below it.
    const DVec3 pad = 1.001 * reach_ * DVec3{absolute(up_.x), absolute(up_.y), absolute(up_.z)};
    const Aabb box{to_float(low - pad), to_float(high + pad)};
    if (surface_.kind == ShapeKind::mesh) {
      const Mesh& mesh = *surface_.mesh;
      walk_overlaps(
          mesh.tree, box, [](std::uint32_t, int) { return true; },
          [&](std::uint32_t first, std::uint32_t count) {
            for (std::uint32_t id = first; id < first + count; ++id) test(surface_triangle(mesh, id));
          });
    } else {
      const HeightField& field = *surface_.field;
      walk_cells(
          field, box, [](HeightBlock) { return true; },
          [&](std::uint32_t column, std::uint32_t row) {
            if (!is_solid_cell(field, column, row)) return;
            for (int half = 0; half < 2; ++half) test(surface_triangle(field, column, row, half));
          });
    }
    out = best_;
    return found_;
  }

 private:
  void test(const SurfaceTriangle& triangle) {
    const DVec3 p[3] = {DVec3(triangle.a), DVec3(triangle.b), DVec3(triangle.c)};
    const double facing = dot(cross(p[1] - p[0], p[2] - p[0]), up_);
    if (facing == 0.0) return;
    const DVec3 out = facing > 0.0 ? up_ : -up_;
    double height[3];  // of the triangle's corners above the face, to the outside of the surface
    for (int k = 0; k < 3; ++k) height[k] = dot(p[k] - corner_[0], out);
    const double highest = max(height[0], max(height[1], height[2]));
    if (highest < -limit_ || highest > reach_) return;
    for (int k = 0; k < 3; ++k) {
      if (height[k] < -limit_) continue;
      const SimplexPoint in = closest_on_triangle(p[k], corner_[0], corner_[1], corner_[2]);
      if (in.corners == 7) take(-height[k], in.point, p[k], out);
    }
    for (int k = 0; k < 3; ++k) {
      for (int n = 0; n < 3; ++n) {
        const SegmentPair near = closest_of_segments(corner_[n], corner_[(n + 1) % 3], p[k], p[(k + 1) % 3]);
        if (!(near.s > 0.0 && near.s < 1.0 && near.t > 0.0 && near.t < 1.0)) continue;
        const DVec3 way = near.on_a - near.on_b;
        const double along = dot(way, out), apart = length(way);
        // Of edges that pass beside each other, other features are nearer.
        if (absolute(along) < kAcross * apart) continue;
        take(along, near.on_a, near.on_a - along * out, out);
      }
    }
  }
  void take(double distance, DVec3 on_face, DVec3 on_surface, DVec3 normal) {
    if (!(distance < best_.distance) || distance < -reach_) return;
    found_ = true;
    best_.distance = distance, best_.normal = normal, best_.on_surface = on_surface;
    const SimplexPoint in = closest_on_triangle(on_face, corner_[0], corner_[1], corner_[2]);
    for (int k = 0; k < 3; ++k) best_.weight[k] = in.weights[k];
  }

  const Shape& surface_;
  const DVec3 (&corner_)[3];
  double reach_, limit_;
  DVec3 up_{};
  bool is_flat_ = false, found_ = false;
  FaceDistance best_;
};

}  // namespace

bool find_surface_features(const Shape& surface, const DVec3 (&corner)[3], double reach, double limit,
                           FaceDistance& out) {
  return FeatureSearch(surface, corner, reach, limit).run(out);
}

bool has_face_distance(const Shape& shape) {
  return shape.kind != ShapeKind::plane && shape.kind != ShapeKind::mesh &&
         shape.kind != ShapeKind::height_field;
}

bool find_face_distance(const Shape& shape, const DVec3 (&corner)[3], double max_distance, double least_depth,
                        FaceDistance& out) {
  return FaceSearch(shape, corner).run(max_distance, least_depth, out);
}

}  // namespace gyre
