// Shapes: bounds and radii against support points and samples, and every refusal of check_shape.
#include "geometry/shape/shape.h"

#include "geometry/shape/support.h"

#include <gtest/gtest.h>

#include <cmath>
#include <random>
#include <string>
#include <vector>

namespace gyre::shape_test {
namespace {

struct Random {
  std::mt19937 engine{4711};
  float operator()(float low = -1.0f, float high = 1.0f) {
    return low + (high - low) * (float(engine() >> 8) / 16777216.0f);
  }
  Vec3 vector() {
    const float x = (*this)(), y = (*this)(), z = (*this)();
    return {x, y, z};
  }
  Vec3 direction() {
    for (;;) {
      const Vec3 p = vector();
      if (length_squared(p) > 0.01f && length_squared(p) < 1.0f) return normalized(p);
    }
  }
  Transform transform() {
    const Quat q{(*this)(), (*this)(), (*this)(), (*this)()};
    return {3.0f * vector(), normalized(q)};
  }
};

std::vector<AnyShape> convex_shapes() {
  Random random;
  std::vector<Vec3> points;
  for (int i = 0; i < 30; ++i)
    points.push_back(Vec3{0.2f, 0.1f, -0.3f} + multiply_each({1.0f, 0.5f, 0.7f}, random.direction()));
  return {Sphere{0.7f},        Box{{0.5f, 0.3f, 0.9f}}, Box{{0.5f, 0.3f, 0.9f}, 0.1f},
          Capsule{0.3f, 0.8f}, Cylinder{0.4f, 0.9f},    Cylinder{0.9f, 0.1f},
          Cone{0.5f, 0.7f},    Cone{1.5f, 0.2f},        Cone{0.1f, 2.0f},
          *cook_hull(points)};
}

float reach(const Shape& shape, Vec3 d) { return dot(support(shape, d), d) + core_radius(shape); }

TEST(Shape, BoundsAreTight) {
  Random random;
  for (const AnyShape& any : convex_shapes()) {
    const Shape shape = make_shape(any);
    for (int round = 0; round < 100; ++round) {
      const Transform t = round == 0 ? Transform{} : random.transform();
      const Aabb box = bounds(shape, t);
      for (int axis = 0; axis < 3; ++axis) {
        const Vec3 d{axis == 0 ? 1.0f : 0.0f, axis == 1 ? 1.0f : 0.0f, axis == 2 ? 1.0f : 0.0f};
        EXPECT_NEAR(box.high[axis], t.position[axis] + reach(shape, rotate_inverse(t.orientation, d)), 4e-6f)
            << to_string(shape.kind);
        EXPECT_NEAR(box.low[axis], t.position[axis] - reach(shape, rotate_inverse(t.orientation, -d)), 4e-6f)
            << to_string(shape.kind);
      }
    }
  }
}

TEST(Shape, InnerRadiusIsTheDistanceOfTheNearestPlane) {
  Random random;
  for (const AnyShape& any : convex_shapes()) {
    const Shape shape = make_shape(any);
    Vec3 middle;
    if (shape.kind == ShapeKind::hull) {
      const Result<MassProperties> mass = mass_properties(any, 1.0f);
      ASSERT_TRUE(mass);
      middle = mass->center;
    }
    float nearest = 1e30f;
    for (int i = 0; i < 40000; ++i) {
      const Vec3 d = random.direction();
      nearest = std::min(nearest, reach(shape, d) - dot(middle, d));
    }
    EXPECT_GE(nearest, inner_radius(shape) - 1e-6f) << to_string(shape.kind);
    EXPECT_LE(nearest, inner_radius(shape) * 1.05f) << to_string(shape.kind);
  }
}

TEST(Shape, OuterRadiusIsTheDistanceOfTheFarthestPoint) {
  Random random;
  for (const AnyShape& any : convex_shapes()) {
    const Shape shape = make_shape(any);
    for (const Vec3 center :
         {Vec3{}, Vec3{0.3f, -0.2f, 0.1f}, Vec3{-2, 1, 3}, Vec3{0, 2, 0}, Vec3{0, -2, 0}}) {
      float farthest = 0.0f;
      for (int i = 0; i < 20000; ++i) {
        const Vec3 d = random.direction();
        farthest = std::max(farthest, distance(support(shape, d) + core_radius(shape) * d, center));
      }
      EXPECT_LE(farthest, outer_radius(shape, center) * 1.000001f) << to_string(shape.kind);
      EXPECT_GE(farthest, outer_radius(shape, center) * 0.998f) << to_string(shape.kind);
    }
  }
}

TEST(Shape, PlanesAreNormalizedAndUnbounded) {
  const Shape plane = make_shape(Plane{{0, 4, 0}, 2.0f});
  EXPECT_EQ(plane.extents, (Vec3{0, 1, 0}));
  EXPECT_EQ(plane.offset, 0.5f);
  const Aabb floor = bounds(plane, {{1, 2, 3}, {}});
  EXPECT_EQ(floor.high.y, 2.5f);
  EXPECT_EQ(floor.low, (Vec3{-kUnbounded, -kUnbounded, -kUnbounded}));
  EXPECT_EQ(floor.high.x, kUnbounded);
  const Aabb wall = bounds(make_shape(Plane{{-1, 0, 0}, 2.0f}), {});
  EXPECT_EQ(wall.low.x, -2.0f);
  EXPECT_EQ(wall.high, (Vec3{kUnbounded, kUnbounded, kUnbounded}));
  const Aabb tilted = bounds(make_shape(Plane{{1e-6f, 1, 0}, 0.0f}), {});
  EXPECT_EQ(tilted.high.y, kUnbounded);
  EXPECT_EQ(inner_radius(plane), kUnbounded);
  EXPECT_EQ(outer_radius(plane, {}), kUnbounded);
}

TEST(Shape, MeshesAndFieldsAreBoundedByTheirTurnedBox) {
  const std::vector<Vec3> vertices = {{-1, 0, -2}, {1, 0, -2}, {0, 1, 2}};
  const std::vector<std::uint32_t> indices = {0, 2, 1};
  const Result<Geometry> mesh = cook_mesh({vertices, indices});
  ASSERT_TRUE(mesh) << mesh.error().message;
  const std::vector<float> heights = {0, 1, 2, 3, 4, 5};
  const Result<Geometry> field = cook_height_field({heights, 3, 2, 2.0f});
  ASSERT_TRUE(field) << field.error().message;
  Random random;
  for (const Geometry& geometry : {*mesh, *field}) {
    const Shape shape = make_shape(geometry);
    std::vector<Vec3> points = vertices;
    if (shape.kind == ShapeKind::height_field) {
      points.clear();
      for (int i = 0; i < 6; ++i)
        points.push_back({float(i % 3 - 1) * 2.0f, heights[std::size_t(i)], (float(i / 3) - 0.5f) * 2.0f});
    }
    const Aabb still = bounds(shape, {});
    Aabb wanted{points[0], points[0]};
    for (const Vec3& p : points) wanted = merge(wanted, {p, p});
    EXPECT_LT(distance(still.low, wanted.low), 1e-5f);
    EXPECT_LT(distance(still.high, wanted.high), 1e-5f);
    for (int i = 0; i < 20; ++i) {
      const Transform t = random.transform();
      const Aabb box = grow(bounds(shape, t), 1e-5f);
      for (const Vec3& p : points) {
        EXPECT_TRUE(contains(box, {t * p, t * p}));
        EXPECT_LE(distance(p, t.position), outer_radius(shape, t.position) * 1.000001f);
      }
    }
    EXPECT_EQ(inner_radius(shape), 0.0f);
  }
}

void expect_refused(const AnyShape& shape, std::initializer_list<const char*> words) {
  const Error error = check_shape(shape);
  EXPECT_EQ(error.code, ErrorCode::invalid_argument);
  for (const char* word : words)
    EXPECT_NE(std::string(error.message).find(word), std::string::npos) << error.message;
}

TEST(Shape, RefusalsNameFieldValueAndRange) {
  const float nan = std::nanf(""), inf = INFINITY;
  for (const float bad : {0.0f, -1.0f, nan, inf, -inf, 1e-30f, 1e30f}) {
    expect_refused(Sphere{bad}, {"sphere", "radius is", "allowed is 1e-09 to 1e+09 m"});
    expect_refused(Box{{bad, 1, 1}}, {"box", "half_extents.x is"});
    expect_refused(Box{{1, bad, 1}}, {"half_extents.y is"});
    expect_refused(Box{{1, 1, bad}}, {"half_extents.z is"});
    expect_refused(Capsule{bad, 1}, {"capsule", "radius is"});
    expect_refused(Cylinder{bad, 1}, {"cylinder", "radius is"});
    expect_refused(Cylinder{1, bad}, {"half_height is"});
    expect_refused(Cone{bad, 1}, {"cone", "radius is"});
    expect_refused(Cone{1, bad}, {"half_height is"});
  }
  expect_refused(Sphere{-2.5f}, {"-2.5"});
  for (const float bad : {-0.1f, 0.6f, nan, inf}) {
    expect_refused(Box{{1, 0.5f, 2}, bad}, {"rounding is", "allowed is 0 to 0.5 m"});
  }
  for (const float bad : {-0.1f, nan, inf})
    expect_refused(Capsule{1, bad}, {"half_height is", "allowed is 0 to"});
  expect_refused(Plane{{0, 0, 0}, 0}, {"plane", "normal is (0, 0, 0)"});
  expect_refused(Plane{{0, nan, 0}, 0}, {"normal is"});
  expect_refused(Plane{{0, inf, 0}, 0}, {"normal is"});
  expect_refused(Plane{{0, 1, 0}, nan}, {"offset is"});
  expect_refused(Plane{{0, 1, 0}, 1e30f}, {"offset is"});
  expect_refused(Geometry{}, {"geometry", "empty"});
  for (const AnyShape& shape : convex_shapes()) EXPECT_EQ(check_shape(shape).code, ErrorCode::none);
  EXPECT_EQ(check_shape(Plane{{0, 0, 7}, -3}).code, ErrorCode::none);
  EXPECT_EQ(check_shape(Capsule{1, 0}).code, ErrorCode::none);
  EXPECT_EQ(check_shape(Box{{1, 0.5f, 2}, 0.5f}).code, ErrorCode::none);
}

TEST(Shape, NamesAndEmptyGeometry) {
  for (int i = 0; i < kShapeKindCount; ++i) EXPECT_STRNE(to_string(ShapeKind(i)), "unknown");
  EXPECT_EQ(Geometry{}.content_hash(), 0u);
  EXPECT_TRUE(view_hull({}).vertices.empty());
  EXPECT_TRUE(view_mesh({}).vertices.empty());
  EXPECT_TRUE(view_height_field({}).heights.empty());
}

}  // namespace
}  // namespace gyre::shape_test
