// cook_height_field: makes a HeightField from a definition, or reports why it cannot.
#include "base/float_mode.h"
#include "base/hash.h"
#include "geometry/shape/cooked.h"
#include "geometry/shape/height_field.h"

namespace gyre {
namespace {

constexpr std::uint64_t kMaxSamples = 1u << 28;
// The error of a plane after rounding, relative to the largest height: a few units in the last place.
constexpr float kFlatTolerance = 4.0e-7f;

Error check_field(const HeightFieldDef& def) {
  if (def.columns < 2 || def.rows < 2) {
    return make_error(ErrorCode::invalid_geometry,
                      "height field: %u columns and %u rows; both must be at least 2", def.columns, def.rows);
  }
  const std::uint64_t samples = std::uint64_t(def.columns) * def.rows;
  if (samples > kMaxSamples) {
    return make_error(ErrorCode::invalid_geometry,
                      "height field: %u columns and %u rows; at most %llu samples are allowed", def.columns,
                      def.rows, static_cast<unsigned long long>(kMaxSamples));
  }
  if (def.heights.size() != samples) {
    return make_error(ErrorCode::invalid_geometry,
                      "height field: %zu heights for %u columns and %u rows; needs %llu", def.heights.size(),
                      def.columns, def.rows, static_cast<unsigned long long>(samples));
  }
  const float extent = def.spacing * float(max(def.columns, def.rows));
  if (!(def.spacing > 0.0f) || !(extent <= kMaxSurfaceCoordinate)) {
    return make_error(ErrorCode::invalid_geometry,
                      "height field: spacing is %g m; must be positive and span at most %g m",
                      double(def.spacing), double(kMaxSurfaceCoordinate));
  }
  for (std::size_t i = 0; i < def.heights.size(); ++i) {
    const float h = def.heights[i];
    if (h != h || absolute(h) <= kMaxSurfaceCoordinate) continue;
    return make_error(
        ErrorCode::invalid_geometry,
        "height field: the height at column %zu, row %zu is %g m; allowed is up to %g m, or NaN for a hole",
        i % def.columns, i / def.columns, double(h), double(kMaxSurfaceCoordinate));
  }
  return {};
}

// True if the samples of a rectangle (corners included) exist and lie in one plane. Tests every `step`-th sample.
bool is_plane(const HeightField& field, const CellRange& samples, std::uint32_t step, float tolerance) {
  const double h = double(field.height(samples.low_column, samples.low_row));
  const double width = double(samples.high_column - samples.low_column),
               depth = double(samples.high_row - samples.low_row);
  const double slope_x = (double(field.height(samples.high_column, samples.low_row)) - h) / width;
  const double slope_z = (double(field.height(samples.low_column, samples.high_row)) - h) / depth;
  for (std::uint32_t r = samples.low_row; r <= samples.high_row; r += step) {
    for (std::uint32_t c = samples.low_column; c <= samples.high_column; c += step) {
      const double plane =
          h + slope_x * double(c - samples.low_column) + slope_z * double(r - samples.low_row);
      // NaN fails too.
      if (!(absolute(double(field.height(c, r)) - plane) <= double(tolerance))) return false;
    }
  }
  return true;
}

HeightRange finest_range(const HeightField& field, std::uint32_t block_column, std::uint32_t block_row,
                         float tolerance) {
  const std::uint32_t size = 1u << HeightField::kBlockShift;
  const std::uint32_t column = block_column * size, row = block_row * size;
  const std::uint32_t end_column = min(column + size, field.cell_columns()),
                      end_row = min(row + size, field.cell_rows());
  HeightRange range{__builtin_huge_valf(), -__builtin_huge_valf(), 0};
  for (std::uint32_t r = row; r < end_row; ++r) {
    for (std::uint32_t c = column; c < end_column; ++c) {
      if (!is_solid_cell(field, c, r)) continue;
      const Aabb box = block_box(field, {-1, c, r});
      range.low = min(range.low, box.low.y);
      range.high = max(range.high, box.high.y);
    }
  }
  // The triangles that touch the block are in one more ring of cells, which must exist.
  if (column > 0 && row > 0 && column + size < field.cell_columns() && row + size < field.cell_rows()) {
    const CellRange samples{column - 1, column + size + 1, row - 1, row + size + 1};
    range.flat = is_plane(field, samples, 1, tolerance) ? 1 : 0;
  }
  return range;
}

// Merges four blocks. The result is flat if all four are and their corners lie in one plane too.
HeightRange merged_range(const HeightField& field, const HeightField::Level& finer, std::uint32_t column,
                         std::uint32_t row, std::uint32_t cells, float tolerance) {
  HeightRange range{__builtin_huge_valf(), -__builtin_huge_valf(), 1};
  for (std::uint32_t k = 0; k < 4; ++k) {
    const std::uint32_t c = 2 * column + (k & 1), r = 2 * row + (k >> 1);
    if (c >= finer.columns || r >= finer.rows) {
      range.flat = 0;
      continue;
    }
    const HeightRange& child = finer.blocks[std::size_t(r) * finer.columns + c];
    range.low = min(range.low, child.low);
    range.high = max(range.high, child.high);
    range.flat &= child.flat;
  }
  if (range.flat != 0) {
    const CellRange samples{column * cells, (column + 1) * cells, row * cells, (row + 1) * cells};
    range.flat = is_plane(field, samples, cells / 2, tolerance) ? 1 : 0;
  }
  return range;
}

void build_levels(HeightField& field, float tolerance) {
  const std::uint32_t size = 1u << HeightField::kBlockShift;
  HeightField::Level level;
  level.columns = (field.cell_columns() + size - 1) / size;
  level.rows = (field.cell_rows() + size - 1) / size;
  for (std::uint32_t r = 0; r < level.rows; ++r) {
    for (std::uint32_t c = 0; c < level.columns; ++c)
      level.blocks.push_back(finest_range(field, c, r, tolerance));
  }
  field.levels.push_back(std::move(level));
  for (std::uint32_t cells = 2 * size; field.levels.back().blocks.size() > 1; cells *= 2) {
    const HeightField::Level& finer = field.levels.back();
    HeightField::Level next;
    next.columns = (finer.columns + 1) / 2;
    next.rows = (finer.rows + 1) / 2;
    for (std::uint32_t r = 0; r < next.rows; ++r) {
      for (std::uint32_t c = 0; c < next.columns; ++c) {
        next.blocks.push_back(merged_range(field, finer, c, r, cells, tolerance));
      }
    }
    field.levels.push_back(std::move(next));
  }
}

void mark_flat_samples(HeightField& field) {
  field.flat_samples.assign((field.heights.size() + 7) / 8, 0);
  for (std::uint32_t r = 1; r + 1 < field.rows; ++r) {
    for (std::uint32_t c = 1; c + 1 < field.columns; ++c) {
      bool flat = true;
      for (std::uint32_t k = 0; k < 4; ++k)
        flat = flat && is_solid_cell(field, c - 1 + (k & 1), r - 1 + (k >> 1));
      if (!flat) continue;
      // The six triangles around: both of two cells, one of the other two.
      const std::uint32_t cells = field.cell_columns(), cell = r * cells + c;
      const std::uint32_t around[6] = {
          2 * cell,           2 * (cell - 1),         2 * (cell - 1) + 1,
          2 * (cell - cells), 2 * (cell - cells) + 1, 2 * (cell - cells - 1) + 1};
      const Vec3 normal = view_triangle(field, around[0]).normal;
      for (int k = 1; k < 6 && flat; ++k) {
        const Vec3 change = view_triangle(field, around[k]).normal - normal;
        flat = length_squared(change) <= field.flat_angle * field.flat_angle;
      }
      const std::size_t sample = std::size_t(r) * field.columns + c;
      if (flat)
        field.flat_samples[sample / 8] = std::uint8_t(field.flat_samples[sample / 8] | 1u << (sample % 8));
    }
  }
}

std::uint64_t hash_field(const HeightField& field) {
  Hasher hasher{std::uint64_t(ShapeKind::height_field)};
  hasher.add(std::uint64_t(field.columns) << 32 | field.rows);
  hasher.add(std::as_bytes(std::span<const float>(&field.spacing, 1)));
  hasher.add(std::as_bytes(std::span<const float>(field.heights)));
  return hasher.value();
}

}  // namespace

Result<Geometry> cook_height_field(const HeightFieldDef& def) {
  const FloatMode mode;
  if (const Error error = check_field(def)) return error;
  auto field = std::make_unique<HeightField>();
  field->columns = def.columns;
  field->rows = def.rows;
  field->spacing = def.spacing;
  field->origin = {-0.5f * float(def.columns - 1) * def.spacing, 0.0f,
                   -0.5f * float(def.rows - 1) * def.spacing};
  field->heights.reserve(def.heights.size());
  float highest = 0.0f;
  for (const float h : def.heights) {
    // All holes get the same NaN, so that equal fields have equal hashes.
    field->heights.push_back(h == h ? h : __builtin_nanf(""));
    if (h == h) highest = max(highest, absolute(h));
  }
  const float tolerance = kFlatTolerance * highest;
  field->flat_angle = 1.0e-6f + tolerance / def.spacing;
  build_levels(*field, tolerance);
  const HeightRange& range = field->levels.back().blocks[0];
  if (range.low > range.high) {
    return make_error(ErrorCode::invalid_geometry, "height field: all of its %u x %u cells are holes",
                      def.columns - 1, def.rows - 1);
  }
  mark_flat_samples(*field);
  const Vec3 far_corner{field->origin.x + float(def.columns - 1) * def.spacing, range.high,
                        field->origin.z + float(def.rows - 1) * def.spacing};
  field->box = {{field->origin.x, range.low, field->origin.z}, far_corner};
  auto cooked = std::make_shared<CookedGeometry>();
  cooked->kind = ShapeKind::height_field;
  cooked->content_hash = hash_field(*field);
  cooked->field = std::move(field);
  return Geometry(std::shared_ptr<const CookedGeometry>(std::move(cooked)));
}

}  // namespace gyre
