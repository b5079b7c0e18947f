// Queries against ropes, cloths and solids, compared with every triangle and segment one by one, and events of soft matter.
#include "determinism/scenes.h"
#include "random.h"

#include <gyre/gyre.h>
#include <gyre/replay.h>

#include <gtest/gtest.h>

#include <cmath>

namespace gyre::soft_queries_test {
namespace {

constexpr float kStep = 1.0f / 60.0f;

World make_world(int threads = 1) {
  WorldDef def;
  def.threads = threads;
  return std::move(*World::create(def));
}

// A crumpled sheet on a ball, a hanging rope, a pressed jelly, far from the origin.
struct Scene {
  World world = make_world();
  DVec3 at{1.0e5, 0.0, -2.0e4};
  BodyId ball{};
  SoftId cloth{}, rope{}, solid{};

  Scene() {
    scenes::add_fixed(world, {at.x, -3.0, at.z}, Box{{20.0f, 0.5f, 20.0f}});
    ball = scenes::add_fixed(world, at, Sphere{0.5f});
    ClothDef sheet;
    sheet.grid = ClothGrid{{2, 2}, {16, 16}};
    sheet.pose.position = at + DVec3{0, 0.6, 0};
    sheet.thickness = 0.02f;
    cloth = world.add_cloth(sheet);
    RopeDef line;
    line.points = {at + DVec3{-3, 2, 0}, at + DVec3{-1.5, 2, 1}};
    line.segments = 40, line.radius = 0.03f;
    rope = world.add_rope(line);
    world.pin(rope, 0);
    SolidDef jelly;
    jelly.box = SolidBox{{0.5f, 0.5f, 0.5f}, {4, 4, 4}};
    jelly.pose.position = at + DVec3{3, -1.9, 0};
    jelly.settings.filter.layer = 4;
    solid = world.add_solid(jelly);
    for (int i = 0; i < 40; ++i) world.step(kStep);
  }
};

// The crossing of a ray with a triangle in double, by determinants.
bool ray_meets(DVec3 origin, DVec3 way, DVec3 a, DVec3 b, DVec3 c, bool one_sided, double& fraction) {
  const DVec3 ab = b - a, ac = c - a, n = cross(ab, ac);
  const double facing = -dot(way, n);
  if (facing == 0.0 || (one_sided && facing < 0.0)) return false;
  const double t = dot(origin - a, n) / facing;
  const DVec3 p = origin + t * way - a;
  const double size = dot(n, n), u = dot(cross(p, ac), n) / size, v = dot(cross(ab, p), n) / size;
  fraction = t;
  return t >= 0.0 && t <= 1.0 && u >= 0.0 && v >= 0.0 && u + v <= 1.0;
}

double nearest_crossing(const World& world, SoftId soft, DVec3 origin, DVec3 way, bool one_sided) {
  const SoftVertices v = world.vertices(soft);
  const auto triangles = world.soft_triangles(soft);
  double nearest = 2.0, fraction = 0.0;
  for (std::size_t k = 0; k < triangles.size(); k += 3) {
    if (ray_meets(origin, way, v.position(triangles[k]), v.position(triangles[k + 1]),
                  v.position(triangles[k + 2]), one_sided, fraction))
      nearest = std::fmin(nearest, fraction);
  }
  return nearest;
}

// The place that the weights name, taken from the first corner so that their rounding does not grow with the distance from the origin.
DVec3 point_of(const World& world, const CastHit& hit) {
  const SoftVertices v = world.vertices(hit.soft);
  const std::size_t k = std::size_t(hit.triangle);
  if (world.soft_info(hit.soft).kind == SoftKind::rope)
    return v.position(k) + double(hit.weights.y) * (v.position(k + 1) - v.position(k));
  const auto t = world.soft_triangles(hit.soft).subspan(3 * k, 3);
  const DVec3 first = v.position(t[0]);
  return first + double(hit.weights.y) * (v.position(t[1]) - first) +
         double(hit.weights.z) * (v.position(t[2]) - first);
}

TEST(SoftQueries, RaysHitTheNearestTriangle) {
  const Scene scene;
  const World& world = scene.world;
  testing_random::Mixed random{7};
  int hits = 0;
  for (int i = 0; i < 2000; ++i) {
    const bool at_cloth = i % 2 == 0;
    const DVec3 middle = scene.at + (at_cloth ? DVec3{} : DVec3{3, -2, 0});
    const DVec3 from = middle + DVec3{random.between(-4, 4), random.between(-4, 4), random.between(-4, 4)};
    if (!at_cloth && length(from - middle) < 1.2) continue;  // not from within the solid
    const DVec3 to = middle + DVec3{random.between(-1, 1), random.between(-1, 1), random.between(-1, 1)};
    const Vec3 way = to_float(2.0 * (to - from));
    const SoftId soft = at_cloth ? scene.cloth : scene.solid;
    QueryFilter filter;
    SoftId only = soft;
    filter.user = &only;
    filter.accepts = [](void*, ShapeId, BodyId) { return false; };
    filter.accepts_soft = [](void* user, SoftId id) { return id == *static_cast<SoftId*>(user); };
    const double expected = nearest_crossing(world, soft, from, DVec3(way), !at_cloth);
    const auto hit = world.cast_ray(from, way, filter);
    ASSERT_EQ(bool(hit), expected <= 1.0) << i;
    EXPECT_EQ(world.cast_ray_any(from, way, filter), bool(hit));
    if (!hit) continue;
    ++hits;
    EXPECT_NEAR(hit->fraction, expected, 1e-9);
    EXPECT_EQ(hit->soft, soft);
    EXPECT_FALSE(hit->body);
    EXPECT_LT(length(point_of(world, *hit) - hit->point), 1e-6);
    EXPECT_NEAR(length(hit->normal), 1.0f, 1e-5f);
    EXPECT_LE(dot(hit->normal, way), 0.0f);
  }
  EXPECT_GT(hits, 500);
}

TEST(SoftQueries, ABodyBehindAClothIsHitAfterIt) {
  const Scene scene;
  const World& world = scene.world;
  const DVec3 above = scene.at + DVec3{0.01, 5, 0.02};
  const auto hit = world.cast_ray(above, {0, -10, 0});
  ASSERT_TRUE(hit);
  EXPECT_EQ(hit->soft, scene.cloth);
  QueryFilter bodies;
  bodies.soft = false;
  const auto bare = world.cast_ray(above, {0, -10, 0}, bodies);
  ASSERT_TRUE(bare);
  EXPECT_EQ(bare->body, scene.ball);
  EXPECT_FALSE(bare->soft);
  CastHit all[4];
  ASSERT_EQ(world.cast_ray_all(above, {0, -10, 0}, all), 3u);  // cloth, ball, ground
  EXPECT_EQ(all[0].soft, scene.cloth);
  EXPECT_EQ(all[1].body, scene.ball);
  EXPECT_LT(all[0].fraction, all[1].fraction);
  QueryFilter layer;
  layer.layers = 4;  // of the solid alone
  EXPECT_FALSE(world.cast_ray(above, {0, -10, 0}, layer));
}

TEST(SoftQueries, ASolidIsSolid) {
  const Scene scene;
  const World& world = scene.world;
  const SoftVertices v = world.vertices(scene.solid);
  const DVec3 middle = v.position(2 + 5 * (2 + 5 * 2));
  const auto hit = world.cast_ray(middle, {0, 1, 0});
  ASSERT_TRUE(hit);
  EXPECT_TRUE(hit->inside);
  EXPECT_EQ(hit->fraction, 0.0);
  EXPECT_EQ(hit->soft, scene.solid);
  Overlap one[2];
  ASSERT_EQ(world.overlap_all({Sphere{0.01f}, {middle}}, one), 1u);
  EXPECT_EQ(one[0].soft, scene.solid);
  EXPECT_EQ(one[0].triangle, -1);  // wholly within
  EXPECT_FALSE(world.overlap_any({Sphere{0.01f}, {middle + DVec3{0, 1.5, 0}}}));
}

TEST(SoftQueries, MovingBallsStopAtHalfTheThicknessAndAtTheRadiusOfARope) {
  const Scene scene;
  const World& world = scene.world;
  testing_random::Mixed random{3};
  int cloths = 0, ropes = 0;
  for (int i = 0; i < 300; ++i) {
    const bool at_rope = i % 2 == 0;
    const SoftId soft = at_rope ? scene.rope : scene.cloth;
    const SoftVertices v = world.vertices(soft);
    const DVec3 to = v.position(std::size_t(random.between(0, double(v.size()) - 1.0)));
    const DVec3 from = to + DVec3{random.between(-1, 1), random.between(0.5, 2), random.between(-1, 1)};
    QueryFilter filter;
    filter.accepts = [](void*, ShapeId, BodyId) { return false; };
    const float radius = 0.1f;
    const auto hit = world.cast_shape(
        {.shape = Sphere{radius}, .pose = {from}, .translation = to_float(1.5 * (to - from))}, filter);
    ASSERT_TRUE(hit);
    if (hit->inside || hit->soft != soft) continue;
    (at_rope ? ropes : cloths) += 1;
    const DVec3 center = from + hit->fraction * DVec3(to_float(1.5 * (to - from)));
    const double keeps = at_rope ? 0.03 : 0.01;
    EXPECT_NEAR(length(point_of(world, *hit) - center), double(radius) + keeps, 2e-5);
    EXPECT_NEAR(length(hit->point - center), double(radius), 2e-5);
    // It stands free of everything just before, and touches just after.
    const DVec3 back = 1e-4 * DVec3(hit->normal);
    EXPECT_FALSE(world.overlap_any({Sphere{radius}, {center + back}}, filter)) << i;
    EXPECT_TRUE(world.overlap_any({Sphere{radius}, {center - back}}, filter)) << i;
  }
  EXPECT_GT(cloths, 100);
  EXPECT_GT(ropes, 100);
}

TEST(SoftQueries, BoxesStopWhereTheyTouch) {
  const Scene scene;
  const World& world = scene.world;
  testing_random::Mixed random{5};
  QueryFilter filter;
  filter.accepts = [](void*, ShapeId, BodyId) { return false; };
  int hits = 0;
  for (int i = 0; i < 200; ++i) {
    const DVec3 middle = scene.at + (i % 2 == 0 ? DVec3{} : DVec3{3, -2, 0});
    const DVec3 from = middle + DVec3{random.between(-2, 2), 3.0, random.between(-2, 2)};
    const Vec3 way = to_float(2.0 * (middle - from));
    const Quat turn = normalized(
        Quat{float(random.between(-1, 1)), float(random.between(-1, 1)), float(random.between(-1, 1)), 1.0f});
    const auto hit = world.cast_shape(
        {.shape = Box{{0.1f, 0.2f, 0.05f}}, .pose = {from, turn}, .translation = way}, filter);
    if (!hit || hit->inside) continue;
    ++hits;
    const DVec3 stop = from + hit->fraction * DVec3(way), back = 1e-4 * DVec3(hit->normal);
    EXPECT_FALSE(world.overlap_any({Box{{0.1f, 0.2f, 0.05f}}, {stop + back, turn}}, filter)) << i;
    EXPECT_TRUE(world.overlap_any({Box{{0.1f, 0.2f, 0.05f}}, {stop - back, turn}}, filter)) << i;
  }
  EXPECT_GT(hits, 100);
}

TEST(SoftQueries, BatchesHaveTheSameBitsAsSingleQueries) {
  Scene scene;
  testing_random::Mixed random{11};
  std::vector<Ray> rays(200);
  std::vector<ShapePose> places(200);
  for (std::size_t i = 0; i < rays.size(); ++i) {
    const DVec3 from = scene.at + DVec3{random.between(-4, 4), random.between(-3, 4), random.between(-3, 3)};
    rays[i] = {from, to_float(scene.at - from)};
    places[i] = {Sphere{0.4f}, {from}};
  }
  std::vector<CastHit> hits(rays.size());
  ASSERT_TRUE(scene.world.cast_ray_batch(rays, hits).ok());
  std::vector<std::uint8_t> any(rays.size());
  std::vector<std::uint32_t> counts(rays.size());
  ASSERT_TRUE(scene.world.overlap_any_batch(places, any).ok());
  ASSERT_TRUE(scene.world.overlap_count_batch(places, counts).ok());
  int soft = 0;
  for (std::size_t i = 0; i < rays.size(); ++i) {
    const auto one = scene.world.cast_ray(rays[i].origin, rays[i].translation);
    ASSERT_EQ(bool(one), bool(hits[i]));
    if (one) {
      EXPECT_EQ(one->fraction, hits[i].fraction);
      EXPECT_EQ(one->soft, hits[i].soft);
      EXPECT_EQ(one->triangle, hits[i].triangle);
      soft += bool(one->soft);
    }
    EXPECT_EQ(any[i] != 0, scene.world.overlap_any(places[i]));
    EXPECT_EQ(any[i] != 0, counts[i] > 0);
  }
  EXPECT_GT(soft, 20);
}

TEST(SoftQueries, SeeChangesAtOnce) {
  World world = make_world();
  EXPECT_FALSE(world.cast_ray({0, 1, 0}, {0, -2, 0}));
  ClothDef sheet;
  sheet.grid = ClothGrid{{1, 1}, {4, 4}};
  const SoftId cloth = world.add_cloth(sheet);
  EXPECT_TRUE(world.cast_ray({0.1, 1, 0}, {0, -2, 0}));
  for (int i = 0; i < 60; ++i) world.step(kStep);
  EXPECT_FALSE(world.cast_ray({0.1, 1, 0}, {0, -2, 0}));
  EXPECT_TRUE(world.cast_ray({0.1, 1, 0}, {0, -20, 0}));
  EXPECT_TRUE(world.remove_soft(cloth));
  EXPECT_FALSE(world.cast_ray({0.1, 1, 0}, {0, -20, 0}));
}

// ---------------------------------------------------------------------------------------------------------------- events

SoftId add_jelly(World& world, DVec3 at) {
  SolidDef jelly;
  jelly.box = SolidBox{{0.2f, 0.2f, 0.2f}, {2, 2, 2}};
  jelly.pose.position = at;
  return world.add_solid(jelly);
}

TEST(SoftEvents, ATouchBeginsOnceAndEndsOnce) {
  World world = make_world();
  const BodyId ground = scenes::add_fixed(world, {0, -0.5, 0}, Box{{5.0f, 0.5f, 5.0f}});
  const SoftId jelly = add_jelly(world, {0, 0.6, 0});
  int begins = 0, ends = 0;
  const auto count = [&] {
    for (const SoftContactBegin& one : world.events().soft_begins) {
      EXPECT_EQ(one.soft, jelly);
      EXPECT_EQ(one.body, ground);
      EXPECT_EQ(one.shape, world.shapes(ground)[0]);
      EXPECT_LT(world.vertices(jelly).y[std::size_t(one.vertex)], 0.05);
      ++begins;
    }
    for (const SoftContactEnd& one : world.events().soft_ends) {
      EXPECT_EQ(one.soft, jelly);
      ++ends;
    }
  };
  for (int i = 0; i < 180; ++i) world.step(kStep), count();
  EXPECT_GE(begins, 1);
  EXPECT_EQ(ends, begins - 1);  // it bounced at most a few times, and lies now
  EXPECT_LE(begins, 4);
  const int bounced = begins;
  for (int i = 0; i < 60; ++i) world.step(kStep), count();
  EXPECT_EQ(begins, bounced);
  world.remove_body(ground);
  world.step(kStep), count();
  EXPECT_EQ(ends, begins);
  for (int i = 0; i < 10; ++i) world.step(kStep), count();
  EXPECT_EQ(ends, begins);
}

TEST(SoftEvents, GoOnFromASnapshotAndTellWhatCommandsEnd) {
  World world = make_world();
  scenes::add_fixed(world, {0, -0.5, 0}, Box{{5.0f, 0.5f, 5.0f}});
  const SoftId jelly = add_jelly(world, {0, 0.3, 0});
  for (int i = 0; i < 10; ++i) world.step(kStep);
  const std::vector<std::byte> before = save_snapshot(world);
  std::vector<std::pair<std::size_t, std::size_t>> first, again;
  for (int i = 0; i < 60; ++i) {
    world.step(kStep);
    first.push_back({world.events().soft_begins.size(), world.events().soft_ends.size()});
  }
  ASSERT_TRUE(restore_snapshot(world, before).ok());
  EXPECT_TRUE(world.events().soft_begins.empty());
  for (int i = 0; i < 60; ++i) {
    world.step(kStep);
    again.push_back({world.events().soft_begins.size(), world.events().soft_ends.size()});
  }
  EXPECT_EQ(first, again);
  world.remove_soft(jelly);
  world.step(kStep);
  ASSERT_EQ(world.events().soft_ends.size(), 1u);
  EXPECT_EQ(world.events().soft_ends[0].soft, jelly);
}

TEST(SoftEvents, ATetrahedronThatTurnsInsideOutIsReportedOnce) {
  WorldDef def;
  def.gravity = {};
  World world = std::move(*World::create(def));
  SolidDef one;
  one.vertices = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}, {1, 1, 1}};
  one.tetrahedra = {0, 1, 2, 3, 1, 2, 3, 4};
  one.settings.velocities = {{60, 60, 60}, {}, {}, {}, {}};
  const SoftId solid = world.add_solid(one);
  int reported = 0;
  for (int i = 0; i < 30; ++i) {
    world.step(kStep);
    for (const SoftInverted& tetrahedron : world.events().inverted) {
      ++reported;
      EXPECT_EQ(tetrahedron.soft, solid);
      EXPECT_EQ(tetrahedron.tetrahedron, 0);
      EXPECT_EQ(tetrahedron.vertices, (std::array<std::uint32_t, 4>{0, 1, 2, 3}));
    }
    if (i == 0) {
      EXPECT_EQ(reported, 1);
    }
  }
  EXPECT_GE(reported, 1);
}

}  // namespace
}  // namespace gyre::soft_queries_test
