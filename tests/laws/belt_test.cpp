// Surfaces with rules: belts that run, platforms that hold from one side, triangles with materials of their own.
#include "laws/kit.h"

#include <gyre/replay.h>

namespace gyre::laws::belt_test {
namespace {

constexpr std::uint16_t kBelt = 7;

// A box laid on a running belt slips at a = mu g until it has the belt's speed, and then goes with it.
struct BeltRun {
  double time_to_match = 0.0, slip = 0.0, fastest = 0.0, final_speed = 0.0, sideways = 0.0, turned = 0.0;
};
BeltRun ride(double belt_speed, double mu, Quat orientation, double seconds, bool belt_is_box,
             BodyType type) {
  World world = make_world();
  Material rubber = surface(float(mu));
  rubber.id = kBelt;
  const Vec3 along = rotate(orientation, {1, 0, 0});
  const AnyShape shape = belt_is_box ? AnyShape(Box{{50, 0.5f, 50}}) : AnyShape(Plane{});
  const Vec3 down = belt_is_box ? Vec3{0, -0.5f, 0} : Vec3{};
  world.add_body({.type = type, .pose = {DVec3(down), orientation}}, {.geometry = shape, .material = rubber});
  EXPECT_TRUE(world.set_surface_rule({.id = kBelt, .velocity = {float(belt_speed), 0, 0}}));
  const BodyId box = world.add_body({.pose = {{0, 0.5, 0}, orientation}},
                                    {.geometry = Box{}, .material = surface(float(mu))});
  BeltRun run;
  bool matched = false;
  constexpr float kShort = 1.0f / 240.0f;
  for (int i = 1; i <= int(seconds * 240.0); ++i) {
    world.step(kShort);
    const Vec3 v = world.linear_velocity(box);
    const double speed = double(dot(v, along));
    run.fastest = std::max(run.fastest, speed);
    run.sideways = std::max(run.sideways, double(length(v - float(speed) * along)));
    run.turned = std::max(run.turned, double(length(world.angular_velocity(box))));
    if (!matched && speed > 0.999 * belt_speed) {
      matched = true;
      run.time_to_match = i / 240.0;
      run.slip = belt_speed * run.time_to_match - dot(world.pose(box).position, DVec3(along));
    }
    run.final_speed = speed;
  }
  return run;
}

TEST(Belt, TakesABoxToItsSpeedByTheLawOfFriction) {
  const double v = 2.0, mu = 0.5;
  for (const bool box : {false, true}) {
    const BeltRun run = ride(v, mu, {}, 2.0, box, BodyType::fixed);
    EXPECT_TRUE(relative_row("A-71 time to match", run.time_to_match, v / (mu * kGravity), 0.02, 0.001));
    EXPECT_TRUE(relative_row("A-71 slip", run.slip, v * v / (2.0 * mu * kGravity), 0.02, 0.001));
    EXPECT_TRUE(row("A-71 final speed", run.final_speed, v, 1e-3, 1e-5));
    EXPECT_TRUE(limit_row("A-71 fastest", run.fastest, v + 1e-3, v + 1e-5));
    EXPECT_TRUE(limit_row("A-71 sideways", run.sideways, 0.02, 1e-3));
  }
}
TEST(Belt, AcceleratesByHalfAsMuchOnHalfTheFriction) {
  const BeltRun slow = ride(1.0, 0.1, {}, 2.0, true, BodyType::kinematic);
  EXPECT_TRUE(relative_row("time to match", slow.time_to_match, 1.0 / (0.1 * kGravity), 0.02, 0.001));
}
TEST(Belt, RunsInTheFrameOfItsBody) {
  const BeltRun turned = ride(2.0, 0.5, from_axis_angle({0, 1, 0}, 0.7f), 2.0, true, BodyType::fixed);
  EXPECT_TRUE(row("final speed along", turned.final_speed, 2.0, 1e-3, 1e-5));
}
TEST(Belt, StopsAndTurnsRoundWhenItsRuleChanges) {
  World world = make_world();
  Material rubber = surface(0.8f);
  rubber.id = kBelt;
  world.add_body({.type = BodyType::fixed}, {.geometry = Plane{}, .material = rubber});
  const BodyId box =
      world.add_body({.pose = {{0, 0.5, 0}, {}}}, {.geometry = Box{}, .material = surface(0.8f)});
  run(world, 2.0);
  EXPECT_FALSE(world.is_awake(box));
  for (const float speed : {1.5f, 0.0f, -1.0f}) {
    EXPECT_TRUE(world.set_surface_rule({.id = kBelt, .velocity = {speed, 0, 0}}));
    run(world, 1.0);
    EXPECT_NEAR(double(world.linear_velocity(box).x), double(speed), 2e-3);
  }
}

// ------------------------------------------------------------------------------------------------------- one-way surfaces

constexpr std::uint16_t kPlatform = 9;

World with_platform(float thickness) {
  World world = make_world();
  Material wood = surface(0.6f);
  wood.id = kPlatform;
  world.add_body({.type = BodyType::fixed, .pose = {{0, -double(thickness), 0}, {}}},
                 {.geometry = Box{{5, thickness, 5}}, .material = wood});
  EXPECT_TRUE(world.set_surface_rule({.id = kPlatform, .material = wood, .one_way = {0, 1, 0}}));
  return world;
}

TEST(OneWay, LetsPassFromBelowAsIfItWereNotThere) {
  for (const AnyShape& shape : {AnyShape(Sphere{0.3f}), AnyShape(Box{{0.3f, 0.3f, 0.3f}})}) {
    for (const float thickness : {0.05f, 0.5f}) {
      World world = with_platform(thickness), empty = make_world();
      const BodyDef def{.pose = {{0.2, -3, 0.1}, {}}, .linear_velocity = {0, 9.5f, 0}, .can_sleep = false};
      const BodyId a = world.add_body(def, {.geometry = shape}), b = empty.add_body(def, {.geometry = shape});
      double highest = -10.0;
      for (int i = 0; i < 55; ++i) {
        world.step(kStep);
        empty.step(kStep);
        EXPECT_EQ(world.linear_velocity(a), empty.linear_velocity(b)) << i;
        EXPECT_NEAR(world.pose(a).position.y, empty.pose(b).position.y, 1e-6) << i;
        highest = std::max(highest, world.pose(a).position.y);
      }
      EXPECT_GT(highest, 1.0);
      // It comes down on the platform and stays there.
      run(world, 3.0);
      EXPECT_NEAR(world.pose(a).position.y, 0.3, 0.01);
      EXPECT_LT(length(world.linear_velocity(a)), 0.01f);
    }
  }
}
TEST(OneWay, HoldsFromAboveAtAnySpeed) {
  for (const float speed : {0.0f, 5.0f, 30.0f}) {
    World world = with_platform(0.1f);
    const BodyId box = world.add_body({.pose = {{0, 2, 0}, {}}, .linear_velocity = {0, -speed, 0}},
                                      {.geometry = Box{{0.3f, 0.3f, 0.3f}}});
    double lowest = 10.0;
    for (int i = 0; i < 240; ++i) {
      world.step(kStep);
      lowest = std::min(lowest, world.pose(box).position.y);
    }
    EXPECT_GT(lowest, 0.25) << speed;
    EXPECT_NEAR(world.pose(box).position.y, 0.3, 0.01) << speed;
  }
}
// Bodies that go farther than their size in a step are swept against what is in their way: not against what lets them pass.
TEST(OneWay, LetsPassAtAnySpeed) {
  for (const float speed : {15.0f, 40.0f, 200.0f}) {
    World world = with_platform(0.1f), empty = make_world();
    const BodyDef def{.pose = {{0.2, -3, 0.1}, {}}, .linear_velocity = {0, speed, 0}, .continuous = true};
    const BodyId a = world.add_body(def, {.geometry = Sphere{0.2f}}), b = empty.add_body(def, {.geometry = Sphere{0.2f}});
    for (int i = 0; i < 40; ++i) {
      world.step(kStep);
      empty.step(kStep);
      EXPECT_EQ(world.pose(a).position, empty.pose(b).position) << speed << " m/s, step " << i;
    }
  }
}
TEST(OneWay, LetsFallBackWhatTurnsRoundHalfWay) {
  World world = with_platform(0.1f);
  // Its middle comes to 0.05 m below the platform's top and no higher.
  const double rise = 1.0;
  const BodyId ball = world.add_body(
      {.pose = {{0, -0.05 - rise, 0}, {}}, .linear_velocity = {0, float(std::sqrt(2 * kGravity * rise)), 0}},
      {.geometry = Sphere{0.3f}});
  run(world, 2.0);
  EXPECT_LT(world.pose(ball).position.y, -5.0);
}

// ---------------------------------------------------------------------------------------------------- triangle materials

// A floor of many triangles, half of it ice by its triangles' ids: what slides there goes on as the law says.
TEST(TriangleMaterials, DecideWhatSlides) {
  constexpr int kCells = 20;
  std::vector<Vec3> vertices;
  std::vector<std::uint32_t> indices;
  std::vector<std::uint16_t> materials;
  for (int row = 0; row <= kCells; ++row) {
    for (int column = 0; column <= kCells; ++column)
      vertices.push_back({float(column) - 10.0f, 0, float(row) - 10.0f});
  }
  for (std::uint32_t row = 0; row < kCells; ++row) {
    for (std::uint32_t column = 0; column < kCells; ++column) {
      const std::uint32_t at = row * (kCells + 1) + column;
      indices.insert(indices.end(), {at, at + kCells + 1, at + 1, at + 1, at + kCells + 1, at + kCells + 2});
      const std::uint16_t id = row < kCells / 2 ? std::uint16_t{3} : std::uint16_t{0};
      materials.insert(materials.end(), {id, id});
    }
  }
  World world = make_world({.friction_rule = CombineRule::minimum});
  const Result<Geometry> mesh = cook_mesh({.vertices = vertices, .indices = indices, .materials = materials});
  ASSERT_TRUE(mesh.has_value());
  world.add_body({.type = BodyType::fixed}, {.geometry = *mesh, .material = surface(0.5f)});
  EXPECT_TRUE(world.set_surface_rule({.id = 3, .material = surface(0.05f)}));
  const Vec3 start{2, 0, 0};
  const BodyDef def{.linear_velocity = start, .can_sleep = false};
  BodyDef on_ice = def, on_wood = def;
  on_ice.pose.position = {-6, 0.25, -5};
  on_wood.pose.position = {-6, 0.25, 5};
  const ShapeDef slab{.geometry = Box{{0.25f, 0.25f, 0.25f}}, .material = surface(1.0f)};
  const BodyId ice = world.add_body(on_ice, slab), wood = world.add_body(on_wood, slab);
  run(world, 0.25);
  EXPECT_NEAR(double(world.linear_velocity(ice).x), 2.0 - 0.05 * kGravity * 0.25, 0.02);
  EXPECT_NEAR(double(world.linear_velocity(wood).x), 2.0 - 0.5 * kGravity * 0.25, 0.05);

  // The same after a snapshot, and the same hash.
  const std::vector<std::byte> saved = save_snapshot(world);
  Result<World> again = load_snapshot(saved);
  ASSERT_TRUE(again.has_value()) << again.error().message;
  EXPECT_EQ(again->hash(), world.hash());
  for (int i = 0; i < 60; ++i) {
    world.step(kStep);
    again->step(kStep);
  }
  EXPECT_EQ(again->hash(), world.hash());
  EXPECT_FALSE(
      cook_mesh({.vertices = vertices, .indices = indices, .materials = std::span(materials).first(3)})
          .has_value());
}

TEST(SurfaceRules, AreRefusedWhenTheyCannotBe) {
  World world = make_world();
  EXPECT_FALSE(world.set_surface_rule({}));
  EXPECT_FALSE(world.set_surface_rule({.id = 1, .velocity = {std::nanf(""), 0, 0}}));
  EXPECT_FALSE(world.set_surface_rule({.id = 1, .one_way = {0, INFINITY, 0}}));
  EXPECT_FALSE(world.set_surface_rule({.id = 1, .material = surface(-1.0f)}));
  EXPECT_EQ(world.problems().size(), 4u);
  const std::uint64_t empty = world.hash();
  EXPECT_TRUE(world.set_surface_rule({.id = 1, .velocity = {1, 0, 0}}));
  EXPECT_NE(world.hash(), empty);
}

}  // namespace
}  // namespace gyre::laws::belt_test
