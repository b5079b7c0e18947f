// A crowd of every kind of shape to be asked, and random questions: what the tests of queries share.
#pragma once

#include "laws/kit.h"

#include <limits>
#include <random>

namespace gyre::laws {

struct Random {
  std::mt19937 engine;
  float operator()(float low, float high) { return low + (high - low) * float(engine() >> 8) / 16777216.0f; }
  int below(int n) { return int(engine() % unsigned(n)); }
  Vec3 in_box(float half) {
    const float x = (*this)(-half, half), y = (*this)(-half, half), z = (*this)(-half, half);
    return {x, y, z};
  }
  Quat turn() {
    const float x = (*this)(-1, 1), y = (*this)(-1, 1), z = (*this)(-1, 1), w = (*this)(-1, 1);
    return normalized(Quat{x, y, z, w});
  }
};

inline Geometry rough_mesh(Random& random, bool double_sided) {
  constexpr int kSide = 12;
  std::vector<Vec3> vertices;
  std::vector<std::uint32_t> indices;
  for (int i = 0; i < kSide * kSide; ++i)
    vertices.push_back({float(i % kSide) - 5.5f, random(-0.7f, 0.7f), float(i / kSide) - 5.5f});
  for (int row = 0; row + 1 < kSide; ++row) {
    for (int column = 0; column + 1 < kSide; ++column) {
      const auto at = [&](int c, int r) { return std::uint32_t((row + r) * kSide + column + c); };
      indices.insert(indices.end(), {at(0, 0), at(0, 1), at(1, 0), at(1, 0), at(0, 1), at(1, 1)});
    }
  }
  return *cook_mesh({.vertices = vertices, .indices = indices, .double_sided = double_sided});
}
inline Geometry rough_field(Random& random) {
  std::vector<float> heights(15 * 9);
  for (float& h : heights)
    h = random.below(12) == 0 ? std::numeric_limits<float>::quiet_NaN() : random(-0.7f, 0.7f);
  return *cook_height_field({.heights = heights, .columns = 15, .rows = 9, .spacing = 0.8f});
}
inline AnyShape random_convex(Random& random) {
  const float a = random(0.2f, 0.8f), b = random(0.2f, 0.8f), c = random(0.2f, 0.8f);
  switch (random.below(7)) {
    case 0:
      return Sphere{a};
    case 1:
      return Box{{a, b, c}};
    case 2:
      return Box{{a, b, c}, 0.15f};
    case 3:
      return Capsule{a, b};
    case 4:
      return Cylinder{a, b};
    case 5:
      return Cone{a, b};
    default: {
      std::vector<Vec3> points;
      for (int i = 0; i < 12; ++i) points.push_back(random.in_box(0.8f));
      return *cook_hull(points);
    }
  }
}

struct Crowd {
  World world;
  std::vector<BodyId> bodies;
  std::vector<std::vector<ShapeDef>> shapes;  // of each body
};

// Every kind of shape, bodies of several shapes, sensors, layers; some of them have moved since the last step.
inline Crowd crowd(unsigned seed, BroadPhaseKind kind, int threads = 1, DVec3 origin = {}) {
  Random random{std::mt19937(seed)};
  WorldDef def;
  def.threads = threads;
  def.gravity = {};
  def.stepping.broad_phase = kind;
  Crowd c{make_world(def), {}, {}};
  const auto add = [&](const BodyDef& body, const std::vector<ShapeDef>& shapes) {
    c.bodies.push_back(c.world.add_body(body, shapes));
    c.shapes.push_back(shapes);
  };
  const auto pose = [&] { return Pose{origin + random.in_box(9.0f), random.turn()}; };
  const Plane plane{normalized(random.in_box(1.0f)), -9.0f};
  add({.type = BodyType::fixed, .pose = {origin, {}}}, {{.geometry = plane}});
  for (int i = 0; i < 4; ++i) {
    const Geometry surface = i % 2 == 0 ? rough_mesh(random, i == 2) : rough_field(random);
    add({.type = BodyType::fixed, .pose = pose()}, {{.geometry = surface}});
  }
  for (int i = 0; i < 150; ++i) {
    std::vector<ShapeDef> shapes(std::size_t(1 + (random.below(4) == 0 ? 3 : 0)));
    for (ShapeDef& shape : shapes) {
      shape.geometry = random_convex(random);
      if (shapes.size() > 1) shape.local = {random.in_box(1.0f), random.turn()};
      shape.sensor = random.below(10) == 0;
      shape.filter.layer = 1u << random.below(4);
    }
    const BodyType type = random.below(3) == 0 ? BodyType::dynamic : BodyType::fixed;
    add({.type = type, .pose = pose()}, shapes);
  }
  if (seed % 3 != 0) c.world.step(kStep);
  if (seed % 3 == 2) {
    for (int i = 0; i < 20; ++i) c.world.set_pose(c.bodies[std::size_t(10 + i)], pose());
    for (int i = 0; i < 10; ++i) c.world.remove_body(c.bodies[std::size_t(60 + i)]);
  }
  return c;
}

inline Ray random_ray(Random& random, DVec3 origin = {}) {
  const Vec3 from = random.in_box(12.0f);
  Vec3 way = 2.0f * (random.in_box(7.0f) - from);
  if (random.below(5) == 0) way = {0.0f, way.y, 0.0f};
  return {origin + from, way};
}
inline ShapePose random_place(Random& random, DVec3 origin = {}) {
  return {random_convex(random), {origin + random.in_box(10.0f), random.turn()}};
}
inline ShapeCast random_cast(Random& random, DVec3 origin = {}) {
  const ShapePose place = random_place(random, origin);
  return {place.shape, place.pose, random.in_box(15.0f)};
}

}  // namespace gyre::laws
