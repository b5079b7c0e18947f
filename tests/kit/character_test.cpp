// Characters: what they climb and what they do not, what carries them, what they push, and that they keep still. Row B-33 of the
// validation table: spawned inside geometry, steep corners, moving platforms, zero motion.
#include <gyre/gyre.h>
#include <gyre/kit/character.h>
#include <gyre/replay.h>

#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <vector>

namespace gyre::kit::character_test {
namespace {

constexpr float kStep = 1.0f / 60.0f;
constexpr float kDegree = kPi / 180.0f;
constexpr double kGapAndABit = 2.0e-3;  // what is kept between a character and the world, and rounding

World make_world() { return std::move(*World::create({})); }

BodyId add_fixed(World& world, DVec3 place, const AnyShape& shape, Quat turn = {}) {
  return world.add_body({.type = BodyType::fixed, .pose = {place, turn}}, {.geometry = shape});
}
BodyId add_ground(World& world) { return add_fixed(world, {}, Plane{}); }

// Steps the world and the character for some seconds.
void traversal(World& world, const CharacterDef& def, CharacterState& state, Vec3 velocity, double seconds,
               const std::function<void()>& each = {}) {
  for (int i = 0; i < int(std::lround(seconds * 60)); ++i) {
    ASSERT_TRUE(world.step(kStep));
    ASSERT_EQ(move_character(world, def, state, {.velocity = velocity}, kStep).code, ErrorCode::none);
    if (each) each();
  }
}

CharacterState stand(World& world, const CharacterDef& def, DVec3 feet) {
  CharacterState state = make_character(def, feet);
  traversal(world, def, state, {}, 0.5);
  return state;
}

TEST(Character, FallsStandsAndWalksAtItsSpeed) {
  World world = make_world();
  add_ground(world);
  const CharacterDef def;
  CharacterState state = make_character(def, {0, 2, 0});
  traversal(world, def, state, {}, 0.2);
  EXPECT_EQ(state.ground, GroundKind::none);
  // Twelve kicks of gravity.
  EXPECT_NEAR(double(state.velocity.y), -9.81 * 0.2, 1e-3);
  traversal(world, def, state, {}, 1.0);
  EXPECT_EQ(state.ground, GroundKind::firm);
  EXPECT_NEAR(state.feet.y, 0.001, 1e-4);
  const DVec3 before = state.feet;
  traversal(world, def, state, {3, 0, -4}, 1.0);
  EXPECT_NEAR(state.feet.x - before.x, 3.0, 1e-4);
  EXPECT_NEAR(state.feet.z - before.z, -4.0, 1e-4);
}

// At rest nothing changes by a bit's worth of a hair: on a plane, a slope, in corners it leans into, on an edge.
TEST(Character, KeepsStill) {
  struct Case {
    const char* name;
    std::function<void(World&)> build;
    DVec3 feet;
    Vec3 direction;
  };
  const auto corner = [](World& world) {
    add_ground(world);
    add_fixed(world, {1, 1, 0}, Box{{0.5f, 2, 5}});
    add_fixed(world, {0, 1, 1}, Box{{5, 2, 0.5f}});
  };
  const auto sharp = [](World& world) {
    add_ground(world);
    add_fixed(world, {1, 1, 0.6}, Box{{3, 2, 0.2f}}, from_axis_angle({0, 1, 0}, 20 * kDegree));
    add_fixed(world, {1, 1, -0.6}, Box{{3, 2, 0.2f}}, from_axis_angle({0, 1, 0}, -20 * kDegree));
  };
  const Case cases[] = {
      {"plane", [](World& w) { add_ground(w); }, {0, 0.1, 0}, {}},
      {"slope",
       [](World& w) {
         add_fixed(w, {}, Plane{{0.5f, 0.8660254f, 0}, 0});
       },
       {0, 0.5, 0},
       {}},
      {"edge",
       [](World& w) {
         add_fixed(w, {0, -0.5, 0}, Box{{1, 0.5f, 1}});
       },
       {1.1, 0.1, 0},
       {}},
      {"corner", corner, {0, 0.1, 0}, {3, 0, 3}},
      {"corner, unevenly", corner, {0, 0.1, 0}, {4, 0, 1}},
      {"sharp corner", sharp, {-1.5, 0.1, 0}, {4, 0, 0.5f}},
      {"wall and steep slope",
       [&](World& w) {
         corner(w);
         add_fixed(w, {-1.2, 0, 0}, Box{{1, 1, 5}}, from_axis_angle({0, 0, 1}, -60 * kDegree));
       },
       {0, 0.1, 0},
       {-3, 0, 2}},
  };
  for (const Case& c : cases) {
    World world = make_world();
    c.build(world);
    const CharacterDef def;
    CharacterState state = make_character(def, c.feet);
    traversal(world, def, state, c.direction, 3.0);
    const DVec3 rest = state.feet;
    double most = 0;
    const GroundKind ground = state.ground;
    traversal(world, def, state, c.direction, 3.0, [&] {
      most = std::fmax(most, length(state.feet - rest));
      EXPECT_EQ(state.ground, ground) << c.name;
    });
    std::printf("[row] %-24s moves at rest by %.2e m\n", c.name, most);
    EXPECT_LT(most, 1.0e-5) << c.name;
  }
}

// A slope just below the limit is walked at the same speed seen from above; one just above it is not climbed at all.
TEST(Character, WalksSlopesUpToItsLimit) {
  for (const float limit : {30.0f, 50.0f}) {
    for (const float angle : {limit - 0.5f, limit + 0.5f}) {
      World world = make_world();
      add_ground(world);
      add_fixed(world, {0, 0, 0}, Plane{{-std::sin(angle * kDegree), std::cos(angle * kDegree), 0}, 0});
      const CharacterDef def{.max_slope = limit * kDegree};
      CharacterState state = stand(world, def, {-1, 0.01, 0});
      traversal(world, def, state, {2, 0, 0}, 3.0);
      if (angle < limit) {
        // Five metres on, less what the foot of the slope costs.
        EXPECT_NEAR(state.feet.x, 5.0, 0.2) << angle;
        EXPECT_NEAR(state.feet.y, state.feet.x * std::tan(double(angle * kDegree)), 0.3) << angle;
        EXPECT_EQ(state.ground, GroundKind::firm);
        const DVec3 rest = state.feet;
        traversal(world, def, state, {}, 1.0);
        EXPECT_NEAR(length(state.feet - rest), 0.0, 1e-5) << "and it stands there";
      } else {
        EXPECT_LT(state.feet.y, 0.05) << angle;
      }
      // Put onto the slope, it slides off the steep one.
      CharacterState put = make_character(def, {3, 3 * std::tan(double(angle * kDegree)) + 0.2, 0});
      traversal(world, def, put, {}, 2.0);
      EXPECT_EQ(put.feet.y<0.1, angle> limit) << angle;
    }
  }
}

double climbed(double ledge, const CharacterDef& def, float speed) {
  World world = make_world();
  add_ground(world);
  add_fixed(world, {3, ledge - 2, 0}, Box{{2, 2, 5}});
  CharacterState state = stand(world, def, {-0.5, 0.01, 0});
  traversal(world, def, state, {speed, 0, 0}, 2.5 / double(speed));
  return state.feet.y;
}

// Ledges up to step_up are climbed, whatever the speed, and those a centimetre higher are walls.
TEST(Character, ClimbsLedgesUpToItsStep) {
  for (const float up : {0.2f, 0.35f, 0.5f}) {
    const CharacterDef def{.step_up = up};
    for (const float speed : {0.5f, 2.0f, 6.0f}) {
      for (const double ledge : {0.05, 0.6 * double(up), double(up) - 0.005}) {
        EXPECT_NEAR(climbed(ledge, def, speed), ledge, kGapAndABit) << up << " " << speed;
      }
      for (const double ledge : {double(up) + 0.01, double(up) + 0.1}) {
        EXPECT_LT(climbed(ledge, def, speed), 0.02) << up << " " << speed << " " << ledge;
      }
    }
  }
  // Without steps even what the round foot could roll over is a wall.
  EXPECT_LT(climbed(0.2, {.step_up = 0.0f}, 2.0f), 0.02);
}

// Up and down a flight of stairs at a steady pace, and the feet never leave them.
TEST(Character, WalksStairsBothWays) {
  World world = make_world();
  add_ground(world);
  for (int i = 0; i < 10; ++i) add_fixed(world, {1.0 + 0.3 * i + 5, 0.2 * (i + 1) - 2, 0}, Box{{5, 2, 2}});
  const CharacterDef def;
  CharacterState state = stand(world, def, {0, 0.01, 0});
  traversal(world, def, state, {2, 0, 0}, 3.0,
            [&] { EXPECT_EQ(state.ground, GroundKind::firm) << state.feet.x; });
  EXPECT_NEAR(state.feet.y, 2.0, kGapAndABit);
  EXPECT_GT(state.feet.x, 5.0);
  traversal(world, def, state, {-2, 0, 0}, 3.0,
            [&] { EXPECT_EQ(state.ground, GroundKind::firm) << state.feet.x; });
  EXPECT_NEAR(state.feet.y, 0.0, kGapAndABit);
  std::printf("[row] way lost on ten stairs of 0.3 m %.3f m of 12\n", -state.feet.x);
  EXPECT_NEAR(state.feet.x, 0.0, 0.1);
}

// Feet follow ground that falls away by step_down, and leave it where it falls deeper.
TEST(Character, StepsDownUpToItsLimit) {
  for (const double drop : {0.30, 0.40}) {
    World world = make_world();
    add_ground(world);
    add_fixed(world, {-5, drop - 2, 0}, Box{{5, 2, 5}});
    const CharacterDef def{.step_down = 0.35f};
    CharacterState state = stand(world, def, {-1, drop + 0.01, 0});
    bool flew = false;
    traversal(world, def, state, {6, 0, 0}, 0.6, [&] { flew = flew || state.ground == GroundKind::none; });
    EXPECT_EQ(flew, drop > 0.35) << drop;
  }
}

// A wall of separate boxes, flush: walked along while pushed against, the speed along it stays what it is.
TEST(Character, DoesNotCatchOnWallsOfBoxes) {
  World world = make_world();
  for (int i = -2; i < 24; ++i) {
    add_fixed(world, {0.5 * i, 1.5, 1.0}, Box{{0.25f, 1.5f, 0.25f}});
    for (int k = -3; k < 3; ++k) add_fixed(world, {0.5 * i, -0.25, 0.5 * k}, Box{{0.25f, 0.25f, 0.25f}});
  }
  const CharacterDef def;
  CharacterState state = stand(world, def, {0, 0.02, 0.2});
  traversal(world, def, state, {3, 0, 1}, 0.5);
  double last = state.feet.x, slowest = 1;
  traversal(world, def, state, {3, 0, 1}, 2.5, [&] {
    slowest = std::fmin(slowest, state.feet.x - last);
    last = state.feet.x;
    EXPECT_EQ(state.ground, GroundKind::firm);
  });
  std::printf("[row] slowest step along a wall of boxes %.6f m of %.6f\n", slowest, 0.05);
  EXPECT_GT(slowest, 0.0499);
  EXPECT_NEAR(state.feet.z, 0.45, 0.005);
}

// Exactly where the platform takes it: on one that slides, one that turns, one that rises and sinks.
TEST(Character, PlatformsCarryItExactly) {
  World world = make_world();
  const BodyId platform = world.add_body({.type = BodyType::kinematic, .pose = {{0, -0.5, 0}, {}}},
                                         {.geometry = Box{{4, 0.5f, 4}}});
  const CharacterDef def;
  CharacterState state = stand(world, def, {1.5, 0.01, 0.5});
  const Vec3 spot = inverse_times(world.pose(platform), state.feet);
  double most = 0, turned = 0;
  for (int i = 0; i < 600; ++i) {
    const double t = i / 60.0;
    const Pose pose{{3 * std::sin(t), -0.5 + 0.8 * std::sin(1.7 * t), 2 * std::sin(0.6 * t)},
                    from_axis_angle({0, 1, 0}, float(0.9 * t))};
    ASSERT_TRUE(world.move_kinematic(platform, pose, kStep));
    ASSERT_TRUE(world.step(kStep));
    ASSERT_EQ(move_character(world, def, state, {}, kStep).code, ErrorCode::none);
    turned += double(state.ground_rotation);
    most = std::fmax(most, double(length(inverse_times(world.pose(platform), state.feet) - spot)));
    EXPECT_EQ(state.ground_body, platform);
  }
  std::printf("[row] slip on a moving platform in 10 s %.2e m\n", most);
  EXPECT_LT(most, 1.0e-4);
  EXPECT_NEAR(turned, 0.9 * 599 / 60.0, 1e-3);
}

// Jumping off a platform takes its speed along; a jump's height is v^2 / 2g.
TEST(Character, JumpsAndTakesTheSpeedAlong) {
  World world = make_world();
  add_ground(world);
  const BodyId cart = world.add_body({.type = BodyType::kinematic, .pose = {{0, 0.5, 0}, {}}},
                                     {.geometry = Box{{3, 0.5f, 3}}});
  const CharacterDef def{.air_acceleration = 0};
  CharacterState state = stand(world, def, {0, 1.01, 0});
  world.set_velocity(cart, {2, 0, 0}, {});
  traversal(world, def, state, {}, 0.5);
  world.step(kStep);
  move_character(world, def, state, {.jump_speed = 4}, kStep);
  double top = 0;
  traversal(world, def, state, {}, 0.6, [&] { top = std::fmax(top, state.feet.y); });
  EXPECT_NEAR(double(state.velocity.x), 2.0, 1e-3);
  // Steps of 1/60 s: v dt / 2 of the parabola.
  EXPECT_NEAR(top - 1.0, 16 / (2 * 9.81), 4.0 / 60);
}

TEST(Character, PlatformsPushItAside) {
  World world = make_world();
  add_ground(world);
  const BodyId wall =
      world.add_body({.type = BodyType::kinematic, .pose = {{3, 1, 0}, {}}}, {.geometry = Box{{0.5f, 1, 3}}});
  const CharacterDef def;
  CharacterState state = stand(world, def, {0, 0.01, 0});
  world.set_velocity(wall, {-2, 0, 0}, {});
  traversal(world, def, state, {}, 3.0);
  // The wall's face has come to -3.5.
  EXPECT_NEAR(state.feet.x, -3.5 - 0.3, 0.05);
  EXPECT_FALSE(state.stuck);
}

TEST(Character, PushesWhatItCanAndStopsAtWhatItCannot) {
  const auto pushed = [](float density, float force) {
    World world = make_world();
    add_ground(world);
    const BodyId crate = world.add_body({.pose = {{2, 0.5, 0}, {}}},
                                        {.geometry = Box{{0.5f, 0.5f, 0.5f}}, .density = density});
    const CharacterDef def{.push_force = force};
    CharacterState state = stand(world, def, {0, 0.01, 0});
    traversal(world, def, state, {2, 0, 0}, 3.0);
    EXPECT_LT(state.feet.x, world.pose(crate).position.x - 0.5 - 0.28) << "it never walks into the crate";
    return world.pose(crate).position.x - 2.0;
  };
  // Friction 0.6 holds 0.6 m g: 59 N of 10 kg, 1,177 N of 200 kg.
  EXPECT_GT(pushed(10, 400), 2.0);
  EXPECT_LT(pushed(200, 400), 0.05);
  EXPECT_LT(pushed(10, 0), 0.01);
  // And it weighs on what it stands on: a balanced board tips.
  World world = make_world();
  add_ground(world);
  add_fixed(world, {0, 0.25, 0}, Box{{0.05f, 0.25f, 1}});
  const BodyId board =
      world.add_body({.pose = {{0, 0.55, 0}, {}}}, {.geometry = Box{{1.5f, 0.05f, 0.5f}}, .density = 200});
  const CharacterDef def;
  CharacterState state = make_character(def, {1, 0.62, 0});
  traversal(world, def, state, {}, 1.0);
  EXPECT_LT(rotate(world.pose(board).orientation, {1, 0, 0}).y, -0.05f);
}

TEST(Character, CrouchesUnderWhatIsLowAndStandsUpWhereThereIsRoom) {
  World world = make_world();
  add_ground(world);
  add_fixed(world, {3, 2.3, 0}, Box{{1, 1, 2}});  // 1.3 m of head room from x = 2 to 4
  const CharacterDef def;
  CharacterState state = stand(world, def, {0, 0.01, 0});
  traversal(world, def, state, {2, 0, 0}, 2.0);
  EXPECT_NEAR(state.feet.x, 1.7, 0.02) << "the lintel stops who stands";
  ASSERT_TRUE(set_character_height(world, def, state, 1.2f));
  traversal(world, def, state, {2, 0, 0}, 0.6);
  EXPECT_GT(state.feet.x, 2.5);
  EXPECT_FALSE(set_character_height(world, def, state, def.height));
  EXPECT_EQ(state.height, 1.2f);
  traversal(world, def, state, {2, 0, 0}, 1.5);
  EXPECT_TRUE(set_character_height(world, def, state, def.height));
  EXPECT_FALSE(set_character_height(world, def, state, 0.3f)) << "lower than its two caps";
  // A jump under a ceiling ends there.
  World low = make_world();
  add_ground(low);
  add_fixed(low, {0, 3, 0}, Box{{5, 1, 5}});
  CharacterState jumper = stand(low, def, {0, 0.01, 0});
  low.step(kStep);
  move_character(low, def, jumper, {.jump_speed = 5}, kStep);
  double top = 0;
  traversal(low, def, jumper, {}, 1.0, [&] { top = std::fmax(top, jumper.feet.y + double(def.height)); });
  EXPECT_LT(top, 2.0);
  EXPECT_GT(top, 1.9);
  EXPECT_EQ(jumper.ground, GroundKind::firm);
}

TEST(Character, GetsOutOfWhatItWasPutInto) {
  const CharacterDef def;
  const auto out_of = [&](const std::function<void(World&)>& build, DVec3 feet) {
    World world = make_world();
    add_ground(world);
    build(world);
    CharacterState state = make_character(def, feet);
    traversal(world, def, state, {}, 2.0);
    EXPECT_FALSE(state.stuck);
    EXPECT_EQ(state.ground, GroundKind::firm);
    ShapePose place = character_shape(def, state);
    Penetration deep[4];
    const std::size_t count = world.penetration_all(place, deep);
    EXPECT_TRUE(count == 0 || deep[0].depth < 0.003f) << deep[0].depth;
    return state.feet;
  };
  EXPECT_NEAR(out_of([](World&) {}, {0, -0.5, 0}).y, 0.0, kGapAndABit);
  out_of([](World& w) { add_fixed(w, {0, 1, 0}, Box{{1, 1, 1}}); }, {0.6, 0.2, 0});
  out_of([](World& w) { add_fixed(w, {0, 1, 0}, Box{{1, 1, 1}}); }, {0, 0.5, 0});
  out_of(
      [](World& w) {
        add_fixed(w, {0.7, 1, 0}, Box{{0.5f, 1, 3}});
        add_fixed(w, {-0.7, 1, 0}, Box{{0.5f, 1, 3}});
      },
      {0, 0.1, 0});  // a gap of 0.4 m for one of 0.6 m
}

// A platform that holds from above only: jumped through from below, stood on, walked under.
TEST(Character, OneWayPlatformsHoldFromAbove) {
  World world = make_world();
  add_ground(world);
  world.add_body({.type = BodyType::fixed, .pose = {{0, 1.0, 0}, {}}},
                 {.geometry = Box{{1, 0.05f, 1}}, .filter = {.layer = 4}});
  const CharacterDef def{.one_way_layers = 4};
  CharacterState state = stand(world, def, {0, 0.01, 0});
  EXPECT_NEAR(state.feet.y, 0.001, kGapAndABit) << "it stands in it and does not mind";
  world.step(kStep);
  move_character(world, def, state, {.jump_speed = 6}, kStep);
  traversal(world, def, state, {}, 2.0);
  EXPECT_NEAR(state.feet.y, 1.05, kGapAndABit);
}

// Through a yard of tilted boxes, over a field of heights, wherever numbers lead: never inside of anything, never faster than asked.
TEST(Character, WandersWithoutEnteringAnything) {
  double deepest = 0, fastest = 0;
  for (std::uint32_t seed = 1; seed <= 6; ++seed) {
    std::uint32_t dice = seed * 2654435761u;
    const auto next = [&](double low, double high) {
      dice = dice * 1664525u + 1013904223u;
      return low + (high - low) * double(dice >> 8) / 16777216.0;
    };
    World world = make_world();
    std::vector<float> heights(41 * 41);
    for (float& h : heights) h = float(next(0, 0.25));
    const Result<Geometry> field = cook_height_field({heights, 41, 41, 0.5f});
    ASSERT_TRUE(bool(field));
    add_fixed(world, {}, *field);
    for (int i = 0; i < 40; ++i) {
      const Vec3 axis{float(next(-1, 1)), float(next(-1, 1)), float(next(-1, 1))};
      const DVec3 place{next(-9, 9), next(0, 0.8), next(-9, 9)};
      const Vec3 half{float(next(0.2, 1.5)), float(next(0.1, 1)), float(next(0.2, 1.5))};
      add_fixed(world, place, Box{half}, from_axis_angle(axis, float(next(0, 3))));
    }
    const CharacterDef def;
    CharacterState state = make_character(def, {0, 6, 0});
    Vec3 velocity{};
    for (int i = 0; i < 1800; ++i) {
      if (i % 40 == 0) {
        velocity = rotate(from_axis_angle({0, 1, 0}, float(next(0, 6.28))), {float(next(0, 5)), 0, 0});
        // Back to the middle from the rim.
        if (std::fabs(state.feet.x) > 6 || std::fabs(state.feet.z) > 6)
          velocity = {float(-0.4 * state.feet.x), 0, float(-0.4 * state.feet.z)};
      }
      world.step(kStep);
      const DVec3 before = state.feet;
      CharacterMove move{.velocity = velocity};
      if (i % 97 == 0) move.jump_speed = 4;
      ASSERT_EQ(move_character(world, def, state, move, kStep).code, ErrorCode::none);
      DVec3 way = state.feet - before;
      way.y = 0;
      if (i > 60) fastest = std::fmax(fastest, length(way) * 60);
      Penetration deep[1];
      if (world.penetration_all(character_shape(def, state), deep) > 0)
        deepest = std::fmax(deepest, double(deep[0].depth));
      ASSERT_FALSE(state.stuck) << "seed " << seed << " step " << i;
    }
    ASSERT_GT(state.feet.y, -0.1) << seed;
  }
  std::printf("[row] wandering: deepest overlap %.2e m, fastest %.3f m/s of 5\n", deepest, fastest);
  EXPECT_LT(deepest, 3.0e-3);
  // Sliding off steep ground adds some.
  EXPECT_LT(fastest, 12.0);
}

// A platform that sinks and slides away at once keeps who stands on it, wherever the two calls are in the frame.
TEST(Character, StaysOnAPlatformThatSinksSideways) {
  World world = make_world();
  const BodyId lift = world.add_body({.type = BodyType::kinematic, .pose = {{0, 9.5, 0}, {}}},
                                     {.geometry = Box{{2, 0.5f, 2}}});
  const CharacterDef def;
  CharacterState state = stand(world, def, {0.5, 10.01, 0});
  world.set_velocity(lift, {1.5f, -3, 0.5f}, {});
  const DVec3 spot = state.feet - world.pose(lift).position;
  double most = 0;
  traversal(world, def, state, {}, 2.5, [&] {
    most = std::fmax(most, length(state.feet - world.pose(lift).position - spot));
    EXPECT_EQ(state.ground, GroundKind::firm);
  });
  EXPECT_LT(most, 1.0e-5);
}

// The state is plain data: a copy of it and a snapshot of the world go the same way again, bit for bit; threads do not show.
TEST(Character, GoesTheSameWayAgain) {
  const auto run = [](World& world, const CharacterDef& def, CharacterState& state, int from, int to) {
    for (int i = from; i < to; ++i) {
      world.step(kStep);
      const float turn = 0.05f * float(i);
      CharacterMove move{.velocity = rotate(from_axis_angle({0, 1, 0}, turn), {3, 0, 0})};
      if (i % 50 == 20) move.jump_speed = 4;
      move_character(world, def, state, move, kStep);
    }
  };
  const auto build = [](World& world) {
    add_ground(world);
    for (int i = 0; i < 30; ++i) {
      world.add_body({.pose = {{-3 + 1.1 * (i % 6), 0.3, -3 + 1.2 * (i / 6)}, {}}},
                     {.geometry = Box{{0.3f, 0.3f, 0.3f}}, .density = 60});
    }
  };
  const CharacterDef def;
  World world = make_world();
  build(world);
  CharacterState state = make_character(def, {0, 1.2, 0});
  run(world, def, state, 0, 150);
  const std::vector<std::byte> bytes = save_snapshot(world);
  const CharacterState kept = state;
  run(world, def, state, 150, 300);
  Result<World> loaded = load_snapshot(bytes, {.threads = 3});
  ASSERT_TRUE(bool(loaded));
  World again = *std::move(loaded);
  CharacterState other = kept;
  // An id names its world: the same body there.
  if (other.ground_body) other.ground_body = again.bodies().ids[other.ground_body.index];
  run(again, def, other, 150, 300);
  EXPECT_EQ(state.feet, other.feet);
  EXPECT_EQ(state.velocity, other.velocity);
  EXPECT_EQ(world.hash(), again.hash());
}

TEST(Character, RefusesWhatCannotBe) {
  World world = make_world();
  CharacterDef def;
  CharacterState state = make_character(def, {});
  def.height = 0.2f;
  const Error e = move_character(world, def, state, {}, kStep);
  EXPECT_NE(std::string(e.message).find("height is 0.2"), std::string::npos) << e.message;
  EXPECT_EQ(move_character(world, {}, state, {.velocity = {NAN, 0, 0}}, kStep).code,
            ErrorCode::invalid_argument);
  EXPECT_EQ(move_character(world, {}, state, {}, 0).code, ErrorCode::invalid_argument);
}

// ------------------------------------------------------------------------------------------------------------ dynamic

TEST(CharacterBody, WalksStandsAndNeverFallsOver) {
  World world = make_world();
  add_ground(world);
  const CharacterDef def;
  const BodyId body = add_character_body(world, def, {0, 0.01, 0});
  const auto drive = [&](Vec3 velocity, double seconds) {
    for (int i = 0; i < int(seconds * 60); ++i) {
      ASSERT_EQ(drive_character_body(world, def, body, {.velocity = velocity}, kStep).code, ErrorCode::none);
      ASSERT_TRUE(world.step(kStep));
    }
  };
  drive({}, 0.5);
  drive({3, 0, 0}, 2.0);
  EXPECT_NEAR(double(world.linear_velocity(body).x), 3.0, 0.02);
  // From rest with grip 1: speed after a tenth of a second is at most g / 10.
  drive({}, 1.0);
  const double before = double(world.linear_velocity(body).x);
  drive({50, 0, 0}, 0.1);
  EXPECT_LE(double(world.linear_velocity(body).x) - before, 0.981 * 1.02);
  EXPECT_GE(double(world.linear_velocity(body).x) - before, 0.981 * 0.9);
  EXPECT_NEAR(double(rotate(world.pose(body).orientation, {0, 1, 0}).y), 1.0, 1e-6);
}

// It stands on slopes that its grip holds (tan a < 1), and slides on steeper ones.
TEST(CharacterBody, GripHoldsItOnSlopes) {
  for (const float angle : {30.0f, 44.0f, 49.0f}) {
    World world = make_world();
    add_fixed(world, {}, Plane{{-std::sin(angle * kDegree), std::cos(angle * kDegree), 0}, 0});
    const CharacterDef def;
    const float off = 0.3f / std::cos(angle * kDegree) - 0.3f;
    const BodyId body = add_character_body(world, def, {0, double(off), 0});
    for (int i = 0; i < 180; ++i) {
      drive_character_body(world, def, body, {}, kStep);
      world.step(kStep);
    }
    const double way = length(world.pose(body).position - DVec3{0, 0.9 + double(off), 0});
    if (angle < 45) {
      EXPECT_LT(way, 0.03) << angle;
    } else {
      EXPECT_GT(way, 0.2) << angle;
    }
  }
}

// What it pushes itself off from goes the other way: momentum stays.
TEST(CharacterBody, PushesTheGroundBack) {
  World world = make_world();
  add_fixed(world, {0, -0.01, 0}, Plane{});
  ShapeDef slab{.geometry = Box{{3, 0.1f, 1}}, .density = 500};
  slab.material.static_friction = slab.material.dynamic_friction = 0;
  const BodyId raft = world.add_body({.pose = {{0, 0.1, 0}, {}}}, slab);
  const CharacterDef def;
  const BodyId body = add_character_body(world, def, {0, 0.2, 0});
  for (int i = 0; i < 60; ++i) {
    drive_character_body(world, def, body, {.velocity = {i < 20 ? 0.0f : 1.0f, 0, 0}}, kStep);
    world.step(kStep);
  }
  const double p = double(world.mass_properties(body).mass * world.linear_velocity(body).x);
  const double q = double(world.mass_properties(raft).mass * world.linear_velocity(raft).x);
  EXPECT_GT(p, 40.0);
  EXPECT_NEAR(p + q, 0.0, 0.02 * p);
}

TEST(CharacterBody, JumpsFromWhereItStandsOnly) {
  World world = make_world();
  add_ground(world);
  const CharacterDef def;
  const BodyId body = add_character_body(world, def, {0, 0.01, 0});
  double top = 0;
  for (int i = 0; i < 120; ++i) {
    drive_character_body(world, def, body, {.jump_speed = i == 30 || i == 45 ? 4.0f : 0.0f}, kStep);
    world.step(kStep);
    top = std::fmax(top, world.pose(body).position.y - 0.9);
  }
  EXPECT_NEAR(top, 16 / (2 * 9.81), 0.05) << "the second jump, in the air, gave nothing";
}

}  // namespace
}  // namespace gyre::kit::character_test
