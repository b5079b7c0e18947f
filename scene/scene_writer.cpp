// Scenes to scene files. See scene_writer.h.
#include "scene/scene_writer.h"

#include "scene/write_parts.h"

namespace gyre {
namespace {

constexpr JsonLayout kOneLine = JsonLayout::one_line;

void write_view(JsonWriter& json, const SceneView& view) {
  json.key("view").begin_object(kOneLine);
  json.field("eye", view.eye);
  json.field("target", view.target);
  json.field("field_of_view", view.field_of_view);
  json.end_object();
}

void write_world(JsonWriter& json, const SceneWorld& world) {
  json.key("world").begin_object();
  json.field("gravity", world.gravity);
  json.field("time_step", world.time_step);
  json.field("substeps", world.substeps);
  if (world.integrator != IntegratorKind::semi_implicit_euler)
    json.field("integrator", to_string(world.integrator));
  if (world.springs != SpringKind::implicit) json.field("springs", to_string(world.springs));
  if (world.stepping != TimeStepping::fixed) {
    json.field("stepping", to_string(world.stepping));
    json.field("tolerance", world.tolerance);
    json.field("max_impacts", world.max_impacts);
  }
  if (world.solver != SolverKind::soft_step) json.field("solver", to_string(world.solver));
  if (world.solver_options.lcp_method != LcpMethod::automatic) json.field("lcp_method", to_string(world.solver_options.lcp_method));
  unless_default(json, "friction_sides", world.solver_options.friction_sides, 0);
  unless_default(json, "iterations", world.solver_options.iterations, 0);
  unless_default(json, "direct_rows", world.solver_options.direct_rows, SolverOptions{}.direct_rows);
  if (world.broad_phase != BroadPhaseKind::bvh) json.field("broad_phase", to_string(world.broad_phase));
  unless_default(json, "sleeping", world.sleeping, true);
  unless_default(json, "sleep_share", world.sleep_share, WorldDef{}.sleep_share);
  json.end_object();
}

void write_material(JsonWriter& json, const SceneMaterial& material) {
  json.key(material.name).begin_object(kOneLine);
  json.field("density", material.density);
  json.field("static_friction", material.surface.static_friction);
  json.field("dynamic_friction", material.surface.dynamic_friction);
  json.field("restitution", material.surface.restitution);
  unless_default(json, "rolling_friction", material.surface.rolling_friction, 0.0f);
  unless_default(json, "spinning_friction", material.surface.spinning_friction, 0.0f);
  write_color(json, material.color);
  unless_default(json, "surface_velocity", material.surface_velocity, Vec3{});
  unless_default(json, "one_way", material.one_way, Vec3{});
  json.end_object();
}

void write_material_pair(JsonWriter& json, const Scene& scene, const SceneMaterialPair& pair) {
  json.begin_object(kOneLine);
  json.key("materials").begin_array(kOneLine);
  json.value(scene.materials[std::size_t(pair.a)].name);
  json.value(scene.materials[std::size_t(pair.b)].name);
  json.end_array();
  if_given(json, "static_friction", pair.static_friction);
  if_given(json, "dynamic_friction", pair.dynamic_friction);
  if_given(json, "restitution", pair.restitution);
  json.end_object();
}

void write_mesh(JsonWriter& json, const SceneMesh& mesh, const WriteOptions& options) {
  json.key(mesh.name);
  if (!mesh.file.empty() && !options.inline_meshes) {
    json.begin_object(kOneLine);
    json.field("file", mesh.file);
    json.end_object();
    return;
  }
  json.begin_object();
  write_points(json, "vertices", mesh.vertices);
  json.key("triangles").begin_array();
  for (std::size_t i = 0; i + 2 < mesh.indices.size(); i += 3) {
    json.begin_array(kOneLine);
    for (std::size_t k = 0; k < 3; ++k) json.value(std::int64_t(mesh.indices[i + k]));
    json.end_array();
  }
  json.end_array();
  json.end_object();
}

struct GeometryWriter {
  JsonWriter& json;
  const Scene& scene;

  void operator()(const Sphere& s) const {
    json.field("type", "sphere");
    json.field("radius", s.radius);
  }
  void operator()(const Box& s) const {
    json.field("type", "box");
    json.field("half_extents", s.half_extents);
    unless_default(json, "rounding", s.rounding, 0.0f);
  }
  void operator()(const Capsule& s) const { round("capsule", s.radius, s.half_height); }
  void operator()(const Cylinder& s) const { round("cylinder", s.radius, s.half_height); }
  void operator()(const Cone& s) const { round("cone", s.radius, s.half_height); }
  void operator()(const Plane& s) const {
    json.field("type", "plane");
    json.field("normal", s.normal);
    json.field("offset", s.offset);
  }
  void operator()(const SceneHull& s) const {
    json.field("type", "convex_hull");
    if (s.mesh >= 0) {
      json.field("mesh", scene.meshes[std::size_t(s.mesh)].name);
      return;
    }
    json.key("points").begin_array(kOneLine);
    for (const Vec3& point : s.points) json.value(point);
    json.end_array();
  }
  void operator()(const SceneTriangles& s) const {
    json.field("type", "mesh");
    json.field("mesh", scene.meshes[std::size_t(s.mesh)].name);
  }
  void operator()(const SceneDecomposition& s) const {
    const SceneDecomposition standard;
    json.field("type", "convex_decomposition");
    json.field("mesh", scene.meshes[std::size_t(s.mesh)].name);
    json.field("max_hulls", s.max_hulls);
    json.field("concavity", s.concavity);
    if (s.max_hull_vertices != standard.max_hull_vertices)
      json.field("max_hull_vertices", s.max_hull_vertices);
    if (s.meaning != standard.meaning) json.field("meaning", to_string(s.meaning));
    if (s.shell_thickness != standard.shell_thickness) json.field("shell_thickness", s.shell_thickness);
  }
  void operator()(const SceneHeightField& s) const {
    json.field("type", "height_field");
    json.key("size").begin_array(kOneLine);
    json.value(std::int64_t(s.columns));
    json.value(std::int64_t(s.rows));
    json.end_array();
    json.field("spacing", s.spacing);
    json.key("heights").begin_array(kOneLine);
    for (const float height : s.heights) json.value(height);  // NaN, a hole, becomes null
    json.end_array();
  }
  void round(const char* type, float radius, float half_height) const {
    json.field("type", type);
    json.field("radius", radius);
    json.field("half_height", half_height);
  }
};

void write_shape(JsonWriter& json, const Scene& scene, const SceneShape& shape) {
  json.begin_object(kOneLine);
  std::visit(GeometryWriter{json, scene}, shape.geometry);
  unless_default(json, "position", shape.local.position, Vec3{});
  unless_default(json, "orientation", shape.local.orientation, Quat{});
  if (shape.material >= 0) json.field("material", scene.materials[std::size_t(shape.material)].name);
  if_given(json, "density", shape.density);
  if_given(json, "static_friction", shape.static_friction);
  if_given(json, "dynamic_friction", shape.dynamic_friction);
  if_given(json, "restitution", shape.restitution);
  if_given(json, "rolling_friction", shape.rolling_friction);
  if_given(json, "spinning_friction", shape.spinning_friction);
  write_color(json, shape.color);
  json.end_object();
}

void write_force(JsonWriter& json, const SceneForce& force) {
  json.begin_object(kOneLine);
  unless_default(json, "force", force.force, Vec3{});
  unless_default(json, "torque", force.torque, Vec3{});
  if_given(json, "at", force.at);
  if (force.in_body_frame) json.field("frame", "body");
  unless_default(json, "start", force.start, 0.0);
  unless_default(json, "end", force.end, 1.0e9);
  json.end_object();
}

void write_axes(JsonWriter& json, const char* key, const bool (&axes)[3]) {
  json.key(key).begin_array(kOneLine);
  for (const bool axis : axes) json.value(axis);
  json.end_array();
}

void write_motion(JsonWriter& json, const BodyDef& def) {
  json.field("position", def.pose.position);
  unless_default(json, "orientation", def.pose.orientation, Quat{});
  unless_default(json, "linear_velocity", def.linear_velocity, Vec3{});
  unless_default(json, "angular_velocity", def.angular_velocity, Vec3{});
  unless_default(json, "linear_damping", def.linear_damping, 0.0f);
  unless_default(json, "angular_damping", def.angular_damping, 0.0f);
  unless_default(json, "gravity_scale", def.gravity_scale, 1.0f);
  unless_default(json, "continuous", def.continuous, false);
  unless_default(json, "can_sleep", def.can_sleep, true);
  unless_default(json, "sleep_speed", def.sleep_speed, 0.0f);
  unless_default(json, "enabled", def.enabled, true);
  if (!(def.locked == LockedAxes{})) {
    json.key("locked").begin_object(kOneLine);
    write_axes(json, "linear", def.locked.linear);
    write_axes(json, "angular", def.locked.angular);
    json.end_object();
  }
  if_given(json, "mass", def.mass);
  if_given(json, "center_of_mass", def.center_of_mass);
  if_given(json, "inertia", def.inertia);
}

void write_body(JsonWriter& json, const Scene& scene, const SceneBody& body) {
  json.begin_object();
  json.field("name", body.name);
  if (body.def.type != BodyType::dynamic) {
    json.field("type", body.def.type == BodyType::fixed ? "static" : "kinematic");
  }
  write_motion(json, body.def);
  if (!(body.filter == Filter{})) {
    json.key("filter").begin_object(kOneLine);
    json.field("layer", std::int64_t(body.filter.layer));
    json.field("collides_with", std::int64_t(body.filter.collides_with));
    json.field("group", std::int64_t(body.filter.group));
    json.end_object();
  }
  unless_default(json, "sensor", body.sensor, false);
  write_color(json, body.color);
  json.key("shapes").begin_array();
  for (const SceneShape& shape : body.shapes) {
    // The first hull of a decomposition stands for all.
    const auto* const hull = std::get_if<SceneDecomposition>(&shape.geometry);
    if (hull == nullptr || hull->part == 0) write_shape(json, scene, shape);
  }
  json.end_array();
  if (!body.forces.empty()) {
    json.key("forces").begin_array();
    for (const SceneForce& force : body.forces) write_force(json, force);
    json.end_array();
  }
  json.end_object();
}

void write_limits(JsonWriter& json, const Limits& limits) {
  json.key("limits").begin_array(kOneLine);
  json.value(limits.low);
  json.value(limits.high);
  json.end_array();
}

void write_motor(JsonWriter& json, const Motor& motor) {
  const Motor none;
  if (motor.target_velocity == none.target_velocity && !motor.target_position &&
      motor.max_force == none.max_force && motor.frequency == none.frequency &&
      motor.damping_ratio == none.damping_ratio) {
    return;
  }
  json.key("motor").begin_object(kOneLine);
  unless_default(json, "target_velocity", motor.target_velocity, none.target_velocity);
  if_given(json, "target_position", motor.target_position);
  json.field("max_force", motor.max_force);
  unless_default(json, "frequency", motor.frequency, none.frequency);
  unless_default(json, "damping_ratio", motor.damping_ratio, none.damping_ratio);
  json.end_object();
}

void write_axis(JsonWriter& json, const char* key, const JointAxisDef& axis, AxisMotion otherwise) {
  json.key(key).begin_object(kOneLine);
  const char* const words[] = {"locked", "free", "limited"};
  if (axis.motion == AxisMotion::limited) {
    write_limits(json, axis.limits);
  } else if (axis.motion != otherwise) {
    json.field("motion", words[int(axis.motion)]);
  }
  unless_default(json, "limit_frequency", axis.limit_frequency, 0.0f);
  unless_default(json, "limit_damping_ratio", axis.limit_damping_ratio, 1.0f);
  write_motor(json, axis.motor);
  unless_default(json, "stiffness", axis.stiffness, 0.0f);
  unless_default(json, "damping", axis.damping, 0.0f);
  unless_default(json, "rest_position", axis.rest_position, 0.0f);
  unless_default(json, "friction", axis.friction, 0.0f);
  json.end_object();
}

template <class Def>
void write_axes(JsonWriter& json, const Def& def) {
  if constexpr (
      requires { def.steering; } || requires { def.angular_z; }) {
    json.key("axes").begin_object();
    if constexpr (requires { def.linear_x; }) {
      write_axis(json, "linear_x", def.linear_x, AxisMotion::locked);
      write_axis(json, "linear_y", def.linear_y, AxisMotion::locked);
      write_axis(json, "linear_z", def.linear_z, AxisMotion::locked);
      write_axis(json, "angular_x", def.angular_x, AxisMotion::locked);
      write_axis(json, "angular_y", def.angular_y, AxisMotion::locked);
    }
    if constexpr (requires { def.steering; }) write_axis(json, "angular_x", def.steering, AxisMotion::locked);
    if constexpr (requires { def.angular_z; })
      write_axis(json, "angular_z", def.angular_z, AxisMotion::locked);
    json.end_object();
  }
}

void write_drive(JsonWriter& json, const PoseDrive& drive) {
  json.key("drive").begin_object(kOneLine);
  unless_default(json, "position", drive.position, Vec3{});
  unless_default(json, "orientation", drive.orientation, Quat{});
  unless_default(json, "linear_velocity", drive.linear_velocity, Vec3{});
  unless_default(json, "angular_velocity", drive.angular_velocity, Vec3{});
  unless_default(json, "frequency", drive.frequency, 0.0f);
  unless_default(json, "damping_ratio", drive.damping_ratio, 1.0f);
  unless_default(json, "max_force", drive.max_force, 0.0f);
  unless_default(json, "max_torque", drive.max_torque, 0.0f);
  json.end_object();
}

void write_path(JsonWriter& json, const PathDef& def) {
  json.key("path").begin_array();
  for (const Vec3& point : def.points) json.value(def.anchor + point);
  json.end_array();
  unless_default(json, "path_closed", def.closed, false);
  const char* const words[] = {"free", "fixed", "following"};
  json.field("path_orientation", words[int(def.orientation)]);
}

template <class Def>
void write_frame(JsonWriter& json, const Def& def) {
  json.field("anchor", def.anchor);
  if constexpr (requires { def.axis; }) json.field("axis", def.axis);
  if constexpr (requires { def.axis_b; }) if_given(json, "axis_b", def.axis_b);
  if constexpr (requires { def.anchor_b; }) if_given(json, "anchor_b", def.anchor_b);
}

// Writes limits, motor and friction of the axis that the limits of a kind bound.
template <class Def>
void write_forces(JsonWriter& json, const Def& def) {
  if constexpr (requires { def.limits; }) {
    if (def.limits) write_limits(json, *def.limits);
    unless_default(json, "limit_frequency", def.limit_frequency, 0.0f);
    unless_default(json, "limit_damping_ratio", def.limit_damping_ratio, 1.0f);
  }
  if constexpr (requires { def.motor; }) write_motor(json, def.motor);
  if constexpr (requires { def.friction; }) unless_default(json, "friction", def.friction, 0.0f);
}

// Writes the fields that only some kinds have.
template <class Def>
void write_special(JsonWriter& json, const Def& def) {
  write_axes(json, def);
  if constexpr (requires { def.swing_y; }) {
    if (def.swing_y && def.swing_z) {
      json.key("swing").begin_array(kOneLine);
      json.value(*def.swing_y);
      json.value(*def.swing_z);
      json.end_array();
    }
  }
  if constexpr (requires { def.ratio; }) unless_default(json, "ratio", def.ratio, 1.0f);
  if constexpr (requires { def.ground_a; }) {
    json.field("ground_a", def.ground_a);
    json.field("ground_b", def.ground_b);
  }
  if constexpr (requires { def.points; }) write_path(json, def);
  if constexpr (requires { def.drive; }) write_drive(json, def.drive);
}

template <class Def>
void write_lengths(JsonWriter& json, const Def& def) {
  if constexpr (requires { def.length; }) if_given(json, "length", def.length);
  if constexpr (requires { def.min_length; }) {
    if_given(json, "min_length", def.min_length);
    if_given(json, "max_length", def.max_length);
    if_given(json, "stiffness", def.stiffness);
    if_given(json, "damping", def.damping);
    if_given(json, "frequency", def.frequency);
    unless_default(json, "damping_ratio", def.damping_ratio, 0.0f);
  } else if constexpr (requires { def.stiffness; }) {
    unless_default(json, "stiffness", def.stiffness, 0.0f);
    unless_default(json, "damping", def.damping, 0.0f);
  }
}

void write_joint(JsonWriter& json, const Scene& scene, const SceneJoint& joint) {
  const auto end = [&](int body) {
    return body < 0 ? std::string("world") : scene.bodies[std::size_t(body)].name;
  };
  json.begin_object();
  json.field("type", to_string(kind_of(joint.def)));
  if (!joint.name.empty()) json.field("name", joint.name);
  json.field("a", end(joint.a));
  json.field("b", end(joint.b));
  const auto write_definition = [&](const auto& def) {
    write_frame(json, def);
    write_forces(json, def);
    write_special(json, def);
    write_lengths(json, def);
    if_given(json, "break_force", def.break_force);
    if_given(json, "break_torque", def.break_torque);
    unless_default(json, "collide_connected", def.collide_connected, false);
  };
  std::visit(write_definition, joint.def);
  json.end_object();
}

void write_bounds(JsonWriter& json, const FieldBounds& bounds) {
  json.key("bounds").begin_array(kOneLine);
  json.value(bounds.low);
  json.value(bounds.high);
  json.end_array();
}

void write_coupling(JsonWriter& json, const Scene& scene, const SceneCoupling& coupling) {
  json.begin_object(kOneLine);
  json.key("terms").begin_array();
  for (const SceneCouplingTerm& term : coupling.terms) {
    json.begin_object(kOneLine);
    json.field("joint", scene.joints[std::size_t(term.joint)].name);
    json.field("axis", to_string(term.axis));
    json.field("coefficient", term.coefficient);
    json.end_object();
  }
  json.end_array();
  if_given(json, "offset", coupling.offset);
  json.end_object();
}

void write_pairs_and_couplings(JsonWriter& json, const Scene& scene) {
  if (!scene.couplings.empty()) {
    json.key("couplings").begin_array();
    for (const SceneCoupling& coupling : scene.couplings) write_coupling(json, scene, coupling);
    json.end_array();
  }
  if (scene.ignored_pairs.empty()) return;
  json.key("ignored_pairs").begin_array();
  for (const auto& [a, b] : scene.ignored_pairs) {
    json.begin_array(kOneLine);
    json.value(scene.bodies[std::size_t(a)].name);
    json.value(scene.bodies[std::size_t(b)].name);
    json.end_array();
  }
  json.end_array();
}

void write_medium(JsonWriter& json, const FieldDef& def) {
  const FieldDef none;
  unless_default(json, "velocity", def.velocity, none.velocity);
  if_given(json, "density", def.density);
  unless_default(json, "drag_coefficient", def.drag_coefficient, none.drag_coefficient);
  unless_default(json, "linear_drag", def.linear_drag, none.linear_drag);
}

// Magnetic fields, Stokes drag, grids.
void write_named_law(JsonWriter& json, const FieldDef& def) {
  const FieldDef none;
  if (def.kind == FieldKind::grid) {
    json.key("points").begin_array(kOneLine);
    for (const int points : def.points) json.value(std::int64_t(points));
    json.end_array();
    json.key("vectors").begin_array(kOneLine);
    for (const Vec3& vector : def.vectors) json.value(vector);
    json.end_array();
    return;
  }
  json.field("strength", def.strength);
  if (def.kind == FieldKind::stokes) return unless_default(json, "velocity", def.velocity, none.velocity);
  json.field("axis", def.axis);
  if (def.kind == FieldKind::magnetic) return;
  json.field("center", def.center);
  json.field("radius", def.radius);
  unless_default(json, "core", def.core, none.core);
}

void write_field(JsonWriter& json, const FieldDef& def) {
  const FieldDef none;
  const bool is_round = def.kind == FieldKind::radial || def.kind == FieldKind::vortex;
  json.begin_object(kOneLine);
  json.field("type", to_string(def.kind));
  if (def.bounds) write_bounds(json, *def.bounds);
  if (def.layers != none.layers) json.field("layers", std::int64_t(def.layers));
  if (def.kind <= FieldKind::buoyancy && def.kind != FieldKind::radial) write_medium(json, def);
  if (def.kind > FieldKind::buoyancy) write_named_law(json, def);
  if (def.kind == FieldKind::wind) {
    unless_default(json, "turbulence", def.turbulence, none.turbulence);
    unless_default(json, "turbulence_length", def.turbulence_length, none.turbulence_length);
  }
  if (is_round) {
    json.field("center", def.center);
    json.field("strength", def.strength);
    json.field("radius", def.radius);
  }
  if (def.kind == FieldKind::radial) {
    json.field("falloff", def.falloff);
    unless_default(json, "core", def.core, none.core);
  }
  if (def.kind == FieldKind::vortex) json.field("axis", def.axis);
  if (def.kind == FieldKind::buoyancy) {
    json.field("normal", def.normal);
    json.field("offset", def.offset);
  }
  json.end_object();
}

void write_explosion(JsonWriter& json, const SceneExplosion& explosion) {
  const ExplosionDef& def = explosion.def;
  json.begin_object(kOneLine);
  json.field("type", "explosion");
  json.field("start", explosion.start);
  json.field("center", def.center);
  json.field("pressure", def.pressure);
  json.field("reference", def.reference);
  json.field("falloff", def.falloff);
  json.field("radius", def.radius);
  unless_default(json, "occlusion", def.occlusion, true);
  if (def.layers != 0xffffffffu) json.field("layers", std::int64_t(def.layers));
  json.end_object();
}

}  // namespace

std::string write_scene(const Scene& scene, const WriteOptions& options) {
  JsonWriter json;
  json.begin_object();
  json.field("gyre_scene", 1);
  if (!scene.name.empty()) json.field("name", scene.name);
  write_world(json, scene.world);
  if (scene.view) write_view(json, *scene.view);
  if (!scene.materials.empty()) {
    json.key("materials").begin_object();
    for (const SceneMaterial& material : scene.materials) write_material(json, material);
    json.end_object();
  }
  if (!scene.material_pairs.empty()) {
    json.key("material_pairs").begin_array();
    for (const SceneMaterialPair& pair : scene.material_pairs) write_material_pair(json, scene, pair);
    json.end_array();
  }
  if (!scene.meshes.empty()) {
    json.key("meshes").begin_object();
    for (const SceneMesh& mesh : scene.meshes) write_mesh(json, mesh, options);
    json.end_object();
  }
  json.key("bodies").begin_array();
  for (const SceneBody& body : scene.bodies) write_body(json, scene, body);
  json.end_array();
  if (!scene.joints.empty()) {
    json.key("joints").begin_array();
    for (const SceneJoint& joint : scene.joints) write_joint(json, scene, joint);
    json.end_array();
  }
  write_pairs_and_couplings(json, scene);
  write_soft_matter(json, scene);
  write_fluids(json, scene);
  if (!scene.fields.empty() || !scene.explosions.empty()) {
    json.key("force_fields").begin_array();
    for (const FieldDef& field : scene.fields) write_field(json, field);
    for (const SceneExplosion& explosion : scene.explosions) write_explosion(json, explosion);
    json.end_array();
  }
  json.end_object();
  return json.take();
}

}  // namespace gyre
