// Things that are put onto sleepers, and sensors around what stands still: everybody is told, whatever moves.
#include "laws/kit.h"

#include <random>

namespace gyre::laws::sleepers_test {
namespace {

enum How { added, teleported, filter_opened, shape_added, how_count };
const char* const kHows[] = {"added", "teleported", "filter opened", "shape added"};
const char* const kTypes[] = {"fixed", "kinematic", "dynamic"};
constexpr Filter kTouchesNothing{.collides_with = 0};

// A slab of triangles, one of whose sides faces down.
Geometry slab(float half) {
  std::vector<Vec3> v;
  for (int i = 0; i < 8; ++i) v.push_back({i & 1 ? half : -half, i & 2 ? 0.2f : -0.2f, i & 4 ? half : -half});
  const std::vector<std::uint32_t> t = {0, 4, 6, 0, 6, 2, 1, 3, 7, 1, 7, 5, 0, 1, 5, 0, 5, 4,
                                        2, 6, 7, 2, 7, 3, 0, 2, 3, 0, 3, 1, 4, 5, 7, 4, 7, 6};
  return *cook_mesh({.vertices = v, .indices = t});
}

// Brings a body of the type and shape to `place` in one of four ways. before() is called some time before the rest.
class Arrival {
 public:
  Arrival(World& world, BodyType type, const ShapeDef& shape, DVec3 place, How how)
      : world_(world), shape_(shape), place_(place), how_(how) {
    def_ = {.type = type, .pose = {.position = place}, .gravity_scale = 0};
    if (how == teleported) def_.pose.position = place + DVec3{30, 5, 0};
    ShapeDef first = shape;
    if (how == filter_opened) first.filter = kTouchesNothing;
    if (how == teleported || how == filter_opened) body = world.add_body(def_, first);
    if (how == shape_added) body = world.add_body(def_);
  }
  void happen() {
    if (how_ == added) body = world_.add_body(def_, shape_);
    if (how_ == teleported) world_.set_pose(body, {.position = place_});
    if (how_ == filter_opened) world_.set_filter(world_.shapes(body)[0], shape_.filter);
    if (how_ == shape_added) world_.add_shape(body, shape_);
  }

  BodyId body{};

 private:
  World& world_;
  ShapeDef shape_;
  DVec3 place_;
  How how_;
  BodyDef def_;
};

int count_begins(const World& world, BodyId a, BodyId b) {
  int count = 0;
  for (const ContactBegin& e : world.events().begins)
    count += (e.body_a == a && e.body_b == b) || (e.body_a == b && e.body_b == a);
  return count;
}
int count_entries(const World& world, ShapeId sensor, ShapeId visitor, bool begins = true) {
  int count = 0;
  for (const SensorTouch& e : world.events().sensors)
    count += e.begins == begins && e.sensor == sensor && e.visitor == visitor;
  return count;
}

TEST(Sleep, EndsUnderWhateverIsPutOntoASleeper) {
  std::mt19937 random(7);
  std::uniform_real_distribution<float> draw(-1, 1);
  for (const bool of_triangles : {false, true}) {
    for (const BodyType type : {BodyType::fixed, BodyType::kinematic, BodyType::dynamic}) {
      for (int how = 0; how < how_count; ++how) {
        if (of_triangles && type == BodyType::dynamic) continue;
        World world = make_world();
        add_ground(world);
        const float size = 0.5f + 0.2f * draw(random);
        const BodyId box = world.add_body({.pose = {.position = {0, double(size), 0}}},
                                          {.geometry = Box{{size, size, size}}});
        // Not by their middle, since nothing could push the box out of it.
        const DVec3 place{0.6 * double(size), double(1.7f * size + 0.2f * draw(random)),
                          0.1 * double(draw(random))};
        ShapeDef shape{.geometry = Box{{size, size, size}}};
        if (of_triangles) shape.geometry = slab(size);
        Arrival arrival(world, type, shape, place, How(how));
        run(world, 3);
        ASSERT_FALSE(world.is_awake(box));
        arrival.happen();
        bool woke = false;
        int told = 0;
        for (int i = 0; i < 60; ++i) {
          world.step(kStep);
          woke |= world.is_awake(box);
          told += count_begins(world, box, arrival.body);
        }
        EXPECT_TRUE(woke && told == 1) << kTypes[int(type)] << " " << kHows[how] << ", triangles "
                                       << of_triangles << ": woke " << woke << ", told " << told;
        if (of_triangles) continue;  // a slab may press it against the ground
        EXPECT_GT(length(world.pose(box).position - DVec3{0, double(size), 0}), 0.01)
            << kTypes[int(type)] << " " << kHows[how] << ", triangles " << of_triangles;
      }
    }
  }
}

TEST(Sleep, GoesOnBesideWhatIsPutThere) {
  World world = make_world();
  add_ground(world);
  const BodyId box = world.add_body({.pose = {.position = {0, 0.5, 0}}}, {.geometry = Box{}});
  run(world, 2);
  ASSERT_FALSE(world.is_awake(box));
  world.add_body({.type = BodyType::fixed, .pose = {.position = {1.05, 0.5, 0}}}, {.geometry = Box{}});
  world.add_body({.type = BodyType::fixed, .pose = {.position = {0, 0.5, 0}}},
                 {.geometry = Box{}, .sensor = true});
  world.add_body({.type = BodyType::fixed, .pose = {.position = {0, 0.5, 0}}},
                 {.geometry = Box{}, .filter = kTouchesNothing});
  run(world, 0.1);
  EXPECT_FALSE(world.is_awake(box));
}

// A level that begins asleep.
TEST(Sleep, OfWhatIsPutToSleepBeforeTheFirstStepGoesOn) {
  World world = make_world();
  std::vector<BodyId> boxes;
  for (int i = 0; i < 5; ++i)
    boxes.push_back(world.add_body({.pose = {.position = {0, 0.5 + i, 0}}}, {.geometry = Box{}}));
  add_ground(world);
  for (const BodyId box : boxes) world.set_awake(box, false);
  run(world, 1);
  for (const BodyId box : boxes) EXPECT_FALSE(world.is_awake(box));
  // They still wake each other.
  world.add_impulse(boxes[0], {0, 2000, 0});
  run(world, 0.1);
  for (const BodyId box : boxes) EXPECT_TRUE(world.is_awake(box));
}

TEST(Sleep, OfARopeEndsUnderWhatIsPutOntoIt) {
  for (const BodyType type : {BodyType::fixed, BodyType::kinematic}) {
    World world = make_world();
    add_ground(world);
    RopeDef rope;
    rope.points = {{-1, 0.05, 0}, {1, 0.05, 0}};
    rope.radius = 0.03f;
    rope.segments = 20;
    const SoftId id = world.add_rope(rope);
    run(world, 8);
    ASSERT_FALSE(world.soft_info(id).awake);
    world.add_body({.type = type, .pose = {.position = {0, 0.2, 0.02}}},
                   {.geometry = Box{{0.1f, 0.18f, 0.05f}}});
    world.step(kStep);
    EXPECT_TRUE(world.soft_info(id).awake);
  }
}

// --------------------------------------------------------------------------------------------------------- sensors

// Every type of sensor and of visitor, both still; the one or the other arrives.
TEST(Sensor, SeesWhatStandsStill) {
  for (const BodyType sensor_type : {BodyType::fixed, BodyType::kinematic, BodyType::dynamic}) {
    for (const BodyType visitor_type : {BodyType::fixed, BodyType::kinematic, BodyType::dynamic}) {
      for (int how = 0; how < how_count; ++how) {
        for (const bool sensor_comes : {false, true}) {
          World world = make_world({.gravity = {0, 0, 0}});
          const ShapeDef sensor{.geometry = Box{{2, 2, 2}}, .sensor = true},
              visitor{.geometry = Sphere{0.5f}};
          const BodyId stays = world.add_body({.type = sensor_comes ? visitor_type : sensor_type},
                                              sensor_comes ? visitor : sensor);
          Arrival arrival(world, sensor_comes ? sensor_type : visitor_type, sensor_comes ? sensor : visitor,
                          {0.5, 0.3, -1}, How(how));
          run(world, 2);
          arrival.happen();
          const ShapeId other = world.shapes(stays)[0], came = world.shapes(arrival.body)[0];
          const ShapeId senses = sensor_comes ? came : other, visits = sensor_comes ? other : came;
          ShapeId inside[2];
          EXPECT_EQ(world.sensor_visitors(senses, inside), 1u);
          EXPECT_EQ(inside[0], visits);
          int told = 0, left = 0;
          for (int i = 0; i < 30; ++i) {
            world.step(kStep);
            told += count_entries(world, senses, visits);
            left += count_entries(world, senses, visits, false);
          }
          EXPECT_TRUE(told == 1 && left == 0)
              << "sensor " << kTypes[int(sensor_type)] << ", visitor " << kTypes[int(visitor_type)] << ", "
              << (sensor_comes ? "sensor " : "visitor ") << kHows[how] << ": told " << told << ", left "
              << left;
          world.set_pose(arrival.body, {.position = {20, 0, 0}});
          world.step(kStep);
          EXPECT_EQ(count_entries(world, senses, visits, false), 1);
          EXPECT_EQ(world.sensor_visitors(senses, inside), 0u);
        }
      }
    }
  }
}

TEST(Sensor, SeesWhoIsInsideFromTheStart) {
  for (const BodyType sensor_type : {BodyType::fixed, BodyType::kinematic, BodyType::dynamic}) {
    for (const BodyType visitor_type : {BodyType::fixed, BodyType::kinematic, BodyType::dynamic}) {
      World world = make_world({.gravity = {0, 0, 0}});
      const BodyId visitor = world.add_body({.type = visitor_type}, {.geometry = Sphere{0.5f}});
      const BodyId sensor =
          world.add_body({.type = sensor_type}, {.geometry = Box{{2, 2, 2}}, .sensor = true});
      world.step(kStep);
      EXPECT_EQ(count_entries(world, world.shapes(sensor)[0], world.shapes(visitor)[0]), 1)
          << kTypes[int(sensor_type)] << " " << kTypes[int(visitor_type)];
    }
  }
}

// A step looks at the poses before it: who moves in with one step and halts is not looked at on the way.
TEST(Sensor, SeesKinematicBodiesThatMoveInAndHalt) {
  for (const bool sensor_moves : {false, true}) {
    for (const bool by_target : {false, true}) {
      World world = make_world({.gravity = {0, 0, 0}});
      const BodyId sensor =
          world.add_body({.type = BodyType::kinematic}, {.geometry = Box{}, .sensor = true});
      const BodyId visitor =
          world.add_body({.type = BodyType::kinematic, .pose = {.position = {3, 0, 0}}}, {.geometry = Box{}});
      const BodyId mover = sensor_moves ? sensor : visitor;
      run(world, 0.1);
      const Pose goal{.position = {sensor_moves ? 2.2 : 0.8, 0, 0}};
      world.move_kinematic(mover, goal, kStep);
      world.step(kStep);
      int told = count_entries(world, world.shapes(sensor)[0], world.shapes(visitor)[0]);
      if (by_target)
        world.move_kinematic(mover, world.pose(mover), kStep);
      else
        world.set_velocity(mover, {}, {});
      for (int i = 0; i < 3; ++i) {
        world.step(kStep);
        told += count_entries(world, world.shapes(sensor)[0], world.shapes(visitor)[0]);
      }
      EXPECT_EQ(told, 1) << sensor_moves << by_target;
    }
  }
}

// A crowd of every type in which half the shapes are sensors: who entered and did not leave is who is inside now.
TEST(Sensor, ListsWhoIsInside) {
  std::mt19937 random(11);
  std::uniform_real_distribution<float> draw(-1, 1);
  World world = make_world({.gravity = {0, 0, 0}});
  std::vector<BodyId> bodies;
  for (int i = 0; i < 60; ++i) {
    BodyDef def{.type = BodyType(i % 3)};
    def.pose.position = {3 * double(draw(random)), 3 * double(draw(random)), 3 * double(draw(random))};
    def.pose.orientation = normalized(Quat{draw(random), draw(random), draw(random), 1});
    if (def.type == BodyType::kinematic) def.linear_velocity = {draw(random), draw(random), draw(random)};
    ShapeDef shape{.geometry = Sphere{0.5f + 0.3f * draw(random)}, .sensor = i % 2 == 0};
    if (i % 4 > 1) shape.geometry = Box{{0.6f, 0.4f, 0.9f}};
    if (i % 20 == 1 && def.type != BodyType::dynamic) shape.geometry = slab(1);
    shape.filter.layer = 1u + unsigned(i % 5 == 0);
    if (i % 7 == 0) shape.filter.collides_with = 1;
    bodies.push_back(world.add_body(def, shape));
  }
  std::vector<std::vector<ShapeId>> inside(bodies.size());
  int compared = 0;
  for (int step = 0; step < 60; ++step) {
    // The events of a step are about the poses before it.
    std::vector<std::vector<ShapeId>> now(bodies.size());
    for (std::size_t k = 0; k < bodies.size(); ++k) {
      ShapeId list[64];
      const std::size_t count = world.sensor_visitors(world.shapes(bodies[k])[0], list);
      now[k].assign(list, list + count);
    }
    world.step(kStep);
    for (const SensorTouch& e : world.events().sensors) {
      for (std::size_t k = 0; k < bodies.size(); ++k) {
        if (world.shapes(bodies[k])[0] != e.sensor) continue;
        std::vector<ShapeId>& list = inside[k];
        if (e.begins)
          list.push_back(e.visitor);
        else
          list.erase(std::find(list.begin(), list.end(), e.visitor));
      }
    }
    for (std::size_t k = 0; k < bodies.size(); ++k) {
      std::sort(inside[k].begin(), inside[k].end(), [](ShapeId a, ShapeId b) { return a.index < b.index; });
      EXPECT_EQ(inside[k], now[k]) << "sensor " << k << " in step " << step;
      compared += int(now[k].size());
    }
  }
  EXPECT_GT(compared, 1000);
  EXPECT_EQ(world.sensor_visitors({}, {}), 0u);
  EXPECT_EQ(world.sensor_visitors(world.shapes(bodies[1])[0], {}), 0u);  // not a sensor
}

}  // namespace
}  // namespace gyre::laws::sleepers_test
