// The limits of a bundle of articulations (solver/articulation/articulation_lanes.h), solved with the
// equations: solver/articulation/articulation_limits.h with a lane for each articulation. A lane takes part
// only with limits that are active in itself, in the order of the joints, and stops once its own impulses
// have converged, so its neighbours change no bit of it.
#pragma once

#include "solver/articulation/articulation_limit_rows.h"
#include "solver/articulation/articulation_prepare.h"

namespace gyre {
inline namespace GYRE_TARGET_NAMESPACE {

// As in solver/articulation/articulation_limits.cpp.
constexpr float kLaneSpeedTolerance = 1.0e-4f;  // rad/s
constexpr int kLaneRounds = 3, kLaneIterations = 100;

// Smaller changes of speed end the iteration.
constexpr float kLaneTolerance = 1.0e-4f;  // rad/s

// Relaxation factor (successive over-relaxation).
constexpr float kLaneRelaxation = 1.15f;

// Largest rotation of a joint, or of the axis of its limit, for which Delassus entries stay cached.
constexpr float kMaxCachedRotation = 0.1f;  // rad

// Smallest effective inverse mass of a limit, relative to its two bodies alone. Below it there is only
// rounding, and the equations hold the limit.
constexpr float kMinInverseMassShare = 1.0e-5f;

// With the equations' matrix as L D L^T, the Delassus entry of limits i and j is the one without equations
// minus y_i . D^-1 y_j, where L y is the effect of the impulse on the rows. Elimination reaches few rows from
// one limit, and the result is valid until joints are prepared anew: three solves share it. The answer of the
// equations is found once for all impulses together.
template <int W>
class LimitSolver {
 public:
  GYRE_INLINE LimitSolver(const WideBundle<W>& bundle, const LaneSettings& settings, ErrorBounds bounds,
                          Mask<W> kept = Mask<W>::splat(false))
      : b_(bundle),
        s_(settings),
        bounds_(bounds),
        kept_(kept),
        limits_(reinterpret_cast<WideLimit<W>*>(bundle.plain.limits)),
        responses_(reinterpret_cast<float*>(limits_ + count())),
        // Before floats whose number may be odd.
        reached_(reinterpret_cast<std::uint64_t*>(responses_ +
                                                  2 * std::size_t(count()) * bundle.plain.row_count * W)),
        matrix_(reinterpret_cast<Wide<W>*>(reached_ + all_reach_words(bundle.plain))),
        poses_(reinterpret_cast<QuatW<W>*>(matrix_ + std::size_t(count()) * count())),
        spins_(reinterpret_cast<Vec3W<W>*>(poses_ + bundle.plain.node_count)),
        layout_(reinterpret_cast<LimitDelassus<W>*>(spins_ + bundle.plain.moving_count)),
        slots_(reinterpret_cast<LimitSlot<W>*>(layout_ + 1)),
        slot_delassus_(reinterpret_cast<Wide<W>*>(slots_ + row_length())),
        computed_(reinterpret_cast<std::uint32_t*>(slot_delassus_ + row_length() * row_length())),
        ends_(reinterpret_cast<std::uint8_t*>(computed_ + std::size_t(count()) * count())),
        layout_ends_(ends_ + row_length() * W) {}

  // Before the first half step of a step: nothing is cached.
  GYRE_INLINE void clear() {
    std::uint32_t next = 0;
    for (std::uint32_t n = 0; n < b_.plain.node_count; ++n) {
      const LaneNode& node = b_.plain.nodes[n];
      if (node.has_twist) list(limits_[next++], node, b_.joints[n].twist, true);
      if (node.has_swing) list(limits_[next++], node, b_.joints[n].swing, false);
    }
    if (b_.plain.servo_count > 0) list_servos(next);
    const Wide<W> none(0.0f);
    for (std::uint32_t n = 0; n < b_.plain.node_count; ++n) poses_[n] = {none, none, none, none};
    for (std::uint32_t& laid : layout_->counts) laid = 0;
    layout_->renewed = layout_->cleared = 0;
  }

  // After the joints have been prepared.
  GYRE_INLINE void begin() {
    const std::uint32_t unchanged = to_bits(find_barely_rotated());
    for (std::uint32_t a = 0; a < count(); ++a) {
      limits_[a].cached &= unchanged;
      if (limits_[a].cached != 0) limits_[a].cached &= to_bits(has_same_axis(limits_[a]));
      limits_[a].has_response = false;
      limits_[a].has_spins = false;
    }
    const std::size_t pairs = std::size_t(count()) * count();
    for (std::size_t i = 0; i < pairs; ++i) computed_[i] = 0;
  }

  GYRE_INLINE void solve(Mask<W> lanes) {
    for (std::uint32_t a = 0; a < end_count(); ++a) compute_bias(limits_[a]);
    for (std::uint32_t a = end_count(); a < count(); ++a) compute_servo_bias(limits_[a]);
    for (int round = 0; round < kLaneRounds; ++round) {
      const Mask<W> live = find_active(round == 0) & lanes;
      if (none(live)) return;
      find(live);
      apply();
    }
  }

 private:
  GYRE_INLINE std::uint32_t count() const { return b_.plain.limit_count; }
  GYRE_INLINE std::uint32_t end_count() const { return count() - b_.plain.servo_count; }
  GYRE_INLINE const WideServo<W>& servo_of(const WideLimit<W>& limit) const {
    return b_.servos[limit.node->servo];
  }
  void list_servos(std::uint32_t next) {
    for (std::uint32_t n = 0; n < b_.plain.node_count; ++n) {
      const LaneNode& node = b_.plain.nodes[n];
      if (node.has_servo) list(limits_[next++], node, b_.servos[node.servo].axis, true);
    }
  }
  GYRE_INLINE std::uint32_t words() const { return reach_words(b_.plain.column_count); }
  GYRE_INLINE static void list(WideLimit<W>& limit, const LaneNode& node, WideLimitAxis<W>& axis,
                               bool has_low) {
    limit.axis = &axis, limit.node = &node;
    limit.has_low = has_low, limit.has_reach = false, limit.cached = 0;
  }
  GYRE_INLINE void compute_bias(WideLimit<W>& limit) const {
    limit.low_on = limit.high_on = Mask<W>::splat(false);
    if (limit.has_low) limit.low_bias = bias_of(limit.axis->low_gap);
    limit.high_bias = bias_of(limit.axis->high_gap);
  }
  GYRE_INLINE void compute_servo_bias(WideLimit<W>& limit) const {
    const WideServo<W>& servo = servo_of(limit);
    limit.low_on = limit.high_on = Mask<W>::splat(false);
    limit.low_bias = servo.target_speed - servo.rate * servo.axis.low_gap;
    if (!limit.node->has_twist) return;
    // A motor targets no speed that its own limits forbid: both would grow against each other without end.
    const WideLimitAxis<W>& own = b_.joints[limit.node - b_.plain.nodes].twist;
    const Wide<W> low = bias_of(own.low_gap), high = Wide<W>(0.0f) - bias_of(own.high_gap);
    limit.low_bias = max(min(limit.low_bias, high), low);
  }
  GYRE_INLINE Wide<W> bias_of(Wide<W> gap) const {
    const Wide<W> rate = select(gap > 0.0f, Wide<W>(1.0f / s_.substep), Wide<W>(s_.rate));
    return Wide<W>(0.0f) - rate * max(max(gap, Wide<W>(-bounds_.rotation)), Wide<W>(-kMaxLimitError));
  }

  GYRE_INLINE void find(Mask<W> live) {
    for (std::uint32_t a = 0; a < count(); ++a) {
      WideLimit<W>& limit = limits_[a];
      limit.active = to_bits((limit.low_on | limit.high_on) & live);
      if (limit.active != 0 && !limit.has_spins) find_spins(limit);
    }
    compute_delassus();
    find_impulses(live);
  }
  // Finds the limits that are violated or have an impulse; returns the lanes with work to do.
  GYRE_INLINE Mask<W> find_active(bool first) {
    Mask<W> live = Mask<W>::splat(false);
    for (std::uint32_t a = 0; a < end_count(); ++a) {
      WideLimit<W>& limit = limits_[a];
      const WideLimitAxis<W>& axis = *limit.axis;
      limit.speed = dot(axis.about, b_.bodies[limit.node->b].angular - b_.bodies[limit.node->a].angular);
      // Axes that cannot rotate have no limits.
      const Mask<W> is_rotatable = axis.mass > 0.0f;
      const auto consider = [&](Wide<W> speed, Wide<W> impulse, Mask<W>& on) {
        const Mask<W> bears = impulse > 0.0f, passed = speed < -kLaneSpeedTolerance;
        const Mask<W> now = is_rotatable & (bears | passed);
        live = live | (first ? now & (passed | (bears & (speed > kLaneSpeedTolerance))) : and_not(now, on));
        on = on | now;
      };
      if (limit.has_low) consider(limit.speed - limit.low_bias, axis.low_impulse, limit.low_on);
      consider(Wide<W>(0.0f) - limit.speed - limit.high_bias, axis.high_impulse, limit.high_on);
    }
    for (std::uint32_t a = end_count(); a < count(); ++a) live = live | find_active_servo(limits_[a], first);
    return live;
  }
  // Without tolerance: the remaining error would be added in each half step until it is large.
  Mask<W> find_active_servo(WideLimit<W>& limit, bool first) const {
    const WideServo<W>& servo = servo_of(limit);
    const WideLimitAxis<W>& axis = servo.axis;
    limit.speed = dot(axis.about, b_.bodies[limit.node->b].angular - b_.bodies[limit.node->a].angular);
    const Wide<W> off = limit.speed - limit.low_bias, zero(0.0f), impulse = axis.low_impulse;
    const Mask<W> is_rotatable = and_not(axis.mass > zero, kept_),
                  more = impulse<servo.max_impulse, less = impulse> zero - servo.max_impulse;
    const Mask<W> misses = is_rotatable & (((off < zero) & more) | ((off > zero) & less));
    const Mask<W> live = first ? misses : and_not(misses, limit.low_on);
    limit.low_on = limit.low_on | misses | (is_rotatable & (impulse != zero));
    return live;
  }

  // --------------------------------------------------------------------------------------------- response

  GYRE_INLINE float* response_of(std::uint32_t a) const {
    return responses_ + 2 * std::size_t(a) * b_.plain.row_count * W;
  }
  GYRE_INLINE float* scaled_of(std::uint32_t a) const {
    return response_of(a) + std::size_t(b_.plain.row_count) * W;
  }
  GYRE_INLINE ReachedColumns reached_of(std::uint32_t a) const { return reached_ + std::size_t(a) * words(); }
  GYRE_INLINE Wide<W>& entry(std::uint32_t row, std::uint32_t column) const {
    return matrix_[std::size_t(row) * count() + column];
  }
  GYRE_INLINE static Vec3W<W> nothing() { return {Wide<W>(0.0f), Wide<W>(0.0f), Wide<W>(0.0f)}; }

  GYRE_INLINE static bool share_body(const LaneNode& node, const LaneNode& other) {
    return other.a == node.a || other.a == node.b || other.b == node.a || other.b == node.b;
  }
  // Lanes in which no joint has rotated far since the cached entries were computed; records the present poses
  // of others.
  Mask<W> find_barely_rotated() const {
    // the cosine of half of that
    constexpr float kMinCosine = 1.0f - 0.125f * kMaxCachedRotation * kMaxCachedRotation;
    Mask<W> unchanged = Mask<W>::splat(true);
    for (std::uint32_t i = 0; i < b_.plain.moving_count; ++i) {
      const Sym3W<W>&now = b_.bodies[i].inverse, &own = b_.bodies[i].own_inverse;
      unchanged = unchanged & (now.xx == own.xx) & (now.yy == own.yy) & (now.zz == own.zz);
    }
    const Mask<W> stiffened = ~unchanged;
    const auto pose_of = [&](std::uint32_t n) {
      const LaneNode& node = b_.plain.nodes[n];
      return conjugate(b_.bodies[node.a].orientation) * b_.bodies[node.b].orientation;
    };
    for (std::uint32_t n = 0; n < b_.plain.node_count; ++n) {
      const QuatW<W> now = pose_of(n), then = poses_[n];
      unchanged =
          unchanged & (now.x * then.x + now.y * then.y + now.z * then.z + now.w * then.w > kMinCosine);
    }
    if (!any(~unchanged)) return unchanged;
    const Wide<W> none(0.0f);
    const QuatW<W> nowhere{none, none, none, none};  // with geometric stiffness nothing is cached
    for (std::uint32_t n = 0; n < b_.plain.node_count; ++n)
      poses_[n] = select(unchanged, poses_[n], select(stiffened, nowhere, pose_of(n)));
    return unchanged;
  }

  // In the axes of the joint's first body.
  GYRE_INLINE Vec3W<W> axis_of(const WideLimit<W>& limit) const {
    return rotate_inverse(b_.bodies[limit.node->a].orientation, limit.axis->about);
  }
  // Where a limb points straight back, the axis of a cone's nearest limit jumps to the other side.
  GYRE_INLINE Mask<W> has_same_axis(const WideLimit<W>& limit) const {
    return length_squared(axis_of(limit) - limit.cached_axis) <
           (kMaxCachedRotation * kMaxCachedRotation) * length_squared(limit.cached_axis);
  }

  GYRE_INLINE void find_spins(WideLimit<W>& limit) const {
    limit.has_spins = true;
    const LaneNode& node = *limit.node;
    const Vec3W<W> about = limit.axis->about;
    limit.spin_a = b_.moves(node.a) ? -(b_.bodies[node.a].inverse * about) : nothing();
    limit.spin_b = b_.moves(node.b) ? b_.bodies[node.b].inverse * about : nothing();
  }
  GYRE_INLINE static Vec3W<W> spin_of(const WideLimit<W>& limit, std::uint32_t body) {
    return body == limit.node->a ? limit.spin_a : body == limit.node->b ? limit.spin_b : nothing();
  }

  // The violation of a joint's rows by spins of its bodies.
  GYRE_INLINE void set_missing(float* vector, std::uint32_t n, Vec3W<W> spin_a, Vec3W<W> spin_b) const {
    const LaneNode& node = b_.plain.nodes[n];
    const WideJoint<W>& joint = b_.joints[n];
    const Vec3W<W> missing = cross(spin_a, joint.from_a) - cross(spin_b, joint.from_b);
    b_.set_row(vector, node.row, missing.x);
    b_.set_row(vector, node.row + 1, missing.y);
    b_.set_row(vector, node.row + 2, missing.z);
    if (node.kind != JointKind::hinge) return;
    b_.set_row(vector, node.row + 3, dot(spin_a - spin_b, joint.perpendicular_1));
    b_.set_row(vector, node.row + 4, dot(spin_a - spin_b, joint.perpendicular_2));
  }

  // Finds the columns that an impulse at a limit reaches: those of joints that share a body with it, and
  // those that elimination adds.
  void find_reach(std::uint32_t index) {
    WideLimit<W>& limit = limits_[index];
    limit.has_reach = true;
    const ReachedColumns reached = reached_of(index);
    for (std::uint32_t i = 0; i < words(); ++i) reached[i] = 0;
    for (std::uint32_t n = 0; n < b_.plain.node_count; ++n) {
      const LaneNode& node = b_.plain.nodes[n];
      if (share_body(*limit.node, node)) reached[node.column / 64] |= std::uint64_t{1} << node.column % 64;
    }
    reach_columns(b_.plain, reached);
  }
  void find_response(std::uint32_t index) {
    WideLimit<W>& limit = limits_[index];
    if (limit.has_response) return;
    limit.has_response = true;
    factor_bundle(b_);
    if (!limit.has_spins) find_spins(limit);
    if (!limit.has_reach) find_reach(index);
    float* const response = response_of(index);
    clear_reached<W>(b_.plain, reached_of(index), response);
    for (std::uint32_t n = 0; n < b_.plain.node_count; ++n) {
      const LaneNode& node = b_.plain.nodes[n];
      if (share_body(*limit.node, node))
        set_missing(response, n, spin_of(limit, node.a), spin_of(limit, node.b));
    }
    solve_reached_down<W>(b_.plain, reached_of(index), response, scaled_of(index));
  }
  // Computes Delassus entries between all active limits, in lanes where one of them is not cached.
  void compute_delassus() {
    std::uint32_t lanes = 0;
    for (std::uint32_t a = 0; a < count(); ++a) lanes |= limits_[a].active & ~limits_[a].cached;
    if (lanes == 0) return;
    layout_->renewed |= lanes;
    std::uint32_t listed[kMaxLaneLimits], used = 0;
    for (std::uint32_t a = 0; a < count(); ++a) {
      limits_[a].cached |= limits_[a].active & lanes;
      if ((limits_[a].cached & lanes) == 0) continue;
      limits_[a].cached_axis = select(Mask<W>::of_bits(lanes), axis_of(limits_[a]), limits_[a].cached_axis);
      listed[used++] = a;
    }
    for (std::uint32_t i = 0; i < used; ++i)
      for (std::uint32_t j = 0; j <= i; ++j) compute_delassus_entry(listed[i], listed[j], lanes);
  }
  // The Delassus entry of two limits, in those of `lanes` that need it.
  void compute_delassus_entry(std::uint32_t a, std::uint32_t b, std::uint32_t lanes) {
    std::uint32_t& found = computed_[std::size_t(a) * count() + b];
    lanes &= limits_[a].cached & limits_[b].cached & ~found;
    if (lanes == 0) return;
    found |= lanes;
    find_response(a);
    find_response(b);
    const LaneNode &pushed = *limits_[a].node, &node = *limits_[b].node;
    Wide<W> alone(0.0f);
    if (share_body(pushed, node))
      alone = dot(limits_[b].axis->about, spin_of(limits_[a], node.b) - spin_of(limits_[a], node.a));
    const Wide<W> entry_value =
        alone - dot_reached<W>(b_.plain, reached_of(a), scaled_of(a), reached_of(b), response_of(b));
    const Wide<W> bounded =
        a == b ? keep(entry_value > kMinInverseMassShare * alone, entry_value) : entry_value;
    entry(a, b) = entry(b, a) = select(Mask<W>::of_bits(lanes), bounded, entry(a, b));
  }

  // ------------------------------------------------------------------------------------------------------ impulses

  // The ends of active limits of each lane stand in the first slots, in their order: a lane has few of all
  // active limits. An end is twice the limit's number, plus one at the high end.
  std::uint32_t list_ends(Mask<W> live, std::uint32_t (&counts)[W]) {
    for (std::uint32_t& n : counts) n = 0;
    std::uint32_t largest = 0;
    const auto list = [&](Mask<W> on, std::uint32_t end) {
      for (std::uint32_t bits = to_bits(on & live); bits != 0; bits &= bits - 1) {
        const std::uint32_t lane = std::uint32_t(__builtin_ctz(bits));
        ends_[counts[lane]++ * W + lane] = std::uint8_t(end);
        if (counts[lane] > largest) largest = counts[lane];
      }
    };
    const auto list_limit = [&](std::uint32_t a) {
      WideLimit<W>& limit = limits_[a];
      if (limit.active == 0) return;
      limit.low_x = limit.high_x = Wide<W>(0.0f);
      if (limit.has_low) list(limit.low_on, 2 * a);
      list(limit.high_on, 2 * a + 1);
    };
    // Limits come last in an iteration.
    for (std::uint32_t a = end_count(); a < count(); ++a) list_limit(a);
    for (std::uint32_t a = 0; a < end_count(); ++a) list_limit(a);
    return largest;
  }
  GYRE_INLINE static float lane_of(const Wide<W>& from, std::uint32_t lane) {
    return reinterpret_cast<const float*>(&from)[lane];
  }
  GYRE_INLINE static void set_lane(Wide<W>& to, std::uint32_t lane, float value) {
    reinterpret_cast<float*>(&to)[lane] = value;
  }
  GYRE_INLINE std::size_t row_length() const { return max_slots<W>(b_.plain); }
  GYRE_INLINE bool is_laid_out(std::uint32_t lane, std::uint32_t count) const {
    if (count != layout_->counts[lane] || (layout_->renewed >> lane & 1u) != 0) return false;
    for (std::uint32_t i = 0; i < count; ++i)
      if (ends_[i * W + lane] != layout_ends_[i * W + lane]) return false;
    return true;
  }
  void lay_out_delassus(std::uint32_t lane, std::uint32_t count) {
    const std::uint32_t laid = layout_->counts[lane];
    const auto set = [&](std::uint32_t i, std::uint32_t j, float value) {
      set_lane(slot_delassus_[i * row_length() + j], lane, value);
      set_lane(slot_delassus_[j * row_length() + i], lane, value);
    };
    for (std::uint32_t i = 0; i < count; ++i) {
      const std::uint32_t end = layout_ends_[i * W + lane] = ends_[i * W + lane];
      for (std::uint32_t j = 0; j <= i; ++j) {
        const std::uint32_t other = ends_[j * W + lane];
        float size = lane_of(entry(end / 2, other / 2), lane);
        if (i == j && end / 2 >= end_count()) size *= 1.0f + kMotorCompliance;
        set(i, j, ((end ^ other) & 1u) != 0 ? -size : size);
      }
    }
    for (std::uint32_t i = count; i < laid; ++i)
      for (std::uint32_t j = 0; j <= i; ++j) set(i, j, 0.0f);
    layout_->counts[lane] = count;
    layout_->renewed &= ~(1u << lane);
  }
  void clear_delassus(std::uint32_t slots) {
    const std::uint32_t before = layout_->cleared, now = slots < kRegisterSlots ? kRegisterSlots : slots;
    if (now <= before) return;
    for (std::uint32_t i = 0; i < now; ++i)
      for (std::uint32_t j = i < before ? before : 0; j < now; ++j)
        slot_delassus_[i * row_length() + j] = Wide<W>(0.0f);
    layout_->cleared = now;
  }
  void fill_slots(std::uint32_t slots, const std::uint32_t (&counts)[W]) {
    const Wide<W> none(0.0f);
    for (std::uint32_t i = 0; i < slots || i < kRegisterSlots; ++i)
      slots_[i].excess = slots_[i].share = slots_[i].min_impulse = slots_[i].room = none;
    clear_delassus(slots);
    for (std::uint32_t lane = 0; lane < W; ++lane) {
      if (counts[lane] != 0 && !is_laid_out(lane, counts[lane])) lay_out_delassus(lane, counts[lane]);
      for (std::uint32_t i = 0; i < counts[lane]; ++i) {
        const std::uint32_t end = ends_[i * W + lane];
        const WideLimit<W>& limit = limits_[end / 2];
        const bool is_high = (end & 1u) != 0;
        const float speed = lane_of(limit.speed, lane);
        const float bias = lane_of(is_high ? limit.high_bias : limit.low_bias, lane);
        const float min_impulse =
            -lane_of(is_high ? limit.axis->high_impulse : limit.axis->low_impulse, lane);
        set_lane(slots_[i].excess, lane, (is_high ? -speed : speed) - bias);
        set_lane(slots_[i].min_impulse, lane, min_impulse);
        set_lane(slots_[i].room, lane, min_impulse);
        if (end / 2 >= end_count()) bound_servo(slots_[i], servo_of(limit), entry(end / 2, end / 2), lane);
      }
    }
  }
  // The impulse of a motor has either sign and a bound, and the motor is compliant.
  static void bound_servo(LimitSlot<W>& slot, const WideServo<W>& servo, const Wide<W>& diagonal,
                          std::uint32_t lane) {
    const float impulse = lane_of(servo.axis.low_impulse, lane),
                max_impulse = lane_of(servo.max_impulse, lane);
    set_lane(slot.excess, lane,
             lane_of(slot.excess, lane) + kMotorCompliance * lane_of(diagonal, lane) * impulse);
    set_lane(slot.min_impulse, lane, -max_impulse - impulse);
    set_lane(slot.max_impulse, lane, max_impulse - impulse);
  }

  // The step of the impulse of a slot; `largest`: the largest change of a speed.
  template <bool kServos>
  GYRE_INLINE static Wide<W> step_of(LimitSlot<W>& slot, Wide<W> excess, Wide<W> own, Mask<W> live,
                                     Wide<W>& largest) {
    Wide<W> by = slot.share * excess;
    if constexpr (kServos) {
      const Wide<W> now = min(max(slot.room + by, slot.min_impulse), slot.max_impulse);
      by = keep(live, now - slot.room);
      slot.room += by;
    } else {
      by = keep(live, max(slot.room, by));
      slot.room -= by;
    }
    largest = max(largest, max(by, Wide<W>(0.0f) - by) * own);
    return by;
  }
  void iterate_few(std::uint32_t slots, Mask<W> live) const {
    Wide<W> excess[kRegisterSlots];
    GYRE_UNROLL
    for (std::uint32_t e = 0; e < kRegisterSlots; ++e) excess[e] = slots_[e].excess;
    for (int iteration = 0; iteration < kLaneIterations && any(live); ++iteration) {
      Wide<W> largest(0.0f);
      GYRE_UNROLL
      for (std::uint32_t i = 0; i < kRegisterSlots; ++i) {
        if (i < slots) {
          const Wide<W>* const row = slot_delassus_ + i * row_length();
          const Wide<W> by = step_of<false>(slots_[i], excess[i], row[i], live, largest);
          GYRE_UNROLL
          for (std::uint32_t e = 0; e < kRegisterSlots; ++e) excess[e] += by * row[e];
        }
      }
      live = live & (largest > kLaneTolerance);
    }
  }
  template <bool kServos>
  void iterate_many(std::uint32_t slots, Mask<W> live) const {
    // The next slot also in a register, because each step waits for it.
    Wide<W> excess = slots_[0].excess;
    for (int iteration = 0; iteration < kLaneIterations && any(live); ++iteration) {
      Wide<W> largest(0.0f);
      for (std::uint32_t i = 0; i < slots; ++i) {
        const Wide<W>* const row = slot_delassus_ + i * row_length();
        const Wide<W> by = step_of<kServos>(slots_[i], excess, row[i], live, largest);
        const std::uint32_t next = i + 1 < slots ? i + 1 : 0;
        excess = slots_[next].excess + by * row[next];
        for (std::uint32_t e = 0; e < slots; ++e) slots_[e].excess += by * row[e];
      }
      live = live & (largest > kLaneTolerance);
    }
  }

  // Projected Gauss-Seidel over the active limits, in each lane until its impulses converge.
  void find_impulses(Mask<W> live) {
    std::uint32_t counts[W];
    const std::uint32_t slots = list_ends(live, counts);
    const bool has_servos = b_.plain.servo_count > 0;
    // Only servos have an upper bound.
    if (has_servos)
      for (std::uint32_t i = 0; i < slots; ++i) slots_[i].max_impulse = Wide<W>(kMaxLimitImpulse);
    fill_slots(slots, counts);
    if (has_servos)
      for (std::uint32_t i = 0; i < slots; ++i) slots_[i].room = Wide<W>(0.0f);
    for (std::uint32_t i = 0; i < slots; ++i) {
      const Wide<W> own = slot_delassus_[i * row_length() + i];
      slots_[i].share = keep(own > 0.0f, -kLaneRelaxation / own);
    }
    // A single lane has no use for the registers, and the code for few slots is long.
    if (has_servos)
      iterate_many<true>(slots, live);
    else if (W > 1 && slots <= kRegisterSlots)
      iterate_few(slots, live);
    else
      iterate_many<false>(slots, live);
    for (std::uint32_t lane = 0; lane < W; ++lane) {
      for (std::uint32_t i = 0; i < counts[lane]; ++i) {
        const std::uint32_t end = ends_[i * W + lane];
        WideLimit<W>& limit = limits_[end / 2];
        set_lane((end & 1u) != 0 ? limit.high_x : limit.low_x, lane,
                 has_servos ? lane_of(slots_[i].room, lane)
                            : lane_of(slots_[i].min_impulse, lane) - lane_of(slots_[i].room, lane));
      }
    }
  }

  // Applies the impulses and the answer of the equations to all of them.
  void apply() {
    for (std::uint32_t i = 0; i < b_.plain.moving_count; ++i) spins_[i] = nothing();
    Mask<W> applied = Mask<W>::splat(false);
    for (std::uint32_t a = 0; a < count(); ++a) {
      WideLimit<W>& limit = limits_[a];
      if (limit.active == 0) continue;
      const Wide<W> x = limit.low_x - limit.high_x;
      // In active lanes only, as add_in_lanes().
      const Wide<W> before = limit.axis->low_impulse, sum = before + limit.low_x,
                    low = a >= end_count() ? sum : max(sum, Wide<W>(0.0f));
      limit.axis->low_impulse = select(Mask<W>::of_bits(limit.active), low, before);
      limit.axis->high_impulse = max(limit.axis->high_impulse + limit.high_x, Wide<W>(0.0f));
      const Mask<W> own = x != 0.0f;
      if (none(own)) continue;
      applied = applied | own;
      const LaneNode& node = *limit.node;
      if (b_.moves(node.a)) spins_[node.a] += x * limit.spin_a;
      if (b_.moves(node.b)) spins_[node.b] += x * limit.spin_b;
    }
    if (none(applied)) return;
    for (std::uint32_t i = 0; i < b_.plain.moving_count; ++i)
      b_.bodies[i].angular += keep(applied, spins_[i]);
    factor_bundle(b_);
    for (std::uint32_t n = 0; n < b_.plain.node_count; ++n) {
      const LaneNode& node = b_.plain.nodes[n];
      set_missing(b_.plain.vector, n, b_.moves(node.a) ? spins_[node.a] : nothing(),
                  b_.moves(node.b) ? spins_[node.b] : nothing());
    }
    solve_lanes<W>(b_.plain);
    for (std::uint32_t n = 0; n < b_.plain.node_count; ++n) answer(n, applied);
  }
  GYRE_INLINE void answer(std::uint32_t n, Mask<W> applied) const {
    const LaneNode& node = b_.plain.nodes[n];
    WideJoint<W>& joint = b_.joints[n];
    const Vec3W<W> p = keep(applied, b_.rows3(node.row));
    Vec3W<W> t = nothing();
    if (node.kind == JointKind::hinge) {
      t = keep(applied,
               b_.row(node.row + 3) * joint.perpendicular_1 + b_.row(node.row + 4) * joint.perpendicular_2);
      add_in_lanes<W>(joint.angular_impulse, t, applied);
    }
    apply_joint_impulse(b_, node, joint, p, t);
    add_in_lanes<W>(joint.linear_impulse, p, applied);
  }

  const WideBundle<W>& b_;
  const LaneSettings& s_;
  ErrorBounds bounds_;
  Mask<W> kept_;  // lanes whose servos keep their impulses
  WideLimit<W>* limits_;
  float* responses_;        // y and D^-1 y, by limit
  std::uint64_t* reached_;  // by limit: its columns
  Wide<W>* matrix_;
  QuatW<W>* poses_;  // of b in a's frame, by joint: as the entries were cached
  Vec3W<W>* spins_;
  LimitDelassus<W>* layout_;
  LimitSlot<W>* slots_;
  Wide<W>* slot_delassus_;  // by two slots
  // By two limits, the later first: lanes whose entry was computed in this half step.
  std::uint32_t* computed_;
  std::uint8_t* ends_;         // by slot and lane
  std::uint8_t* layout_ends_;  // ends of the layout of Delassus entries
};

}  // namespace GYRE_TARGET_NAMESPACE
}  // namespace gyre
