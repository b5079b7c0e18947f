#include "soft/elements/crack_gap.h"

#include "base/container/sort.h"

#include <cmath>

namespace gyre {

namespace {

constexpr int kSweeps = 64;
constexpr double kMinGap = 0.9;  // of the gap: what sweeps must have reached
constexpr double kMaxMove = 1.5;  // gaps: a part that would go farther grips another one

// A face of a tetrahedron, to be sorted by the roots of its corners.
struct Side {
  std::uint32_t root[3] = {}, vertex[3] = {};  // ascending by root
  std::uint32_t opposite = 0;                  // the root of the corner that is not in it
};

Side make_side(std::span<const std::uint32_t> corners, std::span<const std::uint32_t> roots,
               std::uint32_t element, std::uint32_t opposite) {
  Side side;
  side.opposite = roots[corners[4 * element + opposite]];
  std::uint32_t count = 0;
  for (std::uint32_t k = 0; k < 4; ++k) {
    if (k == opposite) continue;
    const std::uint32_t v = corners[4 * element + k];
    std::uint32_t at = count++;
    for (; at > 0 && side.root[at - 1] > roots[v]; --at)
      side.root[at] = side.root[at - 1], side.vertex[at] = side.vertex[at - 1];
    side.root[at] = roots[v], side.vertex[at] = v;
  }
  return side;
}

}  // namespace

void list_crack_faces(std::span<const std::uint32_t> corners, std::span<const std::uint32_t> roots,
                      std::span<const DVec3> whole, Array<CrackFace>& faces) {
  Array<Side> sides, scratch;
  for (std::uint32_t t = 0; t < corners.size() / 4; ++t)
    for (std::uint32_t k = 0; k < 4; ++k) sides.push_back(make_side(corners, roots, t, k));
  scratch.resize(sides.size());
  merge_sort(sides.view(), scratch.view(), [](const Side& a, const Side& b) {
    for (int k = 0; k < 3; ++k)
      if (a.root[k] != b.root[k]) return a.root[k] < b.root[k];
    return false;
  });
  faces.clear();
  for (std::size_t i = 0; i + 1 < sides.size(); ++i) {
    const Side &a = sides[i], &b = sides[i + 1];
    if (a.root[0] != b.root[0] || a.root[1] != b.root[1] || a.root[2] != b.root[2]) continue;
    const DVec3 origin = whole[a.root[0]];
    const DVec3 area = cross(whole[a.root[1]] - origin, whole[a.root[2]] - origin);
    const double size = dot(area, whole[a.opposite] - origin) < 0.0 ? -length(area) : length(area);
    for (int k = 0; k < 3; ++k) {
      if (a.vertex[k] != b.vertex[k])
        faces.push_back({a.root[k], a.vertex[k], b.vertex[k], (1.0 / size) * area});
    }
  }
  Array<CrackFace> more;
  more.resize(faces.size());
  merge_sort(faces.view(), more.view(),
             [](const CrackFace& a, const CrackFace& b) { return a.root < b.root; });
}

bool separate_parts(std::span<const CrackFace> faces, std::span<const double> volume,
                    std::span<DVec3> moves) {
  Array<double> push;
  push.resize(faces.size());
  for (int sweep = 0; sweep < kSweeps; ++sweep) {
    for (std::size_t i = 0; i < faces.size(); ++i) {
      const CrackFace& face = faces[i];
      const double a = 1.0 / volume[face.a], b = 1.0 / volume[face.b];
      const double now = dot(moves[face.a] - moves[face.b], face.normal);
      const double next = max(0.0, push[i] + (1.0 - now) / (a + b)), change = next - push[i];
      push[i] = next;
      moves[face.a] += (change * a) * face.normal;
      moves[face.b] += -(change * b) * face.normal;
    }
  }
  bool fits = true;
  for (const CrackFace& face : faces) {
    fits = fits && dot(moves[face.a] - moves[face.b], face.normal) >= kMinGap &&
           length_squared(moves[face.a]) <= square(kMaxMove) &&
           length_squared(moves[face.b]) <= square(kMaxMove);
  }
  return fits;
}

void open_cracks(std::span<const std::uint32_t> corners, std::span<const std::uint32_t> roots, double gap,
                 std::span<DVec3> places) {
  const std::size_t count = roots.size();
  Array<double> volume;
  Array<DVec3> moves;
  volume.resize(count), moves.resize(count);
  for (std::size_t k = 0; k + 3 < corners.size(); k += 4) {
    const DVec3 origin = places[corners[k]];
    const double size = absolute(dot(cross(places[corners[k + 1]] - origin, places[corners[k + 2]] - origin),
                                     places[corners[k + 3]] - origin));
    for (std::size_t n = k; n < k + 4; ++n) volume[corners[n]] += size;
  }
  Array<CrackFace> faces;
  // The first vertices are the roots.
  list_crack_faces(corners, roots, places, faces);
  for (std::size_t begin = 0, end = 0; begin < faces.size(); begin = end) {
    while (end < faces.size() && faces[end].root == faces[begin].root) ++end;
    separate_parts(faces.view().subspan(begin, end - begin), volume.view(), {moves.data(), count});
  }
  for (std::size_t v = 0; v < count; ++v) places[v] += gap * moves[v];
}

}  // namespace gyre
