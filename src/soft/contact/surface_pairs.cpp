#include "soft/contact/surface_pairs.h"

#include "base/container/sort.h"
#include "geometry/distance/closest.h"

#include <cmath>

namespace gyre {

namespace {

constexpr std::uint64_t kEdgePairs = std::uint64_t(1) << 63;  // in keys

// Numbers of triangles and edges over all surfaces, for keys.
struct FeatureBase {
  std::uint32_t triangle = 0, edge = 0;
};

class PairSearch {
 public:
  PairSearch(std::span<const DVec3> positions, std::span<const float> pads, Array<SurfacePair>& pairs)
      : positions_(positions), pads_(pads), pairs_(pairs) {}

  void search(const SurfaceBoxes& a, FeatureBase base_a, const SurfaceBoxes& b, FeatureBase base_b) {
    same_ = &a == &b;
    if (same_ && !a.surface->self_collision) return;
    friction_[0] = mean_friction(a.surface->static_friction, b.surface->static_friction);
    friction_[1] = mean_friction(a.surface->dynamic_friction, b.surface->dynamic_friction);
    for_each_triangle_pair(a, b, [&](std::uint32_t i, std::uint32_t k) {
      try_corners(a, i, b, k, base_b);
      try_corners(b, k, a, i, base_a);
      try_edges(a, i, base_a, b, k, base_b);
    });
  }

 private:
  static float mean_friction(float a, float b) { return std::sqrt(a * b); }

  // Vertices that triangle i owns against triangle k.
  void try_corners(const SurfaceBoxes& a, std::uint32_t i, const SurfaceBoxes& b, std::uint32_t k,
                   FeatureBase base) {
    const SurfaceTriangle& from = a.surface->triangles[i];
    const std::uint32_t* const corner = b.surface->triangles[k].corner;
    for (unsigned c = 0; c < 3; ++c) {
      const std::uint32_t v = from.corner[c];
      if ((from.owned_corners >> c & 1u) == 0 || !overlap(a.vertices[v], b.triangles[k])) continue;
      if (same_ && (v == corner[0] || v == corner[1] || v == corner[2])) continue;
      const std::uint32_t at = a.first + v;
      const std::uint32_t on[3] = {b.first + corner[0], b.first + corner[1], b.first + corner[2]};
      const DVec3 p = positions_[at];
      const SimplexPoint closest =
          closest_on_triangle({}, positions_[on[0]] - p, positions_[on[1]] - p, positions_[on[2]] - p);
      const double reach = double(pads_[at] + max(pads_[on[0]], max(pads_[on[1]], pads_[on[2]])));
      if (length_squared(closest.point) > reach * reach) continue;
      SurfacePair& pair = pairs_.emplace_back();
      pair.key = std::uint64_t(at) << 32 | (base.triangle + k);
      pair.on_a = 1;
      pair.vertex[0] = at;
      pair.weight[0] = 1.0f;
      for (int n = 0; n < 3; ++n) {
        pair.vertex[n + 1] = on[n];
        pair.weight[n + 1] = -float(closest.weights[n]);
      }
      pair.touches = touches_triangle(p, closest, b, k);
      const DVec3 face = cross(positions_[on[1]] - positions_[on[0]], positions_[on[2]] - positions_[on[0]]);
      finish(pair, -closest.point, face, a, b);
    }
  }

  // True if no other triangle of b has a point nearer to p than the closest point of triangle k, and k is the first that has it.
  bool touches_triangle(DVec3 p, const SimplexPoint& closest, const SurfaceBoxes& b, std::uint32_t k) const {
    const SurfaceTriangle& one = b.surface->triangles[k];
    const auto at = [&](std::uint32_t v) { return positions_[b.first + v] - p; };  // relative to p
    const DVec3 away = -closest.point;
    if (closest.corners == 7) return true;
    for (unsigned c = 0; c < 3; ++c) {
      const unsigned next = c == 2 ? 0 : c + 1;
      if (closest.corners == (1u << c)) {
        if ((one.owned_corners >> c & 1u) == 0) return false;
        const std::uint32_t v = one.corner[c];
        for (std::uint32_t n = b.surface->around_begin[v]; n < b.surface->around_begin[v + 1]; ++n) {
          if (dot(away, at(b.surface->around[n]) - at(v)) > 0.0) return false;
        }
        return true;
      }
      if (closest.corners == (1u << c | 1u << next)) {
        if (one.neighbour[c] < 0) return true;
        if (std::uint32_t(one.neighbour[c]) < k) return false;
        const SurfaceTriangle& other = b.surface->triangles[one.neighbour[c]];
        for (const std::uint32_t v : other.corner) {
          if (v != one.corner[c] && v != one.corner[next] && dot(away, at(v) - closest.point) > 0.0)
            return false;
        }
        return true;
      }
    }
    return true;
  }

  void try_edges(const SurfaceBoxes& a, std::uint32_t i, FeatureBase base_a, const SurfaceBoxes& b,
                 std::uint32_t k, FeatureBase base_b) {
    for (const std::int32_t one : a.surface->triangles[i].owned_edge) {
      if (one < 0) continue;
      const SurfaceEdge e = a.surface->edges[one];
      const Aabb box = merge(a.vertices[e.a], a.vertices[e.b]);
      if (!overlap(box, b.triangles[k])) continue;
      for (const std::int32_t other : b.surface->triangles[k].owned_edge) {
        if (other < 0) continue;
        const SurfaceEdge f = b.surface->edges[other];
        if (same_ && (e.a == f.a || e.a == f.b || e.b == f.a || e.b == f.b)) continue;
        if (!overlap(box, merge(b.vertices[f.a], b.vertices[f.b]))) continue;
        const bool swap = same_ && other < one;
        if (swap)
          add_edges(b, f, base_b.edge + std::uint32_t(other), a, e, base_a.edge + std::uint32_t(one));
        else
          add_edges(a, e, base_a.edge + std::uint32_t(one), b, f, base_b.edge + std::uint32_t(other));
      }
    }
  }

  void add_edges(const SurfaceBoxes& a, SurfaceEdge e, std::uint32_t number_a, const SurfaceBoxes& b,
                 SurfaceEdge f, std::uint32_t number_b) {
    const std::uint32_t v[4] = {a.first + e.a, a.first + e.b, b.first + f.a, b.first + f.b};
    const DVec3 origin = positions_[v[0]];
    const DVec3 along = positions_[v[1]] - origin, p = positions_[v[2]] - origin,
                q = positions_[v[3]] - origin;
    const SegmentPair closest = closest_of_segments({}, along, p, q);
    const DVec3 apart = closest.on_a - closest.on_b;
    const double reach = double(max(pads_[v[0]], pads_[v[1]]) + max(pads_[v[2]], pads_[v[3]]));
    if (length_squared(apart) > reach * reach) return;
    SurfacePair& pair = pairs_.emplace_back();
    pair.key = kEdgePairs | std::uint64_t(number_a) << 32 | number_b;
    pair.on_a = 2;
    for (int n = 0; n < 4; ++n) pair.vertex[n] = v[n];
    pair.weight[1] = float(closest.s), pair.weight[0] = 1.0f - pair.weight[1];
    pair.weight[3] = -float(closest.t), pair.weight[2] = -1.0f - pair.weight[3];
    pair.touches = closest.s > 0.0 && closest.s < 1.0 && closest.t > 0.0 && closest.t < 1.0;
    finish(pair, apart, cross(along, q - p), a, b);
  }

  // `other` is the direction where the features touch.
  void finish(SurfacePair& pair, DVec3 apart, DVec3 other, const SurfaceBoxes& a, const SurfaceBoxes& b) {
    pair.distance = length(apart);
    if (pair.distance > 0.0) {
      pair.normal = apart / pair.distance;
    } else {
      const double size = length(other);
      pair.normal = size > 0.0 ? other / size : DVec3{0.0, 1.0, 0.0};
    }
    for (int n = 0; n < 4; ++n) {
      const SurfaceBoxes& side = n < pair.on_a ? a : b;
      pair.thickness += absolute(pair.weight[n]) * side.surface->radius[pair.vertex[n] - side.first];
    }
    pair.friction[0] = friction_[0], pair.friction[1] = friction_[1];
  }

  std::span<const DVec3> positions_;
  std::span<const float> pads_;
  Array<SurfacePair>& pairs_;
  bool same_ = false;
  float friction_[2] = {};
};

void sort_by_key(Array<SurfacePair>& pairs, Arena& arena) {
  const std::size_t count = pairs.size();
  const std::span<std::uint64_t> keys = arena.make<std::uint64_t>(count),
                                 more_keys = arena.make<std::uint64_t>(count);
  const std::span<std::uint32_t> order = arena.make<std::uint32_t>(count),
                                 more = arena.make<std::uint32_t>(count);
  const std::span<SurfacePair> copy = arena.make<SurfacePair>(count);
  for (std::size_t i = 0; i < count; ++i) {
    keys[i] = pairs[i].key;
    order[i] = std::uint32_t(i);
    copy[i] = pairs[i];
  }
  radix_sort_pairs(keys, order, more_keys, more);
  for (std::size_t i = 0; i < count; ++i) pairs[i] = copy[order[i]];
}

}  // namespace

void find_surface_pairs(std::span<const PlacedSurface> surfaces, std::span<const DVec3> positions,
                        std::span<const float> pads, Arena& arena, Array<SurfacePair>& pairs) {
  const ArenaScope scope(arena);
  pairs.clear();
  if (surfaces.empty() || positions.empty()) return;
  const DVec3 origin = positions[surfaces[0].first];
  const std::span<SurfaceBoxes> boxes = arena.make<SurfaceBoxes>(surfaces.size());
  const std::span<FeatureBase> bases = arena.make<FeatureBase>(surfaces.size());
  FeatureBase base;
  for (std::size_t i = 0; i < surfaces.size(); ++i) {
    boxes[i] = fit_boxes(surfaces[i], positions, pads, origin, arena);
    bases[i] = base;
    base.triangle += std::uint32_t(surfaces[i].surface->triangles.size());
    base.edge += std::uint32_t(surfaces[i].surface->edges.size());
  }
  PairSearch search(positions, pads, pairs);
  for (std::size_t i = 0; i < boxes.size(); ++i) {
    for (std::size_t k = i; k < boxes.size(); ++k) search.search(boxes[i], bases[i], boxes[k], bases[k]);
  }
  sort_by_key(pairs, arena);
}

}  // namespace gyre
