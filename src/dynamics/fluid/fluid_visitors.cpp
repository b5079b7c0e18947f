#include "dynamics/fluid/fluid_visitors.h"

#include "base/container/sort.h"
#include "geometry/query/point_query.h"

#include <cmath>

namespace gyre {

namespace {

constexpr int kProjections = 16;      // on the body and the box in turn
constexpr double kTouching = 1.0e-5;  // of the diagonal of the box: two closer than this overlap

double part_of(DVec3 v, int axis) { return axis == 0 ? v.x : axis == 1 ? v.y : v.z; }

// The length of the box along an axis.
double length_along(const GasBox& box, int axis) {
  return double(box.cells[axis]) * double(axis == 0 ? box.cell.x : axis == 1 ? box.cell.y : box.cell.z);
}

// The nearest point of the box.
DVec3 clamp_to(const GasBox& box, DVec3 local) {
  const auto along = [&](double at, int axis) { return clamp(at, 0.0, length_along(box, axis)); };
  return {along(local.x, 0), along(local.y, 1), along(local.z, 2)};
}

// A shape as the box sees it: from the lower corner, in its axes.
struct LocalShape {
  const Shape& shape;
  DQuat turn;
  DVec3 position;
  Aabb bounds;

  LocalShape(const FluidEntry& entry, const Shape& one, const Pose& world_from_shape) : shape(one) {
    const Pose pose = pose_to_frame(entry.frame(), world_from_shape);
    position = pose.position - entry.box().corner;
    turn = to_double(pose.orientation);
    bounds = gyre::bounds(one, Transform{to_float(position), pose.orientation});
  }
  // The point of the shape that is nearest to `point`; false if it is farther than `most`.
  bool find_nearest(DVec3 point, double most, DVec3& nearest) const {
    PointDistance found;
    if (!find_point_distance(shape, rotate_inverse(turn, point - position), most, found)) return false;
    nearest = found.distance <= 0.0 ? point : position + rotate(turn, found.on_surface);
    return true;
  }
};

bool is_in_gas(const GasBox& box, const LocalShape& shape) {
  const DVec3 whole{length_along(box, 0), length_along(box, 1), length_along(box, 2)};
  const double size = length(whole), most = size + length(DVec3(shape.bounds.high) - DVec3(shape.bounds.low));
  DVec3 point = clamp_to(box, 0.5 * (DVec3(shape.bounds.low) + DVec3(shape.bounds.high)));
  for (int i = 0; i < kProjections; ++i) {
    DVec3 nearest;
    if (!shape.find_nearest(point, most, nearest)) return false;
    if (length(nearest - point) <= kTouching * size) return true;
    point = clamp_to(box, nearest);
    if (length(nearest - point) <= kTouching * size) return true;
  }
  return false;
}

bool is_in_liquid(const LiquidGrid& liquid, const LocalShape& shape) {
  const GridShape& grid = liquid.shape;
  int begin[3], end[3];
  for (int axis = 0; axis < 3; ++axis) {
    const double edge = length_along(liquid.box, axis) / double(grid.cells[axis]);
    const double low = std::floor(part_of(DVec3(shape.bounds.low), axis) / edge) - 1.0,
                 high = std::floor(part_of(DVec3(shape.bounds.high), axis) / edge) + 2.0;
    const auto cell = [&](double at) { return int(clamp(at, 0.0, double(grid.cells[axis]))); };
    begin[axis] = cell(low), end[axis] = cell(high);
    if (liquid.box.flat(axis)) begin[axis] = 0, end[axis] = low < 1.0 && high > 0.0 ? 1 : 0;
  }
  const DVec3 edges{double(liquid.box.cell.x), double(liquid.box.cell.y), double(liquid.box.cell.z)};
  const double diagonal = length(edges);
  for (int k = begin[2]; k < end[2]; ++k) {
    for (int j = begin[1]; j < end[1]; ++j) {
      const float* const surface = liquid.surface.data() + grid.row(j, k);
      for (int i = begin[0]; i < end[0]; ++i) {
        if (!(surface[i] < 0.0f)) continue;
        const DVec3 center{(i + 0.5) * edges.x, (j + 0.5) * edges.y, (k + 0.5) * edges.z};
        DVec3 nearest;
        if (!shape.find_nearest(center, diagonal, nearest)) continue;
        if (sample_field(liquid.box, grid, liquid.surface.data(), -1, to_float(nearest)) < 0.0f) return true;
      }
    }
  }
  return false;
}

bool is_inside(const FluidEntry& entry, DVec3 world_point) {
  const GasBox& box = entry.box();
  const DVec3 local = point_to_frame(entry.frame(), world_point) - box.corner;
  if (!(clamp_to(box, local) == local)) return false;
  return !entry.is_liquid() ||
         sample_field(box, entry.liquid.shape, entry.liquid.surface.data(), -1, to_float(local)) < 0.0f;
}

// Shapes that may be inside, by body.
struct VisitingShape {
  std::uint32_t body = 0, shape = 0;
};

void list_visiting_shapes(const RigidWorld& w, const FluidEntry& entry, Array<VisitingShape>& out) {
  const GasBox& box = entry.box();
  // A box in the world around the box of the fluid.
  Aabb whole{};
  for (int corner = 0; corner < 8; ++corner) {
    const DVec3 at{(corner & 1) != 0 ? length_along(box, 0) : 0.0,
                   (corner & 2) != 0 ? length_along(box, 1) : 0.0,
                   (corner & 4) != 0 ? length_along(box, 2) : 0.0};
    const Vec3 place = to_float(point_to_world(entry.frame(), box.corner + at));
    whole = corner == 0 ? Aabb{place, place} : Aabb{min(whole.low, place), max(whole.high, place)};
  }
  const Aabb near = grow(whole, box.cell.x);
  w.shapes.ids.for_each_live([&](std::uint32_t shape) {
    const Proxy& proxy = w.shapes.proxies[shape];
    const std::uint32_t body = w.shapes.bodies[shape];
    if (proxy.sensor || w.bodies.flags[body].type == BodyType::fixed || !overlap(proxy.fat_box, near)) return;
    out.push_back({body, shape});
  });
  Array<VisitingShape> scratch;
  scratch.resize(out.size());
  merge_sort(out.view(), scratch.view(),
             [](const VisitingShape& a, const VisitingShape& b) { return a.body < b.body; });
}

FluidTouch touch_of(const RigidWorld& w, const FluidStore& fluids, std::uint32_t slot,
                    const FluidVisitor& who, int vertex, bool begins) {
  FluidTouch out;
  out.fluid = {slot, std::uint16_t(fluids.ids.generation(slot)), w.world_number};
  if (who.is_soft != 0)
    out.soft = {who.index, std::uint16_t(who.generation), w.world_number};
  else
    out.body = {who.index, std::uint16_t(who.generation), w.world_number};
  out.vertex = vertex, out.begins = begins;
  return out;
}

std::uint64_t order_of(const FluidVisitor& who) { return std::uint64_t(who.is_soft) << 32 | who.index; }

}  // namespace

void find_fluid_visitors(const RigidWorld& w, const SoftStore& soft, const FluidEntry& entry,
                         Array<FoundVisitor>& out) {
  out.clear();
  Array<VisitingShape> candidates;
  list_visiting_shapes(w, entry, candidates);
  const GasBox& box = entry.box();
  for (const VisitingShape& one : candidates) {
    if (!out.empty() && out[out.size() - 1].who.index == one.body) continue;
    const Pose pose = origin_pose(w.bodies, one.body) * w.shapes.body_from_shape[one.shape];
    const LocalShape shape(entry, w.shapes.colliders[one.shape].shape, pose);
    if (entry.is_liquid() ? is_in_liquid(entry.liquid, shape) : is_in_gas(box, shape))
      out.push_back({{one.body, w.bodies.ids.generation(one.body), 0}, -1});
  }
  for (std::uint32_t slot = 0; slot < soft.entries.size(); ++slot) {
    const SoftEntry& one = soft.entries[slot];
    if (one.def == nullptr) continue;
    const Particles& p = one.body.particles;
    int vertex = 0;
    while (vertex < p.count && !is_inside(entry, p.place(vertex))) ++vertex;
    if (vertex < p.count) out.push_back({{slot, soft.ids.generation(slot), 1}, vertex});
  }
}

void update_fluid_visitors(const RigidWorld& w, const SoftStore& soft, FluidStore& fluids) {
  Array<FoundVisitor> found;
  for (std::uint32_t slot = 0; slot < fluids.entries.size(); ++slot) {
    FluidEntry& entry = fluids.entries[slot];
    if (entry.def == nullptr) continue;
    find_fluid_visitors(w, soft, entry, found);
    const auto tell = [&](const FluidVisitor& who, int vertex, bool begins) {
      fluids.events.push_back(touch_of(w, fluids, slot, who, vertex, begins));
    };
    const Array<FluidVisitor>& before = entry.visitors;
    std::size_t a = 0, b = 0;
    while (a < before.size() || b < found.size()) {
      const bool only_before =
          b == found.size() || (a < before.size() && order_of(before[a]) < order_of(found[b].who));
      const bool only_now =
          a == before.size() || (!only_before && order_of(found[b].who) < order_of(before[a]));
      if (only_before) {
        tell(before[a++], -1, false);
      } else if (only_now) {
        tell(found[b].who, found[b].vertex, true);
        ++b;
      } else {
        // Another object has the index of one that was removed.
        if (before[a].generation != found[b].who.generation)
          tell(before[a], -1, false), tell(found[b].who, found[b].vertex, true);
        ++a, ++b;
      }
    }
    entry.visitors.clear();
    for (const FoundVisitor& one : found) entry.visitors.push_back(one.who);
  }
}

void end_fluid_touches(const RigidWorld& w, FluidStore& fluids, std::uint32_t slot) {
  for (const FluidVisitor& who : fluids.entries[slot].visitors)
    fluids.events.push_back(touch_of(w, fluids, slot, who, -1, false));
}

}  // namespace gyre
