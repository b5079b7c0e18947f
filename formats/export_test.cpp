// Files for other programs: glTF reads back as the same scene, holds the physics without Gyre's own members, and plays recordings.
#include "formats/export.h"
#include "formats/gltf_document.h"
#include "formats/import.h"
#include "formats/import_parts.h"
#include "scene/scene_labels.h"
#include "scene/scene_reader.h"
#include "scene/scene_runner.h"
#include "tests/memory_sink.h"

#include <gtest/gtest.h>

#include <cstring>

namespace gyre {
namespace {

Scene scene_file(const std::string& name) {
  SceneResult<Scene> scene = open_split_scene(GYRE_SOURCE_DIR "/scenes/" + name);
  EXPECT_TRUE(scene) << scene.error().text();
  return scene ? *std::move(scene) : Scene{};
}

std::uint64_t hash_after(Scene scene, int steps) {
  SceneResult<SceneRunner> runner = SceneRunner::create(std::move(scene), "test");
  if (!runner) {
    ADD_FAILURE() << runner.error().text();
    return 0;
  }
  for (int i = 0; i < steps; ++i) EXPECT_TRUE(runner->step());
  return runner->world().hash();
}

std::string gltf_of(const Scene& scene, bool binary = false) {
  SceneResult<ExportedFile> file = export_gltf(scene, "scene", binary);
  EXPECT_TRUE(file) << file.error().text();
  return file ? file->bytes : "";
}

Scene read_back(const std::string& gltf) {
  SceneResult<Scene> scene = import_scene(gltf, FileFormat::gltf, "a.gltf");
  EXPECT_TRUE(scene) << scene.error().text();
  return scene ? *std::move(scene) : Scene{};
}

// What another program reads: the file without Gyre's own members.
std::string without_extras(const std::string& gltf) {
  Json json = Json::parse(gltf);
  json.erase("extras");
  for (Json& node : json["nodes"]) node.erase("extras");
  return json.dump();
}

TEST(ExportGltf, ScenesReadBackWithTheSameHash) {
  const std::pair<const char*, int> scenes[] = {
      {"machines.gyre.json", 100},    {"height_field.gyre.json", 100},       {"joints/gear.gyre.json", 100},
      {"joints/cone.gyre.json", 100}, {"fields/wind.gyre.json", 100},        {"soft/jelly.gyre.json", 10},
      {"belt.gyre.json", 100},        {"half_wood_half_lead.gyre.json", 100}};
  for (const auto& [name, steps] : scenes) {
    const Scene scene = scene_file(name);
    const bool binary = scene.bodies.size() % 2 == 0;
    EXPECT_EQ(hash_after(read_back(gltf_of(scene, binary)), steps), hash_after(scene, steps)) << name;
  }
}

constexpr const char* kScene = R"({"gyre_scene": 1, "world": {"time_step": 0.016666667},
  "materials": {"rubber": {"density": 1200, "static_friction": 0.9, "dynamic_friction": 0.8, "restitution": 0.5}},
  "meshes": {"tetra": {"vertices": [[0,0,0],[1,0,0],[0,1,0],[0,0,1]], "triangles": [[0,2,1],[0,1,3],[0,3,2],[1,2,3]]}},
  "bodies": [
    {"name": "ground", "type": "static", "shapes": [{"type": "plane", "material": "rubber"}, {"type": "mesh", "mesh": "tetra", "position": [5, 0, 0]}]},
    {"name": "arm", "position": [0, 3, 0], "orientation": [0, 0.6, 0, 0.8], "linear_velocity": [1, 2, 3], "mass": 3, "center_of_mass": [0.1, 0, 0],
     "inertia": [1, 2, 2.5, 0.1, 0.2, 0.3], "filter": {"layer": 4, "collides_with": 9}, "shapes": [{"type": "box", "half_extents": [0.5, 0.1, 0.2]}]},
    {"name": "bob", "position": [2, 3, 0], "shapes": [{"type": "cone", "radius": 0.2, "half_height": 0.3, "position": [0, 0.1, 0], "material": "rubber"}]},
    {"name": "lift", "type": "kinematic", "position": [9, 0, 0], "linear_velocity": [0, 1, 0], "shapes": [{"type": "sphere", "radius": 0.5}]}],
  "joints": [
    {"type": "hinge", "a": "world", "b": "arm", "anchor": [0, 3, 0], "axis": [0, 0, 1], "limits": [-1, 0.5], "motor": {"target_velocity": 2, "max_force": 30}},
    {"type": "distance", "a": "arm", "b": "bob", "anchor": [0.5, 3, 0]}]})";

TEST(ExportGltf, OtherProgramsFindThePhysicsWithoutTheExtras) {
  const SceneResult<Scene> scene = read_scene(kScene);
  ASSERT_TRUE(scene) << scene.error().text();
  const Scene read = read_back(without_extras(gltf_of(*scene)));
  const auto body = [&](const std::string& name) -> const SceneBody& {
    for (const SceneBody& each : read.bodies) {
      if (each.name.rfind(name, 0) == 0) return each;
    }
    ADD_FAILURE() << name;
    return read.bodies.at(0);
  };
  const SceneBody &arm = body("arm"), &bob = body("bob");
  EXPECT_EQ(body("lift").def.type, BodyType::kinematic);
  EXPECT_FLOAT_EQ(arm.def.mass.value_or(0), 3);
  EXPECT_EQ(arm.def.center_of_mass, (Vec3{0.1f, 0, 0}));
  const Sym3 inertia = arm.def.inertia.value_or(Sym3{});
  for (const auto& [value, expected] : {std::pair{inertia.xx, 1.0f},
                                        {inertia.yy, 2.0f},
                                        {inertia.zz, 2.5f},
                                        {inertia.xy, 0.1f},
                                        {inertia.xz, 0.2f},
                                        {inertia.yz, 0.3f}})
    EXPECT_NEAR(value, expected, 1e-5f);
  EXPECT_LT(length(arm.def.linear_velocity - Vec3{1, 2, 3}), 1e-5f);
  EXPECT_NE(arm.filter.layer & 1u, 1u);
  EXPECT_TRUE(std::holds_alternative<Box>(arm.shapes.at(0).geometry));
  const Cone* const cone = std::get_if<Cone>(&bob.shapes.at(0).geometry);
  ASSERT_NE(cone, nullptr);
  EXPECT_FLOAT_EQ(cone->radius, 0.2f);
  EXPECT_NEAR(bob.def.mass.value_or(0), 1200 * kPi * 0.04f * 0.6f / 3, 1e-2f);
  const SceneMaterial& rubber = read.materials.at(std::size_t(bob.shapes[0].material));
  EXPECT_EQ(rubber.name, "rubber");
  EXPECT_FLOAT_EQ(rubber.surface.restitution, 0.5f);
  ASSERT_EQ(read.joints.size(), 2u);
  const HingeDef* hinge = nullptr;
  const DistanceDef* rod = nullptr;
  for (const SceneJoint& joint : read.joints) {
    if (const auto* def = std::get_if<HingeDef>(&joint.def)) hinge = def;
    if (const auto* def = std::get_if<DistanceDef>(&joint.def)) rod = def;
  }
  ASSERT_NE(hinge, nullptr);
  ASSERT_NE(rod, nullptr);
  EXPECT_LT(length(hinge->axis - Vec3{0, 0, 1}), 1e-6f);
  EXPECT_FLOAT_EQ(hinge->limits->low, -1);
  EXPECT_FLOAT_EQ(hinge->limits->high, 0.5f);
  EXPECT_FLOAT_EQ(hinge->motor.target_velocity, 2);
  EXPECT_FLOAT_EQ(hinge->motor.max_force, 30);
  EXPECT_FLOAT_EQ(rod->length.value_or(0), 1.5f);
}

TEST(ExportGltf, AnEditInAnotherProgramCounts) {
  const SceneResult<Scene> scene = read_scene(kScene);
  ASSERT_TRUE(scene);
  Json json = Json::parse(gltf_of(*scene));
  for (Json& node : json["nodes"]) {
    if (node["name"] == "arm") node["extensions"]["KHR_physics_rigid_bodies"]["motion"]["mass"] = 7;
  }
  json["extensions"]["KHR_physics_rigid_bodies"]["physicsJoints"][0]["limits"][2]["max"] = 0.25;
  const Scene read = read_back(json.dump());
  EXPECT_FLOAT_EQ(read.bodies.at(1).def.mass.value_or(0), 7);
  bool found = false;
  for (const SceneJoint& joint : read.joints) {
    const auto* const hinge = std::get_if<HingeDef>(&joint.def);
    if (hinge != nullptr) found = hinge->limits->high == 0.25f;
  }
  EXPECT_TRUE(found);
}

// The numbers of an accessor of a .gltf file with its buffer in it.
std::vector<float> floats_of(Json json, const Json& index, std::size_t width) {
  const Json& accessor = json["accessors"][index.get<std::size_t>()];
  const Json& view = json["bufferViews"][accessor["bufferView"].get<std::size_t>()];
  const std::string uri = json["buffers"][0]["uri"];
  const std::string text = uri.substr(uri.find(',') + 1);
  std::string bytes;
  std::uint32_t bits = 0;
  int count = 0;
  for (const char c : text) {
    const char* const digits = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
    const char* const at = std::strchr(digits, c);
    if (c == '=' || at == nullptr) break;
    bits = bits << 6 | std::uint32_t(at - digits);
    count += 6;
    if (count >= 8) {
      count -= 8;
      bytes += char(bits >> count & 0xffu);
    }
  }
  std::vector<float> out(accessor["count"].get<std::size_t>() * width);
  std::memcpy(out.data(), bytes.data() + view["byteOffset"].get<std::size_t>(), 4 * out.size());
  return out;
}

TEST(ExportGltf, ARecordingBecomesKeysOfItsPoses) {
  SceneResult<SceneRunner> runner = SceneRunner::create(scene_file("soft/flag.gyre.json"), "test");
  ASSERT_TRUE(runner);
  MemorySink sink;
  const BodyId pebble = runner->world().add_body({.pose = {{1, 9, 2}, {}}, .angular_velocity = {3, 0, 0}},
                                                 {ShapeDef{.geometry = Box{{0.1f, 0.2f, 0.3f}}}});
  Recorder recorder(runner->world(), sink, {.commands = false});
  label_bodies(recorder, *runner);
  recorder.label(pebble, "pebble");
  for (int i = 0; i < 12; ++i) ASSERT_TRUE(runner->step());
  ASSERT_TRUE(recorder.finish());
  Result<PoseTrack> track = PoseTrack::open(sink.bytes);
  ASSERT_TRUE(track) << track.error().message;
  const SceneResult<ExportedFile> file = export_gltf(*track, "run", false);
  ASSERT_TRUE(file) << file.error().text();
  const Json json = Json::parse(file->bytes);
  ASSERT_FALSE(track->seek(12));
  int seen = 0;
  for (const Json& channel : json["animations"][0]["channels"]) {
    const Json& node = json["nodes"][channel["target"]["node"].get<std::size_t>()];
    const Json& sampler = json["animations"][0]["samplers"][channel["sampler"].get<std::size_t>()];
    const std::vector<float> times = floats_of(json, sampler["input"], 1);
    EXPECT_NEAR(times.back(), 12 * runner->scene().world.time_step, 1e-6);
    if (node["name"] == "pebble" && channel["target"]["path"] == "translation") {
      ++seen;
      const std::vector<float> places = floats_of(json, sampler["output"], 3);
      EXPECT_EQ(times.size(), 13u);
      EXPECT_NEAR(places[places.size() - 2], runner->world().pose(pebble).position.y, 2e-4);
    }
    if (node["name"] == "flag" && channel["target"]["path"] == "weights") {
      ++seen;
      const Json& primitive = json["meshes"][node["mesh"].get<std::size_t>()]["primitives"][0];
      const std::vector<float> base = floats_of(json, primitive["attributes"]["POSITION"], 3),
                               moved = floats_of(json, primitive["targets"][11]["POSITION"], 3),
                               weights = floats_of(json, sampler["output"], 1);
      EXPECT_EQ(weights.size(), 13u * 12u);
      EXPECT_EQ(weights.back(), 1.0f);
      const DVec3 corner = track->soft_vertices(0).back();
      EXPECT_NEAR(base[base.size() - 3] + moved[moved.size() - 3], corner.x, 1e-5);
    }
  }
  EXPECT_EQ(seen, 2);
}

}  // namespace
}  // namespace gyre
