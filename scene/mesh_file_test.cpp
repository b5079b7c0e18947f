// Mesh files: Wavefront text, good and bad, and paths that must not be followed.
#include "scene/mesh_file.h"

#include "scene/scene_reader.h"

#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <string>
#include <vector>

namespace gyre {
namespace {

namespace fs = std::filesystem;

const std::string kSquare =
    "# a square\nv 0 0 0\nv 1 0 0\nv 1 1 0 1.0\nv 0 1 0\nvn 0 0 1\nvt 0 0\ng side\nf 1/1/1 2//1 3/1 4\n";

SceneResult<MeshData> parse(const std::string& text) { return parse_obj(text, "m.obj", SceneLimits{}); }

void expect_line(const std::string& text, int line, const std::string& word) {
  const SceneResult<MeshData> mesh = parse(text);
  ASSERT_FALSE(mesh) << text;
  EXPECT_EQ(mesh.error().line, line) << mesh.error().text();
  EXPECT_NE(mesh.error().message.find(word), std::string::npos) << mesh.error().text();
}

TEST(ObjFile, ReadsFacesAsFans) {
  const SceneResult<MeshData> mesh = parse(kSquare);
  ASSERT_TRUE(mesh) << mesh.error().text();
  EXPECT_EQ(mesh->vertices.size(), 4u);
  EXPECT_EQ(mesh->indices, (std::vector<std::uint32_t>{0, 1, 2, 0, 2, 3}));
  EXPECT_EQ(mesh->vertices[2], (Vec3{1, 1, 0}));
}

TEST(ObjFile, LineEndsAndMissingLastNewline) {
  std::string windows;
  for (const char c : kSquare) windows += c == '\n' ? std::string("\r\n") : std::string(1, c);
  EXPECT_TRUE(parse(windows));
  EXPECT_TRUE(parse(kSquare.substr(0, kSquare.size() - 1)));
  EXPECT_TRUE(parse("\xef\xbb\xbf" + kSquare));
}

TEST(ObjFile, NegativeIndicesCountBack) {
  const SceneResult<MeshData> mesh = parse("v 0 0 0\nv 1 0 0\nv 0 1 0\nf -3 -2 -1\n");
  ASSERT_TRUE(mesh);
  EXPECT_EQ(mesh->indices, (std::vector<std::uint32_t>{0, 1, 2}));
}

TEST(ObjFile, NamesTheLineOfWhatIsWrong) {
  const std::string three = "v 0 0 0\nv 1 0 0\nv 0 1 0\n";
  expect_line("", 0, "no face");
  expect_line(three, 0, "no face");
  expect_line("f 1 2 3\n" + three, 1, "vertex index");
  expect_line(three + "f 1 2 4\n", 4, "from 1 to 3");
  expect_line(three + "f 0 1 2\n", 4, "\"0\"");
  expect_line(three + "f -4 1 2\n", 4, "\"-4\"");
  expect_line(three + "f 1 2\n", 4, "a face of 2");
  expect_line(three + "f\n", 4, "a face of 0");
  expect_line(three + "f 1 2 99999999999999999999999\n", 4, "vertex index");
  expect_line(three + "f 1 2 4294967299\n", 4, "vertex index");
  expect_line(three + "f 1 2 x\n", 4, "\"x\"");
  expect_line(three + "f 1 2 -\n", 4, "\"-\"");
  expect_line(three + "f 1 2 /3\n", 4, "\"/3\"");
  expect_line("v 0 0\n", 1, "the end of the line");
  expect_line("v 0 0 nan\n", 1, "\"nan\"");
  expect_line("v 0 0 1e39\n", 1, "coordinate");
  expect_line("v 0 0 1e999\n", 1, "coordinate");
  expect_line("v 0 0 " + std::string(100000, '1') + "\n", 1, "...");
  expect_line("solid cube\n", 1, "\"solid\"");
  expect_line(std::string("v 0 0 0\n\0\0", 10), 2, "found \"??\"");
}

TEST(ObjFile, CutOffOrChangedAnywhereIsAMeshOrAnError) {
  for (std::size_t size = 0; size <= kSquare.size(); ++size) (void)parse(kSquare.substr(0, size));
  for (std::size_t i = 0; i < kSquare.size(); ++i) {
    for (int value = 0; value < 256; ++value) {
      std::string text = kSquare;
      text[i] = char(value);
      const SceneResult<MeshData> mesh = parse(text);
      if (!mesh) continue;
      for (const std::uint32_t index : mesh->indices) ASSERT_LT(index, mesh->vertices.size());
    }
  }
}

TEST(ObjFile, StopsAtItsLimits) {
  SceneLimits limits;
  limits.triangles = 1;
  EXPECT_FALSE(parse_obj(kSquare, "m.obj", limits));
  limits = {};
  limits.vertices = 3;
  EXPECT_FALSE(parse_obj(kSquare, "m.obj", limits));
}

// A folder with a scene in it and a secret beside it.
class SceneFolder : public ::testing::Test {
 protected:
  void SetUp() override {
    root_ = fs::temp_directory_path() /
            ("gyre_mesh_" + std::to_string(::testing::UnitTest::GetInstance()->random_seed()) + "_" +
             ::testing::UnitTest::GetInstance()->current_test_info()->name());
    fs::remove_all(root_);
    fs::create_directories(root_ / "scene" / "meshes");
    write("secret.obj", kSquare);
    write("scene/meshes/square.obj", kSquare);
  }
  void TearDown() override { fs::remove_all(root_); }

  void write(const std::string& path, const std::string& text) {
    std::ofstream(root_ / path, std::ios::binary) << text;
  }
  std::string in_root(const std::string& path) const { return (root_ / path).string(); }
  SceneResult<Scene> load_with_mesh(const std::string& path) {
    write("scene/s.gyre.json", R"({"gyre_scene": 1, "meshes": {"m": {"file": ")" + path + R"("}}})");
    return load_scene(in_root("scene/s.gyre.json"));
  }

  fs::path root_;
};

TEST_F(SceneFolder, FindsMeshesBesideTheScene) {
  const SceneResult<Scene> scene = load_with_mesh("meshes/square.obj");
  ASSERT_TRUE(scene) << scene.error().text();
  EXPECT_EQ(scene->meshes[0].vertices.size(), 4u);
  EXPECT_TRUE(load_with_mesh("./meshes//square.obj"));
}

TEST_F(SceneFolder, NeverLeavesTheFolder) {
  for (const std::string& path :
       {std::string("../secret.obj"), std::string("meshes/../../secret.obj"), in_root("secret.obj"),
        std::string("file:secret.obj"), std::string("meshes/../meshes/square.obj")}) {
    const SceneResult<Scene> scene = load_with_mesh(path);
    ASSERT_FALSE(scene) << path;
    EXPECT_EQ(scene.error().pointer, "/meshes/m/file");
  }
}

TEST_F(SceneFolder, SymbolicLinksDoNotLeadOut) {
  std::error_code error;
  fs::create_symlink(root_ / "secret.obj", root_ / "scene" / "link.obj", error);
  if (error) GTEST_SKIP() << "no symbolic links here";
  fs::create_directory_symlink(root_, root_ / "scene" / "up", error);
  fs::create_symlink(root_ / "scene" / "meshes" / "square.obj", root_ / "scene" / "inside.obj", error);
  EXPECT_NE(load_with_mesh("link.obj").error().message.find("leads out"), std::string::npos);
  EXPECT_NE(load_with_mesh("up/secret.obj").error().message.find("leads out"), std::string::npos);
  EXPECT_TRUE(load_with_mesh("inside.obj"));
}

TEST_F(SceneFolder, RefusesWhatIsNoFile) {
  fs::create_directories(root_ / "scene" / "folder.obj");
  EXPECT_NE(load_with_mesh("folder.obj").error().message.find("is a folder"), std::string::npos);
  EXPECT_NE(load_with_mesh("none.obj").error().message.find("no such file"), std::string::npos);
  EXPECT_NE(load_scene(in_root("none.gyre.json")).error().message.find("no such file"), std::string::npos);
  EXPECT_NE(load_scene(in_root("scene")).error().message.find("is a folder"), std::string::npos);
}

TEST_F(SceneFolder, FilesAboveTheLimitAreNotRead) {
  SceneLimits limits;
  limits.file_bytes = 100;
  write("scene/big.gyre.json", std::string(101, ' '));
  EXPECT_NE(load_scene(in_root("scene/big.gyre.json"), limits).error().message.find("larger than 100"),
            std::string::npos);
}

}  // namespace
}  // namespace gyre
