// Bodies of a scene and the forces on them. See scene_parts.h.
#include "scene/scene_parts.h"

#include <limits>

namespace gyre {
namespace {

void read_axes(Members& members, const char* key, bool (&out)[3]) {
  const std::optional<Field> field = members.find(key);
  if (!field) return;
  field->array("an array of 3 truth values", 3);
  for (std::size_t axis = 0; axis < 3; ++axis) out[axis] = field->element(axis).boolean();
}

void read_locked(const Field& field, LockedAxes& locked) {
  Members members(field, "locked axes");
  read_axes(members, "linear", locked.linear);
  read_axes(members, "angular", locked.angular);
  members.finish();
}

void read_filter(const Field& field, Filter& filter) {
  constexpr std::int64_t kAllBits = 4294967295;
  Members members(field, "a filter");
  if (const auto layer = members.find("layer")) filter.layer = std::uint32_t(layer->integer(0, kAllBits));
  if (const auto mask = members.find("collides_with"))
    filter.collides_with = std::uint32_t(mask->integer(0, kAllBits));
  if (const auto group = members.find("group")) {
    filter.group = std::int32_t(
        group->integer(std::numeric_limits<std::int32_t>::min(), std::numeric_limits<std::int32_t>::max()));
  }
  members.finish();
}

Sym3 read_inertia(const Field& field) {
  field.array("an array of 6 numbers [xx, yy, zz, xy, xz, yz]", 6);
  float part[6];
  for (std::size_t i = 0; i < 6; ++i) part[i] = field.element(i).real(i < 3 ? Range::above(0) : Range::any());
  const Sym3 inertia{part[0], part[1], part[2], part[3], part[4], part[5]};
  const Error error = check_inertia(inertia);
  if (error) field.fail(error.message);
  return inertia;
}

SceneForce read_force(const Field& field) {
  Members members(field, "a force");
  SceneForce force;
  members.read("force", force.force);
  members.read("torque", force.torque);
  if (const auto at = members.find_value("at")) force.at = at->place();
  if (const auto frame = members.find("frame")) {
    force.in_body_frame = frame->choice<bool>({{"world", false}, {"body", true}});
  }
  members.read("start", force.start);
  members.read("end", force.end);
  members.finish();
  return force;
}

void read_motion(Members& members, BodyDef& def) {
  if (const auto position = members.find("position")) def.pose.position = position->place();
  members.read("orientation", def.pose.orientation);
  members.read("linear_velocity", def.linear_velocity);
  members.read("angular_velocity", def.angular_velocity);
  members.read("linear_damping", def.linear_damping, Range::between(0, kMaxSurface));
  members.read("angular_damping", def.angular_damping, Range::between(0, kMaxSurface));
  members.read("gravity_scale", def.gravity_scale, Range::between(-kMaxSurface, kMaxSurface));
  members.read("continuous", def.continuous);
  members.read("can_sleep", def.can_sleep);
  members.read("sleep_speed", def.sleep_speed, Range::between(0, kMaxSurface));
  members.read("enabled", def.enabled);
  if (const auto locked = members.find("locked")) read_locked(*locked, def.locked);
  members.read("mass", def.mass, Range::above(0));
  if (const auto center = members.find_value("center_of_mass")) def.center_of_mass = center->vec3();
  if (const auto inertia = members.find_value("inertia")) def.inertia = read_inertia(*inertia);
}

}  // namespace

void read_body(SceneReading& reading, const Field& field) {
  Members members(field, "a body");
  SceneBody body;
  const Field name = members.need("name");
  body.name = name.name(reading.options.limits.name_bytes);
  if (!reading.bodies.emplace(body.name, int(reading.scene.bodies.size())).second) {
    name.expected("a name that no other body has");
  }
  if (const auto type = members.find("type")) {
    body.def.type = type->choice<BodyType>(
        {{"static", BodyType::fixed}, {"kinematic", BodyType::kinematic}, {"dynamic", BodyType::dynamic}});
  }
  read_motion(members, body.def);
  if (const auto filter = members.find("filter")) read_filter(*filter, body.filter);
  members.read("sensor", body.sensor);
  members.read("color", body.color);
  if (const auto shapes = members.find("shapes")) {
    const std::size_t count = shapes->array("an array of shapes");
    for (std::size_t i = 0; i < count; ++i) read_shape(reading, shapes->element(i), body);
  }
  if (const auto forces = members.find("forces")) {
    const std::size_t count = forces->array("an array of forces");
    for (std::size_t i = 0; i < count; ++i) body.forces.push_back(read_force(forces->element(i)));
  }
  members.finish();
  reading.scene.bodies.push_back(std::move(body));
}

}  // namespace gyre
