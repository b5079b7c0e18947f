// MJCF models to scenes. The format: DeepMind, MuJoCo documentation, "XML Reference". z is up there; the world is turned so that y is up.
// Controls are zero: a motor exerts nothing, a position actuator is a spring to zero, a velocity actuator is a damper. See import.h.
#include "formats/mjcf_document.h"
#include "formats/mjcf_geom.h"
#include "formats/model_tree.h"
#include "formats/xml_robots.h"

#include <tinyxml2.h>

#include <algorithm>
#include <cmath>

namespace gyre {
namespace {

constexpr std::size_t kMaxMjcfBodies = 100'000;

// The effect of a joint's actuators at zero control.
struct Drive {
  double stiffness = 0, damping = 0, target = 0;  // the target in the coordinate of the joint
};

struct MjcfJoint {
  XmlElement element;
  std::string name;
  bool ball = false;
  ModelAxis axis;
};

class MjcfReader {
 public:
  MjcfReader(Import& import, const XmlElement& root) : import_(import), root_(root) {}
  void read();

 private:
  void read_compiler();
  void read_option();
  void read_assets();
  void read_actuators();
  void read_body(const XmlElement& body, int parent, int depth);
  void read_geoms(const XmlElement& body, ModelLink& link, bool has_inertial);
  MassProperties inertial_of(const XmlElement& inertial) const;
  MjcfJoint joint_of(const XmlElement& element, const Pose& pose);
  void make_joints();
  JointDef ball_of(const MjcfJoint& joint) const;
  void connect(int parent, int child, const std::vector<MjcfJoint>& joints);
  void read_equalities();
  void couple_joints(const XmlElement& equality);
  void couple_tendons(const XmlElement& equality);
  void read_tendons();
  void read_excludes();
  void set_filters();
  int body_named(const XmlElement& element, const char* attribute, bool required) const;
  void count_unknown() const;

  struct JointPlace {
    int parent = -1, child = -1;
    ModelAxis axis;
    bool alone = false;  // the only joint of its body
    int made = -1;       // the hinge or slider of the scene, if it is alone
  };
  static SceneCouplingTerm term_of(const JointPlace& place, double coefficient) {
    return {place.made, place.axis.slide ? JointAxis::linear_x : JointAxis::angular_x, float(coefficient)};
  }
  static std::vector<double> polynomial_of(const XmlElement& equality) {
    std::vector<double> poly = equality.numbers("polycoef", 1, 5);
    if (poly.empty()) poly = {0, 1};
    poly.resize(5);
    return poly;
  }
  static bool is_linear(const std::vector<double>& poly) { return poly[2] == 0 && poly[3] == 0 && poly[4] == 0; }
  // A length of a fixed tendon: the sum of joint coordinates, each times a coefficient.
  using TendonTerms = std::map<std::string, double>;
  void add_terms(const XmlElement& equality, const char* attribute, double factor, TendonTerms& terms) const;

  Import& import_;
  const XmlElement& root_;
  MjcfCompiler compiler_;
  MjcfAssets assets_;
  std::map<std::string, Drive> drives_;
  std::vector<ModelLink> tree_;
  std::vector<std::vector<MjcfJoint>> joints_;                         // of each link
  std::vector<std::pair<std::uint32_t, std::uint32_t>> contact_bits_;  // of each link
  std::map<std::string, int> link_names_;
  std::map<std::string, JointPlace> joint_places_;
  std::map<std::string, TendonTerms> tendons_;
  std::vector<int> body_of_;
};

void MjcfReader::read_compiler() {
  for (const XmlElement& compiler : root_.children("compiler")) {
    const std::string angle = compiler.text("angle", compiler_.degrees ? "degree" : "radian");
    if (angle != "degree" && angle != "radian")
      compiler.fail("found angle \"" + angle + "\", expected degree or radian");
    compiler_.degrees = angle == "degree";
    compiler_.auto_limits = compiler.flag("autolimits", compiler_.auto_limits);
    compiler_.euler = compiler.text("eulerseq", compiler_.euler);
    if (compiler_.euler.size() != 3 || compiler_.euler.find_first_not_of("xyzXYZ") != std::string::npos)
      compiler.fail("found eulerseq \"" + compiler_.euler + "\", expected three of xyzXYZ");
    compiler_.mesh_folder = compiler.text("meshdir", compiler.text("assetdir", compiler_.mesh_folder));
    compiler_.inertia_from_geom = compiler.text("inertiafromgeom", compiler_.inertia_from_geom);
    if (compiler.text("coordinate", "local") != "local")
      compiler.fail("found global coordinates, which MuJoCo has given up, too; expected local");
    for (const char* other : {"settotalmass", "balanceinertia"}) {
      if (compiler.has(other) && compiler.text(other) != "false")
        import_.findings.left_out(std::string("compiler ") + other);
    }
  }
}

void MjcfReader::read_option() {
  Vec3 gravity{0, 0, -9.81f};
  for (const XmlElement& option : root_.children("option")) {
    gravity = option.vec3("gravity", gravity);
    const double step = option.number("timestep", 0.002);
    if (!(step > 0 && step <= 1)) option.fail("found a timestep that is not above 0 and at most 1");
    import_.scene.world.time_step = step;
    for (const char* other : {"density", "viscosity", "wind", "magnetic"}) {
      if (option.has(other)) import_.findings.left_out(std::string("option ") + other);
    }
  }
  if (root_.children("option").empty()) import_.scene.world.time_step = 0.002;
  import_.scene.world.gravity = {gravity.x, gravity.z, -gravity.y};
}

void MjcfReader::read_assets() {
  for (const XmlElement& section : root_.children("asset")) {
    for (const XmlElement& asset : section.children()) {
      if (asset.name() == "mesh") {
        std::string name = asset.text("name");
        if (name.empty()) {
          name = asset.need_text("file");
          name = name.substr(name.find_last_of('/') + 1);
          name = name.substr(0, name.find_last_of('.'));
        }
        assets_.meshes[name] = asset;
      } else if (asset.name() == "material") {
        if (const auto rgba = asset.numbers("rgba", 3, 4); !rgba.empty())
          assets_.colors[asset.text("name")] = color_of(rgba[0], rgba[1], rgba[2]);
      } else if (asset.name() != "texture" && asset.name() != "default") {
        import_.findings.left_out("asset <" + asset.name() + ">");
      }
    }
  }
}

void MjcfReader::read_actuators() {
  for (const XmlElement& section : root_.children("actuator")) {
    for (const XmlElement& actuator : section.children()) {
      const std::string kind = actuator.name();
      const bool is_known = kind == "motor" || kind == "position" || kind == "velocity" || kind == "general";
      if (!is_known || !actuator.has("joint")) {
        import_.findings.left_out("actuator <" + kind + ">" +
                                  (is_known ? " of a transmission that is no joint" : ""));
        continue;
      }
      const std::vector<double> gears = actuator.numbers("gear", 1, 6);
      const double gear = gears.empty() ? 1.0 : gears[0];
      Drive drive;
      if (kind == "position") {
        drive.stiffness = actuator.number("kp", 1);
        drive.damping = actuator.number("kv", 0);
      } else if (kind == "velocity") {
        drive.damping = actuator.number("kv", 1);
      } else if (kind == "general" && actuator.text("biastype", "none") == "affine") {
        std::vector<double> bias = actuator.numbers("biasprm", 1, 10);
        bias.resize(3);
        drive.stiffness = -bias[1];
        drive.damping = -bias[2];
        if (bias[1] != 0) drive.target = -bias[0] / bias[1];
      } else if (kind == "general" && actuator.text("biastype", "none") != "none") {
        import_.findings.left_out("actuator <general> of biastype " + actuator.text("biastype"));
      }
      if (!(drive.stiffness >= 0 && drive.damping >= 0)) actuator.fail("found a gain below 0");
      if (drive.stiffness > 0 && actuator.has("forcerange"))
        import_.findings.left_out("forcerange of a position actuator");
      Drive& sum = drives_[actuator.text("joint")];
      const double stiffness = drive.stiffness * gear * gear;
      if (sum.stiffness + stiffness > 0)
        sum.target = (sum.stiffness * sum.target + stiffness * (gear != 0 ? drive.target / gear : 0)) /
                     (sum.stiffness + stiffness);
      sum.stiffness += stiffness;
      sum.damping += drive.damping * gear * gear;
    }
  }
}

MassProperties MjcfReader::inertial_of(const XmlElement& inertial) const {
  MassProperties out;
  const Transform frame = mjcf_frame(inertial, compiler_);
  out.mass = float(inertial.need_number("mass"));
  if (!(out.mass >= 0.0f)) inertial.fail("found a mass below 0");
  out.center = frame.position;
  Sym3 own;
  if (const auto full = inertial.numbers("fullinertia", 6, 6); !full.empty()) {
    own = {float(full[0]), float(full[1]), float(full[2]), float(full[3]), float(full[4]), float(full[5])};
  } else {
    const Vec3 moments = inertial.vec3("diaginertia", {});
    own = {moments.x, moments.y, moments.z, 0, 0, 0};
  }
  const Mat3 turn = to_matrix(frame.orientation);
  out.inertia = to_symmetric(turn * to_matrix(own) * transpose(turn));
  return out;
}

MjcfJoint MjcfReader::joint_of(const XmlElement& element, const Pose& pose) {
  MjcfJoint joint{element, element.text("name"), false, {}};
  const std::string type = element.text("type", "hinge");
  if (type != "hinge" && type != "slide" && type != "ball")
    element.fail("found the type \"" + type + "\", expected free, ball, slide or hinge");
  joint.ball = type == "ball";
  ModelAxis& axis = joint.axis;
  axis.name = joint.name;
  axis.slide = type == "slide";
  axis.anchor = pose * element.vec3("pos", {});
  const Vec3 direction = element.vec3("axis", {0, 0, 1});
  if (!(length(direction) > 0.0f)) element.fail("found an axis of no length");
  axis.axis = rotate(pose.orientation, normalized(direction));
  const auto coordinate = [&](double value) { return axis.slide ? value : compiler_.angle(value); };
  const double reference = coordinate(element.number("ref", 0));
  const std::vector<double> range = element.numbers("range", 2, 2);
  const std::string limited = element.text("limited", "auto");
  if (!range.empty() && (limited == "true" || (limited == "auto" && compiler_.auto_limits))) {
    axis.limits = Limits{float(coordinate(range[0]) - reference), float(coordinate(range[1]) - reference)};
    if (axis.limits->low > axis.limits->high) element.fail("found a lower limit above the upper one");
  }
  // MuJoCo takes the first of two stiffnesses for the linear spring.
  const auto first_of = [&](const char* name) {
    const std::vector<double> values = element.numbers(name, 1, 3);
    return values.empty() ? 0.0 : max(0.0, values[0]);
  };
  double stiffness = first_of("stiffness"), rest = coordinate(element.number("springref", 0));
  axis.friction = float(first_of("frictionloss"));
  double damping = first_of("damping");
  const auto drive = drives_.find(joint.name);
  if (drive != drives_.end() && !joint.name.empty()) {
    damping += drive->second.damping;
    const double sum = stiffness + drive->second.stiffness;
    if (sum > 0) rest = (stiffness * rest + drive->second.stiffness * drive->second.target) / sum;
    stiffness = sum;
  }
  axis.stiffness = float(stiffness);
  axis.damping = float(damping);
  axis.rest = stiffness > 0 ? float(rest - reference) : 0.0f;
  if (element.number("armature", 0) != 0) import_.findings.left_out("armature of a joint");
  return joint;
}

void MjcfReader::read_geoms(const XmlElement& body, ModelLink& link, bool has_inertial) {
  const bool needs_mass = link.parent >= 0 && !has_inertial;
  std::vector<MassProperties> masses;
  std::pair<std::uint32_t, std::uint32_t> bits{0, 0};
  bool is_first = true;
  for (const XmlElement& element : body.children("geom")) {
    MjcfGeom geom = read_geom(import_, element, compiler_, assets_, needs_mass);
    if (geom.mass) masses.push_back(*geom.mass);
    if (!geom.shape) continue;
    const std::pair<std::uint32_t, std::uint32_t> own{geom.contype, geom.conaffinity};
    if (!is_first && own != bits)
      import_.findings.left_out("contype or conaffinity that differs within a body");
    bits = is_first ? own : std::pair{bits.first | own.first, bits.second | own.second};
    is_first = false;
    link.shapes.push_back(*std::move(geom.shape));
  }
  contact_bits_.push_back(bits);
  if (!masses.empty()) link.mass = combined(masses);
}

void MjcfReader::read_body(const XmlElement& body, int parent, int depth) {
  if (depth > 300) body.fail("is nested deeper than 300 bodies");
  if (tree_.size() >= kMaxMjcfBodies) body.fail("found more than 100000 bodies");
  const int index = int(tree_.size());
  const bool is_world = parent < 0;
  ModelLink link;
  link.name = is_world ? "worldbody" : body.text("name", "body");
  link.parent = parent;
  link.pose = is_world ? z_up_world() : tree_[std::size_t(parent)].pose * mjcf_frame(body, compiler_);
  link.pose.orientation = normalized(link.pose.orientation);
  std::vector<MjcfJoint> joints;
  bool is_free = false;
  for (const XmlElement& joint : body.children()) {
    const std::string tag = joint.name();
    if (tag == "freejoint" || (tag == "joint" && joint.text("type") == "free")) {
      is_free = true;
    } else if (tag == "joint") {
      joints.push_back(joint_of(joint, link.pose));
    }
  }
  if (is_world && (is_free || !joints.empty())) body.fail("found a joint of the world");
  if (is_free && (parent != 0 || !joints.empty()))
    body.fail("found a free joint that is not the only joint of a child of the world");
  link.welded = is_world || (joints.empty() && !is_free);
  const XmlElement inertial = body.child("inertial");
  const bool has_inertial = bool(inertial) && compiler_.inertia_from_geom != "true";
  if (has_inertial) link.mass = inertial_of(inertial);
  read_geoms(body, link, has_inertial);
  if (!is_world && body.has("name") && !link_names_.emplace(link.name, index).second)
    body.fail("found a second body \"" + link.name + "\"");
  tree_.push_back(std::move(link));
  joints_.push_back(std::move(joints));
  for (const XmlElement& part : body.children()) {
    const std::string tag = part.name();
    if (tag == "body") {
      read_body(part, index, depth + 1);
    } else if (tag == "frame" || tag == "replicate" || tag == "composite" || tag == "flexcomp" ||
               tag == "attach") {
      import_.findings.left_out("<" + tag + ">");
    }
  }
}

JointDef MjcfReader::ball_of(const MjcfJoint& joint) const {
  if (joint.axis.limits || joint.axis.stiffness != 0 || joint.axis.damping != 0)
    import_.findings.left_out("range, stiffness or damping of a ball joint");
  BallDef ball;
  ball.anchor = joint.axis.anchor;
  ball.friction = joint.axis.friction;
  return ball;
}

// One joint of the engine for all joints of a body where there is one; else a light body between each two of them.
void MjcfReader::connect(int parent, int child, const std::vector<MjcfJoint>& joints) {
  const bool parent_is_static = import_.scene.bodies[std::size_t(parent)].def.type == BodyType::fixed;
  const auto add = [&](const std::string& name, int a, int b, JointDef def) {
    if (parent_is_static) std::visit([](auto& d) { d.collide_connected = true; }, def);
    add_joint(import_, name, a, b, std::move(def));
  };
  std::vector<ModelAxis> axes;
  bool has_ball = false;
  for (const MjcfJoint& joint : joints) {
    axes.push_back(joint.axis);
    has_ball = has_ball || joint.ball;
    if (!joint.name.empty())
      joint_places_[joint.name] = {parent, child, joint.axis, joints.size() == 1 && !joint.ball, -1};
  }
  std::optional<JointDef> whole;
  if (!has_ball) whole = joint_of_axes(axes);
  if (has_ball && joints.size() == 1) whole = ball_of(joints[0]);
  if (whole && joints.size() == 1 && !joints[0].name.empty())
    joint_places_[joints[0].name].made = int(import_.scene.joints.size());
  if (whole) return add(joints[0].name, parent, child, *whole);
  int from = parent;
  for (std::size_t i = 0; i < joints.size(); ++i) {
    int to = child;
    if (i + 1 < joints.size()) {
      import_.findings.left_out(
          "joints of one body without a joint of the engine, given a body of 0.001 kg between two");
      SceneBody between;
      const SceneBody& last = import_.scene.bodies[std::size_t(child)];
      between.name = Import::unique(import_.body_names, last.name + "_between", "between");
      between.def.pose = {joints[i].axis.anchor, last.def.pose.orientation};
      between.def.mass = 1.0e-3f;
      between.def.inertia = Sym3{1.0e-6f, 1.0e-6f, 1.0e-6f, 0, 0, 0};
      between.def.center_of_mass = Vec3{};
      to = int(import_.scene.bodies.size());
      import_.scene.bodies.push_back(std::move(between));
    }
    const std::optional<JointDef> one = joints[i].ball ? ball_of(joints[i]) : joint_of_axes({joints[i].axis});
    add(joints[i].name, from, to, *one);
    from = to;
  }
}

void MjcfReader::make_joints() {
  for (std::size_t i = 1; i < tree_.size(); ++i) {
    if (!joints_[i].empty()) connect(body_of_[std::size_t(tree_[i].parent)], body_of_[i], joints_[i]);
  }
}

int MjcfReader::body_named(const XmlElement& element, const char* attribute, bool required) const {
  const std::string name = element.text(attribute);
  if (name.empty() && !required) return -1;
  if (name == "world") return -1;
  const auto found = link_names_.find(name);
  if (found == link_names_.end())
    element.fail("found " + std::string(attribute) + " \"" + name + "\", expected the name of a body");
  return body_of_[std::size_t(found->second)];
}

// Positions are measured from the pose of the file, as its polynomials are.
void MjcfReader::couple_joints(const XmlElement& equality) {
  const auto first = joint_places_.find(equality.need_text("joint1"));
  if (first == joint_places_.end())
    equality.fail("found joint1 \"" + equality.text("joint1") + "\", expected the name of a joint");
  const auto second = joint_places_.find(equality.text("joint2"));
  const std::vector<double> poly = polynomial_of(equality);
  if (second == joint_places_.end() || !is_linear(poly) || poly[1] == 0 || !first->second.alone || !second->second.alone) {
    import_.findings.left_out("equality <joint>");
    return;
  }
  SceneCoupling coupling;
  coupling.terms = {term_of(first->second, 1), term_of(second->second, -poly[1])};
  coupling.offset = float(poly[0]);
  import_.scene.couplings.push_back(std::move(coupling));
}

// Fixed tendons by name. Without a spring, limit or friction of its own a tendon exerts nothing until an equality holds it.
void MjcfReader::read_tendons() {
  for (const XmlElement& section : root_.children("tendon")) {
    for (const XmlElement& tendon : section.children()) {
      if (tendon.name() != "fixed") {
        import_.findings.left_out("tendon <" + tendon.name() + ">");
        continue;
      }
      TendonTerms terms;
      for (const XmlElement& term : tendon.children("joint")) {
        const std::string joint = term.need_text("joint");
        if (joint_places_.count(joint) == 0)
          term.fail("found joint \"" + joint + "\", expected the name of a joint");
        terms[joint] += term.need_number("coef");
      }
      if (tendon.has("name")) tendons_[tendon.text("name")] = std::move(terms);
      for (const char* force : {"stiffness", "damping", "frictionloss"}) {
        if (tendon.has(force) && !(tendon.number(force, 0) == 0))
          import_.findings.left_out(std::string(force) + " of a fixed tendon");
      }
      const bool is_limited = tendon.text("limited", "auto") == "auto"
                                  ? tendon.has("range") && compiler_.auto_limits
                                  : tendon.text("limited") == "true";
      if (is_limited) import_.findings.left_out("limits of a fixed tendon");
    }
  }
}

void MjcfReader::add_terms(const XmlElement& equality, const char* attribute, double factor,
                           TendonTerms& terms) const {
  const auto tendon = tendons_.find(equality.text(attribute));
  if (tendon == tendons_.end()) {
    equality.fail("found " + std::string(attribute) + " \"" + equality.text(attribute) +
                  "\", expected the name of a fixed tendon");
  }
  for (const auto& [joint, coefficient] : tendon->second) terms[joint] += factor * coefficient;
}

// The length of one tendon stays, or is a multiple of another's.
void MjcfReader::couple_tendons(const XmlElement& equality) {
  const std::vector<double> poly = polynomial_of(equality);
  TendonTerms terms;
  add_terms(equality, "tendon1", 1, terms);
  if (equality.has("tendon2")) add_terms(equality, "tendon2", -poly[1], terms);
  SceneCoupling coupling;
  bool alone = true;
  for (const auto& [joint, coefficient] : terms) {
    if (coefficient == 0) continue;
    const JointPlace& place = joint_places_.at(joint);
    alone = alone && place.alone;
    coupling.terms.push_back(term_of(place, coefficient));
  }
  const std::size_t count = coupling.terms.size();
  if (!alone || count < 2 || count > std::size_t(kMaxCouplingTerms) || !is_linear(poly))
    return import_.findings.left_out("equality <tendon>");
  coupling.offset = float(poly[0]);
  import_.scene.couplings.push_back(std::move(coupling));
}

void MjcfReader::read_equalities() {
  for (const XmlElement& section : root_.children("equality")) {
    for (const XmlElement& equality : section.children()) {
      const std::string kind = equality.name();
      if (!equality.flag("active", true)) continue;
      if (kind == "joint") {
        couple_joints(equality);
        continue;
      }
      if (kind == "tendon" && tendons_.count(equality.text("tendon1")) != 0) {
        couple_tendons(equality);
        continue;
      }
      if ((kind != "connect" && kind != "weld") || !equality.has("body1")) {
        import_.findings.left_out("equality <" + kind + ">");
        continue;
      }
      const int a = body_named(equality, "body1", true), b = body_named(equality, "body2", false);
      const auto link = link_names_.find(equality.text("body1"));
      if (a == b || link == link_names_.end()) {
        import_.findings.left_out("equality <" + kind + "> within one body");
        continue;
      }
      if (equality.has("relpose")) import_.findings.left_out("relpose of a weld");
      const DVec3 anchor = tree_[std::size_t(link->second)].pose * equality.vec3("anchor", {});
      if (kind == "connect") {
        BallDef ball;
        ball.anchor = anchor;
        add_joint(import_, equality.text("name", "connect"), a, b, ball);
      } else {
        FixedDef weld;
        weld.anchor = anchor;
        add_joint(import_, equality.text("name", "weld"), a, b, weld);
      }
    }
  }
}

// A joint whose six axes are free holds nothing and keeps its two bodies from colliding.
void MjcfReader::read_excludes() {
  for (const XmlElement& section : root_.children("contact")) {
    for (const XmlElement& entry : section.children()) {
      if (entry.name() != "exclude") {
        import_.findings.left_out("contact <" + entry.name() + ">");
        continue;
      }
      const int a = body_named(entry, "body1", true), b = body_named(entry, "body2", true);
      if (a == b) continue;
      SixDofDef nothing;
      for (JointAxisDef* axis : {&nothing.linear_x, &nothing.linear_y, &nothing.linear_z, &nothing.angular_x,
                                 &nothing.angular_y, &nothing.angular_z})
        axis->motion = AxisMotion::free;
      nothing.anchor = import_.scene.bodies[std::size_t(a >= 0 ? a : b)].def.pose.position;
      add_joint(import_, entry.text("name", "exclude"), a, b, nothing);
    }
  }
}

// Two geoms collide if the contype of either meets the conaffinity of the other. Each pair of the two that occurs gets a layer.
void MjcfReader::set_filters() {
  std::vector<std::pair<std::uint32_t, std::uint32_t>> kinds;
  for (std::size_t i = 0; i < tree_.size(); ++i) {
    if (!tree_[i].shapes.empty() && std::find(kinds.begin(), kinds.end(), contact_bits_[i]) == kinds.end())
      kinds.push_back(contact_bits_[i]);
  }
  if (kinds.size() > 32) return import_.findings.left_out("contype and conaffinity of more than 32 kinds");
  for (std::size_t i = 0; i < tree_.size(); ++i) {
    Filter filter{0, 0, 0};
    for (std::size_t k = 0; k < kinds.size(); ++k) {
      if (kinds[k] == contact_bits_[i]) filter.layer = std::uint32_t(1) << k;
      const bool meets =
          (kinds[k].first & contact_bits_[i].second) != 0 || (contact_bits_[i].first & kinds[k].second) != 0;
      if (meets) filter.collides_with |= std::uint32_t(1) << k;
    }
    if (filter == Filter{1, 1, 0} && kinds.size() == 1) filter = Filter{};
    if (!tree_[i].shapes.empty()) tree_[i].filter = filter;
  }
}

void MjcfReader::count_unknown() const {
  constexpr const char* kKnown[] = {"compiler", "option",    "size",     "visual",   "statistic", "default",
                                    "asset",    "worldbody", "actuator", "equality", "contact",   "tendon"};
  for (const XmlElement& section : root_.children()) {
    const std::string name = section.name();
    if (std::any_of(std::begin(kKnown), std::end(kKnown), [&](const char* known) { return name == known; }))
      continue;
    for (const XmlElement& entry : section.children())
      import_.findings.left_out(name + " <" + entry.name() + ">");
  }
}

void MjcfReader::read() {
  if (const std::string name = root_.text("model"); !name.empty()) import_.scene.name = name;
  read_compiler();
  read_option();
  read_assets();
  read_actuators();
  read_body(root_.need_child("worldbody"), -1, 0);
  set_filters();
  body_of_ = build_bodies(import_, tree_);
  make_joints();
  read_tendons();
  read_equalities();
  read_excludes();
  count_unknown();
}

}  // namespace

void read_mjcf(Import& import, tinyxml2::XMLDocument& document) {
  include_files(import, document);
  apply_defaults(import, document);
  const XmlElement root(document.RootElement(), import);
  MjcfReader(import, root).read();
}

}  // namespace gyre
