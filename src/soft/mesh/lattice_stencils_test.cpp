// Stencils with the most extreme cut points and moved points: every tetrahedron keeps its angles and its volume, and together they fill what
// is inside.
#include "soft/mesh/lattice_stencils.h"

#include "random.h"
#include "soft/mesh/cut_lattice.h"
#include "soft/mesh/tetrahedral_fill.h"
#include "soft/mesh/tetrahedron_quality_test_kit.h"

#include <gtest/gtest.h>

#include <vector>

namespace gyre::lattice_stencils_test {
namespace {

// Two centres and two corners of cells, wound positively.
constexpr DVec3 kPlaces[4] = {{1, 1, 1}, {3, 1, 1}, {2, 0, 0}, {2, 2, 0}};
constexpr double kLatticeVolume = 4.0 / 6.0;

// The ways from a point along which it may have been moved, all the way.
std::vector<DVec3> all_moves() {
  std::vector<DVec3> moves{{0, 0, 0}};
  for (int d = 0; d < CutLattice::kDirections; ++d) {
    const LatticePoint p = CutLattice::neighbour({0, 0, 0}, d);
    const bool is_long = p.x * p.y * p.z == 0;
    moves.push_back((is_long ? CutLattice::kLongShare : CutLattice::kShortShare) * DVec3(p.x, p.y, p.z));
  }
  return moves;
}

struct Case {
  std::int8_t side[4];
  bool even[4];
  DVec3 node[16];

  int count(int of) const {
    int n = 0;
    for (const std::int8_t s : side) n += s == of ? 1 : 0;
    return n;
  }
  void set_cut(int inside, int outside, double fraction) {
    node[4 * inside + outside] = kPlaces[inside] + fraction * (kPlaces[outside] - kPlaces[inside]);
  }
  void add_to(TetrahedronQuality& quality) const {
    const StencilTetrahedra cut = cut_lattice_tetrahedron(side, even);
    for (int t = 0; t < cut.count; ++t) {
      const auto& n = cut.node[t];
      quality.add({node[n[0]], node[n[1]], node[n[2]], node[n[3]]});
    }
  }
};

// The cases of sides and parities: number from 0 to 81 * 4.
Case make_case(int number) {
  Case out{};
  for (int i = 0, rest = number; i < 4; ++i, rest /= 3) {
    out.side[i] = std::int8_t(rest % 3 - 1);
    out.node[5 * i] = kPlaces[i];
  }
  out.even[0] = number / 81 % 2 == 0;
  out.even[2] = number / 162 % 2 == 0;
  out.even[1] = !out.even[0];
  out.even[3] = !out.even[2];
  return out;
}

// Calls visit for all moves of the points on the surface and both extreme fractions of every cut.
template <class Visit>
void visit_extremes(Case one, Visit&& visit) {
  static const std::vector<DVec3> moves = all_moves();
  std::size_t moved = 1;
  int cuts = 0;
  for (int i = 0; i < one.count(0); ++i) moved *= moves.size();
  cuts = one.count(1) * one.count(-1);
  for (std::size_t m = 0; m < moved; ++m) {
    std::size_t rest = m;
    for (int i = 0; i < 4; ++i) {
      if (one.side[i] != 0) continue;
      one.node[5 * i] = kPlaces[i] + moves[rest % moves.size()];
      rest /= moves.size();
    }
    for (int far = 0; far < 1 << cuts; ++far) {
      int bit = 0;
      for (int i = 0; i < 4; ++i) {
        for (int j = 0; j < 4; ++j) {
          if (one.side[i] <= 0 || one.side[j] >= 0) continue;
          const double share = is_long_edge(i, j) ? CutLattice::kLongShare : CutLattice::kShortShare;
          one.set_cut(i, j, (far >> bit++ & 1) != 0 ? 1.0 - share : share);
        }
      }
      visit(one);
    }
  }
}

TEST(LatticeStencils, KeepAnglesAndVolumesAtTheExtremes) {
  TetrahedronQuality quality;
  for (int number = 0; number < 324; ++number)
    visit_extremes(make_case(number), [&](const Case& one) { one.add_to(quality); });
  EXPECT_GT(quality.smallest_angle, kMinDihedral);
  EXPECT_LT(quality.smallest_angle, kMinDihedral + 0.1) << "the bound is sharp";
  EXPECT_LT(quality.largest_angle, kMaxDihedral);
  EXPECT_GT(quality.largest_angle, kMaxDihedral - 0.1) << "the bound is sharp";
  EXPECT_GT(quality.smallest_volume, kMinVolumeShare * kLatticeVolume);
}

TEST(LatticeStencils, KeepAnglesAndVolumesBetweenTheExtremes) {
  testing_random::Mixed random{5};
  const std::vector<DVec3> moves = all_moves();
  TetrahedronQuality quality;
  for (int i = 0; i < 200000; ++i) {
    Case one = make_case(int(random.next() % 324));
    for (int a = 0; a < 4; ++a) {
      if (one.side[a] == 0)
        one.node[5 * a] = kPlaces[a] + random.unit() * moves[random.next() % moves.size()];
      for (int b = 0; b < 4; ++b) {
        const double share = is_long_edge(a, b) ? CutLattice::kLongShare : CutLattice::kShortShare;
        if (a != b) one.set_cut(a, b, random.between(share, 1.0 - share));
      }
    }
    one.add_to(quality);
  }
  EXPECT_GT(quality.smallest_angle, kMinDihedral);
  EXPECT_LT(quality.largest_angle, kMaxDihedral);
  EXPECT_GT(quality.smallest_volume, kMinVolumeShare * kLatticeVolume);
}

// A plane cuts the tetrahedron: what is inside has the volume of the part before the plane.
TEST(LatticeStencils, FillThePartInside) {
  testing_random::Mixed random{9};
  for (int i = 0; i < 20000; ++i) {
    const DVec3 normal{random.between(-1, 1), random.between(-1, 1), random.between(-1, 1)};
    const double offset = dot(normal, DVec3{2, 1, 0.5}) + random.between(-0.7, 0.7);
    double height[4];
    Case one = make_case(int(random.next() % 4) * 81);
    for (int a = 0; a < 4; ++a) {
      height[a] = dot(normal, kPlaces[a]) - offset;
      one.side[a] = height[a] > 0.0 ? 1 : -1;
    }
    for (int a = 0; a < 4; ++a) {
      for (int b = 0; b < 4; ++b)
        if (one.side[a] > 0 && one.side[b] < 0) one.set_cut(a, b, height[a] / (height[a] - height[b]));
    }
    TetrahedronQuality quality;
    one.add_to(quality);
    // The share of a simplex above a plane as a truncated power.
    double share = 0.0;
    for (int a = 0; a < 4; ++a) {
      double piece = one.side[a] > 0 ? 1.0 : 0.0;
      for (int b = 0; b < 4; ++b) piece *= a != b ? height[a] / (height[a] - height[b]) : 1.0;
      share += piece;
    }
    EXPECT_NEAR(quality.whole_volume, share * kLatticeVolume, 1.0e-7);
    EXPECT_TRUE(one.count(1) == 0 || quality.smallest_volume >= 0.0);
  }
}

}  // namespace
}  // namespace gyre::lattice_stencils_test
