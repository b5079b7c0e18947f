// Closed surfaces for the tests of the tetrahedral fill, besides those of the decomposition's tests. Square roots are the only functions
// here, so that every platform makes the same bits.
#pragma once

#include "geometry/decomposition/decomposition_test_meshes.h"

#include <map>
#include <vector>

namespace gyre {

// The unit sphere: an octahedron, each triangle cut into four `levels` times.
inline TestMesh ball_mesh(int levels) {
  TestMesh mesh;
  mesh.vertices = {{1, 0, 0}, {-1, 0, 0}, {0, 1, 0}, {0, -1, 0}, {0, 0, 1}, {0, 0, -1}};
  for (const std::uint32_t x : {0u, 1u}) {
    for (const std::uint32_t y : {2u, 3u}) {
      for (const std::uint32_t z : {4u, 5u}) {
        if ((x + y + z) % 2 == 0) mesh.add(x, y, z);
        if ((x + y + z) % 2 != 0) mesh.add(x, z, y);
      }
    }
  }
  for (int level = 0; level < levels; ++level) {
    std::map<std::pair<std::uint32_t, std::uint32_t>, std::uint32_t> middles;
    const auto middle = [&](std::uint32_t a, std::uint32_t b) {
      const auto [at, is_new] =
          middles.try_emplace({std::min(a, b), std::max(a, b)}, std::uint32_t(mesh.vertices.size()));
      if (is_new) mesh.vertices.push_back(normalized(mesh.vertices[a] + mesh.vertices[b]));
      return at->second;
    };
    std::vector<std::uint32_t> before;
    before.swap(mesh.indices);
    for (std::size_t i = 0; i < before.size(); i += 3) {
      const std::uint32_t a = before[i], b = before[i + 1], c = before[i + 2];
      const std::uint32_t ab = middle(a, b), bc = middle(b, c), ca = middle(c, a);
      mesh.add(a, ab, ca);
      mesh.add(ab, b, bc);
      mesh.add(ca, bc, c);
      mesh.add(ab, bc, ca);
    }
  }
  return outward(mesh);
}

// A ball with bumps in some directions: each a reach beyond the ball and the square of its width.
struct Bump {
  Vec3 direction;
  float reach, width;
};
inline TestMesh bumpy_mesh(int levels, const std::vector<Bump>& bumps) {
  TestMesh mesh = ball_mesh(levels);
  for (Vec3& v : mesh.vertices) {
    float radius = 1.0f;
    for (const Bump& bump : bumps) {
      const float near = max(1.0f - length_squared(v - normalized(bump.direction)) / bump.width, 0.0f);
      radius += bump.reach * near * near;
    }
    v = radius * v;
  }
  return mesh;
}

// A belly with a head, two long ears, two feet and a tail.
inline TestMesh bunny_mesh(int levels) {
  return bumpy_mesh(levels, {{{0.6f, 1.0f, 0.0f}, 0.5f, 0.6f},
                             {{0.35f, 1.0f, 0.35f}, 1.0f, 0.06f},
                             {{0.35f, 1.0f, -0.35f}, 1.0f, 0.06f},
                             {{0.5f, -0.8f, 0.6f}, 0.4f, 0.2f},
                             {{0.5f, -0.8f, -0.6f}, 0.4f, 0.2f},
                             {{-1.0f, -0.2f, 0.0f}, 0.3f, 0.1f}});
}

}  // namespace gyre
