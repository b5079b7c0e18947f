// The public World: turns calls into commands.
#include <gyre/world.h>

#include "base/float_mode.h"
#include "world/command.h"
#include "world/joint_reading.h"
#include "world/world_state.h"

namespace gyre {

Result<World> World::create(const WorldDef& def) {
  const Error why = check_world_def(def);
  if (why) return why;
  return World(make_world_state(def));
}

World::World(std::unique_ptr<WorldState> state) : state_(std::move(state)) {}
World::~World() = default;
World::World(World&&) noexcept = default;
World& World::operator=(World&&) noexcept = default;

BodyId World::add_body(const BodyDef& body, const ShapeDef& shape) {
  return add_body(body, std::span<const ShapeDef>(&shape, 1));
}
BodyId World::add_body(const BodyDef& body, std::span<const ShapeDef> shapes) {
  const BodyId id = submit(*state_, AddBody{body, {shapes.begin(), shapes.end()}}).body;
  if (id && body.sleep_speed != 0.0f) submit(*state_, SetSleepSpeed{id, body.sleep_speed});
  if (id && !body.enabled) submit(*state_, SetEnabled{id, false});
  return id;
}
bool World::remove_body(BodyId body) { return submit(*state_, RemoveBody{body}).done; }
ShapeId World::add_shape(BodyId body, const ShapeDef& shape) { return submit(*state_, AddShape{body, shape}).shape; }
bool World::remove_shape(ShapeId shape) { return submit(*state_, RemoveShape{shape}).done; }
JointId World::add_joint(const JointDef& joint) { return submit(*state_, AddJoint{flatten(joint)}).joint; }
bool World::remove_joint(JointId joint) { return submit(*state_, RemoveJoint{joint}).done; }

bool World::set_pose(BodyId body, const Pose& pose) { return submit(*state_, SetPose{body, pose}).done; }
bool World::set_velocity(BodyId body, Vec3 linear, Vec3 angular) {
  return submit(*state_, SetVelocity{body, linear, angular}).done;
}
bool World::move_kinematic(BodyId body, const Pose& pose, float seconds) {
  return submit(*state_, MoveKinematic{body, pose, seconds}).done;
}
bool World::move_kinematics(std::span<const BodyId> bodies, std::span<const Pose> poses, float seconds) {
  if (bodies.size() != poses.size()) {
    report_problem(*state_, ErrorCode::invalid_argument, {}, "move_kinematics: %zu bodies, but %zu poses",
                   bodies.size(), poses.size());
    return false;
  }
  bool all = true;
  for (std::size_t i = 0; i < bodies.size(); ++i) all = move_kinematic(bodies[i], poses[i], seconds) && all;
  return all;
}
bool World::set_mass(BodyId body, const MassDef& mass) { return submit(*state_, SetMass{body, mass}).done; }
bool World::set_density(ShapeId shape, float density) {
  return submit(*state_, SetDensity{shape, density}).done;
}
bool World::set_locked_axes(BodyId body, const LockedAxes& locked) {
  return submit(*state_, SetLockedAxes{body, locked}).done;
}
bool World::set_enabled(BodyId body, bool enabled) {
  return submit(*state_, SetEnabled{body, enabled}).done;
}
bool World::set_continuous(BodyId body, bool continuous) {
  return submit(*state_, SetContinuous{body, continuous}).done;
}
bool World::set_can_sleep(BodyId body, bool can_sleep) {
  return submit(*state_, SetCanSleep{body, can_sleep}).done;
}
bool World::set_sensor(ShapeId shape, bool sensor) { return submit(*state_, SetSensor{shape, sensor}).done; }
bool World::set_geometry(ShapeId shape, const AnyShape& geometry) {
  return submit(*state_, SetShape{shape, geometry, {}}).done;
}
bool World::set_local_transform(ShapeId shape, const Transform& local) {
  return submit(*state_, SetShape{shape, {}, local}).done;
}
bool World::set_user_data(BodyId body, std::uint64_t user_data) {
  return submit(*state_, SetBodyUserData{body, user_data}).done;
}
bool World::set_user_data(ShapeId shape, std::uint64_t user_data) {
  return submit(*state_, SetShapeUserData{shape, user_data}).done;
}
bool World::set_break_load(JointId joint, float force, float torque) {
  return submit(*state_, SetBreakLoad{joint, force, torque}).done;
}
bool World::set_pair_ignored(BodyId a, BodyId b, bool ignored) {
  return submit(*state_, SetPairIgnored{a, b, ignored}).done;
}
void World::set_problem_hook(const ProblemHook& hook) { state_->problem_hook = hook; }

bool World::set_type(BodyId body, BodyType type) { return submit(*state_, SetType{body, type}).done; }
bool World::set_gravity(Vec3 gravity) { return submit(*state_, SetGravity{gravity}).done; }
bool World::set_gravity_scale(BodyId body, float scale) { return submit(*state_, SetGravityScale{body, scale}).done; }
bool World::set_damping(BodyId body, float linear, float angular) {
  return submit(*state_, SetDamping{body, linear, angular}).done;
}
bool World::set_material(ShapeId shape, const Material& material) { return submit(*state_, SetMaterial{shape, material}).done; }
bool World::set_material_pair(const MaterialPair& pair) { return submit(*state_, SetMaterialPair{pair}).done; }
bool World::set_surface_rule(const SurfaceRule& rule) { return submit(*state_, SetSurfaceRule{rule}).done; }
FieldId World::add_field(const FieldDef& field) { return submit(*state_, AddField{field}).field; }
bool World::set_field(FieldId field, const FieldDef& def) { return submit(*state_, SetField{field, def}).done; }
bool World::remove_field(FieldId field) { return submit(*state_, RemoveField{field}).done; }
SoftId World::add_rope(const RopeDef& rope) {
  return submit(*state_, AddSoft{std::make_shared<const SoftDef>(rope)}).soft;
}
SoftId World::add_cloth(const ClothDef& cloth) {
  return submit(*state_, AddSoft{std::make_shared<const SoftDef>(cloth)}).soft;
}
SoftId World::add_solid(const SolidDef& solid) {
  return submit(*state_, AddSoft{std::make_shared<const SoftDef>(solid)}).soft;
}
bool World::remove_soft(SoftId soft) { return submit(*state_, RemoveSoft{soft}).done; }
FluidId World::add_gas(const GasDef& gas) {
  return submit(*state_, AddFluid{std::make_shared<const FluidDef>(gas)}).fluid;
}
FluidId World::add_liquid(const LiquidDef& liquid) {
  return submit(*state_, AddFluid{std::make_shared<const FluidDef>(liquid)}).fluid;
}
bool World::remove_fluid(FluidId fluid) { return submit(*state_, RemoveFluid{fluid}).done; }
bool World::set_emitters(FluidId fluid, std::span<const FluidEmitter> emitters) {
  return submit(*state_, SetEmitters{fluid, {emitters.begin(), emitters.end()}}).done;
}
bool World::set_fluid_pose(FluidId fluid, const Pose& pose) {
  return submit(*state_, SetFluidPose{fluid, pose}).done;
}
bool World::set_fluid_velocity(FluidId fluid, Vec3 linear, Vec3 angular) {
  return submit(*state_, SetFluidVelocity{fluid, linear, angular}).done;
}
namespace {

// A null body of a command is the world, that of a caller is an error.
bool refuses_holder(WorldState& s, BodyId body, bool exists, const char* what) {
  if (!exists)
    report_problem(s, ErrorCode::stale_id, body, "%s: body %u (generation %u) does not exist in this world", what, body.index,
                   unsigned(body.generation));
  return !exists;
}

}  // namespace

bool World::attach(SoftId soft, int vertex, BodyId body) {
  if (refuses_holder(*state_, body, exists(body), "attach")) return false;
  return submit(*state_, AttachSoft{soft, vertex, body}).done;
}
bool World::attach_point(SoftId soft, const SoftPoint& point, BodyId body) {
  if (refuses_holder(*state_, body, exists(body), "attach_point")) return false;
  return submit(*state_, AttachPoint{soft, point, body}).done;
}
bool World::pin_point(SoftId soft, const SoftPoint& point) { return submit(*state_, AttachPoint{soft, point, {}}).done; }
bool World::release_points(SoftId soft, BodyId body) { return submit(*state_, ReleasePoints{soft, body}).done; }
bool World::pin(SoftId soft, int vertex) { return submit(*state_, AttachSoft{soft, vertex, {}}).done; }
bool World::release(SoftId soft, int vertex) { return submit(*state_, ReleaseSoft{soft, vertex}).done; }
bool World::set_vertices(SoftId soft, std::span<const DVec3> positions, std::span<const Vec3> velocities) {
  return submit(*state_, SetVertices{soft, {positions.begin(), positions.end()}, {velocities.begin(), velocities.end()}}).done;
}
bool World::set_vertex_limits(SoftId soft, std::span<const DVec3> targets, std::span<const float> distances, std::span<const Vec3> normals,
                              std::span<const float> backstops) {
  return submit(*state_, SetVertexLimits{soft,
                                         {targets.begin(), targets.end()},
                                         {distances.begin(), distances.end()},
                                         {normals.begin(), normals.end()},
                                         {backstops.begin(), backstops.end()}})
      .done;
}

bool World::explode(const ExplosionDef& explosion) { return submit(*state_, Explode{explosion}).done; }
bool World::set_filter(ShapeId shape, const Filter& filter) { return submit(*state_, SetFilter{shape, filter}).done; }
bool World::set_joint_axis(JointId joint, JointAxis axis, const JointAxisDef& def) {
  return submit(*state_, SetJointAxis{joint, axis, def}).done;
}
bool World::set_drive(JointId joint, const PoseDrive& drive) { return submit(*state_, SetDrive{joint, drive}).done; }
bool World::set_joint_enabled(JointId joint, bool enabled) { return submit(*state_, SetJointEnabled{joint, enabled}).done; }
bool World::set_motor(JointId joint, const Motor& motor) { return submit(*state_, SetMotor{joint, motor}).done; }
bool World::set_sleeping(bool enabled) { return submit(*state_, SetSleeping{enabled}).done; }
bool World::set_sleep_share(float share) { return submit(*state_, SetSleepShare{share}).done; }
bool World::set_sleep_speed(BodyId body, float speed) { return submit(*state_, SetSleepSpeed{body, speed}).done; }
bool World::set_awake(BodyId body, bool awake) { return submit(*state_, SetAwake{body, awake}).done; }
bool World::set_solver(SolverKind solver, const SolverOptions& options) {
  return submit(*state_, SetSolver{solver, options}).done;
}
bool World::set_substeps(int substeps) { return submit(*state_, SetSubsteps{substeps}).done; }

bool World::set_integrator(IntegratorKind integrator) {
  const MotionSettings m = motion_settings(state_->rigid);
  return submit(*state_, SetMotion{integrator, m.springs, m.time, m.tolerance, m.max_impacts}).done;
}
bool World::set_springs(SpringKind springs) {
  const MotionSettings m = motion_settings(state_->rigid);
  return submit(*state_, SetMotion{m.integrator, springs, m.time, m.tolerance, m.max_impacts}).done;
}
bool World::set_time_stepping(TimeStepping time, float tolerance, int max_impacts) {
  const MotionSettings m = motion_settings(state_->rigid);
  return submit(*state_, SetMotion{m.integrator, m.springs, time, tolerance, max_impacts}).done;
}

bool World::set_combine_rules(CombineRule friction, CombineRule restitution) {
  return submit(*state_, SetCombineRules{friction, restitution}).done;
}

namespace {

// Why `def` cannot be the settings of the world from now on; code none if it can.
Error check_change(const WorldState& s, const WorldDef& def) {
  if (s.stepping) return make_error(ErrorCode::busy, "the world is in the middle of a step");
  return check_world_def(def);
}
bool refuse_change(WorldState& s, const Error& why) {
  report_problem(s, why.code, {}, "%s", why.message);
  return false;
}

}  // namespace

bool World::set_threads(int threads) {
  WorldDef new_def = state_->def;
  new_def.threads = threads;
  Error why = check_change(*state_, new_def);
  if (why.ok() && new_def.host_tasks.run != nullptr) {
    why = make_error(ErrorCode::unsupported, "threads: this world uses the host's own tasks");
  }
  if (why) return refuse_change(*state_, why);
  state_->tasks = std::make_unique<TaskSystem>(threads);
  state_->def.threads = threads;
  return true;
}
bool World::set_broad_phase(BroadPhaseKind kind) {
  WorldDef new_def = state_->def;
  new_def.stepping.broad_phase = kind;
  const Error why = check_change(*state_, new_def);
  if (why) return refuse_change(*state_, why);
  // The next step builds it from all boxes, including the changed ones.
  state_->rigid.broadphase = make_broadphase(kind);
  state_->rigid.broadphase_stale = true;
  state_->queried_changes.store(kNothingQueried, std::memory_order_relaxed);
  state_->def.stepping.broad_phase = kind;
  return true;
}

bool World::add_force(BodyId body, Vec3 force) { return submit(*state_, AddForce{body, force, {}}).done; }
bool World::add_force_at(BodyId body, Vec3 force, DVec3 point) {
  const FloatMode mode;
  // t = (p - COM) x f. The centre of a stale body is zero; its command is refused anyway.
  return submit(*state_, AddForce{body, force, cross(difference(point, center_of_mass(body)), force)}).done;
}
bool World::add_torque(BodyId body, Vec3 torque) { return submit(*state_, AddForce{body, {}, torque}).done; }
bool World::add_impulse(BodyId body, Vec3 impulse) { return submit(*state_, AddImpulse{body, impulse, {}}).done; }
bool World::add_impulse_at(BodyId body, Vec3 impulse, DVec3 point) {
  const FloatMode mode;
  return submit(*state_, AddImpulse{body, impulse, cross(difference(point, center_of_mass(body)), impulse)}).done;
}
bool World::add_angular_impulse(BodyId body, Vec3 impulse) { return submit(*state_, AddImpulse{body, {}, impulse}).done; }

bool World::add_joint_load(JointId joint, JointAxis axis, float load) {
  const FloatMode mode;
  const bool there = exists(joint);
  JointLoad on;
  if (!there || !joint_enabled(joint) || !read_joint_load(state_->rigid, joint.index, axis, load, on)) {
    report_problem(*state_, there ? ErrorCode::invalid_argument : ErrorCode::stale_id, {},
                   "add_joint_load: joint %u %s", joint.index,
                   there ? "is not enabled or has no such axis to act on" : "does not exist in this world");
    return false;
  }
  bool done = true;
  if (on.a) done = submit(*state_, AddForce{on.a, -on.force, on.torque_a}).done && done;
  if (on.b) done = submit(*state_, AddForce{on.b, on.force, on.torque_b}).done && done;
  return done;
}

bool World::step(float seconds) { return submit(*state_, Step{seconds}).done; }

}  // namespace gyre
