// Balls beside triangles. See mesh_beside.h.
#include "geometry/mesh_beside.h"

namespace gyre {
namespace {

// Relative to the size of the ball, and a sine: more than the search for a direction asks for before it prefers one of two, or allows one.
constexpr float kRoom = 2.0e-3f;
constexpr float kArc = 3.0e-3f;

bool is_denied(const NearTriangle& t, int edge, Vec3 from_edge) {
  if (t.edge[edge] != EdgeKind::convex) return t.edge[edge] != EdgeKind::open;
  const float inward = dot(from_edge, cross(t.neighbor_normal[edge], t.along[edge]));
  return inward < 0.0f && square(inward) > square(kArc) * length_squared(from_edge);
}

bool is_denied_at_corner(const Surface& surface, const NearTriangle& t, int corner, Vec3 from_corner) {
  if ((t.flat_corners >> corner & 1) != 0) return true;
  const int own = t.turned && corner != 0 ? 3 - corner : corner;
  return !surface.in_normal_cone(t.id, own, normalized(from_corner), kArc);
}

}  // namespace

bool is_ball_beside(const Surface& surface, const NearTriangle& t, const PlacedConvex& ball,
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

}  // namespace gyre
