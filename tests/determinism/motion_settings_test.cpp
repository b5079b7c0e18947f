// Every integrator, kind of spring and time plan gives the same bits whatever the threads and the SIMD width, and goes on from a
// snapshot or a rollback as if nothing had been.
#include <gyre/gyre.h>
#include <gyre/replay.h>

#include <gtest/gtest.h>

#include <string>

namespace gyre::motion_settings_test {
namespace {

constexpr int kSteps = 40, kMiddle = 21;

// Boxes that fall on each other and stand, a net of springs (one end on a box that stands), bodies that tumble in a wind, one bound to
// an axis, one that bounces.
World make_scene(const Stepping& stepping, int threads, int width) {
  WorldDef def;
  def.threads = threads;
  def.simd_width = width;
  def.stepping = stepping;
  World world = *World::create(def);
  world.add_body({.type = BodyType::fixed}, {.geometry = Plane{}, .material = {.restitution = 0.6f}});
  BodyId boxes[8], knots[12];
  for (int i = 0; i < 8; ++i) {
    boxes[i] = world.add_body({.pose = {.position = {1.5 * (i % 3), 0.6 + 1.1 * (i / 3), 0.1 * i}}},
                              {.geometry = Box{{0.5f, 0.5f, 0.4f}}});
  }
  for (int i = 0; i < 12; ++i) {
    knots[i] =
        world.add_body({.pose = {.position = {5.0 + 0.4 * (i % 4), 3.0 + 0.4 * (i / 4), 0}}, .mass = 0.2f},
                       {.geometry = Sphere{.radius = 0.1f}});
  }
  const auto tie = [&](BodyId a, BodyId b) {
    world.add_joint(
        DistanceDef{.a = a, .b = b, .anchor = world.pose(a).position, .stiffness = 200.0f, .damping = 0.5f});
  };
  for (int i = 0; i < 12; ++i) {
    if (i % 4 != 3) tie(knots[i], knots[i + 1]);
    if (i < 8) tie(knots[i], knots[i + 4]);
  }
  tie(boxes[0], knots[8]);
  tie(boxes[1], boxes[6]);
  world.add_joint(DistanceDef{.b = knots[11], .anchor = {6, 6, 0}, .stiffness = 100.0f});
  for (int i = 0; i < 5; ++i) {
    world.add_body({.pose = {.position = {20.0 + 3.0 * i, 8, 0}},
                    .angular_velocity = {float(i), 3, 0.2f},
                    .locked = {.angular = {i == 2, false, false}}},
                   {.geometry = Box{{0.2f, 0.4f, 0.7f}}});
  }
  world.add_body({.pose = {.position = {-5, 2, 0}}},
                 {.geometry = Sphere{.radius = 0.3f}, .material = {.restitution = 0.8f}});
  FieldDef wind;
  wind.velocity = {2, 0, 1};
  wind.bounds = FieldBounds{{15, -10, -50}, {50, 50, 50}};
  world.add_field(wind);
  return world;
}

std::string name_of(const Stepping& s) {
  return std::string(to_string(s.integrator)) + " " + to_string(s.springs) + " " + to_string(s.time);
}

void step_on(World& world, int steps) {
  for (int i = 0; i < steps; ++i) world.step(1.0f / 60.0f);
}

class MotionSettings : public testing::TestWithParam<int> {
 protected:
  Stepping stepping() const {
    Stepping s;
    s.substeps = 2;
    s.tolerance = 1e-2f;
    s.integrator = IntegratorKind(GetParam() % kIntegratorKindCount);
    s.time = TimeStepping(GetParam() / kIntegratorKindCount % kTimeSteppingCount);
    s.springs = GetParam() / kIntegratorKindCount / kTimeSteppingCount == 0 ? SpringKind::implicit
                                                                            : SpringKind::explicit_force;
    return s;
  }
};

TEST_P(MotionSettings, NeverDependOnThreadsOrWidth) {
  World plain = make_scene(stepping(), 1, 1);
  step_on(plain, kSteps);
  // Explicit Euler gains energy in springs, as it says.
  const bool grows = stepping().integrator == IntegratorKind::explicit_euler &&
                     stepping().springs == SpringKind::explicit_force;
  for (const BodyId body : grows ? std::span<const BodyId>{} : plain.bodies().ids)
    EXPECT_LT(length(plain.pose(body).position), 1e3) << name_of(stepping());
  for (const auto& [threads, width] : {std::pair{3, 1}, {1, 8}, {2, 4}}) {
    World other = make_scene(stepping(), threads, width);
    step_on(other, kSteps);
    EXPECT_EQ(other.hash(), plain.hash())
        << name_of(stepping()) << ", " << threads << " threads, width " << width;
  }
}

TEST_P(MotionSettings, GoOnFromASnapshotAndARollback) {
  World plain = make_scene(stepping(), 1, 0);
  step_on(plain, kMiddle);
  const std::vector<std::byte> bytes = save_snapshot(plain);
  Rollback ring(2);
  ring.save(plain);
  step_on(plain, kSteps - kMiddle);
  const std::uint64_t hash = plain.hash();
  Result<World> loaded = load_snapshot(bytes);
  ASSERT_TRUE(loaded) << loaded.error().message;
  EXPECT_EQ(loaded->def().stepping.integrator, stepping().integrator);
  EXPECT_EQ(loaded->def().stepping.time, stepping().time);
  step_on(*loaded, kSteps - kMiddle);
  EXPECT_EQ(loaded->hash(), hash) << name_of(stepping());
  ASSERT_TRUE(ring.restore(plain, kMiddle));
  step_on(plain, kSteps - kMiddle);
  EXPECT_EQ(plain.hash(), hash) << name_of(stepping());
}

INSTANTIATE_TEST_SUITE_P(All, MotionSettings,
                         testing::Range(0, 2 * kIntegratorKindCount * kTimeSteppingCount));

}  // namespace
}  // namespace gyre::motion_settings_test
