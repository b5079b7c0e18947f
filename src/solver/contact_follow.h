// Takes the points of a contact along within the step: what rolls touches elsewhere in each sub-step, and what it weighs on
// follows (rigid/rolling.h says where). One lane at a time, the same operations for every width. Part of the kernels.
//
// The impulses that stand go on acting, but at the new place: what they turn changes by
//   I'^-1 (r' x p) - I^-1 (r x p)
// without which they would turn the bodies as if the contact had stayed behind. They act where the contact is as the sub-step
// begins, but the speeds that they bring about are those of its middle: so what the contact's own motion takes at the one end
// it gives back at the other, as in the leapfrog scheme. With one arm for both, rolling would lose energy to the first order.
#pragma once

#include "solver/contact_prepare.h"

namespace gyre {
inline namespace GYRE_TARGET_NAMESPACE {

GYRE_INLINE Vec3W<1> one_lane(Vec3 v) { return {Wide<1>(v.x), Wide<1>(v.y), Wide<1>(v.z)}; }
GYRE_INLINE Sym3W<1> one_lane(const Sym3& m) {
  return {Wide<1>(m.xx), Wide<1>(m.yy), Wide<1>(m.zz), Wide<1>(m.xy), Wide<1>(m.xz), Wide<1>(m.yz)};
}
template <int W>
GYRE_INLINE Wide<1> one_lane(const Wide<W>& wide, int lane) {
  return Wide<1>(wide[lane]);
}
template <int W>
GYRE_INLINE Vec3W<1> one_lane(const Vec3W<W>& v, int lane) {
  return {one_lane<W>(v.x, lane), one_lane<W>(v.y, lane), one_lane<W>(v.z, lane)};
}
template <int W>
GYRE_INLINE Sym3W<1> one_lane(const Sym3W<W>& m, int lane) {
  return {one_lane<W>(m.xx, lane), one_lane<W>(m.yy, lane), one_lane<W>(m.zz, lane),
          one_lane<W>(m.xy, lane), one_lane<W>(m.xz, lane), one_lane<W>(m.yz, lane)};
}
template <int W>
GYRE_INLINE void put_lane(Wide<W>& wide, int lane, const Wide<1>& value) {
  wide.set(lane, value[0]);
}
template <int W>
GYRE_INLINE void put_lane(Vec3W<W>& wide, int lane, const Vec3W<1>& v) {
  put_lane<W>(wide.x, lane, v.x), put_lane<W>(wide.y, lane, v.y), put_lane<W>(wide.z, lane, v.z);
}
template <int W>
GYRE_INLINE void put_lane(Sym3W<W>& wide, int lane, const Sym3W<1>& m) {
  put_lane<W>(wide.xx, lane, m.xx), put_lane<W>(wide.yy, lane, m.yy), put_lane<W>(wide.zz, lane, m.zz);
  put_lane<W>(wide.xy, lane, m.xy), put_lane<W>(wide.xz, lane, m.xz), put_lane<W>(wide.yz, lane, m.yz);
}

// What a lane has that does not depend on where its points are.
template <int W>
void take_lane(const ContactBlock<W>& block, int lane, int count, ContactBlock<1>& one) {
  one.point_count = count;
  one.has_a = block.has_a >> lane & 1u, one.has_b = block.has_b >> lane & 1u;
  one.normal = one_lane<W>(block.normal, lane);
  one.tangent_1 = one_lane<W>(block.tangent_1, lane);
  one.tangent_2 = one_lane<W>(block.tangent_2, lane);
  one.inverse_mass_a = one_lane<W>(block.inverse_mass_a, lane);
  one.inverse_mass_b = one_lane<W>(block.inverse_mass_b, lane);
  one.inverse_inertia_a = one_lane<W>(block.inverse_inertia_a, lane);
  one.inverse_inertia_b = one_lane<W>(block.inverse_inertia_b, lane);
  one.friction_1 = one_lane<W>(block.friction_1, lane);
  one.friction_2 = one_lane<W>(block.friction_2, lane);
  one.twist = one_lane<W>(block.twist, lane);
  one.twist_radius = one_lane<W>(block.twist_radius, lane);
  one.rolling = one_lane<W>(block.rolling, lane);
  for (int k = 0; k < count; ++k) one.points[k].impulse = one_lane<W>(block.points[k].impulse, lane);
}

template <int W>
void put_lane_back(ContactBlock<W>& block, int lane, const ContactBlock<1>& one, const FollowedArms& arms) {
  put_lane<W>(block.inverse_inertia_a, lane, one.inverse_inertia_a);
  put_lane<W>(block.inverse_inertia_b, lane, one.inverse_inertia_b);
  put_lane<W>(block.friction_from_a, lane, one.friction_from_a);
  put_lane<W>(block.friction_from_b, lane, one.friction_from_b);
  put_lane<W>(block.inverse_k11, lane, one.inverse_k11),
      put_lane<W>(block.inverse_k12, lane, one.inverse_k12);
  put_lane<W>(block.inverse_k13, lane, one.inverse_k13),
      put_lane<W>(block.inverse_k22, lane, one.inverse_k22);
  put_lane<W>(block.inverse_k23, lane, one.inverse_k23),
      put_lane<W>(block.inverse_k33, lane, one.inverse_k33);
  put_lane<W>(block.arm_shift_a, lane, one.arm_shift_a);
  put_lane<W>(block.arm_shift_b, lane, one.arm_shift_b);
  for (int i = 0; i < arms.count; ++i) {
    put_lane<W>(block.points[i].arm, lane, one.points[i].arm);
    block.points[i].separation.set(lane, arms.separation[i]);
    put_lane<W>(block.relief[i], lane, one.relief[i]);
    for (int j = i; j < arms.count; ++j) {
      put_lane<W>(block.k[packed(i, j)], lane, one.k[packed(i, j)]);
      put_lane<W>(block.inverse_k[packed(i, j)], lane, one.inverse_k[packed(i, j)]);
    }
  }
}

// Where friction acts: where the load does, or at the lowest point where nothing bears any.
struct FrictionArms {
  Vec3 from_a, from_b;
};
inline FrictionArms friction_arms(const ContactBlock<1>& one, const PointArmPairs& arms,
                                  const FollowedArms& followed) {
  int lowest = 0;
  float load = 0.0f;
  for (int k = 0; k < followed.count; ++k) {
    load += one.points[k].impulse[0];
    if (followed.separation[k] < followed.separation[lowest]) lowest = k;
  }
  if (!(load > 0.0f)) return {arms.from_a[lowest], arms.from_b[lowest]};
  FrictionArms at;
  for (int k = 0; k < followed.count; ++k) {
    const float share = one.points[k].impulse[0] / load;
    at.from_a += share * arms.from_a[k];
    at.from_b += share * arms.from_b[k];
  }
  return at;
}

// How the impulses that stand turn the two bodies about their centres of mass (N m s) with these arms.
struct LaneTorques {
  Vec3W<1> a, b;
};
inline LaneTorques torques_of(const ContactBlock<1>& one, const PointArmPairs& arms,
                              const FollowedArms& followed) {
  const FrictionArms friction = friction_arms(one, arms, followed);
  const Vec3W<1> slide = one.friction_1 * one.tangent_1 + one.friction_2 * one.tangent_2;
  const Vec3W<1> turn = one.twist * one.normal + one.rolling;
  LaneTorques torques{cross(one_lane(friction.from_a), slide) + turn,
                      cross(one_lane(friction.from_b), slide) + turn};
  for (int k = 0; k < followed.count; ++k) {
    const Vec3W<1> push = one.points[k].impulse * one.normal;
    torques.a = torques.a + cross(one_lane(arms.from_a[k]), push);
    torques.b = torques.b + cross(one_lane(arms.from_b[k]), push);
  }
  return torques;
}

inline void turn_body(float* record, const Vec3W<1>& before, const Vec3W<1>& after) {
  float* const spin = record + kMotionAngular;
  spin[0] += after.x[0] - before.x[0];
  spin[1] += after.y[0] - before.y[0];
  spin[2] += after.z[0] - before.z[0];
}

template <int W>
void follow_lane(void* memory, int index, int lane, const FollowedArms& arms, const Sym3* inverse_a,
                 const Sym3* inverse_b) {
  ContactBlock<W>& block = static_cast<ContactBlock<W>*>(memory)[index];
  ContactBlock<1> one{};
  take_lane<W>(block, lane, arms.count, one);
  const LaneTorques before = torques_of(one, arms.before, arms), now = torques_of(one, arms.now, arms);
  const Vec3W<1> before_a = one.inverse_inertia_a * before.a, before_b = one.inverse_inertia_b * before.b;
  if (inverse_a != nullptr) one.inverse_inertia_a = one_lane(*inverse_a);
  if (inverse_b != nullptr) one.inverse_inertia_b = one_lane(*inverse_b);
  turn_body(block.write_a[lane], one.inverse_inertia_a * now.a, before_a);  // a gets the opposite
  turn_body(block.write_b[lane], before_b, one.inverse_inertia_b * now.b);
  Wide<1> exists[kMaxManifoldPoints];
  auto nearer_a = Wide<1>(0.0f) < Wide<1>(1.0f);
  for (int k = 0; k < kMaxManifoldPoints; ++k) {
    exists[k] = Wide<1>(k < arms.count ? 1.0f : 0.0f);
    if (k >= arms.count) continue;
    const PointArms<1> point{one_lane(arms.middle.from_a[k]), one_lane(arms.middle.from_b[k])};
    if (k == 0) nearer_a = place_arms<1>(one, point);
    one.points[k].arm = cross(select<1>(nearer_a, point.from_a, point.from_b), one.normal);
  }
  const FrictionArms friction = friction_arms(one, arms.middle, arms);
  one.friction_from_a = one_lane(friction.from_a);
  one.friction_from_b = one_lane(friction.from_b);
  auto twists = nearer_a;
  prepare_friction_masses<1>(one, one.twist_radius > Wide<1>(0.0f), twists);
  prepare_normals<1>(one, exists);
  put_lane_back<W>(block, lane, one, arms);
  block.idles = 0;
}

}  // namespace GYRE_TARGET_NAMESPACE
}  // namespace gyre
