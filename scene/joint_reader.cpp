// Joints of a scene. Members that mean nothing for a type of joint are refused, so that none is passed over silently; null
// says nothing and is allowed anywhere. See scene_parts.h.
#include "scene/scene_parts.h"

#include <cmath>

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

// A bit for each kind.
constexpr std::uint32_t bits(std::initializer_list<JointKind> kinds) {
  std::uint32_t set = 0;
  for (const JointKind kind : kinds) set |= 1u << int(kind);
  return set;
}
using enum JointKind;
constexpr std::uint32_t kHasLimits = bits({hinge, slider, cone, universal, wheel, path});
constexpr std::uint32_t kHasMotor = bits({hinge, slider, universal, wheel, path, cone});
constexpr std::uint32_t kHasSpring = bits({distance, hinge, slider, universal, cone, wheel, path});
constexpr std::uint32_t kHasFriction = bits({ball, hinge, slider, cone, universal, wheel, path});
constexpr std::uint32_t kHasAxisB = bits({cone, universal, six_dof, gear, rack_and_pinion, wheel, motor});
constexpr std::uint32_t kNeedsAxis = bits({hinge, slider, cone, universal, gear, rack_and_pinion, wheel});
constexpr std::uint32_t kTakesAxis = kNeedsAxis | bits({six_dof, motor});
constexpr std::uint32_t kHasDrive = bits({cone, mouse, motor});

bool is_among(const JointDef& def, std::uint32_t kinds) { return ((kinds >> int(def.kind)) & 1u) != 0; }

void refuse_all(Members& members, std::initializer_list<const char*> keys, const char* why) {
  for (const char* key : keys) members.refuse(key, why);
}

void read_anchor(const SceneReading& reading, Members& members, SceneJoint& joint) {
  if (const auto anchor = members.find_value("anchor")) {
    joint.def.anchor = anchor->place();
    return;
  }
  switch (joint.def.kind) {
    case ball:
    case hinge:
    case cone:
    case universal:
    case wheel: members.need("anchor").place(); return;
    case distance:
    case pulley:
    case gear:
    case rack_and_pinion: joint.def.anchor = origin_of(reading, joint.a >= 0 ? joint.a : joint.b); return;
    default: joint.def.anchor = origin_of(reading, joint.b >= 0 ? joint.b : joint.a); return;
  }
}

Vec3 read_direction(const Field& field) {
  const Vec3 direction = field.vec3();
  if (direction == Vec3{}) field.fail("found a zero vector, expected a direction");
  return direction;
}

void read_directions(Members& members, JointDef& def) {
  if (const auto axis = members.find_value("axis")) {
    const Vec3 direction = read_direction(*axis);
    if (is_among(def, kTakesAxis)) def.axis = direction;
  } else if (is_among(def, kNeedsAxis)) {
    members.need("axis").vec3();
  }
  if (!is_among(def, kHasAxisB)) {
    members.refuse("axis_b", "this type of joint has one axis at most");
  } else if (const auto axis = members.find_value("axis_b")) {
    def.axis_b = read_direction(*axis);
  } else if (def.kind == rack_and_pinion) {
    members.need("axis_b").vec3();
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
void read_axes(Members& members, JointDef& def) {
  const bool any = def.kind == six_dof || def.kind == wheel || def.kind == universal;
  if (!any) return members.refuse("axes", "only six_dof, wheel and universal joints have axes to tell apart");
  const auto axes = members.find_value("axes");
  if (!axes) return;
  Members each(*axes, "axes of a joint");
  const auto read = [&](const char* key, JointAxisDef& axis, bool allowed, const char* why) {
    if (!allowed) return each.refuse(key, why);
    if (const auto one = each.find_value(key)) axis = read_axis(*one, def.kind != universal);
  };
  const bool all = def.kind == six_dof;
  read("linear_x", def.linear_x, all, "a wheel's suspension is in its limits, stiffness and damping");
  read("linear_y", def.linear_y, all, "only six_dof has this axis");
  read("linear_z", def.linear_z, all, "only six_dof has this axis");
  read("angular_x", def.angular_x, all || def.kind == wheel, "what turns about axis is in limits and motor");
  read("angular_y", def.angular_y, all, "only six_dof has this axis");
  read("angular_z", def.angular_z, all || def.kind == universal, "a wheel's spin is in its motor and friction");
  each.finish();
}

void read_travel(Members& members, JointDef& def) {
  if (is_among(def, kHasLimits)) {
    if (const auto limits = members.find_value("limits")) def.limits = read_limits(*limits);
    members.read("limit_frequency", def.limit_frequency, Range::between(0, kMaxSurface));
    members.read("limit_damping_ratio", def.limit_damping_ratio, Range::between(0, kMaxSurface));
  } else {
    refuse_all(members, {"limits", "limit_frequency", "limit_damping_ratio"}, "this type of joint has no limits");
  }
  if (is_among(def, kHasMotor)) {
    if (const auto motor = members.find_value("motor")) def.motor = read_motor(*motor);
  } else {
    members.refuse("motor", "this type of joint has no motor");
  }
  if (is_among(def, kHasFriction)) {
    members.read("friction", def.friction, Range::at_least(0));
  } else {
    members.refuse("friction", "this type of joint has no friction");
  }
  if (is_among(def, kHasSpring)) {
    members.read("stiffness", def.stiffness, Range::at_least(0));
    members.read("damping", def.damping, Range::at_least(0));
  } else {
    refuse_all(members, {"stiffness", "damping"}, "this type of joint has no spring");
  }
  if (def.kind == cone) {
    if (const auto swing = members.find_value("swing")) {
      swing->array("an array of 2 angles [about y, about z]", 2);
      def.swing_y = swing->element(0).real(Range::between(0, 3.1415));
      def.swing_z = swing->element(1).real(Range::between(0, 3.1415));
    }
  } else {
    members.refuse("swing", "only cones have this");
  }
}

void read_lengths(Members& members, JointDef& def) {
  if (def.kind != distance && def.kind != pulley) {
    refuse_all(members, {"anchor_b", "length"}, "only distance joints and pulleys have this");
  } else {
    if (const auto anchor = members.find_value("anchor_b")) def.anchor_b = anchor->place();
    members.read("length", def.length, Range::at_least(0));
  }
  if (def.kind != distance) {
    return refuse_all(members, {"min_length", "max_length", "frequency", "damping_ratio"}, "only distance joints have this");
  }
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
}

void read_gearing(Members& members, JointDef& def) {
  if (def.kind == gear || def.kind == rack_and_pinion || def.kind == pulley) {
    if (const auto ratio = members.find_value("ratio")) {
      def.ratio = ratio->real(Range::between(-1.0e6, 1.0e6));
      if (std::fabs(double(def.ratio)) < 1.0e-6) ratio->expected("a ratio that is not zero");
      if (def.kind == pulley && def.ratio < 0.0f) ratio->expected("a ratio above 0");
    }
  } else {
    members.refuse("ratio", "only gears, racks and pulleys have this");
  }
  if (def.kind == pulley) {
    def.ground_a = members.need("ground_a").place();
    def.ground_b = members.need("ground_b").place();
  } else {
    refuse_all(members, {"ground_a", "ground_b"}, "only pulleys have this");
  }
}

void read_path(Members& members, JointDef& def) {
  if (def.kind != path) return refuse_all(members, {"path", "path_closed", "path_orientation"}, "only paths have this");
  members.read("path_closed", def.path_closed);
  if (const auto word = members.find_value("path_orientation")) {
    def.path_orientation = word->choice<PathOrientation>({{"free", PathOrientation::free},
                                                          {"fixed", PathOrientation::fixed},
                                                          {"following", PathOrientation::following}});
  }
  const Field points = members.need("path");
  const std::size_t count = points.array("an array of points");
  if (count < (def.path_closed ? 3u : 2u) || count > std::size_t(kMaxPathPoints))
    points.expected(def.path_closed ? "3 to 4096 points" : "2 to 4096 points");
  for (std::size_t i = 0; i < count; ++i) def.path.push_back(difference(points.element(i).place(), def.anchor));
}

void read_drive(Members& members, JointDef& def) {
  if (!is_among(def, kHasDrive)) return members.refuse("drive", "only motors, mice and cones have this");
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

}  // namespace

void read_joint(SceneReading& reading, const Field& field) {
  Members members(field, "a joint");
  SceneJoint joint;
  JointDef& def = joint.def;
  def.kind = members.need("type").choice<JointKind>({{"ball", JointKind::ball},
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
                                                     {"motor", JointKind::motor}});
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
  read_anchor(reading, members, joint);
  read_directions(members, def);
  read_travel(members, def);
  read_axes(members, def);
  read_lengths(members, def);
  read_gearing(members, def);
  read_path(members, def);
  read_drive(members, def);
  members.read("break_force", def.break_force, Range::above(0));
  members.read("break_torque", def.break_torque, Range::above(0));
  members.read("collide_connected", def.collide_connected);
  members.finish();
  reading.scene.joints.push_back(std::move(joint));
}

}  // namespace gyre
