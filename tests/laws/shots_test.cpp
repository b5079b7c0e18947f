// Random shots at thin walls: spheres, rods, plates, boxes that tumble, hulls, cylinders, cones and compounds, at up to 1,000 m/s
// and some at up to 3,000, against a centimetre of box, mesh, height field, moving wall and plate that is free. None gets
// through, and what glances off keeps its way along the wall.
#include "laws/kit.h"

namespace gyre::laws::shots_test {
namespace {

// The same numbers everywhere. (D. Knuth, MMIX.)
class Dice {
 public:
  explicit Dice(std::uint64_t seed) : state_(seed * 2654435761u + 1u) {}
  float operator()(float low, float high) {
    state_ = state_ * 6364136223846793005u + 1442695040888963407u;
    return low + (high - low) * (float(state_ >> 40) * (1.0f / 16777216.0f));
  }
  int below(int n) { return int((*this)(0.0f, float(n))); }
  Vec3 direction() {
    for (;;) {
      const Vec3 v{(*this)(-1, 1), (*this)(-1, 1), (*this)(-1, 1)};
      if (length_squared(v) > 0.01f && length_squared(v) < 1.0f) return normalized(v);
    }
  }
  Quat turn() { return from_axis_angle(direction(), (*this)(0.0f, 3.1f)); }

 private:
  std::uint64_t state_;
};

struct Projectile {
  std::vector<ShapeDef> shapes;
  std::vector<DVec3> tips;  // farthest points of the body, from its middle
  float size = 0.0f;
};

constexpr int kProjectiles = 8;
const char* const kProjectileNames[kProjectiles] = {"sphere", "rod",      "plate", "box",
                                                    "hull",   "cylinder", "cone",  "compound"};

Projectile make_projectile(Dice& dice, int kind) {
  Projectile out;
  const auto add = [&](const AnyShape& shape, DVec3 at = {}) {
    ShapeDef def;
    def.geometry = shape;
    def.local.position = to_float(at);
    out.shapes.push_back(def);
  };
  const auto tip = [&](double x, double y, double z) {
    out.tips.push_back({x, y, z});
    out.size = std::max(out.size, float(std::sqrt(x * x + y * y + z * z)));
  };
  const auto box = [&](Vec3 half) {
    add(Box{half});
    for (int i = 0; i < 8; ++i)
      tip(i & 1 ? half.x : -half.x, i & 2 ? half.y : -half.y, i & 4 ? half.z : -half.z);
  };
  switch (kind) {
    case 0: {
      const float r = dice(0.01f, 0.05f);
      add(Sphere{r});
      tip(r, 0, 0);
      break;
    }
    case 1:
      add(Capsule{0.01f, 0.2f});
      tip(0, 0.21, 0), tip(0, -0.21, 0);
      break;
    case 2:
      box({0.15f, 0.005f, 0.1f});
      break;
    case 3:
      box({dice(0.02f, 0.08f), dice(0.02f, 0.08f), dice(0.02f, 0.08f)});
      break;
    case 4: {
      std::vector<Vec3> points;
      for (int i = 0; i < 12; ++i) points.push_back(dice(0.03f, 0.08f) * dice.direction());
      add(*cook_hull(points));
      for (const Vec3& p : points) tip(double(p.x), double(p.y), double(p.z));
      break;
    }
    case 5:
      add(Cylinder{0.03f, 0.04f});
      for (int i = 0; i < 4; ++i) tip(i & 1 ? 0.03 : -0.03, i & 2 ? 0.04 : -0.04, 0);
      break;
    case 6:
      add(Cone{0.04f, 0.05f});
      tip(0, 0.05, 0), tip(0.04, -0.05, 0), tip(-0.04, -0.05, 0);
      break;
    default:
      add(Sphere{0.03f}, {0.1, 0, 0});
      add(Box{{0.02f, 0.02f, 0.02f}}, {-0.1, 0, 0});
      add(Capsule{0.01f, 0.1f}, {0, 0, 0});
      tip(0.13, 0, 0), tip(-0.12, 0, 0), tip(0, 0.11, 0), tip(0, -0.11, 0);
      break;
  }
  return out;
}

enum class WallKind { box, mesh, height_field, moving, free_plate };
constexpr int kWalls = 5;
const char* const kWallNames[kWalls] = {"box", "mesh", "height field", "moving wall", "free plate"};
constexpr float kHalf = 3.0f, kThin = 0.005f;  // m: half a wall's side and thickness

// A centimetre of mesh: a box whose sides are cut into triangles.
Geometry mesh_wall() {
  std::vector<Vec3> v;
  std::vector<std::uint32_t> t;
  constexpr int kCells = 7;
  for (const float y : {-kThin, kThin}) {
    const auto base = std::uint32_t(v.size());
    for (int z = 0; z <= kCells; ++z) {
      for (int x = 0; x <= kCells; ++x)
        v.push_back(
            {kHalf * (2.0f * float(x) / kCells - 1.0f), y, kHalf * (2.0f * float(z) / kCells - 1.0f)});
    }
    for (std::uint32_t z = 0; z < kCells; ++z) {
      for (std::uint32_t x = 0; x < kCells; ++x) {
        const std::uint32_t a = base + z * (kCells + 1) + x, b = a + 1, c = a + kCells + 2,
                            d = a + kCells + 1;
        if (y > 0.0f) {
          t.insert(t.end(), {a, c, b, a, d, c});
        } else {
          t.insert(t.end(), {a, b, c, a, c, d});
        }
      }
    }
  }
  return *cook_mesh({.vertices = v, .indices = t});
}
Geometry flat_field() {
  const std::vector<float> heights(64, kThin);
  return *cook_height_field({.heights = heights, .columns = 8, .rows = 8, .spacing = 2.0f * kHalf / 7.0f});
}

struct Shot {
  bool through = false;  // the middle passed
  bool pierced = false;  // a tip was left behind the wall when it was over
};

// The wall lies in x and z; the shot comes from above, at any angle up to 70 degrees.
Shot shoot(Dice& dice, int projectile_kind, WallKind wall_kind, const Geometry& mesh, const Geometry& field) {
  const Projectile projectile = make_projectile(dice, projectile_kind);
  World world = make_world({.gravity = {0, 0, 0}, .sleeping = false});
  const float speed = dice.below(5) == 0 ? dice(1000.0f, 3000.0f) : dice(20.0f, 1000.0f);
  BodyDef wall{.type = BodyType::fixed, .pose = {.position = {0, 0, 0}, .orientation = dice.turn()}};
  ShapeDef shape{.geometry = Box{{kHalf, kThin, kHalf}}};
  if (wall_kind == WallKind::mesh) shape.geometry = mesh;
  if (wall_kind == WallKind::height_field) shape.geometry = field;
  const Quat q = wall.pose.orientation;
  float wall_speed = 0.0f;
  if (wall_kind == WallKind::moving) {
    wall.type = BodyType::kinematic;
    wall_speed = dice(-20.0f, 20.0f);
    wall.linear_velocity = rotate(q, Vec3{0, wall_speed, 0});
  } else if (wall_kind == WallKind::free_plate) {
    wall.type = BodyType::dynamic;
    wall.mass = 1000.0f;
  }
  const BodyId wall_id = world.add_body(wall, shape);
  const float angle = dice(0.0f, 1.2f), around = dice(0.0f, 6.28f);
  const Vec3 way = rotate(
      q, Vec3{std::sin(angle) * std::cos(around), -std::cos(angle), std::sin(angle) * std::sin(around)});
  const float approach = speed * std::cos(angle) + wall_speed;
  // Far enough to be clear of the wall, and to meet it at any moment of a step.
  const float before = dice(1.0f, 4.0f) / 60.0f;
  const float clear = (projectile.size + 0.02f) / std::cos(angle);
  const Vec3 meets = rotate(q, Vec3{dice(-1.0f, 1.0f), 0.0f, dice(-1.0f, 1.0f)});
  BodyDef body{.pose = {.position = DVec3(meets) - double(speed * before + clear) * DVec3(way),
                        .orientation = dice.turn()},
               .linear_velocity = speed * way,
               .angular_velocity = dice(0.0f, 60.0f) * dice.direction(),
               .continuous = wall_kind == WallKind::free_plate,
               .mass = 0.2f};
  if (wall_kind == WallKind::moving) body.pose.position += double(wall_speed * before) * turned(q, {0, 1, 0});
  if (approach < 5.0f) return {};
  const BodyId id = world.add_body(body, projectile.shapes);
  Shot out;
  for (int step = 0; step < 20; ++step) {
    world.step(kStep);
    const Pose at = world.pose(wall_id), own = world.pose(id);
    const DVec3 middle = turned_back(at.orientation, world.center_of_mass(id) - at.position);
    if (std::fabs(middle.x) > double(kHalf) || std::fabs(middle.z) > double(kHalf)) {
      out.pierced = false;  // gone past its border
      break;
    }
    out.through = out.through || middle.y < 0.0;
    out.pierced = false;
    for (const DVec3& tip : projectile.tips) {
      const DVec3 p = turned_back(at.orientation, own.position + turned(own.orientation, tip) - at.position);
      out.pierced = out.pierced || p.y < -2.0 * double(kThin);
    }
  }
  return out;
}

void expect_none_through(int shots, std::uint64_t seed) {
  const Geometry mesh = mesh_wall(), field = flat_field();
  int through = 0, pierced = 0;
  for (int i = 0; i < shots; ++i) {
    Dice dice(seed + std::uint64_t(i));
    const int kind = i % kProjectiles, wall = (i / kProjectiles) % kWalls;
    const Shot shot = shoot(dice, kind, WallKind(wall), mesh, field);
    through += shot.through;
    pierced += shot.pierced;
    if (shot.through || shot.pierced)
      std::printf("shot %d: %s %s a %s\n", i, kProjectileNames[kind],
                  shot.through ? "went through" : "stuck in", kWallNames[wall]);
  }
  EXPECT_TRUE(limit_row("shots of all that went through", through, 0, 0));
  EXPECT_TRUE(limit_row("shots of all that stuck in the wall", pierced, 0, 0));
}

TEST(Shots, NoneOfFiveHundredGetsThrough) { expect_none_through(500, 1); }
TEST(LongShots, NoneOfTenThousandGetsThrough) { expect_none_through(10000, 100000); }

// Along a wall of half a kilometre, without friction: the way along it in ten steps, as a part of what speed times time
// makes. A step that ends where the wall is met would lose up to a tenth.
double way_kept(const AnyShape& shape, float speed, float degrees, float phase, BodyType wall_type,
                float wall_speed) {
  World world = make_world({.gravity = {0, 0, 0}, .sleeping = false});
  world.add_body({.type = wall_type, .linear_velocity = {0, wall_speed, 0}},
                 {.geometry = Box{{500.0f, 0.5f, 10.0f}}, .material = surface(0.0f)});
  const float angle = degrees * kDegree, along = speed * std::cos(angle), down = speed * std::sin(angle);
  const double before = double(phase) / 60.0, lowest = 0.05;
  const BodyId id = world.add_body({.pose = {.position = {-400.0, 0.5 + lowest + double(down) * before, 0.0}},
                                    .linear_velocity = {along, -down, 0}},
                                   {.geometry = shape, .material = surface(0.0f)});
  run(world, 10.0 / 60.0);
  return (world.pose(id).position.x + 400.0) / (double(along) * 10.0 / 60.0);
}

TEST(Glancing, KeepsItsWayAlongTheWall) {
  double least = 1.0;
  for (const AnyShape& shape :
       {AnyShape(Sphere{0.05f}), AnyShape(Box{{0.05f, 0.05f, 0.05f}}), AnyShape(Box{{0.1f, 0.05f, 0.02f}})}) {
    for (const float speed : {30.0f, 100.0f, 300.0f, 1000.0f}) {
      for (const float degrees : {3.0f, 10.0f, 30.0f, 60.0f}) {
        for (const float phase : {0.1f, 0.5f, 0.9f, 2.3f})
          least = std::min(least, way_kept(shape, speed, degrees, phase, BodyType::fixed, 0.0f));
      }
    }
  }
  EXPECT_TRUE(limit_row("way along the wall lost by a glancing hit (share)", 1.0 - least, 0.01, 1e-4));
}

TEST(Glancing, KeepsItsWayAlongAMovingWall) {
  double least = 1.0;
  for (const float wall_speed : {-5.0f, 5.0f}) {
    for (const float speed : {100.0f, 1000.0f}) {
      for (const float phase : {0.1f, 0.5f, 0.9f})
        least =
            std::min(least, way_kept(Sphere{0.05f}, speed, 10.0f, phase, BodyType::kinematic, wall_speed));
    }
  }
  EXPECT_TRUE(limit_row("way along a moving wall lost by a glancing hit (share)", 1.0 - least, 0.01, 1e-4));
}

// small cubes at 20 m/s on a fixed disc, thin as a coin.
TEST(Cubes, DoNotPassAThinDisc) {
  int through = 0;
  for (int i = 0; i < 200; ++i) {
    Dice dice(7000 + std::uint64_t(i));
    World world = make_world({.sleeping = false});
    world.add_body({.type = BodyType::fixed}, {.geometry = Cylinder{0.5f, dice(0.0005f, 0.005f)}});
    const float half = dice(0.005f, 0.03f), angle = dice(0.0f, 6.28f), out = dice(0.0f, 0.35f);
    const BodyId cube =
        world.add_body({.pose = {.position = {double(out * std::cos(angle)), 1.0 + double(dice(0.0f, 0.4f)),
                                              double(out * std::sin(angle))},
                                 .orientation = dice.turn()},
                        .linear_velocity = {0, -20, 0},
                        .angular_velocity = dice(0.0f, 20.0f) * dice.direction()},
                       {.geometry = Box{{half, half, half}}});
    for (int step = 0; step < 60; ++step) {
      world.step(kStep);
      const DVec3 p = world.pose(cube).position;
      if (p.x * p.x + p.z * p.z > 0.2) break;  // over the border
      through += int(p.y < 0.0);
      if (p.y < 0.0) break;
    }
  }
  EXPECT_TRUE(limit_row("A-157 cubes through a thin disc", through, 0, 0));
}

// sticks, bullets that spin, needles, and a shot at a stack.
struct Fast {
  const char* name;
  AnyShape shape;
  float speed;
  Vec3 spin;
  float wall;  // m thick
};
TEST(FastBodies, DoNotPassWalls) {
  const Fast all[] = {{"stick 4 m x 0.2, 100 m/s, spinning", Box{{2.0f, 0.1f, 0.1f}}, 100, {0, 0, 30}, 0.2f},
                      {"stick 4 m x 0.2, 100 m/s, tumbling", Box{{2.0f, 0.1f, 0.1f}}, 100, {10, 20, 5}, 0.2f},
                      {"bullet at 600 m/s, spinning", Capsule{0.02f, 0.05f}, 600, {200, 0, 50}, 0.1f},
                      {"3 x 0.1 x 0.1 at 180 m/s", Box{{1.5f, 0.05f, 0.05f}}, 180, {0, 0, 0}, 0.2f},
                      {"3 x 0.1 x 0.1 at 180 m/s, turning", Box{{1.5f, 0.05f, 0.05f}}, 180, {0, 3, 7}, 0.2f},
                      {"needle", Capsule{0.002f, 0.2f}, 300, {0, 0, 0}, 0.1f},
                      {"needle, tumbling", Capsule{0.002f, 0.2f}, 300, {0, 10, 100}, 0.1f}};
  for (const Fast& fast : all) {
    for (int phase = 0; phase < 20; ++phase) {
      World world = make_world({.gravity = {0, 0, 0}, .sleeping = false});
      world.add_body({.type = BodyType::fixed}, {.geometry = Box{{0.5f * fast.wall, 10, 10}}});
      Dice dice(9000 + std::uint64_t(phase));
      const BodyId body = world.add_body(
          {.pose = {.position = {-3.0 - double(fast.speed) / 60.0 * double(phase) / 20.0, 0.2, 0.1},
                    .orientation = phase % 2 == 0 ? Quat{} : dice.turn()},
           .linear_velocity = {fast.speed, 0, 0},
           .angular_velocity = fast.spin},
          {.geometry = fast.shape});
      for (int step = 0; step < 60; ++step) {
        world.step(kStep);
        const DVec3 p = world.pose(body).position;
        if (std::fabs(p.y) > 9.0 || std::fabs(p.z) > 9.0) break;  // gone past its border
        ASSERT_LT(p.x, 0.0) << "A-159 " << fast.name << ", phase " << phase << ", step " << step;
      }
    }
  }
}
// What moves by itself runs over nothing, whether that rests or goes along more slowly.
TEST(Overrun, APlateTakesAlongWhatItMeets) {
  for (const float speed : {20.0f, 40.0f, 100.0f, 400.0f}) {
    for (const float share : {-0.5f, 0.0f, 0.3f}) {  // of the plate's speed: the ball's
      // From the first step on, in which the broad phase does not yet know the speed of the plate, to some steps away.
      for (int phase = 0; phase < 40; ++phase) {
        World world = make_world({.gravity = {0, 0, 0}, .sleeping = false});
        const double ahead = 0.07 + double(speed) / 60.0 * double(phase) / 10.0;
        const BodyId plate = world.add_body({.type = BodyType::kinematic, .linear_velocity = {speed, 0, 0}},
                                            {.geometry = Box{{0.01f, 5, 5}}});
        const BodyId ball = world.add_body(
            {.pose = {.position = {ahead, 0.1, 0.2}}, .linear_velocity = {share * speed, 0, 0}},
            {.geometry = Sphere{0.05f}});
        for (int step = 0; step < 20; ++step) {
          world.step(kStep);
          ASSERT_GT(world.pose(ball).position.x, world.pose(plate).position.x)
              << speed << " m/s, ball at " << share << " of it, phase " << phase << ", step " << step;
        }
      }
    }
  }
}

// Its far end is fast, its middle is not: what counts is how fast it passes what it meets, in the air or on the ground.
void expect_arm_takes_along(const AnyShape& what, bool on_ground, float spin, double out, int phase) {
  World world = make_world({.gravity = {0, 0, on_ground ? -9.81f : 0.0f}, .sleeping = false});
  if (on_ground) world.add_body({.type = BodyType::fixed}, {.geometry = Plane{{0, 0, 1}, -0.05f}});
  const BodyId arm = world.add_body({.type = BodyType::kinematic}, {.geometry = Box{{2, 0.01f, 0.5f}}});
  const double ahead = 0.1 / out + double(spin) / 60.0 * double(phase) / 10.0;
  const BodyId body = world.add_body(
      {.pose = {.position = {out * std::cos(ahead), out * std::sin(ahead), 0.0}}}, {.geometry = what});
  if (on_ground) world.step(kStep);  // so that it lies
  world.set_velocity(arm, {}, {0, 0, spin});
  for (int step = 0; step < 6; ++step) {
    world.step(kStep);
    const Pose frame = world.pose(arm);
    const Vec3 seen = rotate_inverse(frame.orientation, difference(world.pose(body).position, frame.position));
    if (seen.x > 2.0f) break;  // over its end
    EXPECT_GT(seen.y, 0.0f) << (on_ground ? "on the ground, " : "in the air, ") << spin << " rad/s, " << out
                            << " m out, phase " << phase << ", step " << step;
  }
}
TEST(Overrun, AnArmTakesAlongWhatItMeets) {
  for (const float spin : {10.0f, 30.0f}) {
    for (const double out : {0.5, 1.0, 1.8}) {
      for (int phase = 1; phase < 10; ++phase) {
        for (const bool on_ground : {false, true}) {
          expect_arm_takes_along(Sphere{0.05f}, on_ground, spin, out, phase);
          expect_arm_takes_along(Box{{0.05f, 0.05f, 0.05f}}, on_ground, spin, out, phase);
        }
      }
    }
  }
}

// Where something will be in the step is known as the step begins, whatever its length and whatever was told between steps: its
// start, a new velocity, a step longer than those before.
TEST(Overrun, NothingPassesAfterACommand) {
  for (const float speed : {20.0f, 100.0f}) {
    for (int phase = 0; phase < 10; ++phase) {
      for (const float long_step : {kStep, 3.0f * kStep}) {
        World world = make_world({.gravity = {0, 0, 0}, .sleeping = false});
        const BodyId plate = world.add_body({.type = BodyType::kinematic}, {.geometry = Box{{0.01f, 5, 5}}});
        const double ahead = 0.07 + double(speed * long_step) * double(phase) / 10.0;
        const BodyId ball = world.add_body({.pose = {.position = {ahead, 0, 0}}}, {.geometry = Sphere{0.05f}});
        const BodyId behind = world.add_body({.pose = {.position = {-ahead, 0, 0}}}, {.geometry = Sphere{0.05f}});
        for (int step = 0; step < 3; ++step) world.step(kStep);
        world.set_velocity(plate, {speed, 0, 0}, {});
        for (int step = 0; step < 2; ++step) {
          world.step(long_step);
          ASSERT_GT(world.pose(ball).position.x, world.pose(plate).position.x) << speed << " m/s, phase " << phase;
        }
        const Pose back{{world.pose(plate).position.x - double(speed * long_step) * 2.5, 0, 0}, {}};
        world.move_kinematic(plate, back, long_step);
        world.step(long_step);
        ASSERT_LT(world.pose(behind).position.x, world.pose(plate).position.x) << speed << " m/s, phase " << phase;
      }
    }
  }
}

TEST(FastBodies, DoNotPassAStack) {
  for (int phase = 0; phase < 5; ++phase) {
    World world = make_world({.sleeping = false});
    add_ground(world, surface(0.6f));
    std::vector<BodyId> boxes;
    for (int i = 0; i < 10; ++i) {
      boxes.push_back(world.add_body({.pose = {.position = {0, 0.25 + 0.5 * i, 0}}, .continuous = true},
                                     {.geometry = Box{{0.25f, 0.25f, 0.25f}}, .material = surface(0.6f)}));
    }
    const BodyId bullet = world.add_body({.pose = {.position = {-10.0 - 2.0 * phase, 2.25, 0}},
                                          .linear_velocity = {500, 0, 0},
                                          .continuous = true,
                                          .mass = 1.0f},
                                         {.geometry = Sphere{0.1f}});
    bool passed = false;
    for (int step = 0; step < 30; ++step) {
      world.step(kStep);
      // Ahead of the box that it hit it cannot come.
      double first = 1e9;
      for (const BodyId box : boxes) {
        const DVec3 p = world.pose(box).position;
        if (std::fabs(p.y - 2.25) < 0.3 && std::fabs(p.z) < 0.3) first = std::min(first, p.x);
      }
      passed = passed || (step < 4 && first < 1e8 && world.pose(bullet).position.x > first);
    }
    EXPECT_FALSE(passed) << "A-159, 500 m/s against a stack, phase " << phase;
  }
}

}  // namespace
}  // namespace gyre::laws::shots_test
