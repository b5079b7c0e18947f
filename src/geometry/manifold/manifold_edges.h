// The normal where two parallel edges meet: the apex of two boards that lean on each other.
//
// Any direction in the normal cones of both edges separates the shapes equally well, and the axis search names one end: a face of one
// of the two. That face would carry all load, however little of it the edge touches. The middle of the common cone treats both alike, and
// is what edges with any rounding have.
#pragma once

#include "geometry/manifold/manifold.h"
#include "math/trig.h"

namespace gyre {

// Points are on an edge if they are this near its two faces, in shares of the thinnest half extent or inner radius.
constexpr float kOnEdge = 0.02f;

// The faces at an edge: two normals, out of the shape.
struct EdgeFaces {
  Vec3 normals[2];
  int count = 0;

  void add(Vec3 normal) {
    if (count < 2) normals[count] = normal;
    ++count;
  }
};

// The middle of the directions that are normals of both edges, from A to B; `normal` if that is all of them, or if one of the two is no
// edge. All in one frame.
inline Vec3 normal_of_edges(Vec3 normal, const EdgeFaces& a, const EdgeFaces& b) {
  constexpr float kNarrow = 0.02f;  // rad
  if (a.count != 2 || b.count != 2) return normal;
  const Vec3 along = normalized(cross(a.normals[0], a.normals[1])), across = cross(along, normal);
  const auto angle = [&](Vec3 v) { return atan2(dot(v, across), dot(v, normal)); };
  const float a0 = angle(a.normals[0]), a1 = angle(a.normals[1]);
  const float b0 = angle(-b.normals[0]), b1 = angle(-b.normals[1]);
  const float low = max(min(a0, a1), min(b0, b1)), high = min(max(a0, a1), max(b0, b1));
  if (!(high - low > kNarrow)) return normal;
  const SinCos middle = sin_cos(0.5f * (low + high));
  return normalized(middle.cos * normal + middle.sin * across);
}

// The two points of a manifold that are farthest apart along its first and farthest one: the ends of an edge.
inline void keep_ends(LocalManifold& manifold) {
  const auto from_first = [&](int i) {
    return length_squared(manifold.points[i].position - manifold.points[0].position);
  };
  int far = 1;
  for (int i = 2; i < manifold.count; ++i) far = from_first(i) > from_first(far) ? i : far;
  const Vec3 along = manifold.points[far].position - manifold.points[0].position;
  int low = 0;
  for (int i = 1; i < manifold.count; ++i) {
    if (dot(along, manifold.points[i].position) < dot(along, manifold.points[low].position)) low = i;
  }
  const ManifoldPoint ends[2] = {manifold.points[low], manifold.points[far]};
  manifold.points[0] = ends[0], manifold.points[1] = ends[1];
  manifold.count = 2;
}

// The surfaces of both shapes at each point, all in A's frame.
struct SurfacePoints {
  Vec3 on_a[kMaxManifoldPoints], on_b[kMaxManifoldPoints];

  explicit SurfacePoints(const LocalManifold& manifold) {
    for (int i = 0; i < manifold.count; ++i) {
      const Vec3 half_gap = (0.5f * manifold.points[i].separation) * manifold.normal;
      on_a[i] = manifold.points[i].position - half_gap;
      on_b[i] = manifold.points[i].position + half_gap;
    }
  }
};

// Moves the ends to a new normal, unless they are clearly deeper along it: then more than edges overlap. `reach`: how far the reference
// shape reaches along the normal; `thin`: as in manifold_crossing.h.
inline void set_edge_normal(LocalManifold& manifold, Vec3 normal, bool reference_is_a, float reach,
                            float thin) {
  LocalManifold ends = manifold;
  keep_ends(ends);
  const SurfacePoints before(ends);
  const float deepest = min(1.09f * deepest_of(manifold), 0.0f) - 1.0e-3f * thin;
  for (int i = 0; i < ends.count; ++i) {
    const Vec3 on_incident = reference_is_a ? before.on_b[i] : before.on_a[i];
    const float along = dot(normal, on_incident);
    ManifoldPoint& point = ends.points[i];
    point.separation = reference_is_a ? along - reach : reach - along;
    point.position = on_incident + ((reference_is_a ? -0.5f : 0.5f) * point.separation) * normal;
    if (point.separation < deepest) return;
  }
  ends.normal = normal;
  manifold = ends;
}

}  // namespace gyre
