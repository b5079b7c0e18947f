// Plain data that the kernels of soft bodies work on: slots of a sparse matrix (soft/body/sliced_rows.h) and blocks of elements
// (soft/body/continuum.h). Nothing here has functions of its own, since kernels are compiled once for each kind of processor.
#pragma once

#include <cstdint>

namespace gyre {

constexpr int kSliceRows = 16;

constexpr int padded_rows(int count) { return (count + kSliceRows - 1) / kSliceRows * kSliceRows; }

struct RowSlot {
  std::int32_t offset = 0;    // the column of row i is i + offset, if
  std::int32_t columns = -1;  // this is negative; else 16 columns begin here in SlicedRows::columns
};

enum class ElementModel : std::uint8_t { linear, corotated, neo_hookean };

constexpr int kTetLanes = 16;
constexpr int kTetEdges = 6;     // pairs of corners 01 02 03 12 13 23
constexpr int kEdgeFloats = 12;  // a block of nine numbers, each column in four

// Corners ascend within a tetrahedron, so that an edge always leads from the lower particle to the higher.
struct alignas(64) TetBlock {
  std::int32_t corner[4][kTetLanes];
  std::int32_t edge[kTetEdges][kTetLanes];
  float inverse[9][kTetLanes];  // Dm^-1 by columns, 1/m
  float volume[kTetLanes];      // m^3; 0 in lanes that fill up the last block
};

struct alignas(64) TriangleBlock {
  std::int32_t corner[3][kTetLanes];
  std::int32_t edge[3][kTetLanes];  // 01 02 12
  float inverse[4][kTetLanes];      // Dm^-1 by columns, 1/m
  float area[kTetLanes];            // m^2; 0 in lanes that fill up the last block
};

// The constants that the laws of the elements need.
struct ElementMaterial {
  ElementModel model = ElementModel::corotated;
  float mu = 0.0f, lambda = 0.0f;                          // Pa, of tetrahedra
  float stretch = 0.0f, contraction = 0.0f, shear = 0.0f;  // N/m, of triangles: c, c' and g
};

}  // namespace gyre
