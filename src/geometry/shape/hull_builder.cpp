// Cooking of hulls: points to grid, quickhull, thinning, polygons, columns. See hull_builder.h.
#include "geometry/shape/hull_builder.h"

#include "base/float_mode.h"
#include "base/hash.h"
#include "geometry/shape/cooked.h"
#include "geometry/shape/hull_faces.h"
#include "geometry/shape/quickhull.h"
#include "geometry/shape/shape.h"

#include <cstring>

namespace gyre {
namespace {

// The points on a grid that spans their largest extent, and the tolerances there.
struct Grid {
  DVec3 origin;            // m, the grid's (0, 0, 0)
  double step = 1.0;       // m
  double tolerance = 1.0;  // in steps
  std::vector<GridPoint> points;
};

Error check_points(std::span<const Vec3> points) {
  for (std::size_t i = 0; i < points.size(); ++i) {
    const Vec3 p = points[i];
    if (is_finite(p) && largest(absolute(p)) <= kMaxLength) continue;
    return make_error(ErrorCode::invalid_geometry,
                      "hull: point %zu is (%g, %g, %g); allowed are finite coordinates within -%g to %g m", i,
                      double(p.x), double(p.y), double(p.z), double(kMaxLength), double(kMaxLength));
  }
  if (points.size() >= 4) return {};
  return make_error(ErrorCode::invalid_geometry,
                    "hull: %zu points; allowed are at least 4 that span a volume", points.size());
}

Grid make_grid(std::span<const Vec3> points) {
  Vec3 low = points[0], high = points[0];
  for (const Vec3& p : points) {
    low = min(low, p);
    high = max(high, p);
  }
  const DVec3 size = DVec3(high) - DVec3(low);
  const double extent = max(size.x, max(size.y, size.z));
  const double largest_coordinate = double(max(largest(absolute(low)), largest(absolute(high))));
  Grid grid;
  grid.origin = DVec3(low);
  if (!(extent >= double(kMinLength))) return grid;
  grid.step = extent / double(kGridSize);
  // Points far from their origin have only the precision of a float there (3 half steps of 2^-24).
  grid.tolerance = max(kHullTolerance * extent, 1.8e-7 * largest_coordinate) / grid.step;
  grid.points.reserve(points.size());
  const auto snap = [&](float value, double origin) {
    return std::int32_t((double(value) - origin) / grid.step + 0.5);
  };
  for (const Vec3& p : points) {
    grid.points.push_back({snap(p.x, grid.origin.x), snap(p.y, grid.origin.y), snap(p.z, grid.origin.z)});
  }
  return grid;
}

Error span_error(GridSpan span, std::size_t count, double tolerance) {
  const char* const shapes[] = {"span a volume", "coincide", "lie on one line", "lie in one plane"};
  return make_error(ErrorCode::invalid_geometry,
                    "hull: all %zu points %s (tolerance %g m); allowed are points that span a volume", count,
                    shapes[int(span)], tolerance);
}

// ------------------------------------------------------------------------------------------------------- thinning

// A hull of few points. `chosen` has their numbers in the input, the best first; all are vertices of `hull`, whose
// indices are into `points`.
struct HullCandidate {
  std::vector<int> chosen;
  std::vector<GridPoint> points;
  GridHull hull;
};

DVec3 to_point(const GridPoint& p) { return {double(p.x), double(p.y), double(p.z)}; }

// The hull of some points of the grid. `hull.span` says if they span no volume.
HullCandidate make_candidate(std::span<const GridPoint> all, std::span<const int> chosen, double flat) {
  HullCandidate out;
  std::vector<int> order;
  for (const int i : chosen) {
    order.push_back(int(order.size()));
    out.points.push_back(all[std::size_t(i)]);
  }
  out.hull = quickhull(out.points, order, {.tolerance = 0.0, .flat = flat, .vertices = 4});
  if (out.hull.vertices.size() == chosen.size() || out.hull.span != GridSpan::volume) {
    out.chosen.assign(chosen.begin(), chosen.end());
    return out;
  }
  // Some points lie inside the hull of the others. Build it again without them; then all are vertices.
  std::vector<int> fewer;
  for (const int i : out.hull.vertices) fewer.push_back(chosen[std::size_t(i)]);
  return make_candidate(all, fewer, flat);
}

// A lower bound of the distance of each vertex outside the hull of the others: along the mean normal of its faces,
// where the next vertex is one of its neighbours. It is cheap, and nearly always enough to retain the vertex.
std::vector<double> stick_out_bounds(const HullCandidate& body) {
  const auto at = [&](int i) { return to_point(body.points[std::size_t(i)]); };
  std::vector<DVec3> normals(body.points.size());
  for (const GridTriangle& t : body.hull.triangles) {
    const DVec3 a = at(t.vertices[0]);
    const DVec3 n = cross(at(t.vertices[1]) - a, at(t.vertices[2]) - a);
    for (const int v : t.vertices) normals[std::size_t(v)] += n / length(n);
  }
  std::vector<double> bounds(body.points.size(), 1.0e300);
  for (const GridTriangle& t : body.hull.triangles) {
    for (int e = 0; e < 3; ++e) {
      const int v = t.vertices[e], other = t.vertices[(e + 1) % 3];
      const DVec3 n = normals[std::size_t(v)];
      const double height = dot(n, at(v) - at(other)) / max(length(n), 1.0e-12);
      bounds[std::size_t(v)] = min(bounds[std::size_t(v)], height);
    }
  }
  return bounds;
}

// The distance of a vertex outside the hull of the others. Only its neighbours span the surface that would replace it,
// so this is its distance from their triangles: from all of them or, if there are many, from those of their hull.
double stick_out(std::span<const GridPoint> all, const HullCandidate& body, int vertex, double flat) {
  std::vector<int> neighbors;
  for (const GridTriangle& t : body.hull.triangles) {
    for (int e = 0; e < 3; ++e) {
      if (t.vertices[e] == vertex) neighbors.push_back(t.vertices[(e + 1) % 3]);
    }
  }
  const std::size_t count = neighbors.size();
  constexpr std::size_t kFew = 16;
  if (count > kFew) {
    std::vector<int> others = body.chosen;
    others.erase(others.begin() + vertex);
    const HullCandidate rest = make_candidate(all, others, flat);
    if (rest.hull.span != GridSpan::volume) return 1.0e300;
    return distance_outside(rest.points, rest.hull.triangles, body.points[std::size_t(vertex)]);
  }
  const auto at = [&](std::size_t i) { return to_point(body.points[std::size_t(neighbors[i])]); };
  const DVec3 p = to_point(body.points[std::size_t(vertex)]);
  double nearest = 1.0e300;
  for (std::size_t i = 0; i < count; ++i) {
    for (std::size_t j = i + 1; j < count; ++j) {
      for (std::size_t k = j + 1; k < count; ++k)
        nearest = min(nearest, distance_to_triangle(p, at(i), at(j), at(k)));
    }
  }
  return nearest;
}

// Removes vertices that are at most `tolerance` outside the hull of the others, the last first, until none is left.
// Returns true if any was removed.
bool thin(std::span<const GridPoint> all, HullCandidate& body, double tolerance, double flat) {
  bool any = false;
  for (bool changed = true; changed;) {
    changed = false;
    std::vector<double> bounds = stick_out_bounds(body);
    for (std::size_t i = body.chosen.size(); i-- > 0 && body.chosen.size() > 4;) {
      if (bounds[i] > tolerance || stick_out(all, body, int(i), flat) > tolerance) continue;
      std::vector<int> others = body.chosen;
      others.erase(others.begin() + std::ptrdiff_t(i));
      HullCandidate rest = make_candidate(all, others, flat);
      if (rest.hull.span != GridSpan::volume) continue;
      body = std::move(rest);
      bounds = stick_out_bounds(body);
      i = min(i, body.chosen.size());
      any = changed = true;
    }
  }
  return any;
}

// The thinned hull of at most `limit` vertices.
HullCandidate thin_hull(const Grid& grid, int limit, double flat) {
  // Half of the tolerance is for points outside, half for removed vertices.
  const QuickhullLimits limits{.tolerance = 0.5 * grid.tolerance, .flat = flat, .vertices = limit};
  HullCandidate body;
  for (int round = 0; round < 4; ++round) {
    const GridHull hull = quickhull(grid.points, body.chosen, limits);
    if (hull.span != GridSpan::volume) {
      body.hull.span = hull.span;
      return body;
    }
    body = make_candidate(grid.points, hull.vertices, flat);
    if (body.hull.span != GridSpan::volume) return body;
    const bool removed = thin(grid.points, body, 0.5 * grid.tolerance, flat);
    // Removed vertices make room for others.
    if (hull.complete || !removed || int(body.chosen.size()) >= limit) break;
  }
  return body;
}

// -------------------------------------------------------------------------------------------------------- the Hull

struct Polygons {
  // The number in the input of each vertex, ascending.
  std::vector<int> inputs;
  // The vertices in grid steps.
  std::vector<DVec3> points_on_grid;
  std::vector<FaceLoop> loops;
};

Polygons make_polygons(const Grid& grid, const HullCandidate& body) {
  Polygons out;
  const std::size_t count = body.chosen.size();
  std::vector<std::uint8_t> vertex_of(count);
  for (std::size_t i = 0; i < count; ++i) {
    std::size_t rank = 0;
    for (std::size_t j = 0; j < count; ++j) rank += body.chosen[j] < body.chosen[i] ? 1 : 0;
    vertex_of[i] = std::uint8_t(rank);
  }
  out.inputs.resize(count);
  out.points_on_grid.resize(count);
  for (std::size_t i = 0; i < count; ++i) {
    out.inputs[vertex_of[i]] = body.chosen[i];
    out.points_on_grid[vertex_of[i]] = to_point(body.points[i]);
  }
  std::vector<FaceLoop> triangles;
  for (const GridTriangle& t : body.hull.triangles) {
    FaceLoop& loop = triangles.emplace_back();
    for (const int v : t.vertices) loop.push_back(vertex_of[std::size_t(v)]);
  }
  // Faces are at most four tolerances thick: too flat for any contact to notice, and enough for models with six digits.
  out.loops = join_flat_faces(out.points_on_grid, triangles, 2.0 * grid.tolerance);
  return out;
}

// The plane through the face with all vertices on or below it.
HullPlane make_plane(const Polygons& polygons, const FaceLoop& loop, std::span<const Vec3> vertices) {
  const DVec3 n = loop_normal(polygons.points_on_grid, loop);
  HullPlane plane{};
  plane.normal = normalized(to_float(n / length(n)));
  double offset = dot(DVec3(plane.normal), DVec3(vertices[0]));
  for (const Vec3& v : vertices) offset = max(offset, dot(DVec3(plane.normal), DVec3(v)));
  plane.offset = float(offset);
  return plane;
}

void fill_edges(Hull& hull) {
  std::vector<int> face_of(256 * 256, -1);
  for (int pass = 0; pass < 2; ++pass) {
    for (int f = 0; f < hull.face_count(); ++f) {
      const std::uint32_t begin = hull.face_offsets[std::size_t(f)],
                          end = hull.face_offsets[std::size_t(f) + 1];
      for (std::uint32_t i = begin; i < end; ++i) {
        const std::uint8_t from = hull.face_vertices[i];
        const std::uint8_t to = hull.face_vertices[i + 1 < end ? i + 1 : begin];
        if (pass == 0) {
          face_of[std::size_t(from * 256 + to)] = f;
        } else if (const int other = face_of[std::size_t(to * 256 + from)]; f < other) {
          hull.edges.push_back({from, to, std::uint8_t(f), std::uint8_t(other), {}});
        }
      }
    }
  }
}

// The centre of the volume, by tetrahedra from a vertex.
Vec3 volume_center(const Grid& grid, const HullCandidate& body) {
  const DVec3 apex = to_point(body.points[0]);
  const auto at = [&](int i) { return to_point(body.points[std::size_t(i)]) - apex; };
  double volume = 0.0;
  DVec3 moment;
  for (const GridTriangle& t : body.hull.triangles) {
    const DVec3 a = at(t.vertices[0]), b = at(t.vertices[1]), c = at(t.vertices[2]);
    const double volume_of_one = dot(a, cross(b, c));
    volume += volume_of_one;
    moment += volume_of_one * 0.25 * (a + b + c);
  }
  return to_float(grid.origin + grid.step * (apex + moment / volume));
}

Hull make_hull(std::span<const Vec3> points, const Grid& grid, const HullCandidate& body,
               const Polygons& polygons) {
  Hull hull;
  for (const int point : polygons.inputs) hull.vertices.push_back(points[std::size_t(point)]);
  hull.centroid = volume_center(grid, body);
  hull.face_offsets.push_back(0);
  hull.inner_radius = kUnbounded;
  for (const FaceLoop& loop : polygons.loops) {
    const HullPlane plane = make_plane(polygons, loop, hull.vertices);
    hull.planes.push_back(plane);
    hull.face_vertices.insert(hull.face_vertices.end(), loop.begin(), loop.end());
    hull.face_offsets.push_back(std::uint32_t(hull.face_vertices.size()));
    hull.inner_radius = min(hull.inner_radius, plane.offset - dot(plane.normal, hull.centroid));
  }
  hull.inner_radius = max(hull.inner_radius, 0.0f);
  fill_edges(hull);
  complete_hull(hull);
  return hull;
}

std::uint64_t hash_hull(const Hull& hull) {
  Hasher hasher;
  hasher.add(std::uint64_t(ShapeKind::hull));
  hasher.add(std::uint64_t(hull.vertices.size()));
  for (const Vec3& v : hull.vertices) {
    for (int axis = 0; axis < 3; ++axis) {
      std::uint32_t bits;
      const float value = v[axis];
      std::memcpy(&bits, &value, sizeof bits);
      hasher.add(std::uint64_t(bits));
    }
  }
  for (const std::uint32_t offset : hull.face_offsets) hasher.add(std::uint64_t(offset));
  for (const std::uint8_t vertex : hull.face_vertices) hasher.add(std::uint64_t(vertex));
  return hasher.value();
}

}  // namespace

Result<Hull> build_hull(std::span<const Vec3> points) {
  if (const Error error = check_points(points)) return error;
  const Grid grid = make_grid(points);
  if (grid.points.empty()) return span_error(GridSpan::point, points.size(), double(kMinLength));
  const double flat = 4.0 * grid.tolerance;

  HullCandidate body = thin_hull(grid, kMaxHullVertices, flat);
  if (body.hull.span != GridSpan::volume) return span_error(body.hull.span, points.size(), flat * grid.step);
  Polygons polygons = make_polygons(grid, body);
  // Too many faces: use fewer vertices, from the start of the list, which is the best choice of its length. V vertices
  // have at most 2 V - 4 faces, so 129 are always few enough.
  while (int(polygons.loops.size()) > kMaxHullFaces) {
    const std::size_t excess = polygons.loops.size() - std::size_t(kMaxHullFaces);
    const std::vector<int> fewer(body.chosen.begin(), body.chosen.end() - std::ptrdiff_t((excess + 1) / 2));
    body = make_candidate(grid.points, fewer, 1.0);
    polygons = make_polygons(grid, body);
  }
  return make_hull(points, grid, body, polygons);
}

Result<Geometry> cook_hull(std::span<const Vec3> points) {
  const FloatMode mode;
  Result<Hull> hull = build_hull(points);
  if (!hull) return hull.error();
  auto data = std::make_shared<CookedGeometry>();
  data->kind = ShapeKind::hull;
  data->content_hash = hash_hull(*hull);
  data->hull = std::make_unique<Hull>(std::move(*hull));
  return Geometry(std::move(data));
}

}  // namespace gyre
