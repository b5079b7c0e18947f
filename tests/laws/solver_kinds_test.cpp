// The solvers beside the default one: sequential impulses, and the complementarity problem of each island.
#include "kit.h"

#include <cmath>
#include <initializer_list>

namespace gyre::laws::solver_kinds_test {
namespace {

struct Way {
  const char* name;
  SolverKind kind;
  SolverOptions options{};
};

World make_world_by(const Way& way, int substeps = 4, bool sleeping = false) {
  WorldDef def;
  def.stepping.substeps = substeps;
  def.stepping.solver = way.kind;
  def.stepping.solver_options = way.options;
  def.sleeping = sleeping;
  return make_world(def);
}

constexpr Way kSequential{"sequential impulses", SolverKind::sequential_impulses};
constexpr Way kLcp{"lcp", SolverKind::lcp};
constexpr Way kDantzig{"Dantzig", SolverKind::lcp, {.lcp_method = LcpMethod::dantzig, .friction_sides = 4}};
constexpr Way kLemke{"Lemke", SolverKind::lcp, {.lcp_method = LcpMethod::lemke, .friction_sides = 4}};
constexpr Way kNewton{"Newton", SolverKind::lcp, {.lcp_method = LcpMethod::newton}};
constexpr Way kNncg{"NNCG", SolverKind::lcp, {.lcp_method = LcpMethod::nncg}};
constexpr double kMaxResidual = 1.0e-6;  // N s

BodyId add_cube(World& world, DVec3 place, float density = 1000.0f,
                const Material& material = surface(0.5f)) {
  BodyDef def;
  def.pose.position = place;
  return world.add_body(def, {.geometry = Box{{0.5f, 0.5f, 0.5f}}, .density = density, .material = material});
}

// --------------------------------------------------------------------------------------------------------------- loads

// Four cubes of a tonne bear one of a thousand tonnes.
std::vector<BodyId> add_loaded_stack(World& world) {
  add_ground(world, surface(0.5f));
  std::vector<BodyId> cubes;
  for (int i = 0; i < 5; ++i) cubes.push_back(add_cube(world, {0, 0.5 + i, 0}, i == 4 ? 1.0e6f : 1000.0f));
  return cubes;
}

TEST(Solvers, AThousandfoldLoadIsBorne) {
  for (const Way& way : {kLcp, kDantzig, kLemke, kNewton}) {
    // A thousandth of the scene's masses: the residual is an impulse.
    World world = make_world_by(way, 2);
    add_ground(world, surface(0.5f));
    std::vector<BodyId> cubes;
    for (int i = 0; i < 5; ++i) cubes.push_back(add_cube(world, {0, 0.5 + i, 0}, i == 4 ? 1000.0f : 1.0f));
    double residual = 0.0;
    for (int step = 0; step < 120; ++step) {
      world.step(kStep);
      residual = std::max(residual, world.solver_stats().residual);
      EXPECT_EQ(world.solver_stats().direct_islands, 1) << way.name;
    }
    EXPECT_LT(residual, kMaxResidual) << way.name;
    for (std::size_t i = 0; i < cubes.size(); ++i) {
      const DVec3 place = world.pose(cubes[i]).position;
      EXPECT_NEAR(place.y, 0.5 + double(i), 1.0e-4) << way.name << ", cube " << i;
      EXPECT_NEAR(std::hypot(place.x, place.z), 0.0, 1.0e-4) << way.name << ", cube " << i;
    }
  }
}

TEST(Solvers, SequentialImpulsesDoNotBearAThousandfoldLoad) {
  World world = make_world_by(kSequential);
  const std::vector<BodyId> cubes = add_loaded_stack(world);
  run(world, 4.0);
  EXPECT_LT(world.pose(cubes.back()).position.y, 4.0);
}

TEST(Solvers, WeightOnTheGroundIsTheStacks) {
  for (const Way& way : {kSequential, kLcp, kDantzig, kLemke, kNncg}) {
    World world = make_world_by(way);
    add_ground(world, surface(0.5f));
    for (int i = 0; i < 3; ++i) add_cube(world, {0, 0.5 + i, 0});
    run(world, 2.0);
    double impulse = 0.0;
    std::vector<ContactPoint> points(64);
    const std::size_t count = world.contacts(points);
    for (std::size_t i = 0; i < count; ++i) {
      if (points[i].position.y < 0.25) impulse += double(points[i].normal_impulse);
    }
    EXPECT_NEAR(impulse, 3000.0 * kGravity / 60.0, 0.01 * 3000.0 * kGravity / 60.0) << way.name;
  }
}

// ---------------------------------------------------------------------------------------------------------------- arch

// A half circle of dry stones, thinner than a tenth of its span is wide. Milankovitch (1907): a semicircular arch needs a
// thickness of 0.1075 of its mean radius; this one has 0.15.
std::vector<BodyId> add_arch(World& world, int stones) {
  const Material stone = surface(0.7f);
  add_ground(world, stone);
  const double radius = 3.0, thickness = 0.15 * radius, half_width = 0.4;
  std::vector<BodyId> arch;
  for (int i = 0; i < stones; ++i) {
    const double begin = double(kPi) * i / stones, end = double(kPi) * (i + 1) / stones,
                 middle = 0.5 * (begin + end);
    const DVec3 center{radius * std::cos(middle), radius * std::sin(middle), 0};
    std::vector<Vec3> corners;
    for (const double r : {radius - 0.5 * thickness, radius + 0.5 * thickness})
      for (const double angle : {begin, end})
        for (const double z : {-half_width, half_width})
          corners.push_back(to_float(DVec3{r * std::cos(angle), r * std::sin(angle), z} - center));
    BodyDef def;
    def.pose.position = center;
    arch.push_back(
        world.add_body(def, {.geometry = *cook_hull(corners), .density = 2400, .material = stone}));
  }
  return arch;
}

double sag_of(World& world, const std::vector<BodyId>& arch, double seconds) {
  const DVec3 before = world.pose(arch[arch.size() / 2]).position;
  run(world, seconds);
  return length(world.pose(arch[arch.size() / 2]).position - before);
}

TEST(Solvers, ADryArchStandsWhenAllStonesAreSolvedTogether) {
  World world = make_world_by({"lcp", SolverKind::lcp}, 1);
  EXPECT_LT(sag_of(world, add_arch(world, 15), 5.0), 1.0e-4);
  EXPECT_LT(world.solver_stats().residual, kMaxResidual);
  EXPECT_EQ(world.solver_stats().direct_islands, 1);
}

TEST(Solvers, ADryArchFallsWhenStonesAreSolvedOneAfterTheOther) {
  World world = make_world_by({"sequential impulses", SolverKind::sequential_impulses, {.iterations = 2}}, 1);
  EXPECT_GT(sag_of(world, add_arch(world, 15), 5.0), 0.1);
}

// ------------------------------------------------------------------------------------------------------------ friction

// How far a cube slid in two seconds on a plane that rises by `angle`, heading `heading` across the slope.
double slide_of(const Way& way, double angle, double heading, float friction) {
  World world = make_world_by(way);
  const Quat tilt = from_axis_angle({0, 0, 1}, float(angle));
  BodyDef ground;
  ground.type = BodyType::fixed;
  ground.pose.orientation = tilt * from_axis_angle({0, 1, 0}, float(heading));
  world.add_body(ground, {.geometry = Box{{20, 1, 20}}, .material = surface(friction)});
  BodyDef def;
  def.pose.orientation = ground.pose.orientation;
  def.pose.position = DVec3(rotate(tilt, {0, 1.5f, 0}));
  const BodyId cube =
      world.add_body(def, {.geometry = Box{{0.5f, 0.5f, 0.5f}}, .material = surface(friction)});
  run(world, 2.0);
  return length(world.pose(cube).position - def.pose.position);
}

TEST(Solvers, TheConeHoldsUpToItsAngleInEveryDirection) {
  const float friction = 0.5f;
  const double limit = std::atan(double(friction));
  for (const Way& way : {kSequential, kLcp, kNncg}) {
    for (const double heading : {0.0, 0.4, 0.8}) {
      EXPECT_LT(slide_of(way, limit - 0.2 * double(kDegree), heading, friction), 1.0e-3)
          << way.name << ", " << heading;
      // a = g (sin - mu cos), a little above the limit.
      const double above = limit + 2.0 * double(kDegree);
      const double way_down = 2.0 * kGravity * (std::sin(above) - 0.5 * std::cos(above));
      EXPECT_NEAR(slide_of(way, above, heading, friction), way_down, 0.02 * way_down)
          << way.name << ", " << heading;
    }
  }
}

TEST(Solvers, APyramidHoldsBetweenItsInnerAndItsOuterCone) {
  const float friction = 0.5f;
  for (const int sides : {4, 8}) {
    for (const LcpMethod method : {LcpMethod::dantzig, LcpMethod::lemke, LcpMethod::nncg}) {
      const Way way{
          "pyramid", SolverKind::lcp, {.lcp_method = method, .friction_sides = sides, .iterations = 500}};
      const double inner = std::atan(double(friction) * std::cos(double(kPi) / sides));
      for (const double heading : {0.0, 0.3, 0.7}) {
        EXPECT_LT(slide_of(way, inner - 0.3 * double(kDegree), heading, friction), 1.0e-3)
            << sides << " sides, " << to_string(method) << ", " << heading;
        EXPECT_GT(slide_of(way, std::atan(double(friction)) + 0.5 * double(kDegree), heading, friction), 0.05)
            << sides << " sides, " << to_string(method) << ", " << heading;
      }
    }
  }
}

// --------------------------------------------------------------------------------------------------------------- order

// A wall of cubes, made in the order that a number gives; the places of the cubes by their place in the wall.
std::vector<DVec3> wall_after(const Way& way, int shuffle, double seconds) {
  World world = make_world_by(way, 2);
  add_ground(world, surface(0.6f));
  std::vector<DVec3> places;
  for (int row = 0; row < 4; ++row)
    for (int i = 0; i < 4 - row; ++i) places.push_back({1.05 * i + 0.525 * row, 0.5 + row, 0});
  std::vector<std::size_t> order;
  for (std::size_t i = 0; i < places.size(); ++i) order.push_back(i);
  unsigned state = unsigned(shuffle);
  for (std::size_t i = order.size(); shuffle != 0 && i-- > 1;) {
    state = state * 1664525u + 1013904223u;
    std::swap(order[i], order[(state >> 16) % (i + 1)]);
  }
  std::vector<BodyId> ids(places.size());
  for (const std::size_t i : order)
    ids[i] = add_cube(world, places[i], i % 3 == 0 ? 3000.0f : 1000.0f, surface(0.6f));
  run(world, seconds);
  for (std::size_t i = 0; i < ids.size(); ++i) places[i] = world.pose(ids[i]).position;
  return places;
}

TEST(Solvers, TheOrderOfBodiesDoesNotMatterToTheComplementarityProblem) {
  const std::vector<DVec3> plain = wall_after(kLcp, 0, 2.0);
  for (const int shuffle : {1, 2}) {
    const std::vector<DVec3> shuffled = wall_after(kLcp, shuffle, 2.0);
    for (std::size_t i = 0; i < plain.size(); ++i)
      EXPECT_LT(length(shuffled[i] - plain[i]), 1.0e-4) << "cube " << i << ", shuffle " << shuffle;
  }
}

// -------------------------------------------------------------------------------------------------------------- joints

TEST(Solvers, AChainWithALoadOfAThousandLinksHangsStill) {
  for (const Way& way : {kLcp, kDantzig, kLemke}) {
    World world = make_world_by(way);
    std::vector<BodyId> links;
    for (int i = 0; i < 10; ++i) {
      BodyDef def = point_body(i == 9 ? 1000.0 : 1.0, {0.1f, 0.1f, 0.1f}, {0, -0.5 - i, 0});
      links.push_back(world.add_body(def));
      BallDef joint;
      if (i > 0) joint.a = links[std::size_t(i) - 1];
      joint.b = links.back();
      joint.anchor = {0, double(-i), 0};
      world.add_joint(joint);
    }
    double residual = 0.0;
    for (int i = 0; i < 120; ++i) {
      world.step(kStep);
      residual = std::max(residual, world.solver_stats().residual);
    }
    EXPECT_LT(residual, kMaxResidual) << way.name;
    EXPECT_NEAR(world.pose(links.back()).position.y, -9.5, 1.0e-4) << way.name;
  }
}

TEST(Solvers, APendulumKeepsItsPeriodAndItsEnergy) {
  // A point mass on a rod of a metre, let go at 0.5 rad: T = 2 pi sqrt(L / g) (1 + a^2 / 16 + 11 a^4 / 3072).
  const double a = 0.5, period = 2.0 * double(kPi) * std::sqrt(1.0 / kGravity) *
                                 (1.0 + a * a / 16 + 11 * a * a * a * a / 3072);
  for (const Way& way : {kSequential, kLcp, kNncg}) {
    World world = make_world_by(way);
    const DVec3 place{std::sin(a), -std::cos(a), 0};
    const BodyId bob = world.add_body(point_body(1.0, {1e-4f, 1e-4f, 1e-4f}, place));
    BallDef joint;
    joint.b = bob;
    joint.anchor = {0, 0, 0};
    world.add_joint(joint);
    int crossings = 0;
    double last = 0.0, first = 0.0;
    for (int i = 0; i < 600; ++i) {
      const double before = world.pose(bob).position.x;
      world.step(kStep);
      const double after = world.pose(bob).position.x;
      if (before > 0.0 && after <= 0.0) {
        last = world.time() - double(kStep) * after / (after - before);
        if (crossings++ == 0) first = last;
      }
      EXPECT_NEAR(length(world.pose(bob).position), 1.0, 1.0e-3) << way.name;
    }
    EXPECT_NEAR((last - first) / (crossings - 1), period, 2.0e-3 * period) << way.name;
    const double start = -kGravity * std::cos(a), energy = world.energy().kinetic + world.energy().potential;
    EXPECT_NEAR(energy, start, 0.02 * (kGravity + start)) << way.name;
  }
}

TEST(Solvers, MotorsAndLimitsOfHingesAct) {
  for (const Way& way : {kSequential, kLcp, kDantzig}) {
    World world = make_world_by(way);
    world.set_gravity({0, 0, 0});
    const BodyId wheel = world.add_body(point_body(2.0, {1, 1, 1}));
    HingeDef joint;
    joint.b = wheel;
    joint.axis = {0, 0, 1};
    joint.limits = Limits{-10.0f, 1.0f};
    joint.motor.target_velocity = 2.0f;
    joint.motor.max_force = 4.0f;
    const JointId id = world.add_joint(joint);
    // Four N m on one kg m^2: after a quarter of a second 1 rad/s and an eighth of a rad.
    run(world, 0.25);
    EXPECT_NEAR(double(world.angular_velocity(wheel).z), 1.0, 0.01) << way.name;
    EXPECT_NEAR(double(world.joint_state(id).position), 0.125, 0.01) << way.name;
    run(world, 2.0);
    EXPECT_NEAR(double(world.joint_state(id).position), 1.0, 1.0e-3) << way.name;
    EXPECT_NEAR(double(world.angular_velocity(wheel).z), 0.0, 1.0e-3) << way.name;
  }
}

// ------------------------------------------------------------------------------------------------------------- the rest

TEST(Solvers, BallsBounceAsTheyDoWithTheDefault) {
  for (const Way& way : {kSequential, kLcp}) {
    World world = make_world_by(way);
    add_ground(world, surface(0.5f, 0.8f));
    BodyDef def;
    def.pose.position = {0, 2.25, 0};
    const BodyId ball = world.add_body(def, {.geometry = Sphere{0.25f}, .material = surface(0.5f, 0.8f)});
    double highest = 0.0;
    bool rose = false;
    for (int i = 0; i < 120; ++i) {
      world.step(kStep);
      rose = rose || world.linear_velocity(ball).y > 0.5f;
      if (rose) highest = std::max(highest, world.pose(ball).position.y);
    }
    EXPECT_NEAR(highest - 0.25, 0.64 * 2.0, 0.01 * 2.0) << way.name;
  }
}

TEST(Solvers, WhatOverlapsIsPushedApartWithoutABlow) {
  for (const Way& way : {kSequential, kLcp, kNncg}) {
    World world = make_world_by(way);
    add_ground(world, surface(0.5f));
    const BodyId cube = add_cube(world, {0, 0.35, 0});
    double fastest = 0.0;
    for (int i = 0; i < 120; ++i) {
      world.step(kStep);
      fastest = std::max(fastest, double(world.linear_velocity(cube).y));
    }
    EXPECT_LT(fastest, 0.01) << way.name;
    EXPECT_NEAR(world.pose(cube).position.y, 0.5, 2.0e-3) << way.name;
  }
}

TEST(Solvers, WhatRestsFallsAsleep) {
  for (const Way& way : {kSequential, kLcp}) {
    World world = make_world_by(way, 4, true);
    add_ground(world, surface(0.5f));
    for (int i = 0; i < 3; ++i) add_cube(world, {0, 0.5 + 1.01 * i, 0});
    run(world, 4.0);
    EXPECT_EQ(world.stats().awake_bodies, 0) << way.name;
  }
}

TEST(Solvers, IslandsThatAreTooLargeForAMethodAreToldAndSolvedAllTheSame) {
  World world = make_world_by(
      {"Lemke", SolverKind::lcp, {.lcp_method = LcpMethod::lemke, .friction_sides = 4, .direct_rows = 30}});
  add_ground(world, surface(0.5f));
  std::vector<BodyId> cubes;
  for (int i = 0; i < 4; ++i) cubes.push_back(add_cube(world, {0, 0.5 + i, 0}));
  run(world, 0.5);
  ASSERT_EQ(world.problems().size(), 1u);
  EXPECT_EQ(world.problems()[0].code, ErrorCode::unsupported);
  EXPECT_EQ(world.solver_stats().direct_islands, 1);
  EXPECT_LT(world.solver_stats().residual, kMaxResidual);
  EXPECT_EQ(world.solver_stats().largest_rows, 48);
  EXPECT_NEAR(world.pose(cubes.back()).position.y, 3.5, 1.0e-3);
}

TEST(Solvers, IslandsOfAThousandRowsAreSolvedToTheLastDigits) {
  // A wall of 36 bricks in running bond: 996 rows, and a pyramid of 45 cubes: 972.
  for (const bool is_wall : {true, false}) {
    World world = make_world_by(kLcp);
    add_ground(world, surface(0.6f));
    const Material stone = surface(0.6f);
    std::vector<BodyId> stones;
    const int rows = is_wall ? 6 : 9;
    for (int row = 0; row < rows; ++row) {
      for (int i = 0; i < (is_wall ? 6 : rows - row); ++i) {
        BodyDef def;
        def.pose.position = is_wall ? DVec3{i + (row % 2) * 0.5, 0.25 + 0.5 * row, 0}
                                    : DVec3{1.1 * i + 0.55 * row, 0.5 + row, 0};
        const Box box{is_wall ? Vec3{0.5f, 0.25f, 0.25f} : Vec3{0.5f, 0.5f, 0.5f}};
        stones.push_back(world.add_body(def, {.geometry = box, .density = 1000, .material = stone}));
      }
    }
    std::vector<DVec3> built;
    for (const BodyId body : stones) built.push_back(world.pose(body).position);
    for (int i = 0; i < 60; ++i) {
      world.step(1.0f / 60.0f);
      EXPECT_LT(world.solver_stats().residual, kMaxResidual) << is_wall << " step " << i;
      EXPECT_EQ(world.solver_stats().direct_islands, world.solver_stats().islands)
          << is_wall << " step " << i;
    }
    EXPECT_GT(world.solver_stats().largest_rows, 900);
    for (std::size_t i = 0; i < stones.size(); ++i)
      EXPECT_LT(length(world.pose(stones[i]).position - built[i]), 1.0e-6) << is_wall << " stone " << i;
  }
}

TEST(Solvers, SettingsThatCannotBeAreRefused) {
  WorldDef def;
  def.stepping.solver = SolverKind::lcp;
  def.stepping.solver_options.friction_sides = 5;
  EXPECT_FALSE(World::create(def));
  def.stepping.solver_options = {.lcp_method = LcpMethod::lemke};
  EXPECT_FALSE(World::create(def));
  World world = make_world();
  EXPECT_FALSE(world.set_solver(SolverKind::lcp, {.iterations = -1}));
  EXPECT_EQ(world.def().stepping.solver, SolverKind::soft_step);
  EXPECT_TRUE(world.set_solver(SolverKind::lcp, {.friction_sides = 8}));
  EXPECT_EQ(world.def().stepping.solver, SolverKind::lcp);
  EXPECT_EQ(world.def().stepping.solver_options.friction_sides, 8);
}

}  // namespace
}  // namespace gyre::laws::solver_kinds_test
