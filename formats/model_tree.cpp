// Trees of links to bodies and joints. See model_tree.h.
#include "formats/model_tree.h"

#include <cmath>

namespace gyre {
namespace {

constexpr float kDummyMass = 1.0e-3f;     // kg, of links that have neither mass nor shapes
constexpr float kDummyInertia = 1.0e-6f;  // kg m^2

struct BodyParts {
  Pose pose;
  std::vector<MassProperties> masses;
};

void set_mass(Import& import, SceneBody& body, const std::vector<MassProperties>& masses) {
  if (body.def.type != BodyType::dynamic) return;
  MassProperties all;
  if (!masses.empty()) all = combined(masses);
  if (!(all.mass > 0.0f)) {
    bool has_solid = false;
    for (const SceneShape& shape : body.shapes)
      has_solid = has_solid || shape.density.value_or(1000.0f) > 0.0f;
    if (has_solid) return;
    import.findings.left_out("link without mass, given 0.001 kg");
    all = MassProperties{kDummyMass, {}, {kDummyInertia, kDummyInertia, kDummyInertia, 0, 0, 0}};
  }
  if (check_inertia(all.inertia)) {
    import.findings.left_out("inertia that no body has, replaced by its mean moment");
    const float mean = max((all.inertia.xx + all.inertia.yy + all.inertia.zz) / 3.0f, 1.0e-9f);
    all.inertia = {mean, mean, mean, 0, 0, 0};
  }
  body.def.mass = all.mass;
  body.def.center_of_mass = all.center;
  body.def.inertia = all.inertia;
}

JointAxisDef axis_def(const ModelAxis& axis, float sign) {
  JointAxisDef out;
  out.motion = axis.limits ? AxisMotion::limited : AxisMotion::free;
  if (axis.limits) out.limits = sign > 0 ? *axis.limits : Limits{-axis.limits->high, -axis.limits->low};
  out.stiffness = axis.stiffness;
  out.damping = axis.damping;
  out.rest_position = sign * axis.rest;
  out.friction = axis.friction;
  out.motor = axis.motor;
  out.motor.target_velocity *= sign;
  if (out.motor.target_position) *out.motor.target_position *= sign;
  return out;
}

template <class Def>
JointDef simple_joint(const ModelAxis& axis) {
  Def def;
  def.anchor = axis.anchor;
  def.axis = axis.axis;
  def.limits = axis.limits;
  def.stiffness = axis.stiffness;
  def.damping = axis.damping;
  def.friction = axis.friction;
  def.motor = axis.motor;
  return def;
}

bool is_same_place(DVec3 a, DVec3 b) { return length(a - b) < 1.0e-4; }

// Two hinges through one point: the first axis is fixed in the parent, the second in the child.
std::optional<JointDef> universal_of(const ModelAxis& first, const ModelAxis& second) {
  const bool parallel = length(cross(first.axis, second.axis)) < 0.18f;
  if (parallel || first.rest != 0.0f || !is_same_place(first.anchor, second.anchor)) return std::nullopt;
  UniversalDef def;
  def.anchor = first.anchor;
  def.axis = first.axis;
  def.axis_b = second.axis;
  def.limits = first.limits;
  def.stiffness = first.stiffness;
  def.damping = first.damping;
  def.friction = first.friction;
  def.motor = first.motor;
  def.angular_z = axis_def(second, 1.0f);
  return def;
}

std::optional<JointDef> six_dof_of(const std::vector<ModelAxis>& axes) {
  std::vector<const ModelAxis*> hinges, slides;
  for (const ModelAxis& axis : axes) {
    if (axis.slide && !hinges.empty()) return std::nullopt;  // this slide's direction turns with the hinge
    (axis.slide ? slides : hinges).push_back(&axis);
  }
  if (hinges.size() > 3 || slides.size() > 3) return std::nullopt;
  const auto is_plain = [](const ModelAxis* axis) {
    return !axis->limits && axis->stiffness == 0.0f && axis->damping == 0.0f && axis->friction == 0.0f &&
           axis->motor.max_force == 0.0f;
  };
  const bool one_point = hinges.size() == 3 && is_same_place(hinges[0]->anchor, hinges[1]->anchor) &&
                         is_same_place(hinges[0]->anchor, hinges[2]->anchor);
  if (slides.empty() && one_point && is_plain(hinges[0]) && is_plain(hinges[1]) && is_plain(hinges[2])) {
    BallDef ball;
    ball.anchor = hinges[0]->anchor;
    return ball;
  }
  SixDofDef def;
  const Vec3 x = hinges.empty() ? slides[0]->axis : hinges[0]->axis;
  Vec3 y = any_perpendicular(x);
  for (const ModelAxis* axis : slides) {
    if (absolute(dot(axis->axis, x)) < 1.0e-3f) y = axis->axis;
  }
  if (hinges.size() > 1) y = hinges[1]->axis;
  if (absolute(dot(x, y)) > 1.0e-3f) return std::nullopt;
  const Vec3 z = cross(x, y);
  def.axis = x;
  def.axis_b = z;
  def.anchor = hinges.empty() ? slides[0]->anchor : hinges[0]->anchor;
  JointAxisDef* const angular[3] = {&def.angular_x, &def.angular_y, &def.angular_z};
  JointAxisDef* const linear[3] = {&def.linear_x, &def.linear_y, &def.linear_z};
  const Vec3 frame[3] = {x, y, z};
  for (std::size_t i = 0; i < hinges.size(); ++i) {
    const float along = dot(hinges[i]->axis, frame[i]);
    if (absolute(along) < 0.999f || !is_same_place(hinges[i]->anchor, def.anchor)) return std::nullopt;
    *angular[i] = axis_def(*hinges[i], along);
  }
  for (const ModelAxis* slide : slides) {
    int found = -1;
    for (int i = 0; i < 3; ++i) {
      if (absolute(dot(slide->axis, frame[i])) > 0.999f && linear[i]->motion == AxisMotion::locked) found = i;
    }
    if (found < 0) return std::nullopt;
    *linear[found] = axis_def(*slide, dot(slide->axis, frame[found]) > 0 ? 1.0f : -1.0f);
  }
  return def;
}

// A link with a mass and an inertia of zero: the inertia of its shapes at this mass, else that of a ball of water.
MassProperties with_inertia(Import& import, const ModelLink& link) {
  MassProperties out = *link.mass;
  const Sym3 inertia = out.inertia;
  if (!(inertia == Sym3{0, 0, 0, 0, 0, 0})) return out;
  std::vector<MassProperties> parts;
  for (const SceneShape& shape : link.shapes) {
    const Result<MassProperties> part = unit_mass(import.scene, shape.geometry);
    if (part && part->mass > 0.0f) parts.push_back(transformed(*part, shape.local));
  }
  if (!parts.empty()) {
    import.findings.left_out("inertia of zero, taken from the shapes");
    const MassProperties whole = combined(parts);
    out.inertia = (out.mass / whole.mass) * whole.inertia;
    return out;
  }
  import.findings.left_out("inertia of zero, taken as that of a ball of water");
  const float radius = float(std::cbrt(0.75 * double(out.mass) / (1000.0 * kPiDouble)));
  const float moment = 0.4f * out.mass * radius * radius;
  out.inertia = {moment, moment, moment, 0, 0, 0};
  return out;
}

}  // namespace

Result<MassProperties> unit_mass(const Scene& scene, const SceneGeometry& geometry) {
  const auto of_points = [](std::span<const Vec3> points) {
    Result<Geometry> hull = cook_hull(points);
    return hull ? mass_properties(*hull, 1.0f) : Result<MassProperties>(hull.error());
  };
  if (const auto* hull = std::get_if<SceneHull>(&geometry))
    return of_points(hull->mesh >= 0 ? scene.meshes[std::size_t(hull->mesh)].vertices : hull->points);
  if (const auto* triangles = std::get_if<SceneTriangles>(&geometry)) {
    const SceneMesh& mesh = scene.meshes[std::size_t(triangles->mesh)];
    Result<MassProperties> exact = mesh_mass(mesh.vertices, mesh.indices, 1.0f);
    if (exact && exact->mass > 0.0f) return exact;
    return of_points(mesh.vertices);
  }
  if (const auto* sphere = std::get_if<Sphere>(&geometry)) return mass_properties(*sphere, 1.0f);
  if (const auto* box = std::get_if<Box>(&geometry)) return mass_properties(*box, 1.0f);
  if (const auto* capsule = std::get_if<Capsule>(&geometry)) return mass_properties(*capsule, 1.0f);
  if (const auto* cylinder = std::get_if<Cylinder>(&geometry)) return mass_properties(*cylinder, 1.0f);
  return MassProperties{};
}

std::vector<int> build_bodies(Import& import, const std::vector<ModelLink>& links) {
  std::vector<int> body_of(links.size(), -1);
  std::vector<BodyParts> parts(import.scene.bodies.size());
  for (std::size_t i = 0; i < links.size(); ++i) {
    const ModelLink& link = links[i];
    const bool is_lumped = link.welded && link.parent >= 0 && !import.options.keep_fixed;
    if (!is_lumped) {
      SceneBody body;
      body.name = Import::unique(import.body_names, link.name, "link");
      body.def.pose = link.pose;
      body.def.type = link.welded && link.parent < 0 ? BodyType::fixed : BodyType::dynamic;
      body.filter = link.filter;
      body_of[i] = int(import.scene.bodies.size());
      import.scene.bodies.push_back(std::move(body));
      parts.push_back({link.pose, {}});
    } else {
      body_of[i] = body_of[std::size_t(link.parent)];
    }
    SceneBody& body = import.scene.bodies[std::size_t(body_of[i])];
    BodyParts& part = parts[std::size_t(body_of[i])];
    const Transform body_from_link = is_lumped ? inverse_times(part.pose, link.pose) : Transform{};
    for (SceneShape shape : link.shapes) {
      shape.local = body_from_link * shape.local;
      shape.local.orientation = normalized(shape.local.orientation);
      if (body.def.type == BodyType::dynamic) {
        if (const auto* mesh = std::get_if<SceneTriangles>(&shape.geometry))
          shape.geometry = import.solid_mesh(mesh->mesh, true);
        if (std::holds_alternative<Plane>(shape.geometry)) {
          import.findings.left_out("plane on a moving body");
          continue;
        }
      }
      body.shapes.push_back(std::move(shape));
    }
    if (body.shapes.size() == link.shapes.size() && !link.shapes.empty()) body.filter = link.filter;
    if (link.mass && link.mass->mass > 0.0f)
      part.masses.push_back(transformed(with_inertia(import, link), body_from_link));
  }
  for (std::size_t i = 0; i < parts.size(); ++i) set_mass(import, import.scene.bodies[i], parts[i].masses);
  return body_of;
}

std::optional<JointDef> joint_of_axes(const std::vector<ModelAxis>& axes) {
  if (axes.empty()) return std::nullopt;
  if (axes.size() == 1 && axes[0].rest == 0.0f)
    return axes[0].slide ? simple_joint<SliderDef>(axes[0]) : simple_joint<HingeDef>(axes[0]);
  if (axes.size() == 2 && !axes[0].slide && !axes[1].slide) {
    if (const std::optional<JointDef> universal = universal_of(axes[0], axes[1])) return universal;
  }
  return six_dof_of(axes);
}

void add_joint(Import& import, const std::string& name, int a, int b, JointDef def) {
  SceneJoint joint;
  joint.name = Import::unique(import.joint_names, name, "joint");
  joint.a = a;
  joint.b = b;
  joint.def = std::move(def);
  import.scene.joints.push_back(std::move(joint));
}

Pose z_up_world() { return {DVec3{}, from_axis_angle({1, 0, 0}, -0.5f * kPi)}; }

}  // namespace gyre
