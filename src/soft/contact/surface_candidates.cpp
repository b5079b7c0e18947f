#include "soft/contact/surface_candidates.h"

#include "base/container/sort.h"
#include "task/parallel.h"

#include <cmath>

namespace gyre {

namespace {

// Sub-steps that a track is straight for: those of a step by default.
constexpr int kTrackSteps = 4;
constexpr float kMoreOfReach =
    0.3f;  // by which a vertex that has left its track reaches farther about the next one, at most

// Farther from the origin, or with longer moves, the rounding of places is more than a part of a thickness and may exceed the reach of tracks. Squares
// of what is much farther overflow a float. What is found from a list would then depend on when it was made.
constexpr double kFarthestTrack = 0x1p30;  // m

constexpr std::size_t kBlockNodes = 16;  // of a tree, whose leaves one worker takes at a time

// Input that the blocks of a search share.
struct SearchInput {
  std::span<const SurfaceBoxes> boxes;
  std::span<const FeatureBase> bases;
  std::span<const std::uint8_t> is_new;            // by vertex
  std::span<const std::span<std::uint8_t>> marks;  // by surface and triangle: 1 if it has a new vertex
  std::span<const SweptBox> edges;                 // by number over all surfaces
  std::span<const FilterVertex> vertices;
};

// Collects the pairs of features within reach that have a new vertex.
class CandidateSearch {
 public:
  CandidateSearch(const SearchInput& input, FoundCandidates& out)
      : boxes_(input.boxes),
        bases_(input.bases),
        is_new_(input.is_new),
        marks_(input.marks),
        edges_(input.edges),
        vertices_(input.vertices),
        out_(out) {}

  void search(const SearchBlock& block) {
    const std::size_t corners = out_.corners.size(), edges = out_.edges.size();
    const std::uint32_t a = block.a, b = block.b;
    for_each_marked_pair(
        boxes_[a], [&](std::uint32_t i) { return marks_[a][i] != 0; }, boxes_[b],
        [&](std::uint32_t k) { return marks_[b][k] != 0; }, block.rest, block.begin, block.end,
        [&](std::uint32_t i, std::uint32_t k) {
          add_corners(a, i, b, k);
          add_corners(b, k, a, i);
          add_edges(a, i, b, k);
        });
    const FeatureFilters& filters = select_feature_filters();
    filter(out_.corners, corners, filters.corners);
    filter(out_.edges, edges, filters.edges);
  }

 private:
  void add(Array<SurfaceCandidate>& to, const SurfaceCandidate& one) {
    const std::uint32_t* const v = one.vertex;
    if ((is_new_[v[0]] | is_new_[v[1]] | is_new_[v[2]] | is_new_[v[3]]) != 0) to.push_back(one);
  }
  void filter(Array<SurfaceCandidate>& pairs, std::size_t first, FeatureFilter keeps) {
    const std::size_t count = pairs.size() - first;
    out_.kept.resize_uninitialized(count + 8);
    const std::size_t left =
        std::size_t(keeps(pairs.data() + first, int(count), vertices_.data(), out_.kept.data()));
    for (std::size_t i = 0; i < left; ++i) pairs[first + i] = pairs[first + out_.kept[i]];
    pairs.resize_uninitialized(first + left);
  }

  // Vertices that triangle i owns against triangle k.
  void add_corners(std::uint32_t s, std::uint32_t i, std::uint32_t t, std::uint32_t k) {
    const SurfaceBoxes &a = boxes_[s], &b = boxes_[t];
    const SoftTriangle& from = a.surface->triangles[i];
    if (from.owned_corners == 0) return;
    const std::uint32_t* const corner = b.surface->triangles[k].corner;
    for (unsigned c = 0; c < 3; ++c) {
      const std::uint32_t v = from.corner[c];
      if ((from.owned_corners >> c & 1u) == 0 || !may_meet(a.vertices[v], b.triangles[k])) continue;
      if (s == t && (v == corner[0] || v == corner[1] || v == corner[2])) continue;
      add(out_.corners, {{a.first + v, b.first + corner[0], b.first + corner[1], b.first + corner[2]},
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
          add(out_.edges, {{p[0], p[1], q[0], q[1]}, first, second, s, t});
        else
          add(out_.edges, {{q[0], q[1], p[0], p[1]}, second, first, t, s});
      }
    }
  }

  std::span<const SurfaceBoxes> boxes_;
  std::span<const FeatureBase> bases_;
  std::span<const std::uint8_t> is_new_;
  std::span<const std::span<std::uint8_t>> marks_;
  std::span<const SweptBox> edges_;
  std::span<const FilterVertex> vertices_;
  FoundCandidates& out_;
};

std::uint64_t key_of(const SurfaceCandidate& one) { return std::uint64_t(one.a) << 32 | one.b; }

// Replaces the pairs that have a new vertex by those that the workers have found.
void replace(Array<SurfaceCandidate>& pairs, std::span<const std::uint8_t> is_new,
             std::span<const FoundCandidates> found, Array<SurfaceCandidate> FoundCandidates::*list,
             Array<SurfaceCandidate>& before, Arena& arena) {
  const ArenaScope scope(arena);
  std::size_t count = 0;
  for (const FoundCandidates& one : found) count += (one.*list).size();
  const std::span<const SurfaceCandidate*> at = arena.make<const SurfaceCandidate*>(count);
  const std::span<std::uint64_t> keys = arena.make<std::uint64_t>(count),
                                 more = arena.make<std::uint64_t>(count);
  const std::span<std::uint32_t> order = arena.make<std::uint32_t>(count),
                                 other = arena.make<std::uint32_t>(count);
  std::size_t next = 0;
  for (const FoundCandidates& one : found) {
    for (const SurfaceCandidate& pair : one.*list) {
      at[next] = &pair, keys[next] = key_of(pair), order[next] = std::uint32_t(next);
      ++next;
    }
  }
  radix_sort_pairs(keys, order, more, other);
  std::swap(pairs, before);
  pairs.resize_uninitialized(before.size() + count);
  std::size_t kept = 0;
  next = 0;
  for (const SurfaceCandidate& one : before) {
    const std::uint32_t* const v = one.vertex;
    if ((is_new[v[0]] | is_new[v[1]] | is_new[v[2]] | is_new[v[3]]) != 0) continue;
    for (const std::uint64_t key = key_of(one); next < count && keys[next] < key; ++next)
      pairs[kept++] = *at[order[next]];
    pairs[kept++] = one;
  }
  for (; next < count; ++next) pairs[kept++] = *at[order[next]];
  pairs.resize_uninitialized(kept);
}

bool are_same(std::span<const PlacedSurface> a, std::span<const PlacedSurface> b) {
  if (a.size() != b.size()) return false;
  for (std::size_t i = 0; i < a.size(); ++i) {
    if (a[i].surface != b[i].surface || a[i].first != b[i].first) return false;
  }
  return true;
}

// True if any is farther than kFarthestTrack, or is no number.
bool is_any_far(std::span<const DVec3> vectors) {
  bool far = false;
  for (const DVec3& one : vectors)
    far = far || !(max(absolute(one.x), max(absolute(one.y), absolute(one.z))) <= kFarthestTrack);
  return far;
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
    // A vertex that has left a track may leave the next one as far.
    const bool first = candidates.reach[v] < 0.0f;
    candidates.reach[v] = ahead[v] + (first ? 0.0f : min(left[v], kMoreOfReach * ahead[v]));
    ++renewed;
  }
  return renewed;
}

// The search, by all workers: what each has found is in candidates.found, in no order.
void search(std::span<const PlacedSurface> surfaces, std::span<const DVec3> now, std::span<const DVec3> ways,
            std::span<const std::uint8_t> is_new, Arena& arena, TaskSystem& tasks,
            SurfaceCandidates& candidates) {
  const DVec3 origin = now[surfaces[0].first];
  const std::span<SurfaceBoxes> boxes = arena.make<SurfaceBoxes>(surfaces.size());
  const std::span<std::span<std::uint8_t>> marks = arena.make<std::span<std::uint8_t>>(surfaces.size());
  std::size_t count = 0, next = 0;
  for (const PlacedSurface& one : surfaces) count += one.surface->edges.size();
  const std::span<SweptBox> edges = arena.make<SweptBox>(count);
  for (std::size_t s = 0; s < surfaces.size(); ++s) {
    boxes[s] = fit_boxes(surfaces[s], now, candidates.reach, origin, arena, ways);
    const SoftSurface& surface = *surfaces[s].surface;
    for (const SurfaceEdge& edge : surface.edges)
      edges[next++] = merge(boxes[s].vertices[edge.a], boxes[s].vertices[edge.b]);
    marks[s] = arena.make<std::uint8_t>(surface.triangles.size());
    for (std::size_t i = 0; i < marks[s].size(); ++i) {
      const std::uint32_t first = surfaces[s].first, *const v = surface.triangles[i].corner;
      marks[s][i] = is_new[first + v[0]] | is_new[first + v[1]] | is_new[first + v[2]];
    }
  }
  const std::span<FilterVertex> vertices = arena.make<FilterVertex>(now.size());
  fill_filter(now, ways, candidates.reach, origin, vertices);

  Array<SearchBlock>& blocks = candidates.blocks;
  blocks.clear();
  const auto add_blocks = [&](std::uint32_t a, std::uint32_t b, bool rest) {
    for (std::size_t begin = 0; begin < boxes[a].nodes.size(); begin += kBlockNodes)
      blocks.push_back({a, b, begin, min(begin + kBlockNodes, boxes[a].nodes.size()), rest});
  };
  for (std::uint32_t a = 0; a < std::uint32_t(boxes.size()); ++a) {
    if (surfaces[a].surface->self_collision) add_blocks(a, a, false);
    for (std::uint32_t b = a + 1; b < std::uint32_t(boxes.size()); ++b) {
      if (may_meet(boxes[a], boxes[b])) add_blocks(a, b, false), add_blocks(b, a, true);
    }
  }
  candidates.found.resize(std::size_t(tasks.worker_count()));
  for (FoundCandidates& one : candidates.found) one.corners.clear(), one.edges.clear();
  const SearchInput input{boxes, candidates.bases, is_new, marks, edges, vertices};
  for_blocks(tasks, int(blocks.size()), 1, [&](int begin, int end, int worker) {
    CandidateSearch finder(input, candidates.found[std::size_t(worker)]);
    for (int i = begin; i < end; ++i) finder.search(blocks[i]);
  });
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
                       std::span<const float> ahead, Arena& arena, TaskSystem& tasks,
                       SurfaceCandidates& candidates) {
  const ArenaScope scope(arena);
  const std::size_t count = positions.size();
  const bool was_far = candidates.is_far;
  candidates.is_far = is_any_far(positions) || is_any_far(moves);
  if (was_far || candidates.is_far || !are_same(candidates.surfaces, surfaces) ||
      candidates.start.size() != count) {
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
  search(surfaces, now, ways, is_new, arena, tasks, candidates);
  replace(candidates.corners, is_new, candidates.found, &FoundCandidates::corners, candidates.before, arena);
  replace(candidates.edges, is_new, candidates.found, &FoundCandidates::edges, candidates.before, arena);
}

}  // namespace gyre
