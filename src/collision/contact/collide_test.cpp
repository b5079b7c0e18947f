// The narrow-phase stage on hand-made scenes: positions of points, data carried from step to step, and recycled
// contacts against full updates.
#include "collision/contact/collide.h"

#include "base/memory/memory.h"
#include "collision/contact/collide_scene.h"
#include "collision/contact/contact_update.h"
#include "random.h"

#include <gtest/gtest.h>

#include <cstring>

namespace gyre::collide_test {
namespace {

using testing_random::Random;

const Box kGround{{10, 1, 10}};
const Box kCube{{0.5f, 0.5f, 0.5f}};

// Both anchors must be one point, and `separation` must be that of the surfaces.
void expect_consistent(CollideScene& scene, std::uint32_t a, std::uint32_t b) {
  const Manifold manifold = scene.manifold(a, b);
  const ColliderBody& body_a = scene.bodies[a];
  const ColliderBody& body_b = scene.bodies[b];
  const Vec3 apart = difference(body_b.pose * body_b.center, body_a.pose * body_a.center);
  EXPECT_NEAR(length(manifold.normal), 1.0f, 1.0e-5f);
  for (int i = 0; i < manifold.count; ++i) {
    EXPECT_LT(distance(manifold.points[i].from_a, manifold.points[i].from_b + apart), 1.0e-5f);
  }
}

TEST(Collide, CubeOnGround) {
  CollideScene scene;
  const auto ground = scene.add(kGround, {{0, -1, 0}, {}}, false);
  const auto cube = scene.add(kCube, {{2, 0.49, 3}, {}});
  scene.step();
  const Manifold manifold = scene.manifold(ground, cube);
  ASSERT_EQ(manifold.count, 4);
  EXPECT_NEAR(manifold.normal.y, 1.0f, 1.0e-6f);
  for (int i = 0; i < 4; ++i) {
    EXPECT_NEAR(manifold.points[i].separation, -0.01f, 1.0e-5f);
    EXPECT_NEAR(absolute(manifold.points[i].from_b.x), 0.5f, 1.0e-4f);
    EXPECT_NEAR(manifold.points[i].from_b.y, -0.495f, 1.0e-4f);
    EXPECT_NEAR(manifold.points[i].from_a.y, 0.995f, 1.0e-4f);
  }
  expect_consistent(scene, ground, cube);
  EXPECT_EQ(scene.contact(ground, cube)->touching, 1);
  EXPECT_TRUE(scene.changes.began.test(0));
  scene.step();
  EXPECT_FALSE(scene.changes.began.any());
}

TEST(Collide, NormalGoesFromTheLowerIndexToTheHigher) {
  CollideScene scene;
  const auto ball = scene.add(Sphere{0.5f}, {{0, 0.45, 0}, {}});
  const auto ground = scene.add(kGround, {{0, -1, 0}, {}}, false);
  scene.step();
  ASSERT_EQ(scene.manifold(ball, ground).count, 1);
  EXPECT_NEAR(scene.manifold(ball, ground).normal.y, -1.0f, 1.0e-5f);
  expect_consistent(scene, ball, ground);
}

TEST(Collide, CentreOfMassAndShapeMayLieOffTheOrigin) {
  CollideScene scene;
  const auto ground = scene.add(kGround, {{0, -1, 0}, {}}, false);
  const auto ball = scene.add(Sphere{0.5f}, {{1, 2.5, 0}, from_axis_angle({1, 0, 0}, 0.3f)}, true,
                              {rotate_inverse(from_axis_angle({1, 0, 0}, 0.3f), {0, -2, 0}), {}});
  scene.bodies[ball].center = {0.1f, -1.0f, 0.2f};
  scene.step();
  ASSERT_EQ(scene.manifold(ground, ball).count, 1);
  EXPECT_NEAR(scene.manifold(ground, ball).points[0].separation, 0.0f, 1.0e-5f);
  expect_consistent(scene, ground, ball);
}

TEST(Collide, CarriesImpulsesByFeature) {
  CollideScene scene;
  scene.recycle = false;
  const auto ground = scene.add(kGround, {{0, -1, 0}, {}}, false);
  const auto cube = scene.add(kCube, {{2, 0.499, 3}, from_axis_angle({0, 1, 0}, 0.2f)});
  scene.step();
  Contact& contact = *scene.contact(ground, cube);
  Manifold& before = scene.store.manifolds[contact.first_manifold];
  ASSERT_EQ(before.count, 4);
  for (int i = 0; i < 4; ++i) {
    before.points[i].normal_impulse = float(i + 1);
    before.points[i].total_impulse = 4.0f * float(i + 1);
    before.points[i].approach_speed = 3.0f;
  }
  before.friction_impulse = {1, 0.5f, 2};
  before.twist_impulse = 7;
  before.rolling_impulse = {0.25f, 0, 0.5f};
  before.total_friction = {9, 9, 9};
  before.sliding = 1;
  before.load_age = 0.75f;
  const Manifold old = before;
  scene.bodies[cube].pose.position.x += 0.02;
  scene.step();
  const Manifold now = scene.manifold(ground, cube);
  ASSERT_EQ(now.count, 4);
  EXPECT_EQ(now.load_age, 0.75f);
  for (int i = 0; i < 4; ++i) {
    int same = -1;
    for (int k = 0; k < 4; ++k) {
      if (old.points[k].feature == now.points[i].feature) same = k;
    }
    ASSERT_GE(same, 0);
    EXPECT_EQ(now.points[i].normal_impulse, old.points[same].normal_impulse);
    EXPECT_EQ(now.points[i].mean_impulse, old.points[same].mean_impulse);
    EXPECT_EQ(now.points[i].total_impulse, 0.0f);
    EXPECT_EQ(now.points[i].approach_speed, 0.0f);
    EXPECT_NEAR(now.points[i].from_a.x, old.points[same].from_a.x + 0.02f, 1.0e-4f);
  }
  EXPECT_NEAR(distance(now.friction_impulse, Vec3{1, 0, 2}), 0.0f, 1.0e-5f)
      << "turned into the tangent plane";
  EXPECT_EQ(now.twist_impulse, 7.0f);
  EXPECT_EQ(now.sliding, 1u);
  EXPECT_EQ(now.total_friction, Vec3{});
}

TEST(Collide, LoadFindsItsPlaceWhenFeaturesGetNewNames) {
  CollideScene scene;
  scene.recycle = false;
  const auto ground = scene.add(kGround, {{0, -1, 0}, {}}, false);
  const auto cube = scene.add(kCube, {{2, 0.499, 3}, {}});
  scene.step();
  Manifold& before = scene.store.manifolds[scene.contact(ground, cube)->first_manifold];
  for (int i = 0; i < 4; ++i) {
    before.points[i].normal_impulse = before.points[i].from_b.x > 0 ? 2.0f : 1.0f;
    before.points[i].feature = 0xabcd0000u + std::uint32_t(i);
  }
  scene.step();
  const Manifold now = scene.manifold(ground, cube);
  ASSERT_EQ(now.count, 4);
  for (int i = 0; i < 4; ++i)
    EXPECT_EQ(now.points[i].normal_impulse, now.points[i].from_b.x > 0 ? 2.0f : 1.0f);
}

// ------------------------------------------------------------------------------------------------------- recycling

struct Kinds {
  AnyShape a, b;
  double height;  // of b's middle above a's, when they touch
};

std::vector<Kinds> flat_kinds() {
  return {{kGround, kCube, 1.5},
          {kCube, kCube, 1.0},
          {Plane{{0, 1, 0}, 0.0f}, kCube, 0.5},
          {kGround, Cylinder{0.4f, 0.5f}, 1.4},
          {kGround, Cone{0.4f, 0.5f}, 1.4}};
}
std::vector<Kinds> all_kinds() {
  std::vector<Kinds> kinds = flat_kinds();
  kinds.push_back({kGround, Sphere{0.5f}, 1.5});
  kinds.push_back({kGround, Capsule{0.3f, 0.5f}, 1.8});
  kinds.push_back({Sphere{0.5f}, Sphere{0.25f}, 0.75});
  return kinds;
}

// Compares with a scene that updates every contact in full.
void expect_same_contact(CollideScene& scene, std::uint32_t a, std::uint32_t b, float tolerance) {
  CollideScene fresh;
  fresh.shapes = scene.shapes;
  fresh.bodies = scene.bodies;
  fresh.proxies = scene.proxies;
  fresh.recycle = false;
  fresh.step();
  const Manifold recycled = scene.manifold(a, b);
  const Manifold full = fresh.manifold(a, b);
  ASSERT_EQ(recycled.count, full.count);
  EXPECT_LT(distance(recycled.normal, full.normal), 1.1e-3f);
  for (int i = 0; i < full.count; ++i) {
    int same = -1;
    for (int k = 0; k < recycled.count; ++k) {
      if (recycled.points[k].feature == full.points[i].feature) same = k;
    }
    ASSERT_GE(same, 0);
    EXPECT_NEAR(recycled.points[same].separation, full.points[i].separation, tolerance);
    EXPECT_LT(distance(recycled.points[same].from_a, full.points[i].from_a), 1.5e-3f);
    EXPECT_LT(distance(recycled.points[same].from_b, full.points[i].from_b), 1.5e-3f);
  }
}

TEST(CollideRecycling, AgreesWithFullUpdates) {
  Random random;
  for (const Kinds& kinds : flat_kinds()) {
    int recycled = 0;
    for (int round = 0; round < 40; ++round) {
      CollideScene scene;
      const Pose base{{3, 1, -2}, std::holds_alternative<Plane>(kinds.a) ? Quat{} : random.turn(1.0f)};
      const auto a = scene.add(kinds.a, base);
      const auto b = scene.add(kinds.b, base * Transform{{0.1f, float(kinds.height) + 0.001f, 0.05f},
                                                         from_axis_angle({0, 1, 0}, 0.4f)});
      scene.step();
      ASSERT_GE(scene.manifold(a, b).count, 3);
      // A small motion of B relative to A, in any direction.
      Pose& pose = scene.bodies[b].pose;
      pose.position += random.vector(-1.0e-4f, 1.0e-4f);
      pose.orientation = normalized(random.turn(2.0e-4f) * pose.orientation);
      scene.step();
      recycled += scene.contact(a, b)->recycled;
      expect_same_contact(scene, a, b, 1.0e-6f);
      expect_consistent(scene, a, b);
    }
    EXPECT_GT(recycled, 20);
  }
}

TEST(CollideRecycling, ErrorsDoNotAddUp) {
  CollideScene scene;
  const auto ground = scene.add(kGround, {{0, -1, 0}, {}}, false);
  const auto cube = scene.add(kCube, {{0, 0.5, 0}, {}});
  scene.step();
  int recycled = 0, full = 0;
  for (int step = 0; step < 400; ++step) {
    // Creeps sideways, rotates slowly about the normal and rocks a little.
    Pose& pose = scene.bodies[cube].pose;
    pose.position.x += 2.0e-5;
    pose.position.y = 0.5 - 1.0e-4 * double(step % 50);
    pose.orientation = normalized(from_axis_angle({0, 1, 0}, 2.0e-5f) * pose.orientation);
    scene.step();
    (scene.contact(ground, cube)->recycled != 0 ? recycled : full) += 1;
    const Manifold manifold = scene.manifold(ground, cube);
    ASSERT_EQ(manifold.count, 4);
    for (int i = 0; i < 4; ++i) {
      ASSERT_NEAR(manifold.points[i].separation, float(pose.position.y) - 0.5f, 1.0e-6f);
      ASSERT_NEAR(length(manifold.points[i].from_b), std::sqrt(0.75f), 2.0e-3f);
    }
  }
  EXPECT_GT(recycled, 200);
  EXPECT_GT(full, 5);
}

TEST(CollideRecycling, PairsInRigidRotationAreRecycled) {
  CollideScene scene;
  const Transform local{{0.2f, 1.5f, 0.1f}, {}};
  const Pose start{{5, 5, 5}, {}};
  const auto a = scene.add(kGround, start);
  const auto b = scene.add(kCube, start * local);
  scene.step();
  for (int step = 1; step < 60; ++step) {
    const Pose base{{5, 5 + 0.1 * step, 5}, from_axis_angle({1, 2, 3}, 0.05f * float(step))};
    scene.bodies[a].pose = base;
    scene.bodies[b].pose = base * local;
    scene.step();
    ASSERT_EQ(scene.contact(a, b)->recycled, 1);
    expect_same_contact(scene, a, b, 5.0e-6f);
    expect_consistent(scene, a, b);
    EXPECT_LT(distance(scene.manifold(a, b).normal, rotate(base.orientation, {0, 1, 0})), 1.0e-5f);
  }
}

TEST(CollideRecycling, KeepsImpulsesAndClearsSums) {
  CollideScene scene;
  const auto ground = scene.add(kGround, {{0, -1, 0}, {}}, false);
  const auto cube = scene.add(kCube, {{0, 0.5, 0}, {}});
  scene.step();
  Manifold& before = scene.store.manifolds[scene.contact(ground, cube)->first_manifold];
  before.points[2].normal_impulse = 3.0f;
  before.points[2].mean_impulse = 2.5f;
  before.load_age = 0.75f;
  before.points[2].total_impulse = 12.0f;
  before.total_friction = {1, 0, 0};
  before.friction_impulse = {0.5f, 0, 0};
  scene.step();
  ASSERT_EQ(scene.contact(ground, cube)->recycled, 1);
  const Manifold now = scene.manifold(ground, cube);
  EXPECT_EQ(now.points[2].normal_impulse, 3.0f);
  EXPECT_EQ(now.points[2].total_impulse, 0.0f);
  EXPECT_EQ(now.points[2].mean_impulse, 2.5f);
  EXPECT_EQ(now.load_age, 0.75f);
  EXPECT_EQ(now.total_friction, Vec3{});
  EXPECT_EQ(now.friction_impulse, (Vec3{0.5f, 0, 0}));
}

// At any rolling speed: a contact that lags behind would brake the body.
TEST(CollideRecycling, RollingContactsDoNotLag) {
  const std::vector<AnyShape> rollers = {Sphere{0.5f}, Capsule{0.5f, 0.4f}, Cylinder{0.5f, 0.4f}};
  for (const AnyShape& roller : rollers) {
    for (const bool ground_first : {true, false}) {
      CollideScene scene;
      // The axis of capsules and cylinders is local y; here it lies along z.
      const Quat lying = from_axis_angle({1, 0, 0}, 0.5f * kPi);
      std::uint32_t ground = 0, ball = 1;
      if (ground_first) ground = scene.add(kGround, {{0, -1, 0}, {}}, false);
      ball = scene.add(roller, {{0, 0.5, 0}, lying});
      if (!ground_first) ground = scene.add(kGround, {{0, -1, 0}, {}}, false);
      scene.step();
      int recycled = 0;
      for (int step = 1; step < 200; ++step) {
        scene.bodies[ball].pose = {{0.5 * 1.0e-4 * step, 0.5 - 1.0e-5 * (step % 7), 0},
                                   normalized(from_axis_angle({0, 0, 1}, -1.0e-4f * float(step)) * lying)};
        scene.step();
        recycled += scene.contact(ground, ball)->recycled;
        const Manifold manifold = scene.manifold(ground, ball);
        ASSERT_GE(manifold.count, 1);
        for (int i = 0; i < manifold.count; ++i) {
          const Vec3 from_ball = ground_first ? manifold.points[i].from_b : manifold.points[i].from_a;
          ASSERT_NEAR(from_ball.x, 0.0f, 6.0e-5f) << "the contact lags behind";
          ASSERT_NEAR(manifold.points[i].separation, -1.0e-5f * float(step % 7), 3.0e-6f);
        }
      }
      if (roller.index() != rollers[2].index()) {
        EXPECT_GT(recycled, 150);
      }
    }
  }
}

TEST(CollideRecycling, NothingIsMissedThatComesSlowly) {
  for (const Kinds& kinds : all_kinds()) {
    CollideScene scene, fresh;
    fresh.recycle = false;
    for (CollideScene* const each : {&scene, &fresh}) {
      each->add(kinds.a, {{0, 0, 0}, {}}, false);
      each->add(kinds.b, {{0.1, kinds.height + 0.3, 0.2}, from_axis_angle({1, 0, 0.3f}, 0.01f)});
    }
    int skipped = 0;
    for (int step = 0; step < 1600; ++step) {
      for (CollideScene* const each : {&scene, &fresh}) {
        each->bodies[1].pose.position.y -= 2.5e-4;
        each->bodies[1].linear_velocity = {0, -0.015f, 0};
        each->step();
      }
      const Manifold full = fresh.manifold(0, 1);
      const Manifold recycled = scene.manifold(0, 1);
      float nearest_full = 1.0f, nearest_recycled = 1.0f;
      for (int i = 0; i < full.count; ++i) nearest_full = min(nearest_full, full.points[i].separation);
      for (int i = 0; i < recycled.count; ++i)
        nearest_recycled = min(nearest_recycled, recycled.points[i].separation);
      // Within the speculative distance: the share of the size and the translation of the step.
      const float size = smallest(Vec3{scene.shapes[1].size, 0.5f, 0.5f});
      if (nearest_full < kSpeculativeShare * size) {
        ASSERT_NEAR(nearest_recycled, nearest_full, 1.0e-5f) << step;
      }
      skipped +=
          scene.contact(0, 1) != nullptr && scene.contact(0, 1)->recycled != 0 && recycled.count == 0 ? 1 : 0;
    }
    EXPECT_GT(skipped, 5) << "nothing was recycled while clear " << kinds.a.index() << " " << kinds.b.index();
  }
}

// --------------------------------------------------------------------------------------------------- from step to step

TEST(Collide, SleepingPairsAreLeftAlone) {
  CollideScene scene;
  const auto ground = scene.add(kGround, {{0, -1, 0}, {}}, false);
  const auto cube = scene.add(kCube, {{0, 0.5, 0}, {}});
  scene.step();
  Manifold& manifold = scene.store.manifolds[scene.contact(ground, cube)->first_manifold];
  manifold.points[0].total_impulse = 5.0f;
  scene.bodies[cube].awake = false;
  const Manifold before = manifold;
  scene.step();
  EXPECT_EQ(std::memcmp(&before, &scene.store.manifolds[scene.contact(ground, cube)->first_manifold],
                        sizeof before),
            0);
  EXPECT_EQ(scene.contact(ground, cube)->touching, 1);
  EXPECT_FALSE(scene.changes.ended.any());
}

TEST(Collide, ReportsBeganEndedAndGone) {
  CollideScene scene;
  const auto ground = scene.add(kGround, {{0, -1, 0}, {}}, false);
  const auto cube = scene.add(kCube, {{0, 0.5, 0}, {}});
  scene.step();
  EXPECT_TRUE(scene.changes.began.test(0));
  scene.bodies[cube].pose.position.y = 0.55;
  scene.step();
  EXPECT_TRUE(scene.changes.ended.test(0));
  EXPECT_FALSE(scene.changes.gone.any());
  EXPECT_NE(scene.contact(ground, cube), nullptr);
  scene.bodies[cube].pose.position.y = 0.5;
  scene.step();
  EXPECT_TRUE(scene.changes.began.test(0));
  scene.bodies[cube].pose.position.y = 5.0;
  scene.step();
  EXPECT_TRUE(scene.changes.gone.test(0));
  EXPECT_TRUE(scene.changes.ended.test(0));
  EXPECT_EQ(scene.contact(ground, cube), nullptr);
}

TEST(Collide, LoadMeansTouching) {
  CollideScene scene;
  const auto ground = scene.add(kGround, {{0, -1, 0}, {}}, false);
  const auto cube = scene.add(kCube, {{0, 0.5, 0}, {}});
  scene.step();
  scene.bodies[cube].pose.position.y = 0.51;
  for (const bool loaded : {true, false}) {
    Manifold& manifold = scene.store.manifolds[scene.contact(ground, cube)->first_manifold];
    if (loaded) manifold.points[1].total_impulse = 1.0f;
    scene.step();
    EXPECT_EQ(scene.contact(ground, cube)->touching, loaded ? 1 : 0);
  }
}

TEST(Collide, ChangedFilterEndsTheContact) {
  CollideScene scene;
  scene.add(kGround, {{0, -1, 0}, {}}, false);
  const auto cube = scene.add(kCube, {{0, 0.5, 0}, {}});
  scene.step();
  EXPECT_EQ(scene.store.live, 1u);
  scene.proxies[cube].filter.collides_with = 0;
  scene.step();
  EXPECT_EQ(scene.store.live, 0u);
  EXPECT_TRUE(scene.changes.ended.test(0));
}

TEST(Collide, SensorsReportAndKeepNothing) {
  CollideScene scene;
  const auto zone = scene.add(kCube, {{0, 0, 0}, {}}, false);
  scene.proxies[zone].sensor = true;
  const auto ball = scene.add(Sphere{0.25f}, {{0.749, 0, 0}, {}});
  scene.step();
  EXPECT_TRUE(scene.changes.began.test(0));
  EXPECT_EQ(scene.contact(zone, ball)->manifold_count, 0);
  scene.bodies[ball].pose.position.x = 0.7501;
  scene.step();
  EXPECT_TRUE(scene.changes.ended.test(0)) << "near is not inside";
}

TEST(Collide, FastThingsAreSeenFromAfar) {
  CollideScene scene;
  const auto ground = scene.add(kGround, {{0, -1, 0}, {}}, false);
  const auto ball = scene.add(Sphere{0.5f}, {{0, 0.65, 0}, {}});
  scene.step();
  EXPECT_EQ(scene.manifold(ground, ball).count, 0);
  scene.bodies[ball].linear_velocity = {0, -12, 0};  // 20 cm a step
  scene.step();
  EXPECT_EQ(scene.manifold(ground, ball).count, 1);
  EXPECT_EQ(scene.contact(ground, ball)->touching, 0);
}

TEST(Collide, ExactFarFromTheOrigin) {
  for (const double far : {0.0, 1.0e6}) {
    CollideScene scene;
    const auto plane =
        scene.add(Plane{{0, 1, 0}, 0.0f}, {{0, far, 0}, from_axis_angle({0, 0, 1}, 0.25f)}, false);
    const DVec3 normal(rotate(scene.bodies[plane].pose.orientation, {0, 1, 0}));
    const DVec3 along(rotate(scene.bodies[plane].pose.orientation, {1, 0, 0}));
    const DVec3 middle = scene.bodies[plane].pose.position + far * along + 0.49 * normal;
    const auto ball = scene.add(Sphere{0.5f}, {middle, {}});
    const double height = dot(normal, middle - scene.bodies[plane].pose.position) / dot(normal, normal);
    scene.step();
    ASSERT_EQ(scene.manifold(plane, ball).count, 1);
    EXPECT_NEAR(scene.manifold(plane, ball).points[0].separation, height - 0.5, 1.0e-6);
    // Midway between the surfaces.
    EXPECT_NEAR(length(scene.manifold(plane, ball).points[0].from_b), 0.5 + 0.5 * (height - 0.5), 1.0e-6);
  }
}

// The same scene a thousand times larger or smaller gives the same decisions.
TEST(Collide, KnowsNoAbsoluteLength) {
  std::vector<int> decisions[3];
  for (int k = 0; k < 3; ++k) {
    const float scale = k == 0 ? 1.0f : k == 1 ? 1024.0f : 1.0f / 1024.0f;
    CollideScene scene;
    scene.add(Box{scale * kGround.half_extents}, {{0, -double(scale), 0}, {}}, false);
    scene.add(Box{scale * kCube.half_extents}, {{0, 0.6 * double(scale), 0}, {}});
    for (int step = 0; step < 120; ++step) {
      scene.bodies[1].pose.position.y -= 0.001 * double(scale);
      scene.bodies[1].linear_velocity = {0, -0.06f * scale, 0};
      scene.step();
      const Contact* const contact = scene.contact(0, 1);
      if (contact == nullptr) continue;
      decisions[k].push_back(scene.manifold(0, 1).count + 16 * contact->recycled + 32 * contact->touching);
    }
  }
  EXPECT_EQ(decisions[0], decisions[1]);
  EXPECT_EQ(decisions[0], decisions[2]);
  EXPECT_GT(decisions[0].size(), 100u);
}

TEST(Collide, FatBoxesKeepTheirPromise) {
  Random random;
  int near = 0;
  for (int round = 0; round < 4000; ++round) {
    CollideScene scene;
    const auto shape = [&]() -> AnyShape {
      const float r = random.real(0.05f, 1.0f);
      switch (random.next(4)) {
        case 0:
          return Sphere{r};
        case 1:
          return Capsule{r, random.real(0.1f, 2.0f)};
        case 2:
          return Cylinder{r, random.real(0.1f, 2.0f)};
        default:
          return Box{random.vector(0.05f, 1.0f)};
      }
    };
    const double far = round % 3 == 0 ? 1.0e5 : 0.0;
    const auto a = scene.add(shape(), {{far, 0, 0}, random.turn(3.0f)});
    const auto b = scene.add(
        shape(), {{far + 1.5 * double(random.real(0, 2)), double(random.real(0, 1)), 0}, random.turn(3.0f)});
    for (const auto i : {a, b}) {
      scene.bodies[i].linear_velocity = random.vector(-20, 20);
      scene.bodies[i].angular_velocity = random.vector(-20, 20);
    }
    scene.step();
    const bool pair = scene.contact(a, b) != nullptr;
    // Tests the shapes themselves, with a stage whose boxes are endless.
    CollideScene endless;
    endless.shapes = scene.shapes;
    endless.bodies = scene.bodies;
    endless.proxies = scene.proxies;
    for (Proxy& proxy : endless.proxies) proxy.fat_box = {{-1e9f, -1e9f, -1e9f}, {1e9f, 1e9f, 1e9f}};
    add_contact(endless.store, pair_key(a, b), {a, b, false, false, {}});
    endless.recycle = false;
    endless.update_contacts();
    const Manifold manifold = endless.manifold(a, b);
    bool needed = false;
    // The approach of each point counts, so the smallest approach along the normal.
    for (int i = 0; i < manifold.count; ++i) needed = needed || manifold.points[i].separation <= 0.0f;
    const float margin = kSpeculativeShare * smaller_size(scene.shapes[a].size, scene.shapes[b].size);
    for (int i = 0; i < manifold.count; ++i) {
      const ColliderBody& body_a = scene.bodies[a];
      const ColliderBody& body_b = scene.bodies[b];
      const Vec3 speed = body_b.linear_velocity + cross(body_b.angular_velocity, manifold.points[i].from_b) -
                         body_a.linear_velocity - cross(body_a.angular_velocity, manifold.points[i].from_a);
      if (manifold.points[i].separation + dot(speed, manifold.normal) * scene.seconds <= margin)
        needed = true;
    }
    near += needed ? 1 : 0;
    ASSERT_TRUE(pair || !needed) << round;
  }
  EXPECT_GT(near, 500);
}

TEST(Collide, ThreadsChangeNothing) {
  std::vector<Manifold> results[4];
  for (int threads = 1; threads <= 4; ++threads) {
    Random random;
    CollideScene scene(threads);
    scene.add(kGround, {{0, -1, 0}, {}}, false);
    for (int i = 0; i < 400; ++i) {
      scene.add(kCube, {{double(random.real(-5, 5)), double(random.real(0, 5)), double(random.real(-5, 5))},
                        random.turn(2.0f)});
    }
    for (int step = 0; step < 5; ++step) {
      for (ColliderBody& body : scene.bodies) {
        if (!body.awake) continue;
        body.pose.position += random.vector(-0.01f, 0.01f);
      }
      scene.step();
    }
    for (std::size_t i = 0; i < scene.store.manifolds.size(); ++i)
      results[threads - 1].push_back(scene.store.manifolds[i]);
    ASSERT_EQ(results[0].size(), results[threads - 1].size());
    ASSERT_EQ(
        std::memcmp(results[0].data(), results[threads - 1].data(), results[0].size() * sizeof(Manifold)), 0);
  }
}

TEST(Collide, AllocatesNothingOnceWarm) {
  CollideScene scene(2);
  Random random;
  scene.add(kGround, {{0, -1, 0}, {}}, false);
  for (int i = 0; i < 100; ++i) {
    scene.add(kCube, {{double(random.real(-3, 3)), double(random.real(0, 3)), double(random.real(-3, 3))},
                      random.turn(2.0f)});
  }
  for (int step = 0; step < 3; ++step) scene.step();
  const std::uint64_t before = allocation_count();
  for (int step = 0; step < 5; ++step) scene.update_contacts();
  EXPECT_EQ(allocation_count(), before);
}

TEST(Collide, SmallerSizeIgnoresMissingSizes) {
  EXPECT_EQ(smaller_size(1.0f, 2.0f), 1.0f);
  EXPECT_EQ(smaller_size(0.0f, 2.0f), 2.0f);
  EXPECT_EQ(smaller_size(3.0f, kUnbounded), 3.0f);
  EXPECT_EQ(smaller_size(0.0f, kUnbounded), 0.0f);
}

}  // namespace
}  // namespace gyre::collide_test
