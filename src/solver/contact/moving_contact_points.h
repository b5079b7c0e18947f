// Moves the points of a contact within the step: a rolling body touches elsewhere in each sub-step, and its
// load follows (rigid/solve/rolling_contacts.h says where). The moving lanes of a block are handled side by
// side. Part of the kernels.
//
// The accumulated impulses keep acting, but at the new points. Their angular effect changes by
//
// I'^-1 (r' x p) - I^-1 (r x p).
//
// Without this change they would act on the old contact, and friction given at one end of a bone would be
// removed at the other, once the load lies there. Impulses act at the points of the beginning of the
// sub-step, but speeds are measured at those of its middle. So the motion of the contact takes at one end
// what it gives at the other, as in the leapfrog scheme; with one arm for both, rolling would lose energy to
// first order.
#pragma once

#include "solver/contact/contact_prepare.h"

#include <cstddef>

namespace gyre {
inline namespace GYRE_TARGET_NAMESPACE {

// Offsets of the arms in AdvancedArms, in floats.
constexpr int kArmsMiddle = 0, kArmsBefore = 24, kArmsNow = 48, kArmsSeparation = 72, kArmsShares = 76;
static_assert(offsetof(AdvancedArms, before) == 4 * kArmsBefore &&
              offsetof(AdvancedArms, now) == 4 * kArmsNow);
static_assert(offsetof(AdvancedArms, middle) == 0 &&
              offsetof(AdvancedArms, separation) == 4 * kArmsSeparation);
static_assert(offsetof(AdvancedArms, friction_shares) == 4 * kArmsShares);
static_assert(sizeof(PointArmPairs) == 4 * kArmsBefore && offsetof(PointArmPairs, from_b) == 48);

// The moving lanes of a block. Other lanes read zeros, and their results are discarded.
template <int W>
struct AdvancedArmsLanes {
  const float* arms[W];
  const float* inverse_a[W];
  const float* inverse_b[W];
  std::uint32_t bits = 0, has_a = 0, has_b = 0;  // has_a: lanes whose inertia is known
  Wide<W> counts{0.0f};
  int point_count = 0;  // the largest of any lane

  GYRE_INLINE AdvancedArmsLanes(const AdvancedArmsLane* lanes, int count) {
    alignas(64) static constexpr float kNoArms[sizeof(AdvancedArms) / sizeof(float)] = {};
    for (int i = 0; i < W; ++i) arms[i] = inverse_a[i] = inverse_b[i] = kNoArms;
    for (int i = 0; i < count; ++i) {
      const AdvancedArmsLane& moving = lanes[i];
      const int lane = moving.lane;
      bits |= 1u << lane;
      arms[lane] = &moving.arms->middle.from_a[0].x;
      if (moving.inverse_a != nullptr) inverse_a[lane] = &moving.inverse_a->xx, has_a |= 1u << lane;
      if (moving.inverse_b != nullptr) inverse_b[lane] = &moving.inverse_b->xx, has_b |= 1u << lane;
      counts.set(lane, float(moving.arms->count));
      if (moving.arms->count > point_count) point_count = moving.arms->count;
    }
  }
  GYRE_INLINE Mask<W> has_point(int k) const { return counts > Wide<W>(float(k)); }
};

template <int W>
GYRE_INLINE Vec3W<W> gather_vector(const float* const (&records)[W], int first) {
  Wide<W> in[4];
  gather_columns<4, W>(records, first, in);
  return {in[0], in[1], in[2]};
}
template <int W>
GYRE_INLINE Sym3W<W> gather_tensor(const float* const (&records)[W]) {
  Wide<W> in[8];
  gather_columns<4, W>(records, 0, in);
  gather_columns<4, W>(records, 2, in + 4);
  return {in[0], in[1], in[2], in[3], in[6], in[7]};
}
template <int W>
GYRE_INLINE PointArms<W> gather_arms(const AdvancedArmsLanes<W>& lanes, int set, int k) {
  return {gather_vector<W>(lanes.arms, set + 3 * k), gather_vector<W>(lanes.arms, set + 12 + 3 * k)};
}

// Shares of the load among the points: friction acts where the load does, or at the lowest point without
// load.
template <int W>
struct LoadShares {
  Mask<W> exists[kMaxManifoldPoints];
  Wide<W> shares[kMaxManifoldPoints];

  GYRE_INLINE LoadShares(const ContactBlock<W>& block, const AdvancedArmsLanes<W>& lanes) {
    const Wide<W> zero(0.0f), one(1.0f);
    Wide<W> separations[kMaxManifoldPoints], load = zero;
    gather_columns<4, W>(lanes.arms, kArmsSeparation, separations);
    Wide<W> lowest_separation = separations[0];
    for (int k = 0; k < lanes.point_count; ++k) {
      exists[k] = lanes.has_point(k);
      lowest_separation = select(exists[k], min(lowest_separation, separations[k]), lowest_separation);
      load = load + keep(exists[k], block.impulses[k]);
    }
    const auto bears = load > zero;
    const Wide<W> divisor = select(bears, load, one);
    auto left = ~bears;
    for (int k = 0; k < lanes.point_count; ++k) {
      const auto lowest = left & exists[k] & (separations[k] <= lowest_separation);
      left = left & ~lowest;
      shares[k] = select(bears, keep(exists[k], block.impulses[k] / divisor), keep(lowest, one));
    }
  }
};

// Shares with which the accumulated friction was applied; at the beginning of a step those of the load.
template <int W>
GYRE_INLINE void previous_shares(const AdvancedArmsLanes<W>& lanes, const LoadShares<W>& now,
                                 Wide<W> (&before)[kMaxManifoldPoints]) {
  Wide<W> recorded[kMaxManifoldPoints], sum(0.0f);
  gather_columns<4, W>(lanes.arms, kArmsShares, recorded);
  for (int k = 0; k < lanes.point_count; ++k) sum = sum + recorded[k];
  for (int k = 0; k < lanes.point_count; ++k)
    before[k] = select(sum > Wide<W>(0.0f), recorded[k], now.shares[k]);
}

// The arm of friction, accumulated point by point.
template <int W>
struct FrictionArms {
  Vec3W<W> from_a{Wide<W>(0.0f), Wide<W>(0.0f), Wide<W>(0.0f)}, from_b = from_a;

  GYRE_INLINE void add(Wide<W> share, const PointArms<W>& arms) {
    from_a = from_a + share * arms.from_a;
    from_b = from_b + share * arms.from_b;
  }
};

// Angular impulses of the accumulated impulses about the centres of mass (N m s) with these arms.
template <int W>
struct LaneTorques {
  Vec3W<W> a, b;
};
template <int W>
GYRE_INLINE LaneTorques<W> torques_of(const ContactBlock<W>& block, const AdvancedArmsLanes<W>& lanes,
                                      const LoadShares<W>& load,
                                      const Wide<W> (&friction_shares)[kMaxManifoldPoints], int set) {
  PointArms<W> arms[kMaxManifoldPoints];
  FrictionArms<W> friction;
  for (int k = 0; k < lanes.point_count; ++k)
    friction.add(friction_shares[k], arms[k] = gather_arms<W>(lanes, set, k));
  const Vec3W<W> slide = block.friction_1 * block.tangent_1 + block.friction_2 * block.tangent_2;
  const Vec3W<W> torsion = block.twist * block.normal + block.cold->rolling;
  LaneTorques<W> torques{cross(friction.from_a, slide) + torsion, cross(friction.from_b, slide) + torsion};
  for (int k = 0; k < lanes.point_count; ++k) {
    const Vec3W<W> direction = block.impulses[k] * block.normal;
    torques.a = select<W>(load.exists[k], torques.a + cross(arms[k].from_a, direction), torques.a);
    torques.b = select<W>(load.exists[k], torques.b + cross(arms[k].from_b, direction), torques.b);
  }
  return torques;
}

template <int W>
GYRE_INLINE void add_spin(float* record, int lane, const Vec3W<W>& change) {
  float* const spin = record + kMotionAngular;
  spin[0] += change.x[lane];
  spin[1] += change.y[lane];
  spin[2] += change.z[lane];
}

// Copies the data that decide the masses.
template <int W>
GYRE_INLINE void copy_bodies(const ContactBlock<W>& from, ContactBlock<W>& to) {
  to.has_a = from.has_a, to.has_b = from.has_b;
  to.normal = from.normal, to.tangent_1 = from.tangent_1, to.tangent_2 = from.tangent_2;
  to.inverse_mass_a = from.inverse_mass_a, to.inverse_mass_b = from.inverse_mass_b;
  to.locked = from.locked;
  if (from.locked != 0)
    to.cold->locked_mass_a = from.cold->locked_mass_a, to.cold->locked_mass_b = from.cold->locked_mass_b;
}

// Writes the moving lanes back into the block.
template <int W>
GYRE_INLINE void write_back(ContactBlock<W>& block, const ContactBlock<W>& updated,
                            const AdvancedArmsLanes<W>& lanes, const LoadShares<W>& load) {
  const auto moving = Mask<W>::of_bits(lanes.bits);
  const auto put = [](Mask<W> where, auto& to, const auto& from) { to = select(where, from, to); };
  const auto put_vector = [](Mask<W> where, Vec3W<W>& to, const Vec3W<W>& from) {
    to = select<W>(where, from, to);
  };
  put_vector(moving, block.friction_from_a, updated.friction_from_a);
  put_vector(moving, block.friction_from_b, updated.friction_from_b);
  put(moving, block.inverse_k11, updated.inverse_k11), put(moving, block.inverse_k12, updated.inverse_k12);
  put(moving, block.inverse_k13, updated.inverse_k13), put(moving, block.inverse_k22, updated.inverse_k22);
  put(moving, block.inverse_k23, updated.inverse_k23), put(moving, block.inverse_k33, updated.inverse_k33);
  put_vector(moving, block.arm_shift_a, updated.arm_shift_a);
  put_vector(moving, block.arm_shift_b, updated.arm_shift_b);
  Wide<W> separations[kMaxManifoldPoints];
  gather_columns<4, W>(lanes.arms, kArmsSeparation, separations);
  for (int i = 0; i < lanes.point_count; ++i) {
    put_vector(load.exists[i], block.points[i].arm, updated.points[i].arm);
    put(load.exists[i], block.points[i].separation, separations[i]);
    put(load.exists[i], block.cold->inverse_diagonal[i], updated.cold->inverse_diagonal[i]);
    block.rows[i] = lane_bits<W>(block.cold->inverse_diagonal[i] > Wide<W>(0.0f));
    for (int j = i; j < lanes.point_count; ++j) {
      put(load.exists[j], block.cold->k[packed(i, j)], updated.cold->k[packed(i, j)]);
      put(load.exists[j], block.inverse_k[packed(i, j)], updated.inverse_k[packed(i, j)]);
    }
  }
}

template <int W>
void advance_points(void* memory, int index, const AdvancedArmsLane* moving, int count) {
  ContactBlock<W>& block = static_cast<ContactBlock<W>*>(memory)[index];
  const AdvancedArmsLanes<W> lanes(moving, count);
  const LoadShares<W> load(block, lanes);
  Wide<W> friction_before[kMaxManifoldPoints];
  previous_shares<W>(lanes, load, friction_before);
  const LaneTorques<W> before = torques_of<W>(block, lanes, load, friction_before, kArmsBefore),
                       now = torques_of<W>(block, lanes, load, load.shares, kArmsNow);
  const Vec3W<W> before_a = block.inverse_inertia_a * before.a, before_b = block.inverse_inertia_b * before.b;
  const auto refresh = [](std::uint32_t bits, const Sym3W<W>& present, Sym3W<W>& old) {
    const auto known = Mask<W>::of_bits(bits);
    old = {select(known, present.xx, old.xx), select(known, present.yy, old.yy),
           select(known, present.zz, old.zz), select(known, present.xy, old.xy),
           select(known, present.xz, old.xz), select(known, present.yz, old.yz)};
  };
  refresh(lanes.has_a, gather_tensor<W>(lanes.inverse_a), block.inverse_inertia_a);
  refresh(lanes.has_b, gather_tensor<W>(lanes.inverse_b), block.inverse_inertia_b);
  const Vec3W<W> change_a = before_a - block.inverse_inertia_a * now.a,  // A gets the opposite
      change_b = block.inverse_inertia_b * now.b - before_b;
  for (int i = 0; i < count; ++i) {
    const int lane = moving[i].lane;
    add_spin<W>(block.cold->write_a[lane], lane, change_a);
    add_spin<W>(block.cold->write_b[lane], lane, change_b);
    for (int k = 0; k < lanes.point_count; ++k) moving[i].arms->friction_shares[k] = load.shares[k][lane];
  }
  ContactBlockCold<W> cold;
  ContactBlock<W> updated;
  updated.cold = &cold;
  copy_bodies<W>(block, updated);
  updated.inverse_inertia_a = block.inverse_inertia_a, updated.inverse_inertia_b = block.inverse_inertia_b;
  updated.point_count = lanes.point_count;
  const PointArms<W> first = gather_arms<W>(lanes, kArmsMiddle, 0);
  const auto nearer_a = choose_arm_origin<W>(updated, first);
  FrictionArms<W> friction;
  Wide<W> exists[kMaxManifoldPoints];
  for (int k = 0; k < lanes.point_count; ++k) {
    exists[k] = keep(load.exists[k], Wide<W>(1.0f));
    const PointArms<W> arms = k == 0 ? first : gather_arms<W>(lanes, kArmsMiddle, k);
    friction.add(load.shares[k], arms);
    updated.points[k].arm = cross(select<W>(nearer_a, arms.from_a, arms.from_b), block.normal);
  }
  updated.friction_from_a = friction.from_a, updated.friction_from_b = friction.from_b;
  auto twists = nearer_a;
  prepare_friction_masses<W>(updated, block.cold->twist_radius > Wide<W>(0.0f), twists);
  prepare_normals<W>(updated, exists);
  write_back<W>(block, updated, lanes, load);
  mark_uneven_points<W>(block);
  block.carried_a = std::uint16_t(block.carried_a & ~lanes.bits);
  block.carried_b = std::uint16_t(block.carried_b & ~lanes.bits);
  block.is_settled = 0;
}

}  // namespace GYRE_TARGET_NAMESPACE
}  // namespace gyre
