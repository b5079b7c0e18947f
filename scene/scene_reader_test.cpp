// The reader against documents that are wrong in one place each: the pointer and the words must name that place.
#include "scene/scene_reader.h"

#include <gtest/gtest.h>

#include <string>
#include <vector>

namespace gyre::scene_reader_test {
namespace {

struct BadScene {
  std::string text;
  std::string pointer;
  std::vector<std::string> words;
};

std::string scene_with(const std::string& members) { return R"({"gyre_scene": 1, )" + members + "}"; }
std::string world_with(const std::string& members) { return scene_with(R"("world": {)" + members + "}"); }
std::string body_with(const std::string& members) {
  return scene_with(R"("bodies": [{"name": "ground", "type": "static"}, {"name": "box", )" + members + "}]");
}
std::string shape_with(const std::string& members) { return body_with(R"("shapes": [{)" + members + "}]"); }
std::string fixed_shape_with(const std::string& members) {
  return body_with(R"("type": "static", "shapes": [{)" + members + "}]");
}
std::string joint_with(const std::string& members) {
  return scene_with(R"("bodies": [{"name": "p"}, {"name": "q"}], "joints": [{)" + members + "}]");
}
std::string mesh_with(const std::string& members) {
  return scene_with(R"("meshes": {"m": {)" + members + "}}");
}

void expect_refused(const BadScene& bad) {
  ReadOptions options;
  options.file = "bad.gyre.json";
  const SceneResult<Scene> read = read_scene(bad.text, options);
  ASSERT_FALSE(read) << bad.text;
  EXPECT_EQ(read.error().file, "bad.gyre.json");
  EXPECT_EQ(read.error().pointer, bad.pointer) << bad.text << "\n" << read.error().message;
  const std::string text = read.error().text();
  for (const std::string& word : bad.words) {
    EXPECT_NE(text.find(word), std::string::npos) << bad.text << "\nsays: " << text << "\nlacks: " << word;
  }
  EXPECT_EQ(text.find('\n'), std::string::npos) << text;
}

TEST(SceneReader, RefusesWhatIsWrongInTheDocument) {
  const BadScene table[] = {
      {"", "", {"empty file", "JSON object"}},
      {"{", "", {"not valid JSON"}},
      {"[]", "", {"found an array of 0, expected a scene"}},
      {"42", "", {"found 42, expected a scene"}},
      {"{}", "/gyre_scene", {"found nothing", "\"gyre_scene\""}},
      {R"({"gyre_scene": 2})", "/gyre_scene", {"found 2, expected 1"}},
      {R"({"gyre_scene": "1"})", "/gyre_scene", {"found \"1\", expected 1"}},
      {R"({"gyre_scene": 1, "gyre_scene": 1})", "/gyre_scene", {"twice"}},
      {R"({"gyre_scene": 1} x)", "", {"not valid JSON", "bad.gyre.json:1:19"}},
      {R"({"gyre_scene": 1,})", "", {"not valid JSON"}},
      {"// comment\n{\"gyre_scene\": 1}", "", {"not valid JSON"}},
      {"{\n  \"gyre_scene\": 1,\n  \"name\": nope\n}", "/name", {"bad.gyre.json:3:", "not valid JSON"}},
      {std::string("{\"gyre_scene\": 1}\0{}", 19), "", {"zero byte", "bad.gyre.json:1:18"}},
      {"\xff\xfe{\0", "", {"UTF-16"}},
      {"{\"gyre_scene\": 1, \"name\": \"\xc3\x28\"}", "/name", {"not valid JSON", "UTF-8"}},
      {scene_with(R"("name": 3)"), "/name", {"found 3, expected a text"}},
      {scene_with(R"("boddies": [])"), "/boddies", {"unknown field", "\"bodies\""}},
      {scene_with(R"("x/y~z": 1)"),
       "/x~1y~0z",
       {"unknown field in a scene", "one of gyre_scene, name, world"}},
      {scene_with(R"("bodies": {})"), "/bodies", {"found an empty object, expected an array of bodies"}},
      {scene_with(R"("bodies": [7])"), "/bodies/0", {"found 7, expected a body"}},
      {scene_with(R"("materials": [])"), "/materials", {"found an array of 0", "materials by name"}},
      {scene_with(R"("joints": 0)"), "/joints", {"found 0, expected an array of joints"}},
  };
  for (const BadScene& bad : table) expect_refused(bad);
}

TEST(SceneReader, RefusesWhatIsWrongInTheWorld) {
  const BadScene table[] = {
      {world_with(R"("gravity": [0, -9.81])"),
       "/world/gravity",
       {"found an array of 2, expected an array of 3 numbers"}},
      {world_with(R"("gravity": [0, "down", 0])"), "/world/gravity/1", {"found \"down\", expected a number"}},
      {world_with(R"("gravity": [0, -1e300, 0])"), "/world/gravity/1", {"found -1e+300"}},
      {world_with(R"("time_step": 0)"),
       "/world/time_step",
       {"found 0, expected a number above 0 and at most 1"}},
      {world_with(R"("time_step": 1.5)"), "/world/time_step", {"found 1.5"}},
      {world_with(R"("time_step": 1e-300)"), "/world/time_step", {"found 1e-300"}},
      {world_with(R"("time_step": 1e999)"), "/world/time_step", {"not valid JSON", "overflow"}},
      {world_with(R"("time_step": NaN)"), "/world/time_step", {"not valid JSON"}},
      {world_with(R"("time_step": -Infinity)"), "/world/time_step", {"not valid JSON"}},
      {world_with(R"("substeps": 0)"), "/world/substeps", {"found 0, expected an integer from 1 to 64"}},
      {world_with(R"("substeps": 65)"), "/world/substeps", {"found 65"}},
      {world_with(R"("substeps": 2.5)"), "/world/substeps", {"found 2.5"}},
      {world_with(R"("substeps": 99999999999999999999)"), "/world/substeps", {"expected an integer"}},
      {world_with(R"("substeps": 18446744073709551615)"), "/world/substeps", {"expected an integer"}},
      {world_with(R"("substeps": null)"), "/world/substeps", {"found null"}},
      {world_with(R"("sleeping": 1)"), "/world/sleeping", {"found 1, expected true or false"}},
      {world_with(R"("springs": "stiff")"), "/world/springs", {"found \"stiff\"", "\"implicit\""}},
      {world_with(R"("tolerance": 0)"), "/world/tolerance", {"found 0"}},
      {world_with(R"("max_impacts": 5000)"), "/world/max_impacts", {"found 5000"}},
      {world_with(R"("integrator": "rk5")"),
       "/world/integrator",
       {"found \"rk5\"", "one of \"explicit_euler\""}},
      {world_with(R"("solver": "gauss")"), "/world/solver", {"found \"gauss\"", "\"sequential_impulses\""}},
      {world_with(R"("lcp_method": "simplex")"), "/world/lcp_method", {"found \"simplex\"", "\"lemke\""}},
      {world_with(R"("friction_sides": 5)"), "/world/friction_sides", {"found 5", "even number"}},
      {world_with(R"("friction_sides": 34)"), "/world/friction_sides", {"found 34"}},
      {world_with(R"("iterations": -1)"), "/world/iterations", {"found -1"}},
      {world_with(R"("direct_rows": 601)"), "/world/direct_rows", {"found 601"}},
      {world_with(R"("broad_phase": "kdtree")"), "/world/broad_phase", {"found \"kdtree\"", "\"kd_tree\""}},
      {world_with(R"("stepping": "often")"), "/world/stepping", {"found \"often\"", "\"adaptive\""}},
      {world_with(R"("timestep": 0.01)"), "/world/timestep", {"unknown field in a world", "\"time_step\""}},
  };
  for (const BadScene& bad : table) expect_refused(bad);
}

TEST(SceneReader, RefusesWhatIsWrongInMaterialsAndMeshes) {
  const std::string two = R"("materials": {"ice": {}, "steel": {}}, "material_pairs": )";
  const BadScene table[] = {
      {scene_with(R"("materials": {"ice": {"density": -1}})"),
       "/materials/ice/density",
       {"found -1", "0 to 1e+20"}},
      {scene_with(R"("materials": {"ice": {"restitution": 1.01}})"),
       "/materials/ice/restitution",
       {"from 0 to 1"}},
      {scene_with(R"("materials": {"ice": {"friction": 1}})"),
       "/materials/ice/friction",
       {"unknown field in a material"}},
      {scene_with(R"("materials": {"ice": 3})"), "/materials/ice", {"found 3, expected a material"}},
      {scene_with(R"("materials": {"": {}})"), "/materials/", {"found \"\", expected a name"}},
      {scene_with(R"("materials": {"ice": {}, "ice": {}})"), "/materials/ice", {"twice"}},
      {scene_with(two + R"([{"materials": ["ice"]}])"), "/material_pairs/0/materials", {"2 materials"}},
      {scene_with(two + R"([{"materials": ["ice", "wood"]}])"),
       "/material_pairs/0/materials/1",
       {"found \"wood\""}},
      {scene_with(two + R"([{"materials": ["ice", "steel"]}, {"materials": ["steel", "ice"]}])"),
       "/material_pairs/1/materials",
       {"twice"}},
      {scene_with(two + R"([{}])"), "/material_pairs/0/materials", {"found nothing"}},
      {mesh_with(""), "/meshes/m/vertices", {"found nothing", "a mesh needs it"}},
      {mesh_with(R"("vertices": [[0,0,0],[1,0,0]], "triangles": [])"),
       "/meshes/m/vertices",
       {"at least 3 points"}},
      {mesh_with(R"("vertices": [[0,0,0],[1,0,0],[0,1,0]], "triangles": [])"),
       "/meshes/m/triangles",
       {"at least 1"}},
      {mesh_with(R"("vertices": [[0,0,0],[1,0,0],[0,1,0]], "triangles": [[0,1,3]])"),
       "/meshes/m/triangles/0/2",
       {"found 3, expected an integer from 0 to 2"}},
      {mesh_with(R"("vertices": [[0,0,0],[1,0,0],[0,1,0]], "triangles": [[0,1,-1]])"),
       "/meshes/m/triangles/0/2",
       {"-1"}},
      {mesh_with(R"("vertices": [[0,0,0],[1,0,0],[0,1,1e39]], "triangles": [[0,1,2]])"),
       "/meshes/m/vertices/2/2",
       {"found 1e+39", "3.4e38"}},
      {mesh_with(R"("file": "/etc/passwd.obj")"), "/meshes/m/file", {"relative to the scene file"}},
      {mesh_with(R"("file": "../x.obj")"), "/meshes/m/file", {"within the scene's folder"}},
      {mesh_with(R"("file": "a/../../x.obj")"), "/meshes/m/file", {"within the scene's folder"}},
      {mesh_with(R"("file": "C:x.obj")"), "/meshes/m/file", {"without a drive"}},
      {mesh_with(R"("file": "http://host/x.obj")"), "/meshes/m/file", {"without a drive or an address"}},
      {mesh_with(R"("file": "a\\x.obj")"), "/meshes/m/file", {"forward slashes"}},
      {mesh_with(R"("file": "\\\\server\\x.obj")"), "/meshes/m/file", {"forward slashes"}},
      {mesh_with(R"("file": "x.dae")"), "/meshes/m/file", {".obj"}},
      {mesh_with(R"("file": "x\u0000.obj")"), "/meshes/m/file", {"control characters"}},
      {mesh_with(R"("file": "x.obj", "vertices": [])"), "/meshes/m/vertices", {"not both"}},
      {mesh_with(R"("file": "x.obj")"), "/meshes/m/file", {"no files can be opened"}},
  };
  for (const BadScene& bad : table) expect_refused(bad);
}

TEST(SceneReader, RefusesWhatIsWrongInABody) {
  const std::string at = "/bodies/1";
  const BadScene table[] = {
      {scene_with(R"("bodies": [{}])"), "/bodies/0/name", {"found nothing", "a body needs it"}},
      {scene_with(R"("bodies": [{"name": ""}])"), "/bodies/0/name", {"expected a name"}},
      {scene_with(R"("bodies": [{"name": "a\nb"}])"),
       "/bodies/0/name",
       {"found \"a?b\"", "control characters"}},
      {scene_with(R"("bodies": [{"name": "a"}, {"name": "a"}])"), "/bodies/1/name", {"no other body has"}},
      {scene_with(R"("bodies": [{"name": ")" + std::string(2000, 'x') + R"("}])"),
       "/bodies/0/name",
       {"1024 bytes"}},
      {body_with(R"("type": "fixed")"),
       at + "/type",
       {"found \"fixed\"", "\"static\", \"kinematic\", \"dynamic\""}},
      {body_with(R"("position": [0, 1e13, 0])"), at + "/position/1", {"found 1e+13", "1e+12"}},
      {body_with(R"("position": null)"), at + "/position", {"found null"}},
      {body_with(R"("orientation": [0, 0, 0, 0])"), at + "/orientation", {"length 0"}},
      {body_with(R"("orientation": [0, 0, 1])"), at + "/orientation", {"found an array of 3", "quaternion"}},
      {body_with(R"("orientation": {"axis": [0, 0, 0], "angle": 1})"),
       at + "/orientation/axis",
       {"zero vector"}},
      {body_with(R"("orientation": {"axis": [0, 1, 0]})"), at + "/orientation/angle", {"found nothing"}},
      {body_with(R"("orientation": {"euler_xyz": [0, 0]})"), at + "/orientation/euler_xyz", {"array of 3"}},
      {body_with(R"("orientation": {"euler_xyz": [0, 0, 0], "angle": 1})"),
       at + "/orientation/angle",
       {"unknown"}},
      {body_with(R"("linear_damping": -0.1)"), at + "/linear_damping", {"found -0.1"}},
      {body_with(R"("mass": 0)"), at + "/mass", {"found 0, expected a number above 0"}},
      {body_with(R"("mass": 1e-60)"), at + "/mass", {"1e-45"}},
      {body_with(R"("inertia": [1, 1, 1])"), at + "/inertia", {"[xx, yy, zz, xy, xz, yz]"}},
      {body_with(R"("inertia": [1, 1, 0, 0, 0, 0])"), at + "/inertia/2", {"found 0"}},
      {body_with(R"("inertia": [1, 1, 5, 0, 0, 0])"), at + "/inertia", {"sum"}},
      {body_with(R"("locked": {"linear": [true, false]})"), at + "/locked/linear", {"3 truth values"}},
      {body_with(R"("filter": {"layer": -1})"), at + "/filter/layer", {"found -1"}},
      {body_with(R"("filter": {"collides_with": 4294967296})"), at + "/filter/collides_with", {"4294967296"}},
      {body_with(R"("filter": {"group": 3000000000})"), at + "/filter/group", {"2147483647"}},
      {body_with(R"("velocity": [0, 0, 0])"), at + "/velocity", {"unknown field in a body"}},
      {body_with(R"("sensor": "yes")"), at + "/sensor", {"found \"yes\""}},
      {body_with(R"("forces": [{"force": [1, 2]}])"), at + "/forces/0/force", {"array of 2"}},
      {body_with(R"("forces": [{"frame": "local"}])"), at + "/forces/0/frame", {"\"world\", \"body\""}},
      {body_with(R"("forces": [{"from": 1}])"), at + "/forces/0/from", {"unknown field in a force"}},
  };
  for (const BadScene& bad : table) expect_refused(bad);
}

TEST(SceneReader, RefusesWhatIsWrongInAShape) {
  const std::string at = "/bodies/1/shapes/0";
  const BadScene table[] = {
      {shape_with(""), at + "/type", {"found nothing", "a shape needs it"}},
      {shape_with(R"("type": "ball")"), at + "/type", {"found \"ball\"", "\"sphere\""}},
      {shape_with(R"("type": "convex_decomposition")"),
       at + "/mesh",
       {"found nothing", "a convex decomposition needs it"}},
      {shape_with(R"("type": "convex_decomposition", "mesh": "x")"), at + "/mesh", {"\"x\""}},
      {shape_with(R"("type": "sphere")"), at + "/radius", {"found nothing", "a sphere needs it"}},
      {shape_with(R"("type": "sphere", "radius": -1)"),
       at + "/radius",
       {"found -1, expected a number above 0"}},
      {shape_with(R"("type": "sphere", "radius": "1")"),
       at + "/radius",
       {"found \"1\", expected a number above 0"}},
      {shape_with(R"("type": "sphere", "radius": true)"), at + "/radius", {"found true"}},
      {shape_with(R"("type": "sphere", "radius": 1, "half_height": 1)"),
       at + "/half_height",
       {"in a sphere"}},
      {shape_with(R"("type": "sphere", "raduis": 1)"), at + "/radius", {"found nothing"}},
      {shape_with(R"("type": "box", "half_extents": [1, 0, 1])"), at + "/half_extents/1", {"above 0"}},
      {shape_with(R"("type": "box", "half_extents": [1, 1, 0.5], "rounding": 0.6)"),
       at + "/rounding",
       {"0 to 0.5"}},
      {shape_with(R"("type": "capsule", "radius": 1, "half_height": -1)"),
       at + "/half_height",
       {"at least 0"}},
      {shape_with(R"("type": "cone", "radius": 1, "half_height": 0)"), at + "/half_height", {"above 0"}},
      {shape_with(R"("type": "convex_hull", "points": [[0,0,0],[1,0,0],[0,1,0]])"),
       at + "/points",
       {"at least 4"}},
      {shape_with(R"("type": "convex_hull", "mesh": "none")"),
       at + "/mesh",
       {"found \"none\"", "a mesh of this scene"}},
      {shape_with(R"("type": "convex_hull")"), at + "/points", {"found nothing"}},
      {shape_with(R"("type": "plane")"), at + "/type", {"a plane on a dynamic body"}},
      {shape_with(R"("type": "mesh", "mesh": "m")"), at + "/type", {"a mesh on a dynamic body"}},
      {fixed_shape_with(R"("type": "mesh", "mesh": "m")"), at + "/mesh", {"found \"m\""}},
      {fixed_shape_with(R"("type": "plane", "normal": [0, 0, 0])"), at + "/normal", {"zero vector"}},
      {fixed_shape_with(R"("type": "height_field", "size": [2, 1], "heights": [0, 0])"),
       at + "/size/1",
       {"found 1"}},
      {fixed_shape_with(R"("type": "height_field", "size": [2, 2], "heights": [0, 0])"),
       at + "/heights",
       {"found an array of 2, expected 4 numbers (2 times 2)"}},
      {fixed_shape_with(R"("type": "height_field", "size": [65536, 65536], "heights": [])"),
       at + "/heights",
       {"4294967296"}},
      {fixed_shape_with(R"("type": "height_field", "size": [2, 2], "heights": [0, 0, 0, "0"])"),
       at + "/heights/3",
       {}},
      {shape_with(R"("type": "sphere", "radius": 1, "material": "gold")"),
       at + "/material",
       {"found \"gold\""}},
      {shape_with(R"("type": "sphere", "radius": 1, "restitution": 2)"), at + "/restitution", {"0 to 1"}},
      {shape_with(R"("type": "sphere", "radius": 1, "position": [1])"), at + "/position", {"array of 3"}},
  };
  for (const BadScene& bad : table) expect_refused(bad);
}

TEST(SceneReader, RefusesWhatIsWrongInAJoint) {
  const std::string ends = R"(, "a": "p", "b": "q")";
  const std::string at = "/joints/0";
  const BadScene table[] = {
      {joint_with(""), at + "/type", {"found nothing"}},
      {joint_with(R"("type": "wheel", "anchor": [0,0,0])" + ends), at + "/axis", {"found nothing"}},
      {joint_with(R"("type": "rack_and_pinion", "axis": [0,0,1])" + ends), at + "/axis_b", {"found nothing"}},
      {joint_with(R"("type": "ball", "anchor": [0,0,0], "axis_b": [0,0,1])" + ends), at + "/axis_b", {"one axis at most"}},
      {joint_with(R"("type": "gear", "axis": [0,0,1], "ratio": 0)" + ends), at + "/ratio", {"not zero"}},
      {joint_with(R"("type": "pulley", "ground_a": [0,0,0])" + ends), at + "/ground_b", {"found nothing"}},
      {joint_with(R"("type": "path", "path": [[0,0,0]])" + ends), at + "/path", {"2 to 4096 points"}},
      {joint_with(R"("type": "six_dof", "axes": {"linear_x": {"motion": "loose"}})" + ends),
       at + "/axes/linear_x/motion",
       {"found \"loose\"", "\"limited\""}},
      {joint_with(R"("type": "wheel", "anchor": [0,0,0], "axis": [0,1,0], "axes": {"angular_z": {"friction": 1}})" + ends),
       at + "/axes/angular_z",
       {"spin is in its motor"}},
      {joint_with(R"("type": "hinge", "anchor": [0,0,0], "axis": [0,1,0], "swing": [1, 1])" + ends), at + "/swing", {"only cones"}},
      {joint_with(R"("type": "fixed", "drive": {})" + ends), at + "/drive", {"only motors"}},
      {joint_with(R"("type": "glue")" + ends), at + "/type", {"found \"glue\""}},
      {joint_with(R"("type": "ball", "a": "p")"), at + "/b", {"found nothing"}},
      {joint_with(R"("type": "ball", "a": "p", "b": "r", "anchor": [0,0,0])"),
       at + "/b",
       {"found \"r\"", "or \"world\""}},
      {joint_with(R"("type": "ball", "a": "p", "b": "p", "anchor": [0,0,0])"), at + "/b", {"another body"}},
      {joint_with(R"("type": "ball", "a": "world", "b": "world", "anchor": [0,0,0])"),
       at + "/b",
       {"is the world"}},
      {joint_with(R"("type": "ball")" + ends), at + "/anchor", {"found nothing"}},
      {joint_with(R"("type": "hinge", "anchor": [0,0,0])" + ends), at + "/axis", {"found nothing"}},
      {joint_with(R"("type": "hinge", "anchor": [0,0,0], "axis": [0,0,0])" + ends),
       at + "/axis",
       {"zero vector"}},
      {joint_with(R"("type": "hinge", "anchor": [0,0,0], "axis": [0,1,0], "limits": [1, 0])" + ends),
       at + "/limits",
       {"above"}},
      {joint_with(R"("type": "hinge", "anchor": [0,0,0], "axis": [0,1,0], "limits": [1])" + ends),
       at + "/limits",
       {"[low, high]"}},
      {joint_with(R"("type": "ball", "anchor": [0,0,0], "limits": [0, 1])" + ends),
       at + "/limits",
       {"this type of joint has no limits"}},
      {joint_with(R"("type": "ball", "anchor": [0,0,0], "length": 1)" + ends),
       at + "/length",
       {"only distance joints"}},
      {joint_with(R"("type": "slider", "axis": [0,1,0], "motor": {"speed": 1})" + ends),
       at + "/motor/speed",
       {"unknown"}},
      {joint_with(R"("type": "slider", "axis": [0,1,0], "motor": {"max_force": -1})" + ends),
       at + "/motor/max_force",
       {"-1"}},
      {joint_with(R"("type": "distance", "length": -1)" + ends), at + "/length", {"found -1"}},
      {joint_with(R"("type": "distance", "min_length": 2, "max_length": 1)" + ends),
       at + "/min_length",
       {"at most max_length"}},
      {joint_with(R"("type": "fixed", "break_force": 0)" + ends), at + "/break_force", {"above 0"}},
      {scene_with(
           R"("bodies": [{"name": "p"}, {"name": "q"}], "joints": [)"
           R"({"type": "fixed", "name": "j", "a": "p", "b": "q"}, {"type": "fixed", "name": "j", "a": "p", "b": "q"}])"),
       "/joints/1/name",
       {"no other joint has"}},
      {scene_with(
           R"("bodies": [{"name": "p"}, {"name": "world"}], "joints": [{"type": "fixed", "a": "p", "b": "world"}])"),
       "/joints/0/b",
       {"both the fixed world and a body"}},
  };
  for (const BadScene& bad : table) expect_refused(bad);
}

TEST(SceneReader, SectionsOfMatterAreArraysThatMayBeEmpty) {
  for (const char* section : {"ropes", "cloths", "soft_bodies", "gases", "liquids"}) {
    const std::string quoted = std::string("\"") + section + "\": ";
    expect_refused({scene_with(quoted + "3"), std::string("/") + section, {"found 3, expected an array"}});
    EXPECT_TRUE(read_scene(scene_with(quoted + "[]"))) << section;
  }
}

TEST(SceneReader, StopsAtItsLimits) {
  std::string deep;
  for (int i = 0; i < 1'000'000; ++i) deep += "{\"a\":";
  for (const std::string& text : {deep, std::string(1'000'000, '[')}) {
    const SceneResult<Scene> read = read_scene(text);
    ASSERT_FALSE(read);
    EXPECT_NE(read.error().message.find("nested deeper than 64 levels"), std::string::npos);
  }
  ReadOptions options;
  options.limits.values = 100;
  std::string many = "[0";
  for (int i = 0; i < 200; ++i) many += ",0";
  EXPECT_NE(read_scene(many + "]", options).error().message.find("more than 100 values"), std::string::npos);
  options.limits.file_bytes = 10;
  EXPECT_NE(read_scene(many, options).error().message.find("at most 10"), std::string::npos);
  options = {};
  options.limits.bodies = 1;
  EXPECT_EQ(read_scene(body_with(R"("shapes": [])"), options).error().pointer, "/bodies");
  options.limits.bodies = 2;
  EXPECT_TRUE(read_scene(body_with(R"("shapes": [])"), options));
}

}  // namespace
}  // namespace gyre::scene_reader_test
