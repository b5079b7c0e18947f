// Every change of a world as a small struct, and the one function through which all changes pass: it checks the
// command, shows it to the log, and executes it. A recording is a list of commands, so it cannot miss a change.
#pragma once

#include "fluid/store/fluid_store.h"
#include "soft/store/soft_store.h"
#include "world/flat_joint.h"

#include <gyre/defs.h>
#include <gyre/fields.h>
#include <gyre/fluid.h>
#include <gyre/result.h>
#include <gyre/soft.h>
#include <gyre/world.h>

#include <optional>
#include <variant>
#include <vector>

namespace gyre {

struct WorldState;

// Without BodyDef::sleep_speed and BodyDef::enabled, which are commands of their own: they are younger than the first recordings.
struct AddBody {
  BodyDef def;
  std::vector<ShapeDef> shapes;
};
struct RemoveBody {
  BodyId body;
};
struct AddShape {
  BodyId body;
  ShapeDef def;
};
struct RemoveShape {
  ShapeId shape;
};
struct AddJoint {
  FlatJoint def;
};
struct RemoveJoint {
  JointId joint;
};
struct SetPose {
  BodyId body;
  Pose pose;
};
struct SetVelocity {
  BodyId body;
  Vec3 linear, angular;
};
struct MoveKinematic {
  BodyId body;
  Pose pose;
  float seconds = 0;
};
struct SetType {
  BodyId body;
  BodyType type = BodyType::dynamic;
};
struct SetGravity {
  Vec3 gravity;
};
struct SetGravityScale {
  BodyId body;
  float scale = 1;
};
struct SetDamping {
  BodyId body;
  float linear = 0, angular = 0;
};
struct SetMaterial {
  ShapeId shape;
  Material material;
};
struct SetMaterialPair {
  MaterialPair pair;
};
struct SetSurfaceRule {
  SurfaceRule rule;
};
struct SetFilter {
  ShapeId shape;
  Filter filter;
};
struct SetMotor {
  JointId joint;
  Motor motor;
};
struct SetJointAxis {
  JointId joint;
  JointAxis axis = JointAxis::linear_x;
  JointAxisDef def;
};
struct SetDrive {
  JointId joint;
  PoseDrive drive;
};
struct SetJointEnabled {
  JointId joint;
  bool enabled = true;
};
struct SetSleeping {
  bool enabled = true;
};
struct SetAwake {
  BodyId body;
  bool awake = true;
};
struct SetSubsteps {
  int substeps = 4;
};
struct SetSleepShare {
  float share = 0;
};
struct SetSleepSpeed {
  BodyId body;
  float speed = 0;
};
struct SetSolver {
  SolverKind solver = SolverKind::soft_step;
  SolverOptions options;
};
struct AddForce {
  BodyId body;
  Vec3 force, torque;
};
struct AddImpulse {
  BodyId body;
  Vec3 impulse, angular;
};
struct SetCombineRules {
  CombineRule friction = CombineRule::geometric_mean;
  CombineRule restitution = CombineRule::maximum;
};
struct AddField {
  FieldDef def;
};
struct SetField {
  FieldId field;
  FieldDef def;
};
struct RemoveField {
  FieldId field;
};
struct Explode {
  ExplosionDef def;
};
struct SetMotion {
  IntegratorKind integrator = IntegratorKind::semi_implicit_euler;
  SpringKind springs = SpringKind::implicit;
  TimeStepping time = TimeStepping::fixed;
  float tolerance = 1.0e-5f;
  int max_impacts = 128;
};
struct AddSoft {
  std::shared_ptr<const SoftDef> def;
};
struct RemoveSoft {
  SoftId soft;
};
// A null body is the world.
struct AttachSoft {
  SoftId soft;
  int vertex = 0;
  BodyId body;
};
struct ReleaseSoft {
  SoftId soft;
  int vertex = 0;
};
// Either list may be empty: it stays as it is.
struct SetVertices {
  SoftId soft;
  std::vector<DVec3> positions;
  std::vector<Vec3> velocities;
};
// No targets: limits end. Normals and backstops may be empty.
struct SetVertexLimits {
  SoftId soft;
  std::vector<DVec3> targets;
  std::vector<float> distances;
  std::vector<Vec3> normals;
  std::vector<float> backstops;
};
struct AddFluid {
  std::shared_ptr<const FluidDef> def;
};
struct RemoveFluid {
  FluidId fluid;
};
struct SetEmitters {
  FluidId fluid;
  std::vector<FluidEmitter> emitters;
};
struct Step {
  float seconds = 0;
};
struct SetMass {
  BodyId body;
  MassDef mass;
};
struct SetDensity {
  ShapeId shape;
  float density = 0;
};
struct SetLockedAxes {
  BodyId body;
  LockedAxes locked;
};
struct SetContinuous {
  BodyId body;
  bool continuous = false;
};
struct SetCanSleep {
  BodyId body;
  bool can_sleep = true;
};
struct SetSensor {
  ShapeId shape;
  bool sensor = false;
};
// Members that are absent stay.
struct SetShape {
  ShapeId shape;
  std::optional<AnyShape> geometry;
  std::optional<Transform> local;
};
struct SetBodyUserData {
  BodyId body;
  std::uint64_t user_data = 0;
};
struct SetShapeUserData {
  ShapeId shape;
  std::uint64_t user_data = 0;
};
struct SetBreakLoad {
  JointId joint;
  float force = 0, torque = 0;
};
struct SetPairIgnored {
  BodyId a, b;
  bool ignored = true;
};
struct SetFluidPose {
  FluidId fluid;
  Pose pose;
};
struct SetFluidVelocity {
  FluidId fluid;
  Vec3 linear, angular;
};

struct SetEnabled {
  BodyId body;
  bool enabled = true;
};

struct AddCoupling {
  CouplingDef def;
};
// A null body is the world.
struct AttachPoint {
  SoftId soft;
  SoftPoint point;
  BodyId body;
};
struct ReleasePoints {
  SoftId soft;
  BodyId body;
};
struct RemoveCoupling {
  CouplingId coupling;
};

// Recordings store the index of a command in this list: append new ones.
using Command = std::variant<AddBody, RemoveBody, AddShape, RemoveShape, AddJoint, RemoveJoint, SetPose, SetVelocity,
                             MoveKinematic, SetType, SetGravity, SetGravityScale, SetDamping, SetMaterial, SetMaterialPair,
                             SetFilter, SetMotor, SetSleeping, SetAwake, SetSubsteps, AddForce, AddImpulse, Step, SetCombineRules,
                             SetSurfaceRule, AddField, SetField, RemoveField, Explode, SetJointAxis, SetDrive, SetJointEnabled,
                             SetMotion, SetSolver, AddSoft, RemoveSoft, AttachSoft, ReleaseSoft, SetVertices, AddFluid, RemoveFluid, SetEmitters,
                             SetSleepShare, SetSleepSpeed, SetMass, SetDensity, SetLockedAxes, SetContinuous, SetCanSleep, SetSensor, SetShape,
                             SetBodyUserData, SetShapeUserData, SetBreakLoad, SetPairIgnored, SetEnabled, AddCoupling,
                             RemoveCoupling, SetFluidPose, SetFluidVelocity, SetVertexLimits, AttachPoint, ReleasePoints>;

// The result of a command: success, and the id of the new object.
struct CommandResult {
  bool done = false;
  BodyId body;
  ShapeId shape;
  JointId joint;
  FieldId field{};
  SoftId soft{};
  FluidId fluid{};
  CouplingId coupling{};
};

// Checks the command, shows it to the log and executes it. A refused command changes nothing and is reported as one
// problem.
CommandResult submit(WorldState& state, const Command& command);

// Removes a joint that broke, as part of a step and not as a command.
void remove_joint_now(WorldState& state, std::uint32_t joint);

// Why a command would be refused; code none if it would not. See command_check.cpp.
Error check_command(const WorldState& state, const Command& command);

}  // namespace gyre
