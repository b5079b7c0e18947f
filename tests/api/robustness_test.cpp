// Hard input, by the rows of the validation table: degenerate hulls, meshes and height fields, odd queries, coincident shapes, changes
// made while events are read, refusals in words. Each is refused with its reason, or has the answer that it should have.
#include "laws/kit.h"

#include <gyre/debug.h>

#include <array>
#include <cstring>
#include <limits>
#include <string>

namespace gyre::laws::robustness_test {
namespace {

constexpr float kNan = std::numeric_limits<float>::quiet_NaN();

void expect_whole(const World& world, const char* id) {
  const Error fault = validate(world);
  EXPECT_EQ(fault.code, ErrorCode::none) << id << ": " << fault.message;
}
void expect_finite(const World& world, const char* id) {
  const BodyColumns all = world.bodies();
  for (std::size_t i = 0; i < all.ids.size(); ++i) {
    EXPECT_TRUE(is_finite(all.poses[i]) && is_finite(all.linear_velocities[i]) &&
                is_finite(all.angular_velocities[i]))
        << id << " body " << i;
  }
}

// B-05: whoever reads the events of a step removes, stills, moves or changes what they are about, at once. Nothing that began stays
// without an end, and every structure agrees with the others.
TEST(Events, MayBeAnsweredByAnyChange) {
  World world = make_world();
  add_ground(world);
  world.add_body({.type = BodyType::fixed, .pose = {.position = {0, 1.0, 0}}},
                 {.geometry = Box{{6, 0.4f, 6}}, .sensor = true});
  std::uint32_t state = 7;
  const auto next = [&](std::uint32_t below) {
    state = state * 1664525u + 1013904223u;
    return (state >> 8) % below;
  };
  const auto drop = [&] {
    const DVec3 place{double(next(60)) * 0.1 - 3.0, 1.5 + 0.1 * double(next(20)),
                      double(next(60)) * 0.1 - 3.0};
    return world.add_body(
        {.pose = {.position = place}},
        {.geometry = next(2) == 0 ? AnyShape(Box{{0.3f, 0.3f, 0.3f}}) : AnyShape(Sphere{0.3f})});
  };
  std::vector<BodyId> all;
  for (int i = 0; i < 30; ++i) all.push_back(drop());
  for (int i = 0; i + 1 < 10; i += 2) {
    world.add_joint(BallDef{.a = all[std::size_t(i)],
                            .b = all[std::size_t(i + 1)],
                            .anchor = world.pose(all[std::size_t(i)]).position,
                            .break_force = 30.0f});
  }
  const auto change = [&](BodyId body) {
    if (!world.exists(body)) return;
    switch (next(7)) {
      case 0:
        world.remove_body(body);
        break;
      case 1:
        world.set_type(body, BodyType(next(3)));
        break;
      case 2:
        world.set_pose(body, {{0.1 * double(next(40)) - 2.0, 2.0, 0}, {}});
        break;
      case 3:
        world.set_awake(body, false);
        break;
      case 4:
        world.set_filter(world.shapes(body)[0], {.layer = 1, .collides_with = next(2)});
        break;
      case 5:
        world.add_shape(body, {.geometry = Sphere{0.2f}, .local = {.position = {0, 0.3f, 0}}});
        break;
      default:
        world.set_velocity(body, {0, 3, 0}, {});
        break;
    }
  };
  int begins = 0, ends = 0, in = 0, out = 0, broken = 0;
  for (int step = 0; step < 400; ++step) {
    world.step(kStep);
    const Events& events = world.events();
    begins += int(events.begins.size()), ends += int(events.ends.size()), broken += int(events.broken.size());
    for (const SensorTouch& touch : events.sensors) (touch.begins ? in : out) += 1;
    // The first change ends what the spans show: whom they name is taken out before.
    std::vector<BodyId> named;
    for (const auto& touch : events.begins) named.push_back(world.body_of(touch.shape_b));
    for (const auto& touch : events.ends) named.push_back(world.body_of(touch.shape_b));
    for (const SensorTouch& touch : events.sensors) named.push_back(world.body_of(touch.visitor));
    for (const BodyId body : named) change(body);
    if (step % 10 == 0) drop();
    expect_whole(world, "B-05");
  }
  EXPECT_GT(begins, 50);
  EXPECT_GT(in, 20);
  EXPECT_GT(broken, 0);
  // All that touched ends when all that moves is gone.
  const BodyColumns columns = world.bodies();
  const std::vector<BodyId> left(columns.ids.begin(), columns.ids.end());
  for (const BodyId body : left) world.remove_body(body);
  world.step(kStep);
  ends += int(world.events().ends.size());
  for (const SensorTouch& touch : world.events().sensors) (touch.begins ? in : out) += 1;
  EXPECT_TRUE(row("B-05 ends of contacts over their begins", double(ends) / begins, 1.0, 0.0, 0.0));
  EXPECT_TRUE(row("B-05 sensors left over entered", double(out) / in, 1.0, 0.0, 0.0));
}

// B-09: no mass, no inertia about an axis, all of it: each moves, or stays, as it should.
TEST(Masses, OfNoneAndOfTooMuchAreDefined) {
  World world = make_world();
  add_ground(world);
  LockedAxes no_turn;
  for (bool& locked : no_turn.angular) locked = true;
  const BodyId locked =
      world.add_body({.pose = {.position = {0, 1, 0}, .orientation = from_axis_angle({1, 0, 0.4f}, 0.5f)},
                      .locked = no_turn},
                     {.geometry = Box{}});
  const BodyId point = world.add_body({.pose = {.position = {5, 3, 0}}, .mass = 2.0f});
  const BodyId heavy = world.add_body(
      {.pose = {.position = {10, 1, 0}}, .inertia = Sym3{1e30f, 1e30f, 1e30f, 0, 0, 0}}, {.geometry = Box{}});
  EXPECT_FALSE(world.add_body({.mass = 0.0f}, {.geometry = Box{}}));
  EXPECT_FALSE(world.add_body({.mass = -1.0f}, {.geometry = Box{}}));
  EXPECT_FALSE(world.add_body({}, {.geometry = Box{}, .density = -5.0f}));
  const Quat start = world.pose(locked).orientation;
  world.add_impulse_at(heavy, {0, 0, 500}, {10.5, 1, 0});
  run(world, 1.0);
  expect_finite(world, "B-09");
  EXPECT_EQ(world.pose(locked).orientation, start) << "B-09 what cannot turn does not, lying on its edge";
  EXPECT_GT(world.pose(locked).position.y, 0.5);
  EXPECT_TRUE(
      row("B-09 fall of a point (m)", 3.0 - world.pose(point).position.y,
                  0.5 * kGravity * (1.0 + 1.0 / 480.0), 1e-3, 1e-4));
  EXPECT_TRUE(limit_row("B-09 spin of immense inertia (rad/s)", double(length(world.angular_velocity(heavy))),
                        1e-20, 1e-26));
  EXPECT_GT(world.pose(heavy).position.z, 0.01);
}

// B-14: rays and moving shapes that are hard on arithmetic, against the same asked of every pair one by one.
TEST(Queries, ThatAreDegenerateAgreeWithBruteForce) {
  const auto make = [](BroadPhaseKind kind) {
    WorldDef def;
    def.stepping.broad_phase = kind;
    World world = make_world(def);
    add_ground(world);
    for (int i = 0; i < 60; ++i) {
      const DVec3 place{3.0 * (i % 8), 2.0 + 2.5 * (i / 32), 3.0 * (i / 8 % 4)};
      const AnyShape shapes[] = {Sphere{0.5f}, Box{}, Capsule{0.3f, 0.6f}, Cylinder{0.5f, 0.5f},
                                 Cone{0.5f, 0.5f}};
      world.add_body({.type = BodyType::fixed, .pose = {.position = place}}, {.geometry = shapes[i % 5]});
    }
    return world;
  };
  const World fast = make(BroadPhaseKind::bvh), brute = make(BroadPhaseKind::brute_force);
  const float denormal = 1e-42f;
  const Ray rays[] = {{{0, 2, 0}, {0, 0, 0}},         // no length, inside
                      {{1.5, 9, 0}, {0, 0, 0}},       // no length, outside
                      {{6, 20, 0}, {0, -40, 0}},      // along a capsule's axis
                      {{6.3, 20, 0}, {0, -40, 0}},    // grazing its side
                      {{0.5, 20, 0}, {0, -40, 0}},    // grazing a ball
                      {{3.5, 2.5, -10}, {0, 0, 40}},  // along a box's edge
                      {{-1e7, 2, 0}, {2e7f, 0, 0}},   // from ten thousand kilometres
                      {{3, 1e7, 0}, {0, -2e7f, 0}},
                      {{0, 5, 0}, {denormal, -denormal, 0}},  // all but no length
                      {{0, 5, 0}, {0, -3e38f, 0}}};
  int met = 0;
  for (const Ray& ray : rays) {
    const auto a = fast.cast_ray(ray.origin, ray.translation), b = brute.cast_ray(ray.origin, ray.translation);
    EXPECT_EQ(a.has_value(), b.has_value()) << "B-14";
    if (!a || !b) continue;
    ++met;
    EXPECT_EQ(a->fraction, b->fraction) << "B-14";
    EXPECT_TRUE(is_finite(a->point) && is_finite(a->normal)) << "B-14";
  }
  EXPECT_GE(met, 6);
  const ShapeCast casts[] = {
      {Sphere{0.5f}, {{-3000, 2, 0}, {}}, {6000, 0, 0}},     // six kilometres
      {Sphere{6000.0f}, {{0, 9000, 0}, {}}, {0, -6000, 0}},  // of six kilometres
      {Sphere{0.5f}, {{0, 2, 0}, {}}, {0, 0, 0}},
      {Capsule{0.3f, 0.6f}, {{6, 9, 0}, {}}, {0, -9, 0}},  // along its axis, on another's
      {Box{}, {{2, 2, -9}, {}}, {0, 0, 30}},               // a face along a face
      {Sphere{1e-6f}, {{0, 30, 0}, {}}, {0, -30, 0}},
      {Capsule{0.1f, 50.0f}, {{0, 3, -20}, from_axis_angle({0, 0, 1}, 0.5f * kPi)}, {0, 0, 40}}};
  for (const ShapeCast& cast : casts) {
    const auto a = fast.cast_shape(cast), b = brute.cast_shape(cast);
    EXPECT_EQ(a.has_value(), b.has_value()) << "B-14";
    if (!a || !b) continue;
    EXPECT_EQ(a->fraction, b->fraction) << "B-14";
    EXPECT_TRUE(is_finite(a->point) && is_finite(a->normal)) << "B-14";
  }
  EXPECT_FALSE(fast.cast_ray({0, 9, 0}, {kNan, 0, 0})) << "B-14";
  EXPECT_FALSE(fast.cast_ray({double(kNan), 9, 0}, {0, -20, 0})) << "B-14";
  EXPECT_FALSE(fast.cast_shape({Sphere{0.5f}, {{0, 9, 0}, {}}, {0, kNan, 0}})) << "B-14";
  EXPECT_FALSE(fast.cast_shape({Sphere{kNan}, {{0, 9, 0}, {}}, {0, -9, 0}})) << "B-14";
}

// B-16: every two kinds of shapes with the same middle, in the same pose and all but so: they come apart, at no great speed.
TEST(CoincidentShapes, ComeApart) {
  std::vector<Vec3> corners;
  for (int i = 0; i < 12; ++i)
    corners.push_back(
        {0.5f * std::cos(0.9f * float(i)), 0.08f * float(i) - 0.45f, 0.5f * std::sin(0.9f * float(i))});
  const AnyShape shapes[] = {Sphere{0.5f},
                             Box{},
                             Box{{0.5f, 0.5f, 0.5f}, 0.1f},
                             Capsule{0.3f, 0.5f},
                             Cylinder{0.5f, 0.5f},
                             Cone{0.5f, 0.5f},
                             *cook_hull(corners)};
  double fastest = 0.0;
  int still_in = 0;
  for (const AnyShape& a : shapes) {
    for (const AnyShape& b : shapes) {
      for (const float turn : {0.0f, 1e-7f, 0.3f}) {
        World world = make_world({.gravity = {0, 0, 0}, .sleeping = false});
        world.add_body({}, {.geometry = a});
        world.add_body({.pose = {.orientation = from_axis_angle({0, 0, 1}, turn)}}, {.geometry = b});
        for (int i = 0; i < 180; ++i) {
          world.step(kStep);
          for (const Vec3& v : world.bodies().linear_velocities)
            fastest = std::max(fastest, double(length(v)));
        }
        expect_finite(world, "B-16");
        still_in += world.max_penetration() > 0.02f;
      }
    }
  }
  EXPECT_TRUE(limit_row("B-16 pairs of 147 still in each other by 2 cm after 3 s", still_in, 0, 0));
  EXPECT_TRUE(limit_row("B-16 fastest speed (m/s)", fastest, 1.0, 0.5));
}

// B-12: meshes that are no solid stand still all the same, and what is no mesh is refused in words.
TEST(BadMeshes, AreGroundOrAreRefused) {
  const Vec3 square[] = {{-4, 0, -4}, {-4, 0, 4}, {4, 0, 4}, {4, 0, -4}, {0, 0, 0}, {0, 3, 0}};
  struct Case {
    const char* what;
    std::vector<std::uint32_t> indices;
  };
  const Case cases[] = {{"plain", {0, 1, 2, 0, 2, 3}},
                        {"double triangles", {0, 1, 2, 0, 2, 3, 0, 1, 2, 2, 3, 0}},
                        {"triangles without area", {0, 1, 2, 0, 2, 3, 0, 0, 1, 4, 4, 4}},
                        {"a T-junction", {0, 1, 4, 1, 2, 4, 0, 4, 2, 0, 2, 3}},
                        {"an edge of four triangles", {0, 1, 2, 0, 2, 3, 0, 2, 5, 2, 0, 5}}};
  for (const Case& it : cases) {
    World world = make_world();
    const Result<Geometry> mesh = cook_mesh({.vertices = square, .indices = it.indices});
    ASSERT_TRUE(mesh) << "B-12 " << it.what << ": " << mesh.error().message;
    world.add_body({.type = BodyType::fixed}, {.geometry = *mesh});
    const BodyId box =
        world.add_body({.pose = {.position = {-2, 0.8, 1}}}, {.geometry = Box{{0.5f, 0.5f, 0.5f}}});
    run(world, 3.0);
    EXPECT_TRUE(row((std::string("B-12 box on ") + it.what + " (m)").c_str(), world.pose(box).position.y, 0.5,
                    5e-3, 5e-4));
  }
  const auto refusal = [&](std::span<const Vec3> v, const std::vector<std::uint32_t>& indices) {
    const Result<Geometry> mesh = cook_mesh({.vertices = v, .indices = indices});
    return std::string(mesh ? "" : mesh.error().message);
  };
  const Vec3 broken[] = {{0, 0, 0}, {1, 0, 0}, {0, kNan, 1}};
  EXPECT_NE(refusal(square, {0, 1, 9}).find("triangle 0"), std::string::npos)
      << "B-12 " << refusal(square, {0, 1, 9});
  EXPECT_NE(refusal(broken, {0, 1, 2}).find("vertex 2"), std::string::npos)
      << "B-12 " << refusal(broken, {0, 1, 2});
  EXPECT_FALSE(refusal(square, {}).empty()) << "B-12";
  EXPECT_FALSE(refusal(square, {0, 1}).empty()) << "B-12";
}

// B-34: a refusal names the object, the field, the value that was found and what is allowed.
TEST(Refusals, NameObjectFieldValueAndRange) {
  World world = make_world();
  const BodyId body = world.add_body({}, {.geometry = Box{}});
  const ShapeId shape = world.shapes(body)[0];
  struct Case {
    const char* field;
    const char* value;
  };
  int told = 0;
  const auto expect = [&](bool refused, const Case& wanted) {
    EXPECT_TRUE(refused) << "B-34 " << wanted.field;
    ASSERT_FALSE(world.problems().empty()) << wanted.field;
    const char* const said = world.problems().back().message;
    EXPECT_NE(std::strstr(said, wanted.field), nullptr) << "B-34 " << said;
    EXPECT_NE(std::strstr(said, wanted.value), nullptr) << "B-34 " << said;
    EXPECT_TRUE(std::strstr(said, "allowed") != nullptr || std::strstr(said, "must") != nullptr) << "B-34 " << said;
    ++told;
  };
  expect(!world.add_body({}, {.geometry = Sphere{-1.5f}}), {"radius", "-1.5"});
  expect(!world.add_body({}, {.geometry = Box{{1, 0, 1}}}), {"half_extents", "0"});
  expect(!world.add_body({}, {.geometry = Box{}, .density = -3.0f}), {"density", "-3"});
  expect(!world.add_body({.mass = -2.0f}, {.geometry = Box{}}), {"mass", "-2"});
  expect(!world.add_body({.linear_damping = -1.0f}, {.geometry = Box{}}), {"damping", "-1"});
  expect(!world.set_substeps(65), {"substeps", "65"});
  expect(!world.set_material(shape, {.restitution = 1.5f}), {"restitution", "1.5"});
  expect(!world.set_material(shape, {.static_friction = -0.5f}), {"static_friction", "-0.5"});
  expect(!world.step(-0.25f), {"seconds", "-0.25"});
  expect(!world.step(2.0f), {"seconds", "2"});
  expect(!world.set_damping(body, -4.0f, 0), {"damping", "-4"});
  EXPECT_TRUE(row("B-34 refusals in words", told, 11, 0, 0));
}

}  // namespace
}  // namespace gyre::laws::robustness_test
