// Merging of flat faces, the flattest pair first. See hull_faces.h.
#include "geometry/shape/hull_faces.h"

#include "base/container/sort.h"

namespace gyre {
namespace {

constexpr int kNoFace = -1;

struct JoinEdge {
  int from, to;
  double bend;  // distance of the merged polygon's corners from its plane
};

class Joiner {
 public:
  Joiner(std::span<const DVec3> vertices, std::span<const FaceLoop> triangles, double tolerance)
      : vertices_(vertices), loops_(triangles.begin(), triangles.end()), tolerance_(tolerance) {
    face_of_.assign(256 * 256, kNoFace);
    faces_at_.assign(vertices.size(), 0);
    for (int f = 0; f < int(loops_.size()); ++f) {
      claim_edges(f);
      for (const int v : loops_[std::size_t(f)]) ++faces_at_[std::size_t(v)];
    }
  }

  void join_all();
  std::vector<FaceLoop> release_loops();

 private:
  int& face_of(int from, int to) { return face_of_[std::size_t(from * 256 + to)]; }
  DVec3 at(int vertex) const { return vertices_[std::size_t(vertex)]; }
  void claim_edges(int f);
  FaceLoop joined(int from, int to);
  double bend(const FaceLoop& loop) const;
  bool is_convex(const FaceLoop& loop, DVec3 normal) const;
  bool try_join(int from, int to);

  std::span<const DVec3> vertices_;
  std::vector<FaceLoop> loops_;  // empty once merged into another
  std::vector<int> face_of_;     // by directed edge
  std::vector<int> faces_at_;    // number of faces at a vertex
  double tolerance_;
};

void Joiner::claim_edges(int f) {
  const FaceLoop& loop = loops_[std::size_t(f)];
  for (std::size_t i = 0; i < loop.size(); ++i) face_of(loop[i], loop[(i + 1) % loop.size()]) = f;
}

// The loop around both faces of the edge: around the left one from `to` to `from`, then around the right one.
FaceLoop Joiner::joined(int from, int to) {
  FaceLoop out;
  const auto append = [&](const FaceLoop& loop, int first, int last) {
    const std::size_t n = loop.size();
    std::size_t i = 0;
    while (loop[i] != first) ++i;
    for (; loop[i % n] != last; ++i) out.push_back(loop[i % n]);
  };
  append(loops_[std::size_t(face_of(from, to))], to, from);
  append(loops_[std::size_t(face_of(to, from))], from, to);
  return out;
}

// Half the thickness of the loop along its normal; huge if it has none.
double Joiner::bend(const FaceLoop& loop) const {
  const DVec3 n = loop_normal(vertices_, loop);
  const double size = length(n);
  if (!(size > 0.0)) return 1.0e300;
  double low = 0.0, high = 0.0;
  for (const int v : loop) {
    const double height = dot(n, at(v) - at(loop[0])) / size;
    low = min(low, height);
    high = max(high, height);
  }
  return 0.5 * (high - low);
}

bool Joiner::is_convex(const FaceLoop& loop, DVec3 normal) const {
  const std::size_t n = loop.size();
  for (std::size_t i = 0; i < n; ++i) {
    const DVec3 before = at(loop[i]), corner = at(loop[(i + 1) % n]), after = at(loop[(i + 2) % n]);
    if (!(dot(cross(corner - before, after - corner), normal) > 0.0)) return false;
  }
  return true;
}

bool Joiner::try_join(int from, int to) {
  const int left = face_of(from, to), right = face_of(to, from);
  if (left == right) return false;
  // With fewer than three faces a vertex would lie on an edge.
  if (faces_at_[std::size_t(from)] < 4 || faces_at_[std::size_t(to)] < 4) return false;
  const FaceLoop loop = joined(from, to);
  bool met[256] = {};
  for (const int v : loop) {
    if (met[v]) return false;  // the two faces touch elsewhere too
    met[v] = true;
  }
  if (bend(loop) > tolerance_) return false;
  // Both faces must face the same side (the two sides of a wedge can be flat together too).
  const DVec3 n = loop_normal(vertices_, loop);
  if (!(dot(loop_normal(vertices_, loops_[std::size_t(left)]), n) > 0.0)) return false;
  if (!(dot(loop_normal(vertices_, loops_[std::size_t(right)]), n) > 0.0)) return false;
  if (!is_convex(loop, n)) return false;

  face_of(from, to) = face_of(to, from) = kNoFace;
  loops_[std::size_t(left)] = loop;
  loops_[std::size_t(right)].clear();
  claim_edges(left);
  --faces_at_[std::size_t(from)];
  --faces_at_[std::size_t(to)];
  return true;
}

void Joiner::join_all() {
  std::vector<JoinEdge> edges;
  for (int from = 0; from < int(vertices_.size()); ++from) {
    for (int to = from + 1; to < int(vertices_.size()); ++to) {
      if (face_of(from, to) == kNoFace) continue;
      const double height = bend(joined(from, to));
      if (height <= tolerance_) edges.push_back({from, to, height});
    }
  }
  std::vector<JoinEdge> scratch(edges.size());
  const auto flatter = [](const JoinEdge& a, const JoinEdge& b) { return a.bend < b.bend; };
  merge_sort(std::span<JoinEdge>(edges), std::span<JoinEdge>(scratch), flatter);
  // Other merges can make a refused one possible.
  for (bool changed = true; changed;) {
    changed = false;
    for (const JoinEdge& edge : edges) {
      if (face_of(edge.from, edge.to) != kNoFace && try_join(edge.from, edge.to)) changed = true;
    }
  }
}

std::vector<FaceLoop> Joiner::release_loops() {
  std::vector<FaceLoop> out;
  for (const FaceLoop& loop : loops_) {
    if (loop.empty()) continue;
    // The loop starts at its lowest vertex.
    std::size_t first = 0;
    for (std::size_t i = 1; i < loop.size(); ++i) first = loop[i] < loop[first] ? i : first;
    FaceLoop& rotated = out.emplace_back();
    for (std::size_t i = 0; i < loop.size(); ++i) rotated.push_back(loop[(first + i) % loop.size()]);
  }
  return out;
}

}  // namespace

DVec3 loop_normal(std::span<const DVec3> vertices, std::span<const std::uint8_t> loop) {
  // Relative to the first vertex, so that nothing cancels far from the origin.
  const DVec3 origin = vertices[loop[0]];
  DVec3 sum;
  for (std::size_t i = 1; i + 1 < loop.size(); ++i) {
    sum += cross(vertices[loop[i]] - origin, vertices[loop[i + 1]] - origin);
  }
  return sum;
}

std::vector<FaceLoop> join_flat_faces(std::span<const DVec3> vertices, std::span<const FaceLoop> triangles,
                                      double tolerance) {
  Joiner joiner(vertices, triangles, tolerance);
  joiner.join_all();
  return joiner.release_loops();
}

}  // namespace gyre
