#include "soft/contact/surface_candidates.h"

#include "base/container/sort.h"

namespace gyre {

namespace {

// Collects the pairs of features whose boxes overlap.
class CandidateSearch {
 public:
  CandidateSearch(std::span<const SurfaceBoxes> boxes, std::size_t edges, SurfaceCandidates& out,
                  Arena& arena)
      : boxes_(boxes), out_(out), edges_(arena.make<EdgeBox>(edges)) {
    std::size_t next = 0;
    for (const SurfaceBoxes& one : boxes) {
      for (const SurfaceEdge& edge : one.surface->edges) {
        edges_[next++] = {merge(one.vertices[edge.a], one.vertices[edge.b]),
                          merge(one.end_vertices[edge.a], one.end_vertices[edge.b])};
      }
    }
  }

  void search(std::uint32_t a, std::uint32_t b) {
    if (a == b && !boxes_[a].surface->self_collision) return;
    for_each_triangle_pair(boxes_[a], boxes_[b], [&](std::uint32_t i, std::uint32_t k) {
      add_corners(a, i, b, k);
      add_corners(b, k, a, i);
      add_edges(a, i, b, k);
    });
  }

 private:
  // Vertices that triangle i owns against triangle k.
  void add_corners(std::uint32_t s, std::uint32_t i, std::uint32_t t, std::uint32_t k) {
    const SurfaceBoxes &a = boxes_[s], &b = boxes_[t];
    const SoftTriangle& from = a.surface->triangles[i];
    if (from.owned_corners == 0) return;
    const std::uint32_t* const corner = b.surface->triangles[k].corner;
    for (unsigned c = 0; c < 3; ++c) {
      const std::uint32_t v = from.corner[c];
      if ((from.owned_corners >> c & 1u) == 0 ||
          !may_meet(a.vertices[v], a.end_vertices[v], b.triangles[k], b.end_triangles[k]))
        continue;
      if (s == t && (v == corner[0] || v == corner[1] || v == corner[2])) continue;
      out_.corners.push_back({{a.first + v, b.first + corner[0], b.first + corner[1], b.first + corner[2]},
                              a.first + v,
                              out_.bases[t].triangle + k,
                              s,
                              t});
    }
  }

  void add_edges(std::uint32_t s, std::uint32_t i, std::uint32_t t, std::uint32_t k) {
    const SurfaceBoxes &a = boxes_[s], &b = boxes_[t];
    for (const std::int32_t one : a.surface->triangles[i].owned_edge) {
      if (one < 0) continue;
      const SurfaceEdge e = a.surface->edges[one];
      const EdgeBox& box = edges_[out_.bases[s].edge + std::uint32_t(one)];
      if (!may_meet(box.start, box.end, b.triangles[k], b.end_triangles[k])) continue;
      for (const std::int32_t other : b.surface->triangles[k].owned_edge) {
        if (other < 0) continue;
        const SurfaceEdge f = b.surface->edges[other];
        if (s == t && (e.a == f.a || e.a == f.b || e.b == f.a || e.b == f.b)) continue;
        const EdgeBox& to = edges_[out_.bases[t].edge + std::uint32_t(other)];
        if (!may_meet(box.start, box.end, to.start, to.end)) continue;
        const std::uint32_t first = out_.bases[s].edge + std::uint32_t(one),
                            second = out_.bases[t].edge + std::uint32_t(other);
        const std::uint32_t p[2] = {a.first + e.a, a.first + e.b}, q[2] = {b.first + f.a, b.first + f.b};
        if (first < second)
          out_.edges.push_back({{p[0], p[1], q[0], q[1]}, first, second, s, t});
        else
          out_.edges.push_back({{q[0], q[1], p[0], p[1]}, second, first, t, s});
      }
    }
  }

  struct EdgeBox {
    Aabb start, end;
  };

  std::span<const SurfaceBoxes> boxes_;
  SurfaceCandidates& out_;
  std::span<EdgeBox> edges_;  // by number over all surfaces
};

// Keeps those that the filter keeps, and sorts them by their numbers.
void filter_and_sort(Array<SurfaceCandidate>& pairs, std::span<const FilterVertex> vertices,
                     FeatureFilter filter, Arena& arena) {
  const ArenaScope scope(arena);
  const std::span<std::uint32_t> kept = arena.make<std::uint32_t>(pairs.size() + 8);
  const std::size_t count =
      std::size_t(filter(pairs.data(), int(pairs.size()), vertices.data(), kept.data()));
  const std::span<SurfaceCandidate> copy = arena.make<SurfaceCandidate>(count);
  const std::span<std::uint64_t> keys = arena.make<std::uint64_t>(count),
                                 more = arena.make<std::uint64_t>(count);
  const std::span<std::uint32_t> order = arena.make<std::uint32_t>(count),
                                 other = arena.make<std::uint32_t>(count);
  for (std::size_t i = 0; i < count; ++i) {
    copy[i] = pairs[kept[i]];
    keys[i] = std::uint64_t(copy[i].a) << 32 | copy[i].b;
    order[i] = std::uint32_t(i);
  }
  radix_sort_pairs(keys, order, more, other);
  pairs.resize_uninitialized(count);
  for (std::size_t i = 0; i < count; ++i) pairs[i] = copy[order[i]];
}

// True if the candidates are those of these surfaces, and no feature has moved out of what it was thought to reach, nor is to move out of it. All may
// have moved together.
bool covers(const SurfaceCandidates& candidates, std::span<const PlacedSurface> surfaces,
            std::span<const DVec3> positions, std::span<const DVec3> moves, std::span<const float> reach,
            Arena& arena) {
  if (candidates.surfaces.size() != surfaces.size() || candidates.positions.size() != positions.size())
    return false;
  DVec3 sum{}, sum_of_moves{};
  double count = 0.0;
  for (std::size_t i = 0; i < surfaces.size(); ++i) {
    const PlacedSurface& now = surfaces[i];
    if (candidates.surfaces[i].surface != now.surface || candidates.surfaces[i].first != now.first)
      return false;
    for (std::size_t v = now.first; v < now.first + std::size_t(now.surface->vertices); ++v) {
      sum += positions[v] - candidates.positions[v];
      sum_of_moves += moves[v] - candidates.moves[v];
    }
    count += double(now.surface->vertices);
  }
  const double share = count > 0.0 ? 1.0 / count : 0.0;
  const DVec3 mean = share * sum, mean_of_moves = share * sum_of_moves;
  const std::span<float> moved = arena.make<float>(positions.size());
  for (std::size_t v = 0; v < positions.size(); ++v) {
    const float far = float(length(positions[v] - candidates.positions[v] - mean) +
                            length(moves[v] - candidates.moves[v] - mean_of_moves));
    moved[v] = far * (1.0f + 0x1p-20f);
  }
  const std::span<const float> most = spread_over_features(surfaces, moved, arena);
  for (const PlacedSurface& now : surfaces) {
    for (std::size_t v = now.first; v < now.first + std::size_t(now.surface->vertices); ++v) {
      if (!(most[v] + reach[v] <= candidates.reach[v])) return false;
    }
  }
  return true;
}

}  // namespace

std::span<float> spread_over_features(std::span<const PlacedSurface> surfaces, std::span<const float> values,
                                      Arena& arena) {
  const std::span<float> out = arena.make<float>(values.size());
  for (const PlacedSurface& placed : surfaces) {
    const SoftSurface& surface = *placed.surface;
    for (std::size_t i = 0; i < std::size_t(surface.vertices); ++i) {
      float most = values[placed.first + i];
      for (std::uint32_t n = surface.around_begin[i]; n < surface.around_begin[i + 1]; ++n)
        most = max(most, values[placed.first + surface.around[n]]);
      out[placed.first + i] = most;
    }
  }
  return out;
}

void fill_filter(std::span<const DVec3> positions, std::span<const DVec3> moves, std::span<const float> reach,
                 DVec3 origin, std::span<FilterVertex> out) {
  constexpr float kRounding = 0x1p-20f;  // of the coordinates: their rounding to float
  for (std::size_t v = 0; v < positions.size(); ++v) {
    const Vec3 p = difference(positions[v], origin);
    const Vec3 size = absolute(p);
    const Vec3 move = to_float(moves[v]), far = absolute(move);
    const float rounding = size.x + size.y + size.z + far.x + far.y + far.z + reach[v];
    out[v] = {p.x, p.y, p.z, reach[v] + kRounding * rounding, move.x, move.y, move.z, 0.0f};
  }
}

void update_candidates(std::span<const PlacedSurface> surfaces, std::span<const DVec3> positions,
                       std::span<const DVec3> moves, std::span<const float> reach,
                       std::span<const float> ahead, Arena& arena, SurfaceCandidates& candidates) {
  const ArenaScope scope(arena);
  if (covers(candidates, surfaces, positions, moves, reach, arena)) return;
  candidates.corners.clear(), candidates.edges.clear(), candidates.bases.clear();
  candidates.surfaces.assign(surfaces), candidates.positions.assign(positions);
  candidates.moves.assign(moves), candidates.reach.assign(ahead);
  ++candidates.made;
  if (surfaces.empty() || positions.empty()) return;
  const DVec3 origin = positions[surfaces[0].first];
  const std::span<SurfaceBoxes> boxes = arena.make<SurfaceBoxes>(surfaces.size());
  FeatureBase base;
  for (std::size_t i = 0; i < surfaces.size(); ++i) {
    boxes[i] = fit_boxes(surfaces[i], positions, ahead, origin, arena, moves);
    candidates.bases.push_back(base);
    base.triangle += std::uint32_t(surfaces[i].surface->triangles.size());
    base.edge += std::uint32_t(surfaces[i].surface->edges.size());
  }
  CandidateSearch search(boxes, base.edge, candidates, arena);
  for (std::uint32_t i = 0; i < std::uint32_t(boxes.size()); ++i) {
    for (std::uint32_t k = i; k < std::uint32_t(boxes.size()); ++k) search.search(i, k);
  }
  const std::span<FilterVertex> vertices = arena.make<FilterVertex>(positions.size());
  fill_filter(positions, moves, ahead, origin, vertices);
  const FeatureFilters& filters = select_feature_filters();
  filter_and_sort(candidates.corners, vertices, filters.corners, arena);
  filter_and_sort(candidates.edges, vertices, filters.edges, arena);
}

}  // namespace gyre
