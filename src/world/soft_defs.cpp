// World::cloth_def, World::solid_def: definitions with which cloths and solids go on as they are: with present vertices and, if they were torn, present
// elements. World::cloth_crossings: where cloths and solids pass through themselves and each other: a number, exact for these positions. The test is that of
// soft/contact/surface_crossings.h. In: the entries of a world.
#include "base/float_mode.h"
#include "dynamics/soft/soft_surfaces.h"
#include "math/rotation.h"
#include "soft/store/soft_builder.h"
#include "world/soft_commands.h"
#include "world/world_state.h"

#include <utility>

namespace gyre {

namespace {

template <class Def>
void put_present_state(const SoftEntry& entry, Def& def) {
  const Particles& p = entry.body.particles;
  def.settings.positions.clear(), def.settings.velocities.clear();
  for (int i = 0; i < p.count; ++i) {
    def.settings.positions.push_back(p.place(i));
    def.settings.velocities.push_back(p.velocity(i));
  }
}

bool is_torn(const SoftEntry& entry) {
  const Array<std::uint32_t>& roots = entry.damage.roots;
  return !roots.empty() && roots.back() + 1 != roots.size();
}

// Tetrahedra of a box have either handedness, those of a definition are positive.
void turn_upright(SolidDef& def) {
  for (std::size_t t = 0; t < def.tetrahedra.size(); t += 4) {
    const auto edge = [&](std::size_t k) {
      return DVec3(def.vertices[def.tetrahedra[t + k]]) - DVec3(def.vertices[def.tetrahedra[t]]);
    };
    if (dot(edge(1), cross(edge(2), edge(3))) < 0.0) std::swap(def.tetrahedra[t + 2], def.tetrahedra[t + 3]);
  }
}

// The places at rest in the frame of the pose.
std::vector<Vec3> local_rest_places(const SoftEntry& entry, const Pose& pose) {
  const DQuat turn = normalized(to_double(pose.orientation));
  std::vector<Vec3> out;
  for (const DVec3& place : rest_places(entry))
    out.push_back(to_float(rotate_inverse(turn, place - pose.position)));
  return out;
}

}  // namespace

ClothDef World::cloth_def(SoftId cloth) const {
  if (!exists(cloth) || state_->soft.entries[cloth.index].kind != SoftKind::cloth) return {};
  const FloatMode mode;
  const SoftEntry& entry = state_->soft.entries[cloth.index];
  ClothDef def = std::get<ClothDef>(*entry.def);
  put_present_state(entry, def);
  if (!is_torn(entry)) return def;
  def.vertices = local_rest_places(entry, def.pose);
  def.triangles.assign(entry.damage.corners.begin(), entry.damage.corners.end());
  def.grid.reset();
  def.pressure.reset();
  return def;
}

SolidDef World::solid_def(SoftId solid) const {
  if (!exists(solid) || state_->soft.entries[solid.index].kind != SoftKind::solid) return {};
  const FloatMode mode;
  const SoftEntry& entry = state_->soft.entries[solid.index];
  SolidDef def = std::get<SolidDef>(*entry.def);
  put_present_state(entry, def);
  if (!is_torn(entry)) return def;
  def.vertices = local_rest_places(entry, def.pose);
  def.tetrahedra.assign(entry.damage.corners.begin(), entry.damage.corners.end());
  turn_upright(def);
  def.box.reset();
  return def;
}

std::size_t World::cloth_crossings() const {
  const FloatMode mode;
  Arena arena;
  return std::size_t(count_soft_crossings(state_->soft, arena));
}

}  // namespace gyre
