// A cooked grid of heights. Each cell is two triangles, solid below; cells with a NaN corner are holes.
//
// In: a HeightFieldDef. Out: triangles with their neighbourhood, made on demand, and traversal of the cells near a box
// by a pyramid of height ranges. The sample (column, row) is at x = (column - (columns - 1) / 2) * spacing, z = (row -
// (rows - 1) / 2) * spacing. The diagonal of a cell joins (column, row + 1) and (column + 1, row). With cell = row *
// (columns - 1) + column, triangle 2 * cell is at (column, row), and triangle 2 * cell + 1 is beyond the diagonal.
//
// Source of the pyramid: "maximum mipmaps" for displaced surfaces, A. Tevs, I. Ihrke, H.-P. Seidel, 2008.
#pragma once

#include "geometry/shape/triangle.h"

#include <cstdint>
#include <vector>

namespace gyre {

struct HeightRange {
  float low, high;     // low > high if all cells are holes
  std::uint32_t flat;  // not 0: all triangles of the block, and all that touch them, lie in one plane
};

struct HeightField {
  // A block of the finest level spans 2^kBlockShift cells along each axis; the size doubles with each level.
  static constexpr std::uint32_t kBlockShift = 2;
  static constexpr std::uint32_t kNoTriangle = 0xffffffffu;

  struct Level {
    std::uint32_t columns = 0, rows = 0;
    std::vector<HeightRange> blocks;  // row by row
  };

  std::vector<float> heights;  // row by row; NaN in holes
  std::uint32_t columns = 0;   // samples
  std::uint32_t rows = 0;
  float spacing = 1.0f;
  Vec3 origin;              // of sample (0, 0), at height 0
  float flat_angle = 0.0f;  // rad, the angle that rounding of the heights can give to one plane
  // one bit for each sample: the six triangles around it lie in one plane
  std::vector<std::uint8_t> flat_samples;
  Aabb box;
  std::vector<Level> levels;  // from fine to coarse; the last has one block

  std::uint32_t cell_columns() const { return columns - 1; }
  std::uint32_t cell_rows() const { return rows - 1; }
  float height(std::uint32_t column, std::uint32_t row) const {
    return heights[std::size_t(row) * columns + column];
  }
  Vec3 sample(std::uint32_t column, std::uint32_t row) const {
    return {origin.x + float(column) * spacing, height(column, row), origin.z + float(row) * spacing};
  }
};

// True if the cell exists and is no hole.
bool is_solid_cell(const HeightField& field, std::int64_t column, std::int64_t row);
// A triangle by itself, and with its neighbourhood, in the field's frame. Its cell must not be a hole.
BareTriangle bare_triangle(const HeightField& field, std::uint32_t triangle);
TriangleView view_triangle(const HeightField& field, std::uint32_t triangle);
// As for a mesh: true if no edge at this corner of the triangle climbs along `direction` (unit) by more than the sine
// `tolerance`.
bool in_normal_cone(const HeightField& field, std::uint32_t triangle, int corner, Vec3 direction,
                    float tolerance);

// A block of cells; level -1 is a single cell.
struct HeightBlock {
  int level;
  std::uint32_t column, row;
};
// The box of a block, its first triangle that is no hole (kNoTriangle: none), and whether it is flat.
Aabb block_box(const HeightField& field, HeightBlock block);
std::uint32_t first_triangle(const HeightField& field, HeightBlock block);
inline bool is_flat(const HeightField& field, HeightBlock block) {
  if (block.level < 0) return false;
  const HeightField::Level& level = field.levels[std::size_t(block.level)];
  return level.blocks[std::size_t(block.row) * level.columns + block.column].flat != 0;
}

// Calls visit(column, row) for each cell whose box may overlap `box`, in a fixed order (block by block, not row by
// row). Calls enter(block) before each block, and skips the block if that returns false. enter is not called for single
// cells.
template <class Enter, class Visit>
void walk_cells(const HeightField& field, const Aabb& box, Enter&& enter, Visit&& visit);

// The rectangle of cells below and above a box, clamped to the field; empty if low > high.
struct CellRange {
  std::uint32_t low_column = 1, high_column = 0, low_row = 1, high_row = 0;
  constexpr bool empty() const { return low_column > high_column || low_row > high_row; }
};
CellRange cells_under(const HeightField& field, const Aabb& box);

template <class Enter, class Visit>
void walk_cells(const HeightField& field, const Aabb& box, Enter&& enter, Visit&& visit) {
  const CellRange range = cells_under(field, box);
  if (range.empty()) return;
  // Four children for each block and at most 32 levels: three wait on each level.
  HeightBlock stack[3 * 32 + 4];
  int depth = 0;
  stack[depth++] = {int(field.levels.size()) - 1, 0, 0};
  while (depth > 0) {
    const HeightBlock block = stack[--depth];
    const HeightField::Level& level = field.levels[std::size_t(block.level)];
    const HeightRange& heights = level.blocks[std::size_t(block.row) * level.columns + block.column];
    const std::uint32_t shift = HeightField::kBlockShift + std::uint32_t(block.level);
    const std::uint32_t column = block.column << shift, row = block.row << shift;
    const std::uint32_t last_column = column + ((1u << shift) - 1), last_row = row + ((1u << shift) - 1);
    if (column > range.high_column || last_column < range.low_column) continue;
    if (row > range.high_row || last_row < range.low_row) continue;
    if (!(heights.low <= box.high.y && box.low.y <= heights.high) || !enter(block)) continue;
    if (block.level == 0) {
      for (std::uint32_t r = max(row, range.low_row); r <= min(last_row, range.high_row); ++r) {
        for (std::uint32_t c = max(column, range.low_column); c <= min(last_column, range.high_column); ++c)
          visit(c, r);
      }
      continue;
    }
    const HeightField::Level& finer = field.levels[std::size_t(block.level) - 1];
    for (int k = 3; k >= 0; --k) {
      const HeightBlock child{block.level - 1, 2 * block.column + std::uint32_t(k & 1),
                              2 * block.row + std::uint32_t(k >> 1)};
      if (child.column < finer.columns && child.row < finer.rows) stack[depth++] = child;
    }
  }
}

}  // namespace gyre
