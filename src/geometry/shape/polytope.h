// One view of sharp convex polyhedra for the axis search: a cooked hull, or a box in the same form.
#pragma once

#include "geometry/shape/hull.h"
#include "geometry/shape/support.h"
#include "math/wide_vec.h"

#include <bit>

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
  const std::uint64_t* edges_of;  // as in Hull
  int edge_words;
  Vec3 centroid;
  float inner_radius;  // of a ball around the centroid
  float size;          // the largest absolute coordinate
};

Polytope make_polytope(const Hull& hull);

// A box of rounding 0 as a polytope. It owns the columns, so it must outlive the view. Corners are numbered by the
// signs of their coordinates (bit 0: x positive ...), faces 2 * axis + (positive ? 1 : 0), as in support_face.
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
  HullEdge edges_[12];
  float inner_radius_, size_;
};

// The number of a face's corners in a polygon, and each corner. A face with more than kMaxFaceVertices corners is
// thinned evenly.
inline int face_corners(const Polytope& p, int face) {
  return min(int(p.face_offsets[face + 1] - p.face_offsets[face]), kMaxFaceVertices);
}
inline int face_corner(const Polytope& p, int face, int i) {
  const int begin = int(p.face_offsets[face]), count = int(p.face_offsets[face + 1]) - begin;
  return p.face_vertices[count <= kMaxFaceVertices ? begin + i : begin + i * count / kMaxFaceVertices];
}
// Calls `visit` with each edge in `bits`, in ascending order.
template <class Visit>
void for_each_edge(std::uint64_t bits, int word, Visit&& visit) {
  for (; bits != 0; bits &= bits - 1) visit(64 * word + std::countr_zero(bits));
}
// The face as a polygon in the polytope's frame.
void face_polygon(const Polytope& polytope, int face, FacePolygon& out);

// Lanes of the search over vertices and planes: every x86-64, 64-bit ARM and WebAssembly has registers of four.
constexpr int kPolytopeLanes = 4;
static_assert(Hull::kPad % kPolytopeLanes == 0);

// dot(direction, vertex) of four vertices.
inline Wide<kPolytopeLanes> values_along(const Polytope& p, int first, Vec3W<kPolytopeLanes> direction) {
  using Floats = Wide<kPolytopeLanes>;
  return Floats::load_unaligned(p.x + first) * direction.x +
         Floats::load_unaligned(p.y + first) * direction.y +
         Floats::load_unaligned(p.z + first) * direction.z;
}

struct PlaneLanes {
  Vec3W<kPolytopeLanes> normal;
  Wide<kPolytopeLanes> offset;
};
inline PlaneLanes gather_planes(const float* const (&planes)[kPolytopeLanes]) {
  Wide<kPolytopeLanes> columns[4];
  Rows<kPolytopeLanes>::gather(planes, 0, columns);
  return {{columns[0], columns[1], columns[2]}, columns[3]};
}
// Four planes. Lanes after the last plane repeat it.
inline PlaneLanes load_planes(const Polytope& p, int first) {
  const HullPlane* const four = p.planes + first;
  if (first + kPolytopeLanes <= p.face_count)
    return gather_planes({&four[0].normal.x, &four[1].normal.x, &four[2].normal.x, &four[3].normal.x});
  const int last = p.face_count - 1 - first;
  return gather_planes(
      {&four[0].normal.x, &four[min(1, last)].normal.x, &four[min(2, last)].normal.x, &four[last].normal.x});
}

// Smallest and largest dot(direction, vertex).
inline float lowest_along(const Polytope& p, Vec3 d) {
  const Vec3W<kPolytopeLanes> direction = splat<kPolytopeLanes>(d);
  Wide<kPolytopeLanes> best = values_along(p, 0, direction);
  for (int i = kPolytopeLanes; i < p.padded_count; i += kPolytopeLanes)
    best = min(values_along(p, i, direction), best);
  return min(min(best[3], best[1]), min(best[2], best[0]));
}
float highest_along(const Polytope& polytope, Vec3 direction);

struct LowestVertex {
  int vertex;  // the lowest index among equals
  float value;
};
// The vertex with the smallest dot(direction, vertex), and that value.
LowestVertex lowest_vertex(const Polytope& polytope, Vec3 direction);

}  // namespace gyre
