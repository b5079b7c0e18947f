// Makes neighbouring bones of a ragdoll similar enough in mass and inertia.
//
// Masses: with x = log mass, each joint requires |x_child - x_parent| <= log ratio. This is a convex set, and projection on its violated
// constraints in turn approaches it (Bregman, 1967). One factor for all masses then restores the sum and keeps the ratios. Inertias: from
// the leaves to the root, each inertia is scaled with its mass and raised by a multiple of the unit tensor. This raises all principal
// moments alike, and so a body can have the result.
#include "kit/ragdoll_frames.h"

namespace gyre::kit {

namespace {

// Relative tolerance of the ratios.
constexpr float kClose = 1.0e-4f;

float raised_least(const Vec3& moments, float max_ratio) {
  // (largest + s) <= ratio (smallest + s)
  return max_ratio > 1.0f ? (moments.z - max_ratio * moments.x) / (max_ratio - 1.0f) : 0.0f;
}

std::vector<float> shifted_masses(const RagdollDef& def, const std::vector<MassProperties>& mass,
                                  float ratio) {
  const std::size_t count = mass.size();
  std::vector<float> shifted(count);
  double whole = 0.0, sum = 0.0;
  for (std::size_t i = 0; i < count; ++i) whole += double(shifted[i] = mass[i].mass);
  for (int round = 0; round < 1000; ++round) {
    bool settled = true;
    for (std::size_t i = 1; i < count; ++i) {
      float& child = shifted[i];
      float& parent = shifted[std::size_t(def.bones[i].parent)];
      // Both masses change by the same factor.
      const float low = parent / (child * ratio), high = child / (parent * ratio);
      if (low > 1.0f) child *= std::sqrt(low), parent /= std::sqrt(low);
      if (high > 1.0f) child /= std::sqrt(high), parent *= std::sqrt(high);
      settled = settled && !(max(low, high) > 1.0f + kClose);
    }
    if (settled) break;
  }
  for (const float m : shifted) sum += double(m);
  for (float& m : shifted) m = float(double(m) * (whole / sum));
  return shifted;
}

}  // namespace

Result<RagdollDef> stabilized(const RagdollDef& def, const StableDef& stable) {
  if (const Error e = check_ragdoll(def)) return e;
  for (const float ratio : {stable.mass_ratio, stable.slenderness, stable.inertia_ratio}) {
    if (!(ratio >= 1.0f && ratio <= 1.0e9f))
      return make_error(ErrorCode::invalid_argument,
                        "ragdoll: a ratio of StableDef is %g; it must be 1 to 1e9", double(ratio));
  }
  const std::size_t count = def.bones.size();
  std::vector<MassProperties> mass(count);
  for (std::size_t i = 0; i < count; ++i) mass[i] = bone_mass(def.bones[i]);
  const std::vector<float> shifted = shifted_masses(def, mass, stable.mass_ratio);
  RagdollDef result = def;
  std::vector<float> asked(count, 0.0f);  // kg m^2: least smallest moment of a bone, for its children
  for (std::size_t i = count; i-- > 0;) {
    const Sym3 own = (shifted[i] / mass[i].mass) * mass[i].inertia;
    const PrincipalAxes axes = principal_axes(own);
    float raise = max(raised_least(axes.moments, stable.slenderness), asked[i] - axes.moments.x);
    if (stable.slenderness == 1.0f && axes.moments.z > axes.moments.x * (1.0f + kClose)) {
      // The target is a ball, which no added multiple reaches.
      const float moment = max(axes.moments.z, asked[i]);
      result.bones[i].inertia = Sym3{moment, moment, moment, 0, 0, 0};
      raise = 0.0f;
    } else {
      raise = max(raise, 0.0f);
      result.bones[i].inertia = own + Sym3{raise, raise, raise, 0, 0, 0};
    }
    result.bones[i].mass = shifted[i];
    const float largest = principal_axes(*result.bones[i].inertia).moments.z;
    if (i == 0) break;
    float& of_parent = asked[std::size_t(def.bones[i].parent)];
    of_parent = max(of_parent, largest / stable.inertia_ratio);
  }
  return result;
}

}  // namespace gyre::kit
