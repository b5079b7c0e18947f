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
  PairSearch(std::span<const DVec3> positions, std::span<const float> limits, std::span<const float> radii,
             float least_gap, Array<SurfacePair>& pairs)
      : positions_(positions), limits_(limits), radii_(radii), least_gap_(double(least_gap)), pairs_(pairs) {}

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
  // True if `way` leads toward `away`, by more than what flat surfaces may by rounding.
  static bool leads_toward(DVec3 way, DVec3 away) {
    constexpr double kFlat = 1.0e-3;  // of the product of both lengths
    const double along = dot(way, away);
    return along > 0.0 && square(along) > square(kFlat) * length_squared(way) * length_squared(away);
  }
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
      const double limit = double(limits_[at] + max(limits_[on[0]], max(limits_[on[1]], limits_[on[2]])));
      const double radius = double(radii_[at] + max(radii_[on[0]], max(radii_[on[1]], radii_[on[2]])));
      const double far = length_squared(closest.point);
      if (far > square(limit + radius)) continue;
      const bool touches = touches_triangle(p, closest, b, k);
      if (!touches && far > square(limit + least_gap_ * radius)) continue;
      SurfacePair& pair = pairs_.emplace_back();
      pair.key = std::uint64_t(at) << 32 | (base.triangle + k);
      pair.on_a = 1;
      pair.vertex[0] = at;
      pair.weight[0] = 1.0f;
      for (int n = 0; n < 3; ++n) {
        pair.vertex[n + 1] = on[n];
        pair.weight[n + 1] = -float(closest.weights[n]);
      }
      pair.touches = touches;
      const DVec3 face = cross(positions_[on[1]] - positions_[on[0]], positions_[on[2]] - positions_[on[0]]);
      finish(pair, -closest.point, face);
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
          if (leads_toward(at(b.surface->around[n]) - at(v), away)) return false;
        }
        return true;
      }
      if (closest.corners == (1u << c | 1u << next)) {
        if (one.neighbour[c] < 0) return true;
        if (std::uint32_t(one.neighbour[c]) < k) return false;
        const SurfaceTriangle& other = b.surface->triangles[one.neighbour[c]];
        for (const std::uint32_t v : other.corner) {
          if (v != one.corner[c] && v != one.corner[next] && leads_toward(at(v) - closest.point, away))
            return false;
        }
        return true;
      }
    }
    return true;
  }

  // An edge by the triangle that owns it.
  struct OwnedEdge {
    const SurfaceBoxes* boxes;
    std::uint32_t triangle;
    int side;              // of the triangle: from corner side to the next
    std::uint32_t number;  // over all surfaces

    SurfaceEdge ends() const {
      return boxes->surface->edges[boxes->surface->triangles[triangle].owned_edge[side]];
    }
  };

  void try_edges(const SurfaceBoxes& a, std::uint32_t i, FeatureBase base_a, const SurfaceBoxes& b,
                 std::uint32_t k, FeatureBase base_b) {
    for (int side = 0; side < 3; ++side) {
      const std::int32_t one = a.surface->triangles[i].owned_edge[side];
      if (one < 0) continue;
      const SurfaceEdge e = a.surface->edges[one];
      const Aabb box = merge(a.vertices[e.a], a.vertices[e.b]);
      if (!overlap(box, b.triangles[k])) continue;
      for (int other_side = 0; other_side < 3; ++other_side) {
        const std::int32_t other = b.surface->triangles[k].owned_edge[other_side];
        if (other < 0) continue;
        const SurfaceEdge f = b.surface->edges[other];
        if (same_ && (e.a == f.a || e.a == f.b || e.b == f.a || e.b == f.b)) continue;
        if (!overlap(box, merge(b.vertices[f.a], b.vertices[f.b]))) continue;
        const OwnedEdge first{&a, i, side, base_a.edge + std::uint32_t(one)};
        const OwnedEdge second{&b, k, other_side, base_b.edge + std::uint32_t(other)};
        if (first.number < second.number)
          add_edges(first, second);
        else
          add_edges(second, first);
      }
    }
  }

  // True if no triangle at the edge leads from its point `at` toward `away`, where a nearer point would be.
  bool touches_edge(const OwnedEdge& edge, DVec3 at, DVec3 away) const {
    const SoftSurface& surface = *edge.boxes->surface;
    const SurfaceTriangle& one = surface.triangles[edge.triangle];
    const SurfaceEdge ends = edge.ends();
    const std::int32_t sides[2] = {std::int32_t(edge.triangle), one.neighbour[edge.side]};
    for (const std::int32_t side : sides) {
      if (side < 0) continue;
      for (const std::uint32_t v : surface.triangles[side].corner) {
        if (v == ends.a || v == ends.b) continue;
        if (leads_toward(positions_[edge.boxes->first + v] - at, away)) return false;
      }
    }
    return true;
  }

  void add_edges(const OwnedEdge& e, const OwnedEdge& f) {
    const SurfaceEdge a = e.ends(), b = f.ends();
    const std::uint32_t v[4] = {e.boxes->first + a.a, e.boxes->first + a.b, f.boxes->first + b.a,
                                f.boxes->first + b.b};
    const DVec3 origin = positions_[v[0]];
    const DVec3 along = positions_[v[1]] - origin, p = positions_[v[2]] - origin,
                q = positions_[v[3]] - origin;
    const SegmentPair closest = closest_of_segments({}, along, p, q);
    const DVec3 apart = closest.on_a - closest.on_b;
    const double limit = double(max(limits_[v[0]], limits_[v[1]]) + max(limits_[v[2]], limits_[v[3]]));
    const double radius = double(max(radii_[v[0]], radii_[v[1]]) + max(radii_[v[2]], radii_[v[3]]));
    const double far = length_squared(apart);
    if (far > square(limit + radius)) return;
    const bool touches = closest.s > 0.0 && closest.s < 1.0 && closest.t > 0.0 && closest.t < 1.0 &&
                         touches_edge(e, origin + closest.on_a, -apart) &&
                         touches_edge(f, origin + closest.on_b, apart);
    if (!touches && far > square(limit + least_gap_ * radius)) return;
    SurfacePair& pair = pairs_.emplace_back();
    pair.key = kEdgePairs | std::uint64_t(e.number) << 32 | f.number;
    pair.on_a = 2;
    for (int n = 0; n < 4; ++n) pair.vertex[n] = v[n];
    pair.weight[1] = float(closest.s), pair.weight[0] = 1.0f - pair.weight[1];
    pair.weight[3] = -float(closest.t), pair.weight[2] = -1.0f - pair.weight[3];
    pair.touches = touches;
    finish(pair, apart, cross(along, q - p));
  }

  // `other` is the direction where the features touch.
  void finish(SurfacePair& pair, DVec3 apart, DVec3 other) {
    pair.distance = length(apart);
    if (pair.distance > 0.0) {
      pair.normal = apart / pair.distance;
    } else {
      const double size = length(other);
      pair.normal = size > 0.0 ? other / size : DVec3{0.0, 1.0, 0.0};
    }
    for (int n = 0; n < 4; ++n) pair.thickness += absolute(pair.weight[n]) * radii_[pair.vertex[n]];
    pair.friction[0] = friction_[0], pair.friction[1] = friction_[1];
  }

  std::span<const DVec3> positions_;
  std::span<const float> limits_, radii_;
  double least_gap_;
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
                        std::span<const float> limits, float least_gap, Arena& arena,
                        Array<SurfacePair>& pairs) {
  const ArenaScope scope(arena);
  pairs.clear();
  if (surfaces.empty() || positions.empty()) return;
  const DVec3 origin = positions[surfaces[0].first];
  const std::span<SurfaceBoxes> boxes = arena.make<SurfaceBoxes>(surfaces.size());
  const std::span<FeatureBase> bases = arena.make<FeatureBase>(surfaces.size());
  const std::span<float> radii = arena.make<float>(positions.size()),
                         pads = arena.make<float>(positions.size());
  for (const PlacedSurface& placed : surfaces) {
    for (int i = 0; i < placed.surface->vertices; ++i) {
      const std::size_t v = placed.first + std::size_t(i);
      radii[v] = placed.surface->radius[i];
      pads[v] = limits[v] + radii[v];
    }
  }
  FeatureBase base;
  for (std::size_t i = 0; i < surfaces.size(); ++i) {
    boxes[i] = fit_boxes(surfaces[i], positions, pads, origin, arena);
    bases[i] = base;
    base.triangle += std::uint32_t(surfaces[i].surface->triangles.size());
    base.edge += std::uint32_t(surfaces[i].surface->edges.size());
  }
  PairSearch search(positions, limits, radii, least_gap, pairs);
  for (std::size_t i = 0; i < boxes.size(); ++i) {
    for (std::size_t k = i; k < boxes.size(); ++k) search.search(boxes[i], bases[i], boxes[k], bases[k]);
  }
  sort_by_key(pairs, arena);
}

}  // namespace gyre
