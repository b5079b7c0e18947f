// Boxes of shapes in lanes. See shape_boxes.h.
#include "rigid/store/shape_boxes.h"

#include "math/wide_vec.h"

#include <cstddef>

namespace gyre {

namespace {

constexpr int kBoxLanes = 4;
using Number = Wide<kBoxLanes>;
using Vector = Vec3W<kBoxLanes>;
using Rotation = QuatW<kBoxLanes>;

// Four numbers of each lane's record that lie in a row.
struct FourEach {
  Number value[4];
  explicit FourEach(const float* const (&first)[kBoxLanes]) { Rows<kBoxLanes>::gather(first, 0, value); }
  Vector vector(int first) const { return {value[first], value[first + 1], value[first + 2]}; }
  Rotation rotation() const { return {value[0], value[1], value[2], value[3]}; }
};
static_assert(offsetof(Shape, extents) == offsetof(Shape, radius) + sizeof(float));
static_assert(offsetof(Aabb, high) == offsetof(Aabb, low) + sizeof(Vec3));

// Numbers that are taken one by one, too.
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

// Of the numbers that a side of a box is the sum of: more than rounding them to float, and what world_box() adds, can come to.
constexpr float kSideRounding = 4.0e-6f;
// The same of what a sweep adds, whose ends are boxes of their own.
constexpr float kWayRounding = 1.0e-5f;

// Shapes whose box is as far to both sides: that of the inner box, turned, and the radius around it.
bool is_rounded_box(ShapeKind kind) {
  return kind == ShapeKind::sphere || kind == ShapeKind::box || kind == ShapeKind::capsule;
}

// Half sizes of the box of a box: |R| h, as bounds() has it.
GYRE_INLINE Vector turned_extents(const Rotation& q, const Vector& half) {
  const Mat3W<kBoxLanes> r = to_matrix(q);
  return half.x * absolute(r.x) + half.y * absolute(r.y) + half.z * absolute(r.z);
}

// How bodies go: at their velocities for some seconds, or as far as they went in this step.
struct Going {
  Vec3 BodyMotion::*linear;
  Vec3 BodyMotion::*angular;
  float seconds;
};
constexpr Going coming(float seconds) {
  return {&BodyMotion::linear_velocity, &BodyMotion::angular_velocity, seconds};
}
constexpr Going kGone{&BodyMotion::delta_position, &BodyMotion::delta_rotation, 1.0f};

// From one to four shapes.
class ShapeLanes {
 public:
  ShapeLanes(const RigidWorld& w, std::span<const std::uint32_t> shapes, const Going& going) {
    const float *turns[kBoxLanes], *centers[kBoxLanes], *linear[kBoxLanes], *angular[kBoxLanes];
    const float *radii[kBoxLanes], *places[kBoxLanes], *place_turns[kBoxLanes];
    Numbers reaches;
    for (int i = 0; i < kBoxLanes; ++i) {
      const std::uint32_t shape = shapes[min(std::size_t(i), shapes.size() - 1)],
                          body = w.shapes.bodies[shape];
      const BodyMass& mass = w.bodies.masses[body];
      const ColliderShape& collider = w.shapes.colliders[shape];
      colliders_[i] = &collider;
      boxes_[i] = &w.shapes.proxies[shape].fat_box;
      middles_[i] = w.bodies.places[body].center;
      sizes_.value[i] = collider.size;
      reaches.value[i] = mass.reach;
      turns[i] = &w.bodies.places[body].orientation.x;
      centers[i] = &mass.center.x;
      linear[i] = &(w.bodies.motion[body].*going.linear).x;
      angular[i] = &(w.bodies.motion[body].*going.angular).x;
      radii[i] = &collider.shape.radius;
      places[i] = &collider.body_from_shape.position.x;
      place_turns[i] = &collider.body_from_shape.orientation.x;
    }
    const Rotation world_from_body = FourEach(turns).rotation();
    to_origin_ = rotate(world_from_body, FourEach(centers).vector(0));
    to_shape_ = rotate(world_from_body, FourEach(places).vector(0));
    const Rotation turn = world_from_body * FourEach(place_turns).rotation();
    turn_[0] = turn.x, turn_[1] = turn.y, turn_[2] = turn.z, turn_[3] = turn.w;
    const FourEach radius_and_extents(radii);
    const Number radius = radius_and_extents.value[0];
    half_ = turned_extents(turn, radius_and_extents.vector(1)) + Vector{radius, radius, radius};
    way_ = Number(going.seconds) * FourEach(linear).vector(0);
    const Number spin = length(FourEach(angular).vector(0));
    turning_ = Number(going.seconds) * reaches * spin;
    angle_ = Number(going.seconds) * spin;
  }

  ShapeBox box(int lane) const {
    const ColliderShape& collider = *colliders_[lane];
    const DVec3 position = middles_[lane] - to_origin_[lane] + to_shape_[lane];
    const BoxMotion motion{collider.size, way_[lane], turning_[lane]};
    if (is_rounded_box(collider.shape.kind))
      return {world_box(collider.shape, {-half_[lane], half_[lane]}, position), motion};
    const Quat turn{turn_[0][lane], turn_[1][lane], turn_[2][lane], turn_[3][lane]};
    return {world_box(collider.shape, {position, turn}), motion};
  }

  // Bit i: refit_box() leaves the fat box of lane i as it is, for certain; most rest in theirs for many steps.
  unsigned stay() const {
    const Number size = sizes_;
    Mask<kBoxLanes> fits = Mask<kBoxLanes>::splat(true);
    const auto fit = [&](Number inside, Number from, Number to, Number slack) {
      fits = fits & (to - from - (inside + inside) + slack < kTooLarge * size);
    };
    const unsigned inside = stay_within(kSpeculativeShare * size + turning_, kSideRounding, fit);
    return inside & to_bits(fits);
  }

  // Bit i: the whole way of lane i is inside its fat box, for certain.
  unsigned stay_on_way() const {
    const Number turning = turning_, angle = angle_;
    // Its end, and as far as its turn bulges between start and end.
    return stay_within(turning + 0.125f * turning * angle, kWayRounding,
                       [](Number, Number, Number, Number) {});
  }

 private:
  // Bit i: the shape and a margin around it, and both after their way, are inside the fat box of lane i. Calls
  // also(half of the shape's side, box's low and high, slack) for each axis.
  template <class Also>
  unsigned stay_within(Number margin, float rounding, const Also& also) const {
    const float *lows[kBoxLanes], *highs[kBoxLanes];
    Vectors middles;
    unsigned known = 0;
    for (int i = 0; i < kBoxLanes; ++i) {
      lows[i] = &boxes_[i]->low.x;
      highs[i] = &boxes_[i]->low.z;
      const Vec3 middle = to_float(middles_[i]);
      middles.x.value[i] = middle.x, middles.y.value[i] = middle.y, middles.z.value[i] = middle.z;
      known |= is_rounded_box(colliders_[i]->shape.kind) ? 1u << i : 0u;
    }
    const Vector low = FourEach(lows).vector(0), high = FourEach(highs).vector(1);
    const Vector middle = middles, to_origin = to_origin_, to_shape = to_shape_, half = half_, way = way_;
    const Number zero = 0.0f;
    const Vector reach = half + Vector{margin, margin, margin}, position = middle - to_origin + to_shape;
    const Number slack = rounding * largest(absolute(middle) + absolute(to_origin) + absolute(to_shape) +
                                            reach + absolute(way));
    Mask<kBoxLanes> stop_at_impact = Mask<kBoxLanes>::splat(true);
    const auto look = [&](Number at, Number away, Number goes, Number inside, Number from, Number to) {
      stop_at_impact = stop_at_impact & (at - away + min(goes, zero) - slack > from) &
                       (at + away + max(goes, zero) + slack < to);
      also(inside, from, to, slack);
    };
    look(position.x, reach.x, way.x, half.x, low.x, high.x);
    look(position.y, reach.y, way.y, half.y, low.y, high.y);
    look(position.z, reach.z, way.z, half.z, low.z, high.z);
    return to_bits(stop_at_impact) & known;
  }

  const ColliderShape* colliders_[kBoxLanes];
  const Aabb* boxes_[kBoxLanes];
  DVec3 middles_[kBoxLanes];  // of the bodies' mass
  Vectors to_origin_, to_shape_, half_, way_;
  Numbers sizes_, turning_, angle_, turn_[4];
};

}  // namespace

ShapeBox find_box(const RigidWorld& w, std::uint32_t shape, float seconds) {
  return ShapeLanes(w, {&shape, 1}, coming(seconds)).box(0);
}

namespace {

// Calls look(shapes, their number, places of their bodies in the list) for the bodies' shapes, so many at once.
template <class Look>
void for_lanes(const RigidWorld& w, std::span<const std::uint32_t> bodies, const Look& look) {
  std::uint32_t shapes[kBoxLanes], owners[kBoxLanes];
  std::size_t count = 0;
  for (std::uint32_t place = 0; place < bodies.size(); ++place) {
    for (const ShapeId id : w.bodies.shapes[bodies[place]]) {
      shapes[count] = id.index;
      owners[count++] = place;
      if (count < kBoxLanes) continue;
      look(std::span<const std::uint32_t>(shapes, count), owners);
      count = 0;
    }
  }
  if (count > 0) look(std::span<const std::uint32_t>(shapes, count), owners);
}

}  // namespace

bool refit_boxes(RigidWorld& w, std::span<const std::uint32_t> bodies, float seconds) {
  bool any = false;
  for_lanes(w, bodies, [&](std::span<const std::uint32_t> shapes, const std::uint32_t*) {
    const ShapeLanes lanes(w, shapes, coming(seconds));
    const unsigned stay = lanes.stay();
    for (std::size_t i = 0; i < shapes.size(); ++i) {
      if ((stay >> i & 1u) != 0) continue;
      const ShapeBox box = lanes.box(int(i));
      if (!refit_box(w.shapes.proxies[shapes[i]].fat_box, box.tight, box.motion)) continue;
      w.refit_marks[shapes[i]] = 1;
      any = true;
    }
  });
  return any;
}

void find_staying(const RigidWorld& w, std::span<const std::uint32_t> bodies, std::span<bool> stay) {
  for (bool& one : stay) one = true;
  for_lanes(w, bodies, [&](std::span<const std::uint32_t> shapes, const std::uint32_t* owners) {
    const unsigned known = ShapeLanes(w, shapes, kGone).stay_on_way();
    for (std::size_t i = 0; i < shapes.size(); ++i)
      stay[owners[i]] = stay[owners[i]] && (known >> i & 1u) != 0;
  });
}

}  // namespace gyre
