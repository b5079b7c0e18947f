// CCD: nothing passes a thin wall at any speed, sliding bodies keep sliding, and times of impact agree with dense
// sampling.
#include "collision/continuous/continuous.h"

#include "base/memory/memory.h"
#include "collision/broadphase/fat_box.h"
#include "geometry/testing/mesh_test_scenes.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <vector>

namespace gyre::continuous_test {
namespace {

using test::Random;

// ------------------------------------------------------------------------------------------------- time of impact

AnyShape random_convex(Random& random) {
  const float r = random.between(0.05f, 0.6f), h = random.between(0.05f, 1.0f);
  switch (int(random.between(0, 5.99f))) {
    case 0:
      return Sphere{r};
    case 1:
      return Capsule{r, h};
    case 2:
      return Cylinder{r, h};
    case 3:
      return Cone{r, h};
    case 4:
      return Box{{r, h, random.between(0.01f, 0.5f)}, 0.0f};
    default:
      return Box{{0.3f, 0.3f, h + 0.1f}, 0.1f};
  }
}

// Draws stand in separate statements, since compilers choose the order of arguments.
void expect_agreement_with_sampling(int rounds, int samples) {
  Random random{7};
  int hits = 0, misses = 0;
  for (int round = 0; round < rounds; ++round) {
    const Shape shape_a = make_shape(random_convex(random));
    const bool plane = round % 5 == 0;
    const Shape shape_b =
        make_shape(plane ? AnyShape(Plane{random.direction(), 0.3f}) : random_convex(random));
    const double far = round % 3 == 0 ? 1.0e5 : 0.0;
    const float away = random.between(2.0f, 5.0f);
    const Vec3 start = away * random.direction();
    const Sweep a{{DVec3{far, 0, 0} + DVec3(start), random.rotation()},
                  random.in_box(0.2f),
                  -1.5f * start + random.in_box(1.0f),
                  random.in_box(round % 2 == 0 ? 0.3f : 3.0f)};
    const Sweep b{{{far, 0, 0}, random.rotation()},
                  {},
                  plane ? Vec3{} : random.in_box(1.0f),
                  plane ? Vec3{} : random.in_box(1.0f)};
    const SweptShape swept_a = make_swept_shape(shape_a, {random.in_box(0.1f), random.rotation()}, a);
    const SweptShape swept_b = make_swept_shape(shape_b, {}, b);
    const double target = 1.0e-3;
    if (find_gap(swept_a, swept_b, 0.0, 10.0).distance < 0.01) continue;
    const Impact impact = time_of_impact(swept_a, swept_b, 0.0, 1.0, target);
    (impact.hit ? hits : misses) += 1;
    for (int i = 0; i <= samples; ++i) {
      const double time = double(i) / double(samples) * (impact.hit ? impact.time : 1.0);
      EXPECT_GE(find_gap(swept_a, swept_b, time, 10.0).distance, 0.98 * target) << round << " at " << time;
    }
    if (impact.hit) {
      EXPECT_LE(find_gap(swept_a, swept_b, impact.time, 10.0).distance, 1.3 * target) << round;
    }
  }
  EXPECT_GT(hits, rounds / 4);
  EXPECT_GT(misses, rounds / 15);
}
TEST(TimeOfImpact, AgreesWithDenseSampling) { expect_agreement_with_sampling(300, 400); }
TEST(LongTimeOfImpact, AgreesWithDenseSampling) { expect_agreement_with_sampling(100000, 400); }

TEST(TimeOfImpact, PoseAtRotatesAboutTheCentreOfMass) {
  const Sweep sweep{
      {{1, 2, 3}, from_axis_angle({1, 0, 1}, 0.5f)}, {0.3f, -0.2f, 0.1f}, {5, 0, -2}, {0, 2.0f, 0.5f}};
  const DVec3 center = sweep.pose * sweep.center;
  for (const double time : {0.0, 0.25, 1.0}) {
    const Pose pose = pose_at(sweep, time);
    EXPECT_LT(length(pose * sweep.center - (center + time * DVec3(sweep.translation))), 1.0e-6);
    const Vec3 rotation = to_rotation_vector(pose.orientation * conjugate(sweep.pose.orientation));
    EXPECT_LT(distance(rotation, float(time) * sweep.rotation), 1.0e-5f);
  }
}

// ------------------------------------------------------------------------------------------------------- the stage

class Scene {
 public:
  explicit Scene(int threads = 1) : tasks_(threads) {}
  explicit Scene(const HostTasks& host) : tasks_(host) {}

  std::uint32_t add(const AnyShape& geometry, const Sweep& sweep, ProxyMotion motion, bool pushes = true) {
    const auto index = std::uint32_t(shapes.size());
    ColliderShape shape;
    shape.shape = make_shape(geometry);
    shape.size = inner_radius(shape.shape);
    shapes.push_back(shape);
    geometries_.push_back(geometry);
    sweeps.push_back(sweep);
    indices_.push_back(index);
    Proxy proxy;
    proxy.body = index;
    proxy.motion = motion;
    proxy.pushes = motion == ProxyMotion::moving && pushes;
    proxies.push_back(proxy);
    return index;
  }
  std::uint32_t add_fixed(const AnyShape& geometry, const Pose& pose) {
    return add(geometry, {pose, {}, {}, {}}, ProxyMotion::fixed);
  }
  std::uint32_t add_mover(const AnyShape& geometry, const Pose& pose, Vec3 translation, Vec3 rotation = {}) {
    return add(geometry, {pose, {}, translation, rotation}, ProxyMotion::moving);
  }

  std::vector<float> clamp(const std::vector<FastBody>& fast) {
    for (std::size_t i = 0; i < proxies.size(); ++i) {
      const BoxMotion motion{shapes[i].size, sweeps[i].translation, 0.0f};
      proxies[i].fat_box = fat_box(
          needed_box(world_box(shapes[i].shape, sweeps[i].pose * shapes[i].body_from_shape), motion), motion);
    }
    broadphase_->rebuild(proxies);
    return clamp_as_is(fast);
  }
  float clamp(std::uint32_t body, bool continuous = false) { return clamp({{body, continuous}})[0]; }

  // With the boxes of the last clamp().
  std::vector<float> clamp_as_is(const std::vector<FastBody>& fast) {
    saved_.assign(fast.size(), {-1.0f, {}});
    const auto sweep_of = [&](std::uint32_t body) { return sweeps[body]; };
    const auto shapes_of = [&](std::uint32_t body) {
      return std::span<const std::uint32_t>(&indices_[body], 1);
    };
    stage_.clamp_fast_bodies(
        {shapes, proxies, *broadphase_, blocked, sweep_of, shapes_of, nullptr, {}, contacts_}, fast, tasks_,
        saved_);
    std::vector<float> fractions;
    for (const SavedMotion& saved : saved_) fractions.push_back(saved.fraction);
    return fractions;
  }
  float clamp_as_is(std::uint32_t body) { return clamp_as_is({{body, false}})[0]; }
  // The same with contacts for all pairs of boxes and the blockers among them.
  std::vector<float> clamp_by_contacts(const std::vector<FastBody>& fast) {
    ContactStore store;
    Bitset ccd_blockers(proxies.size() * proxies.size()), near_blockers(proxies.size());
    for (std::uint32_t a = 0; a < proxies.size(); ++a) {
      for (std::uint32_t b = a + 1; b < proxies.size(); ++b) {
        if (!overlap(proxies[a].fat_box, proxies[b].fat_box) || !may_pair(proxies[a], proxies[b])) continue;
        const std::uint32_t slot = add_contact(store, pair_key(a, b), {a, b, false, false, {}});
        if (proxies[a].pushes && proxies[b].pushes && !proxies[a].sensor && !proxies[b].sensor) continue;
        ccd_blockers.set(slot), near_blockers.set(a), near_blockers.set(b);
      }
    }
    const KnownContacts contacts{store, ccd_blockers, near_blockers, {}};
    contacts_ = &contacts;
    const std::vector<float> fractions = clamp_as_is(fast);
    contacts_ = nullptr;
    return fractions;
  }
  std::span<const std::uint64_t> crossings() const { return stage_.crossings(); }

  Gap gap(std::uint32_t a, std::uint32_t b, double time) const {
    return find_gap(make_swept_shape(shapes[a].shape, {}, sweeps[a]),
                    make_swept_shape(shapes[b].shape, {}, sweeps[b]), time, 100.0);
  }

  std::vector<ColliderShape> shapes;
  std::vector<Proxy> proxies;
  std::vector<Sweep> sweeps;
  BlockedBodies blocked;

 private:
  TaskSystem tasks_;
  std::unique_ptr<Broadphase> broadphase_ = make_broadphase(BroadPhaseKind::bvh);
  ContinuousCollision stage_;
  std::vector<SavedMotion> saved_;
  std::vector<std::uint32_t> indices_;
  std::vector<AnyShape> geometries_;  // keeps cooked data alive
  const KnownContacts* contacts_ = nullptr;
};

Geometry hull_of_cube(float h) {
  std::vector<Vec3> points;
  for (int i = 0; i < 8; ++i) points.push_back({i & 1 ? h : -h, i & 2 ? h : -h, i & 4 ? h : -h});
  return *cook_hull(points);
}

// A wall of triangles across x = 0, facing -x, from y, z = -30 to 30.
Geometry mesh_wall(int cells) {
  test::Triangles triangles;
  const float size = 60.0f / float(cells);
  for (int i = 0; i < cells; ++i) {
    for (int k = 0; k < cells; ++k) {
      const float y = -30 + size * float(i), z = -30 + size * float(k);
      triangles.quad({0, y, z}, {0, y, z + size}, {0, y + size, z + size}, {0, y + size, z});
    }
  }
  return triangles.cook();
}

std::vector<AnyShape> projectiles() {
  return {Sphere{0.005f},        Sphere{0.5f},     Capsule{0.01f, 0.4f},           Box{{0.5f, 0.004f, 0.5f}},
          Cylinder{0.01f, 0.3f}, Cone{0.1f, 0.2f}, Box{{0.1f, 0.1f, 0.1f}, 0.02f}, hull_of_cube(0.05f)};
}

TEST(Continuous, NothingPassesAThinWall) {
  Random random{3};
  const Geometry mesh = mesh_wall(12);
  const std::vector<AnyShape> walls = {Box{{0.005f, 30, 30}}, mesh, Plane{{-1, 0, 0}, 0.005f}};
  for (const AnyShape& wall : walls) {
    for (const AnyShape& projectile : projectiles()) {
      for (const float speed : {3.0f, 60.0f, 300.0f, 3000.0f}) {
        for (int round = 0; round < 4; ++round) {
          Scene scene;
          const auto obstacle = scene.add_fixed(wall, {{0, 0, 0}, {}});
          const float distance = speed / 60.0f;
          // Starts in front of the wall and would end behind it.
          const float radius = outer_radius(make_shape(projectile), {});
          const float start = radius + 0.02f + random.between(0.0f, 0.9f) * distance;
          const Vec3 sideways{0, random.between(-0.2f, 0.2f) * distance,
                              random.between(-0.2f, 0.2f) * distance};
          const Vec3 moved = Vec3{distance + 2.0f * radius + 0.1f, 0, 0} + sideways;
          const auto bullet = scene.add_mover(projectile, {{-double(start), 0, 0}, random.rotation()}, moved,
                                              round == 0 ? Vec3{} : random.in_box(2.0f));
          const float fraction = scene.clamp(bullet);
          ASSERT_LT(fraction, 1.0f) << wall.index() << " " << projectile.index() << " " << speed;
          // The shape stands in front of the wall, close to it.
          const float inner = inner_radius(scene.shapes[bullet].shape);
          const Pose end = pose_at(scene.sweeps[bullet], double(fraction));
          const Aabb box = bounds(scene.shapes[bullet].shape, {to_float(end.position), end.orientation});
          const float surface = wall.index() == walls[1].index() ? 0.0f : -0.005f;
          EXPECT_LT(box.high.x, surface + 1.0e-6f);
          EXPECT_GT(box.high.x, surface - 0.006f * inner - 2.0e-5f);
          static_cast<void>(obstacle);
        }
      }
    }
  }
}

TEST(Continuous, HeightFieldsStopFallingBodies) {
  Random random{11};
  std::vector<float> heights(33 * 33);
  for (float& height : heights) height = random.between(-0.3f, 0.3f);
  const Geometry field = *cook_height_field({.heights = heights, .columns = 33, .rows = 33, .spacing = 0.5f});
  for (const AnyShape& projectile : projectiles()) {
    for (int round = 0; round < 10; ++round) {
      Scene scene;
      scene.add_fixed(field, {{0, 0, 0}, {}});
      const Vec3 from{random.between(-5, 5), 10, random.between(-5, 5)};
      const auto bullet =
          scene.add_mover(projectile, {DVec3(from), random.rotation()}, {0, -40, 0}, random.in_box(1.0f));
      const float fraction = scene.clamp(bullet);
      const double height = pose_at(scene.sweeps[bullet], double(fraction)).position.y;
      EXPECT_GT(height, -0.3);
      EXPECT_LT(height, 0.31 + double(outer_radius(scene.shapes[bullet].shape, {})));
    }
  }
}

TEST(Continuous, MissesAreLeftAlone) {
  Scene scene;
  scene.add_fixed(Box{{0.005f, 1, 1}}, {{0, 0, 0}, {}});
  const auto above = scene.add_mover(Sphere{0.1f}, {{-10, 1.2, 0}, {}}, {20, 0, 0});
  const auto away = scene.add_mover(Sphere{0.1f}, {{1, 0, 0}, {}}, {20, 0, 0});
  const auto short_of = scene.add_mover(Sphere{0.1f}, {{-10, 0, 0}, {}}, {9, 0, 0});
  EXPECT_EQ(scene.clamp({{above, false}, {away, false}, {short_of, false}}), (std::vector<float>{1, 1, 1}));
}

// One worker may do all the work in one run; in the next, another worker already has room for it.
TEST(Continuous, AnotherWorkerTakesNoMemory) {
  static int first;
  first = 0;
  HostTasks host{.worker_count = 2};
  host.run = [](void*, int count, void (*task)(void*, int), void* context) {
    for (int i = 0; i < count; ++i) task(context, (first + i) % count);
  };
  Scene scene(host);
  std::vector<FastBody> fast;
  for (int i = 0; i < 40; ++i) scene.add_fixed(Box{{0.005f, 30, 30}}, {{0.1 * i, 0, 0}, {}});
  for (Proxy& proxy : scene.proxies) proxy.sensor = true;
  for (int i = 0; i < 8; ++i)
    fast.push_back({scene.add_mover(Sphere{0.1f}, {{-1, double(i), 0}, {}}, {10, 0, 0}), false});
  scene.clamp(fast);
  ASSERT_EQ(scene.crossings().size(), 320u);
  const std::uint64_t before = allocation_count();
  first = 1;
  scene.clamp_as_is(fast);
  EXPECT_EQ(scene.crossings().size(), 320u);
  EXPECT_EQ(allocation_count(), before);
}

// Trees get the boxes of sweeps; empty lanes would overlap an infinite box.
TEST(Continuous, SweepsBeyondFloatsAreTested) {
  Scene scene;
  scene.add_fixed(Box{{0.5f, 0.5f, 0.5f}}, {{5, 0, 0}, {}});
  std::vector<FastBody> fast;
  for (const float distance : {1.0e30f, 3.0e38f, 3.4e38f})
    for (const float angle : {0.0f, 1.0e30f, 3.0e38f})
      fast.push_back(
          {scene.add_mover(Box{{0.1f, 0.1f, 0.1f}}, {{0, 0, 0}, {}}, {-distance, distance, 0}, {0, angle, 0}),
           false});
  for (const float fraction : scene.clamp(fast)) {
    EXPECT_GE(fraction, 0.0f);
    EXPECT_LE(fraction, 1.0f);
  }
}

TEST(Continuous, SpinningBladesStopAtAPost) {
  for (const float rate : {1.0f, 5.0f, 30.0f}) {
    Scene scene;
    const auto post = scene.add_fixed(Box{{0.01f, 1, 0.01f}}, {{0.9, 0, 0}, {}});
    const auto blade = scene.add_mover(Box{{1.0f, 0.01f, 0.02f}},
                                       {{0, 0, 0}, from_axis_angle({0, 1, 0}, 0.8f)}, {}, {0, -rate, 0});
    const float fraction = scene.clamp(blade);
    ASSERT_LT(fraction, 1.0f);
    EXPECT_NEAR(fraction * rate, 0.8f, 0.06f) << "one twist of 0.8 rad leads to the post";
    EXPECT_GT(scene.gap(blade, post, double(fraction)).distance, 0.0);
    EXPECT_LT(scene.gap(blade, post, double(fraction)).distance, 1.0e-4);
  }
}

// A body slides over a floor, pressed down a little in every step and lifted back as by the solver: it must advance.
float slide(const AnyShape& floor, const Pose& floor_pose, const AnyShape& slider, float height,
            float hover) {
  constexpr int kSteps = 40;
  double x = -15.0;
  const float distance = 100.0f / 60.0f / 4.0f;
  for (int step = 0; step < kSteps; ++step) {
    Scene scene;
    scene.add_fixed(floor, floor_pose);
    const double y = double(height) + double(step == 0 ? hover : 0.0f) - (step % 3 == 0 ? 0.001 : 0.0);
    const auto body = scene.add_mover(slider, {{x, y, 0.123}, {}}, {distance, -0.0027f, 0});
    x += double(scene.clamp(body) * distance);
  }
  return float((x + 15.0) / double(distance * kSteps));
}

TEST(Continuous, SlidingBodiesKeepSliding) {
  test::Triangles flat;
  for (int i = 0; i < 40; ++i) {
    for (int k = 0; k < 10; ++k) {
      const float a = -20 + float(i), b = -5 + float(k);
      flat.quad({a, 0, b}, {a, 0, b + 1}, {a + 1, 0, b + 1}, {a + 1, 0, b});
    }
  }
  const Geometry mesh = flat.cook();
  const std::vector<float> heights(81 * 21, 0.0f);
  const Geometry field = *cook_height_field({.heights = heights, .columns = 81, .rows = 21, .spacing = 0.5f});
  const std::vector<std::pair<AnyShape, Pose>> floors = {
      {Box{{30, 1, 30}}, {{0, -1, 0}, {}}}, {Plane{}, {}}, {mesh, {}}, {field, {}}};
  for (const auto& [floor, pose] : floors) {
    for (const float hover : {0.0f, 0.004f}) {
      EXPECT_GT(slide(floor, pose, Box{{0.1f, 0.05f, 0.1f}}, 0.05f, hover), 0.9f) << floor.index();
      EXPECT_GT(slide(floor, pose, Sphere{0.1f}, 0.1f, hover), 0.9f) << floor.index();
      EXPECT_GT(slide(floor, pose, Cylinder{0.1f, 0.02f}, 0.02f, hover), 0.9f) << floor.index();
    }
  }
}

TEST(Continuous, GetsOnOverRoughGround) {
  Random random{5};
  std::vector<float> heights(161 * 21);
  for (float& height : heights) height = random.between(-0.02f, 0.02f);
  const Geometry field =
      *cook_height_field({.heights = heights, .columns = 161, .rows = 21, .spacing = 0.25f});
  EXPECT_GT(slide(field, {}, Sphere{0.2f}, 0.2f, 0.0f), 0.2f);
  EXPECT_GT(slide(field, {}, Box{{0.2f, 0.1f, 0.2f}}, 0.1f, 0.0f), 0.2f);
}

TEST(Continuous, TouchingShapesAreHaltedByTheirCore) {
  const Geometry mesh = mesh_wall(4);
  for (const AnyShape& wall : std::vector<AnyShape>{Box{{0.005f, 5, 5}}, mesh, Plane{{-1, 0, 0}, 0.005f}}) {
    Scene scene;
    scene.add_fixed(wall, {{0, 0, 0}, {}});
    const auto ball = scene.add_mover(Sphere{0.2f}, {{-0.2051, 0, 0}, {}}, {50, 0, 3});
    const float fraction = scene.clamp(ball);
    EXPECT_LT(pose_at(scene.sweeps[ball], double(fraction)).position.x, -0.1);
  }
}

TEST(Continuous, FindsTheBlocker) {
  const Pose wall_pose{{0, 0, 0}, {}}, start{{-5, 0, 0}, {}};
  const Vec3 moved{10, 0, 0};
  {
    Scene scene;
    const auto wall = scene.add_mover(Box{{0.01f, 1, 1}}, wall_pose, {});
    const auto ball = scene.add_mover(Sphere{0.1f}, start, moved);
    EXPECT_EQ(scene.clamp(ball, false), 1.0f) << "dynamic bodies only stop continuous ones";
    EXPECT_LT(scene.clamp(ball, true), 0.5f);
    scene.blocked.insert(pair_key(wall, ball), 1);
    EXPECT_EQ(scene.clamp(ball, true), 1.0f) << "a joint keeps the two from touching";
  }
  {
    Scene scene;
    scene.add(Box{{0.01f, 1, 1}}, {wall_pose, {}, {}, {}}, ProxyMotion::moving, false);
    const auto ball = scene.add_mover(Sphere{0.1f}, start, moved);
    EXPECT_LT(scene.clamp(ball, false), 0.5f) << "kinematic bodies always stop others";
    scene.proxies[0].sensor = true;
    EXPECT_EQ(scene.clamp(ball, false), 1.0f) << "sensors stop nothing";
    scene.proxies[0].sensor = false;
    scene.proxies[0].filter.layer = 2;
    scene.proxies[ball].filter.collides_with = 1;
    EXPECT_EQ(scene.clamp(ball, false), 1.0f) << "filters hold here too";
  }
}

// For bodies that stay in their box or leave it, for sensors and for moving obstacles, contacts give the same result as
// a query of all boxes.
TEST(Continuous, ContactsGiveTheSameBlockers) {
  Random random{23};
  std::size_t stopped = 0, crossed = 0;
  for (int round = 0; round < 20; ++round) {
    Scene scene;
    scene.add_fixed(Box{{20, 1, 20}}, {{0, -1, 0}});
    for (int i = 0; i < 4; ++i) {
      const Vec3 at = random.in_box(3.0f) + Vec3{0, 3, 0};
      const bool sensor = i < 2;
      const std::uint32_t body =
          scene.add(Box{{0.5f, 0.5f, 0.05f}}, {{DVec3(at), random.rotation()}, {}, random.in_box(0.3f), {}},
                    ProxyMotion::moving, false);
      scene.proxies[body].sensor = sensor;
    }
    std::vector<FastBody> fast;
    for (int i = 0; i < 40; ++i) {
      const Vec3 at = random.in_box(3.0f) + Vec3{0, 3.2f, 0};
      const std::uint32_t body = scene.add_mover(random_convex(random), {DVec3(at), random.rotation()},
                                                 random.in_box(1.0f), random.in_box(0.5f));
      fast.push_back({body, i % 8 == 0});
    }
    scene.clamp(fast);  // fits the boxes
    for (std::size_t k = 0; k < fast.size(); k += 2) scene.sweeps[fast[k].body].translation *= 4.0f;
    const std::vector<float> all = scene.clamp_as_is(fast);
    const std::vector<std::uint64_t> passed(scene.crossings().begin(), scene.crossings().end());
    EXPECT_EQ(scene.clamp_by_contacts(fast), all) << round;
    EXPECT_TRUE(std::equal(passed.begin(), passed.end(), scene.crossings().begin(), scene.crossings().end()));
    for (const float fraction : all) stopped += fraction < 1.0f ? 1 : 0;
    crossed += passed.size();
  }
  EXPECT_GT(stopped, 100u);
  EXPECT_GT(crossed, 5u);
}

TEST(Continuous, SkipsMotionsThatAreNotFinite) {
  constexpr float kNan = __builtin_nanf(""), kInfinity = __builtin_inff();
  for (const float bad : {kNan, kInfinity}) {
    Scene scene;
    scene.add_fixed(Box{{0.01f, 1, 1}}, {{0, 0, 0}, {}});
    const auto body = scene.add_mover(Sphere{0.1f}, {{-5, 0, 0}, {}}, {10, 0, 0});
    scene.clamp(body);
    scene.sweeps[body].translation.x = bad;
    EXPECT_EQ(scene.clamp_as_is(body), 1.0f);
    scene.sweeps[body].translation.x = 10;
    scene.sweeps[body].rotation.y = bad;
    EXPECT_EQ(scene.clamp_as_is(body), 1.0f);
  }
}

TEST(Continuous, MovingObstaclesMeetHalfway) {
  Scene scene;
  const auto door =
      scene.add(Box{{0.01f, 1, 1}}, {{{5, 0, 0}, {}}, {}, {-10, 0, 0}, {}}, ProxyMotion::moving, false);
  const auto ball = scene.add_mover(Sphere{0.1f}, {{-5, 0, 0}, {}}, {10, 0, 0});
  const float fraction = scene.clamp(ball);
  EXPECT_NEAR(fraction, (10.0f - 0.11f) / 20.0f, 1.0e-4f);
  EXPECT_GT(scene.gap(ball, door, double(fraction)).distance, 0.0);
}

TEST(Continuous, ThreadsChangeNothing) {
  const Geometry mesh = mesh_wall(20);
  std::vector<float> results[3];
  for (int threads = 1; threads <= 3; ++threads) {
    Random random{9};
    Scene scene(threads);
    scene.add_fixed(mesh, {{0, 0, 0}, {}});
    std::vector<FastBody> fast;
    for (int i = 0; i < 60; ++i) {
      const auto body = scene.add_mover(random_convex(random),
                                        {{-5, double(random.between(-20, 20)), 0}, random.rotation()},
                                        {random.between(2, 20), 0, 0}, random.in_box(1.0f));
      fast.push_back({body, i % 2 == 0});
    }
    results[threads - 1] = scene.clamp(fast);
    ASSERT_EQ(results[0], results[threads - 1]);
  }
}

TEST(Continuous, AllocatesNothingOnceWarm) {
  Scene scene(2);
  scene.add_fixed(mesh_wall(8), {{0, 0, 0}, {}});
  const auto ball = scene.add_mover(Sphere{0.1f}, {{-5, 0, 0}, {}}, {10, 0, 0});
  scene.clamp(ball);
  const std::uint64_t before = allocation_count();
  scene.clamp(ball);
  EXPECT_EQ(allocation_count(), before);
}

TEST(Continuous, FastIsRelativeToTheInnerRadius) {
  EXPECT_TRUE(is_fast({0.3f, 0, 0}, {}, 1.0f, 0.5f));
  EXPECT_FALSE(is_fast({0.2f, 0, 0}, {}, 1.0f, 0.5f));
  EXPECT_TRUE(is_fast({}, {0, 0.3f, 0}, 1.0f, 0.5f));
}

}  // namespace
}  // namespace gyre::continuous_test
