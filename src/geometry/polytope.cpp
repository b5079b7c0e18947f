// Boxes and hulls as polytopes, and searches over their columns. See polytope.h.
#include "geometry/polytope.h"

#include "math/wide_vec.h"

namespace gyre {
namespace {

static_assert(Hull::kPad == 8, "a box fills the columns exactly");

constexpr std::uint32_t kBoxOffsets[7] = {0, 4, 8, 12, 16, 20, 24};
// Faces -x +x -y +y -z +z, counter-clockwise seen from outside.
constexpr std::uint8_t kBoxFaces[24] = {0, 4, 6, 2, 1, 3, 7, 5, 0, 1, 5, 4,
                                        2, 6, 7, 3, 0, 2, 3, 1, 4, 5, 7, 6};
// Each edge in the loop order of its left face.
constexpr HullEdge kBoxEdges[12] = {{0, 1, 2, 4}, {2, 3, 4, 3}, {6, 7, 3, 5}, {5, 4, 2, 5},
                                    {0, 2, 4, 0}, {3, 1, 4, 1}, {7, 5, 1, 5}, {4, 6, 0, 5},
                                    {0, 4, 0, 2}, {1, 5, 2, 1}, {3, 7, 1, 3}, {6, 2, 0, 3}};

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
  planes_[0] = {{-1, 0, 0}, h.x};
  planes_[1] = {{1, 0, 0}, h.x};
  planes_[2] = {{0, -1, 0}, h.y};
  planes_[3] = {{0, 1, 0}, h.y};
  planes_[4] = {{0, 0, -1}, h.z};
  planes_[5] = {{0, 0, 1}, h.z};
}

Polytope BoxPolytope::view() const {
  return {x_,          y_,        z_,        8,  8,  vertices_,     planes_, 6,
          kBoxOffsets, kBoxFaces, kBoxEdges, 12, {}, inner_radius_, size_};
}

void face_polygon(const Polytope& polytope, int face, FacePolygon& out) {
  const std::uint32_t begin = polytope.face_offsets[face];
  const std::uint32_t count = polytope.face_offsets[face + 1] - begin;
  out.feature = std::uint32_t(face);
  out.normal = polytope.planes[face].normal;
  out.count = int(min(count, std::uint32_t(kMaxFaceVertices)));
  for (int i = 0; i < out.count; ++i) {
    const std::uint8_t vertex =
        polytope.face_vertices[begin + std::uint32_t(i) * count / std::uint32_t(out.count)];
    out.ids[i] = vertex;
    out.vertices[i] = polytope.vertices[vertex];
  }
}

float highest_along(const Polytope& p, Vec3 d) { return -lowest_along(p, -d); }

LowestVertex lowest_vertex(const Polytope& p, Vec3 d) {
  constexpr int kLanes = 4;  // every x86-64, 64-bit ARM and WebAssembly has registers of four
  using Floats = Wide<kLanes>;
  using Ints = WideInt<kLanes>;
  static_assert(Hull::kPad % kLanes == 0);
  const Vec3W<kLanes> direction = splat<kLanes>(d);
  const auto value_from = [&](int i) {
    return dot(Vec3W<kLanes>{Floats::load_unaligned(p.x + i), Floats::load_unaligned(p.y + i),
                             Floats::load_unaligned(p.z + i)},
               direction);
  };
  constexpr std::int32_t kOwn[kLanes] = {0, 1, 2, 3};
  Ints index = Ints::load_unaligned(kOwn), winner = index;
  Floats best = value_from(0);
  for (int i = kLanes; i < p.padded_count; i += kLanes) {
    index = index + Ints(kLanes);
    const Floats value = value_from(i);
    winner = select(value < best, index, winner);
    best = min(value, best);
  }
  int lane = 0;
  for (int k = 1; k < kLanes; ++k) {
    if (best[k] < best[lane] || (best[k] == best[lane] && winner[k] < winner[lane])) lane = k;
  }
  // The padding repeats the last vertex, behind it.
  return {min(winner[lane], p.vertex_count - 1), best[lane]};
}

}  // namespace gyre
