// Fills contact blocks from manifolds as the step begins, and reads impulses back as it ends. Part of the kernels (one
// template for every width); apart from contact_kernel.h because it runs once a step and is scalar by nature.
#pragma once

#include "solver/contact_kernel.h"
#include "solver/contact_project.h"

namespace gyre {
inline namespace GYRE_TARGET_NAMESPACE {

// The overlap that springs draw their points to, as a share of the size: loaded points then stay in touch.
constexpr float kSpringSlop = 4.0e-4f;
// How much of the lower body's mobility is denied to it where a contact faces straight up.
constexpr float kLowerShare = 0.7f;
// A point gets used to its load as a mean over its age: of at least the first time (s), of at most the second.
constexpr float kShortestMean = 0.5f;
constexpr float kLongestMean = 1.0f;

// What one lane needs, in scalars. Everything here is computed once per manifold and step.
struct LaneFriction {
  Vec3 from_a, from_b;        // centre of pressure
  float twist_radius = 0.0f;  // m: mean lever arm of a patch of uniform pressure under the points
};

// The centre of pressure and the patch's mean lever arm. Points weigh by the load they carried; where nothing bore load
// yet, those that touch count. The share of lever arm: a uniform square's mean distance from its centre is 0.541 of its
// corners', a uniform segment's half of its ends'.
inline LaneFriction pressure_patch(const Manifold& manifold) {
  float weights[kMaxManifoldPoints];
  float sum = 0.0f;
  float nearest = manifold.points[0].separation;
  for (int k = 1; k < manifold.count; ++k) nearest = gyre::min(nearest, manifold.points[k].separation);
  for (int k = 0; k < manifold.count; ++k) sum += weights[k] = manifold.points[k].normal_impulse;
  if (!(sum > 0.0f)) {
    // A point counts less the farther it is above the lowest, in units of the manifold's extent.
    float extent = 0.0f;
    for (int k = 1; k < manifold.count; ++k) {
      extent = gyre::max(extent, length(manifold.points[k].from_a - manifold.points[0].from_a));
    }
    const float fade = extent > 0.0f ? 100.0f / extent : 0.0f;
    for (int k = 0; k < manifold.count; ++k) {
      const float above = fade * (manifold.points[k].separation - nearest);
      sum += weights[k] = 1.0f / (1.0f + above * above);
    }
  }
  LaneFriction patch;
  for (int k = 0; k < manifold.count; ++k) {
    const float share = weights[k] / sum;
    patch.from_a += share * manifold.points[k].from_a;
    patch.from_b += share * manifold.points[k].from_b;
  }
  float arm = 0.0f;
  for (int k = 0; k < manifold.count; ++k) {
    arm += weights[k] / sum * length(manifold.points[k].from_a - patch.from_a);
  }
  patch.twist_radius = (manifold.count > 2 ? 0.541f : 0.5f) * arm;
  return patch;
}

template <int W>
void set_lane(Wide<W>& wide, int lane, float value) {
  wide.set(lane, value);
}
template <int W>
float get_lane(const Wide<W>& wide, int lane) {
  // Adding zero makes -0 from a lane that rested be the 0 that a narrower kernel would have.
  return wide[lane] + 0.0f;
}
template <int W>
void set_lane(Vec3W<W>& wide, int lane, Vec3 v) {
  set_lane(wide.x, lane, v.x);
  set_lane(wide.y, lane, v.y);
  set_lane(wide.z, lane, v.z);
}
template <int W>
void set_lane(Sym3W<W>& wide, int lane, const Sym3& m) {
  set_lane(wide.xx, lane, m.xx);
  set_lane(wide.yy, lane, m.yy);
  set_lane(wide.zz, lane, m.zz);
  set_lane(wide.xy, lane, m.xy);
  set_lane(wide.xz, lane, m.xz);
  set_lane(wide.yz, lane, m.yz);
}
template <int W>
Vec3 get_lane(const Vec3W<W>& wide, int lane) {
  return {get_lane(wide.x, lane), get_lane(wide.y, lane), get_lane(wide.z, lane)};
}

// Effective mass matrix of the friction rows and its inverse; the twist row is left out where it has no lever arm.
template <int W>
void prepare_friction(ContactBlock<W>& block, int lane, const ContactConstraint& constraint, const BodyInertia& a,
                      const BodyInertia& b, Vec3 normal, Vec3 t1, Vec3 t2) {
  const Manifold& manifold = *constraint.manifold;
  const LaneFriction patch = pressure_patch(manifold);
  const Vec3 a1 = cross(patch.from_a, t1), a2 = cross(patch.from_a, t2);
  const Vec3 b1 = cross(patch.from_b, t1), b2 = cross(patch.from_b, t2);
  const Vec3 ia1 = a.inverse * a1, ia2 = a.inverse * a2, ian = a.inverse * normal;
  const Vec3 ib1 = b.inverse * b1, ib2 = b.inverse * b2, ibn = b.inverse * normal;
  const float inverse_masses = a.inverse_mass + b.inverse_mass;
  Sym3 k;
  k.xx = inverse_masses + dot(a1, ia1) + dot(b1, ib1);
  k.yy = inverse_masses + dot(a2, ia2) + dot(b2, ib2);
  k.xy = dot(a1, ia2) + dot(b1, ib2);
  k.zz = dot(normal, ian) + dot(normal, ibn);
  k.xz = dot(a1, ian) + dot(b1, ibn);
  k.yz = dot(a2, ian) + dot(b2, ibn);
  const float radius = patch.twist_radius;
  const float twist_static = constraint.static_friction * radius + constraint.spinning_friction;
  const float twist_dynamic = constraint.dynamic_friction * radius + constraint.spinning_friction;
  const bool twists = twist_static > 0.0f && k.zz > 0.0f;
  if (!twists) k.xz = k.yz = 0.0f, k.zz = 1.0f;
  Sym3 inverse_k = inverse(k);
  if (!twists) inverse_k.zz = 0.0f;
  set_lane(block.friction_from_a, lane, patch.from_a);
  set_lane(block.friction_from_b, lane, patch.from_b);
  set_lane(block.inverse_k11, lane, inverse_k.xx);
  set_lane(block.inverse_k22, lane, inverse_k.yy);
  set_lane(block.inverse_k33, lane, inverse_k.zz);
  set_lane(block.inverse_k12, lane, inverse_k.xy);
  set_lane(block.inverse_k13, lane, inverse_k.xz);
  set_lane(block.inverse_k23, lane, inverse_k.yz);
  // The scale at which a twist of 1 rad/s slips like a metre per second; with it the largest eigenvalue of K is bounded by
  // its trace, and the inverse of half of it is a safe common step.
  const float scale = twists && constraint.dynamic_friction > 0.0f ? twist_dynamic / constraint.dynamic_friction : radius;
  const float bound = gyre::max(gyre::max(k.xx, k.yy) + gyre::absolute(k.xy), twists ? square(scale) * k.zz : 0.0f);
  set_lane(block.twist_radius, lane, twists ? scale : 0.0f);
  set_lane(block.slide_mass, lane, bound > 0.0f ? 1.0f / bound : 0.0f);
  set_lane(block.static_friction, lane, constraint.static_friction);
  set_lane(block.dynamic_friction, lane, constraint.dynamic_friction);
  set_lane(block.twist_per_normal_static, lane, twists ? twist_static : 0.0f);
  set_lane(block.twist_per_normal_dynamic, lane, twists ? twist_dynamic : 0.0f);
  set_lane(block.surface_1, lane, dot(constraint.surface_velocity, t1));
  set_lane(block.surface_2, lane, dot(constraint.surface_velocity, t2));
}

// K of the normal rows and its inverse. Four points of a plane give rank 3 at most, so the inverse is of K with its
// diagonal raised by a share: the impulses that no motion can tell apart then change least.
template <int W>
void prepare_normals(ContactBlock<W>& block, int lane, const Manifold& manifold, const BodyInertia& a, const BodyInertia& b) {
  constexpr float kRegular = 0.02f;
  const int count = manifold.count;
  Vec3 ja[kMaxManifoldPoints], jb[kMaxManifoldPoints];
  float l[4][4] = {};  // Cholesky factor of the regularised K
  float k[4][4] = {};
  for (int i = 0; i < count; ++i) {
    ja[i] = cross(manifold.points[i].from_a, manifold.normal);
    jb[i] = cross(manifold.points[i].from_b, manifold.normal);
    const Vec3 ia = a.inverse * ja[i], ib = b.inverse * jb[i];
    for (int j = 0; j <= i; ++j) k[i][j] = k[j][i] = a.inverse_mass + b.inverse_mass + dot(ja[j], ia) + dot(jb[j], ib);
  }
  for (int i = 0; i < count; ++i) {
    for (int j = 0; j <= i; ++j) {
      float sum = i == j ? k[i][i] * (1.0f + kRegular) : k[i][j];
      for (int m = 0; m < j; ++m) sum -= l[i][m] * l[j][m];
      if (i == j) {
        l[i][i] = sum > 0.0f ? std::sqrt(sum) : 1.0f;
      } else {
        l[i][j] = sum / l[j][j];
      }
    }
  }
  // Columns of the inverse, by forward and back substitution.
  for (int column = 0; column < count; ++column) {
    float x[4] = {};
    for (int i = 0; i < count; ++i) {
      float sum = i == column ? 1.0f : 0.0f;
      for (int m = 0; m < i; ++m) sum -= l[i][m] * x[m];
      x[i] = sum / l[i][i];
    }
    for (int i = count - 1; i >= 0; --i) {
      float sum = x[i];
      for (int m = i + 1; m < count; ++m) sum -= l[m][i] * x[m];
      x[i] = sum / l[i][i];
    }
    for (int i = 0; i <= column; ++i) {
      set_lane(block.k[packed(i, column)], lane, k[i][column]);
      set_lane(block.inverse_k[packed(i, column)], lane, x[i]);
    }
    set_lane(block.relief[column], lane, k[column][column] > 0.0f ? 1.0f / k[column][column] : 0.0f);
  }
}

// How soft the lane's contact is, and who gives way when overlap is pushed apart: what lies on top, as far as the contact
// faces up. So a heap is freed from below in few passes, as if the lower body were much heavier (E. Guendelman, R. Bridson,
// R. Fedkiw, "Nonconvex Rigid Bodies with Stacking", 2003, calls it shock propagation).
template <int W>
void prepare_softness(ContactBlock<W>& block, int lane, const ContactConstraint& constraint, const ContactSettings& settings) {
  const Manifold& manifold = *constraint.manifold;
  const float youth = settings.aging / (settings.aging + manifold.age);
  set_lane(block.rate, lane, youth * settings.rate);
  set_lane(block.give, lane, constraint.rigid ? 0.0f : youth * settings.give);
  set_lane(block.slop, lane, kSpringSlop * constraint.size);
  set_lane(block.push_speed, lane, constraint.push_speed);
  const bool fixed = block.write_a[lane] == kNoBody || block.write_b[lane] == kNoBody;
  const float rise = fixed ? 0.0f : kLowerShare * dot(manifold.normal, settings.up);
  set_lane(block.mobility_a, lane, 1.0f - gyre::max(rise, 0.0f));
  set_lane(block.mobility_b, lane, 1.0f + gyre::min(rise, 0.0f));
}

template <int W>
void prepare_lane(ContactBlock<W>& block, int lane, const ContactConstraint& constraint, ContactBodies bodies,
                  const ContactSettings& settings) {
  static constexpr BodyInertia kImmovable{};
  const Manifold& manifold = *constraint.manifold;
  const BodyInertia& a = constraint.body_a == kNoBody ? kImmovable : bodies.inertia[constraint.body_a];
  const BodyInertia& b = constraint.body_b == kNoBody ? kImmovable : bodies.inertia[constraint.body_b];
  block.read_a[lane] = constraint.body_a;
  block.read_b[lane] = constraint.body_b;
  block.write_a[lane] = a.inverse_mass > 0.0f || a.inverse != Sym3{} ? constraint.body_a : kNoBody;
  block.write_b[lane] = b.inverse_mass > 0.0f || b.inverse != Sym3{} ? constraint.body_b : kNoBody;
  const Vec3 normal = manifold.normal;
  const Vec3 t1 = any_perpendicular(normal);
  const Vec3 t2 = cross(normal, t1);
  set_lane(block.normal, lane, normal);
  set_lane(block.tangent_1, lane, t1);
  set_lane(block.tangent_2, lane, t2);
  set_lane(block.inverse_mass_a, lane, a.inverse_mass);
  set_lane(block.inverse_mass_b, lane, b.inverse_mass);
  set_lane(block.inverse_inertia_a, lane, a.inverse);
  set_lane(block.inverse_inertia_b, lane, b.inverse);
  prepare_softness<W>(block, lane, constraint, settings);
  prepare_friction<W>(block, lane, constraint, a, b, normal, t1, t2);
  const Vec3 friction = settings.warm_scale * manifold.friction_impulse;
  set_lane(block.friction_1, lane, dot(friction, t1));
  set_lane(block.friction_2, lane, dot(friction, t2));
  set_lane(block.twist, lane, settings.warm_scale * manifold.twist_impulse);
  set_lane(block.sliding, lane, float(manifold.sliding));
  bool bears = false;
  for (int k = 0; k < manifold.count; ++k) bears = bears || manifold.points[k].normal_impulse > 0.0f;
  set_lane(block.fresh, lane, bears ? 0.0f : 1.0f);
  if (!bears) block.has_fresh = 1;
  set_lane(block.rolling_friction, lane, constraint.rolling_friction);
  const float turning = (a.inverse.xx + a.inverse.yy + a.inverse.zz) + (b.inverse.xx + b.inverse.yy + b.inverse.zz);
  set_lane(block.rolling_mass, lane, turning > 0.0f ? 1.0f / turning : 0.0f);
  // A surface that ceased to brake rolling starts from nothing: otherwise it would depend on the lanes beside it whether
  // the old impulse acts once more.
  const bool rolls = constraint.rolling_friction > 0.0f;
  set_lane(block.rolling, lane, rolls ? settings.warm_scale * manifold.rolling_impulse : Vec3{});
  if (rolls) block.rolls = 1;
  prepare_normals<W>(block, lane, manifold, a, b);
  if (manifold.count > block.point_count) block.point_count = manifold.count;
  for (int k = 0; k < manifold.count; ++k) {
    const ContactPointState& from = manifold.points[k];
    PointBlock<W>& point = block.points[k];
    set_lane(point.from_a, lane, from.from_a);
    set_lane(point.from_b, lane, from.from_b);
    set_lane(point.separation, lane, from.separation);
    set_lane(point.impulse, lane, settings.warm_scale * from.normal_impulse);
    set_lane(point.held, lane, settings.warm_scale * from.held);
  }
}

template <int W>
void prepare_blocks(void* memory, int begin, int end, const ContactConstraint* constraints, const std::uint32_t* order,
                    ContactBodies bodies, const ContactSettings& settings) {
  auto* blocks = static_cast<ContactBlock<W>*>(memory);
  for (int i = begin; i < end; ++i) {
    ContactBlock<W>& block = blocks[i];
    block = ContactBlock<W>{};
    for (int lane = 0; lane < W; ++lane) {
      const std::uint32_t index = order[i * W + lane];
      block.read_a[lane] = block.read_b[lane] = block.write_a[lane] = block.write_b[lane] = kNoBody;
      if (index != 0xffffffffu) prepare_lane<W>(block, lane, constraints[index], bodies, settings);
    }
  }
}

// The loads of a manifold are in: its age, and what its points are used to.
inline void age_manifold(Manifold& manifold, const ContactSettings& settings) {
  bool bears = false;
  for (int k = 0; k < manifold.count; ++k) bears = bears || manifold.points[k].normal_impulse > 0.0f;
  manifold.age = bears ? manifold.age + settings.step : 0.0f;
  const float mean = gyre::min(gyre::max(manifold.age, kShortestMean), kLongestMean);
  const float gain = gyre::min(settings.step / mean, 1.0f);
  for (int k = 0; k < manifold.count; ++k) {
    ContactPointState& point = manifold.points[k];
    point.held = point.normal_impulse > 0.0f ? point.held + gain * (point.normal_impulse - point.held) : 0.0f;
  }
}

template <int W>
void finish_blocks(void* memory, int begin, int end, const ContactConstraint* constraints, const std::uint32_t* order,
                   const ContactSettings& settings) {
  auto* blocks = static_cast<ContactBlock<W>*>(memory);
  for (int i = begin; i < end; ++i) {
    const ContactBlock<W>& block = blocks[i];
    for (int lane = 0; lane < W; ++lane) {
      const std::uint32_t index = order[i * W + lane];
      if (index == 0xffffffffu) continue;
      Manifold& manifold = *constraints[index].manifold;
      const Vec3 t1 = get_lane(block.tangent_1, lane), t2 = get_lane(block.tangent_2, lane);
      manifold.friction_impulse = get_lane(block.friction_1, lane) * t1 + get_lane(block.friction_2, lane) * t2;
      manifold.total_friction = get_lane(block.total_1, lane) * t1 + get_lane(block.total_2, lane) * t2;
      manifold.twist_impulse = get_lane(block.twist, lane);
      manifold.rolling_impulse = get_lane(block.rolling, lane);
      manifold.sliding = get_lane(block.sliding, lane) > 0.0f ? 1u : 0u;
      for (int k = 0; k < manifold.count; ++k) {
        manifold.points[k].normal_impulse = get_lane(block.points[k].impulse, lane);
        manifold.points[k].total_impulse += get_lane(block.points[k].total, lane);
      }
      age_manifold(manifold, settings);
    }
  }
}

template <int W>
void read_block_impulse(const void* memory, int index, int lane, ContactImpulse& impulse) {
  const ContactBlock<W>& block = static_cast<const ContactBlock<W>*>(memory)[index];
  for (int k = 0; k < kMaxManifoldPoints; ++k) impulse.normal[k] = get_lane(block.points[k].impulse, lane);
  impulse.friction = get_lane(block.friction_1, lane) * get_lane(block.tangent_1, lane) +
                     get_lane(block.friction_2, lane) * get_lane(block.tangent_2, lane);
  impulse.twist = get_lane(block.twist, lane);
  impulse.rolling = get_lane(block.rolling, lane);
  impulse.friction_from_b = get_lane(block.friction_from_b, lane);
  impulse.twist_per_normal = get_lane(block.twist_per_normal_static, lane);
}

template <int W>
void write_block_impulse(void* memory, int index, int lane, const ContactImpulse& impulse) {
  ContactBlock<W>& block = static_cast<ContactBlock<W>*>(memory)[index];
  // The sums over the step count what stands in the end.
  const auto replace = [lane](Wide<W>& present, Wide<W>& total, float value) {
    set_lane(total, lane, get_lane(total, lane) + (value - get_lane(present, lane)));
    set_lane(present, lane, value);
  };
  for (int k = 0; k < kMaxManifoldPoints; ++k) replace(block.points[k].impulse, block.points[k].total, impulse.normal[k]);
  replace(block.friction_1, block.total_1, dot(impulse.friction, get_lane(block.tangent_1, lane)));
  replace(block.friction_2, block.total_2, dot(impulse.friction, get_lane(block.tangent_2, lane)));
  set_lane(block.twist, lane, impulse.twist);
  set_lane(block.rolling, lane, impulse.rolling);
  set_lane(block.sliding, lane, 0.0f);
}

// The table that a kernel file exports.
template <int W>
constexpr ContactKernels contact_kernels() {
  return {W,
          sizeof(ContactBlock<W>),
          prepare_blocks<W>,
          warm_start_blocks<W>,
          solve_blocks<W>,
          relax_blocks<W>,
          project_blocks<W>,
          read_block_impulse<W>,
          write_block_impulse<W>,
          finish_blocks<W>};
}

}  // namespace GYRE_TARGET_NAMESPACE
}  // namespace gyre
