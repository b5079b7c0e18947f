// A body that hangs on a point between vertices, and soft matter that hangs on one: a ball joint that holds both ways at any ratio of masses. Heavy loads on light bodies
// that joints and contacts hold, too.
// Sources: I. Newton, 1687 (weights, momentum); C. Huygens, 1673 (pendulum).
#include "laws/soft_kit.h"

#include <cmath>
#include <vector>

namespace gyre::laws::soft_points_test {
namespace {

constexpr double kG = kGravity;

DVec3 place_of(const World& world, SoftId soft, const SoftPoint& point) {
  const SoftVertices v = world.vertices(soft);
  DVec3 sum{};
  for (int k = 0; k < 4; ++k)
    if (point.weights[std::size_t(k)] != 0.0f)
      sum += double(point.weights[std::size_t(k)]) * v.position(std::size_t(point.vertices[std::size_t(k)]));
  return sum;
}

BodyId add_ball(World& world, DVec3 place, double mass) {
  BodyDef def{.pose = {place}};
  def.mass = float(mass);
  return world.add_body(def, ShapeDef{.geometry = Sphere{0.05f}});
}

double distance(DVec3 a, DVec3 b) { return std::sqrt(length_squared(a - b)); }

// The point is what the world says is nearest, and keeps its place in the frame of the ball, 0.2 m above its centre.
TEST(SoftPoints, ABallHangsOnAPointOfASheet) {
  for (const double mass : {0.02, 0.2, 20.0, 200.0}) {
    for (const SoftIntegrator integrator : {SoftIntegrator::implicit, SoftIntegrator::sdirk2}) {
      World world = make_world({.sleeping = false});
      const SoftId sheet = world.add_cloth({.grid = ClothGrid{{1, 1}, {8, 8}},
                                            .area_density = 0.2f,
                                            .stretch_stiffness = 5000.0f,
                                            .settings = {.integrator = integrator}});
      for (int k = 0; k < 81; ++k)
        if (k / 9 == 0 || k / 9 == 8 || k % 9 == 0 || k % 9 == 8) world.pin(sheet, k);
      const DVec3 place{0.03, 0, 0.05};
      const SoftPoint point = world.nearest_soft_point(sheet, place);
      ASSERT_LT(distance(place_of(world, sheet, point), place), 1e-6);
      const BodyId ball = add_ball(world, place - DVec3{0, 0.2, 0}, mass);
      ASSERT_TRUE(world.attach_point(sheet, point, ball));
      add_brake(world, 3.0);
      const auto gap = [&] {
        return std::fabs(distance(place_of(world, sheet, point), world.pose(ball).position) - 0.2);
      };
      double worst = 0.0;
      for (int i = 0; i < 300; ++i) {
        world.step(kStep);
        worst = std::max(worst, gap());
      }
      EXPECT_TRUE(limit_row("S-68 ball on a point of a sheet: lag, m", worst, 1e-3, 1e-4)) << mass;
      EXPECT_TRUE(limit_row("S-68 at rest, m", gap(), 1e-5, 1e-6)) << mass;
      EXPECT_LT(length(world.linear_velocity(ball)), 1e-3f) << mass;
    }
  }
}

// A scale bears all of a solid that hangs on one of its points, and the point is where it was.
TEST(SoftPoints, ASolidHangsOnAPointWithItsWeight) {
  for (const double mass : {1.0, 1000.0}) {
    World world = make_world({.sleeping = false});
    BodyDef def = point_body(1000.0, {100, 100, 100});
    def.gravity_scale = 0.0f;
    const BodyId scale = world.add_body(def);
    const JointId joint = world.add_joint(FixedDef{.b = scale});
    const SoftId solid = world.add_solid({.box = SolidBox{{0.2f, 0.2f, 0.2f}, {3, 3, 3}},
                                          .density = float(mass / 0.064),
                                          .young_modulus = float(1e5 * mass)});
    const DVec3 place{0.04, 0.11, -0.07};
    const SoftPoint point = world.nearest_soft_point(solid, place);
    ASSERT_TRUE(world.attach_point(solid, point, scale));
    add_brake(world, 3.0);
    for (int i = 0; i < 600; ++i) world.step(kStep);
    DVec3 load{};
    for (int i = 0; i < 60; ++i) {
      world.step(kStep);
      load += (-1.0 / 60.0) * wide(world.joint_state(joint).force);
    }
    EXPECT_TRUE(relative_row("S-68 solid on a point: weight, N", -load.y, mass * kG, 1e-3, 1e-4)) << mass;
    EXPECT_LT(distance(place_of(world, solid, point), place), 1e-4) << mass;
    // Its middle hangs below the point.
    const SoftVertices v = world.vertices(solid);
    DVec3 middle{};
    for (std::size_t i = 0; i < v.size(); ++i) middle += (1.0 / double(v.size())) * v.position(i);
    EXPECT_LT(std::hypot(middle.x - place.x, middle.z - place.z), 5e-3) << mass;
    EXPECT_LT(middle.y, place.y) << mass;
  }
}

// Small swings of a stiff box about a point d from its middle: T = 2 pi sqrt((I + m d^2) / (m g d)).
TEST(SoftPoints, ASolidOnAPointIsAPendulum) {
  World world = make_world({.stepping = {.substeps = 8}, .sleeping = false});
  const double a = 0.1, d = 0.3;
  const SoftId solid = world.add_solid({.box = SolidBox{{float(a), 0.4f, float(a)}, {2, 8, 2}},
                                        .pose = {{0, -d, 0}},
                                        .density = 1000.0f,
                                        .young_modulus = 1e8f});
  // The middle of a cell lies within its first tetrahedron, not at a vertex.
  const SoftPoint point = world.nearest_soft_point(solid, {0.01, 0, 0.02});
  ASSERT_TRUE(world.pin_point(solid, point));
  ASSERT_TRUE(world.pin_point(solid, world.nearest_soft_point(solid, {0.01, 0, -0.03})));
  const int count = world.soft_info(solid).vertices;
  std::vector<Vec3> velocities;
  for (int i = 0; i < count; ++i) {
    const DVec3 p = world.vertices(solid).position(std::size_t(i));
    velocities.push_back({float(-0.05 * p.y), float(0.05 * (p.x - 0.01)), 0.0f});
  }
  ASSERT_TRUE(world.set_vertices(solid, {}, velocities));
  std::vector<double> turns;
  double before = 0.0;
  for (int i = 0; i < 360; ++i) {
    world.step(kStep);
    const DVec3 low = world.vertices(solid).position(0);
    const double now = low.x + a;
    if (before < 0.0 && now >= 0.0) turns.push_back(double(kStep) * (i + now / (before - now)));
    before = now;
  }
  ASSERT_GE(turns.size(), 3u);
  const double period = (turns.back() - turns.front()) / double(turns.size() - 1);
  // Of masses at vertices: that of a side of n cells is that of the box times 1 + 2 / n^2.
  const double inertia = (1.5 * a * a + (1.0 + 2.0 / 64.0) * 0.4 * 0.4) / 3.0;
  EXPECT_TRUE(relative_row("S-68 pendulum on two points: period, s", period,
                           2 * kPi * std::sqrt((inertia + d * d) / (kG * d)), 5e-3, 1e-3));
}

// Nothing acts from outside: momentum stays, at any ratio of masses.
TEST(SoftPoints, ABodyOnASheetInSpaceKeepsMomentum) {
  for (const double mass : {0.01, 0.2, 200.0}) {
    World world = make_world({.gravity = {}, .sleeping = false});
    const SoftId sheet = world.add_cloth({.grid = ClothGrid{{1, 1}, {6, 6}}, .area_density = 0.2f});
    const BodyId ball = add_ball(world, {0.21, 0.1, 0.05}, mass);
    ASSERT_TRUE(world.attach_point(sheet, world.nearest_soft_point(sheet, {0.21, 0, 0.05}), ball));
    world.set_velocity(ball, {0, 2, 1}, {1, 0, 3});
    const Momentum start = world.momentum();
    for (int i = 0; i < 300; ++i) world.step(kStep);
    const Momentum end = world.momentum();
    const double size = mass * std::sqrt(5.0);
    EXPECT_LT(distance(start.linear, end.linear), 1e-4 * size) << mass;
    // Arms turn within a sub-step, so the error is that of the first order.
    EXPECT_TRUE(limit_row("S-68 body on a sheet in space: angular momentum, share",
                          distance(start.angular, end.angular) / size, 5e-3, 1e-3))
        << mass;
  }
}

// Planks of 24 kg on two ropes bear bodies of up to 30 t; from 2 t on they gained energy, and at 30 t 5e13 J.
TEST(SoftPoints, HeavyBodiesRestOnARopeBridge) {
  for (const double mass : {200.0, 2000.0, 30000.0}) {
    World world = make_world({.sleeping = false});
    std::vector<BodyId> planks;
    for (int k = 0; k < 19; ++k) {
      BodyDef def{.pose = {{-4.5 + 0.5 * k, 2, 0}}};
      def.mass = 24.0f;
      planks.push_back(world.add_body(def, {.geometry = Box{{0.2f, 0.03f, 0.5f}}}));
    }
    for (const double z : {-0.5, 0.5}) {
      const SoftId rope =
          world.add_rope({.points = {{-5, 2, z}, {5, 2, z}}, .segments = 40, .linear_density = 0.5f});
      world.pin(rope, 0), world.pin(rope, 40);
      for (int k = 0; k < 19; ++k) world.attach(rope, 2 + 2 * k, planks[std::size_t(k)]);
    }
    for (int i = 0; i < 60; ++i) world.step(kStep);
    BodyDef def{.pose = {{0, 2.6, 0}}};
    def.mass = float(mass);
    world.add_body(def, {.geometry = Box{{0.6f, 0.2f, 0.4f}}});
    const auto total = [&] {
      const Energy now = world.energy();
      return now.kinetic + now.potential + now.elastic + now.soft_elastic;
    };
    const double start = total();
    double most = 0.0;
    for (int i = 0; i < 240; ++i) {
      world.step(kStep);
      most = std::max(most, total() - start);
    }
    EXPECT_TRUE(limit_row("S-68 heavy body on a rope bridge: energy gained, share of m g l",
                          most / (mass * kG), 0.01, 1e-3))
        << mass;
  }
}

// Boxes of 0.1 and 1 kg on the ground bear sheets, solids and ropes of up to 100 kg; solids gained up to 0.15 of the energy at the start.
TEST(SoftPoints, HeavySoftMatterLiesOnALightBox) {
  for (const double box : {0.1, 1.0}) {
    for (const double mass : {10.0, 100.0}) {
      for (const SoftKind kind : {SoftKind::rope, SoftKind::cloth, SoftKind::solid}) {
        World world = make_world({.sleeping = false});
        add_ground(world);
        BodyDef def{.pose = {{0, 0.1, 0}}};
        def.mass = float(box);
        world.add_body(def, {.geometry = Box{{0.1f, 0.1f, 0.1f}}});
        if (kind == SoftKind::rope)
          world.add_rope(
              {.points = {{-0.5, 0.25, 0}, {0.5, 0.25, 0}}, .segments = 20, .linear_density = float(mass)});
        if (kind == SoftKind::cloth)
          world.add_cloth(
              {.grid = ClothGrid{{1, 1}, {12, 12}}, .pose = {{0, 0.3, 0}}, .area_density = float(mass)});
        if (kind == SoftKind::solid)
          world.add_solid({.box = SolidBox{{0.2f, 0.1f, 0.2f}, {4, 2, 4}},
                           .pose = {{0, 0.35, 0}},
                           .density = float(mass / 0.032),
                           .young_modulus = float(1e4 * mass)});
        const auto total = [&] {
          const Energy now = world.energy();
          return now.kinetic + now.potential + now.elastic + now.soft_elastic;
        };
        const double start = total();
        double most = 0.0;
        for (int i = 0; i < 150; ++i) {
          world.step(kStep);
          most = std::max(most, total() - start);
        }
        EXPECT_TRUE(limit_row("S-68 heavy soft matter on a light box: energy gained, share", most / start,
                              0.01, 1e-3))
            << box << " " << mass << " " << int(kind);
      }
    }
  }
}

// A body of 1 kg that a joint holds bears soft matter of up to 1,000 times its mass, on a vertex or on a point; it exploded from ten times on.
TEST(SoftPoints, ALightBodyOnAJointBearsAHeavySolid) {
  for (const double mass : {1.0, 10.0, 100.0, 1000.0}) {
    for (const bool by_point : {false, true}) {
      for (const bool by_ball : {false, true}) {
        World world = make_world({.sleeping = false});
        BodyDef def = point_body(1.0, {1, 1, 1});
        def.gravity_scale = 0.0f;
        const BodyId body = world.add_body(def);
        if (by_ball) world.add_joint(BallDef{.b = body});
        if (!by_ball) world.add_joint(FixedDef{.b = body});
        const SoftId solid = world.add_solid({.box = SolidBox{{0.2f, 0.2f, 0.2f}, {3, 3, 3}},
                                              .density = float(mass / 0.064),
                                              .young_modulus = float(1e5 * mass)});
        if (by_point)
          world.attach_point(solid, world.nearest_soft_point(solid, {0.04, 0.11, -0.07}), body);
        else
          world.attach(solid, 42, body);
        const Energy start = world.energy();
        double most = 0.0;
        for (int i = 0; i < 180; ++i) {
          world.step(kStep);
          const Energy now = world.energy();
          most = std::max(most, now.kinetic + now.potential + now.soft_elastic - start.potential);
        }
        EXPECT_TRUE(limit_row("S-68 heavy solid on a light body: energy gained, share of m g l",
                              most / (mass * kG * 0.2), 0.05, 0.01))
            << mass << (by_point ? " point" : " vertex") << (by_ball ? " ball" : " fixed");
      }
    }
  }
}

// A kinematic body takes the point along.
TEST(SoftPoints, APointFollowsAKinematicBody) {
  World world = make_world({.sleeping = false});
  const SoftId solid =
      world.add_solid({.box = SolidBox{{0.2f, 0.2f, 0.2f}, {3, 3, 3}}, .young_modulus = 1e6f});
  BodyDef def{.type = BodyType::kinematic};
  const BodyId hand = world.add_body(def, ShapeDef{.geometry = Sphere{0.02f}});
  const SoftPoint point = world.nearest_soft_point(solid, {0.05, 0.03, 0.01});
  ASSERT_TRUE(world.attach_point(solid, point, hand));
  double worst = 0.0;
  for (int i = 0; i < 240; ++i) {
    const float time = float(i) * kStep, speed = std::min(20.0f, 40.0f * time);
    world.set_velocity(hand, {speed, 0, 0}, {});
    world.step(kStep);
    worst = std::max(
        worst, distance(place_of(world, solid, point), world.pose(hand).position + DVec3{0.05, 0.03, 0.01}));
  }
  EXPECT_TRUE(
      limit_row("S-68 point of a solid on a body that speeds up to 20 m/s: lag, m", worst, 1e-3, 1e-4));
}

}  // namespace
}  // namespace gyre::laws::soft_points_test
