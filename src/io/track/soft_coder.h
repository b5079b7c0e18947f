// Vertices of ropes, cloths and solids as whole numbers, in few bits. Shared by writer and reader, so that they cannot disagree.
//
//   number of bodies of soft matter, then for each, by ascending index: the gap from the last index, how its vertices are stored
//     put: generation, surface, each vertex as its difference from the vertex before
//     still: nothing; all vertices keep their place
//     inertia: each vertex as its difference from its last displacement, done again
//     neighbour: the same, with the difference of the vertex before added: neighbours are accelerated alike
//
// A body that is not listed is gone. A keyframe puts every body. Coordinates are rounded as positions of poses are (pose_codec.h), and
// coded with the same Rice code; its parameter follows the sizes of the last differences along the vertices, for each coordinate.
#pragma once

#include "io/track/pose_codec.h"

#include <array>
#include <vector>

namespace gyre {

using RoundedVertex = std::array<std::int64_t, 3>;

enum class VertexCoding : std::uint8_t { put, still, inertia, neighbor };

struct TrackedSoft {
  std::uint32_t index = 0;
  std::uint16_t generation = 0;
  std::uint32_t surface = 0;
  std::vector<RoundedVertex> now, before;  // of the last two frames
  std::int64_t sizes[3] = {-1, -1, -1};    // of the last differences, in sixteenths; -1: there was none
};

template <class Bits>
void code_soft_head(Bits& bits, std::uint64_t& gap, VertexCoding& coding) {
  code_count(bits, gap, 0);
  auto number = std::uint64_t(coding);
  bits.code_bits(number, 2);
  coding = VertexCoding(number);
}

template <class Bits>
void code_soft_put(Bits& bits, TrackedSoft& soft) {
  std::uint64_t generation = soft.generation, surface = soft.surface;
  bits.code_bits(generation, 16);
  code_count(bits, surface, 2);
  soft.generation = std::uint16_t(generation);
  soft.surface = surface > 0xffffffffu ? 0xffffffffu : std::uint32_t(surface);
}

// The vertex that is expected: `error` is the difference of the vertex before from its expectation by inertia.
inline RoundedVertex predict_vertex(const TrackedSoft& soft, std::size_t i, const RoundedVertex& error) {
  RoundedVertex expected;
  for (std::size_t k = 0; k < 3; ++k) expected[k] = 2 * soft.now[i][k] - soft.before[i][k] + error[k];
  return expected;
}

// Codes one vertex against its expectation. False if it is out of range, which only a reader meets.
template <class Bits>
bool code_vertex(Bits& bits, RoundedVertex& vertex, const RoundedVertex& expected, TrackedSoft& soft) {
  bool good = true;
  for (std::size_t k = 0; k < 3; ++k) {
    std::int64_t difference = vertex[k] - expected[k];
    code_difference(bits, difference, soft.sizes[k]);
    vertex[k] = expected[k] + difference;
    good = good && vertex[k] <= kMaxPosition && vertex[k] >= -kMaxPosition;
  }
  return good && !bits.failed();
}

// Codes all vertices; `next` has as many as the body. With put the history begins with them, at rest. False as above.
template <class Bits>
bool code_vertices(Bits& bits, VertexCoding coding, std::vector<RoundedVertex>& next, TrackedSoft& soft) {
  RoundedVertex last{}, error{};
  for (std::size_t i = 0; i < next.size(); ++i) {
    const bool put = coding == VertexCoding::put;
    const RoundedVertex inert = put ? last : predict_vertex(soft, i, {});
    RoundedVertex expected = inert;
    if (coding == VertexCoding::neighbor)
      for (std::size_t k = 0; k < 3; ++k) expected[k] += error[k];
    if (!code_vertex(bits, next[i], expected, soft)) return false;
    for (std::size_t k = 0; k < 3; ++k) error[k] = next[i][k] - inert[k];
    last = next[i];
  }
  if (coding == VertexCoding::put) {
    soft.before = next;
  } else {
    soft.before.swap(soft.now);
  }
  soft.now.swap(next);
  return true;
}

// Vertices keep their place: their displacement is zero from then on.
inline void keep_vertices(TrackedSoft& soft) { soft.before = soft.now; }

// Decodes the bits of a frame into `softs`, which must be those of the frame before (none for a keyframe). `vertex_counts` are those of
// the surfaces. False if the bits are invalid; `softs` is then unusable.
bool decode_softs(std::span<const std::byte> bytes, std::span<const std::uint32_t> vertex_counts,
                  std::vector<TrackedSoft>& softs);

}  // namespace gyre
