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
constexpr int kEdgeFloats = 12;  // a block of nine numbers, each column in four

// Elements of a solid with one deformation gradient each. Corners ascend within an element, so that an edge always leads from the lower particle
// to the higher. An element of fewer corners has its last corner several times, with gradients of zero.
template <int Corners>
struct alignas(64) SolidBlock {
  static constexpr int kCorners = Corners;
  static constexpr int kEdges = Corners * (Corners - 1) / 2;  // pairs of corners 01 02 ... 12 13 ...
  static constexpr int kOthers = Corners - 1;                 // corners from the second on

  std::int32_t corner[Corners][kTetLanes];
  std::int32_t edge[kEdges][kTetLanes];
  // 1/m, of the other corners: x of all, y, z; that of the first makes the sum zero.
  float gradient[3 * kOthers][kTetLanes];
  float volume[kTetLanes];  // m^3; 0 in lanes that fill up the last block
  float stiffness[kTetLanes];  // 1; 0 of tetrahedra for which a cell acts
};

using TetBlock = SolidBlock<4>;

constexpr int kCellCorners = 8;

// A tetrahedron of a cell has no energy of its own until it is pressed below this share of its volume. Then it pushes back, by this share of the shear
// modulus for each share of its volume that is missing: so a cell whose corners were turned inside out comes back (at 0.7 in place of 0.5, and at
// half or twice the stiffness, fewer do).
constexpr float kMinPartVolume = 0.5f;
constexpr float kGuardStiffness = 2.0f;

// Cells also have springs without length between all their corners, which are zero in sum at any uniform deformation.
struct alignas(64) CellBlock : SolidBlock<kCellCorners> {
  float tie[kEdges][kTetLanes];  // m, times the shear modulus: their stiffness
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
