// Scenes to USD text with physics. The format: Pixar, "OpenUSD", and its schema UsdPhysics. See export.h.
//
// Each body is an Xform under /World, each shape a prim in it. USD's capsules, cylinders and cones have an axis attribute, here Y as in scenes.
#include "formats/export.h"
#include "formats/findings.h"
#include "formats/gltf_joint_writer.h"
#include "formats/shape_mesh.h"
#include "scene/number_text.h"
#include "scene/scene_color.h"
#include "scene/scene_runner.h"

#include <set>

namespace gyre {
namespace {

constexpr double kDegrees = 180.0 / kPiDouble;

std::string usd_number(double value) {
  std::string out;
  append_number(out, value);
  return out;
}
std::string usd_number(float value) {
  std::string out;
  append_number(out, value);
  return out;
}
template <class V>
std::string usd_vector(V v) {
  return "(" + usd_number(v.x) + ", " + usd_number(v.y) + ", " + usd_number(v.z) + ")";
}
std::string usd_quaternion(Quat q) {
  return "(" + usd_number(q.w) + ", " + usd_number(q.x) + ", " + usd_number(q.y) + ", " + usd_number(q.z) +
         ")";
}

class UsdWriter {
 public:
  UsdWriter(const Scene& scene, const SceneRunner& runner) : scene_(scene), runner_(runner) {}
  ExportedFile write();

 private:
  void line(const std::string& text) { out_ += std::string(std::size_t(depth_) * 4, ' ') + text + "\n"; }
  void begin(const std::string& type, const std::string& name, const std::string& schemas);
  void end() {
    --depth_;
    line("}");
  }
  std::string prim_name(const std::string& name, const char* otherwise);
  template <class P>
  void place(P position, Quat orientation, const char* type);
  void add_body(std::size_t index);
  void add_shape(std::size_t body, std::size_t index);
  void add_mesh(const ShapeMesh& mesh, bool hull);
  void add_materials();
  void add_joint(std::size_t index);
  void end_of_joint(char end, int body, DVec3 anchor, Quat orientation);

  const Scene& scene_;
  const SceneRunner& runner_;
  std::string out_;
  int depth_ = 0;
  std::set<std::string> names_;
  std::vector<std::string> body_paths_, material_paths_;
  Findings left_out_;
};

void UsdWriter::begin(const std::string& type, const std::string& name, const std::string& schemas) {
  line("def " + type + " \"" + name + "\"" + (schemas.empty() ? "" : " ("));
  if (!schemas.empty()) {
    line("    prepend apiSchemas = [" + schemas + "]");
    line(")");
  }
  line("{");
  ++depth_;
}

// An identifier that no other prim has.
std::string UsdWriter::prim_name(const std::string& name, const char* otherwise) {
  std::string out;
  for (const char c : name.substr(0, 80)) {
    const bool letter = (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || c == '_';
    if (out.empty() && !letter) out += '_';
    out += letter || (c >= '0' && c <= '9') ? c : '_';
  }
  if (out.empty()) out = otherwise;
  std::string unique = out;
  for (int i = 2; !names_.insert(unique).second; ++i) unique = out + "_" + std::to_string(i);
  return unique;
}

template <class P>
void UsdWriter::place(P position, Quat orientation, const char* type) {
  line(std::string(type) + " xformOp:translate = " + usd_vector(position));
  line("quatf xformOp:orient = " + usd_quaternion(orientation));
  line("uniform token[] xformOpOrder = [\"xformOp:translate\", \"xformOp:orient\"]");
}

void UsdWriter::add_mesh(const ShapeMesh& mesh, bool hull) {
  std::string counts, indices, points;
  for (std::size_t i = 0; i < mesh.indices.size(); ++i) {
    if (i % 3 == 0) counts += i == 0 ? "3" : ", 3";
    indices += (i == 0 ? "" : ", ") + std::to_string(mesh.indices[i]);
  }
  for (const MeshVertex& vertex : mesh.vertices)
    points += (points.empty() ? "" : ", ") + usd_vector(vertex.position);
  line("int[] faceVertexCounts = [" + counts + "]");
  line("int[] faceVertexIndices = [" + indices + "]");
  line("point3f[] points = [" + points + "]");
  line("uniform token subdivisionScheme = \"none\"");
  line(std::string("uniform token physics:approximation = ") + (hull ? "\"convexHull\"" : "\"none\""));
}

void UsdWriter::add_shape(std::size_t body, std::size_t index) {
  const SceneBody& of = scene_.bodies[body];
  const SceneShape& shape = of.shapes[index];
  const World& world = runner_.world();
  const AnyShape& geometry = *world.geometry(world.shapes(runner_.bodies()[body])[index]);
  const std::string name = prim_name(of.name + "_shape", "shape");
  std::string schemas = "\"PhysicsCollisionAPI\"";
  if (shape.material >= 0) schemas += ", \"MaterialBindingAPI\"";
  Transform local = shape.local;
  const auto round = [&](const char* type, float radius, float half_height) {
    begin(type, name, schemas);
    line("uniform token axis = \"Y\"");
    line("double radius = " + usd_number(radius));
    line("double height = " + usd_number(2.0f * half_height));
  };
  if (const auto* sphere = std::get_if<Sphere>(&geometry)) {
    begin("Sphere", name, schemas);
    line("double radius = " + usd_number(sphere->radius));
  } else if (const auto* capsule = std::get_if<Capsule>(&geometry)) {
    round("Capsule", capsule->radius, capsule->half_height);
  } else if (const auto* cylinder = std::get_if<Cylinder>(&geometry)) {
    round("Cylinder", cylinder->radius, cylinder->half_height);
  } else if (const auto* cone = std::get_if<Cone>(&geometry)) {
    round("Cone", cone->radius, cone->half_height);
  } else if (const auto* plane = std::get_if<Plane>(&geometry)) {
    const Vec3 up = normalized(plane->normal);
    local.position = local * (plane->offset * up);
    local.orientation = local.orientation * from_directions({0, 1, 0}, up);
    begin("Plane", name, schemas);
    line("uniform token axis = \"Y\"");
  } else if (const auto* box = std::get_if<Box>(&geometry); box != nullptr) {
    if (box->rounding > 0.0f) left_out_.left_out("rounding of a box");
    begin("Cube", name, schemas);
    line("double size = 2");
    line("float3 xformOp:scale = " + usd_vector(box->half_extents));
  } else {
    begin("Mesh", name, schemas + ", \"PhysicsMeshCollisionAPI\"");
    add_mesh(make_shape_mesh(geometry, 24), std::get<Geometry>(geometry).kind() == ShapeKind::hull);
  }
  line("double3 xformOp:translate = " + usd_vector(local.position));
  line("quatf xformOp:orient = " + usd_quaternion(local.orientation));
  const bool is_box = std::holds_alternative<Box>(geometry);
  line(std::string("uniform token[] xformOpOrder = [\"xformOp:translate\", \"xformOp:orient\"") +
       (is_box ? ", \"xformOp:scale\"]" : "]"));
  const SceneColor color = resolved_color(scene_, body, index);
  line("color3f[] primvars:displayColor = [" +
       usd_vector(Vec3{float(color.red) / 255, float(color.green) / 255, float(color.blue) / 255}) + "]");
  if (shape.material >= 0)
    line("rel material:binding:physics = <" + material_paths_[std::size_t(shape.material)] + ">");
  if (shape.material < 0 && (shape.static_friction || shape.dynamic_friction || shape.restitution))
    left_out_.left_out("friction or restitution of a shape");
  end();
}

void UsdWriter::add_body(std::size_t index) {
  const SceneBody& body = scene_.bodies[index];
  const std::string name = prim_name(body.name, "body");
  body_paths_.push_back("/World/" + name);
  const bool moves = body.def.type != BodyType::fixed;
  begin("Xform", name, moves ? "\"PhysicsRigidBodyAPI\", \"PhysicsMassAPI\"" : "");
  place(body.def.pose.position, body.def.pose.orientation, "double3");
  if (body.def.type == BodyType::kinematic) line("bool physics:kinematicEnabled = 1");
  if (moves) {
    // Velocities are in the space that the prim's transform is in; angular ones in degrees.
    line("vector3f physics:velocity = " + usd_vector(body.def.linear_velocity));
    line("vector3f physics:angularVelocity = " + usd_vector(float(kDegrees) * body.def.angular_velocity));
  }
  if (body.def.type == BodyType::dynamic) {
    const MassProperties mass = runner_.world().mass_properties(runner_.bodies()[index]);
    const PrincipalAxes axes = principal_axes(mass.inertia);
    line("float physics:mass = " + usd_number(mass.mass));
    line("point3f physics:centerOfMass = " + usd_vector(mass.center));
    line("float3 physics:diagonalInertia = " + usd_vector(axes.moments));
    line("quatf physics:principalAxes = " + usd_quaternion(axes.orientation));
  }
  if (body.sensor) left_out_.left_out("sensor, written as a collider");
  if (!(body.filter == Filter{})) left_out_.left_out("filter");
  if (!body.forces.empty()) left_out_.left_out("forces of a body");
  for (std::size_t i = 0; i < body.shapes.size(); ++i) add_shape(index, i);
  end();
}

void UsdWriter::add_materials() {
  for (const SceneMaterial& material : scene_.materials) {
    const std::string name = prim_name("material_" + material.name, "material");
    material_paths_.push_back("/World/" + name);
    begin("Material", name, "\"PhysicsMaterialAPI\"");
    line("float physics:staticFriction = " + usd_number(material.surface.static_friction));
    line("float physics:dynamicFriction = " + usd_number(material.surface.dynamic_friction));
    line("float physics:restitution = " + usd_number(material.surface.restitution));
    line("float physics:density = " + usd_number(material.density));
    end();
  }
}

void UsdWriter::end_of_joint(char end, int body, DVec3 anchor, Quat orientation) {
  const std::string number(1, end);
  Pose frame{anchor, orientation};
  if (body >= 0) {
    line("rel physics:body" + number + " = <" + body_paths_[std::size_t(body)] + ">");
    const Transform local = inverse_times(scene_.bodies[std::size_t(body)].def.pose, frame);
    frame = {DVec3(local.position), normalized(local.orientation)};
  }
  line("point3f physics:localPos" + number + " = " + usd_vector(frame.position));
  line("quatf physics:localRot" + number + " = " + usd_quaternion(frame.orientation));
}

void UsdWriter::add_joint(std::size_t index) {
  const SceneJoint& joint = scene_.joints[index];
  const std::string word = to_string(kind_of(joint.def));
  std::string type = "PhysicsJoint", limits;
  const auto range = [&](const std::optional<Limits>& of, double factor) {
    if (!of) return;
    limits = "float physics:lowerLimit = " + usd_number(double(of->low) * factor) + "\n" +
             "float physics:upperLimit = " + usd_number(double(of->high) * factor);
  };
  const bool is_known =
      std::holds_alternative<FixedDef>(joint.def) || std::holds_alternative<BallDef>(joint.def) ||
      std::holds_alternative<HingeDef>(joint.def) || std::holds_alternative<SliderDef>(joint.def) ||
      std::holds_alternative<DistanceDef>(joint.def);
  std::optional<GltfJoint> frames = is_known ? gltf_joint(joint.def) : std::nullopt;
  if (!frames) return left_out_.left_out("joint of type " + word);
  if (!frames->is_complete) left_out_.left_out("friction, spring or break force of a joint of type " + word);
  if (std::holds_alternative<FixedDef>(joint.def)) type = "PhysicsFixedJoint";
  if (std::holds_alternative<BallDef>(joint.def)) type = "PhysicsSphericalJoint";
  const auto motor = [&](const auto& def) {
    if (def.motor.max_force != 0.0f || def.stiffness != 0.0f || def.damping != 0.0f)
      left_out_.left_out("motor or spring of a joint of type " + word);
  };
  if (const auto* hinge = std::get_if<HingeDef>(&joint.def)) {
    type = "PhysicsRevoluteJoint";
    range(hinge->limits, kDegrees);
    motor(*hinge);
  }
  if (const auto* slider = std::get_if<SliderDef>(&joint.def)) {
    type = "PhysicsPrismaticJoint";
    range(slider->limits, 1.0);
    motor(*slider);
  }
  DVec3 anchor_b = frames->anchor_b;
  if (const auto* distance = std::get_if<DistanceDef>(&joint.def)) {
    type = "PhysicsDistanceJoint";
    if (!distance->anchor_b && joint.b >= 0) anchor_b = scene_.bodies[std::size_t(joint.b)].def.pose.position;
    const float present = distance->length.value_or(float(length(anchor_b - distance->anchor)));
    const bool is_rope = distance->min_length || distance->max_length;
    limits =
        "float physics:minDistance = " + usd_number(is_rope ? distance->min_length.value_or(0.0f) : present) +
        "\nfloat physics:maxDistance = " +
        usd_number(is_rope ? distance->max_length.value_or(-1.0f) : present);
  }
  begin(type, prim_name(joint.name.empty() ? word : joint.name, "joint"), "");
  end_of_joint('0', joint.a, frames->anchor_a, frames->orientation);
  end_of_joint('1', joint.b, anchor_b, frames->orientation);
  if (type == "PhysicsRevoluteJoint" || type == "PhysicsPrismaticJoint")
    line("uniform token physics:axis = \"X\"");
  if (!limits.empty()) {
    const std::size_t middle = limits.find('\n');
    line(limits.substr(0, middle));
    line(limits.substr(middle + 1));
  }
  const bool collides = std::visit([](const auto& def) { return def.collide_connected; }, joint.def);
  line(std::string("bool physics:collisionEnabled = ") + (collides ? "1" : "0"));
  end();
}

ExportedFile UsdWriter::write() {
  out_ =
      "#usda 1.0\n(\n    defaultPrim = \"World\"\n    metersPerUnit = 1\n    kilogramsPerUnit = 1\n    "
      "upAxis = \"Y\"\n)\n\n";
  begin("Xform", "World", "");
  begin("PhysicsScene", prim_name("physics", "physics"), "");
  const Vec3 gravity = scene_.world.gravity;
  line("vector3f physics:gravityDirection = " + usd_vector(normalized(gravity, {0, -1, 0})));
  line("float physics:gravityMagnitude = " + usd_number(length(gravity)));
  end();
  add_materials();
  for (std::size_t i = 0; i < scene_.bodies.size(); ++i) add_body(i);
  for (std::size_t i = 0; i < scene_.joints.size(); ++i) add_joint(i);
  end();
  const std::pair<const char*, std::size_t> others[] = {{"pair of materials", scene_.material_pairs.size()},
                                                        {"rope", scene_.ropes.size()},
                                                        {"cloth", scene_.cloths.size()},
                                                        {"soft body", scene_.soft_bodies.size()},
                                                        {"gas", scene_.gases.size()},
                                                        {"liquid", scene_.liquids.size()},
                                                        {"force field", scene_.fields.size()},
                                                        {"explosion", scene_.explosions.size()}};
  for (const auto& [what, count] : others) {
    for (std::size_t i = 0; i < count; ++i) left_out_.left_out(what);
  }
  ExportedFile out;
  out.bytes = std::move(out_);
  if (!left_out_.empty()) out.notes.push_back("left out: " + left_out_.text());
  return out;
}

}  // namespace

SceneResult<ExportedFile> export_usd(const Scene& scene, const std::string& file) {
  SceneResult<SceneRunner> runner = SceneRunner::create(scene, file);
  if (!runner) return runner.error();
  return UsdWriter(scene, *runner).write();
}

}  // namespace gyre
