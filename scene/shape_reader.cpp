// Shapes of a body. See scene_parts.h.
#include "scene/scene_parts.h"

#include <limits>

namespace gyre {
namespace {

enum class ShapeWord {
  sphere,
  box,
  capsule,
  cylinder,
  cone,
  convex_hull,
  mesh,
  height_field,
  plane,
  convex_decomposition
};

void need_unmoving(const Field& field, const SceneBody& body, const char* what) {
  if (body.def.type != BodyType::dynamic) return;
  field.fail(std::string("found ") + what + " on a dynamic body, expected on a static or kinematic one");
}

Box read_box(Members& members) {
  Box box;
  const Field half_extents = members.need("half_extents");
  half_extents.array("an array of 3 numbers above 0", 3);
  box.half_extents = {half_extents.element(0).real(Range::above(0)),
                      half_extents.element(1).real(Range::above(0)),
                      half_extents.element(2).real(Range::above(0))};
  members.read("rounding", box.rounding, Range::between(0, double(smallest(box.half_extents))));
  return box;
}

SceneHull read_hull(const SceneReading& reading, Members& members) {
  SceneHull hull;
  if (const auto mesh = members.find_value("mesh")) {
    members.refuse("points", "a convex hull is given by \"points\" or by \"mesh\", not both");
    hull.mesh = find_name(reading.meshes, *mesh, "a mesh");
    return hull;
  }
  const Field points = members.need("points");
  const std::size_t count = points.array("an array of points");
  if (count < 4) points.expected("at least 4 points");
  if (count > reading.options.limits.vertices) {
    points.expected("at most " + std::to_string(reading.options.limits.vertices) + " points");
  }
  hull.points.reserve(count);
  for (std::size_t i = 0; i < count; ++i) hull.points.push_back(points.element(i).vec3());
  return hull;
}

SceneHeightField read_height_field(Members& members) {
  constexpr std::int64_t kMostSamples = 65536;  // a side
  SceneHeightField out;
  const Field size = members.need("size");
  size.array("an array of 2 integers: samples along x and along z", 2);
  out.columns = std::uint32_t(size.element(0).integer(2, kMostSamples));
  out.rows = std::uint32_t(size.element(1).integer(2, kMostSamples));
  members.read("spacing", out.spacing, Range::above(0));
  const Field heights = members.need("heights");
  const std::size_t count = std::size_t(out.columns) * out.rows;
  heights.array((std::to_string(count) + " numbers (" + std::to_string(out.columns) + " times " +
                 std::to_string(out.rows) + ")")
                    .c_str(),
                std::int64_t(count));
  out.heights.reserve(count);
  for (std::size_t i = 0; i < count; ++i) {
    const Field height = heights.element(i);
    out.heights.push_back(height.is_null() ? std::numeric_limits<float>::quiet_NaN() : height.real());
  }
  return out;
}

SceneDecomposition read_decomposition(const SceneReading& reading, Members& members) {
  SceneDecomposition out;
  out.mesh = find_name(reading.meshes, members.need("mesh"), "a mesh");
  if (const auto most = members.find_value("max_hulls")) out.max_hulls = int(most->integer(1, 1024));
  members.read("concavity", out.concavity, Range::between(0.001, 1));
  if (const auto most = members.find_value("max_hull_vertices"))
    out.max_hull_vertices = int(most->integer(8, 255));
  if (const auto meaning = members.find_value("meaning")) {
    out.meaning = meaning->choice<SurfaceMeaning>({{"automatic", SurfaceMeaning::automatic},
                                                   {"solid", SurfaceMeaning::solid},
                                                   {"shell", SurfaceMeaning::shell}});
  }
  members.read("shell_thickness", out.shell_thickness, Range::at_least(0));
  return out;
}

Plane read_plane(Members& members) {
  Plane plane;
  if (const auto normal = members.find("normal")) {
    plane.normal = normal->vec3();
    if (plane.normal == Vec3{}) normal->fail("found a zero vector, expected a direction");
  }
  members.read("offset", plane.offset);
  return plane;
}

const char* words_for(ShapeWord word) {
  switch (word) {
    case ShapeWord::sphere:
      return "a sphere";
    case ShapeWord::box:
      return "a box";
    case ShapeWord::capsule:
      return "a capsule";
    case ShapeWord::cylinder:
      return "a cylinder";
    case ShapeWord::cone:
      return "a cone";
    case ShapeWord::convex_hull:
      return "a convex hull";
    case ShapeWord::mesh:
      return "a mesh";
    case ShapeWord::height_field:
      return "a height field";
    case ShapeWord::plane:
      return "a plane";
    case ShapeWord::convex_decomposition:
      return "a convex decomposition";
  }
  return "a shape";
}

SceneGeometry read_geometry(const SceneReading& reading, Members& members, ShapeWord word) {
  const auto length = [&](const char* key, Range range) { return members.need(key).real(range); };
  switch (word) {
    case ShapeWord::sphere:
      return Sphere{length("radius", Range::above(0))};
    case ShapeWord::box:
      return read_box(members);
    case ShapeWord::capsule:
      return Capsule{length("radius", Range::above(0)), length("half_height", Range::at_least(0))};
    case ShapeWord::cylinder:
      return Cylinder{length("radius", Range::above(0)), length("half_height", Range::above(0))};
    case ShapeWord::cone:
      return Cone{length("radius", Range::above(0)), length("half_height", Range::above(0))};
    case ShapeWord::convex_hull:
      return read_hull(reading, members);
    case ShapeWord::mesh:
      return SceneTriangles{find_name(reading.meshes, members.need("mesh"), "a mesh")};
    case ShapeWord::height_field:
      return read_height_field(members);
    case ShapeWord::plane:
      return read_plane(members);
    case ShapeWord::convex_decomposition:
      return read_decomposition(reading, members);
  }
  return Sphere{};
}

}  // namespace

void read_shape(SceneReading& reading, const Field& field, SceneBody& body) {
  if (++reading.shape_count > reading.options.limits.shapes) {
    field.fail("found more than " + std::to_string(reading.options.limits.shapes) + " shapes");
  }
  // Twice: the type decides what the other members mean and what the shape is called in errors.
  Members any_shape(field, "a shape");
  const Field type = any_shape.need("type");
  const ShapeWord word = type.choice<ShapeWord>({{"sphere", ShapeWord::sphere},
                                                 {"box", ShapeWord::box},
                                                 {"capsule", ShapeWord::capsule},
                                                 {"cylinder", ShapeWord::cylinder},
                                                 {"cone", ShapeWord::cone},
                                                 {"convex_hull", ShapeWord::convex_hull},
                                                 {"mesh", ShapeWord::mesh},
                                                 {"convex_decomposition", ShapeWord::convex_decomposition},
                                                 {"height_field", ShapeWord::height_field},
                                                 {"plane", ShapeWord::plane}});
  const bool unmoving =
      word == ShapeWord::mesh || word == ShapeWord::height_field || word == ShapeWord::plane;
  if (unmoving) need_unmoving(type, body, words_for(word));

  Members members(field, words_for(word));
  members.find("type");
  SceneShape shape;
  shape.geometry = read_geometry(reading, members, word);
  members.read("position", shape.local.position);
  members.read("orientation", shape.local.orientation);
  if (const auto material = members.find_value("material")) {
    shape.material = find_name(reading.materials, *material, "a material");
  }
  members.read("color", shape.color);
  const SurfaceFields given = read_surface(members);
  shape.density = given.density;
  shape.static_friction = given.static_friction;
  shape.dynamic_friction = given.dynamic_friction;
  shape.restitution = given.restitution;
  shape.rolling_friction = given.rolling_friction;
  shape.spinning_friction = given.spinning_friction;
  members.finish();
  body.shapes.push_back(std::move(shape));
}

}  // namespace gyre
