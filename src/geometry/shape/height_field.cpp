// Triangles and blocks of a height field. See height_field.h.
#include "geometry/shape/height_field.h"

namespace gyre {
namespace {

struct Sample {
  std::uint32_t column, row;
};

// The corners of the two triangles of a cell, as offsets from its lower corner.
constexpr std::uint32_t kCornerColumn[2][3] = {{0, 0, 1}, {1, 0, 1}};
constexpr std::uint32_t kCornerRow[2][3] = {{0, 1, 0}, {0, 1, 1}};
// The cell beyond each edge, as an offset. The triangle there is always the other one of its cell.
constexpr int kBeyondColumn[2][3] = {{-1, 0, 0}, {0, 0, 1}};
constexpr int kBeyondRow[2][3] = {{0, 0, -1}, {0, 1, 0}};
// An edge is named by a sample and a direction: 0 along rows, 1 diagonal, 2 along columns.
constexpr std::uint32_t kEdgeColumn[2][3] = {{0, 0, 0}, {0, 0, 1}};
constexpr std::uint32_t kEdgeRow[2][3] = {{0, 0, 0}, {0, 1, 0}};
constexpr std::uint32_t kEdgeDirection[2][3] = {{0, 1, 2}, {1, 2, 0}};

Vec3 cell_normal(const HeightField& field, std::uint32_t column, std::uint32_t row, int half) {
  const float near_x = field.height(column + 1, row), near_z = field.height(column, row + 1);
  if (half == 0) {
    const float h = field.height(column, row);
    return normalized(Vec3{h - near_x, field.spacing, h - near_z});
  }
  const float h = field.height(column + 1, row + 1);
  return normalized(Vec3{near_z - h, field.spacing, near_x - h});
}

}  // namespace

bool is_solid_cell(const HeightField& field, std::int64_t column, std::int64_t row) {
  if (column < 0 || row < 0 || column >= std::int64_t(field.cell_columns()) ||
      row >= std::int64_t(field.cell_rows())) {
    return false;
  }
  const std::uint32_t c = std::uint32_t(column), r = std::uint32_t(row);
  // One NaN makes the sum NaN. Infinite heights are refused when cooking.
  return is_finite(field.height(c, r) + field.height(c + 1, r) + field.height(c, r + 1) +
                   field.height(c + 1, r + 1));
}

BareTriangle bare_triangle(const HeightField& field, std::uint32_t triangle) {
  const std::uint32_t cell = triangle / 2;
  const int half = int(triangle & 1);
  const std::uint32_t column = cell % field.cell_columns(), row = cell / field.cell_columns();
  BareTriangle out;
  for (int i = 0; i < 3; ++i)
    out.v[i] = field.sample(column + kCornerColumn[half][i], row + kCornerRow[half][i]);
  out.normal = cell_normal(field, column, row, half);
  return out;
}

TriangleView view_triangle(const HeightField& field, std::uint32_t triangle) {
  const std::uint32_t cell = triangle / 2;
  const int half = int(triangle & 1);
  const std::uint32_t column = cell % field.cell_columns(), row = cell / field.cell_columns();
  TriangleView view;
  view.id = triangle;
  view.normal = cell_normal(field, column, row, half);
  for (int i = 0; i < 3; ++i) {
    const std::uint32_t c = column + kCornerColumn[half][i], r = row + kCornerRow[half][i];
    view.v[i] = field.sample(c, r);
    view.corner_id[i] = r * field.columns + c;
    if ((field.flat_samples[view.corner_id[i] / 8] >> (view.corner_id[i] % 8) & 1) != 0) {
      view.flat_corners = std::uint8_t(view.flat_corners | 1 << i);
    }
    view.edge_id[i] = 3 * ((row + kEdgeRow[half][i]) * field.columns + column + kEdgeColumn[half][i]) +
                      kEdgeDirection[half][i];
  }
  for (int i = 0; i < 3; ++i) {
    const std::int64_t c = std::int64_t(column) + kBeyondColumn[half][i],
                       r = std::int64_t(row) + kBeyondRow[half][i];
    view.neighbor_normal[i] = view.normal;
    view.edge[i] = EdgeKind::open;
    if (!is_solid_cell(field, c, r)) continue;
    view.neighbor_normal[i] = cell_normal(field, std::uint32_t(c), std::uint32_t(r), 1 - half);
    view.edge[i] = classify_edge(view.normal, view.neighbor_normal[i], view.v[next_corner(i)] - view.v[i],
                                 field.flat_angle);
  }
  return view;
}

bool in_normal_cone(const HeightField& field, std::uint32_t triangle, int corner, Vec3 direction,
                    float tolerance) {
  const std::uint32_t cell = triangle / 2;
  const int half = int(triangle & 1);
  const std::uint32_t column = cell % field.cell_columns() + kCornerColumn[half][corner];
  const std::uint32_t row = cell / field.cell_columns() + kCornerRow[half][corner];
  const Vec3 apex = field.sample(column, row);
  // The samples around, in a circle, and the cell between each sample and the next.
  constexpr int kAround[6][2] = {{1, 0}, {0, 1}, {-1, 1}, {-1, 0}, {0, -1}, {1, -1}};
  constexpr int kCell[6][2] = {{0, 0}, {-1, 0}, {-1, 0}, {-1, -1}, {0, -1}, {0, -1}};
  bool solid[6];
  for (int k = 0; k < 6; ++k) {
    solid[k] = is_solid_cell(field, std::int64_t(column) + kCell[k][0], std::int64_t(row) + kCell[k][1]);
  }
  for (int k = 0; k < 6; ++k) {
    if (!solid[k] && !solid[(k + 5) % 6]) continue;
    const Vec3 along =
        field.sample(std::uint32_t(int(column) + kAround[k][0]), std::uint32_t(int(row) + kAround[k][1])) -
        apex;
    if (dot(direction, along) > tolerance * length(along)) return false;
  }
  return true;
}

Aabb block_box(const HeightField& field, HeightBlock block) {
  std::uint32_t shift = 0;
  float low = 0.0f, high = 0.0f;
  if (block.level < 0) {
    const float a = field.height(block.column, block.row), b = field.height(block.column + 1, block.row);
    const float c = field.height(block.column, block.row + 1),
                d = field.height(block.column + 1, block.row + 1);
    low = min(min(a, b), min(c, d));
    high = max(max(a, b), max(c, d));
  } else {
    const HeightField::Level& level = field.levels[std::size_t(block.level)];
    const HeightRange& range = level.blocks[std::size_t(block.row) * level.columns + block.column];
    shift = HeightField::kBlockShift + std::uint32_t(block.level);
    low = range.low;
    high = range.high;
  }
  const std::uint32_t column = block.column << shift, row = block.row << shift;
  const std::uint32_t end_column = min(column + (1u << shift), field.cell_columns());
  const std::uint32_t end_row = min(row + (1u << shift), field.cell_rows());
  return {{field.origin.x + float(column) * field.spacing, low, field.origin.z + float(row) * field.spacing},
          {field.origin.x + float(end_column) * field.spacing, high,
           field.origin.z + float(end_row) * field.spacing}};
}

std::uint32_t first_triangle(const HeightField& field, HeightBlock block) {
  const std::uint32_t shift = block.level < 0 ? 0 : HeightField::kBlockShift + std::uint32_t(block.level);
  const std::uint32_t column = block.column << shift, row = block.row << shift;
  const std::uint32_t end_column = min(column + (1u << shift), field.cell_columns());
  const std::uint32_t end_row = min(row + (1u << shift), field.cell_rows());
  for (std::uint32_t r = row; r < end_row; ++r) {
    for (std::uint32_t c = column; c < end_column; ++c) {
      if (is_solid_cell(field, c, r)) return 2 * (r * field.cell_columns() + c);
    }
  }
  return HeightField::kNoTriangle;
}

CellRange cells_under(const HeightField& field, const Aabb& box) {
  // A thousandth of a cell of slack covers the rounding of the sample positions.
  constexpr double kSlack = 1.0e-3;
  const auto cell = [&](float value, float origin, double slack) {
    return (double(value) - double(origin)) / double(field.spacing) + slack;
  };
  const double low_column = cell(box.low.x, field.origin.x, -kSlack),
               high_column = cell(box.high.x, field.origin.x, kSlack);
  const double low_row = cell(box.low.z, field.origin.z, -kSlack),
               high_row = cell(box.high.z, field.origin.z, kSlack);
  const double columns = double(field.cell_columns()), rows = double(field.cell_rows());
  if (!(high_column >= 0.0 && low_column <= columns && high_row >= 0.0 && low_row <= rows)) return {};
  CellRange range;
  range.low_column = std::uint32_t(clamp(low_column, 0.0, columns - 1.0));
  range.high_column = std::uint32_t(clamp(high_column, 0.0, columns - 1.0));
  range.low_row = std::uint32_t(clamp(low_row, 0.0, rows - 1.0));
  range.high_row = std::uint32_t(clamp(high_row, 0.0, rows - 1.0));
  return range;
}

}  // namespace gyre
