// Ropes, cloths and soft bodies of a scene. See scene_parts.h and, for the format, scene_schema_soft.h.
#include "scene/scene_parts.h"

#include <cmath>

namespace gyre {
namespace {

constexpr std::int64_t kMostVertices = 1 << 20;  // of one of them
constexpr int kUnknown = -1;                     // how many vertices there are; the world checks then
constexpr double kMostStiffness = 1.0e12;
constexpr Range kNotNegative = Range::between(0, kMostStiffness);
constexpr Range kPositive = Range::above_to(0, kMostStiffness);

// An integer of at least 1; the refusal of a larger one says how many of `what` are possible.
int read_count(const Field& field, std::int64_t most, const char* what) {
  const bool is_large = field.json().is_number() && field.json().get<double>() > double(most);
  if (is_large) field.expected("at most " + std::to_string(most) + " " + what);
  return int(field.integer(1, most));
}

// Takes vertices from what one entry and the scene may have.
void take_vertices(SceneReading& reading, const Field& field, double count) {
  const std::string found = "found " + std::to_string(std::int64_t(count)) + " vertices, expected at most ";
  if (count > double(kMostVertices)) field.fail(found + std::to_string(kMostVertices));
  const std::size_t most = reading.options.limits.soft_vertices;
  reading.soft_vertices += std::size_t(count);
  if (reading.soft_vertices > most)
    field.fail("found " + std::to_string(reading.soft_vertices) +
               " vertices of ropes, cloths and soft bodies up to here, expected at most " +
               std::to_string(most));
}

// ------------------------------------------------------------------------------------------------- what all three have

void read_start(SceneReading& reading, Members& members, SceneSoft& soft) {
  soft.name = read_unique_name(reading, members.need("name"));
  members.read("color", soft.color);
}

void read_state(const Field& field, int vertices, SoftSettings& out) {
  Members members(field, "a state of positions and velocities");
  const std::string count = vertices == kUnknown ? "" : std::to_string(vertices) + " ";
  if (const auto positions = members.find_value("positions")) {
    const std::string expected = "an array of " + count + "positions, one for each vertex";
    const std::size_t given = positions->array(expected.c_str(), vertices);
    out.positions.reserve(given);
    for (std::size_t i = 0; i < given; ++i) out.positions.push_back(positions->element(i).place());
  }
  if (const auto velocities = members.find_value("velocities")) {
    const std::string expected = "an array of " + count + "velocities, one for each vertex";
    const std::size_t given = velocities->array(expected.c_str(), vertices);
    out.velocities.reserve(given);
    for (std::size_t i = 0; i < given; ++i) out.velocities.push_back(velocities->element(i).vec3());
  }
  members.finish();
}

void read_settings(Members& members, int vertices, SoftSettings& out) {
  if (const auto integrator = members.find("integrator")) {
    out.integrator =
        integrator->choice<SoftIntegrator>({{"implicit", SoftIntegrator::implicit},
                                            {"explicit_euler", SoftIntegrator::explicit_euler},
                                            {"semi_implicit_euler", SoftIntegrator::semi_implicit_euler},
                                            {"rk4", SoftIntegrator::rk4},
                                            {"verlet", SoftIntegrator::verlet},
                                            {"sdirk2", SoftIntegrator::sdirk2},
                                            {"visual", SoftIntegrator::visual}});
  }
  members.read("damping", out.damping, Range::between(0, kMaxSurface));
  members.read("static_friction", out.static_friction, Range::between(0, kMaxSurface));
  std::optional<float> dynamic;
  members.read("dynamic_friction", dynamic, Range::between(0, kMaxSurface));
  out.dynamic_friction = dynamic.value_or(out.static_friction);
  if (const auto state = members.find_value("state")) read_state(*state, vertices, out);
}

// A body by name; -1 for the world.
int read_holder(SceneReading& reading, const Field& field) {
  const bool is_body = reading.bodies.contains(field.text());
  if (field.text() != "world") return find_name(reading.bodies, field, "a body");
  if (is_body)
    field.fail("\"world\" is both the fixed world and a body here; expected another name for the body");
  return -1;
}

void add_hold(SceneSoft& soft, const std::vector<bool>& held, const Field& field, SceneHold hold) {
  if (held[std::size_t(hold.vertex)])
    field.fail("found vertex " + std::to_string(hold.vertex) + " a second time, expected to hold it once");
  soft.holds.push_back(hold);
}

void read_pinned(const Field& field, int vertices, std::vector<bool>& held, SceneSoft& soft) {
  const std::size_t count = field.array("an array of vertex numbers");
  for (std::size_t i = 0; i < count; ++i) {
    const Field element = field.element(i);
    const int vertex = int(element.integer(0, vertices - 1));
    add_hold(soft, held, element, {vertex, -1});
    held[std::size_t(vertex)] = true;
  }
}

// Between vertices are no points of a rope, and none of what is visual.
void read_pinned_to(SceneReading& reading, const Field& field, int vertices, std::vector<bool>& held,
                    bool has_points, SceneSoft& soft) {
  const std::size_t count = field.array("an array of vertices or points and the bodies that hold them");
  for (std::size_t i = 0; i < count; ++i) {
    const Field element = field.element(i);
    Members members(element, "a vertex or a point, and the body that holds it");
    const auto point = members.find_value("point");
    if (point && !has_points)
      point->fail("found a point, expected \"vertex\": ropes and what has the integrator visual are held at vertices");
    if (point) {
      soft.points.push_back({point->place(), read_holder(reading, members.need("body"))});
      if (const auto vertex = members.find_value("vertex"))
        vertex->fail("found this beside \"point\", expected one of the two");
      members.finish();
      continue;
    }
    const Field number = members.need("vertex");
    const int vertex = int(number.integer(0, vertices - 1));
    add_hold(soft, held, number, {vertex, read_holder(reading, members.need("body"))});
    held[std::size_t(vertex)] = true;
    members.finish();
  }
}

// The ends of a rope.
void read_attach(SceneReading& reading, const Field& field, int vertices, std::vector<bool>& held,
                 SceneSoft& soft) {
  const std::size_t count = field.array("an array of ends and the bodies that they are attached to");
  for (std::size_t i = 0; i < count; ++i) {
    const Field element = field.element(i);
    Members members(element, "an end and the body that it is attached to");
    const Field end = members.need("end");
    const int vertex = end.integer(0, 1) == 0 ? 0 : vertices - 1;
    add_hold(soft, held, end, {vertex, read_holder(reading, members.need("body"))});
    held[std::size_t(vertex)] = true;
    members.finish();
  }
}

std::vector<bool> read_holds(SceneReading& reading, Members& members, int vertices, bool has_points,
                             SceneSoft& soft) {
  if (vertices == kUnknown) vertices = int(kMostVertices);
  std::vector<bool> held(std::size_t(vertices), false);
  if (const auto pinned = members.find_value("pinned")) read_pinned(*pinned, vertices, held, soft);
  if (const auto pinned = members.find_value("pinned_to"))
    read_pinned_to(reading, *pinned, vertices, held, has_points, soft);
  return held;
}

void read_pose(Members& members, Pose& out) {
  if (const auto position = members.find("position")) out.position = position->place();
  members.read("orientation", out.orientation);
}

// ------------------------------------------------------------------------------------------------------------- cloths

ClothGrid read_grid(SceneReading& reading, const Field& field) {
  Members members(field, "a grid");
  ClothGrid grid;
  const Field size = members.need("size"), cells = members.need("cells");
  size.array("an array of 2 lengths", 2);
  cells.array("an array of 2 numbers of cells", 2);
  double vertices = 1;
  for (std::size_t axis = 0; axis < 2; ++axis) {
    grid.size[axis] = size.element(axis).real(kPositive);
    grid.cells[axis] = read_count(cells.element(axis), 4096, "cells along a side");
    vertices *= grid.cells[axis] + 1;
  }
  members.finish();
  take_vertices(reading, cells, vertices);
  return grid;
}

void read_gas(Members& members, ClothDef& cloth) {
  members.read("pressure", cloth.pressure, Range::between(-kMostStiffness, kMostStiffness));
  members.read("ambient_pressure", cloth.ambient_pressure, kNotNegative);
  if (const auto law = members.find("pressure_law")) {
    cloth.pressure_law =
        law->choice<PressureLaw>({{"ideal_gas", PressureLaw::ideal_gas}, {"constant", PressureLaw::constant}});
  }
}

// ------------------------------------------------------------------------------------------------------- soft bodies

SolidBox read_box(SceneReading& reading, const Field& field) {
  Members members(field, "a box of cells");
  SolidBox box;
  box.half_extents = members.need("half_extents").vec3(kPositive);
  const Field cells = members.need("cells");
  cells.array("an array of 3 numbers of cells", 3);
  double vertices = 1;
  for (std::size_t axis = 0; axis < 3; ++axis) {
    box.cells[axis] = read_count(cells.element(axis), 256, "cells along a side");
    vertices *= box.cells[axis] + 1;
  }
  members.finish();
  take_vertices(reading, cells, vertices);
  return box;
}

// As the engine sees it: in double precision, against the longest of three edges.
bool has_volume(const std::vector<Vec3>& vertices, const std::uint32_t* corners) {
  const DVec3 a(vertices[corners[0]]);
  const DVec3 b = DVec3(vertices[corners[1]]) - a, c = DVec3(vertices[corners[2]]) - a,
              d = DVec3(vertices[corners[3]]) - a;
  const double longest = max(length(b), max(length(c), length(d)));
  return std::abs(dot(b, cross(c, d))) > 1.0e-7 * longest * longest * longest;
}

void read_tetrahedra(SceneReading& reading, const Field& vertices, const Field& tetrahedra, SolidDef& out) {
  const std::size_t count = vertices.array("an array of points");
  if (count < 4) vertices.expected("at least 4 points");
  take_vertices(reading, vertices, double(count));
  out.vertices.reserve(count);
  for (std::size_t i = 0; i < count; ++i) out.vertices.push_back(vertices.element(i).vec3());
  const std::size_t elements = tetrahedra.array("an array of tetrahedra");
  if (elements < 1) tetrahedra.expected("at least 1 tetrahedron");
  constexpr std::size_t kMost = std::size_t(8) << 20;
  if (elements > kMost) tetrahedra.expected("at most " + std::to_string(kMost) + " tetrahedra");
  out.tetrahedra.reserve(4 * elements);
  for (std::size_t i = 0; i < elements; ++i) {
    const Field corners = tetrahedra.element(i);
    corners.array("an array of 4 vertex numbers", 4);
    for (std::size_t k = 0; k < 4; ++k)
      out.tetrahedra.push_back(std::uint32_t(corners.element(k).integer(0, std::int64_t(count) - 1)));
    if (!has_volume(out.vertices, &out.tetrahedra[4 * i]))
      corners.fail("found a tetrahedron of no volume, expected four corners that do not lie in one plane");
  }
}

void read_material_of_solid(Members& members, SolidDef& out) {
  if (const auto model = members.find("model")) {
    out.model = model->choice<SolidModel>({{"linear", SolidModel::linear},
                                           {"corotated", SolidModel::corotated},
                                           {"neo_hookean", SolidModel::neo_hookean}});
  }
  members.read("density", out.density, kPositive);
  members.read("young_modulus", out.young_modulus, kPositive);
  if (const auto ratio = members.find("poisson_ratio")) {
    out.poisson_ratio = ratio->real();
    if (!(out.poisson_ratio > -1.0f && out.poisson_ratio < 0.5f))
      ratio->expected("a number above -1 and below 0.5");
  }
  members.read("fracture_stress", out.fracture_stress, kNotNegative);
  members.read("yield_stress", out.yield_stress, kNotNegative);
  members.read("creep_time", out.creep_time, kNotNegative);
}

// A surface to be filled; how many vertices that takes shows when it is done.
void read_surface_mesh(SceneReading& reading, const Field& mesh, const std::optional<Field>& resolution,
                       SceneSoftBody& out) {
  out.mesh = find_name(reading.meshes, mesh, "a mesh");
  if (resolution) {
    out.resolution = read_count(*resolution, 128, "cells along the longest side");
    if (out.resolution < 2) resolution->expected("an integer from 2 to 128");
  }
  const double cells = double(out.resolution) * out.resolution * out.resolution;
  take_vertices(reading, mesh, min(cells, double(kMostVertices)));
}

// The mesh, the box, or vertices and tetrahedra. Returns how many vertices there are; kUnknown of a mesh.
int read_solid(SceneReading& reading, const Field& field, Members& members, SceneSoftBody& body) {
  SolidDef& out = body.def;
  const auto mesh = members.find_value("mesh");
  const auto resolution = members.find_value("resolution");
  const auto box = members.find_value("box");
  const auto vertices = members.find_value("vertices"), tetrahedra = members.find_value("tetrahedra");
  const char* const kOne =
      "a soft body is given by \"mesh\", by \"box\", or by \"vertices\" and \"tetrahedra\"";
  if (resolution && !mesh) resolution->fail("only a soft body of a \"mesh\" has a resolution");
  if (mesh || box) {
    for (const auto* other : {&box, &vertices, &tetrahedra}) {
      const bool is_itself = other == &box && !mesh;
      if (*other && !is_itself)
        (*other)->fail(std::string("found this beside \"") + (mesh ? "mesh" : "box") + "\"; " + kOne);
    }
  }
  if (mesh) {
    read_surface_mesh(reading, *mesh, resolution, body);
    return kUnknown;
  }
  if (box) {
    out.box = read_box(reading, *box);
    const std::array<int, 3>& cells = out.box->cells;
    return (cells[0] + 1) * (cells[1] + 1) * (cells[2] + 1);
  }
  if (!vertices && !tetrahedra) field.fail(std::string("found none of its shapes, expected one: ") + kOne);
  read_tetrahedra(reading, members.need("vertices"), members.need("tetrahedra"), out);
  return int(out.vertices.size());
}

}  // namespace

std::string read_unique_name(SceneReading& reading, const Field& field) {
  std::string name = field.name(reading.options.limits.name_bytes);
  if (reading.bodies.contains(name) || !reading.matter.emplace(name, 0).second)
    field.expected("a name that no body, rope, cloth, soft body, gas or liquid of this scene has");
  return name;
}

void read_rope(SceneReading& reading, const Field& field) {
  Members members(field, "a rope");
  SceneRope rope;
  read_start(reading, members, rope);
  const Field points = members.need("points");
  const std::size_t count = points.array("an array of points");
  if (count < 2) points.expected("at least 2 points");
  double whole = 0;
  for (std::size_t i = 0; i < count; ++i) {
    rope.def.points.push_back(points.element(i).place());
    if (i > 0) whole += length(rope.def.points[i] - rope.def.points[i - 1]);
  }
  if (!(whole > 0)) points.fail("found points in one place, expected a rope with a length");
  if (const auto segments = members.find_value("segments"))
    rope.def.segments = read_count(*segments, kMostVertices - 1, "segments");
  const int vertices = rope.def.segments > 0 ? rope.def.segments + 1 : int(count);
  take_vertices(reading, points, vertices);
  if (const auto links = members.find("links"))
    rope.def.links = links->choice<RopeLinks>({{"springs", RopeLinks::springs}, {"rods", RopeLinks::rods}});
  members.read("radius", rope.def.radius, kNotNegative);
  members.read("linear_density", rope.def.linear_density, kPositive);
  members.read("stretch_stiffness", rope.def.stretch_stiffness,
               rope.def.links == RopeLinks::springs ? kPositive : kNotNegative);
  members.read("bend_stiffness", rope.def.bend_stiffness, kNotNegative);
  read_settings(members, vertices, rope.def.settings);
  std::vector<bool> held = read_holds(reading, members, vertices, false, rope);
  if (const auto attach = members.find_value("attach")) read_attach(reading, *attach, vertices, held, rope);
  members.finish();
  reading.scene.ropes.push_back(std::move(rope));
}

void read_cloth(SceneReading& reading, const Field& field) {
  Members members(field, "a cloth");
  SceneCloth cloth;
  read_start(reading, members, cloth);
  const auto mesh = members.find_value("mesh"), grid = members.find_value("grid");
  int vertices = 0;
  if (mesh && grid) grid->fail("found this beside \"mesh\", expected one of the two");
  if (grid) {
    cloth.def.grid = read_grid(reading, *grid);
    vertices = (cloth.def.grid->cells[0] + 1) * (cloth.def.grid->cells[1] + 1);
  } else if (mesh) {
    cloth.mesh = find_name(reading.meshes, *mesh, "a mesh");
    const std::size_t count = reading.scene.meshes[std::size_t(cloth.mesh)].vertices.size();
    take_vertices(reading, *mesh, double(count));
    vertices = int(count);
  } else {
    field.fail("found neither \"mesh\" nor \"grid\", expected one of the two");
  }
  read_pose(members, cloth.def.pose);
  if (const auto links = members.find("links"))
    cloth.def.links = links->choice<ClothLinks>(
        {{"springs", ClothLinks::springs}, {"rods", ClothLinks::rods}, {"membrane", ClothLinks::membrane}});
  members.read("tear_strain", cloth.def.tear_strain, kNotNegative);
  // A grid that may tear is made of triangles.
  const bool is_membrane_of_mesh =
      (cloth.mesh >= 0 || cloth.def.tear_strain > 0.0f) && cloth.def.links == ClothLinks::membrane;
  members.read("area_density", cloth.def.area_density, kPositive);
  members.read("stretch_stiffness", cloth.def.stretch_stiffness,
               cloth.def.links == ClothLinks::rods ? kNotNegative : kPositive);
  // Without lateral contraction, as along the lines of a grid, where nothing is said: the default of a grid may be none of a material.
  if (is_membrane_of_mesh) cloth.def.shear_stiffness = 0.5f * cloth.def.stretch_stiffness;
  members.read("shear_stiffness", cloth.def.shear_stiffness, is_membrane_of_mesh ? kPositive : kNotNegative);
  members.read("bend_stiffness", cloth.def.bend_stiffness, kNotNegative);
  members.read("thickness", cloth.def.thickness, kNotNegative);
  members.read("self_collision", cloth.def.self_collision);
  read_gas(members, cloth.def);
  read_settings(members, vertices, cloth.def.settings);
  read_holds(reading, members, vertices, cloth.def.settings.integrator != SoftIntegrator::visual, cloth);
  members.finish();
  reading.scene.cloths.push_back(std::move(cloth));
}

void read_soft_body(SceneReading& reading, const Field& field) {
  Members members(field, "a soft body");
  SceneSoftBody solid;
  read_start(reading, members, solid);
  const int vertices = read_solid(reading, field, members, solid);
  read_pose(members, solid.def.pose);
  read_material_of_solid(members, solid.def);
  read_settings(members, vertices, solid.def.settings);
  read_holds(reading, members, vertices, solid.def.settings.integrator != SoftIntegrator::visual, solid);
  if (const auto region = members.find_value("pinned_region")) {
    Members parts(*region, "a region, {\"box\": [low, high]}");
    solid.pinned_region = read_bounds(parts.need("box"));
    parts.finish();
  }
  members.finish();
  reading.scene.soft_bodies.push_back(std::move(solid));
}

}  // namespace gyre
