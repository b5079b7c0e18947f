#include "rigid/store/shape_store.h"

namespace gyre {

IdPool::Slot add_shape_slot(ShapeStore& store) {
  const IdPool::Slot slot = store.ids.acquire();
  const std::size_t i = slot.index;
  if (i >= store.colliders.size()) {
    store.bodies.resize(i + 1);
    store.body_from_shape.resize(i + 1);
    store.colliders.resize(i + 1);
    store.proxies.resize(i + 1);
    store.materials.resize(i + 1);
    if (i >= store.geometry.capacity()) store.geometry.reserve(i + i / 8 + 16);  // as arrays grow
    store.geometry.resize(i + 1);
    store.density.resize(i + 1);
    store.user_data.resize(i + 1);
  }
  store.bodies[i] = 0;
  store.body_from_shape.set(i, {});
  store.colliders.set(i, {});
  store.proxies[i] = {};
  store.materials.set(i, {});
  store.geometry[i] = Sphere{};
  store.density[i] = 0.0f;
  store.user_data[i] = 0;
  store.changed.push_back(slot.index);
  return slot;
}

void remove_shape_slot(ShapeStore& store, std::uint32_t shape) {
  store.ids.release(shape);
  store.proxies[shape] = {};
  store.geometry[shape] = Sphere{};
  store.changed.push_back(shape);
}

void refresh_collider(ShapeStore& store, std::uint32_t shape) {
  ColliderShape collider;
  collider.shape = make_shape(store.geometry[shape]);
  collider.body_from_shape = store.body_from_shape[shape];
  collider.size = inner_radius(collider.shape);
  store.colliders.set(shape, collider);
}

MassProperties shapes_mass(const ShapeStore& store, std::span<const ShapeId> shapes) {
  const auto is_solid = [&](ShapeId id) {
    return !store.proxies[id.index].sensor && is_convex(store.colliders[id.index].shape.kind);
  };
  bool any_density = false;
  for (const ShapeId id : shapes)
    any_density = any_density || (is_solid(id) && store.density[id.index] > 0.0f);
  std::vector<MassProperties> parts;
  parts.reserve(shapes.size());
  for (const ShapeId id : shapes) {
    const float density = any_density ? store.density[id.index] : 1.0f;
    if (!(density > 0.0f) || !is_solid(id)) continue;
    const Result<MassProperties> mass = mass_properties(store.geometry[id.index], density);
    if (mass) parts.push_back(transformed(*mass, store.colliders[id.index].body_from_shape));
  }
  MassProperties all = combined(parts);
  if (!any_density && all.mass > 0.0f) {
    all.inertia = (1.0f / all.mass) * all.inertia;
    all.mass = 1.0f;
  }
  return all;
}

}  // namespace gyre
