// Clipping of a rectangle to a rectangle. See manifold_box_face.h.
#include "geometry/manifold/manifold_box_face.h"

#include "geometry/manifold/clip.h"

#include <bit>
#include <utility>

namespace gyre::boxes {
namespace {

// The reference box, and the incident box in its frame.
struct Roles {
  const float* reference;  // half extents
  const float* incident;
  const float (*m)[4];     // m[i][k]: the component of the incident's axis k along axis i
  const float (*axes)[4];  // the transpose
  alignas(16) float c[4];  // the incident's centre
  bool reference_is_a;

  Roles(const Boxes& x, bool is_a)
      : reference(is_a ? x.a : x.b),
        incident(is_a ? x.b : x.a),
        m(is_a ? x.r : x.s),
        axes(is_a ? x.s : x.r),
        reference_is_a(is_a) {
    (is_a ? Floats::load(x.t) : -Floats::load(x.u)).store(c);
  }
};

// A mask of the lane of one axis.
alignas(16) constexpr std::int32_t kOnly[3][4] = {{-1, 0, 0, 0}, {0, -1, 0, 0}, {0, 0, -1, 0}};
inline Mask<4> only(int axis) { return Mask<4>::of(WideInt<4>::load(kOnly[axis]).v); }

// The corners of each of the six faces, in order around it, and the edges that leave them. The face on the negative
// side of an axis comes first.
struct FaceNames {
  std::uint32_t corner[3][2][4];
  std::uint32_t edge[3][2][4];
};
constexpr FaceNames kFaces = [] {
  FaceNames names{};
  for (int k = 0; k < 3; ++k) {
    const std::uint32_t first = 1u << kNext[k], second = 1u << kAfter[k];
    const std::uint32_t around[4] = {first | second, second, 0, first};
    for (int positive = 0; positive < 2; ++positive) {
      for (int i = 0; i < 4; ++i) {
        const std::uint32_t corner = around[i] | std::uint32_t(positive) << k;
        names.corner[k][positive][i] = corner;
        names.edge[k][positive][i] = edge_number(i % 2 == 0 ? kNext[k] : kAfter[k], corner);
      }
    }
  }
  return names;
}();

// A corner of the incident face over the reference face: two coordinates along the reference face and, as the third,
// the height above it.
struct Corner {
  alignas(16) float position[4];
  std::uint32_t feature;
  // the edge that leaves the corner: one of the incident's 12, or kSide + one of the four sides
  std::uint32_t edge;
};
constexpr std::uint32_t kSide = 16;

// The corners of a polygon in order around it, and the first one again. Neither array is cleared: only the counted
// elements are read.
struct Polygon {
  int count = 0;
  const Corner* corners[12];

  Polygon() {}
};

// The sides of the reference face.
struct Sides {
  std::uint32_t edge[4];  // the reference's edge at u = +, u = -, v = +, v = -
  std::uint32_t corner;   // corner bits of the reference face with u and v negative
  std::uint32_t bit_u, bit_v;
  bool reference_is_a;

  Sides(bool is_a, int axis, float facing)
      : corner(facing > 0.0f ? 1u << axis : 0u),
        bit_u(1u << kNext[axis]),
        bit_v(1u << kAfter[axis]),
        reference_is_a(is_a) {
    // As in edge_number(): v is the axis before `axis`, u the one after it.
    edge[1] = edge_number(kAfter[axis], corner), edge[0] = edge[1] + 2u;
    edge[3] = edge_number(kNext[axis], corner), edge[2] = edge[3] + 1u;
  }

  std::uint32_t name(std::uint32_t polygon_edge, std::uint32_t side) const {
    if (polygon_edge < kSide) {
      return reference_is_a ? feature_edges(edge[side], polygon_edge)
                            : feature_edges(polygon_edge, edge[side]);
    }
    const std::uint32_t other = polygon_edge - kSide;
    const std::uint32_t side_u = side < 2 ? side : other, side_v = side < 2 ? other : side;
    const std::uint32_t id = corner | (side_u == 0 ? bit_u : 0u) | (side_v == 2 ? bit_v : 0u);
    return reference_is_a ? feature_vertex_a(id) : feature_vertex_b(id);
  }
};

// Cuts off the part of the polygon whose coordinate along an axis, times `sign`, is above the limit. New corners go to
// `made`.
void cut(const Polygon& in, int along, float sign, float limit, std::uint32_t side, const Sides& sides,
         Corner*& made, Polygon& out) {
  const Mask<4> lane = only(along);
  int count = 0;
  float distance = sign * in.corners[0]->position[along] - limit;
  bool inside = distance <= 0.0f;
  for (int i = 0; i < in.count; ++i) {
    const Corner& from = *in.corners[i];
    const Corner& to = *in.corners[i + 1];
    const float distance_to = sign * to.position[along] - limit;
    const bool inside_to = distance_to <= 0.0f;
    if (inside) out.corners[count++] = &from;
    if (inside != inside_to && count < 8) {
      const Floats start = Floats::load(from.position), t(distance / (distance - distance_to));
      select(lane, Floats(sign * limit), start + t * (Floats::load(to.position) - start))
          .store(made->position);
      made->feature = sides.name(from.edge, side);
      made->edge = inside ? kSide + side : from.edge;
      out.corners[count++] = made++;
    }
    distance = distance_to, inside = inside_to;
  }
  out.count = count;
  out.corners[count] = out.corners[0];
}

// Clips the incident face to the reference rectangle.
class FaceClip {
 public:
  FaceClip(const Roles& roles, int axis, float facing) : roles_(roles), axis_(axis), facing_(facing) {}

  // The points of the incident face along axis k: at most four, in the frame of the reference, midway between the
  // surfaces. Points above max_separation are dropped. Returns the number of points.
  int clip(int k, float max_separation, ManifoldPoint* out);

 private:
  void compute_corners(int k, Floats* positions);
  int write(float max_separation, ManifoldPoint* out) const;

  const Roles& roles_;
  int axis_;
  float facing_;
  Polygon polygons_[2];
  Polygon* polygon_ = polygons_;
  union {
    Corner corners_[4 + 4 * 8];
  };
};

// The four corners of the incident face with the normal +-axis k, in order around it.
void FaceClip::compute_corners(int k, Floats* positions) {
  const bool positive = !(facing_ * roles_.m[axis_][k] > 0.0f);
  // Along the normal of the reference face: the height above that face.
  const Mask<4> normal = only(axis_);
  const Floats to_up = select(normal, Floats(facing_), Floats(1.0f)),
               top = keep(normal, Floats::load(roles_.reference));
  const auto half = [&](int i) { return Floats(roles_.incident[i]) * Floats::load(roles_.axes[i]); };
  const Floats out = half(k), middle = Floats::load(roles_.c);
  const Floats center = to_up * (positive ? middle + out : middle - out) - top;
  const Floats first = to_up * half(kNext[k]), second = to_up * half(kAfter[k]);
  positions[0] = center + first + second;
  positions[1] = center - first + second;
  positions[2] = center - first - second;
  positions[3] = center + first - second;
  const std::uint32_t kind = roles_.reference_is_a ? feature_vertex_b(0) : feature_vertex_a(0);
  for (int i = 0; i < 4; ++i) {
    positions[i].store(corners_[i].position);
    corners_[i].feature = kind | kFaces.corner[k][positive][i];
    corners_[i].edge = kFaces.edge[k][positive][i];
  }
}

int FaceClip::write(float max_separation, ManifoldPoint* out) const {
  const Mask<4> normal = only(axis_);
  const Floats top(facing_ * roles_.reference[axis_]), half(0.5f * facing_);
  int count = 0;
  for (int i = 0; i < polygon_->count && count < 8; ++i) {
    const Corner& corner = *polygon_->corners[i];
    const float separation = corner.position[axis_];
    if (!(separation <= max_separation)) continue;
    const Floats position = Floats::load(corner.position);
    out[count].position = to_vec3(select(normal, top + half * position, position));
    out[count].separation = separation;
    out[count++].feature = corner.feature;
  }
  return count;
}

int FaceClip::clip(int k, float max_separation, ManifoldPoint* out) {
  Floats positions[4];
  compute_corners(k, positions);
  const Floats h = Floats::load(roles_.reference);
  const Floats low = min(min(positions[0], positions[1]), min(positions[2], positions[3])),
               high = max(max(positions[0], positions[1]), max(positions[2], positions[3]));
  const std::uint32_t sideways = kThree & ~(1u << axis_);
  if (((to_bits(low > h) | to_bits(high < -h)) & sideways) != 0) return 0;
  polygon_ = polygons_;
  polygon_->count = 4;
  for (int i = 0; i < 5; ++i) polygon_->corners[i] = &corners_[i % 4];
  const std::uint32_t above = to_bits(high > h) & sideways, below = to_bits(low < -h) & sideways;
  if ((above | below) != 0) {
    const Sides sides(roles_.reference_is_a, axis_, facing_);
    Corner* made = corners_ + 4;
    const auto advance = [&](int along, float sign, std::uint32_t side) {
      Polygon* const other = polygon_ == polygons_ ? polygons_ + 1 : polygons_;
      cut(*polygon_, along, sign, roles_.reference[along], side, sides, made, *other);
      polygon_ = other;
    };
    const int iu = kNext[axis_], iv = kAfter[axis_];
    if ((above >> iu & 1u) != 0) advance(iu, 1.0f, 0);
    if ((below >> iu & 1u) != 0) advance(iu, -1.0f, 1);
    if ((above >> iv & 1u) != 0 && polygon_->count > 0) advance(iv, 1.0f, 2);
    if ((below >> iv & 1u) != 0 && polygon_->count > 0) advance(iv, -1.0f, 3);
  }
  if (polygon_->count <= kMaxManifoldPoints) return write(max_separation, out);
  ManifoldPoint points[8];
  const int count =
      reduce_points(points, write(max_separation, points), to_vec3(keep(only(axis_), Floats(facing_))));
  for (int i = 0; i < count; ++i) out[i] = points[i];
  return count;
}

}  // namespace

void collide_face(const Boxes& x, const Axis& found, float max_separation, LocalManifold& out) {
  const bool reference_is_a = found.number < kFirstB;
  const int axis = reference_is_a ? found.number : found.number - kFirstB;
  const Roles roles(x, reference_is_a);
  const float facing = roles.c[axis] < 0.0f ? -1.0f : 1.0f;
  FaceClip face(roles, axis, facing);
  // The incident face is the one that opposes the reference most. If they do not overlap, the next two are tried.
  const Floats slopes = absolute(Floats::load(roles.m[axis]));
  const int steepest = std::countr_zero((to_bits(slopes >= highest(slopes)) & kThree) | 4u);
  out.count = face.clip(steepest, max_separation, out.points);
  if (out.count == 0) {
    int second = kNext[steepest], third = kAfter[steepest];
    if (slopes[third] > slopes[second]) std::swap(second, third);
    out.count = face.clip(second, max_separation, out.points);
    if (out.count == 0) out.count = face.clip(third, max_separation, out.points);
    if (out.count == 0) return;
  }
  const Floats normal = keep(only(axis), Floats(facing));
  if (reference_is_a) {
    out.normal = to_vec3(normal);
    return;
  }
  const Floats s0 = Floats::load(x.s[0]), s1 = Floats::load(x.s[1]), s2 = Floats::load(x.s[2]),
               center = Floats::load(x.t);
  const auto rotated = [&](Floats v) { return s0 * spread<0>(v) + s1 * spread<1>(v) + s2 * spread<2>(v); };
  out.normal = normalized(to_vec3(rotated(-normal)));
  for (int i = 0; i < out.count; ++i)
    out.points[i].position = to_vec3(rotated(three(out.points[i].position)) + center);
}

}  // namespace gyre::boxes
