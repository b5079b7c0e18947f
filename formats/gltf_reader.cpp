// glTF files to scenes: KHR_physics_rigid_bodies on nodes; without it, every mesh is a static body. See import.h.
#include "formats/gltf_exact.h"
#include "formats/gltf_shapes.h"
#include "formats/model_tree.h"

#include <algorithm>
#include <cmath>

namespace gyre {
namespace {

constexpr const char* kPhysics = "KHR_physics_rigid_bodies";
constexpr std::size_t kMaxGltfMaterials = 256;
constexpr double kUnlimitedForce = 1.0e9;  // N or N m, of a drive without maxForce
constexpr float kSameAngle = 1.0e-4f;      // rad or m: limits that are this close lock an axis

enum class Combine { average, minimum, maximum, multiply };

struct GltfMaterial {
  Combine friction = Combine::average, restitution = Combine::average;
};

class GltfReader {
 public:
  explicit GltfReader(Import& import)
      : import_(import), document_(import), shapes_(import, document_), exact_(import.exact) {}
  void read();

 private:
  void read_materials();
  Combine combine_of(const Json& material, const char* key) const;
  float combined_value(Combine a, Combine b, float x, float y) const;
  void add_pairs();
  void add_bodies();
  int body_at(int node);
  void set_motion(SceneBody& body, const Json& motion);
  void finish_mass(SceneBody& body);
  void add_collider(int node, const Json& collider, bool trigger, const std::string& pointer);
  Filter filter_of(const Json& collider, const std::string& pointer);
  std::uint32_t systems(const Json& filter, const char* key);
  std::optional<SceneColor> color_below(int node) const;
  void add_joints();
  void add_gltf_joint(int node, const Json& joint, const std::string& pointer);
  std::optional<JointDef> rod_of(const Json& joint, int node, int other) const;
  bool take_exact_joint(int node, int other, const Json& joint, const Json& description);
  void take_exact_scene();
  std::vector<JointAxisDef> limits_of(const Json& joint, const std::string& pointer);
  void add_drives(const Json& joint, std::vector<JointAxisDef>& axes, const std::string& pointer);
  void show_meshes();
  const Json& physics_item(const char* section, std::int64_t index, const std::string& pointer) const;

  Import& import_;
  GltfDocument document_;
  GltfShapes shapes_;
  std::vector<GltfMaterial> materials_;
  std::map<std::string, int> system_bits_;
  std::map<int, int> body_of_node_;  // of nodes with motion, and of static colliders
  std::map<int, int>
      motion_of_node_;        // the nearest node that is a body of its own, itself included; -1: none
  std::set<int> has_filter_;  // bodies
  std::set<int> exact_bodies_;
  GltfExact& exact_;
};

const Json& GltfReader::physics_item(const char* section, std::int64_t index,
                                     const std::string& pointer) const {
  const Json* const extension = document_.root_extension(kPhysics);
  const Json* const list = extension == nullptr ? nullptr : json_member(*extension, section);
  if (list == nullptr || !list->is_array() || index < 0 || std::size_t(index) >= list->size())
    document_.fail(pointer, std::string("names an entry of ") + section + " that does not exist");
  return (*list)[std::size_t(index)];
}

Combine GltfReader::combine_of(const Json& material, const char* key) const {
  const std::string word = json_text(material, key, "average");
  if (word == "minimum") return Combine::minimum;
  if (word == "maximum") return Combine::maximum;
  if (word == "multiply") return Combine::multiply;
  if (word != "average")
    document_.fail(std::string("/") + key, "expected average, minimum, maximum or multiply");
  return Combine::average;
}

float GltfReader::combined_value(Combine a, Combine b, float x, float y) const {
  switch (a < b ? a : b) {
    case Combine::average:
      return 0.5f * (x + y);
    case Combine::minimum:
      return min(x, y);
    case Combine::maximum:
      return max(x, y);
    case Combine::multiply:
      return x * y;
  }
  return x;
}

void GltfReader::read_materials() {
  const Json* const extension = document_.root_extension(kPhysics);
  const Json* const list = extension == nullptr ? nullptr : json_member(*extension, "physicsMaterials");
  if (list == nullptr || !list->is_array()) return;
  if (list->size() > kMaxGltfMaterials)
    document_.fail("/extensions/KHR_physics_rigid_bodies/physicsMaterials", "expected at most 256 materials");
  std::set<std::string> names;
  for (std::size_t i = 0; i < list->size(); ++i) {
    const Json& json = (*list)[i];
    SceneMaterial material;
    material.name = Import::unique(names, json_text(json, "name", ""), "physics_material");
    material.surface.static_friction = float(json_number(json, "staticFriction", 0.6));
    material.surface.dynamic_friction = float(json_number(json, "dynamicFriction", 0.6));
    material.surface.restitution = float(json_number(json, "restitution", 0));
    materials_.push_back({combine_of(json, "frictionCombine"), combine_of(json, "restitutionCombine")});
    import_.scene.materials.push_back(std::move(material));
  }
  // Colliders without a material have the values of a material without members.
  SceneMaterial plain;
  plain.name = Import::unique(names, "", "physics_material");
  plain.surface.static_friction = plain.surface.dynamic_friction = 0.6f;
  import_.scene.materials.push_back(std::move(plain));
  materials_.push_back({});
  add_pairs();
}

void GltfReader::add_pairs() {
  for (std::size_t a = 0; a < materials_.size(); ++a) {
    for (std::size_t b = a; b < materials_.size(); ++b) {
      const Material &x = import_.scene.materials[a].surface, &y = import_.scene.materials[b].surface;
      const Combine friction_a = materials_[a].friction, friction_b = materials_[b].friction;
      SceneMaterialPair pair;
      pair.a = int(a);
      pair.b = int(b);
      pair.static_friction = combined_value(friction_a, friction_b, x.static_friction, y.static_friction);
      pair.dynamic_friction = combined_value(friction_a, friction_b, x.dynamic_friction, y.dynamic_friction);
      pair.restitution =
          combined_value(materials_[a].restitution, materials_[b].restitution, x.restitution, y.restitution);
      import_.scene.material_pairs.push_back(pair);
    }
  }
}

std::optional<SceneColor> GltfReader::color_below(int node) const {
  std::vector<int> waiting{node};
  while (!waiting.empty()) {
    const int at = waiting.back();
    waiting.pop_back();
    if (const auto color = document_.mesh_color(at)) return color;
    for (const int child : document_.nodes()[std::size_t(at)].children) {
      const auto motion = motion_of_node_.find(child);
      if (motion == motion_of_node_.end() || motion->second != child) waiting.push_back(child);
    }
  }
  return std::nullopt;
}

void GltfReader::set_motion(SceneBody& body, const Json& motion) {
  const auto vector = [&](const char* key, double most = kLargestGltfNumber) {
    const auto v = json_numbers(motion, key, 3, most);
    return v.empty() ? Vec3{} : Vec3{float(v[0]), float(v[1]), float(v[2])};
  };
  body.def.type = json_flag(motion, "isKinematic", false) ? BodyType::kinematic : BodyType::dynamic;
  body.def.linear_velocity = rotate(body.def.pose.orientation, vector("linearVelocity"));
  body.def.angular_velocity = rotate(body.def.pose.orientation, vector("angularVelocity"));
  body.def.gravity_scale = float(json_number(motion, "gravityFactor", 1));
  if (body.def.type != BodyType::dynamic) return;
  if (json_member(motion, "centerOfMass") != nullptr) body.def.center_of_mass = vector("centerOfMass");
  const double mass = json_number(motion, "mass", -1, kLargestGltfMass);
  if (mass == 0) {
    body.def.type = BodyType::kinematic;  // an infinite mass
    return;
  }
  if (mass > 0) body.def.mass = float(mass);
  const Vec3 moments = vector("inertiaDiagonal", kLargestGltfMass);
  if (moments == Vec3{}) return;
  if (smallest(moments) <= 0.0f || mass < 0)
    return import_.findings.left_out("inertiaDiagonal that is infinite or without a mass");
  const auto q = json_numbers(motion, "inertiaOrientation", 4);
  const Mat3 turn =
      q.empty() ? Mat3{} : to_matrix(normalized(Quat{float(q[0]), float(q[1]), float(q[2]), float(q[3])}));
  body.def.inertia = to_symmetric(turn * diagonal(moments) * transpose(turn));
  if (check_inertia(*body.def.inertia)) {
    import_.findings.left_out("inertia that no body has, replaced by its mean moment");
    const float mean = (moments.x + moments.y + moments.z) / 3.0f;
    body.def.inertia = Sym3{mean, mean, mean, 0, 0, 0};
  }
  if (!body.def.center_of_mass) body.def.center_of_mass = Vec3{};
}

int GltfReader::body_at(int node) {
  const auto found = body_of_node_.find(node);
  if (found != body_of_node_.end()) return found->second;
  SceneBody body;
  const GltfNode& at = document_.nodes()[std::size_t(node)];
  body.name = Import::unique(import_.body_names, at.name, "node");
  body.def.pose = place_of(at).pose;
  body.def.type = BodyType::fixed;
  const int index = int(import_.scene.bodies.size());
  import_.scene.bodies.push_back(std::move(body));
  body_of_node_.emplace(node, index);
  return index;
}

std::uint32_t GltfReader::systems(const Json& filter, const char* key) {
  std::uint32_t bits = 0;
  const Json* const list = json_member(filter, key);
  for (std::size_t i = 0; list != nullptr && list->is_array() && i < list->size(); ++i) {
    if (!(*list)[i].is_string()) continue;
    const auto [at, is_new] =
        system_bits_.try_emplace((*list)[i].get<std::string>(), int(system_bits_.size()) + 1);
    if (at->second > 31) {
      if (is_new) import_.findings.left_out("collision system beyond 31");
      continue;
    }
    bits |= std::uint32_t(1) << at->second;
  }
  return bits;
}

// Bit 0 is of colliders that are in no system.
Filter GltfReader::filter_of(const Json& collider, const std::string& pointer) {
  Filter out;
  const std::int64_t index = json_integer(collider, "collisionFilter", -1);
  if (index < 0) return out;
  const Json& filter = physics_item("collisionFilters", index, pointer);
  out.layer = max(std::uint32_t(1), systems(filter, "collisionSystems"));
  if (json_member(filter, "collideWithSystems") != nullptr)
    out.collides_with = systems(filter, "collideWithSystems");
  if (json_member(filter, "notCollideWithSystems") != nullptr)
    out.collides_with = ~systems(filter, "notCollideWithSystems");
  return out;
}

void GltfReader::add_collider(int node, const Json& collider, bool trigger, const std::string& pointer) {
  if (trigger && json_member(collider, "nodes") != nullptr) return;  // the nodes have triggers of their own
  const int motion = motion_of_node_[node];
  const int index = body_at(motion >= 0 ? motion : node);
  SceneBody& body = import_.scene.bodies[std::size_t(index)];
  const bool moving = body.def.type == BodyType::dynamic;
  if (!body.shapes.empty() && body.sensor != trigger)
    return import_.findings.left_out("trigger or collider on a body that has the other");
  const GltfShapes::Owner owner{motion >= 0 ? motion : node, body.def.pose, moving};
  const Json* const gyre = document_.gyre_extras(node, "shape");
  if (exact_bodies_.count(index) != 0 && gyre != nullptr && json_member(*gyre, "exact") != nullptr &&
      json_member(*gyre, "of") != nullptr && (*gyre)["of"] == collider) {
    if (!(*gyre)["exact"].is_object())
      return;  // one hull of a decomposition, of which the first stands for all
    SceneShape placeholder;
    placeholder.local = shapes_.local_at(node, owner);
    const std::int64_t mesh = json_integer(*gyre, "mesh", -1);
    exact_.add_shape(index, body.shapes.size(),
                     mesh < 0 ? -1 : shapes_.plain_mesh(mesh, document_.nodes()[std::size_t(node)].name),
                     *gyre);
    body.shapes.push_back(std::move(placeholder));
    body.sensor = trigger;
    return;
  }
  std::optional<SceneShape> shape = shapes_.shape_of(collider, node, owner, pointer);
  if (!shape) return;
  if (!materials_.empty()) {
    const std::int64_t material =
        json_integer(collider, "physicsMaterial", std::int64_t(materials_.size()) - 1);
    if (material < 0 || std::size_t(material) >= materials_.size())
      document_.fail(pointer + "/physicsMaterial", "names a material that does not exist");
    shape->material = int(material);
  }
  shape->color = document_.mesh_color(node);
  const Filter filter = filter_of(collider, pointer);
  if (has_filter_.count(index) != 0 && filter != body.filter)
    import_.findings.left_out("filter that differs within a body");
  if (has_filter_.insert(index).second) body.filter = filter;
  body.sensor = trigger;
  body.shapes.push_back(*std::move(shape));
}

void GltfReader::finish_mass(SceneBody& body) {
  if (body.def.type != BodyType::dynamic || body.def.inertia) return;
  const bool is_solid = !body.shapes.empty();
  if (is_solid) return;
  import_.findings.left_out("moving body without a collider, given the inertia of a ball of 0.5 m");
  const float mass = body.def.mass.value_or(1.0f), moment = 0.1f * mass;
  body.def.mass = mass;
  body.def.inertia = Sym3{moment, moment, moment, 0, 0, 0};
  if (!body.def.center_of_mass) body.def.center_of_mass = Vec3{};
}

void GltfReader::add_bodies() {
  for (const int node : document_.order()) {
    const int parent = document_.nodes()[std::size_t(node)].parent;
    const Json* const physics = document_.extension(node, kPhysics);
    const Json* const motion = physics == nullptr ? nullptr : json_member(*physics, "motion");
    const Json* const gyre = document_.gyre_extras(node, "body");
    const bool is_body = motion != nullptr || gyre != nullptr;
    motion_of_node_[node] = is_body ? node : parent >= 0 ? motion_of_node_[parent] : -1;
    if (is_body) (void)body_at(node);
    if (motion != nullptr) set_motion(import_.scene.bodies[std::size_t(body_at(node))], *motion);
    if (gyre == nullptr || json_member(*gyre, "exact") == nullptr) continue;
    const Json* const of = json_member(*gyre, "of");
    if (!(*gyre)["exact"].is_object() || (of == nullptr) != (motion == nullptr) ||
        (of != nullptr && *of != *motion))
      continue;
    exact_bodies_.insert(body_at(node));
    exact_.add_body(body_at(node), (*gyre)["exact"]);
  }
  for (const int node : document_.order()) {
    const Json* const physics = document_.extension(node, kPhysics);
    if (physics == nullptr) continue;
    const std::string pointer = "/nodes/" + std::to_string(node) + "/extensions/KHR_physics_rigid_bodies";
    if (const Json* const collider = json_member(*physics, "collider"))
      add_collider(node, *collider, false, pointer + "/collider");
    if (const Json* const trigger = json_member(*physics, "trigger"))
      add_collider(node, *trigger, true, pointer + "/trigger");
  }
  for (const auto& [node, index] : body_of_node_) {
    SceneBody& body = import_.scene.bodies[std::size_t(index)];
    body.color = color_below(node);
    if (exact_bodies_.count(index) == 0) finish_mass(body);
  }
}

// Six axes, x, y, z linear and angular: free unless a limit says otherwise.
std::vector<JointAxisDef> GltfReader::limits_of(const Json& joint, const std::string& pointer) {
  std::vector<JointAxisDef> axes(6);
  for (JointAxisDef& axis : axes) axis.motion = AxisMotion::free;
  const Json* const limits = json_member(joint, "limits");
  for (std::size_t i = 0; limits != nullptr && limits->is_array() && i < limits->size(); ++i) {
    const Json& limit = (*limits)[i];
    constexpr double kNone = 1.0e9;
    const double low = json_number(limit, "min", -kNone), high = json_number(limit, "max", kNone);
    if (low > high) document_.fail(pointer, "has a limit whose min is above its max");
    if (json_member(limit, "stiffness") != nullptr)
      import_.findings.left_out("stiffness of a limit, taken as hard");
    for (const char* key : {"linearAxes", "angularAxes"}) {
      const Json* const list = json_member(limit, key);
      if (list == nullptr || !list->is_array()) continue;
      if (list->size() > 1 && low != high)
        import_.findings.left_out("limit of several axes at once, taken for each of them");
      for (const Json& axis : *list) {
        if (!axis.is_number_unsigned() || axis.get<std::uint64_t>() > 2)
          document_.fail(pointer, "has a limit of an axis that is not 0, 1 or 2");
        JointAxisDef& out = axes[axis.get<std::size_t>() + (std::string_view(key) == "angularAxes" ? 3 : 0)];
        out.motion = AxisMotion::limited;
        out.limits = {float(low), float(high)};
      }
    }
  }
  return axes;
}

void GltfReader::add_drives(const Json& joint, std::vector<JointAxisDef>& axes, const std::string& pointer) {
  const Json* const drives = json_member(joint, "drives");
  for (std::size_t i = 0; drives != nullptr && drives->is_array() && i < drives->size(); ++i) {
    const Json& drive = (*drives)[i];
    const std::int64_t axis = json_integer(drive, "axis", -1);
    const std::string type = json_text(drive, "type", "linear");
    if (axis < 0 || axis > 2 || (type != "linear" && type != "angular"))
      document_.fail(pointer, "has a drive of no type or axis of glTF");
    JointAxisDef& out = axes[std::size_t(axis) + (type == "angular" ? 3 : 0)];
    const double stiffness = json_number(drive, "stiffness", 0, kLargestGltfMass),
                 damping = json_number(drive, "damping", 0, kLargestGltfMass);
    const double velocity = json_number(drive, "velocityTarget", 0),
                 force = json_number(drive, "maxForce", kUnlimitedForce, kLargestGltfMass);
    if (stiffness < 0 || damping < 0 || force < 0)
      document_.fail(pointer, "has a drive with a number below 0");
    const bool by_force = json_text(drive, "mode", "force") == "force";
    if (stiffness == 0 && by_force && velocity == 0 && force >= kUnlimitedForce) {
      out.damping = float(damping);
    } else if (stiffness == 0) {
      out.motor.target_velocity = float(velocity);
      if (damping > 0) out.motor.max_force = float(force);
    } else if (by_force && force >= kUnlimitedForce) {
      out.stiffness = float(stiffness);
      out.damping = float(damping);
      out.rest_position = float(json_number(drive, "positionTarget", 0));
      if (velocity != 0) import_.findings.left_out("velocityTarget of a drive to a position");
    } else {
      // A spring on the effective mass of the axis: stiffness is the square of its angular frequency.
      out.motor.target_position = float(json_number(drive, "positionTarget", 0));
      out.motor.frequency = by_force ? 0.0f : float(std::sqrt(stiffness) / (2.0 * kPiDouble));
      out.motor.damping_ratio = by_force ? 1.0f : float(damping / (2.0 * std::sqrt(stiffness)));
      out.motor.max_force = float(force);
      if (by_force) import_.findings.left_out("stiffness of a drive with a maxForce, taken as stiff");
    }
  }
}

// A single limit of all three linear axes bounds the distance of the two frames: a rod or a rope.
std::optional<JointDef> GltfReader::rod_of(const Json& joint, int node, int other) const {
  const Json* const limits = json_member(joint, "limits");
  const Json* const drives = json_member(joint, "drives");
  if (limits == nullptr || !limits->is_array() || limits->size() != 1 ||
      (drives != nullptr && drives->is_array() && !drives->empty()))
    return std::nullopt;
  const Json& limit = (*limits)[0];
  const Json* const axes = json_member(limit, "linearAxes");
  if (axes == nullptr || *axes != Json::array({0, 1, 2}) || json_member(limit, "angularAxes") != nullptr)
    return std::nullopt;
  const double low = json_number(limit, "min", 0), high = json_number(limit, "max", kUnlimitedForce);
  if (!(high > 0 && low >= 0 && low <= high)) return std::nullopt;
  DistanceDef def;
  def.anchor = document_.nodes()[std::size_t(node)].translation;
  def.anchor_b = document_.nodes()[std::size_t(other)].translation;
  if (low == high) {
    def.length = float(low);
    return def;
  }
  def.min_length = float(low);
  if (high < kUnlimitedForce) def.max_length = float(high);
  return def;
}

// A joint that Gyre wrote and nobody changed since, if its frames are still where they were.
bool GltfReader::take_exact_joint(int node, int other, const Json& joint, const Json& description) {
  const Json* const gyre = document_.gyre_extras(node, "joint");
  const Json* const of = gyre == nullptr ? nullptr : json_member(*gyre, "of");
  const Json* const exact = gyre == nullptr ? nullptr : json_member(*gyre, "exact");
  if (of == nullptr || exact == nullptr || !exact->is_object() || *of != description) return false;
  if (json_flag(joint, "enableCollision", false) != json_flag(*exact, "collide_connected", false))
    return false;
  const auto anchor = json_numbers(*exact, "anchor", 3);
  if (anchor.size() != 3) return false;
  // The file has places with respect to the body, in floats: those of an anchor far from its body are as coarse as it is far.
  const auto apart = [&](int at, const std::vector<double>& point) {
    const GltfNode& frame = document_.nodes()[std::size_t(at)];
    const DVec3 place = frame.translation;
    const DVec3 above = frame.parent < 0 ? DVec3{} : document_.nodes()[std::size_t(frame.parent)].translation;
    return length(place - DVec3{point[0], point[1], point[2]}) >
           1.0e-5 * (1.0 + length(place) + length(place - above));
  };
  const Json* const anchor_b = json_member(*exact, "anchor_b");
  const bool is_distance = json_text(*exact, "type", "") == "distance";
  if (apart(node, anchor) || (!is_distance && apart(other, anchor))) return false;
  if (anchor_b != nullptr && !anchor_b->is_null() && apart(other, json_numbers(*exact, "anchor_b", 3)))
    return false;
  exact_.add_joint(json_integer(*gyre, "index", 0), *exact);
  return true;
}

void GltfReader::take_exact_scene() {
  const Json* const extras = json_member(document_.json(), "extras");
  const Json* const gyre = extras == nullptr ? nullptr : json_member(*extras, "gyre");
  const Json* const exact = gyre == nullptr ? nullptr : json_member(*gyre, "exact");
  if (exact != nullptr && exact->is_object()) {
    const Json* const extension = document_.root_extension(kPhysics);
    const Json* const materials =
        extension == nullptr ? nullptr : json_member(*extension, "physicsMaterials");
    const Json* const of = json_member(*gyre, "of");
    exact_.set_scene(*exact,
                     (of == nullptr) == (materials == nullptr) && (of == nullptr || *of == *materials));
    if (const Json* const meshes = json_member(*exact, "meshes"); meshes != nullptr && meshes->is_object()) {
      for (const auto& mesh : meshes->items()) import_.mesh_names.insert(mesh.key());
    }
  }
  const Json* const joints = gyre == nullptr ? nullptr : json_member(*gyre, "joints");
  for (std::size_t i = 0; joints != nullptr && joints->is_array() && i < joints->size(); ++i) {
    if (const Json* const joint = json_member((*joints)[i], "exact"))
      exact_.add_joint(json_integer((*joints)[i], "index", 0), *joint);
  }
}

void GltfReader::add_gltf_joint(int node, const Json& joint, const std::string& pointer) {
  const std::int64_t other = json_integer(joint, "connectedNode", -1);
  if (other < 0 || std::size_t(other) >= document_.nodes().size())
    document_.fail(pointer + "/connectedNode", "names a node that does not exist");
  const Json& description =
      physics_item("physicsJoints", json_integer(joint, "joint", -1), pointer + "/joint");
  if (take_exact_joint(node, int(other), joint, description)) return;
  const auto body = [&](int at) {
    const auto motion = motion_of_node_.find(at);
    return motion == motion_of_node_.end() || motion->second < 0 ? -1 : body_of_node_.at(motion->second);
  };
  const int a = body(node), b = body(int(other));
  if (a == b) return import_.findings.left_out("joint within one body");
  if (std::optional<JointDef> rod = rod_of(description, node, int(other))) {
    std::get<DistanceDef>(*rod).collide_connected = json_flag(joint, "enableCollision", false);
    return add_joint(import_, document_.nodes()[std::size_t(node)].name, a, b, *std::move(rod));
  }
  const Pose frame = place_of(document_.nodes()[std::size_t(node)]).pose,
             frame_b = place_of(document_.nodes()[std::size_t(other)]).pose;
  std::vector<JointAxisDef> axes = limits_of(description, pointer);
  add_drives(description, axes, pointer);
  // The engine's zero is the pose at the start, glTF's is where the two frames meet.
  const Transform present = inverse_times(frame, frame_b);
  const EulerAngles angles = to_euler(present.orientation, EulerOrder::xyz);
  const float start[6] = {present.position.x, present.position.y, present.position.z,
                          angles.first,       angles.second,      angles.third};
  std::vector<ModelAxis> moving;
  for (int i = 0; i < 6; ++i) {
    JointAxisDef& axis = axes[std::size_t(i)];
    axis.limits = {axis.limits.low - start[i], axis.limits.high - start[i]};
    axis.rest_position = axis.stiffness > 0.0f ? axis.rest_position - start[i] : 0.0f;
    if (axis.motor.target_position) *axis.motor.target_position -= start[i];
    if (axis.motion == AxisMotion::limited && absolute(axis.limits.low) < kSameAngle &&
        absolute(axis.limits.high) < kSameAngle)
      continue;
    ModelAxis out;
    out.slide = i < 3;
    out.axis = rotate(frame.orientation,
                      {i % 3 == 0 ? 1.0f : 0.0f, i % 3 == 1 ? 1.0f : 0.0f, i % 3 == 2 ? 1.0f : 0.0f});
    out.anchor = frame.position;
    if (axis.motion == AxisMotion::limited) out.limits = axis.limits;
    out.stiffness = axis.stiffness;
    out.damping = axis.damping;
    out.rest = axis.rest_position;
    out.motor = axis.motor;
    moving.push_back(out);
  }
  std::optional<JointDef> def;
  if (moving.empty()) {
    FixedDef fixed;
    fixed.anchor = frame.position;
    def = fixed;
  } else {
    def = joint_of_axes(moving);
  }
  if (!def) return import_.findings.left_out("joint that the engine does not have");
  std::visit([&](auto& d) { d.collide_connected = json_flag(joint, "enableCollision", false); }, *def);
  add_joint(import_, document_.nodes()[std::size_t(node)].name, a, b, *def);
}

void GltfReader::add_joints() {
  for (const int node : document_.order()) {
    const Json* const physics = document_.extension(node, kPhysics);
    const Json* const joint = physics == nullptr ? nullptr : json_member(*physics, "joint");
    if (joint != nullptr)
      add_gltf_joint(node, *joint,
                     "/nodes/" + std::to_string(node) + "/extensions/KHR_physics_rigid_bodies/joint");
  }
}

// A file without physics is shown: each mesh stands where it is.
void GltfReader::show_meshes() {
  for (const int node : document_.order()) {
    const std::int64_t mesh = json_integer(document_.json()["nodes"][std::size_t(node)], "mesh", -1);
    if (mesh < 0) continue;
    SceneBody& body = import_.scene.bodies[std::size_t(body_at(node))];
    SceneShape shape;
    shape.geometry = SceneTriangles{shapes_.mesh_at(mesh, node, {node, body.def.pose, false}, shape.local)};
    shape.color = document_.mesh_color(node);
    body.shapes.push_back(std::move(shape));
  }
}

void GltfReader::read() {
  bool has_physics = document_.root_extension(kPhysics) != nullptr;
  for (const int node : document_.order()) {
    has_physics = has_physics || document_.extension(node, kPhysics) != nullptr;
    for (const char* other : {"OMI_physics_body", "OMI_physics_joint", "OMI_collider", "MSFT_physics"}) {
      if (document_.extension(node, other) != nullptr) import_.findings.left_out(other);
    }
  }
  if (!has_physics) return show_meshes();
  take_exact_scene();
  read_materials();
  add_bodies();
  add_joints();
}

}  // namespace

void read_gltf(Import& import) {
  try {
    GltfReader(import).read();
  } catch (SceneError& error) {
    if (error.file.empty()) error.file = import.file;
    throw error;
  }
}

}  // namespace gyre
