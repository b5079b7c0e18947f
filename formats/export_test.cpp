// Files for other programs: glTF reads back as the same scene, holds the physics without Gyre's own members, and plays recordings.
#include "formats/export.h"
#include "formats/gltf_document.h"
#include "formats/import.h"
#include "formats/import_parts.h"
#include "formats/vtk_writer.h"
#include "scene/scene_labels.h"
#include "scene/scene_reader.h"
#include "scene/scene_runner.h"

#include <gyre/replay.h>

#include <gtest/gtest.h>

#include <cstring>

namespace gyre::export_test {
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

// The file as another program reads it: without Gyre's own members.
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

std::string from_base64(const std::string& text) {
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
  return bytes;
}

// The numbers of an accessor of a .gltf file with its buffer in it.
std::vector<float> floats_of(Json json, const Json& index, std::size_t width) {
  const Json& accessor = json["accessors"][index.get<std::size_t>()];
  const Json& view = json["bufferViews"][accessor["bufferView"].get<std::size_t>()];
  const std::string uri = json["buffers"][0]["uri"];
  const std::string bytes = from_base64(uri.substr(uri.find(',') + 1));
  std::vector<float> out(accessor["count"].get<std::size_t>() * width);
  std::memcpy(out.data(), bytes.data() + view["byteOffset"].get<std::size_t>(), 4 * out.size());
  return out;
}

struct RecordingSink final : ByteSink {
  bool write(std::span<const std::byte> more) override {
    bytes.insert(bytes.end(), more.begin(), more.end());
    return true;
  }
  std::vector<std::byte> bytes;
};

TEST(ExportGltf, ARecordingBecomesKeysOfItsPoses) {
  SceneResult<SceneRunner> runner = SceneRunner::create(scene_file("soft/flag.gyre.json"), "test");
  ASSERT_TRUE(runner);
  RecordingSink sink;
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

// ------------------------------------------------------------------------------------------------------------------- USD

TEST(ExportUsd, BodiesShapesAndJointsArePrims) {
  const SceneResult<Scene> scene = read_scene(kScene);
  ASSERT_TRUE(scene);
  const SceneResult<ExportedFile> file = export_usd(*scene, "scene");
  ASSERT_TRUE(file) << file.error().text();
  const std::string& text = file->bytes;
  EXPECT_EQ(text.rfind("#usda 1.0", 0), 0u);
  EXPECT_EQ(std::count(text.begin(), text.end(), '{'), std::count(text.begin(), text.end(), '}'));
  for (const char* expected :
       {"def Xform \"arm\" (\n        prepend apiSchemas = [\"PhysicsRigidBodyAPI\", \"PhysicsMassAPI\"]\n   "
        " )\n    {",
        "float physics:mass = 3\n", "point3f physics:centerOfMass = (0.1, 0, 0)",
        "vector3f physics:velocity = (1, 2, 3)", "quatf xformOp:orient = (0.8, 0, 0.6, 0)",
        "bool physics:kinematicEnabled = 1", "def Cone \"bob_shape\"", "def Plane \"ground_shape\"",
        "def Mesh \"ground_shape_2\"", "int[] faceVertexCounts = [3, 3, 3, 3]",
        "float physics:restitution = 0.5", "rel material:binding:physics = </World/material_rubber>",
        "def PhysicsRevoluteJoint", "float physics:upperLimit = 28.6478897",
        "rel physics:body1 = </World/arm>", "float physics:minDistance = 1.5",
        "float physics:gravityMagnitude = 9.81"})
    EXPECT_NE(text.find(expected), std::string::npos) << expected << "\n" << text;
  ASSERT_EQ(file->notes.size(), 1u);
  EXPECT_NE(file->notes[0].find("filter (1)"), std::string::npos) << file->notes[0];
}

// ------------------------------------------------------------------------------------------------------------------- VTK

// The numbers of an array of a VTK file, whose length in bytes stands before them.
template <class T>
std::vector<T> vtk_array(const std::string& file, const std::string& name) {
  const std::size_t tag = file.find(" Name=\"" + name + "\"");
  if (tag == std::string::npos) {
    ADD_FAILURE() << "no array " << name;
    return {};
  }
  const std::size_t begin = file.find('>', tag) + 1;
  const std::string bytes = from_base64(file.substr(begin, file.find('<', begin) - begin));
  std::uint64_t size = 0;
  std::memcpy(&size, bytes.data(), 8);
  EXPECT_EQ(size, bytes.size() - 8) << name;
  std::vector<T> out(std::size_t(size) / sizeof(T));
  std::memcpy(out.data(), bytes.data() + 8, out.size() * sizeof(T));
  return out;
}

constexpr const char* kVtkScene = R"({"gyre_scene": 1, "world": {"time_step": 0.01},
  "bodies": [{"name": "box", "position": [0, 5, 0], "linear_velocity": [1, 0, 0], "shapes": [{"type": "box", "half_extents": [0.5, 1, 2]}]}],
  "ropes": [{"name": "line", "points": [[9, 3, 0], [9, 5, 0]], "segments": 4, "radius": 0.01, "linear_density": 1}],
  "soft_bodies": [{"name": "tetra", "vertices": [[0,0,0],[1,0,0],[0,1,0],[0,0,1]], "tetrahedra": [[0,1,2,3]], "young_modulus": 1e5, "position": [20, 9, 0]}],
  "gases": [{"name": "air & smoke", "bounds": [[-40, 0, 0], [-38, 3, 1]], "cells": [2, 3, 1]}],
  "liquids": [{"name": "water", "bounds": [[40, 0, 0], [41, 1, 1]], "cell_size": 0.25, "fill": [{"box": [[40, 0, 0], [41, 0.5, 1]]}]}]})";

TEST(ExportVtk, FilesHoldTheStateOfEveryKind) {
  SceneResult<Scene> scene = read_scene(kVtkScene);
  ASSERT_TRUE(scene) << scene.error().text();
  SceneResult<SceneRunner> runner = SceneRunner::create(*std::move(scene), "test");
  ASSERT_TRUE(runner) << runner.error().text();
  VtkSeries series;
  EXPECT_EQ(series.add_state(*runner).size(), 6u);
  for (int i = 0; i < 3; ++i) ASSERT_TRUE(runner->step());
  std::map<std::string, std::string> files;
  for (const VtkFile& file : series.add_state(*runner)) files[file.name] = file.bytes;
  const World& world = runner->world();

  const std::string& bodies = files.at("bodies_0_000003.vtp");
  const auto places = vtk_array<double>(bodies, "Points");
  const auto corners = vtk_array<std::int64_t>(bodies, "connectivity");
  EXPECT_EQ(places.size(), 3u * 24);
  EXPECT_EQ(corners.size(), 3u * 12);
  EXPECT_EQ(vtk_array<std::int32_t>(bodies, "body"), std::vector<std::int32_t>(12, 0));
  EXPECT_NEAR(*std::max_element(places.begin(), places.end()), world.pose(runner->bodies()[0]).position.y + 1,
              1e-5);
  EXPECT_FLOAT_EQ(vtk_array<float>(bodies, "velocity")[0], 1.0f);

  const std::string& line = files.at("line_1_000003.vtp");
  EXPECT_EQ(vtk_array<double>(line, "Points")[1], world.vertices(runner->ropes()[0]).position(0).y);
  EXPECT_EQ(vtk_array<std::int64_t>(line, "offsets"), (std::vector<std::int64_t>{5}));
  EXPECT_NE(line.find("NumberOfLines=\"1\""), std::string::npos);
  EXPECT_EQ(vtk_array<float>(line, "strain").size(), world.vertices(runner->ropes()[0]).size());

  const std::string& tetra = files.at("tetra_2_000003.vtu");
  EXPECT_EQ(vtk_array<std::int64_t>(tetra, "connectivity"), (std::vector<std::int64_t>{0, 1, 2, 3}));
  EXPECT_EQ(vtk_array<std::uint8_t>(tetra, "types"), (std::vector<std::uint8_t>{10}));
  EXPECT_EQ(vtk_array<float>(tetra, "stress").size(), 1u);
  EXPECT_EQ(vtk_array<float>(tetra, "strain").size(), 1u);

  const std::string& gas = files.at("air___smoke_3_000003.vti");
  EXPECT_NE(gas.find("WholeExtent=\"0 2 0 3 0 1\" Origin=\"-40 0 0\" Spacing=\"1 1 1\""), std::string::npos)
      << gas;
  EXPECT_EQ(vtk_array<float>(gas, "temperature"), std::vector<float>(6, 293.15f));
  EXPECT_EQ(vtk_array<float>(gas, "velocity").size(), 18u);

  const auto water = vtk_array<double>(files.at("water_4_000003.vtp"), "Points");
  EXPECT_EQ(water.size(), 3 * world.liquid_particles(runner->liquids()[0], {}, {}));
  EXPECT_GT(vtk_array<std::int64_t>(files.at("water_surface_5_000003.vtp"), "connectivity").size(), 20u);

  const std::string list = series.collection("run").bytes;
  EXPECT_NE(list.find("timestep=\"0.03\" part=\"3\" name=\"air___smoke\" file=\"air___smoke_3_000003.vti\""),
            std::string::npos)
      << list;
}

TEST(ExportVtk, SolidsMadeFromBoxesHaveCells) {
  SceneResult<Scene> scene = read_scene(R"({"gyre_scene": 1, "world": {"gravity": [0, 0, 0]}, "soft_bodies": [
    {"name": "jelly", "box": {"half_extents": [1, 0.5, 0.5], "cells": [2, 1, 1]}, "young_modulus": 1e5}]})");
  ASSERT_TRUE(scene) << scene.error().text();
  SceneResult<SceneRunner> runner = SceneRunner::create(*std::move(scene), "test");
  ASSERT_TRUE(runner) << runner.error().text();
  VtkSeries series;
  const std::vector<VtkFile> files = series.add_state(*runner);
  ASSERT_EQ(files.size(), 1u);
  EXPECT_EQ(files[0].name, "jelly_0_000000.vtu");
  const auto points = vtk_array<double>(files[0].bytes, "Points");
  const auto corners = vtk_array<std::int64_t>(files[0].bytes, "connectivity");
  ASSERT_EQ(corners.size() % 4, 0u);
  EXPECT_EQ(vtk_array<std::uint8_t>(files[0].bytes, "types").size(), corners.size() / 4);
  const auto point = [&](std::int64_t i) {
    return DVec3{points[std::size_t(3 * i)], points[std::size_t(3 * i + 1)], points[std::size_t(3 * i + 2)]};
  };
  double volume = 0.0;
  for (std::size_t i = 0; i < corners.size(); i += 4) {
    const DVec3 o = point(corners[i]);
    const double six =
        dot(point(corners[i + 1]) - o, cross(point(corners[i + 2]) - o, point(corners[i + 3]) - o));
    EXPECT_GT(six, 0.0) << i;
    volume += six / 6.0;
  }
  EXPECT_NEAR(volume, 2.0, 1.0e-6);
}

}  // namespace
}  // namespace gyre::export_test
