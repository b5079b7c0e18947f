// The preconditions of every command. A message names object, field, value and allowed range.
#include "world/field_commands.h"
#include "world/joint_commands.h"
#include "world/refusal.h"
#include "world/fluid_commands.h"
#include "world/soft_commands.h"
#include "world/world_state.h"

#include <cstdio>

namespace gyre {

namespace {

Error ok() { return {}; }

Error check_body(const WorldState& s, BodyId id, const char* what) {
  const IdPool& ids = s.rigid.bodies.ids;
  if (id && id.world == s.number && ids.live(id.index) && std::uint16_t(ids.generation(id.index)) == id.generation) return ok();
  return make_error(ErrorCode::stale_id, "%s: body %u (generation %u) does not exist in this world", what, id.index,
                    unsigned(id.generation));
}
Error check_shape_id(const WorldState& s, ShapeId id, const char* what) {
  const IdPool& ids = s.rigid.shapes.ids;
  if (id && id.world == s.number && ids.live(id.index) && std::uint16_t(ids.generation(id.index)) == id.generation) return ok();
  return make_error(ErrorCode::stale_id, "%s: shape %u (generation %u) does not exist in this world", what, id.index,
                    unsigned(id.generation));
}
Error check_joint_id(const WorldState& s, JointId id, const char* what) {
  const IdPool& ids = s.rigid.joints.ids;
  if (id && id.world == s.number && ids.live(id.index) && std::uint16_t(ids.generation(id.index)) == id.generation) return ok();
  return make_error(ErrorCode::stale_id, "%s: joint %u (generation %u) does not exist in this world", what, id.index,
                    unsigned(id.generation));
}

Error check_finite(const char* field, Vec3 v) {
  if (is_finite(v)) return ok();
  return refuse("%s is (%g, %g, %g); every component must be finite", field, double(v.x), double(v.y), double(v.z));
}
Error check_range(const char* field, float value, float low, float high) {
  if (is_finite(value) && value >= low && value <= high) return ok();
  return refuse("%s is %g; it must lie within %g and %g", field, double(value), double(low), double(high));
}
Error check_pose(const char* field, const Pose& pose) {
  const DVec3 p = pose.position;
  if (!is_finite(p) || absolute(p.x) > kMaxPosition || absolute(p.y) > kMaxPosition ||
      absolute(p.z) > kMaxPosition) {
    return refuse("%s.position is (%g, %g, %g); every component must be finite and within 1e12 m", field, p.x, p.y, p.z);
  }
  const Quat q = pose.orientation;
  const float size = dot(q, q);
  if (!is_finite(q) || !(size > 1.0e-12f) || !is_finite(size)) {
    return refuse("%s.orientation is (%g, %g, %g, %g); it must be a finite quaternion that is not zero", field, double(q.x),
                  double(q.y), double(q.z), double(q.w));
  }
  return ok();
}

Error check_material(const char* field, const Material& m) {
  char name[64];
  const auto member = [&](const char* what) {
    std::snprintf(name, sizeof name, "%s.%s", field, what);
    return name;
  };
  Error e = check_range(member("static_friction"), m.static_friction, 0.0f, 1.0e6f);
  if (e.ok()) e = check_range(member("dynamic_friction"), m.dynamic_friction, 0.0f, 1.0e6f);
  if (e.ok()) e = check_range(member("restitution"), m.restitution, 0.0f, 1.0f);
  if (e.ok()) e = check_range(member("rolling_friction"), m.rolling_friction, 0.0f, 1.0e6f);
  if (e.ok()) e = check_range(member("spinning_friction"), m.spinning_friction, 0.0f, 1.0e6f);
  return e;
}

Error check_shape_def(const ShapeDef& def, BodyType type) {
  Error e = check_shape(def.geometry);
  if (e) return e;
  e = check_pose("shape.local", {DVec3(def.local.position), def.local.orientation});
  if (e.ok()) e = check_range("shape.density", def.density, 0.0f, 1.0e20f);
  if (e.ok()) e = check_material("shape.material", def.material);
  if (e) return e;
  if (type == BodyType::dynamic && !is_convex(make_shape(def.geometry).kind)) {
    return make_error(ErrorCode::invalid_geometry,
                      "shape.geometry is a %s; dynamic bodies need convex shapes (decompose it, or make the body fixed)",
                      to_string(make_shape(def.geometry).kind));
  }
  return ok();
}

template <class Def>  // BodyDef or MassDef
Error check_mass_overrides(const Def& def) {
  if (def.mass && !(is_finite(*def.mass) && *def.mass > 0.0f)) {
    return refuse("body.mass is %g; it must be finite and above 0", double(*def.mass));
  }
  if (def.center_of_mass) {
    Error e = check_finite("body.center_of_mass", *def.center_of_mass);
    const float farthest = largest(absolute(*def.center_of_mass));
    if (e.ok())
      e = check_range("body.center_of_mass", farthest, 0.0f, float(kMaxPosition));
    if (e) return e;
  }
  if (def.inertia) return check_inertia(*def.inertia);
  return ok();
}

Error check(const WorldState&, const AddBody& c) {
  const BodyDef& d = c.def;
  Error e = check_pose("body.pose", d.pose);
  if (e.ok()) e = check_finite("body.linear_velocity", d.linear_velocity);
  if (e.ok()) e = check_finite("body.angular_velocity", d.angular_velocity);
  if (e.ok()) e = check_range("body.linear_damping", d.linear_damping, 0.0f, 1.0e6f);
  if (e.ok()) e = check_range("body.angular_damping", d.angular_damping, 0.0f, 1.0e6f);
  if (e.ok()) e = check_range("body.gravity_scale", d.gravity_scale, -1.0e6f, 1.0e6f);
  if (e.ok()) e = check_range("body.sleep_speed", d.sleep_speed, 0.0f, 1.0e6f);
  if (e.ok()) e = check_mass_overrides(d);
  for (const ShapeDef& shape : c.shapes) {
    if (e.ok()) e = check_shape_def(shape, d.type);
  }
  return e;
}
Error check(const WorldState& s, const RemoveBody& c) { return check_body(s, c.body, "remove_body"); }
Error check(const WorldState& s, const AddShape& c) {
  const Error e = check_body(s, c.body, "add_shape");
  return e ? e : check_shape_def(c.def, s.rigid.bodies.flags[c.body.index].type);
}
Error check(const WorldState& s, const RemoveShape& c) { return check_shape_id(s, c.shape, "remove_shape"); }

Error check_motor(const Motor& m) {
  Error e = check_range("motor.target_velocity", m.target_velocity, -1.0e6f, 1.0e6f);
  if (e.ok() && m.target_position) {
    e = check_range("motor.target_position", *m.target_position, -1.0e9f, 1.0e9f);
  }
  if (e.ok()) e = check_range("motor.max_force", m.max_force, 0.0f, 1.0e30f);
  if (e.ok()) e = check_range("motor.frequency", m.frequency, 0.0f, 1.0e6f);
  if (e.ok()) e = check_range("motor.damping_ratio", m.damping_ratio, 0.0f, 1.0e6f);
  return e;
}

Error check_optional(const char* field, const std::optional<float>& value, float low) {
  return value ? check_range(field, *value, low, 1.0e30f) : ok();
}

Error check_distance(const FlatJoint& d) {
  Error e = check_optional("joint.length", d.length, 0.0f);
  if (e.ok()) e = check_optional("joint.min_length", d.min_length, 0.0f);
  if (e.ok()) e = check_optional("joint.max_length", d.max_length, 0.0f);
  if (e.ok()) e = check_optional("joint.stiffness", d.stiffness, 0.0f);
  if (e.ok()) e = check_optional("joint.damping", d.damping, 0.0f);
  if (e.ok() && d.frequency) e = check_range("joint.frequency", *d.frequency, 1.0e-6f, 1.0e6f);
  if (e.ok()) e = check_range("joint.damping_ratio", d.damping_ratio, 0.0f, 1.0e6f);
  if (e) return e;
  if (d.frequency && (d.stiffness || d.damping)) return refuse("joint.frequency is instead of joint.stiffness and joint.damping; give one");
  if (d.min_length && d.max_length && *d.min_length > *d.max_length) {
    return refuse("joint.min_length is %g, above joint.max_length %g", double(*d.min_length), double(*d.max_length));
  }
  return ok();
}

Error first_of(std::initializer_list<Error> errors) {
  for (const Error& e : errors) {
    if (e) return e;
  }
  return ok();
}

Error check_direction(const char* field, Vec3 v) {
  const Error e = check_finite(field, v);
  if (e) return e;
  return largest(absolute(v)) > 0.0f ? ok() : refuse("%s is zero; it must have a direction", field);
}

Error check_limits(const Limits& limits) {
  return first_of({check_range("joint.limits.low", limits.low, -1.0e9f, 1.0e9f),
                   check_range("joint.limits.high", limits.high, limits.low, 1.0e9f)});
}

Error check_axis(const JointAxisDef& d) {
  if (d.motion > AxisMotion::limited) return refuse("joint axis: motion is %d; there is no such", int(d.motion));
  return first_of({d.motion == AxisMotion::limited ? check_limits(d.limits) : ok(),
                   check_range("joint axis: limit_frequency", d.limit_frequency, 0.0f, 1.0e6f),
                   check_range("joint axis: limit_damping_ratio", d.limit_damping_ratio, 0.0f, 1.0e6f), check_motor(d.motor),
                   check_range("joint axis: stiffness", d.stiffness, 0.0f, 1.0e30f),
                   check_range("joint axis: damping", d.damping, 0.0f, 1.0e30f),
                   check_range("joint axis: rest_position", d.rest_position, -1.0e9f, 1.0e9f),
                   check_range("joint axis: friction", d.friction, 0.0f, 1.0e30f)});
}

Error check_drive(const PoseDrive& d) {
  return first_of({check_pose("drive", {DVec3(d.position), d.orientation}),
                   check_finite("drive.linear_velocity", d.linear_velocity),
                   check_finite("drive.angular_velocity", d.angular_velocity),
                   check_range("drive.frequency", d.frequency, 0.0f, 1.0e6f),
                   check_range("drive.damping_ratio", d.damping_ratio, 0.0f, 1.0e6f),
                   check_range("drive.max_force", d.max_force, 0.0f, 1.0e30f),
                   check_range("drive.max_torque", d.max_torque, 0.0f, 1.0e30f)});
}

Error check_path(const FlatJoint& d) {
  const std::size_t min_points = d.path_closed ? 3 : 2;
  if (d.path.size() < min_points || d.path.size() > std::size_t(kMaxPathPoints))
    return refuse("joint.points has %d points; it must have %d to %d", int(d.path.size()), int(min_points),
                  kMaxPathPoints);
  if (d.path_orientation > PathOrientation::following)
    return refuse("joint.orientation is %d; there is no such", int(d.path_orientation));
  for (std::size_t i = 0; i < d.path.size(); ++i) {
    const Vec3 p = d.path[i];
    if (!is_finite(p) || !(largest(absolute(p)) <= 1.0e6f))
      return refuse("joint.points[%d] is (%g, %g, %g); it must be finite and within 1e6 m", int(i),
                    double(p.x), double(p.y), double(p.z));
    const Vec3 next = d.path[(i + 1) % d.path.size()];
    if (p == next && (i + 1 < d.path.size() || d.path_closed))
      return refuse("joint.points[%d] and the point after it are the same", int(i));
  }
  return ok();
}

// Fields that only kinds beyond the first five have.
Error check_kind(const FlatJoint& d) {
  if (d.axis_b) {
    const Error e = check_direction("joint.axis_b", *d.axis_b);
    if (e) return e;
  }
  const Vec3 axis = normalized(d.axis), other = d.axis_b ? normalized(*d.axis_b) : Vec3{};
  const float between = length(cross(axis, other));
  switch (d.kind) {
    case JointKind::universal:
    case JointKind::wheel:
      if (d.axis_b && !(between > 0.17f)) return refuse("joint.axis_b is along joint.axis; they must differ by 10 degrees or more");
      return first_of({check_axis(d.angular_x), check_axis(d.angular_z)});
    case JointKind::rack_and_pinion:
      if (!d.axis_b || !(between > 0.99f))
        return refuse("joint.axis_b, the rack's way, must be given and across joint.axis");
      break;
    case JointKind::cone:
      return first_of({check_optional("joint.swing_y", d.swing_y, 0.0f), check_optional("joint.swing_z", d.swing_z, 0.0f),
                       d.swing_y ? check_range("joint.swing_y", *d.swing_y, 0.0f, 3.1416f) : ok(),
                       d.swing_z ? check_range("joint.swing_z", *d.swing_z, 0.0f, 3.1416f) : ok(), check_drive(d.drive)});
    case JointKind::six_dof:
      return first_of({check_axis(d.linear_x), check_axis(d.linear_y), check_axis(d.linear_z), check_axis(d.angular_x),
                       check_axis(d.angular_y), check_axis(d.angular_z)});
    case JointKind::mouse:
    case JointKind::motor: return check_drive(d.drive);
    case JointKind::pulley: {
      const Error e = first_of({check_pose("joint.ground_a", {d.ground_a, {}}), check_pose("joint.ground_b", {d.ground_b, {}}),
                                check_optional("joint.length", d.length, 0.0f)});
      if (e) return e;
      if (!d.a || !d.b) return refuse("joint.a and joint.b of a pulley must both be bodies");
      return check_range("joint.ratio", d.ratio, 1.0e-6f, 1.0e6f);
    }
    case JointKind::path: return check_path(d);
    default: break;
  }
  if (d.kind == JointKind::gear || d.kind == JointKind::rack_and_pinion) {
    const Error e = check_range("joint.ratio", d.ratio, -1.0e6f, 1.0e6f);
    if (e) return e;
    if (!(absolute(d.ratio) >= 1.0e-6f)) return refuse("joint.ratio is %g; it must not be zero", double(d.ratio));
  }
  return ok();
}

Error check(const WorldState& s, const AddJoint& c) {
  const FlatJoint& d = c.def;
  Error e = ok();
  if (d.a) e = check_body(s, d.a, "add_joint");
  if (e.ok() && d.b) e = check_body(s, d.b, "add_joint");
  if (e) return e;
  if (!d.a && !d.b) return refuse("joint.a and joint.b are both the world; one must be a body");
  if (d.a == d.b) return refuse("joint.a and joint.b are the same body (%u)", d.a.index);
  if (int(d.kind) >= kJointKindCount) return refuse("joint.kind is %d; there is no such kind", int(d.kind));
  e = check_pose("joint.anchor", {d.anchor, {}});
  if (e.ok() && d.anchor_b) e = check_pose("joint.anchor_b", {*d.anchor_b, {}});
  if (e.ok()) e = check_finite("joint.axis", d.axis);
  if (e) return e;
  if (!(largest(absolute(d.axis)) > 0.0f)) return refuse("joint.axis is zero; it must have a direction");
  if (d.limits) e = check_limits(*d.limits);
  if (e.ok()) {
    e = first_of({check_range("joint.friction", d.friction, 0.0f, 1.0e30f),
                  check_range("joint.limit_frequency", d.limit_frequency, 0.0f, 1.0e6f),
                  check_range("joint.limit_damping_ratio", d.limit_damping_ratio, 0.0f, 1.0e6f),
                  check_optional("joint.stiffness", d.stiffness, 0.0f), check_optional("joint.damping", d.damping, 0.0f),
                  check_kind(d)});
  }
  if (e.ok()) e = check_motor(d.motor);
  if (e.ok()) e = check_optional("joint.break_force", d.break_force, 0.0f);
  if (e.ok()) e = check_optional("joint.break_torque", d.break_torque, 0.0f);
  if (e.ok() && d.kind == JointKind::distance) e = check_distance(d);
  if (e.ok() && d.kind != JointKind::distance && d.frequency)
    e = refuse("joint.frequency: only distance joints have it; motors have their own");
  return e;
}
Error check(const WorldState& s, const RemoveJoint& c) { return check_joint_id(s, c.joint, "remove_joint"); }
Error check(const WorldState& s, const SetPose& c) {
  const Error e = check_body(s, c.body, "set_pose");
  return e ? e : check_pose("pose", c.pose);
}
Error check(const WorldState& s, const SetVelocity& c) {
  Error e = check_body(s, c.body, "set_velocity");
  if (e.ok()) e = check_finite("linear velocity", c.linear);
  if (e.ok()) e = check_finite("angular velocity", c.angular);
  return e;
}
Error check(const WorldState& s, const MoveKinematic& c) {
  Error e = check_body(s, c.body, "move_kinematic");
  if (e) return e;
  if (s.rigid.bodies.flags[c.body.index].type != BodyType::kinematic) {
    return refuse("move_kinematic: body %u is not kinematic", c.body.index);
  }
  e = check_pose("pose", c.pose);
  return e ? e : check_range("seconds", c.seconds, 1.0e-9f, 1.0f);
}
Error check(const WorldState& s, const SetType& c) {
  const Error e = check_body(s, c.body, "set_type");
  if (e) return e;
  if (c.type > BodyType::dynamic) return refuse("set_type: there is no body type %d", int(c.type));
  if (c.type != BodyType::dynamic) return ok();
  for (const ShapeId id : s.rigid.bodies.shapes[c.body.index]) {
    const ShapeKind kind = s.rigid.shapes.colliders[id.index].shape.kind;
    if (!is_convex(kind)) {
      return make_error(ErrorCode::invalid_geometry, "set_type: body %u has a %s; dynamic bodies need convex shapes",
                        c.body.index, to_string(kind));
    }
  }
  return ok();
}
Error check(const WorldState&, const SetGravity& c) {
  const Error e = check_finite("gravity", c.gravity);
  return e ? e : check_range("gravity", length(c.gravity), 0.0f, 1.0e9f);
}
Error check(const WorldState& s, const SetGravityScale& c) {
  const Error e = check_body(s, c.body, "set_gravity_scale");
  return e ? e : check_range("gravity scale", c.scale, -1.0e6f, 1.0e6f);
}
Error check(const WorldState& s, const SetDamping& c) {
  Error e = check_body(s, c.body, "set_damping");
  if (e.ok()) e = check_range("linear damping", c.linear, 0.0f, 1.0e6f);
  if (e.ok()) e = check_range("angular damping", c.angular, 0.0f, 1.0e6f);
  return e;
}
Error check(const WorldState& s, const SetMaterial& c) {
  const Error e = check_shape_id(s, c.shape, "set_material");
  return e ? e : check_material("material", c.material);
}
Error check(const WorldState&, const SetMaterialPair& c) {
  if (c.pair.a == 0 || c.pair.b == 0) {
    return refuse("material pair (%d, %d): both ids must be above 0", int(c.pair.a), int(c.pair.b));
  }
  return check_material("material pair",
                        {c.pair.static_friction, c.pair.dynamic_friction, c.pair.restitution, 0.0f, 0.0f, 0});
}
Error check(const WorldState&, const SetSurfaceRule& c) {
  if (c.rule.id == 0) return refuse("surface rule: its id must be above 0");
  Error e = check_material("surface rule: material", c.rule.material);
  if (e.ok()) e = check_finite("surface rule: velocity", c.rule.velocity);
  if (e.ok()) e = check_range("surface rule: velocity", largest(absolute(c.rule.velocity)), 0.0f, 1.0e6f);
  return e.ok() ? check_finite("surface rule: one_way", c.rule.one_way) : e;
}
Error check(const WorldState& s, const SetFilter& c) { return check_shape_id(s, c.shape, "set_filter"); }
Error check(const WorldState& s, const SetMotor& c) {
  const Error e = check_joint_id(s, c.joint, "set_motor");
  return e ? e : check_motor(c.motor);
}
Error check(const WorldState& s, const SetJointAxis& c) {
  const Error e = check_joint_id(s, c.joint, "set_joint_axis");
  if (e) return e;
  const JointKind kind = s.rigid.joints.records[c.joint.index].kind;
  if (int(c.axis) >= kJointAxisCount || ((open_axes(kind) >> int(c.axis)) & 1u) == 0) {
    return refuse("set_joint_axis: a %s joint has no %s to set", to_string(kind),
                  int(c.axis) < kJointAxisCount ? to_string(c.axis) : "such axis");
  }
  return check_axis(c.def);
}
Error check(const WorldState& s, const SetDrive& c) {
  const Error e = check_joint_id(s, c.joint, "set_drive");
  if (e) return e;
  const JointKind kind = s.rigid.joints.records[c.joint.index].kind;
  if (!has_pose_drive(kind)) return refuse("set_drive: a %s joint has no drive; motor, mouse and cone have", to_string(kind));
  return check_drive(c.drive);
}
Error check(const WorldState& s, const SetJointEnabled& c) { return check_joint_id(s, c.joint, "set_joint_enabled"); }
Error check(const WorldState&, const SetSleeping&) { return ok(); }
Error check(const WorldState& s, const SetAwake& c) { return check_body(s, c.body, "set_awake"); }
Error check_motion(IntegratorKind integrator, SpringKind springs, TimeStepping time, float tolerance, int max_impacts) {
  if (int(integrator) >= kIntegratorKindCount) return refuse("integrator: there is no such kind");
  if (int(springs) > int(SpringKind::explicit_force)) return refuse("springs: there is no such kind");
  if (int(time) >= kTimeSteppingCount) return refuse("time stepping: there is no such kind");
  if (!is_finite(tolerance) || tolerance < kMinTolerance || tolerance > 1.0f) {
    return refuse("tolerance is %g; it must lie within %g and 1", double(tolerance), double(kMinTolerance));
  }
  if (max_impacts < 1 || max_impacts > kMaxImpacts) {
    return refuse("max_impacts is %d; it must lie within 1 and %d", max_impacts, kMaxImpacts);
  }
  return ok();
}
Error check(const WorldState&, const SetMotion& c) {
  return check_motion(c.integrator, c.springs, c.time, c.tolerance, c.max_impacts);
}
Error check(const WorldState&, const SetSubsteps& c) {
  if (c.substeps >= 1 && c.substeps <= 64) return ok();
  return refuse("substeps is %d; it must lie within 1 and 64", c.substeps);
}
Error check(const WorldState&, const SetSleepShare& c) {
  return check_range("sleep_share", c.share, 0.0f, 1.0e3f);
}
Error check(const WorldState& s, const SetSleepSpeed& c) {
  const Error e = check_body(s, c.body, "set_sleep_speed");
  return e.ok() ? check_range("sleep_speed", c.speed, 0.0f, 1.0e6f) : e;
}
Error check(const WorldState&, const SetSolver& c) {
  const char* const fault = fault_in(SolverSettings{c.solver, c.options});
  return fault == nullptr ? ok() : refuse("set_solver: %s", fault);
}
Error check(const WorldState&, const SetCombineRules& c) {
  for (const CombineRule rule : {c.friction, c.restitution}) {
    if (rule > CombineRule::product) return refuse("combine rule %d: there is no such rule", int(rule));
  }
  return ok();
}
Error check(const WorldState& s, const AddForce& c) {
  Error e = check_body(s, c.body, "add_force");
  if (e.ok()) e = check_finite("force", c.force);
  if (e.ok()) e = check_finite("torque", c.torque);
  return e;
}
Error check(const WorldState& s, const AddImpulse& c) {
  Error e = check_body(s, c.body, "add_impulse");
  if (e.ok()) e = check_finite("impulse", c.impulse);
  if (e.ok()) e = check_finite("angular impulse", c.angular);
  return e;
}
Error check(const WorldState& s, const SetMass& c) {
  const Error e = check_body(s, c.body, "set_mass");
  return e ? e : check_mass_overrides(c.mass);
}
Error check(const WorldState& s, const SetDensity& c) {
  const Error e = check_shape_id(s, c.shape, "set_density");
  return e ? e : check_range("density", c.density, 0.0f, 1.0e20f);
}
Error check(const WorldState& s, const SetLockedAxes& c) { return check_body(s, c.body, "set_locked_axes"); }
Error check(const WorldState& s, const SetContinuous& c) { return check_body(s, c.body, "set_continuous"); }
Error check(const WorldState& s, const SetCanSleep& c) { return check_body(s, c.body, "set_can_sleep"); }
Error check(const WorldState& s, const SetSensor& c) { return check_shape_id(s, c.shape, "set_sensor"); }
Error check(const WorldState& s, const SetShape& c) {
  const Error e = check_shape_id(s, c.shape, c.geometry ? "set_geometry" : "set_local_transform");
  if (e) return e;
  ShapeDef def;
  if (c.geometry) def.geometry = *c.geometry;
  if (c.local) def.local = *c.local;
  return check_shape_def(def, s.rigid.bodies.flags[s.rigid.shapes.bodies[c.shape.index]].type);
}
Error check(const WorldState& s, const SetBodyUserData& c) { return check_body(s, c.body, "set_user_data"); }
Error check(const WorldState& s, const SetShapeUserData& c) {
  return check_shape_id(s, c.shape, "set_user_data");
}
Error check(const WorldState& s, const SetBreakLoad& c) {
  return first_of({check_joint_id(s, c.joint, "set_break_load"),
                   check_range("break force", c.force, 0.0f, 1.0e30f),
                   check_range("break torque", c.torque, 0.0f, 1.0e30f)});
}
Error check(const WorldState& s, const SetEnabled& c) { return check_body(s, c.body, "set_enabled"); }
Error check(const WorldState& s, const SetPairIgnored& c) {
  const Error e = first_of({check_body(s, c.a, "set_pair_ignored"), check_body(s, c.b, "set_pair_ignored")});
  if (e) return e;
  return c.a == c.b ? refuse("set_pair_ignored: a and b are the same body (%u)", c.a.index) : ok();
}
Error check(const WorldState&, const Step& c) {
  if (is_finite(c.seconds) && c.seconds > 0.0f && c.seconds <= 1.0f) return ok();
  return refuse("step: seconds is %g; it must be above 0 and at most 1", double(c.seconds));
}

}  // namespace

Error check_command(const WorldState& state, const Command& command) {
  if (state.stepping) return make_error(ErrorCode::busy, "the world is in the middle of a step");
  return std::visit([&](const auto& c) { return check(state, c); }, command);
}

Error check_world_def(const WorldDef& def) {
  Error e = check_finite("gravity", def.gravity);
  if (e.ok()) e = check_range("gravity", length(def.gravity), 0.0f, 1.0e9f);
  if (e.ok()) e = check_range("sleep_share", def.sleep_share, 0.0f, 1.0e3f);
  if (e) return e;
  if (def.threads < 0 || def.threads > TaskSystem::kMaxWorkers) {
    return refuse("threads is %d; it must lie within 0 and %d", def.threads, TaskSystem::kMaxWorkers);
  }
  if (def.simd_width != 0 && def.simd_width != 1 && def.simd_width != 4 && def.simd_width != 8 && def.simd_width != 16) {
    return refuse("simd_width is %d; it must be 0, 1, 4, 8 or 16", def.simd_width);
  }
  if (def.stepping.substeps < 1 || def.stepping.substeps > 64) {
    return refuse("stepping.substeps is %d; it must lie within 1 and 64", def.stepping.substeps);
  }
  e = check_motion(def.stepping.integrator, def.stepping.springs, def.stepping.time, def.stepping.tolerance, def.stepping.max_impacts);
  if (e) return e;
  const Stepping& by = def.stepping;
  const char* const fault = fault_in(SolverSettings{by.solver, by.solver_options});
  if (fault != nullptr) return refuse("stepping.%s", fault);
  if (int(def.stepping.broad_phase) >= kBroadPhaseKindCount) return refuse("stepping.broad_phase: there is no such kind");
  if (def.host_tasks.run != nullptr && def.host_tasks.worker_count < 1) {
    return refuse("host_tasks.worker_count is %d; it must be at least 1", def.host_tasks.worker_count);
  }
  return ok();
}

}  // namespace gyre
