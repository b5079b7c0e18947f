// Bounding boxes of shapes in the world. See fat_box.h.
#include "collision/broadphase/fat_box.h"

#include <cstdint>

namespace gyre {
namespace {

// A fat box extends ahead by the translation of one more step, but at most by this many sizes.
constexpr float kMaxAhead = 2.0f;
static_assert(kTooLarge > 2.0f * kFatShare + kMaxAhead);
constexpr float kMinNormal = 1.17549435e-38f;  // the smallest normal float
constexpr float kMaxFloat = 3.402823466e38f;  // the largest float

float next_up(float a) {
  if (absolute(a) < kMinNormal) return kMinNormal;
  const auto bits = __builtin_bit_cast(std::uint32_t, a);
  return __builtin_bit_cast(float, a > 0.0f ? bits + 1 : bits - 1);
}
// Sides beyond the range of floats, or NaN, become the largest float: trees rely on finite boxes.
float round_up(double a) {
  if (!(a <= double(kMaxFloat))) return kMaxFloat;
  if (a < -double(kMaxFloat)) return -kMaxFloat;
  const float rounded = float(a);
  return double(rounded) < a ? next_up(rounded) : rounded;
}
float round_down(double a) { return -round_up(-a); }

// The largest coordinate of a box, without the endless sides of planes.
float largest_coordinate(const Aabb& box) {
  const auto bounded = [](Vec3 a) {
    const auto bounded_coordinate = [](float value) { return value < kUnboundedSide ? value : 0.0f; };
    return Vec3{bounded_coordinate(a.x), bounded_coordinate(a.y), bounded_coordinate(a.z)};
  };
  return largest(max(bounded(absolute(box.low)), bounded(absolute(box.high))));
}

}  // namespace

WorldBox world_box(const Shape& shape, const Pose& world_from_shape) {
  return world_box(shape, bounds(shape, {{}, world_from_shape.orientation}), world_from_shape.position);
}

WorldBox world_box(const Shape& shape, const Aabb& rotated, DVec3 position) {
  // bounds() works in float, with a few roundings of numbers up to the box's coordinates. A disc seen from the side
  // loses half of its digits: sqrt(1 - a^2) with a near 1.
  const bool has_disc = shape.kind == ShapeKind::cylinder || shape.kind == ShapeKind::cone;
  const double rounding =
      2.0e-6 * double(largest_coordinate(rotated)) + (has_disc ? 6.0e-4 * double(shape.radius) : 0.0);
  const DVec3 slack{rounding, rounding, rounding};
  return {position + rotated.low - slack, position + rotated.high + slack};
}

Aabb fat_box(const WorldBox& needed, const BoxMotion& motion) {
  const double size = margin_size(motion);
  const double margin = double(kFatShare) * size;
  const DVec3 all{margin, margin, margin};
  const float max_ahead = kMaxAhead * float(size);
  const Vec3 ahead = max(min(motion.translation, Vec3{max_ahead, max_ahead, max_ahead}),
                         Vec3{-max_ahead, -max_ahead, -max_ahead});
  return round_outward({needed.low - all + min(ahead, Vec3{}), needed.high + all + max(ahead, Vec3{})});
}

Aabb round_outward(const WorldBox& box) {
  return {{round_down(box.low.x), round_down(box.low.y), round_down(box.low.z)},
          {round_up(box.high.x), round_up(box.high.y), round_up(box.high.z)}};
}

}  // namespace gyre
