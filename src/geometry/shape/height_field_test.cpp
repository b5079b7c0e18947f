// Cooked height fields: refused input, holes, borders, and the traversal of cells against brute force.
#include "geometry/shape/height_field.h"

#include "geometry/shape/cooked.h"
#include "geometry/testing/mesh_test_scenes.h"

#include <gtest/gtest.h>

#include <cmath>
#include <cstring>
#include <set>

namespace gyre::height_field_test {
namespace {

using test::Random;

Geometry cook(const std::vector<float>& heights, std::uint32_t columns, std::uint32_t rows,
              float spacing = 1.0f) {
  const Result<Geometry> made =
      cook_height_field({.heights = heights, .columns = columns, .rows = rows, .spacing = spacing});
  EXPECT_TRUE(made.has_value()) << made.error().message;
  return made ? *made : Geometry();
}
const HeightField& field_of(const Geometry& geometry) { return *geometry.data()->field; }

// B-13: these, the smallest, and holes below.
TEST(CookHeightField, RefusesBadData) {
  const std::vector<float> heights(12, 0.0f);
  const auto refused = [&](HeightFieldDef def, const char* word) {
    const Result<Geometry> made = cook_height_field(def);
    EXPECT_FALSE(made.has_value());
    EXPECT_EQ(made.error().code, ErrorCode::invalid_geometry);
    EXPECT_NE(std::strstr(made.error().message, word), nullptr) << made.error().message;
  };
  refused({.heights = heights, .columns = 1, .rows = 12}, "at least 2");
  refused({.heights = heights, .columns = 12, .rows = 1}, "at least 2");
  refused({.heights = heights, .columns = 0, .rows = 0}, "at least 2");
  refused({.heights = heights, .columns = 4, .rows = 4}, "needs 16");
  refused({.heights = heights, .columns = 100000, .rows = 100000}, "samples");
  refused({.heights = heights, .columns = 4, .rows = 3, .spacing = 0.0f}, "spacing");
  refused({.heights = heights, .columns = 4, .rows = 3, .spacing = -1.0f}, "spacing");
  refused({.heights = heights, .columns = 4, .rows = 3, .spacing = std::nanf("")}, "spacing");
  refused({.heights = heights, .columns = 4, .rows = 3, .spacing = HUGE_VALF}, "spacing");
  std::vector<float> infinite = heights;
  infinite[6] = -HUGE_VALF;
  refused({.heights = infinite, .columns = 4, .rows = 3}, "column 2, row 1");
  std::vector<float> holes = heights;
  for (std::size_t i = 0; i < holes.size(); i += 2) holes[i] = std::nanf("");
  refused({.heights = holes, .columns = 4, .rows = 3}, "holes");
}

TEST(CookHeightField, TheSmallestHasTwoTriangles) {
  const Geometry geometry = cook({0.0f, 1.0f, 2.0f, 3.0f}, 2, 2, 2.0f);
  const HeightField& field = field_of(geometry);
  const TriangleView low = view_triangle(field, 0), high = view_triangle(field, 1);
  EXPECT_EQ(low.v[0], (Vec3{-1, 0, -1}));
  EXPECT_EQ(low.v[1], (Vec3{-1, 2, 1}));
  EXPECT_EQ(low.v[2], (Vec3{1, 1, -1}));
  EXPECT_EQ(high.v[2], (Vec3{1, 3, 1}));
  EXPECT_EQ(field.box.low, (Vec3{-1, 0, -1}));
  EXPECT_EQ(field.box.high, (Vec3{1, 3, 1}));
  for (const TriangleView& t : {low, high}) {
    EXPECT_LT(length(t.normal - triangle_normal(t.v[0], t.v[1], t.v[2])), 1.0e-6f);
  }
  EXPECT_EQ(low.edge[1], EdgeKind::flat);
  EXPECT_EQ(low.edge[0], EdgeKind::open);
  EXPECT_EQ(high.edge[2], EdgeKind::open);
}

// The same ground as a mesh has the same edges.
TEST(HeightField, AgreesWithTheSameGroundAsAMesh) {
  Random random{9};
  const int n = 9;
  std::vector<float> heights;
  for (int i = 0; i < n * n; ++i) heights.push_back(std::floor(random.between(0.0f, 3.0f)) * 0.25f);
  const Geometry geometry = cook(heights, n, n, 0.5f);
  const HeightField& field = field_of(geometry);
  int flat = 0, convex = 0, concave = 0;
  for (std::uint32_t cell = 0; cell < 64; ++cell) {
    for (std::uint32_t half = 0; half < 2; ++half) {
      const TriangleView t = view_triangle(field, 2 * cell + half);
      EXPECT_LT(length(t.normal - triangle_normal(t.v[0], t.v[1], t.v[2])), 1.0e-6f);
      for (int i = 0; i < 3; ++i) {
        if (t.edge[i] == EdgeKind::open) continue;
        // Look for the neighbour by its name.
        for (std::uint32_t other = 0; other < 128; ++other) {
          if (other == t.id) continue;
          const TriangleView o = view_triangle(field, other);
          for (int k = 0; k < 3; ++k) {
            if (o.edge_id[k] != t.edge_id[i]) continue;
            EXPECT_EQ(o.v[k], t.v[next_corner(i)]);
            EXPECT_EQ(o.v[next_corner(k)], t.v[i]);
            EXPECT_EQ(o.edge[k], t.edge[i]);
            EXPECT_EQ(o.normal, t.neighbor_normal[i]);
            const float height = dot(t.normal, o.v[(k + 2) % 3] - t.v[0]);
            const EdgeKind want = height < -1.0e-6f  ? EdgeKind::convex
                                  : height > 1.0e-6f ? EdgeKind::concave
                                                     : EdgeKind::flat;
            EXPECT_EQ(t.edge[i], want);
            convex += want == EdgeKind::convex;
            concave += want == EdgeKind::concave;
            flat += want == EdgeKind::flat;
          }
        }
      }
    }
  }
  EXPECT_GT(flat, 10);
  EXPECT_GT(convex, 10);
  EXPECT_GT(concave, 10);
}

TEST(HeightField, NormalConesEqualBruteForce) {
  Random random{29};
  std::vector<float> heights;
  for (int i = 0; i < 49; ++i) heights.push_back(random.between(0.0f, 0.5f));
  heights[24] = std::nanf("");
  const Geometry geometry = cook(heights, 7, 7);
  const HeightField& field = field_of(geometry);
  int inside = 0;
  for (std::uint32_t cell = 0; cell < 36; ++cell) {
    if (!is_solid_cell(field, cell % 6, cell / 6)) continue;
    for (std::uint32_t id = 2 * cell; id < 2 * cell + 2; ++id) {
      const TriangleView t = view_triangle(field, id);
      for (int corner = 0; corner < 3; ++corner) {
        const Vec3 d = normalized(Vec3{random.between(-0.5f, 0.5f), 1.0f, random.between(-0.5f, 0.5f)});
        bool want = true;
        for (std::uint32_t other = 0; other < 72; ++other) {
          if (!is_solid_cell(field, other / 2 % 6, other / 2 / 6)) continue;
          const TriangleView o = view_triangle(field, other);
          for (int k = 0; k < 3; ++k) {
            if (o.corner_id[k] != t.corner_id[corner]) continue;
            for (int e = 1; e < 3; ++e) {
              const Vec3 along = o.v[(k + e) % 3] - o.v[k];
              want = want && dot(d, along) <= 1.0e-3f * length(along);
            }
          }
        }
        EXPECT_EQ(in_normal_cone(field, id, corner, d, 1.0e-3f), want);
        inside += want;
      }
    }
  }
  EXPECT_GT(inside, 10);
}

TEST(HeightField, ANanOpensAllCellsThatUseIt) {
  std::vector<float> heights(25, 1.0f);
  heights[2 * 5 + 2] = std::nanf("");
  const Geometry geometry = cook(heights, 5, 5);
  const HeightField& field = field_of(geometry);
  for (int row = 0; row < 4; ++row) {
    for (int column = 0; column < 4; ++column) {
      const bool hole = (row == 1 || row == 2) && (column == 1 || column == 2);
      EXPECT_EQ(is_solid_cell(field, column, row), !hole);
    }
  }
  EXPECT_FALSE(is_solid_cell(field, -1, 0));
  EXPECT_FALSE(is_solid_cell(field, 0, 4));
  // Edges to the hole are open: triangle 1 of cell (0, 1) has its right side there.
  const TriangleView beside = view_triangle(field, 2 * (1 * 4 + 0) + 1);
  EXPECT_EQ(beside.edge[2], EdgeKind::open);
  EXPECT_EQ(beside.edge[1], EdgeKind::flat);
}

TEST(HeightField, TheWalkFindsEveryCellUnderABox) {
  Random random{31};
  for (const auto& [columns, rows] :
       {std::pair<std::uint32_t, std::uint32_t>{2, 2}, {17, 9}, {33, 33}, {40, 3}}) {
    std::vector<float> heights;
    for (std::uint32_t i = 0; i < columns * rows; ++i) heights.push_back(random.between(-1.0f, 1.0f));
    if (heights.size() > 4) heights[heights.size() / 2] = std::nanf("");
    const Geometry geometry = cook(heights, columns, rows, 0.7f);
    const HeightField& field = field_of(geometry);
    for (int query = 0; query < 300; ++query) {
      Vec3 c = random.in_box(15.0f);
      c.y *= 0.1f;
      const Aabb box{c - absolute(random.in_box(3.0f)), c + absolute(random.in_box(3.0f))};
      std::set<std::pair<std::uint32_t, std::uint32_t>> walked;
      walk_cells(
          field, box, [](HeightBlock) { return true; },
          [&](std::uint32_t column, std::uint32_t row) {
            EXPECT_TRUE(walked.insert({column, row}).second);
            EXPECT_LT(column, field.cell_columns());
            EXPECT_LT(row, field.cell_rows());
          });
      for (std::uint32_t row = 0; row + 1 < rows; ++row) {
        for (std::uint32_t column = 0; column + 1 < columns; ++column) {
          if (!is_solid_cell(field, column, row) || !overlap(block_box(field, {-1, column, row}), box))
            continue;
          EXPECT_TRUE(walked.count({column, row}) == 1) << column << ' ' << row;
        }
      }
    }
  }
}

TEST(HeightField, FlatBlocksAreFlatAllAround) {
  // A plain with one bump: blocks that touch the bump's triangles are not flat.
  const std::uint32_t n = 66;
  for (const float slope : {0.0f, 0.25f}) {
    std::vector<float> heights;
    for (std::uint32_t i = 0; i < n * n; ++i)
      heights.push_back(slope * float(i % n) - 0.5f * slope * float(i / n));
    heights[20 * n + 24] += 0.01f;
    const Geometry geometry = cook(heights, n, n);
    const HeightField& field = field_of(geometry);
    EXPECT_EQ(field.levels.size(), 6u);
    for (std::uint32_t row = 0; row < 17; ++row) {
      for (std::uint32_t column = 0; column < 17; ++column) {
        const bool border = row == 0 || column == 0 || row >= 16 || column >= 16;
        // Sample (24, 20) is a corner of these blocks, or of cells that touch them.
        const bool bump = (column == 5 || column == 6) && (row == 4 || row == 5);
        EXPECT_EQ(is_flat(field, {0, column, row}), !border && !bump) << column << ' ' << row;
      }
    }
    EXPECT_TRUE(is_flat(field, {1, 5, 5}));
    EXPECT_FALSE(is_flat(field, {1, 2, 2}));
    EXPECT_FALSE(is_flat(field, {5, 0, 0}));
  }
}

TEST(HeightField, HashesTellFieldsApart) {
  const std::vector<float> heights{0, 1, 2, 3, 4, 5};
  const std::uint64_t one = cook(heights, 3, 2).content_hash();
  EXPECT_EQ(one, cook(heights, 3, 2).content_hash());
  EXPECT_NE(one, cook(heights, 2, 3).content_hash());
  EXPECT_NE(one, cook(heights, 3, 2, 2.0f).content_hash());
}

}  // namespace
}  // namespace gyre::height_field_test
