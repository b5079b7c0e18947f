// Mesh files: Wavefront text, good and bad, and paths that must not be followed.
#include "scene/mesh_file.h"

#include "scene/scene_reader.h"

#include <gtest/gtest.h>

#include <cmath>
#include <filesystem>
#include <fstream>
#include <random>
#include <string>
#include <utility>
#include <vector>

namespace gyre::mesh_file_test {
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

TEST(ObjFile, LinesEndInAnyWayAndGoOnAfterABackslash) {
  std::string old_mac = kSquare, continued;
  for (char& c : old_mac) c = c == '\n' ? '\r' : c;
  for (std::size_t i = 0; i < kSquare.size(); ++i) {
    const bool word_ends = i > 11 && kSquare[i] == ' ' && i % 3 == 0;
    continued += word_ends ? std::string(i % 2 == 0 ? " \\\n" : "\\\r\n") : std::string(1, kSquare[i]);
  }
  for (const std::string& text : {old_mac, continued}) {
    const SceneResult<MeshData> mesh = parse(text);
    ASSERT_TRUE(mesh) << mesh.error().text();
    EXPECT_EQ(mesh->indices, (std::vector<std::uint32_t>{0, 1, 2, 0, 2, 3}));
    EXPECT_EQ(mesh->vertices[2], (Vec3{1, 1, 0}));
  }
  // The line of an error is the first of those that belong together. A comment ends with its line.
  expect_line("v 0 0 0\\\n\nv 1 \\\n0\n", 3, "the end of the line");
  EXPECT_TRUE(parse("# from C:\\models\\\n" + kSquare));
}

TEST(ObjFile, KnowsAllWordsOfTheFormat) {
  for (const char* word :
       {"cstype bspline", "deg 3", "curv 0 1 1 2 3", "parm u 0 1", "end", "bevel on", "lod 3", "con 1 2"})
    EXPECT_TRUE(parse(std::string(word) + "\n" + kSquare)) << word;
}

// Twice the area of each triangle of the file along z.
std::vector<double> areas(const MeshData& mesh) {
  std::vector<double> out;
  for (std::size_t i = 0; i < mesh.indices.size(); i += 3) {
    const DVec3 a(mesh.vertices[mesh.indices[i]]);
    out.push_back(
        cross(DVec3(mesh.vertices[mesh.indices[i + 1]]) - a, DVec3(mesh.vertices[mesh.indices[i + 2]]) - a)
            .z);
  }
  return out;
}

TEST(ObjFile, ConcaveFacesAreCoveredOnce) {
  std::mt19937 engine{11};
  const auto random = [&](double low, double high) {
    return low + (high - low) * double(engine() >> 8) / 16777216.0;
  };
  for (int trial = 0; trial < 60; ++trial) {
    // Combs and stars, drawn; combs have corners in line.
    std::vector<std::pair<double, double>> outline;
    const int count = 2 + int(engine() % 12);
    if (trial % 2 == 0) {
      for (int i = count; i-- > 0;) {
        const double top = random(1.5, 4.0);
        for (const auto& [x, y] :
             {std::pair{2.0 * i + 1, 1.0}, {2.0 * i + 1, top}, {2.0 * i, top}, {2.0 * i, 1.0}})
          outline.push_back({x, y});
      }
      for (int i = 0; i < 2 * count; ++i) outline.push_back({i, 0.0});
    } else {
      for (int i = 0; i < count + 2; ++i) {
        const double angle = 2.0 * 3.14159265358979 * i / (count + 2), radius = random(0.2, 2.0);
        outline.push_back({radius * std::cos(angle), radius * std::sin(angle)});
      }
    }
    const bool mirrored = engine() % 2 == 0;
    std::string text;
    double twice = 0.0;
    for (std::size_t i = 0; i < outline.size(); ++i) {
      const auto [x, y] = outline[i];
      const auto [u, v] = outline[(i + 1) % outline.size()];
      twice += x * v - y * u;
      text += "v " + std::to_string(x) + " " + std::to_string(mirrored ? -y : y) + " 0\n";
    }
    text += "f";
    const std::size_t first = engine() % outline.size();
    for (std::size_t i = 0; i < outline.size(); ++i)
      text += " " + std::to_string((first + i) % outline.size() + 1);
    const SceneResult<MeshData> mesh = parse(text + "\n");
    ASSERT_TRUE(mesh) << mesh.error().text();
    ASSERT_EQ(mesh->indices.size(), 3 * (outline.size() - 2));
    double sum = 0.0;
    for (const double area : areas(*mesh)) {
      EXPECT_GT(mirrored ? -area : area, 1.0e-4) << trial << text;
      sum += area;
    }
    EXPECT_NEAR(mirrored ? -sum : sum, twice, 1.0e-4 * twice);
  }
}

TEST(ObjFile, FacesThatCrossThemselvesAndVeryLongOnesEnd) {
  std::string star = "f", ring = "f", corners, comb, teeth = "f";
  for (int i = 0; i < 6000; ++i) {
    const double angle = 0.001 * i;
    corners +=
        "v " + std::to_string(1000 * std::cos(angle)) + " " + std::to_string(1000 * std::sin(angle)) + " 0\n";
    comb += "v " + std::to_string(0.01 * i) + " " + std::to_string(i % 2) + " 0\n";
    ring += " " + std::to_string(i + 1);
    if (i < 7) star += " " + std::to_string(2400 * i % 6000 + 1);
  }
  EXPECT_TRUE(parse(corners + star + "\n"));
  EXPECT_EQ(parse(corners + ring + "\n")->indices.size(), 3u * 5998u);
  EXPECT_NE(parse(comb + "v 0 9 0\n" + ring + " 6001\n").error().message.find("concave"), std::string::npos);
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
}  // namespace gyre::mesh_file_test
