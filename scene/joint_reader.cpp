// Joints of a scene. Members that mean nothing for a type of joint are refused, so that none is passed over silently; null
// says nothing and is allowed anywhere. See scene_parts.h.
#include "scene/scene_parts.h"

#include <gyre/coupling.h>

#include <cmath>
#include <type_traits>
#include <variant>

namespace gyre {
namespace {

int read_end(const SceneReading& reading, const Field& field) {
  const std::string& name = field.text();
  const auto body = reading.bodies.find(name);
  if (body != reading.bodies.end()) return body->second;
  if (name == "world") return -1;
  field.expected("the name of a body of this scene, or \"world\"");
}

// The place of a body's origin at the start; of the world its origin.
DVec3 origin_of(const SceneReading& reading, int body) {
  return body < 0 ? DVec3{} : reading.scene.bodies[std::size_t(body)].def.pose.position;
}

Limits read_limits(const Field& field) {
  field.array("an array of 2 numbers [low, high]", 2);
  const Range travel = Range::between(-1.0e9, 1.0e9);
  const Limits limits{field.element(0).real(travel), field.element(1).real(travel)};
  if (!(limits.low <= limits.high)) field.fail("found a lower limit above the upper one");
  return limits;
}

Motor read_motor(const Field& field) {
  Members members(field, "a motor");
  Motor motor;
  members.read("target_velocity", motor.target_velocity, Range::between(-1.0e6, 1.0e6));
  members.read("target_position", motor.target_position, Range::between(-1.0e9, 1.0e9));
  members.read("max_force", motor.max_force, Range::at_least(0));
  members.read("frequency", motor.frequency, Range::between(0, kMaxSurface));
  members.read("damping_ratio", motor.damping_ratio, Range::between(0, kMaxSurface));
  members.finish();
  return motor;
}

// The definition of a kind tells whether it has a field: `requires { def.limits; }`.
template <class Def, class... Some>
constexpr bool is_among = (std::is_same_v<Def, Some> || ...);

void refuse_all(Members& members, std::initializer_list<const char*> keys, const char* why) {
  for (const char* key : keys) members.refuse(key, why);
}

// Where the anchor of a kind is that does not need one: at the origin of one of its bodies.
template <class Def>
void read_anchor(const SceneReading& reading, Members& members, const SceneJoint& joint, Def& def) {
  if (const auto anchor = members.find_value("anchor")) {
    def.anchor = anchor->place();
  } else if constexpr (is_among<Def, BallDef, HingeDef, ConeDef, UniversalDef, WheelDef>) {
    members.need("anchor").place();
  } else if constexpr (is_among<Def, DistanceDef, PulleyDef, GearDef, RackAndPinionDef>) {
    def.anchor = origin_of(reading, joint.a >= 0 ? joint.a : joint.b);
  } else {
    def.anchor = origin_of(reading, joint.b >= 0 ? joint.b : joint.a);
  }
}

Vec3 read_direction(const Field& field) {
  const Vec3 direction = field.vec3();
  if (direction == Vec3{}) field.fail("found a zero vector, expected a direction");
  return direction;
}

template <class Def>
void read_directions(Members& members, Def& def) {
  constexpr bool needs_axis = !is_among<Def, SixDofDef, MotorDef>;
  if (const auto axis = members.find_value("axis")) {
    const Vec3 direction = read_direction(*axis);  // kinds without one take no notice of it
    if constexpr (requires { def.axis; }) def.axis = direction;
  } else if constexpr (requires { def.axis; } && needs_axis) {
    members.need("axis").vec3();
  }
  if constexpr (requires { def.axis_b; }) {
    if (const auto axis = members.find_value("axis_b")) {
      def.axis_b = read_direction(*axis);
    } else if constexpr (is_among<Def, RackAndPinionDef>) {
      members.need("axis_b").vec3();
    }
  } else {
    members.refuse("axis_b", "this type of joint has one axis at most");
  }
}

const Range kTravel = Range::between(-1.0e9, 1.0e9);

JointAxisDef read_axis(const Field& field, bool may_lock) {
  Members members(field, "an axis of a joint");
  JointAxisDef axis;
  axis.motion = may_lock ? AxisMotion::locked : AxisMotion::free;
  if (const auto motion = members.find_value("motion")) {
    axis.motion = motion->choice<AxisMotion>(
        {{"locked", AxisMotion::locked}, {"free", AxisMotion::free}, {"limited", AxisMotion::limited}});
  }
  if (const auto limits = members.find_value("limits")) {
    axis.limits = read_limits(*limits);
    axis.motion = AxisMotion::limited;
  }
  members.read("limit_frequency", axis.limit_frequency, Range::between(0, kMaxSurface));
  members.read("limit_damping_ratio", axis.limit_damping_ratio, Range::between(0, kMaxSurface));
  if (const auto motor = members.find_value("motor")) axis.motor = read_motor(*motor);
  members.read("stiffness", axis.stiffness, Range::at_least(0));
  members.read("damping", axis.damping, Range::at_least(0));
  members.read("rest_position", axis.rest_position, kTravel);
  members.read("friction", axis.friction, Range::at_least(0));
  members.finish();
  return axis;
}

// The axes of their own that some kinds have.
template <class Def>
void read_axes(Members& members, Def& def) {
  constexpr bool all = is_among<Def, SixDofDef>;
  if constexpr (!all && !is_among<Def, WheelDef, UniversalDef>) {
    members.refuse("axes", "only six_dof, wheel and universal joints have axes to tell apart");
  } else {
    const auto axes = members.find_value("axes");
    if (!axes) return;
    Members each(*axes, "axes of a joint");
    const auto read = [&](const char* key, JointAxisDef* axis, const char* why) {
      if (axis == nullptr) return each.refuse(key, why);
      if (const auto one = each.find_value(key)) *axis = read_axis(*one, !is_among<Def, UniversalDef>);
    };
    JointAxisDef *linear[3] = {}, *angular[3] = {};
    if constexpr (all) {
      linear[0] = &def.linear_x, linear[1] = &def.linear_y, linear[2] = &def.linear_z;
      angular[0] = &def.angular_x, angular[1] = &def.angular_y;
    }
    if constexpr (requires { def.steering; }) angular[0] = &def.steering;
    if constexpr (requires { def.angular_z; }) angular[2] = &def.angular_z;
    read("linear_x", linear[0], "a wheel's suspension is in its limits, stiffness and damping");
    read("linear_y", linear[1], "only six_dof has this axis");
    read("linear_z", linear[2], "only six_dof has this axis");
    read("angular_x", angular[0], "what turns about axis is in limits and motor");
    read("angular_y", angular[1], "only six_dof has this axis");
    read("angular_z", angular[2], "a wheel's spin is in its motor and friction");
    each.finish();
  }
}

template <class Def>
void read_limits_of(Members& members, Def& def) {
  if constexpr (requires { def.limits; }) {
    if (const auto limits = members.find_value("limits")) def.limits = read_limits(*limits);
    members.read("limit_frequency", def.limit_frequency, Range::between(0, kMaxSurface));
    members.read("limit_damping_ratio", def.limit_damping_ratio, Range::between(0, kMaxSurface));
  } else {
    refuse_all(members, {"limits", "limit_frequency", "limit_damping_ratio"}, "this type of joint has no limits");
  }
}

template <class Def>
void read_forces(Members& members, Def& def) {
  if constexpr (requires { def.motor; }) {
    if (const auto motor = members.find_value("motor")) def.motor = read_motor(*motor);
  } else {
    members.refuse("motor", "this type of joint has no motor");
  }
  if constexpr (requires { def.friction; }) {
    members.read("friction", def.friction, Range::at_least(0));
  } else {
    members.refuse("friction", "this type of joint has no friction");
  }
  if constexpr (requires { def.stiffness; }) {
    members.read("stiffness", def.stiffness, Range::at_least(0));
    members.read("damping", def.damping, Range::at_least(0));
  } else {
    refuse_all(members, {"stiffness", "damping"}, "this type of joint has no spring");
  }
  if constexpr (requires { def.swing_y; }) {
    if (const auto swing = members.find_value("swing")) {
      swing->array("an array of 2 angles [about y, about z]", 2);
      def.swing_y = swing->element(0).real(Range::between(0, 3.1415));
      def.swing_z = swing->element(1).real(Range::between(0, 3.1415));
    }
  } else {
    members.refuse("swing", "only cones have this");
  }
}

template <class Def>
void read_lengths(Members& members, Def& def) {
  if constexpr (requires { def.anchor_b; }) {
    if (const auto anchor = members.find_value("anchor_b")) def.anchor_b = anchor->place();
    members.read("length", def.length, Range::at_least(0));
  } else {
    refuse_all(members, {"anchor_b", "length"}, "only distance joints and pulleys have this");
  }
  if constexpr (requires { def.min_length; }) {
    members.read("frequency", def.frequency, Range::between(1.0e-6, kMaxSurface));
    if (!def.frequency) members.refuse("damping_ratio", "it goes with a frequency");
    members.read("damping_ratio", def.damping_ratio, Range::between(0, kMaxSurface));
    if (def.frequency && (def.stiffness || def.damping)) {
      members.need("frequency").fail("found beside stiffness or damping, of which it takes the place");
    }
    members.read("min_length", def.min_length, Range::at_least(0));
    members.read("max_length", def.max_length, Range::at_least(0));
    if (def.min_length && def.max_length && *def.min_length > *def.max_length) {
      members.need("min_length").expected("at most max_length");
    }
  } else {
    refuse_all(members, {"min_length", "max_length", "frequency", "damping_ratio"},
               "only distance joints have this");
  }
}

template <class Def>
void read_gearing(Members& members, Def& def) {
  constexpr bool is_pulley = is_among<Def, PulleyDef>;
  if constexpr (requires { def.ratio; }) {
    if (const auto ratio = members.find_value("ratio")) {
      def.ratio = ratio->real(Range::between(-1.0e6, 1.0e6));
      if (std::fabs(double(def.ratio)) < 1.0e-6) ratio->expected("a ratio that is not zero");
      if (is_pulley && def.ratio < 0.0f) ratio->expected("a ratio above 0");
    }
  } else {
    members.refuse("ratio", "only gears, racks and pulleys have this");
  }
  if constexpr (is_pulley) {
    def.ground_a = members.need("ground_a").place();
    def.ground_b = members.need("ground_b").place();
  } else {
    refuse_all(members, {"ground_a", "ground_b"}, "only pulleys have this");
  }
}

template <class Def>
void read_path(Members& members, Def& def) {
  if constexpr (!is_among<Def, PathDef>) {
    refuse_all(members, {"path", "path_closed", "path_orientation"}, "only paths have this");
  } else {
    members.read("path_closed", def.closed);
    if (const auto word = members.find_value("path_orientation")) {
      def.orientation = word->choice<PathOrientation>({{"free", PathOrientation::free},
                                                       {"fixed", PathOrientation::fixed},
                                                       {"following", PathOrientation::following}});
    }
    const Field points = members.need("path");
    const std::size_t count = points.array("an array of points");
    if (count < (def.closed ? 3u : 2u) || count > std::size_t(kMaxPathPoints))
      points.expected(def.closed ? "3 to 4096 points" : "2 to 4096 points");
    for (std::size_t i = 0; i < count; ++i)
      def.points.push_back(difference(points.element(i).place(), def.anchor));
  }
}

template <class Def>
void read_drive(Members& members, Def& def) {
  if constexpr (!requires { def.drive; }) {
    members.refuse("drive", "only motors, mice and cones have this");
  } else {
    const auto field = members.find_value("drive");
    if (!field) return;
    Members drive(*field, "a drive");
    PoseDrive& d = def.drive;
    drive.read("position", d.position);
    drive.read("orientation", d.orientation);
    drive.read("linear_velocity", d.linear_velocity);
    drive.read("angular_velocity", d.angular_velocity);
    drive.read("frequency", d.frequency, Range::between(0, kMaxSurface));
    drive.read("damping_ratio", d.damping_ratio, Range::between(0, kMaxSurface));
    drive.read("max_force", d.max_force, Range::at_least(0));
    drive.read("max_torque", d.max_torque, Range::at_least(0));
    drive.finish();
  }
}

template <class Def>
void read_definition(const SceneReading& reading, Members& members, const SceneJoint& joint, Def& def) {
  read_anchor(reading, members, joint, def);
  read_directions(members, def);
  read_limits_of(members, def);
  read_forces(members, def);
  read_axes(members, def);
  read_lengths(members, def);
  read_gearing(members, def);
  read_path(members, def);
  read_drive(members, def);
  members.read("break_force", def.break_force, Range::above(0));
  members.read("break_torque", def.break_torque, Range::above(0));
  members.read("collide_connected", def.collide_connected);
}

}  // namespace

void read_joint(SceneReading& reading, const Field& field) {
  Members members(field, "a joint");
  SceneJoint joint;
  joint.def =
      default_joint(members.need("type").choice<JointKind>({{"ball", JointKind::ball},
                                                            {"hinge", JointKind::hinge},
                                                            {"slider", JointKind::slider},
                                                            {"fixed", JointKind::fixed},
                                                            {"distance", JointKind::distance},
                                                            {"cone", JointKind::cone},
                                                            {"universal", JointKind::universal},
                                                            {"six_dof", JointKind::six_dof},
                                                            {"gear", JointKind::gear},
                                                            {"rack_and_pinion", JointKind::rack_and_pinion},
                                                            {"pulley", JointKind::pulley},
                                                            {"wheel", JointKind::wheel},
                                                            {"path", JointKind::path},
                                                            {"mouse", JointKind::mouse},
                                                            {"motor", JointKind::motor}}));
  if (const auto name = members.find_value("name")) {
    joint.name = name->name(reading.options.limits.name_bytes);
    if (!reading.joints.emplace(joint.name, int(reading.scene.joints.size())).second) {
      name->expected("a name that no other joint has");
    }
  }
  joint.a = read_end(reading, members.need("a"));
  const Field b = members.need("b");
  joint.b = read_end(reading, b);
  if (joint.a == joint.b)
    b.expected(joint.a < 0 ? "a body, as \"a\" is the world" : "another body than \"a\"");
  std::visit([&](auto& def) { read_definition(reading, members, joint, def); }, joint.def);
  members.finish();
  reading.scene.joints.push_back(std::move(joint));
}

namespace {

JointAxis main_axis_of(const JointDef& def) {
  return std::holds_alternative<SliderDef>(def) ? JointAxis::linear_x : JointAxis::angular_x;
}

}  // namespace

void read_coupling(SceneReading& reading, const Field& field) {
  Members members(field, "a coupling");
  SceneCoupling coupling;
  const Field terms = members.need("terms");
  const std::size_t count = terms.array("an array of terms");
  if (count < 2 || count > std::size_t(kMaxCouplingTerms)) terms.expected("2 to 8 terms");
  for (std::size_t i = 0; i < count; ++i) {
    const Field element = terms.element(i);
    Members own(element, "a term");
    SceneCouplingTerm term;
    term.joint = find_name(reading.joints, own.need("joint"), "a joint");
    term.axis = main_axis_of(reading.scene.joints[std::size_t(term.joint)].def);
    if (const auto axis = own.find("axis")) {
      term.axis = axis->choice<JointAxis>({{"linear_x", JointAxis::linear_x},
                                           {"linear_y", JointAxis::linear_y},
                                           {"linear_z", JointAxis::linear_z},
                                           {"angular_x", JointAxis::angular_x},
                                           {"angular_y", JointAxis::angular_y},
                                           {"angular_z", JointAxis::angular_z}});
    }
    own.read("coefficient", term.coefficient, Range::between(-kMaxSurface, kMaxSurface));
    own.finish();
    coupling.terms.push_back(term);
  }
  if (const auto offset = members.find_value("offset")) coupling.offset = offset->real(Range::between(-1.0e9, 1.0e9));
  members.finish();
  reading.scene.couplings.push_back(std::move(coupling));
}

}  // namespace gyre
