// Joints of a scene. Members that mean nothing for a type of joint are refused, so that none is passed over silently; null
// says nothing and is allowed anywhere. See scene_parts.h.
#include "scene/scene_parts.h"

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
  members.read("frequency", motor.frequency, Range::between(0, kMostSurface));
  members.read("damping_ratio", motor.damping_ratio, Range::between(0, kMostSurface));
  members.finish();
  return motor;
}

void read_anchor(const SceneReading& reading, Members& members, SceneJoint& joint) {
  if (const auto anchor = members.find_value("anchor")) {
    joint.def.anchor = anchor->place();
    return;
  }
  switch (joint.def.kind) {
    case JointKind::ball:
    case JointKind::hinge:
      members.need("anchor").place();
      return;
    case JointKind::distance:
      joint.def.anchor = origin_of(reading, joint.a);
      return;
    case JointKind::slider:
    case JointKind::fixed:
      joint.def.anchor = origin_of(reading, joint.b >= 0 ? joint.b : joint.a);
      return;
  }
}

void read_axis(Members& members, JointDef& def) {
  const bool needed = def.kind == JointKind::hinge || def.kind == JointKind::slider;
  const std::optional<Field> axis = members.find_value("axis");
  if (!axis) {
    if (needed) members.need("axis").vec3();
    return;
  }
  const Vec3 direction = axis->vec3();
  if (direction == Vec3{}) axis->fail("found a zero vector, expected a direction");
  if (needed) def.axis = direction;
}

void read_travel(Members& members, JointDef& def) {
  if (def.kind == JointKind::hinge || def.kind == JointKind::slider) {
    if (const auto limits = members.find_value("limits")) def.limits = read_limits(*limits);
    if (const auto motor = members.find_value("motor")) def.motor = read_motor(*motor);
  } else {
    members.refuse("limits", "only hinges and sliders have limits");
    members.refuse("motor", "only hinges and sliders have a motor");
  }
}

void read_distance(Members& members, JointDef& def) {
  if (def.kind != JointKind::distance) {
    for (const char* key : {"anchor_b", "length", "min_length", "max_length", "stiffness", "damping"}) {
      members.refuse(key, "only distance joints have this");
    }
    return;
  }
  if (const auto anchor = members.find_value("anchor_b")) def.anchor_b = anchor->place();
  members.read("length", def.length, Range::at_least(0));
  members.read("min_length", def.min_length, Range::at_least(0));
  members.read("max_length", def.max_length, Range::at_least(0));
  if (def.min_length && def.max_length && *def.min_length > *def.max_length) {
    members.need("min_length").expected("at most max_length");
  }
  members.read("stiffness", def.stiffness, Range::at_least(0));
  members.read("damping", def.damping, Range::at_least(0));
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
                                                     {"cone", {}},
                                                     {"universal", {}},
                                                     {"six_dof", {}},
                                                     {"gear", {}},
                                                     {"pulley", {}},
                                                     {"wheel", {}}});
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
  read_axis(members, def);
  read_travel(members, def);
  read_distance(members, def);
  members.read("break_force", def.break_force, Range::above(0));
  members.read("break_torque", def.break_torque, Range::above(0));
  members.read("collide_connected", def.collide_connected);
  members.finish();
  reading.scene.joints.push_back(std::move(joint));
}

}  // namespace gyre
