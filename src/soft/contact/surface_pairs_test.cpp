// Pairs against brute force, and bounds against exact crossings.
#include "soft/contact/surface_pairs.h"
#include "geometry/distance/closest.h"
#include "random.h"
#include "soft/contact/displacement_bounds.h"
#include "soft/contact/surface_crossings.h"
#include "soft/contact/surface_test_kit.h"

#include <gtest/gtest.h>

#include <array>

namespace gyre::surface_pairs_test {
namespace {

using namespace surface_test;
using testing_random::Mixed;

Array<DVec3> still(const Surfaces& all) {
  Array<DVec3> moves;
  moves.assign(all.positions.size(), DVec3{});
  return moves;
}

// Numbers of pairs (vertex and triangle, edge and edge) within a distance.
struct Counted {
  long corners = 0, edges = 0;
};
// Calls visit(key) for each pair within `most`; returns how many there are.
template <class Visit>
long for_each_near(const Surfaces& all, double most, Visit&& visit) {
  long found = 0;
  const auto place = [&](std::size_t s, std::uint32_t v) { return all.placed[s].first + v; };
  const auto add = [&](std::uint64_t kind, std::size_t a, std::size_t b, double distance) {
    if (!(distance <= most)) return;
    ++found;
    visit(kind | std::uint64_t(a) << 32 | std::uint64_t(b));
  };
  constexpr std::uint64_t kEdges = std::uint64_t(1) << 63;
  std::size_t first_triangle = 0, first_edge = 0;
  Array<std::size_t> triangle_base, edge_base;
  for (const SoftSurface& surface : all.surfaces) {
    triangle_base.push_back(first_triangle), edge_base.push_back(first_edge);
    first_triangle += surface.triangles.size(), first_edge += surface.edges.size();
  }
  for (std::size_t s = 0; s < all.surfaces.size(); ++s) {
    for (std::size_t t = 0; t < all.surfaces.size(); ++t) {
      for (std::uint32_t v = 0; v < std::uint32_t(all.surfaces[s].vertices); ++v) {
        for (std::size_t k = 0; k < all.surfaces[t].triangles.size(); ++k) {
          const SoftTriangle& one = all.surfaces[t].triangles[k];
          std::uint32_t at[3];
          bool common = false;
          for (int c = 0; c < 3; ++c) at[c] = place(t, one.corner[c]), common |= at[c] == place(s, v);
          if (common) continue;
          const DVec3 p = all.positions[place(s, v)];
          const DVec3 near =
              closest_on_triangle(p, all.positions[at[0]], all.positions[at[1]], all.positions[at[2]]).point;
          add(0, place(s, v), triangle_base[t] + k, length(p - near));
        }
      }
      if (t < s) continue;
      for (std::size_t i = 0; i < all.surfaces[s].edges.size(); ++i) {
        for (std::size_t k = s == t ? i + 1 : 0; k < all.surfaces[t].edges.size(); ++k) {
          const SurfaceEdge e = all.surfaces[s].edges[i], f = all.surfaces[t].edges[k];
          const std::uint32_t at[4] = {place(s, e.a), place(s, e.b), place(t, f.a), place(t, f.b)};
          if (at[0] == at[2] || at[0] == at[3] || at[1] == at[2] || at[1] == at[3]) continue;
          const SegmentPair near = closest_of_segments(all.positions[at[0]], all.positions[at[1]],
                                                       all.positions[at[2]], all.positions[at[3]]);
          add(kEdges, edge_base[s] + i, edge_base[t] + k, length(near.on_a - near.on_b));
        }
      }
    }
  }
  return found;
}
Counted brute_force_pairs(const Surfaces& all, double most) {
  Counted out;
  for_each_near(all, most, [&](std::uint64_t key) { (key >> 63 == 0 ? out.corners : out.edges) += 1; });
  return out;
}

TEST(SurfacePairs, AreThoseOfBruteForce) {
  Mixed random{11};
  Arena arena;
  for (int n = 0; n < 8; ++n) {
    Surfaces all;
    Array<float> limits;
    for (int k = 0; k < 1 + n % 3; ++k) {
      const int cells = 4 + int(random.next() % 4);
      Array<DVec3> places = crumpled(cells, 0.1, 0.2, random);
      for (DVec3& p : places) p.x += n == 7 ? 1.0e6 : 0.0;  // far from the origin
      all.add(places, grid_triangles(cells, cells), 0.02f);
    }
    for (std::size_t v = 0; v < all.positions.size(); ++v)
      limits.push_back(n % 2 == 0 ? 0.02f : random.single(0.0f, 0.04f));
    TaskSystem tasks;
    PairSearch candidates;
    Array<SurfacePair> pairs;
    for (SoftSurface& surface : all.surfaces) surface.radius.assign(surface.radius.size(), 0.02f);
    // All that are within their thickness, whether they touch or not.
    find_surface_pairs(all.placed, all.positions, still(all), limits, 1.0f, arena, tasks, candidates, pairs);
    Counted found;
    for (std::size_t i = 0; i < pairs.size(); ++i) {
      const SurfacePair& pair = pairs[i];
      (pair.on_a == 1 ? found.corners : found.edges) += 1;
      if (i > 0) {
        ASSERT_LT(pairs[i - 1].key, pair.key);
      }
      // The weights give the vector between the closest points.
      DVec3 apart{};
      double sum = 0.0;
      for (int k = 0; k < 4; ++k) {
        apart += double(pair.weight[k]) * (all.positions[pair.vertex[k]] - all.positions[pair.vertex[0]]);
        sum += double(pair.weight[k]);
        ASSERT_TRUE(k < pair.on_a ? pair.weight[k] >= 0.0f : pair.weight[k] <= 0.0f);
      }
      ASSERT_NEAR(sum, 0.0, 1e-6);
      ASSERT_LT(length(apart - pair.distance * pair.normal), 1e-6);
      ASSERT_NEAR(length(pair.normal), 1.0, 1e-12);
    }
    // With different limits all that is within the least is found, and nothing beyond the largest.
    const Counted least = brute_force_pairs(all, n % 2 == 0 ? 0.08 : 0.04);
    const Counted most = brute_force_pairs(all, n % 2 == 0 ? 0.08 : 0.12);
    EXPECT_GE(found.corners, least.corners) << n;
    EXPECT_LE(found.corners, most.corners) << n;
    EXPECT_GE(found.edges, least.edges) << n;
    EXPECT_LE(found.edges, most.edges) << n;
    EXPECT_GT(least.corners, 0);
    EXPECT_GT(least.edges, 5);
  }
}

// Whatever comes near while vertices move as planned, or within their limits of it, is among the pairs; what is found does not depend on when
// candidates were made; and a move of all together changes nothing.
TEST(SurfacePairs, AreThoseThatAPlanBringsTogether) {
  Mixed random{17};
  Arena arena;
  const double near = 0.2 * 0.04;  // the least gap of two radii
  long met = 0;
  for (int n = 0; n < 6; ++n) {
    Surfaces all;
    const int cells = 4;
    for (int k = 0; k < 2; ++k)
      all.add(crumpled(cells, 0.1, 0.1, random), grid_triangles(cells, cells), 0.02f);
    for (SoftSurface& surface : all.surfaces) surface.radius.assign(surface.radius.size(), 0.02f);
    const std::size_t count = all.positions.size();
    Array<DVec3> plan = still(all), moves = still(all), together = still(all);
    Array<float> limits;
    for (std::size_t v = 0; v < count; ++v) {
      limits.push_back(random.single(0.0f, 0.02f));
      plan[v] = {random.between(-0.2, 0.2), random.between(-0.2, 0.2), random.between(-0.2, 0.2)};
      // Surfaces fly at 3 m a step, the second of some a little faster.
      plan[v].x += 3.0 + (n % 2 == 1 && v >= count / 2 ? 0.5 : 0.0);
      DVec3 off{random.between(-1, 1), random.between(-1, 1), random.between(-1, 1)};
      moves[v] = plan[v] + (double(limits[v]) / length(off)) * off;
      together[v] = DVec3{0.7, 2.0, 0.1};
    }
    TaskSystem tasks;
    PairSearch candidates, fresh;
    Array<SurfacePair> pairs, same;
    Array<DVec3> before = all.positions;
    for (DVec3& p : before) p += DVec3{random.between(-1e-3, 1e-3), 0.5, random.between(-1e-3, 1e-3)};
    find_surface_pairs(all.placed, before, plan, limits, 0.2f, arena, tasks, candidates, pairs);
    find_surface_pairs(all.placed, all.positions, plan, limits, 0.2f, arena, tasks, candidates, pairs);
    EXPECT_EQ(candidates.candidates.new_tracks, long(count));
    find_surface_pairs(all.placed, all.positions, plan, limits, 0.2f, arena, tasks, fresh, same);
    ASSERT_EQ(pairs.size(), same.size());
    for (std::size_t i = 0; i < pairs.size(); ++i) ASSERT_EQ(pairs[i].key, same[i].key);
    for (const double t : {0.0, 0.2, 0.4, 0.6, 0.8, 1.0}) {
      const Array<DVec3> start = all.positions;
      for (std::size_t v = 0; v < count; ++v) all.positions[v] += t * moves[v];
      met += for_each_near(all, near, [&](std::uint64_t key) {
        bool any = false;
        for (const SurfacePair& pair : pairs) any |= pair.key == key;
        ASSERT_TRUE(any) << n << " " << t;
      });
      all.positions = start;
    }
    PairSearch other;
    find_surface_pairs(all.placed, all.positions, still(all), limits, 0.2f, arena, tasks, other, pairs);
    find_surface_pairs(all.placed, all.positions, together, limits, 0.2f, arena, tasks, other, same);
    EXPECT_EQ(pairs.size(), same.size());
    EXPECT_EQ(other.candidates.new_tracks, long(count));
  }
  EXPECT_GT(met, 300);
}

// Over many sub-steps, with all vertices on their way together, most of them at constant speeds of their own and a few that are stopped or thrown, a search that
// lasts and has three workers finds what a new one finds. Few vertices get new tracks.
TEST(SurfacePairs, OfALastingSearchAreThoseOfANewOne) {
  Mixed random{23};
  Arena arena;
  TaskSystem one(1), three(3);
  long found = 0, renewed = 0, all_vertices = 0;
  for (int n = 0; n < 4; ++n) {
    Surfaces all;
    for (int k = 0; k < 1 + n % 3; ++k) {
      const int cells = 12 + int(random.next() % 6);
      Array<DVec3> places = crumpled(cells, 0.04, 0.06, random);
      for (DVec3& p : places) p.y += 0.02 * k;
      all.add(places, grid_triangles(cells, cells), 0.008f);
    }
    const std::size_t count = all.positions.size();
    Array<DVec3> moves = still(all);
    Array<float> limits;
    limits.resize(count);
    for (DVec3& move : moves)
      move = {random.between(-1e-3, 1e-3), random.between(-3e-3, 3e-3), random.between(-1e-3, 1e-3)};
    PairSearch lasting;
    Array<SurfacePair> pairs, same;
    for (int step = 0; step < 40; ++step) {
      if (step == 20) all.surfaces[0].radius[3] *= 1.5f;  // a reach that grows by itself
      for (std::size_t v = 0; v < count; ++v) {
        if (random.between(0, 1) < 0.01)
          moves[v].y = random.between(0, 1) < 0.5 ? 0.0 : random.between(-0.02, 0.02);
        limits[v] = 0.1f * float(length(moves[v])) + 1e-3f;
      }
      for (int round = 0; round < 2; ++round) {
        find_surface_pairs(all.placed, all.positions, moves, limits, 0.2f, arena, three, lasting, pairs);
        PairSearch fresh;
        find_surface_pairs(all.placed, all.positions, moves, limits, 0.2f, arena, one, fresh, same);
        ASSERT_EQ(pairs.size(), same.size()) << n << " " << step;
        for (std::size_t i = 0; i < pairs.size(); ++i) {
          ASSERT_EQ(pairs[i].key, same[i].key) << n << " " << step;
          ASSERT_EQ(pairs[i].distance, same[i].distance);
        }
        moves[random.next() % count].x *= -3.0;  // what bounds do
      }
      for (std::size_t v = 0; v < count; ++v) all.positions[v] += moves[v] + DVec3{0.3, -0.1 * step, 0.2};
      lasting.candidates.advance();
      found += long(pairs.size());
      all_vertices += 2 * long(count);
    }
    renewed += lasting.candidates.new_tracks;
  }
  EXPECT_GT(found, 30000);
  EXPECT_LT(renewed, all_vertices / 4);
}

// Of two flat sheets, forces act between vertices and faces and between edges that cross, all straight up, and nowhere twice; and between
// the rim of the upper sheet and vertices beyond it.
TEST(SurfacePairs, TouchAlongTheNormalsOfFlatSheets) {
  Arena arena;
  Surfaces all;
  all.add(places_of(grid_cloth({1, 1}, {6, 6}, {}, {})), grid_triangles(6, 6), 0.02f);
  all.add(places_of(grid_cloth({0.61f, 0.53f}, {5, 5}, {{0.013, 0.03, 0.027}, {}}, {})), grid_triangles(5, 5),
          0.02f);
  Array<float> limits;
  limits.resize(all.positions.size());
  TaskSystem tasks;
  PairSearch candidates;
  Array<SurfacePair> pairs;
  find_surface_pairs(all.placed, all.positions, still(all), limits, 1.0f, arena, tasks, candidates, pairs);
  int corners = 0, rim = 0;
  for (const SurfacePair& pair : pairs) {
    if (!pair.touches) continue;
    const bool on_rim =
        pair.on_a == 1 && (pair.weight[1] == 0.0f || pair.weight[2] == 0.0f || pair.weight[3] == 0.0f);
    rim += on_rim;
    if (on_rim) continue;
    EXPECT_NEAR(absolute(pair.normal.y), 1.0, 1e-9);
    EXPECT_NEAR(pair.distance, 0.03, 1e-9);
    corners += pair.on_a == 1;
  }
  // Each vertex of the upper sheet is over one face, and each inner one of the lower sheet under one.
  int under = 0;
  for (std::size_t v = 0; v < 49; ++v) {
    under += absolute(all.positions[v].x - 0.013) < 0.305 && absolute(all.positions[v].z - 0.027) < 0.265;
  }
  EXPECT_EQ(corners, 36 + under);
  EXPECT_LT(rim, 12);
}

TEST(SurfacePairs, OfASheetAtRestAreNone) {
  Arena arena;
  Surfaces all;
  const Array<DVec3> places = places_of(grid_cloth({1, 1}, {30, 30}, {}, {}));
  all.add(places, grid_triangles(30, 30), 1.0f);  // much thicker than its cells
  TaskSystem tasks;
  PairSearch candidates;
  Array<SurfacePair> pairs;
  Array<float> limits;
  limits.resize(all.positions.size());
  find_surface_pairs(all.placed, all.positions, still(all), limits, 1.0f, arena, tasks, candidates, pairs);
  EXPECT_EQ(pairs.size(), 0u);
}

// Layers of random bumps that do not cross, moved at random by more than their distance: all that is moved is moved straight, so no
// crossing at the end, nor at points between, is a strong sign that there is none on the way.
TEST(DisplacementBounds, RandomMovesNeverCross) {
  Mixed random{5};
  Arena arena;
  long shortened = 0, unbounded = 0;
  for (int n = 0; n < 3; ++n) {
    Surfaces all;
    const int cells = 6;
    for (int layer = 0; layer < 3; ++layer) {
      Array<DVec3> places = crumpled(cells, 0.02, 0.008, random);
      for (DVec3& p : places) p.y += 0.02 * layer;
      all.add(places, grid_triangles(cells, cells), 0.005f);
    }
    ASSERT_EQ(count_crossings(all.placed, all.positions, arena), 0);
    const std::size_t count = all.positions.size();
    Array<float> limits;
    Array<std::uint8_t> held;
    held.resize(count);
    limits.assign(count, 0.03f);
    TaskSystem tasks;
    PairSearch candidates;
    for (int move = 0; move < 30; ++move) {
      Array<SurfacePair> pairs;
      find_surface_pairs(all.placed, all.positions, still(all), limits, 0.2f, arena, tasks, candidates,
                         pairs);
      double least = 1.0;
      for (const SurfacePair& pair : pairs) least = min(least, pair.distance / double(pair.thickness));
      // Those that were nearer at the start come no nearer; the rest keeps the least gap.
      EXPECT_GT(least, move == 0 ? 0.0 : 1.0e-3);
      Array<DVec3> moves;
      moves.resize(count);
      for (DVec3& one : moves) {
        one = {random.between(-0.05, 0.05), random.between(-0.05, 0.05), random.between(-0.05, 0.05)};
      }
      if (move % 4 == 3) {
        for (std::size_t v = 0; v < count; ++v)
          moves[v].y = 0.3 * (0.02 - all.positions[v].y);  // all to the middle
      }
      Array<DVec3> there = all.positions;
      for (std::size_t v = 0; v < count; ++v) there[v] += moves[v];
      unbounded += count_crossings(all.placed, there, arena);
      const BoundReport report = bound_moves(pairs, all.positions, limits, held, {}, {}, moves, arena, tasks);
      shortened += report.shortened;
      EXPECT_EQ(report.forced + report.crossed, 0);
      for (const double part : {0.31, 0.77, 1.0}) {
        for (std::size_t v = 0; v < count; ++v) there[v] = all.positions[v] + part * moves[v];
        ASSERT_EQ(count_crossings(all.placed, there, arena), 0) << n << " " << move;
      }
      all.positions = there;
    }
  }
  EXPECT_GT(shortened, 1000);
  EXPECT_GT(unbounded, 1000);
}

// A bound takes the part of a move that goes toward the other surface, and nothing else.
TEST(DisplacementBounds, LeaveMovesAloneThatDoNotApproach) {
  Arena arena;
  Surfaces all;
  const Array<DVec3> low = places_of(grid_cloth({1, 1}, {4, 4}, {}, {}));
  const Array<DVec3> high = places_of(grid_cloth({0.5f, 0.5f}, {4, 4}, {{0, 0.03, 0}, {}}, {}));
  all.add(low, grid_triangles(4, 4), 0.01f);
  all.add(high, grid_triangles(4, 4), 0.01f);
  Array<float> limits;
  limits.assign(all.positions.size(), 0.2f);
  Array<std::uint8_t> held;
  held.resize(all.positions.size());
  TaskSystem tasks;
  PairSearch candidates;
  Array<SurfacePair> pairs;
  find_surface_pairs(all.placed, all.positions, still(all), limits, 0.2f, arena, tasks, candidates, pairs);
  Array<DVec3> moves;
  moves.resize(all.positions.size());
  for (std::size_t v = 25; v < 50; ++v) moves[v] = {0.01, -0.1, 0.0};
  bound_moves(pairs, all.positions, limits, held, {}, {}, moves, arena, tasks);
  for (std::size_t v = 0; v < 25; ++v) EXPECT_EQ(moves[v], DVec3{});
  for (std::size_t v = 25; v < 50; ++v) {
    EXPECT_NEAR(moves[v].x, 0.01, 1e-9);
    EXPECT_NEAR(moves[v].y, -(0.03 - 0.2 * 0.02), 1e-5);  // up to a fifth of the thickness
  }
}

// Where surfaces lie in each other a pair leaves no room to either side. They still fly on.
TEST(DisplacementBounds, DoNotHoldBackWhatFliesTogether) {
  Arena arena;
  TaskSystem tasks;
  // A vertex in a triangle, kept on both of its sides, and far from there another one that stands still.
  Array<DVec3> positions;
  for (const DVec3& p : {DVec3{0.2, 0, 0.2}, DVec3{0, 0, 0}, DVec3{1, 0, 0}, DVec3{0, 0, 1}, DVec3{9, 0, 0}})
    positions.push_back(p);
  std::array<SurfacePair, 2> pairs;
  for (int k = 0; k < 2; ++k) {
    for (std::uint32_t v = 0; v < 4; ++v) pairs[k].vertex[v] = v;
    pairs[k].thickness = 0.01f;
    pairs[k].normal = {0, k == 0 ? 1.0 : -1.0, 0};
  }
  Array<std::uint8_t> held;
  held.resize(5);
  Array<DVec3> moves;
  moves.resize(5);
  for (int v = 0; v < 4; ++v) moves[v] = {0.01, -0.07, 0.02};
  const BoundReport report = bound_moves(pairs, positions, {}, held, {}, {}, moves, arena, tasks);
  EXPECT_EQ(report.crossed, 2);
  EXPECT_EQ(report.shortened, 0);
  for (int v = 0; v < 4; ++v) EXPECT_EQ(moves[v], (DVec3{0.01, -0.07, 0.02}));
  // A vertex that moves against the rest does not.
  moves[0].y += 0.01;
  bound_moves(pairs, positions, {}, held, {}, {}, moves, arena, tasks);
  for (int v = 1; v < 4; ++v) EXPECT_NEAR(moves[v].y, moves[0].y, 1.0e-12);
}

}  // namespace
}  // namespace gyre::surface_pairs_test
