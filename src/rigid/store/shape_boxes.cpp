// Bounding boxes of shapes in SIMD lanes. See shape_boxes.h.
#include "rigid/store/shape_boxes.h"

#include "math/wide_vec.h"

#include <cstddef>

namespace gyre {

namespace {

constexpr int kBoxLanes = 4;
using Number = Wide<kBoxLanes>;
using Vector = Vec3W<kBoxLanes>;
using Rotation = QuatW<kBoxLanes>;

// Four consecutive floats of one record in each lane.
struct FourEach {
  Number value[4];
  explicit FourEach(const float* const (&first)[kBoxLanes]) { Rows<kBoxLanes>::gather(first, 0, value); }
  Vector vector(int first) const { return {value[first], value[first + 1], value[first + 2]}; }
  Rotation rotation() const { return {value[0], value[1], value[2], value[3]}; }
};
static_assert(offsetof(Shape, extents) == offsetof(Shape, radius) + sizeof(float));
static_assert(offsetof(Aabb, high) == offsetof(Aabb, low) + sizeof(Vec3));

// A vector of numbers whose lanes can be read one by one.
struct Numbers {
  alignas(16) float value[kBoxLanes];
  void operator=(Number n) { n.store(value); }
  operator Number() const { return Number::load(value); }
  float operator[](int lane) const { return value[lane]; }
};
struct Vectors {
  Numbers x, y, z;
  void operator=(const Vector& v) { x = v.x, y = v.y, z = v.z; }
  operator Vector() const { return {x, y, z}; }
  Vec3 operator[](int lane) const { return {x[lane], y[lane], z[lane]}; }
};

// A bound of the rounding errors of a box side, relative to the sum of its terms: rounding to float, and the margin
// that world_box() adds.
constexpr float kSideRounding = 4.0e-6f;
// The same with the terms of a sweep, whose ends are boxes of their own.
constexpr float kSweepRounding = 1.0e-5f;

// True for shapes whose box is symmetric about their centre: a rotated inner box plus a radius.
bool is_rounded_box(ShapeKind kind) {
  return kind == ShapeKind::sphere || kind == ShapeKind::box || kind == ShapeKind::capsule;
}

// Half extents of the box of a rotated box: |R| h, as in bounds().
GYRE_INLINE Vector rotated_extents(const Rotation& q, const Vector& half) {
  const Mat3W<kBoxLanes> r = to_matrix(q);
  return half.x * absolute(r.x) + half.y * absolute(r.y) + half.z * absolute(r.z);
}

// The travel of bodies: at their velocities for `seconds`, or the motion of the present step.
struct BodyTravel {
  Vec3 BodyMotion::*linear;
  Vec3 BodyMotion::*angular;
  float seconds;
};
constexpr BodyTravel expected_travel(float seconds) {
  return {&BodyMotion::linear_velocity, &BodyMotion::angular_velocity, seconds};
}
constexpr BodyTravel kStepTravel{&BodyMotion::delta_position, &BodyMotion::delta_rotation, 1.0f};

// One to four shapes, one in each lane.
class ShapeLanes {
 public:
  ShapeLanes(const RigidWorld& w, std::span<const std::uint32_t> shapes, const BodyTravel& travel) {
    const float *orientations[kBoxLanes], *centers[kBoxLanes], *linear[kBoxLanes], *angular[kBoxLanes];
    const float *shape_radii[kBoxLanes], *offsets[kBoxLanes], *offset_rotations[kBoxLanes];
    Numbers radii_of_bodies;
    for (int i = 0; i < kBoxLanes; ++i) {
      const std::uint32_t shape = shapes[min(std::size_t(i), shapes.size() - 1)],
                          body = w.shapes.bodies[shape];
      const BodyMass& mass = w.bodies.masses[body];
      const ColliderShape& collider = w.shapes.colliders[shape];
      colliders_[i] = &collider;
      boxes_[i] = &w.shapes.proxies[shape].fat_box;
      middles_[i] = w.bodies.poses[body].center;
      sizes_.value[i] = collider.size;
      radii_of_bodies.value[i] = mass.bounding_radius;
      orientations[i] = &w.bodies.poses[body].orientation.x;
      centers[i] = &mass.center.x;
      linear[i] = &(w.bodies.motion[body].*travel.linear).x;
      angular[i] = &(w.bodies.motion[body].*travel.angular).x;
      shape_radii[i] = &collider.shape.radius;
      offsets[i] = &collider.body_from_shape.position.x;
      offset_rotations[i] = &collider.body_from_shape.orientation.x;
    }
    const Rotation world_from_body = FourEach(orientations).rotation();
    to_origin_ = rotate(world_from_body, FourEach(centers).vector(0));
    to_shape_ = rotate(world_from_body, FourEach(offsets).vector(0));
    const Rotation orientation = world_from_body * FourEach(offset_rotations).rotation();
    orientation_[0] = orientation.x, orientation_[1] = orientation.y, orientation_[2] = orientation.z,
    orientation_[3] = orientation.w;
    const FourEach radius_and_extents(shape_radii);
    const Number radius = radius_and_extents.value[0];
    half_ = rotated_extents(orientation, radius_and_extents.vector(1)) + Vector{radius, radius, radius};
    translation_ = Number(travel.seconds) * FourEach(linear).vector(0);
    const Number spin = length(FourEach(angular).vector(0));
    arc_ = Number(travel.seconds) * radii_of_bodies * spin;
    angle_ = Number(travel.seconds) * spin;
  }

  ShapeBox box(int lane) const {
    const ColliderShape& collider = *colliders_[lane];
    const DVec3 position = middles_[lane] - to_origin_[lane] + to_shape_[lane];
    const BoxMotion motion{collider.size, translation_[lane], arc_[lane]};
    if (is_rounded_box(collider.shape.kind))
      return {world_box(collider.shape, {-half_[lane], half_[lane]}, position), motion};
    const Quat orientation{orientation_[0][lane], orientation_[1][lane], orientation_[2][lane],
                           orientation_[3][lane]};
    return {world_box(collider.shape, {position, orientation}), motion};
  }

  // Bit i is set if refit_box() certainly leaves the fat box of lane i unchanged. Most fat boxes stay for many steps.
  unsigned needs_no_refit() const {
    const Number size = sizes_;
    Mask<kBoxLanes> fits = Mask<kBoxLanes>::splat(true);
    const auto fit = [&](Number half, Number from, Number to, Number slack) {
      fits = fits & (to - from - (half + half) + slack < kTooLarge * size);
    };
    const unsigned inside = within(kSpeculativeShare * size + arc_, kSideRounding, fit);
    return inside & to_bits(fits);
  }

  // Bit i is set if the fat box of lane i certainly contains the shape at all moments of its motion.
  unsigned within_on_sweep() const {
    const Number turning = arc_, angle = angle_;
    // The end pose, and the sagitta of the arc between start and end.
    return within(turning + 0.125f * turning * angle, kSweepRounding, [](Number, Number, Number, Number) {});
  }

 private:
  // Bit i is set if the fat box of lane i contains the shape with a margin, at the start and at the end of its
  // travel. Calls visit_axis(half extent, low and high side of the fat box, slack) for each axis.
  template <class Visit>
  unsigned within(Number margin, float rounding, const Visit& visit_axis) const {
    const float *lows[kBoxLanes], *highs[kBoxLanes];
    Vectors middles;
    unsigned rounded = 0;
    for (int i = 0; i < kBoxLanes; ++i) {
      lows[i] = &boxes_[i]->low.x;
      highs[i] = &boxes_[i]->low.z;
      const Vec3 middle = to_float(middles_[i]);
      middles.x.value[i] = middle.x, middles.y.value[i] = middle.y, middles.z.value[i] = middle.z;
      rounded |= is_rounded_box(colliders_[i]->shape.kind) ? 1u << i : 0u;
    }
    const Vector low = FourEach(lows).vector(0), high = FourEach(highs).vector(1);
    const Vector middle = middles, to_origin = to_origin_, to_shape = to_shape_, half = half_,
                 translation = translation_;
    const Number zero = 0.0f;
    const Vector extent = half + Vector{margin, margin, margin}, position = middle - to_origin + to_shape;
    const Number slack = rounding * largest(absolute(middle) + absolute(to_origin) + absolute(to_shape) +
                                            extent + absolute(translation));
    Mask<kBoxLanes> inside = Mask<kBoxLanes>::splat(true);
    const auto test_axis = [&](Number at, Number extent_with_margin, Number moves_by, Number half_extent,
                               Number from, Number to) {
      inside = inside & (at - extent_with_margin + min(moves_by, zero) - slack > from) &
               (at + extent_with_margin + max(moves_by, zero) + slack < to);
      visit_axis(half_extent, from, to, slack);
    };
    test_axis(position.x, extent.x, translation.x, half.x, low.x, high.x);
    test_axis(position.y, extent.y, translation.y, half.y, low.y, high.y);
    test_axis(position.z, extent.z, translation.z, half.z, low.z, high.z);
    return to_bits(inside) & rounded;
  }

  const ColliderShape* colliders_[kBoxLanes];
  const Aabb* boxes_[kBoxLanes];
  DVec3 middles_[kBoxLanes];  // centres of mass of the bodies
  Vectors to_origin_, to_shape_, half_, translation_;
  Numbers sizes_, arc_, angle_, orientation_[4];
};

}  // namespace

ShapeBox find_box(const RigidWorld& w, std::uint32_t shape, float seconds) {
  return ShapeLanes(w, {&shape, 1}, expected_travel(seconds)).box(0);
}

namespace {

// Calls visit(shapes, indices of their bodies in the list) for groups of up to four shapes.
template <class Visit>
void for_lanes(const RigidWorld& w, std::span<const std::uint32_t> bodies, const Visit& visit) {
  std::uint32_t shapes[kBoxLanes], owners[kBoxLanes];
  std::size_t count = 0;
  for (std::uint32_t index = 0; index < bodies.size(); ++index) {
    for (const ShapeId id : w.bodies.shapes[bodies[index]]) {
      shapes[count] = id.index;
      owners[count++] = index;
      if (count < kBoxLanes) continue;
      visit(std::span<const std::uint32_t>(shapes, count), owners);
      count = 0;
    }
  }
  if (count > 0) visit(std::span<const std::uint32_t>(shapes, count), owners);
}

}  // namespace

bool refit_boxes(RigidWorld& w, std::span<const std::uint32_t> bodies, float seconds) {
  bool any = false;
  for_lanes(w, bodies, [&](std::span<const std::uint32_t> shapes, const std::uint32_t*) {
    const ShapeLanes lanes(w, shapes, expected_travel(seconds));
    const unsigned fits = lanes.needs_no_refit();
    for (std::size_t i = 0; i < shapes.size(); ++i) {
      if ((fits >> i & 1u) != 0) continue;
      const ShapeBox box = lanes.box(int(i));
      if (!refit_box(w.shapes.proxies[shapes[i]].fat_box, box.tight, box.motion)) continue;
      w.refit_marks[shapes[i]] = 1;
      any = true;
    }
  });
  return any;
}

void find_within_fat_boxes(const RigidWorld& w, std::span<const std::uint32_t> bodies, std::span<bool> stay) {
  for (bool& one : stay) one = true;
  for_lanes(w, bodies, [&](std::span<const std::uint32_t> shapes, const std::uint32_t* owners) {
    const unsigned rounded = ShapeLanes(w, shapes, kStepTravel).within_on_sweep();
    for (std::size_t i = 0; i < shapes.size(); ++i)
      stay[owners[i]] = stay[owners[i]] && (rounded >> i & 1u) != 0;
  });
}

}  // namespace gyre
