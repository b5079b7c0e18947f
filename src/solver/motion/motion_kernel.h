// The motion kernels: forces, displacement and free rotation of W bodies at once, one template for every
// width. Lane i computes exactly what a block of width 1 would, so the width never changes a bit.
//
// Within a step the rotation of a body is a rotation vector since the step began (delta_rotation), composed
// by the first terms of Baker, Campbell and Hausdorff. The orientation follows from it once a step, in double
// (rigid/integrate/integrators.h). So rotations far below the resolution of floats add up, and a step needs
// one exponential map instead of one a sub-step.
//
// Free rotation: the angular momentum is constant in the world frame. A body rotates with the angular
// velocity of the middle of the sub-step; at its end it has the angular velocity of its momentum in the new
// orientation. The error is of order angle^3; faster bodies get exact rotation. Sources as in
// solver/motion/torque_free_rotation_kernel.h.
//
// Warm start: contacts act at the beginning of each sub-step as in the last one. Instead of a loop over all
// contacts, each body stores their effect.
#pragma once

#include "math/wide_vec.h"
#include "solver/motion/motion_block.h"

namespace gyre {
inline namespace GYRE_TARGET_NAMESPACE {

template <int W>
struct MotionBlock {
  std::int32_t body[W];         // kNoBody in lanes without a body
  std::uint32_t pose_read = 0;  // bits of lanes
  std::int32_t any_locked = 0, any_torque = 0, any_loss = 0, any_gyroscopic = 0, carries_rounding = 0;
  std::int32_t was_at_rest = 0;  // nothing moved in the last sub-step, nor before: what depends on the motion
                                 // is up to date
  Vec3W<W> velocity_gain, torque;
  Vec3W<W> lost_gain;  // by rounding, if that is carried
  Wide<W> linear_loss, angular_loss, bounding_radius;
  Vec3W<W> free_axes;                             // 1 along free world axes, 0 along locked ones
  Wide<W> rotates;                                // 1 where the kernel rotates the body
  Wide<W> gyroscopic;                             // 1 where principal moments differ
  QuatW<W> start;                                 // orientation at the beginning of the step
  Sym3W<W> inertia, inverse_inertia;              // body frame
  Sym3W<W> world_inertia, world_inverse_inertia;  // of the present orientation
  Vec3W<W> recorded_linear, recorded_angular;     // velocities before contacts
  Vec3W<W> contact_linear, contact_angular;       // velocity change by contacts in the last sub-step
};

template <int W>
struct MotionW {
  Wide<W> record[kMotionFloats];

  GYRE_INLINE Vec3W<W> linear() const { return {record[0], record[1], record[2]}; }
  GYRE_INLINE Vec3W<W> angular() const { return {record[3], record[4], record[5]}; }
  GYRE_INLINE Vec3W<W> delta_position() const { return {record[8], record[9], record[10]}; }
  GYRE_INLINE Vec3W<W> delta_rotation() const { return {record[11], record[12], record[13]}; }
  GYRE_INLINE void set_linear(Vec3W<W> v) { record[0] = v.x, record[1] = v.y, record[2] = v.z; }
  GYRE_INLINE void set_angular(Vec3W<W> v) { record[3] = v.x, record[4] = v.y, record[5] = v.z; }
  GYRE_INLINE void set_delta_position(Vec3W<W> v) { record[8] = v.x, record[9] = v.y, record[10] = v.z; }
  GYRE_INLINE void set_delta_rotation(Vec3W<W> v) { record[11] = v.x, record[12] = v.y, record[13] = v.z; }
};

// The first `Columns` floats of the block's motion records.
template <int Columns, int W>
GYRE_INLINE MotionW<W> load_motion(const MotionBlock<W>& block, const BodyMotion* motion) {
  MotionW<W> m;
  gather<Columns, W>(&motion->linear_velocity.x, block.body, m.record);
  return m;
}
template <int Columns, int W>
GYRE_INLINE void store_motion(const MotionBlock<W>& block, BodyMotion* motion, const MotionW<W>& m) {
  scatter<Columns, W>(&motion->linear_velocity.x, block.body, m.record);
}

// Access to the velocities of blocks in the motion records, with all other columns.
template <int W>
struct InRecords {
  BodyMotion* motion;

  template <int Columns>
  GYRE_INLINE MotionW<W> load(const MotionBlock<W>& block, int) const {
    return load_motion<Columns, W>(block, motion);
  }
  template <int Columns>
  GYRE_INLINE void store(const MotionBlock<W>& block, int, const MotionW<W>& m) const {
    store_motion<Columns, W>(block, motion, m);
  }
};
// Access to velocities in lanes.
template <int W>
struct InLanes {
  const LaneVelocities& lanes;
  BodyMotion* motion = nullptr;  // null in kernels that only need velocities

  template <int Columns>
  GYRE_INLINE MotionW<W> load(const MotionBlock<W>& block, int n) const {
    MotionW<W> m;
    const float* const from = lanes.of(n);
    GYRE_UNROLL
    for (int i = 0; i < 6; ++i) m.record[i] = Wide<W>::load(from + i * W);
    if constexpr (Columns > kMotionDeltaPosition)
      gather8<W>(&motion->delta_position.x, block.body, m.record + kMotionDeltaPosition);
    return m;
  }
  template <int Columns>
  GYRE_INLINE void store(const MotionBlock<W>& block, int n, const MotionW<W>& m) const {
    float* const to = lanes.of(n);
    GYRE_UNROLL
    for (int i = 0; i < 6; ++i) m.record[i].store(to + i * W);
    if constexpr (Columns > kMotionDeltaPosition)
      scatter<Columns - kMotionDeltaPosition, W>(&motion->delta_position.x, block.body,
                                                 m.record + kMotionDeltaPosition);
  }
};

template <int W>
GYRE_INLINE Vec3W<W> along_free_axes(const MotionBlock<W>& block, Vec3W<W> v) {
  const Wide<W> zero(0.0f);
  return {select(block.free_axes.x > zero, v.x, zero), select(block.free_axes.y > zero, v.y, zero),
          select(block.free_axes.z > zero, v.z, zero)};
}

// Clamps the length without overflow, whatever the numbers.
template <int W>
GYRE_INLINE Vec3W<W> clamp_without_overflow(Vec3W<W> v, float max_length) {
  const Wide<W> top = max(absolute(v.x), max(absolute(v.y), absolute(v.z)));
  const auto may_exceed = top > Wide<W>(0.5f * max_length);
  if (!any(may_exceed)) return v;
  const Wide<W> scale = select(may_exceed, top, Wide<W>(1.0f));
  const Vec3W<W> u{v.x / scale, v.y / scale, v.z / scale};
  // In units of the largest component: the length itself may overflow.
  const Wide<W> size = sqrt(dot(u, u)), limit = Wide<W>(max_length) / scale;
  const auto exceeds = may_exceed & (size > limit);
  const Wide<W> share = limit / select(exceeds, size, Wide<W>(1.0f));
  return select<W>(exceeds, share * v, v);
}

// log(exp(rotation) exp(before)) up to terms of the fourth order.
template <int W>
GYRE_INLINE Vec3W<W> compose_rotations(Vec3W<W> rotation, Vec3W<W> before) {
  const Vec3W<W> c = cross(rotation, before), sum = before + rotation;
  const Vec3W<W> composed = sum + 0.5f * c + (1.0f / 12.0f) * cross(rotation - before, c);
  // The angle of two rotations never exceeds their sum. For several turns in a half step the series violates
  // this, and the result would grow without bound from one half step to the next.
  const Wide<W> bound = 2.1f * (dot(rotation, rotation) + dot(before, before));
  return select<W>(dot(composed, composed) <= bound, composed, sum);
}

template <class Number>
GYRE_INLINE void put(Number& wide, int lane, float value) {
  wide.set(lane, value);
}
template <int W>
GYRE_INLINE void put(Vec3W<W>& wide, int lane, Vec3 v) {
  wide.x.set(lane, v.x), wide.y.set(lane, v.y), wide.z.set(lane, v.z);
}
template <int W>
GYRE_INLINE void put(Sym3W<W>& wide, int lane, const Sym3& m) {
  wide.xx.set(lane, m.xx), wide.yy.set(lane, m.yy), wide.zz.set(lane, m.zz);
  wide.xy.set(lane, m.xy), wide.xz.set(lane, m.xz), wide.yz.set(lane, m.yz);
}

template <int W>
void prepare_motion(void* memory, int begin, int end, const MovedBody* bodies, int count,
                    const BodyInertia* inertia) {
  auto* blocks = static_cast<MotionBlock<W>*>(memory);
  for (int n = begin; n < end; ++n) {
    MotionBlock<W>& block = blocks[n];
    block = MotionBlock<W>{};
    for (int lane = 0; lane < W; ++lane) {
      block.body[lane] = kNoBody;
      if (n * W + lane >= count || bodies[n * W + lane].body == kNoBody) {
        block.start.w.set(lane, 1.0f);
        continue;
      }
      const MovedBody& from = bodies[n * W + lane];
      block.body[lane] = from.body;
      if (from.pose_read && !from.needs_exact_rotation) block.pose_read |= 1u << lane;
      if (from.locked != 0) block.any_locked = 1;
      if (from.carries_rounding) block.carries_rounding = 1;
      if (from.torque != Vec3{}) block.any_torque = 1;
      if (from.linear_loss != 0.0f || from.angular_loss != 0.0f) block.any_loss = 1;
      const bool gyroscopic = !from.isotropic && !from.needs_exact_rotation;
      if (gyroscopic) block.any_gyroscopic = 1;
      put<W>(block.velocity_gain, lane, from.velocity_gain);
      put<W>(block.torque, lane, from.torque);
      put(block.linear_loss, lane, from.linear_loss);
      put(block.angular_loss, lane, from.angular_loss);
      put(block.bounding_radius, lane, from.bounding_radius);
      put<W>(block.free_axes, lane,
             Vec3{(from.locked & 1) != 0 ? 0.0f : 1.0f, (from.locked & 2) != 0 ? 0.0f : 1.0f,
                  (from.locked & 4) != 0 ? 0.0f : 1.0f});
      put(block.rotates, lane, from.needs_exact_rotation ? 0.0f : 1.0f);
      put(block.gyroscopic, lane, gyroscopic ? 1.0f : 0.0f);
      put(block.start.x, lane, from.orientation.x);
      put(block.start.y, lane, from.orientation.y);
      put(block.start.z, lane, from.orientation.z);
      put(block.start.w, lane, from.orientation.w);
      put<W>(block.inertia, lane, from.inertia);
      put<W>(block.inverse_inertia, lane, from.inverse_inertia);
      put<W>(block.world_inverse_inertia, lane, inertia[from.body].inverse);
    }
    if (block.any_gyroscopic != 0)
      block.world_inertia = rotate_inertia<W>(to_matrix<W>(block.start), block.inertia);
  }
}

template <int W>
GYRE_INLINE void add_contact_velocities(MotionBlock<W>& block, MotionW<W>& m) {
  m.set_linear(m.linear() + block.contact_linear);
  m.set_angular(m.angular() + block.contact_angular);
}
template <int W>
GYRE_INLINE void record(MotionBlock<W>& block, const MotionW<W>& m) {
  block.recorded_linear = m.linear();
  block.recorded_angular = m.angular();
}

// Adds the velocity change since the record. The rounding that contacts leave along locked axes is no part of it, whether it is removed
// before this or, where joints are solved in between, later.
template <int W>
GYRE_INLINE void add_gain(MotionBlock<W>& block, const MotionW<W>& m) {
  Vec3W<W> gain = m.linear() - block.recorded_linear;
  if (block.any_locked != 0) gain = along_free_axes<W>(block, gain);
  block.contact_linear = block.contact_linear + gain;
  block.contact_angular = block.contact_angular + (m.angular() - block.recorded_angular);
}

template <int W, class Where>
GYRE_INLINE void integrate_velocities_of(void* memory, int begin, int end, const Where& where, bool warm,
                                         bool recorded) {
  auto* blocks = static_cast<MotionBlock<W>*>(memory);
  const Wide<W> zero(0.0f);
  const Vec3W<W> none{zero, zero, zero};
  for (int n = begin; n < end; ++n) {
    MotionBlock<W>& block = blocks[n];
    MotionW<W> m = where.template load<8>(block, n);
    Vec3W<W> v = m.linear(), w = m.angular();
    Vec3W<W> gain = block.velocity_gain;
    Vec3W<W> twist = none;
    if (block.any_torque != 0) twist = block.world_inverse_inertia * block.torque;
    if (block.any_loss != 0) {
      // Not 0 times v without damping: a lane must not depend on damping in another one, whatever its
      // numbers.
      gain = gain - select<W>(block.linear_loss > zero, block.linear_loss * v, none);
      twist = twist - select<W>(block.angular_loss > zero, block.angular_loss * w, none);
    }
    if (block.carries_rounding != 0) gain = gain + block.lost_gain;
    const Vec3W<W> before = v;
    v = v + gain;
    if (block.carries_rounding != 0) block.lost_gain = gain - (v - before);
    w = w + twist;
    if (block.any_locked != 0) v = along_free_axes<W>(block, v);
    // Adding zero keeps -0 out of the state, so wide kernels may add zeros to lanes that nothing acts on.
    m.set_linear(clamp_without_overflow<W>(v, kMaxSpeed) + none);
    m.set_angular(clamp_without_overflow<W>(w, kMaxSpin) + none);
    if (warm) add_contact_velocities<W>(block, m);
    if (recorded) record<W>(block, m);
    where.template store<6>(block, n, m);
  }
}
template <int W>
void integrate_velocities(void* memory, int begin, int end, BodyMotion* motion, bool warm, bool recorded) {
  integrate_velocities_of<W>(memory, begin, end, InRecords<W>{motion}, warm, recorded);
}
template <int W>
void integrate_velocities_in_lanes(void* memory, int begin, int end, const LaneVelocities& lanes, bool warm,
                                   bool recorded) {
  integrate_velocities_of<W>(memory, begin, end, InLanes<W>{lanes}, warm, recorded);
}

template <int W>
void warm_start_motion(void* memory, int begin, int end, BodyMotion* motion) {
  auto* blocks = static_cast<MotionBlock<W>*>(memory);
  for (int n = begin; n < end; ++n) {
    MotionW<W> m = load_motion<8, W>(blocks[n], motion);
    add_contact_velocities<W>(blocks[n], m);
    record<W>(blocks[n], m);
    store_motion<6, W>(blocks[n], motion, m);
  }
}

template <int W>
void start_contact_change(void* memory, int begin, int end, const BodyMotion* motion) {
  auto* blocks = static_cast<MotionBlock<W>*>(memory);
  for (int n = begin; n < end; ++n) record<W>(blocks[n], load_motion<8, W>(blocks[n], motion));
}
template <int W>
void start_contact_change_in_lanes(void* memory, int begin, int end, const LaneVelocities& lanes) {
  auto* blocks = static_cast<MotionBlock<W>*>(memory);
  for (int n = begin; n < end; ++n) record<W>(blocks[n], InLanes<W>{lanes}.template load<6>(blocks[n], n));
}

// Calls `then` with the number of a block and the values of its records.
template <int W, class Then>
GYRE_INLINE void record_change_of(void* memory, int begin, int end, const BodyMotion* motion,
                                  const Then& then) {
  auto* blocks = static_cast<MotionBlock<W>*>(memory);
  for (int n = begin; n < end; ++n) {
    MotionBlock<W>& block = blocks[n];
    const MotionW<W> m = load_motion<8, W>(block, motion);
    add_gain<W>(block, m);
    record<W>(block, m);
    then(n, m);
  }
}
template <int W>
void add_contact_change(void* memory, int begin, int end, const BodyMotion* motion) {
  record_change_of<W>(memory, begin, end, motion, [](int, const MotionW<W>&) {});
}
template <int W>
void add_contact_change_in_lanes(void* memory, int begin, int end, const BodyMotion* motion,
                                 const LaneVelocities& lanes) {
  const auto* blocks = static_cast<const MotionBlock<W>*>(memory);
  record_change_of<W>(memory, begin, end, motion, [&](int n, const MotionW<W>& m) {
    InLanes<W>{lanes}.template store<6>(blocks[n], n, m);
  });
}

// Writes the pose of some lanes, mostly all, for joints and impacts. Without gyroscopic torque the inertia is
// that of the beginning of the step.
template <int W>
GYRE_INLINE void store_pose(const MotionBlock<W>& block, const QuatW<W>& q, MotionArrays arrays) {
  const Sym3W<W>& i = block.world_inverse_inertia;
  if (block.pose_read == (1u << W) - 1u) {
    const Wide<W> pose[4] = {q.x, q.y, q.z, q.w}, inverse[6] = {i.xx, i.yy, i.zz, i.xy, i.xz, i.yz};
    float* records[W];
    locate_records<W, 4>(&arrays.orientation->x, block.body, records);
    scatter_columns<4, W>(records, 0, pose);
    if (block.any_gyroscopic == 0) return;
    locate_records<W, int(sizeof(BodyInertia) / sizeof(float))>(&arrays.inertia->inverse.xx, block.body,
                                                                records);
    scatter_columns<6, W>(records, 0, inverse);
    return;
  }
  for (int lane = 0; lane < W; ++lane) {
    if ((block.pose_read >> lane & 1u) == 0) continue;
    const std::int32_t body = block.body[lane];
    arrays.orientation[body] = {q.x[lane], q.y[lane], q.z[lane], q.w[lane]};
    if (block.any_gyroscopic == 0) continue;
    arrays.inertia[body].inverse = {i.xx[lane], i.yy[lane], i.zz[lane], i.xy[lane], i.xz[lane], i.yz[lane]};
  }
}

// Rotates over a sub-step; the angular velocity follows from the momentum.
template <int W>
GYRE_INLINE void rotate_block(MotionBlock<W>& block, MotionW<W>& m, MotionArrays arrays, float substep) {
  const Wide<W> zero(0.0f);
  const Wide<W> h(substep);
  const auto gyroscopic = block.gyroscopic > zero;
  const Vec3W<W> w = m.angular();
  Vec3W<W> rotation = h * w;
  if (block.any_gyroscopic != 0) {
    const Vec3W<W> torque = cross(block.world_inertia * w, w);
    const Vec3W<W> middle = w + (0.5f * h) * (block.world_inverse_inertia * torque);
    rotation = select<W>(gyroscopic, h * middle, rotation);
  }
  const Vec3W<W> delta_rotation =
      select<W>(block.rotates > zero, compose_rotations<W>(rotation, m.delta_rotation()), m.delta_rotation());
  m.set_delta_rotation(delta_rotation);
  if (block.any_gyroscopic == 0 && block.pose_read == 0) return;
  const QuatW<W> q = integrate_rotation<W>(block.start, delta_rotation);
  if (block.any_gyroscopic != 0) {
    const Mat3W<W> r = to_matrix<W>(q);
    const Sym3W<W> next = rotate_inertia<W>(r, block.inertia);
    const Sym3W<W> next_inverse = rotate_inertia<W>(r, block.inverse_inertia);
    const Sym3W<W> inertia_loss{block.world_inertia.xx - next.xx, block.world_inertia.yy - next.yy,
                                block.world_inertia.zz - next.zz, block.world_inertia.xy - next.xy,
                                block.world_inertia.xz - next.xz, block.world_inertia.yz - next.yz};
    const Vec3W<W> change = next_inverse * (inertia_loss * w);
    m.set_angular(select<W>(gyroscopic, w + change, w));
    block.world_inertia = next;
    // Without gyroscopic torque the inverse inertia stays.
    block.world_inverse_inertia = {select(gyroscopic, next_inverse.xx, block.world_inverse_inertia.xx),
                                   select(gyroscopic, next_inverse.yy, block.world_inverse_inertia.yy),
                                   select(gyroscopic, next_inverse.zz, block.world_inverse_inertia.zz),
                                   select(gyroscopic, next_inverse.xy, block.world_inverse_inertia.xy),
                                   select(gyroscopic, next_inverse.xz, block.world_inverse_inertia.xz),
                                   select(gyroscopic, next_inverse.yz, block.world_inverse_inertia.yz)};
  }
  if (block.pose_read != 0) store_pose<W>(block, q, arrays);
}

// True if nothing moves or has moved since the step began, to the bit.
template <int W>
GYRE_INLINE bool is_at_rest(const MotionW<W>& m) {
  WideInt<W> bits(0);
  for (int i = kMotionLinear; i < kMotionLinear + 6; ++i) bits = bits | bit_pattern(m.record[i]);
  for (int i = kMotionDeltaPosition; i < kMotionDeltaPosition + 6; ++i)
    bits = bits | bit_pattern(m.record[i]);
  return none(bits != WideInt<W>(0));
}

template <int W, class Where>
GYRE_INLINE void integrate_positions_of(void* memory, int begin, int end, MotionArrays arrays,
                                        const Where& where, float substep, bool recorded) {
  auto* blocks = static_cast<MotionBlock<W>*>(memory);
  const Wide<W> zero(0.0f);
  const Vec3W<W> none{zero, zero, zero};
  for (int n = begin; n < end; ++n) {
    MotionBlock<W>& block = blocks[n];
    MotionW<W> m = where.template load<16>(block, n);
    const bool resting = is_at_rest<W>(m);
    if (block.any_locked != 0) m.set_linear(along_free_axes<W>(block, m.linear()));
    if (recorded) add_gain<W>(block, m);
    // At rest all that follows would give the values that are there already.
    if (resting && block.was_at_rest != 0) continue;
    block.was_at_rest = resting ? 1 : 0;
    m.set_delta_position(m.delta_position() + Wide<W>(substep) * m.linear());
    rotate_block<W>(block, m, arrays, substep);
    m.set_angular(m.angular() + none);
    where.template store<14>(block, n, m);
  }
}
template <int W>
void integrate_positions(void* memory, int begin, int end, MotionArrays arrays, float substep,
                         bool recorded) {
  integrate_positions_of<W>(memory, begin, end, arrays, InRecords<W>{arrays.motion}, substep, recorded);
}
template <int W>
void integrate_positions_in_lanes(void* memory, int begin, int end, MotionArrays arrays,
                                  const LaneVelocities& lanes, float substep) {
  integrate_positions_of<W>(memory, begin, end, arrays, InLanes<W>{lanes, arrays.motion}, substep, false);
}

template <int W>
void begin_projection(void* memory, int begin, int end, BodyMotion* motion) {
  auto* blocks = static_cast<MotionBlock<W>*>(memory);
  for (int n = begin; n < end; ++n) {
    MotionW<W> m = load_motion<8, W>(blocks[n], motion);
    record<W>(blocks[n], m);
    for (int i = 0; i < 6; ++i) m.record[i] = Wide<W>(0.0f);
    store_motion<6, W>(blocks[n], motion, m);
  }
}

template <int W>
void end_projection(void* memory, int begin, int end, BodyMotion* motion, Vec3* rotations) {
  auto* blocks = static_cast<MotionBlock<W>*>(memory);
  const Wide<W> zero(0.0f);
  for (int n = begin; n < end; ++n) {
    const MotionBlock<W>& block = blocks[n];
    MotionW<W> m = load_motion<16, W>(block, motion);
    Vec3W<W> displacement = m.linear();
    const Vec3W<W> rotation = m.angular();
    if (block.any_locked != 0) displacement = along_free_axes<W>(block, displacement);
    m.set_delta_position(m.delta_position() + displacement);
    m.set_delta_rotation(select<W>(block.rotates > zero, compose_rotations<W>(rotation, m.delta_rotation()),
                                   m.delta_rotation()));
    m.set_linear(block.recorded_linear);
    m.set_angular(block.recorded_angular);
    m.record[kMotionPushout] = length(displacement) + block.bounding_radius * length(rotation);
    store_motion<14, W>(block, motion, m);
    for (int lane = 0; lane < W; ++lane) {
      if (block.body[lane] != kNoBody)
        rotations[n * W + lane] = {rotation.x[lane], rotation.y[lane], rotation.z[lane]};
    }
  }
}

// The table that a kernel file exports.
template <int W>
constexpr MotionKernels motion_kernels() {
  MotionKernels kernels{};
  kernels.block_bytes = sizeof(MotionBlock<W>);
  kernels.prepare = prepare_motion<W>;
  kernels.integrate_velocities = integrate_velocities<W>;
  kernels.warm_start = warm_start_motion<W>;
  kernels.start_contact_change = start_contact_change<W>;
  kernels.add_contact_change = add_contact_change<W>;
  kernels.integrate_positions = integrate_positions<W>;
  kernels.begin_projection = begin_projection<W>;
  kernels.end_projection = end_projection<W>;
  if constexpr (W >= 8) {
    kernels.integrate_velocities_in_lanes = integrate_velocities_in_lanes<W>;
    kernels.start_contact_change_in_lanes = start_contact_change_in_lanes<W>;
    kernels.add_contact_change_in_lanes = add_contact_change_in_lanes<W>;
    kernels.integrate_positions_in_lanes = integrate_positions_in_lanes<W>;
  }
  return kernels;
}

}  // namespace GYRE_TARGET_NAMESPACE
}  // namespace gyre
