// cook_mesh: makes a Mesh from a definition, or reports why it cannot.
//
// Steps: check every number, weld vertices, drop triangles without area and duplicates, sort the rest by their tree,
// and connect them. Duplicates are triangles with the same three positions and the same winding.
#include "base/container/sort.h"
#include "base/float_mode.h"
#include "base/hash.h"
#include "geometry/shape/cooked.h"
#include "geometry/shape/flat_triangles.h"
#include "geometry/shape/mesh.h"
#include "geometry/shape/mesh_topology.h"
#include "geometry/shape/mesh_weld.h"

namespace gyre {
namespace {

Error check_mesh(const MeshDef& def) {
  if (def.indices.size() % 3 != 0) {
    return make_error(ErrorCode::invalid_geometry,
                      "mesh: %zu indices do not make whole triangles (three each)", def.indices.size());
  }
  const std::size_t triangles = def.indices.size() / 3;
  if (triangles > StaticTree::kMaxItems) {
    return make_error(ErrorCode::invalid_geometry, "mesh: %zu triangles; at most %u are allowed", triangles,
                      StaticTree::kMaxItems);
  }
  if (!def.materials.empty() && def.materials.size() != triangles) {
    return make_error(ErrorCode::invalid_geometry,
                      "mesh: %zu materials for %zu triangles; needs one each, or none", def.materials.size(),
                      triangles);
  }
  for (std::size_t i = 0; i < def.vertices.size(); ++i) {
    const Vec3 v = def.vertices[i];
    if (!is_finite(v)) {
      return make_error(ErrorCode::invalid_geometry, "mesh: vertex %zu is not finite (%g, %g, %g)", i,
                        double(v.x), double(v.y), double(v.z));
    }
    if (largest(absolute(v)) > kMaxSurfaceCoordinate) {
      return make_error(ErrorCode::invalid_geometry,
                        "mesh: vertex %zu (%g, %g, %g) is farther than %g m from the origin", i, double(v.x),
                        double(v.y), double(v.z), double(kMaxSurfaceCoordinate));
    }
  }
  for (std::size_t i = 0; i < def.indices.size(); ++i) {
    if (def.indices[i] >= def.vertices.size()) {
      return make_error(ErrorCode::invalid_geometry,
                        "mesh: triangle %zu uses vertex %u, but there are only %zu vertices", i / 3,
                        def.indices[i], def.vertices.size());
    }
  }
  return {};
}

// Drops all but the first of triangles with equal corners and equal winding.
void drop_doubles(TriangleList& triangles) {
  const std::size_t count = triangles.source.size();
  struct Corners {
    std::uint32_t a, b, c;
    bool operator==(const Corners&) const = default;
  };
  // The lowest corner first, with the same winding.
  const auto corners_of = [&](std::size_t triangle) {
    const std::uint32_t* i = triangles.indices.data() + 3 * triangle;
    if (i[0] < i[1] && i[0] < i[2]) return Corners{i[0], i[1], i[2]};
    if (i[1] < i[2]) return Corners{i[1], i[2], i[0]};
    return Corners{i[2], i[0], i[1]};
  };
  std::vector<std::uint64_t> keys(count), scratch_keys(count);
  std::vector<std::uint32_t> order(count), scratch(count);
  for (std::size_t i = 0; i < count; ++i) {
    const Corners corners = corners_of(i);
    keys[i] = hash_bytes(&corners, sizeof corners);
    order[i] = std::uint32_t(i);
  }
  radix_sort_pairs(keys, order, scratch_keys, scratch);
  std::vector<std::uint8_t> drop(count, 0);
  for (std::size_t begin = 0; begin < count;) {
    std::size_t end = begin + 1;
    for (; end < count && keys[end] == keys[begin]; ++end) {
      if (corners_of(order[end]) == corners_of(order[begin])) drop[order[end]] = 1;
    }
    begin = end;
  }
  TriangleList result;
  for (std::size_t i = 0; i < count; ++i) {
    if (drop[i] != 0) continue;
    for (std::size_t k = 0; k < 3; ++k) result.indices.push_back(triangles.indices[3 * i + k]);
    result.source.push_back(triangles.source[i]);
  }
  triangles = std::move(result);
}

// Builds the tree and copies the triangles in its order, then the vertices in the order of their first use.
void arrange(std::span<const Vec3> vertices, const TriangleList& triangles, Mesh& mesh) {
  const std::size_t count = triangles.source.size();
  std::vector<Aabb> boxes(count);
  for (std::size_t i = 0; i < count; ++i) {
    const Vec3 a = vertices[triangles.indices[3 * i]], b = vertices[triangles.indices[3 * i + 1]],
               c = vertices[triangles.indices[3 * i + 2]];
    boxes[i] = {min(a, min(b, c)), max(a, max(b, c))};
  }
  build_static_tree(boxes, mesh.tree);
  constexpr std::uint32_t kUnused = 0xffffffffu;
  std::vector<std::uint32_t> index_of(vertices.size(), kUnused);
  mesh.indices.reserve(3 * count);
  mesh.source.reserve(count);
  for (const std::uint32_t triangle : mesh.tree.items) {
    mesh.source.push_back(triangles.source[triangle]);
    for (std::size_t k = 0; k < 3; ++k) {
      const std::uint32_t vertex = triangles.indices[3 * std::size_t(triangle) + k];
      if (index_of[vertex] == kUnused) {
        index_of[vertex] = std::uint32_t(mesh.vertices.size());
        mesh.vertices.push_back(vertices[vertex]);
      }
      mesh.indices.push_back(index_of[vertex]);
    }
  }
  mesh.tree.items = {};
}

std::uint64_t hash_mesh(const Mesh& mesh) {
  Hasher hasher{std::uint64_t(ShapeKind::mesh)};
  hasher.add(std::uint64_t(mesh.double_sided ? 1 : 0));
  hasher.add(std::uint64_t(mesh.vertices.size()));
  hasher.add(std::as_bytes(std::span<const Vec3>(mesh.vertices)));
  hasher.add(std::as_bytes(std::span<const std::uint32_t>(mesh.indices)));
  for (const std::uint16_t material : mesh.materials) hasher.add(std::uint64_t(material));
  return hasher.value();
}

}  // namespace

Result<Geometry> cook_mesh(const MeshDef& def) {
  const FloatMode mode;
  if (const Error error = check_mesh(def)) return error;
  TriangleList triangles;
  if (!def.vertices.empty()) {
    triangles = without_flat_triangles(def.vertices, def.indices, weld_vertices(def.vertices, def.indices));
  }
  drop_doubles(triangles);
  if (triangles.source.empty()) {
    return make_error(ErrorCode::invalid_geometry, "mesh: none of its %zu triangles has an area",
                      def.indices.size() / 3);
  }
  auto mesh = std::make_unique<Mesh>();
  mesh->double_sided = def.double_sided;
  mesh->materials.assign(def.materials.begin(), def.materials.end());
  arrange(def.vertices, triangles, *mesh);
  connect_triangles(*mesh);
  auto cooked = std::make_shared<CookedGeometry>();
  cooked->kind = ShapeKind::mesh;
  cooked->content_hash = hash_mesh(*mesh);
  cooked->mesh = std::move(mesh);
  return Geometry(std::shared_ptr<const CookedGeometry>(std::move(cooked)));
}

}  // namespace gyre
