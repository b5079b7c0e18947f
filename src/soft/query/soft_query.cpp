#include "soft/query/soft_query.h"

#include "geometry/distance/closest.h"
#include "geometry/query/box_cast.h"
#include "geometry/query/closest_points.h"
#include "geometry/query/triangle_ray.h"

#include <cmath>

namespace gyre {

namespace {

// A ray that leaves a solid meets its surface from behind first. The direction is none along which boxes of cells have their faces.
constexpr DVec3 kOutward{1.0, 0.371893, 0.217351};

// The corners of a triangle of the contact surface, relative to the origin of the boxes.
void find_corners(const SoftEntry& entry, const SoftBoxes& boxes, std::uint32_t triangle,
                  DVec3 (&corners)[3]) {
  const std::uint32_t* const corner = entry.contact_surface->triangles[triangle].corner;
  for (int k = 0; k < 3; ++k) corners[k] = entry.body.particles.place(int(corner[k])) - boxes.origin;
}

// A segment of a rope as a capsule, and its frame.
struct Segment {
  Shape shape;
  DVec3 middle;
  DQuat turn;
};

Segment segment_of(const SoftEntry& entry, const SoftBoxes& boxes, std::uint32_t i) {
  const DVec3 a = entry.body.particles.place(int(i)) - boxes.origin,
              b = entry.body.particles.place(int(i) + 1) - boxes.origin;
  const double span = length(b - a);
  Segment out;
  out.shape.kind = ShapeKind::capsule;
  out.shape.radius = entry.radius;
  out.shape.extents.y = float(0.5 * span);
  out.middle = 0.5 * (a + b);
  const DVec3 along = span > 0.0 ? (1.0 / span) * (b - a) : DVec3{0.0, 1.0, 0.0};
  // The smallest rotation from y to the direction.
  out.turn = along.y > -0.999999 ? normalized(DQuat{along.z, 0.0, -along.x, 1.0 + along.y})
                                 : DQuat{1.0, 0.0, 0.0, 0.0};
  return out;
}

bool clip(const Aabb& box, DVec3 start, DVec3 translation, DVec3 half, double max_fraction, double& from,
          double& to) {
  from = 0.0, to = max_fraction;
  const double slack = 1.0e-6 * double(largest(max(absolute(box.low), absolute(box.high))));
  for (int axis = 0; axis < 3; ++axis) {
    const double low = double(box.low[axis]) - half[axis] - slack,
                 high = double(box.high[axis]) + half[axis] + slack;
    const double o = start[axis], d = translation[axis];
    if (d == 0.0) {
      if (o < low || o > high) return false;
      continue;
    }
    const double t1 = (low - o) / d, t2 = (high - o) / d;
    from = max(from, min(t1, t2)), to = min(to, max(t1, t2));
  }
  return from <= to;
}

// Calls visit(part, max_fraction) for each triangle or segment whose box is met by a box of half size `half` that moves from `start`. visit returns
// the new max_fraction, never more than the old one. Fractions are of the whole translation.
template <class Visit>
void walk_parts(const SoftEntry& entry, const SoftBoxes& boxes, DVec3 start, DVec3 translation, Vec3 half,
                double max_fraction, Visit&& visit) {
  double from, to;
  if (!clip(boxes.box, start, translation, DVec3(half), max_fraction, from, to)) return;
  const double clipped = to - from;
  const BoxRay line(start + from * translation, clipped * translation, half);
  const auto reach = [&](double full) {
    return clipped > 0.0 ? float(clamp((full - from) / clipped, 0.0, 1.0)) * 1.000001f + 1.0e-30f : 1.0f;
  };
  if (entry.kind == SoftKind::rope) {
    const std::uint32_t segments = std::uint32_t(entry.body.particles.count - 1);
    float walked = 1.0f, enter = 0.0f;
    for (std::uint32_t k = 0; k < boxes.segments.size(); ++k) {
      if (!meets(line, boxes.segments[k], walked, enter)) continue;
      for (std::uint32_t i = k * kSegmentsPerBox; i < min((k + 1) * kSegmentsPerBox, segments); ++i)
        max_fraction = visit(i, max_fraction);
      walked = min(walked, reach(max_fraction));
    }
    return;
  }
  const RayTraversalKernel<StaticNode> walk_on = select_static_ray_traversal();
  RayTraversal walk(line, 0, 1.0f);
  float enter = 0.0f;
  while (walk_on(boxes.surface.nodes.data(), walk)) {
    const std::uint32_t first = leaf_first(walk.leaf);
    for (std::uint32_t i = first; i < first + leaf_count(walk.leaf); ++i) {
      if (meets(line, start_box(boxes.surface.triangles[i]), walk.max_fraction, enter))
        max_fraction = visit(i, max_fraction);
    }
    walk.max_fraction = min(walk.max_fraction, reach(max_fraction));
  }
}

std::uint32_t number_of(const SoftEntry& entry, std::uint32_t part) {
  return entry.kind == SoftKind::rope ? part : entry.contact_surface->tree.items[part];
}

// The nearest crossing of a ray with the surface, from either side.
bool find_crossing(const SoftEntry& entry, const SoftBoxes& boxes, const LocalRay& ray, double max_fraction,
                   bool both_sides, LocalHit& hit, bool& front) {
  const TriangleRay crossing(ray);
  bool found = false;
  walk_parts(
      entry, boxes, ray.origin, ray.translation, {}, max_fraction, [&](std::uint32_t part, double now) {
        DVec3 corners[3];
        find_corners(entry, boxes, part, corners);
        LocalHit next;
        bool from_front = false;
        if (!crossing.crosses(corners[0], corners[1], corners[2], next.fraction, from_front)) return now;
        if (next.fraction < 0.0 || next.fraction > now || !(from_front || both_sides)) return now;
        next.triangle = part;
        const bool same = found && next.fraction == hit.fraction;
        if (found &&
            (same ? number_of(entry, part) > number_of(entry, hit.triangle) : next.fraction > hit.fraction))
          return now;
        const DVec3 facing = cross(corners[1] - corners[0], corners[2] - corners[0]);
        const double size = length(facing);
        next.normal = size > 0.0 ? ((from_front ? 1.0 : -1.0) / size) * facing : DVec3{};
        hit = next, found = true, front = from_front;
        return next.fraction;
      });
  return found;
}

bool is_within(const SoftEntry& entry, const SoftBoxes& boxes, DVec3 point) {
  if (entry.kind != SoftKind::solid) return false;
  for (int axis = 0; axis < 3; ++axis) {
    if (point[axis] < double(boxes.box.low[axis]) || point[axis] > double(boxes.box.high[axis])) return false;
  }
  const Vec3 size = boxes.box.high - boxes.box.low;
  LocalHit hit;
  bool front = true;
  const DVec3 beyond = 2.0 * double(size.x + size.y + size.z) * kOutward;
  return find_crossing(entry, boxes, {point, beyond}, 1.0, true, hit, front) && !front;
}

bool cast_ray_at_surface(const SoftEntry& entry, const SoftBoxes& boxes, const LocalRay& ray,
                         double max_fraction, bool back_faces, LocalHit& hit) {
  if (is_within(entry, boxes, ray.origin)) {
    const double span = length(ray.translation);
    hit = {};
    hit.inside = true;
    hit.point = ray.origin;
    hit.normal = span > 0.0 ? (-1.0 / span) * ray.translation : DVec3{};
    // The face that it would leave by names the place.
    const Vec3 size = boxes.box.high - boxes.box.low;
    LocalHit out;
    bool front = false;
    find_crossing(entry, boxes, {ray.origin, 2.0 * double(size.x + size.y + size.z) * kOutward}, 1.0, true,
                  out, front);
    hit.triangle = out.triangle;
    return true;
  }
  bool front = true;
  if (!find_crossing(entry, boxes, ray, max_fraction, back_faces || entry.kind == SoftKind::cloth, hit,
                     front))
    return false;
  hit.point = ray.origin + hit.fraction * ray.translation;
  return true;
}

bool cast_at_segment(const Segment& segment, const SoftCast& cast, DVec3 start, double max_fraction,
                     LocalHit& hit) {
  const DVec3 local = rotate_inverse(segment.turn, start - segment.middle),
              way = rotate_inverse(segment.turn, cast.translation);
  if (cast.shape == nullptr) {
    if (!cast_ray(segment.shape, {local, way}, max_fraction, false, hit)) return false;
  } else {
    MovingShape moving;
    moving.shape = cast.shape;
    moving.position = local, moving.translation = way;
    moving.orientation = conjugate(segment.turn) * cast.orientation;
    moving.skin = cast.skin;
    if (!cast_shape(segment.shape, moving, max_fraction, false, hit)) return false;
  }
  hit.point = segment.middle + rotate(segment.turn, hit.point);
  hit.normal = rotate(segment.turn, hit.normal);
  return true;
}

// How far a shape reaches from its box's middle, and the middle from its position.
struct CastExtent {
  DVec3 middle{};
  Vec3 half{};
};
CastExtent extent_of(const SoftEntry& entry, const SoftCast& cast) {
  if (cast.shape == nullptr) return {};
  const Aabb box = bounds(*cast.shape, {{}, to_float(cast.orientation)});
  // The boxes of a rope have its radius already.
  const float slack =
      kBoundsSlack * outer_radius(*cast.shape, {}) + (entry.kind == SoftKind::rope ? 0.0f : entry.radius);
  return {DVec3(center(box)), half_size(box) + Vec3{slack, slack, slack}};
}

// Of several overlaps at the start the deepest decides the exit.
bool comes_first(const SoftEntry& entry, const LocalHit& next, const LocalHit& best) {
  if (next.inside && best.inside && next.depth != best.depth) return next.depth > best.depth;
  if (next.fraction != best.fraction) return next.fraction < best.fraction;
  return number_of(entry, next.triangle) < number_of(entry, best.triangle);
}

bool cast_at_parts(const SoftEntry& entry, const SoftBoxes& boxes, const SoftCast& cast, DVec3 start,
                   double max_fraction, bool both_sides, LocalHit& hit) {
  const CastExtent extent = extent_of(entry, cast);
  MovingShape moving;
  moving.shape = cast.shape, moving.position = start, moving.orientation = cast.orientation;
  moving.translation = cast.translation, moving.skin = cast.skin;
  const double radius = entry.kind == SoftKind::cloth ? double(entry.radius) : 0.0;
  bool found = false;
  walk_parts(entry, boxes, start + extent.middle, cast.translation, extent.half, max_fraction,
             [&](std::uint32_t part, double now) {
               LocalHit next;
               if (entry.kind == SoftKind::rope) {
                 if (!cast_at_segment(segment_of(entry, boxes, part), cast, start, now, next)) return now;
               } else {
                 DVec3 corners[3];
                 find_corners(entry, boxes, part, corners);
                 if (!cast_shape_at_triangle(corners, radius, moving, now, both_sides, next)) return now;
               }
               next.triangle = part;
               if (found && !comes_first(entry, next, hit)) return now;
               hit = next, found = true;
               return min(now, next.fraction);
             });
  return found;
}

void find_weights(const SoftEntry& entry, const SoftBoxes& boxes, const LocalHit& local, SoftHit& hit) {
  if (entry.kind == SoftKind::rope) {
    const DVec3 a = entry.body.particles.place(int(local.triangle)) - boxes.origin,
                along = entry.body.particles.place(int(local.triangle) + 1) - boxes.origin - a;
    const double size = length_squared(along);
    const double t = size > 0.0 ? clamp(dot(local.point - a, along) / size, 0.0, 1.0) : 0.0;
    hit.weights[0] = float(1.0 - t), hit.weights[1] = float(t), hit.weights[2] = 0.0f;
    return;
  }
  DVec3 corners[3];
  find_corners(entry, boxes, local.triangle, corners);
  const SimplexPoint near = closest_on_triangle(local.point, corners[0], corners[1], corners[2]);
  for (int k = 0; k < 3; ++k) hit.weights[k] = float(near.weights[k]);
}

}  // namespace

SoftBoxes fit_soft_boxes(const SoftEntry& entry, Arena& arena) {
  const Particles& p = entry.body.particles;
  SoftBoxes out;
  out.origin = p.place(0);
  if (entry.kind != SoftKind::rope) {
    const std::span<DVec3> positions = arena.make<DVec3>(std::size_t(p.count));
    for (int i = 0; i < p.count; ++i) positions[std::size_t(i)] = p.place(i);
    out.surface = fit_boxes({entry.contact_surface.get(), 0}, positions, {}, out.origin, arena);
    out.box = out.surface.box;
    return out;
  }
  const int segments = p.count - 1;
  const std::span<Aabb> boxes =
      arena.make<Aabb>(std::size_t((segments + kSegmentsPerBox - 1) / kSegmentsPerBox));
  for (std::size_t k = 0; k < boxes.size(); ++k) {
    const int first = int(k) * kSegmentsPerBox, last = min(first + kSegmentsPerBox, segments);
    Vec3 low = difference(p.place(first), out.origin), high = low;
    for (int i = first + 1; i <= last; ++i) {
      const Vec3 at = difference(p.place(i), out.origin);
      low = min(low, at), high = max(high, at);
    }
    const float slack = 1.0e-6f * largest(max(absolute(low), absolute(high)));
    boxes[k] = grow({low, high}, entry.radius + slack);
    out.box = k == 0 ? boxes[0] : merge(out.box, boxes[k]);
  }
  out.segments = boxes;
  return out;
}

bool cast_at_soft(const SoftEntry& entry, const SoftBoxes& boxes, const SoftCast& cast, double max_fraction,
                  bool back_faces, SoftHit& hit) {
  LocalHit local;
  const DVec3 start = cast.position - boxes.origin;
  if (cast.shape == nullptr && entry.kind != SoftKind::rope) {
    if (!cast_ray_at_surface(entry, boxes, {start, cast.translation}, max_fraction, back_faces, local))
      return false;
  } else {
    const bool both_sides = back_faces || entry.kind == SoftKind::cloth;
    if (!cast_at_parts(entry, boxes, cast, start, max_fraction, both_sides, local)) return false;
  }
  hit.fraction = local.fraction;
  hit.point = boxes.origin + local.point;
  hit.normal = to_float(local.normal);
  hit.inside = local.inside;
  hit.depth = float(local.depth);
  hit.part = number_of(entry, local.triangle);
  find_weights(entry, boxes, local, hit);
  return true;
}

bool overlaps_soft(const SoftEntry& entry, const SoftBoxes& boxes, const SoftCast& place,
                   std::uint32_t& part) {
  const DVec3 start = place.position - boxes.origin;
  const CastExtent extent = extent_of(entry, place);
  const double radius = entry.kind == SoftKind::cloth ? double(entry.radius) : 0.0;
  std::uint32_t lowest = kNoTriangle;
  walk_parts(entry, boxes, start + extent.middle, {}, extent.half, 1.0, [&](std::uint32_t one, double now) {
    if (number_of(entry, one) >= lowest) return now;
    bool overlaps = false;
    if (entry.kind == SoftKind::rope) {
      const Segment segment = segment_of(entry, boxes, one);
      const PosedShape posed{place.shape, rotate_inverse(segment.turn, start - segment.middle),
                             conjugate(segment.turn) * place.orientation};
      ClosestPair closest;
      overlaps = find_closest_points(segment.shape, posed, 0.0, closest);
    } else {
      DVec3 corners[3];
      find_corners(entry, boxes, one, corners);
      overlaps = overlaps_triangle(corners, radius, {place.shape, start, place.orientation});
    }
    if (overlaps) lowest = number_of(entry, one);
    return now;
  });
  part = lowest;
  return lowest != kNoTriangle || is_within(entry, boxes, start);
}

}  // namespace gyre
