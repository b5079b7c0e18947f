// Sums of a block of elements to forces and to the blocks of edges: they are found W lanes at a time, and added one lane after the other, since
// lanes may share particles and edges.
#pragma once

#include "math/wide_vec.h"
#include "soft/body/element_blocks.h"

namespace gyre {
inline namespace GYRE_TARGET_NAMESPACE {

// By lane: forces as records of four floats, blocks as records of kEdgeFloats, whose last float of each four is zero.
template <int Forces, int Edges>
struct ElementSums {
  alignas(64) float force[Forces][kTetLanes][4];
  alignas(64) float block[Edges][kTetLanes][kEdgeFloats];
};

// Writes W lanes from `lane` on.
template <int W, int Floats>
GYRE_INLINE void put_columns(float (*records)[Floats], int lane, int first, Vec3W<W> column) {
  float* record[W];
  GYRE_UNROLL
  for (int i = 0; i < W; ++i) record[i] = records[lane + i];
  const Wide<W> parts[4] = {column.x, column.y, column.z, Wide<W>(0.0f)};
  scatter_columns<4, W>(record, first, parts);
}
template <int W>
GYRE_INLINE void put_block(float (*records)[kEdgeFloats], int lane, const Mat3W<W>& block) {
  put_columns(records, lane, 0, block.x);
  put_columns(records, lane, 4, block.y);
  put_columns(records, lane, 8, block.z);
}

// Four floats that stand together, in registers of four where there are any.
template <int W>
struct FourFloats {
  Wide<4> v;
  static GYRE_INLINE FourFloats load(const float* from) { return {Wide<4>::load(from)}; }
  GYRE_INLINE void store(float* to) const { v.store(to); }
  friend GYRE_INLINE FourFloats operator+(FourFloats a, FourFloats b) { return {a.v + b.v}; }
  friend GYRE_INLINE FourFloats operator-(FourFloats a, FourFloats b) { return {a.v - b.v}; }
};
template <>
struct FourFloats<1> {
  float v[4];
  static GYRE_INLINE FourFloats load(const float* from) { return {{from[0], from[1], from[2], from[3]}}; }
  GYRE_INLINE void store(float* to) const {
    for (int k = 0; k < 4; ++k) to[k] = v[k];
  }
  friend GYRE_INLINE FourFloats operator+(FourFloats a, FourFloats b) {
    return {{a.v[0] + b.v[0], a.v[1] + b.v[1], a.v[2] + b.v[2], a.v[3] + b.v[3]}};
  }
  friend GYRE_INLINE FourFloats operator-(FourFloats a, FourFloats b) {
    return {{a.v[0] - b.v[0], a.v[1] - b.v[1], a.v[2] - b.v[2], a.v[3] - b.v[3]}};
  }
};

// Adds one lane of an element: the forces on its corners from the second on, of which the first has what is missing to zero, and the blocks
// of its edges.
template <int W, bool WithBlocks, int Forces, int Edges, class Block>
GYRE_INLINE void add_lane(float* corner_force, float* edge_blocks, const Block& block,
                          const ElementSums<Forces, Edges>& sums, int lane) {
  using Four = FourFloats<W>;
  float* const first = corner_force + 4 * std::int64_t(block.corner[0][lane]);
  Four rest = Four::load(first);
  GYRE_UNROLL
  for (int a = 0; a < Forces; ++a) {
    float* const to = corner_force + 4 * std::int64_t(block.corner[a + 1][lane]);
    const Four force = Four::load(sums.force[a][lane]);
    (Four::load(to) + force).store(to);
    rest = rest - force;
  }
  rest.store(first);
  if constexpr (WithBlocks) {
    GYRE_UNROLL
    for (int e = 0; e < Edges; ++e) {
      float* const to = edge_blocks + kEdgeFloats * std::int64_t(block.edge[e][lane]);
      GYRE_UNROLL
      for (int k = 0; k < kEdgeFloats; k += 4)
        (Four::load(to + k) + Four::load(sums.block[e][lane] + k)).store(to + k);
    }
  }
}

}  // namespace GYRE_TARGET_NAMESPACE
}  // namespace gyre
