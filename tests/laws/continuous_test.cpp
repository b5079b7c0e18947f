// Fast bodies and thin ones, and sliding over meshes and over boxes laid flush: nothing passes through, nothing bumps.
#include "laws/kit.h"
#include "random.h"

namespace gyre::laws::continuous_test {
namespace {

int through_wall(const AnyShape& bullet, float speed, float thickness, BodyType wall_type, bool continuous) {
  int through = 0;
  for (int k = 0; k < 20; ++k) {
    World world = make_world({.gravity = {0, 0, 0}, .sleeping = false});
    world.add_body({.type = wall_type, .mass = 1e6f}, {.geometry = Box{{0.5f * thickness, 2, 2}}});
    const double start = -2.0 - double(speed) / 60.0 * double(k) / 20.0;
    const BodyId b = world.add_body({.pose = {.position = {start, 0.1, 0.2}},
                                     .linear_velocity = {speed, 0, 0},
                                     .continuous = continuous,
                                     .mass = 0.01f},
                                    {.geometry = bullet});
    for (int i = 0; i < 60; ++i) world.step(kStep);
    through += int(world.pose(b).position.x > 0.0);
  }
  return through;
}

TEST(Bullet, NeverPassesAThinWall) {
  for (const float speed : {50.0f, 100.0f, 300.0f, 1000.0f, 3000.0f}) {
    const int n = through_wall(Sphere{0.02f}, speed, 0.01f, BodyType::fixed, false);
    EXPECT_TRUE(limit_row("A-150 spheres of 20 through a fixed wall", n, 0, 0)) << speed;
    EXPECT_EQ(through_wall(Box{{0.02f, 0.02f, 0.02f}}, speed, 0.01f, BodyType::fixed, false), 0) << speed;
  }
}
TEST(Bullet, NeverPassesAThinDynamicWallWhenContinuous) {
  for (const float speed : {50.0f, 300.0f, 3000.0f}) {
    const int n = through_wall(Sphere{0.02f}, speed, 0.01f, BodyType::dynamic, true);
    EXPECT_TRUE(limit_row("gap 7: spheres of 20 through a dynamic wall", n, 0, 0)) << speed;
  }
}

// One ball of a dumb-bell is struck: the other, which touches nothing, is pushed farther than the box that it was given to move in.
TEST(Struck, FliesThroughNoWall) {
  for (const float speed : {50.0f, 300.0f, 1000.0f}) {
    for (int k = 0; k < 20; ++k) {
      World world = make_world({.gravity = {0, 0, 0}, .sleeping = false});
      const double wall = 0.8 + double(speed) / 60.0 * double(k) / 50.0;
      world.add_body({.type = BodyType::fixed, .pose = {.position = {wall, 0, 0}}},
                     {.geometry = Box{{0.005f, 2, 2}}});
      const BodyId back = world.add_body({.mass = 0.1f}, {.geometry = Sphere{0.05f}});
      const BodyId front =
          world.add_body({.pose = {.position = {0.5, 0, 0}}, .mass = 0.1f}, {.geometry = Sphere{0.05f}});
      world.add_joint(FixedDef{.a = back, .b = front, .anchor = {0.25, 0, 0}});
      run(world, 0.1);
      world.add_body({.pose = {.position = {-0.2, 0, 0}},
                      .linear_velocity = {speed, 0, 0},
                      .continuous = true,
                      .mass = 1},
                     {.geometry = Sphere{0.05f}});
      for (int i = 0; i < 3; ++i) {
        world.step(kStep);
        EXPECT_LT(world.pose(front).position.x, wall) << speed << " m/s, " << k << ", step " << i;
      }
      EXPECT_GT(world.pose(front).position.x, 0.6);
    }
  }
}

TEST(Blade, StrikesAPostAtAnySpin) {
  for (const float rate : {10.0f, 40.0f, 160.0f, 600.0f}) {
    for (int phase = 0; phase < 8; ++phase) {
      World world = make_world({.gravity = {0, 0, 0}, .sleeping = false});
      const BodyId post = world.add_body({.type = BodyType::fixed, .pose = {.position = {0.8, 0, 0}}},
                                         {.geometry = Box{{0.02f, 0.5f, 0.02f}}});
      const float angle = 0.4f + 0.3f * float(phase);
      const BodyId blade = world.add_body(
          {.pose = {.orientation = from_axis_angle({0, 1, 0}, angle)}, .angular_velocity = {0, rate, 0}},
          {.geometry = Box{{1.0f, 0.05f, 0.01f}}});
      world.add_joint(HingeDef{.b = blade, .anchor = {0, 0, 0}, .axis = {0, 1, 0}});
      bool hit = false;
      Unwrapped turned_by;
      for (int i = 0; i < 60; ++i) {
        world.step(kStep);
        for (const ContactHit& c : world.events().hits) hit |= c.body_a == post || c.body_b == post;
      }
      EXPECT_TRUE(hit) << "A-153 at " << rate << " rad/s, phase " << phase;
      EXPECT_LT(std::fabs(world.angular_velocity(blade).y), 0.5f * rate)
          << "A-153 at " << rate << " rad/s, phase " << phase;
    }
  }
}

TEST(Continuous, DoesNotStallFlight) {
  World world = make_world({.gravity = {0, 0, 0}, .sleeping = false});
  world.add_body({.type = BodyType::fixed, .pose = {.position = {50, 0, 0}}},
                 {.geometry = Box{{0.5f, 5, 5}}});
  const BodyId ball = world.add_body({.linear_velocity = {20, 0, 0}}, {.geometry = Sphere{0.5f}});
  double last = 0.0;
  for (int i = 0; i < 20; ++i) {
    world.step(0.25f);
    const double x = world.pose(ball).position.x;
    if (last < 43.0) {
      EXPECT_GE(x - last, 0.2 * 5.0) << "A-155 step " << i;
    }
    last = x;
  }
  EXPECT_NEAR(last, 49.0, 0.05) << "A-155 rests at the wall";
}

Geometry floor_mesh(float cell, int n) {
  std::vector<Vec3> v;
  std::vector<std::uint32_t> t;
  for (int z = 0; z <= n; ++z) {
    for (int x = 0; x <= n; ++x)
      v.push_back({cell * (float(x) - 0.5f * float(n)), 0, cell * (float(z) - 0.5f * float(n))});
  }
  for (int z = 0; z < n; ++z) {
    for (int x = 0; x < n; ++x) {
      const std::uint32_t a = std::uint32_t(z * (n + 1) + x), b = a + 1, c = b + std::uint32_t(n) + 1,
                          d = c - 1;
      for (const std::uint32_t i : {a, c, b, a, d, c}) t.push_back(i);
    }
  }
  return *cook_mesh({.vertices = v, .indices = t});
}

TEST(ThinSlab, NeverSinksIntoAMesh) {
  for (const float half : {0.03f, 0.015f}) {
    for (const float tilt : {0.0f, 0.1f, 0.5f, 1.2f}) {
      World world = make_world({.sleeping = false});
      world.add_body({.type = BodyType::fixed}, {.geometry = floor_mesh(1.0f, 20)});
      const BodyId slab = world.add_body(
          {.pose = {.position = {0.13, 5, 0.21}, .orientation = from_axis_angle({1, 0, 0.3f}, tilt)}},
          {.geometry = Box{{1, half, 1}}});
      double lowest = 10.0;
      for (int i = 0; i < 300; ++i) {
        world.step(kStep);
        lowest = std::min(lowest, world.pose(slab).position.y);
      }
      EXPECT_TRUE(limit_row("A-156 slab below the surface (m)", -lowest, 0.0, -0.9 * double(half))) << tilt;
    }
  }
}

struct Slide {
  double bump, speed_loss, heading;
};
// What a body does that slides at (8, 1.7) m/s on a frictionless floor for a second and a half.
Slide slide(World world, const AnyShape& shape, double rest_height) {
  const BodyId b =
      world.add_body({.pose = {.position = {-6.03, rest_height, -1.27}}, .linear_velocity = {8, 0, 1.7f}},
                     {.geometry = shape, .material = surface(0.0f)});
  Slide s{0, 0, 0};
  for (int i = 0; i < 90; ++i) {
    world.step(kStep);
    s.bump = std::max(s.bump, std::fabs(world.pose(b).position.y - rest_height));
  }
  const DVec3 v = wide(world.linear_velocity(b));
  const double speed = std::sqrt(64.0 + 1.7 * 1.7);
  s.speed_loss = std::fabs(length(v) - speed) / speed;
  s.heading = std::fabs(std::atan2(v.z, v.x) - std::atan2(1.7, 8.0));
  return s;
}
void expect_smooth(const char* name, const Slide& s, double bump = 3e-4) {
  say("[row] %s\n", name);
  EXPECT_TRUE(limit_row("  bump (m)", s.bump, bump, 2e-5)) << name;
  EXPECT_TRUE(limit_row("  loss of speed (relative)", s.speed_loss, 1e-3, 1e-5)) << name;
  EXPECT_TRUE(limit_row("  change of heading (rad)", s.heading, 1e-3, 1e-5)) << name;
}

struct Slider {
  const char* name;
  AnyShape shape;
  double height;
};
std::vector<Slider> sliders() {
  return {{"box", Box{{0.4f, 0.3f, 0.4f}}, 0.3},
          {"sphere", Sphere{0.3f}, 0.3},
          {"plate", Box{{0.4f, 0.05f, 0.4f}}, 0.05}};
}

TEST(Sliding, OverAMeshHasNoBumps) {
  for (const float cell : {1.0f, 0.25f, 0.37f}) {
    for (const Slider& s : sliders()) {
      World world = make_world({.sleeping = false});
      world.add_body({.type = BodyType::fixed},
                     {.geometry = floor_mesh(cell, int(24.0f / cell)), .material = surface(0.0f)});
      say("[row] A-160 cell %g\n", double(cell));
      expect_smooth(s.name, slide(std::move(world), s.shape, s.height));
    }
  }
}

// A floor of separate boxes, tops at y = 0 but for `step` on every other one.
World floor_of_boxes(const AnyShape& tile, double pitch, double half_height, double step = 0.0) {
  World world = make_world({.sleeping = false});
  const int n = int(14.0 / pitch);
  for (int i = -n; i <= n; ++i) {
    for (int k = -n; k <= n; ++k) {
      const double y = -half_height + ((i + k) % 2 == 0 ? step : 0.0);
      world.add_body({.type = BodyType::fixed, .pose = {.position = {pitch * i, y, pitch * k}}},
                     {.geometry = tile, .material = surface(0.0f)});
    }
  }
  return world;
}
std::vector<Slider> more_sliders() {
  std::vector<Slider> all = sliders();
  all.push_back({"small sphere", Sphere{0.1f}, 0.1});
  all.push_back({"capsule", Capsule{0.2f, 0.3f}, 0.5});
  all.push_back({"cylinder", Cylinder{0.3f, 0.2f}, 0.2});
  all.push_back({"rounded box", Box{{0.4f, 0.3f, 0.4f}, 0.1f}, 0.3});
  return all;
}

TEST(Sliding, OverFlushBoxesHasNoBumps) {
  std::vector<Vec3> corners;
  for (int i = 0; i < 8; ++i)
    corners.push_back({i & 1 ? 0.5f : -0.5f, i & 2 ? 0.5f : -0.5f, i & 4 ? 0.5f : -0.5f});
  const AnyShape hull = *cook_hull(corners);
  for (const Slider& s : more_sliders()) {
    say("[row] %s\n", "gap 3: flush boxes of 1 m, of 0.7 m, and hulls");
    expect_smooth(s.name, slide(floor_of_boxes(Box{}, 1.0, 0.5), s.shape, s.height));
    expect_smooth(s.name, slide(floor_of_boxes(Box{{0.35f, 0.35f, 0.35f}}, 0.7, 0.35), s.shape, s.height));
    expect_smooth(s.name, slide(floor_of_boxes(hull, 1.0, 0.5), s.shape, s.height));
  }
}

// At any angle to the seams, a corner of a tile that the slider does not touch yet comes towards one of its sides.
TEST(Sliding, TurnedAtRandomOverFlushBoxesHasNoBumps) {
  testing_random::Random random;
  double bump = 0.0, change = 0.0, lag = 0.0;
  for (int draw = 0; draw < 40; ++draw) {
    const float pitch = random.real(0.5f, 1.2f), speed = random.real(1.0f, 9.0f),
                heading = random.real(0.0f, 2.0f * kPi);
    const Vec3 half{random.real(0.1f, 0.5f), random.real(0.1f, 0.3f), random.real(0.1f, 0.5f)};
    World world = floor_of_boxes(Box{0.5f * Vec3{pitch, pitch, pitch}}, double(pitch), 0.5 * double(pitch));
    const Vec3 velocity{speed * std::cos(heading), 0, speed * std::sin(heading)};
    const DVec3 start{double(random.real(-0.5f, 0.5f)), double(half.y), double(random.real(-0.5f, 0.5f))};
    const BodyId b = world.add_body(
        {.pose = {start, from_axis_angle({0, 1, 0}, random.real(0.0f, kPi))}, .linear_velocity = velocity},
        {.geometry = Box{half}, .material = surface(0.0f)});
    for (int i = 0; i < 60; ++i) {
      world.step(kStep);
      bump = std::max(bump, std::fabs(world.pose(b).position.y - start.y));
    }
    const double path = 60.0 * double(kStep) * double(speed);
    change = std::max(change, double(length(world.linear_velocity(b) - velocity) / speed));
    lag =
        std::max(lag, length(world.pose(b).position - start - 60.0 * double(kStep) * wide(velocity)) / path);
  }
  EXPECT_TRUE(limit_row("turned boxes over tiles: bump (m)", bump, 1e-3, 2e-5));
  EXPECT_TRUE(limit_row("turned boxes over tiles: change of velocity (relative)", change, 1e-3, 1e-5));
  EXPECT_TRUE(limit_row("turned boxes over tiles: lag (share of the path)", lag, 1e-2, 1e-3));
}

// Boxes of one fixed body, side by side, are as flush as those of many.
TEST(Sliding, OverACompoundHasNoBumps) {
  for (const Slider& s : sliders()) {
    World world = make_world({.sleeping = false});
    std::vector<ShapeDef> tiles;
    for (int i = -12; i <= 12; ++i) {
      for (int k = -5; k <= 5; ++k)
        tiles.push_back({.geometry = Box{},
                         .local = {.position = {float(i), -0.5f, float(k)}},
                         .material = surface(0.0f)});
    }
    world.add_body({.type = BodyType::fixed}, tiles);
    expect_smooth(s.name, slide(std::move(world), s.shape, s.height));
  }
}

// A flat mesh over a rectangle, in two by two cells.
Geometry sheet(double low_x, double high_x, double low_z, double high_z) {
  std::vector<Vec3> v;
  std::vector<std::uint32_t> t;
  for (int z = 0; z < 3; ++z) {
    for (int x = 0; x < 3; ++x)
      v.push_back({float(low_x + 0.5 * (high_x - low_x) * x), 0, float(low_z + 0.5 * (high_z - low_z) * z)});
  }
  for (const std::uint32_t a : {0u, 1u, 3u, 4u}) t.insert(t.end(), {a, a + 4, a + 1, a, a + 3, a + 4});
  return *cook_mesh({.vertices = v, .indices = t});
}

enum class Ground { meshes, height_fields, meshes_and_boxes };
// Pieces of 3 m side by side, each a body of its own, their tops at y = 0.
World floor_of_pieces(Ground ground) {
  World world = make_world({.sleeping = false});
  const std::vector<float> level(25, 0.0f);
  for (int i = -3; i < 3; ++i) {
    for (int k = -2; k < 2; ++k) {
      const DVec3 middle{3.0 * i + 1.5, 0, 3.0 * k + 1.5};
      BodyDef body{.type = BodyType::fixed, .pose = {.position = middle}};
      ShapeDef piece{.geometry = sheet(-1.5, 1.5, -1.5, 1.5), .material = surface(0.0f)};
      if (ground == Ground::height_fields)
        piece.geometry = *cook_height_field({.heights = level, .columns = 5, .rows = 5, .spacing = 0.75f});
      if (ground == Ground::meshes_and_boxes && (i + k) % 2 == 0) {
        piece.geometry = Box{{1.5f, 0.5f, 1.5f}};
        body.pose.position.y = -0.5;
      }
      world.add_body(body, piece);
    }
  }
  return world;
}

// Meshes and height fields laid side by side are as flush as boxes: what slid from one to the next was thrown half a metre
// up. Thin rods too, which lie nearly along the seams. Round shapes still dip by up to a millimetre as they cross.
TEST(Sliding, OverFlushMeshesAndHeightFieldsHasNoBumps) {
  std::vector<Slider> all = more_sliders();
  for (const Ground ground : {Ground::meshes, Ground::height_fields, Ground::meshes_and_boxes}) {
    say("[row] gap 3: flush pieces, sort %d\n", int(ground));
    for (const Slider& s : all)
      expect_smooth(s.name, slide(floor_of_pieces(ground), s.shape, s.height), 1e-3);
  }
}
TEST(Sliding, OfThinRodsOverFlushPiecesHasNoBumps) {
  const Quat lying = from_axis_angle({0, 0, 1}, 0.5f * kPi);
  for (int sort = 0; sort < 4; ++sort) {
    for (const float turn : {0.0f, 0.7f, 1.57f}) {
      for (const AnyShape& rod : {AnyShape(Capsule{0.02f, 0.4f}), AnyShape(Cylinder{0.02f, 0.4f}),
                                  AnyShape(Box{{0.02f, 0.4f, 0.02f}})}) {
        World world = sort == 3 ? floor_of_boxes(Box{}, 1.0, 0.5) : floor_of_pieces(Ground(sort));
        const BodyId b = world.add_body({.pose = {.position = {-6.03, 0.02, -1.27},
                                                  .orientation = from_axis_angle({0, 1, 0}, turn) * lying},
                                         .linear_velocity = {8, 0, 1.7f}},
                                        {.geometry = rod, .material = surface(0.0f)});
        double bump = 0.0;
        for (int i = 0; i < 90; ++i) {
          world.step(kStep);
          bump = std::max(bump, std::fabs(world.pose(b).position.y - 0.02));
        }
        const DVec3 v = wide(world.linear_velocity(b));
        EXPECT_TRUE(limit_row("thin rods: bump (m)", bump, 1e-3, 2e-5)) << sort << " " << turn;
        EXPECT_TRUE(limit_row("thin rods: loss of speed",
                              std::fabs(length(v) / std::sqrt(64.0 + 1.7 * 1.7) - 1.0), 1e-3, 1e-5))
            << sort << " " << turn;
      }
    }
  }
}

// A wall that is a mesh stands on a floor that is one, and a piece lies higher than the rest: neither is hidden by the floor.
TEST(Sliding, IntoAMeshThatRisesStops) {
  for (const bool step : {false, true}) {
    for (const AnyShape& shape : {AnyShape(Sphere{0.3f}), AnyShape(Box{{0.3f, 0.3f, 0.3f}})}) {
      World world = make_world({.sleeping = false});
      world.add_body({.type = BodyType::fixed},
                     {.geometry = sheet(-6, step ? 0 : 6, -6, 6), .material = surface(0.0f)});
      // A block of mesh from x = 0 on, its top at 0.15 or 2 m.
      std::vector<Vec3> v;
      const float top = step ? 0.15f : 2.0f;
      for (int i = 0; i < 8; ++i)
        v.push_back({i & 1 ? 4.0f : 0.0f, i & 2 ? top : 0.0f, i & 4 ? 5.0f : -5.0f});
      const std::vector<std::uint32_t> t = {0, 4, 6, 0, 6, 2, 1, 3, 7, 1, 7, 5, 2, 6, 7, 2, 7, 3,
                                            0, 2, 3, 0, 3, 1, 4, 5, 7, 4, 7, 6, 0, 1, 5, 0, 5, 4};
      world.add_body({.type = BodyType::fixed},
                     {.geometry = *cook_mesh({.vertices = v, .indices = t}), .material = surface(0.0f)});
      const BodyId b = world.add_body({.pose = {.position = {-2, 0.3, 0.2}}, .linear_velocity = {1, 0, 0}},
                                      {.geometry = shape, .material = surface(0.0f)});
      double farthest = -10.0;
      for (int i = 0; i < 240; ++i) {
        world.step(kStep);
        farthest = std::max(farthest, world.pose(b).position.x);
      }
      EXPECT_LT(farthest, step ? -0.2 : -0.29) << step;
    }
  }
}

// Laid too high or low by a two-hundredth of what slides: no more than that is felt.
TEST(Sliding, OverBoxesAllButFlushIsNotThrown) {
  for (const Slider& s : sliders()) {
    const double step = 0.005 * s.height;
    const Slide slid = slide(floor_of_boxes(Box{}, 1.0, 0.5, -step), s.shape, s.height);
    EXPECT_LT(slid.bump, 2.0 * step) << s.name;
    EXPECT_LT(slid.speed_loss, 0.01) << s.name;
  }
}

// Along a wall of separate boxes, pressed against it.
TEST(Sliding, AlongAWallOfBoxesDoesNotCatch) {
  for (const AnyShape& shape :
       {AnyShape(Box{{0.3f, 0.3f, 0.3f}}), AnyShape(Sphere{0.3f}), AnyShape(Capsule{0.3f, 0.3f})}) {
    World world = make_world({.gravity = {0, 0, -9.81f}, .sleeping = false});
    for (int i = -12; i <= 12; ++i) {
      for (int k = -2; k <= 2; ++k)
        world.add_body({.type = BodyType::fixed, .pose = {.position = {double(i), double(k), -0.5}}},
                       {.geometry = Box{}, .material = surface(0.0f)});
    }
    const BodyId mover =
        world.add_body({.pose = {.position = {-6.03, 0.2, 0.3}}, .linear_velocity = {6, 0.3f, 0}},
                       {.geometry = shape, .material = surface(0.0f)});
    run(world, 1.5);
    EXPECT_NEAR(double(world.linear_velocity(mover).x), 6.0, 1e-3);
    EXPECT_NEAR(world.pose(mover).position.x, -6.03 + 9.0, 5e-3);
    EXPECT_NEAR(world.pose(mover).position.z, 0.3, 1e-3);
  }
}

// What is hidden at a seam must not be hidden in a corner: a wall on the floor stops what slides into it, also what reaches
// it with its lowest edge first.
TEST(Sliding, IntoACornerStopsAtTheWall) {
  for (const bool tiles : {false, true}) {
    for (const float lean : {0.0f, 0.3f, 0.7f, 1.2f}) {
      for (const float speed : {0.5f, 3.0f, 12.0f}) {
        World world = tiles ? floor_of_boxes(Box{}, 1.0, 0.5) : make_world({.sleeping = false});
        if (!tiles) add_ground(world, surface(0.0f));
        world.add_body({.type = BodyType::fixed, .pose = {.position = {2.5, 0.5, 0}}},
                       {.geometry = Box{{0.5f, 0.5f, 5}}, .material = surface(0.0f)});
        const double height = 0.02 * std::cos(double(lean)) + 0.5 * std::sin(double(lean));
        const BodyId rod = world.add_body(
            {.pose = {.position = {0, height, 0}, .orientation = from_axis_angle({0, 0, 1}, -lean)},
             .linear_velocity = {speed, 0, 0}},
            {.geometry = Box{{0.5f, 0.02f, 0.2f}}, .material = surface(0.0f)});
        double farthest = -10.0;
        for (int i = 0; i < 300; ++i) {
          world.step(kStep);
          const Pose pose = world.pose(rod);
          if (pose.position.y > 1.0) break;  // thrown over
          for (int c = 0; c < 4; ++c) {
            const DVec3 corner =
                pose.position + turned(pose.orientation, {c & 1 ? 0.5 : -0.5, c & 2 ? 0.02 : -0.02, 0});
            if (corner.y < 0.98) farthest = std::max(farthest, corner.x);
          }
        }
        EXPECT_LT(farthest, 2.01) << lean << " " << speed << " " << tiles;
      }
    }
  }
}

// Fast bodies over rough ground: sweeps leave them their way, and only bumps take their speed.
TEST(Continuous, DoesNotHoldWhatGoesOverRoughGround) {
  std::vector<float> heights(400 * 60);
  std::uint32_t random = 1;
  for (float& h : heights) {
    random = random * 1664525u + 1013904223u;
    h = 0.02f * (float(random >> 8) / 8388608.0f - 1.0f);
  }
  const Geometry ground =
      *cook_height_field({.heights = heights, .columns = 400, .rows = 60, .spacing = 0.25f});
  for (const AnyShape& shape :
       {AnyShape(Sphere{0.2f}), AnyShape(Box{{0.2f, 0.1f, 0.2f}}), AnyShape(Box{{0.2f, 0.02f, 0.2f}})}) {
    for (const float speed : {10.0f, 40.0f}) {
      World world = make_world({.sleeping = false});
      world.add_body({.type = BodyType::fixed}, {.geometry = ground, .material = surface(0.0f)});
      const BodyId body =
          world.add_body({.pose = {.position = {-45, 0.35, 0.1}}, .linear_velocity = {speed, 0, 0}},
                         {.geometry = shape, .material = surface(0.0f)});
      int held = 0;
      double last = -45.0;
      for (int i = 0; i < 90; ++i) {
        const double expected = double(world.linear_velocity(body).x) / 60.0;
        world.step(kStep);
        const double x = world.pose(body).position.x;
        // Where the speed is still there afterwards, the way should have been gone.
        const bool kept = double(world.linear_velocity(body).x) > 30.0 * expected;
        held += int(kept && x - last < 0.2 * expected);
        last = x;
      }
      EXPECT_TRUE(limit_row("steps of 90 over rough ground that were held", held, 4, 0)) << speed;
    }
  }
}

TEST(SleepTest, OnTwoTrianglesEndsInSleep) {
  World world = make_world();
  world.add_body({.type = BodyType::fixed}, {.geometry = floor_mesh(20.0f, 1)});
  Material rough = surface(0.6f);
  rough.rolling_friction = 1e-3f;
  const BodyId ball =
      world.add_body({.pose = {.position = {0.1, 0.5, 0}}, .linear_velocity = {0.05f, 0, 0.02f}},
                     {.geometry = Sphere{0.5f}, .material = rough});
  double fastest = 0.0;
  for (int i = 0; i < 600; ++i) {
    world.step(kStep);
    fastest = std::max(fastest, double(length(world.linear_velocity(ball))));
  }
  EXPECT_FALSE(world.is_awake(ball)) << "A-165";
  EXPECT_LT(fastest, 0.056) << "A-165: it never gains speed";
}

}  // namespace
}  // namespace gyre::laws::continuous_test
