// The gap of cracks: sides are apart by it along their normals, the centre of mass stays, and parts that grip each other are refused.
#include "soft/elements/crack_gap.h"
#include "soft/elements/solid.h"
#include "soft/elements/vertex_split.h"

#include <gtest/gtest.h>

#include <cmath>

namespace gyre::crack_gap_test {
namespace {

// A box of 4 x 2 x 2 cells of 1 m, cut along the plane x = 2.
struct CutBox {
  Array<std::uint32_t> corners, roots;
  Array<DVec3> whole;
};
CutBox cut_box() {
  const int cells[3] = {4, 2, 2};
  CutBox box;
  box.corners = box_tetrahedra(cells);
  box.whole = box_places({2, 1, 1}, cells, {});
  const std::uint32_t count = std::uint32_t(box.whole.size());
  VertexSplitter splitter(box.corners.view(), 4, count);
  Array<std::uint32_t> made;
  for (std::uint32_t v = 0; v < count; ++v) {
    if (box.whole[v].x != 0.0) continue;
    Array<std::uint8_t> beyond;
    for (const std::uint32_t t : splitter.around(v)) {
      double middle = 0.0;
      for (std::uint32_t k = 0; k < 4; ++k) middle += box.whole[splitter.source(box.corners[4 * t + k])].x;
      beyond.push_back(middle > 0.0 ? 1 : 0);
    }
    splitter.split(v, beyond.view(), made);
  }
  for (std::uint32_t v = 0; v < splitter.vertices(); ++v) box.roots.push_back(splitter.source(v));
  return box;
}

TEST(CrackGap, TheSidesOfAPlaneAreApart) {
  const CutBox box = cut_box();
  ASSERT_EQ(box.roots.size(), 45u + 9u);
  Array<DVec3> places;
  for (const std::uint32_t root : box.roots) places.push_back(box.whole[root]);
  open_cracks(box.corners, box.roots, 0.1, {places.data(), places.size()});
  for (std::uint32_t v = 0; v < 45; ++v) {
    if (box.whole[v].x != 0.0) {
      EXPECT_EQ(places[v], box.whole[v]);
    }
  }
  for (std::uint32_t v = 45; v < places.size(); ++v) {
    const DVec3 apart = places[v] - places[box.roots[v]];
    EXPECT_NEAR(std::abs(apart.x), 0.1, 1e-9);
    EXPECT_NEAR(apart.y, 0.0, 1e-9);
    EXPECT_NEAR(apart.z, 0.0, 1e-9);
  }
}

TEST(CrackGap, PartsMoveAboutTheirCentreOfMass) {
  const CrackFace faces[] = {{0, 0, 1, {1, 0, 0}}, {0, 0, 2, {0, 1, 0}}};
  const double volume[] = {3.0, 1.0, 2.0};
  DVec3 moves[3] = {};
  ASSERT_TRUE(separate_parts(faces, volume, moves));
  EXPECT_NEAR(moves[0].x - moves[1].x, 1.0, 1e-9);
  EXPECT_NEAR(moves[0].y - moves[2].y, 1.0, 1e-9);
  const DVec3 mean = 3.0 * moves[0] + moves[1] + 2.0 * moves[2];
  EXPECT_LT(length(mean), 1e-12);
}

// One part within a fork of the other cannot leave along any direction; in a wide notch it can.
TEST(CrackGap, PartsThatGripEachOtherAreRefused) {
  const double volume[] = {1.0, 1.0};
  for (const double open : {0.0, 1.0}) {
    const DVec3 way = (1.0 / length(DVec3{1, open, 0})) * DVec3{1, open, 0};
    const CrackFace faces[] = {{0, 0, 1, way}, {0, 0, 1, {-way.x, way.y, 0}}};
    DVec3 moves[2] = {};
    EXPECT_EQ(separate_parts(faces, volume, moves), open > 0.0);
  }
}

TEST(CrackGap, SplitsAreTakenBack) {
  const int cells[3] = {2, 2, 2};
  Array<std::uint32_t> corners = box_tetrahedra(cells), made;
  const Array<std::uint32_t> before = corners;
  VertexSplitter splitter(corners.view(), 4, 27);
  for (const std::uint32_t v : {13u, 4u}) {
    Array<std::uint8_t> beyond;
    for (std::size_t i = 0; i < splitter.around(v).size(); ++i) beyond.push_back(std::uint8_t(i % 2));
    splitter.split(v, beyond.view(), made);
  }
  EXPECT_GT(splitter.vertices(), 28u);
  splitter.undo(27);
  EXPECT_EQ(splitter.vertices(), 27u);
  for (std::size_t k = 0; k < before.size(); ++k) ASSERT_EQ(corners[k], before[k]);
}

}  // namespace
}  // namespace gyre::crack_gap_test
