// Scenes to glTF with physics. The formats: Khronos Group, "glTF 2.0 Specification" and the drafts of KHR_physics_rigid_bodies and
// KHR_implicit_shapes. See export.h.
//
// Each body is a node without a parent, each shape beyond the first a child of it. `extras.gyre` of an object has `exact`, the object as in
// a scene file, and `of`, a copy of the part of the file that it belongs to. The reader takes `exact` while the file still equals `of`, so
// that an edit in another program counts.
#include "formats/export.h"
#include "formats/findings.h"
#include "formats/gltf_builder.h"
#include "formats/gltf_joint_writer.h"
#include "scene/scene_color.h"
#include "scene/scene_runner.h"
#include "scene/scene_writer.h"

#include <set>

namespace gyre {
namespace {

constexpr const char* kRigidBodies = "KHR_physics_rigid_bodies";
constexpr const char* kImplicitShapes = "KHR_implicit_shapes";
constexpr int kSegments = 32;  // of a full circle, of meshes to be seen

void remove_members(Json& object, std::initializer_list<const char*> names) {
  for (const char* name : names) object.erase(name);
}

// The scene as JSON, with meshes of no vertices.
Json bare_scene(const Scene& scene) {
  Scene bare = scene;
  for (SceneMesh& mesh : bare.meshes) {
    mesh.file.clear();
    mesh.vertices.clear();
    mesh.indices.clear();
  }
  return Json::parse(write_scene(bare));
}

class GltfWriter {
 public:
  GltfWriter(const Scene& scene, const SceneRunner& runner)
      : scene_(scene), runner_(runner), bare_(bare_scene(scene)) {}
  ExportedFile write(bool binary);

 private:
  void add_materials();
  void add_body(std::size_t index);
  Json motion_of(std::size_t index) const;
  int filter_of(const Filter& filter);
  int material_of(const SceneShape& shape);
  int mesh_of(std::size_t body, std::size_t shape);
  Json hull_primitive(const SceneHull& hull, const Geometry& cooked, SceneColor color);
  void put_shape(Json& node, int number, std::size_t body, std::size_t shape);
  Json geometry_of(std::size_t body, std::size_t shape, int node);
  int implicit_shape(const AnyShape& shape);
  void add_joint_node(std::size_t index);
  int frame_node(int body, DVec3 anchor, Quat orientation, const std::string& name);
  Json scene_extras();
  void add_root(int node) { built_.json()["scenes"][0]["nodes"].push_back(node); }
  const AnyShape& world_shape(std::size_t body, std::size_t shape) const {
    const World& world = runner_.world();
    return *world.geometry(world.shapes(runner_.bodies()[body])[shape]);
  }

  const Scene& scene_;
  const SceneRunner& runner_;
  Json bare_;
  GltfBuilder built_;
  Findings left_out_;
  Json shapes_ = Json::array(), physics_ = Json::object(), other_joints_ = Json::array();
  std::map<std::string, int> shape_numbers_, mesh_numbers_, material_numbers_;
  std::vector<Filter> filters_;
  std::vector<int> body_nodes_;
  std::vector<std::size_t> written_shapes_;  // of the bodies so far, without the parts of decompositions
};

// The materials of the scene in their order. Shapes with coefficients of their own add more.
void GltfWriter::add_materials() {
  for (const SceneMaterial& material : scene_.materials) {
    physics_["physicsMaterials"].push_back(
        {{"name", material.name},
         {"staticFriction", gltf_number(material.surface.static_friction)},
         {"dynamicFriction", gltf_number(material.surface.dynamic_friction)},
         {"restitution", gltf_number(material.surface.restitution)},
         {"frictionCombine", "average"},
         {"restitutionCombine", "maximum"}});
  }
  for (std::size_t i = 0; i < scene_.material_pairs.size(); ++i) left_out_.left_out("pair of materials");
}

int GltfWriter::material_of(const SceneShape& shape) {
  const bool is_own = shape.static_friction || shape.dynamic_friction || shape.restitution;
  if (!is_own) return shape.material;
  Material surface;
  if (shape.material >= 0) surface = scene_.materials[std::size_t(shape.material)].surface;
  Json material{
      {"staticFriction",
       gltf_number(shape.static_friction.value_or(shape.dynamic_friction.value_or(surface.static_friction)))},
      {"dynamicFriction", gltf_number(shape.dynamic_friction.value_or(
                              shape.static_friction.value_or(surface.dynamic_friction)))},
      {"restitution", gltf_number(shape.restitution.value_or(surface.restitution))},
      {"frictionCombine", "average"},
      {"restitutionCombine", "maximum"}};
  const auto [found, is_new] =
      material_numbers_.try_emplace(material.dump(), int(scene_.materials.size() + material_numbers_.size()));
  if (is_new) physics_["physicsMaterials"].push_back(std::move(material));
  return found->second;
}

int GltfWriter::filter_of(const Filter& filter) {
  for (std::size_t i = 0; i < filters_.size(); ++i) {
    if (filters_[i] == filter) return int(i);
  }
  const auto names = [](std::uint32_t bits) {
    Json out = Json::array();
    for (int bit = 0; bit < 32; ++bit) {
      if ((bits >> bit & 1u) != 0) out.push_back("layer " + std::to_string(bit));
    }
    return out;
  };
  if (filter.group != 0) left_out_.left_out("group of a filter");
  Json out{{"collisionSystems", names(filter.layer)}};
  int count = 0;
  for (std::uint32_t bits = filter.collides_with; bits != 0; bits &= bits - 1) ++count;
  if (count > 16) {
    if (count < 32) out["notCollideWithSystems"] = names(~filter.collides_with);
  } else {
    out["collideWithSystems"] = names(filter.collides_with);
  }
  filters_.push_back(filter);
  physics_["collisionFilters"].push_back(std::move(out));
  return int(filters_.size()) - 1;
}

Json GltfWriter::motion_of(std::size_t index) const {
  const SceneBody& body = scene_.bodies[index];
  const Quat turn = body.def.pose.orientation;
  Json out = Json::object();
  if (body.def.type == BodyType::kinematic) {
    out["isKinematic"] = true;
  } else {
    const MassProperties mass = runner_.world().mass_properties(runner_.bodies()[index]);
    const PrincipalAxes axes = principal_axes(mass.inertia);
    out["mass"] = gltf_number(mass.mass);
    out["centerOfMass"] = gltf_numbers(mass.center);
    if (smallest(axes.moments) > 0.0f) {
      const bool is_diagonal = mass.inertia.xy == 0 && mass.inertia.xz == 0 && mass.inertia.yz == 0;
      out["inertiaDiagonal"] =
          gltf_numbers(is_diagonal ? Vec3{mass.inertia.xx, mass.inertia.yy, mass.inertia.zz} : axes.moments);
      if (!is_diagonal) out["inertiaOrientation"] = gltf_numbers(axes.orientation);
    }
  }
  if (!(body.def.linear_velocity == Vec3{}))
    out["linearVelocity"] = gltf_numbers(rotate_inverse(turn, body.def.linear_velocity));
  if (!(body.def.angular_velocity == Vec3{}))
    out["angularVelocity"] = gltf_numbers(rotate_inverse(turn, body.def.angular_velocity));
  if (body.def.gravity_scale != 1.0f) out["gravityFactor"] = gltf_number(body.def.gravity_scale);
  return out;
}

int GltfWriter::implicit_shape(const AnyShape& shape) {
  Json out;
  const auto round = [&](const char* type, float half_height, float top, float bottom) {
    out = {{"type", type},
           {type,
            {{"height", gltf_number(2.0f * half_height)},
             {"radiusTop", gltf_number(top)},
             {"radiusBottom", gltf_number(bottom)}}}};
  };
  if (const auto* sphere = std::get_if<Sphere>(&shape))
    out = {{"type", "sphere"}, {"sphere", {{"radius", gltf_number(sphere->radius)}}}};
  if (const auto* box = std::get_if<Box>(&shape))
    out = {{"type", "box"}, {"box", {{"size", gltf_numbers(2.0f * box->half_extents)}}}};
  if (const auto* capsule = std::get_if<Capsule>(&shape))
    round("capsule", capsule->half_height, capsule->radius, capsule->radius);
  if (const auto* cylinder = std::get_if<Cylinder>(&shape))
    round("cylinder", cylinder->half_height, cylinder->radius, cylinder->radius);
  if (const auto* cone = std::get_if<Cone>(&shape)) round("cylinder", cone->half_height, 0.0f, cone->radius);
  if (std::holds_alternative<Plane>(shape)) out = {{"type", "plane"}, {"plane", Json::object()}};
  const auto [found, is_new] = shape_numbers_.try_emplace(out.dump(), int(shape_numbers_.size()));
  if (is_new) shapes_.push_back(std::move(out));
  return found->second;
}

// All points, from which a reader cooks the same hull, and the faces of the hull.
Json GltfWriter::hull_primitive(const SceneHull& hull, const Geometry& cooked, SceneColor color) {
  const std::vector<Vec3>& points =
      hull.mesh >= 0 ? scene_.meshes[std::size_t(hull.mesh)].vertices : hull.points;
  const HullView view = view_hull(cooked);
  std::vector<std::uint32_t> number(view.vertices.size()), indices;
  for (std::size_t i = 0; i < view.vertices.size(); ++i) {
    float least = -1.0f;
    for (std::size_t k = 0; k < points.size() && least != 0.0f; ++k) {
      const float apart = length_squared(points[k] - view.vertices[i]);
      if (least >= 0.0f && apart >= least) continue;
      least = apart;
      number[i] = std::uint32_t(k);
    }
  }
  for (std::size_t face = 0; face + 1 < view.face_offsets.size(); ++face) {
    const std::uint32_t begin = view.face_offsets[face], end = view.face_offsets[face + 1];
    for (std::uint32_t i = begin + 1; i + 1 < end; ++i) {
      for (const std::uint32_t k : {begin, i, i + 1}) indices.push_back(number[view.face_indices[k]]);
    }
  }
  return built_.triangles(points, indices, color);
}

// The number of the mesh that shows a shape; -1: none.
int GltfWriter::mesh_of(std::size_t body, std::size_t index) {
  const SceneShape& shape = scene_.bodies[body].shapes[index];
  const AnyShape& geometry = world_shape(body, index);
  const SceneColor color = resolved_color(scene_, body, index);
  std::string key = color_text(color);
  const auto* const cooked = std::get_if<Geometry>(&geometry);
  if (cooked == nullptr) {
    key += std::to_string(implicit_shape(geometry));
    if (const auto* box = std::get_if<Box>(&geometry)) key += " " + std::to_string(box->rounding);
  } else {
    key += " " + std::to_string(cooked->content_hash());
  }
  if (const auto found = mesh_numbers_.find(key); found != mesh_numbers_.end()) return found->second;
  Json primitive;
  if (const auto* hull = std::get_if<SceneHull>(&shape.geometry)) {
    primitive = hull_primitive(*hull, *cooked, color);
  } else if (const auto* triangles = std::get_if<SceneTriangles>(&shape.geometry)) {
    const SceneMesh& mesh = scene_.meshes[std::size_t(triangles->mesh)];
    primitive = built_.triangles(mesh.vertices, mesh.indices, color);
  } else {
    const bool is_plane = std::holds_alternative<Plane>(geometry);
    const ShapeMesh mesh = is_plane ? ground_mesh() : make_shape_mesh(geometry, kSegments);
    if (mesh.indices.empty()) return -1;
    primitive = built_.triangles(mesh, color);
  }
  const int out = built_.add_mesh(std::move(primitive));
  mesh_numbers_.emplace(key, out);
  return out;
}

Json GltfWriter::geometry_of(std::size_t body, std::size_t index, int node) {
  const AnyShape& shape = world_shape(body, index);
  const auto* const cooked = std::get_if<Geometry>(&shape);
  if (cooked == nullptr) return {{"shape", implicit_shape(shape)}};
  Json out{{"node", node}};
  if (cooked->kind() == ShapeKind::hull) out["convexHull"] = true;
  return out;
}

// The collider or trigger, its mesh, and the exact shape.
void GltfWriter::put_shape(Json& node, int number, std::size_t body, std::size_t index) {
  const SceneBody& of = scene_.bodies[body];
  const SceneShape& shape = of.shapes[index];
  const int mesh = mesh_of(body, index);
  if (mesh >= 0) node["mesh"] = mesh;
  Json collider{{"geometry", geometry_of(body, index, number)}};
  if (const int material = material_of(shape); material >= 0 && !of.sensor)
    collider["physicsMaterial"] = material;
  if (!(of.filter == Filter{})) collider["collisionFilter"] = filter_of(of.filter);
  const auto* const part = std::get_if<SceneDecomposition>(&shape.geometry);
  Json gyre{{"of", collider}, {"exact", nullptr}};
  if (part == nullptr || part->part == 0) {
    Json exact = bare_["bodies"][body]["shapes"][written_shapes_[body]++];
    remove_members(exact, {"position", "orientation", "points"});
    if (part != nullptr) {
      const SceneMesh& whole = scene_.meshes[std::size_t(part->mesh)];
      const auto [found, is_new] = mesh_numbers_.try_emplace("whole " + whole.name, -1);
      if (is_new)
        found->second = built_.add_mesh(
            built_.triangles(whole.vertices, whole.indices, resolved_color(scene_, body, index)));
      gyre["mesh"] = found->second;
    } else if (mesh >= 0 && !std::holds_alternative<SceneHeightField>(shape.geometry) &&
               std::holds_alternative<Geometry>(world_shape(body, index))) {
      gyre["mesh"] = mesh;
    }
    gyre["exact"] = std::move(exact);
  }
  node["extensions"][kRigidBodies][of.sensor ? "trigger" : "collider"] = std::move(collider);
  node["extras"]["gyre"]["shape"] = std::move(gyre);
}

void put_transform(Json& node, const Json& translation, Quat rotation) {
  node["translation"] = translation;
  if (!(rotation == Quat{})) node["rotation"] = gltf_numbers(rotation);
}

void GltfWriter::add_body(std::size_t index) {
  const SceneBody& body = scene_.bodies[index];
  written_shapes_.push_back(0);
  Json node{{"name", body.name}};
  const DVec3 at = body.def.pose.position;
  put_transform(node, Json::array({at.x, at.y, at.z}), body.def.pose.orientation);
  Json gyre = Json::object();
  if (body.def.type != BodyType::fixed) {
    node["extensions"][kRigidBodies]["motion"] = motion_of(index);
    gyre["of"] = node["extensions"][kRigidBodies]["motion"];
  }
  gyre["exact"] = bare_["bodies"][index];
  remove_members(gyre["exact"], {"name", "position", "orientation", "shapes"});
  node["extras"]["gyre"]["body"] = std::move(gyre);
  const int number = built_.add_node(node);
  body_nodes_.push_back(number);
  add_root(number);
  const auto& locked = body.def.locked;
  if (!(locked == LockedAxes{})) left_out_.left_out("locked axes");
  if (body.def.linear_damping != 0.0f || body.def.angular_damping != 0.0f)
    left_out_.left_out("damping of a body");
  if (!body.forces.empty()) left_out_.left_out("forces of a body");
  for (std::size_t i = 0; i < body.shapes.size(); ++i) {
    const SceneShape& shape = body.shapes[i];
    Transform local = shape.local;
    if (const auto* plane = std::get_if<Plane>(&shape.geometry)) {
      local.position = local * (plane->offset * normalized(plane->normal));
      local.orientation = local.orientation * from_directions({0, 1, 0}, normalized(plane->normal));
    }
    if (body.shapes.size() == 1 && local == Transform{}) {
      Json own = built_.json()["nodes"][std::size_t(number)];
      put_shape(own, number, index, i);
      built_.json()["nodes"][std::size_t(number)] = std::move(own);
      continue;
    }
    const int child = int(built_.json()["nodes"].size());
    built_.add_node(Json::object());
    Json part{{"name", body.name + " shape " + std::to_string(i)}};
    put_transform(part, gltf_numbers(local.position), local.orientation);
    put_shape(part, child, index, i);
    if (!(local == shape.local)) {
      part["extras"]["gyre"]["shape"]["position"] = gltf_numbers(shape.local.position);
      part["extras"]["gyre"]["shape"]["orientation"] = gltf_numbers(shape.local.orientation);
    }
    built_.json()["nodes"][std::size_t(child)] = std::move(part);
    built_.add_child(number, child);
  }
}

int GltfWriter::frame_node(int body, DVec3 anchor, Quat orientation, const std::string& name) {
  Json node{{"name", name}};
  if (body < 0) {
    put_transform(node, Json::array({anchor.x, anchor.y, anchor.z}), orientation);
    const int number = built_.add_node(std::move(node));
    add_root(number);
    return number;
  }
  const Transform local = inverse_times(scene_.bodies[std::size_t(body)].def.pose, Pose{anchor, orientation});
  put_transform(node, gltf_numbers(local.position), normalized(local.orientation));
  const int number = built_.add_node(std::move(node));
  built_.add_child(body_nodes_[std::size_t(body)], number);
  return number;
}

void GltfWriter::add_joint_node(std::size_t index) {
  const SceneJoint& joint = scene_.joints[index];
  JointDef def = joint.def;
  if (auto* const distance = std::get_if<DistanceDef>(&def)) {
    if (!distance->anchor_b && joint.b >= 0)
      distance->anchor_b = scene_.bodies[std::size_t(joint.b)].def.pose.position;
    const bool is_rod = !distance->min_length && !distance->max_length && !distance->stiffness &&
                        !distance->damping && !distance->frequency;
    if (is_rod && !distance->length)
      distance->length = float(length(distance->anchor_b.value_or(distance->anchor) - distance->anchor));
  }
  const std::string word = to_string(kind_of(def));
  std::optional<GltfJoint> made = gltf_joint(def);
  if (!made) {
    left_out_.left_out("joint of type " + word);
    other_joints_.push_back({{"index", index}, {"exact", bare_["joints"][index]}});
    return;
  }
  if (!made->is_complete) left_out_.left_out("friction, spring or break force of a joint of type " + word);
  Json gyre{{"index", index}, {"of", made->description}, {"exact", bare_["joints"][index]}};
  physics_["physicsJoints"].push_back(std::move(made->description));
  const std::string name = joint.name.empty() ? word + " " + std::to_string(index) : joint.name;
  const int other = frame_node(joint.b, made->anchor_b, made->orientation, name + " b");
  const int own = frame_node(joint.a, made->anchor_a, made->orientation, name);
  Json& node = built_.json()["nodes"][std::size_t(own)];
  Json physics{{"connectedNode", other}, {"joint", physics_["physicsJoints"].size() - 1}};
  std::visit(
      [&](const auto& d) {
        if (d.collide_connected) physics["enableCollision"] = true;
      },
      def);
  node["extensions"][kRigidBodies]["joint"] = std::move(physics);
  node["extras"]["gyre"]["joint"] = std::move(gyre);
}

// Members of the scene that are no nodes, with the meshes that they name.
Json GltfWriter::scene_extras() {
  Json out = bare_;
  remove_members(out, {"gyre_scene", "name", "bodies", "joints", "meshes"});
  std::set<int> used;
  for (const SceneCloth& cloth : scene_.cloths) used.insert(cloth.mesh);
  for (const SceneSoftBody& solid : scene_.soft_bodies) used.insert(solid.mesh);
  for (const int index : used) {
    if (index < 0) continue;
    const SceneMesh& mesh = scene_.meshes[std::size_t(index)];
    Json vertices = Json::array(), triangles = Json::array();
    for (const Vec3 v : mesh.vertices) vertices.push_back(gltf_numbers(v));
    for (std::size_t i = 0; i + 2 < mesh.indices.size(); i += 3)
      triangles.push_back(Json::array({mesh.indices[i], mesh.indices[i + 1], mesh.indices[i + 2]}));
    out["meshes"][mesh.name] = {{"vertices", std::move(vertices)}, {"triangles", std::move(triangles)}};
  }
  for (const char* name :
       {"ropes", "cloths", "soft_bodies", "gases", "liquids", "force_fields", "explosions"}) {
    for (std::size_t i = 0; out.contains(name) && i < out[name].size(); ++i) left_out_.left_out(name);
  }
  if (!(scene_.world.gravity == Vec3{0, -9.81f, 0})) left_out_.left_out("gravity");
  return out;
}

ExportedFile GltfWriter::write(bool binary) {
  add_materials();
  for (std::size_t i = 0; i < scene_.bodies.size(); ++i) add_body(i);
  for (std::size_t i = 0; i < scene_.joints.size(); ++i) add_joint_node(i);
  Json& json = built_.json();
  if (!scene_.name.empty()) json["scenes"][0]["name"] = scene_.name;
  json["extensionsUsed"] = Json::array({kRigidBodies});
  if (!shapes_.empty()) {
    json["extensionsUsed"].push_back(kImplicitShapes);
    json["extensions"][kImplicitShapes]["shapes"] = std::move(shapes_);
  }
  json["extras"]["gyre"] = {{"exact", scene_extras()}};
  if (!other_joints_.empty()) json["extras"]["gyre"]["joints"] = std::move(other_joints_);
  if (physics_.contains("physicsMaterials")) json["extras"]["gyre"]["of"] = physics_["physicsMaterials"];
  json["extensions"][kRigidBodies] = std::move(physics_);
  ExportedFile out;
  if (!left_out_.empty())
    out.notes.push_back("only in extras.gyre, which other programs do not read: " + left_out_.text());
  out.bytes = built_.take(binary);
  return out;
}

}  // namespace

SceneResult<ExportedFile> export_gltf(const Scene& scene, const std::string& file, bool binary) {
  SceneResult<SceneRunner> runner = SceneRunner::create(scene, file);
  if (!runner) return runner.error();
  return GltfWriter(scene, *runner).write(binary);
}

}  // namespace gyre
