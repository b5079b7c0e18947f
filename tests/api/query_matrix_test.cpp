// Every question (ray, moving shape, overlap, closest point, penetration) in every form (closest, any, all; alone and in a
// batch over threads) under every filter (layers, callback, sensors, an ignored body), against brute force: every shape of
// the world is asked by its own geometry, without broad phase and filters of the world.
#include "api/query_crowd.h"

#include "geometry/manifold/manifold.h"
#include "geometry/query/cast_surface.h"
#include "geometry/query/closest_points.h"

#include <functional>
#include <type_traits>

namespace gyre::laws::query_matrix_test {
namespace {

constexpr std::size_t kRoom = 3;  // answers kept of each question, fewer than some have
constexpr double kNear = 2.5;     // m
constexpr double kSame =
    1.0e-6;  // m, or of the way: the frames of shapes are rounded once more in the oracle

// What decides the order of answers, and whose they are.
struct Found {
  std::uint32_t shape = 0;
  int triangle = -1;
  double measure = 0.0;
};
using Answers = std::vector<Found>;

Found found(const CastHit& a) { return {a.shape.index, a.triangle, a.fraction}; }
Found found(const Overlap& a) { return {a.shape.index, a.triangle, 0.0}; }
Found found(const ClosestPoint& a) { return {a.shape.index, a.triangle, a.distance}; }
Found found(const Penetration& a) { return {a.shape.index, a.triangle, -double(a.depth)}; }

// One shape of the world as the oracle sees it.
struct Target {
  BodyId body;
  ShapeId id;
  ShapeDef def;
  Shape shape;
  Pose pose;

  DVec3 to_local(DVec3 p) const { return rotate_inverse(turn(), p - pose.position); }
  DQuat turn() const { return normalized(to_double(pose.orientation)); }
};

bool even_shape(void*, ShapeId shape, BodyId) { return shape.index % 2 == 0; }

struct FilterCase {
  const char* name;
  QueryFilter filter;
  bool ignores = false;  // a body that would be met often
};

bool is_let_through(const QueryFilter& f, const Target& t) {
  if ((t.def.filter.layer & f.layers) == 0 || (t.def.sensor && !f.sensors) || t.body == f.ignored)
    return false;
  return f.accepts == nullptr || t.id.index % 2 == 0;
}

struct Oracle {
  const Crowd& crowd;
  std::vector<Target> targets;

  explicit Oracle(const Crowd& c) : crowd(c) {
    for (std::size_t i = 0; i < c.bodies.size(); ++i) {
      if (!c.world.exists(c.bodies[i])) continue;
      const auto ids = c.world.shapes(c.bodies[i]);
      for (std::size_t k = 0; k < ids.size(); ++k) {
        const ShapeDef& def = c.shapes[i][k];
        targets.push_back(
            {c.bodies[i], ids[k], def, make_shape(def.geometry), c.world.pose(c.bodies[i]) * def.local});
      }
    }
  }

  // look(target, answers) for all that the filter lets through, in the order of the world's answers.
  template <class Look>
  Answers all(const QueryFilter& filter, Look&& look) const {
    Answers out;
    for (const Target& t : targets) {
      if (is_let_through(filter, t)) look(t, out);
    }
    std::sort(out.begin(), out.end(), [](const Found& a, const Found& b) {
      return a.measure != b.measure ? a.measure < b.measure
                                    : std::pair(a.shape, a.triangle) < std::pair(b.shape, b.triangle);
    });
    return out;
  }
  static int number(std::uint32_t triangle) { return triangle == kNoTriangle ? -1 : int(triangle); }

  Answers rays(const Ray& ray, const QueryFilter& f) const {
    return all(f, [&](const Target& t, Answers& out) {
      LocalHit hit;
      const LocalRay local{t.to_local(ray.origin), rotate_inverse(t.turn(), DVec3(ray.translation))};
      if (cast_ray(t.shape, local, 1.0, f.back_faces, hit))
        out.push_back({t.id.index, number(hit.triangle), hit.fraction});
    });
  }
  Answers casts(const ShapeCast& cast, const QueryFilter& f) const {
    const Shape shape = make_shape(cast.shape);
    return all(f, [&](const Target& t, Answers& out) {
      LocalHit hit;
      const MovingShape moving{&shape, t.to_local(cast.pose.position),
                               conjugate(t.turn()) * normalized(to_double(cast.pose.orientation)),
                               rotate_inverse(t.turn(), DVec3(cast.translation)), cast.skin};
      if (cast_shape(t.shape, moving, 1.0, f.back_faces, hit))
        out.push_back({t.id.index, number(hit.triangle), hit.fraction});
    });
  }
  Answers near(const ShapePose& place, double reach, const QueryFilter& f) const {
    const Shape shape = make_shape(place.shape);
    return all(f, [&](const Target& t, Answers& out) {
      ClosestPair nearest;
      const PosedShape placed{&shape, t.to_local(place.pose.position),
                              conjugate(t.turn()) * normalized(to_double(place.pose.orientation))};
      if (find_closest_points(t.shape, placed, reach, nearest))
        out.push_back({t.id.index, number(nearest.triangle), nearest.distance});
    });
  }
  Answers deep(const ShapePose& place, const QueryFilter& f) const {
    const Shape shape = make_shape(place.shape);
    return all(f, [&](const Target& t, Answers& out) {
      PairCache cache;
      LocalManifold manifolds[kMaxMeshManifolds];
      const Pose own{place.pose.position, normalized(place.pose.orientation)};
      const int count = collide_shapes(t.shape, shape, inverse_times(t.pose, own), 0.0f, cache, manifolds);
      for (int i = 0; i < count; ++i) {
        double depth = 0.0;
        for (int k = 0; k < manifolds[i].count; ++k)
          depth = max(depth, -double(manifolds[i].points[k].separation));
        const bool surface = t.shape.kind == ShapeKind::mesh || t.shape.kind == ShapeKind::height_field;
        const std::uint32_t id = surface ? public_triangle(t.shape, manifolds[i].triangle) : kNoTriangle;
        if (depth > 0.0) out.push_back({t.id.index, number(id), -depth});
      }
    });
  }
};

// Where the nearest point lies on an edge, rounding decides which of its two triangles is named.
int& other_triangles() {
  static int count = 0;
  return count;
}

// `some` is the first of all answers, as many as fit.
template <class Answer>
void expect_first(std::span<const Answer> some, std::size_t count, const Answers& wanted) {
  ASSERT_EQ(count, wanted.size());
  for (std::size_t i = 0; i < min(some.size(), count); ++i) {
    const Found got = found(some[i]);
    EXPECT_NEAR(got.measure, wanted[i].measure, kSame);
    // Answers that are equal but for rounding may stand in another order.
    const bool alone = (i == 0 || wanted[i].measure - wanted[i - 1].measure > kSame) &&
                       (i + 1 == count || wanted[i + 1].measure - wanted[i].measure > kSame);
    if (!alone) continue;
    EXPECT_EQ(got.shape, wanted[i].shape);
    if (got.triangle != wanted[i].triangle) ++other_triangles();
  }
}

// One kind of question put to a world in all its forms.
template <class Question, class Answer>
struct Forms {
  std::function<Answers(const Question&)> oracle;
  std::function<std::optional<Answer>(const World&, const Question&)> closest;
  std::function<bool(const World&, const Question&)> any;
  std::function<std::size_t(const World&, const Question&, std::span<Answer>)> all;
  std::function<Error(const World&, std::span<const Question>, std::span<Answer>)> closest_batch;
  std::function<Error(const World&, std::span<const Question>, std::span<std::uint8_t>)> any_batch;
  std::function<Error(const World&, std::span<const Question>, std::span<Answer>, std::span<std::uint32_t>)>
      all_batch;
};

// Returns how many answers there were.
template <class Question, class Answer>
std::size_t compare(const World& world, const std::vector<Question>& questions,
                    const Forms<Question, Answer>& f) {
  const std::size_t n = questions.size();
  std::vector<Answer> closest(n), all(n * kRoom);
  std::vector<std::uint8_t> any(n, 7);
  std::vector<std::uint32_t> counts(n, 77);
  if (f.closest_batch) {
    EXPECT_EQ(f.closest_batch(world, questions, closest).code, ErrorCode::none);
  }
  EXPECT_EQ(f.any_batch(world, questions, any).code, ErrorCode::none);
  EXPECT_EQ(f.all_batch(world, questions, all, counts).code, ErrorCode::none);
  std::size_t answers = 0;
  other_triangles() = 0;
  for (std::size_t i = 0; i < n && !::testing::Test::HasFailure(); ++i) {
    SCOPED_TRACE(i);
    const Answers wanted = f.oracle(questions[i]);
    answers += wanted.size();
    const std::size_t one = min(wanted.size(), std::size_t(1));
    if (f.closest) {
      const std::optional<Answer> first = f.closest(world, questions[i]);
      EXPECT_EQ(first.has_value(), one == 1);
      if (first) expect_first<Answer>(std::span(&*first, 1), wanted.size(), wanted);
      EXPECT_EQ(closest[i] ? 1u : 0u, one);
      if (closest[i]) expect_first<Answer>(std::span(&closest[i], 1), wanted.size(), wanted);
    }
    EXPECT_EQ(f.any(world, questions[i]), one == 1);
    EXPECT_EQ(any[i], one);
    std::vector<Answer> out(kRoom);
    expect_first<Answer>(out, f.all(world, questions[i], out), wanted);
    expect_first<Answer>(std::span(all).subspan(i * kRoom, kRoom), counts[i], wanted);
  }
  EXPECT_LE(other_triangles(), 4);  // one question in all its forms
  return answers;
}

class QueryMatrix : public ::testing::TestWithParam<FilterCase> {
 protected:
  void SetUp() override {
    filter_ = GetParam().filter;
    if (GetParam().ignores) filter_.ignored = crowd_.bodies[0];
    for (int i = 0; i < 300; ++i) {
      rays_.push_back(random_ray(random_));
      places_.push_back(random_place(random_));
      if (i % 2 == 0) casts_.push_back(random_cast(random_));
    }
  }
  Random random_{std::mt19937(42)};
  const Crowd crowd_ = crowd(5, BroadPhaseKind::bvh, 2);
  const Oracle oracle_{crowd_};
  QueryFilter filter_;
  std::vector<Ray> rays_;
  std::vector<ShapeCast> casts_;
  std::vector<ShapePose> places_;
};

TEST_P(QueryMatrix, Rays) {
  const QueryFilter& f = filter_;
  Forms<Ray, CastHit> forms;
  forms.oracle = [&](const Ray& r) { return oracle_.rays(r, f); };
  forms.closest = [&](const World& w, const Ray& r) { return w.cast_ray(r.origin, r.translation, f); };
  forms.any = [&](const World& w, const Ray& r) { return w.cast_ray_any(r.origin, r.translation, f); };
  forms.all = [&](const World& w, const Ray& r, auto out) { return w.cast_ray_all(r.origin, r.translation, out, f); };
  forms.closest_batch = [&](const World& w, auto q, auto out) { return w.cast_ray_batch(q, out, f); };
  forms.any_batch = [&](const World& w, auto q, auto out) { return w.cast_ray_any_batch(q, out, f); };
  forms.all_batch = [&](const World& w, auto q, auto out, auto n) { return w.cast_ray_all_batch(q, out, n, f); };
  EXPECT_GT(compare(crowd_.world, rays_, forms), rays_.size() / 4);
}

TEST_P(QueryMatrix, MovingShapes) {
  const QueryFilter& f = filter_;
  Forms<ShapeCast, CastHit> forms;
  forms.oracle = [&](const ShapeCast& c) { return oracle_.casts(c, f); };
  forms.closest = [&](const World& w, const ShapeCast& c) { return w.cast_shape(c, f); };
  forms.any = [&](const World& w, const ShapeCast& c) { return w.cast_shape_any(c, f); };
  forms.all = [&](const World& w, const ShapeCast& c, auto out) { return w.cast_shape_all(c, out, f); };
  forms.closest_batch = [&](const World& w, auto q, auto out) { return w.cast_shape_batch(q, out, f); };
  forms.any_batch = [&](const World& w, auto q, auto out) { return w.cast_shape_any_batch(q, out, f); };
  forms.all_batch = [&](const World& w, auto q, auto out, auto n) { return w.cast_shape_all_batch(q, out, n, f); };
  EXPECT_GT(compare(crowd_.world, casts_, forms), casts_.size() / 4);
}

// Overlaps have no closest: how deep they are, penetrations tell.
TEST_P(QueryMatrix, Overlaps) {
  const QueryFilter& f = filter_;
  Forms<ShapePose, Overlap> forms;
  forms.oracle = [&](const ShapePose& p) { return oracle_.near(p, 0.0, f); };
  forms.any = [&](const World& w, const ShapePose& p) { return w.overlap_any(p, f); };
  forms.all = [&](const World& w, const ShapePose& p, auto out) { return w.overlap_all(p, out, f); };
  forms.any_batch = [&](const World& w, auto q, auto out) { return w.overlap_any_batch(q, out, f); };
  forms.all_batch = [&](const World& w, auto q, auto out, auto n) {
    return w.overlap_all_batch(q, out, n, f);
  };
  EXPECT_GT(compare(crowd_.world, places_, forms), places_.size() / 20);
  std::vector<std::uint32_t> counts(places_.size());
  EXPECT_EQ(crowd_.world.overlap_count_batch(places_, counts, f).code, ErrorCode::none);
  for (std::size_t i = 0; i < places_.size(); ++i)
    EXPECT_EQ(counts[i], oracle_.near(places_[i], 0.0, f).size());
}

TEST_P(QueryMatrix, ClosestPoints) {
  const QueryFilter& f = filter_;
  Forms<ShapePose, ClosestPoint> forms;
  forms.oracle = [&](const ShapePose& p) { return oracle_.near(p, kNear, f); };
  forms.closest = [&](const World& w, const ShapePose& p) { return w.closest_point(p, kNear, f); };
  forms.any = [&](const World& w, const ShapePose& p) { return w.closest_point_any(p, kNear, f); };
  forms.all = [&](const World& w, const ShapePose& p, auto out) { return w.closest_point_all(p, kNear, out, f); };
  forms.closest_batch = [&](const World& w, auto q, auto out) { return w.closest_point_batch(q, kNear, out, f); };
  forms.any_batch = [&](const World& w, auto q, auto out) { return w.closest_point_any_batch(q, kNear, out, f); };
  forms.all_batch = [&](const World& w, auto q, auto out, auto n) {
    return w.closest_point_all_batch(q, kNear, out, n, f);
  };
  EXPECT_GT(compare(crowd_.world, places_, forms), places_.size() / 10);
}

TEST_P(QueryMatrix, Penetrations) {
  const QueryFilter& f = filter_;
  Forms<ShapePose, Penetration> forms;
  forms.oracle = [&](const ShapePose& p) { return oracle_.deep(p, f); };
  forms.closest = [&](const World& w, const ShapePose& p) { return w.penetration(p, f); };
  forms.any = [&](const World& w, const ShapePose& p) { return w.penetration(p, f).has_value(); };
  forms.all = [&](const World& w, const ShapePose& p, auto out) { return w.penetration_all(p, out, f); };
  forms.closest_batch = [&](const World& w, auto q, auto out) { return w.penetration_batch(q, out, f); };
  forms.any_batch = [&](const World& w, auto q, std::span<std::uint8_t> out) {
    std::vector<Penetration> deep(q.size());
    const Error e = w.penetration_batch(q, deep, f);
    for (std::size_t i = 0; i < deep.size(); ++i) out[i] = deep[i] ? 1 : 0;
    return e;
  };
  forms.all_batch = [&](const World& w, auto q, auto out, auto n) {
    return w.penetration_all_batch(q, out, n, f);
  };
  EXPECT_GT(compare(crowd_.world, places_, forms), places_.size() / 20);
}

INSTANTIATE_TEST_SUITE_P(
    Queries, QueryMatrix,
    ::testing::Values(FilterCase{"All", {}}, FilterCase{"Layers", {.layers = 1u | 4u}},
                      FilterCase{"Sensors", {.sensors = true}}, FilterCase{"BackFaces", {.back_faces = true}},
                      FilterCase{"Callback", {.accepts = even_shape}}, FilterCase{"Ignored", {}, true},
                      FilterCase{"Together", {.layers = 3u, .sensors = true, .accepts = even_shape}, true}),
    [](const auto& one) { return std::string(one.param.name); });

template <class Answer>
void expect_same_answers(const std::vector<Answer>& a, const std::vector<Answer>& b) {
  for (std::size_t i = 0; i < a.size(); ++i) {
    const Found x = found(a[i]), y = found(b[i]);
    EXPECT_EQ(a[i].body.index, b[i].body.index);
    EXPECT_EQ(x.shape, y.shape);
    EXPECT_EQ(x.triangle, y.triangle);
    EXPECT_EQ(x.measure, y.measure);
    if constexpr (!std::is_same_v<Answer, Overlap>) {
      EXPECT_EQ(a[i].point, b[i].point);
      EXPECT_EQ(a[i].normal, b[i].normal);
    }
  }
}

// Bit for bit, over one worker, two and four, with another broad phase.
TEST(QueryBatches, HaveTheSameBitsOverThreads) {
  Random random{std::mt19937(43)};
  std::vector<Ray> rays(400);
  std::vector<ShapeCast> casts(200);
  std::vector<ShapePose> places(300);
  for (Ray& ray : rays) ray = random_ray(random);
  for (ShapeCast& cast : casts) cast = random_cast(random);
  for (ShapePose& place : places) place = random_place(random);
  struct Batches {
    std::vector<CastHit> rays, casts;
    std::vector<Overlap> overlaps;
    std::vector<ClosestPoint> near;
    std::vector<Penetration> deepest, deep;
    std::vector<std::uint32_t> counts[5];
    std::vector<std::uint8_t> any[4];
  };
  const auto ask = [&](const World& w) {
    Batches b;
    b.rays.resize(kRoom * rays.size()), b.casts.resize(kRoom * casts.size());
    b.overlaps.resize(kRoom * places.size()), b.near.resize(kRoom * places.size());
    b.deepest.resize(places.size()), b.deep.resize(kRoom * places.size());
    const std::size_t sizes[5] = {rays.size(), casts.size(), places.size(), places.size(), places.size()};
    for (int i = 0; i < 5; ++i) b.counts[i].resize(sizes[i]);
    for (int i = 0; i < 4; ++i) b.any[i].resize(sizes[i]);
    const Error errors[] = {w.cast_ray_all_batch(rays, b.rays, b.counts[0]),
                            w.cast_shape_all_batch(casts, b.casts, b.counts[1]),
                            w.overlap_all_batch(places, b.overlaps, b.counts[2]),
                            w.closest_point_all_batch(places, kNear, b.near, b.counts[3]),
                            w.penetration_all_batch(places, b.deep, b.counts[4]),
                            w.penetration_batch(places, b.deepest),
                            w.cast_ray_any_batch(rays, b.any[0]),
                            w.cast_shape_any_batch(casts, b.any[1]),
                            w.overlap_any_batch(places, b.any[2]),
                            w.closest_point_any_batch(places, kNear, b.any[3])};
    for (const Error& error : errors) EXPECT_EQ(error.code, ErrorCode::none) << error.message;
    return b;
  };
  const Crowd one = crowd(5, BroadPhaseKind::brute_force);
  const Batches expected = ask(one.world);
  for (const int threads : {1, 2, 4}) {
    const Crowd c = crowd(5, BroadPhaseKind::bvh, threads);
    const Batches got = ask(c.world);
    expect_same_answers(got.rays, expected.rays);
    expect_same_answers(got.casts, expected.casts);
    expect_same_answers(got.overlaps, expected.overlaps);
    expect_same_answers(got.near, expected.near);
    expect_same_answers(got.deep, expected.deep);
    expect_same_answers(got.deepest, expected.deepest);
    for (int i = 0; i < 5; ++i) EXPECT_EQ(got.counts[i], expected.counts[i]);
    for (int i = 0; i < 4; ++i) EXPECT_EQ(got.any[i], expected.any[i]);
  }
}

// What overlaps by no more than the skin may be left and slid along, but not entered.
TEST(QuerySkin, LetsGoOfWhatItStandsIn) {
  World world = make_world();
  add_ground(world);
  const auto cast = [&](Vec3 way, float skin) {
    return world.cast_shape({Box{}, {{0, 0.49, 0}, {}}, way, skin}).has_value();
  };
  EXPECT_TRUE(cast({1, 0, 0}, 0.0f));
  EXPECT_TRUE(cast({1, 0, 0}, 0.005f));
  EXPECT_FALSE(cast({1, 0, 0}, 0.02f));
  EXPECT_FALSE(cast({0, 1, 0}, 0.02f));
  EXPECT_TRUE(cast({0, -1, 0}, 0.02f));
}

// Room that cannot be shared out alike, and counts of another length, are refused; no room at all only counts.
TEST(QueryBatches, SayWhyTheyCannotBeAsked) {
  World world = make_world();
  add_ground(world);
  const std::vector<Ray> rays(3, Ray{{0, 1, 0}, {0, -2, 0}});
  std::vector<CastHit> out(7);
  std::vector<std::uint32_t> counts(3);
  EXPECT_EQ(world.cast_ray_all_batch(rays, out, counts).code, ErrorCode::invalid_argument);
  EXPECT_EQ(world.cast_ray_all_batch(rays, std::span(out).first(6), std::span(counts).first(2)).code,
            ErrorCode::invalid_argument);
  EXPECT_EQ(counts[0], 0u);
  EXPECT_EQ(world.cast_ray_all_batch(rays, {}, counts).code, ErrorCode::none);
  EXPECT_EQ(counts[2], 1u);
  EXPECT_EQ(world.cast_ray_all_batch({}, {}, {}).code, ErrorCode::none);
  std::vector<std::uint8_t> near(1);
  EXPECT_EQ(world.closest_point_any_batch(std::vector<ShapePose>(1), -1.0, near).code, ErrorCode::invalid_argument);
}

}  // namespace
}  // namespace gyre::laws::query_matrix_test
