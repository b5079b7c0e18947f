// The schema, the reader and the scenes of the repository agree.
#include "scene/scene_schema.h"

#include "scene/json_schema_check.h"
#include "scene/scene_reader.h"
#include "scene/scene_writer.h"

#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <sstream>
#include <string>
#include <vector>

namespace gyre::scene_schema_test {
namespace {

namespace fs = std::filesystem;

std::string file_text(const fs::path& path) {
  std::ifstream file(path, std::ios::binary);
  std::ostringstream text;
  text << file.rdbuf();
  return text.str();
}

Json parse(const std::string& text) { return parse_document(text, "schema", SceneLimits{}); }

const fs::path kScenes = fs::path(GYRE_SOURCE_DIR) / "scenes";

TEST(SceneSchema, TheFileIsWhatTheProgramPrints) {
  EXPECT_EQ(file_text(kScenes / "scene.schema.json"), scene_schema());
}

TEST(SceneSchema, AcceptsEverySceneOfTheRepositoryAndSoDoesTheReader) {
  const Json schema = parse(scene_schema());
  SchemaCheck check(schema);
  int scenes = 0;
  for (const auto& entry : fs::recursive_directory_iterator(kScenes)) {
    const std::string name = entry.path().filename().string();
    if (name.size() < 10 || name.substr(name.size() - 10) != ".gyre.json") continue;
    ++scenes;
    EXPECT_EQ(check.check(parse(file_text(entry.path()))), "") << name;
    const SceneResult<Scene> scene = load_scene(entry.path().string());
    ASSERT_TRUE(scene) << scene.error().text();
    EXPECT_FALSE(scene->name.empty()) << name;
    EXPECT_EQ(check.check(parse(write_scene(*scene, {.inline_meshes = true}))), "") << name;
    EXPECT_LT(fs::file_size(entry.path()), 300'000u) << name;
  }
  EXPECT_GE(scenes, 14);
}

// A scene in which `members` stand in the named definition.
std::string wrapped(const std::string& definition, const std::string& members) {
  const std::string start = R"({"gyre_scene": 1, )";
  if (definition == "world") return start + R"("world": {)" + members + "}}";
  if (definition == "view") {
    // A member that is under test may be one of the two that must be there.
    const bool eye = members.find("\"eye\"") != std::string::npos;
    const bool target = members.find("\"target\"") != std::string::npos;
    return start + R"("view": {)" + (eye ? "" : R"("eye": [1, 2, 3], )") +
           (target ? "" : R"("target": [0, 0, 0], )") + members + "}}";
  }
  if (definition == "material") return start + R"("materials": {"m": {)" + members + "}}}";
  if (definition == "material_pair") {
    return start + R"("materials": {"m": {}}, "material_pairs": [{"materials": ["m", "m"], )" + members +
           "}]}";
  }
  if (definition == "body") return start + R"("bodies": [{"name": "b", )" + members + "}]}";
  if (definition == "shape_common") {
    return start + R"("bodies": [{"name": "b", "shapes": [{"type": "sphere", "radius": 1, )" + members +
           "}]}]}";
  }
  if (definition == "force_field") return start + R"("force_fields": [{"type": "wind", )" + members + "}]}";
  if (definition == "rope") return start + R"("ropes": [{"name": "r", "points": [[0, 0, 0], [1, 0, 0]], )" + members + "}]}";
  if (definition == "cloth")
    return start + R"("cloths": [{"name": "c", "grid": {"size": [1, 1], "cells": [2, 2]}, )" + members + "}]}";
  if (definition == "soft_body") {
    return start + R"("soft_bodies": [{"name": "s", "box": {"half_extents": [1, 1, 1], "cells": [1, 1, 1]}, )" +
           members + "}]}";
  }
  if (definition == "gas")
    return start + R"("gases": [{"name": "g", "bounds": [[0, 0, 0], [1, 1, 1]], "cells": [4, 4, 4], )" + members + "}]}";
  if (definition == "liquid")
    return start + R"("liquids": [{"name": "l", "bounds": [[0, 0, 0], [1, 1, 1]], "cell_size": 0.25, )" + members + "}]}";
  if (definition == "force") return start + R"("bodies": [{"name": "b", "forces": [{)" + members + "}]}]}";
  const std::string joint =
      start +
      R"("bodies": [{"name": "p"}, {"name": "q"}], "joints": [{"type": "slider", "a": "p", "b": "q", )"
      R"("axis": [0, 1, 0], )";
  if (definition == "motor") return joint + R"("motor": {)" + members + "}}]}";
  return joint + members + "}]}";
}

TEST(SceneSchema, TheReaderKnowsEveryMember) {
  const Json schema = parse(scene_schema());
  int members = 0;
  for (const char* definition :
       {"world", "view", "material", "material_pair", "body", "shape_common", "force", "force_field", "motor", "joint", "rope", "cloth",
        "soft_body", "gas", "liquid"}) {
    for (const auto& [member, rule] : schema["$defs"][definition]["properties"].items()) {
      if (wrapped(definition, "").find("\"" + member + "\"") != std::string::npos) continue;  // there already
      // A value that no member takes: the refusal must be about the value.
      const SceneResult<Scene> scene = read_scene(wrapped(definition, "\"" + member + R"(": [[[]]])"));
      ASSERT_FALSE(scene) << definition << " " << member;
      EXPECT_EQ(scene.error().message.find("unknown field"), std::string::npos)
          << definition << ": " << scene.error().text();
      ++members;
    }
  }
  EXPECT_GT(members, 50);
}

TEST(SceneSchema, BothRefuseTheSame) {
  const Json schema = parse(scene_schema());
  SchemaCheck check(schema);
  const std::vector<std::pair<std::string, std::string>> bad = {
      {"world", R"("gravity": [0, 1])"},
      {"world", R"("time_step": 0)"},
      {"world", R"("substeps": 65)"},
      {"world", R"("solver": "magic")"},
      {"world", R"("nothing": 1)"},
      {"material", R"("restitution": 2)"},
      {"material", R"("density": -1)"},
      {"material", R"("colour": "red")"},
      {"material", R"("color": "red")"},
      {"material", R"("color": [1, 0, 0])"},
      {"body", R"("color": "#12345")"},
      {"body", R"("color": "#12345g")"},
      {"shape_common", R"("color": "1234567")"},
      {"view", R"("eye": [1, 2])"},
      {"view", R"("field_of_view": 0)"},
      {"view", R"("up": [0, 1, 0])"},
      {"material_pair", R"("density": 1)"},
      {"body", R"("type": "fixed")"},
      {"body", R"("mass": 0)"},
      {"body", R"("mass": "1")"},
      {"body", R"("orientation": [0, 0, 1])"},
      {"body", R"("orientation": {"axis": [0, 1, 0]})"},
      {"body", R"("locked": {"linear": [1]})"},
      {"body", R"("filter": {"layer": -1})"},
      {"body", R"("inertia": [1, 2])"},
      {"body", R"("speed": 1)"},
      {"shape_common", R"("height": 1)"},
      {"shape_common", R"("position": 1)"},
      {"shape_common", R"("half_height": 1)"},
      {"force", R"("frame": "local")"},
      {"force", R"("at": [1])"},
      {"force_field", R"("velocity": [1])"},
      {"force_field", R"("turbulence": -1)"},
      {"force_field", R"("bounds": [[0, 0, 0]])"},
      {"force_field", R"("layers": -1)"},
      {"force_field", R"("speed": 1)"},
      {"motor", R"("max_force": -1)"},
      {"motor", R"("speed": 1)"},
      {"joint", R"("limits": [1])"},
      {"joint", R"("break_force": -1)"},
      {"joint", R"("spring": 1)"},
      {"rope", R"("links": "membrane")"},
      {"rope", R"("segments": 0)"},
      {"rope", R"("linear_density": 0)"},
      {"rope", R"("bend_stiffness": -1)"},
      {"rope", R"("attach": [{"end": 2, "body": "world"}])"},
      {"rope", R"("attach": [{"end": 0}])"},
      {"rope", R"("density": 1)"},
      {"cloth", R"("area_density": 0)"},
      {"cloth", R"("shear_stiffness": -1)"},
      {"cloth", R"("pinned": [-1])"},
      {"cloth", R"("pinned_to": [{"vertex": 0}])"},
      {"cloth", R"("integrator": "euler")"},
      {"cloth", R"("state": [])"},
      {"cloth", R"("dynamic_friction": -1)"},
      {"cloth", R"("radius": 1)"},
      {"soft_body", R"("young_modulus": 0)"},
      {"soft_body", R"("density": 0)"},
      {"soft_body", R"("poisson_ratio": 0.5)"},
      {"soft_body", R"("poisson_ratio": -1)"},
      {"soft_body", R"("model": "rubber")"},
      {"soft_body", R"("pinned_region": [[0, 0, 0], [1, 1, 1]])"},
      {"soft_body", R"("damping": -1)"},
      {"gas", R"("density": 0)"},
      {"gas", R"("viscosity": -1)"},
      {"gas", R"("vorticity": -1)"},
      {"gas", R"("boundary": "free")"},
      {"gas", R"("boundary": {"x": "free"})"},
      {"gas", R"("boundary": {"x": ["open"]})"},
      {"gas", R"("boundary": {"w": "open"})"},
      {"gas", R"("walls": {"y": {"velocity": [1, 0, 0]}})"},
      {"gas", R"("initial_velocity": [1, 0])"},
      {"gas", R"("initial_velocity": {"type": "vortex"})"},
      {"gas", R"("initial_velocity": {"amplitude": 1})"},
      {"gas", R"("emitters": [{"radius": 1}])"},
      {"gas", R"("emitters": [{"position": [0.5, 0.5, 0.5], "radius": 0}])"},
      {"gas", R"("emitters": [{"position": [0.5, 0.5, 0.5], "temperature": -1}])"},
      {"gas", R"("probes": [{"position": [0.5, 0.5, 0.5]}])"},
      {"gas", R"("ambient_temperature": 0)"},
      {"gas", R"("advection": "upwind")"},
      {"gas", R"("state": {})"},
      {"gas", R"("cell_size": 1)"},
      {"liquid", R"("density": 0)"},
      {"liquid", R"("surface_tension": -1)"},
      {"liquid", R"("fill": [[[0, 0, 0], [1, 1, 1]]])"},
      {"liquid", R"("emitters": [{"position": [0.5, 0.5, 0.5], "temperature": 300}])"},
      {"liquid", R"("initial_velocity": {"type": "taylor_green"})"},
      {"liquid", R"("state": {"velocities": []})"},
      {"liquid", R"("state": {"positions": [], "affine": [[1, 2, 3]]})"},
      {"liquid", R"("buoyancy": 1)"},
  };
  for (const auto& [definition, members] : bad) {
    const std::string text = wrapped(definition, members);
    EXPECT_FALSE(read_scene(text)) << text;
    EXPECT_NE(check.check(parse(text)), "") << text;
  }
}

TEST(SceneSchema, BothTakeTheContractsGasAndLiquid) {
  const Json schema = parse(scene_schema());
  SchemaCheck check(schema);
  const std::string text = R"({"gyre_scene": 1,
    "gases": [{"name": "smoke", "bounds": [[-2,0,-2],[2,4,2]], "cells": [64,64,64], "buoyancy": 1.0, "vorticity": 0.2,
               "viscosity": 0, "boundary": "open", "emitters": [{"position": [0,0.2,0], "radius": 0.3, "density": 1,
               "temperature": 300, "velocity": [0,1,0]}]}],
    "liquids": [{"name": "water", "bounds": [[0,0,0],[4,2,1]], "cell_size": 0.05, "density": 1000, "viscosity": 0,
                 "surface_tension": 0, "fill": [{"box": [[0,0,0],[1,2,1]]}]}],
    "force_fields": [{"type": "wind", "velocity": [5,0,0], "turbulence": 0.2, "bounds": null}]})";
  EXPECT_EQ(check.check(parse(text)), "");
  EXPECT_TRUE(read_scene(text)) << read_scene(text).error().text();
  EXPECT_NE(check.check(parse(R"({"gyre_scene": 1, "gasses": []})")), "");
}

}  // namespace
}  // namespace gyre::scene_schema_test
