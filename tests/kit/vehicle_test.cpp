// Wheeled vehicles against what is known of them: weight on springs, acceleration in a gear, braking, the bicycle model's understeer.
#include <gyre/gyre.h>
#include <gyre/kit/vehicle.h>
#include <gyre/replay.h>

#include <gtest/gtest.h>

#include <cmath>
#include <random>

namespace gyre::kit::vehicle_test {
namespace {

constexpr float kStep = 1.0f / 60.0f;
constexpr double kGravity = 9.81;

// 1,500 kg on a wheelbase of 2.6 m, the centre of mass 0.1 m before its middle and as low as the wheels' middles.
struct Car {
  VehicleDef def;
  BodyId body;
  VehicleState state;
};
constexpr double kMass = 1500, kFront = 1.2, kRear = 1.4, kTrack = 1.5, kRadius = 0.33;

// What wheels are put to: its mass, principal moments, and a box whose middle is `up` above its origin.
struct Hull {
  DVec3 place;
  float mass;
  Vec3 moments;
  Vec3 half;
  float up;
  Vec3 center{};
};
BodyId add_hull(World& world, const Hull& hull) {
  BodyDef body;
  body.pose.position = hull.place;
  body.mass = hull.mass;
  body.center_of_mass = hull.center;
  body.inertia = Sym3{hull.moments.x, hull.moments.y, hull.moments.z, 0, 0, 0};
  ShapeDef shape;
  shape.geometry = Box{hull.half};
  shape.local.position = {0, hull.up, 0};
  return world.add_body(body, shape);
}

Car make_car(World& world, DVec3 place = {0, 0.6, 0}) {
  Car car;
  car.body =
      add_hull(world, {place, float(kMass), {2500, 2700, 600}, {0.8f, 0.2f, 2.0f}, 0.25f, {0, -0.1f, 0}});
  for (const bool front : {true, false}) {
    for (const float side : {1.0f, -1.0f}) {
      WheelDef wheel;
      // x is to the left of z.
      wheel.mount = {side * float(kTrack / 2), -0.2f, front ? float(kFront) : -float(kRear)};
      wheel.radius = float(kRadius);
      wheel.steer = front ? 1.0f : 0.0f;
      wheel.drive = front ? 0.0f : 0.5f;
      wheel.handbrake = front ? 0.0f : 3000.0f;
      car.def.wheels.push_back(wheel);
    }
  }
  car.def.axles = {{0, 1, 8000, 0}, {2, 3, 6000, 0}};
  return car;
}

// Eight tonnes on ten road wheels in two tracks.
Car make_tank(World& world, double height = 0.9) {
  Car tank{{}, add_hull(world, {{0, height, 0}, 8000, {20000, 25000, 9000}, {1.2f, 0.3f, 2.4f}, 0.3f}), {}};
  tank.def.tracks = {{{}, 1.0f, 30000}, {{}, -1.0f, 30000}};
  for (int i = 0; i < 10; ++i) {
    WheelDef wheel;
    wheel.mount = {i % 2 == 0 ? 1.2f : -1.2f, -0.2f, 1.8f - 0.9f * float(i / 2)};
    wheel.stiffness = 60000;
    wheel.damping = 8000;
    wheel.drive = 0.1f;
    wheel.tyre.rolling = 0;
    tank.def.tracks[std::size_t(i % 2)].wheels.push_back(int(tank.def.wheels.size()));
    tank.def.wheels.push_back(wheel);
  }
  tank.def.engine = {.curve = {{0, 800}}, .redline = 1000, .inertia = 1.0f, .braking = 0};
  tank.def.gearbox = {
      .ratios = {3.0f}, .final_ratio = 4.0f, .clutch = 5000, .shift_time = 0, .automatic = false};
  return tank;
}

// A motorcycle of 250 kg: two wheels in line.
Car make_bike(World& world, double height = 0.75) {
  Car bike{{}, add_hull(world, {{0, height, 0}, 250, {45, 40, 12}, {0.15f, 0.25f, 0.6f}, 0.1f}), {}};
  for (const bool front : {true, false}) {
    WheelDef wheel;
    wheel.mount = {0, -0.35f, front ? 0.7f : -0.7f};
    wheel.radius = 0.3f;
    wheel.inertia = 0.5f;
    wheel.travel = 0.15f;
    wheel.stiffness = 16000;
    wheel.damping = 1500;
    wheel.steer = front ? 1.0f : 0.0f;
    wheel.drive = front ? 0.0f : 1.0f;
    wheel.tyre.grip = 1.3f;
    wheel.tyre.rolling = 0;
    bike.def.wheels.push_back(wheel);
  }
  bike.def.lean.frequency = 2.0f;
  return bike;
}

void drive(World& world, Car& car, const VehicleInput& input, double seconds) {
  for (int i = 0; i < int(std::lround(seconds * 60)); ++i) {
    const Error e = drive_vehicle(world, car.def, car.body, car.state, input, kStep);
    ASSERT_EQ(e.code, ErrorCode::none) << e.message;
    ASSERT_TRUE(world.step(kStep));
  }
}

World make_road() {
  World world = *World::create({});
  world.add_body({.type = BodyType::fixed}, {.geometry = Plane{}});
  return world;
}

struct SinCos {
  float sin, cos;
};
SinCos sin_cos_of(double angle) { return {float(std::sin(angle)), float(std::cos(angle))}; }

double forward_speed(const World& world, const Car& car) {
  return double(dot(world.linear_velocity(car.body), rotate(world.pose(car.body).orientation, {0, 0, 1})));
}

bool relative_row(const char* name, double measured, double expected, double good) {
  const double error = std::fabs(measured / expected - 1);
  std::printf("[row] %-44s %10.5g expected %10.5g  error %8.1e  good %8.1e\n", name, measured, expected,
              error, good);
  return error <= good;
}

TEST(Vehicle, StandsOnItsSprings) {
  World world = make_road();
  Car car = make_car(world);
  drive(world, car, {.gear = 0}, 5.0);
  double load = 0;
  for (int i = 0; i < 4; ++i) load += double(car.state.wheels[i].load);
  EXPECT_TRUE(relative_row("load of four wheels, N", load, kMass * kGravity, 1e-3));
  EXPECT_TRUE(relative_row("load of the front axle",
                           double(car.state.wheels[0].load + car.state.wheels[1].load),
                           kMass * kGravity * kRear / (kFront + kRear), 5e-3));
  EXPECT_TRUE(relative_row("compression in front, m", double(car.state.wheels[0].compression),
                           kMass * kGravity * kRear / (kFront + kRear) / 2 / 30000, 5e-3));
  EXPECT_LT(length(world.linear_velocity(car.body)), 2e-3f);
}

// In one gear, without slip to speak of: the engine's torque at the wheels moves the mass and all that turns with it.
// A slope turned about any horizontal axis, so that the car stands up, down or across it.
TEST(Vehicle, StaysWhereItIsBrakedOnASlope) {
  std::mt19937 random(5);
  std::uniform_real_distribution<float> draw(0, 1);
  for (int trial = 0; trial < 8; ++trial) {
    World world = *World::create({});
    const float slope = 0.35f * draw(random), heading = 6.28f * draw(random);
    const Quat turn = from_axis_angle({std::cos(heading), 0, std::sin(heading)}, slope);
    const BodyId ground =
        world.add_body({.type = BodyType::fixed, .pose = {.orientation = turn}}, {.geometry = Plane{}});
    Car car = make_car(world);
    for (WheelDef& wheel : car.def.wheels) wheel.brake = 3000;
    const Pose before = world.pose(car.body);
    world.set_pose(car.body, {DVec3(rotate(turn, to_float(before.position))), turn * before.orientation});
    const VehicleInput braked{.brake = 1, .gear = 0};
    drive(world, car, braked, 5.0);
    const DVec3 from = world.pose(car.body).position;
    EXPECT_FALSE(world.is_awake(car.body)) << "slope of " << slope << " rad";
    world.set_awake(car.body, true);
    drive(world, car, braked, 20.0);
    EXPECT_LT(length(world.pose(car.body).position - from), 1e-4) << "slope of " << slope << " rad";
    // It rolls when the brakes are off, unless it stands across the slope, and falls when the ground goes.
    if (trial % 2 == 0) {
      drive(world, car, {.gear = 0}, 2.0);
      const double along = double(slope) * std::fabs(std::cos(double(heading)));
      if (along > 0.05) {
        EXPECT_GT(length(world.pose(car.body).position - from), 0.5);
      }
    } else {
      world.remove_body(ground);
      drive(world, car, braked, 0.5);
      EXPECT_GT(length(world.pose(car.body).position - from), 0.5);
    }
    EXPECT_TRUE(world.is_awake(car.body));
  }
}

// With sleep off the tyres still hold it; a push beyond their grip moves it.
TEST(Vehicle, StandsOnASlopeWithoutSleep) {
  World world = *World::create({.sleeping = false});
  const Quat turn = from_axis_angle({1, 0, 0}, -0.25f);
  world.add_body({.type = BodyType::fixed, .pose = {.orientation = turn}}, {.geometry = Plane{}});
  Car car = make_car(world);
  for (WheelDef& wheel : car.def.wheels) wheel.brake = 3000;
  world.set_pose(car.body, {DVec3(rotate(turn, to_float(world.pose(car.body).position))), turn});
  const VehicleInput braked{.brake = 1, .gear = 0};
  drive(world, car, braked, 5.0);
  const DVec3 from = world.pose(car.body).position;
  drive(world, car, braked, 30.0);
  EXPECT_TRUE(world.is_awake(car.body));
  EXPECT_LT(length(world.pose(car.body).position - from), 1e-3);
  for (int i = 0; i < 60; ++i) {
    world.add_force(car.body, {float(1.5 * kMass * kGravity), 0, 0});
    drive(world, car, braked, 1.0 / 60);
  }
  EXPECT_GT(world.pose(car.body).position.x - from.x, 0.5);
}

TEST(Vehicle, AcceleratesAsItsGearSays) {
  World world = make_road();
  Car car = make_car(world);
  car.def.engine = {.curve = {{0, 200}}, .redline = 1000, .inertia = 0.2f, .braking = 0};
  car.def.gearbox = {
      .ratios = {2.0f}, .final_ratio = 4.0f, .clutch = 2000, .shift_time = 0, .automatic = false};
  for (WheelDef& wheel : car.def.wheels) wheel.tyre.rolling = 0.0f;
  drive(world, car, {.gear = 1}, 3.0);
  drive(world, car, {.throttle = 1, .gear = 1}, 2.0);
  const double before = forward_speed(world, car);
  drive(world, car, {.throttle = 1, .gear = 1}, 2.0);
  const double gear = 8.0, r = kRadius;
  const double moved = kMass + 4 * 1.0 / (r * r) + 0.2 * gear * gear / (r * r);
  EXPECT_TRUE(relative_row("acceleration in gear, m/s^2", (forward_speed(world, car) - before) / 2,
                           200 * gear / r / moved, 2e-2));
}

// Force over load against slip, along, across and both at once: 2 s / (1 + s^2) of the grip up to the peak, then falling to `slide`.
TEST(Vehicle, TyresPullAsTheirCurvesSay) {
  const float speed = 20.0f;
  double worst = 0.0;
  for (const double along : {-1.5, -0.5, 0.0, 0.25, 1.0, 4.0}) {     // of the slip at the peak
    for (const double across : {-3.0, -0.25, 0.0, 0.5, 1.0, 2.0}) {  // of the angle at the peak
      World world = make_road();
      Car car = make_car(world);
      for (WheelDef& wheel : car.def.wheels) {
        wheel.inertia = 1.0e6f;  // what the tyre does to its wheel must not change the slip
        wheel.drive = 0.0f;
        wheel.tyre = {.grip = 0.9f, .slide = 0.7f, .peak_slip = 0.1f, .peak_angle = 0.12f, .rolling = 0};
      }
      drive(world, car, {.gear = 0}, 2.0);
      const SinCos drift = sin_cos_of(0.12 * across);
      world.set_velocity(car.body, {speed * drift.sin, 0, speed * drift.cos}, {});
      for (int i = 0; i < 4; ++i)
        car.state.wheels[i].angular_velocity = speed * drift.cos * float(1.0 + 0.1 * along) / float(kRadius);
      ASSERT_EQ(drive_vehicle(world, car.def, car.body, car.state, {.gear = 0}, kStep).code, ErrorCode::none);
      const double s = std::hypot(along, across), peak = 2 * s / (1 + s * s);
      const double share = s <= 1 ? peak : 0.7 + 0.3 * peak;
      const WheelState& wheel = car.state.wheels[0];
      const double most = 0.9 * double(wheel.load);
      const double expected_along = s > 0 ? most * share * along / s : 0.0;
      const double expected_across = s > 0 ? -most * share * across / s : 0.0;
      worst = std::max(worst, std::fabs(double(wheel.force.z) - expected_along) / most);
      worst = std::max(worst, std::fabs(double(wheel.force.x) - expected_across) / most);
    }
  }
  EXPECT_LE(worst, 1e-2);
  std::printf("[row] tyre curves along and across, worst of 36 points: %.2e of the grip\n", worst);
}

// All wheels locked: the sliding share of the grip. Just enough brake: near the peak of it.
TEST(Vehicle, BrakesAsItsTyresGrip) {
  for (const bool locked : {true, false}) {
    World world = make_road();
    Car car = make_car(world);
    drive(world, car, {.gear = 0}, 2.0);
    world.set_velocity(car.body, {0, 0, 30}, {});
    for (int i = 0; i < 4; ++i) car.state.wheels[i].angular_velocity = 30 / float(kRadius);
    for (WheelDef& wheel : car.def.wheels) {
      // In proportion to the load under braking, short of the peak.
      wheel.brake = locked ? 1e5f : 0.0f;
      wheel.tyre.slide = 0.75f;
    }
    if (!locked) {
      for (int i = 0; i < 4; ++i) car.def.wheels[std::size_t(i)].brake = i < 2 ? 1200.0f : 500.0f;
    }
    drive(world, car, {.brake = 1, .gear = 0}, 0.5);
    const double before = forward_speed(world, car);
    drive(world, car, {.brake = 1, .gear = 0}, 1.0);
    const double slowed = before - forward_speed(world, car);
    // Locked: on the curve where slip is 1. Else brakes of 3,400 N m in all, and rolling resistance, against the mass and what turns
    // with it.
    const double s = 1 / 0.12;
    const double expected =
        locked ? 1.1 * (0.75 + 0.25 * 2 * s / (1 + s * s)) * kGravity
               : (3400 / kRadius + 0.012 * kMass * kGravity) / (kMass + 4 * 1.0 / (kRadius * kRadius));
    EXPECT_TRUE(relative_row(locked ? "deceleration, locked, m/s^2" : "deceleration by the brakes", slowed,
                             expected, locked ? 3e-2 : 2e-2));
  }
}

// On a circle the steering angle is L / R + K a. With cornering stiffness 2 grip load / peak_angle in proportion to the load the
// bicycle model's gradient is K = (angle_front / 2 grip_front - angle_rear / 2 grip_rear) / g, whatever the centre of mass.
TEST(Vehicle, UndersteersAsTheBicycleModelSays) {
  const double wheelbase = kFront + kRear;
  for (const float rear_angle : {0.08f, 0.14f}) {
    const double expected = (0.14 - double(rear_angle)) / (2 * 1.1) / kGravity;
    double measured[2] = {}, lateral[2] = {};
    for (int k = 0; k < 2; ++k) {
      World world = make_road();
      Car car = make_car(world);
      for (std::size_t i = 2; i < 4; ++i) car.def.wheels[i].tyre.peak_angle = rear_angle;
      for (WheelDef& wheel : car.def.wheels) wheel.tyre.rolling = 0;
      drive(world, car, {.gear = 0}, 2.0);
      const float speed = k == 0 ? 5.0f : 20.0f;
      world.set_velocity(car.body, {0, 0, speed}, {});
      for (int i = 0; i < 4; ++i) car.state.wheels[i].angular_velocity = speed / float(kRadius);
      // Small angles: a tenth of a radian would be past what is linear at this speed.
      const float angle = k == 0 ? 0.02f : 0.01f;
      drive(world, car, {.steer = angle / car.def.steer_angle, .gear = 0}, 5.0);
      const double v = double(length(world.linear_velocity(car.body)));
      const double rate = double(world.angular_velocity(car.body).y);
      lateral[k] = v * rate;
      measured[k] = double(angle) - wheelbase * rate / v;
      EXPECT_GT(rate, 0.0) << "to the left";
    }
    const double gradient = (measured[1] - measured[0]) / (lateral[1] - lateral[0]);
    std::printf("[row] understeer gradient, rear peak at %.2f rad: %.5f rad s^2/m, bicycle model %.5f\n",
                double(rear_angle), gradient, expected);
    EXPECT_NEAR(gradient, expected, 0.05 * 0.0028 + 0.00015);
  }
}

TEST(Vehicle, ShiftsAndReachesASpeed) {
  World world = make_road();
  Car car = make_car(world);
  drive(world, car, {}, 2.0);
  int highest = 0;
  double hundred = 0;
  for (int i = 0; i < 30 * 60; ++i) {
    drive(world, car, {.throttle = 1}, 1.0 / 60);
    highest = std::max(highest, car.state.gear);
    if (hundred == 0 && forward_speed(world, car) > 100 / 3.6) hundred = i / 60.0;
  }
  std::printf("[row] 100 km/h after %.1f s, highest gear %d, %.0f m/s after 30 s\n", hundred, highest,
              forward_speed(world, car));
  EXPECT_GE(highest, 3);
  EXPECT_GT(hundred, 3.0);
  EXPECT_LT(hundred, 15.0);
  EXPECT_LT(std::fabs(world.pose(car.body).position.x), 0.5) << "straight on";
  drive(world, car, {.brake = 1}, 8.0);
  EXPECT_LT(std::fabs(forward_speed(world, car)), 0.1);
  // And back.
  drive(world, car, {.throttle = 0.5f, .gear = -1}, 4.0);
  EXPECT_LT(forward_speed(world, car), -1.0);
}

// A wheel on ice takes all from an open differential, and not from a locked one.
TEST(Vehicle, DifferentialsShareTorque) {
  double speed[2];
  for (const bool locked : {false, true}) {
    World world = make_road();
    Car car = make_car(world);
    car.def.wheels[2].tyre.grip = 0.02f;
    car.def.axles[1].lock = locked ? 1e9f : 0.0f;
    drive(world, car, {.gear = 0}, 1.0);
    drive(world, car, {.throttle = 0.4f}, 4.0);
    speed[locked ? 1 : 0] = forward_speed(world, car);
    if (locked) {
      EXPECT_NEAR(double(car.state.wheels[2].angular_velocity / car.state.wheels[3].angular_velocity), 1.0,
                  0.1);
    }
  }
  std::printf("[row] one wheel on ice: %.2f m/s open, %.2f m/s locked\n", speed[0], speed[1]);
  EXPECT_GT(speed[1], 2 * speed[0]);
}

// In a bend bars take the lean from the springs.
TEST(Vehicle, AntiRollBarsHoldItUpright) {
  double lean[2];
  for (const bool bars : {false, true}) {
    World world = make_road();
    Car car = make_car(world);
    for (AxleDef& axle : car.def.axles) axle.anti_roll = bars ? 30000.0f : 0.0f;
    drive(world, car, {.gear = 0}, 2.0);
    world.set_velocity(car.body, {0, 0, 15}, {});
    for (int i = 0; i < 4; ++i) car.state.wheels[i].angular_velocity = 15 / float(kRadius);
    drive(world, car, {.steer = 0.06f / car.def.steer_angle, .gear = 0}, 3.0);
    const Vec3 left = rotate(world.pose(car.body).orientation, {1, 0, 0});
    lean[bars ? 1 : 0] = double(left.y);
  }
  std::printf("[row] lean in a bend %.4f without bars, %.4f with\n", lean[0], lean[1]);
  EXPECT_GT(lean[0], 0.005) << "outwards: the left side rises in a bend to the left";
  EXPECT_LT(lean[1], 0.6 * lean[0]);
}

// Over a field of heights for half a minute, on four wheels, tracks and two: upright, and the same way again from a snapshot.
TEST(Vehicle, DrivesOverHeightFieldsTheSameWayAgain) {
  for (const int kind : {0, 1, 2}) {
    SCOPED_TRACE(kind == 0 ? "car" : kind == 1 ? "tracked" : "motorcycle");
    World world = *World::create({});
    std::vector<float> heights(101 * 101);
    for (int i = 0; i < 101 * 101; ++i) {
      heights[std::size_t(i)] = 0.5f *
                                rotate(from_axis_angle({0, 1, 0}, 0.19f * float(i % 101)), {1, 0, 0}).x *
                                rotate(from_axis_angle({0, 1, 0}, 0.23f * float(i / 101)), {1, 0, 0}).z;
    }
    world.add_body({.type = BodyType::fixed}, {.geometry = *cook_height_field({heights, 101, 101, 2.0f})});
    Car car = kind == 0   ? make_car(world, {0, 1.5, 0})
              : kind == 1 ? make_tank(world, 2.0)
                          : make_bike(world, 1.5);
    // As fast as the hills allow.
    const VehicleInput inputs[] = {{.throttle = 0.35f, .steer = 0.4f},
                                   {.throttle = 0.1f, .steer = 0.4f},
                                   {.throttle = 0.08f, .steer = 0.3f}};
    const VehicleInput& input = inputs[kind];
    const auto go = [&](int from, int to) {
      for (int i = from; i < to; ++i) drive(world, car, input, 1.0 / 60);
    };
    go(0, 900);
    const auto moment = save_snapshot(world);
    const VehicleState then = car.state;
    go(900, 1800);
    EXPECT_GT(rotate(world.pose(car.body).orientation, {0, 1, 0}).y, 0.7f);
    EXPECT_GT(forward_speed(world, car), 1.0);
    EXPECT_LT(length(world.pose(car.body).position), 90.0);
    const std::uint64_t hash = world.hash();
    ASSERT_EQ(restore_snapshot(world, moment).code, ErrorCode::none);
    car.state = then;
    go(900, 1800);
    EXPECT_EQ(world.hash(), hash);
  }
}

// Straight on as its torque says, and round on the spot.
TEST(Vehicle, TracksTurnTogether) {
  World world = make_road();
  Car tank = make_tank(world);
  drive(world, tank, {.gear = 1}, 3.0);
  drive(world, tank, {.throttle = 1, .gear = 1}, 1.5);
  const double before = forward_speed(world, tank);
  drive(world, tank, {.throttle = 1, .gear = 1}, 1.5);
  const double moved = 8000 + (10 * 1.0 + 1.0 * 144) / (kRadius * kRadius);
  EXPECT_TRUE(relative_row("tracked: acceleration, m/s^2", (forward_speed(world, tank) - before) / 1.5,
                           800 * 12 / kRadius / moved, 3e-2));
  EXPECT_NEAR(double(world.angular_velocity(tank.body).y), 0.0, 1e-3);
  drive(world, tank, {.brake = 1, .gear = 0}, 6.0);
  const DVec3 place = world.pose(tank.body).position;
  drive(world, tank, {.steer = 1, .gear = 0}, 3.0);
  EXPECT_GT(double(world.angular_velocity(tank.body).y), 0.2) << "to the left";
  EXPECT_LT(length(world.pose(tank.body).position - place), 0.5) << "on the spot";
  EXPECT_LT(tank.state.wheels[0].angular_velocity, 0.0f);
  EXPECT_GT(tank.state.wheels[1].angular_velocity, 0.0f);
  for (int i = 2; i < 10; ++i)
    EXPECT_EQ(tank.state.wheels[i].angular_velocity, tank.state.wheels[i % 2].angular_velocity);
}

// It stands, and in a bend leans by atan(v^2 / g R) with hardly any torque left to hold it there.
TEST(Vehicle, MotorcyclesLeanIntoBends) {
  World world = make_road();
  Car bike = make_bike(world);
  drive(world, bike, {.gear = 0}, 2.0);
  EXPECT_NEAR(double(rotate(world.pose(bike.body).orientation, {0, 1, 0}).y), 1.0, 1e-4) << "it stands";
  world.set_velocity(bike.body, {0, 0, 15}, {});
  for (int i = 0; i < 2; ++i) bike.state.wheels[i].angular_velocity = 50;
  drive(world, bike, {.steer = 0.35f, .gear = 0}, 4.0);
  const double v = double(length(world.linear_velocity(bike.body))),
               rate = double(world.angular_velocity(bike.body).y);
  const Vec3 up = rotate(world.pose(bike.body).orientation, {0, 1, 0});
  const double lean = std::acos(double(up.y));
  EXPECT_GT(rate, 0.1);
  EXPECT_TRUE(relative_row("lean of a motorcycle, rad", lean, std::atan(v * rate / kGravity), 5e-2));
  // Upright that bend would throw it over with m v r h.
  const double whole = 250 * v * rate * 0.75;
  std::printf("[row] torque that holds the lean %.1f N m of %.0f without leaning\n",
              double(bike.state.lean_torque), whole);
  EXPECT_LT(std::fabs(double(bike.state.lean_torque)), 0.1 * whole);
}

TEST(Vehicle, RefusesWhatCannotBe) {
  World world = make_road();
  Car car = make_car(world);
  EXPECT_EQ(drive_vehicle(world, car.def, car.body, car.state, {.throttle = 2}, kStep).code,
            ErrorCode::invalid_argument);
  car.def.wheels[1].radius = 0;
  EXPECT_EQ(check_vehicle(car.def).code, ErrorCode::invalid_argument);
  car.def.wheels.clear();
  EXPECT_EQ(check_vehicle(car.def).code, ErrorCode::invalid_argument);
}

}  // namespace
}  // namespace gyre::kit::vehicle_test
