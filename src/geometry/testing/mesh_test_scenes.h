// Surfaces and random numbers for the tests of meshes and height fields.
#pragma once

#include <gyre/geometry.h>

#include <cmath>
#include <cstdint>
#include <vector>

namespace gyre::test {

// A linear congruential generator, the same everywhere. (D. Knuth, MMIX.)
struct Random {
  std::uint64_t state = 1;
  float unit() {
    state = state * 6364136223846793005u + 1442695040888963407u;
    return float(state >> 40) * (1.0f / 16777216.0f);
  }
  float between(float low, float high) { return low + (high - low) * unit(); }
  Vec3 in_box(float half) { return {between(-half, half), between(-half, half), between(-half, half)}; }
  Vec3 direction() {
    for (;;) {
      const Vec3 v = in_box(1.0f);
      const float n = length_squared(v);
      if (n > 0.01f && n <= 1.0f) return normalized(v);
    }
  }
  Quat rotation() {
    for (;;) {
      const Quat q{between(-1, 1), between(-1, 1), between(-1, 1), between(-1, 1)};
      const float n = dot(q, q);
      if (n > 0.01f && n <= 1.0f) return normalized(q);
    }
  }
};

struct Triangles {
  std::vector<Vec3> vertices;
  std::vector<std::uint32_t> indices;

  std::uint32_t vertex(Vec3 v) {
    vertices.push_back(v);
    return std::uint32_t(vertices.size() - 1);
  }
  void triangle(std::uint32_t a, std::uint32_t b, std::uint32_t c) {
    indices.insert(indices.end(), {a, b, c});
  }
  void quad(Vec3 a, Vec3 b, Vec3 c, Vec3 d) {
    const std::uint32_t first = vertex(a);
    vertex(b), vertex(c), vertex(d);
    triangle(first, first + 1, first + 2);
    triangle(first, first + 2, first + 3);
  }
  Geometry cook(bool double_sided = false) const {
    Result<Geometry> made =
        cook_mesh({.vertices = vertices, .indices = indices, .double_sided = double_sided});
    return made ? *made : Geometry();
  }
};

// A grid over [-half, half] in x and z with heights from `height(x, z)`, cells of about the given size, facing up.
template <class Height>
Triangles grid(float half, float cell, Height&& height) {
  Triangles out;
  const int n = int(std::ceil(2.0f * half / cell));
  for (int j = 0; j <= n; ++j) {
    for (int i = 0; i <= n; ++i) {
      const float x = -half + float(i) * cell, z = -half + float(j) * cell;
      out.vertex({x, height(x, z), z});
    }
  }
  const auto at = [&](int i, int j) { return std::uint32_t(j * (n + 1) + i); };
  for (int j = 0; j < n; ++j) {
    for (int i = 0; i < n; ++i) {
      out.triangle(at(i, j), at(i, j + 1), at(i + 1, j));
      out.triangle(at(i + 1, j), at(i, j + 1), at(i + 1, j + 1));
    }
  }
  return out;
}

inline Triangles flat_grid(float half, float cell) {
  return grid(half, cell, [](float, float) { return 0.0f; });
}

// The twelve triangles of a box from `low` to `high`, facing outward.
inline void add_box(Triangles& out, Vec3 low, Vec3 high) {
  const auto corner = [&](int bits) {
    return Vec3{bits & 1 ? high.x : low.x, bits & 2 ? high.y : low.y, bits & 4 ? high.z : low.z};
  };
  const int faces[6][4] = {{0, 4, 6, 2}, {1, 3, 7, 5}, {0, 1, 5, 4},
                           {2, 6, 7, 3}, {0, 2, 3, 1}, {4, 5, 7, 6}};
  for (const auto& f : faces) out.quad(corner(f[0]), corner(f[1]), corner(f[2]), corner(f[3]));
}

}  // namespace gyre::test
