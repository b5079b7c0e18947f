// Supports that turn: what lies on a turntable, on the floor of a station that turns, or in a drum goes round with it.
// Source: a body in co-rotation needs the acceleration w^2 r towards the axis, which friction or the floor gives.
#include "laws/kit.h"
#include "random.h"

namespace gyre::laws::turning_test {
namespace {

using testing_random::Random;

// The position in the frame of a carrier.
DVec3 seen_from(const Pose& carrier, const Pose& body) {
  const DQuat back = conjugate(normalized(to_double(carrier.orientation)));
  return rotate(back, body.position - carrier.position);
}

// Speed of a rider against its table over `seconds`, m/s: a box or a hull, at 30 % of the grip.
double slip_on_table(Random& random, BodyType type, double seconds) {
  const float size = 0.01f * std::pow(300.0f, random.real(0, 1)), friction = random.real(0.2f, 1.0f);
  const float radius = size * random.real(3.0f, 30.0f), rate = std::sqrt(0.3f * friction * 9.81f / radius);
  World world = make_world({.sleeping = false});
  const Material rough = surface(friction);
  const Vec3 half{radius + 4.0f * size, 0.5f * size, radius + 4.0f * size};
  const BodyId table = world.add_body({.type = type,
                                       .pose = {{0, -0.5 * double(size), 0}, {}},
                                       .angular_velocity = {0, rate, 0},
                                       .mass = 1.0e4f * size * size * size},
                                      {.geometry = Box{half}, .material = rough});
  // A dynamic one turns on smooth ground.
  if (type == BodyType::dynamic)
    world.add_body({.type = BodyType::fixed, .pose = {{0, -1.5 * double(size), 0}, {}}},
                   {.geometry = Box{{3.0f * half.x, 0.5f * size, 3.0f * half.x}}, .material = surface(0.0f)});
  const Vec3 sides{random.real(0.5f, 1.0f) * size, random.real(0.3f, 0.6f) * size,
                   random.real(0.5f, 1.0f) * size};
  const float mass = 2.0f * size * size * size;
  const BodyId rider = world.add_body(
      {.pose = {{double(radius), double(sides.y), 0}, from_axis_angle({0, 1, 0}, random.real(-3, 3))},
       .linear_velocity = {0, 0, -rate * radius},
       .angular_velocity = {0, rate, 0},
       .mass = mass},
      {.geometry = Box{sides}, .material = rough});
  run(world, 0.5);
  const DVec3 begin = seen_from(world.pose(table), world.pose(rider));
  run(world, seconds);
  return length(seen_from(world.pose(table), world.pose(rider)) - begin) / seconds;
}

TEST(TurningSupport, RidersOfATableStayWhereTheyAre) {
  Random random;
  for (const BodyType type : {BodyType::kinematic, BodyType::dynamic}) {
    double worst = 0.0;
    for (int i = 0; i < 20; ++i) worst = std::max(worst, slip_on_table(random, type, 4.0));
    EXPECT_TRUE(limit_row(type == BodyType::kinematic ? "slip on a kinematic turntable (m/s)"
                                                      : "slip on a dynamic turntable (m/s)",
                          worst, 1e-4, 1e-5));
  }
}

// The top of a stack on the floor of a station, against where it stood, in half sides of a box.
double shift_in_station(Random& random, double seconds) {
  const double radius = 10.0 * std::pow(100.0, double(random.real(0, 1))), rate = std::sqrt(9.81 / radius);
  const int count = 3 + int(7.99f * random.real(0, 1));
  const float half = random.real(0.1f, 0.5f);
  World world = make_world({.gravity = {0, 0, 0}, .sleeping = false});
  const BodyId station =
      world.add_body({.type = BodyType::kinematic, .angular_velocity = {0, 0, float(rate)}},
                     {.geometry = Box{{6.0f * half, 0.5f, 6.0f * half}},
                      .local = {.position = {0, float(-radius) - 0.5f, 0}}});
  BodyId top;
  for (int i = 0; i < count; ++i) {
    const double height = double(half) * (1.0 + 2.0 * i);
    top = world.add_body({.pose = {{0, height - radius, 0}, {}},
                          .linear_velocity = {float(rate * (radius - height)), 0, 0},
                          .angular_velocity = {0, 0, float(rate)}},
                         {.geometry = Box{{half, half, half}}});
  }
  const DVec3 begin = seen_from(world.pose(station), world.pose(top));
  run(world, seconds);
  return length(seen_from(world.pose(station), world.pose(top)) - begin) / double(half);
}

TEST(TurningSupport, StacksInATurningStationStand) {
  Random random;
  double worst = 0.0;
  for (int i = 0; i < 12; ++i) worst = std::max(worst, shift_in_station(random, 10.0));
  EXPECT_TRUE(limit_row("shift of the top of a stack in a station in 10 s (half sides)", worst, 0.05, 0.01));
}
TEST(LongTurningSupport, StacksInATurningStationStandForAMinute) {
  Random random;
  double worst = 0.0;
  for (int i = 0; i < 12; ++i) worst = std::max(worst, shift_in_station(random, 60.0));
  EXPECT_TRUE(limit_row("shift of the top of a stack in a station in 60 s (half sides)", worst, 0.2, 0.05));
}

// A drum of twelve boards about a horizontal axis, with balls and boxes in it: none gets out.
TEST(TurningSupport, NothingLeavesADrum) {
  Random random;
  int outside = 0;
  for (int draw = 0; draw < 3; ++draw) {
    const float radius = random.real(0.5f, 2.0f), rate = random.real(1.0f, 8.0f);
    World world = make_world({.sleeping = false});
    std::vector<ShapeDef> boards;
    for (int i = 0; i < 12; ++i) {
      const Quat turn = from_axis_angle({0, 0, 1}, float(i) * kPi / 6.0f);
      boards.push_back({.geometry = Box{{0.3f * radius, 0.02f, 0.5f * radius}},
                        .local = {.position = rotate(turn, Vec3{0, -radius, 0}), .orientation = turn}});
    }
    for (const float side : {-1.0f, 1.0f})
      boards.push_back(
          {.geometry = Box{{radius, radius, 0.05f}}, .local = {.position = {0, 0, 0.55f * radius * side}}});
    world.add_body({.type = BodyType::kinematic, .angular_velocity = {0, 0, rate}}, boards);
    std::vector<BodyId> load;
    for (int i = 0; i < 30; ++i) {
      const float size = radius * random.real(0.04f, 0.08f);
      const AnyShape shape = i % 2 == 0 ? AnyShape(Sphere{size}) : AnyShape(Box{{size, 0.7f * size, size}});
      load.push_back(
          world.add_body({.pose = {DVec3(0.4f * radius * random.vector(-1, 1)), {}}}, {.geometry = shape}));
    }
    run(world, 6.0);
    for (const BodyId body : load) {
      const DVec3 at = world.pose(body).position;
      outside += std::hypot(at.x, at.y) > double(radius) || std::fabs(at.z) > 0.6 * double(radius) ? 1 : 0;
    }
  }
  EXPECT_TRUE(limit_row("bodies that left a drum", outside, 0, 0));
}

}  // namespace
}  // namespace gyre::laws::turning_test
