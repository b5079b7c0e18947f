// Balls and capsules beside triangles. See mesh_reject.h.
#include "geometry/manifold_mesh/mesh_reject.h"

namespace gyre {
namespace {

// Relative to the size of the shape, and a sine: more than the search for a direction asks for before it prefers one of two, or allows one.
constexpr float kRoom = 2.0e-3f;
constexpr float kArc = 3.0e-3f;
// A sine, squared, between a segment and an edge.
constexpr float kLeast = 0.05f;

bool is_denied(const LocalTriangle& t, int edge, Vec3 from_edge) {
  if (t.edge[edge] != EdgeKind::convex) return t.edge[edge] != EdgeKind::open;
  const float inward = dot(from_edge, cross(t.neighbor_normal[edge], t.along[edge]));
  return inward < 0.0f && square(inward) > square(kArc) * length_squared(from_edge);
}

bool is_denied_at_corner(const Surface& surface, const LocalTriangle& t, int corner, Vec3 from_corner) {
  if ((t.flat_corners >> corner & 1) != 0) return true;
  const int own = t.turned && corner != 0 ? 3 - corner : corner;
  return !surface.in_normal_cone(t.id, own, normalized(from_corner), kArc);
}

bool is_ball_beside(const Surface& surface, const LocalTriangle& t, const LocalConvex& ball,
                    float face_separation) {
  const float size = ball.size(), room = kRoom * size + 8.0f * t.slack;
  // Neither touching nor nearly over the face.
  const float clear = square(max(face_separation + ball.radius(), ball.radius()) + room);
  Vec3 way[3];
  float beyond[3], place[3];
  for (int i = 0; i < 3; ++i) {
    way[i] = ball.vertex(0) - t.v[i];
    beyond[i] = dot(t.outward[i], way[i]);
    place[i] = dot(t.along[i], way[i]);
  }
  for (int i = 0; i < 3; ++i) {
    const int next = next_corner(i), before = next_corner(next);
    if (beyond[i] < room) continue;
    if (place[i] > room && place[i] < t.length[i] - room) {
      const Vec3 from_edge = way[i] - place[i] * t.along[i];
      // Of slivers rounding decides what is nearest.
      return dot(from_edge, t.v[before] - t.v[i]) < -room * size && length_squared(from_edge) > clear &&
             is_denied(t, i, from_edge);
    }
    // The corner at which this edge begins, or ends.
    const int corner = place[i] < 0.0f ? i : next, arriving = corner == i ? before : i;
    if (place[corner] < -room && place[arriving] > t.length[arriving] + room)
      return length_squared(way[corner]) > clear && is_denied_at_corner(surface, t, corner, way[corner]);
  }
  return false;
}

// Whether no edge of the triangle allows a direction across it and the segment that is worth as much as `enough`.
bool are_axes_denied(const LocalTriangle& t, Vec3 from, Vec3 axis, float enough) {
  for (int i = 0; i < 3; ++i) {
    const Vec3 across = cross(axis, t.along[i]), d = dot(across, t.outward[i]) < 0.0f ? -across : across;
    const float squared = length_squared(d), height = dot(d, from - t.v[i]);
    // Those that are all but parallel are not asked.
    if (squared < square(0.5e-4f) * length_squared(axis) || height <= 0.0f) continue;
    if (square(height) > square(enough) * squared && !is_denied(t, i, d)) return false;
  }
  return true;
}

bool is_segment_beside(const LocalTriangle& t, const LocalConvex& capsule, float face_separation) {
  const float size = capsule.size(), room = kRoom * size + 8.0f * t.slack, radius = capsule.radius();
  const Vec3 from = capsule.vertex(0), axis = capsule.vertex(1) - from;
  const float squared_axis = length_squared(axis);
  for (int i = 0; i < 3; ++i) {
    const Vec3 way = from - t.v[i];
    const float beyond = dot(t.outward[i], way);
    if (beyond < room || beyond + dot(t.outward[i], axis) < room) continue;
    // What is nearest of the edge's line and of the segment. Where they are nearly parallel, rounding decides.
    const float part = dot(t.along[i], axis), place = dot(t.along[i], way);
    const float sine = squared_axis - square(part);
    if (sine < kLeast * squared_axis) return false;
    const float share = clamp((part * place - dot(axis, way)) / sine, 0.0f, 1.0f), s = place + share * part;
    if (s < room || s > t.length[i] - room) continue;
    const Vec3 between = way + share * axis - s * t.along[i];
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
      return is_ball_beside(surface, t, round, face_separation);
    case 2:
      return is_segment_beside(t, round, face_separation);
    default:
      return false;
  }
}

}  // namespace gyre
