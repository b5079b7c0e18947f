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

// The ends of the edge are on different sides of the triangle, and it has a point in common with it.
bool segment_passes_triangle(DVec3 p, DVec3 q, DVec3 a, DVec3 b, DVec3 c) {
  return orient3(a, b, c, p) * orient3(a, b, c, q) < 0 && segment_meets_triangle(p, q, a, b, c);
}

using SegmentTest = bool (*)(DVec3, DVec3, DVec3, DVec3, DVec3);

// Calls visit(crossing) for each edge of one surface that meets a triangle of the other by the test.
template <class Visit>
class CrossingSearch {
 public:
  CrossingSearch(std::span<const DVec3> positions, SegmentTest test, Visit& visit)
      : positions_(positions), test_(test), visit_(visit) {}

  void search(std::span<const SurfaceBoxes> boxes, std::uint32_t s, std::uint32_t t) {
    for_each_triangle_pair(boxes[s], boxes[t], [&](std::uint32_t i, std::uint32_t k) {
      visit_owned_edges(boxes, s, i, t, k);
      visit_owned_edges(boxes, t, k, s, i);
    });
  }

 private:
  // Edges that triangle i of surface s owns, against triangle k of surface t.
  void visit_owned_edges(std::span<const SurfaceBoxes> boxes, std::uint32_t s, std::uint32_t i,
                         std::uint32_t t, std::uint32_t k) {
    const SurfaceBoxes &a = boxes[s], &b = boxes[t];
    const SoftTriangle& from = a.surface->triangles[i];
    const SoftTriangle& to = b.surface->triangles[k];
    for (const std::int32_t number : from.owned_edge) {
      if (number < 0) continue;
      const SurfaceEdge edge = a.surface->edges[number];
      if (s == t && shares(edge.a, to) + shares(edge.b, to) > 0) continue;
      if (!may_meet(merge(a.vertices[edge.a], a.vertices[edge.b]), b.triangles[k])) continue;
      const auto at = [&](std::uint32_t corner) { return positions_[b.first + to.corner[corner]]; };
      if (test_(positions_[a.first + edge.a], positions_[a.first + edge.b], at(0), at(1), at(2)))
        visit_(EdgeCrossing{s, std::uint32_t(number), t, k});
    }
  }
  static int shares(std::uint32_t v, const SoftTriangle& one) {
    return one.corner[0] == v || one.corner[1] == v || one.corner[2] == v;
  }

  std::span<const DVec3> positions_;
  SegmentTest test_;
  Visit& visit_;
};

template <class Visit>
void for_each_crossing(std::span<const PlacedSurface> surfaces, std::span<const DVec3> positions,
                       SegmentTest test, Arena& arena, Visit&& visit) {
  const ArenaScope scope(arena);
  if (surfaces.empty() || positions.empty()) return;
  const DVec3 origin = positions[surfaces[0].first];
  const std::span<SurfaceBoxes> boxes = arena.make<SurfaceBoxes>(surfaces.size());
  for (std::size_t i = 0; i < surfaces.size(); ++i)
    boxes[i] = fit_boxes(surfaces[i], positions, {}, origin, arena);
  CrossingSearch search(positions, test, visit);
  for (std::uint32_t i = 0; i < std::uint32_t(boxes.size()); ++i) {
    for (std::uint32_t k = i; k < std::uint32_t(boxes.size()); ++k) search.search(boxes, i, k);
  }
}

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
  long count = 0;
  for_each_crossing(surfaces, positions, segment_meets_triangle, arena,
                    [&](const EdgeCrossing&) { ++count; });
  return count;
}

void list_passing_edges(std::span<const PlacedSurface> surfaces, std::span<const DVec3> positions,
                        Arena& arena, Array<EdgeCrossing>& crossings) {
  crossings.clear();
  for_each_crossing(surfaces, positions, segment_passes_triangle, arena,
                    [&](const EdgeCrossing& one) { crossings.push_back(one); });
}

}  // namespace gyre
