// The triangles of a liquid's surface.
#include "fluid/liquid/liquid_surface.h"

#include "fluid/liquid/liquid_test_kit.h"

#include <gtest/gtest.h>

#include <map>

namespace gyre::liquid_surface_test {
namespace {

using namespace liquid_test;

TEST(LiquidSurface, the_mesh_is_closed_and_holds_the_volume) {
  for (const bool flat : {false, true}) {
    LiquidGrid grid = make_liquid_grid(box_of(16, 16, flat ? 1 : 16, 0.1f, GasBoundary::closed));
    const GasSolids none;
    fill_liquid_box(grid, {0, 0, 0}, {1.6, 0.53, 1.6}, {}, none);
    fill_liquid_ball(grid, {0.8, 1.1, flat ? 0.05 : 0.8}, 0.3f, {}, none);
    find_liquid_fields(grid, none, [](const FluidWindow&) {});
    Array<Vec3> vertices;
    Array<std::uint32_t> indices;
    find_surface_mesh(grid, vertices, indices);
    std::map<std::pair<std::uint32_t, std::uint32_t>, int> edges;
    double volume = 0.0;
    for (std::size_t i = 0; i < indices.size(); i += 3) {
      for (std::size_t side = 0; side < 3; ++side) {
        const std::uint32_t a = indices[i + side], b = indices[i + (side + 1) % 3];
        ASSERT_LT(a, vertices.size());
        edges[{a < b ? a : b, a < b ? b : a}] += a < b ? 1 : -1;
      }
      volume +=
          double(dot(vertices[indices[i]], cross(vertices[indices[i + 1]], vertices[indices[i + 2]]))) / 6.0;
    }
    for (const auto& [edge, balance] : edges) ASSERT_EQ(balance, 0) << edge.first << " " << edge.second;
    const double exact = flat ? 0.1 * (1.6 * 0.53 + 3.14159265 * 0.09) : 1.6 * 1.6 * 0.53 + 4.18879 * 0.027;
    EXPECT_NEAR(volume, exact, 0.02 * exact);
    EXPECT_NEAR(liquid_volume(grid, none), exact, 0.01 * exact);
  }
}

}  // namespace
}  // namespace gyre::liquid_surface_test
