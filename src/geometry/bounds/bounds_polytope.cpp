// k-DOPs, convex hulls as bounding volumes, and the cost of each kind of volume. See gyre/bounds.h.
#include "base/float_mode.h"
#include "geometry/bounds/bounds_points.h"
#include "geometry/distance/gjk.h"
#include "geometry/shape/cooked.h"
#include "geometry/shape/shape.h"

namespace gyre {
namespace {

constexpr std::int8_t kAxes[3][3] = {{1, 0, 0}, {0, 1, 0}, {0, 0, 1}};
constexpr std::int8_t kCorners[4][3] = {{1, 1, 1}, {1, 1, -1}, {1, -1, 1}, {-1, 1, 1}};
constexpr std::int8_t kEdges[6][3] = {{1, 1, 0}, {1, -1, 0}, {1, 0, 1}, {1, 0, -1}, {0, 1, 1}, {0, 1, -1}};

const std::int8_t* signs(KDopKind kind, int index) {
  if (index < 3) return kAxes[index];
  index -= 3;
  if (kind == KDopKind::k14) return kCorners[index];
  if (index < 6) return kEdges[index];
  return kCorners[index - 6];
}
DVec3 direction_of(KDopKind kind, int index) {
  const std::int8_t* const s = signs(kind, index);
  return {double(s[0]), double(s[1]), double(s[2])};
}

// Clips a polygon to the inner side of a plane: dot(normal, p) <= offset.
void clip(std::vector<DVec3>& polygon, DVec3 normal, double offset, std::vector<DVec3>& scratch) {
  scratch.clear();
  for (std::size_t i = 0; i < polygon.size(); ++i) {
    const DVec3 a = polygon[i], b = polygon[(i + 1) % polygon.size()];
    const double above_a = dot(normal, a) - offset, above_b = dot(normal, b) - offset;
    if (above_a <= 0.0) scratch.push_back(a);
    if ((above_a < 0.0 && above_b > 0.0) || (above_a > 0.0 && above_b < 0.0)) {
      scratch.push_back(a + (above_a / (above_a - above_b)) * (b - a));
    }
  }
  polygon.swap(scratch);
}

DVec3 area_vector(std::span<const DVec3> polygon) {
  DVec3 sum;
  for (std::size_t i = 2; i < polygon.size(); ++i)
    sum += cross(polygon[i - 1] - polygon[0], polygon[i] - polygon[0]);
  return 0.5 * sum;
}

// Each face is clipped by all other planes by itself. That is slower than to maintain a solid, and robust.
BoundCost cost_of(const KDop& dop) {
  const FloatMode mode;
  const int count = k_dop_directions(dop.kind);
  const DVec3 middle(0.5 * (double(dop.low[0]) + double(dop.high[0])),
                     0.5 * (double(dop.low[1]) + double(dop.high[1])),
                     0.5 * (double(dop.low[2]) + double(dop.high[2])));
  double size = 0.0;
  for (int i = 0; i < 3; ++i) size += double(dop.high[i]) - double(dop.low[i]);
  std::vector<DVec3> polygon, scratch;
  BoundCost cost;
  for (int i = 0; i < 2 * count; ++i) {
    const auto plane = [&](int k, DVec3& normal, double& offset) {
      const DVec3 direction = direction_of(dop.kind, k / 2);
      normal = k % 2 == 0 ? direction : -direction;
      offset = (k % 2 == 0 ? double(dop.high[k / 2]) : -double(dop.low[k / 2])) - dot(normal, middle);
    };
    DVec3 normal;
    double offset = 0.0;
    plane(i, normal, offset);
    const DVec3 n = unit(normal), u = some_perpendicular(n), v = cross(n, u);
    const DVec3 foot = (offset / length(normal)) * n;
    polygon = {foot - size * u - size * v, foot + size * u - size * v, foot + size * u + size * v,
               foot - size * u + size * v};
    for (int k = 0; k < 2 * count && !polygon.empty(); ++k) {
      if (k == i) continue;
      DVec3 other;
      double limit = 0.0;
      plane(k, other, limit);
      clip(polygon, other, limit, scratch);
    }
    if (polygon.size() < 3) continue;
    const double area = length(area_vector(polygon));
    cost.surface_area += area;
    cost.volume += area * (offset / length(normal)) / 3.0;
  }
  return cost;
}

BoundCost cost_of_hull(const HullView& hull) {
  BoundCost cost;
  std::vector<DVec3> face;
  for (std::size_t i = 0; i + 1 < hull.face_offsets.size(); ++i) {
    face.clear();
    for (std::uint32_t k = hull.face_offsets[i]; k < hull.face_offsets[i + 1]; ++k) {
      face.push_back(DVec3(hull.vertices[hull.face_indices[k]]) - DVec3(hull.vertices[0]));
    }
    const DVec3 area = area_vector(face);
    cost.surface_area += length(area);
    cost.volume += dot(area, face[0]) / 3.0;
  }
  return cost;
}

template <class T>
Result<BoundCost> cost_of_fit(const Result<T>& fit) {
  if (!fit) return fit.error();
  return BoundCost{volume(*fit), surface_area(*fit)};
}

}  // namespace

int k_dop_directions(KDopKind kind) { return kind == KDopKind::k14 ? 7 : kind == KDopKind::k18 ? 9 : 13; }
Vec3 k_dop_direction(KDopKind kind, int index) { return to_float(direction_of(kind, index)); }

Result<KDop> fit_k_dop(std::span<const Vec3> points, KDopKind kind) {
  if (const Error e = check_bounded_points(points)) return e;
  KDop dop;
  dop.kind = kind;
  for (int i = 0; i < k_dop_directions(kind); ++i) {
    const DVec3 direction = direction_of(kind, i);
    double low = dot(direction, DVec3(points[0])), high = low;
    for (const Vec3& p : points) {
      low = min(low, dot(direction, DVec3(p)));
      high = max(high, dot(direction, DVec3(p)));
    }
    dop.low[i] = round_down_to_float(low);
    dop.high[i] = round_up_to_float(high);
  }
  return dop;
}

KDop merge(const KDop& a, const KDop& b) {
  KDop dop = a;
  for (int i = 0; i < k_dop_directions(a.kind); ++i) {
    dop.low[i] = min(a.low[i], b.low[i]);
    dop.high[i] = max(a.high[i], b.high[i]);
  }
  return dop;
}
bool overlap(const KDop& a, const KDop& b) {
  for (int i = 0; i < k_dop_directions(a.kind); ++i) {
    if (a.low[i] > b.high[i] || b.low[i] > a.high[i]) return false;
  }
  return true;
}
bool contains(const KDop& dop, Vec3 point) {
  for (int i = 0; i < k_dop_directions(dop.kind); ++i) {
    const double along = dot(direction_of(dop.kind, i), DVec3(point));
    if (along < double(dop.low[i]) || along > double(dop.high[i])) return false;
  }
  return true;
}
double volume(const KDop& dop) { return cost_of(dop).volume; }
double surface_area(const KDop& dop) { return cost_of(dop).surface_area; }

Result<Geometry> merge_hulls(const Geometry& a, const Geometry& b) {
  std::vector<Vec3> points;
  for (const Geometry* each : {&a, &b}) {
    const HullView hull = view_hull(*each);
    points.insert(points.end(), hull.vertices.begin(), hull.vertices.end());
  }
  return cook_hull(points);
}
bool hulls_overlap(const Geometry& a, const Geometry& b) {
  const FloatMode mode;
  if (view_hull(a).vertices.empty() || view_hull(b).vertices.empty()) return false;
  const Shape shape_a = make_shape(a), shape_b = make_shape(b);
  return core_distance(CorePair(shape_a, shape_b, {}), 0.0, {}).overlap;
}
double hull_volume(const Geometry& hull) { return cost_of_hull(view_hull(hull)).volume; }
double hull_surface_area(const Geometry& hull) { return cost_of_hull(view_hull(hull)).surface_area; }

const char* to_string(BoundKind kind) {
  constexpr const char* kNames[kBoundKindCount] = {"sphere_fast",  "sphere",  "box",      "oriented_box_fast",
                                                   "oriented_box", "capsule", "k_dop_14", "k_dop_18",
                                                   "k_dop_26",     "hull"};
  return int(kind) < kBoundKindCount ? kNames[int(kind)] : "?";
}

Result<BoundCost> bound_cost(std::span<const Vec3> points, BoundKind kind) {
  switch (kind) {
    case BoundKind::sphere_fast:
      return cost_of_fit(fit_sphere_fast(points));
    case BoundKind::sphere:
      return cost_of_fit(fit_sphere(points));
    case BoundKind::box:
      return cost_of_fit(fit_box(points));
    case BoundKind::oriented_box_fast:
      return cost_of_fit(fit_oriented_box_fast(points));
    case BoundKind::oriented_box:
      return cost_of_fit(fit_oriented_box(points));
    case BoundKind::capsule:
      return cost_of_fit(fit_capsule(points));
    case BoundKind::k_dop_14:
      return cost_of_fit(fit_k_dop(points, KDopKind::k14));
    case BoundKind::k_dop_18:
      return cost_of_fit(fit_k_dop(points, KDopKind::k18));
    case BoundKind::k_dop_26:
      return cost_of_fit(fit_k_dop(points, KDopKind::k26));
    case BoundKind::hull: {
      const Result<Geometry> hull = cook_hull(points);
      if (!hull) return hull.error();
      return cost_of_hull(view_hull(*hull));
    }
  }
  return make_error(ErrorCode::invalid_argument, "bounds: kind %d; there is no such kind", int(kind));
}

}  // namespace gyre
