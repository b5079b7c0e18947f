#include "dynamics/soft/soft_inside.h"

#include "geometry/query/point_query.h"
#include "math/rotation.h"

namespace gyre {

namespace {

// Signed distance of a vertex to the shapes of a body that it may touch.
double distance_to(const RigidWorld& w, const SoftEntry& entry, std::uint32_t body, std::uint32_t particle) {
  Proxy own;
  own.filter = entry.settings().filter, own.body = kNoIndex, own.motion = ProxyMotion::moving;
  double nearest = kAnyDepth;
  for (const ShapeId id : w.bodies.shapes[body]) {
    const Proxy& proxy = w.shapes.proxies[id.index];
    if (proxy.sensor || !may_pair(own, proxy)) continue;
    const Pose pose = origin_pose(w.bodies, body) * w.shapes.body_from_shape[id.index];
    const DVec3 local = rotate_inverse(to_double(pose.orientation),
                                       entry.body.particles.place(int(particle)) - pose.position);
    PointDistance found;
    if (find_point_distance(w.shapes.colliders[id.index].shape, local, kAnyDepth, found))
      nearest = min(nearest, found.distance);
  }
  return nearest;
}

template <class IsThere, class Visit>
void visit_row(const SlicedRows& rows, std::uint32_t row, IsThere&& is_there, Visit&& visit) {
  if (rows.slots.empty()) return;
  const std::uint32_t slice = row / kSliceRows, lane = row % kSliceRows;
  for (std::int32_t s = rows.slot_begin[slice]; s < rows.slot_begin[slice + 1]; ++s) {
    const RowSlot slot = rows.slots[s];
    if (!is_there(std::size_t(s) * kSliceRows + lane)) continue;
    visit(std::uint32_t(slot.columns < 0 ? std::int32_t(row) + slot.offset
                                         : rows.columns[std::size_t(slot.columns) + lane]));
  }
}

// Calls visit(other) for each vertex that an element holds together with this one.
template <class Visit>
void for_each_neighbour(const SoftBody& body, std::uint32_t particle, Visit&& visit) {
  if (!body.chain.rest_length.empty()) {
    if (particle > 0) visit(particle - 1);
    if (particle < body.chain.rest_length.size()) visit(particle + 1);
    return;
  }
  visit_row(
      body.springs.rows, particle, [&](std::size_t place) { return body.springs.stiffness[place] > 0.0f; },
      visit);
  visit_row(
      body.continuum.rows, particle,
      [&](std::size_t place) { return body.continuum.edge_of_place[place] >= 0; }, visit);
}

}  // namespace

void add_inside(const RigidWorld& w, SoftEntry& entry, std::uint32_t body, std::uint32_t particle) {
  const std::uint32_t count = std::uint32_t(entry.body.particles.count);
  Array<std::uint8_t> seen;
  seen.assign(count, std::uint8_t(0));
  Array<SoftInside> others;
  for (const SoftInside& one : entry.inside) {
    if (one.body != std::int32_t(body)) others.push_back(one);
    if (one.body == std::int32_t(body)) seen[one.particle] = 1;
  }
  Array<std::uint32_t> open;  // of which the neighbours are still to be seen
  seen[particle] = 1;
  open.push_back(particle);
  for (std::size_t next = 0; next < open.size(); ++next) {
    for_each_neighbour(entry.body, open[next], [&](std::uint32_t other) {
      if (other >= count || seen[other] != 0) return;
      const double distance = distance_to(w, entry, body, other);
      if (distance >= double(entry.radius) && distance >= 0.0) return;
      seen[other] = 1;
      if (distance < 0.0) open.push_back(other);
    });
  }
  // Both lists ascend.
  entry.inside.clear();
  std::size_t k = 0;
  for (std::uint32_t i = 0; i < count; ++i) {
    for (; k < others.size() &&
           (others[k].particle < i || (others[k].particle == i && others[k].body < std::int32_t(body)));
         ++k)
      entry.inside.push_back(others[k]);
    if (seen[i] != 0) entry.inside.push_back({i, std::int32_t(body)});
  }
  for (; k < others.size(); ++k) entry.inside.push_back(others[k]);
}

bool is_inside(const SoftEntry& entry, std::uint32_t particle, std::uint32_t body) {
  const std::span<const SoftInside> all = entry.inside;
  std::size_t low = 0, high = all.size();
  while (low < high) {
    const std::size_t middle = (low + high) / 2;
    const SoftInside& one = all[middle];
    const bool before = one.particle != particle ? one.particle < particle : one.body < std::int32_t(body);
    (before ? low : high) = before ? middle + 1 : middle;
  }
  return low < all.size() && all[low].particle == particle && all[low].body == std::int32_t(body);
}

}  // namespace gyre
