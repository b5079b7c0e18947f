// Ropes, cloths and soft bodies in scenes: what is read, what is refused and where, what is written, and going on from a final scene.
#include "scene/json_schema_check.h"
#include "scene/scene_reader.h"
#include "scene/scene_runner.h"
#include "scene/scene_schema.h"
#include "scene/scene_test_kit.h"
#include "scene/scene_writer.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

namespace gyre::scene_soft_test {
namespace {

using namespace scene_test;

const std::string kMeshes =
    R"("meshes": {"sheet": {"vertices": [[0,0,0],[1,0,0],[1,0,1],[0,0,1]], "triangles": [[0,2,1],[0,3,2]]},)"
    R"( "ball": {"vertices": [[1,0,0],[-1,0,0],[0,1,0],[0,-1,0],[0,0,1],[0,0,-1]], "triangles": [[0,2,4],[2,1,4],[1,3,4],[3,0,4],[2,0,5],[1,2,5],[3,1,5],[0,3,5]]},)"
    R"( "line": {"vertices": [[0,0,0],[1,0,0],[2,0,0],[0,0,1]], "triangles": [[0,1,2],[0,3,1]]}}, )";
const std::string kBodies =
    R"("bodies": [{"name": "pole", "type": "static"}, {"name": "load", "position": [2, 0, 0], "shapes": [)"
    R"({"type": "sphere", "radius": 0.1}]}], )";

std::string scene_of(const std::string& section, const std::string& entry) {
  return R"({"gyre_scene": 1, )" + kMeshes + kBodies + "\"" + section + "\": [" + entry + "]}";
}
std::string rope_with(const std::string& members) {
  return scene_of("ropes", R"({"name": "r", "points": [[0, 0, 0], [2, 0, 0]], )" + members + "}");
}
std::string cloth_with(const std::string& members) {
  return scene_of("cloths", R"({"name": "c", )" + members + "}");
}
std::string grid_with(const std::string& members) {
  return cloth_with(R"("grid": {"size": [2, 1], "cells": [4, 2]}, )" + members);
}
std::string solid_with(const std::string& members) {
  return scene_of("soft_bodies", R"({"name": "s", )" + members + "}");
}
std::string box_with(const std::string& members) {
  return solid_with(R"("box": {"half_extents": [1, 1, 1], "cells": [2, 1, 1]}, )" + members);
}
std::string tets_with(const std::string& tetrahedra) {
  return solid_with(R"("vertices": [[0,0,0],[1,0,0],[0,1,0],[0,0,1],[1,1,0]], "tetrahedra": )" + tetrahedra);
}

TEST(SceneSoft, RefusesBadRopes) {
  const std::string at = "/ropes/0";
  const Refused table[] = {
      {scene_of("ropes", R"({"points": [[0,0,0],[1,0,0]]})"), at + "/name", "found nothing", "\"name\""},
      {scene_of("ropes", R"({"name": "r"})"), at + "/points", "found nothing", "\"points\""},
      {scene_of("ropes", R"({"name": "r", "points": [[0,0,0]]})"), at + "/points", "an array of 1",
       "at least 2 points"},
      {scene_of("ropes", R"({"name": "r", "points": [[1,0,0],[1,0,0]]})"), at + "/points", "in one place",
       "with a length"},
      {scene_of("ropes", R"({"name": "r", "points": [[0,0,0],[1,0,0],[1,0,0]]})"), at + "/points/2",
       "points[2]", "needs a length"},
      {scene_of("ropes", R"({"name": "load", "points": [[0,0,0],[1,0,0]]})"), at + "/name", "\"load\"",
       "that no body"},
      {rope_with(R"("segments": 0)"), at + "/segments", "found 0", "from 1"},
      {rope_with(R"("segments": 2000000)"), at + "/segments", "found 2000000", "at most 1048575"},
      {rope_with(R"("linear_density": 0)"), at + "/linear_density", "found 0", "above 0"},
      {rope_with(R"("stretch_stiffness": -1)"), at + "/stretch_stiffness", "found -1", "from 0"},
      {rope_with(R"("links": "springs", "stretch_stiffness": 0)"), at + "/stretch_stiffness", "found 0",
       "above 0"},
      {rope_with(R"("bend_stiffness": -1)"), at + "/bend_stiffness", "found -1", "from 0"},
      {rope_with(R"("links": "steel")"), at + "/links", "\"steel\"", "\"rods\""},
      {rope_with(R"("damping": -0.1)"), at + "/damping", "found -0.1", "from 0"},
      {rope_with(R"("attach": [{"end": 2, "body": "pole"}])"), at + "/attach/0/end", "found 2",
       "from 0 to 1"},
      {rope_with(R"("attach": [{"end": 1, "body": "tree"}])"), at + "/attach/0/body", "\"tree\"",
       "the name of a body"},
      {rope_with(R"("attach": [{"end": 1, "body": "load"}, {"end": 1, "body": "pole"}])"),
       at + "/attach/1/end", "a second time", "once"},
      {rope_with(R"("state": {"positions": [[0,0,0]]})"), at + "/state/positions", "an array of 1",
       "an array of 2 positions"},
      {rope_with(R"("state": {"velocities": [[0,0,0],[0,0,0],[0,0,0]]})"), at + "/state/velocities",
       "an array of 3", "an array of 2 velocities"},
      {rope_with(R"("state": {"speeds": []})"), at + "/state/speeds", "unknown field", "positions"},
      {rope_with(R"("integrator": "euler")"), at + "/integrator", "\"euler\"", "\"implicit\""},
      {rope_with(R"("raduis": 1)"), at + "/raduis", "unknown field", "\"radius\""},
  };
  for (const Refused& bad : table) expect_refused(bad);
}

TEST(SceneSoft, RefusesBadCloths) {
  const std::string at = "/cloths/0";
  const Refused table[] = {
      {cloth_with(R"("links": "rods")"), at, "neither \"mesh\" nor \"grid\"", "expected one"},
      {grid_with(R"("mesh": "sheet")"), at + "/grid", "beside \"mesh\"", "expected one"},
      {cloth_with(R"("mesh": "sail")"), at + "/mesh", "\"sail\"", "the name of a mesh"},
      {cloth_with(R"("mesh": "line")"), at + "/mesh", "triangles[0]", "no area"},
      {cloth_with(R"("grid": {"size": [0, 1], "cells": [1, 1]})"), at + "/grid/size/0", "found 0", "above 0"},
      {cloth_with(R"("grid": {"size": [1, 1], "cells": [1, 0]})"), at + "/grid/cells/1", "found 0", "from 1"},
      {cloth_with(R"("grid": {"size": [1, 1], "cells": [1, 5000]})"), at + "/grid/cells/1", "found 5000",
       "at most 4096"},
      {cloth_with(R"("grid": {"size": [1, 1], "cells": [4000, 4000]})"), at + "/grid/cells", "found 16008001",
       "at most 1048576"},
      {grid_with(R"("area_density": 0)"), at + "/area_density", "found 0", "above 0"},
      {grid_with(R"("stretch_stiffness": -5)"), at + "/stretch_stiffness", "found -5", "above 0"},
      {grid_with(R"("shear_stiffness": -5)"), at + "/shear_stiffness", "found -5", "from 0"},
      {grid_with(R"("bend_stiffness": -5)"), at + "/bend_stiffness", "found -5", "from 0"},
      {grid_with(R"("pinned": [15])"), at + "/pinned/0", "found 15", "from 0 to 14"},
      {grid_with(R"("pinned": [0, -1])"), at + "/pinned/1", "found -1", "from 0 to 14"},
      {grid_with(R"("pinned_to": [{"vertex": 15, "body": "pole"}])"), at + "/pinned_to/0/vertex", "found 15",
       "from 0 to 14"},
      {grid_with(R"("pinned_to": [{"vertex": 1, "body": "mast"}])"), at + "/pinned_to/0/body", "\"mast\"",
       "the name of a body"},
      {grid_with(R"("pinned": [1], "pinned_to": [{"vertex": 1, "body": "pole"}])"),
       at + "/pinned_to/0/vertex", "a second time", "once"},
      {grid_with(R"("pinned_to": [{"vertex": 1, "point": [0, 0, 0], "body": "pole"}])"),
       at + "/pinned_to/0/vertex", "beside \"point\"", "one of the two"},
      {grid_with(R"("pinned_to": [{"point": [0, 0, 0], "body": "mast"}])"), at + "/pinned_to/0/body", "\"mast\"",
       "the name of a body"},
      {grid_with(R"("pinned_to": [{"point": [0, 0, 0]}])"), at + "/pinned_to/0/body", "found nothing", "\"body\""},
      {grid_with(R"("integrator": "visual", "pinned_to": [{"point": [0, 0, 0], "body": "pole"}])"),
       at + "/pinned_to/0/point", "found a point", "expected \"vertex\""},
      {grid_with(R"("pinned_to": [{"point": [0, 9, 0], "body": "pole"}])"), at + "/pinned_to", "m away",
       "within an edge"},
      {grid_with(R"("state": {"positions": []})"), at + "/state/positions", "an array of 0",
       "an array of 15 positions"},
      {cloth_with(R"("mesh": "sheet", "links": "membrane", "shear_stiffness": 1, "stretch_stiffness": 1000)"),
       at + "/shear_stiffness", "shear_stiffness is 1", "a quarter"},
      {grid_with(R"("links": "membrane", "tear_strain": 0.5, "shear_stiffness": 200)"), at + "/shear_stiffness",
       "shear_stiffness is 200", "a quarter"},
      {grid_with(R"("links": "membrane", "integrator": "visual")"), at + "/integrator", "is visual",
       "springs or rods"},
  };
  for (const Refused& bad : table) expect_refused(bad);
}

TEST(SceneSoft, RefusesBadSoftBodies) {
  const std::string at = "/soft_bodies/0";
  const Refused table[] = {
      {solid_with(R"("density": 1)"), at, "found none", "\"box\""},
      {box_with(R"("vertices": [])"), at + "/vertices", "beside \"box\"", "\"tetrahedra\""},
      {box_with(R"("resolution": 4)"), at + "/resolution", "only a soft body of a \"mesh\"", "resolution"},
      {solid_with(R"("box": {"half_extents": [1, 0, 1], "cells": [1, 1, 1]})"), at + "/box/half_extents/1",
       "found 0", "above 0"},
      {solid_with(R"("box": {"half_extents": [1, 1, 1], "cells": [1, 1, 300]})"), at + "/box/cells/2",
       "found 300", "at most 256"},
      {solid_with(R"("box": {"half_extents": [1, 1, 1], "cells": [200, 200, 200]})"), at + "/box/cells",
       "found 8120601", "at most 1048576"},
      {tets_with("[[0, 1, 2, 5]]"), at + "/tetrahedra/0/3", "found 5", "from 0 to 4"},
      {tets_with("[[0, 1, 2, 3], [0, 1, 2, 4]]"), at + "/tetrahedra/1", "no volume",
       "do not lie in one plane"},
      {box_with(R"("pinned_region": {"box": [[5, 5, 5], [6, 6, 6]]})"), at + "/pinned_region", "found no vertex",
       "expected some"},
      {tets_with("[[0, 2, 1, 3], [0, 1, 4, 3]]"), at + "/tetrahedra/0", "is inverted", "clockwise"},
      {tets_with("[[0, 1, 2, 3], [0, 1, 4, 3]]"), at + "/tetrahedra/0", "overlap", "same side"},
      {tets_with("[[0, 1, 2, 2]]"), at + "/tetrahedra/0", "no volume", "four corners"},
      {tets_with("[[0, 1, 2, 3]]"), at + "/vertices/4", "vertices[4]", "no mass"},
      {solid_with(R"("vertices": [[0,0,0],[1,0,0],[0,1,0],[0,0,1]])"), at + "/tetrahedra", "found nothing",
       "\"tetrahedra\""},
      {solid_with(R"("mesh": "bear")"), at + "/mesh", "\"bear\"", "the name of a mesh"},
      {solid_with(R"("mesh": "sheet")"), at + "/mesh", "is open", "closed surfaces"},
      {solid_with(R"("mesh": "ball", "resolution": 1)"), at + "/resolution", "found 1", "from 2 to 128"},
      {solid_with(R"("mesh": "ball", "resolution": 129)"), at + "/resolution", "found 129", "at most 128"},
      {solid_with(R"("mesh": "ball", "box": {})"), at + "/box", "beside \"mesh\"", "\"tetrahedra\""},
      {solid_with(R"("mesh": "ball", "resolution": 4, "pinned": [0, 9999])"), at + "/pinned/1",
       "found vertex 9999", "from 0 to"},
      {solid_with(R"("mesh": "ball", "resolution": 4, "state": {"positions": [[0,0,0]]})"),
       at + "/state/positions", "has 1 entries", "there are"},
      {box_with(R"("density": 0)"), at + "/density", "found 0", "above 0"},
      {box_with(R"("young_modulus": 0)"), at + "/young_modulus", "found 0", "above 0"},
      {box_with(R"("poisson_ratio": 0.5)"), at + "/poisson_ratio", "found 0.5", "below 0.5"},
      {box_with(R"("poisson_ratio": -1)"), at + "/poisson_ratio", "found -1", "above -1"},
      {box_with(R"("model": "rubber")"), at + "/model", "\"rubber\"", "\"neo_hookean\""},
      {box_with(R"("pinned": [12])"), at + "/pinned/0", "found 12", "from 0 to 11"},
      {box_with(R"("pinned_region": {"box": [[1, 0, 0], [0, 1, 1]]})"), at + "/pinned_region/box",
       "a lower corner above the upper", "[low, high]"},
      {box_with(R"("pinned_region": {})"), at + "/pinned_region/box", "found nothing", "\"box\""},
      {box_with(R"("state": {"positions": [[0,0,0]]})"), at + "/state/positions", "an array of 1",
       "an array of 12 positions"},
  };
  for (const Refused& bad : table) expect_refused(bad);
}

TEST(SceneSoft, NamesAreUniqueOverAllKinds) {
  const std::string rope = R"("ropes": [{"name": "x", "points": [[0,0,0],[1,0,0]]}])";
  const std::string cloth = R"("cloths": [{"name": "x", "grid": {"size": [1,1], "cells": [1,1]}}])";
  const std::string solid =
      R"("soft_bodies": [{"name": "x", "box": {"half_extents": [1,1,1], "cells": [1,1,1]}}])";
  const std::string start = R"({"gyre_scene": 1, )";
  EXPECT_TRUE(read_scene(start + rope + "}"));
  EXPECT_EQ(refusal(start + rope + ", " + cloth + "}").pointer, "/cloths/0/name");
  EXPECT_EQ(refusal(start + cloth + ", " + solid + "}").pointer, "/soft_bodies/0/name");
  EXPECT_EQ(refusal(start + solid + R"(, "bodies": [{"name": "x"}]})").pointer, "/soft_bodies/0/name");
}

TEST(SceneSoft, StopsAtTheLimitOfAllTogether) {
  ReadOptions options;
  options.limits.soft_vertices = 20;
  EXPECT_TRUE(read_scene(grid_with(R"("pinned": [])"), options));
  const std::string two = scene_of("cloths", R"({"name": "a", "grid": {"size": [1,1], "cells": [2,2]}},
                                                {"name": "b", "grid": {"size": [1,1], "cells": [3,2]}})");
  const SceneResult<Scene> read = read_scene(two, options);
  ASSERT_FALSE(read);
  EXPECT_EQ(read.error().pointer, "/cloths/1/grid/cells");
  EXPECT_NE(read.error().message.find("found 21"), std::string::npos) << read.error().message;
  EXPECT_NE(read.error().message.find("at most 20"), std::string::npos) << read.error().message;
}

TEST(SceneSoft, DefaultsAreThoseOfTheFormat) {
  const SceneResult<Scene> scene =
      read_scene(R"({"gyre_scene": 1, "ropes": [{"name": "r", "points": [[0,0,0],[1,0,0]]}],
                     "cloths": [{"name": "c", "grid": {"size": [1,1], "cells": [1,1]}}],
                     "soft_bodies": [{"name": "s", "box": {"half_extents": [1,1,1], "cells": [1,1,1]}, "static_friction": 0.7}]})");
  ASSERT_TRUE(scene) << scene.error().text();
  const RopeDef& rope = scene->ropes[0].def;
  EXPECT_EQ(rope.links, RopeLinks::rods);
  EXPECT_EQ(rope.radius, 0.02f);
  EXPECT_EQ(rope.linear_density, 0.1f);
  EXPECT_EQ(rope.stretch_stiffness, 1.0e4f);
  EXPECT_EQ(rope.settings.integrator, SoftIntegrator::implicit);
  EXPECT_EQ(rope.settings.damping, 0.0f);
  EXPECT_EQ(rope.settings.static_friction, 0.4f);
  EXPECT_EQ(rope.settings.dynamic_friction, 0.4f);
  const ClothDef& cloth = scene->cloths[0].def;
  EXPECT_EQ(cloth.links, ClothLinks::springs);
  EXPECT_EQ(cloth.area_density, 0.2f);
  EXPECT_EQ(cloth.stretch_stiffness, 1000.0f);
  EXPECT_EQ(cloth.shear_stiffness, 200.0f);
  EXPECT_EQ(cloth.bend_stiffness, 1.0e-4f);
  EXPECT_EQ(cloth.thickness, 0.005f);
  EXPECT_TRUE(cloth.self_collision);
  const SolidDef& solid = scene->soft_bodies[0].def;
  EXPECT_EQ(solid.model, SolidModel::neo_hookean);
  EXPECT_EQ(solid.density, 1000.0f);
  EXPECT_EQ(solid.young_modulus, 1.0e5f);
  EXPECT_EQ(solid.poisson_ratio, 0.45f);
  EXPECT_EQ(solid.settings.dynamic_friction, 0.7f);  // as the static one
}

// The default of a grid, 200 of 1000 N/m, is that of no isotropic sheet.
TEST(SceneSoft, AMembraneOfAMeshNeedsNoShearStiffness) {
  const auto shear_of = [](const std::string& members) {
    return run(cloth_with(members)).scene().cloths[0].def.shear_stiffness;
  };
  EXPECT_EQ(shear_of(R"("mesh": "sheet", "links": "membrane", "stretch_stiffness": 600)"), 300.0f);
  EXPECT_EQ(
      shear_of(R"("mesh": "sheet", "links": "membrane", "stretch_stiffness": 600, "shear_stiffness": 200)"),
      200.0f);
  EXPECT_EQ(shear_of(R"("mesh": "sheet", "stretch_stiffness": 600)"), 200.0f);
  // A grid that may tear is one of triangles.
  const std::string grid = R"("grid": {"size": [1, 1], "cells": [2, 2]}, "links": "membrane", )";
  EXPECT_EQ(shear_of(grid + R"("stretch_stiffness": 600)"), 200.0f);
  EXPECT_EQ(shear_of(grid + R"("stretch_stiffness": 600, "tear_strain": 0.5)"), 300.0f);
}

// Every member of the three kinds.
const std::string kAll = R"({"gyre_scene": 1, "name": "all", )" + kMeshes + kBodies +
                         R"("ropes": [
      {"name": "a", "points": [[0, 3, 0], [0.1, 3, 0], [2, 0, 0]], "segments": 5, "radius": 0.01, "linear_density": 0.3, "links": "springs",
       "stretch_stiffness": 1234.5, "bend_stiffness": 0.02, "attach": [{"end": 0, "body": "world"}, {"end": 1, "body": "load"}],
       "pinned_to": [{"vertex": 2, "body": "pole"}], "integrator": "verlet", "damping": 0.001, "static_friction": 0.5,
       "dynamic_friction": 0.1, "color": "#102030"},
      {"name": "b", "points": [[0, 3, 1], [1, 3, 1]], "state": {"positions": [[0, 3.1, 1], [1, 3, 1.123456789012345]], "velocities": null}}],
    "cloths": [
      {"name": "c", "grid": {"size": [2, 1], "cells": [2, 1]}, "position": [0, 5, 0.1], "orientation": [0, 0, 0.6, 0.8], "links": "membrane",
       "area_density": 0.3, "stretch_stiffness": 900, "shear_stiffness": 0, "bend_stiffness": 0.001, "thickness": 0.02,
       "self_collision": false, "pinned": [0, 2], "pinned_to": [{"vertex": 4, "body": "load"}, {"vertex": 5, "body": "world"}],
       "integrator": "rk4",
       "state": {"positions": [[0,5,0],[1,5,0],[2,5,0],[0,5,1],[1,5,1],[2,5,1]],
                 "velocities": [[0,0,0],[0.1,0.2,0.3],[0,0,0],[0,0,0],[0,0,0],[0,0,0]]}},
      {"name": "d", "mesh": "sheet", "position": [0, 8, 0], "links": "rods",
       "pinned_to": [{"point": [0.25, 8, 0.125], "body": "pole"}, {"point": [0.75, 8, 0.5], "body": "world"}]}],
    "soft_bodies": [
      {"name": "e", "box": {"half_extents": [0.5, 0.25, 0.5], "cells": [2, 1, 1]}, "position": [0, 12, 0], "density": 900,
       "young_modulus": 20000, "poisson_ratio": -0.2, "model": "corotated", "pinned_region": {"box": [[-1, 12.1, -1], [1, 13, 0]]}},
      {"name": "f", "vertices": [[0,0,0],[1,0,0],[0,1,0],[0,0,1]], "tetrahedra": [[0, 1, 2, 3]], "position": [0, 15, 0],
       "orientation": [0, 1, 0, 0], "model": "linear", "pinned": [3]}]})";

TEST(SceneSoft, WritesWhatItRead) {
  const SceneResult<Scene> first = read_scene(kAll);
  ASSERT_TRUE(first) << first.error().text();
  const std::string text = write_scene(*first);
  const SceneResult<Scene> second = read_scene(text);
  ASSERT_TRUE(second) << second.error().text() << "\n" << text;
  EXPECT_EQ(write_scene(*second), text);
  const Json schema = parse_document(scene_schema(), "schema", SceneLimits{});
  EXPECT_EQ(SchemaCheck(schema).check(parse_document(kAll, "scene", SceneLimits{})), "");
  EXPECT_EQ(SchemaCheck(schema).check(parse_document(text, "scene", SceneLimits{})), "");

  const SceneRope &a = second->ropes[0], &b = second->ropes[1];
  EXPECT_EQ(a.def.segments, 5);
  EXPECT_EQ(a.def.stretch_stiffness, 1234.5f);
  EXPECT_EQ(a.def.settings.integrator, SoftIntegrator::verlet);
  EXPECT_EQ(a.def.settings.dynamic_friction, 0.1f);
  EXPECT_EQ(*a.color, (SceneColor{0x10, 0x20, 0x30}));
  ASSERT_EQ(a.holds.size(), 3u);
  for (const SceneHold hold : {SceneHold{0, -1}, SceneHold{2, 0}, SceneHold{5, 1}})
    EXPECT_NE(std::find(a.holds.begin(), a.holds.end(), hold), a.holds.end()) << hold.vertex;
  EXPECT_EQ(b.def.settings.positions[1].z, 1.123456789012345);
  EXPECT_TRUE(b.def.settings.velocities.empty());
  const SceneCloth& c = second->cloths[0];
  EXPECT_EQ(c.def.grid->cells, (std::array<int, 2>{2, 1}));
  EXPECT_EQ(c.def.pose.orientation, (Quat{0, 0, 0.6f, 0.8f}));
  EXPECT_EQ(c.def.settings.velocities[1], (Vec3{0.1f, 0.2f, 0.3f}));
  EXPECT_FALSE(c.def.self_collision);
  EXPECT_EQ(c.holds.size(), 4u);
  EXPECT_EQ(second->cloths[1].points, (std::vector<SceneHeldPoint>{{{0.25, 8, 0.125}, 0}, {{0.75, 8, 0.5}, -1}}));
  EXPECT_EQ(second->cloths[1].mesh, first->cloths[1].mesh);
  EXPECT_EQ(second->soft_bodies[0].def.poisson_ratio, -0.2f);
  EXPECT_EQ(second->soft_bodies[0].pinned_region->high, (DVec3{1, 13, 0}));
  EXPECT_EQ(second->soft_bodies[1].def.tetrahedra, (std::vector<std::uint32_t>{0, 1, 2, 3}));
}

TEST(SceneSoft, BecomesWhatItSaysInTheWorld) {
  const SceneRunner runner = run(kAll);
  ASSERT_EQ(runner.ropes().size(), 2u);
  ASSERT_EQ(runner.cloths().size(), 2u);
  ASSERT_EQ(runner.soft_bodies().size(), 2u);
  const World& world = runner.world();
  EXPECT_EQ(world.soft_info(runner.ropes()[0]).vertices, 6);
  EXPECT_EQ(world.soft_info(runner.cloths()[0]).vertices, 6);
  EXPECT_EQ(world.soft_info(runner.cloths()[1]).vertices, 4);
  EXPECT_EQ(world.soft_info(runner.soft_bodies()[0]).vertices, 12);
  EXPECT_NEAR(world.soft_info(runner.cloths()[0]).mass, 0.6, 1e-6);
  EXPECT_NEAR(world.soft_info(runner.soft_bodies()[0]).mass, 450, 1e-3);
  EXPECT_EQ(world.vertices(runner.ropes()[1]).position(0), (DVec3{0, 3.1, 1}));
  EXPECT_EQ(world.vertices(runner.cloths()[0]).velocity(1), (Vec3{0.1f, 0.2f, 0.3f}));
  std::vector<std::string> names;
  runner.for_each_soft([&](const SceneSoft& soft, SoftId) { names.push_back(soft.name); });
  EXPECT_EQ(names, (std::vector<std::string>{"a", "b", "c", "d", "e", "f"}));
}

TEST(SceneSoft, AClosedClothHoldsGas) {
  const std::string text = R"({"gyre_scene": 1, "name": "balloon",
    "meshes": {"tetra": {"vertices": [[0,0,0],[1,0,0],[0,1,0],[0,0,1]], "triangles": [[0,2,1],[0,1,3],[0,3,2],[1,2,3]]},
               "sheet": {"vertices": [[0,0,0],[1,0,0],[0,1,0]], "triangles": [[0,2,1]]}},
    "cloths": [{"name": "a", "mesh": "tetra", "pressure": 50, "ambient_pressure": 0, "pressure_law": "constant"}]})";
  const SceneResult<Scene> scene = read_scene(text);
  ASSERT_TRUE(scene) << scene.error().text();
  const ClothDef& def = read_scene(write_scene(*scene))->cloths[0].def;
  EXPECT_EQ(*def.pressure, 50.0f);
  EXPECT_EQ(def.ambient_pressure, 0.0f);
  EXPECT_EQ(def.pressure_law, PressureLaw::constant);
  const Json schema = parse_document(scene_schema(), "schema", SceneLimits{});
  EXPECT_EQ(SchemaCheck(schema).check(parse_document(text, "scene", SceneLimits{})), "");
  const SceneRunner runner = run(text);
  EXPECT_NEAR(runner.world().soft_info(runner.cloths()[0]).volume, 1.0 / 6.0, 1e-6);
  std::string open = text;
  open.replace(open.find("\"mesh\": \"tetra\""), 15, "\"mesh\": \"sheet\"");
  const SceneResult<Scene> bad = read_scene(open);
  ASSERT_TRUE(bad);
  const auto made = SceneRunner::create(*bad, "scene");
  ASSERT_FALSE(made);
  EXPECT_NE(made.error().text().find("/cloths/0/pressure"), std::string::npos) << made.error().text();
}

TEST(SceneSoft, WhatWasTornIsWrittenAsItIs) {
  const std::string text = R"({"gyre_scene": 1, "name": "torn", "world": {"gravity": [0, -30, 0]},
    "cloths": [{"name": "a", "grid": {"size": [1, 1], "cells": [6, 6]}, "stretch_stiffness": 20, "shear_stiffness": 5, "tear_strain": 0.2,
                "pinned": [0, 6]}],
    "soft_bodies": [{"name": "b", "box": {"half_extents": [0.5, 0.1, 0.1], "cells": [8, 2, 2]}, "position": [0, 5, 0], "young_modulus": 20000,
                     "fracture_stress": 1000, "yield_stress": 800, "creep_time": 0.5, "pinned_region": {"box": [[-1, 4, -1], [-0.4, 6, 1]]}}]})";
  const SceneRunner runner = run(text, 60);
  const int torn = runner.world().soft_info(runner.cloths()[0]).vertices,
            broken = runner.world().soft_info(runner.soft_bodies()[0]).vertices;
  EXPECT_GT(torn, 49);
  EXPECT_GT(broken, 81);
  const std::string left = write_scene(runner.final_scene());
  const Json schema = parse_document(scene_schema(), "schema", SceneLimits{});
  EXPECT_EQ(SchemaCheck(schema).check(parse_document(left, "scene", SceneLimits{})), "");
  const SceneRunner on = run(left, 0);
  EXPECT_EQ(on.world().soft_info(on.cloths()[0]).vertices, torn);
  EXPECT_EQ(on.world().soft_info(on.soft_bodies()[0]).vertices, broken);
  EXPECT_NEAR(on.world().soft_info(on.cloths()[0]).mass, 0.2, 1e-6);
  const SoftVertices was = runner.world().vertices(runner.cloths()[0]),
                     is = on.world().vertices(on.cloths()[0]);
  for (std::size_t i = 0; i < was.size(); ++i) EXPECT_EQ(was.position(i), is.position(i)) << i;
}

TEST(SceneSoft, WhatIsHeldStaysWhereItIs) {
  const SceneRunner runner = run(kAll, 30);
  const SoftVertices c = runner.world().vertices(runner.cloths()[0]);
  EXPECT_EQ(c.position(0), (DVec3{0, 5, 0}));
  EXPECT_EQ(c.position(5), (DVec3{2, 5, 1}));
  EXPECT_LT(c.position(1).y, 4.999);
  // Of the box, vertices at the top with z below the middle are in the region.
  const SoftVertices e = runner.world().vertices(runner.soft_bodies()[0]);
  for (std::size_t i = 0; i < 12; ++i) {
    const bool is_pinned = i >= 3 && i < 6;
    EXPECT_EQ(e.velocity(i) == Vec3{}, is_pinned) << i;
    if (is_pinned) {
      EXPECT_EQ(e.y[i], 12.25) << i;
    }
  }
}

// Two runs of 10 steps, the second from the final scene of the first, against one of 20.
TEST(SceneSoft, GoesOnFromAFinalScene) {
  const SceneRunner whole = run(kAll, 20), half = run(kAll, 10);
  const std::string text = write_scene(half.final_scene());
  const SceneRunner rest = run(text, 10);
  const auto compare = [&](std::span<const SoftId> expected, std::span<const SoftId> got, double within) {
    ASSERT_EQ(expected.size(), got.size());
    for (std::size_t k = 0; k < got.size(); ++k) {
      const SoftVertices a = whole.world().vertices(expected[k]), b = rest.world().vertices(got[k]);
      ASSERT_EQ(a.size(), b.size());
      for (std::size_t i = 0; i < a.size(); ++i)
        EXPECT_LT(length(a.position(i) - b.position(i)), within) << k << " " << i;
    }
  };
  // One of each is attached to the load, and what the solver remembers of that is forgotten.
  compare(whole.ropes(), rest.ropes(), 5e-3);
  compare(whole.cloths(), rest.cloths(), 5e-3);
  compare(whole.soft_bodies(), rest.soft_bodies(), 1e-3);
  // The shape at rest stays, and what a region pinned stays pinned though more has moved into it.
  const SceneResult<Scene> scene = read_scene(text);
  ASSERT_TRUE(scene);
  EXPECT_EQ(scene->ropes[0].def.points[2], (DVec3{2, 0, 0}));
  EXPECT_FALSE(scene->soft_bodies[0].pinned_region);
  EXPECT_EQ(scene->soft_bodies[0].holds, (std::vector<SceneHold>{{3, -1}, {4, -1}, {5, -1}}));
}

// The nearest point is held where it is, and the final scene names where that is then.
TEST(SceneSoft, APointIsHeldByABody) {
  const SceneRunner runner =
      run(box_with(R"("young_modulus": 1e6, "position": [0, 5, 0], "pinned_to": [{"point": [0.3, 5.2, 1.1], "body": "load"}])"), 20);
  const Pose load = runner.world().pose(runner.bodies()[1]);
  const DVec3 held = load * inverse_times(Pose{{2, 0, 0}, {}}, DVec3{0.3, 5.2, 1});
  const Scene left = runner.final_scene();
  ASSERT_EQ(left.soft_bodies[0].points.size(), 1u);
  EXPECT_LT(length(left.soft_bodies[0].points[0].place - held), 1e-5);
  const SceneRunner rest = run(write_scene(left), 1);
  ASSERT_EQ(rest.final_scene().soft_bodies[0].points.size(), 1u);
  EXPECT_LT(length(rest.final_scene().soft_bodies[0].points[0].place - held), 0.1);
}

// Explicit schemes without contacts remember nothing: the motion is the same to the bit.
TEST(SceneSoft, ExplicitSchemesGoOnExactly) {
  for (const char* kind : {"explicit_euler", "semi_implicit_euler", "rk4"}) {
    const std::string text = grid_with(std::string(R"("pinned": [0], "integrator": ")") + kind + "\"");
    const SceneRunner whole = run(text, 20), half = run(text, 10);
    const SceneRunner rest = run(write_scene(half.final_scene()), 10);
    const SoftVertices a = whole.world().vertices(whole.cloths()[0]),
                       b = rest.world().vertices(rest.cloths()[0]);
    ASSERT_EQ(a.size(), b.size());
    EXPECT_GT(std::abs(a.y[14]), 0.1) << kind << ": it has moved (explicit Euler has exploded, upward or downward)";
    for (std::size_t i = 0; i < a.size(); ++i) {
      EXPECT_EQ(a.position(i), b.position(i)) << kind << " " << i;
      EXPECT_EQ(a.velocity(i), b.velocity(i)) << kind << " " << i;
    }
  }
}

TEST(SceneSoft, WhatIsRemovedIsLeftOutOfTheFinalScene) {
  SceneRunner runner = run(kAll, 1);
  ASSERT_TRUE(runner.world().remove_soft(runner.cloths()[0]));
  ASSERT_TRUE(runner.world().remove_body(runner.bodies()[1]));
  const Scene left = runner.final_scene();
  ASSERT_EQ(left.cloths.size(), 1u);
  EXPECT_EQ(left.cloths[0].name, "d");
  EXPECT_EQ(left.ropes[0].holds, (std::vector<SceneHold>{{2, 0}, {0, -1}}));  // the end at the load is free
  EXPECT_TRUE(read_scene(write_scene(left)));
}

TEST(SceneSoft, AMeshIsFilled) {
  const SceneRunner runner = run(
      solid_with(R"("mesh": "ball", "resolution": 6, "density": 300, "position": [0, 5, 0], "pinned": [0])"),
      3);
  const SoftInfo info = runner.world().soft_info(runner.soft_bodies()[0]);
  EXPECT_NEAR(info.mass, 300 * 4.0 / 3, 0.1);  // of an octahedron with radius 1
  EXPECT_GT(info.vertices, 30);
  const std::string text = write_scene(runner.final_scene());
  const SceneRunner rest = run(text, 1);
  EXPECT_EQ(rest.world().soft_info(rest.soft_bodies()[0]).vertices, info.vertices);
  EXPECT_EQ(rest.scene().soft_bodies[0].resolution, 6);
  EXPECT_EQ(rest.scene().soft_bodies[0].holds.size(), 1u);
}

// The lesson of the course: of equal chains explicit Euler explodes, the others do not.
TEST(SceneSoft, ExplicitEulerExplodesInTheSceneOfIntegrators) {
  SceneResult<Scene> scene = load_scene(GYRE_SOURCE_DIR "/scenes/soft/integrators.gyre.json");
  ASSERT_TRUE(scene) << scene.error().text();
  SceneResult<SceneRunner> runner = SceneRunner::create(*std::move(scene), "integrators");
  ASSERT_TRUE(runner) << runner.error().text();
  for (int i = 0; i < 540; ++i) ASSERT_TRUE(runner->step()) << runner->problem();
  runner->for_each_soft([&](const SceneSoft& soft, SoftId id) {
    double farthest = 0;
    const SoftVertices vertices = runner->world().vertices(id);
    for (std::size_t i = 0; i < vertices.size(); ++i)
      farthest = std::fmax(farthest, length(vertices.position(i) - vertices.position(0)));
    if (soft.name == "explicit euler") {
      EXPECT_GT(farthest, 50) << soft.name;
    } else {
      EXPECT_LT(farthest, 4) << soft.name;
    }
  });
}

}  // namespace
}  // namespace gyre::scene_soft_test
