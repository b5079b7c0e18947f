#include "soft/contact/surface_tangle.h"

#include "base/container/sort.h"

#include <cmath>

namespace gyre {

namespace {

// The slope of an edge against a triangle, E.N, is taken to be no less: nearly parallel ones would be sent far away.
constexpr double kMinSlope = 0.1;
// A gradient of the contour that is shorter than this (of 1: an end of the line) knows no way: the line is nearly straight there.
constexpr double kMinGradient = 0.1;

// The pieces of a surface without the edges that cross another one.
class Pieces {
 public:
  Pieces(const SoftSurface& surface, std::span<const std::uint8_t> cut, Arena& arena)
      : root_(arena.make<std::uint32_t>(std::size_t(surface.vertices))),
        size_(arena.make<std::uint32_t>(std::size_t(surface.vertices))) {
    for (std::size_t v = 0; v < root_.size(); ++v) root_[v] = std::uint32_t(v), size_[v] = 1;
    for (std::size_t i = 0; i < surface.edges.size(); ++i)
      if (cut[i] == 0) join(surface.edges[i].a, surface.edges[i].b);
  }
  // 1: a is in a larger piece than b; -1: in a smaller one; 0: in the same. Of equal ones that with the lowest vertex is larger.
  int compare(std::uint32_t a, std::uint32_t b) {
    const std::uint32_t p = find(a), q = find(b);
    if (p == q) return 0;
    if (size_[p] != size_[q]) return size_[p] > size_[q] ? 1 : -1;
    return p < q ? 1 : -1;
  }

 private:
  std::uint32_t find(std::uint32_t v) {
    while (root_[v] != v) {
      root_[v] = root_[root_[v]];
      v = root_[v];
    }
    return v;
  }
  void join(std::uint32_t a, std::uint32_t b) {
    const std::uint32_t p = find(a), q = find(b);
    if (p == q) return;
    const std::uint32_t low = min(p, q), high = max(p, q);
    root_[high] = low;
    size_[low] += size_[high];
  }

  std::span<std::uint32_t> root_, size_;  // a root is the lowest vertex of its piece
};

DVec3 unit(DVec3 v) {
  const double size = length(v);
  return size > 0.0 ? v / size : DVec3{};
}

class TangleFinder {
 public:
  TangleFinder(std::span<const PlacedSurface> surfaces, std::span<const DVec3> positions, Arena& arena,
               SurfaceTangle& out)
      : surfaces_(surfaces), positions_(positions), arena_(arena), out_(out) {}

  // Crossings [begin, end) are those of edges of one surface with triangles of another.
  void add(std::size_t begin, std::size_t end) {
    const ArenaScope scope(arena_);
    const PlacedSurface& s = surfaces_[out_.crossings[begin].edge_surface];
    const std::span<std::uint8_t> cut = arena_.make<std::uint8_t>(s.surface->edges.size());
    for (std::uint8_t& one : cut) one = 0;
    for (std::size_t i = begin; i < end; ++i) cut[out_.crossings[i].edge] = 1;
    Pieces pieces(*s.surface, cut, arena_);
    for (std::size_t i = begin; i < end; ++i) add(out_.crossings[i], pieces);
  }

 private:
  DVec3 at(std::uint32_t vertex) const { return positions_[vertex]; }

  void add(const EdgeCrossing& one, Pieces& pieces) {
    const PlacedSurface &s = surfaces_[one.edge_surface], &t = surfaces_[one.triangle_surface];
    const SurfaceEdge& edge = s.surface->edges[one.edge];
    const SoftTriangle& triangle = t.surface->triangles[one.triangle];
    TangledEdge row;
    row.vertex[0] = s.first + edge.a, row.vertex[1] = s.first + edge.b;
    for (int k = 0; k < 3; ++k) row.vertex[2 + k] = t.first + triangle.corner[k];
    const std::uint64_t to_t = std::uint64_t(1) << (one.triangle_surface % 64u),
                        to_s = std::uint64_t(1) << (one.edge_surface % 64u);
    for (int k = 0; k < 5; ++k) out_.partners[row.vertex[k]] |= k < 2 ? to_t : to_s;
    const DVec3 origin = at(row.vertex[2]);
    const DVec3 p = at(row.vertex[0]) - origin, q = at(row.vertex[1]) - origin;
    const DVec3 u = at(row.vertex[3]) - origin, v = at(row.vertex[4]) - origin;
    const DVec3 area = cross(u, v), normal = unit(area), along = unit(q - p);
    const double high = dot(normal, p), low = dot(normal, q);
    if (!(absolute(high - low) > 0.0)) return;
    const double part = clamp(high / (high - low), 0.0, 1.0);
    const DVec3 point = p + part * (q - p);
    const double size = length_squared(area);
    const double b = clamp(dot(area, cross(point, v)) / size, 0.0, 1.0),
                 c = clamp(dot(area, cross(u, point)) / size, 0.0, 1.0 - b);
    row.weight[1] = float(part), row.weight[0] = 1.0f - row.weight[1];
    row.weight[3] = -float(b), row.weight[4] = -float(c);
    row.weight[2] = -1.0f - row.weight[3] - row.weight[4];
    row.edge = min(s.surface->mean_edge, t.surface->mean_edge);
    const int larger = pieces.compare(edge.a, edge.b);
    if (larger != 0) {
      row.way = to_float(((high > low) == (larger > 0) ? 1.0 : -1.0) * normal);
    } else {
      const DVec3 gradient = gradient_of(s, edge, along, normal);
      const double steep = length(gradient);
      if (!(steep > kMinGradient)) return;
      row.way = to_float(gradient / steep);
      row.share = float(min(steep, 1.0));
    }
    out_.edges.push_back(row);
  }

  // How the line of intersection gets shorter if the edge moves against a triangle of this normal.
  DVec3 gradient_of(const PlacedSurface& s, const SurfaceEdge& edge, DVec3 along, DVec3 normal) const {
    const SoftTriangle& owner = s.surface->triangles[edge.triangle];
    const std::int32_t both[2] = {std::int32_t(edge.triangle), owner.neighbour[edge.side]};
    double slope = dot(along, normal);
    if (absolute(slope) < kMinSlope) slope = slope < 0.0 ? -kMinSlope : kMinSlope;
    DVec3 sum{};
    for (const std::int32_t number : both) {
      if (number < 0) continue;
      const SoftTriangle& one = s.surface->triangles[std::size_t(number)];
      const DVec3 first = at(s.first + edge.a);
      DVec3 inward{}, face{};
      for (const std::uint32_t corner : one.corner) {
        if (corner == edge.a || corner == edge.b) continue;
        const DVec3 to = at(s.first + corner) - first;
        inward = to - dot(to, along) * along;
        face = cross(along, to);
      }
      DVec3 line = unit(cross(normal, face));
      if (dot(line, inward) < 0.0) line = -line;
      sum += line - (dot(along, line) / slope) * normal;
    }
    return sum;
  }

  std::span<const PlacedSurface> surfaces_;
  std::span<const DVec3> positions_;
  Arena& arena_;
  SurfaceTangle& out_;
};

void sort_by_surfaces(Array<EdgeCrossing>& crossings, Arena& arena) {
  const ArenaScope scope(arena);
  merge_sort(std::span<EdgeCrossing>(crossings.data(), crossings.size()),
             arena.make<EdgeCrossing>(crossings.size()), [](const EdgeCrossing& a, const EdgeCrossing& b) {
               return a.edge_surface != b.edge_surface ? a.edge_surface < b.edge_surface
                                                       : a.triangle_surface < b.triangle_surface;
             });
}

// An explicit integrator that gains energy comes to places whose products are beyond the range of doubles.
bool are_in_range(std::span<const DVec3> positions) {
  constexpr double kFarthest = 1.0e30;  // m: three of them multiply
  bool all = true;
  for (const DVec3 p : positions) {
    all = all && absolute(p.x) < kFarthest && absolute(p.y) < kFarthest && absolute(p.z) < kFarthest;
  }
  return all;
}

// Gives the marks of each vertex to those that share an edge with it: those are the next to go through, and their pairs would keep them a
// thickness away.
void spread(std::span<const PlacedSurface> surfaces, Array<std::uint64_t>& marks, Arena& arena) {
  const ArenaScope scope(arena);
  const std::span<std::uint64_t> before = arena.make<std::uint64_t>(marks.size());
  for (std::size_t v = 0; v < before.size(); ++v) before[v] = marks[v];
  for (const PlacedSurface& placed : surfaces) {
    const SoftSurface& surface = *placed.surface;
    for (std::uint32_t i = 0; i < std::uint32_t(surface.vertices); ++i) {
      for (std::uint32_t n = surface.around_begin[i]; n < surface.around_begin[i + 1]; ++n)
        marks[placed.first + i] |= before[placed.first + surface.around[n]];
    }
  }
}

}  // namespace

bool SurfaceTangle::has(const SurfacePair& pair) const {
  std::uint64_t crossed[2] = {};
  for (int k = 0; k < 4; ++k) crossed[k < pair.on_a ? 0 : 1] |= partners[pair.vertex[k]];
  const std::uint32_t a = surface[pair.vertex[0]], b = surface[pair.vertex[pair.on_a]];
  return (crossed[0] >> (b % 64u) & 1u) != 0 && (crossed[1] >> (a % 64u) & 1u) != 0;
}

void find_tangle(std::span<const PlacedSurface> surfaces, std::span<const DVec3> positions, Arena& arena,
                 SurfaceTangle& tangle) {
  tangle.edges.clear(), tangle.surface.clear(), tangle.partners.clear();
  tangle.crossings.clear();
  if (!are_in_range(positions)) return;
  list_passing_edges(surfaces, positions, arena, tangle.crossings);
  std::size_t kept = 0;
  for (const EdgeCrossing& one : tangle.crossings) {
    const bool is_self = one.edge_surface == one.triangle_surface;
    if (!is_self || surfaces[one.edge_surface].surface->self_collision) tangle.crossings[kept++] = one;
  }
  tangle.crossings.resize(kept);
  if (tangle.empty()) return;
  sort_by_surfaces(tangle.crossings, arena);
  tangle.partners.assign(positions.size(), std::uint64_t(0));
  tangle.surface.assign(positions.size(), 0u);
  for (std::uint32_t i = 0; i < std::uint32_t(surfaces.size()); ++i) {
    for (int v = 0; v < surfaces[i].surface->vertices; ++v)
      tangle.surface[surfaces[i].first + std::uint32_t(v)] = i;
  }
  TangleFinder finder(surfaces, positions, arena, tangle);
  for (std::size_t begin = 0; begin < kept;) {
    const EdgeCrossing& first = tangle.crossings[begin];
    std::size_t end = begin;
    while (end < kept && tangle.crossings[end].edge_surface == first.edge_surface &&
           tangle.crossings[end].triangle_surface == first.triangle_surface)
      ++end;
    finder.add(begin, end);
    begin = end;
  }
  spread(surfaces, tangle.partners, arena);
}

void leave_out(const SurfaceTangle& tangle, Array<SurfacePair>& pairs) {
  if (tangle.empty()) return;
  std::size_t kept = 0;
  for (const SurfacePair& pair : pairs)
    if (!tangle.has(pair)) pairs[kept++] = pair;
  pairs.resize(kept);
}

}  // namespace gyre
