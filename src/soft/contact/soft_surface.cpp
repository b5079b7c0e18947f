#include "soft/contact/soft_surface.h"

#include "base/container/sort.h"

#include <cmath>

namespace gyre {

namespace {

constexpr float kRadiusOfHeight = 1.0f / 3.0f;  // of a triangle's lowest height: neighbours stay apart
constexpr float kNoFloat = __builtin_nanf("");  // marks an absent number

Aabb box_of(std::span<const DVec3> places, const std::uint32_t* corner, DVec3 origin) {
  const Vec3 a = difference(places[corner[0]], origin), b = difference(places[corner[1]], origin),
             c = difference(places[corner[2]], origin);
  return {min(a, min(b, c)), max(a, max(b, c))};
}

// Twice the area over the longest edge.
double lowest_height(DVec3 a, DVec3 b, DVec3 c) {
  const double longest = max(length_squared(b - a), max(length_squared(c - b), length_squared(a - c)));
  return longest > 0.0 ? length(cross(b - a, c - a)) / std::sqrt(longest) : 0.0;
}

void set_radii(SoftSurface& surface, std::span<const DVec3> places, float radius) {
  surface.radius.assign(std::size_t(surface.vertices), radius);
  for (const SoftTriangle& one : surface.triangles) {
    const float height =
        float(lowest_height(places[one.corner[0]], places[one.corner[1]], places[one.corner[2]]));
    for (const std::uint32_t v : one.corner)
      surface.radius[v] = min(surface.radius[v], kRadiusOfHeight * height);
  }
}

// Edges by their vertices, each owned by the first triangle that has it. (Of an edge of three triangles or more, the first two are
// neighbours.)
void set_edges(SoftSurface& surface) {
  const std::size_t sides = 3 * surface.triangles.size();
  Array<std::uint64_t> keys, scratch_keys;
  Array<std::uint32_t> side, scratch_side;
  keys.resize(sides), scratch_keys.resize(sides), side.resize(sides), scratch_side.resize(sides);
  for (std::size_t i = 0; i < sides; ++i) {
    const SoftTriangle& one = surface.triangles[i / 3];
    const std::uint32_t p = one.corner[i % 3], q = one.corner[(i + 1) % 3];
    keys[i] = std::uint64_t(min(p, q)) << 32 | max(p, q);
    side[i] = std::uint32_t(i);
  }
  radix_sort_pairs(keys, side, scratch_keys, scratch_side);
  for (std::size_t i = 0; i < sides; ++i) {
    if (i > 0 && keys[i] == keys[i - 1]) continue;
    surface.triangles[side[i] / 3].owned_edge[side[i] % 3] = std::int32_t(surface.edges.size());
    surface.edges.push_back({std::uint32_t(keys[i] >> 32), std::uint32_t(keys[i]), side[i] / 3, side[i] % 3});
    if (i + 1 == sides || keys[i + 1] != keys[i]) continue;
    surface.triangles[side[i] / 3].neighbour[side[i] % 3] = std::int32_t(side[i + 1] / 3);
    surface.triangles[side[i + 1] / 3].neighbour[side[i + 1] % 3] = std::int32_t(side[i] / 3);
  }
}

void set_around(SoftSurface& surface) {
  surface.around_begin.assign(std::size_t(surface.vertices) + 1, 0u);
  for (const SurfaceEdge& edge : surface.edges) {
    ++surface.around_begin[edge.a + 1];
    ++surface.around_begin[edge.b + 1];
  }
  for (int v = 0; v < surface.vertices; ++v) surface.around_begin[v + 1] += surface.around_begin[v];
  surface.around.resize(2 * surface.edges.size());
  Array<std::uint32_t> next = surface.around_begin;
  for (const SurfaceEdge& edge : surface.edges) {
    surface.around[next[edge.a]++] = edge.b;
    surface.around[next[edge.b]++] = edge.a;
  }
}

void set_owned_corners(SoftSurface& surface) {
  Array<std::uint8_t> owned;
  owned.resize(std::size_t(surface.vertices));
  for (SoftTriangle& one : surface.triangles) {
    for (unsigned i = 0; i < 3; ++i) {
      if (owned[one.corner[i]] != 0) continue;
      owned[one.corner[i]] = 1;
      one.owned_corners |= 1u << i;
    }
  }
}

// A box that contains `p` and the margin, in float.
Aabb vertex_box(DVec3 p, double pad) {
  constexpr double kSlack = 0x1p-22;  // more than the rounding of float
  const auto low = [&](double x) { return float(x - pad - kSlack * (absolute(x) + pad)); };
  const auto high = [&](double x) { return float(x + pad + kSlack * (absolute(x) + pad)); };
  return {{low(p.x), low(p.y), low(p.z)}, {high(p.x), high(p.y), high(p.z)}};
}

void put_child(StaticNode& node, int lane, std::uint32_t child, const float* low, const float* high) {
  node.child[lane] = child;
  for (int axis = 0; axis < 3; ++axis) {
    node.low[axis][lane] = low[axis];
    node.high[axis][lane] = high[axis];
  }
}

// Fits the boxes of the tree to those of the triangles, at both ends of the moves; returns the boxes of all.
SweptBox fit_nodes(const SoftSurface& surface, std::span<const SweptBox> triangles,
                   std::span<StaticNode> nodes, std::span<StaticNode> end_nodes, Arena& arena) {
  SweptBox none;
  for (int axis = 0; axis < 4; ++axis)
    none.low[axis] = none.high[axis] = none.end_low[axis] = none.end_high[axis] = kNoFloat;
  const std::span<SweptBox> whole = arena.make<SweptBox>(nodes.size());
  // The children of a node have higher numbers.
  for (std::size_t n = nodes.size(); n-- > 0;) {
    const StaticNode& from = surface.tree.nodes[n];
    bool any = false;
    for (int lane = 0; lane < StaticNode::kWidth; ++lane) {
      const std::uint32_t child = from.child[lane];
      SweptBox box = none;
      if (child != StaticNode::kNoChild && is_leaf(child)) {
        const std::uint32_t first = leaf_first(child);
        box = triangles[first];
        for (std::uint32_t i = first + 1; i < first + leaf_count(child); ++i) box = merge(box, triangles[i]);
      } else if (child != StaticNode::kNoChild) {
        box = whole[child];
      }
      if (child != StaticNode::kNoChild) {
        whole[n] = any ? merge(whole[n], box) : box;
        any = true;
      }
      put_child(nodes[n], lane, child, box.low, box.high);
      if (!end_nodes.empty()) put_child(end_nodes[n], lane, child, box.end_low, box.end_high);
    }
  }
  return nodes.empty() ? none : whole[0];
}

}  // namespace

SoftSurface make_surface(std::span<const DVec3> places, std::span<const std::uint32_t> triangles,
                         float radius) {
  SoftSurface surface;
  surface.vertices = int(places.size());
  const std::size_t count = triangles.size() / 3;
  if (count > 0) {
    Array<Aabb> boxes;
    boxes.resize(count);
    for (std::size_t i = 0; i < count; ++i)
      boxes[i] = box_of(places, triangles.data() + 3 * i, places[triangles[0]]);
    build_static_tree(boxes, surface.tree);
  }
  surface.triangles.resize(count);
  for (std::size_t i = 0; i < count; ++i) {
    for (std::size_t k = 0; k < 3; ++k)
      surface.triangles[i].corner[k] = triangles[3 * surface.tree.items[i] + k];
  }
  set_edges(surface);
  set_around(surface);
  set_owned_corners(surface);
  set_radii(surface, places, radius);
  double sum = 0.0;
  for (const SurfaceEdge& edge : surface.edges) sum += length(places[edge.b] - places[edge.a]);
  if (!surface.edges.empty()) surface.mean_edge = float(sum / double(surface.edges.size()));
  return surface;
}

SurfaceBoxes fit_boxes(const PlacedSurface& placed, std::span<const DVec3> positions,
                       std::span<const float> pads, DVec3 origin, Arena& arena,
                       std::span<const DVec3> moves) {
  const SoftSurface& surface = *placed.surface;
  SurfaceBoxes out;
  out.surface = &surface;
  out.first = placed.first;
  out.vertices = arena.make<SweptBox>(std::size_t(surface.vertices));
  out.triangles = arena.make<SweptBox>(surface.triangles.size());
  for (std::size_t v = 0; v < out.vertices.size(); ++v) {
    const std::size_t place = placed.first + v;
    const DVec3 at = positions[place] - origin;
    const double pad = pads.empty() ? 0.0 : double(pads[place]);
    const Aabb start = vertex_box(at, pad), end = moves.empty() ? start : vertex_box(at + moves[place], pad);
    SweptBox& box = out.vertices[v];
    for (int axis = 0; axis < 3; ++axis) {
      box.low[axis] = start.low[axis], box.high[axis] = start.high[axis];
      box.end_low[axis] = end.low[axis], box.end_high[axis] = end.high[axis];
    }
    box.low[3] = box.high[3] = box.end_low[3] = box.end_high[3] = 0.0f;
  }
  for (std::size_t i = 0; i < out.triangles.size(); ++i) {
    const std::uint32_t* const corner = surface.triangles[i].corner;
    out.triangles[i] =
        merge(merge(out.vertices[corner[0]], out.vertices[corner[1]]), out.vertices[corner[2]]);
  }
  out.nodes = arena.make<StaticNode>(surface.tree.nodes.size());
  out.end_nodes = moves.empty() ? out.nodes : arena.make<StaticNode>(surface.tree.nodes.size());
  const SweptBox all = fit_nodes(surface, out.triangles, out.nodes,
                                 moves.empty() ? std::span<StaticNode>() : out.end_nodes, arena);
  out.box = start_box(all), out.end_box = end_box(all);
  return out;
}

}  // namespace gyre
