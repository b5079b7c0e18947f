// A heap of ragdolls among other bodies: how its bodies are moved (dynamics/fused_stages) shows in no bit.
#include "ragdoll_scenes.h"

namespace gyre::kit::ragdoll_heap_test {
namespace {

using namespace ragdoll_test;

World make_world_of(int threads, int width) {
  WorldDef def;
  def.threads = threads;
  def.simd_width = width;
  return std::move(*World::create(def));
}
// Where all bodies are and how they move, to the bit.
std::vector<float> read_bodies(const World& world) {
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
// A rope that is never taut. Such a joint is swept, so bodies are moved stage by stage.
void add_slack(World& world, BodyId a, BodyId b) {
  world.add_joint(DistanceDef{.a = a, .b = b, .max_length = 1000.0f, .collide_connected = true});
}
void expect_the_same(std::vector<float> (*outcome)(bool slack, int threads, int width)) {
  const std::vector<float> expected = outcome(true, 1, 1);
  for (const bool slack : {false, true})
    for (const int threads : {1, 2, 3})
      for (const int width : {4, 8, 16})
        EXPECT_TRUE(expected == outcome(slack, threads, width))
            << slack << ", " << threads << " threads, " << width << " lanes";
}

// Linkages of three shapes, more than fill the lanes of one, and boxes, of which some spin so fast that they turn alone.
std::vector<float> heap(bool slack, int threads, int width) {
  World world = make_world_of(threads, width);
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
      world.add_joint(BallDef{.a = boxes[std::size_t(i - 1)],
                              .b = boxes[std::size_t(i)],
                              .anchor = def.pose.position,
                              .collide_connected = true});
    }
  }
  // The rope hangs between two boxes that fall far away: what is jointed is swept in another way where it turns fast.
  BodyId ends[2];
  for (BodyId& end : ends) {
    const double x = 100.0 + 2.0 * double(&end - ends);
    end = world.add_body({.pose = {.position = {x, 100, 0}}}, {.geometry = Box{{0.1f, 0.1f, 0.1f}}});
  }
  if (slack) add_slack(world, ends[0], ends[1]);
  for (int step = 0; step < 90; ++step) EXPECT_TRUE(world.step(kStep));
  EXPECT_GT(world.stats().touching, 150);
  for (const BodyId end : ends) EXPECT_TRUE(world.remove_body(end));
  return read_bodies(world);
}

TEST(RagdollHeap, IsTheSameRunByRunAndStageByStage) { expect_the_same(heap); }

// What is kinematic moves between contacts, too: nobody may ask after it before, or meanwhile. (Boxes: what a slack rope needs.)
std::vector<float> on_a_swing(bool slack, int threads, int width) {
  World world = make_world_of(threads, width);
  const RagdollDef limp = free_humanoid();
  std::vector<BodyId> swings;
  for (int i = 0; i < 20; ++i) {
    const DVec3 place{2.0 * (i % 5), 6.0, 2.0 * (i / 5)};
    swings.push_back(world.add_body({.type = BodyType::kinematic, .pose = {.position = place}},
                                    {.geometry = Box{{0.2f, 0.1f, 0.2f}}}));
    world.set_velocity(swings.back(), {0.5f, 0.25f * float(i % 3), 0}, {0, 2.0f, 1.0f});
    const Ragdoll ragdoll = add(world, limp, rest_pose(limp, {place - DVec3{0, 2.5, 0}, {}}));
    world.add_joint(
        BallDef{.a = swings.back(), .b = ragdoll.bones[0].body, .anchor = place - DVec3{0, 0.5, 0}});
  }
  std::vector<BodyId> boxes;
  for (const BodyId swing : swings) {
    const DVec3 place = world.pose(swing).position + DVec3{0, 20, 0};
    boxes.push_back(world.add_body({.pose = {.position = place}}, {.geometry = Box{{0.1f, 0.1f, 0.1f}}}));
    if (slack) add_slack(world, swing, boxes.back());
  }
  for (int step = 0; step < 60; ++step) EXPECT_TRUE(world.step(kStep));
  for (const BodyId box : boxes) EXPECT_TRUE(world.remove_body(box));
  return read_bodies(world);
}

TEST(RagdollHeap, HangsOnWhatMovesByItselfAlike) { expect_the_same(on_a_swing); }

// Limbs pass each other by several of their sizes in a step, and turn by radians.
TEST(RagdollHeap, ThrownAtAFloorFastGainsNoEnergy) {
  constexpr int kFalls = 40, kCount = 8, kSteps = 40;
  std::mt19937 random(1);
  std::uniform_real_distribution<float> draw(-1, 1);
  const RagdollDef def = *stabilized(make_humanoid());
  for (int fall = 0; fall < kFalls; ++fall) {
    World world = make_world({});
    world.add_body({.type = BodyType::fixed, .pose = {.position = {0, -0.5, 0}}},
                   {.geometry = Box{{5, 0.5f, 5}}});
    for (int i = 0; i < kCount; ++i) {
      const Quat turn = normalized(Quat{draw(random), draw(random), draw(random), draw(random)});
      const Pose pose{{0.5 * double(draw(random)), 1.2 + 0.9 * i, 0.5 * double(draw(random))}, turn};
      for (const RagdollBone& bone : add(world, def, middle_pose(def, pose)).bones)
        world.set_velocity(bone.body, {0, -60, 0}, {});
    }
    const double begin = world.energy().kinetic;
    for (int step = 0; step < kSteps; ++step) {
      const double before = world.energy().kinetic;
      ASSERT_TRUE(world.step(kStep));
      ASSERT_LT(world.energy().kinetic, before + 1e-3 * begin) << "fall " << fall << ", step " << step;
    }
  }
}

}  // namespace
}  // namespace gyre::kit::ragdoll_heap_test
