// read_boxes: boxes of shapes and nodes of the broad phase's trees. See <gyre/debug.h>.
#include "base/float_mode.h"
#include "collision/broadphase/fat_box.h"
#include "debug/flat.h"
#include "world/world_access.h"
#include "world/world_state.h"

#include <gyre/debug.h>

namespace gyre {

namespace {

struct Collector {
  DVec3 origin;
  BoxTable& out;

  // Corners are rounded outward, so that a box still contains its contents relative to the origin of the table.
  void add(const WorldBox& box, BoxKind kind, int depth, std::uint32_t shape) {
    const Aabb relative = round_outward({box.low - origin, box.high - origin});
    if (is_unbounded(relative)) return;
    append(out.corners, relative.low);
    append(out.corners, relative.high);
    out.kinds.push_back(kind);
    out.depths.push_back(std::uint8_t(depth));
    out.shapes.push_back(shape);
  }
  void add(const Aabb& box, BoxKind kind, int depth, std::uint32_t shape) {
    add(WorldBox{DVec3(box.low), DVec3(box.high)}, kind, depth, shape);
  }
};

void add_nodes(const RigidWorld& w, bool fixed, BoxKind kind, Collector& boxes) {
  w.broadphase->for_each_node([&](const NodeBox& node) {
    if (node.fixed == fixed) boxes.add(node.box, kind, node.depth, kNoShape);
  });
}

}  // namespace

void read_boxes(const World& world, std::uint32_t kinds, DVec3 origin, BoxTable& out) {
  const FloatMode mode;
  const RigidWorld& w = state_of(world).rigid;
  clear_all(out.corners, out.kinds, out.depths, out.shapes);
  Collector boxes{origin, out};
  const auto is_requested = [&](BoxKind kind) { return (kinds & box_bit(kind)) != 0; };
  if (is_requested(BoxKind::tight)) {
    w.shapes.ids.for_each_live([&](std::uint32_t shape) {
      const ColliderShape& collider = w.shapes.colliders[shape];
      const Pose world_from_shape = origin_pose(w.bodies, w.shapes.bodies[shape]) * collider.body_from_shape;
      boxes.add(world_box(collider.shape, world_from_shape), BoxKind::tight, 0, shape);
    });
  }
  if (is_requested(BoxKind::fat)) {
    w.shapes.ids.for_each_live(
        [&](std::uint32_t shape) { boxes.add(w.shapes.proxies[shape].fat_box, BoxKind::fat, 0, shape); });
  }
  if (w.broadphase_stale) return;
  if (is_requested(BoxKind::fixed_tree)) add_nodes(w, true, BoxKind::fixed_tree, boxes);
  if (is_requested(BoxKind::moving_tree)) add_nodes(w, false, BoxKind::moving_tree, boxes);
}

}  // namespace gyre
