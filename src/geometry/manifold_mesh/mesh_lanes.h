// W triangles side by side. See mesh_kernels.h. Numbers are rounded as local_triangle and measure_edges round them.
#pragma once

#include "geometry/manifold_mesh/mesh_apart_lanes.h"
#include "geometry/manifold_mesh/mesh_kernels.h"

namespace gyre {
inline namespace GYRE_TARGET_NAMESPACE {

// Four vectors, one a lane: their first two parts are loaded as one.
GYRE_INLINE Vec3W<4> four_at(const Vec3* base, const std::uint32_t* at) {
  typedef std::int64_t Part __attribute__((aligned(4), may_alias));
  typedef std::int64_t Parts __attribute__((vector_size(16)));
  typedef float Quad __attribute__((vector_size(16)));
  const Vec3 *const a = base + at[0], *const b = base + at[1], *const c = base + at[2],
                    *const d = base + at[3];
  const auto part = [](const Vec3* v) { return *reinterpret_cast<const Part*>(v); };
  const Quad low = (Quad)Parts{part(a), part(b)}, high = (Quad)Parts{part(c), part(d)};
  return {Wide<4>::of(__builtin_shufflevector(low, high, 0, 2, 4, 6)),
          Wide<4>::of(__builtin_shufflevector(low, high, 1, 3, 5, 7)),
          Wide<4>::of(Quad{a->z, b->z, c->z, d->z})};
}
// The vectors at W places.
template <int W>
GYRE_INLINE Vec3W<W> vectors_at(const Vec3* base, const std::uint32_t (&at)[W]) {
  if constexpr (W == 4) {
    return four_at(base, at);
  } else {
    return join(four_at(base, at), four_at(base, at + 4));
  }
}

// W triangles from `first` on; behind the last its copies stand.
template <int W>
GYRE_INLINE void number_lanes(const std::uint32_t* ids, int first, int count, std::uint32_t (&lanes)[W]) {
  const bool full = first + W <= count;
  if (full) {
    GYRE_UNROLL
    for (int k = 0; k < W; ++k) lanes[k] = ids[first + k];
    return;
  }
  GYRE_UNROLL
  for (int k = 0; k < W; ++k) lanes[k] = ids[first + k < count ? first + k : count - 1];
}

template <int W>
GYRE_INLINE void gather_corners(const TriangleColumns& triangles, const std::uint32_t (&lanes)[W],
                                Vec3W<W> (&corner)[3]) {
  GYRE_UNROLL
  for (int i = 0; i < 3; ++i) {
    std::uint32_t at[W];
    GYRE_UNROLL
    for (int k = 0; k < W; ++k) at[k] = triangles.indices[3 * std::size_t(lanes[k]) + std::size_t(i)];
    corner[i] = vectors_at<W>(triangles.vertices, at);
  }
}

// ------------------------------------------------------------------------------------------------------------ the boxes

// As LocalConvex::can_touch.
template <int W>
GYRE_INLINE Mask<W> can_touch(const ConvexColumns& convex, Vec3W<W> low, Vec3W<W> high, float reach) {
  const Wide<W> part(0.5f);
  const Vec3W<W> middle = part * (low + high), half = part * (high - low), size = absolute(middle);
  if (convex.core == ConvexColumns::Core::ball) {
    const Vec3W<W> outside = max(size - half, Vec3W<W>{0.0f, 0.0f, 0.0f});
    const Wide<W> squared = outside.x * outside.x + outside.y * outside.y + outside.z * outside.z;
    return squared <= Wide<W>((convex.radius + reach) * (convex.radius + reach) * 1.0001f);
  }
  const Wide<W> room = Wide<W>(reach) + Wide<W>(1.0e-6f) * largest(size);
  Mask<W> apart = Mask<W>::splat(false);
  const float* const lowest = &convex.local_box.low.x;
  const float* const highest = &convex.local_box.high.x;
  GYRE_UNROLL
  for (int axis = 0; axis < 3; ++axis) {
    const Vec3W<W> direction = splat<W>(convex.axes[axis]), spans = absolute(direction);
    const Wide<W> along = dot(direction, middle);
    const Wide<W> spread = spans.x * half.x + spans.y * half.y + spans.z * half.z + room;
    apart = apart | (along - spread > Wide<W>(highest[axis])) | (along + spread < Wide<W>(lowest[axis]));
  }
  return ~apart;
}

template <int W>
GYRE_INLINE Mask<W> overlaps(Vec3W<W> low, Vec3W<W> high, const Aabb& box) {
  const Vec3W<W> from = splat<W>(box.low), to = splat<W>(box.high);
  return (low.x <= to.x) & (from.x <= high.x) & (low.y <= to.y) & (from.y <= high.y) & (low.z <= to.z) &
         (from.z <= high.z);
}

template <int W>
std::uint32_t find_near(const TriangleColumns& triangles, const std::uint32_t* ids, int count,
                        const ConvexColumns& convex, const NearBoxes& boxes) {
  std::uint32_t near = 0;
  const Vec3W<W> position = splat<W>(boxes.position);
  for (int first = 0; first < count; first += W) {
    std::uint32_t lanes[W];
    number_lanes<W>(ids, first, count, lanes);
    Vec3W<W> corner[3];
    gather_corners<W>(triangles, lanes, corner);
    const Vec3W<W> low = min(corner[0], min(corner[1], corner[2])),
                   high = max(corner[0], max(corner[1], corner[2]));
    const Mask<W> outer = overlaps<W>(low, high, boxes.outer);
    if (none(outer)) continue;
    const Mask<W> inner = overlaps<W>(low, high, boxes.inner) |
                          can_touch<W>(convex, low - position, high - position, boxes.reach);
    near |= to_bits(outer & inner) << first;
  }
  return count < 32 ? near & ((1u << count) - 1u) : near;
}

// -------------------------------------------------------------------------------------------------------- the triangles

template <int W>
GYRE_INLINE void store(Vec3W<W> v, TriangleBatch::Columns& to, int first) {
  v.x.store_unaligned(to.x + first);
  v.y.store_unaligned(to.y + first);
  v.z.store_unaligned(to.z + first);
}

// Returns in which lanes the triangle is seen from behind.
template <int W>
GYRE_INLINE Mask<W> place_lanes(const TriangleColumns& triangles, const std::uint32_t (&lanes)[W],
                                const ConvexColumns& convex, Vec3 position, TriangleLanes<W>& t) {
  t.normal = vectors_at<W>(triangles.normals, lanes);
  gather_corners<W>(triangles, lanes, t.corner);
  Mask<W> turned = Mask<W>::splat(false);
  const Vec3W<W> origin = splat<W>(position);
  if (triangles.double_sided) {
    const Vec3W<W> middle = splat<W>(convex.center) + origin;
    turned = dot(t.normal, middle - t.corner[0]) < Wide<W>(0.0f);
    const Vec3W<W> second = t.corner[1];
    t.corner[1] = select(turned, t.corner[2], second);
    t.corner[2] = select(turned, second, t.corner[2]);
    t.normal = select(turned, -t.normal, t.normal);
  }
  t.reach = largest(absolute(origin));
  GYRE_UNROLL
  for (int i = 0; i < 3; ++i) {
    t.reach = max(t.reach, largest(absolute(t.corner[i])));
    t.corner[i] = t.corner[i] - origin;
  }
  return turned;
}

template <int W>
GYRE_INLINE void find_extents(const ConvexColumns& convex, Vec3W<W> normal, Wide<W>& low, Wide<W>& high) {
  low = high = dot(splat<W>(vertex_of(convex, 0)), normal);
  for (int i = 1; i < convex.vertex_count; ++i) {
    const Wide<W> height = dot(splat<W>(vertex_of(convex, i)), normal);
    low = min(low, height);
    high = max(high, height);
  }
}

template <int W>
GYRE_INLINE void measure_lanes(const TriangleLanes<W>& t, int first, TriangleBatch& out) {
  GYRE_UNROLL
  for (int i = 0; i < 3; ++i) {
    const Vec3W<W> edge = t.corner[i == 2 ? 0 : i + 1] - t.corner[i];
    const Wide<W> size = max(length(edge), Wide<W>(1.0e-30f));
    const Vec3W<W> along = edge / size;
    size.store_unaligned(out.length[i] + first);
    store<W>(along, out.along[i], first);
    store<W>(cross(along, t.normal), out.outward[i], first);
  }
}

template <int W>
void load_triangles(const TriangleColumns& triangles, const std::uint32_t* ids, int count,
                     const ConvexColumns& convex, Vec3 position, float max_separation, TriangleBatch& out) {
  out.touchable = out.apart = out.turned = 0;
  for (int first = 0; first < count; first += W) {
    std::uint32_t lanes[W];
    number_lanes<W>(ids, first, count, lanes);
    const unsigned counted = (count - first < W ? (1u << (count - first)) - 1u : (1u << W) - 1u);
    TriangleLanes<W> t;
    out.turned |= (to_bits(place_lanes<W>(triangles, lanes, convex, position, t)) & counted) << first;
    Wide<W> low, high;
    if (convex.vertex_count > 0) {
      find_extents<W>(convex, t.normal, low, high);
      low.store_unaligned(out.low + first);
      high.store_unaligned(out.high + first);
    } else {
      low = Wide<W>::load_unaligned(out.low + first);
      high = Wide<W>::load_unaligned(out.high + first);
    }
    const Wide<W> height = dot(t.normal, t.corner[0]), radius(convex.radius), most(max_separation);
    const Wide<W> before = low - height - radius;
    const Mask<W> behind = high - height + radius <= Wide<W>(0.0f);
    unsigned touchable = to_bits(~(behind | (before > most))) & counted;
    unsigned apart = to_bits(before > most + apart_slack<W>(t, convex)) & counted;
    if (touchable != 0) {
      // Only of lanes that are still in question, so that none depends on its neighbours.
      const unsigned known = to_bits(is_apart<W>(t, convex, max_separation)) & touchable;
      apart |= known;
      touchable &= ~known;
    }
    out.touchable |= touchable << first;
    out.apart |= apart << first;
    if (touchable == 0) continue;
    (Wide<W>(1.2e-7f) * t.reach + Wide<W>(1.0e-6f * convex.size)).store_unaligned(out.slack + first);
    store<W>(t.normal, out.normal, first);
    GYRE_UNROLL
    for (int i = 0; i < 3; ++i) store<W>(t.corner[i], out.corner[i], first);
    measure_lanes<W>(t, first, out);
  }
}

template <int W>
constexpr MeshKernels mesh_kernels() {
  return {find_near<W>, load_triangles<W>};
}

}  // namespace GYRE_TARGET_NAMESPACE
}  // namespace gyre
