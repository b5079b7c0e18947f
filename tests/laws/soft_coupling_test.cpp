// Bodies and soft matter pass on forces at rest and impulses, at extreme ratios of masses; a bag, a pendulum, drag of sheets.
// Sources: G. Galilei, 1638, C. Huygens, 1673 (pendulum); J. d'Alembert, 1743 (moments of impulse); L. D. Landau, E. M. Lifshitz, "Fluid Mechanics" (drag).
#include "laws/soft_kit.h"

#include <array>
#include <vector>

namespace gyre::laws::soft_coupling_test {
namespace {

constexpr double kG = kGravity;

// A scale is a body that a joint holds to the world. The joint tells the force that it bears.
struct Scale {
  BodyId body;
  JointId joint;

  Scale(World& world, const ShapeDef* shape = nullptr) {
    BodyDef def = point_body(1000.0, {100, 100, 100});
    def.gravity_scale = 0.0f;
    body = shape != nullptr ? world.add_body(def, *shape) : world.add_body(def);
    joint = world.add_joint(FixedDef{.b = body});
  }
  DVec3 load(const World& world) const { return wide(-1.0f * world.joint_state(joint).force); }
};
BodyId add_ball(World& world, DVec3 place, float radius, double mass) {
  BodyDef def{.pose = {place}};
  def.mass = float(mass);
  return world.add_body(def, ShapeDef{.geometry = Sphere{radius}});
}
// Returns a sheet of 1 m whose border a scale holds.
SoftId add_trampoline(World& world, const Scale& scale, int cells, double density) {
  const SoftId sheet = world.add_cloth({.grid = ClothGrid{{1, 1}, {cells, cells}},
                                        .area_density = float(density),
                                        .stretch_stiffness = 5000.0f});
  for (int j = 0; j <= cells; ++j) {
    for (int i = 0; i <= cells; ++i)
      if (i == 0 || j == 0 || i == cells || j == cells) world.attach(sheet, i + j * (cells + 1), scale.body);
  }
  return sheet;
}

// Returns the mean load of a scale over a second.
DVec3 mean_load(World& world, const Scale& scale) {
  DVec3 sum{};
  for (int i = 0; i < 60; ++i) {
    world.step(kStep);
    sum += (1.0 / 60.0) * scale.load(world);
  }
  return sum;
}

// Balls have a thousandth to a thousand times the mass of the sheet.
TEST(SoftCoupling, ABallRestsOnASheetWithItsWeight) {
  struct Case {
    double ball, sheet;  // kg
  };
  for (const Case c : {Case{0.02, 20.0}, Case{0.2, 0.2}, Case{20.0, 0.2}, Case{200.0, 0.2}}) {
    World world = make_world({.sleeping = false});
    const Scale scale(world);
    add_trampoline(world, scale, 16, c.sheet);
    const BodyId ball = add_ball(world, {0, 0.21, 0}, 0.2f, c.ball);
    add_brake(world, 5.0);
    run(world, 5.0);
    const double load = -mean_load(world, scale).y;
    EXPECT_TRUE(relative_row("S-60 ball on a sheet: load of its border, N", load, (c.ball + c.sheet) * kG,
                             2e-2, 1e-3))
        << c.ball;
    EXPECT_TRUE(limit_row("S-60 its speed, m/s", double(length(world.linear_velocity(ball))), 5e-2, 1e-3))
        << c.ball;
  }
}
TEST(SoftCoupling, ABallRestsOnASolidWithItsWeight) {
  for (const double mass : {0.054, 1.0, 50.0}) {
    World world = make_world({.sleeping = false});
    const ShapeDef plate{.geometry = Box{{1, 0.1f, 1}}, .local = {{0, -0.1f, 0}}};
    const Scale scale(world, &plate);
    world.add_solid({.box = SolidBox{{0.3f, 0.15f, 0.3f}, {6, 3, 6}},
                     .pose = {{0, 0.151, 0}},
                     .density = 500.0f,
                     .settings = {.damping = 0.02f}});
    const BodyId ball = add_ball(world, {0, 0.46, 0}, 0.15f, mass);
    add_brake(world, 5.0);
    run(world, 4.0);
    EXPECT_TRUE(relative_row("S-61 ball on a solid: load of the ground, N", -mean_load(world, scale).y,
                             (mass + 54.0) * kG, 2e-2, 1e-3))
        << mass;
    EXPECT_TRUE(limit_row("S-61 its speed, m/s", double(length(world.linear_velocity(ball))), 5e-2, 1e-3))
        << mass;
  }
}
// The momentum that a ball and a sheet gain is the impulse of their weight and of the border. The load of a step is its mean, so nothing is lost between steps.
TEST(SoftCoupling, AFallingBallGetsTheImpulseOfTheBorder) {
  for (const double mass : {0.2, 20.0, 200.0}) {
    World world = make_world({.sleeping = false});
    const Scale scale(world);
    add_trampoline(world, scale, 16, 0.2);
    add_ball(world, {0.05, 0.6, 0.02}, 0.2f, mass);
    double impulse = 0.0, worst = 0.0, greatest = 0.0;
    for (int i = 0; i < 90; ++i) {
      world.step(kStep);
      impulse -= (scale.load(world).y + (mass + 0.2) * kG) * double(kStep);
      const double gained = world.momentum().linear.y;
      worst = std::fmax(worst, std::fabs(gained - impulse)),
      greatest = std::fmax(greatest, std::fabs(gained));
    }
    EXPECT_TRUE(limit_row("S-62 ball that falls on a sheet: momentum without impulse, share",
                          worst / greatest, 5e-3, 1e-4))
        << mass;
  }
}

// A smooth plate on a solid sinks by m g L / E A.
TEST(SoftCoupling, APlateSinksByItsWeight) {
  World world = make_world({.sleeping = false});
  add_ground(world, surface(0.0f));
  world.add_solid({.box = SolidBox{{0.2f, 0.2f, 0.2f}, {4, 4, 4}},
                   .pose = {{0, 0.2, 0}},
                   .density = 1.0f,
                   .young_modulus = 1.0e5f,
                   .poisson_ratio = 0.3f,
                   .settings = {.damping = 0.02f, .static_friction = 0.0f, .dynamic_friction = 0.0f}});
  BodyDef def{.pose = {{0, 0.45, 0}}};
  def.mass = 20.0f, def.locked = LockedAxes{{true, false, true}, {true, true, true}};
  const BodyId plate =
      world.add_body(def, ShapeDef{.geometry = Box{{0.5f, 0.05f, 0.5f}}, .material = surface(0.0f)});
  add_brake(world, 5.0);
  run(world, 4.0);
  EXPECT_TRUE(relative_row("S-63 plate on a solid: indentation, m", 0.45 - world.pose(plate).position.y,
                           20.0 * kG * 0.4 / (1.0e5 * 0.16), 2e-2, 5e-3));
}

// A light rope of 1 m holds a ball at its rim. Both swing in their slower mode. With the angles t of the rope and p of the ball the kinetic energy is
// m (L t' + a p')^2 / 2 + I p'^2 / 2, the potential energy m g (L t^2 + a p^2) / 2. The arc makes the period longer by the factor 1 + t^2 / 16.
TEST(SoftCoupling, ABodyOnARopeIsAPendulum) {
  for (const double radius : {0.05, 0.3}) {
    constexpr double kMass = 2.0, kLength = 1.0, kAngle = 0.1;
    const double inertia = 0.4 * kMass * radius * radius;
    const double a = kLength * inertia / kMass,
                 b = kG * (radius * radius + inertia / kMass + radius * kLength), c = kG * kG * radius;
    const double square = (b - std::sqrt(b * b - 4.0 * a * c)) / (2.0 * a);  // of the angular frequency
    const double turn = kAngle * (kG - square * kLength) / (square * radius);
    World world = make_world({.sleeping = false});
    const DVec3 end{kLength * std::sin(kAngle), -kLength * std::cos(kAngle), 0};
    const SoftId rope = world.add_rope({.points = line({}, end, 20), .linear_density = 1.0e-3f});
    BodyDef def{.pose = {end + radius * DVec3{std::sin(turn), -std::cos(turn), 0},
                         {0, 0, float(std::sin(0.5 * turn)), float(std::cos(0.5 * turn))}}};
    def.mass = float(kMass);
    const BodyId ball = world.add_body(def, ShapeDef{.geometry = Sphere{float(radius)}});
    world.pin(rope, 0), world.attach(rope, 20, ball);
    ZeroCrossings through;
    for (int i = 0; i < 600 && through.count() < 4; ++i) {
      through.add(double(i) * double(kStep), world.pose(ball).position.x);
      world.step(kStep);
    }
    ASSERT_GE(through.count(), 3);
    EXPECT_TRUE(relative_row("S-64 period of a ball on a rope, s", through.mean_period(),
                             2.0 * kPiDouble / std::sqrt(square) * (1.0 + kAngle * kAngle / 16.0), 1e-2,
                             2e-3))
        << radius;
  }
}

constexpr double kDynamicPressure = 0.6;  // Pa at 1 m/s, of air

// The wind pushes a taut sheet whose border a scale holds as it pushes a plate of that angle.
TEST(SoftCoupling, WindPushesATautSheetAsAPlate) {
  for (const double angle : {90.0, 60.0, 30.0}) {
    World world = make_world({.gravity = {}, .sleeping = false});
    const Scale scale(world);
    const double half = 0.5 * angle * double(kDegree);
    ClothDef def{.grid = ClothGrid{{1, 1}, {12, 12}},
                 .pose = {{}, {0, 0, float(std::sin(half)), float(std::cos(half))}}};
    const SoftId sheet = world.add_cloth(def);
    for (int v = 0; v < 169; ++v)
      if (v % 13 == 0 || v % 13 == 12 || v < 13 || v >= 156) world.attach(sheet, v, scale.body);
    world.add_field({.velocity = {10, 0, 0}});
    run(world, 2.0);
    const double load = mean_load(world, scale).x;
    EXPECT_TRUE(relative_row("S-65 taut sheet in the wind: drag, N", load,
                             kDynamicPressure * 100.0 * std::sin(angle * double(kDegree)), 0.2, 2e-2))
        << angle;
  }
}
// A flag that hangs from its upper edge is a plane at the angle t to the upright with tan t = q cos t / (s g), s kg/m^2: drag and weight are
// alike everywhere.
TEST(SoftCoupling, AFlagHangsInTheWindAtItsAngle) {
  for (const double speed : {1.5, 2.5, 4.0}) {
    World world = make_world({.sleeping = false});
    const Scale scale(world);
    ClothDef def{.grid = ClothGrid{{1, 1}, {12, 12}}, .pose = {{}, {-0.5f, -0.5f, -0.5f, 0.5f}}};
    def.bend_stiffness = 1.0e-5f;
    const SoftId flag = world.add_cloth(def);
    const SoftVertices start = world.vertices(flag);
    for (int v = 0; v < 169; ++v)
      if (start.y[std::size_t(v)] > 0.499) world.attach(flag, v, scale.body);
    world.add_field({.velocity = {float(speed), 0, 0}});
    run(world, 8.0);
    const double pressure = kDynamicPressure * speed * speed, weight = 0.2 * kG;
    double low = 0.0, high = 0.5 * kPiDouble;
    for (int n = 0; n < 50; ++n) {
      const double middle = 0.5 * (low + high);
      (std::tan(middle) * weight < pressure * std::cos(middle) ? low : high) = middle;
    }
    const DVec3 drag = mean_load(world, scale);
    EXPECT_TRUE(relative_row("S-66 flag in the wind: drag, N", drag.x, pressure * std::cos(low), 0.2, 2e-2))
        << speed;
    EXPECT_TRUE(relative_row("S-66 its angle, rad", std::atan2(drag.x, -drag.y), low, 2e-2, 5e-3)) << speed;
  }
}

// A bag is a cloth that is open above. It has a floor of kCells x kCells cells, and kCells rows of cells around it.
struct Bag {
  static constexpr int kCells = 6;
  static constexpr float kSize = 0.6f;  // m
  std::vector<Vec3> vertices{};
  std::vector<std::uint32_t> triangles{};

  Bag() {
    constexpr int kColumns = kCells + 1;
    for (int j = 0; j < kColumns; ++j)
      for (int i = 0; i < kColumns; ++i)
        add({kSize * (float(i) / kCells - 0.5f), 0, kSize * (float(j) / kCells - 0.5f)});
    const auto corner = [](int i, int j) { return std::uint32_t(i + j * kColumns); };
    std::vector<std::uint32_t> ring;
    for (int j = 0; j < kCells; ++j)
      for (int i = 0; i < kCells; ++i)
        add_cell({corner(i, j), corner(i + 1, j), corner(i + 1, j + 1), corner(i, j + 1)});
    for (int i = 0; i < kCells; ++i) ring.push_back(corner(i, 0));
    for (int j = 0; j < kCells; ++j) ring.push_back(corner(kCells, j));
    for (int i = kCells; i > 0; --i) ring.push_back(corner(i, kCells));
    for (int j = kCells; j > 0; --j) ring.push_back(corner(0, j));
    for (int row = 0; row < kCells; ++row) {
      std::vector<std::uint32_t> above;
      for (const std::uint32_t v : ring) above.push_back(add(vertices[v] + Vec3{0, kSize / kCells, 0}));
      for (std::size_t k = 0; k < ring.size(); ++k) {
        const std::size_t next = (k + 1) % ring.size();
        add_cell({ring[k], ring[next], above[next], above[k]});
      }
      ring = above;
    }
  }
  std::uint32_t add(Vec3 place) {
    vertices.push_back(place);
    return std::uint32_t(vertices.size() - 1);
  }
  void add_cell(const std::array<std::uint32_t, 4>& c) {
    for (const int k : {0, 1, 2, 0, 2, 3}) triangles.push_back(c[std::size_t(k)]);
  }
};

TEST(SoftCoupling, NoBallLeavesABag) {
  World world = make_world({.sleeping = false});
  add_ground(world, surface(0.5f));
  const Bag bag;
  const SoftId cloth = world.add_cloth({.vertices = bag.vertices,
                                        .triangles = bag.triangles,
                                        .pose = {{0, 0.02, 0}},
                                        .area_density = 0.3f,
                                        .stretch_stiffness = 2.0e4f,
                                        .shear_stiffness = 80.0f,
                                        .thickness = 0.012f,
                                        .settings = {.damping = 0.01f}});
  std::array<BodyId, 2> pins;
  for (const double side : {-1.0, 1.0}) {
    const DVec3 place{0.5 * double(Bag::kSize) * side, 0.02 + double(Bag::kSize), 0};
    const BodyId pin =
        world.add_body({.type = BodyType::kinematic, .pose = {place}, .linear_velocity = {0, 0.2f, 0}});
    const SoftVertices v = world.vertices(cloth);
    for (std::size_t i = 0; i < v.size(); ++i)
      if (length(v.position(i) - place) < 1e-3) world.attach(cloth, int(i), pin);
    pins[side > 0.0] = pin;
  }
  const ShapeDef ball{.geometry = Sphere{0.085f}, .density = 300.0f, .material = {.rolling_friction = 0.01f}};
  std::vector<BodyId> balls;
  for (int k = 0; k < 20; ++k) {
    const DVec3 place{0.18 * (k % 3 - 1), 0.125 + 0.175 * (k / 9), 0.18 * (k / 3 % 3 - 1)};
    balls.push_back(world.add_body({.pose = {place}}, ball));
  }
  int most = 0;
  for (int i = 0; i < 1800; ++i) {
    if (i == 300)
      for (const BodyId pin : pins) world.set_velocity(pin, {}, {});
    world.step(kStep);
    const SoftVertices v = world.vertices(cloth);
    const double low = *std::min_element(v.y.begin(), v.y.end());
    int outside = 0;
    for (const BodyId one : balls) {
      const DVec3 p = world.pose(one).position;
      outside += p.y < low || std::hypot(p.x, p.z) > 0.5;
    }
    most = std::max(most, outside);
  }
  for (const BodyId one : balls) {
    EXPECT_GT(world.pose(one).position.y, 0.8);
    EXPECT_LT(world.pose(one).position.y, world.pose(pins[0]).position.y);
  }
  EXPECT_TRUE(limit_row("S-67 balls outside of a bag that two pins lift, in 30 s", double(most), 0.0, 0.0));
  EXPECT_EQ(world.cloth_crossings(), 0u);
}

}  // namespace
}  // namespace gyre::laws::soft_coupling_test
