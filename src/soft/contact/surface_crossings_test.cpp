// Exact predicates and crossings, against integers, brute force and cases whose number is known.
#include "soft/contact/surface_crossings.h"
#include "random.h"
#include "soft/contact/orientation.h"
#include "soft/contact/surface_test_kit.h"

#include <gtest/gtest.h>

namespace gyre::surface_crossings_test {
namespace {

using namespace surface_test;
using testing_random::Mixed;

// Integers below 2^20: every sign is exact in 128 bits.
TEST(Orientation, HasTheSignOfIntegerArithmetic) {
  Mixed random{7};
  int zeros = 0;
  for (int n = 0; n < 20000; ++n) {
    // Small ranges make many flat tetrahedra.
    const double range = n % 3 == 0 ? 3.0 : n % 3 == 1 ? 40.0 : 1048576.0;
    DVec3 p[4];
    for (DVec3& one : p) {
      one = {std::floor(random.between(-range, range)), std::floor(random.between(-range, range)),
             std::floor(random.between(-range, range))};
    }
    if (n % 5 == 0) p[3] = p[0] + 2.0 * (p[1] - p[0]) - (p[2] - p[0]);
    __extension__ using Big = __int128;
    Big m[3][3];
    for (int r = 0; r < 3; ++r) {
      for (int c = 0; c < 3; ++c) m[r][c] = Big(p[r][c] - p[3][c]);
    }
    const Big volume = m[0][0] * (m[1][1] * m[2][2] - m[1][2] * m[2][1]) -
                       m[0][1] * (m[1][0] * m[2][2] - m[1][2] * m[2][0]) +
                       m[0][2] * (m[1][0] * m[2][1] - m[1][1] * m[2][0]);
    const int sign = volume > 0 ? 1 : volume < 0 ? -1 : 0;
    zeros += sign == 0;
    // Scaling by powers of two and common offsets of the same size keep the sign.
    const double scale = 0x1p-30;
    ASSERT_EQ(orient3(p[0], p[1], p[2], p[3]), sign);
    ASSERT_EQ(orient3(scale * p[1], scale * p[0], scale * p[2], scale * p[3]), -sign);
  }
  EXPECT_GT(zeros, 4000);
}

// Points that lie on a plane up to the last digit of one coordinate.
TEST(Orientation, SeesTheLastDigit) {
  const DVec3 a{0.1, 0.1, 0.1}, b{0.7, 0.7, 0.3}, c{0.2, 0.2, 0.9};
  for (int n = -3; n <= 3; ++n) {
    DVec3 d{0.5, 0.5, 0.5};
    for (int k = 0; k < n; ++k) d.x = std::nextafter(d.x, 1.0);
    for (int k = 0; k > n; --k) d.x = std::nextafter(d.x, 0.0);
    const int sign = orient3(a, b, c, d);
    EXPECT_EQ(sign == 0, n == 0);
    EXPECT_EQ(orient3(a, b, d, c), -sign);
    EXPECT_EQ(orient2({0.1, 0.1}, {0.3, 0.3}, {d.x, d.y}), n > 0 ? -1 : n < 0 ? 1 : 0);
  }
}

TEST(Crossings, TouchingCounts) {
  const DVec3 a{0, 0, 0}, b{1, 0, 0}, c{0, 1, 0};
  EXPECT_TRUE(segment_meets_triangle({0.25, 0.25, -1}, {0.25, 0.25, 1}, a, b, c));
  EXPECT_TRUE(segment_meets_triangle({0.25, 0.25, 0}, {0.25, 0.25, 1}, a, b, c));  // its end on the face
  EXPECT_TRUE(segment_meets_triangle({0.5, 0.5, -1}, {0.5, 0.5, 1}, a, b, c));     // through an edge
  EXPECT_TRUE(segment_meets_triangle({0, 0, 1}, {0, 0, 0}, a, b, c));              // at a corner
  EXPECT_TRUE(segment_meets_triangle({-1, 0.5, 0}, {2, 0.5, 0}, a, b, c));         // within the plane
  EXPECT_TRUE(segment_meets_triangle({0.2, 0.2, 0}, {0.3, 0.3, 0}, a, b, c));      // within the triangle
  EXPECT_FALSE(segment_meets_triangle({0.25, 0.25, 1e-300}, {0.25, 0.25, 1}, a, b, c));
  EXPECT_FALSE(segment_meets_triangle({0.5, std::nextafter(0.5, 1.0), -1}, {0.5, std::nextafter(0.5, 1.0), 1},
                                      a, b, c));
  EXPECT_FALSE(segment_meets_triangle({2, 0, 0}, {3, 0, 0}, a, b, c));  // on the line of an edge, apart
  EXPECT_FALSE(segment_meets_triangle({1, 1, 0}, {2, 2, 0}, a, b, c));
  // A triangle without area is its longest side.
  const DVec3 flat{0.5, 0, 0};
  EXPECT_TRUE(segment_meets_triangle({0.7, -1, 0}, {0.7, 1, 0}, a, b, flat));
  EXPECT_FALSE(segment_meets_triangle({1.5, -1, 0}, {1.5, 1, 0}, a, b, flat));
  EXPECT_FALSE(segment_meets_triangle({0.7, -1, 0.1}, {0.7, 1, 0.1}, a, b, flat));
  EXPECT_TRUE(segment_meets_triangle({1, 0, 1}, {1, 0, -1}, a, b, flat));
  EXPECT_FALSE(segment_meets_triangle({2, 0, 1}, {2, 0, -1}, a, b, flat));
}

long brute_force(const Surfaces& all) {
  long count = 0;
  for (std::size_t s = 0; s < all.surfaces.size(); ++s) {
    for (const SurfaceEdge& edge : all.surfaces[s].edges) {
      for (std::size_t t = 0; t < all.surfaces.size(); ++t) {
        for (const SoftTriangle& one : all.surfaces[t].triangles) {
          bool common = false;
          for (const std::uint32_t v : one.corner) common |= s == t && (v == edge.a || v == edge.b);
          const auto at = [&](std::uint32_t v) { return all.positions[all.placed[t].first + v]; };
          const DVec3 p = all.positions[all.placed[s].first + edge.a],
                      q = all.positions[all.placed[s].first + edge.b];
          count += !common &&
                   segment_meets_triangle(p, q, at(one.corner[0]), at(one.corner[1]), at(one.corner[2]));
        }
      }
    }
  }
  return count;
}

TEST(Crossings, AreThoseOfBruteForce) {
  Mixed random{3};
  Arena arena;
  long all_found = 0;
  for (int n = 0; n < 12; ++n) {
    Surfaces all;
    for (int k = 0; k < 1 + n % 3; ++k) {
      const int cells = 5 + int(random.next() % 4);
      Array<DVec3> places = crumpled(cells, 0.1 + 0.05 * (n % 4), 0.15, random);
      // Places on a coarse lattice touch and coincide.
      if (n % 2 == 1) {
        for (DVec3& p : places)
          p = {std::round(8 * p.x) / 8, std::round(8 * p.y) / 8, std::round(8 * p.z) / 8};
      }
      all.add(places, grid_triangles(cells, cells), 0.01f);
    }
    const long found = count_crossings(all.placed, all.positions, arena);
    EXPECT_EQ(found, brute_force(all)) << n;
    all_found += found;
  }
  EXPECT_GT(all_found, 1000);
}

// A square of two triangles through the middle of another, upright one: the edges that pass, and those that end on the other's lines.
TEST(Crossings, OfTwoSquaresAreThoseCountedByHand) {
  Arena arena;
  const std::uint32_t square[6] = {0, 1, 2, 0, 2, 3};
  Surfaces all;
  const DVec3 flat[4] = {{-1, 0, -1}, {1, 0, -1}, {1, 0, 1}, {-1, 0, 1}};
  const DVec3 upright[4] = {{0.1, -1, -0.4}, {0.1, 1, -0.4}, {0.1, 1, 0.5}, {0.1, -1, 0.5}};
  all.add(flat, square, 0.0f);
  all.add(upright, square, 0.0f);
  // Its edges at z = -0.4 and z = 0.5 and its diagonal pass through one triangle each; of the flat square the diagonal passes through it.
  EXPECT_EQ(count_crossings(all.placed, all.positions, arena), 4);
  for (std::size_t i = 4; i < 8; ++i) all.positions[i].y += 1.5;
  EXPECT_EQ(count_crossings(all.placed, all.positions, arena), 0);
}

TEST(Crossings, OfASheetThatLiesFlatAreNone) {
  Arena arena;
  Surfaces all;
  const Array<DVec3> places = places_of(grid_cloth({1, 1}, {10, 10}, {}, {}));
  all.add(places, grid_triangles(10, 10), 0.005f);
  EXPECT_EQ(all.surfaces[0].edges.size(), 10u * 11u * 2u + 100u);
  EXPECT_EQ(count_crossings(all.placed, all.positions, arena), 0);
  // One vertex moved onto the next: the triangles between have no area, and those across touch.
  all.positions[5 + 5 * 11] = all.positions[7 + 5 * 11];
  const long crossings = brute_force(all);
  EXPECT_EQ(count_crossings(all.placed, all.positions, arena), crossings);
  EXPECT_GT(crossings, 0);
}

}  // namespace
}  // namespace gyre::surface_crossings_test
