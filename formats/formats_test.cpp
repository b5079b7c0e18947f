// Files of other programs: what they say becomes motion that is known in numbers, and files that are wrong are refused with their place.
#include "formats/import.h"
#include "scene/mesh_file.h"
#include "scene/scene_runner.h"
#include "scene/scene_writer.h"

#include <gtest/gtest.h>

#include <cmath>
#include <cstring>

namespace gyre::formats_test {
namespace {

Scene open_example(const std::string& name, const ImportOptions& options = {}) {
  SceneResult<Scene> scene = open_scene(GYRE_SOURCE_DIR "/scenes/formats/" + name, options);
  if (!scene) {
    ADD_FAILURE() << scene.error().text();
    return {};
  }
  return *std::move(scene);
}

SceneRunner run_scene(Scene scene, double time_step) {
  scene.world.time_step = time_step;
  SceneResult<SceneRunner> runner = SceneRunner::create(std::move(scene), "test");
  EXPECT_TRUE(runner) << runner.error().text();
  return *std::move(runner);
}

std::size_t index_of(const Scene& scene, const std::string& name) {
  for (std::size_t i = 0; i < scene.bodies.size(); ++i) {
    if (scene.bodies[i].name == name) return i;
  }
  ADD_FAILURE() << "no body " << name;
  return 0;
}
BodyId body_in(const SceneRunner& runner, const std::string& name) {
  return runner.bodies()[index_of(runner.scene(), name)];
}

const SceneJoint& joint_in(const Scene& scene, const std::string& name) {
  for (const SceneJoint& joint : scene.joints) {
    if (joint.name == name) return joint;
  }
  ADD_FAILURE() << "no joint " << name;
  return scene.joints.at(0);
}

// ---------------------------------------------------------------------------------------------------------------- meshes

std::string little(const void* value, std::size_t size) { return {static_cast<const char*>(value), size}; }

std::string binary_stl(std::uint32_t announced) {
  std::string out(80, 's');
  out += little(&announced, 4);
  const float corners[2][9] = {{0, 0, 0, 1, 0, 0, 0, 1, 0}, {0, 0, 0, 0, 1, 0, 0, 0, 1}};
  for (const auto& triangle : corners) {
    out += std::string(12, '\0') + little(triangle, 36) + std::string(2, '\0');
  }
  return out;
}

constexpr const char* kTextStl =
    "solid two words\nfacet normal 0 0 1\nouter loop\nvertex 0 0 0\nvertex 1 0 0\nvertex 0 1 "
    "0\nendloop\nendfacet\n"
    "facet normal 1 0 0\nouter loop\nvertex 0 0 0\nvertex 0 1 0\nvertex 0 0 1e0\nendloop\nendfacet\nendsolid "
    "two words\n";

TEST(MeshFormats, TextAndBinaryStlGiveTheSameWeldedMesh) {
  const SceneResult<MeshData> text = parse_mesh(kTextStl, "a.stl", {}),
                              binary = parse_mesh(binary_stl(2), "A.STL", {});
  ASSERT_TRUE(text) << text.error().text();
  ASSERT_TRUE(binary) << binary.error().text();
  EXPECT_EQ(text->vertices.size(), 4u);
  EXPECT_EQ(text->vertices, binary->vertices);
  EXPECT_EQ(text->indices, (std::vector<std::uint32_t>{0, 1, 2, 0, 2, 3}));
  EXPECT_EQ(text->indices, binary->indices);
}

TEST(MeshFormats, DamagedStlIsRefused) {
  EXPECT_FALSE(parse_stl(binary_stl(3), "a.stl", {}));  // announces more than there is
  EXPECT_FALSE(parse_stl(binary_stl(0xffffffffu), "a.stl", {}));
  EXPECT_FALSE(parse_stl("solid\nfacet normal 0 0 1\nvertex 0 0 inf\n", "a.stl", {}));
  EXPECT_FALSE(parse_stl("solid\nvertex 0 0 0\nvertex 0 0 1\n", "a.stl", {}));
  EXPECT_FALSE(parse_stl("", "a.stl", {}));
  SceneLimits one;
  one.triangles = 1;
  EXPECT_FALSE(parse_stl(kTextStl, "a.stl", one));
  EXPECT_FALSE(parse_stl(binary_stl(2), "a.stl", one));
}

TEST(MeshFormats, PlyOfAllEncodingsGivesTheSameMesh) {
  const std::string head =
      " 1.0\ncomment a square\nelement vertex 4\nproperty float x\nproperty float y\nproperty uchar "
      "red\nproperty double z\n"
      "element face 1\nproperty list uchar int vertex_indices\nend_header\n";
  const auto ply = [&](bool big) {
    std::string out =
        std::string("ply\nformat ") + (big ? "binary_big_endian" : "binary_little_endian") + head;
    const auto put = [&](const void* value, std::size_t size) {
      std::string bytes = little(value, size);
      if (big) bytes = {bytes.rbegin(), bytes.rend()};
      out += bytes;
    };
    for (const auto& corner : {std::pair{0.0f, 0.0f}, {1.0f, 0.0f}, {1.0f, 1.0f}, {0.0f, 1.0f}}) {
      const double z = 0.5;
      put(&corner.first, 4), put(&corner.second, 4);
      out += 'r';
      put(&z, 8);
    }
    out += char(4);
    for (const std::int32_t i : {0, 1, 2, 3}) put(&i, 4);
    return out;
  };
  const SceneResult<MeshData> text = parse_mesh(
      "ply\nformat ascii" + head + "0 0 9 .5\n1 0 9 .5\n1 1 9 .5\n0 1 9 .5\n4 0 1 2 3\n", "a.ply", {});
  ASSERT_TRUE(text) << text.error().text();
  EXPECT_EQ(text->vertices.size(), 4u);
  EXPECT_EQ(text->indices.size(), 6u);
  EXPECT_EQ(text->vertices[2], (Vec3{1, 1, 0.5f}));
  for (const bool big : {false, true}) {
    const SceneResult<MeshData> binary = parse_mesh(ply(big), "a.ply", {});
    ASSERT_TRUE(binary) << binary.error().text();
    EXPECT_EQ(binary->vertices, text->vertices);
    EXPECT_EQ(binary->indices, text->indices);
  }
  EXPECT_FALSE(parse_ply("ply\nformat ascii" + head + "0 0 9 .5\n1 0 9 .5\n1 1 9 .5\n0 1 9 .5\n4 0 1 2 4\n",
                         "a.ply", {}));
  EXPECT_FALSE(parse_ply(ply(false).substr(0, ply(false).size() - 1), "a.ply", {}));
}

// ------------------------------------------------------------------------------------------------------------------ glTF

TEST(Gltf, CombinesRestitutionByTheRuleOfItsMaterials) {
  // "maximum" of 0.8 and 0: from 1 m above the floor the ball rises to 0.64 m; its centre to 0.74 m.
  SceneRunner runner = run_scene(open_example("playground.gltf"), 0.005);
  const BodyId ball = body_in(runner, "ball");
  double highest = 0;
  for (int i = 0; i < 200; ++i) {
    ASSERT_TRUE(runner.step());
    if (i > 100) highest = std::max(highest, runner.world().pose(ball).position.y);
  }
  EXPECT_NEAR(highest, 0.74, 0.002);
}

TEST(Gltf, FiltersTriggersHullsColoursAndJointsReachTheScene) {
  const Scene scene = open_example("playground.gltf");
  EXPECT_TRUE(scene.notes.empty());
  EXPECT_TRUE(scene.bodies[index_of(scene, "zone")].sensor);
  EXPECT_EQ(scene.bodies[index_of(scene, "ball")].shapes[0].color, (SceneColor{255, 0, 128}));
  EXPECT_EQ(scene.bodies[index_of(scene, "cart")].color, (SceneColor{255, 0, 128}));
  EXPECT_TRUE(std::holds_alternative<SceneHull>(scene.bodies[index_of(scene, "cart")].shapes[0].geometry));
  const auto* hinge = std::get_if<HingeDef>(&joint_in(scene, "arm pivot").def);
  ASSERT_NE(hinge, nullptr);
  EXPECT_EQ(hinge->axis, (Vec3{0, 0, 1}));
  EXPECT_EQ(hinge->limits->low, -1.0f);
  EXPECT_EQ(hinge->limits->high, 0.5f);

  SceneRunner runner = run_scene(scene, 0.01);
  for (int i = 0; i < 100; ++i) ASSERT_TRUE(runner.step());
  // Its filter lets the ghost fall through the floor; 4 kg on 4 pi^2 N/m swing with 0.5 Hz about a target of 0.25 m.
  EXPECT_NEAR(runner.world().pose(body_in(runner, "ghost")).position.y, 0.5 - 0.5 * 9.81, 0.03);
  EXPECT_NEAR(runner.world().pose(body_in(runner, "cart")).position.x, 3.5, 1e-3);
  // The mesh of 0.2 m is scaled by 2: a solid cube of 0.4 m.
  EXPECT_NEAR(runner.world().mass_properties(body_in(runner, "cart")).inertia.xx, 4 * 0.16 / 6, 1e-5);
}

std::string as_glb(std::string json, const std::string& binary) {
  while (json.size() % 4 != 0) json += ' ';
  const auto u32 = [](std::size_t value) {
    const std::uint32_t out = std::uint32_t(value);
    return little(&out, 4);
  };
  return "glTF" + u32(2) + u32(28 + json.size() + binary.size()) + u32(json.size()) + "JSON" + json +
         u32(binary.size()) + std::string("BIN\0", 4) + binary;
}

TEST(Gltf, MeshesOfABinaryFileWithoutPhysicsStandStill) {
  const float triangle[9] = {0, 0, 0, 1, 0, 0, 0, 1, 0};
  const std::string json =
      R"({"asset": {"version": "2.0"}, "buffers": [{"byteLength": 36}], "bufferViews": [{"buffer": 0, "byteLength": 36}],
          "accessors": [{"bufferView": 0, "componentType": 5126, "count": 3, "type": "VEC3"}],
          "meshes": [{"primitives": [{"attributes": {"POSITION": 0}}]}],
          "nodes": [{"scale": [2, 2, 2], "children": [1]}, {"name": "leaf", "mesh": 0, "rotation": [0, 0.70710678, 0, 0.70710678], "translation": [1, 0, 0]}]})";
  const SceneResult<Scene> scene =
      import_scene(as_glb(json, little(triangle, 36)), FileFormat::gltf, "a.glb");
  ASSERT_TRUE(scene) << scene.error().text();
  ASSERT_EQ(scene->bodies.size(), 1u);
  EXPECT_EQ(scene->bodies[0].def.type, BodyType::fixed);
  const Vec3 corner = to_float(scene->bodies[0].def.pose * scene->meshes[0].vertices[1]);
  EXPECT_NEAR(length(corner - Vec3{2, 0, -2}), 0, 1e-5);
}

TEST(Gltf, DamagedFilesAreRefusedWithTheirPlace) {
  const auto refused = [](const std::string& text, const std::string& expected) {
    const SceneResult<Scene> scene = import_scene(text, FileFormat::gltf, "a.gltf");
    ASSERT_FALSE(scene) << text;
    EXPECT_NE(scene.error().text().find(expected), std::string::npos) << scene.error().text();
  };
  const std::string begin = R"({"asset": {"version": "2.0"}, )";
  refused("", "a.gltf");
  refused("{}", "/asset/version");
  refused(begin + R"("extensionsRequired": ["KHR_draco_mesh_compression"]})", "which is not read");
  refused(begin + R"("nodes": [{"children": [1]}, {"children": [0]}], "scenes": [{"nodes": [0]}]})",
          "two parents");
  refused(begin + R"("nodes": [{"children": [7]}]})", "/nodes/0/children");
  refused(begin + R"("nodes": [{"translation": [1e300, 0, 0]}]})", "/translation");
  refused(begin + R"("nodes": [{"scale": [0, 1, 1]}]})", "singular");
  refused(begin + R"("nodes": [{"mesh": 3}]})", "/meshes/3");
  const std::string mesh =
      R"("nodes": [{"mesh": 0}], "meshes": [{"primitives": [{"attributes": {"POSITION": 0}}]}], )";
  const auto accessor = [&](const std::string& view, const std::string& count) {
    return begin + mesh +
           R"("buffers": [{"byteLength": 12, "uri": "data:;base64,AAAAAAAAAAAAAAAA"}], "bufferViews": [{"buffer": 0, )" +
           view + R"(}], "accessors": [{"bufferView": 0, "componentType": 5126, "type": "VEC3", "count": )" +
           count + "}]}";
  };
  refused(accessor(R"("byteLength": 12)", "2"), "reaches out");
  refused(accessor(R"("byteLength": 9000)", "1"), "outside of its buffer");
  refused(accessor(R"("byteLength": 12, "byteOffset": -4)", "1"), "outside of its buffer");
  refused(accessor(R"("byteLength": 12)", "4000000000000000000"), "limit");
  refused(
      begin + mesh + R"("accessors": [{"bufferView": 0, "componentType": 5126, "type": "VEC3", "count": 1}],
      "bufferViews": [{"buffer": 0, "byteLength": 12}], "buffers": [{"byteLength": 12, "uri": "http://host/a.bin"}]})",
      "nothing is fetched");
  refused("glTF" + std::string("\2\0\0\0\xff\0\0\0\xff\xff\xff\xffJSON{}", 18), "longer than the file");
}

#ifdef GYRE_WITH_XML

// ------------------------------------------------------------------------------------------------------------------ URDF

TEST(Urdf, APendulumSwingsWithThePeriodOfItsInertia) {
  const Scene scene = open_example("pendulum.urdf");
  EXPECT_TRUE(scene.notes.empty());
  const SceneBody& rod = scene.bodies[index_of(scene, "rod")];
  EXPECT_NEAR(*rod.def.mass, 1.000001f, 1e-6f);  // the bob, at the end of a fixed joint, is part of it
  EXPECT_EQ(rod.shapes[0].color, (SceneColor{204, 26, 26}));
  SceneRunner runner = run_scene(scene, 0.001);
  const BodyId body = body_in(runner, "rod");
  std::vector<double> crossings;
  for (double last = runner.world().center_of_mass(body).z; crossings.size() < 3;) {
    ASSERT_TRUE(runner.step());
    const double now = runner.world().center_of_mass(body).z;
    if (now * last < 0) crossings.push_back(runner.time() - 0.001 * now / (now - last));
    last = now;
  }
  const double exact = 2 * kPiDouble * std::sqrt((0.0835416667 + 0.25) / (9.81 * 0.5)) * (1 + 0.01 / 16);
  EXPECT_NEAR(crossings[2] - crossings[0], exact, 2e-4 * exact);
}

TEST(Urdf, AMimicJointTurnsInItsRatio) {
  SceneRunner runner = run_scene(open_example("pendulum.urdf"), 0.01);
  const BodyId wheel = body_in(runner, "wheel"), follower = body_in(runner, "follower");
  runner.world().set_velocity(wheel, {}, {0, 3, 0});
  for (int i = 0; i < 50; ++i) ASSERT_TRUE(runner.step());
  const float leading = runner.world().angular_velocity(wheel).y;
  EXPECT_GT(leading, 0.5f);
  EXPECT_NEAR(runner.world().angular_velocity(follower).y, -2 * leading, 1e-3f);
}

// Slides and hinges on bodies that move, with an offset; and a tendon that keeps the sum of two hinges.
TEST(Couplings, OfRobotsHoldBetweenMovingBodies) {
  const char* const link = R"(<inertial><mass value="1"/><inertia ixx="1" ixy="0" ixz="0" iyy="1" iyz="0" izz="1"/></inertial>)";
  const std::string urdf = std::string(R"(<robot name="r"><link name="a"/><link name="hand">)") + link +
                           R"(</link><link name="left">)" + link + R"(</link><link name="right">)" + link +
                           R"(</link><joint name="wrist" type="continuous"><parent link="a"/><child link="hand"/></joint>
    <joint name="left" type="prismatic"><parent link="hand"/><child link="left"/><axis xyz="0 1 0"/><limit lower="-1" upper="1"/></joint>
    <joint name="right" type="prismatic"><parent link="hand"/><child link="right"/><axis xyz="0 -1 0"/><limit lower="-1" upper="1"/>
      <mimic joint="left" multiplier="0.5" offset="0.1"/></joint></robot>)";
  const SceneResult<Scene> scene = import_scene(urdf, FileFormat::urdf, "a.urdf");
  ASSERT_TRUE(scene) << scene.error().text();
  ASSERT_EQ(scene->couplings.size(), 1u);
  EXPECT_EQ(scene->couplings[0].terms[1].coefficient, -0.5f);
  EXPECT_EQ(scene->couplings[0].offset, 0.1f);
  SceneRunner runner = run_scene(*scene, 0.005);
  for (int i = 0; i < 200; ++i) ASSERT_TRUE(runner.step());
  const auto place = [&](std::size_t joint) {
    return double(runner.world().joint_axis_state(runner.joints()[joint], JointAxis::linear_x).position);
  };
  EXPECT_NEAR(place(2), 0.5 * place(1) + 0.1, 1e-3);
  const SceneResult<Scene> model = import_scene(
      R"(<mujoco><worldbody><body><joint name="a" axis="0 1 0"/><geom size="0.1"/><body pos="0 0 1"><joint name="b" axis="0 1 0"/>
        <geom size="0.1" pos="0 0 0.5"/></body></body></worldbody>
        <tendon><fixed name="sum"><joint joint="a" coef="1"/><joint joint="b" coef="2"/></fixed></tendon>
        <equality><tendon tendon1="sum"/><joint joint1="b" joint2="a" polycoef="0.2 -0.5 0 0 0"/></equality></mujoco>)",
      FileFormat::mjcf, "a.xml");
  ASSERT_TRUE(model) << model.error().text();
  ASSERT_EQ(model->couplings.size(), 2u);
  EXPECT_EQ(model->couplings[0].terms[1].coefficient, 2.0f);
  EXPECT_EQ(model->couplings[0].offset, 0.0f);
  EXPECT_EQ(model->couplings[1].terms[1].coefficient, 0.5f);
  EXPECT_EQ(model->couplings[1].offset, 0.2f);
}

TEST(Urdf, OptionsFreeTheBaseAndKeepFixedJoints) {
  ImportOptions options;
  options.free_base = true;
  options.keep_fixed = true;
  const Scene scene = open_example("pendulum.urdf", options);
  EXPECT_EQ(scene.bodies[index_of(scene, "stand")].def.type, BodyType::dynamic);
  EXPECT_EQ(scene.bodies.size(), 5u);
  EXPECT_TRUE(std::holds_alternative<FixedDef>(joint_in(scene, "tip").def));
  EXPECT_EQ(scene.bodies[0].filter.group, -1);
  options.self_collision = true;
  EXPECT_EQ(open_example("pendulum.urdf", options).bodies[0].filter, Filter{});
}

TEST(Urdf, AnInertiaOfZeroIsThatOfTheShapesAndFixedJointsNeedNoAxis) {
  const SceneResult<Scene> scene = import_scene(
      R"(<robot name="r"><link name="a"/><link name="b"><inertial><mass value="6"/><origin xyz="0 0 1"/>
        <inertia ixx="0" ixy="0" ixz="0" iyy="0" iyz="0" izz="0"/></inertial>
        <collision><geometry><box size="1 2 3"/></geometry></collision></link><link name="c"/>
      <joint name="j" type="spherical"><parent link="a"/><child link="b"/></joint>
      <joint name="k" type="fixed"><axis xyz="0 0 0"/><parent link="b"/><child link="c"/></joint></robot>)",
      FileFormat::urdf, "a.urdf");
  ASSERT_TRUE(scene) << scene.error().text();
  const BodyDef& body = scene->bodies[index_of(*scene, "b")].def;
  EXPECT_FLOAT_EQ(body.mass.value_or(0), 6);
  EXPECT_FLOAT_EQ(body.inertia->xx, 6.5f);
  EXPECT_FLOAT_EQ(body.inertia->zz, 2.5f);
  EXPECT_EQ(*body.center_of_mass, (Vec3{0, 0, 1}));
  EXPECT_TRUE(std::holds_alternative<BallDef>(joint_in(*scene, "j").def));
  EXPECT_EQ(scene->notes.size(), 1u);
}

SceneResult<Scene> import_xml(const std::string& text, const ImportOptions& options = {}) {
  return import_scene(text, FileFormat::urdf, "a.urdf", options);
}
void expect_refused(const std::string& text, const std::string& expected) {
  ImportOptions options;
  options.open_files = false;
  const SceneResult<Scene> scene = import_xml(text, options);
  ASSERT_FALSE(scene) << text;
  EXPECT_NE(scene.error().text().find(expected), std::string::npos) << scene.error().text();
}

TEST(Urdf, DamagedFilesAreRefusedWithTheirLine) {
  const std::string two = R"(<robot name="r"><link name="a"/><link name="b"/>)";
  const auto joint = [&](const std::string& type, const std::string& inside) {
    return two + "\n<joint name=\"j\" type=\"" + type + "\"><parent link=\"a\"/><child link=\"b\"/>" +
           inside + "</joint></robot>";
  };
  expect_refused("", "XML");
  expect_refused("<robot>", "XML");
  expect_refused("<sdf/>", "expected <robot>");
  expect_refused("<robot/>", "no <link>");
  expect_refused(two + "</robot>", "two links without a parent");
  expect_refused(joint("revolute", ""), "a.urdf:2:1: <joint>: found no <limit>");
  expect_refused(joint("revolute", R"(<limit lower="2" upper="1"/>)"), "lower limit above");
  expect_refused(joint("spiral", ""), "\"spiral\"");
  expect_refused(joint("continuous", R"(<axis xyz="0 0 0"/>)"), "no length");
  expect_refused(joint("continuous", R"(<axis xyz="0 nan 0"/>)"), "finite numbers");
  expect_refused(joint("continuous", "<axis xyz=\"0&#10;x 0\"/>"), "\"0 x 0\"");  // on one line
  expect_refused(joint("continuous", R"(<origin xyz="1e300 0 0"/>)"), "at most 1e12");
  expect_refused(two + R"(<joint name="j" type="fixed"><parent link="a"/><child link="c"/></joint></robot>)",
                 "name of a link");
  expect_refused(two + R"(<joint name="j" type="fixed"><parent link="a"/><child link="b"/></joint>
                          <joint name="k" type="fixed"><parent link="b"/><child link="a"/></joint></robot>)",
                 "a ring");
  expect_refused(
      R"(<robot><link name="a"><collision><geometry><mesh filename="http://host/a.stl"/></geometry></collision></link></robot>)",
      "no files can be opened");
  expect_refused(
      R"(<robot><link name="a"><collision><geometry><sphere radius="-1"/></geometry></collision></link></robot>)",
      "above 0");
  // Entities are not expanded, and depth is limited.
  expect_refused(R"(<!DOCTYPE r [<!ENTITY e "aaaa">]><robot><link name="&e;" /><link name="&e;"/></robot>)",
                 "second link");
  std::string deep;
  for (int i = 0; i < 100000; ++i) deep += "<a>";
  expect_refused(deep, "nested too deep");
}

TEST(Urdf, LeftOutElementsAreCountedAndStrictRefusesThem) {
  const std::string text = R"(<robot name="r"><link name="a"/><gazebo/><gazebo/><transmission/></robot>)";
  const SceneResult<Scene> scene = import_xml(text);
  ASSERT_TRUE(scene) << scene.error().text();
  ASSERT_EQ(scene->notes.size(), 1u);
  EXPECT_EQ(scene->notes[0], "a.urdf: not simulated: <gazebo> (2), <transmission> (1)");
  ImportOptions strict;
  strict.strict = true;
  EXPECT_FALSE(import_xml(text, strict));
}

// ------------------------------------------------------------------------------------------------------------------ MJCF

TEST(Mjcf, ASpringedCartAFallingBallAndAnArmMoveAsComputed) {
  const Scene scene = open_example("hopper.xml");
  EXPECT_TRUE(scene.notes.empty());
  EXPECT_EQ(scene.world.time_step, 0.002);
  const auto* elbow = std::get_if<UniversalDef>(&joint_in(scene, "elbow_x").def);
  ASSERT_NE(elbow, nullptr);
  EXPECT_EQ(elbow->damping, 0.02f);  // of its default class
  EXPECT_EQ(elbow->angular_z.limits.high, 2.0f);
  EXPECT_EQ(scene.bodies[index_of(scene, "ball")].shapes[0].color, (SceneColor{51, 102, 204}));
  SceneRunner runner = run_scene(scene, 0.002);
  for (int i = 0; i < 500; ++i) ASSERT_TRUE(runner.step());
  // 4 kg on 4 pi^2 N/m: after half of a period of 2 s the cart is as far beyond the rest of the spring, -0.25 m, as it began before it.
  EXPECT_NEAR(runner.world().pose(body_in(runner, "cart")).position.x, -0.5, 1e-4);
  EXPECT_NEAR(runner.world().pose(body_in(runner, "ball")).position.y, 0.1, 1e-3);
  // The hand of 0.5 kg is welded to the forearm of 1 kg.
  EXPECT_NEAR(runner.world().mass_properties(body_in(runner, "lower")).mass, 1.5f, 1e-6f);
}

TEST(Mjcf, AngleUnitsOrientationsAndContactBitsAreRead) {
  const SceneResult<Scene> scene =
      import_scene(R"(<mujoco><worldbody><geom type="plane" contype="1" conaffinity="0"/>
      <body name="a" euler="0 0 90" pos="0 0 5"><joint name="h" range="-90 45"/><geom type="box" size=".1 .2 .3" contype="0" conaffinity="1"/>
        <geom mesh="nowhere" contype="0" conaffinity="0" mass="0" group="2"/><inertial pos="0 0 0" mass="2" diaginertia="1 1 1"/></body>
      <body name="b" quat="0.70710678 0 0 0.70710678"><freejoint/><geom size="1" contype="2" conaffinity="2"/></body></worldbody>
      <sensor><gyro site="s"/><gyro site="t"/></sensor></mujoco>)",
                   FileFormat::mjcf, "a.xml");
  ASSERT_TRUE(scene) << scene.error().text();
  const SceneBody &world = scene->bodies[index_of(*scene, "worldbody")],
                  &a = scene->bodies[index_of(*scene, "a")], &b = scene->bodies[index_of(*scene, "b")];
  EXPECT_NEAR(std::get<HingeDef>(joint_in(*scene, "h").def).limits->low, -0.5f * kPi, 1e-6f);
  EXPECT_NEAR(length(rotate(a.def.pose.orientation, {1, 0, 0}) - rotate(b.def.pose.orientation, {1, 0, 0})),
              0, 1e-5);
  EXPECT_NEAR(length(rotate(a.def.pose.orientation, {1, 0, 0}) - Vec3{0, 0, -1}), 0,
              1e-5);  // y of the file is -z of the scene
  const auto collide = [](const Filter& x, const Filter& y) {
    return (x.collides_with & y.layer) != 0 && (y.collides_with & x.layer) != 0;
  };
  EXPECT_TRUE(collide(world.filter, a.filter));
  EXPECT_FALSE(collide(world.filter, b.filter));
  EXPECT_FALSE(collide(a.filter, b.filter));
  EXPECT_EQ(scene->notes[0], "a.xml: not simulated: sensor <gyro> (2)");
}

// An arm of 1 kg at the end of 0.3 m, which is level, and a wheel that turns about the same axis.
std::string coupled_by(const std::string& more) {
  return R"(<mujoco><compiler angle="radian"/><worldbody>
    <body name="arm" pos="0 0 1"><joint name="p" axis="0 1 0"/><geom type="sphere" size="0.05" pos="0.3 0 0" mass="1"/></body>
    <body name="wheel" pos="2 0 1"><joint name="q" axis="0 1 0"/><geom type="sphere" size="0.1" mass="1"/></body></worldbody>)" +
         more + "</mujoco>";
}

TEST(Mjcf, AFixedTendonThatAnEqualityHoldsCouplesTwoHinges) {
  const std::string tendon =
      "<tendon><fixed name='t'><joint joint='p' coef='1'/><joint joint='q' coef='-0.5'/></fixed></tendon>";
  const SceneResult<Scene> scene = import_scene(
      coupled_by(tendon + "<equality><tendon tendon1='t'/></equality>"), FileFormat::mjcf, "a.xml");
  ASSERT_TRUE(scene) << scene.error().text();
  EXPECT_TRUE(scene->notes.empty()) << scene->notes[0];
  SceneRunner runner = run_scene(*scene, 0.002);
  for (int i = 0; i < 100; ++i) ASSERT_TRUE(runner.step());
  const double arm = runner.world().angular_velocity(body_in(runner, "arm")).z;
  EXPECT_GT(std::abs(arm), 0.5);  // it falls
  EXPECT_NEAR(runner.world().angular_velocity(body_in(runner, "wheel")).z, 2 * arm, 1e-3);
}

TEST(Mjcf, TendonsThatExertNothingAreNoNoteAndOthersAreCounted) {
  const SceneResult<Scene> idle = import_scene(
      coupled_by(
          "<tendon><fixed name='t'><joint joint='p' coef='1'/><joint joint='q' coef='1'/></fixed></tendon>"),
      FileFormat::mjcf, "a.xml");
  ASSERT_TRUE(idle) << idle.error().text();
  EXPECT_TRUE(idle->notes.empty());
  const SceneResult<Scene> others = import_scene(
      coupled_by("<tendon><fixed name='t' stiffness='3' range='0 1'><joint joint='p' coef='1'/></fixed>"
                 "<spatial/></tendon><equality><tendon tendon1='t'/></equality>"),
      FileFormat::mjcf, "a.xml");
  ASSERT_TRUE(others) << others.error().text();
  EXPECT_EQ(others->notes[0],
            "a.xml: not simulated: equality <tendon> (1), limits of a fixed tendon (1), stiffness of a fixed "
            "tendon (1), tendon <spatial> (1)");
  const SceneResult<Scene> wrong =
      import_scene(coupled_by("<tendon><fixed name='t'><joint joint='r' coef='1'/></fixed></tendon>"),
                   FileFormat::mjcf, "a.xml");
  ASSERT_FALSE(wrong);
  EXPECT_NE(wrong.error().text().find("found joint \"r\""), std::string::npos) << wrong.error().text();
}

TEST(Mjcf, JointsWithoutACounterpartGetALightBodyBetween) {
  const SceneResult<Scene> scene =
      import_scene(R"(<mujoco><compiler angle="radian"/><worldbody><body name="a" pos="0 0 1">
      <joint name="x" axis="1 0 0"/><joint name="y" axis="0 1 0" pos="0.5 0 0"/><geom size="0.1"/></body></worldbody></mujoco>)",
                   FileFormat::mjcf, "a.xml");
  ASSERT_TRUE(scene) << scene.error().text();
  EXPECT_EQ(scene->bodies.size(), 3u);
  EXPECT_TRUE(std::holds_alternative<HingeDef>(joint_in(*scene, "x").def));
  EXPECT_TRUE(std::holds_alternative<HingeDef>(joint_in(*scene, "y").def));
  EXPECT_EQ(scene->notes.size(), 1u);
}

TEST(Mjcf, DamagedFilesAreRefused) {
  const auto body = [](const std::string& inside) {
    return "<mujoco><worldbody><body>" + inside + "</body></worldbody></mujoco>";
  };
  expect_refused("<mujoco/>", "worldbody");
  expect_refused(body(R"(<joint type="screw"/>)"), "\"screw\"");
  expect_refused(body(R"(<geom size="0"/>)"), "above 0");
  expect_refused(body(R"(<geom type="capsule" size="1"/>)"), "expected 2");
  expect_refused(body(R"(<geom class="none" size="1"/>)"), "no default class");
  expect_refused(body(R"(<body><freejoint/></body>)"), "free joint");
  expect_refused(R"(<mujoco><include file="a.xml"/></mujoco>)", "no files can be opened");
  expect_refused(R"(<mujoco><compiler eulerseq="abc"/><worldbody/></mujoco>)", "eulerseq");
  std::string deep;
  for (int i = 0; i < 400; ++i) deep += "<body>";
  for (int i = 0; i < 400; ++i) deep += "</body>";
  expect_refused("<mujoco><worldbody>" + deep + "</worldbody></mujoco>", "nested too deep");
}

// ------------------------------------------------------------------------------------------------------------- MuJoCo

// The places of the bodies of a model after 2 s: the centre of mass (m) and the orientation (w, x, y, z) in the frame of the file, which has
// z up. MuJoCo 3.14 (npm package @mujoco/mujoco) computed them with its RK4 integrator and steps of 0.2 ms.
struct MujocoBody {
  const char* name;
  double center[3], orientation[4];
};
struct MujocoModel {
  const char* xml;
  std::vector<MujocoBody> bodies;
};

MujocoModel mujoco_pendulum() {
  return {R"(<mujoco><option timestep="0.0002" integrator="RK4" gravity="0 0 -9.81"/><worldbody>
<body name="rod" pos="0 0 2"><joint name="pivot" type="hinge" axis="0 1 0" damping="0.02"/><geom type="capsule" fromto="0 0 0 0.6 0 -0.1" size="0.03" mass="1.2"/></body>
</worldbody></mujoco>)",
          {{"rod", {-0.2292629, 0.0000000, 1.8001537}, {0.4268897, 0.0000000, 0.9043037, 0.0000000}}}};
}

MujocoModel mujoco_cart_pole() {
  return {R"(<mujoco><option timestep="0.0002" integrator="RK4"/><worldbody>
<body name="cart" pos="0 0 1"><joint name="rail" type="slide" axis="1 0 0" damping="0.5"/><geom type="box" size="0.2 0.1 0.05" mass="2"/>
 <body name="pole" pos="0 0 0.1"><joint name="hinge" type="hinge" axis="0 1 0" stiffness="0.5"/><geom type="capsule" fromto="0 0 0 0.1 0 0.8" size="0.03" mass="0.4"/></body></body>
</worldbody></mujoco>)",
          {{"cart", {-0.0252183, 0.0000000, 1.0000000}, {1.0000000, 0.0000000, 0.0000000, 0.0000000}},
           {"pole", {0.2191432, 0.0000000, 1.4206048}, {0.9654971, 0.0000000, 0.2604139, 0.0000000}}}};
}

MujocoModel mujoco_arm() {
  return {R"(<mujoco><compiler angle="radian"/><option timestep="0.0002" integrator="RK4"/>
<default><joint damping="0.8" armature="0"/><geom contype="0" conaffinity="0"/></default><worldbody>
<body name="l1" pos="0 0 0.3"><joint name="j1" axis="0 0 1"/><geom type="cylinder" size="0.08 0.1" mass="4"/>
<body name="l2" pos="0 0 0.15"><joint name="j2" axis="0 1 0"/><geom type="capsule" fromto="0 0 0 0 0 0.4" size="0.05" mass="3"/>
<body name="l3" pos="0 0 0.4"><joint name="j3" axis="0 1 0"/><geom type="capsule" fromto="0 0 0 0.3 0 0.1" size="0.04" mass="2"/>
<body name="l4" pos="0.3 0 0.1"><joint name="j4" axis="1 0 0"/><geom type="box" size="0.1 0.04 0.03" pos="0.1 0 0.02" mass="1"/>
<body name="l5" pos="0.2 0 0"><joint name="j5" axis="0 1 0"/><geom type="capsule" fromto="0 0 0 0.1 0 0.05" size="0.03" mass="0.6"/>
<body name="l6" pos="0.1 0 0.05"><joint name="j6" axis="1 0 0"/><geom type="box" size="0.03 0.06 0.02" pos="0.03 0.02 0" mass="0.3"/>
</body></body></body></body></body></body></worldbody>
<actuator><position joint="j1" kp="20"/><position joint="j2" kp="60"/><position joint="j3" kp="30"/><position joint="j4" kp="10"/><velocity joint="j5" kv="0.5"/></actuator></mujoco>)",
          {{"l1", {0.0000000, 0.0000000, 0.3000000}, {1.0000000, 0.0000000, 0.0000000, 0.0002195}},
           {"l2", {0.0539338, 0.0000237, 0.6425906}, {0.9906949, -0.0000299, 0.1361010, 0.0002175}},
           {"l3", {0.2567283, 0.0001127, 0.7818848}, {0.9451378, -0.0000717, 0.3266717, 0.0002075}},
           {"l4", {0.4965958, 0.0003350, 0.6825696}, {0.9451336, -0.0028348, 0.3266697, 0.0011625}},
           {"l5", {0.5939242, 0.0001589, 0.5585838}, {0.7497616, -0.0030639, 0.6617009, -0.0000035}},
           {"l6", {0.6276085, 0.0199192, 0.4820969}, {0.7494545, -0.0216762, 0.6614971, 0.0164236}}}};
}

TEST(Mjcf, ModelsMoveAsInMujoco) {
  for (const MujocoModel& model : {mujoco_pendulum(), mujoco_cart_pole(), mujoco_arm()}) {
    const SceneResult<Scene> scene = import_scene(model.xml, FileFormat::mjcf, "a.xml");
    ASSERT_TRUE(scene) << scene.error().text();
    Scene awake = *scene;
    awake.world.sleeping = false;
    SceneRunner runner = run_scene(std::move(awake), 0.001);
    for (int i = 0; i < 2000; ++i) ASSERT_TRUE(runner.step());
    const Quat y_up = from_axis_angle({1, 0, 0}, -0.5f * kPi);
    for (const MujocoBody& body : model.bodies) {
      const BodyId id = body_in(runner, body.name);
      const auto& q = body.orientation;
      const Quat expected = y_up * Quat{float(q[1]), float(q[2]), float(q[3]), float(q[0])};
      const Quat apart = conjugate(expected) * runner.world().pose(id).orientation;
      EXPECT_LT(2.0f * length(Vec3{apart.x, apart.y, apart.z}), 1.0e-3f) << body.name;
      const DVec3 center{body.center[0], body.center[2], -body.center[1]};
      EXPECT_LT(length(runner.world().center_of_mass(id) - center), 2.0e-4) << body.name;
    }
  }
}

#endif

}  // namespace
}  // namespace gyre::formats_test
