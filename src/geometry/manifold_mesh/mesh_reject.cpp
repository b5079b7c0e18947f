// Rejection of triangles for balls and capsules. See mesh_reject.h.
#include "geometry/manifold_mesh/mesh_reject.h"

namespace gyre {
namespace {

// Relative to the size of the shape, and a sine: more than the search requires to prefer one of two directions, or to
// allow one.
constexpr float kRoom = 2.0e-3f;
constexpr float kArc = 3.0e-3f;
// Squared sine between a segment and an edge.
constexpr float kMinSquaredSine = 0.05f;

bool is_denied(const LocalTriangle& t, int edge, Vec3 from_edge) {
  if (t.edge[edge] != EdgeKind::convex) return t.edge[edge] != EdgeKind::open;
  const float inward = dot(from_edge, cross(t.neighbor_normal[edge], t.along[edge]));
  return inward < 0.0f && square(inward) > square(kArc) * length_squared(from_edge);
}

bool is_denied_at_corner(const Surface& surface, const LocalTriangle& t, int corner, Vec3 from_corner) {
  if ((t.flat_corners >> corner & 1) != 0) return true;
  const int own = t.flipped && corner != 0 ? 3 - corner : corner;
  return !surface.in_normal_cone(t.id, own, normalized(from_corner), kArc);
}

bool is_ball_rejected(const Surface& surface, const LocalTriangle& t, const LocalConvex& ball,
                      float face_separation) {
  const float size = ball.size(), room = kRoom * size + 8.0f * t.slack;
  // The ball must neither touch the face nor be nearly over it.
  const float clear = square(max(face_separation + ball.radius(), ball.radius()) + room);
  Vec3 from_corner[3];
  float beyond[3], along[3];
  for (int i = 0; i < 3; ++i) {
    from_corner[i] = ball.vertex(0) - t.v[i];
    beyond[i] = dot(t.outward[i], from_corner[i]);
    along[i] = dot(t.along[i], from_corner[i]);
  }
  for (int i = 0; i < 3; ++i) {
    const int next = next_corner(i), before = next_corner(next);
    if (beyond[i] < room) continue;
    if (along[i] > room && along[i] < t.length[i] - room) {
      const Vec3 from_edge = from_corner[i] - along[i] * t.along[i];
      // Rounding decides the closest feature of a sliver.
      return dot(from_edge, t.v[before] - t.v[i]) < -room * size && length_squared(from_edge) > clear &&
             is_denied(t, i, from_edge);
    }
    // The corner at which this edge begins or ends.
    const int corner = along[i] < 0.0f ? i : next, arriving = corner == i ? before : i;
    if (along[corner] < -room && along[arriving] > t.length[arriving] + room)
      return length_squared(from_corner[corner]) > clear &&
             is_denied_at_corner(surface, t, corner, from_corner[corner]);
  }
  return false;
}

// True if no edge of the triangle allows a direction across it and the segment with a separation above `enough`.
bool are_axes_denied(const LocalTriangle& t, Vec3 from, Vec3 axis, float enough) {
  for (int i = 0; i < 3; ++i) {
    const Vec3 across = cross(axis, t.along[i]), d = dot(across, t.outward[i]) < 0.0f ? -across : across;
    const float squared = length_squared(d), height = dot(d, from - t.v[i]);
    // Nearly parallel pairs are skipped.
    if (squared < square(0.5e-4f) * length_squared(axis) || height <= 0.0f) continue;
    if (square(height) > square(enough) * squared && !is_denied(t, i, d)) return false;
  }
  return true;
}

bool is_segment_rejected(const LocalTriangle& t, const LocalConvex& capsule, float face_separation) {
  const float size = capsule.size(), room = kRoom * size + 8.0f * t.slack, radius = capsule.radius();
  const Vec3 from = capsule.vertex(0), axis = capsule.vertex(1) - from;
  const float squared_axis = length_squared(axis);
  for (int i = 0; i < 3; ++i) {
    const Vec3 from_start = from - t.v[i];
    const float beyond = dot(t.outward[i], from_start);
    if (beyond < room || beyond + dot(t.outward[i], axis) < room) continue;
    // The closest points of the line of the edge and of the segment. If they are nearly parallel, rounding decides.
    const float axis_along = dot(t.along[i], axis), start_along = dot(t.along[i], from_start);
    const float sine = squared_axis - square(axis_along);
    if (sine < kMinSquaredSine * squared_axis) return false;
    const float share = clamp((axis_along * start_along - dot(axis, from_start)) / sine, 0.0f, 1.0f),
                s = start_along + share * axis_along;
    if (s < room || s > t.length[i] - room) continue;
    const Vec3 between = from_start + share * axis - s * t.along[i];
    const float apart = length(between);
    return dot(between, t.v[next_corner(next_corner(i))] - t.v[i]) < -room * size &&
           apart > max(face_separation + radius, radius) + room && is_denied(t, i, between) &&
           are_axes_denied(t, from, axis, apart - room);
  }
  return false;
}

}  // namespace

bool is_round_rejected(const Surface& surface, const LocalTriangle& t, const LocalConvex& round,
                       float face_separation) {
  switch (round.vertex_count()) {
    case 1:
      return is_ball_rejected(surface, t, round, face_separation);
    case 2:
      return is_segment_rejected(t, round, face_separation);
    default:
      return false;
  }
}

}  // namespace gyre
