// Separation of boxes in lanes: finds contacts without manifolds whose boxes are farther apart than a full update
// (contact_update.h) would search. Lane i finds this exactly where the full update would, with the same bits. Eight
// lanes search all axes, and the full update of the remaining contacts starts from the axis found here. Fewer lanes
// test only the face that decided the last update.
#pragma once

#include "collision/contact/contact_lanes.h"
#include "geometry/manifold/box_axes.h"

namespace gyre {
inline namespace GYRE_TARGET_NAMESPACE {

template <int W>
GYRE_INLINE Wide<W> pick_component(WideInt<W> axis, Vec3W<W> v) {
  return select(axis == WideInt<W>(0), v.x, select(axis == WideInt<W>(1), v.y, v.z));
}
template <int W>
GYRE_INLINE Vec3W<W> pick_component(WideInt<W> axis, const Mat3W<W>& columns) {
  return select(axis == WideInt<W>(0), columns.x, select(axis == WideInt<W>(1), columns.y, columns.z));
}

// Separation along the normal of face axis `axis` (0 to 2: of A, 3 to 5: of B) of boxes with half extents `a` and `b`,
// rounded in the same order as in collide_boxes.
template <int W>
GYRE_INLINE Wide<W> face_separation(WideInt<W> axis, Vec3W<W> a, Vec3W<W> b, const Placement<W>& a_from_b) {
  const Mask<W> of_b = axis > WideInt<W>(2);
  const WideInt<W> own_axis = select(of_b, axis - WideInt<W>(3), axis);
  const Mat3W<W> rotation = to_matrix(a_from_b.orientation), inverse_rotation = transpose(rotation);
  // In the axes of the other box.
  const Vec3W<W> normal =
      select(of_b, pick_component(own_axis, rotation), pick_component(own_axis, inverse_rotation));
  const Wide<W> center_offset =
      select(of_b, dot(normal, a_from_b.position), pick_component(own_axis, a_from_b.position));
  const Wide<W> own = pick_component(own_axis, select(of_b, b, a));
  return absolute(center_offset) - own - dot(select(of_b, a, b), absolute(normal));
}

template <int W>
GYRE_INLINE Vec3W<W> load_half_extents(const Records<W>& shape) {
  static_assert(offsetof(ColliderShape, shape) == 0);
  Wide<W> column[4];
  read_four<W>(shape, GYRE_FLOATS_BEFORE(Shape, extents), column);
  return {column[0], column[1], column[2]};
}

GYRE_INLINE bool is_sharp_box(const Shape& shape) {
  return shape.kind == ShapeKind::box && shape.radius == 0.0f;
}

GYRE_INLINE bool are_sharp_boxes(const PairInput& pair) {
  return pair.contact->sensor == 0 && is_sharp_box(pair.shape_a->shape) && is_sharp_box(pair.shape_b->shape);
}

// True if the full update would begin with the face of two boxes and there is no manifold to clear.
GYRE_INLINE bool begins_with_face(const PairInput& pair) {
  const Contact& contact = *pair.contact;
  return contact.manifold_count == 0 && contact.cache.words[0] - 1u < std::uint32_t(boxes::kFirstEdge) &&
         are_sharp_boxes(pair);
}

// Records in the contacts of the given lanes (bits) that a full update found nothing within `max_distance`.
template <int W>
GYRE_INLINE void cache_empty_update(const Group<W>& group, Wide<W> max_distance, unsigned lanes) {
  alignas(16) float discarded[sizeof(Contact) / sizeof(float)];
  Targets<W> to;
  GYRE_UNROLL
  for (int i = 0; i < W; ++i) to[i] = (lanes >> i & 1u) != 0 ? floats(group.pairs[i]->contact) : discarded;
  const Vec3W<W> p = group.now.position;
  const QuatW<W> q = group.now.orientation;
  write_four<4, W>(to, kCachedDistance, {max_distance, group.size, p.x, p.y});
  write_four<4, W>(to, kCachedDistance + 4, {p.z, q.x, q.y, q.z});
  GYRE_UNROLL
  for (int i = 0; i < W; ++i) to[i][kCachedDistance + 8] = q.w[i];
}

// Lanes in which a full update searches far (update_in_room), and its search distance.
template <int W>
GYRE_INLINE Mask<W> searches_far(const Group<W>& group) {
  return (group.max_approach < Wide<W>(kSlow) * group.size) & Mask<W>::of_bits(empty_lanes<W>(group));
}
template <int W>
GYRE_INLINE Wide<W> speculative_reach(const Group<W>& group, Mask<W> far) {
  return group.speculative + select(far, Wide<W>(kFarSlack), Wide<W>(kNearSlack)) * group.size;
}

// The number of the axis that decided the last update, whatever the cache contains.
template <int W>
GYRE_INLINE WideInt<W> last_axis(const Group<W>& group) {
  Records<W> contact;
  GYRE_UNROLL
  for (int i = 0; i < W; ++i) contact[i] = floats(group.pairs[i]->contact);
  return bit_pattern(read_one<W>(contact, GYRE_FLOATS_BEFORE(Contact, cache))) - WideInt<W>(1);
}

// Returns those of the given lanes (bits) whose boxes the face of the last update separates by more than the search
// distance.
template <int W>
GYRE_INLINE unsigned separate_by_last_face(const Group<W>& group, const ShapesInView<W>& shapes,
                                           unsigned lanes) {
  unsigned candidates = 0;
  GYRE_UNROLL
  for (int i = 0; i < W; ++i) candidates |= unsigned(begins_with_face(*group.pairs[i])) << i;
  if ((candidates & lanes) == 0) return 0;
  const Wide<W> max_distance = speculative_reach<W>(group, searches_far<W>(group));
  const Wide<W> separation = face_separation<W>(last_axis<W>(group), load_half_extents<W>(shapes.records_a),
                                                load_half_extents<W>(shapes.records_b), shapes.a_from_b);
  const unsigned apart = candidates & lanes & to_bits(separation > max_distance);
  if (apart != 0) cache_empty_update<W>(group, max_distance, apart);
  return apart;
}

// Searches all axes of the boxes in the given lanes (bits). Returns the lanes without manifolds whose boxes are farther
// apart than the search distance; for the other lanes `axis` gives the result.
template <int W>
GYRE_INLINE unsigned search_boxes(const Group<W>& group, const ShapesInView<W>& shapes, unsigned lanes,
                                  AxisLanes<W>& axis) {
  unsigned boxes = 0;
  GYRE_UNROLL
  for (int i = 0; i < W; ++i) boxes |= unsigned(are_sharp_boxes(*group.pairs[i])) << i;
  boxes &= lanes;
  if (boxes == 0) return 0;
  const WideInt<W> last = last_axis<W>(group), none(boxes::kNoAxis);
  const Mask<W> is_axis = (last >= WideInt<W>(0)) & (last < WideInt<W>(boxes::kAxisCount));
  const Mask<W> far = searches_far<W>(group);
  const Wide<W> max_distance = speculative_reach<W>(group, far);
  const BoxPairLanes<W> pair(load_half_extents<W>(shapes.records_a), load_half_extents<W>(shapes.records_b),
                             shapes.a_from_b.position, shapes.a_from_b.orientation);
  const AxisLanes<W> found = search_axes<W>(pair, max_distance, select(is_axis, last, none));
  const unsigned known = boxes & to_bits(found.known);
  const unsigned apart = known & empty_lanes<W>(group) & to_bits(found.separation > max_distance);
  if (apart != 0) cache_empty_update<W>(group, max_distance, apart);
  for (int i = 0; i < W; ++i) {
    if ((apart >> i & 1u) != 0) group.pairs[i]->contact->cache.words[0] = std::uint32_t(found.number[i] + 1);
  }
  // A far search that found something is repeated with the near distance.
  axis = found;
  axis.number = select(and_not(Mask<W>::of_bits(known), far), found.number, none);
  return apart;
}

// The method for this width. On four lanes the full search gains nothing, since collide_boxes itself tests three axes
// side by side.
template <int W>
GYRE_INLINE unsigned separate_boxes(const Group<W>& group, const ShapesInView<W>& shapes, unsigned lanes,
                                    AxisLanes<W>& axis) {
  if constexpr (W >= 8) return search_boxes<W>(group, shapes, lanes, axis);
  return separate_by_last_face<W>(group, shapes, lanes);
}

}  // namespace GYRE_TARGET_NAMESPACE
}  // namespace gyre
