#include "soft/contact/surface_candidates.h"

#include "base/container/sort.h"

#include <cmath>
#include <cstdio>
#include <cstdlib>

namespace gyre {

namespace {

// Sub-steps that a track is straight for: those of a step by default.
constexpr int kTrackSteps = 4;

// Collects the pairs of features whose boxes overlap and that have a new vertex.
class CandidateSearch {
 public:
  CandidateSearch(std::span<const SurfaceBoxes> boxes, std::span<const std::uint8_t> is_new, std::size_t edges,
                  std::span<const FeatureBase> bases, Array<SurfaceCandidate>& corners_out,
                  Array<SurfaceCandidate>& edges_out, Arena& arena)
      : boxes_(boxes),
        is_new_(is_new),
        bases_(bases),
        corners_out_(corners_out),
        edges_out_(edges_out),
        edges_(arena.make<SweptBox>(edges)),
        marks_(arena.make<std::span<std::uint8_t>>(boxes.size())) {
    std::size_t next = 0;
    for (std::size_t s = 0; s < boxes.size(); ++s) {
      const SurfaceBoxes& one = boxes[s];
      for (const SurfaceEdge& edge : one.surface->edges) {
        edges_[next++] = merge(one.vertices[edge.a], one.vertices[edge.b]);
      }
      marks_[s] = arena.make<std::uint8_t>(one.surface->triangles.size());
      for (std::size_t i = 0; i < marks_[s].size(); ++i) {
        const std::uint32_t* const corner = one.surface->triangles[i].corner;
        marks_[s][i] = is_new[one.first + corner[0]] | is_new[one.first + corner[1]] | is_new[one.first + corner[2]];
      }
    }
  }

  void search(std::uint32_t a, std::uint32_t b) {
    if (a == b && !boxes_[a].surface->self_collision) return;
    search_marked(a, b, false);
    if (a != b) search_marked(b, a, true);
  }

 private:
  void search_marked(std::uint32_t a, std::uint32_t b, bool rest) {
    for_each_marked_pair(
        boxes_[a], [&](std::uint32_t i) { return marks_[a][i] != 0; }, boxes_[b],
        [&](std::uint32_t k) { return marks_[b][k] != 0; }, rest, [&](std::uint32_t i, std::uint32_t k) {
          add_corners(a, i, b, k);
          add_corners(b, k, a, i);
          add_edges(a, i, b, k);
        });
  }
  void add(Array<SurfaceCandidate>& to, const SurfaceCandidate& one) {
    const std::uint32_t* const v = one.vertex;
    if ((is_new_[v[0]] | is_new_[v[1]] | is_new_[v[2]] | is_new_[v[3]]) != 0) to.push_back(one);
  }

  // Vertices that triangle i owns against triangle k.
  void add_corners(std::uint32_t s, std::uint32_t i, std::uint32_t t, std::uint32_t k) {
    const SurfaceBoxes &a = boxes_[s], &b = boxes_[t];
    const SoftTriangle& from = a.surface->triangles[i];
    if (from.owned_corners == 0) return;
    const std::uint32_t* const corner = b.surface->triangles[k].corner;
    for (unsigned c = 0; c < 3; ++c) {
      const std::uint32_t v = from.corner[c];
      if ((from.owned_corners >> c & 1u) == 0 ||
          !may_meet(a.vertices[v], b.triangles[k]))
        continue;
      if (s == t && (v == corner[0] || v == corner[1] || v == corner[2])) continue;
      add(corners_out_, {{a.first + v, b.first + corner[0], b.first + corner[1], b.first + corner[2]},
                         a.first + v,
                         bases_[t].triangle + k,
                         s,
                         t});
    }
  }

  void add_edges(std::uint32_t s, std::uint32_t i, std::uint32_t t, std::uint32_t k) {
    const SurfaceBoxes &a = boxes_[s], &b = boxes_[t];
    for (const std::int32_t one : a.surface->triangles[i].owned_edge) {
      if (one < 0) continue;
      const SurfaceEdge e = a.surface->edges[one];
      const SweptBox& box = edges_[bases_[s].edge + std::uint32_t(one)];
      if (!may_meet(box, b.triangles[k])) continue;
      for (const std::int32_t other : b.surface->triangles[k].owned_edge) {
        if (other < 0) continue;
        const SurfaceEdge f = b.surface->edges[other];
        if (s == t && (e.a == f.a || e.a == f.b || e.b == f.a || e.b == f.b)) continue;
        const SweptBox& to = edges_[bases_[t].edge + std::uint32_t(other)];
        if (!may_meet(box, to)) continue;
        const std::uint32_t first = bases_[s].edge + std::uint32_t(one),
                            second = bases_[t].edge + std::uint32_t(other);
        const std::uint32_t p[2] = {a.first + e.a, a.first + e.b}, q[2] = {b.first + f.a, b.first + f.b};
        if (first < second)
          add(edges_out_, {{p[0], p[1], q[0], q[1]}, first, second, s, t});
        else
          add(edges_out_, {{q[0], q[1], p[0], p[1]}, second, first, t, s});
      }
    }
  }

  std::span<const SurfaceBoxes> boxes_;
  std::span<const std::uint8_t> is_new_;
  std::span<const FeatureBase> bases_;
  Array<SurfaceCandidate>&corners_out_, &edges_out_;
  std::span<SweptBox> edges_;                     // by number over all surfaces
  std::span<std::span<std::uint8_t>> marks_;  // by surface and triangle: 1 if it has a new vertex
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

std::uint64_t key_of(const SurfaceCandidate& one) { return std::uint64_t(one.a) << 32 | one.b; }

// Replaces the pairs that have a new vertex.
void replace(Array<SurfaceCandidate>& pairs, std::span<const std::uint8_t> is_new,
             std::span<const SurfaceCandidate> found, Arena& arena) {
  const ArenaScope scope(arena);
  const std::span<SurfaceCandidate> before = arena.make<SurfaceCandidate>(pairs.size());
  for (std::size_t i = 0; i < before.size(); ++i) before[i] = pairs[i];
  pairs.clear();
  std::size_t next = 0;
  for (const SurfaceCandidate& one : before) {
    const std::uint32_t* const v = one.vertex;
    if ((is_new[v[0]] | is_new[v[1]] | is_new[v[2]] | is_new[v[3]]) != 0) continue;
    while (next < found.size() && key_of(found[next]) < key_of(one)) pairs.push_back(found[next++]);
    pairs.push_back(one);
  }
  while (next < found.size()) pairs.push_back(found[next++]);
}

bool are_same(std::span<const PlacedSurface> a, std::span<const PlacedSurface> b) {
  if (a.size() != b.size()) return false;
  for (std::size_t i = 0; i < a.size(); ++i) {
    if (a[i].surface != b[i].surface || a[i].first != b[i].first) return false;
  }
  return true;
}

DVec3 mean_of(std::span<const PlacedSurface> surfaces, std::span<const DVec3> values) {
  DVec3 sum{};
  double count = 0.0;
  for (const PlacedSurface& one : surfaces) {
    for (std::size_t v = one.first; v < one.first + std::size_t(one.surface->vertices); ++v) sum += values[v];
    count += double(one.surface->vertices);
  }
  return count > 0.0 ? (1.0 / count) * sum : DVec3{};
}

// Where the tracks are `after` sub-steps from now.
DVec3 place_on_track(const SurfaceCandidates& candidates, std::size_t v, int after) {
  return candidates.start[v] + double(min(candidates.time + after, kTrackSteps)) * candidates.way[v];
}

// Gives new tracks to vertices that are not on theirs, now or at the end of their moves, and to those whose neighbours are not; marks them. Returns how many they are.
std::size_t renew_tracks(std::span<const PlacedSurface> surfaces, std::span<const DVec3> positions,
                         std::span<const DVec3> moves, std::span<const float> reach,
                         std::span<const float> ahead, std::span<std::uint8_t> is_new,
                         SurfaceCandidates& candidates, Arena& arena) {
  const std::size_t count = positions.size();
  if (candidates.time >= kTrackSteps) {
    for (std::size_t v = 0; v < count; ++v) {
      candidates.start[v] = place_on_track(candidates, v, 0);
      candidates.way[v] = {};
    }
    candidates.time = 0;
  }
  const std::span<DVec3> off = arena.make<DVec3>(count), off_then = arena.make<DVec3>(count);
  for (std::size_t v = 0; v < count; ++v) {
    off[v] = positions[v] - place_on_track(candidates, v, 0);
    off_then[v] = positions[v] + moves[v] - place_on_track(candidates, v, 1);
  }
  const DVec3 mean = mean_of(surfaces, off), mean_then = mean_of(surfaces, off_then);
  const std::span<float> left = arena.make<float>(count);
  for (std::size_t v = 0; v < count; ++v) {
    const double far = max(length_squared(off[v] - mean), length_squared(off_then[v] - mean_then));
    left[v] = (1.0f + 0x1p-20f) * float(std::sqrt(far));
  }
  std::size_t renewed = 0;
  for (std::size_t v = 0; v < count; ++v) {
    is_new[v] = !(left[v] + reach[v] <= candidates.reach[v]);
    if (is_new[v] == 0) continue;
    candidates.way[v] = moves[v] - (mean_then - mean);
    candidates.start[v] = positions[v] - mean - double(candidates.time) * candidates.way[v];
    candidates.reach[v] = ahead[v] + (candidates.reach[v] < 0.0f ? 0.0f : min(left[v], 0.3f * ahead[v]));
    ++renewed;
  }
  return renewed;
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
  const std::size_t count = positions.size();
  if (!are_same(candidates.surfaces, surfaces) || candidates.start.size() != count) {
    candidates.corners.clear(), candidates.edges.clear(), candidates.bases.clear();
    candidates.surfaces.assign(surfaces);
    candidates.start.assign(positions), candidates.way.assign(moves);
    candidates.reach.assign(count, -1.0f);
    candidates.time = 0;
    FeatureBase base;
    for (const PlacedSurface& one : surfaces) {
      candidates.bases.push_back(base);
      base.triangle += std::uint32_t(one.surface->triangles.size());
      base.edge += std::uint32_t(one.surface->edges.size());
    }
  }
  if (surfaces.empty() || positions.empty()) return;
  const std::span<std::uint8_t> is_new = arena.make<std::uint8_t>(count);
  const std::size_t renewed =
      renew_tracks(surfaces, positions, moves, reach, ahead, is_new, candidates, arena);
  if (renewed == 0) return;
  candidates.new_tracks += long(renewed);
  const std::span<DVec3> now = arena.make<DVec3>(count), ways = arena.make<DVec3>(count);
  for (std::size_t v = 0; v < count; ++v) {
    now[v] = place_on_track(candidates, v, 0);
    ways[v] = place_on_track(candidates, v, kTrackSteps) - now[v];
  }
  const DVec3 origin = now[surfaces[0].first];
  const std::span<SurfaceBoxes> boxes = arena.make<SurfaceBoxes>(surfaces.size());
  std::size_t edges = 0;
  for (std::size_t i = 0; i < surfaces.size(); ++i) {
    boxes[i] = fit_boxes(surfaces[i], now, candidates.reach, origin, arena, ways);
    edges += surfaces[i].surface->edges.size();
  }
  Array<SurfaceCandidate>& found_corners = candidates.found_corners;
  Array<SurfaceCandidate>& found_edges = candidates.found_edges;
  found_corners.clear(), found_edges.clear();
  CandidateSearch search(boxes, is_new, edges, candidates.bases, found_corners, found_edges, arena);
  for (std::uint32_t i = 0; i < std::uint32_t(boxes.size()); ++i) {
    for (std::uint32_t k = i; k < std::uint32_t(boxes.size()); ++k) search.search(i, k);
  }
  const std::size_t c0=found_corners.size(), e0=found_edges.size();
  const std::span<FilterVertex> vertices = arena.make<FilterVertex>(count);
  fill_filter(now, ways, candidates.reach, origin, vertices);
  const FeatureFilters& filters = select_feature_filters();
  filter_and_sort(found_corners, vertices, filters.corners, arena);
  filter_and_sort(found_edges, vertices, filters.edges, arena);
  replace(candidates.corners, is_new, found_corners, arena);
  replace(candidates.edges, is_new, found_edges, arena);
  if(getenv("DBG")) fprintf(stderr,"  t %d renewed %zu raw %zu %zu kept %zu %zu all %zu %zu\n",candidates.time,renewed,c0,e0,found_corners.size(),found_edges.size(),candidates.corners.size(),candidates.edges.size());
}

}  // namespace gyre
