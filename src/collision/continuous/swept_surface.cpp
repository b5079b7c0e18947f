// Sweeps against triangles. See swept_surface.h.
//
// A long sweep is divided into pieces of a few sizes, tested in order: the boxes of the pieces meet far fewer triangles
// than the box of the whole.
#include "collision/continuous/swept_surface.h"

#include "geometry/manifold_mesh/mesh_axis.h"
#include "geometry/shape/support.h"

namespace gyre {
namespace {

constexpr int kMaxPieces = 32;
constexpr float kPieceRadii = 4.0f;  // length of a piece in outer radii
constexpr float kCoreShare = 0.5f;   // of the inner radius
// A core nearer than this share of its target distance counts as deep.
constexpr double kDeep = 1.0e-3;
// The largest number of advances towards a triangle's plane before a search, and the smallest advance, in distances.
constexpr int kMaxPlaneAdvances = 12;
constexpr double kMinAdvance = 0.1;
// A sliding shape may come nearer than its target by this share, and approach at this sine; below them it is rounding.
constexpr double kSlideShare = 0.5, kSlideSlack = 1.0e-6;

TimeOfImpact no_impact(double end) { return {end, false, false, {}, {}}; }

// The time of impact of the core with something that the shape touches from the start; the solver handles the shape
// itself. A core that is already deeper is free.
TimeOfImpact core_time_of_impact(const SweptShape& core, const SweptShape& b, double start, double end,
                                 const ImpactScale& scale) {
  if (stays_clear(core, b, start, end, 2.0 * scale.core_target)) return no_impact(end);
  const Gap gap = find_gap(core, b, start, 2.0 * scale.core_target);
  if (!gap.beyond && gap.distance <= kDeep * scale.core_target) return no_impact(end);
  // A core left near by the last step may come nearer, or it would be held there even while it leaves.
  const double target = gap.beyond ? scale.core_target : min(scale.core_target, 0.5 * gap.distance);
  const Impact impact = time_of_impact(core, b, start, end, target);
  if (!impact.hit) return no_impact(end);
  TimeOfImpact found;
  found.time = impact.time;
  found.hit = found.by_core = true;
  found.normal = find_gap(core, b, impact.time, 4.0 * target).normal;
  const Pose frame = pose_at(*core.sweep, impact.time) * core.body_from_shape;
  const Vec3 towards = rotate_inverse(frame.orientation, to_float(found.normal));
  found.point = frame * support(*core.shape, towards) + double(core_radius(*core.shape)) * found.normal;
  return found;
}

// The time of impact of the shape. If that is before the fraction that the shape keeps in any case, the core decides
// from there on.
TimeOfImpact whole_time_of_impact(const SweptShape& a, const SweptShape& core, const SweptShape& b,
                                  double start, double end, const ImpactScale& scale) {
  const Impact impact = time_of_impact(a, b, start, end, scale.target);
  if (!impact.hit) return no_impact(end);
  if (impact.time < scale.min_fraction) {
    TimeOfImpact deep = core_time_of_impact(core, b, impact.time, min(scale.min_fraction, end), scale);
    if (deep.hit) return deep;
    deep.hit = true;
    deep.normal = find_gap(core, b, deep.time, 1.0e3 * scale.touching).normal;
    return deep;
  }
  return {impact.time, true, false, find_gap(a, b, impact.time, 2.0 * scale.target).normal, {}};
}

// The time of impact of a convex shape that slides along what it touches without rotation: the plane between the two
// stays between them.
TimeOfImpact slide_time_of_impact(const SweptShape& a, const SweptShape& b, double start, double end,
                                  const ImpactScale& scale) {
  const double target = kSlideShare * scale.target;
  const Gap gap = find_gap(a, b, start, 2.0 * target);
  if (!gap.beyond && gap.distance <= 1.25 * target) {
    const DVec3 translation = DVec3(a.sweep->translation) - DVec3(b.sweep->translation);
    const bool closes =
        dot(translation, gap.normal) > kSlideSlack * length(translation) || !(b.sweep->rotation == Vec3{});
    return {closes ? start : end, closes, false, gap.normal, {}};
  }
  const Impact impact = time_of_impact(a, b, start, end, target);
  if (!impact.hit) return no_impact(end);
  return {impact.time, true, false, find_gap(a, b, impact.time, 2.0 * scale.target).normal, {}};
}

// The moving shape in the frame of the surface.
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
        is_surface_still_(b.sweep->rotation == Vec3{} && b.sweep->translation == Vec3{}),
        world_from_surface_(b.sweep->pose * b.body_from_shape),
        start_(surface_from_a(0.0)),
        whole_{a, inverse_times(a.body_from_shape, a.body_from_shape), {}, {}},
        inner_{core, inverse_times(a.body_from_shape, core.body_from_shape), {}, {}},
        middle_(start_ * inverse_times(a.body_from_shape, core.body_from_shape.position)) {
    inner_.start = start_ * inner_.from_shape;
  }

  TimeOfImpact first_impact(double end) {
    const int piece_count = pieces();
    first_ = no_impact(end);
    for (int piece = 0; piece < piece_count && !first_.hit; ++piece) {
      const double from = double(piece) / double(piece_count);
      if (from >= end) break;
      first_.time = min(double(piece + 1) / double(piece_count), end);
      for_each_triangle(from, first_.time, [&](std::uint32_t id) { test_triangle(id, from); });
    }
    if (!first_.hit) first_.time = end;
    return first_;
  }

  Impact first_meeting() {
    const int piece_count = pieces();
    Impact first;
    for (int piece = 0; piece < piece_count && !first.hit; ++piece) {
      const double from = double(piece) / double(piece_count);
      first.time = double(piece + 1) / double(piece_count);
      for_each_triangle(from, first.time, [&](std::uint32_t id) {
        set_triangle(surface_.bare_triangle(id));
        const Impact impact = time_of_impact(a_, near_frame_, from, first.time, scale_.target);
        if (impact.hit) first = impact;
      });
    }
    return first;
  }

  bool crosses(double end, double clear) {
    bool met = false;
    for_each_triangle(end, end, [&](std::uint32_t id) {
      set_triangle(surface_.bare_triangle(id));
      met = met || find_gap(a_, near_frame_, end, scale_.target).distance <= clear;
    });
    if (met) return false;
    const int piece_count = pieces();
    for (int piece = 0; piece < piece_count && !met; ++piece) {
      const double from = double(piece) / double(piece_count),
                   to = min(double(piece + 1) / double(piece_count), end);
      if (from >= end) break;
      for_each_triangle(from, to, [&](std::uint32_t id) {
        set_triangle(surface_.bare_triangle(id));
        met = met || meets(from, to);
      });
    }
    return met;
  }

 private:
  // The shape or its core in the surface's frame, as the tests of triangles need it.
  struct LocalShape {
    const SweptShape& swept;
    Transform from_shape;  // into the frame of the whole shape
    // surface_from_shape at the start of the step (of the core), and at the end of the piece
    Transform start, end;
  };

  Transform surface_from_a(double time) const {
    return inverse_times(
        is_surface_still_ ? world_from_surface_ : pose_at(*b_.sweep, time) * b_.body_from_shape,
        pose_at(*a_.sweep, time) * a_.body_from_shape);
  }

  // A box around the shape over the piece, in the surface's frame. A rotation bulges out of the box around its two ends
  // by at most r (1 - cos(angle / 2)) < r angle^2 / 8.
  Aabb piece_box(double from, double to) const {
    const Transform &at_start = piece_start_, &at_end = piece_end_;
    const float share = float(to - from);
    const float angle_a = share * length(a_.sweep->rotation), angle_b = share * length(b_.sweep->rotation);
    const float lever = max(length(at_start.position), length(at_end.position)) +
                        length(b_.body_from_shape.position - b_.sweep->center) + a_.radius;
    const float bulge = 0.125f * (a_.radius * square(angle_a) + lever * square(angle_b));
    return grow(merge(bounds(*a_.shape, at_start), bounds(*a_.shape, at_end)),
                bulge + float(scale_.touching));
  }

  int pieces() const {
    const float distance =
        length(a_.sweep->translation - b_.sweep->translation) + length(a_.sweep->rotation) * a_.radius;
    return 1 + int(min(distance / (kPieceRadii * a_.radius), float(kMaxPieces - 1)));
  }

  // Calls fn(triangle) for the triangles that the shape may come near between two times.
  template <class Fn>
  void for_each_triangle(double from, double to, const Fn& fn) {
    piece_start_ = from == 0.0 ? start_ : surface_from_a(from);
    piece_end_ = surface_from_a(to);
    whole_.end = piece_end_ * whole_.from_shape;
    inner_.end = piece_end_ * inner_.from_shape;
    const Aabb box = piece_box(from, to);
    // Triangles are moved near the origin of a frame of their own, so that floats stay small in a large mesh.
    origin_ = piece_start_.position;
    near_frame_ = b_;
    near_frame_.body_from_shape = b_.body_from_shape * Transform{origin_, {}};
    if (surface_.mesh != nullptr) {
      walk_overlaps(
          surface_.mesh->tree, box, [](std::uint32_t, int) { return true; },
          [&](std::uint32_t first, std::uint32_t count) {
            for (std::uint32_t id = first; id < first + count; ++id) {
              if (overlap(triangle_box(*surface_.mesh, id), box)) fn(id);
            }
          });
      return;
    }
    walk_cells(
        *surface_.field, box, [](HeightBlock) { return true; },
        [&](std::uint32_t column, std::uint32_t row) {
          if (!is_solid_cell(*surface_.field, column, row)) return;
          const std::uint32_t cell = row * surface_.field->cell_columns() + column;
          fn(2 * cell);
          fn(2 * cell + 1);
        });
  }

  void set_triangle(const BareTriangle& view) {
    hull_.set(view.v[0] - origin_, view.v[1] - origin_, view.v[2] - origin_);
    near_frame_.shape = &hull_.shape();
    near_frame_.radius =
        outer_radius(hull_.shape(), inverse_times(near_frame_.body_from_shape, b_.sweep->center));
  }

  // True if the shape meets the current triangle from either side. A triangle that it overlaps at the start counts if
  // it goes in deeper.
  bool meets(double from, double to) const {
    const double before = find_gap(a_, near_frame_, from, scale_.target).distance;
    if (before > 0.0) return time_of_impact(a_, near_frame_, from, to, min(scale_.target, 0.5 * before)).hit;
    return from > 0.0 || find_gap(a_, near_frame_, 0.001 * to, scale_.target).distance < before;
  }

  // Height of the shape, or its core, above a plane of the surface.
  static double height_of(const Shape& shape, const Transform& surface_from_shape, Vec3 normal, Vec3 corner) {
    const Vec3 lowest =
        surface_from_shape * support(shape, rotate_inverse(surface_from_shape.orientation, -normal));
    return double(dot(normal, lowest - corner)) - double(core_radius(shape));
  }

  // True if the shape, at `height` above a plane of the surface at the start of the step, stays farther from it than
  // `distance` until the end of the piece. The heights at both ends mostly decide: in between, it is nearer by at most
  // the bulge of its rotation. Otherwise it advances as in time_of_impact, but along the one normal, which needs no
  // search.
  bool stays_above(const LocalShape& local, Vec3 normal, Vec3 corner, double height, double distance) const {
    const SweptShape& shape = local.swept;
    if (!(b_.sweep->rotation == Vec3{})) return false;
    const double rounding =
        4.0e-6 * double(largest(absolute(corner)) + largest(absolute(start_.position)) + a_.radius);
    const double bulge = 0.125 * double(shape.radius * length_squared(shape.sweep->rotation));
    const double at_end = height_of(*shape.shape, local.end, normal, corner);
    if (min(height, at_end) - bulge > distance + rounding) return true;
    if (at_end <= distance) return false;
    const DVec3 up(rotate(b_.sweep->pose.orientation, rotate(b_.body_from_shape.orientation, normal)));
    const double closing = -dot(DVec3(shape.sweep->translation) - DVec3(b_.sweep->translation), up) +
                           length(cross(DVec3(shape.sweep->rotation), up)) * double(shape.radius);
    double time = 0.0;
    for (int i = 0; i < kMaxPlaneAdvances; ++i) {
      const double remaining = height - distance - rounding;
      if (remaining > max(closing, 0.0) * (first_.time - time)) return true;
      if (!(remaining > kMinAdvance * distance)) return false;
      time += remaining / closing;
      height = height_of(*shape.shape, surface_from_a(time) * local.from_shape, normal, corner);
    }
    return false;
  }

  // True if the triangle cannot halt the shape before the end of the piece, from `height` above it at the start of the
  // step. Most shapes near a triangle's box fly past it or lie on it already.
  bool stays_clear_of(Vec3 corner, Vec3 normal, double height) const {
    if (height > scale_.touching) return stays_above(whole_, normal, corner, height, 2.0 * scale_.target);
    if (scale_.slides) return false;
    return stays_above(inner_, normal, corner, height_of(*core_.shape, inner_.start, normal, corner),
                       2.0 * scale_.core_target);
  }

  void test_triangle(std::uint32_t id, double from) {
    const BareTriangle view = surface_.bare_triangle(id);
    Vec3 normal = view.normal;
    // The side of the plane on which the middle starts decides; on a straight path it cannot come back.
    if (dot(normal, middle_ - view.v[0]) < 0.0f) {
      if (!surface_.double_sided()) return;
      normal = -normal;
    }
    const Vec3 lowest = start_ * support(*a_.shape, rotate_inverse(start_.orientation, -normal));
    const double height = double(dot(normal, lowest - view.v[0])) - double(core_radius(*a_.shape));
    if (stays_clear_of(view.v[0], normal, height)) return;
    set_triangle(view);
    TimeOfImpact found;
    if (scale_.slides) {
      found = slide_time_of_impact(a_, near_frame_, from, first_.time, scale_);
    } else if (height > scale_.touching) {
      found = whole_time_of_impact(a_, core_, near_frame_, from, first_.time, scale_);
    } else {
      found = core_time_of_impact(core_, near_frame_, from, first_.time, scale_);
    }
    if (found.hit && found.time < first_.time) first_ = found;
  }

  const SweptShape& a_;
  const SweptShape& core_;
  const SweptShape& b_;
  const Surface surface_;
  const ImpactScale& scale_;
  TriangleHull& hull_;
  const bool is_surface_still_;
  const Pose world_from_surface_;  // at the start of the step
  const Transform start_;
  LocalShape whole_, inner_;
  const Vec3 middle_;
  Transform piece_start_, piece_end_;
  Vec3 origin_;
  SweptShape near_frame_;
  TimeOfImpact first_;
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

namespace {

// The largest box with the axes and proportions of the hull's own box that keeps `margin` from every face.
Vec3 box_in_hull(const Hull& hull, float margin) {
  const Vec3 half = half_size(hull.box);
  float scale = 1.0f;
  for (const HullPlane& plane : hull.planes) {
    const float room = plane.offset - dot(plane.normal, hull.centroid) - margin;
    const float needed = dot(absolute(plane.normal), half);
    if (scale * needed > room) scale = max(room, 0.0f) / needed;
  }
  return scale * half;
}

Shape ball_of(float radius) {
  Shape ball;
  ball.kind = ShapeKind::sphere;
  ball.radius = radius;
  return ball;
}

}  // namespace

Core make_core(const Shape& shape, const Transform& body_from_shape) {
  const float off = kCoreShare * inner_radius(shape);
  Core core{shape, body_from_shape};
  switch (shape.kind) {
    case ShapeKind::box: {
      // The rounding is removed first.
      core.shape.radius = max(shape.radius - off, 0.0f);
      const float remaining = max(off - shape.radius, 0.0f);
      core.shape.extents = shape.extents - Vec3{remaining, remaining, remaining};
      return core;
    }
    case ShapeKind::capsule:
      core.shape.radius = shape.radius - off;
      return core;
    case ShapeKind::cylinder:
      core.shape.radius = shape.radius - off;
      core.shape.extents.y = shape.extents.y - off;
      return core;
    case ShapeKind::cone: {
      // Half as large, about the centre of the inscribed ball.
      const float r = shape.radius, h = shape.extents.y;
      const float inscribed = 2.0f * h * r / (r + std::sqrt(r * r + 4.0f * h * h));
      core.shape.radius = (1.0f - kCoreShare) * r;
      core.shape.extents.y = (1.0f - kCoreShare) * h;
      core.body_from_core.position = body_from_shape * Vec3{0, kCoreShare * (inscribed - h), 0};
      return core;
    }
    case ShapeKind::hull: {
      const Vec3 half = box_in_hull(*shape.hull, off);
      core.shape = ball_of(off);
      if (smallest(half) > off) {
        core.shape.kind = ShapeKind::box;
        core.shape.radius = 0.0f;
        core.shape.extents = half;
      }
      core.body_from_core.position = body_from_shape * shape.hull->centroid;
      return core;
    }
    default:
      core.shape = ball_of(shape.radius - off);
      return core;
  }
}

TimeOfImpact convex_time_of_impact(const SweptShape& a, const SweptShape& core, const SweptShape& b,
                                   double start, double end, const ImpactScale& scale) {
  if (stays_clear(a, b, start, end, max(scale.touching, 2.0 * scale.target))) return no_impact(end);
  if (scale.slides) return slide_time_of_impact(a, b, start, end, scale);
  if (find_gap(a, b, start, scale.touching).distance <= scale.touching)
    return core_time_of_impact(core, b, start, end, scale);
  return whole_time_of_impact(a, core, b, start, end, scale);
}

TimeOfImpact surface_time_of_impact(const SweptShape& a, const SweptShape& core, const SweptShape& b,
                                    double end, const ImpactScale& scale, TriangleHull& triangle) {
  return SurfaceSweep(a, core, b, scale, triangle).first_impact(end);
}

Impact first_meeting(const SweptShape& a, const SweptShape& b, double target, TriangleHull& triangle) {
  const ImpactScale scale{.target = target, .touching = target, .core_target = target};
  return SurfaceSweep(a, a, b, scale, triangle).first_meeting();
}

bool crosses_surface(const SweptShape& a, const SweptShape& b, double end, double clear,
                     const ImpactScale& scale, TriangleHull& triangle) {
  return SurfaceSweep(a, a, b, scale, triangle).crosses(end, clear);
}

}  // namespace gyre
