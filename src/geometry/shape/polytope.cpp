// Boxes and hulls as polytopes, and searches over their columns. See polytope.h.
#include "geometry/shape/polytope.h"

namespace gyre {
namespace {

static_assert(Hull::kPad == 8, "a box fills the columns exactly");

constexpr std::uint32_t kBoxOffsets[7] = {0, 4, 8, 12, 16, 20, 24};
// Faces -x +x -y +y -z +z, counter-clockwise seen from outside.
constexpr std::uint8_t kBoxFaces[24] = {0, 4, 6, 2, 1, 3, 7, 5, 0, 1, 5, 4,
                                        2, 6, 7, 3, 0, 2, 3, 1, 4, 5, 7, 6};
// Each edge in the loop order of its left face.
constexpr std::uint8_t kBoxEdges[12][4] = {{0, 1, 2, 4}, {2, 3, 4, 3}, {6, 7, 3, 5}, {5, 4, 2, 5},
                                           {0, 2, 4, 0}, {3, 1, 4, 1}, {7, 5, 1, 5}, {4, 6, 0, 5},
                                           {0, 4, 0, 2}, {1, 5, 2, 1}, {3, 7, 1, 3}, {6, 2, 0, 3}};

struct EdgesOfCorners {
  std::uint64_t of[8] = {};
};
constexpr EdgesOfCorners kEdgesOf = [] {
  EdgesOfCorners edges;
  for (int e = 0; e < 12; ++e) {
    for (int end = 0; end < 2; ++end) edges.of[kBoxEdges[e][end]] |= std::uint64_t(1) << e;
  }
  return edges;
}();

using Floats = Wide<kPolytopeLanes>;

}  // namespace

Polytope make_polytope(const Hull& hull) {
  return {hull.x.data(),
          hull.y.data(),
          hull.z.data(),
          int(hull.x.size()),
          hull.vertex_count(),
          hull.vertices.data(),
          hull.planes.data(),
          hull.face_count(),
          hull.face_offsets.data(),
          hull.face_vertices.data(),
          hull.edges.data(),
          int(hull.edges.size()),
          hull.edges_of.data(),
          hull.edge_words(),
          hull.centroid,
          hull.inner_radius,
          max(largest(absolute(hull.box.low)), largest(absolute(hull.box.high)))};
}

BoxPolytope::BoxPolytope(Vec3 h) : inner_radius_(smallest(h)), size_(largest(h)) {
  for (int i = 0; i < 8; ++i) {
    vertices_[i] = {(i & 1) ? h.x : -h.x, (i & 2) ? h.y : -h.y, (i & 4) ? h.z : -h.z};
    x_[i] = vertices_[i].x;
    y_[i] = vertices_[i].y;
    z_[i] = vertices_[i].z;
  }
  for (int i = 0; i < 12; ++i) {
    const std::uint8_t* const edge = kBoxEdges[i];
    edges_[i] = {edge[0], edge[1], edge[2], edge[3], vertices_[edge[1]] - vertices_[edge[0]]};
  }
  planes_[0] = {{-1, 0, 0}, h.x};
  planes_[1] = {{1, 0, 0}, h.x};
  planes_[2] = {{0, -1, 0}, h.y};
  planes_[3] = {{0, 1, 0}, h.y};
  planes_[4] = {{0, 0, -1}, h.z};
  planes_[5] = {{0, 0, 1}, h.z};
}

Polytope BoxPolytope::view() const {
  return {x_,        y_,     z_, 8,           8, vertices_, planes_,       6,    kBoxOffsets,
          kBoxFaces, edges_, 12, kEdgesOf.of, 1, {},        inner_radius_, size_};
}

void face_polygon(const Polytope& polytope, int face, FacePolygon& out) {
  out.feature = std::uint32_t(face);
  out.normal = polytope.planes[face].normal;
  out.count = face_corners(polytope, face);
  for (int i = 0; i < out.count; ++i) {
    const int vertex = face_corner(polytope, face, i);
    out.ids[i] = std::uint8_t(vertex);
    out.vertices[i] = polytope.vertices[vertex];
  }
}

float highest_along(const Polytope& p, Vec3 d) { return -lowest_along(p, -d); }

LowestVertex lowest_vertex(const Polytope& p, Vec3 d) {
  const Vec3W<kPolytopeLanes> direction = splat<kPolytopeLanes>(d);
  constexpr std::int32_t kOwn[kPolytopeLanes] = {0, 1, 2, 3};
  WideInt<kPolytopeLanes> index = WideInt<kPolytopeLanes>::load_unaligned(kOwn), winner = index;
  Floats best = values_along(p, 0, direction);
  for (int i = kPolytopeLanes; i < p.padded_count; i += kPolytopeLanes) {
    index = index + WideInt<kPolytopeLanes>(kPolytopeLanes);
    const Floats value = values_along(p, i, direction);
    winner = select(value < best, index, winner);
    best = min(value, best);
  }
  int lane = 0;
  for (int k = 1; k < kPolytopeLanes; ++k) {
    if (best[k] < best[lane] || (best[k] == best[lane] && winner[k] < winner[lane])) lane = k;
  }
  // The padding repeats the last vertex.
  return {min(winner[lane], p.vertex_count - 1), best[lane]};
}

}  // namespace gyre
