// Wrong calls and bad numbers: each is refused with words, or contained to the body that it befell.
#include "laws/kit.h"

#include <cmath>
#include <cstring>
#include <limits>
#include <memory>
#include <type_traits>

namespace gyre::laws::misuse_test {
namespace {

// Users have no way into the state of a world.
template <class W>
concept ShowsState = requires(W& world) { world.state(); };
static_assert(!ShowsState<World> && !ShowsState<const World>);
static_assert(!std::is_constructible_v<World, std::unique_ptr<WorldState>>);

constexpr float kNan = std::numeric_limits<float>::quiet_NaN();
constexpr float kInf = std::numeric_limits<float>::infinity();

struct Heap {
  World world;
  std::vector<BodyId> boxes;
};
Heap heap(int n = 10) {
  Heap h{make_world(), {}};
  add_ground(h.world);
  for (int i = 0; i < n; ++i)
    h.boxes.push_back(
        h.world.add_body({.pose = {.position = {0.3 * i, 0.6 + 1.05 * i, 0}}}, {.geometry = Box{}}));
  return h;
}

void expect_refused(const World& world, ErrorCode code, const char* word) {
  ASSERT_FALSE(world.problems().empty()) << word;
  const Problem& p = world.problems().back();
  EXPECT_EQ(p.code, code) << p.message;
  EXPECT_NE(std::strstr(p.message, word), nullptr) << p.message;
}

TEST(Misuse, NumbersThatAreNoneAreRefusedAndChangeNothing) {
  Heap h = heap();
  run(h.world, 0.5);
  const std::uint64_t before = h.world.hash();
  const BodyId b = h.boxes[3];
  for (const float bad : {kNan, kInf, -kInf}) {
    EXPECT_FALSE(h.world.set_velocity(b, {bad, 0, 0}, {}));
    expect_refused(h.world, ErrorCode::invalid_argument, "velocity");
    EXPECT_FALSE(h.world.set_velocity(b, {}, {0, bad, 0}));
    EXPECT_FALSE(h.world.set_pose(b, {.position = {double(bad), 0, 0}}));
    EXPECT_FALSE(h.world.set_pose(b, {.position = {0, 0, 0}, .orientation = {bad, 0, 0, 1}}));
    EXPECT_FALSE(h.world.add_force(b, {0, 0, bad}));
    EXPECT_FALSE(h.world.add_force_at(b, {0, 0, 1}, {0, double(bad), 0}));
    EXPECT_FALSE(h.world.add_torque(b, {bad, 0, 0}));
    EXPECT_FALSE(h.world.add_impulse(b, {bad, 0, 0}));
    EXPECT_FALSE(h.world.add_angular_impulse(b, {bad, 0, 0}));
    EXPECT_FALSE(h.world.set_gravity({0, bad, 0}));
    EXPECT_FALSE(h.world.set_gravity_scale(b, bad));
    EXPECT_FALSE(h.world.set_damping(b, bad, 0));
    EXPECT_FALSE(h.world.set_material(h.world.shapes(b)[0], surface(bad)));
    EXPECT_FALSE(h.world.step(bad));
  }
  EXPECT_FALSE(h.world.set_pose(b, {.orientation = {0, 0, 0, 0}}));
  expect_refused(h.world, ErrorCode::invalid_argument, "orientation");
  EXPECT_FALSE(h.world.step(0.0f));
  EXPECT_FALSE(h.world.step(-kStep));
  EXPECT_FALSE(h.world.step(10.0f));
  EXPECT_FALSE(h.world.set_substeps(0));
  EXPECT_FALSE(h.world.set_substeps(65));
  EXPECT_FALSE(h.world.set_damping(b, -1, 0));
  EXPECT_EQ(h.world.hash(), before);
}

// The farthest that a message allows is allowed, to bodies, fields and questions alike.
TEST(Misuse, PlacesAreTakenUpToTheirLimit) {
  World world = make_world();
  const double beyond = std::nextafter(1.0e12, 2.0e12);
  for (const double sign : {-1.0, 1.0}) {
    for (const DVec3 axis : {DVec3{1, 0, 0}, DVec3{0, 1, 0}, DVec3{0, 0, 1}}) {
      const DVec3 last = sign * 1.0e12 * axis, first_refused = sign * beyond * axis;
      const BodyId body = world.add_body({.pose = {.position = last}}, {.geometry = Box{}});
      EXPECT_TRUE(body);
      EXPECT_FALSE(world.set_pose(body, {.position = first_refused}));
      expect_refused(world, ErrorCode::invalid_argument, "within 1e12 m");
      EXPECT_TRUE(world.add_field({.kind = FieldKind::radial, .center = last}));
      EXPECT_FALSE(world.add_field({.kind = FieldKind::radial, .center = first_refused}));
      expect_refused(world, ErrorCode::invalid_argument, "within 1e12 m");
      EXPECT_EQ(check_ray({.origin = last, .translation = {1, 0, 0}}).code, ErrorCode::none);
      EXPECT_EQ(check_ray({.origin = first_refused, .translation = {1, 0, 0}}).code, ErrorCode::invalid_argument);
    }
  }
  EXPECT_TRUE(world.step(kStep));
}

TEST(Misuse, BadBodiesAreRefused) {
  World world = make_world();
  EXPECT_FALSE(world.add_body({}, {.geometry = Sphere{0.0f}}));
  expect_refused(world, ErrorCode::invalid_argument, "radius");
  EXPECT_FALSE(world.add_body({}, {.geometry = Sphere{-1.0f}}));
  EXPECT_FALSE(world.add_body({}, {.geometry = Sphere{kNan}}));
  EXPECT_FALSE(world.add_body({}, {.geometry = Box{{1, 0, 1}}}));
  EXPECT_FALSE(world.add_body({}, {.geometry = Geometry{}}));
  EXPECT_FALSE(world.add_body({}, {.geometry = Plane{}})) << "planes do not move";
  EXPECT_FALSE(world.add_body({.type = BodyType::fixed}, {.geometry = Plane{.normal = {0, 0, 0}}}));
  EXPECT_FALSE(world.add_body({}, {.geometry = Box{}, .density = -1.0f}));
  EXPECT_FALSE(world.add_body({.mass = 0.0f}, {.geometry = Box{}}));
  EXPECT_FALSE(world.add_body({.mass = -2.0f}, {.geometry = Box{}}));
  EXPECT_FALSE(world.add_body({.inertia = Sym3{1, 1, 3, 0, 0, 0}}, {.geometry = Box{}}))
      << "no body has such moments";
  EXPECT_FALSE(world.add_body({.pose = {.orientation = {0, 0, 0, 0}}}, {.geometry = Box{}}));
  EXPECT_FALSE(world.add_body({.linear_velocity = {kNan, 0, 0}}, {.geometry = Box{}}));
  EXPECT_FALSE(world.add_body({.angular_velocity = {0, kInf, 0}}, {.geometry = Box{}}));
  EXPECT_EQ(world.stats().bodies, 0);
  EXPECT_EQ(world.stats().shapes, 0);
  EXPECT_TRUE(world.step(kStep));
  const BodyId turned_long = world.add_body({.pose = {.orientation = {0, 0, 0, 17}}}, {.geometry = Box{}});
  ASSERT_TRUE(turned_long);
  EXPECT_EQ(world.pose(turned_long).orientation, (Quat{})) << "orientations are scaled to length 1";
}

TEST(Misuse, ImmenseSpeedsAndForcesStayFinite) {
  for (int k = 0; k < 4; ++k) {
    Heap h = heap();
    const BodyId b = h.boxes[4];
    if (k == 0) h.world.set_velocity(b, {1e30f, 0, 0}, {});
    if (k == 1) h.world.set_velocity(b, {}, {0, 1e30f, 1e30f});
    if (k == 2) h.world.add_force(b, {0, 3e38f, 0});
    if (k == 3) h.world.add_torque(b, {3e38f, 0, 3e38f});
    for (int i = 0; i < 120; ++i) h.world.step(kStep);
    for (const BodyId id : h.boxes) {
      EXPECT_TRUE(is_finite(h.world.pose(id))) << k;
      EXPECT_TRUE(is_finite(h.world.linear_velocity(id))) << k;
      EXPECT_TRUE(is_finite(h.world.angular_velocity(id))) << k;
    }
  }
}

// A body that flies off past all numbers does not take others with it.
TEST(Misuse, TheOthersAreUntouchedByABodyThatIsLost) {
  Heap with = heap(), without = heap();
  const BodyDef far{.pose = {.position = {1000, 1000, 0}}};
  const BodyId lost = with.world.add_body(far, {.geometry = Sphere{}});
  without.world.add_body(far, {.geometry = Sphere{}});
  for (int i = 0; i < 60; ++i) {
    with.world.add_force(lost, {3e38f, 3e38f, 3e38f});
    with.world.add_force(lost, {3e38f, 3e38f, 3e38f});
    with.world.step(kStep);
    without.world.step(kStep);
  }
  EXPECT_TRUE(is_finite(with.world.pose(lost)));
  for (std::size_t i = 0; i < with.boxes.size(); ++i) {
    EXPECT_EQ(with.world.pose(with.boxes[i]), without.world.pose(without.boxes[i])) << i;
  }
}

// B-02.
TEST(Misuse, ExtremesOfMassAndInertia) {
  for (const float mass : {1e-30f, 1e-10f, 1e10f, 1e30f}) {
    World world = make_world();
    add_ground(world);
    const BodyId b = world.add_body({.pose = {.position = {0, 1, 0}}, .mass = mass}, {.geometry = Box{}});
    if (!b) continue;  // refusing is an answer too
    const BodyId other = world.add_body({.pose = {.position = {0.2, 2.2, 0}}}, {.geometry = Box{}});
    for (int i = 0; i < 120; ++i) world.step(kStep);
    EXPECT_TRUE(is_finite(world.pose(b)) && is_finite(world.linear_velocity(b))) << "B-02 " << mass;
    EXPECT_TRUE(is_finite(world.pose(other)) && is_finite(world.linear_velocity(other))) << "B-02 " << mass;
  }
  World world = make_world({.gravity = {0, -0.0f, 1e-40f}});
  const BodyId b = world.add_body({.inertia = Sym3{1e30f, 1e30f, 1e30f, 0, 0, 0}}, {.geometry = Box{}});
  world.add_torque(b, {1, 1, 1});
  EXPECT_TRUE(world.step(kStep));
  EXPECT_TRUE(is_finite(world.angular_velocity(b)));
}

TEST(Misuse, BodiesWithoutMassMoveAllTheSame) {
  World world = make_world();
  const BodyId no_shape = world.add_body(BodyDef{});
  const BodyId no_density = world.add_body({}, {.geometry = Sphere{}, .density = 0.0f});
  for (int i = 0; i < 60; ++i) world.step(kStep);
  for (const BodyId b : {no_shape, no_density}) {
    if (!b) continue;
    EXPECT_TRUE(is_finite(world.pose(b)));
    EXPECT_TRUE(is_finite(world.linear_velocity(b)));
  }
}

// B-04: stale, forged, of another world, removed twice.
TEST(StaleIds, NeverReachAnotherObject) {
  World world = make_world(), other = make_world();
  const BodyId gone = world.add_body({}, {.geometry = Box{}});
  const ShapeId gone_shape = world.shapes(gone)[0];
  ASSERT_TRUE(world.remove_body(gone));
  EXPECT_FALSE(world.remove_body(gone));
  const BodyId next =
      world.add_body({.pose = {.position = {9, 9, 9}}, .user_data = 7}, {.geometry = Sphere{}});
  const BodyId foreign = other.add_body({}, {.geometry = Box{}});
  BodyId forged = next;
  forged.generation = std::uint16_t(forged.generation + 1);
  BodyId beyond = next;
  beyond.index = 0x7fffffff;
  for (const BodyId bad : {gone, foreign, forged, beyond, BodyId{}}) {
    EXPECT_FALSE(world.exists(bad)) << "B-04";
    EXPECT_FALSE(world.set_velocity(bad, {1, 0, 0}, {}));
    expect_refused(world, ErrorCode::stale_id, "does not exist");
    EXPECT_FALSE(world.set_pose(bad, {}));
    EXPECT_FALSE(world.add_force(bad, {1, 0, 0}));
    EXPECT_FALSE(world.set_type(bad, BodyType::fixed));
    EXPECT_FALSE(world.set_awake(bad, false));
    EXPECT_FALSE(world.add_shape(bad, {}));
    EXPECT_FALSE(world.move_kinematic(bad, {}, kStep));
    EXPECT_FALSE(world.add_joint(BallDef{.a = next, .b = bad}) && bad)
        << "a null id is the world, others are refused";
    EXPECT_EQ(world.pose(bad), Pose{});
    EXPECT_EQ(world.user_data(bad), 0u);
    EXPECT_TRUE(world.shapes(bad).empty());
    EXPECT_EQ(world.mass_properties(bad).mass, 0.0f);
  }
  EXPECT_FALSE(world.exists(gone_shape));
  EXPECT_FALSE(world.remove_shape(gone_shape));
  EXPECT_FALSE(world.set_material(gone_shape, {}));
  EXPECT_FALSE(world.remove_joint(JointId{}));
  EXPECT_FALSE(world.set_motor(JointId{}, {}));
  EXPECT_EQ(world.joint_state(JointId{}).position, 0.0f);
  EXPECT_EQ(world.stats().bodies, 1);
  EXPECT_EQ(world.pose(next).position, (DVec3{9, 9, 9}));
}

TEST(HugeStep, IsFinite) {
  Heap h = heap();
  for (int i = 0; i < 30; ++i) ASSERT_TRUE(h.world.step(1.0f));
  for (const BodyId b : h.boxes) {
    EXPECT_TRUE(is_finite(h.world.pose(b)));
    EXPECT_GT(h.world.pose(b).position.y, 0.0) << "nothing falls through the floor";
  }
}

// B-06.
TEST(Order, AddAndRemoveBeforeTheFirstStepAndWhileAsleep) {
  World world = make_world();
  const BodyId ground = add_ground(world);
  const BodyId a = world.add_body({.pose = {.position = {0, 0.5, 0}}}, {.geometry = Box{}});
  const BodyId b = world.add_body({.pose = {.position = {0, 1.5, 0}}}, {.geometry = Box{}});
  const JointId j = world.add_joint(FixedDef{.a = a, .b = b, .anchor = {0, 1, 0}});
  const ShapeId extra = world.add_shape(a, {.geometry = Sphere{}, .local = {.position = {0, 0, 1}}});
  EXPECT_TRUE(world.remove_shape(extra));
  EXPECT_TRUE(world.step(kStep));
  run(world, 3.0);
  for (const BodyType type :
       {BodyType::fixed, BodyType::kinematic, BodyType::dynamic, BodyType::kinematic, BodyType::dynamic}) {
    EXPECT_TRUE(world.set_type(a, type));
    EXPECT_EQ(world.type(a), type);
    EXPECT_TRUE(world.step(kStep));
    run(world, 1.0);
  }
  EXPECT_NEAR(world.pose(b).position.y, 1.5, 0.02);
  EXPECT_TRUE(world.set_awake(a, false));
  EXPECT_FALSE(world.is_awake(b)) << "the whole island";
  EXPECT_TRUE(world.remove_body(a));
  EXPECT_FALSE(world.exists(j)) << "B-06 joints go with their bodies";
  run(world, 2.0);
  EXPECT_NEAR(world.pose(b).position.y, 0.5, 0.02);
  EXPECT_TRUE(world.remove_body(ground));
  run(world, 1.0);
  EXPECT_LT(world.pose(b).position.y, -2.0);
}

}  // namespace
}  // namespace gyre::laws::misuse_test
