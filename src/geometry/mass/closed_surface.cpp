// Checks of surfaces. See closed_surface.h.
// Winding numbers: A. Jacobson, L. Kavan, O. Sorkine-Hornung, "Robust Inside-Outside Segmentation using Generalized Winding
// Numbers", 2013; here they are counted along one ray.
#include "geometry/mass/closed_surface.h"

#include "base/container/sort.h"
#include "geometry/query/box_cast.h"
#include "geometry/shape/shape.h"
#include "geometry/tree/static_tree.h"

#include <vector>

namespace gyre {
namespace {

// Pieces that touch or overlap by less than this fraction of the extent do not count as crossing.
constexpr double kTouching = 1.0e-6;

struct Triangle {
  DVec3 a, b, c;
};

Triangle triangle_at(const TriangleSurface& surface, std::uint32_t i) {
  return {surface.corner(i, 0), surface.corner(i, 1), surface.corner(i, 2)};
}

// The directed edge `half` = 3 * triangle + corner.
std::uint32_t edge_start(const TriangleSurface& s, std::uint32_t half) { return s.welded[s.indices[half]]; }
std::uint32_t edge_end(const TriangleSurface& s, std::uint32_t half) {
  return s.welded[s.indices[half % 3 == 2 ? half - 2 : half + 1]];
}

// `total`: how many triangles have the edge; an odd number leaves it open.
Error edge_error(const TriangleSurface& s, std::uint32_t half, int total) {
  const std::uint32_t from = edge_start(s, half), to = edge_end(s, half);
  if (total % 2 != 0) {
    return make_error(
        ErrorCode::invalid_geometry,
        "mesh: edge from vertex %u to %u of triangle %u is open (triangles with it: %d); allowed are closed "
        "surfaces, where another triangle runs back along each edge",
        from, to, s.name(half / 3), total);
  }
  return make_error(ErrorCode::invalid_geometry,
                    "mesh: edge from vertex %u to %u of triangle %u is run the same way by another triangle "
                    "(triangles with it: "
                    "%d); allowed are surfaces wound alike",
                    from, to, s.name(half / 3), total);
}

bool share_vertex(const TriangleSurface& s, std::uint32_t a, std::uint32_t b) {
  for (std::size_t i = 0; i < 3; ++i) {
    for (std::size_t j = 0; j < 3; ++j) {
      if (s.welded[s.indices[3 * std::size_t(a) + i]] == s.welded[s.indices[3 * std::size_t(b) + j]])
        return true;
    }
  }
  return false;
}

// True if the segment from p to q passes through the triangle, more than `slack` from its ends and from the edges.
bool passes_through(DVec3 p, DVec3 q, const Triangle& t, double slack) {
  const DVec3 n = cross(t.b - t.a, t.c - t.a);
  const double size = length(n);
  const double height_p = dot(n, p - t.a), height_q = dot(n, q - t.a);
  if (!(absolute(height_p) > slack * size && absolute(height_q) > slack * size)) return false;
  if ((height_p > 0.0) == (height_q > 0.0)) return false;
  const DVec3 along = q - p;
  const auto side_distance = [&](DVec3 a, DVec3 b) {
    // The distance of the two lines, with the side as its sign.
    const DVec3 m = cross(along, b - a);
    return dot(m, a - p) / max(length(m), 1.0e-300);
  };
  const double sides[3] = {side_distance(t.a, t.b), side_distance(t.b, t.c), side_distance(t.c, t.a)};
  return (sides[0] > slack && sides[1] > slack && sides[2] > slack) ||
         (sides[0] < -slack && sides[1] < -slack && sides[2] < -slack);
}

bool intersect(const Triangle& a, const Triangle& b, double slack) {
  return passes_through(a.a, a.b, b, slack) || passes_through(a.b, a.c, b, slack) ||
         passes_through(a.c, a.a, b, slack) || passes_through(b.a, b.b, a, slack) ||
         passes_through(b.b, b.c, a, slack) || passes_through(b.c, b.a, a, slack);
}

class CoverCheck {
 public:
  explicit CoverCheck(const TriangleSurface& surface);
  Error check();

 private:
  Error check_crossings(std::uint32_t i);
  Error check_sides(std::uint32_t i);
  bool count_crossings(std::uint32_t self, DVec3 from, DVec3 direction, int& count) const;

  const TriangleSurface& surface_;
  std::vector<Aabb> boxes_;
  StaticTree tree_;
  double slack_ = 0.0;
  float ray_length_ = 0.0f;
};

CoverCheck::CoverCheck(const TriangleSurface& surface) : surface_(surface) {
  Aabb all{surface.vertices[surface.indices[0]], surface.vertices[surface.indices[0]]};
  for (std::uint32_t i = 0; i < surface.triangle_count(); ++i) {
    const Triangle t = triangle_at(surface, i);
    const Vec3 a = to_float(t.a), b = to_float(t.b), c = to_float(t.c);
    boxes_.push_back({min(a, min(b, c)), max(a, max(b, c))});
    all = merge(all, boxes_.back());
  }
  const float extent = largest(all.high - all.low);
  slack_ = kTouching * double(extent);
  ray_length_ = 4.0f * extent;
  // More than the rounding of rays in float needs.
  const float margin =
      4.0f * float(kTouching) * max(extent, max(largest(absolute(all.low)), largest(absolute(all.high))));
  for (Aabb& box : boxes_) box = grow(box, margin);
  build_static_tree(boxes_, tree_);
}

Error CoverCheck::check_crossings(std::uint32_t i) {
  const Triangle a = triangle_at(surface_, i);
  std::uint32_t other = i;
  walk_overlaps(
      tree_, boxes_[i], [](std::uint32_t, int) { return true; },
      [&](std::uint32_t first, std::uint32_t count) {
        for (std::uint32_t k = first; k < first + count; ++k) {
          const std::uint32_t j = tree_.items[k];
          if (j <= i || (other != i && j > other) || !overlap(boxes_[i], boxes_[j])) continue;
          if (share_vertex(surface_, i, j)) continue;
          if (intersect(a, triangle_at(surface_, j), slack_)) other = j;
        }
      });
  if (other == i) return {};
  return make_error(
      ErrorCode::invalid_geometry,
      "mesh: triangles %u and %u cross each other; allowed are surfaces that do not pass through themselves",
      surface_.name(i), surface_.name(other));
}

// Counts crossings along the ray, +1 from inside to outside. Returns false if one is too close to an edge or to the
// start.
bool CoverCheck::count_crossings(std::uint32_t self, DVec3 from, DVec3 direction, int& count) const {
  bool certain = true;
  count = 0;
  const BoxRay ray(from, double(ray_length_) * direction, Vec3{});
  traverse_cast(tree_, ray, 1.0f, [&](std::uint32_t first, std::uint32_t leaf_size, float max_fraction) {
    for (std::uint32_t k = first; k < first + leaf_size; ++k) {
      const std::uint32_t j = tree_.items[k];
      if (j == self) continue;
      const Triangle t = triangle_at(surface_, j);
      const DVec3 a = t.a - from, b = t.b - from, c = t.c - from;
      const double u = dot(direction, cross(b, c)), v = dot(direction, cross(c, a)),
                   w = dot(direction, cross(a, b));
      const double facing = u + v + w;  // dot(direction, normal)
      const DVec3 n = cross(b - a, c - a);
      // A nearly parallel triangle counts as hit at its edge.
      const double unsure = 1.0e-9 * (absolute(u) + absolute(v) + absolute(w));
      const bool in = (u > unsure && v > unsure && w > unsure) || (u < -unsure && v < -unsure && w < -unsure);
      const bool out =
          (u < -unsure || v < -unsure || w < -unsure) && (u > unsure || v > unsure || w > unsure);
      if (out || !(length(n) > 0.0)) continue;
      if (!in) {
        certain = false;
        continue;
      }
      const double distance = dot(n, a) / dot(n, direction);
      if (absolute(distance) <= slack_) certain = false;
      if (distance > 0.0) count += facing > 0.0 ? 1 : -1;
    }
    return max_fraction;
  });
  return certain;
}

// A ray from the centre of the triangle must leave the others as often as it enters them, and once more if it starts
// into the solid.
Error CoverCheck::check_sides(std::uint32_t i) {
  const Triangle t = triangle_at(surface_, i);
  const DVec3 n = cross(t.b - t.a, t.c - t.a);
  const DVec3 middle = (t.a + t.b + t.c) / 3.0;
  // Directions with which models are hardly ever aligned. A triangle that no direction decides passes.
  constexpr DVec3 kDirections[3] = {
      {0.5377, 0.6184, 0.5731}, {-0.7071, 0.3317, 0.6245}, {0.2913, -0.8361, 0.4648}};
  for (const DVec3& direction : kDirections) {
    if (!(absolute(dot(n, direction)) > 1.0e-3 * length(n))) continue;
    int count = 0;
    if (!count_crossings(i, middle, direction, count)) continue;
    const int required = dot(n, direction) > 0.0 ? 0 : 1;
    if (count == required) return {};
    return make_error(
        ErrorCode::invalid_geometry,
        "mesh: triangle %u has the solid %d times behind and %d times before it; allowed is once behind and "
        "not before (parts must not overlap, holes must be wound inwards)",
        surface_.name(i), required == 0 ? count + 1 : count, required == 0 ? count : count - 1);
  }
  return {};
}

Error CoverCheck::check() {
  for (std::uint32_t i = 0; i < surface_.triangle_count(); ++i) {
    if (const Error error = check_crossings(i)) return error;
  }
  for (std::uint32_t i = 0; i < surface_.triangle_count(); ++i) {
    if (const Error error = check_sides(i)) return error;
  }
  return {};
}

}  // namespace

Error check_surface_data(const TriangleSurface& surface) {
  const std::size_t count = surface.indices.size();
  if (count == 0 || count % 3 != 0 || count / 3 > StaticTree::kMaxItems) {
    return make_error(ErrorCode::invalid_geometry,
                      "mesh: %zu indices; allowed are 3 for each of 1 to %u triangles", count,
                      StaticTree::kMaxItems);
  }
  for (std::size_t i = 0; i < count; ++i) {
    if (surface.indices[i] < surface.vertices.size()) continue;
    return make_error(ErrorCode::invalid_geometry,
                      "mesh: triangle %u uses vertex %u; allowed are numbers below %zu",
                      surface.name(std::uint32_t(i / 3)), surface.indices[i], surface.vertices.size());
  }
  for (std::size_t i = 0; i < surface.vertices.size(); ++i) {
    const Vec3 p = surface.vertices[i];
    if (is_finite(p) && largest(absolute(p)) <= kMaxLength) continue;
    return make_error(ErrorCode::invalid_geometry,
                      "mesh: vertex %zu is (%g, %g, %g); allowed are finite coordinates within -%g to %g m",
                      i, double(p.x), double(p.y), double(p.z), double(kMaxLength), double(kMaxLength));
  }
  return {};
}

Error check_edges(const TriangleSurface& surface) {
  std::vector<std::uint64_t> keys, key_scratch(surface.indices.size());
  std::vector<std::uint32_t> halves, half_scratch(surface.indices.size());
  for (std::uint32_t half = 0; half < std::uint32_t(surface.indices.size()); ++half) {
    const std::uint32_t from = edge_start(surface, half), to = edge_end(surface, half);
    if (from == to) continue;
    keys.push_back(std::uint64_t(min(from, to)) << 32 | max(from, to));
    halves.push_back(half);
  }
  radix_sort_pairs(keys, halves, key_scratch, half_scratch);
  // Of all wrong edges, the one of the lowest triangle is reported.
  std::uint32_t worst = 0;
  bool found = false;
  int worst_total = 0;
  for (std::size_t begin = 0, end = 0; begin < keys.size(); begin = end) {
    int balance = 0, total = 0;
    for (end = begin; end < keys.size() && keys[end] == keys[begin]; ++end, ++total) {
      balance += edge_start(surface, halves[end]) < edge_end(surface, halves[end]) ? 1 : -1;
    }
    if (balance == 0 || (found && halves[begin] > worst)) continue;
    found = true;
    worst = halves[begin];
    worst_total = total;
  }
  return found ? edge_error(surface, worst, worst_total) : Error{};
}

Error check_covered_once(const TriangleSurface& surface) { return CoverCheck(surface).check(); }

}  // namespace gyre
