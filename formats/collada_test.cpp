// Meshes in COLLADA: units, places of nodes, and refusals.
#include "formats/import.h"

#include <gtest/gtest.h>

#include <string>
#include <vector>

namespace gyre::collada_test {
namespace {

// A square of 2 by 1 units in centimetres, one polygon, which the scene of the file shows twice: turned and moved, and mirrored.
constexpr const char* kDae = R"(<COLLADA><asset><unit meter="0.01"/><up_axis>Z_UP</up_axis></asset>
  <library_geometries><geometry id="g"><mesh><source id="s"><float_array id="a" count="12">0 0 0 2 0 0 2 1 0 0 1 0</float_array>
    <technique_common><accessor source="#a" count="4" stride="3"/></technique_common></source>
    <vertices id="v"><input semantic="POSITION" source="#s"/></vertices>
    <polylist count="1"><input semantic="VERTEX" source="#v" offset="0"/><input semantic="NORMAL" source="#s" offset="1"/>
      <vcount>4</vcount><p>0 0 1 0 2 0 3 0</p></polylist></mesh></geometry></library_geometries>
  <library_nodes><node id="n"><instance_geometry url="#g"/></node></library_nodes>
  <library_visual_scenes><visual_scene id="all">
    <node><translate>0 0 5</translate><rotate>0 0 1 90</rotate><instance_node url="#n"/></node>
    <node><scale>-1 1 1</scale><instance_geometry url="#g"/></node></visual_scene></library_visual_scenes>
  <scene><instance_visual_scene url="#all"/></scene></COLLADA>)";

TEST(Urdf, ColladaMeshesAreReadInMetresAndInTheirPlaces) {
  ImportOptions options;
  options.open_files = false;
  const auto robot = [&](std::string dae) {
    options.files["m.dae"] = std::move(dae);
    return import_scene(
        "<robot name='r'><link name='base'><collision><geometry><mesh "
        "filename='m.dae'/></geometry></collision></link></robot>",
        FileFormat::urdf, "r.urdf", options);
  };
  const SceneResult<Scene> scene = robot(kDae);
  ASSERT_TRUE(scene) << scene.error().text();
  ASSERT_EQ(scene->meshes.size(), 1u);
  const SceneMesh& mesh = scene->meshes[0];
  ASSERT_EQ(mesh.vertices.size(), 8u);
  EXPECT_NEAR(length(mesh.vertices[2] - Vec3{-0.01f, 0.02f, 0.05f}), 0, 1e-7);
  EXPECT_NEAR(length(mesh.vertices[6] - Vec3{-0.02f, 0.01f, 0}), 0, 1e-7);
  EXPECT_EQ(mesh.indices, (std::vector<std::uint32_t>{0, 1, 2, 0, 2, 3, 4, 6, 5, 4, 7, 6}));
  const auto refused = [&](const std::string& from, const std::string& to, const std::string& expected) {
    std::string text = kDae;
    text.replace(text.find(from), from.size(), to);
    const SceneResult<Scene> other = robot(text);
    ASSERT_FALSE(other) << to;
    EXPECT_NE(other.error().text().find(expected), std::string::npos) << other.error().text();
  };
  refused("0 0 1 0 2 0", "9 0 1 0 2 0", "index out of range");
  refused("<vcount>4", "<vcount>5", "fewer indices");
  refused("url=\"#n\"", "url=\"#x\"", "names nothing");
  refused("<instance_geometry url=\"#g\"/></node></library_nodes>",
          "<instance_node url=\"#n\"/></node></library_nodes>", "nested too deep");
}

}  // namespace
}  // namespace gyre::collada_test
