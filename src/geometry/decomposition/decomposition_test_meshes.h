// Meshes by formula for the tests of decomposition: boxes, bodies of revolution, prisms over star-shaped outlines,
// tubes.
#pragma once

#include <gyre/decomposition.h>

#include <cmath>
#include <cstdint>
#include <utility>
#include <vector>

namespace gyre {

struct TestMesh {
  std::vector<Vec3> vertices;
  std::vector<std::uint32_t> indices;

  void add(std::uint32_t a, std::uint32_t b, std::uint32_t c) {
    for (const std::uint32_t i : {a, b, c}) indices.push_back(i);
  }
  double volume() const {
    double sum = 0.0;
    for (std::size_t i = 0; i < indices.size(); i += 3)
      sum += dot(DVec3(vertices[indices[i]]),
                 cross(DVec3(vertices[indices[i + 1]]), DVec3(vertices[indices[i + 2]]))) /
             6.0;
    return sum;
  }
  double area() const {
    double sum = 0.0;
    for (std::size_t i = 0; i < indices.size(); i += 3) {
      const DVec3 a(vertices[indices[i]]);
      sum += 0.5 * length(cross(DVec3(vertices[indices[i + 1]]) - a, DVec3(vertices[indices[i + 2]]) - a));
    }
    return sum;
  }
  void flip() {
    for (std::size_t i = 0; i < indices.size(); i += 3) std::swap(indices[i + 1], indices[i + 2]);
  }
  void add(const TestMesh& other) {
    const std::uint32_t base = std::uint32_t(vertices.size());
    vertices.insert(vertices.end(), other.vertices.begin(), other.vertices.end());
    for (const std::uint32_t i : other.indices) indices.push_back(base + i);
  }
  DecompositionDef def() const {
    DecompositionDef out;
    out.vertices = vertices;
    out.indices = indices;
    out.concavity = 0.04f;
    return out;
  }
};

inline TestMesh outward(TestMesh mesh) {
  if (mesh.volume() < 0.0) mesh.flip();
  return mesh;
}

inline TestMesh moved(TestMesh mesh, const Transform& t, float scale = 1.0f) {
  for (Vec3& v : mesh.vertices) v = t * (scale * v);
  return mesh;
}

inline TestMesh box_mesh(Vec3 center, Vec3 half) {
  TestMesh mesh;
  for (int i = 0; i < 8; ++i) {
    mesh.vertices.push_back(center + Vec3{(i & 1) != 0 ? half.x : -half.x, (i & 2) != 0 ? half.y : -half.y,
                                          (i & 4) != 0 ? half.z : -half.z});
  }
  const std::uint32_t quads[6][4] = {{0, 2, 3, 1}, {4, 5, 7, 6}, {0, 1, 5, 4},
                                     {2, 6, 7, 3}, {0, 4, 6, 2}, {1, 3, 7, 5}};
  for (const auto& q : quads) {
    mesh.add(q[0], q[1], q[2]);
    mesh.add(q[0], q[2], q[3]);
  }
  return mesh;
}

// A plate of cells between the lines, without those for which `open` holds: a slab or a grate, closed.
template <class Open>
TestMesh cell_plate(const std::vector<float>& lines, float thickness, Open&& open) {
  TestMesh mesh;
  const int count = int(lines.size()) - 1;
  const auto vertex = [&](int i, int j, int side) { return std::uint32_t(2 * (i * (count + 1) + j) + side); };
  for (const float x : lines) {
    for (const float z : lines) {
      mesh.vertices.push_back({x, 0, z});
      mesh.vertices.push_back({x, thickness, z});
    }
  }
  const auto full = [&](int i, int j) { return i >= 0 && j >= 0 && i < count && j < count && !open(i, j); };
  const auto quad = [&](std::uint32_t a, std::uint32_t b, std::uint32_t c, std::uint32_t e) {
    mesh.add(a, b, c);
    mesh.add(a, c, e);
  };
  for (int i = 0; i < count; ++i) {
    for (int j = 0; j < count; ++j) {
      if (!full(i, j)) continue;
      quad(vertex(i, j, 1), vertex(i, j + 1, 1), vertex(i + 1, j + 1, 1), vertex(i + 1, j, 1));
      quad(vertex(i, j, 0), vertex(i + 1, j, 0), vertex(i + 1, j + 1, 0), vertex(i, j + 1, 0));
      const int walls[4][6] = {
          {-1, 0, 0, 0, 0, 1}, {1, 0, 1, 1, 1, 0}, {0, -1, 1, 0, 0, 0}, {0, 1, 0, 1, 1, 1}};
      for (const auto& w : walls) {
        if (full(i + w[0], j + w[1])) continue;
        const int ai = i + w[2], aj = j + w[3], bi = i + w[4], bj = j + w[5];
        quad(vertex(ai, aj, 0), vertex(bi, bj, 0), vertex(bi, bj, 1), vertex(ai, aj, 1));
      }
    }
  }
  return mesh;
}

struct Point2f {
  float x, y;
};

// The outline (radius, height) about the y axis; closed back to its first point, or left open.
inline TestMesh revolved(const std::vector<Point2f>& outline, int segments, bool closed = true) {
  TestMesh mesh;
  const int n = int(outline.size());
  for (int s = 0; s < segments; ++s) {
    const double angle = 6.283185307179586 * s / segments;
    for (const Point2f& p : outline)
      mesh.vertices.push_back({p.x * float(std::cos(angle)), p.y, p.x * float(std::sin(angle))});
  }
  for (int s = 0; s < segments; ++s) {
    for (int i = 0; i < (closed ? n : n - 1); ++i) {
      const int j = (i + 1) % n, t = (s + 1) % segments;
      const auto at = [&](int segment, int k) { return std::uint32_t(segment * n + k); };
      if (outline[std::size_t(i)].x > 0.0f) mesh.add(at(s, i), at(t, i), at(t, j));
      if (outline[std::size_t(j)].x > 0.0f) mesh.add(at(s, i), at(t, j), at(s, j));
    }
  }
  return outward(mesh);
}

inline TestMesh torus_mesh(float ring, float tube, int around = 32, int across = 16) {
  std::vector<Point2f> outline;
  for (int i = 0; i < across; ++i) {
    const double angle = 6.283185307179586 * i / across;
    outline.push_back({ring + tube * float(std::cos(angle)), tube * float(std::sin(angle))});
  }
  return revolved(outline, around);
}

// A prism along z over an outline that is visible from `center` all around.
inline TestMesh prism_mesh(const std::vector<Point2f>& outline, Point2f center, float half_height) {
  TestMesh mesh;
  const std::uint32_t n = std::uint32_t(outline.size());
  for (const float z : {-half_height, half_height}) {
    for (const Point2f& p : outline) mesh.vertices.push_back({p.x, p.y, z});
    mesh.vertices.push_back({center.x, center.y, z});
  }
  for (std::uint32_t i = 0; i < n; ++i) {
    const std::uint32_t j = (i + 1) % n, top = n + 1;
    mesh.add(i, j, top + j);
    mesh.add(i, top + j, top + i);
    mesh.add(n, j, i);
    mesh.add(top + n, top + i, top + j);
  }
  return outward(mesh);
}

inline TestMesh beam_mesh() {
  return prism_mesh({{0, 0}, {1, 0}, {1, 0.3f}, {0.3f, 0.3f}, {0.3f, 1}, {0, 1}}, {0.15f, 0.15f}, 0.4f);
}

inline TestMesh gear_mesh(int teeth) {
  std::vector<Point2f> outline;
  for (int i = 0; i < 4 * teeth; ++i) {
    const double angle = 6.283185307179586 * (i + 0.5) / (4 * teeth);
    const float radius = i % 4 < 2 ? 1.0f : 0.75f;
    outline.push_back({radius * float(std::cos(angle)), radius * float(std::sin(angle))});
  }
  return prism_mesh(outline, {0, 0}, 0.2f);
}

// A beaker with a wall, open above.
inline TestMesh beaker_mesh(int segments = 24) {
  return revolved({{0, -0.5f}, {0.45f, -0.5f}, {0.45f, 0.5f}, {0.38f, 0.5f}, {0.38f, -0.42f}, {0, -0.42f}},
                  segments);
}

// A beaker with a handle that enters its wall: two closed surfaces that intersect.
inline TestMesh mug_mesh() {
  TestMesh mesh = beaker_mesh();
  TestMesh handle;
  constexpr int kAlong = 16, kAcross = 8;
  for (int i = 0; i <= kAlong; ++i) {
    const double along = -0.5 * 3.14159265358979 + 3.14159265358979 * i / kAlong;
    for (int k = 0; k < kAcross; ++k) {
      const double across = 6.283185307179586 * k / kAcross;
      const double radius = 0.28 + 0.06 * std::cos(across);
      handle.vertices.push_back({0.41f + float(radius * std::cos(along)), float(radius * std::sin(along)),
                                 float(0.06 * std::sin(across))});
    }
  }
  const auto at = [](int i, int k) { return std::uint32_t(i * kAcross + k % kAcross); };
  for (int i = 0; i < kAlong; ++i) {
    for (int k = 0; k < kAcross; ++k) {
      handle.add(at(i, k), at(i, k + 1), at(i + 1, k + 1));
      handle.add(at(i, k), at(i + 1, k + 1), at(i + 1, k));
    }
  }
  for (int k = 1; k + 1 < kAcross; ++k) {
    handle.add(at(0, 0), at(0, k + 1), at(0, k));
    handle.add(at(kAlong, 0), at(kAlong, k), at(kAlong, k + 1));
  }
  mesh.add(outward(handle));
  return mesh;
}

// Half a sphere without thickness, open above.
inline TestMesh bowl_sheet(int segments = 24) {
  std::vector<Point2f> outline;
  for (int i = 0; i <= 8; ++i) {
    const double angle = 1.5707963267948966 * i / 8;
    outline.push_back({i == 0 ? 0.0f : float(std::sin(angle)), -float(std::cos(angle))});
  }
  return revolved(outline, segments, false);
}

}  // namespace gyre
