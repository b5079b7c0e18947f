// Sweeps against triangles. See swept_surface.h.
//
// A long way is cut into pieces of a few sizes, looked at in order: the boxes of the pieces meet far fewer triangles than
// the box of the whole.
#include "collision/swept_surface.h"

#include "geometry/mesh_axis.h"
#include "geometry/support.h"

namespace gyre {
namespace {

constexpr int kMaxPieces = 32;
constexpr float kPieceRadii = 4.0f;  // a piece is about so many outer radii long

// The moving shape as the surface sees it.
class SurfaceSweep {
 public:
  SurfaceSweep(const SweptShape& a, const SweptShape& core, const SweptShape& b, const ImpactScale& scale,
               TriangleHull& hull)
      : a_(a),
        core_(core),
        b_(b),
        surface_(*b.shape),
        scale_(scale),
        hull_(hull),
        start_(surface_from_a(0.0)) {}

  double first_impact(double end) {
    const float way = length(a_.sweep->moved - b_.sweep->moved) + length(a_.sweep->turned) * a_.radius;
    const int wanted = 1 + int(min(way / (kPieceRadii * a_.radius), float(kMaxPieces - 1)));
    for (int piece = 0; piece < wanted; ++piece) {
      const double from = double(piece) / double(wanted);
      if (from >= end) return end;
      const double to = min(double(piece + 1) / double(wanted), end);
      const double time = look_at_piece(from, to);
      if (time < to) return time;
    }
    return end;
  }

 private:
  Transform surface_from_a(double time) const {
    return inverse_times(pose_at(*b_.sweep, time) * b_.body_from_shape,
                         pose_at(*a_.sweep, time) * a_.body_from_shape);
  }

  // Holds the shape all along the piece, in the surface's frame. A turn bulges out of the box around its two ends by
  // at most r (1 - cos(angle / 2)) < r angle^2 / 8.
  Aabb piece_box(double from, double to) const {
    const Transform at_start = surface_from_a(from), at_end = surface_from_a(to);
    const float share = float(to - from);
    const float angle_a = share * length(a_.sweep->turned), angle_b = share * length(b_.sweep->turned);
    const float lever = max(length(at_start.position), length(at_end.position)) +
                        length(b_.body_from_shape.position - b_.sweep->center) + a_.radius;
    const float bulge = 0.125f * (a_.radius * square(angle_a) + lever * square(angle_b));
    return grow(merge(bounds(*a_.shape, at_start), bounds(*a_.shape, at_end)),
                bulge + float(scale_.touching));
  }

  double look_at_piece(double from, double to) {
    const Aabb box = piece_box(from, to);
    // Triangles are moved near the origin of a frame of their own, so that floats stay small in a large mesh.
    origin_ = surface_from_a(from).position;
    near_frame_ = b_;
    near_frame_.body_from_shape = b_.body_from_shape * Transform{origin_, {}};
    double end = to;
    if (surface_.mesh != nullptr) {
      walk_overlaps(
          surface_.mesh->tree, box, [](std::uint32_t, int) { return true; },
          [&](std::uint32_t first, std::uint32_t count) {
            for (std::uint32_t id = first; id < first + count; ++id) {
              if (overlap(triangle_box(*surface_.mesh, id), box)) end = look_at(id, from, end);
            }
          });
      return end;
    }
    walk_cells(
        *surface_.field, box, [](HeightBlock) { return true; },
        [&](std::uint32_t column, std::uint32_t row) {
          if (!is_solid_cell(*surface_.field, column, row)) return;
          const std::uint32_t cell = row * surface_.field->cell_columns() + column;
          end = look_at(2 * cell, from, end);
          end = look_at(2 * cell + 1, from, end);
        });
    return end;
  }

  double look_at(std::uint32_t id, double from, double end) {
    const TriangleView view = surface_.triangle(id);
    Vec3 normal = view.normal;
    // Which side of the plane the middle is on when the step begins decides; along a straight way it cannot come back.
    const Vec3 middle = start_ * inverse_times(a_.body_from_shape, core_.body_from_shape.position);
    if (dot(normal, middle - view.v[0]) < 0.0f) {
      if (!surface_.double_sided()) return end;
      normal = -normal;
    }
    const Vec3 lowest = start_ * support(*a_.shape, rotate_inverse(start_.orientation, -normal));
    const double height = double(dot(normal, lowest - view.v[0])) - double(core_radius(*a_.shape));
    hull_.set(view.v[0] - origin_, view.v[1] - origin_, view.v[2] - origin_);
    near_frame_.shape = &hull_.shape();
    near_frame_.radius =
        outer_radius(hull_.shape(), inverse_times(near_frame_.body_from_shape, b_.sweep->center));
    if (height > scale_.touching) {
      const Impact impact = time_of_impact(a_, near_frame_, from, end, scale_.target);
      return impact.hit ? impact.time : end;
    }
    if (from == 0.0 && find_gap(core_, near_frame_, 0.0, scale_.core_target).distance <= scale_.core_target)
      return end;
    const Impact impact = time_of_impact(core_, near_frame_, from, end, scale_.core_target);
    return impact.hit ? impact.time : end;
  }

  const SweptShape& a_;
  const SweptShape& core_;
  const SweptShape& b_;
  const Surface surface_;
  const ImpactScale& scale_;
  TriangleHull& hull_;
  const Transform start_;
  Vec3 origin_;
  SweptShape near_frame_;
};

}  // namespace

TriangleHull::TriangleHull() {
  hull_.x.assign(Hull::kPad, 0.0f);
  hull_.y.assign(Hull::kPad, 0.0f);
  hull_.z.assign(Hull::kPad, 0.0f);
  hull_.vertices.assign(3, Vec3{});
  shape_.kind = ShapeKind::hull;
  shape_.hull = &hull_;
}

void TriangleHull::set(Vec3 a, Vec3 b, Vec3 c) {
  const Vec3 corners[3] = {a, b, c};
  for (int i = 0; i < Hull::kPad; ++i) {
    const Vec3 corner = corners[min(i, 2)];
    hull_.x[std::size_t(i)] = corner.x;
    hull_.y[std::size_t(i)] = corner.y;
    hull_.z[std::size_t(i)] = corner.z;
  }
  for (std::size_t i = 0; i < 3; ++i) hull_.vertices[i] = corners[i];
  hull_.box = {min(a, min(b, c)), max(a, max(b, c))};
  hull_.centroid = (a + b + c) / 3.0f;
}

Core make_core(const Shape& shape, const Transform& body_from_shape, float share) {
  Core core;
  core.ball.kind = ShapeKind::sphere;
  core.ball.radius = share * inner_radius(shape);
  const Vec3 middle = shape.kind == ShapeKind::hull ? shape.hull->centroid : Vec3{};
  core.body_from_ball = {body_from_shape * middle, body_from_shape.orientation};
  return core;
}

double impact_with_surface(const SweptShape& a, const SweptShape& core, const SweptShape& b, double end,
                           const ImpactScale& scale, TriangleHull& triangle) {
  return SurfaceSweep(a, core, b, scale, triangle).first_impact(end);
}

}  // namespace gyre
