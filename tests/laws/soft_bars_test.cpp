// Solids follow closed forms: modes of a bar, a hanging bar, a patch of irregular tetrahedra, the neo-Hookean law in pressure and tension.
// Sources: S. Timoshenko, "On the Correction for Shear of the Differential Equation for Transverse Vibrations of Prismatic Bars", 1921; B. Irons, 1966
// (patch test).
#include "laws/soft_kit.h"

#include <array>
#include <vector>

namespace gyre::laws::soft_bars_test {
namespace {

constexpr double kG = kGravity;

// Returns the angular frequency of a mode of a clamped beam of 1 m with shear and rotary inertia (S. Timoshenko, 1921). It is the root of the determinant of
// force and moment at the free end, and lies below `near`, that of D. Bernoulli. `inertia` is I / A in m^2, `bending` EI / rho A, `shear` k G / rho.
double timoshenko_frequency(double near, double inertia, double bending, double shear) {
  const auto determinant = [&](double w) {
    double end[2][2];  // force and moment at the free end for unit ones at the clamp
    for (int start = 0; start < 2; ++start) {
      std::array<double, 4> state{0, 0, start == 0 ? 1.0 : 0.0,
                                  start == 1 ? 1.0 : 0.0};  // deflection, turn, force, moment
      constexpr int kSteps = 400;
      const auto slope = [&](const std::array<double, 4>& s) {
        return std::array{s[1] + s[2] / shear, s[3] / bending, -w * w * s[0], -s[2] - w * w * inertia * s[1]};
      };
      const auto moved = [](const std::array<double, 4>& s, const std::array<double, 4>& d, double h) {
        return std::array{s[0] + h * d[0], s[1] + h * d[1], s[2] + h * d[2], s[3] + h * d[3]};
      };
      for (int n = 0; n < kSteps; ++n) {  // midpoint rule
        constexpr double kLength = 1.0 / kSteps;
        state = moved(state, slope(moved(state, slope(state), 0.5 * kLength)), kLength);
      }
      end[start][0] = state[2], end[start][1] = state[3];
    }
    return end[0][0] * end[1][1] - end[0][1] * end[1][0];
  };
  double low = 0.8 * near, high = 1.02 * near;
  const bool sign = determinant(low) > 0.0;
  EXPECT_NE(sign, determinant(high) > 0.0);
  for (int n = 0; n < 40; ++n) {
    const double middle = 0.5 * (low + high);
    ((determinant(middle) > 0.0) == sign ? low : high) = middle;
  }
  return low;
}

// Returns the frequency of a mode of the reference bar of 1 m, with this many cells through its depth of 10 cm. The bar bends along a diagonal of its
// section: all cells are cut along the same diagonals, so these are the main axes.
double bar_frequency(double beta, int across, double expected, DVec3 axis) {
  World world = make_world({.gravity = {}, .stepping = {.substeps = 2}, .sleeping = false});
  const int along = 10 * across, columns = along + 1;
  SolidDef def{.box = SolidBox{{0.5f, 0.05f, 0.05f}, {along, across, across}},
               .model = SolidModel::corotated,
               .young_modulus = 1.0e6f,
               .poisson_ratio = 0.3f};
  def.settings.integrator = SoftIntegrator::sdirk2;
  const double ratio = (std::cosh(beta) + std::cos(beta)) / (std::sinh(beta) + std::sin(beta));
  const auto shape = [&](double x) {
    return std::cosh(beta * x) - std::cos(beta * x) - ratio * (std::sinh(beta * x) - std::sin(beta * x));
  };
  const auto slope = [&](double x) {
    return beta *
           (std::sinh(beta * x) + std::sin(beta * x) - ratio * (std::cosh(beta * x) - std::cos(beta * x)));
  };
  constexpr double kAmplitude = 5.0e-4;  // m
  for (int k = 0; k <= across; ++k) {
    for (int j = 0; j <= across; ++j) {
      for (int i = 0; i <= along; ++i) {
        const double x = double(i) / along, y = 0.1 * j / across - 0.05, z = 0.1 * k / across - 0.05;
        const DVec3 arm{0, y, z};
        def.settings.positions.push_back(arm + DVec3{x - 0.5 - kAmplitude * dot(arm, axis) * slope(x), 0, 0} +
                                         kAmplitude * shape(x) * axis);
      }
    }
  }
  const SoftId bar = world.add_solid(def);
  for (int v = 0; v < world.soft_info(bar).vertices; v += columns) world.pin(bar, v);
  // Returns the share of the mode in the deflection of the middle line.
  const auto share = [&] {
    const SoftVertices v = world.vertices(bar);
    double sum = 0.0;
    for (int i = 0; i <= along; ++i)
      sum += (i == along ? 0.5 : 1.0) * shape(double(i) / along) *
             dot(axis, v.position(std::size_t(i + columns * (across / 2) * (across + 2))));
    return sum;
  };
  const float step = std::fmin(kStep, float(1.0 / (32.0 * expected)));  // w h is 0.098 in a sub-step at most
  ZeroCrossings down, up;
  for (int i = 0; double(i) * double(step) < 0.85 / expected; ++i) {
    down.add(double(i) * double(step), -share()), up.add(double(i) * double(step), share());
    world.step(step);
  }
  EXPECT_TRUE(down.count() == 1 && up.count() == 1);
  return 0.5 / (up.time(0) - down.time(0));
}

TEST(SolidMotion, ModesOfABar) {
  for (const double beta : {1.875104, 4.694091, 7.854757}) {
    // The reference bar has 1 MPa, 1000 kg/m^3, Poisson's ratio 0.3 and a section of 10 cm x 10 cm.
    const double inertia = 0.01 / 12.0, bending = 1000.0 * inertia, shear = 5.0 / 6.0 * 1000.0 / 2.6;
    const double exact =
        timoshenko_frequency(beta * beta * std::sqrt(bending), inertia, bending, shear) / (2.0 * kPiDouble);
    for (const double side : {-1.0, 1.0}) {
      const DVec3 axis = std::sqrt(0.5) * DVec3{0, 1, side};
      const double coarse = bar_frequency(beta, 4, exact, axis), fine = bar_frequency(beta, 6, exact, axis);
      // Errors of stiffness fall with the square of the cells.
      const double found = std::sqrt((36.0 * fine * fine - 16.0 * coarse * coarse) / 20.0);
      EXPECT_TRUE(relative_row("S-47 modes of a bar, from two meshes, Hz", found, exact, 3e-2, 1e-2)) << beta;
    }
  }
}

TEST(SolidRest, TheStretchOfAHangingBarIsAParabola) {
  for (const SolidModel model : {SolidModel::linear, SolidModel::corotated, SolidModel::neo_hookean}) {
    World world = make_world();
    const SoftId bar = world.add_solid({.box = SolidBox{{0.05f, 0.5f, 0.05f}, {2, 20, 2}},
                                        .model = model,
                                        .young_modulus = 1.0e6f,
                                        .poisson_ratio = 0.0f});
    const auto mean_height = [&](int j) {
      const SoftVertices v = world.vertices(bar);
      double sum = 0.0;
      for (int k = 0; k < 3; ++k)
        for (int i = 0; i < 3; ++i) sum += v.y[std::size_t(i + 3 * (j + 21 * k))];
      return sum / 9.0;
    };
    for (int k = 0; k < 3; ++k)
      for (int i = 0; i < 3; ++i) world.pin(bar, i + 3 * (20 + 21 * k));
    add_brake(world, 20.0);
    run(world, 2.0);
    const double whole = 1000.0 * kG / (2.0 * 1.0e6);
    for (const int j : {15, 10, 5, 0}) {
      const double below = 1.0 - j / 20.0;  // m, under the held end
      const double sunk = 0.5 - below - mean_height(j);
      EXPECT_TRUE(row("S-48 hanging bar: displacement at a quarter to the whole, m", sunk,
                      whole * below * (2.0 - below), 0.01 * whole, 0.005 * whole))
          << j;
    }
  }
}

// A cube of irregular tetrahedra has its inner vertices scattered by a fourth of a cell at most.
struct PatchCube {
  static constexpr int kCells = 4;
  std::vector<Vec3> vertices{};
  std::vector<std::uint32_t> tetrahedra{};
  std::vector<bool> inside{};

  PatchCube() {
    std::uint32_t state = 7;
    const auto scatter = [&] {  // m
      state = state * 1664525u + 1013904223u;
      return 0.0625f * (float(state >> 8) / 8388608.0f - 1.0f);
    };
    World world = weightless();
    const SoftId even = world.add_solid({.box = SolidBox{{0.5f, 0.5f, 0.5f}, {kCells, kCells, kCells}}});
    tetrahedra.resize(world.solid_tetrahedra(even, {}));
    world.solid_tetrahedra(even, tetrahedra);
    const SoftVertices v = world.vertices(even);
    for (std::size_t i = 0; i < v.size(); ++i) {
      const Vec3 p = to_float(v.position(i));
      inside.push_back(std::fabs(p.x) < 0.49f && std::fabs(p.y) < 0.49f && std::fabs(p.z) < 0.49f);
      vertices.push_back(inside.back() ? p + Vec3{scatter(), scatter(), scatter()} : p);
    }
  }
};

// Returns the displacement gradient of an element that moved from `rest` to `now`, column by column.
std::array<DVec3, 3> gradient_of(const std::array<DVec3, 4>& rest, const std::array<DVec3, 4>& now) {
  const DVec3 a = rest[1] - rest[0], b = rest[2] - rest[0], c = rest[3] - rest[0];
  const double volume = dot(a, cross(b, c));
  const DVec3 along[3] = {(1.0 / volume) * cross(b, c), (1.0 / volume) * cross(c, a),
                          (1.0 / volume) * cross(a, b)};
  std::array<DVec3, 3> columns{};
  for (int n = 0; n < 3; ++n) {
    const DVec3 moved = (now[std::size_t(n + 1)] - rest[std::size_t(n + 1)]) - (now[0] - rest[0]);
    columns[0] += along[n].x * moved, columns[1] += along[n].y * moved, columns[2] += along[n].z * moved;
  }
  return columns;
}

TEST(SolidRest, PatchTest) {
  const PatchCube cube;
  const DVec3 exact[3] = {{0.05, 0, -0.03}, {0.02, -0.015, 0}, {0, 0.01, 0.025}};
  for (const SolidModel model : {SolidModel::linear, SolidModel::corotated, SolidModel::neo_hookean}) {
    World world = make_world({.gravity = {}, .sleeping = false});
    const SoftId solid = world.add_solid({.vertices = cube.vertices,
                                          .tetrahedra = cube.tetrahedra,
                                          .model = model,
                                          .young_modulus = 1.0e5f,
                                          .poisson_ratio = 0.3f});
    std::vector<DVec3> places;
    for (std::size_t i = 0; i < cube.vertices.size(); ++i) {
      const DVec3 p(cube.vertices[i]);
      if (!cube.inside[i]) world.pin(solid, int(i));
      places.push_back(cube.inside[i] ? p : p + p.x * exact[0] + p.y * exact[1] + p.z * exact[2]);
    }
    ASSERT_TRUE(world.set_vertices(solid, places, {}));
    add_brake(world, 10.0);
    run(world, 4.0);
    // The stress is a function of the gradient alone, so equal gradients are equal stresses. Strains are floats: at 0.1 % their rounding shows.
    double worst = 0.0;
    const SoftVertices v = world.vertices(solid);
    for (std::size_t t = 0; t < cube.tetrahedra.size(); t += 4) {
      std::array<DVec3, 4> rest, now;
      for (std::size_t n = 0; n < 4; ++n)
        rest[n] = DVec3(cube.vertices[cube.tetrahedra[t + n]]), now[n] = v.position(cube.tetrahedra[t + n]);
      const std::array<DVec3, 3> found = gradient_of(rest, now);
      for (std::size_t n = 0; n < 3; ++n) worst = std::fmax(worst, length(found[n] - exact[n]) / 0.05);
    }
    EXPECT_TRUE(limit_row("S-49 patch test: error of the strain of any element, share", worst, 1e-5, 1e-6))
        << int(model);
  }
}

TEST(SolidRest, ATurnGivesNoForce) {
  const PatchCube cube;
  for (const SolidModel model : {SolidModel::corotated, SolidModel::neo_hookean}) {
    World world = make_world({.gravity = {}, .sleeping = false});
    const SoftId solid = world.add_solid({.vertices = cube.vertices,
                                          .tetrahedra = cube.tetrahedra,
                                          .model = model,
                                          .young_modulus = 1.0e5f,
                                          .poisson_ratio = 0.3f});
    const double half = 0.5 * 137.0 * double(kDegree);
    const DVec3 axis = (std::sin(half) / std::sqrt(5.54)) * DVec3{1.2, -1.7, 1.1};
    const Quat turn{float(axis.x), float(axis.y), float(axis.z), float(std::cos(half))};
    std::vector<DVec3> places;
    for (const Vec3 p : cube.vertices) places.push_back(turned(turn, DVec3(p)));
    ASSERT_TRUE(world.set_vertices(solid, places, {}));
    world.step(kStep);
    double most = 0.0;
    const SoftVertices v = world.vertices(solid);
    for (std::size_t i = 0; i < v.size(); ++i) most = std::fmax(most, double(length(v.velocity(i))));
    // A strain of 1 would give vertices about the speed of its waves.
    const double wave = std::sqrt(1.0e5 / 1000.0);
    EXPECT_TRUE(limit_row("S-49 turned by 137 degrees: speed over that of waves", most / wave, 1e-5, 1e-6))
        << int(model);
  }
}

// A bar drawn by a strain e that contracts by nu e has E e in each tetrahedron, also when it is turned; what is pressed from all sides has none.
TEST(SolidRest, StressIsThatOfTheMaterial) {
  constexpr double kYoung = 2.0e5, kRatio = 0.3, kStrain = 0.01;
  const Quat turn = normalized(Quat{0.3f, -0.2f, 0.4f, 0.8f});
  const DVec3 drawn{1.0 + kStrain, 1.0 - kRatio * kStrain, 1.0 - kRatio * kStrain}, pressed{0.98, 0.98, 0.98};
  for (const SolidModel model : {SolidModel::corotated, SolidModel::neo_hookean}) {
    World world = make_world({.gravity = {}});
    const SoftId bar = world.add_solid({.box = SolidBox{{0.5f, 0.1f, 0.1f}, {5, 2, 2}},
                                        .model = model,
                                        .young_modulus = float(kYoung),
                                        .poisson_ratio = float(kRatio)});
    std::vector<DVec3> rest;
    for (std::size_t i = 0; i < world.vertices(bar).size(); ++i)
      rest.push_back(world.vertices(bar).position(i));
    for (const auto& [scale, expected] : {std::pair{drawn, kYoung * kStrain}, std::pair{pressed, 0.0}}) {
      std::vector<DVec3> places;
      for (const DVec3 p : rest)
        places.push_back(turned(turn, {scale.x * p.x, scale.y * p.y, scale.z * p.z}));
      ASSERT_TRUE(world.set_vertices(bar, places, {}));
      std::vector<float> stress(world.solid_stress(bar, {}));
      EXPECT_EQ(4 * stress.size(), world.solid_tetrahedra(bar, {}));
      ASSERT_EQ(world.solid_stress(bar, stress), stress.size());
      double worst = 0.0;
      for (const float one : stress) worst = std::fmax(worst, std::fabs(double(one) - expected));
      EXPECT_TRUE(limit_row("S-49 stress of a bar that is drawn or pressed: error, share of E e",
                            worst / (kYoung * kStrain), 1e-4, 1e-5))
          << int(model);
    }
  }
}

// The neo-Hookean law tells at a stretch how far a bar contracts across, and its force over the area at rest. The side t across solves
// mu t + stiff (stretch t^2 - a) stretch t = 0.
struct Uniaxial {
  double stretch, young, ratio;
  double mu = young / (2.0 * (1.0 + ratio));
  double stiff = young * ratio / ((1.0 + ratio) * (1.0 - 2.0 * ratio)) + mu, a = 1.0 + mu / stiff;
  double across = std::sqrt((a - mu / (stiff * stretch)) / stretch);
  double stress = mu * stretch + stiff * (stretch * across * across - a) * across * across;
};
// A block of 40 x 10 x 40 cm is pressed between smooth plates, of which one moves; the other one tells the force. (A cube between such plates rolls to its side when it is pressed to half: it has less energy there.)
TEST(SolidRest, PressureFollowsTheLaw) {
  for (const double stretch : {0.8, 0.5}) {
    const Uniaxial law{stretch, 1.0e5, 0.3};
    World world = make_world({.gravity = {}, .sleeping = false});
    const SoftId block =
        world.add_solid({.box = SolidBox{{0.2f, 0.05f, 0.2f}, {4, 2, 4}},
                         .pose = {{0, 0.05, 0}},
                         .young_modulus = float(law.young),
                         .poisson_ratio = float(law.ratio),
                         .settings = {.damping = 0.02f, .static_friction = 0.0f, .dynamic_friction = 0.0f}});
    const ShapeDef plate{.geometry = Box{{0.5f, 0.05f, 0.5f}}, .material = surface(0.0f)};
    const JointId below = world.add_joint(
        FixedDef{.b = world.add_body(point_body(1000.0, {100, 100, 100}, {0, -0.05, 0}), plate)});
    BodyDef press{.type = BodyType::kinematic, .pose = {{0, 0.15, 0}}};
    const BodyId above = world.add_body(press, plate);
    add_brake(world, 5.0);
    for (int i = 0; i < 180; ++i) {
      press.pose.position.y = 0.15 - 0.1 * (1.0 - stretch) * std::fmin(1.0, i / 120.0);
      world.move_kinematic(above, press.pose, kStep);
      world.step(kStep);
    }
    const SoftVertices v = world.vertices(block);
    const double width = v.x[4 + 5 * (1 + 3 * 2)] - v.x[0 + 5 * (1 + 3 * 2)];
    EXPECT_TRUE(relative_row("S-50 pressed neo-Hookean block: force, N",
                             double(world.joint_state(below).force.y), -0.16 * law.stress, 1e-2, 1e-3))
        << stretch;
    EXPECT_TRUE(relative_row("S-50 its width", width / 0.4, law.across, 1e-2, 1e-3)) << stretch;
  }
}
// A body pulls a long bar along, whose other end is held. The middle of the bar stretches by the law.
TEST(SolidRest, TensionFollowsTheLaw) {
  for (const double stretch : {1.2, 2.0}) {
    const Uniaxial law{stretch, 1.0e5, 0.3};
    World world = make_world({.gravity = {}, .sleeping = false});
    const SoftId bar = world.add_solid({.box = SolidBox{{0.05f, 0.5f, 0.05f}, {2, 20, 2}},
                                        .young_modulus = float(law.young),
                                        .poisson_ratio = float(law.ratio),
                                        .settings = {.damping = 0.02f}});
    BodyDef hook = point_body(2.0, {1, 1, 1}, {0, 0.5, 0});
    hook.locked = LockedAxes{{true, false, true}, {true, true, true}};
    const BodyId end = world.add_body(hook);
    const auto vertex = [](int i, int j, int k) { return std::size_t(i + 3 * (j + 21 * k)); };
    for (int n = 0; n < 9; ++n)
      world.pin(bar, int(vertex(n % 3, 0, n / 3))), world.attach(bar, int(vertex(n % 3, 20, n / 3)), end);
    add_brake(world, 5.0);
    for (int i = 0; i < 240; ++i) {
      world.add_force(end, {0, float(0.01 * law.stress), 0});
      world.step(kStep);
    }
    const SoftVertices v = world.vertices(bar);
    EXPECT_TRUE(relative_row("S-51 stretch of a pulled neo-Hookean bar",
                             (v.y[vertex(1, 14, 1)] - v.y[vertex(1, 6, 1)]) / 0.4, stretch, 1e-2, 1e-3));
    EXPECT_TRUE(relative_row("S-51 its width", (v.x[vertex(2, 10, 1)] - v.x[vertex(0, 10, 1)]) / 0.1,
                             law.across, 1e-2, 1e-3))
        << stretch;
  }
}

}  // namespace
}  // namespace gyre::laws::soft_bars_test
