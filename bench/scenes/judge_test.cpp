// The judge of the benchmark scenes against figures that are known by construction, and every scene as it is built.
#include "bench/scenes/judge.h"

#include <gtest/gtest.h>

#include <cmath>

#include "bench/scenes/builders.h"
#include "bench/scenes/gyre_engine.h"

namespace gyre::bench::judge_test {
namespace {

std::vector<BodyState> at_start(const Scene& scene) {
  std::vector<BodyState> states;
  for (const Body& body : scene.bodies) states.push_back({{body.pos, body.q}, body.vel, body.ang});
  return states;
}

TEST(Judge, MeasuresOverlap) {
  Scene scene;
  ground(scene, 10);
  add(scene, box({0.5, 0.5, 0.5}), {0, 0.49, 0});                               // 10 mm in the ground
  add(scene, sphere(0.5), {3, 0.47, 0});                                        // 30 mm
  add(scene, capsule(0.2, 0.5), {6, 0.19, 0}, axis_angle({0, 0, 1}, kPi / 2));  // 10 mm, lying
  add(scene, box({0.5, 0.5, 0.5}), {0, 1.485, 0},
      axis_angle({0, 1, 0}, kPi / 4));  // 5 mm in the first, turned
  const Quality q = Judge(scene).look(at_start(scene));
  EXPECT_EQ(q.touching, 4);
  EXPECT_EQ(q.deep, 0);
  EXPECT_NEAR(q.pen_max, 0.03, 1e-9);
  EXPECT_NEAR(q.pen_mean, (0.01 + 0.03 + 0.01 + 0.005) / 4, 1e-9);
}

TEST(Judge, MeasuresDriftAndWhatIsLost) {
  Scene scene;
  ground(scene, 10);
  scene.tops.push_back(add(scene, box({0.5, 0.5, 0.5}), {0, 5, 0}));
  add(scene, sphere(0.5), {3, 0.5, 0});
  std::vector<BodyState> states = at_start(scene);
  states[1].pose.p = {0.3, 4.9, 0.4};
  states[2].pose.p = {3, -5, 0};
  states[1].velocity = {0, 3, 4};
  const Quality q = Judge(scene).look(states);
  EXPECT_NEAR(q.drift_max, 0.5, 1e-12);
  EXPECT_NEAR(q.sink_max, 0.1, 1e-12);
  EXPECT_NEAR(q.speed_max, 5.0, 1e-12);
  EXPECT_NEAR(q.speed_mean, 2.5, 1e-12);
  EXPECT_EQ(q.lost, 1);
  states[1].pose.p.x = std::nan("");
  EXPECT_FALSE(Judge(scene).look(states).finite);
}

TEST(Judge, MeasuresJoints) {
  Scene scene;
  const int a = add(scene, sphere(0.1), {0, 0, 0}, {}, Motion::fixed);
  const int b = add(scene, sphere(0.1), {1, 0, 0});
  scene.joints.push_back({JointKind::hinge, a, b, {0.5, 0, 0}, {0, 1, 0}, 0, -0.5, 0.5});
  std::vector<BodyState> states = at_start(scene);
  // Turned by 0.7 rad about the hinge and 3 mm off: 0.2 rad beyond its limit.
  const Quat turn = axis_angle({0, 1, 0}, 0.7);
  states[1].pose = {V3{0.5, 0.003, 0} + rot(turn, {0.5, 0, 0}), turn};
  const Quality q = Judge(scene).look(states);
  EXPECT_NEAR(q.joint_max, 0.003, 1e-12);
  EXPECT_NEAR(q.limit_max, 0.2 * 180 / kPi, 1e-9);
}

TEST(Scenes, AreWhatTheirNamesSay) {
  for (const char* name : scene_names()) {
    const std::optional<Scene> scene = find_scene(name);
    ASSERT_TRUE(scene) << name;
    EXPECT_EQ(scene->name, name);
    EXPECT_GT(scene->bodies.size(), 10u) << name;
  }
  EXPECT_EQ(find_scene("box_pile")->bodies.size(), 4005u);
  EXPECT_EQ(find_scene("box_pile:1000")->bodies.size(), 1005u);
  EXPECT_EQ(find_scene("mesh_rain:500")->bodies.size(), 501u);
  EXPECT_FALSE(find_scene("box_pile:0"));
  for (const char* huge : {"pyramid:1001", "pyramid:99999999", "spheres:1000001", "stacks:99999999999999999999"})
    EXPECT_FALSE(find_scene(huge)) << huge;
  EXPECT_FALSE(find_scene("tower:7")) << "has no size";
  EXPECT_FALSE(find_scene("no_such_scene"));
}

// The piles of given size are as dense as those of the standard size.
TEST(Scenes, PilesGrowSideways) {
  for (const int count : {1000, 16000}) {
    const Scene scene = *find_scene("box_pile:" + std::to_string(count));
    double top = 0;
    for (const Body& body : scene.bodies)
      top = body.motion == Motion::dynamic ? std::max(top, body.pos.y) : top;
    EXPECT_NEAR(top, find_scene("box_pile")->bodies.back().pos.y, 4.0) << count;
  }
}

TEST(GyreEngine, KeepsATowerWhereItStands) {
  const Scene scene = *find_scene("tower");
  GyreEngine engine;
  std::string why_not;
  ASSERT_TRUE(engine.create(scene, 1, false, why_not)) << why_not;
  const RunResult r = run(engine, scene, 120);
  EXPECT_EQ(r.steps, 120);
  EXPECT_LT(r.end.sink_max, 1e-3);
  EXPECT_LT(r.end.pen_max, 1e-3);
  EXPECT_EQ(r.end.lost, 0);
  EXPECT_GT(r.cpu_ms_per_step, 0.0);
}

}  // namespace
}  // namespace gyre::bench::judge_test
