#include "rigid/store/body_store.h"

#include "math/rotation.h"

namespace gyre {

IdPool::Slot add_body_slot(BodyStore& store) {
  const IdPool::Slot slot = store.ids.acquire();
  const std::size_t i = slot.index;
  if (i >= store.motion.size()) {
    const std::size_t count = i + 1;
    store.motion.resize(count);
    store.inertia.resize(count);
    store.poses.resize(count);
    store.orientations.resize(count);
    store.masses.resize(count);
    store.forces.resize(count);
    store.flags.resize(count);
    store.sleep.resize(count);
    store.overrides.resize(count);
    store.user_data.resize(count);
    store.shapes.resize(count);
  }
  store.motion[i] = {};
  store.inertia[i] = {};
  store.poses[i] = {};
  store.orientations[i] = {};
  store.masses.set(i, {});
  store.forces[i] = {};
  store.flags[i] = {};
  store.sleep[i] = {};
  store.overrides.set(i, {});
  store.user_data[i] = 0;
  if (i < store.last_moves.size()) store.last_moves[i] = {};
  if (i < store.sleep_speeds.size()) store.sleep_speeds[i] = {};
  store.shapes[i].clear();
  if (i < store.joints.size()) store.joints[i].clear();
  store.awake_stale = true;
  return slot;
}

void remove_body_slot(BodyStore& store, std::uint32_t body) {
  store.ids.release(body);
  store.flags[body] = {};
  store.motion[body] = {};
  store.inertia[body] = {};
  store.shapes[body].clear();
  if (body < store.joints.size()) store.joints[body].clear();
  store.awake_stale = true;
}

namespace {

// The inverse of `inertia` on the free axes, zero on locked ones. A locked axis takes up any torque, so this is the
// inverse of the sub-matrix, not the sub-matrix of the inverse.
Sym3 inverse_on_free_axes(Sym3 inertia, std::uint8_t locked) {
  if (locked & 1) inertia.xy = inertia.xz = 0.0f, inertia.xx = 1.0f;
  if (locked & 2) inertia.xy = inertia.yz = 0.0f, inertia.yy = 1.0f;
  if (locked & 4) inertia.xz = inertia.yz = 0.0f, inertia.zz = 1.0f;
  Sym3 result = inverse(inertia);
  if (locked & 1) result.xx = 0.0f;
  if (locked & 2) result.yy = 0.0f;
  if (locked & 4) result.zz = 0.0f;
  return result;
}

}  // namespace

BodyInertia world_inertia(const BodyMass& mass, const BodyFlags& flags, Quat orientation) {
  if (!is_movable(flags)) return {};
  BodyInertia result;
  result.inverse_mass = flags.locked_linear == 7 ? 0.0f : mass.inverse_mass;
  result.locked = float(flags.locked_linear);
  if (flags.locked_angular == 7) return result;
  if (flags.locked_angular != 0) {
    result.inverse = inverse_on_free_axes(rotate_inertia(orientation, mass.inertia), flags.locked_angular);
  } else if (mass.isotropic != 0) {
    result.inverse = mass.inverse_inertia;
  } else {
    result.inverse = rotate_inertia(orientation, mass.inverse_inertia);
  }
  return result;
}

void refresh_inertia(BodyStore& store, std::uint32_t body) {
  store.inertia[body] = world_inertia(store.masses[body], store.flags[body], store.poses[body].orientation);
  store.motion[body].inverse_mass = store.inertia[body].inverse_mass;
}

void refresh_awake(BodyStore& store) {
  if (!store.awake_stale) return;
  store.awake_stale = false;
  store.awake.clear();
  store.sleeping_count = 0;
  store.ids.for_each_live([&](std::uint32_t body) {
    const BodyFlags& flags = store.flags[body];
    if (is_simulated(flags)) store.awake.push_back(body);
    if (is_movable(flags) && flags.awake == 0) ++store.sleeping_count;
  });
}

}  // namespace gyre
