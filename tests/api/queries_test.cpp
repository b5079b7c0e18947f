// Queries of a whole world: the same answers as asking every shape alone, with every broad phase and number of threads, right
// after every change, far from the origin, and refused where they cannot be asked.
#include "api/query_crowd.h"

#include <array>
#include <cstring>
#include <thread>

namespace gyre::laws::queries_test {
namespace {

bool only_this(void* user, ShapeId shape, BodyId) { return *static_cast<ShapeId*>(user) == shape; }

// Calls ask(filter) for one shape after the other: no query then has any other candidate.
template <class Ask>
void for_each_alone(const Crowd& c, Ask&& ask) {
  for (const BodyId body : c.bodies) {
    for (const ShapeId shape : c.world.shapes(body)) {
      ShapeId one = shape;
      QueryFilter filter;
      filter.accepts = only_this;
      filter.user = &one;
      ask(filter);
    }
  }
}

void expect_same(const CastHit& a, const CastHit& b) {
  EXPECT_EQ(a.body.index, b.body.index);
  EXPECT_EQ(a.shape.index, b.shape.index);
  EXPECT_EQ(a.shape_index, b.shape_index);
  EXPECT_EQ(a.triangle, b.triangle);
  EXPECT_EQ(a.point, b.point);
  EXPECT_EQ(a.normal, b.normal);
  EXPECT_EQ(a.fraction, b.fraction);
  EXPECT_EQ(a.inside, b.inside);
  EXPECT_EQ(a.depth, b.depth);
}

template <class Cast, class All, class Any>
void expect_like_each_alone(const Crowd& c, Cast&& cast, All&& all, Any&& any) {
  std::vector<CastHit> expected;
  for_each_alone(c, [&](const QueryFilter& filter) {
    if (const std::optional<CastHit> hit = cast(filter)) expected.push_back(*hit);
  });
  std::sort(expected.begin(), expected.end(), [](const CastHit& a, const CastHit& b) {
    return a.fraction != b.fraction ? a.fraction < b.fraction : a.shape.index < b.shape.index;
  });
  const std::optional<CastHit> nearest = cast({});
  ASSERT_EQ(nearest.has_value(), !expected.empty());
  EXPECT_EQ(any(QueryFilter{}), !expected.empty());
  if (nearest) expect_same(*nearest, expected[0]);
  std::array<CastHit, 5> some;
  EXPECT_EQ(all(std::span<CastHit>(some)), expected.size());
  for (std::size_t i = 0; i < min(some.size(), expected.size()); ++i) expect_same(some[i], expected[i]);
}

TEST(Queries, FindWhatEveryShapeAloneAnswers) {
  for (unsigned seed = 0; seed < 6; ++seed) {
    const Crowd c = crowd(seed, BroadPhaseKind::bvh);
    Random random{std::mt19937(100 + seed)};
    for (int i = 0; i < 150 && !::testing::Test::HasFailure(); ++i) {
      const Ray ray = random_ray(random);
      expect_like_each_alone(
          c, [&](const QueryFilter& f) { return c.world.cast_ray(ray.origin, ray.translation, f); },
          [&](std::span<CastHit> out) { return c.world.cast_ray_all(ray.origin, ray.translation, out); },
          [&](const QueryFilter& f) { return c.world.cast_ray_any(ray.origin, ray.translation, f); });
      if (i % 5 != 0) continue;
      const ShapeCast cast = random_cast(random);
      expect_like_each_alone(
          c, [&](const QueryFilter& f) { return c.world.cast_shape(cast, f); },
          [&](std::span<CastHit> out) { return c.world.cast_shape_all(cast, out); },
          [&](const QueryFilter& f) { return c.world.cast_shape_any(cast, f); });
    }
  }
}

TEST(Queries, FindOverlapsAndClosestPointsThatEveryShapeAloneAnswers) {
  for (unsigned seed = 0; seed < 6; ++seed) {
    const Crowd c = crowd(seed, BroadPhaseKind::bvh);
    Random random{std::mt19937(200 + seed)};
    for (int i = 0; i < 60 && !::testing::Test::HasFailure(); ++i) {
      const ShapePose place = random_place(random);
      std::vector<ClosestPoint> expected;
      std::vector<std::uint32_t> overlapping;
      for_each_alone(c, [&](const QueryFilter& f) {
        const std::optional<ClosestPoint> near = c.world.closest_point(place, 1.0e30, f);
        // Overlap is distance 0, and nothing else.
        EXPECT_EQ(c.world.overlap_any(place, f), near && near->distance == 0.0);
        if (!near) return;  // a sensor
        expected.push_back(*near);
        if (near->distance == 0.0) overlapping.push_back(near->shape.index);
      });
      std::sort(overlapping.begin(), overlapping.end());
      std::sort(expected.begin(), expected.end(), [](const ClosestPoint& a, const ClosestPoint& b) {
        return a.distance != b.distance ? a.distance < b.distance : a.shape.index < b.shape.index;
      });
      const std::optional<ClosestPoint> nearest = c.world.closest_point(place, 1.0e30);
      ASSERT_TRUE(nearest.has_value());
      EXPECT_EQ(nearest->shape, expected[0].shape);
      EXPECT_EQ(nearest->distance, expected[0].distance);
      EXPECT_EQ(nearest->point, expected[0].point);
      EXPECT_NEAR(length(nearest->query_point - nearest->point), nearest->distance, 1e-6);
      std::array<ClosestPoint, 4> some;
      const std::size_t clamp_length = c.world.closest_point_all(place, expected[3].distance * (1.0 + 1e-9), some);
      EXPECT_GE(clamp_length, 4u);
      for (std::size_t k = 0; k < 4; ++k) EXPECT_EQ(some[k].shape, expected[k].shape);
      EXPECT_EQ(c.world.overlap_any(place), !overlapping.empty());
      std::array<Overlap, 64> found;
      ASSERT_EQ(c.world.overlap_all(place, found), overlapping.size());
      for (std::size_t k = 0; k < overlapping.size(); ++k) EXPECT_EQ(found[k].shape.index, overlapping[k]);
    }
  }
}

// Thousands of rays at once: one by one, over two and four threads, with another broad phase, and on a host's tasks: one answer.
TEST(Queries, InBatchesDependOnNothing) {
  const unsigned seed = 5;
  const Crowd one = crowd(seed, BroadPhaseKind::bvh);
  Random random{std::mt19937(300)};
  std::vector<Ray> rays(5000);
  std::vector<ShapeCast> casts(400);
  std::vector<ShapePose> places(400);
  for (Ray& ray : rays) ray = random_ray(random);
  for (ShapeCast& cast : casts) cast = random_cast(random);
  for (ShapePose& place : places) place = random_place(random);
  std::vector<CastHit> hits(rays.size()), cast_shape_any(casts.size());
  std::vector<ClosestPoint> closest(places.size());
  std::vector<std::uint32_t> counts(places.size());
  int found = 0;
  for (std::size_t i = 0; i < rays.size(); ++i) {
    hits[i] = one.world.cast_ray(rays[i].origin, rays[i].translation).value_or(CastHit{});
    found += hits[i] ? 1 : 0;
  }
  EXPECT_GT(found, 1000);
  for (std::size_t i = 0; i < casts.size(); ++i)
    cast_shape_any[i] = one.world.cast_shape(casts[i]).value_or(CastHit{});
  for (std::size_t i = 0; i < places.size(); ++i) {
    closest[i] = one.world.closest_point(places[i], 3.0).value_or(ClosestPoint{});
    counts[i] = std::uint32_t(one.world.overlap_all(places[i], {}));
  }
  for (const int threads : {1, 2, 4}) {
    for (const BroadPhaseKind kind : {BroadPhaseKind::bvh, BroadPhaseKind::brute_force}) {
      const Crowd c = crowd(seed, kind, threads);
      std::vector<CastHit> out(rays.size()), shape_out(casts.size());
      std::vector<ClosestPoint> closest_out(places.size());
      std::vector<std::uint32_t> counts_out(places.size());
      EXPECT_EQ(c.world.cast_ray_batch(rays, out).code, ErrorCode::none);
      EXPECT_EQ(c.world.cast_shape_batch(casts, shape_out).code, ErrorCode::none);
      EXPECT_EQ(c.world.closest_point_batch(places, 3.0, closest_out).code, ErrorCode::none);
      EXPECT_EQ(c.world.overlap_count_batch(places, counts_out).code, ErrorCode::none);
      for (std::size_t i = 0; i < rays.size(); ++i) expect_same(out[i], hits[i]);
      for (std::size_t i = 0; i < casts.size(); ++i) expect_same(shape_out[i], cast_shape_any[i]);
      for (std::size_t i = 0; i < places.size(); ++i) {
        EXPECT_EQ(closest_out[i].shape.index, closest[i].shape.index);
        EXPECT_EQ(closest_out[i].triangle, closest[i].triangle);
        EXPECT_EQ(closest_out[i].point, closest[i].point);
        EXPECT_EQ(closest_out[i].distance, closest[i].distance);
        EXPECT_EQ(counts_out[i], counts[i]);
      }
      if (::testing::Test::HasFailure()) return;
    }
  }
}

TEST(Queries, MayBeAskedByManyThreadsAtOnce) {
  const Crowd c = crowd(4, BroadPhaseKind::bvh, 2), alone = crowd(4, BroadPhaseKind::bvh);
  Random random{std::mt19937(400)};
  std::vector<Ray> rays(1000);
  for (Ray& ray : rays) ray = random_ray(random);
  std::vector<CastHit> expected(rays.size());
  ASSERT_EQ(alone.world.cast_ray_batch(rays, expected).code, ErrorCode::none);
  std::array<std::vector<CastHit>, 4> out;
  std::vector<std::thread> threads;
  for (std::size_t t = 0; t < out.size(); ++t) {
    threads.emplace_back([&, t] {
      out[t].resize(rays.size());
      if (t % 2 == 0) {
        EXPECT_EQ(c.world.cast_ray_batch(rays, out[t]).code, ErrorCode::none);
        return;
      }
      for (std::size_t i = 0; i < rays.size(); ++i)
        out[t][i] = c.world.cast_ray(rays[i].origin, rays[i].translation).value_or(CastHit{});
    });
  }
  for (std::thread& thread : threads) thread.join();
  for (const std::vector<CastHit>& hits : out) {
    for (std::size_t i = 0; i < rays.size(); ++i) expect_same(hits[i], expected[i]);
  }
}

TEST(Queries, SeeEveryChangeAtOnceAndChangeNothing) {
  World world = make_world({.gravity = {}});
  const auto height = [&] {
    const std::optional<CastHit> hit = world.cast_ray({0, 20, 0}, {0, -40, 0});
    return hit ? hit->point.y : -100.0;
  };
  EXPECT_EQ(height(), -100.0);
  const BodyId box = world.add_body({}, {.geometry = Box{}});
  EXPECT_DOUBLE_EQ(height(), 0.5);
  world.set_pose(box, {{0, 3, 0}, {}});
  EXPECT_DOUBLE_EQ(height(), 3.5);
  world.step(kStep);
  EXPECT_DOUBLE_EQ(height(), 3.5);
  const ShapeId more = world.add_shape(box, {.geometry = Sphere{0.5f}, .local = {{0, 2, 0}, {}}});
  EXPECT_DOUBLE_EQ(height(), 5.5);
  EXPECT_EQ(world.cast_ray({0, 20, 0}, {0, -40, 0})->shape_index, 1);
  world.set_broad_phase(BroadPhaseKind::brute_force);
  EXPECT_DOUBLE_EQ(height(), 5.5);
  world.set_broad_phase(BroadPhaseKind::bvh);
  EXPECT_DOUBLE_EQ(height(), 5.5);
  world.remove_shape(more);
  EXPECT_DOUBLE_EQ(height(), 3.5);
  world.set_velocity(box, {0, 60, 0}, {});
  world.step(kStep);
  EXPECT_NEAR(height(), 4.5, 1e-5);
  world.remove_body(box);
  EXPECT_EQ(height(), -100.0);

  Crowd asked = crowd(1, BroadPhaseKind::bvh), left_alone = crowd(1, BroadPhaseKind::bvh);
  Random random{std::mt19937(1)};
  for (int i = 0; i < 60; ++i) {
    for (int k = 0; k < 5; ++k) {
      const Ray ray = random_ray(random);
      (void)asked.world.cast_ray(ray.origin, ray.translation);
    }
    asked.world.step(kStep);
    left_alone.world.step(kStep);
    ASSERT_EQ(asked.world.hash(), left_alone.world.hash()) << i;
  }
}

bool not_that(void* user, ShapeId, BodyId body) { return *static_cast<BodyId*>(user) != body; }

TEST(Queries, LeaveOutWhatTheFilterSays) {
  World world = make_world();
  BodyId bodies[4];
  for (int i = 0; i < 4; ++i) {
    bodies[i] = world.add_body({.type = BodyType::fixed, .pose = {.position = {2.0 * i, 0, 0}}},
                               {.geometry = Sphere{0.5f}, .filter = {.layer = 1u << i}, .sensor = i == 0});
  }
  const auto first = [&](const QueryFilter& filter) {
    const std::optional<CastHit> hit = world.cast_ray({-5, 0, 0}, {20, 0, 0}, filter);
    return hit ? hit->body : BodyId{};
  };
  EXPECT_EQ(first({}), bodies[1]);
  EXPECT_EQ(first({.sensors = true}), bodies[0]);
  EXPECT_EQ(first({.layers = 4u | 8u}), bodies[2]);
  EXPECT_EQ(first({.layers = 16u}), BodyId{});
  EXPECT_EQ(first({.ignored = bodies[1]}), bodies[2]);
  EXPECT_EQ(first({.accepts = not_that, .user = &bodies[1]}), bodies[2]);
  std::array<CastHit, 8> all;
  EXPECT_EQ(world.cast_ray_all({-5, 0, 0}, {20, 0, 0}, all, {.sensors = true}), 4u);
  for (int i = 0; i < 4; ++i) EXPECT_EQ(all[std::size_t(i)].body, bodies[i]);
  // The nearest are kept where not all fit.
  std::array<CastHit, 2> two;
  EXPECT_EQ(world.cast_ray_all({20, 0, 0}, {-30, 0, 0}, two), 3u);
  EXPECT_EQ(two[0].body, bodies[3]);
  EXPECT_EQ(two[1].body, bodies[2]);
  EXPECT_EQ(world.cast_ray_all({20, 0, 0}, {-30, 0, 0}, {}), 3u);
}

// The same crowd, asked the same, a thousand kilometres away.
TEST(Queries, AreAsPreciseAThousandKilometresAway) {
  const DVec3 far_away{1.0e6, -0.7e6, 0.4e6};
  const Crowd near_crowd = crowd(1, BroadPhaseKind::bvh),
              far_crowd = crowd(1, BroadPhaseKind::bvh, 1, far_away);
  Random random{std::mt19937(500)};
  int hits = 0, differ = 0;
  for (int i = 0; i < 3000; ++i) {
    const Ray ray = random_ray(random);
    const std::optional<CastHit> a = near_crowd.world.cast_ray(ray.origin, ray.translation);
    const std::optional<CastHit> b = far_crowd.world.cast_ray(far_away + ray.origin, ray.translation);
    if (a.has_value() != b.has_value() || (a && a->shape.index != b->shape.index)) {
      ++differ;  // at an edge
      continue;
    }
    if (!a) continue;
    ++hits;
    EXPECT_LT(length(b->point - far_away - a->point), 1.0e-5);
    EXPECT_NEAR(a->fraction, b->fraction, 1.0e-6);
  }
  EXPECT_GT(hits, 500);
  EXPECT_LT(differ, 5);
  // A ray, and a ball, that start a thousand kilometres from what they meet.
  World world = make_world();
  world.add_body({.type = BodyType::fixed, .pose = {.position = far_away}}, {.geometry = Box{}});
  const std::optional<CastHit> ray = world.cast_ray(far_away + DVec3{0, 1.0e6, 0}, {0, -1.5e6f, 0});
  ASSERT_TRUE(ray.has_value());
  EXPECT_NEAR(ray->point.y - far_away.y, 0.5, 1e-9);
  EXPECT_NEAR(ray->fraction * 1.5e6, 1.0e6 - 0.5, 1e-8);
  const std::optional<CastHit> ball =
      world.cast_shape({Sphere{0.25f}, {far_away + DVec3{0, 1.0e6, 0}, {}}, {0, -1.5e6f, 0}});
  ASSERT_TRUE(ball.has_value());
  EXPECT_NEAR(ball->fraction * 1.5e6, 1.0e6 - 0.75, 1e-3);
}

// Moving the shape out by what is answered ends the overlap.
TEST(Queries, TellTheWayOutOfOverlap) {
  Random random{std::mt19937(600)};
  int overlaps = 0;
  for (int i = 0; i < 400; ++i) {
    World world = make_world();
    world.add_body({.type = BodyType::fixed, .pose = {{}, random.turn()}},
                   {.geometry = random_convex(random)});
    ShapePose place{random_convex(random), {DVec3(random.in_box(0.9f)), random.turn()}};
    std::array<Penetration, 4> out;
    const std::size_t count = world.penetration_all(place, out);
    EXPECT_EQ(count, world.overlap_any(place) ? 1u : 0u);
    if (count == 0) continue;
    ++overlaps;
    EXPECT_GT(out[0].depth, 0.0f);
    place.pose.position += (1.001 * double(out[0].depth) + 1e-5) * DVec3(out[0].normal);
    EXPECT_FALSE(world.overlap_any(place));
    place.pose.position = place.pose.position - (0.01 * double(out[0].depth) + 3e-5) * DVec3(out[0].normal);
    EXPECT_TRUE(world.overlap_any(place) || out[0].depth < 1e-3f);
  }
  EXPECT_GT(overlaps, 100);
  // Of a flat mesh floor: straight up, whatever lies below the shape.
  World world = make_world();
  std::vector<Vec3> vertices;
  std::vector<std::uint32_t> indices;
  for (int i = 0; i < 36; ++i) vertices.push_back({float(i % 6) - 2.5f, 0.0f, float(i / 6) - 2.5f});
  for (std::uint32_t k = 0; k < 25; ++k) {
    const std::uint32_t a = k / 5 * 6 + k % 5;
    indices.insert(indices.end(), {a, a + 6, a + 1, a + 1, a + 6, a + 7});
  }
  const BodyId floor =
      world.add_body({.type = BodyType::fixed}, {.geometry = *cook_mesh({vertices, indices})});
  std::array<Penetration, 8> out;
  ASSERT_EQ(world.penetration_all({Sphere{0.5f}, {{0.1, 0.4, 0.3}, {}}}, out), 1u);
  EXPECT_EQ(out[0].body, floor);
  EXPECT_NEAR(out[0].depth, 0.1f, 1e-6f);
  EXPECT_NEAR(out[0].normal.y, 1.0f, 1e-6f);
  EXPECT_GE(out[0].triangle, 0);
}

TEST(Queries, NameTheTriangleOfTheMeshAsItWasGiven) {
  Random random{std::mt19937(700)};
  World world = make_world();
  const Geometry mesh = rough_mesh(random, false);
  world.add_body({.type = BodyType::fixed}, {.geometry = mesh});
  // The mesh of rough_mesh: triangle 2 * cell lies on the side of the cell's lower corner.
  for (int i = 0; i < 200; ++i) {
    const double x = double(random(-5.4f, 5.4f)), z = double(random(-5.4f, 5.4f));
    const std::optional<CastHit> hit = world.cast_ray({x, 5, z}, {0, -10, 0});
    ASSERT_TRUE(hit.has_value());
    const double u = x + 5.5, v = z + 5.5;
    const int column = int(u), row = int(v);
    const int half = (u - column) + (v - row) > 1.0 ? 1 : 0;
    EXPECT_EQ(hit->triangle, 2 * (row * 11 + column) + half);
    EXPECT_EQ(hit->shape_index, 0);
  }
}

TEST(Queries, ThatCannotBeAskedFindNothingAndSayWhy) {
  World world = make_world();
  add_ground(world);
  const float nan = std::numeric_limits<float>::quiet_NaN(), inf = std::numeric_limits<float>::infinity();
  for (const float bad : {nan, inf, -inf}) {
    EXPECT_FALSE(world.cast_ray({0, double(bad), 0}, {0, -1, 0}).has_value());
    EXPECT_FALSE(world.cast_ray({0, 1, 0}, {0, bad, 0}).has_value());
    EXPECT_FALSE(world.cast_ray_any({0, 1, 0}, {0, bad, 0}));
    EXPECT_EQ(world.cast_ray_all({0, 1, 0}, {0, bad, 0}, {}), 0u);
    EXPECT_FALSE(world.cast_shape({Sphere{}, {{0, 3, 0}, {}}, {0, bad, 0}}).has_value());
    EXPECT_FALSE(world.cast_shape({Sphere{bad}, {{0, 3, 0}, {}}, {0, -5, 0}}).has_value());
    EXPECT_FALSE(world.cast_shape({Sphere{}, {{0, 3, 0}, {0, 0, bad, 1}}, {0, -5, 0}}).has_value());
    EXPECT_FALSE(world.overlap_any({Sphere{bad}, {}}));
    EXPECT_FALSE(world.closest_point({Sphere{}, {{0, double(bad), 0}, {}}}, 1.0).has_value());
    EXPECT_NE(std::strstr(check_ray({{0, 1, 0}, {0, bad, 0}}).message, "ray: translation"), nullptr);
  }
  EXPECT_FALSE(world.closest_point({Sphere{}, {{0, 1, 0}, {}}}, double(nan)).has_value());
  EXPECT_FALSE(world.closest_point({Sphere{}, {{0, 1, 0}, {}}}, -1.0).has_value());
  EXPECT_FALSE(world.overlap_any({Plane{}, {}}));
  EXPECT_EQ(check_shape_pose({Plane{}, {}}).code, ErrorCode::invalid_geometry);
  EXPECT_NE(std::strstr(check_shape_pose({Plane{}, {}}).message, "plane"), nullptr);
  EXPECT_EQ(check_shape_cast({Sphere{}, {}, {}, -1.0f}).code, ErrorCode::invalid_argument);
  EXPECT_EQ(check_shape_cast({Sphere{}, {}, {0, 1, 0}}).code, ErrorCode::none);
  EXPECT_EQ(check_ray({{0, 1, 0}, {}}).code, ErrorCode::none);  // without length it is a point

  std::vector<Ray> rays(5);
  rays[3].translation.y = nan;
  std::vector<CastHit> out(5);
  const Error error = world.cast_ray_batch(rays, out);
  EXPECT_EQ(error.code, ErrorCode::invalid_argument);
  EXPECT_NE(std::strstr(error.message, "question 3"), nullptr) << error.message;
  EXPECT_EQ(world.cast_ray_batch(std::span(rays).first(3), out).code, ErrorCode::invalid_argument);
  EXPECT_EQ(world.cast_ray_batch({}, {}).code, ErrorCode::none);
}

TEST(Queries, OfPointsAndTouchingShapes) {
  World world = make_world();
  const BodyId box = world.add_body({.type = BodyType::fixed}, {.geometry = Box{}});
  // A ray without length is a point.
  EXPECT_TRUE(world.cast_ray({0.4, 0, 0}, {})->inside);
  EXPECT_FALSE(world.cast_ray({0.6, 0, 0}, {}).has_value());
  // Touching is overlap of no depth.
  EXPECT_TRUE(world.overlap_any({Sphere{0.5f}, {{1, 0, 0}, {}}}));
  EXPECT_FALSE(world.overlap_any({Sphere{0.5f}, {{1.00001, 0, 0}, {}}}));
  std::array<Penetration, 2> none;
  EXPECT_EQ(world.penetration_all({Sphere{0.5f}, {{1, 0, 0}, {}}}, none), 0u);
  const std::optional<ClosestPoint> near = world.closest_point({Sphere{0.5f}, {{3, 0, 0}, {}}}, 10.0);
  ASSERT_TRUE(near.has_value());
  EXPECT_EQ(near->body, box);
  EXPECT_NEAR(near->distance, 2.0, 1e-12);
  EXPECT_NEAR(near->point.x, 0.5, 1e-12);
  EXPECT_NEAR(near->query_point.x, 2.5, 1e-12);
  EXPECT_FALSE(world.closest_point({Sphere{0.5f}, {{3, 0, 0}, {}}}, 1.99).has_value());
}

}  // namespace
}  // namespace gyre::laws::queries_test
