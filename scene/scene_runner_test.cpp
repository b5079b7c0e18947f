// Scenes as worlds: names, materials, timed forces, refusals of the engine, and going on from a final scene.
#include "scene/scene_runner.h"

#include "scene/scene_reader.h"
#include "scene/scene_writer.h"

#include <gyre/replay.h>

#include <gtest/gtest.h>

#include <cmath>
#include <string>
#include <vector>

namespace gyre::scene_runner_test {
namespace {

SceneRunner run(const std::string& text, int steps = 0, int threads = 1) {
  SceneResult<Scene> scene = read_scene(text);
  EXPECT_TRUE(scene) << scene.error().text();
  SceneResult<SceneRunner> runner = SceneRunner::create(*std::move(scene), "test", threads);
  EXPECT_TRUE(runner) << runner.error().text();
  for (int i = 0; i < steps; ++i) EXPECT_TRUE(runner->step()) << runner->problem();
  return *std::move(runner);
}

SceneError refusal(const std::string& text) {
  SceneResult<Scene> scene = read_scene(text);
  EXPECT_TRUE(scene) << scene.error().text();
  SceneResult<SceneRunner> runner = SceneRunner::create(*std::move(scene), "test");
  EXPECT_FALSE(runner);
  return runner.error();
}

// A ball of 2 kg in free space, with a force on it.
std::string pushed(const std::string& force, const std::string& more = "") {
  return R"({"gyre_scene": 1, "world": {"gravity": [0, 0, 0], "time_step": 0.01},
             "bodies": [{"name": "ball", "mass": 2, "can_sleep": false, )" +
         more + R"("shapes": [{"type": "sphere", "radius": 0.5}],
                         "forces": [)" +
         force + "]}]}";
}

TEST(SceneRunner, NamesAndBodies) {
  const SceneRunner runner =
      run(R"({"gyre_scene": 1, "bodies": [{"name": "one", "shapes": [{"type": "sphere", "radius": 1}]},
                                     {"name": "two", "type": "static", "shapes": [{"type": "plane"}]}]})");
  ASSERT_EQ(runner.bodies().size(), 2u);
  EXPECT_EQ(runner.body_of(runner.bodies()[0])->name, "one");
  EXPECT_EQ(runner.body_of(runner.bodies()[1])->name, "two");
  EXPECT_EQ(runner.body_of(BodyId{}), nullptr);
  EXPECT_EQ(runner.world().stats().bodies, 2);
}

SceneRunner run_file(const char* name, double seconds) {
  SceneResult<Scene> scene = load_scene(std::string(GYRE_SOURCE_DIR "/scenes/") + name);
  EXPECT_TRUE(scene) << scene.error().text();
  SceneResult<SceneRunner> runner = SceneRunner::create(*std::move(scene), "test");
  EXPECT_TRUE(runner) << runner.error().text();
  while (runner->world().time() < seconds) EXPECT_TRUE(runner->step()) << runner->problem();
  return *std::move(runner);
}
BodyId named(const SceneRunner& runner, const char* name) {
  for (const BodyId body : runner.bodies()) {
    if (runner.body_of(body)->name == name) return body;
  }
  ADD_FAILURE() << "no body " << name;
  return {};
}

// Bodies that bounce on triangles find manifolds anew within the step, with more points than before.
TEST(SceneRunner, TheBouncesOfATerrainAreTheSameAtEverySimdWidth) {
  const SceneRunner runner = run_file("mesh_terrain.gyre.json", 0);
  const std::vector<std::byte> begin = save_snapshot(runner.world());
  std::uint64_t hash_of_one_lane = 0;
  for (const int width : {1, 4, 8, 16}) {
    WorldDef def;
    def.simd_width = width;
    Result<World> world = load_snapshot(begin, def);
    ASSERT_TRUE(world) << world.error().message;
    for (int i = 0; i < 110; ++i) ASSERT_TRUE(world->step(1.0f / 60.0f));
    if (width == 1) hash_of_one_lane = world->hash();
    EXPECT_EQ(world->hash(), hash_of_one_lane) << width;
  }
}

TEST(SceneRunner, CratesTakeTheSpeedOfTheirBelt) {
  const SceneRunner runner = run_file("belt.gyre.json", 1.0);
  const World& world = runner.world();
  EXPECT_NEAR(world.linear_velocity(named(runner, "light crate")).x, 2.0f, 1e-3f);
  EXPECT_NEAR(world.linear_velocity(named(runner, "crate back")).x, -1.0f, 1e-3f);
  // What slips still gains mu g a second: mu is the geometric mean of 0.5 and 0.02.
  EXPECT_NEAR(world.linear_velocity(named(runner, "slippery crate")).x, 0.1f * 9.81f, 0.02f);
}

TEST(SceneRunner, OneWayPlatformsLetPassAndHold) {
  const SceneRunner runner = run_file("one_way.gyre.json", 5.0);
  const World& world = runner.world();
  // From below through one platform and through two, and from above onto the upper one.
  EXPECT_NEAR(world.pose(named(runner, "ball")).position.y, 1.5 + 0.25, 0.01);
  EXPECT_NEAR(world.pose(named(runner, "box")).position.y, 3.0 + 0.25, 0.01);
  EXPECT_NEAR(world.pose(named(runner, "weight")).position.y, 3.0 + 0.3, 0.01);
}

TEST(SceneRunner, AForceActsInEveryStepThatBeginsInItsWindow) {
  // 4 N on 2 kg: 2 m/s^2, for ten steps that begin at 0.05 up to 0.14.
  const SceneRunner runner = run(pushed(R"({"force": [4, 0, 0], "start": 0.05, "end": 0.15})"), 50);
  EXPECT_NEAR(runner.world().linear_velocity(runner.bodies()[0]).x, 2.0f * 0.1f, 1e-5f);
  // Up to a step before the window nothing moves; within it, each step counts once.
  EXPECT_EQ(run(pushed(R"({"force": [4, 0, 0], "start": 0.05, "end": 0.15})"), 5)
                .world()
                .linear_velocity(runner.bodies()[0]),
            Vec3{});
  SceneRunner one = run(pushed(R"({"force": [4, 0, 0], "start": 0.05, "end": 0.06})"), 30);
  EXPECT_NEAR(one.world().linear_velocity(one.bodies()[0]).x, 2.0f * 0.01f, 1e-6f);
  SceneRunner never = run(pushed(R"({"force": [4, 0, 0], "start": 0.051, "end": 0.059})"), 30);
  EXPECT_EQ(never.world().linear_velocity(never.bodies()[0]), Vec3{});
}

TEST(SceneRunner, AForceBesideTheCentreTurns) {
  // Torque r x f = (0, 0.5, 0) x (4, 0, 0) = (0, 0, -2); the solid ball's inertia is 2/5 m r^2 = 0.2.
  const SceneRunner world_frame = run(pushed(R"({"force": [4, 0, 0], "at": [0, 0.5, 0], "end": 0.01})"), 1);
  EXPECT_NEAR(world_frame.world().angular_velocity(world_frame.bodies()[0]).z, -2.0f / 0.2f * 0.01f, 1e-4f);
  const SceneRunner torque = run(pushed(R"({"torque": [0, 0, 1], "end": 0.01})"), 1);
  EXPECT_NEAR(torque.world().angular_velocity(torque.bodies()[0]).z, 1.0f / 0.2f * 0.01f, 1e-4f);
  EXPECT_EQ(torque.world().linear_velocity(torque.bodies()[0]), Vec3{});
}

TEST(SceneRunner, ABodyFrameForceTurnsWithTheBody) {
  // A quarter turn about z takes the body's x to the world's y.
  const std::string turned = R"("orientation": {"axis": [0, 0, 1], "angle": 1.5707963267948966}, )";
  const SceneRunner runner = run(pushed(R"({"force": [4, 0, 0], "frame": "body", "end": 0.01})", turned), 1);
  const Vec3 v = runner.world().linear_velocity(runner.bodies()[0]);
  EXPECT_NEAR(v.x, 0.0f, 1e-6f);
  EXPECT_NEAR(v.y, 0.02f, 1e-6f);
  // And so does the point: (0, 0.5, 0) in the body is (-0.5, 0, 0) in the world; torque (-0.5, 0, 0) x (0, 4, 0).
  const SceneRunner off =
      run(pushed(R"({"force": [4, 0, 0], "at": [0, 0.5, 0], "frame": "body", "end": 0.01})", turned), 1);
  EXPECT_NEAR(off.world().angular_velocity(off.bodies()[0]).z, -2.0f / 0.2f * 0.01f, 1e-4f);
}

TEST(SceneRunner, ForcesOnUnmovingBodiesDoNothing) {
  const SceneRunner runner =
      run(R"({"gyre_scene": 1, "bodies": [{"name": "b", "type": "static", "forces": [{"force": [1, 0, 0]}],
                                     "shapes": [{"type": "sphere", "radius": 1}]}]})",
          3);
  EXPECT_EQ(runner.world().pose(runner.bodies()[0]).position, DVec3{});
}

TEST(SceneRunner, MaterialsAndTheirPairs) {
  const std::string scene = R"({"gyre_scene": 1,
    "materials": {"ice": {"density": 900, "static_friction": 0.1, "dynamic_friction": 0.05, "restitution": 0.2}},
    "bodies": [{"name": "a", "shapes": [{"type": "box", "half_extents": [0.5, 0.5, 0.5], "material": "ice"},
                                        {"type": "box", "half_extents": [0.5, 0.5, 0.5], "material": "ice", "density": 100,
                                         "restitution": 0.9, "position": [2, 0, 0]},
                                        {"type": "box", "half_extents": [0.5, 0.5, 0.5], "static_friction": 0.3}]}]})";
  const SceneRunner runner = run(scene);
  const World& world = runner.world();
  const std::span<const ShapeId> shapes = world.shapes(runner.bodies()[0]);
  ASSERT_EQ(shapes.size(), 3u);
  EXPECT_EQ(world.material(shapes[0]).static_friction, 0.1f);
  EXPECT_EQ(world.material(shapes[0]).dynamic_friction, 0.05f);
  EXPECT_NE(world.material(shapes[0]).id, 0);
  EXPECT_EQ(world.material(shapes[1]).restitution, 0.9f);
  EXPECT_EQ(world.material(shapes[1]).id, world.material(shapes[0]).id);
  EXPECT_EQ(world.material(shapes[2]).id, 0);
  EXPECT_EQ(world.material(shapes[2]).dynamic_friction, 0.3f);
  EXPECT_NEAR(world.mass_properties(runner.bodies()[0]).mass, 900 + 100 + 1000, 0.1f);
}

// A box on a tilted floor slides or stays as the pair table says, whatever the materials alone would do.
TEST(SceneRunner, APairOverridesTheMaterials) {
  const auto slide = [](const std::string& pairs) {
    const SceneRunner runner = run(
        R"({"gyre_scene": 1, "materials": {"m": {"static_friction": 1}, "n": {"static_friction": 1}},)" +
            pairs +
            R"("bodies": [{"name": "floor", "type": "static", "orientation": {"axis": [0, 0, 1], "angle": 0.3},
                       "shapes": [{"type": "box", "half_extents": [5, 0.5, 5], "material": "m"}]},
                      {"name": "box", "position": [-0.29552, 0.95534, 0], "orientation": {"axis": [0, 0, 1], "angle": 0.3},
                       "shapes": [{"type": "box", "half_extents": [0.5, 0.5, 0.5], "material": "n"}]}]})",
        60);
    return std::abs(runner.world().pose(runner.bodies()[1]).position.x + 0.29552);
  };
  EXPECT_LT(slide(""), 0.05);
  EXPECT_GT(
      slide(
          R"("material_pairs": [{"materials": ["n", "m"], "static_friction": 0.01, "dynamic_friction": 0.01}],)"),
      0.3);
}

TEST(SceneRunner, RefusalsOfTheEngineNameThePlace) {
  const auto with_shape = [](const std::string& shape) {
    return R"({"gyre_scene": 1, "bodies": [{"name": "a", "type": "static", "shapes": [{"type": "sphere", "radius": 1}, )" +
           shape + "]}]}";
  };
  EXPECT_EQ(refusal(with_shape(R"({"type": "sphere", "radius": 1e20})")).pointer, "/bodies/0/shapes/1");
  EXPECT_EQ(
      refusal(with_shape(R"({"type": "convex_hull", "points": [[0,0,0],[1,0,0],[0,1,0],[1,1,0]]})")).pointer,
      "/bodies/0/shapes/1/points");
  EXPECT_EQ(refusal(with_shape(R"({"type": "plane", "normal": [1e-30, 0, 0]})")).pointer,
            "/bodies/0/shapes/1");
  const std::string flat =
      R"({"gyre_scene": 1, "meshes": {"line": {"vertices": [[0,0,0],[1,0,0],[2,0,0]], "triangles": [[0,1,2]]}},
      "bodies": [{"name": "a", "type": "static", "shapes": [{"type": "mesh", "mesh": "line"}]}]})";
  EXPECT_EQ(refusal(flat).pointer, "/bodies/0/shapes/0/mesh");
  EXPECT_EQ(refusal(flat).file, "test");
}

TEST(SceneRunner, ThreadsDoNotChangeTheHash) {
  std::string bodies = R"({"name": "floor", "type": "static", "shapes": [{"type": "plane"}]})";
  for (int i = 0; i < 40; ++i) {
    bodies += R"(, {"name": "b)" + std::to_string(i) + R"(", "position": [)" + std::to_string(0.3 * (i % 3)) +
              ", " + std::to_string(0.6 + 1.1 * i) +
              R"(, 0.1], "shapes": [{"type": "box", "half_extents": [0.5, 0.5, 0.5]}]})";
  }
  const std::string scene = R"({"gyre_scene": 1, "bodies": [)" + bodies + "]}";
  EXPECT_EQ(run(scene, 120, 1).world().hash(), run(scene, 120, 4).world().hash());
}

TEST(SceneRunner, AFinalSceneGoesOnWhereTheFirstStopped) {
  // A spinning body under gravity and a timed force: 20 + 30 steps through a file are 50 steps.
  const std::string text = R"({"gyre_scene": 1, "world": {"time_step": 0.01}, "bodies": [
      {"name": "top", "position": [0, 5, 0], "angular_velocity": [0.1, 3, 0.2], "linear_velocity": [1, 2, 3],
       "shapes": [{"type": "box", "half_extents": [0.1, 0.3, 0.2]}],
       "forces": [{"force": [50, 0, 0], "start": 0.1, "end": 0.35}, {"torque": [0, 1, 0], "end": 0.15}]}]})";
  const SceneRunner whole = run(text, 50);
  const SceneRunner part = run(text, 20);
  const std::string saved = write_scene(part.final_scene());
  EXPECT_EQ(part.final_scene().bodies[0].forces.size(), 1u);  // the torque is over
  const SceneRunner rest = run(saved, 30);
  const Pose a = whole.world().pose(whole.bodies()[0]), b = rest.world().pose(rest.bodies()[0]);
  EXPECT_NEAR(a.position.x, b.position.x, 1e-5);
  EXPECT_NEAR(a.position.y, b.position.y, 1e-5);
  EXPECT_NEAR(a.position.z, b.position.z, 1e-5);
  EXPECT_NEAR(std::abs(dot(a.orientation, b.orientation)), 1.0f, 1e-5f);
  const Vec3 va = whole.world().linear_velocity(whole.bodies()[0]),
             vb = rest.world().linear_velocity(rest.bodies()[0]);
  EXPECT_NEAR(length(va - vb), 0.0f, 1e-4f);
}

TEST(SceneRunner, AFinalSceneIsAScene) {
  const std::string text = R"({"gyre_scene": 1, "name": "joints",
    "meshes": {"m": {"vertices": [[-5,0,-5],[5,0,-5],[5,0,5],[-5,0,5]], "triangles": [[0,2,1],[0,3,2]]}},
    "bodies": [{"name": "floor", "type": "static", "shapes": [{"type": "mesh", "mesh": "m"}]},
               {"name": "arm", "position": [1, 2, 0], "shapes": [{"type": "box", "half_extents": [1, 0.1, 0.1]}]},
               {"name": "bob", "position": [3, 2, 0], "shapes": [{"type": "sphere", "radius": 0.2}]}],
    "joints": [{"type": "hinge", "name": "shoulder", "a": "world", "b": "arm", "anchor": [0, 2, 0], "axis": [0, 0, 1],
                "limits": [-1, 1]},
               {"type": "distance", "name": "rod", "a": "arm", "b": "bob", "anchor": [2, 2, 0]}]})";
  const SceneRunner runner = run(text, 15);
  const Scene final_scene = runner.final_scene();
  const std::string saved = write_scene(final_scene);
  const SceneResult<Scene> again = read_scene(saved);
  ASSERT_TRUE(again) << again.error().text();
  EXPECT_EQ(write_scene(*again), saved);
  // The anchor on the arm went along with the arm, the rod kept its length, the hinge's limits their places.
  const Pose arm = runner.world().pose(runner.bodies()[1]);
  const DVec3 tip = arm * Vec3{1, 0, 0};
  const DistanceDef& rod = std::get<DistanceDef>(again->joints[1].def);
  EXPECT_NEAR(length(rod.anchor - tip), 0.0, 1e-4);
  EXPECT_NEAR(*rod.length, 1.0f, 1e-6f);
  const HingeDef& shoulder = std::get<HingeDef>(again->joints[0].def);
  const float angle = 2.0f * std::atan2(arm.orientation.z, arm.orientation.w);
  ASSERT_TRUE(shoulder.limits);
  EXPECT_NEAR(shoulder.limits->low, -1.0f - angle, 0.02f);
  EXPECT_NEAR(shoulder.limits->high, 1.0f - angle, 0.02f);
  EXPECT_EQ(shoulder.anchor, (DVec3{0, 2, 0}));
  run(saved, 10);
}

// Fingers that one motor closes, a pair that passes through each other, a body that waits, and a push from a grid.
TEST(SceneRunner, CouplingsPairsAndDisabledBodiesGoOnInTheFinalScene) {
  const std::string text = R"({"gyre_scene": 1, "world": {"gravity": [0, 0, 0]},
    "bodies": [{"name": "hand", "type": "static"},
               {"name": "left", "position": [-1, 0, 0], "mass": 1, "shapes": [{"type": "box", "half_extents": [0.1, 0.3, 0.1]}]},
               {"name": "right", "position": [1, 0, 0], "mass": 1, "shapes": [{"type": "box", "half_extents": [0.1, 0.3, 0.1]}]},
               {"name": "spare", "enabled": false, "linear_velocity": [1, 0, 0], "position": [0, 5, 0], "shapes": [{"type": "sphere", "radius": 0.1}]},
               {"name": "leaf", "position": [9, 0, 0], "shapes": [{"type": "sphere", "radius": 0.1}]}],
    "joints": [{"type": "slider", "name": "l", "a": "hand", "b": "left", "axis": [1, 0, 0], "motor": {"target_velocity": 1, "max_force": 50}},
               {"type": "slider", "name": "r", "a": "hand", "b": "right", "axis": [-1, 0, 0]}],
    "couplings": [{"terms": [{"joint": "l"}, {"joint": "r", "coefficient": -1}]}],
    "ignored_pairs": [["left", "right"]],
    "force_fields": [{"type": "grid", "bounds": [[8, -1, -1], [10, 1, 1]], "points": [2, 2, 2],
                      "vectors": [[0,2,0],[0,2,0],[0,2,0],[0,2,0],[0,2,0],[0,2,0],[0,2,0],[0,2,0]]}]})";
  SceneRunner runner = run(text, 30);
  const auto place = [](const SceneRunner& of, std::size_t body) {
    return of.world().pose(of.bodies()[body]).position;
  };
  EXPECT_NEAR(place(runner, 2).x, -place(runner, 1).x, 1e-3);
  EXPECT_GT(place(runner, 1).x, -0.6);
  EXPECT_EQ(place(runner, 3).x, 0);
  EXPECT_GT(place(runner, 4).y, 0.2);
  const std::string saved = write_scene(runner.final_scene());
  SceneRunner rest = run(saved, 60);
  EXPECT_GT(place(rest, 1).x, 0.2) << "they passed through each other";
  EXPECT_NEAR(place(rest, 2).x, -place(rest, 1).x, 1e-3);
  EXPECT_FALSE(rest.world().enabled(rest.bodies()[3]));
  const SceneResult<Scene> wrong =
      read_scene(R"({"gyre_scene": 1, "couplings": [{"terms": [{"joint": "a"}, {"joint": "b"}]}]})");
  ASSERT_FALSE(wrong);
  EXPECT_EQ(wrong.error().pointer, "/couplings/0/terms/0/joint");
}

TEST(SceneRunner, RestoringASnapshotRestoresTheTimeOfForces) {
  const std::string text = pushed(R"({"force": [4, 0, 0], "start": 0.05, "end": 0.15})");
  SceneRunner runner = run(text, 8);
  const std::vector<std::byte> snapshot = save_snapshot(runner.world());
  for (int i = 0; i < 20; ++i) ASSERT_TRUE(runner.step());
  const std::uint64_t hash = runner.world().hash();
  EXPECT_EQ(runner.steps(), 28u);
  ASSERT_EQ(restore_snapshot(runner.world(), snapshot).code, ErrorCode::none);
  EXPECT_EQ(runner.steps(), 8u);
  EXPECT_NEAR(runner.time(), 0.08, 1e-12);
  for (int i = 0; i < 20; ++i) ASSERT_TRUE(runner.step());
  EXPECT_EQ(runner.world().hash(), hash);
}

TEST(SceneRunner, BodiesThatWereRemovedAreLeftOut) {
  const std::string ball = R"("shapes": [{"type": "sphere", "radius": 0.1}])";
  SceneRunner runner = run(R"({"gyre_scene": 1, "bodies": [
      {"name": "gone", "forces": [{"force": [1, 0, 0]}], )" +
                           ball + R"(}, {"name": "left", "position": [0, 1, 0], )" + ball +
                           R"(}, {"name": "bob", "position": [0, 3, 0], )" + ball + R"(}],
      "joints": [{"type": "distance", "a": "gone", "b": "left"}, {"type": "distance", "a": "left", "b": "bob"}]})");
  ASSERT_TRUE(runner.world().remove_body(runner.bodies()[0]));
  ASSERT_TRUE(runner.world().set_gravity({0, -1.5f, 0}));
  ASSERT_TRUE(runner.step()) << runner.problem();  // its force is no problem
  const Scene scene = runner.final_scene();
  ASSERT_EQ(scene.bodies.size(), 2u);
  EXPECT_EQ(scene.bodies[0].name, "left");
  ASSERT_EQ(scene.joints.size(), 1u);
  EXPECT_EQ(scene.joints[0].a, 0);
  EXPECT_EQ(scene.joints[0].b, 1);
  EXPECT_EQ(scene.world.gravity, (Vec3{0, -1.5f, 0}));
  run(write_scene(scene), 5);
}

}  // namespace
}  // namespace gyre::scene_runner_test
