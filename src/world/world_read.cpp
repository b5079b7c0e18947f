// The reading side of the public World: single getters, bulk columns, sums over the world.
#include <gyre/world.h>

#include "base/container/sort.h"
#include "base/float_mode.h"
#include "rigid/batch/surface_rules.h"
#include "rigid/integrate/spring_stability.h"
#include "world/body_commands.h"
#include "world/field_commands.h"
#include "world/fluid_commands.h"
#include "world/joint_commands.h"
#include "world/joint_reading.h"
#include "world/soft_commands.h"
#include "world/world_state.h"

#include <limits>

namespace gyre {

namespace {

template <class Tag>
bool lives(const WorldState& s, const IdPool& ids, Id<Tag> id) {
  return id && id.world == s.number && ids.live(id.index) &&
         std::uint16_t(ids.generation(id.index)) == id.generation;
}
bool lives(const WorldState& s, BodyId id) { return lives(s, s.rigid.bodies.ids, id); }
bool lives(const WorldState& s, ShapeId id) { return lives(s, s.rigid.shapes.ids, id); }
bool lives(const WorldState& s, JointId id) { return lives(s, s.rigid.joints.ids, id); }

void resize(BodyCopy& copy, std::size_t bodies) {
  copy.ids.resize(bodies);
  copy.poses.resize(bodies);
  copy.linear_velocities.resize(bodies);
  copy.angular_velocities.resize(bodies);
}
void fill(BodyCopy& copy, const WorldState& s, bool only_awake) {
  const FloatMode mode;
  const BodyStore& bodies = s.rigid.bodies;
  resize(copy, bodies.ids.capacity());
  std::size_t count = 0;
  bodies.ids.for_each_live([&](std::uint32_t body) {
    if (only_awake && !is_simulated(bodies.flags[body])) return;
    copy.ids[count] = body_id(s.rigid, body);
    copy.poses[count] = origin_pose(bodies, body);
    copy.linear_velocities[count] = bodies.motion[body].linear_velocity;
    copy.angular_velocities[count] = bodies.motion[body].angular_velocity;
    ++count;
  });
  resize(copy, count);
}
// By ascending index. After a change, the first reading thread makes the copy for all. (One function for both lists:
// code size counts on the web.)
BodyColumns read_bodies(WorldState& s, BodyCopy& copy, bool only_awake) {
  if (copy.made_at.load(std::memory_order_acquire) != s.changes) {
    const std::lock_guard<std::mutex> lock(s.query_lock);
    if (copy.made_at.load(std::memory_order_relaxed) != s.changes) {
      fill(copy, s, only_awake);
      copy.made_at.store(s.changes, std::memory_order_release);
    }
  }
  return {copy.ids, copy.poses, copy.linear_velocities, copy.angular_velocities};
}

// Angular momentum about the centre of mass, world frame, in double.
DVec3 spin_momentum(const BodyStore& bodies, std::uint32_t i) {
  const Quat q = bodies.poses[i].orientation;
  return DVec3(rotate(q, bodies.masses[i].inertia * rotate_inverse(q, bodies.motion[i].angular_velocity)));
}

}  // namespace

bool World::exists(BodyId body) const { return lives(*state_, body); }
bool World::exists(ShapeId shape) const { return lives(*state_, shape); }
bool World::exists(JointId joint) const { return lives(*state_, joint); }

Pose World::pose(BodyId body) const {
  const FloatMode mode;  // the origin is derived from the centre of mass
  return exists(body) ? origin_pose(state_->rigid.bodies, body.index) : Pose{};
}
DVec3 World::center_of_mass(BodyId body) const {
  return exists(body) ? state_->rigid.bodies.poses[body.index].center : DVec3{};
}
Vec3 World::linear_velocity(BodyId body) const {
  return exists(body) ? state_->rigid.bodies.motion[body.index].linear_velocity : Vec3{};
}
Vec3 World::angular_velocity(BodyId body) const {
  return exists(body) ? state_->rigid.bodies.motion[body.index].angular_velocity : Vec3{};
}
Vec3 World::velocity_at(BodyId body, DVec3 point) const {
  if (!exists(body)) return {};
  const FloatMode mode;
  return linear_velocity(body) + cross(angular_velocity(body), difference(point, center_of_mass(body)));
}
BodyType World::type(BodyId body) const {
  return exists(body) ? state_->rigid.bodies.flags[body.index].type : BodyType::fixed;
}
bool World::is_awake(BodyId body) const {
  if (!exists(body)) return false;
  return is_simulated(state_->rigid.bodies.flags[body.index]);
}
float World::sleep_speed(BodyId body) const {
  return exists(body) ? sleep_speed_of(state_->rigid.bodies, body.index) : 0.0f;
}
std::uint64_t World::user_data(BodyId body) const {
  return exists(body) ? state_->rigid.bodies.user_data[body.index] : 0;
}
float World::linear_damping(BodyId body) const {
  return exists(body) ? state_->rigid.bodies.forces[body.index].linear_damping : 0.0f;
}
float World::angular_damping(BodyId body) const {
  return exists(body) ? state_->rigid.bodies.forces[body.index].angular_damping : 0.0f;
}
float World::gravity_scale(BodyId body) const {
  return exists(body) ? state_->rigid.bodies.forces[body.index].gravity_scale : 0.0f;
}
bool World::continuous(BodyId body) const {
  return exists(body) && state_->rigid.bodies.flags[body.index].continuous != 0;
}
bool World::enabled(BodyId body) const {
  return exists(body) && !is_disabled(state_->rigid.bodies.flags[body.index]);
}
bool World::can_sleep(BodyId body) const {
  return exists(body) && state_->rigid.bodies.flags[body.index].can_sleep != 0;
}
LockedAxes World::locked_axes(BodyId body) const {
  LockedAxes out;
  if (!exists(body)) return out;
  const BodyFlags& flags = state_->rigid.bodies.flags[body.index];
  for (int axis = 0; axis < 3; ++axis) {
    out.linear[axis] = (flags.locked_linear >> axis & 1) != 0;
    out.angular[axis] = (flags.locked_angular >> axis & 1) != 0;
  }
  return out;
}
std::size_t World::joints(BodyId body, std::span<JointId> out) const {
  if (!exists(body)) return 0;
  const std::span<const std::uint32_t> slots = joints_of(state_->rigid.bodies, body.index);
  for (std::size_t i = 0; i < slots.size() && i < out.size(); ++i) out[i] = joint_id(state_->rigid, slots[i]);
  return slots.size();
}
MassProperties World::mass_properties(BodyId body) const {
  if (!exists(body)) return {};
  const BodyMass& mass = state_->rigid.bodies.masses[body.index];
  return {mass.mass, mass.center, mass.inertia};
}
std::span<const ShapeId> World::shapes(BodyId body) const {
  if (!exists(body)) return {};
  return state_->rigid.bodies.shapes[body.index];
}
BodyId World::body_of(ShapeId shape) const {
  return exists(shape) ? body_id(state_->rigid, state_->rigid.shapes.bodies[shape.index]) : BodyId{};
}
const AnyShape* World::geometry(ShapeId shape) const {
  return exists(shape) ? &state_->rigid.shapes.geometry[shape.index] : nullptr;
}
Transform World::local_transform(ShapeId shape) const {
  return exists(shape) ? state_->rigid.shapes.body_from_shape[shape.index] : Transform{};
}
Material World::material(ShapeId shape) const {
  return exists(shape) ? state_->rigid.shapes.materials[shape.index] : Material{};
}

Filter World::filter(ShapeId shape) const {
  return exists(shape) ? state_->rigid.shapes.proxies[shape.index].filter : Filter{};
}
bool World::is_sensor(ShapeId shape) const {
  return exists(shape) && state_->rigid.shapes.proxies[shape.index].sensor;
}
float World::density(ShapeId shape) const {
  return exists(shape) ? state_->rigid.shapes.density[shape.index] : 0.0f;
}
std::uint64_t World::user_data(ShapeId shape) const {
  return exists(shape) ? state_->rigid.shapes.user_data[shape.index] : 0;
}

bool World::exists(FieldId field) const { return is_field(*state_, field); }
std::size_t World::fields(std::span<FieldId> out) const {
  const Array<FieldRecord>& fields = state_->rigid.fields;
  std::size_t count = 0;
  for (std::uint32_t slot = 0; slot < fields.size(); ++slot) {
    if (!fields[slot].is_live()) continue;
    if (count < out.size()) out[count] = {slot, std::uint16_t(fields[slot].generation), state_->number};
    ++count;
  }
  return count;
}

JointInfo World::joint_info(JointId id) const {
  if (!exists(id)) return {};
  const FloatMode mode;
  const RigidWorld& w = state_->rigid;
  const JointRecord& joint = w.joints.records[id.index];
  const JointAnchors anchors = joint_anchors(w, joint);
  return {.kind = joint.kind,
          .a = joint.body_a == kNoBody ? BodyId{} : body_id(w, std::uint32_t(joint.body_a)),
          .b = joint.body_b == kNoBody ? BodyId{} : body_id(w, std::uint32_t(joint.body_b)),
          .anchor_a = anchors.a,
          .anchor_b = anchors.b,
          .break_force = joint.break_force,
          .break_torque = joint.break_torque,
          .collide_connected = joint.collide_connected,
          .enabled = joint_enabled(id)};
}
JointState World::joint_state(JointId id) const {
  if (!exists(id)) return {};
  const FloatMode mode;
  return read_joint(state_->rigid, id.index);
}
JointAxisState World::joint_axis_state(JointId id, JointAxis axis) const {
  if (!exists(id) || int(axis) >= kJointAxisCount) return {};
  const FloatMode mode;
  return read_joint_axis(state_->rigid, id.index, axis);
}
bool World::joint_enabled(JointId id) const {
  if (!exists(id)) return false;
  const JointDetail* const detail = detail_of(state_->rigid.joints, id.index);
  return detail == nullptr || !detail->disabled;
}

BodyColumns World::bodies() const { return read_bodies(*state_, state_->all_bodies, false); }
BodyColumns World::awake_bodies() const { return read_bodies(*state_, state_->awake_bodies, true); }

namespace {

// The points of one contact, from number `count` on. Returns the number behind its last point.
std::size_t list_points(const RigidWorld& w, const Contact& contact, std::span<ContactPoint> out,
                        std::size_t count) {
  if (contact.manifold_room == 0) return count;
  for (const Manifold& manifold : manifolds_of(w.contacts, contact)) {
    for (int k = 0; k < manifold.count; ++k, ++count) {
      if (count >= out.size()) continue;
      const ContactPointState& from = manifold.points[k];
      ContactPoint& point = out[count];
      point.shape_a = shape_id(w, contact.shape_a);
      point.shape_b = shape_id(w, contact.shape_b);
      point.body_a = body_id(w, contact.body_a);
      point.body_b = body_id(w, contact.body_b);
      point.position = w.bodies.poses[contact.body_a].center + from.from_a;
      point.normal = manifold.normal;
      point.tangent_1 = any_perpendicular(manifold.normal);
      point.tangent_2 = cross(manifold.normal, point.tangent_1);
      point.separation = from.separation;
      point.triangle = triangle_at(w, contact, point.position);
      point.normal_impulse = from.total_impulse;
      point.friction_impulse = k == 0 ? manifold.total_friction : Vec3{};
      const BodyMotion& a = w.bodies.motion[contact.body_a];
      const BodyMotion& b = w.bodies.motion[contact.body_b];
      point.relative_velocity = b.linear_velocity + cross(b.angular_velocity, from.from_b) -
                                a.linear_velocity - cross(a.angular_velocity, from.from_a);
    }
  }
  return count;
}

// The points of the contacts of some shapes, in the order of World::contacts.
std::size_t list_points_of(const RigidWorld& w, std::span<const ShapeId> shapes,
                           std::span<ContactPoint> out) {
  Array<std::uint64_t> slots;
  for (const ShapeId id : shapes)
    for_each_contact_of_shape(w.contacts, id.index, [&](std::uint32_t slot) { slots.push_back(slot); });
  Array<std::uint64_t> scratch;
  scratch.resize(slots.size());
  radix_sort_u64(slots.view(), scratch.view());
  std::size_t count = 0;
  for (const std::uint64_t slot : slots)
    count = list_points(w, w.contacts.contacts[std::size_t(slot)], out, count);
  return count;
}

void merge_bounds(const RigidWorld& w, std::uint32_t shape, WorldBounds& out) {
  const Shape& own = w.shapes.colliders[shape].shape;
  if (own.kind == ShapeKind::plane) return;
  const Pose pose = origin_pose(w.bodies, w.shapes.bodies[shape]) * w.shapes.body_from_shape[shape];
  const Aabb box = bounds(own, {{}, pose.orientation});
  const DVec3 low = pose.position + box.low, high = pose.position + box.high;
  const bool first = out.low.x > out.high.x;
  out.low = first ? low : DVec3{min(out.low.x, low.x), min(out.low.y, low.y), min(out.low.z, low.z)};
  out.high = first ? high : DVec3{max(out.high.x, high.x), max(out.high.y, high.y), max(out.high.z, high.z)};
}

}  // namespace

std::size_t World::contacts(std::span<ContactPoint> out) const {
  const FloatMode mode;
  const RigidWorld& w = state_->rigid;
  std::size_t count = 0;
  for (const Contact& contact : w.contacts.contacts) count = list_points(w, contact, out, count);
  return count;
}
std::size_t World::body_contacts(BodyId body, std::span<ContactPoint> out) const {
  if (!exists(body)) return 0;
  const FloatMode mode;
  return list_points_of(state_->rigid, shapes(body), out);
}
std::size_t World::shape_contacts(ShapeId shape, std::span<ContactPoint> out) const {
  if (!exists(shape)) return 0;
  const FloatMode mode;
  return list_points_of(state_->rigid, std::span<const ShapeId>(&shape, 1), out);
}
WorldBounds World::body_bounds(BodyId body) const {
  const FloatMode mode;
  WorldBounds out;
  for (const ShapeId shape : shapes(body)) merge_bounds(state_->rigid, shape.index, out);
  return out;
}
WorldBounds World::shape_bounds(ShapeId shape) const {
  const FloatMode mode;
  WorldBounds out;
  if (exists(shape)) merge_bounds(state_->rigid, shape.index, out);
  return out;
}
JointAxisDef World::joint_axis_def(JointId joint, JointAxis axis) const {
  return exists(joint) ? read_joint_axis_def(state_->rigid, joint.index, axis) : JointAxisDef{};
}
Motor World::motor(JointId joint) const {
  return exists(joint) ? read_motor(state_->rigid.joints.records[joint.index]) : Motor{};
}
PoseDrive World::drive(JointId joint) const {
  if (!exists(joint) || !has_pose_drive(state_->rigid.joints.records[joint.index].kind)) return {};
  const JointDetail* const detail = detail_of(state_->rigid.joints, joint.index);
  return detail != nullptr ? detail->drive : PoseDrive{};
}
MaterialPair World::material_pair(std::uint16_t a, std::uint16_t b) const {
  for (const MaterialPair& row : state_->rigid.material_pairs) {
    if (row.a == min(a, b) && row.b == max(a, b)) return row;
  }
  return {};
}
SurfaceRule World::surface_rule(std::uint16_t id) const {
  for (const SurfaceRule& row : state_->rigid.surface_rules) {
    if (row.id == id) return row;
  }
  return {};
}
bool World::pair_ignored(BodyId a, BodyId b) const {
  return exists(a) && exists(b) && is_pair_ignored(state_->rigid, a.index, b.index);
}
std::optional<CastHit> World::cast_ray_body(BodyId body, DVec3 origin, Vec3 translation) const {
  QueryFilter filter;
  filter.sensors = true;
  filter.soft = false;
  filter.user = &body;
  filter.accepts = [](void* user, ShapeId, BodyId candidate) {
    return candidate == *static_cast<const BodyId*>(user);
  };
  return exists(body) ? cast_ray(origin, translation, filter) : std::nullopt;
}

std::size_t World::contact_pairs(std::span<ContactPair> out) const {
  const FloatMode mode;
  const RigidWorld& w = state_->rigid;
  std::size_t count = 0;
  for (std::uint32_t slot = 0; slot < w.contacts.contacts.size(); ++slot) {
    const Contact& contact = w.contacts.contacts[slot];  // an empty slot touches nothing
    if (contact.touching == 0 || contact.sensor != 0) continue;
    if (slot < w.touches.began.size() && w.touches.began.test(slot)) continue;
    if (count++ >= out.size()) continue;
    float impulse = 0.0f;
    for (const Manifold& manifold : manifolds_of(w.contacts, contact)) {
      for (int k = 0; k < manifold.count; ++k) impulse += manifold.points[k].total_impulse;
    }
    out[count - 1] = {shape_id(w, contact.shape_a), shape_id(w, contact.shape_b), body_id(w, contact.body_a),
                      body_id(w, contact.body_b), impulse};
  }
  return count;
}

const Events& World::events() const { return state_->events; }
std::span<const Problem> World::problems() const { return state_->problems; }

WorldStats World::stats() const {
  const RigidWorld& w = state_->rigid;
  WorldStats counts;
  counts.bodies = int(w.bodies.ids.size());
  counts.shapes = int(w.shapes.ids.size());
  counts.joints = int(w.joints.ids.size());
  counts.colors = state_->solve.colors;
  counts.pairs = int(w.contacts.live);
  counts.fluids = int(state_->fluids.ids.size());
  state_->fluids.for_each(
      [&](const FluidEntry& entry) { counts.liquid_particles += entry.liquid.particles(); });
  counts.softs = int(state_->soft.ids.size());
  state_->soft.for_each([&](const SoftEntry& entry) { counts.soft_vertices += entry.body.particles.count; });
  // Free slots have the flags of static bodies; their contacts touch nothing and have no manifolds.
  for (const BodyFlags& flags : w.bodies.flags) counts.awake_bodies += is_simulated(flags) ? 1 : 0;
  for (const Contact& contact : w.contacts.contacts) {
    counts.touching += contact.touching != 0 ? 1 : 0;
    for (const Manifold& manifold : manifolds_of(w.contacts, contact))
      counts.contact_points += manifold.count;
  }
  return counts;
}

SolverStats World::solver_stats() const {
  const RowStats& rows = state_->solve.rows;
  return {rows.residual, rows.islands, rows.direct, rows.largest, rows.sweeps};
}

double World::time() const { return state_->time; }
std::uint64_t World::step_count() const { return state_->step_count; }
Vec3 World::gravity() const { return state_->rigid.settings.gravity; }
float World::sleep_share() const { return gyre::sleep_share(state_->rigid); }
WorldDef World::def() const {
  const RigidSettings& settings = state_->rigid.settings;
  WorldDef def = state_->def;
  def.gravity = settings.gravity;
  def.stepping.substeps = settings.substeps;
  const MotionSettings motion = motion_settings(state_->rigid);
  def.stepping.integrator = motion.integrator;
  def.stepping.springs = motion.springs;
  def.stepping.time = motion.time;
  if (!state_->rigid.motion_settings.empty()) {
    def.stepping.tolerance = motion.tolerance;
    def.stepping.max_impacts = motion.max_impacts;
  }
  def.stepping.solver = SolverKind::soft_step;
  for (const SolverSettings& solver : state_->rigid.solver) {
    def.stepping.solver = solver.kind;
    def.stepping.solver_options = solver.options;
  }
  def.sleeping = settings.sleeping != 0;
  def.sleep_share = gyre::sleep_share(state_->rigid);
  def.friction_rule = settings.friction_rule;
  def.restitution_rule = settings.restitution_rule;
  return def;
}
StepStats World::step_stats() const { return state_->solve.report; }
SpringStability World::spring_stability() const {
  const FloatMode mode;
  const RigidWorld& w = state_->rigid;
  Arena arena;
  const SpringMode fastest = find_fastest_mode(w, arena);
  SpringStability out;
  out.springs = fastest.springs;
  out.critical_step = std::numeric_limits<double>::infinity();
  if (fastest.springs == 0) return out;
  constexpr double kTurn = 6.283185307179586;  // rad
  out.frequency = fastest.frequency / kTurn;
  out.damping_ratio = fastest.frequency > 0.0 ? fastest.decay / fastest.frequency : 0.0;
  const double step = critical_step(motion_settings(w).integrator, fastest.frequency, fastest.decay);
  if (step < kAnyStep) out.critical_step = step;
  out.joint = joint_id(w, fastest.joint);
  return out;
}
int World::substeps() const { return state_->rigid.settings.substeps; }

Energy World::energy() const {
  const FloatMode mode;
  const RigidWorld& w = state_->rigid;
  const DVec3 gravity(w.settings.gravity);
  Energy energy;
  w.bodies.ids.for_each_live([&](std::uint32_t i) {
    if (!is_movable(w.bodies.flags[i])) return;
    const double mass = double(w.bodies.masses[i].mass);
    const BodyMotion& motion = w.bodies.motion[i];
    energy.kinetic += 0.5 * mass * length_squared(DVec3(motion.linear_velocity)) +
                      0.5 * dot(spin_momentum(w.bodies, i), DVec3(motion.angular_velocity));
    energy.potential -=
        mass * double(w.bodies.forces[i].gravity_scale) * dot(gravity, w.bodies.poses[i].center);
  });
  w.joints.ids.for_each_live([&](std::uint32_t slot) { energy.elastic += spring_energy(w, slot); });
  add_soft_energy(state_->soft, gravity, energy);
  add_fluid_energy(*state_, energy);
  return energy;
}

Momentum World::momentum() const {
  const FloatMode mode;
  const RigidWorld& w = state_->rigid;
  Momentum momentum;
  w.bodies.ids.for_each_live([&](std::uint32_t i) {
    if (!is_movable(w.bodies.flags[i])) return;
    const DVec3 p = double(w.bodies.masses[i].mass) * DVec3(w.bodies.motion[i].linear_velocity);
    momentum.linear += p;
    momentum.angular += cross(w.bodies.poses[i].center, p) + spin_momentum(w.bodies, i);
  });
  add_soft_momentum(state_->soft, momentum);
  add_fluid_momentum(*state_, momentum);
  return momentum;
}

float World::max_penetration() const {
  const RigidWorld& w = state_->rigid;
  float deepest = 0.0f;
  for (const Contact& contact : w.contacts.contacts) {
    if (contact.manifold_room == 0) continue;
    for (const Manifold& manifold : manifolds_of(w.contacts, contact)) {
      for (int k = 0; k < manifold.count; ++k) deepest = max(deepest, 0.0f - manifold.points[k].separation);
    }
  }
  return deepest;
}

std::uint64_t World::hash() const { return hash_state(*state_); }

}  // namespace gyre
