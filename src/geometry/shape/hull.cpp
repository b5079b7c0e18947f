// Searches over the columns of a hull. Plain loops over eight lanes, which a compiler vectorises. The result is that of
// a scalar search: the largest value, and the lowest index among equals.
#include "geometry/shape/hull.h"

namespace gyre {

void complete_hull(Hull& hull) {
  const std::size_t count = hull.vertices.size();
  const std::size_t padded = (count + Hull::kPad - 1) / Hull::kPad * Hull::kPad;
  hull.x.resize(padded), hull.y.resize(padded), hull.z.resize(padded);
  hull.box = {hull.vertices[0], hull.vertices[0]};
  for (std::size_t i = 0; i < padded; ++i) {
    const Vec3 v = hull.vertices[i < count ? i : count - 1];
    hull.x[i] = v.x, hull.y[i] = v.y, hull.z[i] = v.z;
    hull.box = merge(hull.box, {v, v});
  }
  const std::size_t words = std::size_t(hull.edge_words());
  hull.edges_of.assign(count * words, 0);
  for (std::size_t e = 0; e < hull.edges.size(); ++e) {
    HullEdge& edge = hull.edges[e];
    edge.direction = hull.vertices[edge.to] - hull.vertices[edge.from];
    for (const std::size_t end : {std::size_t(edge.from), std::size_t(edge.to)})
      hull.edges_of[end * words + e / 64] |= std::uint64_t(1) << (e % 64);
  }
}

int support_vertex(const Hull& hull, Vec3 direction) {
  constexpr int kLanes = Hull::kPad;
  const int count = int(hull.x.size());
  const float* x = hull.x.data();
  const float* y = hull.y.data();
  const float* z = hull.z.data();
  float best[kLanes];
  int index[kLanes];
  for (int lane = 0; lane < kLanes; ++lane) {
    best[lane] = x[lane] * direction.x + y[lane] * direction.y + z[lane] * direction.z;
    index[lane] = lane;
  }
  for (int i = kLanes; i < count; i += kLanes) {
    for (int lane = 0; lane < kLanes; ++lane) {
      const int k = i + lane;
      const float value = x[k] * direction.x + y[k] * direction.y + z[k] * direction.z;
      const bool better = value > best[lane];
      best[lane] = better ? value : best[lane];
      index[lane] = better ? k : index[lane];
    }
  }
  int winner = 0;
  for (int lane = 1; lane < kLanes; ++lane) {
    const bool better =
        best[lane] > best[winner] || (best[lane] == best[winner] && index[lane] < index[winner]);
    if (better) winner = lane;
  }
  // The padding repeats the last vertex.
  return min(index[winner], hull.vertex_count() - 1);
}

int support_face(const Hull& hull, Vec3 direction) {
  int winner = 0;
  float best = dot(hull.planes[0].normal, direction);
  for (int i = 1; i < hull.face_count(); ++i) {
    const float value = dot(hull.planes[std::size_t(i)].normal, direction);
    if (value > best) {
      best = value;
      winner = i;
    }
  }
  return winner;
}

}  // namespace gyre
