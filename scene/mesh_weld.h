// Corners of triangles to a mesh in which equal points are one vertex: STL names every corner by its coordinates.
#pragma once

#include "scene/mesh_file.h"

#include <cstddef>
#include <map>
#include <tuple>
#include <utility>

namespace gyre {

class MeshWeld {
 public:
  void add(Vec3 corner) {
    corner = corner + Vec3{};  // one sign of zero
    const auto [at, is_new] =
        places_.try_emplace({corner.x, corner.y, corner.z}, std::uint32_t(mesh_.vertices.size()));
    if (is_new) mesh_.vertices.push_back(corner);
    mesh_.indices.push_back(at->second);
  }
  std::size_t corners() const { return mesh_.indices.size(); }
  MeshData take() { return std::move(mesh_); }

 private:
  MeshData mesh_;
  std::map<std::tuple<float, float, float>, std::uint32_t> places_;
};

}  // namespace gyre
