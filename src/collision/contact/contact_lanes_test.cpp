// Bounds of the approach of two bodies in a step: tight for bodies that move together, and never too small.
#include "collision/contact/collide_scene.h"
#include "geometry/shape/support.h"
#include "random.h"

#include <gtest/gtest.h>

namespace gyre::contact_lanes_test {
namespace {

using testing_random::Random;

const Box kCube{{0.5f, 0.5f, 0.5f}};

// A cube 4 cm above a turntable at 3 rad/s, 4 m from its axis: beyond the speculative distance of pairs that do not
// close.
struct Turntable {
  CollideScene scene;
  std::uint32_t table = scene.add(Box{{5, 0.5f, 5}}, {{0, -0.5, 0}, {}});
  std::uint32_t cube = scene.add(kCube, {{4, 0.54, 0}, {}});

  Turntable(Vec3 velocity, Vec3 spin) {
    scene.bodies[table].angular_velocity = {0, 3, 0};
    scene.bodies[cube].linear_velocity = velocity;
    scene.bodies[cube].angular_velocity = spin;
    scene.step();
  }
  int points() { return scene.manifold(table, cube).count; }
};

TEST(Closing, RigidCoRotationDoesNotClose) { EXPECT_EQ(Turntable({0, 0, -12}, {0, 3, 0}).points(), 0); }
TEST(Closing, SlidingDoesNotClose) {
  EXPECT_EQ(Turntable({0, 0, 0}, {0, 0, 0}).points(), 0);
  EXPECT_EQ(Turntable({0, 0, 12}, {0, -3, 0}).points(), 0);
}
TEST(Closing, ApproachAndTiltClose) {
  EXPECT_EQ(Turntable({0, -3, -12}, {0, 3, 0}).points(), 4);
  EXPECT_GT(Turntable({0, 0, -12}, {6, 3, 0}).points(), 0);
}
TEST(Closing, SeparationDoesNotClose) { EXPECT_EQ(Turntable({0, 6, -12}, {0, 3, 0}).points(), 0); }

// Two balls of 0.5 m that are 0.1 m apart and close by 0.15 in the step, the second `aside` from its body's origin.
int points_of_balls(float aside) {
  CollideScene scene;
  scene.add(Sphere{0.5f}, {});
  scene.add(Sphere{0.5f}, {{1.1 + double(aside), 0, 0}, {}}, true, {{-aside, 0, 0}, {}});
  scene.bodies[1].linear_velocity = {-9, 0, 0};
  scene.step();
  return scene.manifold(0, 1).count;
}
TEST(Closing, BodiesWhoseBallsMeetInTheStepAreUpdated) {
  EXPECT_EQ(points_of_balls(0.0f), 1);
  EXPECT_EQ(points_of_balls(1.0f), 1);
}

// A body that slides far above a table needs no points; but the update searched only up to the gap, and when the body
// falls the next update must see it.
TEST(Closing, AnEmptyUpdateSearchedUpToTheGap) {
  for (const int width : {1, 0}) {
    CollideScene scene;
    scene.width = width;
    const std::uint32_t table = scene.add(Box{{5, 0.5f, 5}}, {{0, -0.5, 0}, {}}, false);
    const std::uint32_t cube = scene.add(kCube, {{0, 0.53, 0}, {}});
    scene.bodies[cube].linear_velocity = {6, 0, 0};
    scene.step();
    ASSERT_NE(scene.contact(table, cube), nullptr);
    EXPECT_EQ(scene.manifold(table, cube).count, 0);
    scene.bodies[cube].pose.position.x = 0.1;
    scene.bodies[cube].linear_velocity = {0, -0.84f, 0};
    scene.step();
    EXPECT_EQ(scene.manifold(table, cube).count, 4);
  }
}

// A level beam of 2 m, 12 cm above a floor, rotates by 0.15 rad in the step: its end, 1 m away, comes down by as much.
TEST(Closing, ABeamThatTiltsIsSeenByItsEnd) {
  CollideScene scene;
  const std::uint32_t floor = scene.add(Box{{5, 0.5f, 5}}, {{0, -0.5, 0}, {}}, false);
  const std::uint32_t beam = scene.add(Box{{1, 0.2f, 0.2f}}, {{0, 0.32, 0}, {}});
  scene.bodies[beam].angular_velocity = {0, 0, 9};
  scene.step();
  EXPECT_GT(scene.manifold(floor, beam).count, 0);
}

struct Pair {
  AnyShape shapes[2];
  ColliderBody bodies[2];
};

Pair random_pair(Random& random) {
  const AnyShape kinds[] = {kCube,        Box{{0.3f, 0.7f, 0.4f}}, Box{{1, 0.3f, 0.6f}},
                            Sphere{0.5f}, Capsule{0.3f, 0.4f},     Cylinder{0.4f, 0.5f}};
  Pair pair;
  for (int side = 0; side < 2; ++side) {
    pair.shapes[side] = kinds[random.next(6)];
    ColliderBody& body = pair.bodies[side];
    body.pose.orientation = random.turn(3);
    body.center = random.vector(-0.3f, 0.3f);
    body.linear_velocity = random.vector(-5, 5);
    body.angular_velocity = random.vector(-5, 5);
  }
  // Often both rotate nearly alike.
  if (random.next(2) == 0)
    pair.bodies[1].angular_velocity = pair.bodies[0].angular_velocity + random.vector(-1, 1);
  pair.bodies[1].pose.position = DVec3(random.real(0.5f, 2.5f) * normalized(random.vector(-1, 1)));
  return pair;
}

// The number of points after an update of a pair.
int points_of(const Pair& pair, CollideScene& scene) {
  for (int side = 0; side < 2; ++side) {
    scene.add(pair.shapes[side], pair.bodies[side].pose, true, {pair.bodies[side].center, {}});
    scene.bodies.back().linear_velocity = pair.bodies[side].linear_velocity;
    scene.bodies.back().angular_velocity = pair.bodies[side].angular_velocity;
  }
  scene.step();
  return scene.manifold(0, 1).count;
}

float nearest_point(CollideScene& scene) {
  const Manifold manifold = scene.manifold(0, 1);
  float nearest = 1.0f;
  for (int i = 0; i < manifold.count; ++i) nearest = min(nearest, manifold.points[i].separation);
  return nearest;
}

// The pair after a step of uniform motion, at rest.
Pair moved(Pair pair, float seconds) {
  for (ColliderBody& body : pair.bodies) {
    const DVec3 center = body.pose * body.center + DVec3(seconds * body.linear_velocity);
    body.pose.orientation =
        normalized(from_rotation_vector(seconds * body.angular_velocity) * body.pose.orientation);
    body.pose.position = center - DVec3(rotate(body.pose.orientation, body.center));
    body.linear_velocity = body.angular_velocity = {};
  }
  return pair;
}

// True if the approach exceeds what updates search; CCD handles it.
bool too_fast(const CollideScene& scene) {
  const ColliderBody& a = scene.bodies[0];
  const ColliderBody& b = scene.bodies[1];
  const float fastest = length(b.linear_velocity - a.linear_velocity) +
                        length(a.angular_velocity) * a.bounding_radius +
                        length(b.angular_velocity) * b.bounding_radius;
  return scene.seconds * fastest > kMaxApproach * min(scene.shapes[0].size, scene.shapes[1].size);
}

TEST(Closing, PairsThatMeetInAStepHavePointsBefore) {
  Random random;
  int met = 0, unseen = 0;
  for (int trial = 0; trial < 4000; ++trial) {
    const Pair pair = random_pair(random);
    CollideScene before, narrow, after;
    const bool seen = points_of(pair, before) > 0;
    // One lane, which searches boxes one by one, gives the same.
    narrow.width = 1;
    EXPECT_EQ(points_of(pair, narrow) > 0, seen);
    if (before.contact(0, 1) != nullptr) {
      EXPECT_EQ(narrow.contact(0, 1)->cached_distance, before.contact(0, 1)->cached_distance);
    }
    unseen += seen ? 0 : 1;
    points_of(moved(pair, before.seconds), after);
    if (nearest_point(after) > 0.0f || too_fast(before)) continue;
    ++met;
    EXPECT_TRUE(seen) << trial << ": " << nearest_point(after);
  }
  EXPECT_GT(met, 600);
  EXPECT_GT(unseen, 600);
}

}  // namespace
}  // namespace gyre::contact_lanes_test
