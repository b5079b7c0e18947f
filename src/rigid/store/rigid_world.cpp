#include "rigid/store/rigid_world.h"

namespace gyre {

namespace {

float combine(CombineRule rule, float a, float b) {
  switch (rule) {
    case CombineRule::geometric_mean: return std::sqrt(a * b);
    case CombineRule::average: return 0.5f * (a + b);
    case CombineRule::minimum: return min(a, b);
    case CombineRule::maximum: return max(a, b);
    case CombineRule::product: return a * b;
  }
  return a;
}

const MaterialPair* find_pair(const Array<MaterialPair>& pairs, std::uint16_t a, std::uint16_t b) {
  if (a == 0 || b == 0) return nullptr;
  if (a > b) {
    const std::uint16_t other = a;
    a = b;
    b = other;
  }
  for (const MaterialPair& pair : pairs) {
    if (pair.a == a && pair.b == b) return &pair;
  }
  return nullptr;
}

}  // namespace

ContactSurface combine_materials(const RigidWorld& w, const Material& a, const Material& b) {
  ContactSurface surface;
  surface.static_friction = combine(w.settings.friction_rule, a.static_friction, b.static_friction);
  surface.dynamic_friction = combine(w.settings.friction_rule, a.dynamic_friction, b.dynamic_friction);
  surface.restitution = combine(w.settings.restitution_rule, a.restitution, b.restitution);
  // Friction lengths grow with deformation, so the softer surface decides.
  surface.rolling_friction = max(a.rolling_friction, b.rolling_friction);
  surface.spinning_friction = max(a.spinning_friction, b.spinning_friction);
  if (const MaterialPair* pair = find_pair(w.material_pairs, a.id, b.id)) {
    surface.static_friction = pair->static_friction;
    surface.dynamic_friction = pair->dynamic_friction;
    surface.restitution = pair->restitution;
  }
  // Static friction is at least dynamic friction.
  surface.static_friction = max(surface.static_friction, surface.dynamic_friction);
  return surface;
}

}  // namespace gyre
