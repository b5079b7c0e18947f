// A heap of ragdolls among other bodies: how its bodies are moved (rigid/bundle_runs) shows in no bit.
#include "ragdoll_scenes.h"

namespace gyre::kit {
namespace {

using namespace ragdoll_test;

// Linkages of three shapes, more than fill the lanes of one, and boxes, of which some spin so fast that they turn alone. `slack`: two of
// the boxes hang on a rope that is never taut. Such a joint is swept, so bodies are moved stage by stage.
std::vector<float> outcome(bool slack, int threads, int width) {
  WorldDef world_def;
  world_def.threads = threads;
  world_def.simd_width = width;
  World world = std::move(*World::create(world_def));
  add_ground(world);
  const RagdollDef limp = free_humanoid(), stiff = make_humanoid();
  std::mt19937 random(5);
  const auto place = [&](int i) { return DVec3{0.6 * (i % 3), 0.9 + 0.7 * (i / 9), 0.6 * (i / 3 % 3)}; };
  int placed = 0;
  for (int i = 0; i < 19; ++i)
    add(world, limp, random_pose(limp, {place(placed++), random_turn(random)}, random, 0.8f));
  for (int i = 0; i < 3; ++i)
    add(world, stiff, random_pose(stiff, {place(placed++), random_turn(random)}, random, 0.8f));
  std::vector<BodyId> boxes;
  for (int i = 0; i < 30; ++i) {
    BodyDef def;
    def.pose.position = place(placed++) + DVec3{0.2, 0, 0.1};
    def.angular_velocity = i % 4 == 0 ? Vec3{20, 5, 0} : Vec3{};
    boxes.push_back(world.add_body(def, {.geometry = Box{{0.1f, 0.15f, 0.2f}}}));
    // Chains of two and a single one between a moving body and the world.
    if (i % 3 == 1) {
      world.add_joint({.kind = JointKind::ball,
                       .a = boxes[std::size_t(i - 1)],
                       .b = boxes[std::size_t(i)],
                       .anchor = def.pose.position,
                       .collide_connected = true});
    }
  }
  if (slack)
    world.add_joint({.kind = JointKind::distance,
                     .a = boxes[2],
                     .b = boxes[5],
                     .max_length = 1000.0f,
                     .collide_connected = true});
  for (int step = 0; step < 90; ++step) EXPECT_TRUE(world.step(kStep));
  EXPECT_GT(world.counts().touching, 150);
  std::vector<float> all;
  const auto list = [&](Vec3 v) { all.insert(all.end(), {v.x, v.y, v.z}); };
  const BodyColumns bodies = world.bodies();
  for (std::size_t i = 0; i < bodies.ids.size(); ++i) {
    const Quat q = bodies.poses[i].orientation;
    list(to_float(bodies.poses[i].position)), list({q.x, q.y, q.z}), all.push_back(q.w);
    list(bodies.linear_velocities[i]), list(bodies.angular_velocities[i]);
  }
  return all;
}

TEST(RagdollHeap, IsTheSameRunByRunAndStageByStage) {
  const auto expected = outcome(true, 1, 1);
  for (const bool slack : {false, true})
    for (const int threads : {1, 2, 3})
      for (const int width : {4, 16})
        EXPECT_TRUE(expected == outcome(slack, threads, width))
            << slack << ", " << threads << " threads, " << width << " lanes";
}

}  // namespace
}  // namespace gyre::kit
