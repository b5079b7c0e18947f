// GJK against convex shapes, planes and triangles; closed forms for balls against balls, capsules and boxes. See
// closest_points.h.
#include "geometry/query/closest_points.h"

#include "geometry/distance/closest.h"
#include "geometry/query/cast_ball.h"
#include "geometry/query/cast_surface.h"
#include "geometry/shape/support.h"

namespace gyre {
namespace {

// Relative rounding error of the distances of boxes and cores.
constexpr double kDistanceRounding = 1.0e-6;

// From the distance of two cores to that of two surfaces.
void fill(const CoreDistance& near, double radius_a, double radius_b, ClosestPair& out) {
  const double radii = radius_a + radius_b;
  out.normal = near.normal;
  out.overlap = near.overlap || near.distance <= radii;
  out.distance = out.overlap ? 0.0 : near.distance - radii;
  out.on_target = near.on_a + radius_a * near.normal;
  out.on_convex = near.on_b - radius_b * near.normal;
  if (near.overlap) {
    out.on_target = out.on_convex = near.on_a;
  } else if (out.overlap) {
    out.on_target = out.on_convex = 0.5 * (out.on_target + out.on_convex);
  }
}

bool finish(const CorePair& pair, double radius_a, double radius_b, double max_distance, ClosestPair& out) {
  const double radii = radius_a + radius_b;
  // Search slightly farther than required, because hulls choose their support points in float.
  const double max_core_distance =
      (max_distance + radii) * (1.0 + kDistanceRounding) + kDistanceRounding * pair.size();
  const CoreDistance near = core_distance(pair, max_core_distance, {});
  if (near.beyond || near.distance - radii > max_distance) return false;
  fill(near, radius_a, radius_b, out);
  return true;
}

// A ball against a shape whose core is a point, a segment or a box. Returns false if the centre of the ball lies in
// that core.
bool nearest_of_ball(const Shape& target, const PosedShape& ball, double max_distance, ClosestPair& out,
                     bool& in_range) {
  const DVec3 core = box_core(target), p = ball.position;
  CoreDistance near;
  near.on_a = {clamp(p.x, -core.x, core.x), clamp(p.y, -core.y, core.y), clamp(p.z, -core.z, core.z)};
  near.on_b = p;
  const DVec3 offset = p - near.on_a;
  near.distance = length(offset);
  if (!(near.distance > kDistanceRounding * length(p))) return false;
  const double radius_a = double(target.radius), radius_b = double(ball.shape->radius);
  in_range = near.distance - (radius_a + radius_b) <= max_distance;
  near.normal = offset / near.distance;
  if (in_range) fill(near, radius_a, radius_b, out);
  return true;
}

bool nearest_of_plane(const Shape& plane, const PosedShape& convex, double max_distance, ClosestPair& out) {
  const DVec3 normal(plane.extents);
  const DVec3 lowest =
      rotate(convex.orientation, core_support(*convex.shape, rotate_inverse(convex.orientation, -normal)));
  out.on_convex = convex.position + lowest - double(core_radius(*convex.shape)) * normal;
  const double height = dot(normal, out.on_convex) - double(plane.offset);
  if (height > max_distance) return false;
  out.normal = normal;
  out.overlap = height <= 0.0;
  out.distance = out.overlap ? 0.0 : height;
  out.on_target = out.overlap ? out.on_convex : out.on_convex - height * normal;
  return true;
}

bool nearest_of_triangle(const SurfaceTriangle& triangle, const PosedShape& convex, double max_distance,
                         ClosestPair& out) {
  const DVec3 pivot(triangle.a);
  const DVec3 corners[3] = {{}, DVec3(triangle.b) - pivot, DVec3(triangle.c) - pivot};
  if (convex.shape->kind == ShapeKind::sphere) {
    const DVec3 middle = convex.position - pivot;
    const SimplexPoint near = closest_on_triangle(middle, corners[0], corners[1], corners[2]);
    const DVec3 offset = middle - near.point;
    const double apart = length(offset), gap = apart - double(convex.shape->radius);
    if (gap > max_distance) return false;
    // If the triangle contains the centre, the search below decides.
    if (gap > 0.0 && apart > kDistanceRounding * length(middle)) {
      out.normal = offset / apart;
      out.overlap = false;
      out.distance = gap;
      out.on_target = near.point + pivot;
      out.on_convex = convex.position - double(convex.shape->radius) * out.normal;
      return true;
    }
  }
  const CorePair pair(corners, *convex.shape, convex.position - pivot, convex.orientation);
  const auto radius = double(core_radius(*convex.shape));
  if (!finish(pair, 0.0, radius, max_distance, out)) return false;
  out.on_target += pivot;
  out.on_convex += pivot;
  return true;
}

// A lower bound of the distance of two boxes, or 0.
float box_gap(const Aabb& a, const Aabb& b) {
  const Vec3 gap = max(max(a.low - b.high, b.low - a.high), Vec3{});
  return length(gap);
}

Aabb outward(DVec3 low, DVec3 high) {
  const double size =
      max(max(absolute(low.x), absolute(high.x)),
          max(max(absolute(low.y), absolute(high.y)), max(absolute(low.z), absolute(high.z))));
  const double slack = 2.0e-7 * size;
  const DVec3 all{slack, slack, slack};
  return {to_float(low - all), to_float(high + all)};
}

// Finds the closest triangle whose box is within a distance of the convex shape's box.
class SurfaceSearch {
 public:
  SurfaceSearch(const Shape& surface, const PosedShape& convex, double max_distance)
      : surface_(surface), convex_(convex), max_distance_(max_distance) {
    const Aabb box = bounds(*convex.shape, {{}, to_float(convex.orientation)});
    const float slack = kBoundsSlack * outer_radius(*convex.shape, {});
    const Aabb grown = grow(box, slack);
    box_ = outward(convex.position + DVec3(grown.low), convex.position + DVec3(grown.high));
  }

  // Searches boxes that grow eightfold, so that a close triangle is found without a test of all others.
  bool run(ClosestPair& out) {
    const Aabb& all = surface_.kind == ShapeKind::mesh ? surface_.mesh->tree.box : surface_.field->box;
    const auto min_gap = double(box_gap(all, box_));
    if (min_gap * (1.0 - kDistanceRounding) > max_distance_) return false;
    const double max_gap = max_distance_;
    double radius = min_gap + double(largest(half_size(box_))) +
                    1.0e-6 * double(largest(max(absolute(all.low), absolute(all.high))));
    for (;; radius *= 8.0) {
      const bool last = radius >= max_gap;
      walk(last ? max_gap : radius);
      // A triangle found beyond the searched box may not be the closest.
      if (last || (found_ && max_distance_ <= radius * (1.0 - kDistanceRounding))) break;
    }
    out = best_;
    return found_;
  }

 private:
  void walk(double distance) {
    const float margin =
        distance < double(kUnbounded) ? float(distance * (1.0 + kDistanceRounding)) : kUnbounded;
    const Aabb box = grow(box_, margin);
    if (surface_.kind == ShapeKind::mesh) {
      const StaticTree& tree = surface_.mesh->tree;
      walk_overlaps(
          tree, box,
          [&](std::uint32_t node, int lane) { return can_be_closer(child_box(tree.nodes[node], lane)); },
          [&](std::uint32_t first, std::uint32_t count) {
            for (std::uint32_t id = first; id < first + count; ++id) {
              if (can_be_closer(triangle_box(*surface_.mesh, id)))
                test_triangle(surface_triangle(*surface_.mesh, id));
            }
          });
      return;
    }
    const HeightField& field = *surface_.field;
    walk_cells(
        field, box, [&](HeightBlock block) { return can_be_closer(block_box(field, block)); },
        [&](std::uint32_t column, std::uint32_t row) {
          if (!is_solid_cell(field, column, row) || !can_be_closer(block_box(field, {-1, column, row})))
            return;
          for (int half = 0; half < 2; ++half) test_triangle(surface_triangle(field, column, row, half));
        });
  }

  bool can_be_closer(const Aabb& box) const {
    return double(box_gap(box, box_)) * (1.0 - kDistanceRounding) <= max_distance_;
  }

  void test_triangle(const SurfaceTriangle& triangle) {
    ClosestPair next;
    if (!nearest_of_triangle(triangle, convex_, max_distance_, next)) return;
    next.triangle = public_triangle(surface_, triangle.id);
    if (found_ && (next.distance > best_.distance ||
                   (next.distance == best_.distance && next.triangle >= best_.triangle)))
      return;
    best_ = next;
    found_ = true;
    max_distance_ = next.distance;
  }

  const Shape& surface_;
  const PosedShape& convex_;
  Aabb box_;  // of the convex shape
  double max_distance_;
  bool found_ = false;
  ClosestPair best_;
};

}  // namespace

bool find_closest_points(const Shape& target, const PosedShape& convex, double max_distance,
                         ClosestPair& out) {
  out = {};
  if (target.kind == ShapeKind::plane) return nearest_of_plane(target, convex, max_distance, out);
  if (!is_convex(target.kind)) return SurfaceSearch(target, convex, max_distance).run(out);
  if (convex.shape->kind == ShapeKind::sphere && has_box_core(target)) {
    bool in_range;
    if (nearest_of_ball(target, convex, max_distance, out, in_range)) return in_range;
  }
  const CorePair pair(target, *convex.shape, convex.position, convex.orientation);
  const auto radius_a = double(core_radius(target)), radius_b = double(core_radius(*convex.shape));
  return finish(pair, radius_a, radius_b, max_distance, out);
}

bool overlaps_triangle(const DVec3 (&triangle)[3], double radius, const PosedShape& convex) {
  const DVec3 pivot = triangle[0];
  const DVec3 corners[3] = {{}, triangle[1] - pivot, triangle[2] - pivot};
  const CorePair pair(corners, *convex.shape, convex.position - pivot, convex.orientation);
  ClosestPair closest;
  return finish(pair, radius, double(core_radius(*convex.shape)), 0.0, closest);
}

}  // namespace gyre
