// The contact kernels: prepare, warm start, solve, project and finish, one template for every width. Lane i of a block
// computes exactly what a block of width 1 would, so the width never changes a bit.
//
// A manifold has up to four normal rows and one friction row triple at the centre of pressure: two tangents and the twist
// about the normal, limited together by an ellipsoid (S. Goyal, A. Ruina, J. Papadopoulos, "Planar sliding with dry
// friction", 1991; R. Howe, M. Cutkosky, 1996), which couples sliding with spinning as a patch of uniform pressure does.
// Normal rows are soft springs (after E. Catto, "Soft Constraints", 2011) that stiffen with age and get used to their load:
// docs/decisions/contact-softness.md. Overlap is taken back apart from velocities (contact_project.h).
// The normal rows of a manifold are solved together: taken one after the other they would set every box rocking.
//
// Error of a point: s = separation + n . (moved_b - moved_a + turned_b x r_b - turned_a x r_a), first order on purpose: a
// rolling ball's contact does not rise with the material that was there.
#pragma once

#include "math/wide_vec.h"
#include "solver/contact_block.h"

namespace gyre {
inline namespace GYRE_TARGET_NAMESPACE {

// The fastest that springs take overlap back, as a share of the speed with which it is pushed apart: unlike that, theirs is
// momentum.
constexpr float kSpringSpeed = 0.125f;
// Projected sweeps over the points of a manifold in which some would pull.
constexpr int kPullSweeps = 6;

template <int W>
struct PointBlock {
  Vec3W<W> from_a, from_b;
  Wide<W> separation;     // as the step began
  Wide<W> impulse;        // accumulated in this sub-step
  Wide<W> held;           // the load it is used to
  Wide<W> total;          // summed over the step
};

template <int W>
struct ContactBlock {
  std::int32_t read_a[W], read_b[W];    // motion records, or kNoBody
  std::int32_t write_a[W], write_b[W];  // the same, kNoBody for bodies that nothing pushes
  std::int32_t point_count = 0;         // the most of any lane
  std::int32_t rolls = 0;               // any lane has rolling friction
  std::int32_t has_fresh = 0;           // any lane is fresh
  Vec3W<W> normal, tangent_1, tangent_2;
  Wide<W> inverse_mass_a, inverse_mass_b;
  Sym3W<W> inverse_inertia_a, inverse_inertia_b;
  Wide<W> rate, give, slop, push_speed;
  Wide<W> mobility_a, mobility_b;  // shares of the inverse masses that a push apart sees
  // Friction at the centre of pressure.
  Vec3W<W> friction_from_a, friction_from_b;
  Wide<W> static_friction, dynamic_friction;
  Wide<W> twist_per_normal_static, twist_per_normal_dynamic;  // m: torque limit over normal impulse
  Wide<W> inverse_k11, inverse_k12, inverse_k13, inverse_k22, inverse_k23, inverse_k33;  // of (tangent_1, tangent_2, twist)
  Wide<W> slide_mass;     // scalar step for sliding, so that friction opposes the slip in every direction alike
  Wide<W> twist_radius;   // m: scale of the twist row beside the tangents
  Wide<W> surface_1, surface_2;
  Wide<W> friction_1, friction_2, twist;
  Wide<W> sliding;        // 1 where friction was at its limit
  Wide<W> fresh;          // 1 where no load is known yet
  Wide<W> total_1, total_2;
  // Rolling friction.
  Wide<W> rolling_friction, rolling_mass;
  Vec3W<W> rolling;
  // K = J M^-1 J^T of the normal rows, upper triangle by rows (00 01 02 03 11 12 13 22 23 33), and its regularised inverse;
  // `inverse_k[..]` and `relief` are 0 in rows of points that a lane does not have.
  Wide<W> k[10], inverse_k[10];
  Wide<W> relief[kMaxManifoldPoints];  // 1 / K_ii
  PointBlock<W> points[kMaxManifoldPoints];
};

// Place of row i, column j (either order) in a packed upper triangle.
constexpr int packed(int i, int j) {
  constexpr int kStart[4] = {0, 3, 5, 6};
  return i <= j ? kStart[i] + j : kStart[j] + i;
}

// Velocities of the two bodies of each lane.
template <int W>
struct PairMotion {
  Vec3W<W> linear_a, angular_a, linear_b, angular_b;
};

template <int W>
GYRE_INLINE void load_pair(const ContactBlock<W>& block, const BodyMotion* motion, Wide<W>* a, Wide<W>* b) {
  gather16<W>(&motion->linear_velocity.x, block.read_a, a);
  gather16<W>(&motion->linear_velocity.x, block.read_b, b);
}

template <int W>
GYRE_INLINE PairMotion<W> velocities(const Wide<W>* a, const Wide<W>* b) {
  return {{a[0], a[1], a[2]}, {a[3], a[4], a[5]}, {b[0], b[1], b[2]}, {b[3], b[4], b[5]}};
}

template <int W>
GYRE_INLINE void store_pair(const ContactBlock<W>& block, BodyMotion* motion, const PairMotion<W>& pair, Wide<W>* a,
                            Wide<W>* b) {
  // Adding zero keeps -0 out of the state: lanes that have fewer points than their block add zeros of either sign.
  const Wide<W> zero(0.0f);
  a[0] = pair.linear_a.x + zero, a[1] = pair.linear_a.y + zero, a[2] = pair.linear_a.z + zero;
  a[3] = pair.angular_a.x + zero, a[4] = pair.angular_a.y + zero, a[5] = pair.angular_a.z + zero;
  b[0] = pair.linear_b.x + zero, b[1] = pair.linear_b.y + zero, b[2] = pair.linear_b.z + zero;
  b[3] = pair.angular_b.x + zero, b[4] = pair.angular_b.y + zero, b[5] = pair.angular_b.z + zero;
  scatter<8, W>(&motion->linear_velocity.x, block.write_a, a);
  scatter<8, W>(&motion->linear_velocity.x, block.write_b, b);
}

// Adds the impulse `p` on B at `from_b` (and -p on A at `from_a`).
template <int W>
GYRE_INLINE void push(const ContactBlock<W>& block, PairMotion<W>& pair, Vec3W<W> p, Vec3W<W> from_a, Vec3W<W> from_b) {
  pair.linear_a = pair.linear_a - block.inverse_mass_a * p;
  pair.angular_a = pair.angular_a - block.inverse_inertia_a * cross(from_a, p);
  pair.linear_b = pair.linear_b + block.inverse_mass_b * p;
  pair.angular_b = pair.angular_b + block.inverse_inertia_b * cross(from_b, p);
}

// Adds the angular impulse `t` on B (and -t on A).
template <int W>
GYRE_INLINE void turn(const ContactBlock<W>& block, PairMotion<W>& pair, Vec3W<W> t) {
  pair.angular_a = pair.angular_a - block.inverse_inertia_a * t;
  pair.angular_b = pair.angular_b + block.inverse_inertia_b * t;
}

// Velocity of B's material against A's at a point.
template <int W>
GYRE_INLINE Vec3W<W> relative_velocity(const PairMotion<W>& pair, Vec3W<W> from_a, Vec3W<W> from_b) {
  return (pair.linear_b + cross(pair.angular_b, from_b)) - (pair.linear_a + cross(pair.angular_a, from_a));
}

template <int W>
void warm_start_blocks(void* memory, int begin, int end, BodyMotion* motion) {
  auto* blocks = static_cast<ContactBlock<W>*>(memory);
  for (int i = begin; i < end; ++i) {
    ContactBlock<W>& block = blocks[i];
    Wide<W> a[kMotionFloats], b[kMotionFloats];
    load_pair<W>(block, motion, a, b);
    PairMotion<W> pair = velocities<W>(a, b);
    for (int k = 0; k < block.point_count; ++k) {
      const PointBlock<W>& point = block.points[k];
      push<W>(block, pair, point.impulse * block.normal, point.from_a, point.from_b);
    }
    push<W>(block, pair, block.friction_1 * block.tangent_1 + block.friction_2 * block.tangent_2, block.friction_from_a,
            block.friction_from_b);
    turn<W>(block, pair, block.twist * block.normal);
    if (block.rolls != 0) turn<W>(block, pair, block.rolling);
    store_pair<W>(block, motion, pair, a, b);
  }
}

// Sum of the normal impulses of a manifold.
template <int W>
GYRE_INLINE Wide<W> normal_load(const ContactBlock<W>& block) {
  Wide<W> load = block.points[0].impulse;
  for (int k = 1; k < block.point_count; ++k) load = load + block.points[k].impulse;
  return load;
}

// Friction: the impulse that would stop the slip, pulled back into the ellipsoid of what the load allows.
template <int W>
GYRE_INLINE void solve_friction(ContactBlock<W>& block, PairMotion<W>& pair) {
  const Wide<W> zero = Wide<W>(0.0f);
  const Wide<W> one = Wide<W>(1.0f);
  const Wide<W> load = normal_load<W>(block);
  const Vec3W<W> slip = relative_velocity<W>(pair, block.friction_from_a, block.friction_from_b);
  const Wide<W> v1 = dot(slip, block.tangent_1) - block.surface_1;
  const Wide<W> v2 = dot(slip, block.tangent_2) - block.surface_2;
  const Wide<W> v3 = dot(pair.angular_b - pair.angular_a, block.normal);

  // Sticking: all three rows at once.
  Wide<W> f1 = block.friction_1 - (block.inverse_k11 * v1 + block.inverse_k12 * v2 + block.inverse_k13 * v3);
  Wide<W> f2 = block.friction_2 - (block.inverse_k12 * v1 + block.inverse_k22 * v2 + block.inverse_k23 * v3);
  Wide<W> f3 = block.twist - (block.inverse_k13 * v1 + block.inverse_k23 * v2 + block.inverse_k33 * v3);

  const auto was_sliding = block.sliding > zero;
  const Wide<W> slide_limit = block.dynamic_friction * load;
  const Wide<W> slide_twist = block.twist_per_normal_dynamic * load;
  const Wide<W> limit = select(was_sliding, slide_limit, block.static_friction * load);
  const Wide<W> twist_limit = select(was_sliding, slide_twist, block.twist_per_normal_static * load);
  const Wide<W> inverse_limit = select(limit > zero, one / limit, zero);
  const Wide<W> inverse_twist = select(twist_limit > zero, one / twist_limit, zero);
  const Wide<W> use = (f1 * f1 + f2 * f2) * (inverse_limit * inverse_limit) + (f3 * f3) * (inverse_twist * inverse_twist);
  const auto sticks = use <= one;

  // Sliding: a step along the slip, alike in every direction, then onto the ellipsoid.
  const Wide<W> g1 = block.friction_1 - block.slide_mass * v1;
  const Wide<W> g2 = block.friction_2 - block.slide_mass * v2;
  const Wide<W> g3 = block.twist - block.slide_mass * (block.twist_radius * block.twist_radius) * v3;
  const Wide<W> inverse_slide = select(slide_limit > zero, one / slide_limit, zero);
  const Wide<W> inverse_slide_twist = select(slide_twist > zero, one / slide_twist, zero);
  const Wide<W> reach = (g1 * g1 + g2 * g2) * (inverse_slide * inverse_slide) +
                        (g3 * g3) * (inverse_slide_twist * inverse_slide_twist);
  const Wide<W> scale = select(reach > one, one / sqrt(reach), one);
  f1 = select(sticks, f1, g1 * scale);
  f2 = select(sticks, f2, g2 * scale);
  f3 = select(sticks, f3, g3 * scale);
  block.sliding = select(sticks, zero, one);

  // No load, no friction.
  f1 = select(limit > zero, f1, zero);
  f2 = select(limit > zero, f2, zero);
  f3 = select(twist_limit > zero, f3, zero);

  const Wide<W> d1 = f1 - block.friction_1;
  const Wide<W> d2 = f2 - block.friction_2;
  const Wide<W> d3 = f3 - block.twist;
  block.friction_1 = f1;
  block.friction_2 = f2;
  block.twist = f3;
  push<W>(block, pair, d1 * block.tangent_1 + d2 * block.tangent_2, block.friction_from_a, block.friction_from_b);
  turn<W>(block, pair, d3 * block.normal);
}

// Rolling friction: a torque against the relative turning, at most rolling_friction times the load.
template <int W>
GYRE_INLINE void solve_rolling(ContactBlock<W>& block, PairMotion<W>& pair) {
  const Wide<W> zero = Wide<W>(0.0f);
  const Wide<W> one = Wide<W>(1.0f);
  const Vec3W<W> spin = pair.angular_b - pair.angular_a;
  const Vec3W<W> roll = spin - dot(spin, block.normal) * block.normal;
  const Vec3W<W> wanted = block.rolling - block.rolling_mass * roll;
  const Wide<W> limit = block.rolling_friction * normal_load<W>(block);
  const Wide<W> size = sqrt(dot(wanted, wanted));
  const Wide<W> scale = select(size > limit, limit / select(size > zero, size, one), one);
  // A lane that does not roll must come out as from a block without this: also where `wanted` leaves a float's range.
  const auto rolls = block.rolling_friction > zero;
  const Vec3W<W> bounded = scale * wanted;
  const Vec3W<W> next{select(rolls, bounded.x, zero), select(rolls, bounded.y, zero), select(rolls, bounded.z, zero)};
  turn<W>(block, pair, next - block.rolling);
  block.rolling = next;
}

// The normal rows of a manifold, solved together as a small complementarity problem: first as if all points pushed (which
// treats them alike: no order, no rocking), then, where some would pull, by projected sweeps in the space of impulses.
// Sprung: the spring draws its points to an overlap of `slop`, in both directions, and gives way to what it is not used to.
// Not sprung: only approach stops, and under load the speed with which springs pushed goes.
template <int W, bool kSprung>
GYRE_INLINE void solve_normals(ContactBlock<W>& block, PairMotion<W>& pair, const Wide<W>* a, const Wide<W>* b,
                               float substep) {
  const Wide<W> zero(0.0f);
  const Wide<W> one(1.0f);
  const Wide<W> rate(1.0f / substep);
  const Vec3W<W> moved = Vec3W<W>{b[8], b[9], b[10]} - Vec3W<W>{a[8], a[9], a[10]};
  const Vec3W<W> turned_a{a[11], a[12], a[13]};
  const Vec3W<W> turned_b{b[11], b[12], b[13]};
  const int count = block.point_count;
  Wide<W> residual[kMaxManifoldPoints];  // speed that the row wants to lose
  Wide<W> leak[kMaxManifoldPoints];
  Wide<W> next[kMaxManifoldPoints];
  auto pulls = one < zero;
  for (int i = 0; i < count; ++i) {
    const PointBlock<W>& point = block.points[i];
    const Vec3W<W> drift = moved + cross(turned_b, point.from_b) - cross(turned_a, point.from_a);
    const Wide<W> separation = point.separation + dot(drift, block.normal);
    const Wide<W> speed = dot(relative_velocity<W>(pair, point.from_a, point.from_b), block.normal);
    const auto apart = separation > zero;
    if constexpr (kSprung) {
      const Wide<W> asked = (separation + block.slop) * block.rate;
      const Wide<W> fastest = zero - Wide<W>(kSpringSpeed) * block.push_speed;
      const auto is_capped = asked < fastest;
      residual[i] = speed + select(apart, separation * rate + block.slop * block.rate, max(asked, fastest));
      // Where the speed is capped the impulse gives way less by the same share: the spring still bears its load.
      const Wide<W> share = select(is_capped, fastest / select(is_capped, asked, one), one);
      leak[i] = select(apart, zero, block.give * share) * max(point.impulse - point.held, zero);
    } else {
      // A point that is apart may be let go, never be held back: that would brake whatever is about to land.
      const Wide<W> excess = select(point.impulse > zero, max(speed + separation * rate, zero), zero);
      residual[i] = select(apart, excess, speed);
      leak[i] = zero;
    }
    // A point that the lane does not have must stay out of the sums even where speeds leave a float's range: 0 times that
    // would be no number, and a block of the lane's own would not have it.
    residual[i] = select(block.relief[i] > zero, residual[i], zero);
  }
  for (int i = 0; i < count; ++i) {
    Wide<W> change = zero;
    for (int j = 0; j < count; ++j) change = change + block.inverse_k[packed(i, j)] * residual[j];
    const Wide<W> wanted = block.points[i].impulse - change - leak[i];
    pulls = pulls | (wanted < zero);
    next[i] = max(wanted, zero);
  }
  if (any(pulls)) {
    // From the impulses that stand, not from the block's answer with its pulls cut off: that is too strong, and piles shake.
    for (int i = 0; i < count; ++i) next[i] = select(pulls, max(block.points[i].impulse - leak[i], zero), next[i]);
    for (int sweep = 0; sweep < kPullSweeps; ++sweep) {
      for (int i = 0; i < count; ++i) {
        Wide<W> speed = residual[i];
        for (int j = 0; j < count; ++j) speed = speed + block.k[packed(i, j)] * (next[j] - block.points[j].impulse + leak[j]);
        next[i] = select(pulls, max(next[i] - block.relief[i] * speed, zero), next[i]);
      }
    }
  }
  Wide<W> total = zero;
  Vec3W<W> arm_a{zero, zero, zero}, arm_b{zero, zero, zero};
  for (int i = 0; i < count; ++i) {
    PointBlock<W>& point = block.points[i];
    const Wide<W> change = next[i] - point.impulse;
    point.impulse = next[i];
    total = total + change;
    arm_a = arm_a + change * point.from_a;
    arm_b = arm_b + change * point.from_b;
  }
  pair.linear_a = pair.linear_a - (block.inverse_mass_a * total) * block.normal;
  pair.angular_a = pair.angular_a - block.inverse_inertia_a * cross(arm_a, block.normal);
  pair.linear_b = pair.linear_b + (block.inverse_mass_b * total) * block.normal;
  pair.angular_b = pair.angular_b + block.inverse_inertia_b * cross(arm_b, block.normal);
}

// Contacts that bore nothing yet: friction knows no load that limits it, so the normals have to come first once.
template <int W>
GYRE_INLINE void strike_fresh(ContactBlock<W>& block, PairMotion<W>& pair, const Wide<W>* a, const Wide<W>* b, float substep) {
  const auto fresh = block.fresh > Wide<W>(0.0f);
  const ContactBlock<W> old = block;
  const PairMotion<W> old_pair = pair;
  solve_normals<W, true>(block, pair, a, b, substep);
  solve_friction<W>(block, pair);
  for (int k = 0; k < block.point_count; ++k) {
    block.points[k].impulse = select(fresh, block.points[k].impulse, old.points[k].impulse);
  }
  block.friction_1 = select(fresh, block.friction_1, old.friction_1);
  block.friction_2 = select(fresh, block.friction_2, old.friction_2);
  block.twist = select(fresh, block.twist, old.twist);
  block.sliding = select(fresh, block.sliding, old.sliding);
  block.fresh = Wide<W>(0.0f);
  block.has_fresh = 0;
  pair.linear_a = select<W>(fresh, pair.linear_a, old_pair.linear_a);
  pair.angular_a = select<W>(fresh, pair.angular_a, old_pair.angular_a);
  pair.linear_b = select<W>(fresh, pair.linear_b, old_pair.linear_b);
  pair.angular_b = select<W>(fresh, pair.angular_b, old_pair.angular_b);
}

// Normals last: what bodies move with then closes nowhere; an error of the slip does no harm.
template <int W>
void solve_blocks(void* memory, int begin, int end, BodyMotion* motion, float substep) {
  auto* blocks = static_cast<ContactBlock<W>*>(memory);
  for (int i = begin; i < end; ++i) {
    ContactBlock<W>& block = blocks[i];
    Wide<W> a[kMotionFloats], b[kMotionFloats];
    load_pair<W>(block, motion, a, b);
    PairMotion<W> pair = velocities<W>(a, b);
    if (block.has_fresh != 0) strike_fresh<W>(block, pair, a, b, substep);
    if (block.rolls != 0) solve_rolling<W>(block, pair);
    solve_friction<W>(block, pair);
    solve_normals<W, true>(block, pair, a, b, substep);
    for (int k = 0; k < block.point_count; ++k) block.points[k].total = block.points[k].total + block.points[k].impulse;
    block.total_1 = block.total_1 + block.friction_1;
    block.total_2 = block.total_2 + block.friction_2;
    store_pair<W>(block, motion, pair, a, b);
  }
}

// Once, at the end of a step.
template <int W>
void relax_blocks(void* memory, int begin, int end, BodyMotion* motion, float substep) {
  auto* blocks = static_cast<ContactBlock<W>*>(memory);
  for (int i = begin; i < end; ++i) {
    ContactBlock<W>& block = blocks[i];
    Wide<W> a[kMotionFloats], b[kMotionFloats];
    load_pair<W>(block, motion, a, b);
    PairMotion<W> pair = velocities<W>(a, b);
    const Wide<W> friction_1 = block.friction_1, friction_2 = block.friction_2;
    Wide<W> impulses[kMaxManifoldPoints];
    for (int k = 0; k < block.point_count; ++k) impulses[k] = block.points[k].impulse;
    if (block.rolls != 0) solve_rolling<W>(block, pair);
    solve_friction<W>(block, pair);
    solve_normals<W, false>(block, pair, a, b, substep);
    for (int k = 0; k < block.point_count; ++k) {
      block.points[k].total = block.points[k].total + (block.points[k].impulse - impulses[k]);
    }
    block.total_1 = block.total_1 + (block.friction_1 - friction_1);
    block.total_2 = block.total_2 + (block.friction_2 - friction_2);
    store_pair<W>(block, motion, pair, a, b);
  }
}

}  // namespace GYRE_TARGET_NAMESPACE
}  // namespace gyre
