#include "soft/contact/surface_pairs.h"

#include "geometry/distance/closest.h"
#include "task/parallel.h"

#include <cmath>

namespace gyre {

namespace {

constexpr std::uint64_t kEdgePairs = std::uint64_t(1) << 63;  // in keys

// A pair is looked for further by this share of the radii of its vertices, so that candidates last.
constexpr float kAheadOfRadius = 0.3f;

// Features of a surface that are nearer than this share of their radii are in one place: parts of a split vertex that could not be moved apart.
constexpr double kOnePlace = 1.0e-6;

constexpr int kBlockCandidates = 512;  // that one worker takes at a time

DVec3 least_of(DVec3 a, DVec3 b) { return {min(a.x, b.x), min(a.y, b.y), min(a.z, b.z)}; }
DVec3 most_of(DVec3 a, DVec3 b) { return {max(a.x, b.x), max(a.y, b.y), max(a.z, b.z)}; }

// Measures candidates exactly, and keeps the pairs that matter.
class PairFinder {
 public:
  PairFinder(const SurfaceCandidates& candidates, std::span<const DVec3> positions,
             std::span<const DVec3> moves, std::span<const float> limits, std::span<const float> radii,
             float least_gap, Array<SurfacePair>& pairs)
      : candidates_(candidates),
        positions_(positions),
        moves_(moves),
        limits_(limits),
        radii_(radii),
        least_gap_(double(least_gap)),
        pairs_(pairs) {}

  void add_corner(const SurfaceCandidate& one) {
    const std::uint32_t* const v = one.vertex;
    const DVec3 p = positions_[v[0]];
    const SimplexPoint closest =
        closest_on_triangle({}, positions_[v[1]] - p, positions_[v[2]] - p, positions_[v[3]] - p);
    const auto largest = [&](std::span<const float> of) {
      return double(of[v[0]] + max(of[v[1]], max(of[v[2]], of[v[3]])));
    };
    const double limit = largest(limits_), radius = largest(radii_), far = length_squared(closest.point);
    const double move = largest_difference(v, 1);
    if (far > square(limit + radius + move) || stay_apart(v, 1, limit + radius)) return;
    const PlacedSurface& b = candidates_.surfaces[one.surface_b];
    const bool in_one_place = are_in_one_place(one, far, radius);
    const bool touches =
        !in_one_place && touches_triangle(p, closest, b, one.b - candidates_.bases[one.surface_b].triangle);
    if (!touches && far > square(limit + move + least_gap_ * radius)) return;
    SurfacePair& pair = add(one, touches);
    pair.key = std::uint64_t(one.a) << 32 | one.b;
    pair.on_a = 1;
    pair.weight[0] = 1.0f;
    for (int n = 0; n < 3; ++n) pair.weight[n + 1] = -float(closest.weights[n]);
    finish(pair, -closest.point,
           cross(positions_[v[2]] - positions_[v[1]], positions_[v[3]] - positions_[v[1]]));
    if (in_one_place) pair.normal = {};
  }

  void add_edges(const SurfaceCandidate& one) {
    const std::uint32_t* const v = one.vertex;
    const DVec3 origin = positions_[v[0]];
    const DVec3 along = positions_[v[1]] - origin, p = positions_[v[2]] - origin,
                q = positions_[v[3]] - origin;
    const SegmentPair closest = closest_of_segments({}, along, p, q);
    const DVec3 apart = closest.on_a - closest.on_b;
    const auto largest = [&](std::span<const float> of) {
      return double(max(of[v[0]], of[v[1]]) + max(of[v[2]], of[v[3]]));
    };
    const double limit = largest(limits_), radius = largest(radii_), far = length_squared(apart);
    const double move = largest_difference(v, 2);
    if (far > square(limit + radius + move) || stay_apart(v, 2, limit + radius)) return;
    const bool in_one_place = are_in_one_place(one, far, radius);
    const bool touches = !in_one_place && closest.s > 0.0 && closest.s < 1.0 && closest.t > 0.0 &&
                         closest.t < 1.0 &&
                         touches_edge(one.surface_a, one.a, origin + closest.on_a, -apart) &&
                         touches_edge(one.surface_b, one.b, origin + closest.on_b, apart);
    if (!touches && far > square(limit + move + least_gap_ * radius)) return;
    SurfacePair& pair = add(one, touches);
    pair.key = kEdgePairs | std::uint64_t(one.a) << 32 | one.b;
    pair.on_a = 2;
    pair.weight[1] = float(closest.s), pair.weight[0] = 1.0f - pair.weight[1];
    pair.weight[3] = -float(closest.t), pair.weight[2] = -1.0f - pair.weight[3];
    finish(pair, apart, cross(along, q - p));
    if (in_one_place) pair.normal = {};
  }

 private:
  static bool are_in_one_place(const SurfaceCandidate& one, double far, double radius) {
    return one.surface_a == one.surface_b && far <= square(kOnePlace * radius);
  }
  // Of the moves of a vertex of A, the first `on_a`, and one of B.
  double largest_difference(const std::uint32_t* v, int on_a) const {
    double most = 0.0;
    for (int i = 0; i < on_a; ++i) {
      for (int k = on_a; k < 4; ++k) most = max(most, length_squared(moves_[v[i]] - moves_[v[k]]));
    }
    return std::sqrt(most);
  }
  // True if an axis keeps A and B apart by more than `reach` now and at the end of the plan, the same way round.
  bool stay_apart(const std::uint32_t* v, int on_a, double reach) const {
    DVec3 low[2][2], high[2][2];  // of A and B, now and at the end
    for (int k = 0; k < 4; ++k) {
      const int side = k < on_a ? 0 : 1;
      const bool first = k == 0 || k == on_a;
      const DVec3 now = positions_[v[k]] - positions_[v[0]], end = now + (moves_[v[k]] - moves_[v[0]]);
      for (int n = 0; n < 2; ++n) {
        const DVec3 at = n == 0 ? now : end;
        low[side][n] = first ? at : least_of(low[side][n], at);
        high[side][n] = first ? at : most_of(high[side][n], at);
      }
    }
    const DVec3 above[2] = {low[0][0] - high[1][0], low[0][1] - high[1][1]};
    const DVec3 below[2] = {low[1][0] - high[0][0], low[1][1] - high[0][1]};
    return is_beyond(above, reach) || is_beyond(below, reach);
  }
  static bool is_beyond(const DVec3 (&gap)[2], double reach) {
    return (gap[0].x > reach && gap[1].x > reach) || (gap[0].y > reach && gap[1].y > reach) ||
           (gap[0].z > reach && gap[1].z > reach);
  }

  SurfacePair& add(const SurfaceCandidate& one, bool touches) {
    SurfacePair& pair = pairs_.emplace_back();
    for (int n = 0; n < 4; ++n) pair.vertex[n] = one.vertex[n];
    pair.touches = touches;
    const SoftSurface &a = *candidates_.surfaces[one.surface_a].surface,
                      &b = *candidates_.surfaces[one.surface_b].surface;
    pair.friction[0] = std::sqrt(a.static_friction * b.static_friction);
    pair.friction[1] = std::sqrt(a.dynamic_friction * b.dynamic_friction);
    return pair;
  }

  // True if `way` leads toward `away`, by more than what flat surfaces may by rounding.
  static bool leads_toward(DVec3 way, DVec3 away) {
    constexpr double kFlat = 1.0e-3;  // of the product of both lengths
    const double along = dot(way, away);
    return along > 0.0 && square(along) > square(kFlat) * length_squared(way) * length_squared(away);
  }
  // True if no other triangle of b has a point nearer to p than the closest point of triangle k, and k is the first that has it.
  bool touches_triangle(DVec3 p, const SimplexPoint& closest, const PlacedSurface& b, std::uint32_t k) const {
    const SoftTriangle& one = b.surface->triangles[k];
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
        const SoftTriangle& other = b.surface->triangles[one.neighbour[c]];
        for (const std::uint32_t v : other.corner) {
          if (v != one.corner[c] && v != one.corner[next] && leads_toward(at(v) - closest.point, away))
            return false;
        }
        return true;
      }
    }
    return true;
  }

  // True if no triangle at the edge leads from its point `at` toward `away`, where a nearer point would be.
  bool touches_edge(std::uint32_t placed, std::uint32_t number, DVec3 at, DVec3 away) const {
    const PlacedSurface& of = candidates_.surfaces[placed];
    const SoftSurface& surface = *of.surface;
    const SurfaceEdge& edge = surface.edges[number - candidates_.bases[placed].edge];
    const std::int32_t sides[2] = {std::int32_t(edge.triangle),
                                   surface.triangles[edge.triangle].neighbour[edge.side]};
    for (const std::int32_t side : sides) {
      if (side < 0) continue;
      for (const std::uint32_t v : surface.triangles[side].corner) {
        if (v == edge.a || v == edge.b) continue;
        if (leads_toward(positions_[of.first + v] - at, away)) return false;
      }
    }
    return true;
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
  }

  const SurfaceCandidates& candidates_;
  std::span<const DVec3> positions_, moves_;
  std::span<const float> limits_, radii_;
  double least_gap_;
  Array<SurfacePair>& pairs_;
};

}  // namespace

void find_surface_pairs(std::span<const PlacedSurface> surfaces, std::span<const DVec3> positions,
                        std::span<const DVec3> moves, std::span<const float> limits, float least_gap,
                        Arena& arena, TaskSystem& tasks, PairSearch& search, Array<SurfacePair>& pairs) {
  const ArenaScope scope(arena);
  pairs.clear();
  if (surfaces.empty() || positions.empty()) return;
  const std::size_t count = positions.size();
  const std::span<float> radii = arena.make<float>(count), reach = arena.make<float>(count),
                         ahead = arena.make<float>(count);
  for (const PlacedSurface& placed : surfaces) {
    for (int i = 0; i < placed.surface->vertices; ++i) {
      const std::size_t v = placed.first + std::size_t(i);
      radii[v] = placed.surface->radius[i];
      reach[v] = limits[v] + radii[v];
      ahead[v] = reach[v] + kAheadOfRadius * radii[v];
    }
  }
  SurfaceCandidates& candidates = search.candidates;
  update_candidates(surfaces, positions, moves, spread_over_features(surfaces, reach, arena),
                    spread_over_features(surfaces, ahead, arena), arena, tasks, candidates);
  const std::span<FilterVertex> vertices = arena.make<FilterVertex>(count);
  fill_filter(positions, moves, reach, positions[surfaces[0].first], vertices);
  const FeatureFilters& filters = select_feature_filters();
  const int corners = int(candidates.corners.size()), edges = int(candidates.edges.size());
  const int corner_blocks = count_blocks(corners, kBlockCandidates);
  search.found.resize(std::size_t(tasks.worker_count()));
  for (Array<SurfacePair>& one : search.found) one.clear();
  search.blocks.resize(std::size_t(corner_blocks + count_blocks(edges, kBlockCandidates)));
  for_blocks(tasks, int(search.blocks.size()), 1, [&](int block, int, int worker) {
    Array<SurfacePair>& found = search.found[std::size_t(worker)];
    PairFinder finder(candidates, positions, moves, limits, radii, least_gap, found);
    FoundPairs& out = search.blocks[block];
    out = {worker, found.size(), 0};
    const bool of_corners = block < corner_blocks;
    const int first = (of_corners ? block : block - corner_blocks) * kBlockCandidates;
    const int some = min(kBlockCandidates, (of_corners ? corners : edges) - first);
    const SurfaceCandidate* const from = (of_corners ? candidates.corners : candidates.edges).data() + first;
    std::uint32_t kept[kBlockCandidates + 8];
    const int near = (of_corners ? filters.corners : filters.edges)(from, some, vertices.data(), kept);
    for (int i = 0; i < near; ++i) {
      if (of_corners)
        finder.add_corner(from[kept[i]]);
      else
        finder.add_edges(from[kept[i]]);
    }
    out.end = found.size();
  });
  for (const FoundPairs& block : search.blocks) {
    const Array<SurfacePair>& found = search.found[std::size_t(block.worker)];
    for (std::size_t i = block.begin; i < block.end; ++i) pairs.push_back(found[i]);
  }
}

}  // namespace gyre
