// URDF robots to scenes. The format: Open Robotics, "XML Robot Description Format", http://wiki.ros.org/urdf/XML. z is up there; the
// robot's frame is turned so that y is up. See import.h.
#include "formats/xml_collada.h"
#include "formats/model_tree.h"
#include "formats/xml_robots.h"

#include <algorithm>
#include <cmath>

namespace gyre {
namespace {

constexpr std::size_t kMaxUrdfLinks = 100'000;

struct UrdfJoint {
  XmlElement element;
  std::string name, type;
  int parent = -1, child = -1;
  Transform origin{};  // parent_from_child
  Vec3 axis{1, 0, 0};  // in the frame of the child
  int made = -1;       // the hinge or slider of the scene
  JointAxis axis_made = JointAxis::angular_x;
};

struct UrdfLink {
  XmlElement element;
  int joint = -1;             // to its parent
  std::vector<int> joints{};  // to its children
  int place = -1;             // in the tree
};

class UrdfReader {
 public:
  UrdfReader(Import& import, const XmlElement& robot) : import_(import), robot_(robot) {}
  void read();

 private:
  Transform origin_of(const XmlElement& parent) const;
  void read_materials();
  void read_links();
  void read_joints();
  int find_root() const;
  void order_from(int root);
  void place(int link);
  MassProperties inertial_of(const XmlElement& inertial) const;
  std::optional<SceneColor> color_in(const XmlElement& link) const;
  std::optional<SceneShape> shape_of(const XmlElement& collision);
  void add_urdf_joint(UrdfJoint& joint);
  void add_mimics();
  ModelAxis axis_of(const UrdfJoint& joint);
  void count_unknown() const;

  Import& import_;
  const XmlElement& robot_;
  std::map<std::string, SceneColor> materials_;
  std::map<std::string, int> link_names_, joint_names_;
  std::vector<UrdfLink> links_;
  std::vector<UrdfJoint> joints_;
  std::vector<ModelLink> tree_;
  std::vector<int> body_of_;
};

Quat from_roll_pitch_yaw(Vec3 angles) { return from_euler({angles.z, angles.y, angles.x, EulerOrder::zyx}); }

Transform UrdfReader::origin_of(const XmlElement& parent) const {
  const XmlElement origin = parent.child("origin");
  if (!origin) return {};
  return {origin.vec3("xyz", {}), from_roll_pitch_yaw(origin.vec3("rpy", {}))};
}

std::optional<SceneColor> color_in_material(const XmlElement& material) {
  const XmlElement color = material.child("color");
  if (!color) return std::nullopt;
  const std::vector<double> rgba = color.numbers("rgba", 3, 4);
  if (rgba.empty()) return std::nullopt;
  return color_of(rgba[0], rgba[1], rgba[2]);
}

void UrdfReader::read_materials() {
  for (const XmlElement& material : robot_.children("material")) {
    if (const auto color = color_in_material(material)) materials_[material.text("name")] = *color;
  }
}

void UrdfReader::read_links() {
  for (const XmlElement& element : robot_.children("link")) {
    const std::string name = element.need_text("name");
    if (links_.size() >= kMaxUrdfLinks) element.fail("found more than 100000 links");
    if (!link_names_.emplace(name, int(links_.size())).second)
      element.fail("found a second link \"" + name + "\"");
    links_.push_back({element});
  }
  if (links_.empty()) robot_.fail("found no <link>");
}

void UrdfReader::read_joints() {
  for (const XmlElement& element : robot_.children("joint")) {
    UrdfJoint joint{element, element.need_text("name"), element.need_text("type")};
    const auto link_of = [&](const char* end) {
      const XmlElement named = element.need_child(end);
      const auto found = link_names_.find(named.need_text("link"));
      if (found == link_names_.end())
        named.fail("found \"" + named.text("link") + "\", expected the name of a link");
      return found->second;
    };
    joint.parent = link_of("parent");
    joint.child = link_of("child");
    if (joint.parent == joint.child) element.fail("connects a link with itself");
    joint.origin = origin_of(element);
    if (const XmlElement axis = element.child("axis")) joint.axis = axis.vec3("xyz", {1, 0, 0});
    const bool needs_axis = joint.type != "fixed" && joint.type != "floating" && joint.type != "spherical";
    if (needs_axis && !(length(joint.axis) > 0.0f)) element.fail("found an axis of no length");
    joint.axis = normalized(joint.axis);
    if (!joint_names_.emplace(joint.name, int(joints_.size())).second)
      element.fail("found a second joint \"" + joint.name + "\"");
    UrdfLink& child = links_[std::size_t(joint.child)];
    if (child.joint >= 0)
      element.fail("gives the link \"" + child.element.text("name") + "\" a second parent");
    child.joint = int(joints_.size());
    links_[std::size_t(joint.parent)].joints.push_back(int(joints_.size()));
    joints_.push_back(std::move(joint));
  }
}

int UrdfReader::find_root() const {
  int root = -1;
  for (std::size_t i = 0; i < links_.size(); ++i) {
    if (links_[i].joint >= 0) continue;
    if (root >= 0) {
      robot_.fail("found two links without a parent, \"" + links_[std::size_t(root)].element.text("name") +
                  "\" and \"" + links_[i].element.text("name") + "\", expected one tree");
    }
    root = int(i);
  }
  if (root < 0) robot_.fail("every link has a parent: the joints make a ring, expected a tree");
  return root;
}

// Parents before children, without recursion.
void UrdfReader::order_from(int root) {
  std::vector<int> waiting{root};
  std::size_t placed = 0;
  while (!waiting.empty()) {
    const int link = waiting.back();
    waiting.pop_back();
    place(link);
    ++placed;
    const std::vector<int>& joints = links_[std::size_t(link)].joints;
    for (auto j = joints.rbegin(); j != joints.rend(); ++j) waiting.push_back(joints_[std::size_t(*j)].child);
  }
  if (placed != links_.size()) robot_.fail("some joints make a ring, expected a tree");
}

MassProperties UrdfReader::inertial_of(const XmlElement& inertial) const {
  MassProperties out;
  const Transform origin = origin_of(inertial);
  out.mass = float(inertial.need_child("mass").need_number("value"));
  if (!(out.mass >= 0.0f)) inertial.fail("found a mass below 0");
  const XmlElement inertia = inertial.need_child("inertia");
  const auto part = [&](const char* name) { return float(inertia.number(name, 0)); };
  const Sym3 own{part("ixx"), part("iyy"), part("izz"), part("ixy"), part("ixz"), part("iyz")};
  const Mat3 turn = to_matrix(origin.orientation);
  out.center = origin.position;
  out.inertia = to_symmetric(turn * to_matrix(own) * transpose(turn));
  return out;
}

std::optional<SceneColor> UrdfReader::color_in(const XmlElement& link) const {
  for (const XmlElement& visual : link.children("visual")) {
    const XmlElement material = visual.child("material");
    if (!material) continue;
    if (const auto color = color_in_material(material)) return color;
    const auto named = materials_.find(material.text("name"));
    if (named != materials_.end()) return named->second;
  }
  return std::nullopt;
}

std::optional<SceneShape> UrdfReader::shape_of(const XmlElement& collision) {
  const XmlElement geometry = collision.need_child("geometry");
  SceneShape shape;
  shape.local = origin_of(collision);
  const Quat z_from_y = from_axis_angle({1, 0, 0}, 0.5f * kPi);
  const std::vector<XmlElement> kinds = geometry.children();
  if (kinds.empty()) geometry.fail("found nothing in it");
  const XmlElement& kind = kinds[0];
  if (kind.name() == "box") {
    const Vec3 size = kind.vec3("size", {});
    if (!(smallest(size) > 0.0f)) kind.fail("expected a size of three numbers above 0");
    shape.geometry = Box{0.5f * size};
  } else if (kind.name() == "sphere") {
    shape.geometry = Sphere{float(kind.positive("radius"))};
  } else if (kind.name() == "cylinder") {
    shape.geometry = Cylinder{float(kind.positive("radius")), float(0.5 * kind.positive("length"))};
    shape.local.orientation = shape.local.orientation * z_from_y;
  } else if (kind.name() == "capsule") {
    shape.geometry = Capsule{float(kind.positive("radius")), float(0.5 * kind.positive("length"))};
    shape.local.orientation = shape.local.orientation * z_from_y;
  } else if (kind.name() == "mesh") {
    const std::string file = kind.need_text("filename");
    if (mesh_format_of(file) == MeshFormat::none && !is_collada(file)) {
      import_.findings.left_out("collision mesh that is not .stl, .obj, .ply or .dae");
      return std::nullopt;
    }
    const Vec3 scale = kind.vec3("scale", {1, 1, 1});
    if (scale.x * scale.y * scale.z == 0.0f) kind.fail("found a scale of 0");
    shape.geometry = SceneTriangles{import_.mesh_index(file, import_.folder, scale, kind.line())};
  } else {
    import_.findings.left_out("collision <" + kind.name() + ">");
    return std::nullopt;
  }
  return shape;
}

void UrdfReader::place(int index) {
  UrdfLink& link = links_[std::size_t(index)];
  ModelLink out;
  out.name = link.element.text("name");
  link.place = int(tree_.size());
  if (link.joint >= 0) {
    const UrdfJoint& joint = joints_[std::size_t(link.joint)];
    out.parent = links_[std::size_t(joint.parent)].place;
    out.pose = tree_[std::size_t(out.parent)].pose * joint.origin;
    out.welded = joint.type == "fixed";
  } else {
    out.pose = z_up_world();
    const bool is_world = out.name == "world" && !link.element.child("inertial");
    out.welded = !import_.options.free_base || is_world;
  }
  out.pose.orientation = normalized(out.pose.orientation);
  if (const XmlElement inertial = link.element.child("inertial")) out.mass = inertial_of(inertial);
  const std::optional<SceneColor> color = color_in(link.element);
  for (const XmlElement& collision : link.element.children("collision")) {
    std::optional<SceneShape> shape = shape_of(collision);
    if (!shape) continue;
    shape->color = color;
    out.shapes.push_back(*std::move(shape));
  }
  if (!import_.options.self_collision) out.filter.group = -1;
  tree_.push_back(std::move(out));
}

ModelAxis UrdfReader::axis_of(const UrdfJoint& joint) {
  const Pose& pose = tree_[std::size_t(links_[std::size_t(joint.child)].place)].pose;
  ModelAxis axis;
  axis.name = joint.name;
  axis.anchor = pose.position;
  axis.axis = rotate(pose.orientation, joint.axis);
  axis.slide = joint.type == "prismatic";
  const XmlElement limit = joint.element.child("limit");
  if (joint.type != "continuous") {
    if (!limit) joint.element.fail("found no <limit>, which a joint of this type needs");
    axis.limits = Limits{float(limit.number("lower", 0)), float(limit.number("upper", 0))};
    if (axis.limits->low > axis.limits->high) limit.fail("found a lower limit above the upper one");
  }
  if (const XmlElement dynamics = joint.element.child("dynamics")) {
    axis.damping = float(max(0.0, dynamics.number("damping", 0)));
    axis.friction = float(max(0.0, dynamics.number("friction", 0)));
  }
  return axis;
}

JointDef planar_joint(DVec3 anchor, Vec3 normal) {
  SixDofDef def;
  def.anchor = anchor;
  def.axis = normal;
  def.linear_y.motion = def.linear_z.motion = def.angular_x.motion = AxisMotion::free;
  return def;
}

void UrdfReader::add_urdf_joint(UrdfJoint& joint) {
  const int a = body_of_[std::size_t(links_[std::size_t(joint.parent)].place)];
  const int b = body_of_[std::size_t(links_[std::size_t(joint.child)].place)];
  if (joint.type == "floating") return;
  if (joint.type == "fixed") {
    if (a == b) return;
    FixedDef def;
    def.anchor = import_.scene.bodies[std::size_t(b)].def.pose.position;
    return add_joint(import_, joint.name, a, b, def);
  }
  if (joint.type == "spherical") {  // of PyBullet, not of the format
    BallDef def;
    def.anchor = tree_[std::size_t(links_[std::size_t(joint.child)].place)].pose.position;
    return add_joint(import_, joint.name, a, b, def);
  }
  if (joint.type == "planar") {
    const Pose& pose = tree_[std::size_t(links_[std::size_t(joint.child)].place)].pose;
    return add_joint(import_, joint.name, a, b,
                     planar_joint(pose.position, rotate(pose.orientation, joint.axis)));
  }
  if (joint.type != "revolute" && joint.type != "continuous" && joint.type != "prismatic")
    joint.element.fail("found the type \"" + joint.type +
                       "\", expected revolute, continuous, prismatic, fixed, floating or planar");
  joint.made = int(import_.scene.joints.size());
  joint.axis_made = joint.type == "prismatic" ? JointAxis::linear_x : JointAxis::angular_x;
  add_joint(import_, joint.name, a, b, *joint_of_axes({axis_of(joint)}));
}

// The joints of the scene have the names of those of the file, made unique; both are counted from the same places.
void UrdfReader::add_mimics() {
  for (const UrdfJoint& joint : joints_) {
    const XmlElement mimic = joint.element.child("mimic");
    if (!mimic) continue;
    const auto found = joint_names_.find(mimic.need_text("joint"));
    if (found == joint_names_.end())
      mimic.fail("found \"" + mimic.text("joint") + "\", expected the name of a joint");
    const UrdfJoint& leader = joints_[std::size_t(found->second)];
    const double ratio = mimic.number("multiplier", 1);
    if (&leader == &joint || ratio == 0 || leader.made < 0 || joint.made < 0) {
      import_.findings.left_out("<mimic>");
      continue;
    }
    SceneCoupling coupling;
    coupling.terms = {{joint.made, joint.axis_made, 1.0f}, {leader.made, leader.axis_made, float(-ratio)}};
    coupling.offset = float(mimic.number("offset", 0));
    import_.scene.couplings.push_back(std::move(coupling));
  }
}

void UrdfReader::count_unknown() const {
  for (const XmlElement& element : robot_.children()) {
    const std::string name = element.name();
    if (name != "link" && name != "joint" && name != "material") import_.findings.left_out("<" + name + ">");
  }
  for (const UrdfLink& link : links_) {
    for (const XmlElement& part : link.element.children()) {
      const std::string name = part.name();
      if (name == "visual") {
        const XmlElement geometry = part.child("geometry");
        const bool is_drawn = bool(link.element.child("collision"));
        if (geometry && !is_drawn) import_.findings.left_out("<visual> of a link without <collision>");
      } else if (name != "inertial" && name != "collision") {
        import_.findings.left_out("<" + name + ">");
      }
    }
  }
  for (const UrdfJoint& joint : joints_) {
    for (const XmlElement& part : joint.element.children()) {
      const std::string name = part.name();
      constexpr const char* kKnown[] = {"origin", "parent",      "child",
                                        "axis",   "limit",       "dynamics",
                                        "mimic",  "calibration", "safety_controller"};
      if (std::none_of(std::begin(kKnown), std::end(kKnown),
                       [&](const char* known) { return name == known; }))
        import_.findings.left_out("<" + name + ">");
      if (name == "calibration" || name == "safety_controller") import_.findings.left_out("<" + name + ">");
    }
  }
}

void UrdfReader::read() {
  if (const std::string name = robot_.text("name"); !name.empty()) import_.scene.name = name;
  read_materials();
  read_links();
  read_joints();
  order_from(find_root());
  body_of_ = build_bodies(import_, tree_);
  for (UrdfJoint& joint : joints_) add_urdf_joint(joint);
  add_mimics();
  count_unknown();
}

}  // namespace

void read_urdf(Import& import, const XmlElement& robot) { UrdfReader(import, robot).read(); }

}  // namespace gyre
