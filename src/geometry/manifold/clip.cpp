// Clipping of faces and reduction of contact points. See clip.h.
#include "geometry/manifold/clip.h"

#include <utility>

namespace gyre {
namespace {

// Depths that differ by less than this fraction of the width of the manifold are equally deep. Rounding must not decide
// which comes first, or a resting stack would change its points in every step.
constexpr float kEqualDepth = 5.0e-4f;
// The same for lengths and areas.
constexpr float kEqualSpan = 1.0e-3f;

// A corner during clipping, and the edge that leaves it: an edge of the incident face (below kSide), or a stretch of a
// side of the reference face.
struct ClipCorner {
  float x, y, z;   // plain numbers: a Vec3 would fill both buffers with zeros in every call
  float distance;  // how far outside the current side
  std::uint32_t feature;
  int edge;

  Vec3 point() const { return {x, y, z}; }
  void set_point(Vec3 p) { x = p.x, y = p.y, z = p.z; }
};
constexpr int kSide = 256;

// The two faces by their roles: the sides of the reference face cut the incident one.
struct Clipper {
  const FacePair& pair;
  const FacePolygon& reference;
  const FacePolygon& incident;
  bool reference_is_a;
  Vec3 facing;  // the normal, outward from the reference shape

  Clipper(const FacePair& p, bool is_a)
      : pair(p),
        reference(is_a ? *p.a : *p.b),
        incident(is_a ? *p.b : *p.a),
        reference_is_a(is_a),
        facing(is_a ? p.normal : -p.normal) {}

  std::uint32_t incident_vertex(std::uint32_t id) const {
    return reference_is_a ? feature_vertex_b(id) : feature_vertex_a(id);
  }
  std::uint32_t reference_vertex(std::uint32_t id) const {
    return reference_is_a ? feature_vertex_a(id) : feature_vertex_b(id);
  }
  // The name of the point where side `side` of the reference cuts an edge of the polygon.
  std::uint32_t crossing(int edge, int side) const {
    const int n = reference.count;
    if (edge >= kSide) {
      const int other = edge - kSide;
      if ((other + 1) % n == side) return reference_vertex(reference.ids[side]);
      if ((side + 1) % n == other) return reference_vertex(reference.ids[other]);
      return reference_is_a ? feature_edges(reference.ids[side], 256u + reference.ids[other])
                            : feature_edges(256u + reference.ids[other], reference.ids[side]);
    }
    return reference_is_a ? feature_edges(reference.ids[side], incident.ids[edge])
                          : feature_edges(incident.ids[edge], reference.ids[side]);
  }
  // The outward normal of a side. It is as long as the edge.
  Vec3 side_normal(int side) const {
    const Vec3 from = reference.vertices[side],
               to = reference.vertices[side + 1 == reference.count ? 0 : side + 1];
    return cross(to - from, facing);
  }
  // The contact point at a point of the incident core. Returns false if it is too far from the plane of the reference.
  bool emit(Vec3 point, std::uint32_t feature, ManifoldPoint& out) const {
    const float slope = dot(facing, reference.normal);
    const float gap = dot(point - reference.vertices[0], reference.normal) / slope;
    out.separation = gap - (pair.radius_a + pair.radius_b);
    if (!(out.separation <= pair.max_separation)) return false;
    const float radius = reference_is_a ? pair.radius_b : pair.radius_a;
    out.position = point - (radius + 0.5f * out.separation) * facing;
    out.feature = feature;
    return true;
  }
};

ClipCorner cut(const Clipper& clipper, const ClipCorner& from, const ClipCorner& to, int side) {
  ClipCorner out;
  // Always from the inner to the outer end, so that both directions of an edge give the same bits.
  const bool inward = from.distance > 0.0f;
  const ClipCorner& inner = inward ? to : from;
  const ClipCorner& outer = inward ? from : to;
  const float t = inner.distance / (inner.distance - outer.distance);
  out.set_point(lerp(inner.point(), outer.point(), t));
  out.distance = 0.0f;
  out.feature = clipper.crossing(from.edge, side);
  out.edge = inward ? from.edge : kSide + side;
  return out;
}

int clip_polygon(const Clipper& clipper, ManifoldPoint* out) {
  ClipCorner buffers[2][kMaxClipPoints];
  ClipCorner* polygon = buffers[0];
  ClipCorner* next = buffers[1];
  int count = clipper.incident.count;
  for (int i = 0; i < count; ++i) {
    polygon[i].set_point(clipper.incident.vertices[i]);
    polygon[i].distance = 0.0f;
    polygon[i].feature = clipper.incident_vertex(clipper.incident.ids[i]);
    polygon[i].edge = i;
  }
  for (int side = 0; side < clipper.reference.count && count > 0; ++side) {
    const Vec3 outward = clipper.side_normal(side), corner = clipper.reference.vertices[side];
    bool any_outside = false;
    for (int i = 0; i < count; ++i) {
      polygon[i].distance = dot(polygon[i].point() - corner, outward);
      any_outside = any_outside || polygon[i].distance > 0.0f;
    }
    if (!any_outside) continue;
    int count_inside = 0;
    for (int i = 0; i < count; ++i) {
      const ClipCorner& from = polygon[i];
      const ClipCorner& to = polygon[i + 1 == count ? 0 : i + 1];
      const bool from_inside = from.distance <= 0.0f, to_inside = to.distance <= 0.0f;
      if (from_inside) next[count_inside++] = from;
      // A convex polygon grows by at most one corner a side. The bound guards against rounding.
      if (from_inside != to_inside && count_inside < kMaxClipPoints - 1)
        next[count_inside++] = cut(clipper, from, to, side);
    }
    ClipCorner* swap = polygon;
    polygon = next;
    next = swap;
    count = count_inside;
  }
  int points = 0;
  for (int i = 0; i < count; ++i) {
    // Rounding may cut a corner into two with one name.
    if (points > 0 && out[points - 1].feature == polygon[i].feature) continue;
    if (clipper.emit(polygon[i].point(), polygon[i].feature, out[points])) ++points;
  }
  if (points > 1 && out[points - 1].feature == out[0].feature) --points;
  return points;
}

int clip_segment(const Clipper& clipper, ManifoldPoint* out) {
  const Vec3 a = clipper.incident.vertices[0], b = clipper.incident.vertices[1];
  float enter = 0.0f, leave = 1.0f;
  std::uint32_t enter_feature = clipper.incident_vertex(clipper.incident.ids[0]);
  std::uint32_t leave_feature = clipper.incident_vertex(clipper.incident.ids[1]);
  for (int side = 0; side < clipper.reference.count; ++side) {
    const Vec3 outward = clipper.side_normal(side), corner = clipper.reference.vertices[side];
    const float from = dot(a - corner, outward), to = dot(b - corner, outward);
    if (from > 0.0f && to > 0.0f) return 0;
    if (from > 0.0f && from / (from - to) > enter) {
      enter = from / (from - to);
      enter_feature = clipper.crossing(0, side);
    } else if (to > 0.0f && from / (from - to) < leave) {
      leave = from / (from - to);
      leave_feature = clipper.crossing(1, side);
    }
  }
  if (enter > leave) return 0;
  int points = 0;
  if (clipper.emit(enter == 0.0f ? a : lerp(a, b, enter), enter_feature, out[points])) ++points;
  if (leave > enter && clipper.emit(leave == 1.0f ? b : lerp(a, b, leave), leave_feature, out[points]))
    ++points;
  return points;
}

}  // namespace

int clip_faces(const FacePair& pair, bool reference_is_a, ManifoldPoint* out) {
  const Clipper clipper(pair, reference_is_a);
  return clipper.incident.count == 2 ? clip_segment(clipper, out) : clip_polygon(clipper, out);
}

int clip_segments(const FacePair& pair, ManifoldPoint* out) {
  const FacePolygon& a = *pair.a;
  const FacePolygon& b = *pair.b;
  // The ends of B along A's segment, seen along the normal.
  const Vec3 raw = a.vertices[1] - a.vertices[0];
  const Vec3 along = raw - dot(raw, pair.normal) * pair.normal;
  const float along_squared = dot(along, along);
  if (!(along_squared > 0.0f)) return 0;
  const float t0 = dot(b.vertices[0] - a.vertices[0], along) / along_squared;
  const float t1 = dot(b.vertices[1] - a.vertices[0], along) / along_squared;
  if (t0 == t1) return 0;
  const float low = max(0.0f, min(t0, t1)), high = min(1.0f, max(t0, t1));
  if (!(low <= high)) return 0;
  int points = 0;
  for (int end = 0; end < 2; ++end) {
    const float t = end == 0 ? low : high;
    const Vec3 on_a = lerp(a.vertices[0], a.vertices[1], t);
    const float u = clamp((t - t0) / (t1 - t0), 0.0f, 1.0f);
    const Vec3 on_b = lerp(b.vertices[0], b.vertices[1], u);
    ManifoldPoint& point = out[points];
    const float gap = dot(on_b - on_a, pair.normal);
    if (length_squared(on_b - on_a) > square(gap) + square(pair.max_lateral_offset)) return 0;
    point.separation = gap - (pair.radius_a + pair.radius_b);
    if (!(point.separation <= pair.max_separation)) continue;
    point.position = 0.5f * ((on_a + pair.radius_a * pair.normal) + (on_b - pair.radius_b * pair.normal));
    const bool end_of_a = end == 0 ? min(t0, t1) <= 0.0f : max(t0, t1) >= 1.0f;
    point.feature =
        end_of_a ? feature_vertex_a(a.ids[end]) : feature_vertex_b(b.ids[(t0 < t1) == (end == 0) ? 0 : 1]);
    ++points;
    if (low == high) break;
  }
  return points;
}

int reduce_points(ManifoldPoint* points, int count, Vec3 normal, float fade) {
  if (count <= kMaxManifoldPoints) return count;
  float value[kMaxClipPoints + 1];
  int chosen[kMaxManifoldPoints] = {-1, -1, -1, -1};
  // Chooses the candidate with the largest value, and the one with the smallest name among nearly equal ones. Chooses
  // none if no value is above `floor`.
  const auto choose = [&](int slot, float best, float floor, float tolerance) {
    if (!(best > floor)) return false;
    for (int i = 0; i < count; ++i) {
      if (!(value[i] >= best - tolerance)) continue;
      if (chosen[slot] < 0 || points[i].feature < points[chosen[slot]].feature) chosen[slot] = i;
    }
    return chosen[slot] >= 0;
  };

  // First: the deepest point, by name among equally deep ones.
  float width_squared = 0.0f, deepest = points[0].separation;
  for (int i = 0; i < count; ++i) {
    width_squared = max(width_squared, length_squared(points[i].position - points[0].position));
    deepest = min(deepest, points[i].separation);
    value[i] = -points[i].separation;
  }
  // If positions are not finite (bodies that are about to be removed from the world), the first point stays.
  if (!choose(0, -deepest, -kUnbounded, kEqualDepth * std::sqrt(width_squared))) chosen[0] = 0;
  const Vec3 p0 = points[chosen[0]].position;
  int chosen_count = 1;
  float weight[kMaxClipPoints + 1];
  for (int i = 0; i < count; ++i) weight[i] = 1.0f / (1.0f + fade * (points[i].separation - deepest));

  // Second: the point farthest from the first. Third: the largest triangle with both. Fourth: the largest addition to
  // that area.
  float farthest = 0.0f, widest = 0.0f, added = 0.0f;
  for (int i = 0; i < count; ++i) {
    value[i] = weight[i] * length_squared(points[i].position - p0);
    farthest = max(farthest, value[i]);
  }
  if (choose(1, farthest, 1.0e-12f * width_squared, kEqualSpan * farthest)) {
    ++chosen_count;
    const Vec3 p1 = points[chosen[1]].position, beside = cross(normal, p1 - p0);
    for (int i = 0; i < count; ++i) {
      value[i] = weight[i] * absolute(dot(beside, points[i].position - p0));
      widest = max(widest, value[i]);
    }
    if (choose(2, widest, 1.0e-6f * farthest, kEqualSpan * widest)) {
      ++chosen_count;
      const Vec3 p2 = points[chosen[2]].position;
      const float winding = dot(beside, p2 - p0) > 0.0f ? -1.0f : 1.0f;
      const Vec3 out01 = winding * beside, out12 = winding * cross(normal, p2 - p1),
                 out20 = winding * cross(normal, p0 - p2);
      for (int i = 0; i < count; ++i) {
        const Vec3 p = points[i].position;
        value[i] = weight[i] * max(max(dot(out01, p - p0), dot(out12, p - p1)), dot(out20, p - p2));
        added = max(added, value[i]);
      }
      if (choose(3, added, 1.0e-4f * widest, kEqualSpan * added)) ++chosen_count;
    }
  }
  // Restore the order of the input, so that it does not depend on the choice.
  for (int i = 0; i < chosen_count; ++i) {
    for (int k = i + 1; k < chosen_count; ++k) {
      if (chosen[k] < chosen[i]) std::swap(chosen[i], chosen[k]);
    }
  }
  for (int i = 0; i < chosen_count; ++i) points[i] = points[chosen[i]];
  return chosen_count;
}

}  // namespace gyre
