// Points on one triangle. See mesh_points.h.
#include "geometry/manifold_mesh/mesh_points.h"

#include "base/hash.h"
#include "geometry/distance/closest.h"
#include "math/wide_vec.h"

#include <bit>

namespace gyre {
namespace {

// Cosine between a face of the shape and the contact direction below which the face does not lie on the edge.
constexpr float kFlushShare = 0.985f;
// Sine below which two edges count as parallel and touch in two points.
constexpr float kSideBySideEdges = 0.05f;
// How far apart two edges may pass and still cross, relative to the longer one.
constexpr float kCrossingSlack = 1.0e-3f;

using Floats = Wide<4>;
using Vectors = Vec3W<4>;

// The kinds, in the order in which the reduction prefers equally good points. Corners of the shape make the steadiest
// manifold.
enum class PointKind : std::uint32_t { shape_corner, surface_corner, edges, nearest };

std::uint32_t point_name(PointKind kind, std::uint32_t on_surface, std::uint32_t on_shape) {
  const std::uint64_t mixed = mix_bits(std::uint64_t(on_surface) << 32 | on_shape);
  return std::uint32_t(kind) << 30 | std::uint32_t(mixed & 0x3fffffffu);
}

// The normal to within a few degrees, on a grid that starts at a corner of the cube around the sphere of normals.
// Axis-aligned surfaces, and those that lean slightly, are far from the borders of grid cells.
std::uint32_t normal_name(Vec3 n) {
  const auto step = [](float x) { return std::uint32_t((x + 1.0f) * 8.0f + 0.5f); };
  return step(n.x) << 10 | step(n.y) << 5 | step(n.z);
}

// The name of an edge of the facing feature comes from its corners, so that it does not depend on the face.
std::uint32_t edge_name(const FacePolygon& face, int k) {
  const std::uint32_t a = face.ids[k], b = face.ids[k + 1 == face.count ? 0 : k + 1];
  return 0x10000u | min(a, b) << 8 | max(a, b);
}

struct Emitter {
  Vec3 direction;
  Vec3 anchor;  // a point of the surface; separations are measured from it along the direction
  float radius;
  float max_separation;
  MeshPoints& out;

  // A point of the core; its separation is to the plane through the anchor.
  void core_point(Vec3 p, std::uint32_t name) const { pair(p, dot(direction, p - anchor) - radius, name); }
  void pair(Vec3 on_core, float separation, std::uint32_t name) const {
    if (separation <= max_separation)
      out.add(on_core - (radius + 0.5f * separation) * direction, separation, name);
  }
};

// all_of: a bit for each corner of a face. edges_across: from bits of some corners, the edges between those and the
// other corners.
static_assert(kMaxFaceVertices <= 32);
unsigned all_of(const FacePolygon& face) { return ~0u >> (32 - face.count); }
unsigned edges_across(const FacePolygon& face, unsigned corners) {
  if (face.count < 2) return 0;
  const unsigned next = corners >> 1 | (corners & 1u) << (face.count - 1);
  return (corners ^ next) & (face.count == 2 ? 1u : ~0u);
}

// True if `p` is inside the polygon, seen along its normal.
bool inside_polygon(const FacePolygon& face, Vec3 p, float slack) {
  for (int k = 0; k < face.count; ++k) {
    const Vec3 a = face.vertices[k], edge = face.vertices[k + 1 == face.count ? 0 : k + 1] - a;
    const float inside = dot(cross(face.normal, edge), p - a);
    if (inside < 0.0f && inside < -slack * length(edge)) return false;
  }
  return true;
}

// The lowest vertex of a hull may belong to a face that leans more than the facing one.
void add_lowest_vertex(const LocalTriangle& t, const LocalConvex& convex, const PlaneSide& side,
                       const Emitter& emit) {
  if (convex.shape().kind != ShapeKind::hull) return;
  const int lowest = convex.lowest_vertex(t.normal);
  for (int k = 0; k < side.face.count; ++k) {
    if (side.face.ids[k] == lowest) return;
  }
  const Vec3 p = convex.vertex(lowest);
  for (int i = 0; i < 3; ++i) {
    if (dot(t.outward[i], p - t.v[i]) > t.slack) return;
  }
  emit.core_point(p, point_name(PointKind::shape_corner, normal_name(t.normal), std::uint32_t(lowest)));
}

// Bits of the triangle's corners that lie under the polygon, seen along the normal of the triangle.
unsigned find_corners_under(const LocalTriangle& t, const FacePolygon& face, float facing,
                            float (&heights)[4]) {
  unsigned under = ~unsigned(t.flat_corners) & 7u;
  const Vectors corners = side_by_side(t.v[0], t.v[1], t.v[2], t.v[2]), normal = splat<4>(face.normal);
  // Up along the normal of the triangle to the plane of the face.
  const Floats height = dot(normal, splat<4>(face.vertices[0]) - corners) / Floats(facing);
  height.store_unaligned(heights);
  const Vectors p = corners + height * splat<4>(t.normal);
  for (int k = 0; k < face.count && under != 0; ++k) {
    const Vec3 a = face.vertices[k], edge = face.vertices[k + 1 == face.count ? 0 : k + 1] - a;
    const Floats inside = dot(splat<4>(cross(face.normal, edge)), p - splat<4>(a));
    const unsigned beyond = to_bits(inside < Floats(0.0f)) & under;
    if (beyond != 0) under &= ~(beyond & to_bits(inside < Floats(-t.slack * length(edge))));
  }
  return under;
}

void corners_under_face(const LocalTriangle& t, const FacePolygon& face, const Emitter& emit) {
  const float facing = dot(face.normal, t.normal);
  if (face.count < 3 || facing > -0.1f) return;
  float heights[4];
  for (unsigned rest = find_corners_under(t, face, facing, heights); rest != 0; rest &= rest - 1) {
    const int i = std::countr_zero(rest);
    const Vec3 p = t.v[i] + heights[i] * t.normal;
    emit.pair(p, heights[i] - emit.radius,
              point_name(PointKind::surface_corner, t.corner_id[i], face.feature));
  }
}

// The distance of each corner of a face outside each side of a triangle, and bits of the corners that are outside for
// certain.
struct CornersOutside {
  float distance[3][kMaxFaceVertices];
  unsigned beyond[3] = {0, 0, 0};

  CornersOutside(const LocalTriangle& t, const FacePolygon& face) {
    const auto vertex = [&](int k) { return face.vertices[min(k, face.count - 1)]; };
    for (int k = 0; k < face.count; k += 4) {
      const Vectors corners = side_by_side(vertex(k), vertex(k + 1), vertex(k + 2), vertex(k + 3));
      for (int side = 0; side < 3; ++side) {
        const Floats out = dot(splat<4>(t.outward[side]), corners - splat<4>(t.v[side]));
        out.store_unaligned(distance[side] + k);
        beyond[side] |= to_bits(out > Floats(t.slack)) << k;
      }
    }
    for (unsigned& bits : beyond) bits &= all_of(face);
  }
};

}  // namespace

void face_points(const LocalTriangle& t, const LocalConvex& convex, const PlaneSide& side,
                 float max_separation, MeshPoints& out) {
  const FacePolygon& face = side.face;
  const Emitter emit{t.normal, t.v[0], convex.radius(), max_separation, out};
  add_lowest_vertex(t, convex, side, emit);
  const CornersOutside outside(t, face);
  const unsigned(&beyond)[3] = outside.beyond;
  for (const unsigned bits : beyond) {
    if (bits == all_of(face)) return;
  }
  const std::uint32_t normal = normal_name(t.normal);
  for (unsigned rest = all_of(face) & ~(beyond[0] | beyond[1] | beyond[2]); rest != 0; rest &= rest - 1) {
    const int k = std::countr_zero(rest);
    emit.core_point(face.vertices[k], point_name(PointKind::shape_corner, normal, face.ids[k]));
  }
  for (int i = 0; i < 3; ++i) {
    if (t.edge[i] == EdgeKind::flat) continue;
    const int j = next_corner(i), l = next_corner(j);
    for (unsigned rest = edges_across(face, beyond[i]); rest != 0; rest &= rest - 1) {
      const int k = std::countr_zero(rest), next = k + 1 == face.count ? 0 : k + 1;
      const float from = outside.distance[i][k], to = outside.distance[i][next];
      const Vec3 p = lerp(face.vertices[k], face.vertices[next], clamp(from / (from - to), 0.0f, 1.0f));
      if (dot(t.outward[j], p - t.v[j]) > t.slack || dot(t.outward[l], p - t.v[l]) > t.slack) continue;
      emit.core_point(p, point_name(PointKind::edges, t.edge_id[i], edge_name(face, k)));
    }
  }
  corners_under_face(t, face, emit);
}

namespace {

// The displacement must cover both the distance to the plane and the distance along it to the triangle.
bool has_valley_points(const LocalTriangle& t, Vec3 p, float separation, float max_distance) {
  if (separation < 0.0f || separation > max_distance) return false;
  const float farthest = square(max_distance) - square(separation);
  bool beside = false;
  for (int i = 0; i < 3; ++i) {
    const Vec3 from_start = p - t.v[i];
    const float beyond = dot(t.outward[i], from_start);
    if (beyond <= t.slack) continue;
    const float along = dot(t.along[i], from_start), past = along - clamp(along, 0.0f, t.length[i]);
    if (t.edge[i] != EdgeKind::concave || square(beyond) + square(past) > farthest) return false;
    beside = true;
  }
  return beside;
}

}  // namespace

void valley_points(const LocalTriangle& t, const LocalConvex& convex, float max_separation, MeshPoints& out) {
  if (convex.vertex_count() > 2) return;
  const Emitter emit{t.normal, t.v[0], convex.radius(), max_separation, out};
  for (int k = 0; k < convex.vertex_count(); ++k) {
    const Vec3 p = convex.vertex(k);
    const float separation = dot(t.normal, p - t.v[0]) - convex.radius();
    if (has_valley_points(t, p, separation, max_separation))
      emit.pair(p, separation, point_name(PointKind::shape_corner, normal_name(t.normal), std::uint32_t(k)));
  }
}

bool has_valley_points(const LocalTriangle& t, const LocalConvex& convex, float max_distance) {
  MeshPoints found;
  valley_points(t, convex, max_distance, found);
  return found.count > 0;
}

namespace {

// One edge of the triangle, and the feature of the shape that faces it.
struct EdgeContact {
  const LocalTriangle& t;
  int edge;
  const FacePolygon& face;
  Vec3 direction;
  const Emitter& emit;

  Vec3 start() const { return t.v[edge]; }
  Vec3 end() const { return t.v[next_corner(edge)]; }
  Vec3 at(float s) const { return lerp(start(), end(), s); }

  // A point of the edge, with the surface of the core above it at `height` along the direction.
  void add(float s, float height, std::uint32_t name) const {
    const Vec3 p = at(s);
    emit.pair(p + height * direction, height - emit.radius, name);
  }

  void under_polygon() const;
  void parallel_segment() const;
  void nearest() const;
};

// The two ends of the stretch of the edge that lies under the polygon.
void EdgeContact::under_polygon() const {
  const float facing = dot(face.normal, direction);
  float low = 0.0f, high = 1.0f;
  std::uint32_t low_name = point_name(PointKind::surface_corner, t.corner_id[edge], face.feature);
  std::uint32_t high_name =
      point_name(PointKind::surface_corner, t.corner_id[next_corner(edge)], face.feature);
  for (int k = 0; k < face.count; ++k) {
    const Vec3 a = face.vertices[k], side = face.vertices[k + 1 == face.count ? 0 : k + 1] - a;
    const Vec3 inward = cross(side, direction);  // the direction runs into the face, against its normal
    const float from = dot(inward, start() - a), to = dot(inward, end() - a);
    const float slack = t.slack * length(side);
    if (from < -slack && to < -slack) return;
    const std::uint32_t name = point_name(PointKind::edges, t.edge_id[edge], edge_name(face, k));
    if (from < 0.0f && to > 0.0f && from / (from - to) > low) {
      low = from / (from - to);
      low_name = name;
    } else if (from > 0.0f && to < 0.0f && from / (from - to) < high) {
      high = from / (from - to);
      high_name = name;
    }
  }
  if (low > high) return;
  const auto height = [&](float s) { return dot(face.normal, face.vertices[0] - at(s)) / facing; };
  add(low, height(low), low_name);
  if (low < high) add(high, height(high), high_name);
}

// Two parallel edges: the ends of the stretch that both share.
void EdgeContact::parallel_segment() const {
  const Vec3 a = face.vertices[0], b = face.vertices[1], along = end() - start();
  const float scale = 1.0f / length_squared(along);
  const float s_a = dot(a - start(), along) * scale, s_b = dot(b - start(), along) * scale;
  const float low = max(0.0f, min(s_a, s_b)), high = min(1.0f, max(s_a, s_b));
  if (low > high || s_a == s_b) return;
  const auto height = [&](float s) { return dot(direction, lerp(a, b, (s - s_a) / (s_b - s_a)) - at(s)); };
  const auto name = [&](float s, int corner) {
    if (s == s_a || s == s_b)
      return point_name(PointKind::edges, t.edge_id[edge], face.ids[s == s_a ? 0 : 1]);
    return point_name(PointKind::surface_corner, t.corner_id[corner], edge_name(face, 0));
  };
  add(low, height(low), name(low, edge));
  if (low < high) add(high, height(high), name(high, next_corner(edge)));
}

// Two crossing edges, or an edge and a point.
void EdgeContact::nearest() const {
  const Vec3 last = face.vertices[face.count - 1];
  const SegmentPair pair =
      closest_of_segments(DVec3(start()), DVec3(end()), DVec3(face.vertices[0]), DVec3(last));
  const Vec3 p = to_float(pair.on_a), q = to_float(pair.on_b);
  // The edges are apart and do not cross. Another feature is closer.
  const float along = dot(direction, q - p);
  const float beside = kCrossingSlack * max(t.length[edge], length(last - face.vertices[0])) + t.slack;
  if (along > emit.radius && length_squared(q - p) > square(along) + square(beside)) return;
  const std::uint32_t name = face.count == 1 ? face.ids[0] : edge_name(face, 0);
  emit.pair(q, along - emit.radius, point_name(PointKind::edges, t.edge_id[edge], name));
}

// The lowest edge of a polygon along `direction`, which starts at its lowest corner.
void lowest_edge(const FacePolygon& face, Vec3 direction, FacePolygon& out) {
  int lowest = 0;
  for (int k = 1; k < face.count; ++k) {
    if (dot(direction, face.vertices[k]) < dot(direction, face.vertices[lowest])) lowest = k;
  }
  const int after = lowest + 1 == face.count ? 0 : lowest + 1,
            before = lowest == 0 ? face.count - 1 : lowest - 1;
  // The flatter of the two edges that meet there.
  const auto rise = [&](int k) {
    const Vec3 edge = face.vertices[k] - face.vertices[lowest];
    return dot(direction, edge) / max(length(edge), 1.0e-30f);
  };
  const int other = rise(after) <= rise(before) ? after : before;
  out.count = 2;
  out.normal = -direction;
  out.feature = face.feature;
  out.vertices[0] = face.vertices[lowest];
  out.ids[0] = face.ids[lowest];
  out.vertices[1] = face.vertices[other];
  out.ids[1] = face.ids[other];
}

void corner_points(const LocalTriangle& t, int corner, const LocalConvex& convex, const FeatureAxis& axis,
                   const FacePolygon& face, const Emitter& emit) {
  const Vec3 v = t.v[corner];
  const std::uint32_t on_shape = face.count == 2 ? edge_name(face, 0) : face.feature;
  const std::uint32_t name = point_name(PointKind::surface_corner, t.corner_id[corner], on_shape);
  float height = dot(emit.direction, axis.on_core - v);
  if (axis.source != AxisSource::nearest_pair) {
    const float facing = dot(face.normal, emit.direction);
    const bool flush = face.count >= 3 && facing < -kFlushShare;
    // Beside the face nothing lies above the corner at that height.
    if (flush && !inside_polygon(face, v, t.slack)) return;
    height = flush ? dot(face.normal, face.vertices[0] - v) / facing
                   : convex.lowest(emit.direction) - dot(emit.direction, v);
  }
  const Vec3 q = v + height * emit.direction;
  emit.pair(q, height - emit.radius, name);
}

// The feature of the shape along an edge of the triangle if it is no face: an edge or a point.
void narrow_feature(const LocalConvex& convex, const FeatureAxis& axis, const FacePolygon& face,
                    FacePolygon& out) {
  if (axis.source == AxisSource::shape_edge) {
    out.count = 2;
    out.normal = -axis.direction;
    out.vertices[0] = convex.vertex(axis.from);
    out.vertices[1] = convex.vertex(axis.to);
    out.ids[0] = std::uint8_t(axis.from);
    out.ids[1] = std::uint8_t(axis.to);
  } else if (face.count >= 3) {
    lowest_edge(face, axis.direction, out);
  } else {
    out = face;
  }
}

}  // namespace

void feature_points(const LocalTriangle& t, const LocalConvex& convex, const FeatureAxis& axis,
                    float max_separation, MeshPoints& out) {
  const Vec3 d = axis.direction;
  FacePolygon face;
  convex.face_towards(-d, face);
  const Emitter emit{d, t.v[0], convex.radius(), max_separation, out};
  const bool flush = face.count >= 3 && dot(face.normal, d) < -kFlushShare;
  // The other ridges under a face, too: it may rock from one to the other.
  const auto add_other_edges = [&](int but) {
    for (int i = 0; i < 3; ++i) {
      if (i != but && (t.edge[i] == EdgeKind::convex || t.edge[i] == EdgeKind::open))
        EdgeContact{t, i, face, d, emit}.under_polygon();
    }
  };
  for (int i = 0; i < 3; ++i) {
    if (axis.corners != 1u << i) continue;
    corner_points(t, i, convex, axis, face, emit);
    if (flush && axis.source != AxisSource::nearest_pair) add_other_edges(-1);
    return;
  }
  const int edge = axis.corners == 3 ? 0 : (axis.corners == 6 ? 1 : 2);
  if (flush) {
    // Also if an edge of the shape touches: the other end of that face is over the triangle's edge too, and with only
    // one of the two points the shape would rock on it from step to step.
    EdgeContact{t, edge, face, d, emit}.under_polygon();
    const bool is_nearest =
        axis.source != AxisSource::shape_edge || out.deepest() <= axis.separation + kAxisBias * convex.size();
    if (out.count > 0 && is_nearest) return add_other_edges(edge);
    out.count = 0;
  }
  FacePolygon narrow;
  narrow_feature(convex, axis, face, narrow);
  const EdgeContact contact{t, edge, narrow, d, emit};
  if (narrow.count == 2) {
    const Vec3 segment = narrow.vertices[1] - narrow.vertices[0];
    if (length(cross(segment, t.along[edge])) <= kSideBySideEdges * length(segment)) {
      contact.parallel_segment();
      if (out.count > 0) return;
    }
  }
  if (axis.source != AxisSource::nearest_pair) return contact.nearest();
  const std::uint32_t on_shape = narrow.count == 1 ? narrow.ids[0] : edge_name(narrow, 0);
  emit.pair(axis.on_core, axis.separation, point_name(PointKind::edges, t.edge_id[edge], on_shape));
}

}  // namespace gyre
