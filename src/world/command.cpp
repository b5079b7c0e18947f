// Executes commands. command_check.cpp has checked their arguments.
#include "world/command.h"

#include "base/float_mode.h"
#include "collision/contact/pair_update.h"
#include "dynamics/soft/soft_contacts.h"
#include "math/rotation.h"
#include "rigid/collision_bodies.h"
#include "rigid/rigid_step.h"
#include "rigid/sleep/island.h"
#include "world/body_commands.h"
#include "world/field_commands.h"
#include "world/fluid_commands.h"
#include "world/joint_commands.h"
#include "world/query_sight.h"
#include "world/soft_commands.h"
#include "world/soft_events.h"
#include "world/world_state.h"

namespace gyre {

namespace {

// Values beyond the range of float must not enter the state.
Vec3 finite_or(Vec3 value, Vec3 otherwise) { return is_finite(value) ? value : otherwise; }

}  // namespace

void wake_if_movable(RigidWorld& w, std::uint32_t body) {
  if (is_movable(w.bodies.flags[body])) wake(w, body);
}

void drop_contacts(RigidWorld& w, std::uint32_t shape) {
  remove_contacts_of_shape(w.contacts, shape, [&](std::uint32_t, const Contact& contact) { report_end(w, contact); }, w.listed);
}

void refresh_proxy(RigidWorld& w, std::uint32_t shape) {
  Proxy& proxy = w.shapes.proxies[shape];
  const BodyFlags& flags = w.bodies.flags[w.shapes.bodies[shape]];
  proxy.motion = is_disabled(flags)              ? ProxyMotion::none
                 : flags.type == BodyType::fixed ? ProxyMotion::fixed
                                                 : ProxyMotion::moving;
  proxy.pushes = flags.type == BodyType::dynamic;
}

namespace {

// Mass, centre and inertia from shapes and overrides; the origin of the body stays at `origin`.
void refresh_mass(RigidWorld& w, std::uint32_t body, const Pose& origin) {
  BodyStore& bodies = w.bodies;
  const Vec3 old_center = bodies.masses[body].center;
  const BodyOverrides given = bodies.overrides[body];
  BodyMass mass;
  mass.size = kUnbounded;
  for (const ShapeId id : bodies.shapes[body]) {
    const float size = w.shapes.colliders[id.index].size;
    if (size > 0.0f) mass.size = min(mass.size, size);
  }
  if (bodies.flags[body].type == BodyType::dynamic) {
    MassProperties own = shapes_mass(w.shapes, bodies.shapes[body]);
    if (given.has_mass != 0) {
      const float scale = own.mass > 0.0f ? given.mass / own.mass : 0.0f;
      own.inertia = scale * own.inertia;
      own.mass = given.mass;
    }
    if (given.has_center != 0) {
      // The inertia moves to the new centre unless it was set, too (Huygens-Steiner).
      own.inertia = own.inertia + point_inertia(own.mass, given.center - own.center);
      own.center = given.center;
    }
    if (given.has_inertia != 0) own.inertia = given.inertia;
    if (!(own.mass > 0.0f)) own.mass = 1.0f;  // a dynamic body without mass would not move
    mass.mass = own.mass;
    mass.inverse_mass = 1.0f / own.mass;
    mass.center = own.center;
    mass.inertia = own.inertia;
    mass.inverse_inertia = inverse(own.inertia);
    const float spread = max(absolute(own.inertia.xx - own.inertia.yy), absolute(own.inertia.yy - own.inertia.zz)) +
                         absolute(own.inertia.xy) + absolute(own.inertia.xz) + absolute(own.inertia.yz);
    mass.isotropic = spread <= 1.0e-6f * own.inertia.xx ? 1u : 0u;
  } else if (given.has_center != 0) {
    mass.center = given.center;
  }
  for (const ShapeId id : bodies.shapes[body]) {
    const Transform& local = w.shapes.body_from_shape[id.index];
    const float distance =
        outer_radius(w.shapes.colliders[id.index].shape, inverse_times(local, mass.center));
    mass.bounding_radius = max(mass.bounding_radius, distance);
  }
  bodies.masses.set(body, mass);
  // The velocity is that of the centre of mass, so it changes when the centre moves in the body.
  BodyMotion& motion = bodies.motion[body];
  const Vec3 carried = cross(motion.angular_velocity, rotate(origin.orientation, mass.center - old_center));
  motion.linear_velocity = finite_or(motion.linear_velocity + carried, motion.linear_velocity);
  bodies.poses[body] = {origin * mass.center, origin.orientation};
  shift_joint_ends(w, body, mass.center - old_center);
  bodies.orientations[body] = origin.orientation;
  refresh_inertia(bodies, body);
  for_each_contact_of_body(w, body, [&](std::uint32_t slot) { invalidate_cache(w.contacts.contacts[slot]); });
  mark_moved(w, body);
}
}  // namespace

void refresh_mass(RigidWorld& w, std::uint32_t body) { refresh_mass(w, body, origin_pose(w.bodies, body)); }

namespace {

// The shapes of a body, ascending.
template <class List>
void insert_sorted(List& list, ShapeId item) {
  std::size_t at = 0;
  while (at < list.size() && list[at].index < item.index) ++at;
  list.insert_at(at, item);
}
template <class List>
void erase_index(List& list, std::uint32_t index) {
  for (std::size_t i = 0; i < list.size(); ++i) {
    if (list[i].index != index) continue;
    list.erase_at(i);
    return;
  }
}

ShapeId attach_shape(RigidWorld& w, std::uint32_t body, const ShapeDef& def) {
  const std::uint32_t shape = add_shape_slot(w.shapes).index;
  w.shapes.bodies[shape] = body;
  w.shapes.body_from_shape.set(shape, {def.local.position, normalized(def.local.orientation)});
  w.shapes.geometry[shape] = def.geometry;
  w.shapes.density[shape] = def.density;
  w.shapes.materials.set(shape, def.material);
  w.shapes.user_data[shape] = def.user_data;
  Proxy& proxy = w.shapes.proxies[shape];
  proxy.body = body;
  proxy.filter = def.filter;
  proxy.sensor = def.sensor;
  refresh_proxy(w, shape);
  refresh_collider(w.shapes, shape);
  const ShapeId id = shape_id(w, shape);
  insert_sorted(w.bodies.shapes[body], id);
  return id;
}

}  // namespace

void refit_body(RigidWorld& w, std::uint32_t body) {
  for (const ShapeId id : w.bodies.shapes[body]) refit_placed_shape(w, id.index);
}

namespace {

std::uint8_t bits(const bool (&axes)[3]) {
  return std::uint8_t((axes[0] ? 1 : 0) | (axes[1] ? 2 : 0) | (axes[2] ? 4 : 0));
}

CommandResult execute(WorldState& s, const AddBody& c) {
  RigidWorld& w = s.rigid;
  const BodyDef& def = c.def;
  const std::uint32_t body = add_body_slot(w.bodies).index;
  BodyFlags& flags = w.bodies.flags[body];
  flags.type = def.type;
  flags.awake = 1;
  flags.can_sleep = def.can_sleep ? 1 : 0;
  flags.continuous = def.continuous ? 1 : 0;
  flags.locked_linear = bits(def.locked.linear);
  flags.locked_angular = bits(def.locked.angular);
  BodyForces& forces = w.bodies.forces[body];
  forces.linear_damping = def.linear_damping;
  forces.angular_damping = def.angular_damping;
  forces.gravity_scale = def.gravity_scale;
  BodyOverrides given;
  if (def.mass) given.has_mass = 1, given.mass = *def.mass;
  if (def.center_of_mass) given.has_center = 1, given.center = *def.center_of_mass;
  if (def.inertia) given.has_inertia = 1, given.inertia = *def.inertia;
  w.bodies.overrides.set(body, given);
  w.bodies.user_data[body] = def.user_data;
  for (const ShapeDef& shape : c.shapes) attach_shape(w, body, shape);
  refresh_mass(w, body, {def.pose.position, normalized(def.pose.orientation)});
  if (def.type != BodyType::fixed) {
    w.bodies.motion[body].linear_velocity = def.linear_velocity + Vec3{};
    w.bodies.motion[body].angular_velocity = def.angular_velocity + Vec3{};
  }
  refit_body(w, body);
  wake_overlapped(s, body);
  return {true, body_id(w, body), {}, {}};
}

CommandResult execute(WorldState& s, const RemoveBody& c) {
  RigidWorld& w = s.rigid;
  const std::uint32_t body = c.body.index;
  wake_if_movable(w, body);
  wake_neighbours(w, body);
  forget_body(s.soft, body);
  forget_ignored_pairs(w, body);
  while (!joints_of(w.bodies, body).empty()) remove_joint(w, joints_of(w.bodies, body).front());
  for (const ShapeId id : w.bodies.shapes[body]) {
    drop_soft_contacts(s, id.index);
    drop_contacts(w, id.index);
    remove_shape_slot(w.shapes, id.index);
  }
  remove_body_slot(w.bodies, body);
  return {true, {}, {}, {}};
}

CommandResult execute(WorldState& s, const AddShape& c) {
  RigidWorld& w = s.rigid;
  wake_if_movable(w, c.body.index);
  const ShapeId id = attach_shape(w, c.body.index, c.def);
  refresh_mass(w, c.body.index);
  refit_body(w, c.body.index);
  wake_overlapped(s, c.body.index);
  return {true, {}, id, {}};
}

CommandResult execute(WorldState& s, const RemoveShape& c) {
  RigidWorld& w = s.rigid;
  const std::uint32_t shape = c.shape.index;
  const std::uint32_t body = w.shapes.bodies[shape];
  wake_if_movable(w, body);
  wake_neighbours(w, body);
  wake_touching(s.soft, body);
  drop_soft_contacts(s, shape);
  drop_contacts(w, shape);
  erase_index(w.bodies.shapes[body], shape);
  remove_shape_slot(w.shapes, shape);
  refresh_mass(w, body);
  return {true, {}, {}, {}};
}

CommandResult execute(WorldState& s, const AddJoint& c) { return {true, {}, {}, add_joint(s.rigid, c.def)}; }

CommandResult execute(WorldState& s, const RemoveJoint& c) {
  remove_joint(s.rigid, c.joint.index);
  return {true, {}, {}, {}};
}

CommandResult execute(WorldState& s, const SetPose& c) {
  RigidWorld& w = s.rigid;
  const std::uint32_t body = c.body.index;
  wake_touching(s.soft, body);
  wake_if_movable(w, body);
  wake_neighbours(w, body);
  const Pose pose{c.pose.position, normalized(c.pose.orientation)};
  w.bodies.poses[body] = {pose * w.bodies.masses[body].center, pose.orientation};
  w.bodies.orientations[body] = pose.orientation;
  refresh_inertia(w.bodies, body);
  for (const ShapeId id : w.bodies.shapes[body]) drop_contacts(w, id.index);
  refit_body(w, body);
  wake_overlapped(s, body);
  return {true, {}, {}, {}};
}

CommandResult execute(WorldState& s, const SetVelocity& c) {
  RigidWorld& w = s.rigid;
  if (w.bodies.flags[c.body.index].type == BodyType::fixed) return {true, {}, {}, {}};
  wake_if_movable(w, c.body.index);
  w.bodies.motion[c.body.index].linear_velocity = c.linear + Vec3{};
  w.bodies.motion[c.body.index].angular_velocity = c.angular + Vec3{};
  if (!can_move(w, c.body.index)) show_halt_to_sensors(w, c.body.index);
  mark_moved(w, c.body.index);
  return {true, {}, {}, {}};
}

CommandResult execute(WorldState& s, const MoveKinematic& c) {
  RigidWorld& w = s.rigid;
  const std::uint32_t body = c.body.index;
  const Quat orientation = normalized(c.pose.orientation);
  const Pose pose{c.pose.position, orientation};
  const DVec3 center = pose * w.bodies.masses[body].center;
  BodyMotion& motion = w.bodies.motion[body];
  motion.linear_velocity =
      finite_or((1.0f / c.seconds) * difference(center, w.bodies.poses[body].center) + Vec3{}, {});
  motion.angular_velocity = finite_or(
      (1.0f / c.seconds) * rotation_between(w.bodies.poses[body].orientation, orientation) + Vec3{}, {});
  if (!can_move(w, body)) show_halt_to_sensors(w, body);
  mark_moved(w, body);
  return {true, {}, {}, {}};
}

CommandResult execute(WorldState& s, const SetType& c) {
  RigidWorld& w = s.rigid;
  const std::uint32_t body = c.body.index;
  wake_touching(s.soft, body);
  if (w.bodies.flags[body].type == c.type) return {true, {}, {}, {}};
  wake_if_movable(w, body);
  wake_neighbours(w, body);
  for (const ShapeId id : w.bodies.shapes[body]) drop_contacts(w, id.index);
  w.bodies.flags[body].type = c.type;
  w.bodies.flags[body].awake = 1;
  activate_constraints_of(w, body);
  if (!is_disabled(w.bodies.flags[body])) w.bodies.flags[body].frozen = kNotFrozen;
  w.bodies.sleep[body] = {};
  if (c.type == BodyType::fixed) clear_motion(w.bodies.motion[body]);
  w.bodies.awake_stale = true;
  refresh_mass(w, body);
  for (const ShapeId id : w.bodies.shapes[body]) refresh_proxy(w, id.index);
  refit_body(w, body);
  wake_overlapped(s, body);
  return {true, {}, {}, {}};
}

CommandResult execute(WorldState& s, const SetGravity& c) {
  if (s.rigid.settings.gravity != c.gravity) wake_all(s.rigid), wake_all(s.soft);
  s.rigid.settings.gravity = c.gravity;
  return {true, {}, {}, {}};
}
CommandResult execute(WorldState& s, const SetGravityScale& c) {
  wake_if_movable(s.rigid, c.body.index);
  s.rigid.bodies.forces[c.body.index].gravity_scale = c.scale;
  return {true, {}, {}, {}};
}
CommandResult execute(WorldState& s, const SetDamping& c) {
  s.rigid.bodies.forces[c.body.index].linear_damping = c.linear;
  s.rigid.bodies.forces[c.body.index].angular_damping = c.angular;
  return {true, {}, {}, {}};
}

// Combines the materials of every contact of a shape again.
void remix(RigidWorld& w, std::uint32_t shape) {
  for_each_contact_of_shape(w.contacts, shape, [&](std::uint32_t slot) {
    Contact& contact = w.contacts.contacts[slot];
    contact.surface = combine_materials(w, w.shapes.materials[contact.shape_a], w.shapes.materials[contact.shape_b]);
  });
}
CommandResult execute(WorldState& s, const SetMaterial& c) {
  RigidWorld& w = s.rigid;
  w.shapes.materials.set(c.shape.index, c.material);
  remix(w, c.shape.index);
  wake_if_movable(w, w.shapes.bodies[c.shape.index]);
  wake_neighbours(w, w.shapes.bodies[c.shape.index]);
  return {true, {}, {}, {}};
}
CommandResult execute(WorldState& s, const SetMaterialPair& c) {
  RigidWorld& w = s.rigid;
  MaterialPair pair = c.pair;
  if (pair.a > pair.b) {
    pair.a = c.pair.b;
    pair.b = c.pair.a;
  }
  std::size_t at = 0;
  while (at < w.material_pairs.size() &&
         (w.material_pairs[at].a < pair.a || (w.material_pairs[at].a == pair.a && w.material_pairs[at].b < pair.b))) {
    ++at;
  }
  if (at < w.material_pairs.size() && w.material_pairs[at].a == pair.a && w.material_pairs[at].b == pair.b) {
    w.material_pairs[at] = pair;
  } else {
    w.material_pairs.insert_at(at, pair);
  }
  w.shapes.ids.for_each_live([&](std::uint32_t shape) { remix(w, shape); });
  wake_all(w), wake_all(s.soft);
  return {true, {}, {}, {}};
}
CommandResult execute(WorldState& s, const SetSurfaceRule& c) {
  Array<SurfaceRule>& rules = s.rigid.surface_rules;
  std::size_t at = 0;
  while (at < rules.size() && rules[at].id < c.rule.id) ++at;
  if (at < rules.size() && rules[at].id == c.rule.id) {
    rules[at] = c.rule;
  } else {
    rules.insert_at(at, c.rule);
  }
  wake_all(s.rigid), wake_all(s.soft);
  return {true, {}, {}, {}};
}
CommandResult execute(WorldState& s, const SetFilter& c) {
  RigidWorld& w = s.rigid;
  const std::uint32_t shape = c.shape.index;
  wake_if_movable(w, w.shapes.bodies[shape]);
  wake_neighbours(w, w.shapes.bodies[shape]);
  wake_touching(s.soft, w.shapes.bodies[shape]);
  drop_contacts(w, shape);
  w.shapes.proxies[shape].filter = c.filter;
  refit_placed_shape(w, shape);
  wake_overlapped(s, w.shapes.bodies[shape]);
  return {true, {}, {}, {}};
}
CommandResult execute(WorldState& s, const SetMotor& c) {
  set_motor(s.rigid, c.joint.index, c.motor);
  return {true, {}, {}, {}};
}
CommandResult execute(WorldState& s, const SetJointAxis& c) {
  set_joint_axis(s.rigid, c.joint.index, c.axis, c.def);
  return {true, {}, {}, {}};
}
CommandResult execute(WorldState& s, const SetDrive& c) {
  set_drive(s.rigid, c.joint.index, c.drive);
  return {true, {}, {}, {}};
}
CommandResult execute(WorldState& s, const SetJointEnabled& c) {
  set_joint_enabled(s.rigid, c.joint.index, c.enabled);
  return {true, {}, {}, {}};
}
CommandResult execute(WorldState& s, const SetSleeping& c) {
  if (!c.enabled) wake_all(s.rigid), wake_all(s.soft);
  s.rigid.settings.sleeping = c.enabled ? 1 : 0;
  return {true, {}, {}, {}};
}
CommandResult execute(WorldState& s, const SetSleepShare& c) {
  s.rigid.sleep_settings.clear();
  if (c.share != kSleepSpeedShare) s.rigid.sleep_settings.push_back({c.share});
  return {true, {}, {}, {}};
}
CommandResult execute(WorldState& s, const SetSleepSpeed& c) {
  BodyStore& bodies = s.rigid.bodies;
  if (c.speed == sleep_speed_of(bodies, c.body.index)) return {true, {}, {}, {}};
  if (c.body.index >= bodies.sleep_speeds.size()) bodies.sleep_speeds.resize(c.body.index + 1);
  bodies.sleep_speeds[c.body.index].speed = c.speed;
  return {true, {}, {}, {}};
}
CommandResult execute(WorldState& s, const SetAwake& c) {
  if (c.awake) {
    wake_if_movable(s.rigid, c.body.index);
  } else {
    force_sleep(s.rigid, s.arena, c.body.index);
  }
  return {true, {}, {}, {}};
}
CommandResult execute(WorldState& s, const SetSubsteps& c) {
  s.rigid.settings.substeps = c.substeps;
  return {true, {}, {}, {}};
}

CommandResult execute(WorldState& s, const SetMotion& c) {
  RigidWorld& w = s.rigid;
  const MotionSettings motion{c.integrator, c.springs, c.time, c.tolerance, c.max_impacts};
  w.motion_settings.clear();
  if (!is_default(motion)) w.motion_settings.push_back(motion);
  if (motion.integrator != IntegratorKind::verlet) w.bodies.last_moves.clear();
  return {true, {}, {}, {}};
}

CommandResult execute(WorldState& s, const SetSolver& c) {
  s.rigid.solver.clear();
  if (c.solver != SolverKind::soft_step) s.rigid.solver.push_back({c.solver, c.options});
  s.def.stepping.solver_options = c.options;
  return {true, {}, {}, {}};
}

CommandResult execute(WorldState& s, const SetCombineRules& c) {
  RigidWorld& w = s.rigid;
  if (w.settings.friction_rule == c.friction && w.settings.restitution_rule == c.restitution) return {true, {}, {}, {}};
  w.settings.friction_rule = c.friction;
  w.settings.restitution_rule = c.restitution;
  w.shapes.ids.for_each_live([&](std::uint32_t shape) { remix(w, shape); });
  wake_all(w), wake_all(s.soft);
  return {true, {}, {}, {}};
}

// Sums beyond the range of float are clamped.
Vec3 bounded(Vec3 v) {
  constexpr float kMax = 3.0e38f;  // just below the largest float
  return {clamp(v.x, -kMax, kMax), clamp(v.y, -kMax, kMax), clamp(v.z, -kMax, kMax)};
}
CommandResult execute(WorldState& s, const AddForce& c) {
  const std::uint32_t body = c.body.index;
  if (!is_movable(s.rigid.bodies.flags[body])) return {true, {}, {}, {}};
  if (c.force != Vec3{} || c.torque != Vec3{}) wake_if_movable(s.rigid, body);
  BodyForces& forces = s.rigid.bodies.forces[body];
  forces.force = bounded(forces.force + c.force);
  forces.torque = bounded(forces.torque + c.torque);
  return {true, {}, {}, {}};
}
CommandResult execute(WorldState& s, const AddImpulse& c) {
  const std::uint32_t body = c.body.index;
  if (!is_movable(s.rigid.bodies.flags[body])) return {true, {}, {}, {}};
  wake_if_movable(s.rigid, body);
  BodyMotion& motion = s.rigid.bodies.motion[body];
  const BodyInertia& inertia = s.rigid.bodies.inertia[body];
  motion.linear_velocity = bounded(motion.linear_velocity + inertia.inverse_mass * c.impulse) + Vec3{};
  motion.angular_velocity = bounded(motion.angular_velocity + inertia.inverse * c.angular) + Vec3{};
  mark_moved(s.rigid, body);
  return {true, {}, {}, {}};
}
CommandResult execute(WorldState& s, const SetMass& c) {
  set_mass(s, c.body.index, c.mass);
  return {true, {}, {}, {}};
}
CommandResult execute(WorldState& s, const SetDensity& c) {
  set_density(s, c.shape.index, c.density);
  return {true, {}, {}, {}};
}
CommandResult execute(WorldState& s, const SetLockedAxes& c) {
  set_locked_axes(s, c.body.index, c.locked);
  return {true, {}, {}, {}};
}
CommandResult execute(WorldState& s, const SetContinuous& c) {
  s.rigid.bodies.flags[c.body.index].continuous = c.continuous ? 1 : 0;
  return {true, {}, {}, {}};
}
CommandResult execute(WorldState& s, const SetCanSleep& c) {
  set_can_sleep(s, c.body.index, c.can_sleep);
  return {true, {}, {}, {}};
}
CommandResult execute(WorldState& s, const SetSensor& c) {
  set_sensor(s, c.shape.index, c.sensor);
  return {true, {}, {}, {}};
}
CommandResult execute(WorldState& s, const SetShape& c) {
  set_shape(s, c.shape.index, c.geometry, c.local);
  return {true, {}, {}, {}};
}
CommandResult execute(WorldState& s, const SetBodyUserData& c) {
  s.rigid.bodies.user_data[c.body.index] = c.user_data;
  return {true, {}, {}, {}};
}
CommandResult execute(WorldState& s, const SetShapeUserData& c) {
  s.rigid.shapes.user_data[c.shape.index] = c.user_data;
  return {true, {}, {}, {}};
}
CommandResult execute(WorldState& s, const SetBreakLoad& c) {
  JointRecord& joint = s.rigid.joints.records[c.joint.index];
  joint.break_force = c.force;
  joint.break_torque = c.torque;
  return {true, {}, {}, {}};
}
CommandResult execute(WorldState& s, const SetPairIgnored& c) {
  set_pair_ignored(s, c.a.index, c.b.index, c.ignored);
  return {true, {}, {}, {}};
}
CommandResult execute(WorldState& s, const SetEnabled& c) {
  set_enabled(s, c.body.index, c.enabled);
  return {true, {}, {}, {}};
}
CommandResult execute(WorldState& s, const Step& c) {
  step_world(s, c.seconds);
  return {true, {}, {}, {}};
}

}  // namespace

void remove_joint_now(WorldState& state, std::uint32_t joint) { remove_joint(state.rigid, joint); }

CommandResult submit(WorldState& state, const Command& command) {
  const FloatMode mode;  // commands and the serial parts of a step compute, too
  const Error why = check_command(state, command);
  if (why) {
    report_problem(state, why.code, {}, "%s", why.message);
    return {};
  }
  if (state.log != nullptr) state.log->on_command(command);
  const CommandResult result = std::visit([&](const auto& c) { return execute(state, c); }, command);
  note_change(state);
  if (state.log != nullptr && std::holds_alternative<Step>(command)) state.log->on_step_done(state);
  return result;
}

}  // namespace gyre
