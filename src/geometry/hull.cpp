// Searches over a hull's columns. Eight lanes of plain loops that a compiler turns into wide instructions; the answer is
// that of a search one by one: the greatest value, and the lowest index among equals.
#include "geometry/hull.h"

namespace gyre {

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
  // The padding repeats the last vertex, behind it.
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
