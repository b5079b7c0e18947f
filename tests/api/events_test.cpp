// Events, filters, materials in pairs, sensors, sleep and what wakes, readings of contacts, energy and momentum.
#include "laws/kit.h"

namespace gyre::laws::events_test {
namespace {

TEST(Events, RemovingABodyEndsItsContacts) {
  World world = make_world();
  add_ground(world);
  const BodyId box = world.add_body({.pose = {.position = {0, 0.5, 0}}}, {.geometry = Box{}});
  run(world, 0.5);
  world.remove_body(box);
  world.step(kStep);
  EXPECT_EQ(world.events().ends.size(), 1u);
}

TEST(Sensor, ReportsWhatPassesAndTouchesNothing) {
  World world = make_world({.gravity = {0, 0, 0}});
  const BodyId gate =
      world.add_body({.type = BodyType::fixed}, {.geometry = Box{{0.5f, 5, 5}}, .sensor = true});
  const BodyId ball = world.add_body({.pose = {.position = {-3, 0, 0}}, .linear_velocity = {5, 0, 0}},
                                     {.geometry = Sphere{}});
  int in = 0, out = 0;
  for (int i = 0; i < 90; ++i) {
    world.step(kStep);
    for (const SensorTouch& t : world.events().sensors) {
      EXPECT_EQ(t.sensor, world.shapes(gate)[0]);
      EXPECT_EQ(t.visitor, world.shapes(ball)[0]);
      (t.begins ? in : out) += 1;
    }
  }
  EXPECT_EQ(in, 1);
  EXPECT_EQ(out, 1);
  EXPECT_EQ(world.linear_velocity(ball), (Vec3{5, 0, 0}));
  EXPECT_TRUE(world.events().begins.empty());
}

// A bullet that is before a thin sensor at one step's end and beyond it at the next one's: it has been inside.
TEST(Sensor, ReportsBulletsThatPassWithinAStep) {
  for (const float speed : {5.0f, 60.0f, 300.0f, 3000.0f}) {
    for (const bool moving_gate : {false, true}) {
      for (int phase = 0; phase < 20; ++phase) {
        World world = make_world({.gravity = {0, 0, 0}, .threads = 1 + phase % 2});
        const double start = -2.0 - double(speed) / 60.0 * phase / 20.0;
        const BodyId still = world.add_body({.pose = {.position = {0, 0, 0}}},
                                            {.geometry = Box{{0.005f, 2, 2}}, .sensor = !moving_gate});
        const BodyId bullet =
            world.add_body({.pose = {.position = {start, 0.1, 0.2}}, .linear_velocity = {speed, 0, 0}},
                           {.geometry = Sphere{0.02f}, .sensor = moving_gate});
        // Beside the way, and behind a wall: nothing is reported of these.
        world.add_body({.type = BodyType::fixed, .pose = {.position = {0, 5, 0}}},
                       {.geometry = Box{}, .sensor = true});
        std::vector<bool> seen;
        for (int i = 0; i < 90; ++i) {
          world.step(kStep);
          for (const SensorTouch& t : world.events().sensors) {
            EXPECT_EQ(t.sensor, world.shapes(moving_gate ? bullet : still)[0]);
            EXPECT_EQ(t.visitor, world.shapes(moving_gate ? still : bullet)[0]);
            seen.push_back(t.begins);
          }
        }
        EXPECT_EQ(seen, (std::vector<bool>{true, false})) << "B-32 at " << speed << " m/s, phase " << phase;
        EXPECT_EQ(world.linear_velocity(bullet), (Vec3{speed, 0, 0}));
      }
    }
  }
}

// B-32 with gates of triangles: a sheet, one of two sides, a closed slab, a height field. Each is the sensor or the visitor, stands or
// goes, and is passed from either side, within a step too.
Geometry gate_of_triangles(int kind) {
  if (kind == 3) {
    const std::vector<float> heights(49, 0.0f);
    return *cook_height_field({.heights = heights, .columns = 7, .rows = 7, .spacing = 1.0f});
  }
  std::vector<Vec3> v;
  std::vector<std::uint32_t> t = {0, 4, 6, 0, 6, 2, 1, 3, 7, 1, 7, 5, 0, 1, 5, 0, 5, 4,
                                  2, 6, 7, 2, 7, 3, 0, 2, 3, 0, 3, 1, 4, 5, 7, 4, 7, 6};
  for (int i = 0; i < 8; ++i)
    v.push_back({i & 1 ? 3.0f : -3.0f, i & 2 ? 0.01f : -0.01f, i & 4 ? 3.0f : -3.0f});
  if (kind < 2) t = {2, 6, 7, 2, 7, 3};
  return *cook_mesh({.vertices = v, .indices = t, .double_sided = kind == 1});
}
TEST(Sensor, OfTrianglesSeesWhatPasses) {
  enum { dynamic_ball, kinematic_ball, kinematic_gate, gate_over_a_ball_at_rest, cases };
  int wrong = 0, tried = 0;
  for (int kind = 0; kind < 4; ++kind) {
    const Geometry triangles = gate_of_triangles(kind);
    for (const float speed : {2.0f, 47.0f, 300.0f, 3000.0f}) {
      for (int way = 0; way < 4 * cases; ++way) {
        const bool from_below = way % 2 == 0, gate_senses = way / 2 % 2 == 0;
        const int who = way / 4;
        const Vec3 velocity{0, from_below ? speed : -speed, 0};
        World world = make_world({.gravity = {0, 0, 0}, .threads = 1 + way % 2});
        BodyDef gate{.type = who < kinematic_gate ? BodyType::fixed : BodyType::kinematic};
        BodyDef ball{
            .type = who == kinematic_ball || who == kinematic_gate ? BodyType::kinematic : BodyType::dynamic,
            .pose = {.position = {0.13, from_below ? -2.0 : 2.0, 0.21}}};
        (who < kinematic_gate ? ball : gate).linear_velocity = who < kinematic_gate ? velocity : -velocity;
        world.add_body(gate, {.geometry = triangles, .sensor = gate_senses});
        const BodyId id = world.add_body(ball, {.geometry = Sphere{0.1f}, .sensor = !gate_senses});
        std::vector<bool> seen;
        for (int i = 0; i < 120; ++i) {
          world.step(kStep);
          for (const SensorTouch& t : world.events().sensors) {
            seen.push_back(t.begins);
            EXPECT_EQ(world.body_of(gate_senses ? t.visitor : t.sensor), id);
          }
        }
        ++tried;
        if (seen == std::vector<bool>{true, false}) continue;
        ++wrong;
        std::printf("gate %d at %g m/s, case %d: %d events\n", kind, double(speed), way, int(seen.size()));
      }
    }
  }
  EXPECT_TRUE(limit_row("B-32 gates of triangles passed unseen, or seen twice", wrong, 0, 0))
      << "of " << tried;
}

// Sensors and visitors that are both surfaces or planes: sheets, slabs and fields that a kinematic body carries through, and out of,
// what cannot touch them.
TEST(Sensor, OfTrianglesSeesTriangles) {
  enum { plane = 4, kinds };
  const auto shape_of = [](int kind) {
    return kind == plane ? AnyShape(Plane{}) : AnyShape(gate_of_triangles(kind));
  };
  for (int kind = 0; kind < kinds; ++kind) {
    for (int other = 0; other < kinds; ++other) {
      for (int way = 0; way < 4; ++way) {
        const bool still_senses = way % 2 == 0, turned = way / 2 == 1;
        World world = make_world({.gravity = {0, 0, 0}, .threads = 1 + way % 2});
        // The one that moves stands upright, so that the two cross; a plane that moves is turned over, and so apart from one below.
        const float angle = other == plane ? kPi : turned ? 0.5f * kPi : 0.4f * kPi;
        const Quat turn{std::sin(0.5f * angle), 0, 0, std::cos(0.5f * angle)};
        const BodyId still =
            world.add_body({.type = BodyType::fixed}, {.geometry = shape_of(kind), .sensor = still_senses});
        BodyDef moving{
            .type = BodyType::kinematic, .pose = {{0.1, 5, 0.2}, turn}, .linear_velocity = {0, -3, 0}};
        const BodyId visitor = world.add_body(moving, {.geometry = shape_of(other), .sensor = !still_senses});
        std::vector<bool> seen;
        for (int i = 0; i < 400; ++i) {
          if (i == 200) world.set_velocity(visitor, {0, 3, 0}, {});
          world.step(kStep);
          for (const SensorTouch& t : world.events().sensors) {
            seen.push_back(t.begins);
            EXPECT_EQ(world.body_of(still_senses ? t.visitor : t.sensor), visitor);
            EXPECT_EQ(world.body_of(still_senses ? t.sensor : t.visitor), still);
          }
        }
        // Down through it and up again: what is solid below, or turned over above what is, is left only where it came from.
        const bool solid = kind == plane || other == plane;
        const std::vector<bool> expected =
            solid ? std::vector<bool>{true, false} : std::vector<bool>{true, false, true, false};
        EXPECT_EQ(seen, expected) << "of kind " << kind << ", visited by " << other << ", case " << way;
      }
    }
  }
}

TEST(Sensor, BehindAWallSeesNoBullet) {
  World world = make_world({.gravity = {0, 0, 0}});
  world.add_body({.type = BodyType::fixed}, {.geometry = Box{{0.01f, 2, 2}}});
  world.add_body({.type = BodyType::fixed, .pose = {.position = {1, 0, 0}}},
                 {.geometry = Box{{0.005f, 2, 2}}, .sensor = true});
  world.add_body({.pose = {.position = {-2, 0, 0}}, .linear_velocity = {300, 0, 0}},
                 {.geometry = Sphere{0.02f}});
  for (int i = 0; i < 60; ++i) {
    world.step(kStep);
    EXPECT_TRUE(world.events().sensors.empty());
  }
}

// A pair begins once, persists from the next step on, and ends once; what it bears is told each step.
TEST(Events, OfABoxThatLandsRestsAndIsTakenAway) {
  World world = make_world({.sleeping = false});
  const BodyId ground = add_ground(world);
  const BodyId box = world.add_body({.pose = {.position = {0, 0.8, 0}}, .mass = 2.0f}, {.geometry = Box{}});
  int begins = 0, ends = 0, first = -1;
  double struck = 0.0;
  for (int i = 0; i < 120; ++i) {
    world.step(kStep);
    begins += int(world.events().begins.size());
    ends += int(world.events().ends.size());
    if (begins == 1 && first < 0) first = i;
    for (const ContactHit& hit : world.events().hits) {
      struck += double(hit.impulse);
      EXPECT_EQ(hit.triangle, -1);
      EXPECT_GT(hit.approach_speed, 1.0f);
    }
    ContactPair pairs[2];
    const std::size_t count = world.contact_pairs(pairs);
    EXPECT_EQ(count, first >= 0 && i > first ? 1u : 0u) << i;
    if (i > 100) {
      EXPECT_EQ(pairs[0].body_a, ground);
      EXPECT_EQ(pairs[0].body_b, box);
      EXPECT_NEAR(double(pairs[0].impulse), 2.0 * kGravity / 60.0, 1e-3) << "it bears the weight";
    }
  }
  EXPECT_EQ(begins, 1);
  EXPECT_EQ(ends, 0);
  // The hit takes the momentum of a fall of 0.3 m, and what gravity adds in the step.
  EXPECT_NEAR(struck, 2.0 * std::sqrt(2.0 * kGravity * 0.3), 2.0 * kGravity / 60.0 + 0.05);
  world.set_pose(box, {{0, 5, 0}, {}});
  world.step(kStep);
  EXPECT_EQ(world.events().ends.size(), 1u);
  EXPECT_EQ(world.contact_pairs({}), 0u);
}

TEST(Events, NameTheTriangle) {
  World world = make_world({.sleeping = false});
  const Vec3 vertices[] = {{-2, 0, -2}, {-2, 0, 2}, {2, 0, -2}, {2, 0, 2}};
  const std::uint32_t indices[] = {0, 1, 2, 2, 1, 3};
  world.add_body({.type = BodyType::fixed},
                 {.geometry = *cook_mesh({.vertices = vertices, .indices = indices})});
  world.add_body({.pose = {.position = {-1, 0.8, -1}}}, {.geometry = Sphere{0.5f}});
  world.add_body({.pose = {.position = {1, 0.8, 1}}}, {.geometry = Sphere{0.5f}});
  int hits = 0;
  for (int i = 0; i < 60; ++i) {
    world.step(kStep);
    for (const ContactHit& hit : world.events().hits) {
      ++hits;
      EXPECT_EQ(hit.triangle, hit.point.x < 0.0 ? 0 : 1);
    }
  }
  EXPECT_EQ(hits, 2);
  std::vector<ContactPoint> points(world.contacts({}));
  world.contacts(points);
  ASSERT_EQ(points.size(), 2u);
  for (const ContactPoint& point : points) EXPECT_EQ(point.triangle, point.position.x < 0.0 ? 0 : 1);
}

// Sensors of every type of body see visitors of every other, as far as one of the two can move.
TEST(Sensor, SeesEveryTypeOfBody) {
  const BodyType types[] = {BodyType::fixed, BodyType::kinematic, BodyType::dynamic};
  for (const BodyType sensor_type : types) {
    for (const BodyType visitor_type : types) {
      World world = make_world({.gravity = {0, 0, 0}});
      const bool sensor_moves = visitor_type == BodyType::fixed;
      const Vec3 way{3, 0, 0};
      BodyDef sensor{.type = sensor_type, .pose = {.position = {-3, 0, 0}}};
      BodyDef visitor{.type = visitor_type, .pose = {.position = {3, 0, 0}}};
      if (sensor_moves && sensor_type != BodyType::fixed) sensor.linear_velocity = way;
      if (!sensor_moves) visitor.linear_velocity = -way;
      const BodyId gate = world.add_body(sensor, {.geometry = Box{}, .sensor = true});
      const BodyId guest = world.add_body(visitor, {.geometry = Box{}});
      int in = 0, out = 0;
      for (int i = 0; i < 200; ++i) {
        world.step(kStep);
        for (const SensorTouch& touch : world.events().sensors) {
          EXPECT_EQ(world.body_of(touch.sensor), gate);
          EXPECT_EQ(world.body_of(touch.visitor), guest);
          (touch.begins ? in : out) += 1;
        }
      }
      const int expected = sensor_type == BodyType::fixed && visitor_type == BodyType::fixed ? 0 : 1;
      EXPECT_EQ(in, expected) << int(sensor_type) << " " << int(visitor_type);
      EXPECT_EQ(out, expected) << int(sensor_type) << " " << int(visitor_type);
    }
  }
}

TEST(Joints, BreakAboveTheirForceAndSaySo) {
  World world = make_world();
  const BodyId weight = world.add_body({.mass = 10.0f}, {.geometry = Box{}});
  const JointId strong = world.add_joint(BallDef{.b = weight, .anchor = {0, 0.5, 0}, .break_force = 150.0f});
  run(world, 2.0);
  EXPECT_TRUE(world.exists(strong)) << "98.1 N of 150";
  world.add_force(weight, {0, -100, 0});
  world.step(kStep);
  ASSERT_EQ(world.events().broken.size(), 1u);
  EXPECT_EQ(world.events().broken[0].joint, strong);
  EXPECT_NEAR(double(world.events().broken[0].force), 198.1, 5.0);
  EXPECT_FALSE(world.exists(strong));
  run(world, 1.0);
  EXPECT_LT(world.pose(weight).position.y, -4.0);
}

bool collide(const Filter& fa, const Filter& fb) {
  World world = make_world({.gravity = {0, 0, 0}});
  world.add_body({.type = BodyType::fixed}, {.geometry = Box{}, .filter = fa});
  const BodyId b = world.add_body({.pose = {.position = {-2, 0, 0}}, .linear_velocity = {4, 0, 0}},
                                  {.geometry = Box{}, .filter = fb});
  run(world, 1.0);
  return world.pose(b).position.x < 0.0;
}
TEST(Filter, LayersAndGroups) {
  EXPECT_TRUE(collide({}, {}));
  EXPECT_FALSE(collide({.layer = 1, .collides_with = 1}, {.layer = 2, .collides_with = 0xffffffffu}));
  EXPECT_FALSE(collide({.layer = 1, .collides_with = 0xffffffffu}, {.layer = 2, .collides_with = 2}));
  EXPECT_TRUE(collide({.layer = 1, .collides_with = 2}, {.layer = 2, .collides_with = 1}));
  EXPECT_FALSE(collide({.group = -3}, {.group = -3}));
  EXPECT_TRUE(collide({.group = -3}, {.group = -4}));
  EXPECT_TRUE(
      collide({.layer = 1, .collides_with = 0, .group = 5}, {.layer = 1, .collides_with = 0, .group = 5}));
  EXPECT_FALSE(
      collide({.layer = 1, .collides_with = 0, .group = 5}, {.layer = 1, .collides_with = 0, .group = 6}));
}
TEST(Filter, ChangedWhileTouchingTakesEffect) {
  World world = make_world();
  add_ground(world);
  const BodyId box = world.add_body({.pose = {.position = {0, 0.5, 0}}}, {.geometry = Box{}});
  run(world, 3.0);
  EXPECT_FALSE(world.is_awake(box));
  EXPECT_TRUE(world.set_filter(world.shapes(box)[0], {.layer = 2, .collides_with = 0}));
  run(world, 1.0);
  EXPECT_LT(world.pose(box).position.y, -2.0);
}

TEST(Restitution, CombinesByRuleAndByPair) {
  const auto bounce = [](CombineRule rule, bool pair) {
    World world = make_world({.gravity = {0, 0, 0}, .restitution_rule = rule});
    Material a = surface(0, 0.9f), b = surface(0, 0.4f);
    a.id = 3, b.id = 4;
    if (pair) world.set_material_pair({.a = 3, .b = 4, .restitution = 0.25f});
    world.add_body({.type = BodyType::fixed}, {.geometry = Box{}, .material = a});
    const BodyId ball = world.add_body({.pose = {.position = {-2, 0, 0}}, .linear_velocity = {10, 0, 0}},
                                       {.geometry = Sphere{}, .material = b});
    run(world, 0.5);
    return -double(world.linear_velocity(ball).x) / 10.0;
  };
  EXPECT_NEAR(bounce(CombineRule::maximum, false), 0.9, 1e-4);
  EXPECT_NEAR(bounce(CombineRule::minimum, false), 0.4, 1e-4);
  EXPECT_NEAR(bounce(CombineRule::average, false), 0.65, 1e-4);
  EXPECT_NEAR(bounce(CombineRule::geometric_mean, false), 0.6, 1e-4);
  EXPECT_NEAR(bounce(CombineRule::product, false), 0.36, 1e-4);
  EXPECT_NEAR(bounce(CombineRule::product, true), 0.25, 1e-4);
}

// A tower of three, asleep; whatever changes under or about it wakes what it concerns.
struct Sleepers {
  World world;
  std::vector<BodyId> boxes;
};
Sleepers sleepers() {
  Sleepers s{make_world(), {}};
  add_ground(s.world);
  for (int i = 0; i < 3; ++i)
    s.boxes.push_back(s.world.add_body({.pose = {.position = {0, 0.5 + i, 0}}}, {.geometry = Box{}}));
  int asleep_events = 0;
  for (int i = 0; i < 300; ++i) {
    s.world.step(kStep);
    for (const SleepChange& c : s.world.events().sleep_changes) asleep_events += int(c.asleep);
  }
  EXPECT_EQ(asleep_events, 3);
  EXPECT_EQ(s.world.stats().awake_bodies, 0);
  return s;
}
TEST(Sleep, EndsForTheTowerWhenItsFootIsRemoved) {
  Sleepers s = sleepers();
  s.world.remove_body(s.boxes[0]);
  run(s.world, 2.0);
  EXPECT_NEAR(s.world.pose(s.boxes[1]).position.y, 0.5, 0.02) << "A-121";
  EXPECT_NEAR(s.world.pose(s.boxes[2]).position.y, 1.5, 0.02) << "A-121";
}
TEST(Sleep, EndsWhenSomethingKinematicComesUnder) {
  Sleepers s = sleepers();
  const BodyId ram = s.world.add_body(
      {.type = BodyType::kinematic, .pose = {.position = {-3, 0.5, 0}}, .linear_velocity = {2, 0, 0}},
      {.geometry = Box{}});
  run(s.world, 2.0);
  EXPECT_GT(s.world.pose(s.boxes[0]).position.x, 1.0) << "A-121";
  static_cast<void>(ram);
}
TEST(Sleep, EndsWithGravityForceVelocityPoseAndType) {
  for (int k = 0; k < 6; ++k) {
    Sleepers s = sleepers();
    if (k == 0) s.world.set_gravity({0, 5, 0});
    if (k == 1) s.world.add_force(s.boxes[1], {0, 0, 3e4f});
    if (k == 2) s.world.set_velocity(s.boxes[2], {0, 5, 0}, {});
    if (k == 3) s.world.set_pose(s.boxes[0], {.position = {0, 10, 0}});
    if (k == 4) s.world.add_impulse(s.boxes[2], {0, 5000, 0});
    if (k == 5) s.world.set_gravity_scale(s.boxes[2], -1.0f);
    s.world.step(kStep);
    EXPECT_GT(s.world.stats().awake_bodies, 0) << k;
    run(s.world, 0.5);
    double moved = 0.0;
    for (int i = 0; i < 3; ++i)
      moved = std::max(moved, length(s.world.pose(s.boxes[std::size_t(i)]).position - DVec3{0, 0.5 + i, 0}));
    EXPECT_GT(moved, k == 1 ? 1e-4 : 0.05) << k;
  }
}
TEST(Sleep, EndsForBodiesHangingFromAChangedJoint) {
  World world = make_world();
  const BodyId lamp = world.add_body({}, {.geometry = Box{}});
  const JointId cord = world.add_joint(BallDef{.b = lamp, .anchor = {0, 1, 0}});
  run(world, 5.0);
  EXPECT_FALSE(world.is_awake(lamp));
  world.remove_joint(cord);
  run(world, 1.0);
  EXPECT_LT(world.pose(lamp).position.y, -4.0) << "A-121";
}
TEST(Sleep, MotorsTurnSleepersAgain) {
  World world = make_world({.gravity = {0, 0, 0}});
  const BodyId wheel = world.add_body({}, {.geometry = Box{}});
  const JointId axle = world.add_joint(HingeDef{.b = wheel, .anchor = {0, 0, 0}, .axis = {0, 1, 0}});
  run(world, 3.0);
  EXPECT_FALSE(world.is_awake(wheel));
  EXPECT_TRUE(world.set_motor(axle, {.target_velocity = 3.0f, .max_force = 1e6f}));
  run(world, 1.0);
  EXPECT_NEAR(double(world.angular_velocity(wheel).y), 3.0, 0.01) << "A-121";
}

TEST(Readings, ContactsOfABoxAtRest) {
  World world = make_world({.sleeping = false});
  const BodyId ground = add_ground(world);
  const BodyId box = world.add_body({.pose = {.position = {0, 0.5, 0}}, .mass = 3.0f}, {.geometry = Box{}});
  run(world, 2.0);
  std::vector<ContactPoint> points(world.contacts({}));
  ASSERT_EQ(points.size(), 4u);
  EXPECT_EQ(world.contacts(points), 4u);
  double weight = 0.0;
  for (const ContactPoint& p : points) {
    weight += double(p.normal_impulse);
    EXPECT_TRUE((p.body_a == ground && p.body_b == box) || (p.body_a == box && p.body_b == ground));
    EXPECT_NEAR(double(p.normal.y), p.body_b == box ? 1.0 : -1.0, 1e-5) << "from a to b";
    EXPECT_NEAR(double(std::fabs(dot(p.normal, p.tangent_1))), 0.0, 1e-5);
    EXPECT_NEAR(std::fabs(p.position.x), 0.5, 1e-3);
    EXPECT_NEAR(p.position.y, 0.0, 1e-2);
  }
  EXPECT_NEAR(weight, 3.0 * kGravity / 60.0, 1e-3 * weight);
}

TEST(Readings, EnergyAndMomentumOfFreeBodies) {
  World world = make_world();
  world.add_body({.pose = {.position = {1, 2, 3}},
                  .linear_velocity = {1, 0, 0},
                  .angular_velocity = {0, 2, 0},
                  .mass = 6.0f},
                 {.geometry = Box{}});
  const Energy e = world.energy();
  EXPECT_NEAR(e.kinetic, 3.0 + 0.5 * 1.0 * 4.0, 1e-5);
  EXPECT_NEAR(e.potential, 6.0 * kGravity * 2.0, 1e-4);
  const Momentum m = world.momentum();
  EXPECT_NEAR(m.linear.x, 6.0, 1e-6);
  EXPECT_NEAR(m.angular.y, 3.0 * 6.0 + 2.0, 1e-5);
  EXPECT_NEAR(m.angular.z, -2.0 * 6.0, 1e-5);
}

}  // namespace
}  // namespace gyre::laws::events_test
