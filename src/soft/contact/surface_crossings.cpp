#include "soft/contact/surface_crossings.h"

#include "soft/contact/orientation.h"

namespace gyre {

namespace {

PlanePoint project(DVec3 p, int axis) {
  return axis == 0 ? PlanePoint{p.y, p.z} : axis == 1 ? PlanePoint{p.z, p.x} : PlanePoint{p.x, p.y};
}

// `p` on the line of a-b: within the stretch from a to b.
bool within(PlanePoint p, PlanePoint a, PlanePoint b) {
  return min(a.u, b.u) <= p.u && p.u <= max(a.u, b.u) && min(a.v, b.v) <= p.v && p.v <= max(a.v, b.v);
}

bool segments_meet(PlanePoint p, PlanePoint q, PlanePoint a, PlanePoint b) {
  const int pa = orient2(a, b, p), qa = orient2(a, b, q), ap = orient2(p, q, a), bp = orient2(p, q, b);
  if (pa * qa < 0 && ap * bp < 0) return true;
  return (pa == 0 && within(p, a, b)) || (qa == 0 && within(q, a, b)) || (ap == 0 && within(a, p, q)) ||
         (bp == 0 && within(b, p, q));
}

bool inside(PlanePoint p, PlanePoint a, PlanePoint b, PlanePoint c) {
  const int x = orient2(a, b, p), y = orient2(b, c, p), z = orient2(c, a, p);
  return (x >= 0 && y >= 0 && z >= 0) || (x <= 0 && y <= 0 && z <= 0);
}

// Figures of one plane meet if their images do in all three projections: at least one of these is one to one.
bool coplanar_segments_meet(DVec3 p, DVec3 q, DVec3 a, DVec3 b) {
  for (int axis = 0; axis < 3; ++axis) {
    if (!segments_meet(project(p, axis), project(q, axis), project(a, axis), project(b, axis))) return false;
  }
  return true;
}

bool coplanar_triangle_meets(DVec3 p, DVec3 q, DVec3 a, DVec3 b, DVec3 c) {
  for (int axis = 0; axis < 3; ++axis) {
    const PlanePoint s = project(p, axis), t = project(q, axis);
    const PlanePoint u = project(a, axis), v = project(b, axis), w = project(c, axis);
    if (!inside(s, u, v, w) && !segments_meet(s, t, u, v) && !segments_meet(s, t, v, w) &&
        !segments_meet(s, t, w, u)) {
      return false;
    }
  }
  return true;
}

bool has_area(DVec3 a, DVec3 b, DVec3 c) {
  for (int axis = 0; axis < 3; ++axis) {
    if (orient2(project(a, axis), project(b, axis), project(c, axis)) != 0) return true;
  }
  return false;
}

bool any_segments_meet(DVec3 p, DVec3 q, DVec3 a, DVec3 b) {
  return orient3(p, q, a, b) == 0 && coplanar_segments_meet(p, q, a, b);
}

class CrossingCount {
 public:
  CrossingCount(std::span<const DVec3> positions) : positions_(positions) {}

  void add(const SurfaceBoxes& a, const SurfaceBoxes& b) {
    for_each_triangle_pair(a, b, [&](std::uint32_t i, std::uint32_t k) {
      count_ += owned_edges(a, i, b, k) + owned_edges(b, k, a, i);
    });
  }
  long count() const { return count_; }

 private:
  // Edges that triangle i owns, against triangle k.
  long owned_edges(const SurfaceBoxes& a, std::uint32_t i, const SurfaceBoxes& b, std::uint32_t k) const {
    const SoftTriangle& from = a.surface->triangles[i];
    const SoftTriangle& to = b.surface->triangles[k];
    const bool same = a.surface == b.surface && a.first == b.first;
    long found = 0;
    for (const std::int32_t number : from.owned_edge) {
      if (number < 0) continue;
      const SurfaceEdge edge = a.surface->edges[number];
      if (same && shares(edge.a, to) + shares(edge.b, to) > 0) continue;
      if (!overlap(merge(a.vertices[edge.a], a.vertices[edge.b]), b.triangles[k])) continue;
      const auto at = [&](std::uint32_t corner) { return positions_[b.first + to.corner[corner]]; };
      found += segment_meets_triangle(positions_[a.first + edge.a], positions_[a.first + edge.b], at(0),
                                      at(1), at(2));
    }
    return found;
  }
  static int shares(std::uint32_t v, const SoftTriangle& one) {
    return one.corner[0] == v || one.corner[1] == v || one.corner[2] == v;
  }

  std::span<const DVec3> positions_;
  long count_ = 0;
};

}  // namespace

bool segment_meets_triangle(DVec3 p, DVec3 q, DVec3 a, DVec3 b, DVec3 c) {
  const int side_p = orient3(a, b, c, p), side_q = orient3(a, b, c, q);
  if (side_p * side_q > 0) return false;
  if (side_p == 0 && side_q == 0) {
    if (has_area(a, b, c)) return coplanar_triangle_meets(p, q, a, b, c);
    return any_segments_meet(p, q, a, b) || any_segments_meet(p, q, b, c) || any_segments_meet(p, q, c, a);
  }
  const int x = orient3(p, q, a, b), y = orient3(p, q, b, c), z = orient3(p, q, c, a);
  return (x >= 0 && y >= 0 && z >= 0) || (x <= 0 && y <= 0 && z <= 0);
}

long count_crossings(std::span<const PlacedSurface> surfaces, std::span<const DVec3> positions,
                     Arena& arena) {
  const ArenaScope scope(arena);
  if (surfaces.empty() || positions.empty()) return 0;
  const DVec3 origin = positions[surfaces[0].first];
  const std::span<SurfaceBoxes> boxes = arena.make<SurfaceBoxes>(surfaces.size());
  for (std::size_t i = 0; i < surfaces.size(); ++i)
    boxes[i] = fit_boxes(surfaces[i], positions, {}, origin, arena);
  CrossingCount crossings(positions);
  for (std::size_t i = 0; i < boxes.size(); ++i) {
    for (std::size_t k = i; k < boxes.size(); ++k) crossings.add(boxes[i], boxes[k]);
  }
  return crossings.count();
}

}  // namespace gyre
