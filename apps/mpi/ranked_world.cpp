// One world over ranks: who owns and who follows what. See ranked_world.h.
#include "mpi/ranked_world.h"

#include "scene/scene_writer.h"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <ctime>
#include <stdexcept>

namespace gyre {

namespace {

constexpr std::uint32_t kNoUnit = 0xffffffffu;
constexpr std::uint8_t kMotionRecord = 0, kWakeRecord = 1, kOwnRecord = 2;
// Weight of a sleeping unit in the division of space; an awake one has 1 a body.
constexpr double kSleepingWeight = 0.05;

struct UnitRecord {
  std::uint32_t unit = 0;
  std::uint8_t kind = kMotionRecord;
  std::uint8_t awake = 1;
  std::uint16_t unused = 0;
  float still_time = 0;
};

// CPU time of this thread, which waiting neighbours on the same core do not add to.
double thread_seconds() {
  timespec now{};
  clock_gettime(CLOCK_THREAD_CPUTIME_ID, &now);
  return double(now.tv_sec) + 1e-9 * double(now.tv_nsec);
}

class Stopwatch {
 public:
  explicit Stopwatch(double& sum) : sum_(sum), begin_(thread_seconds()) {}
  ~Stopwatch() { sum_ += thread_seconds() - begin_; }

 private:
  double& sum_;
  double begin_;
};

bool moves_freely(const SceneBody& body) { return body.def.type == BodyType::dynamic; }

std::uint32_t root_of(std::vector<std::uint32_t>& parent, std::uint32_t i) {
  while (parent[i] != i) i = parent[i] = parent[parent[i]];
  return i;
}
// The smaller index becomes the root.
void unite(std::vector<std::uint32_t>& parent, std::uint32_t a, std::uint32_t b) {
  a = root_of(parent, a), b = root_of(parent, b);
  parent[std::max(a, b)] = std::min(a, b);
}

bool is_finite(const ReplicaMotion& m) {
  const Vec3 v = m.linear_velocity, w = m.angular_velocity;
  return std::isfinite(m.center.x + m.center.y + m.center.z + double(v.x) + double(v.y) + double(v.z) +
                       double(w.x) + double(w.y) + double(w.z));
}

}  // namespace

std::string RankedWorld::find_obstacle(const Scene& scene) {
  if (!scene.ropes.empty() || !scene.cloths.empty() || !scene.soft_bodies.empty())
    return "ropes, cloths and soft bodies";
  if (!scene.gases.empty() || !scene.liquids.empty()) return "gases and liquids";
  if (!scene.explosions.empty()) return "explosions";
  for (const SceneBody& body : scene.bodies) {
    if (!body.forces.empty()) return "timed forces on bodies";
  }
  for (const SceneJoint& joint : scene.joints) {
    const bool breaks =
        std::visit([](const auto& def) { return def.break_force > 0 || def.break_torque > 0; }, joint.def);
    if (breaks) return "joints that break";
  }
  return {};
}

RankedWorld::RankedWorld(Transport& transport, SceneRunner whole, SceneRunner own, double halo,
                         bool exchange_steps)
    : transport_(transport), whole_(std::move(whole)), own_(std::move(own)) {
  const Scene& scene = whole_.scene();
  out_.resize(std::size_t(transport_.size()));
  parts_ = exchange_steps ? 1 : scene.world.substeps;
  world().set_substeps(scene.world.substeps / parts_);
  // Only bodies that do not move at all fall asleep by themselves; all others as fall_asleep_together() says.
  world().set_sleep_share(0);
  std::vector<float> radii;
  for (std::size_t i = 0; i < scene.bodies.size(); ++i) {
    if (moves_freely(scene.bodies[i])) radii.push_back(bounding_radius(whole_.world(), whole_.bodies()[i]));
  }
  std::sort(radii.begin(), radii.end());
  const double ordinary = radii.empty() ? 1.0 : double(radii[radii.size() * 9 / 10]);
  halo_ = halo * 2 * ordinary;
  blocks_ = SpaceBlocks(std::max(halo_ + ordinary, 1e-6), transport_.size());
  local_.assign(own_.bodies().begin(), own_.bodies().end());
  find_units();
  std::map<std::uint64_t, double> weights;
  for (const Unit& unit : units_)
    weights[blocks_.key_of(replica_motion(world(), local_[unit.bodies[0]]).center)] +=
        double(unit.bodies.size());
  blocks_.divide(weights);
  for (Unit& unit : units_) {
    unit.owner = blocks_.owner_of(replica_motion(world(), local_[unit.bodies[0]]).center);
    unit.role = unit.owner == transport_.rank() ? Role::owned : Role::followed;
  }
  for (std::uint32_t i = 0; i < units_.size(); ++i) here_.push_back(i);
  update_roles();
}

void RankedWorld::find_units() {
  const Scene& scene = whole_.scene();
  std::vector<std::uint32_t> parent(scene.bodies.size());
  for (std::uint32_t i = 0; i < parent.size(); ++i) parent[i] = i;
  const auto is_free = [&](int body) { return body >= 0 && moves_freely(scene.bodies[std::size_t(body)]); };
  for (const SceneJoint& joint : scene.joints) {
    if (is_free(joint.a) && is_free(joint.b)) unite(parent, std::uint32_t(joint.a), std::uint32_t(joint.b));
  }
  unit_of_.assign(parent.size(), kNoUnit);
  for (std::uint32_t i = 0; i < parent.size(); ++i) {
    if (!moves_freely(scene.bodies[i])) continue;
    const std::uint32_t root = root_of(parent, i);
    if (root == i) {
      unit_of_[i] = std::uint32_t(units_.size());
      units_.emplace_back();
    }
    unit_of_[i] = unit_of_[root];
    units_[unit_of_[i]].bodies.push_back(i);
  }
  for (std::uint32_t i = 0; i < scene.joints.size(); ++i) {
    const SceneJoint& joint = scene.joints[i];
    if (is_free(joint.a) || is_free(joint.b))
      units_[unit_of_[std::size_t(is_free(joint.a) ? joint.a : joint.b)]].joints.push_back(i);
  }
}

// Bodies of joints begin where the scene has them, since the anchors of joints are there, and then go where they are.
void RankedWorld::add_unit(std::uint32_t index, const ReplicaMotion* motions) {
  Unit& unit = units_[index];
  const World& source = whole_.world();
  std::vector<ShapeDef> shapes;
  for (std::size_t k = 0; k < unit.bodies.size(); ++k) {
    const std::uint32_t body = unit.bodies[k];
    const BodyId from = whole_.bodies()[body];
    BodyDef def = whole_.scene().bodies[body].def;
    def.user_data = body;
    const MassProperties mass = source.mass_properties(from);
    def.mass = mass.mass, def.center_of_mass = mass.center, def.inertia = mass.inertia;
    if (unit.joints.empty()) {
      def.pose.orientation = motions[k].orientation;
      def.pose.position = motions[k].center - rotate(motions[k].orientation, mass.center);
    }
    shapes.clear();
    for (const ShapeId id : source.shapes(from)) {
      shapes.push_back({.geometry = *source.geometry(id),
                        .local = source.local_transform(id),
                        .density = source.density(id),
                        .material = source.material(id),
                        .filter = source.filter(id),
                        .sensor = source.is_sensor(id)});
    }
    local_[body] = world().add_body(def, shapes);
  }
  for (const std::uint32_t joint : unit.joints) {
    const SceneJoint& source_joint = whole_.scene().joints[joint];
    JointDef def = source_joint.def;
    std::visit(
        [&](auto& d) {
          if (source_joint.a >= 0) d.a = local_[std::size_t(source_joint.a)];
          if (source_joint.b >= 0) d.b = local_[std::size_t(source_joint.b)];
        },
        def);
    world().add_joint(def);
  }
  here_.insert(std::lower_bound(here_.begin(), here_.end(), index), index);
}

void RankedWorld::remove_unit(std::uint32_t index) {
  Unit& unit = units_[index];
  for (const std::uint32_t body : unit.bodies) {
    world().remove_body(local_[body]);
    local_[body] = {};
  }
  unit.role = Role::absent;
  here_.erase(std::lower_bound(here_.begin(), here_.end(), index));
}

bool RankedWorld::is_awake(const Unit& unit) const { return own_.world().is_awake(local_[unit.bodies[0]]); }
void RankedWorld::set_awake(const Unit& unit, bool awake) {
  for (const std::uint32_t body : unit.bodies) world().set_awake(local_[body], awake);
}

void RankedWorld::put_unit(Packet& to, std::uint32_t index, bool own) {
  const Unit& unit = units_[index];
  to.put(
      UnitRecord{index, own ? kOwnRecord : kMotionRecord, std::uint8_t(is_awake(unit)), 0, unit.still_time});
  for (const std::uint32_t body : unit.bodies) {
    const ReplicaMotion motion = replica_motion(world(), local_[body]);
    if (!is_finite(motion))
      throw std::runtime_error("body " + whole_.scene().bodies[body].name +
                               " is no longer finite after step " + std::to_string(steps_));
    to.put(motion);
  }
}

void RankedWorld::take_unit(Packet& from, int sender) {
  const auto record = from.get<UnitRecord>();
  Unit& unit = units_[record.unit];
  if (record.kind == kWakeRecord) {
    if (unit.role == Role::owned && !is_awake(unit)) set_awake(unit, true);
    return;
  }
  std::vector<ReplicaMotion> motions(unit.bodies.size());
  for (ReplicaMotion& motion : motions) motion = from.get<ReplicaMotion>();
  const bool fresh = unit.role == Role::absent;
  if (fresh) add_unit(record.unit, motions.data());
  unit.role = record.kind == kOwnRecord ? Role::owned : Role::followed;
  unit.owner = record.kind == kOwnRecord ? transport_.rank() : sender;
  unit.seen = true;
  unit.owner_awake = record.awake != 0;
  unit.still_time = record.still_time;
  for (std::size_t k = 0; k < motions.size(); ++k)
    set_replica_motion(world(), local_[unit.bodies[k]], motions[k]);
  if (unit.owner_awake && !is_awake(unit)) set_awake(unit, true);
  if (fresh && !unit.owner_awake) set_awake(unit, false);
}

void RankedWorld::take_all(std::vector<Packet>& in) {
  const Stopwatch watch(figures_.cpu_seconds);
  for (std::size_t r = 0; r < in.size(); ++r) {
    while (!in[r].at_end()) take_unit(in[r], int(r));
  }
}

// Between two steps of a step: the same ranks follow the same units.
void RankedWorld::refresh_followed() {
  {
    const Stopwatch watch(figures_.cpu_seconds);
    for (const std::uint32_t index : here_) {
      const Unit& unit = units_[index];
      if (unit.role != Role::owned || !is_awake(unit)) continue;
      for (const int rank : unit.followers) put_unit(out_[std::size_t(rank)], index, false);
    }
  }
  take_all(transport_.exchange(out_));
}

// Hands units to the owners of the space where they are now, and tells owners what woke here.
void RankedWorld::migrate() {
  {
    const Stopwatch watch(figures_.cpu_seconds);
    for (const std::uint32_t index : here_) {
      Unit& unit = units_[index];
      unit.seen = false;
      if (unit.role == Role::followed) {
        if (!unit.owner_awake && is_awake(unit))
          out_[std::size_t(unit.owner)].put(UnitRecord{index, kWakeRecord, 1, 0, 0});
        continue;
      }
      const int owner = blocks_.owner_of(replica_motion(world(), local_[unit.bodies[0]]).center);
      if (owner == transport_.rank()) continue;
      put_unit(out_[std::size_t(owner)], index, true);
      unit.role = Role::followed;
      unit.owner = owner;
      ++figures_.migrations;
    }
  }
  take_all(transport_.exchange(out_));
}

void RankedWorld::update_roles() {
  migrate();
  {
    const Stopwatch watch(figures_.cpu_seconds);
    for (const std::uint32_t index : here_) {
      Unit& unit = units_[index];
      if (unit.role != Role::owned) continue;
      unit.followers.clear();
      for (const std::uint32_t body : unit.bodies) {
        const double reach = halo_ + double(bounding_radius(world(), local_[body]));
        blocks_.for_each_owner(replica_motion(world(), local_[body]).center, reach, [&](int rank) {
          if (rank != transport_.rank() &&
              std::find(unit.followers.begin(), unit.followers.end(), rank) == unit.followers.end())
            unit.followers.push_back(rank);
        });
      }
      for (const int rank : unit.followers) put_unit(out_[std::size_t(rank)], index, false);
    }
  }
  take_all(transport_.exchange(out_));
  const std::vector<std::uint32_t> all = here_;
  for (const std::uint32_t index : all) {
    if (units_[index].role == Role::followed && !units_[index].seen) remove_unit(index);
    if (units_[index].role == Role::followed) ++figures_.followed;
  }
}

void RankedWorld::step() {
  const double h = own_.scene().world.time_step / parts_;
  for (int part = 0; part < parts_; ++part) {
    {
      const Stopwatch watch(figures_.cpu_seconds);
      world().step(float(h));
    }
    if (part + 1 < parts_) refresh_followed();
  }
  ++steps_;
  count_still_time();
  update_roles();
  if (own_.scene().world.sleeping && steps_ % 8 == 0) fall_asleep_together();
}

void RankedWorld::rebalance() {
  std::map<std::uint64_t, double> own;
  for (const std::uint32_t index : here_) {
    const Unit& unit = units_[index];
    if (unit.role != Role::owned) continue;
    const double bodies = double(unit.bodies.size());
    own[blocks_.key_of(replica_motion(world(), local_[unit.bodies[0]]).center)] +=
        is_awake(unit) ? bodies : kSleepingWeight * bodies;
  }
  for (const auto& [key, weight] : own) {
    out_[0].put(key);
    out_[0].put(weight);
  }
  std::vector<Packet>& in = transport_.exchange(out_);
  if (transport_.rank() == 0) {
    std::map<std::uint64_t, double> weights;
    for (Packet& packet : in) {
      while (!packet.at_end()) {
        const auto key = packet.get<std::uint64_t>();
        weights[key] += packet.get<double>();
      }
    }
    blocks_.divide(weights);
    for (Packet& to : out_) {
      for (const std::uint64_t begin : blocks_.begins()) to.put(begin);
    }
  }
  std::vector<Packet>& begins = transport_.exchange(out_);
  std::vector<std::uint64_t> found(blocks_.begins().size());
  for (std::uint64_t& begin : found) begin = begins[0].get<std::uint64_t>();
  blocks_.set_begins(found);
}

std::string RankedWorld::gather_scene() {
  for (const std::uint32_t index : here_) {
    if (units_[index].role != Role::owned) continue;
    for (const std::uint32_t body : units_[index].bodies) {
      out_[0].put(body);
      out_[0].put(replica_motion(world(), local_[body]));
    }
  }
  std::vector<Packet>& in = transport_.exchange(out_);
  if (transport_.rank() != 0) return {};
  for (Packet& packet : in) {
    while (!packet.at_end()) {
      const auto body = packet.get<std::uint32_t>();
      set_replica_motion(whole_.world(), whole_.bodies()[body], packet.get<ReplicaMotion>());
    }
  }
  for (std::size_t i = 0; i < whole_.bodies().size(); ++i) {  // kinematic bodies are in every rank
    if (unit_of_[i] == kNoUnit)
      set_replica_motion(whole_.world(), whole_.bodies()[i], replica_motion(world(), local_[i]));
  }
  return write_scene(whole_.final_scene());
}

}  // namespace gyre
