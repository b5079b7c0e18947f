// Points between vertices that bodies hold: what is refused, what lets them go, and that a state goes on with them.
#include <gyre/gyre.h>
#include <gyre/replay.h>

#include <gtest/gtest.h>

#include <string>

namespace gyre::soft_points_test {
namespace {

constexpr float kStep = 1.0f / 60.0f;

struct Hung {
  World world;
  SoftId sheet;
  BodyId ball;
  SoftPoint point;
};

// A ball hangs on a point of the middle of a sheet that is held at one edge, above the ground.
Hung make_hung(const WorldDef& def = {}, float tear_strain = 0.0f) {
  Hung h{std::move(*World::create(def)), {}, {}, {}};
  h.world.add_body({.type = BodyType::fixed, .pose = {{0, -2, 0}, {}}}, {.geometry = Plane{}});
  h.sheet = h.world.add_cloth({.grid = ClothGrid{{1, 1}, {6, 6}}, .tear_strain = tear_strain});
  for (int k = 0; k < 7; ++k) h.world.pin(h.sheet, k);
  h.ball = h.world.add_body({.pose = {{0.05, -0.1, 0.1}, {}}}, {.geometry = Sphere{0.1f}, .density = 500.0f});
  h.point = h.world.nearest_soft_point(h.sheet, {0.05, 0, 0.1});
  EXPECT_TRUE(h.world.attach_point(h.sheet, h.point, h.ball));
  return h;
}
DVec3 place_of(const World& world, SoftId soft, const SoftPoint& point) {
  DVec3 sum{};
  for (std::size_t k = 0; k < 4; ++k)
    sum += double(point.weights[k]) * world.vertices(soft).position(std::size_t(point.vertices[k]));
  return sum;
}
double gap(const Hung& h) {
  return length(place_of(h.world, h.sheet, h.point) - h.world.pose(h.ball).position);
}

TEST(SoftPoint, IsWhatIsNearest) {
  World world = std::move(*World::create());
  const SoftId solid = world.add_solid({.box = SolidBox{{0.5f, 0.5f, 0.5f}, {2, 2, 2}}});
  const auto nearest = [&](DVec3 place) {
    return place_of(world, solid, world.nearest_soft_point(solid, place));
  };
  EXPECT_LT(length(nearest({0.1, -0.2, 0.3}) - DVec3{0.1, -0.2, 0.3}), 1e-6);
  EXPECT_LT(length(nearest({0.1, -0.2, 3}) - DVec3{0.1, -0.2, 0.5}), 1e-6);
  EXPECT_LT(length(nearest({1, 2, 3}) - DVec3{0.5, 0.5, 0.5}), 1e-6);
  const SoftId rope = world.add_rope({.points = {{0, 0, 0}, {1, 0, 0}}, .segments = 4});
  EXPECT_EQ(world.nearest_soft_point(rope, {0, 0, 0}).weights, (std::array<float, 4>{}));
}

// The hit of a ray names a point, of a solid's surface too.
TEST(SoftPoint, OfAHitCanBeHeld) {
  World world = std::move(*World::create());
  const SoftId solid = world.add_solid({.box = SolidBox{{0.5f, 0.5f, 0.5f}, {2, 2, 2}}});
  const auto hit = world.cast_ray({0.1, 2, 0.2}, {0, -4, 0});
  ASSERT_TRUE(hit && hit->soft == solid);
  const std::size_t first = 3 * std::size_t(hit->triangle);
  const auto corner = [&](std::size_t k) { return int(world.soft_triangles(solid)[first + k]); };
  const SoftPoint point{{corner(0), corner(1), corner(2), 0},
                        {hit->weights.x, hit->weights.y, hit->weights.z, 0}};
  EXPECT_LT(length(place_of(world, solid, point) - DVec3{0.1, 0.5, 0.2}), 1e-6);
  EXPECT_TRUE(world.pin_point(solid, point));
  for (int i = 0; i < 60; ++i) world.step(kStep);
  EXPECT_LT(length(place_of(world, solid, point) - DVec3{0.1, 0.5, 0.2}), 1e-3);
}

TEST(SoftPoint, RefusesWhatIsNone) {
  Hung h = make_hung();
  const SoftId rope = h.world.add_rope({.points = {{0, 5, 0}, {1, 5, 0}}, .segments = 4});
  ClothDef decoration{.grid = ClothGrid{{1, 1}, {2, 2}}};
  decoration.settings.integrator = SoftIntegrator::visual;
  const SoftId visual = h.world.add_cloth(decoration);
  const BodyId gone = h.world.add_body({});
  h.world.remove_body(gone);
  struct Case {
    SoftId soft;
    SoftPoint point;
    BodyId body;
    const char* says;
  };
  const SoftPoint good{{0, 1, 7, 0}, {0.5f, 0.25f, 0.25f, 0}};
  const Case cases[] = {
      {h.sheet, {{0, 1, 7, 0}, {0.5f, 0.25f, 0.5f, 0}}, h.ball, "add up to 1.25"},
      {h.sheet, {{0, 1, 7, 0}, {1.5f, -0.25f, -0.25f, 0}}, h.ball, "within 0 and 1"},
      {h.sheet, {{0, 1, 7, 0}, {0.5f, 0.0f / 0.0f, 0.5f, 0}}, h.ball, "within 0 and 1"},
      {h.sheet, {}, h.ball, "add up to 0"},
      {h.sheet, {{0, 1, 49, 0}, {0.5f, 0.25f, 0.25f, 0}}, h.ball, "within 0 and 48"},
      {h.sheet, {{0, 1, 1, 0}, {0.5f, 0.25f, 0.25f, 0}}, h.ball, "named twice"},
      {h.sheet, {{0, 1, 48, 0}, {0.5f, 0.25f, 0.25f, 0}}, h.ball, "no triangle"},
      {h.sheet, good, gone, "does not exist"},
      {h.sheet, good, BodyId{}, "does not exist"},
      {SoftId{}, good, h.ball, "does not exist"},
      {rope, good, h.ball, "rope is held at its vertices"},
      {visual, good, h.ball, "visual is held at its vertices"},
  };
  const std::uint64_t before = h.world.hash();
  for (const Case& c : cases) {
    EXPECT_FALSE(h.world.attach_point(c.soft, c.point, c.body)) << c.says;
    ASSERT_FALSE(h.world.problems().empty()) << c.says;
    EXPECT_NE(std::string(h.world.problems().back().message).find(c.says), std::string::npos)
        << h.world.problems().back().message;
  }
  EXPECT_EQ(h.world.hash(), before);
  EXPECT_FALSE(h.world.release_points(h.sheet, gone));
  EXPECT_FALSE(h.world.release_points({}, h.ball));
}

TEST(SoftPoint, IsLetGoByCommandAndWithItsBody) {
  Hung h = make_hung();
  for (int i = 0; i < 120; ++i) h.world.step(kStep);
  EXPECT_NEAR(gap(h), 0.1, 1e-3);
  EXPECT_TRUE(h.world.release_points(h.sheet, {}));  // the world holds none
  EXPECT_TRUE(h.world.release_points(h.sheet, h.ball));
  for (int i = 0; i < 120; ++i) h.world.step(kStep);
  EXPECT_GT(gap(h), 0.5);

  Hung other = make_hung();
  other.world.step(kStep);
  other.world.remove_body(other.ball);
  for (int i = 0; i < 60; ++i) other.world.step(kStep);
  EXPECT_TRUE(other.world.problems().empty());
  EXPECT_TRUE(other.world.pin_point(other.sheet, other.point));
  EXPECT_TRUE(other.world.release_points(other.sheet, {}));
}

// One that sleeps keeps its place, and wakes what hangs on it when it is let go.
TEST(SoftPoint, SleepsAndWakes) {
  Hung h = make_hung();
  FieldDef brake;
  brake.kind = FieldKind::drag;
  brake.drag_coefficient = 0.0f;
  brake.linear_drag = 5.0f;
  const FieldId field = h.world.add_field(brake);
  for (int i = 0; i < 300; ++i) h.world.step(kStep);
  h.world.remove_field(field);
  int steps = 0;
  while (h.world.soft_info(h.sheet).awake && ++steps < 600) h.world.step(kStep);
  EXPECT_FALSE(h.world.soft_info(h.sheet).awake);
  EXPECT_FALSE(h.world.is_awake(h.ball));
  h.world.release_points(h.sheet, h.ball);
  for (int i = 0; i < 60; ++i) h.world.step(kStep);
  EXPECT_GT(gap(h), 0.3);
}

// A crack leaves a point with its triangle, whose corners have other numbers then.
TEST(SoftPoint, StaysWithItsTriangleWhenTheSheetTears) {
  Hung h = make_hung({}, 0.2f);
  const auto corner = [&](std::size_t k) { return int(h.world.soft_triangles(h.sheet)[k]); };
  const auto weight_of = [&](int vertex) {
    for (std::size_t k = 0; k < 3; ++k)
      if (h.point.vertices[k] == vertex) return h.point.weights[k];
    return 0.0f;
  };
  std::size_t first = 0;
  float weights[3] = {};
  for (;; first += 3) {
    ASSERT_LT(first, h.world.soft_triangles(h.sheet).size());
    float sum = 0.0f;
    for (std::size_t k = 0; k < 3; ++k) sum += weights[k] = weight_of(corner(first + k));
    if (sum > 0.999f) break;
  }
  h.world.set_velocity(h.ball, {0, -25, 0}, {});
  for (int i = 0; i < 30; ++i) h.world.step(kStep);
  bool is_split = false;
  DVec3 now{};
  for (std::size_t k = 0; k < 3; ++k) {
    is_split = is_split || corner(first + k) >= 49;
    now += double(weights[k]) * h.world.vertices(h.sheet).position(std::size_t(corner(first + k)));
  }
  EXPECT_TRUE(is_split);
  EXPECT_NEAR(length(now - h.world.pose(h.ball).position), 0.1, 5e-3);
}

TEST(SoftPoint, GoesOnFromASnapshotWithAnyThreadsAndWidths) {
  Hung h = make_hung();
  const BodyId hand = h.world.add_body({.type = BodyType::kinematic, .pose = {{0.3, 0, 0.4}, {}}},
                                       {.geometry = Sphere{0.02f}});
  h.world.attach_point(h.sheet, h.world.nearest_soft_point(h.sheet, {0.3, 0, 0.4}), hand);
  h.world.set_velocity(hand, {0, 0.3f, 0.1f}, {0, 2, 0});
  const SoftId solid =
      h.world.add_solid({.box = SolidBox{{0.1f, 0.1f, 0.1f}, {2, 2, 2}}, .pose = {{1, -1, 0}, {}}});
  h.world.attach_point(solid, h.world.nearest_soft_point(solid, {1.02, -1.03, 0.04}), h.ball);
  for (int i = 0; i < 20; ++i) h.world.step(kStep);
  const std::vector<std::byte> saved = save_snapshot(h.world);
  for (int i = 0; i < 40; ++i) h.world.step(kStep);
  for (const int threads : {1, 2, 3}) {
    for (const int width : {1, 4, 0}) {
      WorldDef def;
      def.threads = threads, def.simd_width = width;
      Result<World> loaded = load_snapshot(saved, def);
      ASSERT_TRUE(loaded) << loaded.error().message;
      World again = *std::move(loaded);
      for (int i = 0; i < 40; ++i) again.step(kStep);
      EXPECT_EQ(again.hash(), h.world.hash()) << threads << " threads, width " << width;
    }
  }
}

}  // namespace
}  // namespace gyre::soft_points_test
