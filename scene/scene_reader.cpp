// The scene as a whole: version, world, materials, meshes, bodies, joints, then soft matter, fluids and fields. See scene_reader.h and, for the format,
// scene_schema.cpp.
#include "scene/scene_reader.h"

#include "scene/mesh_file.h"
#include "scene/scene_parts.h"

#include <algorithm>
#include <filesystem>
#include <new>
#include <set>

namespace gyre {

int find_name(const NameTable& table, const Field& field, const char* what) {
  const auto at = table.find(field.text());
  if (at == table.end()) field.expected("the name of " + std::string(what) + " of this scene");
  return at->second;
}

SurfaceFields read_surface(Members& members) {
  SurfaceFields out;
  members.read("density", out.density, Range::between(0, kMaxDensity));
  members.read("static_friction", out.static_friction, Range::between(0, kMaxSurface));
  members.read("dynamic_friction", out.dynamic_friction, Range::between(0, kMaxSurface));
  members.read("restitution", out.restitution, Range::between(0, 1));
  members.read("rolling_friction", out.rolling_friction, Range::between(0, kMaxSurface));
  members.read("spinning_friction", out.spinning_friction, Range::between(0, kMaxSurface));
  return out;
}

namespace {

void read_version(const Field& field) {
  if (!field.json().is_number_integer() || field.json() != 1)
    field.expected("1, the format version of this Gyre");
}

void read_world(const Field& field, SceneWorld& world) {
  Members members(field, "a world");
  if (const auto gravity = members.find("gravity")) {
    world.gravity = gravity->vec3(Range::between(-5.0e8, 5.0e8));
  }
  members.read("time_step", world.time_step, Range::above_to(0, 1));
  if (float(world.time_step) == 0.0f) members.need("time_step").expected("a number of at least 1e-45");
  if (const auto substeps = members.find("substeps")) world.substeps = int(substeps->integer(1, 64));
  if (const auto integrator = members.find("integrator")) {
    world.integrator =
        integrator->choice<IntegratorKind>({{"explicit_euler", IntegratorKind::explicit_euler},
                                            {"semi_implicit_euler", IntegratorKind::semi_implicit_euler},
                                            {"rk4", IntegratorKind::rk4},
                                            {"verlet", IntegratorKind::verlet}});
  }
  if (const auto solver = members.find("solver")) {
    world.solver = solver->choice<SolverKind>({{"soft_step", SolverKind::soft_step},
                                               {"sequential_impulses", SolverKind::sequential_impulses},
                                               {"lcp", SolverKind::lcp}});
  }
  if (const auto method = members.find("lcp_method")) {
    world.solver_options.lcp_method = method->choice<LcpMethod>({{"automatic", LcpMethod::automatic},
                                                  {"dantzig", LcpMethod::dantzig},
                                                  {"lemke", LcpMethod::lemke},
                                                  {"newton", LcpMethod::newton},
                                                  {"nncg", LcpMethod::nncg}});
  }
  if (const auto sides = members.find("friction_sides")) {
    world.solver_options.friction_sides = int(sides->integer(0, 32));
    if (world.solver_options.friction_sides % 2 != 0 || world.solver_options.friction_sides == 2) sides->expected("0 or an even number of 4 to 32");
  }
  if (const auto iterations = members.find("iterations")) world.solver_options.iterations = int(iterations->integer(0, 10000));
  if (const auto rows = members.find("direct_rows")) world.solver_options.direct_rows = int(rows->integer(0, 600));
  if (const auto broad_phase = members.find("broad_phase")) {
    world.broad_phase =
        broad_phase->choice<BroadPhaseKind>({{"bvh", BroadPhaseKind::bvh},
                                             {"grid", BroadPhaseKind::grid},
                                             {"octree", BroadPhaseKind::octree},
                                             {"quadtree", BroadPhaseKind::quadtree},
                                             {"kd_tree", BroadPhaseKind::kd_tree},
                                             {"bsp_tree", BroadPhaseKind::bsp_tree},
                                             {"sweep_and_prune", BroadPhaseKind::sweep_and_prune},
                                             {"brute_force", BroadPhaseKind::brute_force}});
  }
  if (const auto springs = members.find("springs")) {
    world.springs = springs->choice<SpringKind>(
        {{"implicit", SpringKind::implicit}, {"explicit", SpringKind::explicit_force}});
  }
  if (const auto stepping = members.find("stepping")) {
    world.stepping = stepping->choice<TimeStepping>({{"fixed", TimeStepping::fixed},
                                                     {"adaptive", TimeStepping::adaptive},
                                                     {"error_controlled", TimeStepping::error_controlled}});
  }
  members.read("tolerance", world.tolerance, Range::between(1.0e-9, 1));
  if (const auto impacts = members.find("max_impacts")) world.max_impacts = int(impacts->integer(1, 4096));
  members.read("sleeping", world.sleeping);
  members.read("sleep_share", world.sleep_share, Range::between(0, 1000));
  members.finish();
}

SceneView read_view(const Field& field) {
  Members members(field, "a view");
  SceneView view;
  view.eye = members.need("eye").place();
  const Field target = members.need("target");
  view.target = target.place();
  if (view.eye == view.target) target.fail("found the place of the eye, expected another one");
  members.read("field_of_view", view.field_of_view, Range::between(0.01, 3));
  members.finish();
  return view;
}

// Calls read(name, field) for each member of an object of named things.
template <class Read>
void for_each_named(const SceneReading& reading, const Field& field, const char* what, Read read) {
  if (!field.json().is_object()) field.expected(what);
  for (auto member = field.json().begin(); member != field.json().end(); ++member) {
    const std::string& name = member.key();
    const Field value(*member, field, name);
    // The rules for a name are checked on the key as if it stood there as a value.
    const Json key(name);
    Field(key, field, name).name(reading.options.limits.name_bytes);
    read(name, value);
  }
}

// One friction alone stands for both.
void complete_friction(const SurfaceFields& given, Material& surface) {
  if (given.static_friction) surface.static_friction = surface.dynamic_friction = *given.static_friction;
  if (given.dynamic_friction) surface.dynamic_friction = *given.dynamic_friction;
  if (!given.static_friction && given.dynamic_friction) surface.static_friction = *given.dynamic_friction;
}

void read_material(SceneReading& reading, const std::string& name, const Field& field) {
  constexpr std::size_t kMaxMaterials = 65534;  // Material::id is 16 bits wide
  if (reading.scene.materials.size() >= kMaxMaterials) field.fail("found more than 65534 materials");
  Members members(field, "a material");
  SceneMaterial material;
  material.name = name;
  const SurfaceFields given = read_surface(members);
  members.read("color", material.color);
  members.read("surface_velocity", material.surface_velocity);
  members.read("one_way", material.one_way);
  members.finish();
  if (given.density) material.density = *given.density;
  complete_friction(given, material.surface);
  if (given.restitution) material.surface.restitution = *given.restitution;
  if (given.rolling_friction) material.surface.rolling_friction = *given.rolling_friction;
  if (given.spinning_friction) material.surface.spinning_friction = *given.spinning_friction;
  reading.materials.emplace(name, int(reading.scene.materials.size()));
  reading.scene.materials.push_back(std::move(material));
}

void read_material_pairs(SceneReading& reading, const Field& field) {
  const std::size_t count = field.array("an array of material pairs");
  std::set<std::pair<int, int>> seen;
  for (std::size_t i = 0; i < count; ++i) {
    const Field element = field.element(i);
    Members members(element, "a material pair");
    SceneMaterialPair pair;
    const Field names = members.need("materials");
    names.array("the names of 2 materials", 2);
    pair.a = find_name(reading.materials, names.element(0), "a material");
    pair.b = find_name(reading.materials, names.element(1), "a material");
    members.read("static_friction", pair.static_friction, Range::between(0, kMaxSurface));
    members.read("dynamic_friction", pair.dynamic_friction, Range::between(0, kMaxSurface));
    members.read("restitution", pair.restitution, Range::between(0, 1));
    members.finish();
    if (!seen.insert(std::minmax(pair.a, pair.b)).second) {
      names.fail("this pair of materials is given twice, expected once");
    }
    reading.scene.material_pairs.push_back(pair);
  }
}

void read_each(SceneReading& reading, Members& members, const char* key, const char* what,
               void (*read)(SceneReading&, const Field&)) {
  const std::optional<Field> section = members.find(key);
  if (!section) return;
  const std::size_t count = section->array(what);
  constexpr std::size_t kMost = 65536;  // a world has at most that many, all kinds together
  if (count > kMost) section->expected("at most 65536 of them");
  for (std::size_t i = 0; i < count; ++i) read(reading, section->element(i));
}

void read_ignored_pair(SceneReading& reading, const Field& field) {
  field.array("the names of 2 bodies", 2);
  const std::pair<int, int> pair{find_name(reading.bodies, field.element(0), "a body"),
                                 find_name(reading.bodies, field.element(1), "a body")};
  if (pair.first == pair.second) field.fail("found the same body twice, expected two bodies");
  reading.scene.ignored_pairs.push_back(pair);
}

void check_world_name(const SceneReading& reading, const Field& joints) {
  const auto named_world = reading.bodies.find("world");
  if (named_world == reading.bodies.end()) return;
  for (std::size_t i = 0; i < joints.json().size(); ++i) {
    const Field joint = joints.element(i);
    for (const char* end : {"a", "b"}) {
      const auto at = joint.json().find(end);
      if (at != joint.json().end() && *at == "world") {
        Field(*at, joint, end)
            .fail("\"world\" is both the fixed world and a body here; expected another name for the body");
      }
    }
  }
}

void read_scene_object(SceneReading& reading, const Field& root) {
  Members members(root, "a scene");
  // The version first: a newer format may have other fields.
  read_version(members.need("gyre_scene"));
  if (const auto name = members.find("name")) reading.scene.name = name->text();
  if (const auto world = members.find("world")) read_world(*world, reading.scene.world);
  if (const auto view = members.find_value("view")) reading.scene.view = read_view(*view);
  if (const auto materials = members.find("materials")) {
    for_each_named(reading, *materials, "an object of materials by name",
                   [&](const std::string& name, const Field& field) { read_material(reading, name, field); });
  }
  if (const auto pairs = members.find("material_pairs")) read_material_pairs(reading, *pairs);
  if (const auto meshes = members.find("meshes")) {
    for_each_named(reading, *meshes, "an object of meshes by name",
                   [&](const std::string& name, const Field& field) { read_mesh(reading, field, name); });
  }
  if (const auto bodies = members.find("bodies")) {
    const std::size_t count = bodies->array("an array of bodies");
    if (count > reading.options.limits.bodies) {
      bodies->expected("at most " + std::to_string(reading.options.limits.bodies) + " bodies");
    }
    reading.scene.bodies.reserve(count);
    for (std::size_t i = 0; i < count; ++i) read_body(reading, bodies->element(i));
  }
  if (const auto joints = members.find("joints")) {
    const std::size_t count = joints->array("an array of joints");
    if (count > reading.options.limits.joints) {
      joints->expected("at most " + std::to_string(reading.options.limits.joints) + " joints");
    }
    for (std::size_t i = 0; i < count; ++i) read_joint(reading, joints->element(i));
    check_world_name(reading, *joints);
  }
  read_each(reading, members, "couplings", "an array of couplings", read_coupling);
  read_each(reading, members, "ignored_pairs", "an array of pairs of bodies", read_ignored_pair);
  read_each(reading, members, "ropes", "an array of ropes", read_rope);
  read_each(reading, members, "cloths", "an array of cloths", read_cloth);
  read_each(reading, members, "soft_bodies", "an array of soft bodies", read_soft_body);
  read_each(reading, members, "gases", "an array of gases", read_gas);
  read_each(reading, members, "liquids", "an array of liquids", read_liquid);
  if (const auto fields = members.find("force_fields")) {
    const std::size_t count = fields->array("an array of force fields");
    constexpr std::size_t kMaxFields = 10000;
    if (count > kMaxFields) fields->expected("at most 10000 force fields");
    for (std::size_t i = 0; i < count; ++i) read_field(reading, fields->element(i));
  }
  members.finish();
}

}  // namespace

SceneResult<Scene> read_scene(std::string_view text, const ReadOptions& options) noexcept {
  try {
    const Json document = parse_document(text, options.file, options.limits);
    SceneReading reading{options, {}, {}, {}, {}, {}, 0};
    read_scene_object(reading, Field(document, options.file));
    return std::move(reading.scene);
  } catch (const SceneError& error) {
    return error;
  } catch (const std::bad_alloc&) {
    return SceneError{options.file, 0, 0, "", "needs more memory than there is"};
  } catch (const std::exception& error) {
    return SceneError{options.file, 0, 0, "", error.what()};
  }
}

SceneResult<Scene> load_scene(const std::string& path, const SceneLimits& limits) noexcept {
  try {
    ReadOptions options;
    options.file = path;
    options.mesh_files = true;
    options.folder = std::filesystem::path(path).parent_path().string();
    options.limits = limits;
    std::string text;
    const std::string problem = read_whole_file(path, limits, text);
    if (!problem.empty()) return SceneError{path, 0, 0, "", problem};
    if (text.rfind("GYREPLAY", 0) == 0) {
      return SceneError{path, 0, 0, "",
                        "is a recording, expected a scene; gyre replay plays a recording, gyre info describes it, "
                        "gyre render and gyre view show it"};
    }
    return read_scene(text, options);
  } catch (const std::exception& error) {
    return SceneError{"scene", 0, 0, "", error.what()};
  }
}

}  // namespace gyre
