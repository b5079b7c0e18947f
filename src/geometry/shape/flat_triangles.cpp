// Edge flips. See flat_triangles.h.
#include "geometry/shape/flat_triangles.h"

#include "base/container/flat_map.h"
#include "geometry/shape/triangle.h"

namespace gyre {
namespace {

// Twice the area of nearly flat triangles, relative to the square of the longest side: more than rounding makes of corners in line.
constexpr double kNearlyFlat = 4.0e-6;

class Flipper {
 public:
  Flipper(std::span<const Vec3> vertices, TriangleList& list) : vertices_(vertices), list_(list) {
    for (std::uint32_t t = 0; t < list.source.size(); ++t) {
      enter_edges(t);
      if (is_flat(t)) waiting_.push_back(t);
    }
  }

  // Flips while any flip helps: each leaves fewer nearly flat triangles, or as many with a shorter edge between them.
  void run() {
    for (bool any = true; any;) {
      any = false;
      std::vector<std::uint32_t> round;
      round.swap(waiting_);
      for (const std::uint32_t t : round) {
        if (!is_flat(t)) continue;
        if (flip(t)) {
          any = true;
        } else {
          waiting_.push_back(t);
        }
      }
    }
  }

 private:
  std::uint32_t* corners(std::uint32_t t) { return list_.indices.data() + 3 * std::size_t(t); }
  bool is_flat(std::uint32_t a, std::uint32_t b, std::uint32_t c) const {
    const DVec3 ab = DVec3(vertices_[b]) - DVec3(vertices_[a]),
                ac = DVec3(vertices_[c]) - DVec3(vertices_[a]);
    const double longest = max(length_squared(ab), max(length_squared(ac), length_squared(ac - ab)));
    return !(length(cross(ab, ac)) > kNearlyFlat * longest);
  }
  bool is_flat(std::uint32_t t) {
    const std::uint32_t* const v = corners(t);
    return is_flat(v[0], v[1], v[2]);
  }
  static std::uint64_t key(std::uint32_t from, std::uint32_t to) { return std::uint64_t(from) << 32 | to; }
  double length_of(std::uint32_t a, std::uint32_t b) const {
    return length_squared(DVec3(vertices_[a]) - DVec3(vertices_[b]));
  }

  void enter_edges(std::uint32_t t) {
    const std::uint32_t* const v = corners(t);
    for (int e = 0; e < 3; ++e) triangle_of_.find_or_insert(key(v[e], v[(e + 1) % 3]), t);
  }
  void leave_edges(std::uint32_t t) {
    const std::uint32_t* const v = corners(t);
    for (int e = 0; e < 3; ++e) {
      const std::uint64_t edge = key(v[e], v[(e + 1) % 3]);
      if (const std::uint32_t* const owner = triangle_of_.find(edge); owner != nullptr && *owner == t)
        triangle_of_.erase(edge);
    }
  }
  void set(std::uint32_t t, const std::uint32_t (&v)[3], std::uint32_t source) {
    for (int i = 0; i < 3; ++i) corners(t)[i] = v[i];
    list_.source[t] = source;
    enter_edges(t);
    if (is_flat(t)) waiting_.push_back(t);
  }

  // Divides the neighbour across the long side, c to a, at the corner b.
  bool flip(std::uint32_t t) {
    const std::uint32_t* const v = corners(t);
    int e = 0;
    for (int k = 1; k < 3; ++k) {
      if (length_of(v[k], v[(k + 1) % 3]) > length_of(v[e], v[(e + 1) % 3])) e = k;
    }
    const std::uint32_t c = v[e], a = v[(e + 1) % 3], b = v[(e + 2) % 3];
    const std::uint32_t* const found = triangle_of_.find(key(a, c));
    if (found == nullptr || *found == t) return false;
    const std::uint32_t n = *found;
    const std::uint32_t* const w = corners(n);
    const std::uint32_t d = w[0] != a && w[0] != c ? w[0] : w[1] != a && w[1] != c ? w[1] : w[2];
    if (d == a || d == b || d == c) return false;
    const bool shorter = is_flat(n) && length_of(b, d) < length_of(a, c);
    const bool solved = !is_flat(n) && !is_flat(a, b, d) && !is_flat(b, c, d);
    if (!shorter && !solved) return false;
    leave_edges(t);
    leave_edges(n);
    const std::uint32_t source = list_.source[n];
    set(n, {a, b, d}, source);
    set(t, {b, c, d}, source);
    return true;
  }

  std::span<const Vec3> vertices_;
  TriangleList& list_;
  std::vector<std::uint32_t> waiting_;  // nearly flat triangles
  FlatMap<std::uint32_t> triangle_of_;  // by directed edge
};

}  // namespace

TriangleList without_flat_triangles(std::span<const Vec3> vertices, std::span<const std::uint32_t> indices,
                                    std::span<const std::uint32_t> welded) {
  const auto has_area = [&](const std::uint32_t* v) {
    return triangle_normal(vertices[v[0]], vertices[v[1]], vertices[v[2]]) != Vec3{0, 0, 0};
  };
  TriangleList list;
  bool any_flat = false;
  for (std::size_t i = 0; i + 2 < indices.size(); i += 3) {
    const std::uint32_t v[3] = {welded[indices[i]], welded[indices[i + 1]], welded[indices[i + 2]]};
    if (v[0] == v[1] || v[1] == v[2] || v[2] == v[0]) continue;
    list.indices.insert(list.indices.end(), v, v + 3);
    list.source.push_back(std::uint32_t(i / 3));
    any_flat = any_flat || !has_area(v);
  }
  if (!any_flat) return list;
  Flipper(vertices, list).run();
  TriangleList out;
  for (std::size_t t = 0; t < list.source.size(); ++t) {
    const std::uint32_t* const v = list.indices.data() + 3 * t;
    if (!has_area(v)) continue;
    out.indices.insert(out.indices.end(), v, v + 3);
    out.source.push_back(list.source[t]);
  }
  return out;
}

}  // namespace gyre
