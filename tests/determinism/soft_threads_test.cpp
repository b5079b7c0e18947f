// Cloths and solids that are large enough for all workers to step them together have the same bits for any number of threads, with a
// host whose workers run one after the other, and with more threads than cores.
#include <gyre/gyre.h>

#include <gtest/gtest.h>

#include <cstdint>
#include <string>

namespace gyre::soft_threads_test {
namespace {

constexpr int kSteps = 12;

// The large member has more vertices than all others together, so workers share its loops. The others are stepped by one worker each.
struct Scene {
  const char* name;
  void (*add_large)(World& world, BodyId ball);
};

void add_cloth(World& world, BodyId ball) {
  const SoftId cloth = world.add_cloth({.grid = ClothGrid{{2, 2}, {60, 60}}, .pose = {{0, 2, 0}, {}}});
  world.pin(cloth, 0);
  world.attach(cloth, 60, ball);
}
void add_membrane(World& world, BodyId) {
  ClothDef def{.grid = ClothGrid{{2, 2}, {50, 50}}, .pose = {{0, 2, 0}, {}}};
  def.links = ClothLinks::membrane;
  def.self_collision = false;
  def.settings.integrator = SoftIntegrator::sdirk2;
  world.pin(world.add_cloth(def), 0);
}
void add_solid(World& world, BodyId ball) {
  const SoftId solid = world.add_solid({.box = SolidBox{{0.5f, 0.5f, 0.5f}, {11, 11, 11}},
                                        .pose = {{0, 0.6, 0}, {}},
                                        .young_modulus = 1.0e5f});
  world.attach(solid, 5, ball);
}
void add_explicit_solid(World& world, BodyId) {
  world.add_solid({.box = SolidBox{{0.5f, 0.5f, 0.5f}, {11, 11, 11}},
                   .pose = {{0, 0.6, 0}, {}},
                   .model = SolidModel::neo_hookean,
                   .young_modulus = 1.0e4f,
                   .settings = {.integrator = SoftIntegrator::semi_implicit_euler}});
}

std::uint64_t hash_after_steps(const Scene& scene, WorldDef def) {
  World world = *World::create(def);
  world.add_body({.type = BodyType::fixed}, {.geometry = Plane{}});
  const BodyId ball =
      world.add_body({.pose = {{0.3, 2.5, 0.2}, {}}}, {.geometry = Sphere{0.2f}, .density = 100.0f});
  scene.add_large(world, ball);
  for (int i = 0; i < 4; ++i) {
    const SoftId rope = world.add_rope({.points = {{3.0 + i, 2, 0}, {4.0 + i, 2, 0}}, .segments = 20});
    world.pin(rope, 0);
  }
  world.add_cloth({.grid = ClothGrid{{0.5f, 0.5f}, {10, 10}}, .pose = {{-3, 1, 0}, {}}});
  for (int i = 0; i < kSteps; ++i) world.step(1.0f / 60.0f);
  return world.hash();
}

class SoftThreads : public testing::TestWithParam<Scene> {};

TEST_P(SoftThreads, SameBitsForAnyNumber) {
  const std::uint64_t expected = hash_after_steps(GetParam(), {});
  for (const int threads : {2, 3, 8})
    EXPECT_EQ(hash_after_steps(GetParam(), {.threads = threads}), expected) << threads << " threads";
}

TEST_P(SoftThreads, SameBitsWithAHostThatRunsWorkersOneAfterTheOther) {
  WorldDef hosted;
  hosted.host_tasks.worker_count = 5;
  hosted.host_tasks.run = [](void*, int count, void (*task)(void*, int), void* context) {
    for (int i = count; i-- > 0;) task(context, i);
  };
  EXPECT_EQ(hash_after_steps(GetParam(), hosted), hash_after_steps(GetParam(), {}));
}

INSTANTIATE_TEST_SUITE_P(Scenes, SoftThreads,
                         testing::Values(Scene{"cloth", add_cloth}, Scene{"membrane", add_membrane},
                                         Scene{"solid", add_solid},
                                         Scene{"explicit_solid", add_explicit_solid}),
                         [](const auto& tested) { return std::string(tested.param.name); });

}  // namespace
}  // namespace gyre::soft_threads_test
