// Ropes, cloths and solids as triangles. See soft_mesh.h.
#include "render/soft_mesh.h"

#include "formats/turning.h"

#include <set>
#include <utility>

namespace gyre {

std::vector<Vec3> smooth_line(std::span<const Vec3> line, int pieces) {
  std::vector<Vec3> out;
  if (line.empty()) return out;
  for (std::size_t i = 0; i + 1 < line.size(); ++i) {
    const Vec3 a = line[i], b = line[i + 1];
    // Half the way between the neighbours; at an end along the first part.
    const Vec3 leave = i > 0 ? 0.5f * (b - line[i - 1]) : b - a;
    const Vec3 arrive = i + 2 < line.size() ? 0.5f * (line[i + 2] - a) : b - a;
    for (int k = 0; k < pieces; ++k) {
      const float t = float(k) / float(pieces), s = 1.0f - t;
      out.push_back(s * s * (1.0f + 2.0f * t) * a + s * s * t * leave + t * t * (1.0f + 2.0f * s) * b -
                    t * t * s * arrive);
    }
  }
  out.push_back(line.back());
  return out;
}

std::vector<TubePoint> capped_tube(const std::vector<Vec3>& line, float radius, int sides) {
  constexpr int kCapRings = 4;
  const std::vector<TubePoint> tube = tube_rings(line, radius, sides);
  const std::size_t a_ring = std::size_t(sides) + 1;
  std::vector<TubePoint> out;
  // A ring of the half ball over a ring of the tube; 0 is the tube's own, kCapRings the pole.
  const auto add_cap_ring = [&](std::size_t first, Vec3 middle, Vec3 outward, int ring) {
    const Turn turn = turn_of(0.5f * kHalfTurn * float(ring) / float(kCapRings));
    for (std::size_t k = 0; k < a_ring; ++k) {
      const Vec3 normal = turn.cosine * tube[first + k].normal + turn.sine * outward;
      out.push_back({middle + radius * normal, normal});
    }
  };
  const Vec3 start = normalized(line.front() - line[1], Vec3{0, 1, 0});
  const Vec3 end = normalized(line.back() - line[line.size() - 2], Vec3{0, 1, 0});
  for (int ring = kCapRings; ring > 0; --ring) add_cap_ring(0, line.front(), start, ring);
  out.insert(out.end(), tube.begin(), tube.end());
  for (int ring = 1; ring <= kCapRings; ++ring) add_cap_ring(tube.size() - a_ring, line.back(), end, ring);
  return out;
}

ShapeMesh solid_mesh(std::span<const Vec3> vertices, std::span<const std::uint32_t> triangles) {
  constexpr float kSharpCosine = 0.64f;
  return smooth_mesh(vertices, triangles, kSharpCosine);
}

namespace {

// Edges that only one triangle has, in its direction.
std::vector<std::pair<std::uint32_t, std::uint32_t>> rim_edges(std::span<const std::uint32_t> triangles) {
  std::set<std::pair<std::uint32_t, std::uint32_t>> edges;
  for (std::size_t i = 0; i < triangles.size(); ++i)
    edges.insert({triangles[i], triangles[i % 3 == 2 ? i - 2 : i + 1]});
  std::vector<std::pair<std::uint32_t, std::uint32_t>> rim;
  for (const auto& [a, b] : edges)
    if (edges.count({b, a}) == 0) rim.push_back({a, b});
  return rim;
}

}  // namespace

ClothMesh cloth_mesh(std::span<const Vec3> vertices, std::span<const std::uint32_t> triangles, float radius) {
  std::vector<Vec3> normals(vertices.size());
  for (std::size_t t = 0; t + 2 < triangles.size(); t += 3) {
    const std::uint32_t a = triangles[t], b = triangles[t + 1], c = triangles[t + 2];
    const Vec3 area = cross(vertices[b] - vertices[a], vertices[c] - vertices[a]);
    for (const std::uint32_t vertex : {a, b, c}) normals[vertex] = normals[vertex] + area;
  }
  ClothMesh mesh;
  for (std::size_t i = 0; i < vertices.size(); ++i) {
    const Vec3 normal = normalized(normals[i], Vec3{0, 1, 0});
    mesh.front.vertices.push_back({vertices[i] + radius * normal, normal});
    mesh.back.vertices.push_back({vertices[i] - radius * normal, -normal});
  }
  mesh.front.indices.assign(triangles.begin(), triangles.end());
  for (std::size_t t = 0; t + 2 < triangles.size(); t += 3)
    mesh.back.indices.insert(mesh.back.indices.end(), {triangles[t], triangles[t + 2], triangles[t + 1]});
  for (const auto& [a, b] : rim_edges(triangles)) {
    const Vec3 along = vertices[b] - vertices[a];
    const auto first = std::uint32_t(mesh.rim.vertices.size());
    for (const std::uint32_t vertex : {a, b}) {
      const MeshVertex &over = mesh.front.vertices[vertex], &under = mesh.back.vertices[vertex];
      const Vec3 outward = normalized(cross(along, over.normal), over.normal);
      mesh.rim.vertices.push_back({over.position, outward});
      mesh.rim.vertices.push_back({under.position, outward});
      mesh.rim_of.insert(mesh.rim_of.end(), {vertex, vertex});
    }
    mesh.rim.indices.insert(mesh.rim.indices.end(),
                            {first, first + 1, first + 3, first, first + 3, first + 2});
  }
  return mesh;
}

}  // namespace gyre
