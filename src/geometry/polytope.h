// One view of sharp convex polyhedra for the axis search: a hull as it is cooked, or a box written out as one.
#pragma once

#include "geometry/hull.h"
#include "geometry/support.h"

namespace gyre {

struct Polytope {
  const float* x;  // columns, padded to a multiple of Hull::kPad
  const float* y;
  const float* z;
  int padded_count;
  int vertex_count;
  const Vec3* vertices;
  const HullPlane* planes;
  int face_count;
  const std::uint32_t* face_offsets;
  const std::uint8_t* face_vertices;
  const HullEdge* edges;
  int edge_count;
  Vec3 centroid;
  float inner_radius;  // of a ball around the centroid
  float size;          // the largest coordinate, without its sign
};

Polytope make_polytope(const Hull& hull);

// A box of rounding 0 as a polytope; keeps the columns, so it must outlive the view. Corners are numbered by the signs of
// their coordinates (bit 0: x positive ...), faces 2 * axis + (positive ? 1 : 0), as support_face names them.
class BoxPolytope {
 public:
  explicit BoxPolytope(Vec3 half_extents);
  BoxPolytope(const BoxPolytope&) = delete;
  BoxPolytope& operator=(const BoxPolytope&) = delete;
  Polytope view() const;

 private:
  float x_[8], y_[8], z_[8];
  Vec3 vertices_[8];
  HullPlane planes_[6];
  float inner_radius_, size_;
};

// The face as a polygon in the polytope's frame; one with more than kMaxFaceVertices corners is thinned evenly.
void face_polygon(const Polytope& polytope, int face, FacePolygon& out);

// Smallest and largest dot(direction, vertex). Here, because the axis search calls it for every face.
inline float lowest_along(const Polytope& p, Vec3 d) {
  constexpr int kLanes = Hull::kPad;
  float best[kLanes];
  for (int lane = 0; lane < kLanes; ++lane) best[lane] = p.x[lane] * d.x + p.y[lane] * d.y + p.z[lane] * d.z;
  for (int i = kLanes; i < p.padded_count; i += kLanes) {
    for (int lane = 0; lane < kLanes; ++lane) {
      const float value = p.x[i + lane] * d.x + p.y[i + lane] * d.y + p.z[i + lane] * d.z;
      best[lane] = min(value, best[lane]);
    }
  }
  for (int step = kLanes / 2; step > 0; step /= 2) {
    for (int lane = 0; lane < step; ++lane) best[lane] = min(best[lane + step], best[lane]);
  }
  return best[0];
}
float highest_along(const Polytope& polytope, Vec3 direction);

struct LowestVertex {
  int vertex;  // the lowest index among equals
  float value;
};
// The vertex of smallest dot(direction, vertex), and how much that is.
LowestVertex lowest_vertex(const Polytope& polytope, Vec3 direction);

}  // namespace gyre
