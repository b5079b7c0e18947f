// Shapes on bodies: what collision needs as columns indexed by the shape's slot, and what only the user asks for.
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
  Array<std::uint32_t> bodies;      // owner of each shape
  InternedColumn<Transform> body_from_shape;         // body_from_shape
  InternedColumn<ColliderShape> colliders;  // inner form of all that; borrows from `geometry`; derived
  Array<Proxy> proxies;             // fat boxes are state: they decide when pairs begin
  InternedColumn<Material> materials;
  std::vector<AnyShape> geometry;   // keeps cooked data alive
  Array<float> density;
  Array<std::uint64_t> user_data;
  Array<std::uint32_t> changed;     // proxies that the broad phase has not seen yet, in no order; derived
  // The fat boxes of what is awake hold its way in a step of this length (s), but for those of `hurried`; derived.
  float fat_box_horizon = 0.0f;
  Array<std::uint32_t> moved_shapes;     // shapes that commands placed or set moving since
};

IdPool::Slot add_shape_slot(ShapeStore& store);
void remove_shape_slot(ShapeStore& store, std::uint32_t shape);

// The inner form of a shape, from the columns that are state.
void refresh_collider(ShapeStore& store, std::uint32_t shape);

// Mass properties of a set of shapes in the body's frame; kind planes, meshes and fields add none.
MassProperties shapes_mass(const ShapeStore& store, std::span<const ShapeId> shapes);

}  // namespace gyre
