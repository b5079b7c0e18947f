// Files of other programs on the command line: the converted file moves like the original, and meshes come only from folders that were named.
#include "run_program.h"

#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <string>
#include <vector>

namespace gyre::import_test {
namespace {

namespace fs = std::filesystem;

constexpr const char* kTriangleStl =
    "solid\nfacet\nvertex 0 0 0\nvertex 1 0 0\nvertex 0 1 0\nendfacet\nendsolid\n";

class Import : public testing::Test {
 protected:
  void SetUp() override {
    folder_ = fs::temp_directory_path() / ("gyre_formats_" + std::to_string(getpid()) + "_" +
                                           testing::UnitTest::GetInstance()->current_test_info()->name());
    fs::remove_all(folder_);
    fs::create_directories(folder_ / "robot");
    fs::create_directories(folder_ / "arms" / "meshes");
  }
  void TearDown() override { fs::remove_all(folder_); }
  void write(const std::string& name, const std::string& text) {
    std::ofstream(folder_ / name, std::ios::binary) << text;
  }
  Finished gyre(const std::vector<std::string>& arguments) { return run_program(arguments, folder_); }

  fs::path folder_;
};

TEST_F(Import, AConvertedFileMovesBitByBitLikeTheFileItself) {
  const std::string source = GYRE_SOURCE_DIR "/scenes/formats/playground.gltf";
  ASSERT_EQ(gyre({"convert", source, "out.gyre.json"}).code, 0);
  const Finished direct = gyre({"simulate", source, "--steps", "60", "--hash", "--quiet"});
  const Finished converted = gyre({"simulate", "out.gyre.json", "--steps", "60", "--hash", "--quiet"});
  EXPECT_EQ(direct.code, 0) << direct.err;
  EXPECT_FALSE(direct.out.empty());
  EXPECT_EQ(direct.out, converted.out);
}

TEST_F(Import, ScenesAndRecordingsBecomeGltf) {
  const std::string source = GYRE_SOURCE_DIR "/scenes/half_wood_half_lead.gyre.json";
  ASSERT_EQ(gyre({"convert", source, "out.glb"}).code, 0);
  const Finished direct =
      gyre({"simulate", source, "--steps", "60", "--hash", "--quiet", "--record", "run.gyrec"});
  const Finished converted = gyre({"simulate", "out.glb", "--steps", "60", "--hash", "--quiet"});
  EXPECT_EQ(direct.code, 0) << direct.err;
  EXPECT_EQ(direct.out, converted.out);
  EXPECT_EQ(gyre({"convert", "run.gyrec", "run.gltf"}).code, 0);
  std::ifstream file(folder_ / "run.gltf");
  const std::string text((std::istreambuf_iterator<char>(file)), {});
  EXPECT_NE(text.find("\"rotation\""), std::string::npos);
  const Finished refused = gyre({"convert", "run.gyrec", "run.gyre.json"});
  EXPECT_EQ(refused.code, 3);
  EXPECT_NE(refused.err.find(".glb or .gltf"), std::string::npos) << refused.err;
}

TEST_F(Import, ARunBecomesVtkFiles) {
  const std::string source = GYRE_SOURCE_DIR "/scenes/half_wood_half_lead.gyre.json";
  ASSERT_EQ(gyre({"simulate", source, "--steps", "5", "--quiet", "--vtk", "vtk", "--vtk-every", "2"}).code,
            0);
  std::ifstream file(folder_ / "vtk" / "run.pvd");
  const std::string text((std::istreambuf_iterator<char>(file)), {});
  for (const char* name : {"bodies_0_000000.vtp", "bodies_0_000002.vtp", "bodies_0_000004.vtp"}) {
    EXPECT_NE(text.find(name), std::string::npos) << text;
    EXPECT_TRUE(fs::exists(folder_ / "vtk" / name));
  }
  EXPECT_FALSE(fs::exists(folder_ / "vtk" / "bodies_0_000005.vtp"));
}

#ifdef GYRE_WITH_XML
TEST_F(Import, MeshesAreReadFromTheFoldersThatWereNamedAndFromNoOther) {
  const auto robot = [](const std::string& mesh) {
    return "<robot name=\"r\"><link name=\"base\"><collision><geometry><mesh filename=\"" + mesh +
           "\" scale=\"2 2 2\"/></geometry></collision></link></robot>";
  };
  write("arms/meshes/a.stl", kTriangleStl);
  write("robot/p.urdf", robot("package://arms/meshes/a.stl"));
  write("robot/up.urdf", robot("../arms/meshes/a.stl"));
  write("secret.stl", kTriangleStl);
  write("robot/far.urdf", robot("package://arms/../secret.stl"));
  const Finished unnamed = gyre({"info", "robot/p.urdf"}), outside = gyre({"info", "robot/up.urdf"});
  EXPECT_EQ(unnamed.code, 3);
  EXPECT_NE(unnamed.err.find("--package arms=FOLDER"), std::string::npos) << unnamed.err;
  EXPECT_EQ(outside.code, 3);
  EXPECT_NE(outside.err.find("leads out of the folders"), std::string::npos) << outside.err;
  EXPECT_EQ(gyre({"info", "robot/p.urdf", "--package", "arms=arms"}).code, 0);
  EXPECT_EQ(gyre({"info", "robot/p.urdf", "--package", "."}).code, 0);
  EXPECT_EQ(gyre({"info", "robot/up.urdf", "--package", "arms"}).code, 0);
  EXPECT_EQ(gyre({"info", "robot/far.urdf", "--package", "arms=arms"}).code, 3);
  const Finished strict =
      gyre({"convert", GYRE_SOURCE_DIR "/scenes/formats/pendulum.urdf", "out.gyre.json", "--strict"});
  EXPECT_EQ(strict.code, 0) << strict.err;
  write("bad.urdf", "<robot/>");
  EXPECT_EQ(gyre({"convert", "bad.urdf", "none.gyre.json"}).code, 3);
  EXPECT_FALSE(fs::exists(folder_ / "none.gyre.json"));
}
#endif

}  // namespace
}  // namespace gyre::import_test
