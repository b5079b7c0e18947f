// Sleep over ranks, and figures of the whole world. See ranked_world.h.
//
// Islands that touch across borders fall asleep in one step on all ranks: every rank joins what touches here, and ranks exchange the least index and
// the readiness of each island until nothing changes.
#include "mpi/ranked_world.h"

#include <algorithm>
#include <cmath>

namespace gyre {

namespace {

constexpr float kRestTime = 0.5f;  // s that every body of an island must have been still

struct IslandRecord {
  std::uint32_t unit = 0, label = 0, ready = 0;
};

std::uint32_t island_root(std::vector<std::uint32_t>& parent, std::uint32_t i) {
  while (parent[i] != i) i = parent[i] = parent[parent[i]];
  return i;
}

}  // namespace

void RankedWorld::count_still_time() {
  const SceneWorld& settings = own_.scene().world;
  const float gravity = length(settings.gravity) > 0 ? length(settings.gravity) : 9.81f;
  for (const std::uint32_t index : here_) {
    Unit& unit = units_[index];
    if (unit.role != Role::owned || !is_awake(unit)) continue;
    bool still = true;
    for (const std::uint32_t body : unit.bodies) {
      const BodyDef& def = own_.scene().bodies[body].def;
      const float radius = bounding_radius(world(), local_[body]);
      const float limit =
          def.sleep_speed > 0 ? def.sleep_speed : settings.sleep_share * std::sqrt(gravity * radius);
      const ReplicaMotion motion = replica_motion(world(), local_[body]);
      still = still && def.can_sleep &&
              length(motion.linear_velocity) + radius * length(motion.angular_velocity) < limit;
    }
    unit.still_time = still ? unit.still_time + float(settings.time_step) : 0.0f;
  }
}

// Joins units that touch in this rank.
void RankedWorld::join_touching(std::vector<std::uint32_t>& parent) {
  std::size_t count = world().contact_pairs(pairs_);
  if (count > pairs_.size()) {
    pairs_.resize(count);
    count = world().contact_pairs(pairs_);
  }
  for (std::size_t i = 0; i < count; ++i) {
    const std::uint32_t a = unit_of_[std::size_t(world().user_data(pairs_[i].body_a))],
                        b = unit_of_[std::size_t(world().user_data(pairs_[i].body_b))];
    if (a >= units_.size() || b >= units_.size()) continue;
    const std::uint32_t one = island_root(parent, a), other = island_root(parent, b);
    parent[std::max(one, other)] = std::min(one, other);
  }
}

void RankedWorld::fall_asleep_together() {
  double any = 0;
  for (const std::uint32_t index : here_) {
    const Unit& unit = units_[index];
    if (unit.role == Role::owned && is_awake(unit) && unit.still_time >= kRestTime) any = 1;
  }
  if (transport_.max(any) == 0) return;
  std::vector<std::uint32_t> parent(units_.size()), label(units_.size());
  std::vector<std::uint8_t> ready(units_.size(), 1);
  for (std::uint32_t i = 0; i < parent.size(); ++i) parent[i] = label[i] = i;
  join_touching(parent);
  for (const std::uint32_t index : here_) {
    const Unit& unit = units_[index];
    if (unit.role == Role::owned && is_awake(unit) && unit.still_time < kRestTime) ready[index] = 0;
  }
  for (double changes = 1; changes > 0;) {
    changes = 0;
    // Units here know their island's least label and readiness by its root.
    for (const std::uint32_t i : here_) {
      const std::uint32_t root = island_root(parent, i);
      label[root] = std::min(label[root], label[i]);
      ready[root] = std::min(ready[root], ready[i]);
    }
    for (const std::uint32_t i : here_) {
      const std::uint32_t root = island_root(parent, i);
      label[i] = label[root], ready[i] = ready[root];
      const IslandRecord record{i, label[i], ready[i]};
      if (units_[i].role == Role::followed) out_[std::size_t(units_[i].owner)].put(record);
      if (units_[i].role == Role::owned) {
        for (const int rank : units_[i].followers) out_[std::size_t(rank)].put(record);
      }
    }
    for (Packet& packet : transport_.exchange(out_)) {
      while (!packet.at_end()) {
        const auto record = packet.get<IslandRecord>();
        if (record.label < label[record.unit] || record.ready < ready[record.unit]) changes = 1;
        label[record.unit] = std::min(label[record.unit], record.label);
        ready[record.unit] = std::min(ready[record.unit], std::uint8_t(record.ready));
      }
    }
    changes = transport_.max(changes);
  }
  for (const std::uint32_t i : here_) {
    Unit& unit = units_[i];
    if (ready[i] == 0 || !is_awake(unit)) continue;
    set_awake(unit, false);
  }
  for (const std::uint32_t i : here_) {
    if (units_[i].role == Role::followed && ready[i] != 0) units_[i].owner_awake = false;
  }
}

RankedWorld::Quality RankedWorld::quality() {
  Quality out;
  double mass = 0;
  DVec3 moment{};
  for (const std::uint32_t index : here_) {
    const Unit& unit = units_[index];
    if (unit.role != Role::owned) continue;
    for (const std::uint32_t body : unit.bodies) {
      const double m = double(world().mass_properties(local_[body]).mass);
      const ReplicaMotion motion = replica_motion(world(), local_[body]);
      const DVec3 v{double(motion.linear_velocity.x), double(motion.linear_velocity.y),
                    double(motion.linear_velocity.z)};
      out.kinetic += 0.5 * m * dot(v, v);
      out.momentum = out.momentum + m * v;
      moment = moment + m * motion.center;
      mass += m;
      out.bodies += 1;
      out.awake += is_awake(unit);
    }
  }
  std::vector<ContactPoint> points(world().contacts({}));
  world().contacts(points);
  const auto owned = [&](BodyId body) {
    const std::uint32_t unit = unit_of_[std::size_t(world().user_data(body))];
    return unit < units_.size() && units_[unit].role == Role::owned;
  };
  for (const ContactPoint& point : points) {
    if (owned(point.body_a) || owned(point.body_b))
      out.deepest_overlap = std::max(out.deepest_overlap, -double(point.separation));
  }
  for (double* value : {&out.kinetic, &out.momentum.x, &out.momentum.y, &out.momentum.z, &moment.x, &moment.y,
                        &moment.z, &mass, &out.awake, &out.bodies})
    *value = transport_.sum(*value);
  out.deepest_overlap = transport_.max(out.deepest_overlap);
  if (mass > 0) out.center = (1 / mass) * moment;
  return out;
}

}  // namespace gyre
