// Ropes, cloths and solids as triangles. See soft_mesh.h.
#include "render/soft_mesh.h"

#include "render/turning.h"

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

ShapeMesh soft_surface_mesh(std::span<const Vec3> vertices, std::span<const std::uint32_t> triangles,
                            bool sharp_edges) {
  constexpr float kSharpCosine = 0.64f;
  constexpr float kNever = -2.0f;
  return smooth_mesh(vertices, triangles, sharp_edges ? kSharpCosine : kNever);
}

}  // namespace gyre
