#include "soft/store/soft_point.h"

#include "geometry/distance/closest.h"

namespace gyre {

std::uint32_t element_count(const SoftEntry& entry) {
  if (entry.kind == SoftKind::cloth) return std::uint32_t(entry.triangles.size() / 3);
  if (!entry.damage.empty()) return std::uint32_t(entry.damage.corners.size() / 4);
  return std::uint32_t(entry.body.continuum.tetrahedra.size()) * kTetLanes;
}

ElementCorners corners_of(const SoftEntry& entry, std::uint32_t element) {
  ElementCorners out;
  if (element >= element_count(entry)) return out;
  const bool is_cloth = entry.kind == SoftKind::cloth;
  if (is_cloth || !entry.damage.empty()) {
    const Array<std::uint32_t>& all = is_cloth ? entry.triangles : entry.damage.corners;
    out.count = is_cloth ? 3 : 4;
    for (int k = 0; k < out.count; ++k)
      out.corner[k] = all[element * std::uint32_t(out.count) + std::uint32_t(k)];
    return out;
  }
  const TetBlock& block = entry.body.continuum.tetrahedra[element / kTetLanes];
  const std::uint32_t lane = element % kTetLanes;
  if (!(block.volume[lane] > 0.0f)) return out;
  out.count = 4;
  for (int k = 0; k < 4; ++k) out.corner[k] = std::uint32_t(block.corner[k][lane]);
  return out;
}

DVec3 place_of(const SoftEntry& entry, const SoftPointAttachment& point) {
  const ElementCorners corners = corners_of(entry, point.element);
  DVec3 sum{};
  for (int k = 0; k < corners.count; ++k)
    sum += double(point.weight[k]) * entry.body.particles.place(int(corners.corner[k]));
  return sum;
}

bool find_element(const SoftEntry& entry, const SoftPoint& point, SoftPointAttachment& out) {
  for (std::uint32_t element = 0; element < element_count(entry); ++element) {
    const ElementCorners corners = corners_of(entry, element);
    bool has_all = corners.count > 0;
    for (std::size_t k = 0; k < 4; ++k)
      has_all = has_all && (point.weights[k] == 0.0f || corners.has(std::uint32_t(point.vertices[k])));
    if (!has_all) continue;
    out.element = element;
    for (int k = 0; k < corners.count; ++k) {
      out.weight[k] = 0.0f;
      for (std::size_t n = 0; n < 4; ++n)
        if (point.weights[n] != 0.0f && corners.corner[k] == std::uint32_t(point.vertices[n]))
          out.weight[k] = point.weights[n];
    }
    return true;
  }
  return false;
}

SoftPoint find_nearest_point(const SoftEntry& entry, DVec3 place) {
  SoftPoint out;
  double nearest = -1.0;
  for (std::uint32_t element = 0; element < element_count(entry); ++element) {
    const ElementCorners corners = corners_of(entry, element);
    if (corners.count == 0) continue;
    DVec3 at[4];
    for (int k = 0; k < corners.count; ++k) at[k] = entry.body.particles.place(int(corners.corner[k]));
    const SimplexPoint found = corners.count == 3 ? closest_on_triangle(place, at[0], at[1], at[2])
                                                  : closest_on_tetrahedron(place, at[0], at[1], at[2], at[3]);
    const double apart = length_squared(found.point - place);
    if (nearest >= 0.0 && !(apart < nearest)) continue;
    nearest = apart;
    out = {};
    for (std::size_t k = 0; k < std::size_t(corners.count); ++k) {
      out.vertices[k] = int(corners.corner[k]);
      out.weights[k] = float(found.weights[k]);
    }
  }
  return out;
}

}  // namespace gyre
