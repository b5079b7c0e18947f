// Bodies and joints of a bundle of articulations (solver/articulation/articulation_lanes.h) for the kernels,
// W of each side by side, and the exchange with the records of bodies.
#pragma once

#include "math/wide_vec.h"
#include "solver/articulation/articulation_matrix.h"

namespace gyre {
inline namespace GYRE_TARGET_NAMESPACE {

template <int W>
struct WideBody {
  std::int32_t record[W];
  std::int32_t pressed[W];  // 1: contacts act on it
  Vec3W<W> linear,
      angular;  // velocities, within a stage, or from contacts to contacts (LaneVelocities)
  Wide<W> inverse_mass;
  Sym3W<W> inverse;      // of the inertia with geometric stiffness
  Sym3W<W> own_inverse;  // of the inertia as it is
  Sym3W<W> inertia;
  QuatW<W> rotation;  // rotation in the sub-step by its velocities
  // During preparation: the pose, and the geometric stiffness (N m/rad).
  QuatW<W> orientation;
  Vec3W<W> delta_position;
  Sym3W<W> geometric_stiffness;
  Vec3W<W> center;  // while inner motion is scaled: relative to the first body
};

static_assert(offsetof(WideBody<4>, angular) == offsetof(WideBody<4>, linear) + sizeof(Vec3W<4>));

// As LaneLimitAxis, LaneJoint, LaneDrives and LaneServo.
template <int W>
struct WideLimitAxis {
  Wide<W> low, high, low_impulse, high_impulse, total, low_gap, high_gap;
  Vec3W<W> about;
  Wide<W> mass;
};
template <int W>
struct WideJoint {
  Vec3W<W> local_a, local_b, offset, linear_impulse, angular_impulse, total_linear, total_angular;
  QuatW<W> local_frame_a, local_frame_b;
  Wide<W> position, inverse_swing_y, inverse_swing_z;
  WideLimitAxis<W> twist, swing;
  Vec3W<W> from_a, from_b, error, compliance, target_speed;
  Vec3W<W> axis, perpendicular_1, perpendicular_2, angular_error;
  Wide<W> angular_compliance_1, angular_compliance_2, angular_target_1, angular_target_2;
};
template <int W>
struct WideDrives {
  Vec3W<W> drive_impulse, friction_impulse;
  Wide<W> total, max_drive, max_friction;
  Vec3W<W> target_speed;
  QuatW<W> target;
  Wide<W> rate, mass_scale, impulse_scale;
  Vec3W<W> error, speed;
  Sym3W<W> mass;
};
template <int W>
struct WideServo {
  WideLimitAxis<W> axis;
  Wide<W> max_impulse, target_speed, rate;
};
static_assert(sizeof(WideDrives<1>) == sizeof(LaneDrives) && sizeof(WideServo<1>) == sizeof(LaneServo));
static_assert(sizeof(WideLimitAxis<1>) == sizeof(LaneLimitAxis) && sizeof(WideJoint<1>) == sizeof(LaneJoint));
static_assert(offsetof(WideJoint<1>, swing) == offsetof(LaneJoint, swing));
static_assert(offsetof(WideJoint<1>, from_a) == offsetof(LaneJoint, from_a));

// A bundle within a stage.
template <int W>
struct WideBundle {
  const ArticulationBundle& plain;
  WideBody<W>* bodies;
  WideJoint<W>* joints;
  WideDrives<W>* drives;
  WideServo<W>* servos;

  GYRE_INLINE explicit WideBundle(const ArticulationBundle& bundle)
      : plain(bundle),
        bodies(reinterpret_cast<WideBody<W>*>(bundle.bodies)),
        joints(reinterpret_cast<WideJoint<W>*>(bundle.joints)),
        drives(reinterpret_cast<WideDrives<W>*>(bundle.drives)),
        servos(reinterpret_cast<WideServo<W>*>(bundle.servos)) {}
  GYRE_INLINE bool moves(std::uint32_t body) const { return body < plain.moving_count; }

  // Access to the matrix.
  GYRE_INLINE void set_value(std::uint32_t i, Wide<W> v) const { v.store(plain.values + i * W); }
  GYRE_INLINE void add_value(std::uint32_t i, Wide<W> v) const {
    set_value(i, Wide<W>::load(plain.values + i * W) + v);
  }
  // Access to the vector, or one like it.
  GYRE_INLINE void set_row(std::uint32_t row, Wide<W> v) const { set_row(plain.vector, row, v); }
  GYRE_INLINE static void set_row(float* vector, std::uint32_t row, Wide<W> v) { v.store(vector + row * W); }
  GYRE_INLINE Wide<W> row(std::uint32_t row) const { return Wide<W>::load(plain.vector + row * W); }
  GYRE_INLINE Vec3W<W> rows3(std::uint32_t first) const {
    return {row(first), row(first + 1), row(first + 2)};
  }
};

// Applies the impulse p at the joint and the angular impulse t to b, and their opposites to a.
template <int W>
GYRE_INLINE void apply_joint_impulse(const WideBundle<W>& bundle, const LaneNode& node,
                                     const WideJoint<W>& joint, Vec3W<W> p, Vec3W<W> t) {
  if (bundle.moves(node.a)) {
    WideBody<W>& a = bundle.bodies[node.a];
    a.linear -= a.inverse_mass * p;
    a.angular -= a.inverse * (cross(joint.from_a, p) + t);
  }
  if (bundle.moves(node.b)) {
    WideBody<W>& b = bundle.bodies[node.b];
    b.linear += b.inverse_mass * p;
    b.angular += b.inverse * (cross(joint.from_b, p) + t);
  }
}

// Adds the change of an impulse in some lanes. Zero is not added to the others: it would turn their -0 into 0, and a lane alone keeps it.
template <int W>
GYRE_INLINE void add_in_lanes(Vec3W<W>& impulse, Vec3W<W> change, Mask<W> lanes) {
  impulse = select<W>(lanes, impulse + change, impulse);
}

// Gathers `Fours` times four floats of records of `Stride` floats; of `none` where there is no record.
template <int Fours, int W, int Stride>
GYRE_INLINE void gather_vec4(const float* base, const std::int32_t* indices, const float* none, int first,
                             Wide<W>* out) {
  const float* record[W];
  locate_records<W, Stride>(base, indices, none, record);
  if constexpr (W == 1) {
    GYRE_UNROLL
    for (int c = 0; c < 4 * Fours; ++c) out[c] = Wide<W>(record[0][first + c]);
  } else {
    Rows<W>::gather(record, first, out);
    if constexpr (Fours > 1) Rows<W>::gather(record, first + 4, out + 4);
  }
}

// (These two are not inlined: every stage has them.)
template <int W>
__attribute__((noinline)) void load_velocities(const WideBundle<W>& bundle, const LaneArrays& arrays) {
  for (std::uint32_t i = arrays.loads ? 0 : bundle.plain.moving_count; i < bundle.plain.body_count; ++i) {
    WideBody<W>& body = bundle.bodies[i];
    Wide<W> c[8];
    gather8<W>(&arrays.motion->linear_velocity.x, body.record, c);
    body.linear = {c[0], c[1], c[2]};
    body.angular = {c[3], c[4], c[5]};
  }
}

template <int W>
__attribute__((noinline)) void store_velocities(const WideBundle<W>& bundle, const LaneArrays& arrays) {
  // Adding zero keeps -0 out of the state.
  const Wide<W> zero(0.0f);
  for (std::uint32_t i = 0; i < bundle.plain.moving_count; ++i) {
    WideBody<W>& body = bundle.bodies[i];
    body.linear = {body.linear.x + zero, body.linear.y + zero, body.linear.z + zero};
    body.angular = {body.angular.x + zero, body.angular.y + zero, body.angular.z + zero};
    if (!arrays.stores) continue;
    const Wide<W> c[6] = {body.linear.x,  body.linear.y,  body.linear.z,
                          body.angular.x, body.angular.y, body.angular.z};
    scatter<6, W>(&arrays.motion->linear_velocity.x, body.record, c);
  }
}

// Loads poses and inertia of the bodies.
template <int W>
GYRE_INLINE void load_poses(const WideBundle<W>& bundle, const LaneArrays& arrays) {
  alignas(64) static constexpr float kZeros[kRecordFloats] = {};
  alignas(16) static constexpr float kUnturned[4] = {0.0f, 0.0f, 0.0f, 1.0f};
  constexpr int kInertiaFloats = int(sizeof(BodyInertia) / sizeof(float));
  for (std::uint32_t i = 0; i < bundle.plain.body_count; ++i) {
    WideBody<W>& body = bundle.bodies[i];
    Wide<W> c[8];
    gather_vec4<1, W, 4>(&arrays.orientation->x, body.record, kUnturned, 0, c);
    body.orientation = {c[0], c[1], c[2], c[3]};
    gather_vec4<1, W, kMotionFloats>(&arrays.motion->linear_velocity.x, body.record, kZeros,
                                     kMotionDeltaPosition, c);
    body.delta_position = {c[0], c[1], c[2]};
    const Wide<W> zero(0.0f);
    body.geometric_stiffness = {zero, zero, zero, zero, zero, zero};
    if (!bundle.moves(i)) {
      body.inverse_mass = zero;
      body.inverse = body.own_inverse = body.inertia = body.geometric_stiffness;
      continue;
    }
    gather_vec4<2, W, kInertiaFloats>(&arrays.inertia->inverse.xx, body.record, kZeros, 0, c);
    body.own_inverse = {c[0], c[1], c[2], c[3], c[4], c[5]};
    body.inverse = body.own_inverse;
    body.inverse_mass = c[6];
    body.inertia = inverse(body.own_inverse);
  }
}

}  // namespace GYRE_TARGET_NAMESPACE
}  // namespace gyre
