// Casts of shapes: Newton's method on the distance along the translation; balls in closed form where possible
// (cast_ball.h). See cast.h.
#include "geometry/query/cast.h"

#include "geometry/distance/penetration.h"
#include "geometry/query/cast_ball.h"
#include "geometry/query/cast_surface.h"
#include "geometry/shape/support.h"

namespace gyre {
namespace {

constexpr int kMaxSteps = 64;
// Relative error of the distance of GJK. No step may be longer than the certain distance.
constexpr double kDistanceError = 2.0e-9;
// A translation that leads deeper by less than this fraction of its length slides, so a shape that starts within its
// skin keeps going.
constexpr double kSliding = 1.0e-3;

DVec3 surface_on_a(const CoreDistance& near, double radius_a) { return near.on_a + radius_a * near.normal; }

// True if an overlap at the start is no hit: it is within the skin, and the translation does not lead deeper.
bool is_overlap_ignored(const MovingShape& moving, const LocalHit& hit) {
  return hit.depth <= double(moving.skin) &&
         dot(moving.translation, hit.normal) >= -kSliding * length(moving.translation);
}

// Fills the hit of an overlap at the start: the shortest exit.
void fill_overlap(const CorePair& pair, const CoreDistance& near, double radius_a, double radii,
                  LocalHit& hit) {
  hit = {};
  hit.inside = true;
  if (near.overlap) {
    const CorePenetration deep = core_penetration(pair, near);
    hit.normal = deep.normal;
    hit.depth = max(deep.depth + radii, 0.0);
    hit.point = deep.on_a + radius_a * deep.normal;
  } else {
    hit.normal = near.normal;
    hit.depth = radii - near.distance;
    hit.point = surface_on_a(near, radius_a);
  }
}

// The first impact of the moving shape B with the core of A rounded by radius_a.
bool first_impact(CorePair& pair, const MovingShape& moving, DVec3 start, double radius_a,
                  double max_fraction, LocalHit& hit) {
  const double radii = radius_a + double(core_radius(*moving.shape)),
               path_length = length(moving.translation);
  const double touching = kCastTolerance * double(outer_radius(*moving.shape, {}));
  double time = 0.0;
  DVec3 normal;
  for (int step = 0; step < kMaxSteps; ++step) {
    pair.move_b(start + time * moving.translation);
    CoreDistance near =
        core_distance(pair, radii + touching + (max_fraction - time) * path_length, to_float(normal));
    if (near.beyond) return false;
    const double gap = near.overlap ? -radii : near.distance * (1.0 - kDistanceError) - radii;
    const double closing = -dot(moving.translation, near.normal);
    if (step == 0 && (near.overlap || near.distance <= radii)) {
      fill_overlap(pair, near, radius_a, radii, hit);
      return !is_overlap_ignored(moving, hit);
    }
    const bool arrived = gap <= touching || step == kMaxSteps - 1;
    if (arrived && step > 0 && !(gap > 0.0 && closing > 0.0)) {
      // The shapes are so close that rounding reversed the normal or made them overlap. The last step was the impact.
      near.normal = normal;
    } else {
      if (!(closing > 0.0)) return false;
      time += gap / closing;
      if (!(time <= max_fraction)) return false;
    }
    if (arrived) {
      hit = {};
      hit.fraction = time;
      hit.normal = near.normal;
      hit.point = surface_on_a(near, radius_a);
      return true;
    }
    normal = near.normal;
  }
  return false;
}

void fill_impact(const BallImpact& impact, double radius_a, LocalHit& hit) {
  hit = {};
  hit.fraction = impact.fraction;
  hit.normal = impact.normal;
  hit.point = impact.on_core + radius_a * impact.normal;
}

// A moving ball against a convex shape whose core is a box, a segment or a point.
BallCast cast_ball_at_convex(const Shape& target, const MovingShape& ball, double max_fraction,
                             LocalHit& hit) {
  if (!has_box_core(target)) return BallCast::unknown;
  BallImpact impact;
  const BallCast cast = cast_ball_at_box(box_core(target), double(target.radius) + double(ball.shape->radius),
                                         {ball.position, ball.translation}, max_fraction, impact);
  if (cast == BallCast::hits) fill_impact(impact, double(target.radius), hit);
  return cast;
}

bool cast_at_plane(const Shape& plane, const MovingShape& moving, double max_fraction, LocalHit& hit) {
  const DVec3 normal(plane.extents);
  const DVec3 lowest =
      rotate(moving.orientation, core_support(*moving.shape, rotate_inverse(moving.orientation, -normal)));
  const DVec3 start = moving.position + lowest - double(core_radius(*moving.shape)) * normal;
  const double height = dot(normal, start) - double(plane.offset), rate = dot(normal, moving.translation);
  hit = {};
  hit.normal = normal;
  if (height <= 0.0) {
    hit.inside = true;
    hit.depth = -height;
    hit.point = start - height * normal;
    return !is_overlap_ignored(moving, hit);
  }
  if (!(rate < 0.0) || height > -rate * max_fraction) return false;
  hit.fraction = height / -rate;
  hit.point = start + hit.fraction * moving.translation;
  return true;
}

// A one-sided triangle is left through its front. If the shortest exit leads elsewhere, the exit along the normal of
// the face counts.
void leave_by_front(const MovingShape& moving, DVec3 normal, const DVec3 (&corners)[3], LocalHit& hit) {
  if (dot(hit.normal, normal) >= 0.0) return;
  const DVec3 lowest =
      rotate(moving.orientation, core_support(*moving.shape, rotate_inverse(moving.orientation, -normal)));
  hit.normal = normal;
  hit.depth = double(core_radius(*moving.shape)) - dot(normal, moving.position + lowest - corners[0]);
}

bool cast_at_triangle(const Shape& surface, const SurfaceTriangle& triangle, const MovingShape& moving,
                      bool both_sides, double max_fraction, LocalHit& hit) {
  const DVec3 corners[3] = {DVec3(triangle.a), DVec3(triangle.b), DVec3(triangle.c)};
  if (!cast_shape_at_triangle(corners, 0.0, moving, max_fraction, both_sides, hit)) return false;
  hit.triangle = public_triangle(surface, triangle.id);
  return true;
}

bool cast_at_surface(const Shape& surface, const MovingShape& moving, double max_fraction, bool back_faces,
                     LocalHit& hit) {
  const bool both_sides = back_faces || is_double_sided(surface);
  const Aabb box = bounds(*moving.shape, {{}, to_float(moving.orientation)});
  const Vec3 middle = center(box), half = half_size(box);
  const float slack = kBoundsSlack * outer_radius(*moving.shape, {});
  const LocalRay ray{moving.position + DVec3(middle), moving.translation};
  bool found = false;
  walk_triangles(surface, ray, half + Vec3{slack, slack, slack}, max_fraction,
                 [&](const SurfaceTriangle& triangle, double now) {
                   LocalHit next;
                   if (!cast_at_triangle(surface, triangle, moving, both_sides, now, next)) return now;
                   // Of several overlaps at the start the deepest decides the exit.
                   const bool deeper = found && next.inside && hit.inside && next.depth != hit.depth;
                   if (found && (deeper ? next.depth < hit.depth : !comes_before(next, hit))) return now;
                   hit = next;
                   found = true;
                   return min(now, next.fraction);
                 });
  return found;
}

}  // namespace

bool cast_shape_at_triangle(const DVec3 (&triangle)[3], double radius, const MovingShape& moving, double max_fraction,
                            bool both_sides, LocalHit& hit) {
  // Relative to one corner, so that the numbers of GJK are no larger than they must be.
  const DVec3 pivot = triangle[0];
  const DVec3 corners[3] = {{}, triangle[1] - pivot, triangle[2] - pivot};
  const DVec3 facing = cross(corners[1], corners[2]);
  const bool still = moving.translation == DVec3{};
  if (!both_sides && !still && dot(facing, moving.translation) >= 0.0) return false;
  if (moving.shape->kind == ShapeKind::sphere) {
    BallImpact impact;
    const BallCast cast =
        cast_ball_at_triangle(corners, radius + double(moving.shape->radius),
                              {moving.position - pivot, moving.translation}, max_fraction, impact);
    if (cast == BallCast::misses) return false;
    if (cast == BallCast::hits) {
      impact.on_core += pivot;
      fill_impact(impact, radius, hit);
      return true;
    }
  }
  MovingShape local = moving;
  local.position = moving.position - pivot;
  local.skin = 0.0f;  // tested below, with the exit that counts
  CorePair pair(corners, *moving.shape, local.position, moving.orientation);
  if (!first_impact(pair, local, local.position, radius, max_fraction, hit)) return false;
  if (hit.inside) {
    if (!both_sides && dot(facing, facing) > 0.0)
      leave_by_front(local, facing / length(facing), corners, hit);
    if (is_overlap_ignored(moving, hit)) return false;
  }
  hit.point += pivot;
  return true;
}

bool cast_shape(const Shape& target, const MovingShape& moving, double max_fraction, bool back_faces,
                LocalHit& hit) {
  if (target.kind == ShapeKind::plane) return cast_at_plane(target, moving, max_fraction, hit);
  if (!is_convex(target.kind)) return cast_at_surface(target, moving, max_fraction, back_faces, hit);
  if (moving.shape->kind == ShapeKind::sphere) {
    const BallCast cast = cast_ball_at_convex(target, moving, max_fraction, hit);
    if (cast != BallCast::unknown) return cast == BallCast::hits;
  }
  CorePair pair(target, *moving.shape, moving.position, moving.orientation);
  return first_impact(pair, moving, moving.position, double(core_radius(target)), max_fraction, hit);
}

}  // namespace gyre
