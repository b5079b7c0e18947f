// Fills contact blocks from manifolds at the beginning of a step, and stores impulses at its end. Part of the
// kernels (one template for every width), apart from contact_kernel.h because it runs once a step. Records
// are read and written four floats at a time, W records side by side (math/wide_vec.h: Rows).
#pragma once

#include "geometry/manifold/manifold_layout.h"
#include "solver/contact/contact_kernel.h"
#include "solver/contact/contact_normal_rows.h"
#include "solver/core/error_bounds.h"

#include <cstddef>

namespace gyre {
inline namespace GYRE_TARGET_NAMESPACE {

// Share of the lower body's mobility that pushout removes where a contact faces straight up.
constexpr float kLowerShare = 0.7f;
// Bounds of the time over which the mean impulse of a point averages (s): the age of the load, at least the
// first, at most the second.
constexpr float kShortestMean = 0.5f;
constexpr float kLongestMean = 1.0f;

// A patch narrower than this share of the size has no spinning friction.
constexpr float kMinPatch = 1.0e-3f;
// Friction coefficients are bounded by this, because their inverse must not vanish.
constexpr float kMaxFriction = 1.0e6f;

// ----------------------------------------------------------------------------------------------- records, side by side

// Where the fours begin in the other records, in floats.
constexpr int kInertiaMass = 4, kConstraintFriction = 0, kConstraintSize = 4, kConstraintVelocity = 6,
              kConstraintKinds = 10;
static_assert(offsetof(BodyInertia, inverse_mass) == 4 * kInertiaMass + 8);
static_assert(offsetof(ContactConstraint, static_friction) == 4 * kConstraintFriction);
static_assert(offsetof(ContactConstraint, size) == 4 * kConstraintSize &&
              offsetof(ContactConstraint, pushout_speed) == 4 * kConstraintSize + 4);
static_assert(offsetof(ContactConstraint, surface_velocity) == 4 * kConstraintVelocity);
// Bytes in the last float of a group.
static_assert(offsetof(ContactConstraint, rigid) == 4 * kConstraintKinds + 12 &&
              offsetof(ContactConstraint, has_joint) == 4 * kConstraintKinds + 13 &&
              offsetof(ContactConstraint, speculative) == 4 * kConstraintKinds + 14);

// The constraints and manifolds of a block's lanes. Lanes without a contact, and missing points, read zeros
// and are not written.
template <int W>
struct LaneRecords {
  const float* constraint[W];
  float* manifold[W];
  float* point[W];  // the manifold, in lanes that have the present point
  float* nowhere;
  std::uint32_t lanes = 0;                      // bits
  std::uint32_t has_point[kMaxManifoldPoints];  // bits
  int point_count = 0;                          // the largest of any lane
  Vec3W<W> normal;
  Wide<W> exists[kMaxManifoldPoints];  // 1 or 0

  // Offset of point k in `point`. Points must be visited in rising order.
  GYRE_INLINE int begin_point(int k) {
    for (std::uint32_t without = lanes & ~has_point[k]; without != 0; without &= without - 1)
      point[__builtin_ctz(without)] = nowhere;
    return kManifoldPoints + k * kPointFloats;
  }
};

// Manifolds lie anywhere in memory, so those of the next block are fetched during this one.
template <int W>
GYRE_INLINE void fetch_ahead(const ContactConstraint* constraints, const std::uint32_t* order) {
  for (int lane = 0; lane < W; ++lane) {
    if (order[lane] == 0xffffffffu) continue;
    const char* manifold = reinterpret_cast<const char*>(constraints[order[lane]].manifold);
    GYRE_UNROLL
    for (int line = 0; line < 5; ++line) __builtin_prefetch(manifold + 64 * line);
  }
}

// Lanes without a record read (zeros) and write `nowhere`.
template <int W>
GYRE_INLINE LaneRecords<W> find_records(const ContactConstraint* constraints, const std::uint32_t* order,
                                        float (&nowhere)[80]) {
  LaneRecords<W> records;
  records.nowhere = nowhere;
  for (int lane = 0; lane < W; ++lane) {
    records.constraint[lane] = records.manifold[lane] = records.point[lane] = nowhere;
    if (order[lane] == 0xffffffffu) continue;
    const ContactConstraint& constraint = constraints[order[lane]];
    records.lanes |= 1u << lane;
    records.constraint[lane] = reinterpret_cast<const float*>(&constraint);
    records.manifold[lane] = records.point[lane] = &constraint.manifold->normal.x;
  }
  Wide<W> in[4];
  gather_columns<4, W>(records.manifold, kManifoldNormal, in);
  records.normal = {in[0], in[1], in[2]};
  GYRE_UNROLL
  for (int k = 0; k < kMaxManifoldPoints; ++k) {
    const Mask<W> has = bit_pattern(in[3]) > WideInt<W>(k);
    records.has_point[k] = to_bits(has);
    records.exists[k] = keep(has, Wide<W>(1.0f));
    if (records.has_point[k] != 0) records.point_count = k + 1;
  }
  return records;
}

// --------------------------------------------------------------------------------------------------------- preparation

// Access to one lane, for solvers of single contacts.
template <int W>
void set_lane(Wide<W>& wide, int lane, float value) {
  wide.set(lane, value);
}
template <int W>
float get_lane(const Wide<W>& wide, int lane) {
  // Adding zero turns -0 from a resting lane into the 0 of a narrower kernel.
  return wide[lane] + 0.0f;
}
template <int W>
void set_lane(Vec3W<W>& wide, int lane, Vec3 v) {
  set_lane(wide.x, lane, v.x);
  set_lane(wide.y, lane, v.y);
  set_lane(wide.z, lane, v.z);
}
template <int W>
Vec3 get_lane(const Vec3W<W>& wide, int lane) {
  return {get_lane(wide.x, lane), get_lane(wide.y, lane), get_lane(wide.z, lane)};
}

// Arms of the points while a block is prepared.
template <int W>
struct PointArms {
  Vec3W<W> from_a, from_b;
};

// As any_perpendicular of <gyre/math.h>.
template <int W>
GYRE_INLINE Vec3W<W> any_perpendicular(Vec3W<W> a) {
  const Wide<W> zero(0.0f), one(1.0f), bound(0.57735f);
  const auto x = absolute(a.x) < bound;
  const auto y = absolute(a.y) < bound;
  const Vec3W<W> other{select(x, one, zero), select(x, zero, select(y, one, zero)),
                       select(x, zero, select(y, zero, one))};
  return normalized<W>(cross(a, other));
}

// The centre of pressure and the mean lever arm of the patch, which is returned. Points have the load of the
// last step as weight, or without load their nearness to touch. Factors of the lever arm: a uniform square's
// mean distance from its centre is 0.541 of its corners', a uniform segment's half of its ends'.
template <int W>
GYRE_INLINE Wide<W> pressure_patch(ContactBlock<W>& block, const LaneRecords<W>& records,
                                   const PointArms<W> (&arms)[kMaxManifoldPoints]) {
  const Wide<W> zero(0.0f), one(1.0f);
  const int count = block.point_count;
  Wide<W> weights[kMaxManifoldPoints];
  Wide<W> sum = zero;
  for (int k = 0; k < count; ++k) sum = sum + (weights[k] = block.impulses[k]);
  const auto bears = sum > Wide<W>(kMinLoad);
  if (!all(bears)) {
    // The weight of a point falls with its height above the lowest, in units of the manifold's extent.
    Wide<W> extent = zero, nearest = block.points[0].separation;
    for (int k = 1; k < count; ++k) {
      const auto exists = records.exists[k] > zero;
      extent = select(exists, max(extent, length(arms[k].from_a - arms[0].from_a)), extent);
      nearest = select(exists, min(nearest, block.points[k].separation), nearest);
    }
    const auto wide = extent > zero;
    const Wide<W> fade = select(wide, Wide<W>(100.0f) / select(wide, extent, one), zero);
    Wide<W> near_sum = zero;
    for (int k = 0; k < count; ++k) {
      const Wide<W> above = fade * (block.points[k].separation - nearest);
      const Wide<W> weight = keep(records.exists[k] > zero, one / (one + above * above));
      weights[k] = select(bears, weights[k], weight);
      near_sum = near_sum + weight;
    }
    sum = select(bears, sum, near_sum);
  }
  const Wide<W> share = one / select(sum > zero, sum, one);
  Vec3W<W> from_a{zero, zero, zero}, from_b{zero, zero, zero};
  for (int k = 0; k < count; ++k) {
    weights[k] = weights[k] * share;
    from_a = from_a + weights[k] * arms[k].from_a;
    from_b = from_b + weights[k] * arms[k].from_b;
  }
  Wide<W> arm = zero;
  for (int k = 0; k < count; ++k) arm = arm + weights[k] * length(arms[k].from_a - from_a);
  block.friction_from_a = from_a;
  block.friction_from_b = from_b;
  return select(records.exists[2] > zero, Wide<W>(0.541f), Wide<W>(0.5f)) * arm;
}

// Surface parameters of the lanes.
template <int W>
struct SurfaceLanes {
  Wide<W> static_friction, dynamic_friction, rolling_friction, spinning_friction;
};

// Takes locked axes out of the effective mass matrix of the friction rows. A share of the masses stays, so that it has an inverse.
template <int W>
__attribute__((noinline)) void lock_friction_masses(const ContactBlock<W>& block, Wide<W> inverse_masses,
                                                    Sym3W<W>& k) {
  const Vec3W<W> t1 = block.tangent_1, t2 = block.tangent_2;
  const Wide<W> taken(1.0f - 1.0e-5f), zero(0.0f);
  k.xx = k.xx - taken * (inverse_masses - inverse_masses_between<W>(block, t1, t1, inverse_masses));
  k.yy = k.yy - taken * (inverse_masses - inverse_masses_between<W>(block, t2, t2, inverse_masses));
  const Wide<W> xy = k.xy + taken * inverse_masses_between<W>(block, t1, t2, zero);
  k.xy = select(Mask<W>::of_bits(block.locked), xy, k.xy);
}

// Effective mass matrix of the friction rows, and its inverse into the block. The twist row is left out
// without lever arm. Returns K with all rows.
template <int W>
GYRE_INLINE Sym3W<W> prepare_friction_masses(ContactBlock<W>& block, Mask<W> has_lever, Mask<W>& twists) {
  const Wide<W> zero(0.0f), one(1.0f);
  const Vec3W<W> t1 = block.tangent_1, t2 = block.tangent_2, n = block.normal;
  const Vec3W<W> a1 = cross(block.friction_from_a, t1), a2 = cross(block.friction_from_a, t2);
  const Vec3W<W> b1 = cross(block.friction_from_b, t1), b2 = cross(block.friction_from_b, t2);
  const Vec3W<W> ia1 = block.inverse_inertia_a * a1, ia2 = block.inverse_inertia_a * a2,
                 ian = block.inverse_inertia_a * n;
  const Vec3W<W> ib1 = block.inverse_inertia_b * b1, ib2 = block.inverse_inertia_b * b2,
                 ibn = block.inverse_inertia_b * n;
  const Wide<W> inverse_masses = block.inverse_mass_a + block.inverse_mass_b;
  Sym3W<W> k;
  k.xx = inverse_masses + dot(a1, ia1) + dot(b1, ib1);
  k.yy = inverse_masses + dot(a2, ia2) + dot(b2, ib2);
  k.xy = dot(a1, ia2) + dot(b1, ib2);
  if (block.locked != 0) lock_friction_masses<W>(block, inverse_masses, k);
  k.zz = dot(n, ian) + dot(n, ibn);
  k.xz = dot(a1, ian) + dot(b1, ibn);
  k.yz = dot(a2, ian) + dot(b2, ibn);
  twists = has_lever & (k.zz > zero);
  const Sym3W<W> all_rows = k;
  k.xz = keep(twists, k.xz);
  k.yz = keep(twists, k.yz);
  k.zz = select(twists, k.zz, one);
  const Sym3W<W> inverse_k = inverse(k);
  block.inverse_k11 = inverse_k.xx;
  block.inverse_k22 = inverse_k.yy;
  block.inverse_k33 = keep(twists, inverse_k.zz);
  block.inverse_k12 = inverse_k.xy;
  block.inverse_k13 = inverse_k.xz;
  block.inverse_k23 = inverse_k.yz;
  return all_rows;
}

// Prepares the friction rows: masses and limits. `radius`: the lever arm of the patch.
template <int W>
GYRE_INLINE void prepare_friction(ContactBlock<W>& block, const SurfaceLanes<W>& surface, Wide<W> radius,
                                  Wide<W> size) {
  const Wide<W> zero(0.0f), one(1.0f);
  const Wide<W> twist_static = surface.static_friction * radius + surface.spinning_friction;
  const Wide<W> twist_dynamic = surface.dynamic_friction * radius + surface.spinning_friction;
  // Where one point carries all load, the patch is only as wide as rounding and has no lever arm.
  const auto is_patch = (radius > Wide<W>(kMinPatch) * size) | (surface.spinning_friction > zero);
  auto twists = one < zero;
  const Sym3W<W> k = prepare_friction_masses<W>(block, is_patch & (twist_static > zero), twists);
  // The scale at which a twist of 1 rad/s slips like a metre per second. With it the trace bounds the largest
  // eigenvalue of K, and its inverse is a safe common step.
  const auto slides = surface.dynamic_friction > zero;
  const Wide<W> scale =
      select(twists & slides, twist_dynamic / select(slides, surface.dynamic_friction, one), radius);
  const Wide<W> bound = max(max(k.xx, k.yy) + absolute(k.xy), keep(twists, scale * scale * k.zz));
  block.cold->twist_radius = keep(twists, scale);
  block.cold->slide_mass = keep(bound > zero, one / select(bound > zero, bound, one));
  const auto inverse_or_zero = [&](Wide<W> friction) {
    return keep(friction > zero, one / select(friction > zero, min(friction, Wide<W>(kMaxFriction)), one));
  };
  block.inverse_friction = inverse_or_zero(surface.static_friction);
  block.inverse_dynamic_friction = inverse_or_zero(surface.dynamic_friction);
  block.inverse_static_twist = keep(twists, inverse_or_zero(twist_static));
  block.inverse_dynamic_twist = keep(twists, inverse_or_zero(twist_dynamic));
  // Where the patch has shrunk to a point, the twist of the last step is far beyond its limit. Clamped
  // together with the friction it would take that with it.
  const Wide<W> max_twist = twist_static * normal_load<W>(block);
  block.twist = keep(twists, clamp(block.twist, zero - max_twist, max_twist));
}

// Softness of the contacts, and shares of mobility in pushout: the upper body yields, as far as the contact
// faces up. So a heap is freed from below in few passes, as if the lower body were much heavier (E.
// Guendelman, R. Bridson, R. Fedkiw, "Nonconvex Rigid Bodies with Stacking", 2003, call it shock
// propagation).
template <int W>
GYRE_INLINE void prepare_softness(ContactBlock<W>& block, Mask<W> rigid, Wide<W> age, Wide<W> size,
                                  const ContactSettings& settings) {
  const Wide<W> zero(0.0f), one(1.0f), aging(settings.aging);
  const auto yields = ~rigid, both = Mask<W>::of_bits(block.movable_a & block.movable_b);
  const Wide<W> youth = aging / (aging + age);
  block.rate = keep(yields, youth * Wide<W>(settings.rate));
  block.slop = Wide<W>(float(kSpringSlop)) * size;
  const auto has_slop = block.slop > zero;
  block.compliance =
      keep(yields & has_slop, youth * Wide<W>(settings.compliance) / select(has_slop, block.slop, one));
  const Wide<W> rise = keep(both, Wide<W>(kLowerShare) * dot(block.normal, splat<W>(settings.up)));
  block.cold->mobility_a = one - max(rise, zero);
  block.cold->mobility_b = one + min(rise, zero);
}

// Loads the initial impulses of friction, twist and rolling.
template <int W>
GYRE_INLINE void prepare_impulses(ContactBlock<W>& block, const LaneRecords<W>& records,
                                  const SurfaceLanes<W>& surface, const ContactSettings& settings,
                                  Wide<W>& age) {
  const Wide<W> zero(0.0f), one(1.0f), warm(settings.warm_scale);
  Wide<W> in[4];
  gather_columns<4, W>(records.manifold, kManifoldFriction, in);
  age = in[0];
  const Vec3W<W> friction = warm * Vec3W<W>{in[1], in[2], in[3]};
  block.friction_1 = dot(friction, block.tangent_1);
  block.friction_2 = dot(friction, block.tangent_2);
  gather_columns<4, W>(records.manifold, kManifoldTotals, in);
  block.slides = lane_bits<W>(bit_pattern(in[3]) != WideInt<W>(0));
  gather_columns<4, W>(records.manifold, kManifoldTwist, in);
  block.twist = warm * in[0];
  block.cold->rolling_friction = surface.rolling_friction;
  // A surface that ceased to have rolling friction starts from zero: otherwise the lanes beside it would
  // decide whether the old impulse acts once more.
  const auto has_rolling = surface.rolling_friction > zero;
  block.cold->rolling = keep<W>(has_rolling, warm * Vec3W<W>{in[1], in[2], in[3]});
  if (any(has_rolling)) block.has_rolling = 1;
  const Sym3W<W>& a = block.inverse_inertia_a;
  const Sym3W<W>& b = block.inverse_inertia_b;
  const Wide<W> angular_trace = (a.xx + a.yy + a.zz) + (b.xx + b.yy + b.zz);
  block.cold->rolling_mass =
      keep(angular_trace > zero, one / select(angular_trace > zero, angular_trace, one));
}

template <int W>
GYRE_INLINE void load_inertia(const float* const (&record)[W], Wide<W>& inverse_mass, Wide<W>& locked,
                              Sym3W<W>& inverse) {
  Wide<W> low[4], high[4];
  gather_columns<4, W>(record, 0, low);
  gather_columns<4, W>(record, kInertiaMass, high);
  inverse = {low[0], low[1], low[2], low[3], high[0], high[1]};
  inverse_mass = high[2];
  locked = high[3];
}

// Finds the motion records of one side's bodies and loads their mass into the block. Returns the lanes that
// have one, as bits.
template <int W>
GYRE_INLINE std::uint16_t find_side(const LaneRecords<W>& records, std::int32_t ContactConstraint::*body,
                                    ContactBodies bodies, float* (&motion)[W], Wide<W>& inverse_mass,
                                    Wide<W>& locked, Sym3W<W>& inverse_inertia) {
  const float* inertia[W];
  std::uint32_t has = 0;
  for (int lane = 0; lane < W; ++lane) {
    // Never written: a missing record is not movable.
    motion[lane] = const_cast<float*>(kNoRecord);
    inertia[lane] = kNoRecord;
    if ((records.lanes >> lane & 1u) == 0) continue;
    const std::int32_t index = reinterpret_cast<const ContactConstraint*>(records.constraint[lane])->*body;
    if (index == kNoBody) continue;
    has |= 1u << lane;
    motion[lane] = &bodies.motion[index].linear_velocity.x;
    inertia[lane] = &bodies.inertia[index].inverse.xx;
  }
  load_inertia<W>(inertia, inverse_mass, locked, inverse_inertia);
  return static_cast<std::uint16_t>(has);
}

// Finds the records to which velocities of movable bodies are written.
template <int W>
GYRE_INLINE void find_write_records(std::uint32_t pushes, float* const (&read)[W], float* nowhere,
                                    float* (&write)[W]) {
  for (int lane = 0; lane < W; ++lane) write[lane] = (pushes >> lane & 1u) != 0 ? read[lane] : nowhere;
}

// The inverse mass along each locked axis.
template <int W>
__attribute__((noinline)) Vec3W<W> locked_masses(Wide<W> locked, Wide<W> inverse_mass) {
  const Wide<W> zero(0.0f);
  Vec3W<W> masses{zero, zero, zero};
  for (int lane = 0; lane < W; ++lane) {
    const int axes = int(locked[lane]);
    if ((axes & 1) != 0) masses.x.set(lane, inverse_mass[lane]);
    if ((axes & 2) != 0) masses.y.set(lane, inverse_mass[lane]);
    if ((axes & 4) != 0) masses.z.set(lane, inverse_mass[lane]);
  }
  return masses;
}

template <int W>
GYRE_INLINE void prepare_bodies(ContactBlock<W>& block, const LaneRecords<W>& records, ContactBodies bodies) {
  const Wide<W> zero(0.0f);
  Sym3W<W>& a = block.inverse_inertia_a;
  Sym3W<W>& b = block.inverse_inertia_b;
  Wide<W> locked_a, locked_b;
  block.has_a = find_side<W>(records, &ContactConstraint::body_a, bodies, block.read_a, block.inverse_mass_a,
                             locked_a, a);
  block.has_b = find_side<W>(records, &ContactConstraint::body_b, bodies, block.read_b, block.inverse_mass_b,
                             locked_b, b);
  block.locked = lane_bits<W>((locked_a > zero) | (locked_b > zero));
  if (block.locked != 0) {
    block.cold->locked_mass_a = locked_masses<W>(locked_a, block.inverse_mass_a);
    block.cold->locked_mass_b = locked_masses<W>(locked_b, block.inverse_mass_b);
  }
  // Any impulse moves or rotates a body by a diagonal element.
  block.movable_a = block.has_a & lane_bits<W>((block.inverse_mass_a > zero) | (a.xx != zero) |
                                               (a.yy != zero) | (a.zz != zero));
  block.movable_b = block.has_b & lane_bits<W>((block.inverse_mass_b > zero) | (b.xx != zero) |
                                               (b.yy != zero) | (b.zz != zero));
  find_write_records<W>(block.movable_a, block.read_a, block.cold->nowhere, block.cold->write_a);
  find_write_records<W>(block.movable_b, block.read_b, block.cold->nowhere, block.cold->write_b);
}

// Chooses the body from whose centre arms are measured, and their difference for the other. It is the nearer
// one: the other may be large or far away, and its arms rounded. Static bodies have no arms.
template <int W>
GYRE_INLINE Mask<W> choose_arm_origin(ContactBlock<W>& block, const PointArms<W>& first) {
  const Wide<W> zero(0.0f);
  const Vec3W<W> none{zero, zero, zero};
  const auto has_a = Mask<W>::of_bits(block.has_a), has_b = Mask<W>::of_bits(block.has_b);
  const auto nearer_a = has_a & (~has_b | (length_squared(first.from_a) <= length_squared(first.from_b)));
  const Vec3W<W> shift = cross(first.from_b - first.from_a, block.normal);  // of arms from A to B
  block.arm_shift_a = select<W>(has_a & ~nearer_a, -shift, none);
  block.arm_shift_b = select<W>(has_b & nearer_a, shift, none);
  return nearer_a;
}

template <int W>
void prepare_block(ContactBlock<W>& block, const ContactConstraint* constraints, const std::uint32_t* order,
                   ContactBodies bodies, const ContactSettings& settings) {
  const Wide<W> zero(0.0f), one(1.0f), warm(settings.warm_scale);
  alignas(64) float nowhere[80] = {};
  LaneRecords<W> records = find_records<W>(constraints, order, nowhere);
  block.point_count = records.point_count == 3 ? 4 : records.point_count;
  block.has_rolling = block.has_fresh = 0;
  block.is_settled = 0;
  Wide<W> in[4];
  block.normal = records.normal;
  block.tangent_1 = any_perpendicular<W>(block.normal);
  block.tangent_2 = cross(block.normal, block.tangent_1);
  prepare_bodies<W>(block, records, bodies);
  PointArms<W> arms[kMaxManifoldPoints];
  auto nearer_a = one > zero;
  for (int k = 0; k < block.point_count; ++k) {
    PointBlock<W>& point = block.points[k];
    const int first = records.begin_point(k);
    gather_columns<4, W>(records.point, first + kPointA, in);
    arms[k].from_a = {in[0], in[1], in[2]};
    point.separation = in[3];
    gather_columns<4, W>(records.point, first + kPointB, in);
    arms[k].from_b = {in[0], in[1], in[2]};
    if (k == 0) nearer_a = choose_arm_origin<W>(block, arms[0]);
    gather_columns<4, W>(records.point, first + kPointImpulse, in);
    block.impulses[k] = warm * in[0];
    point.mean_impulse = warm * in[2];
    block.totals[k] = zero;
    point.arm = cross(select<W>(nearer_a, arms[k].from_a, arms[k].from_b), block.normal);
  }
  gather_columns<4, W>(records.constraint, kConstraintFriction, in);
  const SurfaceLanes<W> surface{in[0], in[1], in[2], in[3]};
  gather_columns<4, W>(records.constraint, kConstraintSize, in);
  const Wide<W> size = in[0];
  block.pushout_speed = in[1];
  gather_columns<4, W>(records.constraint, kConstraintVelocity, in);
  const Vec3W<W> surface_velocity{in[0], in[1], in[2]};
  // Not -0: a surface at rest is left out, and that must give the same bits.
  block.cold->surface_1 = dot(surface_velocity, block.tangent_1) + zero;
  block.cold->surface_2 = dot(surface_velocity, block.tangent_2) + zero;
  block.has_surface_velocity = any((block.cold->surface_1 != zero) | (block.cold->surface_2 != zero)) ? 1 : 0;
  block.total_1 = block.total_2 = zero;
  gather_columns<4, W>(records.constraint, kConstraintKinds, in);
  const WideInt<W> none(0), kinds = bit_pattern(in[3]);
  const Mask<W> rigid = (kinds & WideInt<W>(0xff)) != none;
  block.jointed = lane_bits<W>((kinds & WideInt<W>(0xff00)) != none);
  block.carried_a = block.carried_b = 0;
  if ((block.has_a & block.has_b) != 0)
    find_carried<W>(block, nearer_a, arms[0].from_a, arms[0].from_b, size, settings.step);
  block.speculative = lane_bits<W>((kinds & WideInt<W>(0xff0000)) != none);
  block.pushing = 0;
  Wide<W> age;
  prepare_impulses<W>(block, records, surface, settings, age);
  block.cold->fresh = select(age > zero, zero, one);
  if ((to_bits(block.cold->fresh > zero) & records.lanes) != 0) block.has_fresh = 1;
  prepare_softness<W>(block, rigid, age, size, settings);
  prepare_friction<W>(block, surface, pressure_patch<W>(block, records, arms), size);
  prepare_normals<W>(block, records.exists);
}

template <int W>
void prepare_blocks(void* memory, void* cold_blocks, int begin, int end, const ContactConstraint* constraints,
                    const std::uint32_t* order, ContactBodies bodies, const ContactSettings& settings) {
  auto* blocks = static_cast<ContactBlock<W>*>(memory);
  for (int i = begin; i < end; ++i) {
    if (i + 1 < end) fetch_ahead<W>(constraints, order + (i + 1) * W);
    blocks[i].cold = static_cast<ContactBlockCold<W>*>(cold_blocks) + i;
    prepare_block<W>(blocks[i], constraints, order + i * W, bodies, settings);
  }
}

// -------------------------------------------------------------------------------------------------------------- finish

// Stores impulses in the manifolds, and updates age and mean impulses.
template <int W>
void finish_block(const ContactBlock<W>& block, const ContactConstraint* constraints,
                  const std::uint32_t* order, const ContactSettings& settings) {
  const Wide<W> zero(0.0f), one(1.0f);
  alignas(64) float nowhere[80] = {};
  LaneRecords<W> records = find_records<W>(constraints, order, nowhere);
  Wide<W> row[4];
  gather_columns<4, W>(records.manifold, kManifoldFriction, row);
  // The load of the whole step: a point unloaded just at its end keeps its history.
  Wide<W> load = zero;
  for (int k = 0; k < block.point_count; ++k) load = max(load, block.totals[k]);
  const Wide<W> age = keep(load > zero, row[0] + Wide<W>(settings.step));
  const Wide<W> mean = min(max(age, Wide<W>(kShortestMean)), Wide<W>(kLongestMean));
  const Wide<W> gain = min(Wide<W>(settings.step) / mean, one);
  // Adding zero turns -0 from a resting lane into the 0 of a narrower kernel.
  const Vec3W<W> none{zero, zero, zero};
  const Vec3W<W> friction = block.friction_1 * block.tangent_1 + block.friction_2 * block.tangent_2 + none;
  const Vec3W<W> total_friction = block.total_1 * block.tangent_1 + block.total_2 * block.tangent_2 + none;
  const Wide<W> friction_row[4] = {age, friction.x, friction.y, friction.z};
  scatter_columns<4, W>(records.manifold, kManifoldFriction, friction_row);
  const Vec3W<W> rolling = block.cold->rolling + none;
  const Wide<W> twist_row[4] = {block.twist + zero, rolling.x, rolling.y, rolling.z};
  scatter_columns<4, W>(records.manifold, kManifoldTwist, twist_row);
  const Wide<W> slides = from_bit_pattern(to_int(Mask<W>::of_bits(block.slides)) & WideInt<W>(1));
  const Wide<W> totals_row[4] = {total_friction.x, total_friction.y, total_friction.z, slides};
  scatter_columns<4, W>(records.manifold, kManifoldTotals, totals_row);
  // A manifold found anew at an impact may have more points than the block, which bore nothing.
  for (int k = 0; k < records.point_count; ++k) {
    const bool is_in_block = k < block.point_count;
    const int first = records.begin_point(k) + kPointImpulse;
    gather_columns<4, W>(records.point, first, row);
    const Wide<W> impulse = is_in_block ? block.impulses[k] + zero : zero;
    const Wide<W> total = is_in_block ? block.totals[k] + zero : zero;
    const Wide<W> mean_impulse = keep(total > zero, row[2] + gain * (impulse - row[2]));
    const Wide<W> point_row[4] = {impulse, row[1] + total, mean_impulse, row[3]};
    scatter_columns<4, W>(records.point, first, point_row);
  }
}

template <int W>
void finish_blocks(void* memory, int begin, int end, const ContactConstraint* constraints,
                   const std::uint32_t* order, const ContactSettings& settings) {
  auto* blocks = static_cast<const ContactBlock<W>*>(memory);
  for (int i = begin; i < end; ++i) {
    if (i + 1 < end) fetch_ahead<W>(constraints, order + (i + 1) * W);
    finish_block<W>(blocks[i], constraints, order + i * W, settings);
  }
}

// ------------------------------------------------------------------------------------------------------ single contacts

template <int W>
void read_block_impulse(const void* memory, int index, int lane, ContactImpulse& impulse) {
  const ContactBlock<W>& block = static_cast<const ContactBlock<W>*>(memory)[index];
  for (int k = 0; k < kMaxManifoldPoints; ++k) impulse.normal[k] = get_lane(block.impulses[k], lane);
  impulse.friction = get_lane(block.friction_1, lane) * get_lane(block.tangent_1, lane) +
                     get_lane(block.friction_2, lane) * get_lane(block.tangent_2, lane);
  impulse.twist = get_lane(block.twist, lane);
  impulse.rolling = get_lane(block.cold->rolling, lane);
  impulse.friction_from_b = get_lane(block.friction_from_b, lane);
  const float inverse_twist_limit = get_lane(block.inverse_static_twist, lane);
  impulse.twist_per_normal = inverse_twist_limit > 0.0f ? 1.0f / inverse_twist_limit : 0.0f;
}

template <int W>
void write_block_impulse(void* memory, int index, int lane, const ContactImpulse& impulse) {
  ContactBlock<W>& block = static_cast<ContactBlock<W>*>(memory)[index];
  // The sums over the step count the final impulse.
  const auto replace = [lane](Wide<W>& present, Wide<W>& total, float value) {
    set_lane(total, lane, get_lane(total, lane) + (value - get_lane(present, lane)));
    set_lane(present, lane, value);
  };
  block.is_settled = 0;
  for (int k = 0; k < kMaxManifoldPoints; ++k) {
    if (impulse.normal[k] > 0.0f)
      block.speculative = static_cast<std::uint16_t>(block.speculative & ~(1u << lane));
    replace(block.impulses[k], block.totals[k], impulse.normal[k]);
  }
  replace(block.friction_1, block.total_1, dot(impulse.friction, get_lane(block.tangent_1, lane)));
  replace(block.friction_2, block.total_2, dot(impulse.friction, get_lane(block.tangent_2, lane)));
  set_lane(block.twist, lane, impulse.twist);
  set_lane(block.cold->rolling, lane, impulse.rolling);
  block.slides = static_cast<std::uint16_t>(block.slides & ~(1u << lane));
}

template <int W>
void make_block_rigid(void* memory, int index, int lane) {
  ContactBlock<W>& block = static_cast<ContactBlock<W>*>(memory)[index];
  set_lane(block.rate, lane, 0.0f);
  set_lane(block.compliance, lane, 0.0f);
  block.is_settled = 0;
}

}  // namespace GYRE_TARGET_NAMESPACE
}  // namespace gyre
