// Contact points of a convex shape on one triangle, once it is known along which direction they touch.
//
// Corners of the shape's facing feature over the triangle, its edges across the triangle's edges, and the triangle's corners
// under the feature. At flat edges and flat corners there is nothing to find: the surface goes on beyond them in the same
// plane, so points there would lie between others. A box on a floor has its four corners as points, however the floor is cut.
//
// Names of points: a corner of the shape over a face is named by the corner and roughly by the face's normal, so that it keeps
// its name while it slides from triangle to triangle; all others by edge or corner of the surface and of the shape.
#pragma once

#include "geometry/manifold/manifold.h"
#include "geometry/manifold_mesh/mesh_axis.h"

namespace gyre {

// Points are seen from the shape's origin, in the surface's axes, until the very end.
struct MeshPoints {
  static constexpr int kRoom = 96;
  int count = 0;
  // Not cleared: only the counted ones are ever read.
  union {
    ManifoldPoint points[kRoom];
  };

  MeshPoints() {}
  // The least separation; infinity if there are no points.
  float deepest() const {
    float least = __builtin_huge_valf();
    for (int i = 0; i < count; ++i) least = min(least, points[i].separation);
    return least;
  }
  // Forgets the points of a lesser separation.
  void drop_below(float separation) {
    int kept = 0;
    for (int i = 0; i < count; ++i) {
      if (points[i].separation >= separation) points[kept++] = points[i];
    }
    count = kept;
  }
  void add(Vec3 position, float separation, std::uint32_t feature) {
    if (count < kRoom) points[count++] = {position, separation, feature};
  }
};

// Points along the triangle's normal. `side` must have its face.
void face_points(const LocalTriangle& triangle, const LocalConvex& convex, const PlaneSide& side,
                 float max_separation, MeshPoints& out);

// Points of a ball or capsule on a triangle that it does not lie over yet, but may touch on a way of `max_separation`, before anybody
// looks again: the ends of its core that lie apart from the triangle's plane, and beside the triangle beyond concave edges alone. There
// the plane runs below the surface, so it stops nothing that has not come over the triangle. Named as by face_points().
void valley_points(const LocalTriangle& triangle, const LocalConvex& convex, float max_separation,
                       MeshPoints& out);
bool has_valley_points(const LocalTriangle& triangle, const LocalConvex& convex, float max_separation);

// Points along the direction of a corner or an edge.
void feature_points(const LocalTriangle& triangle, const LocalConvex& convex, const FeatureAxis& axis,
                    float max_separation, MeshPoints& out);

}  // namespace gyre
