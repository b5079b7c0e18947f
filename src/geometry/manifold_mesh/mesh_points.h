// Contact points of a convex shape on one triangle, for a known direction.
//
// Points are the corners of the shape's facing feature over the triangle, the crossings of its edges with the
// triangle's edges, and the corners of the triangle under the feature. Flat edges and flat corners give no points: the
// surface continues beyond them in the same plane, so such points would lie between others. A box on a floor has its
// four corners as points, however the floor is divided.
//
// Names of points: a corner of the shape over a face is named by the corner and roughly by the normal of the face, so
// that it keeps its name while it slides from triangle to triangle. All others are named by an edge or corner of the
// surface and one of the shape.
#pragma once

#include "geometry/manifold/manifold.h"
#include "geometry/manifold_mesh/mesh_axis.h"

namespace gyre {

// Points are relative to the shape's origin, in the surface's axes, until the very end.
struct MeshPoints {
  static constexpr int kRoom = 96;
  int count = 0;
  // Not cleared: only the counted elements are read.
  union {
    ManifoldPoint points[kRoom];
  };

  MeshPoints() {}
  // The smallest separation; infinity if there are no points.
  float deepest() const {
    float smallest = __builtin_huge_valf();
    for (int i = 0; i < count; ++i) smallest = min(smallest, points[i].separation);
    return smallest;
  }
  // Removes the points with a smaller separation.
  void drop_below(float separation) {
    int count_left = 0;
    for (int i = 0; i < count; ++i) {
      if (points[i].separation >= separation) points[count_left++] = points[i];
    }
    count = count_left;
  }
  void add(Vec3 position, float separation, std::uint32_t feature) {
    if (count < kRoom) points[count++] = {position, separation, feature};
  }
};

// Points along the triangle's normal. `side` must have its face.
void face_points(const LocalTriangle& triangle, const LocalConvex& convex, const PlaneSide& side,
                 float max_separation, MeshPoints& out);

// Points of a ball or capsule on a triangle that it is not over yet, but may reach within a displacement of
// `max_separation`, before the next update: ends of its core before the plane of the triangle, and beyond concave edges
// alone. Behind such an edge the plane runs below the surface, so it stops nothing that has not come over the triangle.
// Names as in face_points().
void valley_points(const LocalTriangle& triangle, const LocalConvex& convex, float max_separation,
                   MeshPoints& out);
bool has_valley_points(const LocalTriangle& triangle, const LocalConvex& convex, float max_separation);

// Points along the direction of a corner or an edge.
void feature_points(const LocalTriangle& triangle, const LocalConvex& convex, const FeatureAxis& axis,
                    float max_separation, MeshPoints& out);

}  // namespace gyre
