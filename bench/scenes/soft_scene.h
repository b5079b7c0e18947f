// Scenes of soft matter that every engine gets alike: hanging and folded (a sheet), beam, rope. bench/soft runs them.
//
// SI units; y is up; steps of 1/60 s; gravity of 9.81 m/s^2. Hanging things start at height 0.
// Engines that move floats in small sub-steps lose gravity to rounding far from it: 10 m high and with 80 sub-steps a step, a rope never starts to fall.
#pragma once

#include <gyre/math.h>

#include <array>
#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

namespace gyre::bench::soft {

inline constexpr float kStep = 1.0f / 60.0f;  // s
inline constexpr float kGravity = -9.81f;     // m/s^2
inline constexpr float kFriction = 0.4f;      // of sheets on bodies

using Pair = std::array<std::uint32_t, 2>;
using Tetrahedron = std::array<std::uint32_t, 4>;

// A square of 2 m and 0.8 kg, 100 x 100 vertices, flat. Vertex i + 100 j is at column i and row j.
// "hanging": held at the two ends of row 0. "folded": dropped on a ball that lies on a floor.
struct Sheet {
  static constexpr std::uint32_t kSide = 100;
  static constexpr double kSize = 2.0;  // m
  static constexpr double kSpacing = kSize / (kSide - 1);
  static constexpr float kAreaDensity = 0.2f;  // kg/m^2
  static constexpr float kThickness = 0.005f;  // m
  static constexpr std::uint32_t kHeld[2] = {0, kSide - 1};
  static constexpr float kBallHeight = 0.5f, kBallRadius = 0.25f;  // m; the floor is at 0

  bool held = true;
  std::vector<DVec3> vertices;
  std::vector<float> masses;  // kg: a quarter of the area of each cell at the vertex
  std::vector<Pair> edges;    // along rows and columns
  std::vector<Pair> diagonals;
  std::vector<std::uint32_t> triangles;
};
Sheet make_sheet(const std::string& scene);

// A beam of 1 m, 0.267 m high and 0.233 m wide, of 30 x 8 x 7 cells with six tetrahedra each, clamped at x = 0.
struct Beam {
  static constexpr float kDensity = 1000.0f, kYoungModulus = 1.0e6f, kPoissonRatio = 0.3f;  // kg/m^3, Pa

  std::vector<DVec3> vertices;
  std::vector<float> masses;  // kg: a quarter of each tetrahedron at the vertex
  std::vector<Tetrahedron> tetrahedra;
  std::vector<std::uint32_t> clamped, tip;  // vertices at x = 0 and at x = 1 m
};
Beam make_beam();
double six_volumes(const std::vector<DVec3>& vertices, const Tetrahedron& t);

// A rope of 10 m and 1,000 vertices, level, held at one end.
struct Rope {
  static constexpr std::uint32_t kVertices = 1000;
  static constexpr double kLength = 10.0;         // m
  static constexpr float kLinearDensity = 0.1f;   // kg/m
  static constexpr float kBendStiffness = 0.01f;  // N m^2
  std::vector<DVec3> vertices;
  std::vector<float> masses;
};
Rope make_rope();

// Pairs in groups, in each of which no vertex occurs twice, one group after another: the order that engines of constraints want. Greedy.
template <std::size_t N>
std::vector<std::array<std::uint32_t, N>> in_groups(const std::vector<std::array<std::uint32_t, N>>& elements,
                                                    std::size_t vertices) {
  std::vector<std::vector<std::array<std::uint32_t, N>>> groups;
  std::vector<std::uint64_t> taken(vertices, 0);  // a bit for each group
  for (const auto& element : elements) {
    std::uint64_t used = 0;
    for (const std::uint32_t v : element) used |= taken[v];
    std::size_t group = 0;
    while (used >> group & 1) ++group;
    for (const std::uint32_t v : element) taken[v] |= std::uint64_t(1) << group;
    if (group >= groups.size()) groups.resize(group + 1);
    groups[group].push_back(element);
  }
  std::vector<std::array<std::uint32_t, N>> ordered;
  for (const auto& group : groups) ordered.insert(ordered.end(), group.begin(), group.end());
  return ordered;
}

}  // namespace gyre::bench::soft
