#include <algorithm>
#include <cmath>
#include <cstdlib>

#include "bench/scenes/builders.h"
#include "bench/scenes/jointed_scenes.h"

namespace gyre::bench {
namespace {

void pyramid_at(Scene& sc, int base, V3 at, double step = 1.1) {
  for (int row = 0; row < base; ++row)
    for (int i = 0; i < base - row; ++i) {
      int b = add(sc, box({0.5, 0.5, 0.5}), at + V3{(i - 0.5 * (base - row - 1)) * step, 0.5 + row, 0});
      if (row == base - 1) sc.tops.push_back(b);
    }
}

Scene pyramid(int base) {
  Scene sc;
  sc.steps = 300;
  ground(sc, 100);
  pyramid_at(sc, base, {});
  return sc;
}

Scene many_pyramids() {
  Scene sc;
  sc.steps = 200;
  ground(sc, 100);
  for (int i = 0; i < 8; ++i)
    for (int j = 0; j < 8; ++j) pyramid_at(sc, 10, {(i - 3.5) * 14, 0, (j - 3.5) * 3});
  return sc;
}

// So many bodies as deep as 4,000 of them in a pit of 15 m half width.
Scene heap(int count, Shape (*shape)(Lcg&, int)) {
  Scene sc;
  sc.steps = 500;
  const double scale = std::sqrt(count / 4000.0);
  const int side = std::max(1, int(std::lround(16 * scale))), layer = side * side;
  pit(sc, 15 * scale, 40);
  Lcg g(1);
  for (int i = 0; i < count; ++i) {
    const int l = i / layer, r = i % layer;
    const Shape one = shape(g, i);
    const double middle = 0.5 * (side - 1);
    add(sc, one, {(r % side - middle) * 1.8, 1.5 + 1.8 * l, (r / side - middle) * 1.8}, g.rotation());
  }
  return sc;
}
Shape any_box(Lcg& g, int) { return box({g.range(0.35, 0.5), g.range(0.35, 0.5), g.range(0.35, 0.5)}); }
Shape any_plank(Lcg& g, int) { return box({g.range(0.5, 0.7), g.range(0.08, 0.15), g.range(0.2, 0.3)}); }
Shape any_sphere(Lcg& g, int) { return sphere(g.range(0.3, 0.5)); }
Shape any_capsule(Lcg& g, int) { return capsule(g.range(0.2, 0.3), g.range(0.2, 0.4)); }
Scene hull_heap(int count) {
  Scene sc = heap(count, [](Lcg&, int i) { return hull(i % 32); });
  add_hulls(sc, 32, 16, 0.5, 2);
  return sc;
}

// A wall of about so many bricks in running bond, and a ball of 8 t/m^3 that hits it after 0.8 s.
Scene wall(int count) {
  Scene sc;
  sc.steps = 400;
  ground(sc, 100);
  const int rows = std::max(2, int(std::sqrt(0.5 * count))), columns = 2 * rows;
  for (int row = 0; row < rows; ++row) {
    for (int i = 0; i < columns; ++i)
      add(sc, box({0.49, 0.25, 0.25}), {i - 0.5 * columns + 0.5 * (row % 2), 0.25 + 0.5 * row, 0});
  }
  Body& ball = sc.bodies[std::size_t(add(sc, sphere(0.4), {0.3, 1.5, -12}))];
  ball.density = 8000;
  ball.vel = {0, 2, 14};
  return sc;
}

// Stacks of ten boxes, about so many in all.
Scene stacks(int count) {
  Scene sc;
  sc.steps = 400;
  ground(sc, 200);
  const int side = std::max(1, int(std::sqrt(0.1 * count)));
  for (int i = 0; i < side * side; ++i) {
    for (int k = 0; k < 10; ++k)
      add(sc, box({0.5, 0.5, 0.5}), {2.0 * (i % side - side / 2), 0.5 + k, 2.0 * (i / side - side / 2)});
  }
  return sc;
}

Scene hull_pile() {
  Scene sc;
  sc.steps = 500;
  pit(sc, 10, 30);
  add_hulls(sc, 32, 16, 0.5, 2);
  Lcg g(3);
  for (int i = 0; i < 2000; ++i) {
    int l = i / 225, r = i % 225;
    add(sc, hull(i % 32), {(r % 15 - 7) * 1.3, 1.5 + 1.3 * l, (r / 15 - 7) * 1.3}, g.rotation());
  }
  return sc;
}

Shape mixed_shape(Lcg& g, int kinds, int i) {
  switch (i % kinds) {
    case 0:
      return sphere(g.range(0.3, 0.5));
    case 1:
      return capsule(g.range(0.2, 0.3), g.range(0.2, 0.4));
    case 2:
      return box({g.range(0.25, 0.45), g.range(0.25, 0.45), g.range(0.25, 0.45)});
    default:
      return hull(i % 32);
  }
}

Scene mixed_pile() {
  Scene sc;
  sc.steps = 500;
  pit(sc, 12, 30);
  Lcg g(4);
  for (int i = 0; i < 3000; ++i) {
    int l = i / 196, r = i % 196;
    Shape s = mixed_shape(g, 3, i);
    add(sc, s, {(r % 14 - 6.5) * 1.6, 1.5 + 1.6 * l, (r / 14 - 6.5) * 1.6}, g.rotation());
  }
  return sc;
}

// Hills with a rim around a square of half width `rim`.
double terrain_height(double x, double z, double rim) {
  const double e = std::max(std::fabs(x), std::fabs(z)) - rim;
  return 1.2 * std::sin(0.45 * x) * std::cos(0.37 * z) + 0.4 * std::sin(1.1 * x + 0.7 * z) + (e > 0 ? e : 0);
}

Mesh terrain(int quads) {
  Mesh m;
  m.n = quads;
  m.size = quads;
  for (int j = 0; j <= m.n; ++j) {
    for (int i = 0; i <= m.n; ++i) {
      const double x = i - 0.5 * quads, z = j - 0.5 * quads;
      m.v.push_back({x, terrain_height(x, z, 0.5 * quads - 8), z});
    }
  }
  for (int j = 0; j < m.n; ++j) {
    for (int i = 0; i < m.n; ++i) {
      const int a = j * (m.n + 1) + i, b = a + 1, c = a + m.n + 1, d = c + 1;
      for (const int t : {a, c, b, b, c, d}) m.tri.push_back(t);
    }
  }
  return m;
}

// So many shapes of four kinds on hills, as dense as 2,000 of them on 100 m by 100 m.
Scene mesh_rain(int count) {
  Scene sc;
  sc.steps = 400;
  const double scale = std::sqrt(count / 2000.0);
  const int columns = std::max(1, int(std::lround(25 * scale))),
            rows = std::max(1, int(std::lround(20 * scale)));
  sc.meshes.push_back(terrain(std::max(20, int(std::lround(100 * scale)))));
  Shape s;
  s.kind = Kind::mesh;
  s.data = 0;
  add(sc, s, {}, {}, Motion::fixed);
  add_hulls(sc, 32, 16, 0.5, 5);
  Lcg g(6);
  for (int i = 0; i < count; ++i) {
    const int l = i / (columns * rows), r = i % (columns * rows);
    const Shape sh = mixed_shape(g, 4, i);
    const double x = (r % columns - columns / 2) * 3.0 + g.range(-0.5, 0.5);
    const double z = (r / columns - 0.5 * (rows - 1)) * 3.0 + g.range(-0.5, 0.5);
    add(sc, sh, {x, 4.0 + 1.8 * l, z}, g.rotation());
  }
  return sc;
}

// A town of fixed boxes, ten to a column over a square metre and a half, and a hundredth as many small ones that rain on it.
Scene field(int count) {
  Scene sc;
  sc.steps = 120;
  const int side = std::max(1, int(std::lround(std::sqrt(count / 10.0))));
  Lcg g(12);
  for (int i = 0; i < count; ++i) {
    const int l = i / (side * side), r = i % (side * side);
    const V3 h{g.range(0.4, 0.7), g.range(0.3, 0.5), g.range(0.4, 0.7)};
    add(sc, box(h), {(r % side - side / 2) * 1.5, 0.5 + 1.0 * l, (r / side - side / 2) * 1.5}, {},
        Motion::fixed);
  }
  const int moving = std::max(1, count / 100), columns = std::max(1, int(std::sqrt(double(moving))));
  const double top = 1.5 + count / (side * side), gap = 1.5 * side / columns;
  for (int i = 0; i < moving; ++i) {
    const int r = i % (columns * columns);
    add(sc, box({0.3, 0.3, 0.3}),
        {(r % columns - 0.5 * columns) * gap, top + 0.8 * (i / (columns * columns)),
         (r / columns - 0.5 * columns) * gap},
        g.rotation());
  }
  return sc;
}

Scene tumbler() {
  Scene sc;
  sc.steps = 600;
  Body drum;
  drum.motion = Motion::kinematic;
  drum.pos = {0, 12, 0};
  drum.ang = {0, 0, 0.8};
  const int n = 32;
  const double R = 7, L = 6;
  for (int i = 0; i < n; ++i) {
    double t = 2 * kPi * i / n;
    Shape s = box({0.5, (R + 1) * std::tan(kPi / n) + 0.02, L});
    s.local = {{(R + 0.5) * std::cos(t), (R + 0.5) * std::sin(t), 0}, axis_angle({0, 0, 1}, t)};
    drum.shapes.push_back(s);
  }
  for (int i = 0; i < 4; ++i) {
    double t = 2 * kPi * (i + 0.5) / 4;
    Shape s = box({0.7, 0.2, L});
    s.local = {{(R - 0.7) * std::cos(t), (R - 0.7) * std::sin(t), 0}, axis_angle({0, 0, 1}, t)};
    drum.shapes.push_back(s);
  }
  for (int i = -1; i <= 1; i += 2) {
    Shape s = box({R + 1, R + 1, 0.5});
    s.local = {{0, 0, i * (L + 0.5)}, {}};
    drum.shapes.push_back(s);
  }
  sc.bodies.push_back(drum);
  Lcg g(8);
  for (int i = 0; i < 1500; ++i) {
    int l = i / 169, r = i % 169;
    add(sc, box({0.25, 0.25, 0.25}), {(r % 13 - 6) * 0.62, 12 + (r / 13 - 6) * 0.62, (l - 4) * 1.1});
  }
  return sc;
}

Scene dominoes() {
  Scene sc;
  sc.steps = 500;
  ground(sc, 60);
  const V3 h{0.06, 0.5, 0.25};
  for (int row = 0; row < 50; ++row)
    for (int i = 0; i < 100; ++i) {
      double x = (i - 50) * 0.45, z = (row - 25) * 1.2, t = i == 0 ? 0.3 : 0;
      add(sc, box(h), {x, h.x * std::sin(t) + h.y * std::cos(t), z}, axis_angle({0, 0, 1}, -t));
    }
  return sc;
}

// One column of 20 boxes.
Scene tower() {
  Scene sc;
  sc.steps = 600;
  ground(sc, 30);
  for (int i = 0; i < 20; ++i) add(sc, box({0.5, 0.5, 0.5}), {0, 0.5 + i, 0});
  sc.tops.push_back(int(sc.bodies.size()) - 1);
  return sc;
}

// Ten light boxes under one that weighs a hundred times as much.
Scene heavy_stack() {
  Scene sc;
  sc.steps = 600;
  ground(sc, 30);
  for (int i = 0; i < 11; ++i)
    add(sc, box({0.5, 0.5, 0.5}), {0, 0.5 + i, 0}, {}, Motion::dynamic, i == 10 ? 10000 : 100);
  sc.tops.push_back(int(sc.bodies.size()) - 1);
  return sc;
}

Scene ray_field() {
  Scene sc;
  sc.steps = 5;
  sc.rays = true;
  add_hulls(sc, 32, 16, 0.8, 9);
  Lcg g(10);
  for (int i = 0; i < 10000; ++i) {
    Shape s =
        i % 4 == 3
            ? hull(i % 32)
            : (i % 4 == 0 ? sphere(g.range(0.4, 0.8))
                          : (i % 4 == 1 ? capsule(g.range(0.3, 0.5), g.range(0.3, 0.8))
                                        : box({g.range(0.4, 0.8), g.range(0.4, 0.8), g.range(0.4, 0.8)})));
    add(sc, s, {(i % 100 - 50) * 2.0, g.range(0, 20), (i / 100 - 50) * 2.0}, g.rotation(), Motion::fixed);
  }
  return sc;
}
}  // namespace

std::vector<Ray> ray_list() {
  std::vector<Ray> r;
  Lcg g(11);
  for (int i = 0; i < 100000; ++i) {
    V3 o{g.range(-100, 100), g.range(0, 20), g.range(-100, 100)};
    V3 d = g.dir();
    d.y *= 0.2;
    r.push_back({o, 100.0 * unit(d)});
  }
  return r;
}

namespace {

struct NamedScene {
  const char* name;
  Scene (*make)();  // none: only with a number
  Scene (*make_of)(int number) = nullptr;
  int max_number = 1000000;
};
const NamedScene kScenes[] = {
    {"pyramid", [] { return pyramid(60); }, pyramid, 1000},  // half a million bodies
    {"many_pyramids", many_pyramids},
    {"box_pile", [] { return heap(4000, any_box); }, [](int n) { return heap(n, any_box); }},
    {"hull_pile", hull_pile},
    {"mixed_pile", mixed_pile},
    {"mesh_rain", [] { return mesh_rain(2000); }, mesh_rain},
    {"ragdolls", ragdolls},
    {"joint_grid", joint_grid},
    {"chain", [] { return chain(false); }},
    {"chain_swing", [] { return chain(true); }},
    {"tumbler", tumbler},
    {"dominoes", dominoes},
    {"tower", tower},
    {"heavy_stack", heavy_stack},
    {"rays", ray_field},
    {"field", nullptr, field},
    {"planks", nullptr, [](int n) { return heap(n, any_plank); }},
    {"spheres", nullptr, [](int n) { return heap(n, any_sphere); }},
    {"capsules", nullptr, [](int n) { return heap(n, any_capsule); }},
    {"hulls", nullptr, hull_heap},
    {"wall", nullptr, wall},
    {"stacks", nullptr, stacks},
};

}  // namespace

const std::vector<const char*>& scene_names() {
  static const std::vector<const char*> names = [] {
    std::vector<const char*> all;
    for (const NamedScene& scene : kScenes) {
      if (scene.make != nullptr) all.push_back(scene.name);
    }
    return all;
  }();
  return names;
}

std::string numbered_scene_names() {
  std::string all;
  for (const NamedScene& scene : kScenes) {
    if (scene.make_of == nullptr) continue;
    all += (all.empty() ? "" : ", ") + std::string(scene.name) + ":N";
    if (scene.max_number < 1000000) all += " (to " + std::to_string(scene.max_number) + ")";
  }
  return all;
}

std::optional<Scene> find_scene(const std::string& name) {
  const std::size_t colon = name.find(':');
  for (const NamedScene& named : kScenes) {
    if (name.substr(0, colon) != named.name) continue;
    std::optional<Scene> scene;
    if (colon == std::string::npos) {
      if (named.make != nullptr) scene = named.make();
    } else if (const long number = std::strtol(name.c_str() + colon + 1, nullptr, 10);
               named.make_of != nullptr && number > 0 && number <= named.max_number) {
      scene = named.make_of(int(number));
    }
    if (scene) scene->name = name;
    return scene;
  }
  return std::nullopt;
}

}  // namespace gyre::bench
