// Liquids against measurements and balances: a column that falls, a tank at rest, floats and sinkers of many densities, a body as heavy as the
// liquid, a wall that moves, a blow in the air, the volume of a liquid that sloshes.
// Sources: J. Martin, W. Moyce, "An Experimental Study of the Collapse of Liquid Columns on a Rigid Horizontal Plane", 1952; Archimedes.
#include "laws/kit.h"

namespace gyre::laws::liquid_flow_test {
namespace {

constexpr double kG = kGravity;

// A plane flow of square cells: one cell deep.
LiquidDef plane_tank(double width, double height, double depth, float cell) {
  LiquidDef def;
  def.lower = {}, def.upper = {width, height, double(cell)};
  def.cell_size = cell;
  def.fill = {{{}, {width, depth, double(cell)}}};
  return def;
}

// A block in a plane flow that does not leave the plane.
BodyDef plane_block(DVec3 position, bool turns) {
  BodyDef body;
  body.pose.position = position;
  body.can_sleep = false;
  body.locked = {.linear = {false, false, true}, .angular = {true, true, !turns}};
  return body;
}

struct Particles {
  std::vector<DVec3> positions;
  std::vector<Vec3> velocities;
};
Particles particles_of(const World& world, FluidId liquid) {
  Particles out;
  const std::size_t count = world.liquid_particles(liquid, {}, {});
  out.positions.resize(count), out.velocities.resize(count);
  world.liquid_particles(liquid, out.positions, out.velocities);
  return out;
}

struct Measured {
  double time, value;
};
// The measured value at a time, between the times of the table linearly.
double between(std::span<const Measured> table, double time) {
  std::size_t i = 1;
  while (i + 1 < table.size() && table[i].time < time) ++i;
  const Measured &a = table[i - 1], &b = table[i];
  return a.value + (b.value - a.value) * (time - a.time) / (b.time - a.time);
}

// A column of the width a and the height 2 a. Times in units of sqrt(a / (2 g)) for the front, sqrt(a / g) for the height.
TEST(Liquid, FallsAsAColumnWasMeasured) {
  constexpr double kWidth = 0.05715;
  constexpr float kCell = float(kWidth) / 16, kShort = 1.0f / 600;
  World world = make_world();
  LiquidDef def = plane_tank(5 * kWidth, 2.5 * kWidth, 2 * kWidth, kCell);
  def.fill[0].upper.x = kWidth;
  const FluidId water = world.add_liquid(def);
  std::vector<Measured> front, height;
  for (int i = 0; i < 144; ++i) {
    world.step(kShort);
    const double time = world.time();
    double tip = 0.0;
    for (const DVec3 at : particles_of(world, water).positions) tip = std::max(tip, at.x);
    front.push_back({time * std::sqrt(2 * kG / kWidth), tip / kWidth});
    const double top = double(world.probe(water, {0.5 * double(kCell), 0.01, 0.001}).surface);
    height.push_back({time * std::sqrt(kG / kWidth), top / (2 * kWidth)});
  }
  constexpr Measured kFront[] = {{0.41, 1.11}, {0.84, 1.22}, {1.19, 1.44}, {1.43, 1.67}, {1.63, 1.89},
                                 {1.83, 2.11}, {1.98, 2.33}, {2.20, 2.56}, {2.32, 2.78}, {2.51, 3.00}};
  // The gate took time to open: the measured times may be later by up to 0.2.
  double least = 1.0;
  for (double shift = 0.0; shift <= 0.2; shift += 0.02) {
    double most = 0.0;
    for (const Measured one : kFront)
      most = std::max(most, std::fabs(between(front, one.time - shift) / one.value - 1.0));
    least = std::min(least, most);
  }
  EXPECT_TRUE(
      limit_row("F-23 front of a falling column, largest error over the measured place", least, 0.10, 0.03));
  constexpr Measured kHeight[] = {{0.56, 0.94}, {0.77, 0.89}, {0.93, 0.83}, {1.08, 0.78}, {1.28, 0.72},
                                  {1.46, 0.67}, {1.66, 0.61}, {1.84, 0.56}, {2.00, 0.50}, {2.21, 0.44},
                                  {2.45, 0.39}, {2.70, 0.33}, {3.06, 0.28}};
  double most = 0.0;
  for (const Measured one : kHeight)
    most = std::max(most, std::fabs(between(height, one.time) / one.value - 1.0));
  EXPECT_TRUE(
      limit_row("F-24 height of a falling column, largest error over the measured height", most, 0.08, 0.03));
}

// Between a solid and the floor there is less than a cell of room. Liquid is not drawn in there: the level stays, and so does rest.
TEST(Liquid, StaysAboveNarrowGaps) {
  constexpr double kCell = 0.025;
  double drift = 0.0, fastest = 0.0;
  const AnyShape shapes[] = {Sphere{0.1f}, Box{{0.1f, 0.1f, 0.1f}}, Sphere{0.1f}};
  const double heights[] = {0.1, 0.112, 0.104};
  for (int i = 0; i < 3; ++i) {
    World world = make_world();
    world.add_body({.type = BodyType::fixed, .pose = {.position = {0.403, heights[i], 0.5 * kCell}}},
                   {.geometry = shapes[i]});
    const FluidId pool = world.add_liquid(plane_tank(0.8, 0.6, 0.35, float(kCell)));
    const double before = world.fluid_info(pool).volume;
    run(world, 3.0);
    drift = std::max(drift, std::fabs(world.fluid_info(pool).volume / before - 1.0));
    for (const Vec3 one : particles_of(world, pool).velocities)
      fastest = std::max(fastest, double(length(one)));
  }
  EXPECT_TRUE(
      limit_row("F-43 drift of the volume with a solid less than a cell above the floor", drift, 1e-2, 5e-3));
  EXPECT_TRUE(
      limit_row("F-44 fastest particle there over sqrt(g H)", fastest / std::sqrt(kG * 0.35), 1e-2, 2e-3));
}

// Under flat rafts that bob, particles do not gather.
TEST(Liquid, KeepsItsVolumeUnderRafts) {
  constexpr double kCell = 0.025;
  double drift = 0.0;
  const float halves[] = {0.25f, 0.2f}, densities[] = {500.0f, 700.0f};
  const double heights[] = {0.55, 0.6};
  for (int i = 0; i < 2; ++i) {
    World world = make_world();
    BodyDef raft = plane_block({0.6, heights[i], 0.5 * kCell}, true);
    raft.locked = {.linear = {true, false, true}, .angular = {true, true, false}};
    world.add_body(raft, {.geometry = Box{{halves[i], 0.04f, 0.5f * float(kCell)}}, .density = densities[i]});
    const FluidId pool = world.add_liquid(plane_tank(1.2, 1.0, 0.45, float(kCell)));
    const double before = world.fluid_info(pool).volume;
    run(world, 4.0);
    double after = 0.0;
    for (int step = 0; step < 30; ++step) {
      world.step(kStep);
      after += world.fluid_info(pool).volume / 30.0;
    }
    drift = std::max(drift, std::fabs(after / before - 1.0));
  }
  EXPECT_TRUE(limit_row("F-47 drift of the volume under a raft that fell on a pool", drift, 1e-2, 5e-3));
}

// Drops that lie on a plate above a pool rest there.
TEST(Liquid, RestsOnAPlateAsDrops) {
  constexpr double kCell = 0.05;
  World world = make_world();
  world.add_body({.type = BodyType::fixed, .pose = {.position = {0.5, 0.43, 0}}},
                 {.geometry = Box{{0.3f, 0.05f, 1}}});
  LiquidDef def = plane_tank(1.0, 1.0, 0.2, float(kCell));
  def.fill.push_back({{0.5, 0.52, 0}, {0.53, 0.56, kCell}});
  const FluidId pool = world.add_liquid(def);
  run(world, 2.0);
  const Particles drops = particles_of(world, pool);
  double fastest = 0.0;
  int on_plate = 0;
  for (std::size_t i = 0; i < drops.positions.size(); ++i) {
    if (drops.positions[i].y < 0.45) continue;
    fastest = std::max(fastest, double(length(drops.velocities[i])));
    ++on_plate;
  }
  EXPECT_GT(on_plate, 0);
  EXPECT_TRUE(limit_row("F-45 speed of drops on a plate after 2 s, m/s", fastest, 0.1, 0.01));
}

TEST(Liquid, ComesToRest) {
  World world = make_world();
  LiquidDef def;
  def.lower = {}, def.upper = {0.8, 0.8, 0.4}, def.cell_size = 0.05f;
  def.fill = {{{}, {0.8, 0.5, 0.4}}};
  const FluidId pool = world.add_liquid(def);
  run(world, 5.0);
  double most = 0.0;
  for (const Vec3 one : particles_of(world, pool).velocities) most = std::max(most, double(length(one)));
  EXPECT_TRUE(limit_row("F-25 fastest particle of a tank at rest over sqrt(g H)", most / std::sqrt(kG * 0.5),
                        1e-3, 1e-4));
}

// The draft of a block that does not turn, over its height, so many cells wide.
double draft_of(double ratio, int cells) {
  constexpr double kSide = 0.2, kDepth = 0.4;
  const float cell = float(kSide) / float(cells);
  World world = make_world();
  const BodyId block =
      world.add_body(plane_block({0.4, kDepth + kSide * (0.5 - ratio), 0.5 * double(cell)}, false),
                     {.geometry = Box{{0.5f * float(kSide), 0.5f * float(kSide), 0.5f * cell}},
                      .density = 1000.0f * float(ratio)});
  const FluidId pool = world.add_liquid(plane_tank(0.8, 0.7, kDepth, cell));
  run(world, 2.0);
  double draft = 0.0;
  for (int i = 0; i < 60; ++i) {
    world.step(kStep);
    const double level = double(world.probe(pool, {0.1, 0.3, 0.001}).surface);
    draft += (level - world.pose(block).position.y + 0.5 * kSide) / kSide / 60.0;
  }
  return draft;
}

TEST(Liquid, CarriesEveryDensity) {
  double error = 0.0, between_cells = 0.0;
  for (const double ratio : {0.05, 0.2, 0.5, 0.8}) {
    const double fine = draft_of(ratio, 8);
    error = std::max(error, std::fabs(fine - ratio));
    between_cells = std::max(between_cells, std::fabs(draft_of(ratio, 5) - fine));
  }
  EXPECT_TRUE(
      limit_row("F-26 draft over height at 0.05 to 0.8 times the density, largest error", error, 0.03, 5e-3));
  EXPECT_TRUE(
      limit_row("F-27 the same at 5 and 8 cells a side, largest difference", between_cells, 0.05, 0.01));
}

// A body as heavy as the liquid stays where it is, one of 1.5 times its density sinks.
TEST(Liquid, SinksOnlyWhatIsHeavier) {
  constexpr float kCell = 0.025f, kSide = 0.2f;
  const auto sunk = [&](double ratio, double seconds) {
    World world = make_world();
    const DVec3 begin{0.43, 0.31, 0.5 * double(kCell)};
    const BodyId block = world.add_body(
        plane_block(begin, true),
        {.geometry = Box{{0.5f * kSide, 0.5f * kSide, 0.5f * kCell}}, .density = 1000.0f * float(ratio)});
    world.add_liquid(plane_tank(0.8, 0.7, 0.55, kCell));
    run(world, seconds);
    return length(world.pose(block).position - begin);
  };
  EXPECT_TRUE(limit_row("F-28 way of a body as heavy as the liquid in 10 s, cells",
                        sunk(1.0, 10.0) / double(kCell), 1.0, 0.01));
  EXPECT_GT(sunk(1.5, 1.0), 0.15);
}

// A wall one cell thick that sweeps through a tank at two cells a step leaves nothing behind.
TEST(Liquid, DoesNotPassAWallThatMoves) {
  constexpr float kCell = 1.0f / 32;
  int most = 0;
  for (const float cells : {0.5f, 2.0f}) {
    World world = make_world();
    const float speed = cells * kCell * 60.0f;
    BodyDef def{.type = BodyType::kinematic, .linear_velocity = {speed, 0, 0}};
    def.pose.position = {7.4 * double(kCell), 0.3, 0};
    const BodyId wall = world.add_body(def, {.geometry = Box{{0.5f * kCell, 2.0f, 1.0f}}});
    LiquidDef tank = plane_tank(48 * double(kCell), 24 * double(kCell), 0.4, kCell);
    tank.fill[0].lower.x = 8 * double(kCell), tank.fill[0].upper.x = 24 * double(kCell);
    const FluidId water = world.add_liquid(tank);
    for (int i = 0; i < int(20.0f / cells); ++i) {
      world.step(kStep);
      int behind = 0;
      for (const DVec3 at : particles_of(world, water).positions)
        behind += at.x < world.pose(wall).position.x ? 1 : 0;
      most = std::max(most, behind);
    }
  }
  EXPECT_TRUE(limit_row("F-29 particles that passed a moving wall one cell thick", double(most), 0.0, 0.0));
}

// Without gravity a block of 700 kg/m^3 runs into a ball of liquid that rests in the air: what one loses the other gains.
TEST(Liquid, TakesTheMomentumOfABlow) {
  constexpr float kCell = 1.0f / 64;
  constexpr double h = double(kCell);
  World world = make_world({.gravity = {}});
  BodyDef def = plane_block({24 * h, 40.6 * h, 0.5 * h}, true);
  def.linear_velocity = {1, 0, 0};
  const BodyId block =
      world.add_body(def, {.geometry = Box{{6 * kCell, 12 * kCell, 0.5f * kCell}}, .density = 700.0f});
  LiquidDef tank = plane_tank(128 * h, 80 * h, 1.0, kCell);
  tank.fill.clear();
  LiquidParticles ball;
  for (int i = 0; i < 256; ++i) {
    for (int j = 0; j < 160; ++j) {
      const DVec3 at{(0.5 * i + 0.25) * h, (0.5 * j + 0.25) * h, 0.5 * h};
      if (std::hypot(at.x - 52 * h, at.y - 40 * h) > 20 * h) continue;
      ball.positions.push_back(at), ball.velocities.push_back({});
    }
  }
  tank.particles = ball;
  const FluidId water = world.add_liquid(tank);
  run(world, 0.5);
  const double mass = double(world.mass_properties(block).mass);
  const double lost = mass * (1.0 - double(world.linear_velocity(block).x));
  double gained = 0.0;
  for (const Vec3 one : particles_of(world, water).velocities)
    gained += 1000.0 * 0.25 * h * h * h * double(one.x);
  EXPECT_GT(lost, 0.3 * mass);
  EXPECT_TRUE(relative_row("F-30 momentum that a blow gives to a liquid over what the block lost",
                           gained / lost, 1.0, 3e-2, 2e-2));
}

// A tank that is shaken through ten periods of its first wave keeps its volume.
TEST(Liquid, KeepsItsVolume) {
  World world = make_world();
  LiquidDef def = plane_tank(1.0, 1.0, 0.4, 1.0f / 32);
  const FluidId pool = world.add_liquid(def);
  const double before = world.fluid_info(pool).volume;
  for (int i = 0; i < 900; ++i) {
    const float time = float(i) * kStep;
    const float push = time < 10.0f ? 0.25f * std::sin(2 * kPi * time / 1.25f) : 0.0f;
    world.set_gravity({9.81f * push, -9.81f, 0});
    world.step(kStep);
  }
  EXPECT_TRUE(relative_row("F-31 volume after 10 s of sloshing and 5 s of rest",
                           world.fluid_info(pool).volume, before, 1e-2, 2e-3));
}

}  // namespace
}  // namespace gyre::laws::liquid_flow_test
