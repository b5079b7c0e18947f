// Convex decompositions in scenes: split into hulls, weighed as the mesh, kept in a store, written back as they were read.
#include "scene/decomposition_split.h"
#include "scene/decomposition_folder.h"
#include "scene/mesh_file.h"
#include "scene/scene_reader.h"
#include "scene/scene_runner.h"
#include "scene/scene_writer.h"

#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <map>

namespace gyre::decomposition_split_test {
namespace {

// A beam with an L as its section: 1 by 1 by 0.5 with a notch of 0.7 by 0.7.
std::string beam_scene(const std::string& more = "", const std::string& triangles = "") {
  return R"({ "gyre_scene": 1, "name": "beam", "meshes": { "L": { "vertices": [
    [0,0,0],[1,0,0],[1,0.3,0],[0.3,0.3,0],[0.3,1,0],[0,1,0],[0,0,0.5],[1,0,0.5],[1,0.3,0.5],[0.3,0.3,0.5],[0.3,1,0.5],[0,1,0.5]],
    "triangles": [)" +
         (triangles.empty()
              ? std::string(R"([0,3,2],[0,2,1],[0,5,4],[0,4,3],[6,8,9],[6,7,8],[6,10,11],[6,9,10],
    [0,1,7],[0,7,6],[1,2,8],[1,8,7],[2,3,9],[2,9,8],[3,4,10],[3,10,9],[4,5,11],[4,11,10],[5,0,6],[5,6,11])")
              : triangles) +
         R"(] } },
    "bodies": [ { "name": "beam", "position": [0, 5, 0], "shapes": [
      { "type": "convex_decomposition", "mesh": "L", "density": 500)" +
         more + R"( }, { "type": "sphere", "radius": 0.1, "density": 100, "position": [2, 0, 0] } ] } ] })";
}

Scene read(const std::string& text) {
  SceneResult<Scene> scene = read_scene(text);
  EXPECT_TRUE(scene) << scene.error().text();
  return scene ? *std::move(scene) : Scene{};
}

struct Memory : DecompositionStore {
  std::map<std::uint64_t, std::vector<std::byte>> kept;
  int loads = 0, saves = 0;
  bool load(std::uint64_t key, std::vector<std::byte>& bytes) override {
    ++loads;
    const auto found = kept.find(key);
    if (found != kept.end()) bytes = found->second;
    return found != kept.end();
  }
  void save(std::uint64_t key, std::span<const std::byte> bytes) override {
    ++saves;
    kept[key].assign(bytes.begin(), bytes.end());
  }
};

TEST(DecompositionSplit, ABodyGetsItsHullsAndTheMassOfTheMesh) {
  const SceneResult<SceneRunner> runner = SceneRunner::create(read(beam_scene()), "beam");
  ASSERT_TRUE(runner) << runner.error().text();
  const BodyId body = runner->bodies()[0];
  EXPECT_EQ(runner->world().shapes(body).size(), 3u);
  EXPECT_EQ(runner->scene().bodies[0].shapes.size(), 3u);
  EXPECT_TRUE(runner->scene().notes.empty());
  // By hand: the L is 1 x 0.3 and 0.3 x 0.7 by 0.5; the sphere is 2 m away.
  const double slab = 500 * 0.3 * 0.5, post = 500 * 0.3 * 0.7 * 0.5,
               ball = 100 * 4.0 / 3.0 * 3.14159265358979 * 0.001;
  const double mass = slab + post + ball;
  EXPECT_NEAR(double(runner->world().mass_properties(body).mass), mass, 1.0e-4 * mass);
  EXPECT_NEAR(double(runner->world().mass_properties(body).center.x),
              (slab * 0.5 + post * 0.15 + ball * 2.0) / mass, 1.0e-4);
}

TEST(DecompositionSplit, IsWrittenBackAsItWasRead) {
  SceneResult<SceneRunner> runner = SceneRunner::create(
      read(beam_scene(R"(, "max_hulls": 7, "concavity": 0.05, "meaning": "solid", "max_hull_vertices": 20)")),
      "beam");
  ASSERT_TRUE(runner);
  runner->step();
  const std::string text = write_scene(runner->final_scene());
  const Scene again = read(text);
  ASSERT_EQ(again.bodies[0].shapes.size(), 2u);
  const auto& shape = std::get<SceneDecomposition>(again.bodies[0].shapes[0].geometry);
  EXPECT_EQ(shape.max_hulls, 7);
  EXPECT_EQ(shape.concavity, 0.05f);
  EXPECT_EQ(shape.meaning, SurfaceMeaning::solid);
  EXPECT_EQ(shape.max_hull_vertices, 20);
}

TEST(DecompositionSplit, TheStoreIsAskedOnceAMeshAndGivesTheSame) {
  Memory store;
  SplitOptions options;
  options.store = &store;
  Scene first = read(beam_scene()), second = read(beam_scene()),
        other = read(beam_scene(R"(, "concavity": 0.1)"));
  first.bodies.push_back(first.bodies[0]);
  ASSERT_FALSE(split_decompositions(first, "", options));
  EXPECT_EQ(store.saves, 1);
  ASSERT_FALSE(split_decompositions(second, "", options));
  EXPECT_EQ(store.saves, 1);
  const auto hull = [](const Scene& scene, std::size_t i) {
    return std::get<SceneDecomposition>(scene.bodies[0].shapes[i].geometry).hull.content_hash();
  };
  EXPECT_EQ(hull(first, 0), hull(second, 0));
  EXPECT_EQ(hull(first, 1), hull(second, 1));
  // Other settings are another key; damaged bytes are as good as none.
  ASSERT_FALSE(split_decompositions(other, "", options));
  EXPECT_EQ(store.saves, 2);
  for (auto& [key, bytes] : store.kept) bytes[20] ^= std::byte{1};
  Scene third = read(beam_scene());
  ASSERT_FALSE(split_decompositions(third, "", options));
  EXPECT_EQ(store.saves, 3);
  EXPECT_EQ(hull(first, 0), hull(third, 0));
}

TEST(DecompositionSplit, AnOpenMeshLeavesANoteAndABadOneAnError) {
  Scene open = read(beam_scene("", "[0,3,2],[0,2,1]"));
  ASSERT_FALSE(split_decompositions(open, "", {}));
  ASSERT_EQ(open.notes.size(), 1u);
  EXPECT_NE(open.notes[0].find("mesh \"L\": 4 open edges"), std::string::npos) << open.notes[0];
  EXPECT_NE(open.notes[0].find("sheet"), std::string::npos);
  Scene flat = read(beam_scene("", "[0,1,0]"));
  const std::optional<SceneError> error = split_decompositions(flat, "f", {});
  ASSERT_TRUE(error);
  EXPECT_EQ(error->pointer, "/bodies/0/shapes/0/mesh");
}

// A ring lies still in the air, and balls fall on it: through the hole, 42 mm wide from the middle, what is smaller, not what is larger. Its convex hull
// would hold both.
TEST(DecompositionSplit, ABallFallsThroughARing) {
  const SceneResult<MeshData> ring =
      load_mesh_file(GYRE_SOURCE_DIR "/scenes/decomposition/meshes", "ring.obj", {});
  ASSERT_TRUE(ring) << ring.error().text();
  Scene scene;
  scene.meshes.push_back({"ring", "", ring->vertices, ring->indices});
  SceneBody body;
  body.name = "ring";
  body.def.type = BodyType::fixed;
  SceneDecomposition hulls;
  hulls.concavity = 0.05f;
  body.shapes.emplace_back().geometry = hulls;
  scene.bodies.push_back(body);
  for (const float radius : {0.025f, 0.05f}) {
    SceneBody ball;
    ball.name = std::to_string(radius);
    ball.def.pose.position = {0, 0.12, 0};
    // They do not see each other.
    ball.filter.group = -1;
    ball.shapes.emplace_back().geometry = Sphere{radius};
    scene.bodies.push_back(ball);
  }
  SceneResult<SceneRunner> runner = SceneRunner::create(scene, "ring");
  ASSERT_TRUE(runner) << runner.error().text();
  for (int i = 0; i < 120; ++i) ASSERT_TRUE(runner->step());
  EXPECT_LT(runner->world().pose(runner->bodies()[1]).position.y, -2.0);
  EXPECT_GT(runner->world().pose(runner->bodies()[2]).position.y, 0.02);
}

TEST(DecompositionFolder, KeepsFilesByKey) {
  namespace fs = std::filesystem;
  const fs::path folder = fs::path(::testing::TempDir()) / "gyre_hulls" / "below";
  fs::remove_all(folder);
  DecompositionFolder store(folder.string());
  std::vector<std::byte> bytes{std::byte{1}, std::byte{2}}, back;
  EXPECT_FALSE(store.load(5, back));
  store.save(5, bytes);
  EXPECT_FALSE(store.failed());
  EXPECT_TRUE(store.load(5, back));
  EXPECT_EQ(back, bytes);
  EXPECT_FALSE(store.load(6, back));
  std::size_t files = 0;
  for ([[maybe_unused]] const auto& entry : fs::directory_iterator(folder)) ++files;
  EXPECT_EQ(files, 1u);
  // A file where the folder should be: nothing is kept, and it says so.
  std::ofstream(folder.string() + "_file") << "x";
  DecompositionFolder blocked(folder.string() + "_file");
  blocked.save(5, bytes);
  EXPECT_TRUE(blocked.failed());
  DecompositionFolder none("");
  none.save(5, bytes);
  EXPECT_FALSE(none.failed());
  fs::remove_all(folder.parent_path());
}

}  // namespace
}  // namespace gyre::decomposition_split_test
