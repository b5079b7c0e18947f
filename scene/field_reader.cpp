// Force fields and explosions of a scene. Members that mean nothing for a type are refused, so that none is passed over silently;
// null says nothing. See scene_parts.h.
#include "scene/scene_parts.h"

namespace gyre {
namespace {

// In the order of FieldKind.
enum class FieldType { wind, radial, vortex, drag, buoyancy, magnetic, magnetic_dipole, stokes, grid, explosion };

constexpr unsigned bit(FieldType type) { return 1u << unsigned(type); }
constexpr unsigned kMedia =
    bit(FieldType::wind) | bit(FieldType::vortex) | bit(FieldType::drag) | bit(FieldType::buoyancy);
constexpr unsigned kMagnetic = bit(FieldType::magnetic) | bit(FieldType::magnetic_dipole);
constexpr unsigned kPointed = bit(FieldType::radial) | bit(FieldType::vortex) | bit(FieldType::magnetic_dipole);
constexpr unsigned kCentered = kPointed | bit(FieldType::explosion);

// Which types have a member.
struct MemberTypes {
  const char* key;
  unsigned types;
  const char* why;
};
constexpr MemberTypes kMembers[] = {
    {"bounds", ~bit(FieldType::explosion), "an explosion has a radius"},
    {"velocity", kMedia | bit(FieldType::stokes), "only wind, vortex, drag, buoyancy and stokes are media"},
    {"density", kMedia, "only wind, vortex, drag and buoyancy are media"},
    {"drag_coefficient", kMedia, "only wind, vortex, drag and buoyancy are media"},
    {"linear_drag", kMedia, "only wind, vortex, drag and buoyancy are media"},
    {"turbulence", bit(FieldType::wind), "only wind has gusts"},
    {"turbulence_length", bit(FieldType::wind), "only wind has gusts"},
    {"center", kCentered, "only radial, vortex, magnetic_dipole and explosion have a center"},
    {"strength", kPointed | kMagnetic | bit(FieldType::stokes),
     "only radial, vortex, magnetic, magnetic_dipole and stokes have a strength"},
    {"radius", kCentered, "only radial, vortex, magnetic_dipole and explosion have a radius"},
    {"falloff", bit(FieldType::radial) | bit(FieldType::explosion), "only radial and explosion fall off"},
    {"core", bit(FieldType::radial) | bit(FieldType::magnetic_dipole), "only radial and magnetic_dipole have a core"},
    {"axis", bit(FieldType::vortex) | kMagnetic, "only vortex, magnetic and magnetic_dipole have an axis"},
    {"points", bit(FieldType::grid), "only a grid has points"},
    {"vectors", bit(FieldType::grid), "only a grid has vectors"},
    {"normal", bit(FieldType::buoyancy), "only buoyancy has a surface"},
    {"offset", bit(FieldType::buoyancy), "only buoyancy has a surface"},
    {"pressure", bit(FieldType::explosion), "only an explosion has this"},
    {"reference", bit(FieldType::explosion), "only an explosion has this"},
    {"occlusion", bit(FieldType::explosion), "only an explosion has this"},
    {"start", bit(FieldType::explosion), "only an explosion has this"},
};

void read_direction(Members& members, const char* key, Vec3& out) {
  const std::optional<Field> field = members.find_value(key);
  if (!field) return;
  out = field->vec3();
  if (out == Vec3{}) field->fail("found a zero vector, expected a direction");
}

void read_center(Members& members, DVec3& out) {
  if (const auto center = members.find_value("center")) out = center->place();
}

void read_layers(Members& members, std::uint32_t& out) {
  if (const auto layers = members.find_value("layers")) out = std::uint32_t(layers->integer(0, 4294967295));
}

void read_number(Members& members, const char* key, float& out, Range range) {
  if (const auto field = members.find_value(key)) out = field->real(range);
}

void read_grid(const Field& points, const Field& vectors, FieldDef& def) {
  points.array("the numbers of points along x, y and z", 3);
  std::size_t count = 1;
  for (std::size_t i = 0; i < 3; ++i) {
    def.points[i] = int(points.element(i).integer(2, 1024));
    count *= std::size_t(def.points[i]);
  }
  const std::size_t given = vectors.array("an array of vectors");
  if (given != count) vectors.expected(std::to_string(count) + " vectors, one for each point");
  for (std::size_t i = 0; i < count; ++i) def.vectors.push_back(vectors.element(i).vec3(Range::between(-1.0e9, 1.0e9)));
}

void read_field_members(Members& members, FieldDef& def) {
  if (const auto bounds = members.find_value("bounds")) def.bounds = read_bounds(*bounds);
  if (const auto velocity = members.find_value("velocity"))
    def.velocity = velocity->vec3(Range::between(-1.0e6, 1.0e6));
  members.read("density", def.density, Range::between(0, kMaxDensity));
  read_number(members, "drag_coefficient", def.drag_coefficient, Range::between(0, kMaxSurface));
  read_number(members, "linear_drag", def.linear_drag, Range::between(0, kMaxSurface));
  read_number(members, "turbulence", def.turbulence, Range::between(0, 1000));
  read_number(members, "turbulence_length", def.turbulence_length, Range::between(1.0e-6, 1.0e9));
  read_center(members, def.center);
  read_number(members, "strength", def.strength, Range::between(-1.0e9, 1.0e9));
  read_number(members, "radius", def.radius, Range::between(1.0e-6, 1.0e9));
  read_number(members, "falloff", def.falloff, Range::between(-4, 4));
  read_number(members, "core", def.core, Range::between(0, 1.0e9));
  read_direction(members, "axis", def.axis);
  read_direction(members, "normal", def.normal);
  if (const auto points = members.find("points")) read_grid(*points, members.need("vectors"), def);
  if (const auto offset = members.find_value("offset"))
    def.offset = offset->number(Range::between(-kFarthest, kFarthest));
}

void read_explosion_members(Members& members, SceneExplosion& explosion) {
  ExplosionDef& def = explosion.def;
  read_center(members, def.center);
  read_number(members, "pressure", def.pressure, Range::between(-1.0e20, 1.0e20));
  read_number(members, "reference", def.reference, Range::between(1.0e-6, 1.0e9));
  read_number(members, "falloff", def.falloff, Range::between(0, 4));
  read_number(members, "radius", def.radius, Range::between(0, 1.0e9));
  if (const auto occlusion = members.find_value("occlusion")) def.occlusion = occlusion->boolean();
  if (const auto start = members.find_value("start")) explosion.start = start->number();
}

}  // namespace

FieldBounds read_bounds(const Field& field) {
  field.array("an array of 2 corners [low, high]", 2);
  const FieldBounds bounds{field.element(0).place(), field.element(1).place()};
  if (!(bounds.low.x <= bounds.high.x && bounds.low.y <= bounds.high.y && bounds.low.z <= bounds.high.z)) {
    field.fail("found a lower corner above the upper one, expected [low, high]");
  }
  return bounds;
}

void read_field(SceneReading& reading, const Field& field) {
  Members members(field, "a force field");
  const FieldType type = members.need("type").choice<FieldType>({{"wind", FieldType::wind},
                                                                 {"radial", FieldType::radial},
                                                                 {"vortex", FieldType::vortex},
                                                                 {"drag", FieldType::drag},
                                                                 {"buoyancy", FieldType::buoyancy},
                                                                 {"magnetic", FieldType::magnetic},
                                                                 {"magnetic_dipole", FieldType::magnetic_dipole},
                                                                 {"stokes", FieldType::stokes},
                                                                 {"grid", FieldType::grid},
                                                                 {"explosion", FieldType::explosion}});
  for (const MemberTypes& member : kMembers) {
    if ((member.types & bit(type)) == 0) members.refuse(member.key, member.why);
  }
  if (type == FieldType::explosion) {
    SceneExplosion explosion;
    read_explosion_members(members, explosion);
    read_layers(members, explosion.def.layers);
    members.finish();
    reading.scene.explosions.push_back(explosion);
    return;
  }
  FieldDef def;
  def.kind = FieldKind(type);
  if (type == FieldType::grid) members.need("points"), members.need("bounds");
  read_field_members(members, def);
  read_layers(members, def.layers);
  members.finish();
  reading.scene.fields.push_back(def);
}

}  // namespace gyre
