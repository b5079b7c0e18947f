// Ropes, cloths and solids in a world: laws that hold whatever the masses and stiffnesses are.
#include "determinism/scenes.h"
#include "memory_sink.h"

#include <gyre/gyre.h>
#include <gyre/replay.h>

#include <gtest/gtest.h>

#include <cmath>

namespace gyre::soft_matter_test {
namespace {

constexpr float kStep = 1.0f / 60.0f;

World make_world(Vec3 gravity = {0, -9.81f, 0}, int threads = 1, int width = 0) {
  WorldDef def;
  def.gravity = gravity;
  def.threads = threads;
  def.simd_width = width;
  return std::move(*World::create(def));
}

BodyId add_ball(World& world, DVec3 at, float radius, float mass, BodyType type = BodyType::dynamic) {
  BodyDef body;
  body.type = type;
  body.pose.position = at;
  if (mass > 0.0f) body.mass = mass;
  return world.add_body(body, ShapeDef{.geometry = Sphere{radius}});
}
BodyId add_box(World& world, DVec3 at, Vec3 half, float mass) {
  BodyDef body;
  body.pose.position = at;
  body.mass = mass;
  return world.add_body(body, ShapeDef{.geometry = Box{half}});
}
void add_ground(World& world) { scenes::add_fixed(world, {0, 0, 0}, Plane{}); }

void step(World& world, int steps) {
  for (int i = 0; i < steps; ++i) world.step(kStep);
}

double lowest(const SoftVertices& v) {
  double low = 1e300;
  for (std::size_t i = 0; i < v.size(); ++i) low = std::fmin(low, v.y[i]);
  return low;
}
double rope_length(const SoftVertices& v) {
  double sum = 0.0;
  for (std::size_t i = 1; i < v.size(); ++i) sum += length(v.position(i) - v.position(i - 1));
  return sum;
}

ClothDef sheet(float size, int cells, DVec3 at) {
  ClothDef def;
  def.grid = ClothGrid{{size, size}, {cells, cells}};
  def.pose.position = at;
  return def;
}

// A rope of 1 kg carries 10 t, from the world and from a body of 20 t, whose joint lets it slide sideways only.
TEST(SoftMatter, ARopeCarriesTenThousandTimesItsMass) {
  for (const bool between_bodies : {false, true}) {
    World world = make_world();
    RopeDef def{.points = {{0, 10, 0}, {0, 0, 0}}, .segments = 100};
    const SoftId rope = world.add_rope(def);
    const BodyId load = add_box(world, {0, -0.5, 0}, {0.5f, 0.5f, 0.5f}, 10000.0f);
    ASSERT_TRUE(world.attach(rope, 100, load));
    if (between_bodies) {
      const BodyId hook = add_box(world, {0, 10.5, 0}, {0.5f, 0.5f, 0.5f}, 20000.0f);
      world.add_joint(SliderDef{.a = hook, .anchor = {0, 10.5, 0}, .axis = {1, 0, 0}});
      ASSERT_TRUE(world.attach(rope, 0, hook));
    } else {
      ASSERT_TRUE(world.pin(rope, 0));
    }
    for (int i = 0; i < 120; ++i) {
      world.step(kStep);
      ASSERT_NEAR(rope_length(world.vertices(rope)), 10.0, 0.01) << i;
    }
    EXPECT_LT(length(world.linear_velocity(load)), 1.0e-3f);
    EXPECT_NEAR(world.pose(load).position.y, -0.5, 0.01);
  }
}

// Planks on four ropes, two on either side: more attachments than the planks have freedoms. A ball falls on it.
void expect_bridge_gains_nothing(const Stepping& stepping, RopeLinks links) {
  WorldDef world_def;
  world_def.threads = 1;
  world_def.stepping = stepping;
  World world = std::move(*World::create(world_def));
  const auto height = [](double x) { return 2.0 + 0.3 * (x * x / 3.0625 - 1.0); };
  std::vector<BodyId> planks;
  for (int k = 0; k < 6; ++k) {
    const double x = -1.25 + 0.5 * k;
    planks.push_back(add_box(world, {x, height(x), 0}, {0.2f, 0.025f, 0.7f}, 14.0f));
  }
  for (const double z : {-0.6, -0.58, 0.58, 0.6}) {
    RopeDef def{.links = links, .linear_density = 0.5f, .stretch_stiffness = 1.0e5f};
    for (int i = 0; i <= 28; ++i) def.points.push_back({-1.75 + 0.125 * i, height(-1.75 + 0.125 * i), z});
    const SoftId rope = world.add_rope(def);
    world.pin(rope, 0), world.pin(rope, 28);
    for (int k = 0; k < 6; ++k) world.attach(rope, 4 + 4 * k, planks[std::size_t(k)]);
  }
  add_ball(world, {0.1, 2.6, 0.1}, 0.25f, 20.0f);
  const auto total = [&] {
    const Energy e = world.energy();
    return e.kinetic + e.potential + e.soft_elastic;
  };
  const double before = total();
  for (int i = 0; i < 120; ++i) {
    world.step(kStep);
    ASSERT_LT(total(), before + 1.0) << i;
  }
  EXPECT_GT(world.pose(planks[3]).position.y, 1.5);
}
TEST(SoftMatter, ABridgeGainsNoEnergyWithAnySolverAndSteps) {
  for (const RopeLinks links : {RopeLinks::springs, RopeLinks::rods}) {
    for (const SolverKind solver : {SolverKind::soft_step, SolverKind::sequential_impulses, SolverKind::lcp}) {
      SCOPED_TRACE(std::string(to_string(solver)) + ", " + to_string(links));
      expect_bridge_gains_nothing({.solver = solver}, links);
    }
    for (const TimeStepping time : {TimeStepping::adaptive, TimeStepping::error_controlled}) {
      SCOPED_TRACE(std::string(to_string(time)) + ", " + to_string(links));
      expect_bridge_gains_nothing({.time = time}, links);
    }
  }
}

// Ropes that strike the ground turn by more than a segment in a sub-step.
TEST(SoftMatter, ARopeThatFallsOnTheGroundIsNotThrown) {
  for (const int segments : {20, 50, 100, 150}) {
    World world = make_world();
    world.add_body({.type = BodyType::fixed}, ShapeDef{.geometry = Plane{{0, 1, 0}, 0}});
    const SoftId rope =
        world.add_rope({.points = {{0, 1, 0}, {1, 1.3, 0.2}}, .segments = segments, .radius = 0.01f});
    const double before = world.energy().potential;
    for (int i = 0; i < 90; ++i) {
      world.step(kStep);
      const Energy e = world.energy();
      ASSERT_LT(e.kinetic + e.potential, 1.001 * before) << segments << " " << i;
      const SoftVertices v = world.vertices(rope);
      for (std::size_t k = 0; k < v.size(); ++k)
        ASSERT_LT(length(v.velocity(k)), 5.5f) << segments << " " << i;
    }
  }
}

// Between its held ends a rope of rods yields, which is energy: that of a swing under a heavy load stays.
TEST(SoftMatter, ARopeOfRodsThatIsHeldAtBothEndsHasTheEnergyOfItsStretch) {
  World world = make_world();
  const SoftId rope = world.add_rope({.points = {{-1, 0, 0}, {1, 0, 0}}, .segments = 2});
  world.pin(rope, 0), world.pin(rope, 2);
  ASSERT_TRUE(world.attach(rope, 1, add_ball(world, {0, 0, 0}, 0.1f, 1000.0f)));
  const auto total = [&] {
    const Energy e = world.energy();
    return e.kinetic + e.potential + e.soft_elastic;
  };
  const double before = total();
  double most = 0.0;
  for (int i = 0; i < 60; ++i) {
    world.step(kStep);
    most = std::max(most, world.soft_info(rope).elastic_energy);
    // Backward Euler takes some.
    ASSERT_LT(total(), before + 1.0);
  }
  // At the lowest point all of the fall: EA = 1e7 x 0.2 kg, 2 EA (d^2 / 2)^2 / 2 = m g d, d = 0.27 m, 2.6 kJ.
  EXPECT_GT(most, 1500.0);
}

// Both ends are held, and one goes further than the rope is long.
TEST(SoftMatter, ARopeOfRodsThatIsTooShortStaysInLine) {
  World world = make_world();
  BodyDef def;
  def.type = BodyType::kinematic;
  def.pose.position = {1, 0, 0};
  def.linear_velocity = {0.5f, 0, 0};
  const BodyId hand = world.add_body(def);
  const SoftId rope = world.add_rope({.points = {{0, 0, 0}, {1, 0, 0}}, .segments = 20});
  world.pin(rope, 0), world.attach(rope, 20, hand);
  for (int i = 0; i < 120; ++i) {
    world.step(kStep);
    const SoftVertices v = world.vertices(rope);
    for (std::size_t k = 0; k < v.size(); ++k) {
      ASSERT_NEAR(v.x[k], (1.0 + 0.5 * (i + 1) / 60.0) * double(k) / 20.0, 0.02) << i;
      ASSERT_NEAR(v.y[k], 0.0, 0.02) << i;
    }
  }
}

// Balls from a gram to half a ton fall onto a sheet of 0.8 kg whose rim is held: none falls through, and no energy comes from nothing.
TEST(SoftMatter, ATrampolineThrowsBallsOfAnyMass) {
  for (const float mass : {0.001f, 1.0f, 500.0f}) {
    World world = make_world();
    ClothDef def = sheet(2, 20, {0, 1, 0});
    def.stretch_stiffness = 5.0e4f;
    def.shear_stiffness = 1.0e4f;
    const SoftId cloth = world.add_cloth(def);
    for (int i = 0; i <= 20; ++i)
      for (const int vertex : {i, i + 21 * 20, 21 * i, 21 * i + 20}) world.pin(cloth, vertex);
    const BodyId ball = add_ball(world, {0.05, 1.6, 0.03}, 0.3f, mass);
    const auto total = [&] {
      const Energy e = world.energy();
      return e.kinetic + e.potential + e.soft_elastic;
    };
    const double before = total(), scale = double(mass + 0.8f) * 9.81;
    for (int i = 0; i < 150; ++i) {
      world.step(kStep);
      ASSERT_GT(world.pose(ball).position.y, 0.0) << mass << " kg, step " << i;
      ASSERT_LT(total(), before + 0.02 * scale) << mass << " kg, step " << i;
    }
  }
}

TEST(SoftMatter, ClothRestsOnShapesOfEveryKind) {
  const auto hull = cook_hull(std::vector<Vec3>{{-0.4f, -0.3f, -0.4f}, {0.4f, -0.3f, -0.4f}, {0.4f, -0.3f, 0.4f},
                                                          {-0.4f, -0.3f, 0.4f}, {-0.3f, 0.3f, -0.3f}, {0.3f, 0.3f, -0.3f},
                                                          {0.3f, 0.3f, 0.3f}, {-0.3f, 0.3f, 0.3f}});
  ASSERT_TRUE(hull);
  std::vector<float> heights(25, 0.0f);
  heights[12] = 0.3f;
  const auto field = cook_height_field({.heights = heights, .columns = 5, .rows = 5, .spacing = 0.5f});
  ASSERT_TRUE(field);
  const std::vector<Vec3> corners{{-1, 0.1f, -1}, {1, 0.1f, -1}, {1, 0.1f, 1}, {-1, 0.1f, 1}, {0, 0.3f, 0}};
  const std::vector<std::uint32_t> faces{0, 4, 1, 1, 4, 2, 2, 4, 3, 3, 4, 0};
  const auto mesh = cook_mesh({.vertices = corners, .indices = faces});
  ASSERT_TRUE(mesh);
  const AnyShape shapes[] = {Sphere{0.4f}, Box{{0.4f, 0.3f, 0.4f}}, Capsule{0.3f, 0.3f}, Cylinder{0.4f, 0.3f},
                             Cone{0.4f, 0.3f}, *hull, Plane{}, *mesh, *field};
  for (const AnyShape& shape : shapes) {
    World world = make_world();
    scenes::add_fixed(world, {0, 0, 0}, shape);
    const SoftId cloth = world.add_cloth(sheet(0.6f, 12, {0, 0.75, 0}));
    step(world, 45);
    const SoftVertices v = world.vertices(cloth);
    int near = 0;
    double deepest = 0.0;
    for (std::size_t i = 0; i < v.size(); ++i) {
      const auto point = world.closest_point({Sphere{0.0001f}, {v.position(i), {}}}, 0.02);
      const auto inside = world.penetration({Sphere{0.0001f}, {v.position(i), {}}});
      near += point.has_value();
      if (inside) deepest = std::fmax(deepest, double(inside->depth));
    }
    EXPECT_GT(near, 5) << "kind " << shape.index();
    EXPECT_LT(deepest, 0.002) << "kind " << shape.index();
    EXPECT_GT(lowest(v), -0.4) << "kind " << shape.index();
  }
}

// Two bodies that fly apart and a cloth between them: nothing acts from outside.
TEST(SoftMatter, MomentumIsKept) {
  World world = make_world({});
  const SoftId cloth = world.add_cloth(sheet(1, 10, {0, 0, 0}));
  const BodyId a = add_box(world, {-0.7, 0, 0}, {0.1f, 0.2f, 0.3f}, 3.0f), b = add_ball(world, {0.7, 0, 0}, 0.1f, 0.5f);
  for (const int j : {0, 5, 10}) world.attach(cloth, 11 * j, a);
  world.attach(cloth, 11 * 5 + 10, b);
  const BodyId thrown = add_ball(world, {0, 1, 0}, 0.15f, 2.0f);
  world.set_velocity(a, {-1, 0.5f, 0}, {0, 1, 2});
  world.set_velocity(b, {3, 0, 0.3f}, {});
  world.set_velocity(thrown, {0, -3, 0}, {1, 0, 0});
  const Momentum before = world.momentum();
  step(world, 90);
  const Momentum after = world.momentum();
  EXPECT_LT(length(after.linear - before.linear), 1.0e-4 * 20.0);
  // Backward Euler turns along the tangent: it is right to the first order of the step.
  EXPECT_LT(length(after.angular - before.angular), 0.1 * (1.0 + length(before.angular)));
}

TEST(SoftMatter, PinsFollowAMovingBodyWithoutLag) {
  World world = make_world();
  BodyDef def;
  def.type = BodyType::kinematic;
  def.linear_velocity = {5, 0, 0};
  def.angular_velocity = {0, 0, 6};
  const BodyId arm = world.add_body(def, ShapeDef{.geometry = Box{{0.5f, 0.1f, 0.1f}}});
  const SoftId rope = world.add_rope({.points = {{0.5, 0, 0}, {0.5, -2, 0}}, .segments = 20});
  const SoftId cloth = world.add_cloth(sheet(1, 8, {-0.5, -0.6, 0}));
  ASSERT_TRUE(world.attach(rope, 0, arm));
  ASSERT_TRUE(world.attach(cloth, 0, arm));
  const Vec3 local = rotate_inverse(world.pose(arm).orientation, to_float(world.vertices(cloth).position(0) - world.pose(arm).position));
  for (int i = 0; i < 60; ++i) {
    world.step(kStep);
    const Pose pose = world.pose(arm);
    const DVec3 end = pose.position + DVec3(rotate(pose.orientation, Vec3{0.5f, 0, 0})),
                corner = pose.position + DVec3(rotate(pose.orientation, local));
    ASSERT_LT(length(world.vertices(rope).position(0) - end), 1.0e-4) << i;
    ASSERT_LT(length(world.vertices(cloth).position(0) - corner), 1.0e-4) << i;
  }
}

double total_energy(const World& world) {
  const Energy e = world.energy();
  return e.kinetic + e.potential + e.soft_elastic;
}

// A ball on a rope that ends in its middle: four vertices begin inside it, which its surface would push out while the rope pulls them in.
TEST(SoftMatter, ARopeThatIsAttachedInsideABodyDoesNotFightItsSurface) {
  World world = make_world();
  const double swing = 1.0, length_of_rope = 3.0;
  const DVec3 end{length_of_rope * std::sin(swing), -length_of_rope * std::cos(swing), 0};
  const BodyId ball = add_ball(world, end, 0.3f, 565.0f);
  const SoftId rope = world.add_rope({.points = {{0, 0, 0}, end}, .segments = 40, .linear_density = 1.2f});
  world.pin(rope, 0);
  ASSERT_TRUE(world.attach(rope, 40, ball));
  const double range = 565.0 * 9.81 * length_of_rope * (1.0 - std::cos(swing)), before = total_energy(world);
  for (int i = 0; i < 180; ++i) {
    world.step(kStep);
    ASSERT_LT(total_energy(world), before + 1.0e-3 * range) << i;
  }
  EXPECT_NEAR(length(world.pose(ball).position), length_of_rope, 0.02);
  // Let go, it is pushed out.
  ASSERT_TRUE(world.release(rope, 40));
  step(world, 2);
  EXPECT_GT(world.soft_info(rope).contacts, 0);
}
// The corner of a cloth and the foot of a jelly begin inside boxes that carry them.
TEST(SoftMatter, ClothsAndSolidsThatBeginInsideABodyStayThere) {
  World world = make_world({});
  BodyDef def;
  def.type = BodyType::kinematic;
  const BodyId box = world.add_body(def, ShapeDef{.geometry = Box{{0.3f, 0.3f, 0.3f}}});
  const SoftId cloth = world.add_cloth(sheet(2, 20, {0.5, 0.05, 0.5}));
  SolidDef jelly;
  jelly.box = SolidBox{{0.15f, 0.3f, 0.15f}, {3, 6, 3}};
  jelly.pose.position = {0, 0.5, 0};
  const SoftId solid = world.add_solid(jelly);
  int inside = -1, foot = -1;
  for (int i = 0; i < 441 && inside < 0; ++i)
    if (length(world.vertices(cloth).position(std::size_t(i)) - DVec3{0, 0.05, 0}) < 1e-4) inside = i;
  for (int i = 0; i < 112 && foot < 0; ++i)
    if (length(world.vertices(solid).position(std::size_t(i)) - DVec3{0.05, 0.2, 0.05}) < 1e-4) foot = i;
  ASSERT_GE(inside, 0);
  ASSERT_GE(foot, 0);
  ASSERT_TRUE(world.attach(cloth, inside, box));
  ASSERT_TRUE(world.attach(solid, foot, box));
  step(world, 30);
  const SoftVertices v = world.vertices(cloth);
  // Next to the middle, 20 cm from the nearest face, and a layer of the jelly below its own attachment's neighbours.
  EXPECT_LT(length(v.position(std::size_t(inside) + 1) - DVec3{0.1, 0.05, 0}), 1.0e-3);
  EXPECT_LT(length(v.position(std::size_t(inside) + 2) - DVec3{0.2, 0.05, 0}), 1.0e-3);
  EXPECT_LT(length(world.vertices(solid).position(0) - DVec3{-0.15, 0.2, -0.15}), 1.0e-3);
}

// A vertex follows its target, and stays in front of its backstop, exactly; snapshots and rollback know the limits.
TEST(SoftMatter, VerticesKeepTheirLimits) {
  for (const SoftIntegrator integrator :
       {SoftIntegrator::implicit, SoftIntegrator::sdirk2, SoftIntegrator::verlet, SoftIntegrator::visual}) {
    World world = make_world();
    ClothDef def = sheet(1, 10, {0, 0, 0});
    def.stretch_stiffness = 100.0f, def.shear_stiffness = 20.0f, def.self_collision = false;
    def.settings.integrator = integrator;
    def.settings.damping = integrator == SoftIntegrator::verlet ? 1.0e-4f : 0.0f;
    SoftId cloth = world.add_cloth(def);
    std::vector<DVec3> rest, targets;
    std::vector<float> distances, backstops(121, 0.02f);
    const std::vector<Vec3> normals(121, Vec3{0, 1, 0});
    for (std::size_t i = 0; i < 121; ++i) {
      rest.push_back(world.vertices(cloth).position(i));
      distances.push_back(i % 11 == 0 ? 0.0f : i % 11 == 10 ? -1.0f : 0.05f * float(i % 11));
    }
    for (int k = 1; k <= 60; ++k) {
      targets = rest;
      for (DVec3& one : targets) one.x += 0.03 * k, one.y += 0.2 * std::sin(0.2 * k);
      ASSERT_TRUE(world.set_vertex_limits(cloth, targets, distances, k % 2 == 0 ? normals : std::vector<Vec3>{},
                                          k % 2 == 0 ? backstops : std::vector<float>{}));
      world.step(kStep);
      const SoftVertices v = world.vertices(cloth);
      for (std::size_t i = 0; i < 121; ++i) {
        const DVec3 off = v.position(i) - targets[i];
        const double far = distances[i] >= 0.0f ? double(distances[i]) : 1.0e9, low = k % 2 == 0 ? -0.02 : -1.0e9;
        ASSERT_LT(length(off), far + 1.0e-6) << to_string(integrator) << k << ' ' << i;
        ASSERT_GT(off.y, low - 1.0e-6) << to_string(integrator) << k << ' ' << i;
      }
      if (k != 40) continue;
      world = std::move(*load_snapshot(save_snapshot(world)));
      world.softs({&cloth, 1});
    }
    ASSERT_TRUE(world.set_vertex_limits(cloth, {}, {}, {}, {}));
    step(world, 30);
    EXPECT_LT(lowest(world.vertices(cloth)), -0.2) << to_string(integrator);
  }
}
TEST(SoftMatter, BadLimitsAreRefused) {
  World world = make_world();
  const SoftId rope = world.add_rope({.points = {{0, 0, 0}, {1, 0, 0}}});
  const std::vector<DVec3> two{{0, 0, 0}, {1, 0, 0}};
  EXPECT_FALSE(world.set_vertex_limits(rope, {two.data(), 1}, std::vector<float>{1}, {}, {}));
  EXPECT_FALSE(world.set_vertex_limits(rope, two, std::vector<float>{1}, {}, {}));
  EXPECT_FALSE(world.set_vertex_limits(rope, two, std::vector<float>{1, NAN}, {}, {}));
  EXPECT_FALSE(world.set_vertex_limits(rope, two, std::vector<float>{1, 1}, std::vector<Vec3>{{0, 2, 0}, {0, 1, 0}}, std::vector<float>{0, 0}));
  EXPECT_FALSE(world.set_vertex_limits(rope, two, std::vector<float>{1, 1}, std::vector<Vec3>{{0, 1, 0}, {0, 1, 0}}, std::vector<float>{0, -1}));
  EXPECT_TRUE(world.set_vertex_limits(rope, two, std::vector<float>{1, -1}, {}, {}));
}

// A flag of the visual scheme keeps its size in a storm, lies on a ball, and says what it is.
TEST(SoftMatter, AVisualFlagKeepsItsSizeAndTouchesShapes) {
  World world = make_world();
  FieldDef wind;
  wind.velocity = {12, 0, 3};
  world.add_field(wind);
  ClothDef def = sheet(2, 40, {0, 3, 0});
  def.settings.integrator = SoftIntegrator::visual;
  const SoftId flag = world.add_cloth(def);
  for (int j = 0; j <= 40; ++j) world.pin(flag, 41 * j);
  def.pose.position = {20, 1.2, 20};
  const SoftId blanket = world.add_cloth(def);
  add_ball(world, {20, 0, 20}, 1.0f, 0.0f, BodyType::fixed);
  EXPECT_TRUE(world.soft_info(flag).visual);
  for (int i = 0; i < 120; ++i) {
    world.step(kStep);
    const SoftVertices v = world.vertices(flag);
    for (std::size_t k = 0; k < v.size(); ++k)
      ASSERT_LT(length(v.position(k) - v.position(k / 41 * 41)), 2.0 * 1.35) << i;  // along the links, which run over corners
    const SoftVertices b = world.vertices(blanket);
    for (std::size_t k = 0; i < 60 && k < b.size(); ++k) ASSERT_GT(length(b.position(k) - DVec3{20, 0, 20}), 0.9) << i;
  }
  SolidDef solid;
  solid.box = SolidBox{};
  solid.settings.integrator = SoftIntegrator::visual;
  EXPECT_FALSE(world.exists(world.add_solid(solid)));
}

World make_mixture(int threads, int width) {
  World world = make_world({0, -9.81f, 0}, threads, width);
  add_ground(world);
  ClothDef cloth = sheet(2, 14, {0, 2, 0});
  cloth.links = ClothLinks::membrane;
  world.add_cloth(cloth);
  const SoftId rope = world.add_rope({.points = {{2, 3, 0}, {2, 1, 0}}, .segments = 16, .bend_stiffness = 0.01f});
  world.pin(rope, 0);
  world.attach(rope, 16, add_ball(world, {2, 0.8, 0}, 0.2f, 5.0f));
  SolidDef jelly;
  jelly.box = SolidBox{{0.3f, 0.3f, 0.3f}, {3, 3, 3}};
  jelly.pose.position = {-1.5, 0.6, 0};
  world.add_solid(jelly);
  // Each integrator, vertices that begin inside a body, and limits.
  RopeDef lively{.points = {{3, 3, 0}, {3, 1, 0}}, .segments = 8};
  lively.settings.integrator = SoftIntegrator::sdirk2;
  const SoftId chain = world.add_rope(lively);
  world.pin(chain, 0);
  world.attach(chain, 8, add_ball(world, {3, 1, 0}, 0.6f, 20.0f));
  ClothDef banner = sheet(1, 6, {5, 2, 0});
  banner.settings.integrator = SoftIntegrator::sdirk2;
  const SoftId first = world.add_cloth(banner);
  banner.pose.position.z = 3;
  banner.settings.integrator = SoftIntegrator::visual;
  const SoftId second = world.add_cloth(banner);
  for (const SoftId one : {first, second}) world.pin(one, 0), world.pin(one, 6);
  std::vector<DVec3> targets;
  for (std::size_t i = 0; i < 49; ++i) targets.push_back(world.vertices(second).position(i));
  world.set_vertex_limits(second, targets, std::vector<float>(49, 0.25f), std::vector<Vec3>(49, Vec3{0, 1, 0}),
                          std::vector<float>(49, 0.1f));
  add_ball(world, {0.1, 1.2, 0.05}, 0.4f, 2.0f);
  add_box(world, {-1.5, 1.6, 0}, {0.2f, 0.2f, 0.2f}, 3.0f);
  for (int i = 0; i < 6; ++i) add_box(world, {0.5, 0.2 + 0.42 * i, 1.5}, {0.2f, 0.2f, 0.2f}, 1.0f);
  FieldDef wind;
  wind.velocity = {1, 0, 0.5f};
  world.add_field(wind);
  return world;
}

TEST(SoftMatter, ThreadsAndWidthsDoNotChangeABit) {
  World plain = make_mixture(1, 1);
  step(plain, 60);
  const std::uint64_t expected = plain.hash();
  for (const int threads : {2, 8}) {
    for (const int width : {4, 8, 16}) {
      World world = make_mixture(threads, width);
      step(world, 60);
      EXPECT_EQ(world.hash(), expected) << threads << " threads, width " << width;
    }
  }
}

TEST(SoftMatter, SavesRestoresRollsBackAndReplays) {
  World world = make_mixture(1, 0);
  MemorySink sink;
  Recorder recorder(world, sink);
  step(world, 40);
  const std::vector<std::byte> saved = save_snapshot(world);
  Rollback rollback(4);
  rollback.save(world);
  const std::uint64_t at_forty = world.hash();
  step(world, 20);
  const std::uint64_t expected = world.hash();
  ASSERT_TRUE(recorder.finish());
  auto loaded = load_snapshot(saved);
  ASSERT_TRUE(loaded) << loaded.error().message;
  EXPECT_EQ(loaded->hash(), at_forty);
  step(*loaded, 20);
  EXPECT_EQ(loaded->hash(), expected);
  ASSERT_TRUE(rollback.restore(world, 40));
  EXPECT_EQ(world.hash(), at_forty);
  step(world, 20);
  EXPECT_EQ(world.hash(), expected);
  auto replay = Replay::open(sink.bytes);
  ASSERT_TRUE(replay) << replay.error().message;
}

TEST(SoftMatter, ExplicitEulerExplodesAndTheOthersUpToTheirStep) {
  // A weight of 2 m on a chain of stiff springs: w = 2 sqrt(k / m) is the fastest oscillation of a long chain.
  const float density = 0.5f, stiffness = 400.0f, cell = 0.1f;
  const double w = 2.0 * std::sqrt(double(stiffness / cell) / double(density * cell));
  const auto grows = [&](SoftIntegrator integrator, double share) {
    World world = make_world({});
    RopeDef def{.points = {{0, 0, 0}, {1, 0, 0}}, .segments = 10, .links = RopeLinks::springs,
                .linear_density = density, .stretch_stiffness = stiffness};
    def.settings.integrator = integrator;
    const SoftId rope = world.add_rope(def);
    world.pin(rope, 0), world.pin(rope, 10);
    std::vector<Vec3> velocities(11);
    for (int i = 1; i < 10; ++i) velocities[std::size_t(i)] = {i % 2 == 0 ? 0.01f : -0.01f, 0, 0};
    world.set_vertices(rope, {}, velocities);
    // A step has four sub-steps.
    const float seconds = float(4.0 * share * 2.0 / w);
    const double before = world.energy().kinetic;
    for (int i = 0; i < 200 && world.energy().kinetic < 1.0e3 * before; ++i) world.step(seconds);
    const Energy after = world.energy();
    return after.kinetic + after.soft_elastic > 100.0 * before;
  };
  EXPECT_TRUE(grows(SoftIntegrator::explicit_euler, 0.1));
  EXPECT_FALSE(grows(SoftIntegrator::semi_implicit_euler, 0.9));
  EXPECT_TRUE(grows(SoftIntegrator::semi_implicit_euler, 1.1));
  EXPECT_FALSE(grows(SoftIntegrator::verlet, 0.9));
  EXPECT_TRUE(grows(SoftIntegrator::verlet, 1.1));
  EXPECT_FALSE(grows(SoftIntegrator::rk4, 1.2));
  EXPECT_TRUE(grows(SoftIntegrator::rk4, 1.6));
  EXPECT_FALSE(grows(SoftIntegrator::implicit, 20.0));
}

TEST(SoftMatter, AnExplosionBeyondTheRangeOfFloatsIsReported) {
  World world = *World::create();
  world.add_body({.type = BodyType::fixed}, {.geometry = Plane{}});
  world.add_body({.pose = {{1, 2, 0}}, .mass = 2.0f}, {.geometry = Sphere{0.1f}});
  const BodyId load = world.add_body({.pose = {{0, 1.9, 0}}, .mass = 2.0f}, {.geometry = Sphere{0.1f}});
  RopeDef def{.points = {{0, 3, 0}, {0, 2, 0}}, .segments = 10, .links = RopeLinks::springs,
              .linear_density = 0.2f, .stretch_stiffness = 1.0e5f};
  def.settings.integrator = SoftIntegrator::semi_implicit_euler;
  const SoftId rope = world.add_rope(def);
  world.pin(rope, 0), world.attach(rope, 10, load);
  bool is_reported = false;
  for (int i = 0; i < 30; ++i) {
    world.step(1.0f / 60);
    is_reported = is_reported || !world.problems().empty();
  }
  EXPECT_TRUE(is_reported);
  EXPECT_TRUE(is_finite(world.pose(load)));
}

TEST(SoftMatter, BadDefinitionsAreRefusedWithTheReason) {
  World world = make_world();
  const auto refused = [&](auto&& call, const char* words) {
    const bool done = bool(call());
    EXPECT_FALSE(done) << words;
    ASSERT_FALSE(world.problems().empty()) << words;
    EXPECT_NE(std::string(world.problems().back().message).find(words), std::string::npos) << world.problems().back().message;
  };
  refused([&] { return world.add_rope({.points = {{0, 0, 0}}}); }, "at least 2");
  refused([&] { return world.add_rope({.points = {{0, 0, 0}, {0, 0, 0}}}); }, "needs a length");
  refused([&] { return world.add_cloth({}); }, "neither grid nor vertices");
  refused([&] { return world.add_cloth({.vertices = {{0, 0, 0}, {1, 0, 0}, {2, 0, 0}}, .triangles = {0, 1, 2}}); }, "no area");
  refused([&] { return world.add_cloth({.vertices = {{0, 0, 0}, {1, 0, 0}, {0, 0, 1}}, .triangles = {0, 1, 3}}); }, "has vertex 3");
  refused([&] { return world.add_cloth({.grid = ClothGrid{}, .area_density = 0.0f}); }, "area_density is 0");
  refused([&] { return world.add_solid({}); }, "neither box nor surface nor vertices");
  refused([&] { return world.add_solid({.box = SolidBox{}, .poisson_ratio = 0.5f}); }, "poisson_ratio is 0.5");
  refused([&] { return world.add_solid({.vertices = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {1, 1, 0}}, .tetrahedra = {0, 1, 2, 3}}); },
          "no volume");
  const std::vector<Vec3> corners{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}, {0.5f, 0.5f, 2}};
  const std::vector<Vec3> both_sides{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}, {0.3f, 0.3f, -1}};
  refused([&] { return world.add_solid({.vertices = both_sides, .tetrahedra = {0, 1, 2, 3, 0, 1, 2, 4}}); }, "tetrahedra[1] is inverted");
  refused([&] { return world.add_solid({.vertices = corners, .tetrahedra = {0, 1, 2, 3, 0, 1, 2, 4}}); }, "tetrahedra[0] and tetrahedra[1] overlap");
  EXPECT_TRUE(world.add_solid({.vertices = both_sides, .tetrahedra = {0, 1, 2, 3, 0, 2, 1, 4}}));
  const SoftId rope = world.add_rope({.points = {{0, 0, 0}, {1, 0, 0}}});
  refused([&] { return world.pin(rope, 2); }, "vertex is 2");
  refused([&] { return world.attach(rope, 0, BodyId{}); }, "does not exist");
  ASSERT_TRUE(world.remove_soft(rope));
  refused([&] { return world.pin(rope, 0); }, "does not exist");
}

}  // namespace
}  // namespace gyre::soft_matter_test
