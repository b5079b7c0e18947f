#include "soft/mesh/tetrahedron_faces.h"

#include "base/container/sort.h"

#include <gyre/math.h>

namespace gyre {

namespace {

TetrahedronFace make_face(std::span<const std::uint32_t> tetrahedra, std::uint32_t tetrahedron,
                          std::uint32_t opposite) {
  std::uint32_t v[3] = {};
  for (std::uint32_t i = 0, n = 0; i < 4; ++i)
    if (i != opposite) v[n++] = tetrahedra[4 * std::size_t(tetrahedron) + i];
  const std::uint32_t low = min(min(v[0], v[1]), v[2]), high = max(max(v[0], v[1]), v[2]);
  return {low, v[0] ^ v[1] ^ v[2] ^ low ^ high, high, tetrahedron, opposite};
}

}  // namespace

Array<TetrahedronFace> sorted_faces(std::span<const std::uint32_t> tetrahedra) {
  Array<TetrahedronFace> faces, scratch;
  for (std::uint32_t t = 0; t < tetrahedra.size() / 4; ++t) {
    for (std::uint32_t k = 0; k < 4; ++k) faces.push_back(make_face(tetrahedra, t, k));
  }
  scratch.resize(faces.size());
  merge_sort(faces.view(), scratch.view(), [](const TetrahedronFace& a, const TetrahedronFace& b) {
    return a.low != b.low ? a.low < b.low : a.middle != b.middle ? a.middle < b.middle : a.high < b.high;
  });
  return faces;
}

}  // namespace gyre
