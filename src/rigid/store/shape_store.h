// Shapes on bodies as columns, indexed by the slot of the shape: data for collision, and data that only the user
// reads.
#pragma once

#include "base/container/array.h"
#include "base/container/interned_column.h"
#include "base/container/slot_map.h"
#include "collision/broadphase/proxy.h"
#include "collision/contact/collide.h"

#include <gyre/defs.h>

#include <vector>

namespace gyre {

inline auto interning_key(const Transform& t) { return words_of(t.position, t.orientation); }
inline auto interning_key(const Material& m) {
  static_assert(sizeof(Material) == 24, "every field is among the bits");
  return words_of(m.static_friction, m.dynamic_friction, m.restitution, m.rolling_friction, m.spinning_friction,
                  std::uint32_t(m.id));
}
inline auto interning_key(const ColliderShape& c) {
  const Shape& s = c.shape;
  const std::uint64_t data = reinterpret_cast<std::uintptr_t>(s.hull);
  return words_of(std::uint32_t(s.kind), s.radius, s.extents, s.offset, data, c.body_from_shape.position,
                  c.body_from_shape.orientation, c.size);
}

struct ShapeStore {
  IdPool ids;
  Array<std::uint32_t> bodies;  // the body of each shape
  InternedColumn<Transform> body_from_shape;
  InternedColumn<ColliderShape> colliders;  // the form for collision; refers to `geometry`; derived
  Array<Proxy> proxies;             // fat boxes are state: they decide when pairs begin
  InternedColumn<Material> materials;
  std::vector<AnyShape> geometry;  // owns cooked geometry
  Array<float> density;
  Array<std::uint64_t> user_data;
  Array<std::uint32_t> changed;  // proxies that the broad phase does not know yet, in no order; derived
  // The fat boxes of awake bodies cover their motion in a step of this length (s), except those of `moved_shapes`;
  // derived.
  float fat_box_horizon = 0.0f;
  Array<std::uint32_t> moved_shapes;  // shapes that commands placed or set moving since the last step
};

IdPool::Slot add_shape_slot(ShapeStore& store);
void remove_shape_slot(ShapeStore& store, std::uint32_t shape);

// Derives the form for collision from the state columns.
void refresh_collider(ShapeStore& store, std::uint32_t shape);

// Mass properties of a set of shapes in the frame of the body. Planes, meshes and height fields have no mass. Shapes whose densities
// are all 0 are measured with equal densities, to a mass of 1.
MassProperties shapes_mass(const ShapeStore& store, std::span<const ShapeId> shapes);

}  // namespace gyre
