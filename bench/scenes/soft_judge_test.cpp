// The judge of soft matter against figures that are known by construction, and its scenes as they are built.
#include "bench/scenes/soft_judge.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numeric>

namespace gyre::bench::soft_judge_test {
namespace {

using namespace gyre::bench::soft;

double sum_of(const std::vector<float>& masses) { return std::accumulate(masses.begin(), masses.end(), 0.0); }
double figure(const SoftJudge& judge, const std::string& name) {
  for (const SoftFigure& f : judge.figures()) {
    if (name == f.name) return f.value;
  }
  return NAN;
}

TEST(SoftScene, HasTheMassesAndElementsThatItSays) {
  const Sheet sheet = make_sheet("hanging");
  EXPECT_NEAR(sum_of(sheet.masses), 0.8, 1e-6);
  EXPECT_EQ(sheet.edges.size() + sheet.diagonals.size(), 39402u);
  EXPECT_EQ(sheet.triangles.size(), 3u * 2 * 99 * 99);
  const Beam beam = make_beam();
  EXPECT_NEAR(sum_of(beam.masses), 1000.0 * 8 / 30 * 7 / 30, 1e-3);
  EXPECT_EQ(beam.tetrahedra.size(), 10080u);
  EXPECT_EQ(beam.clamped.size(), 72u);
  EXPECT_EQ(beam.tip.size(), 72u);
  for (const Tetrahedron& t : beam.tetrahedra) EXPECT_NEAR(six_volumes(beam.vertices, t), 1.0 / 27000, 1e-12);
  EXPECT_NEAR(sum_of(make_rope().masses), 1.0, 1e-6);
}

TEST(SoftScene, GroupsHoldNoVertexTwice) {
  const Sheet sheet = make_sheet("hanging");
  std::vector<Pair> ordered = in_groups(sheet.edges, sheet.vertices.size());
  // Neighbours in the order share a vertex only where a group ends; in the order of the mesh nearly all do.
  int shared = 0;
  for (std::size_t i = 1; i < ordered.size(); ++i) {
    for (const std::uint32_t v : ordered[i]) shared += v == ordered[i - 1][0] || v == ordered[i - 1][1];
  }
  EXPECT_LE(shared, 8);
  std::vector<Pair> edges = sheet.edges;
  std::sort(edges.begin(), edges.end());
  std::sort(ordered.begin(), ordered.end());
  EXPECT_EQ(ordered, edges);
}

TEST(SoftJudge, MeasuresStrain) {
  std::vector<DVec3> stretched = make_sheet("hanging").vertices;
  for (DVec3& p : stretched) p.x *= 1.02;  // half of the edges lie along x
  SoftJudge judge("hanging");
  judge.observe(make_sheet("hanging").vertices, false);
  judge.observe(stretched, true);
  judge.observe(stretched, true);
  EXPECT_NEAR(figure(judge, "mean strain, %"), 1.0, 1e-6);
  EXPECT_NEAR(figure(judge, "largest strain, %"), 2.0, 1e-6);
}

TEST(SoftJudge, CountsCrossings) {
  // The half with positive x is folded over the other half; where it slopes, it goes through it.
  const auto folded = [](double slope) {
    std::vector<DVec3> now = make_sheet("folded").vertices;
    for (DVec3& p : now) {
      if (p.x > 0.0) p = {-p.x + 0.003, p.y + 0.05 - slope * (p.z + 1.0), p.z};
    }
    return now;
  };
  SoftJudge apart("folded"), through("folded");
  apart.observe(folded(0.0), true);
  through.observe(folded(0.05), true);
  EXPECT_EQ(figure(apart, "crossings"), 0.0);
  EXPECT_GT(figure(through, "crossings"), 50.0);  // a line of some 50 cells
}

TEST(SoftJudge, MeasuresTheSwingOfABeam) {
  const Beam beam = make_beam();
  constexpr double deflection = 0.2, period = 0.73, pi = 3.14159265358979;
  SoftJudge judge("beam");
  for (int i = 1; i <= 180; ++i) {
    std::vector<DVec3> now = beam.vertices;
    for (DVec3& p : now) p.y -= deflection * (1.0 - std::cos(2.0 * pi * i * double(kStep) / period)) * p.x;
    if (i == 100) std::swap(now[0], now[1]);  // turns the tetrahedra around the edge between them inside out
    judge.observe(now, i > 60);
  }
  EXPECT_NEAR(figure(judge, "tip, mm"), 200.0, 1.0);  // steps miss the extremes by as much
  EXPECT_NEAR(figure(judge, "period, s"), period, 1e-4);
  EXPECT_GT(figure(judge, "inverted"), 0.0);
}

}  // namespace
}  // namespace gyre::bench::soft_judge_test
