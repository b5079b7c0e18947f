// Cloth that is twisted, heaped up, drawn through a ring, dropped on spikes, pinched and knotted: no edge ever passes a triangle. The judge is World::cloth_crossings, which
// is exact, after each step. Each scene also tells whether it came about: turns, layers, tension. The slow ones repeat it with other seeds, sizes, cells, sub-steps,
// thickness and friction.
// Source of the list of scenes: what is usual for contact of cloth without crossings (A. Chen and others, "Offset Geometric Contact", 2025).
#include "laws/kit.h"

#include <array>
#include <functional>

namespace gyre::laws::soft_crossings_test {
namespace {

constexpr float kHalfRoot = 0.70710678f;
constexpr Quat kUpright{kHalfRoot, 0, 0, kHalfRoot};  // z of a grid points down

struct Trial {
  std::uint32_t seed = 1;
  double size = 1.0;  // m, of a sheet
  int cells = 16;
  int substeps = 4;
  double thickness = 0.008;  // of the size
  float friction = 0.3f;
};

class Random {
 public:
  explicit Random(std::uint32_t seed) : state_(0x9e3779b9u * (seed + 1)) {}
  double between(double low, double high) {
    state_ = 1664525u * state_ + 1013904223u;
    return low + (high - low) * double(state_ >> 8) / double(1 << 24);
  }

 private:
  std::uint32_t state_;
};

// A world and how many crossings it has had.
struct Scene {
  explicit Scene(const Trial& with, float gravity = 9.81f)
      : trial(with),
        random(with.seed),
        world(make_world(
            {.gravity = {0, -gravity, 0}, .stepping = {.substeps = with.substeps}, .sleeping = false})) {}
  Trial trial;
  Random random;
  World world;
  std::size_t most = 0;  // crossings after a step
  int steps = 0, frozen = 0;

  // Scenes of any size go by the time of a fall.
  double time_scale() const { return std::sqrt(trial.size); }
  float step_size() const { return float(double(kStep) * time_scale()); }
  void step() {
    world.step(step_size());
    ++steps;
    most = std::max(most, world.cloth_crossings());
    for (const Problem& problem : world.problems()) frozen += problem.severity == Severity::error;
  }
  void run(double seconds) {  // for a size of 1 m
    for (int n = 0; n < int(std::lround(seconds * 60.0)); ++n) step();
  }
  // A sheet whose vertices begin with a breath of air.
  SoftId add_sheet(ClothDef def) {
    def.thickness = float(trial.thickness * trial.size);
    def.settings.static_friction = def.settings.dynamic_friction = trial.friction;
    def.settings.damping = float(5.0e-3 * time_scale());
    const int vertices = (def.grid->cells[0] + 1) * (def.grid->cells[1] + 1);
    for (int i = 0; i < vertices; ++i) {
      const float speed = float(0.05 * time_scale());
      def.settings.velocities.push_back({speed * float(random.between(-1, 1)),
                                         speed * float(random.between(-1, 1)),
                                         speed * float(random.between(-1, 1))});
    }
    return world.add_cloth(def);
  }
  ClothDef sheet() const {
    return {.grid = ClothGrid{{float(trial.size), float(trial.size)}, {trial.cells, trial.cells}},
            .stretch_stiffness = float(2000.0 * trial.size),
            .shear_stiffness = float(100.0 * trial.size),
            .bend_stiffness = float(2.0e-5 * std::pow(trial.size, 3))};
  }
  BodyId add_body(BodyType type, DVec3 place, const ShapeDef& shape, Quat turn = {}) {
    ShapeDef def = shape;
    def.material = surface(trial.friction);
    return world.add_body({.type = type, .pose = {place, turn}}, def);
  }
};

Quat about_y(double angle) { return {0, float(std::sin(0.5 * angle)), 0, float(std::cos(0.5 * angle))}; }

// The upper and the lower edge of an upright sheet turn against each other, `turns` in four seconds. They are held for a second and let go.
Scene twist(const Trial& trial, double turns) {
  Scene scene(trial);
  const double size = trial.size;
  ClothDef def = scene.sheet();
  def.pose.orientation = kUpright;
  const SoftId cloth = scene.add_sheet(def);
  BodyId bars[2];
  for (int end = 0; end < 2; ++end) {
    bars[end] = scene.add_body(BodyType::kinematic, {0, size * (0.5 - end), 0},
                               {.geometry = Sphere{float(0.01 * size)}, .filter = {.collides_with = 0}});
    for (int i = 0; i <= trial.cells; ++i)
      scene.world.attach(cloth, i + end * trial.cells * (trial.cells + 1), bars[end]);
  }
  for (int n = 0; n < 240; ++n) {
    const double share = (n + 1) / 240.0, angle = kPiDouble * turns * share;
    for (int end = 0; end < 2; ++end)
      scene.world.move_kinematic(bars[end], {{0, size * (0.5 - end), 0}, about_y(end == 0 ? angle : -angle)},
                                 scene.step_size());
    scene.step();
  }
  for (int end = 0; end < 2; ++end) scene.world.set_velocity(bars[end], {}, {});
  scene.run(1.0);
  for (int end = 0; end < 2; ++end)
    for (int i = 0; i <= trial.cells; ++i)
      scene.world.release(cloth, i + end * trial.cells * (trial.cells + 1));
  scene.run(1.0);
  return scene;
}

// Sheets that fall on a level cylinder in layers, each turned against the one below.
Scene heap(const Trial& trial, int sheets) {
  Scene scene(trial);
  const double size = trial.size;
  add_ground(scene.world, surface(trial.friction));
  scene.add_body(BodyType::fixed, {0, 0.5 * size, 0},
                 {.geometry = Cylinder{float(0.2 * size), float(0.7 * size)}}, {kHalfRoot, 0, 0, kHalfRoot});
  for (int k = 0; k < sheets; ++k) {
    ClothDef def = scene.sheet();
    def.pose = {{scene.random.between(-0.05, 0.05) * size, (0.75 + 0.05 * k) * size,
                 scene.random.between(-0.05, 0.05) * size},
                about_y(0.3 * k + scene.random.between(-0.2, 0.2))};
    scene.add_sheet(def);
  }
  scene.run(2.0);
  return scene;
}

// A sheet is drawn by its middle through a ring of a sixth of its width.
Scene pull_through(const Trial& trial, double& passed) {
  Scene scene(trial);
  const double size = trial.size, wire = 0.015 * size, middle = size / 12.0 + wire;
  constexpr int kBars = 16;
  BodyDef ring;
  ring.type = BodyType::fixed;
  const BodyId body = scene.world.add_body(ring);
  for (int k = 0; k < kBars; ++k) {
    const double a = 2.0 * kPiDouble * k / kBars;
    // A capsule lies along y; it is turned into the ring's tangent.
    ShapeDef bar{.geometry = Capsule{float(wire), float(middle * std::tan(kPiDouble / kBars))},
                 .material = surface(0.3f * trial.friction)};
    bar.local = {Vec3{float(middle * std::cos(a)), 0, float(middle * std::sin(a))},
                 {kHalfRoot * float(std::cos(a)), 0, kHalfRoot * float(std::sin(a)), kHalfRoot}};
    scene.world.add_shape(body, bar);
  }
  ClothDef def = scene.sheet();
  def.pose = {{0, 1.5 * wire + trial.thickness * size, 0}, about_y(scene.random.between(0, 1.5))};
  const SoftId cloth = scene.add_sheet(def);
  const BodyId hook =
      scene.add_body(BodyType::kinematic, {0, 0, 0},
                     {.geometry = Sphere{float(0.02 * size)}, .filter = {.collides_with = 0}});
  const int half = trial.cells / 2, columns = trial.cells + 1;
  for (const int v : {half * columns + half, half * columns + half + 1, half * columns + half - 1,
                      (half + 1) * columns + half, (half - 1) * columns + half})
    scene.world.attach(cloth, v, hook);
  for (int n = 0; n < 180; ++n) {
    scene.world.move_kinematic(hook, {{0, -0.9 * size * (n + 1) / 180.0, 0}, {}}, scene.step_size());
    scene.step();
  }
  scene.world.set_velocity(hook, {}, {});
  scene.run(0.5);
  // All of it is below the ring.
  double high = -1e9;
  const SoftVertices v = scene.world.vertices(cloth);
  for (std::size_t i = 0; i < v.size(); ++i) high = std::fmax(high, v.y[i]);
  passed = high / size;
  return scene;
}

// A sheet falls on five cones with rounded tips.
Scene impale(const Trial& trial) {
  Scene scene(trial);
  const double size = trial.size;
  add_ground(scene.world, surface(trial.friction));
  for (int k = 0; k < 5; ++k) {
    const double a = kPiDouble * (0.25 + 0.5 * k), r = k == 4 ? 0.0 : 0.28 * size;
    const DVec3 place{r * std::cos(a), 0.27 * size, r * std::sin(a)};
    scene.add_body(BodyType::fixed, place, {.geometry = Cone{float(0.1 * size), float(0.27 * size)}});
    scene.add_body(BodyType::fixed, place + DVec3{0, 0.24 * size, 0},
                   {.geometry = Sphere{float(0.025 * size)}});
  }
  ClothDef def = scene.sheet();
  def.pose = {
      {scene.random.between(-0.03, 0.03) * size, 0.75 * size, scene.random.between(-0.03, 0.03) * size},
      about_y(scene.random.between(0, 1.5))};
  scene.add_sheet(def);
  scene.run(2.0);
  return scene;
}

// A curtain in three layers that hangs between two boxes which fly at each other, at 1 m/s together, or a sheet that lies between boxes which push its edges together.
enum class Press { faces, edges };
Scene pinch(const Trial& trial, Press press, BodyType type) {
  Scene scene(trial);
  const double size = trial.size, speed = 0.5 * scene.time_scale();
  if (press == Press::edges) add_ground(scene.world, surface(trial.friction));
  ClothDef def = scene.sheet();
  def.pose.position = {0, 0.01 * size, 0};
  if (press == Press::faces) {
    // It goes along x, back in a layer behind, and on in a third; half a circle of 5 cm leads from each to the next.
    const double radius = 0.05, arc = kPiDouble * radius, straight = (1.0 - 2.0 * arc) / 3.0;
    for (int j = 0; j <= trial.cells; ++j) {
      for (int i = 0; i <= trial.cells; ++i) {
        double along = double(i) / trial.cells, sign = -1.0, layer = -2.0 * radius;
        for (; along > straight + arc; along -= straight + arc) sign = -sign, layer += 2.0 * radius;
        const double angle = std::fmax(along - straight, 0.0) / radius;
        const double x = sign * (0.5 * straight - std::fmin(along, straight) - radius * std::sin(angle));
        def.settings.positions.push_back(
            size * DVec3{x, 0.5 - double(j) / trial.cells, layer + radius * (1.0 - std::cos(angle))});
      }
    }
  }
  const SoftId cloth = scene.add_sheet(def);
  for (int i = 0; i <= trial.cells && press == Press::faces; ++i) scene.world.pin(cloth, i);
  BodyId bodies[2];
  const DVec3 way = press == Press::faces ? DVec3{0, 0, 1} : DVec3{1, 0, 0};
  const double start = press == Press::faces ? 0.3 * size : 0.62 * size, end = 0.2 * size, half = 0.1 * size;
  const Vec3 extents = press == Press::faces ? Vec3{float(0.2 * size), float(0.2 * size), float(half)}
                                             : Vec3{float(half), float(0.3 * size), float(0.7 * size)};
  for (int side = 0; side < 2; ++side) {
    const double sign = side == 0 ? -1.0 : 1.0;
    BodyDef body{
        .type = type,
        .pose = {sign * (start + half) * way + DVec3{0, press == Press::edges ? 0.301 * size : 0.0, 0}}};
    body.linear_velocity = to_float(-sign * speed * way), body.gravity_scale = 0.0f,
    body.mass = float(2.0 * size * size);
    bodies[side] =
        scene.world.add_body(body, {.geometry = Box{extents}, .material = surface(trial.friction)});
  }
  // Kinematic ones leave four times the thickness between them, or a fifth of the width.
  const double gap = press == Press::faces ? 4.0 * trial.thickness * size : end;
  const int closing = int((start - 0.5 * gap) / (speed * double(scene.step_size())));
  for (int n = 0; n < closing; ++n) scene.step();
  if (type == BodyType::kinematic)
    for (const BodyId body : bodies) scene.world.set_velocity(body, {}, {});
  scene.run(1.0);
  return scene;
}

// A ribbon with an overhand knot, whose ends are drawn apart. The middle line is a trefoil, opened at a lobe; there it rises so that both ends pass each other.
struct Ribbon {
  std::vector<DVec3> middle, across;  // m; across is of unit length and at right angles to the line
  double length = 0.0;
};
Ribbon make_knot(double scale, double leg, int points) {
  std::vector<DVec3> line;
  constexpr int kFine = 4000;
  const double lobe = kPiDouble;  // of x = sin t + 2 sin 2t, y = cos t - 2 cos 2t the point -3 y
  for (int i = 0; i <= kFine; ++i) {
    const double s = 2.0 * i / kFine - 1.0, t = lobe + kPiDouble * (1.0 + s);
    line.push_back(scale * DVec3{std::sin(t) + 2.0 * std::sin(2.0 * t), 0.8 * s - std::sin(3.0 * t),
                                 std::cos(t) - 2.0 * std::cos(2.0 * t)});
  }
  const DVec3 first = line[1] - line[0], last = line[kFine] - line[kFine - 1];
  std::vector<DVec3> whole;
  whole.push_back(line.front() - (leg / length(first)) * first);
  for (const DVec3& p : line) whole.push_back(p);
  whole.push_back(line.back() + (leg / length(last)) * last);
  std::vector<double> along = {0.0};
  for (std::size_t i = 1; i < whole.size(); ++i)
    along.push_back(along.back() + length(whole[i] - whole[i - 1]));
  Ribbon ribbon{.length = along.back()};
  DVec3 side{0, 1, 0};
  std::size_t at = 1;
  for (int i = 0; i <= points; ++i) {
    const double s = ribbon.length * i / points;
    while (at + 1 < whole.size() && along[at] < s) ++at;
    const double share = (s - along[at - 1]) / (along[at] - along[at - 1]);
    const DVec3 tangent = (1.0 / (along[at] - along[at - 1])) * (whole[at] - whole[at - 1]);
    ribbon.middle.push_back(whole[at - 1] + share * (whole[at] - whole[at - 1]));
    side = side - dot(side, tangent) * tangent;
    side = (1.0 / length(side)) * side;
    ribbon.across.push_back(side);
  }
  return ribbon;
}

Scene pull_knot(const Trial& trial, double& strain, double& extent) {
  Scene scene(trial, 0.0f);
  const double scale = trial.size / 40.0, width = 0.8 * scale;
  constexpr int kAcross = 3;
  const int along = 8 * trial.cells;
  const Ribbon ribbon = make_knot(scale, 5.0 * scale, along);
  ClothDef def = scene.sheet();
  def.grid = ClothGrid{{float(width), float(ribbon.length)}, {kAcross, along}};
  for (int j = 0; j <= along; ++j)
    for (int i = 0; i <= kAcross; ++i)
      def.settings.positions.push_back(ribbon.middle[std::size_t(j)] +
                                       width * (double(i) / kAcross - 0.5) * ribbon.across[std::size_t(j)]);
  const SoftId cloth = scene.add_sheet(def);
  BodyId ends[2];
  DVec3 way[2];
  for (int end = 0; end < 2; ++end) {
    const std::size_t last = end == 0 ? 0 : std::size_t(along), next = end == 0 ? 1 : std::size_t(along) - 1;
    const DVec3 place = ribbon.middle[last], out = place - ribbon.middle[next];
    way[end] = (1.0 / length(out)) * out;
    ends[end] =
        scene.add_body(BodyType::kinematic, place,
                       {.geometry = Sphere{float(0.001 * trial.size)}, .filter = {.collides_with = 0}});
    for (int i = 0; i <= kAcross; ++i) scene.world.attach(cloth, int(last) * (kAcross + 1) + i, ends[end]);
  }
  const double speed = 0.15 * trial.size / scene.time_scale();
  const auto strain_of_legs = [&] {
    const SoftVertices v = scene.world.vertices(cloth);
    const int cells = along / 16;
    const auto at = [&](int j) { return v.position(std::size_t(j * (kAcross + 1) + 1)); };
    return 0.5 * (length(at(cells) - at(0)) + length(at(along) - at(along - cells))) /
               (cells * ribbon.length / along) -
           1.0;
  };
  const auto apart = [&] {
    const SoftVertices v = scene.world.vertices(cloth);
    return length(v.position(v.size() - 2) - v.position(1));
  };
  for (const bool pulled : {true, false}) {
    for (int end = 0; end < 2; ++end)
      scene.world.set_velocity(ends[end], pulled ? to_float(speed * way[end]) : Vec3{}, {});
    for (int n = 0;
         n < (pulled ? 600 : 30) && (!pulled || apart() < 0.6 * ribbon.length || strain_of_legs() < 0.02);
         ++n)
      scene.step();
  }
  strain = strain_of_legs();
  // How much of the ribbon the knot holds: what its ends are nearer than its length.
  extent = 1.0 + strain - apart() / ribbon.length;
  return scene;
}

// Two sheets that begin across each other, half of one on each side of the other, a corner through, or a fold through itself.
enum class Tangle { cards, corner, fold };
Scene untangle(const Trial& trial, Tangle tangle, double& seconds, int& untold) {
  Scene scene(trial, 0.0f);
  const double size = trial.size;
  const auto add = [&](const std::function<DVec3(double, double)>& place) {
    ClothDef def = scene.sheet();
    for (int j = 0; j <= trial.cells; ++j)
      for (int i = 0; i <= trial.cells; ++i)
        def.settings.positions.push_back(size *
                                         place(double(i) / trial.cells - 0.5, double(j) / trial.cells - 0.5));
    scene.add_sheet(def);
  };
  const double shift = scene.random.between(0.01, 0.03);
  if (tangle != Tangle::fold) add([](double x, double z) { return DVec3{x, 0, z}; });
  if (tangle == Tangle::cards) add([&](double x, double y) { return DVec3{x + 0.7, y, shift}; });
  if (tangle == Tangle::corner)
    add([&](double x, double y) {
      return DVec3{double(kHalfRoot) * (x - y), double(kHalfRoot) * (x + y + 1.0) - 0.2, shift};
    });
  if (tangle == Tangle::fold) {
    add([&](double x, double z) {  // its half goes back through the other half, behind the fold
      const double r = 0.08, arc = kPiDouble * r;
      if (x < 0.0) return DVec3{x, 0, z};
      if (x < arc) return DVec3{r * std::sin(x / r), r - r * std::cos(x / r), z};
      return DVec3{-0.5 * (x - arc), 2.0 * r - 0.866 * (x - arc), 0.98 * z + shift};
    });
  }
  EXPECT_GT(scene.world.cloth_crossings(), 0u);
  seconds = 0.0;
  untold = 0;
  for (int n = 0; n < 120; ++n) {
    scene.step();
    if (scene.world.cloth_crossings() == 0) continue;
    untold += scene.world.problems().empty();
    seconds = (n + 1) * double(scene.step_size());
  }
  return scene;
}

bool has_none(const char* name, const Scene& scene) {
  return limit_row(name, double(scene.most), 0.0, 0.0) && scene.frozen == 0;
}
std::string text(const Trial& t) {
  return "seed " + std::to_string(t.seed) + ", size " + std::to_string(t.size) + ", cells " +
         std::to_string(t.cells) + ", sub-steps " + std::to_string(t.substeps) + ", thickness " +
         std::to_string(t.thickness) + ", friction " + std::to_string(t.friction);
}

void expect_none_drawn(const Trial& trial) {
  double passed = 0.0;
  EXPECT_TRUE(has_none("S-82 sheet through a ring of a sixth: crossings", pull_through(trial, passed)))
      << text(trial);
  EXPECT_LT(passed, -0.2) << text(trial);  // all of it is through
}
void expect_none_pinched(const Trial& trial) {
  EXPECT_TRUE(has_none("S-84 curtain between bodies at 1 m/s: crossings",
                       pinch(trial, Press::faces, BodyType::kinematic)))
      << text(trial);
  EXPECT_TRUE(has_none("S-84 curtain between bodies at 1 m/s: crossings",
                       pinch(trial, Press::faces, BodyType::dynamic)))
      << text(trial);
  EXPECT_TRUE(has_none("S-84 sheet pushed together at 1 m/s: crossings",
                       pinch(trial, Press::edges, BodyType::kinematic)))
      << text(trial);
}
void expect_none_knotted(const Trial& trial) {
  double strain = 0.0, extent = 0.0;
  EXPECT_TRUE(has_none("S-85 knot in a ribbon, pulled tight: crossings", pull_knot(trial, strain, extent)))
      << text(trial);
  EXPECT_GT(extent, 0.05) << text(trial);  // it is still there
  if (trial.substeps >= 4 && trial.friction < 0.5f) {
    EXPECT_LT(extent, 0.2) << text(trial);  // and tight: 4 widths of a folded ribbon are 8 %
  }
}

TEST(ClothCrossings, ATwistedSheet) {
  EXPECT_TRUE(
      has_none("S-80 square sheet twisted by 1.5 turns and let go: crossings", twist({.cells = 8}, 1.5)));
}
TEST(ClothCrossings, TenSheetsOnACylinder) {
  EXPECT_TRUE(
      has_none("S-81 ten sheets on a cylinder: crossings", heap({.cells = 8, .thickness = 0.016}, 10)));
}
TEST(ClothCrossings, ASheetThroughARing) { expect_none_drawn({}); }
TEST(ClothCrossings, ASheetOnFiveSpikes) {
  EXPECT_TRUE(has_none("S-83 sheet on five spikes: crossings", impale({})));
}
TEST(ClothCrossings, ASheetBetweenTwoBodies) { expect_none_pinched({}); }
TEST(ClothCrossings, AKnotInARibbon) { expect_none_knotted({}); }

TEST(ClothCrossings, WhatBeginsTangledPartsWithinASecond) {
  for (const Tangle tangle : {Tangle::cards, Tangle::corner, Tangle::fold}) {
    for (const int cells : {10, 16}) {
      double seconds = 0.0;
      int untold = 0;
      untangle({.size = 0.5, .cells = cells}, tangle, seconds, untold);
      EXPECT_TRUE(limit_row("S-86 sheets that begin tangled: apart after, s", seconds, 1.0, 0.5))
          << int(tangle) << ' ' << cells;
      EXPECT_TRUE(limit_row("S-86 steps in which a crossing is not told", untold, 0.0, 0.0))
          << int(tangle) << ' ' << cells;
    }
  }
}

// The trials of the slow ones.
std::vector<Trial> trials() {
  return {{.seed = 2},
          {.seed = 3},
          {.size = 0.05},
          {.size = 10.0},
          {.cells = 10},
          {.substeps = 1},
          {.substeps = 2},
          {.substeps = 16},
          {.thickness = 0.003},
          {.thickness = 0.02},
          {.friction = 0.0f},
          {.friction = 1.0f},
          {.seed = 4, .cells = 28}};
}
TEST(LongClothCrossings, TwistedSheets) {
  for (const Trial& trial : {Trial{.cells = 8}, Trial{.cells = 10}, Trial{.seed = 2, .cells = 12},
                             Trial{.size = 0.1, .cells = 10}, Trial{.cells = 10, .friction = 1.0f}})
    EXPECT_TRUE(has_none("S-80 square sheet twisted by two turns and let go: crossings", twist(trial, 2.0)))
        << text(trial);
}
TEST(LongClothCrossings, TenSheetsOnACylinder) {
  for (Trial trial :
       {Trial{}, Trial{.seed = 2}, Trial{.size = 0.05}, Trial{.substeps = 1}, Trial{.friction = 1.0f}})
    EXPECT_TRUE(has_none("S-81 ten sheets on a cylinder: crossings", heap(trial, 10))) << text(trial);
}
TEST(LongClothCrossings, SheetsThroughARing) {
  for (const Trial& trial : trials()) expect_none_drawn(trial);
}
TEST(LongClothCrossings, SheetsOnFiveSpikes) {
  for (const Trial& trial : trials())
    EXPECT_TRUE(has_none("S-83 sheet on five spikes: crossings", impale(trial))) << text(trial);
}
TEST(LongClothCrossings, SheetsBetweenTwoBodies) {
  for (const Trial& trial : trials()) expect_none_pinched(trial);
}
TEST(LongClothCrossings, KnotsInRibbons) {
  for (const Trial& trial : trials()) expect_none_knotted(trial);
}

}  // namespace
}  // namespace gyre::laws::soft_crossings_test
